"""First-order solution of one frequency: motions, and the total potential and velocity on the hull and the waterline."""

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import ConvergenceError
from ogilvie.hydro.bem_waves import incident
from ogilvie.hydro.drift_panels import WholeHull
from ogilvie.hydro.drift_slope import Slopes
from ogilvie.hydro.drift_solve import Fields, expanded, incident_wave

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
WaterlineRule = Literal["edge", "centre"]


@dataclass(frozen=True, eq=False)
class Wave:
    """Incident waves of one frequency.

    Parameters
    ----------
    omega, k : float
        rad/s, rad/m.
    directions : (n_b,) array
        rad.
    depth, rho, g : float
    """

    omega: float
    k: float
    directions: Array
    depth: float
    rho: float
    g: float

    @property
    def K(self) -> float:
        """omega^2/g, 1/m."""
        return self.omega**2 / self.g

    @property
    def ratio(self) -> float:
        """Group over phase velocity, 1/2 (1 + 2 kh/sinh 2 kh)."""
        kh = self.k * self.depth
        return 0.5 if kh > 300.0 else 0.5 * (1.0 + 2.0 * kh / np.sinh(2.0 * kh))


@dataclass(frozen=True, eq=False)
class Dynamics:
    """Inertia, restoring and external coefficients about O, (6, 6) each; a fixed body has no dynamics."""

    mass: Array
    stiffness: Array
    external_damping: Array
    external_stiffness: Array


@dataclass(frozen=True, eq=False)
class FirstOrder:
    """The first-order solution per metre of wave amplitude, exp(+i omega t).

    Parameters
    ----------
    wave : Wave
    hull : WholeHull
    slopes : Slopes
        Neighbours of the panels along the hull.
    fields : Fields
        The six radiated and the n_b diffracted potentials of :func:`ogilvie.hydro.drift_solve.solve_sources`.
    dynamics : Dynamics or None
        None for a fixed body.
    """

    wave: Wave
    hull: WholeHull
    slopes: Slopes
    fields: Fields
    dynamics: Dynamics | None

    @cached_property
    def weights(self) -> Complex:
        """Parts (n_b, 6 + n_b) that the stored potentials have in the total: i omega xi_j, and i g/omega for diffraction."""
        n_b = len(self.wave.directions)
        diffracted = 1j * self.wave.g / self.wave.omega * np.eye(n_b)
        return np.concatenate([1j * self.wave.omega * self.motion, diffracted], axis=1)

    @cached_property
    def radiation(self) -> tuple[Array, Array]:
        """Added mass and damping (6, 6) about O."""
        phi = expanded(self.fields.potential[:6], self.hull.panels)
        T = -self.wave.rho * phi @ self._loads
        return T.T.real, -self.wave.omega * T.T.imag

    @cached_property
    def excitation(self) -> Complex:
        """Wave force (n_b, 6) on the fixed body."""
        w = self.wave
        froude_krylov, _ = incident(
            self.hull.panels, omega=w.omega, k=w.k, direction=w.directions, depth=w.depth, rho=w.rho, g=w.g
        )
        phi = expanded(self.fields.potential[6:], self.hull.panels)
        return np.asarray(froude_krylov - w.rho * w.g * phi @ self._loads)

    @cached_property
    def motion(self) -> Complex:
        """Motion of O (n_b, 6), m/m and rad/m; zero for a fixed body."""
        if self.dynamics is None:
            return np.zeros((len(self.wave.directions), 6), dtype=complex)
        d, w = self.dynamics, self.wave.omega
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
        d, w = self.dynamics, self.wave.omega
        inertia = -(w**2) * d.mass + d.external_stiffness + 1j * w * d.external_damping
        return np.asarray((self.motion @ inertia.T)[:, :3])

    @cached_property
    def dissipated(self) -> Complex:
        """Mean power (n_b, n_b) that external damping takes, W/m2, for every pair of directions."""
        if self.dynamics is None:
            return np.zeros((len(self.motion),) * 2, dtype=complex)
        B = 0.5 * (self.dynamics.external_damping + self.dynamics.external_damping.T)
        return np.asarray(0.5 * self.wave.omega**2 * self.motion @ B @ self.motion.conj().T)

    @cached_property
    def potential(self) -> Complex:
        """Total potential (n_b, n) at the panels, m2/s."""
        return self._total(self.hull.centers, self.fields)[0]

    @cached_property
    def velocity(self) -> Complex:
        """Total velocity (n_b, n, 3) of the water at the panels, m/s."""
        n_b, n_hull = len(self.wave.directions), self.hull.panels.n_hull
        sigma = self.strengths.reshape(n_b, len(self.hull.panels.images), -1)[:, :, :n_hull].reshape(n_b, -1)
        return np.asarray(self._total(self.hull.centers, self.fields)[1] + self.slopes.missing(sigma))

    def at(self, points: Array, fields: Fields) -> tuple[Complex, Complex]:
        """Return the total potential (n_b, n) and velocity (n_b, n, 3) at points (n, 3) with the fields there."""
        return self._total(points, fields)

    def at_waterline(self, rule: WaterlineRule) -> Complex:
        """Return the total potential (n_b, n) at the waterline's edges.

        Notes
        -----
        "edge": phi_S(c) + grad phi_S(c) . (m - c) from the panel's centre c to the middle m of its edge, phi_I at m. "centre":
        the panel's value as it is.
        """
        line = self.hull.waterline
        if rule == "centre":
            return self.potential[:, line.owner]
        level, slope = self._scattered(self.fields)
        arm = line.middle - self.hull.centers[line.owner]
        scattered = level[:, line.owner] + np.einsum("bni,ni->bn", slope[:, line.owner], arm)
        w = self.wave
        wave, _ = incident_wave(line.middle, k=w.k, directions=w.directions, depth=w.depth)
        return np.asarray(scattered + 1j * w.g / w.omega * wave)

    @cached_property
    def strengths(self) -> Complex:
        """Sources (n_b, n_s) of the scattered and radiated waves on all panels and the lid, copy by copy."""
        return np.asarray(self.weights @ expanded(self.fields.sources, self.hull.panels))

    @cached_property
    def _loads(self) -> Array:
        n, x = self.hull.normals, self.hull.centers
        return np.concatenate([n, np.cross(x, n)], axis=1) * self.hull.areas[:, None]

    def _total(self, points: Array, fields: Fields) -> tuple[Complex, Complex]:
        w = self.wave
        wave, gradient = incident_wave(points, k=w.k, directions=w.directions, depth=w.depth)
        level, slope = self._scattered(fields)
        unit = 1j * w.g / w.omega
        return level + unit * wave, slope + unit * gradient

    def _scattered(self, fields: Fields) -> tuple[Complex, Complex]:
        panels = self.hull.panels
        level = self.weights @ expanded(fields.potential, panels)
        slope = np.einsum("bf,fni->bni", self.weights, expanded(fields.velocity, panels, vector=True), optimize=True)
        return np.asarray(level), np.asarray(slope)
