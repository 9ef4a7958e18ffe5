"""Weights of the fluid memory's convolution: the kernel integrated exactly against a piecewise cubic velocity."""

from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)

START = 8  # number of steps after a start from rest whose history needs weights of its own
_CORRECTED = 4  # number of first velocities that the start changes the weight of


class Kernel(Protocol):
    """K (n_t, m, m) on uniform times t from 0, with the cubic spline through it; zero after its last time."""

    @property
    def t(self) -> Array: ...

    @property
    def K(self) -> Array: ...

    @property
    def spline(self) -> Any: ...


def lag_weights(kernel: Kernel, dt: float, offset: float, intervals: int) -> Array:
    """Return W (intervals + 1, m, m) such that int_0^{intervals dt} K(s + offset dt) nu(t - s) ds = sum_l W_l nu(t - l dt).

    Parameters
    ----------
    kernel : Kernel
        A Retardation, or what a load hands to the time loop.
    dt : float
        Step between the stored velocities, s.
    offset : float
        How far after the last stored velocity the integral is wanted, in steps.
    intervals : int
        Number of steps that the history goes back, >= 0.

    Notes
    -----
    Between two stored velocities nu is the cubic through the four nearest ones (fewer where there are not as many), so the
    weights are fourth-order accurate however quickly K varies; K is a cubic spline, integrated by Gauss-Legendre.

    Examples
    --------
    >>> from ogilvie.memory.table import Retardation
    >>> t = np.linspace(0.0, 4.0, 41)
    >>> one = Retardation(t, np.ones((41, 1, 1)), np.zeros((1, 1)), ("heave",))
    >>> lag_weights(one, 0.5, 0.0, 3)[:, 0, 0].round(4)  # Simpson's 3/8 rule
    array([0.1875, 0.5625, 0.5625, 0.1875])
    """
    n, m = int(intervals), kernel.K.shape[1]
    W = np.zeros((n + 1, m, m))
    if n == 0:
        return W
    points = min(4, n + 1)
    first = np.clip(np.arange(n) - (points // 2 - 1), 0, n + 1 - points)  # of the points used on each interval
    moment = _moments(kernel, dt, offset, n, points)  # (n, points, m, m), of the local variable powers
    for start in np.unique(first - np.arange(n)):
        at = np.flatnonzero(first - np.arange(n) == start)
        basis = _lagrange(np.arange(points) + start)  # (points, powers)
        part = np.einsum("qp,apij->aqij", basis, moment[at])
        for q in range(points):
            np.add.at(W, first[at] + q, part[:, q])
    return W


def start_factors() -> Array:
    """Return the factors (4,) of the first four velocities after a start from rest, once START steps have gone by.

    Notes
    -----
    The weights of a long history belong to a velocity that goes on before the start. K nu begins there with a jump, so the sum
    over it needs an end correction of fourth order: that of a constant kernel, by which K nu is integrated as one function.
    """
    from scipy.interpolate import CubicSpline

    t = np.linspace(0.0, 20.0, 21)
    K = np.ones((21, 1, 1))
    return np.ascontiguousarray(lag_weights(_Table(t, K, CubicSpline(t, K, axis=0)), 1.0, 0.0, 20)[:_CORRECTED, 0, 0])


class _Table(NamedTuple):
    t: Array
    K: Array
    spline: Any


def _lagrange(x: Array) -> Array:
    """Coefficients (point, power) of the Lagrange polynomials through the points x."""
    return np.linalg.inv(np.vander(x.astype(float), increasing=True)).T


def _moments(kernel: Kernel, dt: float, offset: float, n: int, powers: int) -> Array:
    """Return int_0^1 K((j + x + offset) dt) x^p dx dt for the intervals j and the powers p, (n, powers, m, m)."""
    end = kernel.t[-1]
    pieces = 2 * max(1, int(np.ceil(0.5 * dt / (kernel.t[1] - kernel.t[0]))))
    spline = kernel.spline
    out = np.zeros((n, powers, *kernel.K.shape[1:]))
    j = np.arange(n)[:, None]
    for piece in range(pieces):
        x = (piece + 0.5 * (_NODES + 1.0)) / pieces
        s = (j + x + offset) * dt
        K = np.where((s <= end * (1 + 1e-12))[..., None, None], spline(np.minimum(s, end)), 0.0)
        weight = (0.5 * _WEIGHTS * dt / pieces)[:, None] * x[:, None] ** np.arange(powers)
        out += np.einsum("gp,jgab->jpab", weight, K)
    return out
