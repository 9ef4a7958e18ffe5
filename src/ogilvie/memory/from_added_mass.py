"""K(t) from the added mass: the sine form, integrated exactly piece by piece, with the tail that causality demands."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.curves import RadiationCurves
from ogilvie.memory.fourier import fourier_integral, legendre_pieces
from ogilvie.memory.from_damping import kernel_from_damping
from ogilvie.memory.tail import Tail, power_integral

Array = NDArray[Any]

_STEEP = 4.0  # exponent of B from which on its partner in D is not told from omega^-3
_LOGARITHM = 1e-3  # distance from the exponent 3, where the partner becomes omega^-3 log omega


def kernel_from_added_mass(curves: RadiationCurves, A_inf: Array | None, t: Array, interpolation: str) -> Array:
    """Return K(t) = -(2/pi) int_0^inf omega [A(omega) - A_inf] sin(omega t) d omega, shape (n_t, m, m).

    Parameters
    ----------
    curves : RadiationCurves
    A_inf : (m, m) array
        Added mass at infinite frequency, SI.
    t : (n_t,) array
        Any times >= 0, s.
    interpolation : {"spline", "linear"}
        Of D = omega (A - A_inf) between the frequencies, from D(0) = 0 on.

    Notes
    -----
    K_hat(s) = int_0^inf K exp(-s t) dt = K(0)/s + K'(0)/s^2 + ..., so with s = i omega: D = Im K_hat = -K(0)/omega +
    O(omega^-3) and B = Re K_hat = -K'(0)/omega^2 + .... D falls more slowly than B whatever the body, and the value of the
    integral at t -> 0+ rests on the tail alone, (2/pi) K(0) int sin(omega t)/omega d omega = K(0).

    With x = omega/omega_N > 1 the tail is D = -K(0)/(omega_N x) + c x^-3 + g(x). K(0) = (2/pi) int B d omega, c makes D
    continuous at omega_N, and g is the causal partner of damping that falls as b x^-p: s^-p has Re = cos(p pi/2) omega^-p and
    Im = -sin(p pi/2) omega^-p, hence g = -tan(p pi/2) b (x^-p - x^-3), which for p = 3 is (2/pi) b x^-3 log x. It is left out
    for p >= 4, where K''(0) is finite.

    References
    ----------
    Ogilvie (1964).

    Examples
    --------
    >>> w = np.linspace(0.02, 30.0, 1500)[:, None, None]
    >>> A, B = 2 + (1 - w**2) / (1 + w**2) ** 2, 2 * w**2 / (1 + w**2) ** 2  # of K = (1 - t) exp(-t)
    >>> from ogilvie.memory.curves import continued
    >>> curves, _ = continued(w[:, 0, 0], A, B, ("heave",), "fit")
    >>> kernel_from_added_mass(curves, np.array([[2.0]]), np.array([0.0, 1.0, 2.0]), "spline")[:, 0, 0].round(4) + 0.0
    array([ 1. ,  0. , -0.1353])
    """
    assert A_inf is not None
    w, omega_N = curves.omega_from_zero, curves.omega[-1]
    D = curves.omega[:, None, None] * (curves.A - A_inf)
    data = fourier_integral(w, legendre_pieces(w, curves.from_zero(D), interpolation), t).imag
    K0 = kernel_from_damping(curves, None, np.zeros(1), interpolation)[0]
    return -2 / np.pi * (data + _tail_integrals(curves, D[-1], K0 / omega_N, omega_N * t) * omega_N)


def _tail_integrals(curves: RadiationCurves, D_N: Array, first: Array, s: Array) -> Array:
    """Return int_1^inf D(x) sin(s x) dx (n_s, m, m), D = -first/x + (D_N + first)/x^3 + g(x)."""
    from scipy.special import sici

    out = -first * (np.pi / 2 - sici(s)[0])[:, None, None]
    out += (D_N + first) * power_integral(np.array([3.0]), s).imag[:, :, None]
    slow = [(i, j, x) for i, row in enumerate(curves.tails) for j, x in enumerate(row) if x is not None and x.p < _STEEP]
    if slow:
        rows, columns, tails = zip(*slow, strict=True)
        out[:, rows, columns] += _partner_integrals(tails, s)
    return out


def _partner_integrals(tails: Sequence[Tail], s: Array) -> Array:
    """Return int_1^inf g(x) sin(s x) dx (n_s, n_tails) of the causal partners of damping tails b x^-p."""
    p = np.array([tail.p for tail in tails])
    p = np.where(np.abs(p - 3.0) > _LOGARITHM, p, 3.0 + _LOGARITHM)
    b = np.array([tail.B_N * np.exp(-tail.c) for tail in tails])
    powers = power_integral(np.append(p, 3.0), s).imag
    return -np.tan(p * np.pi / 2) * b * (powers[:, :-1] - powers[:, -1:])
