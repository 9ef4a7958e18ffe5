"""What of a hull's lines is wet, section by section: from the middle outward to where the hull ends or leaves the water."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ogilvie.mesh.sections import Lines, Surface

Array = NDArray[np.float64]

_FINE = 300  #: sections that measure a stretch
_BEND = 0.3  #: a right-angled bend counts as this part of the largest girth in the spacing of lines along it
_SMOOTH = np.deg2rad(10.0)  #: most that a turn at one point counts: a corner needs no lines close together


@dataclass(frozen=True, eq=False)
class Reach:
    """A surface from one section outward to its end, measured where it is wet.

    Parameters
    ----------
    surface : Surface
    x : (n,) array
        Sections, from the inner to the outer end, m.
    keel, girth, area : (n,) arrays
        Lowest point z, m; wet girth, m; area of the port half, m2.
    rise : (n,) array
        By how much the profile rose steeply up to here, m: lines along the hull end there.
    ended : (n,) array
        Share of those lines, keel side first, that have ended.
    path : (n,) array
        Length along waterline and keel together from the inner end, over that of the whole reach.
    """

    surface: Surface
    x: Array
    keel: Array
    girth: Array
    area: Array
    rise: Array
    ended: Array
    path: Array

    @property
    def volume(self) -> float:
        """Volume of both sides, m3."""
        return 2.0 * float(abs(np.trapezoid(self.area, self.x)))

    @property
    def length(self) -> float:
        """Distance from the inner to the outer end, m."""
        return float(abs(self.x[-1] - self.x[0]))


def wet(curve: Array) -> Array | None:
    """Return the wet part (n, 2) of a section's curve; None if it is dry."""
    y, z = curve.T
    if z[0] >= 0.0:
        return None
    above = np.flatnonzero(z >= 0.0)
    if len(above) == 0:
        return curve
    k = int(above[0])
    f = z[k - 1] / (z[k - 1] - z[k])
    return np.vstack([curve[:k], [y[k - 1] + f * (y[k] - y[k - 1]), 0.0]])


def weight(part: Array, bend: float) -> Array:
    """Return the length along a curve (n, 2) up to each point, a turn by a right angle counted as `bend` half-breadths more."""
    d = np.diff(part, axis=0)
    turn = np.abs(np.arctan2(d[:-1, 0] * d[1:, 1] - d[:-1, 1] * d[1:, 0], (d[:-1] * d[1:]).sum(axis=1)))
    turn = np.minimum(turn, _SMOOTH)
    extra = bend * part[:, 0].max() / (0.5 * np.pi)
    return np.cumsum(np.r_[0.0, np.hypot(*d.T) + extra * np.r_[turn, 0.0]])


def with_rise(part: Array, rise: float) -> Array:
    """Return a wet section with the length of profile that rose steeply before it, as a vertical on the centreline."""
    return np.vstack([part[0] - [0.0, rise], part])


def girth_of(part: Array) -> float:
    """Return the length of a curve (n, 2), m."""
    return float(np.hypot(*np.diff(part, axis=0).T).sum())


def area_of(part: Array) -> float:
    """Return the area between a curve (n, 2) of half-breadth and height and the centreline, m2."""
    return float((0.5 * (part[1:, 0] + part[:-1, 0]) * np.diff(part[:, 1])).sum())


def bend_length(lines: Lines) -> float:
    """Return the length that a right-angled bend counts for on this hull, in half-breadths of the section."""
    parts = [wet(c) for c in lines.main.curves]
    return _BEND * max(girth_of(p) for p in parts if p is not None) / lines.breadth


