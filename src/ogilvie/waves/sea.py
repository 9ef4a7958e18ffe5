"""Seas: regular, bichromatic, irregular, from a record."""

import numpy as np

from ogilvie.errors import InputError
from ogilvie.units import GRAVITY
from ogilvie.waves.field import Sea
from ogilvie.waves.irregular import irregular
from ogilvie.waves.record import sea_from_record

__all__ = ["Sea", "bichromatic", "irregular", "regular", "sea_from_record"]

Pair = tuple[float, float]


def regular(
    *,
    direction: float,
    amplitude: float | None = None,
    height: float | None = None,
    period: float | None = None,
    omega: float | None = None,
    phase: float = 0.0,
    depth: float = np.inf,
    g: float = GRAVITY,
) -> Sea:
    """Return one regular wave, zeta = a cos(omega t - k (x cos b + y sin b) + phase).

    Parameters
    ----------
    direction : float
        Direction the wave travels to, rad.
    amplitude, height : float
        a or H = 2 a, m: exactly one of them, > 0.
    period, omega : float
        s or rad/s: exactly one of them, > 0.
    phase : float
        rad.
    depth, g : float
        m, m/s2.

    Returns
    -------
    Sea

    Raises
    ------
    InputError

    Examples
    --------
    >>> wave = regular(height=2.0, period=8.0, direction=np.pi)
    >>> float(wave.elevation(0.0)), round(float(wave.elevation(4.0)), 12)
    (1.0, -1.0)
    """
    a = _one_of("regular", amplitude=amplitude, height=height)
    w = _one_of("regular", omega=omega, period=period)
    return Sea(
        omega=np.array([w], dtype=float),
        direction=np.array([direction], dtype=float),
        amplitude=np.array([a], dtype=float),
        phase=np.array([phase], dtype=float),
        depth=depth,
        g=g,
        label=f"regular wave, H {2 * a:.3g} m, T {2 * np.pi / w:.3g} s",
        period=2.0 * np.pi / w,
    )


def bichromatic(
    *,
    direction: float | Pair,
    amplitude: Pair | None = None,
    height: Pair | None = None,
    period: Pair | None = None,
    omega: Pair | None = None,
    phase: Pair = (0.0, 0.0),
    depth: float = np.inf,
    g: float = GRAVITY,
) -> Sea:
    """Return the sum of two regular waves, whose difference frequency drives slow drift.

    Parameters
    ----------
    direction : float or (float, float)
        Directions the waves travel to, rad; one number for both.
    amplitude, height : (float, float)
        m: exactly one of them.
    period, omega : (float, float)
        s or rad/s: exactly one of them.
    phase : (float, float)
        rad.
    depth, g : float
        m, m/s2.

    Returns
    -------
    Sea

    Raises
    ------
    InputError

    Examples
    --------
    >>> sea = bichromatic(height=(7.0, 8.0), period=(7.0, 10.75), direction=np.pi / 2)
    >>> float(sea.elevation(0.0)), len(sea.omega)
    (7.5, 2)
    """
    pairs = {"amplitude": amplitude, "height": height, "period": period, "omega": omega, "phase": phase}
    for key, pair in pairs.items():
        if pair is not None and np.shape(pair) != (2,):
            raise InputError(f"bichromatic: {key} must hold two numbers, {pair!r} found.")
    if np.shape(direction) not in ((), (2,)):
        raise InputError(f"bichromatic: one direction or two expected, {direction!r} found.")
    waves = [
        regular(
            direction=float(np.broadcast_to(direction, 2)[i]),
            phase=float(phase[i]),
            depth=depth,
            g=g,
            amplitude=None if amplitude is None else amplitude[i],
            height=None if height is None else height[i],
            period=None if period is None else period[i],
            omega=None if omega is None else omega[i],
        )
        for i in (0, 1)
    ]
    return waves[0] + waves[1]


def _one_of(who: str, **choices: float | None) -> float:
    """Return amplitude or frequency from whichever of two arguments is given."""
    given = {k: v for k, v in choices.items() if v is not None}
    if len(given) != 1:
        raise InputError(f"{who}: exactly one of {', '.join(choices)} expected, {', '.join(given) or 'none'} found.")
    key, value = next(iter(given.items()))
    number = float(value)
    if not (np.isfinite(number) and number > 0.0):
        raise InputError(f"{key}: a positive number expected, {value!r} found.")
    return {"amplitude": number, "height": 0.5 * number, "omega": number, "period": 2.0 * np.pi / number}[key]
