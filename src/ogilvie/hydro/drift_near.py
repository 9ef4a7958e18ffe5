"""Forces of second order by integration of the pressure over the hull (near field): all six components, term by term (kernel).

    F = -int [ <p2> n + <p1 (R x n)> + p0 <H> n ] dS - rho g/2 oint <zeta_r^2> n (1 - n_z^2)^(-1/2) dl
    p0 = -rho g z,  p1 = -rho (phi_t + g X_z),  p2 = -rho [ |grad phi|^2/2 + X . grad phi_t + g (H x)_z ]

with n into the fluid, X = T + R x x, zeta_r = eta - X_z; the moment about the fixed mean origin has x x n in place of n and
T x n + R x (x x n) in place of R x n (docs/theory/drift.md). The same forms hold
for two waves of different frequencies, where they are the slowly varying force without the potential of second order.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.drift_first import FirstOrder
from ogilvie.hydro.drift_forms import cross_mean, integral, with_moment
from ogilvie.hydro.drift_panels import Waterline, WholeHull
from ogilvie.hydro.drift_static import Rotation, static_force

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class OnHull:
    """What the near field takes from the first order, for any number of waves of any frequencies and directions.

    Parameters
    ----------
    omega : (m,) array
        Frequency of oscillation (of encounter), rad/s.
    motion : (m, 6) array
        Motion of O per metre of amplitude.
    velocity : (m, n, 3) array
        Of the water at the panels' centres.
    loads : (m, 6) array
        Integral of (d/dt - U d/dx) phi (n, x x n) dS, by Tuck's theorem.
    momentum : (m, 6) array
        Integral of phi (n, x x n) dS.
    line : Waterline
        Edges on z = 0.
    elevation, potential : (m, n_l) array
        At the middles of the waterline's edges.
    force : (m, 3) array
        First-order force of the water.
    speed : float
        U, m/s; one for all waves.
    """

    omega: Array
    motion: Complex
    velocity: Complex
    loads: Complex
    momentum: Complex
    line: Waterline
    elevation: Complex
    potential: Complex
    force: Complex
    speed: float

    def hull_velocity(self, x: Array) -> Complex:
        """Return V = (d/dt - U d/dx) X = i omega X - U R x e_x (m, n, 3) at points x (n, 3); phi_n = V . n."""
        V = 1j * self.omega[:, None, None] * displacement(self.motion, x)
        if self.speed != 0.0:
            V[..., 1] -= self.speed * self.motion[:, None, 5]
            V[..., 2] += self.speed * self.motion[:, None, 4]
        return np.asarray(V)


def on_hull(first: FirstOrder) -> OnHull:
    """Return the quantities of one frequency, one wave per direction."""
    w = first.wave
    return OnHull(
        omega=np.full(len(w.directions), w.omega_e),
        motion=first.motion,
        velocity=first.velocity,
        loads=first.rate_of_momentum(first.potential),
        momentum=first.momentum(first.potential),
        line=first.line,
        elevation=first.elevation,
        potential=first.at_waterline,
        force=first.pressure_force,
        speed=w.speed,
    )


def near_field(first: FirstOrder, *, rotation: Rotation) -> dict[str, Complex]:
    """Return the terms (n_b, n_b, 6) of the mean force and moment about the fixed origin; the drift is their sum.

    Parameters
    ----------
    first : FirstOrder
    rotation : {"ZYX", "XYZ"}
    """
    return near_terms(on_hull(first), first.hull, rotation=rotation, rho=first.wave.rho, g=first.wave.g)


def near_terms(waves: OnHull, hull: WholeHull, *, rotation: Rotation, rho: float, g: float) -> dict[str, Complex]:
    """Return the terms (m, m, 6) for every ordered pair of waves, at the difference of their frequencies.

    Returns
    -------
    dict
        waterline, velocity (|grad phi|^2), displacement (X . grad phi_t), rotation (first-order pressure on a turned hull),
        static (still water on the motions of second order).

    Notes
    -----
    At speed phi_t becomes phi_t - U d phi/dx, and no second derivative is needed: with R x e_x = dX/dx

        int X . grad(phi_t - U phi_x) n_i dS
            = int [ X . grad phi_t + U (R x e_x) . grad phi ] n_i dS - U int (X . grad phi) m_i dS

    by Tuck's theorem for X . grad phi; m_i is zero for forces, and -e_x x n for moments.
    """
    dS = with_moment(hull.centers, hull.normals * hull.areas[:, None])
    v, rate = waves.velocity, 1j * waves.omega[:, None]
    X = displacement(waves.motion, hull.centers)
    velocity = np.sum([integral(v[..., i], v[..., i], dS) for i in range(3)], axis=0)
    shifted = np.sum([integral(X[..., i], rate * v[..., i], dS) for i in range(3)], axis=0)
    if waves.speed != 0.0:
        R = waves.motion[:, 3:, None] * np.ones(len(dS))
        shifted = shifted + waves.speed * (integral(R[:, 2], v[..., 1], dS) - integral(R[:, 1], v[..., 2], dS))
        along = np.sum([integral(X[..., i], v[..., i], dS[:, :3]) for i in range(3)], axis=0)
        shifted[..., 3:] += waves.speed * np.cross([1.0, 0.0, 0.0], along)
    return {
        "waterline": strip_force(waves.elevation, waves.motion, waves.line, rho * g),
        "velocity": 0.5 * rho * velocity,
        "displacement": rho * shifted,
        "rotation": rho * turned(waves.motion, waves.loads),
        "static": static_force(waves.motion, hull.panels.hull.moments, rotation=rotation, rho=rho, g=g),
    }


def waterline_force(first: FirstOrder) -> Complex:
    """Return -rho g/2 oint <zeta_r^2> n/(1 - n_z^2)^(1/2) dl and its moment (n_b, n_b, 6)."""
    w = first.wave
    return strip_force(first.elevation, first.motion, first.line, w.rho * w.g)


def strip_force(eta: Complex, motion: Complex, line: Waterline, unit: float) -> Complex:
    """Return the force (m, m, 6) on the wetted strip from elevations (m, n_l) and motions; `unit` is rho g."""
    if len(line.owner) == 0:
        return np.zeros((len(motion),) * 2 + (6,), dtype=complex)
    relative = eta - displacement(motion, line.middle)[..., 2]
    dl = with_moment(line.middle, line.normal * line.length[:, None])
    return np.asarray(-0.5 * unit * integral(relative, relative, dl))


def displacement(motion: Complex, x: Array) -> Complex:
    """Return T + R x x (n_b, n, 3) at points (n, 3)."""
    return np.asarray(motion[:, None, :3] + np.cross(motion[:, None, 3:], x[None]))


def turned(motion: Complex, loads: Complex) -> Complex:
    """Return <R x P>, <T x P + R x Q> of first-order loads (P, Q) = integral of phi_t (n, x x n) dS, (n_b, 6)."""
    T, R, P, Q = motion[:, :3], motion[:, 3:], loads[:, :3], loads[:, 3:]
    return np.concatenate([cross_mean(R, P), cross_mean(T, P) + cross_mean(R, Q)], axis=-1)
