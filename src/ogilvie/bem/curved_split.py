"""Panels at the waterline divided in two, exactly: what an impulse does there is singular."""

from dataclasses import replace

import numpy as np

from ogilvie.bem.curved import BODY, FREE, Array, CurvedMesh
from ogilvie.bem.inner_checks import positions_and_normals
from ogilvie.mesh.chebyshev import chebyshev_points, interpolation

SHARE = 0.15  # of a panel's extent away from the waterline that the panel next to it gets


def split_at_waterline(mesh: CurvedMesh, *, share: float = SHARE) -> CurvedMesh:
    """Return the mesh with the panels of hull and free surface that have a side on the waterline divided along it.

    Parameters
    ----------
    mesh : CurvedMesh
    share : float
        Of the parameter away from the waterline that goes to the panel next to it.

    Notes
    -----
    Both parts are the same polynomial as before, taken at other points: the surface does not change.
    """
    sides = [_waterline_sides(mesh, part) for part in (BODY, FREE)]
    shared = _common(mesh.points, sides[0], sides[1])
    points: list[Array] = []
    part: list[int] = []
    for i, panel in enumerate(mesh.points):
        pieces = [panel]
        for side in shared.get(i, ()):
            pieces = _divided(pieces[0], side, share) + pieces[1:]
        points += pieces
        part += [int(mesh.part[i])] * len(pieces)

    return replace(mesh, points=np.array(points), part=np.array(part))


def water_angle(mesh: CurvedMesh) -> float:
    """Return the largest angle of the water at the waterline, rad: pi/2 at a vertical side, more where the hull flares.

    Examples
    --------
    >>> from ogilvie.bem.inner_mesh import inner_mesh
    >>> from ogilvie.mesh.shapes import hemisphere
    >>> round(water_angle(inner_mesh(hemisphere(1.0))), 3)
    1.571
    """
    t = np.linspace(-0.99, 0.99, 5)  # a little inside: panels of three corners have no normal at the double one
    normal = positions_and_normals(mesh.points, np.array([-1.0, *t, 1.0]), np.array([-1.0, *t, 1.0]))[1]
    along = [side_points(normal[i], side)[1:-1] for i, side in _waterline_sides(mesh, BODY)]
    if not along:
        return 0.5 * np.pi
    n = np.concatenate(along)
    return float(0.5 * np.pi + np.arctan2(n[:, 2], np.linalg.norm(n[:, :2], axis=1)).max())


def side_points(points: Array, side: int) -> Array:
    """Return the points (..., q, 3) of side 0 (u = -1), 1 (u = 1), 2 (v = -1) or 3 (v = 1) of panels (..., q, q, 3)."""
    at = -1 if side % 2 else 0
    return np.asarray(points[..., at, :, :] if side < 2 else points[..., :, at, :])


def _waterline_sides(mesh: CurvedMesh, part: int) -> list[tuple[int, int]]:
    """Panel and side of all sides at z = 0 of one part; corners that stand for a side are none."""
    near = 1e-8 * mesh.radius
    along = [side_points(mesh.points, s) for s in range(4)]
    on = [(np.abs(p[..., 2]).max(axis=1) < near) & (np.ptp(p, axis=1).max(axis=1) > near) & (mesh.part == part) for p in along]
    return [(int(i), s) for s in range(4) for i in np.flatnonzero(on[s])]


def _common(points: Array, hull: list[tuple[int, int]], free: list[tuple[int, int]]) -> dict[int, list[int]]:
    """Sides of each panel that hull and free surface share."""
    from scipy.spatial import cKDTree

    found: dict[int, list[int]] = {}
    if not hull or not free:
        return found
    middles = [np.array([_middle(side_points(points[i], s)) for i, s in sides]) for sides in (hull, free)]
    scale = float(np.ptp(points.reshape(-1, 3), axis=0).max())
    near, index = cKDTree(middles[0]).query(middles[1])
    for k in np.flatnonzero(near < 1e-6 * scale):
        for i, s in (free[k], hull[index[k]]):
            found.setdefault(i, [])
            if s not in found[i]:
                found[i].append(s)
    return found


def _middle(side: Array) -> Array:
    """Return the point half-way along a side, of its polynomial."""
    return np.asarray(interpolation(len(side), np.zeros(1)) @ side)[0]


def _divided(panel: Array, side: int, share: float) -> list[Array]:
    """Return the panel next to the side and the rest."""
    q = len(panel)
    t = chebyshev_points(q)
    cut = -1.0 + 2.0 * share
    near, far = -1.0 + (t + 1.0) * share, cut + (t + 1.0) * (1.0 - share)
    if side % 2:
        near, far = -near[::-1], -far[::-1]
    axis = "ki,ijd->kjd" if side < 2 else "kj,ijd->ikd"
    return [np.einsum(axis, interpolation(q, x), panel) for x in (near, far)]
