"""A tanker and an FPSO: the hybrid time-domain panel method against WAMIT 6.3."""

from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

import ogilvie as og
from ogilvie.bem.hybrid_case import hybrid_case
from ogilvie.bem.hybrid_hydro import hydro_of
from ogilvie.bem.impulses import impulses, retardation_of

TITLE = "Tanker and FPSO from the time domain against WAMIT"
ABOUT = """Retardation functions, added mass, damping and wave forces of two ships by the hybrid time-domain method, one run of
impulse responses per ship at the default resolution, against WAMIT 6.314 (Marine Systems Simulator, T. I. Fossen and T. Perez,
github.com/cybergalactic/MSS, MIT licence). A smooth surface is fitted to the flat panels of each file; it keeps the sharp bilge
of the FPSO, which runs from the transom to the stem. (Rounded off by the fit it costs 6 % of the added mass in roll, by the
panel method in the frequency domain too.)

K(0) is no measure. A quarter (sway, heave) to a half (roll) of it comes from damping above 2.4 rad/s, where the waves are too
short for WAMIT's panels (the tanker's damping turns negative above 3.6 rad/s), and the tail fitted to it decides: K(0) of the
tanker's roll goes from 1.3 to 2.2 GN m with the tail and the last frequency used. By the hybrid method it is 1.75, 1.96, 2.11
with the panels at the waterline divided once, twice and three times, on the way to 2.4. Where the hull is not
vertical at the waterline, the water's angle there being gamma > 90 deg, the surface
velocity after an impulse goes as r^(pi/(2 gamma) - 1); damping then falls as omega^-(2 pi/gamma - 1), slower than omega^-3, and
in shallow sterns the last part of K(0) is the work of centimetres. So both sides are compared with one band limit,
K = (2/pi) int B win cos(omega t), win 1 up to 0.7 of the limit and a half cosine from there to zero at it; the notes tell how
far K is off in full after the first second.

The tanker's A, B and X are compared as far as the panels of the time domain carry the waves. WAMIT's FPSO data have irregular
frequencies from about 1.0 rad/s on, the hybrid method has none: A, B and X are compared up to 0.73 rad/s, K on the whole
band."""
NEEDS = ["data/mss_wamit_tanker/tanker.1", "data/mss_wamit_fpso/fpso.1"]
HEIGHT = 9.0

DOFS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
FILES = {"tanker": "mss_wamit_tanker/tanker", "FPSO": "mss_wamit_fpso/fpso"}
MESHES = {"tanker": "mss_wamit_tanker/tanker.gdf", "FPSO": "mss_wamit_fpso/fpso_low.gdf"}
HEADINGS = {"head": 180.0, "quartering": 40.0, "beam": 90.0}
LIMIT = {"tanker": 2.4, "FPSO": 2.4}  # rad/s, of K
CLEAN = {"tanker": (0.2, 1.39), "FPSO": (0.2, 0.74)}  # rad/s, of A, B, X: long enough for the panels, regular
LATE = 1.0  # s, from which K is compared in full
DURATION = 60.0  # s, of the comparison
ALLOWED = 3.0  # %


def run(shared: Any) -> tuple[list[dict], dict]:
    """Return the checks and what the figure needs."""
    checks, data = [], {}
    for name, path in FILES.items():
        wamit = og.read_hydro(shared / "data" / f"{path}.1")
        hull = og.load_mesh(shared / "data" / MESHES[name])
        units = {"rho": wamit.attrs["rho"], "g": wamit.attrs["g"]}
        found = impulses(hybrid_case(name, hull, **units))
        K = retardation_of(found)
        near = wamit.omega.values <= CLEAN[name][1]
        directions = np.radians(list(HEADINGS.values()))
        ours = hydro_of(found, hull, omega=wamit.omega.values[near], wave_direction=directions)
        checks += limits(name, K, wamit) + memories(name, K, wamit) + matrices(name, K, wamit) + forces(name, ours, wamit)
        data[name] = (K, wamit)
    return checks, data


def limits(name: str, K: Any, wamit: Any) -> list[dict]:
    """Return the added mass at infinite frequency of each dof."""
    error = 100.0 * (np.diag(K.A_inf) / np.diag(wamit.added_mass_inf.values) - 1.0)
    return [check(f"{name}: A{i + 1}{i + 1} at infinite frequency", error[i], ALLOWED, "%", DOFS[i]) for i in range(6)]


def memories(name: str, K: Any, wamit: Any) -> list[dict]:
    """Return K of each dof with one band limit on both sides and, where the data carry it, in full after the first second."""
    t = np.arange(0.0, DURATION, 0.05)
    omega = wamit.omega.values
    mine = np.diagonal(K.transform(omega).real, axis1=1, axis2=2)
    theirs = np.diagonal(wamit.radiation_damping.values, axis1=1, axis2=2)
    full = og.retardation(wamit, duration=DURATION, dt=0.05)
    checks = []
    for i in range(6):
        a, b = (band_limited(omega, B[:, i], t, LIMIT[name]) for B in (mine, theirs))
        error = 100.0 * (a - b) / np.abs(b).max()
        worst = int(np.abs(error).argmax())
        late = full.t >= LATE
        rest = np.interp(full.t, K.t, K.K[:, i, i]) - full.K[:, i, i]
        most = 100.0 * np.abs(rest[late]).max() / np.abs(full.K[:, i, i]).max()
        note = (
            f"at t = {t[worst]:.3g} s; K(0) over that of WAMIT's damping and its fitted tail "
            f"{K.K[0, i, i] / full.K[0, i, i]:.2f}, difference after {LATE:g} s {most:.1f} % of K(0)"
        )
        title = f"{name}: K{i + 1}{i + 1} up to {LIMIT[name]} rad/s"
        checks.append(check(title, error[worst], ALLOWED, "% of the largest value", note))
    return checks


