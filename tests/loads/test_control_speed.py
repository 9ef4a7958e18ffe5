"""Speed keeping: closed form of the PI loop, limits, speed through the water and over ground."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.loads.base import Load, Surroundings
from ogilvie.loads.control import SpeedKeeping
from ogilvie.loads.control import speed as k
from ogilvie.loads.kernel import situation

M, A11, D = 1e7, 5e5, 5e4
BODY = og.RigidBody(mass=M, cog=[0, 0, 0], inertia=[1e9, 1e10, 1e10])
PLANT = {"added_mass": A11, "surge_damping": D}


def sail(law, duration, *, u=0.0, disturbance=0.0, current=0.0):
    """Run on (m + A) u_r' + D u_r = X + disturbance, exact between samples; return t, u over ground, memory, force."""
    law = law.bind(Surroundings(BODY)).control
    T, memory, force, rows, forces = law.period, law.memory.copy(), np.zeros(6), [], []
    decay = np.exp(-D / (M + A11) * T)
    for j in range(round(duration / T)):
        nu = [u, 0, 0, 0, 0, 0]
        law.function(situation(j * T, nu=nu, nu_r=[u - current, 0, 0, 0, 0, 0]), law.data, memory, force)
        rows.append((j * T, u, *memory))
        forces.append(force.copy())
        mean = (force[0] + (disturbance(j * T) if callable(disturbance) else disturbance)) / D
        u = current + mean + (u - current - mean) * decay
    out = np.array(rows)
    return out[:, 0], out[:, 1], out[:, 2:], np.array(forces)


def test_disturbance_dies_out_as_the_placed_poles_say_and_the_error_falls_with_the_period():
    w, F, errors = 0.05, 1e5, []
    for T in (0.8, 0.4, 0.2):
        t, u, _, _ = sail(SpeedKeeping(0.0, natural_frequency=w, period=T, **PLANT), 300, disturbance=F)
        closed = F / (M + A11) * t * np.exp(-w * t)  # s / (s + w)^2
        errors.append(np.abs(u - closed).max() / closed.max())
    assert errors[-1] < 0.01
    assert np.log2(errors[0] / errors[1]) == pytest.approx(1.0, abs=0.1)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(1.0, abs=0.1)


def test_no_error_remains_under_a_constant_force():
    _, u, memory, _ = sail(SpeedKeeping(5.0, **PLANT), 1000, u=3.0, disturbance=-2e5)
    assert u[-1] == pytest.approx(5.0, abs=1e-9)
    assert memory[-1, k.THRUST] == pytest.approx(5 * D + 2e5)


def test_the_vessel_follows_the_reference():
    _, u, memory, _ = sail(SpeedKeeping(5.0, natural_frequency=0.05, max_acceleration=0.05, period=0.1, **PLANT), 300)
    assert memory[:, k.REFERENCE + 1].max() == 0.05
    assert np.abs(u - memory[:, k.REFERENCE]).max() < 0.01


def test_thrust_that_is_known_at_the_start_keeps_the_speed_from_the_start():
    _, u, _, _ = sail(SpeedKeeping(5.0, thrust=5 * D + 1e5, **PLANT), 100, u=5.0, disturbance=-1e5)
    assert u == pytest.approx(5.0, abs=1e-9)


def test_limits_of_thrust_and_rate():
    law = SpeedKeeping([(0, 8.0), (400, 0.0)], max_thrust=3e5, max_reverse=1e5, rate=1e4, period=1.0, **PLANT)
    _, _, memory, force = sail(law, 1500)
    T = memory[:, k.THRUST]
    assert pytest.approx(force[:, 0]) == T
    assert T.max() == 3e5
    assert T.min() == -1e5
    assert np.abs(np.diff(T)).max() == pytest.approx(1e4)
    assert memory[:, k.DEMAND] == pytest.approx(T + memory[:, k.SHORTFALL])
    assert np.abs(memory[:, k.INTEGRAL]).max() < 3e5
    only_ahead = sail(SpeedKeeping(0.0, max_thrust=3e5, max_reverse=0.0, **PLANT), 100, u=5.0)
    assert only_ahead[2][:, k.THRUST].min() == 0.0


@pytest.mark.parametrize("over_ground", [True, False])
def test_speed_through_the_water_and_over_ground(over_ground):
    _, u, memory, _ = sail(SpeedKeeping(5.0, over_ground=over_ground, **PLANT), 1500, u=5.0, current=1.0)
    assert u[-1] == pytest.approx(5.0 if over_ground else 6.0, abs=1e-9)
    assert memory[-1, k.SPEED] == pytest.approx(5.0)


def test_the_line_of_thrust_makes_moments():
    _, _, memory, force = sail(SpeedKeeping(5.0, position=[-80.0, 2.0, -6.0], **PLANT), 10)
    T = memory[:, k.THRUST]
    assert force == pytest.approx(np.array([np.concatenate([[t, 0, 0], np.cross([-80, 2, -6], [t, 0, 0])]) for t in T]))


def test_what_it_is_and_records():
    law = SpeedKeeping(5.0)
    assert isinstance(law, Load)
    assert law.covers == {"speed control"}
    assert max(slot for _, _, slot in law.signals) < law.bind(Surroundings(BODY)).control.memory.size


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"max_thrust": 0.0}, "max_thrust"),
        ({"rate": -1.0}, "rate"),
        ({"thrust": 2e6, "max_thrust": 1e6}, "thrust: a number within the limits -1e"),
        ({"gains": 3.0}, "gains"),
        ({"position": [0.0]}, "position"),
        ({"max_reverse": -5.0}, "max_reverse"),
        ({"surge_damping": -1.0}, "surge_damping"),
    ],
)
def test_wrong_arguments_are_refused(arguments, words):
    with pytest.raises(og.InputError, match=words):
        SpeedKeeping(5.0, **arguments)


def test_gains_that_are_not_stable_are_refused():
    with pytest.raises(og.InputError, match="SpeedKeeping: the control loop is not stable"):
        SpeedKeeping(5.0, gains=[1e9, 1e3]).bind(Surroundings(BODY))
