"""Nonlinear Froude-Krylov load: the linear limit, still water at large heel, work in a frozen wave."""

from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.frames import euler_rate_matrix, rotation_matrix
from ogilvie.loads.base import Surroundings
from ogilvie.loads.froude_krylov import NonlinearFroudeKrylov
from ogilvie.mesh.raise_sides import with_raised_sides
from ogilvie.units import GRAVITY, SEA_WATER, deg

TITLE = "Froude-Krylov force on the wetted hull: identities"
ABOUT = """What must hold whatever the hull. (1) As the waves get lower the force tends to the linear one of the panel method,
the difference with the square of the amplitude: S175 in head and oblique seas, same panels below the water. (2) In still water
it is restoring: the righting levers of a wall-sided barge, and the table of `HullRestoring` for the S175. (3) A frozen wave
whose pressure vanishes at its surface (Wheeler) is a potential field: the force is the gradient of the pressure integrated over
the wet volume, so a closed path in all six degrees of freedom takes no work. What is left comes from the panels and falls with
the square of their size (barge). Forces of a high wave with each kind of stretching stand beside the linear ones."""
NEEDS: list[str] = []
HEIGHT = 5.6

OMEGA = np.array([0.4, 0.5, 0.6, 0.7, 0.8])
HEADINGS = np.radians([120.0, 180.0])
AMPLITUDES = 0.8 * 0.5 ** np.arange(7)
PANELS = (200, 800, 3200, 12800)
SOURCE = "identity"
FREEBOARD = 5.9  # m: depth 15.4 m, the offsets end at 11 m
L, B, T = 60.0, 12.0, 3.0
DOFS = ("surge", "heave", "pitch")


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the checks and what the figure needs."""
    hull = with_raised_sides(og.shapes.s175(panels=1400, above_water=True), FREEBOARD)
    body = og.RigidBody.from_hull(hull.immersed(), kg=9.52, gyradii=(8.3, 42.0, 42.0))
    hydro = og.solve_bem(hull.immersed(), body, omega=OMEGA, wave_direction=HEADINGS, progress=False)
    load = NonlinearFroudeKrylov(hull, body, hydro, evaluation="direct", accuracy=1e-6)
    limit = _limit(load, hydro)
    levers = _levers()
    still = _still(hull, body, load)
    work = [_barge_work(n) for n in PANELS]
    checks = []
    for dof, (error, slope) in zip(DOFS, zip(*_summary(limit), strict=True), strict=True):
        checks += [
            _check(f"limit of no wave less the linear force, {dof}, worst of 10 waves", error, 0.0, 1e-3,
                   "of the largest", "S175, 1400 panels"),
            _check(f"order of the difference to the linear force in the amplitude, {dof}", slope, 2.0, 0.1, "", ""),
        ]  # fmt: skip
    checks.append(
        _check("righting levers of a barge, to 26 deg, worst", levers, 0.0, 1e-9, "of the largest", "wall-sided formula")
    )
    checks.append(_check("still water against HullRestoring, S175, worst", still, 0.0, 2e-3, "of m g and m g L/4", "30 poses"))
    order = np.log2(abs(work[0] / work[-1])) / 3
    ship = _work(load, og.regular(amplitude=3.0, omega=0.6, direction=np.radians(140.0)), 175.0)
    checks += [
        _check("work on a closed path in a frozen wave, barge", work[-1], 0.0, 1e-4, "of the work to and fro",
               f"12800 panels; order {order:.2f} in their size"),
        _check("the same, S175 in waves of 6 m", ship, 0.0, 5e-4, "of the work to and fro", "1400 panels"),
    ]  # fmt: skip
    return checks, {"limit": limit, "work": work, "load": load, "hull": hull}


def _limit(load: Any, hydro: Any) -> dict[str, Any]:
    """Return per wave the force per amplitude, the linear force, and the differences over the amplitudes."""
    linear = hydro.Froude_Krylov_force.values[:, :, [0, 2, 4]]
    still = load.force()
    found = np.empty((len(AMPLITUDES), *linear.shape), dtype=complex)
    for i, a in enumerate(AMPLITUDES):
        for j, w in enumerate(OMEGA):
            for k, b in enumerate(HEADINGS):
                F = [load.force(og.regular(amplitude=a, omega=w, direction=b, phase=p)) - still for p in (0.0, np.pi / 2)]
                found[i, j, k] = ((F[0] - 1j * F[1]) / a)[[0, 2, 4]]
    return {"linear": linear, "found": found}


def _summary(limit: dict[str, Any]) -> tuple[list[float], list[float]]:
    """Return per degree of freedom the error of the limit and the order of the difference."""
    linear, found = limit["linear"], limit["found"]
    zero = 2 * found[-1] - found[-2]  # extrapolated to no amplitude
    size = np.abs(linear).max(axis=(0, 1))
    errors = np.abs(zero - linear).max(axis=(0, 1)) / size
    second = np.abs(found - zero).max(axis=(1, 2)) * AMPLITUDES[:, None]  # a force, ~ a^2
    slopes = np.log2(second[1] / second[4]) / 3
    return list(errors), list(slopes)


def _levers() -> float:
    barge = og.shapes.box(L, B, 8.0, panels=400).translated((0, 0, 5.0))
    body = og.RigidBody.from_hull(barge.immersed(), zg=0.5, gyradii=(4.0, 15.0, 15.0))
    BM, GM = B**2 / 12 / T, T / 2 + B**2 / 12 / T - (T + 0.5)
    phi = np.radians(np.arange(0.0, 26.1, 2.0))
    want = np.sin(phi) * (GM + 0.5 * BM * np.tan(phi) ** 2)
    load = NonlinearFroudeKrylov(barge, body, _nothing())
    found = [-load.force(eta=[0, 0, 0, p, 0, 0])[3] / (body.mass * GRAVITY) for p in phi]
    return float(np.abs(found - want).max() / want.max())


def _still(hull: Any, body: Any, load: Any) -> float:
    table = og.HullRestoring(hull, body, heave=2.0, roll=45 * deg, pitch=3 * deg, points=(13, 61, 13)).bind(Surroundings(body))
    poses = np.random.default_rng(1).uniform([-1.5, -0.7, -0.04], [1.5, 0.7, 0.04], (30, 3))
    scale = body.mass * GRAVITY * np.array([1, 1, 1, 175 / 4, 175 / 4, 175 / 4])
    return float(max(np.abs((load.force(eta=e) - table.kernel.force(eta=e)) / scale).max() for e in
                     np.pad(poses, ((0, 0), (2, 1)))))  # fmt: skip


def _nothing() -> Any:
    """Return data of a body without any wave force."""
    w, Z, X = np.linspace(0.2, 2.0, 4), np.zeros((4, 6, 6)), np.zeros((4, 1, 6))
    data = og.hydro_from_arrays(
        omega=w, added_mass=Z, radiation_damping=Z, wave_direction=[0.0], excitation_force=X, rho=SEA_WATER, g=GRAVITY
    )
    return data.assign(Froude_Krylov_force=data.excitation_force)


def _barge_work(panels: int) -> float:
    hull = og.shapes.box(L, B, 12.0, panels=panels, grading=0.0).translated((0, 0, 9.0))
    body = og.RigidBody.from_hull(hull.immersed(), zg=0.5, gyradii=(4.0, 15.0, 15.0))
    load = NonlinearFroudeKrylov(hull, body, _nothing(), accuracy=1e-6)
    return _work(load, og.regular(amplitude=1.2, omega=0.9, direction=np.radians(140.0)), L)


def _work(load: Any, sea: Any, length: float) -> float:
    """Return the work of the force on a closed path over the work of its absolute power."""
    s = np.linspace(0.0, 2 * np.pi, 400, endpoint=False)
    size, lag = np.array([0.25 * length, 0.1 * length, 1.0, 0.35, 5.0 / length, 0.2]), np.array([0.0, 1.0, 2.0, 0.5, 1.4, 2.6])
    eta, rate = size * np.sin(s[:, None] + lag), size * np.cos(s[:, None] + lag)
    F = load.force(sea, eta=eta) - load.force(eta=eta)
    nu = np.empty_like(rate)
    for i, e in enumerate(eta):
        nu[i, :3] = rotation_matrix(*e[3:]).T @ rate[i, :3]
        nu[i, 3:] = np.linalg.solve(euler_rate_matrix(e[3], e[4]), rate[i, 3:])
    power = np.einsum("si,si->s", F, nu)
    return float(power.sum() / np.abs(power).sum())


def _check(name: str, value: float, reference: float, tolerance: float, unit: str, note: str) -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": float(reference), "tolerance": tolerance, "unit": unit,
        "source": SOURCE, "note": note,
    }  # fmt: skip


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw the difference over the amplitude, the forces of high waves by stretching, the work over the panels."""
    axes = fig.subplots(2, 2)
    found, linear = data["limit"]["found"], data["limit"]["linear"]
    zero = 2 * found[-1] - found[-2]
    for i, (dof, colour) in enumerate(zip(DOFS, ("#2f6db0", "#d1495b", "#2e8b57"), strict=True)):
        size = np.abs(linear[..., i]).max()
        second = np.abs(found - zero).max(axis=(1, 2))[:, i] * AMPLITUDES / size
        axes[0, 0].loglog(AMPLITUDES[:-1], second[:-1], "o-", color=colour, ms=3, label=dof)
    axes[0, 0].loglog(AMPLITUDES[:-1], 0.04 * AMPLITUDES[:-1] ** 2, color="#9aa3ad", ls=":", label="slope 2")
    axes[0, 0].set(xlabel="amplitude [m]", ylabel="force less linear [1 m]", title="small waves")
    axes[0, 0].legend(fontsize=6.5)
    axes[0, 0].minorticks_off()
    _draw_forces(axes[0, 1], axes[1, 0], data)
    ax = axes[1, 1]
    ax.loglog(PANELS, np.abs(data["work"]), "o-", color="#2f6db0", ms=3, label="barge")
    ax.loglog(PANELS, 0.4 / np.array(PANELS), color="#9aa3ad", ls=":", label="1/panels")
    ax.set(xlabel="panels below the water", ylabel="work / work to and fro", title="closed path in a frozen wave")
    ax.legend(fontsize=6.5)


