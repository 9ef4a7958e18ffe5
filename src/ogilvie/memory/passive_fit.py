"""Fit of the oscillator form to radiation data: grown one oscillator at a time, Levenberg-Marquardt, exact Jacobian."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ogilvie.memory.oscillators import derivatives, response

Array = NDArray[Any]

DAMPERS = 3  # r; more gain nothing on any vessel tried, one is too few
_MOTION_WEIGHT = 20.0
_A_INF_TOLERANCE = 0.5  # standard deviations of A(omega) by which a given A_inf may be off at the cost of one residual
_DAMPING_FLOOR = 0.15  # of critical, of an oscillator by its own row of D
_INITIAL_WEIGHT = 0.05  # of K(0+), which the data beyond the last frequency determine only roughly


@dataclass(frozen=True, eq=False)
class Target:
    """Radiation data of one block of m coupled degrees of freedom, scaled so that all are of order one.

    Attributes
    ----------
    omega : (n_w,) array
    A, B : (n_w, m, m) array
        Added mass and damping.
    A_inf : (m, m) array
        Added mass at infinite frequency or a first guess of it.
    A_inf_given : bool
    weight : (m, m) array
        Of each coupling in the residuals of A and B; 0 where it is zero by symmetry.
    K_initial : (m, m) array
        K(0+), an estimate: it keeps the model from inventing fast memory beyond the last frequency.
    compliance : (n_w, m, m) complex array, optional
        X = compliance F of the free-floating body; the fit then weighs the change of the motion, -i omega compliance dK_hat X.
    """

    omega: Array
    A: Array
    B: Array
    A_inf: Array
    A_inf_given: bool
    weight: Array
    K_initial: Array
    compliance: Array | None


class Fit:
    """Least-squares problem of one block; parameters are [A_inf correction (couplings) | oscillators]."""

    def __init__(self, target: Target, r: int = DAMPERS):
        self.target, self.r, self.m = target, r, target.A.shape[1]
        self.upper = [(i, j) for i in range(self.m) for j in range(i, self.m)]
        self.n_inf = len(self.upper)
        self.sA, self.sB = _spread(target.A), _spread(target.B)
        self.data = target.B + 1j * target.omega[:, None, None] * (target.A - target.A_inf)
        self.motion = self._motion_matrix()
        self.reweigh()
        self.bounds = np.log(0.1 * target.omega[0]), np.log(4.0 * target.omega[-1])

    def reweigh(self) -> None:
        """Take over the weights of the couplings from the target."""
        used = [(i, j) for i, j in self.upper if self.target.weight[i, j] > 0.0]
        self.i, self.j = np.array([i for i, _ in used]), np.array([j for _, j in used])
        f = self.target.weight[self.i, self.j] / np.sqrt(len(self.target.omega))
        self.fB = f / self.sB[self.i, self.j]
        self.fA = f / self.sA[self.i, self.j] / self.target.omega[:, None]
        size = np.sqrt(np.maximum(np.diag(self.target.K_initial), 1e-300))
        self.fK = _INITIAL_WEIGHT / np.outer(size, size)

    def correction(self, p: Array) -> Array:
        """Change of A_inf (m, m) in the parameters."""
        change = np.zeros((self.m, self.m))
        for k, (i, j) in enumerate(self.upper):
            change[i, j] = change[j, i] = p[k] * self.sA[i, j]
        return change

    def model(self, p: Array) -> Array:
        """K_hat(i omega) of the oscillators alone, (n_w, m, m)."""
        n = self.oscillators(p)
        return response(p[self.n_inf :], n, self.m, self.r, self.target.omega)[0] if n else np.zeros_like(self.data)

    def oscillators(self, p: Array) -> int:
        """Number of oscillators in the parameters."""
        return (len(p) - self.n_inf) // (1 + self.m + self.r)

    def residual(self, p: Array) -> Array:
        """Residuals of B, A and of the motion, weighted to be of order one."""
        E = self.model(p) + 1j * self.target.omega[:, None, None] * self.correction(p) - self.data
        return self._weigh(E, p)

    def jacobian(self, p: Array) -> tuple[Array, Array]:
        """Return residuals and their derivatives."""
        n, omega = self.oscillators(p), self.target.omega
        H, Y = response(p[self.n_inf :], n, self.m, self.r, omega)
        E = H + 1j * omega[:, None, None] * self.correction(p) - self.data
        dE = np.zeros((len(omega), self.m, self.m, len(p)), dtype=complex)
        dE[..., self.n_inf :] = derivatives(p[self.n_inf :], n, self.m, self.r, omega, Y)
        for k, (i, j) in enumerate(self.upper):
            dE[:, i, j, k] = dE[:, j, i, k] = 1j * omega * self.sA[i, j]
        return self._weigh(E, p), self._weigh_jacobian(dE, p)

    def _weigh(self, E: Array, p: Array) -> Array:
        e = E[:, self.i, self.j]
        parts = [(e.real * self.fB).ravel(), (e.imag * self.fA).ravel()]
        if self.motion is not None:
            R = self.motion @ E
            parts += [R.real.ravel(), R.imag.ravel()]
        return np.concatenate(parts + self._penalties(p))

    def _weigh_jacobian(self, dE: Array, p: Array) -> Array:
        e = dE[:, self.i, self.j]
        n_p = dE.shape[-1]
        parts = [(e.real * self.fB[:, None]).reshape(-1, n_p), (e.imag * self.fA[..., None]).reshape(-1, n_p)]
        if self.motion is not None:
            R = (self.motion @ dE.reshape(len(dE), self.m, -1)).reshape(-1, n_p)
            parts += [R.real, R.imag]
        return np.concatenate(parts + self._penalty_slopes(p))

    def _motion_matrix(self) -> Array | None:
        """Turn an error of K_hat into the weighted relative change of the motion."""
        if self.target.compliance is None:
            return None
        omega = self.target.omega
        weight = _MOTION_WEIGHT * np.sqrt(np.gradient(omega) / (omega[-1] - omega[0]))
        return 1j * (weight * omega)[:, None, None] * self.target.compliance

    def r2(self, p: Array) -> tuple[Array, Array]:
        """Coefficients of determination (m, m) of added mass and damping; NaN where the coupling is zero."""
        K_hat, omega = self.model(p), self.target.omega
        A = self.target.A_inf + self.correction(p) + K_hat.imag / omega[:, None, None]
        lost_A = ((A - self.target.A) ** 2).mean(axis=0) / self.sA**2
        lost_B = ((K_hat.real - self.target.B) ** 2).mean(axis=0) / self.sB**2
        nothing = self.target.weight == 0.0
        return np.where(nothing, np.nan, 1 - lost_A), np.where(nothing, np.nan, 1 - lost_B)

    def motion_change(self, p: Array) -> Array:
        """Relative change (m,) of the motion of each dof under unit forces, root mean square over the frequencies."""
        if self.motion is None or self.target.compliance is None:
            return np.zeros(self.m)
        E = self.model(p) + 1j * self.target.omega[:, None, None] * self.correction(p) - self.data
        X = self.target.compliance
        change = (np.abs(self.motion @ E @ X) ** 2).sum(axis=2) / (np.abs(X) ** 2).sum(axis=2)
        return np.sqrt(change.sum(axis=0)) / _MOTION_WEIGHT

    def _penalties(self, p: Array) -> list[Array]:
        """Residuals that keep A_inf near its value, frequencies in range, oscillators damped, K(0+) near its estimate."""
        n = self.oscillators(p)
        x, b, D = _split(p[self.n_inf :], n, self.m, self.r)
        low, high = self.bounds
        ratio = np.log((D**2).sum(axis=1) / 2 + 1e-300) - x - np.log(_DAMPING_FLOOR)
        hold = 1 / _A_INF_TOLERANCE if self.target.A_inf_given else 1e-3
        initial = (self.fK * (b.T @ b - self.target.K_initial))[np.triu_indices(self.m)]
        return [hold * p[: self.n_inf], np.maximum(x - high, 0) + np.minimum(x - low, 0), initial, 0.1 * np.minimum(ratio, 0)]

    def _penalty_slopes(self, p: Array) -> list[Array]:
        n, n_p = self.oscillators(p), len(p)
        x, b, D = _split(p[self.n_inf :], n, self.m, self.r)
        low, high = self.bounds
        slopes = [np.zeros((rows, n_p)) for rows in (self.n_inf, n, self.n_inf, n)]
        size = (D**2).sum(axis=1) + 1e-300
        k = np.flatnonzero(np.log(size / 2) - x < np.log(_DAMPING_FLOOR))
        slopes[3][k, self.n_inf + k] = -0.1
        for q in range(self.r):
            slopes[3][k, n_p - n * self.r + k * self.r + q] = 0.2 * D[k, q] / size[k]
        slopes[0][:, : self.n_inf] = np.eye(self.n_inf) * (1 / _A_INF_TOLERANCE if self.target.A_inf_given else 1e-3)
        slopes[1][np.arange(n), self.n_inf + np.arange(n)] = (x > high) | (x < low)
        at = self.n_inf + n + self.m * np.arange(n)
        for row, (i, j) in enumerate(self.upper):
            slopes[2][row, at + i] += self.fK[i, j] * b[:, j]
            slopes[2][row, at + j] += self.fK[i, j] * b[:, i]
        return slopes


def _spread(x: Array) -> Array:
    s = x.std(axis=0)
    return np.maximum(s, 1e-12 * max(float(s.max()), 1e-300))


def candidates(fit: Fit, p: Array, keep: int) -> list[Array]:
    """Return parameters with one more oscillator, placed where it lowers the residual most; best first, not yet optimised."""
    omega, m, r, n = fit.target.omega, fit.m, fit.r, fit.oscillators(p)
    missing = (fit.data - fit.model(p) - 1j * omega[:, None, None] * fit.correction(p)).real
    x, b, D = _split(p[fit.n_inf :], n, m, r)
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


def grow(fit: Fit, p: Array, *, keep: int = 10, short: int = 8, long: int = 60) -> tuple[Array, float]:
    """Return parameters and cost with one more oscillator: the best of a few starts after a short descent, then a long one."""
    starts = [optimise(fit, trial, short) for trial in candidates(fit, p, keep)]
    return optimise(fit, min(starts, key=lambda s: s[1])[0], long)


def optimise(fit: Fit, p: Array, iterations: int) -> tuple[Array, float]:
    """Return parameters and cost after Levenberg-Marquardt."""
    damping = 1e-2
    residual, J = fit.jacobian(p)
    cost = float(residual @ residual)
    for _ in range(iterations):
        gradient, normal = J.T @ residual, J.T @ J
        scale = np.diag(normal) + 1e-6 * np.trace(normal) / len(p)
        for _ in range(9):
            factor = scipy.linalg.cho_factor(normal + damping * np.diag(scale), check_finite=False)
            trial = p - scipy.linalg.cho_solve(factor, gradient, check_finite=False)
            new = fit.residual(trial)
            if new @ new < cost:
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


def _split(q: Array, n: int, m: int, r: int) -> tuple[Array, Array, Array]:
    return q[:n], q[n : n + n * m].reshape(n, m), q[n + n * m :].reshape(n, r)
