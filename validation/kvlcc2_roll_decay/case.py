"""Measured roll decay of KVLCC2: viscous damping found from it, and the six-degree-of-freedom simulation that follows it."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.post.decay import decay
from ogilvie.units import deg

TITLE = "Measured roll decay of the tanker KVLCC2"
ABOUT = """A model of KVLCC2 (scale 1:68, no speed, SSPA 2018, run 21337; Mendeley Data 10.17632/2stvkyngj9.1) was heeled and
let go. The period follows from hull, GM = 5.73 m and kxx = 23.2 m alone: panel method with sway and yaw coupled. The decay
analysis then gives the damping of the whole series, linear and quadratic, and the stiffening of the restoring moment; less
the wave damping of the panel method the first is viscous. With these, and kxx raised by 0.06 m so that the periods meet, the
simulation in six degrees of freedom with fluid memory follows all 26 cycles, as a state space (SSM) and as a convolution
(CIM). Everything at full scale."""
NEEDS = ["data/kvlcc2_rolldecay/model_test_21337.csv", "data/kvlcc2_hull/kvlcc2_coarse.gdf"]
HEIGHT = 5.6

SCALE = 68.0
START = 27.4  # s, model scale: one cycle after the model was let go
GM, GYRADII = 5.73, (23.2, 80.0, 80.0)  # m
RHO, G = 1000.0, 9.81
OMEGA = np.arange(0.05, 1.21, 0.05)  # rad/s
DT = 0.1  # s
SOURCE = "SSPA 2018, run 21337, doi 10.17632/2stvkyngj9.1"
ROLL, LATERAL = 3, [1, 5]


@dataclass(frozen=True)
class RollMode:
    """The undamped mode of roll with the sway and yaw that come with it; motion per radian of roll."""

    shape: np.ndarray
    omega: float
    inertia: float
    damping: float  # of the waves, kg m2/s

    @property
    def period(self) -> float:
        """s."""
        return 2 * np.pi / self.omega


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return periods and damping measured and simulated."""
    assert shared is not None
    d = np.genfromtxt(shared / "data" / "kvlcc2_rolldecay" / "model_test_21337.csv", delimiter=",", names=True)
    hull = og.load_mesh(shared / "data" / "kvlcc2_hull" / "kvlcc2_coarse.gdf")
    rest = og.hydrostatics(hull)
    zg = rest.KM_T - hull.draught - GM
    body, hydro, mode = _vessel(hull, zg, GYRADII)
    C44 = hydro.hydrostatic_stiffness.values[ROLL, ROLL]
    measured = decay(d["time"] * np.sqrt(SCALE), d["phi"], start=START * np.sqrt(SCALE), restoring="cubic", stiffness=C44)
    kxx = np.sqrt(GYRADII[0] ** 2 + (measured.inertia - mode.inertia) / body.mass)
    body, hydro, tuned = _vessel(hull, zg, (kxx, *GYRADII[1:]))
    viscous = {
        "linear": measured.linear.value - tuned.damping,
        "quadratic": measured.quadratic.value,
        "cubic stiffness": C44 * measured.stiffening.value,
    }
    K = og.retardation(hydro)
    ssm = og.identify(K, mass=body.matrix, stiffness=hydro.hydrostatic_stiffness.values)
    duration = measured.t[-1] - measured.peak_time[0]
    simulated, series = {}, {}
    for name, radiation in (("SSM", og.StateSpaceRadiation(ssm)), ("CIM", og.Convolution(K))):
        ship = og.Vessel(body, loads=(og.LinearRestoring(hydro), radiation))
        t, phi = simulate_decay(ship, tuned.shape * measured.peak[0], viscous, duration)
        series[name] = (t, phi)
        simulated[name] = decay(t, phi, start=0.0, restoring="cubic", stiffness=C44)
    data = {
        "measured": measured, "mode": mode, "tuned": tuned, "viscous": viscous, "series": series, "simulated": simulated,
        "wall-sided": rest.BM_T / (2 * GM) - 1 / 6, "kxx": kxx, "order": ssm.order,
        "waves": float(tuned.shape @ ssm.transfer(tuned.omega)[0].real @ tuned.shape),
    }  # fmt: skip
    return _checks(data), data


def _vessel(hull: Any, zg: float, gyradii: tuple[float, ...]) -> tuple[Any, Any, RollMode]:
    body = og.RigidBody.from_hull(hull, zg=zg, gyradii=gyradii, rho=RHO)
    hydro = og.solve_bem(hull, body, omega=OMEGA, rho=RHO, g=G, progress=False)
    return body, hydro, roll_mode(body, hydro)


