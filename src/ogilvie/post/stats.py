"""Statistics of time series, each with its confidence interval."""

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.post.cycles import Cycles, cycles
from ogilvie.post.extremes import ExtremeFit, fit_gumbel, fit_rayleigh, fit_weibull
from ogilvie.post.series import as_series, time_step
from ogilvie.post.spectral import spectral_density

__all__ = [
    "Cycles",
    "ExtremeFit",
    "cycles",
    "fit_gumbel",
    "fit_rayleigh",
    "fit_weibull",
    "spectral_density",
    "summary",
]

Array = NDArray[np.float64]

_MANY = 10  # realisations from which on their scatter gives the intervals
_BIAS = 12.0  # of the number of independent samples


def summary(
    data: xr.Dataset | xr.DataArray | ArrayLike,
    *,
    dt: float | None = None,
    skip: float = 0.0,
    variable: str = "eta",
    confidence: float = 0.95,
) -> xr.Dataset:
    """Return mean, standard deviation, heights, periods and maxima of a series, with confidence intervals.

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
    confidence : float
        Of the intervals.

    Returns
    -------
    xarray.Dataset
        Over what dimensions remain (dof): ``mean``, ``std``, ``significant`` (double amplitude 4 std), ``significant_third``
        (mean of the highest third of double amplitudes), ``maximum``, ``minimum`` (of all realisations), ``expected_maximum``
        (mean of the largest excursion above the mean), ``most_probable_maximum`` (above the mean, Rayleigh), ``tz`` (s),
        ``cycles`` (in all), ``independent_samples``; with a dimension bound ("low", "high") ``mean_interval``,
        ``std_interval``, ``significant_interval``, ``expected_maximum_interval``. attrs: duration of a realisation (s),
        realisations, confidence.

    Raises
    ------
    InputError

    Notes
    -----
    From 10 realisations on, intervals follow from their scatter (Student's t). With fewer, from the records themselves: with
    p_k the power of harmonic k, the variance of a Gaussian series has n = 4 (sum p)^2 / sum p^2 - 12 degrees of freedom (12 is
    the bias of the ratio, found by trial) and its interval is chi-squared; the variance of the mean is S(0)/T with the density
    averaged over the lowest n/20 harmonics. In trials with Gaussian series of known spectrum the 95 % interval of std held the
    truth in 93 to 96 % of 20-minute wave records, in 96 % of 1-hour records of a slow motion (100 s, 5 % damping), and in 90 %
    of 1-hour records of both together. The most probable maximum is std sqrt(2 ln N) for N cycles of one realisation; an
    interval of the expected maximum takes 10 realisations.

    References
    ----------
    Priestley (1981), Spectral Analysis and Time Series, 5.3, 6.2; Longuet-Higgins (1952), J. Marine Research 11, 245-266.

    Examples
    --------
    >>> t = np.arange(0, 1200, 0.25)
    >>> result = summary(0.3 + np.sqrt(2) * np.cos(0.8 * t), dt=0.25)
    >>> round(float(result["mean"]), 2), round(float(result["std"]), 2), round(float(result.tz), 2)
    (0.3, 1.0, 7.85)
    """
    if not 0.0 < confidence < 1.0:
        raise InputError(f"confidence: a number between 0 and 1 expected, {confidence!r} found.")
    series = as_series(data, dt=dt, skip=skip, variable=variable)
    step, lead = time_step(series), series.dims[:-2]
    rows = series.values.reshape(-1, *series.shape[-2:])
    results = [_statistics(row, step, confidence) for row in rows]
    shape = tuple(series.sizes[d] for d in lead)
    variables: dict[str, tuple[tuple[str, ...], Array]] = {}
    for key in results[0]:
        values = np.array([result[key] for result in results])
        bound = ("bound",) if values.ndim == 2 else ()
        variables[key] = ((*map(str, lead), *bound), values.reshape((*shape, *values.shape[1:])))
    coords = {k: v for k, v in series.coords.items() if set(v.dims) <= set(lead)}
    return xr.Dataset(
        variables,
        coords={**coords, "bound": ["low", "high"]},
        attrs={
            "duration": series.sizes["time"] * step,
            "realisations": series.sizes["realisation"],
            "confidence": confidence,
        },
    )


