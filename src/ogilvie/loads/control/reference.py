"""Reference filter: a step of the set-point becomes a smooth course that the vessel can follow."""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.loads.control.checks import NO_LIMIT, limit, not_negative, positive

Array = NDArray[Any]

#: Numbers in the data of one filter: transition (3, 3), input (3,), period, largest rate.
REFERENCE_DATA = 14


def reference_data(
    frequency: float, period: float, *, damping: float = 1.0, max_rate: float = NO_LIMIT, what: str = "reference"
) -> Array:
    """Return the data of the third-order reference filter for :func:`reference_step`.

    Parameters
    ----------
    frequency : float
        w, rad/s.
    period : float
        s.
    damping : float
        z, of the second-order part.
    max_rate : float
        Largest rate of change of the reference, in its unit per s.

    Notes
    -----
    x''' + (2 z + 1) w x'' + (2 z + 1) w^2 x' + w^3 x = w^3 r, poles -w and the pair of (w, z). The step is exact for a target
    that is held over the period (matrix exponential), whatever the period. Where the rate would pass its limit it is held
    there, and an acceleration that drives it further is dropped.

    References
    ----------
    Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control (2021): third-order reference models for position and
    heading (first-order low-pass filter and mass-spring-damper in a row), with limited rate.

    Examples
    --------
    >>> state = np.zeros(3)
    >>> for _ in range(2000):
    ...     reference_step(reference_data(0.1, 0.5), state, 0.3)
    >>> float(state[0].round(9))
    0.3
    """
    from scipy.linalg import expm

    w = positive(frequency, f"{what}_frequency", "rad/s")
    z = not_negative(damping, f"{what}_damping", "-")
    T = positive(period, "period", "s")
    F = np.zeros((4, 4))  # state (x, x', x'') and the constant target
    F[0, 1] = F[1, 2] = 1.0
    F[2] = [-(w**3), -(2 * z + 1) * w**2, -(2 * z + 1) * w, w**3]
    E = expm(F * T)
    return np.concatenate([E[:3, :3].ravel(), E[:3, 3], [T, limit(max_rate, "max_rate", "1/s")]])


@njit(cache=True, nogil=True)
def reference_step(data: Array, state: Array, target: float) -> None:
    """Take the state (x, x', x'') over one period towards a target that is held."""
    x, v, a = state[0], state[1], state[2]
    for i in range(3):
        state[i] = data[3 * i] * x + data[3 * i + 1] * v + data[3 * i + 2] * a + data[9 + i] * target
    period, largest = data[12], data[13]
    if abs(state[1]) > largest:
        state[1] = largest if state[1] > 0.0 else -largest
        state[0] = x + 0.5 * period * (v + state[1])
        if state[1] * state[2] > 0.0:
            state[2] = 0.0


@njit(cache=True, nogil=True)
def wrapped(angle: float) -> float:
    """Return the angle (rad) brought to [-pi, pi)."""
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


@njit(cache=True, nogil=True)
def heading_reference_step(data: Array, state: Array, target: float) -> None:
    """As :func:`reference_step`, towards a heading (rad) by the shorter way round."""
    reference_step(data, state, state[0] + wrapped(target - state[0]))
