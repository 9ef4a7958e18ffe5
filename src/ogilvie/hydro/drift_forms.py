"""Means of products of two first-order quantities, for every pair of wave directions (kernel).

With amplitudes c_m of the waves of direction m and frequency omega a quantity is a(t) = Re sum c_m a_m exp(i omega t), and

    <a b> = sum over m, n of c_m c_n* Q_mn,   Q_mn = (a_m b_n* + b_m a_n*)/4,

a Hermitian form; its diagonal, Re(a b*)/2, is the mean in waves of one direction.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

#: The permutation symbol.
EPSILON = np.zeros((3, 3, 3))
EPSILON[[0, 1, 2], [1, 2, 0], [2, 0, 1]] = 1.0
EPSILON[[0, 1, 2], [2, 0, 1], [1, 2, 0]] = -1.0


def mean(a: Complex, b: Complex) -> Complex:
    """Return <a b> (n_b, n_b) of quantities (n_b,), or (n_b, n_b, ...) of quantities (n_b, ...), entry by entry.

    Examples
    --------
    >>> mean(np.array([2.0, 1j]), np.array([1.0, 1j])).round(3).tolist()
    [[(1+0j), -0.75j], [0.75j, (0.5+0j)]]
    """
    return np.asarray(0.25 * (a[:, None] * b[None].conj() + b[:, None] * a[None].conj()))


def outer_mean(a: Complex, b: Complex) -> Complex:
    """Return <a_i b_j> (n_b, n_b, n, m) of vectors a (n_b, n), b (n_b, m)."""
    first, second = np.broadcast_arrays(a[:, :, None], b[:, None, :])
    return mean(first, second)


def cross_mean(a: Complex, b: Complex) -> Complex:
    """Return <a x b> (n_b, n_b, 3) of vectors (n_b, 3)."""
    return np.einsum("ijk,mnjk->mni", EPSILON, outer_mean(a, b))


def integral(a: Complex, b: Complex, weight: Array) -> Complex:
    """Return the integral of <a b> w.

    Parameters
    ----------
    a, b : (n_b, n_p) complex array
        At points.
    weight : (n_p, n) array
        Vectors, such as n dS.

    Returns
    -------
    (n_b, n_b, n) complex array
    """
    out = np.empty((len(a), len(a), weight.shape[1]), dtype=complex)
    same = a is b
    for i, w in enumerate(weight.T):
        half = 0.25 * (a * w) @ b.conj().T
        out[:, :, i] = half + (half if same else 0.25 * (b * w) @ a.conj().T)
    return out


def with_moment(x: Array, v: Array) -> Array:
    """Return (v, x x v) as (n, 6) for vectors v (n, 3) at points x (n, 3)."""
    return np.concatenate([v, np.cross(x, v)], axis=1)
