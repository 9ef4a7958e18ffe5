"""Time histories of a run and the spectra of its responses."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.post.plot._style import BLUE, CYAN, GREY, RED, choose, degrees, is_rotation, new_figure, panels, styled

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]


@styled
def motions(
    run: "xr.Dataset",
    *,
    dofs: Sequence[str] | None = None,
    window: tuple[float, float] | None = None,
    save: str | Path | None = None,
) -> Any:
    """Draw wave elevation and motions over time; of several realisations the first in colour, the others behind it.

    Parameters
    ----------
    run : xarray.Dataset
        From :func:`ogilvie.simulate`.
    dofs : sequence of str, optional
    window : (float, float), optional
        First and last time, s.
    save : str or Path, optional
        File to write as well.

    Returns
    -------
    matplotlib.figure.Figure
    """
    names = choose(run.dof.values, dofs, "dofs")
    if window is not None:
        run = run.sel(time=slice(*window))
        if run.sizes["time"] < 2:
            raise InputError(f"plot.motions: a window (first, last) of times inside the run expected, {window} found.")
    rows = len(names) + int("elevation" in run)
    fig = new_figure(0.4 + 0.92 * rows)
    axes = fig.subplots(rows, 1, sharex=True, squeeze=False)[:, 0]
    t = run.time.values
    if "elevation" in run:
        axes[0].plot(t, _first(run.elevation.values, 1), color=CYAN, lw=0.8)
        axes[0].set_ylabel("\u03b6 [m]")
        axes[0].set_title(
            "wave elevation at O" if _count(run) < 2 else f"wave elevation at O, first of {_count(run)} realisations"
        )
    for ax, dof in zip(axes[-len(names) :], names, strict=True):
        values, unit = degrees(dof, run.eta.sel(dof=dof).values)
        for other in values.reshape(-1, len(t))[1:4]:
            ax.plot(t, other, color=GREY, lw=0.4, alpha=0.5)
        ax.plot(t, _first(values, 1), color=BLUE, lw=0.9)
        ax.set_ylabel(f"{dof} [{unit}]")
    axes[-1].set_xlabel("t [s]")
    axes[-1].set_xlim(t[0], t[-1])
    fig.align_ylabels()
    return fig


@styled
def response_spectra(
    run: "xr.Dataset",
    *,
    expected: "xr.DataArray | None" = None,
    skip: float = 0.0,
    dofs: Sequence[str] | None = None,
    save: str | Path | None = None,
) -> Any:
    """Draw the spectra of the motions (Welch's method, mean over realisations) with their confidence intervals.

    Parameters
    ----------
    run : xarray.Dataset
        From :func:`ogilvie.simulate`.
    expected : xarray.DataArray, optional
        Spectra abs(RAO)^2 S of the frequency domain, dims (omega, dof), m2 s/rad or rad2 s/rad, drawn for comparison.
    skip : float
        Start of the part that is analysed, s.
    dofs : sequence of str, optional
    save : str or Path, optional

    Returns
    -------
    matplotlib.figure.Figure
    """
    from ogilvie.post.spectral import spectral_density

    names = choose(run.dof.values, dofs, "dofs")
    found = spectral_density(run, skip=skip)
    columns = min(3, len(names))
    fig = new_figure(0.4 + 1.7 * -(-len(names) // columns))
    for ax, dof in zip(panels(fig, len(names), columns), names, strict=True):
        scale = np.degrees(1.0) ** 2 if is_rotation(dof) else 1.0
        w, S = found.omega.values, found.density.sel(dof=dof).values
        low, high = found.interval.sel(dof=dof).transpose("bound", "omega").values * scale
        ax.fill_between(w, low, high, color=BLUE, alpha=0.18, lw=0, label="95 % interval")
        ax.plot(w, S * scale, color=BLUE, label="time domain")
        if expected is not None and dof in expected.dof.values:
            line = expected.sel(dof=dof)
            ax.plot(line.omega, line.values * scale, color=RED, ls=(0, (4, 2)), lw=1.1, label="frequency domain")
        ax.set_title(dof)
        ax.set_ylabel(f"[{'deg' if is_rotation(dof) else 'm'}\u00b2 s/rad]")
        ax.set_xlabel("\u03c9 [rad/s]")
        ax.set_xlim(0, _upper_end(w, S))
        ax.set_ylim(0)
    entries = {label: line for ax in fig.axes for line, label in zip(*ax.get_legend_handles_labels(), strict=True)}
    fig.legend(entries.values(), entries.keys(), loc="outside upper right", ncols=3)
    return fig


def _upper_end(w: Array, S: Array) -> float:
    energy = np.cumsum(S)
    return float(1.5 * w[np.searchsorted(energy, 0.995 * energy[-1])]) if energy[-1] > 0 else float(w[-1])


def _first(values: Array, keep: int) -> Array:
    """The first realisation of an array whose last axes are data."""
    return values.reshape(-1, *values.shape[values.ndim - keep :])[0]


def _count(run: "xr.Dataset") -> int:
    return int(run.sizes.get("realisation", 1))
