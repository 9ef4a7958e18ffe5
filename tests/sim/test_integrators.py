"""Order, exactness and stability of the time stepping."""

import numpy as np
import pytest
import scipy.linalg

import ogilvie as og
from ogilvie.loads.base import MemoryModel
from ogilvie.sim.integrate import exact_step, memory_step, step_matrix
from ogilvie.sim.modes import modal_memory
from ogilvie.sim.system import assemble

START = {"eta": [1.0, 2.0, 0.5, 0.1, 0.05, 0.1], "nu": [0.5, 0.3, 0.2, 0.01, 0.02, 0.03]}
SHIFTED = {"eta": START["eta"]}


def calm(barge, radiation):
    return og.Vessel(barge.body, loads=(*barge.others[:3], radiation))


def free_decay(vessel, start, duration):
    """The matrix exponential of the whole vessel."""
    A = assemble(vessel).closed_loop()
    z = np.zeros(len(A))
    z[:6] = start["eta"]
    z[6:12] = start.get("nu", 0.0)
    return (scipy.linalg.expm(A * duration) @ z)[:12]


def final(run):
    return np.concatenate([run.eta.values[-1], run.nu.values[-1]])


def errors(vessel, start, steps, reference, duration):
    scale = np.abs(np.concatenate([START["eta"], START["nu"]]))
    return [
        np.linalg.norm((final(og.simulate(vessel, duration=duration, dt=dt, initial=start)) - reference) / scale)
        for dt in steps
    ]


def slopes(values):
    return np.log2(np.array(values[:-1]) / np.array(values[1:]))


@pytest.mark.parametrize("start", [START, SHIFTED], ids=["moving", "displaced"])
def test_state_space_is_of_fourth_order(barge, start):
    vessel = calm(barge, og.StateSpaceRadiation(barge.model))
    e = errors(vessel, start, (0.2, 0.1, 0.05, 0.025), free_decay(vessel, start, 12.0), 12.0)
    assert slopes(e)[-1] == pytest.approx(4.0, abs=0.1)


def test_convolution_is_of_fourth_order(barge):
    t = np.arange(0.0, 30.0, 0.005)
    K = og.Retardation(t, barge.model.impulse(t), barge.model.A_inf)
    reference = free_decay(calm(barge, og.StateSpaceRadiation(barge.model)), SHIFTED, 3.2)
    e = errors(calm(barge, og.Convolution(K)), SHIFTED, (0.05, 0.025, 0.0125), reference, 3.2)
    assert slopes(e)[-1] == pytest.approx(4.0, abs=0.1)


def test_undamped_oscillator_is_of_fourth_order():
    """Phase error of order 4; the amplitude decays at order 5, so energy does not grow."""
    body = og.RigidBody(mass=2.0, cog=[0, 0, 0], inertia=np.eye(3))
    vessel = og.Vessel(body, loads=og.LinearRestoring(np.diag([0, 0, 8.0, 0, 0, 0])))
    error, loss = [], []
    for dt in (0.1, 0.05, 0.025):
        run = og.simulate(vessel, duration=40.0, dt=dt, initial={"eta": [0, 0, 1.0, 0, 0, 0]})
        z, w = run.eta.values[:, 2], run.nu.values[:, 2]
        error.append(np.abs(z - np.cos(2.0 * run.time.values)).max())
        energy = 4.0 * z**2 + w**2
        assert np.all(np.diff(energy) <= 1e-14)
        loss.append(1.0 - energy[-1] / energy[0])
    assert slopes(error)[-1] == pytest.approx(4.0, abs=0.1)
    assert slopes(loss)[-1] == pytest.approx(5.0, abs=0.1)


@pytest.mark.parametrize("dt", [0.05, 0.7, 4.0])
def test_exact_method_is_the_matrix_exponential_at_any_step(barge, dt):
    vessel = calm(barge, og.StateSpaceRadiation(barge.model))
    run = og.simulate(vessel, duration=28.0, dt=dt, initial=START, method="exact")
    assert final(run) == pytest.approx(free_decay(vessel, START, 28.0), rel=1e-9, abs=1e-10)


def test_exact_step_of_a_quadratic_force():
    """z' = -2 z + 1 + t + t^2 has a closed-form solution."""
    transition, source = exact_step(np.array([[-2.0]]), np.array([[1.0]]), 0.7)
    f = [1 + t + t * t for t in (0.0, 0.35, 0.7)]
    particular = lambda t: t**2 / 2 + 0.5  # noqa: E731
    exact = particular(0.7) + (3.0 - particular(0.0)) * np.exp(-1.4)
    assert transition[0, 0] * 3.0 + source[0, :, 0] @ f == pytest.approx(exact, rel=1e-12)


def test_memory_step_without_poles_is_the_classical_method():
    """For A = 0 the exponential method must be the classical Runge-Kutta method: Simpson's rule for x' = B v."""
    rng = np.random.default_rng(3)
    B, C = rng.normal(size=(2, 6)), rng.normal(size=(6, 2))
    step = memory_step(np.zeros((2, 2)), B, C, 0.3)
    for i, weight in enumerate((1, 2, 2, 1)):
        assert step.source[i] == pytest.approx(0.3 * weight / 6.0 * B, abs=1e-12)
    assert step.coupling[3, 2] == pytest.approx(0.3 * C @ B, abs=1e-12)
    assert np.abs(step.coupling[3, :2]).max() < 1e-12


