"""A hull and its lid as a boundary element method sees them: stored panels, their mirror images, the parity of each dof."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ogilvie.mesh.integrals import reversed_faces
from ogilvie.mesh.panels import PanelMesh

Array = NDArray[np.float64]

#: Sign of the normal component n_i of each dof (surge..yaw) at the mirror image of a panel.
_PARITY = {"xz": (1, -1, 1, -1, 1, -1), "yz": (-1, 1, 1, 1, -1, -1)}
_MIRROR = {"xz": (1, -1, 1), "yz": (-1, 1, 1)}

#: Depth of the points on lid panels over the root of their areas: exp(-1/2)/(2 sqrt(pi)).
_LID_DEPTH = 0.5 * np.exp(-0.5) / np.sqrt(np.pi)

#: Parameters s, t in [-1, 1] of the four Gauss points of a bilinear panel.
_GAUSS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) / np.sqrt(3.0)


@dataclass(frozen=True, eq=False)
class Facets:
    """Flat panels: what the influence of one set of panels on another needs.

    Parameters
    ----------
    vertices : (n_v, 3) array
        m.
    faces : (n, 4) int array
    centers, normals : (n, 3) array
        m; normals into the fluid, downward on a lid.
    areas, radii : (n,) array
        m2; largest distance of a corner from the centre, m.
    """

    vertices: Array
    faces: NDArray[np.int64]
    centers: Array
    normals: Array
    areas: Array
    radii: Array


@dataclass(frozen=True, eq=False)
class HullPanels:
    """Stored panels of a hull, with or without an interior lid, and the planes of symmetry.

    Parameters
    ----------
    hull : PanelMesh
        Wetted hull, normals into the fluid.
    lid : PanelMesh or None
        Interior panels on z = 0, of the same symmetry.
    """

    hull: PanelMesh
    lid: PanelMesh | None = None

    @property
    def n_hull(self) -> int:
        """Number of stored panels of the hull."""
        return self.hull.n_faces

    @property
    def n_lid(self) -> int:
        """Number of stored panels of the lid."""
        return 0 if self.lid is None else self.lid.n_faces

    @property
    def without_lid(self) -> "HullPanels":
        """The hull alone."""
        return HullPanels(self.hull)

    @cached_property
    def facets(self) -> Facets:
        """Hull panels and then lid panels; the lid exactly on z = 0 with normals downward, out of the fluid outside."""
        hull = self.hull
        parts = [Facets(hull.vertices, hull.faces, hull.centers, hull.normals, hull.areas, _radii(hull))]
        if self.lid is not None:
            parts.append(_lid_facets(self.lid))
        first = np.cumsum([0] + [len(p.vertices) for p in parts[:-1]])
        return Facets(
            np.concatenate([p.vertices for p in parts]),
            np.concatenate([p.faces + i for p, i in zip(parts, first, strict=True)]),
            *(np.concatenate([getattr(p, key) for p in parts]) for key in ("centers", "normals", "areas", "radii")),
        )

    @cached_property
    def points(self) -> Array:
        """Where the equations hold (n, 3): the middle of each hull panel, and below that of each lid panel, m.

        The wave part of the Green function, -2 K log(K r/2) for short distances r on z = 0, is -2 K log(K d) at the depth d
        under a source there. d = exp(-1/2)/2 sqrt(a/pi) makes that the mean over a disc of the panel's area a.
        """
        points = np.array(self.facets.centers)
        points[self.n_hull :, 2] -= _LID_DEPTH * np.sqrt(self.facets.areas[self.n_hull :])
        return points

    @cached_property
    def images(self) -> Array:
        """Signs (n_c, 3) of x, y, z at each copy of the stored panels; the first copy is the stored one."""
        signs = np.ones((1, 3))
        for plane in self.hull.planes:
            signs = np.concatenate([signs, signs * _MIRROR[plane]])
        return signs

    @cached_property
    def dof_signs(self) -> Array:
        """Sign (n_c, 6) of each dof's normal component at each copy."""
        signs = np.ones((1, 6))
        for plane in self.hull.planes:
            signs = np.concatenate([signs, signs * _PARITY[plane]])
        return signs

    @cached_property
    def modes(self) -> Array:
        """Normal velocity (6, n_hull) of the stored hull panels in unit motion of each dof about O: (n, r x n)."""
        n = self.hull.normals
        return np.concatenate([n.T, np.cross(self.hull.centers, n).T])

    @cached_property
    def quadrature(self) -> tuple[Array, Array]:
        """Points (n_hull, 4, 3), m, and weights (n_hull, 4), m2, on the stored hull panels.

        2 x 2 Gauss points of a quadrilateral; of a triangle the middles of its sides, the fourth without weight.
        """
        corner = self.hull.vertices[self.hull.faces]  # (n, 4, 3); corners at (-1,-1), (1,-1), (1,1), (-1,1)
        s, t = _GAUSS.T
        shape = np.stack([(1 - s) * (1 - t), (1 + s) * (1 - t), (1 + s) * (1 + t), (1 - s) * (1 + t)], axis=1) / 4.0
        ds = np.stack([t - 1, 1 - t, 1 + t, -1 - t], axis=1) / 4.0
        dt = np.stack([s - 1, -1 - s, 1 + s, 1 - s], axis=1) / 4.0
        points = np.einsum("qk,nki->nqi", shape, corner)
        jacobian = np.cross(np.einsum("qk,nki->nqi", ds, corner), np.einsum("qk,nki->nqi", dt, corner))
        weights = np.abs(np.einsum("nqi,ni->nq", jacobian, self.hull.normals))
        triangle = self.hull.is_triangle
        points[triangle], weights[triangle] = _side_middles(corner[triangle])
        total = weights.sum(axis=1, keepdims=True)
        return points, weights * (self.hull.areas[:, None] / np.where(total > 0.0, total, 1.0))


def _side_middles(corner: Array) -> tuple[Array, Array]:
    """Return the middles (n, 4, 3) of the sides of triangles given by four corners; the side without length last."""
    following = np.roll(corner, -1, axis=1)
    order = np.argsort(-np.linalg.norm(following - corner, axis=2), axis=1, kind="stable")
    middles = np.take_along_axis(0.5 * (corner + following), order[:, :, None], axis=1)
    return middles, np.tile([1.0, 1.0, 1.0, 0.0], (len(corner), 1))


def _radii(mesh: PanelMesh) -> Array:
    arm = mesh.vertices[mesh.faces] - mesh.centers[:, None, :]
    return np.linalg.norm(arm, axis=2).max(axis=1)


def _lid_facets(lid: PanelMesh) -> Facets:
    vertices, centers = np.array(lid.vertices), np.array(lid.centers)
    vertices[:, 2] = centers[:, 2] = 0.0
    up = lid.normals[:, 2] > 0.0
    faces = np.where(up[:, None], reversed_faces(lid.faces), lid.faces)
    return Facets(vertices, faces, centers, np.tile([0.0, 0.0, -1.0], (lid.n_faces, 1)), np.array(lid.areas), _radii(lid))
