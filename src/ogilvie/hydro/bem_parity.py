"""Influence matrices of the copies of a symmetric hull, put together for each combination of parities (kernel)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import ConvergenceError
from ogilvie.hydro.bem_panels import HullPanels

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_CHUNK = 1 << 15  # numbers that are added at a time, within the cache


def parities(panels: HullPanels) -> Array:
    """Return the signs (n_par, n_c) of each combination of parities at each copy."""
    table = np.ones((1, 1))
    for _ in panels.hull.planes:
        table = np.block([[table, table], [table, -table]])
    return table


def by_parity(copies: Sequence[tuple[Complex, ...]]) -> Sequence[tuple[Complex, ...]]:
    """Return the sums of each matrix over the copies of a hull, with the signs of :func:`parities`.

    Notes
    -----
    Sums and differences take the place of the copies, which are lost: matrices of gigabytes are passed over once per plane.

    Examples
    --------
    >>> one, two = np.array([[3.0 + 0j]]), np.array([[1.0 + 0j]])
    >>> [S.tolist() for (S,) in by_parity([(one,), (two,)])]
    [[[(4+0j)]], [[(2+0j)]]]
    """
    step = 1
    while step < len(copies):
        for k in range(len(copies)):
            if k & step == 0:
                for a, b in zip(copies[k], copies[k + step], strict=True):
                    _sum_and_difference(a, b)
        step *= 2
    return copies


def require_finite(copies: Sequence[tuple[Complex, ...]], *, purpose: str) -> None:
    """Raise ConvergenceError where influence matrices hold NaN."""
    if not all(np.all(np.isfinite(matrix)) for matrices in copies for matrix in matrices):
        raise ConvergenceError(
            f"{purpose}: the influence matrices hold NaN or infinite numbers. Panels may overlap or have no area; "
            "look at the mesh with ogilvie.mesh.inspect.check_mesh."
        )


def _sum_and_difference(a: Complex, b: Complex) -> None:
    """Put a + b and a - b of two matrices in their places, a few rows (or columns, as they lie in memory) at a time."""
    if a.flags.f_contiguous:
        a, b = a.T, b.T
    rows = max(1, _CHUNK // max(1, a.shape[1]))
    for i in range(0, len(a), rows):
        difference = a[i : i + rows] - b[i : i + rows]
        a[i : i + rows] += b[i : i + rows]
        b[i : i + rows] = difference
