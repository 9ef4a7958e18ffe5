"""Retardation functions at forward speed in the form of Cummins, from those at zero speed."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.speed_terms import speed_matrix
from ogilvie.memory.table import Retardation

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class KernelAtSpeed:
    """Radiation force -A_inf xi'' - B_inf xi' - C_inf xi - int K(s) xi'(t - s) ds about the frame that advances at the speed.

    Parameters
    ----------
    t : (n_t,) array
        s.
    K : (n_t, m, m) array
        Retardation functions at speed; they fall to zero. Not symmetric.
    A_inf, damping, stiffness : (m, m) array
        A_inf; B_inf = U (L^T A_inf - A_inf L); C_inf = -U^2 L^T A(0) L.
    speed : float
        U, m/s.
    """

    t: Array
    K: Array
    A_inf: Array
    damping: Array
    stiffness: Array
    speed: float


def kernel_at_speed(K: Retardation, speed: float) -> KernelAtSpeed:
    """Return the retardation functions at a forward speed, and the damping and restoring that come with them.

    Parameters
    ----------
    K : Retardation
        At zero speed, with a table long enough for its integrals to settle.
    speed : float
        U, m/s.

    Raises
    ------
    InputError
        Speed not finite; pitch without heave or yaw without sway.

    Notes
    -----
    From F = -(d/dt + U L^T) p, p = A_inf nu + int K_1(s) nu(t - s) ds, nu = xi' - U L xi, with K_1 and K_2 the first and second
    integral of K from 0,

        K_U = K + U (L^T K_1 - K_1 L) - U^2 L^T (K_2 - K_2(inf)) L,   K_2(inf) = A(0) - A_inf.

    The time loop does not use this form (it keeps the zero-speed memory and the momentum of the fluid, see
    docs/theory/sailing.md); it is what other programs call K at speed.

    References
    ----------
    Ogilvie (1964); Salvesen, Tuck and Faltinsen (1970); Perez and Fossen (2007), Model. Identif. Control 28, 1.

    Examples
    --------
    >>> t = np.arange(0.0, 40.0, 0.05)
    >>> k = ((1 - t) * np.exp(-t))[:, None, None] * np.diag([1.0, 0.0])
    >>> sailing = kernel_at_speed(Retardation(t, k, np.diag([2.0, 3.0]), dofs=("heave", "pitch")), 0.5)
    >>> sailing.damping.tolist(), round(float(sailing.K[0, 1, 1]), 6)  # B35 = U A33, K_2(inf) = 1
    ([[0.0, 1.0], [-1.0, 0.0]], 0.25)
    """
    L = speed_matrix(K.dofs)
    if L is None:
        raise InputError(
            f"kernel_at_speed: heave with pitch and sway with yaw expected (speed turns one into the other), "
            f"{', '.join(K.dofs)} found."
        )
    if not np.isfinite(speed):
        raise InputError(f"kernel_at_speed: a finite speed in m/s expected, {speed!r} found.")
    first = K.spline.antiderivative()
    K_1, K_2 = first(K.t), first.antiderivative()(K.t)
    U, last = float(speed), K_2[-1]
    K_U = K.K + U * (L.T @ K_1 - K_1 @ L) - U**2 * L.T @ (K_2 - last) @ L
    B = U * (L.T @ K.A_inf - K.A_inf @ L)
    return KernelAtSpeed(K.t, K_U, K.A_inf, B, -(U**2) * L.T @ (K.A_inf + last) @ L, U)
