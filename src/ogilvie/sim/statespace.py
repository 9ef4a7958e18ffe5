"""Runge-Kutta time stepping of the body with an exact state space of the fluid memory (or none)."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.sim.dynamics import COLUMNS, FAST, combine, pack_mechanics, record, stages
from ogilvie.sim.integrate import memory_step, refuse_unstable_step, step_matrix
from ogilvie.sim.packed import PackedMemory, advance_memory, memory_force
from ogilvie.sim.scheme import Interval
from ogilvie.sim.system import LinearSystem, warn_of_growth

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class StateSpaceScheme:
    """Exponential Runge-Kutta method, order 4; the memory runs in real modal form with its inner stages condensed.

    Parameters
    ----------
    dt, speed : float
        s, m/s.
    mechanics : (18, 6, 6) array
        See :mod:`ogilvie.sim.dynamics`.
    packed : PackedMemory
    """

    dt: float
    speed: float
    mechanics: Array
    packed: PackedMemory
    columns: int = COLUMNS

    @classmethod
    def of(cls, system: LinearSystem, dt: float) -> "StateSpaceScheme":
        """Return the scheme of a system, or raise :class:`InputError` with the time step that would work."""
        warn_of_growth(system)
        refuse_unstable(system, dt)
        packed = PackedMemory.of(system.state_space, dt)
        mechanics = pack_mechanics(system.inverse_mass, system.stiffness, system.damping_at_speed, packed.coupling[0])
        return cls(float(dt), system.speed, mechanics, packed)

    @property
    def memory_size(self) -> int:
        """Length of the memory vector."""
        return self.packed.size

    def rest(self, nu: Array) -> Array:
        """Return the memory (r, k) of vessels that were at rest."""
        return np.zeros((len(nu), self.memory_size))

    def steady(self, omega: Array, velocity: Array, amplitude: Array) -> Array:
        """Return the memory (r, k) of harmonic motions at t = 0; see :class:`ogilvie.sim.scheme.Scheme`."""
        return self.packed.steady(omega, velocity, amplitude)

    def advance(self, y: Array, memory: Array, wave: Array, external: Array, at: Interval, out: Array) -> int:
        """Advance in place; see :class:`ogilvie.sim.scheme.Scheme`."""
        p = self.packed
        return _run(
            self.dt, self.speed, self.mechanics, p.places, p.output[0], p.source, p.bands, p.dense,
            y, memory, wave, external, at.row, at.steps, at.first, at.stride, out,
        )  # fmt: skip


def refuse_unstable(system: LinearSystem, dt: float) -> None:
    """Refuse a dt at which the method makes a motion grow that does not grow by itself."""
    natural = max(0.0, float(system.poles.real.max()))
    model = system.state_space

    def growth(h: float) -> float:
        step = memory_step(model.A, model.B, model.C, h)
        R = step_matrix(system.inverse_mass, system.stiffness, system.damping_at_speed, step, h, system.speed)
        return float(np.abs(np.linalg.eigvals(R)).max() * np.exp(-natural * h))

    refuse_unstable_step(growth, dt)


@njit(cache=True, nogil=True, fastmath=FAST)
def _run(
    dt, speed, mechanics, places, output, source, bands, dense, y, memory, wave, external, row, steps, first, stride, out
):  # fmt: skip
    """Advance `steps` steps; no allocation and no Python inside the loop."""
    eta, rate, v, a, mu = np.empty(6), np.empty((4, 6)), np.empty((4, 6)), np.empty((4, 6)), np.zeros((4, 6))
    states = memory.reshape(output.shape[0], output.shape[2] + 2)
    old = np.empty(output.shape[2] + 2)
    flat_v, flat_mu = v.reshape(24), mu.reshape(24)
    written = 0
    for i in range(steps):
        memory_force(places, output, states, flat_mu)
        stages(dt, speed, mechanics, wave, row + 2 * i, external, mu, y, eta, rate, v, a)
        if (first + i) % stride == 0:
            record(out, written, y, a, mu)
            written += 1
        combine(dt, y, rate, a)
        advance_memory(places, source, bands, dense, flat_v, old, states)
    return written
