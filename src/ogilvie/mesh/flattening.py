"""A panelled half hull spread out on the unit square: the places of its vertices in two smooth coordinates."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.flat_ends import flat_end
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.topology import compact, edges, merge_vertices

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_WELD = 1e-6  #: of the length, vertices nearer to each other are one; up to 100 times as much where gaps ask for it
_KINK, _BROAD = np.deg2rad(40.0), 0.1  #: least turn of the waterline, and share of the half beam, that make a kink
_REACH = 0.15  #: of the length that counts, at the ends of the keel, as much as the draught


@dataclass(frozen=True, eq=False)
class Flattened:
    """The port half of a hull, each vertex with its place in the unit square.

    Parameters
    ----------
    vertices : (n, 3) array
        m.
    uv : (n, 2) array
        u from stern (0) to bow (1), v from keel (0) to waterline (1).
    triangles : (m, 3) int array
    side : (n,) int array
        -1 inside; 0 stern profile (u = 0), 1 bow profile (u = 1), 2 keel (v = 0), 3 waterline (v = 1); corners count as
        keel or waterline.
    flat_ends : pair of bool
        Whether u = 0 and u = 1 are edges of a flat stern and bow, which are left out, instead of profiles in y = 0.
    kinks : tuple of int
        Vertices where the waterline turns by more than 40 deg, at a tenth of the half beam or more.
    """

    vertices: Array
    uv: Array
    triangles: Ints
    side: Ints
    flat_ends: tuple[bool, bool] = (False, False)
    kinks: tuple[int, ...] = ()


def flattened(hull: PanelMesh) -> Flattened:
    """Return a hull's stored half spread out on the unit square.

    Parameters
    ----------
    hull : PanelMesh
        Symmetry "xz", below z = 0.

    Raises
    ------
    InputError
        The half hull is not one piece with one border in z = 0 and y = 0.

    Notes
    -----
    Borders are spread by length: waterline on v = 1, keel on v = 0, the profiles at stern and bow on u = 0 and 1. The profile
    is keel between the two points that are lowest and farthest out together (x over 15 % of the length plus depth over
    draught). At a flat end its edge takes the place of the profile. Inside, each vertex is the mean of its neighbours
    weighted by mean values: such a map is one to one, whatever the triangles.

    References
    ----------
    Floater (2003), Mean value coordinates, Computer Aided Geometric Design 20(1), Eq. (1); Tutte (1963), How to draw a
    graph.

    Examples
    --------
    >>> from ogilvie.mesh.shapes import wigley
    >>> flat = flattened(wigley(panels=400).with_symmetry("xz+yz").translated((0.1, 0.0, 0.0)))
    >>> float(flat.uv.min()), float(flat.uv.max()), sorted(set(flat.side.tolist()))
    (0.0, 1.0, [-1, 0, 1, 2, 3])
    """
    for near in _WELD * hull.length * np.array([1.0, 10.0, 100.0]):
        vertices, tri = conforming(hull, near)
        ends = [flat_end(vertices, tri, end=k, near=10.0 * near) for k in (-1, 1)]
        tri = tri[~(ends[0][0] | ends[1][0])]
        try:
            loop = _border(vertices, tri, 10.0 * near, [i for _, edge in ends for i in edge])
            break
        except InputError as error:
            failure = error
    else:
        raise failure
    corners = _corners(vertices, loop, 10.0 * near)
    for k, (_, edge) in enumerate(ends):
        if edge:
            corners[k], corners[2 + k] = loop.index(edge[-1]), loop.index(edge[0])
    uv, side = _on_border(vertices, loop, corners)
    used, index = np.unique(tri, return_inverse=True)
    inner = used[side[used] == -1]
    uv[inner] = _harmonic(vertices, tri, uv, inner)
    flat = Flattened(vertices[used], uv[used], index.reshape(tri.shape), side[used], (bool(ends[0][1]), bool(ends[1][1])))
    return replace(flat, kinks=_kinks(flat))


def _kinks(flat: Flattened) -> tuple[int, ...]:
    line = np.flatnonzero(flat.side == 3)
    line = line[np.argsort(flat.uv[line, 0])]
    step = np.diff(flat.vertices[line, :2], axis=0)
    turn = np.abs(step[:-1, 0] * step[1:, 1] - step[:-1, 1] * step[1:, 0])
    angle = np.arctan2(turn, (step[:-1] * step[1:]).sum(axis=1))
    broad = flat.vertices[line[1:-1], 1] > _BROAD * flat.vertices[:, 1].max()
    return tuple(line[1:-1][(angle > _KINK) & broad].tolist())


def conforming(hull: PanelMesh, near: float) -> tuple[Array, Ints]:
    """Return vertices and triangles of a hull, with the vertices that lie on another panel's side made corners of it."""
    vertices, faces = merge_vertices(hull.vertices, hull.faces, tolerance=near)
    for axis in (1, 2):
        vertices[np.abs(vertices[:, axis]) <= near, axis] = 0.0
    start, end, _ = edges(faces)
    directed = set(zip(start.tolist(), end.tolist(), strict=True))
    hanging: dict[tuple[int, int], list[int]] = {}
    free = [(a, b) for a, b in directed if (b, a) not in directed]
    candidates = np.unique(np.array(free, dtype=np.int64)) if free else np.zeros(0, dtype=np.int64)
    for a, b in free:
        d = vertices[b] - vertices[a]
        t = (vertices[candidates] - vertices[a]) @ d / (d @ d)
        off = np.linalg.norm(vertices[candidates] - vertices[a] - t[:, None] * d, axis=1)
        on = (t > 1e-6) & (t < 1.0 - 1e-6) & (off <= 10.0 * near)
        if on.any():
            hanging[(a, b)] = candidates[on][np.argsort(t[on])].tolist()
    polygons = [_with_hanging(f, hanging) for f in faces.tolist()]
    middle = {i: len(vertices) + k for k, i in enumerate(i for i, p in enumerate(polygons) if len(p) > 4)}
    added = np.array([vertices[polygons[i]].mean(axis=0) for i in middle]).reshape(-1, 3)
    tri = [t for i, p in enumerate(polygons) for t in _triangles(p, middle.get(i))]
    return compact(np.vstack([vertices, added]), np.array(tri, dtype=np.int64))


