"""Boundaries with their inner corners moved at random: for what must not depend on the panels."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.curved import CONTROL, FREE, CurvedMesh
from ogilvie.errors import InputError
from ogilvie.mesh.chebyshev import chebyshev_points

Array = NDArray[Any]


def jittered(mesh: CurvedMesh, amount: float = 0.4, *, seed: int = 0) -> CurvedMesh:
    """Return the mesh with the corners inside free surface and control surface moved at random.

    Parameters
    ----------
    mesh : CurvedMesh
    amount : float
        Each corner moves by this part, 0 to 0.9, of half the shortest side there.
    seed : int

    Returns
    -------
    CurvedMesh
        Closed as before: panels follow by bilinear functions of u and v, so that neighbours keep their common sides; those of
        the control surface are put back on the sphere. Corners on the waterline, the circle and planes of symmetry stay.

    Raises
    ------
    InputError
        An amount out of range.

    Examples
    --------
    >>> from ogilvie.bem.inner_mesh import inner_mesh
    >>> from ogilvie.mesh.shapes import hemisphere
    >>> mesh = inner_mesh(hemisphere(1.0))
    >>> bool(np.abs(jittered(mesh).points - mesh.points).max() > 0.03)
    True
    """
    if not 0.0 <= amount <= 0.9:
        raise InputError(f"jittered: amount 0 to 0.9 expected, {amount!r} found.")
    points, rng = mesh.points.copy(), np.random.default_rng(seed)
    h = 0.5 * (1.0 + chebyshev_points(mesh.degree))
    hat = np.stack([np.outer(a, b) for a in (1 - h, h) for b in (1 - h, h)])  # (4, q, q)
    for part in (FREE, CONTROL):
        here = np.flatnonzero(mesh.part == part)
        corners = points[here][:, [0, 0, -1, -1], [0, -1, 0, -1]]  # (n, 4, 3)
        move = amount * _moves(corners, mesh, part, rng)
        points[here] += np.einsum("cuv,nck->nuvk", hat, move)
        if part == CONTROL:
            points[here] *= mesh.radius / np.linalg.norm(points[here], axis=-1, keepdims=True)
    return replace(mesh, points=points)


def _moves(corners: Array, mesh: CurvedMesh, part: int, rng: np.random.Generator) -> Array:
    """Return a random vector half as long as the shortest side there for each corner, zero for those that stay (n, 4, 3)."""
    key = np.round(corners / (1e-7 * mesh.radius)).astype(np.int64).reshape(-1, 3)
    _, index, count = np.unique(key, axis=0, return_inverse=True, return_counts=True)
    index = index.ravel()
    side = [np.linalg.norm(corners[:, a] - corners[:, b], axis=1) for a, b in ((0, 1), (0, 2), (3, 1), (3, 2))]
    local = np.full(len(count), np.inf)
    np.minimum.at(local, index, np.repeat(np.min(side, axis=0), 4))
    direction = rng.normal(size=(len(count), 3)) * [1.0, 1.0, 0.0 if part == FREE else 1.0]
    move = 0.5 * local[:, None] * direction / np.linalg.norm(direction, axis=1, keepdims=True)
    place = np.zeros((len(count), 3))
    place[index] = corners.reshape(-1, 3)
    fixed = count < 3  # on a border, or where only two panels meet
    if mesh.symmetry != "none":
        fixed |= np.any(np.abs(place[:, :2]) < 1e-9 * mesh.radius, axis=1)
    if part == CONTROL:
        fixed |= np.abs(place[:, 2]) < 1e-9 * mesh.radius
    move[fixed] = 0.0
    return np.asarray(move[index].reshape(-1, 4, 3))
