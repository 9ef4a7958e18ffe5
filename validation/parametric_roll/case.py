"""Parametric roll of a container ship in head seas: growth against Floquet and Mathieu theory, the limit cycle."""

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.loads.froude_krylov import NonlinearFroudeKrylov
from ogilvie.mesh.raise_sides import with_raised_sides
from ogilvie.units import deg

TITLE = "Parametric roll of the S175 in head seas"
ABOUT = """In head seas of ship length nothing pushes the S175 to roll, but its righting arm varies with each wave that
passes: where the frequency of encounter is about twice that of roll, roll grows out of nothing. The load on the instantaneous
wetted hull shows it. Small roll is compared with theory: the stiffness K(t) of roll comes from the hull at the heave and
pitch of each moment and from the inertia of sway and yaw (stiff springs guide the ship, so v = phi w and r = -phi q in body
axes; the added mass of sway and yaw is left out, so that this is all of it), natural frequency and damping from a free decay
of the same model in still water. Floquet's multipliers of phi'' + 2 mu phi' + w0^2 K(t)/K phi = 0 give the growth, and the
first zone of Mathieu's equation, growth = sqrt((h w/4)^2 - (we/2 - w)^2) - mu with mean and harmonic h of K(t), the chart;
simulated growth is that of the linear map from one encounter to the next. Nothing is fitted to the runs in waves. Roll that
has grown ends in a limit cycle, set by the righting arm and quadratic damping, the same from a small and a large start."""
NEEDS: list[str] = []
HEIGHT = 5.6

OMEGA = np.arange(0.1, 1.41, 0.1)
WAVE = 0.593  # rad/s: 175 m
SPEEDS = (2.0, 2.75, 3.25, 3.75, 4.5, 5.5)  # m/s
AMPLITUDES = (0.3, 0.6, 1.2, 1.8)  # m
SMALL, CYCLE = 0.02 * deg, 2.0  # rad; m, amplitude of the high wave
RATIO = 0.01  # linear roll damping over critical, beside that of the waves
DT = 0.1
SOURCE = "Floquet theory"
ROLL = 3


