"""Drift and added resistance in waves much shorter than the ship: reflection at the waterline."""

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.drift_contour import Contour, find_contour
from ogilvie.hydro.schema import DOFS
from ogilvie.mesh.panels import PanelMesh
from ogilvie.units import GRAVITY, SEA_WATER

Array = NDArray[np.float64]

_PURPOSE = "short_wave_drift"
_DIMS = ("omega", "wave_direction", "influenced_dof")


def short_wave_drift(
    hull: PanelMesh,
    *,
    omega: ArrayLike,
    wave_direction: ArrayLike = (np.pi,),
    speed: float = 0.0,
    rho: float = SEA_WATER,
    g: float = GRAVITY,
) -> xr.Dataset:
    """Return the mean drift forces of waves much shorter than the ship, per square metre of wave amplitude.

    Parameters
    ----------
    hull : PanelMesh
        Wetted hull (z <= 0, normals into the fluid); only its waterline matters.
    omega : (n_w,) array
        Frequencies of the incident waves, rad/s.
    wave_direction : (n_b,) array
        Directions that the waves travel to, rad; pi is head seas.
    speed : float
        Forward speed U, m/s: ``-mean_drift`` in surge is the added resistance then.
    rho, g : float
        kg/m3, m/s2.

    Returns
    -------
    xarray.Dataset
        As of :func:`ogilvie.mean_drift`: mean_drift (omega, wave_direction, influenced_dof), N/m2 and N m/m2 about O, NaN in
        heave, roll and pitch; at speed encounter_frequency (signed). :class:`ogilvie.SlowDrift` and
        ``hydro.assign(mean_drift=...)`` take it as it is, :func:`ogilvie.joined_drift` puts it beside the panel method's.

    Raises
    ------
    InputError
        An argument is out of range; a hull without a closed waterline.

    Notes
    -----
    Each element of the waterline with the unit normal n (out of the body) is a vertical wall along which the water streams, as
    deep as the waves. With d the direction of the waves, s = -d.n, k = omega^2/g and w = (omega U/g) n_x, the force per length

        F_n = (rho g a^2/4) [k_1/k - 1 + s^2 + s k_2/k],   k_1 = k (1 + w s)^2,   k_2^2 = k_1^2 - k^2 (1 - s^2)

    pushes it along -n: k_1 is the wavenumber at the wall, where the water has the velocity of the stream along it, k_2 the part
    across it. To first order in U that is (rho g a^2/2) s (s + 2 w), the published form, taken where the wall runs away from
    the waves (n_x U < 0). At rest it is (rho g a^2/2) s^2; in head seas, to first order, (1 + 2 omega U/g) times that. Only
    elements that waves reach are pushed: s > 0, and s + 2 w > 0, since the energy advances in the ship's axes with
    c_g d - U e_x; nothing else of the hull lies on this ray.

    Deep water and a wall without flare, deeper than about half a wave length (exp(-2kT) of the energy passes below the draught
    T); a hull that short waves do not move. What is right at low speed, and what is not: docs/theory/drift.md, section 8.
    Slow motion (moored, in a current) is for :class:`ogilvie.WaveDriftDamping` with the drift at rest.

    References
    ----------
    O. M. Faltinsen, K. J. Minsaas, N. Liapis and S. O. Skjordal, Prediction of resistance and propulsion of a ship in a seaway,
    13th Symposium on Naval Hydrodynamics, Tokyo (1980).

    Examples
    --------
    A cylinder: 2/3 rho g a^2 R.

    >>> from ogilvie.mesh.shapes import cylinder
    >>> drift = short_wave_drift(cylinder(1.0, 2.0, panels=2000), omega=[5.0], rho=1000.0, g=9.81)
    >>> float((drift.mean_drift.sel(influenced_dof="surge") / 9810.0).round(2).squeeze())
    -0.67
    """
    contour = find_contour(hull, purpose=_PURPOSE)
    rho, g = _number("rho", rho, 0.0, "a positive number"), _number("g", g, 0.0, "a positive number")
    U = _number("speed", speed, -np.inf, "a finite number of m/s")
    w = _axis("omega", omega, 0.0, np.inf, "positive frequencies in rad/s")
    b = _axis("wave_direction", wave_direction, -np.pi - 1e-9, 2.0 * np.pi + 1e-9, "angles from -pi to 2 pi rad")
    drift = np.full((len(w), len(b), 6), np.nan)
    for i, j in np.ndindex(len(w), len(b)):
        drift[i, j, [0, 1, 5]] = 0.5 * rho * g * reflection(contour, float(b[j]), float(w[i]) * U / g)
    coords = {"omega": w, "wave_direction": b, "influenced_dof": list(DOFS)}
    result = xr.Dataset({"mean_drift": (_DIMS, drift, {"method": "reflection of short waves"})}, coords=coords)
    if U != 0.0:
        result["encounter_frequency"] = (_DIMS[:2], w[:, None] - w[:, None] ** 2 * U * np.cos(b) / g)
    ratio = 2.0 * np.pi * g / w[[-1, 0]] ** 2 / hull.length
    at = "" if U == 0.0 else f" at {U:.4g} m/s"
    return result.assign_attrs(
        rho=rho,
        g=g,
        water_depth=np.inf,
        speed=U,
        moments="space",
        name=hull.name,
        length=float(hull.length),
        time_convention="exp(+iwt)",
        units="N/m2, N m/m2 per square metre of wave amplitude",
        summary=f"reflection of short waves at the waterline of {hull.name}{at}: wave lengths of {ratio[0]:.3g} to "
        f"{ratio[1]:.3g} ship lengths",
    )


