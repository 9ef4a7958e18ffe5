"""First-order wave excitation: Froude-Krylov and diffraction force of each wave component."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.schema import DOFS
from ogilvie.loads.base import ComplexArray, Surroundings, Terms
from ogilvie.loads.encounter import encounter_kernel
from ogilvie.loads.excitation_part import NAMES, PARTS, only_part
from ogilvie.loads.interpolation import vessel_headings
from ogilvie.loads.kernel import Kernel
from ogilvie.loads.speed_table import HeadingTable, SpeedTable, has_rule
from ogilvie.waves.field import Sea

Array = NDArray[Any]

#: Largest share of the sea's variance that may lie outside the frequencies of the coefficients (left out with a warning).
NEGLIGIBLE = 1e-3
_TURNS_LEAST = np.radians(2.0)  # range of headings below which large motions make no sense


@dataclass(frozen=True, eq=False, init=False)
class WaveExcitation:
    """Force of the waves on the body, linear in the wave amplitude.

    Parameters
    ----------
    hydro : xarray.Dataset or sequence of them
        Hydrodynamic data set with ``excitation_force``; or several of one vessel at different speeds.
    position : {"instantaneous", "slow", "mean"}
        Where the waves are met in large motions: where the vessel is, at the heading it has; the same with its motion in the
        waves filtered to about a fifth, which is right beside a load of slow drift, that has this part in it; or in the frame
        that advances steadily, as small motions assume.
    speeds : (float, float), optional
        Mean speeds through the water, m/s, that a vessel in large motions may have. By default those of the data sets; with one
        at zero speed up to half as fast again as the vessel's own, and 2 m/s either way for one that lies still.
    part : {"total", "diffraction", "Froude-Krylov"}
        The whole force; or one part of it, where another load (:class:`ogilvie.NonlinearFroudeKrylov`) has the other. Parts
        need ``Froude_Krylov_force`` or ``diffraction_force`` in the data.

    Raises
    ------
    InputError
        The data set holds no wave forces, or not in parts; several sets that do not belong together.

    Notes
    -----
    F(t) = Re sum_j X(w_j, b_j, U) a_j exp(i (w_e t + phase)_j) with b_j the direction relative to the bow and the signed
    encounter frequency w_e = w - k U cos(b). X is interpolated as a complex number: cubic splines in frequency and in heading,
    periodic in heading where the data go all around. Data of a port-starboard symmetric hull that cover one side serve both.

    X at the vessel's speed comes from the data sets at several speeds, or from one at zero speed with ``Froude_Krylov_force``
    or ``diffraction_force`` by the rule of :func:`ogilvie.at_speed`, which moves the diffraction part alone. Where neither is
    possible it is taken as it is, with a warning.

    References
    ----------
    Paper C (Vu), Eq. (29).

    Examples
    --------
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> w, Z = np.linspace(0.2, 2.0, 10), np.zeros((10, 6, 6))
    >>> X = np.ones((10, 1, 6)) * w[:, None, None] ** 2
    >>> hydro = hydro_from_arrays(omega=w, added_mass=Z, radiation_damping=Z, wave_direction=[np.pi], excitation_force=X)
    >>> WaveExcitation(hydro).force([0.5], [np.pi])[0, 2].round(6)
    np.complex128(0.25+0j)
    """

    hydro: xr.Dataset
    _table: HeadingTable = field(repr=False)
    _speeds: SpeedTable | None = field(repr=False)
    position: str = "instantaneous"
    speeds: tuple[float, float] | None = None
    part: str = "total"
    name: str = "excitation"

    def __init__(
        self,
        hydro: xr.Dataset | Sequence[xr.Dataset],
        *,
        position: str = "instantaneous",
        speeds: tuple[float, float] | None = None,
        part: str = "total",
    ) -> None:
        if part not in PARTS:
            raise InputError(f"WaveExcitation: part: one of {', '.join(PARTS)} expected, {part!r} found.")
        if position not in ("instantaneous", "slow", "mean"):
            raise InputError(f"WaveExcitation: position 'instantaneous', 'slow' or 'mean' expected, {position!r} found.")
        if speeds is not None and not (len(speeds) == 2 and np.all(np.isfinite(speeds)) and speeds[0] < speeds[1]):
            raise InputError(f"WaveExcitation: speeds: two ascending numbers of m/s expected, {speeds!r} found.")
        sets = [hydro] if isinstance(hydro, xr.Dataset) or not isinstance(hydro, Sequence) else list(hydro)
        for one in sets:
            if not isinstance(one, xr.Dataset):
                raise InputError(
                    f"WaveExcitation: hydrodynamic data sets (xarray.Dataset) expected, {type(one).__name__} found."
                )
            if "excitation_force" not in one:
                raise InputError(
                    "WaveExcitation: excitation_force expected in the data set, not found. Read or solve for wave forces."
                )
        sets = [only_part(one, part) for one in sets]
        object.__setattr__(self, "hydro", sets[0])
        object.__setattr__(self, "position", position)
        object.__setattr__(self, "speeds", None if speeds is None else (float(speeds[0]), float(speeds[1])))
        object.__setattr__(self, "part", part)
        object.__setattr__(self, "name", NAMES[part])
        object.__setattr__(self, "_table", HeadingTable.of(sets[0]))
        object.__setattr__(self, "_speeds", SpeedTable(sets) if len(sets) > 1 or has_rule(sets[0]) else None)

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return PARTS[self.part]

    def force(self, omega: ArrayLike, direction: ArrayLike, speed: float | None = None) -> ComplexArray:
        """Return the complex force (n, 6) per metre of wave amplitude.

        Parameters
        ----------
        omega : (n,) array
            Frequency of the incident waves, rad/s, within the data.
        direction : (n,) array
            Direction that the waves travel to, relative to the bow, rad.
        speed : float, optional
            m/s; that of the (first) data set by default.

        Raises
        ------
        InputError
            Frequency, heading or speed outside the data.
        """
        w, b = np.broadcast_arrays(np.atleast_1d(np.asarray(omega, dtype=float)), np.asarray(direction, dtype=float))
        lo, hi = self._range
        if len(w) and (w.min() < lo * (1 - 1e-9) or w.max() > hi * (1 + 1e-9)):
            raise InputError(
                f"WaveExcitation: frequencies within {lo:.4g}..{hi:.4g} rad/s expected, {w.min():.4g}..{w.max():.4g} found."
            )
        w, U = np.clip(w, lo, hi), self._own_speed if speed is None else speed
        if self._speeds is None or self._own_speed == U:
            return self._table.at(w, b)
        return self._speeds.force(w, b, U)

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the arrays for the time loop."""
        at, own = surroundings.speed, self._own_speed
        if self._speeds is None and abs(at - own) > 1e-6 * max(1.0, abs(at)):
            warnings.warn(
                f"WaveExcitation: the coefficients hold for {own:.4g} m/s, the vessel sails at {at:.4g} m/s; "
                "their dependence on speed is left out. Give coefficients for the vessel's speed: at_speed(hydro, speed), or "
                "zero-speed ones with Froude_Krylov_force.",
                OgilvieWarning,
                stacklevel=2,
            )
        speed = at if self._speeds is not None else None
        encounter = partial(_encounter, self, surroundings) if self.position != "mean" else None
        return Terms(wave=partial(_force_in_sea, self, speed), encounter=encounter)

    def _turning(self, omega: Array, direction: Array, speed: float) -> ComplexArray:
        """Return the forces (n_h, n, 6) at frequencies (n,) and directions (n_h, n)."""
        return self._table.turning(omega, direction) if self._speeds is None else self._speeds.turning(omega, direction, speed)

    @property
    def _own_speed(self) -> float:
        return float(self.hydro.attrs.get("speed", 0.0))

    @property
    def _range(self) -> tuple[float, float]:
        if self._speeds is not None:
            return self._speeds.omega_range
        w = self.hydro.omega.values
        return float(w[0]), float(w[-1])


