"""Hydrostatics of a wetted hull from integrals over its panels, exact for the faceted hull."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.inspect import require_usable
from ogilvie.mesh.panels import PanelMesh
from ogilvie.units import GRAVITY, SEA_WATER, tonne

Array = NDArray[np.float64]


class Weight(Protocol):
    """Anything with a mass (kg) and a centre of gravity (3,) from O (m), such as a RigidBody."""

    @property
    def mass(self) -> float: ...

    @property
    def cog(self) -> Array: ...


@dataclass(frozen=True, eq=False)
class Hydrostatics:
    """Displacement, waterplane, stability and stiffness of a hull at rest; print it.

    Parameters
    ----------
    name : str
    volumes : (3,) array
        Displaced volume by the x, y and z integrals, m3.
    center_of_buoyancy : (3,) array
        From O (x forward, y port, z up, still water z = 0), m.
    waterplane_area : float
        m2.
    waterplane_moment : (2,) array
        Integrals of x and y over the waterplane, m3.
    waterplane_inertia : (2, 2) array
        Integrals of x x, x y, y y over the waterplane about O, m4.
    wetted_area : float
        m2.
    length, beam : float
        Extent of the waterline, m (0 if submerged).
    draught : float
        Depth of the lowest point, m.
    cog : (3,) array or None
        Centre of gravity, m.
    mass : float
        Of the body if one was given, else rho * volume, kg.
    stiffness : (6, 6) array
        Restoring coefficients about O, force = -stiffness @ displacement; N/m, N, N m. Without `cog` without the weight's part.
    rho, g : float
        kg/m3, m/s2.
    """

    name: str
    volumes: Array
    center_of_buoyancy: Array
    waterplane_area: float
    waterplane_moment: Array
    waterplane_inertia: Array
    wetted_area: float
    length: float
    beam: float
    draught: float
    cog: Array | None
    mass: float
    stiffness: Array
    rho: float
    g: float

    @property
    def volume(self) -> float:
        """Displaced volume, m3: rho g times it is the vertical force of the water on the panels."""
        return float(self.volumes[2])

    @property
    def displacement(self) -> float:
        """Mass of the displaced water, kg."""
        return self.rho * self.volume

    @property
    def center_of_flotation(self) -> Array:
        """Centroid (x, y) of the waterplane, m; nan if there is none."""
        return self.waterplane_moment / self.waterplane_area if self.waterplane_area > 0.0 else np.full(2, np.nan)

    @property
    def inertia_about_flotation(self) -> Array:
        """Second moments (2, 2) of the waterplane about its centroid, m4."""
        S = self.waterplane_moment
        steiner = np.outer(S, S) / self.waterplane_area if self.waterplane_area > 0.0 else 0.0
        return self.waterplane_inertia - steiner

    @property
    def KB(self) -> float:
        """Height of the centre of buoyancy above the lowest point, m."""
        return float(self.center_of_buoyancy[2]) + self.draught

    @property
    def BM_T(self) -> float:
        """Transverse metacentric radius, m."""
        return float(self.inertia_about_flotation[1, 1]) / self.volume

    @property
    def BM_L(self) -> float:
        """Longitudinal metacentric radius, m."""
        return float(self.inertia_about_flotation[0, 0]) / self.volume

    @property
    def KM_T(self) -> float:
        """Height of the transverse metacentre above the lowest point, m."""
        return self.KB + self.BM_T

    @property
    def KM_L(self) -> float:
        """Height of the longitudinal metacentre above the lowest point, m."""
        return self.KB + self.BM_L

    @property
    def KG(self) -> float:
        """Height of the centre of gravity above the lowest point, m."""
        return float(self._cog()[2]) + self.draught

    @property
    def GM_T(self) -> float:
        """Transverse metacentric height, m."""
        return self.KM_T - self.KG

    @property
    def GM_L(self) -> float:
        """Longitudinal metacentric height, m."""
        return self.KM_L - self.KG

    def _cog(self) -> Array:
        if self.cog is None:
            raise InputError(f"{self.name}: KG and GM need the centre of gravity; call hydrostatics(mesh, cog=...).")
        return self.cog

    def __str__(self) -> str:
        B, F = self.center_of_buoyancy, self.center_of_flotation
        rows: list[tuple[str, float | Array, str]] = [
            ("length of waterline", self.length, "m"),
            ("beam of waterline", self.beam, "m"),
            ("draught", self.draught, "m"),
            ("displaced volume", self.volume, "m3"),
            ("displacement", self.displacement / tonne, "t"),
            ("wetted area", self.wetted_area, "m2"),
            ("waterplane area", self.waterplane_area, "m2"),
            ("centre of buoyancy x, y, z", B, "m"),
            ("centre of flotation x, y", F, "m"),
            ("KB", self.KB, "m"),
            ("BM transverse, longitudinal", np.array([self.BM_T, self.BM_L]), "m"),
            ("KM transverse, longitudinal", np.array([self.KM_T, self.KM_L]), "m"),
        ]
        if self.cog is not None:
            rows += [
                ("mass", self.mass / tonne, "t"),
                ("centre of gravity x, y, z", self.cog, "m"),
                ("GM transverse, longitudinal", np.array([self.GM_T, self.GM_L]), "m"),
            ]
        lines = [f"  {what:28s} {_numbers(value)} {unit}" for what, value, unit in rows]
        return "\n".join([f"hydrostatics of {self.name}", *lines])


def hydrostatics(
    mesh: PanelMesh,
    *,
    cog: ArrayLike | None = None,
    body: Weight | None = None,
    rho: float = SEA_WATER,
    g: float = GRAVITY,
) -> Hydrostatics:
    """Return the hydrostatics of a wetted hull.

    Parameters
    ----------
    mesh : PanelMesh
        Below z = 0, normals into the fluid.
    cog : (3,) array, optional
        Centre of gravity from O, m, of a body that floats freely: its mass is rho * volume.
    body : RigidBody, optional
        In place of `cog`: mass and centre of gravity of a body whose mass may differ (moored, for instance).
    rho, g : float
        kg/m3, m/s2.

    Returns
    -------
    Hydrostatics

    Raises
    ------
    InputError
        The mesh is not a wetted hull, or an argument is out of range.

    Notes
    -----
    With S_x = integral of x over the waterplane and so on, V the volume, (x_b, y_b, z_b) its centroid:
    C33 = rho g A_w, C34 = rho g S_y, C35 = -rho g S_x, C44 = rho g (S_yy + V z_b) - m g z_g, C45 = -rho g S_xy,
    C46 = -rho g V x_b + m g x_g, C55 = rho g (S_xx + V z_b) - m g z_g, C56 = -rho g V y_b + m g y_g; C43, C53, C54 by
    symmetry, all others zero. Integrals over the waterplane are minus those of n_z over the hull.

    References
    ----------
    J. N. Newman, Marine Hydrodynamics (1977), section 6.16; WAMIT User Manual, chapter 3.

    Examples
    --------
    >>> v = [[-5.0, 0, -1], [5, 0, -1], [5, 2, -1], [-5, 2, -1], [-5, 0, 0], [5, 0, 0], [5, 2, 0], [-5, 2, 0]]
    >>> f = [[0, 3, 2, 1], [2, 3, 7, 6], [1, 2, 6, 5], [0, 4, 7, 3]]
    >>> barge = hydrostatics(PanelMesh(v, f, symmetry="xz", name="barge"), cog=[0.0, 0.0, 0.2])
    >>> barge.volume, round(barge.BM_T, 6), round(barge.GM_T, 6)  # BM = B^2 / 12 T
    (40.0, 1.333333, 0.633333)
    """
    require_usable(mesh)
    if not (np.isfinite(rho) and rho > 0.0 and np.isfinite(g) and g > 0.0):
        raise InputError(f"hydrostatics: positive rho and g expected, {rho!r} and {g!r} found.")
    mass, center = _weight(mesh, cog, body, rho)
    M0, M1, M2 = mesh.moments
    on_waterline = np.abs(mesh.vertices[:, 2]) <= mesh.tolerance
    extent = _extent(mesh, on_waterline)
    pierces = float(on_waterline.any())  # a submerged body has no waterplane
    Aw, S, SS = -M0[2] * pierces + 0.0, -M1[2, :2] * pierces + 0.0, -M2[2, :2, :2] * pierces + 0.0
    return Hydrostatics(
        name=mesh.name,
        volumes=mesh.volumes,
        center_of_buoyancy=mesh.center_of_buoyancy,
        waterplane_area=float(Aw),
        waterplane_moment=S,
        waterplane_inertia=SS,
        wetted_area=mesh.wetted_area,
        length=float(extent[0]),
        beam=float(extent[1]),
        draught=mesh.draught,
        cog=center,
        mass=mass,
        stiffness=_stiffness(mesh, Aw, S, SS, mass, center, rho, g),
        rho=rho,
        g=g,
    )


def _weight(mesh: PanelMesh, cog: ArrayLike | None, body: Weight | None, rho: float) -> tuple[float, Array | None]:
    if cog is not None and body is not None:
        raise InputError("hydrostatics: cog or body expected, both found.")
    if body is not None:
        return float(body.mass), np.asarray(body.cog, dtype=float)
    if cog is None:
        return rho * mesh.volume, None
    center = np.array(cog, dtype=float)
    if center.shape != (3,) or not np.all(np.isfinite(center)):
        raise InputError(f"cog: three finite lengths (m) expected, {cog!r} found.")
    return rho * mesh.volume, center


def _stiffness(mesh: PanelMesh, Aw: float, S: Array, SS: Array, mass: float, cog: Array | None, rho: float, g: float) -> Array:
    Vb = mesh.volume * mesh.center_of_buoyancy
    mG = np.zeros(3) if cog is None else mass / rho * cog
    C = np.zeros((6, 6))
    C[2, 2] = Aw
    C[2, 3] = C[3, 2] = S[1]
    C[2, 4] = C[4, 2] = -S[0]
    C[3, 3] = SS[1, 1] + Vb[2] - mG[2]
    C[3, 4] = C[4, 3] = -SS[0, 1]
    C[3, 5] = mG[0] - Vb[0]
    C[4, 4] = SS[0, 0] + Vb[2] - mG[2]
    C[4, 5] = mG[1] - Vb[1]
    return rho * g * (C + 0.0)


def _extent(mesh: PanelMesh, on_waterline: NDArray[np.bool_]) -> Array:
    """Return length and beam of the whole waterline."""
    points = mesh.vertices[on_waterline]
    if len(points) == 0:
        return np.zeros(2)
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    for plane in mesh.planes:
        i = 1 if plane == "xz" else 0
        high[i] = max(high[i], -low[i])
        low[i] = -high[i]
    return high - low


def _numbers(value: float | Array) -> str:
    return " ".join(f"{v:12.6g}" for v in np.atleast_1d(value))
