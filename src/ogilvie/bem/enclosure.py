"""Free surface and control hemisphere put round a hull's curved panels."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.control_mesh import control_panels, first_row, rows_below
from ogilvie.bem.curved import BODY, CONTROL, FREE, CurvedMesh
from ogilvie.bem.curves import places
from ogilvie.bem.free_surface_mesh import column_azimuths, free_surface_panels
from ogilvie.bem.inner_checks import corner_angles, positions_and_normals
from ogilvie.bem.waterline import Waterline, fanned, waterline
from ogilvie.errors import InputError
from ogilvie.mesh.panels import PanelMesh

Array = NDArray[np.float64]

_ROOM = 1.05  #: least control radius over the distance of the hull's farthest point
_LEAST_ROWS = 5  #: of panels on the control surface, so that three nodes in each make more than 12
_ROWS, _DEPTH = 0.6, 0.45  #: panels from waterline to circle, and down from it, for each panel round a quarter of the circle
_MANY = 1.5  #: times as many columns as panels of the given size make: the control surface gets its own division


def enclosed(
    panels: Array,
    hull: PanelMesh,
    *,
    control_radius: float | None,
    rows: int | None,
    depth: int | None,
    size: float,
    notes: Sequence[str],
) -> CurvedMesh:
    """Return a hull's curved panels (n, q, q, 3), normals into the hull, closed by free surface and hemisphere.

    Other arguments as in :func:`inner_mesh`; `hull` gives planes of symmetry and extent.
    """
    q, near = panels.shape[1], 1e-7 * float(np.ptp(hull.bounds, axis=0).max())
    panels = _snapped(panels, hull.planes, near)
    line = waterline(panels, planes=hull.planes, near=near)
    centre = np.zeros(3)
    if "yz" not in hull.planes:
        centre[0] = 0.5 * (line.corners[:, 0].min() + line.corners[:, 0].max())
    if line.closed:
        centre[1] = 0.5 * (line.corners[:, 1].min() + line.corners[:, 1].max())
    panels, line = panels - centre, Waterline(line.pieces - centre, line.heights, line.closed)
    radius = _radius(control_radius, panels)
    _require_one_turn(line)
    line = fanned(line)
    azimuth = column_azimuths(line, radius)
    own = _division(azimuth, line, size)
    quarter = (len(own) - 1) * 0.5 * np.pi / (own[-1] - own[0])
    depth = count("depth", depth, max(3, _LEAST_ROWS - rows_below(own), round(_DEPTH * quarter)))
    columns = quarter * (1.0 - sum(line.fans) / (len(line.pieces)))
    rows = count("rows", rows, max(4, round(_ROWS * columns)))
    circle = radius * _on_circle(azimuth, q)
    water = free_surface_panels(line, circle, rows=rows, last=radius * first_row(depth))
    _require_unfolded(water)
    control = radius * control_panels(own, depth=depth, q=q)
    part = np.repeat([BODY, FREE, CONTROL], [len(panels), len(water), len(control)])
    points = _snapped(np.concatenate([panels, water, control]), hull.planes, 1e-9 * radius)
    return CurvedMesh(points, part, radius, hull.symmetry, centre=(float(centre[0]), float(centre[1]), 0.0), notes=tuple(notes))


def _division(azimuth: Array, line: Waterline, size: float) -> Array:
    """Return azimuths (n + 1,) that divide the control surface: the columns', or equal ones where columns are many or odd."""
    length = float(np.linalg.norm(np.diff(line.corners, axis=0), axis=1).sum())
    quarters = round((azimuth[-1] - azimuth[0]) / (0.5 * np.pi))
    wanted = max(4, round(1.25 * length / size / quarters))
    if not line.closed and len(azimuth) - 1 <= _MANY * wanted * quarters:
        return azimuth
    return np.linspace(0.0, 0.5 * np.pi * quarters, quarters * wanted + 1) + azimuth[0]


def _on_circle(azimuth: Array, q: int) -> Array:
    a = places(azimuth, q)
    return np.stack([np.cos(a), np.sin(a), np.zeros(a.shape)], axis=-1)


def _snapped(points: Array, planes: tuple[str, ...], near: float) -> Array:
    """Return points with coordinates near to z = 0 and planes of symmetry put on them."""
    points = points.copy()
    for axis in (2, *(1 if p == "xz" else 0 for p in planes)):
        values = points[..., axis]
        values[np.abs(values) <= near] = 0.0
    return points


def _radius(wanted: float | None, panels: Array) -> float:
    """Return the radius of the hemisphere, checked against the hull's farthest point."""
    half_beam = float(min(np.abs(panels[..., 0]).max(), np.abs(panels[..., 1]).max()))
    farthest = float(np.linalg.norm(panels, axis=-1).max())
    radius = positive("control_radius", wanted, farthest + max(half_beam, 0.2 * farthest))
    if radius < _ROOM * farthest:
        raise InputError(
            f"control_radius: at least {_ROOM * farthest:.6g} m expected (1.05 times the distance of the hull's farthest point "
            f"from its centre), {radius:.6g} m found."
        )
    return radius


def _require_one_turn(line: Waterline) -> None:
    x, y = line.pieces[..., 0], line.pieces[..., 1]
    if np.any(x[:, :-1] * y[:, 1:] - x[:, 1:] * y[:, :-1] <= 0.0):
        raise InputError(
            "waterline: one that is seen from its middle in every direction exactly once expected (star-shaped), found one "
            "that turns back. Such a hull cannot be enclosed by columns from waterline to circle."
        )


def _require_unfolded(water: Array) -> None:
    g = np.polynomial.legendre.leggauss(6)[0]
    normal = positions_and_normals(water, g, g)[1][..., 2]
    if normal.min() <= 0.0 or corner_angles(water).min() < np.deg2rad(2.0):
        x, y = water[np.argmin(normal.min(axis=(1, 2)))].mean(axis=(0, 1))[:2]
        raise InputError(
            f"free surface: panels without folds expected, one found near x = {x:.6g}, y = {y:.6g} m from the centre. Try a "
            "greater control_radius or another size."
        )


def positive(key: str, value: float | None, default: float) -> float:
    """Return a length in m that was given, or the default; :class:`InputError` names the `key` of one that is not positive."""
    if value is None:
        return default
    if not (np.isfinite(value) and value > 0.0):
        raise InputError(f"{key}: a positive length in m expected, {value!r} found.")
    return float(value)


def count(key: str, value: int | None, default: int) -> int:
    """Return a number of panels that was given, or the default; :class:`InputError` names the `key` of one below 1."""
    if value is None:
        return default
    if not (isinstance(value, int | np.integer) and value >= 1):
        raise InputError(f"{key}: a number of panels >= 1 expected, {value!r} found.")
    return int(value)
