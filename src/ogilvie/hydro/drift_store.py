"""First-order fields on disk: one problem per hull, lid and depth; entries per wavenumber and wave direction."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.bem_case import entry
from ogilvie.hydro.bem_panels import HullPanels
from ogilvie.hydro.cache import Cache, cache_folder, content_key, prune
from ogilvie.hydro.drift_solve import Fields

Array = NDArray[np.float64]

_KEYS = ("sources", "potential", "velocity")


@dataclass(frozen=True, eq=False)
class FieldStore:
    """Keeps fields of sources; they depend on geometry, depth, wavenumber and direction, not on rho, g or the body.

    Parameters
    ----------
    panels : HullPanels
    depth : float
        m.
    settings : str
        Whatever else the numbers depend on.
    """

    panels: HullPanels
    depth: float
    settings: str

    def load(self, k: float, directions: Array, *, where: str, incident: float | None = None) -> list[Fields | None]:
        """Return the fields of radiation (6 potentials) and of each direction (one), None for those not there.

        Parameters
        ----------
        k : float
            Of the radiated waves, rad/m.
        directions : (n_b,) array
            rad.
        where : {"hull", "centres", "control"}
            At the hull's panels, in either way of solving, or at the control surface.
        incident : float, optional
            Wavenumber of the incident waves where it is another one, at speed, rad/m.
        """
        return [self._read(name) for name in _names(k, directions, where, incident)]

    def save(self, k: float, directions: Array, fields: Sequence[Fields], *, where: str, incident: float | None = None) -> None:
        """Keep fields in the order of :meth:`load`."""
        for name, field in zip(_names(k, directions, where, incident), fields, strict=True):
            self._cache.store(name, {key: getattr(field, key) for key in _KEYS})

    def finish(self) -> None:
        """Mark the problem as used and keep the cache from growing too large."""
        self._cache.touch()
        prune(_root())

    def _read(self, name: str) -> Fields | None:
        found = self._cache.load(name)
        if found is None or set(found) != set(_KEYS) or not all(np.all(np.isfinite(found[key])) for key in _KEYS):
            return None
        return Fields(*(found[key] for key in _KEYS))

    @cached_property
    def _cache(self) -> Cache:
        facets, planes = self.panels.facets, "+".join(self.panels.hull.planes)
        key = content_key(self.settings, planes, facets.vertices, facets.faces, self.panels.n_hull, self.depth)
        return Cache(_root() / key)


def joined(parts: Sequence[Fields]) -> Fields:
    """Return the potentials of several sets as one."""
    return Fields(*(np.concatenate([getattr(part, key) for part in parts]) for key in _KEYS))


def split(fields: Fields) -> list[Fields]:
    """Return the six radiated potentials as one set and every diffracted one as a set of its own."""
    slices = [slice(0, 6), *(slice(i, i + 1) for i in range(6, len(fields.sources)))]
    return [Fields(*(getattr(fields, key)[part] for key in _KEYS)) for part in slices]


def _names(k: float, directions: Array, where: str, incident: float | None) -> list[str]:
    stem = f"{where}-k{_bits(entry(k))}"
    of = "" if incident is None or entry(incident) == entry(k) else f"-i{_bits(entry(incident))}"
    return [stem, *(f"{stem}{of}-b{_bits(float(b))}" for b in directions)]


def _bits(value: float) -> str:
    return np.array(value, dtype=">f8").tobytes().hex()


def _root() -> Path:
    return cache_folder() / "drift"
