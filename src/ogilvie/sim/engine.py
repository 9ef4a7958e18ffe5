"""What a simulation and a stepper share: equations, scheme, wave forces in blocks, the initial state."""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.loads.base import FROUDE_KRYLOV, SLOW_DRIFT
from ogilvie.loads.excitation import WaveExcitation
from ogilvie.loads.harmonics import HarmonicGrid
from ogilvie.sim.forces import LoadForce, load_forces
from ogilvie.sim.large import LargeMotions
from ogilvie.sim.large_forces import LargeLoadForce, large_load_forces
from ogilvie.sim.scheme import Scheme, are_large, large_scheme, make_scheme
from ogilvie.sim.seaway import Seaway, combine_harmonics, mean_position, meet
from ogilvie.sim.state import State, as_state
from ogilvie.sim.system import TURNING, LinearSystem, assemble, bind_loads
from ogilvie.sim.vessel import Vessel
from ogilvie.waves.field import Sea

Array = NDArray[Any]
ComplexArray = NDArray[Any]
Initial = State | Mapping[str, Any] | str | None


@dataclass(frozen=True, eq=False)
class Engine:
    """A vessel in a sea, bound to a time step.

    Parameters
    ----------
    system : LinearSystem
    about : LinearSystem
        Of small motions about the steady course, from which a steady start is taken; the same as `system` for small motions.
    scheme : Scheme
    seaway : Seaway or None
    dt, ramp : float
        s; the sea grows from nothing with sin^2 during the ramp, counted from t = 0.
    large : bool
        Whether motions are large: then eta is the pose in the world and nu the whole velocity in body axes.
    """

    system: LinearSystem
    about: LinearSystem
    scheme: Scheme
    seaway: Seaway | None
    dt: float
    ramp: float
    large: bool = False

    @property
    def realisations(self) -> int:
        """Number of realisations of the sea, 1 without a sea."""
        return 1 if self.seaway is None else len(self.seaway.amplitude)

    @cached_property
    def block(self) -> int:
        """Steps per block of wave forces: longer for many components, whose set-up a block pays once."""
        n = 0 if self.seaway is None else len(self.seaway.frequency)
        return 2047 if n <= 300 else 4095 if n <= 1200 else 8191

    @cached_property
    def _grid(self) -> HarmonicGrid:
        assert self.seaway is not None
        return HarmonicGrid(self.seaway.frequency, 0.5 * self.dt, 2 * self.block + 1)

    @cached_property
    def _transfer(self) -> ComplexArray:
        assert self.seaway is not None
        return self.seaway.transfer

    def block_phases(self, block: int, origin: float) -> ComplexArray:
        """Return the phases (n,) that all realisations share in a block."""
        return np.zeros(0, dtype=complex) if self.seaway is None else self._grid.phases(origin + block * self.block * self.dt)

    def wave_series(self, realisation: int, block: int, origin: float, phases: ComplexArray) -> Array:
        """Return force (6), elevation and forces of the loads at half steps through a block, (2 block + 1, 7 or more)."""
        if self.seaway is None:
            return np.zeros((2 * self.block + 1, 7))
        series = self._grid.series(self.seaway.amplitude[realisation] * phases, self._transfer)
        t = origin + block * self.block * self.dt
        grown: Array | float = 1.0
        if t < self.ramp:
            grown = ramp_factor(t + 0.5 * self.dt * np.arange(len(series)), self.ramp)[:, None]
            series *= grown
        if not self.seaway.tables:
            return series
        second = [table.series(realisation, t, 0.5 * self.dt, len(series)) * grown**2 for table in self.seaway.tables]
        series[:, :6] += np.sum(second, axis=0)
        return np.concatenate([series, *second], axis=1)

    @cached_property
    def signals(self) -> tuple[tuple[str, str, str], ...]:
        """Variable, name and unit of what the control laws let record."""
        if not isinstance(self.scheme, LargeMotions):
            return ()
        laws = zip(self.scheme.laws.names, self.scheme.laws.kernels, strict=True)
        named = [(owner, name, unit) for owner, law in laws for name, unit, _ in law.signals]
        return tuple((f"{owner}_{name}".replace(" ", "_"), name, unit) for owner, name, unit in named)

    def load_forces(self) -> Sequence[LoadForce | LargeLoadForce]:
        """Return what evaluates the force of each load from the recorded motion."""
        if isinstance(self.scheme, LargeMotions):
            return large_load_forces(self.system, self.seaway, self.scheme)
        return load_forces(self.system, self.seaway)

    def elevation(self, realisation: int, t: Array, motion: Array) -> Array:
        """Return the elevation (n,) of the undisturbed sea where O is, from recorded rows of large motions."""
        assert self.seaway is not None
        sea = self.seaway.sea if self.seaway.sea.amplitude.ndim == 1 else self.seaway.sea.isel(realisation)
        good = np.isfinite(motion[:, :2]).all(axis=1)
        zeta = np.full(len(t), np.nan)
        zeta[good] = sea.elevation(t[good], motion[good, 0], motion[good, 1])
        return zeta * ramp_factor(t, self.ramp) if self.ramp > 0.0 else zeta

    def explain(self, realisation: int, t: Array, eta: Array, nu: Array) -> str:
        """Return which compiled load is not known where the vessel goes from its last two good rows, or nothing."""
        if not isinstance(self.scheme, LargeMotions):
            return ""
        ahead = np.linspace(0.0, 3.0, 13)
        times, poses, velocities = (x[-1] + np.multiply.outer(ahead, x[-1] - x[0]) for x in (t, eta, nu))
        for which, (name, kernel) in enumerate(zip(self.scheme.forces.names, self.scheme.forces.kernels, strict=True)):
            force = self.scheme.kernel_forces(which, realisation, times, poses, velocities)
            if not np.isfinite(force).all():
                place, heading = np.array2string(eta[-1, :5], precision=4), np.degrees(eta[-1, 5])
                return (
                    f"The load {name} is known for {kernel.limits or 'other poses'} only; the vessel had pose "
                    f"{place} m, rad, heading {heading:.4g} deg and speed {nu[-1, 0]:.4g} m/s."
                )
        return ""

    def start(self, initial: Initial) -> tuple[Array, Array, float]:
        """Return the beginning as :meth:`state_at_start` and tell it to the loads that Python computes."""
        y, memory, time = self.state_at_start(initial)
        if isinstance(self.scheme, LargeMotions):
            if not _brings_memory(initial):
                self.scheme.set_out(y, memory)
            self.scheme.begin(time, y)
        return y, memory, time

    def state_at_start(self, initial: Initial) -> tuple[Array, Array, float]:
        """Return y = (eta, nu) (r, 12), memory (r, k) and time (s) of the beginning.

        Raises
        ------
        InputError
            Unknown kind, wrong shapes, memory of another model, no stationary motion.
        """
        if initial is None:
            initial = "steady" if self.seaway is not None and self.ramp == 0.0 else "rest"
        if isinstance(initial, str):
            if initial not in ("steady", "rest"):
                raise InputError(f"initial: 'steady', 'rest', a State or a mapping expected, {initial!r} found.")
            if initial == "steady" and self.ramp > 0.0:
                raise InputError(
                    "initial: 'steady' needs the full sea from the beginning, a ramp was found. Give ramp=0 or initial='rest'."
                )
            return self._steady() if initial == "steady" else self._given(self._resting())
        if self.large and isinstance(initial, Mapping):
            resting = self._resting()
            initial = {"eta": resting.eta, "nu": resting.nu, **initial}
        return self._given(as_state(initial))

    def _resting(self) -> State:
        """Return the state of a vessel that lies still or sails steadily."""
        if not self.large:
            return State()
        return State([0, 0, 0, 0, 0, self.system.heading], [self.system.speed, 0, 0, 0, 0, 0])

    def _given(self, state: State) -> tuple[Array, Array, float]:
        r = self.realisations
        y = np.empty((r, 12))
        for place, what in ((slice(0, 6), "eta"), (slice(6, 12), "nu")):
            value = getattr(state, what)
            if value.shape not in ((6,), (r, 6)):
                raise InputError(f"initial: {what} of shape (6,){f' or ({r}, 6)' * (r > 1)} expected, {value.shape} found.")
            y[:, place] = value
        if state.memory is None:
            return y, self.scheme.rest(y[:, 6:]), state.time
        k = self.scheme.memory_size
        if state.memory.shape not in ((k,), (r, k)):
            raise InputError(
                f"initial: memory of shape ({k},){f' or ({r}, {k})' * (r > 1)} expected, {state.memory.shape} found. "
                "It holds only for the same memory model, method and dt."
            )
        return y, np.array(np.broadcast_to(state.memory, (r, k))), state.time

    def _steady(self) -> tuple[Array, Array, float]:
        y = np.zeros((self.realisations, 12))
        y[:, :6] = mean_position(self.about)
        if self.seaway is None:
            return self._in_world(y), self.scheme.rest(y[:, 6:]), 0.0
        w, a = self.seaway.frequency, self.seaway.amplitude
        seaway = meet(self.about, self.seaway.sea, large=False) if self.large else self.seaway
        X = seaway.response(self.about)
        V = 1j * w[:, None] * X - self.system.speed * X @ TURNING.T
        y[:, :6] += combine_harmonics(a, X) + self._drifted()
        y[:, 6:] = combine_harmonics(a, V)
        return self._in_world(y), self.scheme.steady(w, V, a), 0.0

    def _drifted(self) -> Array:
        """Return the displacements (r, 6) that balance the mean drift forces where anything does."""
        assert self.seaway is not None
        if not self.seaway.second:
            return np.zeros((self.realisations, 6))
        F = np.array([self.seaway.mean_force(r) for r in range(self.realisations)])
        return np.linalg.lstsq(self.about.stiffness, F.T, rcond=None)[0].T

    def _in_world(self, y: Array) -> Array:
        """Turn displacements from the steady frame, which begins at the origin, into poses and whole velocities."""
        if not self.large:
            return y
        c, s = np.cos(self.system.heading), np.sin(self.system.heading)
        y[:, :2] = y[:, :2] @ np.array([[c, s], [-s, c]])
        y[:, 5] += self.system.heading
        y[:, 6] += self.system.speed
        return y


