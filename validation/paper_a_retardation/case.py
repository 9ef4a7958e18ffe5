"""Paper A, section IV: which order realization theory and impulse-response fitting need, on smooth and on uneven damping."""

from pathlib import Path
from typing import Any

import numpy as np
from scipy.signal import lfilter

import ogilvie as og

TITLE = "Two time-domain identifications of a pipe-laying vessel's retardation functions (Yuan et al. 2017)"
ABOUT = """Yuan, Ma, Zan and Wu (2017), Real-time method for calculating retardation functions, J. Marine Science and
Technology (Taiwan) 25(6), fit K of surge, heave and pitch of the vessel HYSY201 by realization theory (RTM) and by
impulse-response curve fitting (IRCFM) to R2 = 0.99, and find IRCFM more susceptible to an uneven damping curve. Here with a
hull of the same length, beam, draught and displacement (its lines are not public) and our own panel solution; uneven means
that every damping value is changed by 5 % at random. Read as linear prediction in the z-domain (Prony), IRCFM needs higher
orders and suffers as published; with Steiglitz-McBride iterations and refitted outputs, as `identify` has it, the handicap
is gone."""
NEEDS: list[str] = []
HEIGHT = 7.0

HULL = {"length": 185.0, "beam": 39.2, "draught": 8.959}  # m, Table 1
DISPLACEMENT = 55101.8e3  # kg
OMEGA = np.arange(0.1, 1.81, 0.05)  # rad/s
DOFS = ("surge", "heave", "pitch")
METHODS = ("RTM", "IRCFM, linear prediction", "IRCFM, iterated")
ORDERS = range(2, 11)
SEEDS = range(5)
UNEVEN = 0.05
SOURCE = "Yuan et al. (2017), section IV"


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return orders and R2 of the methods."""
    hydro = solve()
    data: dict[str, Any] = {"omega": OMEGA}
    for dof in DOFS:
        B = hydro.radiation_damping.sel(influenced_dof=dof, radiating_dof=dof).values
        uneven = [B * (1 + UNEVEN * np.random.default_rng(s).standard_normal(len(B))) for s in SEEDS]
        K, rough = _kernel(hydro, dof, B), [_kernel(hydro, dof, b) for b in uneven]
        data[dof] = {
            "B": B,
            "uneven": uneven[0],
            "K": rough[0],
            "fits": {m: _fit(rough[0], m, 3)[1] for m in METHODS},
            "smooth": {m: np.array([_fit(K, m, n)[0] for n in ORDERS]) for m in METHODS},
            "rough": {m: np.array([[_fit(k, m, n)[0] for n in ORDERS] for k in rough]) for m in METHODS},
        }
    return _checks(data), data


def solve() -> Any:
    """Return the hydrodynamic coefficients of a hull with the particulars of HYSY201."""
    cb = DISPLACEMENT / 1025.0 / np.prod(list(HULL.values()))
    hull = og.shapes.from_particulars(**HULL, cb=cb, panels=1600, name="HYSY201-like hull")
    return og.solve_bem(hull, omega=OMEGA, wave_direction=[np.pi], progress=False)


def _kernel(hydro: Any, dof: str, B: np.ndarray) -> Any:
    """Return the retardation function of one degree of freedom with this damping."""
    one = {"influenced_dof": [dof], "radiating_dof": [dof]}
    part = og.hydro_from_arrays(
        omega=OMEGA,
        added_mass=hydro.added_mass.sel(one).values,
        radiation_damping=B[:, None, None],
        added_mass_inf=hydro.added_mass_inf.sel(one).values,
        dofs=(dof,),
    )
    return og.retardation(part, duration=60.0, dt=0.1, interpolation="linear")


def _fit(K: Any, method: str, order: int) -> tuple[float, np.ndarray]:
    """Return R2 and the impulse response of a model of that order."""
    if method == METHODS[1]:
        y = linear_prediction(K.K[:, 0, 0], order)
        k = K.K[:, 0, 0]
        return 1 - float(((y - k) ** 2).sum() / ((k - k.mean()) ** 2).sum()), y
    model = og.identify(K, method="realization" if method == "RTM" else "impulse", order=order, passive=False)
    return float(model.r2[0, 0]), model.impulse(K.t)[:, 0, 0]


def linear_prediction(h: np.ndarray, n: int) -> np.ndarray:
    """Return the impulse response of b(z)/a(z) of order n whose first n samples are h and whose prediction error is least."""
    columns = np.stack([h[n - k : len(h) - k] for k in range(n + 1)], axis=1)
    a = np.concatenate([[1.0], np.linalg.lstsq(columns[:, 1:], -columns[:, 0], rcond=None)[0]])
    pulse = np.zeros(len(h))
    pulse[0] = 1.0
    return lfilter(np.convolve(a, h[:n])[:n], a, pulse)


def needed(r2: np.ndarray) -> int:
    """Return the order from which on R2 stays at 0.99 or more."""
    low = np.flatnonzero(r2 < 0.99)
    return int(ORDERS[0] + low[-1] + 1) if len(low) else int(ORDERS[0])


def _checks(data: dict[str, Any]) -> list[dict[str, Any]]:
    checks = []
    for dof in DOFS:
        smooth, rough = data[dof]["smooth"], data[dof]["rough"]
        order = needed(smooth["RTM"])
        need = ", ".join(f"{m} {needed(smooth[m])} (smooth), {max(needed(r) for r in rough[m])} (uneven)" for m in METHODS)
        checks.append(
            _check(
                f"R2 of RTM with the order it needs, {order}, {dof}",
                smooth["RTM"][order - 2],
                1.0,
                0.01,
                f"orders needed: {need}",
            )
        )
        checks.append(
            _check(
                f"R2 of RTM with order 2, {dof}",
                smooth["RTM"][0],
                1.0,
                0.02,
                "published: above 0.98 with a second-order system",
            )
        )
    ratio = {
        dof: float(np.exp(np.mean([np.log((1 - r[METHODS[1]]) / (1 - r["RTM"]))])))
        for dof, r in ((d, data[d]["rough"]) for d in DOFS)
    }
    worse = sum(r > 1.0 for r in ratio.values())
    lost = ", ".join(f"{dof} {r:.1f}" for dof, r in ratio.items())
    note = f"factor by which it loses more R2 than RTM, mean of orders 2 to 10: {lost}"
    checks.append(_check("uneven damping: dofs in which IRCFM by linear prediction is worse than RTM", worse, 3, 0, note))
    worst = min(float(data[d]["rough"][METHODS[2]][:, 2:].min()) for d in DOFS)
    checks.append(_check("uneven damping: worst R2 of iterated IRCFM, orders 4 to 10", worst, 1.0, 0.01, "here, not published"))
    return checks


def _check(name: str, value: float, reference: float, tolerance: float, note: str) -> dict[str, Any]:
    return {
        "name": name, "value": float(value), "reference": reference, "tolerance": tolerance, "source": SOURCE, "note": note,
    }  # fmt: skip


def draw(data: dict[str, Any], fig: Any) -> None:
    """Draw damping, retardation functions with third-order fits, and the lost R2 over the order."""
    axes = fig.subplots(3, 3, height_ratios=[0.8, 1.0, 1.0])
    colours = dict(zip(METHODS, ("#2f6db0", "#d1495b", "#2e8b57"), strict=True))
    units = {"surge": ("kg/s", "N/m"), "heave": ("kg/s", "N/m"), "pitch": ("kg m\u00b2/s", "N m")}
    index = {"surge": "11", "heave": "33", "pitch": "55"}
    for column, dof in enumerate(DOFS):
        d, (unit_B, unit_K) = data[dof], units[dof]
        ax = axes[0, column]
        factor = 10.0 ** (3 * int(np.log10(d["B"].max()) / 3))
        power = round(np.log10(factor))
        ax.plot(data["omega"], d["B"] / factor, color="#22262b", label="smooth")
        ax.plot(data["omega"], d["uneven"] / factor, color="#c9971c", lw=0.9, marker=".", ms=3, label="uneven by 5 %")
        ax.set(title=f"B{index[dof]}  {dof}", ylabel=f"[10$^{{{power}}}$ {unit_B}]", xlabel="\u03c9 [rad/s]", xlim=(0, 1.85))
        ax = axes[1, column]
        factor = 10.0 ** (3 * int(np.log10(np.abs(d["K"].K).max()) / 3))
        power = round(np.log10(factor))
        ax.plot(d["K"].t, d["K"].K[:, 0, 0] / factor, color="#22262b", lw=3, alpha=0.3, label="K (uneven B)")
        for method, style in zip(METHODS, ("-", "-", (0, (4, 2))), strict=True):
            ax.plot(d["K"].t, d["fits"][method] / factor, color=colours[method], ls=style, lw=1.1, label=method)
        ax.set(title=f"K{index[dof]} and fits of order 3", ylabel=f"[10$^{{{power}}}$ {unit_K}]", xlabel="t [s]", xlim=(0, 30))
        ax = axes[2, column]
        for method, colour in colours.items():
            ax.semilogy(ORDERS, 1 - d["smooth"][method], color=colour, lw=1.3, label=method)
            ax.semilogy(
                ORDERS, 1 - np.exp(np.log(d["rough"][method]).mean(axis=0)), color=colour, lw=1.0, ls=":", marker=".", ms=4
            )
        ax.axhline(0.01, color="#8a8f98", lw=0.8)
        ax.text(10, 0.028, "R\u00b2 = 0.99", ha="right", va="bottom", fontsize=6.5)
        ax.set(title=f"{dof}: lost R\u00b2", xlabel="order [-]", ylabel="1 \u2212 R\u00b2 [-]", ylim=(1e-5, 0.3), xlim=(2, 10))
    axes[0, 2].legend(fontsize=6.5, loc="upper right")
    handles = axes[1, 0].get_legend_handles_labels()
    fig.legend(*handles, loc="outside upper center", ncols=4)
    axes[2, 2].plot([], [], color="#8a8f98", lw=1.3, label="smooth B")
    axes[2, 2].plot([], [], color="#8a8f98", lw=1.0, ls=":", marker=".", ms=4, label="uneven B")
    lines = axes[2, 2].get_lines()[-2:]
    axes[2, 2].legend(lines, [x.get_label() for x in lines], fontsize=6.5, loc="lower left")
