"""What a steady speed does to the fluid's momentum, added mass, damping and diffraction force (kernel; exp(+i omega t)).

In axes that advance with the mean speed U the body's velocity relative to the water is nu = xi' - U L xi: with the bow down
(pitch) it moves upwards across its own axis, with the bow to port (yaw) to starboard. With the fluid's momentum
p = T nu, T = A + B/s, s = i omega, the force on the body is F = -(d/dt + U L^T) p, hence

    T_U = (1 + U L^T/s) T (1 - U L/s).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

#: What relates rotation and speed: L[sway, yaw] = 1, L[heave, pitch] = -1.
_ENTRIES = (("sway", "yaw", 1.0), ("heave", "pitch", -1.0))
#: Singular values below this part of the largest count as zero: a body of revolution has no added mass about its axis.
_RANK = 1e-9


def speed_matrix(dofs: Sequence[str]) -> Array | None:
    """Return L (n, n) for these degrees of freedom; None where pitch is found without heave, or yaw without sway.

    Examples
    --------
    >>> speed_matrix(("heave", "pitch"))
    array([[ 0., -1.],
           [ 0.,  0.]])
    """
    names = list(dofs)
    L = np.zeros((len(names), len(names)))
    for row, column, value in _ENTRIES:
        if column in names:
            if row not in names:
                return None
            L[names.index(row), names.index(column)] = value
    return L


def momentum_at_speed(T: Complex, omega: ArrayLike, speed: float, L: Array) -> Complex:
    """Return T_U (..., n, n) = (1 + U L^T/s) T (1 - U L/s) with s = i omega.

    Parameters
    ----------
    T : (..., n, n) complex array
        A + B/(i omega) at zero speed.
    omega : (...) array
        Signed frequency of oscillation, rad/s, not zero.
    speed : float
        U, m/s. With -U and T_U in place of T the result is T: L L = 0, so each factor is the inverse of its opposite.
    L : (n, n) array

    Examples
    --------
    >>> L = speed_matrix(("heave", "pitch"))
    >>> T = np.diag([2.0, 3.0]) + 0j
    >>> momentum_at_speed(T, 1.0, 0.5, L).real  # A55 + U^2 A33/omega^2
    array([[2. , 0. ],
           [0. , 3.5]])
    """
    u = speed / (1j * np.asarray(omega, dtype=float))[..., None, None]
    one = np.eye(len(L))
    return (one + u * L.T) @ T @ (one - u * L)


def split(T: Complex, omega: Array) -> tuple[Array, Array]:
    """Return A = Re T and B = -omega Im T (..., n, n)."""
    return T.real, -omega[..., None, None] * T.imag


@dataclass(frozen=True, eq=False)
class FluidMomentum:
    """Momentum of the fluid per unit velocity of the body, T(omega) = A + B/(i omega), at zero speed.

    Parameters
    ----------
    omega : (n_w,) array
        rad/s, ascending, > 0.
    T : (n_w, n, n) complex array
    A_inf : (n, n) array or None

    Notes
    -----
    Between the frequencies Re T and Im T are interpolated monotonically (PCHIP: continuous slope). Below the first A is
    kept and Im T falls to zero. Above the last A goes to A_inf (where known, else it is kept) and Im T to zero as omega^-2.
    T(-omega) is the conjugate of T(omega).
    """

    omega: Array
    T: Complex
    A_inf: Array | None = None

    def at(self, omega: ArrayLike) -> Complex:
        """Return T (..., n, n) at signed frequencies (...), rad/s.

        Examples
        --------
        >>> A, B = np.ones((3, 1, 1)), np.array([1.0, 3.0, 4.0])[:, None, None]
        >>> w = np.array([1.0, 2.0, 3.0])
        >>> fluid = FluidMomentum(w, A + B / (1j * w[:, None, None]))
        >>> fluid.at([2.0, -2.0, 0.0])[:, 0, 0]
        array([1.-1.5j, 1.+1.5j, 1.+0.j ])
        """
        x = np.asarray(omega, dtype=float)
        w, last = np.abs(x), self.omega[-1]
        both = self._curves(np.minimum(w, last))  # (..., 2, n, n)
        A, D = both[..., 0, :, :], both[..., 1, :, :]
        fade = (last / np.maximum(w, last))[..., None, None] ** 2
        if self.A_inf is not None:
            A = np.where(fade < 1.0, self.A_inf + (A - self.A_inf) * fade, A)
        return A + 1j * np.sign(x)[..., None, None] * D * fade

    @cached_property
    def _curves(self) -> Callable[[Array], Array]:
        from scipy.interpolate import PchipInterpolator

        both = np.stack([self.T.real, self.T.imag], axis=1)
        start = both[:1] * np.array([1.0, 0.0])[:, None, None]
        curves: Callable[[Array], Array] = PchipInterpolator(np.r_[0.0, self.omega], np.concatenate([start, both]))
        return curves


def fluid_momentum(hydro: xr.Dataset, *, speed: float = 0.0, L: Array | None = None) -> FluidMomentum:
    """Return the zero-speed momentum of a data set; of one at `speed` with the terms of speed taken off by means of L."""
    omega = hydro.omega.values
    T = hydro.added_mass.values + hydro.radiation_damping.values / (1j * omega[:, None, None])
    if speed != 0.0 and L is not None:
        T = momentum_at_speed(T, omega, -speed, L)
    A_inf = hydro.added_mass_inf.values if "added_mass_inf" in hydro else None
    return FluidMomentum(omega, T, A_inf)


def diffraction_at_speed(
    X: Complex, *, omega: Array, encounter: Array, T: Complex, T_encounter: Complex, speed: float | Array, L: Array
) -> Complex:
    """Return the diffraction force (..., n) at speed from that at zero speed.

    Parameters
    ----------
    X : (..., n) complex array
        Diffraction force at zero speed, at the frequency of the incident wave.
    omega, encounter : (...) array
        Frequency of the incident wave and signed frequency of encounter, rad/s.
    T, T_encounter : (..., n, n) complex array
        Zero-speed momentum at omega and at the frequency of encounter.
    speed : float or (...) array
    L : (n, n) array

    Notes
    -----
    At zero speed X = i omega T(omega) v: v is the velocity of the body in calm water that gives the momentum which the passing
    wave takes. The wave's motion along the hull does not depend on the speed, so at speed

        X_U = (i omega_e + U L^T) T(omega_e) v = (i omega_e + U L^T) T(omega_e) T(omega)^-1 X/(i omega),

    regular at omega_e = 0. What T(omega) cannot give (its null space) keeps the T of omega.
    """
    moved = _carried(X, T, T_encounter)
    U = np.asarray(speed, dtype=float)[..., None]
    return (1j * encounter[..., None] * moved + U * (moved @ L)) / (1j * omega[..., None])


def diffraction_at_rest(
    X: Complex, *, omega: Array, encounter: Array, T: Complex, T_encounter: Complex, speed: float, L: Array
) -> Complex:
    """Return the inverse of :func:`diffraction_at_speed`; the frequency of encounter must not be zero."""
    s = 1j * encounter[..., None]
    moved = 1j * omega[..., None] / s * (X - speed / s * (X @ L))
    return _carried(moved, T_encounter, T)


def _carried(X: Complex, T: Complex, T_new: Complex) -> Complex:
    """Return T_new T^-1 X (..., n)."""
    d = np.sqrt(np.abs(np.diagonal(T, axis1=-2, axis2=-1)))
    d = np.where(d > 0.0, d, 1.0)
    scaled = T / (d[..., :, None] * d[..., None, :])
    velocity = (np.linalg.pinv(scaled, rcond=_RANK) @ (X / d)[..., None])[..., 0] / d
    return X + ((T_new - T) @ velocity[..., None])[..., 0]
