"""Irregular seas: components drawn from a spectrum."""

from collections.abc import Sequence
from math import ceil
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.units import GRAVITY
from ogilvie.waves.field import Sea
from ogilvie.waves.spectrum import Spectrum
from ogilvie.waves.spreading import Spreading, check_direction

Array = NDArray[np.float64]
Method = Literal["equal-frequency", "equal-energy"]
Random = Literal["phase", "amplitude"]

DEFAULT_COMPONENTS = 300
_CUT = (1e-4, 0.998)  # fractions of the variance between which the default range of frequencies lies
_PLACES = 1964  # seed of what all realisations share: places within the bands, order of the directions


def irregular(
    spectrum: Spectrum,
    *,
    direction: float,
    spreading: Spreading | None = None,
    n: int | None = None,
    duration: float | None = None,
    seed: int | Sequence[int] = 0,
    method: Method = "equal-frequency",
    random: Random = "phase",
    omega_range: tuple[float, float] | None = None,
    n_directions: int = 15,
    depth: float = np.inf,
    g: float = GRAVITY,
) -> Sea:
    """Return an irregular sea drawn from a spectrum.

    Parameters
    ----------
    spectrum : Spectrum
    direction : float
        Main direction the waves travel to, rad; pi is head seas for a vessel on heading 0.
    spreading : Spreading, optional
        Long-crested without.
    n : int, optional
        Number of components, 300 by default: bands with one frequency at a random place in each, so that the sea never repeats.
    duration : float, optional
        s. In place of `n`: frequencies are the multiples of 2 pi/duration, so that the sea repeats after just that time (make
        it as long as the simulation) and sums are taken by FFT.
    seed : int or sequence of int
        Seed of the random numbers. A sequence (``range(100)``) makes as many realisations with a leading axis; realisation i is
        the sea that its seed alone gives. Frequencies and directions are the same in all.
    method : {"equal-frequency", "equal-energy"}
        Bands of equal width or of equal variance.
    random : {"phase", "amplitude"}
        Random phases with the amplitudes of the spectrum, or also random (Rayleigh distributed) amplitudes, which makes the sea
        a Gaussian process for any n, its Hs random.
    omega_range : (float, float), optional
        rad/s. By default 0.01 % of the variance is left out below and 0.2 % above (Hs 0.1 % low).
    n_directions : int
        Number of different directions of a spread sea, each with an equal share of the energy.
    depth, g : float
        m, m/s2.

    Returns
    -------
    Sea

    Raises
    ------
    InputError

    Notes
    -----
    a_j = sqrt(2 int S d omega) over band j, so that sum a^2/2 is the variance of the spectrum within the range. In a spread sea
    every component has one direction; components of one frequency and different directions would interfere and make the sea
    inhomogeneous (Jefferys 1987).

    References
    ----------
    Tucker, Challenor and Carter (1984), Applied Ocean Research 6, 118-122; Jefferys (1987), Applied Ocean Research 9, 234-244.

    Examples
    --------
    >>> from ogilvie.waves.spectra import jonswap
    >>> sea = irregular(jonswap(hs=4.25, tp=9.8), direction=np.pi, seed=range(3))
    >>> sea.phase.shape, sea.hs.round(3)
    ((3, 300), array([4.246, 4.246, 4.246]))
    """
    _check(spectrum, direction, spreading, method, random)
    first, last = _range(spectrum, omega_range)
    if duration is None:
        omega, variance = _bands(spectrum, first, last, _components(n), method)
        period = None
    else:
        omega, variance = _grid(spectrum, first, last, duration, n, method)
        period = float(duration)
    directions = _directions(direction, spreading, len(omega), n_directions)
    seeds = _seeds(seed)
    draws = [_draw(s, variance, random) for s in seeds]
    amplitude, phase = (np.stack(values) for values in zip(*draws, strict=True))
    single = isinstance(seed, int | np.integer)
    return Sea(
        omega=omega,
        direction=directions,
        amplitude=amplitude[0] if single else amplitude,
        phase=phase[0] if single else phase,
        depth=depth,
        g=g,
        seeds=seeds,
        label=f"{spectrum.name}, hs {spectrum.hs:.3g} m, tp {spectrum.tp:.3g} s",
        period=period,
    )


def _bands(spectrum: Spectrum, first: float, last: float, n: int, method: str) -> tuple[Array, Array]:
    """Return one frequency in each of n bands and the variance of the bands."""
    place = np.random.default_rng(_PLACES).uniform(size=n)
    if method == "equal-frequency":
        edges = np.linspace(first, last, n + 1)
        return edges[:-1] + place * np.diff(edges), np.diff(spectrum.cumulative(edges))
    total = spectrum.cumulative(np.inf)
    low, high = spectrum.cumulative([first, last])
    share = low + (np.arange(n) + place) * (high - low) / n
    return spectrum.quantile(share / total), np.full(n, (high - low) / n)


