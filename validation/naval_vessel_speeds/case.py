"""A naval vessel whose wave forces are known at five speeds accelerates and turns in an irregular sea."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.frames import to_z_down
from ogilvie.post.spectral import spectral_density
from ogilvie.units import deg

TITLE = "Wave forces at five speeds: a naval vessel accelerates and turns (Marine Systems Simulator)"
ABOUT = """The Marine Systems Simulator holds the wave forces of a multipurpose naval vessel (VERES, z down, clockwise
headings) at 0, 10, 12, 15 and 17 knots. All five drive one vessel of that ship's particulars (navalvessel.m, after Blanke and
Christensen, 1993: 51.5 x 8.6 x 2.3 m, 357 m3, with its inertia, added mass in surge, sway, roll and yaw, GM and resistance;
heave and pitch are held by the long-wave limit of its own heave force, damping and added mass there are taken). In a bow sea
of Hs 1.5 m, Tp 7 s it speeds up from 1 to 7.8 m/s, then turns by 60 degrees. The force has to be what the data of the mean
speed and heading say, and must not jump on the way: what it changes in one step halves with the step, and its fastest change
is that of a Gaussian process of its spectrum. A body too heavy to be moved is drawn along at constant speeds for the forces,
and for the waves that it meets: their frequency is omega - k U cos(b). The force goes by the mean speed of the
last half minute, and its table over speed is linear between the speeds of the data and a few in between: there the force is
exact, in between the line says what that costs."""
NEEDS = ["data/mss_navalvessel/forceRAO_navalvessel.mat"]
HEIGHT = 6.4

RHO, G = 1014.0, 9.81  # of navalvessel.m
LPP, VOLUME, GM, KG, DRAUGHT = 51.5, 357.0, 1.1, 3.36, 2.3
I_XX, I_ZZ = 2.3763e6, 47.934e6  # kg m2
ADDED = np.array([17400.0, 393000.0, 0.0, 774000.0, 0.0, 38.7e6])
RESISTANCE = 1.96e3  # N s2/m2, on u |u|
SEA = {"hs": 1.5, "tp": 7.0, "gamma": 3.3}
RANGE = (0.5, 2.2)  # rad/s
DIRECTION = 150 * deg
SLOW, FAST, NOMINAL = 1.0, 7.8, 8.745 / 1.5  # m/s
SPEEDING, TURNING_AT, END = 40.0, 280.0, 600.0  # s
COURSE = 60 * deg
HEAVY = 1e15  # kg
DOFS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
SOURCE = "forces of the data set"


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the checks and what the figure needs."""
    assert shared is not None
    sets = read(shared / NEEDS[0])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", og.OgilvieWarning)
        data = {"sets": sets, "sea": _sea(0, 120)}
        data["runs"] = {dt: _manoeuvre(sets, data["sea"], dt) for dt in (0.1, 0.05)}
        data["met"] = [_met(sets, relative) for relative in (180.0, 135.0, 90.0, 60.0)]
        checks = [*_constant_speed(sets), *_continuity(data), *_steering(data), *_encounter(data)]
    return checks, data


def read(path: Path) -> list[Any]:
    """Return one data set for each speed: z down and clockwise headings turned into the package's axes."""
    from scipy.io import loadmat

    data = loadmat(path, squeeze_me=True, struct_as_record=False)["RAO"]
    X = np.stack([a * np.exp(1j * p) for a, p in zip(data.Amp, data.Phase, strict=True)], axis=-1)  # (n_w, n_b, n_u, 6)
    nothing = np.zeros((len(data.Freq), 6, 6))
    return [
        og.hydro_from_arrays(
            omega=data.Freq, added_mass=nothing, radiation_damping=nothing, wave_direction=-data.Dir,
            excitation_force=to_z_down(X[:, :, n]), speed=float(u), rho=RHO, g=G,
        )
        for n, u in enumerate(data.Vel)
    ]  # fmt: skip


def _sea(seed: Any, n: int) -> Any:
    return og.irregular(og.jonswap(**SEA), direction=DIRECTION, seed=seed, n=n, omega_range=RANGE)


