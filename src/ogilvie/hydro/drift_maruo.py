"""Mean drift and energy from the waves far away at forward speed, in deep water (kernel).

In axes that advance with U a wave exp(i(omega_e t - q . x)) has the frequency Omega = omega_e + U q_x in the water at rest, and
Omega^2 = g q. With q = q (cos, sin) theta and tau = U omega_e/g that is two waves for each direction,

    Omega = 2 omega_e/(1 +- s),   q = Omega^2/g,   s = (1 - 4 tau cos theta)^(1/2) real:

the lower sign, Omega < 0 where cos theta < 0, belongs to short waves. With the Kochin function K of :func:`kochin` they carry
away the wave action

    dN = (rho/8 pi) sgn(Omega) q |K|^2/s dtheta,

and with the action the energy omega_e N and the momentum q N. The incident wave (q_0, Omega_0) loses the action
N_0 = -(rho g/2 Omega_0) Re K(q_0) per metre of amplitude. So with P the power that external damping takes

    0 = omega_e (N - N_0) + P,
    F = q_0 N_0 - int q dN = int (q_0 - q) dN + q_0 P/omega_e,

the second form that of Maruo (1960), in which the balance of energy has been used; so it stays as a check. See
docs/theory/drift.md.
"""

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.bem_case import resolved_wavenumber
from ogilvie.hydro.drift_far import FarField
from ogilvie.hydro.drift_first import FirstOrder

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

#: Shortest waves of the integrals, over the wavenumber of six panels to a wave: the panels' fields are much longer ones.
_FINEST = 3.0
_DEEP = 12.0  # wavenumber times depth of what is felt no more
_AT_ONCE = 4e6  # panels times wave vectors


def far_field_at_speed(first: FirstOrder) -> FarField:
    """Return the mean drift in surge and sway, each direction alone; NaN in the other dofs and in finite depth.

    Notes
    -----
    Waves shorter than two panels are left out, which is worth some 2 %.
    """
    w, n_b = first.wave, len(first.wave.directions)
    force = np.zeros((n_b, n_b, 6), dtype=complex)
    force[..., 2:] = np.nan
    if np.isfinite(w.depth):
        force[:] = np.nan
        return FarField(force, np.full(n_b, np.nan), np.full(n_b, np.nan))
    qx, qy, dN = radiated_action(first)
    P = np.real(np.diag(first.dissipated))
    q_0 = w.k * np.stack([np.cos(w.directions), np.sin(w.directions)])
    lost = -w.rho * w.g / (2.0 * w.omega) * np.real(np.diag(kochin(first, *q_0)))
    total = dN.sum(axis=1)
    here = np.arange(n_b)
    for i, q in enumerate((qx, qy)):
        force[here, here, i] = q_0[i] * (total + P / w.omega_e) - dN @ q
    return FarField(force, w.omega_e * total + P, w.omega_e * lost)


def radiated_action(first: FirstOrder) -> tuple[Array, Array, Array]:
    """Return wave vectors qx, qy (n,), rad/m, and the action dN (n_b, n) that each carries away per second, J/m2."""
    w = first.wave
    parts = [_waves(w.omega_e, w.speed, w.g, sign, _limit(first), _radius(first)) for sign in (1.0, -1.0)]
    Omega, qx, qy, weight = (np.concatenate([part[i] for part in parts]) for i in range(4))
    strength = kochin(first, qx, qy)
    return qx, qy, w.rho / (8.0 * np.pi) * np.sign(Omega) * np.hypot(qx, qy) * np.abs(strength) ** 2 * weight


def kochin(first: FirstOrder, qx: Array, qy: Array) -> Complex:
    """Return K (n_b, n) of the scattered and radiated waves at wave vectors (n,), rad/m.

    Notes
    -----
    By Green's theorem with E = exp(qz + i q . x), which obeys the free-surface condition of the moving ship,

        K = int (phi_n E - phi E_n) dS + (1/g) oint [ 2 i omega_e U phi E - U^2 (phi_x E - phi E_x) ] n_x dl

    over hull and waterline. Without the second integral K would not fall off in short waves. The sources inside the hull give
    the same at rest, but not at speed, where q is not the wavenumber of their Green function.
    """
    size = max(1, int(_AT_ONCE / first.hull.panels.n_hull))
    parts = [slice(begin, begin + size) for begin in range(0, len(qx), size)]
    return np.concatenate([_over_hull(first, qx[p], qy[p]) + _over_waterline(first, qx[p], qy[p]) for p in parts], axis=1)


