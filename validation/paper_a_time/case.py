"""Paper A, sections VI and VII: the time that the state space saves, and how much of it is the way of convolving."""

import importlib.util
import time
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.units import deg

TITLE = "Time of the state space and of the convolution (Yuan et al. 2017)"
ABOUT = """Yuan, Ma, Zan and Wu (2017), J. Marine Science and Technology (Taiwan) 25(6), report 6.86 s by their state-space
model (SSM) and 30 s by the convolution integral (CIM) for a roll decay of 200 s, and 22.36 s and 10.26 min for motions in
waves, at a time step of 0.01 s: ratios of 4.4 (3.24 in their text) and 28. Here the roll decay of the vessel of
`paper_a_motions` is run by both in three ways, on one machine in one run: as one would write it first (one trapezoid sum for
each coupling), vectorised (one matrix product for all), both in numpy with the classical Runge-Kutta method and one
convolution a step, and in the compiled loop of `simulate`, whose convolution is of fourth order. The ratio says as much about
the way of convolving as about the idea; it is given for information, nothing is required of it. What is required is that all
give the same motion. Time also depends on the length of the memory and on the number of states; the paper states neither."""
NEEDS: list[str] = []
HEIGHT = 3.4

DT = 0.01  # s, as published
STEPS = 2000  # of the numpy loops
DURATION = 200.0  # s, for which times are given
COMPILED = 2000.0  # s, of the compiled loop
MEMORY = 30.0  # s
HEEL = 10 * deg
PUBLISHED = {"roll decay": 30.0 / 6.86, "motions in waves": 10.26 * 60 / 22.36}
WAYS = ("per coupling, trapezoid (numpy)", "one product for all (numpy)", "compiled, fourth order")
SOURCE = "Yuan et al. (2017), sections VI and VII"


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the ratios of time and the differences of the motions."""
    data = measure()
    checks = []
    for way in WAYS:
        cim, ssm = data["seconds"][way]
        note = (
            f"SSM {ssm:.3g} s, CIM {cim:.3g} s for 200 s; {data['states']} states, memory {MEMORY:g} s, "
            f"{data['couplings']} couplings; published also {PUBLISHED['motions in waves']:.1f} for motions in waves"
        )
        checks.append(_check(f"time of CIM over that of SSM, {way}", cim / ssm, PUBLISHED["roll decay"], np.inf, note))
    scale = np.abs(data["roll"]["SSM, compiled"]).max()
    others = {name: roll for name, roll in data["roll"].items() if name != "CIM, compiled"}
    for name, roll in others.items():
        away = np.abs(roll - data["roll"]["CIM, compiled"]).max() / scale
        checks.append(_check(f"roll of {name} less that of the compiled CIM, first 20 s", 100 * away, 0.0, 1.0, "", "%"))
    return checks, data


def measure() -> dict[str, Any]:
    """Return seconds of CIM and SSM for 200 s of simulation by each way, and the roll of each (STEPS,)."""
    body, hydro = _motions().vessel()
    K = og.retardation(hydro, duration=MEMORY, dt=DT)
    springs = np.diag([(body.matrix + hydro.added_mass_zero.values)[i, i] * (2 * np.pi / p) ** 2 if p else 0.0
                       for i, p in enumerate((120.0, 120.0, 0.0, 0.0, 0.0, 100.0))])  # fmt: skip
    stiffness = hydro.hydrostatic_stiffness.values + springs
    model = og.identify(K, mass=body.matrix, stiffness=stiffness)
    M = body.matrix + K.A_inf
    loops = {
        ("CIM", WAYS[0]): lambda: _numpy_convolution(M, stiffness, _per_coupling(K)),
        ("CIM", WAYS[1]): lambda: _numpy_convolution(M, stiffness, _one_product(K)),
        ("SSM", WAYS[0]): lambda: _numpy_state_space(body.matrix + model.A_inf, stiffness, model),
    }
    seconds, roll = {}, {}
    for (kind, way), loop in loops.items():
        took, roll[f"{kind}, {way if kind == 'CIM' else 'numpy'}"] = loop()
        seconds[kind, way] = took * DURATION / (STEPS * DT)
    seconds["SSM", WAYS[1]] = seconds["SSM", WAYS[0]]
    for kind, load in (("CIM", og.Convolution(K, truncation=MEMORY)), ("SSM", og.StateSpaceRadiation(model))):
        vessel = og.Vessel(body, loads=(og.LinearRestoring(hydro), og.LinearMooring(springs), load))
        runs = [og.simulate(vessel, duration=COMPILED, dt=DT, initial={"eta": [0, 0, 0, HEEL, 0, 0]}) for _ in range(3)]
        seconds[kind, WAYS[2]] = min(r.attrs["wall_time"] for r in runs) * DURATION / COMPILED
        roll[f"{kind}, compiled"] = runs[0].eta.sel(dof="roll").values[:STEPS]
    return {
        "seconds": {way: (seconds["CIM", way], seconds["SSM", way]) for way in WAYS},
        "roll": roll,
        "states": model.order,
        "couplings": int(np.any(K.K, axis=0).sum()),
    }


def _per_coupling(K: Any) -> Callable[[np.ndarray], np.ndarray]:
    """Return mu of the past velocities (6, n), newest last: a trapezoid sum for each coupling."""
    pairs = np.argwhere(np.any(K.K, axis=0))
    backwards = {(i, j): np.ascontiguousarray(K.K[::-1, i, j]) for i, j in pairs}

    def force(past: np.ndarray) -> np.ndarray:
        mu = np.zeros(6)
        for (i, j), k in backwards.items():
            mu[i] += np.trapezoid(k * past[j], dx=DT)
        return mu

    return force


def _one_product(K: Any) -> Callable[[np.ndarray], np.ndarray]:
    """Return the same by one matrix product."""
    weighted = K.K[::-1] * DT
    weighted[[0, -1]] *= 0.5
    matrix = np.ascontiguousarray(weighted.transpose(1, 2, 0).reshape(6, -1))
    return lambda past: matrix @ past.ravel()


def _numpy_convolution(M: np.ndarray, C: np.ndarray, force: Callable[[np.ndarray], np.ndarray]) -> tuple[float, np.ndarray]:
    """Return seconds and roll of STEPS classical Runge-Kutta steps; the memory force is held over each."""
    W, n = np.linalg.inv(M), round(MEMORY / DT)
    past = np.zeros((6, n + STEPS))
    z, roll = np.zeros(12), np.empty(STEPS)
    z[3] = HEEL
    begin = time.perf_counter()
    for k in range(STEPS):
        roll[k] = z[3]
        past[:, n + k] = z[6:]
        mu = force(past[:, k : n + k + 1])
        z = _runge_kutta(lambda y, mu=mu: np.concatenate([y[6:], W @ (-C @ y[:6] - mu)]), z)
    return time.perf_counter() - begin, roll


def _numpy_state_space(M: np.ndarray, C: np.ndarray, model: Any) -> tuple[float, np.ndarray]:
    """Return the same with the state space."""
    W = np.linalg.inv(M)
    z, roll = np.zeros(12 + model.order), np.empty(STEPS)
    z[3] = HEEL

    def rate(y: np.ndarray) -> np.ndarray:
        nu, x = y[6:12], y[12:]
        return np.concatenate([nu, W @ (-C @ y[:6] - model.C @ x), model.A @ x + model.B @ nu])

    begin = time.perf_counter()
    for k in range(STEPS):
        roll[k] = z[3]
        z = _runge_kutta(rate, z)
    return time.perf_counter() - begin, roll


def _runge_kutta(rate: Callable[[np.ndarray], np.ndarray], z: np.ndarray) -> np.ndarray:
    k1 = rate(z)
    k2 = rate(z + DT / 2 * k1)
    k3 = rate(z + DT / 2 * k2)
    k4 = rate(z + DT * k3)
    return z + DT / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def _motions() -> ModuleType:
    """Return the case that makes the vessel."""
    spec = importlib.util.spec_from_file_location(
        "ogilvie_validation_paper_a_motions", Path(__file__).parents[1] / "paper_a_motions" / "case.py"
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _check(name: str, value: float, reference: float, tolerance: float, note: str, unit: str = "") -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": reference, "tolerance": tolerance, "unit": unit, "source": SOURCE,
        "note": note,
    }  # fmt: skip


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw seconds for 200 s of simulation, published and here."""
    ax = fig.subplots()
    rows = {"published, roll decay": (30.0, 6.86), **data["seconds"]}
    place = np.arange(len(rows))
    for k, (kind, colour) in enumerate((("CIM", "#c4c8ce"), ("SSM", "#2f6db0"))):
        ax.barh(place + 0.2 * (2 * k - 1), [s[k] for s in rows.values()], 0.38, color=colour, label=kind)
    for y, (cim, ssm) in zip(place, rows.values(), strict=True):
        ax.text(1.15 * max(cim, ssm), y, f"{cim / ssm:.1f} : 1", va="center", fontsize=7)
    ax.set_yticks(place, rows)
    ax.invert_yaxis()
    ax.set(xscale="log", title="time for a roll decay of 200 s, time step 0.01 s [s]", xlim=(None, 400))
    ax.grid(axis="y", visible=False)
    ax.legend(loc="lower right")
