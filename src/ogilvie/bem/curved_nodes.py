"""Unknowns on curved panels: values at the products of Gauss-Legendre points, with position, normal and weight."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import chebyshev, legendre
from numpy.typing import NDArray

from ogilvie.bem.curved import Array, CurvedMesh
from ogilvie.errors import InputError
from ogilvie.mesh.chebyshev import chebyshev_points


@dataclass(frozen=True, eq=False)
class CurvedNodes:
    """The p x p Gauss-Legendre points of every panel, panel by panel, u before v.

    A density is the polynomial of degree p - 1 in u and in v through its values there; `weight` integrates over the stored
    part.

    Parameters
    ----------
    mesh : CurvedMesh
    order : int
        p, 1 for values that are constant on a panel.

    Raises
    ------
    InputError
        p outside 1..12, or a panel whose area element vanishes at a node.

    Examples
    --------
    >>> from ogilvie.bem.curved import FREE, CurvedMesh
    >>> corners = np.array([[[0.0, 0.0, 0.0], [0.0, 2.0, 0.0]], [[3.0, 0.0, 0.0], [3.0, 2.0, 0.0]]])
    >>> nodes = CurvedNodes(CurvedMesh(corners[None], [FREE], 5.0), order=3)
    >>> len(nodes.weight), round(float(nodes.weight.sum()), 12), nodes.normal[0].round(12).tolist()
    (9, 6.0, [0.0, 0.0, 1.0])
    """

    mesh: CurvedMesh
    order: int = 3

    def __post_init__(self) -> None:
        if not 1 <= self.order <= 12:
            raise InputError(f"order: 1 to 12 nodes per side of a panel expected, {self.order} found.")
        size = np.linalg.norm(self._frames[3], axis=-1)
        if not np.all(size > 1e-12 * size.max()):
            worst = int(np.argmin(size.min(axis=(1, 2))))
            raise InputError(
                f"Panel {worst} has no area at one of its nodes: two of its sides are parallel or one has length zero."
            )

    @cached_property
    def abscissae(self) -> Array:
        """Gauss-Legendre points (p,) of one side."""
        return legendre.leggauss(self.order)[0]

    @cached_property
    def coefficients(self) -> Array:
        """Coefficients (n, q, q, 3) of T_k(u) T_l(v) of each panel."""
        q = self.mesh.degree
        inverse = np.linalg.inv(chebyshev.chebvander(chebyshev_points(q), q - 1))
        return np.ascontiguousarray(np.einsum("ki,lj,nijd->nkld", inverse, inverse, self.mesh.points))

    @cached_property
    def _frames(self) -> tuple[Array, Array, Array, Array]:
        """Position, both tangents and x_u x x_v, each (n, p, p, 3)."""
        return frames(self.coefficients, self.abscissae, self.abscissae)

    @cached_property
    def position(self) -> Array:
        """(n_nodes, 3) m."""
        return self._frames[0].reshape(-1, 3)

    @cached_property
    def normal(self) -> Array:
        """Unit normal (n_nodes, 3) out of the fluid."""
        cross = self._frames[3].reshape(-1, 3)
        return cross / np.linalg.norm(cross, axis=1, keepdims=True)

    @cached_property
    def weight(self) -> Array:
        """Area that belongs to each node (n_nodes,), m2, on the stored part."""
        w = legendre.leggauss(self.order)[1]
        return (np.linalg.norm(self._frames[3], axis=-1) * np.outer(w, w)).ravel()

    @cached_property
    def part(self) -> NDArray[np.int64]:
        """`BODY`, `FREE` or `CONTROL` of each node."""
        return np.repeat(self.mesh.part, self.order**2)

    @cached_property
    def to_lagrange(self) -> Array:
        """V (p, p): the polynomial that is one at node a and zero at the others is sum_k V[a, k] P_k."""
        x, w = legendre.leggauss(self.order)
        k = np.arange(self.order)
        return np.ascontiguousarray(w[:, None] * legendre.legvander(x, self.order - 1) * (k + 0.5))


def frames(coefficients: Array, u: Array, v: Array) -> tuple[Array, Array, Array, Array]:
    """Return position, x_u, x_v and x_u x x_v of panels (n, q, q, 3) at the products of u and v, each (n, n_u, n_v, 3)."""
    q = coefficients.shape[1]
    Tu, Tv = chebyshev.chebvander(u, q - 1), chebyshev.chebvander(v, q - 1)
    derivative = np.zeros((q, q))
    derivative[: q - 1] = chebyshev.chebder(np.eye(q)) if q > 1 else 0.0
    dTu, dTv = Tu @ derivative, Tv @ derivative
    half, half_d = (np.einsum("nkld,jl->nkjd", coefficients, T, optimize=True) for T in (Tv, dTv))
    x, xu, xv = (np.einsum("ik,nkjd->nijd", T, h, optimize=True) for T, h in ((Tu, half), (dTu, half), (Tu, half_d)))
    return x, xu, xv, np.cross(xu, xv)


def bends(coefficients: Array) -> Array:
    """Return the largest |x_uu|, |x_uv| and |x_vv| of panels (n, q, q, 3) on a grid, (n, 3).

    Examples
    --------
    >>> flat = np.zeros((1, 3, 3, 3))
    >>> flat[0, 1, 0, 0] = flat[0, 0, 1, 1] = 1.0  # x = u, y = v
    >>> flat[0, 2, 0, 2] = 0.5  # z = u^2 - 1/2
    >>> bends(flat).tolist()
    [[2.0, 0.0, 0.0]]
    """
    q = coefficients.shape[1]
    grid = np.cos(np.pi * np.arange(2 * q + 1) / (2 * q))
    bases = [chebyshev.chebvander(grid, q - 1)]
    for order in (1, 2):
        derivative = np.zeros((q, q))
        if q > order:
            derivative[: q - order] = chebyshev.chebder(np.eye(q), order)
        bases.append(bases[0] @ derivative)
    pairs = ((2, 0), (1, 1), (0, 2))
    values = [np.einsum("ik,jl,nkld->nijd", bases[a], bases[b], coefficients, optimize=True) for a, b in pairs]
    return np.stack([np.linalg.norm(x, axis=-1).max(axis=(1, 2)) for x in values], axis=1)
