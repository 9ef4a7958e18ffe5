"""The damping beyond the last frequency: a power law, fitted or prescribed, integrated exactly."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError

Array = NDArray[Any]

TAILS = ("fit", "omega-2", "omega-3", "none")
EXPONENTS = (1.5, 12.0)  # K needs p > 1; steeper than 12 is as good as nothing

# Nodes of the trapezoid rule on x = 1 + i y, y = exp(pi/2 sinh v), and their weights.
_V = np.linspace(-3.6, 4.2, 261)
_Y = np.exp(np.pi / 2 * np.sinh(_V))
_WEIGHT = _Y * np.pi / 2 * np.cosh(_V) * (_V[1] - _V[0])
_LOG_X = np.log(1 + 1j * _Y)


@dataclass(frozen=True)
class Tail:
    """B(omega) = B_N x^-p exp(c (x^-2 - 1)) for x = omega/omega_N > 1, one coupling.

    The factor beside the power is the first term by which B approaches its asymptote: a hemisphere's sway damping is still
    falling as omega^-2.5 where its asymptote omega^-3 is asked for.
    """

    B_N: float
    p: float
    c: float = 0.0

    def integral(self, omega_N: float, t: ArrayLike) -> NDArray[np.complex128]:
        """Return int_{omega_N}^{inf} B(omega) exp(i omega t) d omega, shape (n_t,).

        Examples
        --------
        >>> Tail(1.0, 3.0).integral(2.0, [0.0]).real.round(6)  # omega_N / (p - 1)
        array([1.])
        """
        return tail_integrals([self], omega_N, t)[:, 0]


def tail_integrals(tails: Sequence[Tail], omega_N: float, t: ArrayLike) -> NDArray[np.complex128]:
    """Return :meth:`Tail.integral` of many couplings at once, shape (n_t, n_tails).

    Examples
    --------
    >>> tail_integrals([Tail(1.0, 3.0), Tail(4.0, 2.0)], 1.0, [0.0]).real.round(6)
    array([[0.5, 4. ]])
    """
    p, c, B_N = (np.array([getattr(tail, name) for tail in tails]) for name in ("p", "c", "B_N"))
    log_x = _LOG_X[:, None]
    s = np.atleast_1d(np.asarray(t, dtype=float)) * omega_N
    return omega_N * _fourier(B_N * np.exp(c * (np.exp(-2 * log_x) - 1) - p * log_x), s)


def power_integral(p: Array, s: Array) -> NDArray[np.complex128]:
    """Return int_1^inf x^-p exp(i s x) dx, shape (n_s, n_p), for p > 1 and s >= 0.

    Notes
    -----
    With x = 1 + i y the integral is i exp(i s) int_0^inf (1 + i y)^-p exp(-s y) dy, which neither oscillates nor cancels;
    trapezoid rule after y = exp(pi/2 sinh v). Relative error below 2e-10 for s <= 300.

    Examples
    --------
    >>> power_integral(np.array([3.0]), np.array([0.0])).round(6)
    array([[0.5+0.j]])
    """
    return _fourier(np.exp(-_LOG_X[:, None] * np.asarray(p)), np.asarray(s))


def _fourier(f: Array, s: Array) -> NDArray[np.complex128]:
    """Return int_1^inf f(x) exp(i s x) dx (n_s, n) of f (n_nodes, n) on x = 1 + i y."""
    return 1j * np.exp(1j * s)[:, None] * (np.exp(-np.outer(s, _Y)) @ (_WEIGHT[:, None] * f))


def fit_tail(omega: Array, B: Array, kind: str = "fit", *, share: float = 0.5, power: int = 2) -> Tail | None:
    """Return the tail of one coupling from its damping at omega[-1] and before, or None where there is none.

    Parameters
    ----------
    omega, B : (n_w,) array
        Ascending frequencies, rad/s, and damping.
    kind : {"fit", "omega-2", "omega-3", "none"}
        ``fit``: log |B| = a - p log omega + c omega^-2 over the last `share` of the frequencies. Papers A and D use the others.
    share : float
        Part of the range omega_N that the fit sees.
    power : int
        Exponent of the correction, 2; another one serves to estimate the error.

    Returns
    -------
    Tail or None
        None for ``none``, and for ``fit`` where B changes sign or does not fall: it has no tail that could be fitted.

    Raises
    ------
    InputError
        Unknown kind.
    """
    if kind not in TAILS:
        raise InputError(f"tail: one of {TAILS} expected, {kind!r} found.")
    if kind == "none" or B[-1] == 0.0:
        return None
    if kind != "fit":
        return Tail(float(B[-1]), float(kind[-1]))
    last = omega >= min((1 - share) * omega[-1], omega[max(0, len(omega) - 6)])
    x, b = omega[last] / omega[-1], B[last]
    if np.any(b * np.sign(b[-1]) <= 0.0) or len(b) < 4:
        return None
    p, c = np.linalg.lstsq(np.c_[-np.log(x), x**-power - 1.0, np.ones(len(x))], np.log(np.abs(b)), rcond=None)[0][:2]
    c *= power / 2  # same slope at omega_N
    if p + 2 * c < 0.5 or abs(c) > 3.0 or not EXPONENTS[0] <= p <= EXPONENTS[1]:  # not a tail of that form: a plain power law
        p, c = -float(np.polyfit(np.log(x), np.log(np.abs(b)), 1)[0]), 0.0
    if p < 1.0:
        return None
    return Tail(float(B[-1]), float(np.clip(p, *EXPONENTS)), float(c))
