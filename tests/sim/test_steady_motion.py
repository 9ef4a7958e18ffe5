"""In the steady motion the time domain and the frequency domain are the same thing."""

import numpy as np
import pytest

import ogilvie as og

METHODS = {"state space": ("ship", "rk4"), "exact": ("ship", "exact"), "convolution": ("ship_convolution", "rk4")}


def frequency_domain(vessel, model, sea, force, t):
    """Component sum of Z(w)^-1 F, written out independently of the package's own assembly (zero speed, heading 0)."""
    loads = {type(load).__name__: load for load in vessel.loads}
    w = sea.omega
    M = vessel.body.matrix + model.A_inf
    C = loads["LinearRestoring"].stiffness + loads["LinearMooring"].stiffness
    D = loads["LinearDamping"].matrix
    X = np.empty((len(w), 6), dtype=complex)
    for j in range(len(w)):
        Z = -(w[j] ** 2) * M + 1j * w[j] * (D + model.transfer(w[j])[0]) + C
        X[j] = np.linalg.solve(Z, force[j])
    a = sea.amplitude * np.exp(1j * sea.phase)
    return (a * np.exp(1j * np.outer(t, w)) @ X).real


def rms(x):
    return np.sqrt(np.mean(np.square(x), axis=0))


@pytest.mark.parametrize("kind", METHODS)
def test_time_domain_equals_component_sum(barge, seas, kind):
    name, method = METHODS[kind]
    run = og.simulate(getattr(barge, name), seas.one, duration=400.0, dt=0.1, method=method)
    force = barge.others[3].force(seas.one.omega, seas.one.direction)
    expected = frequency_domain(barge.ship, barge.model, seas.one, force, run.time.values)
    error = rms(run.eta.values - expected) / rms(expected)
    assert error.max() < 2e-5


@pytest.mark.parametrize("kind", METHODS)
def test_forces_balance_inertia(barge, seas, kind):
    name, method = METHODS[kind]
    run = og.simulate(getattr(barge, name), seas.one, duration=60.0, dt=0.1, method=method, initial="rest")
    total = sum(run[v].values for v in run if v.startswith("force_"))
    inertia = run.acceleration.values @ barge.body.matrix.T
    assert np.abs(total - inertia).max(axis=0) / np.abs(inertia).max(axis=0) == pytest.approx(np.zeros(6), abs=1e-9)


def test_start_from_rest_tends_to_the_steady_motion(barge, seas):
    steady = og.simulate(barge.ship, seas.one, duration=4000.0, dt=0.2, output_step=1.0)
    grown = og.simulate(barge.ship, seas.one, duration=4000.0, dt=0.2, output_step=1.0, ramp=100.0)
    late = slice(3900.0, None)
    difference = rms((grown.eta - steady.eta).sel(time=late)) / rms(steady.eta.sel(time=late))
    assert difference.max() < 0.02
    assert float(abs(grown.eta[0]).max()) == 0.0


def test_velocity_and_acceleration_are_the_rates(barge, seas):
    run = og.simulate(barge.ship, seas.one, duration=50.0, dt=0.05)
    middle = slice(1, -1)
    for value, rate in (("eta", "nu"), ("nu", "acceleration")):
        slope = np.gradient(run[value].values, 0.05, axis=0)[middle]
        assert np.abs(slope - run[rate].values[middle]).max() < 2e-3 * np.abs(run[rate].values).max()


def test_superposition(barge):
    one = og.regular(amplitude=1.0, period=7.0, direction=2.0)
    other = og.regular(amplitude=0.6, period=11.0, direction=2.9, phase=0.7)
    runs = [og.simulate(barge.ship, sea, duration=80.0, initial="rest") for sea in (one, other, one + other)]
    both = runs[0].eta + runs[1].eta
    assert np.abs(both - runs[2].eta).values == pytest.approx(np.zeros(both.shape), abs=1e-10 * float(np.abs(both).max()))


