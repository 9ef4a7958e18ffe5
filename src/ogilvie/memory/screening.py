"""Which frequencies of radiation data can be trusted: irregular frequencies leave marks that no causal, passive fluid has."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

_NEGATIVE = 0.005  # of the largest damping: below it a negative eigenvalue is rounding


def clean_frequencies(omega: Array, B: Array) -> Array:
    """Return the mask (n_w,) of the frequencies whose damping matrix is positive semi-definite, cut where most above are not.

    Parameters
    ----------
    omega : (n_w,) array
    B : (n_w, m, m) array
        Radiation damping.

    Returns
    -------
    (n_w,) bool array
        False where the smallest eigenvalue of the symmetric part, each dof scaled by its largest damping, is below -0.5 %,
        and from the first such frequency on above which at least a third are so: between two irregular frequencies the
        damping of the upper range is no better than at them.

    Notes
    -----
    Radiated power nu^H B nu is never negative.

    Examples
    --------
    >>> B = np.ones((5, 1, 1)); B[2] = -1.0
    >>> clean_frequencies(np.arange(1.0, 6.0), B)
    array([ True,  True, False, False, False])
    """
    peak = np.abs(np.einsum("wii->wi", B)).max(axis=0)
    scale = np.sqrt(np.where(peak > 0, peak, 1.0))
    scaled = (B + B.transpose(0, 2, 1)) / 2 / np.outer(scale, scale)
    bad = np.linalg.eigvalsh(scaled)[:, 0] < -_NEGATIVE
    mask = ~bad
    for k in np.flatnonzero(bad):
        if bad[k:].mean() >= 1 / 3:
            mask[k:] = False
            break
    return mask


def describe(omega: Array, mask: Array) -> str:
    """Return one sentence that names the masked frequencies, or an empty string.

    Examples
    --------
    >>> describe(np.array([1.0, 2.0, 3.0, 4.0]), np.array([True, False, True, False]))
    'damping not positive semi-definite at omega 2, 4 rad/s: left out.'
    """
    bad = np.flatnonzero(~mask)
    if len(bad) == 0:
        return ""
    runs = np.split(bad, np.flatnonzero(np.diff(bad) > 1) + 1)
    names = [f"{omega[r[0]]:.4g}" if len(r) == 1 else f"{omega[r[0]]:.4g} to {omega[r[-1]]:.4g}" for r in runs]
    return f"damping not positive semi-definite at omega {', '.join(names)} rad/s: left out."