def reaches(lines: Lines, side: int) -> list[Reach]:
    """Return the stretches of hull from the middle to one end (side 1: bow, -1: stern).

    A new one starts behind each post, and where a profile that rose steeply turns level again.
    """
    bend, total = bend_length(lines), float(np.ptp(lines.main.x))
    pieces = [lines.main, *(lines.fore if side > 0 else lines.aft)]
    starts = [lines.middle] + [p.x[0] if side > 0 else p.x[-1] for p in pieces[1:]]
    out = []
    for piece, start in zip(pieces, starts, strict=True):
        x, parts = _wet_sections(piece, start, side)
        steep = _steep(x, parts) if not piece.chines else np.zeros(len(x) - 1, dtype=bool)
        cuts = [0, *_turns_level(x, parts, steep, 0.015 * total), len(x) - 1]
        out += [_measured(piece, x[a : b + 1], parts[a : b + 1], steep[a:b], bend) for a, b in pairwise(cuts)]
    return out


def _measured(surface: Surface, x: Array, parts: list[Array], steep: NDArray[np.bool_], bend: float) -> Reach:
    keel, area = np.array([p[0, 1] for p in parts]), np.array([area_of(p) for p in parts])
    girth = np.array([girth_of(p) for p in parts])
    rise = np.r_[0.0, np.cumsum(np.where(steep, np.maximum(np.diff(keel), 0.0), 0.0))]
    weights = [weight(with_rise(p, r), bend) for p, r in zip(parts, rise, strict=True)]
    ended = np.maximum.accumulate([w[1] / max(w[-1], 1e-300) for w in weights])
    outline = np.stack([x, np.array([p[-1, 0] for p in parts]), keel])
    path = np.cumsum(np.r_[0.0, np.linalg.norm(np.diff(outline, axis=1), axis=0)])
    return Reach(surface, x, keel, girth, area, rise, ended, path / path[-1])


def _wet_sections(surface: Surface, inner: float, side: int) -> tuple[Array, list[Array]]:
    """Return x of closely spaced wet sections, outward, and the sections."""
    outer = surface.x[-1] if side > 0 else surface.x[0]
    x = np.concatenate([np.linspace(inner, outer, _FINE), surface.x])
    x = side * np.unique(side * x[side * (x - inner) >= 0.0])
    found = [wet(c) for c in surface.sections(x)]
    dry = next((i for i, w in enumerate(found) if w is None), len(x))
    if dry < len(x):
        last = _last_wet(surface, x[dry - 1], x[dry])
        x, found = np.r_[x[:dry], last], [*found[:dry], wet(surface.sections([last])[0])]
    return x, [w for w in found if w is not None]


def _last_wet(surface: Surface, inner: float, dry: float) -> float:
    """Return the x where the hull leaves the water, between a wet and a dry section, by bisection."""
    while abs(dry - inner) > 1e-10 * np.ptp(surface.x):
        x = 0.5 * (inner + dry)
        inner, dry = (inner, x) if wet(surface.sections([x])[0]) is None else (x, dry)
    return inner


def _steep(x: Array, parts: list[Array]) -> NDArray[np.bool_]:
    """Return where (n - 1,), between sections, lines along the hull should end on the profile.

    It rises by more than 45 deg or the section has become small, and the section is narrow at its foot (a stem, not a rake).
    """
    keel, girth = np.array([p[0, 1] for p in parts]), np.array([girth_of(p) for p in parts])
    up, along = np.diff(keel), np.abs(np.diff(x))
    foot = np.array([np.interp(0.9 * p[0, 1] + 0.1 * p[-1, 1], p[:, 1], p[:, 0]) for p in parts])
    narrow = foot < 0.25 * girth
    return ((up > along) | ((girth[1:] < 0.3 * girth.max()) & (up > 0.0))) & narrow[1:]


def _turns_level(x: Array, parts: list[Array], steep: NDArray[np.bool_], least: float) -> list[int]:
    """Return the sections where a steep rise by over a twentieth of the depth ends before a level stretch of over `least` m."""
    keel, cuts, foot = np.array([p[0, 1] for p in parts]), [], None
    for i, rising in enumerate(steep):
        if rising and foot is None:
            foot = i
        if not rising and foot is not None:
            more = np.flatnonzero(steep[i:])
            level_to = i + int(more[0]) if len(more) else len(x) - 1
            if keel[i] - keel[foot] > -0.05 * keel.min() and abs(x[level_to] - x[i]) > least:
                cuts.append(i)
            foot = None
    return cuts