def _with_hanging(face: list[int], hanging: dict[tuple[int, int], list[int]]) -> list[int]:
    out: list[int] = []
    for a, b in zip(face, [*face[1:], face[0]], strict=True):
        if a != b:
            out += [a, *hanging.get((a, b), [])]
    return out


def _triangles(polygon: list[int], middle: int | None) -> list[list[int]]:
    if middle is not None:
        return [[a, b, middle] for a, b in zip(polygon, [*polygon[1:], polygon[0]], strict=True)]
    return [polygon] if len(polygon) == 3 else [polygon[:3], [polygon[0], polygon[2], polygon[3]]] if len(polygon) == 4 else []


def _border(vertices: Array, tri: Ints, near: float, edges_of_ends: list[int]) -> list[int]:
    """Return the vertices of the border, in order; all but those of flat ends lie in z = 0 or y = 0."""
    start, end, _ = edges(tri)
    directed = set(zip(start.tolist(), end.tolist(), strict=True))
    after = {a: b for a, b in directed if (b, a) not in directed}
    if len(after) < 4 or len(after) < sum((b, a) not in directed for a, b in directed):
        raise InputError("flattened: one border that does not touch itself expected.")
    loop = [min(after)]
    while after[loop[-1]] != loop[0]:
        loop.append(after[loop[-1]])
        if len(loop) > len(after) or loop[-1] not in after:
            raise InputError("flattened: a closed border expected.")
    if len(loop) < len(after):
        raise InputError(f"flattened: one border expected, more found ({len(after) - len(loop)} sides elsewhere).")
    p = vertices[loop]
    off = (np.abs(p[:, 1]) > near) & (np.abs(p[:, 2]) > near) & ~np.isin(loop, edges_of_ends)
    if off.any():
        at = p[off][0].round(6).tolist()
        raise InputError(
            f"flattened: a border in z = 0 and y = 0 expected, {int(off.sum())} vertices elsewhere, one at {at} m."
        )
    return loop


