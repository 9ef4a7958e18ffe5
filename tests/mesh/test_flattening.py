"""Half hulls spread out on a square, and smooth sheets through their vertices."""

import numpy as np
import pytest

from ogilvie.errors import InputError
from ogilvie.mesh import shapes
from ogilvie.mesh.conforming import conforming
from ogilvie.mesh.fitting import fitted
from ogilvie.mesh.flat_ends import flat_end
from ogilvie.mesh.flattening import _harmonic, flattened
from ogilvie.mesh.panels import PanelMesh

SHIPS = {
    "wigley": lambda: shapes.wigley(kind="I", panels=1200).with_symmetry("xz"),
    "hemisphere": lambda: shapes.hemisphere(5.0, panels=1200).with_symmetry("xz"),
    "s175": lambda: shapes.s175(panels=1200),
    "barge": lambda: shapes.from_particulars(length=100.0, beam=25.0, draught=5.0, cb=0.93, panels=900),
    "fine": lambda: shapes.from_particulars(length=100.0, beam=15.0, draught=5.0, cb=0.55, panels=900),
}


@pytest.fixture(scope="module", params=SHIPS)
def flat(request):
    return flattened(SHIPS[request.param]())


def test_map_is_one_to_one_and_fills_the_square(flat):
    p = flat.uv[flat.triangles]
    d, e = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    area = 0.5 * (d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0])
    assert area.max() < 0.0  # all turned the same way: x forward, seen from port
    assert area.sum() == pytest.approx(-1.0, rel=1e-9)


def test_borders_are_keel_profiles_and_waterline(flat):
    x, y, z = flat.vertices.T
    assert np.all(z[flat.side == 3] == 0.0)
    assert np.all(y[flat.side == 2] == 0.0)
    for k, is_flat in enumerate(flat.flat_ends):
        assert is_flat or np.all(y[flat.side == k] == 0.0)
    assert np.all(np.diff(x[flat.side == 3][np.argsort(flat.uv[flat.side == 3, 0])]) > -1e-9)


def test_mean_values_reproduce_linear_functions_of_a_plane_sheet():
    """Floater (2003), Proposition 1: inner places are exact where border places are a linear function of a plane sheet."""
    rng = np.random.default_rng(3)
    n, m = 9, 7
    i = np.arange(n * m).reshape(n, m)
    place = np.stack(np.meshgrid(np.linspace(0.0, 1.0, n), np.linspace(0.0, 1.0, m), indexing="ij"), axis=-1)
    place[1:-1, 1:-1] += rng.uniform(-0.03, 0.03, (n - 2, m - 2, 2))
    uv = place.reshape(-1, 2)
    plane = uv @ np.array([[4.0, 1.0, 0.3], [0.5, -2.0, 1.0]])
    tri = np.concatenate(
        [
            np.stack(t, axis=-1).reshape(-1, 3)
            for t in ((i[:-1, :-1], i[1:, :-1], i[1:, 1:]), (i[:-1, :-1], i[1:, 1:], i[:-1, 1:]))
        ]
    )
    inner = i[1:-1, 1:-1].ravel()
    known = uv.copy()
    known[inner] = 0.0
    np.testing.assert_allclose(_harmonic(plane, tri, known, inner), uv[inner], atol=1e-12)


def test_hanging_vertices_become_corners():
    v = np.array([[0, 1, -1], [2, 1, -1], [2, 1, 0], [0, 1, 0], [1, 0, -1], [0, 0, -1], [2, 0, -1], [1, 1, -1.0]])
    mesh = PanelMesh(v, [[0, 1, 2, 3], [7, 0, 5, 4], [1, 7, 4, 6]], symmetry="xz")
    vertices, tri = conforming(mesh, 1e-9)
    edges = {tuple(e) for t in tri.tolist() for e in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))}
    free = [e for e in edges if e[::-1] not in edges]
    assert all(
        np.ptp(vertices[list(e), k]) == 0.0 and abs(vertices[e[0], k] - c) < 1e-12
        for e in free
        for k, c in [next((k, c) for k, c in ((1, 0.0), (2, 0.0), (0, 0.0), (0, 2.0)) if np.all(vertices[list(e), k] == c))]
    )
    area = np.linalg.norm(
        np.cross(vertices[tri[:, 1]] - vertices[tri[:, 0]], vertices[tri[:, 2]] - vertices[tri[:, 0]]), axis=1
    )
    assert 0.5 * area.sum() == pytest.approx(4.0)


def test_sheet_comes_to_the_formula_of_the_wigley_hull():
    """Distance in half-breadth from eta(xi, zeta), panels refined: third order or better until the fit is 1e-4 of the beam."""
    found = []
    for panels in (300, 1200):
        sheet = fitted(flattened(shapes.wigley(1.0, 0.1, 0.0625, kind="III", panels=panels, grading=0.0).with_symmetry("xz")))
        x, y, z = sheet.at(np.linspace(0.1, 0.9, 21), np.linspace(0.1, 0.9, 9)).reshape(-1, 3).T
        xi, zeta = 2.0 * x, z / 0.0625
        found.append(float(np.abs(y - 0.05 * (1 - zeta**2) * (1 - xi**2) * (1 + 0.2 * xi**2)).max()))
    assert found[1] < 0.5 * found[0]
    assert found[1] < 0.004 * 0.1


def test_sheet_keeps_keel_and_waterline_in_their_planes(flat):
    sheet = fitted(flat)
    t = np.linspace(0.0, 1.0, 40)
    assert np.all(sheet.at(t, np.array([1.0]))[..., 2] == 0.0)
    assert np.all(sheet.at(t, np.array([0.0]))[..., 1] == 0.0)
    assert sheet.at(t, t)[..., 1].min() >= 0.0


def test_flat_ends_are_found_and_round_or_sharp_ones_are_not():
    barge, sharp = SHIPS["barge"](), SHIPS["wigley"]()
    for mesh, expected in ((barge, True), (sharp, False)):
        v, t = conforming(mesh, 1e-6)
        for end in (-1, 1):
            mask, edge = flat_end(v, t, end=end, near=1e-6)
            assert mask.any() == expected == bool(edge)
            assert not expected or np.allclose(v[t[mask]][..., 0], 50.0 * end)
    assert flattened(barge).flat_ends == (True, True)


def test_half_hulls_with_other_borders_are_refused():
    mesh = shapes.box(10.0, 4.0, 2.0, panels=200).with_symmetry("xz")
    hole = PanelMesh(mesh.vertices, np.delete(mesh.faces, 5, axis=0), symmetry="xz")
    with pytest.raises(InputError, match="border"):
        flattened(hole)
