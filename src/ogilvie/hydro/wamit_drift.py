"""Mean drift and quadratic transfer functions of WAMIT's files in SI units."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.errors import FormatError
from ogilvie.hydro.schema import DOFS, VARIABLES
from ogilvie.hydro.wamit_axes import direction_order, frequency_order, merged, wrapped
from ogilvie.hydro.wamit_parameters import Parameters
from ogilvie.hydro.wamit_tables import ComplexArray, Drift, Quadratic
from ogilvie.hydro.wamit_text import Array

METHODS = {"9": "pressure", "7": "control_surface", "8": "momentum"}
_REMARKS = {"9": {"rotations": "Rx Ry Rz, as in WAMIT; matters for heave, roll and pitch"}}


@dataclass(frozen=True, eq=False)
class Axes:
    """What the tables have to fit: omega (rad/s, ascending), directions (deg, ascending) or none, modes from 1."""

    omega: Array
    omega_path: Path
    degrees: Array | None
    degrees_path: Path | None
    modes: tuple[int, ...]


def drift_variables(drifts: Mapping[str, Drift], parameters: Parameters, axes: Axes) -> xr.Dataset:
    """Return the mean-drift variables of the schema (about the body's origin).

    Notes
    -----
    Each method keeps its own variable. ``mean_drift`` takes the horizontal components from the far field (momentum), which
    converges best, and the others from the control surface or, failing that, the pressure; its attribute `method` tells.
    """
    variables: dict[str, xr.DataArray] = {}
    single: dict[str, xr.DataArray] = {}
    double: dict[str, xr.DataArray] = {}
    for suffix, table in drifts.items():
        order = frequency_order(parameters.omega(table.axis), table.path, axes.omega, axes.omega_path)
        pairs, values = merged(table.path, wrapped(table.pairs), table.values[order])
        for body, name in ((False, f"mean_drift_{METHODS[suffix]}"), (True, f"mean_drift_{METHODS[suffix]}_body")):
            full = _modes_of(values, table.modes, axes.modes, parameters, body=body)
            if full is None or name not in VARIABLES:
                continue
            alone = _single_direction(full, pairs, table.path, axes)
            if alone is not None:
                variables[name] = alone.assign_attrs(_REMARKS.get(suffix, {}))
            if not body:
                single |= {} if alone is None else {suffix: alone}
                double |= {suffix: _pairs(full, pairs, axes)} if np.any(pairs[:, 0] != pairs[:, 1]) else {}
    for name, found in (("mean_drift", single), ("mean_drift_pairs", double)):
        if found:
            variables[name] = _best(found, axes)
    return xr.Dataset(variables)


def _best(found: Mapping[str, xr.DataArray], axes: Axes) -> xr.DataArray:
    """Return each component by the best method that has it; all have to hold the directions of the first."""
    first = next(iter(found.values()))
    alike = {s: v for s, v in found.items() if v.shape == first.shape and all(v[c].equals(first[c]) for c in first.coords)}
    values, methods = np.full(first.shape, np.nan, dtype=first.dtype), []
    for column, mode in enumerate(axes.modes):
        order = ("8", "7", "9") if mode in (1, 2, 6) else ("7", "9")
        suffix = next((s for s in order if s in alike and not np.isnan(alike[s].values[..., column]).all()), None)
        if suffix is not None:
            values[..., column] = alike[suffix].values[..., column]
            methods.append(f"{DOFS[mode - 1]}: {METHODS[suffix]}")
    return first.copy(data=values).assign_attrs(method=", ".join(methods))


def quadratic_variables(quadratics: Mapping[str, Quadratic], parameters: Parameters, axes: Axes) -> xr.Dataset:
    """Return qtf_diff, qtf_sum (one direction) and, where there are two directions at once, qtf_diff_pairs, qtf_sum_pairs."""
    if not quadratics:
        return xr.Dataset()
    tables = {}
    for suffix, table in quadratics.items():
        pairs, values = merged(table.path, wrapped(table.pairs), table.values)
        tables[suffix] = (parameters.omega(table.axis), pairs, values, table)
    omega = np.unique(np.concatenate([entry[0] for entry in tables.values()]))
    every = np.unique(np.concatenate([entry[1] for entry in tables.values()]), axis=0)
    coords = {"omega_1": omega, "omega_2": omega, "influenced_dof": _names(axes)}
    variables = {}
    for suffix, (w, pairs, values, table) in tables.items():
        at = np.searchsorted(omega, w)
        where = np.array([np.flatnonzero((every == pair).all(axis=1))[0] for pair in pairs])
        dimensional = _modes_of(values, table.modes, axes.modes, parameters, body=False)
        if dimensional is None:
            raise FormatError(f"{table.path.name}: modes 1 to 6 expected, {table.modes} found. Re-export the file.")
        full = np.full((len(omega), len(omega), len(every), len(axes.modes)), np.nan + 0j)
        full[np.ix_(at, at, where)] = dimensional
        name = "qtf_diff" if suffix == "12d" else "qtf_sum"
        said = {"filled_by_symmetry": table.filled} if table.filled else {}
        alone = every[:, 0] == every[:, 1]
        same = axes.degrees is not None and np.array_equal(every[alone, 0], axes.degrees)
        if same and axes.degrees is not None:
            dims = ("omega_1", "omega_2", "wave_direction", "influenced_dof")
            single = {**coords, "wave_direction": np.deg2rad(axes.degrees)}
            variables[name] = xr.DataArray(full[:, :, alone], dims=dims, coords=single, attrs=said)
        if not same or not alone.all():
            dims = ("omega_1", "omega_2", "qtf_pair", "influenced_dof")
            two = {f"qtf_direction_{k + 1}": ("qtf_pair", np.deg2rad(every[:, k])) for k in (0, 1)}
            variables[f"{name}_pairs"] = xr.DataArray(full, dims=dims, coords={**coords, **two}, attrs=said)
    return xr.Dataset(variables)


def _modes_of(
    values: ComplexArray, given: tuple[int, ...], wanted: tuple[int, ...], parameters: Parameters, *, body: bool
) -> ComplexArray | None:
    """Return (..., wanted modes) in SI, NaN where a mode is not given; None where nothing is given.

    About the moving origin (`body`, negative modes) the forces are those of the positive modes.
    """
    has = {abs(mode): k for k, mode in enumerate(given) if (mode < 0) == body}
    if not has:
        return None
    if body:
        has = {mode: k for k, mode in enumerate(given) if 0 < mode <= 3} | has
    full = np.full((*values.shape[:-1], len(wanted)), np.nan + 0j)
    for column, mode in enumerate(wanted):
        if mode in has:
            unit = parameters.rho * parameters.g * parameters.ulen ** (2 if mode > 3 else 1)
            full[..., column] = unit * values[..., has[mode]]
    return full


def _single_direction(full: ComplexArray, pairs: Array, path: Path, axes: Axes) -> xr.DataArray | None:
    alone = pairs[:, 0] == pairs[:, 1]
    if not alone.any():
        return None
    degrees = pairs[alone, 0]
    if axes.degrees is not None and axes.degrees_path is not None:
        order = direction_order(degrees, path, axes.degrees, axes.degrees_path)
    else:
        order = np.argsort(degrees)
    coords = {"omega": axes.omega, "wave_direction": np.deg2rad(degrees[order]), "influenced_dof": _names(axes)}
    values = full[:, alone][:, order].real
    return xr.DataArray(values, dims=("omega", "wave_direction", "influenced_dof"), coords=coords)


def _pairs(full: NDArray, pairs: Array, axes: Axes) -> xr.DataArray:
    coords = {"omega": axes.omega, "influenced_dof": _names(axes)}
    two = {f"drift_direction_{k + 1}": ("drift_pair", np.deg2rad(pairs[:, k])) for k in (0, 1)}
    return xr.DataArray(full, dims=("omega", "drift_pair", "influenced_dof"), coords={**coords, **two})


def _names(axes: Axes) -> list[str]:
    return [DOFS[mode - 1] for mode in axes.modes]
