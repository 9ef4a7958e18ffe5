"""Tricubic spline on a uniform grid: coefficients here, value and gradient in compiled code (kernel)."""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[Any]


def coefficients(values: Array) -> Array:
    """Return the B-spline coefficients (n1 + 2, n2 + 2, n3 + 2) of the cubic spline through values (n1, n2, n3), n >= 5.

    Notes
    -----
    Along each axis (c_i-1 + 4 c_i + c_i+1) / 6 = f_i, and no jump of the third derivative one step from either end.

    Examples
    --------
    >>> x = np.arange(6.0)
    >>> cube = x[:, None, None] ** 3 + 0 * x[:, None] + 0 * x
    >>> value, d1, d2, d3 = evaluate(coefficients(cube), 2.5, 1.0, 1.0)
    >>> round(value, 9), round(d1, 9), round(abs(d2), 9)  # a cubic is met exactly
    (15.625, 18.75, 0.0)
    """
    c = np.asarray(values, dtype=float)
    for axis in range(c.ndim):
        n = c.shape[axis]
        A = np.zeros((n + 2, n + 2))
        A[0, :5] = A[-1, -5:] = [1.0, -4.0, 6.0, -4.0, 1.0]
        for i in range(n):
            A[i + 1, i : i + 3] = [1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0]
        f = np.moveaxis(c, axis, 0)
        b = np.zeros((n + 2, *f.shape[1:]))
        b[1:-1] = f
        solved = np.linalg.solve(A, b.reshape(n + 2, -1)).reshape(b.shape)
        c = np.moveaxis(solved, 0, axis)
    return np.ascontiguousarray(c)


@njit(cache=True, nogil=True)
def weights(s: float, w: Array, d: Array) -> None:
    """Write the four B-spline weights of a place s in [0, 1] of a cell, and their derivatives."""
    r = 1.0 - s
    w[0], w[3] = r * r * r / 6.0, s * s * s / 6.0
    w[1] = (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0
    w[2] = (4.0 - 6.0 * r * r + 3.0 * r * r * r) / 6.0
    d[0], d[3] = -0.5 * r * r, 0.5 * s * s
    d[1], d[2] = -2.0 * s + 1.5 * s * s, 2.0 * r - 1.5 * r * r


@njit(cache=True, nogil=True)
def evaluate(c: Array, x: float, y: float, z: float) -> tuple[float, float, float, float]:
    """Return value and derivatives at a place in units of the grid, 0 .. n - 1 each; NaN outside."""
    n1, n2, n3 = c.shape[0] - 2, c.shape[1] - 2, c.shape[2] - 2
    if not (0.0 <= x <= n1 - 1 and 0.0 <= y <= n2 - 1 and 0.0 <= z <= n3 - 1):
        return np.nan, np.nan, np.nan, np.nan
    i, j, k = min(int(x), n1 - 2), min(int(y), n2 - 2), min(int(z), n3 - 2)
    w = np.empty((3, 4))
    d = np.empty((3, 4))
    weights(x - i, w[0], d[0])
    weights(y - j, w[1], d[1])
    weights(z - k, w[2], d[2])
    value = dx = dy = dz = 0.0
    for a in range(4):
        va = da = ea = 0.0
        for b in range(4):
            vb = db = 0.0
            for e in range(4):
                q = c[i + a, j + b, k + e]
                vb += w[2, e] * q
                db += d[2, e] * q
            va += w[1, b] * vb
            da += d[1, b] * vb
            ea += w[1, b] * db
        value += w[0, a] * va
        dx += d[0, a] * va
        dy += w[0, a] * da
        dz += w[0, a] * ea
    return value, dx, dy, dz