def vessel(sets: list[Any]) -> Any:
    """Return the ship with speed and heading control."""
    mass = VOLUME * RHO
    body = og.RigidBody(mass=mass, cog=[0.0, 0.0, KG - DRAUGHT], inertia=[I_XX, I_ZZ, I_ZZ])
    C33 = float(np.abs(sets[0].excitation_force.values[0, 6, 2]))  # long waves from the side lift the hull as it stands
    C = np.diag([0.0, 0.0, C33, mass * G * GM, C33 * (0.25 * LPP) ** 2, 0.0])
    A = np.diag(ADDED + [0.0, 0.0, mass, 0.0, body.matrix[4, 4], 0.0])
    memory = og.StateSpace(np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0)), A_inf=A)
    M = np.diag(body.matrix) + np.diag(A)
    D = 2 * np.array([0.0, 0.0, 0.25, 0.1, 0.25, 0.0]) * np.sqrt(np.diag(C) * M)
    u = np.linspace(0.0, 12.0, 25)
    pilot = og.Autopilot(
        [(0.0, 0.0), (TURNING_AT, COURSE)], max_moment=4e6, natural_frequency=0.4, max_rate=1 * deg, added_mass=A,
    )  # fmt: skip
    keeper = og.SpeedKeeping(
        [(0.0, SLOW), (SPEEDING, FAST)], natural_frequency=0.15, added_mass=A, max_thrust=4e5, rate=2e4,
        thrust=RESISTANCE * SLOW**2, max_acceleration=0.15,
    )  # fmt: skip
    loads = (
        og.LinearRestoring(C),
        og.StateSpaceRadiation(memory),
        og.LinearDamping(np.diag(D)),
        og.WaveExcitation(sets),
        og.SurgeResistance.from_table(u, RESISTANCE * u**2),
        og.HullLift(draught=DRAUGHT, x=-0.5 * LPP),
        pilot,
        keeper,
    )
    return og.Vessel(body, loads=loads, speed=NOMINAL)


def _manoeuvre(sets: list[Any], sea: Any, dt: float) -> Any:
    start = {"eta": np.zeros(6), "nu": [SLOW, 0, 0, 0, 0, 0]}
    return og.simulate(vessel(sets), sea, duration=END, dt=dt, initial=start)


def _drawn_along(sets: list[Any], sea: Any, *, nominal: float, speed: float, heading: float, duration: float) -> Any:
    """Return the run of a body that no wave moves, so that the wave force at constant speed and heading is recorded."""
    body = og.RigidBody(mass=HEAVY, cog=[0, 0, 0], inertia=HEAVY * np.array([1e3, 1e3, 1e3]))
    ship = og.Vessel(body, loads=(og.WaveExcitation(sets),), speed=nominal)
    start = {"eta": [0, 0, 0, 0, 0, heading], "nu": [speed, 0, 0, 0, 0, 0]}
    return og.simulate(ship, sea, duration=duration, dt=0.2, initial=start, motions="large")


def _component_sum(hydro: Any, sea: Any, t: np.ndarray, speed: float, heading: float) -> np.ndarray:
    """Return the force (n, 6) along a straight track with the data of one speed."""
    omega, k = sea.omega, sea.omega**2 / 9.80665
    X = og.WaveExcitation(hydro).force(omega, sea.direction - heading)
    phase = np.outer(t, omega - k * speed * np.cos(sea.direction - heading)) + sea.phase
    return (np.exp(1j * phase) @ (sea.amplitude[:, None] * X)).real


def _constant_speed(sets: list[Any]) -> list[dict[str, Any]]:
    sea, heading = _sea(7, 60), 0.7
    checks = []
    for hydro in sets[1:]:
        speed = float(hydro.attrs["speed"]) * (1 - 1e-9)
        found = {}
        for nominal in (speed, NOMINAL) if speed < 1.5 * NOMINAL else (speed,):
            result = _drawn_along(sets, sea, nominal=nominal, speed=speed, heading=heading, duration=100.0)
            wanted = _component_sum(hydro, sea, result.time.values, speed, heading)
            found[nominal] = 100 * np.max(rms(result.force_excitation.values - wanted) / rms(wanted))
        note = "largest of six r.m.s. differences over r.m.s., 100 s on heading 40 deg"
        checks.append(_check(f"force at {speed:.2f} m/s, the nominal speed", found[speed], 0.0, 0.1, "%", SOURCE, note))
        if speed < 1.5 * NOMINAL:
            note = f"linear between {NOMINAL / 4:.2f} m/s apart"
            checks.append(
                _check(f"force at {speed:.2f} m/s of a vessel of nominal {NOMINAL:.2f} m/s", found[NOMINAL], 0.0, 0.5, "%",
                       SOURCE, note)
            )  # fmt: skip
    return checks


