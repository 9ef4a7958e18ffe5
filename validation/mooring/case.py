"""Catenary moorings: published linear stiffness, free decay of a moored body."""

from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.loads.base import Terms
from ogilvie.loads.kernel import ROTATION, Kernel, load_kernel

TITLE = "Catenary moorings: published stiffness (OC3, OC4) and free decay"
ABOUT = """Two moorings whose lines are published together with their linear stiffness: the spar of OC3 (J. Jonkman, Definition
of the Floating System for Phase IV of OC3, NREL/TP-500-47535, 2010) and the semi-submersible of OC4 (A. Robertson et al.,
Definition of the Semisubmersible Floating System for Phase II of OC4, NREL/TP-5000-60601, 2014), three lines each.
`CatenaryMooring` solves each line; its stiffness is a central difference. The vertical force published for OC4, 1.839 MN, is 3
% below that of its own lines; it stands here as published with that difference allowed. Then a body of about the size of the
semi-submersible, moored by its lines, swings free without any damping. A small swing has the period of the eigenvalue problem
of mass and linear stiffness, all six motions coupled. A large one in surge alone has the period of the energy integral T = 2
int dx / x'(x) between the turning points, which the restoring force makes uneven: it stiffens against the single line more
than against the pair."""
NEEDS: list[str] = []
HEIGHT = 6.2

OC3 = {"K11": 41180.0, "K22": 41180.0, "K33": 11940.0, "K44": 311.1e6, "K55": 311.1e6, "K66": 11.56e6, "K15": -2.816e6,
       "K24": 2.816e6}  # fmt: skip
OC4 = {"K11": 7.08e4, "K22": 7.08e4, "K33": 1.91e4, "K44": 8.73e7, "K55": 8.73e7, "K66": 1.17e8, "K51": -1.07e5}
VERTICAL = {"OC3": -1.607e6, "OC4": -1.839e6}
SOURCES = {"OC3": "Jonkman (2010)", "OC4": "Robertson et al. (2014)"}
MASS, ADDED = 1.35e7, 8e6  # kg
INERTIA = 1.1e10  # kg m2
STIFFNESS = np.diag([0.0, 0.0, 3.8e6, 1.4e9, 1.4e9, 0.0])
SWINGS = np.array([2.0, 5.0, 10.0, 15.0, 20.0, 25.0])  # m, to the side of the single line and to the other


@load_kernel
def _constant(x, data, own, force):  # type: ignore[no-untyped-def]
    for i in range(3):
        force[i] += x[ROTATION + 6 + i] * data[0]  # vertical in the world