@pytest.mark.parametrize("fast", [1.0, 1e3])
def test_kernel_equals_step_matrix(barge, fast):
    """The compiled loop and the matrix of one step, multiplied up, are the same; also with a pole far beyond 1/dt."""
    m = barge.model
    A = scipy.linalg.block_diag(m.A, [[-fast]])
    B = np.vstack([m.B, np.full((1, 6), 1e3)])
    C = np.hstack([m.C, np.full((6, 1), 1e3)])
    vessel = calm(barge, og.StateSpaceRadiation(og.StateSpace(A, B, C, A_inf=m.A_inf)))
    system = assemble(vessel)
    R = step_matrix(system.inverse_mass, system.stiffness, system.damping, memory_step(A, B, C, 0.1), 0.1)
    z = np.zeros(len(R))
    z[:6], z[6:12] = START["eta"], START["nu"]
    run = og.simulate(vessel, duration=5.0, dt=0.1, initial=START)
    assert final(run) == pytest.approx((np.linalg.matrix_power(R, 50) @ z)[:12], rel=1e-9, abs=1e-12)


def test_memory_that_cannot_be_diagonalised(barge):
    """A triple pole keeps its Jordan block; the free decay is still the matrix exponential's: K_hat = c s / (s + 1)^3 + ..."""
    A = np.array([[-1.0, 1.0, 0.0], [0.0, -1.0, 1.0], [0.0, 0.0, -1.0]])
    B, C = np.zeros((3, 6)), np.zeros((6, 3))
    B[2, 2], C[2] = 1.0, [-1e6, -1e6, 2e6]
    model = MemoryModel(A, B, C)
    assert modal_memory(model) is model
    vessel = calm(barge, og.StateSpaceRadiation(og.StateSpace(A, B, C, A_inf=barge.model.A_inf)))
    run = og.simulate(vessel, duration=10.0, dt=0.02, initial=START)
    assert final(run) == pytest.approx(free_decay(vessel, START, 10.0), rel=1e-6, abs=1e-7)


def test_convolution_equals_its_state_space(barge, seas):
    a, b = (og.simulate(v, seas.one, duration=200.0, dt=0.1, initial="rest") for v in (barge.ship, barge.ship_convolution))
    scale = np.abs(a.eta.values).max(axis=0)
    assert (np.abs(a.eta.values - b.eta.values).max(axis=0) / scale).max() < 1e-4


def test_truncated_memory_differs_a_little(barge, seas):
    short = og.Vessel(barge.body, loads=(*barge.others, og.Convolution(barge.K, truncation=15.0)))
    a, b = (og.simulate(v, seas.one, duration=100.0, dt=0.1) for v in (short, barge.ship_convolution))
    difference = np.abs(a.eta.values - b.eta.values).max() / np.abs(b.eta.values).max()
    assert 1e-7 < difference < 0.05


class TestStability:
    def vessel(self, frequency):
        body = og.RigidBody(mass=1.0, cog=[0, 0, 0], inertia=np.eye(3))
        return og.Vessel(body, loads=og.LinearRestoring(np.diag([0, 0, frequency**2, 0, 0, 0])))

    def test_refuses_a_step_beyond_the_limit_and_names_one_that_works(self):
        """The classical method is stable on the imaginary axis up to 2 sqrt(2)."""
        vessel = self.vessel(10.0)
        with pytest.raises(og.InputError, match=r"dt: 0\.3 s is too large.*Use dt=") as caught:
            og.simulate(vessel, duration=10.0, dt=0.3)
        works = float(str(caught.value).split("Use dt=")[1].split(" ")[0])
        assert 0.25 < works <= 0.2829
        run = og.simulate(vessel, duration=2000.0, dt=works, initial={"eta": [0, 0, 1.0, 0, 0, 0]})
        assert float(np.abs(run.eta).max()) <= 1.0 + 1e-6

    def test_limit_is_that_of_the_method(self):
        og.simulate(self.vessel(10.0), duration=1.0, dt=0.2828)
        with pytest.raises(og.InputError, match="too large"):
            og.simulate(self.vessel(10.0), duration=1.0, dt=0.2832)

    def test_convolution_refuses_too(self, barge):
        stiff = og.LinearRestoring(np.diag([0, 0, 8e9, 1.6e8, 4e9, 0.0]))
        vessel = og.Vessel(barge.body, loads=(stiff, og.Convolution(barge.K)))
        with pytest.raises(og.InputError, match=r"dt: 0\.2 s is too large.*Use dt="):
            og.simulate(vessel, duration=10.0, dt=0.2)

    def test_exact_method_has_no_limit(self):
        og.simulate(self.vessel(10.0), duration=10.0, dt=1.0, method="exact")

    def test_a_vessel_that_falls_over_is_announced(self, barge):
        negative = og.LinearRestoring(np.diag([0, 0, 8e6, -1.6e8, 4e9, 0.0]))
        with pytest.warns(og.OgilvieWarning, match="grows by itself"):
            og.simulate(og.Vessel(barge.body, loads=negative), duration=1.0)
