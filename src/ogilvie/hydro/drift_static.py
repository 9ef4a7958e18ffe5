"""The quadratic part of the still water's pressure on a body that moves: rotations of second order (kernel).

    F = rho g integral of [ <X_z (R x n)> + <(H x)_z> n + z <H> n ] dS
    M = rho g integral of [ <X_z (T x n + R x (x x n))> + <(H x)_z> x x n + z ( <H> (x x n) + <T x (R x n)> ) ] dS

over the mean wetted hull, n into the fluid, X = T + R x x. All of it follows from the integrals of n_i, n_i x_j, n_i x_j x_k.
"""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.drift_forms import EPSILON, cross_mean, outer_mean

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Rotation = Literal["ZYX", "XYZ"]
Moments = tuple[Array, Array, Array]


def second_rotation(products: Complex, rotation: Rotation) -> Complex:
    """Return H, the quadratic part of the rotation matrix, from products of angles.

    Parameters
    ----------
    products : (..., 3, 3) array
        <a_i a_j> of the angles about x, y, z; symmetric.
    rotation : {"ZYX", "XYZ"}
        R = Rz Ry Rx (this package, Fossen) or Rx Ry Rz (WAMIT).

    Returns
    -------
    (..., 3, 3) array

    Notes
    -----
    With S_i the matrix of e_i x (...), every R_i is 1 + a_i S_i + a_i^2 S_i^2/2. So H has the squares on its diagonal and
    a_i a_j S_i S_j off it, in the order of the factors; S_x S_y = e_y e_x^T. For Rx Ry Rz H is therefore lower triangular, for
    Rz Ry Rx upper triangular, with the same numbers.

    Examples
    --------
    >>> second_rotation(np.outer([0.1, 0.2, 0.0], [0.1, 0.2, 0.0]), "ZYX").round(3)
    array([[-0.02 ,  0.02 ,  0.   ],
           [ 0.   , -0.005,  0.   ],
           [ 0.   ,  0.   , -0.025]])
    """
    square = np.einsum("...ii->...i", products)
    H = np.zeros_like(products)
    for i in range(3):
        H[..., i, i] = -0.5 * (square.sum(axis=-1) - square[..., i])
    for i, j in ((0, 1), (0, 2), (1, 2)):
        place = (..., i, j) if rotation == "ZYX" else (..., j, i)
        H[place] = products[..., i, j]
    return H


def static_force(motion: Complex, moments: Moments, *, rotation: Rotation, rho: float, g: float) -> Complex:
    """Return the quadratic hydrostatic force and moment about the fixed origin (n_b, n_b, 6).

    Parameters
    ----------
    motion : (n_b, 6) complex array
        Motion of O per metre of wave amplitude.
    moments : tuple of (3,), (3, 3), (3, 3, 3) arrays
        Integrals of n_i, n_i x_j, n_i x_j x_k over the whole wetted hull.
    rotation : {"ZYX", "XYZ"}
    rho, g : float
    """
    M0, M1, M2 = moments
    T, R = motion[:, :3], motion[:, 3:]
    N0 = np.einsum("iab,ba->i", EPSILON, M1)  # integral of x x n
    N1 = np.einsum("iab,baj->ij", EPSILON, M2)  # integral of (x x n)_i x_j
    tilt = np.stack([-R[:, 1], R[:, 0], np.zeros_like(R[:, 0])], axis=1)  # gradient of X_z
    rise_n = T[:, 2:] * M0 + tilt @ M1.T  # integral of X_z n
    rise_m = T[:, 2:] * N0 + tilt @ N1.T
    H = second_rotation(outer_mean(R, R), rotation)
    force = cross_mean(R, rise_n) + H[..., 2, :] @ M1.T + H @ M1[:, 2]
    moment = cross_mean(T, rise_n) + cross_mean(R, rise_m) + H[..., 2, :] @ N1.T + H @ N1[:, 2]
    moment = moment + _double_cross(outer_mean(T, R), M1[:, 2])
    return np.asarray(rho * g * np.concatenate([force, moment], axis=-1), dtype=complex)


def _double_cross(products: Complex, v: Array) -> Complex:
    """Return <T x (R x v)> = <R (T . v)> - <T . R> v from products <T_i R_j> (..., 3, 3)."""
    return np.asarray(products.swapaxes(-1, -2) @ v - np.einsum("...ii->...", products)[..., None] * v, dtype=complex)
