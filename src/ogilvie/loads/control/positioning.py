"""Dynamic positioning: PID in surge, sway and yaw with wave filter, reference filter and thrust allocation."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import Surroundings, Terms
from ogilvie.loads.control import positioning_kernel as k
from ogilvie.loads.control.autopilot import HEADING_CONTROL
from ogilvie.loads.control.checks import NO_LIMIT, horizontal, limit, limits, positive, vector
from ogilvie.loads.control.observer import WAVE, WaveFilter
from ogilvie.loads.control.pid import check_sampling, pid_gains
from ogilvie.loads.control.reference import reference_data
from ogilvie.loads.control.schedule import refuse_degrees, schedule
from ogilvie.loads.control.speed import SPEED_CONTROL
from ogilvie.loads.control.thruster import PLANE, Thruster, check_capability, horizontal_arm
from ogilvie.loads.kernel import Sampled

Array = NDArray[Any]

#: Effect: only one load may keep the position.
POSITION_CONTROL = "position control"


@dataclass(frozen=True, eq=False)
class DynamicPositioning:
    """Keeps position and heading by thrusters.

    Parameters
    ----------
    setpoint : (3,) or (n, 4) array
        x, y (m) and heading (rad) of O in the world; or rows of time (s) and these.
    thrusters : sequence of Thruster, optional
        Without them the wanted force acts directly, within `max_force`.
    natural_frequency, damping : float or (3,) array
        w (rad/s) and z of the closed loop in surge, sway and yaw.
    added_mass, linear_damping : (3, 3) or (6, 6) array, optional
        About O: for the gains and the wave filter; zero where not given.
    wave_filter : WaveFilter, optional
        Keeps wave-frequency motion off the thrusters.
    reference_frequency : float or (3,) array, optional
        Of the reference filters of x, y and heading, rad/s; the smallest natural frequency where not given.
    max_speed, max_rate : float
        Largest rates of the reference: of x and of y (m/s), of the heading (rad/s).
    max_force : float or (3,) array
        Limits without thrusters, N, N, N m; infinity for none.
    design_force : (3,) array, optional
        Surge, sway (N) and yaw (N m) that the thrusters must be able to make at once; checked here.
    period : float
        Sampling period, s.

    Raises
    ------
    InputError
        Numbers out of range; thrusters that cannot act in one of the three degrees of freedom or not hold the design force;
        when bound, a loop or a wave filter that is not stable.

    Notes
    -----
    With the error e = R^T(psi)(eta_d - eta) along the vessel, heading wrapped, and the estimates of the wave filter for eta and
    nu: tau = M R^T eta_d'' + D R^T eta_d' + Kp e + Kd (R^T eta_d' - nu) + R^T z, z' = R Ki e: the integral stays in the world,
    where the mean force of weather does. Gains as in :func:`ogilvie.loads.control.pid.pid_gains` from the horizontal part of
    the body's inertia about O plus added mass. The integral of a degree of freedom stops while it falls short and its error
    would drive it further. Allocation: :func:`ogilvie.loads.control.allocation.allocate`.

    References
    ----------
    Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control (2021), dynamic positioning; Fossen, Strand (1999),
    Automatica 35(1), 3-16; paper C (Vu).

    Examples
    --------
    >>> stern = Thruster([-40, 0, -4], azimuth=True, max_thrust=3e5, name="stern")
    >>> bow = Thruster([40, 0, -4], direction=np.pi / 2, max_thrust=2e5, name="bow")
    >>> keeper = DynamicPositioning([0, 0, 0], (stern, bow), wave_filter=WaveFilter(0.7), design_force=[1e5, 1e5, 0])
    >>> [name for name, unit, slot in keeper.signals][-3:]
    ['thrust of stern forward', 'thrust of stern to port', 'thrust of bow']
    """

    setpoint: ArrayLike
    thrusters: Sequence[Thruster] | None = None
    natural_frequency: ArrayLike = field(default=0.06, kw_only=True)
    damping: ArrayLike = field(default=1.0, kw_only=True)
    added_mass: ArrayLike | None = field(default=None, kw_only=True)
    linear_damping: ArrayLike | None = field(default=None, kw_only=True)
    wave_filter: WaveFilter | None = field(default=None, kw_only=True)
    reference_frequency: ArrayLike | None = field(default=None, kw_only=True)
    max_speed: float = field(default=np.inf, kw_only=True)
    max_rate: float = field(default=np.inf, kw_only=True)
    max_force: ArrayLike = field(default=np.inf, kw_only=True)
    design_force: ArrayLike | None = field(default=None, kw_only=True)
    period: float = field(default=0.5, kw_only=True)
    name: str = field(default="positioning", kw_only=True)

    def __post_init__(self) -> None:
        what = "DynamicPositioning: "
        setpoint = schedule(self.setpoint, 3, what + "setpoint")
        refuse_degrees(setpoint, what + "setpoint")
        frequency = _three(self.natural_frequency, what + "natural_frequency", "rad/s")
        reference = float(frequency.min()) if self.reference_frequency is None else self.reference_frequency
        checked = {
            "setpoint": setpoint,
            "natural_frequency": frequency,
            "damping": _three(self.damping, what + "damping", "-"),
            "reference_frequency": _three(reference, what + "reference_frequency", "rad/s"),
            "added_mass": _matrix(self.added_mass, what + "added_mass"),
            "linear_damping": _matrix(self.linear_damping, what + "linear_damping"),
            "max_force": limits(self.max_force, 3, what + "max_force", "N, N m"),
            "thrusters": _units(self.thrusters, self.design_force),
        }
        for key, value in checked.items():
            object.__setattr__(self, key, value)
        if self.wave_filter is not None and not isinstance(self.wave_filter, WaveFilter):
            raise InputError(f"{what}wave_filter: a WaveFilter expected, {type(self.wave_filter).__name__} found.")
        if self.thrusters is not None and np.min(np.asarray(self.max_force)) < NO_LIMIT:
            raise InputError(f"{what}max_force is for a force without thrusters; thrusters have limits of their own.")
        limit(self.max_speed, what + "max_speed", "m/s")
        limit(self.max_rate, what + "max_rate", "rad/s")
        positive(self.period, what + "period", "s")

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({POSITION_CONTROL, HEADING_CONTROL, SPEED_CONTROL})

    @property
    def signals(self) -> tuple[tuple[str, str, int], ...]:
        """What the memory holds: name, unit and slot of each number worth recording."""
        world, force = (("x", "m"), ("y", "m"), ("heading", "rad")), ("N", "N", "N m")
        rates = ("m/s", "m/s", "rad/s")
        out = [(f"reference {d}", unit, k.REFERENCE + 3 * i) for i, (d, unit) in enumerate(world)]
        out += [(f"estimated {d}", unit, k.ESTIMATE + i) for i, (d, unit) in enumerate(world)]
        out += [(f"estimated {d} velocity", unit, k.SPEED + i) for i, (d, unit) in enumerate(zip(PLANE, rates, strict=True))]
        if self.wave_filter is not None:
            out += [(f"wave-frequency {d}", unit, k.OBSERVER + 3 * WAVE + i) for i, (d, unit) in enumerate(world)]
        for words, slot in (("demanded", k.DEMAND), ("shortfall", k.SHORTFALL)):
            out += [(f"{d} force {words}", unit, slot + i) for i, (d, unit) in enumerate(zip(PLANE, force, strict=True))]
        return (*out, *self._thrust_signals())

    def _thrust_signals(self) -> list[tuple[str, str, int]]:
        out = []
        for i, unit in enumerate(self.thrusters or ()):
            label = f"thrust of {unit.name}"
            for c, words in enumerate((" forward", " to port") if unit.azimuth else ("",)):
                out.append((label + words, "N", k.THRUST + 2 * i + c))
        return out

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the control law for the time loop, with gains for the inertia of this body."""
        M = horizontal(surroundings.body.matrix, "body") + np.asarray(self.added_mass)
        D = np.asarray(self.linear_damping)
        gains = pid_gains(M, D, np.asarray(self.natural_frequency), np.asarray(self.damping))
        check_sampling(M, D, gains, self.period, "DynamicPositioning")
        units = self.thrusters or ()
        arm = horizontal_arm(units) if units else 1.0
        switches = [len(units), self.wave_filter is not None, len(np.asarray(self.setpoint)), arm]
        head = [self.period, *np.asarray(self.max_force), *switches, *M.ravel(), *D.ravel(), *np.ravel(gains)]
        fastest = (self.max_speed, self.max_speed, self.max_rate)
        frequencies = np.asarray(self.reference_frequency)
        course = [reference_data(w, self.period, max_rate=v) for w, v in zip(frequencies, fastest, strict=True)]
        if self.wave_filter is None:
            S = np.zeros(k.STEP_MATRIX)
        else:
            S = self.wave_filter.step_matrix(M, D, self.period).ravel()
        data = np.concatenate([head, *course, S, *[unit.data(self.period) for unit in units], np.ravel(self.setpoint)])
        return Terms(control=Sampled(k.positioning, data, np.zeros(k.THRUST + 2 * len(units)), self.period, self.signals))


