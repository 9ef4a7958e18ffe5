"""Restoring with the roll moment of a curve of righting levers."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import RESTORING, Surroundings, Terms
from ogilvie.loads.given import ascending, column, number
from ogilvie.loads.kernel import ETA, Kernel, load_kernel
from ogilvie.loads.pose import add_generalised
from ogilvie.loads.restoring import LinearRestoring
from ogilvie.mesh.gz import GZCurve
from ogilvie.units import GRAVITY

Array = NDArray[Any]


@load_kernel
def gz_force(x: Array, data: Array, own: Array, force: Array) -> None:
    """Restoring; data: stiffness of heave, roll, pitch (3, 3), weight, n; n + 1 ends and 4 n coefficients of cubics."""
    z, phi, theta, n = x[ETA + 2], x[ETA + 3], x[ETA + 4], int(data[10])
    lever = np.nan
    if data[11] <= phi <= data[11 + n]:
        low, high = 0, n - 1
        while low < high:
            middle = (low + high + 1) // 2
            if phi >= data[11 + middle]:
                low = middle
            else:
                high = middle - 1
        s, a = phi - data[11 + low], 12 + n + 4 * low
        lever = ((data[a] * s + data[a + 1]) * s + data[a + 2]) * s + data[a + 3]
    heave = -(data[0] * z + data[1] * phi + data[2] * theta)
    roll = -(data[3] * z + data[9] * lever + data[5] * theta)
    pitch = -(data[6] * z + data[7] * phi + data[8] * theta)
    add_generalised(x, heave, roll, pitch, force)


@dataclass(frozen=True, eq=False, init=False)
class GZRestoring:
    """Restoring that is linear in heave and pitch and follows a curve of righting levers in roll.

    Parameters
    ----------
    stiffness : xarray.Dataset or (6, 6) array
        As for :class:`LinearRestoring`, about O, SI; its roll-roll entry is not used.
    angles : (n,) array
        Heel, ascending, n >= 4, rad. From 0 on the curve is continued as an odd one; otherwise it has to reach both sides.
    gz : (n,) array
        Righting lever, m: positive where it rights a positive heel; 0 at 0 where the curve begins there.
    displacement : float
        Mass, kg.
    g : float
        m/s2.

    Raises
    ------
    InputError
        Shapes, NaN, angles that do not ascend, begin above 0 or are in degrees, a lever at 0 in an odd curve.

    Notes
    -----
    Q_z = -C33 z - C34 phi - C35 theta, Q_phi = -C43 z - m g GZ(phi) - C45 theta, Q_theta = -C53 z - C54 phi - C55 theta, with
    z, phi, theta of the pose, mapped to the body axes by J^T; GZ is a cubic spline. These forces have a potential where the
    stiffness is symmetric. The attribute `stiffness` (6, 6) is their linear limit, with m g GZ'(0) in roll. Beyond the last
    angle the force is NaN and a run stops: the curve says nothing about that heel.

    Examples
    --------
    >>> C = np.diag([0, 0, 1e7, 0, 1e9, 0])
    >>> load = GZRestoring(C, np.radians([0, 10, 20, 30, 40]), [0, 0.2, 0.45, 0.6, 0.5], displacement=1e6, g=10.0)
    >>> load.bind(None).kernel.force(eta=[0, 0, 0, np.radians(-20), 0, 0]).round(3)
    array([      0.,       0.,       0., 4500000.,       0.,       0.])
    """

    data: Array
    stiffness: Array
    limits: str
    name: str = "restoring"

    def __init__(
        self, stiffness: xr.Dataset | ArrayLike, angles: ArrayLike, gz: ArrayLike, *, displacement: float, g: float = GRAVITY
    ) -> None:
        from scipy.interpolate import CubicSpline

        C = LinearRestoring(stiffness).stiffness[2:5, 2:5]
        phi = ascending(angles, "GZRestoring: angles (rad)", fewest=4)
        lever = column(gz, "GZRestoring: gz (m)", n=len(phi))
        if np.abs(phi).max() > np.pi + 1e-9:
            raise InputError(f"GZRestoring: angles within pi rad expected, {np.abs(phi).max():g} found (degrees?).")
        if phi[0] > 0.0 or phi[-1] <= 0.0:
            raise InputError(
                f"GZRestoring: angles from 0, or from both sides of it, expected, {phi[0]:g} to {phi[-1]:g} found."
            )
        if phi[0] == 0.0:
            if abs(lever[0]) > 1e-6 * np.abs(lever).max():
                raise InputError(f"GZRestoring: lever 0 at angle 0 expected in a curve of one side, {lever[0]:g} m found.")
            phi = np.r_[-phi[:0:-1], phi]
            lever = np.r_[-lever[:0:-1], 0.0, lever[1:]]
        weight = number(displacement, "GZRestoring: displacement (kg)", above=0.0) * number(g, "GZRestoring: g", above=0.0)
        spline = CubicSpline(phi, lever)
        data = np.concatenate([C.ravel(), [weight, len(phi) - 1], spline.x, spline.c.T.ravel()])
        tangent = np.zeros((6, 6))
        tangent[2:5, 2:5] = C
        tangent[3, 3] = weight * float(spline(0.0, 1))
        for key, value in (("data", data), ("stiffness", tangent)):
            value.setflags(write=False)
            object.__setattr__(self, key, value)
        object.__setattr__(self, "limits", f"roll {np.degrees(phi[0]):.4g}..{np.degrees(phi[-1]):.4g} deg")
        object.__setattr__(self, "name", "restoring")

    @classmethod
    def from_curve(cls, stiffness: xr.Dataset | ArrayLike, curve: GZCurve, *, g: float = GRAVITY) -> "GZRestoring":
        """Return the restoring with a curve out of :func:`ogilvie.gz_curve`.

        Notes
        -----
        The levers are those at the sinkage and trim of rest at each heel, while this load draws heave and pitch to zero: the
        coupling of a large heel into heave and pitch is left out. :class:`HullRestoring` has it.
        """
        return cls(stiffness, curve.angles, curve.gz, displacement=curve.displacement, g=g)

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({RESTORING})

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the compiled force for the time loop."""
        return Terms(kernel=Kernel(gz_force, self.data, limits=self.limits), small=Terms(stiffness=self.stiffness))
