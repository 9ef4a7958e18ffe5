"""Paper D, section 6: second-order roll of the tanker KVLCC2 in beam seas."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.units import deg


def _ship() -> ModuleType:
    """Return the ship of paper D beside this file."""
    spec = importlib.util.spec_from_file_location("paper_d_ship", Path(__file__).with_name("ship.py"))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


D = _ship()

TITLE = "Second-order roll of KVLCC2 in beam seas (Somayajula and Falzarano 2016)"
ABOUT = """\
Somayajula and Falzarano (2016), Ocean Systems Engineering: GM 5.703 m, roll period 21.02 s, outside the waves but among
their differences. KG is chosen for the GM and kxx for the period, with sway and yaw free to follow; the paper gives KG, no
kxx. Mean drift by pressure integration, moments about the O that moves with the body; the paper names neither point nor
axes. Long-crested waves of 0.4 to 1.3 rad/s (the 720 panels of half the hull resolve 1.2), soft mooring (250 s), no viscous
damping, as in the paper. **Its moments and motions are figures without numbers**; compared are its table, what its text
says (the three Newman forms are almost the same; roll is small without and far larger with the second order), and the time
loop with transfer functions and closed forms. The paper's first Newman form, D_i alone, is the arithmetic mean in the sum;
`newman-1974` here takes the drift at the mean frequency. Waves alone damp this roll by 0.06 % of critical: it takes hours
to settle, would be far beyond small motions then, and in 1000 s still grows; the roll of an undamped run is a matter of its
length. It is compared with the growth of an oscillator under the forces of all pairs (100 realisations tell its rms to
about 5 %), and run with viscous damping too: that measured on the bare hull (SSPA 2018, see `kvlcc2_roll_decay`), its
quadratic part by B = sqrt(8/pi) sigma_p B2, and 5 % of critical, taken for a hull with bilge keels."""
NEEDS = list(D.NEEDS)
HEIGHT = 8.6

PAIR = {"height": (7.0, 8.0), "period": (7.0, 10.75)}
WINDOW, LONG, DT = 1000.0, 3600.0, 0.25  # s
SEEDS, COMPONENTS, SETTLED = range(100), 600, 600.0  # realisations, of each, s
LINEAR, QUADRATIC = 156.7e6, 1.9e10  # kg m2/s with that of the waves, kg m2: bare hull, measured
BILGE = 0.05  # of critical
PAPER, THEORY = "Somayajula and Falzarano (2016)", "transfer functions"
ARITHMETIC = "newman-arithmetic"


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the checks and what the figure needs."""
    assert shared is not None
    ship = D.prepared(shared)
    K = og.retardation(ship.hydro)
    model = og.identify(K, mass=ship.body.matrix, stiffness=ship.hydro.hydrostatic_stiffness.values)
    case = {"ship": ship, "radiation": og.StateSpaceRadiation(model), "loads": {k: og.SlowDrift(ship.slow, k) for k in D.FORMS}}
    vessel = D.moored(ship, case["radiation"], drift=ARITHMETIC)
    case["period"], case["ratio"] = D.roll_damping(vessel)
    pair = _pair(case)
    storm = _storm(case)
    return [*_table(case), *pair["checks"], *storm["checks"]], {"pair": pair, "storm": storm, "case": case}


def _table(case: dict[str, Any]) -> list[dict[str, Any]]:
    ship = case["ship"]
    note = f"chosen for GM {D.GM} m; KM {ship.rest.KM_T:.2f} m of this mesh, {D.KG + D.GM:.2f} m in the paper"
    tonnes = ship.body.mass / 1e3
    return [
        _check("KG", ship.hull.draught + ship.body.cog[2], D.KG, 0.5, "m", PAPER, note),
        _check("displacement", tonnes, D.DISPLACEMENT, 0.01 * D.DISPLACEMENT, "t", PAPER, "coarse mesh"),
        _check(
            "roll period in the time loop's equations", case["period"], D.PERIOD, 0.02, "s", PAPER,
            f"kxx {ship.gyradius:.2f} m chosen; wave damping {100 * case['ratio']:.3f} % of critical",
        ),
    ]  # fmt: skip


