"""Lift of a sailing hull: what keeps it on its course against the fluid's own moment."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import Surroundings, Terms
from ogilvie.loads.kernel import NU_R, Kernel, load_kernel
from ogilvie.units import SEA_WATER

Array = NDArray[Any]

HULL_LIFT = "lift of the hull"


@dataclass(frozen=True, eq=False)
class HullLift:
    """Side force and yaw moment of a hull as a low-aspect-ratio wing: the flow leaves the after end with the momentum it has.

    Parameters
    ----------
    draught : float
        T at the after end, with skeg and rudder, m.
    x : float
        Place of the after end, m from O, negative aft.
    rho : float
        kg/m3.
    name : str

    Raises
    ------
    InputError
        Draught or density not positive, place not finite.

    Notes
    -----
    The cross-flow momentum per length at the after end is a v with a = rho pi T^2 / 2 (a flat plate of draught T below a rigid
    water plane) and the lateral velocity v = v_r + x r there. What a hull of finite after end sheds in its wake acts on it as

        ``Y = -a |u_r| (v_r + x r),   N = x Y``

    for ahead motion: the side force of Jones' wing of low aspect ratio, and the end terms of slender-body and strip theory for
    a hull cut off at x. Small motions take it at the vessel's speed.

    References
    ----------
    Jones (1946), NACA report 835; Newman (1977), Marine Hydrodynamics, section 7.8; Salvesen, Tuck and Faltinsen (1970).

    Examples
    --------
    >>> lift = HullLift(draught=2.0, x=-30.0, rho=1000.0)
    >>> lift.bind(Surroundings(None, 5.0)).kernel.force(nu=[5.0, 0.1, 0, 0, 0, 0]).round()
    array([    0., -3142.,     0.,     0.,     0., 94248.])
    """

    draught: float
    x: float
    rho: float = SEA_WATER
    name: str = "hull_lift"

    def __post_init__(self) -> None:
        for what, value in (("draught", self.draught), ("rho", self.rho)):
            if not (np.isfinite(value) and value > 0.0):
                raise InputError(f"HullLift: a positive {what} expected, {value!r} found.")
        if not np.isfinite(self.x):
            raise InputError(f"HullLift: a finite place x of the after end in m expected, {self.x!r} found.")

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({HULL_LIFT})

    @property
    def end_mass(self) -> float:
        """a, added mass per length of the after end, kg/m."""
        return 0.5 * np.pi * self.rho * self.draught**2

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays for the time loop."""
        D = np.zeros((6, 6))
        D[np.ix_([1, 5], [1, 5])] = self.end_mass * surroundings.speed * np.array([[1.0, self.x], [self.x, self.x**2]])
        return Terms(kernel=Kernel(_lift, np.array([self.end_mass, self.x])), small=Terms(damping=D), suffices=True)


@load_kernel
def _lift(x, data, own, force):
    Y = -data[0] * abs(x[NU_R]) * (x[NU_R + 1] + data[1] * x[NU_R + 5])
    force[1] += Y
    force[5] += data[1] * Y
