"""First-order potentials by sources on the hull, with velocities from the same influence (kernel: arrays and floats only).

    phi = integral of sigma G dS,   n . grad phi = v   (indirect method; time factor exp(+i omega t)).

The gradient of G on the hull is kept, so that the velocity costs no more than the potential. Unknowns on the lid are tied by

    sigma = i epsilon K phi,   epsilon = 0.3 (d/d_max)^2   on z = 0 inside the hull, d from the waterline:

a free surface that damps towards its middle. The inner water has no resonance then, and the sources on the hull stay smooth up
to the waterline, which a rigid lid (or epsilon > 0 at the waterline) spoils. Whatever sources there are inside, the potential
outside is the right one.

Potentials here belong to unit normal velocity of each dof, dphi/dn = n_j, and to incident waves f(z) exp(-ik(x cos b + y sin
b)) without the factor i g/omega: they depend on the hull, the wavenumber and the depth alone.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.bem_panels import HullPanels
from ogilvie.hydro.bem_parity import by_parity, parities, require_finite
from ogilvie.hydro.bem_waves import profile

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

#: Points (n, 3) and mirror signs (3,) -> S (n, n_s) and gradient (3, n, n_s) at the mirrored points due to the stored panels,
#: without the free term, for exp(+i omega t).
Sources = Callable[[Array, Array], tuple[Complex, Complex]]


#: Damping in the middle of the inner free surface: enough against its resonances, little enough to keep the sources smooth.
_DAMPING = 0.3


@dataclass(frozen=True, eq=False)
class Fields:
    """Fields of several potentials by parity.

    Parameters
    ----------
    sources : (n_f, n_par, n_s) array
        On hull and lid.
    potential : (n_f, n_par, n_p) array
        At points, for example the centres of the stored hull panels.
    velocity : (n_f, n_par, n_p, 3) array
    """

    sources: Complex
    potential: Complex
    velocity: Complex


@dataclass(frozen=True, eq=False)
class Corrections:
    """What depends on the geometry alone.

    Parameters
    ----------
    curvature : (n_hull,) array
        From :func:`flux_correction`.
    damping : (n_lid,) array
        From :func:`lid_damping`.
    """

    curvature: Array
    damping: Array


def solve_sources(
    panels: HullPanels, sources: Sources, *, corrections: Corrections, k: float, K: float, directions: Array, depth: float
) -> Fields:
    """Return the six radiated and the diffracted potentials (6 + n_b) with velocities at the hull's panels.

    Parameters
    ----------
    panels : HullPanels
    sources : callable
        See :data:`Sources`.
    corrections : Corrections
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
    """
    from scipy.linalg import lu_factor, lu_solve

    n_hull, n_all = panels.n_hull, panels.n_hull + panels.n_lid
    table = parities(panels)
    velocity = normal_velocities(panels, table, k=k, directions=directions, depth=depth)
    copies = [sources(panels.points, image) for image in panels.images]
    require_finite(copies, purpose="second-order forces")
    n_f, n_par = velocity.shape[:2]
    sigma = np.zeros((n_f, n_par, n_all), dtype=complex)
    phi, v = np.zeros((n_f, n_par, n_hull), dtype=complex), np.zeros((n_f, n_par, n_hull, 3), dtype=complex)
    normals = panels.hull.normals
    for s, (S, G) in enumerate(gathered(copies, panels.images)):
        used = np.flatnonzero(np.abs(velocity[:, s]).max(axis=1) > 0.0)
        if len(used) == 0:
            continue
        G[:, np.arange(n_hull), np.arange(n_hull)] += (0.5 + corrections.curvature) * normals.T
        A = np.eye(n_all, dtype=complex)
        A[:n_hull] = np.einsum("ipq,pi->pq", G[:, :n_hull], normals)
        A[n_hull:] -= 1j * K * corrections.damping[:, None] * S[n_hull:]
        right = np.zeros((n_all, len(used)), dtype=complex)
        right[:n_hull] = velocity[used, s].T
        x = lu_solve(lu_factor(A, overwrite_a=True, check_finite=False), right, check_finite=False)
        sigma[used, s] = x.T
        phi[used, s] = (S[:n_hull] @ x).T
        v[used, s] = (G[:, :n_hull] @ x).transpose(2, 1, 0)
    return Fields(sigma, phi, v)


def fields_at(panels: HullPanels, sources: Sources, strengths: Complex, points: Array) -> Fields:
    """Return the fields of known sources (n_f, n_par, n_s) at points (n_p, 3) in the stored part of the water."""
    n_f, n_par, n_p = len(strengths), strengths.shape[1], len(points)
    phi, v = np.zeros((n_f, n_par, n_p), dtype=complex), np.zeros((n_f, n_par, n_p, 3), dtype=complex)
    rows = strengths.reshape(n_f * n_par, -1).T
    for signs, image in zip(parities(panels).T, panels.images, strict=True):
        S, G = sources(points, image)
        phi += signs[:, None] * (S @ rows).T.reshape(n_f, n_par, n_p)
        for i in range(3):
            v[..., i] += signs[:, None] * image[i] * (G[i] @ rows).T.reshape(n_f, n_par, n_p)
    return Fields(strengths, phi, v)


def gathered(copies: list[tuple[Complex, Complex]], images: Array) -> list[tuple[Complex, Complex]]:
    """Return S and the gradient (3, ...) at the stored points due to all copies of the panels, for each parity.

    The influence at the mirror image of a point is that of the mirrored panel, its gradient mirrored. Results take the place
    of the copies, as in :func:`ogilvie.hydro.bem_parity.by_parity`.
    """
    for (_, G), image in zip(copies, images, strict=True):
        for i in np.flatnonzero(image < 0.0):
            np.negative(G[i], out=G[i])
    by_parity([(S, *G) for S, G in copies])
    return copies


def expanded(values: Complex, panels: HullPanels, *, vector: bool = False) -> Complex:
    """Return values (n_f, n_par, n[, 3]) by parity at all copies: (n_f, n_c n[, 3])."""
    table = parities(panels)
    if not vector:
        full = np.einsum("sc,fsp->fcp", table, values)
        return full.reshape(len(values), -1)
    full = np.einsum("sc,ci,fspi->fcpi", table, panels.images, values)
    return full.reshape(len(values), -1, 3)


def incident_wave(x: Array, *, k: float, directions: Array, depth: float) -> tuple[Complex, Complex]:
    """Return f(z) exp(-ik(x cos b + y sin b)) (n_b, n) and its gradient (n_b, n, 3) at points x (n, 3)."""
    f, df = profile(x[:, 2], k, depth)
    cos, sin = np.cos(directions)[:, None], np.sin(directions)[:, None]
    phase = np.exp(-1j * k * (x[:, 0] * cos + x[:, 1] * sin))
    level = f * phase
    return level, np.stack([-1j * k * cos * level, -1j * k * sin * level, df * phase], axis=-1)


def normal_velocities(panels: HullPanels, table: Array, *, k: float, directions: Array, depth: float) -> Complex:
    """Return the prescribed normal velocity (6 + n_b, n_par, n_hull) at the centres by parity."""
    n_c, n_hull = len(panels.images), panels.n_hull
    v = np.zeros((6 + len(directions), n_c, n_hull), dtype=complex)
    v[:6] = np.einsum("cj,jp->jcp", panels.dof_signs, panels.modes)
    for c, image in enumerate(panels.images):
        _, gradient = incident_wave(panels.hull.centers * image, k=k, directions=directions, depth=depth)
        v[6:, c] = -np.einsum("bpi,pi->bp", gradient, panels.hull.normals * image)
    parts = np.einsum("sc,fcp->fsp", table, v) / n_c
    size = np.abs(parts).max(axis=(1, 2), keepdims=True)
    parts[np.broadcast_to(np.abs(parts).max(axis=2, keepdims=True) < 1e-12 * size, parts.shape)] = 0.0
    return parts


def flux_correction(panels: HullPanels, still: Sources) -> Array:
    """Return what the velocity of each panel's own source lacks because the panel is flat (n_hull,).

    Parameters
    ----------
    panels : HullPanels
    still : callable
        Influence at wavenumber zero: with z = 0 a rigid wall.

    Notes
    -----
    All water that a source on the hull puts out passes the surface just outside of it; half of it by the free term 1/2 of its
    own panel, the other half through all panels by the principal value. Flat panels with one point each miss the curvature
    of the source's own neighbourhood, about the panel's size over the radius; the difference is given to the panel itself:

        d_q = 1/2 - (1/a_q) sum over p of a_p n_p . grad G0(x_p; q).

    This makes the method second order on smooth hulls: heave added mass of a hemisphere of 960 panels at Ka = 0.5 is 0.1 %
    off the exact value with it, 2.5 % without.
    """
    n_hull, flux = panels.n_hull, np.zeros(panels.n_hull)
    weight = panels.hull.normals * panels.hull.areas[:, None]
    for image in panels.images:
        _, G = still(panels.hull.centers, image)
        flux += sum((weight[:, i] * image[i]) @ G[i, :, :n_hull].real for i in range(3))
    return np.asarray(0.5 - flux / panels.hull.areas)


def lid_damping(lid: Array, waterline: Array) -> Array:
    """Return 0.3 (d/d_max)^2 of lid panels with centres (n, 3), d the distance to the nearest of the waterline's points (m, 3).

    Examples
    --------
    >>> lid_damping(np.array([[0.0, 1, 0], [0, 2, 0]]), np.array([[0.0, 3, 0], [0, 4, 0]])).round(6).tolist()
    [0.3, 0.075]
    """
    from scipy.spatial import cKDTree

    if len(lid) == 0:
        return np.zeros(0)
    d, _ = cKDTree(waterline[:, :2]).query(lid[:, :2])
    return np.asarray(_DAMPING * (d / d.max()) ** 2)
