"""Extremes: distributions fitted to peaks and maxima, with confidence intervals of their quantiles."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import ConvergenceError, InputError

Array = NDArray[np.float64]
Kind = Literal["rayleigh", "weibull", "gumbel"]

_EULER = 0.5772156649015329
# n times the asymptotic covariance of location and scale of a Gumbel distribution, in units of the scale squared
_VAR_LOCATION = 1.0 + 6.0 * (1.0 - _EULER) ** 2 / np.pi**2
_VAR_SCALE = 6.0 / np.pi**2
_COVARIANCE = 6.0 * (1.0 - _EULER) / np.pi**2


@dataclass(frozen=True)
class ExtremeFit:
    """A distribution fitted by maximum likelihood.

    Parameters
    ----------
    kind : {"rayleigh", "weibull", "gumbel"}
    scale : float
        Unit of the data: F = 1 - exp(-x^2 / (2 scale^2)), 1 - exp(-(x/scale)^shape), exp(-exp(-(x - location)/scale)).
    shape : float
        Of the Weibull distribution; 2 for Rayleigh, NaN for Gumbel.
    location : float
        Of the Gumbel distribution; 0 else.
    count : int
        Number of values that were fitted.
    """

    kind: Kind
    scale: float
    shape: float
    location: float
    count: int

    def quantile(self, probability: ArrayLike) -> Array:
        """Return the value that is not exceeded with this probability."""
        p = _probability(probability)
        if self.kind == "gumbel":
            return self.location - self.scale * np.log(-np.log(p))
        exponent = -np.log1p(-p)
        return self.scale * (np.sqrt(2.0 * exponent) if self.kind == "rayleigh" else exponent ** (1.0 / self.shape))

    def interval(self, probability: ArrayLike, *, confidence: float = 0.95) -> Array:
        """Return the confidence interval (..., 2) of a quantile.

        Notes
        -----
        Rayleigh: exact, from the chi-squared distribution of sum x^2 / scale^2. Gumbel, and Weibull in the logarithm: normal,
        by the delta method with the Fisher information.
        """
        from scipy.stats import chi2, norm

        p = _probability(probability)
        if self.kind == "rayleigh":
            factor = np.sqrt(2.0 * self.count / chi2.ppf([0.5 + 0.5 * confidence, 0.5 - 0.5 * confidence], 2 * self.count))
            return self.quantile(p)[..., None] * factor
        reach = np.array([-1.0, 1.0]) * norm.ppf(0.5 + 0.5 * confidence)
        if self.kind == "gumbel":
            y = -np.log(-np.log(p))
            return self.quantile(p)[..., None] + reach * (self.scale * _deviation(y, self.count))[..., None]
        y = np.log(-np.log1p(-p))  # ln x = ln scale + y/shape: -ln x is Gumbel with scale 1/shape, and -y its reduced variate
        return self.quantile(p)[..., None] * np.exp(reach * (_deviation(-y, self.count) / self.shape)[..., None])

    def maximum_of(self, n: float, *, confidence: float = 0.95) -> tuple[float, float, float]:
        """Return the value exceeded once in n on average, and its interval: the most probable largest of n peaks or maxima."""
        if not (np.isfinite(n) and n > 1.0):
            raise InputError(f"n: a number of peaks > 1 expected, {n!r} found.")
        low, high = self.interval(1.0 - 1.0 / n, confidence=confidence)
        return float(self.quantile(1.0 - 1.0 / n)), float(low), float(high)


def fit_rayleigh(peaks: ArrayLike) -> ExtremeFit:
    """Fit a Rayleigh distribution to peaks above the mean (narrow-banded Gaussian motion: scale = standard deviation).

    Parameters
    ----------
    peaks : (n,) array
        > 0.

    Returns
    -------
    ExtremeFit

    Examples
    --------
    >>> fit_rayleigh([1.0, 1.0, 2.0]).scale
    1.0
    """
    x = _positive(peaks, least=2)
    return ExtremeFit("rayleigh", float(np.sqrt(0.5 * np.mean(x**2))), 2.0, 0.0, len(x))


def fit_weibull(peaks: ArrayLike) -> ExtremeFit:
    """Fit a two-parameter Weibull distribution to peaks above the mean.

    Parameters
    ----------
    peaks : (n,) array
        > 0, at least 5 and not all equal.

    Returns
    -------
    ExtremeFit

    Notes
    -----
    Maximum likelihood: sum x^k ln x / sum x^k - 1/k = mean ln x for the shape k; scale^k = mean x^k.

    Examples
    --------
    >>> u = (np.arange(1000) + 0.5) / 1000
    >>> fit = fit_weibull(3.0 * (-np.log(u)) ** (1 / 1.5))
    >>> round(fit.scale, 2), round(fit.shape, 2)
    (3.0, 1.5)
    """
    x = _positive(peaks, least=5)
    top = x.max()
    logs = np.log(x / top)
    if np.ptp(logs) == 0.0:
        raise InputError("peaks: values that differ expected, all equal found.")

    def slope(k: float) -> float:
        weight = np.exp(k * logs)
        return float(np.sum(weight * logs) / np.sum(weight) - 1.0 / k - logs.mean())

    k = _root(slope, 1.0 / np.std(logs))
    return ExtremeFit("weibull", float(top * np.mean(np.exp(k * logs)) ** (1.0 / k)), k, 0.0, len(x))


def fit_gumbel(maxima: ArrayLike) -> ExtremeFit:
    """Fit a Gumbel distribution to the largest values of independent realisations of one duration.

    Parameters
    ----------
    maxima : (n,) array
        At least 5 and not all equal.

    Returns
    -------
    ExtremeFit

    Notes
    -----
    Maximum likelihood: scale = mean x - sum x w / sum w, w = exp(-x/scale); location = -scale ln mean w. The most probable
    maximum of that duration is the location.

    Examples
    --------
    >>> u = (np.arange(2000) + 0.5) / 2000
    >>> fit = fit_gumbel(10.0 - 2.0 * np.log(-np.log(u)))
    >>> round(fit.location, 2), round(fit.scale, 2)
    (10.0, 2.0)
    """
    x = np.asarray(maxima, dtype=float)
    if x.ndim != 1 or len(x) < 5 or not np.all(np.isfinite(x)) or np.ptp(x) == 0.0:
        raise InputError(f"maxima: at least 5 finite values, not all equal, expected, shape {x.shape} found.")
    z = x - x.min()

    def slope(rate: float) -> float:  # rate = 1/scale
        weight = np.exp(-rate * z)
        return float(np.sum(weight * z) / np.sum(weight) + 1.0 / rate - z.mean())

    scale = 1.0 / _root(slope, 1.28 / np.std(x))
    return ExtremeFit("gumbel", scale, float("nan"), float(x.min() - scale * np.log(np.mean(np.exp(-z / scale)))), len(x))


def _deviation(y: Array, count: int) -> Array:
    """Return the standard deviation of location + y scale, in units of the scale."""
    return np.sqrt((_VAR_LOCATION + y**2 * _VAR_SCALE + 2.0 * y * _COVARIANCE) / count)


def _root(function: Callable[[float], float], start: float) -> float:
    """Return the positive root of a monotonic function near a start."""
    from scipy.optimize import brentq

    low, high = start / 2.0, start * 2.0
    for _ in range(60):
        if function(low) * function(high) <= 0.0:
            return float(brentq(function, low, high, xtol=1e-12 * start, rtol=1e-13))
        low, high = low / 2.0, high * 2.0
    raise ConvergenceError("extremes: the likelihood has no maximum; the values are too few or too alike.")


def _positive(values: ArrayLike, *, least: int) -> Array:
    x = np.asarray(values, dtype=float)
    if x.ndim != 1 or len(x) < least or not np.all(np.isfinite(x)) or not np.all(x > 0.0):
        raise InputError(f"peaks: an array (n,) of at least {least} finite values > 0 expected, shape {x.shape} found.")
    return x


def _probability(probability: ArrayLike) -> Array:
    p = np.asarray(probability, dtype=float)
    if not np.all((p > 0.0) & (p < 1.0)):
        raise InputError("probability: numbers between 0 and 1 expected, others or NaN found.")
    return p
