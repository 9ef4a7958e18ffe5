"""Newman's approximations: quadratic transfer functions from the mean drift of each wave alone.

Mean drift D(w, b) per amplitude squared is real. With D_i = D(w_i, b_i) of component i:

arithmetic   Q_ij = (D_i + D_j)/2
geometric    Q_ij = sqrt(D+_i D+_j) - sqrt(D-_i D-_j) with D+ = max(D, 0), D- = max(-D, 0)
1974         Q_ij = (D(w_ij, b_i) + D(w_ij, b_j))/2 at the mean frequency w_ij = (w_i + w_j)/2
mean         Q_ii = D_i, and nothing for i != j

All four take pairs of waves from two directions as they stand; no phase between the two directions is known.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.schema import DOFS
from ogilvie.loads.base import ComplexArray, embed
from ogilvie.loads.interpolation import interpolated, symmetric_headings
from ogilvie.loads.quadratic import QuadraticForm
from ogilvie.loads.speed_table import HeadingTable
from ogilvie.loads.transfer import QtfTable

Array = NDArray[Any]
APPROXIMATIONS = ("newman-arithmetic", "newman-geometric", "newman-1974", "mean")


@dataclass(frozen=True, eq=False)
class DriftTable:
    """Mean drift over frequency and heading, and a rule that makes a quadratic transfer function of it.

    Parameters
    ----------
    table : HeadingTable
    rule : str
        One of :data:`APPROXIMATIONS` but for "newman-1974", whose table is a :class:`ogilvie.loads.transfer.QtfTable`.
    known : (6,) bool array
        Components that the data hold; the others are zero.
    """

    table: HeadingTable
    rule: str
    known: NDArray[np.bool_]

    @property
    def omega(self) -> Array:
        """Frequencies of the data, rad/s."""
        return self.table.omega

    @property
    def headings(self) -> Any:
        """Headings of the data."""
        return self.table.headings

    def drift(self, omega: Array, direction: Array) -> Array:
        """Return the mean drift (n, 6) per amplitude squared."""
        return self.table.at(omega, direction).real

    def form(self, omega: Array, direction: Array) -> QuadraticForm:
        """Return the force of n components with these frequencies and directions relative to the bow."""
        make = {"newman-arithmetic": arithmetic_form, "newman-geometric": geometric_form, "mean": steady_form}
        return make[self.rule](self.drift(omega, direction), self.known)

    def pair(self, omega_1: Array, direction_1: Array, omega_2: Array, direction_2: Array) -> ComplexArray:
        """Return Q (n, 6) of n pairs of waves, from the definition."""
        one, two = self.drift(omega_1, direction_1), self.drift(omega_2, direction_2)
        if self.rule == "newman-arithmetic":
            return (0.5 * (one + two)).astype(complex)
        if self.rule == "newman-geometric":
            up = np.sqrt(np.maximum(one, 0.0) * np.maximum(two, 0.0))
            return (up - np.sqrt(np.maximum(-one, 0.0) * np.maximum(-two, 0.0))).astype(complex)
        same = (omega_1 == omega_2) & (direction_1 == direction_2)
        return np.where(same[:, None], one, 0.0).astype(complex)


def arithmetic_form(D: Array, known: NDArray[np.bool_]) -> QuadraticForm:
    """Return Re[(sum D A e)(sum A e)*] of mean drift D (n, 6)."""
    which = np.flatnonzero(known)
    fields = np.concatenate([np.ones((1, len(D))), D[:, which].T])
    left = 1 + np.arange(len(which))
    return QuadraticForm(fields, left, np.zeros_like(left), np.eye(6)[which], np.zeros_like(D))


def geometric_form(D: Array, known: NDArray[np.bool_]) -> QuadraticForm:
    """Return |sum sqrt(D+) A e|^2 - |sum sqrt(D-) A e|^2 of mean drift D (n, 6)."""
    which = np.flatnonzero(known)
    fields = np.sqrt(np.maximum(np.concatenate([D[:, which].T, -D[:, which].T]), 0.0))
    place = np.arange(2 * len(which))
    return QuadraticForm(fields, place, place, np.concatenate([np.eye(6)[which], -np.eye(6)[which]]), np.zeros_like(D))


def steady_form(D: Array, known: NDArray[np.bool_]) -> QuadraticForm:
    """Return the mean force sum |A|^2 D alone."""
    none = np.zeros(0, dtype=np.intp)
    return QuadraticForm(np.zeros((0, len(D))), none, none, np.zeros((0, 6)), D)


def drift_table(
    hydro: xr.Dataset, rule: str, variable: str = "mean_drift", *, tolerance: float = 1e-8
) -> DriftTable | QtfTable:
    """Return the table of an approximation from the mean drift of a data set.

    Parameters
    ----------
    hydro : xarray.Dataset
    rule : str
        One of :data:`APPROXIMATIONS`.
    variable : str
        Which mean drift; where the set has no ``mean_drift`` the diagonal of its ``qtf_diff`` serves.
    tolerance : float
        See :class:`ogilvie.loads.transfer.QtfTable`.

    Raises
    ------
    InputError
        No mean drift; a component that is known at some frequencies or headings only.
    """
    drift = _mean_drift(hydro, variable)
    dofs = tuple(str(d) for d in hydro.influenced_dof.values)
    known = ~np.isnan(drift.values).all(axis=(0, 1))
    if np.isnan(drift.values[..., known]).any():
        raise InputError(
            f"{variable}: each component known everywhere or nowhere expected, some values are missing. "
            "Leave these frequencies, headings or components out."
        )
    values = embed(np.where(known, drift.values, 0.0), dofs, (2,)).astype(complex)
    table = HeadingTable(drift.omega.values.astype(float), *symmetric_headings(hydro, values))
    everywhere = embed(known.astype(float), dofs, (0,)) > 0.5
    if rule != "newman-1974":
        return DriftTable(table, rule, everywhere)
    w = table.omega
    middle = 0.5 * np.add.outer(w, w)
    Q = table.values if len(w) == 1 else interpolated(w, table.values, middle.ravel())
    Q = Q.reshape(len(w), len(w), *table.values.shape[1:]).astype(complex)
    return QtfTable(w, table.headings, Q, everywhere, tolerance=tolerance)


def _mean_drift(hydro: xr.Dataset, variable: str) -> xr.DataArray:
    if variable in hydro:
        return hydro[variable]
    if variable == "mean_drift" and "qtf_diff" in hydro:
        Q = hydro.qtf_diff
        coords = {"omega": Q.omega_1.values, "wave_direction": Q.wave_direction, "influenced_dof": Q.influenced_dof}
        diagonal = np.einsum("ppbi->pbi", Q.values).real
        return xr.DataArray(diagonal, dims=("omega", "wave_direction", "influenced_dof"), coords=coords)
    raise InputError(
        f"{variable} (or qtf_diff) expected in the data set, not found. Read a .8, .9 or .12d file, or give it to "
        f"hydro_from_arrays. Components: {', '.join(DOFS)}."
    )
