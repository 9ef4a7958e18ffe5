"""Quadratic transfer functions between the tabulated frequencies and headings, as sums of products."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.qtf import symmetric_qtf
from ogilvie.loads.base import ComplexArray, embed
from ogilvie.loads.interpolation import Headings, heading_weights, interpolated, symmetric_headings, unwrapped
from ogilvie.loads.quadratic import QuadraticForm

Array = NDArray[Any]
_SAME = 1e-9  # rad: directions that are one


@dataclass(frozen=True, eq=False)
class QtfTable:
    """Quadratic transfer functions of waves of one direction.

    Parameters
    ----------
    omega : (n_w,) array
    headings : Headings
    values : (n_w, n_w, n_b, 6) complex array
        Hermitian in the frequencies, or symmetric for sums.
    known : (6,) bool array
        Components that the data hold.
    difference : bool
    tolerance : float
        Eigenvalues (singular values) below this fraction of the largest are left out.

    Notes
    -----
    Cubic splines S in frequency, complex splines in heading: Q(w_i, w_j; b) = S_i Q_b S_j^T. Two waves of different directions
    get (Q(w_i, w_j; b_i) + Q(w_i, w_j; b_j))/2. S Q_b S^T = sum_k lambda_k u_k u_k^H is found from a matrix of the size of the
    data, so that the number of products is at most n_w for each component, however many waves the sea has.
    """

    omega: Array
    headings: Headings
    values: ComplexArray
    known: NDArray[np.bool_]
    difference: bool = True
    tolerance: float = 1e-8

    def form(self, omega: Array, direction: Array) -> QuadraticForm:
        """Return the force of n components with these frequencies and directions relative to the bow."""
        base, R = np.linalg.qr(spline_weights(self.omega, omega))
        b, first, which = np.unique(np.round(direction / _SAME), return_index=True, return_inverse=True)
        across = heading_weights(self.headings, direction[first])
        left, right, weight = [], [], []
        for c in range(len(b)):
            Q = np.einsum("b,pqbi->ipq", across[c], self.values)
            mask = which == c
            for i in np.flatnonzero(self.known):
                size, u, v = decomposed(R @ Q[i] @ R.T, self.tolerance, difference=self.difference)
                left.append((base @ u).T * mask)
                right.append((base @ v).T)
                weight.append(size[:, None] * np.eye(6)[i])
        return _form(left, right, weight, len(omega), difference=self.difference)

    def pair(self, omega_1: Array, direction_1: Array, omega_2: Array, direction_2: Array) -> ComplexArray:
        """Return Q (n, 6) of n pairs of waves, from the definition."""
        S1, S2 = spline_weights(self.omega, omega_1), spline_weights(self.omega, omega_2)
        found = np.zeros((len(S1), 6), dtype=complex)
        for direction in (direction_1, direction_2):
            b, first, which = np.unique(np.round(direction / _SAME), return_index=True, return_inverse=True)
            across = heading_weights(self.headings, direction[first])
            for c in range(len(b)):
                rows = np.flatnonzero(which == c)
                Q = np.einsum("b,pqbi->pqi", across[c], self.values)
                found[rows] += 0.5 * _bilinear(S1[rows], Q, S2[rows])
        return found


@dataclass(frozen=True, eq=False)
class QtfPairTable:
    """Quadratic transfer functions of two waves of any two directions of the data.

    Parameters
    ----------
    omega, headings, known, difference, tolerance
        See :class:`QtfTable`.
    values : (n_w, n_b, n_w, n_b, 6) complex array
        First wave, second wave.

    Notes
    -----
    Q(w_i, b_i; w_j, b_j) = S_i h_i Q h_j S_j with splines S in frequency and h in heading.
    """

    omega: Array
    headings: Headings
    values: ComplexArray
    known: NDArray[np.bool_]
    difference: bool = True
    tolerance: float = 1e-8

    def form(self, omega: Array, direction: Array) -> QuadraticForm:
        """Return the force of n components with these frequencies and directions relative to the bow."""
        base, R = np.linalg.qr(self._weights(omega, direction))
        left, right, weight = [], [], []
        for i in np.flatnonzero(self.known):
            Q = self.values[..., i].reshape(R.shape[1], R.shape[1])
            size, u, v = decomposed(R @ Q @ R.T, self.tolerance, difference=self.difference)
            left.append((base @ u).T)
            right.append((base @ v).T)
            weight.append(size[:, None] * np.eye(6)[i])
        return _form(left, right, weight, len(omega), difference=self.difference)

    def pair(self, omega_1: Array, direction_1: Array, omega_2: Array, direction_2: Array) -> ComplexArray:
        """Return Q (n, 6) of n pairs of waves, from the definition."""
        one, two = self._weights(omega_1, direction_1), self._weights(omega_2, direction_2)
        Q = self.values.reshape(one.shape[1], one.shape[1], -1)
        return _bilinear(one, Q, two)

    def _weights(self, omega: Array, direction: Array) -> Array:
        S, h = spline_weights(self.omega, omega), heading_weights(self.headings, direction)
        return (S[:, :, None] * h[:, None, :]).reshape(len(omega), -1)


def _bilinear(one: Array, Q: ComplexArray, two: Array) -> ComplexArray:
    """Return sum_pq one_np Q_pqi two_nq (n, 6), some rows at a time."""
    found = np.empty((len(one), Q.shape[2]), dtype=complex)
    for begin in range(0, len(one), 2048):
        part = slice(begin, begin + 2048)
        half = (one[part] @ Q.reshape(len(Q), -1)).reshape(-1, *Q.shape[1:])
        found[part] = np.einsum("nq,nqi->ni", two[part], half)
    return found


def decomposed(Q: ComplexArray, tolerance: float, *, difference: bool) -> tuple[Array, ComplexArray, ComplexArray]:
    """Return weights (k,) and vectors u, v (n, k): Q = sum weight u v^H (Hermitian, u = v) or sum weight u v^T.

    Examples
    --------
    >>> size, u, v = decomposed(np.outer([1.0, 2.0j], [1.0, -2.0j]), 1e-12, difference=True)
    >>> len(size), round(float(size[0]), 9)
    (1, 5.0)
    """
    if difference:
        size, u = np.linalg.eigh(Q)
        keep = np.abs(size) > tolerance * np.abs(size).max(initial=0.0)
        return size[keep], u[:, keep], u[:, keep]
    u, size, v = np.linalg.svd(Q)
    keep = size > tolerance * size.max(initial=0.0)
    return size[keep], u[:, keep], v[keep].T


def spline_weights(omega: Array, at: Array) -> Array:
    """Return the weights (n, n_w) of the tabulated frequencies in the value at each frequency (n,)."""
    if len(omega) == 1:
        return np.ones((len(at), 1))
    return interpolated(omega, np.eye(len(omega)), np.clip(at, omega[0], omega[-1]))


def qtf_table(hydro: xr.Dataset, key: str = "qtf_diff", *, tolerance: float = 1e-8) -> QtfTable | QtfPairTable:
    """Return the table of ``qtf_diff`` or ``qtf_sum``; of two directions at once where all pairs of the data's are there.

    Raises
    ------
    InputError
        No such data, pairs of frequencies that are not known, functions without their symmetry.
    """
    name = f"{key}_pairs" if f"{key}_pairs" in hydro else key
    if name not in hydro:
        raise InputError(
            f"{key} expected in the data set, not found. Read a .12d or .12s file, or use ogilvie.hydro.qtf.with_qtf."
        )
    hydro = symmetric_qtf(hydro)
    dofs = tuple(str(d) for d in hydro.influenced_dof.values)
    Q = hydro[name].values
    gaps = ~np.isnan(Q).all(axis=(0, 1, 2))
    if np.isnan(Q[..., gaps]).any():
        raise InputError(
            f"{name}: all pairs of frequencies expected, {int(np.isnan(Q[..., gaps]).any(axis=(2, 3)).sum())} of "
            f"{len(Q) ** 2} found missing. Fill them knowingly: filled_qtf(hydro, by='newman-arithmetic')."
        )
    known = embed(gaps.astype(float), dofs, (0,)) > 0.5
    Q = embed(np.where(gaps, Q, 0.0), dofs, (3,))
    w, difference = hydro.omega_1.values.astype(float), key == "qtf_diff"
    if name == key:
        headings, flat = symmetric_headings(hydro, Q.reshape(len(w) ** 2, -1, 6))
        values = flat.reshape(len(w), len(w), -1, 6)
        return QtfTable(w, headings, values, known, difference, tolerance)
    headings, values = _both_directions(hydro, name, Q)
    return QtfPairTable(w, headings, values, known, difference, tolerance)


def _both_directions(hydro: xr.Dataset, name: str, Q: ComplexArray) -> tuple[Headings, ComplexArray]:
    """Return headings and values (n_w, n_b, n_w, n_b, 6)."""
    two = np.stack([hydro.qtf_direction_1.values, hydro.qtf_direction_2.values], axis=1)
    _, first, at = np.unique(two.round(7), return_index=True, return_inverse=True)
    b, at = two.ravel()[first], at.reshape(two.shape)
    full = np.full((len(Q), len(b), len(Q), len(b), 6), np.nan + 0j)
    for k, (m, n) in enumerate(at):
        full[:, m, :, n] = Q[:, :, k]
    missing = int(np.isnan(full[0, :, 0, :, :]).all(axis=-1).sum())
    if missing:
        raise InputError(
            f"{name}: every pair of the {len(b)} directions expected, {missing} found missing. Compute them, or leave out the "
            f"pairs: hydro.drop_vars('{name}')."
        )
    headings, order = unwrapped(b, np.arange(len(b))[None, :, None])
    place = order[0, :, 0].astype(np.intp)
    return headings, full[:, place][:, :, :, place]


def _form(
    left: list[ComplexArray], right: list[ComplexArray], weight: list[Array], n: int, *, difference: bool
) -> QuadraticForm:
    """Return the form of products left times right; factors that are the same are kept once."""
    one, two = (np.concatenate([np.zeros((0, n)), *parts]) for parts in (left, right))
    number = np.arange(len(one))
    weights = np.concatenate([np.zeros((0, 6)), *weight])
    if np.array_equal(one, two):
        return QuadraticForm(one, number, number, weights, np.zeros((n, 6)), difference)
    fields = np.concatenate([one, two])
    return QuadraticForm(fields, number, len(one) + number, weights, np.zeros((n, 6)), difference)
