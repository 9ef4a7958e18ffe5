"""Slow drift: second-order wave forces at the differences of the wave frequencies, their mean included."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.schema import DOFS
from ogilvie.loads.base import SLOW_DRIFT, ComplexArray, Surroundings, Terms
from ogilvie.loads.by_speed import by_speed, speed_of
from ogilvie.loads.newman import APPROXIMATIONS, drift_table
from ogilvie.loads.quadratic import QuadraticForm
from ogilvie.loads.second_order import ForceInSea, check_position, refuse_other_headings
from ogilvie.loads.transfer import qtf_table
from ogilvie.loads.wave_drift_damping import WAVE_DRIFT_DAMPING
from ogilvie.waves.field import Sea

Array = NDArray[Any]


@dataclass(frozen=True, eq=False, init=False)
class SlowDrift:
    """Mean and slowly varying drift force of the waves.

    Parameters
    ----------
    hydro : xarray.Dataset or sequence of them
        With ``mean_drift`` for Newman's approximations, ``qtf_diff`` or ``qtf_diff_pairs`` for "full"; or several of one vessel
        at different speeds and the same headings, for example from :func:`ogilvie.mean_drift` with ``speed=``.
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
        Unknown words; data that are missing or known in part; several sets that do not belong together.

    Notes
    -----
    F(t) = Re sum_i sum_j A_i A_j* Q(w_i, w_j) exp(i (w_ei - w_ej) t) with A = a exp(i phase) and signed encounter frequencies
    w_e, evaluated as products of single sums. During a ramp the sea grows with r(t) and the force with r(t)^2. Components that
    the data do not hold (heave, roll and pitch of far-field drift) are zero: :attr:`dofs` names those that act.
    From data at forward speed the mean of the force is the added resistance (and the drift to the side) at that speed. From
    several sets Q is linear between their speeds; in large motions it follows the mean speed through the water, so added
    resistance needs no load of its own. :class:`WaveDriftDamping`, another account of the dependence on speed, is refused then.
    A steady start holds the first-order motion and the mean offset; the slow motion builds up from there.

    The force belongs to first-order excitation and linear restoring. A nonlinear Froude-Krylov force holds part of it.

    References
    ----------
    Newman (1974), Second-order, slowly-varying forces on vessels in irregular waves; Pinkster (1980), Low frequency second
    order wave exciting forces on floating structures; paper D (Somayajula), Eqs. (46)-(54).

    Examples
    --------
    >>> import numpy as np
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
    _force: ForceInSea = field(repr=False)
    name: str = "slow_drift"

    def __init__(
        self,
        hydro: xr.Dataset | Sequence[xr.Dataset],
        approximation: str = "newman-arithmetic",
        *,
        position: str = "instantaneous",
        variable: str = "mean_drift",
        tolerance: float = 1e-8,
    ) -> None:
        known = ("full", *APPROXIMATIONS)
        if approximation not in known:
            raise InputError(f"SlowDrift: approximation, one of {', '.join(known)}, expected, {approximation!r} found.")
        check_position(position, "SlowDrift")
        if not 0.0 <= tolerance < 1.0:
            raise InputError(f"SlowDrift: a tolerance from 0 to below 1 expected, {tolerance!r} found.")
        sets = by_speed([hydro] if isinstance(hydro, xr.Dataset) or not isinstance(hydro, Sequence) else hydro, "SlowDrift")
        tables = [
            qtf_table(one, tolerance=tolerance)
            if approximation == "full"
            else drift_table(one, approximation, variable, tolerance=tolerance)
            for one in sets
        ]
        force = ForceInSea(tables, "SlowDrift", np.array([speed_of(one) for one in sets]))
        refuse_other_headings(force)
        for key, value in (("hydro", sets[0]), ("approximation", approximation), ("position", position), ("_force", force)):
            object.__setattr__(self, key, value)
        object.__setattr__(self, "name", "slow_drift")

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for; with data at several speeds that of speed on the drift is one."""
        return frozenset({SLOW_DRIFT} if len(self._force.speeds) == 1 else {SLOW_DRIFT, WAVE_DRIFT_DAMPING})

    @property
    def dofs(self) -> tuple[str, ...]:
        """Components that the data hold."""
        return tuple(name for name, yes in zip(DOFS, self._force.known, strict=True) if yes)

    def qtf(
        self,
        omega_1: ArrayLike,
        omega_2: ArrayLike,
        direction_1: ArrayLike,
        direction_2: ArrayLike | None = None,
        *,
        speed: float | None = None,
    ) -> ComplexArray:
        """Return the quadratic transfer function (n, 6) of pairs of waves as this load has it, from the definition.

        Parameters
        ----------
        omega_1, omega_2 : (n,) array
            rad/s, within the data.
        direction_1, direction_2 : float or (n,) array
            Directions that the waves travel to, relative to the bow, rad; one for both by default.
        speed : float, optional
            m/s, within the data of several speeds; the lowest of them by default.
        """
        return self._force.qtf(omega_1, omega_2, direction_1, direction_2, speed)

    def form(self, sea: Sea, heading: float = 0.0, speed: float | None = None) -> QuadraticForm:
        """Return the force of a sea on a vessel at a heading (rad) and speed (m/s) as products of sums over its components.

        Raises
        ------
        InputError
            A sea, a heading or a speed that the data do not cover.
        """
        return self._force.form(sea, heading, speed)

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
        return self._force.series(sea, t, heading, speed)

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays for the time loop."""
        own, at = self._force.speeds, surroundings.speed
        if len(own) > 1 and not own[0] - 1e-9 <= at <= own[-1] + 1e-9:
            raise InputError(
                f"SlowDrift: a vessel's speed within the data ({own[0]:.4g}..{own[-1]:.4g} m/s) expected, {at:.4g} m/s found."
            )
        if len(own) == 1 and abs(at - own[0]) > 1e-6 * max(1.0, abs(own[0])):
            warnings.warn(
                f"SlowDrift: the drift holds for {own[0]:.4g} m/s, the vessel sails at {at:.4g} m/s; its dependence on "
                "speed is left out. Give data at several speeds (mean_drift with speed=), or WaveDriftDamping at low speed.",
                OgilvieWarning,
                stacklevel=2,
            )
        return Terms(table=self._force.tabulate, encounter=self._force.encounter(surroundings.heading, self.position))


