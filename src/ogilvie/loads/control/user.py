"""A force that the user writes in Python, sampled and held."""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import Surroundings, Terms
from ogilvie.loads.control.checks import positive
from ogilvie.loads.kernel import Callback

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class UserForce:
    """A force from a Python function of time, pose and velocity.

    Parameters
    ----------
    function : callable
        f(t, eta, nu) -> (6,): force on the body about O in body axes, N, N m, from the time (s), the pose eta (6,) in the world
        and the velocity nu (6,) in body axes. It gets copies; changing them changes nothing.
    period : float
        The function is called once per period (s) and its force is held in between.
    name : str
        Labels the output, ``force_<name>``.
    covers : frozenset of str
        Effects that the function accounts for, so that no other load covers them too, e.g. ``frozenset({"mooring"})``.

    Raises
    ------
    InputError
        No function, a period that is not positive, `covers` that is one string.

    Examples
    --------
    >>> tug = UserForce(lambda t, eta, nu: [0, 2e5, 0, 0, 0, 0], 1.0, name="tug")
    >>> float(tug.call(0.0, np.zeros(6), np.zeros(6))[1])
    200000.0
    """

    function: Callable[[float, Array, Array], ArrayLike]
    period: float
    name: str = field(default="user", kw_only=True)
    covers: frozenset[str] = field(default=frozenset(), kw_only=True)

    def __post_init__(self) -> None:
        if not callable(self.function):
            raise InputError(f"UserForce: a function f(t, eta, nu) -> (6,) expected, {type(self.function).__name__} found.")
        positive(self.period, "UserForce: period", "s")
        if not (isinstance(self.name, str) and self.name):
            raise InputError(f"UserForce: name: a text that is not empty expected, {self.name!r} found.")
        if isinstance(self.covers, str) or not all(isinstance(effect, str) for effect in self.covers):
            raise InputError(f"UserForce: covers: a set of names of effects expected, {self.covers!r} found.")
        object.__setattr__(self, "covers", frozenset(self.covers))

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return what the time loop calls."""
        return Terms(callback=Callback(self.call, self.period))

    def call(self, t: float, eta: Array, nu: Array) -> Array:
        """Return the force (6,) of the function at time t (s), pose eta (6,) and velocity nu (6,).

        Raises
        ------
        InputError
            The function returned something other than six finite numbers. What the function itself raises passes through, with
            a note of the load and the time.
        """
        try:
            value = self.function(float(t), eta.copy(), nu.copy())
        except Exception as error:
            error.add_note(f"Raised in {self._where(t)}.")
            raise
        try:
            force = np.array(value, dtype=float)
        except (TypeError, ValueError):
            raise InputError(f"{self._where(t)}: six numbers (N, N m) expected, {type(value).__name__} found.") from None
        if force.shape != (6,):
            raise InputError(f"{self._where(t)}: force of shape (6,) about O expected, {force.shape} found.")
        if not isfinite(force.sum()):
            raise InputError(f"{self._where(t)}: finite numbers expected, {force.tolist()} found.")
        return force

    def _where(self, t: float) -> str:
        return f"UserForce {self.name!r}: function {getattr(self.function, '__name__', repr(self.function))} at t = {t:g} s"
