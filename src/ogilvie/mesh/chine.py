"""The chine of a panelled half hull: the sharp line that divides bottom and side from stern to bow."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ogilvie.mesh.flat_ends import across

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_SHARP = np.deg2rad(40.0)  #: least turn of the normal across a chine
_LONG = 0.7  #: of the length of the hull that a chine covers
_SHARE = (0.25, 0.75)  #: of the unit square that bottom and side get at least


@dataclass(frozen=True, eq=False)
class Chine:
    """A sharp line from the stern to the bow.

    Parameters
    ----------
    line : list of int
        Vertices from stern to bow.
    below : (m,) bool array
        Triangles between keel and chine.
    share : float
        Place between keel (0) and waterline (1) at which it is put.
    """

    line: list[int]
    below: NDArray[np.bool_]
    share: float


def find_chine(vertices: Array, tri: Ints, *, keel: list[int], waterline: list[int], loop: list[int]) -> Chine | None:
    """Return the chine of a half hull, None where there is none that runs from end to end.

    Parameters
    ----------
    vertices : (n, 3) array
        m.
    tri : (m, 3) int array
        Without hanging vertices and without flat ends.
    keel, waterline, loop : list of int
        Vertices of these parts of the border, and of all of it.

    Notes
    -----
    It runs over sides of triangles where the normal turns by more than 40 deg, the shortest way between two places of the
    border off the waterline, over 70 % of the length. With several the longest is taken; the others are rounded off.

    Examples
    --------
    >>> from ogilvie.mesh.flattening import flattened
    >>> from ogilvie.mesh.shapes import box
    >>> flat = flattened(box(10.0, 4.0, 2.0, panels=200).with_symmetry("xz"))
    >>> line = flat.uv[:, 1] == flat.chine
    >>> np.unique(flat.vertices[line, 1:], axis=0).tolist()
    [[2.0, -2.0]]
    """
    owner, turn = across(vertices, tri)
    sharp = [(a, b) for (a, b), f in owner.items() if a < b and (b, a) in owner and turn[f, owner[(b, a)]] > _SHARP]
    ways = np.array(sharp, dtype=np.int64).reshape(-1, 2)
    ends = sorted((set(loop) - set(waterline)) & set(ways.ravel().tolist()))
    line = _longest(vertices, ways, ends) if len(ends) > 1 else []
    if not line:
        return None
    below = _below(owner, len(tri), line, keel)
    area = np.linalg.norm(
        np.cross(vertices[tri[:, 1]] - vertices[tri[:, 0]], vertices[tri[:, 2]] - vertices[tri[:, 0]]), axis=1
    )
    if not 0.0 < area[below].sum() < area.sum():
        return None
    return Chine(line, below, float(np.clip(area[below].sum() / area.sum(), *_SHARE)))


def _longest(vertices: Array, ways: Ints, ends: list[int]) -> list[int]:
    """Return the longest of the shortest lines over sides (k, 2) between two ends, from stern to bow; [] without one."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import dijkstra

    size = np.linalg.norm(np.diff(vertices[ways], axis=1)[:, 0], axis=1)
    graph = coo_array((size, tuple(ways.T)), shape=(len(vertices),) * 2).tocsr()
    x = vertices[ends, 0]
    starts = [i for i in ends if vertices[i, 0] < x.min() + (1.0 - _LONG) * np.ptp(vertices[:, 0])]
    distance, before = dijkstra(graph, directed=False, indices=starts, return_predecessors=True)
    far = distance[:, ends]
    reach = x[None] - vertices[starts, :1]
    far[~np.isfinite(far) | (reach < _LONG * np.ptp(vertices[:, 0]))] = 0.0
    i, j = np.unravel_index(int(far.argmax()), far.shape)
    if far[i, j] == 0.0:
        return []
    line = [ends[j]]
    while line[-1] != starts[i]:
        line.append(int(before[i, line[-1]]))
    return line[::-1]


def _below(owner: dict[tuple[int, int], int], n: int, line: list[int], keel: list[int]) -> NDArray[np.bool_]:
    """Return the triangles (n,) that the keel reaches without crossing the line."""
    cut = {frozenset(pair) for pair in pairwise(line)}
    stack = [owner[edge] for a, b in pairwise(keel) for edge in ((a, b), (b, a)) if edge in owner]
    neighbours: dict[int, list[int]] = {}
    for (a, b), f in owner.items():
        if frozenset((a, b)) not in cut and (b, a) in owner:
            neighbours.setdefault(f, []).append(owner[(b, a)])
    mask = np.zeros(n, dtype=bool)
    mask[stack] = True
    while stack:
        for g in neighbours.get(stack.pop(), []):
            if not mask[g]:
                mask[g] = True
                stack.append(g)
    return mask
