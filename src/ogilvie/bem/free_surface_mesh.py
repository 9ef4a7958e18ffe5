"""Curved panels of the free surface between a waterline and the circle of the control hemisphere."""

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.curves import divisions, places
from ogilvie.bem.waterline import Waterline, tip_angles
from ogilvie.mesh.chebyshev import interpolation

Array = NDArray[np.float64]

_EVEN = 0.25  #: weight of even steps round the circle against columns that meet it, and the hull, at right angles
_LEAST_END = 1.0  #: slope of the steps at the circle


def column_azimuths(line: Waterline, radius: float) -> Array:
    """Return the azimuths (n + 1,) at which columns from the ends of the pieces of a waterline reach the circle, rad.

    Notes
    -----
    They make the least sum of squares of: the sine of the angle between column and the waterline's normal (at a corner:
    their mean; in a fan: equal angles), the sine of the angle between column and radius, and the logarithm of the ratio of
    neighbouring steps round the circle, times 1/4. The steps are the exponentials of the unknowns, so that columns never
    cross.
    """
    from scipy.optimize import least_squares

    corners, n = line.corners, len(line.pieces)
    normal = _normals(line)
    polar = np.unwrap(np.arctan2(corners[:, 1], corners[:, 0]))
    start = 0.0 if not line.closed else float(polar[0])
    total = 2.0 * np.pi if line.closed else float(0.5 * np.pi * round((polar[-1] - polar[0]) / (0.5 * np.pi)))

    def azimuths(x: Array) -> Array:
        steps = np.exp(x - x.max())
        return start + total * np.r_[0.0, np.cumsum(steps) / steps.sum()]

    def misfit(x: Array) -> Array:
        a = azimuths(x)
        out = np.stack([np.cos(a), np.sin(a)], axis=-1)
        column = radius * out - corners
        column /= np.linalg.norm(column, axis=1, keepdims=True)
        skew = [column[:, 0] * d[:, 1] - column[:, 1] * d[:, 0] for d in (normal, out)]
        return np.concatenate([skew[0][1:-1], skew[1][1:-1], _EVEN * np.diff(x), 1e-6 * x])

    if n == 1:
        return np.array([start, start + total])
    found = least_squares(misfit, np.log(np.maximum(np.diff(polar), 0.02)), max_nfev=200)
    azimuth = azimuths(found.x)
    azimuth[-1] = start + total
    return azimuth


def _normals(line: Waterline) -> Array:
    """Return unit normals (n + 1, 2) of the waterline, away from the hull, at the ends of its pieces; means at corners."""
    first, last = line.fans
    p = line.pieces[first : len(line.pieces) - last, :, :2]
    q = p.shape[1]
    ends = interpolation(q, [-1.0, -0.98, 0.98, 1.0])
    at = np.einsum("kq,nqi->nki", ends, p)
    tangent = np.stack([at[:, 1] - at[:, 0], at[:, 3] - at[:, 2]], axis=1)
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    before, after = (tangent[-1, 1], tangent[0, 0]) if line.closed else (tangent[0, 0], tangent[-1, 1])
    mean = np.vstack([before + tangent[0, 0], tangent[:-1, 1] + tangent[1:, 0], tangent[-1, 1] + after])
    mean /= np.maximum(np.linalg.norm(mean, axis=1, keepdims=True), 1e-300)
    normal = np.stack([mean[:, 1], -mean[:, 0]], axis=-1)
    angles = tip_angles(line)
    ahead = np.arctan2(*line.corners[[0, -1], ::-1].T)
    if first:
        normal = np.vstack([_spread(ahead[0], 0.5 * angles[0], first), normal[1:]])
    if last:
        normal = np.vstack([normal[:-1], _spread(ahead[1], -0.5 * angles[1], last)[::-1]])
    return normal


def _spread(axis: float, angle: float, n: int) -> Array:
    """Return n + 1 unit vectors from the direction `axis` to one turned by `angle`, rad."""
    a = axis + angle * np.linspace(0.0, 1.0, n + 1)
    return np.stack([np.cos(a), np.sin(a)], axis=-1)


def free_surface_panels(line: Waterline, circle: Array, *, rows: int, last: float) -> Array:
    """Return the panels between waterline and circle.

    Parameters
    ----------
    line : Waterline
    circle : (n, q, 3) array
        Piece of the circle that each piece of the waterline is joined to, m.
    rows : int
        Panels from waterline to circle.
    last : float
        Length wanted of the panels next to the circle, m.

    Returns
    -------
    (n rows, q, q, 3) array
        m, z = 0; x_u x x_v points up.

    Notes
    -----
    Columns are straight. Steps along them follow a cubic whose end slopes are chosen so that panels next to the waterline are
    as long as the hull's panels there are high, and those next to the circle `last`, as far as slopes between 0 (power-2
    grading) and 2 at the waterline and between 1 and 2 at the circle go.
    """
    q = line.pieces.shape[1]
    ends = np.vstack([circle[:, 0], circle[-1:, -1]])[:, :2]
    length = np.linalg.norm(ends - line.corners, axis=1)
    steps = np.stack([_steps(rows, h / l, last / l) for h, l in zip(line.heights, length, strict=True)])  # (n + 1, rows + 1)
    if line.closed:
        steps[-1] = steps[0]
    half = places(np.array([0.0, 1.0]), q)[0]
    out = []
    for j in range(len(line.pieces)):
        t = np.stack([places(steps[j], q), places(steps[j + 1], q)])  # (2, rows, q)
        T = t[0][..., None] * (1.0 - half) + t[1][..., None] * half  # (rows, q, q): outward, along
        out.append((1.0 - T)[..., None] * line.pieces[j] + T[..., None] * circle[j])
    return np.concatenate(out)


def _steps(rows: int, first: float, last: float) -> Array:
    """Return divisions of [0, 1] whose first and last steps come near to the given ones."""
    s = 1.0 / rows
    base, rise, fall = s * s * (3.0 - 2.0 * s), s * (1.0 - s) ** 2, s * s * (1.0 - s)
    # first = base + a rise - b fall; last = base - a fall + b rise
    M = np.array([[rise, -fall], [-fall, rise]])
    a, b = np.linalg.solve(M, [first - base, last - base]) if rows > 2 else (0.0, 2.0)
    a = float(np.clip(a, 0.0, 2.0))
    b = float(np.clip((last - base + a * fall) / rise, _LEAST_END, 2.0)) if rows > 2 else 2.0
    return divisions(rows, start=a, end=b)
