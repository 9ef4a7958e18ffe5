"""What the hull feels everywhere on it after unit impulses of its motion: the source of K, added mass, damping, wave forces."""

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.coupled import CoupledSystem, joined
from ogilvie.bem.hybrid_case import HybridCase
from ogilvie.bem.inner import InnerMap, inner_maps
from ogilvie.bem.short_waves import short_waves, wavenumber_limit
from ogilvie.bem.stepping import impulse_response
from ogilvie.hydro.threads import in_parallel
from ogilvie.memory.table import Retardation

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Part:
    """One class of symmetry, in units of control radius and gravity.

    Parameters
    ----------
    system : CoupledSystem
    rate : (n_t, n_hull, n_dofs) array
        Rate of the memory potential at the hull's nodes after a unit impulse in each dof, times sqrt(weight).
    K : (n_t, n_dofs, n_dofs) array
    """

    system: CoupledSystem
    rate: Array
    K: Array

    @property
    def dofs(self) -> list[int]:
        """Dofs of the class."""
        return self.system.inner.dofs


@dataclass(frozen=True, eq=False)
class Impulses:
    """Impulse responses of a hull.

    Parameters
    ----------
    case : HybridCase
    parts : list of Part
    resolved : float
        Highest frequency whose waves the panels carry, rad/s.
    """

    case: HybridCase
    parts: list[Part]
    resolved: float


def impulses(case: HybridCase, *, progress: bool | None = False) -> Impulses:
    """Return the impulse responses of a hull; progress as for :func:`ogilvie.hybrid_bem`."""
    maps, _ = inner_maps(case.mesh, order=case.order)
    title = "impulses of surge..yaw, by symmetry"
    parts = in_parallel(partial(_part, case), [m for m in maps if m.dofs], progress=progress, title=title)
    return Impulses(case, parts, float(np.sqrt(wavenumber_limit(maps[0].nodes)) / case.time))


def _part(case: HybridCase, inner: InnerMap) -> Part:
    system = joined(case.domains(inner))
    rate = impulse_response(
        system.stiffness,
        system.dampers,
        system.forcing,
        dt=case.step / case.time,
        count=case.count,
        late=short_waves(system),
        outputs=system.inputs,
    ).K
    K = np.einsum("in,tnj->tij", system.motions, rate, optimize=True)
    return Part(system, rate, 0.5 * (K + K.transpose(0, 2, 1)))


def retardation_of(found: Impulses) -> Retardation:
    """Return K and A_inf of impulse responses, the same as of :func:`ogilvie.hybrid_bem` but without its second solution.

    Examples
    --------
    >>> from ogilvie.bem.hybrid_case import hybrid_case
    >>> from ogilvie.mesh.shapes import hemisphere
    >>> K = retardation_of(impulses(hybrid_case("example", hemisphere(1.0), duration=4.0, rho=1.0, g=1.0)))
    >>> round(float(K.K[0, 2, 2] / (2 / 3 * np.pi)), 3)  # of K33(0) = 3/16
    0.188
    """
    case = found.case
    K, A = np.zeros((case.count, 6, 6)), np.zeros((6, 6))
    for part in found.parts:
        i, j = np.ix_(part.dofs, part.dofs)
        A[i, j], K[:, i, j] = part.system.added_mass, part.K
    unit = case.rho * case.mesh.radius**2 * np.outer(case.arm, case.arm)
    return Retardation(case.t, case.g * unit * K, case.mesh.radius * unit * A, source=case.source, notes=case.mesh.notes)
