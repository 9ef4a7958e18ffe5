"""Gains of PID control by pole placement, and the check that the sampling is fast enough for them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError

Array = NDArray[Any]

#: Pole of the integral action as a fraction of the natural frequency.
INTEGRAL_POLE = 0.1


def pid_gains(
    M: Array, D: Array, frequency: Array, damping: Array, *, integral_pole: float = INTEGRAL_POLE
) -> tuple[Array, Array, Array]:
    """Return the gains (Kp, Ki, Kd), each (n, n), that give M v' + D v = tau + constant the wanted poles.

    Parameters
    ----------
    M, D : (n, n) array
        Inertia with added mass, and linear damping.
    frequency, damping : (n,) array
        w (rad/s) and z of each degree of freedom.
    integral_pole : float
        p / w.

    Notes
    -----
    With tau = Kp e + Ki int e dt + Kd e' the error obeys (s + p)(s^2 + 2 z w s + w^2) e = 0 in each degree of freedom for
    Kp = M (w^2 + 2 z w p), Ki = M p w^2, Kd = M (2 z w + p) - D. For p -> 0 these are Kp = M w^2, Kd = 2 z w M - D, and
    Ki = p Kp with p = w / 10 is the rule of the handbook; here the three poles are placed exactly.

    References
    ----------
    Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control (2021): pole placement of nonlinear PID control,
    Algorithm 15.2.

    Examples
    --------
    >>> Kp, Ki, Kd = pid_gains(np.eye(1), np.zeros((1, 1)), np.array([1.0]), np.array([1.0]))
    >>> np.roots([1, Kd[0, 0], Kp[0, 0], Ki[0, 0]]).real.round(3)
    array([-1. , -1. , -0.1])
    """
    w, z = np.asarray(frequency, dtype=float), np.asarray(damping, dtype=float)
    p = integral_pole * w
    return M @ np.diag(w**2 + 2 * z * w * p), M @ np.diag(p * w**2), M @ np.diag(2 * z * w + p) - D


def check_sampling(M: Array, D: Array, gains: tuple[Array, Array, Array], period: float, what: str) -> None:
    """Raise :class:`InputError` where the sampled and held PID loop about M v' + D v = tau is not stable at this period.

    Notes
    -----
    The loop is z' = Phi z + Gamma tau with the exact Phi, Gamma of the plant for a held force; its spectral radius decides.

    Examples
    --------
    >>> I = np.eye(1)
    >>> check_sampling(I, 0 * I, pid_gains(I, 0 * I, np.ones(1), np.ones(1)), 0.1, "heading")
    """
    radius = spectral_radius(M, D, gains, period)
    if radius >= 1.0:
        raise InputError(
            f"{what}: the control loop is not stable at a sampling period of {period:g} s (spectral radius {radius:.3g}, "
            "below 1 expected). Sample faster, lower the natural frequency, or check the gains against inertia and damping."
        )


def spectral_radius(M: Array, D: Array, gains: tuple[Array, Array, Array], period: float) -> float:
    """Return the spectral radius of the sampled PID loop about M v' + D v = tau."""
    from scipy.linalg import expm

    Kp, Ki, Kd = gains
    n, T = len(M), period
    F = np.zeros((3 * n, 3 * n))  # position, velocity, held force
    F[:n, n : 2 * n] = np.eye(n)
    F[n : 2 * n, n : 2 * n] = -np.linalg.solve(M, D)
    F[n : 2 * n, 2 * n :] = np.linalg.inv(M)
    E = expm(F * T)
    Phi, Gamma = E[: 2 * n, : 2 * n], E[: 2 * n, 2 * n :]
    A = np.eye(3 * n)
    A[: 2 * n, : 2 * n] = Phi - Gamma @ np.hstack([Kp, Kd])
    A[: 2 * n, 2 * n :] = Gamma
    A[2 * n :, :n] = -T * Ki
    return float(np.abs(np.linalg.eigvals(A)).max())


def speed_gains(
    m: float, D: float, frequency: float, damping: float, *, period: float, gains: tuple[float, float] | None = None
) -> tuple[float, float]:
    """Return (Kp, Ki) = (2 z w m - D, w^2 m) of PI control of m u' + D u = X, or the given ones, checked at this period.

    Raises
    ------
    InputError
        The sampled and held loop is not stable.

    Examples
    --------
    >>> speed_gains(2.0, 1.0, 1.0, 1.0, period=0.1)
    (3.0, 2.0)
    """
    Kp, Ki = gains if gains is not None else (2.0 * damping * frequency * m - D, frequency**2 * m)
    d = D / m
    phi = float(np.exp(-d * period))
    gamma = float(-np.expm1(-d * period)) / D if D > 0.0 else period / m
    radius = float(np.abs(np.linalg.eigvals(np.array([[phi - gamma * Kp, gamma], [-period * Ki, 1.0]]))).max())
    if radius >= 1.0:
        raise InputError(
            f"SpeedKeeping: the control loop is not stable at a sampling period of {period:g} s (spectral radius {radius:.3g}, "
            "below 1 expected). Sample faster, lower the natural frequency, or check the gains against mass and damping."
        )
    return Kp, Ki
