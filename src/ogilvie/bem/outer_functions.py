"""Functions of the depth on the control hemisphere: orthonormal polynomials with a root at the pole, Legendre functions."""

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError

Array = NDArray[Any]

_ROUNDING = 1e-9  # of points on the hemisphere


def depth_functions(m: int, x: Array, count: int) -> Array:
    """Return the first depth functions y_mj of azimuthal mode m: (1 - x^2)^(m/2) times polynomials of degree j.

    Parameters
    ----------
    m : int
        Azimuthal mode, cos(m alpha) or sin(m alpha) in the azimuth.
    x : (n,) array
        cos(theta) = -z / Rc, 0 at the waterline and 1 at the lowest point.
    count : int
        J, number of functions.

    Returns
    -------
    (count, n) array
        Orthonormal: the integral of y_mj y_mk from x = 0 to 1 is 1 for j = k, else 0. Positive at x = 1 but for the root.

    Notes
    -----
    With p_j of degree j orthonormal on [0, 1] under the weight (1 - x^2)^m,

        y_mj = (1 - x^2)^(m/2) p_j,   sqrt(b_(j+1)) p_(j+1) = (x - a_j) p_j - sqrt(b_j) p_(j-1).

    Both parities in x are needed: neither the even functions (zero frequency) nor the odd ones (infinite frequency) suffice
    in between. For m = 0 they are sqrt(2j + 1) P_j(2x - 1).

    Examples
    --------
    >>> depth_functions(0, np.array([0.0, 0.5, 1.0]), 2).round(6)
    array([[ 1.      ,  1.      ,  1.      ],
           [-1.732051,  0.      ,  1.732051]])
    """
    x = np.asarray(x, dtype=float)
    if m < 0 or count < 1 or x.ndim != 1:
        raise InputError(f"depth_functions: m >= 0, count >= 1 and x (n,) expected, {m}, {count} and {x.shape} found.")
    if not np.all(np.abs(x - 0.5) <= 0.5 + _ROUNDING):
        raise InputError(f"depth_functions: x = -z / Rc within 0..1 expected, {x.min():g} to {x.max():g} found.")
    x = np.clip(x, 0.0, 1.0)
    a, root_b, first = _recurrence(m, count)
    y = np.empty((count, len(x)))
    y[0] = first * (1.0 - x * x) ** (m / 2)
    for j in range(count - 1):
        y[j + 1] = (x - a[j]) * y[j]
        if j:
            y[j + 1] -= root_b[j - 1] * y[j - 1]
        y[j + 1] /= root_b[j]
    return y


def depth_taylor(m: int, count: int) -> Array:
    """Return the coefficients (J, J) of x^i in the polynomials y_mj / (1 - x^2)^(m/2).

    Examples
    --------
    >>> depth_taylor(0, 2).round(6)
    array([[ 1.      ,  0.      ],
           [-1.732051,  3.464102]])
    """
    a, root_b, first = _recurrence(m, count)
    p = np.zeros((count, count))
    p[0, 0] = first
    for j in range(count - 1):
        p[j + 1, 1:] = p[j, :-1]
        p[j + 1] -= a[j] * p[j] + (root_b[j - 1] * p[j - 1] if j else 0.0)
        p[j + 1] /= root_b[j]
    return p


@cache
def _recurrence(m: int, count: int) -> tuple[Array, Array, float]:
    """Coefficients a_j, sqrt(b_(j+1)) and the first function's factor, by Stieltjes' procedure on Gauss points."""
    x, w = gauss(m + count + 1)
    y = (1.0 - x * x) ** (m / 2)
    first = float(1.0 / np.sqrt(w @ y**2))
    y, before = first * y, np.zeros_like(y)
    a, root_b = np.zeros(count), np.zeros(count)
    for j in range(count):
        a[j] = w @ (x * y * y)
        new = (x - a[j]) * y - (root_b[j - 1] if j else 0.0) * before
        root_b[j] = np.sqrt(w @ new**2)
        before, y = y, new / root_b[j]
    return a, root_b, first


def gauss(n: int) -> tuple[Array, Array]:
    """Return Gauss-Legendre points and weights (n,) on [0, 1].

    Examples
    --------
    >>> x, w = gauss(3)
    >>> round(float(w @ x**5), 12)
    0.166666666667
    """
    x, w = np.polynomial.legendre.leggauss(n)
    return (x + 1.0) / 2, w / 2


def legendre(m: int, x: Array, top: int) -> Array:
    """Return P_l^m(x) / norm for l = m..top, shape (top - m + 1, n), with unit square integral over 0..1.

    Functions whose degrees differ by an even number are orthonormal on [0, 1]. Without the sign (-1)^m.

    Examples
    --------
    >>> float(legendre(0, np.array([1.0]), 2)[2, 0] ** 2)  # 2 l + 1
    5.0...
    """
    x = np.asarray(x, dtype=float)
    l = np.arange(m, top + 1, dtype=float)
    P = np.empty((len(l), len(x)))
    P[0] = np.sqrt(2 * m + 1) * np.prod([np.sqrt((2 * i - 1) / (2 * i)) for i in range(1, m + 1)]) * (1 - x * x) ** (m / 2)
    if len(l) > 1:
        P[1] = np.sqrt(2 * m + 3) * x * P[0]
    for i in range(2, len(l)):
        a, b = _step(l[i], m)
        P[i] = a * x * P[i - 1] - b * P[i - 2]
    return P


def legendre_at_surface(m: int, top: int) -> tuple[Array, Array]:
    """Return the values and the slopes of :func:`legendre` at x = 0, for l = m..top; one of the two is zero for each l.

    Examples
    --------
    >>> value, slope = legendre_at_surface(0, 3)
    >>> float(value[2]), float(slope[1])  # -sqrt(5) / 2, sqrt(3)
    (-1.1180..., 1.7320...)
    """
    l = np.arange(m, top + 1, dtype=float)
    value, slope = np.zeros(len(l)), np.zeros(len(l))
    value[0] = legendre(m, np.zeros(1), m)[0, 0]
    for i in range(2, len(l)):
        value[i] = -_step(l[i], m)[1] * value[i - 2]
    slope[1:] = np.sqrt((2 * l[1:] + 1) / (2 * l[1:] - 1) * (l[1:] - m) * (l[1:] + m)) * value[:-1]
    return value, slope


def _step(l: float, m: int) -> tuple[float, float]:
    """Coefficients of P_l = a x P_(l-1) - b P_(l-2) for the normalised functions."""
    a = np.sqrt((4 * l * l - 1) / ((l - m) * (l + m)))
    b = np.sqrt((2 * l + 1) * (l + m - 1) * (l - m - 1) / ((2 * l - 3) * (l - m) * (l + m)))
    return float(a), float(b)
