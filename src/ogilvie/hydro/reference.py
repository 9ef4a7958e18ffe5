"""Moves a data set from the point its source refers to, to O."""

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.frames import shift_matrix
from ogilvie.hydro.schema import DOFS, VARIABLES

Array = NDArray[np.float64]

_MOTIONS = ("motion_rao",)
_NOT_MOVABLE = ("mean_drift_pressure_body",)


def moved_to_origin(hydro: xr.Dataset, point: ArrayLike) -> xr.Dataset:
    """Return the data set about O, given one about another point of the body.

    Parameters
    ----------
    hydro : Dataset
        Forces, matrices and motions about `point`; the phase of the waves counts from O.
    point : (3,) array
        The point in the axes of O, m.

    Returns
    -------
    xarray.Dataset
        Drift about the moving origin of the body is left out: to move it takes the first-order forces.

    Raises
    ------
    InputError
        The data set lacks one of the six rigid-body dofs, so moments cannot be moved.

    Notes
    -----
    With H of :func:`ogilvie.frames.shift_matrix` the velocity at the point is H nu_O; so F_O = H^T F, M_O = H^T M H and
    X_O = H^-1 X.

    Examples
    --------
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> A = np.eye(6)[None]
    >>> h = hydro_from_arrays(omega=[1.0], added_mass=A, radiation_damping=A)
    >>> float(moved_to_origin(h, [0.0, 0.0, -2.0]).added_mass[0, 3, 3])  # A44 + z^2 A22
    5.0
    """
    p = np.asarray(point, dtype=float)
    if not p.any():
        return hydro
    if tuple(hydro.influenced_dof.values) != DOFS:
        raise InputError(
            f"hydrodynamic data about the point {p.tolist()} m: all six dofs expected to move them to the origin, "
            f"{hydro.influenced_dof.values.tolist()} found. Choose the origin on the still water plane in the solver."
        )
    H = shift_matrix(p)
    moved = {}
    for key, variable in hydro.data_vars.items():
        dims, _ = VARIABLES.get(str(key), ((), False))
        if key in _NOT_MOVABLE or "influenced_dof" not in dims:
            continue
        if "radiating_dof" in dims:
            values = H.T @ variable.values @ H
        elif key in _MOTIONS:
            values = variable.values @ shift_matrix(-p).T
        else:
            values = _times(variable.values, H)
        moved[key] = (dims, values, variable.attrs)
    return hydro.drop_vars([key for key in _NOT_MOVABLE if key in hydro]).assign(moved)


def _times(values: NDArray, H: Array) -> NDArray:
    """Return values @ H; a result is NaN only where an entry that enters it is."""
    unknown = np.isnan(values)
    product = np.where(unknown, 0.0, values) @ H
    return np.where(unknown.astype(float) @ (H != 0.0) > 0, np.nan, product)
