"""Inner map, its reciprocity, and the coupled system at infinite frequency, against closed forms."""

import numpy as np
import pytest
from octants import hemisphere_in_hemisphere
from scipy.optimize import brentq
from scipy.special import jvp, yvp
from standing import odd_functions, still

from ogilvie.bem.coupled import azimuthal_modes, control_functions, joined, uncoupled
from ogilvie.bem.curved import BODY, CONTROL, FREE
from ogilvie.bem.curved_nodes import CurvedNodes
from ogilvie.bem.inner import inner_maps, normal_modes, unit_mesh
from ogilvie.bem.reciprocity import in_functions, reciprocal
from ogilvie.bem.surface_modes import surface_modes
from ogilvie.errors import InputError

MESH = {"depths": [0, 0.1, 1], "across": [0, 0.04, 0.2, 0.55, 1], "control": [0, 0.3, 1]}


def harmonic(parity, x):
    """A harmonic polynomial with the signs of the class under x -> -x and y -> -y, and its gradient."""
    x, y, z = x.T
    o = 0 * x
    return {
        (1, 1): (x * x * z - z**3 / 3 + 0.2 * z, np.stack([2 * x * z, o, x * x - z * z + 0.2], -1)),
        (-1, 1): (x * z + x**3 - 3 * x * y * y, np.stack([z + 3 * x * x - 3 * y * y, -6 * x * y, x], -1)),
        (1, -1): (y * z, np.stack([o, z, y], -1)),
        (-1, -1): (x * y, np.stack([y, x, o], -1)),
    }[tuple(int(s) for s in parity)]


def map_error(inner):
    """Error of the map (f, q, v) -> (e, -phi, -phi) for the harmonic polynomial, in the area-weighted norm."""
    nodes = inner.nodes
    phi, gradient = harmonic(inner.parity, nodes.position)
    slope = np.sum(gradient * nodes.normal, axis=1)
    free = nodes.part == FREE
    given, wanted = np.where(free, phi, slope), np.where(free, slope, -phi)
    r = inner.root_weight
    return np.linalg.norm(inner.matrix @ (r * given) - r * wanted) / np.linalg.norm(r * wanted)


def test_map_of_harmonic_polynomials_converges_with_the_order():
    errors = np.array([[map_error(m) for m in inner_maps(hemisphere_in_hemisphere(**MESH), order=p)[0]] for p in (2, 4, 6)])
    assert errors.shape == (3, 4)
    assert np.all(errors[2] < 2e-3)
    assert np.all(errors[2] < errors[1] / 4)
    assert np.all(errors[1] < errors[0] / 4)


def test_map_is_reciprocal_for_smooth_functions():
    """a.T T b = b.T T a for two harmonic functions, though the matrix itself is symmetric to a few percent only."""
    inner = inner_maps(hemisphere_in_hemisphere(**MESH), order=5)[0][0]
    nodes, r = inner.nodes, inner.root_weight
    x, z = nodes.position[:, 0], nodes.position[:, 2]
    free = nodes.part == FREE
    one = harmonic((1, 1), nodes.position)
    two = (x * x - nodes.position[:, 1] ** 2, np.stack([2 * x, -2 * nodes.position[:, 1], 0 * z], -1))
    a, b = (r * np.where(free, phi, np.sum(g * nodes.normal, axis=1)) for phi, g in (one, two))
    assert a @ inner.matrix @ b == pytest.approx(b @ inner.matrix @ a, abs=1e-5 * np.linalg.norm(a) * np.linalg.norm(b))
    assert 1e-3 < inner.asymmetry < 0.1


def test_signs_of_the_map():
    """A potential on the free surface costs energy (T_ff > 0 but for the constant); inflow makes -phi < 0 on the rest."""
    for inner in inner_maps(hemisphere_in_hemisphere(**MESH), order=3)[0]:
        part, T = inner.nodes.part, 0.5 * (inner.matrix + inner.matrix.T)
        e = np.linalg.eigvalsh(T[np.ix_(part == FREE, part == FREE)])
        assert e[0] > -1e-4
        assert (e[0] < 1e-4) == (tuple(inner.parity) == (1, 1))
        rest = part != FREE
        assert np.linalg.eigvalsh(T[np.ix_(rest, rest)]).max() < 1e-4


def test_dofs_of_the_classes():
    maps, _ = inner_maps(hemisphere_in_hemisphere(depths=1, across=1), order=2)
    assert {tuple(m.parity.astype(int)): m.dofs for m in maps} == {(1, 1): [2], (1, -1): [1, 3], (-1, 1): [0, 4], (-1, -1): [5]}
    half, _ = inner_maps(hemisphere_in_hemisphere(depths=1, across=1, symmetry="xz"), order=2)
    assert [m.dofs for m in half] == [[0, 2, 4], [1, 3, 5]]
    whole, _ = inner_maps(hemisphere_in_hemisphere(depths=1, across=1, symmetry="none"), order=2)
    assert [m.dofs for m in whole] == [[0, 1, 2, 3, 4, 5]]


def test_modes_of_the_hull():
    """A sphere's normal has no moment about its centre; the integral of n z over the hull is the displaced volume."""
    nodes = CurvedNodes(unit_mesh(hemisphere_in_hemisphere(**MESH)), 5)
    n = normal_modes(nodes)
    assert np.abs(n[3:]).max() < 1e-4
    hull = nodes.part == BODY
    volume = 4 * np.sum(nodes.weight[hull] * n[2] * nodes.position[hull, 2])
    assert abs(volume) == pytest.approx(2 / 3 * np.pi / 8, rel=1e-6)
    assert volume < 0  # normals point into the hull
    shifted = normal_modes(nodes, np.array([0.3, 0.0, 0.0]))
    np.testing.assert_allclose(shifted[4], -0.3 * n[2], atol=1e-4)


