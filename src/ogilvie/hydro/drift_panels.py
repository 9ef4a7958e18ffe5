"""The whole hull and its waterline, copies of the stored panels included."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.bem_panels import HullPanels
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.topology import edges, merge_vertices

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_SMOOTH = np.cos(np.radians(35.0))  # rows of panels at a smaller angle belong to one smooth surface
_PARALLEL = 1e-6  # steepest flare, as part of one, that counts as none


@dataclass(frozen=True, eq=False)
class Waterline:
    """Edges of the panels on z = 0.

    Parameters
    ----------
    owner : (n,) int array
        Panel of each edge.
    middle : (n, 3) array
        m.
    normal : (n, 3) array
        n/(1 - n_z^2)^(1/2): horizontal part of unit length, out of the body; the third entry is the slope of the flare.
    length : (n,) array
        m.
    below : (n,) int array
        Next panel under the owner on the same smooth surface; the owner itself where there is none.
    beyond : (n,) array
        Distance from owner to edge over that from `below` to owner.
    """

    owner: Ints
    middle: Array
    normal: Array
    length: Array
    below: Ints
    beyond: Array

    @property
    def tangent(self) -> Array:
        """Vectors dl (n, 3), m, right-handed about the normal of the hull: dl = (n_y, -n_x, 0) |dl|."""
        n = self.normal
        return self.length[:, None] * np.stack([n[:, 1], -n[:, 0], np.zeros(len(n))], axis=1)


@dataclass(frozen=True, eq=False)
class WholeHull:
    """All panels of a hull in the order (copy, stored panel).

    Parameters
    ----------
    panels : HullPanels
    """

    panels: HullPanels

    @cached_property
    def centers(self) -> Array:
        """(n, 3), m."""
        return self.copied(self.panels.hull.centers)

    @cached_property
    def normals(self) -> Array:
        """(n, 3), into the fluid."""
        return self.copied(self.panels.hull.normals)

    @cached_property
    def areas(self) -> Array:
        """(n,), m2."""
        return np.tile(self.panels.hull.areas, len(self.panels.images))

    @cached_property
    def source_points(self) -> Array:
        """Centres (n_s, 3) of all hull and lid panels in the order (copy, stored panel), m."""
        return self.copied(self.panels.facets.centers)

    @cached_property
    def source_areas(self) -> Array:
        """(n_s,), m2."""
        return np.tile(self.panels.facets.areas, len(self.panels.images))

    @cached_property
    def stored_waterline(self) -> Waterline:
        """Edges of the stored panels alone."""
        return find_waterline(self.panels.hull)

    @cached_property
    def waterline(self) -> Waterline:
        """Edges of all panels, copy by copy."""
        one, n = self.stored_waterline, self.panels.n_hull
        copies = len(self.panels.images)
        owner, below = (np.concatenate([part + c * n for c in range(copies)]) for part in (one.owner, one.below))
        length, beyond = np.tile(one.length, copies), np.tile(one.beyond, copies)
        return Waterline(owner, self.copied(one.middle), self.copied(one.normal), length, below, beyond)

    @cached_property
    def panel_waterline(self) -> Waterline:
        """Edges of all panels with the flare of the top panels as it is, not extrapolated to z = 0."""
        line = self.waterline
        slope = _tangent_of_flare(self.normals[line.owner])
        return replace(line, normal=np.column_stack([line.normal[:, :2], slope]))

    def copied(self, vectors: Array) -> Array:
        """Return vectors (n, 3) of the stored panels, mirrored to all copies (n_c n, 3)."""
        return np.concatenate([vectors * image for image in self.panels.images])


def find_waterline(hull: PanelMesh) -> Waterline:
    """Return the edges of the stored panels that lie on z = 0.

    Notes
    -----
    The normal there belongs to the edge: its horizontal part is square to it, and its slope is that of the panel and of the
    next one below, extrapolated linearly to z = 0; the slope of the top panel alone would be wrong by O(h). Across a sharp
    edge nothing is extrapolated.

    Examples
    --------
    >>> wall = PanelMesh([[0.0, 1, -1], [0, 1, 0], [2, 1, 0], [2, 1, -1]], [[0, 1, 2, 3]])
    >>> line = find_waterline(wall)
    >>> (line.normal + 0.0).tolist(), line.tangent.tolist()
    ([[-0.0, 1.0, 0.0]], [[2.0, 0.0, 0.0]])
    """
    tol = max(hull.tolerance, 1e-9)
    _, merged = merge_vertices(hull.vertices, hull.faces, tolerance=tol)
    start, end, owner = edges(hull.faces)
    v = hull.vertices
    top = (np.abs(v[start, 2]) <= tol) & (np.abs(v[end, 2]) <= tol) & (np.abs(hull.normals[owner, 2]) < 1.0 - _PARALLEL)
    start, end, owner = start[top], end[top], owner[top]
    step = (v[end] - v[start])[:, :2]
    length = np.linalg.norm(step, axis=1)
    middle = 0.5 * (v[start] + v[end])
    middle[:, 2] = 0.0
    below, beyond = _next_row(hull, merged, owner, middle)
    own, lower = _tangent_of_flare(hull.normals[owner]), _tangent_of_flare(hull.normals[below])
    normal = np.stack([-step[:, 1] / length, step[:, 0] / length, own + (own - lower) * beyond], axis=1)
    return Waterline(owner.astype(np.int64), middle, normal, length, below, beyond)


def _next_row(hull: PanelMesh, faces: Ints, owner: Ints, middle: Array) -> tuple[Ints, Array]:
    """Return the panel below each of `owner`, and the distance owner to edge over that from it to the owner (0 without)."""
    n, c = hull.normals, hull.centers
    below = _neighbour_below(faces, c[:, 2], owner)
    has = below >= 0
    next_one = np.where(has, below, owner)
    has &= np.einsum("ei,ei->e", n[owner], n[next_one]) > _SMOOTH
    next_one = np.where(has, next_one, owner).astype(np.int64)
    d1 = np.linalg.norm(c[owner] - middle, axis=1)
    d2 = np.linalg.norm(c[next_one] - c[owner], axis=1)
    return next_one, np.where(has, d1 / np.where(has, d2, 1.0), 0.0)


def _tangent_of_flare(n: Array) -> Array:
    return np.asarray(n[:, 2] / np.sqrt(np.maximum(1.0 - n[:, 2] ** 2, _PARALLEL)))


def _neighbour_below(faces: Ints, z: Array, owner: Ints) -> Ints:
    """Return for each panel of `owner` the neighbour with the lowest centre below its own, or -1."""
    start, end, face = edges(faces)
    pairs = np.stack([np.minimum(start, end), np.maximum(start, end)], axis=1)
    _, edge, count = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
    edge = edge.ravel()
    order = np.argsort(edge, kind="stable")
    order = order[count[edge[order]] == 2].reshape(-1, 2)
    lowest = np.full(len(faces), -1, dtype=np.int64)
    for i, j in np.concatenate([order, order[:, ::-1]]).tolist():
        p, q = face[i], face[j]
        if z[q] < z[p] and (lowest[p] < 0 or z[q] < z[lowest[p]]):
            lowest[p] = q
    return lowest[owner]
