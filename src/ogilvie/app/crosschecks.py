"""What a case file must satisfy beyond single keys: files that exist, keys that go together, physics."""

from collections.abc import Iterator
from math import inf, isfinite, pi, sqrt
from pathlib import Path
from typing import Any

from ogilvie.app.crosscheck_files import missing_file
from ogilvie.app.crosschecks_control import control_checks
from ogilvie.app.crosschecks_loads import load_checks

#: Keys that each shape needs; all other lengths are mistakes there.
SHAPE_KEYS: dict[str, tuple[str, ...]] = {
    "s175": (),
    "box": ("length", "beam", "draught"),
    "hemisphere": ("radius",),
    "cylinder": ("radius", "draught"),
    "wigley": ("length", "beam", "draught", "variant"),
    "particulars": ("length", "beam", "draught", "cb"),
}
_ALSO_TAKEN = {"particulars": ("cm", "cwp", "lcb", "depth")}
_ALL_SHAPE_KEYS = ("length", "beam", "radius", "draught", "depth", "variant", "cb", "cm", "cwp", "lcb")


def crosschecks(sections: dict[str, Any], *, present: set[str], folder: Path) -> list[str]:
    """Return a sentence for every contradiction between keys; sections that are None (absent or broken) are passed over."""
    checks = (_source, _hull, _body, _coefficients, _sea, _range, _simulation, _loads, load_checks, control_checks)
    return [problem for check in checks for problem in check(sections, present, folder)]


def _source(s: dict[str, Any], present: set[str], folder: Path) -> Iterator[str]:
    coefficients = s["coefficients"]
    if "hull" not in present and coefficients is not None and coefficients.file is None:
        yield 'hull: expected, not found: give a [hull] (file or shape), or [coefficients] file = "...".'


def _hull(s: dict[str, Any], present: set[str], folder: Path) -> Iterator[str]:
    hull = s["hull"]
    if hull is None:
        return
    if (hull.file is None) == (hull.shape is None):
        yield f"hull: exactly one of file and shape expected, {'none' if hull.file is None else 'both'} found."
    elif hull.file is not None:
        yield from missing_file("hull.file", hull.file, folder)
        for key in hull.model_fields_set & (set(_ALL_SHAPE_KEYS) - {"draught"} | {"panels"}):
            yield f"hull.{key}: only with shape; the mesh file has its own. Remove it."
    else:
        for key in sorted(hull.model_fields_set & {"unit", "symmetry", "offset", "heal"}):
            yield f"hull.{key}: only with file. Remove it."
        needed = SHAPE_KEYS[hull.shape]
        for key in needed:
            if getattr(hull, key) is None:
                yield f'hull.{key}: expected with shape "{hull.shape}", not found.'
        taken = needed + _ALSO_TAKEN.get(hull.shape, ())
        for key in _ALL_SHAPE_KEYS:
            if getattr(hull, key) is not None and key not in taken:
                takes = ", ".join((*taken, "panels"))
                yield f'hull.{key}: not used by shape "{hull.shape}" (it takes {takes}). Remove it.'


def _body(s: dict[str, Any], present: set[str], folder: Path) -> Iterator[str]:
    body, hull, coefficients = s["body"], s["hull"], s["coefficients"]
    if "body" not in present:
        if coefficients is not None and coefficients.file is None and "hull" in present:
            yield "body: expected, not found: give a [body] with kg (or zg, or cog) and gyradii (or inertia)."
        return
    if body is None:
        return
    heights = [key for key in ("kg", "zg", "cog") if getattr(body, key) is not None]
    if len(heights) != 1:
        found = ", ".join(heights) or "none"
        yield f"body: exactly one of kg (above keel), zg (above still water) and cog expected, {found} found."
    if (body.gyradii is None) == (body.inertia is None):
        yield f"body: exactly one of gyradii and inertia expected, {'none' if body.gyradii is None else 'both'} found."
    if "hull" not in present and body.mass is None:
        yield "body.mass: expected where there is no hull, not found."
    if "hull" not in present and body.kg is not None:
        yield "body.kg: needs a hull to know the keel; give zg or cog."
    if body.gyradii is not None:
        squares = sorted(k**2 for k in body.gyradii)
        if squares[0] + squares[1] < squares[2] * (1 - 1e-9):
            yield f"body.gyradii: {list(body.gyradii)}: no mass has them (kxx^2 + kyy^2 >= kzz^2 expected, in any order)."
    if hull is not None and s["water"] is not None and hull.draught is not None and s["water"].depth <= hull.draught:
        yield f"water.depth: {s['water'].depth:g}: more than the draught {hull.draught:g} m expected."


