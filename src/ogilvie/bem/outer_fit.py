"""Oscillators fitted to the outer domain: started from its poles and its radiated waves, then Levenberg-Marquardt."""

from dataclasses import replace
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ogilvie.bem.outer_oscillators import Problem
from ogilvie.bem.outer_poles import common_poles, damped_oscillators, phase

Array = NDArray[Any]

_STAGES = ((10.0, 250), (1e5, 60), (1e9, 60))  # weight of K(0+), iterations
_ENOUGH = 1e-5  # relative gain of the cost below which an iteration is the last


def fitted(omega: Array, L: Array, initial: Array, count: int) -> tuple[Array, Array, Array]:
    """Return w (n,), b (n, J) and d (n,) of n = `count` oscillators with b^T b = K(0+) exactly.

    Parameters
    ----------
    omega : (f,) array
        The first one 0, the last one so high that L is nearly -K(0+) / omega^2.
    L : (f, J, J) complex array
        N - N_inf, time factor exp(+i omega t).
    initial : (J, J) array
        K(0+), symmetric, positive semi-definite.
    count : int
        At least J.

    Notes
    -----
    Errors are weighed by 1 + omega: those of L at low frequencies, of K_hat = i omega L at high ones.
    """
    size = np.abs(L).max()
    weight = (1 + omega) / size
    problem = Problem(omega, L, weight**2 / len(omega), initial, 0.0)
    p = _start(problem, weight, count)
    for hold, iterations in _STAGES:
        p = descended(replace(problem, initial_weight=hold / np.abs(initial).max() ** 2), p, iterations)
    return problem.split(with_initial(problem, p))


def _start(problem: Problem, weight: Array, count: int) -> Array:
    """Parameters from the common poles, b from the radiated waves.

    Where damping is omega^2 h h^T, the waves of the model are d^T (...)^-1 b = exp(-i phase) cos(phase) sum_k d_k b_k /
    (w_k^2 - omega^2): equal to h, which is real but for that phase, by linear least squares.
    """
    omega, L = problem.omega, problem.target
    i, j = np.triu_indices(L.shape[1])
    poles = common_poles(omega, L[:, i, j], weight, count)
    w, d = damped_oscillators(poles)
    wave, at, trust = _radiated(L[omega > 0], omega[omega > 0]), omega[omega > 0], (weight * omega)[omega > 0, None]
    M = np.cos(phase(poles, at))[:, None] * d / (w**2 - at[:, None] ** 2)
    b = np.linalg.lstsq(trust * M, trust * wave, rcond=1e-10)[0]
    return np.concatenate([np.log(w), b.ravel(), d])


def _radiated(L: Array, omega: Array) -> Array:
    """h (f, J) with -omega Im L = omega^2 h h^T, its sign continuous: frequencies so dense that h turns little in between."""
    strength, axes = np.linalg.eigh(-L.imag / omega[:, None, None])
    h = np.sqrt(np.maximum(strength[:, -1:], 0.0)) * axes[:, :, -1]
    turns = np.where((h[1:] * h[:-1]).sum(axis=1) < 0, -1.0, 1.0)
    return np.asarray(h * np.concatenate([[1.0], np.cumprod(turns)])[:, None])


def descended(problem: Problem, p: Array, iterations: int) -> Array:
    """Return parameters after Levenberg-Marquardt."""
    damping = 1e-6
    cost, gradient, normal = problem.normal(p)
    for _ in range(iterations):
        for _ in range(20):
            matrix = normal + damping * np.trace(normal) / len(p) * np.eye(len(p))
            _, step, failed = scipy.linalg.lapack.dposv(matrix, gradient, overwrite_a=True)
            if not failed and problem.cost(p - step) < cost:
                break
            damping *= 8
        else:
            return p
        before, p, damping = cost, p - step, max(damping / 5, 1e-16)
        cost, gradient, normal = problem.normal(p)
        if before - cost < _ENOUGH * cost:
            break
    return p


def with_initial(problem: Problem, p: Array) -> Array:
    """Return parameters with b^T b = K(0+) exactly, b as near as possible to what it was."""
    w, b, d = problem.split(p)
    strength, axes = np.linalg.eigh(problem.initial)
    root = (axes * np.sqrt(np.maximum(strength, 0.0))) @ axes.T
    U, _, V = np.linalg.svd(b @ root, full_matrices=False)
    return np.concatenate([np.log(w), (U @ V @ root).ravel(), d])