def _over_hull(first: FirstOrder, qx: Array, qy: Array) -> Complex:
    panels = first.hull.panels
    points, weights = panels.quadrature
    n, q = panels.hull.normals, np.hypot(qx, qy)
    phi = first.scattered_potential.reshape(len(first.motion), len(panels.images), -1)
    K = np.zeros((len(phi), len(qx)), dtype=complex)
    for c, image in enumerate(panels.images):
        for i in range(points.shape[1]):
            x, normal, d = points[:, i] * image, n * image, weights[:, i]
            E = np.exp(np.outer(x[:, 2], q) + 1j * (np.outer(x[:, 0], qx) + np.outer(x[:, 1], qy)))
            K += (first.scattered_flow(x, normal) * d) @ E
            for part, factor in zip(normal.T, (1j * qx, 1j * qy, q), strict=True):
                K -= (phi[:, c] * d * part) @ E * factor
    return K


def _over_waterline(first: FirstOrder, qx: Array, qy: Array) -> Complex:
    w, line = first.wave, first.hull.waterline
    if w.speed == 0.0 or len(line.owner) == 0:
        return np.zeros((len(first.motion), len(qx)), dtype=complex)
    phi, phi_x = first.scattered_line
    n_x = line.normal[:, 0] * line.length
    phase, half = (np.outer(x[:, 0], qx) + np.outer(x[:, 1], qy) for x in (line.middle, 0.5 * line.tangent))
    E = np.exp(1j * phase) * np.sinc(half / np.pi)  # the mean along the edge
    steady = ((2j * w.omega_e * w.speed * phi - w.speed**2 * phi_x) * n_x) @ E
    return np.asarray((steady + w.speed**2 * ((phi * n_x) @ E) * (1j * qx)) / w.g)


def _waves(omega_e: float, speed: float, g: float, sign: float, limit: float, radius: float) -> tuple[Array, ...]:
    """Return Omega, qx, qy and dtheta/s of the waves of one sign of the root, up to a wavenumber."""
    tau = abs(speed) * omega_e / g
    least = 2.0 * omega_e / np.sqrt(g * limit)  # 1 + s or |1 - s| at the limit
    first = np.arccos(min(1.0, 0.25 / tau)) if tau > 0.0 else 0.0
    if sign > 0.0:
        ranges, limit = [(first, np.pi)], 4.0 * omega_e**2 / g
    elif tau == 0.0:
        ranges = []
    else:
        ranges = [(first, _angle(1.0 - least, tau)), (_angle(1.0 + least, tau), np.pi)]
    found = []
    for start, end in ranges:
        if end > start:
            t, dt = np.polynomial.legendre.leggauss(int(np.ceil(4.0 * limit * radius + 64.0)))
            u, du = 0.5 * (t + 1.0), 0.5 * dt
            found.append((start + (end - start) * u**2, 2.0 * (end - start) * u * du))
    if not found:
        return (np.zeros(0),) * 4
    theta, d = (np.concatenate(part) for part in zip(*found, strict=True))
    s = np.sqrt(np.maximum(1.0 - 4.0 * tau * np.cos(theta), 0.0))
    Omega = 2.0 * omega_e / (1.0 + sign * s)
    q = Omega**2 / g
    keep = q <= limit * (1.0 + 1e-6)
    along = np.where(speed < 0.0, -1.0, 1.0) * q * np.cos(theta)
    parts = Omega, along, q * np.sin(theta), d / s
    Omega, qx, qy, weight = (part[keep] for part in parts)
    return np.tile(Omega, 2), np.tile(qx, 2), np.concatenate([qy, -qy]), np.tile(weight, 2)


def _angle(s: float, tau: float) -> float:
    """Return the angle (0..pi) at which the root is s >= 0; 0 or pi where no angle has it."""
    return float(np.arccos(np.clip((1.0 - max(s, 0.0) ** 2) / (4.0 * tau), -1.0, 1.0)))


def _limit(first: FirstOrder) -> float:
    """Return the largest wavenumber: of two panels, of waves that do not reach the hull; that of the first waves at least."""
    hull, w = first.hull.panels.hull, first.wave
    finest = min(_FINEST * resolved_wavenumber(hull), _DEEP / -float(hull.centers[:, 2].max()))
    return max(finest, 4.0 * w.omega_e**2 / w.g, w.k)  # where the two waves meet


def _radius(first: FirstOrder) -> float:
    return float(np.linalg.norm(first.hull.source_points[:, :2], axis=1).max())
