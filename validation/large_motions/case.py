"""Large motions: conservation, closed forms and an independent loop."""

import itertools
import warnings
from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.frames import coriolis_matrix, euler_rate_matrix, matrix_to_z_down, rotation_matrix, to_z_down
from ogilvie.loads.base import Terms
from ogilvie.loads.kernel import Kernel, load_kernel
from ogilvie.units import GRAVITY, deg

TITLE = "Large motions against conservation laws, closed forms and an independent loop"
ABOUT = """What the equations of large motions have to obey, whatever the ship. The energy of a free body with all couplings,
tumbling at 20 degrees of roll and more, is kept to the fifth order of the time step, its motion to the fourth. The same body
with damping and a current is integrated a second time by a loop in plain numpy of Fossen's equations in z-down axes (Coriolis
matrices of the body and of the added mass, Handbook of Marine Craft Hydrodynamics and Motion Control, 2011). A passive fluid
memory takes energy and never gives any back, beside that of the added mass. Thrust and a yaw moment drive a body on a circle
whose speed, drift and radius have a closed form. A current at an angle turns a body that is held by the moment of Munk, (A11 -
A22) u v. Undamped roll of large amplitude has a period that follows from the energy integral, T = 4 int dphi / phi'(phi): of a
ship by its righting levers (`GZRestoring`; hull of the main dimensions of the S175), and of a barge whose buoyancy is
integrated over the hull at each pose (`HullRestoring`), where the wall-sided formula m g sin(phi) (GM + BM/2 tan^2(phi)) is
exact until deck or bilge meet the water. All references are exact."""
NEEDS: list[str] = []
HEIGHT = 6.0

CALM = {"eta": [1.0, 2.0, 0.5, 0.4, 0.2, 0.7], "nu": [2.0, 0.8, 0.3, 0.15, 0.1, 0.12]}
STIFFNESS = np.diag([0.0, 0.0, 8e6, 1.6e8, 4e9, 0.0])
DAMPING = np.diag([3e4, 4e5, 1e5, 3e7, 1e8, 3e8])
STEPS = (0.4, 0.2, 0.1, 0.05)
AMPLITUDES = np.array([5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0])
BARGE = {"length": 60.0, "beam": 12.0, "depth": 10.0, "draught": 4.0}


@load_kernel
def _constant(x, data, own, force):  # type: ignore[no-untyped-def]
    for p in range(6):
        force[p] += data[p]


class Push:
    """A constant force in body axes, as a compiled load."""

    name = "push"
    covers = frozenset({"push"})

    def __init__(self, force: list[float]) -> None:
        self.force = np.array(force)

    def bind(self, surroundings: Any) -> Terms:
        """Return the compiled force."""
        return Terms(kernel=Kernel(_constant, self.force))


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the checks and what the figure needs."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", og.OgilvieWarning)  # Munk's moment turns what nothing holds: on purpose
        data = {
            "energy": _energy(),
            "loop": _independent(),
            "work": _work(),
            "circle": _circle(),
            "munk": _munk(),
            "roll": {"ship": _ship_roll(), "barge": _barge_roll()},
        }
    return _checks(data), data


def heavy() -> tuple[Any, np.ndarray, Any]:
    """Return a body with all couplings, its added mass, and the load of it."""
    body = og.RigidBody(mass=1e7, cog=[0.5, 0.2, 1.0], inertia=np.diag([4e8, 7e9, 7e9]))
    A = np.diag([3e5, 4e6, 6e6, 1.5e8, 2.5e9, 2e9])
    A[1, 5] = A[5, 1] = 2e7
    A[2, 4] = A[4, 2] = -3e7
    A[1, 3] = A[3, 1] = 5e6
    return body, A, og.StateSpaceRadiation(_memoryless(A))


def _memoryless(A: np.ndarray) -> Any:
    return og.StateSpace(np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0)), A_inf=A)


def _energy() -> dict[str, Any]:
    """Return the largest relative change of energy for each time step, and by how much the ends of the runs differ."""
    body, A, radiation = heavy()
    C = STIFFNESS.copy()
    C[2, 4] = C[4, 2] = 5e7
    ship = og.Vessel(body, loads=(og.LinearRestoring(C), radiation))
    drift, ends = [], []
    for dt in STEPS:
        result = og.simulate(ship, duration=80.0, dt=dt, initial=CALM, motions="large", variables=("eta", "nu"))
        nu, eta = result.nu.values, result.eta.values
        energy = 0.5 * np.einsum("ti,ij,tj->t", nu, body.matrix + A, nu) + 0.5 * np.einsum("ti,ij,tj->t", eta, C, eta)
        drift.append(np.abs(energy / energy[0] - 1.0).max())
        ends.append(eta[-1])
    apart = np.array([np.linalg.norm((a - b) / np.abs(ends[-1])) for a, b in itertools.pairwise(ends)])
    return {"drift": np.array(drift), "apart": apart}


