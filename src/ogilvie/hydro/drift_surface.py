"""The control surface of the mean drift: a vertical cylinder with a flat bottom around the hull, the water surface within."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.drift_panels import WholeHull

Array = NDArray[np.float64]

#: Gauss points in depth, along the bottom's radius, and from the waterline to the wall: these grow with the distance from the
#: sides of a long hull, on which many waves lie.
N_DEPTH, N_BOTTOM, N_RING, N_FARTHER = 10, 24, 10, 3.0
_GAP = 0.25  # distance of the wall from the hull, in radii of the hull


@dataclass(frozen=True, eq=False)
class ControlSurface:
    """Points in the stored part of the water (for two planes of symmetry x, y >= 0), with weights.

    Parameters
    ----------
    radius, bottom : float
        m; the flat bottom is at z = -bottom.
    wall, floor, ring, rim : (n, 3) array
        Points on the wall, the bottom, the free surface between waterline and wall, and the circle z = 0.
    d_wall, d_floor, d_ring, d_rim : (n,) array
        m2, m2, m2, m.
    ring_is_whole : bool
        False if the waterline is not a single one seen from all sides; then the ring has no points. A submerged hull has the
        whole disc.
    """

    radius: float
    bottom: float
    wall: Array
    floor: Array
    ring: Array
    rim: Array
    d_wall: Array
    d_floor: Array
    d_ring: Array
    d_rim: Array
    ring_is_whole: bool

    @cached_property
    def points(self) -> Array:
        """All points (n, 3): wall, floor, ring, rim."""
        return np.concatenate([self.wall, self.floor, self.ring, self.rim])

    def split(self, values: NDArray, copies: int) -> list[NDArray]:
        """Return values (n_b, n_c n, ...) at all copies of the points as parts for wall, floor, ring and rim."""
        ends = np.cumsum([len(p) for p in (self.wall, self.floor, self.ring, self.rim)])[:-1]
        by_copy = values.reshape(len(values), copies, -1, *values.shape[2:])
        return [p.reshape(len(values), -1, *values.shape[2:]) for p in np.split(by_copy, ends, axis=2)]


def control_surface(hull: WholeHull, *, k: float, depth: float) -> ControlSurface:
    """Return a control surface for waves up to wavenumber k.

    Parameters
    ----------
    hull : WholeHull
    k : float
        rad/m; sets the number of points around.
    depth : float
        m.
    """
    mesh = hull.panels.hull
    size = float(np.linalg.norm(mesh.vertices[np.unique(mesh.faces)][:, :2], axis=1).max())
    R = size + max(_GAP * size, 0.25 * mesh.draught)
    below = max(0.5 * mesh.draught, 0.25 * min(mesh.beam, mesh.length))
    D = mesh.draught + (min(below, 0.5 * (depth - mesh.draught)) if np.isfinite(depth) else below)
    planes = len(hull.panels.images)
    n = 4 * int(np.ceil((2.0 * k * R + 24.0) / 4.0))
    if size > 3.0 * min(mesh.beam, mesh.length):
        n = max(n, 64)
    angle = (2.0 * np.pi / n) * (np.arange(n // planes) + 0.5)
    d = 2.0 * np.pi / n
    circle = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=1)
    z, dz = _gauss(N_DEPTH, -D, 0.0)
    wall = (R * circle[:, None] + z[None, :, None] * [0.0, 0.0, 1.0]).reshape(-1, 3)
    r, dr = _gauss(N_BOTTOM, 0.0, R)
    floor = (r[None, :, None] * circle[:, None] - [0.0, 0.0, D]).reshape(-1, 3)
    submerged = len(hull.stored_waterline.owner) == 0
    ring, d_ring = (floor * [1.0, 1.0, 0.0], np.tile(r * dr * d, len(circle))) if submerged else _ring(hull, R)
    return ControlSurface(
        radius=R,
        bottom=D,
        wall=wall,
        floor=floor,
        ring=ring,
        rim=R * circle,
        d_wall=np.tile(R * d * dz, len(circle)),
        d_floor=np.tile(r * dr * d, len(circle)),
        d_ring=d_ring,
        d_rim=np.full(len(circle), R * d),
        ring_is_whole=len(ring) > 0,
    )


def _gauss(n: int, a: float, b: float) -> tuple[Array, Array]:
    x, w = np.polynomial.legendre.leggauss(n)
    return 0.5 * (b - a) * (x + 1.0) + a, 0.5 * (b - a) * w


def _ring(hull: WholeHull, R: float) -> tuple[Array, Array]:
    """Return points (n, 3) and areas (n,) between the stored waterline and the circle, on rays through the edges' middles.

    An edge from p to q is seen from O under the angle dtheta = p x q/|m|^2 (m its middle); with r = |m| + t (R - |m|) the area
    is r dr dtheta. The points crowd towards the waterline.
    """
    line = hull.stored_waterline
    m = line.middle[:, :2]
    size2 = np.einsum("ni,ni->n", m, m)
    turn = line.length * np.einsum("ni,ni->n", m, line.normal[:, :2])  # twice the area of the triangle O p q
    seen = 2.0 * np.pi / len(hull.panels.images)
    start, end = m - 0.5 * line.tangent[:, :2], m + 0.5 * line.tangent[:, :2]
    cross = end[:, 0] * start[:, 1] - end[:, 1] * start[:, 0]
    angle = np.arctan2(cross, np.einsum("ni,ni->n", start, end))
    if np.any(turn <= 0.0) or abs(angle.sum() - seen) > 1e-3 * seen:
        return np.zeros((0, 3)), np.zeros(0)
    near = np.sqrt(size2)[:, None]
    s, ds = _gauss(int(np.ceil(N_RING + N_FARTHER * (R / near.min() - 1.0))), 0.0, 1.0)
    t, dt = s**2, 2.0 * s * ds
    r = near + t * (R - near)
    area = r * dt * (R - near) * angle[:, None]
    points = np.zeros((*r.shape, 3))
    points[..., :2] = r[..., None] * (m / near)[:, None, :]
    return points.reshape(-1, 3), area.ravel()
