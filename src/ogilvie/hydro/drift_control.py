"""Mean drift by the flow of momentum through a control surface, all six components (kernel).

    F = rho int_{C+S} [ <|grad phi|^2>/2 n - <grad phi phi_n> ] dS - rho oint <phi dX/dt x dl>
        + static - rho g/2 oint <zeta_r^2> n (1 - n_z^2)^(-1/2) dl

C is the control surface and S the still water between it and the hull, n out of the water there; the loops run along the
waterline. The moment has x x n, x x grad phi and x x (dX/dt x dl). No velocity on the hull appears: its integrals turn into the
loop by Gauss's and Stokes's theorems, so sharp edges do no harm (docs/theory/drift.md). On S phi_z = K phi, and the horizontal
force and the yaw moment of S are loops too.

At speed dX/dt is (d/dt - U d/dx) X, phi_z differs from K phi on S by the incident wave, (k - K) phi_I, and the moment has
U e_x x P more, P the mean momentum of the water beside the hull. For two waves of different frequencies two terms are added:
the ring's part of the horizontal force, and d/dt of the integral of <(X . grad phi) n + phi R x n> over the hull.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.drift_first import FirstOrder
from ogilvie.hydro.drift_forms import EPSILON, integral, with_moment
from ogilvie.hydro.drift_near import OnHull, displacement, on_hull, strip_force, turned
from ogilvie.hydro.drift_panels import Waterline, WholeHull
from ogilvie.hydro.drift_solve import Fields
from ogilvie.hydro.drift_static import Rotation, static_force
from ogilvie.hydro.drift_surface import ControlSurface

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class OnSurface:
    """Potential and velocity of any number of waves at the points of a control surface, part by part.

    Parameters
    ----------
    surface : ControlSurface
    K : (m,) array
        omega^2/g, 1/m.
    phi, v : list of (m, n), (m, n, 3) arrays
        On wall, floor, ring and rim.
    excess : (m, n) array
        phi_z - K phi on the ring, zero at rest.
    """

    surface: ControlSurface
    K: Array
    phi: list[Complex]
    v: list[Complex]
    excess: Complex


def on_surface(first: FirstOrder, surface: ControlSurface, fields: Fields) -> OnSurface:
    """Return the quantities of one frequency, one wave per direction, from the stored potentials at the surface's points."""
    images, ring = first.hull.panels.images, first.hull.copied(surface.ring)
    phi, v = first.at(first.hull.copied(surface.points), fields)
    K = np.full(len(phi), first.wave.K)
    excess = np.zeros((len(phi), len(ring)), dtype=complex)
    if first.wave.speed != 0.0:
        wave, gradient = first.incident(ring)
        excess = gradient[..., 2] - first.wave.K * wave
    return OnSurface(surface, K, surface.split(phi, len(images)), surface.split(v, len(images)), excess)


def control_drift(first: FirstOrder, surface: ControlSurface, fields: Fields, *, rotation: Rotation) -> dict[str, Complex]:
    """Return the terms (n_b, n_b, 6) of the mean force and moment about the fixed origin; the drift is their sum.

    Parameters
    ----------
    first : FirstOrder
    surface : ControlSurface
    fields : Fields
        The stored potentials at ``surface.points``.
    rotation
        As in :func:`ogilvie.hydro.drift_near.near_field`.
    """
    waves, outer, w = on_hull(first), on_surface(first, surface, fields), first.wave
    terms = control_terms(waves, outer, first.hull, rotation=rotation, rho=w.rho, g=w.g)
    del terms["rate"]
    return terms


def control_terms(
    waves: OnHull, outer: OnSurface, hull: WholeHull, *, rotation: Rotation, rho: float, g: float
) -> dict[str, Complex]:
    """Return the terms (m, m, 6) for every ordered pair of waves, at the difference of their frequencies.

    Returns
    -------
    dict
        control (through C), surface (on S), loop (moving waterline), static, waterline, rate (what is not steady, zero for
        equal frequencies) and, at speed, stream (moment of the mean momentum beside the hull). Where S is not a plain ring its
        heave, roll and pitch are NaN, and all of it for waves of different frequencies or at speed.
    """
    surface, copies = outer.surface, len(hull.panels.images)
    radial = surface.wall * [1.0, 1.0, 0.0] / surface.radius
    through = _flux(hull.copied(surface.wall), hull.copied(radial), np.tile(surface.d_wall, copies), outer.v[0])
    down = np.broadcast_to([0.0, 0.0, -1.0], surface.floor.shape)
    through = through + _flux(hull.copied(surface.floor), hull.copied(down), np.tile(surface.d_floor, copies), outer.v[1])
    change = 1j * (waves.omega[:, None] - waves.omega[None])
    beside = _momentum(waves, hull) if np.any(change != 0.0) or waves.speed != 0.0 else np.zeros((*change.shape, 6))
    terms = {
        "control": rho * through,
        "surface": rho * _free_surface(outer, hull, waves.potential, moving=waves.speed != 0.0),
        "loop": -rho * _loop(waves, hull.waterline),
        "static": static_force(waves.motion, hull.panels.hull.moments, rotation=rotation, rho=rho, g=g),
        "waterline": strip_force(waves.elevation, waves.motion, hull.waterline, rho * g),
        "rate": rho * change[..., None] * beside,
    }
    if waves.speed != 0.0:
        turning = waves.speed * np.cross([1.0, 0.0, 0.0], beside[..., :3])
        terms["stream"] = rho * np.concatenate([np.zeros_like(turning), turning], axis=-1)
    return terms


