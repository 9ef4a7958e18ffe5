"""The added mass at infinite frequency by three ways, for the hemisphere (exact) and for vessels whose solver gives it."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og

TITLE = "Added mass at infinite frequency: solver, Ogilvie's relation, fit"
ABOUT = """Radiation data without their infinite frequency still contain it: by Ogilvie's relation each frequency gives an
estimate, and a state-space fit has it as one more unknown. Here the limit is hidden from both and compared afterwards with
the exact value of the hemisphere (data cut at Ka = 10) and with WAMIT's for three vessels of the Marine Systems Simulator
(Fossen and Perez, MIT licence). The estimates of the frequencies are averaged by confidence: weight 1/variance from what
another interpolation, another tail and the end of K(t) change, and less weight for outliers. The note tells what the plain
average over all frequencies gives, with K(t) by the trapezoid rule from the damping as it is, which is how the limit is often
found. The semi-submersible's damping ends at 1.4 rad/s, too early to tell its surge to better than some per cent."""
NEEDS = [f"reference/radiation/{name}.npz" for name in ("fpso", "tanker", "semisub")] + ["reference/hemisphere_exact.csv"]
HEIGHT = 4.2

CUT = 10.0  # Ka
EXACT = {"surge": 4 / np.pi - 1, "heave": 0.5}  # of 2/3 pi rho a^3, Hulme (1982)
VESSELS = ("hemisphere", "fpso", "tanker", "semisub")
ALLOWED = {"hemisphere": (0.01, 1.0), "fpso": (2.0, 3.0), "tanker": (2.0, 3.0), "semisub": (5.0, 12.0)}  # %: Ogilvie, fit
WAYS = ("Ogilvie, by confidence", "fit", "plain average")


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the differences from the known limits in per cent, diagonal terms."""
    assert shared is not None
    checks, data = [], {}
    for name in VESSELS:
        hydro = _hemisphere(shared) if name == "hemisphere" else _vessel(shared, name)
        known = np.diag(hydro.added_mass_inf.values)
        hidden = hydro.drop_vars("added_mass_inf")
        K = og.retardation(hidden)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", og.OgilvieWarning)  # couplings that contradict themselves: see passive_memory
            model = og.identify(K)
        found = {w: 100 * (np.diag(x) / known - 1) for w, x in zip(WAYS, (K.A_inf, model.A_inf, plain(hidden)), strict=True)}
        data[name] = {"dofs": K.dofs, "found": found, "consistency": np.diag(og.retardation(hydro).consistency_error)}
        for way, allowed in zip(WAYS, ALLOWED[name], strict=False):
            checks.append(_check(name, way, found, K.dofs, allowed))
    return checks, data


def plain(hydro: Any) -> np.ndarray:
    """Return the average over all frequencies of A + (1/omega) int K sin(omega t) dt, all integrals by the trapezoid rule."""
    omega, A, B = hydro.omega.values, hydro.added_mass.values, hydro.radiation_damping.values
    t = np.linspace(0.0, np.pi / np.median(np.diff(omega)), 1001)
    K = 2 / np.pi * np.trapezoid(B * np.cos(np.outer(t, omega))[:, :, None, None], omega, axis=1)
    sine = np.trapezoid(K[:, None] * np.sin(np.outer(t, omega))[:, :, None, None], t, axis=0)
    return (A + sine / omega[:, None, None]).mean(axis=0)


def _hemisphere(shared: Path) -> Any:
    table = np.genfromtxt(shared / "reference" / "hemisphere_exact.csv", delimiter=",", names=True, skip_header=2)
    table = table[table["Ka"] <= CUT + 1e-9]
    omega = np.sqrt(table["Ka"])
    A, B = np.zeros((2, len(omega), 2, 2))
    for i, n in enumerate(("11", "33")):
        A[:, i, i], B[:, i, i] = table["mu" + n], table["lam" + n] * omega
    dofs = tuple(EXACT)
    return og.hydro_from_arrays(
        omega=omega, added_mass=A, radiation_damping=B, added_mass_inf=np.diag([EXACT[d] for d in dofs]), dofs=dofs
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


def _check(name: str, way: str, found: dict[str, np.ndarray], dofs: tuple[str, ...], allowed: float) -> dict[str, Any]:
    worst = int(np.abs(found[way]).argmax())
    others = np.abs(found[WAYS[2]])
    note = f"in {dofs[worst]}; plain average {others.max():.3g} % in {dofs[others.argmax()]}"
    source = "exact: Hulme (1982)" if name == "hemisphere" else "WAMIT, infinite frequency"
    return {
        "name": f"{name}: largest difference of a diagonal term, {way}", "value": float(np.abs(found[way][worst])),
        "reference": 0.0, "tolerance": allowed, "unit": "%", "source": source, "note": note,
    }  # fmt: skip


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw the differences of all ways, degree of freedom by degree of freedom."""
    axes = fig.subplots(1, len(VESSELS), width_ratios=[1, 2, 2, 2], sharey=True)
    colours = dict(zip(WAYS, ("#2f6db0", "#2e8b57", "#c4c8ce"), strict=True))
    for ax, name in zip(axes, VESSELS, strict=True):
        d = data[name]
        place = np.arange(len(d["dofs"]))
        for k, (way, colour) in enumerate(colours.items()):
            ax.bar(place + 0.27 * (k - 1), np.maximum(np.abs(d["found"][way]), 1.1e-3), 0.25, color=colour, label=way)
        ax.set_xticks(place, d["dofs"], rotation=60)
        ax.set(title=name, yscale="log", ylim=(1e-3, 100))
        ax.grid(axis="x", visible=False)
    axes[0].set_ylabel("|difference from the known limit| [%]")
    fig.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
