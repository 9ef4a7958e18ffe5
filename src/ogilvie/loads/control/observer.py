"""Wave filter: the passive observer, which splits a measured position into low-frequency motion, wave motion and bias."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.control.checks import limit, positive, shape_of, vector

Array = NDArray[Any]

#: Blocks of the state, each of n numbers: integral of the wave motion, wave motion, position, bias force, velocity.
XI, WAVE, POSITION, BIAS, VELOCITY, BLOCKS = 0, 1, 2, 3, 4, 5

_PEAK = "WaveFilter: wave_frequency"


@dataclass(frozen=True, eq=False)
class WaveFilter:
    """Passive observer with wave filtering, for :class:`DynamicPositioning` and :class:`Autopilot`.

    Parameters
    ----------
    wave_frequency : float or (n,) array
        Peak frequency w_o of the wave-frequency motion, rad/s: the frequency of encounter where the vessel sails.
    cutoff : float, optional
        w_c, rad/s, > w_o; 1.1 / 0.8976 of w_o where not given (the ratio of the published sea trials).
    wave_damping : float
        Damping ratio l of the wave model, 0 < l < notch_damping: the depth of the notch is l / notch_damping.
    notch_damping : float
        z: the width of the notch.
    bandwidth : float, optional
        w_b, rad/s: the observer follows low-frequency motion up to about here; w_e / 4 where not given, see the notes.
    bias_time : float
        Time constant T_b of the slowly varying force, s; infinity (an integrator) leaves no error under a constant force, a
        finite one an error in proportion to the force over T_b.

    Raises
    ------
    InputError
        Numbers out of range, or an order of frequencies for which the observer is not passive.

    Notes
    -----
    With the innovation y~ = y - eta - xi_2, in axes parallel to the vessel::

        xi_1' = xi_2 + k1 y~                            k1 = -2 (z - l) w_c / w_o
        xi_2' = -w_o^2 xi_1 - 2 l w_o xi_2 + k2 y~      k2 = 2 w_o (z - l)
        eta'  = nu + w_c y~
        b'    = -b / T_b + K3 y~                        K3 = M (w_c / w_e) f w_b^2
        M nu' = -D nu + b + tau + K4 y~                 K4 = M (w_c / w_e) (w_b^2 + 2 w_b f)

    k1 and k2 make the transfer from y to y~, seen without K3 and K4,
    s (s^2 + 2 l w_o s + w_o^2) / ((s^2 + 2 z w_o s + w_o^2)(s + w_c)): a notch at the waves. Well below them the wave
    model takes a constant part of the measurement, so that the cutoff acts as w_e = w_c / (1 + 2 (z - l) w_c / w_o); K3
    and K4 put the slow poles at -f = -(w_e - 2 w_b) and twice -w_b, to first order in w_b / w_o.

    Passive, so that it is stable at every rate of turn, where the phase of the loop, the notch over s times (s + 1/T_b + K3/K4)
    / (s + 1/T_b), stays above -90 deg: so it does with the default numbers. The published order 1/T_b < K3/K4 < w_o < w_c is
    checked here; it is necessary and not always enough (a cutoff close to w_o, a deep notch). Stability at a fixed heading is
    checked when it is bound.

    The step is exact (matrix exponential) for a measurement that is linear between two samples and a force that is held, with
    the heading of the middle of the period: stable at every sampling period for which the observer itself is.

    References
    ----------
    Fossen, Strand (1999), Passive nonlinear observer design for ships using Lyapunov methods: full-scale experiments with a
    supply vessel, Automatica 35(1), 3-16; Fossen (2021), nonlinear passive observer.

    Examples
    --------
    >>> round(WaveFilter(0.8976).cutoff, 3)
    1.1
    """

    wave_frequency: ArrayLike
    cutoff: float | None = field(default=None, kw_only=True)
    wave_damping: float = field(default=0.1, kw_only=True)
    notch_damping: float = field(default=1.0, kw_only=True)
    bandwidth: float | None = field(default=None, kw_only=True)
    bias_time: float = field(default=np.inf, kw_only=True)

    def __post_init__(self) -> None:
        what = "WaveFilter: "
        shape = shape_of(self.wave_frequency, _PEAK)
        peak = np.atleast_1d(vector(self.wave_frequency, shape, _PEAK))
        if len(shape) > 1 or not peak.size or not np.all(peak > 0.0):
            raise InputError(f"{what}wave_frequency: positive numbers (rad/s) expected, {self.wave_frequency!r} found.")
        low, high = float(peak.min()), float(peak.max())
        cutoff = high * 1.1 / 0.8976 if self.cutoff is None else positive(self.cutoff, what + "cutoff", "rad/s")
        z = positive(self.notch_damping, what + "notch_damping", "-")
        l = positive(self.wave_damping, what + "wave_damping", "-")
        T = limit(self.bias_time, what + "bias_time", "s")
        if not l < z:
            raise InputError(f"{what}wave_damping below notch_damping expected, {l:g} and {z:g} found: there is no notch.")
        if not high < cutoff:
            raise InputError(f"{what}cutoff above the wave frequency {high:g} rad/s expected, {cutoff:g} rad/s found.")
        slow = cutoff / (1 + 2 * (z - l) * cutoff / low)  # w_e
        band = slow / 4.0 if self.bandwidth is None else positive(self.bandwidth, what + "bandwidth", "rad/s")
        if not 2.0 * band < slow:
            raise InputError(f"{what}bandwidth below w_e / 2 = {slow / 2:.3g} rad/s expected, {band:g} rad/s found.")
        ratio = (slow - 2 * band) * band / (band + 2 * (slow - 2 * band))
        if not 1.0 / T < ratio < low:
            raise InputError(
                f"{what}1 / bias_time < K3 / K4 < wave_frequency expected for passivity, "
                f"{1 / T:.3g}, {ratio:.3g}, {low:.3g} rad/s found. Change the bandwidth or the bias time."
            )
        for key, value in (("wave_frequency", peak), ("cutoff", cutoff), ("bandwidth", band)):
            object.__setattr__(self, key, value)

    def continuous(self, M: Array, D: Array) -> tuple[Array, Array, Array]:
        """Return F (5 n, 5 n), G (5 n, n), B (5 n, n) of z' = F z + G y + B tau about inertia M and damping D, each (n, n)."""
        n = len(M)
        peak = np.ravel(np.asarray(self.wave_frequency))
        w = vector(peak if peak.size > 1 else peak[0], (n,), _PEAK, fill=True)
        I, Z, inverse = np.eye(n), np.zeros((n, n)), np.linalg.inv(M)
        wc, wb, z, l = float(self.cutoff or 0.0), float(self.bandwidth or 0.0), self.notch_damping, self.wave_damping
        part = 1 + 2 * (z - l) * wc / w  # w_c / w_e
        f = wc / part - 2 * wb
        k3, k4 = part * f * wb**2, part * (wb**2 + 2 * wb * f)
        G = np.vstack([np.diag(-2 * (z - l) * wc / w), np.diag(2 * w * (z - l)), wc * I, M @ np.diag(k3), np.diag(k4)])
        A = np.block(
            [
                [Z, I, Z, Z, Z],
                [-np.diag(w**2), -np.diag(2 * l * w), Z, Z, Z],
                [Z, Z, Z, Z, I],
                [Z, Z, Z, -I / self.bias_time, Z],
                [Z, Z, Z, inverse, -inverse @ D],
            ]
        )
        C = np.hstack([Z, I, I, Z, Z])
        return A - G @ C, G, np.vstack([Z, Z, Z, Z, inverse])

    def step_matrix(self, M: Array, D: Array, period: float) -> Array:
        """Return S (5 n, 8 n) with z(t + T) = S [z(t), y(t), y(t + T), tau], exact for y linear and tau held over the period.

        Raises
        ------
        InputError
            An observer that is not stable about this inertia and damping.
        """
        from scipy.linalg import expm

        F, G, B = self.continuous(M, D)
        decay = float(np.linalg.eigvals(F).real.max())
        if decay >= 0.0:
            raise InputError(
                f"WaveFilter: a stable observer expected, slowest pole {decay:.3g} 1/s found. Lower the bandwidth "
                f"({self.bandwidth:.3g} rad/s) or raise the cutoff ({self.cutoff:.3g} rad/s)."
            )
        n, m = len(M), len(F)
        E = np.zeros((m + 3 * n, m + 3 * n))  # z, tau, y, rise of y over the period
        E[:m] = np.hstack([F, B, G, np.zeros((m, n))])
        E[m + n : m + 2 * n, m + 2 * n :] = np.eye(n) / period
        E = expm(E * period)[:m]
        held, rise = E[:, m + n : m + 2 * n], E[:, m + 2 * n :]
        return np.hstack([E[:, :m], held - rise, rise, E[:, m : m + n]])