def _three(value: ArrayLike, what: str, unit: str) -> Array:
    return np.array([positive(v, what, unit) for v in vector(value, (3,), what, fill=True)])


def _matrix(value: ArrayLike | None, what: str) -> Array:
    return np.zeros((3, 3)) if value is None else horizontal(value, what)


def _units(thrusters: Sequence[Thruster] | None, design_force: ArrayLike | None) -> tuple[Thruster, ...] | None:
    if thrusters is None:
        if design_force is not None:
            raise InputError("DynamicPositioning: thrusters expected beside a design_force, none found.")
        return None
    units = (thrusters,) if isinstance(thrusters, Thruster) else tuple(thrusters)
    for unit in units:
        if not isinstance(unit, Thruster):
            raise InputError(f"DynamicPositioning: thrusters: Thruster objects expected, {type(unit).__name__} found.")
    units = tuple(u if u.name else replace(u, name=f"thruster {i + 1}") for i, u in enumerate(units))
    names = [unit.name for unit in units]
    if len(set(names)) < len(names):
        raise InputError(f"DynamicPositioning: thrusters with different names expected, {', '.join(names)} found.")
    if not units:
        raise InputError("DynamicPositioning: at least one thruster expected, an empty sequence found; None acts directly.")
    check_capability(units, design_force)
    return units