def reflection(contour: Contour, direction: float, tau: float) -> Array:
    """Return surge, sway (m) and yaw (m2) over rho g a^2/2 of waves in one direction, with tau = omega U/g."""
    d = np.array([np.cos(direction), np.sin(direction)])
    n, x = contour.normal, contour.middle
    reached = contour.exposed(d - [2.0 * tau, 0.0])
    f = np.where(reached, wall_force(-n @ d, tau * n[:, 0]), 0.0)
    force = -(f * contour.length)[:, None] * n
    moment = x[:, 0] @ force[:, 1] - x[:, 1] @ force[:, 0]
    return np.array([*force.sum(axis=0), moment])


def wall_force(s: ArrayLike, w: ArrayLike) -> Array:
    """Return the force per length of a wall over rho g a^2/2.

    Parameters
    ----------
    s : array
        Part of the direction of the waves that points into the wall.
    w : array
        omega/g times the velocity of the wall towards the water, m/s; of a ship (omega U/g) n_x.

    Examples
    --------
    >>> wall_force([1.0, 0.5, 1.0, 1.0], [0.0, 0.0, 0.1, -0.5]).round(6).tolist()
    [1.0, 0.25, 1.21, 0.0]
    """
    into, ahead = np.maximum(np.asarray(s, dtype=float), 0.0), np.asarray(w, dtype=float)
    along = 1.0 - into**2  # square of the part along the wall
    k1 = (1.0 + np.maximum(ahead, 0.0) * into) ** 2
    k2 = np.sqrt(np.maximum(k1**2 - along, 0.0))
    advancing = 0.5 * (k1 - along + into * k2)
    return np.asarray(np.where(ahead >= 0.0, advancing, into * np.maximum(into + 2.0 * ahead, 0.0)))


def _number(name: str, value: float, above: float, what: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float | np.number) or not above < value < np.inf:
        raise InputError(f"{_PURPOSE}: {name}: {what} expected, {value!r} found.")
    return float(value)


def _axis(name: str, values: ArrayLike, above: float, below: float, what: str) -> Array:
    """Return values in ascending order."""
    try:
        x = np.sort(np.atleast_1d(np.asarray(values, dtype=float)))
    except (TypeError, ValueError):
        raise InputError(f"{_PURPOSE}: {name}: {what} expected, {values!r} found.") from None
    if x.ndim != 1 or len(x) == 0:
        raise InputError(f"{_PURPOSE}: {name}: a list of {what} expected, an array of shape {x.shape} found.")
    bad = x[~(np.isfinite(x) & (x > above) & (x < below))]
    if len(bad):
        raise InputError(f"{_PURPOSE}: {name}: {what} expected, {float(bad[0])!r} found.")
    if np.any(np.diff(x) <= 1e-12 * np.abs(x[1:])):
        raise InputError(f"{_PURPOSE}: {name}: distinct values expected, {float(x[1:][np.diff(x).argmin()])!r} is given twice.")
    return x
