"""From a case to its second-order wave forces: mean drift of the data or of the hull, slow drift, wave-drift damping."""

import warnings
from typing import TYPE_CHECKING, Any

from ogilvie.app.case import Case
from ogilvie.app.files import collected_warnings
from ogilvie.errors import InputError, OgilvieWarning

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.body import RigidBody
    from ogilvie.mesh.panels import PanelMesh
    from ogilvie.sim.vessel import Vessel
    from ogilvie.waves.field import Sea


def holds_drift(case: Case, hydro: "xr.Dataset") -> bool:
    """Return whether the coefficients hold what the slow drift of the case is made from."""
    full = case.slow_drift is not None and case.slow_drift.approximation == "full"
    return any(name in hydro for name in (("qtf_diff", "qtf_diff_pairs") if full else ("mean_drift", "qtf_diff")))


def refuse_without_drift(case: Case, hydro: "xr.Dataset") -> None:
    """Raise InputError where slow drift is wanted, without drift in the coefficients and without a hull to compute it from."""
    if case.slow_drift is None or holds_drift(case, hydro):
        return
    if case.slow_drift.approximation == "full":
        raise InputError(
            'slow_drift.approximation: "full": a WAMIT .12d beside coefficients.file expected, none found. Take '
            '"newman-arithmetic".'
        )
    if case.hull is None:
        raise InputError(
            "slow_drift: mean drift in the coefficients (a WAMIT .8 or .9 beside coefficients.file) or a [hull] to compute it "
            "from expected, none found."
        )


def with_drift(
    case: Case,
    vessel: "Vessel",
    hydro: "xr.Dataset",
    body: "RigidBody",
    hull: "PanelMesh | None",
    *,
    progress: bool | None = None,
) -> "xr.Dataset":
    """Return the coefficients with the mean drift of the moving, moored and damped hull where they have none.

    The vessel is that without slow drift: its linear damping and springs shape the motion that the drift comes from.
    """
    refuse_without_drift(case, hydro)
    if case.slow_drift is None or hull is None or holds_drift(case, hydro):
        return hydro
    from ogilvie.hydro.drift import mean_drift
    from ogilvie.sim.system import assemble

    system = assemble(vessel)
    options: Any = {"rho": hydro.attrs["rho"], "g": hydro.attrs["g"], "water_depth": hydro.attrs["water_depth"]}
    said: list[str] = []
    with collected_warnings(said):
        found = mean_drift(
            hull,
            body,
            omega=hydro.omega.values,
            wave_direction=hydro.wave_direction.values,
            damping=system.damping,
            stiffness=system.stiffness - hydro.hydrostatic_stiffness.values,
            method=case.slow_drift.method,
            irregular_frequencies="remove" if case.coefficients.irregular_frequencies else "keep",
            progress=progress,
            cache=case.coefficients.cache,
            **options,
        )
    for words in said:
        warnings.warn("; ".join(words.removeprefix("mean_drift: ").splitlines()), OgilvieWarning)
    return hydro.assign(mean_drift=found.mean_drift)


def drift_loads(case: Case, hydro: "xr.Dataset", sea: "Sea") -> list[Any]:
    """Return slow drift and, where it is wanted, wave-drift damping."""
    from ogilvie.loads.slow_drift import SlowDrift
    from ogilvie.loads.wave_drift_damping import WaveDriftDamping

    d = case.slow_drift
    assert d is not None
    damped = hydro.sizes["wave_direction"] > 1 if d.damping is None else d.damping
    return [SlowDrift(hydro, d.approximation), *([WaveDriftDamping(hydro, sea)] if damped else [])]
