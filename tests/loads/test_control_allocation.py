"""Thrust allocation: exact where it can be, within the limits always; what thrusters can do at all."""

from dataclasses import replace

import numpy as np
import pytest

import ogilvie as og
from ogilvie.loads.control import Thruster
from ogilvie.loads.control.allocation import allocate, thrust_force
from ogilvie.loads.control.thruster import capability, check_capability, effectiveness, horizontal_arm

PORT = Thruster([-40.0, 5.0, -5.0], azimuth=True, max_thrust=3e5, name="port")
STARBOARD = Thruster([-40.0, -5.0, -5.0], azimuth=True, max_thrust=3e5, name="starboard")
BOW = Thruster([40.0, 0.0, -4.0], direction=np.pi / 2, max_thrust=1.5e5, name="bow")
MAIN = Thruster([-45.0, 0.0, -6.0], direction=0.0, max_thrust=5e5, max_reverse=2e5, name="main")
FLEET = (PORT, STARBOARD, BOW, MAIN)


def allot(thrusters, tau, *, u=None, period=1.0):
    data = np.concatenate([t.data(period) for t in thrusters])
    n = len(thrusters)
    u = np.zeros(2 * n) if u is None else np.array(u)
    missing, force = np.zeros(3), np.zeros(6)
    allocate(data, n, horizontal_arm(thrusters), np.array(tau, dtype=float), u, missing)
    thrust_force(data, n, u, force)
    return u, missing, force


def components(thrusters, u):
    return np.array([u[2 * i + c] for i, t in enumerate(thrusters) for c in range(len(t.angles))])


def test_exact_and_of_least_cost_where_no_limit_is_met():
    B = effectiveness(FLEET)
    weight = np.concatenate([np.full(len(t.angles), t.max_thrust**-2.0) for t in FLEET])
    root = np.sqrt(weight)
    for tau in np.random.default_rng(1).normal(size=(50, 3)) * [5e4, 5e4, 1e6]:
        u, missing, force = allot(FLEET, tau)
        assert components(FLEET, u) == pytest.approx(np.linalg.pinv(B / root) @ tau / root, rel=1e-9, abs=1e-6)
        assert force[[0, 1, 5]] == pytest.approx(tau, rel=1e-11)
        assert np.abs(missing / [1, 1, 40]).max() < 1e-12 * np.abs(tau / [1, 1, 40]).max() + 1e-9


def test_force_is_that_of_the_thrusts_at_their_places():
    u, _, force = allot(FLEET, [1e5, 5e4, 2e6])
    total = np.zeros(6)
    for i, t in enumerate(FLEET):
        along = u[2 * i] * np.array([1.0, 0.0, 0.0]) + u[2 * i + 1] * np.array([0.0, 1.0, 0.0])
        F = along if t.azimuth else u[2 * i] * np.array([np.cos(t.direction), np.sin(t.direction), 0.0])
        total += np.concatenate([F, np.cross(t.position, F)])
    assert force == pytest.approx(total)


@pytest.mark.parametrize("scale", [0.3, 1.0, 3.0, 100.0])
def test_limits_are_never_exceeded_and_nothing_is_made_up(scale):
    for tau in np.random.default_rng(2).normal(size=(200, 3)) * [5e5, 3e5, 2e7] * scale:
        u, missing, force = allot(FLEET, tau)
        for i in (0, 1):
            assert np.hypot(*u[2 * i : 2 * i + 2]) <= 3e5 * (1 + 1e-12)
        assert abs(u[4]) <= 1.5e5
        assert -2e5 <= u[6] <= 5e5
        assert u[5] == u[7] == 0.0
        assert force[[0, 1, 5]] + missing == pytest.approx(tau, rel=1e-9)


def test_what_saturated_thrusters_leave_is_taken_over_by_the_others():
    """Two thrusters ahead share alike until the weaker is at its limit; then the stronger takes the rest."""
    weak = Thruster([0, 5.0, 0], direction=0.0, max_thrust=1e5, weight=1.0, name="weak")
    strong = Thruster([0, -5.0, 0], direction=0.0, max_thrust=5e5, weight=1.0, name="strong")
    side = [Thruster([x, 0, 0], direction=np.pi / 2, max_thrust=1e6, name=f"side {x}") for x in (-40.0, 40.0)]
    u, missing, _ = allot((weak, strong, *side), [4e5, 0.0, 0.0])
    assert u[0] == pytest.approx(1e5)
    assert u[2] == pytest.approx(3e5)
    assert np.abs(missing).max() < 1e-6
    u, missing, _ = allot((weak, strong, *side), [7e5, 0.0, 0.0])
    assert u[[0, 2]].tolist() == [1e5, 5e5]
    assert missing[0] == pytest.approx(1e5)
    assert np.abs(missing[1:]).max() < 1e-3


