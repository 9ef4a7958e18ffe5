"""Panels that close the waterplane from inside: against irregular frequencies."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import ConvergenceError, InputError
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.topology import compact, edges, merge_vertices

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_AXIS = {"xz": 1, "yz": 0}
_COARSER = 1.25  #: default size over the mean size of the hull's panels


def waterplane_lid(mesh: PanelMesh, *, size: float | None = None) -> PanelMesh:
    """Return panels that fill the waterplane z = 0 inside a hull.

    Parameters
    ----------
    mesh : PanelMesh
        Wetted hull. Several hulls or columns, and openings within (moonpools, ring pontoons), are found from its waterlines.
    size : float, optional
        Side of a panel, m; by default 1.25 times the root of the mean area of the hull's panels.

    Returns
    -------
    PanelMesh
        Symmetry of the hull; normals down (into the fluid inside the hull). ``mesh.with_lid(lid)`` puts it on the hull.

    Raises
    ------
    InputError
        The hull has no waterline, or one that is not closed.

    Notes
    -----
    Points of the waterline and a square lattice inside it, joined by a Delaunay triangulation whose boundary is made to
    follow the waterline; pairs of triangles are joined to quadrilaterals where those come out convex. Without a lid the
    integral equation has no solution, or a wrong one near by, at the frequencies at which water would slosh inside the hull.

    Examples
    --------
    >>> from ogilvie.mesh.shapes import box
    >>> lid = waterplane_lid(box(100.0, 20.0, 5.0, panels=600))
    >>> lid.symmetry, round(-4.0 * float(lid.area_vectors[:, 2].sum()), 6), lid.normals[0].tolist()
    ('xz+yz', 2000.0, [0.0, 0.0, -1.0])
    """
    h = _COARSER * float(np.sqrt(mesh.areas.mean())) if size is None else float(size)
    if not (np.isfinite(h) and h > 0.0):
        raise InputError(f"size: a positive length in m expected, {size!r} found.")
    outline = _outline(mesh, h)
    points, segments = _with_planes(outline, mesh, h)
    points = np.vstack([points, _lattice(points, segments, outline, h)])
    points, triangles = _triangulated(points, segments, outline, h)
    faces = _paired(points, triangles)
    vertices, faces = compact(np.c_[points, np.zeros(len(points))], faces)
    return PanelMesh(vertices, faces, symmetry=mesh.symmetry, name=f"lid of {mesh.name}")


# ---- outline


def _outline(mesh: PanelMesh, h: float) -> list[Array]:
    """Return the waterlines as chains (n, 2) of points about h apart; closed ones end where they start."""
    tolerance = 1e-5 * float(np.ptp(mesh.bounds, axis=0).max())
    vertices, faces = merge_vertices(mesh.vertices, mesh.faces, tolerance=tolerance)
    start, end, _ = edges(faces)
    open_edges = set(zip(start.tolist(), end.tolist(), strict=True)) - set(zip(end.tolist(), start.tolist(), strict=True))
    wet = np.abs(vertices[:, 2]) <= 10.0 * tolerance
    inside = [np.abs(vertices[:, _AXIS[p]]) <= tolerance for p in mesh.planes]
    line = [(a, b) for a, b in open_edges if wet[a] and wet[b] and not any(plane[a] and plane[b] for plane in inside)]
    if not line:
        raise InputError(
            f"waterplane_lid: {mesh.name!r} has no open edge on z = 0. Clip the hull there first: mesh.immersed()."
        )
    ends = {int(i) for plane in inside for i in np.flatnonzero(plane)}
    flat = vertices[:, :2].copy()
    for plane, p in zip(inside, mesh.planes, strict=True):
        flat[plane, _AXIS[p]] = 0.0
    return [_resampled(flat[chain], h) for chain in _chains(line, ends, mesh.name)]


def _chains(line: list[tuple[int, int]], ends: set[int], name: str) -> list[list[int]]:
    """Return the edges as chains of vertices: closed ones, or from plane of symmetry to plane of symmetry."""
    after = dict(sorted(line))
    if len(after) < len(line) or len({b for _, b in line}) < len(line):
        raise InputError(f"waterplane_lid: waterlines of {name!r} that do not touch expected, found some that branch.")
    first = sorted(set(after) - {b for _, b in line})
    if bad := [i for i in first if i not in ends]:
        raise InputError(
            f"waterplane_lid: closed waterlines expected, {len(bad)} of {name!r} have a gap. Close the holes of the hull."
        )
    out = []
    while after:
        chain = [first.pop(0) if first else min(after)]
        while chain[-1] in after:
            chain.append(after.pop(chain[-1]))
        if chain[0] != chain[-1] and chain[-1] not in ends:
            raise InputError(
                f"waterplane_lid: closed waterlines expected, one of {name!r} has a gap. Close the holes of the hull."
            )
        out.append(chain)
    return out


def _resampled(chain: Array, h: float) -> Array:
    """Return a chain with points left out where they are much closer than h, and added where much farther; corners stay."""
    h = min(h, float(np.hypot(*np.diff(chain, axis=0).T).sum()) / 12.0)
    keep, last = [0], 0
    for i in range(1, len(chain) - 1):
        near = np.hypot(*(chain[i] - chain[last])) + np.hypot(*(chain[i + 1] - chain[i])) <= 1.2 * h
        d, e = chain[last : i + 1] - chain[last], chain[i + 1] - chain[last]
        if not near or np.abs(d[:, 0] * e[1] - d[:, 1] * e[0]).max() > 0.03 * h * np.hypot(*e):
            keep.append(i)
            last = i
    chain = chain[[*keep, len(chain) - 1]]
    out = [chain[:1]]
    for a, b in pairwise(chain):
        n = max(1, round(np.hypot(*(b - a)) / (1.2 * h)))
        out.append(a + np.arange(1, n + 1)[:, None] / n * (b - a))
    return np.concatenate(out)


def _inside(points: Array, outline: list[Array]) -> NDArray[np.bool_]:
    """Return which points (n, 2) are in the waterplane: those with an odd number of waterlines ahead of them in +y."""
    crossings = np.zeros(len(points), dtype=int)
    for chain in outline:
        a, b = chain[:-1], chain[1:]
        x, y = points[:, :1], points[:, 1:]
        spans = (a[:, 0] > x) != (b[:, 0] > x)
        dx = np.where(b[:, 0] == a[:, 0], 1.0, b[:, 0] - a[:, 0])
        crossings += (spans & (a[:, 1] + (x - a[:, 0]) / dx * (b[:, 1] - a[:, 1]) > y)).sum(axis=1)
    return crossings % 2 == 1


def _with_planes(outline: list[Array], mesh: PanelMesh, h: float) -> tuple[Array, Ints]:
    """Return points (n, 2) and segments (m, 2) of the border: waterlines, and planes of symmetry where inside of them."""
    chains = list(outline)
    for p in mesh.planes:
        axis, along = _AXIS[p], 1 - _AXIS[p]
        on = np.unique(
            np.concatenate([c[[0, -1]][c[[0, -1], axis] == 0.0][:, along] for c in outline] + [np.zeros(len(mesh.planes) - 1)])
        )
        for a, b in pairwise(on):
            middle = np.zeros((1, 2))
            middle[0, along], middle[0, axis] = 0.5 * (a + b), 1e-9 * h
            if _inside(middle, outline)[0]:
                t = _plane_points(a, b, axis, along, outline, h)
                chain = np.zeros((len(t), 2))
                chain[:, along] = t
                chains.append(chain)
    points = np.concatenate(chains)
    first = np.cumsum([0, *(len(c) for c in chains)])[:-1]
    segments = np.concatenate(
        [f + np.stack([np.arange(len(c) - 1), np.arange(1, len(c))], axis=1) for f, c in zip(first, chains, strict=True)]
    )
    unique, index = np.unique(np.round(points / (1e-7 * h)), axis=0, return_inverse=True)
    out = np.zeros((len(unique), 2))
    out[index.ravel()] = points
    ends = index.ravel()[segments]
    return out, ends[ends[:, 0] != ends[:, 1]]


def _plane_points(a: float, b: float, axis: int, along: int, outline: list[Array], h: float) -> Array:
    """Return points on a plane of symmetry from a to b: h apart, or opposite the waterline's where that is near."""
    even = np.linspace(a, b, max(1, round((b - a) / h)) + 1)
    line = np.concatenate(outline)
    opposite = line[(line[:, axis] > 0.0) & (line[:, axis] < 0.8 * h) & (line[:, along] > a) & (line[:, along] < b)][:, along]
    far = [t for t in even[1:-1] if not len(opposite) or np.abs(opposite - t).min() > 0.6 * h]
    return np.unique(np.r_[a, opposite, far, b])


