"""Dispersion relation: residuals, limits, inverses, group velocity as a derivative, signed encounter frequency."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ogilvie.errors import InputError
from ogilvie.units import GRAVITY
from ogilvie.waves.dispersion import encounter_frequency, frequency, group_velocity, phase_velocity, wavenumber

EPS = np.finfo(float).eps


def test_root_is_exact_to_rounding_over_28_decades_of_depth():
    x = np.geomspace(1e-14, 1e14, 20001)  # omega^2 h / g
    depth = 50.0
    omega = np.sqrt(x * GRAVITY / depth)
    y = wavenumber(omega, depth) * depth
    t = np.tanh(y)
    error_of_y = (y * t - x) / (y * (t + y * (1 - t * t)))  # relative; Newton's next correction
    assert np.abs(error_of_y).max() < 4 * EPS


def test_deep_and_shallow_limits():
    omega = np.array([1e-3, 0.3, 2.0])
    np.testing.assert_array_equal(wavenumber(omega), omega**2 / GRAVITY)
    np.testing.assert_array_equal(wavenumber(omega, 1e9), omega**2 / GRAVITY)
    np.testing.assert_allclose(wavenumber(1e-6, 10.0), 1e-6 / np.sqrt(GRAVITY * 10.0), rtol=1e-12)
    assert wavenumber(0.0, 10.0) == 0.0
    assert wavenumber(0.0) == 0.0


def test_published_values():
    # Shore Protection Manual (1984), table C-1: d/L0 = 0.1 gives d/L = 0.1410, tanh(kd) = 0.7093, n = c_g/c = 0.8103
    depth, g = 10.0, 9.81
    omega = np.sqrt(2 * np.pi * g * 0.1 / depth)
    kd = wavenumber(omega, depth, g=g) * depth
    assert kd / (2 * np.pi) == pytest.approx(0.1410, abs=5e-5)
    assert np.tanh(kd) == pytest.approx(0.7093, abs=6e-5)
    assert group_velocity(omega, depth, g=g) / phase_velocity(omega, depth, g=g) == pytest.approx(0.8103, abs=1e-4)


@given(st.floats(1e-4, 20.0), st.floats(0.01, 1e5))
def test_frequency_is_the_inverse(omega, depth):
    assert frequency(wavenumber(omega, depth), depth) == pytest.approx(omega, rel=4e-15)


@given(st.floats(0.05, 5.0), st.one_of(st.floats(0.5, 5e3), st.just(np.inf)))
def test_group_velocity_is_the_derivative(omega, depth):
    k = float(wavenumber(omega, depth))
    h = 1e-4 * k
    w = frequency(k + h * np.array([-2.0, -1.0, 1.0, 2.0]), depth)
    derivative = (w[0] - 8 * w[1] + 8 * w[2] - w[3]) / (12 * h)
    assert group_velocity(omega, depth) == pytest.approx(derivative, rel=1e-9)


def test_velocity_limits():
    assert group_velocity(0.7) == pytest.approx(0.5 * phase_velocity(0.7), rel=1e-15)
    assert group_velocity(0.0, 12.0) == phase_velocity(0.0, 12.0) == np.sqrt(GRAVITY * 12.0)
    assert group_velocity(1e-7, 12.0) == pytest.approx(np.sqrt(GRAVITY * 12.0), rel=1e-12)
    assert group_velocity(5.0, 1e4) == pytest.approx(0.5 * GRAVITY / 5.0, rel=1e-14)


def test_arguments_broadcast():
    k = wavenumber(np.array([0.3, 0.6, 0.9])[:, None], np.array([10.0, np.inf]))
    assert k.shape == (3, 2)
    assert k[1, 0] == wavenumber(0.6, 10.0)
    assert k[1, 1] == wavenumber(0.6)


def test_encounter_frequency_is_signed():
    speed, omega = 10.0, np.linspace(0.1, 2.0, 20)
    following = encounter_frequency(omega, speed=speed, direction=0.0)
    head = encounter_frequency(omega, speed=speed, direction=np.pi)
    assert (following < 0).any()
    assert (following < omega).all()
    assert (head > omega).all()
    np.testing.assert_allclose(following + head, 2 * omega, rtol=1e-14)
    # the overtaking limit: phase velocity equals ship speed
    at_rest = frequency(GRAVITY / speed**2)
    assert encounter_frequency(at_rest, speed=speed, direction=0.0) == pytest.approx(0.0, abs=1e-15)
    np.testing.assert_allclose(encounter_frequency(omega, speed=speed, direction=np.pi / 2), omega, rtol=1e-12)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: wavenumber(-0.1), "omega"),
        (lambda: wavenumber([0.1, np.nan]), "omega"),
        (lambda: wavenumber(np.inf), "omega"),
        (lambda: wavenumber(0.5, 0.0), "depth"),
        (lambda: wavenumber(0.5, np.nan), "depth"),
        (lambda: wavenumber(0.5, g=0.0), "g:"),
        (lambda: frequency(-1.0), "k:"),
    ],
)
def test_bad_input_is_named(call, words):
    with pytest.raises(InputError, match=words):
        call()