def _coefficients(s: dict[str, Any], present: set[str], folder: Path) -> Iterator[str]:
    c = s["coefficients"]
    if c is None:
        return
    solver = {"omega", "periods", "omega_min", "omega_max", "omega_count", "directions_deg", "irregular_frequencies", "cache"}
    solver |= {"forward_speed", "solver"}
    if c.file is not None:
        yield from missing_file("coefficients.file", c.file, folder, stem=True)
        for key in sorted(c.model_fields_set & solver):
            yield f"coefficients.{key}: only where coefficients are computed; file has its own. Remove one of the two."
        return
    if c.scale is not None:
        yield "coefficients.scale: the unit length of a WAMIT file; only with file."
    if c.solver == "time-domain":
        yield from _time_domain(s, c)
    ways = [key for key in ("omega", "periods") if getattr(c, key) is not None]
    if c.model_fields_set & {"omega_min", "omega_max", "omega_count"}:
        ways.append("omega_min/omega_max/omega_count")
    if len(ways) > 1:
        yield f"coefficients: one of omega, periods and omega_min/omega_max/omega_count expected, {' and '.join(ways)} found."
    if (c.omega_min is None) != (c.omega_max is None):
        yield "coefficients: omega_min and omega_max expected together, one found."
    elif c.omega_min is not None and c.omega_min >= c.omega_max:
        yield f"coefficients.omega_max: {c.omega_max:g}: more than omega_min {c.omega_min:g} expected."


def _time_domain(s: dict[str, Any], c: Any) -> Iterator[str]:
    water, vessel = s["water"], s["vessel"]
    if water is not None and isfinite(water.depth):
        yield f'coefficients.solver: "time-domain" is for deep water, water.depth = {water.depth:g} m found.'
    if vessel is not None and vessel.speed_knots > 0.0 and c.forward_speed == "panels":
        yield 'coefficients.solver: "time-domain" solves at rest; a vessel with speed needs forward_speed = "rule".'
    for key in sorted(c.model_fields_set & {"irregular_frequencies", "cache"}):
        yield f'coefficients.{key}: only with solver = "frequency-domain". Remove it.'


def _sea(s: dict[str, Any], present: set[str], folder: Path) -> Iterator[str]:
    sea, water = s["sea"], s["water"]
    if sea is None:
        return
    if "sea" not in present:
        yield 'sea: expected, not found: give a [sea] with hs and tp, or spectrum = "calm".'
        return
    needed = {"regular": ("amplitude", "period"), "calm": ()}.get(sea.spectrum, ("hs", "tp"))
    for key in needed:
        if getattr(sea, key) is None:
            yield f'sea.{key}: expected with spectrum "{sea.spectrum}", not found.'
    foreign = {"hs", "tp", "amplitude", "period", "gamma", "spreading"} - set(needed)
    if sea.spectrum not in ("regular", "calm"):
        foreign -= {"spreading"}
    if sea.spectrum == "jonswap":
        foreign -= {"gamma"}
    if sea.spreading is None and "spreading_kind" in sea.model_fields_set:
        yield "sea.spreading_kind: only with spreading. Give its exponent, or remove this."
    if sea.spectrum in ("regular", "calm"):
        foreign |= {"components", "method", "random", "seed"}
    for key in sorted(sea.model_fields_set & foreign):
        yield f'sea.{key}: not used by spectrum "{sea.spectrum}". Remove it.'
    if water is None:
        return
    height, period = (
        (2 * sea.amplitude if sea.amplitude else None, sea.period) if sea.spectrum == "regular" else (sea.hs, sea.tp)
    )
    if height and period:
        steepness = 2 * pi * height / (water.g * period**2)
        if steepness > 1 / 7:
            yield (
                f"sea: height {height:g} m with period {period:g} s: steepness {steepness:.3f}, at most 1/7 exists "
                "(waves break). Lower the height or lengthen the period."
            )


