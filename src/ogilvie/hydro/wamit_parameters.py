"""What a WAMIT run was made with: density, gravity, length, depth, first column, mass; and where each is known from."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np

from ogilvie.errors import FormatError, OgilvieWarning
from ogilvie.hydro.wamit_run_files import (
    Given,
    read_config,
    read_force_control,
    read_geometry_head,
    read_out,
    read_potential_control,
)
from ogilvie.hydro.wamit_text import Array, fail
from ogilvie.units import GRAVITY, SEA_WATER

T = TypeVar("T")

_FIRST_COLUMN = {1: "period", 2: "frequency", 3: "deep-water wavenumber", 4: "wavenumber"}


@dataclass(frozen=True)
class Parameters:
    """Parameters of a run with the source of each.

    Parameters
    ----------
    rho, g, ulen, water_depth : float
        kg/m3, m/s2, m, m (inf for deep water).
    first_column : str
        Meaning of the first column: "period", "frequency", "deep-water wavenumber", "wavenumber" or "wavelength".
    origin : (3,) tuple
        Where the body's axes stand in the axes of the waves, m.
    sources : mapping
        Where rho, g, ulen, water_depth and first_column come from.
    matrices : mapping
        inertia_matrix, external_damping, external_stiffness (6, 6), about `origin`, as far as they are known.
    """

    rho: float
    g: float
    ulen: float
    water_depth: float
    first_column: str
    origin: tuple[float, float, float]
    sources: Mapping[str, str]
    matrices: Mapping[str, Array]

    def omega(self, column: Array) -> Array:
        """Turn the first column (n,) into rad/s; 0 and inf stand for the limits.

        Notes
        -----
        Periods: -1 is zero frequency, 0 infinite. Frequencies and wavenumbers: 0 is zero, -1 infinite.
        omega^2 = g K (deep) or g k tanh(k h); wavenumbers in the file are multiplied by ULEN.
        """
        zero, limit = np.abs(column) < 1e-9, column < 0.0
        x = np.where(zero | limit, 1.0, column)
        if self.first_column in ("period", "wavelength"):
            zero, limit = limit, zero
        if self.first_column == "period":
            omega = 2.0 * np.pi / x
        elif self.first_column == "frequency":
            omega = x
        elif self.first_column == "deep-water wavenumber":
            omega = np.sqrt(self.g * x / self.ulen)
        else:
            k = 2.0 * np.pi / x if self.first_column == "wavelength" else x / self.ulen
            omega = np.sqrt(self.g * k * np.tanh(np.minimum(k * self.water_depth, 700.0)))
        return np.where(zero, 0.0, np.where(limit, np.inf, omega))


def collect(
    files: Mapping[str, Path], *, ulen: float | None, rho: float | None, g: float | None, water_depth: float | None
) -> Parameters:
    """Gather the parameters of a run from the user and from the .out, .frc, .gdf, .pot and .cfg files that are there.

    Parameters
    ----------
    files : mapping
        Suffix without dot, lower case -> path.
    ulen, rho, g, water_depth : float, optional
        Given by the user; these win.

    Returns
    -------
    Parameters

    Raises
    ------
    FormatError
        A file that cannot be understood, or two files that contradict each other.
    """
    config = read_config(files["cfg"]) if "cfg" in files else {}
    readers = {"out": read_out, "frc": read_force_control, "gdf": read_geometry_head, "pot": read_potential_control}
    if "out" in files:
        del readers["pot"]  # the .out repeats it, and is the record of what was run
    given = [reader(files[suffix]) for suffix, reader in readers.items() if suffix in files]
    user = {"ulen": ulen, "rho": rho, "g": g, "water_depth": water_depth}
    default = {"ulen": 1.0, "rho": SEA_WATER, "g": GRAVITY, "water_depth": np.inf}
    values, sources = {}, {}
    for key in user:
        values[key], sources[key] = _choose(key, user[key], default[key], given)
    _warn_of_other_density(rho, given)
    column, sources["first_column"] = _first_column(config, files.get("cfg"))
    origin = _agree("origin of the body", [(item.path, item.origin) for item in given if item.origin is not None])
    x, y, z, turned = origin or (0.0, 0.0, 0.0, 0.0)
    if turned:
        path = next(item.path for item in given if item.origin is not None)
        fail(path, "body axes parallel to those of the waves (PHIBODY = 0)", f"{turned:g} deg", "Run WAMIT with PHIBODY = 0.")
    matrices: dict[str, Array] = {}
    for item in given:
        matrices |= item.matrices
    if "inertia_matrix" not in matrices:
        matrices |= _inertia(given, values["rho"])
    return Parameters(**values, first_column=column, origin=(x, y, z), sources=sources, matrices=matrices)


def _inertia(given: list[Given], rho: float) -> dict[str, Array]:
    """Build the 6 x 6 inertia of a form 1 run: m = rho V, I_ij = m r_ij |r_ij| about the body's origin."""
    for item in given:
        if item.volume is None or item.cog is None or item.gyradii is None:
            continue
        m, (x, y, z), r = rho * item.volume, item.cog, item.gyradii
        S = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        return {"inertia_matrix": np.block([[m * np.eye(3), -m * S], [m * S, m * r * np.abs(r)]])}
    return {}


def _warn_of_other_density(rho: float | None, given: list[Given]) -> None:
    for item in given:
        if rho is not None and item.matrices and not np.isclose(item.numbers.get("rho", rho), rho, rtol=1e-4):
            warnings.warn(
                f"{item.path.name}: masses are for a density of {item.numbers['rho']:g} kg/m3, {rho:g} given; forces are "
                "scaled, masses and external matrices are not.",
                OgilvieWarning,
                stacklevel=4,
            )


def _choose(key: str, user: float | None, default: float, given: list[Given]) -> tuple[float, str]:
    if user is not None:
        return float(user), "given"
    found = [(item.path, item.numbers[key]) for item in given if key in item.numbers]
    value = _agree(key, found)
    if value is None:
        return default, "assumed"
    if not value > 0.0 or (np.isinf(value) and key != "water_depth"):
        fail(found[0][0], f"{key}, a positive number,", f"{value:g}", "Repair the file, or give the value.")
    return value, found[0][0].name


def _agree(what: str, found: list[tuple[Path, T]]) -> T | None:
    """Return the first finding, after making sure that the others say the same."""
    for path, value in found[1:]:
        if not np.allclose(np.asarray(value), np.asarray(found[0][1]), rtol=1e-4, atol=1e-9):
            raise FormatError(
                f"{path.name}: {what} {found[0][1]} expected as in {found[0][0].name}, {value} found. "
                "The files belong to different runs; keep those of one run, or give the right value."
            )
    return found[0][1] if found else None


def _first_column(config: Mapping[str, str], path: Path | None) -> tuple[str, str]:
    key = next((key for key in ("IPEROUT", "IPERIO") if key in config), None)
    if key is None or path is None:
        return "period", "WAMIT's default"
    word = config[key].split()[0] if config[key].split() else ""
    if not word.isdigit() or int(word) not in _FIRST_COLUMN:
        fail(path, f"{key} = 1, 2, 3 or 4", repr(config[key]), "Repair the line.")
    return _FIRST_COLUMN[int(word)], path.name
