"""The Neumann-to-Dirichlet map of the outer domain: the exact hemisphere, limits, reciprocity, radiation, K(0+)."""

import csv
from functools import cache

import numpy as np
import pytest

from ogilvie.bem.outer_functions import depth_functions
from ogilvie.bem.outer_initial import _amplitudes, initial_memory
from ogilvie.bem.outer_map import OuterMap, extrapolated, outer_map
from ogilvie.bem.outer_short_waves import short_waves
from ogilvie.errors import InputError

HEAVE = np.array([1 / 2, 1 / 12**0.5])  # cos(theta) in y_00, y_01
#: Ka: added mass and damping in heave, over 2/3 pi rho a^3 and that times omega; Hulme's (1982) multipole expansion, rounded
HULME = {0.1: (0.8627, 0.1816), 0.2: (0.7938, 0.2793), 1.0: (0.4284, 0.2484), 2.0: (0.3884, 0.1031)}


@cache
def sea(m: int, count: int = 6, multipoles: int = 300) -> OuterMap:
    return outer_map(m, count, multipoles=multipoles)


def heave(k0: float) -> complex:
    return complex(3 * HEAVE @ sea(0).at(k0**0.5)[:2, :2] @ HEAVE)


@pytest.mark.parametrize("k0", HULME)
def test_floating_hemisphere_in_heave_as_published(k0):
    assert (round(heave(k0).real, 4), round(-heave(k0).imag, 4)) == HULME[k0]


def test_floating_hemisphere_is_exact_in_heave_and_surge(shared_reference):
    with open(shared_reference / "hemisphere_exact.csv") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    for row in rows[::7]:
        k0 = float(row["Ka"])
        surge = sea(1).at(k0**0.5)[0, 0]
        exact = [float(row[name]) for name in ("mu33", "lam33", "mu11", "lam11")]
        found = [heave(k0).real, -heave(k0).imag, surge.real, -surge.imag]
        assert np.allclose(found, exact, rtol=0, atol=2e-9), k0


@pytest.mark.parametrize("m", [0, 1, 5])
def test_limits_of_the_hemisphere_and_of_one_multipole(m):
    assert np.isclose(sea(m).at_zero[0, 0], 1 / (m + 1), rtol=1e-12)  # y_m0 / r^(m+1) itself flows past the wall y = 0
    if m == 0:
        assert np.isclose(3 * HEAVE @ sea(0).at_infinity[:2, :2] @ HEAVE, 0.5, rtol=1e-10)
    if m == 1:
        assert np.isclose(sea(1).at_infinity[0, 0], 4 / np.pi - 1, rtol=1e-9)


@pytest.mark.parametrize("m", [0, 1, 5, 16])
def test_map_tends_to_its_limits(m):
    N, zero = sea(m).at(1e-4), sea(m).at_zero
    assert np.abs(N - zero).max() < 1e-6
    rest = [sea(m).at(w) - sea(m).at_infinity for w in (10.0, 20.0)]
    first = initial_memory(m, 6)
    missing = [np.abs(L + first / w**2).max() for L, w in zip(rest, (10.0, 20.0), strict=True)]
    assert missing[1] < missing[0] / 4
    assert missing[1] < 1e-3


@pytest.mark.parametrize("omega", [0.3, 1.2, 4.0])
@pytest.mark.parametrize("m", [0, 1, 9, 16])
def test_map_is_reciprocal_and_radiates_one_wave(m, omega):
    N = sea(m).at(omega)
    damping = np.linalg.eigvalsh(-omega * N.imag)
    assert np.abs(N - N.T).max() < 1e-13
    assert damping[0] > -1e-13
    assert np.abs(damping[:-1]).max() < 1e-12 * max(damping[-1], 1e-3)
    assert np.linalg.eigvalsh(sea(m).at_infinity)[0] > 0


@pytest.mark.parametrize("m", [0, 3])
def test_sums_converge_with_the_fourth_power_and_faster_when_extrapolated(m, monkeypatch):
    exact = sea(m, 12, 500).at(1.0)
    fast = [np.abs(sea(m, 12, n).at(1.0) - exact).max() for n in (100, 200)]
    monkeypatch.setattr("ogilvie.bem.outer_map.extrapolated", lambda sums, h, powers: sums[0])
    plain = [np.abs(sea(m, 12, n).at(1.0) - exact).max() for n in (100, 200)]
    assert 3.6 < np.log2(plain[0] / plain[1]) < 4.4
    assert fast[1] < 0.05 * plain[1]
    assert np.log2(fast[0] / fast[1]) > 4.5


def test_extrapolation_is_exact_for_its_powers():
    h = np.array([0.1, 0.15, 0.2])
    sums = np.array([[2.0 + x**4 - 3 * x**5, 1.0 - x**5] for x in h])
    assert np.allclose(extrapolated(sums, h, (4.0, 5.0)), [2.0, 1.0], rtol=1e-12)


def test_zero_frequency_is_refused():
    with pytest.raises(InputError, match="omega > 0"):
        sea(0).at(0.0)


def test_memory_after_an_impulse_of_the_hemisphere():
    assert np.isclose(3 * HEAVE @ initial_memory(0, 2) @ HEAVE, 3 / 16, rtol=1e-9)
    assert np.isclose(initial_memory(1, 1)[0, 0], 0.54768, rtol=1e-5)


@pytest.mark.parametrize("m", [0, 4])
def test_memory_after_an_impulse_is_the_sum_over_multipoles(m):
    """sum_ll' a_l a_l' / (l + l' + 2), which converges like log(n) / n: extrapolated from its partial sums."""
    l, a = _amplitudes(m, 3, 2400)
    stops = np.array([300, 400, 500, 650, 800, 1000])
    sums = np.array([a[:n].T @ (1 / (l[:n, None] + l[:n] + 2)) @ a[:n] for n in stops])
    h = 1 / (l[stops - 1] + 1.5)
    basis = np.column_stack([np.ones(6)] + [h**p * f for p in (1, 2) for f in (np.log(h), np.ones(6))])
    limit = np.linalg.lstsq(basis / np.abs(basis).max(axis=0), sums.reshape(6, -1), rcond=None)[0][0]
    assert np.allclose(limit.reshape(3, 3), initial_memory(m, 3), atol=1e-7)


@pytest.mark.slow
def test_short_waves_continue_the_multipoles():
    m = 7
    many = outer_map(m, 12, multipoles=1000)
    initial, near = initial_memory(m, 12), np.linspace(20.0, 30.0, 12)
    L = np.array([many.at(w) for w in near]) - many.at_infinity
    beyond = np.array([33.0, 36.0])
    exact = np.array([many.at(w) for w in beyond]) - many.at_infinity
    error = short_waves(m, near, L, initial, beyond) - exact
    assert np.abs(error).max() < 1e-4 * np.abs(exact).max()
    assert np.abs(error[:, 0, 0]).max() < 5e-6 * np.abs(exact).max()


@pytest.mark.parametrize("m", [0, 1, 6])
def test_short_waves_are_those_of_a_plane_wall(m):
    surface = depth_functions(m, np.zeros(1), 1)[0, 0]
    damping = -sea(m, 1).at(18.0).imag[0, 0] * 18.0**4
    assert np.isclose(damping, 2 * surface**2, rtol=0.12)


def test_waves_that_are_not_short_are_refused():
    with pytest.raises(InputError, match=r"frequencies >= 14"):
        short_waves(0, np.linspace(5, 20, 12), np.zeros((12, 1, 1)), np.eye(1), np.array([30.0]))
