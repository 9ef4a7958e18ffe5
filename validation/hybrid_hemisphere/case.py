"""The floating hemisphere by the hybrid time-domain method with a passive outer domain, in one call without settings."""

import re
from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.bem.coupled import joined
from ogilvie.bem.curved import CurvedMesh
from ogilvie.bem.hybrid import hybrid_bem
from ogilvie.bem.hybrid_case import curved_boundary, hybrid_case
from ogilvie.bem.hybrid_hydro import hybrid_hydro
from ogilvie.bem.inner import inner_maps
from ogilvie.bem.jitter import jittered
from ogilvie.bem.short_waves import short_waves
from ogilvie.bem.stepping import impulse_response
from ogilvie.memory.table import Retardation

TITLE = "Hybrid time-domain method with a passive outer domain: hemisphere in time and frequency, and what is left late"
ABOUT = """Hemisphere of radius 1 m, one call of `hybrid_bem` or `hybrid_hydro` without settings: curved panels inside a control
hemisphere, oscillators that stand for the open sea outside it. The exact solution is the multipole expansion of A. Hulme
(Journal of Fluid Mechanics 121 (1982) 443-463) and its cosine transform. Errors of K are the largest in each window of time
over K(0), in percent. In frequency, `solve_bem` stands beside it with and without the panels on the waterplane that remove
irregular frequencies: the time domain has none. Late times: |K| in heave and surge after t = 300 on the panels of the call,
with all inner corners of free surface and control surface moved at random by up to 40 % of half the shortest side, and for a
box barge 4 x 1 x 0.5 likewise; the energy is what is left of what an impulse gave, which can only fall."""
NEEDS = ["reference/hemisphere_K.csv", "reference/hemisphere_exact.csv"]
HEIGHT = 7.6

