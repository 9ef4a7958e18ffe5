"""Paper D, section 4: sway and roll difference-frequency QTF of KVLCC2 in beam seas by three Newman approximations."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.loads.quadratic import double_sum


def _ship() -> ModuleType:
    """Return the ship of paper D."""
    path = Path(__file__).parents[1] / "paper_d_second_order_roll" / "ship.py"
    spec = importlib.util.spec_from_file_location("paper_d_ship", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


D = _ship()

TITLE = "Newman's approximations of the sway and roll QTF of KVLCC2 (Somayajula and Falzarano 2016)"
ABOUT = """Figures 3 and 4 of Somayajula and Falzarano (2016) show the QTF of sway and roll in beam seas by three forms of
Newman's approximation, without numbers: their shape and what their text says are all there is to compare with. The ship is
that of `paper_d_second_order_roll`. All forms equal the mean drift on the diagonal and are Hermitian; beside it they part with
the square of the difference d of the frequencies: the arithmetic mean less the drift at the mean frequency by D'' d^2/8, less
the geometric mean by D'^2 d^2/(8 D), both checked. The paper's first form, Q_ij = D_i, is not Hermitian; in the double sum it
is the arithmetic mean, which is checked too, and the drift at the mean frequency takes its place here. At the roll frequency,
0.3 rad/s off the diagonal, the forms are close where both waves are shorter than 11 s; where one is longer, and drifts the ship
little by itself, they are up to 35 % (geometric) and 77 % (mean frequency) of the largest value apart. Moments refer to the O
that moves with the body; those about its fixed mean position are drawn too. The paper names neither."""
NEEDS = list(D.NEEDS)
HEIGHT = 8.4

GRID = np.linspace(0.4, 1.3, 73)  # rad/s
AT = 0.825  # rad/s: between two frequencies of the data, so that the spline there is one cubic
CLOSE = {"newman-1974": 0.05, "newman-geometric": 0.01}  # rad/s: the first form is exact where both waves are in the data
SHIFT = 2 * np.pi / D.PERIOD  # rad/s
SOURCE, THEORY = "Somayajula and Falzarano (2016)", "closed form"
DOFS = {"sway": 1, "roll": 3}
ARITHMETIC = "newman-arithmetic"


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the checks and what the figure needs."""
    assert shared is not None
    ship = D.prepared(shared)
    loads = {form: og.SlowDrift(ship.slow, form) for form in D.FORMS}
    i, j = (x.ravel() for x in np.indices((len(GRID), len(GRID))))
    Q = {k: load.qtf(GRID[i], GRID[j], D.BEAM).reshape(len(GRID), len(GRID), 6) for k, load in loads.items()}
    return [*_identities(ship, loads, Q), *_beside(loads), *_apart(loads, ship)], {"ship": ship, "Q": Q, "loads": loads}


