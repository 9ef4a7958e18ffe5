"""Fit of the oscillator form to radiation data: grown one oscillator at a time, Levenberg-Marquardt, exact Jacobian."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.oscillators import derivatives, response
from ogilvie.memory.passive_hold import Hold
from ogilvie.memory.passive_target import Target
from ogilvie.memory.passive_weights import MOTION_WEIGHT, data_weight, memory_weight, motion_matrix, root_of_weight
from ogilvie.memory.resonances import Resonances

Array = NDArray[Any]

DAMPERS = 3  # r; more gain nothing on any vessel tried, one is too few
_RESONANCE_WEIGHT = 5.0  # of relative errors of damping and of frequency, in half bandwidths


class Fit:
    """Least-squares problem of one block; parameters are [A_inf correction (couplings) | oscillators].

    Residuals live on three sets of frequencies, one after the other: data, resonances, beyond the data.
    """

    def __init__(self, target: Target, r: int = DAMPERS):
        self.target, self.r, self.m = target, r, target.A.shape[1]
        self.i, self.j = np.triu_indices(self.m)
        self.n_inf = len(self.i)
        self.sA, self.sB = _spread(target.A), _spread(target.B)
        self.n_data = len(target.omega)
        self.resonances: Resonances | None = None  # see aim_at_resonances
        self.resonance_weight = _RESONANCE_WEIGHT
        self._collect()
        self.motion = motion_matrix(target)
        self.memory_weight = 0.0
        self.reweigh()

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
        data = data_weight(self.target, self.sA, self.sB)
        memory, rest = memory_weight(self.target, self.data[: self.n_data], self.memory_weight)
        self.root = root_of_weight(data, self.motion, memory, self.i, self.j)
        self.weighed = np.r_[: self.n_data, self.n_known : self.n_known + len(self.root) - self.n_data]
        self.hold = Hold.of(self.target, rest[self.i, self.j])

    def correction(self, p: Array) -> Array:
        """Change of A_inf (m, m) in the parameters."""
        change = np.zeros((self.m, self.m))
        change[self.i, self.j] = p[: self.n_inf] * self.sA[self.i, self.j]
        change[self.j, self.i] = change[self.i, self.j]
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
        parts = [self._weigh(E), self.hold.residual(p, self.n_inf, self.oscillators(p), self.r)]
        if self.resonances is not None:
            parts.append(self._soft(E)[0])
        return np.concatenate(parts)

    def jacobian(self, p: Array) -> tuple[Array, Array]:
        """Return residuals and their derivatives."""
        n, k = self.oscillators(p), np.arange(self.n_inf)
        H, Y = response(p[self.n_inf :], n, self.m, self.r, self.omega)
        E = H + self.factor[:, None, None] * self.correction(p) - self.data
        dE = np.zeros((len(self.omega), self.m, self.m, len(p)), dtype=complex)
        dE[..., self.n_inf :] = derivatives(p[self.n_inf :], n, self.m, self.r, self.omega, Y)
        dE[:, self.i, self.j, k] = dE[:, self.j, self.i, k] = self.factor[:, None] * self.sA[self.i, self.j]
        parts = [self._weigh(E), self.hold.residual(p, self.n_inf, n, self.r)]
        slopes = [self._weigh(dE), self.hold.slopes(p, self.n_inf, n, self.r)]
        if self.resonances is not None:
            at, slope = self._soft(E)
            parts.append(at)
            slopes.append(slope[:, None] * self.resonances.relative(dE[self.n_data : self.n_known]))
        return np.concatenate(parts), np.concatenate(slopes)

    def _weigh(self, E: Array) -> Array:
        """Residuals (n_r,) of an error (n, m, m), or their derivatives (n_r, n_p) from its derivatives (n, m, m, n_p)."""
        e = E[:, self.i, self.j]
        e = e.reshape(*e.shape[:2], -1)
        x = np.concatenate([e.real, e.imag], axis=1)
        return (self.root @ x[self.weighed]).reshape(-1, *E.shape[3:])

    def _soft(self, E: Array) -> tuple[Array, Array]:
        """Residuals of the resonances and their slopes; errors far above what matters count by their logarithm."""
        assert self.resonances is not None
        x = self.resonance_weight * self.resonances.relative(E[self.n_data : self.n_known])
        return np.arcsinh(x), self.resonance_weight / np.sqrt(1 + x**2)

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
        return np.sqrt(change.sum(axis=0)) / MOTION_WEIGHT


def _spread(x: Array) -> Array:
    s = x.std(axis=0)
    return np.maximum(s, 1e-12 * max(float(s.max()), 1e-300))
