"""A panelled half hull spread out on the unit square: the places of its vertices in two smooth coordinates."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.borders import between, border, corners_of, on_border
from ogilvie.mesh.chine import Chine, find_chine
from ogilvie.mesh.conforming import conforming
from ogilvie.mesh.flat_ends import flat_end
from ogilvie.mesh.panels import PanelMesh

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_WELD = 1e-6  #: of the length, vertices nearer to each other are one; up to 100 times as much where gaps ask for it
_KINK, _BROAD = np.deg2rad(40.0), 0.1  #: least turn of the waterline, and share of the half beam, that make a kink
_FOOT = 0.15  #: of the profile up to which a chine that ends on it meets the keel there
_TIP = 9  #: places of one vertex where bottom or keel ends in a point


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
        -1 inside; 0 stern profile (u = 0), 1 bow profile (u = 1), 2 keel (v = 0), 3 waterline (v = 1), 4 chine; corners count
        as keel or waterline.
    flat_ends : pair of bool
        Whether u = 0 and u = 1 are edges of a flat stern and bow, which are left out, instead of profiles in y = 0.
    kinks : tuple of int
        Vertices where the waterline turns by more than 40 deg, at a tenth of the half beam or more.
    chine : float
        v of the chine, 0 where there is none.
    pinned : tuple of int
        Vertices that keep their place on the square: kinks, corners, ends of the chine, and the copies, at several v, of a
        vertex at which keel and chine meet.
    tips : tuple of int
        Those vertices, which stand for the places from v = 0 up to the chine.
    """

    vertices: Array
    uv: Array
    triangles: Ints
    side: Ints
    flat_ends: tuple[bool, bool] = (False, False)
    kinks: tuple[int, ...] = ()
    chine: float = 0.0
    pinned: tuple[int, ...] = ()
    tips: tuple[int, ...] = ()