def _pair(case: dict[str, Any]) -> dict[str, Any]:
    """Two regular waves: moments of the three forms, roll with and without the second order."""
    sea = og.bichromatic(**PAIR, direction=D.BEAM)
    (w1, w2), (a1, a2) = sea.omega, sea.amplitude
    t = np.arange(0.0, WINDOW, DT)
    moment = {k: load.series(sea, t)[:, D.ROLL] for k, load in case["loads"].items()}
    D1, D2 = (case["loads"][ARITHMETIC].qtf([w], [w], D.BEAM)[0, D.ROLL].real for w in (w1, w2))
    middle = case["loads"][ARITHMETIC].qtf([(w1 + w2) / 2], [(w1 + w2) / 2], D.BEAM)[0, D.ROLL].real
    closed = {
        "newman-1974": 2 * a1 * a2 * abs(middle),
        ARITHMETIC: a1 * a2 * abs(D1 + D2),
        "newman-geometric": 2 * a1 * a2 * np.sqrt(D1 * D2),
    }
    checks = []
    for form, wanted in closed.items():
        found = abs(_harmonics(t, moment[form], [w1 - w2])[0])
        checks.append(
            _check(f"bichromatic, {form}: roll moment at the difference / closed form", found / wanted, 1.0, 2e-3, "", THEORY,
                   f"{wanted / 1e6:.1f} MN m, {wanted / closed[ARITHMETIC]:.3f} of the arithmetic mean's")
        )  # fmt: skip
    runs = {}
    B = {"waves only": 0.0, "5 % of critical": _critical(case, BILGE)}
    for name, damping in B.items():
        vessel = D.moored(case["ship"], case["radiation"], drift=ARITHMETIC, roll=damping)
        runs[name] = og.simulate(vessel, sea, duration=WINDOW, dt=DT, variables=("eta",))
        roll = runs[name].eta.sel(dof="roll").values
        period, ratio = D.roll_damping(vessel)
        w0 = 2 * np.pi / period
        Q = case["loads"][ARITHMETIC].qtf([w1], [w2], D.BEAM)[0]
        wanted = abs(D.roll_of_force(vessel, np.array([w1 - w2]))[0] @ Q) * 2 * a1 * a2
        found = abs(_harmonics(runs[name].time.values, roll, [w1 - w2, w1, w2], free=w0 * (1j - ratio))[0])
        checks.append(
            _check(f"bichromatic, {name}: roll at the difference / transfer function", found / wanted, 1.0, 0.02, "", THEORY,
                   f"{found / deg:.2f} deg; largest in 1000 s, with what the start leaves, {np.abs(roll).max() / deg:.1f} deg")
        )  # fmt: skip
        rise = np.divide(*np.abs(D.roll_of_force(vessel, np.array([w1 - w2, 0.0]))[:, D.ROLL]))
        closed_rise = 1 / np.hypot(1 - ((w1 - w2) / w0) ** 2, 2 * ratio * (w1 - w2) / w0)
        checks.append(
            _check(f"bichromatic, {name}: amplification / oscillator's", rise / closed_rise, 1.0, 0.03, "", "one oscillator",
                   f"roll of a roll moment {rise:.1f} times that at rest; difference period {2 * np.pi / (w1 - w2):.2f} s")
        )  # fmt: skip
    without = og.simulate(D.moored(case["ship"], case["radiation"]), sea, duration=WINDOW, dt=DT, variables=("eta",))
    runs["first order"] = without
    ratio = runs["waves only"].eta.sel(dof="roll").std() / without.eta.sel(dof="roll").std()
    std = float(without.eta.sel(dof="roll").std()) / deg
    checks.append(
        _check("bichromatic: roll std in 1000 s with / without second order", float(ratio), 1.0, np.inf, "", PAPER,
               f"for information; first order {std:.2f} deg; the paper says 'significantly larger' of the irregular sea")
    )  # fmt: skip
    return {"checks": checks, "t": t, "moment": moment, "runs": runs}


def _harmonics(t: np.ndarray, x: np.ndarray, omega: list[float], free: complex | None = None) -> np.ndarray:
    """Return complex amplitudes of harmonics by least squares, beside a mean and, if wished, a decaying free oscillation."""
    waves = [1j * w for w in omega] + ([free] if free is not None else [])
    use = t >= 0.2 * t[-1]
    basis = [np.ones(use.sum())]
    for s in waves:
        e = np.exp(s * t[use])
        basis += [e.real, -e.imag]
    c = np.linalg.lstsq(np.stack(basis, axis=1), x[use], rcond=None)[0][1:]
    return c[0 : 2 * len(omega) : 2] + 1j * c[1 : 2 * len(omega) : 2]


def _critical(case: dict[str, Any], part: float) -> float:
    """Return roll damping (N m s) that is a part of critical."""
    C44 = case["ship"].hydro.hydrostatic_stiffness.values[D.ROLL, D.ROLL]
    return float(2 * part * C44 * case["period"] / (2 * np.pi))