def band_limited(omega: np.ndarray, B: np.ndarray, t: np.ndarray, limit: float) -> np.ndarray:
    """Return (2/pi) int_0^limit B win cos(omega t) d omega from values at omega, win falling from 1 to 0 over the last 0.3."""
    w = np.linspace(0.0, limit, 1201)
    win = 0.5 * (1.0 + np.cos(np.pi * np.clip((w / limit - 0.7) / 0.3, 0.0, 1.0)))
    weight = np.full(len(w), w[1])
    weight[[0, -1]] *= 0.5
    values = CubicSpline(np.append(0.0, omega), np.append(0.0, B))(w)
    return np.asarray(2.0 / np.pi * np.cos(np.outer(t, w)) @ (weight * win * values))


def matrices(name: str, K: Any, wamit: Any) -> list[dict]:
    """Return added mass and damping of each dof."""
    low, high = CLEAN[name]
    w = wamit.omega.values
    near = (w >= low) & (w <= high)
    H = K.transform(w[near])
    A = np.diag(K.A_inf) + np.diagonal(H.imag, axis1=1, axis2=2) / w[near][:, None]
    B = np.diagonal(H.real, axis1=1, axis2=2)
    checks = []
    for letter, values, variable in (("A", A, "added_mass"), ("B", B, "radiation_damping")):
        wanted = np.diagonal(wamit[variable].values[near], axis1=1, axis2=2)
        for i in range(6):
            error = 100.0 * (values[:, i] - wanted[:, i]) / np.abs(wanted[:, i]).max()
            worst = int(np.abs(error).argmax())
            title, note = f"{name}: {letter}{i + 1}{i + 1}, {low} to {high} rad/s", f"at {w[near][worst]:.3g} rad/s"
            checks.append(check(title, error[worst], ALLOWED, "% of the largest value", note))
    return checks


def forces(name: str, ours: Any, wamit: Any) -> list[dict]:
    """Return modulus and phase together of the wave forces of each dof."""
    low, high = CLEAN[name]
    w, angle = ours.omega.values, np.degrees(wamit.wave_direction.values)
    near, n = w >= low, len(w)
    columns = [int(np.abs((angle - d + 180.0) % 360.0 - 180.0).argmin()) for d in HEADINGS.values()]
    wanted = wamit.excitation_force.values[:n, columns][near]
    order = [int(np.abs(ours.wave_direction.values - np.radians(d)).argmin()) for d in HEADINGS.values()]
    error = 100.0 * np.abs(ours.excitation_force.values[near][:, order] - wanted).max(axis=0)
    scale = np.abs(wamit.excitation_force.values[:n][near]).max(axis=(0, 1))
    checks = []
    for i in range(6):
        each = error[:, i] / scale[i]
        note = ", ".join(f"{heading} {e:.2g}" for heading, e in zip(HEADINGS, each, strict=True)) + " %"
        title = f"{name}: X{i + 1}, {low} to {high} rad/s"
        checks.append(check(title, each.max(), ALLOWED, "% of the largest value", note))
    return checks


def check(name: str, value: float, tolerance: float, unit: str, note: str) -> dict[str, Any]:
    """Return one comparison with zero."""
    return {
        "name": name, "value": float(value), "reference": 0.0, "tolerance": tolerance, "unit": unit, "source": "WAMIT 6.314",
        "note": note,
    }  # fmt: skip


def draw(data: dict, fig: Any) -> None:
    """Draw K and B of the six dofs: the tanker's K and the FPSO's B."""
    axes = fig.subplots(6, 4)
    for pair, (name, (K, wamit)) in enumerate(data.items()):
        full = og.retardation(wamit, duration=30.0, dt=0.05)
        dense = np.linspace(0.02, 4.6, 600)
        B = np.diagonal(K.transform(dense).real, axis1=1, axis2=2)
        w = wamit.omega.values
        for i, dof in enumerate(DOFS):
            left, right = axes[i, 2 * pair], axes[i, 2 * pair + 1]
            scale = np.abs(K.K[:, i, i]).max()
            left.plot(full.t, full.K[:, i, i] / scale, color="#22262b", lw=2.6, alpha=0.3, label="from WAMIT's damping")
            left.plot(K.t, K.K[:, i, i] / scale, color="#2f6db0", lw=1.1, label="time domain")
            left.set(xlim=(0, 20), ylim=(-0.62, 1.5))
            peak = np.abs(B[:, i]).max()
            seen = w < 4.6
            right.plot(w[seen], wamit.radiation_damping.values[seen, i, i] / peak, "o", color="#d1495b", ms=2.6, label="WAMIT")
            right.plot(dense, B[:, i] / peak, color="#2f6db0", lw=1.1, label="time domain")
            right.set(xlim=(0, 4.6), ylim=(-0.3, 1.15))
            for ax in (left, right):
                ax.axhline(0, color="#8a8f98", lw=0.5)
                ax.tick_params(labelsize=6)
                if i < 5:
                    ax.set_xticklabels([])
            if pair == 0:
                left.set_ylabel(dof, fontsize=8)
        axes[0, 2 * pair].set_title(f"{name}: K / K(0)", fontsize=8)
        axes[0, 2 * pair + 1].set_title(f"{name}: B / max B", fontsize=8)
        axes[-1, 2 * pair].set_xlabel("t, s", fontsize=8)
        axes[-1, 2 * pair + 1].set_xlabel("omega, rad/s", fontsize=8)
    axes[0, 0].legend(fontsize=6, frameon=False)
    axes[0, 1].legend(fontsize=6, frameon=False)
