"""What the plain hybrid method refuses: arguments, time steps beyond the leapfrog's limit, solutions that grow."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import ConvergenceError, InputError

Array = NDArray[Any]

DOFS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
#: Parity in x and y of the normal velocity and the potential of each dof.
PARITY = {"surge": (-1, 1), "sway": (1, -1), "heave": (1, 1), "roll": (1, -1), "pitch": (-1, 1), "yaw": (-1, -1)}


def check_arguments(*, duration: float, dt: float | None, dofs: tuple[str, ...], rho: float, g: float, points: int) -> None:
    """Raise an error for what `plain_hybrid` cannot work with."""
    if points not in range(1, 9):
        raise InputError(f"plain_hybrid: points: a whole number 1..8 expected, {points!r} found.")
    for name, value in (("duration", duration), ("dt", dt), ("rho", rho), ("g", g)):
        if value is not None and not (np.isfinite(value) and value > 0.0):
            raise InputError(f"plain_hybrid: {name}: a positive number expected, {value!r} found.")
    unknown = [d for d in dofs if d not in DOFS]
    if unknown or not dofs or len(set(dofs)) < len(dofs):
        raise InputError(f"plain_hybrid: dofs: some of {', '.join(DOFS)}, each once, expected, {dofs!r} found.")


def time_step(dt: float | None, limit: float) -> float:
    """Return the time step, half the limit where none is given; an error names one that works."""
    if dt is None:
        return 0.5 * limit
    if dt >= limit:
        digits = 1 - int(np.floor(np.log10(0.95 * limit)))
        works = np.floor(0.95 * limit * 10.0**digits) / 10.0**digits
        raise InputError(
            f"plain_hybrid: dt below {limit:.4g} s expected, {dt:g} s found: the leapfrog of the free surface would grow. "
            f"dt={works:g} works; larger free-surface panels allow more."
        )
    return dt


def check_bounded(K: Array, step: float, dofs: tuple[str, ...], extent: float) -> None:
    """Raise an error where |K_jj(t)| is above 2 K_jj(0), apart from dofs that have no radiation.

    Notes
    -----
    A passive fluid has |K_jj(t)| <= K_jj(0), as K_jj is the cosine transform of a damping that is nowhere negative.
    """
    size = np.array([extent if DOFS.index(d) > 2 else 1.0 for d in dofs])
    diagonal = np.abs(np.diagonal(K, axis1=1, axis2=2)) / size**2
    start = diagonal[0]
    grown = (diagonal > 2.0 * np.maximum(start, 0.01 * start.max())).any(axis=1) | ~np.isfinite(diagonal).all(axis=1)
    if grown.any():
        first = step * float(grown.argmax())
        raise ConvergenceError(
            f"plain_hybrid: |K(t)| <= K(0) expected, more than twice as much found at t = {first:.4g} s: the solution grows. "
            "Take smaller panels of the control surface, points=3 or more, or a shorter duration."
        )
