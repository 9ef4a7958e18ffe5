"""A box barge by the hybrid time-domain method: against itself on finer panels and against the frequency domain."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.bem.hybrid import hybrid_bem
from ogilvie.memory.table import Retardation

TITLE = "Hybrid time-domain method: retardation functions of a box barge, all six motions"
ABOUT = """Box 4 x 1 x 0.5 m, rho = g = 1, about the middle of the waterplane. `hybrid_bem` without settings beside itself at
resolution 1.5 (half as many panels again per length), and beside `solve_bem` (Capytaine: flat panels, irregular frequencies
removed) with `retardation` on three meshes of that code. Differences of K are the largest for t up to 30 over K(0), in percent.
The edges of the box slow the flat panels down: their results move towards the hybrid method's as they shrink, and the straight
line through the two finest in 1/n, n the number of panels (second order in their size), ends close to it. Roll, whose K is two
orders smaller than what the moment of sway's pressure would give, is hardest."""
NEEDS: list[str] = []
HEIGHT = 7.6

SIZE = (4.0, 1.0, 0.5)
UNITS = {"rho": 1.0, "g": 1.0}
DOFS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
PANELS = (500, 1000, 2900)  # at most, of the flat panels
OMEGA = np.concatenate([np.arange(0.08, 1.61, 0.08), np.arange(1.76, 3.21, 0.16), np.arange(3.4, 4.61, 0.4)])
DURATION, DT = 30.0, 0.1
#: Allowed differences: own K and A at resolution 1 from 1.5, K of the finest flat panels, K and A of the straight line, %.
SELF = {"surge": 0.4, "sway": 0.3, "heave": 0.1, "roll": 0.2, "pitch": 0.2, "yaw": 0.4}
FINEST = {"surge": 1.2, "sway": 1.2, "heave": 1.0, "roll": 6.0, "pitch": 1.5, "yaw": 1.2}
LINE = {"surge": 1.0, "sway": 1.0, "heave": 1.0, "roll": 4.0, "pitch": 1.2, "yaw": 1.2}


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the checks and the curves."""
    own, finer = (hybrid_bem(og.shapes.box(*SIZE), duration=DURATION, dt=DT, resolution=r, **UNITS) for r in (1.0, 1.5))
    counts, flat = zip(*(frequency_domain(n) for n in PANELS), strict=True)
    line = extrapolated(counts, flat)
    away = {name: percent(K, finer.K) for name, K in (("own", own.K), ("line", line[0]))}
    trend = np.array([percent(r.K, finer.K) for r in flat])
    checks = itself(own, finer, away["own"])
    for i, dof in enumerate(DOFS):
        words = ", ".join(f"{n} panels: {x:.2g} %" for n, x in zip(counts, trend[:, i], strict=True))
        title = f"K of {dof}: {counts[-1]} flat panels from hybrid"
        checks.append(check(title, trend[-1, i], FINEST[dof], "% of K(0)", "solve_bem (Capytaine), retardation", words))
        title = f"K of {dof}: flat panels, straight line in 1/n, from hybrid"
        checks.append(check(title, away["line"][i], LINE[dof], "% of K(0)", f"from {counts[-2]} and {counts[-1]} panels"))
    checks += masses(finer, counts, flat, line[1])
    data = {"own": own, "finer": finer, "flat": flat, "counts": counts, "trend": trend, "line": line}
    return checks, data


def frequency_domain(panels: int) -> tuple[int, Retardation]:
    """Return the number of panels and the retardation functions from flat panels."""
    hull = og.shapes.box(*SIZE, panels=panels, grading=1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", og.OgilvieWarning)  # short waves on the coarsest mesh: here a matter of the trend
        hydro = og.solve_bem(hull, omega=OMEGA, progress=False, **UNITS)
    return int(hydro.attrs["panels"]), og.retardation(hydro, duration=DURATION, dt=DT)


def extrapolated(counts: tuple[int, ...], flat: tuple[Retardation, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Return K and A_inf of no panel size, on the straight line in 1/n through the two finest."""
    (n, m), (coarse, fine) = counts[-2:], flat[-2:]
    return (m * fine.K - n * coarse.K) / (m - n), (m * fine.A_inf - n * coarse.A_inf) / (m - n)