VOLUME = 2.0 / 3.0 * np.pi
UNITS = {"rho": 1.0, "g": 1.0}
EXACT = "exact: Hulme (1982), multipole expansion"
WINDOWS = ((0.0, 0.5), (0.5, 3.0), (3.0, 12.0), (12.0, 25.0), (25.0, 40.0))
DOFS = (("K33", 2, 1), ("K11", 0, 2))  # number of the dof, column of the table
ALLOWED = {"K33": (0.05,) * 5, "K11": (0.6, 0.6, 0.6, 0.05, 0.05)}  # % of K(0)
CURVES = ("A33", "B33", "A11", "B11", "X3", "X1")
ALLOWED_CURVES = (0.02, 0.05, 0.1, 0.15, 0.02, 0.15)  # % of the largest value
SWEEP = np.arange(2.40, 2.721, 0.02)  # Ka through the irregular frequency of heave, 2.56
PANELS = 600  # of the hull for the frequency-domain code
LATE, LAST, COARSE = 300.0, 1000.0, 0.5


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the checks and the curves, in units of rho, g, radius and 2/3 pi rho r^3."""
    assert shared is not None
    exact = np.loadtxt(shared / NEEDS[0], delimiter=",", skiprows=2)
    result = hybrid_bem(og.shapes.hemisphere(1.0), duration=40.0, dt=0.05, **UNITS)
    errors = {name: 100.0 * (result.K[:, i, i] / VOLUME - exact[:, c]) / exact[0, c] for name, i, c in DOFS}
    frequency = in_frequency(np.genfromtxt(shared / NEEDS[1], delimiter=",", skip_header=3))
    late = {name: remains(mesh, order) for name, (mesh, order) in meshes().items()}
    checks = windows(result, errors) + limits(result) + compared(frequency)
    checks += moved(late["hemisphere, corners moved"], exact)
    checks += [row for name, found in late.items() for row in late_checks(name, found)]
    return checks, {"t": result.t, "exact": exact, "K": result.K / VOLUME, "errors": errors, "late": late, **frequency}


def windows(result: Retardation, errors: dict[str, np.ndarray]) -> list[dict[str, Any]]:
    """Compare K in windows of time."""
    checks = []
    for name, i, _ in DOFS:
        true, stated = np.abs(errors[name]).max(), 100.0 * result.discretisation_error[i, i]
        note = f"at all times {true:.2g} %; the result itself states {stated:.2g} %"
        for (low, high), allowed in zip(WINDOWS, ALLOWED[name], strict=True):
            error = errors[name][(result.t >= low - 1e-9) & (result.t <= high + 1e-9)]
            title = f"{name}, largest error, t {low:g} to {high:g}"
            checks.append(check(title, np.abs(error).max(), 0.0, allowed, "% of K(0)", EXACT, note))
    return checks


def limits(result: Retardation) -> list[dict[str, Any]]:
    """Compare A_inf and K33(0), and count nodes."""
    mass, start = np.diag(result.A_inf) / VOLUME, result.K[0, 2, 2] / VOLUME
    nodes = re.search(r"(\d+) on the whole boundary", " ".join(result.notes))
    assert nodes is not None
    unit, wall = "2/3 pi rho r^3", 4.0 / np.pi - 1.0
    return [
        check("A33 at infinite frequency", mass[2], 0.5, 1e-4 * 0.5, unit, "exact", "allowed: 0.01 %"),
        check("A11 at infinite frequency", mass[0], wall, 2e-3 * wall, unit, "exact", "allowed: 0.2 %"),
        check("K33(0)", start, 3.0 / 16.0, 5e-4 * 3.0 / 16.0, unit + " g/r", "exact", "allowed: 0.05 %"),
        check("nodes of the whole boundary", float(nodes[1]), 1000.0, 1000.0, "", "", f"at most 2000; {result.source}"),
    ]


def in_frequency(table: np.ndarray) -> dict[str, Any]:
    """Return curves and errors in percent of the largest value, of the time domain and of the frequency domain."""
    wide = np.round(np.concatenate([np.arange(0.05, 4.001, 0.05), SWEEP]), 6)
    Ka, few = np.unique(wide), np.unique(np.round(np.concatenate([np.arange(0.1, 4.001, 0.3), SWEEP]), 6))
    scale = tabulated(table, Ka).max(axis=0)
    hull = og.shapes.hemisphere(1.0, panels=PANELS)
    found = {"hybrid": curves(hybrid_hydro(og.shapes.hemisphere(1.0), omega=np.sqrt(Ka), **UNITS))}
    for how in ("keep", "remove"):
        solved = og.solve_bem(hull, omega=np.sqrt(few), irregular_frequencies=how, progress=False, **UNITS)
        found[how] = curves(solved)
    at = {"hybrid": Ka, "keep": few, "remove": few}
    off = {name: 100.0 * (found[name] - tabulated(table, at[name])) / scale for name in found}
    return {"Ka": at, "found": found, "off": off, "dense": (Ka, tabulated(table, Ka))}


def curves(hydro: Any) -> np.ndarray:
    """Return A33, B33, A11, B11 over 2/3 pi rho r^3, and |X3|, |X1| over rho g pi r^2 (n, 6)."""
    A, B = hydro.added_mass.values / VOLUME, hydro.radiation_damping.values / VOLUME
    X = np.abs(hydro.excitation_force.values[:, 0]) / np.pi
    return np.stack([A[:, 2, 2], B[:, 2, 2], A[:, 0, 0], B[:, 0, 0], X[:, 2], X[:, 0]], axis=1)


def tabulated(table: np.ndarray, Ka: np.ndarray) -> np.ndarray:
    """Return the same curves from the exact table by cubic splines, the forces from the damping by Haskind's relation."""
    from scipy.interpolate import CubicSpline

    A33, b33, A11, b11 = (CubicSpline(table[:, 0], table[:, i])(Ka) for i in (1, 2, 3, 4))
    X = [np.sqrt(factor * b / (3.0 * np.pi * Ka)) for factor, b in ((4.0, b33), (8.0, b11))]
    return np.stack([A33, b33 * np.sqrt(Ka), A11, b11 * np.sqrt(Ka), *X], axis=1)


