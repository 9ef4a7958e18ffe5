"""Linear hydrostatic restoring."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.schema import DOFS
from ogilvie.loads.base import RESTORING, Surroundings, Terms, embed, matrix6

Array = NDArray[Any]


@dataclass(frozen=True, eq=False, init=False)
class LinearRestoring:
    """Force -C eta of buoyancy and weight, for small motions about the equilibrium.

    Parameters
    ----------
    source : xarray.Dataset or (6, 6) array
        A hydrodynamic data set with ``hydrostatic_stiffness``, or the stiffness about O itself, SI, gravity included.

    Raises
    ------
    InputError
        Data set without stiffness, wrong shape, NaN.

    Examples
    --------
    >>> float(LinearRestoring(np.diag([0, 0, 1e8, 9e9, 4e11, 0])).stiffness[3, 3])
    9000000000.0
    """

    stiffness: Array
    name: str = "restoring"

    def __init__(self, source: xr.Dataset | ArrayLike) -> None:
        dofs: tuple[str, ...] = DOFS
        if isinstance(source, xr.Dataset):
            if "hydrostatic_stiffness" not in source:
                raise InputError(
                    "LinearRestoring: hydrostatic_stiffness expected in the data set, not found. "
                    "Give the (6, 6) stiffness about O itself, e.g. from ogilvie.hydrostatics(hull)."
                )
            dofs = tuple(str(d) for d in source.influenced_dof.values)
            source = source["hydrostatic_stiffness"].values
        object.__setattr__(self, "stiffness", matrix6(embed(np.asarray(source), dofs, (0, 1)), "LinearRestoring: stiffness"))
        object.__setattr__(self, "name", "restoring")

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({RESTORING})

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays for the time loop."""
        return Terms(stiffness=self.stiffness)
