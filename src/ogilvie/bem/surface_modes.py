"""Standing waves of the free surface inside the control hemisphere: Neumann modes of its Laplace operator."""

from typing import Any

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from ogilvie.bem.curved import FREE
from ogilvie.bem.curved_nodes import CurvedNodes, frames
from ogilvie.mesh.chebyshev import chebyshev_points

Array = NDArray[Any]


def surface_modes(nodes: CurvedNodes, parity: Array) -> tuple[Array, Array]:
    """Return wavenumbers and modes of the free surface of one class of symmetry.

    Parameters
    ----------
    nodes : CurvedNodes
    parity : (2,) array
        Sign of the potential under x -> -x and y -> -y.

    Returns
    -------
    wavenumber : (n,) array
        Ascending; infinite for what no continuous function can hold.
    modes : (n, n) array
        Orthonormal columns: values at the nodes times sqrt(weight).

    Notes
    -----
    The functions are continuous, of degree p - 1 on each panel; their mass and stiffness

        M_ij = int f_i f_j dS,   K_ij = int grad f_i . grad f_j dS,   K f = k^2 M f

    are integrated by the p x p nodes themselves, so the modes are orthonormal there. A class that is odd in x (y) has no
    value on the line x = 0 (y = 0). The p^2 values of each panel have more freedom than continuous functions: the rest, jumps
    between panels, completes the basis.
    """
    from scipy.linalg import eigh, null_space

    to_nodes, gradients, weight = _continuous(nodes, parity)
    E = np.sqrt(weight)[:, None] * to_nodes
    stiffness = sum(g.T @ (weight[:, None] * g) for g in gradients)
    square, shapes = eigh(stiffness, E.T @ E)
    modes = E @ shapes
    rest = null_space(modes.T) if modes.shape[1] < len(weight) else np.zeros((len(weight), 0))
    k = np.concatenate([np.sqrt(np.maximum(square, 0.0)), np.full(rest.shape[1], np.inf)])
    return k, np.concatenate([modes, rest], axis=1)


def _continuous(nodes: CurvedNodes, parity: Array) -> tuple[Array, tuple[Array, Array], Array]:
    """Return values (n, n_c) and gradient at the nodes of each continuous function, and the weights (n,)."""
    p, free = nodes.order, np.flatnonzero(nodes.mesh.part == FREE)
    corners = chebyshev_points(p)
    c = nodes.coefficients[free]
    number, kept = _merged(frames(c, corners, corners)[0].reshape(-1, 3), parity, nodes)
    value, slope = _one_dimension(corners, nodes.abscissae)
    _, xu, xv, cross = frames(c, nodes.abscissae, nodes.abscissae)
    size = len(free) * p * p
    to_nodes, du, dv = np.zeros((3, size, size))
    for i in range(len(free)):
        part = slice(i * p * p, (i + 1) * p * p)
        to_nodes[part, part] = np.kron(value, value)
        du[part, part], dv[part, part] = np.kron(slope, value), np.kron(value, slope)
    z = cross[..., 2].reshape(-1, 1)
    gx = (xv[..., 1].reshape(-1, 1) * du - xu[..., 1].reshape(-1, 1) * dv) / z
    gy = (-xv[..., 0].reshape(-1, 1) * du + xu[..., 0].reshape(-1, 1) * dv) / z
    gather = np.zeros((size, number.max() + 1))
    gather[np.arange(size), number] = 1.0
    gather = gather[:, kept]
    weight = len(nodes.mesh.images) * nodes.weight[nodes.part == FREE]
    return to_nodes @ gather, (gx @ gather, gy @ gather), weight


def _merged(points: Array, parity: Array, nodes: CurvedNodes) -> tuple[Array, Array]:
    """Number the points (n, 3), equal ones alike; tell which numbers are off the lines where the class is zero."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    near = 1e-6 * float(np.ptp(points, axis=0).max())
    pairs = cKDTree(points).query_pairs(near, output_type="ndarray")
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(points), len(points)))
    count, number = connected_components(graph, directed=False)
    zero = np.zeros(len(points), dtype=bool)
    for axis in (0, 1):
        mirrored = np.any(nodes.mesh.images[:, axis] < 0)
        if mirrored and parity[axis] < 0:
            zero |= np.abs(points[:, axis]) < near
    kept = np.ones(count, dtype=bool)
    kept[number[zero]] = False
    return number, kept


def _one_dimension(corners: Array, x: Array) -> tuple[Array, Array]:
    """Return values and slopes (p, p) at x of the polynomials that are one at one corner and zero at the others."""
    p = len(corners)
    inverse = np.linalg.inv(legendre.legvander(corners, p - 1))
    slope = np.zeros((p, p))
    slope[: p - 1] = legendre.legder(np.eye(p))
    V = legendre.legvander(x, p - 1)
    return V @ inverse, V @ slope @ inverse
