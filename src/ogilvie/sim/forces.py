"""The force of each load, evaluated from the recorded motion."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.sim.dynamics import FAST
from ogilvie.sim.seaway import Seaway
from ogilvie.sim.system import TURNING, LinearSystem

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class LoadForce:
    """What turns recorded rows (eta, nu, acceleration, memory force) into the force of one load.

    Parameters
    ----------
    name : str
    matrix : (6, 24) array
        Force = matrix row + constant + wave force.
    span : (int, int)
        Columns of the matrix that are not zero.
    constant : (6,) array
    column : int
        Where the six columns of its wave force begin in the table of wave series; -1 without.
    """

    name: str
    matrix: Array
    span: tuple[int, int]
    constant: Array
    column: int

    def fill(self, rows: Array, wave: Array, first: int, step: int, out: Array, *, t: Array, realisation: int) -> None:
        """Write the forces (n, 6) at the recorded rows (n, 24); row i belongs to row first + i step of `wave`."""
        _fill(rows, self.matrix, self.span[0], self.span[1], self.constant, wave, first, step, self.column, out)


def load_forces(system: LinearSystem, seaway: Seaway | None) -> Sequence[LoadForce]:
    """Return what evaluates the force of each load of a system."""
    columns = {} if seaway is None else seaway.columns()
    forces = []
    for name, term in zip(system.names, system.terms, strict=True):
        damping = term.damping + system.speed * TURNING.T @ term.added_mass
        parts = [term.stiffness, damping, term.added_mass, np.eye(6) * (term.memory is not None)]
        matrix = -np.concatenate(parts, axis=1)
        used = np.flatnonzero(matrix.any(axis=0))
        span = (int(used[0]), int(used[-1]) + 1) if len(used) else (0, 0)
        forces.append(LoadForce(name, matrix, span, np.array(term.constant, dtype=float), columns.get(name, -1)))
    return tuple(forces)


@njit(cache=True, nogil=True, fastmath=FAST)
def _fill(rows, matrix, begin, end, constant, wave, first, step, column, out):
    for i in range(rows.shape[0]):
        f0, f1, f2, f3, f4, f5 = constant[0], constant[1], constant[2], constant[3], constant[4], constant[5]
        for k in range(begin, end):
            x = rows[i, k]
            f0 += matrix[0, k] * x
            f1 += matrix[1, k] * x
            f2 += matrix[2, k] * x
            f3 += matrix[3, k] * x
            f4 += matrix[4, k] * x
            f5 += matrix[5, k] * x
        out[i, 0], out[i, 1], out[i, 2], out[i, 3], out[i, 4], out[i, 5] = f0, f1, f2, f3, f4, f5
        if column >= 0:
            for p in range(6):
                out[i, p] += wave[first + i * step, column + p]