def _force_in_sea(load: WaveExcitation, speed: float | None, sea: Sea, heading: float) -> ComplexArray:
    """Return the force of all components; those outside the data must hold a negligible share of the variance."""
    _compare_depth(load, sea)
    inside = _covered(load, sea)
    force = np.zeros((len(sea.omega), len(DOFS)), dtype=complex)
    force[inside] = load.force(sea.omega[inside], sea.direction[inside] - heading, speed)
    return force


def _covered(load: WaveExcitation, sea: Sea) -> NDArray[np.bool_]:
    """Return which components have data; the others must hold a negligible share of the variance."""
    lo, hi = load._range
    inside = (sea.omega >= lo * (1 - 1e-9)) & (sea.omega <= hi * (1 + 1e-9))
    if not inside.all():
        variance = np.atleast_2d(sea.amplitude**2).mean(axis=0)
        _report_lost(float(variance[~inside].sum() / variance.sum()) if variance.any() else 0.0, sea.omega, lo, hi)
    return inside


def _encounter(load: WaveExcitation, surroundings: Surroundings, sea: Sea, ramp: float) -> Kernel:
    """Return the compiled force of the sea where the vessel is."""
    inside = _covered(load, sea)
    w, direction = sea.omega[inside], sea.direction[inside]
    limits = vessel_headings(load._table.headings, np.unique(direction), surroundings.heading)
    if limits is not None and limits[1] - limits[0] < _TURNS_LEAST:
        raise InputError(
            f"WaveExcitation: large motions need data for the headings that the vessel takes; for this sea they hold from "
            f"{np.degrees(limits[0]):.4g} to {np.degrees(limits[1]):.4g} deg only. Give coefficients for more headings, or "
            "position='mean' to take the force at the mean heading."
        )
    part = replace(sea, omega=w, direction=direction, amplitude=sea.amplitude[..., inside], phase=sea.phase[..., inside])

    def force(omega: Array, b: Array, speed: float) -> ComplexArray:
        return load._turning(omega, np.broadcast_to(b[:, None], (len(b), len(omega))), speed)

    speeds, limits_of_speed = _speeds_met(load, surroundings.speed)
    return encounter_kernel(
        force,
        part,
        ramp=ramp,
        speeds=speeds,
        limits=limits_of_speed,
        slow=load.position == "slow",
        headings=load._table.headings,
        heading=surroundings.heading,
    )


