"""HAMS: the folder `Wamit_format` it writes, with ControlFile.in and Hydrostatic.in of its input folder."""

from pathlib import Path

import numpy as np
import xarray as xr

from ogilvie.errors import FormatError, InputError
from ogilvie.hydro.schema import DOFS, validate
from ogilvie.hydro.wamit import read_tables, wamit_files
from ogilvie.hydro.wamit_dimension import dataset
from ogilvie.hydro.wamit_parameters import Parameters
from ogilvie.hydro.wamit_run_files import leading_numbers
from ogilvie.hydro.wamit_tables import hydrostatics
from ogilvie.hydro.wamit_text import Array, fail, read_text_lines
from ogilvie.units import GRAVITY, SEA_WATER

_COLUMNS = {1: "deep-water wavenumber", 2: "wavenumber", 3: "frequency", 4: "period", 5: "wavelength"}
_BLOCKS = {
    "body mass matrix": "inertia_matrix",
    "external linear damping matrix": "external_damping",
    "external quadratic damping matrix": "quadratic_damping",
    "hydrostatic restoring matrix": "hydrostatic_stiffness",
    "external restoring matrix": "external_stiffness",
}


def read_hams(
    path: str | Path, *, rho: float | None = None, g: float | None = None, water_depth: float | None = None
) -> xr.Dataset:
    """Read a HAMS case.

    Parameters
    ----------
    path : path
        The folder of the case (with Input/ControlFile.in), its folder Wamit_format, or a file in it.
    rho, g, water_depth : float, optional
        kg/m3, m/s2, m. HAMS has 1025 and 9.80665 built in and the depth in ControlFile.in; give others only for a changed HAMS.

    Returns
    -------
    xarray.Dataset
        Obeys :mod:`ogilvie.hydro.schema`.

    Raises
    ------
    FormatError
        A damaged file, or no ControlFile.in: without it nobody knows whether the first column is a period.

    Notes
    -----
    HAMS writes F / (rho g), A / rho, B / (rho omega): the reference length takes no part. Where the motion X belongs its `.4`
    holds i X / (rho g L^m), m = 2 for translations and 3 for rotations. Versions that write X itself are told apart by the
    equation of motion with HAMS's own coefficients; a `.4` that fits neither is left out with a note.

    References
    ----------
    Y. Liu, HAMS: A frequency-domain preprocessor for wave-structure interactions, J. Mar. Sci. Eng. 7(3):81, 2019.
    """
    table, control = find_case(Path(path))
    stem, files = wamit_files(table)
    column, depth, point, length = read_control_file(control)
    matrices = {}
    hydrostatic = control.with_name("Hydrostatic.in")
    if hydrostatic.is_file():
        matrices = read_hydrostatic(hydrostatic)
    quadratic = matrices.pop("quadratic_damping", np.zeros((6, 6)))
    stiffness = matrices.pop("hydrostatic_stiffness", None)
    values = {"rho": (rho, SEA_WATER), "g": (g, GRAVITY), "water_depth": (water_depth, depth)}
    parameters = Parameters(
        **{key: default if given is None else given for key, (given, default) in values.items()},
        ulen=1.0,
        first_column=column,
        origin=point,
        sources={key: "HAMS" if given is None else "given" for key, (given, _) in values.items()}
        | {"first_column": control.name},
        matrices=matrices,
    )
    _check_stiffness(files, stiffness, parameters)
    hydro = dataset(read_tables(files), parameters, name=stem.name, source="HAMS " + ", ".join(f.name for f in files.values()))
    return _with_motions(hydro, length, bool(quadratic.any()))


def find_case(path: Path) -> tuple[Path, Path]:
    """Return the `.1` file and ControlFile.in of a case, from its folder, its folder Wamit_format, or a file there."""
    folder = path if path.is_dir() else path.parent
    if not folder.is_dir():
        raise InputError(f"{folder}: an existing folder expected, none found. Check the path.")
    near = [folder, *folder.parents][:3]
    control = next((found for base in near if (found := base / "Input" / "ControlFile.in").is_file()), None)
    if control is None:
        raise FormatError(
            f"{folder}: Input/ControlFile.in of the HAMS case expected nearby, not found. Without it the first column may be a "
            "period, a frequency or a wavenumber; add it, or read the file with format='wamit' if it is the period."
        )
    pattern = "*.1" if path.is_dir() else f"{path.name.split('.')[0]}.1"
    base = folder if any(folder.glob(pattern)) else control.parent.parent
    tables = sorted({*base.glob(pattern), *base.glob(f"*/Wamit_format/{pattern}"), *base.glob(f"Wamit_format/{pattern}")})
    if len(tables) != 1:
        names = ", ".join(str(t.relative_to(base)) for t in tables) or "none"
        raise FormatError(f"{base}: one {pattern} in Wamit_format expected, {names} found. Name the file to read.")
    return tables[0], control


