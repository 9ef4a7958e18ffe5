"""Heading control: PID on the heading with reference filter, wave filter, and a rudder or a yaw moment that has a limit."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import Surroundings, Terms
from ogilvie.loads.control import autopilot_kernel as k
from ogilvie.loads.control.checks import diagonal, limit, positive, vector
from ogilvie.loads.control.observer import WaveFilter
from ogilvie.loads.control.pid import check_sampling, pid_gains
from ogilvie.loads.control.reference import reference_data
from ogilvie.loads.control.rudder import RUDDER_DATA, Rudder
from ogilvie.loads.control.schedule import refuse_degrees, schedule
from ogilvie.loads.kernel import Sampled

Array = NDArray[Any]

#: Effects: only one load may steer, and a rudder must not be in two loads.
HEADING_CONTROL, RUDDER_FORCE = "heading control", "rudder force"


@dataclass(frozen=True, eq=False)
class Autopilot:
    """Heading control.

    Parameters
    ----------
    heading : float or (n, 2) array
        Heading to keep, rad, anticlockwise from +x; or rows of time (s) and heading. The shorter way round is taken.
    rudder : Rudder, optional
        Give `rudder` or `max_moment`.
    max_moment : float, optional
        Limit of a yaw moment that acts directly, N m; infinity for none.
    natural_frequency, damping : float
        w (rad/s) and z of the closed loop.
    gains : (3,) array, optional
        Kp (N m/rad), Ki (N m/(rad s)), Kd (N m s/rad) instead of pole placement.
    added_mass : float or (6, 6) array
        Yaw added mass moment of inertia, kg m2, or the matrix about O; 0 leaves it out of the gains.
    yaw_damping : float or (6, 6) array
        Linear yaw damping that the vessel has anyway, N m s.
    reference_frequency : float, optional
        Of the reference filter, rad/s; the natural frequency where not given.
    max_rate : float
        Largest rate of turn of the reference, rad/s.
    wave_filter : WaveFilter, optional
        Keeps wave-frequency yaw off the rudder.
    period : float
        Sampling period, s.

    Raises
    ------
    InputError
        Numbers out of range; neither or both of `rudder` and `max_moment`; when bound, a loop that is not stable.

    Notes
    -----
    N = I psi_d'' + D psi_d' + Kp e + Ki int e dt + Kd (psi_d' - r), e = psi_d - psi wrapped to [-pi, pi); I is the yaw inertia
    of the body about O plus the added mass, D the yaw damping, and the poles are -w/10 and the pair of (w, z), see
    :func:`ogilvie.loads.control.pid.pid_gains`. The integral stops while the moment falls short and the error would drive it
    further. The rudder angle for N is found for straight inflow at the present speed through the water.

    References
    ----------
    Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control (2021), heading autopilots; paper C (Vu).

    Examples
    --------
    >>> pilot = Autopilot(0.5, max_moment=1e7, natural_frequency=0.1, max_rate=0.01)
    >>> [name for name, unit, slot in pilot.signals][:2]
    ['heading reference', 'heading estimated']
    """

    heading: ArrayLike
    rudder: Rudder | None = None
    max_moment: float | None = field(default=None, kw_only=True)
    natural_frequency: float = field(default=0.1, kw_only=True)
    damping: float = field(default=1.0, kw_only=True)
    gains: ArrayLike | None = field(default=None, kw_only=True)
    added_mass: ArrayLike = field(default=0.0, kw_only=True)
    yaw_damping: ArrayLike = field(default=0.0, kw_only=True)
    reference_frequency: float | None = field(default=None, kw_only=True)
    max_rate: float = field(default=np.inf, kw_only=True)
    wave_filter: WaveFilter | None = field(default=None, kw_only=True)
    period: float = field(default=0.5, kw_only=True)
    name: str = field(default="autopilot", kw_only=True)

    def __post_init__(self) -> None:
        what = "Autopilot: "
        object.__setattr__(self, "heading", schedule(self.heading, 1, what + "heading"))
        refuse_degrees(np.asarray(self.heading), what + "heading")
        if (self.rudder is None) == (self.max_moment is None):
            raise InputError(f"{what}exactly one of rudder and max_moment expected.")
        if self.rudder is not None and not isinstance(self.rudder, Rudder):
            raise InputError(f"{what}rudder: a Rudder expected, {type(self.rudder).__name__} found.")
        if self.wave_filter is not None and not isinstance(self.wave_filter, WaveFilter):
            raise InputError(f"{what}wave_filter: a WaveFilter expected, {type(self.wave_filter).__name__} found.")
        if self.max_moment is not None:
            limit(self.max_moment, what + "max_moment", "N m")
        for key, unit in (("natural_frequency", "rad/s"), ("damping", "-"), ("period", "s")):
            positive(getattr(self, key), what + key, unit)
        if self.reference_frequency is not None:
            positive(self.reference_frequency, what + "reference_frequency", "rad/s")
        limit(self.max_rate, what + "max_rate", "rad/s")
        diagonal(self.added_mass, 5, what + "added_mass")
        diagonal(self.yaw_damping, 5, what + "yaw_damping")
        if self.gains is not None:
            object.__setattr__(self, "gains", vector(self.gains, (3,), what + "gains"))

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({HEADING_CONTROL} | ({RUDDER_FORCE} if self.rudder is not None else set()))

    @property
    def signals(self) -> tuple[tuple[str, str, int], ...]:
        """What the memory holds: name, unit and slot of each number worth recording."""
        rudder = (("rudder angle", "rad", k.RUDDER),) if self.rudder is not None else ()
        wave = (("wave-frequency yaw", "rad", k.OBSERVER + 1),) if self.wave_filter is not None else ()
        return (
            ("heading reference", "rad", k.REFERENCE),
            ("heading estimated", "rad", k.ESTIMATE),
            ("yaw rate estimated", "rad/s", k.ESTIMATE + 1),
            ("yaw moment demanded", "N m", k.DEMAND),
            ("yaw moment shortfall", "N m", k.SHORTFALL),
            *rudder,
            *wave,
        )

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the control law for the time loop, with gains for the inertia of this body."""
        I = float(surroundings.body.matrix[5, 5]) + diagonal(self.added_mass, 5, "Autopilot: added_mass")
        D = diagonal(self.yaw_damping, 5, "Autopilot: yaw_damping")
        Kp, Ki, Kd = self._gains(I, D)
        head = np.zeros(k.HEAD)
        head[: k.RUDDERED] = [I, D, Kp, Ki, Kd, self.period, limit(self.max_moment or np.inf, "max_moment", "N m")]
        head[k.RUDDERED :] = [self.rudder is not None, self.wave_filter is not None, len(np.asarray(self.heading))]
        course = reference_data(self.reference_frequency or self.natural_frequency, self.period, max_rate=self.max_rate)
        blade = np.zeros(RUDDER_DATA) if self.rudder is None else self.rudder.data(self.period)
        if self.wave_filter is None:
            S = np.zeros(k.STEP_MATRIX)
        else:
            S = self.wave_filter.step_matrix(np.array([[I]]), np.array([[D]]), self.period).ravel()
        data = np.concatenate([head, course, blade, S, np.ravel(self.heading)])
        return Terms(control=Sampled(k.autopilot, data, np.zeros(k.MEMORY), self.period, self.signals))

    def _gains(self, I: float, D: float) -> tuple[float, float, float]:
        M, C = np.array([[I]]), np.array([[D]])
        if self.gains is None:
            gains = pid_gains(M, C, np.array([self.natural_frequency]), np.array([self.damping]))
        else:
            Kp, Ki, Kd = (np.array([[g]]) for g in np.asarray(self.gains))
            gains = (Kp, Ki, Kd)
        check_sampling(M, C, gains, self.period, "Autopilot")
        return float(gains[0][0, 0]), float(gains[1][0, 0]), float(gains[2][0, 0])
