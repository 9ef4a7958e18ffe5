"""netCDF files: the package's own, written and read, and those of Capytaine."""

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ogilvie.atomic import write_whole
from ogilvie.errors import FormatError, InputError
from ogilvie.hydro.capytaine_data import from_capytaine
from ogilvie.hydro.schema import validate

FORMAT = "ogilvie hydro 1"
_PARTS = ("re", "im")


def write_netcdf(hydro: xr.Dataset, path: str | Path) -> Path:
    """Write a hydrodynamic data set to a netCDF-4 file, whole or not at all.

    Parameters
    ----------
    hydro : Dataset
        Obeys :mod:`ogilvie.hydro.schema`.
    path : path

    Returns
    -------
    Path

    Notes
    -----
    netCDF has no complex numbers: complex variables get a first dimension ``complex`` with the labels "re" and "im". Numbers
    carry checksums, so a damaged file is refused when it is read.

    Examples
    --------
    >>> import tempfile
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> A = np.ones((2, 1, 1))
    >>> h = hydro_from_arrays(omega=[1.0, 2.0], added_mass=A, radiation_damping=A, dofs=("heave",))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     back = read_netcdf(write_netcdf(h, Path(folder) / "h.nc"))
    >>> back.identical(h)
    True
    """
    target = Path(path)
    real = separate_complex(validate(hydro)).assign_attrs(format=FORMAT)
    for key, value in real.attrs.items():
        if not isinstance(value, str | int | float | list | np.generic | np.ndarray):
            raise InputError(
                f"attribute {key}: text or numbers expected, {value!r} found. netCDF holds nothing else; remove it."
            )
    checksum = {str(key): {"fletcher32": True} for key, v in real.variables.items() if v.ndim and v.dtype.kind in "fiu"}
    return write_whole(target, lambda part: real.to_netcdf(part, engine="h5netcdf", encoding=checksum))


def read_netcdf(
    path: str | Path, *, rho: float | None = None, g: float | None = None, water_depth: float | None = None
) -> xr.Dataset:
    """Read a netCDF file of this package or of Capytaine.

    Parameters
    ----------
    path : path
    rho, g, water_depth : float, optional
        For Capytaine files that lack them; a value that contradicts the file is an error.

    Returns
    -------
    xarray.Dataset
        Obeys :mod:`ogilvie.hydro.schema`.

    Raises
    ------
    FormatError
        Not netCDF, several bodies, missing or non-finite variables.
    """
    source = Path(path)
    if not source.is_file():
        raise InputError(f"{source}: an existing file expected, none found. Check the path.")
    content = merge_complex(_load(source))
    try:
        if content.attrs.get("format") == FORMAT:
            content.attrs = {key: _plain(value) for key, value in content.attrs.items() if key != "format"}
            return validate(content)
        return from_capytaine(content, name=source.stem, source=source.name, rho=rho, g=g, water_depth=water_depth)
    except InputError as error:
        raise FormatError(f"{source.name}: {error}") from error


def separate_complex(content: xr.Dataset) -> xr.Dataset:
    """Return the data set with a first dimension "complex" (re, im) in place of complex numbers."""
    split = {}
    for key, variable in content.data_vars.items():
        if variable.dtype.kind == "c":
            parts = np.stack([variable.values.real, variable.values.imag])
            split[key] = (("complex", *variable.dims), parts, variable.attrs)
    return content.assign(split).assign_coords(complex=list(_PARTS)) if split else content


def merge_complex(content: xr.Dataset) -> xr.Dataset:
    """Return the data set with complex numbers in place of the dimension "complex"."""
    if "complex" not in content.dims:
        return content
    if "complex" not in content.coords or content["complex"].values.tolist() != list(_PARTS):
        raise FormatError(f"dimension complex: labels {list(_PARTS)} expected, others found. Write the file again.")
    joined = {}
    for key, variable in content.data_vars.items():
        if "complex" in variable.dims:
            parts = variable.transpose("complex", ...)
            joined[key] = (parts.dims[1:], parts.values[0] + 1j * parts.values[1], variable.attrs)
    return content.drop_vars([*joined, "complex"]).assign(joined)


def _load(path: Path) -> xr.Dataset:
    try:
        with xr.open_dataset(path, engine="h5netcdf") as stream:
            return stream.load()
    except Exception as first:  # the libraries raise many kinds for a damaged file
        try:
            with xr.open_dataset(path, engine="scipy") as stream:  # netCDF-3
                return stream.load()
        except Exception:
            raise FormatError(
                f"{path.name}: a netCDF file expected, something else found ({type(first).__name__}: {first}). Write it again."
            ) from first


def _plain(value: Any) -> Any:
    """Return an attribute as it was before writing: numpy scalars and arrays become plain numbers and lists."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    return value.item() if isinstance(value, np.generic) else value
