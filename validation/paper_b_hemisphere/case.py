"""The floating hemisphere by the plain hybrid method of Guo et al. on a mesh of their size."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ogilvie.bem.plain import PlainHybrid, plain_hybrid
from ogilvie.bem.plain_boundary import FlatBoundary, FlatPanels, hemisphere_boundary

TITLE = "Hybrid time-domain method: retardation function, added mass and damping of a floating hemisphere"
ABOUT = """Y. Guo, W. Wang, T. Chen, X. Tong, Application of symmetry properties on the hybrid method in time domain: a
hemisphere of radius 1 m within a control hemisphere of 5 m, 260 flat panels on the hull, 400 on the free surface, 300 on the
control surface, the transient Green function outside. The paper shows figures beside an analytical solution and gives no
numbers; here the exact solution is the measure. What remains late (t > 20) has the frequencies of the control surface's
irregular modes, K Rc = 2.6, 5.6, 8.8 ...: a property of the method, and the reason for an outer domain without Green function.
The paper does not say how it integrates the Green function over a panel: here by 3 x 3 points, with results of its value at the
centroid in the notes."""
NEEDS: list[str] = []
HEIGHT = 6.0

VOLUME = 2.0 / 3.0 * np.pi
UNITS = {"rho": 1.0, "g": 1.0}
DURATION, CUT, DT = 40.0, 20.0, 0.1
HULME, SOURCE = "Hulme (1982)", "exact: Hulme (1982), multipole expansion"
#: Ka, added mass and damping in heave of A. Hulme, Journal of Fluid Mechanics 121 (1982) 443-463.
TABLE = np.array(
    [
        [0.1, 0.8627, 0.1816],
        [0.2, 0.7938, 0.2793],
        [0.4, 0.6452, 0.3410],
        [0.6, 0.5381, 0.3271],
        [0.8, 0.4698, 0.2899],
        [1.0, 0.4284, 0.2484],
        [1.4, 0.3924, 0.1756],
        [2.0, 0.3884, 0.1031],
        [3.0, 0.4111, 0.0452],
        [4.0, 0.4322, 0.0219],
    ]
)


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the checks and the curves, in units of rho, g, radius and 2/3 pi rho r^3."""
    boundary = hemisphere_boundary(1.0, 5.0, around=20, rings=(13, 20, 15))
    result = plain_hybrid(boundary, duration=DURATION, dt=DT, dofs=("surge", "heave"), **UNITS)
    centroid = plain_hybrid(boundary, duration=DURATION, dt=DT, dofs=("surge", "heave"), points=1, **UNITS)
    mass, start = np.diag(result.A_inf) / VOLUME, np.diagonal(result.K[0]) / VOLUME
    unit = "2/3 pi rho r^3"
    checks = [
        check("infinite added mass, heave", mass[1], 0.5, 0.005, unit, "exact"),
        check("infinite added mass, surge", mass[0], 4.0 / np.pi - 1.0, 0.01, unit, "exact", "a vertical wall meets phi = 0"),
        check("K33(0)", start[1], 3.0 / 16.0, 0.001, unit + " g/r", "exact"),
        check("K11(0)", start[0], 0.547683, 0.028, unit + " g/r", SOURCE, "psi_z is singular at the waterline"),
    ]
    for column, name, allowed in ((1, "A33", 2.0), (2, "B33", 5.0)):
        found = [
            coefficients(r, TABLE[:, 0], until)[column - 1] - TABLE[:, column]
            for r, until in ((result, CUT), (result, 12.0), (result, DURATION), (centroid, CUT))
        ]
        others = [100.0 * np.abs(e).max() / TABLE[:, column].max() for e in found[1:]]
        note = "K to t = 12: {:.1f} %, to t = 40: {:.1f} %; to t = 20 with the Green function at the centroids: {:.1f} %"
        title = f"{name}, Ka 0.1 to 4, from K to t = {CUT:g}"
        checks.append(worst(title, found[0], TABLE[:, column].max(), allowed, HULME, note=note.format(*others)))
    exact = None
    if shared is not None and (shared / "reference" / "hemisphere_K.csv").exists():
        exact = np.loadtxt(shared / "reference" / "hemisphere_K.csv", delimiter=",", skiprows=2)
        checks += against_exact(result, centroid, exact)
    saving, notes = savings(boundary)
    checks.append(check("storage without symmetry over that with two planes", saving, 16.0, 0.01, "", "16 = 4^2", notes))
    dense = np.linspace(0.05, 4.0, 160)
    data = {"result": result, "centroid": centroid, "exact": exact, "Ka": dense, "AB": coefficients(result, dense)}
    return checks, data


def coefficients(result: PlainHybrid, Ka: np.ndarray, until: float = CUT) -> tuple[np.ndarray, np.ndarray]:
    """Return added mass and damping in heave over 2/3 pi rho r^3 and, the damping, omega, from K up to a time."""
    omega, n = np.sqrt(Ka), round(until / DT) + 1
    K_hat = replace(result, t=result.t[:n], K=result.K[:n]).retardation().transform(omega)[:, 1, 1] / VOLUME
    return result.A_inf[1, 1] / VOLUME + K_hat.imag / omega, K_hat.real / omega