def percent(K: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Return the largest differences of the diagonal entries over K(0), %."""
    difference = np.abs(np.diagonal(K - reference, axis1=1, axis2=2)).max(axis=0)
    return 100.0 * difference / np.diag(reference[0])


def itself(own: Retardation, finer: Retardation, away: np.ndarray) -> list[dict[str, Any]]:
    """Compare resolutions 1 and 1.5, and the difference with the error that the result states."""
    checks = []
    for i, dof in enumerate(DOFS):
        stated, mass = 100.0 * own.discretisation_error[i, i], 100.0 * (own.A_inf[i, i] / finer.A_inf[i, i] - 1.0)
        note = f"the result states {stated:.2g} % of the largest value"
        title = f"K of {dof}: resolution 1 from 1.5"
        checks.append(check(title, away[i], SELF[dof], "% of K(0)", "hybrid_bem, finer", note))
        checks.append(check(f"A of {dof} at infinity: resolution 1 from 1.5", mass, 0.2, "%", "hybrid_bem, finer"))
    return checks


def masses(
    finer: Retardation, counts: tuple[int, ...], flat: tuple[Retardation, ...], line: np.ndarray
) -> list[dict[str, Any]]:
    """Compare A_inf."""
    checks, reference = [], np.diag(finer.A_inf)
    for i, dof in enumerate(DOFS):
        off = [100.0 * (r.A_inf[i, i] / reference[i] - 1.0) for r in flat]
        words = ", ".join(f"{n} panels: {x:.2g} %" for n, x in zip(counts, off, strict=True))
        title = f"A of {dof} at infinity: flat panels, straight line in 1/n, from hybrid"
        checks.append(check(title, 100.0 * (line[i, i] / reference[i] - 1.0), 0.5, "%", "solve_bem (Capytaine)", words))
    return checks


def check(name: str, value: float, tolerance: float, unit: str, source: str, note: str = "") -> dict[str, Any]:
    """Return one comparison with no difference."""
    return {
        "name": name, "value": float(value), "reference": 0.0, "tolerance": tolerance, "unit": unit, "source": source,
        "note": note,
    }  # fmt: skip


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw K of each motion over K(0), and below the differences over the number of panels."""
    axes = fig.subplots(3, 3)
    finer, flat, counts = data["finer"], data["flat"], data["counts"]
    for i, dof in enumerate(DOFS):
        ax, start = axes[i // 3, i % 3], finer.K[0, i, i]
        ax.plot(finer.t, finer.K[:, i, i] / start, color="#22262b", lw=3.2, alpha=0.3, label="hybrid, resolution 1.5")
        ax.plot(data["own"].t, data["own"].K[:, i, i] / start, color="#2f6db0", lw=1.2, label="hybrid, no settings")
        ax.plot(flat[-1].t, flat[-1].K[:, i, i] / start, color="#d1495b", lw=1, ls=":", label=f"{counts[-1]} flat panels")
        ax.set(title=dof, xlim=(0, 20), xlabel="t [s]")
        ax.axhline(0, color="#8a8f98", lw=0.6)
    axes[0, 2].legend(frameon=False, fontsize=6)
    for ax in axes[:2, 0]:
        ax.set_ylabel("K / K(0) [-]")
    for i, dof in ((2, "heave"), (0, "surge")):
        ax = axes[2, 0 if i == 2 else 1]
        for r, n, shade in zip(flat, counts, (0.3, 0.6, 1.0), strict=True):
            error = 100.0 * (r.K[:, i, i] - finer.K[:, i, i]) / finer.K[0, i, i]
            ax.plot(r.t, error, color="#d1495b", alpha=shade, lw=1, label=f"{n} flat panels")
        error = 100.0 * (data["own"].K[:, i, i] - finer.K[:, i, i]) / finer.K[0, i, i]
        ax.plot(finer.t, error, color="#2f6db0", lw=1.2, label="hybrid, no settings")
        ax.set(title=f"{dof}: difference from res. 1.5", xlim=(0, 20), xlabel="t [s]")
    axes[2, 0].set_ylabel("% of K(0)")
    axes[2, 0].legend(frameon=False, fontsize=6)
    for i, dof in enumerate(DOFS):
        axes[2, 2].loglog(counts, data["trend"][:, i], "o-", ms=3, lw=1, label=dof)
    axes[2, 2].set(title="largest difference of K", xlabel="flat panels", ylabel="% of K(0)")
    axes[2, 2].set_xticks(counts, [str(n) for n in counts], minor=False)
    axes[2, 2].set_xticks([], minor=True)
    axes[2, 2].legend(frameon=False, fontsize=6, ncols=2)
