"""What a load is: which physical effects it covers, and the plain arrays that it hands to the time loop."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.body import RigidBody
from ogilvie.errors import InputError
from ogilvie.hydro.schema import DOFS
from ogilvie.loads.kernel import Callback, Kernel, Sampled
from ogilvie.waves.field import Sea

Array = NDArray[Any]
ComplexArray = NDArray[Any]

#: Physical effects. Two loads of one vessel must not cover the same one.
RESTORING = "hydrostatic restoring"
FROUDE_KRYLOV = "Froude-Krylov force"
DIFFRACTION = "diffraction force"
RADIATION = "wave radiation"
SLOW_DRIFT = "slow drift"
MOORING = "mooring"


def viscous_effect(dof: str) -> str:
    """Return the name of the effect "viscous damping" of one degree of freedom.

    Examples
    --------
    >>> viscous_effect("roll")
    'viscous damping of roll'
    """
    return f"viscous damping of {dof}"


class WaveTransfer(Protocol):
    """Complex force per metre of wave amplitude, for the components of a sea."""

    def __call__(self, sea: Sea, heading: float) -> ComplexArray:
        """Return the force (n, 6) of each component on a vessel with this heading (rad)."""
        ...


class Encounter(Protocol):
    """Compiled force of a sea on a vessel that is anywhere in it."""

    def __call__(self, sea: Sea, ramp: float) -> Kernel:
        """Return the force of the sea, which grows from nothing during the ramp (s)."""
        ...


class ForceSeries(Protocol):
    """Force of a sea on a vessel on a steady course, known before the run."""

    def series(self, realisation: int, start: float, step: float, count: int) -> Array:
        """Return the force (count, 6) at times from `start`, `step` apart (s), in axes along the mean heading."""
        ...

    def mean(self, realisation: int) -> Array:
        """Return its mean (6,)."""
        ...


class SecondOrderTable(Protocol):
    """Force of second order in the wave amplitude, for a vessel that is at the origin of the sea at t = 0."""

    def __call__(self, sea: Sea, heading: float, speed: float) -> ForceSeries:
        """Return the force of the full sea; the time loop multiplies it by the square of the ramp."""
        ...


@dataclass(frozen=True, eq=False)
class MemoryModel:
    """Memory force mu = C x, x' = A x + B nu in all six degrees of freedom: A (n, n), B (n, 6), C (6, n)."""

    A: Array
    B: Array
    C: Array


@dataclass(frozen=True, eq=False)
class MemoryKernel:
    """Memory force mu = int K(s) nu(t - s) ds with K (n_t, 6, 6) on the uniform times t (n_t,), zero after them."""

    t: Array
    K: Array

    @cached_property
    def spline(self) -> Any:
        """Cubic spline through the table: a function of time."""
        from scipy.interpolate import CubicSpline

        return CubicSpline(self.t, self.K, axis=0)


@dataclass(frozen=True, eq=False)
class Terms:
    """What a load adds to the equations of motion, as plain arrays about O.

    Parameters
    ----------
    added_mass, damping, stiffness : (6, 6) array
        SI.
    constant : (6,) array
        N, N m.
    damping_ratio : (6,) array
        Fractions of critical damping; turned into a damping matrix when mass, added mass and stiffness of the vessel are known.
    memory : MemoryModel or MemoryKernel, optional
    wave : callable, optional
        Complex force per metre of wave amplitude.
    table : callable, optional
        Force of second order in the wave amplitude, made before the run.
    kernel : Kernel, optional
        Compiled force that is not linear in the motion; see :mod:`ogilvie.loads.kernel`.
    small : Terms, optional
        What stands for the whole load in small motions; without it a load with a kernel is for large motions only.
    suffices : bool
        Whether `small` is all there is to first order, so that motions are small unless told otherwise. Quadratic damping, say,
        has a linear part too, but leaving the rest out has to be asked for.
    encounter : callable, optional
        Compiled force of the waves where the vessel is, in place of `wave` and `table` when motions are large.
    control : Sampled, optional
        Compiled control law, sampled and held.
    callback : Callback, optional
        The same in Python.
    current : (3,) array
        Velocity of the water in the world, m/s.

    Notes
    -----
    Force on the body = constant - added_mass nu' - damping nu - stiffness eta - mu
    + Re sum_j wave_j a_j exp(i (w_e t + phase)_j) + table + kernel + encounter + control + callback.
    """

    added_mass: Array = field(default_factory=lambda: np.zeros((6, 6)))
    damping: Array = field(default_factory=lambda: np.zeros((6, 6)))
    stiffness: Array = field(default_factory=lambda: np.zeros((6, 6)))
    constant: Array = field(default_factory=lambda: np.zeros(6))
    damping_ratio: Array = field(default_factory=lambda: np.zeros(6))
    memory: MemoryModel | MemoryKernel | None = None
    wave: WaveTransfer | None = None
    table: SecondOrderTable | None = None
    kernel: Kernel | None = None
    small: "Terms | None" = None
    suffices: bool = False
    encounter: Encounter | None = None
    control: Sampled | None = None
    callback: Callback | None = None
    current: Array = field(default_factory=lambda: np.zeros(3))


