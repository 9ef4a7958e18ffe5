"""Curved panels of a ship given by flat ones: a smooth sheet through their corners, divided."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.curves import divisions, places, turned
from ogilvie.bem.inner_checks import jacobians, positions_and_normals
from ogilvie.mesh.fitting import Sheet, fitted
from ogilvie.mesh.flattening import flattened
from ogilvie.mesh.panels import PanelMesh

Array = NDArray[np.float64]

_ENDS = 0.3  #: slope of the division along the ship at its ends: panels there are about a third of the mean
_MORE = 1.1  #: times as many panels as equal ones of the given size
_MORE_GRADED = 1.25  #: the same on either side of a chine
_TURN = 0.15  #: of the panels, as many as go to a turn by 180 deg
_STEEP = 1.5  #: slope of the edge of a flat end up to which panels stand upright in it
_LEAST = (8, 4)  #: panels along and across: with three across, the damping of a tanker in roll is 6 % off


@dataclass(frozen=True, eq=False)
class FittedHull:
    """Curved panels of a ship, and how far they are from the flat ones.

    Parameters
    ----------
    panels : (n, q, q, 3) array
        m; x_u x x_v points into the hull.
    rms, most : float
        Distance of the corners of the flat panels from the curved ones, m.
    jacobian : float
        Least relative size of x_u x x_v inside a panel; negative where it is folded.
    volume : float
        Displacement of both halves, m3.
    chine : bool
        Whether one was kept sharp.
    """

    panels: Array
    rms: float
    most: float
    jacobian: float
    volume: float
    chine: bool


def fitted_panels(hull: PanelMesh, *, size: float, q: int, chine: bool = True) -> FittedHull:
    """Return a smooth hull through the corners of a panelled one.

    Parameters
    ----------
    hull : PanelMesh
        Symmetry "xz", below z = 0.
    size : float
        Length of a panel, m.
    q : int
        Points per side of a panel.
    chine : bool
        Keep a chine from end to end sharp.

    Raises
    ------
    InputError
        The half hull is not one sheet bordered by waterline and centreline.

    Notes
    -----
    Panels get smaller towards waterline (as 1/n^2), stem and stern. A shallow transom is filled with upright panels, another
    flat end with panels of three sides, from its edge to where centreline and waterline meet. Towards a chine that runs from
    end to end panels get smaller too. Other knuckles are rounded off within a span of the splines.

    Examples
    --------
    >>> from ogilvie.mesh.s175 import s175
    >>> fit = fitted_panels(s175(panels=1000), size=16.0, q=6)
    >>> fit.rms < 0.002 * 25.4, len(fit.panels)
    (True, 52)
    """
    flat = flattened(hull, chine=chine)
    return divided(fitted(flat), flat.vertices, size=size, q=q)


def divided(sheet: Sheet, vertices: Array, *, size: float, q: int) -> FittedHull:
    """Return the panels of a sheet, and how far vertices (n, 3) are from them; see :func:`fitted_panels`."""
    u, v = (places(t, q) for t in _divisions(sheet, size))
    grid = sheet.at(u.ravel(), v.ravel()).reshape(len(u), q, len(v), q, 3)
    panels = grid.transpose(0, 2, 1, 3, 4).reshape(-1, q, q, 3)
    if sheet.flat_ends[0]:
        panels = np.concatenate([panels, turned(_fan(panels[: len(v), 0], size))])
    if sheet.flat_ends[1]:
        panels = np.concatenate([panels, _fan(panels[(len(u) - 1) * len(v) : len(u) * len(v), -1], size)])
    off = distances(vertices, panels)
    g, w = np.polynomial.legendre.leggauss(q + 2)
    x, normal = positions_and_normals(panels, g, g)
    volume = -2.0 * float(np.einsum("a,b,nab,nab->", w, w, x[..., 2], normal[..., 2]))
    return FittedHull(
        panels, float(np.sqrt(np.mean(off**2))), float(off.max()), float(jacobians(normal).min()), volume, sheet.chine > 0.0
    )


def _fan(edge: Array, size: float) -> Array:
    """Return panels that fill a flat end from its edge (n, q, 3), keel to waterline.

    They run up to the waterline where the edge is nowhere steep, else to the place where waterline and centreline meet.
    """
    q, top, keel = edge.shape[1], edge[-1, -1], edge[0, 0]
    step = np.diff(edge, axis=1)
    shallow = bool(np.all(step[..., 1] > 0.0) and np.all(np.abs(step[..., 2]) < _STEEP * step[..., 1]))
    middle = np.stack([np.full(edge.shape[:2], top[0]), edge[..., 1] * shallow, np.zeros(edge.shape[:2])], axis=-1)
    middle = middle[None, :, None]
    w = places(
        divisions(max(1, round(float(-keel[2] if shallow else max(top[1], -keel[2])) / size)), start=1.0, end=1.0), q
    )  # (m, q)
    fan = (1.0 - w)[:, None, :, None, None] * edge[None, :, None] + w[:, None, :, None, None] * middle  # (m, n, q, q, 3)
    return np.asarray(fan.reshape(-1, q, q, 3))


def _divisions(sheet: Sheet, size: float) -> tuple[Array, Array]:
    """Return the divisions of u and v: even in length plus turn of the lines, finer at waterline, stern and bow."""
    t, across = np.linspace(0.0, 1.0, 401), np.linspace(0.0, 1.0, 9)
    along, girth = sheet.at(t, across), sheet.at(across[2:-2], t).swapaxes(0, 1)
    out = []
    for lines, least, slopes in zip((along, girth), _LEAST, ((_ENDS, _ENDS), (1.0, 0.0)), strict=True):
        if lines is girth and sheet.chine > 0.0:
            out.append(_beside_chine(girth, t, sheet.chine, size))
            continue
        step = np.linalg.norm(np.diff(lines, axis=0), axis=-1)  # (400, lines)
        tangent = np.diff(lines, axis=0) / np.maximum(step, 1e-300)[..., None]
        turn = np.zeros(len(t))
        turn[1:-1] = np.arccos(np.clip((tangent[1:] * tangent[:-1]).sum(axis=-1), -1.0, 1.0)).max(axis=1)
        n = max(least, int(np.ceil(_MORE * step.sum(axis=0).max() / size - 0.3)))
        travel = np.r_[0.0, np.cumsum(step.mean(axis=1))]
        weight = travel / travel[-1] + _TURN * np.cumsum(turn) / np.pi + 1e-9 * t
        out.append(np.interp(divisions(n, start=slopes[0], end=slopes[1]), weight / weight[-1], t))
    return _through(out[0], sheet.kinks), out[1]


def _beside_chine(girth: Array, t: Array, chine: float, size: float) -> Array:
    """Return the divisions of v with panels that get smaller towards the chine, from both sides, and to the waterline."""
    step = np.linalg.norm(np.diff(girth, axis=0), axis=-1)  # (400, lines)
    travel = np.r_[0.0, np.cumsum(step.mean(axis=1))]
    longest = np.vstack([np.zeros(step.shape[1]), np.cumsum(step, axis=0)])
    parts = []
    for low, high, start in ((0.0, chine, 2.0), (chine, 1.0, 0.0)):
        a, b = (np.interp(x, t, travel) for x in (low, high))
        length = max(float(np.interp(high, t, one) - np.interp(low, t, one)) for one in longest.T)
        n = max(2 + (start == 0.0), int(np.ceil(_MORE_GRADED * length / size - 0.3)))
        parts.append(np.interp(a + (b - a) * divisions(n, start=start, end=0.0), travel, t))
        parts[-1][[0, -1]] = low, high
    return np.concatenate([parts[0], parts[1][1:]])


def _through(breaks: Array, kinks: tuple[float, ...]) -> Array:
    """Return a division with the break nearest to each kink put on it, those between spread anew."""
    where = {0: 0.0, len(breaks) - 1: 1.0}
    for k in sorted(kinks):
        before = max(i for i, t in where.items() if t < k)
        where[int(np.clip(np.argmin(np.abs(breaks - k)), before + 1, len(breaks) - 2))] = k
    at = np.array(sorted(where))
    return np.interp(breaks, breaks[at], [where[i] for i in at])


def distances(points: Array, panels: Array) -> Array:
    """Return the distances (n,) of points (n, 3) from panels (m, q, q, 3): from the tangent plane at the nearest sample, m."""
    from scipy.spatial import cKDTree

    fine = np.sin(0.5 * np.pi * np.linspace(-1.0, 1.0, 25))
    x, normal = (a.reshape(-1, 3) for a in positions_and_normals(panels, fine, fine))
    normal = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    away, near = cKDTree(x).query(points)
    gap = points - x[near]
    height = (gap * normal[near]).sum(axis=1)
    spacing = float(np.sqrt(np.median(np.linalg.norm(panels[:, -1, -1] - panels[:, 0, 0], axis=1)))) ** 2 / 12.0
    beyond = np.maximum(np.sqrt(np.maximum(away**2 - height**2, 0.0)) - spacing, 0.0)  # off the end of the nearest panel
    return np.asarray(np.hypot(height, beyond))
