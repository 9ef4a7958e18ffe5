"""Steering and positioning: course changes, turning circles, dynamic positioning in waves."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.frames import coriolis_matrix, euler_rate_matrix, rotation_matrix
from ogilvie.loads.base import Surroundings
from ogilvie.units import deg

TITLE = "Steering and positioning: course changes, turning circles, position in waves, wind and current"
ABOUT = """Control laws at work in the equations of large motions, against closed forms and against themselves. A ship with the
lines of the S175 (added mass of zero frequency from the panel method, lift and cross-flow drag of the hull, a rudder of 32.5
m2) changes its course by 20 degrees at 10 and 4 m/s: the reference heading is 1 - (1 + wt + (wt)^2/2) exp(-wt) times the step,
the rudder keeps its 35 degrees and 65 degrees in 28 seconds, and at 4 m/s it needs both. With the rudder held it turns in
circles. No measurement is compared, and heel is not to be relied on: it is a small difference of large moments, and the theory
of a uniform stream leaves the steady flow about the hull out of them. Speed, drift, rate of turn and heel have to be a
solution of the steady equations, which are written out here and solved on their own. A zig-zag (20/20) has to be the same at
half the time step.

An offshore vessel of 80 m keeps its position against waves (Hs 2.5 m, Tp 8.5 s), a drift force that follows their envelope,
gusty wind of 12 m/s and a current of 0.6 m/s by three thrusters, with and without the wave filter. The filter has to take the
waves off the thrusters and leave the accuracy; what it lets through at wave frequency is compared with the transfer function
of the passive observer (Fossen and Strand 1999) written out in closed form. Limits of thrust and of its rate are kept exactly.
The drift coefficients are taken, not computed."""
NEEDS: list[str] = []
HEIGHT = 8.4

STEP, AT, FREQUENCY = 20 * deg, 20.0, 0.09  # rad, s, rad/s of the autopilot and its reference
SPEEDS = (10.0, 4.0)  # m/s
RUDDERS = (10.0, 20.0, 35.0)  # deg
SHIP = {"kg": 9.55, "gyradii": (8.3, 42.0, 42.0)}
LPP = 175.0
DP_TIME, DP_FROM = 1800.0, 600.0  # s
PEAK = 2 * np.pi / 8.5  # rad/s
POSITION = ("x", "y", "heading")


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the checks and what the figure needs."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", og.OgilvieWarning)
        ship = _ship()
        data: dict[str, Any] = {"course": {U: _course(ship, U) for U in SPEEDS}}
        data["circle"] = {angle: _circle(ship, angle * deg) for angle in RUDDERS}
        data["zigzag"] = {dt: _zigzag(ship, dt) for dt in (0.2, 0.1)}
        data["positioning"] = _positioning()
    return [*_course_checks(data), *_circle_checks(data), *_zigzag_checks(data), *_dp_checks(data["positioning"])], data


def _ship() -> dict[str, Any]:
    """Return hull, body, stiffness, added mass and rudder of the container ship."""
    hull = og.shapes.s175(panels=500)
    body = og.RigidBody.from_hull(hull, **SHIP)
    hydro = og.solve_bem(hull, body, omega=[0.1, 0.2, 0.3, 0.4], progress=False)
    A = hydro.added_mass_zero.values
    C = hydro.hydrostatic_stiffness.values
    roll = 0.2 * np.sqrt(C[3, 3] * (body.matrix + A)[3, 3])  # 10 % of critical
    rudder = og.Rudder(32.5, 1.83, position=[-0.5 * LPP, 0.0, -5.0], hull_interaction=0.2, hull_position=-80.0)
    return {"hull": hull, "body": body, "A": 0.5 * (A + A.T), "C": C, "rudder": rudder, "roll": roll}


def _loads(ship: dict[str, Any], speed: float) -> dict[str, Any]:
    """Return the loads on the ship but for its rudder."""
    memory = og.StateSpace(np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0)), A_inf=ship["A"])
    return {
        "restoring": og.LinearRestoring(ship["C"]),
        "radiation": og.StateSpaceRadiation(memory),
        "lift": og.HullLift(draught=9.5, x=-0.5 * LPP),
        "drag": og.CrossFlowDrag.from_hull(ship["hull"]),
        "resistance": og.SurgeResistance(area=5500.0, length=LPP, form_factor=0.2, allowance=4e-4, balanced_at=speed),
        "roll": og.RollDamping(linear=ship["roll"]),
    }


def _course(ship: dict[str, Any], speed: float) -> Any:
    pilot = og.Autopilot([(0.0, 0.0), (AT, STEP)], ship["rudder"], natural_frequency=FREQUENCY, added_mass=ship["A"])
    vessel = og.Vessel(ship["body"], loads=(*_loads(ship, speed).values(), pilot), speed=speed)
    return og.simulate(vessel, duration=400.0, dt=0.1)


def _steered(ship: dict[str, Any], speed: float, angle: Any, dt: float, duration: float) -> Any:
    """Return a run with the rudder at angle(t, heading), rad."""
    rudder = ship["rudder"]
    force = og.UserForce(lambda t, eta, nu: rudder.force(angle(t, eta[5]), nu=nu), dt, name="rudder")
    vessel = og.Vessel(ship["body"], loads=(*_loads(ship, speed).values(), force), speed=speed)
    return og.simulate(vessel, duration=duration, dt=dt)


def _circle(ship: dict[str, Any], angle: float) -> dict[str, Any]:
    """Return the run with the rudder put over at AT, and the steady turn of the equations alone."""
    speed, rate = SPEEDS[0], ship["rudder"].rate
    result = _steered(
        ship, speed, lambda t, psi: min(angle, max(0.0, rate * (t - AT))), 0.2, 1400.0 if angle > 15 * deg else 2400.0
    )
    return {"run": result, "steady": _steady_turn(ship, speed, angle, result)}


def _steady_turn(ship: dict[str, Any], speed: float, angle: float, result: Any) -> dict[str, float]:
    """Return u, v, rate of turn, heel of the steady turn: a root of the equations, written out here.

    Momentum P = A (nu - U e1); 0 = force - C_RB(nu) nu - (w x P1, w x P2 + v x P1), with the turn about the vertical.
    """
    from scipy.optimize import root

    bound = {k: load.bind(Surroundings(ship["body"], speed)) for k, load in _loads(ship, speed).items()}
    M, A = ship["body"].matrix, ship["A"]

    def velocity(q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        u, v, turn, z, phi, theta = q
        R = rotation_matrix(phi, theta, 0.0)
        omega = R.T @ [0.0, 0.0, turn]
        w = -(R[2, 0] * u + R[2, 1] * v) / R[2, 2]  # no vertical velocity
        return np.r_[0.0, 0.0, z, phi, theta, 0.0], np.r_[u, v, w, omega]

    def residual(q: np.ndarray) -> np.ndarray:
        eta, nu = velocity(q)
        R = rotation_matrix(*eta[3:])
        J = np.block([[R, np.zeros((3, 3))], [np.zeros((3, 3)), euler_rate_matrix(eta[3], eta[4])]])
        force = -J.T @ (ship["C"] @ eta) + ship["rudder"].force(angle, nu=nu)
        for key in ("lift", "drag", "resistance"):
            force = force + bound[key].kernel.force(eta=eta, nu=nu)
        force[3] -= ship["roll"] * nu[3]
        P = A @ (nu - speed * np.eye(6)[0])
        P[[0, 4]] -= A[[0, 4], 0] * (nu[0] - speed)  # the uniform stream has no momentum of its own
        fluid = np.r_[np.cross(nu[3:], P[:3]), np.cross(nu[3:], P[3:]) + np.cross(nu[:3], P[:3])]
        return (force - coriolis_matrix(M, nu) @ nu - fluid) / np.array([1e6, 1e6, 1e7, 1e8, 1e9, 1e8])

    nu = result.nu.values[-1]
    start = np.r_[0.8 * nu[0], 0.8 * nu[1], 0.8 * nu[5], 0.0, 0.0, 0.0]  # not the answer itself
    found = root(residual, start, tol=1e-12)
    assert found.success, found.message
    u, v, turn, _, phi, _ = found.x
    return {"u": u, "v": v, "turn": turn, "heel": phi}


def _zigzag(ship: dict[str, Any], dt: float) -> Any:
    """Return run and rudder of a 20/20 zig-zag."""
    state, rate = {"angle": 0.0, "side": 1.0}, ship["rudder"].rate
    record = []

    def angle(t: float, psi: float) -> float:
        if t >= AT:
            if state["side"] * psi > 20 * deg:
                state["side"] = -state["side"]
            wanted = state["side"] * 20 * deg
            state["angle"] += float(np.clip(wanted - state["angle"], -rate * dt, rate * dt))
        record.append(state["angle"])
        return state["angle"]

    result = _steered(ship, SPEEDS[0], angle, dt, 500.0)
    return {"run": result, "rudder": np.array(record)}


# ------------------------------------------------------------------------------------------------------------ positioning


def _offshore() -> dict[str, Any]:
    hull = og.shapes.from_particulars(length=80.0, beam=18.0, draught=6.0, cb=0.68, cm=0.95, cwp=0.82, panels=500)
    body = og.RigidBody.from_hull(hull, zg=1.0, gyradii=(6.3, 20.0, 20.0))
    omega = np.r_[0.1, 0.2, np.arange(0.3, 1.5, 0.1), np.arange(1.6, 2.7, 0.2)]
    hydro = og.solve_bem(hull, body, omega=omega, wave_direction=np.arange(0.0, 181.0, 30.0) * deg, progress=False)
    model = og.identify(og.retardation(hydro))
    return {"hull": hull, "body": body, "hydro": hydro, "model": model}


def _drift(sea: Any) -> Any:
    """Return the slow force (n, 3) over whole seconds: taken coefficients times the square of the wave envelope."""
    t = np.arange(0.0, DP_TIME + 1.0, 1.0)
    envelope = np.abs(np.exp(1j * (np.outer(t, sea.omega) + sea.phase)) @ sea.amplitude)
    return np.outer(envelope**2, [-9e3, 1.2e4, 1.5e5])


def _positioning() -> dict[str, Any]:
    vessel = _offshore()
    sea = og.irregular(og.jonswap(hs=2.5, tp=8.5, gamma=3.3), direction=160 * deg, n=200, seed=4, omega_range=(0.4, 2.2))
    fleet = (
        og.Thruster([-36.0, 5.0, -5.0], azimuth=True, max_thrust=4e5, rate=6e4, name="port"),
        og.Thruster([-36.0, -5.0, -5.0], azimuth=True, max_thrust=4e5, rate=6e4, name="starboard"),
        og.Thruster([34.0, 0.0, -4.0], direction=np.pi / 2, max_thrust=2.5e5, rate=6e4, name="bow"),
    )
    slow = _drift(sea)
    shape = {"frontal_area": 220.0, "lateral_area": 620.0, "length": 80.0, "centroid_height": 5.0}
    coefficients = og.blendermann_wind("offshore supply vessel", **shape)
    wind = og.Wind(12.0, 130 * deg, gust="npd", seed=1, period=DP_TIME)
    A = vessel["hydro"].added_mass_zero.values
    loads = (
        og.LinearRestoring(vessel["hydro"]),
        og.StateSpaceRadiation(vessel["model"]),
        og.WaveExcitation(vessel["hydro"]),
        og.RollDamping(ratio=0.08),
        og.CrossFlowDrag.from_hull(vessel["hull"]),
        og.Current(0.6, 120 * deg),
        og.WindForce(coefficients, wind, height=10.0),
        og.UserForce(lambda t, eta, nu: _held(slow, t), 1.0, name="drift"),
    )
    laws, runs = {}, {}
    for name, wave_filter in (("with filter", og.WaveFilter(PEAK)), ("without filter", None)):
        law = og.DynamicPositioning([0.0, 0.0, 0.0], fleet, natural_frequency=0.06, added_mass=A, wave_filter=wave_filter)
        laws[name] = law
        runs[name] = og.simulate(
            og.Vessel(vessel["body"], loads=(*loads, law)), sea, duration=DP_TIME, dt=0.1, initial="rest", ramp=60.0
        )
    M = vessel["body"].matrix + A
    return {"runs": runs, "fleet": fleet, "laws": laws, "mass": M[0, 0]}


def _held(slow: np.ndarray, t: float) -> list[float]:
    x, y, n = slow[min(int(t), len(slow) - 1)]
    return [x, y, 0.0, 0.0, 0.0, n]


def thrusts(result: Any, fleet: Any) -> np.ndarray:
    """Return the size of each thruster's thrust (n, 3) and, for the rate, its vector (n, 3, 2)."""
    out = np.zeros((result.time.size, len(fleet), 2))
    for i, unit in enumerate(fleet):
        label = f"positioning_thrust of {unit.name}"
        for c, words in enumerate((" forward", " to port") if unit.azimuth else ("",)):
            out[:, i, c] = result[(label + words).replace(" ", "_")].values
    return out


