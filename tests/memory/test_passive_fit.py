"""What the passive fit aims at: resonances, weights as one quadratic form, exact derivatives, damping where it decides."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.memory.oscillators import state_space
from ogilvie.memory.passive_fit import Fit
from ogilvie.memory.passive_target import target_of
from ogilvie.memory.passive_weights import root_of_weight
from ogilvie.memory.resonances import find_resonances

OMEGA = np.linspace(0.05, 4.0, 60)


def known(*, damping=0.7):
    """Two coupled dofs, three oscillators on two dampers."""
    b = np.array([[1.0, 0.3], [-0.4, 0.9], [0.5, 0.5]])
    D = np.array([[damping, 0.0], [0.3, 0.8], [-0.5, 0.6]])
    p = np.concatenate([np.log([0.6, 1.1, 1.9]), b.ravel(), D.ravel()])
    return og.StateSpace(*state_space(p, 3, 2, 2), ("heave", "roll"))


def data_of(model):
    """K(t), A and B of a model without any error of transforms."""
    A_inf, t, K_hat = np.array([[3.0, 0.2], [0.2, 2.0]]), np.arange(1201) * 0.05, model.transfer(OMEGA)
    A = A_inf + K_hat.imag / OMEGA[:, None, None]
    return og.Retardation(t, model.impulse(t), A_inf, model.dofs, omega=OMEGA, added_mass=A, radiation_damping=K_hat.real)


def test_resonances_are_where_stiffness_balances_inertia():
    """det[C - w^2 (M + A)] = 0, modes of unit inertia; those outside the data are not found."""
    K = data_of(known())
    M, C = np.array([[5.0, 1.0], [1.0, 4.0]]), np.diag([2.0, 3.0])
    r = find_resonances(OMEGA, K.added_mass, K.radiation_damping, M, C)
    assert len(r.omega) == 2
    for w, phi, A, B in zip(r.omega, r.shape, r.A, r.B, strict=True):
        assert np.linalg.norm((C - w**2 * (M + A)) @ phi) < 1e-8
        assert phi @ (M + A) @ phi == pytest.approx(1.0, abs=1e-9)
        K_hat = known().transfer(w)[0]
        assert np.abs(K_hat.real - B).max() < 1e-3
    assert len(find_resonances(OMEGA, K.added_mass, K.radiation_damping, M, 1e-4 * C).omega) == 0
    assert len(find_resonances(OMEGA, K.added_mass, K.radiation_damping, -10 * M, C).omega) == 0  # no inertia at all


def test_relative_errors_are_of_damping_and_of_frequency():
    """An error of K_hat in proportion to B is that share of damping, less what is uncertain; it moves no frequency."""
    K = data_of(known())
    r = find_resonances(OMEGA, K.added_mass, K.radiation_damping, 4 * np.eye(2), np.diag([2.0, 3.0]))
    e = r.relative(0.01 * r.B.astype(complex))
    assert np.all((e[:2] > 0.0095) & (e[:2] <= 0.01))
    assert not np.any(e[2:])


def test_weights_are_one_quadratic_form():
    rng = np.random.default_rng(0)
    n, m = 4, 3
    i, j = np.triu_indices(m)
    data, memory = rng.uniform(0.1, 1, (n, 2, m, m)), rng.uniform(0.1, 1, (n + 2, m, m))
    motion = rng.standard_normal((n, m, m)) + 1j * rng.standard_normal((n, m, m))
    e = rng.standard_normal((n + 2, m, m)) + 1j * rng.standard_normal((n + 2, m, m))
    e = e + e.transpose(0, 2, 1)
    upper = e[:, i, j]
    root = root_of_weight(data, motion, memory, i, j)
    cost = np.sum((root @ np.concatenate([upper.real, upper.imag], axis=1)[..., None]) ** 2)
    plain = np.sum((data[:, 0, i, j] * upper[:n].real) ** 2) + np.sum((data[:, 1, i, j] * upper[:n].imag) ** 2)
    plain += np.sum(np.abs(motion @ e[:n]) ** 2) + np.sum(memory[:, i, j] ** 2 * np.abs(upper) ** 2)
    assert cost == pytest.approx(plain, rel=1e-12)


@pytest.mark.parametrize("aware", [True, False])
def test_derivatives_of_all_residuals(aware):
    """Motion and resonances, or K(t): exact Jacobian against central differences."""
    K = data_of(known())
    more = (4 * np.eye(2), np.diag([2.0, 3.0])) if aware else (None, None)
    fit = Fit(target_of(K, [0, 1], *more)[0])
    if aware:
        assert fit.aim_at_resonances()
    else:
        fit.weigh_memory(3.0)
    rng = np.random.default_rng(1)
    n = 2
    p = np.concatenate(
        [0.1 * rng.standard_normal(3), np.log([0.7, 1.4]), rng.standard_normal(2 * n), 0.8 * rng.standard_normal(3 * n)]
    )
    residual, J = fit.jacobian(p)
    assert np.allclose(residual, fit.residual(p))
    h = 1e-6
    for k in range(len(p)):
        step = h * (np.arange(len(p)) == k)
        numeric = (fit.residual(p + step) - fit.residual(p - step)) / (2 * h)
        assert np.allclose(J[:, k], numeric, atol=1e-6 * max(1.0, np.abs(J[:, k]).max()))


def test_the_error_of_k_is_that_of_its_transform():
    """Parseval: the residuals of K(t) add up to its squared error over its energy."""
    true, other = known(), known(damping=0.9)
    K = data_of(true)
    target, scale = target_of(K, [0, 1])
    fit = Fit(target)
    fit.weigh_memory(1.0)
    E = np.concatenate([other.transfer(fit.omega) - true.transfer(fit.omega)]) / np.outer(scale, scale)
    alone = fit._weigh(E)
    fit.weigh_memory(0.0)
    cost = alone @ alone - fit._weigh(E[: fit.n_data]) @ fit._weigh(E[: fit.n_data])
    t = np.arange(4000) * 0.02
    a, b = true.impulse(t), other.impulse(t)
    trust = target.beyond.trust
    expected = sum(
        trust[i, j] ** 2 * np.sum((a - b)[:, i, j] ** 2) / np.sum(a[:, i, j] ** 2) for i, j in ((0, 0), (0, 1), (1, 1))
    )
    assert cost == pytest.approx(expected, rel=0.05)


@pytest.mark.filterwarnings("default::ogilvie.errors.OgilvieWarning")
@pytest.mark.parametrize("name", ["fpso", "tanker", "s175", "supply"])
def test_damping_of_roll_at_its_resonance(shared_reference, name):
    """Lightly damped roll: within 1 % of the damping there, half a thousandth of critical added."""
    d = np.load(shared_reference / "radiation" / f"{name}.npz")
    some = d["omega"] > 0
    h = og.hydro_from_arrays(
        omega=d["omega"][some],
        added_mass=d["added_mass"][some],
        radiation_damping=d["radiation_damping"][some],
        added_mass_inf=d["added_mass_inf"] if "added_mass_inf" in d.files else None,
    )
    K = og.retardation(h)
    model = og.identify(K, mass=d["mass"], stiffness=d["stiffness"])
    target, scale = target_of(K, [1, 3, 5], d["mass"], d["stiffness"])
    r = target.resonances
    assert len(r.omega) == 1
    damping = model.transfer(r.omega)[:, [1, 3, 5]][:, :, [1, 3, 5]].real / np.outer(scale, scale)
    assert abs(r.project(damping - r.B)[0]) / r.damping[0] < 0.01
