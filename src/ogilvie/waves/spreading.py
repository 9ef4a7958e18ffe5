"""How wave energy spreads over directions."""

from dataclasses import dataclass
from math import exp, lgamma, pi
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError

Array = NDArray[np.float64]
Kind = Literal["cos2s", "cosn"]


@dataclass(frozen=True)
class Spreading:
    """Density D of wave energy over the angle from the main direction, 1/rad; its integral over the circle is 1.

    Made by :func:`spreading`.
    """

    kind: Kind
    exponent: float

    def __call__(self, angle: ArrayLike) -> Array:
        """Return D at angles (rad) from the main direction, 1/rad."""
        angle = np.remainder(np.asarray(angle, dtype=float) + pi, 2.0 * pi) - pi
        a, stretch = self._cosine
        cosine = np.where(np.abs(angle) <= stretch * pi / 2.0, np.cos(angle / stretch), 0.0)
        return _norm(a) / stretch * np.maximum(cosine, 0.0) ** a

    def quantile(self, fraction: ArrayLike) -> Array:
        """Return the angle (rad) from the main direction below which a fraction (0..1) of the energy travels."""
        from scipy.special import betaincinv

        p = np.asarray(fraction, dtype=float)
        if not np.all((p >= 0.0) & (p <= 1.0)):
            raise InputError("fraction: numbers from 0 to 1 expected, others or NaN found.")
        a, stretch = self._cosine
        return np.sign(p - 0.5) * stretch * np.arcsin(np.sqrt(betaincinv(0.5, 0.5 * (a + 1.0), np.abs(2.0 * p - 1.0))))

    @property
    def deviation(self) -> float:
        """Circular standard deviation sqrt(2 (1 - r1)), rad, r1 the mean of cos(angle)."""
        angle = self.quantile((np.arange(4000) + 0.5) / 4000)
        return float(np.sqrt(2.0 * (1.0 - np.mean(np.cos(angle)))))

    @property
    def _cosine(self) -> tuple[float, float]:
        """Return a, c of D ~ cos^a(angle/c)."""
        return (2.0 * self.exponent, 2.0) if self.kind == "cos2s" else (self.exponent, 1.0)


def spreading(*, s: float | None = None, n: float | None = None) -> Spreading:
    """Return a spreading function: cos^2s of half the angle, or cos^n of the angle.

    Parameters
    ----------
    s : float, optional
        D ~ cos^(2 s)(angle/2) over the whole circle (Longuet-Higgins); about 10 for wind sea, 25 to 75 for swell.
    n : float, optional
        D ~ cos^n(angle) within 90 deg of the main direction; 2 to 4 for wind sea. About s = 2 n + 1.

    Returns
    -------
    Spreading

    Raises
    ------
    InputError
        Not exactly one of `s` and `n`, or not positive.

    Notes
    -----
    D = Gamma(s + 1)/(2 sqrt(pi) Gamma(s + 1/2)) cos^(2 s)(angle/2); Gamma(n/2 + 1)/(sqrt(pi) Gamma(n/2 + 1/2)) cos^n(angle).

    References
    ----------
    Longuet-Higgins, Cartwright and Smith (1963); DNV-RP-C205 (2010), 3.5.8.

    Examples
    --------
    >>> D = spreading(s=10)
    >>> round(float(D(0.0)), 4), round(D.deviation * 180 / np.pi, 1)
    (0.9033, 24.4)
    """
    if (s is None) == (n is None):
        raise InputError("spreading: exactly one of s (cos^2s of half the angle) and n (cos^n of the angle) expected.")
    kind: Kind = "cosn" if s is None else "cos2s"
    value = float(n if s is None else s)  # type: ignore[arg-type]
    if not (np.isfinite(value) and value > 0.0):
        raise InputError(f"spreading: a positive exponent expected, {value!r} found.")
    return Spreading(kind, value)


def check_direction(direction: ArrayLike) -> None:
    """Raise :class:`InputError` unless directions are finite and within +-2 pi."""
    b = np.asarray(direction, dtype=float)
    if not np.all(np.abs(b) <= 2.0 * np.pi + 1e-9):
        worst = f"{float(b.flat[int(np.argmax(np.abs(np.nan_to_num(b, nan=np.inf))))]):g}"
        raise InputError(f"direction: rad within -2 pi..2 pi expected, {worst} found. Degrees? Write {worst} * og.units.deg.")


def _norm(a: float) -> float:
    """Return 1 / integral of cos^a over -pi/2..pi/2."""
    return exp(lgamma(0.5 * a + 1.0) - lgamma(0.5 * a + 0.5)) / pi**0.5
