"""From a case to what steers, drives and holds the vessel: autopilot, speed keeping, positioning, mooring."""

from math import pi, radians
from typing import TYPE_CHECKING, Any

import numpy as np

from ogilvie.app.build_loads import (
    Made,
    after_end,
    hull_lift,
    make_current,
    make_wind,
    resistance,
    righting_levers,
    wind_coefficients,
)
from ogilvie.app.build_memory import slow_added_mass
from ogilvie.app.case import Case
from ogilvie.app.tables import read_columns
from ogilvie.errors import InputError
from ogilvie.units import deg, knot

if TYPE_CHECKING:
    from ogilvie.loads.control.observer import WaveFilter
    from ogilvie.mesh.panels import PanelMesh

#: The notch of a wave filter has to lie so many times above the bandwidth of the control.
_APART = 2.0


def try_parts(case: Case, hull: "PanelMesh | None") -> None:
    """Make once what needs no coefficients, so that a mistake in it is told before the long work.

    Raises
    ------
    InputError
        What a load finds wrong: tables, thrusters that cannot hold the vessel, lines that cannot be.
    """
    from ogilvie.loads.control.thruster import check_capability

    made = Made(case, None, None, hull)  # type: ignore[arg-type]
    if case.restoring is not None and case.restoring.file is not None:
        righting_levers(case)
    if case.wind is not None:
        wind_coefficients(made)
        make_wind(case)
    if case.current is not None:
        make_current(case, hull)
    if case.resistance is not None:
        resistance(made)
    if case.hull_lift is not None:
        hull_lift(made)
    if case.mooring is not None:
        mooring(made)
    for name in ("autopilot", "positioning"):
        section = getattr(case, name)
        if section is not None:
            _wave_filter(made, section, name)
    if case.autopilot is not None and case.autopilot.rudder is not None:
        _rudder(made)
    if case.positioning is not None and case.positioning.thrusters is not None:
        check_capability([_thruster(t, i) for i, t in enumerate(case.positioning.thrusters)], None)


def control_loads(made: Made) -> list[Any]:
    """Return the loads of the sections autopilot, speed_keeping and positioning."""
    case, loads = made.case, list[Any]()
    if case.autopilot is not None:
        loads.append(_autopilot(made))
    if case.speed_keeping is not None:
        loads.append(_speed_keeping(made))
    if case.positioning is not None:
        loads.append(_positioning(made))
    return loads


def _autopilot(made: Made) -> Any:
    from ogilvie.loads.control.autopilot import Autopilot

    case, a = made.case, made.case.autopilot
    assert a is not None
    heading: Any = radians(case.vessel.heading_deg if a.heading_deg is None else a.heading_deg)
    if a.schedule is not None:
        heading = np.array(a.schedule) * [1.0, deg]
    lift = hull_lift(made) if case.hull_lift is not None else None
    return Autopilot(
        heading,
        None if a.rudder is None else _rudder(made),
        max_moment=a.max_moment,
        natural_frequency=a.natural_frequency,
        damping=a.damping,
        added_mass=slow_added_mass(made.hydro),
        yaw_damping=0.0 if lift is None else lift.end_mass * case.speed * lift.x**2,
        max_rate=np.inf if a.max_rate_deg is None else a.max_rate_deg * deg,
        wave_filter=_wave_filter(made, a, "autopilot"),
        period=a.period,
    )


def _rudder(made: Made) -> Any:
    from ogilvie.loads.control.rudder import Rudder

    r: Any = made.case.autopilot and made.case.autopilot.rudder
    end, draught = (0.0, 0.0) if made.hull is None else after_end(made.hull)
    return Rudder(
        r.area,
        r.aspect_ratio,
        position=(end if r.x is None else r.x, r.y, -0.5 * draught if r.z is None else r.z),
        max_angle=r.max_angle_deg * deg,
        rate=r.rate_deg * deg,
        inflow=r.inflow,
        straightening=r.straightening,
        drag_deduction=r.drag_deduction,
        hull_interaction=r.hull_interaction,
        hull_position=r.hull_position,
        rho=made.case.water.rho,
    )


def encounter_peak(made: Made) -> float:
    """Return the frequency (rad/s, without sign) at which the vessel meets the waves of the spectrum's peak."""
    from ogilvie.waves.dispersion import encounter_frequency

    case = made.case
    period = case.sea.period if case.sea.spectrum == "regular" else case.sea.tp
    b = radians(case.sea.direction_deg - case.vessel.heading_deg)
    water = {"depth": case.water.depth, "g": case.water.g}
    return abs(float(encounter_frequency(2 * pi / float(period or np.inf), speed=case.speed, direction=b, **water)))


