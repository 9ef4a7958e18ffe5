"""A vessel's state as NMEA 0183 sentences: position, course, heading, rate of turn, attitude."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from functools import cached_property
from math import cos, degrees, hypot, pi, sin

from ogilvie.errors import InputError
from ogilvie.frames import rotation_matrix
from ogilvie.post.geodesy import TangentPlane
from ogilvie.sim.state import State
from ogilvie.units import knot


def sentence(body: str) -> str:
    """Return `$body*hh` with its checksum, the exclusive or of all characters between $ and *, and the line's end.

    Examples
    --------
    >>> sentence("GPGLL,5300.97914,N,00259.98174,E,125926,A")
    '$GPGLL,5300.97914,N,00259.98174,E,125926,A*28\\r\\n'
    """
    check = 0
    for byte in body.encode("ascii"):
        check ^= byte
    return f"${body}*{check:02X}\r\n"


@dataclass(frozen=True)
class Fix:
    """What the sentences say, in their own units: degrees, knots, degrees per minute, metres; positive as NMEA has it."""

    time: datetime
    latitude: float
    longitude: float
    heading: float
    speed: float
    course: float | None
    rate_of_turn: float
    roll: float
    pitch: float
    heave: float
    simulated: bool

    @property
    def mode(self) -> str:
        """Mode indicator: S simulator, A autonomous."""
        return "S" if self.simulated else "A"

    @property
    def clock(self) -> str:
        """UTC as hhmmss.sss."""
        return f"{self.time:%H%M%S}.{self.time.microsecond // 1000:03d}"

    @property
    def place(self) -> str:
        """Four fields: latitude, N or S, longitude, E or W; minutes with six decimals (2 mm)."""
        lat, lon = _minutes(self.latitude, 2), _minutes(self.longitude, 3)
        return f"{lat},{'S' if self.latitude < 0 else 'N'},{lon},{'W' if self.longitude < 0 else 'E'}"

    @property
    def track(self) -> str:
        """Course over ground, or an empty field at rest."""
        return "" if self.course is None else _circle(self.course)


def gga(f: Fix) -> str:
    """Position; the altitude is that of O above the still water."""
    return f"GPGGA,{f.clock},{f.place},{8 if f.simulated else 1},,,{_number(f.heave, 3)},M,,M,,"


def rmc(f: Fix) -> str:
    """Position, speed and course over ground, date. The status of a simulated position is V, as the standard has it."""
    status = "V" if f.simulated else "A"
    return f"GPRMC,{f.clock},{status},{f.place},{_number(f.speed, 3)},{f.track},{f.time:%d%m%y},,,{f.mode}"


def vtg(f: Fix) -> str:
    """Course and speed over ground."""
    return f"GPVTG,{f.track},T,,M,{_number(f.speed, 3)},N,{_number(f.speed * 1.852, 3)},K,{f.mode}"


def hdt(f: Fix) -> str:
    """True heading."""
    return f"HEHDT,{_circle(f.heading)},T"


def rot(f: Fix) -> str:
    """Rate of turn, degrees per minute, positive to starboard."""
    return f"TIROT,{_number(f.rate_of_turn, 2)},A"


def xdr(f: Fix) -> str:
    """Pitch (bow up), roll (port side up), heave (up)."""
    return f"YXXDR,A,{_number(f.pitch, 3)},D,PTCH,A,{_number(f.roll, 3)},D,ROLL,D,{_number(f.heave, 3)},M,HEAV"


def pashr(f: Fix) -> str:
    """Heading, roll (port side up), pitch (bow up), heave (up); accuracies left empty."""
    angles = f"{_circle(f.heading)},T,{_number(f.roll, 2, sign='+')},{_number(f.pitch, 2, sign='+')}"
    return f"PASHR,{f.clock},{angles},{_number(f.heave, 2, sign='+')},,,,1,1"


#: The sentences, in the order in which they are sent.
SENTENCES: dict[str, Callable[[Fix], str]] = {
    "GGA": gga,
    "RMC": rmc,
    "VTG": vtg,
    "HDT": hdt,
    "ROT": rot,
    "XDR": xdr,
    "PASHR": pashr,
}


@dataclass(frozen=True)
class Nmea:
    """Turns states with the pose in the world into NMEA 0183 sentences, all of a state's in one block.

    Parameters
    ----------
    origin : (latitude, longitude)
        Where the world's origin is, rad, positive to the North and the East.
    x_axis : {"east", "north"}
        Where the world's x axis points; y is then North or West.
    sentences : sequence of str
        Which ones, of GGA, RMC, VTG, HDT, ROT, XDR and PASHR.
    start : datetime, optional
        Time of t = 0; without a zone it is UTC. By default the moment when this object is made.
    simulated : bool
        Say in GGA, RMC and VTG that positions are simulated, as the standard asks. Programs that then refuse them get the
        marks of an ordinary fix with False.

    Raises
    ------
    InputError
        Unknown sentence or axis, origin beyond its range.

    Notes
    -----
    Heading: 90 deg - psi (x East) or -psi (x North) at the origin, turned by the convergence of the meridians elsewhere.
    Roll is positive with the port side up in NMEA as here; pitch is positive with the bow **up** there, so theta changes
    its sign; rate of turn is positive to starboard, minus psi'. Angles are those of R = Rz(psi) Ry(theta) Rx(phi).
    Position, speed and course are those of O, wave motion included.

    References
    ----------
    IEC 61162-1 (NMEA 0183). PASHR: the form with time, heading, roll, pitch and heave of the Applanix POS MV and others.

    Examples
    --------
    >>> nmea = Nmea(start=datetime(2024, 1, 1), sentences=["HDT", "XDR"])
    >>> print(nmea(State(eta=[0, 0, 0.5, 0.1, 0.02, 0.0])).decode().replace("\\r", ""), end="")
    $HEHDT,90.000,T*16
    $YXXDR,A,-1.146,D,PTCH,A,5.730,D,ROLL,D,0.500,M,HEAV*4B
    """

    origin: tuple[float, float] = (0.0, 0.0)
    x_axis: str = "east"
    sentences: Sequence[str] = tuple(SENTENCES)
    start: datetime = field(default_factory=lambda: datetime.now(UTC))
    simulated: bool = True

    def __post_init__(self) -> None:
        if self.x_axis not in ("east", "north"):
            raise InputError(f"x_axis: 'east' or 'north' expected, {self.x_axis!r} found.")
        unknown = [name for name in self.sentences if name not in SENTENCES]
        if unknown or not self.sentences or isinstance(self.sentences, str):
            raise InputError(f"sentences: a list out of {', '.join(SENTENCES)} expected, {self.sentences!r} found.")
        if self.start.tzinfo is None:
            object.__setattr__(self, "start", self.start.replace(tzinfo=UTC))
        _ = self._plane

    @cached_property
    def _plane(self) -> TangentPlane:
        return TangentPlane(*self.origin)

    def __call__(self, state: State) -> bytes:
        """Return the sentences of a state, each with its line's end."""
        found = self.fix(state)
        return "".join(sentence(SENTENCES[name](found)) for name in self.sentences).encode("ascii")

    def fix(self, state: State) -> Fix:
        """Return the numbers of the sentences."""
        x, y, z, phi, theta, psi = map(float, state.eta)
        u, v, w, _, q, r = map(float, state.nu)
        R = rotation_matrix(phi, theta, psi)
        vx, vy = (float(row[0] * u + row[1] * v + row[2] * w) for row in R[:2])
        at = self._plane.position(*self._east_north(x, y))
        speed = hypot(vx, vy) / knot
        return Fix(
            time=(self.start + timedelta(milliseconds=round(1e3 * state.time))).astimezone(UTC),
            latitude=degrees(at[0]),
            longitude=degrees(at[1]),
            heading=degrees(self._azimuth(cos(psi), sin(psi), at)),
            speed=speed,
            course=degrees(self._azimuth(vx, vy, at)) if speed >= 0.001 else None,
            rate_of_turn=-60.0 * degrees((sin(phi) * q + cos(phi) * r) / cos(theta)),
            roll=degrees((phi + pi) % (2 * pi) - pi),
            pitch=-degrees(theta),
            heave=z,
            simulated=self.simulated,
        )

    def _east_north(self, x: float, y: float) -> tuple[float, float]:
        return (x, y) if self.x_axis == "east" else (-y, x)

    def _azimuth(self, x: float, y: float, at: tuple[float, float]) -> float:
        return self._plane.azimuth(*self._east_north(x, y), at=at)


def _number(value: float, decimals: int, *, sign: str = "") -> str:
    """A number without the minus of a zero."""
    return f"{round(value, decimals) + 0.0:{sign}.{decimals}f}"


def _circle(angle: float) -> str:
    """An angle from 0.000 to 359.999."""
    return f"{round(angle % 360.0, 3) % 360.0:.3f}"


def _minutes(angle: float, width: int) -> str:
    """Degrees and minutes of an angle without its sign, dddmm.mmmmmm."""
    whole, rest = divmod(round(abs(angle) * 60e6), 60_000_000)
    return f"{whole:0{width}d}{rest // 1_000_000:02d}.{rest % 1_000_000:06d}"