def rms(x: np.ndarray) -> np.ndarray:
    """Return the root of the mean square over time."""
    return np.sqrt(np.mean(np.square(x), axis=0))


def level_forces(run: Any) -> np.ndarray:
    """Return the wave force of a run (n, 6) in the horizontal axes that turn with the vessel."""
    from ogilvie.frames import rotation_matrix

    R = np.array([rotation_matrix(phi, theta, 0.0) for phi, theta in run.eta.values[:, 3:5]])
    parts = run.force_excitation.values.reshape(-1, 2, 3)
    return np.einsum("tij,tkj->tki", R, parts).reshape(-1, 6)


def _defined(data: dict[str, Any], every: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the force of a run and what place, heading and speed define, each (n, 6)."""
    run, sea, load = data["runs"][0.05], data["sea"], og.WaveExcitation(data["sets"])
    rows = np.arange(0, run.time.size, every)
    mean = _averaged(run.nu.values[:, 0], float(run.time[1] - run.time[0]))
    k, b = sea.wavenumber, sea.direction
    wanted = []
    for n in rows:
        x, y, psi, u = (float(v) for v in (*run.eta.values[n, [0, 1, 5]], mean[n]))
        X = load.force(sea.omega, b - psi, u)
        phase = sea.omega * float(run.time[n]) - k * (x * np.cos(b) + y * np.sin(b)) + sea.phase
        wanted.append((np.exp(1j * phase) * sea.amplitude @ X).real)
    return level_forces(run)[rows], np.array(wanted)


def _averaged(speed: np.ndarray, dt: float) -> np.ndarray:
    """Return the mean speed that the force goes by: u_m' = (u - u_m) / 30 s from the first speed on, trapezoidal rule."""
    mean, a = np.empty_like(speed), 0.5 * dt / 30.0
    mean[0] = speed[0]
    for n in range(1, len(speed)):
        mean[n] = ((1.0 - a) * mean[n - 1] + a * (speed[n - 1] + speed[n])) / (1.0 + a)
    return mean


def _fastest(data: dict[str, Any]) -> np.ndarray:
    """Return the largest standard deviation (6,) of the force's rate that the spectrum allows on the track."""
    run, sea = data["runs"][0.05], data["sea"]
    load = og.WaveExcitation(data["sets"])
    largest = np.zeros(6)
    for n in range(0, run.time.size, 400):
        u, psi = float(run.nu[n, 0]), float(run.eta[n, 5])
        b = sea.direction - psi
        rate = np.abs(load.force(sea.omega, b, max(u, 0.0))) * np.abs(sea.omega - sea.omega**2 / G * u * np.cos(b))[:, None]
        largest = np.maximum(largest, np.sqrt(0.5 * np.sum((sea.amplitude[:, None] * rate) ** 2, axis=0)))
    return largest


def _continuity(data: dict[str, Any]) -> list[dict[str, Any]]:
    largest = {dt: np.abs(np.diff(run.force_excitation.values, axis=0)).max(axis=0) for dt, run in data["runs"].items()}
    ratio = largest[0.1] / largest[0.05]
    worst = int(np.abs(ratio - 2.0).argmax())
    rates = np.abs(np.diff(level_forces(data["runs"][0.05]), axis=0)).max(axis=0) / 0.05
    fastest = (rates / _fastest(data)).max()
    met, defined = _defined(data, 20)
    apart = 100 * np.max(rms(met - defined) / rms(defined))
    a, b = (data["runs"][dt].force_excitation.values for dt in (0.1, 0.05))
    away = (np.abs(a - b[::2]).max(axis=0) / np.abs(b).max(axis=0)).max()
    return [
        _check("force on the way - that of place, heading and speed", apart, 0.0, 1.0, "%", SOURCE,
               "largest of six r.m.s. differences over r.m.s., every second"),
        _check("largest change of the force in one step of 0.1 s over that of 0.05 s", ratio[worst], 2.0, 0.1, "", "no jumps",
               f"{DOFS[worst]}, the farthest from 2 of six"),
        _check("largest rate of the force over its standard deviation", fastest, 3.3, 1.3, "", "Gaussian process",
               "largest of six; the most of some 200 waves is about 3.3"),
        _check("force with steps of 0.1 s - 0.05 s", 100 * away, 0.0, 1.0, "%", "time step", "of the largest force"),
    ]  # fmt: skip


def _steering(data: dict[str, Any]) -> list[dict[str, Any]]:
    run = data["runs"][0.05]
    late = run.sel(time=slice(END - 100, None))
    settled = run.sel(time=slice(TURNING_AT - 60, TURNING_AT))
    return [
        _check("speed kept before the turn", float(settled.nu.values[:, 0].mean()), FAST, 0.1, "m/s", "set-point", ""),
        _check("speed kept after the turn", float(late.nu.values[:, 0].mean()), FAST, 0.1, "m/s", "set-point", ""),
        _check("heading kept after the turn", float(late.eta.values[:, 5].mean()) / deg, COURSE / deg, 0.5, "deg",
               "set-point", f"standard deviation {float(late.eta.values[:, 5].std()) / deg:.2f} deg in waves"),
    ]  # fmt: skip


def _met(sets: list[Any], relative: float) -> dict[str, Any]:
    """Return the spectrum of the waves met at FAST in this relative direction, and that of the sea seen at speed."""
    heading = DIRECTION - relative * deg
    sea = og.irregular(og.jonswap(**SEA), direction=DIRECTION, seed=range(12), n=300, omega_range=RANGE)
    result = _drawn_along(sets, sea, nominal=NOMINAL, speed=FAST, heading=heading, duration=300.0)
    found = spectral_density(result.elevation.values, dt=0.2, segment=100.0)
    w = np.linspace(*RANGE, 40001)
    met = np.abs(w - w**2 / 9.80665 * FAST * np.cos(relative * deg))
    edges = np.arange(0.0, 7.0, 0.02)
    S = np.histogram(met, edges, weights=og.jonswap(**SEA)(w) * (w[1] - w[0]))[0] / 0.02
    return {
        "relative": relative,
        "omega": found.omega.values,
        "density": np.ravel(found.density.values),
        "expected": (0.5 * (edges[1:] + edges[:-1]), S),
    }


def _encounter(data: dict[str, Any]) -> list[dict[str, Any]]:
    checks = []
    peak = 2 * np.pi / SEA["tp"]
    for met in data["met"]:
        w, S = met["omega"], met["density"]
        mean = np.sum(w * S) / np.sum(S)
        w_e, S_e = met["expected"]
        wanted = np.sum(w_e * S_e) / np.sum(S_e)
        met |= {"peak": peak - peak**2 / 9.80665 * FAST * np.cos(met["relative"] * deg)}
        checks.append(
            _check(f"mean frequency met, waves to {met['relative']:.0f} deg", mean, wanted, 0.03 * wanted, "rad/s",
                   "omega - k U cos(b)", f"{FAST} m/s, 12 realisations of 300 s")
        )  # fmt: skip
        if met["relative"] > 80.0:
            near = S / S.max() > 0.7
            found = np.sum(w[near] * S[near]) / np.sum(S[near])
            checks.append(
                _check(f"peak of the spectrum met, waves to {met['relative']:.0f} deg", found, met["peak"], 0.04 * met["peak"],
                       "rad/s", "omega - k U cos(b)", "centre of what lies above 0.7 of the highest value")
            )  # fmt: skip
    return checks


def _check(name: str, value: float, reference: float, tolerance: float, unit: str, source: str, note: str) -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": float(reference), "tolerance": float(tolerance), "unit": unit,
        "source": source, "note": note,
    }  # fmt: skip


