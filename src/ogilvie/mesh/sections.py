"""Stations as smooth curves of one common parameter, and the surface through all of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError

Array = NDArray[np.float64]
Station = tuple[float, ArrayLike]

#: Points of a curve between two chines (or keel and top).
_N_U = 160
#: A turn of more than this between two sides of a station is a corner (rad); less is a sampled bend.
CORNER = np.deg2rad(45.0)


@dataclass(frozen=True, eq=False)
class Surface:
    """Port half of a hull: curves from keel to top through the stations, each point joined to its like on the next one.

    Parameters
    ----------
    x : (n_s,) array
        Stations, ascending, m.
    curves : (n_s, n_u, 2) array
        Half-breadth and height above still water along each station, m.
    chines : tuple of int
        Indices on the curves where every station has a corner.
    knuckles : tuple of int
        Stations at which the lines along the hull may have a corner.

    Notes
    -----
    Between stations, each coordinate of each line of equal index is a piecewise cubic that is monotone wherever the stations
    are (Fritsch-Carlson): nothing overshoots, and a parallel midbody stays parallel.
    """

    x: Array
    curves: Array
    chines: tuple[int, ...] = ()
    knuckles: tuple[int, ...] = ()

    def sections(self, x: ArrayLike) -> Array:
        """Return the curves (n, n_u, 2) at x (n,), m."""
        from scipy.interpolate import PchipInterpolator

        at = np.clip(np.asarray(x, dtype=float), self.x[0], self.x[-1])
        out = np.empty((len(at), *self.curves.shape[1:]))
        ends = [0, *self.knuckles, len(self.x) - 1]
        for a, b in pairwise(ends):
            here = (at >= self.x[a]) & (at <= self.x[b])
            out[here] = PchipInterpolator(self.x[a : b + 1], self.curves[a : b + 1], axis=0)(at[here])
        out[..., 0] = np.maximum(out[..., 0], 0.0)  # rounding
        return out


@dataclass(frozen=True, eq=False)
class Lines:
    """A hull's lines: the surface of the main body and, outward of it, those of what carries on behind a post.

    Parameters
    ----------
    main : Surface
    aft, fore : tuples of Surface
        Overhang above a skeg or bulb below a stem, from the inside out; each starts at the station where the one before ends.
    """

    main: Surface
    aft: tuple[Surface, ...] = ()
    fore: tuple[Surface, ...] = ()

    @property
    def breadth(self) -> float:
        """Greatest half-breadth, m."""
        return float(self.main.curves[..., 0].max())

    @property
    def middle(self) -> float:
        """The x half-way between the outermost stations of the main body that reach into the water, m."""
        at = [x for x, c in zip(self.main.x, self.main.curves, strict=True) if c[0, 1] < 0.0]
        return float(0.5 * (at[0] + at[-1]))


def lofted(stations: Sequence[Station], *, draught: float | None = None, knuckles: Sequence[float] = ()) -> Lines:
    """Return the lines through stations.

    Parameters
    ----------
    stations : sequence of (x, points)
        x forward, m; points (n, 2) of half-breadth and height, from keel to top or back, m.
    draught : float, optional
        Heights are above the baseline and the water is at this height, m; None: heights are above still water.
    knuckles : sequence of float
        x of stations at which the lines along the hull may have a corner, m.

    Notes
    -----
    Along a station, a point's parameter is half its share of the travel in y plus half its share of the travel in z. So
    keel, bilge and side meet their likes on the next station, whatever the station's breadth and depth.

    A run of points on the centreline (y = 0) at the bottom of a station, over at least a quarter of its height, is a post:
    the hull below closes on it, and what is above carries on. A shorter run is left out: the profile then rises to where the
    hull is solid. A station that closes on the centreline below the water is a bulb: the stem above it closes there.
    """
    listed = sorted((_read(i, x, p, draught) for i, (x, p) in enumerate(stations)), key=lambda s: s[0])
    if len(listed) < 2:
        raise InputError(f"stations: at least two expected, {len(listed)} found.")
    x = np.array([s[0] for s in listed])
    if np.any(np.diff(x) <= 0.0):
        raise InputError(f"stations: different x expected, x = {x[1:][np.diff(x) <= 0.0][0]:.6g} m found twice.")
    _check_water(x, [p for _, p in listed])
    if unknown := [k for k in knuckles if np.abs(x - k).min() > 1e-9 * np.ptp(x)]:
        raise InputError(f"knuckles: x of stations expected, {unknown[0]!r} found; stations are at {x.tolist()}.")
    middle = int(np.argmax([max(-p[0, 1], 0.0) * p[:, 0].max() for _, p in listed]))
    fore, aft = _chain(listed[middle:]), _chain(listed[middle::-1])
    return Lines(
        _surface(aft[0][:0:-1] + fore[0], knuckles),
        tuple(_surface(piece[::-1], knuckles) for piece in aft[1:]),
        tuple(_surface(piece, knuckles) for piece in fore[1:]),
    )


def _chain(listed: list[tuple[float, Array]]) -> list[list[tuple[float, Array]]]:
    """Return the stations from the middle outward, divided at posts: each ends one piece and starts the next."""
    pieces: list[list[tuple[float, Array]]] = [[]]
    top = listed[0][1][-1, 1]
    for i, (x, p) in enumerate(listed):
        solid, outer = _solid(p), i + 1 < len(listed) and i > 0
        low, bulb = solid[0, 1] - p[0, 1], solid[-1, 1] < 0.0
        was_bulb = bool(pieces[-1]) and pieces[-1][-1][1][-1, 1] < 0.0
        if was_bulb and not bulb:
            raise InputError(
                f"stations: the one at x = {pieces[-1][-1][0]:.6g} m closes below the water (a bulb), so those farther out "
                f"should too, but the one at x = {x:.6g} m does not. Give each station as one outline from keel to deck."
            )
        if outer and len(solid) > 1 and (low >= 0.25 * np.ptp(p[:, 1]) or (bulb and not was_bulb)):
            pieces[-1].append((x, np.vstack([p, [0.0, top]]) if bulb and p[-1, 1] < top else p))
            pieces.append([(x, solid)])
        else:
            pieces[-1].append((x, solid))
        top = max(p[-1, 1], 0.0) if not bulb else top
    return pieces


def _solid(p: Array) -> Array:
    """Return a station without its runs on the centreline; all of one that has no breadth."""
    off = np.flatnonzero(p[:, 0] > 0.0)
    return p if len(off) == 0 else p[max(off[0] - 1, 0) : min(off[-1] + 1, len(p) - 1) + 1]


def _surface(listed: list[tuple[float, Array]], knuckles: Sequence[float]) -> Surface:
    x, points = np.array([x for x, _ in listed]), [p for _, p in listed]
    corners = _chines(points)
    curves = np.array([_curve(p, c) for p, c in zip(points, corners, strict=True)])
    turning = sorted({int(np.argmin(np.abs(x - k))) for k in knuckles if x[0] < k < x[-1]})
    return Surface(x, curves, tuple((k + 1) * _N_U for k in range(len(corners[0]))), tuple(turning))


def _read(i: int, x: float, points: ArrayLike, draught: float | None) -> tuple[float, Array]:
    """Return a station's x and points from keel to top, heights above still water, deck left out."""
    P = np.array(points, dtype=float)
    if not np.isfinite(x) or P.ndim != 2 or P.shape[1] != 2 or len(P) == 0 or not np.all(np.isfinite(P)):
        raise InputError(
            f"stations[{i}]: x and an (n, 2) list of finite (half-breadth, height) expected, x = {x!r}, {P.shape} found."
        )
    if P[:, 0].min() < 0.0:
        raise InputError(f"stations[{i}] (x = {x:.6g} m): half-breadths >= 0 expected, {P[:, 0].min():.6g} m found.")
    P[:, 0] = np.where(P[:, 0] < 1e-9 * np.abs(P).max(), 0.0, P[:, 0])
    if P[0, 1] > P[-1, 1]:
        P = P[::-1]
    P = P[np.r_[True, np.hypot(*np.diff(P, axis=0).T) > 1e-9 * np.abs(P).max()]]
    water = draught or 0.0
    while len(P) > 2 and P[-2, 1] >= water and abs(P[-1, 1] - P[-2, 1]) < 0.2 * (P[-2, 0] - P[-1, 0]):
        P = P[:-1]  # deck
    if P[0, 0] > 0.0:
        P = np.vstack([[0.0, P[0, 1]], P])  # flat bottom
    return float(x), P - [0.0, water]


