"""From a case to hull, body and coefficients."""

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.app.case import Case
from ogilvie.app.crosschecks import default_range
from ogilvie.body import RigidBody
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.units import deg, knot

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.mesh.hydrostatics import Hydrostatics
    from ogilvie.mesh.panels import PanelMesh

Array = NDArray[np.float64]
_LITTLE = 0.75  # of the highest default frequency: panels that resolve less deserve a warning


def make_hull(case: Case) -> "PanelMesh | None":
    """Return the wetted hull of a case, or None where it has coefficients only."""
    if case.hull is None:
        return None
    if case.hull.file is None:
        return _shape(case, above_water=False)
    from ogilvie.mesh.inspect import require_usable

    mesh = _floating(case).immersed()
    try:
        require_usable(mesh, purpose="hull.file")
    except InputError as error:
        if case.hull.heal or ".flipped()" not in str(error):
            raise
        raise InputError(str(error).replace("Use .flipped().", "Give hull.heal = true, which turns them.")) from None
    return mesh


def make_whole_hull(case: Case) -> "PanelMesh":
    """Return the hull of a case up to its deck, for restoring at large heel."""
    if case.hull is not None and case.hull.file is None:
        return _shape(case, above_water=True)
    mesh = _floating(case)
    if mesh.bounds[1, 2] <= mesh.tolerance:
        raise InputError(
            f'restoring.kind: "{case.restoring and case.restoring.kind}": a hull up to its deck expected, hull.file ends '
            f"{mesh.bounds[1, 2]:.3g} m above the water. Give a mesh with the sides above the water, or a file of levers."
        )
    return mesh


def _floating(case: Case) -> "PanelMesh":
    """The mesh of the file at its draught, with what is above the water."""
    from ogilvie.mesh.files import load_mesh

    h: Any = case.hull
    offset = None if h.offset is None else (*h.offset, 0.0)
    mesh = load_mesh(case.path(h.file), unit=h.unit, symmetry=h.symmetry, offset=offset)
    if h.heal:
        from ogilvie.mesh.inspect import heal

        mesh, found = heal(mesh)
        for what, count in found.repairs:
            warnings.warn(f"hull.heal: {what}: {count}", OgilvieWarning)
    if h.draught is None:
        return mesh
    mesh.immersed(h.draught)  # refuses a draught that the mesh cannot have
    return mesh.translated((0.0, 0.0, -h.draught - mesh.bounds[0, 2]))


def _shape(case: Case, *, above_water: bool) -> "PanelMesh":
    from ogilvie.mesh import shapes

    h: Any = case.hull  # which keys are there was checked with the case
    makers: dict[str, Any] = {
        "s175": lambda: shapes.s175(panels=h.panels, above_water=above_water),
        "box": lambda: shapes.box(h.length, h.beam, h.draught, panels=h.panels),
        "hemisphere": lambda: shapes.hemisphere(h.radius, panels=h.panels),
        "cylinder": lambda: shapes.cylinder(h.radius, h.draught, panels=h.panels),
        "wigley": lambda: shapes.wigley(h.length, h.beam, h.draught, kind=h.variant, panels=h.panels),
        "particulars": lambda: _from_particulars(h, above_water),
    }
    return makers[str(h.shape)]().named(case.vessel.name)


def _from_particulars(h: Any, above_water: bool) -> "PanelMesh":
    from ogilvie.mesh import shapes

    names = ("length", "beam", "draught", "cb", "cm", "cwp", "lcb", "depth", "panels")
    return shapes.from_particulars(**{key: getattr(h, key) for key in names}, above_water=above_water)


def make_body(case: Case, hull: "PanelMesh | None", hydro: "xr.Dataset | None" = None) -> RigidBody:
    """Return the body of a case; without a [body] section it is that of the coefficients' inertia matrix."""
    b = case.body
    if b is None:
        if hydro is None or "inertia_matrix" not in hydro:
            raise InputError(
                "body: expected, not found: the coefficients hold no inertia matrix. "
                "Give a [body] with mass, cog (or zg) and gyradii (or inertia)."
            )
        return body_from_matrix(hydro.inertia_matrix.values, name=case.vessel.name)
    mass = b.mass if b.mass is not None else case.water.rho * _need(hull).volume
    if b.cog is not None:
        cog = np.array(b.cog)
    else:
        zg = b.zg if b.zg is not None else float(_need(hull).vertices[:, 2].min()) + float(b.kg or 0.0)
        xb, yb = (0.0, 0.0) if hull is None else hull.center_of_buoyancy[:2]
        cog = np.array([xb, yb, zg])
    if b.gyradii is not None:
        return RigidBody.from_gyradii(mass, cog=cog, gyradii=b.gyradii, name=case.vessel.name)
    return RigidBody(mass, cog, np.array(b.inertia), case.vessel.name)


def _need(hull: "PanelMesh | None") -> "PanelMesh":
    if hull is None:
        raise InputError("body: a hull expected for what is not given (mass, keel), none found. Give mass and zg or cog.")
    return hull


