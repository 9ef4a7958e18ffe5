"""Heave decay of a sphere dropped from above its floating position: six codes, CFD, and what the wetted surface changes."""

from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.loads.froude_krylov import NonlinearFroudeKrylov

TITLE = "Heave decay of a sphere"
ABOUT = """A sphere of 10 m diameter floats to its equator in deep water (IEA OES Task 10; Wendt et al. 2017, 2019) and is
released 1 m above that. Its heave is compared with five codes, MARIN's nonlinear one and CFD (NREL): once with linear
restoring, once with the buoyancy of the instantaneous wetted surface, both with the same linear radiation as a state space.
At 1 m the wetted surface matters little: the waterplane shrinks by 4 % either way, so the period grows. The larger drops (3 m,
and 5 m, where the sphere just touches the water) show what restoring alone does to the decay; added mass and wave damping stay
those of the half-immersed sphere, as in all weakly nonlinear codes."""
NEEDS = ["data/seastack_oes_sphere/sphere_decay_multicode/normalized/" + n + "/heave_decay.txt"
         for n in ("proteusds", "inwave", "inwave_h", "wavec", "hydrochrono", "marin", "nrel_cfd")]  # fmt: skip
HEIGHT = 5.2

RADIUS, MASS, RHO, G, ZG = 5.0, 261.8e3, 1000.0, 9.81, -2.0
OMEGA = np.arange(0.1, 5.81, 0.1)
DT, DURATION = 0.02, 20.0
NAMES = {
    "proteusds": "ProteusDS", "inwave": "InWave", "inwave_h": "InWave+H", "wavec": "WavEC", "hydrochrono": "HydroChrono",
    "marin": "MARIN (nonlinear)", "nrel_cfd": "NREL CFD",
}  # fmt: skip
SOURCE = "IEA OES Task 10, as collected by SEA-Stack"
HEAVE = 2


