"""Layer potentials of flat panels against closed forms, quadrature and the identities of potential theory."""

import numpy as np
import pytest

from ogilvie.bem.curved import image_signs
from ogilvie.bem.flat_panels import FlatPanels
from ogilvie.bem.flat_panels_influence import density_signs, rankine, rankine_by_parity
from ogilvie.errors import InputError

SQUARE = FlatPanels([[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]])
RNG = np.random.default_rng(0)


def grid(function, n, m):
    u, v = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, m + 1), indexing="ij")
    p = np.stack(np.broadcast_arrays(*function(u, v)), axis=-1)
    return np.stack([p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]], axis=2).reshape(-1, 4, 3)


def sphere(n, symmetry="none"):
    """Return a sphere of radius 1, normals outwards; triangles at the poles."""
    turn = {"none": 2 * np.pi, "xz": np.pi, "xz+yz": np.pi / 2}[symmetry]
    around = {"none": 4, "xz": 2, "xz+yz": 1}[symmetry] * n

    def point(u, v):
        theta, alpha = np.pi * (1 - u), turn * v
        s = np.where((u == 0) | (u == 1), 0.0, np.sin(theta))
        return s * np.cos(alpha), s * np.sin(alpha), np.cos(theta)

    corners = grid(point, 2 * n, around)[:, ::-1]
    return FlatPanels(corners, symmetry=symmetry)


def warped(n):
    """Return a closed surface of quadrilaterals that are not flat."""
    p = sphere(n).corners
    return FlatPanels(p + 0.15 * np.sin(3 * p[..., [1, 2, 0]]) * [1.0, 0.5, 0.7])


def quadrature(P, corners):
    """Return both layers of a flat panel by 60 x 60 Gauss points."""
    x, w = np.polynomial.legendre.leggauss(60)
    u, v = np.meshgrid(0.5 * (x + 1), 0.5 * (x + 1), indexing="ij")
    a, b, c, d = corners
    q = (
        np.multiply.outer((1 - u) * (1 - v), a)
        + np.multiply.outer(u * (1 - v), b)
        + np.multiply.outer(u * v, c)
        + np.multiply.outer((1 - u) * v, d)
    )
    qu = np.multiply.outer(1 - v, b - a) + np.multiply.outer(v, c - d)
    qv = np.multiply.outer(1 - u, d - a) + np.multiply.outer(u, c - b)
    n = np.cross(qu, qv)
    d = P - q
    r = np.linalg.norm(d, axis=-1)
    W = np.outer(w, w) / 4
    return (W * np.linalg.norm(n, axis=-1) / r).sum(), (W * (d * n).sum(axis=-1) / r**3).sum()


@pytest.mark.parametrize("h", [1e-6, 0.1, 1.0, 7.0, -0.4])
def test_square_on_its_axis(h):
    S, D = (x[0, 0] for x in rankine([[0, 0, h]], SQUARE, accuracy=1e-10))
    r = np.sqrt(2 + h * h)
    angle = 4 * np.arctan(1 / (h * r))
    assert D / angle == pytest.approx(1.0, rel=1e-9)
    closed = 4 * np.log((2 * r + 2) / (2 * r - 2)) - h * angle
    assert S / closed == pytest.approx(1.0, rel=1e-11)


def test_in_the_plane():
    S, D = rankine([[0, 0, 0], [1, 0, 0], [1, 1, 0], [3, 0, 0], [1, 5, 0]], SQUARE)
    assert np.all(D == 0)
    assert S[0, 0] == pytest.approx(8 * np.log(1 + np.sqrt(2)))  # side 2
    assert S[2, 0] == pytest.approx(4 * np.log(1 + np.sqrt(2)))  # a corner sees one fourth of a square of side 4, half its size
    for i, P in ((3, [3, 0, 0]), (4, [1, 5, 0])):
        assert S[i, 0] == pytest.approx(quadrature(np.array(P), SQUARE.corners[0])[0], rel=1e-9)


