"""The default identification: oscillators that share dampers, stable and passive for any data (docs/theory/memory.md)."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.memory.oscillators import state_space
from ogilvie.memory.passive_fit import Fit
from ogilvie.memory.passive_grow import QUICK, grow, optimise
from ogilvie.memory.passive_target import target_of
from ogilvie.memory.retardation import Retardation

Array = NDArray[Any]

MOTION_TOLERANCE = 0.0066  # change of the motion under unit forces at which the order is high enough
_MEMORY_WEIGHT = 0.5  # of K(t) where its tail is known and added mass and damping have a goal
_MEMORY_WEIGHT_ALONE = 20.0  # of K(t) where its tail is known and the order is given, so that nothing else has
RESONANCE_TOLERANCE = 0.1  # relative error of the damping at a resonance at which it is so
_HALVINGS = 4  # times that the weight of the resonances may be halved for the sake of the rest
_STUCK = 3  # oscillators without progress after which a coupling is said to fit no causal model


@dataclass(eq=False)
class Block:
    """State of the growth of one block; the only mutable thing here."""

    dofs: list[int]
    fit: Fit
    scale: Array
    p: Array
    scores: list[float]
    waived: Array
    motion_limit: float = MOTION_TOLERANCE
    resonance_limit: float = RESONANCE_TOLERANCE

    @classmethod
    def of(cls, K: Retardation, dofs: list[int], mass: Array | None, stiffness: Array | None) -> "Block":
        """Return the block of these degrees of freedom without oscillators."""
        target, scale = target_of(K, dofs, mass, stiffness)
        fit = Fit(target)
        return cls(dofs, fit, scale, np.zeros(fit.n_inf), [], target.weight == 0.0)

    def criteria(self, r2: float) -> tuple[float, float, float]:
        """Worst coupling, motion and resonance, as multiples of what is allowed."""
        lost = 1 - np.fmin(*self.fit.r2(self.p))
        lost = np.where(self.waived, np.nan, lost)
        coupling = float(np.nanmax(lost)) / (1 - r2) if np.any(np.isfinite(lost)) else 0.0
        motion = float(self.fit.motion_change(self.p).max()) / self.motion_limit
        return coupling, motion, self.fit.resonance_error(self.p) / self.resonance_limit


def identify_passive(
    K: Retardation,
    blocks: list[list[int]],
    *,
    r2: float,
    order: int | None,
    max_order: int,
    mass: Array | None,
    stiffness: Array | None,
) -> tuple[list[tuple[list[int], Array, Array, Array]], Array, list[str]]:
    """Return the models of the blocks [(dofs, A, B, C)], A_inf (m, m) and notes.

    Parameters
    ----------
    K : Retardation
    blocks : list of lists of int
        Coupled degrees of freedom.
    r2 : float
        To be reached by A and B of every coupling.
    order : int, optional
        States of every block, instead of `r2`.
    max_order : int
        States of all blocks together at most.
    mass, stiffness : (m, m) array, optional
        Of the vessel; the fit then weighs the change of its motion.
    """
    state = [Block.of(K, dofs, mass, stiffness) for dofs in blocks]
    notes: list[str] = []
    if order is not None:
        for block in state:
            while 2 * block.fit.oscillators(block.p) < order:
                block.p, _ = grow(block.fit, block.p, rounds=QUICK)
    else:
        grow_until(state, r2, max_order, K.dofs, notes)
    return *polished(state, K, r2, order), notes


def polished(
    blocks: list[Block], K: Retardation, r2: float, order: int | None
) -> tuple[list[tuple[list[int], Array, Array, Array]], Array]:
    """Return the models of the blocks [(dofs, A, B, C)] after a last descent, and A_inf (m, m), in SI.

    Where the order is given, and added mass and damping have no goal, K(t) now has the largest weight.
    """
    models, A_inf = [], np.array(K.A_inf)
    for block in blocks:
        _aim(block, r2)
        if order is not None:
            block.fit.weigh_memory(_MEMORY_WEIGHT_ALONE)
        block.p, _ = optimise(block.fit, block.p, 80)
        n = block.fit.oscillators(block.p)
        a, b, c = state_space(block.p[block.fit.n_inf :], n, len(block.dofs), block.fit.r)
        models.append((block.dofs, a, b * block.scale, c * block.scale[:, None]))
        where = np.ix_(block.dofs, block.dofs)
        A_inf[where] = (block.fit.target.A_inf + block.fit.correction(block.p)) * np.outer(block.scale, block.scale)
    return models, A_inf


def grow_until(blocks: list[Block], r2: float, max_order: int, names: tuple[str, ...], notes: list[str]) -> None:
    """Let the worst block grow until every block is good enough, stuck, or the order is used up."""
    for block in blocks:
        block.fit.weigh_memory(_MEMORY_WEIGHT)
        block.p, _ = grow(block.fit, block.p)
    while sum(2 * b.fit.oscillators(b.p) for b in blocks) < max_order:
        scores = [max(b.criteria(r2)) for b in blocks]
        worst = int(np.argmax(scores))
        if scores[worst] <= 1.0:
            if not any([_aim(block, r2) for block in blocks]):
                return
            continue
        block = blocks[worst]
        block.scores.append(scores[worst])
        if len(block.scores) > _STUCK and scores[worst] > 0.8 * block.scores[-1 - _STUCK]:
            _waive(block, r2, names, notes)
            block.scores.clear()
            continue
        block.p, _ = grow(block.fit, block.p)
    low = [names[i] for b in blocks for i in b.dofs if max(b.criteria(r2)) > 1.0]
    if low:
        notes.append(f"order limit {max_order} reached before R2 {r2:g} or the motion tolerance in {', '.join(low)}.")


def _aim(block: Block, r2: float) -> bool:
    """Let the block aim at the resonances too, as far as the rest stays as good as it must; return whether that is new."""
    allowed, start = max(1.0, 1.05 * max(block.criteria(r2))), block.p
    if not block.fit.aim_at_resonances():
        return False
    block.scores.clear()
    for _ in range(_HALVINGS):
        block.p, _ = optimise(block.fit, start, 80)
        if max(block.criteria(r2)[:2]) <= allowed:
            break
        block.fit.resonance_weight /= 2
    return True


def _waive(block: Block, r2: float, names: tuple[str, ...], notes: list[str]) -> None:
    """Stop waiting for the coupling that no longer improves, and say so; for the motion, accept what is reached."""
    coupling, motion, resonance = block.criteria(r2)
    if resonance >= max(coupling, motion):
        block.resonance_limit *= resonance
        notes.append(f"damping at a resonance of {', '.join(names[i] for i in block.dofs)} is {block.resonance_limit:.1%} off.")
    elif coupling >= motion:
        reached = np.where(block.waived, np.inf, np.fmin(*block.fit.r2(block.p)))
        i, j = np.unravel_index(int(np.nanargmin(reached)), reached.shape)
        block.waived[i, j] = block.waived[j, i] = True
        notes.append(
            f"{names[block.dofs[i]]}-{names[block.dofs[j]]}: R2 stays at {reached[i, j]:.3f} and further states "
            f"do not help; check(hydro) tells whether its added mass and damping contradict each other."
        )
        block.fit.target.weight[i, j] = block.fit.target.weight[j, i] = 0.2
        block.fit.reweigh()
    else:
        block.motion_limit *= motion
        notes.append(
            f"motion of {', '.join(names[i] for i in block.dofs)}: the aim of {MOTION_TOLERANCE:.2%} under unit forces is not "
            "quite reached and further states do not help."
        )


def check_square(name: str, value: Any, m: int) -> Array:
    """Return a finite symmetric (m, m) matrix or raise InputError."""
    matrix = np.asarray(value, dtype=float)
    if matrix.shape != (m, m) or not np.all(np.isfinite(matrix)):
        raise InputError(f"identify: {name} must be a finite ({m}, {m}) matrix about O, shape {matrix.shape} found.")
    if name == "mass" and scipy.linalg.eigvalsh((matrix + matrix.T) / 2).min() <= 0:
        raise InputError("identify: mass must be positive definite (rigid body about O, without added mass).")
    return matrix
