"""Added mass, damping and wave forces from the force vectors of one wavenumber (kernel; time factor exp(+i omega t)).

With forward speed U the normal velocity of unit displacement in dof j is i omega n_j + U m_j with m = (0, 0, 0, 0, n_3, -n_2),
and the force of a potential is

    F_i = rho integral of (i omega phi - U d phi/d x) n_i dS = rho integral of (i omega n_i - U m_i) phi dS

by Tuck's theorem without its integral along the waterline, which is of the order of the terms of U that the free-surface
condition leaves out; with it the relations of Timman and Newman would be violated. With T_ij = -rho integral of n_i phi_j
(phi_j the potential of unit velocity n_j) and m = C^T n that is

    A - i B/omega = T - (i U/omega) (T C - C^T T) + (U/omega)^2 C^T T C:    A35 = A35' - U B33/omega^2, B35 = B35' + U A33, ...
"""

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.bem_panels import HullPanels

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

#: C of the page above: m_5 = n_3, m_6 = -n_2.
SPEED_TERMS = np.zeros((6, 6))
SPEED_TERMS[2, 4], SPEED_TERMS[1, 5] = 1.0, -1.0


def radiation(panels: HullPanels, g: Complex, *, omega: float, rho: float, speed: float = 0.0) -> tuple[Array, Array]:
    """Return added mass and damping (6, 6) about O.

    Parameters
    ----------
    panels : HullPanels
    g : (6, n_hull) complex array
        Force vectors of the wavenumber that belongs to omega, exp(+i omega t).
    omega : float
        Frequency of oscillation, rad/s, > 0, or its limits 0 (at zero speed) and inf.
    rho, speed : float
        kg/m3, m/s.

    Notes
    -----
    At infinite frequency A = T and B = U (T C - C^T T), which is not zero at speed.
    """
    C = SPEED_TERMS
    T = -rho * (panels.dof_signs.T @ panels.dof_signs) * (g @ panels.modes.T)
    turn = speed * (T @ C - C.T @ T)
    if omega == np.inf:
        return T.real, turn.real
    if omega == 0.0:
        return T.real, np.zeros((6, 6))
    coefficient = T - 1j / omega * turn + (speed / omega) ** 2 * (C.T @ T @ C)
    return coefficient.real, -omega * coefficient.imag


def scattered(panels: HullPanels, g: Complex, v: Complex, *, omega: float, rho: float, speed: float = 0.0) -> Complex:
    """Return the force (..., 6) of a potential with normal velocity v (..., n_c, n_hull) that oscillates with omega (signed).

    Parameters
    ----------
    panels : HullPanels
    g : (6, n_hull) complex array
        Force vectors, exp(+i omega t); for negative omega the conjugate of those of -omega.
    v : (..., n_c, n_hull) complex array
        At each copy of the stored panels, m/s.
    omega, rho, speed : float
    """
    f = rho * np.einsum("...cp,ci,ip->...i", v, panels.dof_signs, g, optimize=True)
    return np.asarray(1j * omega * f - speed * (f @ SPEED_TERMS))
