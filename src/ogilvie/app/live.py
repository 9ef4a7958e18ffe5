"""A case that runs by the clock and sends its states over UDP."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from math import isfinite, radians
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ogilvie.app import build, build_run
from ogilvie.app.case import Case, read_case
from ogilvie.app.console import say, step, stderr, warn
from ogilvie.app.files import collected_warnings
from ogilvie.errors import InputError
from ogilvie.post.broadcast import UdpSender
from ogilvie.post.nmea import Nmea
from ogilvie.post.steady_frame import SteadyFrame
from ogilvie.sim.real_time import run_real_time
from ogilvie.units import knot

if TYPE_CHECKING:
    from ogilvie.sim.state import State
    from ogilvie.sim.stepper import Stepper

#: The status line is written anew after this time, s.
REFRESH = 0.25


@dataclass(frozen=True)
class LiveOptions:
    """Where to send, what and how fast, as the command line has it (deg)."""

    host: str
    port: int
    format: str
    factor: float
    duration: float | None
    rate: float | None
    origin: str
    x_axis: str
    fix: str

    @property
    def formatter(self) -> Any:
        """What turns a state into a datagram."""
        if self.format == "json":
            return "json"
        if self.format != "nmea":
            raise InputError(f"--format: json or nmea expected, {self.format!r} found.")
        if self.x_axis not in ("east", "north"):
            raise InputError(f"--x-axis: east or north expected, {self.x_axis!r} found.")
        if self.fix not in ("simulated", "ordinary"):
            raise InputError(f"--fix: simulated or ordinary expected, {self.fix!r} found.")
        return Nmea(self._origin, x_axis=self.x_axis, simulated=self.fix == "simulated")

    @property
    def _origin(self) -> tuple[float, float]:
        try:
            latitude, longitude = map(float, self.origin.split(","))
        except ValueError:
            latitude = longitude = float("nan")
        if not (abs(latitude) < 90.0 and abs(longitude) <= 180.0):
            raise InputError(f"--origin: LAT,LON in degrees expected (59.90,10.70, say), {self.origin!r} found.")
        return radians(latitude), radians(longitude)

    def sender(self, case: Case) -> UdpSender:
        """Open the socket; the poses sent are those in the world."""
        frame = SteadyFrame(case.vessel.speed_knots * knot, radians(case.vessel.heading_deg))
        return UdpSender(self.host, self.port, format=self.formatter, rate=self.rate, frame=frame)


def live_command(path: Path, options: LiveOptions) -> None:
    """Build the vessel of a case, run it by the clock, send its states, and print how well it kept time.

    Raises
    ------
    InputError
        A case or an option that cannot be used.
    KeyboardInterrupt
        Interrupted before the end of a run that has one; the report has been printed.
    """
    case = read_case(path)
    duration = case.simulation.duration if options.duration is None else options.duration
    if not (duration > 0.0 and options.factor > 0.0 and isfinite(options.factor)):
        raise InputError(
            f"--duration, --factor: positive numbers expected (duration also inf), {duration:g}, {options.factor:g} found."
        )
    with options.sender(case) as sender:
        stepper = make_stepper(case, duration)
        say(f"sending {options.format} to {options.host} port {options.port}, {_length(duration)}; ctrl-C ends it")
        notes: list[str] = []
        with collected_warnings(notes), _status(stepper, duration, options.factor, sender) as status:
            report = run_real_time(stepper, duration, factor=options.factor, listeners=(sender, *status))
        for note in notes:
            warn(note)
        say(str(report))
        say(f"sent              {sender}")
    if report.interrupted and isfinite(duration):
        stop = KeyboardInterrupt()
        stop.add_note(f"{report.simulated:g} s of {duration:g} s were run.")
        raise stop


def make_stepper(case: Case, duration: float) -> "Stepper":
    """Return the stepper of a case in its first realisation, warmed up; a sea lasts as long as the longer of case and run."""
    from ogilvie.sim.stepper import Stepper

    longest = max(case.simulation.duration, duration if isfinite(duration) else 0.0)
    case = replace(case, simulation=case.simulation.model_copy(update={"duration": longest, "realisations": 1}))
    s, notes = case.simulation, list[str]()
    with collected_warnings(notes):
        hull = build.make_hull(case)
        body = build.make_body(case, hull) if case.body is not None else None
        with step("coefficients"):
            hydro = build.make_hydro(case, hull, body)
        body = body or build.make_body(case, hull, hydro)
        with step("fluid memory"):
            K, ssm = build.make_memory(case, hydro, body)
        sea = build_run.make_sea(case, build_run.make_spectrum(case), hydro)
        vessel = build_run.make_vessel(case, body, hydro, K, ssm)
        initial: Any = None if s.initial is None else {"eta": s.initial.eta}
        with step("stepper"):
            stepper = Stepper(vessel, sea, dt=s.dt, ramp=s.ramp, initial=initial, method=s.method)
    for note in notes:
        warn(note)
    return stepper


def _length(duration: float) -> str:
    return f"{duration:g} s" if isfinite(duration) else "without an end"


@contextmanager
def _status(
    stepper: "Stepper", duration: float, factor: float, sender: UdpSender
) -> Iterator[tuple[Callable[["State"], None], ...]]:
    """A listener that keeps one line on a terminal; none elsewhere."""
    if not sys.stderr.isatty():
        yield ()
        return
    from rich.live import Live
    from rich.text import Text

    begin, due = time.perf_counter(), 0.0
    first = stepper.time
    end = f" of {duration:g}" if isfinite(duration) else ""

    def show(state: "State") -> None:
        nonlocal due
        now = time.perf_counter() - begin
        if now < due:
            return
        due = now + REFRESH
        done, angles = state.time - first, 180.0 / 3.141592653589793 * state.eta[3:5]
        behind = now - done / factor
        late = f", [red]{behind:.1f} s behind[/red]" if behind > REFRESH else ""
        lost = f", [red]{sender.errors} lost[/red]" if sender.errors else ""
        line.update(
            Text.from_markup(
                f"t {done:8.1f}{end} s  heave {state.eta[2]:+6.2f} m  roll {angles[0]:+6.2f} deg  pitch {angles[1]:+6.2f} deg"
                f"  {sender.sent} sent{lost}{late}"
            ),
            refresh=True,
        )

    with ExitStack() as stack:
        line = stack.enter_context(Live(Text(), console=stderr(), auto_refresh=False, transient=True))
        yield (show,)
