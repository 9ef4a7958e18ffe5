"""Speed control: PI on the speed through the water or over ground, with limited thrust."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import Surroundings, Terms
from ogilvie.loads.control.checks import NO_LIMIT, diagonal, finite, limit, positive, vector
from ogilvie.loads.control.pid import speed_gains
from ogilvie.loads.control.reference import REFERENCE_DATA, reference_data, reference_step
from ogilvie.loads.control.schedule import row_at, schedule
from ogilvie.loads.kernel import NU, NU_R, TIME, Sampled, load_kernel

Array = NDArray[Any]

#: Effect: only one load may keep the speed.
SPEED_CONTROL = "speed control"

_INERTIA, _DAMPING, _KP, _KI, _PERIOD, _MAX, _MIN, _STEP, _GROUND, _X, _Y, _Z, _ROWS, _HEAD = range(14)

#: Memory: 1 after the first sample; set-point; reference and its two derivatives; integral part (N); thrust wanted, made and
#: missing (N); measured speed.
STARTED, TARGET, REFERENCE, INTEGRAL, DEMAND, THRUST, SHORTFALL, SPEED, MEMORY = 0, 1, 2, 5, 6, 7, 8, 9, 10


@dataclass(frozen=True, eq=False)
class SpeedKeeping:
    """Thrust that keeps a forward speed.

    Parameters
    ----------
    speed : float or (n, 2) array
        m/s, or rows of time (s) and speed.
    over_ground : bool
        Speed over ground instead of through the water.
    natural_frequency, damping : float
        w (rad/s) and z of the closed loop.
    gains : (2,) array, optional
        Kp (N s/m) and Ki (N/m) instead of pole placement.
    added_mass : float or (6, 6) array
        Surge added mass, kg, or the matrix about O; 0 leaves it out of the gains.
    surge_damping : float or (6, 6) array
        Linear damping that the vessel has anyway, N s/m.
    max_thrust, max_reverse : float
        Limits ahead and astern, N; astern as ahead where not given.
    rate : float
        Largest change of thrust, N/s.
    thrust : float
        Thrust at the start, N: the resistance, where it is known, so that the vessel does not slow down first.
    position : (3,) array
        A point of the line of thrust from O, m; its height makes a trim moment.
    reference_frequency : float, optional
        Of the reference filter, rad/s; the natural frequency where not given.
    max_acceleration : float
        Largest acceleration of the reference, m/s2.
    period : float
        Sampling period, s.

    Raises
    ------
    InputError
        Numbers out of range; when bound, a loop that is not stable.

    Notes
    -----
    X = m u_d' + D u_d + Kp e + Ki int e dt, e = u_d - u: the error of m u' + D u = X + constant obeys s^2 + 2 z w s + w^2 for
    Kp = 2 z w m - D and Ki = w^2 m. The integral stops while the thrust falls short and the error would drive it further.

    Examples
    --------
    >>> sorted(SpeedKeeping(9.0, max_thrust=2e6, rate=1e5).covers)
    ['speed control']
    """

    speed: ArrayLike
    over_ground: bool = field(default=False, kw_only=True)
    natural_frequency: float = field(default=0.05, kw_only=True)
    damping: float = field(default=1.0, kw_only=True)
    gains: ArrayLike | None = field(default=None, kw_only=True)
    added_mass: ArrayLike = field(default=0.0, kw_only=True)
    surge_damping: ArrayLike = field(default=0.0, kw_only=True)
    max_thrust: float = field(default=np.inf, kw_only=True)
    max_reverse: float | None = field(default=None, kw_only=True)
    rate: float = field(default=np.inf, kw_only=True)
    thrust: float = field(default=0.0, kw_only=True)
    position: ArrayLike = field(default=(0.0, 0.0, 0.0), kw_only=True)
    reference_frequency: float | None = field(default=None, kw_only=True)
    max_acceleration: float = field(default=np.inf, kw_only=True)
    period: float = field(default=0.5, kw_only=True)
    name: str = field(default="speed_keeping", kw_only=True)

    def __post_init__(self) -> None:
        what = "SpeedKeeping: "
        object.__setattr__(self, "speed", schedule(self.speed, 1, what + "speed"))
        object.__setattr__(self, "position", vector(self.position, (3,), what + "position"))
        for key, unit in (("natural_frequency", "rad/s"), ("damping", "-"), ("period", "s")):
            positive(getattr(self, key), what + key, unit)
        if self.reference_frequency is not None:
            positive(self.reference_frequency, what + "reference_frequency", "rad/s")
        for key, unit in (("max_thrust", "N"), ("rate", "N/s"), ("max_acceleration", "m/s2")):
            limit(getattr(self, key), what + key, unit)
        if self.max_reverse is not None and self.max_reverse != 0.0:
            limit(self.max_reverse, what + "max_reverse", "N")
        diagonal(self.added_mass, 0, what + "added_mass")
        diagonal(self.surge_damping, 0, what + "surge_damping")
        if self.gains is not None:
            object.__setattr__(self, "gains", vector(self.gains, (2,), what + "gains"))
        lowest, highest = self._range
        if not lowest <= finite(self.thrust, what + "thrust", "N") <= highest:
            raise InputError(
                f"{what}thrust: a number within the limits {lowest:g} to {highest:g} N expected, {self.thrust:g} N found."
            )

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({SPEED_CONTROL})

    @property
    def signals(self) -> tuple[tuple[str, str, int], ...]:
        """What the memory holds: name, unit and slot of each number worth recording."""
        return (
            ("speed reference", "m/s", REFERENCE),
            ("speed measured", "m/s", SPEED),
            ("thrust demanded", "N", DEMAND),
            ("thrust", "N", THRUST),
            ("thrust shortfall", "N", SHORTFALL),
        )

    @property
    def _range(self) -> tuple[float, float]:
        highest = min(float(self.max_thrust), NO_LIMIT)
        return -(highest if self.max_reverse is None else min(float(self.max_reverse), NO_LIMIT)), highest

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the control law for the time loop, with gains for the mass of this body."""
        m = surroundings.body.mass + diagonal(self.added_mass, 0, "SpeedKeeping: added_mass")
        D = diagonal(self.surge_damping, 0, "SpeedKeeping: surge_damping")
        chosen = None if self.gains is None else (float(np.asarray(self.gains)[0]), float(np.asarray(self.gains)[1]))
        Kp, Ki = speed_gains(m, D, self.natural_frequency, self.damping, period=self.period, gains=chosen)
        lowest, highest = self._range
        step = min(limit(self.rate, "rate", "N/s") * self.period, NO_LIMIT)
        head = [m, D, Kp, Ki, self.period, highest, lowest, step, float(self.over_ground), *np.asarray(self.position)]
        course = reference_data(
            self.reference_frequency or self.natural_frequency,
            self.period,
            max_rate=self.max_acceleration,
            what="SpeedKeeping: reference",
        )
        data = np.concatenate([head, [len(np.asarray(self.speed))], course, np.ravel(self.speed)])
        memory = np.zeros(MEMORY)
        memory[THRUST] = self.thrust
        return Terms(control=Sampled(_speed_keeping, data, memory, self.period, self.signals))


