"""Retardation functions of the floating hemisphere from damping that ends at Ka = 10, beside the exact ones."""

from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og

TITLE = "Retardation functions of a floating hemisphere from damping cut at Ka = 10"
ABOUT = """The exact added mass and damping of a floating hemisphere (multipole expansion, Hulme 1982) are cut at Ka = 10, as
any panel code would, and turned into retardation functions, which are compared with the exact ones. The continuation of the
damping beyond the cut decides: it is fitted here, while published work leaves it out (Yuan et al. 2017) or takes omega^-2
throughout (Somayajula and Falzarano 2016)."""
NEEDS = ["reference/hemisphere_exact.csv", "reference/hemisphere_K.csv"]
HEIGHT = 5.4

CUT = 10.0
TAILS = ("fit", "omega-3", "omega-2", "none")
COLUMN = {"heave": 1, "surge": 2}  # of the table of exact K
A_INF = {"heave": 0.5, "surge": 4 / np.pi - 1}


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the largest errors for t = 0..40 (a/g)^1/2 and the curves; unit of mass 2/3 pi rho a^3."""
    assert shared is not None
    table = np.genfromtxt(shared / "reference" / "hemisphere_exact.csv", delimiter=",", names=True, skip_header=2)
    exact = np.loadtxt(shared / "reference" / "hemisphere_K.csv", delimiter=",", skiprows=2)
    hydro = cut_data(table)
    K = {tail: og.retardation(hydro, duration=40.0, dt=0.05, tail=tail) for tail in TAILS}
    error = {
        tail: {dof: (k.K[:, i, i] - exact[:, COLUMN[dof]]) / exact[0, COLUMN[dof]] for i, dof in enumerate(k.dofs)}
        for tail, k in K.items()
    }
    checks = [
        check(
            f"largest error of K{n}, {dof}, over K(0)",
            np.abs(error["fit"][dof]).max(),
            0.0,
            0.005,
            note="with no tail {:.3f}, with omega^-2 {:.3f}, with omega^-3 {:.4f}".format(
                *(np.abs(error[tail][dof]).max() for tail in ("none", "omega-2", "omega-3"))
            ),
        )
        for dof, n in (("heave", "33"), ("surge", "11"))
    ]
    checks += [
        check(
            f"infinite added mass of {dof} by Ogilvie's relation",
            K["fit"].A_inf_ogilvie[i, i],
            A_INF[dof],
            1e-4,
            unit="2/3 pi rho a^3",
            note="from added mass and K, not from the limit itself",
        )
        for i, dof in enumerate(K["fit"].dofs)
    ]
    stated = np.diag(K["fit"].tail_error + K["fit"].truncation_error + K["fit"].discretisation_error)
    for i, dof in enumerate(K["fit"].dofs):
        true = np.abs(error["fit"][dof]).max()
        checks.append(
            check(f"true over stated error, {dof}", true / stated[i], 0.5, 0.5, note="the stated error is an upper estimate")
        )
    data = {"t": exact[:, 0], "exact": exact, "K": K["fit"], "error": error, "exponent": np.diag(K["fit"].tail_exponent)}
    return checks, data


def cut_data(table: Any) -> Any:
    """Return the hydrodynamic data set up to the cut."""
    table = table[table["Ka"] <= CUT + 1e-9]
    omega = np.sqrt(table["Ka"])
    A, B = np.zeros((2, len(omega), 2, 2))
    for i, n in enumerate(("11", "33")):
        A[:, i, i], B[:, i, i] = table["mu" + n], table["lam" + n] * omega
    return og.hydro_from_arrays(omega=omega, added_mass=A, radiation_damping=B, dofs=("surge", "heave"), name="hemisphere")


def check(name: str, value: float, reference: float, tolerance: float, *, unit: str = "", note: str = "") -> dict[str, Any]:
    """Return one comparison."""
    source = "exact: Hulme (1982), multipole expansion"
    return {
        "name": name, "value": float(value), "reference": reference, "tolerance": tolerance, "unit": unit, "source": source,
        "note": note,
    }  # fmt: skip


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw K with the exact curve, and the errors of all tails."""
    axes = fig.subplots(2, 2, sharex="row", height_ratios=[1.15, 1.0])
    colours = {"fit": "#2f6db0", "omega-3": "#2e8b57", "omega-2": "#c9971c", "none": "#d1495b"}
    names = {"fit": "fitted", "omega-3": "\u03c9\u207b\u00b3", "omega-2": "\u03c9\u207b\u00b2", "none": "none"}
    for column, (i, dof, n) in enumerate(((1, "heave", "33"), (0, "surge", "11"))):
        ax = axes[0, column]
        ax.plot(data["t"], data["exact"][:, COLUMN[dof]], color="#22262b", lw=3.2, alpha=0.3, label="exact")
        ax.plot(data["t"], data["K"].K[:, i, i], color=colours["fit"], label="from B up to Ka = 10, fitted tail")
        ax.axhline(0, color="#8a8f98", lw=0.6)
        ax.set(title=f"K{n}  {dof}, tail exponent {data['exponent'][i]:.2f}", xlim=(0, 14), xlabel="t (g/a)\u00bd [-]")
        ax = axes[1, column]
        for tail, colour in reversed(colours.items()):
            ax.semilogy(data["t"], np.abs(data["error"][tail][dof]) + 1e-8, color=colour, lw=1.1, label=f"tail {names[tail]}")
        ax.axhline(0.005, color="#8a8f98", lw=0.9, ls=":")
        ax.text(39.5, 0.0056, "0.5 %", ha="right", va="bottom", fontsize=7)
        ax.set(title=f"error of K{n}", xlim=(0, 40), ylim=(1e-7, 1), xlabel="t (g/a)\u00bd [-]")
    axes[0, 0].set_ylabel("K / (\u2154 \u03c0 \u03c1 a\u00b2 g) [-]")
    axes[1, 0].set_ylabel("|error| / K(0) [-]")
    axes[0, 0].legend(loc="upper right")
    axes[1, 1].legend(loc="upper right", ncols=2)
