"""Forces quadratic in the wave amplitudes: as double sums, by one FFT, and as products of single sums."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.loads.harmonics import HarmonicGrid

Array = NDArray[Any]
ComplexArray = NDArray[Any]
IntArray = NDArray[np.intp]
_TOGETHER = 64  # products, or times, evaluated at once


@dataclass(frozen=True, eq=False)
class QuadraticForm:
    """A quadratic force as a sum of products of single sums over n wave components.

    Parameters
    ----------
    fields : (m, n) complex array
        f: transfer functions of the single sums X_k(t) = sum_j f_kj A_j exp(i w_j t).
    left, right : (p,) int array
        Which two sums each product takes.
    weight : (p, 6) array
        Of each product in the six components.
    steady : (n, 6) array
        D: a steady force sum_j |A_j|^2 D_j beside the products.
    difference : bool
        Difference frequencies (the second factor conjugate) or sum frequencies.

    Notes
    -----
    F(t) = sum_j |A_j|^2 D_j + Re sum_p weight_p X_left X_right*, which is the double sum Re sum_i sum_j A_i A_j* Q_ij
    exp(i (w_i - w_j) t) with Q_ij = sum_p weight_p f_left,i f_right,j*; without conjugates at sum frequencies. Its cost grows
    with N log N where that of the double sum grows with N^2.

    Examples
    --------
    >>> one = QuadraticForm(np.ones((1, 2)), np.array([0]), np.array([0]), np.eye(6)[:1], np.zeros((2, 6)))
    >>> grid = HarmonicGrid(np.array([0.5, 0.7]), step=0.2 * np.pi / 0.2, count=11)
    >>> one.series(grid, grid.phases(0.0))[[0, 5, 10], 0].round(9)  # 2 + 2 cos(0.2 t)
    array([4., 0., 4.])
    """

    fields: ComplexArray
    left: IntArray
    right: IntArray
    weight: Array
    steady: Array
    difference: bool = True

    def series(self, grid: HarmonicGrid, amplitude: ComplexArray) -> Array:
        """Return the force (count, 6); amplitude (n,) times the phases of the grid, see :meth:`HarmonicGrid.series`."""
        out = np.tile(np.abs(amplitude) ** 2 @ self.steady, (grid.count, 1))
        for which, left, right, transfer in self._portions:
            series = grid.series(amplitude, transfer)
            m = transfer.shape[1] // 2
            X = series[:, :m] + 1j * series[:, m:]
            other = X[:, right].conj() if self.difference else X[:, right]
            out += (X[:, left] * other).real @ self.weight[which]
        return out

    @cached_property
    def _portions(self) -> tuple[tuple[slice, IntArray, IntArray, ComplexArray], ...]:
        """Some products at a time, with the transfer functions of the real and the imaginary parts of their sums."""
        found = []
        for begin in range(0, len(self.left), _TOGETHER):
            which = slice(begin, begin + _TOGETHER)
            used, place = np.unique(np.concatenate([self.left[which], self.right[which]]), return_inverse=True)
            left, right = np.split(place, 2)
            T = self.fields[used].T
            found.append((which, left, right, np.ascontiguousarray(np.concatenate([T, -1j * T], axis=1), dtype=complex)))
        return tuple(found)

    def matrix(self) -> ComplexArray:
        """Return Q (n, n, 6), Hermitian for differences and symmetric for sums."""
        right = self.fields[self.right].conj() if self.difference else self.fields[self.right]
        Q = np.einsum("pi,pj,pd->ijd", self.fields[self.left], right, self.weight)
        other = Q.swapaxes(0, 1)
        Q = 0.5 * (Q + (other.conj() if self.difference else other))
        diagonal = np.arange(len(Q))
        Q[diagonal, diagonal] += self.steady
        return Q

    def diagonal(self) -> Array:
        """Return the steady force (n, 6) of each component alone, per amplitude squared; for difference frequencies."""
        return self.steady + (self.fields[self.left] * self.fields[self.right].conj()).real.T @ self.weight


def weighted_forms(parts: Sequence[tuple[float, QuadraticForm]]) -> QuadraticForm:
    """Return the sum of forms of the same components, each times a number.

    Examples
    --------
    >>> one = QuadraticForm(np.ones((1, 2)), np.array([0]), np.array([0]), np.eye(6)[:1], np.zeros((2, 6)))
    >>> weighted_forms([(0.25, one), (0.5, one)]).matrix()[0, 1, 0]
    np.float64(0.75)
    """
    if len(parts) == 1 and parts[0][0] == 1.0:
        return parts[0][1]
    forms = [form for _, form in parts]
    first = np.cumsum([0, *(len(form.fields) for form in forms)])[:-1]
    left, right = ([getattr(f, side) + at for f, at in zip(forms, first, strict=True)] for side in ("left", "right"))
    return QuadraticForm(
        np.concatenate([form.fields for form in forms]),
        np.concatenate(left),
        np.concatenate(right),
        np.concatenate([share * form.weight for share, form in parts]),
        np.sum([share * form.steady for share, form in parts], axis=0),
        forms[0].difference,
    )


def double_sum(amplitude: ComplexArray, frequency: Array, Q: ComplexArray, t: Array, *, difference: bool = True) -> Array:
    """Return the force (n_t, 6) as the plain double sum, paper D, Eq. (51); the reference for all other ways.

    Parameters
    ----------
    amplitude : (n,) complex array
    frequency : (n,) array
        rad/s.
    Q : (n, n, 6) complex array
    t : (n_t,) array
    difference : bool
        Re sum sum A_i A_j* Q_ij exp(i (w_i - w_j) t), or Re sum sum A_i A_j Q_ij exp(i (w_i + w_j) t).

    Examples
    --------
    >>> Q = np.ones((2, 2, 6))
    >>> double_sum(np.ones(2), np.array([0.5, 0.7]), Q, np.array([0.0, np.pi / 0.2]))[:, 0].round(9) + 0.0
    array([4., 0.])
    """
    n, found = len(amplitude), np.empty((len(t), Q.shape[2]))
    flat = Q.reshape(n, -1).astype(complex)
    for begin in range(0, len(t), _TOGETHER):
        part = slice(begin, begin + _TOGETHER)
        e = amplitude * np.exp(1j * np.multiply.outer(t[part], frequency))
        inner = (e @ flat).reshape(-1, n, Q.shape[2])
        found[part] = np.einsum("tj,tjd->td", e.conj() if difference else e, inner).real
    return found


def single_fft(amplitude: ComplexArray, Q: ComplexArray, count: int) -> Array:
    """Return the force at difference frequencies over one period by a single inverse FFT, paper D, Eq. (52).

    Parameters
    ----------
    amplitude : (n,) complex array
        Of equidistant frequencies w_p = w_0 + p dw.
    Q : (n, n, 6) complex array
        Hermitian.
    count : int
        Times 0, T/count, 2 T/count ... of the period T = 2 pi/dw, 2 n at least.

    Returns
    -------
    (count, 6) array

    Raises
    ------
    InputError
        Fewer times than the highest difference frequency needs.

    Examples
    --------
    >>> single_fft(np.ones(2), np.ones((2, 2, 6)), 4)[:, 0]
    array([4., 2., 0., 2.])
    """
    n = len(amplitude)
    if count < 2 * n:
        raise InputError(f"single_fft: {2 * n} times or more expected for {n} components, {count} found.")
    spectrum = np.zeros((count // 2 + 1, Q.shape[2]), dtype=complex)
    spectrum[0] = np.einsum("p,p,ppd->d", amplitude, amplitude.conj(), Q).real
    for k in range(1, n):  # the k-th diagonal: all pairs with the difference k dw
        spectrum[k] = np.einsum("l,l,ld->d", amplitude[k:], amplitude[:-k].conj(), np.einsum("lld->ld", Q[k:, :-k]))
    return np.fft.irfft(spectrum, n=count, axis=0) * count
