"""Extrema of a decaying oscillation, found one half cycle after the other by local fits that see through noise."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from ogilvie.errors import InputError

Array = NDArray[Any]

_SAMPLES = 10  # per cycle at least
_WINDOW = 0.2  # of a period: half width of the piece that a local fit sees
_BEYOND = 0.05  # of a period: how far outside the series an extremum may lie
_NOISE = 3.0  # standard deviations of the noise that an extremum must exceed
_ROUNDS = 4  # of the local fits, each with the frequency and decay found by the one before
_GROWTH = 1.5  # from one extremum to the next at most: more is no decay
_NEIGHBOURS = 3  # extrema on either side from which the local decay is taken
_RATIOS = np.linspace(0.0, 0.4, 9)  # damping ratios tried for a first look
_MANY = 4000  # samples that are enough for it


@dataclass(frozen=True)
class Oscillation:
    """x = c + d (t - t_0) + exp(-sigma (t - t_0)) (a cos + b sin)(omega (t - t_0)): the first look at a decay."""

    omega: float
    sigma: float
    offset: float
    drift: float

    def base(self, t: Array) -> Array:
        """Return c + d (t - t_0)."""
        return self.offset + self.drift * (t - t[0])


def first_look(t: Array, x: Array, *, drift: bool) -> Oscillation:
    """Return the damped sine that fits a series best: frequency, decay, offset and, if asked for, drift.

    Raises
    ------
    InputError
        Fewer than one and a half cycles, or fewer than ten samples in a cycle.
    """
    step = max(1, len(t) // _MANY)
    tau, y = t[::step] - t[0], x[::step]
    omega = _dominant_frequency(t, x)
    trials = [(w, ratio * w) for w in omega * np.linspace(0.6, 1.5, 46) for ratio in _RATIOS]
    start = min(trials, key=lambda p: float((_misfit(p, tau, y, drift)[0] ** 2).sum()))
    best = least_squares(
        lambda p: _misfit(p, tau, y, drift)[0], start, x_scale=[omega, 0.05 * omega], bounds=([0.2 * omega, -omega], 5 * omega)
    )
    omega, sigma = best.x
    _check_length(t, omega)
    c = _misfit(best.x, tau, y, drift)[1]
    return Oscillation(float(omega), float(sigma), float(c[2]), float(c[3]) if drift else 0.0)


def extrema(t: Array, x: Array, look: Oscillation, *, noise: float, smallest: float) -> tuple[Array, Array]:
    """Return times and signed values of the extrema of a decay about zero, as long as they rise above the noise.

    Parameters
    ----------
    t, x : (n,) array
        From the first extremum on (or a little before it), offset removed.
    look : Oscillation
    noise : float
        Standard deviation of a sample, in the unit of x.
    smallest : float
        Part of the first extremum below which none is picked.

    Notes
    -----
    Around each extremum x = exp(-sigma s)(a cos omega s + b sin omega s) is fitted over 0.4 of a period by linear least
    squares; its own extremum is the result. The next one is looked for half a period later. omega and sigma are then taken
    from the neighbouring extrema and the fits are repeated. A linearly damped oscillation is found exactly.
    """
    half = np.pi / look.omega
    doubt = _NOISE * noise * np.sqrt(2 * np.median(np.diff(t)) / (4 * _WINDOW * half))  # of a local fit of two numbers
    first = int(np.argmax(np.abs(x[t <= t[0] + 1.2 * half])))
    found = _local(t, x, float(t[first]), look.omega, look.sigma) or _local(t, x, t[first] + half, look.omega, look.sigma)
    times, values, omega = [], [], look.omega
    while found is not None:
        times.append(found[0])
        values.append(found[1])
        if len(times) > 1:
            omega = 0.5 * omega + 0.5 * np.pi / np.clip(times[-1] - times[-2], 0.7 * half, 1.4 * half)
        found = _local(t, x, times[-1] + np.pi / omega, omega, look.sigma)
        least, most = max(doubt, smallest * abs(values[0])), _GROWTH * abs(values[-1])
        if found is not None and not least < -found[1] * np.sign(values[-1]) < most:
            break
    if len(times) < 3:
        raise InputError(f"decay: three extrema above the noise expected, {len(times)} found. Give a longer or cleaner series.")
    peaks, heights = np.array(times), np.array(values)
    for _ in range(_ROUNDS):
        peaks, heights = _again(t, x, peaks, heights)
    return peaks, heights


def _again(t: Array, x: Array, peaks: Array, heights: Array) -> tuple[Array, Array]:
    """Repeat the local fits with the frequency and decay of the neighbours."""
    new = []
    for k in range(len(peaks)):
        near = slice(max(0, k - _NEIGHBOURS), k + _NEIGHBOURS + 1)
        number = np.arange(len(peaks))[near]
        omega = np.pi / np.polyfit(number, peaks[near], 1)[0]
        sigma = -np.polyfit(peaks[near], np.log(np.abs(heights[near])), 1)[0]
        found = _local(t, x, float(peaks[k]), float(omega), float(sigma))
        new.append((peaks[k], heights[k]) if found is None or found[1] * heights[k] <= 0 else found)
    return np.array([p for p, _ in new]), np.array([h for _, h in new])


def _local(t: Array, x: Array, guess: float, omega: float, sigma: float) -> tuple[float, float] | None:
    """Return time and value of the extremum near a guess, or None where it lies outside the series."""
    period = 2 * np.pi / omega
    first = min(max(guess - _WINDOW * period, t[0]), t[-1] - 2 * _WINDOW * period)
    a, b = np.searchsorted(t, [first, first + 2 * _WINDOW * period], side="left")
    if guess > t[-1] + _BEYOND * period or b - a < 4:
        return None
    s = t[a : b + 1] - guess
    decay = np.exp(-sigma * s)
    regressors = np.stack([decay * np.cos(omega * s), decay * np.sin(omega * s)], axis=1)
    p, q = np.linalg.lstsq(regressors, x[a : b + 1], rcond=None)[0]
    at = np.arctan2(omega * q - sigma * p, omega * p + sigma * q) / omega  # where the derivative is zero
    at -= np.pi / omega * np.round(at * omega / np.pi)
    if not t[0] - _BEYOND * period <= guess + at <= t[-1] + _BEYOND * period:
        return None
    return guess + at, float(np.exp(-sigma * at) * (p * np.cos(omega * at) + q * np.sin(omega * at)))


def _dominant_frequency(t: Array, x: Array) -> float:
    """Return the highest peak of the spectrum, rad/s, from half a cycle in the series to ten samples in a cycle."""
    n = min(len(t), 4 * _MANY)
    grid = np.linspace(t[0], t[-1], n)
    y = np.interp(grid, t, x)
    omega = 2 * np.pi * np.fft.rfftfreq(4 * n, grid[1] - grid[0])
    power = np.abs(np.fft.rfft(y - y.mean(), 4 * n))
    usable = (omega > np.pi / (t[-1] - t[0])) & (omega < 2 * np.pi / (_SAMPLES * (grid[1] - grid[0])))
    if not np.any(usable):
        raise InputError(
            f"decay: at least 1.5 cycles of {_SAMPLES} samples expected, {len(t)} samples found. Give a longer series."
        )
    return float(omega[usable][int(np.argmax(power[usable]))])


def _misfit(p: Any, tau: Array, y: Array, drift: bool) -> tuple[Array, Array]:
    omega, sigma = p
    decay = np.exp(-sigma * tau)
    columns = [decay * np.cos(omega * tau), decay * np.sin(omega * tau), np.ones(len(tau))]
    regressors = np.stack([*columns, tau] if drift else columns, axis=1)
    c = np.linalg.lstsq(regressors, y, rcond=None)[0]
    return regressors @ c - y, c


def _check_length(t: Array, omega: float) -> None:
    cycles = (t[-1] - t[0]) * omega / (2 * np.pi)
    if cycles < 1.5:
        raise InputError(f"decay: at least one and a half cycles expected, {cycles:.2g} found. Give a longer series.")
    if len(t) / cycles < _SAMPLES:
        raise InputError(f"decay: at least {_SAMPLES} samples per cycle expected, {len(t) / cycles:.3g} found.")
