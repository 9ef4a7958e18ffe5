"""The account that a real-time run gives of itself."""

from dataclasses import dataclass

from ogilvie.sim.latency import Percentiles, readable


@dataclass(frozen=True)
class RealTimeReport:
    """How well a run kept its time.

    Parameters
    ----------
    steps : int
        Steps done.
    simulated, wall : float
        Simulated time, and time on the clock, s.
    dt, factor : float
        Time step, s; simulated seconds per second of the clock.
    missed : int
        States that were ready after their deadline.
    largest_lateness, mean_lateness : float
        Of the missed deadlines, s; 0 where there are none.
    stretches, caught_up : int
        How often the run fell behind, and how often it was on time again afterwards: at most one less.
    longest_behind : float
        Longest time from a first missed deadline to the last before the run was on time again, s.
    final_lateness : float
        Lateness of the last state, s.
    computing, wake_up, output : Percentiles
        Time per step of `on_step` and the stepper, the first step apart; how late after its deadline a wait ended; time of all
        listeners together.
    interrupted : bool
        Whether an interrupt ended the run.
    """

    steps: int
    simulated: float
    wall: float
    dt: float
    factor: float
    missed: int
    largest_lateness: float
    mean_lateness: float
    stretches: int
    caught_up: int
    longest_behind: float
    final_lateness: float
    computing: Percentiles
    wake_up: Percentiles
    output: Percentiles
    interrupted: bool

    def __str__(self) -> str:
        share = 100.0 * self.missed / self.steps if self.steps else 0.0
        lines = [
            f"{self.simulated:.6g} s in {self.steps} steps of {readable(self.dt)}, {self.wall:.6g} s on the clock"
            + (f" ({self.factor:g} x real time)" if self.factor != 1.0 else "")
            + (", interrupted" if self.interrupted else ""),
            f"deadlines missed  {self.missed} ({share:.2g} %){self._lateness()}",
            f"computing         {self.computing}",
            f"wake-up           {self.wake_up}",
        ]
        if self.output.count:
            lines.append(f"output            {self.output}")
        return "\n".join(lines)

    def _lateness(self) -> str:
        if not self.missed:
            return ""
        times = "once" if self.stretches == 1 else f"{self.stretches} times"
        at_end = f"{readable(self.final_lateness)} behind at the end"
        now = "caught up each time" if self.caught_up == self.stretches else at_end
        return (
            f", by {readable(self.largest_lateness)} at most and {readable(self.mean_lateness)} on average; "
            f"behind {times}, for {readable(self.longest_behind)} at the longest, {now}"
        )