@njit(cache=True, nogil=True)
def observer_step(S: Array, n: int, z: Array, y: Array, y_new: Array, tau: Array) -> None:
    """Take the observer state z (5 n,) over one period with the flat matrix S of :meth:`WaveFilter.step_matrix`."""
    m = BLOCKS * n
    old = z[:m].copy()
    for i in range(m):
        s, row = 0.0, i * (m + 3 * n)
        for j in range(m):
            s += S[row + j] * old[j]
        for j in range(n):
            s += S[row + m + j] * y[j] + S[row + m + n + j] * y_new[j] + S[row + m + 2 * n + j] * tau[j]
        z[i] = s


@njit(cache=True, nogil=True)
def planar_observer_step(S: Array, z: Array, y: Array, y_new: Array, tau: Array) -> None:
    """As :func:`observer_step` for surge, sway and yaw: z and y in the world, velocity and tau along the vessel."""
    heading = 0.5 * (y[2] + y_new[2])
    c, s = np.cos(heading), np.sin(heading)
    before, after = y.copy(), y_new.copy()
    for part in (before, after, z[0:3], z[3:6], z[6:9], z[9:12]):
        turn(part, c, -s)
    observer_step(S, 3, z, before, after, tau)
    for part in (z[0:3], z[3:6], z[6:9], z[9:12]):
        turn(part, c, s)


@njit(cache=True, nogil=True)
def turn(vector: Array, c: float, s: float) -> None:
    """Turn the first two numbers by the angle with cosine c and sine s: vessel to world; with -s, world to vessel."""
    x, y = vector[0], vector[1]
    vector[0], vector[1] = c * x - s * y, s * x + c * y
