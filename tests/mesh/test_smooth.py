"""Smooth surfaces kept with panel meshes: same hull, same moves."""

import numpy as np
import pytest

from ogilvie.errors import InputError
from ogilvie.mesh import shapes
from ogilvie.mesh.chebyshev import chebyshev_points, differentiation, interpolation
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.smooth import SmoothSurface

ALL = {
    "hemisphere": lambda n: shapes.hemisphere(5.0, panels=n),
    "box": lambda n: shapes.box(100.0, 20.0, 5.0, panels=n),
    "cylinder": lambda n: shapes.cylinder(10.0, 10.0, panels=n),
    **{f"wigley {k}": (lambda n, k=k: shapes.wigley(kind=k, panels=n)) for k in ("I", "II", "III", "IV", "parabolic")},
}


def farthest_vertex(mesh) -> float:
    """Greatest distance of a vertex from the surface (Newton on the nearest of many points), m."""
    from scipy.optimize import minimize
    from scipy.spatial import cKDTree

    fine, s = np.linspace(-1.0, 1.0, 41), mesh.surface
    samples = [s.at(i, fine, fine).reshape(-1, 3) for i in range(len(s.patches))]
    index = cKDTree(np.concatenate(samples)).query(mesh.vertices)[1]
    worst = 0.0
    for p, k in zip(mesh.vertices, index, strict=True):
        patch, rest = divmod(int(k), 41 * 41)
        start = fine[[rest // 41, rest % 41]]
        miss = lambda c, patch=patch, p=p: float(((s.at(patch, c[:1], c[1:])[0, 0] - p) ** 2).sum())  # noqa: E731
        found = minimize(miss, start, bounds=[(-1, 1)] * 2, tol=1e-16)
        worst = max(worst, float(np.sqrt(min(found.fun, miss(start)))))
    return worst


@pytest.mark.parametrize("name", ALL)
def test_volume_of_the_surface_is_that_of_the_mesh(name):
    mesh = ALL[name](400)
    assert 4.0 * mesh.surface.volume == pytest.approx(mesh.volume, rel=1e-12)
    np.testing.assert_allclose(mesh.surface.bounds[0], [0.0, 0.0, -mesh.draught], atol=1e-2 * mesh.draught)


@pytest.mark.parametrize("name", ["hemisphere", "box", "cylinder", "wigley I"])
def test_vertices_come_to_lie_on_the_surface(name):
    """Meshes that keep the volume have vertices off the surface by O(h^2), those of the box by nothing."""
    coarse, fine = (farthest_vertex(ALL[name](n)) for n in (60, 240))
    size = ALL[name](60).beam
    assert coarse < 0.07 * size
    assert fine < 1e-6 * size or fine < 0.4 * coarse


def test_surface_follows_every_move_of_the_hull():
    mesh = shapes.wigley(kind="I", panels=200)
    moved = mesh.translated((3.0, 0.0, 0.0)).scaled(2.0)
    assert moved.surface.bounds[1, 0] == pytest.approx(9.0)
    assert moved.symmetry == "xz"
    assert 2.0 * moved.surface.volume == pytest.approx(moved.volume, rel=1e-12)
    whole = moved.translated((0.0, 1.0, 0.0)).mirrored("xz").rotated(psi=0.3).named("turned")
    assert whole.surface.volume == pytest.approx(8.0 * mesh.volume, rel=1e-12)
    assert moved.full().with_symmetry("xz").surface.volume == pytest.approx(moved.surface.volume, rel=1e-12)
    assert mesh.with_lid(shapes.waterplane_lid(mesh)).surface is mesh.surface


def test_corners_on_the_surface_of_lofts_follow_every_move():
    mesh = shapes.from_particulars(length=100.0, beam=15.0, draught=5.0, cb=0.6, panels=400, above_water=True)
    assert mesh.bounds[1, 2] > 1.0
    wet = mesh.immersed()
    assert wet.surface is mesh.surface  # cut where the surface ends
    assert mesh.immersed(draught=4.0).surface is None
    assert mesh.surface.bounds[1, 2] == pytest.approx(0.0, abs=1e-9)
    off = np.abs(wet.surface.bounds - [[wet.bounds[0, 0], 0.0, -5.0], [wet.bounds[1, 0], 7.5, 0.0]])
    assert off.max() < 0.02
    moved = wet.translated((3.0, 1.0, 0.0)).scaled(2.0)
    assert moved.symmetry == "none"
    assert len(moved.surface.faces) == 2 * len(wet.surface.faces)
    np.testing.assert_allclose(moved.surface.bounds[1], 2.0 * (wet.surface.bounds[1] + [3.0, 1.0, 0.0]))
    assert len(wet.full().with_symmetry("xz").surface.faces) == len(wet.surface.faces)
    assert moved.surface.half("xz") is None
    image = moved.mirrored("xz").surface
    np.testing.assert_allclose(image.vertices, moved.surface.vertices * [1.0, -1.0, 1.0])
    assert image.faces[0].tolist() != moved.surface.faces[0].tolist()


def test_lofted_corners_enclose_less_than_the_panels_that_keep_the_volume():
    mesh = shapes.s175(panels=600)
    corners = PanelMesh(mesh.surface.vertices, mesh.surface.faces, symmetry="xz")
    fine = shapes.s175(panels=2400)
    assert corners.volume < mesh.volume
    assert PanelMesh(fine.surface.vertices, fine.surface.faces, symmetry="xz").volume > corners.volume
    np.testing.assert_allclose(corners.volume, mesh.volume, rtol=0.01)


def test_surface_is_left_out_where_the_hull_is_cut_or_turned_over():
    mesh = shapes.box(10.0, 4.0, 2.0, panels=100)
    assert mesh.immersed().surface is mesh.surface
    assert mesh.immersed(draught=2.0).surface is not None
    assert mesh.immersed(draught=1.0).surface is None
    assert mesh.flipped().surface is None
    moved = mesh.full().translated((0.0, 1.0, 0.0)).surface
    assert moved.half("xz") is None
    assert moved.half("yz") is not None


def test_patch_across_a_plane_has_no_half():
    u, v = np.meshgrid([-1.0, 1.0], [-1.0, 1.0], indexing="ij")
    assert SmoothSurface((np.stack([v, u, -1.0 + 0.0 * u], axis=-1),)).half("xz") is None


@pytest.mark.parametrize("patches", [(), (np.zeros((1, 2, 3)),), (np.full((2, 2, 3), np.nan),), (np.zeros((2, 2, 2)),)])
def test_bad_patches_are_refused(patches):
    with pytest.raises(InputError, match="patches"):
        SmoothSurface(patches)


def test_interpolation_and_derivative_are_exact_for_polynomials():
    x, at = chebyshev_points(7), np.r_[np.linspace(-1.0, 1.0, 11), chebyshev_points(7)]
    p = np.polynomial.Polynomial([0.3, -1.0, 2.0, 0.5, -0.7, 0.2, 1.1])
    np.testing.assert_allclose(interpolation(7, at) @ p(x), p(at), atol=1e-13)
    np.testing.assert_allclose(differentiation(7) @ p(x), p.deriv()(x), atol=1e-12)
