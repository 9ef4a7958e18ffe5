"""Long triangles split until no edge exceeds a length (plain arrays in, plain arrays out)."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Faces = NDArray[np.int64]


def split_long_edges(vertices: Array, tri: Faces, *, length: float) -> tuple[Array, Faces]:
    """Return the same surface in triangles without edges longer than `length`, m.

    Parameters
    ----------
    vertices : (n_v, 3) array
    tri : (n, 3) array

    Returns
    -------
    vertices, tri : arrays
        New vertices are appended; orientation is kept.

    Notes
    -----
    Each long edge gets its middle as a vertex, in all triangles that have it, so that no vertex comes to lie within an edge; a
    triangle becomes two, three or four; over again until all are short.

    Examples
    --------
    >>> v, t = split_long_edges(np.array([[0.0, 0, 0], [2, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]), length=1.5)
    >>> len(v), len(t)
    (5, 3)
    """
    while True:
        edges = np.sort(tri[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        unique, inverse = np.unique(edges, axis=0, return_inverse=True)
        a, b = vertices[unique[:, 0]], vertices[unique[:, 1]]
        long = np.linalg.norm(b - a, axis=1) > length
        if not long.any():
            return vertices, tri
        middle = np.full(len(unique), -1)
        middle[long] = len(vertices) + np.arange(long.sum())
        vertices = np.concatenate([vertices, 0.5 * (a + b)[long]])
        cut = middle[inverse].reshape(-1, 3)
        kept = tri[(cut < 0).all(axis=1)]
        pieces = [_pieces(t, m) for t, m in zip(tri.tolist(), cut.tolist(), strict=True) if max(m) >= 0]
        tri = np.concatenate([kept, np.array([p for ps in pieces for p in ps], dtype=tri.dtype)])


def _pieces(t: list[int], m: list[int]) -> list[tuple[int, int, int]]:
    """Return the triangles of one whose edges (0, 1), (1, 2), (2, 0) have the middle vertices m, -1 for none."""
    while m[0] < 0 or (m[2] >= 0 and m[1] < 0):  # turn it until the cut edges are the first ones
        t, m = [*t[1:], t[0]], [*m[1:], m[0]]
    (a, b, c), (ab, bc, ca) = t, m
    if bc < 0:
        return [(a, ab, c), (ab, b, c)]
    if ca < 0:
        return [(ab, b, bc), (a, ab, bc), (a, bc, c)]
    return [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