@pytest.mark.parametrize("how", ["smoother", "mean"])
def test_added_mass_of_the_hemisphere_at_infinite_frequency(how):
    """phi = 0 on the whole free surface: A33 = 1/2 and A11 = 4/pi - 1 of the displaced mass."""
    unit = 2 / 3 * np.pi / 8
    maps, _ = inner_maps(hemisphere_in_hemisphere(**MESH), order=5)
    for inner in maps:
        system = joined(uncoupled(inner, [still(m, 4) for m in range(4)], odd_functions), reciprocity=how)
        np.testing.assert_array_equal(system.stiffness, system.stiffness.T)
        assert np.linalg.eigvalsh(system.stiffness)[0] > 0
        found = system.added_mass[0, 0] / unit
        if inner.dofs == [2]:
            assert found == pytest.approx(0.5, rel=1e-4)
            assert system.forcing[:, 0] @ system.forcing[:, 0] / unit / 2 == pytest.approx(3 / 16 * 15 / 16, rel=5e-3)
        elif 0 in inner.dofs or 1 in inner.dofs:
            assert found == pytest.approx(4 / np.pi - 1, rel=1e-3)
        np.testing.assert_allclose(system.added_mass, system.added_mass.T, atol=1e-12)


def test_reciprocal_map_is_exact_where_the_map_is_symmetric():
    inner = inner_maps(hemisphere_in_hemisphere(depths=1, across=1), order=2)[0][0]
    part = inner.nodes.part
    symmetric = type(inner)(inner.nodes, inner.parity, inner.matrix + inner.matrix.T)
    Y, modes = np.eye((part == CONTROL).sum()), surface_modes(inner.nodes, inner.parity)[1]
    motions = normal_modes(inner.nodes)[inner.dofs] * inner.root_weight[part == BODY]
    given = in_functions(symmetric, Y, modes, motions)
    one, two = (reciprocal(given, smooth=len(modes), how=how) for how in ("smoother", "mean"))
    for name in ("ff", "qf", "qq", "vf", "vq", "vv"):
        np.testing.assert_allclose(getattr(one, name), getattr(two, name), atol=1e-12)
    T = symmetric.matrix[np.ix_(part == BODY, part == FREE)]
    np.testing.assert_allclose(one.hull @ one.vf @ modes.T, T, atol=1e-12)


def annulus_wavenumbers(m, count, a=0.5, b=1.0):
    """k of J_m(k r) and Y_m(k r) combined so that the slope is zero at both radii."""
    k = np.linspace(0.01, 60.0, 6000)

    def f(x):
        return jvp(m, x * a) * yvp(m, x * b) - jvp(m, x * b) * yvp(m, x * a)

    change = np.flatnonzero(f(k[1:]) * f(k[:-1]) < 0)
    return [brentq(f, k[i], k[i + 1]) for i in change][:count]


@pytest.mark.parametrize(("parity", "m"), [((-1, 1), (1, 3, 5, 7)), ((1, -1), (1, 3, 5, 7)), ((-1, -1), (2, 4, 6, 8))])
@pytest.mark.parametrize("jitter", [0.0, 0.4])
def test_standing_waves_of_the_annulus(parity, m, jitter):
    nodes = CurvedNodes(unit_mesh(hemisphere_in_hemisphere(across=4, k=2, jitter=jitter)), 6)
    k, modes = surface_modes(nodes, np.array(parity))
    exact = np.sort(np.concatenate([annulus_wavenumbers(i, 4) for i in m]))[:6]
    np.testing.assert_allclose(k[:6], exact, rtol=3e-4)
    np.testing.assert_allclose(modes.T @ modes, np.eye(len(modes)), atol=1e-10)


def test_azimuthal_modes_of_a_class_have_its_parity():
    a = np.array([0.3, 1.1])
    for parity in [(1, 1), (1, -1), (-1, 1), (-1, -1)]:
        found = azimuthal_modes(np.array(parity), (True, True), 7)
        assert len(found) >= 3
        for m, sine in found:
            f = np.sin if sine else np.cos
            np.testing.assert_allclose(f(m * (np.pi - a)), parity[0] * f(m * a), atol=1e-12)
            np.testing.assert_allclose(f(-m * a), parity[1] * f(m * a), atol=1e-12)
    assert len(azimuthal_modes(np.array([1, 1]), (False, False), 7)) == 15


def test_functions_of_the_control_surface_are_orthonormal():
    nodes = CurvedNodes(unit_mesh(hemisphere_in_hemisphere(control=2, k=2)), 7)
    rows = np.concatenate([control_functions(nodes, m, False, 4, odd_functions) for m in (0, 2, 4)])
    np.testing.assert_allclose(rows @ rows.T, np.eye(12), atol=2e-3)


def test_control_surface_with_too_few_nodes_is_refused():
    inner = inner_maps(hemisphere_in_hemisphere(depths=1, across=1), order=1)[0][0]
    with pytest.raises(InputError, match="functions of the depth"):
        uncoupled(inner, [still(m, 12) for m in range(2)], odd_functions)
