"""Eddy-making roll damping of naked sections by Ikeda's formula."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.loads.given import column

Array = NDArray[Any]


def lewis_coefficients(ratio: ArrayLike, sigma: ArrayLike) -> tuple[Array, Array]:
    """Return a1 and a3 of the Lewis sections with half-breadth over draught H0 and area coefficient sigma.

    Notes
    -----
    c = 3 + 4 sigma / pi + (1 - 4 sigma / pi) k^2, k = (H0 - 1) / (H0 + 1); a3 = (3 - c + (9 - 2 c)^1/2) / c, a1 = k (1 + a3).
    Where c > 4.5 there is no such section and that with c = 4.5, the fullest, is taken.

    References
    ----------
    Lewis (1929), The inertia of the water surrounding a vibrating ship; von Kerczek and Tuck (1969), The representation of
    ship hulls by conformal mapping functions.

    Examples
    --------
    >>> a1, a3 = lewis_coefficients(1.0, np.pi / 4)  # a semicircle
    >>> round(float(a1), 12), abs(round(float(a3), 12))
    (0.0, 0.0)
    """
    H0, s = np.asarray(ratio, dtype=float), np.asarray(sigma, dtype=float)
    k, q = (H0 - 1.0) / (H0 + 1.0), 4.0 * s / np.pi
    c = np.minimum(3.0 + q + (1.0 - q) * k**2, 4.5)
    a3 = (3.0 - c + np.sqrt(9.0 - 2.0 * c)) / c
    return k * (1.0 + a3), a3


def bilge_radius(breadth: ArrayLike, draught: ArrayLike, area: ArrayLike) -> Array:
    """Return the bilge radius of sections with a flat bottom and upright sides of this area, at most draught or half-breadth.

    Notes
    -----
    B d - A = 2 (1 - pi/4) R^2, both bilges, or R = 2 d (H0 (sigma - 1) / (pi - 4))^1/2.

    References
    ----------
    Ikeda, Himeno, Tanaka (1978), A prediction method for ship roll damping, report 00405, University of Osaka Prefecture.

    Examples
    --------
    >>> round(float(bilge_radius(10.0, 4.0, 10.0 * 4.0 - 2 * (1 - np.pi / 4) * 1.5**2)), 12)
    1.5
    """
    B, d, A = (np.asarray(v, dtype=float) for v in (breadth, draught, area))
    R = np.sqrt(np.maximum(B * d - A, 0.0) / (2.0 - 0.5 * np.pi))
    return np.minimum(R, np.minimum(d, 0.5 * B))


def eddy_coefficient(
    breadth: ArrayLike, draught: ArrayLike, area: ArrayLike, *, og: float, radius: ArrayLike | None = None
) -> Array:
    """Return the coefficient C_R (n,) of the eddy-making moment of sections that roll about an axis.

    Parameters
    ----------
    breadth, draught, area : (n,) array
        Of the sections, m and m2.
    og : float
        Depth of the roll axis below the still water, m (negative above).
    radius : (n,) array, optional
        Bilge radius, m; by default :func:`bilge_radius`.

    Returns
    -------
    (n,) array
        Zero for sections without breadth, and for those less deep than the axis, where the formula does not hold.

    Notes
    -----
    The moment of a metre of hull is 1/2 rho d^4 C_R |p| p, so that it damps as (4 / 3 pi) rho d^4 omega phi_a C_R. With the
    Lewis section (a1, a3, M = B / (2 (1 + a1 + a3))), r_max the largest distance of its contour from the origin at psi = 0 or
    1/2 arccos(a1 (1 + a3) / (4 a3)):

    C_R = (r_max/d)^2 C_p ((1 - f1 R/d)(1 - OG/d - f1 R/d) + f2 (H0 - f1 R/d)^2),
    C_p = (0.87 exp(-g) - 4 exp(-0.187 g) + 3) / 2,
    g = pi^1/2 f3 (r_max + 2 M / H (A^2 + B^2)^1/2) / (2 d (1 - OG/d) (H0' sigma')^1/2), H0' = H0 / (1 - OG/d), sigma' =
    (sigma - OG/d) / (1 - OG/d), f1 = (1 + tanh(20 (sigma - 0.7))) / 2, f2 = (1 - cos(pi sigma)) / 2 - 1.5 (1 - exp(-5 (1 -
    sigma))) sin^2(pi sigma), f3 = 1 + 4 exp(-1.65e5 (1 - sigma)^2), and H, A, B the polynomials of a1, a3 in :func:`_speed`.

    Wide flat sections (H0 of 5 and more, at transom sterns) get far too much damping: the formula was made for sections of
    cargo ships.

    References
    ----------
    Ikeda, Himeno, Tanaka (1978), On eddy making component of roll damping force on naked hull, J. Soc. Naval Arch. Japan 142;
    ITTC Recommended Procedure 7.5-02-07-04.5, section 2.2.4.

    Examples
    --------
    >>> round(float(eddy_coefficient([0.28], [0.112], [0.28 * 0.112 * 0.995], og=0.0, radius=[0.02])[0]), 2)  # measured 0.94
    0.94
    """
    B = column(breadth, "breadth (m)", least=0.0)
    d, S = (column(v, k, n=len(B), least=0.0) for v, k in ((draught, "draught (m)"), (area, "area (m2)")))
    R = bilge_radius(B, d, S) if radius is None else column(radius, "radius (m)", n=len(B), least=0.0)
    C = np.zeros(len(B))
    kept = (B > 0.0) & (S > 0.0) & (d > max(1.001 * og, 0.0)) & (S - B * og > 0.0)
    if kept.any():
        C[kept] = _coefficient(B[kept], d[kept], S[kept], R[kept], og)
    return C


def _coefficient(B: Array, d: Array, S: Array, R: Array, og: float) -> Array:
    H0, s, o, b = 0.5 * B / d, np.minimum(S / (B * d), 1.0), og / d, R / d
    f1 = 0.5 * (1.0 + np.tanh(20.0 * (s - 0.7)))
    f2 = 0.5 * (1.0 - np.cos(np.pi * s)) - 1.5 * (1.0 - np.exp(-5.0 * (1.0 - s))) * np.sin(np.pi * s) ** 2
    f3 = 1.0 + 4.0 * np.exp(-1.65e5 * (1.0 - s) ** 2)
    r, speed = _speed(B, H0, s)
    root = np.sqrt(H0 / (1.0 - o) * (s - o) / (1.0 - o))
    g = np.sqrt(np.pi) * f3 * speed / (2.0 * d * (1.0 - o) * root)
    Cp = 0.5 * (0.87 * np.exp(-g) - 4.0 * np.exp(-0.187 * g) + 3.0)
    lever = (1.0 - f1 * b) * (1.0 - o - f1 * b) + f2 * (H0 - f1 * b) ** 2
    return (r / d) ** 2 * Cp * lever


def _speed(B: Array, H0: Array, s: Array) -> tuple[Array, Array]:
    """Return r_max and the largest velocity on the contour over the rate of roll, r_max + 2 M / H (A^2 + B^2)^1/2, m."""
    a, c = lewis_coefficients(H0, s)  # a1, a3
    M = 0.5 * B / (1.0 + a + c)

    def distance(psi: Array) -> Array:
        across = (1.0 + a) * np.sin(psi) - c * np.sin(3.0 * psi)
        down = (1.0 - a) * np.cos(psi) + c * np.cos(3.0 * psi)
        return M * np.hypot(across, down)

    ratio = a * (1.0 + c) / np.where(np.abs(c) > 1e-12, 4.0 * c, np.inf)
    inside = np.where(np.abs(ratio) <= 1.0, 0.5 * np.arccos(np.clip(ratio, -1.0, 1.0)), 0.0)
    psi = np.where(distance(inside) > distance(np.zeros_like(inside)), inside, 0.0)
    H = 1.0 + a**2 + 9.0 * c**2 + 2.0 * a * (1.0 - 3.0 * c) * np.cos(2.0 * psi) - 6.0 * c * np.cos(4.0 * psi)
    first = (6.0 - 3.0 * a) * c**2 + (a**2 - 3.0 * a) * c + a**2
    second = (6.0 + 3.0 * a) * c**2 + (a**2 + 3.0 * a) * c + a**2
    X = -2.0 * c * np.cos(5.0 * psi) + a * (1.0 - c) * np.cos(3.0 * psi) + first * np.cos(psi)
    Y = -2.0 * c * np.sin(5.0 * psi) + a * (1.0 - c) * np.sin(3.0 * psi) + second * np.sin(psi)
    r = distance(psi)
    return r, r + 2.0 * M / H * np.hypot(X, Y)
