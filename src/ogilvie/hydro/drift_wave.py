"""What a first-order solution is asked for: waves that are met at one frequency, and the body that moves in them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ogilvie.waves.dispersion import wavenumber

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Wave:
    """Incident waves of one frequency, met at one frequency of encounter.

    Parameters
    ----------
    omega, k : float
        rad/s, rad/m.
    directions : (n_b,) array
        rad; at speed all of one frequency of encounter.
    depth, rho, g : float
    speed : float
        m/s, along x.

    Notes
    -----
    Waves that the ship overtakes, met at omega_e < 0, are described by the conjugates of all amplitudes, which have positive
    frequencies of encounter: -omega in place of omega, and the opposite direction. Means do not change.
    """

    omega: float
    k: float
    directions: Array
    depth: float
    rho: float
    g: float
    speed: float = 0.0

    @property
    def omega_e(self) -> float:
        """Frequency of encounter, omega - k U cos b, rad/s, > 0."""
        return self.omega if self.speed == 0.0 else self.omega - self.k * self.speed * float(np.cos(self.directions[0]))

    @property
    def k_e(self) -> float:
        """Wavenumber of waves of the frequency of encounter in water at rest, rad/m."""
        return self.k if self.speed == 0.0 else float(wavenumber(self.omega_e, self.depth, g=self.g))

    @property
    def K(self) -> float:
        """omega_e^2/g, 1/m."""
        return self.omega_e**2 / self.g

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