def _draw_forces(heave: Any, pitch: Any, data: dict[str, Any]) -> None:
    load, hull = data["load"], data["hull"]
    body = og.RigidBody.from_hull(hull.immersed(), kg=9.52, gyradii=(8.3, 42.0, 42.0))
    phase = np.linspace(0.0, 2 * np.pi, 73)
    kinds = {"wheeler": {}, "vertical": {"stretching": "vertical"}, "extrapolated": {"stretching": "extrapolated"},
             "mean surface": {"surface": "mean"}}  # fmt: skip
    colours = ("#2f6db0", "#c9971c", "#8e4585", "#9aa3ad")
    still = load.force()
    for (name, more), colour in zip(kinds.items(), colours, strict=True):
        one = NonlinearFroudeKrylov(hull, body, load.hydro, **more)
        F = np.array([one.force(og.regular(amplitude=4.0, omega=0.6, direction=np.pi, phase=p)) - still for p in phase])
        heave.plot(phase / deg, F[:, 2] / 1e6, color=colour, lw=1.1, label=name)
        pitch.plot(phase / deg, F[:, 4] / 1e9, color=colour, lw=1.1, label=name)
    i = int(np.argmin(abs(OMEGA - 0.6)))
    for ax, dof, scale in ((heave, 1, 1e6), (pitch, 2, 1e9)):
        X = 4.0 * data["limit"]["linear"][i, 1, dof]
        ax.plot(phase / deg, (X * np.exp(1j * phase)).real / scale, color="#22262b", lw=0.9, ls=(0, (4, 3)), label="linear")
        ax.set(xlabel="phase of the wave at midship [deg]", xlim=(0, 360))
    heave.set(ylabel="[MN]", title="heave, head sea 8 m high")
    pitch.set(ylabel="[GN m]", title="pitch, the same")
    heave.legend(fontsize=6.5)
