"""Mooring from tables: no energy out of nothing, exact for exact tables, and an error at their ends."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from ogilvie.body import RigidBody
from ogilvie.errors import InputError
from ogilvie.frames import euler_rate_matrix, rotation_matrix
from ogilvie.loads.base import Load, Surroundings
from ogilvie.loads.mooring import LinearMooring
from ogilvie.loads.mooring_line import MooringLine
from ogilvie.loads.mooring_lines import CatenaryMooring
from ogilvie.loads.mooring_table import MooringTable

AROUND = Surroundings(RigidBody(mass=1.0, cog=[0, 0, 0], inertia=np.eye(3)))
R = np.linspace(0.0, 30.0, 31)
STIFFENING = 5e4 * R + 80.0 * R**3
X = np.linspace(-20.0, 20.0, 21)
ANGLE = np.linspace(-1.0, 1.0, 41)
POSE = np.array([6.0, -8.0, 1.0, 0.05, -0.1, 0.4])


def test_obeys_the_protocol():
    load = MooringTable((R, STIFFENING))
    assert isinstance(load, Load)
    assert load.covers == {"mooring"}
    assert load.bind(AROUND).kernel.force(eta=POSE) == pytest.approx(load.force(POSE))


@pytest.mark.parametrize("psi", [0.0, 1.3])
def test_radial_force_points_back_and_has_the_tables_size(psi):
    force = MooringTable((R, STIFFENING)).force([6.0, -8.0, 0, 0, 0, psi])
    world = rotation_matrix(0, 0, psi) @ force[:3]
    assert world == pytest.approx(-(5e5 + 80e3) * np.array([0.6, -0.8, 0.0]), rel=1e-9)
    assert force[3:] == pytest.approx(np.zeros(3), abs=1e-6)


def test_no_force_at_the_centre_and_the_slope_around_it():
    table = MooringTable((R, STIFFENING))
    assert table.force() == pytest.approx(np.zeros(6))
    assert table.force([0, 1e-6, 0, 0, 0, 0])[1] == pytest.approx(-0.05, rel=1e-6)


def test_turret_turns_the_ship():
    p = np.array([70.0, 0.0, -5.0])
    table = MooringTable((R, STIFFENING), point=p)
    eta = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.1])
    offset = rotation_matrix(0, 0, 0.1) @ p - p
    world = -np.interp(np.hypot(*offset[:2]), R, STIFFENING) * offset / np.linalg.norm(offset)
    body = rotation_matrix(0, 0, 0.1).T @ world
    assert table.force(eta) == pytest.approx(np.concatenate([body, np.cross(p, body)]), rel=2e-3, abs=1.0)
    assert table.force(eta)[5] < 0.0


def test_linear_tables_are_linear_mooring():
    k, psi = (2e5, 3e5, 4e8), 0.5
    table = MooringTable(tables={"surge": (X, k[0] * X), "sway": (X, k[1] * X), "yaw": (ANGLE, k[2] * ANGLE)}, heading=psi)
    K = LinearMooring(np.diag([k[0], k[1], 0, 0, 0, k[2]])).stiffness
    d = np.array([2.0, -3.0, 0.5, 0, 0, 0.2])
    eta = np.concatenate([rotation_matrix(0, 0, psi) @ d[:3], d[3:5], [psi + d[5]]])
    force = table.force(eta)
    force[:3] = rotation_matrix(0, 0, d[5]) @ force[:3]
    assert force == pytest.approx(-K @ d, rel=1e-9, abs=1e-3)


def test_yaw_does_not_count_turns():
    table = MooringTable(tables={"yaw": (ANGLE, 1e8 * ANGLE)}, heading=3.0)
    for turns in (-3, 0, 5):
        assert table.force([0, 0, 0, 0, 0, 3.3 + 2 * np.pi * turns])[5] == pytest.approx(-3e7, rel=1e-9)
        assert table.force([0, 0, 0, 0, 0, 2.7 + 2 * np.pi * turns])[5] == pytest.approx(3e7, rel=1e-9)


CASES = {
    "radial": MooringTable((R, STIFFENING), point=[40.0, 3.0, -6.0]),
    "radial and yaw": MooringTable((R, STIFFENING), tables={"yaw": (ANGLE, 1e8 * np.sin(3 * ANGLE))}, heading=0.1),
    "per degree of freedom": MooringTable(
        tables={"surge": (X, 1e4 * np.expm1(X / 8)), "sway": (X, 300 * X**3), "yaw": (ANGLE, 1e8 * np.tan(ANGLE))},
        point=[10.0, -4.0, 2.0],
        heading=0.3,
    ),
    "uneven": MooringTable(
        (30 * np.linspace(0, 1, 15) ** 1.5, 1e5 * np.sinh(np.linspace(0, 1, 15) ** 1.5)), interpolation="monotone"
    ),
}


@pytest.mark.parametrize("table", CASES.values(), ids=CASES)
def test_a_closed_path_costs_no_work(table):
    n = 2000
    s = 2 * np.pi * np.arange(n) / n
    amplitude = np.array([5.0, 4.0, 1.5, 0.1, 0.12, 0.3])
    phase = np.array([0.0, 1.0, 2.5, 0.4, 2.0, 4.0])
    path, rate = amplitude * np.sin(s[:, None] + phase), amplitude * np.cos(s[:, None] + phase)
    power = np.array([table.force(eta) @ _velocity(eta, d) for eta, d in zip(path, rate, strict=True)])
    assert np.all(np.isfinite(power))
    assert abs(power.mean()) < 2e-7 * np.abs(power).max()


def _velocity(eta, rate):
    turning = np.linalg.solve(euler_rate_matrix(eta[3], eta[4]), rate[3:])
    return np.concatenate([rotation_matrix(*eta[3:]).T @ rate[:3], turning])


def test_uniform_table_keeps_its_spline_and_uneven_ones_nearly():
    f = np.sinh
    for x, tolerance in ((np.linspace(-3, 3, 13), 1e-12), (3 * np.sin(np.linspace(-np.pi / 2, np.pi / 2, 13)), 1e-6)):
        spline, table = CubicSpline(x, f(x)), MooringTable(tables={"surge": (x, f(x))})
        at = np.linspace(-3, 3, 501)
        found = [-table.force([a, 0, 0, 0, 0, 0])[0] for a in at]
        assert found == pytest.approx(spline(at), abs=tolerance * 10)


def test_interpolation_error_falls_with_the_fourth_power():
    at = np.linspace(-2.9, 2.9, 301)
    errors = []
    for n in (21, 41):
        x = np.linspace(-3, 3, n)
        table = MooringTable(tables={"sway": (x, np.sinh(x))})
        errors.append(max(abs(table.force([0, a, 0, 0, 0, 0])[1] + np.sinh(a)) for a in at))
    assert np.log2(errors[0] / errors[1]) > 3.4


def test_monotone_interpolation_does_not_overshoot_a_kink():
    x, f = np.array([-4.0, -2, 0, 2, 4, 6]), np.array([0.0, 0, 0, 0, 1e6, 2e6])
    at = np.linspace(-4, 6, 401)
    found = {}
    for way in ("spline", "monotone"):
        table = MooringTable(tables={"surge": (x, f)}, interpolation=way)
        found[way] = np.array([-table.force([a, 0, 0, 0, 0, 0])[0] for a in at])
    assert found["monotone"].min() == 0.0
    assert found["spline"].min() < -1e4


def test_beyond_the_table_the_run_must_stop_or_go_on_straight():
    ends = MooringTable((R, STIFFENING))
    assert np.isfinite(ends.force([30.0, 0, 0, 0, 0, 0])).all()
    assert np.isnan(ends.force([30.001, 0, 0, 0, 0, 0])[0])
    assert np.isnan(ends.force([np.nan, 0, 0, 0, 0, 0])[0])
    on = MooringTable((R, STIFFENING), beyond="linear")
    inside, edge, outside = (-on.force([r, 0, 0, 0, 0, 0])[0] for r in (29.999, 30.0, 31.0))
    assert (edge - inside) / 1e-3 == pytest.approx(outside - edge, rel=1e-4)
    assert outside - edge == pytest.approx(5e4 + 240.0 * 900, rel=1e-6)
    both = MooringTable(tables={"surge": (X, X**3)}, beyond="linear")
    assert both.force([-22.0, 0, 0, 0, 0, 0])[0] == pytest.approx(8000.0 + 2 * 1200.0, rel=1e-9)
    assert both.force([22.0, 0, 0, 0, 0, 0])[0] == pytest.approx(-8000.0 - 2 * 1200.0, rel=1e-9)
    assert np.isnan(both.force([0, 0, 0, 0, 0, np.nan])).any()
    assert np.isnan(MooringTable(tables={"yaw": (ANGLE, ANGLE)}).force([0, 0, 0, 0, 0, 1.1])[5])


def test_table_of_a_spread_of_catenaries_stands_for_the_spread():
    lines = []
    for a in 2 * np.pi * np.arange(12) / 12:
        c, s = np.cos(a), np.sin(a)
        lines.append(MooringLine([700 * c, 700 * s, -100], [0, 0, -10], length=720.0, weight=1500.0, stiffness=8e8))
    mooring = CatenaryMooring(lines)
    r = np.linspace(0, 20, 41)
    table = MooringTable((r, [-mooring.force([x, 0, 0, 0, 0, 0])[0] if x else 0.0 for x in r]), point=[0, 0, -10])
    for angle, x in ((0.13, 4.3), (2.0, 11.1), (-1.1, 17.0)):
        eta = [x * np.cos(angle), x * np.sin(angle), 0, 0, 0, 0]
        assert table.force(eta)[[0, 1, 3, 4]] == pytest.approx(mooring.force(eta)[[0, 1, 3, 4]], rel=5e-3, abs=2e3)


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({}, "none found"),
        ({"radial": (R, STIFFENING), "tables": {"surge": (X, X)}}, "count twice"),
        ({"tables": {"heave": (X, X)}}, "surge, sway or yaw expected, heave"),
        ({"radial": (R + 1, STIFFENING)}, "offset 0 with force 0"),
        ({"radial": (R, STIFFENING + 1)}, "offset 0 with force 0"),
        ({"radial": (R[::-1], STIFFENING)}, "increase"),
        ({"radial": (R[:3], STIFFENING[:3])}, "4 or more"),
        ({"radial": (R, STIFFENING[:-1])}, "same length"),
        ({"radial": R}, r"\(displacements, forces\)"),
        ({"radial": (R, np.full(31, np.nan))}, "finite"),
        ({"radial": (R, ["a"] * 31)}, "numbers expected"),
        ({"tables": {"surge": (R, R)}}, "from negative to positive"),
        ({"tables": {"yaw": (X, X)}}, "-pi to pi"),
        ({"radial": (R, STIFFENING), "beyond": "hold"}, "beyond"),
        ({"radial": (R, STIFFENING), "interpolation": "cubic"}, "interpolation"),
        ({"radial": (R, STIFFENING), "point": [1.0]}, "point"),
        ({"radial": (R, STIFFENING), "centre": [1.0, np.nan]}, "centre"),
        ({"radial": (R, STIFFENING), "heading": np.inf}, "heading"),
    ],
)
def test_wrong_tables_are_refused(arguments, text):
    with pytest.raises(InputError, match=text):
        MooringTable(**arguments)
