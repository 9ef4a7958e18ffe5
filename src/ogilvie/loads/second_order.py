"""Second-order forces of a sea: what slow drift and sum-frequency forces share."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import ComplexArray, Encounter
from ogilvie.loads.coverage import covered
from ogilvie.loads.harmonics import HarmonicGrid
from ogilvie.loads.kernel import Kernel
from ogilvie.loads.newman import DriftTable
from ogilvie.loads.quadratic import QuadraticForm, weighted_forms
from ogilvie.loads.second_order_kernel import second_order_kernel
from ogilvie.loads.transfer import QtfPairTable, QtfTable
from ogilvie.waves.field import Sea

Array = NDArray[Any]
POSITIONS = ("instantaneous", "mean")


@dataclass(frozen=True, eq=False)
class ForceInSea:
    """The quadratic transfer functions of a load, at one speed or several, and what they make of a sea.

    Parameters
    ----------
    tables : sequence of DriftTable, QtfTable or QtfPairTable
        For the same headings.
    who : str
        Name of the load in errors.
    speeds : (n_u,) array
        Of the tables, ascending, m/s; Q is linear between them, and does not depend on speed if there is one alone.
    """

    tables: Sequence[DriftTable | QtfTable | QtfPairTable]
    who: str
    speeds: Array = field(default_factory=lambda: np.zeros(1))

    @property
    def table(self) -> DriftTable | QtfTable | QtfPairTable:
        """That of the lowest speed."""
        return self.tables[0]

    @property
    def omega(self) -> Array:
        """Lowest and highest frequency (2,) that all tables hold, rad/s."""
        return np.array([max(t.omega[0] for t in self.tables), min(t.omega[-1] for t in self.tables)])

    @property
    def known(self) -> NDArray[np.bool_]:
        """Components (6,) that all tables hold."""
        return np.all([t.known for t in self.tables], axis=0)

    def qtf(
        self,
        omega_1: ArrayLike,
        omega_2: ArrayLike,
        direction_1: ArrayLike,
        direction_2: ArrayLike | None,
        speed: float | None = None,
    ) -> ComplexArray:
        """Return Q (n, 6) of pairs of waves, from the definition; one direction serves both where the second is None."""
        second = direction_1 if direction_2 is None else direction_2
        given = [np.atleast_1d(np.asarray(v, dtype=float)) for v in (omega_1, direction_1, omega_2, second)]
        w1, b1, w2, b2 = np.broadcast_arrays(*given)
        lo, hi = self.omega
        for w in (w1, w2):
            if len(w) and not (w.min() >= lo * (1 - 1e-9) and w.max() <= hi * (1 + 1e-9)):
                raise InputError(
                    f"{self.who}: frequencies within {lo:.4g}..{hi:.4g} rad/s expected, {w.min():.4g}..{w.max():.4g} found."
                )
        parts = [share * table.pair(w1, b1, w2, b2) for share, table in self._around(speed)]
        return np.asarray(np.sum(parts, axis=0))

    def form(self, sea: Sea, heading: float, speed: float | None = None) -> QuadraticForm:
        """Return the force on a vessel at a heading (rad) as products of sums over all components of a sea."""
        inside = covered(sea, self.omega, self.who)
        part = self._form(sea.omega[inside], sea.direction[inside] - heading, speed)
        fields = np.zeros((len(part.fields), len(sea.omega)), dtype=complex)
        fields[:, inside] = part.fields
        steady = np.zeros((len(sea.omega), 6))
        steady[inside] = part.steady
        return QuadraticForm(fields, part.left, part.right, part.weight, steady, part.difference)

    def tabulate(self, sea: Sea, heading: float, speed: float) -> "SecondOrderSeries":
        """Return the force on a vessel on a steady course that is at the origin of the sea at t = 0."""
        frequency = sea.omega - sea.wavenumber * speed * np.cos(sea.direction - heading)
        return SecondOrderSeries(self.form(sea, heading, speed), frequency, np.atleast_2d(sea.complex_amplitude))

    def series(self, sea: Sea, t: ArrayLike, heading: float, speed: float) -> Array:
        """Return the force (n_t, 6), or (n_realisations, n_t, 6), at equally spaced times."""
        times = np.asarray(t, dtype=float)
        step = float(times[1] - times[0]) if times.ndim == 1 and len(times) > 1 else 0.0
        if not (step > 0.0 and np.allclose(np.diff(times), step, rtol=1e-6, atol=1e-9)):
            raise InputError(f"{self.who}.series: two or more equally spaced, increasing times expected, others found.")
        table = self.tabulate(sea, heading, speed)
        force = np.array([table.series(r, float(times[0]), step, len(times)) for r in range(sea.n_realisations)])
        return force if sea.amplitude.ndim == 2 else force[0]

    def encounter(self, heading: float, position: str) -> Encounter | None:
        """Return what makes the compiled force of a sea on a vessel that starts at a heading; none for the mean position."""
        return partial(_encounter, self, heading) if position == "instantaneous" else None

    def _form(self, omega: Array, direction: Array, speed: float | None) -> QuadraticForm:
        w = np.clip(omega, *self.omega)
        try:
            return weighted_forms([(share, table.form(w, direction)) for share, table in self._around(speed)])
        except InputError as error:
            raise InputError(str(error).replace("WaveExcitation", self.who)) from None

    def _around(self, speed: float | None) -> list[tuple[float, DriftTable | QtfTable | QtfPairTable]]:
        """Return the tables about a speed with their shares; the first one alone for None."""
        if speed is None or len(self.speeds) == 1:
            return [(1.0, self.table)]
        lo, hi = self.speeds[[0, -1]]
        if not lo - 1e-9 <= speed <= hi + 1e-9:
            raise InputError(f"{self.who}: a speed within the data ({lo:.4g}..{hi:.4g} m/s) expected, {speed:.4g} found.")
        i = int(np.clip(np.searchsorted(self.speeds, speed, side="right") - 1, 0, len(self.speeds) - 2))
        s = float(np.clip((speed - self.speeds[i]) / (self.speeds[i + 1] - self.speeds[i]), 0.0, 1.0))
        return [(share, self.tables[k]) for share, k in ((1.0 - s, i), (s, i + 1)) if share > 0.0]


@dataclass(frozen=True, eq=False)
class SecondOrderSeries:
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
        if not self.form.difference:
            return np.zeros(6)
        return np.asarray(np.abs(self.amplitude[realisation]) ** 2 @ self.form.diagonal())


def refuse_other_headings(force: ForceInSea) -> None:
    """Raise :class:`InputError` unless all tables hold the same headings."""
    first, *others = [table.headings for table in force.tables]
    for other in others:
        if first.periodic != other.periodic or not np.array_equal(np.round(first.values, 9), np.round(other.values, 9)):
            raise InputError(f"{force.who}: data sets for the same headings expected, different ones found.")


def check_position(position: str, who: str) -> None:
    """Raise :class:`InputError` unless the word is one of :data:`POSITIONS`."""
    if position not in POSITIONS:
        raise InputError(f"{who}: position 'instantaneous' or 'mean' expected, {position!r} found.")


def _encounter(force: ForceInSea, heading: float, sea: Sea, ramp: float) -> Kernel:
    """Return the compiled force of the sea where the vessel is."""
    inside = covered(sea, force.omega, force.who)
    w, direction = sea.omega[inside], sea.direction[inside]
    return second_order_kernel(
        lambda psi, u: force._form(w, direction - psi, u),
        force.speeds,
        force.table.headings,
        sea,
        inside,
        heading=heading,
        ramp=ramp,
        who=force.who,
    )
