"""Weights of the fluid memory's convolution: the kernel integrated exactly against a piecewise cubic velocity."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.loads.base import MemoryKernel
from ogilvie.memory.fourier import fourier_integral, legendre_pieces

Array = NDArray[Any]
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)


def lag_weights(kernel: MemoryKernel, dt: float, offset: float, intervals: int) -> Array:
    """Return W (intervals + 1, 6, 6) such that int_0^{intervals dt} K(s + offset dt) nu(t - s) ds = sum_l W_l nu(t - l dt).

    Parameters
    ----------
    kernel : MemoryKernel
        Zero after its last time.
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
    """
    n = int(intervals)
    W = np.zeros((n + 1, 6, 6))
    if n == 0:
        return W
    points = min(4, n + 1)
    first = np.clip(np.arange(n) - (points // 2 - 1), 0, n + 1 - points)  # of the points used on each interval
    moment = _moments(kernel, dt, offset, n, points)  # (n, points, 6, 6), of the local variable powers
    for start in np.unique(first - np.arange(n)):
        at = np.flatnonzero(first - np.arange(n) == start)
        basis = _lagrange(np.arange(points) + start)  # (points, powers)
        part = np.einsum("qp,apij->aqij", basis, moment[at])
        for q in range(points):
            np.add.at(W, first[at] + q, part[:, q])
    return W


def _lagrange(x: Array) -> Array:
    """Coefficients (point, power) of the Lagrange polynomials through the points x."""
    return np.linalg.inv(np.vander(x.astype(float), increasing=True)).T


def _moments(kernel: MemoryKernel, dt: float, offset: float, n: int, powers: int) -> Array:
    """Return int_0^1 K((j + x + offset) dt) x^p dx dt for the intervals j and the powers p, (n, powers, 6, 6)."""
    end = kernel.t[-1]
    pieces = 2 * max(1, int(np.ceil(0.5 * dt / (kernel.t[1] - kernel.t[0]))))
    spline = kernel.spline
    out = np.zeros((n, powers, 6, 6))
    j = np.arange(n)[:, None]
    for piece in range(pieces):
        x = (piece + 0.5 * (_NODES + 1.0)) / pieces
        s = (j + x + offset) * dt
        K = np.where((s <= end * (1 + 1e-12))[..., None, None], spline(np.minimum(s, end)), 0.0)
        weight = (0.5 * _WEIGHTS * dt / pieces)[:, None] * x[:, None] ** np.arange(powers)
        out += np.einsum("gp,jgab->jpab", weight, K)
    return out


def kernel_transform(kernel: MemoryKernel, omega: Array) -> NDArray[np.complex128]:
    """Return K_hat(i omega) = int_0^T K(t) exp(-i omega t) dt (n, 6, 6) of the same cubic spline that the time loop uses."""
    return np.conj(fourier_integral(kernel.t, legendre_pieces(kernel.t, kernel.K, "spline"), omega))