def _check_water(x: Array, points: list[Array]) -> None:
    for xi, p in zip(x, points, strict=True):
        if p[-1, 1] < 0.0 and p[-1, 0] > 0.0:
            raise InputError(
                f"stations: points up to the water expected, the station at x = {xi:.6g} m ends {-p[-1, 1]:.6g} m below it at "
                f"half-breadth {p[-1, 0]:.6g} m. Add points up to the deck, or a last point at half-breadth 0."
            )
    if min(p[0, 1] for p in points) >= 0.0:
        raise InputError("stations: points below the water expected, none found. Check draught and heights.")


def _turns(p: Array) -> Array:
    """Return the angles (n - 2,) by which the polygon turns at its inner points, rad, positive towards the inside of a hull."""
    d = np.diff(p, axis=0)
    cross = d[:-1, 0] * d[1:, 1] - d[:-1, 1] * d[1:, 0]
    return np.arctan2(cross, (d[:-1] * d[1:]).sum(axis=1))


def _corners(p: Array) -> NDArray[np.int64]:
    return 1 + np.flatnonzero(np.abs(_turns(p)) > CORNER) if len(p) > 2 else np.array([], dtype=np.int64)


def _chines(points: list[Array]) -> list[list[Array]]:
    """Return each station's wet corner points off the centreline where all wet stations have as many, else none."""
    wet = [p[:, 0].max() > 0.0 and p[0, 1] < 0.0 for p in points]
    found = [
        [p[k] for k in _corners(p) if p[k, 0] > 0.0 and (p[k, 1] < 0.0 or not w)] for p, w in zip(points, wet, strict=True)
    ]
    numbers = {len(c) for c, w in zip(found, wet, strict=True) if w}
    if len(numbers) != 1 or numbers == {0}:
        return [[] for _ in points]
    n, solid = numbers.pop(), [i for i, w in enumerate(wet) if w]
    for i in (i for i, w in enumerate(wet) if not w):
        found[i] = found[i][:n]
        if len(found[i]) < n:  # a stem line or the like is divided in height as the wet station next to it
            j = min(solid, key=lambda s: abs(s - i))
            share = [(c[1] - points[j][0, 1]) / np.ptp(points[j][:, 1]) for c in found[j]]
            heights = [points[i][0, 1] + s * np.ptp(points[i][:, 1]) for s in share]
            found[i] = [points[i][np.argmin(np.abs(points[i][:, 1] - z))] * [1.0, 0.0] + [0.0, z] for z in heights]
    return found


