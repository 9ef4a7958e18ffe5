"""Wave radiation: added mass at infinite frequency and fluid memory."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import RADIATION, MemoryKernel, MemoryModel, Surroundings, Terms, dof_indices, embed
from ogilvie.memory.convolve import checked_length, truncated
from ogilvie.memory.statespace import StateSpace
from ogilvie.memory.table import Retardation

Array = NDArray[Any]


@dataclass(frozen=True, eq=False, init=False)
class StateSpaceRadiation:
    """Radiation force -A_inf nu' - mu with the fluid memory as a state space: mu = C x, x' = A x + B nu.

    Parameters
    ----------
    model : StateSpace
        Stable model of the fluid memory, e.g. from :func:`ogilvie.identify`.
    added_mass : (m, m) array, optional
        Added mass at infinite frequency, SI; taken from the model where it is not given.

    Raises
    ------
    InputError
        No added mass anywhere, unstable model, wrong shape.

    References
    ----------
    Paper A (Yuan), Eqs. (2), (3).

    Examples
    --------
    >>> ssm = StateSpace(A=[[-1.0]], B=[[1.0]], C=[[2.0]], dofs=("heave",))
    >>> float(StateSpaceRadiation(ssm, added_mass=[[5.0]]).bind(None).added_mass[2, 2])
    5.0
    """

    model: StateSpace
    added_mass: Array
    name: str = "radiation"

    def __init__(self, model: StateSpace, *, added_mass: ArrayLike | None = None) -> None:
        if not isinstance(model, StateSpace):
            raise InputError(f"StateSpaceRadiation: a StateSpace (e.g. from identify) expected, {type(model).__name__} found.")
        if added_mass is None:
            added_mass = model.A_inf
        if added_mass is None:
            raise InputError(
                "StateSpaceRadiation: the added mass at infinite frequency is missing from the model. "
                "Give added_mass=..., e.g. Retardation.A_inf or hydro.added_mass_inf.values."
            )
        if not model.is_stable:
            raise InputError(
                f"StateSpaceRadiation: a stable memory model expected, a pole with real part {model.poles.real.max():+.4g} 1/s "
                "found. Identify again with another order or method."
            )
        object.__setattr__(self, "model", model)
        object.__setattr__(self, "added_mass", _matrix(added_mass, model.dofs, "StateSpaceRadiation: added_mass"))
        object.__setattr__(self, "name", "radiation")

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({RADIATION})

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays for the time loop."""
        m, dofs = self.model, self.model.dofs
        return Terms(added_mass=self.added_mass, memory=MemoryModel(m.A, embed(m.B, dofs, (1,)), embed(m.C, dofs, (0,))))


@dataclass(frozen=True, eq=False, init=False)
class Convolution:
    """Radiation force -A_inf nu' - int_0^T K(s) nu(t - s) ds, the convolution evaluated at every stage of every step.

    Parameters
    ----------
    K : Retardation
        Retardation functions with their added mass at infinite frequency.
    truncation : float, optional
        Length T of the memory, s. By default the shortest after which no more than 1e-5 of ``int |K| dt`` is left in any
        coupling (:func:`ogilvie.memory.convolve.memory_length`); ``K.duration`` takes the whole table. ``K.truncation_error``
        tells what the table itself leaves out.

    Raises
    ------
    InputError
        Not a Retardation; truncation longer than the table or not positive.

    References
    ----------
    Cummins (1962); paper A (Yuan), Eq. (1).

    Examples
    --------
    >>> t = np.arange(0, 10, 0.1)
    >>> K = Retardation(t=t, K=np.exp(-t)[:, None, None], A_inf=np.array([[3.0]]), dofs=("heave",))
    >>> Convolution(K, truncation=5.0).bind(None).memory.K.shape
    (51, 6, 6)
    """

    K: Retardation
    truncation: float
    name: str = "radiation"

    def __init__(self, K: Retardation, *, truncation: float | None = None) -> None:
        length = checked_length(K, truncation, "Convolution")
        object.__setattr__(self, "K", K)
        object.__setattr__(self, "truncation", length)
        object.__setattr__(self, "name", "radiation")

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({RADIATION})

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays for the time loop."""
        K = truncated(self.K, self.truncation)
        added_mass = _matrix(K.A_inf, K.dofs, "Convolution: A_inf")
        return Terms(added_mass=added_mass, memory=MemoryKernel(K.t, embed(K.K, K.dofs, (1, 2))))


def _matrix(value: ArrayLike, dofs: tuple[str, ...], what: str) -> Array:
    """Return an (m, m) matrix over the dofs as (6, 6)."""
    m = len(dof_indices(dofs))
    array = np.asarray(value, dtype=float)
    if array.shape != (m, m) or not np.all(np.isfinite(array)):
        raise InputError(f"{what}: finite ({m}, {m}) matrix over {', '.join(dofs)} expected, shape {array.shape} found.")
    return embed(array, dofs, (0, 1))
