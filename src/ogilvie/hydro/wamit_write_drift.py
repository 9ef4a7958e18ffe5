"""Mean drift and quadratic transfer functions as WAMIT prints them."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from ogilvie.errors import InputError
from ogilvie.hydro.qtf import symmetric_qtf
from ogilvie.hydro.schema import DOFS
from ogilvie.hydro.wamit_format import exponential, mode_numbers, periods, polar, rotations
from ogilvie.hydro.wamit_text import Array

_DRIFTS = {"7": "mean_drift_control_surface", "8": "mean_drift_momentum", "9": "mean_drift_pressure"}
_BODY_DRIFT = "mean_drift_pressure_body"
_QUADRATIC = {"12d": "qtf_diff", "12s": "qtf_sum"}
Columns = list[tuple[int, Array]]


def drift_tables(hydro: xr.Dataset, ulen: float) -> dict[str, str]:
    """Return suffix and text of the files of mean drift.

    Notes
    -----
    `mean_drift` alone, of unknown origin, goes to `.9` if it holds all components, else to `.8`. Drift in two directions at
    once goes to the file whose components it has.

    Raises
    ------
    InputError
        A component known in part; drift in two directions whose components no file has.
    """
    drifts = {suffix: key for suffix, key in _DRIFTS.items() if key in hydro}
    if not drifts and "mean_drift" in hydro:
        drifts = {"9" if np.isfinite(hydro.mean_drift.values).all() else "8": "mean_drift"}
    columns = {suffix: _single(hydro, key, ulen) for suffix, key in drifts.items()}
    if "mean_drift_pairs" not in hydro:
        return {suffix: _drift_text(hydro, known, _same(hydro)) for suffix, known in columns.items()}
    pairs = _known(hydro, "mean_drift_pairs", ulen)
    modes = [mode for mode, _ in pairs]
    place = next((suffix for suffix, known in columns.items() if [mode for mode, _ in known] == modes), None)
    if place is None and columns:
        raise InputError(
            "mean_drift_pairs: components of one of the other drift variables expected (a file holds one method), "
            f"{', '.join(DOFS[mode - 1] for mode in modes)} found. Leave it out: hydro.drop_vars('mean_drift_pairs')."
        )
    place = place or ("9" if len(modes) == hydro.sizes["influenced_dof"] else "8")
    texts = {suffix: _drift_text(hydro, known, _same(hydro)) for suffix, known in columns.items() if suffix != place}
    two = np.stack([hydro.drift_direction_1.values, hydro.drift_direction_2.values], axis=1)
    return texts | {place: _drift_text(hydro, pairs, np.degrees(two))}


def quadratic_tables(hydro: xr.Dataset, ulen: float) -> dict[str, str]:
    """Return suffix and text of the files of quadratic transfer functions: one half, since the other follows by symmetry.

    Raises
    ------
    InputError
        Functions without their symmetry; components known at some pairs of frequencies only.
    """
    texts = {}
    for suffix, key in _QUADRATIC.items():
        name = f"{key}_pairs" if f"{key}_pairs" in hydro else key
        if name in hydro:
            texts[suffix] = "".join(_quadratic_rows(symmetric_qtf(hydro), name, ulen))
    return texts


def _same(hydro: xr.Dataset) -> Array:
    degrees = np.degrees(hydro.wave_direction.values)
    return np.stack([degrees, degrees], axis=1)


def _single(hydro: xr.Dataset, key: str, ulen: float) -> Columns:
    """Return mode and values (n_w, n_b); components about the moving origin have negative modes."""
    columns = _known(hydro, key, ulen)
    if key == "mean_drift_pressure" and _BODY_DRIFT in hydro:
        columns += [(-mode, values) for mode, values in _known(hydro, _BODY_DRIFT, ulen) if mode > 3]
    return columns


def _known(hydro: xr.Dataset, key: str, ulen: float) -> Columns:
    """Return mode and dimensionless values of each component that is known."""
    unit = hydro.attrs["rho"] * hydro.attrs["g"] * ulen ** (1 + rotations(hydro))
    columns = [(mode, hydro[key].values[..., m] / unit[m]) for m, mode in enumerate(mode_numbers(hydro))]
    return [(mode, values) for mode, values in columns if not np.isnan(values).all()]


def _drift_text(hydro: xr.Dataset, columns: Columns, degrees: Array) -> str:
    if any(np.isnan(values).any() for _, values in columns):
        raise InputError("mean drift: components known everywhere or nowhere expected, some are NaN. Drop the component.")
    return "".join(
        f" {period:13.6E}{first:14.6E}{second:14.6E}{mode:6d}{polar(complex(values[f, b]))}"
        for f, period in periods(hydro)
        for b, (first, second) in enumerate(degrees)
        for mode, values in columns
    )


def _quadratic_rows(hydro: xr.Dataset, name: str, ulen: float) -> Iterator[str]:
    w, columns = hydro.omega_1.values, _known(hydro, name, ulen)
    if name.endswith("_pairs"):
        degrees = np.degrees(np.stack([hydro.qtf_direction_1.values, hydro.qtf_direction_2.values], axis=1))
    else:
        degrees = _same(hydro)
    place = {tuple(pair): k for k, pair in enumerate(degrees.round(5).tolist())}
    exchanged = [place.get((b, a)) for a, b in degrees.round(5).tolist()]
    for i, j, k in np.ndindex(len(w), len(w), len(degrees)):
        there = exchanged[k]
        if there is not None and (i, k) < (j, there):
            continue
        values = [(mode, complex(Q[i, j, k])) for mode, Q in columns]
        unknown = [np.isnan(value) for _, value in values]
        if all(unknown):
            continue
        if any(unknown):
            raise InputError(f"{name}: all components of a pair of frequencies or none expected, some found. Drop a component.")
        first, second = degrees[k]
        start = f" {2 * np.pi / w[i]:13.6E}{exponential(2 * np.pi / w[j])}{first:14.6E}{second:14.6E}"
        yield from (f"{start}{mode:6d}{polar(value)}" for mode, value in values)
