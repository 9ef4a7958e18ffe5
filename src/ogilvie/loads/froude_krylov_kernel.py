"""Compiled: weight and buoyancy of a hull cut by still water, and what waves add to them."""

import numpy as np
from numba import njit

from ogilvie.loads.incident_kernel import incident
from ogilvie.loads.kernel import ETA, ROTATION, load_kernel
from ogilvie.loads.wet_panels import add_wet_force

#: Numbers before the vertices: counts of vertices and triangles, rho g, weight (N), centre of gravity (3).
HULL = 7

_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, nogil=True, fastmath=_FAST)
def is_somewhere(x):
    """Return whether the pose is finite and near the water at all; places in tables are taken from it."""
    good = abs(x[ETA + 2]) < 1e9
    for i in range(9):
        good = good and abs(x[ROTATION + i]) < 1.5
    return good


@njit(cache=True, nogil=True, fastmath=_FAST)
def parts(data):
    """Return vertices (3, n), triangles (3, m) and vertex weights (6, n) of a hull."""
    n, m = int(data[0]), int(data[1])
    a, b = HULL + 3 * n, HULL + 3 * n + 3 * m
    return data[HULL:a].reshape((3, n)), data[a:b].reshape((3, m)), data[b : b + 6 * n].reshape((6, n))


@njit(cache=True, nogil=True, fastmath=_FAST)
def heights(x, vertices, out):
    """Fill the heights (n,) of the vertices over still water."""
    r = x[ROTATION:]
    for v in range(out.shape[0]):
        out[v] = x[ETA + 2] + r[6] * vertices[0, v] + r[7] * vertices[1, v] + r[8] * vertices[2, v]


@load_kernel
def still_force(x, data, own, force):
    """Weight and buoyancy in still water."""
    if not is_somewhere(x):
        force[:] = np.nan
        return
    vertices, triangles, weights = parts(data)
    depth = np.empty(vertices.shape[1])
    heights(x, vertices, depth)
    for v in range(depth.shape[0]):
        depth[v] = -depth[v]
    add_wet_force(vertices, triangles, weights, depth, depth, True, data[2], force)
    fx, fy, fz = -data[3] * x[ROTATION + 6], -data[3] * x[ROTATION + 7], -data[3] * x[ROTATION + 8]
    force[0] += fx
    force[1] += fy
    force[2] += fz
    force[3] += data[5] * fz - data[6] * fy
    force[4] += data[6] * fx - data[4] * fz
    force[5] += data[4] * fy - data[5] * fx


@load_kernel
def incident_force(x, data, own, force):
    """Pressure force in waves less that in still water; data: kind of surface, zero pressure on it, length of the hull's."""
    if not is_somewhere(x):
        force[:] = np.nan
        return
    hull = data[3 : 3 + int(data[2])]
    vertices, triangles, weights = parts(hull)
    n = vertices.shape[1]
    X, Y, Z, depth = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    zeta, head = np.empty(n), np.empty(n)
    r = x[ROTATION:]
    for v in range(n):
        X[v] = r[0] * vertices[0, v] + r[1] * vertices[1, v] + r[2] * vertices[2, v]
        Y[v] = r[3] * vertices[0, v] + r[4] * vertices[1, v] + r[5] * vertices[2, v]
    heights(x, vertices, Z)
    if not incident(x, data[3 + int(data[2]) :], own, X, Y, Z, zeta, head):
        force[:] = np.nan
        return
    for v in range(n):
        depth[v] = -Z[v]
        head[v] -= Z[v]
        zeta[v] = zeta[v] - Z[v] if data[0] > 0.5 else depth[v]
    add_wet_force(vertices, triangles, weights, zeta, head, data[1] > 0.5, hull[2], force)
    add_wet_force(vertices, triangles, weights, depth, depth, True, -hull[2], force)
