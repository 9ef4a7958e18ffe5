"""What a free decay says: estimates with their intervals, cycle by cycle figures, a printed table."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.hydro.schema import DOFS

Array = NDArray[Any]

_ROWS = 14  # of the printed table at most
_UNITS = {
    True: {"linear": ("1/s", "kg m2/s"), "quadratic": ("1/rad", "kg m2"), "cubic": ("s/rad2", "kg m2 s")},
    False: {"linear": ("1/s", "kg/s"), "quadratic": ("1/m", "kg/m"), "cubic": ("s/m2", "kg s/m2")},
}


@dataclass(frozen=True)
class Estimate:
    """A value and the half width of its 95 % confidence interval."""

    value: float
    error: float = 0.0

    def __str__(self) -> str:
        return f"{self.value:.5g} +- {self.error:.2g}"


@dataclass(frozen=True, eq=False)
class DecayAnalysis:
    """What a free decay says about period and damping; made by :func:`ogilvie.post.decay.decay`.

    Parameters
    ----------
    dof : str
    model : str
        Damping terms.
    t, x : (n,) array
        The part of the series that was analysed, s and m or rad.
    fit : (n,) array
        The simulated decay that fits it best, offset included.
    natural_frequency : Estimate
        Undamped, of small motions, rad/s.
    linear, quadratic, cubic : Estimate
        Damping coefficients, SI; per unit of inertia where `inertia` is None. Zero where the model does not have the term.
    stiffening : Estimate
        e of the restoring omega^2 (x + e x^3), 1/rad2 or 1/m2.
    offset, drift : Estimate
        Rest position at the first time and its rate.
    inertia : float or None
        Mass with added mass that the coefficients are multiplied with, SI.
    peak_time, peak : (n_p,) array
        Extrema, one per half cycle, offset removed.
    time, amplitude, period, damping_ratio : (n_p - 2,) array
        Of the cycle that begins at each extremum but the last two: its middle, mean amplitude, duration and, from the
        logarithmic decrement, fraction of critical damping.
    r2 : float
        Coefficient of determination of the fit.
    independent : float
        Number of independent samples that the residuals amount to; see :func:`ogilvie.post.decay_fit.fit_decay`.
    notes : tuple of str
        What the user should know about the analysis.
    """

    dof: str
    model: str
    t: Array
    x: Array
    fit: Array
    natural_frequency: Estimate
    linear: Estimate
    quadratic: Estimate
    cubic: Estimate
    stiffening: Estimate
    offset: Estimate
    drift: Estimate
    inertia: float | None
    peak_time: Array
    peak: Array
    time: Array
    amplitude: Array
    period: Array
    damping_ratio: Array
    r2: float
    independent: float
    notes: tuple[str, ...] = field(default=())

    @property
    def natural_period(self) -> float:
        """2 pi / natural frequency, s."""
        return float(2 * np.pi / self.natural_frequency.value)

    def equivalent_damping_ratio(self, amplitude: ArrayLike) -> Array:
        """Return the fraction of critical damping that takes the same energy per cycle at an amplitude (m or rad).

        Notes
        -----
        zeta = (b1 + 8/(3 pi) b2 omega a + 3/4 b3 omega^2 a^2) / (2 omega), b per unit of inertia.
        """
        a, w = np.asarray(amplitude, dtype=float), self.natural_frequency.value
        b = [x.value / (self.inertia or 1.0) for x in (self.linear, self.quadratic, self.cubic)]
        return np.asarray((b[0] + 8 / (3 * np.pi) * b[1] * w * a + 0.75 * b[2] * (w * a) ** 2) / (2 * w))

    def __str__(self) -> str:
        angle, (factor, unit) = _is_angle(self.dof), _shown(self.dof)
        w = self.natural_frequency
        lines = [
            f"Free decay in {self.dof}: {len(self.peak)} extrema, t = {self.t[0]:.5g} to {self.t[-1]:.5g} s",
            f"natural period {2 * np.pi / w.value:.5g} +- {2 * np.pi / w.value**2 * w.error:.2g} s, "
            f"offset {factor * self.offset.value:.3g} +- {factor * self.offset.error:.1g} {unit}; "
            f"R2 of the fit {self.r2:.5f} ({len(self.t)} samples, {self.independent:.0f} independent)",
        ]
        for name in self.model.split("+"):
            lines.append(f"{name + ' damping':18} {getattr(self, name)} {_UNITS[angle][name][self.inertia is not None]}")
        if self.stiffening.error > 0.0:
            lines.append(f"{'stiffening':18} {self.stiffening} {'1/rad2' if angle else '1/m2'}")
        lines.append("  time [s]   amplitude   period [s]  damping ratio   of the fit")
        fitted = self.equivalent_damping_ratio(self.amplitude)
        rows = list(zip(self.time, factor * self.amplitude, self.period, self.damping_ratio, fitted, strict=True))
        for time, amplitude, period, ratio, of_fit in rows[:: -(-len(rows) // _ROWS)]:
            lines.append(f"{time:10.4g} {amplitude:8.3g} {unit:3} {period:12.5g} {ratio:13.3%} {of_fit:12.3%}")
        return "\n".join(lines + [f"note: {n}" for n in self.notes])


def _is_angle(dof: str) -> bool:
    return DOFS.index(dof) > 2


def _shown(dof: str) -> tuple[float, str]:
    return (180 / np.pi, "deg") if _is_angle(dof) else (1.0, "m")
