"""Impulse responses: against exponentials of matrices, and that nothing can grow."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.linalg import expm

from ogilvie.bem.rational import RationalStep, poles
from ogilvie.bem.stepping import impulse_response
from ogilvie.errors import ConvergenceError, InputError


def system(n=30, r=2, strength=1.0, seed=0):
    """Random stiffness with frequencies up to 12, dampers and inputs."""
    rng = np.random.default_rng(seed)
    Q = np.linalg.qr(rng.normal(size=(n, n)))[0]
    S = Q @ np.diag(np.linspace(0.0, 12.0, n) ** 2) @ Q.T
    return 0.5 * (S + S.T), strength * rng.normal(size=(n, r)), rng.normal(size=(n, 2))


@dataclass
class Late:
    shape: np.ndarray
    rate: np.ndarray
    complete: float = 1.0

    def loss(self, t, h):
        return np.expm1(-self.rate * (min(t / self.complete, 1.0) if self.complete else 1.0) * h)


@pytest.mark.parametrize(("dt", "count"), [(0.03, 40), (0.1, 300), (0.5, 12)])
def test_response_is_that_of_the_exponential(dt, count):
    S, D, h = system()
    n = len(S)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-S, -D @ D.T]])
    E, x = expm(A * dt), np.concatenate([0 * h, h])
    exact = []
    for _ in range(count):
        exact.append(h.T @ x[n:])
        x = E @ x
    found = impulse_response(S, D, h, dt=dt, count=count)
    assert found.K.shape == (count, 2, 2)
    np.testing.assert_allclose(found.K, exact, atol=2e-7 * np.abs(exact).max())


@pytest.mark.parametrize("strength", [0.0, 1.0, 100.0])
@pytest.mark.parametrize("h", [0.01, 1.0, 100.0])
def test_step_of_any_length_contracts(strength, h):
    S, D, _ = system(strength=strength)
    size, turn = np.linalg.eigh(S)
    M = RationalStep(np.sqrt(np.maximum(size, 0)), turn.T @ D, h)(np.eye(60))
    assert np.linalg.norm(M, 2) <= 1.0 + 1e-9


def test_poles_make_the_exponential_and_contract_in_the_left_half_plane():
    def R(z):
        return sum(0.5 * (c / (z - p) + np.conj(c) / (z - np.conj(p))) if p.imag else c / (z - p) for p, c in poles())

    for z in (-0.3, 0.4j, -0.2 + 0.3j):
        assert abs(R(z) - np.exp(z)) < 1e-9
    y = np.linspace(-200.0, 200.0, 4001)
    assert np.abs(R(1j * y)).max() <= 1.0 + 1e-11


def test_energy_never_grows_and_few_or_many_oscillators_agree(monkeypatch):
    S, D, h = system()
    late = Late(np.linalg.qr(np.random.default_rng(1).normal(size=(30, 30)))[0], np.linspace(0.0, 3.0, 30))
    one = impulse_response(S, D, h, dt=0.07, count=400, late=late)
    monkeypatch.setattr("ogilvie.bem.stepping._SMALL", 0)
    two = impulse_response(S, D, h, dt=0.07, count=400, late=late)
    np.testing.assert_allclose(one.K, two.K, atol=1e-10)
    assert one.energy[0] == pytest.approx([1.0, 1.0])
    assert np.all(np.diff(two.energy, axis=0) <= 1e-12)
    np.testing.assert_allclose(two.K, two.K.transpose(0, 2, 1), atol=0)


def test_late_damping_converges_to_the_equation_it_stands_for():
    """z'' + shape diag(rate) shape.T z' + S z = 0 from the start, against the exponential: second order in the step."""
    S, D, h = system(n=12, r=1)
    late = Late(np.eye(12)[:, :5], np.full(5, 1.5), complete=0.0)
    C = D @ D.T + late.shape @ np.diag(late.rate) @ late.shape.T
    A = np.block([[np.zeros((12, 12)), np.eye(12)], [-S, -C]])
    exact = h.T @ (expm(A * 2.0) @ np.concatenate([0 * h, h]))[12:]
    errors = [
        np.abs(impulse_response(S, D, h, dt=dt, count=round(2 / dt) + 1, late=late).K[-1] - exact).max() for dt in (0.02, 0.01)
    ]
    assert errors[0] < 2e-2 * np.abs(exact).max()
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


def test_bad_input():
    S, D, h = system(n=5)
    with pytest.raises(InputError, match="dt > 0"):
        impulse_response(S, D, h, dt=0.0, count=3)
    with pytest.raises(ConvergenceError, match="eigenvalue of -1"):
        impulse_response(-S, D, h, dt=0.1, count=3)
    assert impulse_response(S - 1e-6 * np.eye(5), D, h, dt=0.1, count=3).least < 0
