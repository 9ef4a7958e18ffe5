"""PanelMesh: exact integrals, symmetry, transformations, convergence."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ogilvie.errors import InputError
from ogilvie.frames import rotation_matrix
from ogilvie.mesh.panels import PanelMesh

SYMMETRIES = ["none", "xz", "xz+yz"]
ANGLES = st.floats(-3.0, 3.0)
LENGTHS = st.floats(-20.0, 20.0)


@pytest.mark.parametrize("symmetry", SYMMETRIES)
def test_box_is_exact(box, symmetry):
    hull = box(8.0, 4.0, -2.0, 0.0, symmetry=symmetry, deck=False)
    assert hull.volumes == pytest.approx([64.0] * 3, rel=1e-14)
    assert hull.volume == pytest.approx(64.0, rel=1e-14)
    assert hull.center_of_buoyancy == pytest.approx([0.0, 0.0, -1.0], abs=1e-14)
    assert hull.wetted_area == pytest.approx(8 * 4 + 2 * 2 * (8 + 4), rel=1e-14)
    assert hull.bounds.tolist() == [[-4.0, -2.0, -2.0], [4.0, 2.0, 0.0]]
    assert (hull.length, hull.beam, hull.draught) == (8.0, 4.0, 2.0)


def test_normals_areas_centers(box):
    hull = box(8.0, 4.0, -2.0, 1.0)
    assert np.linalg.norm(hull.normals, axis=1) == pytest.approx(1.0)
    outward = np.einsum("fi,fi->f", hull.normals, hull.centers - [0.0, 0.0, -0.5])
    assert (outward > 0).all()
    assert hull.areas.sum() == pytest.approx(2 * (8 * 4 + 8 * 3 + 4 * 3))
    assert hull.area_vectors == pytest.approx(hull.normals * hull.areas[:, None])


def test_centroid_of_a_trapezium():
    trapezium = PanelMesh([[0.0, 0, 0], [4, 0, 0], [2, 3, 0], [0, 3, 0]], [[0, 1, 2, 3]])
    # parallel sides 4 and 2, height 3: y = h (a + 2 b) / (3 (a + b)), x = (a^2 + a b + b^2) / (3 (a + b))
    assert trapezium.centers[0] == pytest.approx([28 / 18, 3 * 8 / 18, 0.0])
    assert trapezium.areas[0] == pytest.approx(9.0)


def test_triangles_in_any_writing():
    v = [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    mesh = PanelMesh(v, [[0, 1, 2, 2], [0, 0, 1, 2], [2, 0, 1, 2], [0, 1, 2, 3]])
    assert mesh.is_triangle.tolist() == [True, True, True, False]
    assert mesh.areas == pytest.approx([0.5, 0.5, 0.5, 1.0])
    assert mesh.centers[:3] == pytest.approx(np.tile([2 / 3, 1 / 3, 0.0], (3, 1)))
    assert mesh.flipped().normals == pytest.approx(-mesh.normals)


def test_panel_without_area_has_a_centre_and_no_normal():
    mesh = PanelMesh([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2, 2]])
    assert mesh.areas[0] == 0.0
    assert mesh.normals[0].tolist() == [0.0, 0.0, 0.0]
    assert np.isfinite(mesh.centers).all()


@given(st.integers(0, 10**6))
@settings(max_examples=30, deadline=None)
def test_divergence_theorem_holds_with_warped_panels(blob, seed):
    hull = blob(seed)
    M0, M1, M2 = hull.moments
    V = hull.volume
    assert np.abs(M0).max() < 1e-12 * hull.wetted_area
    assert np.abs(M1 - V * np.eye(3)).max() < 1e-12 * V
    centroid = np.array([M2[0, 0, 0] / 2, M2[0, 0, 1], M2[0, 0, 2]]) / V  # by n_x
    assert centroid == pytest.approx(hull.center_of_buoyancy, abs=1e-12)
    by_ny = np.array([M2[1, 0, 1], M2[1, 1, 1] / 2, M2[1, 1, 2]]) / V
    assert by_ny == pytest.approx(hull.center_of_buoyancy, abs=1e-12)


@given(st.integers(0, 10**6), ANGLES, ANGLES, ANGLES, st.tuples(LENGTHS, LENGTHS, LENGTHS), st.floats(0.1, 10.0))
@settings(max_examples=30, deadline=None)
def test_volume_and_centroid_move_with_the_body(blob, seed, phi, theta, psi, offset, factor):
    hull = blob(seed)
    moved = hull.scaled(factor).rotated(phi, theta, psi, about=(1.0, 2.0, 3.0)).translated(offset)
    R = rotation_matrix(phi, theta, psi)
    expected = R @ (factor * hull.center_of_buoyancy - [1, 2, 3]) + [1, 2, 3] + offset
    assert moved.volume == pytest.approx(factor**3 * hull.volume, rel=1e-9)
    assert moved.wetted_area == pytest.approx(factor**2 * hull.wetted_area, rel=1e-12)
    assert moved.center_of_buoyancy == pytest.approx(expected, abs=1e-8 * (1 + factor**2))
    assert moved.normals == pytest.approx(hull.normals @ R.T, abs=1e-12)


@pytest.mark.parametrize("plane", ["xz", "yz"])
def test_mirrored(blob, plane):
    hull = blob(5)
    image = hull.mirrored(plane)
    sign = np.array([1.0, -1.0, 1.0]) if plane == "xz" else np.array([-1.0, 1.0, 1.0])
    assert image.volume == pytest.approx(hull.volume, rel=1e-12)
    assert image.center_of_buoyancy == pytest.approx(sign * hull.center_of_buoyancy)
    assert image.normals == pytest.approx(sign * hull.normals)
    assert image.mirrored(plane).vertices == pytest.approx(hull.vertices)


def test_mirrored_at_its_own_plane_is_itself(box):
    half = box(symmetry="xz")
    assert half.mirrored("xz") is half


def test_flipped_turns_the_volume(blob):
    hull = blob(1)
    assert hull.flipped().volumes == pytest.approx(-hull.volumes)
    assert hull.flipped().flipped().volumes == pytest.approx(hull.volumes)


# ---- symmetry


@pytest.mark.parametrize("symmetry", SYMMETRIES)
def test_full_hull_has_the_same_moments(box, symmetry):
    part = box(8.0, 4.0, -2.0, 0.0, symmetry=symmetry, deck=False)
    whole = part.full()
    assert whole.symmetry == "none"
    assert whole.n_faces == part.n_faces * {"none": 1, "xz": 2, "xz+yz": 4}[symmetry]
    for of_part, of_whole in zip(part.moments, whole.moments, strict=True):
        assert of_whole == pytest.approx(of_part, abs=1e-12)
    assert whole.bounds.tolist() == part.bounds.tolist()
    assert whole.wetted_area == pytest.approx(part.wetted_area)
    assert len(whole.vertices) == len(np.unique(whole.vertices.round(9), axis=0))  # shared in the planes


@pytest.mark.parametrize("stored", SYMMETRIES)
@pytest.mark.parametrize("wanted", SYMMETRIES)
def test_with_symmetry(box, stored, wanted):
    hull = box(symmetry=stored, n=4)
    other = hull.with_symmetry(wanted)
    assert other.symmetry == wanted
    assert other.volumes == pytest.approx(hull.volumes)
    assert other.full().n_faces == hull.full().n_faces
    assert all(other.vertices[:, 1 if plane == "xz" else 0].min() >= 0 for plane in other.planes)


def test_with_symmetry_refuses_what_is_not_symmetric(box):
    with pytest.raises(InputError, match="cross it"):
        box(n=3).with_symmetry("xz")
    lopsided = box(n=4).vertices.copy()
    lopsided[:, 2] += np.where(lopsided[:, 1] < -0.5, 0.01 * lopsided[:, 0], 0.0)
    with pytest.raises(InputError, match="mirror images"):
        PanelMesh(lopsided, box(n=4).faces).with_symmetry("xz")
    with pytest.raises(InputError, match="'xz\\+yz' expected"):
        box().with_symmetry("yz")


@pytest.mark.parametrize(
    ("move", "left"),
    [
        (lambda m: m.translated((0, 0, 1)), "xz+yz"),
        (lambda m: m.translated((1, 0, 0)), "xz"),
        (lambda m: m.translated((0, 1, 0)), "none"),
        (lambda m: m.rotated(0.1), "none"),
        (lambda m: m.rotated(theta=0.1), "xz"),
        (lambda m: m.rotated(psi=0.1), "none"),
        (lambda m: m.rotated(theta=0.1, about=(3.0, 0.0, 1.0)), "xz"),
        (lambda m: m.scaled(2.0), "xz+yz"),
        (lambda m: m.flipped(), "xz+yz"),
        (lambda m: m.immersed(), "xz+yz"),
    ],
)
def test_operations_keep_the_symmetry_they_can(box, move, left):
    quarter = box(symmetry="xz+yz")
    moved, reference = move(quarter), move(quarter.full())
    assert moved.symmetry == left
    for a, b in zip(moved.moments, reference.moments, strict=True):
        assert a == pytest.approx(b, abs=1e-11)


# ---- lid


def test_lid_moves_with_the_hull_and_leaves_with_the_waterline(box):
    lid = PanelMesh([[-4.0, -2, 0], [4, -2, 0], [4, 2, 0], [-4, 2, 0]], [[0, 1, 2, 3]])
    hull = box().with_lid(lid)
    assert hull.lid is lid
    assert hull.volume == pytest.approx(96.0)  # the lid is no part of the hull
    assert hull.immersed().lid is lid
    assert hull.immersed(draught=2.0).lid.n_faces == 1
    assert hull.immersed(draught=1.0).lid is None
    assert hull.translated((1.0, 0.0, 0.0)).lid.bounds[0, 0] == -3.0
    assert hull.with_lid(None).lid is None


def test_lid_must_fit(box):
    lid = PanelMesh([[-4.0, -2, 0], [4, -2, 0], [4, 2, 0], [-4, 2, 0]], [[0, 1, 2, 3]])
    with pytest.raises(InputError, match="z = 0"):
        box().with_lid(lid.translated((0, 0, 0.1)))
    with pytest.raises(InputError, match="with_symmetry"):
        box(symmetry="xz").with_lid(lid)


# ---- convergence


def test_sphere_converges_with_second_order(sphere):
    n = np.array([8, 16, 32])
    meshes = [sphere(k) for k in n]
    volume = np.array([4 / 3 * np.pi - m.volume for m in meshes])
    area = np.array([4 * np.pi - m.wetted_area for m in meshes])
    for error in (volume, area):
        assert (error > 0).all()  # inscribed
        assert np.log2(error[:-1] / error[1:]) == pytest.approx(2.0, abs=0.1)


# ---- bad input


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"vertices": [[0.0, 0.0]]}, r"\(n, 3\)"),
        ({"vertices": [[0.0, 0, 0], [1, 0, 0], [np.nan, 1, 0]]}, "NaN"),
        ({"faces": [[0, 1, 2]]}, r"\(n, 4\)"),
        ({"faces": [[0, 1, 2, 9]]}, r"0\.\.2 expected"),
        ({"faces": [[0, 1, 2, -1]]}, r"0\.\.2 expected"),
        ({"symmetry": "yz"}, "symmetry"),
    ],
)
def test_bad_fields(change, message):
    good = {"vertices": [[0.0, 0, 0], [1, 0, 0], [0, 1, 0]], "faces": [[0, 1, 2, 2]]}
    PanelMesh(**good)
    with pytest.raises(InputError, match=message):
        PanelMesh(**(good | change))


@pytest.mark.parametrize(
    "call",
    [
        lambda m: m.translated((0.0, 0.0)),
        lambda m: m.rotated(0.1, about=(0.0, 0.0)),
        lambda m: m.scaled(-1.0),
        lambda m: m.scaled(float("nan")),
        lambda m: m.mirrored("xy"),
        lambda m: m.immersed(draught=-1.0),
        lambda m: m.immersed(draught=float("inf")),
        lambda m: m.translated((0, 0, 100.0)).immersed(),
    ],
)
def test_bad_arguments(box, call):
    with pytest.raises(InputError, match="expected"):
        call(box())


def test_a_surface_without_volume_has_no_centre():
    with pytest.raises(InputError, match="no volume"):
        _ = PanelMesh([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2, 2]]).center_of_buoyancy


def test_arrays_are_read_only(box):
    hull = box()
    for array in (hull.vertices, hull.faces, hull.centers, hull.normals, hull.areas, hull.bounds, hull.center_of_buoyancy):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_an_open_hull_is_not_sunk_but_a_closed_one_is():
    corners = [[x, y, z] for z in (-1.0, 0.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)]
    faces = [[0, 2, 3, 1], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6], [4, 5, 7, 6]]
    barge, block = PanelMesh(corners, faces[:5]), PanelMesh(np.array(corners) + [0, 0, -1], faces)
    assert barge.immersed(1.0).volume == pytest.approx(4.0)
    with pytest.raises(InputError, match="at most 1 m, the height of"):
        barge.immersed(1.1)
    assert block.immersed(3.0).volume == pytest.approx(4.0)
