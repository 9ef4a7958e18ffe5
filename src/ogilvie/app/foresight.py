"""What the long work would come to grief on, or would do without a word though nobody can mean it: told before it begins."""

import warnings
from collections.abc import Iterator
from math import ceil, hypot, inf, radians, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from ogilvie.app import build, build_run
from ogilvie.app.angles import in_radians
from ogilvie.app.build_control import try_parts
from ogilvie.app.build_drift import refuse_without_drift
from ogilvie.app.case import Case
from ogilvie.errors import InputError, OgilvieWarning

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.body import RigidBody
    from ogilvie.mesh.hydrostatics import Hydrostatics
    from ogilvie.mesh.panels import PanelMesh

#: Length of a hull, m, beyond which it is doubted, and beyond which its unit is taken for another.
_LONG, _TOO_LONG = 600.0, 1e4
#: Radii of gyration as parts of the space diagonal of the wetted hull.
_LEAST_GYRATION, _LARGEST_GYRATION = 0.02, 2.0
#: Weight and buoyancy may differ by this part without a word, and by this factor at all.
_WEIGHT, _WEIGHT_AT_MOST = 0.02, 2.0
_FROUDE = 0.5
_STIFFNESS = 0.05


def foresee(case: Case, hull: "PanelMesh | None") -> None:
    """Try what needs no coefficients: parts of the vessel, its weight and stability, the sea, the directions it comes from.

    Raises
    ------
    InputError
        What cannot be: a table, a mass in tonnes, a hull in millimetres, a negative GM, a sea from where there are no data.

    Warns
    -----
    OgilvieWarning
        What can be but is hardly meant.
    """
    if hull is not None:
        _size(case, hull)
    try_parts(case, hull)
    if hull is not None and case.body is not None:
        body = build.make_body(case, hull)
        statics = build.statics(case, hull, body)
        _weight(body.mass, case.water.rho * hull.volume, "displaced by the hull")
        _gyration(body, hull)
        if statics is not None:
            _stability(case, statics)
    _result(case)
    for sentence in (*in_radians(case), *_doubts(case, hull)):
        warnings.warn(sentence, OgilvieWarning)
    if hull is not None and case.coefficients.file is None:
        foresee_sea(case, build.frequencies(case, hull), _headings(case, hull))


def foresee_data(case: Case, hydro: "xr.Dataset") -> None:
    """Try what needs the coefficients: the mass against theirs, the sea and the directions that it comes from."""
    from ogilvie.loads.speed_table import HeadingTable

    if case.body is not None and case.hull is None and case.body.mass is not None and "inertia_matrix" in hydro:
        M = hydro.inertia_matrix.values
        _weight(case.body.mass, float(M[0, 0]), "of the coefficients")
        mine = build.make_body(case, None).matrix
        _inertia(mine, M)
        _height(mine, M, hydro)
    refuse_without_drift(case, hydro)
    if "excitation_force" in hydro:
        foresee_sea(case, hydro.omega.values, HeadingTable.of(hydro).headings)


def foresee_sea(case: Case, omega: Any, headings: Any) -> None:
    """Make the sea, and look whether the coefficients hold the directions that it comes from.

    Parameters
    ----------
    omega : (n,) array
        Frequencies of the coefficients, rad/s.
    headings : Headings
        Their wave directions relative to the bow.
    """
    import xarray as xr

    from ogilvie.loads.interpolation import heading_weights

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)  # it is told when the sea is made for good
        sea = build_run.make_sea(case, build_run.make_spectrum(case), xr.Dataset(coords={"omega": omega}))
    if sea is None:
        return
    try:
        heading_weights(headings, np.unique(sea.direction) - radians(case.vessel.heading_deg))
    except InputError:
        met = 180 - (180 + case.vessel.heading_deg - case.sea.direction_deg) % 360
        spread = ", spread," if case.sea.spreading is not None else ""
        key = "directions_deg" if case.coefficients.file is None else "file"
        raise InputError(
            f"sea.direction_deg: {case.sea.direction_deg:g}: waves{spread} that meet the vessel at {met:g} "
            f"deg from its bow: among or between the directions of the coefficients, {headings.text}, no two of them more than "
            f"60 deg apart, expected. Change the direction, or add to coefficients.{key}."
            + "".join(f"\n{sentence}" for sentence in in_radians(case))
        ) from None


