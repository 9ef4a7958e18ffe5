"""A current is a velocity: its direction, and its mean over the draught."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.errors import InputError
from ogilvie.loads.base import Load, Surroundings
from ogilvie.loads.current import Current

AROUND = Surroundings(og.RigidBody(mass=1.0, cog=[0, 0, 0], inertia=np.eye(3)))


def test_it_flows_to_its_direction_and_adds_no_force():
    for angle in (0.0, 0.7, -2.0, np.pi):
        terms = Current(1.3, angle).bind(AROUND)
        assert terms.current == pytest.approx([1.3 * np.cos(angle), 1.3 * np.sin(angle), 0.0])
        assert not terms.damping.any()
        assert not terms.constant.any()
        assert terms.kernel is None
    load = Current(1.0, 0.0)
    assert isinstance(load, Load)
    assert load.covers == {"current"}
    assert load.name == "current"


def test_mean_of_a_profile_is_exact_for_straight_lines():
    z = [0.0, -10.0, -100.0]
    mean = Current([2.0, 1.0, 0.1], 0.0, z=z, draught=10.0).velocity
    assert mean == pytest.approx([1.5, 0.0, 0.0])
    # 10 m from 2 to 1 and 10 m from 1 to 0.9
    assert Current([2.0, 1.0, 0.1], 0.0, z=z, draught=20.0).velocity[0] == pytest.approx((15.0 + 9.5) / 20.0)
    falling = Current([0.1, 1.0, 2.0], 0.0, z=z[::-1], draught=20.0).velocity
    assert falling == pytest.approx(Current([2.0, 1.0, 0.1], 0.0, z=z, draught=20.0).velocity)


def test_mean_of_the_power_law_converges_with_the_square_of_the_spacing():
    """int_-T^0 (1 + z/h)^2 dz / T in closed form."""
    h, T = 50.0, 20.0
    exact = h * (1.0 - (1.0 - T / h) ** 3) / 3.0 / T
    error = []
    for n in (11, 21, 41):
        z = np.linspace(0.0, -h, n)
        error.append(abs(Current((1.0 + z / h) ** 2, 0.5, z=z, draught=T).velocity[0] / np.cos(0.5) - exact))
    assert error[0] / error[1] == pytest.approx(4.0, rel=1e-6)
    assert error[1] / error[2] == pytest.approx(4.0, rel=1e-6)


def test_a_profile_may_turn():
    """Components are averaged, not angles: from ahead above, from starboard below."""
    turning = Current(1.0, [0.0, np.pi / 2], z=[0.0, -10.0], draught=10.0)
    assert turning.velocity == pytest.approx([0.5, 0.5, 0.0])


def test_a_uniform_profile_is_no_profile():
    assert Current([0.8, 0.8], 1.0, z=[0.0, -30.0], draught=7.0).velocity == pytest.approx(Current(0.8, 1.0).velocity)


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: Current(-1.0, 0.0),
        lambda: Current(1.0, 180.0),
        lambda: Current("fast", 0.0),
        lambda: Current(float("nan"), 0.0),
        lambda: Current([1.0, 2.0], 0.0),
        lambda: Current([1.0, 2.0], 0.0, z=[0.0, -10.0]),
        lambda: Current(1.0, 0.0, draught=5.0),
        lambda: Current([1.0, 2.0], 0.0, z=[0.0, -10.0], draught=12.0),
        lambda: Current([1.0, 2.0], 0.0, z=[-1.0, -10.0], draught=5.0),
        lambda: Current([1.0, 2.0, 3.0], 0.0, z=[0.0, -10.0], draught=5.0),
        lambda: Current([1.0, 2.0, 3.0], 0.0, z=[0.0, -10.0, -10.0], draught=5.0),
        lambda: Current([1.0, 2.0], 0.0, z=[0.0, -10.0], draught=-5.0),
    ],
)
def test_bad_input_is_refused(wrong):
    with pytest.raises(InputError):
        wrong()


def test_two_currents_are_refused():
    with pytest.raises(og.DoubleCountingError, match="current"):
        og.Vessel(AROUND.body, loads=(Current(1.0, 0.0), Current(0.5, 1.0)))
