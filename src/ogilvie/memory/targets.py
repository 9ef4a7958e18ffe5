"""What a state space is fitted to: K(t), or added mass and damping; outputs by linear least squares, the poles being known."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.blocks import negligible, r_squared
from ogilvie.memory.passive_target import radiation_data
from ogilvie.memory.retardation import Retardation
from ogilvie.memory.statespace import StateSpace

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Trial:
    """A model of one block, K(t) = C exp(A t) B, and the added mass at infinite frequency that goes with it.

    Where it was truncated, `common_poles` are those of the model before.
    """

    A: Array
    B: Array
    C: Array
    A_inf: Array
    common_poles: Array | None = None

    @property
    def poles(self) -> Array:
        """Complex poles (n,), 1/s, those of the model before truncation where there was one."""
        return np.linalg.eigvals(self.A).astype(complex) if self.common_poles is None else self.common_poles

    @property
    def model(self) -> StateSpace:
        """The same as a StateSpace with numbered degrees of freedom."""
        return StateSpace(self.A, self.B, self.C, tuple(map(str, range(len(self.C)))))


class FitTarget(Protocol):
    """What the papers' methods need to know of a block; each degree of freedom is divided by its scale."""

    @property
    def size(self) -> int:
        """Number of degrees of freedom m."""

    @property
    def least_order(self) -> int:
        """Number of states below which the constraints leave nothing to fit."""

    @property
    def most_poles(self) -> int:
        """Number of common poles that the data can determine."""

    @property
    def scale(self) -> Array:
        """(m,): forces and velocities are per scale."""

    @property
    def A_inf(self) -> Array:
        """(m, m): added mass at infinite frequency or a first guess of it."""

    def outputs(self, A: Array, B: Array, A_inf: Array | None = None) -> Trial:
        """Return the model with the C that fits best; A_inf is found with it where it is neither known nor handed over."""

    def r2(self, trial: Trial) -> Array:
        """Return the coefficient of determination (m, m) of each coupling; NaN where it is zero by symmetry."""


