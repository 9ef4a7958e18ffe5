"""Rotations, change of reference point, and the two axis conventions of the field.

Axes: x forward, y port, z up. ``eta = (x, y, z, phi, theta, psi)`` in the world,
``nu`` in the body. R = Rz(psi) Ry(theta) Rx(phi).
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

#: Turns a 6-vector of z-up axes (y port) into Fossen's z-down axes (y starboard) and back: it is its own inverse.
Z_DOWN = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])


def rotation_matrix(phi: float, theta: float, psi: float) -> Array:
    """Return the (3, 3) matrix R = Rz(psi) Ry(theta) Rx(phi) that turns body components into world components.

    Parameters
    ----------
    phi, theta, psi : float
        Roll, pitch and yaw, rad.

    References
    ----------
    Paper C (Vu), Eq. (5).

    Examples
    --------
    >>> rotation_matrix(0.0, 0.0, np.pi / 2).round(12) @ [1.0, 0.0, 0.0]
    array([0., 1., 0.])
    """
    cf, sf, ct, st, cp, sp = np.cos(phi), np.sin(phi), np.cos(theta), np.sin(theta), np.cos(psi), np.sin(psi)
    return np.array(
        [
            [cp * ct, -sp * cf + cp * st * sf, sp * sf + cp * st * cf],
            [sp * ct, cp * cf + sp * st * sf, -cp * sf + sp * st * cf],
            [-st, ct * sf, ct * cf],
        ]
    )


def euler_rate_matrix(phi: float, theta: float) -> Array:
    """Return the (3, 3) matrix T that turns body rates (p, q, r) into rates of the Euler angles.

    References
    ----------
    Paper C (Vu), Eq. (6). Singular at theta = +-90 deg.

    Examples
    --------
    >>> bool(np.all(euler_rate_matrix(0.0, 0.0) == np.eye(3)))
    True
    """
    cf, sf, ct, tt = np.cos(phi), np.sin(phi), np.cos(theta), np.tan(theta)
    return np.array([[1.0, sf * tt, cf * tt], [0.0, cf, -sf], [0.0, sf / ct, cf / ct]])


def skew(r: ArrayLike) -> Array:
    """Return the (3, 3) matrix S(r) with S(r) v = r x v.

    Examples
    --------
    >>> skew([0.0, 0.0, 2.0]) @ [1.0, 0.0, 0.0]
    array([0., 2., 0.])
    """
    x, y, z = np.asarray(r, dtype=float)
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def shift_matrix(r: ArrayLike) -> Array:
    """Return the (6, 6) matrix H(r): the velocity at the point r is ``H(r) @ velocity at the origin``.

    A force 6-vector at r becomes ``H(r).T @ force`` about the origin.

    Examples
    --------
    >>> shift_matrix([1.0, 0.0, 0.0]) @ [0, 0, 0, 0, 0, 1.0]  # yaw moves a point ahead to port
    array([0., 1., 0., 0., 0., 1.])
    """
    H = np.eye(6)
    H[:3, 3:] = -skew(r)
    return H


def about_origin(matrix: ArrayLike, point: ArrayLike) -> Array:
    """Move a (..., 6, 6) matrix given about `point` (position in the axes of the origin, m) to the origin: H(-p)^T M H(-p).

    With p the old reference point, the velocity there is H(p) nu, so M_O = H(p)^T M_p H(p).

    Examples
    --------
    >>> M = about_origin(np.diag([2.0, 2.0, 2.0, 0, 0, 0]), [0.0, 0.0, -1.0])
    >>> float(M[3, 3]), float(M[0, 4])  # m z^2 and m z
    (2.0, -2.0)
    """
    H = shift_matrix(point)
    return H.T @ np.asarray(matrix, dtype=float) @ H


def coriolis_matrix(M: ArrayLike, nu: ArrayLike) -> Array:
    """Return the (6, 6) Coriolis-centripetal matrix C(nu) of a symmetric inertia matrix, with nu^T C(nu) nu = 0.

    Notes
    -----
    C = [[0, -S(a)], [-S(a), -S(b)]] with (a, b) = M nu.

    References
    ----------
    Paper C (Vu), Eqs. (13), (28); m2c of the Marine Systems Simulator.

    Examples
    --------
    >>> nu = np.arange(1.0, 7.0)
    >>> M = np.diag([1.0, 2, 3, 4, 5, 6])
    >>> bool(abs(nu @ coriolis_matrix(M, nu) @ nu) < 1e-12)
    True
    """
    momentum = np.asarray(M, dtype=float) @ np.asarray(nu, dtype=float)
    C = np.zeros((6, 6))
    C[:3, 3:] = C[3:, :3] = -skew(momentum[:3])
    C[3:, 3:] = -skew(momentum[3:])
    return C


def to_z_down(value: ArrayLike) -> Array:
    """Turn a (..., 6) vector or, for the last two axes 6 x 6, a matrix from z-up to Fossen's z-down axes (or back).

    Notes
    -----
    T = diag(1, -1, -1, 1, -1, -1): v' = T v. For matrices use :func:`matrix_to_z_down`.

    Examples
    --------
    >>> to_z_down([1.0, 1, 1, 1, 1, 1])
    array([ 1., -1., -1.,  1., -1., -1.])
    """
    return np.asarray(value) * Z_DOWN


def matrix_to_z_down(M: ArrayLike) -> Array:
    """Turn (..., 6, 6) matrices from z-up to Fossen's z-down axes (or back): M' = T M T.

    Examples
    --------
    >>> float(matrix_to_z_down(np.ones((6, 6)))[0, 4])
    -1.0
    """
    return np.asarray(M) * Z_DOWN[:, None] * Z_DOWN[None, :]
