"""Hulls with known properties, built here from grids so that no test depends on `shapes`."""

from collections.abc import Callable

import numpy as np
import pytest

from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.topology import merge_vertices


def _patch(origin, a, b, n, m):
    """Corners (n m, 4, 3) of a grid on origin + s a + t b; normals along a x b."""
    s, t = np.linspace(0.0, 1.0, n + 1), np.linspace(0.0, 1.0, m + 1)
    p = origin + s[:, None, None] * np.asarray(a, float) + t[None, :, None] * np.asarray(b, float)
    return np.stack([p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]], axis=2).reshape(-1, 4, 3)


def _from_corners(corners, **options) -> PanelMesh:
    points = np.concatenate(corners).reshape(-1, 3)
    vertices, faces = merge_vertices(points, np.arange(len(points)).reshape(-1, 4), tolerance=1e-9)
    return PanelMesh(vertices, faces, **options)


def _box(length=8.0, beam=4.0, low=-2.0, high=1.0, *, n=3, symmetry="none", deck=True, bottom=True) -> PanelMesh:
    """Box with normals outward; `symmetry` leaves the mirrored parts out; open at the top without deck."""
    x0 = 0.0 if symmetry == "xz+yz" else -length / 2
    y0 = -beam / 2 if symmetry == "none" else 0.0
    x1, y1, h = length / 2, beam / 2, high - low
    L, B = x1 - x0, y1 - y0
    sides = [_patch([x1, y0, low], [0, B, 0], [0, 0, h], n, n), _patch([x0, y1, low], [0, 0, h], [L, 0, 0], n, n)]
    if symmetry != "xz+yz":
        sides.append(_patch([x0, y0, low], [0, 0, h], [0, B, 0], n, n))
    if symmetry == "none":
        sides.append(_patch([x0, y0, low], [L, 0, 0], [0, 0, h], n, n))
    if bottom:
        sides.append(_patch([x0, y0, low], [0, B, 0], [L, 0, 0], n, n))
    if deck:
        sides.append(_patch([x0, y0, high], [L, 0, 0], [0, B, 0], n, n))
    return _from_corners(sides, symmetry=symmetry, name="box")


def _sphere(n=8, *, radius=1.0, center=(0.0, 0.0, 0.0), turn=0.0) -> PanelMesh:
    """Closed sphere of 2 n meridians and n rows, triangles at the poles."""
    theta, phi = np.linspace(0.0, np.pi, n + 1), np.linspace(0.0, 2 * np.pi, 2 * n + 1) + turn
    t, p = np.meshgrid(theta, phi, indexing="ij")
    xyz = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], axis=-1) * radius + center
    corners = np.stack([xyz[:-1, :-1], xyz[1:, :-1], xyz[1:, 1:], xyz[:-1, 1:]], axis=2).reshape(-1, 4, 3)
    return _from_corners([corners], name="sphere")


def _blob(seed=0, *, n=3, amount=0.25) -> PanelMesh:
    """Closed box with vertices moved at random: warped panels, no symmetry."""
    mesh = _box(n=n)
    shift = np.random.default_rng(seed).uniform(-amount, amount, mesh.vertices.shape)
    return PanelMesh(mesh.vertices + shift, mesh.faces, name="blob")


@pytest.fixture(scope="session")
def box() -> Callable[..., PanelMesh]:
    return _box


@pytest.fixture(scope="session")
def sphere() -> Callable[..., PanelMesh]:
    return _sphere


@pytest.fixture(scope="session")
def blob() -> Callable[..., PanelMesh]:
    return _blob
