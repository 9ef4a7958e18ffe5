"""A vessel: a body, the loads on it, its speed and heading."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from ogilvie.body import RigidBody
from ogilvie.errors import DoubleCountingError, InputError
from ogilvie.loads.base import Load


@dataclass(frozen=True, eq=False)
class Vessel:
    """A rigid body and the loads on it, moving at a mean speed and heading.

    Parameters
    ----------
    body : RigidBody
        Mass, centre of gravity and inertia.
    loads : sequence of loads
        Each accounts for the physical effects in its ``covers``; no effect may be covered twice.
    speed : float
        Mean forward speed U, m/s, >= 0.
    heading : float
        Mean heading, anticlockwise from the x axis of the sea, rad.

    Raises
    ------
    DoubleCountingError
        Two loads cover one physical effect; the message names both.
    InputError
        No rigid body, something that is not a load, speed negative or not finite, a heading beyond a whole turn (degrees?).

    Examples
    --------
    >>> from ogilvie.loads.restoring import LinearRestoring
    >>> body = RigidBody(mass=1e6, cog=[0, 0, 0], inertia=np.diag([1e8, 1e9, 1e9]))
    >>> Vessel(body, loads=(LinearRestoring(np.eye(6)),)).names
    ('restoring',)
    >>> Vessel(body, loads=(LinearRestoring(np.eye(6)), LinearRestoring(np.eye(6))))
    Traceback (most recent call last):
    ...
    ogilvie.errors.DoubleCountingError: hydrostatic restoring is covered by two loads, LinearRestoring and LinearRestoring. ...
    """

    body: RigidBody
    loads: Sequence[Load] = ()
    speed: float = 0.0
    heading: float = 0.0

    def __post_init__(self) -> None:
        if not isinstance(self.body, RigidBody):
            raise InputError(
                f"Vessel: a RigidBody (mass, centre of gravity, inertia) expected, {type(self.body).__name__} found."
            )
        loads = (self.loads,) if isinstance(self.loads, Load) else tuple(self.loads)
        for load in loads:
            if not isinstance(load, Load):
                raise InputError(f"Vessel: loads with name, covers and bind expected, {type(load).__name__} found.")
        _refuse_double_counting(loads)
        if not (np.isfinite(self.speed) and self.speed >= 0.0):
            raise InputError(f"Vessel: a speed >= 0 in m/s expected, {self.speed!r} found.")
        if not np.isfinite(self.heading):
            raise InputError(f"Vessel: a finite heading in rad expected, {self.heading!r} found.")
        if abs(self.heading) > 2.0 * np.pi + 1e-9:
            found = f"{float(self.heading):g}"
            raise InputError(
                f"Vessel: heading: rad within -2 pi..2 pi expected, {found} found. Degrees? {found} * og.units.deg."
            )
        object.__setattr__(self, "loads", loads)
        object.__setattr__(self, "speed", float(self.speed))
        object.__setattr__(self, "heading", float(self.heading))

    @property
    def names(self) -> tuple[str, ...]:
        """Name of each load in the output, unique: the second of a kind is called name_2."""
        seen: Counter[str] = Counter()
        names = []
        for load in self.loads:
            seen[load.name] += 1
            names.append(load.name if seen[load.name] == 1 else f"{load.name}_{seen[load.name]}")
        return tuple(names)


def _refuse_double_counting(loads: Sequence[Load]) -> None:
    for one, other in combinations(loads, 2):
        both = sorted(one.covers & other.covers)
        if both:
            raise DoubleCountingError(
                f"{', '.join(both)} is covered by two loads, {type(one).__name__} and {type(other).__name__}. "
                "Keep one of them, or add their coefficients up in one load."
            )
