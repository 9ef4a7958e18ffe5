"""Spectra with two peaks, wind sea and swell: Torsethaugen, and Ochi-Hubble with its eleven most probable members."""

from math import exp, gamma, pi, sqrt
from typing import Literal

import numpy as np

from ogilvie.errors import InputError
from ogilvie.units import GRAVITY
from ogilvie.waves.spectrum import Peak, Spectrum

_A10, _A1 = 0.7, 0.5  # share and decay of the wind sea
_A20, _A2, _A3 = 0.6, 0.3, 6.0  # share and decay of the swell, growth of its gamma
_LONGEST = 25.0  # s, upper limit of the peak period

#: hs1/hs, hs2/hs, omega1, its decay with hs, omega2, its decay, lambda1, lambda2, its decay (Ochi and Hubble 1976, table 2)
_OCHI_HUBBLE = (
    (0.84, 0.54, 0.70, 0.046, 1.15, 0.039, 3.00, 1.54, 0.062),  # most probable
    (0.95, 0.31, 0.70, 0.046, 1.50, 0.046, 1.35, 2.48, 0.102),
    (0.65, 0.76, 0.61, 0.039, 0.94, 0.036, 4.95, 2.48, 0.102),
    (0.84, 0.54, 0.93, 0.056, 1.50, 0.046, 3.00, 2.77, 0.112),
    (0.84, 0.54, 0.41, 0.016, 0.88, 0.026, 2.55, 1.82, 0.089),
    (0.90, 0.44, 0.81, 0.052, 1.60, 0.033, 1.80, 2.95, 0.105),
    (0.77, 0.64, 0.54, 0.039, 0.61, 0.000, 4.50, 1.95, 0.082),
    (0.73, 0.68, 0.70, 0.046, 0.99, 0.039, 6.40, 1.78, 0.069),
    (0.92, 0.39, 0.70, 0.046, 1.37, 0.039, 0.70, 1.78, 0.069),
    (0.84, 0.54, 0.74, 0.052, 1.30, 0.039, 2.65, 3.90, 0.085),
    (0.84, 0.54, 0.62, 0.039, 1.03, 0.030, 2.60, 0.53, 0.069),
)


def torsethaugen(
    *, hs: float, tp: float, model: Literal["2004", "1996"] = "2004", fetch_factor: float = 6.6, g: float = GRAVITY
) -> Spectrum:
    """Return the Torsethaugen spectrum of combined wind sea and swell, fitted to the northern North Sea.

    Parameters
    ----------
    hs : float
        Significant wave height of the whole sea, m.
    tp : float
        Peak period of the higher peak, s.
    model : {"2004", "1996"}
        Simplified model of Torsethaugen and Haver, or the full one.
    fetch_factor : float
        a_f, s m^-1/3: 6.6 for 370 km of fetch, 5.3 for 100 km.
    g : float
        m/s2.

    Returns
    -------
    Spectrum
        Two peaks (one where the share of the other is zero), the primary first; each has its exact share of hs^2.

    Raises
    ------
    InputError

    Notes
    -----
    T_f = a_f hs^(1/3) divides wind sea (tp <= T_f) from swell. Shares r_w = 0.7 + 0.3 exp(-(e_l/0.5)^2) and
    r_s = 0.6 + 0.4 exp(-(e_u/0.3)^2), e_l = (T_f - tp)/(T_f - 2 sqrt(hs)), e_u = (tp - T_f)/(25 - T_f), both limited to 0..1.
    The enhancement is never taken below 1. Fitted to hs 0.5 to 11 m and tp 3.5 to 19 s.

    References
    ----------
    Torsethaugen and Haver (2004), ISOPE 2004-JSC-193; Torsethaugen (1996), SINTEF STF22 A96204; DNV-RP-C205 (2010), appendix A.

    Examples
    --------
    >>> sea = torsethaugen(hs=3.0, tp=14.0)
    >>> [(round(p.hs, 3), round(p.tp, 2), round(p.gamma, 2)) for p in sea.parts], round(sea.hs, 12)
    ([(2.273, 14.0, 3.52), (1.958, 8.26, 1.0)], 3.0)
    """
    hs, tp = _positive(hs, "hs", "m"), _positive(tp, "tp", "s")
    if model not in ("2004", "1996"):
        raise InputError(f"model: '2004' (simplified) or '1996' (full) expected, {model!r} found.")
    tf = fetch_factor * hs ** (1.0 / 3.0)
    parts = _wind_sea(hs, tp, tf, model, g) if tp <= tf else _swell(hs, tp, tf, model, fetch_factor, g)
    return Spectrum(tuple(part for part in parts if part.hs > 0.0), f"Torsethaugen {model}")


def _wind_sea(hs: float, tp: float, tf: float, model: str, g: float) -> tuple[Peak, Peak]:
    """Peaks of a sea whose higher peak is its wind sea."""
    N, _, boost = _shape(hs, model)
    e = _limited((tf - tp) / (tf - 2.0 * sqrt(hs)) if tf > 2.0 * sqrt(hs) else float(tp < tf))
    share = _A10 + (1.0 - _A10) * exp(-((e / _A1) ** 2))
    enhancement = boost * (2.0 * pi / g * share * hs / tp**2) ** (6.0 / 7.0)
    return (
        Peak(share * hs, tp, gamma=max(enhancement, 1.0), tail=N),
        Peak(sqrt(1.0 - share**2) * hs, tf + 2.0, tail=N),
    )


