"""Mean drift of a ship at speed, added resistance among it: the panel method as far as its panels go, reflection beyond."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.app.case import Case
from ogilvie.hydro.bem_case import resolved_wavenumber
from ogilvie.waves.dispersion import encounter_frequency, frequency

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.body import RigidBody
    from ogilvie.mesh.panels import PanelMesh

Array = NDArray[np.float64]

_BAND = (0.8, 1.2)  # wave lengths over the ship's between which reflection fades out
_STANDING = 0.02  # part of its frequency below which that of encounter is no place for a computation
_MOVED = 1.03  # of a frequency that is met too slowly from somewhere


def added_resistance(
    case: Case, hull: "PanelMesh", body: "RigidBody", *, omega: Array, wave_direction: Array, **options: Any
) -> "xr.Dataset":
    """Return the mean drift at the vessel's speed from the first to the last of these frequencies.

    Waves that are met at frequencies which the panels do not resolve are left to :func:`ogilvie.short_wave_drift`, which is
    also a floor in waves shorter than the ship (:func:`ogilvie.joined_drift`); the panel method has them all where it ends in
    waves longer than that, or `slow_drift.short_waves` is false.
    """
    from ogilvie.hydro.drift import mean_drift
    from ogilvie.hydro.drift_join import joined_drift
    from ogilvie.hydro.drift_short import short_wave_drift

    d, U, g = case.slow_drift, case.speed, options["g"]
    assert d is not None
    first, last = (float(np.sqrt(2.0 * np.pi * g / (ratio * hull.length))) for ratio in _BAND[::-1])
    end = min(float(omega[-1]), _resolved(hull, case, wave_direction, g))
    join = d.short_waves and omega[-1] > first and end >= last and omega[0] < last
    w = np.linspace(omega[0], end, len(omega)) if join else omega
    w = moving(w, wave_direction, case, g)
    options |= {"wave_direction": wave_direction}
    long = mean_drift(hull, body, omega=w, speed=U, method=d.method, **options)
    if not join:
        return long
    short_w = np.unique(np.r_[first, np.linspace(first, omega[-1], 4 * len(omega))])
    short = short_wave_drift(hull, omega=short_w, wave_direction=wave_direction, speed=U, rho=options["rho"], g=g)
    return joined_drift(long, short, band=_BAND)


def _resolved(hull: "PanelMesh", case: Case, directions: Array, g: float) -> float:
    """Return the frequency of waves, rad/s, up to which those from every direction are met within what the panels resolve."""
    k = resolved_wavenumber(hull)
    if not np.isfinite(k):
        return np.inf
    limit = float(frequency(k, case.water.depth, g=g))
    ahead = case.speed * max(0.0, float(-np.cos(directions).min())) / g  # omega_e = omega + ahead omega^2
    return limit if ahead == 0.0 else float((np.sqrt(1.0 + 4.0 * ahead * limit) - 1.0) / (2.0 * ahead))


def moving(omega: Array, directions: Array, case: Case, g: float) -> Array:
    """Return the frequencies, those inside moved a little where the vessel would keep pace with a wave from some direction."""
    w = omega.copy()
    for i in range(1, len(w) - 1):
        for _ in range(9):
            met = encounter_frequency(w[i], speed=case.speed, direction=directions, depth=case.water.depth, g=g)
            if np.all(np.abs(met) > _STANDING * w[i]):
                break
            w[i] *= _MOVED
    return np.unique(w)
