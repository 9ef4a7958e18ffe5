"""Spectra of wind gusts along the mean wind, all of one form with closed integrals: NPD, API, Davenport, Harris."""

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError

Array = NDArray[np.float64]

_N = 0.468  # of the NPD spectrum


@dataclass(frozen=True)
class GustSpectrum:
    """One-sided spectrum of the gust speed, 2 pi S(omega) = level x^a / (b + x^p)^q with x = time omega / (2 pi).

    Made by :func:`npd_gust`, :func:`api_gust`, :func:`davenport_gust`, :func:`harris_gust`.

    Parameters
    ----------
    name : str
    level : float
        (m/s)2/Hz, > 0.
    time : float
        s, > 0: the inverse of the frequency of the corner, Hz.
    rise, offset, power, fall : float
        a >= 0, b > 0, p > 0 and q > (a + 1)/p, so that the variance is finite.

    Raises
    ------
    InputError
        A parameter outside these bounds.

    Examples
    --------
    >>> spectrum = npd_gust(20.0)
    >>> round(spectrum.deviation, 3), round(float(spectrum.variance(0.01, 3.0) / spectrum.variance()), 3)
    (2.664, 0.733)
    """

    name: str
    level: float
    time: float
    rise: float
    offset: float
    power: float
    fall: float

    def __post_init__(self) -> None:
        for name in ("level", "time", "offset", "power"):
            positive(getattr(self, name), f"{self.name} gust spectrum: {name}")
        if not (self.rise >= 0.0 and np.isfinite(self.fall) and self.power * self.fall > self.rise + 1.0):
            raise InputError(
                f"{self.name} gust spectrum: rise >= 0 and power * fall > rise + 1 expected (finite variance), "
                f"rise {self.rise!r}, power {self.power!r}, fall {self.fall!r} found."
            )

    def __call__(self, omega: ArrayLike) -> Array:
        """Return S(omega) at frequencies >= 0 in rad/s, (m/s)2 s/rad."""
        w = np.asarray(omega, dtype=float)
        if not np.all(w >= 0.0):
            raise InputError("omega: frequencies >= 0 in rad/s expected, negative ones or NaN found.")
        x = self.time * w / (2.0 * pi)
        return self.level / (2.0 * pi) * x**self.rise / (self.offset + x**self.power) ** self.fall

    def variance(self, low: ArrayLike = 0.0, high: ArrayLike = np.inf) -> Array:
        """Return the variance between two frequencies (rad/s), (m/s)2.

        Notes
        -----
        With h = (a + 1)/p, the integral of x^a / (b + x^p)^q from 0 is b^(h - q) B(h, q - h) I(h, q - h; u) / p with
        u = x^p / (b + x^p), B the beta function and I the regularised incomplete one.
        """
        from scipy.special import beta

        h = (self.rise + 1.0) / self.power
        whole = self.level / self.time * self.offset ** (h - self.fall) * beta(h, self.fall - h) / self.power
        return whole * (self._above(low, h) - self._above(high, h))

    @property
    def deviation(self) -> float:
        """Standard deviation of the gust speed, m/s."""
        return float(np.sqrt(self.variance()))

    def _above(self, omega: ArrayLike, h: float) -> Array:
        """Return the share of the variance above a frequency, 1 - I(h, q - h; u) = I(q - h, h; 1 - u), without cancellation."""
        from scipy.special import betainc

        x = self.time * np.asarray(omega, dtype=float) / (2.0 * pi)
        if not np.all(x >= 0.0):
            raise InputError("omega: frequencies >= 0 in rad/s expected, negative ones or NaN found.")
        with np.errstate(divide="ignore", over="ignore"):
            ratio = x**self.power / self.offset
            u, rest = 1.0 / (1.0 + 1.0 / ratio), 1.0 / (1.0 + ratio)
        return np.where(u < 0.5, 1.0 - betainc(h, self.fall - h, u), betainc(self.fall - h, h, rest))


