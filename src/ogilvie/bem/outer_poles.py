"""Poles that all entries of the outer domain's map share, and the damped oscillators that have these poles."""

from typing import Any

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

from ogilvie.memory.common_poles import compressed, modal, one_each, stable

Array = NDArray[Any]

_ITERATIONS = 20
_SPREAD = (0.2, 20.0)  # of the first poles
_START_DAMPING = 0.3


def common_poles(omega: Array, L: Array, weight: Array, pairs: int) -> Array:
    """Return 2 `pairs` stable poles of the columns L (f, c), given at s = i omega, by relaxed vector fitting.

    Parameters
    ----------
    omega : (f,) array
    L : (f, c) complex array
    weight : (f,) array
        Of the errors.
    pairs : int

    References
    ----------
    Gustavsen and Semlyen (1999), IEEE Trans. Power Delivery 14(3); Gustavsen (2006), ibid. 21(3).

    Examples
    --------
    >>> w = np.linspace(0.1, 4.0, 40)
    >>> L = 1 / ((1j * w) ** 2 + 0.6j * w + 1.09)  # poles -0.3 +- i
    >>> common_poles(w, L[:, None], np.ones(40), 1).round(6)
    array([-0.3+1.j, -0.3-1.j])
    """
    upper = np.geomspace(*_SPREAD, pairs) * (1j - _START_DAMPING)
    poles = np.concatenate([upper, upper.conj()])
    for _ in range(_ITERATIONS):
        poles = stable(_relocated(1j * omega, L, weight, poles))
    return poles


def _relocated(s: Array, L: Array, weight: Array, poles: Array) -> Array:
    """Zeros of sigma(s) = c_0 + sum c_k / (s - a_k) for which sigma L is nearest to a sum over the same fractions."""
    F = _fractions(poles, s)
    n = F.shape[1]
    rows = [weight[:, None] * np.hstack([F, -h[:, None] * F, -h[:, None]]) for h in L.T]
    R = compressed(np.array([np.concatenate([x.real, x.imag]) for x in rows]), n)
    mean = np.concatenate([F.real.mean(axis=0), [1.0]])  # of Re sigma, to be 1: no trivial solution
    size = np.linalg.norm(R)
    M, rhs = np.vstack([R, size * mean]), np.concatenate([np.zeros(len(R)), [size]])
    scale = np.linalg.norm(M, axis=0)
    c = np.linalg.lstsq(M / scale, rhs, rcond=None)[0] / scale
    A, b = modal(poles)
    zeros = np.linalg.eigvals(A - np.outer(b, c[:n]) / c[n])
    return np.where(np.abs(zeros.imag) < 1e-12 * np.abs(zeros), zeros.real, zeros)


def _fractions(poles: Array, s: Array) -> Array:
    """Real basis (f, n) of partial fractions, in the order of `modal`."""
    columns = []
    for a in one_each(poles):
        f = 1 / (s - a)
        g = 1 / (s - a.conjugate())
        columns += [(f + g) / 2, 1j * (f - g) / 2] if a.imag > 0 else [f]
    return np.stack(columns, axis=1)


def damped_oscillators(poles: Array) -> tuple[Array, Array]:
    """Return w (n,) and d (n,) of the n oscillators on one damper, s^2 + s d d^T + W^2, that have these 2n stable poles.

    Notes
    -----
    With p(s) = prod (s - a), the determinant is p. Where the phase of p(i omega), which grows from 0 to n pi, passes
    (k - 1/2) pi the even part of p is zero: these are the w_k (Hermite and Biehler: any stable p has n of them). From the
    partial fractions odd/even = sum s d_k^2 / (s^2 + w_k^2) follows d_k^2 = 2 / (d phase / d omega) at w_k.

    Examples
    --------
    >>> damped_oscillators(np.array([-0.3 + 1.0j, -0.3 - 1.0j]))  # w^2 = 1.09, d^2 = 0.6
    (array([1.044...]), array([0.774...]))
    """
    w = np.array([_passes(poles, (k + 0.5) * np.pi) for k in range(len(poles) // 2)])
    rate = (-poles.real / ((w[:, None] - poles.imag) ** 2 + poles.real**2)).sum(axis=1)
    return w, np.sqrt(2 / rate)


def phase(poles: Array, omega: Array) -> Array:
    """Return the phase of prod (i omega - a), (f,), from 0 at omega = 0 on."""
    return np.asarray(np.arctan2(omega[:, None] - poles.imag, -poles.real).sum(axis=1))


def _passes(poles: Array, level: float) -> float:
    """Frequency at which the phase is `level`."""
    size = np.abs(poles)
    low, high = np.log(1e-6 * size.min()), np.log(1e6 * size.max())
    return float(np.exp(scipy.optimize.brentq(lambda x: phase(poles, np.exp([x]))[0] - level, low, high, xtol=1e-13)))
