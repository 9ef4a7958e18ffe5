"""The added mass at infinite frequency from Ogilvie's relation, averaged over the frequencies by confidence."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.curves import RadiationCurves
from ogilvie.memory.fourier import fourier_integral, legendre_pieces
from ogilvie.memory.kernel_errors import Doubts

Array = NDArray[Any]

_FLOOR = 1e-3  # of the range of A: no frequency is trusted further
_OUTLIER = 2.0  # standard deviations from which on a frequency counts by its distance, not its square
_ROUNDS = 30
_NOTHING = 1e-200  # keeps couplings that are zero from dividing zero by zero


def infinite_added_mass(curves: RadiationCurves, t: Array, K: Array, doubts: Doubts) -> Array:
    """Return A_inf (m, m) from the added mass and the retardation functions.

    Parameters
    ----------
    curves : RadiationCurves
    t : (n_t,) array
    K : (n_t, m, m) array
        From the damping.
    doubts : Doubts
        Of K.

    Notes
    -----
    Each frequency gives a(omega) = A(omega) + (1/omega) int_0^T K(t) sin(omega t) dt, which would be A_inf at all of them
    were the data perfect. Its variance is taken as the sum of squares of what it changes by with another interpolation of
    B, with another tail of B, of max |K(t > T)|/omega^2 (the part of the integral left out), and of 0.1 % of the range of
    A. The mean has the weight d_omega/variance, and Huber's factor min(1, 2 sigma/|a - mean|), iterated, for frequencies
    whose added mass is off for other reasons. Low frequencies so count little where K is cut short, the highest ones
    little where the tail is in doubt, and a narrow peak of B little where it is not resolved.

    References
    ----------
    Ogilvie (1964). Huber (1964), Ann. Math. Stat. 35(1), 73-101.
    """
    omega = curves.omega
    a = curves.A + _sine(t, K, omega)
    variance = (_FLOOR * np.ptp(curves.A, axis=0)) ** 2 + _NOTHING
    for change in (*doubts.tails, doubts.interpolation):
        variance = variance + _sine(t, change, omega) ** 2
    variance = variance + (doubts.later / omega[:, None, None] ** 2) ** 2
    return _robust_mean(a, np.gradient(omega)[:, None, None] / variance, np.sqrt(variance))


def _sine(t: Array, K: Array, omega: Array) -> Array:
    """Return (1/omega) int K(t) sin(omega t) dt (n_w, m, m) of the table."""
    return fourier_integral(t, legendre_pieces(t, K, "spline"), omega).imag / omega[:, None, None]


def _robust_mean(a: Array, weight: Array, deviation: Array) -> Array:
    """Weighted mean over the first axis in which outliers count by their distance."""
    weight = weight / weight.max(axis=0)
    mean = (weight * a).sum(axis=0) / weight.sum(axis=0)
    for _ in range(_ROUNDS):
        w = weight / np.maximum(1.0, np.abs(a - mean) / (_OUTLIER * deviation))
        mean = (w * a).sum(axis=0) / w.sum(axis=0)
    return mean
