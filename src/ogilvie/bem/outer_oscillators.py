"""Oscillators that share one damper, as a model of the outer domain: response, and normal equations of its fit (kernels).

    L(s) = b^T (s^2 + s d d^T + W^2)^-1 b,   W = diag(w),   K_hat = s L,   K(0+) = b^T b

Symmetric and passive for any b (n, J), d (n,) and w (n,), with damping of rank one as each azimuthal mode radiates one wave:
Re K_hat(i omega) = omega^2 |d^T (...)^-1 b|^2. Parameters are one vector [log w (n) | b (n J), row by row | d (n)].
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Problem:
    """Least squares of weighted errors of L at s = i omega and of K(0+).

    Attributes
    ----------
    omega : (f,) array
    target : (f, J, J) complex array
        L(i omega), symmetric.
    weight : (f,) array
        Of squared errors.
    initial : (J, J) array
        K(0+).
    initial_weight : float
    """

    omega: Array
    target: Array
    weight: Array
    initial: Array
    initial_weight: float

    def split(self, p: Array) -> tuple[Array, Array, Array]:
        """Return w (n,), b (n, J) and d (n,)."""
        J = len(self.initial)
        n = len(p) // (J + 2)
        return np.exp(p[:n]), p[n:-n].reshape(n, J), p[-n:]

    def error(self, p: Array) -> Array:
        """Errors of L (f, J, J)."""
        w, b, d = self.split(p)
        return np.asarray(b.T @ solved(w, b, d, self.omega) - self.target)

    def cost(self, p: Array) -> float:
        """Weighted sum of squared errors."""
        b = self.split(p)[1]
        return self._cost(self.error(p), b.T @ b - self.initial)

    def _cost(self, E: Array, first: Array) -> float:
        return float(self.weight @ (E.real**2 + E.imag**2).sum(axis=(1, 2)) + self.initial_weight * np.sum(first**2))

    def normal(self, p: Array) -> tuple[float, Array, Array]:
        """Return cost, half its gradient (n_p,) and the Gauss-Newton matrix (n_p, n_p) to that.

        Notes
        -----
        Every derivative of L is u v^T + v u^T: (Y_k, -w_k^2 Y_k) for log w_k, (e_i, Y_k) for b_ki, (Y_k, -s Z) for d_k with
        Y_k the rows of Y = (...)^-1 b and Z = d^T Y. Half the inner product of two of them is
        (u* . u')(v* . v') + (u* . v')(v* . u'): the large Jacobian is never formed.
        """
        w, b, d = self.split(p)
        Y = solved(w, b, d, self.omega)
        E, first = b.T @ Y - self.target, b.T @ b - self.initial
        return self._cost(E, first), self._slope(w, b, d @ Y, Y, E, first), self._curvature(w, b, d @ Y, Y)

    def _slope(self, w: Array, b: Array, Z: Array, Y: Array, E: Array, first: Array) -> Array:
        """Half the gradient of the cost."""
        g, s = self.weight, 1j * self.omega
        EY = Y.conj() @ E
        slope_w = -(w**2) * np.einsum("f,fki,fki->k", g, EY, Y.conj()).real
        slope_b = np.einsum("f,fki->ki", g, EY).real + self.initial_weight * b @ first
        slope_d = np.einsum("f,fki,fi->k", g * s, EY, Z.conj()).real
        return np.concatenate([slope_w, slope_b.ravel(), slope_d])

    def _curvature(self, w: Array, b: Array, Z: Array, Y: Array) -> Array:
        """Half the Gauss-Newton matrix of the cost, in blocks of log w, b and d."""
        n, J = b.shape
        g, s, c, g0 = self.weight, 1j * self.omega, -(w**2), self.initial_weight
        Yc, y = Y.conj(), Y.reshape(len(g), n * J)
        G = Yc @ Y.transpose(0, 2, 1)  # (f, n, n)
        H = np.einsum("fki,fi->fk", Yc, Z)
        gG, gsH, sH = g[:, None, None] * G, (g * s)[:, None] * H, self.omega[:, None] * H
        ww = 2 * np.outer(c, c) * np.einsum("fkl,fkl->kl", gG, G).real
        wb = 2 * c[:, None] * np.einsum("fki,fkl->kli", Yc, gG, optimize=True).real.reshape(n, n * J)
        wd = -2 * c[:, None] * np.einsum("fkl,fk->kl", G, gsH).real
        bb = _real_product(g[:, None] * y, y.conj()).reshape(n, J, n, J).transpose(2, 1, 0, 3).copy()
        bb += g0 * np.einsum("li,kj->kilj", b, b)
        i = np.arange(J)
        bb[:, i, :, i] += gG.real.sum(axis=0) + g0 * b @ b.T
        bd = _real_product(y, gsH).reshape(n, J, n).transpose(2, 1, 0)
        bd = bd + _real_product((s[:, None, None] * gG).reshape(len(g), n * n), Z).reshape(n, n, J).transpose(0, 2, 1)
        dd = np.einsum("f,fkl->kl", self.omega**2 * (np.abs(Z) ** 2).sum(axis=1), gG).real
        dd += _real_product(g[:, None] * sH, sH.conj())
        b_b, b_d = bb.reshape(n * J, n * J), -bd.reshape(n * J, n)
        return np.block([[ww, wb, wd], [wb.T, b_b, b_d], [wd.T, b_d.T, dd]])


def solved(w: Array, b: Array, D: Array, omega: Array) -> Array:
    """Return (s^2 + s D D^T + W^2)^-1 b at s = i omega, (f, n, J); D (n,) or (n, r)."""
    D = D.reshape(len(w), -1)
    A = 1j * omega[:, None, None] * (D @ D.T)
    n = np.arange(len(w))
    A[:, n, n] += w**2 - omega[:, None] ** 2
    return np.asarray(np.linalg.solve(A, np.broadcast_to(b + 0j, (len(A), *b.shape))))


def _real_product(a: Array, b: Array) -> Array:
    """Real part of a^T b for complex (f, p) and (f, q)."""
    return np.asarray(a.real.T @ b.real - a.imag.T @ b.imag)