def test_twice_the_sea_twice_the_motion(barge):
    one = og.regular(amplitude=1.0, period=7.0, direction=2.0)
    two = og.regular(amplitude=2.0, period=7.0, direction=2.0)
    a, b = (og.simulate(barge.ship, sea, duration=30.0, initial="rest").eta.values for sea in (one, two))
    assert b == pytest.approx(2.0 * a, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("name", ["ship", "ship_convolution"])
def test_waves_from_port_and_starboard_mirror_the_motion(barge, name):
    port = og.regular(amplitude=1.0, period=8.0, direction=-np.pi / 2)
    starboard = og.regular(amplitude=1.0, period=8.0, direction=np.pi / 2)
    a, b = (og.simulate(getattr(barge, name), sea, duration=60.0).eta.values for sea in (port, starboard))
    scale = np.abs(a).max(axis=0) + 1e-12
    assert np.abs(a * [1, -1, 1, -1, 1, -1] - b).max(axis=0) / scale == pytest.approx(np.zeros(6), abs=1e-8)
    assert np.abs(a[:, 3]).max() > 1e-3


def test_heading_turns_the_vessel_in_the_sea(barge):
    sea = og.regular(amplitude=1.0, period=8.0, direction=np.radians(100.0))
    turned = og.Vessel(barge.body, loads=barge.ship.loads, heading=np.radians(-30.0))
    straight = og.simulate(barge.ship, og.regular(amplitude=1.0, period=8.0, direction=np.radians(130.0)), duration=30.0)
    run = og.simulate(turned, sea, duration=30.0)
    assert run.eta.values == pytest.approx(straight.eta.values, rel=1e-9, abs=1e-9)


@pytest.mark.filterwarnings("ignore:WaveExcitation")
@pytest.mark.parametrize("direction", [np.pi, 0.3])
@pytest.mark.parametrize("kind", METHODS)
def test_speed_is_that_of_strip_theory(barge, kind, direction):
    """Added mass and damping at speed of Salvesen, Tuck and Faltinsen at the signed encounter frequency, written out here.

    Head waves are met faster; short following waves are overtaken: their phase runs backwards.
    """
    name, method = METHODS[kind]
    speed, lift = 9.0, og.HullLift(draught=25.0, x=-40.0)
    sea = og.regular(amplitude=1.0, omega=1.5, direction=direction)
    vessel = og.Vessel(barge.body, loads=(*getattr(barge, name).loads, lift), speed=speed)
    run = og.simulate(vessel, sea, duration=60.0, dt=0.05, method=method)
    t = run.time.values
    assert run.elevation.values == pytest.approx(sea.elevation(t, speed * t, 0.0), abs=1e-9)
    we = 1.5 - sea.wavenumber[0] * speed * np.cos(direction)
    assert (we < 0) == (direction == 0.3)
    H = barge.model.transfer(we)[0]
    A, B = at_speed_of_strip_theory(barge.model.A_inf + H.imag / we, H.real, we, speed)
    C = barge.others[0].stiffness + barge.others[1].stiffness
    D = barge.others[2].matrix + lift.end_mass * speed * np.outer([0, 1, 0, 0, 0, lift.x], [0, 1, 0, 0, 0, lift.x])
    C_drag = np.zeros((6, 6))  # damping acts on the velocity in body axes: xi_2' - U xi_6, xi_3' + U xi_5
    C_drag[:, 5], C_drag[:, 4] = -speed * D[:, 1], speed * D[:, 2]
    Z = -(we**2) * (barge.body.matrix + A) + 1j * we * (B + D) + C + C_drag
    X = np.linalg.solve(Z, barge.others[3].force(1.5, direction)[0])
    expected = (np.exp(1j * we * t)[:, None] * X).real
    assert np.abs(run.eta.values - expected).max(axis=0) / np.abs(X) == pytest.approx(np.zeros(6), abs=1e-4)


def at_speed_of_strip_theory(A, B, omega, speed):
    """Salvesen, Tuck and Faltinsen (1970) without end terms: heave to pitch and sway to yaw, with their couplings."""
    A_U, B_U = A.copy(), B.copy()
    ratio = speed / omega**2
    for turn, shift, sign in ((4, 2, 1.0), (5, 1, -1.0)):
        for i in range(6):
            if i not in (4, 5):
                A_U[i, turn] -= sign * ratio * B[i, shift]
                B_U[i, turn] += sign * speed * A[i, shift]
                A_U[turn, i] += sign * ratio * B[shift, i]
                B_U[turn, i] -= sign * speed * A[shift, i]
        A_U[turn, turn] += speed * ratio * A[shift, shift]
        B_U[turn, turn] += speed * ratio * B[shift, shift]
    return A_U, B_U


def test_pretension_moves_the_mean_position(barge):
    force = np.array([1e5, 0, 0, 0, 0, 0])
    springs = og.LinearMooring(barge.others[1].stiffness, pretension=force)
    vessel = og.Vessel(barge.body, loads=(barge.others[0], springs, barge.others[2], og.StateSpaceRadiation(barge.model)))
    run = og.simulate(vessel, duration=50.0, initial="steady")
    expected = np.linalg.solve(barge.others[0].stiffness + springs.stiffness, force)
    assert run.eta.values[-1] == pytest.approx(expected, abs=1e-9)
    mooring = run.force_mooring.values
    assert mooring == pytest.approx(np.zeros_like(mooring), abs=1e-6 * 1e5)


def test_free_vessel_does_not_drift_from_a_steady_start(barge, seas):
    """Without any horizontal restoring or damping the steady start leaves the pure oscillation."""
    loads = (barge.others[0], barge.others[3], og.StateSpaceRadiation(barge.model))
    run = og.simulate(og.Vessel(barge.body, loads=loads), seas.one, duration=600.0, dt=0.1, output_step=0.5)
    surge = run.eta.sel(dof="surge").values
    assert np.abs(surge).max() < 2.0
    assert abs(surge[-200:].mean()) < 0.1 * surge.std() + 0.02
