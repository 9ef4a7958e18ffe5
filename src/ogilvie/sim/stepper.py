"""Step-by-step simulation, for co-simulation, control and real time."""

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import ConvergenceError, InputError
from ogilvie.sim.engine import Initial, first_step, make_engine
from ogilvie.sim.scheme import Interval
from ogilvie.sim.state import State
from ogilvie.sim.vessel import Vessel
from ogilvie.waves.field import Sea

Array = NDArray[Any]


class Stepper:
    """A simulation that advances one step at a time, with the kernels and the results of :func:`ogilvie.simulate`.

    Parameters
    ----------
    vessel : Vessel
    sea : Sea, optional
        One realisation.
    dt : float
        Time step, s.
    ramp : float
        See :func:`ogilvie.simulate`.
    initial : State, mapping or str, optional
        See :func:`ogilvie.simulate`.
    method : {"rk4", "exact"}
    motions : {"small", "large"}, optional
        See :func:`ogilvie.simulate`.

    Raises
    ------
    InputError
        As :func:`ogilvie.simulate`; a sea with several realisations.

    Examples
    --------
    >>> from ogilvie.body import RigidBody
    >>> from ogilvie.loads.restoring import LinearRestoring
    >>> body = RigidBody(mass=2.0, cog=[0, 0, 0], inertia=np.eye(3))
    >>> stepper = Stepper(Vessel(body, loads=(LinearRestoring(np.zeros((6, 6))),)), dt=0.1)
    >>> state = stepper.step([4.0, 0, 0, 0, 0, 0])
    >>> float(state.nu[0]), state.time
    (0.2, 0.1)
    """

    def __init__(
        self,
        vessel: Vessel,
        sea: Sea | None = None,
        *,
        dt: float = 0.1,
        ramp: float = 0.0,
        initial: Initial = None,
        method: str = "rk4",
        motions: str | None = None,
    ) -> None:
        self._engine = make_engine(vessel, sea, dt=dt, method=method, ramp=ramp, motions=motions)
        if self._engine.realisations > 1:
            raise InputError(f"Stepper: one realisation expected, {self._engine.realisations} found. Take one: sea.isel(0).")
        self._record = np.empty((1, self._engine.scheme.columns))
        self._block = -1
        self._wave = np.zeros((1, 7))
        self.init(initial)

    @property
    def dt(self) -> float:
        """Time step, s."""
        return self._engine.dt

    @property
    def motions(self) -> str:
        """``"small"`` (states about the steady frame) or ``"large"`` (poses in the world)."""
        return "large" if self._engine.large else "small"

    @property
    def time(self) -> float:
        """Time of the present state, s."""
        return self._origin + self._step * self._engine.dt

    @property
    def state(self) -> State:
        """The present state; it does not change when the stepper moves on."""
        return State.unchecked(self._y[:6].copy(), self._y[6:].copy(), self._memory.copy(), self.time)

    def init(self, initial: Initial = None) -> State:
        """Begin (again) from a state, in the steady motion or at rest; return the state."""
        y, memory, time = self._engine.start(initial)
        self._y, self._memory = y[0].copy(), memory[0].copy()
        self._step, origin = first_step(time, self._engine.dt)
        if origin != getattr(self, "_origin", origin):
            self._block = -1
        self._origin = origin
        return self.state

    def step(self, external_force: ArrayLike | None = None) -> State:
        """Advance by dt and return the new state.

        Parameters
        ----------
        external_force : (6,) array, optional
            Force on the body about O, N and N m, constant during the step; it comes on top of the vessel's loads.

        Raises
        ------
        InputError
            Force of another shape, NaN.
        ConvergenceError
            The motion is no longer finite.
        """
        engine = self._engine
        force = engine.system.constant
        if external_force is not None:
            force = force + _six(external_force)
        block = self._step // engine.block
        if block != self._block:
            self._wave = engine.wave_series(0, block, self._origin, engine.block_phases(block, self._origin))
            self._block = block
        row = 2 * (self._step - block * engine.block)
        at = Interval(1, row, number=self._step, origin=self._origin)
        engine.scheme.advance(self._y, self._memory, self._wave, force, at, self._record)
        self._step += 1
        if not np.isfinite(self._y).all():
            raise ConvergenceError(
                f"Stepper: the motion is no longer finite after {self.time:g} s. Check the external force and dt."
            )
        return self.state

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the present state to a file, bit-exact."""
        self.state.save(Path(path))

    def restore(self, source: State | str | os.PathLike[str]) -> State:
        """Return to a state that :attr:`state` or :meth:`save` gave; the run goes on from there bit for bit."""
        return self.init(source if isinstance(source, State) else State.load(Path(source)))


def _six(force: ArrayLike) -> Array:
    value = np.asarray(force, dtype=float)
    if value.shape != (6,) or not np.isfinite(value).all():
        raise InputError(f"external_force: six finite numbers (N, N m) expected, {force!r} found.")
    return value
