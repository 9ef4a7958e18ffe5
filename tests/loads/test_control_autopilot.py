"""Autopilot and rudder: closed forms of the loop, limits, signs, the wrap at +-180 deg, the wave filter."""

import numpy as np
import pytest
from scipy.linalg import expm

import ogilvie as og
from ogilvie.frames import to_z_down
from ogilvie.loads.base import Load, Surroundings
from ogilvie.loads.control import Autopilot, Rudder, WaveFilter
from ogilvie.loads.control import autopilot_kernel as k
from ogilvie.loads.control.rudder import rudder_command, rudder_moment
from ogilvie.loads.kernel import situation
from ogilvie.units import deg

I66, A66, D = 2.0e10, 1.0e10, 3.0e8
BODY = og.RigidBody(mass=1e7, cog=[0, 0, 0], inertia=[1e9, I66, I66])
RUDDER = Rudder(area=30.0, aspect_ratio=1.8, position=[-85.0, 0.0, -5.0])
PLANT = {"added_mass": A66, "yaw_damping": D}


def sail(pilot, duration, *, psi=0.0, disturbance=0.0, speed=8.0, wave=None):
    """Run the law on (I + A) psi'' + D psi' = N + disturbance, exact between samples; return t, heading, memory, force."""
    law = pilot.bind(Surroundings(BODY)).control
    T, memory, force = law.period, law.memory.copy(), np.zeros(6)
    F = np.array([[0, 1, 0], [0, -D / (I66 + A66), 1 / (I66 + A66)], [0, 0, 0]])
    E, state, rows = expm(F * T), np.array([psi, 0.0]), []
    for j in range(round(duration / T)):
        t = j * T
        w = (0.0, 0.0) if wave is None else wave(t)
        nu = [speed, 0, 0, 0, 0, state[1] + w[1]]
        law.function(situation(t, [0, 0, 0, 0, 0, state[0] + w[0]], nu), law.data, memory, force)
        rows.append((t, *state, force[5], *memory))
        N = force[5] + (disturbance(t) if callable(disturbance) else disturbance)
        state = E[:2, :2] @ state + E[:2, 2] * N
    out = np.array(rows)
    return out[:, 0], out[:, 1], out[:, 4:], out[:, 3]


def constant_disturbance(t, N, w, p):
    """Heading of I psi'' = N - PID with poles -p and twice -w."""
    q = w - p
    return N / (I66 + A66) * (np.exp(-p * t) / q**2 - np.exp(-w * t) * (1 / q**2 + t / q))


def test_disturbance_dies_out_as_the_placed_poles_say_and_the_error_falls_with_the_period():
    w, N, errors = 0.1, 1e7, []
    for T in (0.4, 0.2, 0.1):
        t, psi, _, _ = sail(Autopilot(0.0, max_moment=np.inf, natural_frequency=w, period=T, **PLANT), 400, disturbance=N)
        errors.append(np.abs(psi - constant_disturbance(t, N, w, 0.1 * w)).max() / psi.max())
    assert errors[-1] < 0.01
    assert np.log2(errors[0] / errors[1]) == pytest.approx(1.0, abs=0.1)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(1.0, abs=0.1)


def test_integral_action_leaves_no_error():
    _, psi, memory, N = sail(Autopilot(0.2, max_moment=1e9, **PLANT), 3000, disturbance=2e7)
    assert psi[-1] == pytest.approx(0.2, abs=1e-7)
    assert N[-1] == pytest.approx(-2e7, rel=1e-6)
    assert memory[-1, k.INTEGRAL] == pytest.approx(-2e7, rel=1e-6)


def test_the_vessel_follows_the_reference():
    t, psi, memory, _ = sail(Autopilot(0.5, max_moment=np.inf, natural_frequency=0.1, period=0.1, **PLANT), 200)
    wt = 0.1 * t
    closed = 0.5 * (1 - (1 + wt + wt**2 / 2) * np.exp(-wt))
    assert memory[:, k.REFERENCE] == pytest.approx(closed, abs=1e-12)
    assert np.abs(psi - closed).max() < 2e-3 * 0.5


