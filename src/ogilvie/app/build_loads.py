"""From a case to the loads beyond waves, radiation and springs: restoring, damping, resistance, lift, wind, current."""

from dataclasses import dataclass
from math import ceil, radians
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.app.build import make_whole_hull
from ogilvie.app.case import Case
from ogilvie.app.tables import read_columns
from ogilvie.errors import InputError
from ogilvie.hydro.at_speed import radiation_at_rest
from ogilvie.units import deg, knot

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.body import RigidBody
    from ogilvie.loads.current import Current
    from ogilvie.loads.hull_lift import HullLift
    from ogilvie.loads.resistance import SurgeResistance
    from ogilvie.loads.wind_coefficients import WindCoefficients
    from ogilvie.mesh.panels import PanelMesh
    from ogilvie.waves.wind import Wind

Array = NDArray[np.float64]

_GUST_STEP = 0.5  # s


@dataclass(frozen=True, eq=False)
class Made:
    """What of a case is there when its loads are made."""

    case: Case
    body: "RigidBody"
    hydro: "xr.Dataset"
    hull: "PanelMesh | None"

    @property
    def wetted(self) -> Any:
        """The wetted hull, which the checks of the case made sure of."""
        return self.hull


def plain_loads(made: Made) -> list[Any]:
    """Return the loads of the sections damping, resistance, hull_lift, wind and current."""
    case, loads = made.case, list[Any]()
    if case.damping is not None:
        loads += _damping(made)
    if case.hull_lift is not None:
        loads.append(hull_lift(made))
    if case.resistance is not None:
        loads.append(resistance(made))
    if case.wind is not None:
        loads.append(_wind_force(made))
    if case.current is not None:
        loads.append(make_current(case, made.hull))
    return loads


def restoring(made: Made) -> Any:
    """Return the hydrostatic restoring: linear, by a curve of righting levers, or of the hull as the water cuts it."""
    from ogilvie.loads.restoring import LinearRestoring

    r, g = made.case.restoring, made.case.water.g
    if r is None or r.kind == "linear":
        return LinearRestoring(made.hydro)
    if r.kind == "hull":
        from ogilvie.loads.hull_restoring import HullRestoring

        spans: Any = {"roll": r.max_roll_deg * deg, "pitch": r.max_pitch_deg * deg}
        return HullRestoring(make_whole_hull(made.case), made.body, **spans, rho=made.case.water.rho, g=g)
    from ogilvie.loads.gz import GZRestoring

    if r.file is not None:
        angle, lever = righting_levers(made.case)
        return GZRestoring(made.hydro, angle, lever, displacement=made.body.mass, g=g)
    from ogilvie.mesh.gz import gz_curve

    angles = np.linspace(0.0, r.max_roll_deg, ceil(r.max_roll_deg / 2.5) + 1) * deg
    curve = gz_curve(make_whole_hull(made.case), made.body, angles, rho=made.case.water.rho)
    return GZRestoring.from_curve(made.hydro, curve, g=g)


def righting_levers(case: Case) -> tuple[Array, Array]:
    """Return angles of heel (rad) and righting levers (m) of the file of the case."""
    r: Any = case.restoring
    angle, lever = read_columns(case.path(r.file), columns=(2,), what="heel in deg, lever in m")
    return angle * deg, lever


def _damping(made: Made) -> list[Any]:
    from ogilvie.loads.base import per_dof
    from ogilvie.loads.cross_flow import CrossFlowDrag
    from ogilvie.loads.roll_damping import RollDamping
    from ogilvie.loads.viscous import LinearDamping, QuadraticDamping

    d, loads = made.case.damping, list[Any]()
    assert d is not None
    if d.linear.given:
        loads.append(LinearDamping(np.diag(per_dof(d.linear.given, "damping.linear"))))
    quadratic = dict(d.quadratic.given)
    roll = quadratic.pop("roll", 0.0)
    if quadratic:
        loads.append(QuadraticDamping(quadratic))
    if roll or d.cubic is not None:
        loads.append(RollDamping(quadratic=roll, cubic=0.0 if d.cubic is None else d.cubic.roll))
    if d.cross_flow is not None:
        c = d.cross_flow
        drag: Any = {"cd": c.cd, "cd_vertical": c.cd_vertical, "z": c.z, "strips": c.strips}
        loads.append(CrossFlowDrag.from_hull(made.wetted, **drag, rho=made.case.water.rho))
    return loads + ([_ikeda(made)] if d.ikeda is not None else [])


def _ikeda(made: Made) -> Any:
    from ogilvie.loads.ikeda import IkedaHull
    from ogilvie.loads.ikeda_damping import IkedaRollDamping
    from ogilvie.post.report_tables import natural_periods

    i: Any = made.case.damping and made.case.damping.ikeda
    period = natural_periods(radiation_at_rest(made.hydro), made.body).get("roll")
    if period is None:
        raise InputError(
            "damping.ikeda: the natural frequency of roll within the coefficients expected, not found. Extend omega_min, "
            "omega_max, or check GM."
        )
    keels = None if i.keel_start is None else (i.keel_start, i.keel_end, i.keel_breadth)
    hull = IkedaHull.from_hull(made.wetted, cog=made.body.cog, keels=keels, rho=made.case.water.rho)
    return IkedaRollDamping(hull, omega=2 * np.pi / period, amplitude=i.amplitude_deg * deg, model=i.model)


