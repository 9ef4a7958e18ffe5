"""The chine of a half hull: found, spread out, and kept sharp in the fitted surface."""

import numpy as np
import pytest

from ogilvie.bem import hull_surface
from ogilvie.bem.fitted_hull import distances, fitted_panels
from ogilvie.mesh import shapes
from ogilvie.mesh.fitting import fitted
from ogilvie.mesh.flattening import flattened
from ogilvie.mesh.panels import PanelMesh


def bare(hull):
    """The panels without the smooth surface that they came from."""
    return PanelMesh(hull.vertices, hull.faces, symmetry=hull.symmetry).with_symmetry("xz")


def wedge(deadrise, *, length=40.0, beam=8.0, draught=2.0, bow=12.0, stations=41, rows=7):
    """A hull of flat bottom halves with deadrise and vertical sides, its bow a wedge down to a vertical stem, transom stern."""
    x = np.linspace(0.0, length, stations)
    y = 0.5 * beam * np.clip((length - x) / bow, 0.0, 1.0)
    chine = -draught + y * np.tan(deadrise)
    s = np.linspace(0.0, 1.0, rows)[:, None]
    bottom = np.stack([x + 0.0 * s, s * y, -draught + s * (chine + draught)], axis=-1)
    side = np.stack([x + 0.0 * s, y + 0.0 * s, chine * (1.0 - s)], axis=-1)
    t = s[:, 0]
    depth = t[None, :] * y[0]
    stern = np.stack([0.0 * depth * (1 - s), depth + 0.0 * s, (1.0 - s) * (-draught + depth * np.tan(deadrise))], axis=-1)
    vertices, faces = [], []
    for grid, outward in ((bottom, (0, 0, -1)), (side, (0, 1, 0)), (stern, (-1, 0, 0))):
        i = sum(len(v) for v in vertices) + np.arange(grid[..., 0].size).reshape(grid.shape[:2])
        four = np.stack([i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]], axis=-1).reshape(-1, 4)
        across = np.cross(grid[0, 1] - grid[0, 0], grid[1, 0] - grid[0, 0]) @ outward
        vertices.append(grid.reshape(-1, 3))
        faces.append(four if across > 0.0 else four[:, ::-1])
    return PanelMesh(np.concatenate(vertices), np.concatenate(faces), symmetry="xz", name="wedge")


CHINED = {
    "box": lambda: bare(shapes.box(60.0, 20.0, 6.0, panels=900)),
    "cylinder": lambda: bare(shapes.cylinder(10.0, 5.0, panels=900)),
    "wedge": lambda: wedge(np.radians(5.0)),
}


@pytest.mark.parametrize("name", CHINED)
def test_the_chine_is_the_edge_of_the_bottom_and_the_map_is_one_to_one(name):
    flat = flattened(CHINED[name]())
    assert 0.25 <= flat.chine <= 0.75
    line = (flat.side == 4) | np.isin(np.arange(len(flat.side)), flat.tips)
    x, y, z = flat.vertices[line].T
    radius = np.hypot(*flat.vertices[:, :2].T).max()  # a little over 10 m: flat panels of the same volume
    expected = {
        "box": lambda: np.abs(y - 10.0) + np.abs(z + 6.0),
        "cylinder": lambda: np.abs(np.hypot(x, y) - radius) + np.abs(z + 5.0),
        "wedge": lambda: np.abs(y - np.minimum(4.0, (40.0 - x) / 3.0)) + np.abs(z + 2.0 - y * np.tan(np.radians(5.0))),
    }[name]()
    assert expected.max() < 1e-9
    assert np.ptp(x) == pytest.approx(np.ptp(flat.vertices[:, 0]), rel=1e-9)
    p = flat.uv[flat.triangles]
    d, e = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    area = 0.5 * (d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0])
    near_tip = np.isin(flat.triangles, flat.tips).any(axis=1)  # the tip stands for a side
    assert area[~near_tip].max() < 0.0


@pytest.mark.parametrize(("name", "tips"), [("box", 0), ("cylinder", 2), ("wedge", 1)])
def test_bottoms_end_in_points_where_keel_and_chine_meet(name, tips):
    flat = flattened(CHINED[name]())
    assert len(flat.tips) == tips
    sheet = fitted(flat)
    v = np.linspace(0.0, flat.chine, 5)
    for tip in flat.tips:
        side = sheet.at(flat.uv[tip, :1], v)[0]
        np.testing.assert_allclose(side, np.tile(flat.vertices[tip], (5, 1)), atol=1e-9)


@pytest.mark.parametrize("name", CHINED)
def test_the_fitted_surface_keeps_the_edge(name):
    hull = CHINED[name]()
    fit = fitted_panels(hull, size=0.1 * hull.length, q=6)
    assert fit.jacobian > 0.0
    rough = 10.0 if name == "wedge" else 1.0  # its side turns by 18 deg where the bow begins: that edge is rounded off
    assert fit.rms < rough * 2e-4 * hull.beam
    radius = np.hypot(*hull.vertices[:, :2].T).max()
    exact = {"box": 7200.0, "cylinder": 5.0 * np.pi * radius**2, "wedge": hull.volume}[name]
    assert fit.volume == pytest.approx(exact, rel=1.5e-3)
    flat = flattened(hull)
    edge = flat.vertices[flat.side == 4]
    off = distances(edge, fit.panels)
    assert off.max() < rough * 1e-3 * hull.beam


@pytest.mark.parametrize(
    "hull",
    [
        lambda: shapes.s175(panels=900),
        lambda: bare(shapes.hemisphere(5.0, panels=900)),
        lambda: bare(shapes.wigley(100.0, 10.0, 6.25, panels=900)),
        lambda: shapes.from_particulars(length=100.0, beam=25.0, draught=5.0, cb=0.93, panels=900),
    ],
)
def test_round_bilges_are_none(hull):
    flat = flattened(hull())
    assert flat.chine == 0.0
    assert flat.tips == ()
    assert not np.any(flat.side == 4)


def test_an_edge_that_ends_half_way_is_none():
    """The side of a box turned in gradually forward of amidships, so that the bilge is flat there."""
    hull = bare(shapes.box(60.0, 20.0, 6.0, panels=900, grading=0.0))
    x, y, z = hull.vertices.T
    forward = np.clip(x / 30.0, 0.0, 1.0)
    low = np.clip(-z / 6.0, 0.0, 1.0)
    bent = np.stack([x, y * (1.0 - 0.9 * forward * low), z * (1.0 - 0.3 * forward * np.abs(y) / 10.0)], axis=1)
    flat = flattened(PanelMesh(bent, hull.faces, symmetry="xz"))
    assert flat.chine == 0.0


def test_a_chine_that_cannot_be_kept_is_rounded_off(monkeypatch):
    hull = CHINED["box"]()
    good = hull_surface._is_good
    assert hull_surface._best_fit(hull, 6.0, 6).chine
    monkeypatch.setattr(hull_surface, "_is_good", lambda fit, hull: not fit.chine and good(fit, hull))
    rounded = hull_surface._best_fit(hull, 6.0, 6)
    assert not rounded.chine
    assert rounded.rms > 1e-3 * hull.beam
