"""Wave spectra, wave forces and response amplitude operators."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ogilvie.errors import InputError
from ogilvie.post.plot._style import (
    BLUE,
    GREY,
    INK,
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

    from ogilvie.waves.field import Sea
    from ogilvie.waves.spectrum import Spectrum


@styled
def spectrum(spectrum: "Spectrum | None", *, sea: "Sea | None" = None, save: str | Path | None = None) -> Any:
    """Draw a wave spectrum, the components of a sea as a density, or both.

    Parameters
    ----------
    spectrum : Spectrum or None
        From :func:`ogilvie.jonswap` and its like.
    sea : Sea, optional
        From :func:`ogilvie.irregular`; a regular sea is drawn as lines.
    save : str or Path, optional
        File to write as well.

    Returns
    -------
    matplotlib.figure.Figure
    """
    if spectrum is None and sea is None:
        raise InputError("plot.spectrum: a spectrum, a sea or both expected, neither found.")
    fig = new_figure(2.7)
    spectrum_axes(fig.add_subplot(), spectrum, sea)
    return fig


def spectrum_axes(ax: Any, spectrum: "Spectrum | None", sea: "Sea | None") -> None:
    """Draw a spectrum and the components of a sea."""
    ax.set_ylabel("S(\u03c9) [m\u00b2 s/rad]")
    ax.set_xlabel("\u03c9 [rad/s]")
    top = 0.0
    if spectrum is not None:
        wp = 2 * np.pi / spectrum.tp
        w = np.linspace(0.3 * wp, 3.2 * wp, 500)
        S = np.asarray(spectrum(w))
        top = float(w[-1])
        ax.fill_between(w, S, color=BLUE, alpha=0.12, lw=0)
        ax.plot(w, S, color=BLUE)
        note = f"{spectrum.name}\nHs {spectrum.hs:.3g} m\nTp {spectrum.tp:.3g} s\nTz {spectrum.tz:.3g} s"
        ax.text(0.985, 0.95, note, transform=ax.transAxes, ha="right", va="top", linespacing=1.5)
    if sea is not None:
        last = _components(ax, sea)
        top = top or last
        ax.legend(loc="upper left")
    ax.set_xlim(0, top)
    ax.set_ylim(0)
    _periods(ax)


def _components(ax: Any, sea: "Sea") -> float:
    """Sum the energy a^2/2 of the components (mean over realisations) into bins of frequency."""
    w = sea.omega
    energy = (0.5 * sea.amplitude**2).reshape(-1, len(w)).mean(axis=0)
    if len(w) < 5:
        ax.vlines(w, 0, np.sqrt(2 * energy), color=BLUE, label=sea.label)
        ax.set_ylabel("amplitude [m]")
        return float(1.5 * w.max())
    edges = np.linspace(w.min(), w.max(), max(10, min(80, len(w) // 4)) + 1)
    total, _ = np.histogram(w, bins=edges, weights=energy)
    ax.stairs(total / np.diff(edges), edges, color=GREY, lw=0.9, label=f"{len(w)} components")
    return float(w.max())


def _periods(ax: Any) -> None:
    """Mark wave periods along the upper edge."""
    low, high = ax.get_xlim()
    T = [t for t in (3, 4, 5, 6, 8, 10, 12, 15, 20, 30) if low < 2 * np.pi / t < high]
    room = 0.2 * (high - low) / (ax.figure.get_figwidth() * ax.get_position().width)  # 0.2 in
    kept: list[int] = []
    for t in T:  # leave out what would overlap
        if not kept or abs(2 * np.pi / t - 2 * np.pi / kept[-1]) > room:
            kept.append(t)
    top = ax.secondary_xaxis("top")
    top.set_xticks([2 * np.pi / t for t in kept], [str(t) for t in kept])
    top.tick_params(length=2, colors=GREY, labelsize=6.5, pad=1)
    top.spines["top"].set_visible(False)
    top.set_xlabel("period [s]", fontsize=6.5, color=GREY, labelpad=2)


@styled
def rao(
    response: "xr.DataArray",
    *,
    dofs: Sequence[str] | None = None,
    compare: "xr.DataArray | None" = None,
    save: str | Path | None = None,
) -> Any:
    """Draw response amplitude operators: amplitude, and phase below it, per degree of freedom.

    Parameters
    ----------
    response : xarray.DataArray
        Complex, dims (omega, wave_direction, dof), per metre of wave amplitude; from :func:`ogilvie.rao`.
    dofs : sequence of str, optional
    compare : xarray.DataArray, optional
        A second set, dashed.
    save : str or Path, optional

    Returns
    -------
    matplotlib.figure.Figure
    """
    return _amplitude_phase(response, dofs, compare, _motion_unit)


@styled
def excitation(hydro: "xr.Dataset", *, dofs: Sequence[str] | None = None, save: str | Path | None = None) -> Any:
    """Draw wave excitation: amplitude, and phase below it, per degree of freedom.

    Parameters
    ----------
    hydro : xarray.Dataset
        With excitation_force.
    dofs : sequence of str, optional
    save : str or Path, optional

    Returns
    -------
    matplotlib.figure.Figure
    """
    if "excitation_force" not in hydro:
        raise InputError(
            "plot.excitation: data with excitation_force expected, none found; solve or read them with wave directions."
        )
    return _amplitude_phase(hydro.excitation_force.rename(influenced_dof="dof"), dofs, None, _force_unit)


def _motion_unit(dof: str, values: Any) -> tuple[float, str]:
    """Factor and unit of a response for display."""
    return (np.pi / 180.0, "deg/m") if is_rotation(dof) else (1.0, "m/m")


def _force_unit(dof: str, values: Any) -> tuple[float, str]:
    factor, prefix = power(np.abs(values))
    return factor, prefix + ("N m/m" if is_rotation(dof) else "N/m")


def _amplitude_phase(X: "xr.DataArray", dofs: Sequence[str] | None, compare: "xr.DataArray | None", unit: Any) -> Any:
    names = choose([str(d) for d in X.dof.values], dofs, "dofs")
    X = X.sel(dof=names).transpose("omega", "wave_direction", "dof")
    directions = np.degrees(X.wave_direction.values)
    picked = some_of(len(directions))
    end = _last_of_interest(X.omega.values, np.abs(X.values))
    columns = min(3, len(names))
    rows = -(-len(names) // columns)
    fig = new_figure(0.5 + 2.35 * rows)
    axes = fig.subplots(2 * rows, columns, squeeze=False, sharex=True, height_ratios=[1.0, 0.55] * rows)
    colours = shades(len(picked)) if len(picked) > 1 else [BLUE]
    for k, dof in enumerate(names):
        upper, lower = axes[2 * (k // columns), k % columns], axes[2 * (k // columns) + 1, k % columns]
        values = X.values[:, :, k]
        factor, name = unit(dof, values)
        top = _ceiling(X.omega.values, np.abs(values[:, picked]) / factor)
        for colour, b in zip(colours, picked, strict=True):
            upper.plot(X.omega, np.abs(values[:, b]) / factor, color=colour, label=f"{directions[b]:.4g}\u00b0")
            _phase(lower, X.omega.values, values[:, b], colour, 0.02 * factor * top)
            if compare is not None:
                other = compare.sel(dof=dof).sel(wave_direction=X.wave_direction[b], method="nearest")
                upper.plot(other.omega, np.abs(other.values) / factor, color=INK, ls=(0, (4, 2)), lw=1.0)
        upper.set_title(dof)
        upper.set_ylabel(f"[{name}]")
        upper.set_ylim(0, 1.06 * top)
        lower.set_ylabel("phase [deg]")
        lower.set_ylim(-180, 180)
        lower.set_yticks([-180, 0, 180])
        lower.set_xlim(0, end)
    for ax in axes[-1]:
        ax.set_xlabel("\u03c9 [rad/s]")
    for ax in axes.ravel()[len(names) :]:
        if not ax.has_data():
            ax.remove()
    legend_of_directions(fig, axes[0, 0], len(picked), len(directions))
    return fig


def _phase(ax: Any, omega: Any, values: Any, colour: Any, least: float) -> None:
    """Phase in degrees, broken where it wraps or the data are too coarse, and left out where the amplitude is below `least`."""
    phase = np.where(np.abs(values) > least, np.degrees(np.angle(values)), np.nan)
    jumps = np.flatnonzero(np.abs(np.diff(phase)) > 150) + 1
    ax.plot(np.insert(omega, jumps, np.nan), np.insert(phase, jumps, np.nan), color=colour, lw=1.0)


def _last_of_interest(omega: Any, size: Any) -> float:
    """The frequency above which no curve reaches 3 % of what is drawn, and a margin."""
    top = np.array([_ceiling(omega, size[:, :, k]) for k in range(size.shape[2])])
    alive = np.flatnonzero((np.nan_to_num(size) > 0.03 * top).any(axis=(1, 2)))
    return float(min(omega[-1], 1.15 * omega[alive[-1]])) if len(alive) else float(omega[-1])


def _ceiling(omega: Any, size: Any) -> float:
    """Upper end of an axis for curves over the first axis; a pole at low frequency that dwarfs the rest may run out of it."""
    size = np.nan_to_num(size)
    rest = size[omega > 0.1 * omega[-1]].max(initial=0.0)
    top = size.max(initial=0.0)
    return float((top if top < 3.0 * rest or rest == 0.0 else 1.5 * rest) or 1.0)
