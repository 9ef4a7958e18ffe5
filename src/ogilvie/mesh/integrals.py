"""Surface integrals over flat-faceted panels, exact for polynomials up to second degree (plain arrays in, plain arrays out).

A quadrilateral is two triangles that share the diagonal from its first to its third vertex. So a hull, warped panels
included, is one definite polyhedron, and the divergence theorem holds for it to rounding.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Faces = NDArray[np.int64]

#: Signs that mirror (x, y, z): at the plane y = 0 ("xz") and at the plane x = 0 ("yz").
MIRROR = {"xz": np.array([1.0, -1.0, 1.0]), "yz": np.array([-1.0, 1.0, 1.0])}


def triangles(faces: Faces) -> Faces:
    """Return the (2 n_f, 3) triangles of (n_f, 4) faces: first all (0, 1, 2), then all (0, 2, 3); some may have no area.

    Examples
    --------
    >>> triangles(np.array([[0, 1, 2, 3]])).tolist()
    [[0, 1, 2], [0, 2, 3]]
    """
    return np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])


def reversed_faces(faces: Faces) -> Faces:
    """Return the (n_f, 4) faces with the opposite orientation and the same diagonal; triangles repeat their third vertex.

    Examples
    --------
    >>> reversed_faces(np.array([[0, 1, 2, 3], [0, 1, 2, 2]])).tolist()
    [[0, 3, 2, 1], [0, 2, 1, 1]]
    """
    flipped = faces[:, [0, 3, 2, 1]]
    triangle = faces[:, 2] == faces[:, 3]
    flipped[triangle] = faces[triangle][:, [0, 2, 1, 1]]
    return flipped


def triangle_area_vectors(vertices: Array, tri: Faces) -> Array:
    """Return the (n, 3) area vectors of triangles, (b - a) x (c - a) / 2, m2; they point to where a, b, c run anticlockwise."""
    a, b, c = vertices[tri[:, 0]], vertices[tri[:, 1]], vertices[tri[:, 2]]
    return 0.5 * np.cross(b - a, c - a)


def panel_geometry(vertices: Array, faces: Faces) -> tuple[Array, Array, Array]:
    """Return centroids (n_f, 3), area vectors (n_f, 3) and areas (n_f,) of panels, each made of its two triangles.

    The length of the area vector of a warped panel is less than its area; for a flat one they are equal.
    """
    n = len(faces)
    tri = triangles(faces)
    S = triangle_area_vectors(vertices, tri)
    weight = np.linalg.norm(S, axis=1)
    area = weight[:n] + weight[n:]
    moment = weight[:, None] * vertices[tri].mean(axis=1)
    flat = vertices[faces].mean(axis=1)  # a panel without area has no centroid: take the mean of its vertices
    safe = np.where(area > 0.0, area, 1.0)[:, None]
    center = np.where(area[:, None] > 0.0, (moment[:n] + moment[n:]) / safe, flat)
    return center, S[:n] + S[n:], area


def surface_moments(vertices: Array, faces: Faces, *, planes: tuple[str, ...] = ()) -> tuple[Array, Array, Array]:
    """Return the integrals of n_i, n_i x_j and n_i x_j x_k over the panels and their mirror images.

    Parameters
    ----------
    vertices : (n_v, 3) array
    faces : (n_f, 4) array
    planes : tuple of {"xz", "yz"}
        Planes of symmetry; the integrals cover the whole surface.

    Returns
    -------
    M0, M1, M2 : arrays (3,) m2, (3, 3) m3, (3, 3, 3) m4

    Notes
    -----
    With S the area vector of a triangle and s the sum of its vertices p: integral of n_i x_j = S_i s_j / 3, of n_i x_j x_k =
    S_i (sum p_j p_k + s_j s_k) / 12. A mirror plane multiplies each integral by 1 + (product of the signs of its indices).

    Examples
    --------
    >>> v = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> M0, M1, M2 = surface_moments(v, np.array([[0, 1, 2, 3]]))
    >>> float(M0[2]), float(M1[2, 0]), round(float(M2[2, 0, 0]), 12)  # area, first and second moment
    (1.0, 0.5, 0.333333333333)
    """
    tri = triangles(faces)
    S, p = triangle_area_vectors(vertices, tri), vertices[tri]
    s = p.sum(axis=1)
    square = (np.einsum("taj,tak->tjk", p, p) + s[:, :, None] * s[:, None, :]) / 12.0
    M0, M1, M2 = S.sum(axis=0), S.T @ s / 3.0, np.einsum("ti,tjk->ijk", S, square)
    for plane in planes:
        m = MIRROR[plane]
        M0 = M0 * (1.0 + m)
        M1 = M1 * (1.0 + m[:, None] * m)
        M2 = M2 * (1.0 + m[:, None, None] * m[:, None] * m)
    return M0, M1, M2