@dataclass(frozen=True, eq=False)
class Impulse:
    """K(t) of one block, the target of the time-domain methods.

    Attributes
    ----------
    t : (n_t,) array
    K : (n_t, m, m) array
    omega_max : float
        Highest frequency of the data behind K, rad/s.
    A_inf : (m, m) array
    scale : (m,) array
    """

    t: Array
    K: Array
    omega_max: float
    A_inf: Array
    scale: Array

    @classmethod
    def of(cls, K: Retardation, dofs: list[int]) -> "Impulse":
        """Return the target of the block of these degrees of freedom, scaled by the square root of max |K_ii|."""
        part = K.K[:, dofs][:, :, dofs]
        scale = np.sqrt(np.abs(np.einsum("tii->ti", part)).max(axis=0))
        square = np.outer(scale, scale)
        omega = radiation_data(K)[0]
        return cls(K.t, part / square, float(omega[-1]), K.A_inf[np.ix_(dofs, dofs)] / square, scale)

    @property
    def size(self) -> int:
        """Number of degrees of freedom."""
        return self.K.shape[1]

    @property
    def least_order(self) -> int:
        """One: nothing is constrained."""
        return 1

    @property
    def most_poles(self) -> int:
        """Three samples for each pole."""
        return (len(self.t) - 1) // 3

    def outputs(self, A: Array, B: Array, A_inf: Array | None = None) -> Trial:
        """Return the model with the C that fits K(t) best."""
        n = len(A)
        states = StateSpace(A, B, np.zeros((self.size, n)), tuple(map(str, range(self.size)))).states(self.t)
        regressors = states.transpose(0, 2, 1).reshape(-1, n)
        targets = self.K.transpose(0, 2, 1).reshape(-1, self.size)
        return Trial(A, B, np.linalg.lstsq(regressors, targets, rcond=None)[0].T, self.A_inf)

    def r2(self, trial: Trial) -> Array:
        """Return R2 (m, m) of K(t)."""
        return r_squared(self.K, trial.model.impulse(self.t))


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Added mass and damping of one block, the target of the frequency-domain methods.

    Attributes
    ----------
    omega : (n_w,) array
    A, B : (n_w, m, m) array
    A_inf : (m, m) array
    A_inf_given : bool
        Otherwise A_inf is found with the model.
    scale : (m,) array
    """

    omega: Array
    A: Array
    B: Array
    A_inf: Array
    A_inf_given: bool
    scale: Array

    @classmethod
    def of(cls, K: Retardation, dofs: list[int]) -> "Spectrum":
        """Return the target of the block of these degrees of freedom, scaled by the square root of max |B_ii|."""
        omega, A, B = radiation_data(K)
        A, B = A[:, dofs][:, :, dofs], B[:, dofs][:, :, dofs]
        scale = np.sqrt(np.abs(np.einsum("wii->wi", B)).max(axis=0))
        square = np.outer(scale, scale)
        return cls(omega, A / square, B / square, K.A_inf[np.ix_(dofs, dofs)] / square, K.A_inf_given, scale)

    @property
    def size(self) -> int:
        """Number of degrees of freedom."""
        return self.A.shape[1]

    @property
    def least_order(self) -> int:
        """Two for each degree of freedom, since K_hat(0) = 0 ties as many states as there are degrees of freedom."""
        return 2 * self.size

    @property
    def most_poles(self) -> int:
        """A coupling has two numbers at each frequency, and as many residues as poles, which it shares."""
        return len(self.omega) - 1

    @cached_property
    def couplings(self) -> list[tuple[int, int]]:
        """Couplings i <= j that are not zero by symmetry."""
        zero = negligible(self.B)
        return [(i, j) for i in range(self.size) for j in range(i, self.size) if not zero[i, j]]

    @cached_property
    def spreads(self) -> tuple[Array, Array]:
        """Standard deviation (m, m) of A and B over the frequencies."""
        A, B = self.A.std(axis=0), self.B.std(axis=0)
        return np.maximum(A, 1e-12 * A.max() + 1e-300), np.maximum(B, 1e-12 * B.max() + 1e-300)

    def rows(self, x: Array, pairs: list[tuple[int, int]]) -> Array:
        """Return real rows (n_c, 2 n_w, ...) of complex equations x (n_c or 1, n_w, ...) for K_hat of these couplings.

        Real and imaginary part are weighted so that the squared error of K_hat_ij is (1 - R2) of A_ij plus (1 - R2) of B_ij.
        """
        i, j = np.transpose(pairs)
        shape = (len(pairs), len(self.omega)) + (1,) * (x.ndim - 2)
        share = 1 / np.sqrt(len(self.omega))
        real = np.broadcast_to(share / self.spreads[1][i, j, None], shape[:2]).reshape(shape)
        imag = (share / (self.spreads[0][i, j, None] * self.omega)).reshape(shape)
        return np.concatenate([real * x.real, imag * x.imag], axis=1)

    def data(self, pairs: list[tuple[int, int]], A_inf: Array) -> Array:
        """Return K_hat = B + i omega (A - A_inf) of these couplings, (n_c, n_w) complex."""
        i, j = np.transpose(pairs)
        return (self.B[:, i, j] + 1j * self.omega[:, None] * (self.A[:, i, j] - A_inf[i, j])).T

    def outputs(self, A: Array, B: Array, A_inf: Array | None = None) -> Trial:
        """Return the model with the C that fits A and B best under C A^-1 B = 0, that is K_hat(0) = 0."""
        n, m = A.shape[0], self.size
        inf = self.A_inf if A_inf is None else A_inf
        X = np.linalg.solve(1j * self.omega[:, None, None] * np.eye(n) - A, B.astype(complex)).transpose(2, 0, 1)  # (m, n_w, n)
        Q = np.linalg.qr(np.linalg.solve(A, B), mode="complete")[0][:, m:]  # C = z Q^T
        C, change = np.zeros((m, n)), np.zeros((m, m))
        for i in range(m):
            pairs = [(i, j) for j in range(m) if (min(i, j), max(i, j)) in self.couplings]
            columns = [j for _, j in pairs]
            regressors = X[columns] @ Q
            if A_inf is None and not self.A_inf_given:
                regressors = np.concatenate([regressors, _one_each(1j * self.omega, len(pairs))], axis=2)
            M, y = self.rows(regressors, pairs), self.rows(self.data(pairs, inf), pairs)
            z = np.linalg.lstsq(M.reshape(-1, M.shape[2]), y.ravel(), rcond=None)[0]
            C[i], change[i, columns[: len(z) - n + m]] = Q @ z[: n - m], z[n - m :]
        return Trial(A, B, C, inf + (change + change.T) / 2)

    def r2(self, trial: Trial) -> Array:
        """Return the lower one of R2 of A and of B (m, m)."""
        K_hat = trial.model.transfer(self.omega)
        A = trial.A_inf + K_hat.imag / self.omega[:, None, None]
        return np.fmin(r_squared(self.A, A, size=self.B), r_squared(self.B, K_hat.real))


def _one_each(column: Array, n: int) -> Array:
    """Return (n, n_w, n): the column for unknown k in equations k, zero elsewhere."""
    x = np.zeros((n, len(column), n), dtype=complex)
    x[np.arange(n), :, np.arange(n)] = column
    return x
