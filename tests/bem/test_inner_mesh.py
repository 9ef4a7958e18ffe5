"""Closed boundaries of the inner domain: Gauss's theorem, shared sides, sizes, and the errors that say what to do."""

import numpy as np
import pytest

from ogilvie.bem.control_mesh import control_panels
from ogilvie.bem.curved import BODY, CONTROL, FREE
from ogilvie.bem.curves import divisions, sides
from ogilvie.bem.inner_checks import inspect_inner, positions_and_normals
from ogilvie.bem.inner_mesh import inner_mesh
from ogilvie.errors import InputError
from ogilvie.mesh import shapes
from ogilvie.mesh.panels import PanelMesh

HULLS = {
    "hemisphere": lambda: shapes.hemisphere(5.0),
    "box": lambda: shapes.box(4.0, 1.0, 0.5),
    "cylinder": lambda: shapes.cylinder(1.0, 0.5),
    "spar": lambda: shapes.cylinder(1.0, 4.0),
    "wigley I": lambda: shapes.wigley(kind="I"),
    "wigley III": lambda: shapes.wigley(kind="III"),
    "half box": lambda: shapes.box(4.0, 1.0, 0.5).translated((3.0, 0.0, 0.0)),
    "whole wigley": lambda: shapes.wigley(kind="IV").translated((2.0, 1.0, 0.0)),
    "turned box": lambda: shapes.box(2.0, 1.0, 0.5).rotated(psi=0.4),
}


@pytest.fixture(scope="module", params=HULLS)
def case(request):
    hull = HULLS[request.param]()
    return hull, inner_mesh(hull)


def test_boundary_is_closed_and_encloses_half_a_ball_less_the_hull(case):
    hull, mesh = case
    report = inspect_inner(mesh)
    assert report.closure < 1e-9
    assert report.displacement == pytest.approx(hull.volume, rel=2e-6)
    assert report.volume == pytest.approx(2.0 / 3.0 * np.pi * mesh.radius**3 - hull.volume, rel=1e-7)
    assert report.jacobian > (0.01 if "Wigley" in hull.name else 0.2)  # a fan of columns at a sharp bow starts in one point
    assert np.rad2deg(report.angle) > (14.0 if mesh.symmetry == "none" else 36.0)


def test_normals_point_out_of_the_fluid(case):
    _, mesh = case
    x, n = positions_and_normals(mesh.points, np.array([-0.7, 0.0, 0.7]), np.array([-0.7, 0.0, 0.7]))
    assert np.all(n[mesh.part == FREE][..., 2] > 0.0)
    np.testing.assert_allclose(mesh.points[mesh.part == FREE][..., 2], 0.0, atol=0.0)
    out = (x * n)[mesh.part == CONTROL].sum(axis=-1)
    assert np.all(out > 0.0)
    np.testing.assert_allclose(np.linalg.norm(x[mesh.part == CONTROL], axis=-1), mesh.radius, rtol=3e-6)
    assert np.all((x * n)[mesh.part == BODY].sum(axis=(1, 2, 3)) < 0.0)


def test_every_side_is_shared_with_one_neighbour_or_lies_in_a_plane_of_symmetry(case):
    _, mesh = case
    all_sides = sides(mesh.points).reshape(-1, mesh.degree, 3)
    all_sides = all_sides[np.ptp(all_sides, axis=1).max(axis=1) > 1e-9 * mesh.radius]  # fans start in a point
    if mesh.symmetry == "none":  # the circle is divided twice, by columns and by the control surface
        on_circle = np.abs(np.linalg.norm(all_sides[..., :2], axis=-1) - mesh.radius).max(axis=1) < 1e-6 * mesh.radius
        all_sides = all_sides[~on_circle | (np.abs(all_sides[..., 2]).max(axis=1) > 1e-6 * mesh.radius)]
    axes = {"none": [], "xz": [1], "xz+yz": [0, 1]}[mesh.symmetry]
    inside = ~np.any([np.all(all_sides[..., a] == 0.0, axis=1) for a in axes] or [np.zeros(len(all_sides), bool)], axis=0)
    curves = all_sides[inside]
    from scipy.spatial import cKDTree

    both = np.concatenate([curves, curves[:, ::-1]]).reshape(2 * len(curves), -1)
    pairs = cKDTree(both).query_ball_point(curves.reshape(len(curves), -1), 1e-9 * mesh.radius)
    assert [len(p) for p in pairs] == [2] * len(curves)


