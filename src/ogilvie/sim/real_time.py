"""A simulation that keeps wall-clock time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import inf, isinf
from typing import Any, Protocol

from numpy.typing import ArrayLike

from ogilvie.errors import InputError
from ogilvie.sim.engine import positive
from ogilvie.sim.interrupts import Stop, heeded_interrupts
from ogilvie.sim.latency import Latencies
from ogilvie.sim.pacing import Clock, Pacer
from ogilvie.sim.real_time_report import RealTimeReport
from ogilvie.sim.state import State

Listener = Callable[[State], Any]


class Steppable(Protocol):
    """What goes step by step: :class:`ogilvie.Stepper` and its like."""

    @property
    def dt(self) -> float:
        """Time step, s."""
        ...

    @property
    def state(self) -> State:
        """The present state."""
        ...

    def step(self, external_force: ArrayLike | None = None) -> State:
        """Advance by dt and return the new state."""
        ...


def run_real_time(
    stepper: Steppable,
    duration: float,
    *,
    factor: float = 1.0,
    every: int = 1,
    listeners: Sequence[Listener] = (),
    on_step: Callable[[State], ArrayLike | None] | None = None,
    patience: float = 1.0,
    clock: Clock | None = None,
) -> RealTimeReport:
    """Run a stepper by the clock and tell how well it kept time.

    Parameters
    ----------
    stepper : Stepper
        Goes on from where it is.
    duration : float
        Simulated time, s, rounded to whole steps; inf: until an interrupt.
    factor : float
        Simulated seconds per second of the clock: 1 is real time, 10 ten times as fast.
    every : int
        Listeners hear every so many steps.
    listeners : sequence of callables
        Each is called with the state, at the state's time. What a listener raises ends the run.
    on_step : callable, optional
        Called before each step with the present state; returns the external force on the body during the step (6,), N and
        N m, or None.
    patience : float
        A run that is behind for longer than this, s on the clock, is warned of, once.
    clock : Clock, optional
        Another clock than the computer's.

    Returns
    -------
    RealTimeReport

    Raises
    ------
    InputError
        Duration, factor, every or patience outside their range; what the stepper finds wrong with a force.
    ConvergenceError
        The motion is no longer finite.

    Warns
    -----
    OgilvieWarning
        Behind for longer than `patience`.

    Notes
    -----
    State k is computed at once when state k - 1 has been handed out, and handed out at the deadline start + k dt / factor.
    Deadlines are absolute, so that neither sleeps nor computing make the run drift. Most of a wait is slept, the last half
    millisecond spun. A state that is not ready in time is handed out as soon as it is; no step is ever left out, and what
    comes after it is not waited for until the run has caught up. The first step is computed before the clock starts:
    compilation is no delay.

    An interrupt (ctrl-C) ends the run after the step at hand and gives the report so far; the stepper is left in order. A
    second one ends it at once.

    Examples
    --------
    >>> import numpy as np
    >>> import ogilvie as og
    >>> body = og.RigidBody(mass=2.0, cog=[0, 0, 0], inertia=np.eye(3))
    >>> stepper = og.Stepper(og.Vessel(body, loads=(og.LinearRestoring(np.zeros((6, 6))),)), dt=0.01)
    >>> heard = []
    >>> push = [4.0, 0, 0, 0, 0, 0]
    >>> report = run_real_time(stepper, 0.05, listeners=[heard.append], on_step=lambda state: push, patience=60.0)
    >>> report.steps, report.wall >= 0.05, [round(state.time, 2) for state in heard]
    (5, True, [0.01, 0.02, 0.03, 0.04, 0.05])
    >>> float(stepper.state.nu[0])
    0.1
    """
    dt = float(stepper.dt)
    steps = _number_of_steps(duration, dt)
    positive(factor, "factor", "simulated seconds per second")
    if isinstance(every, bool) or not isinstance(every, int) or every < 1:
        raise InputError(f"every: a whole number of steps >= 1 expected, {every!r} found.")
    if not patience >= 0.0:
        raise InputError(f"patience: a time >= 0 in s expected, {patience!r} found.")
    pacer = Pacer(dt / float(factor), float(patience), clock or Clock())
    loop = _Loop(stepper, pacer, every, tuple(listeners), on_step)
    with heeded_interrupts() as stop:
        try:
            loop.go(steps, stop)
        except KeyboardInterrupt:
            stop.asked = True
    return loop.report(float(factor), interrupted=stop.asked)


@dataclass(eq=False)
class _Loop:
    stepper: Steppable
    pacer: Pacer
    every: int
    listeners: tuple[Listener, ...]
    on_step: Callable[[State], ArrayLike | None] | None
    done: int = 0
    computing: Latencies = field(default_factory=Latencies)
    output: Latencies = field(default_factory=Latencies)

    def go(self, steps: float, stop: Stop) -> None:
        """Step, wait, hand out."""
        now = self.pacer.clock.now
        state = self._advance(None)
        self.pacer.begin()
        while True:
            self.done += 1
            if not self.pacer.keep(self.done, stop):
                return
            if self.listeners and self.done % self.every == 0:
                began = now()
                for listener in self.listeners:
                    listener(state)
                self.output.add(now() - began)
            if self.done >= steps or stop.asked:
                return
            began = now()
            state = self._advance(state)
            self.computing.add(now() - began)

    def _advance(self, state: State | None) -> State:
        if self.on_step is None:
            return self.stepper.step()
        force = self.on_step(self.stepper.state if state is None else state)
        return self.stepper.step() if force is None else self.stepper.step(force)

    def report(self, factor: float, *, interrupted: bool) -> RealTimeReport:
        """The account so far."""
        p = self.pacer
        return RealTimeReport(
            steps=self.done,
            simulated=self.done * self.stepper.dt,
            wall=p.clock.now() - p.start if self.done else 0.0,
            dt=self.stepper.dt,
            factor=factor,
            missed=p.missed,
            largest_lateness=p.largest,
            mean_lateness=p.total / p.missed if p.missed else 0.0,
            stretches=p.stretches,
            caught_up=p.caught_up,
            longest_behind=p.longest,
            final_lateness=p.lateness,
            computing=self.computing.percentiles(),
            wake_up=p.wake_up.percentiles(),
            output=self.output.percentiles(),
            interrupted=interrupted,
        )


def _number_of_steps(duration: float, dt: float) -> float:
    """Whole steps of a duration, or inf."""
    if isinstance(duration, float) and isinf(duration) and duration > 0.0:
        return inf
    positive(duration, "duration", "s")
    steps = round(duration / dt)
    if steps < 1:
        raise InputError(f"duration: at least one step of {dt:g} s expected, {duration:g} s found.")
    return steps
