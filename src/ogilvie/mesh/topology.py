"""Vertices and faces as arrays: merge, compact, mirror, halve, edges (plain arrays in, plain arrays out)."""

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.integrals import MIRROR, reversed_faces

Array = NDArray[np.float64]
Faces = NDArray[np.int64]

#: Axis that a plane is normal to: planes of symmetry and the still water.
NORMAL_AXIS = {"xz": 1, "yz": 0, "xy": 2}
_ALONG = 0.9  # cosine of the angle up to which edges run along each other
_WHOLE = 0.99  # of an edge, covered by others


def compact(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    """Return vertices and faces without the vertices that no face uses; the order of the others stays.

    Examples
    --------
    >>> v, f = compact(np.eye(5, 3), np.array([[0, 1, 4, 4]]))
    >>> v.shape, f.tolist()
    ((3, 3), [[0, 1, 2, 2]])
    """
    used, index = np.unique(faces, return_inverse=True)
    return vertices[used], index.reshape(faces.shape)


def merge_vertices(vertices: Array, faces: Faces, *, tolerance: float) -> tuple[Array, Faces]:
    """Return the mesh with vertices closer than `tolerance` (m) made one, at the place of the first of them.

    Examples
    --------
    >>> v = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 1e-9]])
    >>> v, f = merge_vertices(v, np.array([[0, 1, 2, 3]]), tolerance=1e-6)
    >>> len(v), f.tolist()
    (3, [[0, 1, 2, 1]])
    """
    label = _clusters(vertices, tolerance)
    _, first, index = np.unique(label, return_index=True, return_inverse=True)
    order = np.argsort(first)  # clusters in the order of their first vertex
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return vertices[first[order]], rank[index][faces]


def _clusters(vertices: Array, tolerance: float) -> NDArray[np.int64]:
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    unique, index = np.unique(vertices, axis=0, return_inverse=True)
    pairs = cKDTree(unique).query_pairs(tolerance, output_type="ndarray")
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(unique), len(unique)))
    return connected_components(graph, directed=False)[1][index.ravel()]


def canonical(faces: Faces) -> Faces:
    """Return faces in which a panel with two equal neighbouring corners is a triangle that repeats its third vertex.

    Faces with fewer than three distinct corners, or with equal opposite corners, stay as they are.

    Examples
    --------
    >>> canonical(np.array([[0, 1, 2, 3], [5, 5, 6, 7], [5, 6, 6, 7], [7, 5, 6, 7], [1, 1, 2, 2]])).tolist()
    [[0, 1, 2, 3], [5, 6, 7, 7], [5, 6, 7, 7], [5, 6, 7, 7], [1, 1, 2, 2]]
    """
    out = faces.copy()
    same = faces == np.roll(faces, -1, axis=1)  # corner i equals corner i + 1
    single = same.sum(axis=1) == 1
    for i, order in enumerate(([1, 2, 3, 3], [0, 2, 3, 3], [0, 1, 2, 2], [1, 2, 3, 3])):
        rows = single & same[:, i]
        out[rows] = faces[rows][:, order]
    return out


def with_mirror_image(vertices: Array, faces: Faces, *, plane: str, tolerance: float) -> tuple[Array, Faces]:
    """Return the panels and after them their mirror images; vertices within `tolerance` (m) of the plane are shared.

    Examples
    --------
    >>> v = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    >>> v, f = with_mirror_image(v, np.array([[0, 1, 2, 2]]), plane="xz", tolerance=0)
    >>> v[3].tolist(), f.tolist()
    ([0.0, -1.0, 0.0], [[0, 1, 2, 2], [0, 3, 1, 1]])
    """
    free = np.abs(vertices[:, NORMAL_AXIS[plane]]) > tolerance
    image = np.arange(len(vertices))
    image[free] = len(vertices) + np.arange(free.sum())
    mirrored = vertices[free] * MIRROR[plane] + 0.0  # + 0.0 turns -0.0 into 0.0
    return np.concatenate([vertices, mirrored]), np.concatenate([faces, reversed_faces(image[faces])])


def half(vertices: Array, faces: Faces, *, plane: str, tolerance: float) -> tuple[Array, Faces]:
    """Return the panels on the positive side of a plane, if the others are their mirror images.

    Raises
    ------
    InputError
        A panel crosses or lies in the plane, or the two sides are not mirror images to `tolerance` (m).
    """
    axis, letter = NORMAL_AXIS[plane], "xyz"[NORMAL_AXIS[plane]]
    side = np.where(np.abs(vertices[:, axis]) <= tolerance, 0.0, np.sign(vertices[:, axis]))[faces]
    low, high = side.min(axis=1), side.max(axis=1)
    if n := int((low * high < 0.0).sum() + ((low == 0.0) & (high == 0.0)).sum()):
        raise InputError(f"symmetry {plane}: panels on either side of {letter} = 0 expected, {n} cross it or lie in it.")
    mirror = _mirror_vertices(vertices, plane, tolerance)
    images = {frozenset(f) for f in mirror[faces[low < 0.0]].tolist()}
    stored = {frozenset(f) for f in faces[high > 0.0].tolist()}
    if images != stored or -1 in mirror[faces]:
        raise InputError(f"symmetry {plane}: two sides that are mirror images, panel by panel, expected; they differ.")
    return compact(vertices, faces[high > 0.0])


def _mirror_vertices(vertices: Array, plane: str, tolerance: float) -> NDArray[np.int64]:
    """Return for each vertex the index of the vertex at its mirror image, or -1."""
    from scipy.spatial import cKDTree

    distance, index = cKDTree(vertices).query(vertices * MIRROR[plane])
    return np.where(distance <= tolerance, index, -1)


