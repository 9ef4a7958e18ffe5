"""Roll damping by bilge keels by Ikeda's formulas: normal force of the keels and the pressure that they cause on the hull."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def keel_damping(
    breadth: Array, draught: Array, area: Array, radius: Array, *, keel: Array, og: float, amplitude: Array
) -> tuple[Array, Array]:
    """Return the damping by normal force and by hull pressure of a metre of hull with a pair of keels, over rho omega phi_a.

    Parameters
    ----------
    breadth, draught, area, radius : (..., n) arrays
        Of the sections; bilge radius; m and m2.
    keel : (..., n) array
        Breadth of the keels, m.
    og : float
        Depth of the roll axis below the still water, m.
    amplitude : (..., 1) array
        Of roll, rad, > 0.

    Returns
    -------
    normal, pressure : (..., n) arrays
        B' / (rho omega phi_a), m4.

    Notes
    -----
    r = d ((H0 - 0.293 R/d)^2 + (1 - OG/d - 0.293 R/d)^2)^1/2 from the axis to the middle of the bilge, f = 1 + 0.3 exp(-160
    (1 - sigma)) the increase of the velocity there, C_D = 22.5 b / (pi r f phi_a) + 2.4:

    B'_N = (8 / 3 pi) rho r^3 b omega phi_a f^2 C_D; B'_H = (4 / 3 pi) rho r^2 d^2 omega phi_a f^2 I,

    I = 1.2 B + (C_D - 1.2) A: the pressure coefficient is +1.2 in front of a keel, falling linearly along the girth to zero
    at the centreline (waterline), and 1.2 - C_D behind it over the length S0 = 0.3 pi f r phi_a + 1.95 b. A and
    B are the levers of :func:`levers`. f enters both squared, as the pressure of a velocity f r p; some programs have it once
    in B'_N, which differs for sections with sigma > 0.98 alone.

    References
    ----------
    Ikeda, Himeno, Tanaka (1978), Components of roll damping of ship at forward speed, J. Soc. Naval Arch. Japan 143; Himeno
    (1981), Prediction of ship roll damping - state of the art, University of Michigan report 239; ITTC Recommended Procedure
    7.5-02-07-04.5, section 2.2.5.1.

    Examples
    --------
    >>> one = np.array([1.0])
    >>> N, H = keel_damping(25.4 * one, 9.5 * one, 233.0 * one, 3.3 * one, keel=0.35 * one, og=0.0, amplitude=0.1 * one)
    >>> bool(N > 0 and H > N)
    True
    """
    d, H0, sigma, m1 = draught, 0.5 * breadth / draught, area / (breadth * draught), radius / draught
    m2 = og / d
    f = 1.0 + 0.3 * np.exp(-160.0 * (1.0 - np.minimum(sigma, 1.0)))
    r = d * np.hypot(H0 - _CORNER * m1, 1.0 - m2 - _CORNER * m1)
    Cd = 22.5 * keel / (np.pi * r * f * amplitude) + 2.4
    S0 = 0.3 * np.pi * f * r * amplitude + 1.95 * keel
    behind, ahead = levers(H0, m1, m2, S0 / d)
    normal = 8.0 / (3.0 * np.pi) * r**3 * keel * f**2 * Cd
    I = 1.2 * ahead + (Cd - 1.2) * behind
    return normal, 4.0 / (3.0 * np.pi) * r**2 * d**2 * f**2 * I


_CORNER = 1.0 - np.sqrt(0.5)  # 0.293: distance of the middle of a bilge from the corner, in each direction, over the radius
_ARC = 1.0 - 0.25 * np.pi  # 0.215: by how much the girth from the middle of the bilge is less than to the corner


def levers(H0: Array, m1: Array, m2: Array, s: Array) -> tuple[Array, Array]:
    """Return the moments over d^2 of unit pressure behind both keels, over the length s, and of that falling off before them.

    Parameters
    ----------
    H0, m1, m2, s : arrays
        Half-breadth, bilge radius, depth of the axis and length behind the keel, all over the draught.

    Notes
    -----
    With m3 = 1 - m1 - m2 and m4 = H0 - m1 the distances of the centre of the bilge circle from the axis: A = (m3 + m4) m8 -
    m7^2, m7 = s - pi m1 / 4 (not below 0), m8 = m7 + (2^1/2 - 1) m1, or 2^1/2 (1 - cos(s / m1)) m1 where s ends on the arc;
    B = m4^3 / (3 (H0 - 0.215 m1)) + (1 - m1)^2 (2 m3 - m2) / (6 (1 - 0.215 m1)) + m1 (m3 m5 + m4 m6). m5, m6 are integrals of
    cos and sin over the arc, here in closed form; the published polynomials (0.414 H0 + 0.0651 m1^2 - ...) are the same to
    their three digits.

    Examples
    --------
    >>> A, B = levers(1.0, 0.0, 0.0, 0.2)  # a square about its waterline
    >>> round(float(A), 3), round(float(B), 3)  # 2 s - s^2, 1/3 + 1/3
    (0.36, 0.667)
    """
    H0, m1, m2, s = (np.asarray(v, dtype=float) for v in (H0, m1, m2, s))
    m3, m4, root = 1.0 - m1 - m2, H0 - m1, np.sqrt(2.0)
    flat = s > 0.25 * np.pi * m1
    m7 = np.where(flat, s - 0.25 * np.pi * m1, 0.0)
    on_arc = root * (1.0 - np.cos(np.minimum(s / np.maximum(m1, 1e-12), 0.25 * np.pi))) * m1
    m8 = np.where(flat, m7 + (root - 1.0) * m1, on_arc)
    side, bottom = 1.0 - _ARC * m1, H0 - _ARC * m1  # girth from the keel to the waterline, to the centreline
    near, far = _CORNER * m1, (0.25 * np.pi - np.sqrt(0.5)) * m1
    m5 = root - 1.0 - near / side + far / bottom
    m6 = root - 1.0 - near / bottom + far / side
    B = m4**3 / (3.0 * bottom) + (1.0 - m1) ** 2 * (2.0 * m3 - m2) / (6.0 * side) + m1 * (m3 * m5 + m4 * m6)
    return (m3 + m4) * m8 - m7**2, B
