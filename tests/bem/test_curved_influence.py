"""Influence matrices of curved panels against closed forms on the sphere and the rectangle."""

from dataclasses import replace

import numpy as np
import pytest
from octants import hemisphere_in_hemisphere, mirrored, sphere_octant

from ogilvie.bem.curved import CONTROL, FREE, CurvedMesh
from ogilvie.bem.curved_influence import check_closed, influence
from ogilvie.bem.curved_nodes import CurvedNodes
from ogilvie.errors import InputError


def whole_sphere(k, q=8):
    """Panels of the unit sphere; the quarter x, y > 0 is stored."""
    lower = np.array(sphere_octant(k, np.linspace(0.0, 1.0, k + 1), q))
    points, part = mirrored(lower, np.full(len(lower), CONTROL), 2)
    return CurvedMesh(points, part, 1.0, "xz+yz")


def harmonics(x):
    """Spherical harmonics of degree 0, 1, 2, 3 that are even in x and y."""
    z, rho = x[:, 2], x[:, 0] ** 2 - x[:, 1] ** 2
    return [(0, np.ones(len(x))), (1, z), (2, rho), (3, z * rho)]


def layer_errors(order, k, tolerance=1e-9):
    """Largest errors of the single and double layer of harmonics: eigenvalues 4 pi/(2l + 1) and -2 pi/(2l + 1)."""
    nodes = CurvedNodes(whole_sphere(k), order)
    matrices = influence(nodes, tolerance=tolerance)
    single, double = 0.0, 0.0
    for l, Y in harmonics(nodes.position):
        single = max(single, np.abs(matrices.single[0] @ Y - 4 * np.pi / (2 * l + 1) * Y).max())
        double = max(double, np.abs(matrices.double[0] @ Y + 2 * np.pi / (2 * l + 1) * Y).max())
    return single, double


def test_layers_on_the_sphere_have_the_exact_eigenvalues():
    single, double = layer_errors(7, 1)
    assert single < 1e-4
    assert double < 1e-4


@pytest.mark.parametrize("order", [1, 2, 3])
def test_layers_converge_with_the_order_of_the_panels(order):
    coarse, fine = (np.array(layer_errors(order, k, 1e-7)) for k in (2, 4))
    slope = np.log2(coarse / fine)
    assert np.all(slope > order - 0.2)


def test_solid_angle_of_a_smooth_closed_boundary_is_two_pi():
    matrices = influence(CurvedNodes(hemisphere_in_hemisphere(), 3), tolerance=1e-8)
    assert check_closed(matrices) < 1e-7


@pytest.mark.parametrize(("order", "sides"), [(1, (3.0, 2.0)), (3, (3.0, 2.0)), (4, (5.0, 0.5))])
def test_potential_of_a_rectangle_at_its_own_nodes(order, sides):
    a, b = sides
    corners = np.array([[[0, 0, 0], [0, b, 0]], [[a, 0, 0], [a, b, 0]]], dtype=float)
    nodes = CurvedNodes(CurvedMesh(corners[None], [FREE], 9.0), order)
    x, y, _ = nodes.position.T
    exact = sum(p * np.arcsinh(r / p) + r * np.arcsinh(p / r) for p in (x, a - x) for r in (y, b - y))
    np.testing.assert_allclose(influence(nodes, tolerance=1e-9).single[0].sum(axis=1), exact, rtol=1e-8)


def test_near_points_cost_no_accuracy():
    """Two panels 1/500 of their size apart: the potential of one at the other's nodes against the rectangle's closed form."""
    square = np.array([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]], dtype=float)
    h = 0.002
    nodes = CurvedNodes(CurvedMesh(np.array([square, square + [0, 0, h]]), [FREE, FREE], 9.0), 2)
    matrices = influence(nodes, tolerance=1e-8)
    x, y, _ = nodes.position[4:].T

    def corner(p, r):
        s = np.sqrt(p * p + r * r + h * h)
        return p * np.arcsinh(r / np.hypot(p, h)) + r * np.arcsinh(p / np.hypot(r, h)) - h * np.arctan(p * r / (h * s))

    exact = sum(corner(p, r) for p in (x, 1 - x) for r in (y, 1 - y))
    np.testing.assert_allclose(matrices.single[0][4:, :4].sum(axis=1), exact, rtol=1e-7)
    angle = sum(np.arctan(p * r / (h * np.sqrt(p * p + r * r + h * h))) for p in (x, 1 - x) for r in (y, 1 - y))
    np.testing.assert_allclose(matrices.double[0][4:, :4].sum(axis=1), angle, rtol=1e-6)


