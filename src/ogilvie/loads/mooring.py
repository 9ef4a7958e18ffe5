"""Linear springs to the earth."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.loads.base import MOORING, Surroundings, Terms, matrix6, vector6

Array = NDArray[Any]


@dataclass(frozen=True, eq=False, init=False)
class LinearMooring:
    """Force pretension - stiffness eta of a mooring that is linear about the mean position.

    Parameters
    ----------
    stiffness : (6, 6) array
        About O, N/m, N, N m.
    pretension : (6,) array, optional
        Force at zero motion, N, N m.

    Examples
    --------
    >>> springs = LinearMooring(np.diag([2e5, 2e5, 0, 0, 0, 1e9]))
    >>> sorted(springs.covers)
    ['mooring']
    """

    stiffness: Array
    pretension: Array
    name: str = "mooring"

    def __init__(self, stiffness: ArrayLike, *, pretension: ArrayLike | None = None) -> None:
        object.__setattr__(self, "stiffness", matrix6(stiffness, "LinearMooring: stiffness"))
        force = np.zeros(6) if pretension is None else pretension
        object.__setattr__(self, "pretension", vector6(force, "LinearMooring: pretension"))
        object.__setattr__(self, "name", "mooring")

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({MOORING})

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays for the time loop."""
        return Terms(stiffness=self.stiffness, constant=self.pretension)
