"""Shaded pictures of hulls and sea by the painter's algorithm, with an own projection: sharp and quick, and no window."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

PORT, STARBOARD, DECK, WATER = "#c2573f", "#2f8f74", "#c9ccd1", "#5b93bd"
_SUN = np.array([0.35, 0.55, 0.76])


@dataclass(frozen=True)
class Camera:
    """Looks at `target` from azimuth and elevation (rad; azimuth 0: from ahead, anticlockwise seen from above)."""

    azimuth: float
    elevation: float
    target: tuple[float, float, float] = (0.0, 0.0, 0.0)
    distance: float = np.inf

    def project(self, points: ArrayLike) -> tuple[Array, Array]:
        """Return picture coordinates (..., 2) and depth (...), larger is farther, of points (..., 3)."""
        x, y, z = np.moveaxis(np.asarray(points, dtype=float) - np.array(self.target), -1, 0)
        ca, sa, ce, se = np.cos(self.azimuth), np.sin(self.azimuth), np.cos(self.elevation), np.sin(self.elevation)
        right = -x * sa + y * ca
        towards = x * ca + y * sa
        up = z * ce - towards * se
        depth = -(towards * ce + z * se)
        scale = 1.0 if np.isinf(self.distance) else self.distance / (self.distance + depth)
        return np.stack([right * scale, up * scale], axis=-1), depth


@dataclass(frozen=True)
class Surface:
    """Polygons (n, 4, 3) with a colour each (n, 4: RGBA) and an edge colour."""

    polygons: Array
    colours: Array
    edges: Array

    def __add__(self, other: "Surface") -> "Surface":
        both = ((getattr(self, f), getattr(other, f)) for f in ("polygons", "colours", "edges"))
        return Surface(*(np.concatenate(pair) for pair in both))


def draw(ax: Any, surface: Surface, camera: Camera, *, linewidth: float = 0.25) -> None:
    """Paint the polygons from far to near."""
    from matplotlib.collections import PolyCollection

    flat, depth = camera.project(surface.polygons)
    order = np.argsort(-depth.mean(axis=1))
    ax.add_collection(
        PolyCollection(
            list(flat[order]), facecolors=surface.colours[order], edgecolors=surface.edges[order], linewidths=linewidth
        )
    )
    low, high = flat.reshape(-1, 2).min(axis=0), flat.reshape(-1, 2).max(axis=0)
    ax.set_xlim(low[0], high[0])
    ax.set_ylim(low[1], high[1])
    ax.set_aspect("equal")
    ax.set_axis_off()


def lit(polygons: Array, colour: str | list[str], *, alpha: float = 1.0, edge: float = 0.82, gloss: float = 0.0) -> Surface:
    """Return polygons shaded by a sun high on port bow; `edge` darkens (1: as the face) the outline of a panel."""
    from matplotlib.colors import to_rgb

    base = np.array([to_rgb(c) for c in ([colour] if isinstance(colour, str) else colour)])
    normal = np.cross(polygons[:, 2] - polygons[:, 0], polygons[:, 3] - polygons[:, 1])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    sun = np.abs(normal @ (_SUN / np.linalg.norm(_SUN)))
    shade = (0.52 + 0.48 * sun)[:, None]
    rgb = np.clip(base * shade + gloss * sun[:, None] ** 24, 0.0, 1.0)
    colours = np.column_stack([rgb, np.full(len(rgb), alpha)])
    outline = np.column_stack([rgb * edge, np.full(len(rgb), alpha)])
    return Surface(polygons, colours, outline)


def hull_surface(mesh: Any, *, pose: ArrayLike | None = None, freeboard: float = 0.0) -> Surface:
    """Return the wetted hull, port red and starboard green, and above it (for the picture only) wall sides and a deck.

    `pose` is a 6-vector eta; the picture uses the full rotation.
    """
    full = mesh.full()
    P = full.vertices[full.faces]  # (n, 4, 3)
    surface = lit(P, [PORT if c > 0 else STARBOARD for c in P[:, :, 1].mean(axis=1)])
    if freeboard > 0.0:
        surface = surface + _topsides(P, freeboard)
    return surface if pose is None else Surface(moved(surface.polygons, pose), surface.colours, surface.edges)


def moved(points: ArrayLike, pose: ArrayLike) -> Array:
    """Return points (..., 3) of the body in the world for a pose eta (6,)."""
    from ogilvie.frames import rotation_matrix

    eta = np.asarray(pose, dtype=float)
    return np.asarray(points) @ rotation_matrix(*eta[3:]).T + eta[:3]


def waterline(P: Array) -> Array:
    """Return the edges (n, 2, 3) of panels (n, 4, 3) that lie on the still water."""
    a, b = P, np.roll(P, -1, axis=1)
    size = np.ptp(P[:, :, 2])
    on = (np.abs(a[..., 2]) < 1e-4 * size) & (np.abs(b[..., 2]) < 1e-4 * size)
    on &= np.linalg.norm(b - a, axis=-1) > 1e-9 * size
    flat = np.ptp(P[:, :, 2], axis=1) < 1e-6 * size  # lid panels have all edges there
    on &= ~flat[:, None]
    return np.stack([a[on], b[on]], axis=1)


def _topsides(P: Array, freeboard: float) -> Surface:
    E = waterline(P)
    up = np.array([0.0, 0.0, freeboard])
    wall = np.stack([E[:, 0], E[:, 1], E[:, 1] + up, E[:, 0] + up], axis=1)
    sides = lit(wall, "#e4e2dc", edge=0.97)
    centre = E.copy()
    centre[..., 1] = 0.0
    deck = lit(np.stack([E[:, 0], E[:, 1], centre[:, 1], centre[:, 0]], axis=1) + up, DECK, edge=0.97)
    return sides + deck
