"""Thrusters: where they stand, which way they push, how hard; and whether together they can do what is asked."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.control.checks import NO_LIMIT, finite, limit, not_negative, positive, vector

Array = NDArray[Any]

#: The degrees of freedom of positioning.
PLANE = ("surge", "sway", "yaw")

#: Numbers of one thruster in the data: unit wrench of its one or two components (2, 6), kind (1 or 2 components), largest
#: thrust ahead and astern (N), largest change in one period (N), weight (1/N^2).
WRENCH, KIND, MAX, MIN, STEP, WEIGHT, THRUSTER_DATA = 0, 12, 13, 14, 15, 16, 17

_SIDES = 64  # of the polygon for the circle of thrust of an azimuth thruster in the check of capability


@dataclass(frozen=True, eq=False)
class Thruster:
    """A thruster with a fixed direction, or one that turns.

    Parameters
    ----------
    position : (3,) array
        From O, m.
    direction : float, optional
        Direction of its force on the vessel in the horizontal plane, rad, from forward to port: 0 main propeller, pi/2 tunnel.
    azimuth : bool
        It turns to every direction. Give `direction` or `azimuth`.
    max_thrust : float
        N.
    max_reverse : float, optional
        Largest thrust against its direction, N, for a fixed one; as `max_thrust` where not given.
    rate : float
        Largest change of thrust, N/s; for an azimuth thruster of its force vector, turning included.
    weight : float, optional
        Cost of its squared thrust, 1/N^2; 1 / max_thrust^2 where not given, so that all are loaded alike.
    name : str
        Labels its signals; a number where not given.

    Raises
    ------
    InputError
        Neither or both of `direction` and `azimuth`; numbers out of range.

    Examples
    --------
    >>> bow = Thruster([40.0, 0.0, -4.0], direction=np.pi / 2, max_thrust=150e3)
    >>> bow.wrenches.round(9).tolist()  # per N: sway, roll (arm below O), yaw
    [[0.0, 1.0, 0.0, 4.0, 0.0, 40.0]]
    """

    position: ArrayLike
    direction: float | None = field(default=None, kw_only=True)
    azimuth: bool = field(default=False, kw_only=True)
    max_thrust: float = field(kw_only=True)
    max_reverse: float | None = field(default=None, kw_only=True)
    rate: float = field(default=np.inf, kw_only=True)
    weight: float | None = field(default=None, kw_only=True)
    name: str = field(default="", kw_only=True)

    def __post_init__(self) -> None:
        what = f"Thruster {self.name}: " if self.name else "Thruster: "
        object.__setattr__(self, "position", vector(self.position, (3,), what + "position"))
        if (self.direction is None) != bool(self.azimuth):
            raise InputError(f"{what}exactly one of direction (rad) and azimuth=True expected.")
        if self.direction is not None:
            finite(self.direction, what + "direction", "rad")
        positive(self.max_thrust, what + "max_thrust", "N")
        limit(self.rate, what + "rate", "N/s")
        if self.weight is not None:
            positive(self.weight, what + "weight", "1/N2")
        if self.max_reverse is not None:
            not_negative(self.max_reverse, what + "max_reverse", "N")
            if self.azimuth:
                raise InputError(f"{what}max_reverse is for a thruster with a direction; an azimuth thruster turns round.")

    @property
    def angles(self) -> tuple[float, ...]:
        """Directions of its components, rad: its own, or forward and port."""
        return (0.0, 0.5 * np.pi) if self.direction is None else (float(self.direction),)

    @property
    def lowest(self) -> float:
        """Lowest thrust along a component, N."""
        return -float(self.max_thrust if self.max_reverse is None else self.max_reverse)

    @property
    def wrenches(self) -> Array:
        """Force about O (1 or 2, 6) of one newton in each component."""
        rows = []
        for angle in self.angles:
            F = np.array([np.cos(angle), np.sin(angle), 0.0])
            rows.append(np.concatenate([F, np.cross(np.asarray(self.position), F)]))
        return np.array(rows)

    def data(self, period: float) -> Array:
        """Return the numbers (THRUSTER_DATA,) for the kernel."""
        out = np.zeros(THRUSTER_DATA)
        out[: 6 * len(self.angles)] = self.wrenches.ravel()
        step = min(limit(self.rate, "rate", "N/s") * period, NO_LIMIT)
        weight = self.max_thrust**-2 if self.weight is None else self.weight
        out[KIND:] = [len(self.angles), self.max_thrust, self.lowest, min(step, 4.0 * self.max_thrust), weight]
        return out


def effectiveness(thrusters: Sequence[Thruster]) -> Array:
    """Return B (3, m): surge, sway and yaw of one newton in each of the m components of all thrusters."""
    return np.vstack([t.wrenches for t in thrusters])[:, [0, 1, 5]].T


def check_capability(thrusters: Sequence[Thruster], design_force: ArrayLike | None) -> None:
    """Raise :class:`InputError` where the thrusters cannot act in surge, sway and yaw, or not hold a design force.

    Parameters
    ----------
    thrusters : sequence of Thruster
    design_force : (3,) array, optional
        Surge and sway force (N) and yaw moment (N m) that the thrusters must be able to make, all at once.

    Notes
    -----
    Rank: singular values of B scaled by the largest thrusts and the largest arm. Force: the largest l with B u = l tau within
    the limits by linear programming, circles of thrust as polygons of 64 sides inside them (0.12 % on the safe side).

    Examples
    --------
    >>> check_capability([Thruster([0, 0, 0], direction=0.0, max_thrust=1e5)], None)
    Traceback (most recent call last):
    ...
    ogilvie.errors.InputError: ... cannot act in sway, yaw: ...
    """
    B, arm = effectiveness(thrusters), horizontal_arm(thrusters)
    scaled = B / np.array([1.0, 1.0, arm])[:, None]
    left, size, _ = np.linalg.svd(scaled @ np.diag(_weights(thrusters)) @ scaled.T)
    idle = left[:, size < 1e-9 * size[0]]
    if idle.shape[1]:
        names = [d for d, part in zip(PLANE, np.abs(idle).max(axis=1), strict=True) if part > 1e-6]
        mixed = "" if len(names) == idle.shape[1] else " independently of each other"
        raise InputError(
            f"thrusters: forces in surge, sway and yaw expected, these cannot act in {', '.join(names)}{mixed}: "
            f"rank {3 - idle.shape[1]} of 3. Add a thruster, or one off the centre, or turn one."
        )
    if design_force is not None:
        _check_force(thrusters, vector(design_force, (3,), "design_force"))


def capability(thrusters: Sequence[Thruster], direction: Array) -> float:
    """Return the largest l for which the thrusters can make the force l times `direction` (3,) in surge, sway and yaw."""
    from scipy.optimize import linprog

    B, m, unit = effectiveness(thrusters), sum(len(t.angles) for t in thrusters), max(t.max_thrust for t in thrusters)
    rows, bounds, j = [], [], 0
    for t in thrusters:
        bounds += [(t.lowest / unit, t.max_thrust / unit)] * len(t.angles)
        if t.azimuth:
            for a in np.linspace(0.0, 2 * np.pi, _SIDES, endpoint=False):
                row = np.zeros(m + 1)
                row[j : j + 2] = np.array([np.cos(a), np.sin(a)]) / (t.max_thrust / unit * np.cos(np.pi / _SIDES))
                rows.append(row)
        j += len(t.angles)
    scale = np.array([1.0, 1.0, horizontal_arm(thrusters)])
    A = np.hstack([B, -direction[:, None] / unit]) / scale[:, None]
    unequal = {"A_ub": np.array(rows), "b_ub": np.ones(len(rows))} if rows else {}
    found = linprog(-np.eye(m + 1)[m], A_eq=A, b_eq=np.zeros(3), bounds=[*bounds, (0.0, None)], **unequal)
    return float(found.x[m]) if found.status == 0 else np.inf


def _check_force(thrusters: Sequence[Thruster], force: Array) -> None:
    if not np.any(force) or capability(thrusters, force) >= 1.0:
        return
    share = {d: capability(thrusters, np.eye(3)[i] * force[i]) for i, d in enumerate(PLANE) if force[i] != 0.0}
    short = [f"{d} ({part:.0%} of {force[PLANE.index(d)]:g})" for d, part in share.items() if part < 1.0]
    if short:
        raise InputError(f"thrusters: the design force expected to be within their limits, too weak in {', '.join(short)}.")
    raise InputError(
        f"thrusters: the design force expected to be within their limits, found {capability(thrusters, force):.0%} of it: "
        f"enough in each of {', '.join(share)} alone, too weak for all at once."
    )


def _weights(thrusters: Sequence[Thruster]) -> Array:
    return np.concatenate([np.full(len(t.angles), t.max_thrust / max(u.max_thrust for u in thrusters)) for t in thrusters]) ** 2


def horizontal_arm(thrusters: Sequence[Thruster]) -> float:
    """Largest horizontal distance from O, m, to compare moments with forces; 1 m if all stand at O."""
    return float(max(np.hypot(*np.asarray(t.position)[:2]) for t in thrusters)) or 1.0
