"""Roll damping by coefficients: linear, quadratic and cubic in the roll velocity."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import Surroundings, Terms, viscous_effect
from ogilvie.loads.given import number
from ogilvie.loads.kernel import NU_R, Kernel, load_kernel
from ogilvie.loads.viscous import quadratic_effect

Array = NDArray[Any]

ROLL = 3


class Coefficient(Protocol):
    """Anything with a value, such as an Estimate."""

    @property
    def value(self) -> float: ...


class Decay(Protocol):
    """Anything with the damping coefficients of a free decay in roll, such as a DecayAnalysis."""

    @property
    def linear(self) -> Coefficient: ...

    @property
    def quadratic(self) -> Coefficient: ...

    @property
    def cubic(self) -> Coefficient: ...

    @property
    def inertia(self) -> float | None: ...


@load_kernel
def roll_polynomial(x: Array, data: Array, own: Array, force: Array) -> None:
    """Roll moment ``-(b2 |p| + b3 p^2) p`` with data (b2, b3)."""
    p = x[NU_R + 3]
    force[3] -= (data[0] * abs(p) + data[1] * p * p) * p


@dataclass(frozen=True, eq=False, init=False)
class RollDamping:
    """Roll moment ``-B1 p - B2 |p| p - B3 p^3``.

    Parameters
    ----------
    linear, quadratic, cubic : float
        B1 (N m s), B2 (N m s2) and B3 (N m s3), or all three per unit of inertia where `inertia` is given.
    ratio : float, optional
        Linear part as a fraction of critical damping, in place of `linear`.
    inertia : float, optional
        Moment of inertia with added mass, kg m2, that the three coefficients are multiplied with: for the coefficients of a
        decay analysis that did not know it.

    Raises
    ------
    InputError
        Nothing given, both `linear` and `ratio`, NaN, negative linear, quadratic or cubic coefficient (a negative one drives
        the motion at some amplitude).

    Notes
    -----
    The coefficients of a free decay hold all of its damping, that of the radiated waves included. With a radiation load in the
    vessel the wave part at the natural frequency is to be taken off the linear one; :meth:`from_decay` does so.

    References
    ----------
    ITTC Recommended Procedure 7.5-02-07-04.5, Numerical estimation of roll damping, equations of nonlinear damping.

    Examples
    --------
    >>> load = RollDamping(linear=2e7, quadratic=5e8)
    >>> sorted(load.covers)
    ['nonlinear viscous damping of roll', 'viscous damping of roll']
    >>> round(float(load.equivalent(amplitude=0.2, omega=0.5)) / 1e6, 3)  # 20 + 8 / (3 pi) 500 0.1
    62.441
    """

    linear: float
    quadratic: float
    cubic: float
    ratio: float
    name: str = "roll_damping"

    def __init__(
        self,
        *,
        linear: float = 0.0,
        quadratic: float = 0.0,
        cubic: float = 0.0,
        ratio: float | None = None,
        inertia: float | None = None,
    ) -> None:
        factor = 1.0 if inertia is None else number(inertia, "RollDamping: inertia (kg m2)", above=0.0)
        values = {"linear": linear, "quadratic": quadratic, "cubic": cubic}
        for key, value in values.items():
            object.__setattr__(self, key, factor * number(value, f"RollDamping: {key}", least=0.0))
        object.__setattr__(self, "ratio", 0.0 if ratio is None else number(ratio, "RollDamping: ratio", least=0.0))
        object.__setattr__(self, "name", "roll_damping")
        if ratio is not None and self.linear > 0.0:
            raise InputError("RollDamping: linear or ratio expected, both found.")
        if not (self.linear or self.quadratic or self.cubic or self.ratio):
            raise InputError("RollDamping: a coefficient > 0 expected (linear or ratio, quadratic, cubic), none found.")

    @classmethod
    def from_decay(cls, found: Decay, *, wave: float = 0.0) -> "RollDamping":
        """Return the damping that a decay analysis found.

        Parameters
        ----------
        found : DecayAnalysis
            Of :func:`ogilvie.decay` with `inertia` or `stiffness` given, so that its coefficients are in SI.
        wave : float
            Radiation damping of roll at the natural frequency, N m s, taken off the linear coefficient for a vessel with a
            radiation load.

        Raises
        ------
        InputError
            Coefficients per unit of inertia, a coefficient below zero, more wave damping than the linear coefficient.
        """
        if found.inertia is None:
            raise InputError("RollDamping: a decay analysis with inertia (or stiffness) given expected, found one without.")
        linear = found.linear.value - number(wave, "RollDamping: wave (N m s)", least=0.0)
        if linear < 0.0:
            raise InputError(
                f"RollDamping: wave damping of at most the linear coefficient of the decay expected, {wave:.4g} with "
                f"{found.linear.value:.4g} N m s found. Check the natural frequency of the radiation data."
            )
        return cls(linear=linear, quadratic=found.quadratic.value, cubic=found.cubic.value)

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for: the linear part, the rest, or both."""
        first = {viscous_effect("roll")} if self.linear or self.ratio else set()
        return frozenset(first | ({quadratic_effect("roll")} if self.quadratic or self.cubic else set()))

    def equivalent(self, *, amplitude: ArrayLike, omega: ArrayLike) -> Any:
        """Return the linear coefficient (N m s) that takes the same energy per cycle at an amplitude (rad), omega (rad/s).

        Notes
        -----
        B1 + 8/(3 pi) B2 omega a + 3/4 B3 omega^2 a^2, without the part given as a ratio.
        """
        wa = np.asarray(omega, dtype=float) * np.asarray(amplitude, dtype=float)
        return self.linear + 8.0 / (3.0 * np.pi) * self.quadratic * wa + 0.75 * self.cubic * wa**2

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays and the compiled force for the time loop."""
        D, z = np.zeros((6, 6)), np.zeros(6)
        D[ROLL, ROLL], z[ROLL] = self.linear, self.ratio
        kernel = Kernel(roll_polynomial, np.array([self.quadratic, self.cubic])) if self.quadratic or self.cubic else None
        small = None if kernel is None else Terms(damping=D, damping_ratio=z)
        return Terms(damping=D, damping_ratio=z, kernel=kernel, small=small)
