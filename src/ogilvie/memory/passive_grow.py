"""Growth of the oscillator form: where the next oscillator starts, and Levenberg-Marquardt with the exact Jacobian."""

from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ogilvie.memory.passive_fit import Fit
from ogilvie.memory.passive_hold import split

Array = NDArray[Any]

THOROUGH = ((10, 8), (1, 60))  # rounds of growth: starts and iterations of each
QUICK = ((8, 4), (2, 4), (1, 20))


def candidates(fit: Fit, p: Array, keep: int) -> list[Array]:
    """Return parameters with one more oscillator, placed where it lowers the residual most; best first, not yet optimised."""
    omega, r, n = fit.target.omega, fit.r, fit.oscillators(p)
    missing = -fit.error(p)[: len(omega)].real
    x, b, D = split(p[fit.n_inf :], n, fit.m, r)
    found = []
    for w0 in np.geomspace(0.5 * omega[0], 4 * omega[-1], 16):
        window = np.exp(-((np.log(omega / w0) / 0.3) ** 2)) + 1e-12
        strength, direction = np.linalg.eigh(np.einsum("w,wij->ij", window / window.sum(), missing))
        local = (np.inf, p)
        for zeta in (0.1, 0.4, 1.5):
            row = np.sqrt(2 * zeta * w0 * max(strength[-1], 1e-9)) * direction[:, -1]
            for q in range(min(r, n + 1)):
                damper = np.zeros(r)
                damper[q] = np.sqrt(2 * zeta * w0)
                trial = np.concatenate([p[: fit.n_inf], x, [np.log(w0)], b.ravel(), row, D.ravel(), damper])
                residual = fit.residual(trial)
                local = min(local, (float(residual @ residual), trial), key=lambda c: c[0])
        found.append(local)
    return [trial for _, trial in sorted(found, key=lambda c: c[0])[:keep]]


def grow(fit: Fit, p: Array, *, rounds: tuple[tuple[int, int], ...] = THOROUGH) -> tuple[Array, float]:
    """Return parameters and cost with one more oscillator: many starts descend a little, the best one to the end."""
    starts = [(trial, 0.0) for trial in candidates(fit, p, rounds[0][0])]
    for keep, iterations in rounds:
        starts = [optimise(fit, trial, iterations) for trial, _ in starts[:keep]]
        starts.sort(key=lambda start: start[1])
    return starts[0]


def optimise(fit: Fit, p: Array, iterations: int) -> tuple[Array, float]:
    """Return parameters and cost after Levenberg-Marquardt."""
    damping = 1e-2
    residual, J = fit.jacobian(p)
    cost = float(residual @ residual)
    for _ in range(iterations):
        gradient, normal = J.T @ residual, J.T @ J
        scale = np.diag(normal) + 1e-6 * np.trace(normal) / len(p)
        for _ in range(9):
            _, step, failed = scipy.linalg.lapack.dposv(normal + damping * np.diag(scale), gradient)
            trial = p - step
            new = fit.residual(trial)
            if not failed and new @ new < cost:
                break
            damping *= 4
        else:
            return p, cost
        gain = cost - float(new @ new)
        p, damping = trial, max(damping / 4, 1e-8)
        residual, J = fit.jacobian(p)
        cost = float(residual @ residual)
        if gain < 1e-4 * cost:
            break
    return p, cost
