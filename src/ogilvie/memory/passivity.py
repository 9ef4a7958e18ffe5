"""Is a fluid-memory model passive? Certificates that hold at all frequencies, not only on a grid."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def smallest_damping(K_hat: Array) -> float:
    """Return the smallest eigenvalue of the Hermitian part of K_hat (n_w, m, m), each dof scaled by its largest damping."""
    hermitian = (K_hat + np.conj(K_hat.transpose(0, 2, 1))) / 2
    peak = np.abs(np.einsum("wii->wi", hermitian)).max(axis=0)
    scale = np.sqrt(np.where(peak > 0, peak, 1.0))
    return float(np.linalg.eigvalsh(hermitian / np.outer(scale, scale))[:, 0].min())


def is_passive(A: Array, B: Array, C: Array, *, tolerance: float = 1e-6) -> bool:
    """Return whether Re K_hat(i omega) >= -tolerance at every frequency, in units of the largest damping of each dof.

    Notes
    -----
    K_hat + K_hat^H + 2 e 1 is singular at omega exactly where i omega is an eigenvalue of the Hamiltonian matrix
    [[A - B C/(2e), -B B^T/(2e)], [C^T C/(2e), -A^T + C^T B^T/(2e)]]. No imaginary eigenvalue and a stable A: positive
    definite everywhere (it is at infinity, where K_hat vanishes). Eigenvalues that come out imaginary within rounding are
    settled by the smallest eigenvalue of Re K_hat at and around them.

    References
    ----------
    Boyd, Balakrishnan and Kabamba (1989), Mathematics of Control, Signals and Systems 2.
    """
    if len(A) == 0:
        return True
    if np.linalg.eigvals(A).real.max() >= 0.0:
        return False
    scale = _damping_scale(A, B, C)
    B, C = B / scale, C / scale[:, None]
    e2 = 2.0 * tolerance
    H = np.block([[A - B @ C / e2, -B @ B.T / e2], [C.T @ C / e2, -A.T + C.T @ B.T / e2]])
    lam = np.linalg.eigvals(H)
    suspicious = np.abs(lam.real) <= 1e-6 * np.abs(lam) + 1e-12
    omega = np.unique(np.abs(lam.imag[suspicious]))
    if len(omega) == 0:
        return True
    near = np.unique(np.concatenate([omega, np.sqrt(omega[:-1] * omega[1:]), omega * 0.99, omega * 1.01, [0.0]]))
    K_hat = C @ np.linalg.solve(
        1j * near[:, None, None] * np.eye(len(A)) - A, np.broadcast_to(B.astype(complex), (len(near), *B.shape))
    )
    return bool(np.linalg.eigvalsh((K_hat + np.conj(K_hat.transpose(0, 2, 1))) / 2).min() >= -tolerance)


def _damping_scale(A: Array, B: Array, C: Array) -> Array:
    """Square root of the largest |Re K_hat_ii| near the poles, (m,)."""
    omega = np.unique(np.abs(np.linalg.eigvals(A)))
    K_hat = C @ np.linalg.solve(
        1j * omega[:, None, None] * np.eye(len(A)) - A, np.broadcast_to(B.astype(complex), (len(omega), *B.shape))
    )
    peak = np.abs(np.einsum("wii->wi", K_hat).real).max(axis=0)
    return np.sqrt(np.where(peak > 0, peak, 1.0))
