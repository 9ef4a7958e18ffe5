"""Curved panels of the control hemisphere: spherical triangles from the circle at z = 0 to the lowest point."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.curves import arc, backwards, block, divisions, places
from ogilvie.mesh.smooth_shapes import facing

Array = NDArray[np.float64]

_SIDE = 0.25 * np.pi  #: depth angle where the patches at the circle end on the triangle's outer meridians, rad
_MIDDLE = np.arctan(np.sqrt(0.5))  #: and on the meridian in its middle (the corner of a cube)


def control_panels(azimuth: Array, *, depth: int, q: int) -> Array:
    """Return the panels of the unit hemisphere, z <= 0, between the first and the last azimuth.

    Parameters
    ----------
    azimuth : (n + 1,) array
        Where panels meet on the circle z = 0, ascending, rad: from 0 to pi/2, pi or 2 pi.
    depth : int
        Panels from the circle down to where the patches meet; below it are some more.
    q : int
        Points per side of a panel.

    Returns
    -------
    (m, q, q, 3) array
        On the unit sphere; x_u x x_v points away from O.

    Notes
    -----
    Each quadrant or so is a spherical triangle in three patches, as the corner of a cube blown up to the sphere; so panels
    are nowhere slivers, and the lowest point is a corner like others. Panels of neighbouring triangles share whole sides:
    the number of panels on the circle next to x = 0 is one for all of them, the number next to y = 0 differs. Rows shrink
    as 1/n^2 towards z = 0.

    Examples
    --------
    >>> control_panels(np.linspace(0.0, 0.5 * np.pi, 5), depth=3, q=5).shape
    (16, 5, 5, 3)
    """
    corners = _corners(azimuth)
    counts = _counts(azimuth, corners)
    out = [
        _triangle(azimuth[a : b + 1], n, depth, q, toward_x=k % 2 == 0)
        for k, (a, b, n) in enumerate(zip(corners[:-1], corners[1:], counts, strict=True))
    ]
    return np.concatenate(out)


def rows_below(azimuth: Array) -> int:
    """Return how many rows of panels there are, on the x axis, below those counted by `depth`."""
    corners = _corners(azimuth)
    return int(corners[1] - _counts(azimuth, corners)[0])


def first_row(depth: int) -> float:
    """Return the height of the row next to the circle, of the radius."""
    return float(_SIDE * divisions(depth, start=0.0, end=2.0)[1])


def _corners(azimuth: Array) -> list[int]:
    """Return the indices of the azimuths that divide the triangles: those nearest to multiples of 90 deg."""
    n = round((azimuth[-1] - azimuth[0]) / (0.5 * np.pi))
    return [int(np.argmin(np.abs(azimuth - azimuth[0] - 0.5 * np.pi * k))) for k in range(n + 1)]


def _counts(azimuth: Array, corners: list[int]) -> list[int]:
    """Return how many panels each triangle has on the circle from its end on the x axis to its middle.

    Triangles that share a meridian have as many on their far sides; so this number is one for all.
    """
    wish = []
    for k, (a, b) in enumerate(pairwise(corners)):
        middle = int(np.argmin(np.abs(azimuth[a : b + 1] - 0.5 * (azimuth[a] + azimuth[b]))))
        wish.append(middle if k % 2 == 0 else b - a - middle)
    most = min(b - a for a, b in pairwise(corners)) - 1
    return [int(np.clip(round(float(np.mean(wish))), 1, most))] * len(wish)


def _triangle(azimuth: Array, near_x: int, depth: int, q: int, *, toward_x: bool) -> Array:
    """Return the panels of one triangle; `near_x` of those on the circle belong to the patch at its end on the x axis."""
    n = near_x if toward_x else len(azimuth) - 1 - near_x
    m = len(azimuth) - 1 - n
    down = places(divisions(depth, start=0.0, end=2.0), q)
    even = [places(divisions(k), q) for k in (n, m)]
    x, middle, y = azimuth[0], azimuth[n], azimuth[-1]
    low, left, right, center = _at(0.0, 0.5 * np.pi), _at(x, _SIDE), _at(y, _SIDE), _at(middle, _MIDDLE)
    circle = _at(places(azimuth, q), 0.0)
    sides = {
        "left": arc(_at(x, 0.0), left)(down),
        "middle": arc(_at(middle, 0.0), center)(down),
        "right": arc(_at(y, 0.0), right)(down),
        "left center": arc(left, center)(even[0]),
        "center right": arc(center, right)(even[1]),
        "low left": arc(low, left)(even[1]),
        "low right": arc(low, right)(even[0]),
    }
    blocks = [
        block(circle[:n], sides["left center"], sides["left"], sides["middle"]),
        block(circle[n:], sides["center right"], sides["middle"], sides["right"]),
        block(sides["low left"], backwards(sides["center right"]), sides["low right"], sides["left center"]),
    ]
    panels = np.concatenate(blocks)
    panels /= np.linalg.norm(panels, axis=-1, keepdims=True)
    return np.stack([facing(p, tuple(p.mean(axis=(0, 1)))) for p in panels])


def _at(azimuth: Array | float, depth: float) -> Array:
    """Return points (..., 3) of the unit sphere at azimuths and an angle below z = 0, rad."""
    a = np.asarray(azimuth)
    return np.stack([np.cos(depth) * np.cos(a), np.cos(depth) * np.sin(a), np.full(a.shape, -np.sin(depth))], axis=-1)
