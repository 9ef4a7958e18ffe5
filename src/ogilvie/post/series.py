"""Time series for the statistics, from the result of a run or from plain arrays."""

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError

Array = NDArray[np.float64]


def as_series(data: xr.Dataset | xr.DataArray | ArrayLike, *, dt: float | None, skip: float, variable: str) -> xr.DataArray:
    """Return a DataArray whose last dims are (realisation, time), with equally spaced times from the end of `skip` on.

    Parameters
    ----------
    data : Dataset, DataArray or array
        The result of a run; one of its variables; or an array (n_t,) or (n_realisations, n_t).
    dt : float or None
        Time step of an array, s.
    skip : float
        Start-up to leave out, s.
    variable : str
        Which variable of a Dataset.

    Raises
    ------
    InputError
    """
    series = _from_dataset(data, variable) if isinstance(data, xr.Dataset) else data
    if not isinstance(series, xr.DataArray):
        series = _from_array(series, dt)
    elif dt is not None:
        raise InputError("dt: not expected with a DataArray or Dataset, which hold their own times.")
    if "time" not in series.dims:
        raise InputError(f"statistics: a dimension 'time' expected, dimensions {series.dims} found.")
    if "realisation" not in series.dims:
        series = series.expand_dims("realisation")
    series = series.transpose(..., "realisation", "time")
    _check_times(series.time.values)
    if not (np.isfinite(skip) and skip >= 0.0):
        raise InputError(f"skip: a time >= 0 in s expected, {skip!r} found.")
    series = series.isel(time=series.time.values >= series.time.values[0] + skip - 1e-9)
    if series.sizes["time"] < 16:
        raise InputError(f"statistics: at least 16 times expected, {series.sizes['time']} left after skip = {skip:g} s.")
    bad = int((~np.isfinite(series.values)).sum())
    if bad:
        raise InputError(f"statistics: finite numbers expected, {bad} NaN or infinite found.")
    return series.astype(float)


def time_step(series: xr.DataArray) -> float:
    """Return the step between times, s."""
    t = series.time.values
    return float(t[-1] - t[0]) / (len(t) - 1)


def _from_dataset(data: xr.Dataset, variable: str) -> xr.DataArray:
    if variable not in data:
        raise InputError(f"variable: one of {', '.join(map(str, data.data_vars))} expected, {variable!r} found.")
    return data[variable]


def _from_array(data: ArrayLike, dt: float | None) -> xr.DataArray:
    values = np.asarray(data, dtype=float)
    if values.ndim not in (1, 2):
        raise InputError(f"statistics: an array (n_t,) or (n_realisations, n_t) expected, shape {values.shape} found.")
    if dt is None or not (np.isfinite(dt) and dt > 0.0):
        raise InputError(f"dt: the time step in s, > 0, expected with an array, {dt!r} found.")
    dims = ("time",) if values.ndim == 1 else ("realisation", "time")
    return xr.DataArray(values, dims=dims, coords={"time": dt * np.arange(values.shape[-1])})


def _check_times(t: Array) -> None:
    if t.ndim != 1 or len(t) < 2 or not np.all(np.isfinite(t)):
        raise InputError("statistics: at least two finite times expected.")
    steps = np.diff(t)
    if not np.all(steps > 0.0) or np.ptp(steps) > 1e-3 * steps.mean():
        raise InputError(f"time: equal steps expected, steps from {steps.min():.6g} to {steps.max():.6g} s found.")