def _grid(spectrum: Spectrum, first: float, last: float, duration: float, n: int | None, method: str) -> tuple[Array, Array]:
    """Return the multiples of 2 pi / duration within the range and the variance around each."""
    if n is not None:
        raise InputError(
            f"irregular: n or duration expected, both found; the duration fixes the number of components (n = {n})."
        )
    if method != "equal-frequency":
        raise InputError(f"irregular: duration needs method 'equal-frequency', {method!r} found; give n in place of duration.")
    if not (np.isfinite(duration) and duration > 0.0):
        raise InputError(f"duration: a positive number of seconds expected, {duration!r} found.")
    step = 2.0 * np.pi / duration
    k = np.arange(max(np.ceil(first / step), 1.0), np.floor(last / step) + 1.0)
    if len(k) < 20:
        raise InputError(
            f"duration: at least 20 components expected, {duration:.6g} s gives {len(k)} from {first:.4g} to {last:.4g} rad/s. "
            f"Take at least {ceil(21 * 2 * np.pi / (last - first))} s, or a number of components."
        )
    edges = step * np.r_[k - 0.5, k[-1] + 0.5]
    return step * k, np.diff(spectrum.cumulative(edges))


def _draw(seed: int, variance: Array, random: str) -> tuple[Array, Array]:
    """Return amplitudes and phases of one realisation."""
    rng = np.random.default_rng(seed)
    phase = rng.uniform(0.0, 2.0 * np.pi, len(variance))
    amplitude = np.sqrt(2.0 * variance) if random == "phase" else np.sqrt(variance) * rng.rayleigh(size=len(variance))
    return amplitude, phase


def _directions(main: float, spreading: Spreading | None, n: int, n_directions: int) -> Array:
    """Return one direction per component: equally probable ones, in an order shuffled anew in every block of frequencies."""
    if spreading is None:
        return np.full(n, float(main))
    if not (isinstance(n_directions, int | np.integer) and 1 <= n_directions <= n):
        raise InputError(
            f"n_directions: a whole number from 1 to the number of components {n} expected, {n_directions!r} found."
        )
    offsets = spreading.quantile((np.arange(n_directions) + 0.5) / n_directions)
    rng = np.random.default_rng([_PLACES, n_directions])
    order = np.concatenate([rng.permutation(n_directions) for _ in range(-(-n // n_directions))])[:n]
    around = float(main) + offsets[order]
    return np.where(around > np.pi, around - 2.0 * np.pi, np.where(around <= -np.pi, around + 2.0 * np.pi, around))


def _seeds(seed: int | Sequence[int]) -> tuple[int, ...]:
    values = (seed,) if isinstance(seed, int | np.integer) else tuple(seed) if np.iterable(seed) else (seed,)
    whole = [isinstance(s, int | np.integer) and not isinstance(s, bool) and s >= 0 for s in values]
    if not values or not all(whole):
        raise InputError(f"seed: a whole number >= 0 or a sequence of them expected, {seed!r} found.")
    if len(set(values)) != len(values):
        raise InputError(f"seed: different seeds expected, {seed!r} repeats some; its realisations would be the same sea.")
    return tuple(int(s) for s in values)


def _components(n: int | None) -> int:
    if n is None:
        return DEFAULT_COMPONENTS
    if not isinstance(n, int | np.integer) or isinstance(n, bool) or n < 1:
        raise InputError(f"n: a whole number >= 1 of components expected, {n!r} found.")
    return int(n)


def _range(spectrum: Spectrum, omega_range: tuple[float, float] | None) -> tuple[float, float]:
    if omega_range is None:
        first, last = spectrum.quantile(_CUT)
        return float(first), float(last)
    values = np.asarray(omega_range, dtype=float)
    if values.shape != (2,) or not (0.0 <= values[0] < values[1] < np.inf):
        raise InputError(f"omega_range: two frequencies 0 <= first < last in rad/s expected, {omega_range!r} found.")
    low, high = spectrum.cumulative(values)
    if not high > low:
        raise InputError(f"omega_range: the spectrum has no energy between {values[0]:.4g} and {values[1]:.4g} rad/s.")
    return float(values[0]), float(values[1])


def _check(spectrum: Spectrum, direction: float, spreading: Spreading | None, method: str, random: str) -> None:
    if not isinstance(spectrum, Spectrum):
        raise InputError(f"irregular: a spectrum, such as jonswap(...) returns, expected, {type(spectrum).__name__} found.")
    if np.ndim(direction) != 0:
        raise InputError("direction: one main direction expected, several found; add seas with + for several systems.")
    check_direction(direction)
    if spreading is not None and not isinstance(spreading, Spreading):
        raise InputError(f"spreading: what spreading(s=...) returns, or None, expected, {type(spreading).__name__} found.")
    for name, value, allowed in (
        ("method", method, ("equal-frequency", "equal-energy")),
        ("random", random, ("phase", "amplitude")),
    ):
        if value not in allowed:
            raise InputError(f"{name}: one of {', '.join(map(repr, allowed))} expected, {value!r} found.")
