"""Slow drift: the force on a wall from first principles, Newman's approximations and a full QTF for an FPSO."""

import time
from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.hydro.qtf import with_qtf
from ogilvie.loads.harmonics import HarmonicGrid
from ogilvie.loads.quadratic import double_sum, single_fft
from ogilvie.loads.slow_drift import SlowDrift
from ogilvie.loads.transfer import qtf_table
from ogilvie.waves.dispersion import wavenumber

TITLE = "Slow drift: a wall from first principles, and an FPSO by Newman's approximations and a full QTF"
ABOUT = """\
**Wall.** In front of a vertical wall waves stand, and the force of second order that comes of first-order quantities is
known from the elevation and the velocity at the wall alone: rho g zeta^2/2 - rho/2 int w^2 dz per metre of width. Worked out
at every instant of an irregular sea it must equal the sum of the difference and the sum frequency force with Q = rho g (1 -+
w1 w2/(w1^2 + w2^2)): no common factor, sign or pair can be wrong.

**FPSO.** Mean drift of the 200 m FPSO (WAMIT 6.3, Marine Systems Simulator, MIT licence; pressure integration on a hull with
sharp edges, so the numbers are an example, not a truth) in an irregular sea, Hs 4 m, Tp 10 s, 30 deg off the bow. No
measured or computed full QTF of it is public. The one used here is made up of what is known: the drift at the geometric
mean, times the factor of the wall, with the phase of waves that are met half a length before midship. Against it stand four
approximations, which lose that phase, a delay of the force by the time in which wave groups travel the half length; rms
values and spectra of the slow force are close. Every force is also summed pair by pair (paper D: Somayajula and Falzarano
2016, Eq. 51) and by one FFT (Eq. 52), and its spectrum is compared with Pinkster's 8 int S S |Q|^2."""
NEEDS = ["data/mss_wamit_fpso/fpso.9"]
HEIGHT = 8.4

RHO, G = 1025.0, 9.80665
HS, TP, DURATION = 4.0, 10.0, 900.0
BAND = (0.35, 1.6)  # rad/s
DIRECTION = np.radians(150.0)
ARM = 100.0  # m, where the made-up QTF has its phase
WAYS = ("newman-arithmetic", "newman-geometric", "newman-1974", "mean", "full")
SEEDS, STEP = range(20), 0.5
SLOW = 0.2  # rad/s: below it the slow force is compared
SOURCE = "first principles"


def run(shared: Path | None) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return the checks and what the figure needs."""
    assert shared is not None
    wall_checks, wall = _wall()
    checks, data = _fpso(shared)
    return wall_checks + checks, data | {"wall": wall}


def _sea(seed: Any, direction: float) -> Any:
    return og.irregular(og.jonswap(hs=HS, tp=TP), direction=direction, duration=DURATION, seed=seed, omega_range=BAND)


def _wall() -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Compare the force on a wall, instant by instant, with its quadratic transfer functions."""
    w = np.linspace(BAND[0] - 0.05, BAND[1] + 0.05, 60)
    factor = np.multiply.outer(w, w) / np.add.outer(w**2, w**2)
    Z = np.zeros((len(w), 1, 1))
    bare = og.hydro_from_arrays(
        omega=w, added_mass=Z, radiation_damping=Z, dofs=("surge",), wave_direction=[0.0], excitation_force=Z
    )
    shape = (len(w), len(w), 1, 1)
    hydro = with_qtf(
        bare, omega=w, qtf_diff=(RHO * G * (1 - factor)).reshape(shape), qtf_sum=(RHO * G * (1 + factor)).reshape(shape)
    )
    sea, t = _sea(7, 0.0), np.arange(0.0, DURATION, 0.2)
    A = sea.complex_amplitude
    slow = SlowDrift(hydro, "full", tolerance=1e-12).series(sea, t)[:, 0]
    grid = HarmonicGrid(sea.omega, 0.2, len(t))
    table = qtf_table(hydro, "qtf_sum", tolerance=1e-12)
    fast = table.form(sea.omega, sea.direction).series(grid, A * grid.phases(0.0))[:, 0]
    e = A * np.exp(1j * np.multiply.outer(t, sea.omega))
    zeta = 2.0 * e.real.sum(axis=1)
    rate = 2.0 * (1j * e * sea.omega).real  # vertical velocity of each component at the surface
    k = sea.wavenumber
    direct = 0.5 * RHO * G * zeta**2 - 0.5 * RHO * np.einsum("ti,tj,ij->t", rate, rate, 1 / np.add.outer(k, k), optimize=True)
    size = np.abs(direct).max()
    flat = og.hydro_from_arrays(
        omega=w, added_mass=Z, radiation_damping=Z, dofs=("surge",), wave_direction=[0.0], mean_drift=Z + 0.5 * RHO * G
    )
    newman = SlowDrift(flat).series(sea, t)[:, 0]
    checks = [
        _check("wall: force of each instant, largest difference", np.abs(slow + fast - direct).max() / size, 0.0, 1e-5),
        _check(
            "wall: mean force / (rho g Hs^2/16)",
            direct.mean() / (RHO * G * sea.hs**2 / 16),
            1.0,
            1e-3,
            note="one period of the sea",
        ),
        _check(
            "wall: slow force by Newman / by the full QTF, r.m.s.",
            newman.std() / slow.std(),
            1.0,
            0.1,
            note="all of Newman's forms are one here, since the drift of a wall does not depend on frequency",
        ),
    ]
    return checks, {"t": t, "direct": direct, "slow": slow, "newman": newman}


