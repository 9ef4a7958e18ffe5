"""Time stepping schemes: what they share, and the one place that chooses among them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import MemoryKernel, Terms
from ogilvie.sim.system import LinearSystem
from ogilvie.waves.field import Sea

Array = NDArray[Any]
ComplexArray = NDArray[Any]
METHODS = ("rk4", "exact")
MOTIONS = ("small", "large")


@dataclass(frozen=True)
class Interval:
    """Steps that a scheme advances.

    Parameters
    ----------
    steps : int
        How many.
    row : int
        Row of the table of wave forces at the first of them.
    first, stride : int
        A row of output is written for each step whose number, counted from `first`, is a multiple of `stride`.
    number, origin : int, float
        The first step begins at the time origin + number dt, s.
    realisation : int
    """

    steps: int
    row: int = 0
    first: int = 0
    stride: int = 1
    number: int = 0
    origin: float = 0.0
    realisation: int = 0


class Scheme(Protocol):
    """A time stepping scheme bound to a system and a time step.

    The state of one vessel is y = (eta, nu) (12,) and a flat memory vector; both are advanced in place.
    """

    @property
    def columns(self) -> int:
        """Length of a row of output."""
        ...

    @property
    def memory_size(self) -> int:
        """Length of the memory vector."""
        ...

    def rest(self, nu: Array) -> Array:
        """Return the memory (r, k) of vessels at rest until t = 0, when they have the velocities nu (r, 6)."""
        ...

    def steady(self, omega: Array, velocity: ComplexArray, amplitude: ComplexArray) -> Array:
        """Return the memory (r, k) at t = 0 of the velocities Re sum_j amplitude_rj velocity_j exp(i omega_j t)."""
        ...

    def advance(self, y: Array, memory: Array, wave: Array, external: Array, at: Interval, out: Array) -> int:
        """Advance through an interval and return how many rows were written to `out` (rows, columns).

        `wave` (k, 6 or more) holds the wave force at half steps in its first columns; `external` (6,) is constant. A row
        (eta, nu, acceleration, memory force ...) is written at the start of each step that the interval names.
        """
        ...


def make_scheme(system: LinearSystem, dt: float, method: str) -> Scheme:
    """Return the scheme of a method, or raise :class:`InputError` where it cannot serve the system with this dt."""
    from ogilvie.sim.convolution import ConvolutionScheme
    from ogilvie.sim.exact import ExactScheme
    from ogilvie.sim.statespace import StateSpaceScheme

    if method not in METHODS:
        raise InputError(f"method: one of {', '.join(METHODS)} expected, {method!r} found.")
    if isinstance(system.memory, MemoryKernel):
        if method == "exact":
            raise InputError(
                "method: 'exact' needs a state-space memory, a Convolution was found. Use method='rk4' or StateSpaceRadiation."
            )
        return ConvolutionScheme.of(system, dt)
    return ExactScheme.of(system, dt) if method == "exact" else StateSpaceScheme.of(system, dt)


def are_large(names: Sequence[str], terms: Sequence[Terms], motions: str | None) -> bool:
    """Return whether motions are large: as wished, by default where a load is not linear or steers.

    Raises
    ------
    InputError
        Unknown word; small motions of loads that are not linear.
    """
    if motions not in (None, *MOTIONS):
        raise InputError(f"motions: one of {', '.join(MOTIONS)} expected, {motions!r} found.")
    beyond = [name for name, term in zip(names, terms, strict=True) if _only_large(term)]
    more = [term for term in terms if term.kernel is not None and not term.suffices]
    if motions == "small" and beyond:
        raise InputError(f"motions: 'large' expected for the loads {', '.join(beyond)}, which are not linear; 'small' found.")
    return motions == "large" or (motions is None and bool(beyond or more))


def _only_large(term: Terms) -> bool:
    steers = term.control is not None or term.callback is not None or bool(term.current.any())
    return steers or (term.kernel is not None and term.small is None)


def large_scheme(system: LinearSystem, sea: Sea | None, *, dt: float, method: str, ramp: float) -> Scheme:
    """Return the scheme of large motions: compiled forces of the loads and of the sea that the vessel meets, control laws."""
    from ogilvie.sim.large import Compiled, LargeMotions

    if method != "rk4":
        raise InputError(f"method: 'rk4' expected for large motions, {method!r} found. The others are for small motions.")
    terms = list(zip(system.names, system.terms, strict=True))
    forces = [(name, t.kernel) for name, t in terms if t.kernel is not None]
    if sea is not None:
        forces += [(name, t.encounter(sea, ramp)) for name, t in terms if t.encounter is not None]
    called = [(name, t.callback) for name, t in terms if t.callback is not None]
    laws = [(name, t.control) for name, t in terms if t.control is not None] + [(name, c.held()) for name, c in called]
    return LargeMotions.of(system, dt, Compiled.of(forces), Compiled.of(laws), [c for _, c in called])
