"""Impulse-response curve fitting (paper A's IRCFM): Prony's method, then Steiglitz-McBride iterations, in the z-domain.

    H_ij(z) = sum_k K_ij(k dt) z^-k = b_ij(z) / a(z),   a(z) = 1 + a_1 z^-1 + ... + a_n z^-n

with one denominator for all couplings of a block. The poles exp(lambda dt) of H are those of K(t) sampled: no bilinear map.
"""

from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ogilvie.memory.blocks import negligible
from ogilvie.memory.common_poles import fit_common_poles, stable
from ogilvie.memory.targets import Impulse, Trial

Array = NDArray[Any]

_ITERATIONS = 10
_NYQUIST = 3.0  # half the sampling frequency, in terms of the highest frequency of the data
_LEAST_SAMPLES = 3  # for each pole
_UNIT = 0.999  # largest |z| of a pole


def identify_by_prony(target: Impulse, *, r2: float, order: int | None, limit: int) -> tuple[Trial, Array]:
    """Return the model of a block with common poles fitted to K(t) by Prony's method and Steiglitz-McBride iterations.

    References
    ----------
    Paper A (Yuan 2017), Eq. (10); Steiglitz and McBride (1965), IEEE Trans. Automatic Control 10.
    """
    return fit_common_poles(target, prony_poles, r2=r2, order=order, limit=limit)


def prony_poles(target: Impulse, n: int) -> Array:
    """Return n stable poles shared by all couplings of the target, 1/s.

    Notes
    -----
    Prony: h_k = -sum_l a_l h_k-l for k >= n, least squares over all couplings. Steiglitz-McBride: with h and the unit pulse
    filtered by 1/a of the iteration before, min sum |a h - b pulse|^2, which at the end is the error of h itself; the best of
    the iterations is kept, since they need not converge.

    Examples
    --------
    >>> t = np.arange(0.0, 20.0, 0.05)
    >>> K = (np.exp(-0.3 * t) * np.cos(t))[:, None, None]
    >>> prony_poles(Impulse(t, K, 3.0, np.zeros((1, 1)), np.ones(1)), 2).round(6)
    array([-0.3+1.j, -0.3-1.j])
    """
    h, dt = _samples(target, n)
    a = _inside(_predictor(h, n))
    best = (np.inf, a)
    for _ in range(_ITERATIONS):
        cost, new = _steiglitz_mcbride(h, a)
        if cost < best[0]:
            best = (cost, a)
        if np.abs(new - a).max() < 1e-10:
            break
        a = _inside(new)
    return _continuous(np.roots(best[1]), dt)


def _samples(target: Impulse, n: int) -> tuple[Array, float]:
    """Samples (n_t, n_c) of the couplings that are not zero, each divided by its root mean square, and their time step."""
    dt = float(target.t[1])
    every = max(1, min(int(np.pi / (_NYQUIST * target.omega_max * dt)), (len(target.t) - 1) // (_LEAST_SAMPLES * n)))
    h = target.K[::every][:, ~negligible(target.K)]
    return h / np.sqrt((h**2).mean(axis=0)), dt * every


def _predictor(h: Array, n: int) -> Array:
    """Denominator of the linear prediction, all couplings together."""
    columns = np.stack([h[n - k : len(h) - k].ravel() for k in range(n + 1)], axis=1)
    return np.concatenate([[1.0], np.linalg.lstsq(columns[:, 1:], -columns[:, 0], rcond=None)[0]])


def _steiglitz_mcbride(h: Array, a: Array) -> tuple[float, Array]:
    """Error of the fit with denominator a, numerators optimal, and the next denominator."""
    n, N = len(a) - 1, len(h)
    pulse = np.zeros((N, 1))
    pulse[0] = 1.0
    filtered = scipy.linalg.solve_banded((n, 0), np.repeat(a[:, None], N, axis=1), np.hstack([h, pulse]))
    lagged = np.zeros((n + 1, N, h.shape[1] + 1))
    for k in range(n + 1):
        lagged[k, k:] = filtered[: N - k]
    Q = np.linalg.qr(lagged[:n, :, -1].T)[0]
    M = lagged[:, :, :-1].transpose(2, 1, 0)
    M = (M - Q @ (Q.T @ M)).reshape(-1, n + 1)  # numerators eliminated
    return float(((M @ a) ** 2).sum()), np.concatenate([[1.0], np.linalg.lstsq(M[:, 1:], -M[:, 0], rcond=None)[0]])


def _inside(a: Array) -> Array:
    """Denominator with its roots mirrored into the unit circle."""
    z = np.roots(a)
    return np.poly(np.where(np.abs(z) > _UNIT, _UNIT * z / np.abs(z) / np.maximum(np.abs(z), 1.0), z)).real


def _continuous(z: Array, dt: float) -> Array:
    """Poles log(z)/dt; a negative real z, which no single pole has, goes to a fast real pole by the bilinear map."""
    z = np.where(np.abs(z) < 1e-9, 1e-9, z).astype(complex)
    alone = (z.imag == 0.0) & (z.real < 0.0)
    return stable(np.where(alone, 2 / dt * (z - 1) / (z + 1), np.log(z) / dt))
