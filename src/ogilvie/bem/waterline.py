"""The waterline of a curved hull: sides of its panels at z = 0, in order round the hull."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.curves import backwards, sides
from ogilvie.errors import InputError
from ogilvie.mesh.chebyshev import interpolation

Array = NDArray[np.float64]

_SHARP = np.deg2rad(150.0)  #: angle of the fluid between centreline and waterline from which on an end is sharp
_FAN = 2  #: columns that spread from a sharp end
_SEVERAL = "Hulls that cross the water in several places, or have a moonpool, are not supported."


@dataclass(frozen=True, eq=False)
class Waterline:
    """Pieces of a waterline, anticlockwise seen from above.

    Parameters
    ----------
    pieces : (n, q, 3) array
        m; each ends where the next one starts, the first on the x axis (or anywhere, if the line is closed).
    heights : (n + 1,) array
        Height of the hull's panels below each end of a piece, m.
    closed : bool
        The last piece ends where the first one starts.
    fans : pair of int
        How many pieces at the start and at the end have no length: columns of the free surface spread there from one point.
    """

    pieces: Array
    heights: Array
    closed: bool
    fans: tuple[int, int] = (0, 0)

    @property
    def corners(self) -> Array:
        """Ends (n + 1, 2) of the pieces, x and y, m."""
        return np.vstack([self.pieces[:, 0, :2], self.pieces[-1:, -1, :2]])


def waterline(hull: Array, *, planes: tuple[str, ...], near: float) -> Waterline:
    """Return the waterline of a hull's curved panels.

    Parameters
    ----------
    hull : (n, q, q, 3) array
        m.
    planes : tuple of {"xz", "yz"}
        Planes of symmetry; only the part y >= 0 (and x >= 0) is stored.
    near : float
        Lengths taken as zero, m.

    Raises
    ------
    InputError
        No waterline, several ones, one with gaps.
    """
    owner, side = np.nonzero(_at_water(hull, near))
    if len(owner) == 0:
        raise InputError("waterline: a hull with panels up to z = 0 expected, none found. Clip it there: mesh.immersed().")
    pieces, heights = sides(hull)[owner, side], _heights(hull)[owner, side]
    order, closed = _chain(pieces, planes, near)
    if closed and planes:
        raise InputError(f"waterline: one line round the hull expected, found one apart from the plane of symmetry. {_SEVERAL}")
    pieces, heights = pieces[order], heights[order]
    turn = pieces[:, :, 0], pieces[:, :, 1]
    if float(_swept(*turn)) < 0.0:
        pieces, heights = backwards(pieces), heights[::-1]
    if not closed and len(planes) == 2 and not (abs(pieces[0, 0, 1]) <= 10.0 * near and abs(pieces[-1, -1, 0]) <= 10.0 * near):
        raise InputError(f"waterline: one line round the hull expected, several found that do not cross x = 0. {_SEVERAL}")
    at_ends = [heights[-1] if closed else heights[0], *(0.5 * (heights[1:] + heights[:-1])), heights[-1]]
    return Waterline(pieces, np.array(at_ends), closed)


def fanned(line: Waterline) -> Waterline:
    """Return the waterline with two pieces without length at each sharp end.

    At such an end - a bow whose waterline makes less than 30 deg with the centreline - a single column would have an angle
    near 180 deg; two more that start there leave no angle above 90 deg or so.
    """
    sharp = tuple(angle > 0.0 and not line.closed for angle in tip_angles(line))
    first, last = (_FAN * s for s in sharp)
    start, end = (np.broadcast_to(p, line.pieces.shape[1:])[None] for p in (line.pieces[0, 0], line.pieces[-1, -1]))
    pieces = np.concatenate([np.repeat(start, first, axis=0), line.pieces, np.repeat(end, last, axis=0)])
    heights = np.r_[np.repeat(line.heights[:1], first), line.heights, np.repeat(line.heights[-1:], last)]
    return replace(line, pieces=pieces, heights=heights, fans=(first, last))


def tip_angles(line: Waterline) -> tuple[float, float]:
    """Return the angles of the fluid between centreline and waterline at both ends, rad; 0 where they are not sharp."""
    out = []
    for end in (0, 1):
        p = line.pieces[line.fans[0] if end == 0 else -1 - line.fans[1], :, :2]
        at = interpolation(p.shape[0], [-1.0, -0.98] if end == 0 else [1.0, 0.98]) @ p
        ahead, d = at[0] / max(float(np.linalg.norm(at[0])), 1e-300), at[1] - at[0]
        angle = float(np.arctan2(abs(ahead[0] * d[1] - ahead[1] * d[0]), ahead @ d))
        out.append(angle if angle > _SHARP else 0.0)
    return out[0], out[1]


def _at_water(hull: Array, near: float) -> NDArray[np.bool_]:
    """Return which sides (n, 4) lie in z = 0 and have a length."""
    s = sides(hull)
    return np.asarray((np.abs(s[..., 2]).max(axis=2) <= near) & (np.linalg.norm(s[:, :, -1] - s[:, :, 0], axis=-1) > near))


def _heights(hull: Array) -> Array:
    """Return the mean length (n, 4) of the two sides of a panel that meet each of its sides."""
    length = np.linalg.norm(np.diff(sides(hull), axis=2), axis=-1).sum(axis=2)
    across, along = length[:, 2:].mean(axis=1), length[:, :2].mean(axis=1)
    return np.stack([across, across, along, along], axis=1)


def _chain(pieces: Array, planes: tuple[str, ...], near: float) -> tuple[list[int], bool]:
    """Return the order of the pieces, turned round in place where needed, and whether they form a closed line."""
    first, last = pieces[:, 0].copy(), pieces[:, -1].copy()
    ends = np.stack([first, last], axis=1)
    same = np.linalg.norm(ends[:, :, None, None] - ends[None, None], axis=-1) <= 10.0 * near  # (n, 2, n, 2)
    n = len(pieces)
    same[np.arange(n), :, np.arange(n), :] = False
    degree = same.sum(axis=(2, 3))
    if degree.max() > 1:
        raise InputError("waterline: one line round the hull expected, found lines that branch or panels that lie in z = 0.")
    free = [(i, e) for i in range(n) for e in (0, 1) if degree[i, e] == 0]
    axes = [1 if p == "xz" else 0 for p in planes]
    for i, e in free:
        if not any(abs(ends[i, e, a]) <= 10.0 * near for a in axes):
            raise InputError(
                f"waterline: a line without gaps expected, one found at x, y = {ends[i, e, :2].round(6).tolist()} m. "
                "Close the holes of the hull."
            )
    i, e = free[0] if free else (0, 0)
    order: list[int] = []
    while i not in order:
        order.append(i)
        if e == 1:
            pieces[i] = pieces[i, ::-1].copy()
        following = np.argwhere(same[i, 1 - e])
        if len(following) == 0:
            break
        i, e = int(following[0, 0]), int(following[0, 1])
    if len(order) < n:
        raise InputError(
            f"waterline: one line round the hull expected, several found ({n - len(order)} of {n} pieces are apart). "
            + _SEVERAL
        )
    return order, not free


def _swept(x: Array, y: Array) -> float:
    """Return twice the area swept round O by pieces (n, q), positive for anticlockwise ones."""
    return float((x[:, :-1] * y[:, 1:] - x[:, 1:] * y[:, :-1]).sum())
