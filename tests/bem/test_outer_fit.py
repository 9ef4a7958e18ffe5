"""Oscillators on one damper: poles, passivity, derivatives of the fit, recovery of a known model."""

from dataclasses import replace

import numpy as np
import pytest

from ogilvie.bem.outer_fit import descended, fitted, with_initial
from ogilvie.bem.outer_oscillators import Problem, solved
from ogilvie.bem.outer_poles import common_poles, damped_oscillators, phase

OMEGA = np.concatenate([[0.0], np.geomspace(0.02, 20.0, 250)])


def known(n=5, J=3, seed=1):
    rng = np.random.default_rng(seed)
    return np.geomspace(0.3, 4.0, n), rng.normal(size=(n, J)), 0.4 + rng.uniform(size=n)


def response(w, b, d, omega=OMEGA):
    return b.T @ solved(w, b, d, omega)


def problem_of(w, b, d):
    initial = b.T @ b
    return Problem(OMEGA, response(w, b, d), np.ones(len(OMEGA)), initial, 1.0)


def poles_of(w, d):
    n = len(w)
    return np.linalg.eigvals(np.block([[-np.outer(d, d), -np.diag(w)], [np.diag(w), np.zeros((n, n))]]))


@pytest.mark.parametrize("n", [1, 4, 12])
def test_any_stable_poles_belong_to_oscillators_on_one_damper(n):
    rng = np.random.default_rng(n)
    upper = -rng.uniform(0.05, 3.0, n) + 1j * rng.uniform(0.1, 5.0, n)
    poles = np.concatenate([upper, upper.conj()])
    if n > 1:  # two real poles in place of a pair
        poles[[0, n]] = -0.2, -7.0
    w, d = damped_oscillators(poles)
    assert np.all(d > 0)
    assert np.all(np.diff(w) > 0)
    assert np.allclose(np.sort_complex(poles_of(w, d)), np.sort_complex(poles), rtol=1e-7, atol=1e-7)


def test_phase_of_the_poles_turns_half_a_circle_per_pair():
    poles = np.array([-0.3 + 1j, -0.3 - 1j, -0.5, -2.0])
    assert np.allclose(phase(poles, np.array([0.0, 1e9])), [0.0, 2 * np.pi], atol=1e-8)


def test_common_poles_of_a_known_model_are_found():
    w, b, d = known()
    i, j = np.triu_indices(3)
    found = common_poles(OMEGA, response(w, b, d)[:, i, j], np.ones(len(OMEGA)), 5)
    assert np.allclose(np.sort_complex(found), np.sort_complex(poles_of(w, d)), atol=1e-7)


@pytest.mark.parametrize("seed", range(4))
def test_any_parameters_are_passive_and_reciprocal(seed):
    w, b, d = known(8, 4, seed)
    L = response(w, b, d)
    damping = -OMEGA[:, None, None] * L.imag
    assert np.allclose(L, L.transpose(0, 2, 1), atol=1e-11)
    assert np.linalg.eigvalsh(damping).min() > -1e-11
    assert np.linalg.eigvalsh(L[0].real).min() > -1e-11
    high = np.array([1e4])
    assert np.allclose(-(high**2)[:, None, None] * response(w, b, d, high).real, b.T @ b, rtol=1e-5, atol=1e-5)


def test_normal_equations_are_those_of_the_differences():
    w, b, d = known()
    rng = np.random.default_rng(0)
    problem = replace(problem_of(w, b, d), weight=rng.uniform(0.5, 2.0, len(OMEGA)), initial_weight=0.7)
    p = np.concatenate([np.log(w), b.ravel(), d])
    p = p + 0.1 * rng.normal(size=len(p))

    def residual(p):
        b = problem.split(p)[1]
        E = (np.sqrt(problem.weight)[:, None, None] * problem.error(p)).ravel()
        return np.concatenate([E.real, E.imag, np.sqrt(0.7) * (b.T @ b - problem.initial).ravel()])

    cost, gradient, normal = problem.normal(p)
    h = 1e-6
    J = np.array([(residual(p + h * e) - residual(p - h * e)) / (2 * h) for e in np.eye(len(p))]).T
    assert np.isclose(cost, residual(p) @ residual(p), rtol=1e-12)
    assert np.isclose(cost, problem.cost(p), rtol=1e-12)
    assert np.allclose(gradient, J.T @ residual(p) / 2, atol=1e-7 * np.abs(gradient).max())
    assert np.allclose(normal, J.T @ J / 2, atol=1e-7 * np.abs(normal).max())


def test_descent_finds_the_minimum_from_nearby():
    w, b, d = known()
    exact = np.concatenate([np.log(w), b.ravel(), d])
    problem = problem_of(w, b, d)
    start = exact + 0.002 * np.random.default_rng(3).normal(size=len(exact))
    assert problem.cost(descended(problem, start, 60)) < 1e-16 * problem.cost(start)


def test_known_model_is_recovered_from_its_response():
    w, b, d = known()
    w1, b1, d1 = fitted(OMEGA, response(w, b, d), b.T @ b, 5)
    assert np.allclose(np.sort(w1), w, rtol=1e-6)
    assert np.allclose(response(w1, b1, d1), response(w, b, d), atol=1e-7)


def test_initial_memory_is_imposed_exactly_and_hardly_moves_the_fit():
    w, b, d = known()
    rng = np.random.default_rng(5)
    change = 1e-3 * rng.normal(size=b.shape)
    problem = problem_of(w, b, d)
    p = with_initial(problem, np.concatenate([np.log(w), (b + change).ravel(), d]))
    moved = problem.split(p)[1]
    assert np.allclose(moved.T @ moved, problem.initial, rtol=1e-12)
    assert np.linalg.norm(moved - b) < 1.5 * np.linalg.norm(change)