def against_exact(result: PlainHybrid, centroid: PlainHybrid, exact: np.ndarray) -> list[dict[str, Any]]:
    """Return the largest differences of K in windows of time."""
    checks = []
    for i, column, name, allowed in ((1, 1, "K33", (1.5, 3.0, 5.0)), (0, 2, "K11", (5.0, 8.0, 20.0))):
        for (low, high), limit in zip(((0.0, 12.0), (12.0, 20.0), (20.0, 40.0)), allowed, strict=True):
            pick = (result.t >= low) & (result.t <= high)
            wanted = np.interp(result.t[pick], exact[:, 0], exact[:, column])
            error, other = (r.K[pick, i, i] / VOLUME - wanted for r in (result, centroid))
            note = f"Green function at the centroids: {100.0 * np.abs(other).max() / exact[0, column]:.1f} %"
            checks.append(worst(f"{name}, t {low:g} to {high:g}", error, exact[0, column], limit, SOURCE, "K(0)", note))
    return checks


def savings(boundary: FlatBoundary) -> tuple[float, str]:
    """Return the ratio of storage, and times of heave to t = 20 with the Green function at the centroids, in words."""
    whole = boundary.expanded()
    half = [FlatPanels(p.corners[p.centers[:, 1] > 0.0], symmetry="xz") for p in (whole.hull, whole.free, whole.control)]
    found = {}
    for name, b in (("two planes", boundary), ("one plane", FlatBoundary(*half)), ("none", whole)):
        r = plain_hybrid(b, duration=20.0, dt=DT, dofs=("heave",), points=1, **UNITS)
        found[name] = (sum(r.storage.values()), sum(r.seconds.values()))
    words = "; ".join(f"{name}: {size / 1e6:.0f} MB, {seconds:.1f} s" for name, (size, seconds) in found.items())
    return found["none"][0] / found["two planes"][0], "heave to t = 20: " + words


def worst(
    name: str, error: np.ndarray, scale: float, allowed: float, source: str, what: str = "the largest value", note: str = ""
) -> dict[str, Any]:
    """Return the largest difference in percent as a comparison with zero."""
    value = 100.0 * float(error[np.abs(error).argmax()]) / scale
    return check(name, value, 0.0, allowed, f"% of {what}", source, note)


def check(
    name: str, value: float, reference: float, tolerance: float, unit: str = "", source: str = "", note: str = ""
) -> dict[str, Any]:
    """Return one comparison."""
    return {
        "name": name, "value": float(value), "reference": reference, "tolerance": tolerance, "unit": unit, "source": source,
        "note": note,
    }  # fmt: skip


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw K33 and its error, A33 and B33."""
    (ax_K, ax_A), (ax_error, ax_B) = fig.subplots(2, 2)
    result, exact = data["result"], data["exact"]
    K = {"3 x 3 points": result.K[:, 1, 1] / VOLUME, "centroids": data["centroid"].K[:, 1, 1] / VOLUME}
    colours = {"3 x 3 points": "#2f6db0", "centroids": "#c9971c"}
    if exact is not None:
        ax_K.plot(exact[:, 0], exact[:, 1], color="#22262b", lw=3.2, alpha=0.3, label="exact")
        for name, k in K.items():
            error = 100.0 * (k - np.interp(result.t, exact[:, 0], exact[:, 1])) / exact[0, 1]
            ax_error.plot(result.t, error, color=colours[name], lw=1, label=name)
    ax_K.plot(result.t, K["3 x 3 points"], color=colours["3 x 3 points"], lw=1.2, label="hybrid, 960 panels")
    ax_K.set(title="K33", xlim=(0, 20), xlabel="t (g/r)\u00bd [-]", ylabel="K / (\u2154 \u03c0 \u03c1 r\u00b2 g) [-]")
    ax_error.set(title="error of K33", xlim=(0, 40), xlabel="t (g/r)\u00bd [-]", ylabel="% of K(0)")
    for ax, found, column, name in ((ax_A, data["AB"][0], 1, "A33"), (ax_B, data["AB"][1], 2, "B33")):
        ax.plot(TABLE[:, 0], TABLE[:, column], "o", color="#22262b", ms=4, mfc="none", label="Hulme (1982)")
        ax.plot(data["Ka"], found, color="#2f6db0", lw=1.2, label="hybrid, K to t = 20")
        ax.set(title=name, xlim=(0, 4), ylim=(0, None), xlabel="K r [-]")
    ax_A.set_ylabel("A / (\u2154 \u03c0 \u03c1 r\u00b3) [-]")
    ax_B.set_ylabel("B / (\u2154 \u03c0 \u03c1 r\u00b3 \u03c9) [-]")
    for ax in (ax_K, ax_A, ax_error, ax_B):
        ax.axhline(0, color="#8a8f98", lw=0.6)
        if ax.get_legend_handles_labels()[0]:
            ax.legend(frameon=False)