def flattened(hull: PanelMesh, *, chine: bool = True) -> Flattened:
    """Return a hull's stored half spread out on the unit square.

    Parameters
    ----------
    hull : PanelMesh
        Symmetry "xz", below z = 0.
    chine : bool
        Look for one.

    Raises
    ------
    InputError
        The half hull is not one piece with one border in z = 0 and y = 0.

    Notes
    -----
    Borders are spread by length: waterline on v = 1, keel on v = 0, the profiles at stern and bow on u = 0 and 1. The profile
    is keel between the two points that are lowest and farthest out together (x over 15 % of the length plus depth over
    draught). At a flat end its edge takes the place of the profile. Inside, each vertex is the mean of its neighbours
    weighted by mean values: such a map is one to one, whatever the triangles. A chine from end to end becomes a line of
    constant v, and bottom and side are spread apart from each other; where the bottom ends in a point, that point becomes a
    side of the square.

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
            loop = border(vertices, tri, 10.0 * near, [i for _, edge in ends for i in edge])
            break
        except InputError as error:
            failure = error
    else:
        raise failure
    corners = corners_of(vertices, loop, 10.0 * near)
    for k, (_, rim) in enumerate(ends):
        if rim:
            corners[k], corners[2 + k] = loop.index(rim[-1]), loop.index(rim[0])
    is_flat = (bool(ends[0][1]), bool(ends[1][1]))
    edge, tips = None, (False, False)
    if chine:
        edge, corners, tips = _with_chine(vertices, tri, loop, corners, is_flat)
    uv, side = on_border(vertices, loop, corners, edge)
    _spread(vertices, tri, uv, side, edge, tips)
    used, index = np.unique(tri, return_inverse=True)
    flat = Flattened(vertices[used], uv[used], index.reshape(tri.shape), side[used], is_flat)
    return _finished(flat, edge.share if edge else 0.0, tips)


def _with_chine(
    vertices: Array, tri: Ints, loop: list[int], corners: list[int], is_flat: tuple[bool, bool]
) -> tuple[Chine | None, list[int], tuple[bool, bool]]:
    """Return the chine, the corners and, for stern and bow, whether the bottom ends in a point (at a corner, then)."""
    stern, bow, low_stern, low_bow = corners
    sides = [between(loop, a, b, [c for c in corners if c not in (a, b)]) for a, b in ((low_stern, low_bow), (stern, bow))]
    chine = find_chine(vertices, tri, keel=sides[0], waterline=sides[1], loop=loop)
    if chine is None:
        return None, corners, (False, False)
    corners, tips = list(corners), [False, False]
    for k, (i, top) in enumerate(((chine.line[0], stern), (chine.line[-1], bow))):
        profile = between(loop, corners[2 + k], top, [c for c in corners if c not in (corners[2 + k], top)])
        at = profile.index(i) / len(profile) if i in profile else 0.0
        tips[k] = not is_flat[k] and at < _FOOT
        if tips[k]:
            corners[2 + k] = loop.index(i)
        elif i not in profile:  # it ends on the keel of a flat end
            return None, list(corners), (False, False)
    return chine, corners, (tips[0], tips[1])


def _spread(vertices: Array, tri: Ints, uv: Array, side: Ints, chine: Chine | None, tips: tuple[bool, bool]) -> None:
    """Put the inner vertices into `uv`, those below and above the chine apart from each other.

    A bottom that ends in points is spread between the chine and a convex line below it, which is then drawn down to v = 0.
    """
    if chine is None:
        inner = _inner(tri, side)
        uv[inner] = _harmonic(vertices, tri, uv, inner)
        return
    share = chine.share
    inner = _inner(tri[~chine.below], side)
    above = np.stack([uv[:, 0], np.maximum(uv[:, 1], share)], axis=1)
    uv[inner] = _harmonic(vertices, tri[~chine.below], above, inner)
    inner = _inner(tri[chine.below], side)
    lens = np.stack([uv[:, 0], share - (share - uv[:, 1]) * _depth(uv[:, 0], tips)], axis=1)
    u, v = _harmonic(vertices, tri[chine.below], lens, inner).T
    uv[inner] = np.stack([u, share - (share - v) / np.maximum(_depth(u, tips), 1e-9)], axis=1)


def _inner(tri: Ints, side: Ints) -> Ints:
    used = np.unique(tri)
    return np.asarray(used[side[used] == -1])


def _depth(u: Array, tips: tuple[bool, bool]) -> Array:
    """Return the depth of the line below the chine, as part of that of the keel: concave, zero at points."""
    depth = (u if tips[0] else 1.0) * ((1.0 - u) if tips[1] else 1.0)
    return np.asarray((4.0 if all(tips) else 1.0) * depth + 0.0 * u)


def _finished(flat: Flattened, share: float, tips: tuple[bool, bool]) -> Flattened:
    """Return the map with its pinned vertices, and with copies of a vertex at which the bottom ends."""
    kinks = _kinks(flat)
    corner = (np.abs(flat.uv - 0.5) == 0.5).all(axis=1)
    ends = (flat.side == 4) & np.isin(flat.uv[:, 0], (0.0, 1.0))
    pinned = [*kinks, *np.flatnonzero(corner | ends).tolist()]
    vertices, uv, side = [flat.vertices], [flat.uv], [flat.side]
    count, at = len(flat.vertices), []
    for k in (0, 1):
        if tips[k]:
            v = np.linspace(0.0, share, _TIP)[1:]
            at.append(int(np.flatnonzero((flat.uv == (float(k), 0.0)).all(axis=1))[0]))
            vertices.append(np.tile(flat.vertices[at[-1]], (len(v), 1)))
            uv.append(np.stack([np.full(len(v), float(k)), v], axis=1))
            side.append(np.full(len(v), k))
            pinned += range(count, count + len(v))
            count += len(v)
    whole = replace(flat, vertices=np.concatenate(vertices), uv=np.concatenate(uv), side=np.concatenate(side))
    return replace(whole, kinks=kinks, chine=share, pinned=tuple(pinned), tips=tuple(at))


def _kinks(flat: Flattened) -> tuple[int, ...]:
    line = np.flatnonzero(flat.side == 3)
    line = line[np.argsort(flat.uv[line, 0])]
    step = np.diff(flat.vertices[line, :2], axis=0)
    turn = np.abs(step[:-1, 0] * step[1:, 1] - step[:-1, 1] * step[1:, 0])
    angle = np.arctan2(turn, (step[:-1] * step[1:]).sum(axis=1))
    broad = flat.vertices[line[1:-1], 1] > _BROAD * flat.vertices[:, 1].max()
    return tuple(line[1:-1][(angle > _KINK) & broad].tolist())


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
