"""A stand-in for the outer domain: phi = 0 on the free surface outside the control hemisphere, at all times."""

from dataclasses import dataclass

import numpy as np
from scipy.special import lpmv


@dataclass(frozen=True)
class Still:
    m: int
    instantaneous: np.ndarray
    inputs: np.ndarray
    dampers: np.ndarray
    frequencies: np.ndarray


def still(m, count):
    """Potentials P_l^m / r^(l+1) with l - m odd: phi = -phi_r / (l + 1)."""
    return Still(m, np.diag(1.0 / (m + 2 + 2 * np.arange(count))), np.zeros((0, count)), np.zeros((0, 0)), np.zeros(0))


def odd_functions(m, x, count):
    """P_l^m(x), l = m + 1, m + 3, ..., orthonormal on 0..1."""
    t, w = np.polynomial.legendre.leggauss(60)
    t, w = 0.5 + 0.5 * t, 0.5 * w
    out = []
    for j in range(count):
        l = m + 1 + 2 * j
        out.append(lpmv(m, l, x) / np.sqrt(w @ lpmv(m, l, t) ** 2))
    return np.array(out)
