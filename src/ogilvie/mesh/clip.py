"""Cut panels at the still water plane z = 0 and keep what is below (kernel: plain arrays in, plain arrays out)."""

import numpy as np
from numpy.typing import NDArray

from ogilvie.mesh.topology import compact

Array = NDArray[np.float64]
Faces = NDArray[np.int64]


def clip_below(vertices: Array, faces: Faces, *, tolerance: float) -> tuple[Array, Faces]:
    """Return the part of the panels with z <= 0; panels that lie in the plane z = 0 are dropped.

    Parameters
    ----------
    vertices : (n_v, 3) array
        m.
    faces : (n_f, 4) array
    tolerance : float
        Vertices with abs(z) <= tolerance are on the plane and get z = 0 exactly, m.

    Returns
    -------
    vertices, faces : arrays (m_v, 3), (m_f, 4)
        Possibly with m_f = 0. Orientation is kept; the new vertex on a cut edge is shared by the panels on either side of it.

    Notes
    -----
    A cut flat panel is cut as a polygon (3 to 5 corners), a cut warped panel as its two triangles, so that the remaining
    polyhedron is exactly the lower part of the one before.

    Examples
    --------
    >>> v = np.array([[0.0, 0, -1], [1, 0, -1], [1, 0, 3], [0, 0, 3]])
    >>> v, f = clip_below(v, np.array([[0, 1, 2, 3]]), tolerance=1e-9)
    >>> v.tolist(), f.tolist()
    ([[0.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]], [[0, 1, 2, 3]])
    """
    vertices = np.where((np.abs(vertices) <= tolerance) & [False, False, True], 0.0, vertices)
    z = vertices[:, 2][faces]
    above, below = (z > 0.0).any(axis=1), (z < 0.0).any(axis=1)
    kept = faces[below & ~above]
    vertices, pieces = _cut(vertices, faces[below & above], tolerance)
    return compact(vertices, np.concatenate([kept, pieces]))


def _cut(vertices: Array, faces: Faces, tolerance: float) -> tuple[Array, Faces]:
    """Cut faces that reach both sides of the plane; return the vertices with new ones appended, and the pieces below."""
    z = vertices[:, 2]
    new: list[Array] = []
    where: dict[tuple[int, int], int] = {}

    def crossing(i: int, j: int) -> int:
        key = (i, j) if i < j else (j, i)
        if key not in where:
            a, b = vertices[key[0]], vertices[key[1]]
            point = a + a[2] / (a[2] - b[2]) * (b - a)
            point[2] = 0.0
            where[key] = len(vertices) + len(new)
            new.append(point)
        return where[key]

    pieces: list[list[int]] = []
    for polygon in _polygons(vertices, faces, tolerance):
        kept: list[int] = []
        for i, j in zip(polygon, [*polygon[1:], polygon[0]], strict=True):
            if z[i] <= 0.0:
                kept.append(i)
            if z[i] * z[j] < 0.0:
                kept.append(crossing(i, j))
        if len(kept) >= 3 and any(i < len(z) and z[i] < 0.0 for i in kept):
            pieces += _panels(kept)
    faces = np.array(pieces, dtype=np.int64).reshape(-1, 4)
    return np.concatenate([vertices, np.array(new).reshape(-1, 3)]), faces


def _polygons(vertices: Array, faces: Faces, tolerance: float) -> list[list[int]]:
    """Return flat faces as they are and warped ones as two triangles, each without repeated corners."""
    p = vertices[faces]
    S = np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1])  # twice the area vector
    length = np.linalg.norm(S, axis=1)
    lift = np.abs(np.einsum("fi,fi->f", p[:, 1] - p[:, 0], S))  # of the second corner above the mean plane, times length
    flat = lift <= tolerance * length
    polygons: list[list[int]] = []
    for face, is_flat in zip(faces.tolist(), flat, strict=True):
        corners = [face] if is_flat else [face[:3], [face[0], face[2], face[3]]]
        polygons += [distinct for c in corners if len(distinct := list(dict.fromkeys(c))) >= 3]
    return polygons


def _panels(polygon: list[int]) -> list[list[int]]:
    """Return a convex polygon of n corners as a fan of quadrilaterals and at most one triangle."""
    panels = []
    while len(polygon) > 4:
        panels.append(polygon[:4])
        polygon = [polygon[0], *polygon[3:]]
    return [*panels, polygon if len(polygon) == 4 else [*polygon, polygon[-1]]]
