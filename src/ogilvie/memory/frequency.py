"""Frequency-domain identification (FDI): rational functions of s with a common denominator for a block.

    K_hat_ij(s) = s P_ij(s) / Q(s),   degree P <= n - 2, degree Q = n

so that K_hat(0) = 0 and the relative degree is one, as the physics demand. Sanathanan-Koerner iterations, linear least squares
with the denominator of the iteration before as weight, give a start; Gauss-Newton on the poles, the numerators eliminated,
gives the least-squares solution in A and B.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.common_poles import LEAST_DAMPING, compressed, fit_common_poles, stable
from ogilvie.memory.targets import Spectrum, Trial

Array = NDArray[Any]

_SANATHANAN_KOERNER = 12  # iterations
_GAUSS_NEWTON = 15
_RANGE = 10.0  # poles stay between omega_1 / 10 and 10 omega_N


def identify_by_frequency(target: Spectrum, *, r2: float, order: int | None, limit: int) -> tuple[Trial, Array]:
    """Return the model of a block with a common denominator by least squares in the frequency domain.

    References
    ----------
    Perez and Fossen (2009), A Matlab toolbox for parametric identification of radiation-force models, Modeling, Identification
    and Control 30(1); Perez and Fossen (2011); Golub and Pereyra (1973) for the elimination of the numerators.
    """
    return fit_common_poles(target, frequency_poles, r2=r2, order=order, limit=limit)


def frequency_poles(target: Spectrum, n: int) -> Array:
    """Return n stable poles shared by all couplings of the target, 1/s.

    Examples
    --------
    >>> w = np.linspace(0.1, 4.0, 40)
    >>> K_hat = 1j * w / ((1j * w) ** 2 + 0.6j * w + 1.09)  # poles -0.3 +- i
    >>> A, B = (K_hat.imag / w)[:, None, None], K_hat.real[:, None, None]
    >>> frequency_poles(Spectrum(w, A, B, np.zeros((1, 1)), True, np.ones(1)), 2).round(6)
    array([-0.3+1.j, -0.3-1.j])
    """
    s = 1j * target.omega / target.omega[-1]
    return _gauss_newton(target, s, _sanathanan_koerner(target, s, n)) * target.omega[-1]


def _sanathanan_koerner(target: Spectrum, s: Array, n: int) -> Array:
    phi, beta = _orthonormal(s, n)
    numerator = s[:, None] * phi[:, : n - 1] if target.A_inf_given else s[:, None] * phi
    K_hat = target.data(target.couplings, target.A_inf)[:, :, None]
    M = np.concatenate([np.broadcast_to(numerator, (len(K_hat), *numerator.shape)), -K_hat * phi], axis=2)
    k, weight, poles = numerator.shape[1], np.ones(len(s), dtype=complex), np.zeros(n)
    for _ in range(_SANATHANAN_KOERNER):
        R = compressed(target.rows(M / weight[:, None], target.couplings), k)
        q = np.linalg.lstsq(R[:, :n], -R[:, n], rcond=None)[0]
        before, poles = poles, stable(_roots(q, beta))
        if np.abs(np.sort(np.abs(poles)) - np.sort(np.abs(before))).max() < 1e-6:
            break
        weight = np.prod(s[:, None] - poles, axis=1)
        weight /= np.abs(weight).max()
    return poles


def _orthonormal(s: Array, n: int) -> tuple[Array, Array]:
    """Polynomials phi_0 .. phi_n (n_w, n + 1) orthonormal over the points s = i omega and their conjugates; their recurrence.

    beta_k+1 phi_k+1 = s phi_k + beta_k phi_k-1; powers of s would be useless above order ten.
    """
    phi, beta = np.full((len(s), n + 1), 1 / np.sqrt(len(s)), dtype=complex), np.zeros(n + 1)
    for k in range(n):
        following = s * phi[:, k] + (beta[k] * phi[:, k - 1] if k else 0.0)
        beta[k + 1] = np.linalg.norm(following)
        phi[:, k + 1] = following / beta[k + 1]
    return phi, beta


def _roots(q: Array, beta: Array) -> Array:
    """Zeros of phi_n + sum q_k phi_k: eigenvalues of the matrix of the recurrence."""
    n = len(q)
    M = np.diag(beta[1:n], 1) - np.diag(beta[1:n], -1)
    M[-1] -= beta[n] * q
    return np.linalg.eigvals(M)


def _gauss_newton(target: Spectrum, s: Array, poles: Array) -> Array:
    """Poles that minimise the squared error of A and B; damped steps."""
    low, high = _bounds(s, len(poles))
    x = np.clip(_factors(poles), low, high)
    y = target.rows(target.data(target.couplings, target.A_inf), target.couplings)
    cost, r, J = _projected(target, s, x, y)
    damping = 1e-3
    for _ in range(_GAUSS_NEWTON):
        H = J.T @ J
        scale = np.diag(np.diag(H) + 1e-9 * np.trace(H) + 1e-300)
        for _ in range(6):
            step = np.linalg.solve(H + damping * scale, -J.T @ r)
            trial = np.clip(x + np.clip(step, -1.0, 1.0), low, high)
            new = _projected(target, s, trial, y)
            if new[0] < cost:
                break
            damping *= 5
        else:
            break
        gain, damping = cost - new[0], max(damping / 5, 1e-9)
        x, (cost, r, J) = trial, new
        if gain < 1e-3 * cost:
            break
    return _poles(x)


def _factors(poles: Array) -> Array:
    """Logarithms of (2 zeta, b) of factors s^2 + 2 zeta sqrt(b) s + b, two poles each, then of c of s + c where one is left."""
    up, real = poles[poles.imag > 0], np.sort(-poles[poles.imag == 0].real)
    odd = len(real) % 2
    one, two = real[odd::2], real[odd + 1 :: 2]
    b = np.concatenate([np.abs(up) ** 2, one * two])
    a = np.concatenate([-2 * up.real, one + two]) / np.sqrt(b)
    return np.log(np.concatenate([np.stack([a, b], axis=1).ravel(), real[:odd]]))


def _bounds(s: Array, n: int) -> tuple[Array, Array]:
    slowest, fastest = np.abs(s[0]) / _RANGE, np.abs(s[-1]) * _RANGE
    low = [2 * LEAST_DAMPING, slowest**2] * (n // 2) + [slowest] * (n % 2)
    high = [2 * _RANGE, fastest**2] * (n // 2) + [fastest] * (n % 2)
    return np.log(low), np.log(high)


def _coefficients(x: Array) -> tuple[Array, Array]:
    """(a, b) of the factors s^2 + a s + b, and what is left of x."""
    pairs, rest = np.exp(x[: len(x) // 2 * 2].reshape(-1, 2)), np.exp(x[len(x) // 2 * 2 :])
    return np.stack([pairs[:, 0] * np.sqrt(pairs[:, 1]), pairs[:, 1]], axis=1), rest


def _poles(x: Array) -> Array:
    (a, b), rest = _coefficients(x)[0].T, _coefficients(x)[1]
    root = np.sqrt(a**2 / 4 - b + 0j)
    return np.concatenate([-a / 2 + root, -a / 2 - root, -rest])


def _projected(target: Spectrum, s: Array, x: Array, y: Array) -> tuple[float, Array, Array]:
    """Squared error, residuals and their derivatives (Kaufman), the numerators being the best ones for these poles."""
    F, slopes = _fractions(x, s)
    n = len(x)
    total = np.array([0.0, 1.0] * (n // 2) + [1.0] * (n % 2))
    strictly_proper = np.linalg.qr(total[:, None], mode="complete")[0][:, 1:]
    M = s[:, None] * (F @ strictly_proper)
    if not target.A_inf_given:
        M = np.hstack([M, s[:, None]])
    Q, R = np.linalg.qr(target.rows(np.broadcast_to(M, (len(y), *M.shape)), target.couplings))
    z = np.swapaxes(Q, 1, 2) @ y[:, :, None]
    r = y - (Q @ z)[:, :, 0]
    u = (np.linalg.pinv(R, rcond=1e-12) @ z)[:, : n - 1, 0] @ strictly_proper.T  # (n_c, n) numerators
    D = target.rows(s[:, None] * np.einsum("cf,wfk->cwk", u, slopes), target.couplings)
    J = Q @ (np.swapaxes(Q, 1, 2) @ D) - D
    return float((r**2).sum()), r.ravel(), J.reshape(-1, n)


def _fractions(x: Array, s: Array) -> tuple[Array, Array]:
    """Partial fractions 1/(s^2 + a s + b), s/(...), 1/(s + c) as columns (n_w, n), and their derivatives to x (n_w, n, n)."""
    F, slopes = np.empty((len(s), len(x)), dtype=complex), np.zeros((len(s), len(x), len(x)), dtype=complex)
    factors, rest = _coefficients(x)
    for k, (a, b) in enumerate(factors):
        g = 1 / (s**2 + a * s + b)
        F[:, 2 * k], F[:, 2 * k + 1] = g, s * g
        for to, change in ((2 * k, a * s), (2 * k + 1, a * s / 2 + b)):
            slopes[:, 2 * k, to], slopes[:, 2 * k + 1, to] = -(g**2) * change, -s * g**2 * change
    if len(rest):
        F[:, -1] = 1 / (s + rest[0])
        slopes[:, -1, -1] = -rest[0] * F[:, -1] ** 2
    return F, slopes
