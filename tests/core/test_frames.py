"""Rotations, reference points and axis conventions: identities."""

import numpy as np
import pytest

from ogilvie.frames import (
    about_origin,
    coriolis_matrix,
    euler_rate_matrix,
    matrix_to_z_down,
    rotation_matrix,
    shift_matrix,
    skew,
    to_z_down,
)

ANGLES = [(0.3, -0.7, 1.9), (-1.2, 0.4, -2.5)]


@pytest.mark.parametrize("angles", ANGLES)
def test_rotation_is_orthogonal_and_composes(angles):
    phi, theta, psi = angles
    R = rotation_matrix(*angles)
    assert np.allclose(R @ R.T, np.eye(3), atol=1e-14)
    assert np.isclose(np.linalg.det(R), 1.0)
    parts = rotation_matrix(0, 0, psi) @ rotation_matrix(0, theta, 0) @ rotation_matrix(phi, 0, 0)
    assert np.allclose(R, parts, atol=1e-14)


def test_positive_pitch_is_bow_down():
    bow = rotation_matrix(0.0, 0.1, 0.0) @ [100.0, 0.0, 0.0]
    assert bow[2] < 0


def test_positive_roll_lifts_port():
    port = rotation_matrix(0.1, 0.0, 0.0) @ [0.0, 10.0, 0.0]
    assert port[2] > 0


@pytest.mark.parametrize("angles", ANGLES)
def test_euler_rates_match_the_rotation_rate(angles):
    """R' = R S(omega) with Theta' = T omega, by central differences."""
    omega, h = np.array([0.3, -0.2, 0.5]), 1e-6
    rate = euler_rate_matrix(*angles[:2]) @ omega
    difference = (rotation_matrix(*(np.array(angles) + h * rate)) - rotation_matrix(*(np.array(angles) - h * rate))) / (2 * h)
    assert np.allclose(difference, rotation_matrix(*angles) @ skew(omega), atol=1e-8)


def test_moving_the_reference_point_keeps_kinetic_energy_and_power():
    rng = np.random.default_rng(1)
    M = rng.standard_normal((6, 6))
    M, p, nu = M @ M.T, np.array([1.0, -2.0, 3.0]), rng.standard_normal(6)
    nu_p = shift_matrix(p) @ nu
    assert np.isclose(nu @ about_origin(M, p) @ nu, nu_p @ M @ nu_p)


def test_coriolis_does_no_work_and_turns_a_point_mass():
    rng = np.random.default_rng(2)
    M, nu = rng.standard_normal((6, 6)), rng.standard_normal(6)
    M = M @ M.T
    assert abs(nu @ coriolis_matrix(M, nu) @ nu) < 1e-12 * np.abs(M).max()
    steady_turn = np.array([2.0, 0, 0, 0, 0, 0.5])  # centripetal force m u r towards port
    assert np.allclose((coriolis_matrix(np.diag([3.0, 3, 3, 1, 1, 1]), steady_turn) @ steady_turn)[:3], [0, 3 * 2 * 0.5, 0])


def test_z_down_is_its_own_inverse_and_keeps_the_power():
    rng = np.random.default_rng(3)
    F, nu, M = rng.standard_normal(6), rng.standard_normal(6), rng.standard_normal((6, 6))
    assert np.array_equal(to_z_down(to_z_down(F)), F)
    assert np.isclose(to_z_down(F) @ to_z_down(nu), F @ nu)
    assert np.allclose(matrix_to_z_down(M) @ to_z_down(nu), to_z_down(M @ nu))