def _independent() -> dict[str, Any]:
    """Return the motion by `simulate` and by the loop in z-down axes."""
    body, A, radiation = heavy()
    current = og.Current(0.8, 2.0)
    ship = og.Vessel(body, loads=(og.LinearRestoring(STIFFNESS), radiation, og.LinearDamping(DAMPING), current))
    dt, steps = 0.05, 1200
    result = og.simulate(ship, duration=dt * steps, dt=dt, initial=CALM)
    M_d, A_d, C_d, D_d = (matrix_to_z_down(x) for x in (body.matrix, A, STIFFNESS, DAMPING))
    v_c = to_z_down(np.r_[current.velocity, 0, 0, 0])[:3]
    inverse = np.linalg.inv(M_d + A_d)

    def rates(z: np.ndarray) -> np.ndarray:
        eta, nu = z[:6], z[6:]
        R, T = rotation_matrix(*eta[3:]), euler_rate_matrix(eta[3], eta[4])
        J = np.block([[R, np.zeros((3, 3))], [np.zeros((3, 3)), T]])
        nu_c = np.r_[R.T @ v_c, 0, 0, 0]
        nu_r = nu - nu_c
        slip = np.r_[np.cross(nu[3:], nu_c[:3]), 0, 0, 0]
        force = -coriolis_matrix(M_d, nu) @ nu - coriolis_matrix(A_d, nu_r) @ nu_r - D_d @ nu_r
        return np.r_[J @ nu, inverse @ (force - J.T @ (C_d @ eta) - A_d @ slip)]

    z = np.r_[to_z_down(CALM["eta"]), to_z_down(CALM["nu"])]
    there = [z]
    for _ in range(steps):
        k1 = rates(z)
        k2 = rates(z + 0.5 * dt * k1)
        k3 = rates(z + 0.5 * dt * k2)
        k4 = rates(z + dt * k3)
        z = z + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        there.append(z)
    eta = np.array([to_z_down(z[:6]) for z in there])
    return {"t": result.time.values, "here": result.eta.values, "there": eta}


def memory_model(A_inf: np.ndarray) -> Any:
    """Return oscillators that share dampers with all motions, s b^T (s^2 + s D + W^2)^-1 b: passive by construction."""
    A, B = np.zeros((16, 16)), np.zeros((16, 6))
    scale = np.sqrt([4e5, 3e6, 5e6, 4e7, 2.5e9, 1.2e9])
    for k, dofs in enumerate(([0, 2, 4], [1, 3, 5])):
        q, p = np.arange(8 * k, 8 * k + 4), np.arange(8 * k + 4, 8 * k + 8)
        A[q, p] = 1.0
        A[p, q] = -(np.linspace(0.5, 1.8, 4) ** 2)
        A[p, p] = -np.linspace(0.5, 0.9, 4)
        B[np.ix_(p, dofs)] = np.cos(np.outer(np.arange(4), [1.0, 1.7, 2.3]) + k) * scale[dofs]
    return og.StateSpace(A, B, B.T, A_inf=A_inf)


def _work() -> dict[str, Any]:
    """Return the work that the memory takes in a large motion, beside the energy of the added mass, over the energy."""
    body, A, _ = heavy()
    model, dt = memory_model(A), 0.02
    ship = og.Vessel(body, loads=(og.LinearRestoring(STIFFNESS), og.StateSpaceRadiation(model)))
    result = og.simulate(ship, duration=120.0, dt=dt, initial=CALM, motions="large")
    nu = result.nu.values
    kinetic = 0.5 * np.einsum("ti,ij,tj->t", nu, A, nu)
    power = -np.einsum("ti,ti->t", result.force_radiation.values, nu)
    work = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * dt)]) - (kinetic - kinetic[0])
    eta0, nu0 = (np.array(CALM[key]) for key in ("eta", "nu"))
    energy = 0.5 * nu0 @ (body.matrix + A) @ nu0 + 0.5 * eta0 @ STIFFNESS @ eta0
    return {"t": result.time.values, "share": work / energy}