def _wave_filter(made: Made, section: Any, name: str) -> "WaveFilter | None":
    if not section.wave_filter or made.case.sea.spectrum == "calm":
        return None
    from ogilvie.loads.control.observer import WaveFilter

    peak = encounter_peak(made)
    if peak < _APART * section.natural_frequency:
        raise InputError(
            f"{name}.wave_filter: true: waves met at {_APART:g} times natural_frequency {section.natural_frequency:g} rad/s or "
            f"more expected, {peak:.3g} rad/s found: they cannot be told from the vessel's own motion. Take false."
        )
    return WaveFilter(peak)


def _speed_keeping(made: Made) -> Any:
    from ogilvie.loads.control.speed import SpeedKeeping

    case, k = made.case, made.case.speed_keeping
    assert k is not None
    speed = case.speed if k.speed_knots is None else k.speed_knots * knot
    highest = np.inf if k.max_thrust is None else k.max_thrust
    thrust = float(resistance(made).resistance(case.speed)) if case.resistance is not None else 0.0
    return SpeedKeeping(
        speed,
        over_ground=k.over_ground,
        natural_frequency=k.natural_frequency,
        damping=k.damping,
        added_mass=slow_added_mass(made.hydro),
        max_thrust=highest,
        max_reverse=k.max_reverse,
        rate=np.inf if k.rate is None else k.rate,
        thrust=min(thrust, highest),
        position=(0.0, 0.0, k.z),
        period=k.period,
    )


def _positioning(made: Made) -> Any:
    from ogilvie.loads.control.positioning import DynamicPositioning

    case, p = made.case, made.case.positioning
    assert p is not None
    heading = case.vessel.heading_deg if p.heading_deg is None else p.heading_deg
    setpoint: Any = (p.x, p.y, radians(heading))
    if p.schedule is not None:
        setpoint = np.array(p.schedule) * [1.0, 1.0, 1.0, deg]
    units = None if p.thrusters is None else [_thruster(t, i) for i, t in enumerate(p.thrusters)]
    return DynamicPositioning(
        setpoint,
        units,
        natural_frequency=p.natural_frequency,
        damping=p.damping,
        added_mass=slow_added_mass(made.hydro),
        wave_filter=_wave_filter(made, p, "positioning"),
        max_speed=np.inf if p.max_speed is None else p.max_speed,
        max_rate=np.inf if p.max_rate_deg is None else p.max_rate_deg * deg,
        period=p.period,
    )


def _thruster(t: Any, i: int) -> Any:
    from ogilvie.loads.control.thruster import Thruster

    direction = {"azimuth": None, "tunnel": 0.5 * pi}.get(t.kind, radians(t.direction_deg or 0.0))
    return Thruster(
        (t.x, t.y, t.z),
        direction=direction,
        azimuth=t.kind == "azimuth",
        max_thrust=t.max_thrust,
        max_reverse=t.max_reverse,
        rate=np.inf if t.rate is None else t.rate,
        name=t.name or f"{t.kind} {i + 1}",
    )


def mooring(made: Made) -> Any:
    """Return the mooring of the section of that name."""
    m = made.case.mooring
    assert m is not None
    if m.lines is not None:
        lines = make_lines(made)
        return lines.linearised(_start(made)) if m.linearised else lines
    if m.table is not None:
        return _table(made, m.table)
    from ogilvie.loads.moordyn import MoorDyn

    d: Any = m.moordyn
    period = made.case.simulation.dt if d.period is None else d.period
    return MoorDyn(made.case.path(d.file), period=period, dt=d.dt)


def _start(made: Made) -> list[float]:
    return [0.0, 0.0, 0.0, 0.0, 0.0, radians(made.case.vessel.heading_deg)]


def make_lines(made: Made) -> Any:
    """Return the catenary lines."""
    from ogilvie.loads.mooring_line import MooringLine
    from ogilvie.loads.mooring_lines import CatenaryMooring

    m: Any = made.case.mooring
    names = ("length", "weight", "stiffness", "friction", "grounded")
    found = []
    for i, line in enumerate(m.lines):
        own = {key: getattr(m if getattr(line, key) is None else line, key) for key in names}
        try:
            found.append(MooringLine(line.anchor, line.fairlead, **own))
        except InputError as error:
            raise InputError(f"mooring.lines[{i}]: {error}") from None
    return CatenaryMooring(found)


def _table(made: Made, t: Any) -> Any:
    from ogilvie.loads.mooring_table import MooringTable

    read: dict[str, Any] = {}
    for key, name in t.files.items():
        unit, force = ("deg", "N m") if key == "yaw" else ("m", "N")
        x, f = read_columns(made.case.path(name), columns=(2,), what=f"displacement in {unit}, force back in {force}")
        read[key] = (x * deg, f) if key == "yaw" else (x, f)
    radial = read.pop("radial", None)
    options = {"point": t.point, "interpolation": t.interpolation, "beyond": t.beyond}
    return MooringTable(radial, tables=read, heading=radians(made.case.vessel.heading_deg), **options)
