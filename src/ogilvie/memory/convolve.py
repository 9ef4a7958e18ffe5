"""The memory force of a velocity that is known beforehand: one convolution by fast Fourier transforms; how long a memory is."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.memory.lag import START, lag_weights, start_factors
from ogilvie.memory.table import Retardation

Array = NDArray[Any]

SHARE = 1e-5  # of int |K| dt that the default length of a memory leaves out; 1e-3 moves a softly moored yaw by 0.6 %


def memory_length(K: Retardation, *, share: float = SHARE) -> float:
    """Return the shortest T after which no more than `share` of the memory is left, s.

    Parameters
    ----------
    K : Retardation
    share : float
        Between 0 and 1.

    Raises
    ------
    InputError
        A share that is not between 0 and 1.

    Notes
    -----
    int_T^end |K_ij| dt <= share sqrt(I_ii I_jj) with I_ij = int_0^end |K_ij| dt, for every coupling. The memory force that
    is left out is then at most the share of what the largest velocity could ever cause.

    Examples
    --------
    >>> t = np.arange(0.0, 40.0, 0.01)
    >>> K = Retardation(t, np.exp(-t)[:, None, None], [[0.0]], ("heave",))
    >>> round(memory_length(K, share=1e-3), 1)  # exp(-T) = 0.001
    6.9
    """
    if not 0.0 < share < 1.0:
        raise InputError(f"share: a number between 0 and 1 (0.001, say) expected, {share!r} found.")
    size = np.abs(K.K)
    pieces = 0.5 * K.dt * (size[1:] + size[:-1])
    left = np.concatenate([np.cumsum(pieces[::-1], axis=0)[::-1], np.zeros((1, *size.shape[1:]))])
    whole = np.diag(left[0])
    scale = np.sqrt(np.outer(whole, whole))
    alive = np.any(left > share * np.where(scale > 0.0, scale, left[0]), axis=(1, 2))
    return float(K.t[int(np.flatnonzero(alive)[-1]) + 1]) if alive.any() else K.dt


def truncated(K: Retardation, length: float) -> Retardation:
    """Return the functions cut at a time, s; the errors of the table they were cut from stay with it.

    Examples
    --------
    >>> t = np.arange(0.0, 10.0, 0.1)
    >>> truncated(Retardation(t, np.exp(-t)[:, None, None], [[0.0]], ("heave",)), 5.0).duration
    5.0
    """
    keep = round(length / K.dt) + 1
    return Retardation(K.t[:keep], K.K[:keep], K.A_inf, K.dofs, source=f"{K.source}, cut at {length:g} s")


def convolve(K: Retardation, nu: ArrayLike, dt: float, *, truncation: float | None = None) -> Array:
    """Return the memory force mu(t) = int_0^T K(s) nu(t - s) ds of a velocity known in advance, zero before its first sample.

    Parameters
    ----------
    K : Retardation
        Of m degrees of freedom.
    nu : (..., n_t, m) array
        Velocities, m/s and rad/s, in the order of K.dofs; leading axes are realisations.
    dt : float
        Time step of `nu`, s; at most an eighth of the memory. It need not be that of K.
    truncation : float, optional
        Length T of the memory, s; by default that of :func:`memory_length`, as in
        :class:`ogilvie.Convolution`.

    Returns
    -------
    (..., n_t, m) array
        N and N m. The radiation force is -A_inf nu' - mu.

    Raises
    ------
    InputError
        Wrong shape, NaN, a step that is not positive or too large, a memory longer than the table.

    Notes
    -----
    mu_n = sum_l W_l nu_{n-l}: K as a cubic spline is integrated exactly against the cubic through four neighbouring
    velocities, so the error falls as dt^4 also where the motion starts with a jump of velocity. The sums over the whole
    history are done by overlap-add. The scheme inside the time loop has the same weights.

    Examples
    --------
    >>> t = np.arange(0.0, 40.0, 0.1)
    >>> K = Retardation(t, np.exp(-t)[:, None, None], [[0.0]], ("heave",))
    >>> mu = convolve(K, np.ones((100, 1)), 0.05, truncation=30.0)  # velocity 1 from t = 0 on
    >>> bool(np.allclose(mu[:, 0], 1.0 - np.exp(-0.05 * np.arange(100)), atol=1e-6))
    True
    """
    from scipy.signal import oaconvolve

    length = checked_length(K, truncation, "convolve")
    velocity = _checked_velocity(K, nu, dt, length)
    kernel = truncated(K, length)
    W = lag_weights(kernel, dt, 0.0, int(np.ceil(kernel.duration / dt - 1e-9)) + 2)
    v = velocity.reshape(-1, *velocity.shape[-2:])
    n = v.shape[1]
    late = v.copy()
    late[:, : min(n, 4)] *= start_factors()[: min(n, 4), None]
    mu = np.zeros_like(v)
    for j in np.flatnonzero(np.any(kernel.K, axis=(0, 1))):
        mu += oaconvolve(late[:, :, j, None], W[None, :, :, j], axes=1)[:, :n]
    for k in range(min(START, n)):
        start = lag_weights(kernel, dt, 0.0, k)
        mu[:, k] = np.einsum("lij,rlj->ri", start, v[:, k::-1])
    return mu.reshape(velocity.shape)


def checked_length(K: Retardation, truncation: float | None, what: str) -> float:
    """Return the length of the memory, by default where little is left, or raise InputError."""
    if not isinstance(K, Retardation):
        raise InputError(f"{what}: a Retardation (e.g. from retardation) expected, {type(K).__name__} found.")
    if truncation is None:
        return memory_length(K)
    try:
        length = float(truncation)
    except (TypeError, ValueError):
        length = float("nan")
    if not (0.0 < length <= K.duration * (1 + 1e-9)):
        raise InputError(f"{what}: truncation in (0, {K.duration:g}] s, the length of the table, expected, {truncation} found.")
    return length


def _checked_velocity(K: Retardation, nu: ArrayLike, dt: float, length: float) -> Array:
    m = len(K.dofs)
    try:
        v, step = np.asarray(nu, dtype=float), float(dt)
    except (TypeError, ValueError):
        raise InputError("convolve: an array of velocities and a time step in s expected, something else found.") from None
    if v.ndim < 2 or v.shape[-1] != m or v.shape[-2] == 0:
        raise InputError(f"convolve: nu (..., n_t, {m}) over {', '.join(K.dofs)} expected, shape {v.shape} found.")
    if not np.all(np.isfinite(v)):
        raise InputError(f"convolve: finite velocities expected, {int((~np.isfinite(v)).sum())} NaN or infinite found.")
    if not (np.isfinite(step) and 0.0 < step <= length / START):
        raise InputError(
            f"convolve: dt positive and at most an eighth of the memory's {length:g} s expected, {dt} found. "
            "Resample the velocity, or give a longer truncation."
        )
    return v
