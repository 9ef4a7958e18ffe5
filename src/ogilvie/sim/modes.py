"""A fluid-memory model in real modal form: what its independent blocks of states make cheap."""

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import MemoryModel
from ogilvie.memory.statespace import modal_form

Array = NDArray[Any]
_PORT_STARBOARD = ((0, 2, 4), (1, 3, 5))  # degrees of freedom that a hull with equal sides does not couple


def modal_memory(model: MemoryModel) -> MemoryModel:
    """Return the same model with A in 1 x 1 and 2 x 2 blocks, or unchanged where it is so already or would lose digits.

    Examples
    --------
    >>> A = np.array([[0.0, 1.0, 0.0], [-4.0, -1.0, 1.0], [-1.0, 0.0, -3.0]])
    >>> modal = modal_memory(MemoryModel(A, np.ones((3, 6)), np.ones((6, 3))))
    >>> int(np.count_nonzero(modal.A))
    5
    """
    A, B, C = model.A, model.B, model.C
    if all(j - i <= 2 for i, j in independent(A)):
        return model
    try:
        modal = modal_form(A, B, C)
    except InputError:
        return model
    omega = np.abs(np.linalg.eigvals(A))  # where the transfer function has its features
    given, changed = (c @ resolvent(a, omega, b) for a, b, c in ((A, B, C), modal))
    return MemoryModel(*modal) if np.abs(given - changed).max() < 1e-9 * np.abs(given).max() else model


def independent(A: Array) -> list[tuple[int, int]]:
    """Return the ranges [i, j) of neighbouring states that do not interact with any others.

    Examples
    --------
    >>> independent(np.array([[1.0, 2.0, 0.0], [-2.0, 1.0, 0.0], [0.0, 0.0, 3.0]]))
    [(0, 2), (2, 3)]
    """
    n = len(A)
    cuts = [k for k in range(1, n) if not (A[:k, k:].any() or A[k:, :k].any())]
    return list(pairwise([0, *cuts, n])) if n else []


def resolvent(A: Array, omega: Array, right: Array) -> Array:
    """Return (i omega - A)^-1 right (n_w, n, m) for right (n, m) or (n_w, n, m)."""
    n = len(A)
    right = np.broadcast_to(right, (len(omega), *right.shape[-2:]))
    out = np.empty(right.shape, dtype=complex)
    for i, j in independent(A):
        matrix = 1j * omega[:, None, None] * np.eye(j - i) - A[i:j, i:j]
        out[:, i:j] = np.linalg.solve(matrix, right[:, i:j])
    return out if n else np.zeros(right.shape, dtype=complex)


def sides(model: MemoryModel) -> list[tuple[NDArray[np.intp], tuple[int, ...]]]:
    """Return groups of states with the degrees of freedom that they act on and that drive them.

    Notes
    -----
    For a hull with equal sides these are two: surge-heave-pitch and sway-roll-yaw. Otherwise all states make one group.
    """
    groups: list[list[int]] = [[], []]
    for i, j in independent(model.A):
        used = (model.B[i:j] != 0.0).any(axis=0) | (model.C[:, i:j] != 0.0).any(axis=1)
        first, second = (bool(used[list(dofs)].any()) for dofs in _PORT_STARBOARD)
        if first and second:
            return [(np.arange(len(model.A)), tuple(range(6)))]
        groups[1 if second else 0] += range(i, j)
    return [(np.array(g, dtype=np.intp), dofs) for g, dofs in zip(groups, _PORT_STARBOARD, strict=True)]
