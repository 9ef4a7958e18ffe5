"""The incident waves' potential of second order at the difference of two frequencies, and the force it makes (kernel).

Two waves that travel one way, with k and K = omega^2/g, bind a long wave to their groups: kappa = k_m - k_n, Delta = omega_m -
omega_n,

    phi_2 = sum over m, n of a_m a_n* C_mn cosh kappa(z + h)/cosh kappa h exp(i Delta t - i kappa s),
    C_mn = Q_mn/(g kappa tanh kappa h - Delta^2),
    Q_mn = -i Delta g^2 (k_m k_n + K_m K_n)/(2 omega_m omega_n) + (i g^2/4) [(k_n^2 - K_n^2)/omega_n - (k_m^2 - K_m^2)/omega_m],

from phi_tt + g phi_z = -d/dt |grad phi|^2 + (1/g) phi_t d/dz (phi_tt + g phi_z) on z = 0 by the rule of pairs. In deep water
C_mn is -i max(omega_m, omega_n)/2 times the sign of Delta.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_LEAST = 6  # wavenumbers at which the force is evaluated, at least


def bound_wave(omega: Array, k: Array, *, depth: float, g: float) -> Complex:
    """Return the amplitude C (n, n) of the potential at z = 0, m2/s per square metre; 0 for equal frequencies.

    Parameters
    ----------
    omega, k : (n,) array
        rad/s, rad/m.
    depth, g : float

    Examples
    --------
    >>> w = np.array([0.5, 0.7])
    >>> bound_wave(w, w**2 / 9.81, depth=np.inf, g=9.81).imag.round(6).tolist()
    [[0.0, 0.35], [-0.35, 0.0]]
    """
    K = omega**2 / g
    difference = omega[:, None] - omega[None]
    kappa = np.abs(k[:, None] - k[None])
    excess = (k**2 - K**2) / omega
    product = (k[:, None] * k[None] + K[:, None] * K[None]) / (omega[:, None] * omega[None])
    Q = 1j * g**2 * (-0.5 * difference * product + 0.25 * (excess[None] - excess[:, None]))
    below = g * kappa * (1.0 if np.isinf(depth) else np.tanh(kappa * depth)) - difference**2
    same = difference == 0.0
    return np.asarray(np.where(same, 0.0, Q / np.where(same, 1.0, below)))


def wavenumbers(k: Array, *, length: float, depth: float, least: float) -> Array:
    """Return the wavenumbers at which the force of long waves is needed, denser towards zero, the largest difference last.

    Parameters
    ----------
    k : (n,) array
        rad/m.
    length : float
        Of the hull, m: its force turns its phase with k.
    depth : float
        m.
    least : float
        Smallest k h that can be solved.
    """
    largest = float(np.ptp(k))
    n = max(_LEAST, int(np.ceil(largest * length)) + 4)
    found = largest * (np.arange(1, n + 1) / n) ** 1.5
    return np.asarray(found if np.isinf(depth) else found[found * depth >= least])


def bound_force(omega: Array, k: Array, *, nodes: Array, excitation: Complex, depth: float, g: float) -> Complex:
    """Return the force (n, n, 6) of the bound waves, N/m2 and N m/m2.

    Parameters
    ----------
    omega, k : (n,) array
        rad/s, rad/m.
    nodes : (n_k,) array
        Wavenumbers from zero on, rad/m.
    excitation : (n_k, 6) complex array
        First-order wave force per metre of amplitude at these; its pressure is rho g times the wave's profile.
    depth, g : float

    Notes
    -----
    The pressure -rho phi_2t is -i Delta C/g times that of a wave of unit amplitude and wavenumber kappa, and so is its force:
    F = -i Delta C X(kappa)/g for k_m > k_n, the conjugate for k_m < k_n (Pinkster 1980). X includes the diffraction of a free
    wave of that length, whose frequency is (g kappa tanh kappa h)^(1/2) instead of Delta.
    """
    C = bound_wave(omega, k, depth=depth, g=g)
    kappa = k[:, None] - k[None]
    X = CubicSpline(nodes, excitation)(np.abs(kappa))
    X = np.where((kappa < 0.0)[..., None], X.conj(), X)
    difference = omega[:, None] - omega[None]
    return np.asarray((-1j * difference * C / g)[..., None] * X)
