"""Mean drift by integration of the pressure over the hull (near field): all six components, term by term (kernel).

    F = -int [ <p2> n + <p1 (R x n)> + p0 <H> n ] dS - rho g/2 oint <zeta_r^2> n (1 - n_z^2)^(-1/2) dl
    p0 = -rho g z,  p1 = -rho (phi_t + g X_z),  p2 = -rho [ |grad phi|^2/2 + X . grad phi_t + g (H x)_z ]

with n into the fluid, X = T + R x x, zeta_r = eta - X_z; the moment about the fixed mean origin has x x n in place of n and
T x n + R x (x x n) in place of R x n (docs/theory/drift.md).
"""

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.drift_first import FirstOrder, WaterlineRule
from ogilvie.hydro.drift_forms import cross_mean, integral, with_moment
from ogilvie.hydro.drift_static import Rotation, static_force

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


def near_field(first: FirstOrder, *, rotation: Rotation, waterline: WaterlineRule) -> dict[str, Complex]:
    """Return the terms (n_b, n_b, 6) of the mean force and moment about the fixed origin; the drift is their sum.

    Parameters
    ----------
    first : FirstOrder
    rotation : {"ZYX", "XYZ"}
    waterline : {"edge", "centre"}

    Returns
    -------
    dict
        waterline, velocity (|grad phi|^2), displacement (X . grad phi_t), rotation (first-order pressure on a turned hull),
        static (still water on the motions of second order).
    """
    w, hull = first.wave, first.hull
    dS = with_moment(hull.centers, hull.normals * hull.areas[:, None])
    v = first.velocity
    X = displacement(first.motion, hull.centers)
    velocity = np.sum([integral(v[..., i], v[..., i], dS) for i in range(3)], axis=0)
    shifted = np.sum([integral(X[..., i], 1j * w.omega * v[..., i], dS) for i in range(3)], axis=0)
    return {
        "waterline": waterline_force(first, waterline),
        "velocity": 0.5 * w.rho * velocity,
        "displacement": w.rho * shifted,
        "rotation": w.rho * _turned(first.motion, 1j * w.omega * first.potential @ dS),
        "static": static_force(first.motion, hull.panels.hull.moments, rotation=rotation, rho=w.rho, g=w.g),
    }


def waterline_force(first: FirstOrder, rule: WaterlineRule) -> Complex:
    """Return -rho g/2 oint <zeta_r^2> n/(1 - n_z^2)^(1/2) dl and its moment (n_b, n_b, 6)."""
    w, line = first.wave, first.hull.waterline
    if len(line.owner) == 0:
        return np.zeros((len(w.directions),) * 2 + (6,), dtype=complex)
    eta = -1j * w.omega / w.g * first.at_waterline(rule)
    relative = eta - displacement(first.motion, line.middle)[..., 2]
    dl = with_moment(line.middle, line.normal * line.length[:, None])
    return np.asarray(-0.5 * w.rho * w.g * integral(relative, relative, dl))


def displacement(motion: Complex, x: Array) -> Complex:
    """Return T + R x x (n_b, n, 3) at points (n, 3)."""
    return np.asarray(motion[:, None, :3] + np.cross(motion[:, None, 3:], x[None]))


def _turned(motion: Complex, loads: Complex) -> Complex:
    """Return <R x P>, <T x P + R x Q> of first-order loads (P, Q) = integral of phi_t (n, x x n) dS, (n_b, 6)."""
    T, R, P, Q = motion[:, :3], motion[:, 3:], loads[:, :3], loads[:, 3:]
    return np.concatenate([cross_mean(R, P), cross_mean(T, P) + cross_mean(R, Q)], axis=-1)
