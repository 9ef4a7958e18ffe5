"""From dimensionless tables of several files to one data set in SI units, after making sure that the files fit together."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr

from ogilvie.errors import FormatError, InputError
from ogilvie.hydro.reference import moved_to_origin
from ogilvie.hydro.schema import DOFS, hydro_from_arrays, validate
from ogilvie.hydro.wamit_axes import direction_order, frequency_order, merged, wrapped
from ogilvie.hydro.wamit_drift import Axes, drift_variables, quadratic_variables
from ogilvie.hydro.wamit_parameters import Parameters
from ogilvie.hydro.wamit_tables import ComplexArray, Drift, Quadratic, Radiation, Response
from ogilvie.hydro.wamit_text import Array

FORCES = {"3": "excitation_force", "3fk": "froude_krylov_force", "3sc": "diffraction_force"}


@dataclass(frozen=True, eq=False)
class Tables:
    """The tables of one run, by suffix."""

    radiation: Radiation
    responses: Mapping[str, Response] = field(default_factory=dict)
    drifts: Mapping[str, Drift] = field(default_factory=dict)
    quadratics: Mapping[str, Quadratic] = field(default_factory=dict)
    stiffness: Array | None = None


def dataset(tables: Tables, parameters: Parameters, *, name: str, source: str) -> xr.Dataset:
    """Return one data set about O in SI units.

    Parameters
    ----------
    tables : Tables
    parameters : Parameters
    name, source : str
        Become attributes.

    Raises
    ------
    FormatError
        Files that contradict each other: frequencies, directions, modes, or a total that is not the sum of its parts.
    """
    radiation = _radiation(tables.radiation, parameters)
    axes = Axes(radiation["omega"], tables.radiation.path, None, None, tables.radiation.modes)
    notes: list[str] = []
    responses: dict[str, ComplexArray] = {}
    for suffix, table in tables.responses.items():
        values, axes = _response(table, parameters, axes, notes, required=suffix != "4")
        if values is not None:
            responses[suffix] = values
    if "2" in responses and "3" not in responses:
        notes.append(f"excitation by Haskind's relation, {tables.responses['2'].path.name}")
        responses["3"] = responses["2"]
    _check_sum(responses, tables.responses)
    drift = drift_variables(tables.drifts, parameters, axes)
    quadratic = quadratic_variables(tables.quadratics, parameters, axes)
    attrs = _attributes(parameters, notes)
    names = [DOFS[mode - 1] for mode in axes.modes]
    try:
        hydro = hydro_from_arrays(
            **radiation,
            wave_direction=None if axes.degrees is None else np.deg2rad(axes.degrees),
            **_forces(responses, parameters, axes),
            **_matrices(tables.stiffness, parameters, axes),
            rho=parameters.rho,
            g=parameters.g,
            water_depth=parameters.water_depth,
            dofs=tuple(names),
            name=name,
            source=source,
            attrs=attrs,
        )
        for extra in (drift, quadratic):
            hydro = hydro.merge(extra.drop_vars("wave_direction", errors="ignore") if axes.degrees is not None else extra)
        return validate(moved_to_origin(hydro, parameters.origin))
    except InputError as error:
        raise FormatError(f"{tables.radiation.path.name} and the files beside it: {error}") from error


def _radiation(table: Radiation, parameters: Parameters) -> dict[str, Any]:
    """Split off zero and infinite frequency, sort, give units."""
    keep = np.array(table.modes) - 1
    omega = parameters.omega(table.axis)
    k = _rotations(table.modes)
    unit = parameters.rho * parameters.ulen ** (3 + k[:, None] + k[None, :])
    A = table.added_mass[:, keep[:, None], keep] * unit
    finite = np.flatnonzero((omega > 0) & np.isfinite(omega))
    if len(finite) == 0:
        raise FormatError(f"{table.path.name}: added mass at finite frequencies expected, none found. Re-run with periods.")
    order = finite[np.argsort(omega[finite])]
    B = table.damping[:, keep[:, None], keep][order] * unit * omega[order, None, None]
    limits = {"added_mass_zero": omega == 0.0, "added_mass_inf": np.isinf(omega)}
    found = {key: A[np.argmax(where)] for key, where in limits.items() if where.any()}
    return {"omega": omega[order], "added_mass": A[order], "radiation_damping": B, **found}


def _response(
    table: Response, parameters: Parameters, axes: Axes, notes: list[str], *, required: bool
) -> tuple[ComplexArray | None, Axes]:
    """Return the dimensionless values (omega, direction, mode) on the common axes; the first table sets the directions."""
    rows = frequency_order(parameters.omega(table.axis), table.path, axes.omega, axes.omega_path)
    degrees, values = merged(table.path, wrapped(table.directions), table.values[rows])
    if len(degrees) < len(table.directions):
        notes.append(f"{table.path.name}: directions that differ by 360 deg are one")
    if axes.degrees is None or axes.degrees_path is None:
        axes = Axes(axes.omega, axes.omega_path, degrees, table.path, axes.modes)
    else:
        values = values[:, direction_order(degrees, table.path, axes.degrees, axes.degrees_path)]
    missing = sorted(set(axes.modes) - set(table.modes))
    if missing and not required:
        notes.append(f"{table.path.name}: left out, modes {missing} are not in it")
        return None, axes
    if missing:
        raise FormatError(
            f"{table.path.name}: modes {list(axes.modes)} as in {axes.omega_path.name} expected, {missing} missing. "
            "Re-export both with the same modes."
        )
    unused = sorted(set(table.modes) - set(axes.modes))
    if unused:
        notes.append(f"{table.path.name}: modes {unused} left out, {axes.omega_path.name} lacks them")
    return values[:, :, [table.modes.index(mode) for mode in axes.modes]], axes


def _check_sum(values: Mapping[str, ComplexArray], tables: Mapping[str, Response]) -> None:
    if not all(suffix in values for suffix in FORCES):
        return
    total, parts = values["3"], values["3fk"] + values["3sc"]
    scale = np.maximum(np.abs(values["3fk"]), np.abs(values["3sc"])).max(axis=(0, 1))
    wrong = np.abs(total - parts) > 1e-3 * scale + 1e-6 * scale.max()
    if wrong.any():
        f, b, m = np.argwhere(wrong)[0]
        raise FormatError(
            f"{tables['3fk'].path.name} and {tables['3sc'].path.name}: parts of the total force expected, "
            f"{total[f, b, m]:.6e} instead of {parts[f, b, m]:.6e} found (frequency {f + 1}, direction {b + 1}, mode {m + 1}). "
            "The files belong to different runs, or one is damaged; keep the files of one run."
        )


def _forces(values: Mapping[str, ComplexArray], parameters: Parameters, axes: Axes) -> dict[str, Any]:
    k = _rotations(axes.modes)
    unit = parameters.rho * parameters.g * parameters.ulen ** (2 + k)
    found = {name: values[suffix] * unit for suffix, name in FORCES.items() if suffix in values}
    total = found.get("excitation_force")
    if total is not None and "froude_krylov_force" in found:
        found.setdefault("diffraction_force", total - found["froude_krylov_force"])
    elif total is not None and "diffraction_force" in found:
        found["froude_krylov_force"] = total - found["diffraction_force"]
    if "4" in values:
        found["motion_rao"] = values["4"] / parameters.ulen**k
    return found


def _matrices(stiffness: Array | None, parameters: Parameters, axes: Axes) -> dict[str, Any]:
    keep = np.array(axes.modes) - 1
    found = {key: matrix[keep[:, None], keep] for key, matrix in parameters.matrices.items()}
    if stiffness is not None:
        k = _rotations(axes.modes)
        unit = parameters.rho * parameters.g * parameters.ulen ** (2 + k[:, None] + k[None, :])
        found["hydrostatic_stiffness"] = stiffness[keep[:, None], keep] * unit
    return found


def _attributes(parameters: Parameters, notes: list[str]) -> dict[str, Any]:
    attrs: dict[str, Any] = {f"{key}_source": source for key, source in parameters.sources.items()}
    attrs |= {"ulen": parameters.ulen, "first_column": parameters.first_column}
    if any(parameters.origin):
        attrs["moved_from"] = list(parameters.origin)
    if notes:
        attrs["notes"] = "; ".join(notes)
    return attrs


def _rotations(modes: tuple[int, ...]) -> Array:
    """Return 0.0 for translations and 1.0 for rotations."""
    return (np.array(modes) > 3).astype(float)
