"""Sums of harmonics on a uniform grid of times: Re sum_j c_j exp(i w_j t), any frequencies, by FFT.

A wave force at fixed heading and speed is such a sum. Its frequencies are never quite those of an FFT (equal-energy components,
encounter frequencies, a time step of one's own choice), so each component is spread over a few neighbouring frequencies of a
finer FFT grid with a smooth window, and the window is divided out in time. The cost does not grow with the number of
components times the number of steps; the error is about 1e-12 of sum |c_j|.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[Any]
ComplexArray = NDArray[Any]

_WIDTH = 16  # grid points under the window
_FINER = 1.5  # FFT points per time point
_SHAPE = 0.98 * np.pi * _WIDTH * (1.0 - 0.5 / _FINER)  # of the window exp(shape (sqrt(1 - x^2) - 1))


@dataclass(frozen=True, eq=False)
class HarmonicGrid:
    """Evaluates sums of harmonics with frequencies w (n,) at `count` times `step` apart.

    Parameters
    ----------
    frequency : (n,) array
        rad/s, any sign.
    step : float
        s.
    count : int
        Number of times in a block.

    References
    ----------
    Barnett, Magland and af Klinteberg (2019), SIAM J. Sci. Comput. 41(5), C479: the window.

    Examples
    --------
    >>> grid = HarmonicGrid(np.array([0.5, 1.3]), step=0.1, count=50)
    >>> t = 1000.0 + 0.1 * np.arange(50)
    >>> series = grid.series(grid.phases(1000.0), np.ones((2, 1), dtype=complex))[:, 0]
    >>> bool(np.abs(series - np.cos(0.5 * t) - np.cos(1.3 * t)).max() < 1e-10)
    True
    """

    frequency: Array
    step: float
    count: int

    @cached_property
    def size(self) -> int:
        """Number of points of the FFT."""
        return _smooth_even(int(np.ceil(_FINER * self.count)) + _WIDTH)

    @cached_property
    def _middle(self) -> int:
        return self.count // 2

    @cached_property
    def _places(self) -> tuple[NDArray[np.int64], Array]:
        """First grid point (n,) and window weights (n, width) of each component."""
        x = np.remainder(self.frequency * self.step / (2 * np.pi) + 0.5, 1.0) - 0.5  # cycles per step in [-1/2, 1/2)
        x = x * self.size
        first = np.ceil(x - _WIDTH / 2).astype(np.int64)
        distance = (first[:, None] + np.arange(_WIDTH) - x[:, None]) / (_WIDTH / 2)
        return first, _window(distance)

    @cached_property
    def _correction(self) -> Array:
        """1 / (transform of the window), (count,), scaled for an inverse real FFT."""
        node, weight = np.polynomial.legendre.leggauss(4 * _WIDTH)
        p = np.arange(self.count) - self._middle
        transform = np.cos(np.outer(p, np.pi * _WIDTH * node / self.size)) @ (weight * _window(node)) * (_WIDTH / 2)
        return 0.5 * self.size / transform

    def phases(self, start: float) -> ComplexArray:
        """Return exp(i w t) (n,) at the middle of the block whose first time is `start` (s)."""
        return np.exp(1j * self.frequency * (start + self._middle * self.step))

    def series(self, amplitude: ComplexArray, transfer: ComplexArray) -> Array:
        """Return the real series (count, m) of the m sums with coefficients ``amplitude[:, None] * transfer``.

        Parameters
        ----------
        amplitude : (n,) complex array
            Of each component in the middle of the block: its complex amplitude times :meth:`phases`.
        transfer : (n, m) complex array
            What turns the amplitude of a component into each of the m quantities.
        """
        first, weight = self._places
        m = transfer.shape[1]
        spectrum = np.zeros((m, self.size // 2 + 1), dtype=complex)
        _spread(first, weight, amplitude, transfer, self.size, spectrum)
        out = np.empty((self.count, m))
        _gather(np.fft.irfft(spectrum, n=self.size, axis=1), self._middle, self._correction, out)
        return out


def _window(x: Array) -> Array:
    return np.exp(_SHAPE * (np.sqrt(np.maximum(1.0 - x * x, 0.0)) - 1.0))


def _smooth_even(least: int) -> int:
    """Smallest even number >= least without prime factors above 5."""
    n = least + least % 2
    while True:
        rest = n
        for f in (2, 3, 5):
            while rest % f == 0:
                rest //= f
        if rest == 1:
            return n
        n += 2


@njit(cache=True, nogil=True)
def _spread(first, weight, amplitude, transfer, size, spectrum):
    """Add each component to the half spectrum of a real series; negative frequencies enter as conjugates."""
    half = size // 2
    m = spectrum.shape[0]
    width = weight.shape[1]
    for j in range(len(first)):
        for i in range(m):
            c = amplitude[j] * transfer[j, i]
            if first[j] > 0 and first[j] + width <= half:
                for q in range(width):
                    spectrum[i, first[j] + q] += weight[j, q] * c
                continue
            for q in range(width):
                place = (first[j] + q) % size
                value = weight[j, q] * c
                if place == 0 or place == half:
                    spectrum[i, place] += 2.0 * value.real
                elif place < half:
                    spectrum[i, place] += value
                else:
                    spectrum[i, size - place] += value.conjugate()


@njit(cache=True, nogil=True)
def _gather(wrapped, middle, correction, out):
    """Unwrap the periodic series (m, size), divide the window out, and turn it to (count, m)."""
    size = wrapped.shape[1]
    for p in range(out.shape[0]):
        k = p - middle
        if k < 0:
            k += size
        for i in range(out.shape[1]):
            out[p, i] = wrapped[i, k] * correction[p]
