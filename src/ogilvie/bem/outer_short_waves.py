"""The outer domain in waves too short for multipoles: expansion in 1 / omega^2 with logarithms, fitted where both hold."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.outer_functions import depth_functions
from ogilvie.errors import InputError

Array = NDArray[Any]

_ORDERS = 3
_SHORT = 14.0


def short_waves(m: int, omega: Array, L: Array, initial: Array, at: Array) -> Array:
    """Return L = N - N_inf (n, J, J) at high frequencies `at` from L (f, J, J) at lower ones.

    Parameters
    ----------
    m : int
    omega : (f,) array
        Frequencies at which waves are already short compared with the control radius: above 14, for 16 depth functions
        above 20.
    L : (f, J, J) complex array
        Time factor exp(+i omega t).
    initial : (J, J) array
        K(0+).
    at : (n,) array

    Notes
    -----
    A short wave sees the control surface as a plane wall. With q = exp(-k0 y) the wave i exp(-k0 y - i k0 x) / k0 solves the
    problem of the wall, hence in general 2i exp(-k0 y - i k0 x) int q exp(-k0 y') dy': -Im L = 2 y_j(0) y_k(0) / omega^4 in
    the limit. As L is analytic for Re s > 0 that belongs to a logarithm,

        L = K(0+) / s^2 + [-(4/pi) y_j(0) y_k(0) log s + B_0] / s^4 + sum_n [A_n log s + B_n] / s^(2n+4),   s = i omega,

    with real A_n, B_n found by least squares for n up to 3.
    """
    if np.min(omega, initial=np.inf) < _SHORT or len(omega) < 2 * _ORDERS:
        raise InputError(f"short_waves: at least {2 * _ORDERS} frequencies >= {_SHORT} expected, {omega} found.")
    surface = depth_functions(m, np.zeros(1), len(initial))[:, 0]
    wall = -4 / np.pi * np.outer(surface, surface)

    def known(w: Array) -> Array:
        s = 1j * w[:, None, None]
        return np.asarray(initial / s**2 + wall * np.log(s) / s**4)

    rest = ((L - known(omega)) * (omega**4)[:, None, None]).reshape(len(omega), -1)
    basis = _basis(omega)
    M, rhs = np.concatenate([basis.real, basis.imag]), np.concatenate([rest.real, rest.imag])
    scale = np.linalg.norm(M, axis=0)
    c = np.linalg.lstsq(M / scale, rhs, rcond=None)[0] / scale[:, None]
    return np.asarray(known(at) + (_basis(at) @ c).reshape(len(at), *initial.shape) / (at**4)[:, None, None])


def _basis(omega: Array) -> Array:
    """Return 1 and s^-2n log s, s^-2n, (f, 2 orders + 1)."""
    s = 1j * omega
    columns = [np.ones_like(s)]
    for n in range(1, _ORDERS + 1):
        columns += [s ** (-2 * n) * np.log(s), s ** (-2 * n)]
    return np.stack(columns, axis=1)
