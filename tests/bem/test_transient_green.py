"""The transient Green function against exact sums, contour integrals, closed forms and the equations that it obeys."""

from functools import cache

import numpy as np
import pytest
from scipy.special import dawsn, jv

import ogilvie.bem.transient_green_kernel as kernel
from ogilvie.bem.transient_green import transient_green
from ogilvie.bem.transient_green_table import chebyshev_table
from ogilvie.errors import InputError

MU = np.array([0.0, 1 / 1024, 1 / 64, 0.125, 0.3125, 0.5, 0.75, 0.90625, 0.984375, 1023 / 1024, 1.0])
BETA = np.array([0.5, 3.0, 6.0, 8.75, 10.5, 11.96875, 12.03125, 14.0, 20.0, 40.0])


def integrals(mu, beta):
    """Return F, -F'', H/s (n, 3)."""
    mu, beta = (np.ascontiguousarray(a.ravel(), dtype=float) for a in np.broadcast_arrays(mu, beta))
    out = np.empty((len(mu), 3))
    kernel.fill_scattered(mu, beta, chebyshev_table(), out)
    return out


@cache
def exact(mu, beta):
    """Return F, -F'', H/s by the power series in integers scaled by 2^bits: exact for mu, beta that are binary fractions.

    b_n = (-1)^n beta^(2n+1) (n+1)!/(2n+1)!; F = sum b_n P_{n+1}, -F'' = sum b_n (n+2) P_{n+2}, H/s = sum b_n P'_{n+2}.
    Terms reach exp(beta^2/4); the scale has 120 bits more than that.
    """
    bits = int(0.25 * beta**2 / np.log(2.0)) * 2 + 200
    one = 1 << bits
    m, x, b = int(mu * 2**20) << (bits - 20), int(beta * 2**20), int(beta * 2**20) << (bits - 20)
    assert m / one == mu
    assert x / 2**20 == beta
    P, before, dP, d_before = m, one, one, 0  # P_1, P_0, P'_1, P'_0
    sums = [0, 0, 0]
    n = 0
    while abs(b) * (n + 3) ** 2 > 1 << 60 or n < 4:
        after = ((2 * n + 3) * m * P - (n + 1) * before * one) // ((n + 2) * one)  # P_{n+2}
        d_after = (2 * n + 3) * P + d_before  # P'_{n+2}
        sums[0] += b * P // one
        sums[1] += b * (n + 2) * after // one
        sums[2] += b * d_after // one
        before, P, d_before, dP = P, after, dP, d_after
        b = -b * x * x * (n + 2) // ((2 * n + 2) * (2 * n + 3) << 40)
        n += 1
    return tuple(s / one for s in sums)


def largest(beta):
    """Return the size of F, -F'', H/s at this beta where they are largest (mu = 0; H/s also near mu = 1 for small beta)."""
    return np.array([0.7 * beta + 1.0, 0.18 * beta**3 + 1.0, 0.18 * beta**3 + 1.0])


@pytest.mark.parametrize("beta", BETA)
def test_integrals_are_those_of_the_exact_power_series(beta):
    error = integrals(MU, beta) - [exact(m, beta) for m in MU]
    assert np.all(np.abs(error) <= 1e-12 * largest(beta))


@pytest.mark.parametrize("mu", [0.0, 0.25, 1.0])
def test_integrals_at_large_beta(mu):
    # phase s beta^2/4 = 1000 rad: rounding of the phase alone is 1e-13
    assert np.all(np.abs(integrals(mu, 64.0)[0] - exact(mu, 64.0)) < 1e-12 * largest(64.0))


def test_no_step_where_the_expansions_meet():
    mu = np.linspace(0.0, 1.0, 401)
    step = np.abs(integrals(mu, np.nextafter(12.0, 0.0)) - integrals(mu, 12.0)).max(axis=0)
    assert np.all(step < 1e-12 * largest(12.0))


def test_at_the_surface_it_is_a_product_of_bessel_functions():
    beta = np.concatenate([np.linspace(0.1, 40.0, 200), [100.0, 200.0]])
    x = beta**2 / 8
    bessel = np.pi * beta**3 / (16 * np.sqrt(2)) * (jv(0.25, x) * jv(-0.25, x) + jv(0.75, x) * jv(-0.75, x))
    np.testing.assert_allclose(integrals(0.0, beta)[:, 0], bessel, atol=2e-9, rtol=0)


