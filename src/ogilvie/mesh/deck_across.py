"""A deck of strips from side to side, whose panels are as short as those of the hull."""

from dataclasses import replace

import numpy as np

from ogilvie.mesh.deck import decked
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.topology import open_edges


def decked_across(hull: PanelMesh) -> PanelMesh:
    """Return the whole hull closed by a watertight deck, symmetry "none".

    Parameters
    ----------
    hull : PanelMesh
        As for :func:`ogilvie.mesh.deck.decked`, which also closes a hull without the symmetry "xz".

    Notes
    -----
    Each open edge is joined to its projection on the plane of symmetry; the edges that arise there cancel with those of the
    other side. Long waves over the deck are resolved as they are over the sides, which a deck of triangles to one point is not.

    Raises
    ------
    InputError
        The hull ends at the water, is open below it, or has its normals inside.

    Examples
    --------
    >>> from ogilvie.mesh.shapes import box
    >>> barge = decked_across(box(4.0, 2.0, 3.0, panels=12).translated((0, 0, 1.0)))
    >>> barge.volumes.round(12).tolist(), float(abs(barge.area_vectors.sum(axis=0)).max().round(12))
    ([24.0, 24.0, 24.0], 0.0)
    """
    closed = decked(hull)
    if "xz" not in hull.planes:
        return closed
    whole = hull.with_lid(None).full()
    start, end, _ = open_edges(whole.vertices, whole.faces, planes=(), tolerance=whole.tolerance)
    if len(start) == 0:
        return closed
    rim = np.unique(np.concatenate([start, end]))
    middle = whole.vertices[rim] * [1.0, 0.0, 1.0]
    grid = np.round(middle / max(whole.tolerance, 1e-300)).astype(np.int64)
    _, kept, place = np.unique(grid, axis=0, return_index=True, return_inverse=True)
    below = np.zeros(len(whole.vertices), dtype=np.int64)
    below[rim] = len(whole.vertices) + place.ravel()
    faces = np.stack([end, start, below[start], below[end]], axis=1)
    return replace(whole, vertices=np.concatenate([whole.vertices, middle[kept]]), faces=np.concatenate([whole.faces, faces]))
