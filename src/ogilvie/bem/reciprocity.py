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


def reciprocal(
    inner: InnerMap, control: Array, surface: Array, motions: Array, *, smooth: int, how: Reciprocity = "smoother"
) -> ReciprocalMap:
    """Return the symmetric map.

    Parameters
    ----------
    inner : InnerMap
    control : (n_q, n_control) array
        Functions of the control surface, from smooth to rough.
    surface : (n_f, n_f) array
        Modes of the free surface in columns, from smooth to rough.
    motions : (k, n_hull) array
        Normal velocities of the hull in the dofs of the class. All are values at nodes times sqrt(weight).
    smooth : int
        Modes of the free surface that count as smooth.
    how : {"smoother", "mean"}

    Notes
    -----
    In functions b_i ordered from smooth to rough T_ij = b_i.T T b_j and T_ji are equal for the exact map. The discrete map is
    good for the smooth b_j, and b_i.T only weighs its result; a rough b_i is badly represented, worst at edges. So for i > j

        smoother: T_ij = T_ji := b_i.T T b_j, mean where both are rough      mean: T_ij = T_ji := (b_i.T T b_j + b_j.T T b_i)
        / 2.

    Order: motions of the hull, functions of the control surface, modes of the free surface, all else on the hull. The
    difference of the two is a measure of the error.
    """
    part = inner.nodes.part
    hull, body, free, outer = _completed(motions), part == BODY, part == FREE, part == CONTROL
    k, n_v, n_q, n_f = len(motions), len(hull), len(control), len(surface)
    R = np.zeros((len(part), n_v + n_q + n_f))
    v, q, f = np.r_[:k, k + n_q + n_f : n_v + n_q + n_f], np.arange(k, k + n_q), np.arange(k + n_q, k + n_q + n_f)
    R[np.ix_(body, v)] = hull
    R[np.ix_(outer, q)] = control.T
    R[np.ix_(free, f)] = surface
    T = R.T @ (inner.matrix @ R)
    mean = 0.5 * (T + T.T)
    if how == "smoother":
        edge = k + n_q + smooth
        mean[:, :edge] = np.tril(T)[:, :edge]
        mean = np.tril(mean) + np.tril(mean, -1).T
    T = mean
    pairs = {"ff": (f, f), "qf": (q, f), "qq": (q, q), "vf": (v, f), "vq": (v, q), "vv": (v, v)}
    return ReciprocalMap(hull, **{name: T[np.ix_(a, b)] for name, (a, b) in pairs.items()})


def _completed(motions: Array) -> Array:
    """Return an orthonormal basis (n, n), in columns, whose first columns span the motions."""
    return np.asarray(np.linalg.qr(motions.T, mode="complete")[0])
