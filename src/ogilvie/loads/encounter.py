"""The force of a sea on a vessel that may be anywhere in it, at any heading and speed: a compiled load.

Components of one direction make a group, and groups with the same frequencies share a table of the force over the heading
relative to the bow: a short-crested sea of many directions needs no larger table than a long-crested one.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import ComplexArray
from ogilvie.loads.interpolation import Headings, run_of, vessel_headings
from ogilvie.loads.kernel import ETA, MEAN_SPEED, ROTATION, SLOW, TIME, Kernel, load_kernel
from ogilvie.waves.field import Sea
from ogilvie.waves.sincos import sines_and_cosines

Array = NDArray[Any]
Force = Callable[[Array, Array, float], ComplexArray]

_FAST = {"reassoc", "contract", "nsz", "arcp"}
_STEP = np.radians(3.0)  # of the tables over the relative heading, rad
_LARGEST = 1.5e9  # bytes of all tables
_HEAD, _GROUP, _FAMILY = 7, 4, 5  # numbers of the header, of a group, of a family


@dataclass(frozen=True, eq=False)
class _Family:
    """Force of components with the same frequencies over the relative heading: (n_u, n_b, 2, 12, n), slopes per step."""

    grid: Array
    periodic: bool
    table: Array

    @classmethod
    def of(cls, force: Force, omega: Array, run: tuple[float, float] | None, speeds: Array) -> "_Family":
        """Tabulate the force all around or within a run of headings (rad)."""
        grid = _grid(run)
        if 8 * 24 * len(omega) * len(grid) * len(speeds) > _LARGEST:
            raise InputError(
                f"WaveExcitation: at most {_LARGEST / 1e9:g} GB of tables expected, {len(omega)} frequencies need more. "
                "Give the sea fewer components, or position='mean'."
            )
        table = np.stack([_spline_table(force(omega, grid, float(u)), grid, run is None) for u in speeds])
        return cls(grid, run is None, table)


def encounter_kernel(
    force: Force,
    sea: Sea,
    *,
    ramp: float,
    speeds: Array,
    limits: tuple[float, float],
    headings: Headings,
    heading: float,
    slow: bool = False,
) -> Kernel:
    """Return the wave force as a function of time, place, heading and speed.

    Parameters
    ----------
    force : callable
        ``force(omega, b, speed)``: complex force (n_b, n, 6) per metre of amplitude of waves with the frequencies omega (n,)
        from the directions b (n_b,) relative to the bow, rad, on a vessel with this mean speed through the water, m/s.
    sea : Sea
    ramp : float
        s; the sea grows from nothing with sin^2.
    speeds : (n_u,) array
        Ascending, m/s; a single one where the force does not depend on speed.
    limits : (float, float)
        Mean speeds outside which the force is NaN, m/s.
    headings : Headings
        Relative headings of the data. Where they do not go all around, the force is NaN outside the run of them in which the
        waves lie at the vessel's first heading.
    heading : float
        The vessel's first heading, rad.
    slow : bool
        Take place and heading without the motion in the waves.

    Notes
    -----
    F = Re sum_j X_j(b_j - psi, u) a_j exp(i (omega_j t - k_j (x cos b_j + y sin b_j) + phase_j)) in the horizontal axes that
    turn with the vessel; x and y are those of O. X is tabulated every 3 degrees as a cubic spline, and linear in the mean speed
    u (with the speed of the moment, surge in the waves would make a second-order force of its own).
    """
    families: dict[Any, int] = {}
    made: list[_Family] = []
    order: list[NDArray[np.intp]] = []
    groups: list[list[float]] = []
    directions, which = np.unique(sea.direction.round(12), return_inverse=True)
    for g, direction in enumerate(directions):
        members = np.flatnonzero(which == g)
        members = members[np.argsort(sea.omega[members], kind="stable")]
        run = None if headings.periodic else run_of(headings, direction - heading)
        key = (sea.omega[members].tobytes(), run)
        if key not in families:
            families[key] = len(made)
            made.append(_Family.of(force, sea.omega[members], run, speeds))
        groups.append([direction, sum(len(o) for o in order), len(members), families[key]])
        order.append(members)
    j = np.concatenate(order)
    kx, ky = sea.wavenumber * np.cos(sea.direction), sea.wavenumber * np.sin(sea.direction)
    head = [len(j), len(groups), len(speeds), *limits, ramp, float(slow)]
    numbers = [np.ravel(groups), _described(made, len(groups), len(j), len(speeds)), speeds, sea.omega[j], kx[j], ky[j]]
    data = np.concatenate([np.array(head), *numbers, *[family.table.ravel() for family in made]])
    own = np.concatenate([np.atleast_2d(sea.amplitude)[:, j], np.atleast_2d(sea.phase)[:, j]], axis=1)
    return Kernel(_wave_force, data, own, _limits(headings, directions, heading, limits), steady=False)


def _described(families: list[_Family], groups: int, n: int, n_u: int) -> Array:
    """Return for each family the place of its table, number of headings, first heading, step, whether it goes all around."""
    place = _HEAD + _GROUP * groups + _FAMILY * len(families) + n_u + 3 * n
    rows = []
    for family in families:
        rows.append([place, len(family.grid), family.grid[0], family.grid[1] - family.grid[0], float(family.periodic)])
        place += family.table.size
    return np.ravel(rows)


def _grid(run: tuple[float, float] | None) -> Array:
    if run is None:
        n = round(2 * np.pi / _STEP)
        return 2 * np.pi / n * np.arange(n)
    lo, hi = run
    return np.linspace(lo, hi, max(4, int(np.ceil((hi - lo) / _STEP)) + 1))


def _spline_table(force: ComplexArray, grid: Array, periodic: bool) -> Array:
    """Return values and slopes times the step (n_b, 2, 12, n) of the cubic spline; 12 = (real, imaginary) of six forces."""
    from scipy.interpolate import CubicSpline

    values = np.concatenate([force.real, force.imag], axis=2).transpose(0, 2, 1)  # (n_b, 12, n)
    if periodic:
        spline = CubicSpline(np.append(grid, grid[0] + 2 * np.pi), np.concatenate([values, values[:1]]), bc_type="periodic")
    else:
        spline = CubicSpline(grid, values)
    return np.stack([values, spline(grid, 1) * (grid[1] - grid[0])], axis=1)


def _limits(headings: Headings, directions: Array, heading: float, speeds: tuple[float, float]) -> str:
    found = vessel_headings(headings, directions, heading)
    parts = []
    if found is not None:
        lo, hi = np.degrees(found)
        parts.append(f"headings of the vessel {lo:.4g}..{hi:.4g} deg in this sea")
    parts.append(f"mean speeds through the water {speeds[0]:.4g}..{speeds[1]:.4g} m/s (see WaveExcitation's argument speeds)")
    return " and ".join(parts)


@njit(cache=True, nogil=True, fastmath=_FAST)
def _add_row(row, weight, n, cosine, sine, total):
    """total (6,) += weight (Re X cosine - Im X sine) summed over the components of one row (12 n,) of the table."""
    for i in range(6):
        s = 0.0
        for j in range(n):
            s += row[i * n + j] * cosine[j] - row[(6 + i) * n + j] * sine[j]
        total[i] += weight * s


@njit(cache=True, nogil=True, fastmath=_FAST)
def _add_group(data, family, b, u, n, cosine, sine, total):
    """Add the force of a group of n components whose heading relative to the bow is b; NaN outside its table."""
    table, n_b, n_u = data[int(data[family]) :], int(data[family + 1]), int(data[2])
    low = min(int(u), max(n_u - 2, 0))
    around = data[family + 4] > 0.5
    h = (b - data[family + 2]) / data[family + 3]
    turn = 2.0 * np.pi / data[family + 3]
    h -= turn * np.floor((h + (0.0 if around else 0.5 * (turn - n_b + 1.0))) / turn)  # the turn in which the table lies
    if not around and (h < -1e-6 or h > n_b - 1 + 1e-6):
        total[:] = np.nan
        return
    i = min(max(int(h), 0), n_b - 1 if around else n_b - 2)
    s, following = h - i, (i + 1) % n_b
    for k in range(2 if n_u > 1 else 1):
        share = 1.0 if n_u == 1 else (u - low if k == 1 else 1.0 - (u - low))
        here, there = ((low + k) * n_b + i) * 24 * n, ((low + k) * n_b + following) * 24 * n
        _add_row(table[here:], share * (1.0 + 2.0 * s) * (1.0 - s) ** 2, n, cosine, sine, total)
        _add_row(table[here + 12 * n :], share * s * (1.0 - s) ** 2, n, cosine, sine, total)
        _add_row(table[there:], share * s * s * (3.0 - 2.0 * s), n, cosine, sine, total)
        _add_row(table[there + 12 * n :], share * s * s * (s - 1.0), n, cosine, sine, total)


@load_kernel
def _wave_force(x, data, own, force):
    n, n_g, n_u = int(data[0]), int(data[1]), int(data[2])
    mean = x[MEAN_SPEED]
    if mean < data[3] - 1e-9 or mean > data[4] + 1e-9:
        force[:] = np.nan
        return
    families = _HEAD + _GROUP * n_g
    n_f = 0
    for g in range(n_g):
        n_f = max(n_f, int(data[_HEAD + _GROUP * g + 3]) + 1)
    speeds = data[families + _FAMILY * n_f : families + _FAMILY * n_f + n_u]
    u = 0.0  # place among the speeds
    for k in range(n_u - 1):
        u += min(max((mean - speeds[k]) / (speeds[k + 1] - speeds[k]), 0.0), 1.0)
    first = families + _FAMILY * n_f + n_u
    px, py, psi = x[ETA], x[ETA + 1], x[ETA + 5]
    if data[6] > 0.5:
        px, py, psi = x[SLOW], x[SLOW + 1], x[SLOW + 2]
    omega, kx, ky = data[first : first + n], data[first + n : first + 2 * n], data[first + 2 * n : first + 3 * n]
    angle, sine, cosine, total = np.empty(n), np.empty(n), np.empty(n), np.zeros(6)
    for j in range(n):
        angle[j] = omega[j] * x[TIME] - kx[j] * px - ky[j] * py + own[n + j]
    sines_and_cosines(angle, sine, cosine)
    for j in range(n):
        cosine[j] *= own[j]
        sine[j] *= own[j]
    for g in range(n_g):
        at = _HEAD + _GROUP * g
        begin, count = int(data[at + 1]), int(data[at + 2])
        family = families + _FAMILY * int(data[at + 3])
        b = data[at] - psi
        _add_group(data, family, b, u, count, cosine[begin : begin + count], sine[begin : begin + count], total)
    if data[5] > 0.0 and x[TIME] < data[5]:
        grown = np.sin(0.5 * np.pi * max(x[TIME], 0.0) / data[5]) ** 2
        for p in range(6):
            total[p] *= grown
    c, s = np.cos(psi), np.sin(psi)
    R = x[ROTATION:]
    for part in range(2):
        f0, f1, f2 = total[3 * part], total[3 * part + 1], total[3 * part + 2]
        w0, w1 = c * f0 - s * f1, s * f0 + c * f1
        for p in range(3):
            force[3 * part + p] += R[p] * w0 + R[3 + p] * w1 + R[6 + p] * f2
