"""What a model of the fluid memory changes in the motion of the vessel: the figure that decides whether it is good enough."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.passive_target import floating_compliance

Array = NDArray[Any]


def motion_change(omega: Array, A: Array, B: Array, A_fit: Array, B_fit: Array, mass: Array, stiffness: Array) -> Array:
    """Return the relative change (m,) of the motion of each degree of freedom under unit forces.

    Parameters
    ----------
    omega : (n_w,) array
    A, B : (n_w, m, m) array
        Added mass and damping of the data.
    A_fit, B_fit : (n_w, m, m) array
        Those of the model.
    mass, stiffness : (m, m) array
        Rigid-body inertia and restoring about O.

    Notes
    -----
    With X the compliance of the floating body (and a loss of 1 % of inertia and stiffness, so that a resonance on a frequency
    of the data does not decide alone) for the data and X_fit for the model, and forces per root of the inertia of their degree
    of freedom: root mean square over the frequencies of |X_fit - X| over |X|, both summed over the forces.

    Examples
    --------
    >>> w, one = np.linspace(0.1, 2.0, 20), np.ones((20, 1, 1))
    >>> change = motion_change(w, one, 0.2 * one, 1.001 * one, 0.2 * one, np.eye(1), np.eye(1))
    >>> bool(0.0 < change[0] < 0.01)
    True
    """
    scale = np.sqrt(np.diag(mass))
    square = np.outer(scale, scale)
    C = stiffness / square
    X, X_fit = (floating_compliance(omega, (mass + a) / square, b / square, C) for a, b in ((A, B), (A_fit, B_fit)))
    relative = (np.abs(X_fit - X) ** 2).sum(axis=2) / (np.abs(X) ** 2).sum(axis=2)  # (n_w, m)
    weight = np.gradient(omega) / (omega[-1] - omega[0])
    return np.sqrt(weight @ relative)
