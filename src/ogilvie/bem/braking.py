"""Velocities damped along given shapes, a few columns at a time: one sweep over the matrix forward, one back."""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[Any]

_FEW = 12  # columns up to which the sweeps are faster than products of matrices


class Brake:
    """v -> v + shape diag(loss) shape.T v for the lower half of the state x = (positions, velocities).

    Parameters
    ----------
    shape : (n, m) array
        Norm up to 1.

    Examples
    --------
    >>> x = np.array([[3.0], [4.0]])
    >>> Brake(np.ones((1, 1)))(x, np.array([-0.25])).ravel().tolist()
    [3.0, 3.0]
    """

    def __init__(self, shape: Array) -> None:
        self.shape = np.ascontiguousarray(shape)

    def __call__(self, x: Array, loss: Array) -> Array:
        """Return a new state (2 n, k); loss (m,) from -1 to 0."""
        n = len(self.shape)
        out = np.array(x)
        if x.shape[1] > _FEW:
            out[n:] += self.shape @ (loss[:, None] * (self.shape.T @ x[n:]))
        else:
            _sweep(self.shape, loss, out[n:])
        return out


@njit(cache=True, nogil=True, fastmath={"contract", "reassoc", "nsz"})
def _sweep(shape: Array, loss: Array, v: Array) -> None:
    """Add shape diag(loss) shape.T v to v (n, k)."""
    n, m = shape.shape
    k = v.shape[1]
    w = np.zeros((k, m))
    for i in range(n):
        for c in range(k):
            for j in range(m):
                w[c, j] += shape[i, j] * v[i, c]
    for c in range(k):
        for j in range(m):
            w[c, j] *= loss[j]
    for i in range(n):
        for c in range(k):
            f = 0.0
            for j in range(m):
                f += shape[i, j] * w[c, j]
            v[i, c] += f