def fpso(shared: Path) -> Any:
    """Return the coefficients with the made-up QTF."""
    hydro = og.read_hydro(shared / "data/mss_wamit_fpso/fpso").drop_vars(["mean_drift_pressure", "mean_drift_pressure_body"])
    w = hydro.omega.values[(hydro.omega.values > 0.25) & (hydro.omega.values < 1.9)]
    b = hydro.wave_direction.values
    geometric = SlowDrift(hydro, "newman-geometric")
    i, j, m = (x.ravel() for x in np.indices((len(w), len(w), len(b))))
    Q = geometric.qtf(w[i], w[j], b[m]).reshape(len(w), len(w), len(b), 6)
    k = wavenumber(w, np.inf, g=G)
    factor = 2.0 * (1.0 - np.multiply.outer(w, w) / np.add.outer(w**2, w**2))
    phase = np.exp(1j * np.subtract.outer(k, k)[:, :, None] * ARM * np.abs(np.cos(b)))
    return with_qtf(hydro, omega=w, qtf_diff=Q * (factor[:, :, None] * phase)[..., None])


def _fpso(shared: Path) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    hydro, one, many = fpso(shared), _sea(1, DIRECTION), _sea(SEEDS, DIRECTION)
    t = np.arange(0.0, DURATION, STEP)
    n = len(one.omega)
    i, j = (x.ravel() for x in np.indices((n, n)))
    D = SlowDrift(hydro).qtf(one.omega, one.omega, DIRECTION).real
    mean = one.amplitude**2 @ D
    checks: list[dict[str, Any]] = []
    series, seconds, spectra = {}, {}, {}
    for way in WAYS:
        load = SlowDrift(hydro, way, tolerance=1e-9)
        Q = load.qtf(one.omega[i], one.omega[j], DIRECTION).reshape(n, n, 6)
        plain, seconds["double sum"] = _timed(lambda Q=Q: double_sum(one.complex_amplitude, one.omega, Q, t))
        by_fft, seconds["single FFT"] = _timed(lambda Q=Q: single_fft(one.complex_amplitude, Q, len(t)))
        grid, form = HarmonicGrid(one.omega, STEP, len(t)), load.form(one)
        form.series(grid, one.complex_amplitude * grid.phases(0.0))
        found, seconds[way] = _timed(lambda f=form, g=grid: f.series(g, one.complex_amplitude * g.phases(0.0)))
        size = np.abs(plain).max(axis=0)
        away = max((np.abs(x - plain).max(axis=0) / size).max() for x in (by_fft, found))
        checks.append(
            _check(f"FPSO, {way}: products and FFT against the double sum", away, 0.0, 1e-6, note=f"{len(form.left)} products")
        )
        note = "between the data's frequencies a spline of Q is not one of D: the phase turns" if way == "full" else ""
        ratio = found[:, 1].mean() / mean[1]
        checks.append(_check(f"FPSO, {way}: mean sway force / sum a^2 D", ratio, 1.0, 0.03, note=note))
        series[way] = found
        spectra[way] = _spectra(load, many, t, Q[:, :, 1])
    for way in WAYS:
        slow, reference = _slow_rms(spectra[way][0]), _slow_rms(spectra[way][1])
        if way != "mean":
            checks.append(
                _check(
                    f"FPSO, {way}: slow sway force, {len(SEEDS)} realisations / Pinkster's spectrum, r.m.s.",
                    slow / reference,
                    1.0,
                    0.05,
                    source="Pinkster (1980)",
                )
            )
    for way in WAYS[:3]:
        ratio = _slow_rms(spectra[way][1]) / _slow_rms(spectra["full"][1])
        note = f"correlation of the two forces {_correlation(series[way], series['full']):.2f}, as the delay is lost"
        checks.append(_check(f"FPSO, {way}: slow sway force / full QTF, r.m.s.", ratio, 1.0, 0.1, note=note))
    checks[-1]["note"] += "; times of one evaluation: " + ", ".join(f"{k} {1e3 * v:.0f} ms" for k, v in seconds.items())
    return checks, {"t": t, "series": series, "spectra": spectra, "seconds": seconds, "n": n}