def _flux(x: Array, n: Array, d: Array, v: Complex) -> Complex:
    """Return the integral of <|v|^2>/2 (n, x x n) - <(v, x x v) v_n> (n_b, n_b, 6)."""
    dS = with_moment(x, n * d[:, None])
    v_n = np.einsum("bni,ni->bn", v, n)
    out = 0.5 * sum(integral(v[..., i], v[..., i], dS) for i in range(3))
    six = np.concatenate([v, np.cross(x[None], v)], axis=-1)
    part = [integral(six[..., i], v_n, d[:, None])[..., 0] for i in range(6)]
    return np.asarray(out - np.stack(part, axis=-1))


def _free_surface(outer: OnSurface, hull: WholeHull, at_hull: Complex, *, moving: bool) -> Complex:
    """Return the part of the still water (m, m, 6): loops for surge, sway, yaw, the ring for heave, roll, pitch.

    With K = K_mean + K_half and K_mean - K_half of two waves, -<grad phi phi_z> is -K_mean grad <phi^2>/2, which makes the
    loops, less K_half (phi_m grad phi_n* - phi_n* grad phi_m)/4 over the ring, less <grad phi (phi_z - K phi)> at speed.
    """
    K, surface, line, copies = outer.K, outer.surface, hull.waterline, len(hull.panels.images)
    mean, half = 0.5 * (K[:, None] + K[None]), 0.5 * (K[:, None] - K[None])
    rim = hull.copied(surface.rim)
    outward = with_moment(rim, rim / surface.radius * np.tile(surface.d_rim, copies)[:, None])
    inner = with_moment(line.middle, line.normal * [1.0, 1.0, 0.0] * line.length[:, None])
    out = -0.5 * mean[..., None] * (integral(outer.phi[3], outer.phi[3], outward) - integral(at_hull, at_hull, inner))
    out[..., 2:5] = np.nan
    if not surface.ring_is_whole:
        out[(half != 0.0) | moving] = np.nan
        return np.asarray(out)
    x, phi, v = hull.copied(surface.ring), outer.phi[2], outer.v[2]
    dS = np.stack([np.ones(len(x)), x[:, 1], -x[:, 0]], axis=1) * np.tile(surface.d_ring, copies)[:, None]
    along = integral(v[..., 0], v[..., 0], dS) + integral(v[..., 1], v[..., 1], dS)
    rise = K[:, None] * phi + outer.excess
    out[..., 2:5] = 0.5 * (along - integral(rise, rise, dS))
    if moving or np.any(half != 0.0):
        turning = x[:, 0] * v[..., 1] - x[:, 1] * v[..., 0]
        for i, part in ((0, v[..., 0]), (1, v[..., 1]), (5, turning)):
            product = (phi * dS[:, 0]) @ part.conj().T
            out[..., i] -= 0.25 * half * (product - product.conj().T)
            out[..., i] -= integral(part, outer.excess, dS[:, :1])[..., 0]
    return np.asarray(out)


def _momentum(waves: OnHull, hull: WholeHull) -> Complex:
    """Return the integral of <(X . grad phi) n + phi R x n> over the hull and its moment (m, m, 6)."""
    dS = with_moment(hull.centers, hull.normals * hull.areas[:, None])
    X, v = displacement(waves.motion, hull.centers), waves.velocity
    shifted = np.sum([integral(X[..., i], v[..., i], dS) for i in range(3)], axis=0)
    return np.asarray(shifted + turned(waves.motion, waves.momentum))


def _loop(waves: OnHull, line: Waterline) -> Complex:
    """Return oint <phi (V x dl)> and oint <phi x x (V x dl)> (m, m, 6), V = (d/dt - U d/dx) X."""
    phi, speed = waves.potential, waves.hull_velocity(line.middle)
    force = sum(EPSILON[:, j, k] * integral(phi, speed[..., j], line.tangent[:, k : k + 1]) for j in range(3) for k in range(3))
    moment = np.zeros((len(phi), len(phi), 3), dtype=complex)
    for j in range(3):
        for k in range(3):
            arms = np.einsum("ial,l,na->ni", EPSILON, EPSILON[:, j, k], line.middle) * line.tangent[:, k : k + 1]
            moment += integral(phi, speed[..., j], arms)
    return np.concatenate([force, moment], axis=-1)
