"""What may be wrong with K(t): how much it changes when something that the data do not tell is assumed otherwise."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.curves import RadiationCurves, cosine_integrals
from ogilvie.memory.from_damping import kernel_from_damping
from ogilvie.memory.tail import Tail, fit_tail

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Doubts:
    """Changes of K(t) from the damping, with the sign of one of them.

    Parameters
    ----------
    tails : tuple of (n_t, m, m) arrays
        With other tails: fitted to a shorter piece, fitted with another correction, or omega^-2 where that makes no difference.
    interpolation : (n_t, m, m) array
        With the other interpolation between frequencies.
    later : (m, m) array
        Largest |K| after the last time.
    """

    tails: tuple[Array, ...]
    interpolation: Array
    later: Array

    @property
    def tail(self) -> Array:
        """Largest change by another tail (m, m)."""
        return np.max([np.abs(change).max(axis=0) for change in self.tails], axis=0)


def doubts_of(curves: RadiationCurves, K: Array, t: Array, interpolation: str, horizon: float) -> Doubts:
    """Return what the damping leaves open in K(t).

    Parameters
    ----------
    curves : RadiationCurves
    K : (n_t, m, m) array
        From the damping.
    t : (n_t,) array
    interpolation : {"spline", "linear"}
    horizon : float
        Time up to which the spacing of the frequencies determines K, s.
    """
    later = np.linspace(t[-1], max(min(2 * t[-1], horizon), 1.05 * t[-1]), 200)
    return Doubts(
        _other_tails(curves, t),
        kernel_from_damping(curves, None, t, other_interpolation(interpolation)) - K,
        np.abs(kernel_from_damping(curves, None, later, interpolation)).max(axis=0),
    )


def other_interpolation(interpolation: str) -> str:
    """Return "linear" for "spline" and the reverse."""
    return "linear" if interpolation == "spline" else "spline"


def _other_tails(curves: RadiationCurves, t: Array) -> tuple[Array, Array]:
    """Changes of K(t) (n_t, m, m) by the two other tails of each coupling; only early times tell them apart."""
    omega, early = curves.omega, t[: len(t) // 4 + 2]
    others = [[_others(omega, curves.B[:, i, j], tail) for j, tail in enumerate(row)] for i, row in enumerate(curves.tails)]
    base = cosine_integrals(curves.tails, omega[-1], early)
    changes = np.zeros((2, len(t), *curves.B.shape[1:]))
    for k, change in enumerate(changes):
        tails = [[pair[k] for pair in row] for row in others]
        exists = np.array([[tail is not None for tail in row] for row in tails])
        change[: len(early)] = 2 / np.pi * np.where(exists, cosine_integrals(tails, omega[-1], early) - base, 0.0)
    return changes[0], changes[1]


def _others(omega: Array, b: Array, tail: Tail | None) -> tuple[Tail | None, Tail | None]:
    """Two other tails; omega^-2 where another correction gives none or, at the bounds of the exponent, the same."""
    short, corrected = fit_tail(omega, b, "fit", share=0.3), fit_tail(omega, b, "fit", power=3)
    return short, fit_tail(omega, b, "omega-2") if corrected in (None, tail) else corrected
