"""Solutions of the panel method on disk: one problem per hull, lid and depth, one entry per wavenumber."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.bem_case import Case, entry
from ogilvie.hydro.cache import Cache, cache_folder, content_key, prune

Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class SolutionStore:
    """Keeps the force vectors of a case; they depend on geometry, depth and wavenumber, not on rho, g, speed, directions.

    Parameters
    ----------
    case : Case
    settings : str
        Whatever else the numbers depend on: version of the method, settings of the Green function.
    """

    case: Case
    settings: str

    def load(self, k: float) -> Complex | None:
        """Return the force vectors (6, n_hull) at a wavenumber, or None where they are not there."""
        g = (self._cache(k).load(_name(k)) or {}).get("force_vectors")
        if g is None or g.shape != (6, self.case.panels.n_hull) or not np.all(np.isfinite(g)):
            return None
        return np.asarray(g, dtype=complex)

    def save(self, k: float, g: Complex) -> None:
        """Keep force vectors, whole or not at all."""
        self._cache(k).store(_name(k), {"force_vectors": g})

    def finish(self) -> None:
        """Mark the problem as used; remove those not used for longest from a cache that has grown too large."""
        self._cache(1.0).touch()
        prune(_root())

    def _cache(self, k: float) -> Cache:
        panels = self.case.panels_at(k)
        facets, planes = panels.facets, "+".join(panels.hull.planes)
        key = content_key(self.settings, planes, facets.vertices, facets.faces, panels.n_hull, self.case.depth)
        return Cache(_root() / key)


def _root() -> Path:
    return cache_folder() / "bem"


def _name(k: float) -> str:
    """Return the file name of a wavenumber: its 64 bits, so that no two share one."""
    return f"k{np.array(entry(k), dtype='>f8').tobytes().hex()}"
