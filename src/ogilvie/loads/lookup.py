"""Look-up in equally spaced tables inside the time loop. Kernel."""

from math import floor
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[Any]

_INLINE: Any = njit(cache=True, nogil=True)


def periodic_spline(values: Array) -> Array:
    """Return the coefficients (..., n) of the cubic B-spline through periodic values (..., n), for :func:`periodic_value`.

    Notes
    -----
    (c_{i-1} + 4 c_i + c_{i+1})/6 = y_i, solved by FFT.

    Examples
    --------
    >>> y = np.array([1.0, 3.0, 2.0, 5.0, 4.0])
    >>> c = periodic_spline(y)
    >>> [round(periodic_value(c, s), 12) for s in (0.0, 3.0, 8.0, -1.0)]
    [1.0, 5.0, 5.0, 4.0]
    """
    n = np.shape(values)[-1]
    response = (2.0 + np.cos(2.0 * np.pi * np.arange(n // 2 + 1) / n)) / 3.0
    return np.fft.irfft(np.fft.rfft(values, axis=-1) / response, n=n, axis=-1)


@_INLINE
def periodic_value(c, s):
    """Return the value of a periodic cubic B-spline with coefficients c (n,) at the place s, in steps (any real number)."""
    n = len(c)
    turns = floor(s / n)
    s -= turns * n
    i = min(max(int(s), 0), n - 1)
    x = s - i
    below = c[i - 1] if i > 0 else c[n - 1]
    above = c[i + 1] if i + 1 < n else c[i + 1 - n]
    further = c[i + 2] if i + 2 < n else c[i + 2 - n]
    y = 1.0 - x
    near = (4.0 - 3.0 * x * x * (2.0 - x)) * c[i] + (4.0 - 3.0 * y * y * (2.0 - y)) * above
    return (y * y * y * below + near + x * x * x * further) / 6.0


@_INLINE
def cubic_value(c, at, x):
    """Return c0 + c1 x + c2 x^2 + c3 x^3 with c0 at the place `at` of the flat array c."""
    return c[at] + x * (c[at + 1] + x * (c[at + 2] + x * c[at + 3]))
