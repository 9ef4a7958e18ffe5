"""How a hull closes at its ends: round noses, flat transoms, below and above the water."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.patches import coons, oriented
from ogilvie.mesh.sections import Lines
from ogilvie.mesh.wetted import Reach, area_of, wet

Array = NDArray[np.float64]
Closing = Literal["auto", "round", "flat"]


def nose_width(lines: Lines, last: Reach, closing: Closing, *, end: str) -> float:
    """Return the greatest half-breadth of the last section where a round nose closes it, 0 for a flat or sharp end, m."""
    if closing not in ("auto", "round", "flat"):
        raise InputError(f"{end}: 'auto', 'round' or 'flat' expected, {closing!r} found.")
    part = wet(last.surface.sections(last.x[-1:])[0])
    if part is None or last.area[-1] <= 1e-9 * lines.breadth**2:
        return 0.0
    width, bulb = float(part[:, 0].max()), part[-1, 1] < 0.0
    small = end == "bow" and width < 0.15 * lines.breadth
    return width if closing == "round" or (closing == "auto" and small) or bulb else 0.0


def nose_volume(nose: float, last: Reach) -> float:
    """Return the volume of both sides of a round nose, m3."""
    part = wet(last.surface.sections(last.x[-1:])[0])
    return 0.0 if part is None else float(0.5 * np.pi * np.trapezoid(part[:, 0] * _nose_length(nose, part[:, 0]), part[:, 1]))


def _nose_length(nose: float, y: Array) -> Array:
    """Return how far a nose goes beyond a last section where that is y wide: an ellipse at each height, longest at the bulb."""
    return np.sqrt(nose * y)


def end_sheets(edge: Array, nose: float, side: float) -> list[Array]:
    """Return grids that close the hull beyond the edge (n, 3) of its side, from keel to water; side 1: bow, -1: stern."""
    if nose > 0.0:
        return [_nose(edge, nose, side, _nose_columns(edge, nose))]
    flat = _transom(edge)
    return [] if flat is None else [oriented(flat, (side, 0.0, 0.0))]


def upper_end_sheets(edge: Array, below: Array, nose: float, side: float) -> list[Array]:
    """Return grids that close the hull above the water beyond the edge (n, 3) of its side, from water to deck.

    `below` is the edge below the water: where both meet, the grids share its vertices.
    """
    if edge[:, 1].max() <= 0.0:
        return []
    if nose > 0.0:
        return [_nose(edge, nose, side, _nose_columns(below, nose))]
    water = _water_row(below)
    if edge[0, 1] > 0.0 and len(water) > 1:
        across = water[:, 1] / water[-1, 1]
        fill = np.stack([np.outer(across, p * [0.0, 1.0, 0.0]) + p * [1.0, 0.0, 1.0] for p in edge])
    else:
        rim = edge[max(int(np.argmax(edge[:, 1] > 0.0)) - 1, 0) :]
        fill = np.stack([rim, rim * [1.0, 0.0, 1.0]])
    return [oriented(fill, (side, 0.0, 0.0))]


def _water_row(edge: Array) -> Array:
    """Return the vertices (n, 3) at z = 0 of the end below the water, from the centreline out."""
    flat = _transom(edge)
    candidates = edge if flat is None else flat.reshape(-1, 3)
    row = candidates[np.abs(candidates[:, 2]) < 1e-9]
    return row[np.unique(row[:, 1], return_index=True)[1]]


def _nose_columns(edge: Array, nose: float) -> int:
    """Return how many panels go round a nose: about 1.5 times as long as those of the edge are high."""
    return int(np.clip(round(0.5 * np.pi * nose / (1.5 * np.linalg.norm(np.diff(edge, axis=0), axis=1).mean())), 2, 12))


def _nose(edge: Array, nose: float, side: float, n: int) -> Array:
    """Return a nose whose waterplanes, ellipses with n chords, have the area of the ellipse: inner corners are moved out."""
    d = 0.5 * np.pi / n
    # (n - 2) f^2 + 2 f = pi / (2 sin d): area of the triangles between the radii 1, f, .., f, 1
    need = 0.5 * np.pi / np.sin(d)
    f = 0.5 * need if n == 2 else (np.sqrt(1.0 + (n - 2) * need) - 1.0) / (n - 2)
    factor = np.r_[1.0, np.full(n - 1, f), 1.0][:, None]
    angle = d * np.arange(n + 1)[:, None]
    ahead = side * _nose_length(nose, edge[:, 1])
    x, y = edge[:, 0] + factor * ahead * np.sin(angle), factor * edge[:, 1] * np.cos(angle)
    y[-1] = 0.0
    return oriented(np.dstack([x, y, edge[:, 2] + 0.0 * angle]), (side, 1.0, 0.0))


def _transom(edge: Array) -> Array | None:
    """Return a grid that fills the plane between an end section (n, 3) and the centreline; None for a sharp end."""
    rim = edge[max(int(np.argmax(edge[:, 1] > 0.0)) - 1, 0) :]
    area = area_of(rim[:, 1:])
    if len(rim) < 2 or area <= 1e-6 * np.ptp(edge[:, 2]) ** 2:
        return None
    ruled = np.stack([rim, rim * [1.0, 0.0, 1.0]])
    n, top, width, depth = len(rim) - 1, rim[-1] * [1.0, 0.0, 1.0], rim[-1, 1], rim[-1, 2] - rim[0, 2]
    if n < 2 or width <= 0.0:
        return ruled
    bulge = rim[:, 1] / width - (rim[:, 2] - rim[0, 2]) / depth
    j = 1 + int(np.argmax(bulge[1:n]))  # corner between bottom and side
    across, up = rim[: j + 1, 1] / rim[j, 1], np.linspace(0.0, 1.0, len(rim) - j)
    water, center = top + np.outer(across, rim[-1] - top), rim[0] + np.outer(up, top - rim[0])
    fill = coons(rim[: j + 1], water, center, rim[j:])
    return fill if _unsigned_area(fill) <= area * (1.0 + 1e-6) else ruled


def _unsigned_area(fill: Array) -> float:
    """Return the sum of the panels' areas, m2: more than the area inside the border where panels overlap."""
    d1, d2 = fill[1:, 1:] - fill[:-1, :-1], fill[:-1, 1:] - fill[1:, :-1]
    return float(0.5 * np.linalg.norm(np.cross(d1, d2), axis=-1).sum())
