"""A watertight deck across the open upper edge of a hull."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.topology import open_edges, without_t_junctions

Array = NDArray[np.float64]

GAP = 0.01  #: part of the extent up to which two open edges side by side are a gap between patches, not an opening


def rim(hull: PanelMesh) -> Array:
    """Return the points (n, 3) of the open edge of a whole hull; empty where the hull is closed.

    Examples
    --------
    >>> from ogilvie.mesh.shapes import box
    >>> sorted(set(rim(box(4.0, 2.0, 1.0, panels=12))[:, 2].tolist()))
    [0.0]
    """
    whole = hull.with_lid(None).full()
    start, end, _ = open_edges(whole.vertices, whole.faces, planes=(), tolerance=whole.tolerance)
    if len(start) == 0:
        return np.zeros((0, 3))
    kept = without_t_junctions(whole.vertices, start, end, tolerance=GAP * float(np.ptp(whole.bounds, axis=0).max()))
    return whole.vertices[np.unique(np.concatenate([start[kept], end[kept]]))]


def decked(hull: PanelMesh) -> PanelMesh:
    """Return the whole hull closed by a watertight deck, symmetry "none"; a closed hull is only expanded.

    Parameters
    ----------
    hull : PanelMesh
        Up to the deck, open there; normals into the fluid.

    Raises
    ------
    InputError
        The hull ends at the water, is open below it, or has its normals inside.

    Notes
    -----
    Each open edge is joined to the mean point of all of them by a triangle. Over a plane deck these cover it once (where it is
    not convex with both signs, so that integrals and their clipped parts are right all the same); over a curved one they make a
    low cone. The two sides of a narrow gap between patches cancel.

    Examples
    --------
    >>> from ogilvie.mesh.shapes import box
    >>> barge = decked(box(4.0, 2.0, 3.0, panels=12).translated((0, 0, 1.0)))
    >>> barge.volumes.round(12).tolist(), float(abs(barge.area_vectors.sum(axis=0)).max().round(12))
    ([24.0, 24.0, 24.0], 0.0)
    """
    whole = hull.with_lid(None).full()
    if whole.volumes.mean() <= 0.0:
        raise InputError(f"deck: normals of {hull.name!r} into the fluid expected. Use .flipped().")
    if whole.bounds[1, 2] <= whole.tolerance:
        raise InputError(
            f"deck: {hull.name!r} up to its deck expected, it ends at z = {whole.bounds[1, 2]:.4g} m. "
            "Give the hull with its freeboard (not clipped)."
        )
    edge = rim(hull)
    if len(edge) and edge[:, 2].min() <= whole.tolerance:
        raise InputError(
            f"deck: {hull.name!r} open above the water alone expected, an open edge at z = {edge[:, 2].min():.4g} m found. "
            "Close it, or move the hull to its draught."
        )
    start, end, _ = open_edges(whole.vertices, whole.faces, planes=(), tolerance=whole.tolerance)
    if len(start) == 0:
        return whole
    apex = (edge if len(edge) else whole.vertices[start]).mean(axis=0)
    top = np.full(len(start), len(whole.vertices))
    faces = np.stack([end, start, top, top], axis=1)
    return replace(whole, vertices=np.vstack([whole.vertices, apex]), faces=np.concatenate([whole.faces, faces]))
