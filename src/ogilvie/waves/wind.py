"""The wind: mean speed and direction, how it grows with height, and gusts as periodic tables."""

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from math import log, pi, sqrt
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.waves.gust import GustSpectrum, api_gust, npd_gust
from ogilvie.waves.spreading import check_direction

Array = NDArray[np.float64]
Profile = Literal["npd", "power", "uniform"]

_HOUR = 3600.0
_STREAM = 1961  # keeps the phases of gusts apart from those of waves of one seed


@dataclass(frozen=True)
class Wind:
    """A wind that blows in one direction, the same everywhere at one height, with or without gusts.

    Parameters
    ----------
    speed : float
        Mean over one hour at `reference_height`, m/s, >= 0.
    direction : float
        Direction the wind blows **to**, anticlockwise from +x, rad, as that of waves; see :func:`blowing_from`.
    reference_height : float
        m above still water.
    profile : {"npd", "power", "uniform"}
        How the mean speed depends on the height.
    exponent : float
        Of the power law.
    gust : {"npd", "api"} or GustSpectrum, optional
        Spectrum of the gusts; "npd" and "api" are taken at the height where the wind acts. No gusts without.
    seed : int or sequence of int
        Of the random phases. A sequence makes as many realisations.
    period : float
        Time after which the gusts repeat themselves, s; make it as long as the simulation. Slower gusts belong to the mean.
    step : float
        Step of the table of gusts, s; it divides the period. The fastest gust has a period of 4 steps.

    Raises
    ------
    InputError
        Speed negative, direction in degrees, unknown profile or spectrum, gusts without wind, period no multiple of the step.

    Notes
    -----
    "npd": U(z) = U10 (1 + C ln(z/10 m)), C = 0.0573 sqrt(1 + 0.15 U10). "power": U(z) = U_r (z/z_r)^exponent.
    Gusts are u(t) = sum_k a_k cos(2 pi k t/period + phase_k) along the mean wind, with a_k^2/2 the variance of the spectrum in
    the band of width 1/period (Hz) around k/period.

    References
    ----------
    ISO 19901-1 (2005), A.7; NORSOK N-003; API RP 2A-WSD (2000), 2.3.2.

    Examples
    --------
    >>> wind = Wind(20.0, np.pi, gust="npd", seed=range(3))
    >>> round(wind.mean(30.0), 2), wind.gusts(10.0).shape
    (22.52, (3, 7200))
    """

    speed: float
    direction: float
    _: KW_ONLY
    reference_height: float = 10.0
    profile: Profile = "npd"
    exponent: float = 0.125
    gust: Literal["npd", "api"] | GustSpectrum | None = None
    seed: int | Sequence[int] = 0
    period: float = _HOUR
    step: float = 0.5

    def __post_init__(self) -> None:
        _number(self.speed, "speed", "m/s", zero=True)
        _number(self.exponent, "exponent", "1", zero=True)
        for name, unit in (("reference_height", "m"), ("period", "s"), ("step", "s")):
            _number(getattr(self, name), name, unit)
        if np.ndim(self.direction) != 0:
            raise InputError("wind: one direction expected, several found.")
        check_direction(self.direction)
        if self.profile not in ("npd", "power", "uniform"):
            raise InputError(f"wind: profile 'npd', 'power' or 'uniform' expected, {self.profile!r} found.")
        if not (self.gust is None or isinstance(self.gust, GustSpectrum) or self.gust in ("npd", "api")):
            raise InputError(f"wind: gust 'npd', 'api', a GustSpectrum or None expected, {self.gust!r} found.")
        if self.gust is not None and self.speed == 0.0:
            raise InputError("wind: a speed > 0 expected with gusts, 0 found; give no gust in a calm.")
        count = self.period / self.step
        if abs(count - round(count)) > 1e-9 * count or round(count) < 8:
            raise InputError(
                f"wind: a period of a whole number of steps, 8 at least, expected, {self.period!r} s and {self.step!r} s found."
            )
        object.__setattr__(self, "seed", _seeds(self.seed))
        self.mean(self.reference_height)

    @property
    def seeds(self) -> tuple[int, ...]:
        """One seed per realisation."""
        return self.seed  # type: ignore[return-value]

    @property
    def n_realisations(self) -> int:
        """Number of realisations; 1 without gusts."""
        return len(self.seeds) if self.gust is not None else 1

    @property
    def speed_10(self) -> float:
        """Mean speed at 10 m, m/s."""
        z = self.reference_height
        if self.profile != "npd" or self.speed == 0.0 or z == 10.0:
            return self.speed * self._power(10.0)
        return _solve_npd(self.speed, z)

    def mean(self, height: float) -> float:
        """Return the mean speed over one hour at a height (m above still water), m/s."""
        z = _number(height, "height", "m")
        if self.profile != "npd":
            return self.speed * self._power(z)
        U = self.speed_10
        speed = U * (1.0 + _shear(U) * log(z / 10.0))
        if speed < 0.0:
            raise InputError(f"wind: a height where the NPD profile is positive expected, {z:.4g} m found.")
        return speed

    def sustained(self, averaging: float, height: float) -> float:
        """Return the largest mean over a shorter time that is expected within the hour, m/s.

        Parameters
        ----------
        averaging : float
            t, s, at most 3600.
        height : float
            z, m.

        Notes
        -----
        U(z, t) = U(z) (1 - 0.41 I ln(t/3600 s)), I = 0.06 (1 + 0.043 U10) (z/10 m)^-0.22: of the NPD profile only.
        """
        if self.profile != "npd":
            raise InputError(f"wind: sustained speeds belong to the profile 'npd', {self.profile!r} found.")
        t = _number(averaging, "averaging", "s")
        if t > _HOUR:
            raise InputError(f"wind: averaging of at most 3600 s expected, {t:.6g} s found.")
        intensity = 0.06 * (1.0 + 0.043 * self.speed_10) * (height / 10.0) ** -0.22
        return self.mean(height) * (1.0 - 0.41 * intensity * log(t / _HOUR))

    def spectrum(self, height: float) -> GustSpectrum | None:
        """Return the spectrum of the gusts at a height (m), None without gusts."""
        z = _number(height, "height", "m")
        if self.gust == "npd":
            return npd_gust(self.speed_10, height=z)
        if self.gust == "api":
            return api_gust(self.mean(z), height=z)
        return self.gust

    def gusts(self, height: float) -> Array:
        """Return the gust speed at the times 0, step, 2 step ... of one period, (n_realisations, period/step), m/s."""
        spectrum, n = self.spectrum(height), round(self.period / self.step)
        if spectrum is None:
            return np.zeros((1, n))
        k = np.arange(1, n // 4 + 1)
        edges = 2.0 * pi / self.period * (np.r_[k, k[-1] + 1] - 0.5)
        amplitude = np.sqrt(2.0 * spectrum.variance(edges[:-1], edges[1:]))
        phase = np.stack([np.random.default_rng([_STREAM, s]).uniform(0.0, 2.0 * pi, len(k)) for s in self.seeds])
        F = np.zeros((len(phase), n // 2 + 1), dtype=complex)
        F[:, k] = 0.5 * n * amplitude * np.exp(1j * phase)
        return np.fft.irfft(F, n=n, axis=-1)

    def _power(self, height: float) -> float:
        return (height / self.reference_height) ** self.exponent if self.profile == "power" else 1.0


def blowing_from(bearing: float, *, north: float = pi / 2) -> float:
    """Return the direction (to, anticlockwise from +x, rad) of a wind that comes from a compass bearing.

    Parameters
    ----------
    bearing : float
        Where the wind comes **from**, clockwise from North, rad.
    north : float
        Direction of North, anticlockwise from +x, rad; pi/2 where +x points East, 0 where +x points North.

    Returns
    -------
    float
        In (-pi, pi].

    Examples
    --------
    >>> round(blowing_from(np.pi / 2, north=0.0) * 180 / np.pi)  # an easterly wind, x to the North: towards port, West
    90
    """
    if not np.all(np.isfinite([bearing, north])):
        raise InputError(f"blowing_from: finite angles in rad expected, {bearing!r} and {north!r} found.")
    check_direction([bearing, north])
    return float(pi - np.remainder(-(north - bearing), 2.0 * pi))


def _shear(speed_10: float) -> float:
    """Return C of the NPD profile."""
    return 0.0573 * sqrt(1.0 + 0.15 * speed_10)


def _solve_npd(speed: float, height: float) -> float:
    """Return the speed at 10 m that the NPD profile has for a speed at another height."""
    from scipy.optimize import brentq

    def excess(U: float) -> float:
        return U * (1.0 + _shear(U) * log(height / 10.0)) - speed

    top = max(speed, 1.0)
    while excess(top) < 0.0:
        top *= 1.2
        if top > 1e3 * max(speed, 1.0):
            raise InputError(f"wind: no speed at 10 m gives {speed:.4g} m/s at {height:.4g} m in the NPD profile.")
    return float(brentq(excess, 0.0, top, xtol=1e-12, rtol=1e-14))


def _seeds(seed: int | Sequence[int]) -> tuple[int, ...]:
    values = (seed,) if isinstance(seed, int | np.integer) else tuple(seed) if np.iterable(seed) else (seed,)
    whole = [isinstance(s, int | np.integer) and not isinstance(s, bool) and s >= 0 for s in values]
    if not values or not all(whole) or len(set(values)) != len(values):
        raise InputError(f"wind: seed, a whole number >= 0 or a sequence of different ones, expected, {seed!r} found.")
    return tuple(int(s) for s in values)


def _number(value: float, name: str, unit: str, *, zero: bool = False) -> float:
    real = isinstance(value, int | float | np.number) and not isinstance(value, bool) and np.isfinite(value)
    if not real or value < 0.0 or (value == 0.0 and not zero):
        raise InputError(f"wind: {name}, a finite number {'>=' if zero else '>'} 0 in {unit}, expected, {value!r} found.")
    return float(value)