class Ship:
    """Hull, data and memory, and vessels made of them."""

    def __init__(self) -> None:
        self.hull = with_raised_sides(og.shapes.s175(panels=700, above_water=True), 5.9)
        wet = self.hull.immersed()
        self.body = og.RigidBody.from_hull(wet, kg=9.52, gyradii=(8.33, 42.0, 42.0))
        self.hydro = _guided(og.solve_bem(wet, self.body, omega=OMEGA, wave_direction=[np.pi], progress=False))
        model = og.identify(
            og.retardation(self.hydro), mass=self.body.matrix, stiffness=self.hydro.hydrostatic_stiffness.values
        )
        self.load = NonlinearFroudeKrylov(self.hull, self.body, self.hydro)
        m, moment = self.body.mass, self.body.matrix[5, 5]
        stiffness = np.diag([2.5e-3 * m, 4.0 * m, 0, 0, 0, 4.0 * moment])
        damping = np.diag([0.05 * m, 1.0 * m, 0, 0, 0, 1.0 * moment])
        roll = og.RollDamping(ratio=RATIO, quadratic=0.25 * self.body.matrix[3, 3])
        diffraction = og.WaveExcitation(self.hydro, part="diffraction", position="mean")
        moored = (og.LinearMooring(stiffness), og.LinearDamping(damping))
        self.loads = (self.load, diffraction, og.StateSpaceRadiation(model), roll, *moored)

    def sail(self, sea: Any, speed: float, roll: float, duration: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return times, poses and velocities (n, 6)."""
        vessel = og.Vessel(self.body, loads=self.loads, speed=speed)
        run = og.simulate(
            vessel, sea, duration=duration, dt=DT, ramp=0.0 if sea is None else 30.0, motions="large", variables=("eta", "nu"),
            initial={"eta": [0, 0, 0, roll, 0, 0]},
        )  # fmt: skip
        return run.time.values, run.eta.values, run.nu.values


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return growth rates and the limit cycle."""
    ship = Ship()
    points = []
    for speed in SPEEDS:
        w0, mu = _decay(*ship.sail(None, speed, 0.2 * deg, 150.0)[:2])
        for amplitude in AMPLITUDES:
            sea = og.regular(amplitude=amplitude, omega=WAVE, direction=np.pi)
            t, eta, nu = ship.sail(sea, speed, SMALL, 220.0)
            we = WAVE + float(sea.wavenumber[0]) * speed
            stiffness = _stiffness(ship, sea, (t, eta, nu), we, w0)
            points.append(
                {
                    "speed": speed, "amplitude": amplitude, "we": we, "w0": w0, "mu": mu,
                    "found": _growth(t, eta[:, ROLL], nu[:, ROLL], we), "theory": _floquet(stiffness, w0, mu, we),
                    **_mathieu(stiffness, w0, mu, we),
                }
            )  # fmt: skip
    sea = og.regular(amplitude=CYCLE, omega=WAVE, direction=np.pi)
    cycles = {name: ship.sail(sea, 4.5, roll, 600.0)[:2] for name, roll in (("small", 2 * deg), ("large", 15 * deg))}
    return _checks(points, cycles), {"points": points, "cycles": cycles}


def _guided(hydro: Any) -> Any:
    """Return data without added mass and damping of sway and yaw."""
    still = hydro.copy(deep=True)
    for name in [n for n in ("added_mass", "radiation_damping", "added_mass_inf", "added_mass_zero") if n in still]:
        for dofs in ({"influenced_dof": ["sway", "yaw"]}, {"radiating_dof": ["sway", "yaw"]}):
            still[name].loc[dofs] = 0.0
    return still


def _decay(t: np.ndarray, eta: np.ndarray) -> tuple[float, float]:
    """Return natural frequency and damping (1/s) of a free decay, from its turning points."""
    phi = eta[:, ROLL]
    at = np.flatnonzero((phi[1:-1] - phi[:-2]) * (phi[2:] - phi[1:-1]) <= 0) + 1
    at = at[at > 20][:12]
    swing = np.abs(np.diff(phi[at]))
    zeros = [np.interp(0.0, *_ascending(phi[a : b + 1], t[a : b + 1])) for a, b in pairwise(at)]
    half = np.diff(zeros).mean()
    return float(np.pi / half), float(-np.polyfit(np.arange(len(swing)) * half, np.log(swing), 1)[0])


def _ascending(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return (x, y) if x[-1] > x[0] else (x[::-1], y[::-1])


def _stiffness(ship: Ship, sea: Any, run: tuple[np.ndarray, ...], we: float, w0: float) -> np.ndarray:
    """Return K(t)/K of roll at 48 points of a period, at the heave and pitch that the ship has there.

    A ship that is guided has v = phi w and r = -phi q in body axes, so that sway and yaw bring their inertia and damping,
    at the frequency of roll, into the equation of roll as a stiffness.
    """
    t, eta, nu = run
    times = 150.0 + 2 * np.pi / we * np.arange(48) / 48
    pose = np.array([np.interp(times, t, e) for e in eta.T]).T
    pose[:, [1, 3, 5]] = 0.0
    tilt = 1e-3 * np.eye(6)[ROLL]
    slope = (ship.load.force(sea, t=times, eta=pose - tilt) - ship.load.force(sea, t=times, eta=pose + tilt))[:, ROLL] / 2e-3
    at = ship.hydro[["added_mass", "radiation_damping"]].interp(omega=w0, method="cubic")
    M, B = ship.body.matrix + at.added_mass.values, at.radiation_damping.values
    vertical = ship.body.matrix + ship.hydro.added_mass.interp(omega=we, method="cubic").values
    w, q = (np.interp(times, t, nu[:, i]) for i in (2, 4))
    dw, dq = (np.interp(times, t, np.gradient(nu[:, i], t)) for i in (2, 4))
    slope += M[3, 1] * dw - M[3, 5] * dq + B[3, 1] * w - B[3, 5] * q
    slope += w * (vertical[2, 2] * w + vertical[2, 4] * q) - w * (M[1, 1] * w - M[1, 5] * q)
    slope += q * (vertical[4, 2] * w + vertical[4, 4] * q) + q * (M[5, 1] * w - M[5, 5] * q)
    return slope / ship.load.stiffness[ROLL, ROLL]


def _floquet(stiffness: np.ndarray, w0: float, mu: float, we: float) -> float:
    """Return the growth rate of phi'' + 2 mu phi' + w0^2 K(t)/K phi = 0, 1/s."""
    n, h = len(stiffness) // 2, 2 * np.pi / we / (len(stiffness) // 2)
    y = np.eye(2)
    for i in range(n):
        a, b, c = (np.array([[0.0, 1.0], [-(w0**2) * stiffness[(2 * i + k) % (2 * n)], -2 * mu]]) for k in range(3))
        k1 = a @ y
        k2 = b @ (y + 0.5 * h * k1)
        k3 = b @ (y + 0.5 * h * k2)
        y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + c @ (y + h * k3))
    return float(np.log(np.abs(np.linalg.eigvals(y)).max()) / (n * h))


def _mathieu(stiffness: np.ndarray, w0: float, mu: float, we: float) -> dict[str, float]:
    """Return mean frequency and harmonic of the stiffness, and the growth rate of the first zone."""
    mean = float(stiffness.mean())
    w = w0 * np.sqrt(mean)
    h = 2 * abs(np.mean(stiffness * np.exp(-2j * np.pi * np.arange(len(stiffness)) / len(stiffness)))) / mean
    inner = (h * w / 4) ** 2 - (we / 2 - w) ** 2
    return {"w": w, "h": float(h), "mathieu": float(np.sqrt(max(inner, 0.0)) - mu)}


def _growth(t: np.ndarray, phi: np.ndarray, p: np.ndarray, we: float) -> float:
    """Return the growth rate of small roll from the linear map of (phi, phi') from one encounter to the next, 1/s."""
    from scipy.interpolate import CubicSpline

    period = 2 * np.pi / we
    end = t[np.argmax(np.abs(phi) > 2 * deg)] if np.abs(phi).max() > 2 * deg else t[-1]
    y = CubicSpline(t, np.stack([phi, p], axis=1))(np.arange(60.0, end, period))
    Y = np.linalg.lstsq(y[:-1] / np.linalg.norm(y[:-1], axis=1)[:, None], y[1:] / np.linalg.norm(y[:-1], axis=1)[:, None])[0]
    return float(np.log(np.abs(np.linalg.eigvals(Y)).max()) / period)


def _amplitude(t: np.ndarray, eta: np.ndarray) -> float:
    return float(0.5 * np.ptp(eta[t > 540.0, ROLL]))


def _checks(points: list[dict[str, float]], cycles: dict[str, Any]) -> list[dict[str, Any]]:
    found, theory, mathieu = (np.array([p[k] for p in points]) for k in ("found", "theory", "mathieu"))
    clear, grows = np.abs(theory) > 0.002, theory > 0.0
    first = "first zone, first order in h"
    off = float(np.sqrt(np.mean((found - theory)[grows] ** 2)))
    low = float(np.abs(found - theory)[[p["amplitude"] <= 0.6 for p in points]].max())
    end = {name: _amplitude(*c) / deg for name, c in cycles.items()}
    return [
        _check("growth rate, simulated less Floquet, waves up to 1.2 m high, largest", low, 0.0, 0.0008, "1/s", ""),
        _check("growth rate where roll grows, simulated less Floquet, r.m.s.", off, 0.0, 0.0015, "1/s",
               f"{grows.sum()} of {len(points)} runs, rates to {found.max():.4f} 1/s"),
        _check("the largest growth rate, simulated over Floquet", found.max() / theory[found.argmax()], 1.0, 0.15, "",
               f"wave {2 * points[int(found.argmax())]['amplitude']:g} m high"),
        _check("runs on the other side of Floquet's boundary", _others(found[clear], theory[clear]),
               0.0, 0.0, "", f"of {clear.sum()} that lie 0.002 1/s away from it"),
        _check("runs on the other side of Mathieu's", _others(found[clear], mathieu[clear]), 0.0, 0, "", first),
        _check("limit cycle in a wave of 4 m, large less small start", end["large"] - end["small"], 0.0, 0.3, "deg",
               f"{end['small']:.2f} deg"),
    ]  # fmt: skip


def _others(a: np.ndarray, b: np.ndarray) -> float:
    """Return how many numbers have another sign."""
    return float(np.sum(np.sign(a) != np.sign(b)))


def _check(name: str, value: float, reference: float, tolerance: float, unit: str, note: str) -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": float(reference), "tolerance": tolerance, "unit": unit,
        "source": SOURCE, "note": note,
    }  # fmt: skip


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw the limit cycle, growth against theory, and the stability chart."""
    grid = fig.add_gridspec(2, 2, height_ratios=[1.0, 1.15])
    ax = fig.add_subplot(grid[0, :])
    for (name, (t, eta)), colour in zip(data["cycles"].items(), ("#2f6db0", "#d1495b"), strict=True):
        ax.plot(t, eta[:, ROLL] / deg, color=colour, lw=0.8, label=f"{name} start")
    ax.set(xlabel="time [s]", ylabel="roll [deg]", xlim=(0, 600), title=f"wave {2 * CYCLE:g} m high, 4.5 m/s")
    ax.legend(fontsize=6.5, ncols=2)
    points = data["points"]
    ax = fig.add_subplot(grid[1, 0])
    theory, found = (np.array([p[k] for p in points]) for k in ("theory", "found"))
    ends = [min(theory.min(), found.min()) - 0.005, max(theory.max(), found.max()) + 0.005]
    ax.plot(ends, ends, color="#9aa3ad", lw=1.0)
    ax.plot(theory, found, "o", ms=3.5, color="#2f6db0", mfc="none")
    ax.plot([p["mathieu"] for p in points], found, "x", ms=3, color="#c9971c")
    ax.set(xlabel="Floquet (o), Mathieu (x) [1/s]", ylabel="simulated [1/s]", title="growth of small roll")
    ax = fig.add_subplot(grid[1, 1])
    ratio = np.linspace(0.8, 1.3, 200)
    mu = np.mean([p["mu"] / p["w"] for p in points])
    ax.plot(ratio, 4 * np.sqrt((ratio - 1) ** 2 + mu**2), color="#22262b", lw=1.2, label="Mathieu, first zone")
    for p in points:
        grows = p["found"] > 0
        ax.plot(
            p["we"] / (2 * p["w"]), p["h"], "o", ms=4, color="#d1495b" if grows else "#2f6db0", mfc=None if grows else "none"
        )
    ax.set(
        xlabel="encounter over twice the roll frequency",
        ylabel="harmonic h of the roll stiffness",
        title="grows (full), decays",
    )
    ax.set(xlim=(0.86, 1.18), ylim=(0.0, 1.3 * max(p["h"] for p in points)))
    ax.legend(fontsize=6.5)
