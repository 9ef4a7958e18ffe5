"""Mean drift by the flow of momentum through a control surface, all six components (kernel).

    F = rho int_{C+S} [ <|grad phi|^2>/2 n - <grad phi phi_n> ] dS - rho oint <phi dX/dt x dl>
        + static - rho g/2 oint <zeta_r^2> n (1 - n_z^2)^(-1/2) dl

C is the control surface and S the still water between it and the hull, n out of the water there; the loops run along the
waterline. The moment has x x n, x x grad phi and x x (dX/dt x dl). No velocity on the hull appears: its integrals turn into the
loop by Gauss's and Stokes's theorems, so sharp edges do no harm (docs/theory/drift.md). On S phi_z = K phi, and the horizontal
force and the yaw moment of S are loops too.
"""

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.drift_first import FirstOrder, WaterlineRule
from ogilvie.hydro.drift_forms import EPSILON, integral, with_moment
from ogilvie.hydro.drift_near import displacement, waterline_force
from ogilvie.hydro.drift_solve import Fields
from ogilvie.hydro.drift_static import Rotation, static_force
from ogilvie.hydro.drift_surface import ControlSurface

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


def control_drift(
    first: FirstOrder, surface: ControlSurface, fields: Fields, *, rotation: Rotation, waterline: WaterlineRule
) -> dict[str, Complex]:
    """Return the terms (n_b, n_b, 6) of the mean force and moment about the fixed origin; the drift is their sum.

    Parameters
    ----------
    first : FirstOrder
    surface : ControlSurface
    fields : Fields
        The stored potentials at ``surface.points``.
    rotation, waterline
        As in :func:`ogilvie.hydro.drift_near.near_field`.

    Returns
    -------
    dict
        control (through C), surface (on S), loop (moving waterline), static, waterline. Where S is not a plain ring its
        heave, roll and pitch are NaN.
    """
    w, hull = first.wave, first.hull
    images = hull.panels.images
    phi, v = first.at(hull.copied(surface.points), fields)
    phis, vs = surface.split(phi, len(images)), surface.split(v, len(images))
    radial = surface.wall * [1.0, 1.0, 0.0] / surface.radius
    through = _flux(hull.copied(surface.wall), hull.copied(radial), np.tile(surface.d_wall, len(images)), vs[0])
    down = np.broadcast_to([0.0, 0.0, -1.0], surface.floor.shape)
    through = through + _flux(hull.copied(surface.floor), hull.copied(down), np.tile(surface.d_floor, len(images)), vs[1])
    return {
        "control": w.rho * through,
        "surface": w.rho * _free_surface(first, surface, phis, vs[2], waterline),
        "loop": -w.rho * _loop(first, waterline),
        "static": static_force(first.motion, hull.panels.hull.moments, rotation=rotation, rho=w.rho, g=w.g),
        "waterline": waterline_force(first, waterline),
    }


def _flux(x: Array, n: Array, d: Array, v: Complex) -> Complex:
    """Return the integral of <|v|^2>/2 (n, x x n) - <(v, x x v) v_n> (n_b, n_b, 6)."""
    dS = with_moment(x, n * d[:, None])
    v_n = np.einsum("bni,ni->bn", v, n)
    out = 0.5 * sum(integral(v[..., i], v[..., i], dS) for i in range(3))
    six = np.concatenate([v, np.cross(x[None], v)], axis=-1)
    part = [integral(six[..., i], v_n, d[:, None])[..., 0] for i in range(6)]
    return np.asarray(out - np.stack(part, axis=-1))


def _free_surface(
    first: FirstOrder, surface: ControlSurface, phis: list[Complex], v: Complex, waterline: WaterlineRule
) -> Complex:
    """Return the part of the still water (n_b, n_b, 6): loops for surge, sway, yaw, the ring for heave, roll, pitch."""
    K, hull = first.wave.K, first.hull
    line, copies = hull.waterline, len(hull.panels.images)
    rim = hull.copied(surface.rim)
    outward = with_moment(rim, rim / surface.radius * np.tile(surface.d_rim, copies)[:, None])
    inner = with_moment(line.middle, line.normal * [1.0, 1.0, 0.0] * line.length[:, None])
    at_hull = first.at_waterline(waterline)
    out = -0.5 * K * (integral(phis[3], phis[3], outward) - integral(at_hull, at_hull, inner))
    out[..., 2:5] = np.nan
    if surface.ring_is_whole:
        x = hull.copied(surface.ring)
        dS = np.stack([np.ones(len(x)), x[:, 1], -x[:, 0]], axis=1) * np.tile(surface.d_ring, copies)[:, None]
        along = integral(v[..., 0], v[..., 0], dS) + integral(v[..., 1], v[..., 1], dS)
        out[..., 2:5] = 0.5 * (along - K**2 * integral(phis[2], phis[2], dS))
    return out


def _loop(first: FirstOrder, rule: WaterlineRule) -> Complex:
    """Return oint <phi (dX/dt x dl)> and oint <phi x x (dX/dt x dl)> (n_b, n_b, 6)."""
    line = first.hull.waterline
    phi, speed = first.at_waterline(rule), 1j * first.wave.omega * displacement(first.motion, line.middle)
    force = sum(EPSILON[:, j, k] * integral(phi, speed[..., j], line.tangent[:, k : k + 1]) for j in range(3) for k in range(3))
    n_b = len(phi)
    moment = np.zeros((n_b, n_b, 3), dtype=complex)
    for j in range(3):
        for k in range(3):
            arms = np.einsum("ial,l,na->ni", EPSILON, EPSILON[:, j, k], line.middle) * line.tangent[:, k : k + 1]
            moment += integral(phi, speed[..., j], arms)
    return np.concatenate([force, moment], axis=-1)
