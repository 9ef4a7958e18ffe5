"""Impulse responses of damped oscillators on an even time grid, without a limit of the time step."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.braking import Brake
from ogilvie.bem.rational import RationalStep
from ogilvie.errors import ConvergenceError, InputError
from ogilvie.hydro.threads import algebra_threads

Array = NDArray[Any]

_NEGATIVE = 1e-3  # of the largest eigenvalue: a stiffness more negative than this is an error of the mesh, not of rounding
_STEP = 0.036  # longest step while late damping comes into force, and between it and the motion
_SMALL = 450  # oscillators up to which powers of the matrix of a step are worth their making


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
        inputs.T z'(t), symmetric; (n_t, n_outputs, k) and outputs.T z'(t) where other outputs were asked for.
    least : float
        Lowest eigenvalue of the stiffness over the highest, before it was cut off at zero.
    energy : (n_t, k) array
        Energy left of what each impulse gave, 1 at the start; it cannot grow. Small systems tell it for about every
        sqrt(n_t)-th time and repeat it between.
    """

    K: Array
    least: float
    energy: Array


def impulse_response(
    stiffness: Array,
    dampers: Array,
    inputs: Array,
    *,
    dt: float,
    count: int,
    late: LateDamping | None = None,
    outputs: Array | None = None,
) -> Response:
    """Return inputs.T z'(t) at t = 0, dt, ... of z'' + dampers dampers.T z' + stiffness z = inputs delta(t).

    Parameters
    ----------
    stiffness : (n, n) array
        Symmetric, >= 0.
    dampers : (n, r) array
    inputs : (n, k) array
    dt : float
    count : int
        Number of times.
    late : LateDamping, optional
        Further damping that comes into force by and by.
    outputs : (n, n_outputs) array, optional
        What to look at instead of the inputs.

    Raises
    ------
    InputError
        dt or count not positive.
    ConvergenceError
        A stiffness far from positive semi-definite.

    Notes
    -----
    With S = U diag(W^2) U.T and x = (W U.T z, U.T z'), x' = A x where

        A = [[0, W], [-W, -O O.T]],   O = U.T dampers,   d|x|^2/dt = -2 |O.T U.T z'|^2 <= 0.

    Steps of :class:`ogilvie.bem.rational.RationalStep` contract whatever their length. Late damping is put between, half
    before and half after, as z' -> z' + shape (exp(-rate ramp h/2) - 1) shape.T z', which contracts too: nothing can grow.
    Once it is constant so is the step M, and for few oscillators two sequences of about sqrt(count) vectors give all times:
    (inputs.T z')(i + j m) = (b.T M^i) (M^(j m) x).

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
    W, parts = np.sqrt(np.maximum(size, 0.0)), int(np.ceil(dt / _STEP - 1e-9))
    move = RationalStep(W, turn.T @ dampers, dt / parts)
    b = np.concatenate([np.zeros_like(inputs), turn.T @ inputs])
    seen = b if outputs is None else np.concatenate([np.zeros_like(outputs), turn.T @ outputs])
    shape = None if late is None else turn.T @ late.shape
    with algebra_threads(1):  # a step is short: threads would only wait for each other
        path = _Path(seen, b.copy())
        if late is None or shape is None:
            path.go_on(lambda x: _repeated(move, x, parts), count - 1)
        else:
            _go_late(path, move, late, shape, parts=parts, dt=dt, count=count)
    K = np.array(path.K)
    if outputs is None:
        K = 0.5 * (K + K.transpose(0, 2, 1))
    return Response(K, least, np.array(path.energy) / path.energy[0])


def _go_late(path: "_Path", move: RationalStep, late: LateDamping, shape: Array, *, parts: int, dt: float, count: int) -> None:
    """Go the whole way with damping between the steps: half before and half after each, two halves as one."""
    brake, h, seen = Brake(shape), dt / parts, path.b
    path.x = move(brake(path.x, late.loss(0.0, 0.5 * h)))
    first = min(int(np.ceil(late.complete / dt)), count - 1)
    for i in range(1, parts * first):
        if i % parts == 0:
            path.record(brake(path.x, late.loss(i * h, 0.5 * h)))
        path.x = move(brake(path.x, late.loss(i * h, h)))
    path.b, loss = brake(seen, late.loss(first * dt, 0.5 * h)), late.loss(late.complete, h)
    if len(path.K) < count:
        path.record()
    path.go_on(lambda x: _repeated(lambda y: move(brake(y, loss)), x, parts), count - len(path.K))


def _repeated(step: Callable[[Array], Array], x: Array, times: int) -> Array:
    for _ in range(times):
        x = step(x)
    return x


class _Path:
    """State x with what is seen of it: b.T x, and |x|^2, at each time."""

    def __init__(self, b: Array, x: Array) -> None:
        self.b, self.x = b, x
        self.K: list[Array] = []
        self.energy: list[Array] = []
        self.record()

    def record(self, x: Array | None = None) -> None:
        """Record x, or another state than the own."""
        x = self.x if x is None else x
        self.K.append(np.stack([self.b.T @ column for column in x.T], axis=1))
        self.energy.append(np.sum(x**2, axis=0))

    def go_on(self, step: Callable[[Array], Array], count: int) -> None:
        """Add `count` times by equal steps."""
        if len(self.x) > 2 * _SMALL or count < 2 * len(self.x) ** 0.5:
            for _ in range(count):
                self.x = step(self.x)
                self.record()
            return
        M = step(np.eye(len(self.x)))
        k, seen, small = self.x.shape[1], self.b.shape[1], int(np.sqrt(count)) + 1
        large = -(-(count + 1) // small)
        left = _powers(M.T, self.b, small).transpose(0, 2, 1).reshape(small * seen, -1)
        right = _powers(np.linalg.matrix_power(M, small), self.x, large)
        K = (left @ right.transpose(1, 0, 2).reshape(len(M), large * k)).reshape(small, seen, large, k)
        self.K += list(K.transpose(2, 0, 1, 3).reshape(-1, seen, k)[1 : count + 1])
        self.energy += list(np.repeat(np.sum(right**2, axis=1), small, axis=0)[1 : count + 1])


def _powers(M: Array, b: Array, count: int) -> Array:
    """Return M^i b for i = 0..count - 1, shape (count, n, k)."""
    out = np.empty((count, *b.shape))
    out[0] = b
    for i in range(1, count):
        out[i] = M @ out[i - 1]
    return out
