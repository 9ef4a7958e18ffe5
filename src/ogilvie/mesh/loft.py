"""A ship from its lines: stations lofted to a surface, the surface panelled, its ends closed, its volume kept."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.ends import Closing, end_sheets, nose_volume, nose_width
from ogilvie.mesh.freeboard import freeboard_sheets
from ogilvie.mesh.girthlines import chine_rows, side_grids
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.patches import oriented, panel_mesh
from ogilvie.mesh.sections import Lines, Station, lofted
from ogilvie.mesh.smooth import SurfaceCorners
from ogilvie.mesh.wetted import Reach, reaches

Array = NDArray[np.float64]

_ASPECT = 1.6  #: mean length of a panel over its height
_MOST = 0.05  #: of the distance to the next vertex, that one is moved off the surface
_VOLUME = 0.003  #: part of the volume by which the panels may miss it


def from_offsets(
    stations: Sequence[Station],
    *,
    draught: float | None = None,
    panels: int = 1000,
    bow: Closing = "auto",
    stern: Closing = "auto",
    knuckles: Sequence[float] = (),
    above_water: bool = False,
    name: str = "hull",
) -> PanelMesh:
    """Return the hull through stations.

    Parameters
    ----------
    stations : sequence of (x, points)
        In any order: x, positive forward, m, and the points (n, 2) of half-breadth and height, m, along the station from
        keel to deck or from deck to keel. A first point off the centreline stands for a flat bottom; a deck is left out.
    draught : float, optional
        The heights are above the baseline and the water is at this height, m. None: the heights are above still water.
    panels : int
        Largest number of panels of the whole hull below the water.
    bow, stern : {"auto", "round", "flat"}
        What closes an end whose last station still has an area: a round nose, elliptic in each waterplane, or a plane.
        "auto": a nose where the bow's last station is narrower than 15 % of the beam (and on bulbs), else a plane.
    knuckles : sequence of float
        x of stations at which lines along the hull may have a corner, such as the foot of a rake, m.
    above_water : bool
        Add the sides from the water up to where the stations end (no deck); these panels count extra.
    name : str

    Returns
    -------
    PanelMesh
        Symmetry "xz", z = 0 at the water, its uppermost wet row of vertices exactly there.

    Raises
    ------
    InputError
        Fewer than two stations, two at one x, points that are not finite, negative half-breadths, a station that ends below
        the water off the centreline, nothing below the water, too few panels.

    Notes
    -----
    Each station is a curve of monotone cubics, broken at corners of more than 45 deg. Corners that all wet stations share
    become lines of the mesh (chines). Lines along the hull are monotone cubics of x through like points of all stations
    (same share of the travel in y and z from keel to top). A run of points on the centreline at the foot of a station, over
    at least a quarter of its height, is a post: the skeg ends there, what is above carries on. A station that closes on the
    centreline below the water is a bulb, the stem above it ends there.

    Vertices are moved off that surface, along its normal, by about k h^2 / 12 (curvature k, side h of a panel), so that the
    flat panels enclose its volume; keel, waterline, transom and chines keep their places. `PanelMesh.surface` keeps where they
    were on it.

    Examples
    --------
    >>> barge = [(x, [(0.0, 0.0), (10.0, 0.0), (10.0, 8.0)]) for x in (-50.0, 0.0, 50.0)]
    >>> hull = from_offsets(barge, draught=5.0, panels=600)
    >>> round(hull.volume, 6), hull.bounds.tolist()
    (10000.0, [[-50.0, -10.0, -5.0], [50.0, 10.0, 0.0]])
    """
    lines = lofted(stations, draught=draught, knuckles=knuckles)
    return panelled(lines, panels=panels, bow=bow, stern=stern, above_water=above_water, name=name)


@dataclass(frozen=True, eq=False)
class _Grids:
    """Grids of the wet side from the middle outward, and the widths of the noses, aft and fore."""

    aft: list[Array]
    fore: list[Array]
    noses: tuple[float, float]

    def moved(self, offsets: "_Grids", c: float) -> "_Grids":
        """Return the grids moved by c times the offsets, not below the keel, beyond the centreline or beyond the beam."""
        low = min(g[..., 2].min() for g in (*self.aft, *self.fore))
        high = max(g[..., 1].max() for g in (*self.aft, *self.fore))

        def move(g: Array, d: Array) -> Array:
            x, y, z = np.moveaxis(g + c * d, -1, 0)
            return np.stack([x, np.clip(y, 0.0, np.maximum(high, g[..., 1])), np.maximum(z, low)], axis=-1)

        pairs = [zip(a, b, strict=True) for a, b in ((self.aft, offsets.aft), (self.fore, offsets.fore))]
        aft, fore = ([move(g, d) for g, d in pair] for pair in pairs)
        return replace(self, aft=aft, fore=fore)

    def sheets(self) -> list[Array]:
        """Return all grids, ends included, with their normals outward."""
        side = [oriented(g, (0.0, 1.0, 0.0)) for g in (*self.aft, *self.fore)]
        return side + end_sheets(self.aft[-1][-1], self.noses[0], -1.0) + end_sheets(self.fore[-1][-1], self.noses[1], 1.0)


def panelled(
    lines: Lines,
    *,
    panels: int,
    bow: Closing = "auto",
    stern: Closing = "auto",
    above_water: bool = False,
    volume: float | None = None,
    name: str = "hull",
) -> PanelMesh:
    """Return lofted lines as panels.

    Arguments as in :func:`from_offsets`; `volume` (m3) replaces the volume inside the surface as what the panels shall
    enclose.
    """
    if panels < 40:
        raise InputError(f"panels: at least 40 expected, {panels!r} found.")
    sides = [reaches(lines, -1), reaches(lines, 1)]
    noses = (nose_width(lines, sides[0][-1], stern, end="stern"), nose_width(lines, sides[1][-1], bow, end="bow"))
    if volume is None:
        volume = sum(r.volume for side in sides for r in side)
        volume += sum(nose_volume(nose, side[-1]) for nose, side in zip(noses, sides, strict=True))
    length = sum(r.length for side in sides for r in side)
    girth = sum(float(abs(np.trapezoid(r.girth, r.x))) for side in sides for r in side) / length
    grids, n = _fitting(lines, sides, noses, panels, girth / length)
    exact = _mesh(grids.sheets(), name)
    grids = _with_volume(grids, volume, fixed=list(chine_rows(lines, n).values()))
    sheets = grids.sheets()
    if above_water:
        for side, wet, nose, out in zip(sides, (grids.aft, grids.fore), noses, (-1.0, 1.0), strict=True):
            sheets += freeboard_sheets(side, wet, nose=nose, height=girth / n, out=out)
    return replace(_mesh(sheets, name), surface=SurfaceCorners(exact.vertices, exact.faces))


def _fitting(
    lines: Lines, sides: list[list[Reach]], noses: tuple[float, float], panels: int, slenderness: float
) -> tuple[_Grids, int]:
    """Return the finest grids with at most that many panels, and the number of their lines."""
    for n in range(max(3, round(np.sqrt(0.5 * panels * _ASPECT * slenderness))), 2, -1):
        for m in range(panels // (4 * n), 1, -1):
            grids = _Grids(side_grids(lines, sides[0], n, m), side_grids(lines, sides[1], n, m), noses)
            if 2 * _mesh(grids.sheets(), "").n_faces <= panels:
                return grids, n
    raise InputError(f"panels: more than {panels!r} expected for this hull.")


def _mesh(sheets: list[Array], name: str) -> PanelMesh:
    tolerance = 1e-7 * float(np.ptp(np.concatenate([s[..., 0].ravel() for s in sheets])))
    return panel_mesh(sheets, symmetry="xz", name=name, tolerance=tolerance)


# ---- volume


def _with_volume(grids: _Grids, volume: float, *, fixed: list[int]) -> _Grids:
    """Return the grids moved off the surface just so far that the flat panels enclose the volume."""
    offsets = _offsets(grids, fixed)
    a, va, c = 0.0, _mesh(grids.sheets(), "").volume, 1.0
    for _ in range(5):
        new = grids.moved(offsets, c)
        v = _mesh(new.sheets(), "").volume
        if abs(v / volume - 1.0) < 1e-9 or v == va:
            break
        a, va, c = c, v, float(np.clip(c + (volume - v) * (c - a) / (v - va), 0.0, 3.0))
    if abs(v / volume - 1.0) > _VOLUME:
        raise InputError(f"panels: too few for this hull, they enclose {v:.6g} m3 instead of {volume:.6g} m3. Give more.")
    return new


def _offsets(grids: _Grids, fixed: list[int]) -> _Grids:
    """Return by how much flat panels fall short of the surface; grids of the main body are joined amidships for it."""
    m = len(grids.aft[0]) - 1
    main = _shortfall(np.concatenate([grids.aft[0][:0:-1], grids.fore[0]]), fixed)
    aft, fore = ([_shortfall(g, []) for g in side[1:]] for side in (grids.aft, grids.fore))
    return replace(grids, aft=[main[m::-1], *aft], fore=[main[m:], *fore])


def _shortfall(grid: Array, fixed: list[int]) -> Array:
    """Return by how much (m + 1, n + 1, 3) flat panels with corners on a surface fall short of it in the mean.

    A chord of length h falls short of a curve of curvature k by k h^2 / 12 in the mean; k h^2 is the second difference.
    """
    along, up = np.zeros_like(grid), np.zeros_like(grid)
    along[1:-1] = grid[2:] - 2.0 * grid[1:-1] + grid[:-2]
    up[:, 1:-1] = grid[:, 2:] - 2.0 * grid[:, 1:-1] + grid[:, :-2]
    up[:, fixed] = 0.0
    normal = np.cross(np.gradient(grid, axis=0), np.gradient(grid, axis=1))
    bulb = bool(np.all(grid[:, -1, 1] < 1e-9 * grid[..., 1].max()))
    normal[:, 0, 1] = normal[:, -1, 1 if bulb else 2] = 0.0  # centreline and waterline stay in their planes
    normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-300)
    size = -((along + up) * normal).sum(axis=-1, keepdims=True) / 12.0
    size[0] = size[-1] = 0.0
    most = _MOST * np.minimum(_nearest(grid), _nearest(grid.swapaxes(0, 1)).swapaxes(0, 1))[..., None]
    return np.clip(size, -most, most) * normal


def _nearest(grid: Array) -> Array:
    """Return the distance (m + 1, n + 1) of each vertex to the nearer of its neighbours along the first axis."""
    step = np.linalg.norm(np.diff(grid, axis=0), axis=-1)
    return np.minimum(np.concatenate([step[:1], step]), np.concatenate([step, step[-1:]]))
