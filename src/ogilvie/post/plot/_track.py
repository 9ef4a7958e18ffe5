"""Where a vessel went, and what steered and drove it."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.post.course import mean_course
from ogilvie.post.plot._motions import _count
from ogilvie.post.plot._signals import control_panels
from ogilvie.post.plot._style import AMBER, BLUE, CYCLE, GREY, INK, RED, new_figure, styled

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

_MOST = 8  # tracks drawn
_SLENDER = 0.12  # breadth over length of a track below which its deviations get axes of their own


@styled
def track(run: "xr.Dataset", *, length: float | None = None, beam: float | None = None, save: str | Path | None = None) -> Any:
    """Draw the track of O in the world, to one scale in both directions, with the vessel's heading along it.

    Parameters
    ----------
    run : xarray.Dataset
        Of large motions, from :func:`ogilvie.simulate`; the first realisation in colour, the others behind it.
    length, beam : float, optional
        Of the vessel, m, which is then drawn to scale where it is large enough to be seen.
    save : str or Path, optional
        File to write as well.

    Returns
    -------
    matplotlib.figure.Figure
    """
    if run.attrs.get("motions") != "large":
        raise InputError("plot.track: a run of large motions expected, one of small motions found.")
    t, eta = run.time.values, _rows(run.eta.values)
    outline = _outline(length or 1.0, beam or 0.15 * (length or 1.0))
    course = mean_course(t, eta[0])
    straight = course.straight and course.speed > 0.0
    across = _along(eta[0], course)[1]
    if straight and np.ptp(across) < _SLENDER * np.ptp(_along(eta[0], course)[0]):
        fig = new_figure(5.2)
        grid = fig.add_gridspec(2, 1, height_ratios=(1.0, 0.55))
        _map(fig.add_subplot(grid[0]), t, eta, outline, length)
        _deviation(fig.add_subplot(grid[1]), t, eta)
    elif length is not None and np.ptp(eta[0, :, :2], axis=0).max() < 0.5 * length:
        fig = new_figure(3.4)
        left, right = fig.subplots(1, 2, width_ratios=(1.25, 1.0))
        _map(left, t, eta, outline, length)
        _lines(right, eta)
        right.set_title("the same, enlarged")
    else:
        fig = new_figure(4.8)
        _map(fig.add_subplot(), t, eta, outline, length)
    if len(eta) > 1:
        note = f"grey: {min(len(eta), _MOST) - 1} more of {_count(run)} realisations"
        fig.axes[-1].set_title(note, loc="right", weight="normal", fontsize=6.5)
    return fig


def _along(eta: Array, course: Any) -> tuple[Array, Array]:
    """Distances along and to port of the mean track."""
    c, s = np.cos(course.direction), np.sin(course.direction)
    off = eta[:, :2] - course.start
    return off @ [c, s], off @ [-s, c]


def _lines(ax: Any, eta: Array) -> None:
    for other in eta[1:_MOST]:
        ax.plot(other[:, 0], other[:, 1], color=GREY, lw=0.5, alpha=0.6)
    ax.plot(eta[0, :, 0], eta[0, :, 1], color=BLUE, lw=1.0)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.12)
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")


def _map(ax: Any, t: Array, eta: Array, outline: Array, length: float | None) -> None:
    """The track with outlines of the vessel along it, enlarged where they would be too small to be seen."""
    _lines(ax, eta)
    x, y, psi = eta[0, :, 0], eta[0, :, 1], eta[0, :, 5]
    span = float(max(np.ptp(eta[:, :, 0]), np.ptp(eta[:, :, 1]), 1e-3))
    size = float(np.ptp(outline[:, 0]))
    factor = max(1.0, 0.06 * span / size) if length else 0.06 * span / size
    still = span < 2.0 * size * factor
    for k in np.unique(np.linspace(0, len(t) - 1, 2 if still else 9).round().astype(int)):
        turned = factor * outline @ np.array([[np.cos(psi[k]), np.sin(psi[k])], [-np.sin(psi[k]), np.cos(psi[k])]])
        ax.fill(*(turned + [x[k], y[k]]).T, facecolor=AMBER, edgecolor=INK, lw=0.6, alpha=0.3 if still else 0.75)
    for k in () if still else (0, len(t) - 1):
        ax.annotate(f"{t[k]:.4g} s", (x[k], y[k]), xytext=(4, 9), textcoords="offset points", fontsize=7)
    scale = "vessel to scale" if length and factor == 1.0 else f"vessel enlarged {factor:.2g} times" if length else ""
    ax.set_title("track of O" + (f", {scale}" if scale else ""))


def _outline(length: float, beam: float) -> Array:
    """A ship seen from above, bow towards +x."""
    x = np.concatenate([[-0.5, -0.47], 0.15 + 0.35 * np.sin(np.linspace(0.0, 0.5 * np.pi, 25))])
    y = np.where(x < 0.15, 1.0, np.sqrt(np.maximum(1.0 - ((x - 0.15) / 0.35) ** 2, 0.0)))
    y[0] = 0.8
    side = np.stack([length * x, 0.5 * beam * y], axis=1)
    return np.concatenate([side, side[::-1] * [1.0, -1.0]])


def _deviation(ax: Any, t: Array, eta: Array) -> None:
    course = mean_course(t, eta[0])
    for k, one in reversed(list(enumerate(eta[:_MOST]))):
        along, across = _along(one, course)
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
    panels = control_panels(run)
    fig = new_figure(0.5 + 1.25 * len(panels))
    axes = fig.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    for ax, panel in zip(axes, panels, strict=True):
        ax.set_title(panel.title, weight="normal", fontsize=7.5, pad=3)
        ax.set_ylabel(f"[{panel.unit}]")
        for colour, (label, values, reference) in zip(_colours(len(panel.curves)), panel.curves, strict=True):
            style: Any = {"color": RED, "lw": 1.0, "ls": (0, (4, 2))} if reference else {"color": colour, "lw": 0.9}
            ax.plot(run.time, values, label=label, **style)
        if len(panel.curves) > 1:
            ax.legend(loc="upper right", ncols=4, fontsize=6.5, bbox_to_anchor=(1.0, 1.24), borderpad=0.0)
    axes[-1].set_xlabel("t [s]")
    axes[-1].set_xlim(float(run.time[0]), float(run.time[-1]))
    fig.align_ylabels()
    return fig


def _colours(count: int) -> list[str]:
    palette = [c for c in CYCLE if c != RED]
    return [palette[i % len(palette)] for i in range(count)]


def _rows(values: Array) -> Array:
    """Realisations (r, n, 6)."""
    return values.reshape(-1, *values.shape[-2:])
