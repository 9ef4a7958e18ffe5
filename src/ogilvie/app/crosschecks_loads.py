"""What the sections on forces and control must satisfy beyond single keys."""

from collections.abc import Iterator
from itertools import pairwise
from math import isfinite
from pathlib import Path
from typing import Any

from ogilvie.app.crosscheck_files import missing_file

#: Shapes whose hull above the water is known; others end there.
DECKED = ("s175", "particulars")


def load_checks(s: dict[str, Any], present: set[str], folder: Path) -> Iterator[str]:
    """Yield a sentence for every contradiction in the sections on forces."""
    s = {**s, "hullless": hullless(s, present)}
    for check in (_restoring, _damping, _resistance, _lift, _wind, _current, _slow_drift, _mooring):
        yield from check(s, folder)


def hullless(s: dict[str, Any], present: set[str]) -> bool:
    """Return whether a case has coefficients alone, so that what a hull would tell has to be given."""
    return "hull" not in present and s["coefficients"] is not None and s["coefficients"].file is not None


def _needs(s: dict[str, Any], section: str, keys: tuple[str, ...]) -> Iterator[str]:
    """What has to be given where there is no hull to take it from."""
    if s["hullless"]:
        for key in keys:
            if getattr(s[section], key) is None:
                yield f"{section}.{key}: expected where there is no hull, not found."


def _restoring(s: dict[str, Any], folder: Path) -> Iterator[str]:
    r, hull = s["restoring"], s["hull"]
    if r is None or r.kind == "linear":
        for key in () if r is None else sorted(r.model_fields_set - {"kind"}):
            yield f'restoring.{key}: not used by kind "linear". Remove it, or take kind "gz" or "hull".'
        return
    if r.file is not None:
        yield from missing_file("restoring.file", r.file, folder)
        if r.kind == "hull":
            yield 'restoring.file: a curve of righting levers; only with kind "gz".'
        return
    if s["hullless"]:
        yield f'restoring.kind: "{r.kind}": a [hull] up to its deck expected, none found.'
    elif hull is not None and hull.shape is not None and hull.shape not in DECKED:
        yield (
            f'restoring.kind: "{r.kind}": a hull up to its deck expected; shape "{hull.shape}" ends at the water. '
            "Give a file that goes on above it."
        )
    if r.kind == "gz" and "max_pitch_deg" in r.model_fields_set:
        yield 'restoring.max_pitch_deg: not used by kind "gz". Remove it.'


def _damping(s: dict[str, Any], folder: Path) -> Iterator[str]:
    d = s["damping"]
    if d is None:
        return
    ratios = s["loads"].damping_ratio.given if s["loads"] is not None else {}
    for dof in sorted(d.linear.given.keys() & ratios.keys()):
        yield f"damping.linear.{dof}: also in loads.damping_ratio; one of the two expected."
    if d.cross_flow is not None:
        if s["hullless"]:
            yield "damping.cross_flow: a [hull] for its sections expected, none found."
        dofs = {"sway", "yaw"} | ({"heave", "pitch"} if d.cross_flow.cd_vertical > 0 else set())
        for dof in sorted(dofs & d.quadratic.given.keys()):
            yield f"damping.quadratic.{dof}: cross_flow holds it already; one of the two expected."
    if d.ikeda is None:
        return
    if s["hullless"]:
        yield "damping.ikeda: a [hull] for its sections expected, none found."
    for name, given in (
        ("loads.damping_ratio.roll", "roll" in ratios),
        ("damping.linear.roll", "roll" in d.linear.given),
        ("damping.quadratic.roll", "roll" in d.quadratic.given),
        ("damping.cubic.roll", d.cubic is not None),
    ):
        if given:
            yield f"{name}: ikeda holds the damping of roll already; one of the two expected."
    keel = [k for k in ("keel_start", "keel_end", "keel_breadth") if getattr(d.ikeda, k) is not None]
    if len(keel) in (1, 2):
        yield f"damping.ikeda: keel_start, keel_end and keel_breadth expected together, {' and '.join(keel)} found."
    elif keel and d.ikeda.keel_start >= d.ikeda.keel_end:
        yield f"damping.ikeda.keel_end: {d.ikeda.keel_end:g}: more than keel_start {d.ikeda.keel_start:g} expected (x forward)."


