"""Polynomials through Chebyshev points: places, interpolation, derivatives (plain arrays in, plain arrays out)."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def chebyshev_points(count: int) -> Array:
    """Return the points -cos(pi i/(count - 1)), i = 0..count-1, of [-1, 1], ends included.

    Examples
    --------
    >>> chebyshev_points(3).round(12).tolist()
    [-1.0, 0.0, 1.0]
    """
    return np.asarray(np.sin(0.5 * np.pi * np.linspace(-1.0, 1.0, count)))


def interpolation(count: int, x: ArrayLike) -> Array:
    """Return the matrix (n, count) from values at `count` Chebyshev points to those of the polynomial through them at x (n,).

    Notes
    -----
    Barycentric formula, weights (-1)^i, halved at the ends.

    References
    ----------
    Berrut and Trefethen (2004), Barycentric Lagrange interpolation, SIAM Review 46(3), Eq. (4.2) and section 5.

    Examples
    --------
    >>> (interpolation(4, [0.3]) @ chebyshev_points(4) ** 3).round(12).tolist()
    [0.027]
    """
    nodes, at = chebyshev_points(count), np.asarray(x, dtype=float)
    weights = np.where(np.arange(count) % 2 == 0, 1.0, -1.0)
    weights[[0, -1]] *= 0.5
    gap = at[:, None] - nodes
    exact = np.abs(gap) < 1e-14
    terms = weights / np.where(exact, 1.0, gap)
    rows = terms / terms.sum(axis=1, keepdims=True)
    hit = exact.any(axis=1)
    rows[hit] = np.where(exact[hit], 1.0, 0.0)
    return rows


def differentiation(count: int) -> Array:
    """Return the matrix (count, count) from values at Chebyshev points to the derivative of their polynomial there.

    References
    ----------
    Berrut and Trefethen (2004), section 9.3.

    Examples
    --------
    >>> (differentiation(4) @ chebyshev_points(4) ** 3 - 3.0 * chebyshev_points(4) ** 2).round(12).tolist()
    [0.0, 0.0, 0.0, 0.0]
    """
    nodes = chebyshev_points(count)
    weights = np.where(np.arange(count) % 2 == 0, 1.0, -1.0)
    weights[[0, -1]] *= 0.5
    gap = nodes[:, None] - nodes + np.eye(count)
    D = weights[None, :] / weights[:, None] / gap
    np.fill_diagonal(D, 0.0)
    np.fill_diagonal(D, -D.sum(axis=1))
    return D