def _spectra(load: Any, sea: Any, t: Any, Q: Any) -> tuple[Any, Any]:
    """Return spectrum of the sway force over multiples of dw, from the realisations and from Pinkster's integral."""
    dw = 2 * np.pi / DURATION
    force = load.series(sea, t)[:, :, 1]
    found = (2 * (np.abs(np.fft.rfft(force, axis=1)) / len(t)) ** 2 / dw).mean(axis=0)
    a2 = sea.amplitude[0] ** 2  # 2 S dw
    expected = np.zeros_like(found)
    for k in range(1, len(a2)):
        expected[k] = np.sum(2 * a2[k:] * a2[:-k] * np.abs(np.diagonal(Q, -k)) ** 2) / dw  # 8 int S S |Q|^2
    return found, expected


def _slow_rms(spectrum: Any) -> float:
    dw = 2 * np.pi / DURATION
    return float(np.sqrt(spectrum[1 : int(SLOW / dw) + 1].sum() * dw))


def _correlation(one: Any, two: Any) -> float:
    return float(np.corrcoef(*(_low(x[:, 1]) for x in (one, two)))[0, 1])


def _low(force: Any) -> Any:
    """Return the part below the frequency SLOW."""
    F = np.fft.rfft(force)
    F[int(SLOW * DURATION / (2 * np.pi)) + 1 :] = 0.0
    return np.fft.irfft(F, n=len(force))


def _timed(function: Any) -> tuple[Any, float]:
    begin = time.perf_counter()
    value = function()
    return value, time.perf_counter() - begin


def _check(
    name: str, value: float, reference: float, tolerance: float, *, note: str = "", source: str = SOURCE
) -> dict[str, Any]:
    return {
        "name": name,
        "value": float(value),
        "reference": reference,
        "tolerance": tolerance,
        "source": source,
        "note": note,
    }


def draw(data: dict[str, Any], fig: Any) -> None:
    """Force on the wall; sway force on the FPSO over time, its spectrum, and what each way costs."""
    top, middle, left, right = fig.subplot_mosaic([["a", "a"], ["b", "b"], ["c", "d"]]).values()
    wall = data["wall"]
    part = slice(0, 1000)
    for name, label, width in (
        ("direct", "pressure at each instant", 0.6),
        ("slow", "full QTF", 1.6),
        ("newman", "Newman", 1.0),
    ):
        top.plot(wall["t"][part], 1e-3 * wall[name][part], lw=width, label=label)
    top.set(xlabel="t (s)", ylabel="force on a wall (kN/m)")
    t, part = data["t"], slice(0, 1200)
    for way in WAYS:
        middle.plot(t[part], 1e-3 * _low(data["series"][way][:, 1])[part], lw=1.0, label=way)
    middle.set(xlabel="t (s)", ylabel="slow sway force, FPSO (kN)")
    w = 2 * np.pi / DURATION * np.arange(len(data["spectra"]["full"][0]))
    shown = (w > 0) & (w < 0.4)
    for way in (w_ for w_ in WAYS if w_ != "mean"):
        line = left.plot(w[shown], 1e-6 * data["spectra"][way][1][shown], lw=1.2, label=f"{way}, Pinkster")[0]
        left.plot(w[shown], 1e-6 * data["spectra"][way][0][shown], ".", ms=2, color=line.get_color())
    left.set(xlabel="frequency (rad/s)", ylabel="spectrum of sway force (kN2 s)")
    names = list(data["seconds"])
    right.barh(names, [1e3 * data["seconds"][k] for k in names])
    right.set_xscale("log")
    right.set_xlabel(f"ms for {len(t)} times, {data['n']} components")
    for ax in (top, middle, left):
        ax.legend(loc="upper right")
