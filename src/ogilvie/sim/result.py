"""The result of a simulation as an xarray.Dataset."""

import hashlib
import platform
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.schema import DOFS

Array = NDArray[Any]
VARIABLES = ("eta", "nu", "acceleration", "elevation", "forces", "signals")

_ABOUT = {
    "eta": ("motion about the steady frame of the vessel", "m, rad"),
    "nu": ("velocity", "m/s, rad/s"),
    "acceleration": ("acceleration", "m/s2, rad/s2"),
    "elevation": ("elevation of the undisturbed sea at the steady frame's origin", "m"),
}
_ABOUT_LARGE = {
    "eta": ("pose in the world", "m, rad"),
    "nu": ("velocity in body axes", "m/s, rad/s"),
    "acceleration": ("rate of the velocity in body axes", "m/s2, rad/s2"),
    "elevation": ("elevation of the undisturbed sea at O", "m"),
}


def to_dataset(
    series: Mapping[str, Array],
    time: Array,
    *,
    batched: bool,
    seeds: Sequence[int],
    large: bool = False,
    signals: Sequence[tuple[str, str, str]] = (),
) -> xr.Dataset:
    """Return the result of a run.

    Parameters
    ----------
    series : mapping of str to array
        (r, n_t, 6), or (r, n_t) for the elevation.
    time : (n_t,) array
        s.
    batched : bool
        Whether the result has an axis of realisations.
    seeds : sequence of int
        Of the realisations, if known.
    large : bool
        Whether motions are poses in the world.
    signals : sequence of (variable, name, unit)
        Of control laws, among the series; the variable's attribute ``signal`` holds the name.
    """
    coords: dict[str, Any] = {"time": ("time", time, {"units": "s"}), "dof": list(DOFS)}
    number = len(next(iter(series.values()))) if series else 0
    if batched:
        coords["realisation"] = np.arange(number)
        if len(seeds) == number:
            coords["seed"] = ("realisation", np.asarray(seeds))
    dims = ("realisation", "time", "dof") if batched else ("time", "dof")
    data = {}
    about = _ABOUT_LARGE if large else _ABOUT
    named = {variable: (variable.replace("_", " "), unit) for variable, _, unit in signals}
    for key, values in series.items():
        long_name, units = (about | named).get(key, (f"force of {key.removeprefix('force_')} on the body", "N, N m"))
        one = values if batched else values[0]
        data[key] = (dims[: one.ndim], one, {"long_name": long_name, "units": units})
    found = xr.Dataset(data, coords=coords)
    for variable, name, _ in signals:
        if variable in found:
            found[variable].attrs["signal"] = name
    return found


def check_variables(variables: Sequence[str]) -> tuple[str, ...]:
    """Return the names of the wanted variables, or raise :class:`InputError`."""
    names = (variables,) if isinstance(variables, str) else tuple(variables)
    unknown = [v for v in names if v not in VARIABLES]
    if unknown or not names:
        raise InputError(
            f"variables: some of {', '.join(VARIABLES)} expected, {', '.join(map(repr, unknown)) or 'none'} found."
        )
    return names


def versions() -> str:
    """Return the versions of what computed the result."""
    import numba
    import scipy

    import ogilvie

    return (
        f"ogilvie {ogilvie.__version__}, Python {platform.python_version()}, numpy {np.__version__}, "
        f"scipy {scipy.__version__}, numba {numba.__version__}, xarray {xr.__version__}"
    )


def case_hash(*parts: Any) -> str:
    """Return 16 hex digits that depend on all that determines a run: numbers, arrays, strings, dataclasses of them.

    Examples
    --------
    >>> case_hash(1.0, np.zeros(3)) == case_hash(1.0, np.zeros(3)) != case_hash(1.0, np.zeros(4))
    True
    """
    digest = hashlib.sha256()
    for part in parts:
        _feed(digest, part)
    return digest.hexdigest()[:16]


def _feed(digest: Any, value: Any) -> None:
    if isinstance(value, np.ndarray):
        digest.update(f"{value.dtype.str}{value.shape}".encode() + np.ascontiguousarray(value).tobytes())
    elif is_dataclass(value) and not isinstance(value, type):
        for f in fields(value):
            if f.name.startswith("_"):
                continue
            digest.update(f.name.encode())
            _feed(digest, getattr(value, f.name))
    elif isinstance(value, (list, tuple)):
        digest.update(f"[{len(value)}".encode())
        for item in value:
            _feed(digest, item)
    elif isinstance(value, xr.Dataset):
        for key in sorted(value.variables, key=str):
            digest.update(str(key).encode())
            _feed(
                digest, np.asarray(value[key].values) if value[key].dtype.kind not in "OU" else str(value[key].values.tolist())
            )
    elif callable(value):
        digest.update(getattr(getattr(value, "func", value), "__qualname__", "").encode())
    else:
        digest.update(repr(value).encode())
