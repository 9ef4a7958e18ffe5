"""Mistakes in the sections on forces and control: each is told with its path, what was found and what is expected."""

import re

import pytest
from typer.testing import CliRunner

from ogilvie.app.case import parse_case
from ogilvie.app.cli import app
from ogilvie.app.demo import shipped_cases
from ogilvie.errors import InputError

CASES = shipped_cases()
SHIP, SUPPLY, TANKER = (CASES[name] for name in ("container_ship", "supply_vessel", "moored_tanker"))


def mistakes(text: str, **options) -> list[str]:
    with pytest.raises(InputError) as error:
        parse_case(text, **options)
    first, *rest = str(error.value).splitlines()
    assert f"{len(rest)} mistake" in first
    return [line.strip() for line in rest]


def changed(text: str, old: str, new: str) -> str:
    assert old in text
    return text.replace(old, new, 1)


def without(text: str, section: str) -> str:
    found, count = re.subn(rf"^\[{re.escape(section)}\].*?(?=^\[|\Z)", "", text, flags=re.DOTALL | re.MULTILINE)
    assert count == 1
    return found


ONE = [
    (
        without(SHIP, "wind.blendermann"),
        "wind: exactly one of [wind.blendermann], [wind.isherwood] and [wind.table] expected, none",
    ),
    (
        changed(SHIP, 'gust = "npd"', "from_deg = 210.0"),
        "wind: exactly one of direction_deg (to, anticlockwise from x) and from_deg",
    ),
    (changed(SHIP, "ship, loaded", "ship loaded"), 'wind.blendermann.type: "container ship loaded": one of "car carrier"'),
    (changed(SHIP, '"npd"', '"harris"'), 'wind.gust: "harris": one of "npd", "api", "none" expected.'),
    (changed(SHIP, "speed = 14.0", "speed = 0.0"), 'wind.gust: "npd": a wind speed > 0 expected, 0 found.'),
    (
        changed(SHIP, "speed_knots = 1.0", "speed_knots = 1.0\nspeed = 0.5"),
        "current: exactly one of speed (m/s) and speed_knots",
    ),
    (changed(SHIP, "\ndirection_deg = 120.0", ""), "current.direction_deg: expected, not found."),
    (
        changed(SHIP, "[autopilot]\n", "[autopilot]\nmax_moment = 1e8\n"),
        "autopilot: exactly one of [autopilot.rudder] and max_moment",
    ),
    (changed(SHIP, "area = 32.0\n", ""), "autopilot.rudder.area: expected, not found."),
    (changed(SHIP, "keel_end = 22.0\n", ""), "damping.ikeda: keel_start, keel_end and keel_breadth expected together"),
    (changed(SHIP, "keel_end = 22.0", "keel_end = -30.0"), "damping.ikeda.keel_end: -30: more than keel_start -22 expected"),
    (
        changed(SHIP, "[simulation]", '[simulation]\nmotions = "small"'),
        'simulation.motions: "small": "large" or "auto" expected with resistance, wind, current, autopilot, speed_keeping',
    ),
    (changed(SHIP, "[simulation]", '[simulation]\nmethod = "exact"'), 'simulation.method: "exact": "rk4" expected for large'),
    (
        changed(SHIP, "[memory]", '[memory]\nmodel = "convolution"'),
        'memory.model: "convolution": "state-space" expected for large',
    ),
    (
        changed(SHIP, "form_factor = 0.15", "balanced = true"),
        "resistance.balanced: a constant thrust and [speed_keeping] would both",
    ),
    (changed(SHIP, "form_factor = 0.15", 'residuary = "no.csv"'), 'resistance.residuary: "no.csv": no such file'),
    (SHIP + "[loads]\ndamping_ratio = { roll = 0.05 }\n", "loads.damping_ratio.roll: ikeda holds the damping of roll already"),
    (SHIP + "[restoring]\nkind = 'GZ'\n", 'restoring.kind: "GZ": one of "linear", "gz", "hull" expected; did you mean "gz"?'),
    (SHIP + "[restoring]\nmax_roll_deg = 40.0\n", 'restoring.max_roll_deg: not used by kind "linear". Remove it'),
    (
        changed(SHIP, "heading_deg = 0.0\nnat", "schedule = [[0.0, 0.0], [9.0, 20.0], [8.0, 0.0]]\nnat"),
        "autopilot.schedule: rows that",
    ),
    (
        changed(SHIP, "heading_deg = 0.0\nnat", "schedule = [[0.0, 0.0, 1.0]]\nnat"),
        "autopilot.schedule[0]: [0.0, 0.0, 1.0]: at most 2",
    ),
    (changed(SHIP, "[hull_lift]", "[hull_lft]"), 'hull_lft: unknown section; did you mean "hull_lift"? Allowed: title, vessel'),
    (
        changed(SUPPLY, 'kind = "tunnel"', 'kind = "bow"'),
        'positioning.thrusters[2].kind: "bow": one of "fixed", "tunnel", "azimuth"',
    ),
    (changed(SUPPLY, "max_thrust = 160.0e3\n", ""), "positioning.thrusters[2].max_thrust: expected, not found."),
    (
        changed(SUPPLY, "wave_filter = true", "period = 0.25"),
        "positioning.period: 0.25: a multiple of simulation.dt = 0.1 s expected.",
    ),
    (changed(SUPPLY, "[-10.0, 0.5]", "[10.0, 0.5]"), "current.profile: rows [z, speed] with z <= 0 (below the water)"),
    (changed(SUPPLY, "linear = { surge", "quadratic = { sway"), "damping.quadratic.sway: cross_flow holds it already"),
    (changed(TANKER, "weight = 1500.0", ""), "mooring.weight: expected here for all lines, or in each of them, not found."),
    (
        changed(TANKER, "617.0,  745.0, -150.0", "617.0, 745.0"),
        "mooring.lines[1].anchor[2]: a number expected, the list ends before it.",
    ),
    (
        changed(TANKER, "617.0,  745.0, -150.0", "617.0, 745.0, -151.0"),
        "mooring.lines[1].anchor: z = -151 m: not below the bottom",
    ),
    (
        TANKER + "[loads]\nmooring_period = { surge = 90.0 }\n",
        "mooring: the springs of [loads] (mooring_period, mooring_stiffness)",
    ),
    (
        changed(TANKER, "length = 930.0", "lenght = 930.0"),
        'mooring.lenght: unknown key; did you mean "length"? Allowed: lines,',
    ),
    (
        changed(SHIP, 'forward_speed = "rule"', 'solver = "time-domain"'),
        'coefficients.solver: "time-domain" solves at rest; a vessel with speed needs forward_speed = "rule".',
    ),
    (
        changed(SHIP, 'forward_speed = "rule"', 'forward_speed = "rule"\nsolver = "time-domain"\ncache = false'),
        'coefficients.cache: only with solver = "frequency-domain". Remove it.',
    ),
    (changed(TANKER, "length = 930.0", "table = {}"), "mooring: exactly one of [[mooring.lines]], [mooring.table]"),
]


