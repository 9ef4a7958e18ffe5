"""A user's own force: what it gets, what it may return."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.loads.control import UserForce


def spring(t, eta, nu):
    return -1e3 * eta + t * np.eye(6)[0] - nu


def test_call_hands_on_time_pose_and_velocity():
    eta, nu = np.arange(6.0), np.ones(6)
    assert UserForce(spring, 0.5).call(2.0, eta, nu) == pytest.approx(-1e3 * eta + 2.0 * np.eye(6)[0] - nu)


def test_the_function_cannot_change_the_state():
    def vandal(t, eta, nu):
        eta[:] = nu[:] = 7.0
        return np.zeros(6)

    eta, nu = np.zeros(6), np.zeros(6)
    UserForce(vandal, 0.5).call(0.0, eta, nu)
    assert not eta.any()
    assert not nu.any()


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (np.zeros(3), r"shape \(6,\) about O expected, \(3,\) found"),
        ([0, 0, np.nan, 0, 0, 0], "finite numbers expected"),
        (None, "six|shape"),
        ("force", "six numbers"),
        ([[1, 2], [3]], "six numbers"),
    ],
)
def test_what_is_not_a_force_is_refused_by_name(value, words):
    def tow(t, eta, nu):
        return value

    with pytest.raises(og.InputError, match=words) as error:
        UserForce(tow, 0.5, name="tug").call(3.0, np.zeros(6), np.zeros(6))
    assert "'tug': function tow at t = 3 s" in str(error.value)


def test_errors_of_the_function_pass_through_with_a_note():
    def broken(t, eta, nu):
        return 1 / 0

    with pytest.raises(ZeroDivisionError) as error:
        UserForce(broken, 0.5).call(3.0, np.zeros(6), np.zeros(6))
    assert error.value.__notes__ == ["Raised in UserForce 'user': function broken at t = 3 s."]


def test_covers_are_the_users():
    assert UserForce(spring, 1.0).covers == frozenset()
    assert UserForce(spring, 1.0, covers={"mooring"}).covers == {"mooring"}


@pytest.mark.parametrize(
    ("function", "period", "more", "words"),
    [
        (3.0, 1.0, {}, "a function"),
        (spring, 0.0, {}, "period"),
        (spring, 1.0, {"name": ""}, "name"),
        (spring, 1.0, {"covers": "mooring"}, "covers"),
    ],
)
def test_wrong_arguments_are_refused(function, period, more, words):
    with pytest.raises(og.InputError, match=words):
        UserForce(function, period, **more)
