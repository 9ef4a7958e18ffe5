"""Inner and outer domain together: one symmetric system of oscillators, driven by the hull's normal velocity."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from ogilvie.bem.curved import BODY, CONTROL, FREE
from ogilvie.bem.curved_nodes import CurvedNodes, frames
from ogilvie.bem.inner import InnerMap, normal_modes
from ogilvie.errors import ConvergenceError, InputError

Array = NDArray[Any]

_GRAM = 0.9  # largest part of the square of a function on the control surface that its nodes may miss
_MORE = 6  # points per side of a panel, more than nodes, for integrals of these functions


class OuterMode(Protocol):
    """Outer domain of one azimuthal mode in J depth functions: phi = -N q - b.T w, w'' + D D.T w' + W^2 w = b q."""

    @property
    def m(self) -> int: ...
    @property
    def instantaneous(self) -> Array: ...
    @property
    def inputs(self) -> Array: ...
    @property
    def dampers(self) -> Array: ...
    @property
    def frequencies(self) -> Array: ...


DepthFunctions = Callable[[int, Array, int], Array]


@dataclass(frozen=True, eq=False)
class CoupledSystem:
    """z'' + damping z' + stiffness z = inputs v, phi_hull = inputs.T z - instantaneous v, in units of control radius and gravity.

    Parameters
    ----------
    inner : InnerMap
    stiffness, damping : (n, n) array
        Symmetric and >= 0; z holds the potential on the free surface, then the outer oscillators.
    inputs : (n, n_hull) array
    instantaneous : (n_hull, n_hull) array
        Symmetric, >= 0.
    modes : (n_dofs, n_hull) array
        Normal velocity of a unit velocity in each dof of the class.
    gram : float
        Largest part of the square of a function on the control surface that its nodes miss.
    """

    inner: InnerMap
    stiffness: Array
    damping: Array
    inputs: Array
    instantaneous: Array
    modes: Array
    gram: float

    @cached_property
    def forcing(self) -> Array:
        """Inputs (n, n_dofs) of unit velocities of the dofs; also the outputs."""
        return self.inputs @ self.modes.T

    @cached_property
    def added_mass(self) -> Array:
        """Added mass at infinite frequency (n_dofs, n_dofs) for unit density."""
        return self.modes @ self.instantaneous @ self.modes.T


def azimuthal_modes(parity: Array, mirrored: tuple[bool, bool], highest: int) -> list[tuple[int, bool]]:
    """Return (m, sine?) of cos(m alpha), sin(m alpha) that have the parities under x -> -x and y -> -y, where these are planes.

    Examples
    --------
    >>> azimuthal_modes(np.array([-1, 1]), (True, True), 6)
    [(1, False), (3, False), (5, False)]
    >>> azimuthal_modes(np.array([1, -1]), (False, True), 2)
    [(1, True), (2, True)]
    """
    found = []
    for m in range(highest + 1):
        for sine in (False, True) if m else (False,):
            signs = ((-1) ** (m + sine), -1 if sine else 1)
            if all(not plane or sign == given for plane, sign, given in zip(mirrored, signs, parity, strict=True)):
                found.append((m, sine))
    return found