def _headings(case: Case, hull: "PanelMesh") -> Any:
    """The directions that will be solved, on both sides of a hull that is its own mirror image."""
    from ogilvie.loads.interpolation import unwrapped

    b = build.directions(case, hull)
    if "xz" in hull.planes:
        b = np.unique(np.concatenate([b, -b[np.abs(b) < np.pi - 1e-9]]).round(9))
    return unwrapped(b, np.zeros((1, len(b), 1), dtype=complex))[0]


def _result(case: Case) -> None:
    """Refuse a result that does not fit in the machine's memory: pose, velocity, acceleration and three loads at least."""
    from ogilvie.sim.run import check_memory

    s = case.simulation
    check_memory(ceil(s.duration / (s.output_step or s.dt)) * s.realisations, 36)


def _size(case: Case, hull: "PanelMesh") -> None:
    extent = float(np.ptp(hull.full().vertices, axis=0).max())
    if extent > _TOO_LONG:
        file = case.hull is not None and case.hull.file is not None
        hint = "A mesh in millimetres? Give hull.unit = 0.001." if file else "Lengths are in m."
        raise InputError(f"hull: at most {_TOO_LONG:g} m expected, {extent:.4g} m found. {hint}")
    draught = -float(hull.vertices[:, 2].min())
    if case.water.depth <= draught:
        raise InputError(f"water.depth: {case.water.depth:g}: more than the draught of the hull, {draught:.4g} m, expected.")


def _weight(mass: float, other: float, what: str) -> None:
    """Compare the mass with what the water carries, kg."""
    ratio = mass / other
    if not 1 / _WEIGHT_AT_MOST < ratio < _WEIGHT_AT_MOST:
        hint = " Tonnes? Multiply by 1000." if 0.7e-3 < ratio < 1.4e-3 else " Look at mass (kg), draught and unit of the hull."
        raise InputError(f"body.mass: {mass:g}: about {other:.5g} kg, the mass {what}, expected.{hint}")
    if abs(ratio - 1) > _WEIGHT:
        warnings.warn(
            f"body.mass: {mass:.6g} kg, {abs(ratio - 1):.1%} {'less' if ratio < 1 else 'more'} than the {other:.6g} kg "
            f"{what}: they should be equal, unless lines carry the rest. Look at mass and draught.",
            OgilvieWarning,
        )


def _gyration(body: "RigidBody", hull: "PanelMesh") -> None:
    diagonal = float(np.linalg.norm(np.ptp(hull.full().vertices, axis=0)))
    largest = float(max(body.gyradii))
    if not _LEAST_GYRATION * diagonal < largest < _LARGEST_GYRATION * diagonal:
        hint = "Parts of beam and length? Multiply by them." if largest < 1 else "Metres are expected."
        found = ", ".join(f"{k:.4g}" for k in body.gyradii)
        raise InputError(
            f"body.gyradii (or inertia): {found} m: no vessel of this hull ({diagonal:.4g} m across) has them. {hint}"
        )


def _inertia(mine: Any, other: Any) -> None:
    """Compare the moments of inertia about O with those of the coefficients, kg m2."""
    for i, name in enumerate(("roll", "pitch", "yaw"), start=3):
        if other[i, i] > 0 and not 0.1 < mine[i, i] / other[i, i] < 10:
            raise InputError(
                f"body.gyradii (or inertia): about {other[i, i]:.3g} kg m2 in {name} about O, as the coefficients have it, "
                f"expected, {mine[i, i]:.3g} found. Radii in m about the centre of gravity are expected, no parts of length."
            )