def test_below_its_source_it_is_dawsons_function():
    # int k^(1/2) sin(beta k^(1/2)) exp(-k) dk = -2 d^2/dbeta^2 D(beta/2), D'' = (4 x^2 - 2) D - 2 x
    beta = np.linspace(0.0, 25.0, 300)
    x = beta / 2
    closed = -0.5 * ((4 * x**2 - 2) * dawsn(x) - 2 * x)
    np.testing.assert_allclose(integrals(1.0, beta)[:, 0], closed, atol=1e-11, rtol=0)


def test_mean_over_angle_of_complex_gaussians():
    """J_0 is the mean of exp(-i k s cos a): F is a mean of Dawson functions of complex argument, valid for mu not near 0."""
    from scipy.special import wofz

    a = (np.arange(4000) + 0.5) * np.pi / 4000
    for mu in (0.2, 0.6, 0.95):
        c = mu + 1j * np.sqrt(1 - mu**2) * np.cos(a)
        for beta in (2.0, 9.0, 13.0, 60.0):
            z = beta / (2 * np.sqrt(c))
            D = 0.5j * np.sqrt(np.pi) * (np.exp(-z * z) - wofz(z))
            second = ((4 * z**2 - 2) * D - 2 * z) / (4 * c)  # d^2/dbeta^2 of D(beta/(2 c^(1/2)))
            F = np.mean(-2 * second / np.sqrt(c)).real
            assert abs(integrals(mu, beta)[0, 0] - F) < 1e-10


def test_clements_equation_holds_in_both_regions():
    h = 0.02
    i = np.arange(-4, 5)
    first = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280]) / h
    second = np.array([-1 / 560, 8 / 315, -1 / 5, 8 / 5, -205 / 72, 8 / 5, -1 / 5, 8 / 315, -1 / 560]) / h**2
    for mu in (0.0, 0.1, 0.7, 1.0):
        for beta in (5.0, 11.9, 12.1, 30.0):
            F, F2, _ = integrals(mu, beta + h * i).T
            F2 = -F2
            left = second @ F2 + mu * beta * (first @ F2) + (beta**2 / 4 + 4 * mu) * F2[4] + 1.75 * beta * (first @ F)
            size = (beta**2 / 4 + 4) * (0.18 * beta**3 + 1.0)
            assert abs(left + 2.25 * F[4]) < 1e-6 * size


def test_gradient_is_the_derivative_of_the_value():
    rng = np.random.default_rng(1)
    x, xi = rng.normal(size=(2, 60, 3))
    x[:, 2], xi[:, 2] = -np.abs(x[:, 2]), -np.abs(xi[:, 2])
    x[:5, :2] = xi[:5, :2] + 1e-7  # nearly on the axis
    t, h = rng.uniform(0.5, 12.0, 60), 1e-3
    gradient = transient_green(x, xi, t, g=9.81).gradient
    for k in range(3):
        e = h * np.eye(3)[k]
        down, up = (x - e, x) if k == 2 else (x - e, x + e)  # one-sided in z: stay below the water
        if k == 2:
            f0, f1, f2 = (transient_green(x - n * e, xi, t).value for n in (0, 1, 2))
            numerical = (3 * f0 - 4 * f1 + f2) / (2 * h)
        else:
            numerical = (transient_green(up, xi, t).value - transient_green(down, xi, t).value) / (2 * h)
        scale = np.abs(gradient).max(axis=1) + 1.0
        r = np.sqrt(((x - xi) ** 2)[:, :2].sum(axis=1) + (x + xi)[:, 2] ** 2)
        third = (1 + 9.81 * t**2 / (4 * r**2)) ** 3  # bound of the third derivative's growth
        assert np.all(np.abs(numerical - gradient[:, k]) < scale * (1e-7 + h**2 * third))


def test_free_surface_condition_and_laplace():
    x, xi, t = np.array([0.7, -0.4, -0.3]), np.array([0.0, 0.2, -0.5]), 2.3
    h = 0.01
    values = transient_green(x, xi, t + h * np.array([-2, -1, 0, 1, 2]), g=9.81)
    G_tt = np.array([-1, 16, -30, 16, -1]) @ values.value / (12 * h**2)
    assert G_tt == pytest.approx(-9.81 * values.gradient[2, 2], rel=1e-4)
    laplacian = 0.0
    for k in range(3):
        e = 1e-3 * np.eye(3)[k]
        up, down = (transient_green(x + s * e, xi, t).gradient[k] for s in (1, -1))
        laplacian += (up - down) / 2e-3
    assert abs(laplacian) < 1e-4 * np.abs(values.gradient[2]).max()


