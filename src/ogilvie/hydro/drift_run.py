"""Frequencies one after the other: from the panels to the terms of the mean drift by every method."""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.bem_case import Case
from ogilvie.hydro.capytaine import frequency_threads, green_settings, source_influence, surface_green_function
from ogilvie.hydro.drift_control import control_drift
from ogilvie.hydro.drift_encounter import placed, placed_pairs, waves_met
from ogilvie.hydro.drift_far import FarField, far_field
from ogilvie.hydro.drift_first import FirstOrder, WaterlineRule
from ogilvie.hydro.drift_forms import cross_mean
from ogilvie.hydro.drift_maruo import far_field_at_speed
from ogilvie.hydro.drift_near import near_field
from ogilvie.hydro.drift_panels import WholeHull
from ogilvie.hydro.drift_slope import find_slopes
from ogilvie.hydro.drift_solve import Corrections, Fields, fields_at, flux_correction, lid_damping, solve_sources
from ogilvie.hydro.drift_static import Rotation
from ogilvie.hydro.drift_store import FieldStore, joined, split
from ogilvie.hydro.drift_surface import ControlSurface, control_surface
from ogilvie.hydro.drift_wave import Dynamics, Wave
from ogilvie.hydro.progress import tracked

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Complex = NDArray[np.complex128]

#: Raised whenever the same problem would give other fields than before.
REVISION = 2


@dataclass(frozen=True)
class Options:
    """How the drift is evaluated; see :func:`ogilvie.hydro.drift.mean_drift`."""

    rotation: Rotation
    waterline: WaterlineRule
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
    shift : (n_b, n_b, 3) array
        <T x F1>: what the moment about the fixed origin has more than that about the moving one.
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


def _drift(solver: "Solver", wave: Wave, dynamics: Dynamics | None, options: Options) -> Drift:
    first = solver.first_order(wave, dynamics)
    terms: dict[str, Complex] = {}
    if options.control:
        surface = control_surface(solver.hull, k=max(wave.k, wave.k_e), depth=wave.depth)
        fields = solver.at_surface(wave, surface, first.fields)
        terms = control_drift(first, surface, fields, rotation=options.rotation, waterline=options.waterline)
    near = near_field(first, rotation=options.rotation, waterline=options.waterline)
    far = far_field(first) if wave.speed == 0.0 else far_field_at_speed(first)
    motion = first.motion if wave.omega > 0.0 else first.motion.conj()
    shift, flux = cross_mean(first.motion[:, :3], first.pressure_force), _flux(first)
    return Drift(near, terms, far, shift, motion, flux, wave.k / abs(wave.omega), solver.hull.panels.hull.length)


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
        motion=placed(places, [d.motion for d in found]),
        flux=placed(places, [d.flux for d in found]),
    )


class Solver:
    """Solves what the store does not have; the Green function and the corrections are made when first needed.

    Parameters
    ----------
    case : Case
    cache : bool
        Keep the fields on disk.
    workers : int
        Threads.

    Raises
    ------
    InputError
        The panels' matrices do not fit into memory.
    """

    def __init__(self, case: Case, *, cache: bool, workers: int) -> None:
        _refuse_too_large(case)
        self.hull = WholeHull(case.panels)
        self._case, self._workers = case, workers
        self._store: FieldStore | None = None
        if cache:
            self._store = FieldStore(case.panels, case.depth, settings=f"drift {REVISION}; {green_settings()}")
        self._slopes = find_slopes(self.hull)
        self._ready: tuple | None = None

    def first_order(self, wave: Wave, dynamics: Dynamics | None) -> FirstOrder:
        """Return the first-order solution in waves."""
        return FirstOrder(wave, self.hull, self._slopes, self.at_hull(wave), dynamics)

    def finish(self) -> None:
        """Leave the store in order."""
        if self._store:
            self._store.finish()

    def at_hull(self, wave: Wave) -> Fields:
        """Return the fields at the hull's panels."""
        kept = self._load(wave, "hull")
        missing = [i for i, field in enumerate(kept) if field is None]
        if missing:
            green, corrections = self._tools()
            panels, b = self._case.panels, np.array([wave.directions[i - 1] for i in missing if i > 0])
            sources = source_influence(green, panels.facets, wave.k_e, wave.depth)
            with frequency_threads(self._case, self._workers):
                new = solve_sources(
                    panels, sources, corrections=corrections, k=wave.k, K=wave.K, directions=b, depth=wave.depth
                )
            parts = iter(split(new))
            kept[0] = next(parts)
            for i, part in zip([i for i in missing if i > 0], parts, strict=True):
                kept[i] = part
            self._save(wave, kept, "hull")
        return joined([field for field in kept if field is not None])

    def at_surface(self, wave: Wave, surface: ControlSurface, hull_fields: Fields, *, where: str = "control") -> Fields:
        """Return the fields at a control surface; `where` names it in the store."""
        kept = self._load(wave, where)
        if any(field is None or field.potential.shape[2] != len(surface.points) for field in kept):
            green, _ = self._tools()
            panels = self._case.panels
            sources = source_influence(green, panels.facets, wave.k_e, wave.depth)
            with frequency_threads(self._case, self._workers):
                found = fields_at(panels, sources, hull_fields.sources, surface.points)
            kept = list(split(Fields(np.zeros((len(found.potential), 0), dtype=complex), found.potential, found.velocity)))
            self._save(wave, kept, where)
        return joined([field for field in kept if field is not None])

    def _tools(self) -> tuple:
        if self._ready is None:
            green, panels = surface_green_function(), self._case.panels
            bare = panels.without_lid
            lid = np.zeros((0, 3)) if panels.lid is None else panels.lid.centers
            curvature = flux_correction(bare, source_influence(green, bare.facets, 0.0, np.inf))
            damping = lid_damping(lid, self.hull.waterline.middle)
            self._ready = green, Corrections(curvature, damping)
        return self._ready

    def _load(self, wave: Wave, where: str) -> list[Fields | None]:
        if self._store is None:
            return [None] * (1 + len(wave.directions))
        return self._store.load(wave.k_e, wave.directions, where=where, incident=wave.k)

    def _save(self, wave: Wave, fields: list[Fields | None], where: str) -> None:
        if self._store is not None:
            known = [field for field in fields if field is not None]
            self._store.save(wave.k_e, wave.directions, known, where=where, incident=wave.k)


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


def _refuse_too_large(case: Case) -> None:
    n, copies = case.panels.n_hull + case.panels.n_lid, len(case.panels.images)
    needed = 16.0 * n**2 * (4.0 * (copies + 2) + 2.0)
    try:
        memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return
    if needed > memory:
        raise InputError(
            f"second-order forces: a mesh that fits into {memory / 1e9:.3g} GB of memory expected, {n} stored panels found, "
            f"which need {needed / 1e9:.3g} GB. Use a coarser mesh, or store the hull with its symmetry: "
            "hull.with_symmetry('xz')."
        )