@pytest.mark.parametrize("repeated", [0, 1, 2, 3])
def test_any_flat_panel_as_by_quadrature(repeated):
    turn = np.linalg.qr(RNG.normal(size=(3, 3)))[0]
    for corners in ([[0, 0], [1.3, 0.2], [1.0, 1.1], [-0.2, 0.8]], [[0, 0], [1.3, 0.2], [0.4, 1.1]]):
        flat = np.c_[corners, np.zeros(len(corners))] @ turn.T
        if len(flat) == 3:
            flat = np.insert(flat, repeated % 3, flat[repeated % 3], axis=0)
        panel = FlatPanels([flat])
        assert len(panel) == 1
        for P in panel.centers + RNG.uniform(-0.5, 0.5, size=(6, 3)) + panel.normals:
            S, D = rankine([P], panel, accuracy=1e-10)
            s, d = quadrature(P, panel.corners[0])
            assert S[0, 0] == pytest.approx(s, rel=1e-8)
            assert D[0, 0] == pytest.approx(d, abs=1e-7)


@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-6, 1e-8])
def test_approximations_are_as_accurate_as_stated(accuracy):
    used = 0
    for corners in (
        SQUARE.corners[0],
        [[0, 0, 0], [2, 0, 0], [0.3, 1, 0], [0.3, 1, 0]],
        [[0, 0, 0], [9, 0, 0], [9, 1, 0], [1, 1, 0]],
    ):
        panel = FlatPanels([corners])
        e = RNG.normal(size=(400, 3))
        distance = panel.sizes[0] * np.geomspace(2.0, 3e5, 400)
        points = panel.centers + e / np.linalg.norm(e, axis=1, keepdims=True) * distance[:, None]
        rough, fine = rankine(points, panel, accuracy=accuracy), rankine(points, panel, accuracy=1e-10)
        scale = panel.areas[0] / distance
        assert np.abs(rough.single - fine.single)[:, 0].max() > 0
        assert np.all(np.abs(rough.single - fine.single)[:, 0] <= accuracy * scale)
        assert np.all(np.abs(rough.double - fine.double)[:, 0] <= accuracy * scale / distance)
        used += np.sum(rough.single != fine.single)
    assert used > 100


@pytest.mark.parametrize("closed", [sphere(5), warped(5), sphere(4)])
def test_solid_angles_of_a_closed_surface(closed):
    inside = 0.5 * RNG.uniform(-1, 1, size=(20, 3)) / np.sqrt(3)
    points = np.concatenate([inside, 3.0 + inside, closed.centers])
    angle = rankine(points, closed, accuracy=1e-10).double.sum(axis=1)
    np.testing.assert_allclose(angle[:20], -4 * np.pi, atol=1e-10)  # normals outwards: the inside is their back
    np.testing.assert_allclose(angle[20:40], 0.0, atol=1e-10)
    np.testing.assert_allclose(angle[40:], -2 * np.pi, atol=1e-9)


def test_split_panels_close_the_surface():
    surface = warped(4)
    assert np.abs((surface.areas[:, None] * surface.normals).sum(axis=0)).max() < 1e-13
    assert len(surface) > len(sphere(4))


def test_constant_source_density_on_a_sphere():
    """Potential 4 pi inside, 4 pi/r outside; the error falls with the square of the panels' size."""
    errors = []
    for n in (4, 8, 16):
        S = rankine([[0.2, 0.1, -0.3], [1.0, 1.0, 0.5]], sphere(n)).single.sum(axis=1)
        errors.append(np.abs(S - 4 * np.pi * np.array([1.0, 1 / 1.5])).max())
    assert errors[2] < 0.03
    assert np.all(np.log2(np.divide(errors[:-1], errors[1:])) > 1.9)


