"""The velocity that sources of constant strength on each panel lack along the hull (kernel).

Sources that vary along the hull like exp(i kappa s) make there the velocity -(i/2) exp(i kappa s). As steps of panels of length
h, sampled at the middles, they make (1 - (ln 2/pi) kappa h + ...) times that: the spectrum of the steps, sinc(kappa h/2 + n
pi), folds back with both signs. So

    v = v_steps - (ln 2/2 pi) sum over both directions of the panel of t h d sigma/d s,

which turns the velocity from first into second order. The slopes come from the neighbours on the same smooth surface; beside
a sharp edge, where sources grow without bound, nothing is added.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.drift_panels import WholeHull
from ogilvie.mesh.topology import merge_vertices

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Complex = NDArray[np.complex128]

_MISSING = np.log(2.0) / (2.0 * np.pi)
_SMOOTH = np.cos(np.radians(35.0))


@dataclass(frozen=True, eq=False)
class Slopes:
    """Neighbours of each panel along its two directions.

    Parameters
    ----------
    before, after : (2, n) int arrays
        The panel itself where there is no neighbour.
    span : (2, n) array
        Distance between the centres of the two, along the hull, m; 1 where there are none.
    step : (2, n, 3) array
        Side-to-side vectors of the panel, m.
    """

    before: Ints
    after: Ints
    span: Array
    step: Array

    def missing(self, sigma: Complex) -> Complex:
        """Return the velocity (n_f, n, 3) that steps of sources (n_f, n) lack."""
        v = np.zeros((*sigma.shape, 3), dtype=complex)
        for before, after, span, step in zip(self.before, self.after, self.span, self.step, strict=True):
            rate = (sigma[:, after] - sigma[:, before]) / span
            v -= _MISSING * rate[..., None] * step
        return v


def find_slopes(hull: WholeHull) -> Slopes:
    """Return the neighbours of all panels of a hull, across its planes of symmetry too; triangles have none."""
    mesh, n = hull.panels.hull, hull.panels.n_hull
    vertices = hull.copied(mesh.vertices)
    copies = len(hull.panels.images)
    faces = np.concatenate([mesh.faces + c * len(mesh.vertices) for c in range(copies)])
    _, merged = merge_vertices(vertices, faces, tolerance=max(mesh.tolerance, 1e-9))
    across = _across(merged)  # (4, n): neighbour at sides ab, bc, cd, da
    own = np.arange(n * copies)
    normals, centers = hull.normals, hull.centers
    sharp = np.zeros((4, n * copies), dtype=bool)
    for side in range(4):
        other = np.where(across[side] >= 0, across[side], own)
        sharp[side] = np.einsum("ni,ni->n", normals, normals[other]) < _SMOOTH
        across[side] = other
    across[0], across[2] = (np.where(sharp[0] | sharp[2], own, a) for a in (across[0], across[2]))
    across[1], across[3] = (np.where(sharp[1] | sharp[3], own, a) for a in (across[1], across[3]))
    across[:, np.tile(mesh.is_triangle, copies)] = own[np.tile(mesh.is_triangle, copies)]
    corner = vertices[faces]
    middle = 0.5 * (corner + np.roll(corner, -1, axis=1))
    before, after = np.stack([across[3], across[0]]), np.stack([across[1], across[2]])
    step = np.stack([middle[:, 1] - middle[:, 3], middle[:, 2] - middle[:, 0]])
    gap = np.linalg.norm(centers[after] - centers, axis=2) + np.linalg.norm(centers[before] - centers, axis=2)
    along = step - np.einsum("dni,ni->dn", step, normals)[..., None] * normals
    return Slopes(before, after, np.where(gap > 0.0, gap, 1.0), along)


def _across(faces: Ints) -> Ints:
    """Return the neighbour (4, n) of each panel at its sides 01, 12, 23, 30, or -1."""
    n = len(faces)
    start, end = faces.T.ravel(), np.roll(faces, -1, axis=1).T.ravel()  # side by side
    pairs = np.stack([np.minimum(start, end), np.maximum(start, end)], axis=1)
    _, edge, count = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
    edge = edge.ravel()
    order = np.argsort(edge, kind="stable")
    order = order[(count[edge[order]] == 2) & (start[order] != end[order])]
    first, second = order.reshape(-1, 2).T
    out = np.full(4 * n, -1, dtype=np.int64)
    out[first], out[second] = second % n, first % n
    return out.reshape(4, n)