def sphere(panels: int) -> tuple[Any, Any]:
    """Return the wetted half and the closed sphere."""
    wet = og.shapes.hemisphere(RADIUS, panels=panels)
    lower = wet.full()
    upper = lower.vertices * [1.0, 1.0, -1.0]
    faces = np.concatenate([lower.faces, lower.faces[:, ::-1] + len(upper)])
    return wet, og.PanelMesh(np.concatenate([lower.vertices, upper]), faces)


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the differences of the series and the series."""
    assert shared is not None
    reference = {key: np.loadtxt(shared / path).T for key, path in zip(_keys(), NEEDS, strict=True)}
    wet, closed = sphere(1200)
    body = og.RigidBody(mass=RHO * wet.volume, cog=[0, 0, ZG], inertia=np.diag([1.69e6, 1.69e6, 2.6e6]))
    hydro = og.solve_bem(wet, body, omega=OMEGA, wave_direction=[0.0], rho=RHO, g=G, progress=False)
    K = og.retardation(hydro)
    model = og.identify(K, mass=body.matrix, stiffness=hydro.hydrostatic_stiffness.values)
    radiation = og.StateSpaceRadiation(model)
    loads = {"linear": og.LinearRestoring(hydro), "nonlinear": NonlinearFroudeKrylov(closed, body, hydro)}
    series = {}
    for kind, restoring in loads.items():
        for height in (1.0, 3.0, 5.0):
            motion = og.simulate(
                og.Vessel(body, loads=(restoring, radiation)), duration=DURATION, dt=DT, motions="large",
                initial={"eta": [0, 0, height, 0, 0, 0]},
            )  # fmt: skip
            series[kind, height] = (motion.time.values, motion.eta.values[:, HEAVE])
    return _checks(series, reference, body), {"series": series, "reference": reference}


def _keys() -> list[str]:
    return [path.split("/")[-2] for path in NEEDS]


def _difference(ours: Any, theirs: np.ndarray) -> float:
    """Return the root mean square difference over the first 15 s as a fraction of the drop."""
    t, z = theirs[:, theirs[0] <= 15.0]
    return float(np.sqrt(np.mean((np.interp(t, *ours) - z) ** 2)))


def _crossings(t: np.ndarray, z: np.ndarray) -> np.ndarray:
    at = np.flatnonzero((z[:-1] > 0) & (z[1:] <= 0))
    return t[at] + z[at] / (z[at] - z[at + 1]) * (t[at + 1] - t[at])


def _period(t: np.ndarray, z: np.ndarray) -> float:
    """Return the time between the first two downward crossings of zero, s."""
    return float(np.diff(_crossings(t, z))[0])


def _trough(t: np.ndarray, z: np.ndarray) -> float:
    return float(z[t < 4.0].min())


def _checks(series: dict[Any, Any], reference: dict[str, np.ndarray], body: Any) -> list[dict[str, Any]]:
    checks = [
        _check("mass of the sphere's wetted half", body.mass / 1e3, MASS / 1e3, 1.0, "t", "given in the task: 261.8 t"),
    ]
    spread = {key: _difference(tuple(series_), reference["nrel_cfd"]) for key, series_ in reference.items()}
    for key, name in NAMES.items():
        nonlinear = key in ("marin", "nrel_cfd")
        ours = series["nonlinear" if nonlinear else "linear", 1.0]
        what = "nonlinear" if nonlinear else "linear"
        checks.append(
            _check(
                f"1 m drop, {what}, against {name}: r.m.s. difference over the drop", _difference(ours, reference[key]), 0.0,
                0.05 if key == "proteusds" else 0.02, "", f"0 to 15 s; this code's own difference to CFD {spread[key]:.3f}",
            )
        )  # fmt: skip
    linear = _difference(series["linear", 1.0], reference["nrel_cfd"])
    found = _difference(series["nonlinear", 1.0], reference["nrel_cfd"])
    name = "1 m drop: r.m.s. difference to CFD, nonlinear over linear restoring"
    checks.append(_check(name, found / linear, 0.5, 0.2, "", f"{linear:.4f} -> {found:.4f}"))
    for key in ("marin", "nrel_cfd"):
        checks += [
            _check(f"1 m drop: first period, {NAMES[key]}", _period(*series["nonlinear", 1.0]), _period(*reference[key]), 0.04,
                   "s", f"linear {_period(*series['linear', 1.0]):.3f} s"),
            _check(f"1 m drop: first trough, {NAMES[key]}", _trough(*series["nonlinear", 1.0]), _trough(*reference[key]), 0.03,
                   "m", f"linear {_trough(*series['linear', 1.0]):.3f} m"),
        ]  # fmt: skip
    return checks


def _check(name: str, value: float, reference: float, tolerance: float, unit: str, note: str) -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": float(reference), "tolerance": tolerance, "unit": unit,
        "source": SOURCE, "note": note,
    }  # fmt: skip


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw the decay from 1 m with all codes, and those from 3 m and 5 m over the drop."""
    grid = fig.add_gridspec(2, 2, height_ratios=[1.1, 1.0])
    ax = fig.add_subplot(grid[0, :])
    for key, (t, z) in data["reference"].items():
        colour = {"marin": "#2e8b57", "nrel_cfd": "#22262b"}.get(key, "#9aa3ad")
        ax.plot(t, z, color=colour, lw=2.4 if key == "nrel_cfd" else 1.4, alpha=0.45, label=NAMES[key])
    for kind, colour, style in (("linear", "#d1495b", (0, (4, 3))), ("nonlinear", "#2f6db0", "-")):
        ax.plot(*data["series"][kind, 1.0], color=colour, ls=style, lw=1.0, label=f"ogilvie, {kind}")
    ax.set(xlim=(0, 15), xlabel="time [s]", ylabel="heave [m]", title="released 1 m above rest")
    ax.legend(ncols=3, fontsize=6.5)
    for place, height in ((grid[1, 0], 3.0), (grid[1, 1], 5.0)):
        ax = fig.add_subplot(place)
        for kind, colour, style in (("linear", "#d1495b", (0, (4, 3))), ("nonlinear", "#2f6db0", "-")):
            ax.plot(*data["series"][kind, height], color=colour, ls=style, lw=1.2, label=f"{kind} restoring")
        ax.set(xlim=(0, 15), xlabel="time [s]", ylabel="heave [m]", title=f"released {height:.0f} m above rest")
    ax.legend(fontsize=6.5)
