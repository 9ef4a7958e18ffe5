"""Reference filter, set-points in time and pole placement, against closed forms."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.loads.control.pid import check_sampling, pid_gains, spectral_radius
from ogilvie.loads.control.reference import heading_reference_step, reference_data, reference_step, wrapped
from ogilvie.loads.control.schedule import row_at, schedule
from ogilvie.units import deg


def course(data, target, n, *, start=0.0, step=reference_step):
    state, out = np.array([start, 0.0, 0.0]), []
    for _ in range(n):
        out.append(state.copy())
        step(data, state, target)
    return np.array(out)


@pytest.mark.parametrize("period", [0.1, 1.0, 20.0])
def test_step_response_is_the_closed_form_at_every_period(period):
    w = 0.1
    x = course(reference_data(w, period), 2.0, 80)
    t = w * period * np.arange(80)
    assert x[:, 0] == pytest.approx(2 * (1 - (1 + t + t**2 / 2) * np.exp(-t)), abs=1e-12)
    assert x[:, 1] == pytest.approx(w * t**2 * np.exp(-t), abs=1e-12)
    assert x[:, 2] == pytest.approx(w**2 * (2 * t - t**2) * np.exp(-t), abs=1e-12)


def test_under_damped_filter_has_its_three_poles():
    w, z, T = 0.2, 0.4, 0.5
    Phi = reference_data(w, T, damping=z)[:9].reshape(3, 3)
    poles = np.array([-w, w * (-z + 1j * np.sqrt(1 - z**2)), w * (-z - 1j * np.sqrt(1 - z**2))])
    assert np.sort_complex(np.linalg.eigvals(Phi)) == pytest.approx(np.sort_complex(np.exp(poles * T)), abs=1e-12)


def test_limited_rate_is_held_and_does_not_overshoot():
    w, vmax, T = 0.1, 0.01, 0.5
    x = course(reference_data(w, T, max_rate=vmax), 1.0, 600)
    assert x[:, 1].max() == vmax
    assert np.all(np.diff(x[:, 0]) >= 0.0)
    assert x[:, 0].max() <= 1.0
    assert x[-1, 0] == pytest.approx(1.0, abs=1e-5)
    cruising = x[:, 1] == vmax
    assert np.diff(x[cruising, 0]) == pytest.approx(vmax * T)
    assert cruising.sum() * T == pytest.approx((1.0 - 3 * vmax / w) / vmax, rel=0.2)  # leaves it at 3 v / w before the target


def test_heading_goes_the_shorter_way_round():
    x = course(reference_data(0.2, 0.5), 179 * deg, 300, start=-179 * deg, step=heading_reference_step)[:, 0]
    assert x[-1] == pytest.approx(-181 * deg)
    assert np.ptp(x) == pytest.approx(2 * deg)
    turned = course(reference_data(0.2, 0.5), 0.1, 300, start=8 * np.pi, step=heading_reference_step)[:, 0]
    assert turned[-1] == pytest.approx(8 * np.pi + 0.1)


def test_wrapped_angles():
    angle = np.linspace(-20, 20, 401)
    out = np.array([wrapped(a) for a in angle])
    assert np.exp(1j * out) == pytest.approx(np.exp(1j * angle), abs=1e-12)
    assert out.min() >= -np.pi
    assert out.max() < np.pi


def test_rows_hold_from_their_time_on():
    rows = schedule([(10.0, 1.0, 2.0), (20.0, 3.0, 4.0)], 2, "setpoint")
    flat = rows.ravel()
    assert [flat[row_at(flat, 2, 2, t)] for t in (0.0, 10.0, 19.9, 20.0, 1e6)] == [1, 1, 1, 3, 3]


@pytest.mark.parametrize("value", [[1.0, 2.0], "north", [(0, 1.0), (0, 2.0)], np.nan, [(0, np.inf)], []])
def test_wrong_set_points_are_refused(value):
    with pytest.raises(og.InputError, match="heading"):
        schedule(value, 1, "heading")


def test_poles_are_where_they_were_placed():
    M, D = np.array([[3.0, 0, 0], [0, 5.0, 1.0], [0, 1.0, 9.0]]), np.diag([0.3, 0.4, 0.5])
    w, z = np.array([0.1, 0.2, 0.3]), np.array([0.7, 1.0, 1.2])
    Kp, Ki, Kd = pid_gains(M, D, w, z)
    I, Z = np.eye(3), np.zeros((3, 3))
    inv = np.linalg.inv(M)
    A = np.block([[Z, I, Z], [-inv @ Kp, -inv @ (D + Kd), inv], [-Ki, Z, Z]])
    wanted = np.concatenate([[-0.1 * wi, *np.roots([1, 2 * zi * wi, wi**2])] for wi, zi in zip(w, z, strict=True)])
    found = np.linalg.eigvals(A)
    assert max(np.abs(found - p).min() for p in wanted) < 1e-6  # double poles are found to the root of rounding


def test_sampling_too_slow_is_refused():
    M, D = np.eye(1), np.zeros((1, 1))
    gains = pid_gains(M, D, np.ones(1), np.ones(1))
    check_sampling(M, D, gains, 0.5, "x")
    assert spectral_radius(M, D, gains, 1e-3) == pytest.approx(np.exp(-0.1e-3), abs=1e-6)
    with pytest.raises(og.InputError, match="not stable at a sampling period of 2 s"):
        check_sampling(M, D, gains, 2.0, "x")