def _circle() -> dict[str, Any]:
    """Return the run and u, v, r of the steady circle in closed form: surge and sway with the same mass m + a."""
    m, a, d1, d2, d6, X, N = 1e6, 4e5, 2e4, 3e5, 4e7, 2e5, 1.6e6
    body = og.RigidBody(mass=m, cog=[0, 0, 0], inertia=np.diag([4e7, 7e8, 7e8]))
    loads = (
        og.StateSpaceRadiation(_memoryless(np.diag([a, a, a, 1e7, 1e8, 1e8]))),
        og.LinearRestoring(np.diag([0, 0, 8e6, 1e8, 1e9, 0])),
        og.LinearDamping(np.diag([d1, d2, 1e6, 5e7, 1e9, d6])),
        Push([X, 0, 0, 0, 0, N]),
    )
    result = og.simulate(og.Vessel(body, loads=loads), duration=900.0, dt=0.1, output_step=0.5)
    r = N / d6
    u = X / (d1 + (m + a) ** 2 * r**2 / d2)
    return {"run": result, "u": u, "v": -(m + a) * u * r / d2, "r": r}


def _munk() -> dict[str, Any]:
    """Return the yaw moment of the fluid on a body that is held in a current of 1.5 m/s, over the angle, and Munk's."""
    _, A, radiation = heavy()
    held = og.RigidBody(mass=1e15, cog=[0, 0, 0], inertia=np.diag([1e18, 1e18, 1e18]))
    angle = np.linspace(0.0, 180.0, 25) * deg
    moment = []
    for b in angle:
        ship = og.Vessel(held, loads=(radiation, og.Current(1.5, float(b))))
        result = og.simulate(ship, duration=0.2, dt=0.1, initial={"eta": np.zeros(6)})
        moment.append(float(result.force_radiation.values[0, 5]))
    u, v = -1.5 * np.cos(angle), -1.5 * np.sin(angle)
    return {"angle": angle, "moment": np.array(moment), "closed": (A[0, 0] - A[1, 1]) * u * v}


def quarter_period(moment: Any, inertia: float, amplitude: float) -> float:
    """Return T/4 (s) of I phi'' = -moment(phi) from rest at an amplitude (rad), by quadrature of the energy integral."""
    s, weight = np.polynomial.legendre.leggauss(80)
    x = 0.25 * np.pi * (s + 1)
    phi = amplitude * np.sin(x)  # takes the root of phi' at the turning point away
    half = 0.5 * (amplitude - phi)
    energy = half * np.sum(weight * moment(phi[:, None] + half[:, None] * (s + 1)), axis=1)
    return float(0.25 * np.pi * np.sum(weight * amplitude * np.cos(x) / np.sqrt(2 * energy / inertia)))


def period_of(t: np.ndarray, roll: np.ndarray) -> float:
    """Return twice the mean time between passes through zero, found by cubic interpolation."""
    from scipy.interpolate import CubicSpline

    roots = CubicSpline(t, roll).roots(extrapolate=False)
    return float(2 * np.mean(np.diff(roots)))


def _rolls(body: Any, restoring: Any, moment: Any) -> dict[str, Any]:
    """Return periods of free roll from several amplitudes, simulated and by the energy integral."""
    added = 0.2 * body.inertia[0, 0]
    A = np.diag([1e-3 * body.mass] * 3 + [added, 1e-3 * body.inertia[1, 1], 1e-3 * body.inertia[2, 2]])
    ship = og.Vessel(body, loads=(restoring, og.StateSpaceRadiation(_memoryless(A))))
    found, closed = [], []
    for degrees in AMPLITUDES:
        T = 4 * quarter_period(moment, body.inertia[0, 0] + added, degrees * deg)
        start = {"eta": [0, 0, 0, degrees * deg, 0, 0]}
        result = og.simulate(ship, duration=5.2 * T, dt=T / 400, initial=start, motions="large", variables=("eta",))
        closed.append(T)
        found.append(period_of(result.time.values, result.eta.values[:, 3]))
    return {"found": np.array(found), "closed": np.array(closed)}


def _ship_roll() -> dict[str, Any]:
    """Roll of a ship of the main dimensions of the S175 by its righting levers, about O, its centre of gravity there."""
    hull = og.shapes.from_particulars(
        length=175.0,
        beam=25.4,
        draught=9.5,
        cb=0.572,
        cm=0.97,
        cwp=0.711,
        lcb=-0.0142,
        depth=15.4,
        panels=600,
        above_water=True,
    )
    floats = og.RigidBody.from_hull(hull.immersed(), kg=9.55, gyradii=(8.3, 42.0, 42.0))
    curve = og.gz_curve(hull, floats, np.arange(0.0, 61.0, 2.5) * deg)
    C = og.hydrostatics(hull.immersed(), body=floats).stiffness
    body = og.RigidBody(mass=floats.mass, cog=[0.0, 0.0, 0.0], inertia=floats.inertia)
    restoring = og.GZRestoring.from_curve(np.diag(np.diag(C)), curve)
    odd = np.r_[-curve.gz[:0:-1], 0.0, curve.gz[1:]]
    from scipy.interpolate import CubicSpline

    lever = CubicSpline(np.r_[-curve.angles[:0:-1], curve.angles], odd)
    return _rolls(body, restoring, lambda phi: floats.mass * GRAVITY * lever(phi)) | {"gm": curve.gm, "curve": curve}


