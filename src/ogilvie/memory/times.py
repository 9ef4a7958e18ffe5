"""How long and how fine the table of K(t) is where the user does not say."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.curves import RadiationCurves
from ogilvie.memory.from_damping import kernel_from_damping

Array = NDArray[Any]

_FORGOTTEN = 2e-3  # of the largest K_ii: where the table may end


def time_table(curves: RadiationCurves, duration: float | None, dt: float | None, horizon: float, interpolation: str) -> Array:
    """Return the times of the table, s.

    Parameters
    ----------
    curves : RadiationCurves
    duration, dt : float, optional
        Last time and step, s. By default where every K_ii has fallen below 0.2 % of its largest value, but no later than
        `horizon`, and 1, 2 or 5 times a power of ten up to a twentieth of the shortest period in the data.
    horizon : float
        Time up to which the spacing of the frequencies determines K, s.
    interpolation : {"spline", "linear"}
    """
    dt = dt or _nice_step(2 * np.pi / curves.omega[-1] / 20)
    if duration is None:
        duration = _memory_length(curves, horizon, dt, interpolation)
    return dt * np.arange(int(np.ceil(duration / dt - 1e-9)) + 1)


def _memory_length(curves: RadiationCurves, horizon: float, dt: float, interpolation: str) -> float:
    t = np.linspace(0.0, horizon, 600)
    K = np.abs(np.einsum("tii->ti", kernel_from_damping(curves, None, t, interpolation)))
    peak = K.max(axis=0)
    alive = (K[:, peak > 0] / peak[peak > 0]).max(axis=1) > _FORGOTTEN
    last = t[np.flatnonzero(alive)[-1]]
    return float(max(min(1.05 * last, horizon), 40 * dt))


def _nice_step(dt: float) -> float:
    """Round down to 1, 2 or 5 times a power of ten."""
    decade = 10.0 ** np.floor(np.log10(dt))
    return float(max(m for m in (1.0, 2.0, 5.0) if m * decade <= dt * (1 + 1e-9)) * decade)