def read_control_file(path: Path) -> tuple[str, float, tuple[float, float, float], float]:
    """Return the meaning of the first column, the depth, the reference point (m) and the reference length (m)."""
    lines = read_text_lines(path)

    def numbers(word: str, count: int) -> list[float]:
        for k, line in enumerate(lines):
            if line.strip().startswith(word):
                found = leading_numbers(line.split(word, 1)[1])
                if len(found) < count:
                    fail(path, f"{count} numbers after {word}", str(len(found)), "Repair the line.", line=k + 1)
                return found
        fail(path, f"a line {word}", "none", "Use the ControlFile.in of the run.")

    depth = numbers("Waterdepth", 1)[0]
    kind = int(numbers("Output_frequency_type", 1)[0])
    if kind not in _COLUMNS:
        fail(path, "Output_frequency_type 1 to 5", str(kind), "Repair the line.")
    x, y, z = numbers("Reference_body_center", 3)[:3]
    length = numbers("Reference_body_length", 1)[0]
    return _COLUMNS[kind], depth if depth > 0 else np.inf, (x, y, z), length


def read_hydrostatic(path: Path) -> dict[str, Array]:
    """Return the 6 x 6 matrices of Hydrostatic.in (SI, about the reference point)."""
    lines = read_text_lines(path)
    found = {}
    for k, line in enumerate(lines):
        name = _BLOCKS.get(line.strip().rstrip(":").lower())
        if name is None:
            continue
        rows = [leading_numbers(row) for row in lines[k + 1 : k + 7]]
        if len(rows) != 6 or any(len(row) != 6 for row in rows):
            fail(path, f"six lines of six numbers after {line.strip()!r}", "something else", "Repair the matrix.", line=k + 1)
        found[name] = np.array(rows)
    if "inertia_matrix" not in found:
        fail(path, "Body Mass Matrix:", "none", "Use the Hydrostatic.in of the run.")
    return found


def _check_stiffness(files: dict[str, Path], stiffness: Array | None, parameters: Parameters) -> None:
    """Make sure that `.hst` times rho g is the matrix of Hydrostatic.in: the proof of density and gravity."""
    if stiffness is None or "hst" not in files:
        return
    C = hydrostatics(files["hst"]) * parameters.rho * parameters.g
    if not np.allclose(C, stiffness, rtol=0, atol=1e-3 * np.abs(stiffness).max()):
        k = np.unravel_index(np.abs(C - stiffness).argmax(), C.shape)
        fail(
            files["hst"],
            f"C({k[0] + 1},{k[1] + 1}) rho g = {stiffness[k]:.6g} as in Hydrostatic.in",
            f"{C[k]:.6g} with rho {parameters.rho:g} and g {parameters.g:g}",
            "Give the rho and g of your HAMS, or the files of one run.",
        )


def _with_motions(hydro: xr.Dataset, length: float, quadratic: bool) -> xr.Dataset:
    """Return the data set with motions in m/m and rad/m, or without them where the file's meaning cannot be told."""
    if "motion_rao" not in hydro:
        return hydro
    reason = "external quadratic damping" if quadratic else "no inertia or stiffness" if not _can_move(hydro) else None
    if reason is None:
        raw = hydro.motion_rao.values
        size = length ** np.where(np.arange(6) < 3, 2.0, 3.0)
        own = _own_motions(hydro)
        scale = np.abs(own).max(axis=(0, 1))
        for motion in (raw, -1j * hydro.attrs["rho"] * hydro.attrs["g"] * size * raw):
            off = np.abs(motion - own).max(axis=(0, 1))
            if np.all(off <= 1e-2 * scale + 1e-9 * scale.max()):
                return validate(hydro.assign(motion_rao=(hydro.motion_rao.dims, motion)))
        reason = "it fits neither X nor i X / (rho g L^m) by the equation of motion"
    notes = "; ".join(filter(None, [hydro.attrs.get("notes"), f"motions (.4) left out: {reason}"]))
    return hydro.drop_vars("motion_rao").assign_attrs(notes=notes)


def _can_move(hydro: xr.Dataset) -> bool:
    needed = {"inertia_matrix", "hydrostatic_stiffness", "excitation_force"} <= set(hydro)
    return needed and tuple(hydro.influenced_dof.values) == DOFS


def _own_motions(hydro: xr.Dataset) -> np.ndarray:
    """Solve (-omega^2 (M + A) + i omega (B + B_ext) + C + C_ext) X = F."""
    w = hydro.omega.values[:, None, None]
    zero = np.zeros((6, 6))
    damping = hydro.radiation_damping.values + np.asarray(hydro.get("external_damping", zero))
    stiffness = hydro.hydrostatic_stiffness.values + np.asarray(hydro.get("external_stiffness", zero))
    Z = -(w**2) * (hydro.inertia_matrix.values + hydro.added_mass.values) + 1j * w * damping + stiffness
    return np.linalg.solve(Z, hydro.excitation_force.values.swapaxes(1, 2)).swapaxes(1, 2)
