"""The hull as flat panels: an immutable mesh with its symmetry."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.frames import rotation_matrix
from ogilvie.mesh.clip import clip_below
from ogilvie.mesh.integrals import MIRROR, panel_geometry, reversed_faces, surface_moments
from ogilvie.mesh.smooth import Surface
from ogilvie.mesh.topology import half, with_mirror_image

Array = NDArray[np.float64]
Faces = NDArray[np.int64]
Symmetry = Literal["none", "xz", "xz+yz"]
Plane = Literal["xz", "yz"]

#: Lengths below this part of the hull's largest extent are taken as zero (vertices on z = 0 or on a plane of symmetry).
RELATIVE_TOLERANCE = 1e-8

_SYMMETRIES: tuple[Symmetry, ...] = ("none", "xz", "xz+yz")
_PLANES: dict[str, tuple[Plane, ...]] = {"none": (), "xz": ("xz",), "xz+yz": ("xz", "yz")}


@dataclass(frozen=True, eq=False, repr=False)
class PanelMesh:
    """Panels of a hull below (or also above) still water, z = 0; x forward, y port, z up, metres.

    Parameters
    ----------
    vertices : (n_v, 3) array
        m.
    faces : (n_f, 4) int array
        Vertex indices; a triangle repeats its third vertex. Seen from the fluid the vertices run anticlockwise, so that
        normals point into the fluid.
    symmetry : {"none", "xz", "xz+yz"}
        Planes of symmetry; only the part y >= 0 (and x >= 0) is stored.
    name : str
    lid : PanelMesh, optional
        Interior panels of the waterplane (z = 0) against irregular frequencies; no part of the hull's geometry.
    surface : SmoothSurface or SurfaceCorners, optional
        The smooth hull below the water that the panels stand for, where it is known; it moves with them, and is left out where
        panels are cut elsewhere than at its waterline, or turned over.

    Notes
    -----
    A quadrilateral is two triangles sharing the diagonal from its first to its third vertex: all integrals are exact for that
    polyhedron. `n_faces`, `centers`, `normals`, `areas` speak of the stored panels; volumes, areas, centres and extents of
    the whole hull, mirror images included. Every operation returns a new mesh; one that breaks a symmetry expands it first.

    Examples
    --------
    >>> v = [[0.0, 0, -1], [2, 0, -1], [2, 1, -1], [0, 1, -1], [0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0]]
    >>> f = [[0, 3, 2, 1], [2, 3, 7, 6], [1, 2, 6, 5], [0, 4, 7, 3]]
    >>> barge = PanelMesh(v, f, symmetry="xz", name="barge")
    >>> barge
    PanelMesh 'barge': 4 panels (xz), 2 x 2 x 1 m, volume 4 m3
    >>> barge.immersed(draught=0.25).volume, barge.center_of_buoyancy.tolist()
    (1.0, [1.0, 0.0, -0.5])
    """

    vertices: Array
    faces: Faces
    symmetry: Symmetry = "none"
    name: str = "hull"
    lid: "PanelMesh | None" = None
    surface: Surface | None = None

    def __post_init__(self) -> None:
        vertices = np.array(self.vertices, dtype=float)
        faces = np.array(self.faces, dtype=np.int64)
        if vertices.ndim != 2 or vertices.shape[1] != 3 or not np.all(np.isfinite(vertices)):
            raise InputError(f"vertices: finite (n, 3) array expected, shape {vertices.shape} found (or NaN in it).")
        if faces.ndim != 2 or faces.shape[1] != 4 or len(faces) == 0:
            raise InputError(f"faces: (n, 4) array with n >= 1 expected, shape {faces.shape} found.")
        if faces.min() < 0 or faces.max() >= len(vertices):
            raise InputError(f"faces: indices 0..{len(vertices) - 1} expected, {faces.min()}..{faces.max()} found.")
        if self.symmetry not in _PLANES:
            raise InputError(f"symmetry: 'none', 'xz' or 'xz+yz' expected, {self.symmetry!r} found.")
        if self.lid is not None and self.lid.symmetry != self.symmetry:
            raise InputError(
                f"lid: the hull's symmetry {self.symmetry!r} expected, {self.lid.symmetry!r} found. "
                f"Use lid.with_symmetry({self.symmetry!r})."
            )
        vertices.setflags(write=False)
        faces.setflags(write=False)
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", faces)

    def __repr__(self) -> str:
        lid = f" + {self.lid.n_faces} lid panels" if self.lid is not None else ""
        extent = " x ".join(f"{e:.6g}" for e in np.ptp(self.bounds, axis=0))
        return f"PanelMesh {self.name!r}: {self.n_faces} panels ({self.symmetry}){lid}, {extent} m, volume {self.volume:.6g} m3"

    # ---- stored panels

    @property
    def n_faces(self) -> int:
        """Number of stored panels."""
        return len(self.faces)

    @property
    def planes(self) -> tuple[Plane, ...]:
        """Planes of symmetry, of "xz" (y = 0) and "yz" (x = 0)."""
        return _PLANES[self.symmetry]

    @cached_property
    def is_triangle(self) -> NDArray[np.bool_]:
        """True for panels (n_f,) with three distinct vertices."""
        f = np.sort(self.faces, axis=1)
        return np.asarray((np.diff(f, axis=1) == 0).sum(axis=1) == 1)

    @cached_property
    def _geometry(self) -> tuple[Array, Array, Array]:
        return panel_geometry(self.vertices, self.faces)

    @cached_property
    def centers(self) -> Array:
        """Centroids (n_f, 3) of the panels, m."""
        return _locked(self._geometry[0])

    @cached_property
    def area_vectors(self) -> Array:
        """Integral of the normal over each panel (n_f, 3), m2; their sum over a closed hull is zero."""
        return _locked(self._geometry[1])

    @cached_property
    def normals(self) -> Array:
        """Unit normals (n_f, 3) into the fluid; zero for a panel without area."""
        size = np.linalg.norm(self.area_vectors, axis=1, keepdims=True)
        return _locked(self.area_vectors / np.where(size > 0.0, size, 1.0))

    @cached_property
    def areas(self) -> Array:
        """Areas (n_f,) of the panels, m2: the lengths of `area_vectors`, so that areas * normals closes exactly."""
        return _locked(np.linalg.norm(self.area_vectors, axis=1))

    # ---- whole hull

    @cached_property
    def moments(self) -> tuple[Array, Array, Array]:
        """Integrals of n_i (3,), n_i x_j (3, 3) and n_i x_j x_k (3, 3, 3) over the whole hull; m2, m3, m4."""
        M0, M1, M2 = surface_moments(self.vertices, self.faces, planes=self.planes)
        return _locked(M0), _locked(M1), _locked(M2)

    @property
    def volumes(self) -> Array:
        """Displaced volume by the integrals of n_x x, n_y y, n_z z (3,), m3; they agree where the hull has no holes.

        The hull is closed by z = 0 (which adds nothing to any of them) or is closed itself.
        """
        return self.moments[1].diagonal()

    @property
    def volume(self) -> float:
        """Displaced volume by the integral of n_z z, m3: the buoyancy of these panels is rho g times it, holes or not."""
        return float(self.volumes[2])

    @cached_property
    def center_of_buoyancy(self) -> Array:
        """Point (3,) where the buoyancy attacks, m: integrals of n_z x z, n_z y z and n_z z^2 / 2, divided by the volume."""
        if self.volume == 0.0:
            raise InputError(f"center_of_buoyancy: {self.name!r} encloses no volume.")
        return _locked(self.moments[2][2, :, 2] * [1.0, 1.0, 0.5] / self.volume)

    @cached_property
    def wetted_area(self) -> float:
        """Area of all panels and their mirror images, m2 (clip the hull first if it reaches above water)."""
        return float(self._geometry[2].sum()) * 2 ** len(self.planes)

    @cached_property
    def bounds(self) -> Array:
        """Lowest and highest x, y, z (2, 3) of the whole hull, m."""
        used = self.vertices[np.unique(self.faces)]
        low, high = used.min(axis=0), used.max(axis=0)
        for plane in self.planes:
            i = 1 if plane == "xz" else 0
            high[i] = max(high[i], -low[i])
            low[i] = -high[i]
        return _locked(np.array([low, high]))

    @property
    def length(self) -> float:
        """Extent in x, m."""
        return float(np.ptp(self.bounds[:, 0]))

    @property
    def beam(self) -> float:
        """Extent in y, m."""
        return float(np.ptp(self.bounds[:, 1]))

    @property
    def draught(self) -> float:
        """Depth of the lowest point below z = 0, m (negative where the hull is above water)."""
        return float(-self.bounds[0, 2])

    @property
    def tolerance(self) -> float:
        """Length taken as zero for this hull, m."""
        return RELATIVE_TOLERANCE * float(np.ptp(self.bounds, axis=0).max())

    # ---- new meshes

    def named(self, name: str) -> "PanelMesh":
        """Return the mesh under another name."""
        return replace(self, name=name)

    def with_lid(self, lid: "PanelMesh | None") -> "PanelMesh":
        """Return the mesh with these interior panels at z = 0 (None: without)."""
        if lid is not None and np.abs(lid.bounds[:, 2]).max() > self.tolerance:
            raise InputError(f"with_lid: panels at z = 0 expected, z {lid.bounds[0, 2]:.6g} to {lid.bounds[1, 2]:.6g} m found.")
        return replace(self, lid=lid)

    def full(self) -> "PanelMesh":
        """Return the whole hull, mirror images as panels of their own; symmetry "none"."""
        return self._expanded(())

    def with_symmetry(self, symmetry: Symmetry) -> "PanelMesh":
        """Return the same hull stored with these planes of symmetry.

        Raises
        ------
        InputError
            The hull does not have the symmetry, or a panel crosses the plane.
        """
        if symmetry not in _PLANES:
            raise InputError(f"symmetry: 'none', 'xz' or 'xz+yz' expected, {symmetry!r} found.")
        mesh = self._expanded(_PLANES[symmetry])
        for plane in _PLANES[symmetry][len(mesh.planes) :]:
            mesh = mesh._halved(plane)
        return mesh

    def translated(self, offset: ArrayLike) -> "PanelMesh":
        """Return the mesh moved by (dx, dy, dz), m."""
        d = np.asarray(offset, dtype=float)
        if d.shape != (3,):
            raise InputError(f"translated: three lengths (dx, dy, dz) in m expected, {offset!r} found.")
        mesh = self._kept(xz=d[1] == 0.0, yz=d[0] == 0.0)
        return mesh._moved(lambda v: v + d)

    def rotated(
        self, phi: float = 0.0, theta: float = 0.0, psi: float = 0.0, *, about: ArrayLike = (0.0, 0.0, 0.0)
    ) -> "PanelMesh":
        """Return the mesh turned by R = Rz(psi) Ry(theta) Rx(phi) about a point.

        Parameters
        ----------
        phi, theta, psi : float
            Roll, pitch (positive bow down) and yaw, rad.
        about : (3,) array
            Fixed point of the rotation, m.
        """
        R, p = rotation_matrix(phi, theta, psi), np.asarray(about, dtype=float)
        if p.shape != (3,):
            raise InputError(f"rotated: a point (x, y, z) in m expected, {about!r} found.")
        mesh = self._kept(xz=phi == 0.0 and psi == 0.0, yz=phi == theta == psi == 0.0)
        return mesh._moved(lambda v: (v - p) @ R.T + p)

    def scaled(self, factor: float) -> "PanelMesh":
        """Return the mesh with all lengths multiplied by `factor` > 0."""
        if not (np.isfinite(factor) and factor > 0.0):
            raise InputError(f"scaled: a positive factor expected, {factor!r} found.")
        return self._moved(lambda v: v * factor)

    def mirrored(self, plane: Plane) -> "PanelMesh":
        """Return the mirror image at the plane y = 0 ("xz") or x = 0 ("yz"); normals still point into the fluid."""
        if plane not in MIRROR:
            raise InputError(f"mirrored: 'xz' or 'yz' expected, {plane!r} found.")
        if plane in self.planes:
            return self
        surface = self.surface.mirrored(plane) if self.surface is not None else None
        bare = replace(self, surface=None)
        return replace(bare._moved(lambda v: v * MIRROR[plane]).flipped(), surface=surface)

    def flipped(self) -> "PanelMesh":
        """Return the mesh with all panels turned over (the lid stays as it is)."""
        return replace(self, faces=reversed_faces(self.faces), surface=None)

    def immersed(self, draught: float | None = None) -> "PanelMesh":
        """Return the part below z = 0, after a shift that puts the lowest point at z = -draught.

        Parameters
        ----------
        draught : float, optional
            m, > 0; None: no shift.

        Notes
        -----
        A lid that the shift takes off z = 0 is left out: it belongs to another waterline.

        Raises
        ------
        InputError
            Draught not positive, nothing is below the water, or an open hull would be wholly below it.
        """
        mesh = self
        if draught is not None:
            if not (np.isfinite(draught) and draught > 0.0):
                raise InputError(f"immersed: a positive draught in m expected, {draught!r} found.")
            mesh = self.translated((0.0, 0.0, -draught - self.bounds[0, 2]))
            mesh._refuse_sunk(draught)
        vertices, faces = clip_below(mesh.vertices, mesh.faces, tolerance=mesh.tolerance)
        if len(faces) == 0:
            low = mesh.bounds[0, 2]
            raise InputError(
                f"immersed: panels of {self.name!r} below z = 0 expected, lowest z {low + 0.0:.6g} m found; give a draught."
            )
        keeps_lid = mesh.lid is not None and np.abs(mesh.lid.bounds[:, 2]).max() <= mesh.tolerance
        surface = mesh.surface if mesh._cut_at_waterline_of_surface() else None
        return replace(mesh, vertices=vertices, faces=faces, lid=mesh.lid if keeps_lid else None, surface=surface)

    # ---- helpers

    def _refuse_sunk(self, draught: float) -> None:
        """Refuse a hull that is open above and ends below the water."""
        top = float(self.bounds[1, 2])
        if top < -self.tolerance and abs(self.area_vectors[:, 2].sum()) > 1e-3 * self.areas.sum():
            raise InputError(
                f"immersed: a draught of at most {draught + top:.6g} m, the height of {self.name!r}, expected, {draught:g} "
                "found: the hull would end below the water. A mesh that was cut at its waterline needs no draught."
            )

    def _cut_at_waterline_of_surface(self) -> bool:
        """Return whether z = 0 cuts nothing off the hull's smooth surface."""
        if self.surface is None or self.bounds[1, 2] <= self.tolerance:
            return True
        return abs(float(self.surface.bounds[1, 2])) <= 1e2 * self.tolerance

    def _moved(self, transform: Callable[[Array], Array]) -> "PanelMesh":
        lid = self.lid._moved(transform) if self.lid is not None else None
        surface = self.surface.moved(transform) if self.surface is not None else None
        return replace(self, vertices=transform(self.vertices), lid=lid, surface=surface)

    def _kept(self, *, xz: bool, yz: bool) -> "PanelMesh":
        """Return the mesh with only those planes of symmetry that an operation leaves alone."""
        return self._expanded(("xz", "yz") if xz and yz else ("xz",) if xz else ())

    def _expanded(self, planes: tuple[Plane, ...]) -> "PanelMesh":
        vertices, faces, surface, tolerance = self.vertices, self.faces, self.surface, self.tolerance
        left = len(self.planes)
        while left > len(planes):
            left -= 1
            surface = surface.with_mirror_image(self.planes[left]) if surface is not None else None
            vertices, faces = with_mirror_image(vertices, faces, plane=self.planes[left], tolerance=tolerance)
        lid = self.lid._expanded(planes) if self.lid is not None else None
        return (
            self
            if left == len(self.planes)
            else replace(self, vertices=vertices, faces=faces, symmetry=_SYMMETRIES[left], lid=lid, surface=surface)
        )

    def _halved(self, plane: Plane) -> "PanelMesh":
        vertices, faces = half(self.vertices, self.faces, plane=plane, tolerance=1e2 * self.tolerance)
        lid = self.lid._halved(plane) if self.lid is not None else None
        symmetry, surface = _SYMMETRIES[len(self.planes) + 1], self.surface.half(plane) if self.surface is not None else None
        return replace(self, vertices=vertices, faces=faces, symmetry=symmetry, lid=lid, surface=surface)


def _locked(array: Array) -> Array:
    array.setflags(write=False)
    return array
