"""From a case to its sea, its vessel, the simulation, and what the frequency domain says about it."""

import warnings
from math import radians
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.app.build_memory import mooring_stiffness
from ogilvie.app.case import Case
from ogilvie.errors import InputError, OgilvieWarning

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.body import RigidBody
    from ogilvie.memory.retardation import Retardation
    from ogilvie.memory.statespace import StateSpace
    from ogilvie.mesh.panels import PanelMesh
    from ogilvie.sim.vessel import Vessel
    from ogilvie.waves.field import Sea
    from ogilvie.waves.spectrum import Spectrum
    from ogilvie.waves.spreading import Spreading

Array = NDArray[np.float64]

_UNSETTLED = 0.2  # half the confidence interval of a standard deviation, of its value, beyond which a run is called short


def make_spectrum(case: Case) -> "Spectrum | None":
    """Return the wave spectrum of a case, or None for regular waves and calm water."""
    from ogilvie.waves import spectra

    s = case.sea
    if s.spectrum in ("regular", "calm"):
        return None
    hs, tp = float(s.hs or 0.0), float(s.tp or 0.0)
    if s.spectrum == "jonswap":
        return spectra.jonswap(hs=hs, tp=tp, gamma=s.gamma)
    makers: dict[str, Any] = {
        "bretschneider": spectra.bretschneider,
        "pierson-moskowitz": spectra.pierson_moskowitz,
        "torsethaugen": spectra.torsethaugen,
    }
    return makers[s.spectrum](hs=hs, tp=tp)


def make_spreading(case: Case) -> "Spreading | None":
    """Return the spreading of a case, or None for long-crested waves."""
    from ogilvie.waves.spreading import spreading

    if case.sea.spreading is None:
        return None
    return spreading(**{"s" if case.sea.spreading_kind == "cos2s" else "n": case.sea.spreading})


#: Shares of the sea's variance that the coefficients' frequencies may leave out: without a word (Hs 0.5 % low), with a warning.
LOST, LOST_AT_MOST = 0.01, 0.05


def make_sea(case: Case, spectrum: "Spectrum | None", hydro: "xr.Dataset") -> "Sea | None":
    """Return the sea of a case with one realisation per seed, or None for calm water.

    Raises
    ------
    InputError
        More than 5 % of the variance lies outside the frequencies of the coefficients.
    """
    from ogilvie.waves.sea import irregular, regular

    s, n = case.sea, case.simulation.realisations
    if s.spectrum == "calm":
        return None
    depth, g, b = case.water.depth, case.water.g, radians(s.direction_deg)
    if spectrum is None:
        return regular(direction=b, amplitude=s.amplitude, period=s.period, depth=depth, g=g)
    return irregular(
        spectrum,
        direction=b,
        spreading=make_spreading(case),
        n=s.components,
        duration=None if s.components is not None else case.simulation.duration,
        seed=range(s.seed, s.seed + n),
        method=s.method,
        random=s.random,
        omega_range=_within(spectrum, hydro.omega.values),
        depth=depth,
        g=g,
    )


def _within(spectrum: "Spectrum", omega: Array) -> tuple[float, float]:
    """Return the frequencies between which the sea is made: nearly all of the spectrum, within the coefficients."""
    first, last = spectrum.quantile([1e-4, 0.998])
    low, high = max(float(first), float(omega[0])), min(float(last), float(omega[-1]))
    below, above = spectrum.cumulative([low, high]) if low < high else (0.0, 0.0)
    lost = 1.0 - (above - below) / spectrum.m0
    what = f"{100 * lost:.2g} % of the variance lies outside the coefficients' {omega[0]:.4g}..{omega[-1]:.4g} rad/s"
    if lost > LOST_AT_MOST:
        raise InputError(
            f"sea: {what}; at most {100 * LOST_AT_MOST:g} % expected. Extend the coefficients (omega_max) or change tp."
        )
    if lost > LOST:
        warnings.warn(f"sea: {what} and is left out; Hs is {100 * (1 - (1 - lost) ** 0.5):.2g} % low.", OgilvieWarning)
    return low, high


def make_vessel(
    case: Case,
    body: "RigidBody",
    hydro: "xr.Dataset",
    K: "Retardation",
    ssm: "StateSpace | None",
    *,
    hull: "PanelMesh | None" = None,
    sea: "Sea | None" = None,
    drift: "xr.Dataset | None" = None,
) -> "Vessel":
    """Return the vessel with the loads of a case; slow drift, which needs its data and the sea, where these are given."""
    from ogilvie.app.build_control import control_loads, mooring
    from ogilvie.app.build_drift import drift_loads
    from ogilvie.app.build_loads import Made, plain_loads, restoring
    from ogilvie.loads.excitation import WaveExcitation
    from ogilvie.loads.mooring import LinearMooring
    from ogilvie.loads.radiation import Convolution, StateSpaceRadiation
    from ogilvie.loads.viscous import LinearDamping
    from ogilvie.sim.vessel import Vessel

    made = Made(case, body, hydro, hull)
    loads: list[Any] = [restoring(made), Convolution(K) if ssm is None else StateSpaceRadiation(ssm)]
    if case.sea.spectrum != "calm":
        slow = case.slow_drift is not None and case.large
        loads.append(WaveExcitation(hydro, position="slow" if slow else "instantaneous"))
    if sea is not None and drift is not None:
        loads += drift_loads(case, drift, sea)
    stiffness = mooring_stiffness(case, body, hydro)
    if stiffness.any():
        loads.append(LinearMooring(stiffness))
    if case.mooring is not None:
        loads.append(mooring(made))
    if case.loads.damping_ratio.given:
        loads.append(LinearDamping(ratio=case.loads.damping_ratio.given))
    loads += plain_loads(made) + control_loads(made)
    return Vessel(body, loads=tuple(loads), speed=case.speed, heading=radians(case.vessel.heading_deg))