def test_panels_on_both_sides_of_the_circle_are_of_like_size(case):
    _, mesh = case
    along = sides(mesh.points)
    on_circle = np.abs(np.linalg.norm(along[..., :2], axis=-1) - mesh.radius).max(axis=2) < 1e-9 * mesh.radius
    length = np.linalg.norm(np.diff(along, axis=2), axis=-1).sum(axis=2)
    height = {
        part: np.mean(
            [length[i, 2:].mean() if k < 2 else length[i, :2].mean() for i, k in np.argwhere(on_circle) if mesh.part[i] == part]
        )
        for part in (FREE, CONTROL)
    }
    assert 0.5 < height[FREE] / height[CONTROL] < 3.2


def test_hemisphere_within_500_nodes_and_more_than_12_rows_in_depth():
    mesh = inner_mesh(shapes.hemisphere(1.0))
    assert 9 * len(mesh.part) <= 500
    g = np.polynomial.legendre.leggauss(3)[0]
    x, _ = positions_and_normals(mesh.points[mesh.part == CONTROL], g, g)
    on_edge = np.sort(x[..., 2].ravel())
    assert (np.diff(on_edge) > 1e-6).sum() + 1 > 12


@pytest.mark.parametrize("symmetry", ["quarter", "half"])
def test_polynomials_in_all_panels_integrate_as_the_divergence_theorem_says(symmetry):
    """Surface integral of x (y^2 + z^2) n_x - and others - of fluid outside a sphere: closed forms of half balls."""
    hull = shapes.hemisphere(1.0)
    mesh = inner_mesh(hull if symmetry == "quarter" else hull.translated((0.25, 0.0, 0.0)))
    g, w = np.polynomial.legendre.leggauss(10)
    x, n = positions_and_normals(mesh.points, g, g)
    # div (x z^2, 0, 0) = z^2: 2 pi R^5 / 15 over half a ball
    flux = np.einsum("a,b,nab->", w, w, x[..., 0] * x[..., 2] ** 2 * n[..., 0]) * len(mesh.images)
    assert flux == pytest.approx(2.0 * np.pi * (mesh.radius**5 - 1.0) / 15.0, rel=1e-6)
    assert mesh.centre == ((0.0, 0.0, 0.0) if symmetry == "quarter" else (0.25, 0.0, 0.0))


def test_finer_size_gives_more_panels_and_the_same_closed_boundary():
    hull = shapes.hemisphere(1.0)
    counts = [len(inner_mesh(hull, size=s).part) for s in (0.5, 0.3, 0.2)]
    assert counts == sorted(counts)
    assert counts[-1] > 3 * counts[0]
    fine = inspect_inner(inner_mesh(hull, size=0.2, rows=6, depth=5, control_radius=3.0))
    assert fine.volume == pytest.approx(2.0 / 3.0 * np.pi * 26.0, rel=1e-9)


def test_symmetry_is_found_and_used():
    whole = shapes.box(4.0, 1.0, 0.5).full()
    assert inner_mesh(whole).symmetry == "xz+yz"
    assert inner_mesh(whole.translated((1.0, 0.0, 0.0))).symmetry == "xz"


def test_boundary_scales_with_the_hull():
    a, b = inner_mesh(shapes.box(4.0, 1.0, 0.5)), inner_mesh(shapes.box(4.0, 1.0, 0.5).scaled(25.0))
    np.testing.assert_allclose(b.points, 25.0 * a.points, atol=1e-6)


