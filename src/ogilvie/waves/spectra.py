"""The standard wave spectra. One-sided in omega, m2 s/rad, scaled so that Hs = 4 sqrt(m0) holds to rounding."""

import warnings
from math import exp, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.units import GRAVITY
from ogilvie.waves.double_peak import ochi_hubble, ochi_hubble_family, torsethaugen
from ogilvie.waves.spectrum import Peak, Spectrum, Table
from ogilvie.waves.spreading import Spreading, spreading

__all__ = [
    "Spectrum",
    "Spreading",
    "bretschneider",
    "jonswap",
    "ochi_hubble",
    "ochi_hubble_family",
    "pierson_moskowitz",
    "spectrum_from_table",
    "spreading",
    "torsethaugen",
]

_PM_ALPHA, _PM_BETA = 0.0081, 0.74  # Pierson and Moskowitz (1964), wind speed at 19.5 m


def jonswap(
    *,
    hs: float,
    tp: float | None = None,
    tz: float | None = None,
    t1: float | None = None,
    gamma: float | None = 3.3,
    sigma: tuple[float, float] = (0.07, 0.09),
) -> Spectrum:
    """Return the JONSWAP spectrum of a wind sea that still grows.

    Parameters
    ----------
    hs : float
        Significant wave height 4 sqrt(m0), m, > 0.
    tp, tz, t1 : float
        Peak, zero-up-crossing or mean period, s, > 0: exactly one of them.
    gamma : float or None
        Peak enhancement, usually 1 to 7; None takes it from r = tp/sqrt(hs): 5 for r <= 3.6, exp(5.75 - 1.15 r), 1 for r >= 5.
    sigma : (float, float)
        Width of the peak below and above omega_p.

    Returns
    -------
    Spectrum

    Raises
    ------
    InputError
        Hs, period or gamma not positive, or not exactly one period.

    Notes
    -----
    S = c omega^-5 exp(-1.25 (omega_p/omega)^4) gamma^exp(-(omega/omega_p - 1)^2 / (2 sigma^2)), with c from the exact integral.
    The usual c = (5/16) hs^2 omega_p^4 (1 - 0.287 ln gamma) is within 1.2 % of it for gamma 1 to 7.

    References
    ----------
    Hasselmann et al. (1973); DNV-RP-C205 (2010), 3.5.5.

    Examples
    --------
    >>> sea = jonswap(hs=4.25, tp=9.8, gamma=3.3)
    >>> round(sea.hs, 12), round(sea.tz / sea.tp, 4), round(float(sea(2 * np.pi / 9.8)), 3)
    (4.25, 0.7774, 5.458)
    """
    _check_sigma(sigma)
    if gamma is None:
        if tp is None:
            raise InputError("jonswap: gamma=None takes gamma from hs and tp, and needs tp; give tp or gamma.")
        gamma = _gamma_of_steepness(_positive(hs, "hs", "m"), _positive(tp, "tp", "s"))
    _check_gamma(gamma)
    peak = _peak("jonswap", hs, tp, tz, t1, float(gamma), sigma)
    return Spectrum((peak,), f"JONSWAP gamma {peak.gamma:.3g}")


def bretschneider(*, hs: float, tp: float | None = None, tz: float | None = None, t1: float | None = None) -> Spectrum:
    """Return the Bretschneider (ITTC, ISSC, two-parameter Pierson-Moskowitz) spectrum of a fully developed sea.

    Parameters
    ----------
    hs : float
        m, > 0.
    tp, tz, t1 : float
        s, > 0: exactly one of them.

    Returns
    -------
    Spectrum

    Notes
    -----
    S = (5/16) hs^2 omega_p^4 omega^-5 exp(-1.25 (omega_p/omega)^4); tp/tz = 1.4077, tp/t1 = 1.2957.

    References
    ----------
    Bretschneider (1959); 15th ITTC (1978).

    Examples
    --------
    >>> sea = bretschneider(hs=2.0, tp=10.0)
    >>> round(sea.tp / sea.tz, 4), round(sea.tp / sea.t1, 4)
    (1.4077, 1.2957)
    """
    return Spectrum((_peak("bretschneider", hs, tp, tz, t1, 1.0, (0.07, 0.09)),), "Bretschneider")


