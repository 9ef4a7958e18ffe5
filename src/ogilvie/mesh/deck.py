"""A watertight deck across the open upper edge of a hull."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.topology import open_edges

Array = NDArray[np.float64]


def rim(hull: PanelMesh) -> tuple[Array, Array]:
    """Return the start and end points (n, 3) of the open edges of a whole hull, as its panels run along them.

    Examples
    --------
    >>> from ogilvie.mesh.shapes import box
    >>> start, end = rim(box(4.0, 2.0, 1.0, panels=12))
    >>> sorted(set(start[:, 2].tolist())), bool(abs((end - start).sum(axis=0)).max() < 1e-12)
    ([0.0], True)
    """
    whole = hull.with_lid(None).full()
    start, end, _ = open_edges(whole.vertices, whole.faces, planes=(), tolerance=whole.tolerance)
    return whole.vertices[start], whole.vertices[end]


def decked(hull: PanelMesh) -> PanelMesh:
    """Return the whole hull closed by a deck, symmetry "none"; a closed hull is only expanded.

    Parameters
    ----------
    hull : PanelMesh
        Up to the deck, open there; normals into the fluid.

    Raises
    ------
    InputError
        The open edge is at or below the water: there is nothing above it.

    Notes
    -----
    Each open edge is joined to the mean point of all of them by a triangle. Over a plane deck these cover it once (where it is
    not convex with both signs, so that integrals and their clipped parts are right all the same); over a curved one they make a
    low cone.

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
    start, end = rim(hull)
    if len(start) == 0:
        return whole
    apex = 0.5 * (start + end).mean(axis=0)
    if apex[2] <= whole.tolerance:
        raise InputError(
            f"deck: {hull.name!r} up to its deck expected, its open edge is {-apex[2]:.4g} m below still water (mean). "
            "Give the hull with its freeboard (not clipped)."
        )
    n, m = len(whole.vertices), len(start)
    vertices = np.concatenate([whole.vertices, start, end, apex[None]])
    k = np.arange(m)
    top = np.full(m, n + 2 * m)
    faces = np.stack([n + m + k, n + k, top, top], axis=1)
    return replace(whole, vertices=vertices, faces=np.concatenate([whole.faces, faces]))
