"""Paper C: the naval combatant DTMB 5415 at 18 knots in the time domain, small and large motions."""

import importlib.util
import sys
import warnings
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.post.spectral import spectral_density
from ogilvie.sim.system import assemble
from ogilvie.units import deg

TITLE = "DTMB 5415 at 18 knots in the time domain (Vu et al.)"
ABOUT = """The simulation of Vu et al.: DTMB 5415 at 18 knots, JONSWAP with Hs 4.25 m, Tp 9.8 s (peakedness 3.3 taken here),
head sea. They show six time series without one number that could be read off, and neither seed nor peakedness: there is
nothing to be compared with. What is compared here is the package with itself, time domain with frequency domain. Hull and
coefficients of zero speed are those of `paper_c_dtmb5415`; the memory is identified once, at zero speed. Regular waves: the
motion of the time loop against the transfer function of the same equations at the signed frequency of encounter, which is
negative in waves that the ship overtakes, and against `rao` on the coefficients themselves, which tells what the
identification costs. Irregular waves: significant double amplitudes (4 standard deviations) of all realisations; allowed are
3.5 standard deviations of that estimate, which follow from the spectrum of the response and the time simulated. In
long-crested head seas a ship that is its own mirror image has three motions; for six a short-crested sea (cos^2 about the same
direction) is run too. Large motions meet the waves where the ship is and at the heading it has; thrust balances the resistance
at 18 knots and the speed is what comes of it: no drift force (added resistance) is in these equations, and what products of
first-order quantities leave is 1 % of the resistance. Taken, since the paper gives none: 5 % of critical roll damping, lift of
the hull with its draught at the after end, and in place of a helmsman springs in sway and yaw (periods near 40 s) with damping
in yaw, without which this hull leaves its course. Nothing of the paper's ship but its hull and its radii is tuned."""
NEEDS: list[str] = []
HEIGHT = 7.4

DT, DURATION = 0.1, 1200.0  # s
RUNS = {"long": 60, "short": 30}  # realisations of small motions
LARGE_RUNS = 6
SEA = {"hs": 4.25, "tp": 9.8, "gamma": 3.3}
WAVES = (0.3, 1.4)  # rad/s
ROLL_RATIO = 0.05  # of critical
HELM = {"period": 40.0, "damping": 0.3}  # s, of critical: what stands for a helmsman in yaw
REGULAR = {180.0: (0.5, 0.7, 1.0), 135.0: (0.5, 0.7, 1.0), 90.0: (0.5, 0.7, 1.0), 45.0: (0.5, 0.8, 1.3), 0.0: (0.5, 0.8, 1.3)}
NAMES = {180.0: "head", 135.0: "bow", 90.0: "beam", 45.0: "quartering", 0.0: "following"}
DOFS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
SCALE = np.array([1.0, 1.0, 1.0, 1 / deg, 1 / deg, 1 / deg])
SIGMAS = 3.5


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the checks and what the figure needs."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", og.OgilvieWarning)  # short waves left out, encounters beyond the data: see ABOUT
        paper = _frequency_domain()
        ship = paper.prepared(shared, np.arange(0.0, 181.0, 30.0) * deg)
        vessel = _vessel(ship)
        data = {"ship": ship, "vessel": vessel, "long": _irregular(vessel, "long"), "short": _irregular(vessel, "short")}
        data["large"] = _large(ship, vessel, data["long"])
        data["regular"] = _regular(vessel)
        data["rao"] = _rao(ship, vessel)
    return [*_regular_checks(data), *_irregular_checks(data), *_large_checks(data)], data


