"""Draught, breadth and area of the sections of a panelled hull, from exact cuts of its panels."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.integrals import triangles
from ogilvie.mesh.panels import PanelMesh

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Stations:
    """Sections of a wetted hull at places x.

    Parameters
    ----------
    x : (n,) array
        From O, positive forward, m.
    draught, breadth : (n,) array
        Depth of the lowest point below z = 0 and extent in y, m.
    area : (n,) array
        m2.
    girth : (n,) array
        Length of the wet contour, m.
    """

    x: Array
    draught: Array
    breadth: Array
    area: Array
    girth: Array


def stations(hull: PanelMesh, x: ArrayLike | int = 41) -> Stations:
    """Return the sections of the part of a hull below z = 0.

    Parameters
    ----------
    hull : PanelMesh
        Normals into the fluid; what is above z = 0 is cut off.
    x : (n,) array or int
        Places, m, or their number: the middles of that many equal strips over the length of the wetted hull.

    Returns
    -------
    Stations
        Zero where the hull does not reach.

    Raises
    ------
    InputError
        NaN in x, nothing below the water.

    Notes
    -----
    A plane cuts a triangle along a straight piece of length s with the normal n turned into the plane; area = sum of
    y n_y s, by the divergence theorem (the waterplane and the plane of symmetry add nothing).

    Examples
    --------
    >>> from ogilvie.mesh.shapes import box
    >>> s = stations(box(10.0, 4.0, 1.5, panels=60), [-1.0, 2.0])
    >>> s.draught.tolist(), s.breadth.tolist(), s.area.tolist(), s.girth.tolist()
    ([1.5, 1.5], [4.0, 4.0], [6.0, 6.0], [7.0, 7.0])
    """
    wet = hull.immersed().full()
    low, high = wet.bounds[:, 0]
    if isinstance(x, int):
        if x < 1:
            raise InputError(f"stations: a number of strips >= 1 expected, {x} found.")
        x = low + (high - low) * (np.arange(x) + 0.5) / x
    places = np.array(x, dtype=float)
    if places.ndim != 1 or not np.all(np.isfinite(places)):
        raise InputError(f"stations: finite x (n,) in m expected, shape {places.shape} found (or NaN in it).")
    corners = wet.vertices[triangles(wet.faces)]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    rows = np.array([_section(corners, normal, float(p), wet.tolerance) for p in places]).reshape(-1, 4)
    return Stations(places, *rows.T)


def _section(p: Array, normal: Array, x: float, tolerance: float) -> tuple[float, float, float, float]:
    """Return draught, breadth, area and girth at x of triangles p (n, 3, 3) with any normals along `normal`."""
    d = p[:, :, 0] - x
    d = np.where(np.abs(d) < tolerance, tolerance, d)  # a corner in the plane counts as ahead of it
    cut = (d > 0.0).any(axis=1) & (d < 0.0).any(axis=1)
    if not cut.any():
        return 0.0, 0.0, 0.0, 0.0
    d, p, normal = d[cut], p[cut], normal[cut]
    alone = np.where((d > 0.0).sum(axis=1) == 1, np.argmax(d, axis=1), np.argmin(d, axis=1))  # on its side of the plane
    row, ends = np.arange(len(d)), []
    for step in (1, 2):
        other = (alone + step) % 3
        f = d[row, alone] / (d[row, alone] - d[row, other])
        ends.append(p[row, alone] + f[:, None] * (p[row, other] - p[row, alone]))
    a, b = ends[0][:, 1:], ends[1][:, 1:]
    s = np.hypot(*(b - a).T)
    n_y = normal[:, 1] / np.maximum(np.hypot(normal[:, 1], normal[:, 2]), 1e-300)
    points = np.concatenate([a, b])
    area = float((0.5 * (a[:, 0] + b[:, 0]) * n_y * s).sum())
    return float(-points[:, 1].min()), float(np.ptp(points[:, 0])), area, float(s.sum())