def test_greens_third_identity():
    """2 pi phi + int phi d/dn(1/r) = int phi_n / r on the surface for a source outside, second order in the panels' size."""
    outside = np.array([1.2, -0.9, 0.8])
    errors = []
    for n in (4, 8, 16):
        panels = sphere(n)
        S, D = rankine(panels.centers, panels)
        d = panels.centers - outside
        r = np.linalg.norm(d, axis=1)
        phi, phi_n = 1 / r, -(d * panels.normals).sum(axis=1) / r**3
        residual = 2 * np.pi * phi + D @ phi - S @ phi_n
        errors.append(np.sqrt((panels.areas * residual**2).sum() / panels.areas.sum()))
    rates = np.log2(np.divide(errors[:-1], errors[1:]))
    assert errors[2] < 0.02
    assert np.all(rates > 1.3)


def test_neumann_problem_of_a_moving_sphere():
    """Outside a sphere that moves along x: phi = -x/2, added mass half the displaced mass."""
    mass = []
    for n in (4, 8):
        panels = sphere(n)
        S, D = rankine(panels.centers, panels)
        phi = np.linalg.solve(D - 2 * np.pi * np.eye(len(panels)), S @ panels.normals[:, 0])
        mass.append(-(phi * panels.normals[:, 0] * panels.areas).sum())
    exact = 2 / 3 * np.pi
    assert abs(mass[1] - exact) < 0.3 * abs(mass[0] - exact)
    assert mass[1] == pytest.approx(exact, rel=0.03)


@pytest.mark.parametrize("symmetry", ["xz", "xz+yz"])
def test_symmetry_gives_the_potentials_of_the_whole_surface(symmetry):
    part = sphere(3, symmetry)
    images = image_signs(symmetry)
    points = RNG.uniform(0.1, 2.0, size=(8, 3))
    whole = []
    for sx, sy in images:
        corners = part.corners * [sx, sy, 1.0]
        whole.append(FlatPanels(corners if sx * sy > 0 else corners[:, ::-1]))
    parities = [[1, 1], [1, -1], [-1, 1], [-1, -1]] if symmetry == "xz+yz" else [[1, 1], [1, -1]]
    density = RNG.normal(size=len(part))
    found = rankine_by_parity(points, part, parities)
    for sign, (S, D) in zip(density_signs(images, parities), found, strict=True):
        s = sum(
            c * (rankine(points, w).single @ _ordered(part, w, m, density)) for c, w, m in zip(sign, whole, images, strict=True)
        )
        d = sum(
            c * (rankine(points, w).double @ _ordered(part, w, m, density)) for c, w, m in zip(sign, whole, images, strict=True)
        )
        np.testing.assert_allclose(S @ density, s, atol=1e-6)
        np.testing.assert_allclose(D @ density, d, atol=1e-6)


def _ordered(part, whole, image, density):
    """Return the density in the order of the mirrored panels."""
    distance = np.linalg.norm(part.centers[None] * [*image, 1.0] - whole.centers[:, None], axis=-1)
    return density[distance.argmin(axis=1)]


def test_image_in_the_free_surface():
    part = FlatPanels(SQUARE.corners + [0.3, 0.2, -1.5])
    P = np.array([[0.4, 0.9, -0.2]])
    (S, D), (s, d) = rankine_by_parity(P, part, [[1, 1]], mirror=(1, 1, -1))[0], rankine(P * [1, 1, -1], part)
    assert S[0, 0] == s[0, 0]
    assert D[0, 0] == d[0, 0]


@pytest.mark.parametrize(
    ("corners", "words"),
    [
        (np.zeros((2, 3, 3)), r"\(n, 4, 3\) array"),
        (np.full((1, 4, 3), np.nan), "NaN"),
        ([[[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]], "panels with an area"),
    ],
)
def test_bad_panels_are_explained(corners, words):
    with pytest.raises(InputError, match=words):
        FlatPanels(corners)


def test_bad_arguments_are_explained():
    with pytest.raises(InputError, match="symmetry"):
        FlatPanels(SQUARE.corners, symmetry="yz")
    with pytest.raises(InputError, match="field"):
        rankine([0, 0, 0], SQUARE)
    with pytest.raises(InputError, match="accuracy"):
        rankine([[0, 0, 0]], SQUARE, accuracy=0.0)
    with pytest.raises(InputError, match="parities"):
        rankine_by_parity([[0, 0, 0]], SQUARE, [[0, 1]])
