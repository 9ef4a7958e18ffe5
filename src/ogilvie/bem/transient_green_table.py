"""Integrals of the transient Green function for beta < 12: polynomials on patches of the (mu, beta) plane.

The three integrals (see `transient_green_kernel`) are power series in beta with Legendre functions of mu. Their terms reach
exp(beta^2/4), so they are summed once with 32 digits at Chebyshev points, and interpolated by products of Chebyshev
polynomials from then on.
"""

from functools import cache
from typing import Any

import numpy as np
from numba import njit, prange
from numpy.typing import NDArray

from ogilvie.bem.double_double import dd_add, dd_divide, dd_multiply

Array = NDArray[Any]

#: From here on the asymptotic expansion is used.
BETA_FAR = 12.0
#: Patches across mu = 0..1 and beta = 0..BETA_FAR, and Chebyshev points of each in either direction.
MU_PATCHES, BETA_PATCHES, POINTS = 8, 18, 16
_TERMS = 190


@cache
def chebyshev_table() -> Array:
    """Return coefficients (MU_PATCHES, BETA_PATCHES, POINTS of mu, 3 functions, POINTS of beta), read-only.

    Notes
    -----
    Made on first use (about half a second) and kept: 0.9 MB.

    Examples
    --------
    >>> chebyshev_table().shape
    (8, 18, 16, 3, 16)
    """
    n = POINTS
    node = np.cos(np.pi * (np.arange(n) + 0.5) / n)
    mu = ((np.arange(MU_PATCHES)[:, None] + 0.5 * (1.0 + node)) / MU_PATCHES).ravel()
    beta = ((np.arange(BETA_PATCHES)[:, None] + 0.5 * (1.0 + node)) * BETA_FAR / BETA_PATCHES).ravel()
    values = series(mu, beta).reshape(3, MU_PATCHES, n, BETA_PATCHES, n)
    T = np.cos(np.outer(np.arange(n), np.pi * (np.arange(n) + 0.5) / n)) * (2.0 / n)
    T[0] *= 0.5
    table = np.ascontiguousarray(np.einsum("im,fambn,jn->abifj", T, values, T, optimize=True))
    table.setflags(write=False)
    return table


def series(mu: Array, beta: Array) -> Array:
    """Return F, -F'' and H/s (3, n_mu, n_beta) by power series with 32 digits, for 0 <= mu <= 1, 0 <= beta <= 13.

    Notes
    -----
    With b_n = (-1)^n beta^(2n+1) (n+1)!/(2n+1)! and int k^m exp(-mu k) J_0(k s) dk = m! P_m(mu),
    int k^m exp(-mu k) J_1(k s) dk = (m-1)! s P_m'(mu), s = (1 - mu^2)^(1/2):

        F = sum b_n P_{n+1},   -F'' = sum b_n (n+2) P_{n+2},   H/s = sum b_n P'_{n+2}.

    Examples
    --------
    >>> F, F2, H = series(np.array([1.0]), np.array([1e-3]))
    >>> bool(np.allclose([F[0, 0], F2[0, 0], H[0, 0]], [1e-3, 2e-3, 3e-3]))
    True
    """
    out = np.empty((3, len(mu), len(beta)))
    _series(np.ascontiguousarray(mu, dtype=float), np.ascontiguousarray(beta, dtype=float), out)
    return out


@njit(cache=True, nogil=True, parallel=True)
def _series(mu, beta, out):
    powers = np.empty((len(beta), _TERMS, 2))
    for j in range(len(beta)):
        _coefficients(beta[j], powers[j])
    for i in prange(len(mu)):
        P, dP = np.empty((_TERMS + 2, 2)), np.empty((_TERMS + 2, 2))
        _legendre(mu[i], P, dP)
        for j in range(len(beta)):
            fh, fl, gh, gl, hh, hl = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            for n in range(_TERMS):
                bh, bl = powers[j, n]
                xh, xl = dd_multiply(bh, bl, P[n + 1, 0], P[n + 1, 1])
                fh, fl = dd_add(fh, fl, xh, xl)
                xh, xl = dd_multiply(bh, bl, dP[n + 2, 0], dP[n + 2, 1])
                hh, hl = dd_add(hh, hl, xh, xl)
                bh, bl = dd_multiply(bh, bl, n + 2.0, 0.0)
                xh, xl = dd_multiply(bh, bl, P[n + 2, 0], P[n + 2, 1])
                gh, gl = dd_add(gh, gl, xh, xl)
                if n > 0.3 * beta[j] ** 2 and abs(bh) * (n + 3.0) ** 2 < 1e-22:
                    break
            out[0, i, j], out[1, i, j], out[2, i, j] = fh + fl, gh + gl, hh + hl


@njit(cache=True, nogil=True)
def _coefficients(beta, b):
    """Fill b (n, 2) with (-1)^n beta^(2n+1) (n+1)!/(2n+1)!."""
    xh, xl = dd_multiply(beta, 0.0, beta, 0.0)
    h, l = beta, 0.0
    for n in range(len(b)):
        b[n, 0], b[n, 1] = h, l
        h, l = dd_multiply(h, l, xh, xl)
        h, l = dd_multiply(h, l, -(n + 2.0), 0.0)
        h, l = dd_divide(h, l, (2.0 * n + 2.0) * (2.0 * n + 3.0))


@njit(cache=True, nogil=True)
def _legendre(mu, P, dP):
    """Fill the Legendre polynomials of mu and their derivatives (n, 2): n P_n = (2n-1) mu P_{n-1} - (n-1) P_{n-2}."""
    P[0, 0], P[0, 1], P[1, 0], P[1, 1] = 1.0, 0.0, mu, 0.0
    dP[0, 0], dP[0, 1], dP[1, 0], dP[1, 1] = 0.0, 0.0, 1.0, 0.0
    for n in range(2, len(P)):
        h, l = dd_multiply(P[n - 1, 0], P[n - 1, 1], mu, 0.0)
        h, l = dd_multiply(h, l, 2.0 * n - 1.0, 0.0)
        ch, cl = dd_multiply(P[n - 2, 0], P[n - 2, 1], -(n - 1.0), 0.0)
        h, l = dd_add(h, l, ch, cl)
        P[n, 0], P[n, 1] = dd_divide(h, l, float(n))
        h, l = dd_multiply(P[n - 1, 0], P[n - 1, 1], 2.0 * n - 1.0, 0.0)
        dP[n, 0], dP[n, 1] = dd_add(h, l, dP[n - 2, 0], dP[n - 2, 1])
