"""Exact time stepping of a fully linear vessel with a state-space memory, at any time step."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.loads.base import MemoryModel
from ogilvie.sim.dynamics import COLUMNS, FAST
from ogilvie.sim.integrate import exact_step
from ogilvie.sim.packed import harmonic_states
from ogilvie.sim.scheme import Interval
from ogilvie.sim.system import LinearSystem, warn_of_growth

Array = NDArray[Any]
ComplexArray = NDArray[Any]


@dataclass(frozen=True, eq=False)
class ExactScheme:
    """Matrix exponential of the whole vessel; exact for forces that are quadratic in time within a step, stable for any dt.

    Parameters
    ----------
    step : (12 + n, 12 + n + 18) array
        Gives the next (eta, nu, x) from (eta, nu, x, F(t), F(t + dt/2), F(t + dt)).
    now : (12, 12 + n + 18) array
        Gives acceleration and memory force at the start of the step from the same.
    model : MemoryModel
    """

    step: Array
    now: Array
    model: MemoryModel
    columns: int = COLUMNS

    @classmethod
    def of(cls, system: LinearSystem, dt: float) -> "ExactScheme":
        """Return the scheme of a system."""
        warn_of_growth(system)
        A = system.closed_loop()
        G = np.zeros((len(A), 6))
        G[6:12] = system.inverse_mass
        transition, source = exact_step(A, G, dt)
        n = len(A)
        now = np.zeros((12, n + 18))
        now[:6, :n], now[:6, n : n + 6] = A[6:12], system.inverse_mass
        now[6:, 12:n] = system.state_space.C
        step = np.concatenate([transition, source.reshape(n, 18)], axis=1)
        return cls(step, now, system.state_space)

    @property
    def memory_size(self) -> int:
        """Number of states of the fluid memory."""
        return len(self.model.A)

    def rest(self, nu: Array) -> Array:
        """Return the memory (r, k) of vessels that were at rest."""
        return np.zeros((len(nu), self.memory_size))

    def steady(self, omega: Array, velocity: ComplexArray, amplitude: ComplexArray) -> Array:
        """Return the memory (r, k) of harmonic motions at t = 0; see :class:`ogilvie.sim.scheme.Scheme`."""
        return harmonic_states(self.model, omega, velocity, amplitude)

    def advance(self, y: Array, memory: Array, wave: Array, external: Array, at: Interval, out: Array) -> int:
        """Advance in place; see :class:`ogilvie.sim.scheme.Scheme`."""
        return _run(self.step, self.now, y, memory, wave, external, at.row, at.steps, at.first, at.stride, out)


@njit(cache=True, nogil=True, fastmath=FAST)
def _product(matrix, u, out):
    """out = matrix u."""
    for i in range(matrix.shape[0]):
        s = 0.0
        for k in range(matrix.shape[1]):
            s += matrix[i, k] * u[k]
        out[i] = s


@njit(cache=True, nogil=True, fastmath=FAST)
def _run(step, now, y, memory, wave, external, row, steps, first, stride, out):
    n = step.shape[0]
    u, z, more = np.empty(n + 18), np.empty(n), np.empty(12)
    z[:12] = y
    z[12:] = memory
    written = 0
    for i in range(steps):
        u[:n] = z
        for k in range(3):
            for p in range(6):
                u[n + 6 * k + p] = wave[row + 2 * i + k, p] + external[p]
        if (first + i) % stride == 0:
            _product(now, u, more)
            for p in range(12):
                out[written, p] = z[p]
                out[written, 12 + p] = more[p]
            written += 1
        _product(step, u, z)
    y[:] = z[:12]
    memory[:] = z[12:]
    return written
