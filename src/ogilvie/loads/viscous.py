"""Viscous damping, linear in the velocity."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.schema import DOFS
from ogilvie.loads.base import Surroundings, Terms, matrix6, per_dof, viscous_effect

Array = NDArray[Any]


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
