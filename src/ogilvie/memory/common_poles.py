"""Models of a block whose couplings share n poles: residues by least squares, condensed by balanced truncation."""

from collections.abc import Callable
from dataclasses import replace
from itertools import chain
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.memory.raise_order import raise_order
from ogilvie.memory.reduce import balance
from ogilvie.memory.targets import FitTarget, Trial

Array = NDArray[Any]

MOST_POLES = 20  # common poles of a block; more only describe the errors of the data
LEAST_DAMPING = 0.01  # of critical: a sharper resonance would hide between the frequencies and ring for ever
_PATIENCE = 4


def stable(poles: Array) -> Array:
    """Return poles mirrored into the left half plane, with a damping ratio of one per cent at least.

    Examples
    --------
    >>> stable(np.array([1.0 + 2.0j, 1.0 - 2.0j, 3.0]))
    array([-1.+2.j, -1.-2.j, -3.+0.j])
    """
    poles = np.asarray(poles, dtype=complex)
    return -np.maximum(np.abs(poles.real), LEAST_DAMPING * np.abs(poles)) + 1j * poles.imag


def one_each(poles: Array) -> Array:
    """Return one pole of each complex pair, the one with positive imaginary part, and the real poles.

    Examples
    --------
    >>> one_each(np.array([-1.0 - 2.0j, -3.0, -1.0 + 2.0j]))
    array([-3.+0.j, -1.+2.j])
    """
    return poles[poles.imag >= 0.0]


def modal(poles: Array) -> tuple[Array, Array]:
    """Return A (n, n) of 2x2 and 1x1 blocks with these poles, and the input column (n,) that drives each of them.

    Examples
    --------
    >>> A, b = modal(np.array([-1.0 + 2.0j, -1.0 - 2.0j, -3.0]))
    >>> A, b
    (array([[-1.,  2.,  0.],
           [-2., -1.,  0.],
           [ 0.,  0., -3.]]), array([1., 0., 1.]))
    """
    blocks = [np.array([[p.real, p.imag], [-p.imag, p.real]]) if p.imag > 0 else np.array([[p.real]]) for p in one_each(poles)]
    drive = np.concatenate([[1.0, 0.0] if p.imag > 0 else [1.0] for p in one_each(poles)])
    return scipy.linalg.block_diag(*blocks), drive


def compressed(rows: Array, own: int) -> Array:
    """Return the rows (n_c * k, n - own) left for the unknowns that all couplings share, each coupling's own eliminated.

    Parameters
    ----------
    rows : (n_c, n_rows, n) array
        Equations of each coupling; their first `own` columns belong to unknowns of that coupling alone.
    own : int
    """
    R = np.asarray(np.linalg.qr(rows, mode="r"))
    return R[:, own:, own:].reshape(-1, rows.shape[2] - own)


def fit_common_poles(
    target: FitTarget, find_poles: Callable[[Any, int], Array], *, r2: float, order: int | None, limit: int
) -> tuple[Trial, Array]:
    """Return the model with the fewest common poles that reaches `r2`, or with `order` poles, and what it reaches (m, m).

    The residues have full rank: m states for each pole. Where that is more than `order` or `limit`, the model is truncated.

    Parameters
    ----------
    target : FitTarget
    find_poles : callable
        (target, n) -> n stable poles.
    r2 : float
    order : int, optional
    limit : int
        Largest number of states.

    Raises
    ------
    InputError
        Data that do not determine two poles.
    """
    least, most = min(2, target.least_order), min(MOST_POLES, target.most_poles)
    if most < 2:
        raise InputError("identify: too few samples of K, or frequencies, to determine two poles; use a longer table.")
    sizes = [min(max(order, least), most)] if order else range(2, max(2, min(limit, most)) + 1, 2)

    def trial(n: int) -> Trial:
        poles = find_poles(target, n)
        A, b = modal(poles)
        one = np.eye(target.size)
        full = target.outputs(np.kron(one, A), np.kron(one, b[:, None]))
        return replace(truncated(target, full, max(order or limit, target.least_order)), common_poles=poles)

    return raise_order(target, map(trial, sizes), r2, patience=_PATIENCE)


def truncated(target: FitTarget, trial: Trial, order: int) -> Trial:
    """Return the model with that many states at most: balanced truncation, the outputs refitted."""
    if len(trial.A) <= order:
        return trial
    A, B, _ = balance(trial.A, trial.B, trial.C).truncated(order)
    return target.outputs(A, B, trial.A_inf)


def condense(target: FitTarget, trial: Trial, reached: Array, r2: float) -> tuple[Trial, Array]:
    """Return a model with as few states as `r2`, or what was reached before if that is less, allows; and what it reaches."""
    if len(trial.A) == len(trial.poles):
        return trial, reached
    balanced = balance(trial.A, trial.B, trial.C)
    sizes = range(max(target.least_order, len(trial.poles)), len(balanced.singular_values))
    trials = (target.outputs(*balanced.truncated(k)[:2], trial.A_inf) for k in sizes)
    return raise_order(target, chain(trials, [trial]), np.fmin(r2, reached - 1e-9))
