"""Coefficients of the wind force."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ogilvie.errors import InputError
from ogilvie.post.plot._style import CYCLE, GREY, new_figure, panels, styled

if TYPE_CHECKING:
    from ogilvie.loads.wind_coefficients import WindCoefficients

_TITLES = ("CX  surge, forward", "CY  sway, to port", "CK  roll, port side up", "CN  yaw, bow to port")
_FROM = {-90: "port", 0: "astern", 90: "starboard", 180: "ahead", -180: "ahead"}


@styled
def wind_coefficients(coefficients: "WindCoefficients | Sequence[WindCoefficients]", *, save: str | Path | None = None) -> Any:
    """Draw wind coefficients against the direction that the relative wind blows to, and the points they are made from.

    Parameters
    ----------
    coefficients : WindCoefficients or sequence of them
        From :func:`ogilvie.isherwood_wind`, :func:`ogilvie.blendermann_wind` or a table; seven sets at most.
    save : str or Path, optional
        File to write as well.

    Returns
    -------
    matplotlib.figure.Figure
    """
    sets = list(coefficients) if isinstance(coefficients, Sequence) else [coefficients]
    if not 1 <= len(sets) <= len(CYCLE):
        raise InputError(f"plot.wind_coefficients: 1 to {len(CYCLE)} sets of coefficients expected, {len(sets)} found.")
    first = 0 if all(c.symmetry == "xz" for c in sets) else -180
    degrees = np.linspace(first, 180, 181 - first)
    fig = new_figure(4.4)
    axes = panels(fig, 4, 2)
    for colour, one in zip(CYCLE, sets, strict=False):
        curves = one(np.radians(degrees))
        nodes = np.degrees(np.remainder(one.angle + np.pi, 2 * np.pi) - np.pi) if first else np.degrees(one.angle)
        few = len(nodes) <= 73 and len(sets) == 1
        for ax, curve, values in zip(axes, curves.T, (one.CX, one.CY, one.CK, one.CN), strict=True):
            ax.plot(degrees, curve, color=colour, label=one.name)
            if few:
                ax.plot(nodes, values, "o", ms=2.6, color=colour)
    for ax, title in zip(axes, _TITLES, strict=True):
        ax.set_title(title)
        ax.axhline(0.0, color=GREY, lw=0.7, zorder=1)
        ax.set_xlim(first, 180)
        ax.set_xticks(range(first, 181, 45 if first == 0 else 90))
        _name_sides(ax)
    for ax in axes[2:]:
        ax.set_xlabel("relative wind blows to [deg]")
    for ax in axes[::2]:
        ax.set_ylabel("coefficient [1]")
    fig.legend(*axes[0].get_legend_handles_labels(), loc="outside upper right", ncols=min(3, len(sets)))
    return fig


def _name_sides(ax: Any) -> None:
    """Write along the upper edge where the wind comes from."""
    low, high = ax.get_xlim()
    ticks = sorted(b for b in _FROM if low <= b <= high)
    top = ax.secondary_xaxis("top")
    top.set_xticks(ticks, [f"from {_FROM[b]}" if b == ticks[0] else _FROM[b] for b in ticks])
    top.tick_params(length=2, colors=GREY, labelsize=6.5, pad=1)
    top.spines["top"].set_visible(False)
