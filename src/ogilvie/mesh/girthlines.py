"""The wet side of a hull as a grid: lines along it at shares of the girth, sections across."""

import numpy as np
from numpy.typing import NDArray

from ogilvie.mesh.patches import graded
from ogilvie.mesh.sections import Lines
from ogilvie.mesh.wetted import Reach, bend_length, weight, wet, with_rise

Array = NDArray[np.float64]

_GIRTH_GRADING, _LENGTH_GRADING = 0.45, 0.4  #: lines closer together at the waterline, sections at the ends


def side_grids(lines: Lines, side: list[Reach], n: int, m: int) -> list[Array]:
    """Return vertices (.., n + 1, 3) of each reach from the middle of the hull outward, from keel to waterline.

    A post ends the girth lines that do not meet the next reach; those that do carry on.
    """
    t, rows = _girth_lines(n), chine_rows(lines, n)
    bend, total = bend_length(lines), sum(r.length for r in side)
    grids: list[Array] = []
    inner_end: Array | None = None
    for k, reach in enumerate(side):
        last_one = k + 1 == len(side)
        low, high = (float(reach.ended[-1]), 1.0) if last_one else _shares(reach, side[k + 1], bend)
        end, first, last = _through_corners(t, low, high)
        grid = _grid(reach, (t, end), rows, max(1, round(m * reach.length / total)), bend)
        if inner_end is not None:
            grid[0] = inner_end
        if last_one and grid[-1, :, 2].min() > 2e-3 * lines.main.curves[..., 1].min():
            grid[-1, :, 2] = 0.0  # leaves the water over its whole breadth
        grids.append(grid)
        inner_end = grid[-1, first : last + 1]
        t, rows = (end[first : last + 1] - end[first]) / (end[last] - end[first]), {}
    return grids


def _grid(reach: Reach, t: tuple[Array, Array], rows: dict[int, int], m: int, bend: float) -> Array:
    """Return vertices (m + 1, n + 1, 3); t: shares of the girth of its lines at the inner and outer end."""
    x_end, z_end = _line_ends(reach, t[1])
    v = graded(np.linspace(0.0, 1.0, m + 1), _LENGTH_GRADING)[:, None]
    v = np.interp(v, reach.path, (reach.x - reach.x[0]) / (reach.x[-1] - reach.x[0]))
    x = reach.x[0] + v * (x_end - reach.x[0])
    out = np.sign(reach.x[-1] - reach.x[0])
    rise = np.interp(out * x, out * reach.x, reach.rise)
    share = t[0] + np.minimum(2.0 * v, 1.0) * (t[1] - t[0])
    knots = np.r_[0.0, t[0][list(rows.values())], 1.0], list(rows)
    curves = reach.surface.sections(x.ravel())
    yz = [_point(c, r, s, knots, bend) for c, r, s in zip(curves, rise.ravel(), share.ravel(), strict=True)]
    grid = np.dstack([x, np.reshape(yz, (*x.shape, 2))])
    on_profile = np.isfinite(z_end)
    grid[-1, on_profile, 1], grid[-1, on_profile, 2] = 0.0, z_end[on_profile]
    return grid


def _girth_lines(n: int) -> Array:
    return graded(np.linspace(0.0, 1.0, n + 1), _GIRTH_GRADING)


def _shares(reach: Reach, behind: Reach, bend: float) -> tuple[float, float]:
    """Return the shares of the girth, at the end of a reach, between which the next one starts."""
    part, solid = wet(reach.surface.sections(reach.x[-1:])[0]), wet(behind.surface.sections(behind.x[:1])[0])
    if part is None or solid is None:
        return 0.0, 1.0
    w = weight(with_rise(part, float(reach.rise[-1])), bend)
    low, high = (float(w[1 + np.argmin(np.hypot(*(part - q).T))] / w[-1]) for q in (solid[0], solid[-1]))
    return low, high


def _through_corners(t: Array, low: float, high: float) -> tuple[Array, int, int]:
    """Return shares of girth lines stretched so that two of them meet the given shares, and which ones."""
    i, j, n = 0, len(t) - 1, len(t) - 1
    if 0.0 < low < 1.0 - 1e-4:
        i = min(max(int(np.argmin(np.abs(t - low))), 1), n - 1)
    if high < 1.0 - 1e-4:
        j = max(min(int(np.argmin(np.abs(t - high))), n - 1), i + 1)
    knots = sorted({(0.0, 0.0), (float(t[i]), low if i else 0.0), (float(t[j]), high if j < n else 1.0), (1.0, 1.0)})
    return np.interp(t, *np.transpose(knots)), i, j


def _line_ends(reach: Reach, t: Array) -> tuple[Array, Array]:
    """Return x (n + 1,) where each girth line ends, and z for those that end on the profile (nan: on the last section)."""
    x, z = np.full(len(t), reach.x[-1]), np.full(len(t), np.nan)
    for j in np.flatnonzero(t < reach.ended[-1] + 1e-12) if reach.ended[-1] > 0.0 else ():
        k = min(int(np.searchsorted(reach.ended, t[j], side="right")) - 1, len(reach.x) - 2)
        step = reach.ended[k + 1] - reach.ended[k]
        f = (t[j] - reach.ended[k]) / step if step > 0.0 else 1.0
        x[j] = reach.x[k] + f * (reach.x[k + 1] - reach.x[k])
        z[j] = reach.keel[k] + f * (reach.keel[k + 1] - reach.keel[k])
    return x, z


def chine_rows(lines: Lines, n: int) -> dict[int, int]:
    """Return the grid row that follows each chine (index on the curves: row), the row nearest to it in the middle section."""
    t, curve = _girth_lines(n), lines.main.sections([lines.middle])[0]
    part = wet(curve)
    if part is None:
        return {}
    w = weight(part, bend_length(lines))
    below = [c for c in lines.main.chines if c < len(part) - 1]
    rows = {c: int(np.clip(np.argmin(np.abs(t - w[c] / w[-1])), i + 1, n - len(below) + i)) for i, c in enumerate(below)}
    return rows if len(set(rows.values())) == len(rows) else {}


def _point(curve: Array, rise: float, share: float, knots: tuple[Array, list[int]], bend: float) -> Array:
    """Return half-breadth and height at a share of the wet girth, the profile that has risen so far included."""
    part = wet(curve)
    if part is None:
        return np.zeros(2)
    part = with_rise(part, rise)
    w = weight(part, bend)
    at = np.array([w[min(c + 1, len(w) - 1)] for c in knots[1]]) / w[-1]
    at = np.clip(at, 0.15 * knots[0][1:-1], 1.0 - 0.15 * (1.0 - knots[0][1:-1]))  # no slivers where a chine leaves the water
    length = max(w[-1] * np.interp(share, knots[0], np.r_[0.0, at, 1.0]), w[1])  # on the solid section
    return np.array([np.interp(length, w, part[:, k]) for k in (0, 1)])
