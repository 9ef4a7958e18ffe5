"""K(t) by sums over equidistant frequencies, as published: to compare with, not to use."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.curves import RadiationCurves

Array = NDArray[Any]


def kernel_by_trapezoid(curves: RadiationCurves, A_inf: Array | None, t: Array, interpolation: str) -> Array:
    """Return K(t) from the damping by the trapezoid rule, shape (n_t, m, m); there is no tail, and K repeats at 2 pi/d_omega.

    Parameters
    ----------
    curves : RadiationCurves
    A_inf : (m, m) array or None
        Not used; every way to K(t) has this signature.
    t : (n_t,) array
    interpolation : {"spline", "linear"}
        Between the data where they are not equidistant multiples of d_omega.

    Notes
    -----
    K = (d_omega/pi) [B_0 + 2 sum_{k=1}^{N-1} B_k cos(k d_omega t) + B_N cos(N d_omega t)] with B_0 = B(0) = 0. In print
    B(0) stands under the cosine of the last term and B(k_max) lacks its d_omega.

    References
    ----------
    Paper A (Yuan 2017), Eq. (9).
    """
    omega, B = _equidistant(curves, curves.B, interpolation)
    weight = np.where(np.arange(len(omega)) < len(omega) - 1, 2.0, 1.0)
    return np.einsum("tw,wij->tij", np.cos(np.outer(t, omega)) * weight, B) * omega[0] / np.pi


def kernel_by_ifft(curves: RadiationCurves, A_inf: Array | None, t: Array, interpolation: str) -> Array:
    """Return K(t) as the inverse discrete Fourier transform of K_hat = B + i omega (A - A_inf), shape (n_t, m, m).

    Parameters
    ----------
    curves : RadiationCurves
    A_inf : (m, m) array
    t : (n_t,) array
        Any times: the transform is evaluated as the trigonometric sum that it is. At the times n pi/omega_N it equals
        ``numpy.fft.irfft`` of the data over d_t = pi/omega_N.
    interpolation : {"spline", "linear"}
        Between the data where they are not equidistant multiples of d_omega.

    Notes
    -----
    K = (d_omega/pi) Re [K_hat_0/2 + sum_{k=1}^{N-1} K_hat_k exp(i k d_omega t) + K_hat_N exp(i N d_omega t)/2], K_hat_0 =
    0. K jumps at t = 0, where a Fourier series takes the mean: half of K(0+), with ripples beside it. It repeats at 2
    pi/d_omega.

    References
    ----------
    Paper A (Yuan 2017), Eq. (8).
    """
    assert A_inf is not None
    K_hat = curves.B + 1j * curves.omega[:, None, None] * (curves.A - A_inf)
    omega, K_hat = _equidistant(curves, K_hat, interpolation)
    weight = np.where(np.arange(len(omega)) < len(omega) - 1, 1.0, 0.5)
    return np.einsum("tw,wij->tij", np.exp(1j * np.outer(t, omega)) * weight, K_hat).real * omega[0] / np.pi


def equidistant_step(curves: RadiationCurves) -> float:
    """Return d_omega: the last frequency over a whole number, close to the spacing where the damping is."""
    return float(curves.omega[-1] / max(1, round(curves.omega[-1] / curves.energetic_step())))


def _equidistant(curves: RadiationCurves, f: Array, interpolation: str) -> tuple[Array, Array]:
    """Return the frequencies k d_omega, k = 1..N, and f there; f(0) = 0."""
    from scipy.interpolate import CubicSpline, interp1d

    step = equidistant_step(curves)
    omega = step * np.arange(1, round(curves.omega[-1] / step) + 1)
    omega[-1] = curves.omega[-1]
    x, y = curves.omega_from_zero, np.concatenate([np.zeros((1, *f.shape[1:])), f])
    through = CubicSpline(x, y, axis=0) if interpolation == "spline" else interp1d(x, y, axis=0)
    return omega, through(omega)
