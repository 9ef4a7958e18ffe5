"""The wave part of the Green function near the free surface, exactly (kernel)."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_NODES = 64


def near_surface(r: Array, z: Array) -> Array:
    """Return I(r, z) (n_r, n_z) such that the real part of the Green function of deep water is 1/R + 1/R' + K I(Kr, Kz).

    Parameters
    ----------
    r : (n_r,) array
        Horizontal distance times K, > 0.
    z : (n_z,) array
        Sum of both heights times K, <= 0.

    Notes
    -----
    I obeys dI/dz = I + 2 (r^2 + z^2)^(-1/2), and I(r, 0) = -pi (H_0(r) + Y_0(r)) with the Struve function H_0, so that

        I(r, z) = exp(z) [-pi (H_0(r) + Y_0(r)) - 2 integral_0^arsinh(|z|/r) exp(r sinh s) ds].

    Numerical integration of the usual form loses up to 0.05 where |z| is much less than r, at the free surface, whatever r.

    Examples
    --------
    >>> near_surface(np.array([1.0]), np.array([0.0])).round(4)
    array([[-2.064]])
    """
    from scipy.special import struve, y0

    x, w = np.polynomial.legendre.leggauss(_NODES)
    top = np.arcsinh(-z[None, :] / r[:, None])
    s = 0.5 * top[..., None] * (x + 1.0)
    integral = 0.5 * top * (np.exp(r[:, None, None] * np.sinh(s)) @ w)
    at_surface = -np.pi * (struve(0, r) + y0(r))
    return np.asarray(np.exp(z) * (at_surface[:, None] - 2.0 * integral))
