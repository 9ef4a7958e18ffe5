"""Functions of the depth: orthonormal, with the right root at the pole; Legendre functions against scipy."""

import numpy as np
import pytest
import scipy.special

from ogilvie.bem.outer_functions import depth_functions, depth_taylor, gauss, legendre, legendre_at_surface
from ogilvie.errors import InputError


@pytest.mark.parametrize("m", [0, 1, 2, 7, 16])
def test_depth_functions_are_orthonormal_on_a_finer_grid(m):
    x, w = gauss(200)
    y = depth_functions(m, x, 16)
    assert np.allclose((y * w) @ y.T, np.eye(16), atol=1e-11)


def test_depth_functions_of_the_axisymmetric_mode_are_shifted_legendre_polynomials():
    x = np.linspace(0, 1, 7)
    expected = [np.sqrt(2 * j + 1) * scipy.special.eval_legendre(j, 2 * x - 1) for j in range(10)]
    assert np.allclose(depth_functions(0, x, 10), expected, atol=1e-11)


@pytest.mark.parametrize("m", [1, 3, 6])
def test_depth_functions_have_a_root_of_order_m_at_the_pole(m):
    sine = np.array([1e-3, 2e-3])
    y = depth_functions(m, np.sqrt(1 - sine**2), 5)
    assert np.allclose(y[:, 1] / y[:, 0], 2.0**m, rtol=1e-3)


def test_depth_functions_span_both_parities():
    x, w = gauss(60)
    y = depth_functions(2, x, 5)
    for degree in range(5):
        f = (1 - x**2) * x**degree
        assert np.allclose((y * w @ f) @ y, f, atol=1e-11)


@pytest.mark.parametrize("m", [0, 3])
def test_taylor_coefficients_give_the_functions(m):
    x = np.linspace(0, 1, 9)
    p = depth_taylor(m, 6)
    assert np.allclose((1 - x**2) ** (m / 2) * (p @ x ** np.arange(6)[:, None]), depth_functions(m, x, 6), atol=1e-10)


@pytest.mark.parametrize("m", [0, 1, 4])
def test_legendre_functions_agree_with_scipy(m):
    x = np.linspace(0.05, 0.95, 6)
    P = legendre(m, x, m + 9)
    for l in range(m, m + 10):
        norm = np.sqrt((2 * l + 1) * scipy.special.factorial(l - m) / scipy.special.factorial(l + m))
        assert np.allclose(P[l - m], (-1) ** m * norm * scipy.special.lpmv(m, l, x), rtol=1e-11)


def test_legendre_functions_stay_orthonormal_at_high_degree():
    x, w = gauss(2100)
    P = legendre(5, x, 2005)[::2][-4:]
    assert np.allclose((P * w) @ P.T, np.eye(4), atol=1e-10)


@pytest.mark.parametrize("m", [0, 2, 5])
def test_values_and_slopes_at_the_surface(m):
    h = 1e-4
    value, slope = legendre_at_surface(m, m + 8)
    assert np.allclose(value, legendre(m, np.zeros(1), m + 8)[:, 0], atol=1e-13)
    low, high = legendre(m, np.array([-h, h]), m + 8).T
    assert np.allclose(slope, (high - low) / (2 * h), atol=1e-5)


@pytest.mark.parametrize("x", [np.array([-0.1, 0.5]), np.array([0.5, 1.01]), np.array([np.nan]), np.array(0.5)])
def test_points_outside_the_hemisphere_are_refused(x):
    with pytest.raises(InputError, match="expected"):
        depth_functions(0, x, 3)


def test_rounding_at_the_ends_is_no_error():
    assert np.allclose(depth_functions(1, np.array([-1e-12, 1 + 1e-12]), 3), depth_functions(1, np.array([0.0, 1.0]), 3))
