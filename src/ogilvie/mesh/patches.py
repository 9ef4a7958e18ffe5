"""Structured patches: spacing of grid lines, quarter discs, fills of end sections, and their union as one mesh."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.topology import canonical, compact, merge_vertices

Array = NDArray[np.float64]

#: Greatest distance of a quadrilateral's corners from their mean plane, over the root of its area.
WARP = 0.09
#: Vertices closer than this part of the largest extent are one.
WELD = 1e-9


def spacing(n: int, *, grading: float = 0.5, fine: Literal["end", "both"] = "end") -> Array:
    """Return n + 1 values from 0 to 1 whose steps shrink towards 1, or towards 0 and 1.

    Parameters
    ----------
    n : int
        Number of steps.
    grading : float
        0: equal steps; 1: cosine spacing; between: a blend of both. The finest step is about (1 - grading) of the mean one.
    fine : {"end", "both"}
        Where the steps are small.

    Examples
    --------
    >>> spacing(2, grading=0.0).tolist(), spacing(4, grading=1.0, fine="both").round(3).tolist()
    ([0.0, 0.5, 1.0], [0.0, 0.146, 0.5, 0.854, 1.0])
    """
    if not 0.0 <= grading <= 1.0:
        raise InputError(f"grading: a number from 0 (equal steps) to 1 (cosine) expected, {grading!r} found.")
    return graded(np.linspace(0.0, 1.0, n + 1), grading, fine=fine)


def graded(s: Array, grading: float, *, fine: Literal["end", "both"] = "end") -> Array:
    """Return the map of [0, 1] on itself behind :func:`spacing`: (1 - g) s + g sin(pi s / 2), or with (1 - cos(pi s)) / 2."""
    curve = np.sin(0.5 * np.pi * s) if fine == "end" else 0.5 * (1.0 - np.cos(np.pi * s))
    return (1.0 - grading) * s + grading * curve


def quarter_disc(n: int, m: int, *, core: float = 0.55, grading: float = 0.5) -> list[Array]:
    """Return the quarter x, y >= 0 of the unit disc as three grids (.., .., 2): a square core and two sectors.

    Parameters
    ----------
    n, m : int
        Panels along each side of the core; rings between core and rim. n (n + 2 m) panels in all.
    core : float
        Where the core's sides meet the axes.
    grading : float
        Steps of the rings, see :func:`spacing`; they shrink towards the rim.
    """
    t = np.linspace(0.0, 1.0, n + 1)
    X, Y = np.meshgrid(t, t, indexing="ij")
    bulge = 0.1  # the core's far corner is drawn in, so that no angle there comes near 180 deg
    middle = core * np.stack([X * (1.0 - bulge * Y**2), Y * (1.0 - bulge * X**2)], axis=-1)
    phi = 0.25 * np.pi * t
    rim = np.stack([np.cos(phi), np.sin(phi)], axis=-1)
    s = spacing(m, grading=grading)[None, :, None]
    sector = (1.0 - s) * middle[-1, :, None, :] + s * rim[:, None, :]
    return [middle, sector, sector[..., ::-1]]


def coons(bottom: Array, top: Array, left: Array, right: Array) -> Array:
    """Return the grid (n, m, 3) between curves bottom, top (n, 3) and left, right (m, 3), by transfinite interpolation."""
    u = np.linspace(0.0, 1.0, len(bottom))[:, None, None]
    v = np.linspace(0.0, 1.0, len(left))[None, :, None]
    ruled = (1 - v) * bottom[:, None] + v * top[:, None] + (1 - u) * left[None] + u * right[None]
    corners = (1 - u) * ((1 - v) * bottom[0] + v * top[0]) + u * ((1 - v) * bottom[-1] + v * top[-1])
    return np.asarray(ruled - corners)


def oriented(grid: Array, outward: ArrayLike) -> Array:
    """Return the grid, its first two axes exchanged where needed, so that its mean normal points along `outward` (3,)."""
    d1, d2 = grid[1:, 1:] - grid[:-1, :-1], grid[:-1, 1:] - grid[1:, :-1]
    mean = np.cross(d1, d2).sum(axis=(0, 1))
    return grid if mean @ np.asarray(outward, dtype=float) >= 0.0 else grid.swapaxes(0, 1)


def panel_mesh(
    grids: Sequence[Array], *, symmetry: Literal["none", "xz", "xz+yz"], name: str, tolerance: float | None = None
) -> PanelMesh:
    """Return the union of structured grids as one mesh with shared vertices.

    Parameters
    ----------
    grids : sequence of (n, m, 3) arrays
        m; the normal of panel (i, j) is along (step in i) x (step in j).
    symmetry : {"none", "xz", "xz+yz"}
        Vertices within the tolerance of a plane of symmetry are put on it, and panels that lie in one are left out.
    tolerance : float, optional
        Vertices closer than this (m) become one; by default 1e-9 of the largest extent.

    Notes
    -----
    A panel with two equal corners becomes a triangle, one without area is left out, and one whose corners are far off their
    mean plane (by over 0.09 of the root of its area) becomes two triangles.
    """
    vertices = np.concatenate([np.asarray(g, dtype=float).reshape(-1, 3) for g in grids])
    faces, first = [], 0
    for g in grids:
        n, m = g.shape[:2]
        i = np.arange(first, first + n * m).reshape(n, m)
        faces.append(np.stack([i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]], axis=-1).reshape(-1, 4))
        first += n * m
    tol = tolerance if tolerance is not None else WELD * float(np.ptp(vertices, axis=0).max())
    for axis in {"none": (), "xz": (1,), "xz+yz": (0, 1)}[symmetry]:
        vertices[np.abs(vertices[:, axis]) <= tol, axis] = 0.0
    vertices[np.abs(vertices[:, 2]) <= tol, 2] = 0.0
    vertices, merged = merge_vertices(vertices, np.concatenate(faces), tolerance=tol)
    merged = _unwarped(vertices, _hinged(vertices, _proper(vertices, canonical(merged), symmetry), symmetry))
    return PanelMesh(*compact(vertices, merged), symmetry=symmetry, name=name)


def _proper(vertices: Array, faces: NDArray[np.int64], symmetry: str) -> NDArray[np.int64]:
    """Return the faces with three or four distinct corners, not folded in two, that do not lie in a plane of symmetry."""
    keep = (np.diff(np.sort(faces, axis=1), axis=1) > 0).sum(axis=1) >= 2
    keep &= (faces[:, 0] != faces[:, 2]) & (faces[:, 1] != faces[:, 3])
    for axis in {"none": (), "xz": (1,), "xz+yz": (0, 1)}[symmetry]:
        keep &= np.any(vertices[faces][..., axis] != 0.0, axis=1)
    return faces[keep]


def _hinged(vertices: Array, faces: NDArray[np.int64], symmetry: str) -> NDArray[np.int64]:
    """Return the faces; those with three corners in a plane of symmetry start at the fourth: no half lies in the plane."""
    faces = faces.copy()
    for axis in {"none": (), "xz": (1,), "xz+yz": (0, 1)}[symmetry]:
        off = vertices[faces][..., axis] != 0.0
        rows = np.flatnonzero((off.sum(axis=1) == 1) & (faces[:, 2] != faces[:, 3]))
        faces[rows] = faces[rows[:, None], (off[rows].argmax(axis=1)[:, None] + np.arange(4)) % 4]
    return faces


def _unwarped(vertices: Array, faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the faces, strongly warped quadrilaterals as two triangles along their first diagonal."""
    p = vertices[faces]
    S = 0.5 * np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1])
    area = np.maximum(np.linalg.norm(S, axis=1), 1e-300)
    off = np.abs(((p - p.mean(axis=1, keepdims=True)) * (S / area[:, None])[:, None]).sum(axis=2)).max(axis=1)
    warped = (off > WARP * np.sqrt(area)) & (faces[:, 2] != faces[:, 3])
    halves = faces[warped][:, [[0, 1, 2, 2], [0, 2, 3, 3]]].reshape(-1, 4)
    return np.concatenate([faces[~warped], halves])
