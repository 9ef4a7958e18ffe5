"""A sea as a vessel meets it: encounter frequencies, wave forces, the stationary response."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import ForceSeries
from ogilvie.sim.system import LinearSystem
from ogilvie.waves.field import Sea

Array = NDArray[Any]
ComplexArray = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Seaway:
    """Wave components in the steady frame of a vessel, which is at the origin of the sea at t = 0.

    Parameters
    ----------
    frequency : (n,) array
        Signed encounter frequency w - k U cos(b), rad/s.
    amplitude : (r, n) complex array
        a exp(i phase), m; one row per realisation.
    force : (n_loads, n, 6) complex array
        Force of each wave load per metre of amplitude.
    names : tuple of str
        Of the wave loads.
    batched : bool
        Whether the sea has an axis of realisations.
    tabulated : tuple of bool
        Whether the force of each wave load comes from a table made before the run, for the vessel's mean position.
    sea : Sea
    second : tuple of (str, ForceSeries, bool)
        Name and force of each load of second order, and whether it comes from a table made before the run.
    """

    frequency: Array
    amplitude: ComplexArray
    force: ComplexArray
    names: tuple[str, ...]
    batched: bool
    tabulated: tuple[bool, ...]
    sea: Sea
    second: tuple[tuple[str, ForceSeries, bool], ...] = ()

    @property
    def transfer(self) -> ComplexArray:
        """Coefficients (n, 7 or more): total force (6), elevation, then the force of each load of :meth:`columns`."""
        n = len(self.frequency)
        force = self.force[np.array(self.tabulated, dtype=bool)]
        parts = [force.sum(axis=0), np.ones((n, 1), dtype=complex)]
        if self._apart:
            parts.extend(force)
        return np.ascontiguousarray(np.concatenate(parts, axis=1))

    def columns(self) -> dict[str, int]:
        """Where the six columns of each load's force begin in :attr:`transfer`, then those of second order."""
        names = self._tables()
        return {name: 7 + 6 * i if self._apart else 0 for i, name in enumerate(names)}

    @property
    def tables(self) -> tuple[ForceSeries, ...]:
        """Forces of second order that come from tables."""
        return tuple(force for _, force, yes in self.second if yes)

    @property
    def _apart(self) -> bool:
        """Whether the force of each load has columns of its own beside the total."""
        return len(self._tables()) > 1 or len(self.tables) > 0

    def _tables(self) -> list[str]:
        first = [name for name, yes in zip(self.names, self.tabulated, strict=True) if yes]
        return first + [name for name, _, yes in self.second if yes]

    def mean_force(self, realisation: int) -> Array:
        """Return the mean force (6,) of second order."""
        return np.sum([np.zeros(6), *[force.mean(realisation) for _, force, _ in self.second]], axis=0)

    def response(self, system: LinearSystem) -> ComplexArray:
        """Return the stationary motion (n, 6) per metre of amplitude: Z(w_e)^-1 F.

        Raises
        ------
        InputError
            No stationary motion exists at some encounter frequency.
        """
        Z = system.impedance(self.frequency)
        F = self.force.sum(axis=0)
        rigid = np.linalg.cond(Z) > 1e13
        if np.any(rigid):
            raise InputError(
                f"initial: no stationary motion exists at the encounter frequency {self.frequency[rigid][0]:.3g} rad/s, where "
                "nothing holds the vessel. Start with initial='rest' and a ramp, or add restoring, damping or mooring."
            )
        return np.linalg.solve(Z, F[..., None])[..., 0]


def meet(system: LinearSystem, sea: Sea, *, large: bool) -> Seaway:
    """Return a sea as the vessel meets it.

    Raises
    ------
    InputError
        Not a sea, or components that the loads do not cover.
    """
    if not isinstance(sea, Sea):
        raise InputError(f"sea: a Sea (e.g. from irregular or regular) expected, {type(sea).__name__} found.")
    loads = [(name, term.wave) for name, term in zip(system.names, system.terms, strict=True) if term.wave is not None]
    force = [wave(sea, system.heading) for _, wave in loads]
    second = [
        (name, term.table(sea, system.heading, system.speed), not large or term.encounter is None)
        for name, term in zip(system.names, system.terms, strict=True)
        if term.table is not None
    ]
    return Seaway(
        frequency=sea.omega - sea.wavenumber * system.speed * np.cos(sea.direction - system.heading),
        amplitude=np.ascontiguousarray(np.atleast_2d(sea.complex_amplitude)),
        force=np.array(force) if force else np.zeros((0, len(sea.omega), 6), dtype=complex),
        names=tuple(name for name, _ in loads),
        batched=sea.amplitude.ndim == 2,
        tabulated=tuple(not large or system.terms[system.names.index(name)].encounter is None for name, _ in loads),
        sea=sea,
        second=tuple(second),
    )


def combine_harmonics(amplitude: Array, response: Array) -> Array:
    """Return Re sum_j amplitude_rj response_j (r, m) at t = 0, each realisation by itself so that its bits are its own."""
    return np.array([(a @ response).real for a in amplitude])


def mean_position(system: LinearSystem) -> Array:
    """Return the displacement (6,) at which restoring and mooring balance the constant forces.

    Raises
    ------
    InputError
        A constant force acts where nothing restores.
    """
    F = system.constant
    if not F.any():
        return np.zeros(6)
    eta = np.linalg.lstsq(system.stiffness, F, rcond=None)[0]
    if not np.allclose(system.stiffness @ eta, F, rtol=1e-6, atol=1e-9 * np.abs(F).max()):
        raise InputError(
            "initial: a constant force acts where nothing restores, so there is no stationary motion. Use initial='rest'."
        )
    return eta