@pytest.mark.parametrize("turns", [0, 3])
def test_set_point_179_from_minus_179_turns_two_degrees(turns):
    start = -179 * deg + turns * 2 * np.pi
    _, psi, _, _ = sail(Autopilot(179 * deg, max_moment=np.inf, **PLANT), 600, psi=start)
    assert psi[-1] - start == pytest.approx(-2 * deg, abs=1e-6)
    assert np.ptp(psi) < 2.4 * deg


def test_heading_that_jumps_by_a_turn_is_the_same_heading():
    law = Autopilot(0.0, max_moment=np.inf, wave_filter=WaveFilter(0.7), **PLANT).bind(Surroundings(BODY)).control
    forces = []
    for jump in (0.0, 2 * np.pi):
        memory, force = law.memory.copy(), np.zeros(6)
        for j in range(20):
            law.function(situation(0.5 * j, [0, 0, 0, 0, 0, 0.01 * j + jump * (j > 10)]), law.data, memory, force)
        forces.append(force[5])
    assert forces[1] == pytest.approx(forces[0], rel=1e-9)


def test_set_points_in_time():
    _, psi, _, _ = sail(Autopilot([(0, 0.0), (100, 0.3)], max_moment=np.inf, **PLANT), 800)
    assert np.abs(psi[:200]).max() < 1e-12
    assert psi[-1] == pytest.approx(0.3, abs=1e-6)


def test_moment_stays_within_its_limit_and_the_integral_does_not_wind_up():
    N0, T = 2e7, 0.5

    def pulse(t):
        return 1.1 * N0 * (t < 120)  # more than the limit holds: the vessel turns away

    _, psi, memory, N = sail(Autopilot(0.0, max_moment=N0, period=T, **PLANT), 3000, disturbance=pulse)
    assert np.abs(N).max() == N0
    assert (np.abs(N) == N0).sum() * T > 100
    assert memory[:, k.DEMAND] - memory[:, k.SHORTFALL] == pytest.approx(N)
    assert psi[-1] == pytest.approx(0.0, abs=1e-9)
    wound = winding_up(N0, T, pulse, 3000)
    assert np.abs(memory[:, k.INTEGRAL]).max() < 0.6 * N0
    assert -psi.min() < 0.25 * -wound.min()


def winding_up(N0, T, pulse, duration):
    """Heading of the same loop with an integral that never stops."""
    I, w = I66 + A66, 0.1
    Kp, Ki, Kd = I * (w**2 + 0.2 * w**2), 0.1 * I * w**3, I * 2.1 * w - D
    state, z, out = np.zeros(2), 0.0, []
    E = expm(np.array([[0, 1, 0], [0, -D / I, 1 / I], [0, 0, 0]]) * T)
    for j in range(int(duration / T)):
        N = min(max(-Kp * state[0] - Kd * state[1] + z, -N0), N0)
        z -= T * Ki * state[0]
        out.append(state[0])
        state = E[:2, :2] @ state + E[:2, 2] * (N + pulse(j * T))
    return np.array(out)


def test_rudder_turns_the_vessel_and_keeps_its_limits():
    pilot = Autopilot(20 * deg, RUDDER, natural_frequency=0.05, max_rate=0.5 * deg, **PLANT)
    _, psi, memory, _ = sail(pilot, 2500, disturbance=5e6)
    angle = memory[:, k.RUDDER]
    assert psi[-1] == pytest.approx(20 * deg, abs=1e-7)
    assert angle.max() > 1 * deg  # to port first
    assert np.abs(angle).max() <= RUDDER.max_angle
    assert np.abs(np.diff(angle)).max() <= RUDDER.rate * pilot.period * (1 + 1e-12)
    slow = Autopilot(20 * deg, RUDDER, natural_frequency=0.05, max_rate=0.5 * deg, **PLANT)
    _, _, low, _ = sail(slow, 300, speed=1.0)  # hardly any force on the rudder
    assert np.abs(low[:, k.RUDDER]).max() == pytest.approx(RUDDER.max_angle)


