"""Second-order wave forces at the sums of the wave frequencies."""

from dataclasses import dataclass, field
from typing import Any

import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import ComplexArray, Surroundings, Terms
from ogilvie.loads.second_order import ForceInSea, check_position
from ogilvie.loads.transfer import qtf_table
from ogilvie.waves.field import Sea

Array = NDArray[Any]
#: The effect that :class:`SumFrequency` accounts for.
SUM_FREQUENCY = "sum-frequency force"


@dataclass(frozen=True, eq=False, init=False)
class SumFrequency:
    """Wave force at the sums of the wave frequencies, which rings what is stiff: tethers, tall columns.

    Parameters
    ----------
    hydro : xarray.Dataset
        With ``qtf_sum`` or ``qtf_sum_pairs``.
    position : {"instantaneous", "mean"}
        See :class:`ogilvie.SlowDrift`.
    tolerance : float
        Parts of the quadratic transfer function that are smaller than this fraction of the largest are left out.

    Raises
    ------
    InputError
        Data that are missing or known in part.

    Notes
    -----
    F(t) = Re sum_i sum_j A_i A_j Q(w_i, w_j) exp(i (w_ei + w_ej) t) over all ordered pairs, Q(w_j, w_i) = Q(w_i, w_j),
    evaluated as products of single sums. There is no approximation by the mean drift as at difference frequencies.

    References
    ----------
    Paper D (Somayajula), Eq. (51).

    Examples
    --------
    >>> import numpy as np
    >>> from ogilvie.hydro.qtf import with_qtf
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> from ogilvie.waves.sea import regular
    >>> Z = np.zeros((2, 6, 6))
    >>> hydro = hydro_from_arrays(omega=[0.4, 1.2], added_mass=Z, radiation_damping=Z, wave_direction=[0.0],
    ...                           excitation_force=np.zeros((2, 1, 6)))
    >>> load = SumFrequency(with_qtf(hydro, omega=[0.4, 1.2], qtf_sum=1e4 * np.ones((2, 2, 1, 6))))
    >>> sea = regular(amplitude=2.0, omega=0.8, direction=0.0)
    >>> load.series(sea, np.pi / 1.6 * np.arange(3))[:, 0].round()  # a^2 Q cos(2 w t)
    array([ 40000., -40000.,  40000.])
    """

    hydro: xr.Dataset
    position: str
    _force: ForceInSea = field(repr=False)
    name: str = "sum_frequency"

    def __init__(self, hydro: xr.Dataset, *, position: str = "instantaneous", tolerance: float = 1e-8) -> None:
        if not isinstance(hydro, xr.Dataset):
            raise InputError(f"SumFrequency: a hydrodynamic data set (xarray.Dataset) expected, {type(hydro).__name__} found.")
        check_position(position, "SumFrequency")
        force = ForceInSea([qtf_table(hydro, "qtf_sum", tolerance=tolerance)], "SumFrequency")
        for key, value in (("hydro", hydro), ("position", position), ("_force", force), ("name", "sum_frequency")):
            object.__setattr__(self, key, value)

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({SUM_FREQUENCY})

    def qtf(
        self, omega_1: ArrayLike, omega_2: ArrayLike, direction_1: ArrayLike, direction_2: ArrayLike | None = None
    ) -> ComplexArray:
        """Return the quadratic transfer function (n, 6) of pairs of waves; see :meth:`ogilvie.SlowDrift.qtf`."""
        return self._force.qtf(omega_1, omega_2, direction_1, direction_2)

    def series(self, sea: Sea, t: ArrayLike, *, heading: float = 0.0, speed: float = 0.0) -> Array:
        """Return the force (n_t, 6) or (n_realisations, n_t, 6); see :meth:`ogilvie.SlowDrift.series`."""
        return self._force.series(sea, t, heading, speed)

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays for the time loop."""
        return Terms(table=self._force.tabulate, encounter=self._force.encounter(surroundings.heading, self.position))
