"""Wave spectra as data: a sum of peaks or a table, with exact moments, cumulative variance and quantiles."""

from dataclasses import dataclass, field
from functools import cached_property
from math import gamma as gamma_function
from math import inf, log, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError

Array = NDArray[np.float64]

_X, _W = np.polynomial.legendre.leggauss(16)
_PEAK_EDGES = np.arange(-9.0, 9.5, 1.0)  # in widths sigma about the peak; gamma^exp(-u^2/2) - 1 is below 1e-16 outside
_TAIL_END = 1e6  # of the peak frequency


@dataclass(frozen=True)
class Peak:
    """One peak: S ~ r^-N exp(-(N/M) r^-M) gamma^exp(-(r - 1)^2 / (2 sigma^2)), r = omega/omega_p, scaled to variance hs^2/16.

    N = 5, M = 4 is JONSWAP (gamma = 1: Bretschneider); N = 4 lambda + 1, M = 4 is Ochi-Hubble; Torsethaugen has its own N, M.

    Parameters
    ----------
    hs : float
        Significant wave height of this peak, m.
    tp : float
        Peak period, s.
    gamma : float
        Peak enhancement.
    tail : float
        N > 1; S falls as omega^-N.
    width : float
        M > 0; the smaller the wider.
    sigma : (float, float)
        Width of the enhancement below and above the peak.
    """

    hs: float
    tp: float
    gamma: float = 1.0
    tail: float = 5.0
    width: float = 4.0
    sigma: tuple[float, float] = (0.07, 0.09)

    def density(self, omega: Array) -> Array:
        """Return S, m2 s/rad."""
        wp = 2.0 * pi / self.tp
        return self.hs**2 / (16.0 * wp * self.shape_moment(0)) * self._shape(omega / wp)

    def moment(self, n: float) -> float:
        """Return the integral of omega^n S over all frequencies; infinite for n >= N - 1."""
        return self.hs**2 / 16.0 * (2.0 * pi / self.tp) ** n * self.shape_moment(n) / self.shape_moment(0)

    def shape_moment(self, n: float) -> float:
        """Return the integral of r^n times the shape: a gamma function, and quadrature of what the enhancement adds."""
        N, M = self.tail, self.width
        p = (N - 1.0 - n) / M
        if p <= 0.0:
            return inf
        total = (N / M) ** -p * gamma_function(p) / M
        if self.gamma != 1.0:
            edges = 1.0 + _PEAK_EDGES * np.where(_PEAK_EDGES < 0.0, *self.sigma)
            r, w = _nodes(np.unique(np.maximum(edges, 1e-3)))
            total += float(np.sum(w * r**n * (self._shape(r) - self._base(r))))
        return total

    @property
    def breakpoints(self) -> Array:
        """Frequencies between which 16-point quadrature is exact to rounding; the first and last enclose all of S."""
        N, M = self.tail, self.width
        first = (N / M / 70.0) ** (1.0 / M)  # exp(-70)
        peak = 1.0 + _PEAK_EDGES * np.where(_PEAK_EDGES < 0.0, *self.sigma)
        below = np.geomspace(first, 1.0, 16)
        above = np.geomspace(1.0, _TAIL_END, 36)
        return 2.0 * pi / self.tp * np.unique(np.r_[below, peak[peak > first], above])

    def _base(self, r: Array) -> Array:
        safe = np.where(r > 0.0, r, 1.0)
        N, M = self.tail, self.width
        with np.errstate(over="ignore"):
            return np.where(r > 0.0, np.exp(-N * np.log(safe) - N / M * safe**-M), 0.0)

    def _shape(self, r: Array) -> Array:
        sigma = np.where(r <= 1.0, *self.sigma)
        return self._base(r) * np.exp(log(self.gamma) * np.exp(-0.5 * ((r - 1.0) / sigma) ** 2))


@dataclass(frozen=True, eq=False)
class Table:
    """A tabulated spectrum, linear between its points and zero outside."""

    omega: Array
    values: Array

    def density(self, omega: Array) -> Array:
        """Return S, m2 s/rad."""
        return np.interp(omega, self.omega, self.values, left=0.0, right=0.0)

    def moment(self, n: float) -> float:
        """Return the integral of omega^n S over the table (exact for whole n >= 0)."""
        w, dw = _nodes(self.omega)
        return float(np.sum(dw * w**n * self.density(w)))

    @property
    def breakpoints(self) -> Array:
        """The points of the table."""
        return self.omega


