"""The lines of a catenary mooring."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.post.plot._style import AMBER, BLUE, CYAN, CYCLE, GREY, INK, new_figure, styled

if TYPE_CHECKING:
    from ogilvie.loads.mooring_lines import CatenaryMooring

Array = NDArray[np.float64]

_BOTTOM, _DECK = "#c9b79c", "#e9edf2"


@styled
def mooring(lines: "CatenaryMooring", *, eta: ArrayLike | None = None, save: str | Path | None = None) -> Any:
    """Draw the lines of a mooring: plan, side view along each line, and the tensions at fairlead and anchor.

    Parameters
    ----------
    lines : CatenaryMooring
    eta : (6,) array, optional
        Pose of the ship, m and rad; lines at zero pose are drawn thin behind it.
    save : str or Path, optional
        File to write as well.

    Returns
    -------
    matplotlib.figure.Figure
    """
    fig = new_figure(4.6)
    grid = fig.add_gridspec(2, 2, width_ratios=(1.0, 1.5), height_ratios=(1.0, 0.55))
    plan, side = fig.add_subplot(grid[:, 0]), fig.add_subplot(grid[0, 1])
    shapes = lines.shapes(eta, points=301)
    rest = lines.shapes(points=301) if eta is not None else None
    _plan(plan, shapes, rest)
    _side(side, lines, shapes, rest)
    _tensions(fig.add_subplot(grid[1, 1]), lines, eta)
    return fig


def _plan(ax: Any, shapes: list[Array], rest: list[Array] | None) -> None:
    for other in rest or []:
        ax.plot(other[:, 0], other[:, 1], color=GREY, lw=0.6)
    for i, curve in enumerate(shapes):
        ax.plot(curve[:, 0], curve[:, 1], color=_colour(i))
        ax.plot(*curve[0, :2], "s", color=INK, ms=3.5)
        ax.plot(*curve[-1, :2], "o", color=_colour(i), ms=3.5)
        ax.annotate(str(i), curve[0, :2], textcoords="offset points", xytext=(5, 4), fontsize=7.5)
    ends = np.array([curve[-1, :2] for curve in shapes])
    if len(ends) > 2:
        order = np.argsort(np.arctan2(*(ends - ends.mean(axis=0)).T[::-1]))
        ax.fill(*ends[order].T, color=_DECK, lw=0.8, ec=INK, zorder=0)
    ax.set_aspect("equal")
    ax.set_anchor("N")
    ax.set_title("plan: anchors square, fairleads round")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")


def _side(ax: Any, lines: "CatenaryMooring", shapes: list[Array], rest: list[Array] | None) -> None:
    for curve in rest or []:
        ax.plot(_along(curve), curve[:, 2], color=GREY, lw=0.6)
    for i, curve in enumerate(shapes):
        ax.plot(_along(curve), curve[:, 2], color=_colour(i), label=f"{i}")
        ax.plot(_along(curve)[-1], curve[-1, 2], "o", color=_colour(i), ms=3.5)
    ax.axhline(0.0, color=CYAN, lw=0.9)
    for level in sorted({float(line.anchor[2]) for line in lines.lines if line.grounded}):
        ax.axhline(level, color=_BOTTOM, lw=2.0, zorder=0)
    ax.set_title("along each line, from its anchor")
    ax.set_xlabel("horizontal distance from the anchor [m]")
    ax.set_ylabel("z [m]")


def _tensions(ax: Any, lines: "CatenaryMooring", eta: ArrayLike | None) -> None:
    T = lines.tensions(eta) / 1e3
    i = np.arange(len(T))
    ax.bar(i - 0.18, T[:, 0], 0.34, color=BLUE, label="fairlead")
    ax.bar(i + 0.18, T[:, 1], 0.34, color=AMBER, label="anchor")
    ax.set_xticks(i, [f"{k}: {kind}" for k, kind in enumerate(lines.kinds(eta))] if len(T) < 7 else [str(k) for k in i])
    ax.grid(False, axis="x")
    ax.set_ylabel("tension [kN]")
    ax.set_xlabel("line")
    ax.legend(ncols=2, loc="lower right", bbox_to_anchor=(1.0, 0.98), borderpad=0.0)


def _along(curve: Array) -> Array:
    return np.asarray(np.hypot(*(curve[:, :2] - curve[0, :2]).T))


def _colour(i: int) -> str:
    return CYCLE[i % len(CYCLE)]
