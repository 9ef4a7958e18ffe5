"""Oscillators fitted to the outer domain: added one at a time where the error is largest, Levenberg-Marquardt."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ogilvie.bem.outer_oscillators import Problem

Array = NDArray[Any]

_APART = 0.25  # in log omega, of the places where a new oscillator is tried
_PLACES = 3
_WIDTHS = (0.15, 0.6)  # of critical damping, of a new oscillator
_SHORT, _LONG = 6, 40  # iterations: of each trial, of the best


def grown(problem: Problem, count: int, report: Callable[[str], None] = lambda text: None) -> Array:
    """Return the parameters of `count` oscillators."""
    p = np.zeros(0)
    for n in range(count):
        trials = sorted(_trials(problem, p), key=problem.cost)[:_PLACES]
        descended = [descend(problem, trial, _SHORT) for trial in trials]
        p, cost = descend(problem, min(descended, key=lambda d: d[1])[0], _LONG)
        report(f"{n + 1} oscillators, error {np.sqrt(cost):.2e}")
    return p


def descend(problem: Problem, p: Array, iterations: int, *, tolerance: float = 1e-3) -> tuple[Array, float]:
    """Return parameters and cost after Levenberg-Marquardt."""
    damping = 1e-3
    cost, gradient, normal = problem.normal(p)
    for _ in range(iterations):
        scale = np.diag(normal) + 1e-9 * np.trace(normal) / len(p)
        for _ in range(10):
            matrix = normal.copy()
            matrix[np.diag_indices_from(matrix)] += damping * scale
            _, step, failed = scipy.linalg.lapack.dposv(matrix, gradient, overwrite_a=True)
            trial = p - step
            if not failed and np.abs(step[: len(problem.split(p)[0])]).max() < 2.0 and problem.cost(trial) < cost:
                break
            damping *= 4
        else:
            return p, cost
        before, p, damping = cost, trial, max(damping / 5, 1e-12)
        cost, gradient, normal = problem.normal(p)
        if before - cost < tolerance * cost:
            break
    return p, cost


def _trials(problem: Problem, p: Array) -> list[Array]:
    """Parameters with one more oscillator at the frequencies of the largest errors, on each damper in turn."""
    J, r = len(problem.initial), problem.dampers
    n = len(p) // (1 + J + r)
    w, b, D = problem.split(p)
    missing = -problem.error(p) if n else problem.target
    size = np.sqrt(problem.weight * np.abs(missing).max(axis=(1, 2)) ** 2) * (problem.omega > 0)
    found = []
    for w0 in _peaks(problem.omega, size):
        near = np.exp(-((np.log(np.maximum(problem.omega, 1e-6) / w0) / 0.3) ** 2)) * problem.weight
        damping = np.einsum("f,fij->ij", near / near.sum(), -problem.omega[:, None, None] * missing.imag)
        strength, direction = np.linalg.eigh(damping)
        for zeta in _WIDTHS:
            row = np.sqrt(2 * zeta * w0 * max(strength[-1], 1e-14)) * direction[:, -1]
            for q in range(min(r, n + 1)):
                damper = np.sqrt(2 * zeta * w0) * (np.arange(r) == q)
                found.append(np.concatenate([np.log(np.append(w, w0)), b.ravel(), row, D.ravel(), damper]))
    return found


def _peaks(omega: Array, size: Array) -> list[float]:
    """Frequencies of the largest errors, some distance apart."""
    found: list[float] = []
    for f in np.argsort(-size):
        if omega[f] > 0 and all(abs(np.log(omega[f] / other)) > _APART for other in found):
            found.append(float(omega[f]) * 1.003)  # off the frequency itself
        if len(found) == _PLACES:
            break
    return found


def levelled(problem: Problem, p: Array, *, rounds: int = 6, iterations: int = 12) -> Array:
    """Return parameters whose largest error is lower: weights grow where errors are large."""
    best, lowest = p, np.inf
    base = problem.weight
    boost = np.ones(len(base))
    for _ in range(rounds + 1):
        error = np.abs(problem.error(p)).max(axis=(1, 2)) * np.sqrt(base)
        if error.max() < lowest:
            best, lowest = p, error.max()
        boost = boost * np.maximum(error / np.sqrt(np.mean(error**2)), 0.3)
        boost /= boost.mean()
        p, _ = descend(replace(problem, weight=base * boost), p, iterations)
    return best


def with_initial(problem: Problem, p: Array) -> Array:
    """Return parameters with b^T b = K(0+) exactly: the nearest such b."""
    w, b, D = problem.split(p)
    value, axes = np.linalg.eigh(problem.initial)
    root = (axes * np.sqrt(np.maximum(value, 0.0))) @ axes.T
    U, _, V = np.linalg.svd(b @ root, full_matrices=False)
    return np.concatenate([np.log(w), (U @ V @ root).ravel(), D.ravel()])
