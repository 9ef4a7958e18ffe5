"""Waves outside the unit hemisphere: the wave source multipole and the wave-free multipoles of each azimuthal mode.

Deep water, lengths in the control radius, time in sqrt(Rc / g); y = r cos(theta) is the depth, R = r sin(theta) the distance
from the vertical axis. Real parts of f(r, theta) exp(-i omega t), k0 = omega^2; on the surface phi_y + k0 phi = 0.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.special
from numpy.typing import NDArray

from ogilvie.bem.outer_functions import gauss

Array = NDArray[Any]

_SMALLEST = 1e-9  # of the wave numbers on the ray: the integrand of S_m is at most of order k there
_PER_PANEL = 16
_GROWTH, _LONGEST = 1.75, 8.0  # of the panels: ratio of neighbours, greatest length
_STEEP = np.pi / 4  # from here on the Hankel function on the ray k = tau exp(i theta)
_TURN = np.pi / 12  # of the ray nearer to the axis


@dataclass(frozen=True, eq=False)
class WaveSource:
    """Table from which the wave source multipole and its radial derivative follow at r = 1 for any frequency.

    Attributes
    ----------
    m : int
    x : (n,) array
        cos(theta), 0 < x < 1.
    tau : (n_k,) array
        Wave numbers on the ray, without their direction.
    turn : (n,) array
        Angle of the ray of each point.
    value, slope : (n, n_k) complex array
        Integrands without 1/(k - k0), weights included.
    """

    m: int
    x: Array
    tau: Array
    turn: Array
    value: Array
    slope: Array

    def at(self, k0: float) -> tuple[Array, Array]:
        """Return S_m and dS_m/dr (n,) complex at wave number k0 > 0.

        Notes
        -----
            S_m = 1/(2m-1)!! { PV int_0^inf k^(m+1)/(k - k0) exp(-k y) J_m(k R) dk + i pi k0^(m+1) exp(-k0 y) J_m(k0 R) }
        """
        m, x = self.m, self.x
        R = np.sqrt(1.0 - x * x)
        pole = 1.0 / (self.tau * np.exp(1j * self.turn)[:, None] - k0)
        principal = np.einsum("xk,xk->x", self.value, pole).real
        principal_r = np.einsum("xk,xk->x", self.slope, pole).real
        rise = np.pi * k0 ** (m + 1) / double_factorial(m) * np.exp(-k0 * x)
        J, dJ = scipy.special.jv(m, k0 * R), scipy.special.jvp(m, k0 * R)
        far = np.arccos(x) >= _STEEP
        Y, dY = scipy.special.yv(m, k0 * R[far]), scipy.special.yvp(m, k0 * R[far])
        principal[far] -= rise[far] * Y
        principal_r[far] -= k0 * rise[far] * (R[far] * dY - x[far] * Y)
        return principal + 1j * rise * J, principal_r + 1j * k0 * rise * (R * dJ - x * J)


def wave_source(m: int, x: Array) -> WaveSource:
    """Return the table of the wave source multipole of mode m at the points x = cos(theta) of the unit hemisphere.

    Notes
    -----
    The integral is taken on a ray k = tau exp(i alpha). From theta = pi/4 on J_m is the real part of H_m (first kind), which
    decays upwards in k: on alpha = theta the integrand falls as exp(-tau), and half the residue at k0 adds
    -pi k0^(m+1) exp(-k0 y) Y_m(k0 R). Nearer to the axis J_m itself stays on the ray alpha = pi/12, where it falls as
    exp(-tau cos(theta + alpha)) and half the residue is imaginary. The derivative in r is k d/dk of exp(-k y) J_m(k R).
    """
    x = np.asarray(x, dtype=float)
    theta = np.arccos(x)
    far = theta >= _STEEP
    turn = np.where(far, theta, _TURN)
    tau, weight = _ray(4.0 * (m + 1) + 120.0)
    k = tau * np.exp(1j * turn)[:, None]
    R = np.sqrt(1.0 - x * x)
    z = k * R[:, None]
    f, df = np.empty_like(k), np.empty_like(k)  # exp(-k y) C_m(k R) and its derivative in k R, times exp(k y)
    for near_or_far, function in ((far, scipy.special.hankel1e), (~far, scipy.special.jve)):
        at = z[near_or_far]
        f[near_or_far] = function(m, at)
        df[near_or_far] = function(m - 1, at) - m / at * f[near_or_far]
    grow = np.where(far[:, None], 1j * z, np.abs(z.imag))  # what the scaled functions left out
    factor = np.exp(-k * x[:, None] + grow) * k ** (m + 1) * weight * np.exp(1j * turn)[:, None] / double_factorial(m)
    return WaveSource(m, x, tau, turn, factor * f, factor * (z * df - k * x[:, None] * f))


def _ray(last: float) -> tuple[Array, Array]:
    """Gauss points and weights from 0 to `last`, on panels that grow with k up to the length that a wave allows."""
    growing = _SMALLEST * _GROWTH ** np.arange(np.log(_LONGEST / (_GROWTH - 1) / _SMALLEST) / np.log(_GROWTH))
    edges = np.concatenate([[0.0], growing, np.arange(growing[-1] + _LONGEST, last + _LONGEST, _LONGEST)])
    u, w = gauss(_PER_PANEL)
    length = np.diff(edges)
    return (edges[:-1, None] + length[:, None] * u).ravel(), (length[:, None] * w).ravel()


def double_factorial(m: int) -> float:
    """Return (2m - 1)!!, 1 for m = 0.

    Examples
    --------
    >>> double_factorial(3)
    15.0
    """
    return float(np.prod(np.arange(1.0, 2 * m, 2)))
