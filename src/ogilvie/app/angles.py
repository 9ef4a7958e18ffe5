"""Angles of a case that look as if they were radians."""

from collections.abc import Iterator
from math import degrees, pi
from typing import Any

from pydantic import BaseModel

from ogilvie.app.sections import SECTIONS

#: Angles that people write, rad, and how near a number has to be to be taken for one.
_STEP, _NEAR = pi / 12, 0.0026


def looks_like_radians(value: float) -> bool:
    """Return whether a number of degrees is a multiple of pi/12 to two or more decimals, as no round number of degrees is.

    Examples
    --------
    >>> [looks_like_radians(v) for v in (3.1416, 1.57, -2.356, 180.0, 15.0, 0.0, 2.5)]
    [True, True, True, False, False, False, False]
    """
    nearest = round(value / _STEP)
    return nearest != 0 and abs(nearest) <= 24 and abs(value - nearest * _STEP) < _NEAR and (2 * value) % 1 != 0


def in_radians(case: Any) -> Iterator[str]:
    """Yield a sentence for every angle of a case that looks like radians where degrees are meant."""
    for name in SECTIONS:
        section = getattr(case, name)
        if section is not None:
            for path, value in _angles(section, name):
                if looks_like_radians(value):
                    yield (
                        f"{path}: {value:g}: degrees expected; this is {degrees(value):.0f} deg in radians. "
                        f"Write {degrees(value):.0f} if that is meant."
                    )


def _angles(section: BaseModel, name: str) -> Iterator[tuple[str, float]]:
    """The numbers under keys that end in _deg, and the angles of schedules, with their paths in the file."""
    for key in type(section).model_fields:
        value, path = getattr(section, key), f"{name}.{key}"
        if isinstance(value, BaseModel):
            yield from _angles(value, path)
        elif isinstance(value, list) and value and isinstance(value[0], BaseModel):
            for i, inner in enumerate(value):
                yield from _angles(inner, f"{path}[{i}]")
        elif key == "schedule" and value is not None:
            yield from ((f"{path}[{i}][{len(row) - 1}]", row[-1]) for i, row in enumerate(value))
        elif key.endswith("_deg") and value is not None:
            listed = isinstance(value, list)
            yield from ((f"{path}[{i}]" if listed else path, v) for i, v in enumerate(value if listed else [value]))
