"""What the oscillator form is fitted to: added mass and damping, and what makes their errors matter."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.memory.resonances import Resonances, find_resonances
from ogilvie.memory.retardation import Retardation

Array = NDArray[Any]

_TAIL_TRUST = 0.005  # error of the tail, in parts of K, at which the weight of K(t) is a quarter
_LEFT_TRUST = 0.1  # damping at the last frequency, in parts of its peak, at which it is so
_FARTHEST, _N_BEYOND = 6.0, 12  # times the last frequency, and frequencies up to there
_FEWEST = 4  # frequencies
_LOSS = 0.01  # of inertia and stiffness in the compliance
_ZERO = 1e-3  # of sqrt(spread_ii spread_jj): a coupling below it is zero by symmetry


@dataclass(frozen=True, eq=False)
class Beyond:
    """K_hat (n_b, m, m) at frequencies omega (n_b,) beyond the data, and the trust (m, m) in K(t) of each coupling, 0 to 1."""

    omega: Array
    K_hat: Array
    trust: Array


@dataclass(frozen=True, eq=False)
class Target:
    """Radiation data of one block of m coupled degrees of freedom, scaled so that all are of order one.

    Attributes
    ----------
    omega : (n_w,) array
    A, B : (n_w, m, m) array
        Added mass and damping.
    A_inf : (m, m) array
        Added mass at infinite frequency or a first guess of it.
    A_inf_given : bool
    weight : (m, m) array
        Of each coupling in the residuals of A and B; 0 where it is zero by symmetry.
    K_initial : (m, m) array
        K(0+), an estimate: it keeps the model from inventing fast memory beyond the last frequency.
    compliance : (n_w, m, m) complex array, optional
        X = compliance F of the free-floating body; the fit then weighs the change of the motion, -i omega compliance dK_hat X.
    resonances : Resonances, optional
        Of the free-floating body; the fit then weighs damping and natural frequency there.
    beyond : Beyond, optional
        Where the tail of the damping is well known: the fit then weighs K(t) itself.
    """

    omega: Array
    A: Array
    B: Array
    A_inf: Array
    A_inf_given: bool
    weight: Array
    K_initial: Array
    compliance: Array | None = None
    resonances: Resonances | None = None
    beyond: Beyond | None = None


def target_of(
    K: Retardation, dofs: list[int], mass: Array | None = None, stiffness: Array | None = None
) -> tuple[Target, Array]:
    """Return the target of the block of these degrees of freedom and the scale (m,) of each."""
    omega, A, B = radiation_data(K)
    where = np.ix_(dofs, dofs)
    a, b = A[:, dofs][:, :, dofs], B[:, dofs][:, :, dofs]
    weigh = np.diag(mass[where]) if mass is not None else np.zeros(len(dofs))
    scale = np.sqrt(weigh + np.abs(np.einsum("wii->i", a)) / len(omega))
    square = np.outer(scale, scale)
    a, b = a / square, b / square
    spread = np.maximum(b.std(axis=0), 1e-300)
    weight = (spread > _ZERO * np.sqrt(np.outer(np.diag(spread), np.diag(spread)))).astype(float)
    A_inf, K_initial = _symmetric(K.A_inf[where]) / square, _symmetric(K.K[0][where]) / square
    compliance, resonances, beyond = None, None, None
    if mass is not None and stiffness is not None:
        M, C = mass[where] / square, stiffness[where] / square
        compliance, resonances = floating_compliance(omega, M + a, b, C), find_resonances(omega, a, b, M, C)
    else:
        beyond = _beyond(K, omega, b, where, square, weight > 0)
    return Target(omega, a, b, A_inf, K.A_inf_given, weight, K_initial, compliance, resonances, beyond), scale


def check_spectrum(K: Retardation) -> None:
    """Raise InputError where the added mass and damping behind K cannot be fitted: shapes, frequencies, NaN, nothing left."""
    if K.omega is None or K.added_mass is None or K.radiation_damping is None:
        return
    n, m = len(K.omega), len(K.dofs)
    mask = np.ones(n, dtype=bool) if K.mask is None else np.asarray(K.mask)
    shapes = [np.shape(x) for x in (K.added_mass, K.radiation_damping, mask)]
    if shapes != [(n, m, m), (n, m, m), (n,)]:
        raise InputError(f"identify: added mass and damping ({n}, {m}, {m}) and a mask ({n},) expected, {shapes} found.")
    omega, B = K.omega[mask], K.radiation_damping[mask]
    if len(omega) < _FEWEST:
        raise InputError(f"identify: at least {_FEWEST} frequencies expected, {len(omega)} found: the whole curve is needed.")
    if not (np.all(np.isfinite(omega)) and omega[0] > 0.0 and np.all(np.diff(omega) > 0.0)):
        raise InputError("identify: frequencies must be positive and ascending; sort them and leave zero and infinity out.")
    if not (np.all(np.isfinite(K.added_mass[mask])) and np.all(np.isfinite(B))):
        raise InputError("identify: finite added mass and damping expected, NaN or infinite found; mask such frequencies.")
    if not np.any(B):
        raise InputError("identify: the damping is zero at all frequencies; there is no fluid memory to model.")


def radiation_data(K: Retardation) -> tuple[Array, Array, Array]:
    """Return frequencies, added mass and damping to be fitted: the data that K was made from, or the transform of K itself."""
    if K.omega is not None and K.added_mass is not None and K.radiation_damping is not None:
        mask = np.ones(len(K.omega), dtype=bool) if K.mask is None else K.mask
        return K.omega[mask], _symmetric(K.added_mass[mask]), _symmetric(K.radiation_damping[mask])
    size = np.abs(np.einsum("tii->ti", K.transform(np.linspace(0.0, np.pi / K.dt / 4, 400))))
    alive = np.flatnonzero((size > 0.02 * size.max(axis=0)).any(axis=1))
    omega = np.linspace(0.0, np.pi / K.dt / 4, 400)[: alive[-1] + 2][1:]
    omega = np.linspace(omega[-1] / 80, omega[-1], 80)
    K_hat = K.transform(omega)
    return omega, _symmetric(K.A_inf + K_hat.imag / omega[:, None, None]), _symmetric(K_hat.real)


def _symmetric(x: Array) -> Array:
    """Radiation is reciprocal at zero speed; what differs between ij and ji is error of the panel method."""
    return (x + np.swapaxes(x, -1, -2)) / 2


def _beyond(K: Retardation, omega: Array, B: Array, where: Any, square: Array, used: Array) -> Beyond | None:
    """K_hat beyond the data and the trust in K(t), which falls with what is not known of it: the tail and what leads to it."""
    error = np.zeros(B.shape[1:]) if K.tail_error is None else np.nan_to_num(_symmetric(K.tail_error)[where], nan=np.inf)
    left = np.abs(B[-1]) / np.abs(B).max(axis=0)
    trust = used / (1 + (error / _TAIL_TRUST) ** 2 + (left / _LEFT_TRUST) ** 2)
    trust = np.where(trust < 0.02, 0.0, trust)
    if not np.any(trust):
        return None
    at = omega[-1] * np.geomspace(1.0, _FARTHEST, _N_BEYOND + 1)[1:]
    at = at[at < np.pi / K.dt / 2]
    return Beyond(at, _symmetric(K.transform(at))[(slice(None), *where)] / square, trust)


def floating_compliance(omega: Array, M: Array, B: Array, C: Array) -> Array:
    """Return X (n_w, m, m) of a floating body, M with added mass (n_w, m, m).

    A loss of 1 % of inertia and stiffness keeps one resonance from ruling the fit.
    """
    w = omega[:, None, None]
    loss = np.zeros_like(M)
    i = np.arange(len(C))
    loss[:, i, i] = _LOSS * (np.abs(np.diag(C)) + omega[:, None] ** 2 * np.abs(M[:, i, i]))
    return np.linalg.inv(-(w**2) * M + 1j * (w * B + loss) + C)