def _curve(p: Array, chines: list[Array]) -> Array:
    """Return the station as a smooth curve (n_u, 2), evenly spaced in its parameter between chines, corners kept."""
    dense, corners = _dense(p)
    ends = [0, *(int(np.argmin(np.hypot(*(dense - c).T))) for c in chines), len(dense) - 1]
    pieces = []
    for a, b in pairwise(ends):
        q = dense[a : b + 1] if b > a else dense[[a, a]]
        step = np.abs(np.diff(q, axis=0))
        travel = step.sum(axis=0)
        share = step / np.maximum(travel, max(0.05 * travel.sum(), 1e-300))
        u = np.r_[0.0, np.cumsum(share.sum(axis=1) + 1e-12)]
        piece = np.stack([np.interp(np.linspace(0.0, u[-1], _N_U + 1), u, q[:, k]) for k in (0, 1)], axis=-1)
        for k in (k for k in corners if a < k < b):
            piece[min(max(round(u[k - a] / u[-1] * _N_U), 1), _N_U - 1)] = dense[k]
        pieces.append(piece)
    return np.concatenate([pieces[0], *(q[1:] for q in pieces[1:])])


def _dense(p: Array) -> tuple[Array, list[int]]:
    """Return the polygon as a smooth dense one, monotone cubics of chord length between corners, and the corners' indices."""
    from scipy.interpolate import PchipInterpolator

    if len(p) < 2:
        return np.repeat(p, 2, axis=0), []
    center = np.flatnonzero(np.diff((p[:, 0] == 0.0).astype(int)) != 0)  # where the curve leaves or meets the centreline
    posts = [k if p[k, 0] == 0.0 else k + 1 for k in center]
    breaks = sorted({0, *_corners(p).tolist(), *posts, len(p) - 1})
    out, at = [p[:1]], [0]
    for a, b in pairwise(breaks):
        q = p[a : b + 1]
        s = np.r_[0.0, np.cumsum(np.hypot(*np.diff(q, axis=0).T))]
        out.append(PchipInterpolator(s, q, axis=0)(np.unique(np.r_[s, np.linspace(0.0, s[-1], 200)]))[1:])
        at.append(at[-1] + len(out[-1]))
    return np.concatenate(out), at[1:-1]
