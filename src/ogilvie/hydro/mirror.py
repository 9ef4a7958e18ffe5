"""Port-starboard symmetry of a data set, and headings mirrored to the full circle."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Sign of each degree of freedom in the mirror y -> -y.
MIRROR = {"surge": 1.0, "sway": -1.0, "heave": 1.0, "roll": -1.0, "pitch": 1.0, "yaw": -1.0}
_NEGLIGIBLE = 1e-3
_SAME = 1e-6  # rad
TURN = 2.0 * np.pi


def mirror_signs(dofs: Sequence[str]) -> Array | None:
    """Return the sign of each degree of freedom in the mirror, None if there are others than the six.

    Examples
    --------
    >>> mirror_signs(["surge", "sway", "yaw"])
    array([ 1., -1., -1.])
    """
    if not all(dof in MIRROR for dof in dofs):
        return None
    return np.array([MIRROR[dof] for dof in dofs])


def is_symmetric(hydro: xr.Dataset) -> bool:
    """Tell whether the data are those of a port-starboard symmetric body.

    Notes
    -----
    Surge, heave, pitch do not couple with sway, roll, yaw; head and following seas exert no force on the latter, and forces of
    opposite headings b and -b are mirror images; each within 0.1 % of its scale.
    """
    signs = mirror_signs([str(d) for d in hydro.influenced_dof.values])
    if signs is None or not matrices_are_symmetric(hydro):
        return False
    if "excitation_force" not in hydro:
        return True
    return forces_are_symmetric(hydro.wave_direction.values, hydro.excitation_force.values, signs)


def matrices_are_symmetric(hydro: xr.Dataset) -> bool:
    """Tell whether no added mass or damping, where the data hold it, couples surge, heave, pitch with sway, roll, yaw."""
    signs = mirror_signs([str(d) for d in hydro.influenced_dof.values])
    if signs is None:
        return False
    crossed = signs[:, None] != signs
    for key in (k for k in ("added_mass", "radiation_damping") if k in hydro):
        M = np.abs(hydro[key].values).max(axis=0)
        scale = np.sqrt(np.outer(M.diagonal(), M.diagonal()))
        if np.any(M[crossed] > _NEGLIGIBLE * scale[crossed] + np.finfo(float).tiny):
            return False
    return True


def forces_are_symmetric(b: Array, X: NDArray, signs: Array) -> bool:
    """Tell whether forces X (n_w, n_b, n) of headings b and -b are mirror images, those of 0 and pi their own."""
    size = np.abs(X).max(axis=(0, 1))
    one, two = np.nonzero(np.abs(wrapped(b[:, None] + b)) < _SAME)
    return bool(np.all(np.abs(X[:, one] - X[:, two] * signs) <= 2.0 * _NEGLIGIBLE * size))


def full_circle(directions: Array, values: NDArray, signs: Array | None) -> tuple[Array, NDArray]:
    """Return ascending directions in [0, 2 pi) and values (n_w, n_b, n), with their mirror images where `signs` is given.

    Examples
    --------
    >>> b, X = full_circle(np.array([0.0, np.pi / 2, np.pi]), np.ones((1, 3, 1)), np.array([-1.0]))
    >>> np.degrees(b), X[0, :, 0]
    (array([  0.,  90., 180., 270.]), array([ 1.,  1.,  1., -1.]))
    """
    b = np.mod(directions + _SAME, TURN) - _SAME
    if signs is not None:
        b = np.concatenate([b, np.mod(-b + _SAME, TURN) - _SAME])
        values = np.concatenate([values, values * signs], axis=1)
    order = np.argsort(b, kind="stable")
    b, values = b[order], values[:, order]
    keep = np.r_[True, np.diff(b) > 2.0 * _SAME]
    return b[keep], values[:, keep]


def wrapped(angle: Array) -> Array:
    """Return angles in (-pi, pi], rad."""
    return np.pi - np.mod(np.pi - angle, TURN)
