"""check_mesh finds each fault by its name, heal repairs and lists, require_usable refuses."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ogilvie.errors import InputError
from ogilvie.mesh.inspect import check_mesh, heal, require_usable
from ogilvie.mesh.panels import PanelMesh


def _faults(mesh):
    return {f.what: f.count for f in check_mesh(mesh).findings}


@pytest.mark.parametrize("symmetry", ["none", "xz", "xz+yz"])
def test_a_good_hull_has_no_faults(box, symmetry):
    hull = box(high=0.0, deck=False, symmetry=symmetry)
    report = check_mesh(hull)
    assert report.findings == ()
    assert report.ok
    assert "no faults" in str(report)
    require_usable(hull)


def test_inward_normals_at_any_height(box):
    for hull in (
        box(high=0.0, deck=False),
        box(deck=False).translated((0, 0, 5.0)),
        box(low=0.0, high=3.0, symmetry="xz", deck=False),
    ):
        assert _faults(hull).get("inward normals") is None
        assert _faults(hull.flipped())["inward normals"] == 1


def test_panels_and_hull_above_water(box):
    hull = box(n=3)  # -2 .. 1: the upper row of the sides and the deck
    assert _faults(hull) == {"panels above water": 4 * 3 + 9}
    assert _faults(hull.translated((0, 0, 3.0)))["hull wholly above water"] == 1


def test_panels_turned_over(box):
    hull = box(high=0.0, deck=False)
    faces = hull.faces.copy()
    faces[4] = faces[4][::-1]
    faults = _faults(PanelMesh(hull.vertices, faces))
    assert faults["edges run twice in one direction"] == 4
    assert not check_mesh(PanelMesh(hull.vertices, faces)).ok


def test_a_hole_is_open_edges_and_different_volumes(box):
    hull = box(high=0.0, deck=False)
    faces = np.delete(hull.faces, 4, axis=0)  # middle of the fore side
    holed = PanelMesh(hull.vertices, faces)
    assert _faults(holed)["open edges"] == 4
    assert _faults(holed)["volumes differ"] == 1


def test_t_junctions_are_no_holes():
    # a wall of one panel above two panels of half its width
    v = [[0.0, 0, -2], [1, 0, -2], [2, 0, -2], [0, 0, -1], [1, 0, -1], [2, 0, -1], [0, 0, 0], [2, 0, 0]]
    wall = PanelMesh(v, [[0, 1, 4, 3], [1, 2, 5, 4], [3, 5, 7, 6]])
    faults = _faults(wall)
    assert faults["T-junction edges"] == 3
    assert faults["open edges"] == 6  # the rim: 2 below, 2 x 2 at the ends


def test_staggered_t_junctions_are_no_holes():
    """Three panels above two: the side of the middle one runs along parts of both below, and neither holds it whole."""
    x3, x2 = np.linspace(0.0, 3.0, 4), np.array([0.0, 1.5, 3.0])
    above = [[x, 0.0, z] for z in (-1.0, 0.0) for x in x3]
    below = [[x, 0.0, z] for z in (-2.0, -1.0) for x in x2]
    faces = [[i, i + 1, i + 5, i + 4] for i in range(3)] + [[8 + i, 9 + i, 12 + i, 11 + i] for i in range(2)]
    wall = PanelMesh(above + below, faces)
    faults = _faults(wall)
    assert faults["T-junction edges"] == 5
    assert faults["open edges"] == 2 + 4  # below, and both ends; the waterline may be open
    gap = PanelMesh(above + below, [f for k, f in enumerate(faces) if k != 4])  # half of the row below is missing
    assert (
        _faults(gap)["open edges"] == 1 + 4 + 2
    )  # below, the ends, the last side above and the middle one, half of which is open
    holed = PanelMesh(above + below, [f for k, f in enumerate(faces) if k != 3])
    assert _faults(holed)["open edges"] == _faults(gap)["open edges"]


def test_duplicate_vertices_and_identical_panels(box):
    hull = box(high=0.0, deck=False)
    loose = PanelMesh(hull.vertices[hull.faces].reshape(-1, 3), np.arange(4 * hull.n_faces).reshape(-1, 4))
    assert _faults(loose)["duplicate vertices"] == 4 * hull.n_faces - len(np.unique(hull.faces))
    double = PanelMesh(hull.vertices, np.concatenate([hull.faces, np.roll(hull.faces[:2], 1, axis=1)]))
    assert _faults(double)["identical panels"] == 2
    assert _faults(double)["edges with more than two panels"] >= 1


def test_shape_of_panels():
    v = [
        [0.0, 0, -1],
        [1, 0, -1],
        [1, 1, -1.6],
        [0, 1, -1],
        [100, 0, -1],
        [100, 0.5, -1],
        [0, 0.5, -1],
        [3, 3, -1],
        [4, 4, -1],
        [5, 5, -1],
    ]
    mesh = PanelMesh(v, [[0, 3, 2, 1], [0, 6, 5, 4], [7, 8, 9, 9], [0, 1, 1, 1]])
    faults = _faults(mesh)
    assert faults["warped panels"] == 1
    assert faults["slender panels"] == 1
    assert faults["panels without area"] == 2


def test_panels_about_a_plane_of_symmetry(box):
    whole = box(high=0.0, deck=False, n=4)
    assert _faults(PanelMesh(whole.vertices, whole.faces, symmetry="xz"))["panels beyond y = 0"] == whole.n_faces // 2
    starboard = box(high=0.0, deck=False, symmetry="xz").rotated().full()
    keep = starboard.vertices[starboard.faces, 1].max(axis=1) <= 0
    half = PanelMesh(starboard.vertices, starboard.faces[keep], symmetry="xz")
    assert check_mesh(half).ok  # the other half is as good
    wall = np.array([[0.0, 0, -1], [1, 0, -1], [1, 0, -0.5], [0, 0, -0.5]])
    half = box(high=0.0, deck=False, symmetry="xz")
    n = len(half.vertices)
    inner = PanelMesh(
        np.concatenate([half.vertices, wall]), np.concatenate([half.faces, [[n, n + 1, n + 2, n + 3]]]), symmetry="xz"
    )
    assert _faults(inner)["panels in y = 0"] == 1


def test_lid_faults(box):
    lid = PanelMesh([[-4.0, -2, 0], [4, -2, 0], [4, 2, 0], [-4, 2, 0]], [[0, 1, 2, 3]])
    hull = box(high=0.0, deck=False).with_lid(lid)
    assert check_mesh(hull).ok
    assert _faults(hull.with_lid(lid.scaled(1.1)))["lid larger than the waterplane"] == 1
    assert _faults(hull.translated((0, 0, -1.0)))["lid off z = 0"] == 1


def test_report_is_a_table(box):
    text = str(check_mesh(box().flipped()))
    assert "error         1  inward normals" in text
    assert ".immersed()" in text
    assert check_mesh(box())["inward normals"] == 0


# ---- heal


@given(st.integers(0, 10**6))
@settings(max_examples=15, deadline=None)
def test_heal_restores_a_spoiled_hull(box, seed):
    rng = np.random.default_rng(seed)
    hull = box(high=0.0, deck=False, symmetry="xz")
    corners = hull.vertices[hull.faces] + rng.uniform(-1e-7, 1e-7, (hull.n_faces, 4, 3))  # loose vertices, off the planes
    turned = rng.random(hull.n_faces) < 0.3
    corners[turned] = corners[turned, ::-1]
    corners = np.concatenate([corners, corners[:2], corners[:1, [0, 0, 1, 1]]])  # identical panels, one without area
    spoiled = PanelMesh(corners.reshape(-1, 3), np.arange(4 * len(corners)).reshape(-1, 4), symmetry="xz")
    assert not check_mesh(spoiled).ok
    healed, report = heal(spoiled)
    assert report.after.ok
    assert report.after.findings == ()
    assert healed.n_faces == hull.n_faces
    assert healed.volume == pytest.approx(hull.volume, rel=1e-5)
    done = dict(report.repairs)
    assert done["identical panels removed"] == 2
    assert done["panels without area removed"] == 1
    assert "vertices merged" in str(report)


def test_heal_leaves_a_good_hull_alone(box):
    hull = box(high=0.0, deck=False)
    healed, report = heal(hull)
    assert report.repairs == ()
    assert healed.faces.tolist() == hull.faces.tolist()
    assert "nothing to repair" in str(report)


def test_heal_turns_an_inward_hull(box):
    healed, report = heal(box(high=0.0, deck=False).flipped())
    assert healed.volume > 0
    assert report.repairs[0][0].startswith("hull turned over")
    assert not report.before.ok


def test_heal_does_not_clip_or_close(box):
    hull = box(deck=False)
    healed, report = heal(hull)
    assert healed.n_faces == hull.n_faces
    assert not report.after.ok


def test_heal_needs_a_panel():
    with pytest.raises(InputError, match="no panel with an area"):
        heal(PanelMesh([[0.0, 0, -1], [1, 0, -1], [2, 0, -1]], [[0, 1, 2, 2]]))


# ---- require_usable


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda m: m.flipped(), r"into the body found.*\.flipped\(\)"),
        (lambda m: m.translated((0, 0, 5.0)), r"below z = 0 expected.*\.immersed\(draught\)"),
        (lambda m: m.translated((0, 0, 0.5)), r"\d+ of 'box' reach up to 0.5 m\. Use \.immersed\(\)"),
        (lambda m: PanelMesh(m.vertices, m.faces[-9:], name="plate"), "encloses water"),
    ],
)
def test_unusable_meshes_are_refused(box, spoil, message):
    hull = box(high=0.0, deck=False)
    with pytest.raises(InputError, match=message) as caught:
        require_usable(spoil(hull), purpose="solve_bem")
    assert str(caught.value).startswith("solve_bem: ")
