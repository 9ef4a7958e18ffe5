"""Coefficients of the wind force against the direction of the relative wind, as data."""

from dataclasses import KW_ONLY, dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.waves.gust import positive

Array = NDArray[Any]

#: Intervals of the table in which the time loop looks up: whole degrees.
INTERVALS = 360
_ODD = (False, True, True, True)  # under a mirror about the centre plane: CX, CY, CK, CN


@dataclass(frozen=True, eq=False)
class WindCoefficients:
    """CX, CY, CK and CN of a vessel against the direction of the relative wind.

    Parameters
    ----------
    angle : (n,) array
        Direction the relative wind blows **to** in body axes, anticlockwise from +x, rad, increasing: pi is a wind from ahead,
        pi/2 one from starboard. (A wind that comes from an angle g off the bow, to starboard, blows to pi - g.)
    CX, CY : (n,) array
        Surge (forward) and sway (to port) force.
    CK, CN : (n,) array, optional
        Roll moment (port side up) and yaw moment (bow to port) about the `point` of :class:`WindForce`; zero if left out.
    frontal_area, lateral_area : float
        A_F, A_L, m2.
    length : float
        L, m.
    symmetry : {"xz", "none"}
        "xz": angles 0 to pi are given, the other side is their mirror image (CY, CK, CN change sign and are zero at the ends).
        "none": angles over a whole turn are given, first and last 2 pi apart or the last left out.
    interpolation : {"cubic", "linear"}
        Periodic spline or straight lines between the angles, resampled to whole degrees.
    name : str

    Raises
    ------
    InputError
        Shapes that differ, NaN, angles not increasing or not over the half or whole turn, ends that do not agree, no area.

    Notes
    -----
    X = q A_F CX, Y = q A_L CY, K = q A_L H CK, N = q A_L L CN with q = rho V^2/2 and H = A_L/L.

    References
    ----------
    Fossen (2011), Handbook of marine craft hydrodynamics and motion control, 8.1.

    Examples
    --------
    >>> angle = np.linspace(0.0, np.pi, 19)
    >>> plate = WindCoefficients(angle, 0.8 * np.cos(angle), np.sin(angle), frontal_area=300, lateral_area=900, length=100)
    >>> plate(np.array([np.pi, -np.pi / 2])).round(3) + 0.0
    array([[-0.8,  0. ,  0. ,  0. ],
           [ 0. , -1. ,  0. ,  0. ]])
    """

    angle: Array
    CX: Array
    CY: Array
    CK: Array | None = None
    CN: Array | None = None
    _: KW_ONLY
    frontal_area: float
    lateral_area: float
    length: float
    symmetry: Literal["xz", "none"] = "xz"
    interpolation: Literal["cubic", "linear"] = "cubic"
    name: str = "table"

    def __post_init__(self) -> None:
        for name in ("frontal_area", "lateral_area", "length"):
            object.__setattr__(self, name, positive(getattr(self, name), f"wind coefficients: {name}"))
        if self.symmetry not in ("xz", "none"):
            raise InputError(f"wind coefficients: symmetry 'xz' or 'none' expected, {self.symmetry!r} found.")
        if self.interpolation not in ("cubic", "linear"):
            raise InputError(f"wind coefficients: interpolation 'cubic' or 'linear' expected, {self.interpolation!r} found.")
        angle = _series(self.angle, "angle")
        if len(angle) < 3 or np.any(np.diff(angle) <= 0.0):
            raise InputError("wind coefficients: at least 3 increasing angles in rad expected, others found.")
        object.__setattr__(self, "angle", angle)
        for name in ("CX", "CY", "CK", "CN"):
            given = getattr(self, name)
            values = np.zeros(len(angle)) if given is None else _series(given, name)
            if len(values) != len(angle):
                raise InputError(f"wind coefficients: {name}, one per angle ({len(angle)}), expected, {len(values)} found.")
            values.setflags(write=False)
            object.__setattr__(self, name, values)
        angle.setflags(write=False)
        self._circle()

    def __call__(self, angle: ArrayLike) -> Array:
        """Return CX, CY, CK, CN, (..., 4), for directions (rad) the relative wind blows to."""
        table = self.pieces()
        s = np.remainder(np.asarray(angle, dtype=float), 2.0 * np.pi) * (INTERVALS / (2.0 * np.pi))
        i = np.minimum(s.astype(int), INTERVALS - 1)
        x = (s - i)[..., None]
        c = table[i]
        return c[..., 0] + x * (c[..., 1] + x * (c[..., 2] + x * c[..., 3]))

    def pieces(self) -> Array:
        """Return c0..c3 of the cubics c0 + c1 x + c2 x^2 + c3 x^3 of CX, CY, CK, CN over each degree, x = 0..1; (360, 4, 4)."""
        angle, values = self._circle()
        nodes = np.arange(INTERVALS + 1) * (2.0 * np.pi / INTERVALS)
        if self.interpolation == "linear":
            y = np.stack([np.interp(nodes, angle[:-1], v, period=2.0 * np.pi) for v in values[:-1].T], axis=-1)
            zero = np.zeros((INTERVALS, values.shape[1]))
            return np.stack([y[:-1], np.diff(y, axis=0), zero, zero], axis=-1)
        return _hermite(angle, values, nodes)

    def force_areas(self) -> Array:
        """Return :meth:`pieces` of X/q, Y/q, K/q, N/q; m2 and m3."""
        A_F, A_L = self.frontal_area, self.lateral_area
        scale = np.array([A_F, A_L, A_L**2 / self.length, A_L * self.length])
        return self.pieces() * scale[:, None]

    def _circle(self) -> tuple[Array, Array]:
        """Return angles over a whole turn, the last 2 pi after the first, and the values (n, 4) there."""
        angle = self.angle
        values = np.stack([self.CX, self.CY, self.CK, self.CN], axis=-1)  # type: ignore[list-item]
        if self.symmetry == "xz":
            return _mirrored(angle, values)
        turn = angle[-1] - angle[0]
        if abs(turn - 2.0 * np.pi) < 1e-6:
            if np.abs(values[-1] - values[0]).max() > 1e-9 * (1.0 + np.abs(values).max()):
                raise InputError("wind coefficients: the same values at both ends of the turn expected, others found.")
            angle, values = np.r_[angle[:-1], angle[0] + 2.0 * np.pi], np.r_[values[:-1], values[:1]]
        elif turn < 2.0 * np.pi and 2.0 * np.pi - turn <= 1.5 * np.diff(angle).max():
            angle, values = np.r_[angle, angle[0] + 2.0 * np.pi], np.r_[values, values[:1]]
        else:
            raise InputError(
                f"wind coefficients: angles over a whole turn (2 pi) expected without symmetry, {turn:.4g} rad found. Degrees?"
            )
        return angle, values


