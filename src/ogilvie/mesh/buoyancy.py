"""Buoyancy of a closed hull in any pose in still water, from its triangles (kernel: plain arrays in, plain arrays out)."""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.mesh.integrals import triangles
from ogilvie.mesh.panels import PanelMesh

Array = NDArray[Any]


def corners(hull: PanelMesh) -> Array:
    """Return the triangles (n, 3, 3) of a hull without mirror images, those without area left out, m."""
    p = hull.vertices[triangles(hull.faces)]
    S = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    return np.ascontiguousarray(p[np.linalg.norm(S, axis=1) > 0.0])


@njit(cache=True, nogil=True)
def immersed_integrals(p: Array, z: float, phi: float, theta: float) -> Array:
    """Return volume and moments of the part of a closed hull below still water.

    Parameters
    ----------
    p : (n, 3, 3) array
        Triangles in body axes, anticlockwise from outside, m.
    z, phi, theta : float
        Height of the body's origin, m, roll and pitch, rad.

    Returns
    -------
    (4,) array
        Volume V, m3, and V times its centroid x, y, z in horizontal axes (still water z = 0, x and y from the body's
        origin), m4.

    Notes
    -----
    With n_z the vertical part of the normal, V = int n_z z dS, V x_b = int n_z x z dS, V z_b = int n_z z^2 / 2 dS over what is
    wet of each triangle, 3 or 4 corners after the cut; the waterplane adds nothing. Exact for the faceted hull.

    Examples
    --------
    >>> from ogilvie.mesh.deck import decked
    >>> from ogilvie.mesh.shapes import box
    >>> barge = corners(decked(box(4.0, 2.0, 3.0, panels=12).translated((0, 0, 1.0))))
    >>> (immersed_integrals(barge, -0.5, 0.0, 0.0) + 0.0).round(12).tolist()
    [20.0, 0.0, 0.0, -25.0]
    """
    cf, sf, ct, st = np.cos(phi), np.sin(phi), np.cos(theta), np.sin(theta)
    out = np.zeros(4)
    q, w = np.empty((3, 3)), np.empty((4, 3))
    for t in range(p.shape[0]):
        wet = 0
        for i in range(3):
            x, y, h = p[t, i, 0], p[t, i, 1], p[t, i, 2]
            q[i, 2] = z - st * x + ct * (sf * y + cf * h)
            if q[i, 2] < 0.0:
                wet += 1
            q[i, 0] = ct * x + st * (sf * y + cf * h)
            q[i, 1] = cf * y - sf * h
        if wet == 0:
            continue
        n = 0
        for i in range(3):
            j = (i + 1) % 3
            if q[i, 2] < 0.0:
                w[n] = q[i]
                n += 1
            if (q[i, 2] < 0.0) != (q[j, 2] < 0.0):
                f = q[i, 2] / (q[i, 2] - q[j, 2])
                w[n] = q[i] + f * (q[j] - q[i])
                w[n, 2] = 0.0
                n += 1
        for k in range(1, n - 1):  # a fan of triangles (0, k, k + 1)
            a, b, c = w[0], w[k], w[k + 1]
            S = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
            sz = a[2] + b[2] + c[2]
            out[0] += S * sz / 3.0
            for i in range(3):
                square = a[i] * a[2] + b[i] * b[2] + c[i] * c[2] + (a[i] + b[i] + c[i]) * sz
                out[1 + i] += S * square / (12.0 if i < 2 else 24.0)
    return out


@njit(cache=True, nogil=True)
def potential_energy(p: Array, mass: float, cog: Array, z: float, phi: float, theta: float) -> float:
    """Return the energy of weight and buoyancy over rho g, m4: mass z_G - V z_b, with the mass over rho (m3)."""
    cf, sf, ct, st = np.cos(phi), np.sin(phi), np.cos(theta), np.sin(theta)
    height = z - st * cog[0] + ct * (sf * cog[1] + cf * cog[2])
    return mass * height - immersed_integrals(p, z, phi, theta)[3]


@njit(cache=True, nogil=True)
def energy_gradient(p: Array, mass: float, cog: Array, z: float, phi: float, theta: float) -> Array:
    """Return the derivatives (3,) of :func:`potential_energy` by z, phi and theta: minus the generalised restoring forces.

    Notes
    -----
    dE/dz = m - V; dE/dphi = (m y_G - V y_b) cos theta; dE/dtheta = V x_b - m x_G, horizontal distances from the body's origin.
    """
    cf, sf, ct, st = np.cos(phi), np.sin(phi), np.cos(theta), np.sin(theta)
    I = immersed_integrals(p, z, phi, theta)
    x = ct * cog[0] + st * (sf * cog[1] + cf * cog[2])
    y = cf * cog[1] - sf * cog[2]
    return np.array([mass - I[0], (mass * y - I[2]) * ct, I[1] - mass * x])