def test_most_forces_within_the_limits_are_found_in_full():
    rng, found, B = np.random.default_rng(3), 0, effectiveness(FLEET)
    for _ in range(300):
        a, size = rng.uniform(0, 2 * np.pi, 2), 3e5 * np.sqrt(rng.uniform(size=2))
        u = np.array([size[0] * np.cos(a[0]), size[0] * np.sin(a[0]), size[1] * np.cos(a[1]), size[1] * np.sin(a[1]), 0, 0])
        u[4:] = rng.uniform(-1.5e5, 1.5e5), rng.uniform(-2e5, 5e5)
        tau = B @ u
        _, missing, _ = allot(FLEET, tau)
        found += np.abs(missing / [1, 1, 40]).max() < 1e-6 * np.abs(tau / [1, 1, 40]).max()
    assert found > 0.95 * 300


def test_rates_are_kept_and_the_force_arrives():
    slow = [replace(t, rate=1e4) for t in FLEET]
    u, tau = np.zeros(8), np.array([2e5, 1e5, 3e6])
    for _ in range(60):
        new, missing, _ = allot(slow, tau, u=u, period=0.5)
        step = np.hypot(new[0::2] - u[0::2], new[1::2] - u[1::2])
        assert step.max() <= 5e3 * (1 + 1e-9)
        u = new
    assert np.abs(missing).max() < 1e-3
    assert u == pytest.approx(allot(FLEET, tau)[0])


def test_port_and_starboard_are_mirror_images():
    u, _, _ = allot(FLEET, [1e5, 2e5, 4e6])
    v, _, _ = allot(FLEET, [1e5, -2e5, -4e6])
    assert v[:4] == pytest.approx(np.array([u[2], -u[3], u[0], -u[1]]), rel=1e-9)
    assert v[4] == pytest.approx(-u[4])
    assert v[6] == pytest.approx(u[6])


@pytest.mark.parametrize(
    ("thrusters", "words"),
    [
        ((MAIN,), "cannot act in sway, yaw"),
        ((MAIN, BOW), "sway, yaw independently of each other: rank 2 of 3"),
        ((BOW, Thruster([-40, 0, 0], direction=np.pi / 2, max_thrust=1e5)), "cannot act in surge"),
        ((Thruster([0, 0, 0], azimuth=True, max_thrust=1e5),), "cannot act in yaw"),
    ],
)
def test_thrusters_that_cannot_act_are_refused(thrusters, words):
    with pytest.raises(og.InputError, match=words):
        check_capability(thrusters, None)


def test_capability_is_that_of_simple_arrangements():
    assert capability(FLEET, np.array([1e5, 0, 0])) == pytest.approx(11.0, rel=2e-3)  # 300 + 300 + 500 kN
    assert capability(FLEET, np.array([-1e5, 0, 0])) == pytest.approx(8.0, rel=2e-3)
    pair = [Thruster([x, 0, 0], azimuth=True, max_thrust=1e5) for x in (-50.0, 50.0)]
    assert capability(pair, np.array([0, 0, 1e7])) == pytest.approx(1.0, rel=2e-3)
    assert capability(pair, np.array([0, 1e5, 0])) == pytest.approx(2.0, rel=2e-3)
    assert capability(pair, np.array([1e5, 1e5, 0])) == pytest.approx(np.sqrt(2), rel=2e-3)


def test_design_force_that_cannot_be_held_is_refused_by_name():
    check_capability(FLEET, [2e5, 1e5, 1e6])
    with pytest.raises(og.InputError, match="too weak in surge"):
        check_capability(FLEET, [2e6, 0, 0])
    with pytest.raises(og.InputError, match=r"too weak in yaw \(\d+% of 1e\+08\)"):
        check_capability(FLEET, [1e5, 0, 1e8])
    with pytest.raises(og.InputError, match="enough in each of surge, sway alone, too weak for all at once"):
        check_capability([Thruster([x, 0, 0], azimuth=True, max_thrust=1e5) for x in (-50.0, 50.0)], [1.9e5, 1.9e5, 0])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({}, "exactly one of direction"),
        ({"direction": 0.0, "azimuth": True}, "exactly one of direction"),
        ({"azimuth": True, "max_reverse": 1e5}, "max_reverse"),
        ({"azimuth": True, "max_thrust": 0.0}, "max_thrust"),
        ({"azimuth": True, "rate": 0.0}, "rate"),
        ({"direction": np.nan}, "direction"),
        ({"azimuth": True, "position": [0, 1]}, "position"),
        ({"azimuth": True, "weight": -1.0}, "weight"),
    ],
)
def test_wrong_thrusters_are_refused(arguments, words):
    with pytest.raises(og.InputError, match=words):
        Thruster(**{"position": [0, 0, 0], "max_thrust": 1e5, **arguments})
