"""Compiled: integrals of the transient Green function for large beta, a wave and an algebraic part (kernel: numbers only).

F obeys A. H. Clement's equation (Journal of Engineering Mathematics 33 (1998) 201-217)

    F'''' + mu beta F''' + (beta^2/4 + 4 mu) F'' + 7/4 beta F' + 9/4 F = 0.

Its solutions for large beta are exp(a beta^2/2) sum c_k beta^(1-2k) with a^2 + mu a + 1/4 = 0, the wave, and a series in odd
powers of 1/beta.
"""

import numpy as np
from numba import njit

WAVE_TERMS, ALGEBRAIC_TERMS = 28, 36
_NEGLIGIBLE = 40.0  # exponent of the wave from which on it is left out
_AXIS = 0.999  # mu from which on the wave is below exp(-35)


@njit(cache=True, nogil=True)
def wave_coefficients(mu, c):
    """Fill c (WAVE_TERMS,) complex: F_wave = 2 Re sum c_k beta^(1-2k) exp(a beta^2/2), a = -(mu + i s)/2.

    Notes
    -----
    c_0 = (8 s)^(-1/2) exp(3i theta/2 - i pi/4), cos theta = mu, by the method of steepest descent; the others by inserting the
    form into Clement's equation, which leaves a recurrence of four terms,

        2k a (1/4 - a^2) c_k + B(3-2k) c_{k-1} + C(5-2k) c_{k-2} + E(7-2k) c_{k-3} = 0,
        B(q) = a^2 (6q^2 + 6q + 3) + mu a (3q^2 + 8q + 4) + q(q-1)/4 + 7q/4 + 9/4,
        C(q) = q (q-1) [a (4q - 2) + mu (q + 2)],   E(q) = q (q-1) (q-2) (q-3).
    """
    c[:] = 0.0
    if mu > _AXIS:
        return
    s = np.sqrt((1.0 - mu) * (1.0 + mu))
    theta = np.arctan2(s, mu)
    a = -0.5 * complex(mu, s)
    phase = 1.5 * theta - 0.25 * np.pi
    c[0] = complex(np.cos(phase), np.sin(phase)) / np.sqrt(8.0 * s)
    first = 2.0 * a * (0.25 - a * a)
    for k in range(1, len(c)):
        q = 3.0 - 2.0 * k
        B = a * a * (6.0 * q * q + 6.0 * q + 3.0) + mu * a * (3.0 * q * q + 8.0 * q + 4.0) + 0.25 * q * (q + 6.0) + 2.25
        right = B * c[k - 1]
        if k > 1:
            q = 5.0 - 2.0 * k
            right += q * (q - 1.0) * (a * (4.0 * q - 2.0) + mu * (q + 2.0)) * c[k - 2]
        if k > 2:
            q = 7.0 - 2.0 * k
            right += q * (q - 1.0) * (q - 2.0) * (q - 3.0) * c[k - 3]
        c[k] = -right / (k * first)


@njit(cache=True, nogil=True)
def algebraic_coefficients(mu, d):
    """Fill d (ALGEBRAIC_TERMS, 2): F_alg = sum d[m, 0] beta^(-2m-3), (H/s)_alg = sum d[m, 1] beta^(-2m-3).

    Notes
    -----
    From the powers of k of k^(1/2) exp(-mu k) J_0(k s), integrated one by one (Abel):
    d[m, 0] = -2 (2m+2)!/m! P_m(mu), d[m, 1] = -2 (2m+2)!/m! P'_{m-1}(mu).
    """
    factor = -4.0
    P, before = 1.0, 0.0  # P_m, P_{m-1}
    dP, d_before = 0.0, 0.0  # P'_{m-1}, P'_{m-2}
    for m in range(len(d)):
        d[m, 0], d[m, 1] = factor * P, factor * dP
        factor *= 2.0 * (2.0 * m + 3.0) * (m + 2.0) / (m + 1.0)
        after = ((2.0 * m + 1.0) * mu * P - m * before) / (m + 1.0)
        dP, d_before = (2.0 * m - 1.0) * before + d_before if m > 0 else 0.0, dP
        before, P = P, after


@njit(cache=True, nogil=True)
def far_field(mu, beta, c, d):
    """Return F, -F'' and H/s for beta >= 12 from the coefficients; each series ends at its smallest term."""
    x = 1.0 / (beta * beta)
    power, size = x / beta, 1.0
    F, F2, H = 0.0, 0.0, 0.0
    for m in range(len(d)):
        F += d[m, 0] * power
        F2 -= (2.0 * m + 3.0) * (2.0 * m + 4.0) * d[m, 0] * power * x
        H += d[m, 1] * power
        ratio = 2.0 * (2.0 * m + 3.0) * (m + 2.0) / (m + 1.0) * x
        size *= ratio  # of the next term less its Legendre function, over the first
        if ratio > 1.0 or size * (m + 1.0) * (m + 2.0) < 1e-17:
            break
        power *= x
    exponent = 0.25 * mu * beta * beta
    if exponent > _NEGLIGIBLE or mu > _AXIS:
        return F, F2, H
    s2 = (1.0 - mu) * (1.0 + mu)
    s = np.sqrt(s2)
    a = -0.5 * complex(mu, s)
    u, u1, u2 = 0.0j, 0.0j, 0.0j  # sums for F, F', F'' less the exponential
    power, last = beta, np.inf
    for k in range(len(c)):
        q = 1.0 - 2.0 * k
        term = c[k] * power
        size = abs(term.real) + abs(term.imag)
        if size > last:
            break
        last = size
        u += term
        u1 += term * (a * beta + q / beta)
        u2 += term * (a * a * beta * beta + a * (2.0 * q + 1.0) + q * (q - 1.0) * x)
        if size < 1e-17 * beta:
            break
        power *= x
    angle = 0.25 * s * beta * beta
    wave = 2.0 * np.exp(-exponent) * complex(np.cos(angle), -np.sin(angle))
    f, f1, f2 = (wave * u).real, (wave * u1).real, (wave * u2).real
    return F + f, F2 - f2, H + (1.5 * f + 0.5 * beta * f1 + mu * f2) / s2
