"""The force of a sea on a vessel that may be anywhere in it, at any heading and speed: a compiled load."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.loads.base import ComplexArray
from ogilvie.loads.kernel import ETA, MEAN_SPEED, ROTATION, TIME, Kernel, load_kernel
from ogilvie.waves.field import Sea
from ogilvie.waves.sincos import sines_and_cosines

Array = NDArray[Any]
_FAST = {"reassoc", "contract", "nsz", "arcp"}
_STEP = np.radians(3.0)  # of the table over the vessel's heading, rad


def encounter_kernel(
    force: Callable[[Array, float], ComplexArray],
    sea: Sea,
    *,
    ramp: float,
    speeds: Array,
    headings: tuple[float, float] | None,
) -> Kernel:
    """Return the wave force as a function of time, place, heading and speed.

    Parameters
    ----------
    force : callable
        ``force(headings, speed)``: complex force (n_h, n, 6) of each component per metre of amplitude on a vessel with these
        headings (n_h,) in the world, rad, at this mean speed through the water, m/s.
    sea : Sea
    ramp : float
        s; the sea grows from nothing with sin^2.
    speeds : (n_u,) array
        Ascending and uniform; a single one where the force does not depend on speed. Outside them the force is NaN.
    headings : (float, float), optional
        Headings of the vessel in the world for which the data hold, rad; all around where it is not given. Outside them the
        force is NaN.

    Notes
    -----
    F = Re sum_j X_j(psi, u) a_j exp(i (omega_j t - k_j (x cos b_j + y sin b_j) + phase_j)) in the horizontal axes that turn
    with the vessel; x and y are those of O. X is tabulated every 3 degrees of psi as a cubic spline, and linear in the mean
    speed u (with the speed of the moment, surge in the waves would make a second-order force of its own).
    """
    grid, periodic = _heading_grid(headings)
    table = np.stack([_spline_table(force(grid, float(u)), grid, periodic) for u in speeds])  # (n_u, n_h, 2, 12, n)
    n = len(sea.omega)
    du = float(speeds[1] - speeds[0]) if len(speeds) > 1 else 0.0
    # n, headings, speeds, first heading, its step, first speed, its step, periodic, ramp
    header = [n, len(grid), len(speeds), grid[0], grid[1] - grid[0], speeds[0], du, float(periodic), ramp]
    kx, ky = sea.wavenumber * np.cos(sea.direction), sea.wavenumber * np.sin(sea.direction)
    data = np.concatenate([header, sea.omega, kx, ky, table.ravel()])
    own = np.concatenate([np.atleast_2d(sea.amplitude), np.atleast_2d(sea.phase)], axis=1)
    return Kernel(_wave_force, data, own, _limits(grid, periodic, speeds), steady=False)


def _limits(grid: Array, periodic: bool, speeds: Array) -> str:
    lo, hi = np.degrees(grid[[0, -1]])
    parts = [] if periodic else [f"headings of the vessel {lo:.4g}..{hi:.4g} deg in this sea"]
    if len(speeds) > 1:
        parts.append(f"mean speeds through the water {speeds[0]:.4g}..{speeds[-1]:.4g} m/s")
    return " and ".join(parts)


def _heading_grid(headings: tuple[float, float] | None) -> tuple[Array, bool]:
    if headings is None:
        n = round(2 * np.pi / _STEP)
        return 2 * np.pi / n * np.arange(n), True
    lo, hi = headings
    n = max(4, int(np.ceil((hi - lo) / _STEP)) + 1)
    return np.linspace(lo, hi, n), False


def _spline_table(force: ComplexArray, grid: Array, periodic: bool) -> Array:
    """Return values and slopes times the step (n_h, 2, 12, n) of the cubic spline; 12 = (real, imaginary) of six forces."""
    from scipy.interpolate import CubicSpline

    values = np.concatenate([force.real, force.imag], axis=2).transpose(0, 2, 1)  # (n_h, 12, n)
    if periodic:
        spline = CubicSpline(np.append(grid, grid[0] + 2 * np.pi), np.concatenate([values, values[:1]]), bc_type="periodic")
    else:
        spline = CubicSpline(grid, values)
    return np.stack([values, spline(grid, 1) * (grid[1] - grid[0])], axis=1)


@njit(cache=True, nogil=True, fastmath=_FAST)
def _add_row(row, weight, n, cosine, sine, total):
    """total (6,) += weight (Re X cosine - Im X sine) summed over the components of one row (12 n,) of the table."""
    for i in range(6):
        s = 0.0
        for j in range(n):
            s += row[i * n + j] * cosine[j] - row[(6 + i) * n + j] * sine[j]
        total[i] += weight * s


@load_kernel
def _wave_force(x, data, own, force):
    n, n_h, n_u = int(data[0]), int(data[1]), int(data[2])
    h = (x[ETA + 5] - data[3]) / data[4]
    if data[7] > 0.5:
        h -= n_h * np.floor(h / n_h)
    u = (x[MEAN_SPEED] - data[5]) / data[6] if n_u > 1 else 0.0
    outside = (data[7] < 0.5 and (h < -1e-9 or h > n_h - 1 + 1e-9)) or u < -1e-9 or u > n_u - 1 + 1e-9
    if outside:
        force[:] = np.nan
        return
    omega, kx, ky = data[9 : 9 + n], data[9 + n : 9 + 2 * n], data[9 + 2 * n : 9 + 3 * n]
    table = data[9 + 3 * n :]
    angle, sine, cosine, total = np.empty(n), np.empty(n), np.empty(n), np.zeros(6)
    for j in range(n):
        angle[j] = omega[j] * x[TIME] - kx[j] * x[ETA] - ky[j] * x[ETA + 1] + own[n + j]
    sines_and_cosines(angle, sine, cosine)
    for j in range(n):
        cosine[j] *= own[j]
        sine[j] *= own[j]
    last = n_h - 1 if data[7] > 0.5 else n_h - 2
    i = min(max(int(h), 0), last)
    s = h - i
    following = (i + 1) % n_h
    low = min(max(int(u), 0), max(n_u - 2, 0))
    for k in range(2 if n_u > 1 else 1):
        share = 1.0 if n_u == 1 else (u - low if k == 1 else 1.0 - (u - low))
        here, there = ((low + k) * n_h + i) * 24 * n, ((low + k) * n_h + following) * 24 * n
        _add_row(table[here:], share * (1.0 + 2.0 * s) * (1.0 - s) ** 2, n, cosine, sine, total)
        _add_row(table[here + 12 * n :], share * s * (1.0 - s) ** 2, n, cosine, sine, total)
        _add_row(table[there:], share * s * s * (3.0 - 2.0 * s), n, cosine, sine, total)
        _add_row(table[there + 12 * n :], share * s * s * (s - 1.0), n, cosine, sine, total)
    if data[8] > 0.0 and x[TIME] < data[8]:
        grown = np.sin(0.5 * np.pi * max(x[TIME], 0.0) / data[8]) ** 2
        for p in range(6):
            total[p] *= grown
    c, s = np.cos(x[ETA + 5]), np.sin(x[ETA + 5])
    R = x[ROTATION:]
    for part in range(2):
        f0, f1, f2 = total[3 * part], total[3 * part + 1], total[3 * part + 2]
        w0, w1 = c * f0 - s * f1, s * f0 + c * f1
        for p in range(3):
            force[3 * part + p] += R[p] * w0 + R[3 + p] * w1 + R[6 + p] * f2
