"""Fit of the oscillator form to radiation data: grown one oscillator at a time, Levenberg-Marquardt, exact Jacobian."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.oscillators import derivatives, response
from ogilvie.memory.passive_target import Target
from ogilvie.memory.resonances import Resonances

Array = NDArray[Any]

DAMPERS = 3  # r; more gain nothing on any vessel tried, one is too few
_MOTION_WEIGHT = 20.0
_RESONANCE_WEIGHT = 5.0  # of relative errors of damping and of frequency, in half bandwidths
_A_INF_TOLERANCE = 0.5  # standard deviations of A(omega) by which a given A_inf may be off at the cost of one residual
_DAMPING_FLOOR = 0.15  # of critical, of an oscillator by its own row of D
_INITIAL_WEIGHT = 0.05  # of K(0+), which the data beyond the last frequency determine only roughly


class Fit:
    """Least-squares problem of one block; parameters are [A_inf correction (couplings) | oscillators].

    Residuals live on three sets of frequencies, one after the other: data, resonances, beyond the data.
    """

    def __init__(self, target: Target, r: int = DAMPERS):
        self.target, self.r, self.m = target, r, target.A.shape[1]
        self.upper = [(i, j) for i in range(self.m) for j in range(i, self.m)]
        self.n_inf = len(self.upper)
        self.sA, self.sB = _spread(target.A), _spread(target.B)
        self.n_data = len(target.omega)
        self.resonances: Resonances | None = None  # see aim_at_resonances
        self.resonance_weight = _RESONANCE_WEIGHT
        self._collect()
        self.motion = self._motion_matrix()
        self.memory_weight = 0.0
        self.reweigh()
        self.bounds = np.log(0.1 * target.omega[0]), np.log(4.0 * target.omega[-1])

    def _collect(self) -> None:
        """Gather the frequencies, K_hat and the factor of a change of A_inf; K(t) beyond the data does not know A_inf."""
        t = self.target
        omega, data, factor = [t.omega], [t.B + 1j * t.omega[:, None, None] * (t.A - t.A_inf)], [1j * t.omega]
        if (r := t.resonances) is not None:
            omega.append(r.omega)
            data.append(r.B + 1j * r.omega[:, None, None] * (r.A - t.A_inf))
            factor.append(1j * r.omega)
        self.n_known = sum(map(len, omega))
        if t.beyond is not None:
            omega.append(t.beyond.omega)
            data.append(t.beyond.K_hat)
            factor.append(0j * t.beyond.omega)
        self.omega, self.data, self.factor = np.concatenate(omega), np.concatenate(data), np.concatenate(factor)

    def aim_at_resonances(self) -> bool:
        """Weigh damping and natural frequency at the resonances from now on; return whether that is new."""
        new = self.resonances is None and self.target.resonances is not None
        self.resonances = self.target.resonances
        return new

    def resonance_error(self, p: Array) -> float:
        """Largest relative error of damping at a resonance, or of its frequency in half bandwidths; 0 where not aimed at."""
        if self.resonances is None:
            return 0.0
        return float(np.abs(self.resonances.relative(self.error(p)[self.n_data : self.n_known])).max(initial=0.0))

    def weigh_memory(self, weight: float) -> None:
        """Give K(t) this weight, where its tail is known."""
        self.memory_weight = weight
        self.reweigh()

    def reweigh(self) -> None:
        """Take over the weights of the couplings from the target, and the weight of K(t)."""
        self.memory, rest = self._memory()
        used = [(i, j) for i, j in self.upper if self.target.weight[i, j] > 0.0]
        self.i, self.j = np.array([i for i, _ in used]), np.array([j for _, j in used])
        f = self.target.weight[self.i, self.j] / np.sqrt(self.n_data)
        self.fB = f / self.sB[self.i, self.j]
        self.fA = f / self.sA[self.i, self.j] / self.target.omega[:, None]
        size = np.sqrt(np.maximum(np.diag(self.target.K_initial), 1e-300))
        self.fK = np.sqrt((_INITIAL_WEIGHT / np.outer(size, size)) ** 2 + rest)

    def correction(self, p: Array) -> Array:
        """Change of A_inf (m, m) in the parameters."""
        change = np.zeros((self.m, self.m))
        for k, (i, j) in enumerate(self.upper):
            change[i, j] = change[j, i] = p[k] * self.sA[i, j]
        return change

    def error(self, p: Array) -> Array:
        """K_hat of the model less that of the data, (n, m, m), a change of A_inf taken into account."""
        n = self.oscillators(p)
        H = response(p[self.n_inf :], n, self.m, self.r, self.omega)[0] if n else 0.0
        return H + self.factor[:, None, None] * self.correction(p) - self.data

    def oscillators(self, p: Array) -> int:
        """Number of oscillators in the parameters."""
        return (len(p) - self.n_inf) // (1 + self.m + self.r)

    def residual(self, p: Array) -> Array:
        """Residuals of B, A, motion, resonances and K(t), weighted to be of order one."""
        E = self.error(p)
        parts = self._weigh(E)
        if self.resonances is not None:
            parts.append(self._soft(E)[0])
        return np.concatenate(parts + self._penalties(p))

    def _soft(self, E: Array) -> tuple[Array, Array]:
        """Residuals of the resonances and their slopes; errors far above what matters count by their logarithm."""
        assert self.resonances is not None
        x = self.resonance_weight * self.resonances.relative(E[self.n_data : self.n_known])
        return np.arcsinh(x), self.resonance_weight / np.sqrt(1 + x**2)

    def jacobian(self, p: Array) -> tuple[Array, Array]:
        """Return residuals and their derivatives."""
        n = self.oscillators(p)
        H, Y = response(p[self.n_inf :], n, self.m, self.r, self.omega)
        E = H + self.factor[:, None, None] * self.correction(p) - self.data
        dE = np.zeros((len(self.omega), self.m, self.m, len(p)), dtype=complex)
        dE[..., self.n_inf :] = derivatives(p[self.n_inf :], n, self.m, self.r, self.omega, Y)
        for k, (i, j) in enumerate(self.upper):
            dE[:, i, j, k] = dE[:, j, i, k] = self.factor * self.sA[i, j]
        parts, slopes = self._weigh(E), self._weigh(dE)
        if self.resonances is not None:
            at, slope = self._soft(E)
            parts.append(at)
            slopes.append(slope[:, None] * self.resonances.relative(dE[self.n_data : self.n_known]))
        return np.concatenate(parts + self._penalties(p)), np.concatenate(slopes + self._penalty_slopes(p))

    def _weigh(self, E: Array) -> list[Array]:
        """Residuals of an error (n, m, m), or their derivatives from its derivatives (n, m, m, n_p)."""
        rest, more = E.shape[3:], (1,) * (E.ndim - 3)
        known = E[: self.n_data]
        e = known[:, self.i, self.j]
        parts = [e.real * self.fB.reshape(1, -1, *more), e.imag * self.fA.reshape(*self.fA.shape, *more)]
        if self.motion is not None:
            R = (self.motion @ known.reshape(self.n_data, self.m, -1)).reshape(known.shape)
            parts += [R.real, R.imag]
        if self.memory is not None:
            i, j, weight = self.memory
            e = np.concatenate([known, E[self.n_known :]])[:, i, j]
            weight = weight.reshape(*weight.shape, *more)
            parts += [e.real * weight, e.imag * weight]
        return [part.reshape(-1, *rest) for part in parts]

    def _motion_matrix(self) -> Array | None:
        """Turn an error of K_hat into the weighted relative change of the motion."""
        if self.target.compliance is None:
            return None
        omega = self.target.omega
        weight = _MOTION_WEIGHT * np.sqrt(np.gradient(omega) / (omega[-1] - omega[0]))
        return 1j * (weight * omega)[:, None, None] * self.target.compliance

    def _memory(self) -> tuple[tuple[Array, Array, Array] | None, Array]:
        """Couplings i, j and weights (n, n_c) that make the squared error of K_hat that of K(t) over its energy (Parseval).

        The second array (m, m) is what is left of it beyond the last of the frequencies, where dK_hat = dK(0+) / (i omega).
        """
        beyond, rest = self.target.beyond, np.zeros((self.m, self.m))
        if beyond is None or self.memory_weight == 0.0:
            return None, rest
        i, j = np.nonzero(np.triu(beyond.trust))
        at = np.concatenate([self.target.omega, beyond.omega])
        step = np.gradient(np.concatenate([[0.0], at]))[1:]
        K_hat = np.concatenate([self.data[: self.n_data], beyond.K_hat])[:, i, j]
        energy = np.maximum(step @ np.abs(K_hat) ** 2, 1e-300)
        weight = self.memory_weight * beyond.trust[i, j]
        rest[i, j] = weight**2 / (energy * at[-1])
        return (i, j, weight * np.sqrt(step[:, None] / energy)), rest

    def r2(self, p: Array) -> tuple[Array, Array]:
        """Coefficients of determination (m, m) of added mass and damping; NaN where the coupling is zero."""
        E = self.error(p)[: self.n_data]
        lost_A = ((E.imag / self.target.omega[:, None, None]) ** 2).mean(axis=0) / self.sA**2
        lost_B = (E.real**2).mean(axis=0) / self.sB**2
        nothing = self.target.weight == 0.0
        return np.where(nothing, np.nan, 1 - lost_A), np.where(nothing, np.nan, 1 - lost_B)

    def motion_change(self, p: Array) -> Array:
        """Relative change (m,) of the motion of each dof under unit forces, root mean square over the frequencies."""
        if self.motion is None or self.target.compliance is None:
            return np.zeros(self.m)
        E = self.error(p)[: self.n_data]
        X = self.target.compliance
        change = (np.abs(self.motion @ E @ X) ** 2).sum(axis=2) / (np.abs(X) ** 2).sum(axis=2)
        return np.sqrt(change.sum(axis=0)) / _MOTION_WEIGHT

    def _penalties(self, p: Array) -> list[Array]:
        """Residuals that keep A_inf near its value, frequencies in range, oscillators damped, K(0+) near its estimate."""
        n = self.oscillators(p)
        x, b, D = split(p[self.n_inf :], n, self.m, self.r)
        low, high = self.bounds
        ratio = np.log((D**2).sum(axis=1) / 2 + 1e-300) - x - np.log(_DAMPING_FLOOR)
        hold = 1 / _A_INF_TOLERANCE if self.target.A_inf_given else 1e-3
        initial = (self.fK * (b.T @ b - self.target.K_initial))[np.triu_indices(self.m)]
        return [hold * p[: self.n_inf], np.maximum(x - high, 0) + np.minimum(x - low, 0), initial, 0.1 * np.minimum(ratio, 0)]

    def _penalty_slopes(self, p: Array) -> list[Array]:
        n, n_p = self.oscillators(p), len(p)
        x, b, D = split(p[self.n_inf :], n, self.m, self.r)
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


def split(q: Array, n: int, m: int, r: int) -> tuple[Array, Array, Array]:
    return q[:n], q[n : n + n * m].reshape(n, m), q[n + n * m :].reshape(n, r)
