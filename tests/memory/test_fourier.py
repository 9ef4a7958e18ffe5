"""Fourier integrals of piecewise polynomials against closed forms."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import exp1

from ogilvie.memory.fourier import fourier_integral, legendre_pieces
from ogilvie.memory.tail import Tail, fit_tail, power_integral

S = np.array([0.0, 1e-6, 0.3, 2.0, 50.0, 3000.0])


def exact_monomial(n, a, b, s):
    """int_a^b x^n exp(isx) dx by repeated integration by parts."""
    if s == 0:
        return (b ** (n + 1) - a ** (n + 1)) / (n + 1)
    edge = (b**n * np.exp(1j * s * b) - a**n * np.exp(1j * s * a)) / (1j * s)
    return edge - (n / (1j * s) * exact_monomial(n - 1, a, b, s) if n else 0.0)


@pytest.mark.parametrize("n", [0, 1, 2, 3])
def test_spline_integrates_cubics_exactly(n):
    x = np.array([0.0, 0.4, 0.7, 1.5, 2.0, 2.2])
    F = fourier_integral(x, legendre_pieces(x, x**n, "spline"), S)
    exact = [exact_monomial(n, 0.0, 2.2, s) for s in S if s > 1e-3]
    assert np.allclose(F[S > 1e-3], exact, rtol=1e-11, atol=1e-12)
    assert np.allclose(F[:2], 2.2 ** (n + 1) / (n + 1), rtol=1e-5)


def test_linear_integrates_the_polygon_exactly():
    x, f = np.array([0.0, 0.5, 2.0]), np.array([1.0, 3.0, -1.0])
    F = fourier_integral(x, legendre_pieces(x, f, "linear"), [4.0])[0]
    parts = [quad(lambda u: np.interp(u, x, f) * g(4 * u), 0, 2, points=[0.5], epsabs=1e-12)[0] for g in (np.cos, np.sin)]
    assert np.isclose(F, parts[0] + 1j * parts[1], atol=1e-11)


@pytest.mark.parametrize(("interpolation", "order"), [("linear", 2), ("spline", 4)])
def test_convergence_order(interpolation, order):
    def error(n):
        x = np.linspace(0.0, 3.0, n + 1)
        F = fourier_integral(x, legendre_pieces(x, np.exp(-x), interpolation), [5.0])[0]
        return abs(F - (1 - np.exp((5j - 1) * 3)) / (1 - 5j))

    assert order - 0.1 < np.log2(error(40) / error(80)) < order + 1.1


def test_power_integral_is_the_exponential_integral_at_p_one_step_up():
    """E_2(z) = exp(-z) - z E_1(z) with z = -i s."""
    s = np.array([1e-3, 0.2, 1.0, 7.0, 100.0])
    z = -1j * s
    assert np.allclose(power_integral(np.array([2.0]), s)[:, 0], np.exp(-z) - z * exp1(z), rtol=1e-8)


def test_tail_equals_quadrature():
    tail, omega_N, t = Tail(2.0, 3.3, -0.7), 1.7, 0.9
    x = np.linspace(0, 16, 400_001)  # omega = omega_N exp(x): integrand decays, fine steps
    omega = omega_N * np.exp(x)
    B = 2.0 * (omega / omega_N) ** -3.3 * np.exp(-0.7 * ((omega_N / omega) ** 2 - 1))
    keep = omega < 400
    numeric = np.trapezoid((B * np.exp(1j * omega * t) * omega)[keep], x[keep])
    assert abs(tail.integral(omega_N, [t])[0] - numeric) < 2e-5


def test_fit_recovers_the_law_it_assumes():
    omega = np.linspace(0.1, 3.0, 60)
    B = omega**-3.0 * np.exp(-1.5 / omega**2)
    tail = fit_tail(omega, B)
    assert tail is not None
    assert np.isclose(tail.p, 3.0)
    assert np.isclose(tail.c, -1.5 / 9)


@pytest.mark.parametrize("B", [np.sin(np.linspace(0, 12, 60)), np.linspace(0, 1, 60) ** 2, np.zeros(60)])
def test_no_tail_is_invented(B):
    assert fit_tail(np.linspace(0.1, 3.0, 60), B) is None
