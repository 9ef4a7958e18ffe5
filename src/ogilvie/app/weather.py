"""Wind and current of a case in words."""

from math import degrees, hypot, isfinite
from typing import TYPE_CHECKING

from ogilvie.app.build_loads import make_current, make_wind
from ogilvie.app.case import Case
from ogilvie.post.report_tables import number
from ogilvie.units import knot

if TYPE_CHECKING:
    from ogilvie.mesh.panels import PanelMesh


def weather(case: Case, hull: "PanelMesh | None") -> tuple[tuple[str, str], ...]:
    """Return what wind and current are, as rows of name and value; none where there are none."""
    rows = []
    if case.wind is not None:
        wind = make_wind(case)
        speed = f"{number(wind.speed, 3)} m/s ({number(wind.speed / knot, 3)} kn) at {number(wind.reference_height, 3)} m"
        to = degrees(wind.direction)
        rows += [
            ("wind, mean of an hour", f"{speed}, profile {wind.profile}"),
            ("wind blows towards", f"{number(to, 4)}\u00b0, from {_compass(to)}\u00b0 by compass (x East)"),
        ]
        gusts = wind.spectrum(case.wind.height)
        if gusts is not None:
            rows.append(("gusts", f"{gusts.name}, standard deviation {number(gusts.deviation, 3)} m/s"))
    if case.current is not None:
        x, y, _ = make_current(case, hull).velocity
        flow = hypot(x, y)
        mean = ", mean over the draught" if case.current.profile is not None else ""
        rows += [
            ("current", f"{number(flow, 3)} m/s ({number(flow / knot, 3)} kn){mean}"),
            ("current flows towards", f"{number(_turn(case.current.direction_deg), 4)}\u00b0"),
        ]
    if rows and isfinite(case.water.depth):
        rows.append(("water depth", f"{number(case.water.depth)} m"))
    return tuple(rows)


def _compass(to: float) -> str:
    """Bearing that something comes from, clockwise from North with x East, deg."""
    return number((270.0 - to) % 360.0, 4)


def _turn(angle: float) -> float:
    return (angle + 180.0) % 360.0 - 180.0
