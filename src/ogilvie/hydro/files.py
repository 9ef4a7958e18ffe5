"""Reads hydrodynamic coefficients of any known format; what kind of file it is, is seen from its name and surroundings."""

from pathlib import Path

import xarray as xr

from ogilvie.errors import FormatError, InputError
from ogilvie.hydro.hams import read_hams
from ogilvie.hydro.netcdf import read_netcdf
from ogilvie.hydro.probe import check_convention
from ogilvie.hydro.wamit import read_wamit, split_name, wamit_files

FORMATS = ("wamit", "hams", "netcdf")


def read_hydro(
    path: str | Path,
    *,
    format: str | None = None,
    ulen: float | None = None,
    rho: float | None = None,
    g: float | None = None,
    water_depth: float | None = None,
    probe: bool = True,
) -> xr.Dataset:
    """Read a hydrodynamic data set and make sure of its conventions.

    Parameters
    ----------
    path : path
        WAMIT: the stem or any of the files (.1 .2 .3 .3fk .3sc .4 .7 .8 .9 .12d .12s .hst .out ...), or a folder with one run.
        HAMS: the folder of the case, its Wamit_format, or a file there. netCDF: a file of this package or of Capytaine.
    format : {"wamit", "hams", "netcdf"}, optional
        Found out by itself if not given.
    ulen, rho, g, water_depth : float, optional
        Length scale (m), density (kg/m3), gravity (m/s2), depth (m) of the run, where the files do not say; the attributes
        `rho_source` and so on tell where each value comes from, "assumed" among them.
    probe : bool
        Whether to refuse data whose phases in long waves contradict the convention, see :mod:`ogilvie.hydro.probe`.

    Returns
    -------
    xarray.Dataset
        Obeys :mod:`ogilvie.hydro.schema`: SI, radians, exp(+i omega t), z up, about O.

    Raises
    ------
    InputError
        No such file, or none of the known formats.
    FormatError
        A damaged, truncated or contradictory file; the message names file and line.
    ConventionError
        Time factor, directions or axes are not the project's.

    Examples
    --------
    >>> import tempfile
    >>> import numpy as np
    >>> import ogilvie as og
    >>> A = np.ones((2, 1, 1))
    >>> hydro = og.hydro_from_arrays(omega=[1.0, 2.0], added_mass=A, radiation_damping=A, dofs=("heave",))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     paths = og.write_wamit(hydro, Path(folder) / "buoy")
    ...     back = og.read_hydro(Path(folder) / "buoy.1")
    >>> back.omega.values.round(5)
    array([1., 2.])
    """
    source = Path(path)
    for name, value in {"ulen": ulen, "rho": rho, "g": g, "water_depth": water_depth}.items():
        if value is not None and not value > 0.0:
            raise InputError(f"{name}: a positive number expected, {value!r} given.")
    kind = format or _kind(source)
    if kind == "wamit":
        hydro = read_wamit(_only_stem(source), ulen=ulen, rho=rho, g=g, water_depth=water_depth)
    elif kind in ("hams", "netcdf") and ulen is not None:
        raise InputError(f"ulen: only WAMIT files have a length scale, ulen={ulen:g} given with format {kind!r}. Leave it out.")
    elif kind == "hams":
        hydro = read_hams(source, rho=rho, g=g, water_depth=water_depth)
    elif kind == "netcdf":
        hydro = read_netcdf(source, rho=rho, g=g, water_depth=water_depth)
    else:
        raise InputError(f"format: one of {', '.join(FORMATS)} expected, {format!r} given.")
    return check_convention(hydro, source=source.name) if probe else hydro


def _kind(path: Path) -> str:
    """Tell the format from the name of the file and what stands beside it."""
    if path.suffix.lower() in (".nc", ".nc4", ".cdf"):
        return "netcdf"
    if not path.parent.is_dir():
        raise InputError(f"{path}: an existing file or stem expected, no folder {path.parent} found. Check the path.")
    if _is_hams(path):
        return "hams"
    if path.is_dir() or wamit_files(path)[1]:
        return "wamit"
    reason = "an unknown kind of file" if path.exists() else "nothing"
    raise InputError(
        f"{path}: WAMIT files or their stem, a HAMS case or a netCDF file expected, {reason} found. "
        f"Check the path, or say which format it is: {', '.join(FORMATS)}."
    )


def _is_hams(path: Path) -> bool:
    """Tell whether a folder is a HAMS case or its Wamit_format, or a file lies in such a folder."""
    folder = path if path.is_dir() else path.parent
    return folder.name == "Wamit_format" or (path.is_dir() and (path / "Input" / "ControlFile.in").is_file())


def _only_stem(path: Path) -> Path:
    """Return the path itself, or the only stem in a folder."""
    if not path.is_dir() or wamit_files(path)[1]:
        return path
    stems = sorted({path / split_name(file.name)[0] for file in path.iterdir() if split_name(file.name)[1] == "1"})
    if len(stems) != 1:
        names = ", ".join(stem.name for stem in stems) or "none"
        raise FormatError(f"{path}: the files of one WAMIT run expected, {names} found. Name the stem or a file.")
    return stems[0]