def coupled_system(
    inner: InnerMap, outer: Sequence[OuterMode], depth_functions: DepthFunctions, *, centre: Array | None = None
) -> CoupledSystem:
    """Return the coupled system of one class of symmetry.

    Parameters
    ----------
    inner : InnerMap
    outer : sequence of OuterMode
        Of azimuthal modes 0, 1, 2, ...
    depth_functions : callable
        (m, x, J) -> (J, n): orthonormal functions of x = -z on 0..1.
    centre : (3,) array, optional
        Of the control hemisphere from O, in control radii.

    Raises
    ------
    InputError
        Too few nodes on the control surface for the functions.
    ConvergenceError
        N - T_qq is not positive definite.

    Notes
    -----
    With the blocks T of the inner map, q in the functions of the control surface and P = N - T_qq > 0,

        q = P^-1 (T_qf f + T_qv v - b.T w),   f'' = -e,
        S = [[T_ff + T_fq P^-1 T_qf, -T_fq P^-1 b.T], [-b P^-1 T_qf, W^2 + b P^-1 b.T]],
        h = [-(T_fv + T_fq P^-1 T_qv); b P^-1 T_qv],   -phi_hull = -h.T z + (T_vv + T_vq P^-1 T_qv) v.
    """
    Y, b, D, W, N, gram = _outer(inner, outer, depth_functions)
    T_ff, T_fv, T_vv = (inner.block(*rc) for rc in ((FREE, FREE), (FREE, BODY), (BODY, BODY)))
    T_qf, T_qv = Y @ inner.block(CONTROL, FREE), Y @ inner.block(CONTROL, BODY)
    P = N - Y @ inner.block(CONTROL, CONTROL) @ Y.T
    try:
        half = np.linalg.inv(np.linalg.cholesky(0.5 * (P + P.T)))
    except np.linalg.LinAlgError:
        raise ConvergenceError(
            "Inner and outer domain do not match: the map of the control surface is not definite. Refine the control surface."
        ) from None
    F, V, B = half @ T_qf, half @ T_qv, half @ b.T
    n_f, n = len(T_ff), len(T_ff) + len(W)
    S, C = np.empty((n, n)), np.zeros((n, n))
    S[:n_f, :n_f] = T_ff + F.T @ F
    S[:n_f, n_f:] = -F.T @ B
    S[n_f:, :n_f] = S[:n_f, n_f:].T
    S[n_f:, n_f:] = np.diag(W**2) + B.T @ B
    C[n_f:, n_f:] = D @ D.T
    h = np.concatenate([-(T_fv + F.T @ V), B.T @ V])
    modes = normal_modes(inner.nodes, centre)[inner.dofs] * inner.root_weight[inner.nodes.part == BODY]
    return CoupledSystem(inner, S, C, h, -(T_vv + V.T @ V), modes, gram)


def _outer(
    inner: InnerMap, outer: Sequence[OuterMode], depth_functions: DepthFunctions
) -> tuple[Array, Array, Array, Array, Array, float]:
    """Functions on the control nodes as orthonormal rows, and b, D, W, N of all azimuthal modes of the class."""
    from scipy.linalg import block_diag

    nodes = inner.nodes
    symmetry = nodes.mesh.symmetry
    kinds = azimuthal_modes(inner.parity, (symmetry == "xz+yz", symmetry != "none"), len(outer) - 1)
    used = [outer[m] for m, _ in kinds]
    Y = control_functions(nodes, [(m, sine, len(u.instantaneous)) for (m, sine), u in zip(kinds, used, strict=True)], depth_functions)
    size = np.linalg.eigvalsh(Y @ Y.T)
    gram = float(np.abs(size - 1.0).max())
    if gram > _GRAM:
        raise InputError(
            f"The control surface has {Y.shape[1]} nodes in its stored part; {len(Y)} functions on it have squares between "
            f"{size[0]:.2g} and {size[-1]:.2g} there, 1 within {_GRAM} expected. Use more panels on the control surface, or fewer "
            "outer modes."
        )
    b, D, N = (block_diag(*(getattr(u, name) for u in used)) for name in ("inputs", "dampers", "instantaneous"))
    return Y, b, D, np.concatenate([u.frequencies for u in used]), N, gram


def control_functions(nodes: CurvedNodes, kinds: Sequence[tuple[int, bool, int]], depth_functions: DepthFunctions) -> Array:
    """Return the functions (m, sine?, J) of the control surface seen by its nodes, (n_functions, n_control).

    Rows hold int L_i Y dS / sqrt(weight_i) with L_i one at node i and zero at the others, by a rule of more points than the nodes:
    the row times the values times sqrt(weight) is the integral of Y times what the nodes hold, the transposed the best
    approximation of Y by the nodes. A function of unit square that the nodes cannot hold has a shorter row.
    """
    p, on = nodes.order, nodes.mesh.part == CONTROL
    t, w = legendre.leggauss(p + _MORE)
    x, _, _, cross = frames(nodes.coefficients[on], t, t)
    area = np.linalg.norm(cross, axis=-1) * np.outer(w, w) * len(nodes.mesh.images)
    L = legendre.legvander(t, p - 1) @ nodes.to_lagrange.T
    depth = np.clip(-x[..., 2] / np.linalg.norm(x, axis=-1), 0.0, 1.0)
    azimuth = np.arctan2(x[..., 1], x[..., 0])
    rows = []
    for m, sine, count in kinds:
        wave = (np.sin(m * azimuth) if sine else np.cos(m * azimuth)) / np.sqrt(np.pi * (2 if m == 0 else 1))
        values = depth_functions(m, depth.ravel(), count).reshape(count, *depth.shape) * (wave * area)
        rows.append(np.einsum("knij,ia,jb->knab", values, L, L, optimize=True).reshape(count, -1))
    root = np.sqrt(len(nodes.mesh.images) * nodes.weight[nodes.part == CONTROL])
    return np.concatenate(rows) / root
