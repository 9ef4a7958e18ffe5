"""What holds the parameters of the oscillator form where the data leave them free."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.passive_target import Target

Array = NDArray[Any]

_A_INF_TOLERANCE = 0.5  # standard deviations of A(omega) by which a given A_inf may be off at the cost of one residual
_DAMPING_FLOOR = 0.15  # of critical, of an oscillator by its own row of D
_INITIAL_WEIGHT = 0.05  # of K(0+), which the data beyond the last frequency determine only roughly


@dataclass(frozen=True, eq=False)
class Hold:
    """Residuals that keep A_inf near its value, frequencies in range, K(0+) near its estimate, oscillators damped.

    Attributes
    ----------
    a_inf : float
        Weight of the corrections of A_inf.
    low, high : float
        Range of log w.
    i, j : (u,) array
        Couplings.
    K_initial, weight : (u,) array
        K(0+) and its weight.
    """

    a_inf: float
    low: float
    high: float
    i: Array
    j: Array
    K_initial: Array
    weight: Array

    @classmethod
    def of(cls, target: Target, more: Array) -> "Hold":
        """Return what the target asks for; `more` (u,) is added to the squared weight of K(0+)."""
        i, j = np.triu_indices(len(target.K_initial))
        size = np.sqrt(np.maximum(np.diag(target.K_initial), 1e-300))
        weight = np.sqrt((_INITIAL_WEIGHT / (size[i] * size[j])) ** 2 + more)
        a_inf = 1 / _A_INF_TOLERANCE if target.A_inf_given else 1e-3
        low, high = np.log(0.1 * target.omega[0]), np.log(4.0 * target.omega[-1])
        return cls(a_inf, float(low), float(high), i, j, target.K_initial[i, j], weight)

    def residual(self, p: Array, n_inf: int, n: int, r: int) -> Array:
        """Return the residuals (2 n_inf + 2 n,) for n oscillators on r dampers."""
        x, b, D = split(p[n_inf:], n, self.i[-1] + 1, r)
        ratio = np.log((D**2).sum(axis=1) / (2 * _DAMPING_FLOOR) + 1e-300) - x
        initial = self.weight * ((b.T @ b)[self.i, self.j] - self.K_initial)
        return np.concatenate(
            [self.a_inf * p[:n_inf], x - np.clip(x, self.low, self.high), initial, 0.1 * np.minimum(ratio, 0.0)]
        )

    def slopes(self, p: Array, n_inf: int, n: int, r: int) -> Array:
        """Return the derivatives (2 n_inf + 2 n, n_p) of the residuals."""
        x, b, D = split(p[n_inf:], n, self.i[-1] + 1, r)
        m = b.shape[1]
        J = np.zeros((2 * n_inf + 2 * n, len(p)))
        u, k = np.arange(n_inf), np.arange(n)
        J[u, u] = self.a_inf
        J[n_inf + k, n_inf + k] = (x > self.high) | (x < self.low)
        by_row = np.zeros((n_inf, n, m))
        np.add.at(by_row, (u[:, None], k, self.i[:, None]), self.weight[:, None] * b[:, self.j].T)
        np.add.at(by_row, (u[:, None], k, self.j[:, None]), self.weight[:, None] * b[:, self.i].T)
        J[n_inf + n : 2 * n_inf + n, n_inf + n : n_inf + n + n * m] = by_row.reshape(n_inf, -1)
        size = (D**2).sum(axis=1) + 1e-300
        low = np.flatnonzero(np.log(size / (2 * _DAMPING_FLOOR)) < x)
        J[2 * n_inf + n + low, n_inf + low] = -0.1
        for q in range(r):
            J[2 * n_inf + n + low, len(p) - n * r + low * r + q] = 0.2 * D[low, q] / size[low]
        return J


def split(q: Array, n: int, m: int, r: int) -> tuple[Array, Array, Array]:
    """Return log w (n,), b (n, m) and D (n, r) of the parameters of n oscillators on r dampers."""
    return q[:n], q[n : n + n * m].reshape(n, m), q[n + n * m :].reshape(n, r)
