"""Curved panels of a smooth hull: its patches divided, finer towards the waterline and sharp edges."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.curves import divisions, places, turned
from ogilvie.errors import InputError
from ogilvie.mesh.chebyshev import chebyshev_points
from ogilvie.mesh.smooth import SmoothSurface

Array = NDArray[np.float64]

_SHARP = np.deg2rad(30.0)  #: turn of the normal across a side that makes it an edge
_MORE = 1.25  #: times as many panels along a line with small ones at its ends
_NORMAL_AXIS = {"xz": 1, "yz": 0}


@dataclass
class _Lines:
    """Lines across patches that must be divided alike: union-find with the direction of each line."""

    parent: list[int]
    reverse: list[bool] = field(default_factory=list)

    def root(self, i: int) -> tuple[int, bool]:
        r = False
        while self.parent[i] != i:
            r ^= self.reverse[i]
            i = self.parent[i]
        return i, r

    def join(self, i: int, j: int, reverse: bool) -> None:
        (a, ra), (b, rb) = self.root(i), self.root(j)
        if a != b:
            self.parent[b], self.reverse[b] = a, ra ^ rb ^ reverse


def hull_panels(surface: SmoothSurface, *, planes: tuple[str, ...], size: float, q: int) -> Array:
    """Return a smooth hull as curved panels.

    Parameters
    ----------
    surface : SmoothSurface
        Its stored part, below z = 0.
    planes : tuple of {"xz", "yz"}
        Planes of symmetry.
    size : float
        Length of a panel, m, where nothing asks for smaller ones.
    q : int
        Points per side of a panel.

    Returns
    -------
    (n, q, q, 3) array
        m. x_u x x_v points into the hull.

    Raises
    ------
    InputError
        A patch has a free side that lies neither in z = 0 nor in a plane of symmetry.

    Notes
    -----
    Lines that run across several patches are divided once, so that panels share whole sides. Steps shrink as 1/n^2 towards
    the waterline and towards sides where the normal turns by more than 30 deg (bilge, stem, corners): there the velocity is
    singular.

    Examples
    --------
    >>> from ogilvie.mesh.shapes import box
    >>> hull_panels(box(4.0, 1.0, 0.5).surface, planes=("xz", "yz"), size=1.0, q=3).shape
    (21, 3, 3, 3)
    """
    scale = float(np.abs(surface.bounds).max())
    neighbours = _neighbours(surface, 1e-7 * scale)
    fine = _fine_sides(surface, neighbours, planes, 1e-7 * scale)
    breaks = _breaks(surface, neighbours, fine, size)
    out = []
    for i in range(len(surface.patches)):
        u, v = (2.0 * places(b, q) - 1.0 for b in breaks[2 * i : 2 * i + 2])
        grid = surface.at(i, u.ravel(), v.ravel()).reshape(len(u), q, len(v), q, 3)
        out.append(grid.transpose(0, 2, 1, 3, 4).reshape(-1, q, q, 3))
    return turned(np.concatenate(out))


# A side is numbered 4 i + k of patch i: k = 0, 1 for u = -1, 1 (it runs along v) and k = 2, 3 for v = -1, 1 (along u).
# A line is numbered 2 i (along u) or 2 i + 1 (along v).


def _points(surface: SmoothSurface, side: int, at: Array) -> Array:
    i, k = divmod(side, 4)
    end = [-1.0 if k % 2 == 0 else 1.0]
    return surface.at(i, end, at)[0] if k < 2 else surface.at(i, at, end)[:, 0]


def _normal(surface: SmoothSurface, side: int, at: float) -> Array:
    """Return the unit normal at one place of a side, a little inside of it (a patch may end in a point)."""
    i, k = divmod(side, 4)
    end = [-0.999 if k % 2 == 0 else 0.999]
    n = (surface.normal(i, end, [at]) if k < 2 else surface.normal(i, [at], end))[0, 0]
    return np.asarray(n / max(float(np.linalg.norm(n)), 1e-300))


def _line_along(side: int) -> int:
    i, k = divmod(side, 4)
    return 2 * i + (1 if k < 2 else 0)


def _line_across(side: int) -> int:
    i, k = divmod(side, 4)
    return 2 * i + (0 if k < 2 else 1)


def _neighbours(surface: SmoothSurface, near: float) -> list[tuple[int, int, bool]]:
    """Return pairs of sides at the same place, and whether they run opposite ways."""
    at = chebyshev_points(5) * np.array([1.0, 0.98, 1.0, 0.98, 1.0])
    curves = [_points(surface, s, at) for s in range(4 * len(surface.patches))]
    found = []
    for a in range(len(curves)):
        for b in range(a + 1, len(curves)):
            for reverse in (False, True):
                other = curves[b][::-1] if reverse else curves[b]
                if np.abs(curves[a] - other).max() <= near and np.ptp(curves[a], axis=0).max() > near:
                    found.append((a, b, reverse))
    return found


def _fine_sides(
    surface: SmoothSurface, neighbours: list[tuple[int, int, bool]], planes: tuple[str, ...], near: float
) -> list[bool]:
    """Return which sides (4 n,) call for small panels: those at the waterline and at sharp edges."""
    fine, shared = [False] * (4 * len(surface.patches)), {s for pair in neighbours for s in pair[:2]}
    for a, b, reverse in neighbours:
        turn = max(_turn(_normal(surface, a, t), _normal(surface, b, -t if reverse else t)) for t in (-0.5, 0.0, 0.5))
        fine[a] = fine[b] = turn > _SHARP
    for s in set(range(len(fine))) - shared:
        points = _points(surface, s, chebyshev_points(9))
        if np.ptp(points, axis=0).max() <= near:
            continue
        if np.abs(points[:, 2]).max() <= near:
            fine[s] = True
            continue
        axes = [_NORMAL_AXIS[p] for p in planes if np.abs(points[:, _NORMAL_AXIS[p]]).max() <= near]
        if not axes:
            raise InputError(
                f"surface: free sides on z = 0 or on a plane of symmetry only expected, patch {s // 4} has one at "
                f"{points[4].round(6).tolist()} m. The hull has a hole."
            )
        mirror = np.where(np.arange(3) == axes[0], -1.0, 1.0)
        fine[s] = any(_turn(n, n * mirror) > _SHARP for n in (_normal(surface, s, t) for t in (-0.5, 0.0, 0.5)))
    return fine


def _turn(a: Array, b: Array) -> float:
    return float(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))


def _breaks(surface: SmoothSurface, neighbours: list[tuple[int, int, bool]], fine: list[bool], size: float) -> list[Array]:
    """Return the divisions of [0, 1] of each line."""
    n = 2 * len(surface.patches)
    lines = _Lines(list(range(n)), [False] * n)
    for a, b, reverse in neighbours:
        lines.join(_line_along(a), _line_along(b), reverse)
    ends, length = np.zeros((n, 2), dtype=bool), np.zeros(n)
    for side, is_fine in enumerate(fine):
        root, reverse = lines.root(_line_across(side))
        ends[root, (side % 2) ^ reverse] |= is_fine
        curve = _points(surface, side, np.linspace(-1.0, 1.0, 33))
        root = lines.root(_line_along(side))[0]
        length[root] = max(length[root], float(np.linalg.norm(np.diff(curve, axis=0), axis=1).sum()))
    out = []
    for line in range(n):
        root, reverse = lines.root(line)
        graded = int(ends[root].sum())
        count = max(1 + graded, int(np.ceil(length[root] / size * (_MORE if graded else 1.0) - 0.3)))
        slopes = [0.0 if e else 2.0 if o else 1.0 for e, o in (ends[root], ends[root][::-1])]
        t = divisions(count, start=slopes[0], end=slopes[1])
        out.append(1.0 - t[::-1] if reverse else t)
    return out
