"""Boundaries round ships given by flat panels: fitted surfaces, panels as they are, and hulls that do not work."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.bem.curved import BODY, FREE
from ogilvie.bem.curves import sides
from ogilvie.bem.fitted_hull import distances, fitted_panels
from ogilvie.bem.inner_checks import inspect_inner
from ogilvie.bem.inner_mesh import inner_mesh
from ogilvie.errors import InputError
from ogilvie.mesh import shapes
from ogilvie.mesh.panels import PanelMesh

LOFTED = {
    "s175": lambda: shapes.s175(panels=1200),
    "fine": lambda: shapes.from_particulars(length=175.0, beam=25.4, draught=9.5, cb=0.572, panels=1200),
    "barge": lambda: shapes.from_particulars(length=100.0, beam=25.0, draught=5.0, cb=0.93, panels=1200),
}
FILES = {
    "tanker": "mss_wamit_tanker/tanker.gdf",
    "fpso": "mss_wamit_fpso/fpso_low.gdf",
    "kvlcc2": "kvlcc2_hull/kvlcc2_coarse.gdf",
    "dtmb5415": "dtmb5415_hull/dtmb5415_maorg.gdf",
}


def check(mesh, hull, *, volume, nodes):
    report = inspect_inner(mesh)
    assert report.closure < 1e-9
    assert report.jacobian > 0.0
    assert report.volume + report.displacement == pytest.approx(2.0 / 3.0 * np.pi * mesh.radius**3, rel=1e-7)
    assert report.displacement == pytest.approx(hull.volume, rel=volume)
    assert 9 * len(mesh.part) <= nodes
    assert mesh.symmetry == "xz"


@pytest.mark.parametrize("name", LOFTED)
def test_lofted_ships_are_smooth_and_closed(name):
    hull = LOFTED[name]()
    mesh = inner_mesh(hull)
    assert mesh.notes[0].startswith("smooth surface fitted")
    check(mesh, hull, volume=3e-3 if name == "barge" else 1.5e-3, nodes=1900)  # the barge's knuckles are rounded


def test_volume_of_lofted_ships_is_that_of_their_surface_at_any_number_of_panels():
    """Panels of lofts are moved off the surface to keep its volume; the fit goes through where they were on it."""
    for panels in (500, 1500):
        hull = shapes.s175(panels=panels)
        assert inspect_inner(inner_mesh(hull)).displacement == pytest.approx(shapes.s175(panels=2000).volume, rel=2e-3)


@pytest.mark.parametrize("name", FILES)
def test_published_ships_are_smooth_and_closed(shared_data, name):
    hull = og.load_mesh(shared_data / FILES[name])
    mesh = inner_mesh(hull)
    assert mesh.notes[0].startswith("smooth surface fitted")
    check(mesh, hull, volume=0.004, nodes=2500)


@pytest.mark.parametrize(("name", "rms"), [("tanker", 0.0015), ("fpso", 0.0035), ("kvlcc2", 0.0015), ("dtmb5415", 0.0015)])
def test_fitted_surface_is_near_to_the_panels(shared_data, name, rms):
    hull = og.load_mesh(shared_data / FILES[name])
    fit = fitted_panels(hull, size=0.1 * hull.length, q=6)
    assert fit.rms < rms * hull.beam
    assert fit.most < 0.02 * hull.beam


def test_columns_stand_on_the_waterline_of_the_hull():
    mesh = inner_mesh(LOFTED["fine"]())
    hull, water = mesh.points[mesh.part == BODY], mesh.points[mesh.part == FREE]
    along = sides(hull)
    top, foot = along[np.abs(along[..., 2]).max(axis=2) == 0.0], water[:, 0]
    assert len(top) >= 12
    near = [np.abs(top - f).max(axis=(1, 2)).min() for f in foot]
    reverse = [np.abs(top[:, ::-1] - f).max(axis=(1, 2)).min() for f in foot]
    on = np.minimum(near, reverse) < 1e-9
    assert on.sum() == len(top)


@pytest.mark.parametrize("name", ["s175", "barge"])
def test_panels_as_they_are_close_too(name):
    hull = LOFTED[name]()
    mesh = inner_mesh(hull, surface="panels")
    assert mesh.notes == (f"{(mesh.part == BODY).sum()} flat panels as they are",)
    report = inspect_inner(mesh)
    assert report.closure < 1e-8  # circle and control surface are divided differently
    assert report.jacobian > -1e-12
    assert report.displacement == pytest.approx(hull.volume, rel=1e-3)  # warped panels: bilinear, not two triangles


@pytest.mark.parametrize("name", FILES)
def test_published_panels_as_they_are(shared_data, name):
    hull = og.load_mesh(shared_data / FILES[name])
    report = inspect_inner(inner_mesh(hull, surface="panels"))
    assert report.closure < 1e-4  # gaps of the files themselves, where patches meet
    assert report.displacement == pytest.approx(hull.volume, rel=3e-4)


def test_whole_ship_is_halved():
    half = LOFTED["fine"]()
    a, b = inner_mesh(half), inner_mesh(half.full())
    assert b.symmetry == "xz"
    np.testing.assert_allclose(inspect_inner(b).displacement, inspect_inner(a).displacement, rtol=1e-3)


def test_fit_of_a_wigley_hull_is_near_to_its_formula():
    hull = shapes.wigley(100.0, 15.0, 6.0, kind="III", panels=1500)
    bare = PanelMesh(hull.vertices, hull.faces, symmetry="xz+yz").with_symmetry("xz")
    fit = fitted_panels(bare, size=9.0, q=6)
    t = np.linspace(-1.0, 1.0, 15)
    exact = hull.surface.at(0, t, t).reshape(-1, 3)
    off = distances(exact, fit.panels)
    assert np.sqrt(np.mean(off**2)) < 0.002 * hull.beam
    assert fit.volume == pytest.approx(hull.volume, rel=0.004)


def test_shape_without_smooth_fit_falls_back_to_its_panels_and_says_so():
    hull = shapes.from_particulars(length=100.0, beam=25.0, draught=5.0, cb=0.93, panels=1200)
    rng = np.random.default_rng(1)
    v = hull.vertices.copy()
    inside = (v[:, 1] > 0.1) & (v[:, 2] < -0.1)
    v[inside] += rng.uniform(-0.5, 0.5, (int(inside.sum()), 3)) * [0.3, 1.0, 1.0]
    mesh = inner_mesh(PanelMesh(v, hull.faces, symmetry="xz"))
    assert "flat panels as they are; no good smooth surface" in mesh.notes[0]


def test_semi_submersible_is_refused(shared_data):
    with pytest.raises(InputError, match="several places"):
        inner_mesh(og.load_mesh(shared_data / "mss_wamit_semisub/semisub_low.gdf"))


def test_open_hull_is_refused():
    hull = LOFTED["barge"]()
    with pytest.raises(InputError, match="holes"):
        inner_mesh(PanelMesh(hull.vertices, hull.faces[20:], symmetry="xz"))


def test_waterline_that_turns_back_is_refused():
    """A hull in the shape of a C seen from above."""
    n = 48
    outer = np.array([[10 * np.cos(t), 10 * np.sin(t)] for t in np.linspace(0.6, 2 * np.pi - 0.6, n)])
    inner = 0.6 * outer[::-1]
    ring = np.vstack([outer, inner])
    m = len(ring)
    v = np.vstack([np.c_[ring, np.zeros(m)], np.c_[ring, np.full(m, -3.0)]])
    sides = [[i, i + m, (i + 1) % m + m, (i + 1) % m] for i in range(m)]
    bottom = [[m + i, m + 2 * n - 1 - i, m + 2 * n - 2 - i, m + i + 1] for i in range(n - 1)]
    with pytest.raises(InputError, match="star-shaped"):
        inner_mesh(PanelMesh(v, sides + bottom))


def test_unknown_representation_is_named():
    with pytest.raises(InputError, match="'auto', 'smooth' or 'panels'"):
        inner_mesh(shapes.hemisphere(1.0), surface="exact")


def test_smooth_is_an_error_where_no_sheet_fits():
    box = shapes.box(10.0, 4.0, 2.0, panels=300).full().rotated(psi=0.3)
    with pytest.raises(InputError, match="symmetry"):
        inner_mesh(PanelMesh(box.vertices, box.faces), surface="smooth")
