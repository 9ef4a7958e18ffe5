"""The state space of the fluid memory packed for the time loop: real modal form, groups of states, condensed stages."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.loads.base import MemoryModel
from ogilvie.sim.dynamics import FAST
from ogilvie.sim.integrate import memory_step
from ogilvie.sim.modes import resolvent, sides
from ogilvie.sim.seaway import combine_harmonics

Array = NDArray[Any]
_LANES = 8  # states are padded to whole vector registers


@dataclass(frozen=True, eq=False)
class PackedMemory:
    """One exponential Runge-Kutta step of x' = A x + B nu as arrays for :func:`memory_force` and :func:`advance_memory`.

    Parameters
    ----------
    groups : tuple of arrays
        States that act on the same degrees of freedom, see :func:`ogilvie.sim.modes.sides`.
    places : (g, m) int array
        Stage and degree of freedom, 6 i + p, of each row of the next two; m = 12 for two groups, 24 for one.
    output : (n_out, g, m, n) array
        Forces of the stages that the states determine, for each output matrix.
    coupling : (n_out, 4, 4, 6, 6) array
        What the velocity of an earlier stage adds to them.
    source : (g, m, n) array
        What the velocities of the stages add to the states.
    bands : (g, 3, n) array
        Diagonals of the transition matrix (below, on, above).
    dense : (g, n, n) array
        What the transition matrix holds off its three diagonals; (g, 0, 0) for a model in modal form.
    model : MemoryModel
    """

    groups: tuple[NDArray[np.intp], ...]
    places: NDArray[np.int64]
    output: Array
    coupling: Array
    source: Array
    bands: Array
    dense: Array
    model: MemoryModel

    @classmethod
    def of(cls, model: MemoryModel, dt: float, *more: Array) -> "PackedMemory":
        """Return the step of a model with the outputs C x and, for each matrix (6, n) in `more`, that matrix times x."""
        outputs = (model.C, *more)
        steps = [memory_step(model.A, model.B, C, dt) for C in outputs]
        groups = sides(MemoryModel(model.A, model.B, np.abs(np.array(outputs)).max(axis=0)))
        size = max(len(states) for states, _ in groups)
        size += -size % _LANES
        places = np.array([[6 * i + p for i in range(4) for p in dofs] for _, dofs in groups], dtype=np.int64)
        output = np.zeros((len(outputs), len(groups), places.shape[1], size))
        source, transition = np.zeros(output.shape[1:]), np.zeros((len(groups), size, size))
        for g, (states, _) in enumerate(groups):
            n = len(states)
            for k, step in enumerate(steps):
                output[k, g, :, :n] = step.output.reshape(24, -1)[np.ix_(places[g], states)]
            source[g, :, :n] = steps[0].source.transpose(0, 2, 1).reshape(24, -1)[np.ix_(places[g], states)]
            transition[g, :n, :n] = steps[0].transition[np.ix_(states, states)]
        bands = np.zeros((len(groups), 3, size))
        bands[:, 0, 1:], bands[:, 2, :-1] = (np.diagonal(transition, k, 1, 2) for k in (-1, 1))
        bands[:, 1] = np.diagonal(transition, 0, 1, 2)
        rest = np.triu(transition, 2) + np.tril(transition, -2)
        return cls(
            groups=tuple(states for states, _ in groups),
            places=places,
            output=output,
            coupling=np.array([step.coupling for step in steps]),
            source=source,
            bands=bands,
            dense=rest if rest.any() else np.zeros((len(groups), 0, 0)),
            model=model,
        )

    def turned(self) -> "PackedMemory":
        """Return it with the matrices of `coupling` transposed."""
        return replace(self, coupling=np.ascontiguousarray(self.coupling.swapaxes(-1, -2)))

    @property
    def size(self) -> int:
        """Length of the memory vector: for each group a zero, its states, zeros."""
        return len(self.groups) * (self.bands.shape[2] + 2)

    def steady(self, omega: Array, velocity: Array, amplitude: Array) -> Array:
        """Return the memory (r, k) of harmonic motions at t = 0; see :class:`ogilvie.sim.scheme.Scheme`."""
        x = harmonic_states(self.model, omega, velocity, amplitude)
        memory = np.zeros((len(amplitude), len(self.groups), self.bands.shape[2] + 2))
        for g, states in enumerate(self.groups):
            memory[:, g, 1 : 1 + len(states)] = x[:, states]
        return memory.reshape(len(amplitude), -1)


def harmonic_states(model: MemoryModel, omega: Array, velocity: Array, amplitude: Array) -> Array:
    """Return the states (r, n) of the memory at t = 0 that belong to harmonic motions.

    Notes
    -----
    x = Re sum_j a_j (i w_j - A)^-1 B V_j with the velocities V (n_w, 6) per unit amplitude and the amplitudes a (r, n_w).
    """
    driven = velocity @ model.B.T  # (n_w, n)
    return combine_harmonics(amplitude, resolvent(model.A, omega, driven[..., None])[..., 0])


@njit(cache=True, nogil=True, fastmath=FAST)
def memory_force(places, output, states, mu):
    """Fill mu (24,): the part of the output (g, m, n) of each stage that the states at the start of the step determine."""
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
def advance_memory(places, source, bands, dense, v, old, states):
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
