"""Slow drift: second-order wave forces at the differences of the wave frequencies, their mean included."""

import warnings
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.loads.base import SLOW_DRIFT, ComplexArray, Surroundings, Terms
from ogilvie.loads.coverage import covered
from ogilvie.loads.harmonics import HarmonicGrid
from ogilvie.loads.kernel import Kernel
from ogilvie.loads.newman import APPROXIMATIONS, DriftTable, drift_table
from ogilvie.loads.quadratic import QuadraticForm
from ogilvie.loads.slow_drift_kernel import slow_drift_kernel
from ogilvie.loads.transfer import QtfPairTable, QtfTable, qtf_table
from ogilvie.waves.field import Sea

Array = NDArray[Any]
Table = DriftTable | QtfTable | QtfPairTable


@dataclass(frozen=True, eq=False, init=False)
class SlowDrift:
    """Mean and slowly varying drift force of the waves.

    Parameters
    ----------
    hydro : xarray.Dataset
        With ``mean_drift`` for Newman's approximations, ``qtf_diff`` or ``qtf_diff_pairs`` for "full".
    approximation : {"newman-arithmetic", "newman-geometric", "newman-1974", "full", "mean"}
        How Q(w_i, w_j) follows from the data: see :mod:`ogilvie.loads.newman`; "mean" has no slowly varying part.
    position : {"instantaneous", "mean"}
        Where the waves are met in large motions: where the vessel is, at the heading it has; or in the frame that advances
        steadily, as small motions assume.
    variable : str
        Which mean drift, e.g. ``"mean_drift_pressure_body"``, whose moments are about the moving O.
    tolerance : float
        Parts of a quadratic transfer function that are smaller than this fraction of the largest are left out.

    Raises
    ------
    InputError
        Unknown words; data that are missing or known in part.

    Notes
    -----
    F(t) = Re sum_i sum_j A_i A_j* Q(w_i, w_j) exp(i (w_ei - w_ej) t) with A = a exp(i phase) and signed encounter frequencies
    w_e, evaluated as products of single sums. During a ramp the sea grows with r(t) and the force with r(t)^2. Components that
    the data do not hold (heave, roll and pitch of far-field drift) are zero: :attr:`dofs` names those that act.
    A steady start holds the first-order motion and the mean offset; the slow motion builds up from there.

    The force belongs to first-order excitation and linear restoring. A nonlinear Froude-Krylov force holds part of it.

    References
    ----------
    Newman (1974), Second-order, slowly-varying forces on vessels in irregular waves; Pinkster (1980), Low frequency second
    order wave exciting forces on floating structures; paper D (Somayajula), Eqs. (46)-(54).

    Examples
    --------
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> w, Z = np.linspace(0.2, 2.0, 10), np.zeros((10, 6, 6))
    >>> D = np.ones((10, 1, 6)) * -1e4 * w[:, None, None] ** 2
    >>> hydro = hydro_from_arrays(omega=w, added_mass=Z, radiation_damping=Z, wave_direction=[np.pi], mean_drift=D)
    >>> drift = SlowDrift(hydro)
    >>> drift.qtf([0.5], [0.7], np.pi)[0, 0].real.round(6)
    np.float64(-3700.0)
    """

    hydro: xr.Dataset
    approximation: str
    position: str
    _table: Table = field(repr=False)
    name: str = "slow_drift"

    def __init__(
        self,
        hydro: xr.Dataset,
        approximation: str = "newman-arithmetic",
        *,
        position: str = "instantaneous",
        variable: str = "mean_drift",
        tolerance: float = 1e-8,
    ) -> None:
        known = ("full", *APPROXIMATIONS)
        if approximation not in known:
            raise InputError(f"SlowDrift: approximation, one of {', '.join(known)}, expected, {approximation!r} found.")
        if position not in ("instantaneous", "mean"):
            raise InputError(f"SlowDrift: position 'instantaneous' or 'mean' expected, {position!r} found.")
        if not isinstance(hydro, xr.Dataset):
            raise InputError(f"SlowDrift: a hydrodynamic data set (xarray.Dataset) expected, {type(hydro).__name__} found.")
        if not 0.0 <= tolerance < 1.0:
            raise InputError(f"SlowDrift: a tolerance from 0 to below 1 expected, {tolerance!r} found.")
        if approximation == "full":
            table: Table = qtf_table(hydro, tolerance=tolerance)
        else:
            table = drift_table(hydro, approximation, variable, tolerance=tolerance)
        values = {"hydro": hydro, "approximation": approximation, "position": position, "_table": table, "name": "slow_drift"}
        for key, value in values.items():
            object.__setattr__(self, key, value)

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({SLOW_DRIFT})

    @property
    def dofs(self) -> tuple[str, ...]:
        """Components that the data hold."""
        from ogilvie.hydro.schema import DOFS

        return tuple(name for name, yes in zip(DOFS, self._table.known, strict=True) if yes)

    def qtf(
        self, omega_1: ArrayLike, omega_2: ArrayLike, direction_1: ArrayLike, direction_2: ArrayLike | None = None
    ) -> ComplexArray:
        """Return the quadratic transfer function (n, 6) of pairs of waves as this load has it, from the definition.

        Parameters
        ----------
        omega_1, omega_2 : (n,) array
            rad/s, within the data.
        direction_1, direction_2 : float or (n,) array
            Directions that the waves travel to, relative to the bow, rad; one for both by default.
        """
        second = direction_1 if direction_2 is None else direction_2
        given = [np.atleast_1d(np.asarray(v, dtype=float)) for v in (omega_1, direction_1, omega_2, second)]
        w1, b1, w2, b2 = np.broadcast_arrays(*given)
        lo, hi = self._table.omega[[0, -1]]
        for w in (w1, w2):
            if len(w) and not (w.min() >= lo * (1 - 1e-9) and w.max() <= hi * (1 + 1e-9)):
                raise InputError(
                    f"SlowDrift: frequencies within {lo:.4g}..{hi:.4g} rad/s expected, {w.min():.4g}..{w.max():.4g} found."
                )
        return self._table.pair(w1, b1, w2, b2)

    def form(self, sea: Sea, heading: float = 0.0) -> QuadraticForm:
        """Return the force of a sea on a vessel at a heading (rad) as products of sums over its components.

        Raises
        ------
        InputError
            A sea or a heading that the data do not cover.
        """
        inside = covered(sea, self._table.omega, "SlowDrift")
        part = _form(self._table, sea.omega[inside], sea.direction[inside] - heading)
        fields = np.zeros((len(part.fields), len(sea.omega)), dtype=complex)
        fields[:, inside] = part.fields
        steady = np.zeros((len(sea.omega), 6))
        steady[inside] = part.steady
        return QuadraticForm(fields, part.left, part.right, part.weight, steady, part.difference)

    def series(self, sea: Sea, t: ArrayLike, *, heading: float = 0.0, speed: float = 0.0) -> Array:
        """Return the force on a vessel on a steady course that is at the origin of the sea at t = 0.

        Parameters
        ----------
        sea : Sea
        t : (n_t,) array
            Equally spaced times, s.
        heading, speed : float
            rad, m/s.

        Returns
        -------
        (n_t, 6) or (n_realisations, n_t, 6) array
            In axes along the heading, about O.
        """
        times = np.asarray(t, dtype=float)
        step = float(times[1] - times[0]) if times.ndim == 1 and len(times) > 1 else 0.0
        if not (step > 0.0 and np.allclose(np.diff(times), step, rtol=1e-6, atol=1e-9)):
            raise InputError("SlowDrift.series: two or more equally spaced, increasing times expected, others found.")
        table = self._tabulate(sea, heading, speed)
        force = np.array([table.series(r, float(times[0]), step, len(times)) for r in range(sea.n_realisations)])
        return force if sea.amplitude.ndim == 2 else force[0]

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays for the time loop."""
        own = float(self.hydro.attrs.get("speed", 0.0))
        if abs(surroundings.speed - own) > 1e-6 * max(1.0, abs(own)):
            warnings.warn(
                f"SlowDrift: the drift holds for {own:.4g} m/s, the vessel sails at {surroundings.speed:.4g} m/s; its "
                "dependence on speed is left out (at low speed WaveDriftDamping accounts for it).",
                OgilvieWarning,
                stacklevel=2,
            )
        encounter = partial(_encounter, self, surroundings.heading) if self.position == "instantaneous" else None
        return Terms(table=self._tabulate, encounter=encounter)

    def _tabulate(self, sea: Sea, heading: float, speed: float) -> "DriftSeries":
        frequency = sea.omega - sea.wavenumber * speed * np.cos(sea.direction - heading)
        return DriftSeries(self.form(sea, heading), frequency, np.atleast_2d(sea.complex_amplitude))


@dataclass(frozen=True, eq=False)
class DriftSeries:
    """The force of a sea on a vessel on a steady course, as tables over time.

    Parameters
    ----------
    form : QuadraticForm
    frequency : (n,) array
        Of encounter, rad/s.
    amplitude : (r, n) complex array
    """

    form: QuadraticForm
    frequency: Array
    amplitude: ComplexArray
    _grids: dict[tuple[float, int], HarmonicGrid] = field(default_factory=dict, repr=False)

    def series(self, realisation: int, start: float, step: float, count: int) -> Array:
        """Return the force (count, 6) of a realisation at times from `start`, `step` apart (s)."""
        key = (step, count)
        if key not in self._grids:
            self._grids[key] = HarmonicGrid(self.frequency, step, count)
        grid = self._grids[key]
        return self.form.series(grid, self.amplitude[realisation] * grid.phases(start))

    def mean(self, realisation: int) -> Array:
        """Return the mean force (6,) of a realisation."""
        return np.asarray(np.abs(self.amplitude[realisation]) ** 2 @ self.form.diagonal())


def _form(table: Table, omega: Array, direction: Array) -> QuadraticForm:
    """Return the form of a table, with errors in the name of this load."""
    lo, hi = table.omega[[0, -1]]
    try:
        return table.form(np.clip(omega, lo, hi), direction)
    except InputError as error:
        raise InputError(str(error).replace("WaveExcitation", "SlowDrift")) from None


def _encounter(load: SlowDrift, heading: float, sea: Sea, ramp: float) -> Kernel:
    """Return the compiled force of the sea where the vessel is."""
    inside = covered(sea, load._table.omega, "SlowDrift")
    w, direction = sea.omega[inside], sea.direction[inside]
    return slow_drift_kernel(
        lambda psi: _form(load._table, w, direction - psi), load._table.headings, sea, inside, heading=heading, ramp=ramp
    )
