"""Potential on the hull after an impulse of its velocity: what forces of waves are made of."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.coupled import CoupledSystem
from ogilvie.bem.stepping import propagator

Array = NDArray[Any]


def hull_response(system: CoupledSystem, *, dt: float, count: int) -> Array:
    """Return the rate of the memory potential at the hull's nodes after a unit impulse in each dof, (count, n_hull, n_dofs).

    Parameters
    ----------
    system : CoupledSystem
    dt : float
        In units of the system.
    count : int
        Number of times 0, dt, ...

    Notes
    -----
    inputs.T z'(t) with z(0) = 0, z'(0) = inputs n_k; its product with n_j is K_jk(t). All times come from products of
    propagators exp(A dt)^i with blocks of about sqrt(count) vectors. Values carry the nodes' sqrt(weight).
    """
    size, turn = np.linalg.eigh(system.stiffness)
    W, n = np.sqrt(np.maximum(size, 0.0)), len(size)
    E = propagator(W, turn.T @ system.damping @ turn, dt)
    H = turn.T @ system.inputs
    b = H @ system.modes.T
    k, small = b.shape[1], max(int(np.sqrt(count)), 1)
    block = np.empty((2 * n, small, k))
    block[:n, 0], block[n:, 0] = 0.0, b
    for i in range(1, small):
        block[:, i] = E @ block[:, i - 1]
    E, x = np.linalg.matrix_power(E, small), block.reshape(2 * n, -1)
    out = []
    for _ in range(-(-count // small)):
        out.append((H.T @ x[n:]).reshape(-1, small, k).transpose(1, 0, 2))
        x = E @ x
    return np.concatenate(out)[:count]