@dataclass(frozen=True, eq=False)
class Surroundings:
    """What a load may know of its vessel when it is bound: the body, speed (m/s) and heading (rad)."""

    body: RigidBody
    speed: float = 0.0
    heading: float = 0.0


@runtime_checkable
class Load(Protocol):
    """A force on the body.

    ``name`` labels the output (``force_<name>``), ``covers`` holds the physical effects that the load accounts for, and
    ``bind`` turns the description into arrays for the time loop.
    """

    @property
    def name(self) -> str: ...

    @property
    def covers(self) -> frozenset[str]: ...

    def bind(self, surroundings: Surroundings) -> Terms: ...


def matrix6(value: ArrayLike, what: str) -> Array:
    """Return a finite, read-only (6, 6) array or raise :class:`InputError` that names `what`."""
    return _finite(value, (6, 6), what)


def vector6(value: ArrayLike, what: str) -> Array:
    """Return a finite, read-only (6,) array or raise :class:`InputError` that names `what`."""
    return _finite(value, (6,), what)


def _finite(value: ArrayLike, shape: tuple[int, ...], what: str) -> Array:
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{what}: numbers of shape {shape} expected, {type(value).__name__} found.") from None
    if array.shape != shape:
        raise InputError(f"{what}: shape {shape} expected, {array.shape} found.")
    if not np.all(np.isfinite(array)):
        raise InputError(f"{what}: finite numbers expected, {int((~np.isfinite(array)).sum())} NaN or infinite found.")
    array.setflags(write=False)
    return array


def dof_indices(dofs: Sequence[str]) -> NDArray[np.intp]:
    """Return the places of the named degrees of freedom among the six, or raise :class:`InputError`.

    Examples
    --------
    >>> dof_indices(("heave", "pitch"))
    array([2, 4])
    """
    unknown = [d for d in dofs if d not in DOFS]
    if unknown:
        raise InputError(f"degrees of freedom: names out of {', '.join(DOFS)} expected, {', '.join(map(str, unknown))} found.")
    if len(set(dofs)) != len(dofs):
        raise InputError(f"degrees of freedom: distinct names expected, {', '.join(dofs)} found.")
    return np.array([DOFS.index(d) for d in dofs], dtype=np.intp)


def embed(value: ArrayLike, dofs: Sequence[str], axes: tuple[int, ...]) -> Array:
    """Return the array with each of the `axes`, which run over `dofs`, extended to all six degrees of freedom by zeros.

    Examples
    --------
    >>> embed([[3.0]], ("heave",), (0, 1))[2]
    array([0., 0., 3., 0., 0., 0.])
    """
    array = np.asarray(value)
    index = dof_indices(dofs)
    if list(index) == list(range(6)):
        return np.array(array)
    for axis in axes:
        shape = list(array.shape)
        shape[axis] = 6
        wide = np.zeros(shape, dtype=array.dtype)
        place: list[Any] = [slice(None)] * array.ndim
        place[axis] = index
        wide[tuple(place)] = array
        array = wide
    return array


def per_dof(values: Mapping[str, float], what: str) -> Array:
    """Return a (6,) array from a mapping of names of degrees of freedom to finite numbers.

    Examples
    --------
    >>> per_dof({"roll": 0.05}, "ratio")
    array([0.  , 0.  , 0.  , 0.05, 0.  , 0.  ])
    """
    index = dof_indices(tuple(values))
    out = np.zeros(6)
    out[index] = np.array(list(values.values()), dtype=float)
    return vector6(out, what)
