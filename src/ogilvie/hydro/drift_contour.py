"""The waterline of a hull as a wall that short waves run into: which of its elements a ray reaches."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.bem_panels import HullPanels
from ogilvie.hydro.drift_panels import WholeHull
from ogilvie.mesh.inspect import require_usable
from ogilvie.mesh.panels import PanelMesh

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

_CLOSED = 1e-3  # sum of normals of a closed waterline, as part of its length
_SMALL = 1e-9  # of the waterline's length: distances that count as none


@dataclass(frozen=True, eq=False)
class Contour:
    """Straight elements of one or several closed waterlines.

    Parameters
    ----------
    middle, normal : (n, 2) array
        m; unit vectors out of the body.
    length : (n,) array
        m.

    Examples
    --------
    >>> sides = np.array([[1.0, 0], [0, 1], [-1, 0], [0, -1]])
    >>> square = Contour(middle=sides, normal=sides, length=np.full(4, 2.0))
    >>> square.exposed(np.array([-1.0, 0.0])).tolist()
    [True, False, False, False]
    """

    middle: Array
    normal: Array
    length: Array

    def exposed(self, ray: Array) -> Mask:
        """Return which elements (n,) rays in the direction `ray` (2,) reach: turned towards them, with nothing before."""
        facing = self.normal @ ray < 0.0
        i, j = self._before
        keep = facing[i]
        i, j = i[keep], j[keep]
        tangent = self._step[j]
        across = np.array([-ray[1], ray[0]])
        slope = tangent @ across
        apart = self.middle[j] - self.middle[i]
        with np.errstate(divide="ignore", invalid="ignore"):
            at = -(apart @ across) / slope  # place on element j, in its lengths from its middle
        crossed = np.abs(at) <= 0.5 + _SMALL
        ahead = np.einsum("pi,pi->p", apart + np.where(crossed, at, 0.0)[:, None] * tangent, -ray[None, :]) > 0.0
        hidden = np.zeros(len(facing), dtype=bool)
        hidden[i[crossed & ahead]] = True
        return np.asarray(facing & ~hidden)

    @cached_property
    def _step(self) -> Array:
        return self.length[:, None] * np.stack([self.normal[:, 1], -self.normal[:, 0]], axis=1)

    @cached_property
    def _before(self) -> tuple[Ints, Ints]:
        """Elements i, and elements j that lie, in part, on the outer side of the line through i: none of a convex hull."""
        ends = np.stack([self.middle - 0.5 * self._step, self.middle + 0.5 * self._step])
        height = np.einsum("ejd,id->eij", ends, self.normal) - np.einsum("id,id->i", self.middle, self.normal)[:, None]
        i, j = np.nonzero(height.max(axis=0) > _SMALL * self.length.sum())
        return i, j


def find_contour(hull: PanelMesh, *, purpose: str) -> Contour:
    """Return the waterline of the whole hull.

    Raises
    ------
    InputError
        No hull that is cut at z = 0; no waterline, or an open one.
    """
    if not isinstance(hull, PanelMesh):
        raise InputError(f"{purpose}: hull: a PanelMesh expected, {type(hull).__name__} found. Read one with load_mesh.")
    require_usable(hull, purpose=purpose)
    line = WholeHull(HullPanels(hull)).waterline
    if len(line.length) == 0:
        raise InputError(
            f"{purpose}: hull: a hull that pierces the surface expected, no edge of {hull.name!r} lies on z = 0. "
            "Short waves pass over a submerged body."
        )
    total = float(line.length.sum())
    gap = float(np.hypot(*(line.length @ line.normal[:, :2])))
    if gap > _CLOSED * total:
        raise InputError(
            f"{purpose}: hull: a closed waterline expected, one of {total:.4g} m with a gap of {gap:.4g} m found. "
            "See check_mesh(hull); is its symmetry the right one?"
        )
    return Contour(line.middle[:, :2], line.normal[:, :2], line.length)
