"""Wave forces as a function of frequency, heading and speed, for a vessel whose speed changes."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.schema import DOFS
from ogilvie.hydro.speed_terms import FluidMomentum, diffraction_at_speed, speed_matrix
from ogilvie.loads.base import ComplexArray, embed
from ogilvie.loads.by_speed import ROUNDING, by_speed, speed_of
from ogilvie.loads.interpolation import Headings, evaluate, evaluate_turning, symmetric_headings
from ogilvie.waves.dispersion import encounter_frequency

Array = NDArray[np.float64]
Interpolation = Literal["cubic", "linear"]


@dataclass(frozen=True, eq=False)
class HeadingTable:
    """Forces (n_w, n_b, 6) of one data set over frequency and heading."""

    omega: Array
    headings: Headings
    values: ComplexArray

    def at(self, omega: Array, direction: Array) -> ComplexArray:
        """Return the forces (n, 6); frequencies are those of the data at most."""
        return evaluate(self.omega, self.headings, self.values, np.clip(omega, self.omega[0], self.omega[-1]), direction)

    def turning(self, omega: Array, direction: Array) -> ComplexArray:
        """Return the forces (n_h, n, 6) at frequencies (n,) and directions (n_h, n)."""
        w = np.clip(omega, self.omega[0], self.omega[-1])
        return evaluate_turning(self.omega, self.headings, self.values, w, direction)

    @classmethod
    def of(cls, hydro: xr.Dataset, key: str = "excitation_force") -> "HeadingTable":
        """Return the table of a variable of a data set, mirrored where the hull is symmetric."""
        dofs = tuple(str(d) for d in hydro.influenced_dof.values)
        headings, values = symmetric_headings(hydro, embed(hydro[key].values, dofs, (2,)).astype(complex))
        return cls(hydro.omega.values, headings, values)


@dataclass(frozen=True, eq=False)
class _Rule:
    """Forces of one data set at zero speed, carried to any speed."""

    total: HeadingTable
    incident: HeadingTable
    fluid: FluidMomentum
    water_depth: float
    g: float

    def at(self, omega: Array, direction: Array, speed: Array) -> ComplexArray:
        """Return the forces (n, 6) at speeds (n,)."""
        incident = self.incident.at(omega, direction)
        return self._moved(incident, self.total.at(omega, direction) - incident, omega, direction, speed)

    def turning(self, omega: Array, direction: Array, speed: float) -> ComplexArray:
        """Return the forces (n_h, n, 6) at frequencies (n,) and directions (n_h, n)."""
        incident = self.incident.turning(omega, direction)
        return self._moved(incident, self.total.turning(omega, direction) - incident, omega, direction, np.array(speed))

    def _moved(
        self, incident: ComplexArray, scattered: ComplexArray, omega: Array, direction: Array, speed: Array
    ) -> ComplexArray:
        encounter = encounter_frequency(omega, speed=speed, direction=direction, depth=self.water_depth, g=self.g)
        T, T_encounter = self.fluid.at(omega), self.fluid.at(encounter)  # (n, 6, 6), (..., n, 6, 6)
        L = speed_matrix(DOFS)
        assert L is not None
        found = diffraction_at_speed(
            scattered, omega=omega, encounter=encounter, T=T, T_encounter=T_encounter, speed=speed, L=L
        )
        return np.asarray(incident + found)


@dataclass(frozen=True, eq=False, init=False)
class SpeedTable:
    """Complex wave forces over frequency, heading and speed.

    Parameters
    ----------
    hydro : xarray.Dataset or sequence of them
        Data sets of one vessel at different speeds; or one at zero speed with ``Froude_Krylov_force`` or ``diffraction_force``,
        which is carried to other speeds by the rule of :func:`ogilvie.at_speed`.
    interpolation : {"cubic", "linear"}
        Between the speeds of several data sets: a spline with two continuous derivatives (of lower degree for fewer than four
        speeds), or straight lines. The rule needs none.

    Raises
    ------
    InputError
        No wave forces, or not in two parts where the rule needs them; a speed given twice; different water.

    Notes
    -----
    Real and imaginary parts are interpolated, never amplitude and phase: cubic in frequency and in heading, as in
    :class:`ogilvie.WaveExcitation` (periodic where the headings go all around, mirrored for a symmetric hull). By the rule the
    force is smooth in the speed but for the slope of interpolated A and B, which is continuous.

    Examples
    --------
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> w, Z = np.linspace(0.2, 2.0, 10), np.zeros((10, 6, 6))
    >>> def data(speed):
    ...     X = np.ones((10, 1, 6)) * (1.0 + speed) * w[:, None, None]
    ...     return hydro_from_arrays(omega=w, added_mass=Z, radiation_damping=Z, wave_direction=[np.pi], excitation_force=X,
    ...                              speed=speed)
    >>> table = SpeedTable([data(0.0), data(4.0), data(8.0)])
    >>> table.force(0.5, np.pi, [1.0, 6.0])[:, 2].real.round(6)
    array([1. , 3.5])
    """

    interpolation: Interpolation
    _speeds: Array = field(repr=False)
    _tables: tuple[HeadingTable, ...] = field(repr=False)
    _rule: _Rule | None = field(repr=False)

    def __init__(self, hydro: xr.Dataset | Sequence[xr.Dataset], *, interpolation: Interpolation = "cubic") -> None:
        sets = [hydro] if isinstance(hydro, xr.Dataset) else list(hydro)
        if not sets:
            raise InputError("SpeedTable: at least one hydrodynamic data set expected, none found.")
        sets = by_speed(sets, "SpeedTable")
        _check_sets(sets)
        if interpolation not in ("cubic", "linear"):
            raise InputError(f"SpeedTable: interpolation: 'cubic' or 'linear' expected, {interpolation!r} found.")
        speeds = np.array([speed_of(h) for h in sets])
        object.__setattr__(self, "interpolation", interpolation)
        object.__setattr__(self, "_speeds", speeds)
        object.__setattr__(self, "_tables", tuple(HeadingTable.of(h) for h in sets))
        object.__setattr__(self, "_rule", _rule(sets[0]) if len(sets) == 1 and speeds[0] == 0.0 else None)

    @property
    def speed_range(self) -> tuple[float, float]:
        """Lowest and highest speed, m/s; unlimited where the rule is used."""
        return (-np.inf, np.inf) if self._rule else (float(self._speeds[0]), float(self._speeds[-1]))

    @property
    def speeds(self) -> Array:
        """Speeds of the data sets, m/s."""
        return self._speeds

    @property
    def omega_range(self) -> tuple[float, float]:
        """Lowest and highest frequency of the incident waves that all data sets hold, rad/s."""
        return max(float(t.omega[0]) for t in self._tables), min(float(t.omega[-1]) for t in self._tables)

    def force(self, omega: ArrayLike, direction: ArrayLike, speed: ArrayLike) -> ComplexArray:
        """Return the complex force (n, 6) per metre of wave amplitude about O.

        Parameters
        ----------
        omega : (n,) array
            Frequency of the incident waves, rad/s.
        direction : (n,) array
            Direction that the waves travel to, relative to the bow, rad.
        speed : float or (n,) array
            m/s.

        Returns
        -------
        (n, 6) complex array
            Force = Re(X a exp(i (omega_e t + phase))) with the signed omega_e of this speed and direction.

        Raises
        ------
        InputError
            Frequency, heading or speed outside the data; nothing is extrapolated.
        """
        asked = (np.atleast_1d(np.asarray(v, dtype=float)) for v in (omega, direction, speed))
        w, b, U = np.broadcast_arrays(*asked)
        _refuse_outside("frequencies", "rad/s", w, *self.omega_range)
        _refuse_outside("speeds", "m/s", U, *self.speed_range)
        if self._rule is not None:
            return self._rule.at(w, b, U)
        weights = self._weights(U)  # (n, n_u)
        found = np.zeros((len(w), 6), dtype=complex)
        for n in np.flatnonzero(np.any(weights != 0.0, axis=0)):
            found += weights[:, n, None] * self._tables[n].at(w, b)
        return found

    def turning(self, omega: Array, direction: Array, speed: float) -> ComplexArray:
        """Return the complex forces (n_h, n, 6) at frequencies (n,) and directions (n_h, n) at one speed, as :meth:`force`."""
        _refuse_outside("frequencies", "rad/s", omega, *self.omega_range)
        _refuse_outside("speeds", "m/s", np.array([speed]), *self.speed_range)
        if self._rule is not None:
            return self._rule.turning(omega, direction, speed)
        weights = self._weights(np.array([speed]))[0]
        return np.sum([w * self._tables[n].turning(omega, direction) for n, w in enumerate(weights) if w != 0.0], axis=0)

    @property
    def headings(self) -> Headings:
        """Headings that the data hold."""
        return self._tables[0].headings

    def _weights(self, speed: Array) -> Array:
        if len(self._speeds) == 1:
            return np.ones((len(speed), 1))
        from scipy.interpolate import make_interp_spline

        highest = 1 if self.interpolation == "linear" else 3
        spline = make_interp_spline(self._speeds, np.eye(len(self._speeds)), k=min(highest, len(self._speeds) - 1))
        return np.asarray(spline(np.clip(speed, self._speeds[0], self._speeds[-1])))


def _check_sets(sets: list[xr.Dataset]) -> None:
    for hydro in sets:
        if "excitation_force" not in hydro:
            raise InputError("SpeedTable: excitation_force expected in every data set, none found. Read or solve for it.")
    for key in ("rho", "g", "water_depth"):
        values = [float(h.attrs[key]) for h in sets]
        if not np.allclose(values, values[0], rtol=1e-6):
            raise InputError(f"SpeedTable: {key}: one value in all data sets expected, {', '.join(map(str, values))} found.")


def has_rule(hydro: xr.Dataset) -> bool:
    """Return whether the forces of a data set can be carried to any speed: at zero speed, in two parts, heave with pitch."""
    parts = "Froude_Krylov_force" in hydro or "diffraction_force" in hydro
    dofs = tuple(str(d) for d in hydro.influenced_dof.values)
    return parts and speed_of(hydro) == 0.0 and "added_mass" in hydro and speed_matrix(dofs) is not None


def _rule(hydro: xr.Dataset) -> _Rule | None:
    """Return the rule of a data set at zero speed."""
    if "Froude_Krylov_force" not in hydro:
        if "diffraction_force" not in hydro:
            raise InputError(
                "SpeedTable: Froude_Krylov_force or diffraction_force expected beside excitation_force in a data set at zero "
                "speed, none found. Give data sets at several speeds (at_speed(hydro, speed, hull=...) makes them)."
            )
        hydro = hydro.assign(Froude_Krylov_force=hydro.excitation_force - hydro.diffraction_force)
    dofs = tuple(str(d) for d in hydro.influenced_dof.values)
    if speed_matrix(dofs) is None:
        raise InputError(f"SpeedTable: heave with pitch and sway with yaw expected, {', '.join(dofs)} found.")
    omega = hydro.omega.values
    T = hydro.added_mass.values + hydro.radiation_damping.values / (1j * omega[:, None, None])
    A_inf = embed(hydro.added_mass_inf.values, dofs, (0, 1)) if "added_mass_inf" in hydro else None
    fluid = FluidMomentum(omega, embed(T, dofs, (1, 2)), A_inf)
    water = {"water_depth": float(hydro.attrs["water_depth"]), "g": float(hydro.attrs["g"])}
    return _Rule(HeadingTable.of(hydro), HeadingTable.of(hydro, "Froude_Krylov_force"), fluid, **water)


def _refuse_outside(what: str, unit: str, found: Array, lo: float, hi: float) -> None:
    bad = ~np.isfinite(found) | (found < lo - ROUNDING) | (found > hi + ROUNDING)
    if bad.any():
        raise InputError(
            f"SpeedTable: {what} within {lo:.4g}..{hi:.4g} {unit} expected, {found[bad][0]:.4g} {unit} found. "
            "Nothing is extrapolated: give data that cover it."
        )
