"""The sea: wave components as arrays, and what they do at a point."""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.units import GRAVITY, SEA_WATER
from ogilvie.waves.dispersion import wavenumber
from ogilvie.waves.spreading import check_direction
from ogilvie.waves.synthesis import scattered, time_series

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Sea:
    """A sum of linear wave components: zeta = sum_j a_j cos(omega_j t - k_j (x cos b_j + y sin b_j) + phase_j).

    Made by :func:`ogilvie.regular`, :func:`ogilvie.bichromatic`, :func:`ogilvie.irregular`, :func:`ogilvie.sea_from_record`.
    Seas add with ``+``.

    Parameters
    ----------
    omega : (n,) array
        rad/s, > 0; shared by all realisations.
    direction : (n,) array
        Direction the components travel to, anticlockwise from +x, rad.
    amplitude : (n,) or (n_realisations, n) array
        m.
    phase : (n,) or (n_realisations, n) array
        rad. Broadcast with `amplitude` to one shape; a leading axis counts realisations.
    depth : float
        Water depth, m; infinite for deep water.
    g : float
        m/s2.
    seeds : tuple of int
        What the realisations were drawn from, if they were.
    label : str
        For titles.
    period : float, optional
        The time after which the sea repeats itself, s: every omega is a multiple of 2 pi/period. None if it never does.

    Attributes
    ----------
    wavenumber : (n,) array
        From the dispersion relation, rad/m.

    Raises
    ------
    InputError

    Examples
    --------
    >>> sea = Sea(omega=[0.6, 0.9], direction=[np.pi, np.pi], amplitude=[1.0, 0.5], phase=[0.0, 0.0])
    >>> float(sea.elevation(0.0)), sea.n_realisations
    (1.5, 1)
    """

    omega: Array
    direction: Array
    amplitude: Array
    phase: Array
    depth: float = np.inf
    g: float = GRAVITY
    seeds: tuple[int, ...] = ()
    label: str = "sea"
    period: float | None = None
    wavenumber: Array = field(init=False)

    def __post_init__(self) -> None:
        omega, direction = _one_axis(self.omega, "omega"), _one_axis(self.direction, "direction")
        if len(direction) != len(omega) or len(omega) == 0:
            raise InputError(f"sea: as many directions as frequencies expected, {len(direction)} and {len(omega)} found.")
        if omega.min() <= 0.0:
            raise InputError(f"omega: frequencies > 0 in rad/s expected, {omega.min():.6g} found.")
        check_direction(direction)
        amplitude, phase = _realisations(self.amplitude, self.phase, len(omega))
        k = wavenumber(omega, self.depth, g=self.g)
        if self.period is not None:
            check_period(omega, self.period)
        for name, value in (
            ("omega", omega),
            ("direction", direction),
            ("amplitude", amplitude),
            ("phase", phase),
            ("wavenumber", k),
        ):
            value.setflags(write=False)
            object.__setattr__(self, name, value)
        object.__setattr__(self, "seeds", tuple(int(s) for s in self.seeds))

    def __add__(self, other: "Sea") -> "Sea":
        if not isinstance(other, Sea):
            return NotImplemented
        return _sum(self, other)

    def __repr__(self) -> str:
        hs = np.atleast_1d(self.hs)
        height = f"{hs[0]:.4g}" if np.ptp(hs) < 1e-9 else f"{hs.min():.4g}..{hs.max():.4g}"
        return f"Sea({self.label}: hs {height} m, {len(self.omega)} components, {self.n_realisations} realisation(s))"

    @property
    def n_realisations(self) -> int:
        """Number of realisations, 1 if there is no axis for them."""
        return int(np.prod(self.amplitude.shape[:-1], dtype=int))

    @property
    def hs(self) -> Array:
        """Significant wave height 4 sqrt(sum a^2 / 2) of each realisation, m; shape () or (n_realisations,)."""
        return 4.0 * np.sqrt(0.5 * np.sum(self.amplitude**2, axis=-1))

    @property
    def complex_amplitude(self) -> ComplexArray:
        """A = a exp(i phase), (..., n): zeta = Re sum A exp(i (omega t - k (x cos b + y sin b)))."""
        return self.amplitude * np.exp(1j * self.phase)

    def isel(self, realisation: int | slice | list[int]) -> "Sea":
        """Return one realisation (an int takes the axis away) or some (slice, list)."""
        if self.amplitude.ndim == 1:
            raise InputError("isel: the sea has no axis of realisations; it was not made from a sequence of seeds.")
        seeds = np.array(self.seeds)[realisation] if len(self.seeds) == self.n_realisations else self.seeds
        return replace(
            self,
            amplitude=self.amplitude[realisation],
            phase=self.phase[realisation],
            seeds=tuple(np.atleast_1d(seeds)),
        )

    def elevation(self, t: ArrayLike, x: ArrayLike = 0.0, y: ArrayLike = 0.0) -> Array:
        """Return the elevation of the surface, m.

        Parameters
        ----------
        t : array
            Time, s.
        x, y : array
            Place, m: a fixed point (numbers), or arrays that broadcast with `t` (a moving probe, a map).

        Returns
        -------
        array
            (..., shape) with shape that of t, x and y together; realisations lead.

        Notes
        -----
        At a fixed point a series of equal steps is summed by FFT where the step divides the period of the sea, else by turning
        phasors.
        """
        return self._sum(np.ones(len(self.omega), dtype=complex), t, x, y)

    def pressure(self, t: ArrayLike, x: ArrayLike = 0.0, y: ArrayLike = 0.0, *, z: float, rho: float = SEA_WATER) -> Array:
        """Return the dynamic pressure rho g cosh k(z + h)/cosh(kh) zeta at the height z <= 0, Pa; see :meth:`elevation`."""
        down, up, bottom = self._decay(z)
        return self._sum(rho * self.g * (down + up) / (1.0 + bottom), t, x, y)

    def velocity(self, t: ArrayLike, x: ArrayLike = 0.0, y: ArrayLike = 0.0, *, z: float) -> Array:
        """Return the velocity of the water at the height z <= 0, m/s; shape (..., shape, 3).

        Notes
        -----
        Horizontal omega cosh k(z + h)/sinh(kh) zeta along the direction, vertical Re i omega sinh k(z + h)/sinh(kh) A e^(i...).
        """
        down, up, bottom = self._decay(z)
        horizontal = self.omega * (down + up) / (1.0 - bottom)
        vertical = 1j * self.omega * (down - up) / (1.0 - bottom)
        factors = (horizontal * np.cos(self.direction), horizontal * np.sin(self.direction), vertical)
        return np.stack([self._sum(factor, t, x, y) for factor in factors], axis=-1)

    def _sum(self, factor: ArrayLike, t: ArrayLike, x: ArrayLike, y: ArrayLike) -> Array:
        """Return Re sum factor A exp(i (omega t - k.x))."""
        C = self.complex_amplitude * np.asarray(factor)
        kx, ky = self.wavenumber * np.cos(self.direction), self.wavenumber * np.sin(self.direction)
        t, x, y = (_finite(v, name) for v, name in ((t, "t"), (x, "x"), (y, "y")))
        if x.ndim == y.ndim == 0 and t.ndim == 1:
            return time_series(self.omega, C * np.exp(-1j * (kx * x + ky * y)), t, period=self.period)
        return scattered(self.omega, kx, ky, C, *np.broadcast_arrays(t, x, y))

    def _decay(self, z: float) -> tuple[Array, Array, Array]:
        """Return exp(kz), exp(-k(z + 2h)) and exp(-2kh)."""
        if not -self.depth <= z <= 0.0:
            raise InputError(f"z: a height between the bottom ({-self.depth:.6g} m) and still water (0) expected, {z!r} found.")
        k = self.wavenumber
        return np.exp(k * z), np.exp(-k * (z + 2.0 * self.depth)), np.exp(-2.0 * k * self.depth)