def pierson_moskowitz(
    *,
    wind_speed: float | None = None,
    hs: float | None = None,
    tp: float | None = None,
    tz: float | None = None,
    t1: float | None = None,
    g: float = GRAVITY,
) -> Spectrum:
    """Return the Pierson-Moskowitz spectrum: fully developed from one parameter, or with hs and a period of one's own.

    Parameters
    ----------
    wind_speed : float, optional
        At 19.5 m above the sea, m/s.
    hs : float, optional
        m.
    tp, tz, t1 : float, optional
        s. One of wind_speed, hs, tp, tz, t1 alone fixes the sea of 1964; hs with one period is :func:`bretschneider`.
    g : float
        m/s2.

    Returns
    -------
    Spectrum

    Notes
    -----
    S = alpha g^2 omega^-5 exp(-beta (g/(U omega))^4), alpha = 0.0081, beta = 0.74.

    References
    ----------
    Pierson and Moskowitz (1964), J. Geophys. Res. 69, 5181-5190.

    Examples
    --------
    >>> sea = pierson_moskowitz(wind_speed=15.0)
    >>> round(sea.hs, 2), round(sea.tp, 2)
    (4.8, 10.96)
    """
    given = {k: v for k, v in {"wind_speed": wind_speed, "hs": hs, "tp": tp, "tz": tz, "t1": t1}.items() if v is not None}
    if hs is not None and len(given) == 2 and wind_speed is None:
        return Spectrum((_peak("pierson_moskowitz", hs, tp, tz, t1, 1.0, (0.07, 0.09)),), "Pierson-Moskowitz")
    if len(given) != 1:
        raise InputError(
            "pierson_moskowitz: one of wind_speed, hs, tp, tz, t1, or hs with one period expected, "
            f"{', '.join(given) or 'nothing'} found."
        )
    key, value = next(iter(given.items()))
    value = _positive(value, key, {"wind_speed": "m/s", "hs": "m"}.get(key, "s"))
    unit = Peak(hs=1.0, tp=1.0)
    omega_p_of_unit_wind = (0.8 * _PM_BETA) ** 0.25 * g  # omega_p = this / U
    if key == "wind_speed":
        U = value
    elif key == "hs":
        U = sqrt(0.5 * value * g * sqrt(_PM_BETA / _PM_ALPHA))
    else:
        U = value / _period(unit, key) * omega_p_of_unit_wind / (2.0 * pi)
    hs = 2.0 * U**2 / g * sqrt(_PM_ALPHA / _PM_BETA)
    return Spectrum((Peak(hs=hs, tp=2.0 * pi * U / omega_p_of_unit_wind),), "Pierson-Moskowitz")


def spectrum_from_table(omega: ArrayLike, density: ArrayLike, *, name: str = "table") -> Spectrum:
    """Return a spectrum from a table, linear between its points and zero outside.

    Parameters
    ----------
    omega : (n,) array
        rad/s, ascending, >= 0. A table over f in Hz: omega = 2 pi f, S(omega) = S(f) / (2 pi).
    density : (n,) array
        One-sided, m2 s/rad, >= 0.
    name : str

    Returns
    -------
    Spectrum

    Raises
    ------
    InputError

    Examples
    --------
    >>> triangle = spectrum_from_table([0.4, 0.6, 0.8], [0.0, 5.0, 0.0])
    >>> round(triangle.m0, 12), round(triangle.hs, 6)
    (1.0, 4.0)
    """
    w, S = np.array(omega, dtype=float), np.array(density, dtype=float)
    if w.ndim != 1 or w.shape != S.shape or len(w) < 2:
        raise InputError(f"spectrum_from_table: two arrays of one length >= 2 expected, shapes {w.shape} and {S.shape} found.")
    if not (np.all(np.isfinite(w)) and w[0] >= 0.0 and np.all(np.diff(w) > 0.0)):
        raise InputError("spectrum_from_table: omega >= 0 rad/s, ascending and finite expected, found otherwise.")
    if not (np.all(np.isfinite(S)) and np.all(S >= 0.0) and S.max() > 0.0):
        raise InputError("spectrum_from_table: densities >= 0, finite and not all zero expected, found otherwise.")
    w.setflags(write=False)
    S.setflags(write=False)
    return Spectrum((Table(w, S),), name)


def _peak(
    who: str,
    hs: float,
    tp: float | None,
    tz: float | None,
    t1: float | None,
    gamma: float,
    sigma: tuple[float, float],
) -> Peak:
    """Return the peak with the one period that is given, turned into tp by the moments of the shape itself."""
    given = {k: v for k, v in {"tp": tp, "tz": tz, "t1": t1}.items() if v is not None}
    if len(given) != 1:
        raise InputError(f"{who}: exactly one of tp, tz, t1 (s) expected, {', '.join(given) or 'none'} found.")
    key, value = next(iter(given.items()))
    unit = Peak(hs=1.0, tp=1.0, gamma=gamma, sigma=sigma)
    return Peak(hs=_positive(hs, "hs", "m"), tp=_positive(value, key, "s") / _period(unit, key), gamma=gamma, sigma=sigma)


def _period(peak: Peak, key: str) -> float:
    if key == "tp":
        return peak.tp
    n = {"t1": 1, "tz": 2}[key]
    return 2.0 * pi * (peak.moment(0) / peak.moment(n)) ** (1.0 / n)


def _gamma_of_steepness(hs: float, tp: float) -> float:
    ratio = tp / sqrt(hs)
    return 5.0 if ratio <= 3.6 else 1.0 if ratio >= 5.0 else exp(5.75 - 1.15 * ratio)


def _positive(value: float, name: str, unit: str) -> float:
    number = float(value)
    if not (np.isfinite(number) and number > 0.0):
        raise InputError(f"{name}: a positive number of {unit} expected, {value!r} found.")
    return number


def _check_gamma(gamma: float) -> None:
    _positive(gamma, "gamma", "-")
    if not 1.0 <= gamma <= 7.0:
        warnings.warn(
            f"jonswap: gamma is usually 1 to 7, {gamma:.4g} found; the spectrum is made as asked.", OgilvieWarning, stacklevel=3
        )


def _check_sigma(sigma: tuple[float, float]) -> None:
    if len(sigma) != 2 or not all(0.0 < s < 0.5 for s in sigma):
        raise InputError(f"sigma: two widths between 0 and 0.5 (below and above the peak) expected, {sigma!r} found.")
