"""Realization theory (paper A): a state space from samples of K(t) by the singular values of their Hankel matrix (Kung).

The shared poles of all couplings of a block come out of one block Hankel matrix; one decomposition serves every order.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ogilvie.memory.blocks import r_squared
from ogilvie.memory.retardation import Retardation
from ogilvie.memory.statespace import StateSpace, modal_form

Array = NDArray[Any]


_SAMPLES = 401  # of K in the Hankel matrix


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


def identify_by_realization(
    K: Retardation, blocks: list[list[int]], *, r2: float, order: int | None, max_order: int
) -> tuple[list[tuple[list[int], Array, Array, Array]], list[str]]:
    """Return the models of the blocks [(dofs, A, B, C)] and notes on couplings that do not reach `r2`.

    The order of a block is raised until each of its couplings reaches `r2`, at most to its share of `max_order`.
    """
    models, notes = [], []
    for block in blocks:
        A, B, C, reached = _identify_block(K, block, r2, order, max(2, max_order * len(block) // sum(map(len, blocks))))
        models.append((block, A, B, C))
        low = [
            f"{K.dofs[i]}-{K.dofs[j]} {reached[a, b]:.4f}"
            for a, i in enumerate(block)
            for b, j in enumerate(block)
            if order is None and reached[a, b] < r2
        ]
        if low:
            notes.append(f"R2 {r2:g} not reached with order {len(A)}: {', '.join(low)}; raise max_order or check the data.")
    return models, notes


def _identify_block(
    K: Retardation, block: list[int], r2: float, order: int | None, max_order: int
) -> tuple[Array, Array, Array, Array]:
    part = K.K[:, block][:, :, block]
    scale = np.sqrt(np.abs(np.einsum("tii->ti", part)).max(axis=0))
    scaled = part / np.outer(scale, scale)
    t = np.linspace(0.0, K.duration, min(_SAMPLES, len(K.t)))
    flat = scaled.reshape(len(K.t), -1)
    samples = np.stack([np.interp(t, K.t, flat[:, k]) for k in range(flat.shape[1])], axis=1).reshape(len(t), *part.shape[1:])
    hankel = hankel_realization(samples, t[1], max_order=order or max_order)
    dofs = tuple(K.dofs[i] for i in block)
    best: tuple[float, tuple[Array, Array, Array], Array] | None = None
    for n in [order] if order else range(2, len(hankel.singular_values) + 1):
        model = _refit(hankel, n, K.t, scaled)
        reached = r_squared(scaled, StateSpace(*model, dofs).impulse(K.t))
        worst = float(np.nanmin(reached))
        if best is None or worst > best[0]:
            best = (worst, model, reached)
        if worst >= r2:
            break
    assert best is not None
    A, B, C = best[1]
    return A, B * scale, C * scale[:, None], best[2]


def _refit(hankel: HankelRealization, order: int, t: Array, K: Array) -> tuple[Array, Array, Array]:
    """Model of that order in real modal form, its outputs refitted to K(t) by least squares with poles and inputs fixed."""
    A, B, C = modal_form(*hankel.continuous(order))
    m = K.shape[1]
    columns = StateSpace(A, B, np.zeros((m, order)), tuple(map(str, range(m)))).states(t)  # (n_t, n, m)
    regressors = columns.transpose(0, 2, 1).reshape(-1, order)
    targets = K.transpose(0, 2, 1).reshape(-1, m)
    C = np.linalg.lstsq(regressors, targets, rcond=None)[0].T
    return A, B, C