def _resistance(s: dict[str, Any], folder: Path) -> Iterator[str]:
    r = s["resistance"]
    if r is None:
        return
    for key in ("file", "residuary"):
        if getattr(r, key) is not None:
            yield from missing_file(f"resistance.{key}", getattr(r, key), folder)
    if r.file is not None:
        for key in sorted(r.model_fields_set & {"residuary", "wetted_area", "length", "form_factor", "allowance"}):
            yield f"resistance.{key}: not used beside file, which is the whole resistance. Remove one of the two."
    else:
        yield from _needs(s, "resistance", ("wetted_area", "length"))
    if r.balanced and s["speed_keeping"] is not None:
        yield "resistance.balanced: a constant thrust and [speed_keeping] would both push; one of the two expected."


def _lift(s: dict[str, Any], folder: Path) -> Iterator[str]:
    if s["hull_lift"] is not None:
        yield from _needs(s, "hull_lift", ("draught", "x"))


def _one_speed(section: Any, name: str) -> Iterator[str]:
    given = [key for key in ("speed", "speed_knots") if getattr(section, key) is not None]
    if len(given) != 1:
        yield f"{name}: exactly one of speed (m/s) and speed_knots expected, {' and '.join(given) or 'none'} found."


def _wind(s: dict[str, Any], folder: Path) -> Iterator[str]:
    w = s["wind"]
    if w is None:
        return
    yield from _one_speed(w, "wind")
    if (w.direction_deg is None) == (w.from_deg is None):
        found = "none" if w.direction_deg is None else "both"
        yield f"wind: exactly one of direction_deg (to, anticlockwise from x) and from_deg (compass) expected, {found} found."
    kinds = [key for key in ("blendermann", "isherwood", "table") if getattr(w, key) is not None]
    if len(kinds) != 1:
        found = " and ".join(kinds) or "none"
        yield f"wind: exactly one of [wind.blendermann], [wind.isherwood] and [wind.table] expected, {found} found."
    if w.table is not None:
        yield from missing_file("wind.table.file", w.table.file, folder)
    for kind in kinds:
        yield from (f"wind.{kind}.{key}: expected where there is no hull, not found." for key in _unknown(s, getattr(w, kind)))
    speed = w.speed if w.speed is not None else w.speed_knots
    if w.gust != "none" and speed == 0:
        yield f'wind.gust: "{w.gust}": a wind speed > 0 expected, 0 found. Take gust "none".'
    if w.seed is not None and w.gust == "none":
        yield 'wind.seed: only with gusts; give gust = "npd" or "api", or remove it.'


def _unknown(s: dict[str, Any], coefficients: Any) -> list[str]:
    if not s["hullless"]:
        return []
    return [key for key in ("length", "beam") if key in type(coefficients).model_fields and getattr(coefficients, key) is None]


def _current(s: dict[str, Any], folder: Path) -> Iterator[str]:
    c = s["current"]
    if c is None:
        return
    if c.profile is None:
        yield from _one_speed(c, "current")
        if c.draught is not None:
            yield "current.draught: what a profile is averaged over; only with profile."
        return
    if c.speed is not None or c.speed_knots is not None:
        yield "current: speed or profile expected, both found."
    if s["hullless"] and c.draught is None:
        yield "current.draught: expected where there is no hull, not found."
    z, v = zip(*c.profile, strict=True)
    if max(z) > 0 or min(v) < 0:
        yield "current.profile: rows [z, speed] with z <= 0 (below the water) and speed >= 0 expected, others found."
    elif any(b >= a for a, b in pairwise(z)) and any(b <= a for a, b in pairwise(z)):
        yield "current.profile: z in falling (or rising) order expected, others found."


def _slow_drift(s: dict[str, Any], folder: Path) -> Iterator[str]:
    d, sea, vessel = s["slow_drift"], s["sea"], s["vessel"]
    if d is None:
        return
    if sea is not None and sea.spectrum == "calm":
        yield "slow_drift: a sea expected, calm water found. Remove it."
    full, at_speed = d.approximation == "full", vessel is not None and vessel.speed_knots > 0
    for key in sorted(d.model_fields_set & {"method", "second_order", "omega_count"}):
        if s["hullless"]:
            yield f"slow_drift.{key}: how the drift of a [hull] is computed; there is none. Remove it."
    if full and "method" in d.model_fields_set:
        yield 'slow_drift.method: how the mean drift is computed; not with approximation "full". Remove it.'
    if not full and "second_order" in d.model_fields_set:
        yield 'slow_drift.second_order: only with approximation "full". Remove it.'
    if not full and not at_speed and "omega_count" in d.model_fields_set:
        yield 'slow_drift.omega_count: only at speed or with approximation "full"; else [coefficients] has the frequencies.'
    if not at_speed and "short_waves" in d.model_fields_set:
        yield "slow_drift.short_waves: only at speed. Remove it."
    if at_speed:
        yield from _drift_at_speed(s, d)


