"""The mean drift as a data set, with what tells how far to trust it."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.hydro.bem_case import Case
from ogilvie.hydro.drift_run import Drift, pairs_of
from ogilvie.hydro.schema import DOFS

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Method = Literal["auto", "near", "far", "control_surface"]

#: Beyond these energy and methods are flagged, at rest and at speed, where the theory itself is less exact.
ENERGY_LIMIT, METHOD_LIMIT, VERTICAL_LIMIT = 0.02, 0.10, 0.5
ENERGY_LIMIT_AT_SPEED, METHOD_LIMIT_AT_SPEED = 0.25, 0.50
#: Smallest U omega_e/g at which waves radiated ahead of a moving ship stay behind it.
_CRITICAL = 0.25
_HORIZONTAL, _VERTICAL = [0, 1, 5], [2, 3, 4]
_SMALL = 0.1  # of a dof's largest value at all frequencies: less than this is measured against this
_PART = 0.05  # of the largest horizontal force at that frequency (in yaw times the length): the same
_LITTLE_PUSH = 0.01  # of the momentum of the incident waves over the hull's breadth (in yaw times the length): the same
_LITTLE_POWER = 0.05  # of the incident power over the hull's breadth: the same for energy
_DIMS = ("omega", "wave_direction", "influenced_dof")
_WORDS = {"pressure": "near field", "control_surface": "control surface", "momentum": "far field"}


def as_dataset(case: Case, found: Sequence[Drift], *, method: Method, moments: str, pairs: bool) -> xr.Dataset:
    """Return the data set of :func:`ogilvie.hydro.drift.mean_drift`."""
    full = {name: np.array([dict(pairs_of(d))[name] for d in found]) for name, _ in pairs_of(found[0])}
    shift, near_shift = np.zeros_like(full["pressure"]), np.zeros_like(full["pressure"])
    shift[..., 3:], near_shift[..., 3:] = [d.shift for d in found], [d.near_shift for d in found]
    best, chosen = _best(full, method)
    if moments == "body":
        best = best - np.where([name == "pressure" for name in chosen], near_shift, shift)
    taken = ", ".join(f"{dof}: {name}" for dof, name in zip(DOFS, chosen, strict=True))
    variables = {
        "mean_drift": (_DIMS, _alone(best), {"method": taken}),
    }
    variables |= {f"mean_drift_{name}": (_DIMS, _alone(value), {}) for name, value in full.items()}
    variables["mean_drift_pressure_body"] = (_DIMS, _alone(full["pressure"] - near_shift), {})
    result = xr.Dataset(variables, coords={"omega": case.omega, "wave_direction": case.direction, "influenced_dof": list(DOFS)})
    result["motion_rao"] = (_DIMS, np.array([d.motion for d in found]))
    for name, terms in (("pressure", [d.near for d in found]), ("control_surface", [d.control for d in found])):
        if terms[0]:
            keys = list(terms[0])
            stacked = np.array([[_alone(t[key][None])[0] for t in terms] for key in keys])
            part = xr.DataArray(stacked, dims=(f"{name}_term", *_DIMS), coords={f"{name}_term": keys})
            result[f"{name}_terms"] = part
    if pairs:
        result = result.merge(_pairs(best, case.direction))
    limits = (ENERGY_LIMIT, METHOD_LIMIT) if case.speed == 0.0 else (ENERGY_LIMIT_AT_SPEED, METHOD_LIMIT_AT_SPEED)
    result = result.merge(_quality(full, found, *limits))
    if case.speed != 0.0:
        result["encounter_frequency"] = (_DIMS[:2], case.encounter)
        result["flag_slow_encounter"] = (_DIMS[:2], np.abs(case.speed * case.encounter) / case.g < _CRITICAL)
    result.attrs = {
        "rho": case.rho,
        "g": case.g,
        "water_depth": case.depth,
        "speed": case.speed,
        "moments": moments,
        "name": case.panels.hull.name,
        "time_convention": "exp(+iwt)",
        "units": "N/m2, N m/m2 per square metre of wave amplitude",
    }
    return result.assign_attrs(summary=_summary(result, *limits))


def _best(full: dict[str, Complex], method: Method) -> tuple[Complex, list[str]]:
    """Return the force (n_w, n_b, n_b, 6) of the chosen method of each dof, and its name."""
    order = {
        "near": ("pressure",),
        "far": ("momentum",),
        "control_surface": ("control_surface",),
        "auto": ("momentum", "control_surface", "pressure"),
    }[method]
    best = np.full_like(full["pressure"], np.nan)
    chosen = []
    for i in range(6):
        usable = [name for name in order if name in full and np.all(np.isfinite(full[name][..., i]))]
        if usable:
            best[..., i] = full[usable[0]][..., i]
        chosen.append(usable[0] if usable else "none")
    return best, chosen


def _alone(values: Complex) -> Array:
    """Return the mean in waves of one direction (n_w, n_b, 6) of values (n_w, n_b, n_b, 6)."""
    return np.real(np.einsum("wbbi->wbi", values))


def _pairs(best: Complex, directions: Array) -> xr.Dataset:
    n = len(directions)
    one, two = np.repeat(directions, n), np.tile(directions, n)
    values = best.reshape(len(best), n * n, 6)
    coords = {"drift_direction_1": ("drift_pair", one), "drift_direction_2": ("drift_pair", two)}
    return xr.Dataset({"mean_drift_pairs": (("omega", "drift_pair", "influenced_dof"), values)}, coords=coords)


def _quality(full: dict[str, Complex], found: Sequence[Drift], energy: float, method: float) -> xr.Dataset:
    radiated, removed = np.array([d.far.radiated for d in found]), np.array([d.far.removed for d in found])
    scale = np.maximum(np.maximum(np.abs(radiated), np.abs(removed)), _LITTLE_POWER * np.array([d.flux for d in found]))
    if energy != ENERGY_LIMIT:
        scale = np.maximum(scale, _SMALL * scale.max(axis=0))
    imbalance = (radiated - removed) / scale
    two = _DIMS[:2]
    out: dict[str, tuple] = {"energy_imbalance": (two, imbalance), "flag_energy": (two, np.abs(imbalance) > energy)}
    far = _alone(full["momentum"])
    push = np.array([d.flux.max() * d.slowness for d in found])
    scale_of = _scales(far, push, found[0].length)
    for name in ("pressure", "control_surface"):
        if name in full:
            difference = np.abs(_alone(full[name]) - far) / scale_of
            out[f"difference_{name}"] = (_DIMS, difference)
            out[f"flag_{name}"] = (two, (difference[..., _HORIZONTAL] > method).any(axis=-1))
    if {"pressure", "control_surface"} <= set(full):
        apart = _apart(_alone(full["pressure"])[..., _VERTICAL], _alone(full["control_surface"])[..., _VERTICAL])
        out["flag_vertical"] = (two, (apart > VERTICAL_LIMIT).any(axis=-1))
    return xr.Dataset(out)


def _apart(near: Array, control: Array) -> Array:
    """Return how far two methods are apart in heave, roll, pitch (n_w, n_b, 3), of the larger one's size at that frequency.

    No less than a part of its largest value at all frequencies: the far field says nothing of these, so neither is confirmed
    where they are far apart.
    """
    size = np.maximum(np.abs(near), np.abs(control)).max(axis=1, keepdims=True)
    least = _SMALL * size.max(axis=0, keepdims=True)
    return np.abs(near - control) / np.maximum(np.maximum(size, least), np.finfo(float).tiny)


def _scales(far: Array, push: Array, length: float) -> Array:
    """Return what differences are parts of (n_w, 1, 6).

    The largest value over all directions at that frequency, yet no less than parts of the largest at all frequencies, of the
    largest horizontal force, and of the momentum of the incident waves, `push` (n_w,), N/m2.
    """
    size = np.abs(far).max(axis=1, keepdims=True)
    force = size[..., :2].max(axis=-1, keepdims=True)
    size = np.maximum(size, _SMALL * size.max(axis=0, keepdims=True))
    least = np.maximum(_PART * force, _LITTLE_PUSH * push[:, None, None])
    size[..., :2] = np.maximum(size[..., :2], least)
    size[..., 5:] = np.maximum(size[..., 5:], length * least)
    return size


def _summary(result: xr.Dataset, energy: float, method: float) -> str:
    worst = float(np.abs(result.energy_imbalance).max())
    flagged = int(result.flag_energy.sum())
    at = "" if result.attrs["speed"] == 0.0 else f" at {result.attrs['speed']:.4g} m/s"
    lines = [
        f"mean drift of {result.attrs['name']}{at}: {result.sizes['omega']} frequencies, "
        f"{result.sizes['wave_direction']} directions",
        f"taken from: {result.mean_drift.attrs['method']}",
    ]
    if np.isfinite(worst):
        lines.append(
            f"energy out of balance by up to {100 * worst:.2g} % ({flagged} of {result.flag_energy.size} points above "
            f"{100 * energy:.0f} %)"
        )
    for name in ("pressure", "control_surface"):
        if f"flag_{name}" in result:
            worst_of = {DOFS[i]: float(result[f"difference_{name}"][..., i].max()) for i in _HORIZONTAL}
            parts = ", ".join(f"{dof} {100 * d:.2g} %" for dof, d in worst_of.items() if np.isfinite(d))
            flags = int(result[f"flag_{name}"].sum())
            if parts:
                lines.append(f"{_WORDS[name]} against far field: {parts} at most ({flags} points above {100 * method:.0f} %)")
    if "flag_vertical" in result and result.flag_vertical.any():
        lines.append(
            f"heave, roll or pitch by near field and control surface more than {100 * VERTICAL_LIMIT:.0f} % apart at "
            f"{int(result.flag_vertical.sum())} of {result.flag_vertical.size} points: neither is confirmed there"
        )
    if "flag_slow_encounter" in result and result.flag_slow_encounter.any():
        lines.append(
            f"U omega_e/g below {_CRITICAL:g} at {int(result.flag_slow_encounter.sum())} of {result.flag_slow_encounter.size} "
            "points: waves run ahead of the ship, which this theory of speed does not describe well"
        )
    return "\n".join(lines)