def check_period(omega: Array, period: float) -> None:
    """Raise :class:`InputError` unless every omega is a multiple of 2 pi / period."""
    if not (np.isfinite(period) and period > 0.0):
        raise InputError(f"period: a positive time in s (or None) expected, {period!r} found.")
    cycles = omega * period / (2.0 * np.pi)
    if np.any(np.abs(cycles - np.rint(cycles)) > 1e-9 * np.maximum(cycles, 1.0)):
        raise InputError(f"period: a time after which every component repeats expected, {period:.6g} s is not.")


def _realisations(amplitude: ArrayLike, phase: ArrayLike, n: int) -> tuple[Array, Array]:
    a, p = np.array(amplitude, dtype=float), np.array(phase, dtype=float)
    try:
        a, p = np.broadcast_arrays(a, p)
    except ValueError:
        raise InputError(f"sea: amplitude and phase of one shape expected, {a.shape} and {p.shape} found.") from None
    if a.ndim not in (1, 2) or a.shape[-1] != n or a.size == 0:
        raise InputError(f"sea: amplitude and phase ({n},) or (n_realisations, {n}) expected, {a.shape} found.")
    if not (np.all(np.isfinite(a)) and np.all(a >= 0.0) and np.all(np.isfinite(p))):
        raise InputError("sea: finite amplitudes >= 0 and finite phases expected, others found.")
    return a, p


def _sum(one: Sea, two: Sea) -> Sea:
    if (one.depth, one.g) != (two.depth, two.g):
        raise InputError(
            f"sea + sea: one depth and gravity expected, {one.depth} m, {one.g} m/s2 and {two.depth} m, {two.g} m/s2 found."
        )
    if one.amplitude.ndim == two.amplitude.ndim == 2 and one.n_realisations != two.n_realisations:
        raise InputError(
            f"sea + sea: as many realisations in both expected, {one.n_realisations} and {two.n_realisations} found."
        )
    if one.seeds and two.seeds and np.any(one.phase == two.phase[..., :1]):
        raise InputError(
            f"sea + sea: independent seas expected, both were drawn from the same seeds {one.seeds[:3]}...: their phases are "
            "the same numbers. Give the second sea other seeds, such as range(1000, 1000 + n)."
        )
    lead = np.broadcast_shapes(one.amplitude.shape[:-1], two.amplitude.shape[:-1])

    def joined(name: str) -> Array:
        values = (getattr(one, name), getattr(two, name))
        return np.concatenate([np.broadcast_to(v, (*lead, v.shape[-1])) for v in values], axis=-1)

    return Sea(
        omega=np.r_[one.omega, two.omega],
        direction=np.r_[one.direction, two.direction],
        amplitude=joined("amplitude"),
        phase=joined("phase"),
        depth=one.depth,
        g=one.g,
        seeds=one.seeds + two.seeds,
        label=f"{one.label} + {two.label}",
        period=one.period if one.period == two.period else None,
    )


def _one_axis(value: ArrayLike, name: str) -> Array:
    array = np.array(value, dtype=float)
    if array.ndim != 1 or not np.all(np.isfinite(array)):
        raise InputError(f"{name}: a finite array of one axis expected, shape {array.shape} found (or NaN in it).")
    return array


def _finite(value: ArrayLike, name: str) -> Array:
    array = np.asarray(value, dtype=float)
    if not np.all(np.isfinite(array)):
        raise InputError(f"{name}: finite numbers expected, {int((~np.isfinite(array)).sum())} NaN or infinite found.")
    return array
