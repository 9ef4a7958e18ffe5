"""A sea from a measured record of the elevation."""

import warnings
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.units import GRAVITY
from ogilvie.waves.field import Sea
from ogilvie.waves.spreading import check_direction

Array = NDArray[np.float64]


def sea_from_record(
    t: ArrayLike,
    elevation: ArrayLike,
    *,
    direction: float,
    x: float = 0.0,
    y: float = 0.0,
    omega_range: tuple[float, float] | None = None,
    taper: float = 0.0,
    depth: float = np.inf,
    g: float = GRAVITY,
    label: str = "record",
) -> Sea:
    """Return the long-crested sea whose elevation at the wave probe is a measured record.

    Parameters
    ----------
    t : (n_t,) array
        Times, equally spaced, s.
    elevation : (n_t,) or (n_realisations, n_t) array
        m.
    direction : float
        Direction the waves travel to, rad.
    x, y : float
        Place of the wave probe, m.
    omega_range : (float, float), optional
        Components outside are left out, rad/s. By default all from 2 pi/T to pi/dt are kept, noise included.
    taper : float
        Time over which each end of the record is brought to zero by a half cosine, s. 0 keeps the record; its two ends then
        meet with a jump, which the sea reproduces.
    depth, g : float
        m, m/s2.
    label : str

    Returns
    -------
    Sea
        Periodic with T = n_t dt. ``sea.elevation(t, x, y)`` is the record less its mean, to rounding (with no taper, no range).

    Raises
    ------
    InputError

    Warns
    -----
    OgilvieWarning
        The mean, which is no wave and is taken off, exceeds a tenth of the standard deviation.

    Notes
    -----
    A_j = (2/n_t) sum_m zeta_m exp(-i omega_j t_m), omega_j = 2 pi j/T, and half that at pi/dt; phases move from the probe to O
    by k (x cos b + y sin b).

    Examples
    --------
    >>> t = np.arange(0, 20.0, 0.5)
    >>> zeta = np.cos(2 * np.pi / 10 * t + 0.3)
    >>> sea = sea_from_record(t, zeta, direction=np.pi)
    >>> bool(np.abs(sea.elevation(t) - zeta).max() < 1e-13)
    True
    """
    check_direction(direction)
    t, zeta = _check_record(t, elevation)
    n = len(t)
    period = n * (t[-1] - t[0]) / (n - 1)
    zeta = _without_mean(zeta) * _window(n, taper / period * n)
    omega = 2.0 * np.pi / period * np.arange(1, n // 2 + 1)
    A = np.fft.rfft(zeta, axis=-1)[..., 1:] * (2.0 / n)
    if n % 2 == 0:
        A[..., -1] *= 0.5
    keep = _kept(omega, omega_range)
    sea = Sea(
        omega=omega[keep],
        direction=np.full(int(keep.sum()), float(direction)),
        amplitude=np.abs(A[..., keep]),
        phase=np.angle(A[..., keep]) - omega[keep] * t[0],
        depth=depth,
        g=g,
        label=label,
        period=period,
    )
    travel = sea.wavenumber * (x * np.cos(direction) + y * np.sin(direction))
    return replace(sea, phase=np.remainder(sea.phase + travel, 2.0 * np.pi))


def _check_record(t: ArrayLike, elevation: ArrayLike) -> tuple[Array, Array]:
    t, zeta = np.asarray(t, dtype=float), np.array(elevation, dtype=float)
    if t.ndim != 1 or len(t) < 4 or zeta.ndim not in (1, 2) or zeta.shape[-1] != len(t):
        raise InputError(
            f"sea_from_record: times (n_t,) with n_t >= 4 and elevations (n_t,) or (n_realisations, n_t) expected, "
            f"{t.shape} and {zeta.shape} found."
        )
    for name, value in (("t", t), ("elevation", zeta)):
        if not np.all(np.isfinite(value)):
            raise InputError(f"{name}: finite numbers expected, {int((~np.isfinite(value)).sum())} NaN or infinite found.")
    steps = np.diff(t)
    if not np.all(steps > 0.0) or np.ptp(steps) > 1e-3 * steps.mean():
        raise InputError(
            f"t: equally spaced, ascending times expected, steps from {steps.min():.6g} to {steps.max():.6g} s found. "
            "Interpolate the record to equal steps first."
        )
    return t, zeta


def _without_mean(zeta: Array) -> Array:
    mean = zeta.mean(axis=-1, keepdims=True)
    if np.any(np.abs(mean) > 0.1 * zeta.std(axis=-1, keepdims=True)):
        warnings.warn(
            f"sea_from_record: the mean {float(mean.flat[int(np.argmax(np.abs(mean)))]):.4g} m of the record is no wave and is "
            "taken off.",
            OgilvieWarning,
            stacklevel=3,
        )
    return zeta - mean


def _window(n: int, length: float) -> Array:
    """Return a half-cosine taper over `length` samples at either end."""
    if not 0.0 <= length <= 0.5 * n:
        raise InputError(f"taper: a time from 0 to half the record expected, {length / n:.3g} of the record found.")
    if length == 0.0:
        return np.ones(n)
    from_end = np.minimum(np.arange(n), np.arange(n)[::-1])
    return 0.5 * (1.0 - np.cos(np.pi * np.minimum(from_end / length, 1.0)))


def _kept(omega: Array, omega_range: tuple[float, float] | None) -> NDArray[np.bool_]:
    if omega_range is None:
        return np.ones(len(omega), dtype=bool)
    first, last = omega_range
    keep = (omega >= first) & (omega <= last)
    if not keep.any():
        raise InputError(
            f"omega_range: {omega_range!r} rad/s holds no component of the record ({omega[0]:.4g}..{omega[-1]:.4g} rad/s)."
        )
    return keep
