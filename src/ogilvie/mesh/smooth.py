"""A smooth hull: a few four-sided patches, each a polynomial through its points; or panels whose corners lie on it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.chebyshev import chebyshev_points, differentiation, interpolation
from ogilvie.mesh.integrals import MIRROR, reversed_faces
from ogilvie.mesh.topology import half, with_mirror_image

Array = NDArray[np.float64]
Faces = NDArray[np.int64]
Plane = Literal["xz", "yz"]

_NEAR = 1e-6  #: of the extent, corners nearer to a plane of symmetry lie in it


@dataclass(frozen=True, eq=False)
class SmoothSurface:
    """Four-sided patches that meet along whole sides; with mirror images as the panel mesh that carries it.

    Parameters
    ----------
    patches : tuple of (m, n, 3) arrays
        m. Positions at the products of m and n Chebyshev points -cos(pi i/(m - 1)) of u and v; the patch is the polynomial
        through them. x_u x x_v points into the fluid. Patches that share a side have the same points along it.

    Examples
    --------
    >>> u, v = np.meshgrid([-1.0, 1.0], [-1.0, 1.0], indexing="ij")
    >>> bottom = SmoothSurface((np.stack([v, u, -1.0 + 0.0 * u], axis=-1),))
    >>> bottom.at(0, [0.0], [0.5]).tolist(), bottom.volume
    ([[[0.5, 0.0, -1.0]]], 4.0)
    """

    patches: tuple[Array, ...]

    def __post_init__(self) -> None:
        patches = tuple(np.array(p, dtype=float) for p in self.patches)
        for i, p in enumerate(patches):
            if p.ndim != 3 or p.shape[2] != 3 or min(p.shape[:2]) < 2 or not np.all(np.isfinite(p)):
                raise InputError(f"patches[{i}]: finite (m, n, 3) array, m, n >= 2, expected; shape {p.shape} found (or NaN).")
            p.setflags(write=False)
        if not patches:
            raise InputError("patches: at least one expected, none found.")
        object.__setattr__(self, "patches", patches)

    def at(self, patch: int, u: ArrayLike, v: ArrayLike) -> Array:
        """Return the positions (n_u, n_v, 3) of one patch at the products of u (n_u,) and v (n_v,), both within -1..1."""
        p = self.patches[patch]
        U, V = interpolation(p.shape[0], u), interpolation(p.shape[1], v)
        return np.asarray(np.einsum("ai,bj,ijk->abk", U, V, p))

    def normal(self, patch: int, u: ArrayLike, v: ArrayLike) -> Array:
        """Return x_u x x_v (n_u, n_v, 3), into the fluid, at the products of u and v."""
        p = self.patches[patch]
        U, V = interpolation(p.shape[0], u), interpolation(p.shape[1], v)
        DU, DV = U @ differentiation(p.shape[0]), V @ differentiation(p.shape[1])
        return np.cross(np.einsum("ai,bj,ijk->abk", DU, V, p), np.einsum("ai,bj,ijk->abk", U, DV, p))

    @property
    def volume(self) -> float:
        """Integral of n_z z over the patches, mirror images not included, m3."""
        total = 0.0
        for i, p in enumerate(self.patches):
            (u, wu), (v, wv) = (np.polynomial.legendre.leggauss(2 * n) for n in p.shape[:2])
            total += float(np.einsum("a,b,ab,ab->", wu, wv, self.normal(i, u, v)[..., 2], self.at(i, u, v)[..., 2]))
        return total

    @property
    def bounds(self) -> Array:
        """Lowest and highest x, y, z (2, 3) of a fine sample of the patches, m."""
        fine = chebyshev_points(33)
        points = np.concatenate([self.at(i, fine, fine).reshape(-1, 3) for i in range(len(self.patches))])
        return np.array([points.min(axis=0), points.max(axis=0)])

    def moved(self, transform: Callable[[Array], Array]) -> "SmoothSurface":
        """Return the surface with an affine map, that keeps the hand, applied to its points (n, 3)."""
        return SmoothSurface(tuple(transform(p.reshape(-1, 3)).reshape(p.shape) for p in self.patches))

    def mirrored(self, plane: Plane) -> "SmoothSurface":
        """Return the mirror image at y = 0 ("xz") or x = 0 ("yz")."""
        return SmoothSurface(tuple((p * MIRROR[plane] + 0.0).swapaxes(0, 1) for p in self.patches))

    def with_mirror_image(self, plane: Plane) -> "SmoothSurface":
        """Return the surface and its mirror image at y = 0 ("xz") or x = 0 ("yz") as one."""
        return SmoothSurface(self.patches + self.mirrored(plane).patches)

    def half(self, plane: Plane) -> "SmoothSurface | None":
        """Return the patches on the positive side of a plane; None where one crosses it."""
        axis = 1 if plane == "xz" else 0
        low, high = (np.array([f(p[..., axis]) for p in self.patches]) for f in (np.min, np.max))
        near = 1e-9 * float(np.abs(np.concatenate([p.ravel() for p in self.patches])).max())
        if np.any((low < -near) & (high > near)):
            return None
        kept = tuple(p for p, a in zip(self.patches, high, strict=True) if a > near)
        return SmoothSurface(kept) if kept else None


@dataclass(frozen=True, eq=False)
class SurfaceCorners:
    """A smooth hull known at places: corners of panels that all lie on it, while those of the hull's own panels are off it.

    Parameters
    ----------
    vertices : (n, 3) array
        m.
    faces : (m, 4) int array
        As those of a panel mesh.
    """

    vertices: Array
    faces: Faces

    @property
    def bounds(self) -> Array:
        """Lowest and highest x, y, z (2, 3) of the corners, m."""
        return np.array([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    def moved(self, transform: Callable[[Array], Array]) -> "SurfaceCorners":
        """Return the corners after an affine map, that keeps the hand, of points (n, 3)."""
        return SurfaceCorners(transform(self.vertices), self.faces)

    def mirrored(self, plane: Plane) -> "SurfaceCorners":
        """Return the mirror image at y = 0 ("xz") or x = 0 ("yz")."""
        return SurfaceCorners(self.vertices * MIRROR[plane] + 0.0, reversed_faces(self.faces))

    def with_mirror_image(self, plane: Plane) -> "SurfaceCorners":
        """Return the corners and their mirror images at y = 0 ("xz") or x = 0 ("yz") as one."""
        near = _NEAR * float(np.ptp(self.vertices, axis=0).max())
        return SurfaceCorners(*with_mirror_image(self.vertices, self.faces, plane=plane, tolerance=near))

    def half(self, plane: Plane) -> "SurfaceCorners | None":
        """Return the corners on the positive side of a plane; None where the other side is not their mirror image."""
        near = _NEAR * float(np.ptp(self.vertices, axis=0).max())
        try:
            return SurfaceCorners(*half(self.vertices, self.faces, plane=plane, tolerance=near))
        except InputError:
            return None


Surface = SmoothSurface | SurfaceCorners
