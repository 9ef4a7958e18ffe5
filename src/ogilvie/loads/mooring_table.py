"""Mooring given as tables of force against displacement."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import MOORING, Surroundings, Terms
from ogilvie.loads.catenary import compiled
from ogilvie.loads.kernel import ETA, ROTATION, Kernel, load_kernel

Array = NDArray[Any]
Table = tuple[ArrayLike, ArrayLike]

_DOFS = ("surge", "sway", "yaw")
_FINEST = 4096  # intervals of a resampled table
_HEAD = 10  # heading, point, centre, and where the four tables start
_INTERVAL = 4  # coefficients of an interval


@compiled
def table_value(data, start, x):
    """Return the force at x of a packed table: first, step, number of intervals, rule beyond, coefficients per interval."""
    first, step, count = data[start], data[start + 1], int(data[start + 2])
    u = (x - first) / step
    if not (-1e-12 * count <= u <= count * (1.0 + 1e-12)):
        if data[start + 3] == 0.0 or np.isnan(u):
            return np.nan
        end = 0.0 if u < 0.0 else 1.0
        p = start + 4 + (_INTERVAL * (count - 1) if u > 0.0 else 0)
        a, b, c, d = data[p], data[p + 1], data[p + 2], data[p + 3]
        value = a + end * (b + end * (c + end * d))
        return value + (b + end * (2.0 * c + 3.0 * end * d)) * (u - end * count)
    i = min(max(int(u), 0), count - 1)
    r = u - i
    p = start + 4 + _INTERVAL * i
    return data[p] + r * (data[p + 1] + r * (data[p + 2] + r * data[p + 3]))


@load_kernel
def _table_kernel(x, data, own, force):
    R = x[ROTATION : ROTATION + 9]
    a, b, c = data[1], data[2], data[3]
    dx = x[ETA] + R[0] * a + R[1] * b + R[2] * c - data[4]
    dy = x[ETA + 1] + R[3] * a + R[4] * b + R[5] * c - data[5]
    X, Y, N = 0.0, 0.0, 0.0
    if data[6] > 0.0:
        r = np.hypot(dx, dy)
        pull = table_value(data, int(data[6]), r)
        if r != 0.0:  # NaN passes on
            X -= pull * dx / r
            Y -= pull * dy / r
    co, si = np.cos(data[0]), np.sin(data[0])
    if data[7] > 0.0:
        pull = table_value(data, int(data[7]), co * dx + si * dy)
        X -= pull * co
        Y -= pull * si
    if data[8] > 0.0:
        pull = table_value(data, int(data[8]), co * dy - si * dx)
        X += pull * si
        Y -= pull * co
    if data[9] > 0.0:
        turn = x[ETA + 5] - data[0]
        N = -table_value(data, int(data[9]), turn - 2.0 * np.pi * np.floor(turn / (2.0 * np.pi) + 0.5))
    upright = R[7] * R[7] + R[8] * R[8]  # cos(theta)^2
    fx, fy, fz = R[0] * X + R[3] * Y, R[1] * X + R[4] * Y, R[2] * X + R[5] * Y
    force[0] += fx
    force[1] += fy
    force[2] += fz
    force[3] += b * fz - c * fy
    force[4] += c * fx - a * fz + R[7] * N / upright
    force[5] += a * fy - b * fx + R[8] * N / upright


@dataclass(frozen=True, eq=False, init=False)
class MooringTable:
    """Mooring with restoring forces from tables: against the horizontal offset, or against surge, sway and yaw.

    Parameters
    ----------
    radial : (offsets, forces), optional
        Spread mooring that is the same all round: force (N) back towards the centre against horizontal offset (m) from 0; the
        force at 0 is 0.
    tables : mapping of "surge", "sway", "yaw" to (displacements, forces), optional
        Force back to zero (N, N m; positive for positive displacement of a mooring that holds) against displacement (m, rad),
        from negative to positive, along axes at rest with the given heading. "surge" and "sway" exclude `radial`.
    heading : float
        Of these axes, and that at which the yaw displacement is zero, rad.
    point : (3,) array
        Where the horizontal force attacks, e.g. the turret, in body axes from O, m.
    centre : (2,) array, optional
        World place of the point without offset, m; by default that with O at the origin of the world and the given heading.
    interpolation : {"spline", "monotone"}
        Cubic spline, or the piecewise cubic that does not overshoot (PCHIP): for tables with kinks.
    beyond : {"error", "linear"}
        Outside a table: "error" makes the force NaN, so that a run stops with an error; "linear" goes on along the tangent.

    Raises
    ------
    InputError
        Nothing given, radial and surge or sway given, fewer than 4 rows, unsorted, NaN, wrong start, unknown word.

    Notes
    -----
    F = -f(r) (dx, dy) / r at the point, in the world, or -f_1(d_1) e_1 - f_2(d_2) e_2; the yaw table does the work
    -f_6(psi - heading, wrapped) dpsi, so in body axes its moment is -f_6 (0, sin phi, cos phi) / cos theta. Each is minus the
    gradient of a potential: the mooring neither gives nor takes energy. Tables are turned into cubics on uniform intervals; a
    table that is uniform already keeps its interpolant to rounding, others are sampled eight times finer than their narrowest
    interval (at most 4096 intervals).

    Examples
    --------
    >>> r = np.linspace(0.0, 30.0, 31)
    >>> mooring = MooringTable((r, 5e4 * r + 80.0 * r**3))
    >>> mooring.force([3.0, 4.0, 0, 0, 0, 0])[:2].round()
    array([-156000., -208000.])
    """

    data: Array
    name: str = "mooring"

    def __init__(
        self,
        radial: Table | None = None,
        *,
        tables: Mapping[str, Table] | None = None,
        heading: float = 0.0,
        point: ArrayLike = (0.0, 0.0, 0.0),
        centre: ArrayLike | None = None,
        interpolation: Literal["spline", "monotone"] = "spline",
        beyond: Literal["error", "linear"] = "error",
    ) -> None:
        given = dict(tables or {})
        _check_choice(given, radial is not None, interpolation, beyond)
        psi = float(_numbers(heading, (), "heading"))
        p = _numbers(point, (3,), "point")
        co, si = np.cos(psi), np.sin(psi)
        rest = np.array([co * p[0] - si * p[1], si * p[0] + co * p[1]])
        head = np.concatenate([[psi], p, rest if centre is None else _numbers(centre, (2,), "centre"), np.zeros(4)])
        parts, start = [head], _HEAD
        for slot, name in enumerate(("radial", *_DOFS)):
            table = radial if name == "radial" else given.get(name)
            if table is None:
                continue
            x, f = _checked(table, name)
            head[6 + slot] = start
            parts.append(_packed(x, f, interpolation, beyond == "linear", odd=name == "radial"))
            start += parts[-1].size
        data = np.concatenate(parts)
        data.setflags(write=False)
        object.__setattr__(self, "data", data)
        object.__setattr__(self, "name", "mooring")

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({MOORING})

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the compiled force for the time loop."""
        return Terms(kernel=self.kernel)

    @property
    def kernel(self) -> Kernel:
        """The compiled force with its tables."""
        return Kernel(_table_kernel, self.data, limits="offsets within its tables")

    def force(self, eta: ArrayLike | None = None) -> Array:
        """Return the force (6,) on the body about O in body axes at the pose eta (6,), NaN outside the tables."""
        return self.kernel.force(eta=eta)