def test_course_to_port_and_to_starboard_are_mirror_images():
    port = sail(Autopilot(0.3, RUDDER, natural_frequency=0.05, **PLANT), 300)
    starboard = sail(Autopilot(-0.3, RUDDER, natural_frequency=0.05, **PLANT), 300)
    assert port[1] == pytest.approx(-starboard[1], abs=1e-14)
    assert port[2][:, k.RUDDER] == pytest.approx(-starboard[2][:, k.RUDDER], abs=1e-14)


def test_wave_filter_keeps_the_waves_off_the_rudder():
    wo, a = 0.7, 1 * deg

    def wave(t):
        return a * np.sin(wo * t), a * wo * np.cos(wo * t)

    common = {"natural_frequency": 0.05, **PLANT}
    plain = sail(Autopilot(0.1, RUDDER, **common), 1500, wave=wave)
    calm = sail(Autopilot(0.1, RUDDER, **common), 1500)
    filtered = sail(Autopilot(0.1, RUDDER, wave_filter=WaveFilter(wo), **common), 1500, wave=wave)
    late = slice(1500, None)
    ratio = filtered[2][late, k.RUDDER].std() / plain[2][late, k.RUDDER].std()
    assert ratio < 0.12
    assert np.abs(filtered[1] - calm[1]).max() < 0.7 * deg  # while the filter settles
    assert filtered[1][late].mean() == pytest.approx(0.1, abs=2e-4)
    assert filtered[2][late, k.OBSERVER + 1].std() == pytest.approx(0.9 * a / np.sqrt(2), rel=0.05)  # 1 - l / z of it


def mmg_rudder(delta, u, v, r, *, x, A, f, rho, tR, aH, xH):
    """Rudder force of the MMG model as published: z down, y starboard, delta positive to starboard; X, Y, N."""
    vR = v + x * r
    FN = 0.5 * rho * A * f * (u**2 + vR**2) * np.sin(delta - np.arctan2(-vR, u))
    return -(1 - tR) * FN * np.sin(delta), -(1 + aH) * FN * np.cos(delta), -(x + aH * xH) * FN * np.cos(delta)


def test_rudder_force_is_that_of_the_published_model_in_its_axes():
    rudder = Rudder(30.0, 1.8, position=[-85.0, 0, -5.0], drag_deduction=0.3, hull_interaction=0.31, hull_position=-70.0)
    nu = np.array([8.0, 0.6, 0, 0, 0, -0.01])
    nu_down = to_z_down(nu)
    numbers = {"x": -85.0, "A": 30.0, "f": 6.13 * 1.8 / (1.8 + 2.25), "rho": 1025.0, "tR": 0.3, "aH": 0.31, "xH": -70.0}
    for delta in np.array([-30, -5, 0, 12, 35]) * deg:
        down = to_z_down(rudder.force(delta, nu=nu))  # delta to port here is -delta there
        X, Y, N = mmg_rudder(-delta, nu_down[0], nu_down[1], nu_down[5], **numbers)
        assert [down[0], down[1], down[5]] == pytest.approx([X, Y, N])
        assert down[3] == pytest.approx(-5.0 * Y)  # acts 5 m below O, z down: K = -z Y
        assert down[4] == pytest.approx(5.0 * X)


