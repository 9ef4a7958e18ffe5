"""Exact Fourier integrals of piecewise polynomials (Filon): the one tool behind every transform between B and K."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline
from scipy.special import spherical_jn

from ogilvie.errors import InputError

Array = NDArray[Any]

INTERPOLATIONS = ("linear", "spline")

# Monomials 1, u, u^2, u^3 on [-1, 1] in Legendre polynomials P0..P3 (rows: monomials).
_LEGENDRE = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [1 / 3, 0, 2 / 3, 0], [0, 3 / 5, 0, 2 / 5]])


def legendre_pieces(x: Array, f: Array, interpolation: str = "linear") -> Array:
    """Return Legendre coefficients (n - 1, d, ...) of the interpolant of f(x) on each interval of x.

    Parameters
    ----------
    x : (n,) array
        Ascending.
    f : (n, ...) array
    interpolation : {"linear", "spline"}
        d = 2 or, for the not-a-knot cubic spline, d = 4.
    """
    if interpolation == "linear" or len(x) < 4:
        return np.stack([(f[:-1] + f[1:]) / 2, (f[1:] - f[:-1]) / 2], axis=1)
    if interpolation != "spline":
        raise InputError(f"interpolation: one of {INTERPOLATIONS} expected, {interpolation!r} found.")
    power = CubicSpline(x, f, axis=0).c[::-1]  # (4, n-1, ...), powers of (x - x_k)
    h = (np.diff(x) / 2).reshape((-1,) + (1,) * (f.ndim - 1))
    # (x - x_k) = h (u + 1)
    a0, a1, a2, a3 = power[0], power[1] * h, power[2] * h**2, power[3] * h**3
    monomials = np.stack([a0 + a1 + a2 + a3, a1 + 2 * a2 + 3 * a3, a2 + 3 * a3, a3], axis=1)
    return np.einsum("kd...,de->ke...", monomials, _LEGENDRE)


def fourier_integral(x: Array, pieces: Array, s: ArrayLike) -> NDArray[np.complex128]:
    """Return int f(x) exp(i s x) dx, shape (n_s, ...), of a function given by :func:`legendre_pieces`.

    Notes
    -----
    On each interval of half-width h and centre c: int_{-1}^{1} P_n(u) exp(i theta u) du = 2 i^n j_n(theta), theta = s h. No
    cancellation for any s.

    Examples
    --------
    >>> x = np.linspace(0.0, 1.0, 3)
    >>> F = fourier_integral(x, legendre_pieces(x, x), [0.0, 2.0])
    >>> [round(float(v), 6) for v in F.real]  # int x dx and int x cos 2x dx
    [0.5, 0.100612]
    """
    s = np.atleast_1d(np.asarray(s, dtype=float))
    h, c = np.diff(x) / 2, (x[:-1] + x[1:]) / 2
    flat = pieces.reshape(pieces.shape[0], pieces.shape[1], -1)
    total = np.zeros((len(s), flat.shape[2]), dtype=complex)
    block = max(1, 2_000_000 // len(h))
    for start in range(0, len(s), block):
        part = slice(start, start + block)
        theta = np.outer(s[part], h)
        carrier = 2 * h * np.exp(1j * np.outer(s[part], c))
        for n in range(flat.shape[1]):
            total[part] += (carrier * (1j**n * spherical_jn(n, theta))) @ flat[:, n]
    return total.reshape((len(s),) + pieces.shape[2:])
