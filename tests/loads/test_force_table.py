"""A tabulated force: exact at the table, of fourth order between, in three frames, nothing outside."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.errors import InputError
from ogilvie.frames import rotation_matrix
from ogilvie.loads.base import SLOW_DRIFT, Load, Surroundings
from ogilvie.loads.force_table import ForceTable
from ogilvie.loads.kernel import situation

BODY = og.RigidBody(mass=1.0, cog=[0, 0, 0], inertia=np.eye(3))
TIME = 5.0 + 0.25 * np.arange(81)
RNG = np.random.default_rng(7)
FORCE = RNG.normal(size=(81, 6))
POSE = [10.0, -3.0, 0.5, 0.3, -0.2, 2.5]


def blocks(R):
    return np.kron(np.eye(2), R)


def test_it_passes_through_the_table():
    kernel = ForceTable(TIME, FORCE, frame="body").kernel
    for k in (0, 1, 40, 79, 80):
        assert kernel.force(t=TIME[k], eta=POSE) == pytest.approx(FORCE[k], abs=1e-12)


def test_it_is_the_cubic_spline():
    from scipy.interpolate import CubicSpline

    kernel, spline = ForceTable(TIME, FORCE, frame="body").kernel, CubicSpline(TIME, FORCE)
    for t in RNG.uniform(TIME[0], TIME[-1], 50):
        assert kernel.force(t=t) == pytest.approx(spline(t), abs=1e-11)


def test_a_cubic_is_exact_and_the_error_falls_with_the_fourth_power():
    coefficients = RNG.normal(size=(6, 4))
    cubic = np.stack([np.polyval(c, TIME / 10.0) for c in coefficients], axis=-1)
    assert ForceTable(TIME, cubic, frame="body").kernel.force(t=9.1) == pytest.approx(
        [np.polyval(c, 0.91) for c in coefficients], rel=1e-10
    )
    error = []
    for n in (41, 81, 161):
        t = np.linspace(0.0, 10.0, n)
        kernel = ForceTable(t, np.sin(t)[:, None] * np.ones(6), frame="body").kernel
        at = 4.0 + 0.5 * (t[1] - t[0])
        error.append(abs(kernel.force(t=at)[2] - np.sin(at)))
    assert np.log2(error[0] / error[1]) == pytest.approx(4.0, abs=0.3)
    assert np.log2(error[1] / error[2]) == pytest.approx(4.0, abs=0.3)


def test_frames():
    """The same physical force, given in three frames, is one force on the body."""
    R, Rz = rotation_matrix(*POSE[3:]), rotation_matrix(0.0, 0.0, POSE[5])
    k = 33
    world = ForceTable(TIME, FORCE, frame="world").kernel.force(t=TIME[k], eta=POSE)
    assert world == pytest.approx(blocks(R.T) @ FORCE[k], abs=1e-12)
    heading = ForceTable(TIME, FORCE).kernel.force(t=TIME[k], eta=POSE)
    assert heading == pytest.approx(blocks(R.T @ Rz) @ FORCE[k], abs=1e-12)
    in_heading = FORCE @ blocks(Rz.T).T
    assert ForceTable(TIME, in_heading, frame="heading").kernel.force(t=TIME[k], eta=POSE) == pytest.approx(world, abs=1e-12)
    in_body = FORCE @ blocks(R.T).T
    assert ForceTable(TIME, in_body, frame="body").kernel.force(t=TIME[k], eta=POSE) == pytest.approx(world, abs=1e-12)


def test_whole_turns_of_the_heading_do_not_matter():
    kernel = ForceTable(TIME, FORCE).kernel
    turned = [*POSE[:5], POSE[5] + 6 * np.pi]
    assert kernel.force(t=8.0, eta=turned) == pytest.approx(kernel.force(t=8.0, eta=POSE), abs=1e-12)


def test_it_ends_with_the_table():
    kernel = ForceTable(TIME, FORCE, frame="body").kernel
    for t in (-1.0, 4.999, 25.001, 1e6):
        assert not kernel.force(t=t).any()


def test_the_force_is_added():
    kernel = ForceTable(TIME, FORCE, frame="world").kernel
    total = np.arange(6.0)
    kernel.function(situation(8.0, POSE), kernel.data, kernel.own[0], total)
    assert total == pytest.approx(np.arange(6.0) + kernel.force(t=8.0, eta=POSE))


def test_realisations_have_their_own_rows():
    both = np.stack([FORCE, 2.0 * FORCE])
    kernel = ForceTable(TIME, both, frame="body").kernel
    one, two = np.zeros(6), np.zeros(6)
    kernel.function(situation(8.1), kernel.data, kernel.own[0], one)
    kernel.function(situation(8.1), kernel.data, kernel.own[1], two)
    assert two == pytest.approx(2.0 * one)
    assert one == pytest.approx(ForceTable(TIME, FORCE, frame="body").kernel.force(t=8.1))


def test_it_covers_what_it_stands_for():
    plain = ForceTable(TIME, FORCE)
    assert isinstance(plain, Load)
    assert plain.covers == {"force_table"}
    drift = ForceTable(TIME, FORCE, name="drift", covers={SLOW_DRIFT})
    assert drift.bind(Surroundings(BODY)).kernel is not None
    with pytest.raises(og.DoubleCountingError, match=SLOW_DRIFT):
        og.Vessel(BODY, loads=(drift, ForceTable(TIME, FORCE, name="other", covers={SLOW_DRIFT})))


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: ForceTable(TIME[:3], FORCE[:3]),
        lambda: ForceTable(TIME**2, FORCE),
        lambda: ForceTable(TIME[::-1], FORCE),
        lambda: ForceTable(TIME, FORCE[:, :3]),
        lambda: ForceTable(TIME, FORCE[:-1]),
        lambda: ForceTable(TIME, np.where(FORCE > 1.0, np.nan, FORCE)),
        lambda: ForceTable("now", FORCE),
        lambda: ForceTable(TIME, FORCE, frame="ship"),
        lambda: ForceTable(TIME, FORCE, covers="slow drift"),
    ],
)
def test_bad_input_is_refused(wrong):
    with pytest.raises(InputError):
        wrong()
