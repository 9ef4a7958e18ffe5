"""Compiled: the integrals of the transient Green function at any (mu, beta) (kernel: numbers and arrays only).

    F    = int_0^inf k^(1/2) sin(beta k^(1/2)) exp(-mu k) J_0(k s) dk,                s = (1 - mu^2)^(1/2),
    -F'' = int_0^inf k^(3/2) sin(beta k^(1/2)) exp(-mu k) J_0(k s) dk,
    H    = int_0^inf k^(3/2) sin(beta k^(1/2)) exp(-mu k) J_1(k s) dk = (3/2 F + beta/2 F' + mu F'')/s.

H/s is regular on the axis s = 0; F, -F'' and H/s are what value and gradient need.
"""

import numpy as np
from numba import njit, prange

from ogilvie.bem.transient_green_far import (
    ALGEBRAIC_TERMS,
    WAVE_TERMS,
    algebraic_coefficients,
    far_field,
    wave_coefficients,
)
from ogilvie.bem.transient_green_table import BETA_FAR, BETA_PATCHES, MU_PATCHES, POINTS

_PATCH = BETA_FAR / BETA_PATCHES


@njit(cache=True, nogil=True, fastmath={"contract", "reassoc", "nsz"})
def _along_mu(mu, patch, table, row):
    """Fill row (3, POINTS): the polynomials of beta on one patch, at this mu."""
    a = min(int(mu * MU_PATCHES), MU_PATCHES - 1)
    x = 2.0 * (mu * MU_PATCHES - a) - 1.0
    row[:] = 0.0
    before, now = x, 1.0  # T_1 = T_{-1}
    for i in range(POINTS):
        for f in range(3):
            for j in range(POINTS):
                row[f, j] += now * table[a, patch, i, f, j]
        before, now = now, 2.0 * x * now - before


@njit(cache=True, nogil=True, fastmath={"contract", "nsz"})
def _along_beta(beta, patch, row):
    """Return the three integrals from the polynomials of a patch (Clenshaw)."""
    x = 2.0 * (2.0 * (beta / _PATCH - patch) - 1.0)
    f1, f2, g1, g2, h1, h2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for j in range(POINTS - 1, 0, -1):
        f1, f2 = row[0, j] + x * f1 - f2, f1
        g1, g2 = row[1, j] + x * g1 - g2, g1
        h1, h2 = row[2, j] + x * h1 - h2, h1
    x *= 0.5
    return row[0, 0] + x * f1 - f2, row[1, 0] + x * g1 - g2, row[2, 0] + x * h1 - h2


@njit(cache=True, nogil=True, parallel=True)
def fill_scattered(mu, beta, table, out):
    """Fill out (n, 3) with F, -F'', H/s at points (n,)."""
    chunks = min(len(mu), 64)
    for chunk in prange(chunks):
        row, c, d = np.empty((3, POINTS)), np.empty(WAVE_TERMS, np.complex128), np.empty((ALGEBRAIC_TERMS, 2))
        for i in range(chunk * len(mu) // chunks, (chunk + 1) * len(mu) // chunks):
            if beta[i] < BETA_FAR:
                patch = min(int(beta[i] / _PATCH), BETA_PATCHES - 1)
                _along_mu(mu[i], patch, table, row)
                out[i] = _along_beta(beta[i], patch, row)
            else:
                wave_coefficients(mu[i], c)
                algebraic_coefficients(mu[i], d)
                out[i] = far_field(mu[i], beta[i], c, d)


@njit(cache=True, nogil=True, parallel=True)
def fill_history(field, source, normal, weight, g, step, first, table, G, Gn):
    """Add to G and to Gn, the derivative along the source's normal, (n_field, n_t, n_source) at times (first + m) step, m >= 0.

    Both are multiplied by `weight` (n_source,). All times of a pair share mu, so that what depends on mu is done once.
    """
    n_t, n_source = G.shape[1], len(source)
    for i in prange(len(field)):
        rows, known = np.empty((BETA_PATCHES, 3, POINTS)), np.empty(BETA_PATCHES, np.bool_)
        c, d = np.empty(WAVE_TERMS, np.complex128), np.empty((ALGEBRAIC_TERMS, 2))
        for j in range(n_source):
            dx, dy, Z = field[i, 0] - source[j, 0], field[i, 1] - source[j, 1], field[i, 2] + source[j, 2]
            r = np.sqrt(dx * dx + dy * dy + Z * Z)
            mu = min(-Z / r, 1.0)
            rate, known[:], far = np.sqrt(g / r), False, False
            value = 2.0 * np.sqrt(g / r) / r * weight[j]
            slope = value / r
            across = -(dx * normal[j, 0] + dy * normal[j, 1]) / r
            for m in range(n_t):
                beta = rate * step * (first + m)
                if beta < BETA_FAR:
                    patch = min(int(beta / _PATCH), BETA_PATCHES - 1)
                    if not known[patch]:
                        _along_mu(mu, patch, table, rows[patch])
                        known[patch] = True
                    F, F2, H = _along_beta(beta, patch, rows[patch])
                else:
                    if not far:
                        wave_coefficients(mu, c)
                        algebraic_coefficients(mu, d)
                        far = True
                    F, F2, H = far_field(mu, beta, c, d)
                G[i, m, j] += value * F
                Gn[i, m, j] += slope * (normal[j, 2] * F2 - across * H)