class Lift:
    """The part of the buoyancy that carries the lines."""

    name = "lift"
    covers = frozenset({"lift"})

    def __init__(self, force: float) -> None:
        self.force = force

    def bind(self, surroundings: Any) -> Terms:
        """Return the compiled force."""
        return Terms(kernel=Kernel(_constant, np.array([self.force])))


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the checks and what the figure needs."""
    moorings = {"OC3": spar(), "OC4": semisubmersible()}
    data = {"moorings": moorings, "small": _small_swing(moorings["OC4"]), "large": _large_swings(moorings["OC4"])}
    return [*_published(moorings), *_swing_checks(data)], data


def spread(anchors: tuple[float, float], fairleads: tuple[float, float], *, first: float, **chain: float) -> Any:
    """Return three lines all round: (radius, depth) of anchors and fairleads, m."""
    lines = []
    for a in first + 2 * np.pi * np.arange(3) / 3:
        c, s = np.cos(a), np.sin(a)
        places = ([r * c, r * s, -d] for r, d in (anchors, fairleads))
        lines.append(og.MooringLine(*places, **chain))
    return og.CatenaryMooring(lines)


def semisubmersible() -> Any:
    """Return the mooring of OC4: chain of 113.35 kg/m, 108.63 kg/m in water, in 200 m."""
    return spread((837.6, 200.0), (40.868, 14.0), first=np.pi / 3, length=835.35, weight=108.63 * 9.81, stiffness=753.6e6)


def spar() -> Any:
    """Return the mooring of OC3: 698.094 N/m in water, in 320 m."""
    return spread((853.87, 320.0), (5.2, 70.0), first=0.0, length=902.2, weight=698.094, stiffness=384.243e6)


def _body(moment: float = INERTIA) -> Any:
    return og.RigidBody(mass=MASS, cog=[0, 0, -10.0], inertia=np.diag([moment, moment, moment]))


def _radiation() -> Any:
    A = np.diag([ADDED, ADDED, 1.4e7, 7e9, 7e9, 4e9])
    return og.StateSpaceRadiation(og.StateSpace(np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0)), A_inf=A)), A


def _small_swing(mooring: Any) -> dict[str, Any]:
    """Return the swing in the slowest mode of surge and pitch, and the period of the eigenvalue problem."""
    from scipy.linalg import eigh

    body = _body()
    radiation, A = _radiation()
    lift = -mooring.force()[2]
    K = STIFFNESS + mooring.stiffness()
    pair = np.ix_([0, 2, 4], [0, 2, 4])
    M = body.matrix + A
    w2, modes = eigh(0.5 * (K + K.T)[pair], M[pair])
    mode = modes[:, 0] / modes[0, 0] * 0.2
    start = np.zeros(6)
    start[[0, 2, 4]] = mode
    ship = og.Vessel(body, loads=(og.LinearRestoring(STIFFNESS), radiation, mooring, Lift(lift)))
    T = 2 * np.pi / np.sqrt(w2[0])
    result = og.simulate(ship, duration=4.2 * T, dt=0.1, initial={"eta": start})
    return {"t": result.time.values, "eta": result.eta.values, "period": T, "found": period_of(result), "start": start}


def period_of(result: Any) -> float:
    """Return the mean period of surge from where its velocity is zero, by cubic interpolation."""
    from scipy.interpolate import CubicSpline

    roots = CubicSpline(result.time.values[1:], result.nu.values[1:, 0]).roots(extrapolate=False)
    return float(2 * np.mean(np.diff(roots[: 2 * (len(roots) // 2) + 1 - (len(roots) % 2 == 0)])))


def _large_swings(mooring: Any) -> dict[str, Any]:
    """Return periods of surge alone (a body that neither heaves nor pitches), by simulation and by the energy integral."""
    radiation, _ = _radiation()
    body = og.RigidBody(mass=MASS, cog=[0, 0, 0], inertia=np.diag([1e13, 1e13, 1e13]))
    stiff = np.diag([0.0, 0.0, 1e10, 1e15, 1e15, 0.0])
    ship = og.Vessel(body, loads=(og.LinearRestoring(stiff), radiation, mooring, Lift(-mooring.force()[2])))
    x = np.linspace(-45.0, 45.0, 361)
    force = np.array([mooring.force([s, 0, 0, 0, 0, 0])[0] for s in x])
    found, closed, runs = [], [], {}
    for side in (-1.0, 1.0):
        for swing in SWINGS:
            T = integral_period(x, force, MASS + ADDED, side * swing)
            start = {"eta": [side * swing, 0, 0, 0, 0, 0]}
            result = og.simulate(ship, duration=3.2 * T, dt=0.05, initial=start, variables=("eta", "nu"))
            closed.append(T)
            found.append(period_of(result))
            runs[side * swing] = (result.time.values, result.eta.values[:, 0])
    return {"x": x, "force": force, "swing": np.r_[-SWINGS, SWINGS], "found": np.array(found), "closed": np.array(closed),
            "runs": runs}  # fmt: skip


def integral_period(x: np.ndarray, force: np.ndarray, mass: float, start: float) -> float:
    """Return the period (s) of mass x'' = F(x) from rest at `start`, by quadrature between its turning points."""
    from scipy.interpolate import CubicSpline
    from scipy.optimize import brentq

    work = CubicSpline(x, force).antiderivative()
    level = float(work(start))
    far = 0.98 * (x[-1] if start < 0 else x[0])
    other = brentq(lambda s: float(work(s)) - level, 0.2 * far / abs(far), far)
    low, high = sorted((start, other))
    s, weight = np.polynomial.legendre.leggauss(120)
    a = 0.5 * np.pi * s  # x = middle + half sin(a) takes the roots at the turning points away
    at = 0.5 * (low + high) + 0.5 * (high - low) * np.sin(a)
    speed = np.sqrt(2 * np.maximum(work(at) - level, 1e-300) / mass)
    return float(2 * 0.5 * np.pi * np.sum(weight * 0.5 * (high - low) * np.cos(a) / speed))


def _published(moorings: dict[str, Any]) -> list[dict[str, Any]]:
    checks = []
    for name, values, part in (("OC3", OC3, 2e-3), ("OC4", OC4, 5e-3)):
        K, F = moorings[name].stiffness(), moorings[name].force()
        for key, wanted in values.items():
            i, j = int(key[1]) - 1, int(key[2]) - 1
            unit = "N/m" if max(i, j) < 3 else ("N m/rad" if min(i, j) >= 3 else "N")
            checks.append(_check(f"{name} {key}", K[i, j], wanted, part * abs(wanted), unit, SOURCES[name], ""))
        note = "see text" if name == "OC4" else ""
        wanted, part = VERTICAL[name], 0.035 if name == "OC4" else 1e-3
        checks.append(_check(f"{name} vertical force", F[2] / 1e6, wanted / 1e6, abs(wanted) * part / 1e6, "MN", SOURCES[name],
                             note))  # fmt: skip
    return checks


def _swing_checks(data: dict[str, Any]) -> list[dict[str, Any]]:
    small, large = data["small"], data["large"]
    T = small["period"]
    checks = [_check("period of a swing of 0.2 m", small["found"], T, 1e-3 * T, "s", "mass and stiffness",
                     "surge, heave and pitch coupled; free of damping")]  # fmt: skip
    for swing in (-25.0, -10.0, 10.0, 25.0):
        i = int(np.flatnonzero(large["swing"] == swing)[0])
        wanted = large["closed"][i]
        what = f"period of surge let go at {swing:+.0f} m"
        checks.append(_check(what, large["found"][i], wanted, 5e-4 * wanted, "s", "energy integral", ""))
    return checks


def _check(name: str, value: float, reference: float, tolerance: float, unit: str, source: str, note: str) -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": float(reference), "tolerance": float(tolerance), "unit": unit,
        "source": source, "note": note,
    }  # fmt: skip


BLUE, RED, GREEN, AMBER, GREY, INK = "#2f6db0", "#d1495b", "#2e8b57", "#c9971c", "#8a8f98", "#22262b"


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw the lines at rest and offset, restoring curves, swings, periods over amplitude."""
    grid = fig.add_gridspec(2, 6, height_ratios=[1.0, 1.0])
    lines = data["moorings"]["OC4"]
    _plan(fig.add_subplot(grid[0, :2]), lines)
    _side(fig.add_subplot(grid[0, 2:]), lines)
    ax = fig.add_subplot(grid[1, :2])
    for name, color in (("OC4", BLUE), ("OC3", AMBER)):
        x = np.linspace(-30.0, 30.0, 61)
        F = np.array([data["moorings"][name].force([s, 0, 0, 0, 0, 0])[0] for s in x])
        K = (OC4 if name == "OC4" else OC3)["K11"]
        ax.plot(x, F / 1e6, color=color, lw=1.3, label=name)
        ax.plot(x[20:41], -K * x[20:41] / 1e6, "--", color=INK, lw=0.8, label="published K11" if name == "OC4" else None)
    ax.axhline(0.0, color=INK, lw=0.5)
    ax.set(xlabel="offset in surge [m]", ylabel="force [MN]", xlim=(-30, 30))
    ax.set_title("restoring", fontsize=8.5)
    ax.legend(fontsize=6.5, frameon=False)
    ax = fig.add_subplot(grid[1, 2:4])
    for swing, color in ((25.0, RED), (10.0, BLUE), (-25.0, GREEN)):
        t, x = data["large"]["runs"][swing]
        ax.plot(t, x, color=color, lw=1.0, label=f"from {swing:+.0f} m")
    ax.set(xlabel="time [s]", ylabel="surge [m]", xlim=(0, 250), ylim=(-62, 30))
    ax.set_title("free surge, no damping", fontsize=8.5)
    ax.legend(fontsize=6.5, frameon=False, loc="lower right")
    ax = fig.add_subplot(grid[1, 4:])
    large, n = data["large"], len(SWINGS)
    for part, color, name in ((slice(0, n), GREEN, "let go at - x"), (slice(n, None), RED, "let go at + x")):
        ax.plot(np.abs(large["swing"][part]), large["closed"][part], color=color, lw=1.1, label=name)
        ax.plot(np.abs(large["swing"][part]), large["found"][part], "o", color=color, ms=4, mfc="none")
    K = data["moorings"]["OC4"].stiffness()[0, 0]
    ax.axhline(2 * np.pi * np.sqrt((MASS + ADDED) / K), color=INK, lw=0.8, ls="--", label="linear")
    ax.set(xlabel="first excursion [m]", ylabel="period [s]", xlim=(0, 26))
    ax.set_title("period (lines: energy)", fontsize=8.5)
    ax.legend(fontsize=6.5, frameon=False)