def make_engine(vessel: Vessel, sea: Sea | None, *, dt: float, method: str, ramp: float, motions: str | None) -> Engine:
    """Bind a vessel and a sea to a time step.

    Raises
    ------
    InputError
        Not a vessel; dt or ramp outside their range; dt beyond stability; a sea that the loads do not cover.
    """
    if not isinstance(vessel, Vessel):
        raise InputError(f"vessel: a Vessel expected, {type(vessel).__name__} found.")
    positive(dt, "dt", "s")
    if not (np.isfinite(ramp) and ramp >= 0.0):
        raise InputError(f"ramp: a time >= 0 in s expected, {ramp!r} found.")
    bound = bind_loads(vessel)
    large = are_large(vessel.names, bound, motions)
    system = assemble(vessel, bound=bound, large=large)
    about = assemble(vessel, bound=bound) if large else system
    seaway = None if sea is None else meet(system, sea, large=large)
    if large:
        _warn_of_drift_twice(vessel, sea)
        scheme: Scheme = large_scheme(system, sea, dt=float(dt), method=method, ramp=float(ramp))
    else:
        scheme = make_scheme(system, float(dt), method)
    return Engine(system, about, scheme, seaway, float(dt), float(ramp), large)


def _warn_of_drift_twice(vessel: Vessel, sea: Sea | None) -> None:
    """First-order forces at the place of the moment hold one part of the drift force that a load of slow drift has too."""
    drift = any(SLOW_DRIFT in load.covers and FROUDE_KRYLOV not in load.covers for load in vessel.loads)
    met = [load for load in vessel.loads if isinstance(load, WaveExcitation) and load.position == "instantaneous"]
    if sea is not None and drift and met:
        warnings.warn(
            "Vessel: a load of slow drift and wave excitation at the place of the moment count part of the mean force twice. "
            "Give WaveExcitation(..., position='slow').",
            OgilvieWarning,
            stacklevel=4,
        )


def _brings_memory(initial: Initial) -> bool:
    if isinstance(initial, State):
        return initial.memory is not None
    return isinstance(initial, Mapping) and initial.get("memory") is not None


def ramp_factor(t: Array, ramp: float) -> Array:
    """Return sin^2(pi t / (2 ramp)) during the ramp and 1 after it."""
    return np.sin(0.5 * np.pi * np.clip(t / ramp, 0.0, 1.0)) ** 2


def positive(value: float, what: str, unit: str) -> None:
    """Raise :class:`InputError` unless the value is a positive finite number."""
    try:
        good = bool(np.isfinite(value) and value > 0.0)
    except TypeError:
        good = False
    if not good:
        raise InputError(f"{what}: a positive number of {unit} expected, {value!r} found.")


def first_step(time: float, dt: float) -> tuple[int, float]:
    """Return the number of the step that begins at a time (s) and the origin of the steps, 0 for a multiple of dt."""
    n = round(time / dt)
    origin = time - n * dt
    return n, 0.0 if abs(origin) < 1e-6 * dt else origin
