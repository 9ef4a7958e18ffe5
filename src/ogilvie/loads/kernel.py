"""Compiled forces: what a load hands to the time loop when its force is not linear in the motion.

A force kernel is a compiled function ``f(x, data, own, force)`` that adds a force on the body about O, in body axes, to
``force`` (6,). ``x`` is the situation at one stage of a step, ``data`` the load's numbers in one flat array, ``own`` those of
the realisation. A control kernel has the same form, is called once per sampling period, keeps its memory in ``own``, and its
force is held until the next sample. One signature for all, so a new load is a new file and never a branch in the time loop.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from ogilvie.errors import InputError

Array = NDArray[Any]

#: Places in the situation x: time (s); pose eta in the world (m, rad); velocity nu in body axes; velocity through the water
#: nu_r in body axes; the rotation matrix R (3, 3) row by row, body to world; the mean speed, that is the surge velocity through
#: the water averaged over the last minute or so; the slow x, y (m) and heading (rad), without the motion in the waves; the
#: number of entries.
TIME, ETA, NU, NU_R, ROTATION, MEAN_SPEED, SLOW, SITUATION = 0, 1, 7, 13, 19, 28, 29, 32

_F8 = types.float64[::1]
SIGNATURE = types.void(_F8, _F8, _F8, _F8)

#: Decorator of a kernel ``f(x, data, own, force)``.
load_kernel = njit(SIGNATURE, cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz", "arcp"})


@dataclass(frozen=True, eq=False)
class Kernel:
    """A compiled force.

    Parameters
    ----------
    function : compiled function
        Made by :data:`load_kernel`; adds to the force.
    data : (n,) array
    own : (r, m) array, optional
        Numbers of each realisation; one row serves all.
    limits : str
        Where the force is known, for the error of a run that leaves it; the function gives NaN there.
    steady : bool
        Whether the force does not depend on time, so that its slopes tell about stability.
    """

    function: Any
    data: Array = field(default_factory=lambda: np.zeros(0))
    own: Array = field(default_factory=lambda: np.zeros((1, 0)))
    limits: str = ""
    steady: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "data", _flat(self.data, 1))
        object.__setattr__(self, "own", _flat(self.own, 2))

    def force(self, *, t: float = 0.0, eta: Any = None, nu: Any = None, nu_r: Any = None) -> Array:
        """Return the force (6,) in one situation, for looking and testing; nu_r is nu where it is not given."""
        force = np.zeros(6)
        self.function(situation(t, eta, nu, nu_r), self.data, self.own[0].copy(), force)
        return force


@dataclass(frozen=True, eq=False)
class Sampled:
    """A compiled control law, called every `period` seconds; its force is held in between.

    Parameters
    ----------
    function : compiled function
        Made by :data:`load_kernel`; overwrites the force (it finds the one it gave last) and may change its memory.
    data : (n,) array
    memory : (m,) array
        At the start.
    period : float
        s, > 0.
    signals : tuple of (name, unit, place)
        Entries of the memory that results record.
    """

    function: Any
    data: Array
    memory: Array
    period: float
    signals: tuple[tuple[str, str, int], ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "data", _flat(self.data, 1))
        object.__setattr__(self, "memory", _flat(self.memory, 1))
        if not (np.isfinite(self.period) and self.period > 0.0):
            raise InputError(f"period: a positive number of s expected, {self.period!r} found.")


@dataclass(frozen=True, eq=False)
class Callback:
    """A force that Python computes, called every `period` seconds and held in between.

    Parameters
    ----------
    function : callable
        ``function(t, eta, nu)`` returns the force (6,) on the body about O, in body axes, N and N m.
    period : float
        s, > 0.
    begin : callable, optional
        ``begin(t, eta, nu)`` is called before the first step.
    alone : bool
        The function keeps a state of its own, so it serves one realisation only.
    """

    function: Callable[[float, Array, Array], Array]
    period: float
    begin: Callable[[float, Array, Array], Any] | None = None
    alone: bool = False

    def held(self) -> Sampled:
        """Return the control law that keeps what Python wrote."""
        return Sampled(_hold, np.zeros(0), np.zeros(0), self.period)


@load_kernel
def _hold(x, data, own, force):
    pass


def situation(t: float = 0.0, eta: Any = None, nu: Any = None, nu_r: Any = None) -> Array:
    """Return the situation x (32,) of a pose and velocities, zero where not given, mean speed and slow pose as now.

    Examples
    --------
    >>> situation(2.0, nu=[3.0, 0, 0, 0, 0, 0])[[TIME, NU, NU_R, ROTATION]]
    array([2., 3., 3., 1.])
    """
    from ogilvie.frames import rotation_matrix

    x = np.zeros(SITUATION)
    x[TIME] = t
    x[ETA:NU] = 0.0 if eta is None else eta
    x[NU:NU_R] = 0.0 if nu is None else nu
    x[NU_R:ROTATION] = x[NU:NU_R] if nu_r is None else nu_r
    x[ROTATION:MEAN_SPEED] = rotation_matrix(*x[ETA + 3 : ETA + 6]).ravel()
    x[MEAN_SPEED] = x[NU_R]
    x[SLOW:] = x[[ETA, ETA + 1, ETA + 5]]
    return x


def _flat(value: Any, ndim: int) -> Array:
    array = np.array(value, dtype=float, order="C")  # a copy: kernels take no read-only arrays
    if array.ndim != ndim or not np.all(np.isfinite(array)):
        raise InputError(f"kernel: {ndim}-dimensional array of finite numbers expected, shape {array.shape} found.")
    return array
