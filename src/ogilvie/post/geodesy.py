"""From a plane that touches the Earth to latitude and longitude on the WGS 84 ellipsoid."""

from dataclasses import dataclass
from math import atan2, cos, hypot, pi, sin, sqrt

from ogilvie.errors import InputError

#: WGS 84: semi-major axis, m, and flattening (NGA.STND.0036).
SEMI_MAJOR, FLATTENING = 6378137.0, 1.0 / 298.257223563
_E2 = FLATTENING * (2.0 - FLATTENING)

Vector = tuple[float, float, float]


def earth_centred(latitude: float, longitude: float) -> Vector:
    """Return the Earth-centred coordinates (m) of a point on the ellipsoid, rad.

    Examples
    --------
    >>> earth_centred(0.0, 0.0)
    (6378137.0, 0.0, 0.0)
    """
    n = SEMI_MAJOR / sqrt(1.0 - _E2 * sin(latitude) ** 2)
    return n * cos(latitude) * cos(longitude), n * cos(latitude) * sin(longitude), n * (1.0 - _E2) * sin(latitude)


def geographic(x: float, y: float, z: float) -> tuple[float, float]:
    """Return latitude and longitude (rad) of a point near the surface, from its Earth-centred coordinates (m).

    Notes
    -----
    tan(lat) = (z + e'^2 b sin^3 u) / (p - e^2 a cos^3 u), tan u = z a / (p b): exact on the ellipsoid.

    References
    ----------
    Bowring, B. R.: Transformation from spatial to geographical coordinates. Survey Review 23 (1976) 323-327.
    """
    a, b, p = SEMI_MAJOR, SEMI_MAJOR * (1.0 - FLATTENING), hypot(x, y)
    u = atan2(z * a, p * b)
    latitude = atan2(z + _E2 / (1.0 - _E2) * b * sin(u) ** 3, p - _E2 * a * cos(u) ** 3)
    return latitude, atan2(y, x)


def local_axes(latitude: float, longitude: float) -> tuple[Vector, Vector]:
    """Return the unit vectors to the East and to the North of a point, in Earth-centred axes."""
    sp, cp, sl, cl = sin(latitude), cos(latitude), sin(longitude), cos(longitude)
    return (-sl, cl, 0.0), (-sp * cl, -sp * sl, cp)


@dataclass(frozen=True)
class TangentPlane:
    """The plane that touches the ellipsoid at an origin; points on it go straight down to the ellipsoid.

    Parameters
    ----------
    latitude, longitude : float
        Of the origin, positive to the North and to the East, rad.

    Raises
    ------
    InputError
        Latitude at or beyond the poles, longitude beyond +-180 deg.

    Notes
    -----
    Distances from the origin come out short by d^3 / (3 R^2): 8 mm at 10 km, 8 m at 100 km.

    Examples
    --------
    >>> from math import degrees
    >>> lat, lon = TangentPlane(0.0, 0.0).position(east=1852.0, north=0.0)
    >>> round(60 * degrees(lon), 4)  # a minute of the equator has 1855.3 m
    0.9982
    """

    latitude: float
    longitude: float

    def __post_init__(self) -> None:
        if not (abs(self.latitude) < 0.5 * pi and abs(self.longitude) <= pi):
            raise InputError(
                "origin: latitude between the poles and longitude within +-pi in rad expected, "
                f"({self.latitude!r}, {self.longitude!r}) found."
            )

    def position(self, east: float, north: float) -> tuple[float, float]:
        """Return latitude and longitude (rad) of a point of the plane (m)."""
        origin = earth_centred(self.latitude, self.longitude)
        offset = self._vector(east, north)
        return geographic(*(o + d for o, d in zip(origin, offset, strict=True)))

    def azimuth(self, east: float, north: float, *, at: tuple[float, float]) -> float:
        """Return the direction of a vector of the plane, clockwise from the North of the position `at` (rad), 0 to 2 pi."""
        vector = self._vector(east, north)
        to_east, to_north = (sum(a * v for a, v in zip(axis, vector, strict=True)) for axis in local_axes(*at))
        return atan2(to_east, to_north) % (2.0 * pi)

    def _vector(self, east: float, north: float) -> Vector:
        e, n = local_axes(self.latitude, self.longitude)
        return east * e[0] + north * n[0], east * e[1] + north * n[1], east * e[2] + north * n[2]
