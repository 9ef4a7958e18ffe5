"""From a case to hull, body, coefficients and fluid memory."""

import contextlib
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.app.case import Case
from ogilvie.app.crosschecks import default_range
from ogilvie.app.files import read_memory, write_memory
from ogilvie.app.sections import Memory
from ogilvie.body import RigidBody
from ogilvie.errors import FormatError, InputError, OgilvieWarning
from ogilvie.hydro.schema import DOFS
from ogilvie.units import deg, knot

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.memory.retardation import Retardation
    from ogilvie.memory.statespace import StateSpace
    from ogilvie.mesh.hydrostatics import Hydrostatics
    from ogilvie.mesh.panels import PanelMesh

Array = NDArray[np.float64]


def make_hull(case: Case) -> "PanelMesh | None":
    """Return the wetted hull of a case, or None where it has coefficients only."""
    if case.hull is None:
        return None
    h: Any = case.hull  # which keys are there was checked with the case
    if h.file is not None:
        from ogilvie.mesh.files import load_mesh
        from ogilvie.mesh.inspect import require_usable

        mesh = load_mesh(case.path(h.file)).immersed(h.draught)
        require_usable(mesh, purpose="hull.file")
        return mesh
    from ogilvie.mesh import shapes

    makers: dict[str, Any] = {
        "s175": lambda: shapes.s175(panels=h.panels),
        "box": lambda: shapes.box(h.length, h.beam, h.draught, panels=h.panels),
        "hemisphere": lambda: shapes.hemisphere(h.radius, panels=h.panels),
        "cylinder": lambda: shapes.cylinder(h.radius, h.draught, panels=h.panels),
        "wigley": lambda: shapes.wigley(h.length, h.beam, h.draught, kind=h.variant, panels=h.panels),
        "particulars": lambda: _from_particulars(h),
    }
    return makers[str(h.shape)]().named(case.vessel.name)


def _from_particulars(h: Any) -> "PanelMesh":
    from ogilvie.mesh import shapes

    return shapes.from_particulars(
        length=h.length, beam=h.beam, draught=h.draught, cb=h.cb, cm=h.cm, cwp=h.cwp, lcb=h.lcb, panels=h.panels
    )


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
    low, high = (c.omega_min, c.omega_max) if c.omega_min is not None else default_range(hull.beam, case.water.g)
    return np.linspace(float(low), float(high), c.omega_count)  # type: ignore[arg-type]


def directions(case: Case) -> Array:
    """Return the wave directions relative to the bow that the solver is asked for, rad, ascending.

    By default those that the sea needs: its own, or every 15 deg around it where it is spread.
    """
    if case.coefficients.directions_deg is not None:
        given = np.array(case.coefficients.directions_deg)
    else:
        main = case.sea.direction_deg - case.vessel.heading_deg
        given = main + np.arange(-180.0, 180.0, 15.0) if case.sea.spreading is not None else np.array([main])
    folded = (given + 180.0) % 360.0 - 180.0
    folded[np.isclose(folded, -180.0)] = 180.0
    return np.unique(folded.round(9)) * deg


def make_hydro(case: Case, hull: "PanelMesh | None", body: RigidBody | None, *, progress: bool | None = None) -> "xr.Dataset":
    """Return the coefficients of a case: read, or solved (or taken from the cache)."""
    c, water = case.coefficients, case.water
    if c.file is not None:
        from ogilvie.hydro.files import read_hydro

        hydro = read_hydro(case.path(c.file), ulen=c.scale)
        return _with_statics(hydro, hull, body)
    from ogilvie.hydro.capytaine import solve_bem

    return solve_bem(
        _need(hull),
        body,
        omega=frequencies(case, _need(hull)),
        wave_direction=directions(case),
        rho=water.rho,
        g=water.g,
        water_depth=water.depth,
        speed=case.vessel.speed_knots * knot,
        irregular_frequencies="remove" if c.irregular_frequencies else "keep",
        progress=progress,
        cache=c.cache,
    )


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


def make_memory(case: Case, hydro: "xr.Dataset", body: RigidBody) -> "tuple[Retardation, StateSpace | None]":
    """Return retardation functions and, unless the case asks for the convolution, the identified model.

    The fit knows body and restoring, so that it serves the motions. Results are kept on disk by the content of the problem.
    """
    m = case.memory
    stiffness = mooring_stiffness(case, body, hydro)
    if "hydrostatic_stiffness" in hydro:
        stiffness = stiffness + hydro.hydrostatic_stiffness.values
    if not m.cache:
        return _identified(m, hydro, body, stiffness)
    kept = _memory_file(m, hydro, body, stiffness)
    if kept.exists():
        try:
            K, ssm = read_memory(kept)
        except FormatError:
            kept.unlink(missing_ok=True)
        else:
            for note in ssm.notes if ssm is not None else ():
                warnings.warn(f"identify: {note}", OgilvieWarning)
            return K, ssm
    K, ssm = _identified(m, hydro, body, stiffness)
    with contextlib.suppress(OSError):  # a cache that cannot be written costs time, no more
        kept.parent.mkdir(parents=True, exist_ok=True)
        write_memory(kept, K, ssm)
    return K, ssm


def _identified(m: Memory, hydro: "xr.Dataset", body: RigidBody, stiffness: Array) -> "tuple[Retardation, StateSpace | None]":
    from ogilvie.memory.identify import identify
    from ogilvie.memory.retardation import retardation

    K = retardation(hydro, duration=m.duration, dt=m.dt, tail=m.tail, frequencies=m.frequencies)
    if m.model == "convolution":
        return K, None
    return K, identify(K, method=m.method, r2=m.r2, max_order=m.max_order, mass=body.matrix, stiffness=stiffness)


def _memory_file(m: Memory, hydro: "xr.Dataset", body: RigidBody, stiffness: Array) -> Path:
    """Where the fluid memory of this problem is kept; another version of the code is another problem."""
    import ogilvie.memory
    from ogilvie.hydro.cache import cache_folder, content_key

    names = ("omega", "added_mass", "radiation_damping", "added_mass_inf")
    arrays = [hydro[name].values for name in names if name in hydro]
    code = [file.read_text(encoding="utf-8") for file in sorted(Path(ogilvie.memory.__path__[0]).glob("*.py"))]
    key = content_key(*arrays, body.matrix, stiffness, m.model_dump_json(), str(hydro.attrs.get("name")), *code)
    return cache_folder() / "memory" / f"{key}.npz"


def mooring_stiffness(case: Case, body: RigidBody, hydro: "xr.Dataset") -> Array:
    """Return the (6, 6) stiffness of the springs: as given, or such that a degree of freedom has the natural period given."""
    k = np.zeros(6)
    for dof, value in case.loads.mooring_stiffness.given.items():
        k[DOFS.index(dof)] = value
    for dof, period in case.loads.mooring_period.given.items():
        i, w = DOFS.index(dof), 2 * np.pi / period
        A = hydro.added_mass.sel(influenced_dof=dof, radiating_dof=dof)
        inertia = body.matrix[i, i] + float(np.interp(w, A.omega.values, A.values))
        own = float(hydro.hydrostatic_stiffness.values[i, i]) if "hydrostatic_stiffness" in hydro else 0.0
        k[i] = w**2 * inertia - own
        if k[i] <= 0.0:
            raise InputError(
                f"loads.mooring_period.{dof}: {period:g}: a period shorter than the unmoored one, "
                f"{2 * np.pi * np.sqrt(inertia / own):.4g} s, expected. Springs can only shorten it."
            )
    return np.diag(k)