def _corners(vertices: Array, loop: list[int], near: float) -> list[int]:
    """Return the places in the loop of stern and bow on the waterline, and of both ends of the keel."""
    p = vertices[loop]
    wet_line = np.flatnonzero((np.abs(p[:, 2]) <= near) & (np.abs(p[:, 1]) <= near))
    stern, bow = (wet_line[np.argmin(p[wet_line, 0])], wet_line[np.argmax(p[wet_line, 0])]) if len(wet_line) else (0, 0)
    keel = np.flatnonzero((np.abs(p[:, 1]) <= near) & (p[:, 2] < -near))
    if len(keel) < 2:
        raise InputError("flattened: a keel on the centreline expected.")
    score = p[keel, 2] / np.abs(p[:, 2]).max()
    along = p[keel, 0] / (_REACH * np.ptp(p[:, 0]))
    return [int(stern), int(bow), int(keel[np.argmin(along + score)]), int(keel[np.argmax(along - score)])]


def _on_border(vertices: Array, loop: list[int], corners: list[int]) -> tuple[Array, Ints]:
    """Return (u, v) of the border's vertices, zeros elsewhere, and which side each vertex is on."""
    stern, bow, low_stern, low_bow = corners
    uv, side = np.zeros((len(vertices), 2)), np.full(len(vertices), -1)
    ends = {0: (low_stern, stern), 1: (low_bow, bow), 2: (low_stern, low_bow), 3: (stern, bow)}
    for k, (a, b) in ends.items():
        chain = _between(loop, a, b, [c for c in corners if c not in (a, b)])
        length = np.cumsum(np.r_[0.0, np.linalg.norm(np.diff(vertices[chain], axis=0), axis=1)])
        t = length / length[-1]
        uv[chain] = np.stack([np.full(len(t), float(k)), t] if k < 2 else [t, np.full(len(t), k - 2.0)], axis=-1)
        side[chain] = k
    return uv, side


def _between(loop: list[int], a: int, b: int, others: list[int]) -> list[int]:
    """Return the vertices of a loop from place a to place b, the way that does not pass the other corners."""
    n = len(loop)
    for step in (1, -1):
        way = [(a + step * i) % n for i in range((step * (b - a)) % n + 1)]
        if not set(way) & set(others):
            return [loop[i] for i in way]
    raise InputError("flattened: waterline and keel between stern and bow expected, the border runs differently.")


def _harmonic(vertices: Array, tri: Ints, uv: Array, inner: Ints) -> Array:
    """Return the places of inner vertices as means of their neighbours, weights (tan a/2 + tan b/2) / distance."""
    from scipy.sparse import coo_array
    from scipy.sparse.linalg import spsolve

    rows, columns, values = [], [], []
    for k in range(3):
        i, j, l = tri[:, k], tri[:, (k + 1) % 3], tri[:, (k + 2) % 3]
        d, e = vertices[j] - vertices[i], vertices[l] - vertices[i]
        nd, ne = np.linalg.norm(d, axis=1), np.linalg.norm(e, axis=1)
        angle = np.arctan2(np.linalg.norm(np.cross(d, e), axis=1), (d * e).sum(axis=1))
        half = np.tan(0.5 * np.minimum(angle, 0.99 * np.pi))
        rows += [i, i]
        columns += [j, l]
        values += [half / nd, half / ne]
    n = len(vertices)
    W = coo_array((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(n, n)).tocsr()
    W = W[inner]
    total = np.asarray(W.sum(axis=1)).ravel()
    index = np.zeros(n, dtype=bool)
    index[inner] = True  # places of vertices that no triangle has count for nothing
    A = -W[:, inner] + coo_array((total, (np.arange(len(inner)), np.arange(len(inner)))), shape=(len(inner),) * 2)
    return np.asarray(spsolve(A.tocsc(), W[:, np.flatnonzero(~index)] @ uv[~index]))
