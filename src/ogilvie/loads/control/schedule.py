"""Set-points that are constant or change with time: rows (time, values), each valid from its time on."""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError

Array = NDArray[Any]


def schedule(value: ArrayLike, width: int, what: str) -> Array:
    """Return set-points as rows (n, 1 + width): time, then the values.

    Parameters
    ----------
    value : (width,) array, number if width is 1, or (n, 1 + width) array
        One set-point for all times, or rows of time (s, increasing) and set-point; each row holds until the next, the first
        also before its time.
    width : int
        Numbers of a set-point.
    what : str
        Name for messages.

    Raises
    ------
    InputError
        Wrong shape, NaN, times that do not increase.

    Examples
    --------
    >>> schedule(0.5, 1, "heading")
    array([[0. , 0.5]])
    >>> schedule([(0, 0.0), (100, 0.2)], 1, "heading").shape
    (2, 2)
    """
    try:
        rows = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{what}: numbers expected, {value!r} found.") from None
    if rows.size == width and rows.ndim < 2:
        rows = np.concatenate([[0.0], rows.ravel()])[None, :]
    if rows.ndim != 2 or rows.shape[1] != width + 1 or not rows.shape[0] or not np.all(np.isfinite(rows)):
        raise InputError(
            f"{what}: {width} finite number(s), or rows of time and {width} number(s), expected, "
            f"{np.asarray(value).tolist()} found."
        )
    if np.any(np.diff(rows[:, 0]) <= 0.0):
        raise InputError(f"{what}: increasing times expected in the first column, {rows[:, 0].tolist()} found.")
    rows.setflags(write=False)
    return rows


@njit(cache=True, nogil=True)
def row_at(rows: Array, n: int, width: int, t: float) -> int:
    """Return the place, in the flat `rows`, of the first value of the row that holds at time t."""
    i = 0
    while i + 1 < n and rows[(i + 1) * (width + 1)] <= t:
        i += 1
    return i * (width + 1) + 1


def refuse_degrees(rows: Array, what: str) -> None:
    """Raise InputError where headings, the last column, begin or jump by more than a whole turn, as degrees would.

    Examples
    --------
    >>> refuse_degrees(schedule([(0, 0.0), (60, 0.5)], 1, "heading"), "heading")
    """
    turns = np.abs(np.diff(np.concatenate([[0.0], rows[:, -1]])))
    if turns.max() > 2.0 * np.pi + 1e-9:
        found = f"{rows[int(turns.argmax()), -1]:g}"
        raise InputError(
            f"{what}: headings in rad that turn by at most 2 pi expected, {found} found. Degrees? Write {found} * og.units.deg."
        )
