"""Time stepping of a vessel in large motions: any heading, speed, roll and pitch, any compiled load, control."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numba import types
from numba.typed import List
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import MemoryKernel
from ogilvie.loads.kernel import ETA, MEAN_SPEED, NU, NU_R, SIGNATURE, SITUATION, SLOW, Callback, Kernel, Sampled
from ogilvie.sim.large_kernel import LARGE_COLUMNS, SLOW_STATES, add_kernels, run_large, situate
from ogilvie.sim.packed import PackedMemory
from ogilvie.sim.scheme import Interval
from ogilvie.sim.statespace import refuse_unstable
from ogilvie.sim.system import LinearSystem, added_mass_at_rest, momentum_output, warn_of_growth

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Compiled:
    """Compiled loads of one vessel, one after the other.

    Parameters
    ----------
    names : tuple of str
        Of the loads.
    kernels : tuple of Kernel or Sampled
    """

    names: tuple[str, ...]
    kernels: tuple[Any, ...]

    @classmethod
    def of(cls, pairs: Sequence[tuple[str, Kernel | Sampled]]) -> "Compiled":
        """Return them from pairs of name and kernel."""
        return cls(tuple(name for name, _ in pairs), tuple(kernel for _, kernel in pairs))

    @cached_property
    def functions(self) -> Any:
        """Typed list of the compiled functions."""
        functions = List.empty_list(types.FunctionType(SIGNATURE))
        for kernel in self.kernels:
            functions.append(kernel.function)
        return functions

    @cached_property
    def data(self) -> Array:
        """Numbers of all of them, one after the other."""
        return np.concatenate([np.zeros(0), *[k.data for k in self.kernels]])

    @cached_property
    def data_ranges(self) -> NDArray[np.int64]:
        """Where the numbers of each begin and end (n, 2)."""
        return _ranges([len(k.data) for k in self.kernels])


@dataclass(frozen=True, eq=False)
class LargeMotions:
    """Exponential Runge-Kutta method of order 4 for the equations of :mod:`ogilvie.sim.large_kernel`.

    Parameters
    ----------
    dt : float
        s.
    frame : (15,) array
        Speed U, heading psi_0, current in the world (3), constant force in the steady frame (6), cos psi_0, sin psi_0, A_11(0)
        and A_51(0) or zero for U = 0.
    matrices : (5, 6, 6) array
        (M + A)^-1, M, A, D, C, each transposed.
    packed : PackedMemory
        With the outputs mu and p_m.
    forces, laws : Compiled
        Compiled forces; control laws, the last of them held forces of `callbacks`.
    callbacks : tuple of Callback
    table : (n, 5) int array
        Of the control laws: their data from, to; their memory from, to; steps between samples.
    """

    dt: float
    frame: Array
    matrices: Array
    packed: PackedMemory
    forces: Compiled
    laws: Compiled
    callbacks: tuple[Callback, ...]
    table: NDArray[np.int64]

    @classmethod
    def of(
        cls, system: LinearSystem, dt: float, forces: Compiled, laws: Compiled, callbacks: Sequence[Callback] = ()
    ) -> "LargeMotions":
        """Return the scheme of a system, or raise :class:`InputError` where it cannot serve it with this dt."""
        if isinstance(system.memory, MemoryKernel):
            raise InputError(
                "large motions: a state-space memory expected, a Convolution found. Use StateSpaceRadiation(identify(K)), "
                "or leave out what is not linear and simulate small motions."
            )
        current = np.sum([t.current for t in system.terms], axis=0) if system.terms else np.zeros(3)
        A_0 = added_mass_at_rest(system)
        ahead = A_0[[0, 4], 0] if system.speed > 0.0 else np.zeros(2)
        frame = steady_frame(system.speed, system.heading, current, system.constant, ahead)
        parts = (system.inverse_mass, system.body_mass, system.added_mass, system.damping, system.stiffness)
        matrices = np.ascontiguousarray(np.array(parts, dtype=float).transpose(0, 2, 1))
        packed = PackedMemory.of(system.memory, dt, momentum_output(system.memory)).turned()
        table = _sampling(laws, SLOW_STATES + packed.size, dt)
        scheme = cls(float(dt), frame, matrices, packed, forces, laws, tuple(callbacks), table)
        scheme._refuse_unstable(system)
        return scheme

    @property
    def columns(self) -> int:
        """Length of a row of output: eta, nu, acceleration, radiation, mean speed, slow pose, held forces, signals."""
        return LARGE_COLUMNS + 6 * len(self.table) + len(self.signals)

    @property
    def memory_size(self) -> int:
        """Length of the memory vector: mean speed and slow pose, fluid, then held force and memory of each control law."""
        return int(self.table[-1, 3]) if len(self.table) else SLOW_STATES + self.packed.size

    @cached_property
    def signals(self) -> NDArray[np.int64]:
        """Places in the memory vector that are recorded as signals of the control laws."""
        places = [
            int(begin) + 6 + slot
            for law, begin in zip(self.laws.kernels, self.table[:, 2], strict=True)
            for _, _, slot in law.signals
        ]
        return np.array(places, dtype=np.int64)

    @cached_property
    def ranges(self) -> NDArray[np.int64]:
        """Where the numbers of each compiled force lie in `data` and in `own` (n, 4)."""
        own = _ranges([k.own.shape[1] for k in self.forces.kernels])
        return np.ascontiguousarray(np.concatenate([self.forces.data_ranges, own], axis=1))

    @cached_property
    def own(self) -> tuple[Array, ...]:
        """Numbers of each realisation, those of all forces one after the other; the last serves those that follow."""
        count = max([1, *[len(k.own) for k in self.forces.kernels]])
        rows = [[k.own[min(r, len(k.own) - 1)] for k in self.forces.kernels] for r in range(count)]
        return tuple(np.concatenate([np.zeros(0), *row]) for row in rows)

    def rest(self, nu: Array) -> Array:
        """Return the memory (r, k) of vessels that sailed steadily; see :class:`ogilvie.sim.scheme.Scheme`."""
        return self._controlled(np.zeros((len(nu), self.packed.size)))

    def steady(self, omega: Array, velocity: Array, amplitude: Array) -> Array:
        """Return the memory (r, k) of harmonic motions at t = 0; see :class:`ogilvie.sim.scheme.Scheme`."""
        return self._controlled(self.packed.steady(omega, velocity, amplitude))

    def set_out(self, y: Array, memory: Array) -> None:
        """Let mean speed and slow pose begin with the states y (r, 12): what has been there before is not known."""
        c, s = np.cos(y[:, 5]), np.sin(y[:, 5])
        memory[:, 0] = y[:, 6] - (c * self.frame[2] + s * self.frame[3])
        memory[:, 1:4] = y[:, [0, 1, 5]]
        memory[:, 4:7] = np.stack([c * y[:, 6] - s * y[:, 7], s * y[:, 6] + c * y[:, 7], y[:, 11]], axis=1)

    def advance(self, y: Array, memory: Array, wave: Array, external: Array, at: Interval, out: Array) -> int:
        """Advance in place; see :class:`ogilvie.sim.scheme.Scheme`."""
        p = self.packed
        fixed = (
            self.dt, self.frame, self.matrices, p.places, p.output, p.coupling, p.source, p.bands, p.dense,
            self.forces.functions, self.ranges, self.forces.data, self.own[min(at.realisation, len(self.own) - 1)],
            self.laws.functions, self.table, self.laws.data, self.signals, y, memory, wave, external,
        )  # fmt: skip
        if not self.callbacks:
            return run_large(*fixed, at.row, at.steps, at.first, at.stride, at.number, at.origin, out)
        called = [(call, int(row[2]), int(row[4])) for call, row in zip(self.callbacks, self._called, strict=True)]
        done, written, number, end = 0, 0, at.number, at.number + at.steps
        while number < end:
            t, steps = at.origin + number * self.dt, end - number
            for callback, begin, every in called:
                if number % every == 0:
                    memory[begin : begin + 6] = callback.function(t, y[:6], y[6:])
                steps = min(steps, every - number % every)
            first = at.first + done
            written += run_large(*fixed, at.row + 2 * done, steps, first, at.stride, number, at.origin, out[written:])
            done += steps
            number += steps
        return written

    @property
    def _called(self) -> NDArray[np.int64]:
        """Rows of the table that belong to the Python forces."""
        return self.table[len(self.table) - len(self.callbacks) :]

    def begin(self, t: float, y: Array) -> None:
        """Tell the Python forces where the vessel starts, y (r, 12).

        Raises
        ------
        InputError
            A force with a state of its own for several realisations.
        """
        for name, callback in zip(self.laws.names[len(self.table) - len(self.callbacks) :], self.callbacks, strict=True):
            if callback.alone and len(y) > 1:
                raise InputError(f"{name}: one realisation at a time expected, since it keeps a state; {len(y)} found.")
            if callback.begin is not None:
                callback.begin(t, y[0, :6].copy(), y[0, 6:].copy())

    def kernel_forces(self, which: int, realisation: int, t: Array, eta: Array, nu: Array, slow: Array | None = None) -> Array:
        """Return the force (n, 6) of one compiled load at times t (n,), poses and velocities (n, 6).

        slow (n, 4) holds mean speed and slow pose; those of the moment without it.
        """
        kernel, one = self.forces.kernels[which], self._each[which]
        own = kernel.own[min(realisation, len(kernel.own) - 1)]
        force, x, trig = np.zeros((len(t), 6)), np.zeros(SITUATION), np.zeros(4)
        ranges = np.array([[0, len(kernel.data), 0, len(own)]], dtype=np.int64)
        for i in range(len(t)):
            x[ETA:NU], x[NU : NU + 6] = eta[i], nu[i]
            situate(t[i], self.frame[2:5], x, trig)
            now = (x[NU_R], x[ETA], x[ETA + 1], x[ETA + 5])
            x[MEAN_SPEED : SLOW + 3] = now if slow is None else slow[i]
            add_kernels(one.functions, ranges, one.data, own, x, force[i])
        return force

    @cached_property
    def _each(self) -> tuple[Compiled, ...]:
        """Every compiled force by itself; a list of functions takes a tenth of a second to make."""
        pairs = zip(self.forces.names, self.forces.kernels, strict=True)
        return tuple(Compiled((name,), (kernel,)) for name, kernel in pairs)

    def _controlled(self, memory: Array) -> Array:
        """Put the slow states before the memory of the fluid, held forces and memories of the control laws after it."""
        start = np.concatenate([np.zeros(0), *[np.r_[np.zeros(6), law.memory] for law in self.laws.kernels]])
        slow = np.zeros((len(memory), SLOW_STATES))
        return np.concatenate([slow, memory, np.broadcast_to(start, (len(memory), len(start)))], axis=1)

    def _refuse_unstable(self, system: LinearSystem) -> None:
        """Check dt on the motions about the steady course, with the compiled forces linearised there."""
        F_eta, F_nu = self._slopes()
        about = replace(system, stiffness=system.stiffness - F_eta, damping=system.damping - F_nu)
        if not len(self.table):
            warn_of_growth(about)
        refuse_unstable(about, self.dt)

    def _slopes(self) -> tuple[Array, Array]:
        """Derivatives (6, 6) of the compiled forces by eta and nu on the steady course."""
        slopes = np.zeros((2, 6, 6))
        course = np.zeros((2, 6))
        course[0, 5], course[1, 0] = self.frame[1], self.frame[0]
        for which in [k for k, kernel in enumerate(self.forces.kernels) if kernel.steady]:
            for part, i in np.ndindex(2, 6):
                h = 1e-4 * (1.0 if i < 3 else 0.1)
                step = np.zeros((2, 2, 6))
                step[:, part, i] = h, -h
                at = course + step
                force = self.kernel_forces(which, 0, np.zeros(2), at[:, 0], at[:, 1])
                slopes[part, :, i] += (force[0] - force[1]) / (2.0 * h)
        slopes = np.nan_to_num(slopes)  # a kernel beyond its data tells so when it is met in the run
        c, s = np.cos(self.frame[1]), np.sin(self.frame[1])
        slopes[0, :, :2] = slopes[0, :, :2] @ np.array([[c, -s], [s, c]])
        return slopes[0], slopes[1]


def steady_frame(speed: float, heading: float, current: Array, constant: Array, ahead: Array) -> Array:
    """Return the array `frame` of the kernels."""
    return np.concatenate([[speed, heading], current, constant, [np.cos(heading), np.sin(heading)], ahead])


def _ranges(lengths: Sequence[int]) -> NDArray[np.int64]:
    ends = np.cumsum([0, *lengths])
    return np.stack([ends[:-1], ends[1:]], axis=1).astype(np.int64)


def _sampling(laws: Compiled, begin: int, dt: float) -> NDArray[np.int64]:
    """Return the table of the control laws whose memories follow one another from `begin`."""
    table = np.zeros((len(laws.kernels), 5), dtype=np.int64)
    table[:, :2] = laws.data_ranges
    for k, (name, law) in enumerate(zip(laws.names, laws.kernels, strict=True)):
        every = round(law.period / dt)
        if every < 1 or abs(every * dt - law.period) > 1e-6 * dt:
            raise InputError(
                f"{name}: a sampling period that is a multiple of dt = {dt:g} s expected, {law.period:g} s found. "
                "Change one of them."
            )
        end = begin + 6 + len(law.memory)
        table[k, 2:] = begin, end, every
        begin = end
    return table
