"""States sent over UDP while a simulation runs."""

import json
import socket
from collections.abc import Callable
from math import floor
from types import TracebackType
from typing import Any

from ogilvie.errors import InputError
from ogilvie.post.nmea import Nmea
from ogilvie.post.steady_frame import SteadyFrame
from ogilvie.sim.engine import positive
from ogilvie.sim.state import State

#: Version of the JSON lines: a number that changes when a field changes its meaning or goes.
JSON_VERSION = 1

Format = Callable[[State], bytes | str]


def json_line(state: State) -> bytes:
    """Return a state as one line of JSON: version, t (s), eta (m, rad) and nu (m/s, rad/s) as they are, bit for bit.

    Examples
    --------
    >>> json_line(State(nu=[1.5, 0, 0, 0, 0, 0], time=0.1))
    b'{"version":1,"t":0.1,"eta":[0.0,0.0,0.0,0.0,0.0,0.0],"nu":[1.5,0.0,0.0,0.0,0.0,0.0]}\\n'
    """
    content = {"version": JSON_VERSION, "t": state.time, "eta": state.eta.tolist(), "nu": state.nu.tolist()}
    return json.dumps(content, separators=(",", ":")).encode("ascii") + b"\n"


class UdpSender:
    """A listener of :func:`ogilvie.run_real_time` that sends each state as one UDP datagram.

    Parameters
    ----------
    host : str
        Name or address of the receiver, or of all in a network (a broadcast address).
    port : int
        1 to 65535; 10110 is the one registered for NMEA 0183.
    format : "json", "nmea" or callable
        :func:`json_line`; all sentences of :class:`ogilvie.post.nmea.Nmea` with its defaults (give an ``Nmea(...)`` for
        an origin and other choices); or a function from the state to bytes or text.
    rate : float, optional
        At most so many datagrams per second of simulated time, evenly; by default every state.
    frame : SteadyFrame, optional
        Of a vessel whose states are motions about its steady frame: sent is the pose in the world.

    Raises
    ------
    InputError
        A host that has no address; port, rate or format outside what they can be.

    Notes
    -----
    Sending never waits: a datagram that the system does not take, or a state that cannot be put into the format, is lost,
    counted and told by :attr:`errors`, :attr:`last_error` and ``str(sender)``. That nobody listens is no error: UDP does
    not know.

    Examples
    --------
    >>> receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    >>> receiver.bind(("127.0.0.1", 0))
    >>> with UdpSender("127.0.0.1", receiver.getsockname()[1]) as sender:
    ...     sender(State(time=2.5))
    >>> json.loads(receiver.recv(2048))["t"], sender.sent
    (2.5, 1)
    >>> receiver.close()
    """

    def __init__(
        self,
        host: str,
        port: int,
        *,
        format: str | Format = "json",
        rate: float | None = None,
        frame: SteadyFrame | None = None,
    ) -> None:
        if isinstance(port, bool) or not isinstance(port, int) or not 1 <= port <= 65535:
            raise InputError(f"port: a whole number from 1 to 65535 expected, {port!r} found.")
        if rate is not None:
            positive(rate, "rate", "datagrams per second")
        self._format = _formatter(format)
        self._rate, self._slot, self._frame = rate, None, frame  # type: float | None, int | None, SteadyFrame | None
        family, self._address = _resolved(host, port)
        self._socket = socket.socket(family, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        if family == socket.AF_INET:
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
        self.sent = 0  #: datagrams that the system took
        self.errors = 0  #: states that were to be sent and were not
        self.last_error = ""  #: what the last of the errors was

    def __call__(self, state: State) -> None:
        """Send a state if its turn has come."""
        if self._rate is not None:
            slot = floor(state.time * self._rate + 1e-6)
            if slot == self._slot:
                return
            self._slot = slot
        try:
            content = self._format(state if self._frame is None else self._frame.in_world(state))
            self._socket.sendto(content.encode() if isinstance(content, str) else content, self._address)
        except Exception as error:  # whatever a format or the system does, the simulation goes on
            self.errors += 1
            self.last_error = f"{type(error).__name__}: {error}"
        else:
            self.sent += 1

    def __str__(self) -> str:
        lost = f", {self.errors} lost, the last by {self.last_error}" if self.errors else ""
        return f"{self.sent} datagrams sent to {self._address[0]} port {self._address[1]}{lost}"

    def close(self) -> None:
        """Close the socket; what is sent afterwards counts as an error."""
        self._socket.close()

    def __enter__(self) -> "UdpSender":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()


def _formatter(format: str | Format) -> Format:
    if callable(format):
        return format
    if format == "json":
        return json_line
    if format == "nmea":
        return Nmea()
    raise InputError(f"format: 'json', 'nmea' or a function of the state expected, {format!r} found.")


def _resolved(host: str, port: int) -> tuple[socket.AddressFamily, Any]:
    """Address family and address of a host, IPv4 first."""
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)
    except (OSError, UnicodeError, TypeError) as error:
        raise InputError(f"host: a name or address that can be found expected, {host!r} found ({error}).") from None
    family, _, _, _, address = min(found, key=lambda one: one[0] != socket.AF_INET)
    return family, address