def storm(seeds: Any) -> Any:
    """Return the paper's sea: JONSWAP, Hs 8 m, Tz 7 s, and a regular wave of 7 m and 11 s."""
    wind = og.irregular(og.jonswap(hs=8.0, tz=7.0), direction=D.BEAM, n=COMPONENTS, seed=seeds, omega_range=D.WAVES, g=D.G)
    return wind + og.regular(height=7.0, period=11.0, direction=D.BEAM, g=D.G)


def _storm(case: dict[str, Any]) -> dict[str, Any]:
    sea, slow, ship = storm(SEEDS), case["loads"][ARITHMETIC], case["ship"]
    t = np.arange(0.0, WINDOW, 0.5)
    moment = {k: load.series(sea, t)[..., D.ROLL] for k, load in case["loads"].items()}
    checks = []
    for form in ("newman-1974", "newman-geometric"):
        one, two = moment[form], moment[ARITHMETIC]
        r = np.mean([np.corrcoef(x, y)[0, 1] for x, y in zip(one, two, strict=True)])
        note = f"rms ratio {one.std() / two.std():.3f}; 'almost equivalent' (figure 5)"
        checks.append(_check(f"storm: roll moment, {form} with arithmetic, correlation", r, 1.0, 0.05, "", PAPER, note))
    free = D.moored(ship, case["radiation"], drift=ARITHMETIC)
    settled = D.expected(free, slow, sea)
    bare = _bare(case, sea, settled.second)
    runs, std = {}, {}
    for form in D.FORMS:
        vessel = D.moored(ship, case["radiation"], drift=form)
        runs[form] = og.simulate(vessel, sea, duration=LONG if form == ARITHMETIC else WINDOW, dt=DT, variables=("eta",))
        std[form] = _std(runs[form], 0.0, WINDOW)
    runs["first order"] = og.simulate(D.moored(ship, case["radiation"]), sea, duration=WINDOW, dt=DT, variables=("eta",))
    first = _std(runs["first order"], 0.0, WINDOW)
    checks.append(
        _check("storm, first order: roll std / transfer functions", first / settled.first, 1.0, 0.05, "", THEORY,
               f"{first / deg:.2f} deg: 'significantly low'")
    )  # fmt: skip
    growth: dict[float, float] = {}
    for end in (WINDOW, LONG):
        times = np.linspace(0, end, 9)[1:] - end / 16
        growth |= {s: _grown(free, slow, sea, s, ship) for s in times}
        wanted = np.sqrt(np.mean([growth[s] for s in times]))
        found = _std(runs[ARITHMETIC], 0.0, end)
        checks.append(
            _check(f"storm, waves only: roll rms in {end:.0f} s / growth of an oscillator", found / wanted, 1.0, 0.15, "",
                   THEORY, f"{found / deg:.1f} deg, {found / first:.0f} times the first order's: 'significantly larger'; "
                   f"settled {settled.both / deg:.0f} deg")
        )  # fmt: skip
    for form in ("newman-1974", "newman-geometric"):
        ratio = std[form] / std[ARITHMETIC]
        checks.append(_check(f"storm: roll rms in 1000 s, {form} / arithmetic", ratio, 1.0, 0.1, "", PAPER, "same seeds"))
    for name, damping in (("bare hull", bare), ("5 % of critical", _critical(case, BILGE))):
        vessel = D.moored(ship, case["radiation"], drift=ARITHMETIC, roll=damping)
        runs[name] = og.simulate(vessel, sea, duration=LONG, dt=DT, variables=("eta",))
        wanted, found = D.expected(vessel, slow, sea), _std(runs[name], SETTLED, LONG)
        ratio = D.roll_damping(vessel)[1]
        plain = D.expected(D.moored(ship, case["radiation"], roll=damping), slow, sea).first
        checks.append(
            _check(f"storm, {name}: roll std / transfer functions", found / wanted.both, 1.0, 0.03, "", THEORY,
                   f"{found / deg:.2f} deg, {plain / deg:.2f} without second order; damping {100 * ratio:.1f} % of critical, "
                   f"{len(SEEDS)} seeds of {LONG - SETTLED:.0f} s")
        )  # fmt: skip
        mean = runs[name].eta.sel(dof="roll", time=slice(SETTLED, LONG)).mean() / wanted.mean
        checks.append(_check(f"storm, {name}: mean heel / sum a2 D", float(mean), 1.0, 0.03, "", THEORY,
                             f"{wanted.mean / deg:.2f} deg"))  # fmt: skip
    return {"checks": checks, "sea": sea, "t": t, "moment": moment, "runs": runs, "growth": growth}