def _statistics(x: Array, dt: float, confidence: float) -> dict[str, float | Array]:
    """Return the statistics of realisations (n_r, n_t) of one quantity."""
    means = x.mean(axis=1)
    mean = float(means.mean())
    variances = np.mean((x - mean) ** 2, axis=1)
    std = float(np.sqrt(variances.mean()))
    found = [cycles(row, dt) for row in x]
    count = sum(len(c.periods) for c in found)
    span = sum(float(c.periods.sum()) for c in found)
    tz = span / count if count else float("nan")
    heights = np.sort(np.concatenate([c.double_amplitudes for c in found]))[::-1]
    third = float(heights[: count // 3].mean()) if count >= 3 else float("nan")
    per_realisation = x.shape[1] * dt / tz if count else float("nan")
    largest = (x - means[:, None]).max(axis=1)
    samples = _independent_samples(x)
    if len(x) >= _MANY:
        mean_interval = _student(means, confidence)
        std_interval = np.sqrt(np.maximum(_student(variances, confidence), 0.0))
        largest_interval = _student(largest, confidence)
    else:
        mean_interval = _mean_interval(x, mean, samples, dt, confidence)
        std_interval = _std_interval(std, samples, confidence)
        largest_interval = np.full(2, np.nan)
    return {
        "mean": mean,
        "mean_interval": mean_interval,
        "std": std,
        "std_interval": std_interval,
        "significant": 4.0 * std,
        "significant_interval": 4.0 * std_interval,
        "significant_third": third,
        "maximum": float(x.max()),
        "minimum": float(x.min()),
        "expected_maximum": float(largest.mean()),
        "expected_maximum_interval": largest_interval,
        "most_probable_maximum": std * np.sqrt(2.0 * np.log(per_realisation)) if per_realisation > 1.0 else float("nan"),
        "tz": tz,
        "cycles": float(count),
        "independent_samples": samples,
    }


def _independent_samples(x: Array) -> float:
    """Return the number of independent samples that hold as much information on the variance of a Gaussian series."""
    power = _power(x)
    total = float(power.sum())
    if total == 0.0:
        return float(x.size)
    ratio = 4.0 * total**2 / float(np.sum(power**2))
    return max(ratio - _BIAS, ratio / 3.0)


def _power(x: Array) -> Array:
    """Return the power of the harmonics k = 1, 2, ... (n_r, n_k) of each realisation."""
    return np.abs(np.fft.rfft(x - x.mean(axis=1, keepdims=True), axis=1)[:, 1:]) ** 2


def _mean_interval(x: Array, mean: float, samples: float, dt: float, confidence: float) -> Array:
    from scipy.special import stdtrit

    n_r, n_t = x.shape
    lowest = int(np.clip(round(samples / (20.0 * n_r)), 3, n_t // 4))
    density = dt / n_t * float(_power(x)[:, :lowest].mean())  # per Hz, two-sided, at zero frequency
    deviation = np.sqrt(density / (n_r * n_t * dt))
    return mean + np.array([-1.0, 1.0]) * deviation * stdtrit(2 * lowest * n_r, 0.5 + 0.5 * confidence)


def _std_interval(std: float, samples: float, confidence: float) -> Array:
    from scipy.special import chdtri

    return std * np.sqrt(samples / chdtri(samples, [0.5 - 0.5 * confidence, 0.5 + 0.5 * confidence]))


def _student(values: Array, confidence: float) -> Array:
    """Return the interval of the mean of independent values."""
    from scipy.special import stdtrit

    n = len(values)
    reach = stdtrit(n - 1, 0.5 + 0.5 * confidence) * values.std(ddof=1) / np.sqrt(n)
    return values.mean() + np.array([-1.0, 1.0]) * reach
