"""Smooth surfaces of the bodies with a formula: hemisphere, box, cylinder, Wigley hulls; the quarter x, y >= 0."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ogilvie.mesh.chebyshev import chebyshev_points
from ogilvie.mesh.smooth import SmoothSurface

Array = NDArray[np.float64]

_ROUND = 20  #: points per side of a patch on a circle or sphere: error of rounding size
_CORE = 0.55  #: of the radius, side of the square in the middle of a disc


def smooth_hemisphere(radius: float) -> SmoothSurface:
    """Return an eighth of a sphere about O, z <= 0, as three patches that meet in its middle.

    Examples
    --------
    >>> surface = smooth_hemisphere(1.0)
    >>> round(4.0 * surface.volume / (2.0 / 3.0 * np.pi), 12)
    1.0
    """
    a = np.tan(0.125 * np.pi * (1.0 + chebyshev_points(_ROUND)))  # a cube blown up to the sphere: equal angles
    one = np.ones((_ROUND, _ROUND))
    A, B = np.meshgrid(a, a, indexing="ij")
    cube = [np.stack(p, axis=-1) for p in ((B, A, -one), (one, A, -B[:, ::-1]), (A[::-1], one, -B[:, ::-1]))]
    return SmoothSurface(tuple(radius * c / np.linalg.norm(c, axis=-1, keepdims=True) for c in cube))


def smooth_box(length: float, beam: float, draught: float) -> SmoothSurface:
    """Return bottom, side and end of a quarter of a box.

    Examples
    --------
    >>> round(4.0 * smooth_box(4.0, 1.0, 0.5).volume, 12)
    2.0
    """
    L, B, T = 0.5 * length, 0.5 * beam, draught
    corners = [
        [(0, 0, -T), (L, 0, -T), (0, B, -T), (L, B, -T)],
        [(0, B, -T), (L, B, -T), (0, B, 0), (L, B, 0)],
        [(L, 0, -T), (L, 0, 0), (L, B, -T), (L, B, 0)],
    ]
    outward = ((0, 0, -1), (0, 1, 0), (1, 0, 0))
    grids = (np.array(c, dtype=float).reshape(2, 2, 3) for c in corners)
    return SmoothSurface(tuple(facing(g, o) for g, o in zip(grids, outward, strict=True)))


def smooth_cylinder(radius: float, draught: float) -> SmoothSurface:
    """Return a quarter of an upright circular cylinder: a square and two sectors of the bottom, two halves of the side.

    Examples
    --------
    >>> round(4.0 * smooth_cylinder(1.0, 2.0).volume / (2.0 * np.pi), 12)
    1.0
    """
    s = 0.5 * (1.0 + chebyshev_points(_ROUND))
    X, Y = np.meshgrid(s, s, indexing="ij")
    core = _CORE * np.stack([X * (1.0 - 0.1 * Y**2), Y * (1.0 - 0.1 * X**2), 0.0 * X], axis=-1)
    rim = np.stack([np.cos(0.25 * np.pi * s), np.sin(0.25 * np.pi * s), 0.0 * s], axis=-1)
    sector = (1.0 - s)[None, :, None] * core[-1][:, None] + s[None, :, None] * rim[:, None]
    bottom = [radius * g - [0.0, 0.0, draught] for g in (core, sector, sector[..., [1, 0, 2]])]
    sides = [radius * r[:, None] * [1.0, 1.0, 0.0] + draught * (s[:, None] - 1.0) * [0, 0, 1] for r in (rim, rim[:, [1, 0, 2]])]
    return SmoothSurface((*(facing(g, (0, 0, -1)) for g in bottom), *(facing(g, (1, 1, 0)) for g in sides)))


def smooth_wigley(length: float, beam: float, draught: float, eta: Callable[[Array, Array], Array]) -> SmoothSurface:
    """Return a quarter of a hull with half-breadths beam / 2 eta(2 x/length, z/draught), polynomials up to degree 10."""
    u, v = np.meshgrid(0.5 * (1.0 + chebyshev_points(11)), 0.5 * (chebyshev_points(11) - 1.0), indexing="ij")
    return SmoothSurface((facing(np.stack([0.5 * length * u, 0.5 * beam * eta(u, v), draught * v], axis=-1), (0, 1, 0)),))


def facing(patch: Array, outward: tuple[float, float, float]) -> Array:
    """Return the patch (m, n, 3), its first two axes exchanged where needed, so that x_u x x_v points along `outward`."""
    normal = np.cross(patch[-1, -1] - patch[0, 0], patch[0, -1] - patch[-1, 0])
    return patch if normal @ np.asarray(outward) > 0.0 else patch.swapaxes(0, 1)
