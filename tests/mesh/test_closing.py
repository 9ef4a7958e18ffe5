"""Closing a hull above the water: decks of strips, raised sides, long triangles split."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.mesh.deck import decked
from ogilvie.mesh.deck_across import decked_across
from ogilvie.mesh.integrals import triangles
from ogilvie.mesh.raise_sides import with_raised_sides
from ogilvie.mesh.split import split_long_edges


@pytest.fixture(scope="module")
def ship():
    return og.shapes.s175(panels=400, above_water=True)


def test_strips_enclose_the_volume_of_the_fan(ship):
    """The upper edge of the S175 is plane: both decks close the same body."""
    one, other = decked_across(ship), decked(ship)
    assert one.volumes == pytest.approx(other.volumes, rel=1e-9)
    assert np.abs(one.area_vectors.sum(axis=0)).max() < 1e-9 * one.areas.sum()
    assert np.ptp(one.volumes) < 1e-9 * one.volume


def test_strips_follow_a_sheer():
    """A box whose upper edge rises to the ends keeps equal volumes along x, y and z, with a deck that follows the edge."""
    box = og.shapes.box(40.0, 10.0, 8.0, panels=400, grading=0.0).translated((0, 0, 5.0))
    v = box.vertices.copy()
    top = v[:, 2] > 4.99
    v[top, 2] += 0.002 * v[top, 0] ** 2
    sheer = og.PanelMesh(v, box.faces, symmetry=box.symmetry)
    closed = decked_across(sheer)
    assert np.ptp(closed.volumes) < 1e-9 * closed.volume
    assert closed.volume > box.volume + 0.5 * 10.0 * 40.0 * 0.002 * 20.0**2 / 3.0


def test_hulls_without_symmetry_get_the_other_deck(ship):
    whole = ship.full()
    assert "xz" not in whole.planes
    assert decked_across(whole).volume == pytest.approx(decked(ship).volume, rel=1e-12)
    assert decked_across(decked(ship)).volume == pytest.approx(decked(ship).volume, rel=1e-12)


def test_strips_are_short(ship):
    closed = decked_across(ship)
    p = closed.vertices[triangles(closed.faces)]
    longest = max(np.linalg.norm(p[:, i] - p[:, (i + 1) % 3], axis=1).max() for i in range(3))
    assert longest < 20.0  # the fan to one point has edges of 87 m


def test_raised_sides_are_vertical(ship):
    high = with_raised_sides(ship, 5.9)
    assert high.bounds[1, 2] == pytest.approx(5.9)
    waterplane = og.hydrostatics(ship.translated((0, 0, -1.5)).immersed()).waterplane_area
    assert decked_across(high).volume - decked_across(ship).volume == pytest.approx(waterplane * 4.4, rel=1e-6)
    assert high.immersed().volume == pytest.approx(ship.immersed().volume, rel=1e-12)


def test_raised_sides_refuse_what_they_cannot_raise(ship):
    with pytest.raises(og.InputError, match="above the open edge"):
        with_raised_sides(ship, 1.0)
    with pytest.raises(og.InputError, match="closed"):
        with_raised_sides(decked(ship), 10.0)


@pytest.mark.parametrize("length", [30.0, 8.0, 3.0])
def test_splitting_keeps_the_surface(ship, length):
    fan = decked(ship)
    vertices, tri = split_long_edges(fan.vertices, triangles(fan.faces), length=length)
    p = vertices[tri]
    assert max(np.linalg.norm(p[:, i] - p[:, (i + 1) % 3], axis=1).max() for i in range(3)) <= length
    S = 0.5 * np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    assert np.einsum("ti,ti->", S, p.mean(axis=1)) / 3.0 == pytest.approx(fan.volume, rel=1e-12)
    c = fan.vertices[triangles(fan.faces)]
    before = 0.5 * np.linalg.norm(np.cross(c[:, 1] - c[:, 0], c[:, 2] - c[:, 0]), axis=1).sum()
    assert np.linalg.norm(S, axis=1).sum() == pytest.approx(before, rel=1e-12)


def test_splitting_leaves_no_vertex_within_an_edge():
    """In a closed surface each edge has one triangle on either side, before and after."""
    closed = decked(og.shapes.box(40.0, 10.0, 8.0, panels=60).translated((0, 0, 5.0)))
    tri = triangles(closed.faces)
    tri = tri[(tri[:, 0] != tri[:, 1]) & (tri[:, 1] != tri[:, 2]) & (tri[:, 2] != tri[:, 0])]
    for length in (50.0, 7.0, 2.0):
        _, split = split_long_edges(closed.vertices, tri, length=length)
        edges = split[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        directed = {(a, b) for a, b in edges.tolist()}
        assert len(directed) == len(edges)
        assert all((b, a) in directed for a, b in directed)
