"""The incident wave on the hull: its own force (Froude-Krylov) and the normal velocity that the body must undo (kernel).

zeta = Re exp(i(omega t - k (x cos b + y sin b))); phi_0 = (i g/omega) f(z) exp(-i k (x cos b + y sin b)) with
f = cosh k(z + h)/cosh kh.
"""

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.bem_panels import HullPanels

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


def incident(
    panels: HullPanels, *, omega: float, k: float, direction: Array, depth: float, rho: float, g: float
) -> tuple[Complex, Complex]:
    """Return the Froude-Krylov force (n_b, 6) and the normal velocity of the wave, d phi_0/d n (n_b, n_c, n_hull).

    Parameters
    ----------
    panels : HullPanels
    omega, k : float
        Frequency, rad/s, and wavenumber, rad/m, of the incident wave.
    direction : (n_b,) array
        Direction the waves travel to, rad.
    depth, rho, g : float

    Notes
    -----
    F_i = -rho g integral of f exp(-ik(...)) n_i dS. Force and velocity are integrated over each panel by a rule of degree two
    or more; the velocity is the mean over the panel.
    """
    points, weights = panels.quadrature
    n = panels.hull.normals
    loads = _loads(points, weights, n)
    f, df = profile(points[:, :, 2], k, depth)
    cos, sin = np.cos(direction)[:, None], np.sin(direction)[:, None]
    force = np.zeros((len(direction), 6), dtype=complex)
    velocity = np.empty((len(direction), len(panels.images), panels.n_hull), dtype=complex)
    x, y = points[:, :, 0].ravel(), points[:, :, 1].ravel()
    for c, (sx, sy, _) in enumerate(panels.images):
        phase = np.exp(-1j * k * (sx * x * cos + sy * y * sin)).reshape(-1, *weights.shape)
        pressure = f * phase
        force -= rho * g * panels.dof_signs[c] * np.einsum("bnq,nqi->bi", pressure, loads, optimize=True)
        level, slope = np.sum(pressure * weights, axis=2), np.sum(df * phase * weights, axis=2)
        flux = -1j * k * (sx * n[:, 0] * cos + sy * n[:, 1] * sin) * level + n[:, 2] * slope
        velocity[:, c] = 1j * g / omega * flux / panels.hull.areas
    return force, velocity


def _loads(points: Array, weights: Array, n: Array) -> Array:
    """Return (n, r x n) dS at the quadrature points (n_hull, 4, 6)."""
    normal = np.broadcast_to(n[:, None, :], points.shape)
    return weights[:, :, None] * np.concatenate([normal, np.cross(points, normal)], axis=2)


def profile(z: Array, k: float, depth: float) -> tuple[Array, Array]:
    """Return f = cosh k(z + h)/cosh kh and df/dz, without overflow."""
    if np.isinf(depth):
        f = np.exp(k * z)
        return f, k * f
    up, down = np.exp(k * z), np.exp(-k * (z + 2.0 * depth))
    scale = 1.0 / (1.0 + np.exp(-2.0 * k * depth))
    return (up + down) * scale, k * (up - down) * scale
