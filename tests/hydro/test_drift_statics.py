"""Second-order rotations and still-water forces of the mean drift, against exact geometry; forms and tables behind it."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.special import exp1

from ogilvie.hydro.bem_panels import HullPanels
from ogilvie.hydro.bem_table import near_surface
from ogilvie.hydro.drift_forms import cross_mean, integral, mean, outer_mean
from ogilvie.hydro.drift_near import waterline_force
from ogilvie.hydro.drift_panels import WholeHull, find_waterline
from ogilvie.hydro.drift_slope import find_slopes
from ogilvie.hydro.drift_static import second_rotation, static_force
from ogilvie.mesh import shapes
from ogilvie.mesh.panels import PanelMesh

RHO, G = 1000.0, 9.8


def turn(angles, order):
    """The rotation matrix R = Rz Ry Rx ("ZYX") or Rx Ry Rz ("XYZ")."""
    c, s = np.cos(angles), np.sin(angles)
    X = np.array([[1, 0, 0], [0, c[0], -s[0]], [0, s[0], c[0]]])
    Y = np.array([[c[1], 0, s[1]], [0, 1, 0], [-s[1], 0, c[1]]])
    Z = np.array([[c[2], -s[2], 0], [s[2], c[2], 0], [0, 0, 1]])
    return Z @ Y @ X if order == "ZYX" else X @ Y @ Z


@pytest.mark.parametrize("order", ["ZYX", "XYZ"])
def test_quadratic_part_of_the_rotation_matrix(order):
    a, h = np.array([0.3, -0.7, 0.5]), 1e-3
    exact = (turn(h * a, order) + turn(-h * a, order) - 2.0 * np.eye(3)) / (2.0 * h * h)
    np.testing.assert_allclose(second_rotation(np.outer(a, a), order), exact, atol=1e-6)


def buoyancy(vertices, faces, motion, order):
    """Exact force and moment about the fixed origin of still water on a closed body that has moved."""
    moved = vertices @ turn(motion[3:], order).T + motion[:3]
    below = PanelMesh(moved, faces).immersed()
    force = RHO * G * below.volume * np.array([0.0, 0.0, 1.0])
    return np.concatenate([force, np.cross(below.center_of_buoyancy, force)])


@pytest.mark.parametrize("order", ["ZYX", "XYZ"])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_still_water_on_a_moved_box_agrees_with_exact_hydrostatics(order, seed):
    rng = np.random.default_rng(seed)
    motion = rng.normal(size=6) * [1.0, 1.0, 0.5, 0.1, 0.1, 0.3]
    L, B, T, H = 8.0, 5.0, 2.0, 2.0
    x0 = np.array([0.7, -0.4])  # no symmetry about O
    corner = np.array([[x, y, z] for x in (-L / 2, L / 2) for y in (-B / 2, B / 2) for z in (-T, H)]) + [*x0, 0.0]
    closed = np.array([[0, 2, 6, 4], [1, 5, 7, 3], [0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6]])
    if PanelMesh(corner, closed).volume < 0:
        closed = closed[:, ::-1]
    h = 2e-3
    exact = sum(buoyancy(corner, closed, s * h * motion, order) for s in (1, -1))
    exact = 0.5 * (exact - 2.0 * buoyancy(corner, closed, 0.0 * motion, order)) / (2.0 * h * h)
    box = shapes.box(L, B, T, panels=2500, grading=0.0).with_symmetry("none").translated([*x0, 0.0])
    X = motion[None].astype(complex)
    found = static_force(X, box.moments, rotation=order, rho=RHO, g=G)
    hull = WholeHull(HullPanels(box))
    still = SimpleNamespace(
        wave=SimpleNamespace(rho=RHO, g=G, omega=1.0, directions=[0.0]),
        hull=hull,
        motion=X,
        line=hull.waterline,
        elevation=np.zeros((1, len(hull.waterline.owner)), dtype=complex),
    )
    found = (found + waterline_force(still)).real[0, 0]
    scale = RHO * G * np.abs([50, 50, 50, 200, 200, 200])
    assert np.abs(found - exact).max() < 2e-3 * scale.max()
    np.testing.assert_allclose(found / scale, exact / scale, atol=4e-4)
    other = static_force(X, box.moments, rotation="XYZ" if order == "ZYX" else "ZYX", rho=RHO, g=G).real[0, 0]
    change = other - static_force(X, box.moments, rotation=order, rho=RHO, g=G).real[0, 0]
    assert np.abs(change[2:5] / scale[2:5]).max() > 5e-4  # the order of rotations matters there
    np.testing.assert_allclose(change[[0, 1, 5]], 0.0, atol=1e-6 * scale[0])


def test_means_are_hermitian_forms_and_their_diagonal_is_the_time_average():
    rng = np.random.default_rng(0)
    a, b = (rng.normal(size=(3, 4)) + 1j * rng.normal(size=(3, 4)) for _ in range(2))
    Q = mean(a, b)
    np.testing.assert_allclose(Q, Q.conj().transpose(1, 0, 2))
    c = rng.normal(size=3) + 1j * rng.normal(size=3)
    t = 2.0 * np.pi * np.arange(64) / 64
    x, y = (np.real((c @ f)[:, None] * np.exp(1j * t)) for f in (a, b))
    np.testing.assert_allclose(np.einsum("m,mnp,n->p", c, Q, c.conj()), (x * y).mean(axis=1), atol=1e-12)
    w = rng.normal(size=(4, 2))
    np.testing.assert_allclose(integral(a, b, w), np.einsum("mnp,pi->mni", Q, w))
    np.testing.assert_allclose(integral(a, a, w), np.einsum("mnp,pi->mni", mean(a, a), w))
    v, u = a[:, :3], b[:, :3]
    pairs = outer_mean(v, u)
    np.testing.assert_allclose(cross_mean(v, u)[..., 2], pairs[..., 0, 1] - pairs[..., 1, 0])


def test_waterline_of_a_sphere_is_a_circle_with_no_flare():
    hull = WholeHull(HullPanels(shapes.hemisphere(2.0, panels=800)))
    line = hull.waterline
    np.testing.assert_allclose(np.linalg.norm(line.middle, axis=1), 2.0, rtol=5e-3)
    np.testing.assert_allclose(line.normal[:, :2], line.middle[:, :2] / np.linalg.norm(line.middle, axis=1)[:, None], atol=2e-3)
    assert np.abs(line.normal[:, 2]).max() < 0.004  # the top panels alone have 0.028
    assert np.abs(hull.normals[line.owner][:, 2]).max() > 0.02
    np.testing.assert_allclose(line.tangent.sum(axis=0), 0.0, atol=1e-12)
    around = np.cross(line.middle, line.tangent)[:, 2]  # right-handed about the normal: clockwise seen from above
    assert np.all(around < 0.0)
    np.testing.assert_allclose(-0.5 * around.sum(), 4.0 * np.pi, rtol=1e-2)


def test_flare_of_a_cone_is_found_and_a_deck_is_no_waterline():
    n = 24
    t = 2.0 * np.pi * np.arange(n) / n
    ring = [np.stack([r * np.cos(t), r * np.sin(t), 0.0 * t + z], axis=1) for r, z in ((1.0, -2.0), (2.0, -1.0), (3.0, 0.0))]
    points = np.concatenate([*ring, [[0.0, 0.0, -2.0]]])
    i = np.arange(n)
    j = (i + 1) % n
    faces = [np.stack([i + k * n, j + k * n, j + (k + 1) * n, i + (k + 1) * n], axis=1) for k in (0, 1)]
    cone = PanelMesh(points, np.concatenate([*faces, np.stack([0 * i + 3 * n, j, i, i], axis=1)]))
    line = find_waterline(cone)
    assert len(line.owner) == n
    np.testing.assert_allclose(line.normal[:, 2], -np.cos(np.pi / n), rtol=1e-2)


def test_slopes_of_a_linear_source_on_a_plane_are_exact():
    x, y = np.meshgrid(np.linspace(0.0, 3.0, 7), np.linspace(0.0, 2.0, 6), indexing="ij")
    v = np.stack([x.ravel(), y.ravel(), -1.0 + 0.0 * x.ravel()], axis=1)
    i = np.arange(42).reshape(7, 6)
    f = np.stack([i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]], axis=-1).reshape(-1, 4)
    hull = WholeHull(HullPanels(PanelMesh(v, f)))
    sigma = (2.0 * hull.centers[:, 0] - hull.centers[:, 1])[None].astype(complex)
    lacking = find_slopes(hull).missing(sigma)[0]
    c = np.log(2.0) / (2.0 * np.pi)
    np.testing.assert_allclose(lacking, np.tile([-c * 2.0 * 0.5, c * 0.4, 0.0], (30, 1)), atol=1e-12)


def test_tangential_velocity_of_steps_lacks_what_is_added():
    kappa, n = 2.0 * np.pi, 40  # plane in two dimensions: potential (sigma/2 pi) ln r per length
    h = 1.0 / n
    centers = h * (np.arange(-200 * n, 200 * n) + 0.5)
    sigma = np.sin(kappa * centers)
    d = 0.5 * h - centers
    left, right = np.abs(d + 0.5 * h), np.abs(d - 0.5 * h)
    ok = np.abs(d) > 0.25 * h
    velocity = np.sum(sigma[ok] * np.log(left[ok] / right[ok])) / (2.0 * np.pi)
    exact = -0.5 * np.cos(kappa * 0.5 * h)
    added = -np.log(2.0) / (2.0 * np.pi) * h * kappa * np.cos(kappa * 0.5 * h)
    assert abs(velocity - exact) > 0.01 * abs(exact)
    assert abs(velocity + added - exact) < 0.1 * abs(velocity - exact)


def test_wave_part_of_the_green_function_at_the_surface():
    r, z = np.array([0.2, 1.0, 6.0, 30.0]), np.array([-0.9, -0.1, -1e-4])
    s = (np.arange(40000) + 0.5) / 40000
    u, w = 0.5 * np.pi * s**3, 1.5 * np.pi * s**2 / 40000
    zeta = z[None, :, None] + 1j * r[:, None, None] * np.sin(u)
    exact = 4.0 / np.pi * ((np.exp(zeta) * (exp1(zeta) + 1j * np.pi)).real @ w)
    np.testing.assert_allclose(near_surface(r, z), exact, atol=2e-6)
