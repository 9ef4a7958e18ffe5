"""One mooring line: where it is held and what it is made of."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError

Array = NDArray[Any]


@dataclass(frozen=True, eq=False, init=False)
class MooringLine:
    """One line of uniform properties from an anchor to a fairlead.

    Parameters
    ----------
    anchor : (3,) array
        World, m: z is minus the depth where the anchor lies on the bottom.
    fairlead : (3,) array
        Body axes, from O, m.
    length : float
        Unstretched, m.
    weight : float
        In water, per unstretched length, N/m.
    stiffness : float
        EA, N.
    friction : float
        Coefficient of friction between line and bottom.
    grounded : bool
        True: a flat bottom at the level of the anchor carries what lies on it. False: the line hangs free, e.g. from a pile.

    Raises
    ------
    InputError
        Wrong shape, NaN, length, weight or stiffness not positive, negative friction, a line heavier than its axial stiffness.

    Examples
    --------
    >>> line = MooringLine([837.6, 0, -200], [40.868, 0, -14], length=835.35, weight=108.63 * 9.81, stiffness=753.6e6)
    >>> line.friction
    0.0
    """

    anchor: Array
    fairlead: Array
    length: float
    weight: float
    stiffness: float
    friction: float
    grounded: bool

    def __init__(
        self,
        anchor: ArrayLike,
        fairlead: ArrayLike,
        *,
        length: float,
        weight: float,
        stiffness: float,
        friction: float = 0.0,
        grounded: bool = True,
    ) -> None:
        object.__setattr__(self, "anchor", _point(anchor, "anchor"))
        object.__setattr__(self, "fairlead", _point(fairlead, "fairlead"))
        for name, value, unit in (("length", length, "m"), ("weight", weight, "N/m"), ("stiffness", stiffness, "N")):
            object.__setattr__(self, name, _number(value, name, unit, positive=True))
        object.__setattr__(self, "friction", _number(friction, "friction", "", positive=False))
        object.__setattr__(self, "grounded", bool(grounded))
        if self.weight * self.length > self.stiffness:
            raise InputError(
                f"MooringLine: stiffness EA above the line's weight {self.weight * self.length:.4g} N expected, "
                f"{self.stiffness:.4g} N found. EA is in N, weight in N/m."
            )

    @property
    def row(self) -> Array:
        """The line's numbers (11,) for the kernel: anchor, fairlead, length, weight, stiffness, friction, grounded (1 or 0)."""
        rest = (self.length, self.weight, self.stiffness, self.friction, float(self.grounded))
        return np.concatenate([self.anchor, self.fairlead, rest])


def _point(value: ArrayLike, what: str) -> Array:
    try:
        point = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"MooringLine: {what}: three coordinates in m expected, {value!r} found.") from None
    if point.shape != (3,) or not np.all(np.isfinite(point)):
        raise InputError(f"MooringLine: {what}: three finite coordinates in m expected, {value!r} found.")
    point.setflags(write=False)
    return point


def _number(value: float, what: str, unit: str, *, positive: bool) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = np.nan
    if not np.isfinite(number) or number < 0.0 or (positive and number == 0.0):
        kind = "positive number" if positive else "number >= 0"
        raise InputError(f"MooringLine: {what}: a {kind}{' of ' + unit if unit else ''} expected, {value!r} found.")
    return number
