"""The closed boundary of the inner domain: a hull, the free surface round it, the control hemisphere outside."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.control_mesh import control_panels, first_row, rows_below
from ogilvie.bem.curved import BODY, CONTROL, FREE, CurvedMesh, Symmetry
from ogilvie.bem.curves import places
from ogilvie.bem.free_surface_mesh import column_azimuths, free_surface_panels
from ogilvie.bem.hull_patches import hull_panels
from ogilvie.bem.inner_checks import corner_angles, positions_and_normals
from ogilvie.bem.waterline import Waterline, waterline
from ogilvie.errors import InputError
from ogilvie.mesh.panels import PanelMesh

Array = NDArray[np.float64]

_Q = 6  #: points per side of a panel: a fifth of a quarter circle is round to 1e-8
_SIZE = 0.2  #: of the length times (beam / length)^0.4, default length of a panel
_ROWS, _DEPTH = 0.6, 0.5  #: panels from waterline to circle, and down from it, for each panel round a quarter of the circle
_ROOM = 1.05  #: least control radius over the distance of the hull's farthest point
_LEAST_ROWS = 5  #: of panels on the control surface, so that three nodes in each make more than 12


def inner_mesh(
    hull: PanelMesh,
    *,
    control_radius: float | None = None,
    size: float | None = None,
    rows: int | None = None,
    depth: int | None = None,
) -> CurvedMesh:
    """Return the boundary of the fluid between a hull and a hemisphere round it as curved panels.

    Parameters
    ----------
    hull : PanelMesh
        What is below z = 0 counts.
    control_radius : float, optional
        Of the hemisphere, m. By default the distance of the hull's farthest point from its centre plus the half beam, or
        plus a fifth of that distance if this is more: twice the radius of a sphere, 0.6 times the length of a ship.
    size : float, optional
        Length of a panel on hull and waterline, m; smaller ones are used towards waterline and sharp edges. By default 0.2
        times length^0.6 beam^0.4.
    rows : int, optional
        Panels from the waterline to the circle.
    depth : int, optional
        Panels from the circle down to where the patches of the hemisphere meet; some more are below.

    Returns
    -------
    CurvedMesh
        About `centre`, half-way between the ends of the waterline; `notes` tell how the hull was represented.

    Raises
    ------
    InputError
        The hull reaches beyond the hemisphere (the message gives a radius that works), has holes, no waterline or several,
        or a waterline that does not run once round its middle; free-surface panels would be folded.

    Examples
    --------
    >>> from ogilvie.mesh.shapes import hemisphere
    >>> mesh = inner_mesh(hemisphere(5.0))
    >>> mesh.radius, mesh.symmetry, len(mesh.part)
    (10.0, 'xz+yz', 48)
    """
    if hull.bounds[1, 2] < -hull.tolerance:
        raise InputError(
            f"waterline: a hull up to z = 0 expected, {hull.name!r} ends at z = {hull.bounds[1, 2]:.6g} m. A submerged body is "
            "not supported."
        )
    wet = with_found_symmetry(hull.immersed())
    if wet.surface is None:
        raise InputError("inner_mesh: a hull with a smooth surface expected.")
    size = _positive("size", size, default_size(wet))
    panels = hull_panels(wet.surface, planes=wet.planes, size=size, q=_Q)
    return enclosed(panels, wet, control_radius=control_radius, rows=rows, depth=depth, notes=("smooth surface of the hull",))


def with_found_symmetry(hull: PanelMesh) -> PanelMesh:
    """Return the hull stored with all planes of symmetry that it has."""
    wish: tuple[Symmetry, ...] = ("xz+yz", "xz")
    for symmetry in wish:
        try:
            found = hull.with_symmetry(symmetry)
        except InputError:
            continue
        if hull.surface is None or found.surface is not None:
            return found
    return hull


def default_size(hull: PanelMesh) -> float:
    """Return the length of panels, m: 4 of them round a quarter of a sphere, 14 along a ship of seven beams."""
    short, long = sorted((hull.beam, hull.length))
    return float(_SIZE * long * (short / long) ** 0.4)


def enclosed(
    panels: Array,
    hull: PanelMesh,
    *,
    control_radius: float | None,
    rows: int | None,
    depth: int | None,
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
    azimuth = column_azimuths(line, radius)
    own = azimuth if not line.closed else np.linspace(0.0, 2.0 * np.pi, 4 * max(2, round(len(azimuth) / 4)) + 1)
    quarter = (len(own) - 1) * 0.5 * np.pi / (own[-1] - own[0])
    depth = _count("depth", depth, max(3, _LEAST_ROWS - rows_below(own), round(_DEPTH * quarter)))
    rows = _count("rows", rows, max(4, round(_ROWS * quarter)))
    circle = radius * _on_circle(azimuth, q)
    water = free_surface_panels(line, circle, rows=rows, last=radius * first_row(depth))
    _require_unfolded(water)
    control = radius * control_panels(own, depth=depth, q=q)
    part = np.repeat([BODY, FREE, CONTROL], [len(panels), len(water), len(control)])
    points = _snapped(np.concatenate([panels, water, control]), hull.planes, 1e-9 * radius)
    return CurvedMesh(points, part, radius, hull.symmetry, centre=(float(centre[0]), float(centre[1]), 0.0), notes=tuple(notes))


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
    radius = _positive("control_radius", wanted, farthest + max(half_beam, 0.2 * farthest))
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


def _positive(key: str, value: float | None, default: float) -> float:
    if value is None:
        return default
    if not (np.isfinite(value) and value > 0.0):
        raise InputError(f"{key}: a positive length in m expected, {value!r} found.")
    return float(value)


def _count(key: str, value: int | None, default: int) -> int:
    if value is None:
        return default
    if not (isinstance(value, int | np.integer) and value >= 1):
        raise InputError(f"{key}: a number of panels >= 1 expected, {value!r} found.")
    return int(value)
