"""Frequencies one after the other: from the panels to the terms of the mean drift by every method."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.bem_case import Case
from ogilvie.hydro.drift_control import control_drift
from ogilvie.hydro.drift_encounter import placed, placed_pairs, waves_met
from ogilvie.hydro.drift_far import FarField, far_field
from ogilvie.hydro.drift_first import FirstOrder
from ogilvie.hydro.drift_forms import cross_mean
from ogilvie.hydro.drift_maruo import far_field_at_speed
from ogilvie.hydro.drift_near import near_field
from ogilvie.hydro.drift_solver import Solver
from ogilvie.hydro.drift_static import Rotation
from ogilvie.hydro.drift_surface import control_surface
from ogilvie.hydro.drift_wave import Dynamics, Wave
from ogilvie.hydro.progress import tracked

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Options:
    """How the drift is evaluated; see :func:`ogilvie.hydro.drift.mean_drift`."""

    rotation: Rotation
    centre: bool
    control: bool
    cache: bool
    workers: int
    progress: bool | None


@dataclass(frozen=True, eq=False)
class Drift:
    """The drift of one frequency for every pair of directions, about the fixed mean origin.

    Parameters
    ----------
    near, control : dict of (n_b, n_b, 6) arrays
        Terms; `control` is empty if it was not asked for.
    far : FarField
    shift, near_shift : (n_b, n_b, 3) array
        <T x F1>: what the moment about the fixed origin has more than that about the moving one; second, with the first order
        that `near` has.
    motion : (n_b, 6) array
    flux : (n_b,) array
        Power of the incident waves over the breadth of the hull across them, W/m2.
    slowness : float
        k/omega, s/m: momentum over energy of the waves.
    length : float
        Of the hull, m.
    """

    near: dict[str, Complex]
    control: dict[str, Complex]
    far: FarField
    shift: Complex
    near_shift: Complex
    motion: Complex
    flux: Array
    slowness: float
    length: float


def drifts(case: Case, dynamics: Dynamics | None, options: Options) -> list[Drift]:
    """Return the drift at every frequency of a case."""
    solver = Solver(case, cache=options.cache, workers=options.workers)
    out = []
    for i in tracked(range(len(case.omega)), show=options.progress, title=f"drift of {case.panels.hull.name}"):
        parts = [(place, _drift(solver, wave, dynamics, options)) for place, wave in waves_met(case, i)]
        out.append(parts[0][1] if case.speed == 0.0 else _merged(parts))
    solver.finish()
    return out


def _drift(solver: Solver, wave: Wave, dynamics: Dynamics | None, options: Options) -> Drift:
    first = solver.first_order(wave, dynamics)
    terms: dict[str, Complex] = {}
    if options.control:
        surface = control_surface(solver.hull, k=max(wave.k, wave.k_e), depth=wave.depth)
        fields = solver.at_surface(wave, surface, first.fields)
        terms = control_drift(first, surface, fields, rotation=options.rotation)
    beside = solver.first_order_at_centres(wave, dynamics) if options.centre else first
    near = near_field(beside, rotation=options.rotation)
    far = far_field(first) if wave.speed == 0.0 else far_field_at_speed(first)
    motion = first.motion if wave.omega > 0.0 else first.motion.conj()
    shift, near_shift = (cross_mean(order.motion[:, :3], order.pressure_force) for order in (first, beside))
    slowness, length = wave.k / abs(wave.omega), solver.hull.panels.hull.length
    return Drift(near, terms, far, shift, near_shift, motion, _flux(first), slowness, length)


def _merged(parts: Sequence[tuple[Ints, Drift]]) -> Drift:
    """Return the drift of all directions from those of some; pairs of directions with different omega_e are zero."""
    places, found = [place for place, _ in parts], [drift for _, drift in parts]
    far = FarField(
        placed_pairs(places, [d.far.force for d in found]),
        placed(places, [d.far.radiated for d in found]),
        placed(places, [d.far.removed for d in found]),
    )
    return replace(
        found[0],
        near={key: placed_pairs(places, [d.near[key] for d in found]) for key in found[0].near},
        control={key: placed_pairs(places, [d.control[key] for d in found]) for key in found[0].control},
        far=far,
        shift=placed_pairs(places, [d.shift for d in found]),
        near_shift=placed_pairs(places, [d.near_shift for d in found]),
        motion=placed(places, [d.motion for d in found]),
        flux=placed(places, [d.flux for d in found]),
    )


def _flux(first: FirstOrder) -> Array:
    w = first.wave
    across = first.hull.centers[:, :2] @ np.stack([-np.sin(w.directions), np.cos(w.directions)])
    return np.asarray(0.5 * w.rho * w.g * w.ratio * abs(w.omega) / w.k * np.ptp(across, axis=0))


def pairs_of(drift: Drift) -> Iterator[tuple[str, Complex]]:
    """Yield name and sum (n_b, n_b, 6) of each method."""
    yield "pressure", np.sum(list(drift.near.values()), axis=0)
    if drift.control:
        yield "control_surface", np.sum(list(drift.control.values()), axis=0)
    yield "momentum", drift.far.force
