"""Vertical sides on top of a hull whose lines end below its deck."""

from dataclasses import replace

import numpy as np

from ogilvie.errors import InputError
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.topology import open_edges


def with_raised_sides(hull: PanelMesh, height: float) -> PanelMesh:
    """Return a hull whose open upper edge is continued by vertical sides up to a height above the still water.

    Parameters
    ----------
    hull : PanelMesh
        Open at the top, above the water.
    height : float
        Of the new edge above z = 0, m.

    Raises
    ------
    InputError
        No open edge, or one that reaches higher.

    Notes
    -----
    Lines plans often end little above the design water; hulls in steep waves or at large heel need their freeboard.

    Examples
    --------
    >>> from ogilvie.mesh.shapes import box
    >>> barge = with_raised_sides(box(4.0, 2.0, 3.0, panels=12).translated((0, 0, 1.0)), 2.5)
    >>> barge.bounds[:, 2].tolist(), barge.symmetry
    ([-2.0, 2.5], 'xz+yz')
    """
    bare = hull.with_lid(None)
    start, end, _ = open_edges(bare.vertices, bare.faces, planes=bare.planes, tolerance=bare.tolerance)
    top = bare.vertices[np.unique(np.r_[start, end])][:, 2] if len(start) else np.array([np.inf])
    if not top.max() < height < np.inf:
        raise InputError(
            f"with_raised_sides: a height above the open edge of {hull.name!r} expected (its z is up to {top.max():.4g} m, inf "
            f"where it is closed), {height!r} found."
        )
    length = float(np.linalg.norm(bare.vertices[end] - bare.vertices[start], axis=1).mean())
    rows = max(1, round((height - float(top.mean())) / length))
    vertices, faces = [bare.vertices], [bare.faces]
    edge = np.unique(np.r_[start, end])
    low_start, low_end, count = start, end, len(bare.vertices)
    for i in range(1, rows + 1):
        level = bare.vertices[edge].copy()
        level[:, 2] += i / rows * (height - level[:, 2])
        vertices.append(level)
        place = np.full(len(bare.vertices), -1)
        place[edge] = count + np.arange(len(edge))
        faces.append(np.stack([low_end, low_start, place[start], place[end]], axis=1))
        low_start, low_end, count = place[start], place[end], count + len(edge)
    return replace(bare, vertices=np.concatenate(vertices), faces=np.concatenate(faces))