def _bare(case: dict[str, Any], sea: Any, start: float) -> float:
    """Return the viscous roll damping (N m s) of the bare hull, linear for the motion that it has in this sea."""
    waves = _critical(case, case["ratio"])
    damping, second = LINEAR - waves, start
    for _ in range(12):
        w0 = 2 * np.pi / case["period"]
        damping = 0.5 * (damping + LINEAR - waves + np.sqrt(8 / np.pi) * QUADRATIC * w0 * second)
        vessel = D.moored(case["ship"], case["radiation"], roll=damping)
        second = D.expected(vessel, case["loads"][ARITHMETIC], sea).second
    return float(damping)


def _grown(vessel: Any, slow: Any, sea: Any, t: float, ship: Any) -> float:
    """Return the mean square of roll about zero at t after a start without slow motion."""
    found = D.expected(vessel, slow, sea, since=t, pole=D.roll_damping(vessel))
    return found.both**2


def _std(run_: Any, begin: float, end: float) -> float:
    """Return the root mean square over realisations of the deviation of roll from the mean of all."""
    roll = run_.eta.sel(dof="roll", time=slice(begin, end)).values
    return float((roll - roll.mean()).std())


def _check(
    name: str, value: float, reference: float, tolerance: float, unit: str, source: str, note: str = ""
) -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": reference, "tolerance": tolerance, "unit": unit, "source": source,
        "note": note,
    }  # fmt: skip


def draw(data: dict[str, Any], fig: Any) -> None:
    """Moments of the three forms, roll with and without second order, how it grows."""
    axes = fig.subplot_mosaic([["a", "b"], ["c", "d"], ["e", "e"]])
    pair, storm_ = data["pair"], data["storm"]
    for form in D.FORMS:
        axes["a"].plot(pair["t"], pair["moment"][form] / 1e6, lw=1.0, label=form)
        axes["b"].plot(storm_["t"], storm_["moment"][form][0] / 1e6, lw=0.8, label=form)
    axes["a"].set(xlim=(0, 100), ylim=(None, 320), title="bichromatic: second-order roll moment [MN m]", xlabel="time [s]")
    axes["b"].set(xlim=(400, 600), ylim=(-1000, 350), title="storm: second-order roll moment [MN m]", xlabel="time [s]")
    colours = {"waves only": "#d1495b", "5 % of critical": "#2f6db0", "first order": "#22262b"}
    for name, colour in colours.items():
        run_ = pair["runs"][name]
        axes["c"].plot(run_.time, run_.eta.sel(dof="roll") / deg, color=colour, lw=0.7, label=name)
    axes["c"].set(title="bichromatic: roll [deg]", xlabel="time [s]", xlim=(0, WINDOW), ylim=(-38, 62))
    lines = {ARITHMETIC: ("no viscous damping", "#d1495b"), "bare hull": ("bare hull", "#c9971c")}
    lines |= {"5 % of critical": ("5 % of critical", "#2f6db0"), "first order": ("first order", "#22262b")}
    for name, (label, colour) in lines.items():
        run_ = storm_["runs"][name]
        roll = run_.eta.sel(dof="roll").isel(realisation=0).sel(time=slice(0, WINDOW)) / deg
        axes["d"].plot(roll.time, roll, color=colour, lw=0.7, label=label)
        if name != "first order":
            everyone = run_.eta.sel(dof="roll").values / deg
            spread = np.sqrt(np.convolve(everyone.var(axis=0), np.ones(240) / 240, "valid"))
            axes["e"].plot(run_.time.values[120 : 120 + len(spread)], spread, color=colour, lw=1.2, label=label)
    axes["d"].set(title="storm: roll [deg], one realisation", xlabel="time [s]", xlim=(0, WINDOW), ylim=(-16, 24))
    times = sorted(storm_["growth"])
    grown = [np.sqrt(storm_["growth"][s]) / deg for s in times]
    axes["e"].plot(times, grown, "--", color="#22262b", lw=1.0, label="growth of an oscillator, all pairs")
    axes["e"].set(title=f"storm: roll std over {len(SEEDS)} realisations, 60 s means [deg]", xlabel="time [s]", xlim=(0, LONG))
    for ax in axes.values():
        ax.legend(fontsize=6.5, loc="upper left")
