"""A steady current."""

from dataclasses import KW_ONLY, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import Surroundings, Terms
from ogilvie.waves.spreading import check_direction

Array = NDArray[Any]

#: The physical effect.
CURRENT = "current"


@dataclass(frozen=True, eq=False)
class Current:
    """A steady current, uniform over the hull: what loads on the velocity through the water take off the velocity.

    It is no force itself: damping, drag and manoeuvring loads turn it into one.

    Parameters
    ----------
    speed : float or (n,) array
        m/s, >= 0: one for all depths, or those at the heights `z`.
    direction : float or (n,) array
        Direction the water flows **to**, anticlockwise from +x, rad; one, or one per height.
    z : (n,) array, optional
        Heights of the profile, m, <= 0 below still water, in rising or falling order.
    draught : float, optional
        T, m: the profile is averaged over -T <= z <= 0. Given with `z` and only then.

    Attributes
    ----------
    velocity : (3,) array
        Of the water, in the world, m/s.

    Raises
    ------
    InputError
        Speed negative, directions in degrees, a profile without draught or one that does not reach it, shapes that differ.

    Notes
    -----
    ``velocity = (1/T) int_-T^0 V(z) (cos b, sin b) dz``, the velocity components linear between the heights; above the highest
    and below the lowest of them there is no value: they have to reach 0 and -T.

    Examples
    --------
    >>> Current(1.0, np.pi / 2).velocity.round(6) + 0.0
    array([0., 1., 0.])
    >>> Current([2.0, 0.0], 0.0, z=[0.0, -40.0], draught=10.0).velocity  # 2 at the surface, 1.5 at the keel
    array([1.75, 0.  , 0.  ])
    """

    speed: ArrayLike
    direction: ArrayLike
    _: KW_ONLY
    z: ArrayLike | None = None
    draught: float | None = None
    name: str = "current"
    velocity: Array = field(init=False)

    def __post_init__(self) -> None:
        speed, direction = _real(self.speed, "speed"), _real(self.direction, "direction")
        if np.any(speed < 0.0):
            raise InputError(f"Current: a speed >= 0 in m/s expected, {speed.min():.4g} found; turn the direction instead.")
        check_direction(direction)
        if (self.z is None) != (self.draught is None):
            raise InputError("Current: z and draught together expected (the profile and what to average it over), one found.")
        if self.z is None and (speed.ndim or direction.ndim):
            raise InputError("Current: one speed and direction expected without z, several found; give their heights z.")
        velocity = speed[..., None] * np.stack([np.cos(direction), np.sin(direction), 0.0 * direction], axis=-1)
        if self.z is not None:
            velocity = _average(_heights(self.z, speed, direction), velocity, self.draught)
        velocity.setflags(write=False)
        object.__setattr__(self, "velocity", velocity)

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({CURRENT})

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays for the time loop."""
        return Terms(current=self.velocity)


def _heights(z: ArrayLike, speed: Array, direction: Array) -> Array:
    """Return the checked heights; speed and direction are single or as many."""
    heights = _real(z, "z")
    if heights.ndim != 1 or len(heights) < 2:
        raise InputError(f"Current: z, two heights or more, expected, shape {heights.shape} found.")
    for name, value in (("speed", speed), ("direction", direction)):
        if value.ndim > 1 or (value.ndim == 1 and len(value) != len(heights)):
            raise InputError(f"Current: one {name} or {len(heights)}, one per height, expected, shape {value.shape} found.")
    if not (np.all(np.diff(heights) > 0.0) or np.all(np.diff(heights) < 0.0)):
        raise InputError("Current: heights z in rising or falling order expected, others found.")
    return heights


def _average(z: Array, velocity: Array, draught: float | None) -> Array:
    """Return the mean (3,) of velocities (n, 3), linear in z, over the draught, exactly."""
    T = float(_real(draught, "draught"))
    if not T > 0.0:
        raise InputError(f"Current: a draught > 0 in m expected, {draught!r} found.")
    if z.min() > -T or z.max() < 0.0:
        raise InputError(
            f"Current: a profile from z = 0 down to the draught, {-T:.4g} m, expected, {z.max():.4g} to {z.min():.4g} m found."
        )
    order = np.argsort(z)
    velocity = np.broadcast_to(velocity, (len(z), 3))[order]
    at = np.unique(np.r_[-T, z[(z > -T) & (z < 0.0)], 0.0])
    values = np.stack([np.interp(at, z[order], v) for v in velocity.T], axis=-1)
    return np.trapezoid(values, at, axis=0) / T


def _real(value: Any, name: str) -> Array:
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"Current: {name}, numbers, expected, {type(value).__name__} found.") from None
    if not np.all(np.isfinite(array)):
        raise InputError(f"Current: {name}, finite numbers, expected, NaN or infinite found.")
    return array
