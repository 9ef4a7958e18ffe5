"""Solves the first order of one hull, frequency by frequency, and keeps the fields on disk."""

from functools import partial

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.bem_case import Case
from ogilvie.hydro.capytaine import (
    dipole_influence,
    frequency_threads,
    green_settings,
    source_influence,
    surface_green_function,
)
from ogilvie.hydro.drift_centre import solve_centres
from ogilvie.hydro.drift_first import FirstOrder
from ogilvie.hydro.drift_panels import WholeHull
from ogilvie.hydro.drift_slope import find_slopes
from ogilvie.hydro.drift_solve import Corrections, Fields, fields_at, flux_correction, lid_damping, solve_sources
from ogilvie.hydro.drift_store import FieldStore, joined, split
from ogilvie.hydro.drift_surface import ControlSurface
from ogilvie.hydro.drift_wave import Dynamics, Wave
from ogilvie.hydro.threads import machine_memory

Complex = NDArray[np.complex128]

#: Raised whenever the same problem would give other fields than before.
REVISION = 3


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

    def first_order_at_centres(self, wave: Wave, dynamics: Dynamics | None) -> FirstOrder:
        """Return the first-order solution as codes of flat panels have it; see :mod:`ogilvie.hydro.drift_centre`."""
        return FirstOrder(wave, self.hull, None, self.at_hull(wave, centres=True), dynamics)

    def finish(self) -> None:
        """Leave the store in order."""
        if self._store:
            self._store.finish()

    def at_hull(self, wave: Wave, *, centres: bool = False) -> Fields:
        """Return the fields at the hull's panels, by :func:`solve_centres` or :func:`solve_sources`."""
        where = "centres" if centres else "hull"
        kept = self._load(wave, where)
        missing = [i for i, field in enumerate(kept) if field is None]
        if missing:
            green, corrections = self._tools()
            panels, b = self._case.panels, np.array([wave.directions[i - 1] for i in missing if i > 0])
            sources = source_influence(green, panels.facets, wave.k_e, wave.depth)
            if centres:
                dipoles = dipole_influence(green, panels, wave.k_e, wave.depth)
                solve = partial(solve_centres, panels, sources, dipoles, damping=corrections.damping)
            else:
                solve = partial(solve_sources, panels, sources, corrections=corrections)
            with frequency_threads(self._case, self._workers):
                new = solve(k=wave.k, K=wave.K, directions=b, depth=wave.depth)
            parts = iter(split(new))
            kept[0] = next(parts)
            for i, part in zip([i for i in missing if i > 0], parts, strict=True):
                kept[i] = part
            self._save(wave, kept, where)
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


def _refuse_too_large(case: Case) -> None:
    n, copies = case.panels.n_hull + case.panels.n_lid, len(case.panels.images)
    needed = 16.0 * n**2 * (4.0 * (copies + 1) + 2.0)
    memory = machine_memory()
    if needed > memory:
        raise InputError(
            f"second-order forces: a mesh that fits into {memory / 1e9:.3g} GB of memory expected, {n} stored panels found, "
            f"which need {needed / 1e9:.3g} GB. Use a coarser mesh, or store the hull with its symmetry: "
            "hull.with_symmetry('xz')."
        )
