"""The fairest curves with given areas and centroid: a convex programme in spline coefficients, solved exactly."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import ConvergenceError

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Basis:
    """Cubic B-splines on equal intervals of [-1, 1], and the points at which inequalities are imposed.

    Parameters
    ----------
    n : int
        Intervals.
    """

    n: int

    @property
    def size(self) -> int:
        """Number of coefficients."""
        return self.n + 3

    @property
    def knots(self) -> Array:
        """Knots, the end ones repeated."""
        return np.r_[[-1.0] * 3, np.linspace(-1.0, 1.0, self.n + 1), [1.0] * 3]

    @property
    def points(self) -> Array:
        """Points (4 n + 1,) of the inequalities."""
        return np.linspace(-1.0, 1.0, 4 * self.n + 1)

    def rows(self, x: ArrayLike, derivative: int = 0) -> Array:
        """Return the values (n_x, size) of the splines, or of a derivative."""
        return np.asarray(self.curve(np.eye(self.size))(np.atleast_1d(x), nu=derivative))

    def integral(self, power: int = 0) -> Array:
        """Return the integrals (size,) of x^power times each spline over [-1, 1]."""
        x, w = self._gauss(3)
        return np.asarray((w * x**power) @ self.rows(x))

    def roughness(self) -> Array:
        """Return R (.., size) with |R c|^2 the integral of the squared third derivative."""
        x, w = self._gauss(1)
        return np.sqrt(w)[:, None] * self.rows(x, 3)

    def curve(self, coefficients: Array) -> "BSpline":
        """Return the spline with these coefficients."""
        from scipy.interpolate import BSpline

        return BSpline(self.knots, coefficients, 3)

    def _gauss(self, order: int) -> tuple[Array, Array]:
        t, w = np.polynomial.legendre.leggauss(order)
        edges = np.linspace(-1.0, 1.0, self.n + 1)
        half = 1.0 / self.n
        return ((edges[:-1, None] + half) + half * t).ravel(), np.tile(half * w, self.n)


@dataclass(frozen=True, eq=False)
class Constraints:
    """Linear conditions on unknowns x: A x = b and G x >= h."""

    A: Array
    b: Array
    G: Array
    h: Array


def smoothest(R: Array, c: Constraints) -> Array | None:
    """Return the x with least |R x|^2 under linear conditions, or None if no x meets them.

    Notes
    -----
    Equalities are eliminated (x = x0 + Z y), the rest is a least-distance problem, whose dual is a non-negative least-squares
    problem: exact in a finite number of steps, no start value, and a residual of zero there proves that no x exists.

    References
    ----------
    Lawson and Hanson (1974), Solving least squares problems, chapter 23.
    """
    from scipy.optimize import nnls

    U, s, Vt = np.linalg.svd(c.A)
    rank = int((s > 1e-10 * s[0]).sum())
    x0 = Vt[:rank].T @ ((U.T @ c.b)[:rank] / s[:rank])
    if np.abs(c.A @ x0 - c.b).max() > 1e-9:
        return None
    Z = Vt[rank:].T
    Q, T = np.linalg.qr(np.vstack([R @ Z, 1e-7 * np.linalg.norm(R) * Z]))
    q = Q.T @ np.r_[-R @ x0, np.zeros(len(Z))]
    # u = T y - q: least |u| with G Z T^-1 (u + q) >= h - G x0
    M = np.linalg.solve(T.T, (c.G @ Z).T).T
    rhs = c.h - c.G @ x0 - M @ q
    scale, given = np.linalg.norm(M, axis=1), np.linalg.norm(c.G @ Z, axis=1) <= 1e-10 * np.linalg.norm(c.G, axis=1)
    if np.any((c.h - c.G @ x0)[given] > 1e-9):
        return None
    if given.all():
        return np.asarray(x0 + Z @ np.linalg.solve(T, q))
    E = np.vstack([M[~given].T, rhs[~given]]) / scale[~given]
    f = np.r_[np.zeros(len(E) - 1), 1.0]
    try:
        weights, rest = nnls(E, f, maxiter=50 * E.shape[1])
    except RuntimeError as error:
        raise ConvergenceError(f"fairing: the non-negative least-squares solver stopped, {error}") from error
    if rest < 1e-9:
        return None
    r = E @ weights - f
    return np.asarray(x0 + Z @ np.linalg.solve(T, -r[:-1] / r[-1] + q))


def span(row: Array, c: Constraints) -> tuple[float, float] | None:
    """Return the least and greatest value of row . x under linear conditions, or None if no x meets them."""
    from scipy.optimize import linprog

    ends = [
        linprog(s * row, A_ub=-c.G, b_ub=-c.h, A_eq=c.A, b_eq=c.b, bounds=(None, None), method="highs") for s in (1.0, -1.0)
    ]
    if any(e.status != 0 for e in ends):
        return None
    return float(ends[0].fun), float(-ends[1].fun)