def edges(faces: Faces) -> tuple[Faces, Faces, NDArray[np.int64]]:
    """Return the directed edges of all faces, sides of no length left out.

    Returns
    -------
    start, end : (n_e,) int arrays
        Vertices, in the direction in which the face runs.
    owner : (n_e,) int array
        The face.

    Examples
    --------
    >>> [e.tolist() for e in edges(np.array([[4, 5, 6, 6]]))]
    [[4, 5, 6], [5, 6, 4], [0, 0, 0]]
    """
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    owner = np.repeat(np.arange(len(faces)), faces.shape[1])
    real = start != end
    return start[real], end[real], owner[real]


def open_edges(vertices: Array, faces: Faces, *, planes: tuple[str, ...], tolerance: float) -> tuple[Faces, Faces, Faces]:
    """Return the edges (start, end, face) with one face only that do not lie in one of the planes through O.

    Examples
    --------
    >>> v = np.array([[0.0, 0, 0], [1, 0, 0], [1, 0, -1], [0, 0, -1]])
    >>> start, end, _ = open_edges(v, np.array([[3, 2, 1, 0]]), planes=("xy",), tolerance=1e-9)
    >>> sorted(zip(start.tolist(), end.tolist()))
    [(0, 3), (2, 1), (3, 2)]
    """
    start, end, owner = edges(faces)
    pairs = np.stack([np.minimum(start, end), np.maximum(start, end)], axis=1)
    _, edge, count = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
    free = count[edge.ravel()] == 1
    for plane in planes:
        on_plane = np.abs(vertices[:, NORMAL_AXIS[plane]]) <= tolerance
        free &= ~(on_plane[start] & on_plane[end])
    return start[free], end[free], owner[free]


def without_t_junctions(vertices: Array, start: Faces, end: Faces, *, tolerance: float) -> NDArray[np.bool_]:
    """Return True for those open edges that do not run along other open edges (of a patch with another division).

    An edge is part of a T-junction if both its ends lie within `tolerance` (m) of one other edge that runs the other way, if
    another such edge has both its ends on it, or if several such edges together cover all of it.
    """
    if len(start) == 0:
        return np.zeros(0, dtype=bool)
    points, index = np.unique(np.concatenate([start, end]), return_inverse=True)
    first, second = index[: len(start)], index[len(start) :]
    a, d = vertices[start], vertices[end] - vertices[start]
    on = np.array([_on_edge(vertices[p], a, d, tolerance) for p in points])  # (n_points, n_edges)
    opposite = d @ d.T
    within = on[first] & on[second] & (opposite < 0.0)  # row: an edge; column: the edge that it lies on
    length = np.linalg.norm(d, axis=1)
    shared = (first[:, None] == first) | (second[:, None] == second) | (first[:, None] == second) | (second[:, None] == first)
    met = (on[first] | on[second]) & (on[first] | on[second]).T & ~shared  # one end of each lies on the other
    met &= opposite < -_ALONG * np.outer(length, length)
    i, j = np.nonzero(met)
    t = np.einsum("cei,ei->ce", vertices[np.stack([start[j], end[j]])] - a[i], d[i]) / np.maximum(length[i] ** 2, 1e-300)
    part = np.bincount(i, np.abs(np.diff(np.clip(t, 0.0, 1.0), axis=0))[0], minlength=len(start)) * length
    inside = length @ within
    return np.asarray(~(within.any(axis=0) | within.any(axis=1) | (part + inside > _WHOLE * length)))


def _on_edge(point: Array, a: Array, d: Array, tolerance: float) -> NDArray[np.bool_]:
    """Return for edges a .. a + d whether a point lies on them."""
    length2 = np.einsum("ei,ei->e", d, d)
    t = np.clip(np.einsum("ei,ei->e", point - a, d) / np.where(length2 > 0.0, length2, 1.0), 0.0, 1.0)
    return np.asarray(np.linalg.norm(point - a - t[:, None] * d, axis=1) <= tolerance)


def consistent_orientation(faces: Faces, areas: Array) -> NDArray[np.bool_]:
    """Return True for the faces to be turned over so that neighbours agree; of each connected part the smaller area is turned.

    Examples
    --------
    >>> consistent_orientation(np.array([[0, 1, 2, 2], [1, 2, 3, 3]]), np.array([1.0, 2.0])).tolist()
    [True, False]
    """
    neighbours = _neighbours(faces)
    turned = np.full(len(faces), -1)
    for seed in range(len(faces)):
        if turned[seed] >= 0:
            continue
        turned[seed] = 0
        part, stack = [seed], [seed]
        while stack:
            face = stack.pop()
            for other, opposed in neighbours[face]:
                if turned[other] < 0:
                    turned[other] = turned[face] ^ opposed
                    part.append(other)
                    stack.append(other)
        weight = areas[part]
        if weight[turned[part] == 1].sum() > weight[turned[part] == 0].sum():
            turned[part] = 1 - turned[part]
    return turned == 1


def _neighbours(faces: Faces) -> list[list[tuple[int, int]]]:
    """Return for each face its neighbours across edges of exactly two faces, and 1 where they run the edge the same way."""
    start, end, owner = edges(faces)
    pairs = np.stack([np.minimum(start, end), np.maximum(start, end)], axis=1)
    _, edge, count = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(edge.ravel(), kind="stable")
    order = order[count[edge.ravel()[order]] == 2].reshape(-1, 2)
    neighbours: list[list[tuple[int, int]]] = [[] for _ in faces]
    for i, j in order.tolist():
        opposed = int(start[i] == start[j])
        neighbours[owner[i]].append((int(owner[j]), opposed))
        neighbours[owner[j]].append((int(owner[i]), opposed))
    return neighbours
