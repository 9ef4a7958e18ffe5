"""Sides and four-sided blocks of curved panels: graded divisions, curves in pieces, transfinite interpolation."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ogilvie.mesh.chebyshev import chebyshev_points

Array = NDArray[np.float64]


def divisions(n: int, *, start: float = 1.0, end: float = 1.0) -> Array:
    """Return n + 1 values from 0 to 1 along a cubic with these slopes at its ends.

    Parameters
    ----------
    n : int
    start, end : float
        0: the steps there shrink as 1/n^2 (power-2 grading); 1 and 1: equal steps; 0 and 2: t = s^2.

    Examples
    --------
    >>> divisions(4, start=0.0, end=2.0).tolist(), divisions(2).tolist()
    ([0.0, 0.0625, 0.25, 0.5625, 1.0], [0.0, 0.5, 1.0])
    """
    s = np.linspace(0.0, 1.0, n + 1)
    return np.asarray(s**2 * (3.0 - 2.0 * s) + start * s * (1.0 - s) ** 2 - end * s**2 * (1.0 - s))


def places(breaks: Array, q: int) -> Array:
    """Return the q Chebyshev points of each of the intervals between breaks (n + 1,), as (n, q)."""
    half = 0.5 * (1.0 + chebyshev_points(q))
    out = breaks[:-1, None] + np.diff(breaks)[:, None] * half
    out[:, -1] = breaks[1:]  # the same number on both sides
    return np.asarray(out)


def arc(a: Array, b: Array) -> Callable[[Array], Array]:
    """Return the great circle through two unit vectors (3,): a function of t (...) in 0..1 to points (..., 3)."""
    angle = float(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))

    def at(t: Array) -> Array:
        t = np.asarray(t)[..., None]
        return np.asarray((np.sin((1.0 - t) * angle) * a + np.sin(t * angle) * b) / np.sin(angle))

    return at


def backwards(side: Array) -> Array:
    """Return a side (n, q, 3) run the other way."""
    return side[::-1, ::-1]


def block(bottom: Array, top: Array, left: Array, right: Array) -> Array:
    """Return panels (n_u n_v, q, q, axes) between four sides in pieces.

    Parameters
    ----------
    bottom, top : (n_u, q, axes) arrays
        Sides at v = 0 and 1, along u.
    left, right : (n_v, q, axes) arrays
        Sides at u = 0 and 1, along v; axes: 2 or 3 coordinates.

    Notes
    -----
    Transfinite interpolation (Coons) with the mean share of the length along the two sides as blending function: the sides
    of the panels on the border are the given ones.
    """
    nu, q, nv, axes = len(bottom), bottom.shape[1], len(left), bottom.shape[2]
    b, t, l, r = (side.reshape(-1, axes) for side in (bottom, top, left, right))
    u = 0.5 * (_share(b) + _share(t))[:, None, None]
    v = 0.5 * (_share(l) + _share(r))[None, :, None]
    ruled = (1 - v) * b[:, None] + v * t[:, None] + (1 - u) * l[None] + u * r[None]
    grid = ruled - (1 - u) * ((1 - v) * b[0] + v * t[0]) - u * ((1 - v) * b[-1] + v * t[-1])
    return np.asarray(grid.reshape(nu, q, nv, q, axes).transpose(0, 2, 1, 3, 4).reshape(nu * nv, q, q, axes))


def _share(points: Array) -> Array:
    """Return the share of the length of a polygon (n, axes) up to each of its points."""
    length = np.cumsum(np.r_[0.0, np.linalg.norm(np.diff(points, axis=0), axis=1)])
    return np.asarray(length / length[-1])


def turned(panels: Array) -> Array:
    """Return panels (n, q, q, 3) with the other side up."""
    return panels.swapaxes(1, 2)


def sides(panels: Array) -> Array:
    """Return the sides (n, 4, q, 3) of panels (n, q, q, 3): u = -1 and u = 1 along v, v = -1 and v = 1 along u."""
    return np.stack([panels[:, 0], panels[:, -1], panels[:, :, 0], panels[:, :, -1]], axis=1)
