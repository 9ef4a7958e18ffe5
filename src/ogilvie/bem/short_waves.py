"""Damping of waves shorter than the panels can carry, after they have done their part near the hull."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.coupled import CoupledSystem
from ogilvie.bem.curved import BODY, FREE
from ogilvie.bem.curved_nodes import CurvedNodes, frames

Array = NDArray[Any]

STRENGTH = 0.5  # of the damping over frequency, far above the limit of the wavenumber
SHARE = 0.45  # of the wavenumber pi/h that nodes at distance h can hold: where damping sets in
HIGHEST = 60.0  # wavenumber in 1/Rc that 12 functions of the depth let through
_POWER = 4
_START, _RISE = 4.0, 10.0  # phase of a wave, rad, at which its damping begins, and over which it rises
_LOWEST = 0.25  # of the limit of the wavenumber: longer waves are damped as late as this one
_TAPER = 0.2  # of the way from waterline to control surface, where damping begins to fall towards zero at the control surface


@dataclass(frozen=True, eq=False)
class ShortWaves:
    """Damping shape diag(rate * ramp(t)) shape.T of the free surface's modes, with norm(shape) <= 1.

    Parameters
    ----------
    shape : (n, n_f) array
    rate : (n_f,) array
        Of each mode, >= 0, 1/sqrt(Rc/g).
    frequency : (n_f,) array
        Whose phase decides when the rate comes into force.
    """

    shape: Array
    rate: Array
    frequency: Array

    @property
    def complete(self) -> float:
        """Time from which on the damping is constant."""
        return float((_START + _RISE) / self.frequency.min())

    def loss(self, t: float, h: float) -> Array:
        """Return exp(-rate ramp h) - 1 at time t (n_f,)."""
        return np.asarray(np.expm1(-self.rate * rise((self.frequency * t - _START) / _RISE) * h))


def short_waves(system: CoupledSystem, *, limit: float | None = None, strength: float = STRENGTH) -> ShortWaves:
    """Return the damping of short waves.

    Parameters
    ----------
    system : CoupledSystem
    limit : float, optional
        Wavenumber kc from which on waves are damped, in 1/Rc; by default :func:`wavenumber_limit`.
    strength : float
        alpha.

    Notes
    -----
    rate = alpha sqrt(k) x/(1 + x), x = (k/kc)^4, for the Neumann modes of the free surface, in force from t = 4/sqrt(k) on
    and fully from 14/sqrt(k). An impulse makes waves of all lengths (at a vertical wall psi_z is logarithmic). What they add
    to the force cancels within a few of their periods, as they run away; on panels they do not: waves too short for the
    panels farther out are caught in the fine ones at the waterline. Damping from the start would take away force that is
    real; damping after some periods takes away what should have gone.

    The operator must not act at the control surface: it sees the wave together with its mirror image there, and their kink
    would reflect. It falls to zero from a fifth of the way between waterline and control surface on.
    """
    k = np.where(np.isinf(system.wavenumber), 2.0 * np.max(system.wavenumber, where=np.isfinite(system.wavenumber),
    initial=0.0),
                 system.wavenumber)  # fmt: skip
    kc = wavenumber_limit(system.inner.nodes) if limit is None else limit
    x = (k / kc) ** _POWER
    taper = np.sqrt(1.0 - rise((_way(system.inner.nodes) - _TAPER) / (1.0 - _TAPER)))
    shape = system.modes.T @ (taper[:, None] * system.modes)
    rest = np.zeros((len(system.stiffness) - len(shape), shape.shape[1]))
    return ShortWaves(
        np.concatenate([shape, rest]), strength * np.sqrt(k) * x / (1.0 + x), np.sqrt(np.maximum(k, _LOWEST * kc))
    )


def wavenumber_limit(nodes: CurvedNodes) -> float:
    """Return kc = 0.45 pi/h, at most 60, in 1/Rc; h: largest distance of nodes across a panel of the free surface.

    That is the shorter side over p. Waves of more than 60/Rc are not let through by 12 functions of the depth.
    """
    c = nodes.coefficients[nodes.mesh.part == FREE]
    t = np.linspace(-1.0, 1.0, 9)
    x = frames(c, t, t)[0]
    along, across = (np.linalg.norm(np.diff(x, axis=a), axis=-1).sum(axis=a).mean(axis=1) for a in (1, 2))
    return float(min(SHARE * np.pi * nodes.order / np.minimum(along, across).max(), HIGHEST))


def rise(x: Array) -> Array:
    """Return the smooth step from 0 at x = 0 to 1 at x = 1 with two continuous derivatives."""
    x = np.clip(x, 0.0, 1.0)
    return np.asarray(x**3 * (10.0 - 15.0 * x + 6.0 * x * x))


def _way(nodes: CurvedNodes) -> Array:
    """Return where each node of the free surface is between waterline (0) and control surface (1)."""
    from scipy.spatial import cKDTree

    x = nodes.position[nodes.part == FREE]
    hull = cKDTree(nodes.position[nodes.part == BODY]).query(x)[0]
    outwards = 1.0 - np.linalg.norm(x, axis=1)
    return np.asarray(hull / (hull + outwards))
