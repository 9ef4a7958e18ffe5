"""Paper A, sections V to VII: state space against convolution, in K, radiation forces, motions and a roll decay."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import brentq

import ogilvie as og
from ogilvie.post.decay import decay
from ogilvie.units import deg

TITLE = "State space against convolution: forces, motions and roll decay of a pipe-laying vessel (Yuan et al. 2017)"
ABOUT = """Yuan, Ma, Zan and Wu (2017), J. Marine Science and Technology (Taiwan) 25(6), compare a state-space model (SSM,
realization theory) with the convolution integral (CIM) for the vessel HYSY201: retardation functions, radiation forces and
motions in a Bretschneider sea (Hs 2.5 m, Tp 8 s, head, time step 0.01 s) and a roll decay (measured period 17.1 s). Here
with a hull of the same particulars (its lines and masses are not public; KG is chosen for the roll period), our own panel
solution, the default model of `identify` and, beside it, realization theory. The published forces and motions of the two
methods disagree before 65 s; here both start from the same rest and agree from the first second."""
NEEDS: list[str] = []
HEIGHT = 8.6

HULL = {"length": 185.0, "beam": 39.2, "draught": 8.959}  # m, Table 1
DISPLACEMENT = 55101.8e3  # kg
GYRADII = (0.35 * 39.2, 0.25 * 185.0, 0.25 * 185.0)  # m
ROLL_PERIOD = 17.1  # s, section VI
OMEGA = np.arange(0.1, 1.81, 0.05)  # rad/s
HEAD = np.pi
SPRINGS = ((0, 120.0), (1, 120.0), (5, 100.0))  # dof, natural period, s
DT, DURATION, SETTLED = 0.01, 200.0, 65.0  # s
HEEL = 10 * deg
SHOWN = (("surge", 0), ("heave", 2), ("pitch", 4))
SOURCE = "Yuan et al. (2017), sections V to VII"


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the differences between the two methods."""
    body, hydro = vessel()
    K = og.retardation(hydro)
    springs = np.zeros((6, 6))
    for i, period in SPRINGS:
        springs[i, i] = (body.matrix + hydro.added_mass_zero.values)[i, i] * (2 * np.pi / period) ** 2
    stiffness = hydro.hydrostatic_stiffness.values + springs
    models = {
        "SSM": og.identify(K, mass=body.matrix, stiffness=stiffness),
        "SSM, realization": og.identify(K, method="realization", r2=0.99, passive=False),
    }
    radiation = {name: og.StateSpaceRadiation(m, added_mass=m.A_inf) for name, m in models.items()}
    radiation["CIM"] = og.Convolution(K)
    sea = og.irregular(og.bretschneider(hs=2.5, tp=8.0), direction=HEAD, seed=2017, omega_range=(0.3, OMEGA[-1]))
    runs, decays, complaints = {}, {}, {}
    for name, load in radiation.items():
        still = og.Vessel(body, loads=(og.LinearRestoring(hydro), og.LinearMooring(springs), load))
        moving = og.Vessel(body, loads=(*still.loads, og.WaveExcitation(hydro)))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", og.OgilvieWarning)
            runs[name] = og.simulate(moving, sea, duration=DURATION, dt=DT, initial="rest", output_step=0.05)
            decays[name] = og.simulate(still, duration=DURATION, dt=0.05, initial={"eta": [0, 0, 0, HEEL, 0, 0]})
        complaints[name] = sorted({str(c.message).split(". ")[0] for c in caught})
    data = {"K": K, "models": models, "runs": runs, "decays": decays, "complaints": complaints}
    return _checks(data, body), data


def vessel() -> tuple[Any, Any]:
    """Return body and coefficients, with the height of the centre of gravity that gives the roll period."""
    cb = DISPLACEMENT / 1025.0 / np.prod(list(HULL.values()))
    hull = og.shapes.from_particulars(**HULL, cb=cb, panels=1600, name="HYSY201-like hull")

    def solved(kg: float) -> tuple[Any, Any]:
        body = og.RigidBody.from_hull(hull, kg=kg, gyradii=GYRADII)
        return body, og.solve_bem(hull, body, omega=OMEGA, wave_direction=[HEAD], progress=False)

    hydro = solved(14.0)[1]
    w = 2 * np.pi / ROLL_PERIOD
    A = hydro.added_mass.interp(omega=w).values
    lateral = np.ix_([1, 3, 5], [1, 3, 5])

    def excess(kg: float) -> float:
        """C44 - w^2 (M + A), sway and yaw free: zero at the natural frequency."""
        body = og.RigidBody.from_hull(hull, kg=kg, gyradii=GYRADII)
        C44 = hydro.hydrostatic_stiffness.values[3, 3] - body.mass * 9.80665 * (kg - 14.0)
        M = (body.matrix + A)[lateral]
        return C44 - w**2 / np.linalg.inv(M)[1, 1]

    return solved(brentq(excess, 10.0, 18.0))


