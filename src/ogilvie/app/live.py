"""A case that runs by the clock and sends its states over UDP."""

import sys
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from math import degrees, isfinite, radians
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ogilvie.app import build, build_run
from ogilvie.app.build_memory import make_memory
from ogilvie.app.case import Case, read_case
from ogilvie.app.console import say, stderr, step, warn
from ogilvie.app.files import collected_warnings
from ogilvie.app.foresight import foresee, foresee_data
from ogilvie.errors import InputError, OgilvieWarning
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
            given = {"origin": self.origin != "0,0", "x-axis": self.x_axis != "east", "fix": self.fix != "simulated"}
            for option in (name for name, is_given in given.items() if is_given):
                raise InputError(f"--{option}: only with --format nmea; json has the pose in the world. Remove it.")
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

    def sender(self, case: Case, motions: str) -> UdpSender:
        """Open the socket; the poses sent are those in the world."""
        frame = None
        if motions == "small":
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
    _ = options.formatter  # a mistake in the options is told before the long work
    stepper = make_stepper(case, duration)
    with options.sender(case, stepper.motions) as sender:
        say(f"sending {options.format} to {options.host} port {options.port}, {_length(duration)}; ctrl-C ends it")
        with _told_at_once(), _status(stepper, duration, options.factor, sender) as status:
            report = run_real_time(stepper, duration, factor=options.factor, listeners=(sender, *status))
        say(str(report))
        say(f"sent              {sender}")
    if report.interrupted and isfinite(duration):
        stop = KeyboardInterrupt()
        stop.add_note(f"{report.simulated:g} s of {duration:g} s were run.")
        raise stop


def make_stepper(case: Case, duration: float) -> "Stepper":
    """Return the stepper of a case in its first realisation; the sea lasts as long as the longer of case and run."""
    from ogilvie.sim.stepper import Stepper

    longest = max(case.simulation.duration, duration if isfinite(duration) else 0.0)
    case = replace(case, simulation=case.simulation.model_copy(update={"duration": longest, "realisations": 1}))
    s, notes = case.simulation, list[str]()
    with collected_warnings(notes):
        hull = build.make_hull(case)
        foresee(case, hull)
        body = build.make_body(case, hull) if case.body is not None else None
        with step("coefficients"):
            hydro = build.make_hydro(case, hull, body)
        foresee_data(case, hydro)
        body = body or build.make_body(case, hull, hydro)
        with step("fluid memory"):
            K, ssm = make_memory(case, hydro, body)
        sea = build_run.make_sea(case, build_run.make_spectrum(case), hydro)
        vessel = build_run.finished_vessel(case, body, hydro, K, ssm, hull=hull, sea=sea)
        options: Any = {"method": s.method, "motions": build_run.motions(case), "initial": build_run.initial(case)}
        with step("stepper"):
            stepper = Stepper(vessel, sea, dt=s.dt, ramp=s.ramp, **options)
    for note in notes:
        warn(note)
    return stepper


def _length(duration: float) -> str:
    return f"{duration:g} s" if isfinite(duration) else "without an end"


@contextmanager
def _told_at_once() -> Iterator[None]:
    """Print the package's own warnings when they come."""
    with warnings.catch_warnings():
        warnings.simplefilter("always", OgilvieWarning)
        others = warnings.showwarning

        def show(message: Any, category: type[Warning], *where: Any, **more: Any) -> None:
            if issubclass(category, OgilvieWarning):
                warn(str(message))
            else:
                others(message, category, *where, **more)

        warnings.showwarning = show
        yield


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

    first, end = stepper.time, f" of {duration:g}" if isfinite(duration) else ""
    with Live(Text(), console=stderr(), auto_refresh=False, transient=True) as line:
        begin, due = time.perf_counter(), 0.0

        def show(state: "State") -> None:
            nonlocal due
            now = time.perf_counter() - begin
            if now < due:
                return
            due, done = now + REFRESH, state.time - first
            behind = now - done / factor
            late = f", {behind:.1f} s behind" if behind > REFRESH else ""
            line.update(Text(f"t {done:.1f}{end} s  {_motions(state)}  {sender.sent} sent{_lost(sender)}{late}"), refresh=True)

        yield (show,)


def _motions(state: "State") -> str:
    heave, roll, pitch = float(state.eta[2]), degrees(state.eta[3]), degrees(state.eta[4])
    return f"heave {heave:+.2f} m, roll {roll:+.2f} deg, pitch {pitch:+.2f} deg"


def _lost(sender: UdpSender) -> str:
    return f", {sender.errors} lost" if sender.errors else ""
