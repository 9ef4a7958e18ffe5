"""Poles of any method as a start of the passive form: every pair becomes an oscillator, all are refitted together."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.passive import Block, grow_until, polished
from ogilvie.memory.passive_fit import Fit
from ogilvie.memory.passive_grow import grow, optimise
from ogilvie.memory.retardation import Retardation

Array = NDArray[Any]

_TRIED = 3  # starts that descend
_SHORT, _EACH = 6, 12  # iterations: of these, of the best of them


def identify_passive_from(
    K: Retardation,
    blocks: list[list[int]],
    poles: list[Array],
    *,
    r2: float,
    order: int | None,
    max_order: int,
    mass: Array | None,
    stiffness: Array | None,
) -> tuple[list[tuple[list[int], Array, Array, Array]], Array, list[str]]:
    """Return passive models of the blocks [(dofs, A, B, C)] that start from given poles, A_inf (m, m) and notes.

    Parameters
    ----------
    poles : list of (n,) array
        Of each block, 1/s. Pairs that the goal does not need are left out; where they do not suffice, oscillators are added
        as in :func:`ogilvie.memory.passive.identify_passive`, whose other parameters are the same.
    """
    state = [Block.of(K, dofs, mass, stiffness) for dofs in blocks]
    notes: list[str] = []
    for block, pool in zip(state, poles, strict=True):
        _use(block, pool, r2, order, max(2, max_order * len(block.dofs) // sum(map(len, blocks))))
    if order is None:
        _fill_up(state, r2, max_order, K.dofs, notes)
    return *polished(state, K, r2, order), notes


def oscillators_of(poles: Array) -> tuple[Array, Array]:
    """Return frequencies w (rad/s) and damping 2 zeta w (1/s) of the oscillators that have these poles.

    A complex pair is one oscillator. Real poles are paired, the slowest two first; one that is left over is doubled.

    Examples
    --------
    >>> oscillators_of(np.array([-0.3 + 0.4j, -0.3 - 0.4j, -1.0, -4.0]))
    (array([0.5, 2. ]), array([0.6, 5. ]))
    """
    up, real = poles[poles.imag > 0], np.sort(-poles[poles.imag == 0].real)
    real = np.append(real, real[-1:]) if len(real) % 2 else real
    w = np.concatenate([np.abs(up), np.sqrt(real[::2] * real[1::2])])
    damping = np.concatenate([-2 * up.real, real[::2] + real[1::2]])
    order = np.argsort(w)
    return w[order], damping[order]


def _use(block: Block, poles: Array, r2: float, order: int | None, share: int) -> None:
    """Add oscillators with these poles, the most helpful first, until the goal or the order is reached or none is left."""
    w, damping = oscillators_of(poles)
    left = np.ones(len(w), dtype=bool)
    while np.any(left) and 2 * block.fit.oscillators(block.p) < (order or share):
        starts = _starts(block.fit, block.p, w, damping, left)[:_TRIED]
        descents = [(*optimise(block.fit, p, _SHORT), k) for p, k in starts]
        block.p, _, used = min(descents, key=lambda d: d[1])
        block.p, _ = optimise(block.fit, block.p, _EACH)
        left[used] = False
        if order is None and max(block.criteria(r2)) <= 1.0:
            return
    while order is not None and 2 * block.fit.oscillators(block.p) < order:
        block.p, _ = grow(block.fit, block.p)


def _fill_up(state: list[Block], r2: float, max_order: int, names: tuple[str, ...], notes: list[str]) -> None:
    """Add oscillators to the blocks that are not good enough yet, as far as the order allows."""
    poor = [b for b in state if max(b.criteria(r2)) > 1.0]
    used = sum(2 * b.fit.oscillators(b.p) for b in state)
    if poor and used + 2 * len(poor) <= max_order:
        good = sum(2 * b.fit.oscillators(b.p) for b in state if b not in poor)
        grow_until(poor, r2, max_order - good, names, notes)
    elif poor:
        low = ", ".join(names[i] for b in poor for i in b.dofs)
        notes.append(f"order limit {max_order} reached before R2 {r2:g} or the motion tolerance in {low}.")


def _starts(fit: Fit, p: Array, w: Array, damping: Array, left: Array) -> list[tuple[Array, int]]:
    """Parameters with one of the oscillators added on one of the dampers, where damping is missing; best first."""
    omega, n, m, r = fit.target.omega, fit.oscillators(p), fit.m, fit.r
    missing = -fit.error(p)[: len(omega)].real
    x, b, D = np.split(p[fit.n_inf :], [n, n + n * m])
    found = []
    for k in np.flatnonzero(left):
        window = np.exp(-((np.log(omega / w[k]) / 0.3) ** 2)) + 1e-12
        strength, direction = np.linalg.eigh(np.einsum("w,wij->ij", window / window.sum(), missing))
        row = np.sqrt(damping[k] * max(strength[-1], 1e-9)) * direction[:, -1]
        for q in range(min(r, n + 1)):
            damper = np.sqrt(damping[k]) * (np.arange(r) == q)
            trial = np.concatenate([p[: fit.n_inf], x, [np.log(w[k])], b, row, D, damper])
            residual = fit.residual(trial)
            found.append((float(residual @ residual), trial, int(k)))
    return [(trial, k) for _, trial, k in sorted(found, key=lambda f: f[0])]
