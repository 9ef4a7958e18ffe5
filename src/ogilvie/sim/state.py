"""State of a vessel at one time: pose, velocity, fluid memory."""

import os
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import FormatError, InputError

Array = NDArray[Any]
_FIELDS = ("eta", "nu", "memory", "time")


@dataclass(frozen=True, eq=False, init=False)
class State:
    """Pose, velocity and fluid memory at one time.

    Parameters
    ----------
    eta : (..., 6) array, optional
        Displacement and rotation from the steady frame that moves with the vessel's speed and heading, m and rad; zero by
        default.
    nu : (..., 6) array, optional
        Their rates, m/s and rad/s; zero by default.
    memory : (..., k) array, optional
        States of the fluid memory as the time loop keeps them; at rest by default.
    time : float
        s.

    Raises
    ------
    InputError
        Wrong shape, NaN or infinite numbers.

    Examples
    --------
    >>> heeled = State(eta=[0, 0, 0, 0.1, 0, 0])
    >>> heeled.nu
    array([0., 0., 0., 0., 0., 0.])
    """

    eta: Array
    nu: Array
    memory: Array | None
    time: float

    def __init__(
        self,
        eta: ArrayLike | None = None,
        nu: ArrayLike | None = None,
        *,
        memory: ArrayLike | None = None,
        time: float = 0.0,
    ) -> None:
        arrays = {"eta": _vectors(eta, "eta"), "nu": _vectors(nu, "nu")}
        if memory is not None:
            arrays["memory"] = _finite(memory, "memory")
        if not np.isfinite(time):
            raise InputError(f"state: a finite time in s expected, {time!r} found.")
        object.__setattr__(self, "memory", None)
        object.__setattr__(self, "time", float(time))
        for key, value in arrays.items():
            value.setflags(write=False)
            object.__setattr__(self, key, value)

    @classmethod
    def unchecked(cls, eta: Array, nu: Array, memory: Array, time: float) -> "State":
        """Return a state of arrays that are known to be right and are not used elsewhere."""
        state = object.__new__(cls)
        for key, value in zip(_FIELDS[:3], (eta, nu, memory), strict=True):
            value.flags.writeable = False
            object.__setattr__(state, key, value)
        object.__setattr__(state, "time", time)
        return state

    def save(self, path: str | Path) -> None:
        """Write the state to a NumPy archive, bit-exact; the file is written whole or not at all."""
        path = Path(path)
        values = {key: getattr(self, key) for key in _FIELDS if getattr(self, key) is not None}
        handle, part = tempfile.mkstemp(dir=path.parent, prefix=path.name, suffix=".part")
        try:
            with os.fdopen(handle, "wb") as file:
                np.savez(file, allow_pickle=False, **values)
            os.replace(part, path)
        except BaseException:
            Path(part).unlink(missing_ok=True)
            raise

    @classmethod
    def load(cls, path: str | Path) -> "State":
        """Read a state that :meth:`save` wrote."""
        try:
            with np.load(path, allow_pickle=False) as file:
                values = {key: file[key] for key in _FIELDS if key in file}
            return cls(values["eta"], values["nu"], memory=values.get("memory"), time=float(values["time"]))
        except FileNotFoundError:
            raise
        except Exception as error:
            raise FormatError(f"{path}: a state written by State.save expected, something else found ({error}).") from error


def as_state(value: "State | Mapping[str, Any]") -> State:
    """Return a State from a State or a mapping with the keys eta, nu, memory, time."""
    if isinstance(value, State):
        return value
    if not isinstance(value, Mapping):
        raise InputError(f"initial: a State or a mapping with eta and nu expected, {type(value).__name__} found.")
    unknown = [k for k in value if k not in _FIELDS]
    if unknown:
        raise InputError(f"initial: keys out of {', '.join(_FIELDS)} expected, {', '.join(map(repr, unknown))} found.")
    state = State(value.get("eta"), value.get("nu"), memory=value.get("memory"), time=value.get("time", 0.0))
    for i, name, most in ((3, "roll", np.pi), (4, "pitch", np.pi / 2)):
        if (largest := float(np.abs(state.eta[..., i]).max())) > most:
            raise InputError(
                f"initial: {name} within {most:.4g} rad expected, {largest:g} found. Degrees? Write {largest:g} * og.units.deg."
            )
    return state


def _vectors(value: ArrayLike | None, what: str) -> Array:
    array = _finite(np.zeros(6) if value is None else value, what)
    if array.ndim == 0 or array.shape[-1] != 6:
        raise InputError(f"state: {what} with six numbers in its last axis expected, shape {array.shape} found.")
    return array


def _finite(value: ArrayLike, what: str) -> Array:
    array = np.array(value, dtype=float)
    if not np.all(np.isfinite(array)):
        raise InputError(f"state: {what} without NaN or infinite numbers expected, {array.tolist()} found.")
    return array
