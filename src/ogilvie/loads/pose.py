"""Generalised forces of heave, roll and pitch as a force on the body (kernel)."""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.loads.kernel import ETA, ROTATION

Array = NDArray[Any]


@njit(cache=True, nogil=True)
def add_generalised(x: Array, heave: float, roll: float, pitch: float, force: Array) -> None:
    """Add generalised forces of z, phi and theta to the force (6,) about O in body axes.

    Notes
    -----
    tau = J^T Q with J = diag(R, T), the matrix of eta' = J nu: their power is the same, Q . eta' = tau . nu. R^T (0, 0, Q_z) is
    the third row of R times Q_z; T^T (Q_phi, Q_theta, 0) = (Q_phi, s t Q_phi + c Q_theta, c t Q_phi - s Q_theta) with c, s of
    phi and t = tan(theta).
    """
    phi, theta = x[ETA + 3], x[ETA + 4]
    c, s, t = np.cos(phi), np.sin(phi), np.tan(theta)
    for i in range(3):
        force[i] += x[ROTATION + 6 + i] * heave
    force[3] += roll
    force[4] += s * t * roll + c * pitch
    force[5] += c * t * roll - s * pitch