def _check_choice(given: dict[str, Table], radial: bool, interpolation: str, beyond: str) -> None:
    unknown = [name for name in given if name not in _DOFS]
    if unknown:
        raise InputError(f"MooringTable: tables of surge, sway or yaw expected, {', '.join(map(str, unknown))} found.")
    if not radial and not given:
        raise InputError("MooringTable: a radial table or tables per degree of freedom expected, none found.")
    if radial and ("surge" in given or "sway" in given):
        raise InputError(
            "MooringTable: a radial table or tables of surge and sway expected, both found: they would count twice."
        )
    if interpolation not in ("spline", "monotone"):
        raise InputError(f"MooringTable: interpolation: 'spline' or 'monotone' expected, {interpolation!r} found.")
    if beyond not in ("error", "linear"):
        raise InputError(f"MooringTable: beyond: 'error' or 'linear' expected, {beyond!r} found.")


def _checked(table: Table, name: str) -> tuple[Array, Array]:
    what = f"{name} table"
    try:
        first, second = table
    except (TypeError, ValueError):
        raise InputError(f"MooringTable: {what}: (displacements, forces) expected.") from None
    x, f = _numbers(first, None, what), _numbers(second, None, what)
    if x.ndim != 1 or x.shape != f.shape or x.size < 4:
        raise InputError(
            f"MooringTable: {what}: two lists of the same length, 4 or more, expected, {x.shape} and {f.shape} found."
        )
    if np.any(np.diff(x) <= 0.0):
        raise InputError(f"MooringTable: {what}: displacements that increase expected, others found.")
    if name == "radial":
        if x[0] != 0.0 or f[0] != 0.0:
            raise InputError(f"MooringTable: {what}: offset 0 with force 0 expected first, {x[0]:g} m, {f[0]:g} N found.")
    elif not x[0] < 0.0 < x[-1]:
        raise InputError(
            f"MooringTable: {what}: displacements from negative to positive expected, {x[0]:g} to {x[-1]:g} found."
        )
    if name == "yaw" and max(-x[0], x[-1]) > np.pi:
        raise InputError(f"MooringTable: {what}: angles within -pi to pi rad expected, {x[0]:g} to {x[-1]:g} found.")
    return x, f


def _packed(x: Array, f: Array, interpolation: str, linear: bool, *, odd: bool) -> Array:
    """First, step, number of intervals, rule beyond, then four coefficients of (x - x_i) / step for each interval."""
    from scipy.interpolate import CubicSpline, PchipInterpolator

    X, F = (np.concatenate([-x[:0:-1], x]), np.concatenate([-f[:0:-1], f])) if odd else (x, f)
    curve: Any = CubicSpline(X, F) if interpolation == "spline" else PchipInterpolator(X, F)
    gaps = np.diff(x)
    uniform = np.ptp(gaps) <= 1e-9 * gaps.max()
    count = gaps.size if uniform else int(min(_FINEST, np.ceil(8.0 * (x[-1] - x[0]) / gaps.min())))
    nodes = np.linspace(x[0], x[-1], count + 1)
    step = (x[-1] - x[0]) / count
    v, s = curve(nodes), curve(nodes, 1) * step
    d = np.diff(v)
    cubic = np.column_stack([v[:-1], s[:-1], 3.0 * d - 2.0 * s[:-1] - s[1:], s[:-1] + s[1:] - 2.0 * d])
    return np.concatenate([[x[0], step, count, float(linear)], cubic.ravel()])


def _numbers(value: ArrayLike, shape: tuple[int, ...] | None, what: str) -> Array:
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"MooringTable: {what}: numbers expected, {value!r} found.") from None
    if (shape is not None and array.shape != shape) or not np.all(np.isfinite(array)):
        raise InputError(f"MooringTable: {what}: finite numbers of shape {shape} expected, shape {array.shape} found.")
    return array