def _swell(hs: float, tp: float, tf: float, model: str, fetch_factor: float, g: float) -> tuple[Peak, Peak]:
    """Peaks of a sea whose higher peak is its swell."""
    N, M, boost = _shape(hs, model)
    e = _limited((tp - tf) / (_LONGEST - tf) if tf < _LONGEST else 1.0)
    share = _A20 + (1.0 - _A20) * exp(-((e / _A2) ** 2))
    enhancement = boost * (2.0 * pi / g * hs / tf**2) ** (6.0 / 7.0) * (1.0 + _A3 * e)
    hs_wind = sqrt(max(1.0 - share**2, 0.0)) * hs
    if model == "2004":
        tp_wind = fetch_factor * hs_wind ** (1.0 / 3.0)
    else:
        s4 = max(0.01, 0.08 * (1.0 - exp(-hs / 3.0)))
        G0 = M * (N / M) ** ((N - 1.0) / M) / gamma((N - 1.0) / M)
        tp_wind = max(2.5, (G0 * hs_wind**2 / (16.0 * s4 * 0.4**N)) ** (1.0 / (N - 1.0)))
    return (
        Peak(share * hs, tp, gamma=max(enhancement, 1.0), tail=N),
        Peak(hs_wind, tp_wind, tail=N, width=M),
    )


def _shape(hs: float, model: str) -> tuple[float, float, float]:
    """Return the tail exponent N, the width M of the secondary wind sea and the factor of gamma."""
    if model == "2004":
        return 4.0, 4.0, 35.0
    return 0.5 * sqrt(hs) + 3.2, 4.0 * (1.0 - 0.7 * exp(-hs / 3.0)), 35.0 * (1.0 + 3.5 * exp(-hs))


def ochi_hubble(*, hs1: float, tp1: float, lambda1: float, hs2: float, tp2: float, lambda2: float) -> Spectrum:
    """Return the six-parameter Ochi-Hubble spectrum: a low- and a high-frequency peak, each with its own shape.

    Parameters
    ----------
    hs1, hs2 : float
        Significant wave heights of the two peaks, m; hs^2 = hs1^2 + hs2^2.
    tp1, tp2 : float
        Peak periods, s.
    lambda1, lambda2 : float
        Shape, > 0; 1 is Bretschneider, larger is narrower.

    Returns
    -------
    Spectrum

    Raises
    ------
    InputError

    Notes
    -----
    S_j = (1/4) ((4 l + 1)/4 w_p^4)^l / Gamma(l) hs_j^2 / w^(4 l + 1) exp(-((4 l + 1)/4) (w_p/w)^4), l = lambda_j.

    References
    ----------
    Ochi and Hubble (1976), On six-parameter wave spectra, Proc. 15th Coastal Engineering Conf., 301-328.

    Examples
    --------
    >>> sea = ochi_hubble(hs1=3.0, tp1=14.0, lambda1=3.0, hs2=4.0, tp2=8.0, lambda2=1.0)
    >>> round(sea.hs, 12), round(sea.tp, 2)
    (5.0, 14.0)
    """
    values = {"hs1": hs1, "tp1": tp1, "lambda1": lambda1, "hs2": hs2, "tp2": tp2, "lambda2": lambda2}
    for key, value in values.items():
        _positive(value, key, {"h": "m", "t": "s", "l": "-"}[key[0]])
    parts = tuple(Peak(hs, tp, tail=4.0 * lam + 1.0) for hs, tp, lam in ((hs1, tp1, lambda1), (hs2, tp2, lambda2)))
    return Spectrum(parts, "Ochi-Hubble")


def ochi_hubble_family(*, hs: float) -> tuple[Spectrum, ...]:
    """Return the eleven Ochi-Hubble spectra of a sea of which only hs is known: the most probable, then ten at 95 % confidence.

    Parameters
    ----------
    hs : float
        m. The published shares of hs, rounded to two digits, are scaled so that their squares sum to hs^2.

    Returns
    -------
    tuple of Spectrum
        The most probable one first. The largest and smallest responses over the family bound what the sea can do.

    References
    ----------
    Ochi and Hubble (1976), table 2.

    Examples
    --------
    >>> family = ochi_hubble_family(hs=5.0)
    >>> len(family), round(family[0].hs, 12), round(family[0].parts[0].tp, 2)
    (11, 5.0, 11.3)
    """
    hs = _positive(hs, "hs", "m")
    return tuple(_member(hs, i, row) for i, row in enumerate(_OCHI_HUBBLE, start=1))


def _member(hs: float, number: int, row: tuple[float, ...]) -> Spectrum:
    r1, r2, w1, d1, w2, d2, lambda1, lambda2, d3 = row
    scale = hs / float(np.hypot(r1, r2))
    sea = ochi_hubble(
        hs1=r1 * scale,
        tp1=2.0 * pi / (w1 * exp(-d1 * hs)),
        lambda1=lambda1,
        hs2=r2 * scale,
        tp2=2.0 * pi / (w2 * exp(-d2 * hs)),
        lambda2=lambda2 * exp(-d3 * hs),
    )
    return Spectrum(sea.parts, f"Ochi-Hubble member {number} of 11")


def _limited(value: float) -> float:
    return min(max(value, 0.0), 1.0)


def _positive(value: float, name: str, unit: str) -> float:
    number = float(value)
    if not (np.isfinite(number) and number > 0.0):
        raise InputError(f"{name}: a positive number of {unit} expected, {value!r} found.")
    return number