def _speeds_met(load: WaveExcitation, speed: float) -> tuple[Array, tuple[float, float]]:
    """Return the speeds (n,) of the table and the range of mean speeds that it serves, m/s.

    Raises
    ------
    InputError
        A vessel's speed, or wished speeds, outside the data.
    """
    around = max(2.0, 0.5 * speed)
    if load._speeds is None:  # the force does not depend on speed: near the data's own, and near the vessel's (with a warning)
        own = load._own_speed
        return np.array([own]), load.speeds or (min(own, speed) - around, max(own, speed) + around)
    data = load._speeds.speed_range
    limits = load.speeds or (data if np.isfinite(data[0]) else (-0.5 * around, speed + around))
    lo, hi = max(limits[0], data[0]), min(limits[1], data[1])
    if not (lo <= speed <= hi and data[0] <= limits[0] and limits[1] <= data[1]):
        raise InputError(
            f"WaveExcitation: a vessel's speed and `speeds` within the data ({data[0]:.4g}..{data[1]:.4g} m/s) expected, "
            f"{speed:.4g} and {limits} found."
        )
    return np.unique(np.r_[np.linspace(lo, hi, 9), speed, load._speeds.speeds[1:-1]].clip(lo, hi).round(9)), (lo, hi)


def _compare_depth(load: WaveExcitation, sea: Sea) -> None:
    """Warn where coefficients and sea differ in depth and the waves feel it (k h < pi)."""
    own = float(load.hydro.attrs.get("water_depth", np.inf))
    shallow = min(own, sea.depth)
    if own != sea.depth and abs(own - sea.depth) > 0.01 * shallow and sea.wavenumber.min() * shallow < np.pi:
        warnings.warn(
            f"WaveExcitation: the coefficients hold for a water depth of {own:g} m, the sea for {sea.depth:g} m. "
            "Make both for one depth.",
            OgilvieWarning,
            stacklevel=5,
        )


def _report_lost(share: float, omega: ComplexArray, lo: float, hi: float) -> None:
    """Refuse a sea that the data do not cover, warn of one that they cover but for a negligible rest."""
    found = (
        f"WaveExcitation: the coefficients cover {lo:.4g}..{hi:.4g} rad/s, the sea has components from {omega.min():.4g} to "
        f"{omega.max():.4g} rad/s; {100 * share:.3g} % of its variance lies outside."
    )
    if share > NEGLIGIBLE:
        raise InputError(f"{found} At most {100 * NEGLIGIBLE:g} % can be left out: extend the coefficients or limit the sea.")
    if share > 0.0:
        warnings.warn(f"{found} It exerts no force.", OgilvieWarning, stacklevel=5)