def _mirrored(angle: Array, values: Array) -> tuple[Array, Array]:
    """Add the mirror image of the half turn 0..pi."""
    if abs(angle[0]) > 1e-6 or abs(angle[-1] - np.pi) > 1e-6:
        raise InputError(
            f"wind coefficients: angles from 0 to pi rad expected with symmetry 'xz', {angle[0]:.4g} to {angle[-1]:.4g} found. "
            "Degrees? Or give the whole turn and symmetry='none'."
        )
    odd = np.array(_ODD)
    ends = np.abs(values[[0, -1]][:, odd]).max()
    if ends > 1e-9 * (1.0 + np.abs(values).max()):
        raise InputError(f"wind coefficients: CY = CK = CN = 0 at 0 and pi expected with symmetry 'xz', {ends:.4g} found.")
    values = values.copy()
    values[0, odd] = values[-1, odd] = 0.0
    sign = np.where(odd, -1.0, 1.0)
    angle = np.r_[0.0, angle[1:-1], np.pi]
    return np.r_[angle, 2.0 * np.pi - angle[-2::-1]], np.r_[values, sign * values[-2::-1]]


def _hermite(angle: Array, values: Array, nodes: Array) -> Array:
    """Return the cubics over each interval of the nodes with the values and slopes of the periodic spline; (n, m, 4)."""
    from scipy.interpolate import CubicSpline

    spline = CubicSpline(angle, values, axis=0, bc_type="periodic")
    h = nodes[1] - nodes[0]
    y, d = spline(nodes), h * spline(nodes, 1)
    rise = np.diff(y, axis=0)
    return np.stack([y[:-1], d[:-1], 3.0 * rise - 2.0 * d[:-1] - d[1:], d[:-1] + d[1:] - 2.0 * rise], axis=-1)


def _series(value: ArrayLike, name: str) -> Array:
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"wind coefficients: {name}, an array of numbers, expected, {type(value).__name__} found.") from None
    if array.ndim != 1 or not np.all(np.isfinite(array)):
        raise InputError(f"wind coefficients: {name}, a finite array of one axis, expected, shape {array.shape} found.")
    return array
