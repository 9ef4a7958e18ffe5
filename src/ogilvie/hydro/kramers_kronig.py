"""Kramers-Kronig: what the damping says about the added mass of a causal body."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_JUDGED_UP_TO = 0.8  # of the last frequency; closer to it the unknown damping beyond dominates
_FINE = 3000  # points of the smooth interpolant, at least
_TAIL_POWERS = (2.0, 6.0)  # slow and fast decay between which the tail beyond the data is fitted


def kramers_kronig_matrix(omega: Array, at: Array) -> Array:
    """Return the matrix H (m, n) that turns the damping at `omega` into A - A_inf at other frequencies.

    Parameters
    ----------
    omega : (n,) array
        rad/s, ascending; the damping is linear between them and zero outside, so it should start and end with 0.
    at : (m,) array
        Frequencies w > 0, rad/s; may coincide with `omega` except where B jumps (its last point, unless B is 0 there).

    Returns
    -------
    (m, n) array
        ``H @ B`` is A(w) - A_inf less the part of the damping beyond the data.

    Notes
    -----
    A(w) - A_inf = (2/pi) PV int_0^inf B(s)/(s^2 - w^2) ds, exact for piecewise linear B: int B/(s - w) ds = B_n - B_1 + sum_j
    B_j(w) [ln|s_(j+1) - w| - ln|s_j - w|], with B_j(w) the line of interval j at w. At a node the two logarithms cancel because
    B is continuous.

    References
    ----------
    Kotik and Mangulis (1962), Int. Shipbuilding Progress 9, 361-368; Ogilvie (1964), 5th Symposium on Naval Hydrodynamics.

    Examples
    --------
    >>> s = np.linspace(0.0, 60.0, 6001)
    >>> B = s**2 / (1 + s**2) ** 2  # A - A_inf = (1 - w^2)/(2 (1 + w^2)^2)
    >>> (kramers_kronig_matrix(s, np.array([0.5, 2.0])) @ B).round(3) + 0.0
    array([ 0.24, -0.06])
    """
    return (_one_sided(omega, at) - _one_sided(omega, -at)) / (np.pi * at[:, None])


def _one_sided(s: Array, w: Array) -> Array:
    """Return the matrix of the principal value of the integral of B/(s - w)."""
    distance = s[None, :] - w[:, None]
    at_node = distance == 0.0
    log = np.where(at_node, 0.0, np.log(np.abs(np.where(at_node, 1.0, distance))))
    step = np.diff(log, axis=1) / np.diff(s)
    H = np.zeros_like(distance)
    H[:, :-1] += step * distance[:, 1:]
    H[:, 1:] -= step * distance[:, :-1]
    H[:, 0] -= 1.0
    H[:, -1] += 1.0
    return H


@dataclass(frozen=True, eq=False)
class Mismatch:
    """How far m added-mass curves are from what their damping implies, as fractions of max \\|A - A_inf\\| of each.

    Parameters
    ----------
    residual : (n, m) array
        A - A_inf - A_from_B, less the fitted tail and constant; NaN where not judged.
    uncertainty : (n, m) array
        What the interpolation of B between its frequencies leaves open.
    tail : (n, m) array
        What the damping beyond the data leaves open: the distance between a slow and a fast decay.
    constant : (m,) array
        Fitted A_inf less the given one.
    """

    residual: Array
    uncertainty: Array
    tail: Array
    constant: Array


def mismatch(omega: Array, A: Array, B: Array, A_inf: Array, keep: NDArray[np.bool_]) -> Mismatch:
    """Compare entries of the added mass with what their damping implies.

    Parameters
    ----------
    omega : (n,) array
        rad/s, > 0.
    A, B : (n, m) array
        m entries.
    A_inf : (m,) array
        Added mass at infinite frequency; a constant off it is fitted.
    keep : (n,) bool array
        Frequencies to use; damaged ones are left out of the integral and are not judged.

    Returns
    -------
    Mismatch

    Notes
    -----
    B(0) = 0. Beyond the data B is taken as B(s_n) (s_n/s)^p; the share of slow (p = 2) and fast (p = 6) decay and the constant
    are fitted to the judged frequencies, up to 80 % of the last, by least absolute deviations: a few bad points do not move it.
    """
    from scipy.interpolate import PchipInterpolator

    w, a = omega[keep], A[keep] - A_inf
    b = np.concatenate([np.zeros((1, B.shape[1])), B[keep]])
    s = np.r_[0.0, w]
    fine = np.unique(np.r_[np.linspace(0.0, w[-1], max(_FINE, 4 * len(w))), w])
    judged = w < _JUDGED_UP_TO * w[-1]
    H = kramers_kronig_matrix(fine, w[judged])
    smooth = H @ PchipInterpolator(s, b)(fine)
    doubt = np.abs(smooth - kramers_kronig_matrix(s, w[judged]) @ b)
    for first in (0, 1):  # every second frequency left out: four times the error
        some = np.unique(np.r_[0, np.arange(first, len(s), 2), len(s) - 1])
        doubt = np.maximum(doubt, 0.25 * np.abs(smooth - H @ PchipInterpolator(s[some], b[some])(fine)))
    scale = np.abs(a).max(axis=0)
    scale = np.where(scale > 0.0, scale, 1.0)
    slow, fast = (np.outer(_tail(w[judged], w[-1], p), b[-1]) for p in _TAIL_POWERS)
    raw, spread = (a[judged] - smooth - fast) / scale, (slow - fast) / scale
    fits = np.array([_robust_fit(x, y) for x, y in zip(spread.T, raw.T, strict=True)])  # (m, 2)
    residual, uncertainty, tail = (np.full(A.shape, np.nan) for _ in range(3))
    place = np.flatnonzero(keep)[judged]
    residual[place] = raw - fits[:, 0] * spread - fits[:, 1]
    uncertainty[place] = doubt / scale
    tail[place] = np.abs(spread)
    return Mismatch(residual, uncertainty, tail, fits[:, 1])


def _robust_fit(x: Array, y: Array) -> tuple[float, float]:
    """Return p within 0..1 and c of y = p x + c in the sense of least absolute deviations (reweighted least squares)."""
    p, c = 0.0, float(np.median(y))
    for _ in range(30):
        weight = 1.0 / np.maximum(np.abs(y - p * x - c), 1e-4)
        x_mean, y_mean = np.average(x, weights=weight), np.average(y, weights=weight)
        spread = np.sum(weight * (x - x_mean) ** 2)
        slope = np.sum(weight * (x - x_mean) * (y - y_mean)) / spread if spread > 0.0 else 0.0
        p = float(np.clip(slope, 0.0, 1.0))
        c = float(y_mean - p * x_mean)
    return p, c


def _tail(w: Array, last: float, p: float) -> Array:
    """Return (2/pi) times the integral of (last/s)^p/(s^2 - w^2) from `last` to infinity, by a series in (w/last)^2 < 1."""
    x = (w / last) ** 2
    terms = np.arange(400)
    return 2.0 / (np.pi * last) * np.sum(x[:, None] ** terms / (p + 1.0 + 2.0 * terms), axis=1)