def test_classes_of_symmetry_are_those_of_the_whole_boundary():
    """Densities of each parity on the quarter make the potential that they make on the boundary with all its images stored."""
    quarter = CurvedNodes(hemisphere_in_hemisphere(depths=1, across=1), 2)
    whole = CurvedNodes(hemisphere_in_hemisphere(depths=1, across=1, symmetry="none"), 2)
    parts, full = influence(quarter, tolerance=1e-9), influence(whole, tolerance=1e-9)
    density = np.cos(np.arange(len(quarter.weight)))
    near = np.linalg.norm(np.abs(whole.position)[:, None] * [1, 1, 1] - np.abs(quarter.position), axis=-1).argmin(axis=1)
    for i, (sx, sy) in enumerate(parts.parities):
        sign = np.where(whole.position[:, 0] < 0, sx, 1.0) * np.where(whole.position[:, 1] < 0, sy, 1.0)
        own = np.flatnonzero((whole.position[:, 0] > 0) & (whole.position[:, 1] > 0))
        for name in ("single", "double"):
            a = getattr(full, name)[0] @ (sign * density[near])
            b = getattr(parts, name)[i] @ density
            np.testing.assert_allclose(a[own], b[near[own]], atol=2e-6)


@pytest.mark.parametrize("damage", ["gap", "twice", "inside out"])
def test_boundary_that_is_not_closed_is_refused_by_name(damage):
    mesh = hemisphere_in_hemisphere()
    points, part = mesh.points, mesh.part
    last = int(np.flatnonzero(part == FREE)[-1])
    if damage == "gap":
        mesh = replace(mesh, points=np.delete(points, last, axis=0), part=np.delete(part, last))
    elif damage == "twice":
        mesh = replace(mesh, points=np.append(points, points[last : last + 1], axis=0), part=np.append(part, FREE))
    else:
        turned = points.copy()
        turned[last] = points[last].transpose(1, 0, 2)
        mesh = replace(mesh, points=turned)
    with pytest.raises(InputError, match=r"not closed: from panel \d+ \((hull|free surface|control surface), at"):
        check_closed(influence(CurvedNodes(mesh, 2)))


def test_panel_without_area_is_refused():
    flat = np.zeros((1, 2, 2, 3))
    flat[0, 1, :, 0] = 1.0
    with pytest.raises(InputError, match="no area"):
        CurvedNodes(CurvedMesh(flat, [FREE], 1.0), 2)
    with pytest.raises(InputError, match="order"):
        CurvedNodes(whole_sphere(1), 0)
    with pytest.raises(InputError, match="tolerance"):
        influence(CurvedNodes(whole_sphere(1), 1), tolerance=0.5)


def test_nodes_integrate_area_and_normal_points_outwards():
    nodes = CurvedNodes(whole_sphere(2), 4)
    assert 4 * nodes.weight.sum() == pytest.approx(4 * np.pi, rel=1e-7)
    np.testing.assert_allclose(nodes.normal, nodes.position, atol=2e-6)


def test_strongly_bent_panels_are_halved_enough():
    """Two bent sheets close together: the tangent plane in the middle of a panel says little of where the panel is."""
    t = -np.cos(np.pi * np.arange(6) / 5)
    u, v = np.meshgrid(t, t, indexing="ij")
    sheet = np.stack([u + 0.3 * u * v, v, 0.9 * (1.0 - u**2) ** 2 - 0.3 * u**3], axis=-1)
    nodes = CurvedNodes(CurvedMesh(np.array([sheet, sheet + [0.0, 0.0, 0.02]]), [FREE, FREE], 5.0), order=6)
    rough, fine = (influence(nodes, tolerance=tolerance) for tolerance in (1e-6, 1e-11))
    assert np.abs(rough.double - fine.double).max() < 2e-4
    assert np.abs(rough.single - fine.single).max() < 2e-4


def test_panel_that_bends_away_from_its_own_tangent_plane():
    """A narrow, skewed and twisted sheet: what it does at its own nodes, against many more points."""
    t = -np.cos(np.pi * np.arange(6) / 5)
    u, v = np.meshgrid(t, t, indexing="ij")
    sheet = np.stack([u + 0.5 * v, 0.3 * v + 0.1 * u * v, 0.6 * u**2 + 0.3 * v**2], axis=-1)
    nodes = CurvedNodes(CurvedMesh(sheet[None], [FREE], 5.0), order=4)
    rough, fine = (influence(nodes, tolerance=tolerance) for tolerance in (1e-6, 1e-11))
    assert np.abs(rough.double - fine.double).max() < 1e-5
    assert np.abs(rough.single - fine.single).max() < 1e-5
