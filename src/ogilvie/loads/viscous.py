"""Viscous damping, linear or quadratic in the velocity."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.schema import DOFS
from ogilvie.loads.base import Surroundings, Terms, matrix6, per_dof, viscous_effect
from ogilvie.loads.kernel import NU_R, Kernel, load_kernel

Array = NDArray[Any]


def quadratic_effect(dof: str) -> str:
    """Return the name of the effect "viscous damping beyond the linear" of one degree of freedom.

    Examples
    --------
    >>> quadratic_effect("sway")
    'nonlinear viscous damping of sway'
    """
    return f"nonlinear viscous damping of {dof}"


@dataclass(frozen=True, eq=False, init=False)
class LinearDamping:
    """Force -D nu, given as a matrix or as fractions of critical damping.

    Parameters
    ----------
    matrix : (6, 6) array, optional
        D about O, SI.
    ratio : mapping of str to float, optional
        Degree of freedom to fraction of its critical damping, e.g. ``{"roll": 0.05}``. Give `matrix` or `ratio`.

    Raises
    ------
    InputError
        Neither or both given, wrong shape, NaN, unknown degree of freedom, negative ratio.

    Notes
    -----
    A ratio z makes D_jj = 2 z sqrt(C_jj (M_jj + A_jj(w_n))) with w_n = sqrt(C_jj / (M_jj + A_jj(w_n))), the natural frequency
    of the uncoupled degree of freedom with the stiffness of all loads. It comes on top of the wave radiation damping.

    Examples
    --------
    >>> sorted(LinearDamping(ratio={"roll": 0.05}).covers)
    ['viscous damping of roll']
    """

    matrix: Array
    ratio: Array
    name: str = "damping"

    def __init__(self, matrix: ArrayLike | None = None, *, ratio: Mapping[str, float] | None = None) -> None:
        if (matrix is None) == (ratio is None):
            raise InputError("LinearDamping: exactly one of matrix (6, 6) and ratio (per degree of freedom) expected.")
        D = matrix6(np.zeros((6, 6)) if matrix is None else matrix, "LinearDamping: matrix")
        z = per_dof(ratio or {}, "LinearDamping: ratio")
        if np.any(z < 0.0):
            raise InputError(f"LinearDamping: ratios >= 0 expected, {z.min():g} found for {DOFS[int(z.argmin())]}.")
        object.__setattr__(self, "matrix", D)
        object.__setattr__(self, "ratio", z)
        object.__setattr__(self, "name", "damping")

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for: one per damped degree of freedom."""
        damped = self.matrix.any(axis=1) | (self.ratio > 0.0)
        return frozenset(viscous_effect(d) for d, yes in zip(DOFS, damped, strict=True) if yes)

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays for the time loop."""
        return Terms(damping=self.matrix, damping_ratio=self.ratio)


@load_kernel
def _quadratic_force(x: Array, data: Array, own: Array, force: Array) -> None:
    for j in range(6):
        v = x[NU_R + j]
        for i in range(6):
            force[i] -= data[6 * i + j] * abs(v) * v


@dataclass(frozen=True, eq=False, init=False)
class QuadraticDamping:
    """Force that grows with the square of the velocity through the water.

    Parameters
    ----------
    coefficients : (6, 6) array or mapping of str to float
        D2 about O, N s2/m2, N s2, N m s2; or its diagonal per degree of freedom, e.g. ``{"roll": 4e9, "sway": 2e5}``.

    Raises
    ------
    InputError
        Wrong shape, NaN, unknown degree of freedom, negative number on the diagonal (it would drive the motion).

    Notes
    -----
    ``F_i = -sum_j D2_ij |nu_rj| nu_rj``. It comes on top of :class:`LinearDamping` and covers another effect.

    Examples
    --------
    >>> load = QuadraticDamping({"roll": 3.0})
    >>> load.bind(None).kernel.force(nu=[0, 0, 0, -2.0, 0, 0])
    array([ 0.,  0.,  0., 12.,  0.,  0.])
    """

    matrix: Array
    name: str = "quadratic_damping"

    def __init__(self, coefficients: ArrayLike | Mapping[str, float]) -> None:
        if isinstance(coefficients, Mapping):
            coefficients = np.diag(per_dof(coefficients, "QuadraticDamping"))
        D = matrix6(coefficients, "QuadraticDamping: matrix")
        if np.any(np.diag(D) < 0.0):
            worst = int(np.diag(D).argmin())
            raise InputError(f"QuadraticDamping: coefficients >= 0 expected, {D[worst, worst]:g} found for {DOFS[worst]}.")
        object.__setattr__(self, "matrix", D)
        object.__setattr__(self, "name", "quadratic_damping")

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for: one per damped degree of freedom."""
        return frozenset(quadratic_effect(d) for d, row in zip(DOFS, self.matrix, strict=True) if row.any())

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the compiled force for the time loop."""
        return Terms(kernel=Kernel(_quadratic_force, self.matrix.flatten()))
