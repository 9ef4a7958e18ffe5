"""What the application writes and reads: whole files or none, and what kind of thing a file is."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ogilvie.atomic import write_whole
from ogilvie.errors import FormatError, OgilvieWarning

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.memory.retardation import Retardation
    from ogilvie.memory.statespace import StateSpace

MESH_SUFFIXES = (".gdf", ".stl", ".obj", ".msh", ".pnl", ".nemoh", ".mar")
_FORMAT = "ogilvie memory 1"


def write_bytes(path: Path, content: bytes) -> Path:
    """Write bytes, whole or not at all."""
    return write_whole(path, lambda temporary: temporary.write_bytes(content))


def write_text(path: Path, text: str) -> Path:
    """Write a text in UTF-8, whole or not at all."""
    return write_whole(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def write_result(run: "xr.Dataset", path: Path) -> Path:
    """Write the result of a simulation as netCDF-4, whole or not at all."""
    return write_whole(path, lambda temporary: run.to_netcdf(temporary, engine="h5netcdf"))


def read_result(path: Path) -> "xr.Dataset":
    """Return the result of a simulation that :func:`write_result` wrote.

    Raises
    ------
    FormatError
        Another kind of file.
    """
    run = read_set(path)
    if "eta" not in run or "time" not in run.coords:
        raise FormatError(f"{path.name}: the result of a simulation (eta over time) expected, not found. Give a result.nc.")
    return run


def read_set(path: Path) -> "xr.Dataset":
    """Return a data set that :func:`write_result` wrote, whatever it holds.

    Raises
    ------
    FormatError
        No netCDF-4.
    """
    import xarray as xr

    try:
        with xr.open_dataset(path, engine="h5netcdf") as stream:
            return stream.load()
    except FileNotFoundError:
        raise
    except Exception as error:  # the libraries raise many kinds for a damaged file
        raise FormatError(
            f"{path.name}: a netCDF file expected, something else found ({type(error).__name__}). Write it again."
        ) from error


def write_memory(path: Path, K: "Retardation", ssm: "StateSpace | None" = None) -> Path:
    """Write retardation functions, and the model identified from them, to one NumPy archive, whole or not at all."""
    import numpy as np

    data = {"format": np.array(_FORMAT), **_packed("K", K), **({} if ssm is None else _packed("ssm", ssm))}
    return write_whole(path, lambda temporary: _savez(temporary, data))


def _packed(prefix: str, value: Any) -> dict[str, Any]:
    """The fields of a dataclass that are set, as arrays."""
    import numpy as np

    given = {f.name: getattr(value, f.name) for f in fields(value)}
    return {
        f"{prefix}.{key}": np.asarray(x, dtype=str if isinstance(x, tuple) else None)
        for key, x in given.items()
        if x is not None
    }


def _unpacked(kind: Any, prefix: str, data: dict[str, Any]) -> Any:
    """The dataclass of :func:`_packed`."""
    values = {}
    for f in fields(kind):
        x = data.get(f"{prefix}.{f.name}")
        if x is not None:
            values[f.name] = tuple(map(str, x)) if x.dtype.kind == "U" and x.ndim else x.item() if x.ndim == 0 else x
    return kind(**values)


def _savez(path: Path, data: dict[str, Any]) -> None:
    import numpy as np

    with path.open("wb") as stream:
        np.savez_compressed(stream, **data)


def read_memory(path: Path) -> "tuple[Retardation, StateSpace | None]":
    """Return what :func:`write_memory` wrote.

    Raises
    ------
    FormatError
        Another kind of file, or a damaged one.
    """
    import numpy as np

    from ogilvie.memory.retardation import Retardation
    from ogilvie.memory.statespace import StateSpace

    try:
        with np.load(path, allow_pickle=False) as archive:
            data = {key: archive[key] for key in archive.files}
        if str(data["format"]) != _FORMAT:
            raise KeyError("format")
        return _unpacked(Retardation, "K", data), _unpacked(StateSpace, "ssm", data) if "ssm.A" in data else None
    except FileNotFoundError:
        raise
    except Exception as error:  # zip, numpy and type errors of a damaged archive
        raise FormatError(
            f"{path.name}: a file of `ogilvie identify` expected, another found ({type(error).__name__}). Write it again."
        ) from error


def kind_of(path: Path) -> str:
    """Return what a file is: case, mesh, memory, result, drift or coefficients.

    Raises
    ------
    FileNotFoundError
        Neither such a file or folder, nor files with this stem.
    """
    if not path.name:
        raise IsADirectoryError(21, "Is a directory", str(path))
    suffix = path.suffix.lower()
    if not path.exists() and not list(path.parent.glob(path.name + ".*")):
        raise FileNotFoundError(2, "No such file", str(path))
    if path.is_file() and path.stat().st_size == 0:
        raise FormatError(f"{path.name}: a file with content expected, an empty one found. Write or copy it again.")
    if suffix == ".toml":
        return "case"
    if suffix == ".npz":
        return "memory"
    if suffix in MESH_SUFFIXES or (suffix == ".dat" and path.is_file()):
        return "mesh"
    names = _variables(path) if suffix in (".nc", ".nc4", ".cdf") else set()
    if {"eta", "time"} <= names:
        return "result"
    return "drift" if "mean_drift" in names and "added_mass" not in names else "coefficients"


def _variables(path: Path) -> set[str]:
    """Return the names of what a netCDF-4 file holds; none of another kind of file, of which its reader says more."""
    import h5netcdf

    try:
        with h5netcdf.File(path, "r") as stream:
            return set(stream.variables)
    except OSError:
        return set()


@contextmanager
def collected_warnings(into: list[str]) -> Iterator[None]:
    """Collect the package's own warnings as sentences; all others pass through."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("default")
        warnings.simplefilter("always", OgilvieWarning)
        try:
            yield
        finally:
            seen = [w for w in caught if issubclass(w.category, OgilvieWarning)]
            into += [text for text in dict.fromkeys(str(w.message) for w in seen) if text not in into]
    for other in caught:
        if not issubclass(other.category, OgilvieWarning):
            warnings.warn_explicit(other.message, other.category, other.filename, other.lineno)
