"""What errors of K_hat weigh: at each frequency a quadratic form of the errors of all couplings, and its root."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.passive_target import Target

Array = NDArray[Any]

MOTION_WEIGHT = 20.0


def data_weight(target: Target, sA: Array, sB: Array) -> Array:
    """Return the weights (n_w, 2, m, m) of Re and Im of an error of K_hat: B and A in units of their spread sB, sA (m, m)."""
    f = target.weight / np.sqrt(len(target.omega))
    imag = f / sA / target.omega[:, None, None]
    return np.stack([np.broadcast_to(f / sB, imag.shape), imag], axis=1)


def motion_matrix(target: Target) -> Array | None:
    """Return what turns an error of K_hat into the weighted relative change of the motion, (n_w, m, m)."""
    if target.compliance is None:
        return None
    omega = target.omega
    weight = MOTION_WEIGHT * np.sqrt(np.gradient(omega) / (omega[-1] - omega[0]))
    return 1j * (weight * omega)[:, None, None] * target.compliance


def memory_weight(target: Target, K_hat: Array, weight: float) -> tuple[Array | None, Array]:
    """Return weights (n, m, m) that make the squared error of K_hat that of K(t) over its energy (Parseval).

    Parameters
    ----------
    target : Target
        The weights are for its frequencies and those beyond.
    K_hat : (n_w, m, m) complex array
        Data.
    weight : float
        That of a coupling whose K(t) is fully trusted.

    Returns
    -------
    (n, m, m) array, or None where nothing is trusted
    (m, m) array
        Squared weight of an error of K(0+), which stands for all higher frequencies: there dK_hat = dK(0+) / (i omega).
    """
    beyond = target.beyond
    if beyond is None or weight == 0.0:
        return None, np.zeros(K_hat.shape[1:])
    at = np.concatenate([target.omega, beyond.omega])
    step = np.gradient(np.concatenate([[0.0], at]))[1:]
    energy = np.einsum("w,wij->ij", step, np.abs(np.concatenate([K_hat, beyond.K_hat])) ** 2)
    share = (weight * beyond.trust) ** 2 / np.maximum(energy, 1e-300)
    return np.sqrt(step[:, None, None] * share), share / at[-1]


def root_of_weight(data: Array, motion: Array | None, memory: Array | None, i: Array, j: Array) -> Array:
    """Return T (n, 2 u, 2 u) so that \\|T [Re e, Im e]\\|^2 is all that an error e (u,) of the couplings i <= j costs.

    Parameters
    ----------
    data : (n_w, 2, m, m) array
    motion : (n_w, m, m) complex array, optional
    memory : (n, m, m) array, optional
        At more frequencies than the others, which come first.
    i, j : (u,) array
    """
    n_w, u, m = len(data), len(i), data.shape[-1]
    gram = np.zeros((n_w if memory is None else len(memory), 2 * u, 2 * u))
    k = np.arange(2 * u)
    gram[:n_w, k, k] = np.concatenate([data[:, 0, i, j], data[:, 1, i, j]], axis=1) ** 2
    if memory is not None:
        gram[:, k, k] += np.tile(memory[:, i, j], 2) ** 2
    if motion is not None:
        spread = np.zeros((m, m, u))  # an error of coupling k is one of ij and of ji
        spread[i, j, np.arange(u)] = spread[j, i, np.arange(u)] = 1.0
        Q = np.einsum("wac,cbk->wabk", motion, spread).reshape(n_w, -1, u)
        P = np.conj(Q.transpose(0, 2, 1)) @ Q
        gram[:n_w] += np.concatenate(
            [np.concatenate([P.real, -P.imag], axis=2), np.concatenate([P.imag, P.real], axis=2)], axis=1
        )
    strength, axes = np.linalg.eigh(gram)
    return np.sqrt(np.maximum(strength, 0.0))[:, :, None] * axes.transpose(0, 2, 1)
