"""Compiled: potentials of a flat triangle or quadrilateral with constant source or dipole density (kernel: arrays and floats).

With h the height of the field point above the panel's plane along its normal, t_e its distance inside of edge e (length l_e) in
the plane and r_1, r_2 those from the ends of the edge,

    int dS/r = sum_e t_e ln((r_1 + r_2 + l_e)/(r_1 + r_2 - l_e)) - h W,   int d/dn_q (1/r) dS = W,

W the solid angle of the panel as seen from the point, positive on the side of the normal (J. L. Hess, A. M. O. Smith,
Calculation of potential flow about arbitrary bodies, Progress in Aeronautical Sciences 8 (1967); the angle of each
triangle by A. van Oosterom, J. Strackee, IEEE Transactions on Biomedical Engineering 30 (1983) 125-126).
"""

import numpy as np
from numba import njit, prange

_IN_PLANE = 1e-11  # heights below this part of the panel's size are zero


@njit(cache=True, nogil=True)
def _triangle_angle(a, b, c, p, q, r):
    """Return the solid angle of a triangle from vectors a, b, c to its corners at distances p, q, r."""
    det = (
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    )  # negative where the normal points towards the field point
    ab = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    ac = a[0] * c[0] + a[1] * c[1] + a[2] * c[2]
    bc = b[0] * c[0] + b[1] * c[1] + b[2] * c[2]
    return -2.0 * np.arctan2(det, p * q * r + ab * r + ac * q + bc * p)


@njit(cache=True, nogil=True)
def exact_panel(P, corners, normal, size, a, r):
    """Return the single and double layer of one panel; a (4, 3) and r (4,) are work space."""
    for e in range(4):
        square = 0.0
        for k in range(3):
            a[e, k] = corners[e, k] - P[k]
            square += a[e, k] * a[e, k]
        r[e] = np.sqrt(square)
    h = -(a[0, 0] * normal[0] + a[0, 1] * normal[1] + a[0, 2] * normal[2])
    S = 0.0
    for e in range(4):
        f = (e + 1) % 4
        dx, dy, dz = a[f, 0] - a[e, 0], a[f, 1] - a[e, 1], a[f, 2] - a[e, 2]
        length = np.sqrt(dx * dx + dy * dy + dz * dz)
        if length <= _IN_PLANE * size:
            continue
        mx, my, mz = dy * normal[2] - dz * normal[1], dz * normal[0] - dx * normal[2], dx * normal[1] - dy * normal[0]
        t = (a[e, 0] * mx + a[e, 1] * my + a[e, 2] * mz) / length
        s = r[e] + r[f]
        if s - length > 1e-15 * s:
            S += 2.0 * t * np.arctanh(length / s)  # half the logarithm, exact far away too
    if abs(h) <= _IN_PLANE * size:
        return S, 0.0
    W = _triangle_angle(a[0], a[1], a[2], r[0], r[1], r[2])
    if corners[2, 0] != corners[3, 0] or corners[2, 1] != corners[3, 1] or corners[2, 2] != corners[3, 2]:
        W += _triangle_angle(a[0], a[2], a[3], r[0], r[2], r[3])
    return S - h * W, W


@njit(cache=True, nogil=True, parallel=True)
def fill_influence(field, corners, centers, normals, areas, moments, sizes, near, far, S, D):
    """Fill S and D (n_field, n) of panels, exact within `near` sizes, with second moments within `far`, as points beyond.

    Notes
    -----
    With d from the panel's centroid to the point and M its second moments about the centroid (M n = 0),
    S = A/d + (3 dMd/d^5 - tr M/d^3)/2, D = dn [A/d^3 + (15 dMd/d^7 - 3 tr M/d^5)/2].
    """
    for i in prange(len(field)):
        a, r = np.empty((4, 3)), np.empty(4)
        P = field[i]
        for j in range(len(centers)):
            x, y, z = P[0] - centers[j, 0], P[1] - centers[j, 1], P[2] - centers[j, 2]
            d2 = x * x + y * y + z * z
            if d2 < (near * sizes[j]) ** 2:
                S[i, j], D[i, j] = exact_panel(P, corners[j], normals[j], sizes[j], a, r)
                continue
            q = 1.0 / d2
            root = np.sqrt(q)
            height = x * normals[j, 0] + y * normals[j, 1] + z * normals[j, 2]
            s, w = areas[j], areas[j]
            if d2 < (far * sizes[j]) ** 2:
                M = moments[j]
                form = M[0, 0] * x * x + M[1, 1] * y * y + M[2, 2] * z * z
                form = (form + 2.0 * (M[0, 1] * x * y + M[0, 2] * x * z + M[1, 2] * y * z)) * q
                trace = M[0, 0] + M[1, 1] + M[2, 2]
                s += 0.5 * (3.0 * form - trace) * q
                w += 0.5 * (15.0 * form - 3.0 * trace) * q
            S[i, j] = s * root
            D[i, j] = height * w * q * root