def resistance(made: Made) -> "SurgeResistance":
    """Return the calm-water resistance, with the thrust that balances it at the vessel's speed where nothing else keeps it."""
    from ogilvie.loads.resistance import SurgeResistance

    case, r = made.case, made.case.resistance
    assert r is not None
    balanced = r.balanced if r.balanced is not None else case.speed > 0.0 and case.speed_keeping is None
    at = case.speed if balanced else None
    if r.file is not None:
        speed, force = read_columns(case.path(r.file), columns=(2,), what="speed in m/s, resistance in N")
        return SurgeResistance.from_table(speed, force, astern=r.astern, balanced_at=at)
    residuary = None
    if r.residuary is not None:
        froude, C = read_columns(case.path(r.residuary), columns=(2,), what="Froude number, residuary coefficient")
        residuary = (froude, C)
    return SurgeResistance(
        area=r.wetted_area if r.wetted_area is not None else float(made.wetted.full().areas.sum()),
        length=r.length if r.length is not None else made.wetted.length,
        form_factor=r.form_factor,
        allowance=r.allowance,
        residuary=residuary,
        astern=r.astern,
        balanced_at=at,
        rho=case.water.rho,
        g=case.water.g,
    )


def hull_lift(made: Made) -> "HullLift":
    """Return the lift of the hull; draught and place of the after end by default from the deepest point of the last tenth."""
    from ogilvie.loads.hull_lift import HullLift

    given = made.case.hull_lift
    assert given is not None
    x, draught = (0.0, 0.0) if made.hull is None else after_end(made.hull)
    return HullLift(
        draught=given.draught if given.draught is not None else draught,
        x=given.x if given.x is not None else x,
        rho=made.case.water.rho,
    )


def after_end(hull: "PanelMesh") -> tuple[float, float]:
    """Return the place of the after end of a wetted hull and the draught there, the largest of the last tenth of its length.

    Examples
    --------
    >>> from ogilvie.mesh.shapes import box
    >>> after_end(box(20.0, 4.0, 1.5, panels=60))
    (-10.0, 1.5)
    """
    points = hull.full().vertices
    low, high = float(points[:, 0].min()), float(points[:, 0].max())
    last = points[points[:, 0] <= low + 0.1 * (high - low)]
    return low, -float(last[:, 2].min())


def make_wind(case: Case) -> "Wind":
    """Return the wind of a case, with one realisation of the gusts for each of the sea."""
    from ogilvie.waves.wind import Wind, blowing_from

    w: Any = case.wind
    direction = radians(w.direction_deg) if w.direction_deg is not None else blowing_from(radians(w.from_deg))
    first = w.seed if w.seed is not None else case.sea.seed
    steps = max(ceil(case.simulation.duration / _GUST_STEP - 1e-9), 8)
    return Wind(
        w.speed if w.speed is not None else w.speed_knots * knot,
        direction,
        reference_height=w.reference_height,
        profile=w.profile,
        gust=None if w.gust == "none" else w.gust,
        seed=range(first, first + case.simulation.realisations),
        period=steps * _GUST_STEP,
        step=_GUST_STEP,
    )


def _wind_force(made: Made) -> Any:
    from ogilvie.loads.wind import WindForce

    w: Any = made.case.wind
    return WindForce(wind_coefficients(made), make_wind(made.case), height=w.height)


def wind_coefficients(made: Made) -> "WindCoefficients":
    """Return the wind coefficients of a case: by type of ship, by regression, or from a table."""
    from ogilvie.loads.wind_blendermann import blendermann_wind
    from ogilvie.loads.wind_coefficients import WindCoefficients
    from ogilvie.loads.wind_isherwood import isherwood_wind

    w: Any = made.case.wind
    kind = w.blendermann or w.isherwood or w.table
    given = kind.model_dump()
    for key in ("length", "beam"):
        if key in given and given[key] is None:
            given[key] = getattr(made.wetted, key)
    if w.blendermann is not None:
        return blendermann_wind(given.pop("type"), **given)
    if w.isherwood is not None:
        return isherwood_wind(**given)
    columns = read_columns(made.case.path(given.pop("file")), columns=(3, 4, 5), what="angle in deg, CX, CY, CK, CN")
    return WindCoefficients(columns[0] * deg, *columns[1:], **given)


def make_current(case: Case, hull: "PanelMesh | None") -> "Current":
    """Return the current of a case; a profile is averaged over the draught of the hull."""
    from ogilvie.loads.current import Current

    c: Any = case.current
    direction = radians(c.direction_deg)
    if c.profile is None:
        return Current(c.speed if c.speed is not None else c.speed_knots * knot, direction)
    z, speed = np.array(c.profile).T
    return Current(speed, direction, z=z, draught=c.draught if c.draught is not None else hull.draught)  # type: ignore[union-attr]