def _identities(ship: Any, loads: dict[str, Any], Q: dict[str, np.ndarray]) -> list[dict[str, Any]]:
    w, drift = ship.drift.omega.values, ship.drift.mean_drift.values[:, 0]
    checks = []
    for form, load in loads.items():
        away = np.abs(load.qtf(w, w, D.BEAM) - drift)
        for name, i in DOFS.items():
            part = away[:, i].max() / np.abs(drift[:, i]).max()
            checks.append(_check(f"{name}, {form}: diagonal less mean drift", part, 0.0, 1e-9, THEORY, "part of the largest"))
        skew = np.abs(Q[form] - Q[form].conj().swapaxes(0, 1)).max() / np.abs(Q[form]).max()
        checks.append(_check(f"{form}: Q(w1, w2) - Q(w2, w1)*", skew, 0.0, 1e-9, SOURCE, "Eq. (53), part of the largest"))
    sea = og.irregular(
        og.jonswap(hs=7.0, tz=7.0), direction=D.BEAM, n=60, seed=1, omega_range=D.WAVES, g=D.G
    )  # of the paper's figure 5
    n, t = len(sea.omega), np.arange(0.0, 600.0, 1.0)
    diagonal = loads[ARITHMETIC].qtf(sea.omega, sea.omega, D.BEAM)
    first = double_sum(sea.complex_amplitude, sea.omega, np.broadcast_to(diagonal[:, None], (n, n, 6)), t)
    away = np.abs(first - loads[ARITHMETIC].series(sea, t)) / np.abs(first).max(axis=0)
    note = "Eqs. (46), (47), (51): double sum with D_i against the products of single sums"
    checks.append(
        _check("sway, roll: force of Q = D_i less that of the arithmetic mean", away[:, [1, 3]].max(), 0.0, 1e-6, SOURCE, note)
    )
    series = {k: load.series(sea, t) for k, load in loads.items()}
    for form in ("newman-1974", "newman-geometric"):
        r = np.corrcoef(series[form][:, D.ROLL], series[ARITHMETIC][:, D.ROLL])[0, 1]
        ratio = series[form][:, D.ROLL].std() / series[ARITHMETIC][:, D.ROLL].std()
        checks.append(
            _check(
                f"roll moment in Hs 7 m, Tz 7 s, {form} with arithmetic, correlation",
                r,
                1.0,
                0.05,
                SOURCE,
                f"std ratio {ratio:.3f}; figure 5: 'all three approximations are almost equivalent'",
            )
        )
    return checks


def _beside(loads: dict[str, Any]) -> list[dict[str, Any]]:
    """Compare differences of the forms beside the diagonal with their leading terms."""
    h = 1e-3
    at = loads[ARITHMETIC].qtf([AT - h, AT, AT + h], [AT - h, AT, AT + h], D.BEAM).real
    first, second, here = (at[2] - at[0]) / (2 * h), (at[2] - 2 * at[1] + at[0]) / h**2, at[1]
    checks = []
    for name, i in DOFS.items():
        rate = {"newman-1974": second[i] / 8, "newman-geometric": first[i] ** 2 / (8 * here[i])}
        for form, d in CLOSE.items():
            pair = [k.qtf([AT - d / 2], [AT + d / 2], D.BEAM)[0, i].real for k in (loads[ARITHMETIC], loads[form])]
            found, wanted = pair[0] - pair[1], rate[form] * d**2
            note = f"{abs(wanted / here[i]):.1e} of D at {AT} rad/s, {d} rad/s apart"
            checks.append(_check(f"{name}: arithmetic less {form} / leading term", found / wanted, 1.0, 0.05, THEORY, note))
    return checks


def _apart(loads: dict[str, Any], ship: Any) -> list[dict[str, Any]]:
    """Compare the forms where the difference is the roll frequency, and the two sorts of moments."""
    lower = np.linspace(GRID[0], GRID[-1] - SHIFT, 60)
    Q = {k: load.qtf(lower, lower + SHIFT, D.BEAM).real for k, load in loads.items()}
    checks = []
    for name, i in DOFS.items():
        size = np.abs(Q[ARITHMETIC][:, i]).max()
        for form in ("newman-1974", "newman-geometric"):
            away = np.abs(Q[form][:, i] - Q[ARITHMETIC][:, i]) / size
            note = f"information; at {lower[away.argmax()]:.2f} and {lower[away.argmax()] + SHIFT:.2f} rad/s"
            long = away[lower > 0.55].max()
            checks.append(
                _check(
                    f"{name}: {form} - arithmetic at the roll frequency, largest",
                    100 * away.max(),
                    0.0,
                    np.inf,
                    SOURCE,
                    note,
                    "% of largest there",
                )
            )
            checks.append(
                _check(
                    f"{name}: {form} - arithmetic at the roll frequency, above 0.55 rad/s",
                    100 * long,
                    0.0,
                    10.0,
                    SOURCE,
                    "'qualitatively similar'",
                    "% of largest there",
                )
            )
    drift = ship.drift
    near, far = drift.mean_drift.values[:, 0, 1], drift.mean_drift_momentum.values[:, 0, 1]
    checks.append(
        _check(
            "sway: pressure integration - far field, largest",
            100 * np.abs(near - far).max() / np.abs(far).max(),
            0.0,
            10.0,
            "each other",
            f"{len(near)} frequencies, 720 panels of half the hull",
            "% of largest",
        )
    )
    body, space = drift.mean_drift_pressure_body.values[:, 0, 3], drift.mean_drift_pressure.values[:, 0, 3]
    w = drift.omega.values
    most = np.abs(space - body).argmax()
    checks.append(
        _check(
            "roll: moment about fixed - about moving O, largest",
            100 * abs(space - body)[most] / np.abs(body).max(),
            0.0,
            np.inf,
            SOURCE,
            f"information; at {w[most]:.2f} rad/s",
            "% of largest",
        )
    )
    return checks


