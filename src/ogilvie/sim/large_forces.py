"""The force of each load in large motions, evaluated from the recorded motion."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.loads.base import Terms
from ogilvie.loads.kernel import ETA, NU, SITUATION
from ogilvie.sim.dynamics import FAST
from ogilvie.sim.large import LargeMotions, steady_frame
from ogilvie.sim.large_kernel import LARGE_COLUMNS, add_reference_forces, situate
from ogilvie.sim.seaway import Seaway
from ogilvie.sim.system import LinearSystem

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class LargeLoadForce:
    """What turns recorded rows into the force of one load.

    Parameters
    ----------
    name : str
    term : Terms
    scheme : LargeMotions
    column : int
        Where the six columns of its wave force begin in the table of wave series; -1 without.
    kernels : tuple of int
        Its compiled forces among those of the scheme.
    held : int
        Its place among the control laws; -1 without.
    """

    name: str
    term: Terms
    scheme: LargeMotions
    column: int
    kernels: tuple[int, ...]
    held: int

    def fill(self, rows: Array, wave: Array, first: int, step: int, out: Array, *, t: Array, realisation: int) -> None:
        """Write the forces (n, 6) at the recorded rows (n, columns); row i belongs to row first + i step of `wave`."""
        out[:] = 0.0
        term, n = self.term, len(rows)
        table = np.zeros((n, 6))
        if self.column >= 0:
            table[:] = wave[first : first + n * step : step, self.column : self.column + 6][:n]
        own = self.scheme.frame
        frame = steady_frame(own[0], own[1], own[2:5], term.constant, own[13:])
        if term.stiffness.any() or term.constant.any() or self.column >= 0 or term.damping.any():
            _reference(frame, np.ascontiguousarray(term.stiffness.T), term.damping, table, rows, t, out)
        out -= rows[:, 12:18] @ term.added_mass.T
        if term.memory is not None or term.added_mass.any():
            out += rows[:, 18:24]
        for which in self.kernels:
            out += self.scheme.kernel_forces(which, realisation, t, rows[:, :6], rows[:, 6:12], rows[:, 24:28])
        if self.held >= 0:
            begin = LARGE_COLUMNS + 6 * self.held
            out += rows[:, begin : begin + 6]


def large_load_forces(system: LinearSystem, seaway: Seaway | None, scheme: LargeMotions) -> Sequence[LargeLoadForce]:
    """Return what evaluates the force of each load."""
    columns = {} if seaway is None else seaway.columns()
    laws = {name: k for k, name in enumerate(scheme.laws.names)}
    return tuple(
        LargeLoadForce(
            name,
            term,
            scheme,
            columns.get(name, -1),
            tuple(k for k, owner in enumerate(scheme.forces.names) if owner == name),
            laws.get(name, -1),
        )
        for name, term in zip(system.names, system.terms, strict=True)
        if not term.current.any()  # water that flows is no force of its own
    )


@njit(cache=True, nogil=True, fastmath=FAST)
def _reference(frame, C, D, table, rows, t, out):
    x, trig, work = np.zeros(SITUATION), np.empty(4), np.empty(12)
    for i in range(len(rows)):
        x[ETA:NU] = rows[i, :6]
        x[NU : NU + 6] = rows[i, 6:12]
        situate(t[i], frame[2:5], x, trig)
        add_reference_forces(t[i], frame, C, table, i, x, trig, work, out[i])
        for p in range(6):
            for q in range(6):
                delta = x[NU + 6 + q] - (frame[0] if q == 0 else 0.0)
                out[i, p] -= D[p, q] * delta
