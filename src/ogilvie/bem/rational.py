"""Oscillators with a few strong dampers over one time step, by a rational function of the matrix that contracts."""

from functools import cache
from math import factorial
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

DEGREE = 5  # poles of the rational function; one is real, the others are pairs


class RationalStep:
    """exp(h A) x for A = [[0, W], [-W, -O O.T]], to order 2 DEGREE - 1 in h.

    Parameters
    ----------
    W : (n,) array
        Frequencies, >= 0.
    O : (n, r) array
        Dampers.
    h : float
        Step.

    Notes
    -----
    The Pade approximation R of exp with DEGREE - 1 zeros and DEGREE poles p_j is that of the Radau IIA methods: |R(z)| <= 1 for
    Re z <= 0, R(inf) = 0. As x.T A x <= 0, von Neumann's theorem gives |R(h A) x| <= |x|: no step can make anything grow,
    however strong the dampers. In partial fractions R(h A) = sum_j c_j (h A - p_j)^-1; without dampers each term is diagonal
    in pairs, and the r dampers change it by a matrix of rank r (Woodbury): a step costs O(n r), and no matrix is formed.

    References
    ----------
    Hairer, Wanner, Solving Ordinary Differential Equations II, secs. IV.3-IV.5, IV.11.

    Examples
    --------
    >>> step = RationalStep(np.array([2.0]), np.zeros((1, 0)), 0.5)
    >>> step(np.array([[0.0], [1.0]])).round(7).tolist(), [round(float(f(1.0)), 7) for f in (np.sin, np.cos)]
    ([[0.841471], [0.5403023]], [0.841471, 0.5403023])
    """

    def __init__(self, W: Array, O: Array, h: float) -> None:
        self.n, self.O, self.terms = len(W), O, []
        for pole, residue in poles():
            bottom = pole**2 + (h * W) ** 2
            same, turn = -pole / bottom, h * W / bottom  # (h A0 - p)^-1 = [[same, -turn], [turn, same]]
            inner = np.linalg.inv(np.eye(O.shape[1]) - h * O.T @ (same[:, None] * O))
            self.terms.append((same[:, None], turn[:, None], h * O @ inner, residue))

    def __call__(self, x: Array) -> Array:
        """Return exp(h A) x for columns x (2 n, k): W times positions, then velocities."""
        p, v = x[: self.n], x[self.n :]
        out_p, out_v = np.zeros_like(p), np.zeros_like(v)
        for same, turn, back, residue in self.terms:
            y_v = turn * p + same * v
            force = back @ (self.O.T @ y_v)
            out_p += (residue * (same * p - turn * (v + force))).real
            out_v += (residue * (y_v + same * force)).real
        return np.concatenate([out_p, out_v])


@cache
def poles() -> list[tuple[complex, complex]]:
    """Return poles in the upper half plane with their residues (twice those of pairs) of the Pade approximation of exp."""
    k, m = DEGREE - 1, DEGREE
    top = [factorial(k + m - i) * factorial(k) / (factorial(k + m) * factorial(i) * factorial(k - i)) for i in range(k + 1)]
    bottom = [
        (-1) ** i * factorial(k + m - i) * factorial(m) / (factorial(k + m) * factorial(i) * factorial(m - i))
        for i in range(m + 1)
    ]
    P, Q = np.polynomial.Polynomial(top), np.polynomial.Polynomial(bottom)
    out = []
    for root in np.asarray(Q.roots(), dtype=complex):
        if root.imag > -1e-9:
            pair = 2.0 if root.imag > 1e-9 else 1.0
            out.append((complex(root), complex(pair * P(root) / Q.deriv()(root))))
    return out
