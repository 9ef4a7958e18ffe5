"""Deadlines on a clock: waiting for them, and the account of those that were missed."""

import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field

from ogilvie.errors import OgilvieWarning
from ogilvie.sim.latency import Latencies, readable

#: The last part of a wait is spun away, because a sleep ends late by about a tenth of this, s; other threads get their turn
#: in it but for its own last part, which is shorter than such a turn takes.
SPIN, ALONE = 5e-4, 1e-4
#: A sleep is cut into pieces of this length at most, so that a wish to stop is heard, s.
SLICE = 0.1


@dataclass(frozen=True)
class Clock:
    """A clock and how to let it go on.

    Parameters
    ----------
    now : callable
        Returns the time, s; it never goes back.
    sleep : callable
        Returns after about so many seconds; 0 gives way to other threads.
    """

    now: Callable[[], float] = time.perf_counter
    sleep: Callable[[float], None] = time.sleep


@dataclass(eq=False)
class Pacer:
    """Deadlines at start + k period for k = 1, 2, ...: absolute, so that no error adds up.

    Parameters
    ----------
    period : float
        s.
    patience : float
        Being behind for longer than this is warned of, once, s.
    clock : Clock

    Examples
    --------
    >>> pacer = Pacer(period=1e-3, patience=1.0)
    >>> pacer.begin()
    >>> pacer.keep(5, lambda: False)
    True
    >>> pacer.clock.now() - pacer.start >= 5e-3
    True
    """

    period: float
    patience: float
    clock: Clock = field(default_factory=Clock)
    start: float = 0.0
    missed: int = 0
    largest: float = 0.0
    total: float = 0.0
    stretches: int = 0
    caught_up: int = 0
    longest: float = 0.0
    lateness: float = 0.0
    wake_up: Latencies = field(default_factory=Latencies)
    _since: float | None = None
    _warned: bool = False

    def begin(self) -> None:
        """Start the clock: the first deadline is one period from now."""
        self.start = self.clock.now()

    def keep(self, k: int, stopping: Callable[[], bool]) -> bool:
        """Wait for deadline k, or go on at once and note the lateness if it has passed; return False if told to stop."""
        deadline = self.start + k * self.period
        now = self.clock.now()
        if now > deadline:
            self._late(now, deadline)
            return True
        if self._since is not None:
            self.caught_up += 1
            self._since = None
        self.lateness = 0.0
        return self._wait(deadline, stopping)

    def _wait(self, deadline: float, stopping: Callable[[], bool]) -> bool:
        now, sleep = self.clock.now, self.clock.sleep
        while (rest := deadline - now()) > SPIN:
            if stopping():
                return False
            sleep(min(rest - SPIN, SLICE))
        while (late := now() - deadline) < 0.0:
            if late < -ALONE:
                sleep(0.0)
        self.wake_up.add(late)
        return True

    def _late(self, now: float, deadline: float) -> None:
        self.lateness = now - deadline
        self.missed += 1
        self.total += self.lateness
        self.largest = max(self.largest, self.lateness)
        if self._since is None:
            self._since = deadline
            self.stretches += 1
        behind = now - self._since
        self.longest = max(self.longest, behind)
        if behind > self.patience and not self._warned:
            self._warned = True
            warnings.warn(
                f"real time: behind for {readable(behind)}, {readable(self.lateness)} at present; no step is left out. "
                f"A step has {readable(self.period)}: take a larger dt, a smaller factor or a quieter machine.",
                OgilvieWarning,
                stacklevel=4,
            )
