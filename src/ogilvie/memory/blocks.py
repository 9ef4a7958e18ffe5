"""Which degrees of freedom interact, and how well a fit describes each of their couplings."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

_NEGLIGIBLE = 1e-4  # of sqrt(x_ii x_jj): a coupling below it is zero by symmetry


def coupled_blocks(K: Array) -> list[list[int]]:
    """Return the sets of degrees of freedom that interact: connected components of the couplings that are not zero.

    Parameters
    ----------
    K : (n, m, m) array

    Examples
    --------
    >>> coupled_blocks(np.eye(2)[None])
    [[0], [1]]
    """
    linked = ~negligible(K)
    blocks: list[list[int]] = []
    left = [i for i in range(K.shape[1]) if np.any(K[:, i, i])]
    while left:
        block, grown = {left[0]}, True
        while grown:
            new = {j for j in left if j not in block and any(linked[i, j] or linked[j, i] for i in block)}
            block |= new
            grown = bool(new)
        blocks.append(sorted(block))
        left = [i for i in left if i not in block]
    return blocks


def negligible(K: Array) -> Array:
    """Return the mask (m, m) of the couplings of K (n, m, m) that are zero by symmetry, rounding aside."""
    size = np.abs(K).max(axis=0)
    scale = np.sqrt(np.diag(size))
    return size <= _NEGLIGIBLE * np.outer(scale, scale)


def r_squared(x: Array, fit: Array, *, size: Array | None = None) -> Array:
    """Return R2 (m, m) of each entry over the first axis (paper A, Eq. 7).

    NaN where `size`, by default x itself, is zero by symmetry.
    """
    nothing = negligible(x if size is None else size)
    total = ((x - x.mean(axis=0)) ** 2).sum(axis=0)
    nothing |= total == 0.0
    return np.where(nothing, np.nan, 1 - ((x - fit) ** 2).sum(axis=0) / np.where(nothing, 1.0, total))
