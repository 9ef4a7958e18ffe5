"""Mean drift over frequency."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ogilvie.errors import InputError
from ogilvie.post.plot._style import (
    FAINT,
    choose,
    is_rotation,
    legend_of_directions,
    new_figure,
    power,
    shades,
    some_of,
    styled,
)

if TYPE_CHECKING:
    import xarray as xr


@styled
def drift(data: "xr.Dataset", *, dofs: Sequence[str] | None = None, save: str | Path | None = None) -> Any:
    """Draw mean drift per square metre of wave amplitude, one line for each direction of the waves.

    Parameters
    ----------
    data : xarray.Dataset
        With mean_drift; at forward speed the surge force, its sign changed, is the added resistance.
    dofs : sequence of str, optional
        By default surge, sway and yaw, as far as they are known, or else what is.
    save : str or Path, optional

    Returns
    -------
    matplotlib.figure.Figure
    """
    if "mean_drift" not in data:
        raise InputError("plot.drift: data with mean_drift expected, none found; compute it with mean_drift.")
    known = [str(d) for d in data.influenced_dof.values if np.isfinite(data.mean_drift.sel(influenced_dof=d)).all()]
    if not known:
        raise InputError("plot.drift: a component known at all frequencies expected, none found.")
    chosen = choose(known, dofs or [d for d in ("surge", "sway", "yaw") if d in known] or known, "plot.drift")
    directions = np.degrees(data.wave_direction.values)
    picked = some_of(len(directions))
    fig = new_figure(2.7)
    colours = shades(len(picked))
    for ax, dof in zip(np.atleast_1d(fig.subplots(1, len(chosen))), chosen, strict=True):
        D = data.mean_drift.sel(influenced_dof=dof).transpose("omega", "wave_direction").values
        factor, prefix = power(D)
        for colour, b in zip(colours, picked, strict=True):
            ax.plot(data.omega, D[:, b] / factor, color=colour, label=f"{directions[b]:.4g}\u00b0")
        ax.axhline(0.0, color=FAINT, lw=0.8, zorder=0)
        ax.set_title(dof)
        ax.set_xlabel("\u03c9 [rad/s]")
        ax.set_ylabel(f"[{prefix}{'N m' if is_rotation(dof) else 'N'}/m\u00b2]")
    legend_of_directions(fig, fig.axes[0], len(picked), len(directions))
    return fig
