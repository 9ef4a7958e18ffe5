"""Rudder: from angle and inflow to force, and from a wanted yaw moment to an angle within its limits."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.control.checks import finite, limit, not_negative, positive, vector
from ogilvie.units import SEA_WATER, deg

Array = NDArray[Any]

#: Places in the data of a rudder.
PRESSURE, X, Y, Z, INFLOW, STRAIGHTENING, DRAG, INTERACTION, X_HULL, ANGLE, STEP, RUDDER_DATA = range(12)

_SLOWEST = 0.05  # m/s of inflow below which the command is that of this inflow: the rudder does not work there


@dataclass(frozen=True, eq=False)
class Rudder:
    """A rudder behind the hull. Positive angle turns the vessel to port (trailing edge to port).

    Parameters
    ----------
    area : float
        A, m2.
    aspect_ratio : float
        Lambda = span / chord (span^2 / area).
    position : (3,) array
        Centre of the blade from O, m; x < 0 behind O.
    max_angle : float
        rad.
    rate : float
        Largest rate of turn of the rudder, rad/s; the default is the 65 deg in 28 s of SOLAS II-1, regulation 29.
    inflow : float
        u_R / u: wake and propeller race together, 1 for open water.
    straightening : float
        g_R: part of the lateral velocity at the rudder that its inflow feels.
    drag_deduction : float
        t_R.
    hull_interaction : float
        a_H: lateral force on the hull as a fraction of the rudder's.
    hull_position : float
        x_H: where that force acts, m from O along x.
    rho : float
        kg/m3.

    Raises
    ------
    InputError
        Numbers out of range; a rudder without arm.

    Notes
    -----
    Inflow u_R = inflow u, v_R = g_R (v + x r), U_R^2 = u_R^2 + v_R^2 from the velocity through the water; angle of attack
    a = delta + atan2(v_R, u_R); normal force F_N = 1/2 rho A f U_R^2 sin(a) with f = 6.13 Lambda / (Lambda + 2.25). Force
    on the vessel X = -(1 - t_R) F_N sin(delta), Y = -(1 + a_H) F_N cos(delta), N = -(x + a_H x_H) F_N cos(delta) - y X, and the
    moments of X and Y about the axes of roll and pitch with the arm z. The sine holds up to stall, about 35 deg.

    References
    ----------
    Fujii, Tsuda (1961) for f; Yasukawa, Yoshimura (2015), Introduction of MMG standard method for ship maneuvering predictions,
    J. Mar. Sci. Technol. 20, 37-52; Fossen (2021), section 9.5. Those are written in z-down axes; here y is port and z up.

    Examples
    --------
    >>> rudder = Rudder(area=30.0, aspect_ratio=1.8, position=[-85.0, 0.0, -5.0])
    >>> force = rudder.force(10 * deg, nu=[8.0, 0, 0, 0, 0, 0])
    >>> bool(force[5] > 0 and force[1] < 0 and force[0] < 0)
    True
    """

    area: float
    aspect_ratio: float
    position: ArrayLike = field(kw_only=True)
    max_angle: float = field(default=35.0 * deg, kw_only=True)
    rate: float = field(default=65.0 / 28.0 * deg, kw_only=True)
    inflow: float = field(default=1.0, kw_only=True)
    straightening: float = field(default=1.0, kw_only=True)
    drag_deduction: float = field(default=0.0, kw_only=True)
    hull_interaction: float = field(default=0.0, kw_only=True)
    hull_position: float = field(default=0.0, kw_only=True)
    rho: float = field(default=SEA_WATER, kw_only=True)

    def __post_init__(self) -> None:
        what = "Rudder: "
        positive(self.area, what + "area", "m2")
        positive(self.aspect_ratio, what + "aspect_ratio", "-")
        object.__setattr__(self, "position", vector(self.position, (3,), what + "position"))
        if positive(self.max_angle, what + "max_angle", "rad") > 45.0 * deg:
            raise InputError(
                f"{what}max_angle: at most 45 deg expected, {self.max_angle / deg:g} deg found. Angles are in rad."
            )
        limit(self.rate, what + "rate", "rad/s")
        positive(self.inflow, what + "inflow", "-")
        not_negative(self.straightening, what + "straightening", "-")
        if not 0.0 <= not_negative(self.drag_deduction, what + "drag_deduction", "-") < 1.0:
            raise InputError(f"{what}drag_deduction: a number in [0, 1) expected, {self.drag_deduction!r} found.")
        not_negative(self.hull_interaction, what + "hull_interaction", "-")
        finite(self.hull_position, what + "hull_position", "m")
        positive(self.rho, what + "rho", "kg/m3")
        if self.arm == 0.0:
            raise InputError(f"{what}an arm x + a_H x_H other than 0 expected: this rudder makes no yaw moment.")

    @property
    def slope(self) -> float:
        """Slope f of the normal force coefficient, per rad."""
        return 6.13 * self.aspect_ratio / (self.aspect_ratio + 2.25)

    @property
    def arm(self) -> float:
        """Arm x + a_H x_H of the lateral force about O, m."""
        return float(np.asarray(self.position)[0]) + self.hull_interaction * self.hull_position

    def data(self, period: float) -> Array:
        """Return the numbers (RUDDER_DATA,) for the kernels, for this sampling period (s)."""
        out = np.zeros(RUDDER_DATA)
        out[PRESSURE] = 0.5 * self.rho * self.area * self.slope
        out[X : Z + 1] = self.position
        out[INFLOW : X_HULL + 1] = [
            self.inflow,
            self.straightening,
            self.drag_deduction,
            self.hull_interaction,
            self.hull_position,
        ]
        out[ANGLE], out[STEP] = self.max_angle, limit(self.rate, "rate", "rad/s") * period
        return out

    def force(self, angle: float, *, nu: ArrayLike) -> Array:
        """Return the force (6,) on the vessel about O at this angle (rad) and velocity through the water nu (6,)."""
        out = np.zeros(6)
        rudder_force(self.data(1.0), float(angle), vector(nu, (6,), "Rudder.force: nu").copy(), out)
        return out


@njit(cache=True, nogil=True)
def rudder_force(data: Array, angle: float, nu: Array, force: Array) -> None:
    """Write the force (6,) about O of a rudder at this angle in the velocity nu (6,) through the water."""
    u, v = data[INFLOW] * nu[0], data[STRAIGHTENING] * (nu[1] + data[X] * nu[5])
    normal = data[PRESSURE] * (u * u + v * v) * np.sin(angle + np.arctan2(v, u))
    side = -normal * np.cos(angle)
    force[0] = -(1.0 - data[DRAG]) * normal * np.sin(angle)
    force[1] = (1.0 + data[INTERACTION]) * side
    force[2] = 0.0
    force[3] = -data[Z] * force[1]
    force[4] = data[Z] * force[0]
    force[5] = (data[X] + data[INTERACTION] * data[X_HULL]) * side - data[Y] * force[0]


@njit(cache=True, nogil=True)
def rudder_command(data: Array, moment: float, u: float) -> float:
    """Return the angle (rad), before its limits, that makes this yaw moment in straight inflow at forward speed u.

    The moment -arm p u_R |u_R| sin(2 angle) / 2 is inverted; what no angle can make gives 45 deg, beyond every limit.
    """
    w = data[INFLOW] * u
    if abs(w) < _SLOWEST:
        w = _SLOWEST if w >= 0.0 else -_SLOWEST
    s = -2.0 * moment / ((data[X] + data[INTERACTION] * data[X_HULL]) * data[PRESSURE] * w * abs(w))
    return 0.5 * np.arcsin(min(max(s, -1.0), 1.0))


@njit(cache=True, nogil=True)
def rudder_moment(data: Array, angle: float, u: float) -> float:
    """Return the yaw moment of the deflection in straight inflow at forward speed u: the inverse of :func:`rudder_command`."""
    w = data[INFLOW] * u
    return -0.5 * (data[X] + data[INTERACTION] * data[X_HULL]) * data[PRESSURE] * w * abs(w) * np.sin(2.0 * angle)


@njit(cache=True, nogil=True)
def rudder_move(data: Array, angle: float, command: float) -> float:
    """Return the angle after one period on the way to the command, within the limits of angle and rate."""
    command = min(max(command, -data[ANGLE]), data[ANGLE])
    return angle + min(max(command - angle, -data[STEP]), data[STEP])
