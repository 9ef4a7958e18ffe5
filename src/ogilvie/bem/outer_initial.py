"""The memory of the outer domain just after an impulse, K(0+), per azimuthal mode."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.outer_functions import depth_functions, depth_taylor, gauss, legendre, legendre_at_surface

Array = NDArray[Any]

_SMALLEST = 2.0**-12  # u = log(R) down to which the series is summed
_LARGEST = 32.0
_LOG_ACCURACY = 36.0
_QUADRATURE = 800  # multipoles up to here by quadrature, beyond by the asymptotic series
_PER_PANEL = 16
_FITTED, _ORDER = 3, 5  # panels that the behaviour below the smallest u is fitted to, powers of u


def initial_memory(m: int, count: int) -> Array:
    """Return K(0+) (J, J), symmetric and positive semi-definite, in the first `count` depth functions.

    Notes
    -----
    An impulse q delta(t) leaves phi = 0 on the surface with psi = -sum_l E_lj P_l / ((l + 1) r^(l+1)), l - m odd, and the
    surface rises with psi_y. By Green's identity the potential on the control surface then starts to change as

        K(0+) = int_1^inf psi_y psi_y R dR = int_0^inf g g^T du,   g_j(u) = sum_l a_lj exp(-(l + 1) u),   R = exp(u),
        a_lj = E_lj P_l'(0) / (l + 1),

    a positive form. The vertical velocity psi_y is logarithmic at the control surface. The integrals E_lj of P_l y_mj are taken
    by Gauss points for low degrees; for high ones integration by parts gives
    E_lj = P_l'(0) sum_k (-1)^k (D^k y_mj)(0) / (l (l + 1))^(k+1), D y = ((1 - x^2) y')' - m^2 y / (1 - x^2).
    Below the smallest u the sum of u^k (A_k log u + B_k), k = 0..4, is fitted to g.

    Examples
    --------
    >>> c = np.array([1 / 2, 1 / 12**0.5])  # cos(theta): heave of the hemisphere
    >>> round(float(3 * c @ initial_memory(0, 2) @ c), 9)  # 3/16
    0.1875
    """
    l, a = _amplitudes(m, count, int(_LOG_ACCURACY / _SMALLEST))
    edges = np.exp2(np.arange(np.log2(_SMALLEST), np.log2(_LARGEST) + 1.0))
    x, w = gauss(_PER_PANEL)
    u = (edges[:-1, None] * (1 + x)).ravel()
    weight = (edges[:-1, None] * w).ravel()
    g = np.array([np.exp(-v * (l[:n] + 1)) @ a[:n] for v in u for n in [1 + int(_LOG_ACCURACY / v / 2)]])
    near = slice(0, _FITTED * _PER_PANEL)
    fit = np.linalg.lstsq(_logarithmic(u[near]), g[near], rcond=None)[0]
    edges = _SMALLEST * np.exp2(-np.arange(50.0))
    u0, w0 = (edges[1:, None] * (1 + x)).ravel(), (edges[1:, None] * w).ravel()
    g0 = _logarithmic(u0) @ fit
    return np.asarray((g.T * weight) @ g + (g0.T * w0) @ g0)


def _logarithmic(u: Array) -> Array:
    """Return u^k log u and u^k for k = 0..4, u in units of the smallest."""
    v = u / _SMALLEST
    return np.column_stack([v**k * f for k in range(_ORDER) for f in (np.log(v), np.ones_like(v))])


def _amplitudes(m: int, count: int, top: int) -> tuple[Array, Array]:
    """Return the degrees l = m + 1, m + 3, ... and a_lj (n, J)."""
    slope = legendre_at_surface(m, top)[1][1::2]
    l = np.arange(m + 1.0, top + 1.0, 2.0)
    x, w = gauss(_QUADRATURE + 100)
    low = (legendre(m, x, m + 2 * _QUADRATURE) * w)[1::2] @ depth_functions(m, x, count).T
    E = slope[:, None] * _by_parts(m, count, l * (l + 1))
    E[: len(low)] = low
    return l, E * (slope / (l + 1))[:, None]


def _by_parts(m: int, count: int, eigenvalue: Array) -> Array:
    """Sum of (-1)^k (D^k y_mj)(0) / eigenvalue^(k+1), k = 0..4, (n, J); D on the Taylor coefficients of y / (1 - x^2)^(m/2)."""
    p = depth_taylor(m, count)  # (J, degree)
    i = np.arange(p.shape[1])
    total = np.zeros((len(eigenvalue), count))
    for k in range(5):
        total += np.outer((-1) ** k / eigenvalue ** (k + 1), p[:, 0])
        up = np.pad(p[:, 2:], ((0, 0), (0, min(2, p.shape[1]))))[:, : p.shape[1]]
        p = (i + 2) * (i + 1) * up - (i + m) * (i + m + 1) * p
    return total
