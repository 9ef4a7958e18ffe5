"""Roll damping by Ikeda's method as a load: linear at one amplitude, or as a polynomial of the roll velocity."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import RADIATION, Surroundings, Terms, viscous_effect
from ogilvie.loads.given import number
from ogilvie.loads.ikeda import IkedaHull
from ogilvie.loads.kernel import Kernel
from ogilvie.loads.roll_damping import ROLL, roll_polynomial
from ogilvie.loads.viscous import quadratic_effect

Array = NDArray[Any]

_TERMS = {"linear": 1, "quadratic": 2, "cubic": 3}
_AMPLITUDES = np.linspace(0.1, 1.0, 19)  # of the fit, over the largest


@dataclass(frozen=True, eq=False, init=False)
class IkedaRollDamping:
    """Roll moment by Ikeda's method at the vessel's speed.

    Parameters
    ----------
    hull : IkedaHull
    omega : float
        Frequency of roll, rad/s: the natural one.
    amplitude : float
        Of roll, rad: that of the linear model, the largest of the others.
    model : {"cubic", "quadratic", "linear"}
        "cubic": ``-B1 p - B2 |p| p - B3 p^3``, fitted to the equivalent damping at amplitudes from a tenth of `amplitude` up;
        "quadratic": without B3; "linear": the equivalent damping at `amplitude`.
    wave : float, optional
        Wave damping of roll at zero speed and `omega`, N m s, for a vessel without a radiation load. By default there is none.

    Raises
    ------
    InputError
        A number out of its range, unknown model.

    Notes
    -----
    The fit minimises the sum of squares of B1 + 8/(3 pi) B2 omega a + 3/4 B3 (omega a)^2 - B(a) with no coefficient below zero.
    Bilge keels make B(a) grow faster than linearly, so that the quadratic model, without B3, can end up with B1 = 0. The moment
    is a couple, the same about O as about the roll axis. See :meth:`IkedaHull.components` for the formulas.

    Examples
    --------
    >>> from ogilvie.mesh.s175 import s175
    >>> ship = IkedaHull.from_hull(s175(panels=600), cog=[-2.5, 0.0, 0.05], keels=(-26.0, 26.0, 0.35))
    >>> load = IkedaRollDamping(ship, omega=0.33, amplitude=0.3)
    >>> bool(min(load.coefficients(speed=0.0)) > 0.0)
    True
    """

    hull: IkedaHull
    omega: float
    amplitude: float
    model: str
    wave: float
    name: str = "roll_damping"

    def __init__(
        self,
        hull: IkedaHull,
        *,
        omega: float,
        amplitude: float,
        model: Literal["cubic", "quadratic", "linear"] = "cubic",
        wave: float | None = None,
    ) -> None:
        if model not in _TERMS:
            raise InputError(f"IkedaRollDamping: model 'cubic', 'quadratic' or 'linear' expected, {model!r} found.")
        values = {
            "hull": hull,
            "omega": number(omega, "IkedaRollDamping: omega (rad/s)", above=0.0),
            "amplitude": number(amplitude, "IkedaRollDamping: amplitude (rad)", above=1e-5),
            "model": model,
            "wave": 0.0 if wave is None else number(wave, "IkedaRollDamping: wave (N m s)", least=0.0),
            "name": "roll_damping",
        }
        for key, value in values.items():
            object.__setattr__(self, key, value)

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        viscous = {viscous_effect("roll"), quadratic_effect("roll")}
        return frozenset(viscous | {RADIATION} if self.wave > 0.0 else viscous)

    def coefficients(self, *, speed: float) -> tuple[float, float, float]:
        """Return B1 (N m s), B2 (N m s2) and B3 (N m s3) at a speed (m/s); those that the model does not have are zero."""
        from scipy.optimize import nnls

        ends = np.array([1.0]) if self.model == "linear" else _AMPLITUDES
        a = self.amplitude * ends
        B = self.hull.components(amplitude=a, omega=self.omega, speed=speed, wave=self.wave).total
        columns = np.stack([ends**k for k in range(_TERMS[self.model])], axis=1)
        scale, rate = float(np.abs(B).max()), self.omega * self.amplitude
        found = np.zeros(3)
        found[: columns.shape[1]] = nnls(columns, B / scale)[0] * scale
        B1, B2, B3 = (float(b) for b in found / [1.0, 8.0 / (3.0 * np.pi) * rate, 0.75 * rate**2])
        return B1, B2, B3

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays and the compiled force for the time loop, at the vessel's speed."""
        B1, B2, B3 = self.coefficients(speed=surroundings.speed)
        D = np.zeros((6, 6))
        D[ROLL, ROLL] = B1
        kernel = Kernel(roll_polynomial, np.array([B2, B3])) if B2 > 0.0 or B3 > 0.0 else None
        return Terms(damping=D, kernel=kernel, small=None if kernel is None else Terms(damping=D))