@pytest.mark.parametrize(("text", "sentence"), ONE)
def test_a_mistake_in_one_section(text, sentence):
    assert any(line.startswith(sentence) for line in mistakes(text)), mistakes(text)


def test_a_key_of_a_line_that_is_misspelt():
    found = mistakes(changed(TANKER, "{ anchor = [ 741.0,  643.0", "{ ancor = [ 741.0,  643.0"))
    assert found == [
        "mooring.lines[0].anchor: expected, not found.",
        'mooring.lines[0].ancor: unknown key; did you mean "anchor"? Allowed: anchor, fairlead, length, weight, stiffness, '
        "friction, grounded.",
    ]


def test_a_broken_hull_is_one_mistake():
    assert mistakes(changed(SHIP, "panels = 800", "panels = 2")) == ["hull.panels: 2: a number >= 8 expected."]


def test_what_a_hull_would_tell_has_to_be_given_without_one(tmp_path):
    (tmp_path / "a.nc").write_text("")
    text = without(without(SHIP, "hull"), "coefficients") + '[coefficients]\nfile = "a.nc"\n'
    paths = [line.split(":")[0] for line in mistakes(text, folder=tmp_path)]
    for path in ("resistance.wetted_area", "hull_lift.x", "wind.blendermann.length", "autopilot.rudder.z", "damping.ikeda"):
        assert path in paths


def test_a_rudder_in_a_ship_that_lies_still():
    found = mistakes(changed(SHIP, "speed_knots = 18.0", "speed_knots = 0.0"))
    assert found[0].startswith("autopilot.rudder: a rudder needs vessel.speed_knots > 0, 0 found.")


def test_positioning_steers_alone():
    found = mistakes(SUPPLY + "[autopilot]\nmax_moment = 1e8\n")
    assert found == ["positioning: it steers and drives already; remove [autopilot] or [positioning]."]


def test_a_hull_that_ends_at_the_water_has_no_righting_levers():
    text = changed(changed(SUPPLY, "depth = 8.0\ncb = 0.70\n", ""), '"particulars"', '"box"')
    text += '[restoring]\nkind = "hull"\n'
    assert mistakes(text) == [
        'restoring.kind: "hull": a hull up to its deck expected; shape "box" ends at the water. '
        "Give a file that goes on above it."
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (changed(TANKER, "stiffness = 9.0e8", "stiffness = 9.0e5"), "mooring.lines[0]: MooringLine: stiffness EA above"),
        (changed(SUPPLY, 'kind = "tunnel"\nx = 33.0', 'kind = "fixed"\nx = 0.0'), ""),
        (changed(SHIP, "form_factor = 0.15", 'residuary = "r.csv"'), "r.csv line 2: numbers (Froude number, residuary"),
    ],
)
def test_check_tells_what_only_the_making_finds(text, message, tmp_path):
    """Before the long work, with exit code 2 and nothing written."""
    (tmp_path / "a.toml").write_text(text)
    (tmp_path / "r.csv").write_text("0.1, 0.001\n0.2, many\n")
    for command in ("check", "run") if message else ("check",):
        result = CliRunner().invoke(app, [command, str(tmp_path / "a.toml")])
        assert result.exit_code == (2 if message else 0)
        assert message in " ".join(result.stderr.split())
        assert sorted(p.name for p in tmp_path.iterdir()) == ["a.toml", "r.csv"]


@pytest.mark.parametrize(
    ("extra", "large"),
    [
        ("", False),
        ("[hull_lift]\n", False),
        ("[damping]\nlinear = { sway = 1e5 }\n", False),
        ("[damping]\nquadratic = { roll = 1e8 }\n", True),
        ("[damping.ikeda]\nmodel = 'linear'\n", False),
        ("[restoring]\nkind = 'gz'\n", True),
        ("[current]\nspeed = 1.0\ndirection_deg = 0.0\n", True),
        ("[simulation]\nmotions = 'large'\n", True),
        ("[simulation]\nmotions = 'small'\n[restoring]\nkind = 'gz'\n", False),
    ],
)
def test_motions_follow_what_is_given(extra, large):
    text = without(without(CASES["s175"], "simulation"), "loads")
    assert parse_case(text + extra).large == large