def _lattice(points: Array, segments: Ints, outline: list[Array], h: float) -> Array:
    """Return the points of a square lattice inside the waterplane that keep away from its border."""
    low, high = points.min(axis=0), points.max(axis=0)
    axes = [
        low[k] + (np.arange(int((high[k] - low[k]) / h)) + 1.0) * (high[k] - low[k]) / (int((high[k] - low[k]) / h) + 1.0)
        for k in (0, 1)
    ]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    grid = grid[_inside(grid, outline)]
    a, b = points[segments[:, 0]], points[segments[:, 1]]
    d = b - a
    t = np.clip(((grid[:, None] - a) * d).sum(axis=2) / (d * d).sum(axis=1), 0.0, 1.0)
    away = np.linalg.norm(grid[:, None] - (a + t[..., None] * d), axis=2)
    return grid[away.min(axis=1) > 0.55 * h] if len(grid) else grid


# ---- panels


def _triangulated(points: Array, segments: Ints, outline: list[Array], h: float) -> tuple[Array, Ints]:
    """Return points and the triangles (n, 3) of the waterplane; segments of the border that are missing are halved."""
    from scipy.spatial import Delaunay

    for _ in range(12):
        tri = Delaunay(points).simplices.astype(np.int64)
        sides = {tuple(sorted(s)) for t in tri.tolist() for s in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))}
        lost = np.array([tuple(sorted(s)) not in sides for s in segments.tolist()])
        if not lost.any():
            break
        new = 0.5 * (points[segments[lost, 0]] + points[segments[lost, 1]])
        i = len(points) + np.arange(len(new))
        halves = [np.stack([segments[lost, 0], i], axis=1), np.stack([i, segments[lost, 1]], axis=1)]
        points, segments = np.vstack([points, new]), np.concatenate([segments[~lost], *halves])
    else:
        raise ConvergenceError("waterplane_lid: the triangulation does not follow the waterline; try another size.")
    area = _area(points[tri])
    tri = tri[(np.abs(area) > 1e-6 * h * h) & _inside(points[tri].mean(axis=1), outline)]
    clockwise = _area(points[tri]) < 0.0
    return points, np.where(clockwise[:, None], tri, tri[:, ::-1])  # seen from above: normals down


