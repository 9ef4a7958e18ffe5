"""The rigid body: mass, centre of gravity, inertia."""

import warnings
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.frames import skew
from ogilvie.units import SEA_WATER

Array = NDArray[np.float64]

_ROUNDING = 0.02  # violation of the triangle inequality that rounded radii of gyration of real ships show: a warning


@dataclass(frozen=True, eq=False)
class RigidBody:
    """Mass, centre of gravity and inertia of a rigid body.

    Parameters
    ----------
    mass : float
        kg, > 0.
    cog : (3,) array
        Centre of gravity from O (origin on the still water plane; x forward, y port, z up), m.
    inertia : (3, 3) array
        Moments of inertia about the centre of gravity, kg m2; off-diagonal entries are -int x y dm.

    Raises
    ------
    InputError
        Mass not positive; inertia not symmetric, not positive definite, or principal moments that violate the triangle
        inequality I1 + I2 >= I3 (no distribution of mass has such moments) by more than 2 %; a smaller violation warns.

    Examples
    --------
    >>> body = RigidBody(mass=1000.0, cog=[0.0, 0.0, -0.5], inertia=np.diag([200.0, 900.0, 1000.0]))
    >>> body.matrix.shape, float(body.matrix[0, 4])
    ((6, 6), -500.0)
    """

    mass: float
    cog: Array
    inertia: Array
    name: str = field(default="body")

    def __post_init__(self) -> None:
        mass = float(self.mass)
        cog, inertia = np.array(self.cog, dtype=float), np.array(self.inertia, dtype=float)
        if not (np.isfinite(mass) and mass > 0.0):
            raise InputError(f"mass: a positive number of kg expected, {self.mass!r} found.")
        if cog.shape != (3,) or not np.all(np.isfinite(cog)):
            raise InputError(f"cog: three finite numbers (m) expected, {self.cog!r} found.")
        if inertia.shape == (3,):
            inertia = np.diag(inertia)
        _check_inertia(inertia)
        cog.setflags(write=False)
        inertia.setflags(write=False)
        object.__setattr__(self, "mass", mass)
        object.__setattr__(self, "cog", cog)
        object.__setattr__(self, "inertia", inertia)

    @classmethod
    def from_gyradii(cls, mass: float, *, cog: ArrayLike, gyradii: ArrayLike, name: str = "body") -> "RigidBody":
        """Return a body from its radii of gyration (kxx, kyy, kzz) about the centre of gravity, m: I = m k^2.

        Examples
        --------
        >>> RigidBody.from_gyradii(2.0, cog=[0, 0, 0], gyradii=(1.0, 2.0, 2.0)).inertia.diagonal()
        array([2., 8., 8.])
        """
        k = np.asarray(gyradii, dtype=float)
        if k.shape != (3,) or not np.all(k > 0):
            raise InputError(f"gyradii: three positive lengths (kxx, kyy, kzz) in m expected, {gyradii!r} found.")
        return cls(mass, np.asarray(cog, dtype=float), np.diag(mass * k**2), name)

    @classmethod
    def from_hull(
        cls, hull: Any, *, gyradii: ArrayLike, kg: float | None = None, zg: float | None = None, rho: float = SEA_WATER
    ) -> "RigidBody":
        """Return the body that floats at rest with this wetted hull: mass = rho * volume, centre of gravity above buoyancy.

        Parameters
        ----------
        hull : PanelMesh
            Wetted hull, still water at z = 0.
        gyradii : (3,) array
            Radii of gyration kxx, kyy, kzz about the centre of gravity, m.
        kg : float, optional
            Height of the centre of gravity above the lowest point of the hull, m.
        zg : float, optional
            Height of the centre of gravity above the still water, m (negative below). Give `kg` or `zg`.
        rho : float
            Density of the water, kg/m3.
        """
        if (kg is None) == (zg is None):
            raise InputError("from_hull: exactly one of kg (above keel) and zg (above still water) expected.")
        keel = float(hull.vertices[:, 2].min())
        z = keel + kg if kg is not None else zg
        if not hull.volume > 0.0:
            raise InputError(
                f"from_hull: a wetted hull with a volume below the still water expected, {hull.volume:.4g} m3 found. "
                "Put it in the water: hull.immersed(draught=...)."
            )
        xb, yb, _ = hull.center_of_buoyancy
        return cls.from_gyradii(rho * hull.volume, cog=[xb, yb, z], gyradii=gyradii, name=hull.name)

    @property
    def matrix(self) -> Array:
        """Inertia matrix (6, 6) about O: [[m 1, -m S(cog)], [m S(cog), I + m S^T S]]; paper C (11)."""
        m, S = self.mass, skew(self.cog)
        M = np.zeros((6, 6))
        M[:3, :3] = m * np.eye(3)
        M[:3, 3:] = -m * S
        M[3:, :3] = m * S
        M[3:, 3:] = self.inertia + m * S.T @ S
        return M

    @property
    def gyradii(self) -> Array:
        """Radii of gyration (3,) about the centre of gravity, m."""
        return np.sqrt(np.diag(self.inertia) / self.mass)


def _check_inertia(inertia: Array) -> None:
    if inertia.shape != (3, 3) or not np.all(np.isfinite(inertia)):
        raise InputError(f"inertia: a finite (3, 3) matrix or three moments (kg m2) expected, shape {inertia.shape} found.")
    scale = np.abs(inertia).max()
    if not np.allclose(inertia, inertia.T, rtol=0, atol=1e-6 * scale):
        raise InputError("inertia: a symmetric matrix expected, found one that is not; give -int x y dm in both places.")
    I = np.linalg.eigvalsh(inertia)  # ascending
    if I[0] <= 0.0:
        raise InputError(f"inertia: positive principal moments expected, {I.tolist()} found.")
    excess = I[2] / (I[0] + I[1]) - 1.0
    if excess > 1e-9:
        found = (
            f"inertia: principal moments {I[0]:.6g}, {I[1]:.6g}, {I[2]:.6g} kg m2 violate the triangle inequality "
            f"I1 + I2 >= I3 by {excess:.2%}; no mass distribution has them. Check radii of gyration and reference point."
        )
        if excess > _ROUNDING:
            raise InputError(found)
        warnings.warn(found, OgilvieWarning, stacklevel=4)
