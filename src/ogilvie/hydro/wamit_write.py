"""Writes a data set as WAMIT's numeric output files."""

import os
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import xarray as xr

from ogilvie.errors import InputError
from ogilvie.hydro.schema import DOFS, validate
from ogilvie.hydro.wamit import wamit_files
from ogilvie.hydro.wamit_format import exponential, mode_numbers, periods, polar, rotations
from ogilvie.hydro.wamit_text import Array, read_text_lines
from ogilvie.hydro.wamit_write_drift import drift_tables, quadratic_tables

_FORCES = {"3": "excitation_force", "3fk": "Froude_Krylov_force", "3sc": "diffraction_force"}
_MARK = "written by ogilvie"


def write_wamit(hydro: xr.Dataset, stem: str | Path, *, ulen: float = 1.0) -> tuple[Path, ...]:
    """Write the files of one body as WAMIT prints them, all of them or none.

    Parameters
    ----------
    hydro : Dataset
        Obeys :mod:`ogilvie.hydro.schema`; zero speed.
    stem : path
        Folder and name without suffix.
    ulen : float
        Length scale, m.

    Returns
    -------
    tuple of Path
        `.1`, and as far as the data are there `.3`, `.3fk`, `.3sc`, `.4`, `.7`, `.8`, `.9`, `.12d`, `.12s`, `.hst`; a `.out`
        that holds no more than the constants (gravity, length scale, depth, density), so that the set can be read again; and,
        with inertia, a `.frc` in alternative form 2 with mass, external damping and stiffness.

    Raises
    ------
    InputError
        Forward speed, dofs other than the rigid ones, or a length scale that is not positive.

    Notes
    -----
    Numbers have WAMIT's seven digits, periods too, so that frequencies read again differ by up to 5e-7. Couplings that are zero
    at every frequency are left out, as WAMIT leaves out those that vanish by symmetry.

    Examples
    --------
    >>> import tempfile
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> A = np.full((2, 1, 1), 1025.0)
    >>> h = hydro_from_arrays(omega=[np.pi, 2 * np.pi], added_mass=A, radiation_damping=0 * A, dofs=("heave",))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     print(write_wamit(h, Path(folder) / "buoy")[0].read_text())
      1.000000E+00     3     3  1.000000E+00  0.000000E+00
      2.000000E+00     3     3  1.000000E+00  0.000000E+00
    """
    validate(hydro)
    if hydro.attrs.get("speed", 0.0) != 0.0:
        raise InputError(f"speed: zero expected for WAMIT files, {hydro.attrs['speed']:g} m/s found. Use write_netcdf.")
    strange = [name for name in hydro.influenced_dof.values if name not in DOFS]
    if strange or not ulen > 0.0:
        raise InputError(f"write_wamit: rigid-body dofs and a positive ulen expected, {strange} and {ulen!r} found.")
    path = Path(stem)
    if not path.parent.is_dir():
        raise InputError(f"{path.parent}: an existing folder expected, none found. Make it first.")
    texts: dict[str, str] = {"1": _radiation(hydro, ulen)}
    scale = hydro.attrs["rho"] * hydro.attrs["g"]
    for suffix, key in _FORCES.items():
        if key in hydro:
            texts[suffix] = _response(hydro, hydro[key].values / (scale * ulen ** (2 + rotations(hydro))))
    if "motion_rao" in hydro:
        texts["4"] = _response(hydro, hydro.motion_rao.values * ulen ** rotations(hydro))
    texts |= drift_tables(hydro, ulen) | quadratic_tables(hydro, ulen)
    if "hydrostatic_stiffness" in hydro:
        texts["hst"] = _hydrostatics(hydro, ulen)
    if "inertia_matrix" in hydro:
        texts["frc"] = _force_control(hydro)
    texts["out"] = _head(hydro, ulen)
    _refuse_mixture(path, set(texts))
    return _write_all({path.with_name(f"{path.name}.{suffix}"): text for suffix, text in texts.items()})


def _refuse_mixture(path: Path, suffixes: set[str]) -> None:
    """Refuse to leave tables of another run beside the new ones, and to overwrite the .out or .frc of a WAMIT run."""
    for suffix, file in wamit_files(path.with_name(f"{path.name}.1"))[1].items():
        table = suffix not in ("out", "frc")
        if suffix == "gdf" or (suffix in suffixes and (table or any(_MARK in line for line in read_text_lines(file)[:3]))):
            continue
        raise InputError(
            f"{file}: no other files of this stem expected, this one found; it would be read together with the new ones, or be "
            "overwritten. Choose another stem, or move it away."
        )


