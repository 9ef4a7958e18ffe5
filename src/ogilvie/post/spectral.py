"""Spectra of time series by Welch's method."""

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ogilvie.errors import InputError
from ogilvie.post.series import as_series, time_step

_OVERLAP = 1.0 / 36.0  # squared correlation of the periodograms of Hann windows that overlap by half


def spectral_density(
    data: xr.Dataset | xr.DataArray | ArrayLike,
    *,
    dt: float | None = None,
    skip: float = 0.0,
    variable: str = "eta",
    segment: float | None = None,
    confidence: float = 0.95,
) -> xr.Dataset:
    """Return the one-sided spectrum of a series over omega, averaged over segments and realisations.

    Parameters
    ----------
    data : Dataset, DataArray or array
        The result of a run, one of its variables, or an array (n_t,) or (n_realisations, n_t) with `dt`.
    dt : float, optional
        Time step of an array, s.
    skip : float
        Start-up to leave out, s.
    variable : str
        Which variable of a Dataset.
    segment : float, optional
        Length of the segments, s; an eighth of the record by default. Resolution is about 9/segment rad/s.
    confidence : float
        Of the interval.

    Returns
    -------
    xarray.Dataset
        ``density`` (..., omega), unit^2 s/rad; ``interval`` (..., omega, bound), bound "low" and "high"; attrs ``dof``.

    Raises
    ------
    InputError

    Notes
    -----
    Hann windows that overlap by half, the mean of each segment taken off. With n segments and realisations the density is
    chi-squared with 2 n/(1 + 2/36) degrees of freedom.

    References
    ----------
    Welch (1967), IEEE Trans. Audio Electroacoust. 15, 70-73.

    Examples
    --------
    >>> t = np.arange(0, 4000, 0.5)
    >>> S = spectral_density(np.cos(0.8 * t), dt=0.5)
    >>> round(float(S.density.integrate("omega")), 3), round(float(S.omega[S.density.values.argmax()]), 2)
    (0.5, 0.8)
    """
    from scipy.special import chdtri

    series = as_series(data, dt=dt, skip=skip, variable=variable)
    step, n_t = time_step(series), series.sizes["time"]
    length = round((n_t * step / 8.0 if segment is None else segment) / step)
    if not 8 <= length <= n_t:
        raise InputError(f"segment: a time from {8 * step:.4g} to {n_t * step:.4g} s expected, {length * step:.4g} s found.")
    begins = np.arange(0, n_t - length + 1, max(length // 2, 1))
    window = 0.5 * (1.0 - np.cos(2.0 * np.pi * np.arange(length) / length))
    scale = 2.0 * step / (2.0 * np.pi * np.sum(window**2))
    power = np.zeros((*series.shape[:-1], length // 2 + 1))
    for begin in begins:
        piece = series.values[..., begin : begin + length]
        power += np.abs(np.fft.rfft((piece - piece.mean(axis=-1, keepdims=True)) * window, axis=-1)) ** 2
    power *= scale / len(begins)
    power[..., 0] *= 0.5
    if length % 2 == 0:
        power[..., -1] *= 0.5
    density = xr.DataArray(
        power,
        dims=(*series.dims[:-1], "omega"),
        coords={
            **{k: v for k, v in series.coords.items() if "time" not in v.dims},
            "omega": 2.0 * np.pi * np.fft.rfftfreq(length, step),
        },
    ).mean("realisation")
    count = len(begins) * series.sizes["realisation"]
    dof = 2.0 * count / (1.0 + (2.0 * _OVERLAP if len(begins) > 1 else 0.0))
    low, high = dof / chdtri(dof, [0.5 - 0.5 * confidence, 0.5 + 0.5 * confidence])
    factors = xr.DataArray([low, high], dims="bound", coords={"bound": ["low", "high"]})
    return xr.Dataset({"density": density, "interval": density * factors}, attrs={"dof": dof, "confidence": confidence})
