"""What control laws recorded in a run, sorted into panels of a figure: heading, speed, rudder, position, thrusts."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ogilvie.post.plot._style import power
from ogilvie.units import knot

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]
Curve = tuple[str, Array, bool]  # label, values, whether it is a reference

_REFERENCES = ("heading reference", "reference heading")


@dataclass
class Panel:
    """One axis: title, unit and curves."""

    title: str
    unit: str
    curves: list[Curve] = field(default_factory=list)


def control_panels(run: "xr.Dataset") -> list[Panel]:
    """Return the panels of the first realisation of large motions."""
    eta = run.eta.values.reshape(-1, *run.eta.shape[-2:])[0]
    by_name = recorded(run)
    panels = [_heading(eta, by_name)]
    if speed := _speed(run, by_name):
        panels.append(speed)
    if "rudder angle" in by_name:
        panels.append(Panel("rudder angle, positive turns to port", "deg", [("rudder", by_name["rudder angle"], False)]))
    for axis, column in (("x", 0), ("y", 1)):
        if f"reference {axis}" in by_name:
            panels.append(Panel(axis, "m", [(axis, eta[:, column], False), ("reference", by_name[f"reference {axis}"], True)]))
    return panels + _thrusts(by_name)


def recorded(run: "xr.Dataset") -> dict[str, Array]:
    """Return the signals of the first realisation by their names, angles in degrees."""
    found = {}
    for key in map(str, run.data_vars):
        one = run[key]
        if "signal" in one.attrs:
            values = (one.isel(realisation=0) if "realisation" in one.dims else one).values
            found[str(one.attrs["signal"])] = np.degrees(values) if str(one.attrs.get("units")).startswith("rad") else values
    return found


def _heading(eta: Array, signals: dict[str, Array]) -> Panel:
    heading = np.degrees(np.unwrap(eta[:, 5]))
    curves: list[Curve] = [("heading", heading, False)]
    for name in _REFERENCES:
        if name in signals:
            line = np.degrees(np.unwrap(np.radians(signals[name])))
            curves.append(("reference", line + 360.0 * np.round((heading[0] - line[0]) / 360.0), True))
    return Panel("heading", "deg", curves)


def _speed(run: "xr.Dataset", signals: dict[str, Array]) -> Panel | None:
    """Speed along the bow, for a vessel that is meant to make way."""
    if "nu" not in run or (float(run.attrs.get("speed", 0.0)) == 0.0 and "speed reference" not in signals):
        return None
    ahead = run.nu.values.reshape(-1, *run.nu.shape[-2:])[0][:, 0]
    panel = Panel("speed ahead", "kn", [("over ground", ahead / knot, False)])
    for name, label, reference in (("speed measured", "measured", False), ("speed reference", "reference", True)):
        if name in signals:
            panel.curves.append((label, signals[name] / knot, reference))
    return panel


def _thrusts(signals: dict[str, Array]) -> list[Panel]:
    """Thrusts, four to a panel; of azimuth thrusters the size."""
    curves: list[Curve] = [("thrust", signals["thrust"], False)] if "thrust" in signals else []
    for name, values in signals.items():
        unit = name.removeprefix("thrust of ")
        if unit == name or unit.endswith(" to port"):
            continue
        if unit.endswith(" forward"):
            unit = unit.removesuffix(" forward")
            values = np.hypot(values, signals.get(f"thrust of {unit} to port", 0.0 * values))
        curves.append((unit, values, False))
    panels = []
    for part in (curves[i : i + 4] for i in range(0, len(curves), 4)):
        factor, prefix = power(np.concatenate([v for _, v, _ in part]))
        title = "thrust" if part[0][0] == "thrust" else "thrusts"
        panels.append(Panel(title, f"{prefix}N", [(label, v / factor, r) for label, v, r in part]))
    return panels
