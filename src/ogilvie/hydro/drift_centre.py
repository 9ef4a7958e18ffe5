"""First-order fields as codes of flat panels with constant potentials have them, to compare with their files (kernel).

Potentials follow from Green's theorem, with the whole potential of the diffraction problem as the unknown,

    (1/2 + D) phi_j = S n_j,   (1/2 + D) (phi_I + phi_D) = phi_I   on the hull,

velocities from sources, (1/2 + K) sigma = v, without any correction for the curvature of the hull or the slope of sigma.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.bem_kernel import tie_lid
from ogilvie.hydro.bem_panels import HullPanels
from ogilvie.hydro.bem_parity import by_parity, parities, require_finite
from ogilvie.hydro.drift_solve import Corrections, Fields, Sources, incident_wave, normal_velocities, solve_sources

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

#: Mirror signs (3,) -> S and D (n_s, n_s) at the mirrored centres due to the stored panels, free term in D, exp(+i omega t).
Dipoles = Callable[[Array], tuple[Complex, Complex]]


def solve_centres(
    panels: HullPanels,
    sources: Sources,
    dipoles: Dipoles,
    *,
    damping: Array,
    k: float,
    K: float,
    directions: Array,
    depth: float,
) -> Fields:
    """Return the fields of :func:`ogilvie.hydro.drift_solve.solve_sources` in this way.

    Parameters
    ----------
    panels : HullPanels
    sources, dipoles : callable
        See :data:`ogilvie.hydro.drift_solve.Sources` and :data:`Dipoles`.
    damping : (n_lid,) array
        Of the lid under the sources; the potential has a lid of :mod:`ogilvie.hydro.bem_kernel`.
    k, K : float
        Wavenumber, rad/m, and omega^2/g, 1/m.
    directions : (n_b,) array
        rad.
    depth : float
        m.

    Raises
    ------
    ConvergenceError
        The influence matrices hold NaN.

    Notes
    -----
    The second equation is that of the scattered wave, (1/2 + D) phi_D = -S d phi_I/dn, and Green's theorem for phi_I inside the
    hull, (1/2 - D) phi_I = -S d phi_I/dn, together; with panels the two differ by O(h). At the points of a lid, which lie
    inside, the theorem reads phi_I = D phi_I - S d phi_I/dn, so the right side of :mod:`ogilvie.hydro.bem_kernel`'s
    mu + tau w = 0 is tau phi_I there.
    """
    flat = Corrections(np.zeros(panels.n_hull), damping)
    found = solve_sources(panels, sources, corrections=flat, k=k, K=K, directions=directions, depth=depth)
    table = parities(panels)
    copies = [dipoles(image) for image in panels.images]
    require_finite(copies, purpose="second-order forces")
    radiated = normal_velocities(panels, table, k=k, directions=directions, depth=depth)[:6]
    whole = _incident(panels, table, k=k, directions=directions, depth=depth)
    n_hull, potential = panels.n_hull, np.zeros_like(found.potential)
    for s, (S, D) in enumerate(by_parity(copies)):
        factor = tie_lid(S, D, K=K, areas=panels.facets.areas[n_hull:])
        right = np.concatenate([S[:, :n_hull] @ radiated[:, s].T, factor[:, None] * whole[:, s].T], axis=1)
        potential[:, s] = np.linalg.solve(D, right)[:n_hull].T
    potential[6:] -= whole[:, :, :n_hull]
    return replace(found, potential=potential)


def _incident(panels: HullPanels, table: Array, *, k: float, directions: Array, depth: float) -> Complex:
    """Return the incident waves (n_b, n_par, n_s) at the points of hull and lid by parity."""
    x = panels.points
    at = np.stack([incident_wave(x * image, k=k, directions=directions, depth=depth)[0] for image in panels.images], axis=1)
    return np.einsum("sc,bcp->bsp", table, at) / len(panels.images)
