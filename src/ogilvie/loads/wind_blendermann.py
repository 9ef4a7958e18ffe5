"""Blendermann's wind loads on ships by type."""

import numpy as np

from ogilvie.errors import InputError
from ogilvie.loads.wind_coefficients import WindCoefficients
from ogilvie.waves.gust import positive

#: Ship type: CD_t, CD_l,AF from ahead, CD_l,AF from astern, delta, kappa.
BLENDERMANN = {
    "car carrier": (0.95, 0.55, 0.60, 0.80, 1.2),
    "cargo vessel, loaded": (0.85, 0.65, 0.55, 0.40, 1.7),
    "cargo vessel, containers on deck": (0.85, 0.55, 0.50, 0.40, 1.4),
    "container ship, loaded": (0.90, 0.55, 0.55, 0.40, 1.4),
    "destroyer": (0.85, 0.60, 0.65, 0.65, 1.1),
    "diving support vessel": (0.90, 0.60, 0.80, 0.55, 1.7),
    "drilling vessel": (1.00, 0.85, 0.925, 0.10, 1.7),
    "ferry": (0.90, 0.45, 0.50, 0.80, 1.1),
    "fishing vessel": (0.95, 0.70, 0.70, 0.40, 1.1),
    "liquefied natural gas tanker": (0.70, 0.60, 0.65, 0.50, 1.1),
    "offshore supply vessel": (0.90, 0.55, 0.80, 0.55, 1.2),
    "passenger liner": (0.90, 0.40, 0.40, 0.80, 1.2),
    "research vessel": (0.85, 0.55, 0.65, 0.60, 1.4),
    "speed boat": (0.90, 0.55, 0.60, 0.60, 1.1),
    "tanker, loaded": (0.70, 0.90, 0.55, 0.40, 3.1),
    "tanker, in ballast": (0.70, 0.75, 0.55, 0.40, 2.2),
    "tender": (0.85, 0.55, 0.55, 0.65, 1.1),
}


def blendermann_wind(
    ship_type: str,
    *,
    frontal_area: float,
    lateral_area: float,
    length: float,
    centroid_height: float,
    centroid_x: float = 0.0,
) -> WindCoefficients:
    """Return the wind coefficients of a type of ship after Blendermann.

    Parameters
    ----------
    ship_type : str
        A name of :data:`BLENDERMANN`, e.g. "container ship, loaded".
    frontal_area, lateral_area : float
        A_F and A_L above the water, m2.
    length : float
        L over all, m.
    centroid_height : float
        s_H, height of the centroid of the lateral area above the water, m.
    centroid_x : float
        s_L, distance of that centroid ahead of half the length, m.

    Returns
    -------
    WindCoefficients
        About half the length, on the waterline.

    Raises
    ------
    InputError
        Unknown type, a dimension that is not positive, centroid outside the ship.

    Notes
    -----
    For a wind that comes from an angle g off the bow (to starboard; the other side is the mirror image), with
    CD_l = CD_l,AF A_F/A_L, CD_l,AF that from ahead up to 90 deg and that from astern beyond:

    D = 1 - (delta/2) (1 - CD_l/CD_t) sin^2 2g, CX = -CD_l,AF cos g / D, CY = CD_t sin g / D,
    CK = -kappa (s_H/H) CY with H = A_L/L, CN = (s_L/L - 0.18 (g - pi/2)) CY.

    CK is negative where CY is positive: a wind from starboard puts the port side down. The drilling vessel has the mean of the
    range that is published for it.

    References
    ----------
    Blendermann (1994), Parameter identification of wind loads on ships, J. Wind Eng. Ind. Aerodyn. 51, 339-351.
    Fossen (2011), Handbook of marine craft hydrodynamics and motion control, Table 8.1.

    Examples
    --------
    >>> ship = blendermann_wind("ferry", frontal_area=500, lateral_area=2500, length=150, centroid_height=9)
    >>> ship(np.pi / 2).round(3) + 0.0  # from starboard: to port, port side down
    array([ 0.   ,  0.9  , -0.535,  0.   ])
    """
    if ship_type not in BLENDERMANN:
        raise InputError(f"blendermann_wind: a ship type among {'; '.join(BLENDERMANN)} expected, {ship_type!r} found.")
    A_F, A_L = (
        positive(frontal_area, "blendermann_wind: frontal_area"),
        positive(lateral_area, "blendermann_wind: lateral_area"),
    )
    L, s_H = positive(length, "blendermann_wind: length"), positive(centroid_height, "blendermann_wind: centroid_height")
    if not abs(centroid_x) < 0.5 * L:
        raise InputError(f"blendermann_wind: centroid_x within half the length {L:.4g} m expected, {centroid_x!r} found.")
    CD_t, ahead, astern, delta, kappa = BLENDERMANN[ship_type]
    angle = np.linspace(0.0, np.pi, 181)  # blows to
    g = np.pi - angle
    CD_AF = np.where(angle >= 0.5 * np.pi, ahead, astern)
    D = 1.0 - 0.5 * delta * (1.0 - CD_AF * A_F / A_L / CD_t) * np.sin(2.0 * g) ** 2
    CY = CD_t * np.sin(g) / D
    CY[[0, -1]] = 0.0
    return WindCoefficients(
        angle,
        -CD_AF * np.cos(g) / D,
        CY,
        -kappa * s_H * L / A_L * CY,
        (centroid_x / L - 0.18 * (g - 0.5 * np.pi)) * CY,
        frontal_area=A_F,
        lateral_area=A_L,
        length=L,
        interpolation="linear",
        name=f"Blendermann, {ship_type}",
    )
