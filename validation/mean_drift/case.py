"""Mean drift by three methods: against WAMIT, diffraction theory, and each other."""

import warnings
from typing import Any

import numpy as np
from scipy.special import h2vp, jvp

import ogilvie as og
from ogilvie.hydro.drift import mean_drift

TITLE = "Mean drift forces: far field, control surface and pressure integration"
ABOUT = """A floating hemisphere on the 400 panels of WAMIT's input (WEC-Sim, `Mean_Drift`): all three methods meet WAMIT's far
field (`.8`), while its own pressure integration (`.9`) is up to two thirds off, as it takes
everything at panel centres: done the same way (`waterline="centre"`), ours follows it. Moments about the origin that moves with
the body, WAMIT's negative modes, follow in the files of an FPSO from those about the fixed one and the motions.
A vertical cylinder held in waves, three radii deep, against the diffraction theory of R. C. MacCamy and R. A. Fuchs (1954) with
Maruo's form; the cylinder of the theory has no lower end, which is worth 0.3 % at kR = 1. A box barge of 100 x 20 x 6 m with
sharp edges: the control surface needs no velocity on the hull and stays with the far field (yaw differs most at the undamped
resonance of roll), pressure integration does not; its differences are noted, not judged. Energy: what waves and damping carry
away against what the incident wave loses, two independent sums. Differences are parts of the largest value of a curve."""
NEEDS = [
    "data/wecsim_sphere_drift/sphere.1",
    "data/wecsim_sphere_drift/sphere.GDF",
    "data/mss_wamit_fpso/fpso.1",
]
HEIGHT = 8.0

RHO, G = 1000.0, 9.81
QUIET = {"cache": False, "progress": False, "rho": RHO, "g": G}
METHODS = {"momentum": "far field", "control_surface": "control surface", "pressure": "near field"}
KR = np.array([1.0, 1.4, 1.8, 2.2, 2.6, 3.0])
BOX = (100.0, 20.0, 6.0)  # m


def run(shared: Any) -> tuple[list[dict], dict]:
    """Return the checks and what the figure needs."""
    sphere, centre, wamit, pick = _sphere(shared)
    checks = []
    u = wamit.attrs["rho"] * wamit.attrs["g"]
    theirs = wamit.mean_drift_momentum.values[pick, 0, 0] / u
    for method, words in METHODS.items():
        found = sphere[f"mean_drift_{method}"].values[:, 0, 0] / u
        checks.append(
            _check(f"hemisphere, surge, {words}", found, theirs, 1.5, "WAMIT 7.311, far field", f"{len(pick)} frequencies")
        )
    heave = [sphere[f"mean_drift_{m}"].values[:, 0, 2] / u for m in ("pressure", "control_surface")]
    checks.append(_check("hemisphere, heave, near field against control surface", *heave, 3.0, "each other", ""))
    checks.append(_energy("hemisphere", sphere))
    for dof, i in (("surge", 0), ("heave", 2)):
        own, file = centre.mean_drift.values[:, 0, i] / u, wamit.mean_drift_pressure.values[pick, 0, i] / u
        converged = np.abs(sphere.mean_drift_pressure.values[:, 0, i] / u - file).max() / np.abs(file).max()
        note = f"on the same panels; with elevations at edges {100.0 * converged:.0f} % away"
        checks.append(_check(f"hemisphere, {dof}, near field at panel centres", own, file, 3.0, "WAMIT 7.311, .9", note))
    checks += _moving_origin(og.read_hydro(shared / NEEDS[2]))
    cylinder = mean_drift(og.shapes.cylinder(1.0, 3.0, panels=2000), omega=np.sqrt(G * KR), wave_direction=[0.0], **QUIET)
    exact = np.array([cylinder_drift(x) for x in KR])
    for method, words in METHODS.items():
        found = cylinder[f"mean_drift_{method}"].values[:, 0, 0] / (RHO * G)
        checks.append(_check(f"fixed cylinder, surge, {words}", found, exact, 1.5, "MacCamy and Fuchs 1954, Maruo 1960", ""))
    checks.append(_energy("fixed cylinder", cylinder))
    box = _box()
    far = box.mean_drift_momentum.values
    for i, dof, tolerance in ((0, "surge", 2.0), (1, "sway", 2.0), (5, "yaw", 6.0)):
        near = np.abs(box.mean_drift_pressure.values[..., i] - far[..., i]).max() / np.abs(far[..., i]).max()
        found, note = box.mean_drift_control_surface.values[..., i], f"near field: {100.0 * near:.0f} %"
        name = f"box barge, {dof}, control surface against far field"
        checks.append(_check(name, found, far[..., i], tolerance, "each other", note))
    checks.append(_energy("box barge", box))
    return checks, {"sphere": sphere, "centre": centre, "wamit": wamit, "pick": pick, "cylinder": cylinder, "box": box}