def _plan(ax: Any, lines: Any) -> None:
    for eta, color, lw in ((np.zeros(6), GREY, 1.0), (np.array([25.0, 0, 0, 0, 0, 0]), RED, 1.0)):
        for curve in lines.shapes(eta, points=101):
            ax.plot(curve[:, 0], curve[:, 1], color=color, lw=lw)
            ax.plot(*curve[0, :2], "s", color=INK, ms=3)
            ax.plot(*curve[-1, :2], "o", color=color, ms=3)
    ax.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
    ax.set_title("OC4: plan, at rest and at +25 m", fontsize=8.5)


def _side(ax: Any, lines: Any) -> None:
    """Draw the lines along themselves: the one ahead of the offset slack, those astern tight."""
    for swing, color in ((0.0, GREY), (25.0, RED), (-25.0, GREEN)):
        for i, style in ((1, "-"), (0, "--")):
            curve = lines.shapes([swing, 0, 0, 0, 0, 0], points=401)[i]
            along = np.hypot(*(curve[:, :2] - curve[0, :2]).T)
            name = f"{swing:+.0f} m, {'single line' if i == 1 else 'one of the pair'}"
            ax.plot(along, curve[:, 2], style, color=color, lw=1.1, label=name)
    ax.axhline(-200.0, color="#c9b79c", lw=2.5, zorder=0)
    ax.axhline(0.0, color="#4fb3d9", lw=0.9)
    ax.set(xlabel="distance from the anchor [m]", ylabel="z [m]", xlim=(350, 840), ylim=(-210, 10))
    ax.set_title("along the lines, last part", fontsize=8.5)
    ax.legend(fontsize=6.5, frameon=False, loc="upper left")
