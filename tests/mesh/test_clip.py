"""Clipping at z = 0: exact volumes, shared waterline, orientation and symmetry kept."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ogilvie.errors import InputError
from ogilvie.mesh.clip import clip_below
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.topology import edges, open_edges

ANGLES = st.floats(-3.0, 3.0)


def _is_closed_below(mesh: PanelMesh) -> bool:
    start, _, _ = open_edges(mesh.vertices, mesh.faces, planes=("xy", *mesh.planes), tolerance=mesh.tolerance)
    return len(start) == 0


@pytest.mark.parametrize("symmetry", ["none", "xz", "xz+yz"])
@pytest.mark.parametrize("draught", [0.3, 1.0, 2.999, 3.0])
def test_box_is_exact_at_any_draught(box, symmetry, draught):
    hull = box(8.0, 4.0, -2.0, 1.0, symmetry=symmetry)
    wet = hull.immersed(draught=draught)
    assert wet.symmetry == symmetry
    assert wet.volumes == pytest.approx([32.0 * draught] * 3, rel=1e-13)
    assert wet.center_of_buoyancy == pytest.approx([0.0, 0.0, -draught / 2], abs=1e-13)
    assert wet.wetted_area == pytest.approx(32.0 + 24.0 * draught, rel=1e-13)
    assert wet.bounds[:, 2] == pytest.approx([-draught, 0.0])
    assert wet.vertices[:, 2].max() == 0.0
    assert _is_closed_below(wet)


def test_deck_at_the_waterline_is_dry(box):
    assert box(low=-2.0, high=0.0).immersed().n_faces == box(low=-2.0, high=0.0, deck=False).n_faces


def test_hull_below_water_stays_as_it_is(blob):
    hull = blob(3).translated((0.0, 0.0, -10.0))
    wet = hull.immersed()
    assert wet.faces.tolist() == hull.faces.tolist()
    assert wet.vertices.tolist() == hull.vertices.tolist()


@given(st.integers(0, 10**6), ANGLES, ANGLES, st.floats(-2.0, 2.0))
@settings(max_examples=40, deadline=None)
def test_lower_and_upper_part_make_the_whole(blob, seed, phi, theta, z):
    hull = blob(seed).rotated(phi, theta).translated((0.0, 0.0, z))
    try:
        below = hull.immersed()
        above = hull.rotated(np.pi).immersed()
    except InputError:  # all on one side
        assert hull.bounds[0, 2] * hull.bounds[1, 2] >= 0.0 or np.abs(hull.bounds[:, 2]).min() < 1e-6
        return
    assert below.volume + above.volume == pytest.approx(hull.volume, rel=1e-11)
    assert below.volumes == pytest.approx([below.volume] * 3, abs=1e-11 * hull.volume)
    assert below.wetted_area + above.wetted_area == pytest.approx(hull.wetted_area, rel=1e-11)
    moment = below.volume * below.center_of_buoyancy + above.volume * above.center_of_buoyancy * [1, -1, -1]
    assert moment == pytest.approx(hull.volume * hull.center_of_buoyancy, abs=1e-9 * hull.volume)
    assert -below.moments[0][2] == pytest.approx(-above.moments[0][2], abs=1e-11 * hull.wetted_area)  # one waterplane
    assert _is_closed_below(below)


@given(st.integers(0, 10**6), ANGLES, ANGLES)
@settings(max_examples=20, deadline=None)
def test_clipping_twice_changes_nothing(blob, seed, phi, theta):
    once = blob(seed).rotated(phi, theta).immersed()
    twice = once.immersed()
    assert twice.n_faces == once.n_faces
    assert twice.volumes == pytest.approx(once.volumes, rel=1e-14)


def test_symmetric_part_clips_like_the_whole(box):
    part = box(symmetry="xz", n=4).rotated(theta=0.11).translated((0.0, 0.0, 0.3))
    assert part.symmetry == "xz"
    a, b = part.immersed(), part.full().immersed()
    for x, y in zip(a.moments, b.moments, strict=True):
        assert x == pytest.approx(y, abs=1e-12)
    assert a.full().n_faces == b.n_faces


def test_new_vertices_are_shared_and_orientation_is_kept(sphere):
    ball = sphere(8, center=(0.0, 0.0, 0.13))
    wet = ball.immersed()
    assert len(np.unique(wet.vertices.round(12), axis=0)) == len(wet.vertices)
    start, end, _ = edges(wet.faces)
    directed = np.stack([start, end], axis=1)
    assert len(np.unique(directed, axis=0)) == len(directed)  # neighbours run their edge in opposite directions
    assert np.einsum("fi,fi->f", wet.normals, wet.centers - [0.0, 0.0, 0.13]).min() > 0
    assert (wet.vertices[:, 2] <= 0.0).all()


def test_a_corner_on_the_plane_needs_no_new_vertex():
    v = np.array([[0.0, 0, -1], [1, 0, 0], [0, 0, 1], [-1, 0, 0]])
    vertices, faces = clip_below(v, np.array([[0, 1, 2, 3]]), tolerance=1e-12)
    assert sorted(vertices.tolist()) == [[-1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]]
    assert faces.shape == (1, 4)
    assert len(set(faces[0].tolist())) == 3


def test_a_cut_off_corner_leaves_a_pentagon():
    v = np.array([[0.0, 0, -2], [2, 0, -2], [2, 0, 1], [0, 0, -1]])
    vertices, faces = clip_below(v, np.array([[0, 1, 2, 3]]), tolerance=1e-12)
    mesh = PanelMesh(vertices, faces)
    assert mesh.n_faces == 2
    assert sorted(mesh.is_triangle.tolist()) == [False, True]
    assert mesh.areas.sum() == pytest.approx(4.0 - 0.5)  # trapezium 2 x (1 + 3) / 2 less the triangle above water


def test_vertices_within_the_tolerance_are_on_the_plane():
    v = np.array([[0.0, 0, -1], [1, 0, -1], [1, 0, 1e-10], [0, 0, -1e-10]])
    vertices, faces = clip_below(v, np.array([[0, 1, 2, 3]]), tolerance=1e-9)
    assert faces.tolist() == [[0, 1, 2, 3]]
    assert vertices[2:, 2].tolist() == [0.0, 0.0]


def test_volume_is_continuous_and_its_slope_is_the_waterplane(blob):
    hull = blob(11)
    for z in np.linspace(-0.8, 0.8, 9):
        h = 1e-5
        deeper, higher = hull.translated((0, 0, z - h)).immersed(), hull.translated((0, 0, z + h)).immersed()
        slope = (deeper.volume - higher.volume) / (2 * h)
        assert slope == pytest.approx(-hull.translated((0, 0, z)).immersed().moments[0][2], rel=1e-6)


def test_spherical_cap_converges(sphere):
    h = 0.7  # height of the wetted cap
    exact = np.pi * h**2 * (1.0 - h / 3)
    error = np.array([exact - sphere(n).immersed(draught=h).volume for n in (8, 16, 32)])
    assert np.log2(error[:-1] / error[1:]) == pytest.approx(2.0, abs=0.5)
    assert abs(error[-1]) < 0.01 * exact