def compared(data: dict[str, Any]) -> list[dict[str, Any]]:
    """Compare added mass, damping and forces over all frequencies."""
    worst = {name: np.abs(error).max(axis=0) for name, error in data["off"].items()}
    words = "solve_bem, {} panels: {:.2g} % with panels on the waterplane, {:.2g} % without them"
    return [
        check(
            f"{name}, largest error, Ka 0.05 to 4 and 2.4 to 2.72 by 0.02",
            worst["hybrid"][i],
            0.0,
            allowed,
            "% of the largest value",
            EXACT,
            words.format(PANELS, worst["remove"][i], worst["keep"][i]),
        )
        for i, (name, allowed) in enumerate(zip(CURVES, ALLOWED_CURVES, strict=True))
    ]


def meshes() -> dict[str, tuple[CurvedMesh, int]]:
    """Return panels as the call makes them of hemisphere and (fewer) box, moved or not, with the nodes per side."""
    sphere, box = (
        curved_boundary(hull, None, resolution)
        for hull, resolution in ((og.shapes.hemisphere(1.0), 1.0), (og.shapes.box(4.0, 1.0, 0.5), 0.7))
    )
    return {
        "hemisphere": (sphere, 4),
        "hemisphere, corners moved": (jittered(sphere, 0.4), 4),
        "box": (box, 3),
        "box, corners moved": (jittered(box, 0.4), 3),
    }


def remains(mesh: CurvedMesh, order: int) -> dict[str, Any]:
    """Return K of heave and surge to t = 1000, energies, and the largest real part of an eigenvalue of the motion."""
    case = hybrid_case("late times", mesh, duration=LAST, dt=COARSE, order=order, **UNITS)
    maps, _ = inner_maps(mesh, order=order)
    K, energy, growth, nodes = [], [], [], len(mesh.images) * len(maps[0].nodes.weight)
    for inner in (m for m in maps if {0, 2} & set(m.dofs)):
        system = joined(case.domains(inner))
        late, step = short_waves(system), case.step / case.time
        response = impulse_response(system.stiffness, system.dampers, system.forcing, dt=step, count=case.count, late=late)
        K.append(mesh.radius**2 * response.K[:, 0, 0])
        energy.append(response.energy.max(axis=1))
        growth.append(fastest(system.stiffness, system.dampers, late))
    return {"t": case.t, "K": K, "energy": energy, "growth": max(growth) / case.time, "nodes": nodes}


def fastest(S: np.ndarray, dampers: np.ndarray, late: Any) -> float:
    """Return the largest real part of an eigenvalue of z'' + C z' + S z = 0 with and without the damping of short waves."""
    C = dampers @ dampers.T
    found = []
    for damping in (C, C + late.shape @ (late.rate[:, None] * late.shape.T)):
        A = np.block([[np.zeros_like(S), np.eye(len(S))], [-S, -damping]])
        found.append(np.linalg.eigvals(A).real.max())
    return float(max(found))


def moved(found: dict[str, Any], exact: np.ndarray) -> list[dict[str, Any]]:
    """Compare K on the moved panels with the exact one, as on the others."""
    every = exact[:: round(COARSE / 0.05)]
    checks = []
    for K, (name, _, column) in zip(found["K"], DOFS, strict=True):
        error = 100.0 * np.abs(K[: len(every)] / VOLUME - every[:, column]).max() / exact[0, column]
        title = f"hemisphere, corners moved: {name}, largest error, t 0 to 40 by 0.5"
        checks.append(check(title, error, 0.0, max(ALLOWED[name]), "% of K(0)", EXACT))
    return checks


def late_checks(name: str, found: dict[str, Any]) -> list[dict[str, Any]]:
    """Compare what is left after t = 300 with zero."""
    after = found["t"] > LATE
    left = [100.0 * float(np.abs(k[after]).max()) / k[0] for k in found["K"]]
    rise = max(float(np.diff(e).max()) for e in found["energy"])
    note = f"heave {left[0]:.1e}, surge {left[1]:.1e} %; {found['nodes']} nodes"
    return [
        check(f"{name}: |K| for t 300 to 1000", max(left), 0.0, 0.02, "% of K(0)", "what the sea carries away", note),
        check(f"{name}: largest rise of energy in a step", max(rise, 0.0), 0.0, 1e-12, "of the impulse's", "passivity"),
        check(f"{name}: largest growth rate of an eigenvalue", max(found["growth"], 0.0), 0.0, 1e-9, "1/s", "passivity"),
    ]


