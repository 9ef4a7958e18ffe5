"""From the sections on weather, damping, mooring and control to loads: units, defaults, files."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.app import build_control, build_loads
from ogilvie.app.build import make_hull
from ogilvie.app.build_loads import Made
from ogilvie.app.case import parse_case
from ogilvie.app.tables import read_columns
from ogilvie.errors import FormatError, InputError
from ogilvie.mesh.hydrostatics import hydrostatics
from ogilvie.units import deg, knot

BASE = """
[hull]
shape = "particulars"
length = 80.0
beam = 18.0
draught = 6.0
cb = 0.7
panels = 200
[body]
kg = 6.5
gyradii = [6.5, 20.0, 20.0]
[sea]
hs = 2.0
tp = 8.0
direction_deg = 150.0
"""
COEFFICIENTS = "frontal_area = 300.0\nlateral_area = 900.0\ncentroid_height = 5.0\n"
BLENDERMANN = f'[wind.blendermann]\ntype = "tender"\n{COEFFICIENTS}'


@pytest.fixture(scope="module")
def hull():
    return make_hull(parse_case(BASE))


@pytest.fixture(scope="module")
def body(hull):
    return og.RigidBody.from_hull(hull, kg=6.5, gyradii=(6.5, 20.0, 20.0))


@pytest.fixture(scope="module")
def hydro(hull, body):
    """Coefficients that are constant, with the stiffness of the hull."""
    w = np.linspace(0.2, 3.0, 29)
    A = np.tile(np.diag([5e5, 5e6, 6e6, 1.5e8, 2e9, 2e9]), (len(w), 1, 1))
    C = hydrostatics(hull, body=body).stiffness
    return og.hydro_from_arrays(omega=w, added_mass=A, radiation_damping=0.1 * A, hydrostatic_stiffness=C)


@pytest.fixture(scope="module")
def made(hull, body, hydro):
    return lambda text, **options: Made(parse_case(BASE + text, **options), body, hydro, hull)


def test_wind_goes_where_the_compass_says():
    """From the South-East by compass, x East: towards 135 deg; knots become m/s."""
    case = parse_case(BASE + "[simulation]\nrealisations = 3\nduration = 90.2\n[wind]\nspeed_knots = 20.0\nfrom_deg = 135.0\n"
                      'gust = "npd"\n' + BLENDERMANN)  # fmt: skip
    wind = build_loads.make_wind(case)
    assert wind.direction == pytest.approx(135 * deg)
    assert wind.speed == pytest.approx(20 * knot)
    assert wind.seeds == (1, 2, 3)
    assert wind.period == 90.5


def test_wind_coefficients_take_the_length_of_the_hull(made, hull):
    found = build_loads.wind_coefficients(made("[wind]\nspeed = 10.0\ndirection_deg = 0.0\n" + BLENDERMANN))
    assert found.length == hull.length


def test_wind_coefficients_from_a_file(made, tmp_path):
    rows = [f"{a}; {np.cos(a * deg):.6f}; {np.sin(a * deg) if 0 < a < 180 else 0:.6f}" for a in range(0, 181, 10)]
    (tmp_path / "wind.csv").write_text("angle; CX; CY\n" + "\n".join(rows))
    text = "[wind]\nspeed = 10.0\ndirection_deg = 0.0\n"
    text += '[wind.table]\nfile = "wind.csv"\nfrontal_area = 300.0\nlateral_area = 900.0\n'
    found = build_loads.wind_coefficients(made(text, folder=tmp_path))
    np.testing.assert_allclose(found(90 * deg), [0.0, 1.0, 0.0, 0.0], atol=1e-5)


def test_a_current_profile_is_averaged_over_the_draught(made):
    m = made("[current]\ndirection_deg = 90.0\nprofile = [[0.0, 2.0], [-12.0, 0.0]]\n")
    np.testing.assert_allclose(build_loads.make_current(m.case, m.hull).velocity, [0.0, 1.5, 0.0], atol=1e-6)


def test_hull_lift_acts_at_the_after_end(made, hull):
    lift = build_loads.hull_lift(made("[hull_lift]\n"))
    assert lift.x == hull.bounds[0, 0]
    assert 0.0 < lift.draught <= 6.0
    assert build_loads.hull_lift(made("[hull_lift]\ndraught = 5.5\nx = -38.0\n")).draught == 5.5


def test_resistance_is_balanced_at_the_vessels_speed(made):
    load = build_loads.resistance(made("[resistance]\nform_factor = 0.2\n[vessel]\nspeed_knots = 12.0\n"))
    assert load.thrust == pytest.approx(float(load.resistance(12 * knot)))
    assert load.thrust > 1e4
    kept = build_loads.resistance(made("[resistance]\n[speed_keeping]\n[vessel]\nspeed_knots = 12.0\n"))
    assert kept.thrust == 0.0


def test_resistance_from_a_file(made, tmp_path):
    (tmp_path / "r.csv").write_text("# m/s, N\n0,0\n4,40e3\n8,160e3\n12,360e3\n")
    load = build_loads.resistance(made('[resistance]\nfile = "r.csv"\n', folder=tmp_path))
    assert float(load.resistance(6.0)) == pytest.approx(90e3)


@pytest.mark.parametrize("kind", ["gz", "hull"])
def test_restoring_at_large_heel_starts_as_the_linear_one(kind, made, hydro):
    """The roll stiffness m g GM of the hull cut by the water is that of hydrostatics."""
    load = build_loads.restoring(made(f'[restoring]\nkind = "{kind}"\nmax_roll_deg = 30.0\n'))
    assert load.stiffness[3, 3] == pytest.approx(hydro.hydrostatic_stiffness.values[3, 3], rel=0.03)


def test_a_righting_lever_of_a_file_in_degrees(made, body, tmp_path):
    (tmp_path / "gz.csv").write_text("0 0\n10 0.2\n20 0.4\n30 0.55\n40 0.6\n")
    load = build_loads.restoring(made('[restoring]\nkind = "gz"\nfile = "gz.csv"\n', folder=tmp_path))
    force = load.bind(None).kernel.force(eta=[0, 0, 0, 20 * deg, 0, 0])
    assert force[3] == pytest.approx(-body.mass * 9.80665 * 0.4, rel=1e-6)


def test_damping_by_parts(made):
    text = "[damping]\nlinear = { sway = 2e5 }\nquadratic = { roll = 3e8, surge = 1e4 }\ncubic = { roll = 1e9 }\n"
    linear, quadratic, roll = build_loads.plain_loads(made(text))
    assert linear.matrix[1, 1] == 2e5
    assert quadratic.matrix[0, 0] == 1e4
    assert (roll.quadratic, roll.cubic) == (3e8, 1e9)


def test_ikeda_rolls_at_the_natural_period(made, hydro, body):
    (load,) = build_loads.plain_loads(made("[damping.ikeda]\nkeel_start = -15.0\nkeel_end = 15.0\nkeel_breadth = 0.4\n"))
    C, A = hydro.hydrostatic_stiffness.values[3, 3], hydro.added_mass.values[0, 3, 3]
    assert load.omega == pytest.approx(np.sqrt(C / (body.matrix[3, 3] + A)), rel=1e-2)
    assert min(load.coefficients(speed=0.0)[1:]) >= 0.0


def test_lines_share_what_mooring_gives(made):
    text = "[mooring]\nlength = 200.0\nweight = 500.0\nstiffness = 1e8\nlines = ["
    text += "{ anchor = [180, 0, -60], fairlead = [38, 0, -3] },"
    text += "{ anchor = [-180, 0, -60], fairlead = [-38, 0, -3], weight = 700 }]\n"
    lines = build_control.make_lines(made(text))
    assert [line.weight for line in lines.lines] == [500.0, 700.0]
    assert {line.length for line in lines.lines} == {200.0}


def test_a_mooring_table_holds_back(made, tmp_path):
    (tmp_path / "x.csv").write_text("-20,-4e5\n-10,-1e5\n0,0\n10,1e5\n20,4e5\n")
    (tmp_path / "psi.csv").write_text("-20,-4e7\n-10,-1e7\n0,0\n10,1e7\n20,4e7\n")
    load = build_control.mooring(made('[mooring.table]\nsurge = "x.csv"\nyaw = "psi.csv"\n', folder=tmp_path))
    force = load.force([10.0, 0, 0, 0, 0, 10 * deg])
    assert np.hypot(*force[:2]) == pytest.approx(1e5)
    assert force[5] == pytest.approx(-1e7)


def test_autopilot_and_rudder_in_degrees(made, hull):
    text = "[vessel]\nspeed_knots = 10.0\n[autopilot]\nschedule = [[0.0, 5.0], [60.0, 25.0]]\nmax_rate_deg = 0.5\n"
    pilot = build_control._autopilot(made(text + "[autopilot.rudder]\narea = 15.0\n"))
    np.testing.assert_allclose(pilot.heading, [[0.0, 5 * deg], [60.0, 25 * deg]])
    assert pilot.max_rate == pytest.approx(0.5 * deg)
    assert pilot.rudder.position[0] == hull.bounds[0, 0]
    assert pilot.rudder.max_angle == pytest.approx(35 * deg)


def test_a_wave_filter_is_tuned_to_the_encounter(made):
    m = made("[vessel]\nspeed_knots = 10.0\n[autopilot]\nmax_moment = 1e8\nwave_filter = true\n")
    w = 2 * np.pi / 8.0
    expected = w + w**2 / 9.80665 * 10 * knot * np.cos(30 * deg)
    assert build_control.encounter_peak(m) == pytest.approx(expected, rel=1e-3)
    assert build_control._autopilot(m).wave_filter.wave_frequency == pytest.approx(expected, rel=1e-3)


def test_waves_that_cannot_be_told_from_the_ships_own_motion(made):
    m = made("[vessel]\nspeed_knots = 24.0\n[autopilot]\nmax_moment = 1e8\nwave_filter = true\n")
    case = parse_case(m.case.text.replace("direction_deg = 150.0", "direction_deg = 0.0"))
    with pytest.raises(InputError, match=r"autopilot.wave_filter: true: waves met at 2 times natural_frequency 0.06"):
        build_control.try_parts(case, m.hull)


THRUSTER = '[[positioning.thrusters]]\nkind = "{}"\nx = {}\nmax_thrust = 1e5\n'


def test_thrusters_by_kind(made):
    text = "[positioning]\nheading_deg = 90.0\n" + THRUSTER.format("azimuth", -35.0) + THRUSTER.format("tunnel", 30.0)
    keeper = build_control._positioning(made(text))
    np.testing.assert_allclose(keeper.setpoint, [[0.0, 0.0, 0.0, np.pi / 2]])
    assert [unit.name for unit in keeper.thrusters] == ["azimuth 1", "tunnel 2"]
    assert keeper.thrusters[1].direction == pytest.approx(np.pi / 2)
    assert keeper.wave_filter is not None


def test_thrusters_that_cannot_hold_are_told_before_the_long_work(made):
    m = made("[positioning]\n" + THRUSTER.format("tunnel", 30.0))
    with pytest.raises(InputError, match="cannot act in surge"):
        build_control.try_parts(m.case, m.hull)


@pytest.mark.parametrize("text", ["1,2\n3,4\n", "x;y\n1;2\n3;4\n", "# note\n\n1 2\n3\t4  # end\n", "a, b\n1.0 , 2e0\n3,4"])
def test_tables_in_several_hands(text, tmp_path):
    (tmp_path / "t.csv").write_text(text)
    x, y = read_columns(tmp_path / "t.csv", columns=(2,), what="x, y")
    assert (x.tolist(), y.tolist()) == ([1.0, 3.0], [2.0, 4.0])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1,2\n3;x\n", r"t.csv line 2: numbers \(x, y\) expected, '3;x' found"),
        ("1,2\n3,4,5\n", "line 2: 2 columns .* expected, 3 found"),
        ("1,2,3\n", "line 1: 2 columns .* expected, 3 found"),
        ("1,nan\n", "line 1: finite numbers expected"),
        ("only words\n", "rows of numbers .* expected, none found"),
    ],
)
def test_tables_that_are_none(text, message, tmp_path):
    (tmp_path / "t.csv").write_text(text)
    with pytest.raises(FormatError, match=message):
        read_columns(tmp_path / "t.csv", columns=(2,), what="x, y")
