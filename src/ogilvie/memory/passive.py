"""The default identification: oscillators that share dampers, stable and passive for any data (docs/theory/memory.md)."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.memory.oscillators import state_space
from ogilvie.memory.passive_fit import Fit, Target, grow, optimise
from ogilvie.memory.retardation import Retardation

Array = NDArray[Any]

MOTION_TOLERANCE = 0.0066  # change of the motion under unit forces at which the order is high enough
_LOSS = 0.01  # of inertia and stiffness in the compliance
_STUCK = 3  # oscillators without progress after which a coupling is said to fit no causal model
_ZERO = 1e-3  # of sqrt(spread_ii spread_jj): a coupling below it is zero by symmetry


@dataclass(eq=False)
class _Block:
    """State of the growth of one block; the only mutable thing here."""

    dofs: list[int]
    fit: Fit
    scale: Array
    p: Array
    scores: list[float]
    waived: Array
    motion_limit: float = MOTION_TOLERANCE

    def criteria(self, r2: float) -> tuple[float, float]:
        """Worst coupling and motion, as multiples of what is allowed."""
        lost = 1 - np.fmin(*self.fit.r2(self.p))
        lost = np.where(self.waived, np.nan, lost)
        coupling = float(np.nanmax(lost)) / (1 - r2) if np.any(np.isfinite(lost)) else 0.0
        return coupling, float(self.fit.motion_change(self.p).max()) / self.motion_limit


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
    omega, A, B = radiation_data(K)
    state = [_prepare(K, omega, A, B, dofs, mass, stiffness) for dofs in blocks]
    notes: list[str] = []
    if order is not None:
        for block in state:
            while 2 * block.fit.oscillators(block.p) < order:
                block.p, _ = grow(block.fit, block.p)
    else:
        _grow_until(state, r2, max_order, K.dofs, notes)
    return *polished(state, K), notes


def polished(blocks: list[_Block], K: Retardation) -> tuple[list[tuple[list[int], Array, Array, Array]], Array]:
    """Return the models of the blocks [(dofs, A, B, C)] after a last descent, and A_inf (m, m), in SI."""
    models, A_inf = [], np.array(K.A_inf)
    for block in blocks:
        block.p, _ = optimise(block.fit, block.p, 80)
        n = block.fit.oscillators(block.p)
        a, b, c = state_space(block.p[block.fit.n_inf :], n, len(block.dofs), block.fit.r)
        models.append((block.dofs, a, b * block.scale, c * block.scale[:, None]))
        where = np.ix_(block.dofs, block.dofs)
        A_inf[where] = (block.fit.target.A_inf + block.fit.correction(block.p)) * np.outer(block.scale, block.scale)
    return models, A_inf


def radiation_data(K: Retardation) -> tuple[Array, Array, Array]:
    """Return frequencies, added mass and damping to be fitted: the data that K was made from, or the transform of K itself."""
    if K.omega is not None and K.added_mass is not None and K.radiation_damping is not None:
        mask = np.ones(len(K.omega), dtype=bool) if K.mask is None else K.mask
        return K.omega[mask], _symmetric(K.added_mass[mask]), _symmetric(K.radiation_damping[mask])
    size = np.abs(np.einsum("tii->ti", K.transform(np.linspace(0.0, np.pi / K.dt / 4, 400))))
    alive = np.flatnonzero((size > 0.02 * size.max(axis=0)).any(axis=1))
    omega = np.linspace(0.0, np.pi / K.dt / 4, 400)[: alive[-1] + 2][1:]
    omega = np.linspace(omega[-1] / 80, omega[-1], 80)
    K_hat = K.transform(omega)
    return omega, _symmetric(K.A_inf + K_hat.imag / omega[:, None, None]), _symmetric(K_hat.real)


def _symmetric(x: Array) -> Array:
    """Radiation is reciprocal at zero speed; what differs between ij and ji is error of the panel method."""
    return (x + np.swapaxes(x, -1, -2)) / 2


def _prepare(
    K: Retardation, omega: Array, A: Array, B: Array, dofs: list[int], mass: Array | None, stiffness: Array | None
) -> _Block:
    where = np.ix_(dofs, dofs)
    a, b = A[:, dofs][:, :, dofs], B[:, dofs][:, :, dofs]
    weigh = np.diag(mass[where]) if mass is not None else np.zeros(len(dofs))
    scale = np.sqrt(weigh + np.abs(np.einsum("wii->i", a)) / len(omega))
    square = np.outer(scale, scale)
    a, b = a / square, b / square
    spread = np.maximum(b.std(axis=0), 1e-300)
    weight = (spread > _ZERO * np.sqrt(np.outer(np.diag(spread), np.diag(spread)))).astype(float)
    compliance = None
    if mass is not None and stiffness is not None:
        compliance = _compliance(omega, mass[where] / square + a, b, stiffness[where] / square)
    A_inf = _symmetric(K.A_inf[where]) / square
    fit = Fit(Target(omega, a, b, A_inf, K.A_inf_given, weight, _symmetric(K.K[0][where]) / square, compliance))
    return _Block(dofs, fit, scale, np.zeros(fit.n_inf), [], weight == 0.0)


def _compliance(omega: Array, M: Array, B: Array, C: Array) -> Array:
    """X (n_w, m, m) of the floating body; a loss of 1 % of inertia and stiffness keeps one resonance from ruling the fit."""
    w = omega[:, None, None]
    loss = np.zeros_like(M)
    i = np.arange(len(C))
    loss[:, i, i] = _LOSS * (np.abs(np.diag(C)) + omega[:, None] ** 2 * np.abs(M[:, i, i]))
    return np.linalg.inv(-(w**2) * M + 1j * (w * B + loss) + C)


def _grow_until(blocks: list[_Block], r2: float, max_order: int, names: tuple[str, ...], notes: list[str]) -> None:
    """Let the worst block grow until every block is good enough, stuck, or the order is used up."""
    for block in blocks:
        block.p, _ = grow(block.fit, block.p)
    while sum(2 * b.fit.oscillators(b.p) for b in blocks) < max_order:
        scores = [max(b.criteria(r2)) for b in blocks]
        worst = int(np.argmax(scores))
        if scores[worst] <= 1.0:
            return
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


def _waive(block: _Block, r2: float, names: tuple[str, ...], notes: list[str]) -> None:
    """Stop waiting for the coupling that no longer improves, and say so; for the motion, accept what is reached."""
    coupling, motion = block.criteria(r2)
    if coupling >= motion:
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
            f"motion of {', '.join(names[i] for i in block.dofs)} changes by {block.motion_limit:.2%} under unit forces."
        )


def check_square(name: str, value: Any, m: int) -> Array:
    """Return a finite symmetric (m, m) matrix or raise InputError."""
    matrix = np.asarray(value, dtype=float)
    if matrix.shape != (m, m) or not np.all(np.isfinite(matrix)):
        raise InputError(f"identify: {name} must be a finite ({m}, {m}) matrix about O, shape {matrix.shape} found.")
    if name == "mass" and scipy.linalg.eigvalsh((matrix + matrix.T) / 2).min() <= 0:
        raise InputError("identify: mass must be positive definite (rigid body about O, without added mass).")
    return matrix
