"""What the sections on control must satisfy beyond single keys, and which motions a case has."""

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

from ogilvie.app.crosschecks_loads import hullless

#: Sections that are for large motions alone.
STEERING = ("resistance", "wind", "current", "autopilot", "speed_keeping", "positioning")


def control_checks(s: dict[str, Any], present: set[str], folder: Path) -> Iterator[str]:
    """Yield a sentence for every contradiction in the sections on control."""
    s = {**s, "hullless": hullless(s, present)}
    for check in (_autopilot, _speed_keeping, _positioning, _motions):
        yield from check(s)


def beyond_small(s: dict[str, Any]) -> list[str]:
    """Return the names of what is given for large motions alone."""
    found = [name for name in STEERING if s[name] is not None]
    damping, mooring = s["damping"], s["mooring"]
    if damping is not None and damping.cross_flow is not None:
        found.append("damping.cross_flow")
    if damping is not None and damping.quadratic.given.keys() - {"roll"}:
        found.append("damping.quadratic")
    if mooring is not None and not mooring.linearised:
        found.append("mooring")
    return found


def not_linear(s: dict[str, Any]) -> list[str]:
    """Return the names of what small motions replace by its linear part."""
    found = []
    restoring, damping = s["restoring"], s["damping"]
    if restoring is not None and restoring.kind != "linear":
        found.append("restoring")
    if damping is not None and ("roll" in damping.quadratic.given or damping.cubic is not None):
        found.append("damping of roll")
    if damping is not None and damping.ikeda is not None and damping.ikeda.model != "linear":
        found.append("damping.ikeda")
    return found


def large_motions(s: dict[str, Any]) -> bool:
    """Return whether the sections of a case ask for large motions."""
    wish = s["simulation"].motions
    return bool(wish == "large" or (wish == "auto" and (beyond_small(s) or not_linear(s))))


def _period(section: Any, name: str, s: dict[str, Any]) -> Iterator[str]:
    run = s["simulation"]
    if run is None:
        return
    steps = section.period / run.dt
    if round(steps) < 1 or abs(steps - round(steps)) > 1e-6:
        yield f"{name}.period: {section.period:g}: a multiple of simulation.dt = {run.dt:g} s expected."


def _schedule(rows: Any, name: str) -> Iterator[str]:
    times = [row[0] for row in rows]
    if any(b <= a for a, b in pairwise(times)):
        yield f"{name}.schedule: rows that begin with increasing times (s) expected, {times} found."


def _wave_filter(section: Any, name: str, s: dict[str, Any]) -> Iterator[str]:
    sea = s["sea"]
    explicit = "wave_filter" in section.model_fields_set and section.wave_filter
    if explicit and sea is not None and sea.spectrum == "calm":
        yield f"{name}.wave_filter: true: a sea expected, calm water found. Remove it."


def _autopilot(s: dict[str, Any]) -> Iterator[str]:
    a = s["autopilot"]
    if a is None:
        return
    if (a.rudder is None) == (a.max_moment is None):
        found = "none" if a.rudder is None else "both"
        yield f"autopilot: exactly one of [autopilot.rudder] and max_moment (N m) expected, {found} found."
    if a.heading_deg is not None and a.schedule is not None:
        yield "autopilot: heading_deg or schedule expected, both found."
    if a.schedule is not None:
        yield from _schedule(a.schedule, "autopilot")
    if a.rudder is not None and s["hullless"]:
        for key in ("x", "z"):
            if getattr(a.rudder, key) is None:
                yield f"autopilot.rudder.{key}: expected where there is no hull, not found."
    if a.rudder is not None and s["vessel"] is not None and s["vessel"].speed_knots == 0.0:
        yield "autopilot.rudder: a rudder needs vessel.speed_knots > 0, 0 found. Give a speed, or max_moment, or [positioning]."
    yield from _period(a, "autopilot", s)
    yield from _wave_filter(a, "autopilot", s)


def _speed_keeping(s: dict[str, Any]) -> Iterator[str]:
    k, vessel = s["speed_keeping"], s["vessel"]
    if k is None:
        return
    if k.speed_knots is None and vessel is not None and vessel.speed_knots == 0.0:
        yield "speed_keeping.speed_knots: expected where vessel.speed_knots is 0, not found."
    yield from _period(k, "speed_keeping", s)


def _positioning(s: dict[str, Any]) -> Iterator[str]:
    p, vessel = s["positioning"], s["vessel"]
    if p is None:
        return
    for other in ("autopilot", "speed_keeping"):
        if s[other] is not None:
            yield f"positioning: it steers and drives already; remove [{other}] or [positioning]."
    if vessel is not None and vessel.speed_knots > 0.0:
        yield f"positioning: a vessel without forward speed expected, vessel.speed_knots = {vessel.speed_knots:g} found."
    if p.schedule is not None:
        yield from _schedule(p.schedule, "positioning")
        for key in sorted(p.model_fields_set & {"x", "y", "heading_deg"}):
            yield f"positioning.{key}: not used beside schedule. Remove one of the two."
    for i, t in enumerate(p.thrusters or ()):
        name = f"positioning.thrusters[{i}]"
        if t.direction_deg is not None and t.kind != "fixed":
            yield f'{name}.direction_deg: only with kind "fixed"; a "{t.kind}" thruster has none. Remove it.'
        if t.max_reverse is not None and t.kind == "azimuth":
            yield f'{name}.max_reverse: not used by kind "azimuth", which turns round. Remove it.'
    yield from _period(p, "positioning", s)
    yield from _wave_filter(p, "positioning", s)


def _motions(s: dict[str, Any]) -> Iterator[str]:
    run, memory = s["simulation"], s["memory"]
    if run is None:
        return
    beyond = beyond_small(s)
    if run.motions == "small" and beyond:
        yield f'simulation.motions: "small": "large" or "auto" expected with {", ".join(beyond)}, which are not linear.'
        return
    if not large_motions(s):
        return
    why = ", ".join(beyond + not_linear(s)) or 'motions = "large"'
    if run.method == "exact":
        yield f'simulation.method: "exact": "rk4" expected for large motions ({why}).'
    if memory is not None and memory.model == "convolution":
        yield f'memory.model: "convolution": "state-space" expected for large motions ({why}).'