def test_jittered_boundary_still_closes(jittered):
    mesh = inner_mesh(shapes.hemisphere(1.0), size=0.25)
    moved = jittered(mesh, 0.4)
    report = inspect_inner(moved)
    assert np.abs(moved.points - mesh.points).max() > 0.01
    assert report.closure < 1e-7
    assert report.jacobian > 0.0
    assert report.volume == pytest.approx(2.0 / 3.0 * np.pi * 7.0, rel=1e-5)


def test_columns_fan_out_from_a_sharp_bow_only():
    """The angle ahead of a bow of 13.5 deg, 166 deg, is divided into three."""
    for hull, fans in ((shapes.wigley(kind="III"), 2), (shapes.box(4.0, 1.0, 0.5), 0)):
        mesh = inner_mesh(hull)
        water = mesh.points[mesh.part == FREE]
        points = np.ptp(water[:, 0], axis=1).max(axis=1) == 0.0
        assert points.sum() == fans
        directions = [np.arctan2(*(p[-1, k] - p[0, k])[1::-1]) for p in water[points] for k in (0, -1)]
        assert not fans or np.diff(sorted(directions)).max() < np.deg2rad(60.0)


@pytest.mark.parametrize("azimuths", [[0, 20, 50, 90], [0, 10, 30, 55, 85, 120, 150, 180], [0, 30, 60, 90, 130, 150, 180]])
def test_uneven_control_surface_is_half_a_ball(azimuths):
    panels = control_panels(np.deg2rad(azimuths), depth=3, q=8)
    g, w = np.polynomial.legendre.leggauss(10)
    x, n = positions_and_normals(panels, g, g)
    volume = np.einsum("a,b,nabk,nabk->", w, w, x, n) / 3.0
    assert volume == pytest.approx(2.0 / 3.0 * np.pi * azimuths[-1] / 360.0, rel=1e-6)


def test_divisions_are_power_two_where_asked():
    np.testing.assert_allclose(divisions(5, start=0.0, end=2.0), (np.arange(6) / 5.0) ** 2, atol=1e-15)
    np.testing.assert_allclose(divisions(5), np.arange(6) / 5.0, atol=1e-15)
    steep = np.diff(divisions(40, start=0.0, end=0.0))
    assert steep[0] == pytest.approx(steep[-1])
    assert steep[0] == pytest.approx(3.0 / 40**2, rel=0.03)


def test_control_radius_too_small_names_one_that_works():
    hull = shapes.hemisphere(5.0)
    with pytest.raises(InputError, match=r"at least 5\.25 m"):
        inner_mesh(hull, control_radius=5.1)
    assert inner_mesh(hull, control_radius=5.2501).radius == 5.2501


@pytest.mark.parametrize("options", [{"size": -1.0}, {"rows": 0}, {"depth": 2.5}, {"control_radius": np.nan}])
def test_bad_options_are_named(options):
    with pytest.raises(InputError, match=next(iter(options))):
        inner_mesh(shapes.hemisphere(5.0), **options)


def test_submerged_hull_has_no_waterline():
    with pytest.raises(InputError, match="waterline"):
        inner_mesh(shapes.hemisphere(5.0).translated((0.0, 0.0, -1.0)))


def test_two_hulls_have_two_waterlines():
    one = shapes.box(2.0, 1.0, 0.5)
    from dataclasses import replace

    from ogilvie.mesh.smooth import SmoothSurface

    a, b = (one.translated((d, 0.0, 0.0)) for d in (-3.0, 3.0))
    two = PanelMesh(np.vstack([a.vertices, b.vertices]), np.vstack([a.faces, b.faces + len(a.vertices)]), symmetry="xz")
    with pytest.raises(InputError, match="several"):
        inner_mesh(replace(two, surface=SmoothSurface(a.surface.patches + b.surface.patches)))