def _frequency_domain() -> ModuleType:
    """Return the case of the frequency domain."""
    path = Path(__file__).parent.parent / "paper_c_dtmb5415" / "case.py"
    spec = importlib.util.spec_from_file_location("paper_c_dtmb5415_of_time", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def _vessel(ship: Any) -> Any:
    model = og.identify(og.retardation(ship.hydro0), mass=ship.body.matrix, stiffness=ship.hydro0.hydrostatic_stiffness.values)
    M = ship.body.matrix + ship.hydro0.added_mass_zero.values
    w = 2 * np.pi / HELM["period"]
    yaw = 2 * HELM["damping"] * w * M[5, 5]
    loads = (
        og.LinearRestoring(ship.hydro0),
        og.StateSpaceRadiation(model),
        og.WaveExcitation(ship.hydro0),
        og.RollDamping(ratio=ROLL_RATIO),
        og.HullLift(draught=6.15, x=-71.0),
        og.LinearMooring(np.diag([0, 0.5 * M[1, 1], 0, 0, 0, M[5, 5]]) * w**2),
        og.LinearDamping(np.diag([0, 0, 0, 0, 0, yaw])),
    )
    return og.Vessel(ship.body, loads=loads, speed=ship.speed)


def _transfer(vessel: Any, omega: np.ndarray, direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return signed encounter frequencies (n,) and motions (n, 6) per metre of wave amplitude from the vessel's equations."""
    excitation = next(load for load in vessel.loads if isinstance(load, og.WaveExcitation))
    omega_e = omega - omega**2 / 9.80665 * vessel.speed * np.cos(direction)
    force = excitation.force(omega, direction, vessel.speed)
    return omega_e, np.linalg.solve(assemble(vessel).impedance(omega_e), force[:, :, None])[:, :, 0]


def _regular(vessel: Any) -> list[dict[str, Any]]:
    """Return for each regular wave the motion of the time loop and of the transfer function."""
    found = []
    for heading, frequencies in REGULAR.items():
        for omega in frequencies:
            direction = heading * deg
            omega_e, wanted = (v[0] for v in _transfer(vessel, np.array([omega]), np.array([direction])))
            duration = max(60.0, 3 * 2 * np.pi / abs(omega_e))
            wave = og.regular(amplitude=1.0, omega=omega, direction=direction)
            result = og.simulate(vessel, wave, duration=duration, dt=0.05, variables=("eta",))
            t = result.time.values
            basis = np.stack([np.cos(omega_e * t), -np.sin(omega_e * t), np.ones_like(t)], axis=1)
            c = np.linalg.lstsq(basis, result.eta.values, rcond=None)[0]
            away = np.abs(result.eta.values - (np.exp(1j * omega_e * t)[:, None] * wanted).real).max(axis=0)
            here = {"heading": heading, "omega": omega, "omega_e": omega_e, "motion": c[0] + 1j * c[1], "wanted": wanted}
            found.append(here | {"away": away})
    return found


def _rao(ship: Any, vessel: Any) -> list[dict[str, Any]]:
    """Return heave and pitch by `rao` from the coefficients, and by the vessel's equations, for each heading of the data."""
    from ogilvie.hydro.at_speed import at_speed

    sailing = at_speed(ship.hydro0, ship.speed)
    full = og.rao(sailing, ship.body).sel(omega=slice(*WAVES), dof=["heave", "pitch"])
    found = []
    for direction in full.wave_direction.values:
        theirs = full.sel(wave_direction=direction).values
        w = full.omega.values
        ours = _transfer(vessel, w, np.full(len(w), direction))[1][:, [2, 4]]
        found.append({"heading": direction / deg, "omega": w, "rao": theirs, "model": ours})
    return found


def _irregular(vessel: Any, crests: str) -> dict[str, Any]:
    """Return small motions in a sea, long-crested or not, and their spectrum of encounter from the transfer function."""
    spread, n = (None, 1000) if crests == "long" else (og.spreading(n=2.0), 2000)  # bands narrower than 2 pi over DURATION
    options = {"direction": np.pi, "n": n, "omega_range": WAVES, "random": "amplitude", "spreading": spread}
    sea = og.irregular(og.jonswap(**SEA), seed=range(RUNS[crests]), n_directions=41, **options)
    result = og.simulate(vessel, sea, duration=DURATION, dt=DT, variables=("eta", "elevation"))
    variance = og.irregular(og.jonswap(**SEA), seed=0, n_directions=91, **(options | {"random": "phase", "n": 9100}))
    omega_e, H = _transfer(vessel, variance.omega, variance.direction)
    share = np.abs(H) ** 2 * 0.5 * np.ravel(variance.amplitude)[:, None] ** 2
    edges = np.arange(0.2, 3.4, 0.04)
    spectrum = np.stack([np.histogram(omega_e, edges, weights=s)[0] for s in share.T], axis=1) / 0.04
    found = spectral_density(result, segment=200.0)
    return {
        "sea": sea,
        "result": result,
        "omega_e": 0.5 * (edges[1:] + edges[:-1]),
        "spectrum": spectrum,
        "deviation": np.sqrt(share.sum(axis=0)),
        "found": found,
    }


def _doubt(part: dict[str, Any], runs: int) -> np.ndarray:
    """Return the relative standard deviation (6,) of a standard deviation estimated from all realisations.

    The variance of a Gaussian process of spectrum S over a time T is known to 2 pi int S^2 / (T m0^2), a standard deviation to
    half of that in parts of itself.
    """
    squared = np.sum(part["spectrum"] ** 2, axis=0) * 0.04
    m0 = part["deviation"] ** 2
    return 0.5 * np.sqrt(2 * np.pi * squared / (runs * DURATION)) / np.where(m0 > 0, m0, 1.0)


def _large(ship: Any, vessel: Any, part: dict[str, Any]) -> dict[str, Any]:
    """Return large motions in the first realisations of the long-crested sea, displacements from the steady course.

    `led`: with the waves of the steady course and nothing that changes the mean speed, for comparison instant by instant.
    """
    area = og.hydrostatics(ship.coarse, body=ship.body).wetted_area
    resistance = og.SurgeResistance(area=area, length=142.0, form_factor=0.15, allowance=4e-4, balanced_at=ship.speed)
    sailing = og.Vessel(ship.body, loads=(*vessel.loads, resistance), speed=ship.speed)
    sea = part["sea"].isel(slice(0, LARGE_RUNS))
    result = og.simulate(sailing, sea, duration=DURATION, dt=DT, motions="large", variables=("eta", "nu", "elevation"))
    eta = result.eta.copy(deep=True)
    eta.loc[{"dof": "surge"}] -= ship.speed * result.time
    loads = [og.WaveExcitation(ship.hydro0, position="mean") if load.name == "excitation" else load for load in vessel.loads]
    led = og.Vessel(ship.body, loads=loads, speed=ship.speed)
    options = {"dt": DT, "motions": "large", "variables": ("eta",)}
    there = og.simulate(led, part["sea"].isel(0), duration=0.25 * DURATION, **options).eta
    small = part["result"].eta.isel(realisation=slice(0, LARGE_RUNS))
    return {"result": result, "eta": eta, "small": small, "led": there, "thrust": resistance.thrust}


def _regular_checks(data: dict[str, Any]) -> list[dict[str, Any]]:
    checks = []
    for heading, name in NAMES.items():
        waves = [w for w in data["regular"] if w["heading"] == heading]
        worst = max(w["away"][i] / abs(w["wanted"][i]) for w in waves for i in range(6) if abs(w["wanted"][i]) > 1e-6)
        met = ", ".join(f"{w['omega_e']:.3g}" for w in waves)
        frequencies = ", ".join(f"{w['omega']:g}" for w in waves)
        note = f"six motions, wave frequencies {frequencies} rad/s met at {met} rad/s"
        checks.append(
            _check(f"regular {name} waves: time loop - transfer function", 100 * worst, 0.0, 0.01, "%", "identity", note)
        )
    for k, dof in enumerate(("heave", "pitch")):
        largest = max(np.abs(r["rao"])[:, k].max() for r in data["rao"])
        worst = max(np.abs(r["rao"] - r["model"])[:, k].max() / largest for r in data["rao"])
        note = "seven headings, of the largest of all: what the identification of the memory costs"
        checks.append(
            _check(f"{dof}: identified memory - coefficients", 100 * worst, 0.0, 1.5, "%", "rao(at_speed(hydro))", note)
        )
    return checks


def _irregular_checks(data: dict[str, Any]) -> list[dict[str, Any]]:
    checks = []
    for kind, dofs in (("long", (0, 2, 4)), ("short", range(6))):
        part = data[kind]
        doubt = _doubt(part, RUNS[kind])
        found = np.sqrt(np.mean(part["result"].eta.values ** 2, axis=(0, 1)))
        for i in dofs:
            value, wanted = 4 * found[i] * SCALE[i], 4 * part["deviation"][i] * SCALE[i]
            note = f"{RUNS[kind]} realisations of {DURATION:.0f} s: standard deviation of the estimate {100 * doubt[i]:.2g} %"
            unit = "m" if i < 3 else "deg"
            checks.append(
                _check(
                    f"{kind}-crested sea: significant {DOFS[i]}", value, wanted, SIGMAS * doubt[i] * wanted, unit,
                    "frequency domain", note,
                )
            )  # fmt: skip
    return checks


def _large_checks(data: dict[str, Any]) -> list[dict[str, Any]]:
    large, checks = data["large"], []
    for i in (2, 4):
        small = large["small"].values[:, :, i]
        value, wanted = (4 * x.std() * SCALE[i] for x in (large["eta"].values[:, :, i], small))
        unit = "m" if i < 3 else "deg"
        note = f"{LARGE_RUNS} realisations of {DURATION:.0f} s; waves where the ship is"
        checks.append(
            _check(
                f"large motions: significant {DOFS[i]}", value, wanted, 0.03 * wanted, unit, "small motions, same seas", note
            )
        )
        led = large["led"].values[:, i]
        away = 100 * np.std(led - small[0, : len(led)]) / np.std(led)
        note = "instant by instant, waves of the steady course: what turning with the ship changes"
        checks.append(_check(f"large - small motions: {DOFS[i]}", away, 0.0, 1.0, "%", "small motions, same sea", note))
    nu = large["result"].nu.sel(dof="surge").values
    checks.append(
        _check(
            "large motions: mean speed", nu.mean(), data["ship"].speed, 0.1, "m/s", "balanced at 18 kn",
            f"thrust {large['thrust'] / 1e3:.0f} kN; no drift force in the equations, see text",
        )
    )  # fmt: skip
    side = np.abs(large["result"].eta.values[:, :, [1, 3, 5]]).max()
    checks.append(_check("large motions: largest sway, roll, yaw in head seas", side, 0.0, 1e-6, "m, rad", "symmetry", ""))
    return checks


def _check(name: str, value: float, reference: float, tolerance: float, unit: str, source: str, note: str) -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": float(reference), "tolerance": float(tolerance), "unit": unit,
        "source": source, "note": note,
    }  # fmt: skip


BLUE, RED, GREY, INK = "#2f6db0", "#d1495b", "#8a8f98", "#22262b"


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw six motions of one realisation with the hull, spectra beside the frequency domain, regular waves."""
    grid = fig.add_gridspec(4, 4, height_ratios=[1.0, 1.0, 1.25, 1.25], width_ratios=[1, 1, 1, 1])
    _hull(fig.add_subplot(grid[0, :2]), data)
    _track(fig.add_subplot(grid[1, :2]), data)
    _series(fig, grid[:2, 2:], data)
    for k, (kind, i) in enumerate((("long", 2), ("long", 4), ("short", 3), ("short", 5))):
        _spectrum(fig.add_subplot(grid[2, k]), data[kind], kind, i)
    for k, i in enumerate((2, 3, 4, 5)):
        _rays(fig.add_subplot(grid[3, k]), data, i)


def _hull(ax: Any, data: dict[str, Any]) -> None:
    """Profile of the ship at one moment of the large motions, in the waves that it meets."""
    ship, large = data["ship"], data["large"]
    pitch = large["eta"].values[0, :, 4]
    n = int(np.abs(pitch).argmax())
    x, z, theta = large["result"].eta.values[0, n, [0, 2, 4]]
    points = ship.hull.vertices
    bins = np.linspace(points[:, 0].min(), points[:, 0].max(), 41)
    which = np.clip(np.digitize(points[:, 0], bins), 1, 40)
    keel = np.array([[0.5 * (bins[b - 1] + bins[b]), points[which == b, 2].min()] for b in np.unique(which)])
    outline = np.r_[keel, [[keel[-1, 0] + 4.0, 7.5], [keel[0, 0], 5.0], keel[0]]]
    X = outline[:, 0] * np.cos(theta) + outline[:, 1] * np.sin(theta)
    Z = -outline[:, 0] * np.sin(theta) + outline[:, 1] * np.cos(theta) + z
    at = np.linspace(-130.0, 130.0, 521)
    t = float(large["result"].time.values[n])
    wave = data["long"]["sea"].isel(0).elevation(np.full_like(at, t), x + at, 0.0)
    ax.fill(X, Z, color="#b8c4d0", ec=INK, lw=0.8, zorder=1)
    ax.fill_between(at, wave, -20.0, color="#4fb3d9", alpha=0.35, lw=0.0, zorder=2)
    ax.plot(at, wave, color=BLUE, lw=1.2, zorder=3)
    ax.set(xlim=(-130, 130), ylim=(-20, 16), ylabel="z [m]", xlabel="from O along the course [m]")
    ax.set_title(f"deepest pitch, {theta / deg:+.1f} deg at {t:.0f} s (heights x 2)", fontsize=8.5)


def _track(ax: Any, data: dict[str, Any]) -> None:
    """Speed of the ship in the long-crested sea and its distance from the steady course."""
    result, large = data["large"]["result"], data["large"]
    t = result.time.values
    ax.plot(t, result.nu.values[0, :, 0] / 0.514444, color=BLUE, lw=0.7)
    ax.axhline(18.0, color=INK, lw=0.6)
    ax.set(xlabel="time [s]", ylabel="speed [kn]", xlim=(0, DURATION), title="")
    ax.set_title("large motions: speed, distance gained", fontsize=8.5)
    other = ax.twinx()
    other.plot(t, large["eta"].values[0, :, 0], color=RED, lw=1.0)
    other.set_ylabel("distance [m]", color=RED)
    other.spines["right"].set_visible(True)


def _series(fig: Any, place: Any, data: dict[str, Any]) -> None:
    """Six motions of one realisation of the short-crested sea."""
    inner = place.subgridspec(6, 1, hspace=0.15)
    result = data["short"]["result"]
    t = result.time.values
    show = t <= 180.0
    for i, dof in enumerate(DOFS):
        ax = fig.add_subplot(inner[i])
        ax.plot(t[show], result.eta.values[0, show, i] * SCALE[i], color=(BLUE, RED)[i > 2], lw=0.9)
        ax.set_ylabel(f"{dof}\n[{'m' if i < 3 else 'deg'}]", fontsize=6.5)
        ax.tick_params(labelsize=6.5, labelbottom=i == 5)
        ax.set_xlim(0, 180)
        if i == 0:
            ax.set_title("six motions, short-crested head sea", fontsize=8.5)
        if i == 5:
            ax.set_xlabel("time [s]")


def _spectrum(ax: Any, part: dict[str, Any], kind: str, i: int) -> None:
    found = part["found"]
    scale = SCALE[i] ** 2
    # the estimate is averaged over realisations; band: 95 %
    w, S = found.omega.values, found.density.sel(dof=DOFS[i]).values * scale
    band = found.interval.sel(dof=DOFS[i]).values * scale
    ax.fill_between(w, band[..., 0], band[..., 1], color=BLUE, alpha=0.25, lw=0)
    ax.plot(w, S, color=BLUE, lw=1.1, label="time")
    ax.plot(part["omega_e"], part["spectrum"][:, i] * scale, color=RED, lw=1.1, ls="--", label="frequency")
    ax.set(xlim=(0.2, 2.0), ylim=(0, None), xlabel="encounter [rad/s]")
    ax.set_title(f"{DOFS[i]}, {kind}-crested", fontsize=8)
    ax.set_ylabel("m2 s/rad" if i < 3 else "deg2 s/rad", fontsize=7)
    if i == 2:
        ax.legend(fontsize=6, frameon=False, loc="upper right", handlelength=1.2)
    ax.set_xticks([0.5, 1.0, 1.5, 2.0])


def _rays(ax: Any, data: dict[str, Any], i: int) -> None:
    """Motions in regular waves: lines of the transfer function, dots of the time loop."""
    w = np.linspace(0.3, 1.4, 221)
    colors = dict(zip(NAMES, ("#1b3a5c", BLUE, "#2e8b57", "#c9971c", RED), strict=True))
    for heading, name in NAMES.items():
        if i in (3, 5) and heading in (0.0, 180.0):
            continue
        H = _transfer(data["vessel"], w, np.full_like(w, heading * deg))[1][:, i]
        ax.plot(w, np.abs(H) * SCALE[i], color=colors[heading], lw=1.0, label=name)
        waves = [r for r in data["regular"] if r["heading"] == heading]
        ax.plot(
            [r["omega"] for r in waves], [abs(r["motion"][i]) * SCALE[i] for r in waves], "o", ms=3.5, color=colors[heading]
        )
    ax.set(xlabel="wave [rad/s]", xlim=(0.3, 1.4), ylim=(0, None))
    ax.set_title(f"{DOFS[i]}, regular waves", fontsize=8)
    ax.set_ylabel("m/m" if i < 3 else "deg/m", fontsize=7)
    if i == 4:
        ax.legend(fontsize=6, frameon=False, loc="upper right", handlelength=1.2)
