"""Where a vessel went, and what steered and drove it."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.post.course import mean_course
from ogilvie.post.plot._motions import _count
from ogilvie.post.plot._style import AMBER, BLUE, CYCLE, GREY, INK, RED, new_figure, power, styled

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

_KNOT = 1852.0 / 3600.0
_SLENDER = 0.12  # breadth over length of a track below which its deviations get axes of their own


@styled
def track(run: "xr.Dataset", *, length: float | None = None, save: str | Path | None = None) -> Any:
    """Draw the track of O in the world, to one scale in both directions, with the vessel's heading along it.

    Parameters
    ----------
    run : xarray.Dataset
        Of large motions, from :func:`ogilvie.simulate`; the first realisation in colour, the others behind it.
    length : float, optional
        Of the vessel, m, which is then drawn to scale where it is large enough to be seen.
    save : str or Path, optional
        File to write as well.

    Returns
    -------
    matplotlib.figure.Figure
    """
    if run.attrs.get("motions") != "large":
        raise InputError("plot.track: a run of large motions expected, one of small motions found.")
    eta = _rows(run.eta.values)
    low, high = (f(eta[:, :, :2].reshape(-1, 2), axis=0) for f in (np.nanmin, np.nanmax))
    course = mean_course(run.time.values, eta[0])
    ratio = float(np.min(high - low) / max(np.max(high - low), 1e-9))
    slender = ratio < _SLENDER or (course.straight and course.speed > 0.0 and _breadth(run.time.values, eta[0]) < _SLENDER)
    fig = new_figure(5.2 if slender else 4.6)
    grid = fig.add_gridspec(2, 1, height_ratios=(1.0, 0.55)) if slender else fig.add_gridspec(1, 1)
    _map(fig.add_subplot(grid[0]), run, eta, length)
    if slender:
        _deviation(fig.add_subplot(grid[1]), run, eta)
    return fig


def _breadth(t: Array, eta: Array) -> float:
    """Breadth over length of a track about its straight mean."""
    along, across = _along(t, eta, mean_course(t, eta))
    return float(np.ptp(across) / max(np.ptp(along), 1e-9))


def _along(t: Array, eta: Array, course: Any) -> tuple[Array, Array]:
    c, s = np.cos(course.direction), np.sin(course.direction)
    off = eta[:, :2] - course.start
    return off @ [c, s], off @ [-s, c]


def _map(ax: Any, run: "xr.Dataset", eta: Array, length: float | None) -> None:
    for other in eta[1:8]:
        ax.plot(other[:, 0], other[:, 1], color=GREY, lw=0.6, alpha=0.6)
    x, y, psi, t = eta[0, :, 0], eta[0, :, 1], eta[0, :, 5], run.time.values
    ax.plot(x, y, color=BLUE, lw=1.2)
    span = float(max(np.ptp(eta[:, :, 0]), np.ptp(eta[:, :, 1]), 1.0 if length is None else 1.6 * length))
    shown = max(length or 0.0, 0.06 * span)
    to_scale = length is not None and shown <= 1.0001 * length
    marks = np.linspace(0, len(t) - 1, 2 if to_scale and span < 4 * shown else 9).round().astype(int)
    for k in np.unique(marks):
        outline = _outline(shown) @ np.array([[np.cos(psi[k]), np.sin(psi[k])], [-np.sin(psi[k]), np.cos(psi[k])]])
        ax.fill(*(outline + [x[k], y[k]]).T, facecolor=AMBER, edgecolor=INK, lw=0.6, alpha=0.35 if to_scale else 0.75)
    for k in (0, len(t) - 1):
        ax.annotate(f"{t[k]:.4g} s", (x[k], y[k]), xytext=(4, 9), textcoords="offset points", fontsize=7)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.12)
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    size = "to scale" if to_scale else f"{shown / length:.2g} times its size" if length else "not to scale"
    more = f"; grey: {min(_count(run), 8) - 1} more realisations" if _count(run) > 1 else ""
    ax.set_title(f"track of O, vessel {size}{more}")


def _outline(length: float) -> Array:
    """A ship seen from above, bow towards +x."""
    half = np.array([(-0.5, 0.055), (-0.47, 0.07), (0.25, 0.07), (0.4, 0.045), (0.5, 0.0)])
    return length * np.concatenate([half, half[::-1] * [1.0, -1.0]])


def _deviation(ax: Any, run: "xr.Dataset", eta: Array) -> None:
    t = run.time.values
    course = mean_course(t, eta[0])
    for k, one in reversed(list(enumerate(eta[:8]))):
        along, across = _along(t, one, course)
        ax.plot(along, across, color=BLUE if k == 0 else GREY, lw=1.1 if k == 0 else 0.6)
    ax.set_xlabel(f"distance along the mean track, towards {np.degrees(course.direction):.1f} deg [m]")
    ax.set_ylabel("to port of it [m]")
    ax.set_title("the same, deviation enlarged")


@styled
def controls(run: "xr.Dataset", *, save: str | Path | None = None) -> Any:
    """Draw heading and speed over time, with what was asked of them, rudder angle and thrusts; of the first realisation.

    Parameters
    ----------
    run : xarray.Dataset
        Of large motions, from :func:`ogilvie.simulate`.
    save : str or Path, optional
        File to write as well.

    Returns
    -------
    matplotlib.figure.Figure
    """
    if run.attrs.get("motions") != "large":
        raise InputError("plot.controls: a run of large motions expected, one of small motions found.")
    panels = _panels(run)
    fig = new_figure(0.5 + 1.25 * len(panels))
    axes = fig.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    for ax, (title, unit, curves) in zip(axes, panels, strict=True):
        ax.set_title(title, weight="normal", fontsize=7.5, pad=3)
        ax.set_ylabel(f"[{unit}]")
        for colour, (label, values, reference) in zip(_colours(curves), curves, strict=True):
            style = {"color": RED, "lw": 1.0, "ls": (0, (4, 2))} if reference else {"color": colour, "lw": 0.9}
            ax.plot(run.time, values, label=label, **style)
        if len(curves) > 1:
            ax.legend(loc="upper right", ncols=len(curves), fontsize=6.5, bbox_to_anchor=(1.0, 1.22), borderpad=0.0)
    axes[-1].set_xlabel("t [s]")
    axes[-1].set_xlim(float(run.time[0]), float(run.time[-1]))
    fig.align_ylabels()
    return fig


def _colours(curves: list[Any]) -> list[str]:
    palette = [c for c in CYCLE if c != RED]
    return [palette[i % len(palette)] for i in range(len(curves))]


def _panels(run: "xr.Dataset") -> list[tuple[str, str, list[tuple[str, Array, bool]]]]:
    """Title, unit and curves (label, values, whether a reference) of each panel."""
    eta, nu = _rows(run.eta.values)[0], _rows(run.nu.values)[0] if "nu" in run else None
    signals = {str(key): np.degrees(v) if v_unit == "rad" else v for key, v, v_unit in _signals(run)}
    heading: list[tuple[str, Array, bool]] = [("heading", np.degrees(np.unwrap(eta[:, 5])), False)]
    panels = [("heading", "deg", heading)]
    if nu is not None:
        panels.append(("speed ahead, over ground", "kn", [("over ground", nu[:, 0] / _KNOT, False)]))
    thrusts: list[tuple[str, Array, bool]] = []
    for key, values in signals.items():
        owner, _, name = key.partition("_")
        if name in ("heading reference", "reference heading"):
            heading.append(("reference", _near(values, heading[0][1]), True))
        elif name == "speed reference" and nu is not None:
            panels[1] = ("speed ahead", "kn", [*panels[1][2], ("reference of the control", values / _KNOT, True)])
        elif name == "speed measured" and nu is not None:
            panels[1][2].append(("measured by the control", values / _KNOT, False))
        elif name == "rudder angle":
            panels.append(("rudder angle, positive turns to port", "deg", [("rudder", values, False)]))
        elif name == "thrust" or name.startswith("thrust of "):
            thrusts.append((name.removeprefix("thrust of "), values, False))
        elif name in ("reference x", "reference y"):
            place = eta[:, 0 if name.endswith("x") else 1]
            axis = name[-1]
            panels.append((axis, "m", [(axis, place, False), ("reference", values, True)]))
    for part in (thrusts[i : i + 4] for i in range(0, len(thrusts), 4)):
        factor, prefix = power(np.concatenate([v for _, v, _ in part]))
        title = "thrust" if len(part) == 1 and part[0][0] == "thrust" else "thrusts"
        panels.append((title, f"{prefix}N", [(label, v / factor, r) for label, v, r in part]))
    return panels


def _near(reference: Array, heading: Array) -> Array:
    """A reference angle (deg), unwrapped, in the turn of the heading."""
    line = np.degrees(np.unwrap(np.radians(reference)))
    return line + 360.0 * np.round((heading[0] - line[0]) / 360.0)


def _signals(run: "xr.Dataset") -> list[tuple[str, Array, str]]:
    found = []
    for key in run.data_vars:
        one = run[key]
        if set(one.dims) <= {"realisation", "time"} and str(key) != "elevation":
            values = one.isel(realisation=0) if "realisation" in one.dims else one
            found.append((str(key), values.values, str(one.attrs.get("units", ""))))
    return found


def _rows(values: Array) -> Array:
    """Realisations (r, n, 6)."""
    return values.reshape(-1, *values.shape[-2:])