def _checks(data: dict[str, Any], body: Any) -> list[dict[str, Any]]:
    K, runs = data["K"], data["runs"]
    checks = []
    for dof, i in SHOWN:
        model = data["models"]["SSM"]
        note = f"realization theory {data['models']['SSM, realization'].r2[i, i]:.4f}; published fits reach 0.99"
        checks.append(_check(f"R2 of K, SSM, {dof}", model.r2[i, i], 1.0, 0.01, note=note))
    for what, variable in (("radiation force", "force_radiation"), ("motion", "eta")):
        for dof, _ in SHOWN:
            early, late = (_difference(runs, "SSM", variable, dof, part) for part in ("early", "late"))
            other = _difference(runs, "SSM, realization", variable, dof, "late")
            note = f"realization theory {100 * other:.2f} %"
            checks.append(_check(f"{what}, {dof}: SSM - CIM after 65 s, r.m.s.", 100 * late, 0.0, 2.0, unit="%", note=note))
            note = "published: mostly inconsistent"
            checks.append(_check(f"{what}, {dof}: SSM - CIM before 65 s", 100 * early, 0.0, 2.0, unit="%", note=note))
    for name in ("SSM", "CIM"):
        found = decay_of(data["decays"][name])
        note = (
            f"KG {body.cog[2] + HULL['draught']:.2f} m chosen for it; damping of waves alone {found.damping_ratio.mean():.2%}"
        )
        checks.append(_check(f"roll period by {name}", float(np.median(found.period)), ROLL_PERIOD, 0.05, unit="s", note=note))
    phi = {k: d.eta.sel(dof="roll").values for k, d in data["decays"].items()}
    away = np.abs(phi["SSM"] - phi["CIM"]).max() / deg
    note = "radiation alone damps it, 0.02 % of critical"
    checks.append(_check("roll decay from 10 deg: largest SSM - CIM in 200 s", away, 0.0, 0.1, unit="deg", note=note))
    said = "; ".join(data["complaints"]["SSM, realization"]) or "nothing"
    note = f"said of realization theory, which is not passive: {said}"
    checks.append(_check("motions of the SSM that grow by themselves", len(data["complaints"]["SSM"]), 0.0, 0.0, note=note))
    states = ", ".join(f"{k} {m.order} states" for k, m in data["models"].items())
    checks[0]["note"] += f"; {states}; memory of the convolution {K.duration:.0f} s"
    return checks


def decay_of(run: Any) -> Any:
    """Return the analysis of a simulated roll decay."""
    return decay(run.time.values, run.eta.sel(dof="roll").values, model="linear", start=0.0)


def _difference(runs: dict[str, Any], name: str, variable: str, dof: str, part: str) -> float:
    """Return the r.m.s. difference to CIM, over the r.m.s. of CIM in the whole run."""
    x, y = (runs[k][variable].sel(dof=dof) for k in (name, "CIM"))
    chosen = slice(None, SETTLED) if part == "early" else slice(SETTLED, None)
    return float(np.sqrt(((x - y).sel(time=chosen) ** 2).mean() / (y**2).mean()))


def _check(name: str, value: float, reference: float, tolerance: float, *, unit: str = "", note: str = "") -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": reference, "tolerance": tolerance, "unit": unit, "source": SOURCE,
        "note": note,
    }  # fmt: skip


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw K, radiation forces and motions of surge, heave and pitch by both methods, and the roll decay."""
    grid = fig.add_gridspec(4, 3, height_ratios=[1, 1, 1, 0.9])
    K, runs = data["K"], data["runs"]
    fit = data["models"]["SSM"].impulse(K.t)
    index = {"surge": "11", "heave": "33", "pitch": "55"}
    for column, (dof, i) in enumerate(SHOWN):
        turns = dof == "pitch"
        ax = fig.add_subplot(grid[0, column])
        _pair(ax, K.t, K.K[:, i, i], fit[:, i, i], "N m" if turns else "N/m")
        ax.set(title=f"K{index[dof]}  {dof}", xlabel="t [s]", xlim=(0, 25))
        for row, (variable, word) in enumerate((("force_radiation", "radiation force"), ("eta", "motion")), start=1):
            ax = fig.add_subplot(grid[row, column])
            cim, ssm = (runs[k][variable].sel(dof=dof) for k in ("CIM", "SSM"))
            scale = 1 / deg if turns and variable == "eta" else 1.0
            unit = ("deg" if turns else "m") if variable == "eta" else ("N m" if turns else "N")
            _pair(ax, cim.time.values, cim.values * scale, ssm.values * scale, unit)
            ax.axvline(SETTLED, color="#c9971c", lw=0.9, ls=":")
            ax.set(title=f"{word}, {dof}", xlim=(0, 120))
            ax.set_xlabel("time [s]")
    ax = fig.add_subplot(grid[3, :])
    decays = data["decays"]
    t = decays["CIM"].time.values
    phi = [decays[k].eta.sel(dof="roll").values / deg for k in ("CIM", "SSM")]
    _pair(ax, t, phi[0], phi[1], "deg")
    found = decay_of(decays["CIM"])
    ax.set(
        title=f"roll decay without viscous damping, period {np.median(found.period):.2f} s", xlabel="time [s]", xlim=(0, 200)
    )
    fig.axes[1].text(SETTLED + 2, 0.02, "65 s", transform=fig.axes[1].get_xaxis_transform(), fontsize=6.5, color="#8a6a10")
    fig.legend(*fig.axes[0].get_legend_handles_labels(), loc="outside upper right", ncols=2)


def _pair(ax: Any, t: np.ndarray, cim: np.ndarray, ssm: np.ndarray, unit: str) -> None:
    """Draw two curves that should be one."""
    largest = np.abs(cim).max()
    exponent = 3 * int(np.floor(np.log10(largest) / 3)) if largest >= 1e3 or largest < 0.1 else 0
    ax.plot(t, cim / 10.0**exponent, color="#22262b", lw=3, alpha=0.3, label="convolution (CIM)")
    ax.plot(t, ssm / 10.0**exponent, color="#2f6db0", lw=1.1, label="state space (SSM)")
    ax.set_ylabel(f"[10$^{{{exponent}}}$ {unit}]" if exponent else f"[{unit}]")
