"""The drift of the panel method in long waves, reflection in short ones, a blend of the two between."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.errors import InputError

Array = NDArray[np.float64]

_PURPOSE = "joined_drift"
_DIMS = ("omega", "wave_direction", "influenced_dof")


def joined_drift(long: xr.Dataset, short: xr.Dataset, *, band: tuple[float, float] = (0.4, 0.8)) -> xr.Dataset:
    """Return the mean drift of the panel method with that of :func:`ogilvie.short_wave_drift` in short waves.

    Parameters
    ----------
    long : xarray.Dataset
        With ``mean_drift``, of :func:`ogilvie.mean_drift` or another program, up to waves of ``band[0]`` ship lengths at least.
    short : xarray.Dataset
        Of :func:`ogilvie.short_wave_drift` for the same directions, speed and water, from waves of ``band[1]`` lengths on.
    band : (float, float)
        Wave lengths over the length of the ship: `short` alone below the first, `long` alone above the second.

    Returns
    -------
    xarray.Dataset
        mean_drift at the frequencies of both, within the band and on their own side of it, NaN in components that one of them
        lacks; weight_short (omega): the part of `short` in it.

    Raises
    ------
    InputError
        Sets that do not belong together, or do not reach the band; a band that is none.

    Notes
    -----
    (1 - c) long + c short, c = 3 p^2 - 2 p^3, with p from 1 to 0 over the band; each set between its frequencies by monotone
    cubics. This is an interpolation and no theory: at speed neither side is right inside the band, and the panel method may
    lack most of the reflection below it (docs/theory/drift.md, section 8). At rest the panel method is right as far as its
    panels reach: move the band there.

    Examples
    --------
    >>> from ogilvie.hydro.drift_short import short_wave_drift
    >>> from ogilvie.mesh.shapes import wigley
    >>> short = short_wave_drift(wigley(100.0, panels=200), omega=np.linspace(0.8, 2.0, 7), speed=5.0)
    >>> long = short.assign(mean_drift=3.0 * short.mean_drift).isel(omega=slice(4))  # stands for that of mean_drift
    >>> joined_drift(long, short).weight_short.values.round(2).tolist()
    [0.0, 0.44, 0.99, 1.0, 1.0, 1.0, 1.0]
    """
    _check(long, short, band)
    length, g = float(short.attrs["length"]), float(short.attrs["g"])
    first, last = (float(np.sqrt(2.0 * np.pi * g / (ratio * length))) for ratio in band[::-1])
    both = {"long": long.omega.values.astype(float), "short": short.omega.values.astype(float)}
    if both["long"][-1] < last * (1.0 - 1e-9):
        raise InputError(
            f"{_PURPOSE}: long: frequencies up to {last:.4g} rad/s (waves of {band[0]:g} lengths) expected, up to "
            f"{both['long'][-1]:.4g} rad/s found. Compute more of them, or raise the band."
        )
    if both["short"][0] > first * (1.0 + 1e-9):
        raise InputError(
            f"{_PURPOSE}: short: frequencies from {first:.4g} rad/s on (waves of {band[1]:g} lengths) expected, from "
            f"{both['short'][0]:.4g} rad/s found. Compute more of them: they cost nothing."
        )
    w = _distinct(np.concatenate([both["long"][both["long"] <= last], both["short"][both["short"] >= first]]))
    p = np.clip((band[1] - 2.0 * np.pi * g / w**2 / length) / (band[1] - band[0]), 0.0, 1.0)
    c = 3.0 * p**2 - 2.0 * p**3
    drift = (1.0 - c)[:, None, None] * _at(w, long, c < 1.0) + c[:, None, None] * _at(w, short, c > 0.0)
    drift[..., np.isnan(drift).any(axis=(0, 1))] = np.nan
    coords = {"omega": w, "wave_direction": short.wave_direction, "influenced_dof": short.influenced_dof}
    result = xr.Dataset({"mean_drift": (_DIMS, drift), "weight_short": ("omega", c)}, coords=coords, attrs=short.attrs)
    text = (
        f"mean drift of {long.attrs.get('name', 'the panel method')} in waves longer than {band[1]:g} ship lengths, reflection "
        f"in those shorter than {band[0]:g}, a blend between"
    )
    return result.assign_attrs(water_depth=long.attrs.get("water_depth", np.inf), band=list(band), summary=text)


def _at(w: Array, drift: xr.Dataset, needed: NDArray[np.bool_]) -> Array:
    """Return mean drift (n, n_b, 6) at frequencies w where needed, zero (of what is known) elsewhere."""
    from scipy.interpolate import PchipInterpolator

    values = drift.mean_drift.values.astype(float)
    out = np.where(np.isnan(values).any(axis=(0, 1)), np.nan, np.zeros((len(w), *values.shape[1:])))
    known = ~np.isnan(values).any(axis=(0, 1))
    x = drift.omega.values.astype(float)
    inside = np.clip(w[needed], x[0], x[-1])  # beyond by rounding alone
    out[np.ix_(needed, np.arange(values.shape[1]), known)] = PchipInterpolator(x, values[..., known])(inside)
    return out


def _distinct(w: Array) -> Array:
    """Return ascending frequencies without those equal to another but for rounding."""
    w = np.sort(w)
    return np.asarray(w[np.append(True, np.diff(w) > 1e-9 * w[1:])])


def _check(long: xr.Dataset, short: xr.Dataset, band: tuple[float, float]) -> None:
    try:
        low, high = (float(x) for x in band)
    except (TypeError, ValueError):
        raise InputError(f"{_PURPOSE}: band: two wave lengths over the ship's length expected, {band!r} found.") from None
    if not 0.0 < low < high < np.inf:
        raise InputError(f"{_PURPOSE}: band: two positive wave lengths, the shorter first, expected, {band!r} found.")
    for name, one in (("long", long), ("short", short)):
        if not isinstance(one, xr.Dataset):
            raise InputError(f"{_PURPOSE}: {name}: a data set expected, {type(one).__name__} found.")
        if "mean_drift" not in one or one.mean_drift.dims != _DIMS:
            raise InputError(f"{_PURPOSE}: {name}: mean_drift over {', '.join(_DIMS)} expected, {list(one.data_vars)} found.")
    if "length" not in short.attrs:
        raise InputError(f"{_PURPOSE}: short: a result of short_wave_drift expected, one without the ship's length found.")
    for key in ("rho", "g", "speed"):
        found, wanted = long.attrs.get(key), short.attrs.get(key)
        if found is None or wanted is None or not np.isclose(found, wanted, rtol=1e-6, atol=0.0):
            raise InputError(f"{_PURPOSE}: long: attribute {key} {wanted} of short expected, {found} found.")
    if long.attrs.get("moments", "space") != "space":
        raise InputError(f"{_PURPOSE}: long: moments about the fixed origin (moments='space') expected, 'body' found.")
    b = long.wave_direction.values, short.wave_direction.values
    if len(b[0]) != len(b[1]) or not np.allclose(*b, rtol=0.0, atol=1e-6):
        found = np.degrees(b[0]).round(3).tolist()
        raise InputError(f"{_PURPOSE}: long: the directions of short expected, {found} deg found.")
    if long.influenced_dof.values.tolist() != short.influenced_dof.values.tolist():
        raise InputError(f"{_PURPOSE}: long: the dofs of short expected, {long.influenced_dof.values.tolist()} found.")
