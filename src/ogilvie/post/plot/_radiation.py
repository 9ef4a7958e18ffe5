"""Added mass, damping and retardation functions, with the fit of a fluid-memory model beside them."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ogilvie.errors import InputError
from ogilvie.post.plot._style import BLUE, GREY, RED, matrix_unit, new_figure, panels, power, styled, subscript

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.memory.retardation import Retardation
    from ogilvie.memory.statespace import StateSpace

Entries = Sequence[tuple[str, str]]


@styled
def coefficients(
    hydro: "xr.Dataset", *, ssm: "StateSpace | None" = None, entries: Entries | None = None, save: str | Path | None = None
) -> Any:
    """Draw added mass and radiation damping over frequency, one row per entry.

    Parameters
    ----------
    hydro : xarray.Dataset
        See :mod:`ogilvie.hydro.schema`.
    ssm : StateSpace, optional
        A fluid-memory model whose own A and B are drawn over the data.
    entries : sequence of (str, str), optional
        (force, motion) by name; the diagonal by default.
    save : str or Path, optional
        File to write as well.

    Returns
    -------
    matplotlib.figure.Figure
    """
    names = [str(d) for d in hydro.influenced_dof.values]
    chosen = _entries(names, entries)
    pairs = -(-len(chosen) // 2) if len(chosen) > 3 else len(chosen)
    columns = 4 if len(chosen) > 3 else 2
    fig = new_figure(0.6 + 1.55 * pairs)
    axes = fig.subplots(pairs, columns, squeeze=False, sharex=True)
    model = _model(hydro, ssm) if ssm is not None else None
    for k, (i, j) in enumerate(chosen):
        row, side = k % pairs, 2 * (k // pairs)
        _added_mass(axes[row, side], hydro, names, i, j, model)
        _damping(axes[row, side + 1], hydro, names, i, j, model)
    for ax in axes.ravel():
        if not ax.has_data():
            ax.remove()
    for ax in axes[-1]:
        ax.set_xlabel("\u03c9 [rad/s]")
    handles = [h for h in axes[0, 0].get_lines() if not str(h.get_label()).startswith("_")]
    fig.legend(handles=handles, loc="outside upper right", ncols=len(handles))
    return fig


@styled
def retardation(
    K: "Retardation", ssm: "StateSpace | None" = None, *, entries: Entries | None = None, save: str | Path | None = None
) -> Any:
    """Draw retardation functions over time.

    Parameters
    ----------
    K : Retardation
    ssm : StateSpace, optional
        A fluid-memory model; its C exp(A t) B is drawn over K, with the coefficient of determination.
    entries : sequence of (str, str), optional
        (force, motion) by name; the diagonal and the couplings that are not zero by symmetry by default.
    save : str or Path, optional

    Returns
    -------
    matplotlib.figure.Figure
    """
    names = list(K.dofs)
    chosen = _entries(names, entries) if entries is not None else _lively(K)
    columns = min(3, len(chosen))
    rows = -(-len(chosen) // columns)
    fig = new_figure(0.5 + 1.5 * rows)
    fit = ssm.impulse(K.t) if ssm is not None else None
    for ax, (i, j) in zip(panels(fig, len(chosen), columns), chosen, strict=True):
        factor, prefix = power(K.K[:, i, j])
        ax.plot(K.t, K.K[:, i, j] / factor, color=BLUE, label="K from damping")
        if fit is not None and ssm is not None:
            ax.plot(K.t, fit[:, i, j] / factor, color=RED, ls=(0, (4, 2)), lw=1.1, label="state space")
            if ssm.r2 is not None and np.isfinite(ssm.r2[i, j]):
                ax.text(0.97, 0.93, f"R\u00b2 {ssm.r2[i, j]:.4f}", transform=ax.transAxes, ha="right", va="top", fontsize=7.5)
        ax.axhline(0, color=GREY, lw=0.6)
        ax.set_title(f"K{subscript(names[i], names[j])}  {_label(names[i], names[j])}")
        ax.set_ylabel(f"[{prefix}{matrix_unit(names[i], names[j], 'K')}]")
        ax.set_xlim(0, K.t[-1])
    for ax in fig.axes[-columns:]:
        ax.set_xlabel("t [s]")
    fig.legend(*fig.axes[0].get_legend_handles_labels(), loc="outside upper right", ncols=2)
    return fig


def _added_mass(ax: Any, hydro: "xr.Dataset", names: list[str], i: int, j: int, model: Any) -> None:
    A = hydro.added_mass.values[:, i, j]
    factor, prefix = power(A)
    ax.plot(hydro.omega, A / factor, color=BLUE, label="data")
    if model is not None:
        ax.plot(model[0], model[1][:, i, j] / factor, color=RED, ls=(0, (4, 2)), lw=1.1, label="state space")
    if "added_mass_inf" in hydro:
        ax.axhline(hydro.added_mass_inf.values[i, j] / factor, color=GREY, lw=0.9, ls=":", label="A(\u221e)")
    if "added_mass_zero" in hydro:
        zero = hydro.added_mass_zero.values[i, j] / factor
        ax.plot(0, zero, "o", ms=3.5, color=BLUE, mfc="white", label="A(0)", clip_on=False)
    _frame(ax, "A", names[i], names[j], prefix, hydro)


def _damping(ax: Any, hydro: "xr.Dataset", names: list[str], i: int, j: int, model: Any) -> None:
    B = hydro.radiation_damping.values[:, i, j]
    factor, prefix = power(B)
    ax.plot(hydro.omega, B / factor, color=BLUE)
    if model is not None:
        ax.plot(model[0], model[2][:, i, j] / factor, color=RED, ls=(0, (4, 2)), lw=1.1)
    if i == j:
        ax.axhline(0, color=GREY, lw=0.6)
    _frame(ax, "B", names[i], names[j], prefix, hydro)


def _frame(ax: Any, letter: str, row: str, column: str, prefix: str, hydro: "xr.Dataset") -> None:
    ax.set_title(f"{letter}{subscript(row, column)}  {_label(row, column)}")
    ax.set_ylabel(f"[{prefix}{matrix_unit(row, column, letter)}]")
    ax.set_xlim(0, float(hydro.omega[-1]))


def _model(hydro: "xr.Dataset", ssm: "StateSpace") -> tuple[Any, Any, Any]:
    """The model's own added mass and damping, A = A_inf + Im K_hat / omega and B = Re K_hat."""
    w = np.linspace(0.25 * float(hydro.omega[0]), float(hydro.omega[-1]), 300)
    K_hat = ssm.transfer(w)
    A_inf = ssm.A_inf if ssm.A_inf is not None else hydro.get("added_mass_inf")
    if A_inf is None:
        raise InputError("plot.coefficients: A_inf expected in the model or in the data, none found; identify a model first.")
    return w, np.asarray(A_inf) + K_hat.imag / w[:, None, None], K_hat.real


def _entries(names: list[str], entries: Entries | None) -> list[tuple[int, int]]:
    if entries is None:
        return [(k, k) for k in range(len(names))]
    unknown = {n for pair in entries for n in pair} - set(names)
    if unknown:
        raise InputError(f"entries: pairs of {', '.join(names)} expected, {', '.join(sorted(unknown))} found.")
    return [(names.index(a), names.index(b)) for a, b in entries]


def _lively(K: "Retardation") -> list[tuple[int, int]]:
    """The diagonal, then the couplings (upper triangle) that are not negligible beside it."""
    size = np.abs(K.K).max(axis=0)
    scale = np.sqrt(np.outer(size.diagonal(), size.diagonal()))
    couplings = np.argwhere(np.triu((size > 0.01 * scale) & (scale > 0), k=1))
    return [(k, k) for k in range(len(K.dofs))] + [(int(i), int(j)) for i, j in couplings]


def _label(row: str, column: str) -> str:
    return row if row == column else f"{row}\u2013{column}"
