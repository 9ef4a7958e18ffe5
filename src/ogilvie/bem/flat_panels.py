"""Flat triangles and quadrilaterals: geometry, moments, Gauss points, mirror images."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.curved import Symmetry, image_signs
from ogilvie.errors import InputError

Array = NDArray[Any]

#: Quadrilaterals whose corners leave their mean plane by more than this part of their size become two triangles.
FLATNESS = 1e-9


@dataclass(frozen=True, eq=False)
class FlatPanels:
    """Flat panels with normals to one side.

    Parameters
    ----------
    corners : (n, 4, 3) array
        m, anticlockwise as seen from where the normal points to; a triangle repeats its third corner. Quadrilaterals that are
        not flat are split along the diagonal from the first to the third corner, so that the surface stays closed: `n` grows.
    symmetry : {"none", "xz", "xz+yz"}
        Planes of symmetry; only the part y >= 0 (and x >= 0) is given.

    Raises
    ------
    InputError
        Wrong shape, NaN, panels without area.

    Examples
    --------
    >>> square = FlatPanels([[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]])
    >>> square.areas.tolist(), square.normals.tolist()
    ([1.0], [[0.0, 0.0, 1.0]])
    """

    corners: Array
    symmetry: Symmetry = "none"

    def __post_init__(self) -> None:
        corners = np.array(self.corners, dtype=float)
        if corners.ndim != 3 or corners.shape[1:] != (4, 3) or len(corners) == 0 or not np.all(np.isfinite(corners)):
            raise InputError(f"corners: a finite (n, 4, 3) array, n >= 1, expected, shape {corners.shape} found (or NaN).")
        if self.symmetry not in ("none", "xz", "xz+yz"):
            raise InputError(f"symmetry: 'none', 'xz' or 'xz+yz' expected, {self.symmetry!r} found.")
        corners = _repeated_third(corners)
        size = np.ptp(corners, axis=1).max(axis=-1)
        area = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        length = np.linalg.norm(area, axis=-1)
        flat = np.abs(np.einsum("nk,nk->n", corners[:, 1] - corners[:, 0], area)) <= FLATNESS * size * length
        if not flat.all():
            warped = corners[~flat]
            corners = np.concatenate([corners[flat], warped[:, [0, 1, 2, 2]], warped[:, [0, 2, 3, 3]]])
        corners.setflags(write=False)
        object.__setattr__(self, "corners", corners)
        if not np.all(self.areas > 1e-14 * np.ptp(corners, axis=1).max(axis=-1) ** 2):
            raise InputError(f"corners: panels with an area expected, panel {int(self.areas.argmin())} has none.")

    def __len__(self) -> int:
        return len(self.corners)

    @cached_property
    def _triangles(self) -> tuple[Array, Array]:
        """Centroids (n, 2, 3) and area vectors (n, 2, 3) of the two triangles of each panel."""
        a, b, c, d = self.corners.transpose(1, 0, 2)
        centers = np.stack([a + b + c, a + c + d], axis=1) / 3.0
        return centers, 0.5 * np.stack([np.cross(b - a, c - a), np.cross(c - a, d - a)], axis=1)

    @cached_property
    def areas(self) -> Array:
        """(n,) m2."""
        return np.asarray(np.linalg.norm(self._triangles[1].sum(axis=1), axis=-1))

    @cached_property
    def normals(self) -> Array:
        """(n, 3) unit vectors."""
        return np.asarray(self._triangles[1].sum(axis=1) / self.areas[:, None])

    @cached_property
    def _parts(self) -> Array:
        """Signed areas (n, 2) of the triangles, m2."""
        return np.einsum("ntk,nk->nt", self._triangles[1], self.normals)

    @cached_property
    def centers(self) -> Array:
        """Centroids (n, 3), m."""
        return np.einsum("nt,ntk->nk", self._parts, self._triangles[0]) / self.areas[:, None]

    @cached_property
    def moments(self) -> Array:
        """Second moments (n, 3, 3) about the centroids, m4."""
        a, b, c, d = (self.corners - self.centers[:, None]).transpose(1, 0, 2)
        M = np.zeros((len(self), 3, 3))
        for k, (p, q, r) in enumerate(((a, b, c), (a, c, d))):
            for x in (p, q, r, p + q + r):  # int x x^T = A/12 (p p^T + q q^T + r r^T + (p+q+r)(p+q+r)^T)
                M += self._parts[:, k, None, None] / 12.0 * x[:, :, None] * x[:, None, :]
        return M

    @cached_property
    def sizes(self) -> Array:
        """(n,) largest distances of a corner from the centroid, m."""
        return np.asarray(np.linalg.norm(self.corners - self.centers[:, None], axis=-1).max(axis=1))

    @cached_property
    def images(self) -> Array:
        """Signs (n_images, 2) of x and y of the given part and of its mirror images."""
        return image_signs(self.symmetry)

    def gauss_points(self, count: int) -> tuple[Array, Array]:
        """Return points (count^2, n, 3), m, and weights (count^2, n), m2, for integrals over the panels; 1: the centroids.

        Examples
        --------
        >>> square = FlatPanels([[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]])
        >>> points, weights = square.gauss_points(2)
        >>> round(float((weights * points[..., 0] ** 3).sum()), 12)
        0.25
        """
        if count == 1:
            return self.centers[None], self.areas[None]
        x, w = np.polynomial.legendre.leggauss(count)
        u, v = (a.ravel()[:, None, None] for a in np.meshgrid(0.5 + 0.5 * x, 0.5 + 0.5 * x, indexing="ij"))
        a, b, c, d = self.corners.transpose(1, 0, 2)
        points = (1 - u) * (1 - v) * a + u * (1 - v) * b + u * v * c + (1 - u) * v * d
        cross = np.cross((1 - v) * (b - a) + v * (c - d), (1 - u) * (d - a) + u * (c - b))
        return points, 0.25 * np.outer(w, w).reshape(-1, 1) * np.linalg.norm(cross, axis=-1)


def _repeated_third(corners: Array) -> Array:
    """Return corners with those of triangles ordered so that the third is repeated."""
    corners = corners.copy()
    for k in (0, 1, 3):  # corner k equals corner k + 1: start after it, so that it comes third and fourth
        same = np.all(corners[:, k] == corners[:, (k + 1) % 4], axis=-1) & ~np.all(corners[:, 2] == corners[:, 3], axis=-1)
        corners[same] = np.roll(corners[same], -(k + 2) % 4, axis=1)
    return corners
