"""Wave forces between the tabulated frequencies and headings, as complex numbers."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.mirror import TURN, forces_are_symmetric, full_circle, matrices_are_symmetric
from ogilvie.loads.base import ComplexArray

Array = NDArray[Any]
_PORT_STARBOARD = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
_TOLERANCE = 1e-6  # rad
_WIDEST_GAP = np.pi / 3  # rad; headings further apart are not interpolated between


@dataclass(frozen=True, eq=False)
class Headings:
    """Tabulated headings in ascending order from `start`, rad; periodic where they go all around."""

    values: Array
    periodic: bool

    @property
    def start(self) -> float:
        """First heading, rad."""
        return float(self.values[0])

    @property
    def text(self) -> str:
        """The range in degrees."""
        return f"{np.degrees(self.values[0]):.4g}..{np.degrees(self.values[-1]):.4g} deg"


def symmetric_headings(hydro: xr.Dataset, table: ComplexArray) -> tuple[Headings, ComplexArray]:
    """Return headings and forces (n_w, n_b, 6) that go as far around as the data and the hull's symmetry allow.

    Notes
    -----
    For a hull that is its own mirror image F(-b) = S F(b) with S = diag(1, -1, 1, -1, 1, -1).
    """
    b = hydro.wave_direction.values.astype(float)
    symmetric = matrices_are_symmetric(hydro) and forces_are_symmetric(b, table, _PORT_STARBOARD)
    return unwrapped(*full_circle(b, table, _PORT_STARBOARD if symmetric else None))


def unwrapped(b: Array, table: ComplexArray) -> tuple[Headings, ComplexArray]:
    """Begin after the largest gap, so that the headings ascend; no gap larger than the others means all around."""
    if len(b) == 1:
        return Headings(b, False), table
    gaps = np.diff(np.append(b, b[0] + TURN))  # gap i follows heading i
    first = (int(gaps.argmax()) + 1) % len(b)
    periodic = len(b) >= 4 and gaps.max() <= 1.5 * np.sort(gaps)[-2]
    turned = np.roll(b, -first)
    turned = turned + TURN * (turned < turned[0])
    if turned[0] > np.pi:
        turned = turned - TURN
    return Headings(turned, periodic), np.roll(table, -first, axis=1)


def evaluate(omega: Array, headings: Headings, table: ComplexArray, w: Array, b: Array) -> ComplexArray:
    """Return the forces (n, 6) at frequencies w and headings b, each (n,), from the table (n_w, n_b, 6)."""
    across = heading_weights(headings, b)  # (n, n_b)
    used = np.flatnonzero(np.any(across != 0.0, axis=0))
    if len(omega) == 1:
        along = np.broadcast_to(table[:, used], (len(w), len(used), table.shape[2]))
    else:
        along = interpolated(omega, table[:, used], w)
    return np.einsum("nb,nbi->ni", across[:, used], along)


def heading_weights(headings: Headings, b: Array, *, derivative: int = 0) -> Array:
    """Return the weights (n, n_b) of the tabulated headings in the value, or a derivative, at each heading b (n,).

    Raises
    ------
    InputError
        Heading outside the data.
    """
    t = headings.values
    x = _from_first(t, b)
    _refuse_outside(headings, x)
    if headings.periodic:
        from scipy.interpolate import CubicSpline

        ring = np.eye(len(t))[np.append(np.arange(len(t)), 0)]
        return CubicSpline(np.append(t, t[0] + TURN), ring, bc_type="periodic")(x, derivative)
    x = np.clip(x, t[0], t[-1])
    if len(t) == 1:
        return np.full((len(b), 1), float(derivative == 0))
    return interpolated(t, np.eye(len(t)), x, derivative=derivative)


def evaluate_turning(omega: Array, headings: Headings, table: ComplexArray, w: Array, b: Array) -> ComplexArray:
    """Return the forces (n_h, n, 6) at frequencies w (n,) and headings b (n_h, n) from the table (n_w, n_b, 6)."""
    along = np.broadcast_to(table, (len(w), *table.shape[1:])) if len(omega) == 1 else interpolated(omega, table, w)
    across = heading_weights(headings, b.ravel()).reshape(*b.shape, -1)
    return np.einsum("hnb,nbi->hni", across, along)


def _from_first(t: Array, b: Any) -> Any:
    """Return headings b, rad, in the turn that begins at the first of the tabulated ones t."""
    return t[0] + np.mod(b - t[0] + _TOLERANCE, TURN) - _TOLERANCE


def run_of(headings: Headings, b: float) -> tuple[float, float]:
    """Return the ends (rad) of the run of headings, without too wide a gap, in or next to which the heading b lies.

    Examples
    --------
    >>> np.degrees(run_of(Headings(np.radians([0.0, 30.0, 150.0, 180.0]), False), np.radians(160.0))).round()
    array([150., 180.])
    """
    t = headings.values
    cuts = np.flatnonzero(np.diff(t) > _WIDEST_GAP + _TOLERANCE)
    starts, ends = t[np.r_[0, cuts + 1]], t[np.r_[cuts, len(t) - 1]]
    x = _from_first(t, b)
    k = int(np.clip(np.searchsorted(starts, x + _TOLERANCE, side="right") - 1, 0, len(starts) - 1))
    return float(starts[k]), float(ends[k])


def vessel_headings(headings: Headings, direction: Array, heading: float) -> tuple[float, float] | None:
    """Return the headings of a vessel, rad, between which waves of these directions (n,) meet it within the data.

    None where the data go all around. Counted from the vessel's `heading`, at which the waves lie in some run of the data.

    Examples
    --------
    >>> lo, hi = vessel_headings(Headings(np.radians([90.0, 135.0, 180.0]), False), np.radians([120.0, 130.0]), 0.0)
    >>> np.degrees([lo, hi]).round()
    array([-50.,  30.])
    """
    if headings.periodic:
        return None
    t, lo, hi = headings.values, -np.inf, np.inf
    for b in direction - heading:
        x = _from_first(t, b)
        start, end = run_of(headings, b)
        lo, hi = max(lo, x - end), min(hi, x - start)
    return heading + lo, heading + hi


def _refuse_outside(headings: Headings, x: Array) -> None:
    """Refuse headings beyond the data and headings in a gap that is too wide to interpolate across."""
    ring = np.append(headings.values, headings.start + TURN)
    i = np.clip(np.searchsorted(ring, x, side="right") - 1, 0, len(ring) - 2)
    at_node = np.minimum(np.abs(x - ring[i]), np.abs(x - ring[i + 1])) <= _TOLERANCE
    widest = np.diff(ring)[i] > _WIDEST_GAP + _TOLERANCE
    beyond = np.zeros(len(x), dtype=bool) if headings.periodic else x > headings.values[-1] + _TOLERANCE
    bad = ~at_node & (widest | beyond)
    if bad.any():
        found = ", ".join(f"{np.degrees((v + np.pi) % TURN - np.pi):.4g}" for v in np.unique(x[bad].round(9))[:5])
        given = ", ".join(f"{np.degrees(v):.4g}" for v in headings.values)
        raise InputError(
            f"WaveExcitation: headings relative to the bow among or between those of the coefficients ({given} deg, at most "
            f"{np.degrees(_WIDEST_GAP):.0f} deg apart) expected, {found} deg found. "
            "Compute or read coefficients for these headings."
        )


def interpolated(x: Array, y: NDArray, at: Array, *, derivative: int = 0) -> NDArray:
    """Cubic spline through the rows of y (not-a-knot), of lower degree where there are fewer than four points."""
    from scipy.interpolate import make_interp_spline

    return make_interp_spline(x, y, k=min(3, len(x) - 1))(at, derivative)