def _barge_roll() -> dict[str, Any]:
    """Roll of a wall-sided barge, centre of gravity in O, on exact hydrostatics."""
    L, B, D, T = (BARGE[k] for k in ("length", "beam", "depth", "draught"))
    hull = og.shapes.box(L, B, D, panels=200).translated((0, 0, D - T))
    body = og.RigidBody.from_hull(hull.immersed(), zg=0.0, gyradii=(4.0, 15.0, 15.0))
    load = og.HullRestoring(hull, body, heave=1.5, roll=40 * deg, pitch=3 * deg, points=(13, 121, 9))
    BM = B**2 / 12 / T
    GM = BM - T / 2

    def moment(phi: np.ndarray) -> np.ndarray:
        return np.asarray(body.mass * GRAVITY * np.sin(phi) * (GM + 0.5 * BM * np.tan(phi) ** 2))

    return _rolls(body, load, moment) | {"gm": GM}


def _checks(data: dict[str, Any]) -> list[dict[str, Any]]:
    drift = data["energy"]["drift"]
    apart = data["energy"]["apart"]
    order, motion = (float(np.log2(x[-2] / x[-1])) for x in (drift, apart))
    loop, work, circle, munk = (data[k] for k in ("loop", "work", "circle", "munk"))
    away = (np.abs(loop["here"] - loop["there"]).max(axis=0) / np.abs(loop["there"]).max(axis=0)).max()
    nu = circle["run"].nu.values[-1]
    late = circle["run"].eta.values[-round(2 * np.pi / circle["r"] / 0.5) :, :2]
    radius = 0.25 * (np.ptp(late[:, 0]) + np.ptp(late[:, 1]))
    turned = 100 * np.abs(munk["moment"] - munk["closed"]).max() / np.abs(munk["closed"]).max()
    checks = [
        _check("order of the error of the motion in the time step", motion, 4.0, 0.2, "", "order of the method",
               "free body after 80 s"),
        _check("order of the error of its energy", order, 5.0, 0.3, "", "order of the method",
               "of an oscillation; the amplitude of classical Runge-Kutta is of one order more than its phase"),
        _check("energy lost or gained in 80 s, steps of 0.05 s", drift[-1], 0.0, 2e-7, "", "conservation", "of the energy"),
        _check("motion - independent loop in z-down axes", away, 0.0, 1e-9, "", "Fossen's equations",
               "six motions in 60 s, of the largest of each; roll from 23 deg, current 0.8 m/s"),
        _check("least work taken by the memory", min(work["share"].min(), 0.0), 0.0, 1e-6, "", "passivity",
               "of the energy at the start; work on the added mass taken off"),
        _check("speed ahead on the circle", nu[0], circle["u"], 1e-5 * circle["u"], "m/s", "closed form", ""),
        _check("drift on the circle", nu[1], circle["v"], 1e-5 * abs(circle["v"]), "m/s", "closed form", ""),
        _check("radius of the circle", radius, np.hypot(circle["u"], circle["v"]) / circle["r"], 0.05, "m", "closed form", ""),
        _check("moment of Munk in a current", turned, 0.0, 0.01, "%", "(A11 - A22) u v", "25 angles, of the largest"),
    ]  # fmt: skip
    for key, name, part in (("ship", "righting levers of a ship", 1e-4), ("barge", "pressure on a barge", 1e-3)):
        roll = data["roll"][key]
        for degrees in (5.0, 20.0, 35.0):
            i = int(np.flatnonzero(degrees == AMPLITUDES)[0])
            wanted, note = roll["closed"][i], f"GM {roll['gm']:.2f} m"
            what = f"period of roll at {degrees:.0f} deg, {name}"
            checks.append(_check(what, roll["found"][i], wanted, part * wanted, "s", "energy integral", note))
    return checks


def _check(name: str, value: float, reference: float, tolerance: float, unit: str, source: str, note: str) -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": float(reference), "tolerance": float(tolerance), "unit": unit,
        "source": source, "note": note,
    }  # fmt: skip


