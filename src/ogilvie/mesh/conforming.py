"""Triangles of a panelled hull that meet corner to corner, whatever its patches do."""

import numpy as np
from numpy.typing import NDArray

from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.topology import compact, edges, merge_vertices

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


def conforming(hull: PanelMesh, near: float) -> tuple[Array, Ints]:
    """Return vertices and triangles of a hull, with the vertices that lie on another panel's side made corners of it."""
    vertices, faces = merge_vertices(hull.vertices, hull.faces, tolerance=near)
    for axis in (1, 2):
        vertices[np.abs(vertices[:, axis]) <= near, axis] = 0.0
    start, end, _ = edges(faces)
    directed = set(zip(start.tolist(), end.tolist(), strict=True))
    hanging: dict[tuple[int, int], list[int]] = {}
    free = [(a, b) for a, b in directed if (b, a) not in directed]
    candidates = np.unique(np.array(free, dtype=np.int64)) if free else np.zeros(0, dtype=np.int64)
    for a, b in free:
        d = vertices[b] - vertices[a]
        t = (vertices[candidates] - vertices[a]) @ d / (d @ d)
        off = np.linalg.norm(vertices[candidates] - vertices[a] - t[:, None] * d, axis=1)
        on = (t > 1e-6) & (t < 1.0 - 1e-6) & (off <= 10.0 * near)
        if on.any():
            hanging[(a, b)] = candidates[on][np.argsort(t[on])].tolist()
    polygons = [_with_hanging(f, hanging) for f in faces.tolist()]
    middle = {i: len(vertices) + k for k, i in enumerate(i for i, p in enumerate(polygons) if len(p) > 4)}
    added = np.array([vertices[polygons[i]].mean(axis=0) for i in middle]).reshape(-1, 3)
    tri = [t for i, p in enumerate(polygons) for t in _triangles(p, middle.get(i))]
    return compact(np.vstack([vertices, added]), np.array(tri, dtype=np.int64))


def _with_hanging(face: list[int], hanging: dict[tuple[int, int], list[int]]) -> list[int]:
    out: list[int] = []
    for a, b in zip(face, [*face[1:], face[0]], strict=True):
        if a != b:
            out += [a, *hanging.get((a, b), [])]
    return out


def _triangles(polygon: list[int], middle: int | None) -> list[list[int]]:
    if middle is not None:
        return [[a, b, middle] for a, b in zip(polygon, [*polygon[1:], polygon[0]], strict=True)]
    return [polygon] if len(polygon) == 3 else [polygon[:3], [polygon[0], polygon[2], polygon[3]]] if len(polygon) == 4 else []