def _drift_at_speed(s: dict[str, Any], d: Any) -> Iterator[str]:
    knots, water = s["vessel"].speed_knots, s["water"]
    if d.approximation == "full":
        yield f'slow_drift.approximation: "full" is for a vessel at rest; one of newman-... expected at {knots:g} knots.'
    if d.damping:
        yield f"slow_drift.damping: for a vessel at rest; at {knots:g} knots the drift holds the speed. Remove it."
    if water is not None and isfinite(water.depth) and d.method in ("far", "auto"):
        found = f"{d.method!r} found"
        yield f'slow_drift.method: "control_surface" or "near" expected at speed in water of {water.depth:g} m, {found}.'
    run = s["simulation"]
    if run is not None and run.motions != "large" and s["speed_keeping"] is None and s["resistance"] is None:
        yield (
            'slow_drift: added resistance slows a ship down: [speed_keeping], [resistance] or simulation.motions = "large" '
            "expected at speed, none found."
        )


def _mooring(s: dict[str, Any], folder: Path) -> Iterator[str]:
    m = s["mooring"]
    if m is None:
        return
    kinds = [key for key in ("lines", "table", "moordyn") if getattr(m, key) is not None]
    if len(kinds) != 1:
        found = " and ".join(kinds) or "none"
        yield f"mooring: exactly one of [[mooring.lines]], [mooring.table] and [mooring.moordyn] expected, {found} found."
    loads = s["loads"]
    if loads is not None and (loads.mooring_period.given or loads.mooring_stiffness.given):
        yield "mooring: the springs of [loads] (mooring_period, mooring_stiffness) hold the vessel; keep one of the two."
    for key in sorted(m.model_fields_set & {"length", "weight", "stiffness", "friction", "grounded", "linearised"}):
        if m.lines is None:
            yield f"mooring.{key}: only with lines. Remove it."
    yield from _lines(s, m)
    if m.table is not None:
        yield from _mooring_tables(m.table, folder)
    if m.moordyn is not None:
        yield from missing_file("mooring.moordyn.file", m.moordyn.file, folder)
        if s["simulation"] is not None and s["simulation"].realisations > 1:
            n = s["simulation"].realisations
            yield f"simulation.realisations: {n}: 1 expected with mooring.moordyn, whose lines have one state."


def _lines(s: dict[str, Any], m: Any) -> Iterator[str]:
    for key in ("length", "weight", "stiffness"):
        lacking = [i for i, line in enumerate(m.lines or ()) if getattr(line, key) is None and getattr(m, key) is None]
        if lacking and len(lacking) == len(m.lines):
            yield f"mooring.{key}: expected here for all lines, or in each of them, not found."
        else:
            yield from (f"mooring.lines[{i}].{key}: expected here or in [mooring], not found." for i in lacking)
    for i, line in enumerate(m.lines or ()):
        name, z = f"mooring.lines[{i}].anchor: z = {line.anchor[2]:g} m", line.anchor[2]
        if z >= line.fairlead[2]:
            yield f"{name}: below the fairlead, z = {line.fairlead[2]:g} m, expected."
        water = s["water"]
        if water is not None and z < -water.depth * (1 + 1e-9):
            yield f"{name}: not below the bottom expected, water.depth is {water.depth:g} m."


def _mooring_tables(table: Any, folder: Path) -> Iterator[str]:
    if not table.files:
        yield "mooring.table: a file for radial, or for surge, sway and yaw, expected, none found."
    if table.radial is not None and (table.surge is not None or table.sway is not None):
        yield "mooring.table: radial, or surge and sway, expected, both found."
    for key, name in table.files.items():
        yield from missing_file(f"mooring.table.{key}", name, folder)
