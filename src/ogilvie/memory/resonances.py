"""Resonances of the free-floating body: where damping, not inertia or restoring, decides what happens."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.interpolate
import scipy.linalg
from numpy.typing import NDArray

Array = NDArray[Any]

_LEAST_DAMPING = 5e-4  # of critical, added to the radiation damping that an error is compared with
_LEAST_WIDTH = 5e-3  # of critical, added to it where an error of the natural frequency is compared with the width


@dataclass(frozen=True, eq=False)
class Resonances:
    """Undamped natural frequencies of the floating body within the data, and what an error of K_hat does there.

    Attributes
    ----------
    omega : (n_r,) array
        Natural frequencies, rad/s.
    shape : (n_r, m) array
        Modes phi.
    A, B : (n_r, m, m) array
        Added mass and damping, interpolated.
    damping, width : (n_r,) array
        phi^T dB phi over `damping` (plus what is uncertain of it) is the relative error of the decay, omega phi^T dA phi over
        `width` that of the natural frequency in half bandwidths.
    """

    omega: Array
    shape: Array
    A: Array
    B: Array
    damping: Array
    width: Array

    def project(self, E: Array) -> Array:
        """Return phi^T E phi, (n_r, ...), of E (n_r, m, m, ...)."""
        return np.einsum("ki,kij...,kj->k...", self.shape, E, self.shape)

    def relative(self, E: Array) -> Array:
        """Return the relative errors of damping and of frequency (2 n_r, ...) for errors E of K_hat (n_r, m, m, ...)."""
        e = self.project(E)
        tail = (1,) * (e.ndim - 1)
        return np.concatenate([e.real / self.damping.reshape(-1, *tail), e.imag / self.width.reshape(-1, *tail)])


def find_resonances(omega: Array, A: Array, B: Array, mass: Array, stiffness: Array) -> Resonances:
    """Return the resonances of a body in the range of the frequencies; A and B are cubic splines, B(0) = 0.

    Parameters
    ----------
    omega : (n_w,) array
    A, B : (n_w, m, m) array
    mass, stiffness : (m, m) array

    Notes
    -----
    A natural frequency is where a branch of det[C - w^2 (M + A(w))] = 0 crosses: w_i(w)^2 - w^2 changes its sign from above to
    below, with w_i^2 the i-th eigenvalue of (C, M + A(w)).

    Examples
    --------
    >>> w = np.linspace(0.1, 2.0, 20)
    >>> one = np.ones((20, 1, 1))
    >>> r = find_resonances(w, one, 0.1 * w[:, None, None] * one, np.eye(1), 2 * np.eye(1))
    >>> r.omega.round(6), r.B[0, 0, 0].round(3)
    (array([1.]), np.float64(0.1))
    """
    at_zero = np.concatenate([np.zeros((1,) + B.shape[1:]), B])
    spline_A = scipy.interpolate.CubicSpline(omega, A)
    spline_B = scipy.interpolate.CubicSpline(np.concatenate([[0.0], omega]), at_zero)
    C = (stiffness + stiffness.T) / 2

    def branches(w: float) -> Array:
        M = mass + spline_A(w)
        return scipy.linalg.eigh(C, (M + M.T) / 2, eigvals_only=True) - w**2

    try:
        excess = np.array([branches(w) for w in omega])
        found = []
        for k, i in zip(*np.nonzero((excess[:-1] >= 0.0) & (excess[1:] < 0.0)), strict=True):
            found.append((_crossing(branches, i, omega[k], omega[k + 1]), i))
        at = np.array([w for w, _ in found])
        pairs = [scipy.linalg.eigh(C, mass + (spline_A(w) + spline_A(w).T) / 2) for w in at]
    except np.linalg.LinAlgError:  # inertia not positive definite at some frequency: damaged data, no resonance to speak of
        found, at, pairs = [], np.zeros(0), []
    m = len(mass)
    shape = np.array([vectors[:, i] for (_, vectors), (_, i) in zip(pairs, found, strict=True)]).reshape(-1, m)
    A_at, B_at = spline_A(at).reshape(-1, m, m), spline_B(at).reshape(-1, m, m)
    between = scipy.interpolate.PchipInterpolator(spline_B.x, at_zero)(at).reshape(-1, m, m)
    damping, other = (np.einsum("ki,kij,kj->k", shape, x, shape) for x in (B_at, between))  # phi^T (M + A) phi is one
    damping, doubt = np.maximum(damping, 0.0), np.abs(damping - other) + _doubt(omega, B, at, shape)
    return Resonances(at, shape, A_at, B_at, damping + doubt + 2 * at * _LEAST_DAMPING, damping + 2 * at * _LEAST_WIDTH)


def _doubt(omega: Array, B: Array, at: Array, shape: Array) -> Array:
    """What interpolation may miss: midway between two frequencies a quarter of the step of the modal damping."""
    k = np.clip(np.searchsorted(omega, at) - 1, 0, len(omega) - 2)
    u = (at - omega[k]) / (omega[k + 1] - omega[k])
    step = np.abs(np.einsum("ki,kij,kj->k", shape, B[k + 1] - B[k], shape))
    return u * (1 - u) * step


def _crossing(branches: Any, i: int, low: float, high: float) -> float:
    """Bisect branch i between a frequency where it is positive and one where it is not."""
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if branches(middle)[i] >= 0.0 else (low, middle)
    return 0.5 * (low + high)
