"""Inner domain: what the potential on the free surface and the normal velocities elsewhere make on the whole boundary."""

from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.curved import BODY, FREE, CurvedMesh
from ogilvie.bem.curved_influence import Influence, check_closed, influence
from ogilvie.bem.curved_nodes import CurvedNodes
from ogilvie.errors import ConvergenceError
from ogilvie.hydro.threads import in_parallel

Array = NDArray[Any]

#: Signs of the potential under x -> -x and y -> -y when the body moves in each dof.
DOF_PARITIES = np.array([[-1, 1], [1, -1], [1, 1], [1, -1], [-1, 1], [-1, -1]])


@dataclass(frozen=True, eq=False)
class InnerMap:
    """The map (f, q, v) -> (e, -phi_control, -phi_hull) of one class of symmetry, in the nodes' values times sqrt(weight).

    Lengths are in control radii. f is the potential on the free surface and e its normal derivative there, q and v are the
    normal derivatives on control surface and hull (normals out of the fluid).

    Parameters
    ----------
    nodes : CurvedNodes
        Of the mesh in control radii.
    parity : (2,) array
        Sign of the potential under x -> -x and y -> -y (1 where there is no such plane).
    matrix : (N, N) array
        In the order of the nodes, as solved: symmetric but for the error of the discretisation.
    """

    nodes: CurvedNodes
    parity: Array
    matrix: Array

    @cached_property
    def root_weight(self) -> Array:
        """Square root of the area of each node and all its images (N,)."""
        return np.sqrt(len(self.nodes.mesh.images) * self.nodes.weight)

    @cached_property
    def asymmetry(self) -> float:
        """Size of the antisymmetric part over that of the matrix: an error of rough functions, which K hardly feels."""
        return _norm(0.5 * (self.matrix - self.matrix.T)) / _norm(self.matrix)

    @property
    def dofs(self) -> list[int]:
        """Dofs whose motion makes a potential of this class."""
        mirrored = [self.nodes.mesh.symmetry == "xz+yz", self.nodes.mesh.symmetry != "none"]
        fits = (self.parity == DOF_PARITIES) | ~np.array(mirrored)
        return [int(i) for i in np.flatnonzero(fits.all(axis=1))]


def unit_mesh(mesh: CurvedMesh) -> CurvedMesh:
    """Return the mesh in control radii."""
    return CurvedMesh(mesh.points / mesh.radius, mesh.part, 1.0, mesh.symmetry)


def inner_maps(mesh: CurvedMesh, *, order: int = 4, tolerance: float = 1e-6) -> tuple[list[InnerMap], float]:
    """Return the maps of all classes of symmetry, and the largest defect of the solid angle.

    Parameters
    ----------
    mesh : CurvedMesh
    order : int
        Nodes per side of a panel.
    tolerance : float
        Of the quadrature.

    Raises
    ------
    InputError
        A boundary that is not closed (:func:`ogilvie.bem.curved_influence.check_closed`).
    ConvergenceError
        Influence matrices that are not finite.

    Notes
    -----
    Green's second identity with the normal out of the fluid, c the solid angle of the fluid at the node:

        c phi + int phi d(1/r)/dn dS = int phi_n / r dS.

    For two harmonic functions int (phi psi_n - psi phi_n) dS = 0, so the map is symmetric in the area-weighted product. The
    discrete map is so for smooth functions; :func:`ogilvie.bem.reciprocity.reciprocal` makes it so for all.
    """
    nodes = CurvedNodes(unit_mesh(mesh), order)
    matrices = influence(nodes, tolerance=tolerance)
    if not (np.all(np.isfinite(matrices.single)) and np.all(np.isfinite(matrices.double))):
        raise ConvergenceError("Influence matrices of the inner domain hold NaN: panels touch or cross; look at the mesh.")
    defect = check_closed(matrices)
    return in_parallel(partial(_map, matrices), range(len(matrices.parities))), defect


def _map(matrices: Influence, index: int) -> InnerMap:
    """Solve Green's identity for what is not given."""
    from scipy.linalg import solve

    nodes = matrices.nodes
    S, D = matrices.single[index], matrices.double[index] + np.diag(matrices.solid_angle)
    free = nodes.part == FREE
    left, right = np.where(free, S, D), np.where(free, D, -S)
    T = solve(left, right, overwrite_a=True, overwrite_b=True, check_finite=False)
    root = np.sqrt(nodes.weight)
    return InnerMap(nodes, matrices.parities[index], root[:, None] * T / root)


def _norm(a: Array) -> float:
    """Return the largest singular value, by a few steps of the power method on a.T a."""
    x = np.cos(np.arange(a.shape[0]) + 1.0)
    for _ in range(12):
        x = a.T @ (a @ (x / np.linalg.norm(x)))
    return float(np.sqrt(np.linalg.norm(x)))


def normal_modes(nodes: CurvedNodes, centre: Array | None = None) -> Array:
    """Return n_1..n_6 at the hull's nodes (6, n_hull): normal velocity of a unit velocity in each dof about O.

    `centre` (3,) is where the origin of the nodes lies from O, in their unit of length.
    """
    hull = nodes.part == BODY
    n, x = nodes.normal[hull], nodes.position[hull] + (0.0 if centre is None else np.asarray(centre))
    return np.concatenate([n, np.cross(x, n)], axis=1).T