def finished_vessel(
    case: Case,
    body: "RigidBody",
    hydro: "xr.Dataset",
    K: "Retardation",
    ssm: "StateSpace | None",
    *,
    hull: "PanelMesh | None",
    sea: "Sea | None",
) -> "Vessel":
    """Return the vessel with all its loads, after the drift of the hull where slow drift needs it."""
    from ogilvie.app.build_drift import drift_data

    drift = None
    if case.slow_drift is not None and sea is not None:
        drift = drift_data(case, make_vessel(case, body, hydro, K, ssm, hull=hull), hydro, body, hull, sea)
    return make_vessel(case, body, hydro, K, ssm, hull=hull, sea=sea, drift=drift)


def motions(case: Case) -> str:
    """Return the kind of motions of a case, small or large."""
    return "large" if case.large else "small"


def initial(case: Case) -> dict[str, Any] | None:
    """Return the pose at the start as the simulation takes it: about the steady frame, or in the world for large motions."""
    start = case.simulation.initial
    if start is None:
        return None
    eta = np.array(start.eta)
    if case.large:
        psi = radians(case.vessel.heading_deg)
        c, s = np.cos(psi), np.sin(psi)
        eta[:2] = c * eta[0] - s * eta[1], s * eta[0] + c * eta[1]
        eta[5] += psi
    return {"eta": eta.tolist()}


def simulate_case(case: Case, vessel: "Vessel", sea: Any, *, progress: bool | None = None) -> "xr.Dataset":
    """Return the simulation of a case, marked with the case it belongs to."""
    from ogilvie.sim.simulate import simulate

    s = case.simulation
    run = simulate(
        vessel,
        sea,
        duration=s.duration,
        dt=s.dt,
        ramp=s.ramp,
        initial=initial(case),
        method=s.method,
        motions=motions(case),
        output_step=s.output_step,
        progress=progress,
    )
    run.attrs |= {"title": case.title, "case_digest": case.digest, "case_toml": case.text}
    return run


def skipped(case: Case) -> float:
    """Return the start of the statistics, s: as given, else after the ramp, or after a tenth where a run starts from a pose.

    So it does where motions are large: control, wind and current take hold of the vessel at the start.
    """
    s = case.simulation
    if s.skip is not None:
        return s.skip
    ramped = 2 * s.ramp if 2 * s.ramp < s.duration else s.ramp
    return max(ramped, 0.1 * s.duration) if s.initial is not None or case.large else ramped


def statistics(case: Case, run: "xr.Dataset") -> "xr.Dataset | None":
    """Return the statistics of the motions, those of large ones about the mean course; None where a run was cut too short."""
    from ogilvie.post.course import about_course
    from ogilvie.post.stats import summary

    skip = skipped(case)
    if run.sizes["time"] < 16 or float(run.time[-1]) <= skip:
        warnings.warn("no statistics: the run ended before enough of it was done", OgilvieWarning)
        return None
    found = summary(about_course(run, skip=skip), skip=skip)
    straight = run.attrs.get("motions") == "large" and "surge" in found.dof.values
    about = "the mean course (surge along it, sway to port of it)" if straight else ""
    if case.sea.spectrum not in ("regular", "calm") and (words := _uncertain(found)):
        warnings.warn(words, OgilvieWarning)
    return found.assign_attrs(about=about)


def _uncertain(found: "xr.Dataset") -> str:
    """Return a word on motions whose standard deviation the run does not settle, or nothing."""
    low, high = found.std_interval.values[..., 0], found.std_interval.values[..., 1]
    with np.errstate(invalid="ignore", divide="ignore"):
        half_width = 0.5 * (high - low) / found["std"].values
    moving = found["std"].values > 1e-6
    poor = [(float(w), str(d)) for w, d, on in zip(half_width, found.dof.values, moving, strict=True) if on and w > _UNSETTLED]
    if not poor:
        return ""
    worst = max(poor)[0]
    longer = (
        f"{np.ceil((worst / _UNSETTLED) ** 2):.0f} times the duration or the realisations bring it to {100 * _UNSETTLED:.0f} %"
    )
    names = ", ".join(d for _, d in poor)
    return f"a short run: the standard deviation of {names} is known to within {100 * worst:.0f} % only; about {longer}."
