"""From retardation functions to a state-space model: blocks, scaling, choice of the order."""

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.memory.realization import HankelRealization, hankel_realization
from ogilvie.memory.retardation import Retardation
from ogilvie.memory.statespace import StateSpace, modal_form, stack_blocks

Array = NDArray[Any]

METHODS = ("realization",)
_SAMPLES = 401  # of K in the Hankel matrix
_NEGLIGIBLE = 1e-4  # of sqrt(K_ii K_jj): a coupling below it is zero by symmetry


def identify(
    K: Retardation, *, method: str = "realization", r2: float = 0.99, order: int | None = None, max_order: int = 40
) -> StateSpace:
    """Return a stable state-space model of the fluid memory.

    The couplings are sorted into blocks that do not interact (surge-heave-pitch and sway-roll-yaw for a symmetric hull);
    each block shares one set of poles. The order of a block is raised until every coupling of it reaches `r2`.

    Parameters
    ----------
    K : Retardation
    method : {"realization"}
        Realization theory: singular values of the Hankel matrix, bilinear map, outputs refitted to K with the poles fixed.
    r2 : float
        Coefficient of determination of each entry of K to be reached, 0 < r2 < 1.
    order : int, optional
        Order of every block instead of `r2`.
    max_order : int
        Largest order of a block.

    Returns
    -------
    StateSpace
        In real modal form; `r2` of each entry in it.

    Raises
    ------
    InputError
        Unknown method, r2 outside (0, 1), order < 1, K that is zero.

    Warns
    -----
    OgilvieWarning
        The order `max_order` does not reach `r2`; the couplings and what they reach are named.

    Notes
    -----
    R2 = 1 - sum (K - K_fit)^2 / sum (K - mean K)^2 over the time steps.

    References
    ----------
    Paper A (Yuan 2017), sections III and IV.

    Examples
    --------
    >>> import ogilvie as og
    >>> t = np.linspace(0, 20, 401)
    >>> K = og.Retardation(t, (np.exp(-t / 2) * np.cos(2 * t))[:, None, None], np.ones((1, 1)), ("heave",))
    >>> ssm = og.identify(K, r2=0.999)
    >>> ssm.order, ssm.is_stable, bool(ssm.r2[0, 0] > 0.999)
    (2, True, True)
    """
    if method not in METHODS:
        raise InputError(f"method: one of {METHODS} expected, {method!r} found.")
    if not 0.0 < r2 < 1.0:
        raise InputError(f"r2: a number between 0 and 1 (0.99, say) expected, {r2!r} found.")
    if order is not None and order < 1:
        raise InputError(f"order: a positive number of states expected, {order!r} found.")
    blocks = coupled_blocks(K.K)
    if not blocks:
        raise InputError("identify: K is zero; there is no fluid memory to model.")
    models, notes = [], []
    for block in blocks:
        A, B, C, reached = _identify_block(K, block, r2, order, max_order)
        models.append((block, A, B, C))
        notes += _shortfall(K.dofs, block, reached, r2 if order is None else 0.0, len(A))
    for note in notes:
        warnings.warn(note, OgilvieWarning, stacklevel=2)
    A, B, C = stack_blocks(models, len(K.dofs))
    model = StateSpace(A, B, C, K.dofs, A_inf=K.A_inf, method=method, notes=tuple(notes))
    return StateSpace(A, B, C, K.dofs, r2=r_squared(K.K, model.impulse(K.t)), A_inf=K.A_inf, method=method, notes=tuple(notes))


def coupled_blocks(K: Array) -> list[list[int]]:
    """Return the sets of degrees of freedom that interact: connected components of the couplings that are not zero.

    Examples
    --------
    >>> coupled_blocks(np.eye(2)[None])
    [[0], [1]]
    """
    size = np.abs(K).max(axis=0)
    scale = np.sqrt(np.diag(size))
    linked = size > _NEGLIGIBLE * np.outer(scale, scale)
    blocks: list[list[int]] = []
    left = [i for i in range(len(size)) if size[i, i] > 0]
    while left:
        block, grown = {left[0]}, True
        while grown:
            new = {j for j in left if j not in block and any(linked[i, j] or linked[j, i] for i in block)}
            block |= new
            grown = bool(new)
        blocks.append(sorted(block))
        left = [i for i in left if i not in block]
    return blocks


def r_squared(K: Array, fit: Array) -> Array:
    """Return R2 (m, m) of each entry over the first axis, NaN where K is zero (paper A, Eq. 7)."""
    size = np.abs(K).max(axis=0)
    scale = np.sqrt(np.diag(size))
    total = ((K - K.mean(axis=0)) ** 2).sum(axis=0)
    nothing = size <= _NEGLIGIBLE * np.outer(scale, scale)
    return np.where(nothing, np.nan, 1 - ((K - fit) ** 2).sum(axis=0) / np.where(nothing, 1.0, total))


def _identify_block(
    K: Retardation, block: list[int], r2: float, order: int | None, max_order: int
) -> tuple[Array, Array, Array, Array]:
    part = K.K[:, block][:, :, block]
    scale = np.sqrt(np.abs(np.einsum("tii->ti", part)).max(axis=0))
    scaled = part / np.outer(scale, scale)
    t = np.linspace(0.0, K.duration, min(_SAMPLES, len(K.t)))
    samples = np.stack([np.interp(t, K.t, scaled[:, i, j]) for i in range(len(block)) for j in range(len(block))], axis=1)
    hankel = hankel_realization(samples.reshape(len(t), len(block), len(block)), t[1], max_order=order or max_order)
    best: tuple[float, tuple[Array, Array, Array], Array] | None = None
    for n in [order] if order else range(2, len(hankel.singular_values) + 1):
        model = _refit(hankel, n, K.t, scaled)
        reached = r_squared(scaled, StateSpace(*model, tuple(K.dofs[i] for i in block)).impulse(K.t))
        worst = float(np.nanmin(reached))
        if best is None or worst > best[0]:
            best = (worst, model, reached)
        if worst >= r2:
            break
    assert best is not None
    A, B, C = best[1]
    return A, B * scale, C * scale[:, None], best[2]


def _refit(hankel: HankelRealization, order: int, t: Array, K: Array) -> tuple[Array, Array, Array]:
    """Model of that order in real modal form, its outputs refitted to K(t) by least squares with poles and inputs fixed."""
    A, B, C = modal_form(*hankel.continuous(order))
    m = K.shape[1]
    columns = StateSpace(A, B, np.zeros((m, order)), tuple(map(str, range(m)))).states(t)  # (n_t, n, m)
    regressors = columns.transpose(0, 2, 1).reshape(-1, order)
    targets = K.transpose(0, 2, 1).reshape(-1, m)
    C = np.linalg.lstsq(regressors, targets, rcond=None)[0].T
    return A, B, C


def _shortfall(dofs: tuple[str, ...], block: list[int], reached: Array, r2: float, order: int) -> list[str]:
    low = [
        f"{dofs[i]}-{dofs[j]} {reached[a, b]:.4f}"
        for a, i in enumerate(block)
        for b, j in enumerate(block)
        if reached[a, b] < r2
    ]
    return (
        [f"identify: R2 {r2:g} not reached with order {order}: {', '.join(low)}; raise max_order or check the data."]
        if low
        else []
    )
