"""Impulse responses of damped oscillators on an even time grid, exactly, whatever the step."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import ConvergenceError, InputError

Array = NDArray[Any]

_NEGATIVE = 1e-3  # of the largest eigenvalue: a stiffness more negative than this is an error of the mesh, not of rounding


@dataclass(frozen=True, eq=False)
class Response:
    """Velocities of a system of oscillators after unit impulses.

    Parameters
    ----------
    K : (n_t, k, k) array
        inputs.T z'(t), symmetric.
    least : float
        Lowest eigenvalue of the stiffness over the highest, before it was cut off at zero.
    energy : (n_t,) array
        Largest energy left of what the impulses gave, 1 at the start; it cannot grow.
    """

    K: Array
    least: float
    energy: Array


def impulse_response(stiffness: Array, damping: Array, inputs: Array, *, dt: float, count: int) -> Response:
    """Return inputs.T z'(t) at t = 0, dt, ... of z'' + damping z' + stiffness z = inputs delta(t).

    Parameters
    ----------
    stiffness, damping : (n, n) array
        Symmetric, >= 0.
    inputs : (n, k) array
    dt : float
    count : int
        Number of times.

    Raises
    ------
    InputError
        dt or count not positive.
    ConvergenceError
        A stiffness far from positive semi-definite.

    Notes
    -----
    With S = U diag(W^2) U.T and x = (W U.T z, U.T z'), x' = A x where

        A = [[0, W], [-W, -U.T C U]],   d|x|^2/dt = -2 z'.T C z' <= 0:

    the propagator E = exp(A dt) contracts, so neither the step nor its number can make anything grow. A.T = J A J with
    J = diag(-1, 1), hence (inputs.T z')(i + j m) = (J E^i b).T E^(jm) b with b = (0, U.T inputs): two sequences of about
    sqrt(count) vectors give all times.

    Examples
    --------
    >>> one = np.ones((1, 1))
    >>> r = impulse_response(4.0 * one, 0.0 * one, one, dt=0.5, count=4)
    >>> bool(np.allclose(r.K[:, 0, 0], np.cos(2 * 0.5 * np.arange(4))))
    True
    """
    if not (dt > 0.0 and count >= 1):
        raise InputError(f"impulse_response: dt > 0 and count >= 1 expected, {dt} and {count} found.")
    size, turn = np.linalg.eigh(stiffness)
    least = float(size[0] / size[-1])
    if least < -_NEGATIVE:
        raise ConvergenceError(
            f"The stiffness of the coupled system has an eigenvalue of {least:.1e} of the largest, 0 or more expected: "
            "the mesh of the inner domain is too coarse or distorted."
        )
    W, n, k = np.sqrt(np.maximum(size, 0.0)), len(size), inputs.shape[1]
    E = propagator(W, turn.T @ damping @ turn, dt)
    b = np.concatenate([np.zeros((n, k)), turn.T @ inputs])
    small = max(int(np.sqrt(count)), 1)
    large = -(-count // small)
    first = _powers(E, b, small)
    second = _powers(np.linalg.matrix_power(E, small), b, large)
    energy = np.repeat(np.max(np.sum(second**2, axis=1) / np.sum(b**2, axis=0), axis=1), small)[:count]
    first[:, :n] *= -1.0
    left = first.transpose(0, 2, 1).reshape(small * k, 2 * n)
    K = left @ second.transpose(1, 0, 2).reshape(2 * n, large * k)
    K = K.reshape(small, k, large, k).transpose(2, 0, 1, 3).reshape(-1, k, k)[:count]
    return Response(0.5 * (K + K.transpose(0, 2, 1)), least, energy)


def propagator(W: Array, C: Array, dt: float) -> Array:
    """Return exp(dt [[0, W], [-W, -C]])."""
    from scipy.linalg import expm

    n = len(W)
    A = np.zeros((2 * n, 2 * n))
    A[:n, n:] = np.diag(W)
    A[n:, :n] = -np.diag(W)
    A[n:, n:] = -C
    return np.asarray(expm(dt * A))


def _powers(E: Array, b: Array, count: int) -> Array:
    """Return E^i b for i = 0..count - 1, shape (count, n, k)."""
    out = np.empty((count, *b.shape))
    out[0] = b
    for i in range(1, count):
        out[i] = E @ out[i - 1]
    return out
