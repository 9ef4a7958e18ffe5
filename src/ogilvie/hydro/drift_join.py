"""The drift of the panel method with reflection of short waves: a floor at speed, the continuation where panels end."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.errors import InputError

Array = NDArray[np.float64]

_PURPOSE = "joined_drift"
_DIMS = ("omega", "wave_direction", "influenced_dof")
_RAISED = 2  # surge and sway
_FADED = 0.5  # wave length, over that of the last frequency of the panel method, where nothing of it is left


def joined_drift(long: xr.Dataset, short: xr.Dataset, *, band: tuple[float, float] = (0.8, 1.2)) -> xr.Dataset:
    """Return the mean drift of the panel method with that of :func:`ogilvie.short_wave_drift` in short waves.

    Parameters
    ----------
    long : xarray.Dataset
        With ``mean_drift``, of :func:`ogilvie.mean_drift` or another program, up to waves of ``band[0]`` ship lengths at least.
    short : xarray.Dataset
        Of :func:`ogilvie.short_wave_drift` for the same directions, speed and water, from waves of ``band[1]`` lengths on.
    band : (float, float)
        Wave lengths over the length of the ship between which reflection fades out as a floor at speed.

    Returns
    -------
    xarray.Dataset
        mean_drift at the frequencies of both (of `short` from ``band[1]`` on), NaN in components that one of them lacks.

    Raises
    ------
    InputError
        Sets that do not belong together, or do not reach the band; a band that is none.

    Notes
    -----
    *At rest* the panel method is right, and is taken up to its last frequency. *At speed* it lacks reflection, so
    surge and sway are raised to that where it is larger: with l of `long`, s of `short` and e the sign of s,

        F = l + e clip(e (c s - l), 0, 2 c abs(s)),

    the larger of l and c s where both have one sign, and continuous in any case; c = 1 in waves shorter than ``band[0]``, 0 in
    those longer than ``band[1]``, 3 p^2 - 2 p^3 between. *Beyond the last frequency* of `long` the difference from `short`
    fades out until the wave length is halved. Between their frequencies both are monotone cubics.

    This is a rule and no theory: it adds no reflection to the motions' part, and knows nothing of yaw (docs/theory/drift.md,
    section 8).

    Examples
    --------
    >>> from ogilvie.hydro.drift_short import short_wave_drift
    >>> from ogilvie.mesh.shapes import wigley
    >>> short = short_wave_drift(wigley(100.0, panels=200), omega=np.linspace(0.7, 2.0, 6), speed=5.0)
    >>> long = short.assign(mean_drift=0.4 * short.mean_drift).isel(omega=slice(4))  # stands for that of mean_drift
    >>> (joined_drift(long, short).mean_drift / short.mean_drift)[:, 0, 0].values.round(2).tolist()
    [0.4, 1.0, 1.0, 1.0, 1.0, 1.0]
    """
    _check(long, short, band)
    length, g = float(short.attrs["length"]), float(short.attrs["g"])
    first, last = (float(np.sqrt(2.0 * np.pi * g / (ratio * length))) for ratio in band[::-1])
    ours, theirs = short.omega.values.astype(float), long.omega.values.astype(float)
    end = float(theirs[-1])
    if end < last * (1.0 - 1e-9):
        raise InputError(
            f"{_PURPOSE}: long: frequencies up to {last:.4g} rad/s (waves of {band[0]:g} lengths) expected, up to "
            f"{end:.4g} rad/s found. Compute more of them."
        )
    if ours[0] > first * (1.0 + 1e-9):
        raise InputError(
            f"{_PURPOSE}: short: frequencies from {first:.4g} rad/s on (waves of {band[1]:g} lengths) expected, from "
            f"{ours[0]:.4g} rad/s found. Compute more of them: they cost nothing."
        )
    w = _distinct(np.concatenate([theirs, ours[ours >= first]]))
    panels, walls = _at(w, long), _at(w, short)
    if float(short.attrs["speed"]) != 0.0:
        c = _step((band[1] - 2.0 * np.pi * g / w**2 / length) / (band[1] - band[0]))
        panels = np.where((w <= end)[:, None, None], _raised(panels, walls, c), panels)
    at_end = int(np.searchsorted(w, end * (1.0 - 1e-9)))
    rest = 1.0 - _step((1.0 - (end / w) ** 2) / (1.0 - _FADED))
    beyond = walls + rest[:, None, None] * (panels[at_end] - walls[at_end])
    drift = np.where((w > end)[:, None, None], beyond, panels)
    drift[..., np.isnan(panels + walls).any(axis=(0, 1))] = np.nan
    coords = {"omega": w, "wave_direction": short.wave_direction, "influenced_dof": short.influenced_dof}
    result = xr.Dataset({"mean_drift": (_DIMS, drift)}, coords=coords, attrs=short.attrs)
    text = f"mean drift of {long.attrs.get('name', 'the panel method')} up to {end:.4g} rad/s and reflection of short waves"
    return result.assign_attrs(water_depth=long.attrs.get("water_depth", np.inf), band=list(band), summary=text)


def _raised(panels: Array, walls: Array, c: Array) -> Array:
    """Return the drift of the panels (n, n_b, 6) with surge and sway raised to c times that of the walls where it is larger."""
    out = panels.copy()
    drift, floor = panels[..., :_RAISED], c[:, None, None] * walls[..., :_RAISED]
    sign = np.sign(floor)
    out[..., :_RAISED] = drift + sign * np.clip(sign * (floor - drift), 0.0, 2.0 * np.abs(floor))
    return out


def _step(p: Array) -> Array:
    """Return the smooth step from 0 at p = 0 to 1 at p = 1."""
    p = np.clip(p, 0.0, 1.0)
    return np.asarray(3.0 * p**2 - 2.0 * p**3)


def _at(w: Array, drift: xr.Dataset) -> Array:
    """Return mean drift (n, n_b, 6) at frequencies w; outside those of the data that at their ends."""
    from scipy.interpolate import PchipInterpolator

    x, values = drift.omega.values.astype(float), drift.mean_drift.values.astype(float)
    known = ~np.isnan(values).any(axis=(0, 1))
    out = np.full((len(w), *values.shape[1:]), np.nan)
    out[..., known] = PchipInterpolator(x, values[..., known])(np.clip(w, x[0], x[-1]))
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
        if one.sizes["omega"] < 2:
            raise InputError(f"{_PURPOSE}: {name}: at least two frequencies expected, one found.")
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
