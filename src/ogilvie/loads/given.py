"""Numbers as they were given to a load, checked once."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError

Array = NDArray[Any]


def number(value: Any, what: str, *, least: float = -np.inf, above: float = -np.inf) -> float:
    """Return a finite float that is >= `least` and > `above`, or raise :class:`InputError` that names `what`.

    Examples
    --------
    >>> number(3, "draught (m)", above=0.0)
    3.0
    """
    try:
        x = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{what}: a number expected, {value!r} found.") from None
    if not (np.isfinite(x) and x >= least and x > above):
        bound = f" > {above:g}" if above > -np.inf else f" >= {least:g}" if least > -np.inf else ""
        raise InputError(f"{what}: a finite number{bound} expected, {value!r} found.")
    return x


def column(
    value: ArrayLike, what: str, *, n: int | None = None, least: float = -np.inf, fewest: int = 1, wide: int | None = None
) -> Array:
    """Return a finite (n,) array, or (n, wide) where `wide` is given; one number (row) serves all n.

    Examples
    --------
    >>> column(2.0, "cd", n=3)
    array([2., 2., 2.])
    """
    try:
        x = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{what}: numbers expected, {type(value).__name__} found.") from None
    tail = () if wide is None else (wide,)
    if n is not None and x.shape == tail:
        x = np.broadcast_to(x, (n, *tail)).copy()
    count = len(x) if x.ndim else 0
    if x.shape != (count, *tail) or count < fewest or (n is not None and count != n):
        rows = f"{n}" if n is not None else f"n >= {fewest}"
        raise InputError(f"{what}: shape ({', '.join([rows, *map(str, tail)])}) expected, {x.shape} found.")
    if not np.all(np.isfinite(x)) or np.any(x < least):
        bound = f" >= {least:g}" if least > -np.inf else ""
        raise InputError(f"{what}: finite numbers{bound} expected, NaN, infinite or smaller ones found.")
    x.setflags(write=False)
    return x


def ascending(value: ArrayLike, what: str, *, fewest: int = 2) -> Array:
    """Return a finite (n,) array that strictly ascends, or raise :class:`InputError` that names `what`.

    Examples
    --------
    >>> ascending([0.0, 1.0, 3.0], "x")
    array([0., 1., 3.])
    """
    x = column(value, what, fewest=fewest)
    if np.any(np.diff(x) <= 0.0):
        at = int(np.argmax(np.diff(x) <= 0.0))
        raise InputError(f"{what}: strictly ascending numbers expected, {x[at]:.6g} followed by {x[at + 1]:.6g} found.")
    return x