def roll_mode(body: Any, hydro: Any) -> RollMode:
    """Return the roll mode; sway and yaw have no stiffness, so they follow by their inertia."""
    C44 = hydro.hydrostatic_stiffness.values[ROLL, ROLL]
    shape, omega, inertia, B = np.zeros(6), 0.3, 0.0, np.zeros((6, 6))
    shape[ROLL] = 1.0
    for _ in range(20):
        at = hydro[["added_mass", "radiation_damping"]].interp(omega=omega, method="cubic")
        M, B = body.matrix + at.added_mass.values, at.radiation_damping.values
        shape[LATERAL] = -np.linalg.solve(M[np.ix_(LATERAL, LATERAL)], M[LATERAL, ROLL])
        inertia = float(shape @ M @ shape)
        omega = float(np.sqrt(C44 / inertia))
    return RollMode(shape, omega, inertia, float(shape @ B @ shape))


def simulate_decay(ship: Any, eta: np.ndarray, viscous: dict[str, float], duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Return times and roll of a free decay from rest; what is not linear is a roll moment at the middle of each step."""
    stepper = og.Stepper(ship, dt=DT, initial={"eta": eta})
    state, before, force = stepper.state, 0.0, np.zeros(6)
    phi = [state.eta[ROLL]]
    for _ in range(int(duration / DT)):
        p = state.nu[ROLL] + 0.5 * (state.nu[ROLL] - before)
        angle, before = state.eta[ROLL] + 0.5 * DT * state.nu[ROLL], state.nu[ROLL]
        force[ROLL] = -(viscous["linear"] + viscous["quadratic"] * abs(p)) * p - viscous["cubic stiffness"] * angle**3
        state = stepper.step(force)
        phi.append(state.eta[ROLL])
    return DT * np.arange(len(phi)), np.array(phi)


def _checks(data: dict[str, Any]) -> list[dict[str, Any]]:
    measured, mode = data["measured"], data["mode"]
    doubt = measured.natural_period * measured.natural_frequency.error / measured.natural_frequency.value
    share = data["tuned"].damping / measured.linear.value
    first, last = measured.equivalent_damping_ratio(np.abs(measured.peak[[0, -1]]))
    checks = [
        _check(
            "natural period of small angles, from hull, GM and kxx", mode.period, measured.natural_period, 0.1, "s",
            f"nothing fitted; measured +- {doubt:.3f} s",
        ),
        _check(
            "stiffening e of C (phi + e phi^3), wall-sided hull", data["wall-sided"], measured.stiffening.value, 0.25, "1/rad2",
            f"BM/(2 GM) - 1/6; measured +- {measured.stiffening.error:.2f}",
        ),
        _check(
            "R2 of the fitted decay", measured.r2, 1.0, 1e-4, "",
            f"linear damping {measured.linear.value:.3g} +- {measured.linear.error:.1g} kg m2/s, {share:.0%} of it waves; "
            f"quadratic {measured.quadratic.value:.3g} +- {measured.quadratic.error:.1g} kg m2; damping ratio {first:.2%} at "
            f"the first, {last:.2%} at the last extremum",
        ),
    ]  # fmt: skip
    checks.append(
        _check(
            "wave damping of the SSM at the resonance, over the panel method's", data["waves"] / data["tuned"].damping, 1.0,
            0.01, "", f"{data['waves']:.4g} kg m2/s",
        )
    )  # fmt: skip
    for name in ("SSM", "CIM"):
        s = data["simulated"][name]
        n = min(len(s.period), len(measured.period))
        period = np.sqrt(np.mean((s.period[:n] - measured.period[:n]) ** 2))
        ratio = np.sqrt(np.mean((s.damping_ratio[:n] - measured.damping_ratio[:n]) ** 2))
        amplitude = np.abs(np.abs(s.peak[: n + 2]) - np.abs(measured.peak[: n + 2])).max() / deg
        note = f"kxx {data['kxx']:.2f} m; " + (f"{data['order']} states" if name == "SSM" else "43 s of memory")
        checks += [
            _check(f"{name}: r.m.s. difference of the series over its r.m.s.", _misfit(data, name), 0.0, 0.02, "", note),
            _check(f"{name}: period per cycle, r.m.s. difference", period, 0.0, 0.02, "s", f"{n} overlapping cycles"),
            _check(f"{name}: damping ratio per cycle, r.m.s. difference", 100 * ratio, 0.0, 0.06, "% of critical", ""),
            _check(f"{name}: largest difference of an amplitude", amplitude, 0.0, 0.08, "deg", ""),
            _check(
                f"{name}: linear damping found again", s.linear.value / 1e6, measured.linear.value / 1e6, 3.0, "10^6 kg m2/s",
                "waves + viscous",
            ),
        ]  # fmt: skip
    return checks


def _misfit(data: dict[str, Any], name: str) -> float:
    tau, x = _free(data["measured"])
    phi = np.interp(tau, *data["series"][name])
    return float(np.sqrt(np.mean((phi - x) ** 2) / np.mean(x**2)))


def _free(measured: Any) -> tuple[np.ndarray, np.ndarray]:
    """Times from the first extremum on and measured roll without offset."""
    tau = measured.t - measured.peak_time[0]
    use = (tau >= 0.0) & (tau <= measured.t[-1] - measured.peak_time[0] - DT)
    return tau[use], measured.x[use] - measured.offset.value


def _check(name: str, value: float, reference: float, tolerance: float, unit: str, note: str) -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": float(reference), "tolerance": tolerance, "unit": unit,
        "source": SOURCE, "note": note,
    }  # fmt: skip


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw the series, its end, damping and period over the amplitude."""
    grid = fig.add_gridspec(2, 3, height_ratios=[1.0, 1.05])
    measured, tau_x = data["measured"], _free(data["measured"])
    for place, limits in ((grid[0, :], (0, 530)), (grid[1, 0], (465, 530))):
        ax = fig.add_subplot(place)
        ax.plot(tau_x[0], tau_x[1] / deg, color="#22262b", lw=3, alpha=0.3, label="measured (1:68, at full scale)")
        for name, colour, style in (("SSM", "#2f6db0", "-"), ("CIM", "#d1495b", (0, (4, 3)))):
            t, phi = data["series"][name]
            ax.plot(t, phi / deg, color=colour, ls=style, lw=1.0, label=f"simulated, {name}")
        ax.set(xlim=limits, xlabel="time [s]", ylabel="roll [deg]", title="free roll decay" if limits[0] == 0 else "its end")
    fig.axes[1].set_ylim(-5.5, 5.5)
    fig.legend(*fig.axes[0].get_legend_handles_labels(), loc="outside upper right", ncols=3)
    amplitude = np.linspace(0.0, 9.2, 60) * deg
    ax = fig.add_subplot(grid[1, 1])
    _damping_parts(ax, data, amplitude)
    ax.plot(measured.amplitude / deg, 100 * measured.damping_ratio, "o", ms=3, color="#22262b", mfc="none", mew=0.8)
    ax.plot(amplitude / deg, 100 * measured.equivalent_damping_ratio(amplitude), color="#2f6db0", lw=1.3)
    ax.set(title="damping per cycle", xlabel="amplitude [deg]", ylabel="[% of critical]", xlim=(0, 9.2), ylim=(0, 0.95))
    ax = fig.add_subplot(grid[1, 2])
    ax.plot(measured.amplitude / deg, measured.period, "o", ms=3, color="#22262b", mfc="none", mew=0.8)
    ssm = data["simulated"]["SSM"]
    ax.plot(ssm.amplitude / deg, ssm.period, color="#2f6db0", lw=1.3)
    ax.plot(0, data["mode"].period, "D", ms=5, color="#2e8b57", clip_on=False, zorder=5)
    ax.annotate(
        "from hull, GM, kxx", (0, data["mode"].period), (6, -11), textcoords="offset points", fontsize=6.5, color="#2e8b57"
    )
    ax.set(title="period per cycle", xlabel="amplitude [deg]", ylabel="[s]", xlim=(0, 9.2), ylim=(20.8, 21.1))


def _damping_parts(ax: Any, data: dict[str, Any], amplitude: np.ndarray) -> None:
    """Shade what waves, linear and quadratic viscous damping contribute."""
    measured = data["measured"]
    w, inertia = measured.natural_frequency.value, measured.inertia
    waves = np.full(len(amplitude), data["tuned"].damping / (2 * w * inertia))
    linear = np.full(len(amplitude), measured.linear.value / (2 * w * inertia))
    total = measured.equivalent_damping_ratio(amplitude)
    levels = [0 * waves, waves, linear, total]
    names = (("waves", "#4fb3d9"), ("linear viscous", "#c9971c"), ("quadratic viscous", "#8e4585"))
    for low, high, (name, colour) in zip(levels[:-1], levels[1:], names, strict=True):
        ax.fill_between(amplitude / deg, 100 * low, 100 * high, color=colour, alpha=0.25, lw=0, label=name)
    ax.legend(loc="upper left", fontsize=6.5)
