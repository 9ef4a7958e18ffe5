"""What a retardation function is to the rest of the package: a table K(t) with its added mass and its errors."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.memory.fourier import fourier_integral, legendre_pieces

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Retardation:
    """Retardation functions K(t) of the radiation force -A_inf nu' - int K(t - s) nu(s) ds.

    Parameters
    ----------
    t : (n_t,) array
        Uniform, from 0, s.
    K : (n_t, m, m) array
        Force per velocity and time; SI.
    A_inf : (m, m) array
        Added mass at infinite frequency that goes with K, SI.
    dofs : tuple of str
    truncation_error, tail_error, discretisation_error : (m, m) array
        Estimates as fractions of the largest K_ij: what remains after the last time; what the damping beyond the last frequency
        may change; what the interpolation between frequencies may change. NaN where K_ij is zero.
    consistency_error : (m, m) array
        Largest difference between K from the damping and K from the added mass, in the same measure. Both are exact for a
        causal fluid, so it tells how far the two halves of the data contradict each other (or A_inf, or the tails).
    tail_exponent : (m, m) array
        p of the tail B ~ omega^-p; NaN where there is none.
    A_inf_ogilvie : (m, m) array
        A_inf from Ogilvie's relation, for comparison.
    omega, added_mass, radiation_damping : arrays
        The data that K was made from.
    mask : (n_w,) bool array
        Frequencies that were used.
    A_inf_given : bool
        False where A_inf was estimated from the rest of the data.
    source : str
    notes : tuple of str
        What the user should know about these functions.

    Raises
    ------
    InputError
        t that is not uniform or does not start at 0, wrong shapes, NaN or infinite values.
    """

    t: Array
    K: Array
    A_inf: Array
    dofs: tuple[str, ...] = ("surge", "sway", "heave", "roll", "pitch", "yaw")
    truncation_error: Array | None = None
    tail_error: Array | None = None
    discretisation_error: Array | None = None
    consistency_error: Array | None = None
    tail_exponent: Array | None = None
    A_inf_ogilvie: Array | None = None
    omega: Array | None = None
    added_mass: Array | None = None
    radiation_damping: Array | None = None
    mask: Array | None = None
    A_inf_given: bool = True
    source: str = "given"
    notes: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        t, K, A_inf = (_numbers(name, getattr(self, name)) for name in ("t", "K", "A_inf"))
        m = len(self.dofs)
        if t.ndim != 1 or len(t) < 2 or t[0] != 0.0 or not np.allclose(np.diff(t), t[1], rtol=1e-6, atol=0.0) or t[1] <= 0:
            raise InputError("Retardation: t must be uniform, ascending and start at 0; resample K first.")
        if K.shape != (len(t), m, m) or A_inf.shape != (m, m):
            raise InputError(f"Retardation: K ({len(t)}, {m}, {m}), A_inf ({m}, {m}) expected, {K.shape}, {A_inf.shape} found.")
        if not (np.all(np.isfinite(K)) and np.all(np.isfinite(A_inf))):
            raise InputError("Retardation: finite K and A_inf expected, NaN or infinite found.")
        for name, value in (("t", t), ("K", K), ("A_inf", A_inf)):
            value.setflags(write=False)
            object.__setattr__(self, name, value)

    @property
    def dt(self) -> float:
        """Time step of the table, s."""
        return float(self.t[-1] / (len(self.t) - 1))

    @property
    def duration(self) -> float:
        """Last time of the table, s."""
        return float(self.t[-1])

    @cached_property
    def spline(self) -> Any:
        """Cubic spline through the table: a function of time."""
        from scipy.interpolate import CubicSpline

        return CubicSpline(self.t, self.K, axis=0)

    def transform(self, omega: ArrayLike) -> NDArray[np.complex128]:
        """Return K_hat(i omega) = int_0^T K(t) exp(-i omega t) dt of the table (cubic spline), shape (n_w, m, m).

        B = Re K_hat and A = A_inf + Im K_hat / omega are the damping and added mass that a convolution with this table has.
        """
        return np.conj(fourier_integral(self.t, legendre_pieces(self.t, self.K, "spline"), omega))

    def __str__(self) -> str:
        lines = [
            f"Retardation functions: {len(self.dofs)} dofs, t = 0..{self.duration:g} s, dt = {self.dt:g} s ({self.source})",
            f"{'':14}{'K(0) SI':>12}{'tail p':>8}{'tail err':>10}{'trunc err':>10}{'interp err':>11}{'A vs B':>8}"
            f"{'A_inf':>13}{'Ogilvie':>13}",
        ]
        shown = (self.tail_exponent, self.tail_error, self.truncation_error, self.discretisation_error, self.consistency_error)
        for i, dof in enumerate(self.dofs):
            p, tail, truncation, interpolation, consistency = (_at(x, i) for x in shown)
            lines.append(
                f"{dof:14}{self.K[0, i, i]:12.4g}{p:8.2f}{tail:10.1%}{truncation:10.1%}{interpolation:11.1%}{consistency:8.1%}"
                f"{self.A_inf[i, i]:13.5g}{_at(self.A_inf_ogilvie, i):13.5g}"
            )
        return "\n".join(lines + [f"note: {n}" for n in self.notes])


def _numbers(name: str, value: Any) -> Array:
    """Return a copy as an array of floats."""
    try:
        return np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"Retardation: an array of numbers expected for {name}, {type(value).__name__} found.") from None


def _at(x: Array | None, i: int) -> float:
    return float("nan") if x is None else float(x[i, i])
