"""Which components of a sea have data: the others must hold a negligible share of the variance."""

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.waves.field import Sea

#: Largest share of the sea's variance that may lie outside the frequencies of the data (left out with a warning).
NEGLIGIBLE = 1e-3


def covered(sea: Sea, omega: NDArray[Any], who: str) -> NDArray[np.bool_]:
    """Return which components of a sea have frequencies within the data (n_w,).

    Raises
    ------
    InputError
        More than a negligible share of the variance lies outside.
    """
    lo, hi = float(omega[0]), float(omega[-1])
    inside = (sea.omega >= lo * (1 - 1e-9)) & (sea.omega <= hi * (1 + 1e-9))
    if inside.all():
        return inside
    variance = np.atleast_2d(sea.amplitude**2).mean(axis=0)
    share = float(variance[~inside].sum() / variance.sum()) if variance.any() else 0.0
    found = (
        f"{who}: the coefficients cover {lo:.4g}..{hi:.4g} rad/s, the sea has components from {sea.omega.min():.4g} to "
        f"{sea.omega.max():.4g} rad/s; {100 * share:.3g} % of its variance lies outside."
    )
    if share > NEGLIGIBLE:
        raise InputError(f"{found} At most {100 * NEGLIGIBLE:g} % can be left out: extend the coefficients or limit the sea.")
    if share > 0.0:
        warnings.warn(f"{found} It exerts no force.", OgilvieWarning, stacklevel=5)
    return inside