def draw(data: dict, fig: Any) -> None:
    """Hemisphere with WAMIT, cylinder with theory, barge."""
    above, middle, below = fig.subplots(3, 1)
    wamit, sphere = data["wamit"], data["sphere"]
    u = wamit.attrs["rho"] * wamit.attrs["g"]
    band = (wamit.omega > 2.0) & (wamit.omega < 4.8)
    for name, style in (("momentum", "-"), ("pressure", ":")):
        line = wamit[f"mean_drift_{name}"][band, 0, 0] / u
        above.plot(wamit.omega[band], line, style, color="0.5", label=f"WAMIT, {METHODS[name]}")
    _points(above, sphere.omega, {m: sphere[f"mean_drift_{m}"][:, 0, 0] / u for m in METHODS})
    above.plot(sphere.omega, data["centre"].mean_drift[:, 0, 0] / u, "k+", ms=6, label="near field at panel centres")
    above.set(title="hemisphere afloat", xlabel="omega, rad/s", ylabel="surge/(rho g a^2 R)")
    k = np.linspace(0.1, 3.2, 80)
    middle.plot(k, [cylinder_drift(x) for x in k], color="0.5", label="theory")
    _points(middle, KR, {m: data["cylinder"][f"mean_drift_{m}"][:, 0, 0] / (RHO * G) for m in METHODS})
    middle.set(title="cylinder held", xlabel="kR", ylabel="surge/(rho g a^2 R)")
    box = data["box"]
    _points(below, box.omega, {m: box[f"mean_drift_{m}"][:, 0, 1] / (RHO * G * BOX[0]) for m in METHODS}, style="-")
    below.set(title="box barge afloat, beam seas", xlabel="omega, rad/s", ylabel="sway/(rho g a^2 L)")
    for axis in (above, middle, below):
        axis.legend(frameon=False)


def cylinder_drift(kR: float) -> float:
    """Drift of a deep vertical cylinder over rho g a^2 R; it tends to 2/3 in short waves."""
    m = np.arange(int(2 * kR) + 25)
    c = jvp(m, kR) / h2vp(m, kR) * np.where(m == 0, 1.0, 2.0)
    theta = 2.0 * np.pi * np.arange(720) / 720
    A = np.sqrt(2.0 / (np.pi * kR)) * (c @ np.cos(np.outer(m, theta)))
    return float(0.25 * np.mean(np.abs(A) ** 2 * (1.0 - np.cos(theta))) * 2.0 * np.pi)


def _moving_origin(wamit: Any) -> list[dict]:
    """Return the checks of WAMIT's negative modes from its positive ones and its motions."""
    found, theirs = og.drift_about_body(wamit, "mean_drift_pressure").values, wamit.mean_drift_pressure_body.values
    checks = []
    for i, dof in ((3, "roll"), (4, "pitch"), (5, "yaw")):
        shift = np.abs(wamit.mean_drift_pressure.values - theirs)[..., i].max() / np.abs(theirs[..., i]).max()
        note = f"the two origins are up to {100.0 * shift:.2g} % apart"
        checks.append(
            _check(f"FPSO, {dof} about the moving origin", found[..., i], theirs[..., i], 1.0, "WAMIT, negative modes", note)
        )
    regular = wamit.omega.values < 0.75  # beyond, WAMIT's forces are those of irregular frequencies
    for i, dof in ((3, "roll"), (5, "yaw")):
        own, file = (wamit.mean_drift_pressure.values[regular, :, i] - x[regular, :, i] for x in (found, theirs))
        checks.append(_check(f"FPSO, {dof}, difference of the origins", own, file, 1.5, "WAMIT", "below 0.75 rad/s"))
    return checks


def _sphere(shared: Any) -> tuple[Any, Any, Any, list[int]]:
    wamit = og.read_hydro(shared / NEEDS[0])
    pick = [i for i, w in enumerate(wamit.omega.values) if 2.0 < w < 4.8][::3]
    M = wamit.inertia_matrix.values
    hull, body = og.load_mesh(shared / NEEDS[1]), og.RigidBody(M[0, 0], [0.0, 0.0, 0.0], np.diag(M)[3:])
    keys = {
        "omega": wamit.omega.values[pick],
        "wave_direction": [0.0],
        **{**QUIET, "rho": wamit.attrs["rho"], "g": wamit.attrs["g"]},
    }
    as_wamit = {"method": "near", "waterline": "centre", "rotation": "XYZ", "irregular_frequencies": "keep"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", og.OgilvieWarning)  # off the far field, as expected
        centre = mean_drift(hull, body, **keys, **as_wamit)
    return mean_drift(hull, body, **keys), centre, wamit, pick


def _box() -> Any:
    hull = og.shapes.box(*BOX, panels=1200)
    body = og.RigidBody.from_hull(hull, gyradii=(7.0, 25.0, 25.0), zg=0.0, rho=RHO)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", og.OgilvieWarning)
        return mean_drift(
            hull, body, omega=np.arange(0.45, 1.01, 0.05), wave_direction=np.radians([90.0, 135.0, 180.0]), **QUIET
        )


def _points(axis: Any, x: Any, curves: dict, style: str = "") -> None:
    for (method, y), mark in zip(curves.items(), "osx", strict=True):
        axis.plot(x, y, style + mark, ms=4, lw=1, label=METHODS[method], fillstyle="none")


def _check(name: str, found: np.ndarray, wanted: np.ndarray, tolerance: float, source: str, note: str) -> dict:
    error = 100.0 * np.abs(found - wanted).max() / np.abs(wanted).max()
    return {
        "name": name,
        "value": float(error),
        "reference": 0.0,
        "tolerance": tolerance,
        "unit": "% of the largest value",
        "source": source,
        "note": note,
    }


def _energy(name: str, drift: Any) -> dict:
    worst = 100.0 * float(np.abs(drift.energy_imbalance).max())
    return {"name": f"{name}, energy", "value": worst, "reference": 0.0, "tolerance": 2.0, "unit": "% out of balance"}