@njit(cache=True, nogil=True)
def _reference(x: Array, data: Array, memory: Array) -> None:
    """Advance the reference; it starts at the speed that is there, and the integral at the thrust that is there."""
    reference = memory[REFERENCE : REFERENCE + 3]
    if memory[STARTED] == 0.0:
        reference[0] = memory[SPEED]
        memory[INTEGRAL] = memory[THRUST] - data[_DAMPING] * memory[SPEED]
    else:
        reference_step(data[_HEAD : _HEAD + REFERENCE_DATA], reference, memory[TARGET])
    table = data[_HEAD + REFERENCE_DATA :]
    memory[TARGET] = table[row_at(table, int(data[_ROWS]), 1, x[TIME])]
    memory[STARTED] = 1.0


@load_kernel
def _speed_keeping(x, data, memory, force):
    memory[SPEED] = x[NU] if data[_GROUND] != 0.0 else x[NU_R]
    _reference(x, data, memory)
    u, a = memory[REFERENCE], memory[REFERENCE + 1]
    error = u - memory[SPEED]
    memory[DEMAND] = data[_INERTIA] * a + data[_DAMPING] * u + data[_KP] * error + memory[INTEGRAL]
    wanted = min(max(memory[DEMAND], data[_MIN]), data[_MAX])
    T = memory[THRUST] + min(max(wanted - memory[THRUST], -data[_STEP]), data[_STEP])
    memory[THRUST], memory[SHORTFALL] = T, memory[DEMAND] - T
    growth = data[_PERIOD] * data[_KI] * error
    if growth * memory[SHORTFALL] <= 1e-9 * abs(growth * memory[DEMAND]):
        memory[INTEGRAL] += growth
    force[:] = 0.0
    force[0], force[4], force[5] = T, data[_Z] * T, -data[_Y] * T