BLUE, RED, GREEN, INK = "#2f6db0", "#d1495b", "#2e8b57", "#22262b"


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw energy, tumbling motion, work of the memory, circle, moment of Munk, periods of roll."""
    axes = fig.subplots(2, 3).ravel()
    _draw_energy(axes[0], data["energy"])
    _draw_loop(axes[1], data["loop"])
    work, ax = data["work"], axes[2]
    ax.plot(work["t"], 100 * work["share"], color=BLUE, lw=1.1)
    ax.axhline(0.0, color=INK, lw=0.6)
    ax.set(xlabel="time [s]", ylabel="% of the energy at the start", xlim=(0, 120))
    ax.set_title("taken by the fluid memory", fontsize=8.5)
    _draw_circle(axes[3], data["circle"])
    munk, ax = data["munk"], axes[4]
    ax.plot(munk["angle"] / deg, munk["closed"] / 1e6, color=RED, lw=1.1, label="(A11 - A22) u v")
    ax.plot(munk["angle"] / deg, munk["moment"] / 1e6, "o", ms=3.5, mfc="none", color=BLUE, label="simulate")
    ax.axhline(0.0, color=INK, lw=0.6)
    ax.set(xlabel="direction of the current [deg]", ylabel="yaw moment [1e6 N m]", xlim=(0, 180))
    ax.set_title("moment of Munk, 1.5 m/s", fontsize=8.5)
    ax.legend(fontsize=6.5, frameon=False)
    _draw_roll(axes[5], data["roll"])


def _draw_energy(ax: Any, energy: dict[str, Any]) -> None:
    dt, drift = np.array(STEPS), energy["drift"]
    ax.loglog(dt, drift, "o-", color=BLUE, ms=4, lw=1.0)
    ax.loglog(dt, drift[-1] * (dt / dt[-1]) ** 5, "--", color=RED, lw=1.0, label="slope 5")
    ax.set(xlabel="time step [s]", ylabel="largest change / energy")
    ax.set_xticks(dt, [f"{h:g}" for h in dt])
    ax.minorticks_off()
    ax.set_title("energy of a tumbling body", fontsize=8.5)
    ax.legend(fontsize=6.5, frameon=False)


def _draw_loop(ax: Any, loop: dict[str, Any]) -> None:
    for i, color, name in ((3, BLUE, "roll"), (4, RED, "pitch"), (5, GREEN, "yaw / 4")):
        scale = 1 / deg / (4 if i == 5 else 1)
        ax.plot(loop["t"], loop["here"][:, i] * scale, color=color, lw=1.0, label=name)
        ax.plot(loop["t"][::40], loop["there"][::40, i] * scale, "o", color=color, ms=3, mfc="none")
    ax.set(xlabel="time [s]", ylabel="[deg]", xlim=(0, 60))
    ax.set_title("simulate; rings: z-down loop", fontsize=8.5)
    ax.legend(fontsize=6.5, frameon=False, ncols=3, loc="upper right")


def _draw_circle(ax: Any, circle: dict[str, Any]) -> None:
    x, y = circle["run"].eta.values[:, 0], circle["run"].eta.values[:, 1]
    ax.plot(x, y, color=BLUE, lw=1.0)
    turn = round(2 * np.pi / circle["r"] / 0.5)
    cx, cy = x[-turn:].mean(), y[-turn:].mean()
    R, a = np.hypot(circle["u"], circle["v"]) / circle["r"], np.linspace(0, 2 * np.pi, 200)
    ax.plot(cx + R * np.cos(a), cy + R * np.sin(a), "--", color=RED, lw=1.0)
    ax.plot(x[0], y[0], "o", ms=4, color=INK)
    ax.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
    ax.set_title("from rest to the circle", fontsize=8.5)


def _draw_roll(ax: Any, rolls: dict[str, Any]) -> None:
    for key, color, name in (("ship", BLUE, "ship, levers"), ("barge", GREEN, "barge, pressure")):
        roll = rolls[key]
        small = roll["closed"][0]
        ax.plot(AMPLITUDES, roll["closed"] / small, color=color, lw=1.1, label=f"{name} ({small:.1f} s)")
        ax.plot(AMPLITUDES, roll["found"] / small, "o", ms=4, mfc="none", color=color)
    ax.set(xlabel="amplitude of roll [deg]", ylabel="period / period at 5 deg")
    ax.set_title("free roll (lines: exact)", fontsize=8.5)
    ax.legend(fontsize=6.5, frameon=False)