def _check(
    name: str, value: float, reference: float, tolerance: float, source: str, note: str = "", unit: str = ""
) -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": reference, "tolerance": tolerance, "unit": unit, "source": source,
        "note": note,
    }  # fmt: skip


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw the matrices of sway and roll, their diagonals, and the cut at the roll frequency."""
    grid = fig.add_gridspec(3, 6, height_ratios=[1, 1, 1])
    for row, (name, i) in enumerate(DOFS.items()):
        unit, scale = ("MN/m2", 1e-6) if i < 3 else ("MN m/m2", 1e-6)
        values = {k: scale * Q[:, :, i].real for k, Q in data["Q"].items()}
        levels = np.linspace(min(v.min() for v in values.values()), max(v.max() for v in values.values()), 17)
        axes = []
        for column, (form, value) in enumerate(values.items()):
            ax = fig.add_subplot(grid[row, 2 * column : 2 * column + 2])
            filled = ax.contourf(GRID, GRID, value.T, levels=levels, cmap="viridis")
            for sign in (-1, 1):
                ax.plot(GRID, GRID + sign * SHIFT, color="w", lw=0.8, ls=":")
            ax.set(xlim=(0.4, 1.3), ylim=(0.4, 1.3), aspect="equal", xlabel="[rad/s]", title=f"{name}, {form[7:]}")
            if column == 0:
                ax.set_ylabel("[rad/s]")
            axes.append(ax)
        fig.colorbar(filled, ax=axes, label=unit, shrink=0.9, format="%.3g")
    lower = np.linspace(GRID[0], GRID[-1] - SHIFT, 60)
    for column, (name, i) in enumerate(DOFS.items()):
        ax = fig.add_subplot(grid[2, 3 * column : 3 * column + 3])
        drift = data["ship"].drift
        ax.plot(drift.omega, 1e-6 * drift.mean_drift.values[:, 0, i], "o", ms=3, color="#22262b", label="mean drift")
        if i == 3:
            space = 1e-6 * drift.mean_drift_pressure.values[:, 0, i]
            ax.plot(drift.omega, space, "x", ms=4, color="#8a8f98", label="about the fixed O")
        for form, colour in zip(D.FORMS, ("#2e8b57", "#2f6db0", "#d1495b"), strict=True):
            cut = data["loads"][form].qtf(lower, lower + SHIFT, D.BEAM)[:, i].real
            ax.plot(lower + SHIFT / 2, 1e-6 * cut, color=colour, lw=1.3, label=f"{form[7:]}, difference {SHIFT:.3f} rad/s")
        ax.set(title=f"{name}: diagonal, and at the roll frequency", xlabel="mean frequency [rad/s]", xlim=(0.4, 1.3))
        ax.set_ylabel("[MN/m2]" if i < 3 else "[MN m/m2]")
        ax.legend(fontsize=6.5)
