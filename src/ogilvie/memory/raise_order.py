"""The order of a model is raised until every coupling is good enough, or until that no longer helps."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.memory.targets import FitTarget, Trial

Array = NDArray[Any]

_PROGRESS = 0.95  # of the shortfall: anything above is no progress


def raise_order(
    target: FitTarget, trials: Iterable[Trial], goal: ArrayLike, *, patience: int | None = None
) -> tuple[Trial, Array]:
    """Return the first trial whose couplings all reach the goal, otherwise the best one, and the R2 (m, m) that it reaches.

    Parameters
    ----------
    target : FitTarget
    trials : iterable of Trial
        In ascending order; made when asked for.
    goal : float or (m, m) array
        R2 to be reached.
    patience : int, optional
        Trials without progress after which to stop. Progress is a shortfall, summed over the couplings, 5 % below the best.

    Examples
    --------
    >>> from ogilvie.memory.targets import Impulse
    >>> t = np.linspace(0.0, 20.0, 201)
    >>> target = Impulse(t, np.exp(-t)[:, None, None], 3.0, np.zeros((1, 1)), np.ones(1))
    >>> rates = [np.array([[-2.0]]), np.array([[-1.0]]), np.array([[-0.5]])]
    >>> trial, r2 = raise_order(target, (target.outputs(A, np.ones((1, 1))) for A in rates), 0.999)
    >>> trial.A
    array([[-1.]])
    """
    best: tuple[Trial, Array] | None = None
    least, idle = np.inf, 0
    for trial in trials:
        reached = target.r2(trial)
        short = float(np.nansum(np.clip(goal - reached, 0.0, 1.0)))
        idle += 1
        if best is None or short < _PROGRESS * least:
            best, least, idle = (trial, reached), short, 0
        if least == 0.0 or idle == patience:
            break
    assert best is not None
    return best


def shortfall(dofs: tuple[str, ...], block: list[int], reached: Array, r2: float, order: int) -> list[str]:
    """Return a note that names the couplings of a block below `r2` and what they reach, or nothing.

    Examples
    --------
    >>> shortfall(("heave", "pitch"), [0, 1], np.array([[1.0, 0.9], [0.9, 1.0]]), 0.99, 6)
    ['R2 0.99 not reached with order 6: heave-pitch 0.9000, pitch-heave 0.9000; raise max_order or check the data.']
    """
    low = [
        f"{dofs[i]}-{dofs[j]} {reached[a, b]:.4f}"
        for a, i in enumerate(block)
        for b, j in enumerate(block)
        if reached[a, b] < r2
    ]
    return [f"R2 {r2:g} not reached with order {order}: {', '.join(low)}; raise max_order or check the data."] if low else []
