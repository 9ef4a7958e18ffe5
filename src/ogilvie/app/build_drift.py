"""From a case to its second-order wave forces: drift of the data or of the hull, slow drift, wave-drift damping."""

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.app.case import Case
from ogilvie.app.files import collected_warnings
from ogilvie.errors import InputError, OgilvieWarning

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.body import RigidBody
    from ogilvie.mesh.panels import PanelMesh
    from ogilvie.sim.vessel import Vessel
    from ogilvie.waves.field import Sea

Array = NDArray[np.float64]

_BESIDE = 0.05  # of the frequency of a regular wave, on either side of it


def holds_drift(case: Case, hydro: "xr.Dataset") -> bool:
    """Return whether the coefficients hold what the slow drift of the case is made from, at the vessel's speed."""
    full = case.slow_drift is not None and case.slow_drift.approximation == "full"
    at_speed = abs(float(hydro.attrs.get("speed", 0.0)) - case.speed) <= 1e-3 * max(1.0, case.speed)
    return at_speed and any(name in hydro for name in (("qtf_diff", "qtf_diff_pairs") if full else ("mean_drift", "qtf_diff")))


def refuse_without_drift(case: Case, hydro: "xr.Dataset") -> None:
    """Raise InputError where slow drift is wanted, without drift in the coefficients and without a hull to compute it from."""
    if case.slow_drift is None or case.hull is not None or holds_drift(case, hydro):
        return
    if case.slow_drift.approximation == "full":
        raise InputError(
            'slow_drift.approximation: "full": a WAMIT .12d beside coefficients.file, or a [hull] to compute it from, '
            'expected, none found. Take "newman-arithmetic".'
        )
    raise InputError(
        "slow_drift: mean drift in the coefficients (a WAMIT .8 or .9 beside coefficients.file) or a [hull] to compute it "
        "from expected, none found."
    )


def drift_data(
    case: Case,
    vessel: "Vessel",
    hydro: "xr.Dataset",
    body: "RigidBody",
    hull: "PanelMesh | None",
    sea: "Sea",
    *,
    progress: bool | None = None,
) -> "xr.Dataset":
    """Return the data that slow drift is made from, computed for the moving, moored and damped hull where none are there.

    The coefficients, with their mean drift; at speed and for a full quadratic transfer function a data set of its own, on
    `slow_drift.omega_count` frequencies of the sea. The vessel is that without slow drift: its linear damping and springs
    shape the motion that the drift comes from.
    """
    refuse_without_drift(case, hydro)
    d = case.slow_drift
    if d is None or hull is None or holds_drift(case, hydro):
        return hydro
    from ogilvie.app.build_resistance import added_resistance
    from ogilvie.hydro.drift import mean_drift
    from ogilvie.hydro.drift_qtf import difference_qtf
    from ogilvie.sim.system import TURNING, assemble

    system, b = assemble(vessel), hydro.wave_direction.values
    of_its_own = case.speed > 0.0 or d.approximation == "full"
    options: Any = {
        "omega": frequencies_of(case, sea) if of_its_own else hydro.omega.values,
        "wave_direction": b,
        "damping": system.damping,
        "stiffness": system.stiffness - case.speed * system.damping @ TURNING - hydro.hydrostatic_stiffness.values,
        "irregular_frequencies": "remove" if case.coefficients.irregular_frequencies else "keep",
        "progress": progress,
        "cache": case.coefficients.cache,
        "rho": hydro.attrs["rho"],
        "g": hydro.attrs["g"],
        "water_depth": hydro.attrs["water_depth"],
    }
    said: list[str] = []
    with collected_warnings(said):
        if d.approximation == "full":
            found = difference_qtf(hull, body, second_order=d.second_order, **options)
        elif case.speed > 0.0:
            found = added_resistance(case, hull, body, **options)
        else:
            found = mean_drift(hull, body, method=d.method, **options)
    for words in said:
        told = words.removeprefix("mean_drift: ").removeprefix("difference_qtf: ")
        warnings.warn("; ".join(told.splitlines()), OgilvieWarning)
    return found if of_its_own else hydro.assign(mean_drift=found.mean_drift)


def frequencies_of(case: Case, sea: "Sea") -> Array:
    """Return frequencies from the first to the last of the sea, rad/s; of a regular wave some beside it."""
    assert case.slow_drift is not None
    low, high = float(sea.omega.min()), float(sea.omega.max())
    if high - low > 2.0 * _BESIDE * low:
        return np.linspace(low, high, case.slow_drift.omega_count)
    return np.unique([low * (1.0 - _BESIDE), low, high, high * (1.0 + _BESIDE)])


def drift_loads(case: Case, drift: "xr.Dataset", sea: "Sea") -> list[Any]:
    """Return slow drift and, where it is wanted and the vessel is at rest, wave-drift damping."""
    from ogilvie.loads.slow_drift import SlowDrift
    from ogilvie.loads.wave_drift_damping import WaveDriftDamping

    d = case.slow_drift
    assert d is not None
    damped = case.speed == 0.0 and drift.sizes["wave_direction"] > 1 if d.damping is None else d.damping
    return [SlowDrift(drift, d.approximation), *([WaveDriftDamping(drift, sea)] if damped else [])]