def npd_gust(speed: float, *, height: float = 10.0) -> GustSpectrum:
    """Return the NPD (Froya) spectrum of ISO 19901-1, NORSOK N-003 and API RP 2A.

    Parameters
    ----------
    speed : float
        One hour mean speed at 10 m, m/s.
    height : float
        z, m.

    Notes
    -----
    S(f) = 320 (U/10)^2 (z/10)^0.45 / (1 + F^n)^(5/(3 n)), F = 172 f (z/10)^(2/3) (U/10)^(-3/4), n = 0.468; for
    0.00167 Hz <= f <= 0.5 Hz.

    References
    ----------
    ISO 19901-1 (2005), A.7.4; API RP 2A-WSD (2000), 2.3.2.

    Examples
    --------
    >>> round(float(npd_gust(10.0)(0.0)) * 2 * pi, 6)  # at f = 0, (m/s)2/Hz
    320.0
    """
    U, z = positive(speed, "npd_gust: speed") / 10.0, positive(height, "npd_gust: height") / 10.0
    level, time = 320.0 * U**2 * z**0.45, 172.0 * z ** (2.0 / 3.0) * U**-0.75
    return GustSpectrum("NPD", level, time, rise=0.0, offset=1.0, power=_N, fall=5.0 / (3.0 * _N))


def api_gust(speed: float, *, height: float = 10.0, peak: float = 0.025) -> GustSpectrum:
    """Return the API spectrum of the earlier API RP 2A.

    Parameters
    ----------
    speed : float
        One hour mean speed at the height z, m/s.
    height : float
        z, m.
    peak : float
        f_p z / U, 0.01 to 0.1.

    Notes
    -----
    S(f) = s^2/f_p / (1 + 1.5 f/f_p)^(5/3), whose integral is s^2; s = 0.15 U (z/20 m)^-0.125 up to 20 m and
    0.15 U (z/20 m)^-0.275 above.

    References
    ----------
    API RP 2A (1993, 20th edition), 2.3.2.

    Examples
    --------
    >>> round(api_gust(20.0, height=20.0).deviation, 6)
    3.0
    """
    U, z = positive(speed, "api_gust: speed"), positive(height, "api_gust: height")
    f_p = positive(peak, "api_gust: peak") * U / z
    s = 0.15 * U * (z / 20.0) ** (-0.125 if z <= 20.0 else -0.275)
    return GustSpectrum("API", s**2 / f_p, 1.5 / f_p, rise=0.0, offset=1.0, power=1.0, fall=5.0 / 3.0)


def davenport_gust(speed: float, *, drag: float, length: float = 1200.0) -> GustSpectrum:
    """Return the Davenport spectrum, which does not depend on the height.

    Parameters
    ----------
    speed : float
        Mean speed at 10 m, m/s.
    drag : float
        Surface drag coefficient kappa, referred to the speed at 10 m.
    length : float
        Length scale L, m.

    Notes
    -----
    f S(f) = 4 kappa U^2 X^2 / (1 + X^2)^(4/3), X = f L/U; its integral is 6 kappa U^2.

    References
    ----------
    Davenport (1961), Quarterly Journal of the Royal Meteorological Society 87, 194-211.

    Examples
    --------
    >>> round(float(davenport_gust(20.0, drag=0.002).variance()) / (0.002 * 20.0**2), 6)
    6.0
    """
    U, L = positive(speed, "davenport_gust: speed"), positive(length, "davenport_gust: length")
    level = 4.0 * positive(drag, "davenport_gust: drag") * L * U
    return GustSpectrum("Davenport", level, L / U, rise=1.0, offset=1.0, power=2.0, fall=4.0 / 3.0)


def harris_gust(speed: float, *, drag: float, length: float = 1800.0) -> GustSpectrum:
    """Return the Harris spectrum, which does not depend on the height.

    Parameters
    ----------
    speed, drag, length : float
        As in :func:`davenport_gust`.

    Notes
    -----
    S(f) = 4 kappa L U / (2 + X^2)^(5/6), X = f L/U; its integral is 6.68 kappa U^2.

    References
    ----------
    Harris (1971), The nature of wind, CIRIA.

    Examples
    --------
    >>> round(float(harris_gust(20.0, drag=0.002).variance()) / (0.002 * 20.0**2), 2)
    6.68
    """
    U, L = positive(speed, "harris_gust: speed"), positive(length, "harris_gust: length")
    level = 4.0 * positive(drag, "harris_gust: drag") * L * U
    return GustSpectrum("Harris", level, L / U, rise=0.0, offset=2.0, power=2.0, fall=5.0 / 6.0)


def positive(value: float, what: str) -> float:
    """Return a positive finite number or raise :class:`InputError` that names it."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.number) or not (np.isfinite(value) and value > 0.0):
        raise InputError(f"{what}: a positive finite number expected, {value!r} found.")
    return float(value)
