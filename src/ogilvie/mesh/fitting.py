"""A smooth surface through the vertices of a panelled half hull: one sheet of cubic B-splines on the unit square."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ogilvie.mesh.flattening import Flattened

Array = NDArray[np.float64]

_DEGREE = 3
_SPANS = (0.45, 0.6)  #: spans of the splines for each row of vertices, along and across
_STIFF = 1e-4  #: weight of squared second differences of the coefficients against squared distances
_ON_BORDER = 3.0  #: weight of vertices on keel, profiles and waterline
_ONE_SIDED = 5  #: solutions in which coefficients that came out on the wrong side of a plane are held in it
_BETWEEN = 0.05  #: weight of the middles between vertices, which keep the surface from swinging there
_ROUNDS = 4  #: corrections of the vertices' places on the sheet


@dataclass(frozen=True, eq=False)
class Sheet:
    """A surface of cubic B-splines over the unit square; u from stern to bow, v from keel to waterline.

    Parameters
    ----------
    knots : pair of arrays
        Of u and of v.
    coefficients : (n_u, n_v, 3) array
        m.
    flat_ends : pair of bool
        As in :class:`ogilvie.mesh.flattening.Flattened`.
    kinks : tuple of float
        Places u at which lines along the ship may have a corner.
    chine : float
        v at which lines across the ship may have one, 0 for none.
    """

    knots: tuple[Array, Array]
    coefficients: Array
    flat_ends: tuple[bool, bool] = (False, False)
    kinks: tuple[float, ...] = ()
    chine: float = 0.0

    def at(self, u: Array, v: Array) -> Array:
        """Return the positions (n_u, n_v, 3) at the products of u and v, m."""
        U, V = _rows(self.knots[0], u), _rows(self.knots[1], v)
        return np.asarray(np.einsum("ai,bj,ijk->abk", U, V, self.coefficients))

    def points(self, uv: Array, *, along: int = -1) -> Array:
        """Return the positions (n, 3) at places uv (n, 2), or their derivatives by u (`along` 0) or v (1)."""
        U, V = (_rows(k, t, derivative=int(along == i)) for i, (k, t) in enumerate(zip(self.knots, uv.T, strict=True)))
        return np.asarray(np.einsum("ai,aj,ijk->ak", U, V, self.coefficients))


def fitted(flat: Flattened) -> Sheet:
    """Return the sheet that comes nearest to the vertices.

    Notes
    -----
    Least squares of the distances of vertices and, with little weight, of the middles between neighbours, with a small
    penalty on second differences of the coefficients. Keel and profiles lie in y = 0 and the
    waterline in z = 0 exactly: their coefficients there are zero; no coefficient of y is
    negative, none of z positive. After each fit, vertices
    move on the sheet to the place nearest to them (Gauss-Newton), so that in the end distances count, not places. Knots are
    where vertices are many; three of them where the waterline has a corner, and along a chine, so that the surface may have
    one.

    Examples
    --------
    >>> from ogilvie.mesh.flattening import flattened
    >>> from ogilvie.mesh.shapes import wigley
    >>> hull = wigley(panels=1000).translated((0.1, 0.0, 0.0))
    >>> flat = flattened(hull)
    >>> sheet = fitted(flat)
    >>> bool(np.abs(sheet.points(flat.uv) - flat.vertices).max() < 0.02 * hull.beam)
    True
    """
    knots = _knots(flat)
    flat, weight = replace(flat, uv=flat.uv.copy()), np.where(flat.side >= 0, _ON_BORDER, 1.0)
    sheet = _least_squares(flat, knots, weight)
    for _ in range(_ROUNDS):
        flat = replace(flat, uv=_nearer(sheet, flat))
        sheet = _least_squares(flat, knots, weight)
    return sheet


def _knots(flat: Flattened) -> tuple[Array, Array]:
    rows = float(np.sqrt(len(flat.vertices)))
    along = int((flat.side == 3).sum())
    counts = (max(6, round(_SPANS[0] * along)), max(3, round(_SPANS[1] * rows**2 / along)))
    out: list[Array] = []
    corners = (flat.uv[list(flat.kinks), 0], np.array([flat.chine] if flat.chine > 0.0 else []))
    for n, t, kinks in zip(counts, flat.uv.T, corners, strict=True):
        s = np.linspace(0.0, 1.0, n + 1)[1:-1]
        inner = 0.5 * s + 0.5 * np.quantile(t, s)
        if len(kinks):  # three knots at one place: the surface may have a corner there
            inner = inner[np.abs(inner[:, None] - kinks).min(axis=1) > 0.3 / n]
            inner = np.sort(np.r_[inner, np.repeat(kinks, _DEGREE)])
        out.append(np.r_[np.zeros(_DEGREE + 1), inner, np.ones(_DEGREE + 1)])
    return out[0], out[1]


def _rows(knots: Array, t: Array, *, derivative: int = 0) -> Array:
    from scipy.interpolate import BSpline

    n = len(knots) - _DEGREE - 1
    return np.asarray(BSpline(knots, np.eye(n), _DEGREE)(np.clip(t, 0.0, 1.0), derivative))


def _least_squares(flat: Flattened, knots: tuple[Array, Array], weight: Array) -> Sheet:
    ends = np.unique(np.sort(flat.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    between = flat.uv[ends]
    tip = np.isin(ends, flat.tips)
    between[..., 1] = np.where(tip, np.minimum(between[:, ::-1, 1], flat.chine), between[..., 1])
    uv, places = np.vstack([flat.uv, between.mean(axis=1)]), np.vstack([flat.vertices, flat.vertices[ends].mean(axis=1)])
    weight = np.r_[weight, _BETWEEN * weight[ends].min(axis=1)]
    U, V = (_rows(k, t) for k, t in zip(knots, uv.T, strict=True))
    nu, nv = U.shape[1], V.shape[1]
    A = (weight[:, None, None] * U[:, :, None] * V[:, None, :]).reshape(len(U), nu * nv)
    du, dv = np.diff(np.eye(nu), 2, axis=0), np.diff(np.eye(nv), 2, axis=0)
    stiff = np.sqrt(_STIFF * len(U) / (nu * nv)) * np.vstack([np.kron(du, np.eye(nv)), np.kron(np.eye(nu), dv)])
    index = np.arange(nu * nv).reshape(nu, nv)
    profiles = [index[k] for k, flat_one in ((0, flat.flat_ends[0]), (-1, flat.flat_ends[1])) if not flat_one]
    zero = {1: np.unique(np.concatenate([index[:, 0], *profiles])), 2: index[:, -1]}
    M, b = A.T @ A + stiff.T @ stiff, A.T @ (weight[:, None] * places)
    C = np.zeros((nu * nv, 3))
    known = _known(flat, knots[1], index)
    for k, sign in ((0, 0.0), (1, 1.0), (2, -1.0)):
        fixed = {int(i): float(p[k]) for i, p in known.items()} | dict.fromkeys(zero.get(k, index[:0, 0]).tolist(), 0.0)
        C[:, k] = _solved(M, b[:, k], fixed, sign)
    return Sheet(knots, C.reshape(nu, nv, 3), flat.flat_ends, tuple(flat.uv[list(flat.kinks), 0].tolist()), flat.chine)


def _known(flat: Flattened, knots: Array, index: NDArray[np.int64]) -> dict[int, Array]:
    """Return the coefficients that stand for a vertex in which the bottom ends: on a side of the square up to the chine."""
    last = int(np.searchsorted(knots, flat.chine)) - 1 if flat.chine > 0.0 else -1
    return {int(i): flat.vertices[tip] for tip in flat.tips for i in index[-int(flat.uv[tip, 0]), : last + 1]}


def _solved(M: Array, b: Array, fixed: dict[int, float], sign: float) -> Array:
    """Return the solution of M c = b with some c given and, where `sign` is not zero, none of the other sign."""
    held, values = np.array(list(fixed), dtype=np.int64), np.array(list(fixed.values()))
    c, free = np.zeros(len(b)), np.setdiff1d(np.arange(len(b)), held)
    b = b - M[:, held] @ values
    for _ in range(_ONE_SIDED):
        c[:] = 0.0
        c[held] = values
        c[free] = np.linalg.solve(M[np.ix_(free, free)], b[free])
        if (sign * c).min() >= 0.0:
            return c
        free = free[sign * c[free] > 0.0]
    return np.where(sign * c < 0.0, 0.0, c)


def _nearer(sheet: Sheet, flat: Flattened) -> Array:
    """Return the vertices' places one Gauss-Newton step nearer; those on border and chine stay there, pinned ones at rest."""
    off = flat.vertices - sheet.points(flat.uv)
    a, b = sheet.points(flat.uv, along=0), sheet.points(flat.uv, along=1)
    aa, ab, bb, ar, br = ((p * q).sum(axis=1) for p, q in ((a, a), (a, b), (b, b), (a, off), (b, off)))
    det = np.maximum(aa * bb - ab**2, 1e-6 * aa * bb + 1e-300)
    step = np.stack([bb * ar - ab * br, aa * br - ab * ar], axis=-1) / det[:, None]
    on_v, on_u = (flat.side == 0) | (flat.side == 1), flat.side >= 2
    step[on_u] = np.stack([ar / np.maximum(aa, 1e-300), 0.0 * ar], axis=-1)[on_u]
    step[on_v] = np.stack([0.0 * br, br / np.maximum(bb, 1e-300)], axis=-1)[on_v]
    step[list(flat.pinned)] = 0.0
    most = np.array([0.5 / (len(k) - 2 * _DEGREE - 1) for k in sheet.knots])
    moved = flat.uv + np.clip(step, -most, most)
    inside, below = flat.side == -1, flat.uv[:, 1] < flat.chine
    moved[inside] = np.clip(moved[inside], 1e-6, 1.0 - 1e-6)
    moved[inside & below, 1] = np.minimum(moved[inside & below, 1], flat.chine - 1e-6)
    moved[inside & ~below, 1] = np.maximum(moved[inside & ~below, 1], flat.chine + 1e-6)
    return np.clip(moved, 0.0, 1.0)
