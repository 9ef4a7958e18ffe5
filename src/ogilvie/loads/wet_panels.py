"""Pressure integrated over what is wet of a hull whose triangles a water surface cuts (kernel: arrays and floats only).

The pressure is known at the vertices, as a head over rho g, and linear between them; so is the height of the surface above the
hull, whose zero cuts a triangle. Integrals over whole triangles are weights of their vertices, made beforehand.
"""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[Any]

_FAST = {"reassoc", "contract", "nsz", "arcp"}


def vertex_weights(vertices: Array, triangles: NDArray[np.int64]) -> Array:
    """Return the force and moment (n, 6) of a unit head at each vertex, linear over the triangles around it; m2, m3.

    Notes
    -----
    With S the area vector (outward) and P_i the heads of the corners r_i: force - S sum P_i / 3, moment
    - sum_i r_i (P_i + sum P) / 12 x S.

    Examples
    --------
    >>> corners = np.array([[0.0, 0, 0], [3, 0, 0], [0, 3, 0]])
    >>> (vertex_weights(corners, np.array([[0, 1, 2]])).sum(axis=0) + 0.0).tolist()
    [0.0, 0.0, -4.5, -4.5, 4.5, 0.0]
    """
    p = vertices[triangles]
    S = 0.5 * np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    total = p.sum(axis=1)
    weights = np.zeros((len(vertices), 6))
    for i in range(3):
        np.add.at(weights[:, :3], triangles[:, i], -S / 3.0)
        np.add.at(weights[:, 3:], triangles[:, i], -np.cross((p[:, i] + total) / 12.0, S))
    return weights


@njit(cache=True, nogil=True, fastmath=_FAST)
def add_triangle(q, i, j, k, scale, force):
    """Add scale times force and moment of the head q[:, 3] that is linear over the triangle of rows i, j, k of q (n, 4)."""
    ux, uy, uz = q[j, 0] - q[i, 0], q[j, 1] - q[i, 1], q[j, 2] - q[i, 2]
    vx, vy, vz = q[k, 0] - q[i, 0], q[k, 1] - q[i, 1], q[k, 2] - q[i, 2]
    h = 0.5 * scale
    sx, sy, sz = h * (uy * vz - uz * vy), h * (uz * vx - ux * vz), h * (ux * vy - uy * vx)
    a, b, c = q[i, 3], q[j, 3], q[k, 3]
    total = a + b + c
    force[0] -= sx * total / 3.0
    force[1] -= sy * total / 3.0
    force[2] -= sz * total / 3.0
    a, b, c = (a + total) / 12.0, (b + total) / 12.0, (c + total) / 12.0
    rx = a * q[i, 0] + b * q[j, 0] + c * q[k, 0]
    ry = a * q[i, 1] + b * q[j, 1] + c * q[k, 1]
    rz = a * q[i, 2] + b * q[j, 2] + c * q[k, 2]
    force[3] -= ry * sz - rz * sy
    force[4] -= rz * sx - rx * sz
    force[5] -= rx * sy - ry * sx


@njit(cache=True, nogil=True, fastmath=_FAST)
def add_wet_force(vertices, triangles, weights, level, head, free, scale, force):
    """Add scale times force and moment about O, in the axes of the vertices, of the head over the wet surface.

    Parameters
    ----------
    vertices : (3, n) array
        m.
    triangles : (3, m) array
        Corners, anticlockwise from the fluid, as whole numbers kept as floats.
    weights : (6, n) array
        Of :func:`vertex_weights`.
    level, head : (n,) array
        Height of the surface above each vertex, m, positive where it is wet; pressure there over rho g, m.
    free : bool
        The head is zero where the surface cuts the hull; otherwise interpolated there.
    scale : float
        rho g, or minus that.
    force : (6,) array
    """
    total = np.zeros(6)
    for i in range(6):
        s = 0.0
        for v in range(level.shape[0]):
            s += (head[v] if level[v] > 0.0 else 0.0) * weights[i, v]
        total[i] = s
    q, w = np.empty((3, 4)), np.empty((4, 4))
    for t in range(triangles.shape[1]):
        a, b, c = int(triangles[0, t]), int(triangles[1, t]), int(triangles[2, t])
        wet = (level[a] > 0.0) + (level[b] > 0.0) + (level[c] > 0.0)
        if wet == 1 or wet == 2:
            _add_cut(vertices, level, head, free, a, b, c, q, w, total)
    for i in range(6):
        force[i] += scale * total[i]


@njit(cache=True, nogil=True, fastmath=_FAST)
def _add_cut(vertices, level, head, free, a, b, c, q, w, total):
    """Replace what the weights of the wet corners gave for a cut triangle by the integral over its wet part."""
    corners = (a, b, c)
    for i in range(3):
        v = corners[i]
        for p in range(3):
            q[i, p] = vertices[p, v]
        q[i, 3] = head[v] if level[v] > 0.0 else 0.0
    add_triangle(q, 0, 1, 2, -1.0, total)
    n = 0
    for i in range(3):
        here, there = corners[i], corners[(i + 1) % 3]
        l, m = level[here], level[there]
        if l > 0.0:
            for p in range(4):
                w[n, p] = q[i, p]
            n += 1
        if (l > 0.0) != (m > 0.0):
            f = l / (l - m)
            for p in range(3):
                w[n, p] = vertices[p, here] + f * (vertices[p, there] - vertices[p, here])
            w[n, 3] = 0.0 if free else head[here] + f * (head[there] - head[here])
            n += 1
    for k in range(1, n - 1):
        add_triangle(w, 0, k, k + 1, 1.0, total)
