"""Checks of the numbers that control laws are given, each with a message that names the argument."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError

Array = NDArray[Any]

#: Stands for "no limit" in the flat data of kernels, which hold finite numbers only.
NO_LIMIT = 1e30


def positive(value: float, what: str, unit: str) -> float:
    """Return a finite number > 0 or raise :class:`InputError` that names `what`.

    Examples
    --------
    >>> positive(2, "period", "s")
    2.0
    """
    return _number(value, what, f"a positive number ({unit})", lambda x: x > 0.0)


def not_negative(value: float, what: str, unit: str) -> float:
    """Return a finite number >= 0 or raise :class:`InputError` that names `what`.

    Examples
    --------
    >>> not_negative(0, "rate", "N/s")
    0.0
    """
    return _number(value, what, f"a number >= 0 ({unit})", lambda x: x >= 0.0)


def finite(value: float, what: str, unit: str) -> float:
    """Return a finite number or raise :class:`InputError` that names `what`.

    Examples
    --------
    >>> finite(-1, "speed", "m/s")
    -1.0
    """
    return _number(value, what, f"a finite number ({unit})", lambda x: True)


def limit(value: float, what: str, unit: str) -> float:
    """Return a number > 0, with infinity as :data:`NO_LIMIT`, or raise :class:`InputError` that names `what`.

    Examples
    --------
    >>> limit(np.inf, "max_rate", "rad/s") == NO_LIMIT
    True
    """
    if isinstance(value, (int, float, np.number)) and value == np.inf:
        return NO_LIMIT
    return _number(value, what, f"a positive number or infinity ({unit})", lambda x: x > 0.0)


def limits(value: ArrayLike, n: int, what: str, unit: str) -> Array:
    """Return n limits as :func:`limit` takes them; one number serves all.

    Examples
    --------
    >>> limits(5.0, 3, "max_force", "N")
    array([5., 5., 5.])
    """
    several: list[Any] = [value] * n if not shape_of(value, what) else np.ravel(np.asarray(value, dtype=object)).tolist()
    if len(several) != n:
        raise InputError(f"{what}: {n} positive numbers or infinity ({unit}) expected, {len(several)} found.")
    return np.array([limit(number, what, unit) for number in several])


def vector(value: ArrayLike, shape: tuple[int, ...], what: str, *, fill: bool = False) -> Array:
    """Return a finite, read-only array of this shape or raise :class:`InputError`; with `fill` one number serves all.

    Examples
    --------
    >>> vector(0.1, (3,), "natural_frequency", fill=True)
    array([0.1, 0.1, 0.1])
    """
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{what}: numbers of shape {shape} expected, {value!r} found.") from None
    if fill and array.ndim == 0:
        array = np.full(shape, float(array))
    if array.shape != shape or not np.all(np.isfinite(array)):
        raise InputError(f"{what}: finite numbers of shape {shape} expected, {np.asarray(value).tolist()} found.")
    array.setflags(write=False)
    return array


def shape_of(value: ArrayLike, what: str) -> tuple[int, ...]:
    """Return the shape of an array, or raise :class:`InputError` for nested sequences of unequal lengths.

    Examples
    --------
    >>> shape_of([[1, 2, 3]], "added_mass")
    (1, 3)
    """
    try:
        return tuple(np.shape(value))
    except ValueError:
        raise InputError(f"{what}: an array expected, rows of different lengths found.") from None


def horizontal(matrix: ArrayLike, what: str) -> Array:
    """Return the (3, 3) part for surge, sway and yaw of a (6, 6) matrix about O; a (3, 3) one is taken as it is.

    Examples
    --------
    >>> horizontal(np.diag([1.0, 2, 3, 4, 5, 6]), "added_mass").diagonal()
    array([1., 2., 6.])
    """
    shape = shape_of(matrix, what)
    if shape not in ((3, 3), (6, 6)):
        raise InputError(f"{what}: shape (6, 6), or (3, 3) for surge, sway and yaw, expected, {shape} found.")
    full = vector(matrix, shape, what)
    index = [0, 1, 5] if shape == (6, 6) else [0, 1, 2]
    return np.array(full[np.ix_(index, index)])


def diagonal(value: ArrayLike, index: int, what: str) -> float:
    """Return a number >= 0 of one degree of freedom, given itself or as the diagonal entry of a (6, 6) matrix about O.

    Examples
    --------
    >>> diagonal(np.diag([1.0, 2, 3, 4, 5, 6]), 5, "added_mass")
    6.0
    """
    if not shape_of(value, what):
        return not_negative(value, what, "SI")  # type: ignore[arg-type]
    return not_negative(vector(value, (6, 6), what)[index, index], what, "SI")


def _number(value: Any, what: str, expected: str, allowed: Any) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{what}: {expected} expected, {value!r} found.") from None
    if not (np.isfinite(number) and allowed(number)):
        raise InputError(f"{what}: {expected} expected, {value!r} found.")
    return number
