"""Waves of one frequency at forward speed: which are met at one frequency of encounter, and results put together again."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.bem_case import Case, entry
from ogilvie.hydro.drift_wave import Wave

Ints = NDArray[np.int64]


def waves_met(case: Case, i: int) -> list[tuple[Ints, Wave]]:
    """Return the waves of one frequency of a case with the places of their directions: together those of one omega_e.

    Notes
    -----
    Overtaken waves are given by their conjugates, see :class:`ogilvie.hydro.drift_wave.Wave`.
    """
    omega, k, water = float(case.omega[i]), float(case.k[i]), (case.depth, case.rho, case.g, case.speed)
    met: dict[tuple[float, bool], list[int]] = {}
    for j, w in enumerate(case.encounter[i]):
        met.setdefault((entry(abs(float(w))), bool(w < 0.0)), []).append(j)
    out = []
    for (_, overtaken), places in met.items():
        b = case.direction[places]
        wave = Wave(-omega, k, b + np.pi, *water) if overtaken else Wave(omega, k, b, *water)
        out.append((np.array(places, dtype=np.int64), wave))
    return out


def placed(places: Sequence[Ints], values: Sequence[NDArray]) -> NDArray:
    """Return values (n_b, ...) of all directions from those of some.

    Examples
    --------
    >>> placed([np.array([2, 0]), np.array([1])], [np.array([5.0, 3.0]), np.array([4.0])]).tolist()
    [3.0, 4.0, 5.0]
    """
    n = sum(map(len, places))
    out = np.zeros((n, *values[0].shape[1:]), dtype=values[0].dtype)
    for place, value in zip(places, values, strict=True):
        out[place] = value
    return out


def placed_pairs(places: Sequence[Ints], values: Sequence[NDArray]) -> NDArray:
    """Return values (n_b, n_b, ...) of all pairs of directions from those of some; zero for pairs of two parts."""
    n = sum(map(len, places))
    out = np.zeros((n, n, *values[0].shape[2:]), dtype=values[0].dtype)
    for place, value in zip(places, values, strict=True):
        out[np.ix_(place, place)] = value
    return out
