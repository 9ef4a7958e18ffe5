"""Numbers of a case that no vessel has: mass, centre of gravity, radii of gyration, stability, size, speed, starting pose."""

import warnings
from collections.abc import Iterator
from math import hypot, inf, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

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
_OFF_BALANCE = 0.01  # of the length or beam


def refuse_size(case: Case, hull: "PanelMesh") -> None:
    """Refuse a hull in another unit, and water that it does not float in."""
    extent = float(np.ptp(hull.full().vertices, axis=0).max())
    if extent > _TOO_LONG:
        file = case.hull is not None and case.hull.file is not None
        hint = "A mesh in millimetres? Give hull.unit = 0.001." if file else "Lengths are in m."
        raise InputError(f"hull: at most {_TOO_LONG:g} m expected, {extent:.4g} m found. {hint}")
    draught = -float(hull.vertices[:, 2].min())
    if case.water.depth <= draught:
        raise InputError(f"water.depth: {case.water.depth:g}: more than the draught of the hull, {draught:.4g} m, expected.")


def compare_mass(mass: float, other: float, what: str) -> None:
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


def compare_centres(body: "RigidBody", hull: "PanelMesh") -> None:
    """Compare where the weight acts with where the buoyancy does, along and across."""
    points, B = hull.full().vertices, hull.center_of_buoyancy
    for i, axis in ((0, "x"), (1, "y")):
        low, high = float(points[:, i].min()), float(points[:, i].max())
        G = float(body.cog[i])
        if not low <= G <= high:
            raise InputError(
                f"body.cog: {axis} = {G:g}: within the hull, {low:.4g}..{high:.4g} m from its origin O, expected. "
                "Counted from another point than the hull is?"
            )
        if abs(G - B[i]) > _OFF_BALANCE * (high - low):
            warnings.warn(
                f"body.cog: {axis} = {G:g} m, {abs(G - B[i]):.3g} m from the centre of buoyancy at {B[i]:.4g} m: the vessel "
                "would not float as the hull lies. Leave cog out for one above the other (kg or zg), or trim the hull.",
                OgilvieWarning,
            )


def refuse_gyration(body: "RigidBody", hull: "PanelMesh") -> None:
    """Refuse radii of gyration that are in another unit than the hull."""
    diagonal = float(np.linalg.norm(np.ptp(hull.full().vertices, axis=0)))
    largest = float(max(body.gyradii))
    if not _LEAST_GYRATION * diagonal < largest < _LARGEST_GYRATION * diagonal:
        hint = "Parts of beam and length? Multiply by them." if largest < 1 else "Metres are expected."
        found = ", ".join(f"{k:.4g}" for k in body.gyradii)
        raise InputError(
            f"body.gyradii (or inertia): {found} m: no vessel of this hull ({diagonal:.4g} m across) has them. {hint}"
        )


def compare_inertia(mine: Any, other: Any) -> None:
    """Compare the moments of inertia about O with those of the coefficients, kg m2."""
    for i, name in enumerate(("roll", "pitch", "yaw"), start=3):
        if other[i, i] > 0 and not 0.1 < mine[i, i] / other[i, i] < 10:
            raise InputError(
                f"body.gyradii (or inertia): about {other[i, i]:.3g} kg m2 in {name} about O, as the coefficients have it, "
                f"expected, {mine[i, i]:.3g} found. Radii in m about the centre of gravity are expected, no parts of length."
            )


def compare_heights(mine: Any, other: Any, hydro: "xr.Dataset") -> None:
    """Warn where the stiffness of the coefficients is that of another height of the centre of gravity."""
    if "hydrostatic_stiffness" not in hydro:
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


def refuse_capsizing(case: Case, statics: "Hydrostatics") -> None:
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


def doubts(case: Case, hull: "PanelMesh | None") -> Iterator[str]:
    """Yield a sentence for what can be, but is hardly meant."""
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
            f"and heave at a ship's end hold pitch and yaw. Move it: hull.offset = [{-0.5 * (low[0] + high[0]):.4g}, 0, 0]."
        )
    if start is not None and abs(start.heave) > -low[2]:
        yield f"simulation.initial.heave: {start.heave:g}: less than the draught, {-low[2]:.4g} m, expected."
    froude = case.speed / sqrt(case.water.g * length) if length > 0 else inf
    if froude > _FROUDE:
        yield (
            f"vessel.speed_knots: {case.vessel.speed_knots:g}: Froude number {froude:.2g}; forces at speed hold up to about "
            "0.4. Knots?"
        )
