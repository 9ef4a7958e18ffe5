"""Oscillators that share dampers: the reciprocal, passive form of fluid memory (kernels).

    w'' + R w' + W^2 w = b nu,   mu = b^T w',   R = D D^T + 2 z W      K_hat(s) = s b^T (s^2 + s R + W^2)^-1 b

with n oscillators, W = diag(w_k), b (n, m), D (n, r) and a small damping z of each oscillator's own. Whatever the numbers,
K_hat is symmetric, K_hat(0) = 0, and Re K_hat(i omega) = omega^2 b^H (...)^-H R (...)^-1 b >= 0: damping is the power that the
dampers take away. A (n_p,) vector of parameters holds [x = log w (n) | b (n m) | D (n r)], row by row.
"""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[Any]

#: z: no mode of the model is damped less than about this share of critical, so that none can hide between two frequencies.
OWN_DAMPING = 0.001


@njit(cache=True, nogil=True)
def _solve_in_place(A: Array, B: Array) -> None:  # pragma: no cover - compiled
    """Gaussian elimination with partial pivoting, A (n, n), B (n, m) complex; the solution replaces B."""
    n, m = B.shape
    for k in range(n):
        p = k
        for i in range(k + 1, n):
            if abs(A[i, k]) > abs(A[p, k]):
                p = i
        if p != k:
            for j in range(n):
                A[k, j], A[p, j] = A[p, j], A[k, j]
            for j in range(m):
                B[k, j], B[p, j] = B[p, j], B[k, j]
        pivot = 1.0 / A[k, k]
        for i in range(k + 1, n):
            f = A[i, k] * pivot
            for j in range(k + 1, n):
                A[i, j] -= f * A[k, j]
            for j in range(m):
                B[i, j] -= f * B[k, j]
    for k in range(n - 1, -1, -1):
        for j in range(m):
            total = B[k, j]
            for i in range(k + 1, n):
                total -= A[k, i] * B[i, j]
            B[k, j] = total / A[k, k]


@njit(cache=True, nogil=True)
def response(p: Array, n: int, m: int, r: int, omega: Array) -> tuple[Array, Array]:  # pragma: no cover - compiled
    """Return K_hat(i omega) (n_w, m, m) and Y = (...)^-1 b (n_w, n, m), both complex."""
    b, D = p[n : n + n * m].reshape(n, m), p[n + n * m :].reshape(n, r)
    W2 = np.exp(2 * p[:n])
    DD = D @ D.T
    H = np.zeros((len(omega), m, m), dtype=np.complex128)
    Y = np.empty((len(omega), n, m), dtype=np.complex128)
    delta = np.empty((n, n), dtype=np.complex128)
    for f in range(len(omega)):
        w = omega[f]
        for i in range(n):
            for j in range(n):
                delta[i, j] = 1j * w * DD[i, j]
            delta[i, i] += W2[i] - w * w + 2j * w * OWN_DAMPING * np.sqrt(W2[i])
            for j in range(m):
                Y[f, i, j] = b[i, j]
        _solve_in_place(delta, Y[f])
        for i in range(m):
            for j in range(m):
                for k in range(n):
                    H[f, i, j] += 1j * w * b[k, i] * Y[f, k, j]
    return H, Y


@njit(cache=True, nogil=True)
def derivatives(p: Array, n: int, m: int, r: int, omega: Array, Y: Array) -> Array:  # pragma: no cover - compiled
    """Return d K_hat / d p, shape (n_w, m, m, n_p), complex."""
    D = p[n + n * m :].reshape(n, r)
    W2 = np.exp(2 * p[:n])
    J = np.zeros((len(omega), m, m, len(p)), dtype=np.complex128)
    Z = np.empty((r, m), dtype=np.complex128)
    for f in range(len(omega)):
        s = 1j * omega[f]
        for q in range(r):
            for j in range(m):
                total = 0j
                for k in range(n):
                    total += D[k, q] * Y[f, k, j]
                Z[q, j] = total
        for k in range(n):
            for i in range(m):
                J[f, i, :, n + k * m + i] += s * Y[f, k]
                J[f, :, i, n + k * m + i] += s * Y[f, k]
                for j in range(m):
                    J[f, i, j, k] = -2.0 * s * (W2[k] + s * OWN_DAMPING * np.sqrt(W2[k])) * Y[f, k, i] * Y[f, k, j]
                    for q in range(r):
                        J[f, i, j, n + n * m + k * r + q] = -s * s * (Y[f, k, i] * Z[q, j] + Z[q, i] * Y[f, k, j])
    return J


def state_space(p: Array, n: int, m: int, r: int) -> tuple[Array, Array, Array]:
    """Return (A, B, C) with states (w', W w): A = [[-R, -W], [W, 0]], B = (b, 0), C = B^T.

    A + A^T = -2 diag(R, 0) <= 0 and C = B^T: passive by inspection, the stored energy is |x|^2 / 2.
    """
    W = np.diag(np.exp(p[:n]))
    b, D = p[n : n + n * m].reshape(n, m), p[n + n * m :].reshape(n, r)
    A = np.block([[-D @ D.T - 2 * OWN_DAMPING * W, -W], [W, np.zeros((n, n))]])
    B = np.vstack([b, np.zeros((n, m))])
    return A, B, B.T
