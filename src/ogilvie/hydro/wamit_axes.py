"""Frequencies and directions of several files on one axis, or an error that names both files."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import FormatError
from ogilvie.hydro.wamit_text import Array, fail

SAME = 1e-5  # files of one run print one frequency with six or seven digits
OTHER_RUN = "The files belong to different runs, or one of them is truncated; keep the files of one run."


def wrapped(degrees: Array) -> Array:
    """Return directions in (-180, 180] if they all are there already, else in [0, 360).

    Examples
    --------
    >>> wrapped(np.array([-90.0, 0.0, 180.0])), wrapped(np.array([0.0, 180.0, 360.0]))
    (array([-90.,   0., 180.]), array([  0., 180.,   0.]))
    """
    if np.all((degrees > -180.0) & (degrees <= 180.0)):
        return degrees
    return degrees % 360.0


def merged(path: Path, labels: Array, values: NDArray) -> tuple[Array, NDArray]:
    """Return distinct labels (n,) or (n, 2), sorted, with their values (..., n, modes); repeated ones have to agree.

    Directions 0 and 360 deg in one file are the same direction twice.
    """
    distinct, first, place = np.unique(labels, axis=0, return_index=True, return_inverse=True)
    kept = np.take(values, first, axis=-2)
    if len(distinct) == len(labels):
        return distinct, kept
    again = np.take(kept, place.ravel(), axis=-2)
    scale = np.nanmax(np.abs(values), initial=0.0)
    if np.nanmax(np.abs(again - values), initial=0.0) > 1e-4 * scale:
        fail(path, "equal values in directions that differ by 360 deg", "different ones", "Keep one of the two directions.")
    return distinct, kept


def frequency_order(omega: Array, path: Path, master: Array, master_path: Path) -> NDArray[np.intp]:
    """Return the index of each frequency of the master axis (ascending) in another file's axis; both have to hold the same."""
    order = np.argsort(omega)
    ours = omega[order]
    if len(ours) == len(master) and np.all(np.abs(ours - master) <= SAME * master):
        return order
    lonely = _lonely(master, ours)
    if lonely is None:
        lonely, path, master_path = _lonely(ours, master), master_path, path
    what = f", {2 * np.pi / lonely:.6g} s ({lonely:.6g} rad/s) among them," if lonely is not None else ""
    raise FormatError(
        f"{path.name}: the frequencies of {master_path.name}{what} expected, they are not those found. {OTHER_RUN} "
        "If the first column is not the period, say so by IPEROUT in the .cfg file."
    )


def direction_order(degrees: Array, path: Path, master: Array, master_path: Path) -> NDArray[np.intp]:
    """Return the index of each direction of the master axis in another file's axis; both have to hold the same."""
    order = np.argsort(degrees)
    if len(order) == len(master) and np.allclose(degrees[order], master, rtol=0, atol=1e-3):
        return order
    raise FormatError(
        f"{path.name}: the {len(master)} directions of {master_path.name} ({_span(master)}) expected, "
        f"{len(degrees)} ({_span(degrees)}) found. {OTHER_RUN}"
    )


def _lonely(a: Array, b: Array) -> float | None:
    """Return the first value of a that is not in b."""
    for value in a:
        if len(b) == 0 or np.min(np.abs(b - value)) > SAME * value:
            return float(value)
    return None


def _span(degrees: Array) -> str:
    return f"{degrees.min():g}..{degrees.max():g} deg"