BLUE, RED, GREEN, GREY, INK = "#2f6db0", "#d1495b", "#2e8b57", "#8a8f98", "#22262b"


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw the track in the waves, speed and heading, wave forces, spectra of the waves met."""
    run, sea = data["runs"][0.05], data["sea"]
    grid = fig.add_gridspec(4, 2, width_ratios=[1.0, 1.35], height_ratios=[1.0, 1.0, 1.0, 1.5])
    _track(fig.add_subplot(grid[:3, 0]), run, sea)
    t = run.time.values
    ax = fig.add_subplot(grid[0, 1])
    ax.plot(t, run.nu.values[:, 0], color=BLUE, lw=1.0)
    for hydro in data["sets"]:
        ax.axhline(hydro.attrs["speed"], color=GREY, lw=0.6, ls=":")
    ax.set(ylabel="speed [m/s]", xlim=(0, END), ylim=(0, 9.2))
    ax.set_title("speed (dotted: speeds of the data)", fontsize=8.5)
    ax = fig.add_subplot(grid[1, 1])
    ax.plot(t, run.eta.values[:, 5] / deg, color=RED, lw=1.0)
    ax.set(ylabel="heading [deg]", xlim=(0, END))
    ax = fig.add_subplot(grid[2, 1])
    ax.plot(t, run.force_excitation.values[:, 2] / 1e3, color=BLUE, lw=0.6)
    ax.set(ylabel="heave force [kN]", xlim=(0, END), xlabel="time [s]")
    _forces(fig.add_subplot(grid[3, 0]), data)
    ax = fig.add_subplot(grid[3, 1])
    for met, color in zip(data["met"], ("#1b3a5c", BLUE, GREEN, "#c9971c"), strict=True):
        ax.plot(met["omega"], met["density"], color=color, lw=1.1, label=f"waves to {met['relative']:.0f} deg")
        ax.plot(*met["expected"], color=color, lw=0.8, ls="--")
        if met["relative"] > 80:
            ax.plot(met["peak"], 0.0, "^", color=color, ms=5, clip_on=False, zorder=5)
    ax.set(xlabel="frequency met [rad/s]", ylabel="m2 s/rad", xlim=(0.2, 2.4), ylim=(0, 0.65))
    ax.set_title(f"waves met at {FAST} m/s; dashed: by omega - k U cos b", fontsize=8.5)
    ax.legend(fontsize=6.5, frameon=False)


def _track(ax: Any, run: Any, sea: Any) -> None:
    x, y, psi = (run.eta.values[:, i] for i in (0, 1, 5))
    X, Y = np.meshgrid(np.linspace(x.min() - 250, x.max() + 250, 300), np.linspace(y.min() - 600, y.max() + 500, 300))
    zeta = sea.elevation(np.full(X.size, END), X.ravel(), Y.ravel()).reshape(X.shape)
    ax.pcolormesh(X, Y, zeta, cmap="Blues_r", alpha=0.55, shading="auto", rasterized=True)
    ax.plot(x, y, color=INK, lw=1.0)
    outline = LPP * 3 * np.array([[-0.5, -0.08], [0.25, -0.08], [0.5, 0.0], [0.25, 0.08], [-0.5, 0.08], [-0.5, -0.08]])
    step = round(60.0 / float(run.time.values[1] - run.time.values[0]))
    for n in range(0, len(x), step):
        c, s = np.cos(psi[n]), np.sin(psi[n])
        ax.fill(x[n] + c * outline[:, 0] - s * outline[:, 1], y[n] + s * outline[:, 0] + c * outline[:, 1], color=RED, lw=0)
    ax.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
    ax.set_title("track, ship every 60 s (x 3), sea at the end", fontsize=8.5)
    ax.grid(visible=False)


def _forces(ax: Any, data: dict[str, Any]) -> None:
    """Draw the force about the turn with both steps: the points lie on one smooth curve."""
    for dt, style, color in ((0.05, "-", BLUE), (0.1, ".", RED)):
        run = data["runs"][dt].sel(time=slice(TURNING_AT - 5, TURNING_AT + 35))
        ax.plot(run.time, run.force_excitation.values[:, 5] / 1e6, style, color=color, lw=0.9, ms=2.5, label=f"dt {dt} s")
    ax.set(xlabel="time [s]", ylabel="yaw moment [1e6 N m]")
    ax.set_title("wave moment while the turn begins", fontsize=8.5)
    ax.legend(fontsize=6.5, frameon=False)
