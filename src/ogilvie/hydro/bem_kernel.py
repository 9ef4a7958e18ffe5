"""Integral equations at one wavenumber: from influence matrices to force vectors (kernel: arrays and floats only).

A force vector g_i gives the force on the body in dof i that any normal velocity v on the hull makes:

    integral of n_i phi dS = sum over all panels of g_i v,   phi = D^-1 S v  (direct method: D phi = S v).

It is the solution of the transposed equation, g_i = S^T D^-T (n_i dS), and depends on the hull, the wavenumber and the depth
alone. Radiation is v = n_j, diffraction v = -d phi_0/d n for any direction of the waves: no further equation is solved. The
two are consistent to rounding, and six right sides serve all directions and all speeds.

With planes of symmetry the equations fall apart into one for each combination of parities, of a half or a quarter of the size.

Inside the hull the same integrals make a potential w = D phi - S v that has to vanish. The hull alone asks for w = 0 on its
own panels, which leaves out the water that sloshes inside at the irregular frequencies. A lid on z = 0 with unknowns mu ends
it. A dipole there is K times a source, since G_z = K G, so the column of D that belongs to mu is -K S:

    w = D phi - K S mu - S v,   w_z - K w = K mu;   mu = -tau w on the lid makes   w_z = (1 - tau) K w.

For tau >= 1, integral of |grad w|^2 dV + (tau - 1) K integral of w^2 dS = 0: no frequency is irregular, and w = mu = 0. tau = 1
is a rigid lid. Its equations become singular again where the lid's panels do not resolve the waves; with

    tau = 1 + (K^2 a/4)^2   (a the area of the panel)

they stay regular there; where panels are a sixth of a wave length or less the lid is rigid but for 8 %. All this is real, so
w does not mix the phases of the potential: where a body makes no waves its damping stays near zero.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.bem_panels import HullPanels
from ogilvie.hydro.bem_parity import by_parity, parities, require_finite

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

#: Mirror signs (3,) of the receiving copy -> (S, D), each (n, n): potential at that copy's centres due to sources and dipoles
#: on the stored panels; the free term is in D of the first copy.
Influence = Callable[[Array], tuple[Complex, Complex]]


def force_vectors(panels: HullPanels, influence: Influence, *, K: float) -> Complex:
    """Return g: integral of n_i phi dS = sum over copies c and panels p of dof_signs[c, i] g[i, p] v[c, p].

    Parameters
    ----------
    panels : HullPanels
    influence : callable
        See :data:`Influence`; on the lid at the points of :attr:`HullPanels.points`.
    K : float
        omega^2/g, 1/m; of no account without a lid.

    Returns
    -------
    (6, n_hull) complex array
        m3 (translations) or m4 (rotations) per unit of normal velocity, in the time convention of `influence`.

    Raises
    ------
    ConvergenceError
        The influence matrices hold NaN.
    """
    from scipy.linalg import lu_factor, lu_solve

    loads = np.zeros((6, panels.n_hull + panels.n_lid))
    loads[:, : panels.n_hull] = panels.modes * panels.hull.areas
    copies = [influence(mirror) for mirror in panels.images]
    require_finite(copies, purpose="solve_bem")
    g = np.empty((6, panels.n_hull), dtype=complex)
    for signs, (S, D) in zip(parities(panels), by_parity(copies), strict=True):
        i = np.flatnonzero((panels.dof_signs == signs[:, None]).all(axis=0))
        if len(i) == 0:
            continue
        tie_lid(S, D, K=K, areas=panels.facets.areas[panels.n_hull :])
        lu = lu_factor(D, overwrite_a=True, check_finite=False)
        y = lu_solve(lu, loads[i].T.astype(complex), trans=1, check_finite=False)
        g[i] = (S.T @ y)[: panels.n_hull].T
    return g


def tie_lid(S: Complex, D: Complex, *, K: float, areas: Array) -> Array:
    """Replace the last equations of (n, n) matrices, those of lid panels with areas (n_lid,), by mu + tau w = 0, in place.

    Returns
    -------
    (n,) array
        What the equations have been multiplied with: 1 on the hull, tau on the lid.
    """
    lid = np.arange(len(D) - len(areas), len(D))
    factor = np.concatenate([np.ones(len(D) - len(areas)), 1.0 + (0.25 * K**2 * areas) ** 2])
    D[:, lid] = -K * S[:, lid]
    D[lid] *= factor[lid, None]
    S[lid] *= factor[lid, None]
    D[lid, lid] += 1.0
    return factor
