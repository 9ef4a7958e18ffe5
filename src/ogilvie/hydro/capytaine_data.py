"""Turns data sets of Capytaine into those of this package, by the names of their dimensions."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.reference import moved_to_origin
from ogilvie.hydro.schema import DOFS, hydro_from_arrays
from ogilvie.units import GRAVITY

_FREQUENCIES = ("omega", "period", "freq", "wavenumber", "wavelength")


def from_capytaine(
    content: xr.Dataset,
    *,
    name: str = "vessel",
    source: str = "Capytaine",
    rho: float | None = None,
    g: float | None = None,
    water_depth: float | None = None,
) -> xr.Dataset:
    """Turn a data set of Capytaine into one of this package.

    Parameters
    ----------
    content : Dataset
        As `BEMSolver.fill_dataset` returns it: one body, rigid dofs, one density, gravity and depth; zero speed.
    name, source : str
        Become attributes.
    rho, g, water_depth : float, optional
        Where the data set lacks them.

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    InputError
        Several bodies, other dofs, several values of a parameter, missing radiation.

    Notes
    -----
    Capytaine's time factor is exp(-i omega t): forces and motions are conjugated. Arrays are transposed by the names of their
    dimensions. Zero and infinite frequency become variables. Dofs about a `rotation_center` other than O are moved to O.
    """
    if "added_mass" not in content or "radiation_damping" not in content:
        raise InputError("added_mass and radiation_damping: expected, not found. Solve radiation problems too.")
    data = _by_omega(content)
    given = {"rho": rho, "g": g, "water_depth": water_depth}
    constants = {key: _scalar(data, key, value) for key, value in given.items()}
    speed = _scalar(data, "forward_speed", None, default=0.0)
    if speed != 0.0:
        raise InputError(
            f"forward_speed: zero expected, {speed:g} m/s found; such data are per encounter frequency. Use solve_bem."
        )
    labels = _dof_labels(data)
    data = data.drop_vars("rotation_center", errors="ignore")
    point = _rotation_center(content)
    matrix, force = ("influenced_dof", "radiating_dof"), ("omega", "wave_direction", "influenced_dof")
    w = data.omega.values
    finite = np.flatnonzero((w > 0) & np.isfinite(w))
    A = _array(data, "added_mass", ("omega", *matrix), labels)
    arrays: dict[str, Any] = {
        "added_mass": A[finite],
        "radiation_damping": _array(data, "radiation_damping", ("omega", *matrix), labels)[finite],
        "added_mass_zero": A[np.argmax(w == 0.0)] if np.any(w == 0.0) else None,
        "added_mass_inf": A[np.argmax(np.isinf(w))] if np.any(np.isinf(w)) else None,
    }
    for key, argument in (
        ("excitation_force", "excitation_force"),
        ("Froude_Krylov_force", "froude_krylov_force"),
        ("diffraction_force", "diffraction_force"),
        ("RAO", "motion_rao"),
        ("rao", "motion_rao"),
    ):
        if key in data:
            arrays[argument] = np.conj(_array(data, key, force, labels)[finite])
    for key in ("hydrostatic_stiffness", "inertia_matrix"):
        if key in data:
            arrays[key] = _array(data, key, matrix, labels)
    with_waves = any(key.endswith(("_force", "_rao")) for key in arrays)
    hydro = hydro_from_arrays(
        omega=w[finite],
        wave_direction=np.atleast_1d(data.wave_direction.values) if with_waves else None,
        **arrays,
        **constants,
        dofs=tuple(labels),
        name=name,
        source=source,
        attrs={"solver_attributes": "; ".join(f"{k}={v}" for k, v in content.attrs.items())},
    )
    moved = moved_to_origin(hydro, point)
    return moved if not point.any() else moved.assign_attrs(moved_from=point.tolist())


def _by_omega(content: xr.Dataset) -> xr.Dataset:
    """Make omega the dimension, whatever kind of frequency the problems were set up with."""
    if "omega" not in content.coords:
        raise InputError("omega: a coordinate expected, not found. Assemble the data set with omega=True.")
    found = [key for key in _FREQUENCIES if key in content.dims]
    if len(found) > 1:
        raise InputError(f"one frequency dimension expected, {found} found. Assemble radiation and diffraction alike.")
    if not found:
        content = content.expand_dims("omega")
        found = ["omega"]
    data = content if found == ["omega"] else content.swap_dims({found[0]: "omega"})
    return data.sortby("omega").drop_vars([key for key in _FREQUENCIES if key != "omega"], errors="ignore")


def _scalar(content: xr.Dataset, key: str, given: float | None, *, default: float | None = None) -> float:
    default = {"g": GRAVITY, "water_depth": np.inf}.get(key, default) if given is None else given
    if key not in content.coords:
        if default is None:
            raise InputError(f"{key}: expected, not found. Give it.")
        return float(default)
    values = np.unique(np.atleast_1d(content[key].values).astype(float))
    if len(values) != 1:
        raise InputError(f"{key}: one value expected, {values.tolist()} found. Select one with .sel().")
    value = float(values[0])
    if given is not None and not np.isclose(given, value, rtol=1e-6):
        raise InputError(f"{key}: {value:g} as in the data set expected, {given:g} given. Solve again or leave it out.")
    return value


def _dof_labels(content: xr.Dataset) -> dict[str, str]:
    """Return our name -> Capytaine's name of the rigid-body dofs, in our order."""
    names = [str(name) for name in np.atleast_1d(content.influenced_dof.values)]
    bare = {name: name.split("__")[-1].lower() for name in names}
    bodies = {name.split("__")[0] for name in names if "__" in name}
    strange = sorted(set(bare.values()) - set(DOFS))
    if len(bodies) > 1 or len(set(bare.values())) != len(names) or strange:
        raise InputError(
            f"dofs: surge to yaw of one body expected, {names} found. Several bodies are not read by this version."
        )
    radiating = {str(name) for name in np.atleast_1d(content.radiating_dof.values)}
    ordered = sorted((name for name in names if name in radiating), key=lambda name: DOFS.index(bare[name]))
    if not ordered:
        raise InputError("dofs: radiating dofs among the influenced ones expected, none found. Solve again.")
    return {bare[name]: name for name in ordered}


def _rotation_center(content: xr.Dataset) -> NDArray[np.float64]:
    if "rotation_center" not in content.coords:
        return np.zeros(3)
    point = np.asarray(content.rotation_center.values, dtype=float).reshape(-1)
    if point.shape != (3,):
        raise InputError(f"rotation_center: one point expected, {point.tolist()} found. Give one body.")
    return np.where(np.isnan(point), 0.0, point)


def _array(content: xr.Dataset, key: str, dims: tuple[str, ...], labels: Mapping[str, str]) -> NDArray:
    """Return a variable with these dimensions in this order and our dofs; dimensions of length one beyond them are dropped."""
    variable = content[key].squeeze([d for d in content[key].dims if d not in dims and content.sizes[d] == 1], drop=True)
    missing = [d for d in dims if d not in variable.dims and d in content.coords]
    variable = variable.expand_dims(missing) if missing else variable
    if set(variable.dims) != set(dims):
        raise InputError(f"{key}: dimensions {dims} expected, {variable.dims} found. Select one value of the others.")
    wanted = list(labels.values())
    variable = variable.sel({d: wanted for d in dims if d.endswith("_dof")})
    return np.asarray(variable.transpose(*dims).values)
