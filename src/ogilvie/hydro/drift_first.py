"""First-order solution of one frequency: motions, and the total potential and velocity on the hull and the waterline."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import ConvergenceError
from ogilvie.hydro.bem_forces import SPEED_TERMS
from ogilvie.hydro.bem_waves import incident
from ogilvie.hydro.drift_panels import Waterline, WholeHull
from ogilvie.hydro.drift_slope import Slopes
from ogilvie.hydro.drift_solve import Fields, expanded, incident_wave
from ogilvie.hydro.drift_wave import Dynamics, Wave
from ogilvie.hydro.speed_terms import momentum_at_speed, split

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class FirstOrder:
    """The first-order solution per metre of wave amplitude, exp(+i omega_e t).

    At speed U it is that of :mod:`ogilvie.hydro.bem_forces`: radiation and diffraction with the Green function of zero speed
    at the frequency of encounter, normal velocity i omega_e n_j + U m_j, forces by Tuck's theorem.

    Parameters
    ----------
    wave : Wave
    hull : WholeHull
    slopes : Slopes or None
        Neighbours of the panels along the hull. None: as codes of flat panels with constant values do it, velocities as the
        panels give them, the elevation at the waterline that of the panel's centre, the flare that of the panel.
    fields : Fields
        The six radiated and the n_b diffracted potentials of :func:`ogilvie.hydro.drift_solve.solve_sources`, or of
        :func:`ogilvie.hydro.drift_centre.solve_centres` for `slopes` None.
    dynamics : Dynamics or None
        None for a fixed body.
    """

    wave: Wave
    hull: WholeHull
    slopes: Slopes | None
    fields: Fields
    dynamics: Dynamics | None

    @cached_property
    def weights(self) -> Complex:
        """Parts (n_b, 6 + n_b) of the stored potentials in the total: i omega_e xi + U C xi, and i g/omega for diffraction."""
        w, n_b = self.wave, len(self.wave.directions)
        radiated = 1j * w.omega_e * self.motion + w.speed * self.motion @ SPEED_TERMS.T
        return np.concatenate([radiated, 1j * w.g / w.omega * np.eye(n_b)], axis=1)

    @cached_property
    def radiation(self) -> tuple[Array, Array]:
        """Added mass and damping (6, 6) about O."""
        w, phi = self.wave, expanded(self.fields.potential[:6], self.hull.panels)
        T = (-w.rho * phi @ self._loads).T
        return split(momentum_at_speed(T, w.omega_e, w.speed, -SPEED_TERMS), np.array(w.omega_e))

    @cached_property
    def excitation(self) -> Complex:
        """Wave force (n_b, 6) on the fixed body."""
        w = self.wave
        froude_krylov, _ = incident(
            self.hull.panels, omega=w.omega, k=w.k, direction=w.directions, depth=w.depth, rho=w.rho, g=w.g
        )
        phi = expanded(self.fields.potential[6:], self.hull.panels)
        return np.asarray(froude_krylov + 1j * w.rho * w.g / w.omega * self.rate_of_momentum(phi))

    @cached_property
    def motion(self) -> Complex:
        """Motion of O (n_b, 6), m/m and rad/m; zero for a fixed body."""
        if self.dynamics is None:
            return np.zeros((len(self.wave.directions), 6), dtype=complex)
        d, w = self.dynamics, self.wave.omega_e
        A, B = self.radiation
        Z = -(w**2) * (d.mass + A) + 1j * w * (B + d.external_damping) + d.stiffness + d.external_stiffness
        size = np.sqrt(np.abs(np.diag(Z)))
        if not np.all(size > 0.0):
            raise ConvergenceError(f"second-order forces: nothing holds the body at {w:.4g} rad/s; leave this frequency out.")
        return np.asarray(np.linalg.solve(Z / np.outer(size, size), (self.excitation / size).T).T / size)

    @cached_property
    def pressure_force(self) -> Complex:
        """First-order force of the water (n_b, 3): what accelerates the body, less what external means contribute."""
        if self.dynamics is None:
            return self.excitation[:, :3]
        d, w = self.dynamics, self.wave.omega_e
        inertia = -(w**2) * d.mass + d.external_stiffness + 1j * w * d.external_damping
        return np.asarray((self.motion @ inertia.T)[:, :3])

    @cached_property
    def dissipated(self) -> Complex:
        """Mean power (n_b, n_b) that external damping takes, W/m2, for every pair of directions."""
        if self.dynamics is None:
            return np.zeros((len(self.motion),) * 2, dtype=complex)
        B = 0.5 * (self.dynamics.external_damping + self.dynamics.external_damping.T)
        return np.asarray(0.5 * self.wave.omega_e**2 * self.motion @ B @ self.motion.conj().T)

    @cached_property
    def potential(self) -> Complex:
        """Total potential (n_b, n) at the panels, m2/s."""
        return self._total(self.hull.centers, self.fields)[0]

    @cached_property
    def line(self) -> Waterline:
        """Edges on z = 0."""
        return self.hull.panel_waterline if self.slopes is None else self.hull.waterline

    @cached_property
    def velocity(self) -> Complex:
        """Total velocity (n_b, n, 3) of the water at the panels, m/s."""
        if self.slopes is None:
            return self._total(self.hull.centers, self.fields)[1]
        n_b, n_hull = len(self.wave.directions), self.hull.panels.n_hull
        sigma = self.strengths.reshape(n_b, len(self.hull.panels.images), -1)[:, :, :n_hull].reshape(n_b, -1)
        return np.asarray(self._total(self.hull.centers, self.fields)[1] + self.slopes.missing(sigma))

    @cached_property
    def scattered_potential(self) -> Complex:
        """Potential (n_b, n) of the scattered and radiated waves at the panels, m2/s."""
        return self._scattered(self.fields)[0]

    def scattered_flow(self, points: Array, normals: Array) -> Complex:
        """Return the normal velocity (n_b, n) that scattered and radiated waves must have on the hull."""
        radiated = self.weights[:, :6] @ np.concatenate([normals, np.cross(points, normals)], axis=1).T
        return np.asarray(radiated - np.einsum("bni,ni->bn", self.incident(points)[1], normals))

    def at(self, points: Array, fields: Fields) -> tuple[Complex, Complex]:
        """Return the total potential (n_b, n) and velocity (n_b, n, 3) at points (n, 3) with the fields there."""
        return self._total(points, fields)

    @cached_property
    def at_waterline(self) -> Complex:
        """Total potential (n_b, n) at the waterline's edges.

        Notes
        -----
        phi_S(c) + grad phi_S(c) . (m - c) from the panel's centre c to the middle m of its edge, phi_I at m; the panel's value
        as it is for `slopes` None.
        """
        if self.slopes is None:
            return self.potential[:, self.line.owner]
        return np.asarray(self.scattered_line[0] + self.incident(self.line.middle)[0])

    @cached_property
    def elevation(self) -> Complex:
        """Total elevation (n_b, n) -(i omega_e phi - U d phi/dx)/g at the waterline's edges; see `at_waterline`."""
        w = self.wave
        eta = -1j * w.omega_e / w.g * self.at_waterline
        if w.speed == 0.0:
            return np.asarray(eta)
        along = self.scattered_line[1] + self.incident(self.line.middle)[1][..., 0]
        return np.asarray(eta + w.speed / w.g * along)

    @cached_property
    def scattered_line(self) -> tuple[Complex, Complex]:
        """Potential and velocity along x (n_b, n) of the scattered and radiated waves at the waterline's edges.

        Notes
        -----
        phi_S(c) + grad phi_S(c) . (m - c) from the panel's centre c to the middle m of its edge; the velocity is extrapolated
        along the hull from the two highest rows of panels.
        """
        line = self.hull.waterline
        level, slope = self._scattered(self.fields)
        arm = line.middle - self.hull.centers[line.owner]
        phi = level[:, line.owner] + np.einsum("bni,ni->bn", slope[:, line.owner], arm)
        along = self.velocity[..., 0] - self.incident(self.hull.centers)[1][..., 0]
        top, below = along[:, line.owner], along[:, line.below]
        return np.asarray(phi), np.asarray(top + (top - below) * line.beyond)

    def momentum(self, phi: Complex) -> Complex:
        """Return the integral (n_f, 6) of phi (n, x x n) dS for potentials (n_f, n) at the panels."""
        return np.asarray(phi @ self._loads)

    def rate_of_momentum(self, phi: Complex) -> Complex:
        """Return the integral (n_f, 6) of (i omega_e n_i - U m_i) phi dS for potentials (n_f, n) at the panels.

        Notes
        -----
        That is the integral of (i omega_e phi - U d phi/dx) n_i by Tuck's theorem.
        """
        loads = self.momentum(phi)
        return np.asarray(1j * self.wave.omega_e * loads - self.wave.speed * loads @ SPEED_TERMS)

    @cached_property
    def strengths(self) -> Complex:
        """Sources (n_b, n_s) of the scattered and radiated waves on all panels and the lid, copy by copy."""
        return np.asarray(self.weights @ expanded(self.fields.sources, self.hull.panels))

    @cached_property
    def _loads(self) -> Array:
        n, x = self.hull.normals, self.hull.centers
        return np.concatenate([n, np.cross(x, n)], axis=1) * self.hull.areas[:, None]

    def _total(self, points: Array, fields: Fields) -> tuple[Complex, Complex]:
        (level, slope), (wave, gradient) = self._scattered(fields), self.incident(points)
        return level + wave, slope + gradient

    def incident(self, points: Array) -> tuple[Complex, Complex]:
        """Return potential (n_b, n) and velocity (n_b, n, 3) of the incident wave at points (n, 3)."""
        w = self.wave
        wave, gradient = incident_wave(points, k=w.k, directions=w.directions, depth=w.depth)
        return 1j * w.g / w.omega * wave, 1j * w.g / w.omega * gradient

    def _scattered(self, fields: Fields) -> tuple[Complex, Complex]:
        panels = self.hull.panels
        level = self.weights @ expanded(fields.potential, panels)
        slope = np.einsum("bf,fni->bni", self.weights, expanded(fields.velocity, panels, vector=True), optimize=True)
        return np.asarray(level), np.asarray(slope)
