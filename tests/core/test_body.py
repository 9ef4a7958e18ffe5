"""The rigid body: inertia about O, and what it refuses."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.frames import about_origin


def test_matrix_is_the_inertia_moved_from_the_centre_of_gravity():
    body = og.RigidBody(1200.0, [3.0, 0.5, -2.0], np.diag([500.0, 900.0, 1000.0]))
    at_cog = np.zeros((6, 6))
    at_cog[:3, :3], at_cog[3:, 3:] = 1200.0 * np.eye(3), body.inertia
    assert np.allclose(body.matrix, about_origin(at_cog, body.cog))
    assert np.allclose(body.gyradii**2 * body.mass, [500.0, 900.0, 1000.0])


def test_kinetic_energy_of_point_masses():
    """A body made of point masses has the kinetic energy of these masses."""
    rng = np.random.default_rng(4)
    points, m = rng.standard_normal((8, 3)), rng.uniform(1, 2, 8)
    cog = m @ points / m.sum()
    r = points - cog
    inertia = np.einsum("i,ijk->jk", m, np.einsum("ij,ij->i", r, r)[:, None, None] * np.eye(3) - r[:, :, None] * r[:, None, :])
    body, nu = og.RigidBody(m.sum(), cog, inertia), rng.standard_normal(6)
    energy = 0.5 * m @ np.einsum("ij,ij->i", v := nu[:3] + np.cross(nu[3:], points), v)
    assert np.isclose(0.5 * nu @ body.matrix @ nu, energy)


@pytest.mark.parametrize(
    ("mass", "cog", "inertia", "words"),
    [
        (-1.0, [0, 0, 0], [1, 1, 1], "mass"),
        (np.nan, [0, 0, 0], [1, 1, 1], "mass"),
        (1.0, [0, 0], [1, 1, 1], "cog"),
        (1.0, [0, 0, np.nan], [1, 1, 1], "cog"),
        (1.0, [0, 0, 0], [1, 1, 3], "triangle inequality"),
        (1.0, [0, 0, 0], [1, 1, -1], "positive principal"),
        (1.0, [0, 0, 0], [[1, 1, 0], [0, 1, 0], [0, 0, 1]], "symmetric"),
        (1.0, [0, 0, 0], np.full((3, 3), np.nan), "finite"),
    ],
)
def test_impossible_bodies_are_refused(mass, cog, inertia, words):
    with pytest.raises(og.InputError, match=words):
        og.RigidBody(mass, cog, inertia)


def test_rounded_inertia_of_a_real_ship_only_warns():
    with pytest.warns(og.OgilvieWarning, match="triangle inequality"):
        og.RigidBody(1.0, [0, 0, 0], [1.0, 9.0, 10.1])


def test_from_hull_needs_one_height():
    with pytest.raises(og.InputError, match="exactly one of"):
        og.RigidBody.from_hull(og.shapes.box(10, 4, 2), gyradii=(1, 2, 2))


def test_from_hull_floats_at_rest():
    hull = og.shapes.box(10.0, 4.0, 2.0)
    body = og.RigidBody.from_hull(hull, gyradii=(1.5, 3, 3), kg=1.5, rho=1000.0)
    assert np.isclose(body.mass, 80_000.0)
    assert np.allclose(body.cog, [0, 0, -0.5])
