"""Isherwood's regression of wind forces on merchant ships."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.loads.wind_coefficients import WindCoefficients
from ogilvie.waves.gust import positive

Array = NDArray[Any]

# Rows: angle off the bow that the wind comes from, 0 to 180 deg by 10 deg.
_CX = np.array(
    [
        [2.152, -5.00, 0.243, -0.164, 0, 0, 0],
        [1.714, -3.33, 0.145, -0.121, 0, 0, 0],
        [1.818, -3.97, 0.211, -0.143, 0, 0, 0.033],
        [1.965, -4.81, 0.243, -0.154, 0, 0, 0.041],
        [2.333, -5.99, 0.247, -0.190, 0, 0, 0.042],
        [1.726, -6.54, 0.189, -0.173, 0.348, 0, 0.048],
        [0.913, -4.68, 0, -0.104, 0.482, 0, 0.052],
        [0.457, -2.88, 0, -0.068, 0.346, 0, 0.043],
        [0.341, -0.91, 0, -0.031, 0, 0, 0.032],
        [0.355, 0, 0, 0, -0.247, 0, 0.018],
        [0.601, 0, 0, 0, -0.372, 0, -0.020],
        [0.651, 1.29, 0, 0, -0.582, 0, -0.031],
        [0.564, 2.54, 0, 0, -0.748, 0, -0.024],
        [-0.142, 3.58, 0, 0.047, -0.700, 0, -0.028],
        [-0.677, 3.64, 0, 0.069, -0.529, 0, -0.032],
        [-0.723, 3.14, 0, 0.064, -0.475, 0, -0.032],
        [-2.148, 2.56, 0, 0.081, 0, 1.27, -0.027],
        [-2.707, 3.97, -0.175, 0.126, 0, 1.81, 0],
        [-2.529, 3.76, -0.174, 0.128, 0, 1.55, 0],
    ]
)
_CY = np.array(
    [
        [0, 0, 0, 0, 0, 0, 0],
        [0.096, 0.22, 0, 0, 0, 0, 0],
        [0.176, 0.71, 0, 0, 0, 0, 0],
        [0.225, 1.38, 0, 0.023, 0, -0.29, 0],
        [0.329, 1.82, 0, 0.043, 0, -0.59, 0],
        [1.164, 1.26, 0.121, 0, -0.242, -0.95, 0],
        [1.163, 0.96, 0.101, 0, -0.177, -0.88, 0],
        [0.916, 0.53, 0.069, 0, 0, -0.65, 0],
        [0.844, 0.55, 0.082, 0, 0, -0.54, 0],
        [0.889, 0, 0.138, 0, 0, -0.66, 0],
        [0.799, 0, 0.155, 0, 0, -0.55, 0],
        [0.797, 0, 0.151, 0, 0, -0.55, 0],
        [0.996, 0, 0.184, 0, -0.212, -0.66, 0.34],
        [1.014, 0, 0.191, 0, -0.280, -0.69, 0.44],
        [0.784, 0, 0.166, 0, -0.209, -0.53, 0.38],
        [0.536, 0, 0.176, -0.029, -0.163, 0, 0.27],
        [0.251, 0, 0.106, -0.022, 0, 0, 0],
        [0.125, 0, 0.046, -0.012, 0, 0, 0],
        [0, 0, 0, 0, 0, 0, 0],
    ]
)
_CN = np.array(
    [
        [0, 0, 0, 0, 0, 0],
        [0.0596, 0.061, 0, 0, 0, -0.074],
        [0.1106, 0.204, 0, 0, 0, -0.170],
        [0.2258, 0.245, 0, 0, 0, -0.380],
        [0.2017, 0.457, 0, 0.0067, 0, -0.472],
        [0.1759, 0.573, 0, 0.0118, 0, -0.523],
        [0.1925, 0.480, 0, 0.0115, 0, -0.546],
        [0.2133, 0.315, 0, 0.0081, 0, -0.526],
        [0.1827, 0.254, 0, 0.0053, 0, -0.443],
        [0.2627, 0, 0, 0, 0, -0.508],
        [0.2102, 0, -0.0195, 0, 0.0335, -0.492],
        [0.1567, 0, -0.0258, 0, 0.0497, -0.457],
        [0.0801, 0, -0.0311, 0, 0.0740, -0.396],
        [-0.0189, 0, -0.0488, 0.0101, 0.1128, -0.420],
        [0.0256, 0, -0.0422, 0.0100, 0.0889, -0.463],
        [0.0552, 0, -0.0381, 0.0109, 0.0689, -0.476],
        [0.0881, 0, -0.0306, 0.0091, 0.0366, -0.415],
        [0.0851, 0, -0.0122, 0.0025, 0, -0.220],
        [0, 0, 0, 0, 0, 0],
    ]
)


def isherwood_wind(
    *,
    length: float,
    beam: float,
    frontal_area: float,
    lateral_area: float,
    superstructure_area: float,
    perimeter: float,
    centroid_from_bow: float,
    masts: int = 0,
    centroid_height: float | None = None,
) -> WindCoefficients:
    """Return the wind coefficients of a merchant ship after Isherwood.

    Parameters
    ----------
    length, beam : float
        L over all and B, m.
    frontal_area, lateral_area : float
        A_F and A_L above the water, m2.
    superstructure_area : float
        A_SS, lateral area of the superstructure, m2.
    perimeter : float
        S, length of the perimeter of the lateral projection without the waterline and slender bodies such as masts, m.
    centroid_from_bow : float
        C, distance of the centroid of the lateral area from the bow, m.
    masts : int
        M, number of distinct groups of masts or king posts seen from the side, without king posts close to the bridge front.
    centroid_height : float, optional
        Height of the centroid of the lateral area above the water, m. The roll moment is then that of the sway force there; it
        is no part of the regression and is zero without.

    Returns
    -------
    WindCoefficients
        About half the length, on the waterline.

    Raises
    ------
    InputError
        A dimension that is not positive, centroid outside the ship, superstructure larger than the lateral area.

    Notes
    -----
    -CX = A0 + A1 2 A_L/L^2 + A2 2 A_F/B^2 + A3 L/B + A4 S/L + A5 C/L + A6 M; CY likewise with A6 M -> B6 A_SS/A_L; CN likewise
    without a last term; coefficients tabulated every 10 deg. Regression of model tests of merchant ships: hold it against tests
    where the ship is unusual. Standard errors of the fit are in the paper.

    References
    ----------
    Isherwood (1973), Wind resistance of merchant ships, Trans. RINA 115, 327-338.

    Examples
    --------
    >>> ship = isherwood_wind(length=160, beam=23, frontal_area=500, lateral_area=2100, superstructure_area=600, perimeter=210,
    ...     centroid_from_bow=82, masts=2)
    >>> ship(np.pi).round(3)[:2] + 0.0  # wind from ahead
    array([-0.65,  0.  ])
    """
    L, B = positive(length, "isherwood_wind: length"), positive(beam, "isherwood_wind: beam")
    A_F, A_L = positive(frontal_area, "isherwood_wind: frontal_area"), positive(lateral_area, "isherwood_wind: lateral_area")
    S, C = positive(perimeter, "isherwood_wind: perimeter"), positive(centroid_from_bow, "isherwood_wind: centroid_from_bow")
    A_SS = float(superstructure_area)
    if not 0.0 <= A_SS <= A_L:
        raise InputError(f"isherwood_wind: superstructure_area from 0 to lateral_area expected, {superstructure_area!r} found.")
    if L < C:
        raise InputError(f"isherwood_wind: centroid_from_bow below the length {L:.4g} m expected, {C:.4g} m found.")
    if isinstance(masts, bool) or not isinstance(masts, int | np.integer) or masts < 0:
        raise InputError(f"isherwood_wind: masts, a whole number >= 0, expected, {masts!r} found.")
    shape = [1.0, 2.0 * A_L / L**2, 2.0 * A_F / B**2, L / B, S / L, C / L]
    CX = -_CX @ [*shape, float(masts)]
    CY = _CY @ [*shape, A_SS / A_L]
    arm = 0.0 if centroid_height is None else positive(centroid_height, "isherwood_wind: centroid_height") * L / A_L
    # Tabulated from the bow to the stern; the wind blows to pi minus that angle.
    return WindCoefficients(
        np.linspace(0.0, np.pi, len(_CX)),
        CX[::-1],
        CY[::-1],
        -arm * CY[::-1],
        (_CN @ shape)[::-1],
        frontal_area=A_F,
        lateral_area=A_L,
        length=L,
        name="Isherwood",
    )