def _height(mine: Any, other: Any, hydro: "xr.Dataset") -> None:
    """Warn where the stiffness of the coefficients is that of another height of the centre of gravity."""
    if "hydrostatic_stiffness" not in hydro or not {"roll"} <= {str(d) for d in hydro.influenced_dof.values}:
        return
    C44 = float(hydro.hydrostatic_stiffness.sel(influenced_dof="roll", radiating_dof="roll"))
    change = -float(hydro.attrs["g"]) * (mine[4, 0] - other[4, 0])  # m z_G stands at (pitch, surge)
    if abs(change) > _STIFFNESS * abs(C44):
        here, there = (M[4, 0] / M[0, 0] for M in (mine, other))
        warnings.warn(
            f"body.zg (or cog): z = {here:.4g} m, where the coefficients have {there:.4g} m: the stiffness of roll would "
            f"change by {change / C44:.0%}, but that of the coefficients is kept. Take theirs, or coefficients for yours.",
            OgilvieWarning,
        )


def _stability(case: Case, statics: "Hydrostatics") -> None:
    """Refuse a vessel that linear restoring lets capsize."""
    linear = case.restoring is None or case.restoring.kind == "linear"
    for name, dof, GM in (("transverse", "roll", statics.GM_T), ("longitudinal", "pitch", statics.GM_L)):
        if GM is None or GM > 0 or not linear or dof in case.loads.mooring_stiffness.given:
            continue
        key = next((k for k in ("kg", "zg") if case.body is not None and getattr(case.body, k) is not None), "cog")
        counted = "" if key == "kg" else " (z counts from the still water, kg from the keel)"
        raise InputError(
            f"body.{key}: a centre of gravity below the {name} metacentre expected, {statics.KG:.4g} m above the keel found, "
            f"GM {GM:.3g} m: the vessel capsizes. Lower it{counted}."
        )


def _doubts(case: Case, hull: "PanelMesh | None") -> Iterator[str]:
    """What can be, but is hardly meant."""
    start = case.simulation.initial
    if start is not None and not case.large:
        for key in ("roll_deg", "pitch_deg"):
            if abs(getattr(start, key)) > 30:
                yield (
                    f"simulation.initial.{key}: {getattr(start, key):g}: small motions are linear up to any angle, ships are "
                    'not. Take less, or simulation.motions = "large" with [restoring].'
                )
    if hull is None:
        return
    points = hull.full().vertices
    low, high = points.min(axis=0), points.max(axis=0)
    length = float(max(high[0] - low[0], high[1] - low[1]))
    if length > _LONG:
        yield f"hull: {length:.4g} m long. In feet or millimetres? Give hull.unit, the length of the file's unit in m."
    along, across, deep = high[0] - low[0], high[1] - low[1], high[2] - low[2]
    if across > 1.001 * along:
        yield f"hull: {across:.4g} m across and {along:.4g} m along: x forward, y to port expected."
    if case.hull is not None and case.hull.shape == "particulars" and deep > across:
        yield f"hull.draught: {deep:.4g}: a ship with less draught than its beam of {across:.4g} m expected."
    middle = hypot(*(0.5 * (low + high))[:2])
    if middle > 0.25 * length:
        yield (
            f"hull: its middle lies {middle:.4g} m from the origin O. Motions, springs and damping are those of O: surge, sway "
            "and heave at the end of a ship hold its pitch and yaw. Move the mesh so that O is amidships."
        )
    if start is not None and abs(start.heave) > -low[2]:
        yield f"simulation.initial.heave: {start.heave:g}: less than the draught, {-low[2]:.4g} m, expected."
    froude = case.speed / sqrt(case.water.g * length) if length > 0 else inf
    if froude > _FROUDE:
        yield (
            f"vessel.speed_knots: {case.vessel.speed_knots:g}: Froude number {froude:.2g}; forces at speed hold up to about "
            "0.4. Knots?"
        )
