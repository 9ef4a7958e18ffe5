"""K(t) of the floating hemisphere by four routes from the same data, two of them as published, beside the exact one."""

from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og

TITLE = "Four routes from added mass and damping to retardation functions"
ABOUT = """The exact added mass and damping of a floating hemisphere (Hulme 1982), cut at Ka = 10, become retardation functions
by the cosine form of the damping and by the sine form of the added mass, both integrated exactly piece by piece with a tail,
and by the trapezoid rule and the inverse discrete Fourier transform as Yuan et al. (2017) have them, Eqs. (9) and (8). The
sums lack what lies beyond the data, and the Fourier transform takes half of the jump at t = 0: that is what their errors are
expected to be. Both repeat themselves at 2 pi/d_omega. The two exact forms check each other: their difference is given for
three real vessels, too, where it is a measure of the data (irregular frequencies, damping that ends too high, an infinite added
mass that does not fit)."""
NEEDS = [
    "reference/hemisphere_exact.csv",
    "reference/hemisphere_K.csv",
    *(f"reference/radiation/{name}.npz" for name in ("fpso", "tanker", "semisub")),
]
HEIGHT = 5.4

CUT = 10.0  # Ka
A_INF = np.diag([4 / np.pi - 1, 0.5])
DOFS = ("surge", "heave")
LABELS = {
    "damping": "damping, exact pieces",
    "added_mass": "added mass, exact pieces",
    "trapezoid": "trapezoid, Eq. (9)",
    "ifft": "inverse FFT, Eq. (8)",
}
VESSELS = ("fpso", "tanker", "semisub")


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the errors of the routes for t = 0..40 (a/g)^1/2 and the differences of the exact two for vessels."""
    assert shared is not None
    exact = np.loadtxt(shared / "reference" / "hemisphere_K.csv", delimiter=",", skiprows=2)
    exact = exact[:, [0, 2, 1]]  # t, surge, heave
    hydro = _hemisphere(shared)
    K = {m: og.retardation(hydro, method=m, duration=40.0, dt=0.05) for m in LABELS}
    error = {m: (np.einsum("tii->ti", k.K) - exact[:, 1:]) / exact[0, 1:] for m, k in K.items()}
    beyond = 1 - np.diag(og.retardation(hydro, tail="none", duration=40.0, dt=0.05).K[0]) / exact[0, 1:]
    expected = {"trapezoid": beyond, "ifft": 0.5 + beyond / 2}
    checks = []
    for method in LABELS:
        for i, dof in enumerate(DOFS):
            size = np.abs(error[method][:, i])
            limits = (expected[method][i], 0.005) if method in expected else (0.0, 0.015)
            note = f"after t = 2: {size[exact[:, 0] > 2].max():.2g}"
            checks.append(_check(f"largest error over K(0), {LABELS[method]}, {dof}", size.max(), *limits, note))
    differences = {name: np.diag(og.retardation(_vessel(shared, name)).consistency_error) for name in VESSELS}
    stated = np.diag(K["damping"].consistency_error)
    difference = np.abs(error["damping"] - error["added_mass"]).max(axis=0)
    for i, dof in enumerate(DOFS):
        others = ", ".join(f"{name} {100 * differences[name][2 * i]:.1f} %" for name in VESSELS)
        checks.append(
            _check(f"difference of the two exact forms, {dof}", difference[i], 0.0, 0.015, f"stated {stated[i]:.2g}; {others}")
        )
    return checks, {"t": exact[:, 0], "exact": exact[:, 1:], "K": K, "error": error}


def _hemisphere(shared: Path) -> Any:
    table = np.genfromtxt(shared / "reference" / "hemisphere_exact.csv", delimiter=",", names=True, skip_header=2)
    table = table[table["Ka"] <= CUT + 1e-9]
    omega = np.sqrt(table["Ka"])
    A, B = np.zeros((2, len(omega), 2, 2))
    for i, n in enumerate(("11", "33")):
        A[:, i, i], B[:, i, i] = table["mu" + n], table["lam" + n] * omega
    return og.hydro_from_arrays(
        omega=omega, added_mass=A, radiation_damping=B, added_mass_inf=A_INF, dofs=DOFS, name="hemisphere"
    )


def _vessel(shared: Path, name: str) -> Any:
    d = np.load(shared / "reference" / "radiation" / f"{name}.npz")
    some = d["omega"] > 0
    return og.hydro_from_arrays(
        omega=d["omega"][some],
        added_mass=d["added_mass"][some],
        radiation_damping=d["radiation_damping"][some],
        added_mass_inf=d["added_mass_inf"],
        name=name,
    )


def _check(name: str, value: float, reference: float, tolerance: float, note: str) -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": reference, "tolerance": tolerance,
        "source": "exact: Hulme (1982), multipole expansion", "note": note,
    }  # fmt: skip


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw early K of both degrees of freedom by all routes, and the errors."""
    axes = fig.subplots(2, 2, sharex="row")
    colours = dict(zip(LABELS, ("#2f6db0", "#2e8b57", "#c9971c", "#d1495b"), strict=True))
    for column, dof in enumerate(DOFS):
        ax = axes[0, column]
        ax.plot(data["t"], data["exact"][:, column], color="#22262b", lw=3.2, alpha=0.3, label="exact")
        for method, colour in colours.items():
            ax.plot(data["t"], data["K"][method].K[:, column, column], color=colour, lw=1.1, label=LABELS[method])
        ax.axhline(0, color="#8a8f98", lw=0.6)
        ax.set(title=f"K{'13'[column] * 2}  {dof}", xlim=(0, 4), xlabel="t (g/a)\u00bd [-]")
        ax = axes[1, column]
        for method, colour in reversed(colours.items()):
            ax.semilogy(data["t"], np.abs(data["error"][method][:, column]) + 1e-8, color=colour, lw=1.0)
        ax.set(title=f"error of K{'13'[column] * 2}", xlim=(0, 40), ylim=(1e-7, 1), xlabel="t (g/a)\u00bd [-]")
    axes[0, 0].set_ylabel("K / (\u2154 \u03c0 \u03c1 a\u00b2 g) [-]")
    axes[1, 0].set_ylabel("|error| / K(0) [-]")
    fig.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=5)
