"""Sums of wave components, Re sum_j C_j exp(i omega_j t): FFT where the sea is periodic, compiled loops elsewhere. Kernel."""

from math import cos, sin

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_BLOCK = 128  # steps between exact renewals of the phasors; the rounding of their products stays below 1e-13


def time_series(omega: Array, coefficients: ComplexArray, t: Array, *, period: float | None = None) -> Array:
    """Return Re sum_j C_j exp(i omega_j t_m).

    Parameters
    ----------
    omega : (n,) array
        rad/s.
    coefficients : (..., n) complex array
        C.
    t : (n_t,) array
        s.
    period : float, optional
        Every omega is a multiple of 2 pi/period; then times that divide the period evenly are summed by FFT.

    Returns
    -------
    (..., n_t) array

    Examples
    --------
    >>> t = np.arange(4) * 0.5
    >>> time_series(np.array([np.pi]), np.array([1.0 + 0j]), t, period=2.0).round(12) + 0.0
    array([ 1.,  0., -1.,  0.])
    """
    lead = coefficients.shape[:-1]
    C = np.ascontiguousarray(coefficients.reshape(-1, len(omega)), dtype=complex)
    step = _uniform_step(t)
    if step is None:
        zero = np.zeros_like(t)
        out = _scattered(omega, np.zeros_like(omega), np.zeros_like(omega), C, t, zero, zero)
    elif (count := _steps_per_period(step, period)) is not None:
        out = _periodic(omega, C, float(t[0]), len(t), count, float(period or 0.0))
    else:
        out = _uniform(omega, C, float(t[0]), step, len(t))
    return out.reshape((*lead, len(t)))


def scattered(omega: Array, kx: Array, ky: Array, coefficients: ComplexArray, t: Array, x: Array, y: Array) -> Array:
    """Return Re sum_j C_j exp(i (omega_j t - kx_j x - ky_j y)) at points (t, x, y) of any one shape; (..., *shape)."""
    lead, shape = coefficients.shape[:-1], t.shape
    C = np.ascontiguousarray(coefficients.reshape(-1, len(omega)), dtype=complex)
    points = (np.ascontiguousarray(p, dtype=float).ravel() for p in (t, x, y))
    return _scattered(omega, kx, ky, C, *points).reshape((*lead, *shape))


def _uniform_step(t: Array) -> float | None:
    """Return the step of equally spaced times, None if they are not (or only one)."""
    if len(t) < 2:
        return None
    step = float(t[-1] - t[0]) / (len(t) - 1)
    tolerance = 4.0 * np.finfo(float).eps * float(np.abs(t).max())
    even = step > 0.0 and float(np.abs(t - (t[0] + step * np.arange(len(t)))).max()) <= tolerance
    return step if even else None


def _steps_per_period(step: float, period: float | None) -> int | None:
    if period is None:
        return None
    count = round(period / step)
    return count if count >= 2 and abs(count * step - period) <= 1e-12 * period else None


def _periodic(omega: Array, C: ComplexArray, start: float, n_t: int, count: int, period: float) -> Array:
    """Sum by FFT over one period of `count` steps, repeated as needed."""
    bins = np.rint(omega * period / (2.0 * np.pi)).astype(np.int64) % count
    F = np.zeros((len(C), count), dtype=complex)
    np.add.at(F.T, bins, (C * np.exp(1j * omega * start)).T)
    half = count // 2 + 1
    mirror = (-np.arange(half)) % count
    cycle = np.fft.irfft(0.5 * (F[:, :half] + np.conj(F[:, mirror])), n=count, axis=-1) * count
    return cycle[:, np.arange(n_t) % count]


@njit(cache=True, fastmath={"reassoc", "contract", "nsz"})
def _uniform(omega, C, start, step, n_t):
    """Turn phasors step by step; they are renewed by sine and cosine at the start of each block."""
    n_r, n = C.shape
    out = np.empty((n_r, n_t))
    turn_re, turn_im = np.empty(n), np.empty(n)
    re, im = np.empty(n), np.empty(n)
    for j in range(n):
        turn_re[j], turn_im[j] = cos(omega[j] * step), sin(omega[j] * step)
    for r in range(n_r):
        for m0 in range(0, n_t, _BLOCK):
            for j in range(n):
                angle = omega[j] * (start + m0 * step)
                c, s = cos(angle), sin(angle)
                re[j] = C[r, j].real * c - C[r, j].imag * s
                im[j] = C[r, j].real * s + C[r, j].imag * c
            for m in range(m0, min(m0 + _BLOCK, n_t)):
                total = 0.0
                for j in range(n):
                    total += re[j]
                    turned = re[j] * turn_re[j] - im[j] * turn_im[j]
                    im[j] = re[j] * turn_im[j] + im[j] * turn_re[j]
                    re[j] = turned
                out[r, m] = total
    return out


@njit(cache=True)
def _scattered(omega, kx, ky, C, t, x, y):
    """Sum at arbitrary points."""
    n_r, n = C.shape
    out = np.zeros((n_r, len(t)))
    for m in range(len(t)):
        for j in range(n):
            angle = omega[j] * t[m] - kx[j] * x[m] - ky[j] * y[m]
            c, s = cos(angle), sin(angle)
            for r in range(n_r):
                out[r, m] += C[r, j].real * c - C[r, j].imag * s
    return out
