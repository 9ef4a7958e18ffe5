"""Dynamic positioning on a plant of known mass and damping: closed forms, turning of the world, thrust limits, wave filter."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

import ogilvie as og
from ogilvie.loads.base import Load, Surroundings
from ogilvie.loads.control import DynamicPositioning, Thruster, WaveFilter
from ogilvie.loads.control import positioning_kernel as k
from ogilvie.loads.kernel import situation
from ogilvie.units import deg

BODY = og.RigidBody(mass=6e6, cog=[-1.0, 0, 0], inertia=[1e9, 3e9, 3e9])
ADDED = np.diag([6e5, 4e6, 0, 0, 0, 2e9])
ADDED[1, 5] = ADDED[5, 1] = -2e7
LINEAR = np.diag([2e5, 3e5, 0, 0, 0, 2e8])
PLANT = {"added_mass": ADDED, "linear_damping": LINEAR}
M = (BODY.matrix + ADDED)[np.ix_([0, 1, 5], [0, 1, 5])]
D = LINEAR[np.ix_([0, 1, 5], [0, 1, 5])]
FLEET = (
    Thruster([-40.0, 5.0, -5.0], azimuth=True, max_thrust=3e5, rate=3e4, name="port"),
    Thruster([-40.0, -5.0, -5.0], azimuth=True, max_thrust=3e5, rate=3e4, name="starboard"),
    Thruster([40.0, 0.0, -4.0], direction=np.pi / 2, max_thrust=2e5, rate=5e4, name="bow"),
)
STILL = lambda t: np.zeros(3)  # noqa: E731


def turning(psi):
    c, s = np.cos(psi), np.sin(psi)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def keep(law, duration, *, start=(0, 0, 0), weather=STILL, wave=None):
    """Run on M nu' + D nu = tau + R^T weather, eta' = R nu with the heading held over a period; weather in the world.

    `wave` adds wave-frequency motion (3,) to what the law sees. Returns t, eta (n, 3), memory, force (n, 6).
    """
    law = law.bind(Surroundings(BODY)).control
    T, memory, force = law.period, law.memory.copy(), np.zeros(6)
    F = np.zeros((9, 9))
    inv = np.linalg.inv(M)
    F[:3, 3:6], F[3:6, 3:6], F[3:6, 6:] = np.eye(3), -inv @ D, inv
    E, eta, nu, rows, forces = expm(F * T), np.array(start, dtype=float), np.zeros(3), [], []
    for j in range(round(duration / T)):
        t = j * T
        shift, rate = (np.zeros(3), np.zeros(3)) if wave is None else wave(t)
        R = turning(eta[2])
        seen, velocity = eta + shift, nu + R.T @ rate
        pose = [seen[0], seen[1], 0, 0, 0, seen[2]]
        law.function(situation(t, pose, [velocity[0], velocity[1], 0, 0, 0, velocity[2]]), law.data, memory, force)
        rows.append((t, *eta, *memory))
        forces.append(force.copy())
        move = E @ np.concatenate([np.zeros(3), nu, force[[0, 1, 5]] + R.T @ np.asarray(weather(t))])
        eta, nu = eta + R @ move[:3], move[3:6]
    out = np.array(rows)
    return out[:, 0], out[:, 1:4], out[:, 4:], np.array(forces)


def test_disturbance_dies_out_as_the_placed_poles_say_and_the_error_falls_with_the_period():
    w, acceleration, errors = np.array([0.05, 0.07, 0.06]), np.array([0.01, 0.02, 0.0]), []
    p = 0.1 * w
    for T in (0.8, 0.4, 0.2):
        law = DynamicPositioning([0, 0, 0], natural_frequency=w, period=T, **PLANT)
        t, eta, _, _ = keep(law, 300, weather=lambda t: M @ acceleration)
        q, s = w - p, t[:, None]
        closed = acceleration * (np.exp(-p * s) / q**2 - np.exp(-w * s) * (1 / q**2 + s / q))
        errors.append(np.abs(eta - closed).max() / closed.max())
    assert errors[-1] < 0.015
    assert np.log2(errors[0] / errors[1]) == pytest.approx(1.0, abs=0.15)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(1.0, abs=0.15)


@pytest.mark.parametrize("heading", [0.0, 2.0, -3.0])
@pytest.mark.parametrize("wave_filter", [None, WaveFilter(0.7)])
def test_no_error_remains_under_constant_weather(heading, wave_filter):
    weather = np.array([8e4, -5e4, 1e6])
    law = DynamicPositioning([10.0, -5.0, heading], FLEET, wave_filter=wave_filter, **PLANT)
    _, eta, memory, force = keep(law, 6000, start=(10, -5, heading), weather=lambda t: weather)
    assert eta[-1] == pytest.approx([10, -5, heading], abs=1e-5)
    assert force[-1, [0, 1, 5]] == pytest.approx(-turning(heading).T @ weather, rel=1e-3)
    assert np.abs(memory[-1, k.SHORTFALL : k.SHORTFALL + 3]).max() < 1e-3
    if wave_filter is None:
        assert memory[-1, k.INTEGRAL : k.INTEGRAL + 3] == pytest.approx(-weather, rel=1e-4)


def test_the_vessel_follows_the_reference_to_a_new_set_point():
    law = DynamicPositioning([(0, 0, 0, 0), (50, 40, 0, 0)], natural_frequency=0.06, period=0.1, **PLANT)
    t, eta, memory, _ = keep(law, 400)
    wt = 0.06 * np.maximum(t - 50, 0)
    closed = 40 * (1 - (1 + wt + wt**2 / 2) * np.exp(-wt))
    assert memory[:, k.REFERENCE] == pytest.approx(closed, abs=1e-9)
    assert np.abs(eta[:, 0] - closed).max() < 0.1
    assert np.abs(eta[:, 1:]).max() < 1e-6


def test_reference_keeps_its_speed():
    law = DynamicPositioning([100.0, 0, 1.0], max_speed=0.5, max_rate=0.005, **PLANT)
    _, eta, memory, _ = keep(law, 1500)
    assert memory[:, k.REFERENCE + 1].max() == 0.5
    assert memory[:, k.REFERENCE + 7].max() == 0.005
    assert eta[-1] == pytest.approx([100.0, 0, 1.0], abs=1e-3)


def test_heading_goes_the_shorter_way_round():
    law = DynamicPositioning([0, 0, 179 * deg], FLEET, wave_filter=WaveFilter(0.7), **PLANT)
    _, eta, _, _ = keep(law, 1500, start=(0, 0, -179 * deg))
    assert eta[-1, 2] == pytest.approx(-181 * deg, abs=1e-5)
    assert np.ptp(eta[:, 2]) < 2.6 * deg


def test_everything_turns_with_the_world():
    a, law = 0.9, DynamicPositioning([5.0, 3.0, 0.2], FLEET, wave_filter=WaveFilter(0.7), **PLANT)
    R, weather = turning(a), np.array([5e4, -3e4, 1e6])
    turned = replace(law, setpoint=R @ [5.0, 3.0, 0.2] + [0, 0, a])
    _, eta, _, force = keep(law, 200, weather=lambda t: weather)
    _, eta_turned, _, force_turned = keep(turned, 200, start=(0, 0, a), weather=lambda t: R @ weather)
    assert eta_turned == pytest.approx(eta @ R.T + [0, 0, a], abs=1e-8)
    assert force_turned == pytest.approx(force, rel=1e-6, abs=1e-2)


def test_thrusters_keep_their_limits_and_the_shortfall_is_told():
    weather = np.array([0.0, 1.2e6, 0.0])  # more than the thrusters have
    law = DynamicPositioning([0, 0, 0], FLEET, period=0.5, **PLANT)
    _, eta, memory, force = keep(law, 100, weather=lambda t: weather)
    u = memory[:, k.THRUST :]
    assert np.hypot(u[:, 0::2], u[:, 1::2]).max(axis=0) == pytest.approx([3e5, 3e5, 2e5], rel=0.35)
    assert np.all(np.hypot(u[:, 0::2], u[:, 1::2]).max(axis=0) <= np.array([3e5, 3e5, 2e5]) * (1 + 1e-12))
    step = np.hypot(np.diff(u[:, 0::2], axis=0), np.diff(u[:, 1::2], axis=0)).max(axis=0)
    assert np.all(step <= np.array([3e4, 3e4, 5e4]) * 0.5 * (1 + 1e-9))
    wanted, missing = memory[:, k.DEMAND : k.DEMAND + 3], memory[:, k.SHORTFALL : k.SHORTFALL + 3]
    assert wanted - missing == pytest.approx(force[:, [0, 1, 5]], abs=1e-3)
    assert np.abs(missing[-1, 1]) > 1e5
    assert eta[-1, 1] > 10.0


def test_integral_does_not_wind_up_while_thrust_is_short():
    gust = lambda t: np.array([0.0, 9e5 * (t < 100), 0.0])  # noqa: E731
    law = DynamicPositioning([0, 0, 0], FLEET, **PLANT)
    _, eta, memory, _ = keep(law, 1500, weather=gust)
    assert eta[:, 1].max() > 5.0
    assert np.abs(memory[:, k.INTEGRAL + 1]).max() < 8e5
    assert -eta[:, 1].min() < 0.3 * eta[:, 1].max()
    assert np.abs(eta[-1]).max() < 0.05


@pytest.mark.parametrize("factor", [0.6, 1.5])
def test_a_wrong_inertia_in_the_law_costs_no_accuracy_in_the_end(factor):
    wrong = factor * M - BODY.matrix[np.ix_([0, 1, 5], [0, 1, 5])]
    law = DynamicPositioning([10.0, 0, 0.5], FLEET, added_mass=wrong, wave_filter=WaveFilter(0.7))
    _, eta, _, _ = keep(law, 4000, weather=lambda t: np.array([5e4, 8e4, 1e6]))
    assert eta[-1] == pytest.approx([10, 0, 0.5], abs=1e-4)


def test_force_acts_directly_without_thrusters():
    law = DynamicPositioning([100.0, 0, 0], max_force=[1e5, np.inf, np.inf], **PLANT)
    _, _, memory, force = keep(law, 100)
    assert force[:, 0].max() == 1e5
    assert memory[:, k.SHORTFALL].max() > 0.0
    assert not force[:, 2:5].any()


def test_wave_filter_keeps_the_waves_off_the_thrusters_and_the_vessel_in_place():
    wo, a = 0.7, np.array([0.8, 0.6, 0.5 * deg])
    phase = np.array([0.0, 1.0, 2.0])

    def wave(t):
        return a * np.sin(wo * t + phase), a * wo * np.cos(wo * t + phase)

    weather = lambda t: np.array([8e4, 5e4 * (1 + np.sin(0.01 * t)), 0.0])  # noqa: E731
    plain = DynamicPositioning([0, 0, 0.3], FLEET, **PLANT)
    filtered = replace(plain, wave_filter=WaveFilter(wo))
    fast = lambda memory: np.diff(memory[1000:, k.THRUST :], axis=0).std(axis=0)  # noqa: E731
    _, eta, memory, _ = keep(plain, 2000, start=(0, 0, 0.3), weather=weather, wave=wave)
    _, eta_f, memory_f, _ = keep(filtered, 2000, start=(0, 0, 0.3), weather=weather, wave=wave)
    active = [0, 1, 2, 3, 4]
    assert np.all(fast(memory_f)[active] < 0.12 * fast(memory)[active])
    assert np.abs(eta_f[1000:] - [0, 0, 0.3]).max() < 1.5 * np.abs(eta[1000:] - [0, 0, 0.3]).max() + 0.2
    estimate = memory_f[1000:, k.ESTIMATE : k.ESTIMATE + 2]
    assert np.abs(estimate - eta_f[1000:, :2]).max() < 0.2 * a[0]


def test_what_it_is_and_records():
    law = DynamicPositioning([0, 0, 0], FLEET, wave_filter=WaveFilter(0.7))
    assert isinstance(law, Load)
    assert law.covers == {"position control", "heading control", "speed control"}
    names, _, slots = zip(*law.signals, strict=True)
    assert len(set(names)) == len(names)
    assert len(set(slots)) == len(slots)
    assert max(slots) < law.bind(Surroundings(BODY)).control.memory.size
    unnamed = DynamicPositioning([0, 0, 0], [replace(t, name="") for t in FLEET])
    assert [n for n, _, _ in unnamed.signals][-1] == "thrust of thruster 3"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"setpoint": [0, 0]}, "setpoint"),
        ({"thrusters": FLEET[2:]}, "cannot act in surge"),
        ({"thrusters": FLEET, "design_force": [1e5, 9e5, 0]}, "too weak in sway"),
        ({"thrusters": FLEET, "design_force": [1e5]}, "design_force"),
        ({"thrusters": ()}, "at least one thruster"),
        ({"thrusters": (1.0,)}, "Thruster objects"),
        ({"thrusters": (FLEET[0], FLEET[0])}, "different names"),
        ({"design_force": [1e5, 0, 0]}, "thrusters expected beside"),
        ({"natural_frequency": [0.1, 0.1]}, "natural_frequency"),
        ({"natural_frequency": 0.0}, "natural_frequency"),
        ({"added_mass": np.eye(2)}, "added_mass"),
        ({"added_mass": [[1, 2], [3]]}, "rows of different lengths"),
        ({"setpoint": [(0, 1, 2, 3), (4, 5)]}, "setpoint"),
        ({"max_force": [1e5, 1e5]}, "max_force"),
        ({"max_force": "none"}, "max_force"),
        ({"thrusters": FLEET, "max_force": 1e5}, "thrusters have limits of their own"),
        ({"wave_filter": 0.7}, "a WaveFilter expected"),
        ({"period": -1.0}, "period"),
    ],
)
def test_wrong_arguments_are_refused(arguments, words):
    with pytest.raises(og.InputError, match=words):
        DynamicPositioning(**{"setpoint": [0, 0, 0], **arguments})


def test_sampling_too_slow_is_refused():
    with pytest.raises(og.InputError, match="DynamicPositioning: the control loop is not stable"):
        DynamicPositioning([0, 0, 0], period=60.0, **PLANT).bind(Surroundings(BODY))


def test_a_heading_in_degrees_is_refused():
    with pytest.raises(og.InputError, match=r"Degrees\? Write 90 \* og.units.deg"):
        DynamicPositioning((0.0, 0.0, 90.0))
