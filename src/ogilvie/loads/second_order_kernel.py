"""The second-order force of a sea on a vessel that may be anywhere in it, at any heading: a compiled load."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.loads.interpolation import Headings, vessel_headings
from ogilvie.loads.kernel import ETA, MEAN_SPEED, ROTATION, TIME, Kernel, load_kernel
from ogilvie.loads.quadratic import QuadraticForm
from ogilvie.waves.field import Sea
from ogilvie.waves.sincos import sines_and_cosines

Array = NDArray[Any]
_FAST = {"reassoc", "contract", "nsz", "arcp"}
_STEP = np.radians(3.0)  # of the table over the vessel's heading, rad
_TURNS_LEAST = np.radians(2.0)  # range of headings below which large motions make no sense
_LARGEST = 2e7  # numbers in the table
_HEAD = 9  # n, headings, first heading, step, periodic, ramp, real, difference, speeds; then the speeds
_BLOCK = 2  # fields, products: before the numbers of each heading


def second_order_kernel(
    form: Callable[[float, float], QuadraticForm],
    speeds: Array,
    tabulated: Headings,
    sea: Sea,
    inside: NDArray[np.bool_],
    *,
    heading: float,
    ramp: float,
    who: str,
) -> Kernel:
    """Return the force as a function of time, place, heading and speed.

    Parameters
    ----------
    form : callable
        ``form(heading, speed)``: the force of the components `inside` on a vessel with this heading in the world, rad, and this
        mean speed through the water, m/s.
    speeds : (n_u,) array
        Ascending, m/s; a single one where the force does not depend on speed.
    tabulated : Headings
        Directions of the waves relative to the bow for which there are data.
    sea : Sea
    inside : (n,) bool array
        Components of the sea that have data.
    heading : float
        Of the vessel at first, rad.
    ramp : float
        s; the sea grows from nothing with r = sin^2, the force with r^2.
    who : str
        Name of the load in errors.

    Raises
    ------
    InputError
        Data for one heading only; a table that is too large.

    Notes
    -----
    F = Re sum_p weight_p X_left X_right* (without the conjugate at sum frequencies), X_k = sum_j f_kj(psi) a_j exp(i (omega_j t
    - k_j (x cos b_j + y sin b_j) + phase_j)), in the horizontal axes that turn with the vessel; x and y are those of O.
    Tabulated every 3 degrees of psi, linear between; linear in the mean speed, outside `speeds` NaN.
    """
    direction = sea.direction[inside]
    limits = vessel_headings(tabulated, direction, heading)
    if limits is not None and limits[1] - limits[0] < _TURNS_LEAST:
        raise InputError(
            f"{who}: large motions need data for the headings that the vessel takes; for this sea they hold from "
            f"{np.degrees(limits[0]):.4g} to {np.degrees(limits[1]):.4g} deg only. Give data for more headings, or "
            "position='mean' to take the force at the mean heading."
        )
    grid = _headings(limits)
    forms = [form(float(psi), float(u)) for u in speeds for psi in grid]
    w, k = sea.omega[inside], sea.wavenumber[inside]
    amplitude, phase = np.atleast_2d(sea.amplitude)[:, inside], np.atleast_2d(sea.phase)[:, inside]
    if forms[0].steady.any() or not len(forms[0].left):
        return _steady(forms, amplitude, grid, limits, ramp, speeds)
    real = all(not np.iscomplexobj(f.fields) or not f.fields.imag.any() for f in forms)
    blocks = [_packed(f, real=real) for f in forms]
    if sum(map(len, blocks)) > _LARGEST:
        raise InputError(
            f"{who}: at most {_LARGEST:.3g} numbers in the table over the heading expected, {sum(map(len, blocks)):.3g} "
            "found. Raise the tolerance, take fewer components, a Newman approximation, or position='mean'."
        )
    head = _head(len(w), grid, limits, ramp, speeds, real=real, difference=forms[0].difference)
    places = len(head) + 3 * len(w) + len(blocks) + np.cumsum([0, *map(len, blocks)])[:-1]
    data = np.concatenate([head, w, k * np.cos(direction), k * np.sin(direction), places, *blocks])
    own = np.concatenate([amplitude, phase], axis=1)
    return Kernel(_second_order, data, own, _limits(limits, speeds), steady=False)


def _headings(limits: tuple[float, float] | None) -> Array:
    if limits is None:
        n = round(2 * np.pi / _STEP)
        return 2 * np.pi / n * np.arange(n)
    return np.linspace(*limits, max(2, int(np.ceil((limits[1] - limits[0]) / _STEP)) + 1))


def _limits(limits: tuple[float, float] | None, speeds: Array) -> str:
    parts = []
    if limits is not None:
        lo, hi = np.degrees(limits)
        parts.append(f"headings of the vessel {lo:.4g}..{hi:.4g} deg in this sea")
    if len(speeds) > 1:
        parts.append(f"mean speeds through the water {speeds[0]:.4g}..{speeds[-1]:.4g} m/s")
    return " and ".join(parts)


def _head(
    n: int, grid: Array, limits: tuple[float, float] | None, ramp: float, speeds: Array, *, real: bool, difference: bool = True
) -> Array:
    numbers = [n, len(grid), grid[0], grid[1] - grid[0], limits is None, ramp, real, difference, len(speeds)]
    return np.array([*numbers, *speeds], dtype=float)


def _packed(form: QuadraticForm, *, real: bool) -> Array:
    """Return fields, products; real parts (m n), imaginary parts unless they are zero, left, right, weights (6 p)."""
    parts = [form.fields.real] if real else [form.fields.real, form.fields.imag]
    numbers = [np.array([len(form.fields), len(form.left)], dtype=float), *[p.ravel() for p in parts]]
    return np.concatenate([*numbers, form.left, form.right, form.weight.ravel()])


def _steady(
    forms: list[QuadraticForm],
    amplitude: Array,
    grid: Array,
    limits: tuple[float, float] | None,
    ramp: float,
    speeds: Array,
) -> Kernel:
    """Return the kernel of the mean force, one table over speed and heading for each realisation."""
    table = np.einsum("rj,hjd->rhd", amplitude**2, np.array([f.steady for f in forms]))
    data = _head(0, grid, limits, ramp, speeds, real=True)
    return Kernel(_mean_drift, data, table.reshape(len(table), -1), _limits(limits, speeds), steady=False)


@njit(cache=True, nogil=True, fastmath=_FAST)
def _place(heading, data):
    """Return the two headings of the table about one, and the share of the second; -1 outside the table."""
    n_h = int(data[1])
    h = (heading - data[2]) / data[3]
    if data[4] > 0.5:
        h -= n_h * np.floor(h / n_h)
        i = min(int(h), n_h - 1)
        return i, (i + 1) % n_h, h - i
    if h < -1e-9 or h > n_h - 1 + 1e-9:
        return -1, -1, 0.0
    i = min(max(int(h), 0), n_h - 2)
    return i, i + 1, h - i


@njit(cache=True, nogil=True)
def _speed_place(mean, data):
    """Return the lower of the two speeds of the table about one, and the share of the other; -1 outside the table."""
    n_u = int(data[8])
    if n_u == 1:
        return 0, 0.0
    speeds = data[_HEAD : _HEAD + n_u]
    if mean < speeds[0] - 1e-9 or mean > speeds[n_u - 1] + 1e-9:
        return -1, 0.0
    u = 0.0
    for k in range(n_u - 1):
        u += min(max((mean - speeds[k]) / (speeds[k + 1] - speeds[k]), 0.0), 1.0)
    low = min(int(u), n_u - 2)
    return low, u - low


@njit(cache=True, nogil=True, fastmath=_FAST)
def _add_turned(x, data, total, force):
    """Turn the force (6,) from the axes of the heading to those of the body, with the square of the ramp."""
    grown = 1.0
    if data[5] > 0.0 and x[TIME] < data[5]:
        grown = np.sin(0.5 * np.pi * max(x[TIME], 0.0) / data[5]) ** 4
    c, s = np.cos(x[ETA + 5]), np.sin(x[ETA + 5])
    R = x[ROTATION:]
    for part in range(2):
        f0, f1, f2 = grown * total[3 * part], grown * total[3 * part + 1], grown * total[3 * part + 2]
        w0, w1 = c * f0 - s * f1, s * f0 + c * f1
        for p in range(3):
            force[3 * part + p] += R[p] * w0 + R[3 + p] * w1 + R[6 + p] * f2


@njit(cache=True, nogil=True, fastmath=_FAST)
def _add_products(block, n, real, sign, share, cosine, sine, total):
    """total (6,) += share times the products of one heading; sign +1 with a conjugate factor, -1 without."""
    m, p = int(block[0]), int(block[1])
    re, im = np.empty(m), np.empty(m)
    for k in range(m):
        row = block[_BLOCK + k * n : _BLOCK + (k + 1) * n]
        a = b = 0.0
        for j in range(n):
            a += row[j] * cosine[j]
            b += row[j] * sine[j]
        if not real:
            row = block[_BLOCK + (m + k) * n : _BLOCK + (m + k + 1) * n]
            for j in range(n):
                a -= row[j] * sine[j]
                b += row[j] * cosine[j]
        re[k], im[k] = a, b
    at = _BLOCK + (m if real else 2 * m) * n
    for q in range(p):
        i, j = int(block[at + q]), int(block[at + p + q])
        product = share * (re[i] * re[j] + sign * im[i] * im[j])
        for d in range(6):
            total[d] += block[at + 2 * p + 6 * q + d] * product


@load_kernel
def _second_order(x, data, own, force):
    n, n_h, n_u, real = int(data[0]), int(data[1]), int(data[8]), data[6] > 0.5
    here, there, s = _place(x[ETA + 5], data)
    low, share = _speed_place(x[MEAN_SPEED], data)
    if here < 0 or low < 0:
        force[:] = np.nan
        return
    first = _HEAD + n_u
    omega, kx, ky = data[first : first + n], data[first + n : first + 2 * n], data[first + 2 * n : first + 3 * n]
    places = data[first + 3 * n : first + 3 * n + n_u * n_h]
    angle, sine, cosine, total = np.empty(n), np.empty(n), np.empty(n), np.zeros(6)
    for j in range(n):
        angle[j] = omega[j] * x[TIME] - kx[j] * x[ETA] - ky[j] * x[ETA + 1] + own[n + j]
    sines_and_cosines(angle, sine, cosine)
    for j in range(n):
        cosine[j] *= own[j]
        sine[j] *= own[j]
    sign = 1.0 if data[7] > 0.5 else -1.0
    for k in range(2 if share > 0.0 else 1):
        part, row = (share if k == 1 else 1.0 - share), (low + k) * n_h
        _add_products(data[int(places[row + here]) :], n, real, sign, part * (1.0 - s), cosine, sine, total)
        _add_products(data[int(places[row + there]) :], n, real, sign, part * s, cosine, sine, total)
    _add_turned(x, data, total, force)


@load_kernel
def _mean_drift(x, data, own, force):
    here, there, s = _place(x[ETA + 5], data)
    low, share = _speed_place(x[MEAN_SPEED], data)
    if here < 0 or low < 0:
        force[:] = np.nan
        return
    total, n_h = np.zeros(6), int(data[1])
    for k in range(2 if share > 0.0 else 1):
        part, row = (share if k == 1 else 1.0 - share), 6 * (low + k) * n_h
        for d in range(6):
            total[d] += part * ((1.0 - s) * own[row + 6 * here + d] + s * own[row + 6 * there + d])
    _add_turned(x, data, total, force)