def _range(s: dict[str, Any], present: set[str], folder: Path) -> Iterator[str]:
    """The peak of the sea has to lie well inside the frequencies that are to be solved."""
    sea, c = s["sea"], s["coefficients"]
    if sea is None or c is None or c.file is not None:
        return
    period = sea.tp or sea.period
    low, high = solved_range(c)
    if period is None or high == inf:
        return
    w = 2 * pi / period
    need = w if sea.spectrum == "regular" else 1.5 * w
    if need > high or w < low:
        what = "the wave" if sea.spectrum == "regular" else "1.5 times the peak"
        yield (
            f"sea: peak at {w:.3g} rad/s (period {period:g} s): the frequencies {low:.3g}..{high:.3g} rad/s of [coefficients] "
            f"must hold it and reach {what}, {need:.3g} rad/s. Widen omega_min/omega_max."
        )


def solved_range(c: Any) -> tuple[float, float]:
    """Return the lowest and highest frequency that a [coefficients] section asks for, or (0, inf) where it does not say."""
    if c.omega is not None:
        return min(c.omega), max(c.omega)
    if c.periods is not None:
        return 2 * pi / max(c.periods), 2 * pi / min(c.periods)
    if c.omega_min is not None and c.omega_max is not None:
        return c.omega_min, c.omega_max
    return 0.0, inf


def _simulation(s: dict[str, Any], present: set[str], folder: Path) -> Iterator[str]:
    run, sea = s["simulation"], s["sea"]
    if run is None:
        return
    if run.dt >= run.duration:
        yield f"simulation.dt: {run.dt:g}: less than the duration {run.duration:g} s expected."
    if run.ramp >= run.duration:
        yield f"simulation.ramp: {run.ramp:g}: less than the duration {run.duration:g} s expected."
    if run.output_step is not None and abs(run.output_step / run.dt - round(run.output_step / run.dt)) > 1e-6:
        yield f"simulation.output_step: {run.output_step:g}: a multiple of dt = {run.dt:g} s expected."
    if run.method == "exact" and s["memory"] is not None and s["memory"].model == "convolution":
        yield 'simulation.method: "exact": only with memory.model = "state-space"; take "rk4".'
    if run.skip is not None and run.skip >= run.duration:
        yield f"simulation.skip: {run.skip:g}: less than the duration {run.duration:g} s expected."
    period = sea and (sea.tp or sea.period)
    if period and run.dt > period / 20:
        yield f"simulation.dt: {run.dt:g}: at most a twentieth of the wave period expected, {period / 20:.3g} s."
    if sea is not None and sea.spectrum in ("regular", "calm") and run.realisations > 1:
        yield f'simulation.realisations: {run.realisations}: 1 expected, a "{sea.spectrum}" sea has no seed.'


def _loads(s: dict[str, Any], present: set[str], folder: Path) -> Iterator[str]:
    loads = s["loads"]
    if loads is None:
        return
    for dof in loads.mooring_period.given.keys() & loads.mooring_stiffness.given.keys():
        yield f"loads: {dof}: one of mooring_period and mooring_stiffness expected, both found."
    for dof, ratio in loads.damping_ratio.given.items():
        if ratio >= 1:
            yield f"loads.damping_ratio.{dof}: {ratio:g}: a fraction of critical damping < 1 expected (5 % is 0.05)."


def default_range(beam: float, g: float) -> tuple[float, float]:
    """Return frequencies that show most of the radiation of a hull of this beam: 0.1 and 1 times 3.6 sqrt(g/B), rad/s.

    Examples
    --------
    >>> [round(w, 2) for w in default_range(25.4, 9.80665)]
    [0.22, 2.24]
    """
    high = 3.6 * sqrt(g / beam)
    return 0.1 * high, high