def body_from_matrix(matrix: Any, *, name: str = "body") -> RigidBody:
    """Return the body whose inertia matrix about O is given, (6, 6).

    Examples
    --------
    >>> body = RigidBody(mass=2.0, cog=[1.0, 0.0, -0.5], inertia=np.diag([2.0, 3.0, 4.0]))
    >>> body_from_matrix(body.matrix).cog
    array([ 1. ,  0. , -0.5])
    """
    from ogilvie.frames import skew

    M = np.asarray(matrix, dtype=float)
    mass = float(M[0, 0])
    if M.shape != (6, 6) or not mass > 0.0:
        raise InputError(f"inertia matrix: (6, 6) with a positive mass expected, shape {M.shape} and mass {mass:g} found.")
    mS = M[3:, :3]
    cog = np.array([mS[2, 1], mS[0, 2], mS[1, 0]]) / mass
    inertia = M[3:, 3:] - mass * skew(cog).T @ skew(cog)
    return RigidBody(mass, cog, 0.5 * (inertia + inertia.T), name)


def frequencies(case: Case, hull: "PanelMesh") -> Array:
    """Return the frequencies that the solver is asked for, rad/s, ascending."""
    c = case.coefficients
    if c.omega is not None:
        return np.sort(np.array(c.omega))
    if c.periods is not None:
        return np.sort(2 * np.pi / np.array(c.periods))
    low, high = (c.omega_min, c.omega_max) if c.omega_min is not None else _usual(hull, case.water.g)
    return np.linspace(float(low), float(high), c.omega_count)  # type: ignore[arg-type]


def _usual(hull: "PanelMesh", g: float) -> tuple[float, float]:
    """The default range, up to what the panels resolve where that is a little less."""
    from ogilvie.hydro.bem_case import resolved_wavenumber

    low, high = default_range(hull.beam, g)
    resolved = float(np.sqrt(g * resolved_wavenumber(hull))) * (1 - 1e-9)
    return low, min(high, resolved) if _LITTLE * high < resolved else high


def directions(case: Case, hull: "PanelMesh | None" = None) -> Array:
    """Return the wave directions relative to the bow that the solver is asked for, rad, ascending.

    By default those that the vessel meets: that of the sea, or every 15 deg around it where it is spread or the vessel turns;
    of a hull with a centre plane those of one side.
    """
    if case.coefficients.directions_deg is not None:
        given = np.array(case.coefficients.directions_deg)
    else:
        main = case.sea.direction_deg - case.vessel.heading_deg
        around = case.sea.spreading is not None or case.large
        if around and hull is not None and "xz" in hull.planes:
            given = np.arange(0.0, 181.0, 15.0)
        else:
            given = main + np.arange(-180.0, 180.0, 15.0) if around else np.array([main])
    folded = (given + 180.0) % 360.0 - 180.0
    folded[np.isclose(folded, -180.0)] = 180.0
    return np.unique(folded.round(9)) * deg


def make_hydro(case: Case, hull: "PanelMesh | None", body: RigidBody | None, *, progress: bool | None = None) -> "xr.Dataset":
    """Return the coefficients of a case: read, or solved (or taken from the cache)."""
    c, water = case.coefficients, case.water
    if c.file is not None:
        from ogilvie.hydro.files import read_hydro

        return fitted_to_speed(case, _with_statics(read_hydro(case.path(c.file), ulen=c.scale), hull, body), hull)
    asked: Any = {
        "omega": frequencies(case, _need(hull)),
        "wave_direction": directions(case, hull),
        "rho": water.rho,
        "g": water.g,
        "progress": progress,
    }
    if c.solver == "time-domain":
        from ogilvie.bem.hybrid_hydro import hybrid_hydro

        return hybrid_hydro(_need(hull), body, **asked)
    from ogilvie.hydro.capytaine import solve_bem

    return solve_bem(
        _need(hull),
        body,
        water_depth=water.depth,
        speed=case.speed if c.forward_speed == "panels" else 0.0,
        irregular_frequencies="remove" if c.irregular_frequencies else "keep",
        cache=c.cache,
        **asked,
    )


def fitted_to_speed(case: Case, hydro: "xr.Dataset", hull: "PanelMesh | None") -> "xr.Dataset":
    """Return given coefficients as they serve the vessel's speed: at it, or at zero speed with wave forces in two parts.

    Raises
    ------
    InputError
        Coefficients for another speed.
    """
    own, at = float(hydro.attrs.get("speed", 0.0)), case.speed
    if own != 0.0 and abs(own - at) > 1e-3 * max(own, at):
        raise InputError(
            f"coefficients: those of zero speed or of the vessel's {at / knot:.4g} knots expected, {own / knot:.4g} knots "
            f"({own:.4g} m/s) found. Change vessel.speed_knots, or give others."
        )
    parts = "Froude_Krylov_force" in hydro or "diffraction_force" in hydro
    if at == 0.0 or own != 0.0 or parts or hull is None or "excitation_force" not in hydro:
        return hydro
    from ogilvie.hydro.at_speed import at_speed

    return at_speed(hydro, at, hull=hull)


def _with_statics(hydro: "xr.Dataset", hull: "PanelMesh | None", body: RigidBody | None) -> "xr.Dataset":
    """Add the stiffness of the hull where the file has none."""
    if "hydrostatic_stiffness" in hydro or hull is None or body is None:
        return hydro
    from ogilvie.mesh.hydrostatics import hydrostatics

    C = hydrostatics(hull, body=body, rho=hydro.attrs["rho"], g=hydro.attrs["g"]).stiffness
    return hydro.assign(hydrostatic_stiffness=(("influenced_dof", "radiating_dof"), C))


def statics(case: Case, hull: "PanelMesh | None", body: RigidBody) -> "Hydrostatics | None":
    """Return the hydrostatics of the hull with its body."""
    if hull is None:
        return None
    from ogilvie.mesh.hydrostatics import hydrostatics

    return hydrostatics(hull, body=body, rho=case.water.rho, g=case.water.g)
