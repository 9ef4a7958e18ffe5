"""Tables of a vessel that sails or keeps its place: track, speed, heading, what control did."""

from typing import TYPE_CHECKING

import numpy as np

from ogilvie.post.course import courses
from ogilvie.post.page import Table
from ogilvie.post.report_tables import number
from ogilvie.units import knot

if TYPE_CHECKING:
    import xarray as xr

#: Signals of control laws that a reader wants in figures: name, title, factor, unit.
_SIGNALS = (
    ("rudder angle", "rudder angle", 180.0 / np.pi, "deg"),
    ("speed measured", "speed measured by the control", 1.0 / knot, "kn"),
    ("thrust", "thrust", 1e-3, "kN"),
)


def course_rows(run: "xr.Dataset", *, skip: float = 0.0) -> list[tuple[str, str]]:
    """Return what describes the mean course of large motions, over all realisations; nothing for small ones."""
    if run.attrs.get("motions") != "large" or float(run.time[-1] - run.time[0]) <= skip:
        return []
    found = courses(run, skip=skip)
    headings = np.degrees([c.heading for c in found])
    rows = []
    if not all(c.straight for c in found):
        turned = np.degrees(max(c.turned for c in found))
        rows.append(("course", f"turns by up to {number(float(turned))} deg: no mean track"))
    elif any(c.speed > 0.0 for c in found):
        rows += [
            ("speed over ground", f"{_spread([c.speed / knot for c in found])} kn"),
            ("track over ground, towards", f"{_spread(np.degrees([c.direction for c in found]))} deg"),
            ("mean heading", f"{_spread(headings)} deg"),
            ("drift angle, track less heading", f"{_spread(np.degrees([c.drift_angle for c in found]))} deg"),
        ]
    else:
        places = np.array([c.start for c in found])
        rows += [
            ("mean place, x", f"{_spread(places[:, 0])} m"),
            ("mean place, y", f"{_spread(places[:, 1])} m"),
            ("mean heading", f"{_spread(headings)} deg"),
        ]
    return rows + _signals(run, skip)


def course_table(run: "xr.Dataset", *, skip: float = 0.0) -> list[Table]:
    """Return the table of :func:`course_rows`, if there is one."""
    rows = course_rows(run, skip=skip)
    return [Table(rows, caption="Course; the range is that of the realisations.", wrap=frozenset({1}))] if rows else []


def _signals(run: "xr.Dataset", skip: float) -> list[tuple[str, str]]:
    rows = []
    for key in map(str, run.data_vars):
        name = str(run[key].attrs.get("signal", ""))
        x = run[key].values[..., run.time.values >= float(run.time[0]) + skip] if name else np.zeros(0)
        for wanted, title, factor, unit in _SIGNALS:
            if name == wanted:
                largest = float(np.abs(x * factor).max())
                mean, std = (
                    number(float(v) if abs(v) > 1e-9 * largest else 0.0, 3) for v in (x.mean() * factor, x.std() * factor)
                )
                rows.append((title, f"mean {mean}, std {std}, largest {number(largest, 3)} {unit}"))
        if name.startswith("thrust of ") and not name.endswith(" to port"):
            if name.endswith(" forward"):
                port = key.removesuffix("_forward") + "_to_port"
                x = np.hypot(x, run[port].values[..., run.time.values >= float(run.time[0]) + skip])
            mean, most = number(x.mean() / 1e3, 3), number(np.abs(x).max() / 1e3, 3)
            rows.append((name.removesuffix(" forward"), f"mean {mean}, largest {most} kN"))
    return rows


def _spread(values: "list[float] | np.ndarray") -> str:
    """The mean, and the range where there is one."""
    x = np.asarray(values, dtype=float)
    x = np.where(np.abs(x) < 1e-9, 0.0, x)
    text = number(float(x.mean()), 3)
    return (
        text
        if len(x) < 2 or number(x.min(), 3) == number(x.max(), 3)
        else f"{text} ({number(x.min(), 3)} to {number(x.max(), 3)})"
    )
