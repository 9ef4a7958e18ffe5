"""The wave source multipole: the defining integral, Laplace's equation, the free surface, radiated energy."""

import numpy as np
import pytest
import scipy.special

from ogilvie.bem.outer_functions import gauss, legendre, legendre_at_surface
from ogilvie.bem.outer_map import outer_map
from ogilvie.bem.outer_waves import double_factorial, wave_source

X = np.array([0.3, 0.6, 0.7, 0.72, 0.99])  # both sides of the change of ray


def on_the_real_axis(m: int, k0: float, x: float) -> complex:
    """The principal value by pairs of points on both sides of the pole, the rest by many small panels."""
    R = np.sqrt(1 - x * x)

    def g(k):
        return k ** (m + 1) * np.exp(-k * x) * scipy.special.jv(m, k * R)

    u, w = gauss(300)
    total = np.sum(w * (g(k0 * (1 + u)) - g(k0 * (1 - u))) / u)
    u, w = gauss(20)
    edges = 2 * k0 + np.append(0.0, np.geomspace(0.1 * k0 + 0.01, (120 + 6 * m) / x, 300))
    k = edges[:-1, None] + np.diff(edges)[:, None] * u
    total += np.sum(np.diff(edges)[:, None] * w * g(k) / (k - k0))
    return (total + 1j * np.pi * g(k0)) / double_factorial(m)


@pytest.mark.parametrize("k0", [1e-3, 0.3, 1.0, 5.0])
@pytest.mark.parametrize("m", [0, 1, 2, 6])
def test_wave_source_is_its_defining_integral(m, k0):
    exact = np.array([on_the_real_axis(m, k0, x) for x in X])
    assert np.abs(wave_source(m, X).at(k0)[0] - exact).max() <= 1e-12 * np.abs(exact).max()


@pytest.mark.parametrize("m", [0, 1, 4, 12, 16])
def test_radial_derivative_follows_from_the_change_with_frequency(m):
    """S(r; k0) = r^-(m+1) S(1; k0 r), hence dS/dr = -(m + 1) S + k0 dS/dk0 at r = 1."""
    source, k0, h = wave_source(m, X), 1.3, 1e-3
    S = {i: source.at(k0 * (1 + i * h))[0] for i in (-3, -2, -1, 1, 2, 3)}
    change = (45 * (S[1] - S[-1]) - 9 * (S[2] - S[-2]) + S[3] - S[-3]) / (60 * h)
    value, slope = source.at(k0)
    assert np.abs(slope - (change - (m + 1) * value)).max() <= 1e-10 * np.abs(slope).max()


@pytest.mark.parametrize("m", [0, 1, 5])
def test_wave_source_obeys_laplace(m):
    k0, h = 2.0, 2e-3
    x0 = np.array([0.25, 0.5, 0.85])
    angle = np.arccos(x0)

    def S(r, turn):
        return r ** -(m + 1.0) * wave_source(m, np.cos(angle + turn)).at(k0 * r)[0]

    rr = (S(1 + h, 0) - 2 * S(1, 0) + S(1 - h, 0)) / h**2
    r = (S(1 + h, 0) - S(1 - h, 0)) / (2 * h)
    tt = (S(1, h) - 2 * S(1, 0) + S(1, -h)) / h**2
    t = (S(1, h) - S(1, -h)) / (2 * h)
    sine = np.sin(angle)
    residual = rr + 2 * r + tt + t / np.tan(angle) - m**2 / sine**2 * S(1, 0)
    assert np.abs(residual).max() <= 2e-5 * np.abs(rr).max()


@pytest.mark.parametrize("k0", [0.2, 1.0, 8.0])
@pytest.mark.parametrize("m", [0, 1, 5])
def test_wave_source_obeys_the_free_surface(m, k0):
    """phi_y + k0 phi = 0 at y = 0, where d/dy is d/dx on the sphere."""
    h = 0.01
    S = wave_source(m, 1e-12 + h * np.arange(9)).at(k0)[0]
    slope = np.polynomial.Polynomial.fit(h * np.arange(9), S.real, 8).deriv()(0.0)
    slope_i = np.polynomial.Polynomial.fit(h * np.arange(9), S.imag, 8).deriv()(0.0)
    assert np.abs(slope + 1j * slope_i + k0 * S[0]) <= 1e-7 * k0 * np.abs(S[0])


@pytest.mark.parametrize("k0", [0.05, 1.0, 9.0])
@pytest.mark.parametrize("m", [0, 1, 6, 16])
def test_wave_source_radiates_the_energy_of_its_far_wave(m, k0):
    """Through the sphere passes what i pi k0^(m+1) exp(-k0 y) H_m(k0 R) / (2m-1)!! carries away."""
    x, w = gauss(120)
    S, dS = wave_source(m, x).at(k0)
    far = np.pi * k0 ** (2 * m + 1) / double_factorial(m) ** 2
    assert np.isclose(w @ (S.conj() * dS).imag, far, rtol=1e-10)


@pytest.mark.parametrize("k0", [0.05, 1.0, 9.0])
@pytest.mark.parametrize("m", [0, 3])
def test_wave_source_and_wave_free_multipoles_are_reciprocal(m, k0):
    """Green's identity outside the sphere: int (S psi_r - psi S_r) = 0, as all obey Laplace, surface and radiation."""
    x, w = gauss(120)
    sea = outer_map(m, 2, multipoles=8)
    P = legendre(m, x, m + 16)
    S, dS = wave_source(m, x).at(k0)
    l, k = sea.degree[:, None], k0 * sea.ratio[:, None]
    psi, dpsi = P[2::2] + k * P[1::2], -(l + 1) * P[2::2] - k * l * P[1::2]
    assert np.abs((dpsi * w) @ S - (psi * w) @ dS).max() <= 1e-11 * np.abs(dpsi * w) @ np.abs(S) @ np.ones(8)


@pytest.mark.parametrize("m", [0, 2, 7])
def test_wave_free_multipoles_obey_the_free_surface(m):
    sea = outer_map(m, 2, multipoles=20)
    value, slope = legendre_at_surface(m, m + 40)
    assert np.allclose(sea.ratio * slope[1::2], -value[2::2], rtol=1e-12)
