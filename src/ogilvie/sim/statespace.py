"""Runge-Kutta time stepping of the body with an exact state space of the fluid memory (or none)."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.loads.base import MemoryModel
from ogilvie.sim.dynamics import FAST, combine, pack_mechanics, record, stages
from ogilvie.sim.integrate import memory_step, refuse_unstable_step, step_matrix
from ogilvie.sim.modes import resolvent, sides
from ogilvie.sim.seaway import combine_harmonics
from ogilvie.sim.system import LinearSystem, warn_of_growth

Array = NDArray[Any]
_LANES = 8  # states are padded to whole vector registers


@dataclass(frozen=True, eq=False)
class StateSpaceScheme:
    """Exponential Runge-Kutta method, order 4; the memory runs in real modal form with its inner stages condensed.

    Parameters
    ----------
    dt : float
        s.
    mechanics : (18, 6, 6) array
        See :mod:`ogilvie.sim.dynamics`.
    groups : tuple of arrays
        States that act on the same degrees of freedom, see :func:`ogilvie.sim.modes.sides`.
    places : (g, m) int array
        Stage and degree of freedom, 6 i + p, of each row of the next two; m = 12 for two groups, 24 for one.
    output : (g, m, n) array
        Memory force of the stages that the states determine.
    source : (g, m, n) array
        What the velocities of the stages add to the states.
    bands : (g, 3, n) array
        Diagonals of the transition matrix (below, on, above).
    dense : (g, n, n) array
        What the transition matrix holds off its three diagonals; (g, 0, 0) for a model in modal form.
    model : MemoryModel
    """

    dt: float
    mechanics: Array
    groups: tuple[NDArray[np.intp], ...]
    places: NDArray[np.int64]
    output: Array
    source: Array
    bands: Array
    dense: Array
    model: MemoryModel

    @classmethod
    def of(cls, system: LinearSystem, dt: float) -> "StateSpaceScheme":
        """Return the scheme of a system, or raise :class:`InputError` with the time step that would work."""
        warn_of_growth(system)
        model = system.state_space
        _refuse_unstable(system, model, dt)
        step = memory_step(model.A, model.B, model.C, dt)
        groups = sides(model)
        size = max(len(states) for states, _ in groups)
        size += -size % _LANES
        places = np.array([[6 * i + p for i in range(4) for p in dofs] for _, dofs in groups], dtype=np.int64)
        output, source = np.zeros((2, len(groups), places.shape[1], size))
        transition = np.zeros((len(groups), size, size))
        for g, (states, _) in enumerate(groups):
            n = len(states)
            output[g, :, :n] = step.output.reshape(24, -1)[np.ix_(places[g], states)]
            source[g, :, :n] = step.source.transpose(0, 2, 1).reshape(24, -1)[np.ix_(places[g], states)]
            transition[g, :n, :n] = step.transition[np.ix_(states, states)]
        bands = np.zeros((len(groups), 3, size))
        bands[:, 0, 1:], bands[:, 2, :-1] = (np.diagonal(transition, k, 1, 2) for k in (-1, 1))
        bands[:, 1] = np.diagonal(transition, 0, 1, 2)
        rest = np.triu(transition, 2) + np.tril(transition, -2)
        return cls(
            dt=float(dt),
            mechanics=pack_mechanics(system.inverse_mass, system.stiffness, system.damping, step.coupling),
            groups=tuple(states for states, _ in groups),
            places=places,
            output=output,
            source=source,
            bands=bands,
            dense=rest if rest.any() else np.zeros((len(groups), 0, 0)),
            model=model,
        )

    @property
    def memory_size(self) -> int:
        """Length of the memory vector: for each group a zero, its states, zeros."""
        return len(self.groups) * (self.bands.shape[2] + 2)

    def rest(self, nu: Array) -> Array:
        """Return the memory (r, k) of vessels that were at rest."""
        return np.zeros((len(nu), self.memory_size))

    def steady(self, omega: Array, response: Array, amplitude: Array) -> Array:
        """Return the memory (r, k) of harmonic motions at t = 0; see :class:`ogilvie.sim.scheme.Scheme`."""
        x = harmonic_states(self.model, omega, response, amplitude)
        memory = np.zeros((len(amplitude), len(self.groups), self.bands.shape[2] + 2))
        for g, states in enumerate(self.groups):
            memory[:, g, 1 : 1 + len(states)] = x[:, states]
        return memory.reshape(len(amplitude), -1)

    def advance(
        self,
        y: Array,
        memory: Array,
        wave: Array,
        external: Array,
        *,
        row: int,
        steps: int,
        first: int,
        stride: int,
        out: Array,
    ) -> int:
        """Advance in place; see :class:`ogilvie.sim.scheme.Scheme`."""
        return _run(
            self.dt, self.mechanics, self.places, self.output, self.source, self.bands, self.dense,
            y, memory, wave, external, row, steps, first, stride, out,
        )  # fmt: skip


def _refuse_unstable(system: LinearSystem, model: MemoryModel, dt: float) -> None:
    """Refuse a dt at which the method makes a motion grow that does not grow by itself."""
    natural = max(0.0, float(system.poles.real.max()))

    def growth(h: float) -> float:
        step = memory_step(model.A, model.B, model.C, h)
        R = step_matrix(system.inverse_mass, system.stiffness, system.damping, step, h)
        return float(np.abs(np.linalg.eigvals(R)).max() * np.exp(-natural * h))

    refuse_unstable_step(growth, dt)


def harmonic_states(model: MemoryModel, omega: Array, response: Array, amplitude: Array) -> Array:
    """Return the states (r, n) of the memory at t = 0 that belong to harmonic motions.

    Notes
    -----
    x = Re sum_j a_j (i w_j - A)^-1 B i w_j X_j with the response X (n_w, 6) per unit amplitude and the amplitudes a (r, n_w).
    """
    driven = (1j * omega[:, None] * response) @ model.B.T  # (n_w, n)
    return combine_harmonics(amplitude, resolvent(model.A, omega, driven[..., None])[..., 0])


@njit(cache=True, nogil=True, fastmath=FAST)
def _memory_force(places, output, states, mu):
    """Fill mu (24,): the part of the memory force of each stage that the states at the start of the step determine."""
    for g in range(output.shape[0]):
        for j in range(0, output.shape[1], 6):
            s0 = s1 = s2 = s3 = s4 = s5 = 0.0
            for k in range(output.shape[2]):
                x = states[g, k + 1]
                s0 += output[g, j, k] * x
                s1 += output[g, j + 1, k] * x
                s2 += output[g, j + 2, k] * x
                s3 += output[g, j + 3, k] * x
                s4 += output[g, j + 4, k] * x
                s5 += output[g, j + 5, k] * x
            place = places[g, j : j + 6]
            mu[place[0]], mu[place[1]], mu[place[2]] = s0, s1, s2
            mu[place[3]], mu[place[4]], mu[place[5]] = s3, s4, s5


@njit(cache=True, nogil=True, fastmath=FAST)
def _advance_memory(places, source, bands, dense, v, old, states):
    """Advance the states by one step from the velocities v (24,) of the four stages."""
    for g in range(source.shape[0]):
        for k in range(old.shape[0]):
            old[k] = states[g, k]
        for k in range(source.shape[2]):
            states[g, k + 1] = bands[g, 0, k] * old[k] + bands[g, 1, k] * old[k + 1] + bands[g, 2, k] * old[k + 2]
        for j in range(0, source.shape[1], 6):
            place = places[g, j : j + 6]
            v0, v1, v2, v3, v4, v5 = v[place[0]], v[place[1]], v[place[2]], v[place[3]], v[place[4]], v[place[5]]
            for k in range(source.shape[2]):
                states[g, k + 1] += (
                    (source[g, j, k] * v0 + source[g, j + 1, k] * v1)
                    + (source[g, j + 2, k] * v2 + source[g, j + 3, k] * v3)
                    + (source[g, j + 4, k] * v4 + source[g, j + 5, k] * v5)
                )
        for k in range(dense.shape[1]):
            s = 0.0
            for m in range(dense.shape[1]):
                s += dense[g, k, m] * old[m + 1]
            states[g, k + 1] += s


@njit(cache=True, nogil=True, fastmath=FAST)
def _run(
    dt, mechanics, places, output, source, bands, dense, y, memory, wave, external, row, steps, first, stride, out
):  # fmt: skip
    """Advance `steps` steps; no allocation and no Python inside the loop."""
    eta, v, a, mu = np.empty(6), np.empty((4, 6)), np.empty((4, 6)), np.zeros((4, 6))
    states = memory.reshape(output.shape[0], output.shape[2] + 2)
    old = np.empty(output.shape[2] + 2)
    flat_v, flat_mu = v.reshape(24), mu.reshape(24)
    written = 0
    for i in range(steps):
        _memory_force(places, output, states, flat_mu)
        stages(dt, mechanics, wave, row + 2 * i, external, mu, y, eta, v, a)
        if (first + i) % stride == 0:
            record(out, written, y, a, mu)
            written += 1
        combine(dt, y, v, a)
        _advance_memory(places, source, bands, dense, flat_v, old, states)
    return written
