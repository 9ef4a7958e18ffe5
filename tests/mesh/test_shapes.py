"""Hulls with a formula: volumes, areas and places of vertices from mathematics."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ogilvie.errors import InputError
from ogilvie.mesh import shapes
from ogilvie.mesh.hydrostatics import hydrostatics
from ogilvie.mesh.inspect import check_mesh
from ogilvie.mesh.patches import coons, panel_mesh, quarter_disc, spacing

ALL = {
    "hemisphere": lambda n: shapes.hemisphere(5.0, panels=n),
    "box": lambda n: shapes.box(100.0, 20.0, 5.0, panels=n),
    "cylinder": lambda n: shapes.cylinder(10.0, 10.0, panels=n),
    **{f"wigley {k}": (lambda n, k=k: shapes.wigley(kind=k, panels=n)) for k in ("I", "II", "III", "IV", "parabolic")},
}


@pytest.mark.parametrize("panels", [60, 300, 1500])
@pytest.mark.parametrize("name", ALL)
def test_closed_hull_below_water_within_the_panel_count(name, panels):
    mesh = ALL[name](panels)
    assert mesh.symmetry == "xz+yz"
    assert 0.45 * panels < 4 * mesh.n_faces <= panels
    assert check_mesh(mesh).findings == ()
    assert mesh.vertices.max(axis=0)[2] == 0.0
    assert mesh.vertices[:, :2].min() == 0.0
    assert panels < 100 or not mesh.is_triangle.any()
    np.testing.assert_allclose(mesh.volumes, mesh.volume, rtol=1e-12)


@pytest.mark.parametrize(
    ("name", "volume"),
    [
        ("hemisphere", 2.0 / 3.0 * np.pi * 5.0**3),
        ("box", 100.0 * 20.0 * 5.0),
        ("cylinder", np.pi * 10.0**3),
        ("wigley parabolic", 3.0 * 0.3 * 0.1875 * 4.0 / 9.0),
    ],
)
def test_volume_is_that_of_the_formula_at_any_number_of_panels(name, volume):
    for panels in (40, 500):
        assert ALL[name](panels).volume == pytest.approx(volume, rel=1e-12)


@pytest.mark.parametrize(("kind", "volume"), [("I", 0.0946), ("II", 0.1892), ("III", 0.0780), ("IV", 0.1560)])
def test_wigley_volumes_of_journee(kind, volume):
    assert shapes.wigley(kind=kind, panels=400).volume == pytest.approx(volume, abs=5e-5)


@pytest.mark.parametrize(("kind", "alpha", "c"), [("II", 1.0, 0.2), ("III", 0.0, 0.2), ("parabolic", 0.0, 0.0)])
def test_wigley_vertices_lie_on_the_formula_up_to_one_factor(kind, alpha, c):
    L, B, T = 120.0, 17.0, 6.0
    mesh = shapes.wigley(L, B, T, kind=kind, panels=900)
    xi, eta, zeta = (mesh.vertices * [2.0 / L, 2.0 / B, 1.0 / T]).T
    formula = (1 - zeta**2) * (1 - xi**2) * (1 + c * xi**2) + alpha * zeta**2 * (1 - zeta**8) * (1 - xi**2) ** 4
    off = formula > 1e-9
    factor = eta[off] / formula[off]
    assert np.ptp(factor) < 1e-9
    assert 1.0 < factor.mean() < 1.02
    assert eta[~off].max() < 1e-9


def test_hemisphere_vertices_lie_on_one_sphere_whose_radius_converges_with_the_square_of_the_panel_size():
    excess = []
    for panels in (108, 432, 1728):
        mesh = shapes.hemisphere(2.0, panels=panels, grading=0.0)
        r = np.linalg.norm(mesh.vertices, axis=1)
        assert np.ptp(r) < 1e-12
        excess.append(r[0] / 2.0 - 1.0)
    slopes = np.log2(np.array(excess[:-1]) / excess[1:])
    np.testing.assert_allclose(slopes, 2.0, atol=0.1)


def test_hemisphere_hydrostatics_converge_to_the_sphere():
    h = hydrostatics(shapes.hemisphere(1.0, panels=1500))
    assert h.center_of_buoyancy[2] == pytest.approx(-3.0 / 8.0, rel=2e-3)
    assert h.waterplane_area == pytest.approx(np.pi, rel=2e-3)
    assert h.wetted_area == pytest.approx(2.0 * np.pi, rel=2e-3)


@pytest.mark.parametrize("make", [shapes.hemisphere, lambda r, **k: shapes.cylinder(r, 1.0, **k)])
def test_panels_get_flatter_towards_the_waterline(make):
    def top_row(grading):
        mesh = make(1.0, panels=1000, grading=grading)
        z = np.unique(np.round(mesh.vertices[:, 2][mesh.vertices[:, 2] < 0.0], 9))
        return -z.max()

    assert top_row(0.8) < 0.6 * top_row(0.0)


def test_cylinder_has_the_area_of_the_circle_in_every_waterplane():
    mesh = shapes.cylinder(3.0, 6.0, panels=200)
    assert hydrostatics(mesh).waterplane_area == pytest.approx(9.0 * np.pi, rel=1e-12)
    assert -mesh.center_of_buoyancy[2] == pytest.approx(3.0, rel=1e-12)


@settings(max_examples=25, deadline=None)
@given(st.floats(1.0, 400.0), st.floats(0.1, 1.0), st.floats(0.02, 1.0), st.integers(12, 600), st.floats(0.0, 0.9))
def test_box_of_any_size(length, beam, draught, panels, grading):
    B, T = beam * length, draught * length
    mesh = shapes.box(length, B, T, panels=panels, grading=grading)
    assert mesh.volume == pytest.approx(length * B * T, rel=1e-9)
    np.testing.assert_allclose(mesh.bounds, [[-length / 2, -B / 2, -T], [length / 2, B / 2, 0.0]], rtol=1e-12)


def test_shapes_scale():
    small, large = shapes.wigley(3.0, panels=300), shapes.wigley(30.0, panels=300)
    np.testing.assert_allclose(10.0 * small.vertices, large.vertices, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    "call",
    [
        lambda: shapes.hemisphere(-1.0),
        lambda: shapes.hemisphere(1.0, panels=4),
        lambda: shapes.hemisphere(1.0, grading=1.5),
        lambda: shapes.box(1.0, np.nan, 1.0),
        lambda: shapes.cylinder(1.0, 0.0),
        lambda: shapes.wigley(kind="V"),
        lambda: shapes.wigley(3.0, -0.3),
    ],
)
def test_nonsense_is_refused(call):
    with pytest.raises(InputError, match="expected"):
        call()


def test_spacing_is_monotone_from_0_to_1():
    for fine in ("end", "both"):
        for grading in (0.0, 0.3, 1.0):
            s = spacing(9, grading=grading, fine=fine)
            assert s[0] == 0.0
            assert s[-1] == pytest.approx(1.0)
            assert np.diff(s).min() > 0.0
    assert np.diff(spacing(9, grading=1.0))[-1] < 0.1 * np.diff(spacing(9, grading=1.0))[0]


def test_quarter_disc_covers_a_quarter_of_the_circle():
    grids = [np.dstack([g, 0.0 * g[..., 0]]) for g in quarter_disc(8, 6)]
    mesh = panel_mesh(grids, symmetry="none", name="disc")
    d = np.pi / 32
    assert mesh.areas.sum() == pytest.approx(np.pi / 4 * np.sin(d) / d, rel=1e-12)


def test_coons_patch_of_straight_borders_is_bilinear():
    s = np.linspace(0.0, 1.0, 5)[:, None]
    a, b, c, d = np.array([[0.0, 0, 0], [2, 0, 0], [3, 1, 1], [0, 1, 0]])
    grid = coons(a + s * (b - a), d + s * (c - d), a + s * (d - a), b + s * (c - b))
    np.testing.assert_allclose(grid[2, 2], (a + b + c + d) / 4.0)
