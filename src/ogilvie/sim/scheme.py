"""Time stepping schemes: what they share, and the one place that chooses among them."""

from typing import Any, Protocol

from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import MemoryKernel
from ogilvie.sim.system import LinearSystem

Array = NDArray[Any]
ComplexArray = NDArray[Any]
METHODS = ("rk4", "exact")


class Scheme(Protocol):
    """A time stepping scheme bound to a system and a time step.

    The state of one vessel is y = (eta, nu) (12,) and a flat memory vector; both are advanced in place.
    """

    @property
    def memory_size(self) -> int:
        """Length of the memory vector."""
        ...

    def rest(self, nu: Array) -> Array:
        """Return the memory (r, k) of vessels at rest until t = 0, when they have the velocities nu (r, 6)."""
        ...

    def steady(self, omega: Array, response: ComplexArray, amplitude: ComplexArray) -> Array:
        """Return the memory (r, k) at t = 0 of motions Re sum_j amplitude_rj response_j exp(i omega_j t), response (n, 6)."""
        ...

    def advance(
        self,
        y: Array,
        memory: Array,
        wave: Array,
        external: Array,
        *,
        row: int,
        steps: int,
        first: int,
        stride: int,
        out: Array,
    ) -> int:
        """Advance by `steps` steps and return how many rows were written to `out` (rows, 24).

        `wave` (k, 6) is the wave force at half steps and `row` its row at the first step; `external` (6,) is constant. A row
        (eta, nu, acceleration, memory force) is written at the start of each step whose number, counted from `first`, is a
        multiple of `stride`.
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
