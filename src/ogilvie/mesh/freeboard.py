"""The side of a hull above the water, up to where its stations end, overhangs beyond the waterline included."""

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.ends import end_sheets, upper_end_sheets
from ogilvie.mesh.patches import oriented
from ogilvie.mesh.sections import Surface
from ogilvie.mesh.wetted import Reach, girth_of, weight

Array = NDArray[np.float64]


def freeboard_sheets(side: list[Reach], wet: list[Array], *, nose: float, height: float, out: float) -> list[Array]:
    """Return grids of one half of the hull above the water, ends included, normals outward.

    Parameters
    ----------
    side : list of Reach
        The half from the middle outward.
    wet : list of (m, n + 1, 3) arrays
        Its wet grids; those of bulbs are left out.
    nose : float
        Width of a round nose at its end, m.
    height : float
        Wanted height of the panels, m.
    out : float
        1: towards the bow; -1: towards the stern.
    """
    grids = [g for g in wet if np.all(g[:, -1, 2] == 0.0)]
    line = np.concatenate([grids[0][:1, -1], *(g[1:, -1] for g in grids)])
    pieces = [r.surface for r in side if r.surface.curves[:, -1, 1].max() > 0.0]
    if not pieces:
        raise InputError("above_water: stations that end above the water expected, none found.")
    rows = max(1, round(girth_of(_upper(pieces, line[0, 0], out, None)) / height))
    share = np.linspace(0.0, 1.0, rows + 1)
    last = pieces[-1].x[-1] if out > 0.0 else pieces[-1].x[0]
    overhang, step = abs(last - line[-1, 0]), float(np.linalg.norm(np.diff(line, axis=0), axis=1).mean())
    grid = np.stack([_points(_upper(pieces, p[0], out, None), share, p[0]) for p in line])
    grid[:, 0] = line
    if overhang <= 1e-6 * np.ptp(pieces[0].x):
        return [oriented(grid, (0.0, 1.0, 0.0)), *upper_end_sheets(grid[-1], grids[-1][-1], nose, out)]
    beyond = np.linspace(line[-1, 0], last, max(1, round(overhang / step)) + 1)[1:]
    foot = _crossing(pieces[-1], line[-1, 0])
    upper = np.stack([_points(_upper(pieces, x, out, foot), share, x) for x in beyond])
    sheets, edge = [oriented(np.concatenate([grid, upper]), (0.0, 1.0, 0.0))], upper[-1]
    below = grids[-1][-1]
    if below[:, 2].min() == 0.0 and below[:, 1].max() > 0.0:  # it leaves the water over its breadth: the underside goes on
        across = below[:, 1] / below[-1, 1]
        under = np.stack([below, *(_points(_lower(pieces[-1], x, foot), across, x) for x in beyond)])
        under[1:, -1] = upper[:, 0]
        sheets.append(oriented(under, (0.0, 0.2, -1.0)))
        edge = np.concatenate([under[-1], edge[1:]])
    return [*sheets, *end_sheets(edge, 0.0, out)]


def _crossing(surface: Surface, x: float) -> float:
    """Return the place on the curves (a fractional index) at which the section at x leaves the water."""
    z = surface.sections([x])[0][:, 1]
    k = int(np.argmax(z >= 0.0))
    return 0.0 if k == 0 else k - 1.0 + float(z[k - 1] / (z[k - 1] - z[k]))


def _upper(pieces: list[Surface], x: float, out: float, foot: float | None) -> Array:
    """Return the section at x, of the outermost surface that reaches there, from a place on its curve (None: the water) up."""
    inside = [s for s in pieces[1:] if out * (x - (s.x[0] if out > 0.0 else s.x[-1])) >= 0.0]
    surface = inside[-1] if inside else pieces[0]
    curve = surface.sections([x])[0]
    if curve[-1, 1] <= 0.0:
        raise InputError(f"above_water: stations that end above the water expected, the section at x = {x:.6g} m does not.")
    return _cut(curve, _crossing(surface, x) if foot is None else foot)


def _lower(surface: Surface, x: float, foot: float) -> Array:
    curve = surface.sections([x])[0]
    return _cut(curve[::-1], len(curve) - 1.0 - foot)[::-1]


def _cut(curve: Array, foot: float) -> Array:
    """Return a curve from a fractional index on."""
    k = int(np.floor(foot))
    first = curve[k] + (foot - k) * (curve[min(k + 1, len(curve) - 1)] - curve[k])
    return np.vstack([first, curve[k + 1 :]])


def _points(part: Array, share: Array, x: float) -> Array:
    """Return points (n, 3) at shares of the length of a curve in the plane of x."""
    w = weight(part, 0.0)
    return np.stack([np.full(len(share), x), *(np.interp(share * w[-1], w, part[:, k]) for k in (0, 1))], axis=-1)
