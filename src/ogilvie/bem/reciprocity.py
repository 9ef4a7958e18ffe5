"""The inner map in smooth functions of each part, made symmetric by trusting what it makes of the smoother of two functions."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.curved import BODY, CONTROL, FREE
from ogilvie.bem.inner import InnerMap

Array = NDArray[Any]

Reciprocity = Literal["smoother", "mean"]


@dataclass(frozen=True, eq=False)
class ReciprocalMap:
    """Blocks of the symmetric map (f, q, v) -> (e, -phi_control, -phi_hull) in functions of the three parts.

    Parameters
    ----------
    hull : (n_v, n_v) array
        Orthonormal columns, values at the hull's nodes times sqrt(weight); the first span the motions of the class.
    ff, qf, qq, vf, vq, vv : arrays
        ff in the modes of the free surface, q in the functions of the control surface, v in `hull`.
    """

    hull: Array
    ff: Array
    qf: Array
    qq: Array
    vf: Array
    vq: Array
    vv: Array


@dataclass(frozen=True, eq=False)
class FunctionMap:
    """The inner map between functions of the three parts, as the panels give it.

    Parameters
    ----------
    matrix : (n, n) array
        b_i.T T b_j, from smooth to rough: motions of the hull, functions of the control surface, modes of the free surface,
        all else on the hull.
    hull : (n_v, n_v) array
        As in :class:`ReciprocalMap`.
    motions, control, surface : int
        Numbers of the first three kinds.
    """

    matrix: Array
    hull: Array
    motions: int
    control: int
    surface: int


def in_functions(inner: InnerMap, control: Array, surface: Array, motions: Array) -> FunctionMap:
    """Return the inner map in functions.

    Parameters
    ----------
    inner : InnerMap
    control : (n_q, n_control) array
        Functions of the control surface, from smooth to rough.
    surface : (n_f, n_f) array
        Modes of the free surface in columns, from smooth to rough.
    motions : (k, n_hull) array
        Normal velocities of the hull in the dofs of the class. All are values at nodes times sqrt(weight).
    """
    part, k = inner.nodes.part, len(motions)
    hull = np.linalg.qr(motions.T, mode="complete")[0]  # the first columns span the motions
    kinds = ((BODY, hull[:, :k]), (CONTROL, control.T), (FREE, surface), (BODY, hull[:, k:]))
    places, right = [np.flatnonzero(part == p) for p, _ in kinds], []
    for (_, functions), at in zip(kinds, places, strict=True):
        right.append(inner.matrix[:, at] @ functions)
    X = np.concatenate(right, axis=1)
    rows = [functions.T @ X[at] for (_, functions), at in zip(kinds, places, strict=True)]
    return FunctionMap(np.concatenate(rows), hull, k, len(control), len(surface))


def reciprocal(given: FunctionMap, *, smooth: int, how: Reciprocity = "smoother") -> ReciprocalMap:
    """Return the symmetric map.

    Parameters
    ----------
    given : FunctionMap
    smooth : int
        Modes of the free surface that count as smooth.
    how : {"smoother", "mean"}

    Notes
    -----
    T_ij = b_i.T T b_j and T_ji are equal for the exact map. The discrete map is good for a smooth b_j, b_i.T only weighs its
    result; a rough b_i is badly represented, worst at edges. So for i > j

        smoother: T_ij = T_ji := b_i.T T b_j, or the mean where both are rough,
        mean:     T_ij = T_ji := (b_i.T T b_j + b_j.T T b_i) / 2.

    The difference of the two is a measure of the error.
    """
    k, n_q, n_f, n = given.motions, given.control, given.surface, len(given.matrix)
    T = 0.5 * (given.matrix + given.matrix.T)
    if how == "smoother":
        edge = k + n_q + smooth
        T[:, :edge] = given.matrix[:, :edge]
        T = np.tril(T) + np.tril(T, -1).T
    v, q, f = np.r_[:k, k + n_q + n_f : n], np.arange(k, k + n_q), np.arange(k + n_q, k + n_q + n_f)
    pairs = {"ff": (f, f), "qf": (q, f), "qq": (q, q), "vf": (v, f), "vq": (v, q), "vv": (v, v)}
    return ReciprocalMap(given.hull, **{name: T[np.ix_(a, b)] for name, (a, b) in pairs.items()})
