"""Oscillators that share dampers, as a model of the outer domain: response, and normal equations of a fit.

    L(s) = b^T (s^2 + s D D^T + W^2)^-1 b,   W = diag(w),   K_hat = s L,   K(0+) = b^T b

Symmetric and passive for any b (n, J), D (n, r) and w (n,): Re K_hat(i omega) = omega^2 |D^T (...)^-1 b|^2.
Parameters are one vector [log w (n) | b (n J) | D (n r)], row by row.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Problem:
    """Least squares of weighted errors of L at imaginary s = i omega and of K(0+).

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
    dampers : int
    """

    omega: Array
    target: Array
    weight: Array
    initial: Array
    initial_weight: float
    dampers: int

    def split(self, p: Array) -> tuple[Array, Array, Array]:
        """Return w (n,), b (n, J) and D (n, r)."""
        J, r = len(self.initial), self.dampers
        n = len(p) // (1 + J + r)
        return np.exp(p[:n]), p[n : n + n * J].reshape(n, J), p[n + n * J :].reshape(n, r)

    def error(self, p: Array) -> Array:
        """Errors of L (f, J, J)."""
        b, Y = self._solved(p)
        return b.T @ Y - self.target

    def cost(self, p: Array) -> float:
        """Weighted sum of squared errors."""
        E = self.error(p)
        b = self.split(p)[1]
        first = b.T @ b - self.initial
        return float(self.weight @ _square(E) + self.initial_weight * np.sum(first**2))

    def _solved(self, p: Array) -> tuple[Array, Array]:
        """Return b (n, J) and Y = (s^2 + s D D^T + W^2)^-1 b, (f, n, J)."""
        w, b, D = self.split(p)
        s = 1j * self.omega[:, None, None]
        A = s * (D @ D.T)
        n = np.arange(len(w))
        A[:, n, n] += w**2 - self.omega[:, None] ** 2
        return b, np.linalg.solve(A, np.broadcast_to(b + 0j, (len(A), *b.shape)))

    def normal(self, p: Array) -> tuple[float, Array, Array]:
        """Return cost, half its gradient (n_p,) and the Gauss-Newton matrix (n_p, n_p).

        Notes
        -----
        Every derivative is u v^T + v u^T: (Y_k, -w_k^2 Y_k) for log w_k, (e_i, Y_k) for b_ki, (Y_k, -s Z_q) for D_kq with
        Y_k the rows of Y and Z = D^T Y. Inner products of two of them are
        2 Re [(u* . u')(v* . v') + (u* . v')(v* . u')], so that the large Jacobian is never formed.
        """
        w, b, D = self.split(p)
        n, J = b.shape
        r = self.dampers
        _, Y = self._solved(p)
        E = b.T @ Y - self.target
        first = b.T @ b - self.initial
        cost = float(self.weight @ _square(E) + self.initial_weight * np.sum(first**2))
        g, s, c = self.weight, 1j * self.omega, -(w**2)
        Z = D.T @ Y
        Yc, Zc = Y.conj(), Z.conj()
        G, H, ZZ = Yc @ Y.transpose(0, 2, 1), Yc @ Z.transpose(0, 2, 1), Zc @ Z.transpose(0, 2, 1)
        EY = Yc @ E
        gradient = np.concatenate(
            [
                c * np.einsum("f,fki,fki->k", g, EY, Yc).real,
                (np.einsum("f,fki->ki", g, EY).real + self.initial_weight * b @ first).ravel(),
                np.einsum("f,fki,fqi->kq", g * s, EY, Zc).real.ravel(),
            ]
        )
        N = np.zeros((len(p), len(p)))
        x, q, d = slice(0, n), slice(n, n + n * J), slice(n + n * J, None)
        N[x, x] = 2 * np.outer(c, c) * np.einsum("f,fkl->kl", g, G**2).real
        gG = (g[:, None, None] * G).reshape(len(g), n * n)
        kli = np.einsum("fki,fkl->kli", Yc, gG.reshape(G.shape), optimize=True).real
        N[x, q] = 2 * (c[:, None, None] * kli).reshape(n, n * J)
        klq = np.einsum("f,fkl,fkq->klq", g * s, G, H, optimize=True).real
        N[x, d] = -2 * (c[:, None, None] * klq).reshape(n, n * r)
        y = Y.reshape(len(g), n * J)
        likj = _real_product(g[:, None] * y, y.conj()).reshape(n, J, n, J)
        bb = likj.transpose(2, 1, 0, 3) + self.initial_weight * np.einsum("li,kj->kilj", b, b)
        i = np.arange(J)
        bb[:, i, :, i] += gG.real.sum(axis=0).reshape(n, n) + self.initial_weight * b @ b.T
        N[q, q] = bb.reshape(n * J, n * J)
        h = ((g * s)[:, None, None] * H).reshape(len(g), n * r)
        likq = _real_product(y, h).reshape(n, J, n, r)
        klqi = _real_product(s[:, None] * gG, Z.reshape(len(g), r * J)).reshape(n, n, r, J)
        N[q, d] = -(likq.transpose(2, 1, 0, 3) + klqi.transpose(0, 3, 1, 2)).reshape(n * J, n * r)
        gs = g * self.omega**2
        dd = np.einsum("f,fkl,fqt->kqlt", gs, G, ZZ, optimize=True) + np.einsum(
            "f,fkt,flq->kqlt", gs, H, H.conj(), optimize=True
        )
        N[d, d] = dd.real.reshape(n * r, n * r)
        N[q, x], N[d, x], N[d, q] = N[x, q].T, N[x, d].T, N[q, d].T
        return cost, gradient, N


def _square(E: Array) -> Array:
    return np.asarray((E.real**2 + E.imag**2).sum(axis=(1, 2)))


def _real_product(a: Array, b: Array) -> Array:
    """Real part of a^T b for complex (f, p) and (f, q)."""
    return a.real.T @ b.real - a.imag.T @ b.imag
