"""Lids fill the waterplane, whatever its outline."""

import numpy as np
import pytest

from ogilvie.errors import InputError
from ogilvie.mesh import shapes
from ogilvie.mesh.files import load_mesh
from ogilvie.mesh.hydrostatics import hydrostatics
from ogilvie.mesh.inspect import check_mesh
from ogilvie.mesh.lid import waterplane_lid
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.patches import oriented, panel_mesh
from ogilvie.mesh.topology import edges

WHOLE = {"none": 1, "xz": 2, "xz+yz": 4}


def lid_area(lid):
    return -WHOLE[lid.symmetry] * lid.area_vectors[:, 2].sum()


def tube(radius, draught, *, center=(0.0, 0.0), inward=False, n=24, sweep=2.0 * np.pi):
    """Side of a vertical cylinder (n panels around), normals out of the water body or into it."""
    a, z = np.linspace(0.0, sweep, n + 1), np.linspace(-draught, 0.0, 4)
    A, Z = np.meshgrid(a, z, indexing="ij")
    grid = np.stack([center[0] + radius * np.cos(A), center[1] + radius * np.sin(A), Z], axis=-1)
    return grid.swapaxes(0, 1) if inward else grid


def annulus(inner, outer, z, *, n=24, sweep=2.0 * np.pi):
    a, r = np.linspace(0.0, sweep, n + 1), np.linspace(inner, outer, 4)
    A, R = np.meshgrid(a, r, indexing="ij")
    return oriented(np.stack([R * np.cos(A), R * np.sin(A), 0.0 * A + z], axis=-1), (0, 0, -1))


@pytest.mark.parametrize(
    "mesh",
    [
        shapes.hemisphere(5.0, panels=600),
        shapes.box(100.0, 20.0, 5.0, panels=600),
        shapes.cylinder(1.0, 2.0, panels=400),
        shapes.wigley(kind="II"),
        shapes.s175(panels=800),
        shapes.hemisphere(5.0, panels=600).with_symmetry("xz"),
        shapes.box(100.0, 20.0, 5.0, panels=600).full(),
    ],
    ids=lambda m: f"{m.name} {m.symmetry}",
)
def test_fills_the_waterplane_from_inside(mesh):
    lid = waterplane_lid(mesh)
    assert lid.symmetry == mesh.symmetry
    assert np.all(lid.vertices[:, 2] == 0.0)
    np.testing.assert_array_equal(lid.normals, np.tile([0.0, 0.0, -1.0], (lid.n_faces, 1)))
    assert lid_area(lid) == pytest.approx(hydrostatics(mesh).waterplane_area, rel=2e-4)
    assert lid.areas.sum() == pytest.approx(-lid.area_vectors[:, 2].sum(), rel=1e-12)  # no panel turned over
    assert check_mesh(mesh.with_lid(lid)).findings == ()
    start, end, _ = edges(lid.faces)
    assert len(set(zip(start.tolist(), end.tolist(), strict=True))) == len(start)  # no edge twice in one direction: no overlap


def test_panels_have_the_size_asked_for_and_are_mostly_quadrilaterals():
    hull = shapes.box(100.0, 20.0, 5.0, panels=600)
    for size in (1.0, 2.5):
        lid = waterplane_lid(hull, size=size)
        assert np.sqrt(np.median(lid.areas)) == pytest.approx(size, rel=0.25)
        assert lid.is_triangle.mean() < 0.15


def test_several_columns_off_the_planes_of_symmetry():
    legs = [tube(4.0, 10.0, center=(x, 20.0)) for x in (-25.0, 25.0)]
    mesh = panel_mesh([oriented(g, (0, 0, 0)) for g in legs], symmetry="xz", name="columns")
    polygon = 24.0 / 2.0 * 16.0 * np.sin(2.0 * np.pi / 24.0)
    for hull in (mesh, mesh.full()):
        lid = waterplane_lid(hull)
        assert lid_area(lid) == pytest.approx(4 * polygon, rel=1e-9)
        c = np.abs(lid.centers[:, :2])
        assert np.hypot(c[:, 0] - 25.0, c[:, 1] - 20.0).max() < 4.0


@pytest.mark.parametrize(("symmetry", "sweep"), [("none", 2.0 * np.pi), ("xz", np.pi), ("xz+yz", 0.5 * np.pi)])
def test_moonpool_stays_open(symmetry, sweep):
    n = round(24 * sweep / (2.0 * np.pi))
    sheets = [
        tube(10.0, 5.0, n=n, sweep=sweep),
        tube(4.0, 5.0, inward=True, n=n, sweep=sweep),
        annulus(4.0, 10.0, -5.0, n=n, sweep=sweep),
    ]
    mesh = panel_mesh(sheets, symmetry=symmetry, name="ring")
    assert check_mesh(mesh).findings == ()
    lid = waterplane_lid(mesh, size=1.5)
    assert lid_area(lid) == pytest.approx(12.0 * np.sin(2.0 * np.pi / 24.0) * (100.0 - 16.0), rel=1e-9)
    r = np.hypot(*lid.centers[:, :2].T)
    assert r.min() > 4.0 * np.cos(np.pi / 24.0)
    assert r.max() < 10.0


def test_long_waterline_edges_are_divided_and_short_ones_joined():
    coarse = shapes.box(100.0, 20.0, 5.0, panels=60, grading=0.0)
    assert waterplane_lid(coarse, size=2.0).n_faces > 80
    fine = shapes.cylinder(10.0, 5.0, panels=3000)
    lid = waterplane_lid(fine, size=4.0)
    assert lid.n_faces < 25
    assert lid_area(lid) == pytest.approx(100.0 * np.pi, rel=5e-3)


def test_hull_under_water_is_refused():
    with pytest.raises(InputError, match="no open edge"):
        waterplane_lid(shapes.box(10.0, 4.0, 2.0, panels=60).translated((0.0, 0.0, -1.0)))


def test_hull_with_a_hole_at_the_waterline_is_refused():
    box = shapes.box(10.0, 4.0, 2.0, panels=200).full()
    top = np.flatnonzero(np.abs(box.centers[:, 2]) < 0.3)
    faces = np.delete(box.faces, top[3], axis=0)
    with pytest.raises(InputError, match="gap"):
        waterplane_lid(PanelMesh(box.vertices, faces))


def test_size_must_be_positive():
    with pytest.raises(InputError, match="positive"):
        waterplane_lid(shapes.box(10.0, 4.0, 2.0, panels=60), size=0.0)


@pytest.mark.parametrize(
    "path",
    [
        "mss_wamit_fpso/fpso_low.gdf",
        "mss_wamit_tanker/tanker.gdf",
        "kvlcc2_hull/kvlcc2_fine.gdf",
        "dtmb5415_hull/dtmb5415_maorg.gdf",
        "wecsim_cylinder/cyl.gdf",
    ],
)
def test_meshes_of_other_codes(path, shared_data):
    mesh = load_mesh(shared_data / path)
    assert lid_area(waterplane_lid(mesh)) == pytest.approx(hydrostatics(mesh).waterplane_area, rel=5e-3)
