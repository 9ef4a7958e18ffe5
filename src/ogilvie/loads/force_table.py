"""A force given as a table over time."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import cos, sin
from typing import Any, Literal

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import Surroundings, Terms
from ogilvie.loads.kernel import ETA, ROTATION, TIME, Kernel, load_kernel

Array = NDArray[Any]
Frame = Literal["heading", "world", "body"]

_FRAMES = ("heading", "world", "body")
_HEADING, _BODY = 0.0, 2.0  # places among them
_START, _STEP, _FRAME = 0, 1, 2
_ROW = 12  # numbers per time: value and slope times step, six each


@dataclass(frozen=True, eq=False, init=False)
class ForceTable:
    """A force that is known before the run, such as a slow-drift force or a measured one.

    Parameters
    ----------
    time : (n_t,) array
        Equally spaced, s; 4 times at least.
    force : (n_t, 6) or (n_realisations, n_t, 6) array
        Force and moment on the body about O, N and N m.
    frame : {"heading", "world", "body"}
        Axes of the table: "heading" turns with the yaw of the vessel and stays level, "world" is fixed, "body" moves along.
    name : str
        Of the output.
    covers : iterable of str, optional
        Physical effects that the table stands for, e.g. ``{ogilvie.loads.base.SLOW_DRIFT}``, so that a second load on them is
        refused; only the `name` by default.

    Raises
    ------
    InputError
        Times not equally spaced, shapes that differ, NaN, unknown frame.

    Notes
    -----
    Cubic spline in time. **The force is zero before the first and after the last time**: it begins and ends with the table,
    with a jump if the table does. "heading": F_body = (Ry Rx)^T F; "world": F_body = R^T F, moments likewise.

    Examples
    --------
    >>> t = np.arange(0.0, 10.0, 0.5)
    >>> push = ForceTable(t, np.sin(t)[:, None] * [1e5, 0, 0, 0, 0, 0], frame="world")
    >>> quarter_turn = [0, 0, 0, 0, 0, np.pi / 2]
    >>> push.kernel.force(t=1.5, eta=quarter_turn).round() + 0.0  # to starboard
    array([     0., -99749.,      0.,      0.,      0.,      0.])
    """

    time: Array
    force: Array
    frame: Frame
    covers: frozenset[str]
    name: str

    def __init__(
        self,
        time: ArrayLike,
        force: ArrayLike,
        *,
        frame: Frame = "heading",
        name: str = "force_table",
        covers: Iterable[str] | None = None,
    ) -> None:
        t, F = _real(time, "time"), _real(force, "force")
        _check_times(t)
        if F.ndim not in (2, 3) or F.shape[-2:] != (len(t), 6) or F.size == 0:
            raise InputError(f"ForceTable: force ({len(t)}, 6) or (n_realisations, {len(t)}, 6) expected, {F.shape} found.")
        if frame not in _FRAMES:
            raise InputError(f"ForceTable: frame {', '.join(map(repr, _FRAMES))} expected, {frame!r} found.")
        if isinstance(covers, str):
            raise InputError(f"ForceTable: covers, a set of names, expected, the text {covers!r} found; write {{{covers!r}}}.")
        values = (t, F, frame, frozenset((name,) if covers is None else covers), name)
        for field, value in zip(("time", "force", "frame", "covers", "name"), values, strict=True):
            object.__setattr__(self, field, value)

    @property
    def kernel(self) -> Kernel:
        """The compiled force, with the table of each realisation."""
        from scipy.interpolate import CubicSpline

        h = (self.time[-1] - self.time[0]) / (len(self.time) - 1)
        F = self.force.reshape(-1, *self.force.shape[-2:])
        slope = h * CubicSpline(self.time, F, axis=1)(self.time, 1)
        own = np.concatenate([F, slope], axis=-1).reshape(len(F), -1)
        return Kernel(_force_table, np.array([self.time[0], h, float(_FRAMES.index(self.frame))]), own)

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays for the time loop."""
        return Terms(kernel=self.kernel)


@njit(cache=True, nogil=True)
def _value(own, at, u):
    """Return the cubic between two times, u = 0..1, of the component whose value at the first is at the place `at`."""
    v = 1.0 - u
    first = v * v * ((1.0 + 2.0 * u) * own[at] + u * own[at + 6])
    return first + u * u * ((1.0 + 2.0 * v) * own[at + _ROW] - v * own[at + _ROW + 6])


@load_kernel
def _force_table(x, data, own, force):
    """Add the force of the table; own: value and slope times step of six components at each time."""
    s = (x[TIME] - data[_START]) / data[_STEP]
    n = len(own) // _ROW
    if s < -1e-9 or s > n - 1.0 + 1e-9:
        return
    i = min(max(int(s), 0), n - 2)
    u = s - i
    f1, f2, f3 = _value(own, _ROW * i, u), _value(own, _ROW * i + 1, u), _value(own, _ROW * i + 2, u)
    m1, m2, m3 = _value(own, _ROW * i + 3, u), _value(own, _ROW * i + 4, u), _value(own, _ROW * i + 5, u)
    if data[_FRAME] == _BODY:
        force[0] += f1
        force[1] += f2
        force[2] += f3
        force[3] += m1
        force[4] += m2
        force[5] += m3
        return
    if data[_FRAME] == _HEADING:
        c, s = cos(x[ETA + 5]), sin(x[ETA + 5])
        f1, f2, m1, m2 = c * f1 - s * f2, s * f1 + c * f2, c * m1 - s * m2, s * m1 + c * m2
    for k in range(3):  # R^T
        r1, r2, r3 = x[ROTATION + k], x[ROTATION + 3 + k], x[ROTATION + 6 + k]
        force[k] += r1 * f1 + r2 * f2 + r3 * f3
        force[3 + k] += r1 * m1 + r2 * m2 + r3 * m3


def _check_times(t: Array) -> None:
    if t.ndim != 1 or len(t) < 4:
        raise InputError(f"ForceTable: 4 times or more expected, shape {t.shape} found.")
    step = (t[-1] - t[0]) / (len(t) - 1)
    worst = np.abs(t - (t[0] + step * np.arange(len(t)))).max()
    if not (step > 0.0 and worst <= 1e-6 * step + 1e-12 * np.abs(t).max()):
        raise InputError(
            f"ForceTable: equally spaced, increasing times expected, steps of {np.diff(t).min():.6g} to {np.diff(t).max():.6g} "
            "s found; resample the force."
        )


def _real(value: ArrayLike, name: str) -> Array:
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"ForceTable: {name}, an array of numbers, expected, {type(value).__name__} found.") from None
    if not np.all(np.isfinite(array)):
        raise InputError(
            f"ForceTable: {name}, finite numbers, expected, {int((~np.isfinite(array)).sum())} NaN or infinite found."
        )
    array.setflags(write=False)
    return array
