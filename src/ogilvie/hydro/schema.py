"""The contract of the hydrodynamic data set, and its one constructor.

Everything that reads, computes or uses coefficients meets in an ``xarray.Dataset`` that obeys this page:

==========================  =============================================  ==========================================
variable                    dims                                           unit, remark
==========================  =============================================  ==========================================
omega (coord)               omega                                          rad/s, > 0, ascending; frequency of oscillation
                                                                           for radiation, of the incident wave for excitation
wave_direction (coord)      wave_direction                                 rad, ascending, in (-pi, pi] or [0, 2 pi)
added_mass                  omega, influenced_dof, radiating_dof           kg, kg m, kg m2
radiation_damping           omega, influenced_dof, radiating_dof           kg/s, ...
added_mass_inf              influenced_dof, radiating_dof                  optional
added_mass_zero             influenced_dof, radiating_dof                  optional; at zero speed only
radiation_damping_inf       influenced_dof, radiating_dof                  optional; at forward speed, where it is not zero
excitation_force            omega, wave_direction, influenced_dof          N/m, N; complex, per metre of wave amplitude
Froude_Krylov_force         same                                           optional; part of excitation_force
diffraction_force           same                                           optional; part of excitation_force
hydrostatic_stiffness       influenced_dof, radiating_dof                  optional; with gravity, about O
inertia_matrix              influenced_dof, radiating_dof                  optional; about O
external_damping            influenced_dof, radiating_dof                  optional; what a solver added to its own motions
external_stiffness          influenced_dof, radiating_dof                  optional; same
motion_rao                  omega, wave_direction, influenced_dof          optional; m/m, rad/m, complex, as read from a file
mean_drift                  omega, wave_direction, influenced_dof          optional; N/m2, N/m; best of those below (*)
mean_drift_pressure         same                                           optional; near field, about the mean origin
mean_drift_pressure_body    same                                           optional; near field, about the moving origin (*)
mean_drift_control_surface  same                                           optional; control surface (*)
mean_drift_momentum         same                                           optional; far field, horizontal dofs only (*)
mean_drift_pairs            omega, drift_pair, influenced_dof              optional; complex, two directions (*)
qtf_diff, qtf_sum           omega_1, omega_2, wave_direction, influenced_dof  optional; complex (*)
qtf_diff_pairs, _sum_pairs  omega_1, omega_2, qtf_pair, influenced_dof     optional; complex, two directions (*)
==========================  =============================================  ==========================================

(*) may hold NaN where the source gives no value: heave, roll and pitch of far-field drift, frequency pairs not computed.

Two wave directions at once are a list of pairs: the coordinates ``drift_direction_1(drift_pair)``, ``drift_direction_2``,
``qtf_direction_1(qtf_pair)``, ``qtf_direction_2`` (rad) name them. With amplitudes a1, a2 the forces are
Re sum sum a1 a2* Q_diff exp(i(w1 - w2)t) and Re sum sum a1 a2 Q_sum exp(i(w1 + w2)t), over all ordered pairs; the mean drift of
one wave is |a|^2 mean_drift. Exchanging the waves (frequencies and directions) makes Q_diff its conjugate and leaves Q_sum as
it is; :mod:`ogilvie.hydro.qtf` puts such functions in, checks this and fills gaps.

Attributes: rho, g, water_depth (inf allowed), speed, reference_point, time_convention = "exp(+iwt)", name, source.
Axes x forward, y port, z up; everything about O; elevation = Re exp(i(omega t - k(x cos b + y sin b))).
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ogilvie.errors import InputError
from ogilvie.units import GRAVITY, SEA_WATER

DOFS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
TIME_CONVENTION = "exp(+iwt)"

_RADIATION = ("omega", "influenced_dof", "radiating_dof")
_MATRIX = ("influenced_dof", "radiating_dof")
_FORCE = ("omega", "wave_direction", "influenced_dof")
_QTF = ("omega_1", "omega_2", "wave_direction", "influenced_dof")
_QTF_PAIRS = ("omega_1", "omega_2", "qtf_pair", "influenced_dof")

#: variable -> (dims, complex?)
VARIABLES: dict[str, tuple[tuple[str, ...], bool]] = {
    "added_mass": (_RADIATION, False),
    "radiation_damping": (_RADIATION, False),
    "added_mass_inf": (_MATRIX, False),
    "added_mass_zero": (_MATRIX, False),
    "radiation_damping_inf": (_MATRIX, False),
    "excitation_force": (_FORCE, True),
    "Froude_Krylov_force": (_FORCE, True),
    "diffraction_force": (_FORCE, True),
    "motion_rao": (_FORCE, True),
    "mean_drift": (_FORCE, False),
    "mean_drift_pressure": (_FORCE, False),
    "mean_drift_pressure_body": (_FORCE, False),
    "mean_drift_control_surface": (_FORCE, False),
    "mean_drift_momentum": (_FORCE, False),
    "mean_drift_pairs": (("omega", "drift_pair", "influenced_dof"), True),
    "hydrostatic_stiffness": (_MATRIX, False),
    "inertia_matrix": (_MATRIX, False),
    "external_damping": (_MATRIX, False),
    "external_stiffness": (_MATRIX, False),
    "qtf_diff": (_QTF, True),
    "qtf_sum": (_QTF, True),
    "qtf_diff_pairs": (_QTF_PAIRS, True),
    "qtf_sum_pairs": (_QTF_PAIRS, True),
}

#: Variables that may hold NaN: not every method gives every component, not every pair of frequencies is computed.
PARTIAL = frozenset(key for key in VARIABLES if key.startswith(("mean_drift", "qtf_"))) - {"mean_drift_pressure"}


def hydro_from_arrays(
    *,
    omega: ArrayLike,
    added_mass: ArrayLike,
    radiation_damping: ArrayLike,
    added_mass_inf: ArrayLike | None = None,
    added_mass_zero: ArrayLike | None = None,
    wave_direction: ArrayLike | None = None,
    excitation_force: ArrayLike | None = None,
    froude_krylov_force: ArrayLike | None = None,
    diffraction_force: ArrayLike | None = None,
    motion_rao: ArrayLike | None = None,
    mean_drift: ArrayLike | None = None,
    hydrostatic_stiffness: ArrayLike | None = None,
    inertia_matrix: ArrayLike | None = None,
    external_damping: ArrayLike | None = None,
    external_stiffness: ArrayLike | None = None,
    rho: float = SEA_WATER,
    g: float = GRAVITY,
    water_depth: float = np.inf,
    speed: float = 0.0,
    dofs: tuple[str, ...] = DOFS,
    name: str = "vessel",
    source: str = "arrays",
    attrs: Mapping[str, Any] | None = None,
) -> xr.Dataset:
    """Return a validated hydrodynamic data set from plain arrays.

    Parameters
    ----------
    omega : (n_w,) array
        Frequencies, rad/s, positive; sorted here if they are not ascending.
    added_mass, radiation_damping : (n_w, n, n) array
        SI; first index of a matrix is the force, second the motion.
    added_mass_inf, added_mass_zero : (n, n) array, optional
        Limits at infinite and zero frequency.
    wave_direction : (n_b,) array, optional
        Directions that the waves travel to, rad; needed with any force.
    excitation_force, froude_krylov_force, diffraction_force : (n_w, n_b, n) complex array, optional
        Per metre of wave amplitude, exp(+i omega t). The excitation is the sum of the other two when only these are given.
    motion_rao, mean_drift : (n_w, n_b, n) array, optional
    hydrostatic_stiffness, inertia_matrix : (n, n) array, optional
        About O, gravity included.
    external_damping, external_stiffness : (n, n) array, optional
        What a solver added to obtain the motions it reports; not part of the radiation damping and the stiffness above.
    rho, g, water_depth, speed : float
        kg/m3, m/s2, m (inf for deep water), m/s.
    dofs : tuple of str
        Names of the n degrees of freedom.

    Returns
    -------
    xarray.Dataset
        Obeys :mod:`ogilvie.hydro.schema`.

    Raises
    ------
    InputError
        Wrong shape, NaN, non-positive or repeated frequencies, forces without directions.

    Examples
    --------
    >>> w = np.linspace(0.2, 2.0, 10)
    >>> A = np.ones((10, 1, 1)); B = np.zeros((10, 1, 1))
    >>> h = hydro_from_arrays(omega=w, added_mass=A, radiation_damping=B, dofs=("heave",))
    >>> h.sizes["omega"], h.attrs["time_convention"]
    (10, 'exp(+iwt)')
    """
    given = {
        "added_mass": added_mass,
        "radiation_damping": radiation_damping,
        "added_mass_inf": added_mass_inf,
        "added_mass_zero": added_mass_zero,
        "excitation_force": _total(excitation_force, froude_krylov_force, diffraction_force),
        "Froude_Krylov_force": froude_krylov_force,
        "diffraction_force": diffraction_force,
        "motion_rao": motion_rao,
        "mean_drift": mean_drift,
        "hydrostatic_stiffness": hydrostatic_stiffness,
        "inertia_matrix": inertia_matrix,
        "external_damping": external_damping,
        "external_stiffness": external_stiffness,
    }
    present = {key: value for key, value in given.items() if value is not None}
    coords: dict[str, Any] = {"omega": _axis("omega", omega), "influenced_dof": list(dofs), "radiating_dof": list(dofs)}
    if wave_direction is not None:
        coords["wave_direction"] = _axis("wave_direction", wave_direction)
    elif any("wave_direction" in VARIABLES[key][0] for key in present):
        raise InputError("wave_direction: needed with wave forces (rad, direction the waves travel to), none found.")
    sizes = {key: len(value) for key, value in coords.items()}
    variables = {key: (VARIABLES[key][0], _shaped(key, value, sizes)) for key, value in present.items()}
    meta = {
        "rho": float(rho),
        "g": float(g),
        "water_depth": float(water_depth),
        "speed": float(speed),
        "reference_point": [0.0, 0.0, 0.0],
        "time_convention": TIME_CONVENTION,
        "name": name,
        "source": source,
        **(attrs or {}),
    }
    hydro = xr.Dataset(variables, coords=coords, attrs=meta)
    order = {dim: np.argsort(coords[dim], kind="stable") for dim in ("omega", "wave_direction") if dim in coords}
    return validate(hydro.isel(order))


def validate(hydro: xr.Dataset) -> xr.Dataset:
    """Return the data set unchanged if it obeys the contract of this page, else raise :class:`InputError`.

    Every mistake found is named in one message.

    Examples
    --------
    >>> validate(xr.Dataset(attrs={"rho": -1.0}))
    Traceback (most recent call last):
    ...
    ogilvie.errors.InputError: hydrodynamic data set: omega: expected, not found; added_mass: expected, ...
    """
    problems = [f"{key}: expected, not found" for key in ("omega", "added_mass", "radiation_damping") if key not in hydro]
    for key in VARIABLES:
        if key in hydro:
            problems += _variable_problems(key, hydro[key])
    for key in ("omega", "omega_1", "omega_2"):
        if key in hydro.coords and not _ascending(hydro[key].values, above=0.0):
            problems.append(
                f"{key}: positive, ascending, distinct frequencies in rad/s expected (zero and infinity are variables)"
            )
    if "wave_direction" in hydro.coords:
        problems += _direction_problems(hydro.wave_direction.values)
    if "influenced_dof" in hydro.coords and "radiating_dof" in hydro.coords:
        i, j = hydro.influenced_dof.values.tolist(), hydro.radiating_dof.values.tolist()
        if i != j or len(set(i)) != len(i):
            problems.append(f"dofs: one list of distinct names for influenced and radiating dofs expected, {i} and {j} found")
    for key in ("rho", "g", "water_depth"):
        value = hydro.attrs.get(key)
        if not (isinstance(value, int | float | np.number) and value > 0):
            problems.append(f"attribute {key}: positive number expected, {value!r} found")
    if hydro.attrs.get("time_convention") != TIME_CONVENTION:
        problems.append(
            f"attribute time_convention: {TIME_CONVENTION!r} expected, {hydro.attrs.get('time_convention')!r} found"
        )
    if problems:
        raise InputError("hydrodynamic data set: " + "; ".join(problems) + ".")
    return hydro


def _total(total: ArrayLike | None, incident: ArrayLike | None, scattered: ArrayLike | None) -> ArrayLike | None:
    if total is not None or incident is None or scattered is None:
        return total
    return np.asarray(incident) + np.asarray(scattered)


def _axis(name: str, values: ArrayLike) -> np.ndarray:
    axis = np.atleast_1d(np.asarray(values, dtype=float))
    if axis.ndim != 1:
        raise InputError(f"{name}: a list of numbers expected, an array of shape {axis.shape} found.")
    return axis


def _shaped(key: str, value: ArrayLike, sizes: Mapping[str, int]) -> np.ndarray:
    dims, is_complex = VARIABLES[key]
    array = np.array(value, dtype=complex if is_complex else float)
    shape = tuple(sizes[d] for d in dims)
    if array.shape != shape:
        raise InputError(f"{key}: shape {shape} = ({', '.join(dims)}) expected, {array.shape} found.")
    return array


def _variable_problems(key: str, variable: xr.DataArray) -> list[str]:
    dims, is_complex = VARIABLES[key]
    problems = []
    if variable.dims != dims:
        problems.append(f"{key}: dims {dims} expected, {variable.dims} found")
    if variable.dtype.kind not in ("fiuc" if is_complex else "fiu"):
        kind = "complex" if is_complex else "real"
        return [*problems, f"{key}: {kind} numbers expected, {variable.dtype} found"]
    values = variable.values
    bad = int((np.isinf(values) if key in PARTIAL else ~np.isfinite(values)).sum())
    if bad:
        problems.append(f"{key}: finite numbers expected, {bad} NaN or infinite found")
    return problems


def _ascending(values: np.ndarray, *, above: float) -> bool:
    good = values.dtype.kind in "fiu" and len(values) > 0 and bool(np.all(np.isfinite(values)))
    return good and bool(values[0] > above and np.all(np.diff(values) > 0))


def _direction_problems(b: np.ndarray) -> list[str]:
    if not _ascending(b, above=-np.inf):
        return ["wave_direction: distinct directions (rad) in ascending order expected"]
    if b.min() < -np.pi - 1e-9 or b.max() > 2 * np.pi + 1e-9:
        return [f"wave_direction: rad expected, {b.min():.4g}..{b.max():.4g} found; degrees?"]
    return []
