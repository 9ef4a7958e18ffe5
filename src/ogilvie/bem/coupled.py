"""Inner and outer domain together: one symmetric system of oscillators, driven by the hull's normal velocity."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from ogilvie.bem.curved import BODY, CONTROL
from ogilvie.bem.curved_nodes import CurvedNodes, frames
from ogilvie.bem.inner import InnerMap, normal_modes
from ogilvie.bem.outer import OuterMode
from ogilvie.bem.reciprocity import FunctionMap, Reciprocity, in_functions, reciprocal
from ogilvie.bem.surface_modes import surface_modes
from ogilvie.errors import ConvergenceError, InputError

Array = NDArray[Any]

_MISSED = 0.5  # largest part of the square of a function on the control surface that its nodes may miss
_SMOOTH = 150.0  # wavenumber in 1/Rc up to which modes of the free surface count as smooth
_FEWEST = 4  # functions of the depth in the lowest azimuthal mode
_MORE = 6  # points per side of a panel, more than nodes, for integrals of these functions


DepthFunctions = Callable[[int, Array, int], Array]


@dataclass(frozen=True, eq=False)
class CoupledSystem:
    """z'' + dampers dampers.T z' + stiffness z = inputs v, phi_hull = inputs.T z + instantaneous v, with Rc = g = 1.

    Parameters
    ----------
    inner : InnerMap
    stiffness : (n, n) array
        Symmetric, >= 0; z holds the free surface's modes, then the outer oscillators.
    dampers : (n, r) array
        Of the outer domain.
    inputs : (n, n_hull) array
        v and phi_hull are values at the hull's nodes times the square root of their weight (all images).
    instantaneous : (n_hull, n_hull) array
        Symmetric, >= 0.
    motions : (n_dofs, n_hull) array
        v of a unit velocity in each dof of the class.
    wavenumber, modes : (n_f,) and (n_f, n_f) array
        Of the free surface: z_f = modes.T (values times square root of weight).
    missed : float
        Largest part of the square of a function on the control surface that its nodes miss.
    """

    inner: InnerMap
    stiffness: Array
    dampers: Array
    inputs: Array
    instantaneous: Array
    motions: Array
    wavenumber: Array
    modes: Array
    missed: float

    @cached_property
    def forcing(self) -> Array:
        """Inputs (n, n_dofs) of unit velocities of the dofs; also the outputs."""
        return self.inputs @ self.motions.T

    @cached_property
    def added_mass(self) -> Array:
        """Added mass at infinite frequency (n_dofs, n_dofs) for unit density."""
        return self.motions @ self.instantaneous @ self.motions.T


def azimuthal_modes(parity: Array, mirrored: tuple[bool, bool], highest: int) -> list[tuple[int, bool]]:
    """Return (m, sine?) of cos(m alpha), sin(m alpha) that have the parities under x -> -x and y -> -y, where these are planes.

    Examples
    --------
    >>> azimuthal_modes(np.array([-1, 1]), (True, True), 6)
    [(1, False), (3, False), (5, False)]
    """
    found = []
    for m in range(highest + 1):
        for sine in (False, True) if m else (False,):
            signs = ((-1) ** (m + sine), -1 if sine else 1)
            if all(not plane or sign == given for plane, sign, given in zip(mirrored, signs, parity, strict=True)):
                found.append((m, sine))
    return found


@dataclass(frozen=True, eq=False)
class Uncoupled:
    """Inner and outer domain of one class, ready to be joined."""

    inner: InnerMap
    map: FunctionMap
    sea: "_Outer"
    motions: Array
    wavenumber: Array
    modes: Array


def uncoupled(
    inner: InnerMap, outer: Sequence[OuterMode], depth_functions: DepthFunctions, *, centre: Array | None = None
) -> Uncoupled:
    """Return both domains of one class in functions of the hull, the control surface and the free surface.

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
    """
    nodes = inner.nodes
    sea = _outer(inner, outer, depth_functions)
    wavenumber, modes = surface_modes(nodes, inner.parity)
    motions = normal_modes(nodes, centre)[inner.dofs] * inner.root_weight[nodes.part == BODY]
    return Uncoupled(inner, in_functions(inner, sea.functions, modes, motions), sea, motions, wavenumber, modes)


def joined(given: Uncoupled, *, reciprocity: Reciprocity = "smoother") -> CoupledSystem:
    """Return the coupled system of one class of symmetry from its two domains.

    Parameters
    ----------
    given : Uncoupled
    reciprocity : {"smoother", "mean"}
        See :func:`ogilvie.bem.reciprocity.reciprocal`.

    Raises
    ------
    ConvergenceError
        N - T_qq is not positive definite.

    Notes
    -----
    With the blocks T of the inner map, q in the functions of the control surface and P = N - T_qq > 0,

        q = P^-1 (T_qf f + T_qv v - b.T w),   f'' = -e,
        S = [[T_ff + T_fq P^-1 T_qf, -T_fq P^-1 b.T], [-b P^-1 T_qf, W^2 + b P^-1 b.T]],
        h = [-(T_fv + T_fq P^-1 T_qv); b P^-1 T_qv],   -phi_hull = -h.T z + (T_vv + T_vq P^-1 T_qv) v.
    """
    sea, modes = given.sea, given.modes
    T = reciprocal(given.map, smooth=int(np.sum(given.wavenumber < _SMOOTH)), how=reciprocity)
    try:
        half = np.linalg.inv(np.linalg.cholesky(sea.instantaneous - T.qq))
    except np.linalg.LinAlgError:
        raise ConvergenceError(
            "Inner and outer domain do not match: the map of the control surface is not definite. Refine the control surface."
        ) from None
    F, V, B = half @ T.qf, half @ T.vq.T, half @ sea.inputs.T
    S = np.block([[T.ff + F.T @ F, -F.T @ B], [-B.T @ F, np.diag(sea.frequencies**2) + B.T @ B]])
    D = np.concatenate([np.zeros((len(modes), sea.dampers.shape[1])), sea.dampers])
    h = np.concatenate([-(T.vf.T + F.T @ V), B.T @ V]) @ T.hull.T
    instantaneous = -T.hull @ (T.vv + V.T @ V) @ T.hull.T
    return CoupledSystem(given.inner, S, D, h, instantaneous, given.motions, given.wavenumber, modes, sea.missed)


@dataclass(frozen=True, eq=False)
class _Outer:
    """Functions of the control surface in rows, and the outer domain in them."""

    functions: Array
    inputs: Array
    dampers: Array
    frequencies: Array
    instantaneous: Array
    missed: float


def _outer(inner: InnerMap, outer: Sequence[OuterMode], depth_functions: DepthFunctions) -> _Outer:
    """Put together all azimuthal modes of the class, each with the depth functions that the nodes can hold."""
    from scipy.linalg import block_diag

    nodes, symmetry = inner.nodes, inner.nodes.mesh.symmetry
    rows: list[Array] = []
    blocks, missed = [], 0.0
    for m, sine in azimuthal_modes(inner.parity, (symmetry == "xz+yz", symmetry != "none"), len(outer) - 1):
        mode = outer[m]
        Y = control_functions(nodes, m, sine, len(mode.instantaneous), depth_functions)
        lost = 1.0 - np.sum(Y**2, axis=1)
        J = int(np.argmax(np.append(lost, 2.0) > _MISSED))
        if J < _FEWEST and not rows:
            raise InputError(
                f"The nodes of the control surface hold {J} functions of the depth of azimuthal mode {m}, {_FEWEST} or "
                "more expected. Use more panels on the control surface, or a higher order."
            )
        if J:
            missed = max(missed, float(lost[:J].max()))
            rows.append(Y[:J])
            blocks.append((mode.inputs[:, :J], mode.dampers, mode.frequencies, mode.instantaneous[:J, :J]))
    b, D, W, N = zip(*blocks, strict=True)
    return _Outer(np.concatenate(rows), block_diag(*b), block_diag(*D), np.concatenate(W), block_diag(*N), missed)


def control_functions(nodes: CurvedNodes, m: int, sine: bool, count: int, depth_functions: DepthFunctions) -> Array:
    """Return the functions of azimuthal mode m on the control surface as seen by its nodes, (count, n_control).

    Rows hold int L_i Y dS / sqrt(weight_i) with L_i one at node i and zero at the others, by a rule of more points than
    nodes: the row times (values times sqrt(weight)) is the integral of Y times what the nodes hold, the transposed row the
    best approximation of Y by the nodes. A function of unit square that the nodes cannot hold has a shorter row.
    """
    p, on = nodes.order, nodes.mesh.part == CONTROL
    t, w = legendre.leggauss(p + _MORE)
    x, _, _, cross = frames(nodes.coefficients[on], t, t)
    area = np.linalg.norm(cross, axis=-1) * np.outer(w, w) * len(nodes.mesh.images)
    L = legendre.legvander(t, p - 1) @ nodes.to_lagrange.T
    depth = np.clip(-x[..., 2] / np.linalg.norm(x, axis=-1), 0.0, 1.0)
    azimuth = np.arctan2(x[..., 1], x[..., 0])
    wave = (np.sin(m * azimuth) if sine else np.cos(m * azimuth)) / np.sqrt(np.pi * (2 if m == 0 else 1))
    values = depth_functions(m, depth.ravel(), count).reshape(count, *depth.shape) * (wave * area)
    rows = np.einsum("knij,ia,jb->knab", values, L, L, optimize=True).reshape(count, -1)
    return np.asarray(rows / np.sqrt(len(nodes.mesh.images) * nodes.weight[nodes.part == CONTROL]))