def _write_all(texts: dict[Path, str]) -> tuple[Path, ...]:
    """Write every text beside its target first, then move them all into place."""
    waiting: dict[Path, Path] = {}
    try:
        for target, text in texts.items():
            handle, name = tempfile.mkstemp(prefix=f".{target.name}-", dir=target.parent)
            waiting[target] = Path(name)
            with os.fdopen(handle, "w", encoding="ascii", newline="\n") as stream:
                stream.write(text)
        for target, temporary in waiting.items():
            os.replace(temporary, target)
    finally:
        for temporary in waiting.values():
            temporary.unlink(missing_ok=True)
    return tuple(texts)


def _radiation(hydro: xr.Dataset, ulen: float) -> str:
    k, modes = rotations(hydro), mode_numbers(hydro)
    unit = hydro.attrs["rho"] * ulen ** (3 + k[:, None] + k[None, :])
    A = hydro.added_mass.values / unit
    B = hydro.radiation_damping.values / (unit * hydro.omega.values[:, None, None])
    limits = {-1.0: "added_mass_zero", 0.0: "added_mass_inf"}
    special = {period: hydro[key].values / unit for period, key in limits.items() if key in hydro}
    occurs = (A != 0).any(axis=0) | (B != 0).any(axis=0) | np.eye(len(modes), dtype=bool)
    for matrix in special.values():
        occurs |= matrix != 0
    couplings = [(i, j, modes[i], modes[j]) for i, j in np.argwhere(occurs | occurs.T)]
    lines = [f" {p:13.6E}{mi:6d}{mj:6d}{exponential(M[i, j])}\n" for p, M in special.items() for i, j, mi, mj in couplings]
    for f, period in periods(hydro):
        for i, j, mi, mj in couplings:
            lines.append(f" {period:13.6E}{mi:6d}{mj:6d}{exponential(A[f, i, j])}{exponential(B[f, i, j])}\n")
    return "".join(lines)


def _response(hydro: xr.Dataset, values: np.ndarray) -> str:
    modes, degrees = mode_numbers(hydro), np.degrees(hydro.wave_direction.values)
    return "".join(
        f" {period:13.6E}{degrees[b]:14.6E}{mode:6d}{polar(complex(values[f, b, m]))}"
        for f, period in periods(hydro)
        for b in range(len(degrees))
        for m, mode in enumerate(modes)
    )


def _hydrostatics(hydro: xr.Dataset, ulen: float) -> str:
    C, k = _full(hydro, "hydrostatic_stiffness"), (np.arange(6) > 2).astype(float)
    C = C / (hydro.attrs["rho"] * hydro.attrs["g"] * ulen ** (2 + k[:, None] + k[None, :]))
    return "".join(f"{i + 1:6d}{j + 1:6d}{exponential(C[i, j]):>15s}\n" for i in range(6) for j in range(6))


def _full(hydro: xr.Dataset, key: str) -> Array:
    """Return the 6 x 6 matrix of all modes, zero where the data set has no dof."""
    M, at = np.zeros((6, 6)), np.array(mode_numbers(hydro)) - 1
    M[np.ix_(at, at)] = hydro[key].values
    return M


def _force_control(hydro: xr.Dataset) -> str:
    M = _full(hydro, "inertia_matrix")
    m = M.diagonal()[:3].max()
    cog = (M[1, 5] / m, M[2, 3] / m, M[0, 4] / m) if m > 0 else (0.0, 0.0, 0.0)
    lines = [
        f"Body matrices, {_MARK}",
        "1 0 1 1 0 0 0 0 0",
        _number(hydro.attrs["rho"]),
        " ".join(map(_number, cog)),
    ]
    for key in ("inertia_matrix", "external_damping", "external_stiffness"):
        lines.append("1" if key in hydro else "0")
        if key in hydro:
            lines += [" ".join(map(_number, row)) for row in _full(hydro, key)]
    return "\n".join([*lines, "0", "0", ""])


_number: Callable[[float], str] = "{:.10E}".format


def _head(hydro: xr.Dataset, ulen: float) -> str:
    depth = hydro.attrs["water_depth"]
    shown = f"{_number(depth):>18s}" if np.isfinite(depth) else f"{'infinite':>15s}   "
    return (
        f" Constants of the numeric output files beside this one, {_MARK}, not by WAMIT.\n\n"
        f" Gravity: {_number(hydro.attrs['g']):>18s}    Length scale: {_number(ulen):>18s}\n"
        f" Water depth:{shown}  Water density: {_number(hydro.attrs['rho']):>18s}\n"
        "\n End of constants.\n"
    )
