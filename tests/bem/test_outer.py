"""The stored outer domain: against the map it was made from, the exact hemisphere in time, energy, data it does not have."""

import csv

import numpy as np
import pytest

from ogilvie.bem import outer_build
from ogilvie.bem.outer import OuterMode, depth_functions, outer_mode
from ogilvie.bem.outer_functions import gauss
from ogilvie.bem.outer_initial import initial_memory
from ogilvie.bem.outer_map import outer_map
from ogilvie.errors import InputError

HEAVE = np.array([1 / 2, 1 / 12**0.5])  # cos(theta) in y_00, y_01
MOST = outer_build.FUNCTIONS
MODES = range(outer_build.MODES)


def heave(t):
    """K33 of the floating hemisphere over 2/3 pi rho a^3 g/a."""
    return 3 * np.einsum("i,tij,j->t", HEAVE, outer_mode(0, 2).memory(t), HEAVE)


def surge(t):
    return outer_mode(1, 1).memory(t)[:, 0, 0]


@pytest.mark.parametrize(("m", "allowed"), [(0, 2e-5), (1, 5e-6), (6, 5e-6), (16, 5e-6), (22, 5e-6)])
def test_stored_oscillators_are_the_map(m, allowed):
    omega = np.array([0.013, 0.11, 0.37, 0.83, 1.27, 2.2, 3.9, 6.6, 11.3])  # few of them frequencies of the fit
    sea = outer_map(m, MOST, multipoles=300 if m < 20 else 600)
    exact = np.array([sea.at(w) for w in omega])
    largest = np.abs(exact - sea.at_infinity).max()
    assert np.abs(outer_mode(m, MOST).at(omega) - exact).max() < allowed * largest
    assert np.abs(outer_mode(m, MOST).instantaneous - sea.at_infinity).max() < 1e-8
    assert np.abs(outer_mode(m, MOST).at(np.zeros(1))[0] - sea.at_zero).max() < allowed * largest


@pytest.mark.parametrize("m", [0, 3, 16, 22])
def test_memory_starts_with_its_exact_value(m):
    b = outer_mode(m, MOST).inputs
    assert np.abs(b.T @ b - initial_memory(m, MOST)).max() < 1e-8
    assert np.allclose(outer_mode(m, MOST).memory(np.zeros(1))[0], b.T @ b, atol=1e-9)


@pytest.mark.parametrize("m", MODES)
def test_modes_are_passive_and_decay(m):
    mode = outer_mode(m, MOST)
    omega = np.concatenate([[0.0], np.geomspace(1e-3, 1e3, 400)])
    N = mode.at(omega)
    damping = np.linalg.eigvalsh(-omega[:, None, None] * N.imag)
    assert damping.min() > -1e-10
    assert np.linalg.eigvalsh(mode.instantaneous)[0] > 0
    assert np.linalg.eigvalsh(N[0].real - mode.instantaneous)[0] > -1e-10  # never less than at infinite frequency
    size = np.abs(mode.memory(np.array([0.0, 20.0, 40.0, 100.0]))).max(axis=(1, 2))
    assert np.all(size[1:] < np.array([0.02, 1e-3, 2e-6]) * size[0])


def test_sea_takes_energy_whatever_is_done_to_it():
    """Work on the sea minus the energy stored in its oscillators is never negative, at any time."""
    mode = outer_mode(1, 4)
    n, dt = len(mode.frequencies), 0.002
    rng = np.random.default_rng(2)
    q = np.cumsum(rng.normal(size=(2000, 4)), axis=0) * dt
    W = mode.frequencies
    keep = W < 50.0  # the fast ones would need a smaller step
    W, D, b = W[keep], mode.dampers[keep], mode.inputs[keep]
    w, v, work = np.zeros(len(W)), np.zeros(len(W)), 0.0
    for step in q:
        v = np.linalg.solve(np.eye(len(W)) + dt * D @ D.T, v + dt * (b @ step - W**2 * w))
        work += dt * (b @ step) @ v
        w = w + dt * v
        assert work >= 0.45 * (v @ v + W**2 @ w**2)
    assert n > len(W) > 10


def test_hemisphere_starts_with_the_exact_memory():
    assert np.isclose(heave(np.zeros(1))[0], 3 / 16, rtol=1e-8)
    assert np.isclose(surge(np.zeros(1))[0], 0.54768, rtol=1e-5)


def test_memory_of_the_hemisphere_is_exact(shared_reference):
    with open(shared_reference / "hemisphere_K.csv") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    t, K33, K11 = (np.array([float(row[name]) for row in rows]) for name in ("t", "K33", "K11"))
    assert np.abs(heave(t) - K33).max() < 2e-5 * K33[0]
    assert np.abs(surge(t) - K11).max() < 5e-5 * K11[0]


def test_late_memory_in_heave_keeps_its_algebraic_tail():
    t = np.array([40.0, 60.0, 80.0])
    assert np.allclose(heave(t) * t**4, 9.0, rtol=0.15)
    late = np.geomspace(100, 1000, 20)
    assert np.abs(heave(late) - 9 / late**4).max() < 1e-7 * 3 / 16


def test_fewer_functions_are_the_first_of_more():
    more, fewer = outer_mode(2, 8), outer_mode(2, 3)
    omega = np.array([0.4, 2.0])
    assert np.allclose(fewer.at(omega), more.at(omega)[:, :3, :3], atol=1e-14)


def test_depth_functions_of_the_stored_modes_are_orthonormal():
    x, w = gauss(60)
    for m in MODES:
        y = depth_functions(m, x, MOST)
        assert np.allclose((y * w) @ y.T, np.eye(MOST), atol=1e-10)


@pytest.mark.parametrize(
    ("m", "count", "says"), [(23, 4, "0 to 22"), (-1, 4, "0 to 22"), (2, 17, "1 to 16"), (2, 0, "1 to 16")]
)
def test_what_is_not_stored_is_refused_with_what_is(m, count, says):
    with pytest.raises(InputError, match=says):
        outer_mode(m, count)


def test_stored_arrays_cannot_be_changed():
    with pytest.raises(ValueError, match="read-only"):
        outer_mode(0, 4).inputs[0, 0] = 1.0


@pytest.mark.slow
def test_stored_data_are_computed_again():
    built = outer_build.build_mode(2)
    new = OuterMode(2, built["instantaneous"], built["inputs"], built["dampers"][:, None], built["frequencies"])
    omega = np.geomspace(0.01, 100.0, 60)
    old = outer_mode(2, MOST)
    size = np.abs(old.at(omega) - old.instantaneous).max()
    assert built["error"] < 5e-6
    assert np.abs(new.at(omega) - old.at(omega)).max() < 1e-5 * size
