"""The closed boundary of the inner domain: a hull, the free surface round it, the control hemisphere outside."""

from ogilvie.bem.curved import CurvedMesh, Symmetry
from ogilvie.bem.enclosure import enclosed, positive
from ogilvie.bem.hull_surface import Representation, represented
from ogilvie.errors import InputError
from ogilvie.mesh.panels import PanelMesh

_Q = 6  #: points per side of a panel: a fifth of a quarter circle is round to 1e-8
_SIZE = 0.2  #: of the length times (beam / length)^0.4, default length of a panel


def inner_mesh(
    hull: PanelMesh,
    *,
    control_radius: float | None = None,
    size: float | None = None,
    rows: int | None = None,
    depth: int | None = None,
    surface: Representation = "auto",
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
    surface : {"auto", "smooth", "panels"}
        "smooth": the smooth surface that came with the hull (`PanelMesh.surface`), else one fitted to its panels. "panels":
        each flat panel as it is; the free surface has a column at each of its sides on the waterline. "auto": smooth where
        the corners of the panels are within 0.4 % of the beam of it (rms) and the volume within 1 %, else panels.

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
    size = positive("size", size, default_size(wet))
    panels, wet, note = represented(wet, surface, size=size, q=_Q)
    return enclosed(panels, wet, control_radius=control_radius, size=size, rows=rows, depth=depth, notes=(note,))


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
