"""Cycles of a time series between zero-up-crossings."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Cycles:
    """What happens between successive up-crossings of the mean.

    Parameters
    ----------
    starts : (n,) array
        Times of the up-crossings that begin the cycles, s.
    periods, crests, troughs : (n,) array
        s; largest and smallest value of each cycle, from the mean (troughs are negative).
    """

    starts: Array
    periods: Array
    crests: Array
    troughs: Array

    @property
    def double_amplitudes(self) -> Array:
        """Crest minus the trough that follows it in the cycle."""
        return self.crests - self.troughs

    @property
    def tz(self) -> float:
        """Mean period, s; NaN without a whole cycle."""
        return float(self.periods.mean()) if len(self.periods) else float("nan")

    @property
    def significant(self) -> float:
        """Mean of the highest third of the double amplitudes (H_1/3); NaN with fewer than three cycles."""
        heights = np.sort(self.double_amplitudes)[::-1]
        count = len(heights) // 3
        return float(heights[:count].mean()) if count else float("nan")


def cycles(x: ArrayLike, dt: float, *, level: float | None = None) -> Cycles:
    """Return the cycles of a series between up-crossings of its mean (or of another level).

    Parameters
    ----------
    x : (n_t,) array
    dt : float
        s.
    level : float, optional
        The mean by default.

    Returns
    -------
    Cycles

    Examples
    --------
    >>> t = np.arange(0.0, 100.0, 0.1)
    >>> found = cycles(2.0 * np.sin(2 * np.pi * t / 8.0 - 1.0), 0.1)
    >>> len(found.periods), round(found.tz, 3), round(found.significant, 2)
    (12, 8.0, 4.0)
    """
    x = np.asarray(x, dtype=float)
    if x.ndim != 1 or len(x) < 2 or not np.all(np.isfinite(x)):
        raise InputError(f"cycles: a finite array (n_t,) expected, shape {x.shape} found (or NaN in it).")
    z = x - (x.mean() if level is None else level)
    before = np.flatnonzero((z[:-1] < 0.0) & (z[1:] >= 0.0))
    if len(before) < 2:
        empty = np.zeros(0)
        return Cycles(empty, empty, empty, empty)
    times = dt * (before + z[before] / (z[before] - z[before + 1]))
    inside = z[before[0] + 1 : before[-1] + 1]
    begins = before[:-1] - before[0]
    return Cycles(times[:-1], np.diff(times), np.maximum.reduceat(inside, begins), np.minimum.reduceat(inside, begins))