def slow_drift_force(sea: Sea, qtf: xr.Dataset, t: ArrayLike, *, heading: float = 0.0, speed: float = 0.0) -> Array:
    """Return mean and slowly varying drift force of a sea from a full quadratic transfer function.

    Parameters
    ----------
    sea : Sea
    qtf : xarray.Dataset
        With ``qtf_diff`` or ``qtf_diff_pairs``: of :func:`ogilvie.difference_qtf`, :func:`ogilvie.newman` or a .12d file.
    t : (n_t,) array
        Equally spaced times, s.
    heading, speed : float
        Steady course of the vessel, rad, m/s.

    Returns
    -------
    (n_t, 6) or (n_realisations, n_t, 6) array
        In axes along the heading, about O; see :class:`SlowDrift`, whose ``series`` this is.

    Raises
    ------
    InputError
        Data that are missing or known in part; a sea that they do not cover.

    Examples
    --------
    >>> import numpy as np
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> from ogilvie.loads.newman_qtf import newman
    >>> from ogilvie.waves.sea import bichromatic
    >>> w, Z = np.linspace(0.2, 2.0, 10), np.zeros((10, 6, 6))
    >>> D = np.ones((10, 1, 6)) * -1e4 * w[:, None, None] ** 2
    >>> hydro = hydro_from_arrays(omega=w, added_mass=Z, radiation_damping=Z, wave_direction=[np.pi], mean_drift=D)
    >>> sea = bichromatic(height=(2.0, 2.0), period=(7.0, 8.0), direction=np.pi)
    >>> force = slow_drift_force(sea, newman(hydro, "arithmetic"), np.arange(0.0, 560.0, 0.5))  # ten groups of 56 s
    >>> float(force[:, 0].mean().round(-1))
    -14230.0
    """
    return SlowDrift(qtf, "full").series(sea, t, heading=heading, speed=speed)
