"""The transfer function of the fluid memory as a convolution; its weights in time are in :mod:`ogilvie.memory.lag`."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.loads.base import MemoryKernel
from ogilvie.memory.fourier import fourier_integral, legendre_pieces

Array = NDArray[Any]


def kernel_transform(kernel: MemoryKernel, omega: Array) -> NDArray[np.complex128]:
    """Return K_hat(i omega) = int_0^T K(t) exp(-i omega t) dt (n, 6, 6) of the same cubic spline that the time loop uses."""
    return np.conj(fourier_integral(kernel.t, legendre_pieces(kernel.t, kernel.K, "spline"), omega))