@dataclass(frozen=True, eq=False)
class Spectrum:
    """A one-sided wave spectrum S(omega), m2 s/rad, called like a function; spectra add with ``+``.

    Parameters
    ----------
    parts : tuple of Peak or Table
        What is summed.
    name : str
        For labels and printing.

    Examples
    --------
    >>> from ogilvie.waves.spectra import bretschneider
    >>> sea = bretschneider(hs=4.0, tp=10.0) + bretschneider(hs=3.0, tp=15.0)
    >>> round(sea.hs, 12), round(sea.tp, 2)
    (5.0, 10.69)
    """

    parts: tuple[Peak | Table, ...]
    name: str = field(default="spectrum")

    def __call__(self, omega: ArrayLike) -> Array:
        """Return S at the frequencies omega >= 0 (rad/s), m2 s/rad."""
        w = np.asarray(omega, dtype=float)
        if not np.all(w >= 0.0):
            raise InputError("omega: frequencies >= 0 in rad/s expected, negative or NaN found; the spectrum is one-sided.")
        return sum((part.density(w) for part in self.parts), start=np.zeros_like(w))

    def __add__(self, other: "Spectrum") -> "Spectrum":
        if not isinstance(other, Spectrum):
            return NotImplemented
        return Spectrum(self.parts + other.parts, f"{self.name} + {other.name}")

    def __repr__(self) -> str:
        return f"Spectrum({self.name}: hs {self.hs:.4g} m, tp {self.tp:.4g} s)"

    def moment(self, n: float, *, omega_range: tuple[float, float] | None = None) -> float:
        """Return m_n, the integral of omega^n S, m2 (rad/s)^n.

        Parameters
        ----------
        n : float
            Order. With a tail omega^-5 the moment of order 4 is infinite over all frequencies: give a range.
        omega_range : (float, float), optional
            Limits of the integral, rad/s; all frequencies by default.
        """
        if omega_range is None:
            return sum(part.moment(n) for part in self.parts)
        first, last = omega_range
        if not 0.0 <= first < last:
            raise InputError(f"omega_range: two frequencies 0 <= first < last in rad/s expected, {omega_range!r} found.")
        inside = self._edges[(self._edges > first) & (self._edges < last)]
        w, dw = _nodes(np.r_[first, inside, last])
        return float(np.sum(dw * w**n * self(w)))

    @property
    def m0(self) -> float:
        """Variance of the elevation, m2."""
        return self.moment(0)

    @property
    def m1(self) -> float:
        """First moment, m2 rad/s."""
        return self.moment(1)

    @property
    def m2(self) -> float:
        """Second moment, m2 (rad/s)^2."""
        return self.moment(2)

    @property
    def m4(self) -> float:
        """Fourth moment, m2 (rad/s)^4; infinite for the tail omega^-5 (use ``moment(4, omega_range=...)``)."""
        return self.moment(4)

    @property
    def hs(self) -> float:
        """Significant wave height 4 sqrt(m0), m."""
        return 4.0 * sqrt(self.m0)

    @cached_property
    def tp(self) -> float:
        """Peak period 2 pi / (frequency of the largest S), s."""
        if len(self.parts) == 1 and isinstance(self.parts[0], Peak):
            return self.parts[0].tp
        w = self._edges
        for _ in range(12):  # zoom on the largest value
            i = int(np.argmax(self(w)))
            w = np.linspace(w[max(i - 1, 0)], w[min(i + 1, len(w) - 1)], 41)
        return 2.0 * pi / float(w[np.argmax(self(w))])

    @property
    def t1(self) -> float:
        """Mean period 2 pi m0/m1, s."""
        return 2.0 * pi * self.m0 / self.m1

    @property
    def tz(self) -> float:
        """Mean zero-up-crossing period 2 pi sqrt(m0/m2), s; 0 where m2 is infinite (tail omega^-3 or slower)."""
        return 2.0 * pi * sqrt(self.m0 / self.m2)

    @property
    def te(self) -> float:
        """Energy period 2 pi m_-1/m0, s."""
        return 2.0 * pi * self.moment(-1) / self.m0

    def cumulative(self, omega: ArrayLike) -> Array:
        """Return the variance below the frequencies omega, m2."""
        w = np.clip(np.asarray(omega, dtype=float), self._edges[0], self._edges[-1])
        i = np.clip(np.searchsorted(self._edges, w, side="right") - 1, 0, len(self._edges) - 2)
        half = 0.5 * (w - self._edges[i])
        nodes = self._edges[i][..., None] + half[..., None] * (1.0 + _X)
        return self._cumulative_at_edges[i] + half * (self(nodes) @ _W)

    def quantile(self, fraction: ArrayLike) -> Array:
        """Return the frequencies (rad/s) below which a fraction (0..1) of the variance lies."""
        p = np.asarray(fraction, dtype=float)
        if not np.all((p >= 0.0) & (p <= 1.0)):
            raise InputError("fraction: numbers from 0 to 1 expected, others or NaN found.")
        target = p * self._cumulative_at_edges[-1]
        i = np.clip(np.searchsorted(self._cumulative_at_edges, target, side="right") - 1, 0, len(self._edges) - 2)
        low, high = self._edges[i], self._edges[i + 1]
        for _ in range(54):  # bisection to the last bit
            middle = 0.5 * (low + high)
            above = self.cumulative(middle) > target
            low, high = np.where(above, low, middle), np.where(above, middle, high)
        return 0.5 * (low + high)

    @cached_property
    def _edges(self) -> Array:
        return np.unique(np.concatenate([part.breakpoints for part in self.parts]))

    @cached_property
    def _cumulative_at_edges(self) -> Array:
        half = 0.5 * np.diff(self._edges)
        nodes = self._edges[:-1, None] + half[:, None] * (1.0 + _X)
        return np.r_[0.0, np.cumsum(half * (self(nodes) @ _W))]


def _nodes(edges: Array) -> tuple[Array, Array]:
    """Return the points and weights of 16-point Gauss-Legendre quadrature on every interval, flat."""
    half = 0.5 * np.diff(edges)
    return (edges[:-1, None] + half[:, None] * (1.0 + _X)).ravel(), (half[:, None] * _W).ravel()