def _area(p: Array) -> Array:
    d1, d2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    return np.asarray(0.5 * (d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0]))


def _paired(points: Array, triangles: Ints) -> Ints:
    """Return (n, 4) faces: pairs of triangles joined, the squarest first, where no angle gets below 45 or above 135 deg."""
    owner: dict[tuple[int, int], tuple[int, int]] = {}
    candidates = []
    for k, t in enumerate(triangles.tolist()):
        for a, b, c in ((t[0], t[1], t[2]), (t[1], t[2], t[0]), (t[2], t[0], t[1])):
            if (b, a) in owner:
                other, opposite = owner[(b, a)]
                quad = [c, a, opposite, b]
                if (worst := _worst_angle(points[quad])) < np.deg2rad(45.0):
                    candidates.append((worst, k, other, quad))
            owner[(a, b)] = (k, c)
    used: set[int] = set()
    faces = []
    for _, k, other, quad in sorted(candidates):
        if k not in used and other not in used:
            used |= {k, other}
            faces.append(quad)
    faces += [[*t, t[2]] for k, t in enumerate(triangles.tolist()) if k not in used]
    return np.array(faces, dtype=np.int64)


def _worst_angle(quad: Array) -> float:
    """Return the greatest difference between an angle of a quadrilateral and a right angle, rad."""
    before, after = np.roll(quad, 1, axis=0) - quad, np.roll(quad, -1, axis=0) - quad
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return float(np.abs(np.abs(np.arctan2(cross, (before * after).sum(axis=1))) - 0.5 * np.pi).max())