def check(
    name: str, value: float, reference: float, tolerance: float, unit: str = "", source: str = "", note: str = ""
) -> dict[str, Any]:
    """Return one comparison."""
    return {
        "name": name, "value": float(value), "reference": reference, "tolerance": tolerance, "unit": unit, "source": source,
        "note": note,
    }  # fmt: skip


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw K and errors, the irregular frequency, late times."""
    axes = fig.subplots(3, 2)
    colours = {"K33": "#2f6db0", "K11": "#d1495b"}
    for name, i, column in DOFS:
        axes[0, 0].plot(data["t"], data["exact"][:, column], color="#22262b", lw=3.2, alpha=0.3)
        axes[0, 0].plot(data["t"], data["K"][:, i, i], color=colours[name], lw=1.2, label=name)
        axes[0, 1].semilogy(data["t"], np.abs(data["errors"][name]) + 1e-9, color=colours[name], lw=1, label=name)
    axes[0, 0].set(title="K (grey: exact)", xlim=(0, 15), ylabel="K / (\u2154 \u03c0 \u03c1 r\u00b2 g) [-]")
    axes[0, 1].set(title="|error| of K", xlim=(0, 40), ylim=(1e-6, 1), ylabel="% of K(0)")
    for ax in axes[0]:
        ax.set_xlabel("t (g/r)\u00bd [-]")
        ax.legend(frameon=False)
    look = {"keep": ("#c9971c", "o", "solve_bem, without lid"), "remove": ("#2e8b57", "s", "solve_bem, with lid")}
    for ax, i, title in (
        (axes[1, 0], 0, "A33 / (\u2154 \u03c0 \u03c1 r\u00b3)"),
        (axes[1, 1], 4, "|X3| / (\u03c0 \u03c1 g r\u00b2)"),
    ):
        Ka, exact = data["dense"]
        ax.plot(Ka, exact[:, i], color="#22262b", lw=3.2, alpha=0.3, label="exact")
        for how, (colour, marker, label) in look.items():
            ax.plot(data["Ka"][how], data["found"][how][:, i], marker, color=colour, ms=3, mfc="none", lw=0, label=label)
        ax.plot(Ka, data["found"]["hybrid"][:, i], color="#2f6db0", lw=1.2, label="hybrid")
        inside = (Ka > 1.9) & (Ka < 3.3)
        low, high, room = exact[inside, i].min(), exact[inside, i].max(), 0.13 if i == 0 else 0.08
        ax.set(title=title, xlim=(2.0, 3.2), ylim=(low - room, high + room), xlabel="K r [-]")
    axes[1, 1].legend(frameon=False, fontsize=7)
    for name, found in data["late"].items():
        line = {"lw": 1.0, "ls": "--" if "moved" in name else "-", "color": "#2f6db0" if "hemi" in name else "#d1495b"}
        size = np.max([np.abs(k) / k[0] for k in found["K"]], axis=0)
        envelope = np.maximum.accumulate(size[::-1])[::-1]
        axes[2, 0].loglog(found["t"][1:], 100.0 * envelope[1:], **line, label=name)
        energy = np.max(found["energy"], axis=0)
        known = np.flatnonzero(np.diff(energy, prepend=np.inf))[1:]  # late it is known at some times only
        axes[2, 1].loglog(found["t"][known], energy[known], **line, label=name)
    axes[2, 0].axhline(0.02, color="#8a8f98", lw=0.9, ls=":")
    axes[2, 0].set(title="what is left of |K|, heave and surge", ylabel="% of K(0)", xlabel="t [s]", xlim=(1, 1000))
    axes[2, 1].set(title="energy after an impulse", ylabel="of that at the start", xlabel="t [s]", xlim=(1, 1000))
    axes[2, 1].legend(frameon=False, fontsize=7)
