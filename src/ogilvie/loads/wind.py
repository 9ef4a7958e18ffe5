"""The force of the wind on what stands above the water."""

from dataclasses import KW_ONLY, dataclass
from math import atan2, cos, pi, sin
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import Surroundings, Terms
from ogilvie.loads.kernel import NU, ROTATION, TIME, Kernel, load_kernel
from ogilvie.loads.lookup import cubic_value, periodic_spline, periodic_value
from ogilvie.loads.wind_coefficients import INTERVALS, WindCoefficients
from ogilvie.waves.gust import positive
from ogilvie.waves.wind import Wind

Array = NDArray[Any]

#: The physical effect.
WIND = "wind"
#: Density of air at 15 deg C and standard pressure, kg/m3.
AIR = 1.225

_HALF_RHO, _MEAN, _COS, _SIN, _STEP, _POINT, _TABLE = 0, 1, 2, 3, 4, 5, 8
_PER_DEGREE = INTERVALS / (2.0 * pi)
_ROWS = 16  # numbers per degree: X, Y, K, N by four coefficients


@dataclass(frozen=True, eq=False)
class WindForce:
    """Force of the wind relative to the vessel: q A C(angle) in surge, sway, roll and yaw.

    Parameters
    ----------
    coefficients : WindCoefficients
        From :func:`ogilvie.isherwood_wind`, :func:`ogilvie.blendermann_wind` or measured.
    wind : Wind
    height : float
        Where the speed of the wind is taken, m above still water: the height that the coefficients are referred to.
    point : (3,) array
        Reference point of the coefficients, from O, m; for Isherwood and Blendermann half the length, on the waterline.
    rho : float
        Density of air, kg/m3.

    Raises
    ------
    InputError
        No coefficients, no wind, wrong shape, numbers that are not positive.

    Notes
    -----
    v = R^T (W(t), 0) - nu - omega x p, the velocity of the air seen from the point p, in body axes; its first two components
    count: q = rho (v_1^2 + v_2^2)/2, angle = atan2(v_2, v_1). X = q A_F CX, Y = q A_L CY, K = q A_L H CK, N = q A_L L CN act
    at p along the axes of the body and are moved to O. W(t) = U(z) + u(t): mean speed and gusts at the height z, in one
    direction, the same over the whole ship. The gusts are read from a cubic spline through their table. A heeled ship keeps
    the coefficients of the upright one.

    References
    ----------
    Fossen (2011), Handbook of marine craft hydrodynamics and motion control, 8.1.

    Examples
    --------
    >>> from ogilvie.loads.wind_blendermann import blendermann_wind
    >>> ship = blendermann_wind("ferry", frontal_area=500, lateral_area=2500, length=150, centroid_height=9)
    >>> load = WindForce(ship, Wind(20.0, np.pi))
    >>> load.kernel.force().round() + 0.0  # from ahead
    array([-55125.,      0.,      0.,      0.,      0.,      0.])
    """

    coefficients: WindCoefficients
    wind: Wind
    _: KW_ONLY
    height: float = 10.0
    point: ArrayLike = (0.0, 0.0, 0.0)
    rho: float = AIR
    name: str = "wind"

    def __post_init__(self) -> None:
        if not isinstance(self.coefficients, WindCoefficients):
            raise InputError(f"WindForce: WindCoefficients expected first, {type(self.coefficients).__name__} found.")
        if not isinstance(self.wind, Wind):
            raise InputError(f"WindForce: a Wind expected second, {type(self.wind).__name__} found.")
        object.__setattr__(self, "height", positive(self.height, "WindForce: height"))
        object.__setattr__(self, "rho", positive(self.rho, "WindForce: rho"))
        point = np.array(self.point, dtype=float)
        if point.shape != (3,) or not np.all(np.isfinite(point)):
            raise InputError(f"WindForce: point, three finite numbers in m, expected, {self.point!r} found.")
        point.setflags(write=False)
        object.__setattr__(self, "point", point)

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({WIND})

    @property
    def kernel(self) -> Kernel:
        """The compiled force, with the table of gusts of each realisation."""
        wind = self.wind
        step = wind.step if wind.gust is not None else 1.0
        head = [0.5 * self.rho, wind.mean(self.height), cos(wind.direction), sin(wind.direction), step, *np.asarray(self.point)]
        own = np.zeros((1, 0)) if wind.gust is None else periodic_spline(wind.gusts(self.height))
        return Kernel(_wind_force, np.r_[head, self.coefficients.force_areas().ravel()], own)

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays for the time loop."""
        return Terms(kernel=self.kernel)


@load_kernel
def _wind_force(x, data, own, force):
    """Add the wind force; data: head and table of force areas, own: spline of the gusts (empty without)."""
    W = data[_MEAN]
    if len(own) > 0:
        W += periodic_value(own, x[TIME] / data[_STEP])
    w1, w2 = W * data[_COS], W * data[_SIN]
    p1, p2, p3 = data[_POINT], data[_POINT + 1], data[_POINT + 2]
    v1 = x[ROTATION] * w1 + x[ROTATION + 3] * w2 - (x[NU] + x[NU + 4] * p3 - x[NU + 5] * p2)
    v2 = x[ROTATION + 1] * w1 + x[ROTATION + 4] * w2 - (x[NU + 1] + x[NU + 5] * p1 - x[NU + 3] * p3)
    q = data[_HALF_RHO] * (v1 * v1 + v2 * v2)
    s = atan2(v2, v1) * _PER_DEGREE
    if s < 0.0:
        s += INTERVALS
    i = min(int(s), INTERVALS - 1)
    s -= i
    row = _TABLE + _ROWS * i
    X = q * cubic_value(data, row, s)
    Y = q * cubic_value(data, row + 4, s)
    K = q * cubic_value(data, row + 8, s)
    N = q * cubic_value(data, row + 12, s)
    force[0] += X
    force[1] += Y
    force[3] += K - p3 * Y
    force[4] += p3 * X
    force[5] += N + p1 * Y - p2 * X