def test_it_is_symmetric_and_zero_at_the_start():
    x, xi = np.array([0.3, 0.1, -0.2]), np.array([-0.5, 0.8, -1.1])
    one, other = transient_green(x, xi, 1.7), transient_green(xi, x, 1.7)
    assert one.value == pytest.approx(other.value, rel=1e-14)
    np.testing.assert_allclose(one.gradient, other.gradient * [-1, -1, 1], rtol=1e-13)
    assert transient_green(x, xi, 0.0).value == pytest.approx(0.0, abs=1e-12)


def test_froude_scaling():
    x, xi = np.array([0.3, 0.1, -0.2]), np.array([-0.5, 0.8, -1.1])
    small, large = transient_green(x, xi, 1.7), transient_green(4 * x, 4 * xi, 2 * 1.7)
    assert large.value == pytest.approx(small.value / 8, rel=1e-12)
    np.testing.assert_allclose(large.gradient, small.gradient / 32, rtol=1e-11)


def test_long_time_integral_is_the_rigid_wall_image():
    """int_0^inf G_f dt = 2/r': a steady source under a free surface ends up under a wall. The rest is int 8/(g t^3)."""
    x, xi = np.array([0.3, 0.1, -0.6]), np.array([-0.5, 0.8, -1.1])
    t = np.linspace(0.0, 60.0, 6001)
    f = transient_green(x, xi, t, g=1.0).value
    integral = (f[0::2].sum() * 2 + f[1::2].sum() * 4 - f[0] - f[-1]) * t[1] / 3
    r = np.sqrt(0.64 + 0.49 + 1.7**2)
    assert integral - 4 / 60.0**2 == pytest.approx(2 / r, rel=1e-5)


def test_shapes_broadcast():
    field = np.zeros((4, 1, 1, 3)) + [0, 0, -1.0]
    result = transient_green(field, np.ones((5, 1, 3)) * [1, 1, -1], np.linspace(0, 3, 7))
    assert result.value.shape == (4, 5, 7)
    assert result.gradient.shape == (4, 5, 7, 3)


BELOW = [0.0, 0.0, -1.0]


@pytest.mark.parametrize(
    ("field", "source", "t", "g", "words"),
    [
        ([0, 0, 0.1], BELOW, 1.0, 9.81, "field: finite points with z <= 0"),
        (BELOW, [0, 0, np.nan], 1.0, 9.81, "source: finite"),
        ([0.0, 0.0], BELOW, 1.0, 9.81, r"\(..., 3\) array expected"),
        (BELOW, BELOW, -1.0, 9.81, "t: finite times >= 0"),
        (BELOW, BELOW, 1.0, 0.0, "g: a positive number"),
        ([0.0, 0, 0], [0.0, 0, 0], 1.0, 9.81, "one place of the surface"),
        ([BELOW] * 2, [BELOW] * 3, 1.0, 9.81, "shapes that broadcast"),
        ("here", BELOW, 1.0, 9.81, "arrays of numbers"),
    ],
)
def test_bad_input_is_explained(field, source, t, g, words):
    with pytest.raises(InputError, match=words):
        transient_green(field, source, t, g=g)


def test_history_of_pairs_is_the_same_function():
    rng = np.random.default_rng(3)
    x, xi, n = rng.normal(size=(3, 6, 3))
    x[:, 2], xi[:, 2] = -np.abs(x[:, 2]), -np.abs(xi[:, 2])
    weight = rng.uniform(0.5, 2.0, 6)
    G, Gn = np.zeros((2, 6, 90, 6))
    kernel.fill_history(x, xi, n, weight, 9.81, 0.1, 1, chebyshev_table(), G, Gn)
    t = 0.1 * np.arange(1, 91)
    wanted = transient_green(x[:, None, None], xi[None, None], t[None, :, None])
    np.testing.assert_allclose(G, wanted.value * weight, rtol=1e-9, atol=1e-9 * np.abs(G).max())
    normal = np.einsum("imjk,jk->imj", wanted.gradient * [-1, -1, 1], n) * weight
    np.testing.assert_allclose(Gn, normal, rtol=1e-9, atol=1e-9 * np.abs(Gn).max())