def observer_gain(law: Any, mass: float, omega: np.ndarray) -> np.ndarray:
    """Return |estimated / measured position| of the passive observer at frequencies (rad/s), written out."""
    f = law.wave_filter
    wo, wc, wb = float(np.ravel(f.wave_frequency)[0]), f.cutoff, f.bandwidth
    l, z, s = f.wave_damping, f.notch_damping, 1j * omega
    part = 1 + 2 * (z - l) * wc / wo
    fast = wc / part - 2 * wb
    wave = (2 * wo * (z - l) * s + wo**2 * 2 * (z - l) * wc / wo) / (s**2 + 2 * l * wo * s + wo**2)
    low = (wc + part * mass * (wb**2 + 2 * wb * fast + fast * wb**2 / s) / (mass * s)) / s
    return np.abs(low / (1 + wave + low))


def _spectral_gain(result: Any, dof: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return frequencies, gain from measured to estimated position, and spectrum of the measured one."""
    from scipy.signal import csd, welch

    late = result.sel(time=slice(DP_FROM, None))
    y, x = late.eta.values[:, dof], late[f"positioning_estimated_{POSITION[dof]}".replace(" ", "_")].values
    options = {"fs": 10.0, "nperseg": 2048, "detrend": "linear"}
    f, S_y = welch(y, **options)
    return 2 * np.pi * f, np.abs(csd(y, x, **options)[1]) / S_y, S_y / (2 * np.pi)


# ------------------------------------------------------------------------------------------------------------------ checks


def closed_reference(t: np.ndarray) -> np.ndarray:
    """Return the heading of the reference filter, rad."""
    wt = FREQUENCY * np.maximum(t - AT, 0.0)
    return STEP * (1 - (1 + wt + 0.5 * wt**2) * np.exp(-wt))


def _course_checks(data: dict[str, Any]) -> list[dict[str, Any]]:
    checks = []
    for speed, result in data["course"].items():
        t, angle = result.time.values, result["autopilot_rudder_angle"].values
        reference = result["autopilot_heading_reference"].values
        sampled = np.isclose(t / 0.5, np.round(t / 0.5))  # it is held between the samples
        away = np.abs(reference - closed_reference(t))[sampled].max() / deg
        turn = np.abs(np.diff(angle[sampled])).max() / 0.5 / deg
        checks += [
            _check(f"reference heading at {speed:g} m/s - closed form", away, 0.0, 1e-6, "deg", "closed form", ""),
            _check(f"heading in the end at {speed:g} m/s", float(result.eta[-1, 5]) / deg, 20.0, 0.5, "deg", "set-point",
                   f"largest heading {float(result.eta[:, 5].max()) / deg:.1f} deg"),
        ]  # fmt: skip
        if speed == SPEEDS[1]:
            largest, note = np.abs(angle).max() / deg, "has to be reached"
            checks += [
                _check(f"largest rudder angle at {speed:g} m/s", largest, 35.0, 1e-9, "deg", "limit", note),
                _check(f"largest rate of the rudder at {speed:g} m/s", turn, 65.0 / 28.0, 1e-9, "deg/s", "limit", note),
            ]
    return checks


def _circle_checks(data: dict[str, Any]) -> list[dict[str, Any]]:
    checks = []
    for angle, circle in data["circle"].items():
        eta, nu, steady = circle["run"].eta.values[-1], circle["run"].nu.values[-1], circle["steady"]
        turn = float(np.diff(circle["run"].eta.values[-11:, 5]).mean()) / 0.2
        radius = np.hypot(steady["u"], steady["v"]) / abs(steady["turn"]) / LPP
        drift = np.arctan2(-steady["v"], steady["u"]) / deg
        note = f"radius {radius:.2f} L, drift angle {drift:.1f} deg, speed {np.hypot(steady['u'], steady['v']):.2f} m/s"
        for what, value, wanted, unit in (
            ("speed ahead", nu[0], steady["u"], "m/s"),
            ("lateral speed", nu[1], steady["v"], "m/s"),
            ("rate of turn", turn / deg, steady["turn"] / deg, "deg/s"),
            ("heel", eta[3] / deg, steady["heel"] / deg, "deg"),
        ):
            name = f"{what} in the turn, rudder {angle:.0f} deg"
            allowed = 0.005 if what == "heel" else 1e-3 * abs(wanted)  # heel is a small difference of large moments
            checks.append(_check(name, value, wanted, allowed, unit, "root of the steady equations", note))
            note = ""
    return checks


def _overshoots(zigzag: dict[str, Any]) -> np.ndarray:
    psi = zigzag["run"].eta.values[:, 5] / deg
    turning = np.flatnonzero(np.diff(np.sign(np.diff(psi)))) + 1
    return np.array([abs(p) - 20.0 for p in psi[turning] if abs(p) > 20.0][:3])


def _zigzag_checks(data: dict[str, Any]) -> list[dict[str, Any]]:
    coarse, fine = (_overshoots(data["zigzag"][dt]) for dt in (0.2, 0.1))
    return [
        _check(f"zig-zag 20/20, overshoot {i + 1}", a, b, 0.2, "deg", "half the time step", "from 10 m/s")
        for i, (a, b) in enumerate(zip(coarse[:2], fine[:2], strict=True))
    ]


def _dp_checks(dp: dict[str, Any]) -> list[dict[str, Any]]:
    checks, rates, offsets = [], {}, {}
    highest, fastest = (np.array([getattr(unit, key) for unit in dp["fleet"]]) for key in ("max_thrust", "rate"))
    for name, result in dp["runs"].items():
        late = result.sel(time=slice(DP_FROM, None))
        u = thrusts(result, dp["fleet"])[::5]
        over = (np.hypot(u[..., 0], u[..., 1]) / highest).max()
        step = (np.hypot(*np.moveaxis(np.diff(u, axis=0), -1, 0)) / 0.5 / fastest).max()
        rates[name] = (np.diff(thrusts(late, dp["fleet"])[::5], axis=0) / 0.5).std(axis=0)
        offsets[name] = late.eta.values[:, [0, 1, 5]]
        for what, value in (("thrust", over), ("rate of thrust", step)):
            excess = max(value - 1.0, 0.0)
            note = f"largest {value:.3f} of the limit"
            checks.append(_check(f"{what} beyond its limit, {name}", excess, 0.0, 1e-9, "", "limit", note))
    active = rates["without filter"] > 0.0
    ratio = (rates["with filter"][active] / rates["without filter"][active]).max()
    note = "standard deviation, largest ratio of the three thrusters' components"
    checks.append(_check("rate of thrust with filter over that without", ratio, 0.0, 0.2, "", "bound", note))
    for name, offset in offsets.items():
        mean, spread = offset.mean(axis=0), offset.std(axis=0)
        note = f"standard deviation {spread[0]:.2f} m, {spread[1]:.2f} m, {spread[2] / deg:.2f} deg, waves included"
        worst = float(np.hypot(*mean[:2]))
        checks.append(_check(f"mean distance from the set-point, {name}", worst, 0.0, 0.5, "m", "integral action", note))
        checks.append(_check(f"mean heading, {name}", mean[2] / deg, 0.0, 0.5, "deg", "integral action", ""))
    return [*checks, *_gain_checks(dp)]


def _gain_checks(dp: dict[str, Any]) -> list[dict[str, Any]]:
    w, gain, S = _spectral_gain(dp["runs"]["with filter"], 0)
    dp["gain"] = (w, gain, observer_gain(dp["laws"]["with filter"], dp["mass"], np.maximum(w, 1e-9)))
    waves = (w > 0.85 * PEAK) & (w < 1.25 * PEAK)
    found = np.sqrt(np.sum(gain[waves] ** 2 * S[waves]) / np.sum(S[waves]))
    closed = np.sqrt(np.sum(dp["gain"][2][waves] ** 2 * S[waves]) / np.sum(S[waves]))
    note = "surge, mean over the waves' frequencies; from the spectra of measured and estimated position"
    return [_check("what the observer lets through at wave frequency", found, closed, 0.03, "", "closed form", note)]


def _check(name: str, value: float, reference: float, tolerance: float, unit: str, source: str, note: str) -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": float(reference), "tolerance": float(tolerance), "unit": unit,
        "source": source, "note": note,
    }  # fmt: skip


# ------------------------------------------------------------------------------------------------------------------ figure

BLUE, RED, GREEN, AMBER, GREY, INK = "#2f6db0", "#d1495b", "#2e8b57", "#c9971c", "#8a8f98", "#22262b"


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw course changes with rudder, turning circles and zig-zag, positions and thrusts, the observer's gain."""
    grid = fig.add_gridspec(4, 6, height_ratios=[1.0, 1.0, 1.35, 1.15])
    _draw_course(fig.add_subplot(grid[0, :3]), fig.add_subplot(grid[1, :3]), data["course"])
    _draw_circles(fig.add_subplot(grid[:2, 3:]), data["circle"])
    _draw_zigzag(fig.add_subplot(grid[2, :2]), data["zigzag"][0.1])
    dp = data["positioning"]
    _draw_positions(fig.add_subplot(grid[2, 2:4]), dp)
    _draw_gain(fig.add_subplot(grid[2, 4:]), dp)
    _draw_thrust(fig.add_subplot(grid[3, :]), dp)


def _draw_course(top: Any, bottom: Any, course: dict[float, Any]) -> None:
    for (speed, result), color in zip(course.items(), (BLUE, RED), strict=True):
        t = result.time.values
        top.plot(t, result.eta.values[:, 5] / deg, color=color, lw=1.1, label=f"{speed:g} m/s")
        bottom.plot(t, result["autopilot_rudder_angle"].values / deg, color=color, lw=1.0)
    top.plot(t, closed_reference(t) / deg, "--", color=INK, lw=0.9, label="reference, closed form")
    for limit in (-35.0, 35.0):
        bottom.axhline(limit, color=GREY, lw=0.7, ls=":")
    top.set(xlim=(0, 300), ylabel="heading [deg]")
    top.set_title("course change of 20 deg", fontsize=8.5)
    top.legend(fontsize=6.5, frameon=False, loc="lower right")
    bottom.set(xlim=(0, 300), ylim=(-40, 40), xlabel="time [s]", ylabel="rudder [deg]")


def _draw_circles(ax: Any, circles: dict[float, Any]) -> None:
    outline = LPP * np.array([[-0.5, -0.07], [0.3, -0.07], [0.5, 0.0], [0.3, 0.07], [-0.5, 0.07]])
    for (angle, circle), color in zip(circles.items(), (BLUE, GREEN, RED), strict=True):
        eta, steady = circle["run"].eta.values, circle["steady"]
        radius = np.hypot(steady["u"], steady["v"]) / abs(steady["turn"])
        ax.plot(eta[:, 0], eta[:, 1], color=color, lw=1.0, label=f"{angle:.0f} deg: {radius / LPP:.1f} L")
        for n in range(0, len(eta), 500):
            c, s = np.cos(eta[n, 5]), np.sin(eta[n, 5])
            x, y = eta[n, 0] + c * outline[:, 0] - s * outline[:, 1], eta[n, 1] + s * outline[:, 0] + c * outline[:, 1]
            ax.fill(x, y, color=color, alpha=0.45, lw=0)
    ax.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
    ax.set_title("turning circles from 10 m/s, ship every 100 s", fontsize=8.5)
    ax.legend(fontsize=6.5, frameon=False, title="rudder: radius", title_fontsize=6.5, loc="upper left")


def _draw_zigzag(ax: Any, zigzag: dict[str, Any]) -> None:
    result = zigzag["run"]
    t = result.time.values
    ax.plot(t, result.eta.values[:, 5] / deg, color=BLUE, lw=1.1, label="heading")
    ax.plot(t[: len(zigzag["rudder"])], zigzag["rudder"][: len(t)] / deg, color=RED, lw=0.9, label="rudder")
    ax.set(xlim=(0, 500), xlabel="time [s]", ylabel="[deg]")
    ax.set_title("zig-zag 20/20, 10 m/s", fontsize=8.5)
    ax.legend(fontsize=6.5, frameon=False, loc="lower left", ncols=2)


def _draw_positions(ax: Any, dp: dict[str, Any]) -> None:
    for (name, result), color in zip(dp["runs"].items(), (BLUE, RED), strict=True):
        late = result.sel(time=slice(DP_FROM, None))
        ax.plot(late.eta.values[:, 1], late.eta.values[:, 0], color=color, lw=0.35, label=name)
    ax.plot(0.0, 0.0, "+", color=INK, ms=9, mew=1.2)
    ax.set(xlabel="y [m]", ylabel="x [m]", aspect="equal")
    ax.invert_xaxis()
    ax.set_title("position, 20 min", fontsize=8.5)
    ax.legend(fontsize=6.5, frameon=False, loc="upper left")


def _draw_gain(ax: Any, dp: dict[str, Any]) -> None:
    w, gain, closed = dp["gain"]
    use = (w > 0.02) & (w < 1.6)
    ax.plot(w[use], closed[use], color=RED, lw=1.1, label="closed form")
    waves = use & (w > 0.55)
    ax.plot(w[waves], gain[waves], ".", color=BLUE, ms=3, label="from the run")
    ax.axvline(PEAK, color=GREY, lw=0.8, ls=":")
    ax.set(xlabel="[rad/s]", ylim=(0, None), xlim=(0, 1.6))
    ax.set_title("observer: out / in", fontsize=8.5)
    ax.legend(fontsize=6.5, frameon=False)


def _draw_thrust(ax: Any, dp: dict[str, Any]) -> None:
    for (name, result), color in zip(list(dp["runs"].items())[::-1], (RED, BLUE), strict=True):
        u = thrusts(result, dp["fleet"])
        ax.plot(result.time, u[:, 2, 0] / 1e3, color=color, lw=0.7, label=name)
    for limit in (-250.0, 250.0):
        ax.axhline(limit, color=GREY, lw=0.7, ls=":")
    ax.set(xlim=(0, 900), xlabel="time [s]", ylabel="thrust [kN]")
    ax.set_title("bow thruster (dotted: its limits)", fontsize=8.5)
    ax.legend(fontsize=6.5, frameon=False, ncols=2, loc="lower right")
