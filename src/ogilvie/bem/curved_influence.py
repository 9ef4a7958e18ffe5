"""Influence matrices of curved panels for every class of symmetry, in one pass over the geometry."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numba import njit, prange
from numpy.polynomial import legendre
from numpy.typing import NDArray

from ogilvie.bem.curved import PARTS, CurvedMesh
from ogilvie.bem.curved_kernel import add_rule, near_moments, reach, self_moments
from ogilvie.bem.curved_nodes import CurvedNodes, bends, frames
from ogilvie.errors import InputError

Array = NDArray[Any]

_BENT = 2.0  # how far a panel is off its tangent plane over its half width, from which on
_MORE = 3  # times as many points are taken over the panel of the node itself


@dataclass(frozen=True, eq=False)
class Influence:
    """Potentials at the nodes of single and double layers with the densities of the nodes.

    Parameters
    ----------
    nodes : CurvedNodes
    parities : (n_c, 2) array
        Of each class: sign of the potential under x -> -x and under y -> -y.
    single, double : (n_c, N, N) array
        int L_j / r dS (m) and int L_j d(1/r)/dn dS over the stored part and its images, L_j one at node j and zero at the
        others.
    """

    nodes: CurvedNodes
    parities: Array
    single: Array
    double: Array

    @cached_property
    def solid_angle(self) -> Array:
        """Of the fluid seen from each node (N,): 2 pi on a smooth closed boundary."""
        return -self.double[0].sum(axis=1)


def parities(mesh: CurvedMesh) -> Array:
    """Return the signs (n_c, 2) under x -> -x and y -> -y of the classes that a mesh can hold; the symmetric class is first."""
    y = (1.0,) if mesh.symmetry == "none" else (1.0, -1.0)
    x = (1.0, -1.0) if mesh.symmetry == "xz+yz" else (1.0,)
    return np.array([(a, b) for a in x for b in y])


def influence(nodes: CurvedNodes, *, tolerance: float = 1e-6) -> Influence:
    """Return the influence matrices of all classes of symmetry.

    Parameters
    ----------
    nodes : CurvedNodes
    tolerance : float
        Of the quadrature, relative to the integral of one panel.

    Raises
    ------
    InputError
        A tolerance outside 1e-12..1e-2.

    Notes
    -----
    A Gauss rule of n points on an analytic integrand errs as s^(-2n), s the size of the ellipse with foci at the ends of the
    interval that passes through the nearest singularity. The rule of a box and the halving of boxes follow from s and the
    tolerance.

    Examples
    --------
    >>> from ogilvie.bem.curved import FREE, CurvedMesh
    >>> corners = np.array([[[-1.0, -1.0, 0.0], [-1.0, 1.0, 0.0]], [[1.0, -1.0, 0.0], [1.0, 1.0, 0.0]]])
    >>> square = CurvedNodes(CurvedMesh(corners[None], [FREE], 5.0), order=1)
    >>> round(float(influence(square, tolerance=1e-9).single[0, 0, 0]), 5), round(8 * float(np.arcsinh(1.0)), 5)
    (7.05099, 7.05099)
    """
    if not 1e-12 <= tolerance <= 1e-2:
        raise InputError(f"tolerance: 1e-12 to 1e-2 expected, {tolerance} found.")
    classes = parities(nodes.mesh)
    images = nodes.mesh.images
    signs = np.where(images[None, :, 0] < 0, classes[:, None, 0], 1.0) * np.where(
        images[None, :, 1] < 0, classes[:, None, 1], 1.0
    )
    p = nodes.order
    rules = [_Rule(nodes, n, tolerance) for n in (p + 2, p + 4)]
    near = p + 6
    gauss, weight = legendre.leggauss(near)
    own = near + 2 + int(-math.log10(tolerance) / 2)
    own_rules = [*legendre.leggauss(own), *legendre.leggauss(_MORE * own)]
    centre = np.stack([f[:, 0, 0] for f in frames(nodes.coefficients, np.zeros(1), np.zeros(1))[:3]], axis=1)
    bend = bends(nodes.coefficients)
    S, D = _influence(
        nodes.coefficients, centre, bend, nodes.position, nodes.abscissae, nodes.to_lagrange, images, signs,
        rules[0].points, rules[0].weight, rules[0].P, rules[0].least,
        rules[1].points, rules[1].weight, rules[1].P, rules[1].least,
        gauss, weight, least_ellipse(near, p, tolerance), _bent(nodes, bend), *own_rules,
    )  # fmt: skip
    return Influence(nodes, classes, S, D)


def least_ellipse(n: int, p: int, tolerance: float) -> float:
    """Return the ellipse size from which n points integrate a density of p points to the tolerance."""
    return float(np.exp(-np.log(tolerance) / (2 * n - p)))


class _Rule:
    """Points and x_u x x_v (panels, n, n, 6) of a Gauss rule on every panel, and from which ellipse size on it will do."""

    def __init__(self, nodes: CurvedNodes, n: int, tolerance: float) -> None:
        gauss, self.weight = legendre.leggauss(n)
        x, _, _, cross = frames(nodes.coefficients, gauss, gauss)
        self.points = np.ascontiguousarray(np.concatenate([x, cross], axis=-1))
        self.P = legendre.legvander(gauss, nodes.order - 1)
        self.least = least_ellipse(n, nodes.order, tolerance)


def _bent(nodes: CurvedNodes, bend: Array) -> NDArray[np.bool_]:
    """Tell at which nodes (N,) the panel leaves its tangent plane within its own width there."""
    _, xu, xv, _ = frames(nodes.coefficients, nodes.abscissae, nodes.abscissae)
    guu, gvv, guv = np.sum(xu * xu, axis=-1), np.sum(xv * xv, axis=-1), np.sum(xu * xv, axis=-1)
    narrow = 0.5 * (guu + gvv) - np.sqrt(0.25 * (guu - gvv) ** 2 + guv**2)
    off = 0.5 * bend[:, 0] + bend[:, 1] + 0.5 * bend[:, 2]
    return np.asarray(off[:, None, None] ** 2 > _BENT**2 * narrow).ravel()


@njit(cache=True, nogil=True, parallel=True)
def _influence(
    c: Array, centre: Array, bend: Array, position: Array, abscissae: Array, V: Array, images: Array, signs: Array,
    y1: Array, w1: Array, P1: Array, least1: float, y2: Array, w2: Array, P2: Array, least2: float,
    gauss: Array, weight: Array, least: float,
    bent: Array, own_gauss: Array, own_weight: Array, more_gauss: Array, more_weight: Array,
) -> tuple[Array, Array]:  # fmt: skip
    """Return single and double layer matrices (n_c, N, N)."""
    N, p, n_c = position.shape[0], abscissae.size, signs.shape[0]
    S, D = np.zeros((n_c, N, N)), np.zeros((n_c, N, N))
    for i in prange(N):
        x = np.empty(3)
        s, d, t = np.empty((p, p)), np.empty((p, p)), np.empty((p, p))
        own = i // (p * p)
        for m in range(images.shape[0]):
            x[0], x[1], x[2] = images[m, 0] * position[i, 0], images[m, 1] * position[i, 1], position[i, 2]
            for panel in range(c.shape[0]):
                s[:] = 0.0
                d[:] = 0.0
                if m == 0 and panel == own:
                    k = i - own * p * p
                    u, v = abscissae[k // p], abscissae[k % p]
                    if bent[i]:
                        self_moments(c[panel], u, v, more_gauss, more_weight, s, d)
                    else:
                        self_moments(c[panel], u, v, own_gauss, own_weight, s, d)
                else:
                    in_u, in_v, _ = reach(x, centre[panel], 1.0, 1.0, bend[panel])
                    size = min(in_u, in_v)
                    if size >= least1:
                        add_rule(y1[panel], x, w1, P1, P1, s, d)
                    elif size >= least2:
                        add_rule(y2[panel], x, w2, P2, P2, s, d)
                    else:
                        near_moments(c[panel], x, bend[panel], gauss, weight, least, s, d)
                _spread(s, V, t, signs, m, i, panel, S)
                _spread(d, V, t, signs, m, i, panel, D)
    return S, D


@njit(cache=True, nogil=True)
def _spread(moments: Array, V: Array, t: Array, signs: Array, m: int, i: int, panel: int, out: Array) -> None:
    """Turn moments into values per node and add them to all classes with the sign of the image."""
    p = V.shape[0]
    for a in range(p):
        for l in range(p):
            f = 0.0
            for k in range(p):
                f += V[a, k] * moments[k, l]
            t[a, l] = f
    for a in range(p):
        for b in range(p):
            f = 0.0
            for l in range(p):
                f += t[a, l] * V[b, l]
            for g in range(signs.shape[0]):
                out[g, i, panel * p * p + a * p + b] += signs[g, m] * f


def check_closed(matrices: Influence, *, tolerance: float = 5e-3) -> float:
    """Return the largest defect of the solid angle, |angle/(2 pi) - 1|; refuse a boundary that is not closed.

    Raises
    ------
    InputError
        A defect above the tolerance: the boundary has gaps, overlaps or normals that point inwards. The message names the
        panel.
    """
    defect = np.abs(matrices.solid_angle / (2.0 * np.pi) - 1.0)
    worst = int(np.argmax(defect))
    if not defect[worst] <= tolerance:
        nodes = matrices.nodes
        panel = worst // nodes.order**2
        where = ", ".join(f"{c:.4g}" for c in nodes.position[worst])
        raise InputError(
            f"The boundary of the inner domain is not closed: from panel {panel} ({PARTS[nodes.mesh.part[panel]]}, at {where}) "
            f"it fills {matrices.solid_angle[worst] / (2 * np.pi):.5f} of the half space, 1 within {tolerance:.1g} expected. "
            "Look there for gaps, overlaps or panels whose normal points into the fluid."
        )
    return float(defect[worst])