def test_rudder_signs():
    ahead = RUDDER.force(10 * deg, nu=[8, 0, 0, 0, 0, 0])
    assert ahead[5] > 0  # to port
    assert ahead[1] < 0
    assert ahead[0] < 0
    assert ahead[3] < 0  # force to starboard below O: port side down
    astern = RUDDER.force(10 * deg, nu=[-8, 0, 0, 0, 0, 0])
    assert astern[5] < 0
    drifting = RUDDER.force(0.0, nu=[8, 0.5, 0, 0, 0, 0])
    assert drifting[1] < 0  # against the drift
    assert RUDDER.force(0.0, nu=[8, 0, 0, 0, 0, 0.01])[5] < 0  # against the turn
    assert RUDDER.force(0.2, nu=np.zeros(6)).tolist() == [0] * 6


def test_command_is_the_inverse_of_the_moment():
    data = RUDDER.data(0.5)
    for u in (3.0, 8.0, -4.0):
        for angle in np.array([-40, -10, 0, 5, 35]) * deg:
            N = rudder_moment(data, angle, u)
            assert rudder_command(data, N, u) == pytest.approx(angle, abs=1e-12)
            if u > 0:
                assert RUDDER.force(angle, nu=[u, 0, 0, 0, 0, 0])[5] == pytest.approx(N)
    assert rudder_command(data, 1e12, 8.0) == pytest.approx(45 * deg)
    assert rudder_command(data, 1e12, 0.0) == pytest.approx(45 * deg)


def test_what_an_autopilot_is_and_records():
    pilot = Autopilot(0.0, RUDDER, wave_filter=WaveFilter(0.7))
    assert isinstance(pilot, Load)
    assert pilot.covers == {"heading control", "rudder force"}
    assert Autopilot(0.0, max_moment=1.0).covers == {"heading control"}
    memory = pilot.bind(Surroundings(BODY)).control.memory
    slots = [slot for _, _, slot in pilot.signals]
    assert len(set(slots)) == len(slots)
    assert max(slots) < memory.size
    assert ("rudder angle", "rad", k.RUDDER) in pilot.signals


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({}, "exactly one of rudder and max_moment"),
        ({"rudder": RUDDER, "max_moment": 1e6}, "exactly one"),
        ({"rudder": 3.0}, "a Rudder expected"),
        ({"max_moment": -1.0}, "max_moment"),
        ({"max_moment": 1e6, "natural_frequency": 0.0}, "natural_frequency"),
        ({"max_moment": 1e6, "period": np.nan}, "period"),
        ({"max_moment": 1e6, "wave_filter": 0.7}, "a WaveFilter expected"),
        ({"max_moment": 1e6, "gains": [1.0, 2.0]}, "gains"),
        ({"max_moment": 1e6, "added_mass": np.eye(3)}, "added_mass"),
    ],
)
def test_wrong_arguments_are_refused(arguments, words):
    with pytest.raises(og.InputError, match=words):
        Autopilot(0.0, **arguments)


def test_gains_that_are_not_stable_are_refused():
    with pytest.raises(og.InputError, match="Autopilot: the control loop is not stable"):
        Autopilot(0.0, max_moment=1e9, gains=[1e9, 1e9, 0.0]).bind(Surroundings(BODY))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"area": 0.0}, "area"),
        ({"position": [0.0, 0, 0]}, "no yaw moment"),
        ({"max_angle": 35.0}, "max_angle: at most 45 deg"),
        ({"drag_deduction": 1.5}, "drag_deduction"),
        ({"position": [1.0, 2.0]}, "position"),
    ],
)
def test_wrong_rudders_are_refused(arguments, words):
    with pytest.raises(og.InputError, match=words):
        Rudder(**{"area": 30.0, "aspect_ratio": 1.5, "position": [-80.0, 0, 0], **arguments})


@pytest.mark.parametrize("heading", [45.0, [(0.0, 0.0), (300.0, 30.0)]])
def test_headings_in_degrees_are_refused(heading):
    with pytest.raises(og.InputError, match=r"Degrees\? Write"):
        Autopilot(heading, max_moment=1e8)


def test_a_schedule_may_turn_round_and_round():
    Autopilot([(0.0, 0.0), (300.0, 6.0), (600.0, 12.0), (900.0, 18.0)], max_moment=1e8)
