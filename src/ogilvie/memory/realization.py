"""Realization theory (paper A): a state space from samples of K(t) by the singular values of their Hankel matrix (Kung).

The shared poles of all couplings of a block come out of one block Hankel matrix; one decomposition serves every order.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ogilvie.memory.raise_order import raise_order
from ogilvie.memory.statespace import modal_form
from ogilvie.memory.targets import Impulse, Trial

Array = NDArray[Any]

_SAMPLES = 401  # of K in the Hankel matrix
_PATIENCE = 8  # orders without progress; the way to a good order is not monotonic


@dataclass(frozen=True, eq=False)
class HankelRealization:
    """Decomposition of the Hankel matrix of K, from which a model of any order follows.

    Attributes
    ----------
    dt : float
        Sampling step, s.
    U, V : (n_rows * m, n_max) array
        Leading left and right singular vectors.
    singular_values : (n_max,) array
        Their decay bounds the error of a model of order n: max over omega |K_hat - K_hat_n| <= 2 sum of those left out.
    """

    dt: float
    m: int
    U: Array
    V: Array
    singular_values: Array

    def discrete(self, order: int) -> tuple[Array, Array, Array]:
        """Return (A, B, C) of x_{k+1} = A x_k + B u_k, y_k = C x_k whose impulse response C A^(k-1) B is K(k dt) dt."""
        root = np.sqrt(self.singular_values[:order])
        O, R = self.U[:, :order] * root, self.V[:, :order] * root
        A = np.linalg.lstsq(O[: -self.m], O[self.m :], rcond=None)[0]
        return A, R[: self.m].T, O[: self.m]

    def continuous(self, order: int) -> tuple[Array, Array, Array]:
        """Return (A, B, C) of the continuous model by the bilinear map s = (2/dt)(z - 1)/(z + 1); unstable poles are mirrored.

        Notes
        -----
        A_c = (2/dt)(A - 1)(A + 1)^-1, B_c = 2 (A + 1)^-1 B / sqrt(dt), C_c = C (A + 1)^-1 2 / sqrt(dt). The direct term that
        the map leaves is zero to second order in dt (half a sample at t = 0, trapezoid rule) and is dropped: paper A (11).
        """
        A, B, C = self.discrete(order)
        lam, W = np.linalg.eig(A)
        outside = np.abs(lam) >= 1.0
        if np.any(outside):
            lam = np.where(outside, 0.999 / np.conj(lam), lam)
            A = (W * lam @ np.linalg.inv(W)).real
        inverse = np.linalg.inv(A + np.eye(order))
        Ac = 2 / self.dt * (A - np.eye(order)) @ inverse
        return Ac, 2 / np.sqrt(self.dt) * inverse @ B, 2 / np.sqrt(self.dt) * C @ inverse


def hankel_realization(K: Array, dt: float, *, max_order: int) -> HankelRealization:
    """Return the decomposition of the block Hankel matrix of the samples K(dt), K(2 dt), ...

    Parameters
    ----------
    K : (n_t, m, m) array
        Samples of K from t = 0.
    dt : float
        s.
    max_order : int

    References
    ----------
    Kung (1978); Kristiansen, Hjulstad and Egeland (2005); paper A (Yuan 2017), section IV.2.
    """
    n, m = (len(K) - 1) // 2, K.shape[1]
    rows = np.arange(n)[:, None] + np.arange(n)[None, :] + 1
    H = (K[rows] * dt).transpose(0, 2, 1, 3).reshape(n * m, n * m)
    rank = min(max_order, n * m - 1)
    U, s, Vt = _leading_svd(H, rank)
    return HankelRealization(dt, m, U, Vt.T, s)


def _leading_svd(H: Array, rank: int) -> tuple[Array, Array, Array]:
    """Leading singular triplets by randomised subspace iteration from a fixed start, exact to rounding for decaying spectra."""
    if len(H) <= 4 * rank:
        U, s, Vt = scipy.linalg.svd(H, check_finite=False)
        return U[:, :rank], s[:rank], Vt[:rank]
    Q = np.random.default_rng(1978).standard_normal((len(H), min(2 * rank + 10, len(H))))
    for _ in range(4):
        Q = np.linalg.qr(H @ np.linalg.qr(H.T @ np.linalg.qr(H @ Q)[0])[0])[0]
    U, s, Vt = scipy.linalg.svd(Q.T @ H, full_matrices=False, check_finite=False)
    return (Q @ U)[:, :rank], s[:rank], Vt[:rank]


def identify_by_realization(target: Impulse, *, r2: float, order: int | None, limit: int) -> tuple[Trial, Array]:
    """Return the model of a block by realization theory, of the lowest order that reaches `r2`, the outputs refitted to K."""
    t = np.linspace(0.0, target.t[-1], min(_SAMPLES, len(target.t)))
    flat = target.K.reshape(len(target.t), -1)
    samples = np.stack([np.interp(t, target.t, column) for column in flat.T], axis=1).reshape(len(t), *target.K.shape[1:])
    hankel = hankel_realization(samples, t[1], max_order=order or limit)
    sizes = [order] if order else range(2, len(hankel.singular_values) + 1)
    trials = (target.outputs(*modal_form(*hankel.continuous(n))[:2]) for n in sizes)
    return raise_order(target, trials, r2, patience=_PATIENCE)
