"""Data sets of one vessel at several speeds, in order."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from ogilvie.errors import InputError

#: m/s; speeds as near as this are one, and so far beyond a table is rounding.
ROUNDING = 1e-9


def speed_of(hydro: xr.Dataset) -> float:
    """Return the speed of a data set, m/s."""
    return float(hydro.attrs.get("speed", 0.0))


def by_speed(sets: Sequence[Any], who: str) -> list[xr.Dataset]:
    """Return data sets in the order of their speeds.

    Raises
    ------
    InputError
        Anything else than data sets; none; two at one speed.
    """
    for one in sets:
        if not isinstance(one, xr.Dataset):
            raise InputError(f"{who}: hydrodynamic data sets (xarray.Dataset) expected, {type(one).__name__} found.")
    if not sets:
        raise InputError(f"{who}: one hydrodynamic data set or more expected, none found.")
    found = sorted(sets, key=speed_of)
    speeds = np.array([speed_of(one) for one in found])
    if np.any(np.diff(speeds) <= ROUNDING):
        raise InputError(f"{who}: data sets at different speeds expected, {', '.join(f'{u:.4g}' for u in speeds)} m/s found.")
    return found
