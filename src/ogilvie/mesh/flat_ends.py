"""Flat ends of a panelled half hull - transom, blunt bow - as regions of their own, apart from the side."""

import numpy as np
from numpy.typing import NDArray

from ogilvie.mesh.topology import edges

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_CREASE = np.deg2rad(35.0)  #: turn of the normal across an edge that ends a region
_ACROSS = 0.5  #: most change of x along the end's waterline, over the change of y
_LEAST = (4, 0.1)  #: triangles, and half-breadth over that of the ship
_NEAR_END = 0.05  #: of the length that an end may reach forward or aft


def flat_end(vertices: Array, tri: Ints, *, end: int, near: float) -> tuple[NDArray[np.bool_], list[int]]:
    """Return the triangles of the flat end of a half hull, and the vertices of its edge from the keel to the waterline.

    Parameters
    ----------
    vertices : (n, 3) array
        m, y >= 0, z <= 0.
    tri : (m, 3) int array
        Without hanging vertices.
    end : {-1, 1}
        Stern or bow.
    near : float
        Lengths taken as zero, m.

    Returns
    -------
    mask : (m,) bool array
        All False where this end is sharp or round.
    edge : list of int
        Empty then.

    Notes
    -----
    It starts at the waterline where that runs across the ship to the centreline, and spreads over edges where the normal turns
    by less than 35 deg. It counts if it stays within 5 % of the length from the end, has 4 triangles and a tenth of the
    breadth, and one line divides it from the side.

    Examples
    --------
    >>> from ogilvie.mesh.conforming import conforming
    >>> from ogilvie.mesh.shapes import box
    >>> v, t = conforming(box(10.0, 4.0, 2.0, panels=200).with_symmetry("xz"), 1e-6)
    >>> mask, edge = flat_end(v, t, end=1, near=1e-6)
    >>> int(mask.sum()), sorted({float(v[i, 0]) for i in edge}), v[edge[-1]].tolist()
    (18, [5.0], [5.0, 2.0, 0.0])
    """
    none = np.zeros(len(tri), dtype=bool), list[int]()
    low, high = float(vertices[:, 0].min()), float(vertices[:, 0].max())
    owner, turn = across(vertices, tri)
    start = {f for (a, b), f in owner.items() if _runs_across(vertices, a, b, near) and (b, a) not in owner}
    start = {f for f in start if _within(vertices[tri[f]], low, high, end)}
    region, stack = set(start), list(start)
    while stack:
        f = stack.pop()
        for a, b in zip(tri[f], np.roll(tri[f], -1), strict=True):
            other = owner.get((int(b), int(a)))
            if other is not None and other not in region and turn[f, other] < _CREASE:
                region.add(other)
                stack.append(other)
    mask = none[0].copy()
    mask[list(region)] = True
    if not region or not all(_within(vertices[tri[f]], low, high, end) for f in region):
        return none
    edge = _dividing(vertices, owner, mask, near)
    if not edge or mask.sum() < _LEAST[0] or vertices[edge[-1], 1] < _LEAST[1] * vertices[:, 1].max():
        return none
    return mask, edge


def across(vertices: Array, tri: Ints) -> tuple[dict[tuple[int, int], int], dict[tuple[int, int], float]]:
    """Return the triangle on each directed edge, and the turn of the normal between neighbours, rad."""
    n = np.cross(vertices[tri[:, 1]] - vertices[tri[:, 0]], vertices[tri[:, 2]] - vertices[tri[:, 0]])
    n /= np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-300)
    start, end, face = (a.tolist() for a in edges(tri))
    owner = dict(zip(zip(start, end, strict=True), face, strict=True))
    pairs = ((f, owner[(b, a)]) for (a, b), f in owner.items() if (b, a) in owner)
    return owner, {(f, g): float(np.arccos(np.clip(n[f] @ n[g], -1.0, 1.0))) for f, g in pairs}


def _runs_across(vertices: Array, a: int, b: int, near: float) -> bool:
    p, d = vertices[[a, b]], vertices[b] - vertices[a]
    return bool(np.abs(p[:, 2]).max() <= near and abs(d[0]) <= _ACROSS * abs(d[1]))


def _within(points: Array, low: float, high: float, end: int) -> bool:
    reach = _NEAR_END * (high - low)
    return bool(points[:, 0].min() >= high - reach if end > 0 else points[:, 0].max() <= low + reach)


def _dividing(vertices: Array, owner: dict[tuple[int, int], int], mask: NDArray[np.bool_], near: float) -> list[int]:
    """Return the vertices of the line between region and rest, from the centreline to the waterline; [] if it is not one."""
    after: dict[int, int] = {}
    for (a, b), f in owner.items():
        other = owner.get((b, a))
        if mask[f] and other is not None and not mask[other]:
            if a in after:
                return []
            after[a] = b
    starts = set(after) - set(after.values())
    if len(starts) != 1:
        return []
    line = [starts.pop()]
    while line[-1] in after:
        line.append(after[line[-1]])
    if len(line) != len(after) + 1:
        return []
    if abs(vertices[line[0], 2]) <= near:
        line = line[::-1]
    foot, top = vertices[line[0]], vertices[line[-1]]
    return line if abs(foot[1]) <= near and foot[2] < -near and abs(top[2]) <= near and top[1] > near else []
