"""Impulse responses of damped oscillators on an even time grid, without a limit of the time step."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import ConvergenceError, InputError

Array = NDArray[Any]

_NEGATIVE = 1e-3  # of the largest eigenvalue: a stiffness more negative than this is an error of the mesh, not of rounding
_STEP = 0.025  # longest step between damping and motion


class LateDamping(Protocol):
    """Damping shape diag(rate ramp(t)) shape.T that is constant from `complete` on; see :mod:`ogilvie.bem.short_waves`."""

    @property
    def shape(self) -> Array: ...
    @property
    def complete(self) -> float: ...
    def loss(self, t: float, h: float) -> Array: ...


@dataclass(frozen=True, eq=False)
class Response:
    """Velocities of a system of oscillators after unit impulses.

    Parameters
    ----------
    K : (n_t, k, k) array
        inputs.T z'(t), symmetric.
    least : float
        Lowest eigenvalue of the stiffness over the highest, before it was cut off at zero.
    energy : (n_t, k) array
        Energy left of what each impulse gave, 1 at the start; it cannot grow.
    """

    K: Array
    least: float
    energy: Array


def impulse_response(
    stiffness: Array, damping: Array, inputs: Array, *, dt: float, count: int, late: LateDamping | None = None
) -> Response:
    """Return inputs.T z'(t) at t = 0, dt, ... of z'' + damping z' + stiffness z = inputs delta(t).

    Parameters
    ----------
    stiffness, damping : (n, n) array
        Symmetric, >= 0.
    inputs : (n, k) array
    dt : float
    count : int
        Number of times.
    late : LateDamping, optional
        Further damping that comes into force by and by.

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

    the propagator E = exp(A h) contracts whatever the step. Late damping is put between, half before and half after, as
    z' -> z' + shape (exp(-rate ramp h/2) - 1) shape.T z', which contracts too: nothing can grow. Once it is constant so is the step
    M, and two sequences of about sqrt(count) vectors give all times: (inputs.T z')(i + j m) = (b.T M^i) (M^(jm) x).

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
    x = np.concatenate([np.zeros((n, k)), turn.T @ inputs])
    C = turn.T @ damping @ turn
    if late is None:
        X = _even(propagator(W, C, dt), x, x, count)
    else:
        X = _late(propagator(W, C, dt / _parts(dt)), turn.T @ late.shape, late, x, dt, count)
    return Response(0.5 * (X[0] + X[0].transpose(0, 2, 1)), least, X[1] / X[1][0])


def propagator(W: Array, C: Array, dt: float) -> Array:
    """Return exp(dt [[0, W], [-W, -C]])."""
    from scipy.linalg import expm

    n = len(W)
    A = np.zeros((2 * n, 2 * n))
    A[:n, n:] = np.diag(W)
    A[n:, :n] = -np.diag(W)
    A[n:, n:] = -C
    return np.asarray(expm(dt * A))


def _parts(dt: float) -> int:
    return int(np.ceil(dt / _STEP - 1e-9))


def _late(E: Array, shape: Array, late: LateDamping, b: Array, dt: float, count: int) -> tuple[Array, Array]:
    """Return b.T x and |x|^2 at all times: single steps until the late damping is constant, then :func:`_even`."""
    parts, n, x = _parts(dt), len(shape), b.copy()
    h, first = dt / parts, min(count, int(np.ceil(late.complete / dt)) + 1)
    K, energy = [b.T @ x], [np.sum(x**2, axis=0)]
    for i in range((first - 1) * parts):
        x[n:] += shape @ (late.loss(i * h, h / 2)[:, None] * (shape.T @ x[n:]))
        x = E @ x
        x[n:] += shape @ (late.loss((i + 1) * h, h / 2)[:, None] * (shape.T @ x[n:]))
        if (i + 1) % parts == 0:
            K.append(b.T @ x)
            energy.append(np.sum(x**2, axis=0))
    if first == count:
        return np.array(K), np.array(energy)
    half = np.eye(n) + shape @ (late.loss(late.complete, h / 2)[:, None] * shape.T)
    M = E.copy()
    M[n:] = half @ M[n:]
    M[:, n:] = M[:, n:] @ half
    K_after, energy_after = _even(np.linalg.matrix_power(M, parts), b, x, count - first + 1)
    return np.concatenate([K, K_after[1:]]), np.concatenate([energy, energy_after[1:]])


def _even(M: Array, b: Array, x: Array, count: int) -> tuple[Array, Array]:
    """Return b.T M^i x (count, k, k) and |M^i x|^2 (count, k), the latter held for some steps."""
    k, small = b.shape[1], max(int(np.sqrt(count)), 1)
    large = -(-count // small)
    left = _powers(M.T, b, small).transpose(0, 2, 1).reshape(small * k, -1)
    right = _powers(np.linalg.matrix_power(M, small), x, large)
    K = (left @ right.transpose(1, 0, 2).reshape(len(x), large * k)).reshape(small, k, large, k)
    energy = np.repeat(np.sum(right**2, axis=1), small, axis=0)
    return K.transpose(2, 0, 1, 3).reshape(-1, k, k)[:count], energy[:count]


def _powers(M: Array, b: Array, count: int) -> Array:
    """Return M^i b for i = 0..count - 1, shape (count, n, k)."""
    out = np.empty((count, *b.shape))
    out[0] = b
    for i in range(1, count):
        out[i] = M @ out[i - 1]
    return out
