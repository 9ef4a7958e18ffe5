"""Added mass and damping as functions of frequency, continued beyond the data: what every way to K(t) starts from."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.tail import Tail, fit_tail, tail_integrals

Array = NDArray[Any]
Tails = list[list[Tail | None]]


@dataclass(frozen=True, eq=False)
class RadiationCurves:
    """Radiation data at the frequencies in use.

    Parameters
    ----------
    omega : (n_w,) array
        rad/s, ascending.
    A, B : (n_w, m, m) array
        Added mass and damping, SI.
    tails : (m, m) list of lists of Tail or None
        Damping beyond the last frequency.
    """

    omega: Array
    A: Array
    B: Array
    tails: Tails

    @property
    def omega_from_zero(self) -> Array:
        """Frequencies with zero in front."""
        return np.concatenate([[0.0], self.omega])

    def from_zero(self, f: Array) -> Array:
        """Return f (n_w, m, m) with its value at zero frequency, 0, in front."""
        return np.concatenate([np.zeros((1, *f.shape[1:])), f])

    def energetic_step(self) -> float:
        """Median spacing of the frequencies that carry the damping, rad/s."""
        diagonal = np.abs(np.einsum("wii->wi", self.B))
        peak = diagonal.max(axis=0)
        level = (diagonal[:, peak > 0] / peak[peak > 0]).max(axis=1)
        return float(np.median(np.diff(self.omega_from_zero)[level > 0.05]))


def cosine_integrals(tails: Tails, omega_N: float, t: Array) -> Array:
    """Return int_{omega_N}^{inf} B cos(omega t) d omega of each tail, shape (n_t, m, m); zero where there is none."""
    out = np.zeros((len(t), len(tails), len(tails)))
    found = [(i, j, tail) for i, row in enumerate(tails) for j, tail in enumerate(row) if tail is not None]
    if found:
        rows, columns, present = zip(*found, strict=True)
        out[:, rows, columns] = tail_integrals(present, omega_N, t).real
    return out


def continued(omega: Array, A: Array, B: Array, dofs: tuple[str, ...], kind: str) -> tuple[RadiationCurves, list[str]]:
    """Return the curves with a tail for each coupling, and what the user should know about the tails.

    Parameters
    ----------
    omega, A, B : arrays
        As in :class:`RadiationCurves`.
    dofs : tuple of str
    kind : {"fit", "omega-2", "omega-3", "none"}
        See :func:`ogilvie.memory.tail.fit_tail`. Where none can be fitted though damping is left, omega^-3 is used and said.
    """
    peak = np.abs(B).max(axis=0)
    tails: Tails = []
    forced = []
    for i in range(B.shape[1]):
        row: list[Tail | None] = []
        for j in range(B.shape[2]):
            found = fit_tail(omega, B[:, i, j], kind)
            if found is None and kind == "fit" and abs(B[-1, i, j]) > 0.01 * peak[i, j] > 0:
                found = fit_tail(omega, B[:, i, j], "omega-3")
                forced.append(f"{dofs[i]}-{dofs[j]}")
            row.append(found)
        tails.append(row)
    notes = [f"damping has no clean tail to fit, omega^-3 assumed: {', '.join(forced)}."] if forced else []
    return RadiationCurves(omega, A, B, tails), notes
