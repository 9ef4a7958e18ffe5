"""Runge-Kutta time stepping with the fluid memory as a convolution over the past velocities."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import MemoryKernel
from ogilvie.memory.lag import START, lag_weights, start_factors
from ogilvie.sim.dynamics import COLUMNS, FAST, combine, pack_mechanics, record, stages
from ogilvie.sim.integrate import memory_step, refuse_unstable_step, step_matrix
from ogilvie.sim.scheme import Interval
from ogilvie.sim.seaway import combine_harmonics
from ogilvie.sim.system import TURNING, LinearSystem

Array = NDArray[Any]
ComplexArray = NDArray[Any]
_NEAR = 5  # number of weights at the near end that depend on where the history ends
_HEADER = 8  # entries of the memory vector before the velocities: step count, place of the newest velocity, carried force (6)


@dataclass(frozen=True, eq=False)
class ConvolutionScheme:
    """Exponential Runge-Kutta method of order 4, its exponentials replaced by the kernel.

    Parameters
    ----------
    dt : float
        s.
    speed : float
        U, m/s.
    mechanics : (18, 6, 6) array
        See :mod:`ogilvie.sim.dynamics`.
    pairs : (n_pairs, 2) int array
        Couplings (force, motion) whose kernel is not zero.
    weights : (n_pairs, 2, n) array
        Of the past velocities, newest first, in the memory force half a step and one step after the newest.
    near : (5, 6, 6) array
        What the step just completed adds to the memory force carried over from it.
    start_weights : (8, 3, 8, 6, 6) array
        For the first steps after a start from rest: number of the step, place in the step, velocity, force, motion.
    start_factors : (4,) array
        Factors of the first four velocities after a start from rest.

    Notes
    -----
    mu(t + c dt) = int_0^inf K(s + c dt) nu(t - s) ds + (current step), c = 0, 1/2, 1. The past is a sum over stored velocities
    with the fourth-order weights of :mod:`ogilvie.memory.lag`. With I the integral of K from 0 to dt/2 and J that from dt/2
    to dt, the current step adds I v_1, I v_2, (J - I) v_1 + 2 I v_3 to the stages 2, 3, 4: what
    :func:`ogilvie.sim.integrate.memory_step` does for K = C exp(A t) B. A step costs two sums per coupling: the memory
    force at its end is carried over. A start with a jump in velocity or acceleration keeps the order: the integral then
    begins at the start.

    References
    ----------
    Cox and Matthews (2002), J. Comput. Phys. 176, 430; Brunner, Hairer and Norsett (1982), Math. Comp. 39(159), 147.
    """

    dt: float
    speed: float
    mechanics: Array
    pairs: NDArray[np.int64]
    weights: Array
    near: Array
    start_weights: Array
    start_factors: Array
    columns: int = COLUMNS

    @classmethod
    def of(cls, system: LinearSystem, dt: float) -> "ConvolutionScheme":
        """Return the scheme of a system, or raise :class:`InputError` with the time step that would work."""
        kernel = system.memory_at_speed
        assert isinstance(kernel, MemoryKernel)
        _check_step(system, kernel, dt)
        n = int(np.ceil(kernel.t[-1] / dt - 1e-9)) + 2  # beyond the memory, so that its far end needs no care
        now, half, one = (lag_weights(kernel, dt, c, n) for c in (0.0, 0.5, 1.0))
        near = now[:_NEAR].copy()
        near[1:] -= one[: _NEAR - 1]
        start = np.zeros((START, 3, START, 6, 6))
        for k in range(START):
            for place, c in enumerate((0.0, 0.5, 1.0)):
                start[k, place, : k + 1] = lag_weights(kernel, dt, c, k)
        pairs = np.argwhere(np.abs(kernel.K).max(axis=0) > 0.0)
        both = np.stack([half, one])[:, :, pairs[:, 0], pairs[:, 1]]  # (2, n + 1, n_pairs)
        coupling = np.zeros((4, 4, 6, 6))
        near_half, far_half = (kernel.spline.integrate(c * dt, (c + 0.5) * dt) for c in (0.0, 0.5))
        coupling[1, 0] = coupling[2, 1] = near_half
        coupling[3, 0], coupling[3, 2] = far_half - near_half, 2.0 * near_half
        return cls(
            dt=float(dt),
            speed=system.speed,
            mechanics=pack_mechanics(system.inverse_mass, system.stiffness, system.damping_at_speed, coupling),
            pairs=np.ascontiguousarray(pairs, dtype=np.int64),
            weights=np.ascontiguousarray(both.transpose(2, 0, 1)),
            near=near,
            start_weights=start,
            start_factors=start_factors(),
        )

    @property
    def length(self) -> int:
        """Number of past velocities in use."""
        return self.weights.shape[2]

    @property
    def memory_size(self) -> int:
        """Length of the memory vector: header and velocities (6, 2 length), stored twice so that any window is contiguous."""
        return _HEADER + 12 * self.length

    def rest(self, nu: Array) -> Array:
        """Return the memory (r, k) of vessels that were at rest."""
        return np.zeros((len(nu), self.memory_size))

    def steady(self, omega: Array, velocity: ComplexArray, amplitude: ComplexArray) -> Array:
        """Return the memory (r, k) of harmonic motions, their past velocities; see :class:`ogilvie.sim.scheme.Scheme`."""
        turn = np.exp(-1j * np.outer(omega, self.dt * np.arange(1, self.length + 1)))
        past = np.stack([combine_harmonics(amplitude, velocity[:, i, None] * turn) for i in range(6)], axis=1)
        carried = np.zeros((len(amplitude), 6))
        for (i, j), w in zip(self.pairs, self.weights, strict=True):
            carried[:, i] += (past[:, j] * w[1]).sum(axis=1)
        count = np.full((len(amplitude), 1), float(START))
        velocities = np.concatenate([past, past], axis=2).reshape(len(amplitude), -1)
        return np.concatenate([count, np.zeros_like(count), carried, velocities], axis=1)

    def advance(self, y: Array, memory: Array, wave: Array, external: Array, at: Interval, out: Array) -> int:
        """Advance in place; see :class:`ogilvie.sim.scheme.Scheme`."""
        return _run(
            self.dt, self.speed, self.mechanics, self.pairs, self.weights, self.near, self.start_weights, self.start_factors,
            y, memory, wave, external, at.row, at.steps, at.first, at.stride, out,
        )  # fmt: skip


def _check_step(system: LinearSystem, kernel: MemoryKernel, dt: float) -> None:
    """The fluid acts between a spring K(0) (fast motions) and nothing (slow ones): both must be stable."""
    if kernel.t[-1] < START * dt:
        raise InputError(f"dt: at most an eighth of the memory's {kernel.t[-1]:g} s expected, {dt:g} s found.")
    W, D, U = system.inverse_mass, system.damping_at_speed, system.speed
    nothing = memory_step(np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0)), dt)
    for spring in (system.stiffness, system.stiffness + kernel.K[0]):
        loop = np.block([[U * TURNING, np.eye(6)], [-W @ spring, -W @ D]])
        natural = max(0.0, float(np.linalg.eigvals(loop).real.max()))

        def growth(h: float, spring: Array = spring, natural: float = natural) -> float:
            return float(np.abs(np.linalg.eigvals(step_matrix(W, spring, D, nothing, h, U))).max() * np.exp(-natural * h))

        refuse_unstable_step(growth, dt)


@njit(cache=True, nogil=True, fastmath=FAST)
def _past(pairs, weights, past, head, mu):
    """Fill the rows 1 to 3 of mu (half a step, half a step, one step after the newest velocity)."""
    n = weights.shape[2]
    mu[1:] = 0.0
    for c in range(pairs.shape[0]):
        i, j = pairs[c, 0], pairs[c, 1]
        window = past[j, head : head + n]
        half, one = 0.0, 0.0
        for k in range(n):
            x = window[k]
            half += weights[c, 0, k] * x
            one += weights[c, 1, k] * x
        mu[1, i] += half
        mu[3, i] += one
    mu[2] = mu[1]


@njit(cache=True, nogil=True, fastmath=FAST)
def _sum(weights, past, head, count, force):
    """force += sum_l weights_l nu_l over the newest `count` velocities, weights (>= count, 6, 6)."""
    for k in range(count):
        for i in range(6):
            s = 0.0
            for j in range(6):
                s += weights[k, i, j] * past[j, head + k]
            force[i] += s


@njit(cache=True, nogil=True, fastmath=FAST)
def _run(
    dt, speed, mechanics, pairs, weights, near, start_weights, start_factors,
    y, memory, wave, external, row, steps, first, stride, out,
):  # fmt: skip
    eta, rate, v, a, mu = np.empty(6), np.empty((4, 6)), np.empty((4, 6)), np.empty((4, 6)), np.zeros((4, 6))
    n = weights.shape[2]
    start = start_weights.shape[0]
    past = memory[8:].reshape(6, 2 * n)
    count, head = int(memory[0]), int(memory[1])
    written = 0
    for i in range(steps):
        head = n - 1 if head == 0 else head - 1
        for p in range(6):
            past[p, head] = past[p, head + n] = y[6 + p]
        mu[0] = 0.0
        if count < start:
            mu[1:] = 0.0
            for stage, place in ((0, 0), (1, 1), (2, 1), (3, 2)):
                _sum(start_weights[count, place], past, head, count + 1, mu[stage])
            if count == start - 1:
                for q in range(start_factors.shape[0]):
                    k = head + count - q
                    for p in range(6):
                        past[p, k] *= start_factors[q]
                        past[p, (k + n) % (2 * n)] = past[p, k]
            count += 1
        else:
            for p in range(6):
                mu[0, p] = memory[2 + p]
            _sum(near, past, head, near.shape[0], mu[0])
            _past(pairs, weights, past, head, mu)
        for p in range(6):
            memory[2 + p] = mu[3, p]
        stages(dt, speed, mechanics, wave, row + 2 * i, external, mu, y, eta, rate, v, a)
        if (first + i) % stride == 0:
            record(out, written, y, a, mu)
            written += 1
        combine(dt, y, rate, a)
    memory[0] = count
    memory[1] = head
    return written
