"""Case files: every mistake is reported at once, with its path, what was found and what is expected."""

import tomllib

import pytest

from ogilvie.app.case import parse_case, read_case
from ogilvie.app.demo import demo_text
from ogilvie.errors import FormatError, InputError

GOOD = """
[hull]
shape = "s175"
[body]
kg = 9.5
gyradii = [8.3, 42.0, 42.0]
[sea]
hs = 4.0
tp = 10.0
"""


def mistakes(text: str, **options) -> list[str]:
    with pytest.raises(InputError) as error:
        parse_case(text, **options)
    first, *rest = str(error.value).splitlines()
    assert f"{len(rest)} mistake" in first
    return [line.strip() for line in rest]


def changed(old: str, new: str) -> str:
    assert old in GOOD
    return GOOD.replace(old, new)


def test_defaults_fill_what_is_left_out():
    case = parse_case(GOOD, name="x")
    assert case.title == "x"
    assert (case.water.rho, case.memory.r2, case.sea.gamma) == (1025.0, 0.99, 3.3)
    assert case.water.depth == float("inf")


def test_the_demo_case_has_no_mistakes():
    case = parse_case(demo_text())
    assert case.hull.shape == "s175"
    assert tomllib.loads(case.text)["title"] == case.title


def test_all_mistakes_are_reported_at_once():
    text = """
[hull]
shape = "sl75"
drauft = 3
[body]
kg = "9"
gyradii = [1, 2]
[sea]
hs = -1
spectrum = "jonswop"
[simulation]
dt = 0
[simulaton]
"""
    found = mistakes(text, label="ship.toml")
    paths = [line.split(":")[0] for line in found]
    assert sorted(paths) == sorted(
        ["hull.shape", "hull.drauft", "body.kg", "body.gyradii[2]", "sea.hs", "sea.spectrum", "simulation.dt", "simulaton"]
    )


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (changed("hs = 4.0", "hs = -1"), "sea.hs: -1: a number > 0 expected."),
        (changed("hs = 4.0", "hs = nan"), "sea.hs: nan: a finite number expected."),
        (changed("hs = 4.0", 'hs = "four"'), 'sea.hs: "four": a number expected.'),
        (changed("hs = 4.0", "hs = true"), "sea.hs: true: a number expected."),
        (changed("hs = 4.0", "hss = 4.0"), 'sea.hss: unknown key; did you mean "hs"? Allowed: spectrum, hs, tp'),
        (changed("[sea]", "[see]"), 'see: unknown section; did you mean "sea"? Allowed: title, vessel'),
        (changed('"s175"', '"s-175"'), 'hull.shape: "s-175": one of "s175", "box"'),
        (changed("[8.3, 42.0, 42.0]", "[8.3, 42.0]"), "body.gyradii[2]: a number expected, the list ends before it."),
        (changed("[8.3, 42.0, 42.0]", "8.3"), "body.gyradii: 8.3: a list [..., ...] expected."),
        (GOOD + "[loads]\ndamping_ratio = { rol = 0.1 }", 'loads.damping_ratio.rol: unknown key; did you mean "roll"?'),
        (GOOD + "[loads]\nmooring_period = 100.0", "loads.mooring_period: 100.0: a table of keys expected."),
        (GOOD + "[simulation]\ninitial = { roll = 5 }", 'simulation.initial.roll: unknown key; did you mean "roll_deg"?'),
        (GOOD + '[memory]\ntail = "omega-4"', 'memory.tail: "omega-4": one of "fit", "omega-2", "omega-3", "none"'),
        (GOOD + "[simulation]\nrealisations = 2.5", "simulation.realisations: 2.5: a whole number expected."),
        ("hull = 3", "hull: 3: a section [hull] with keys expected."),
    ],
)
def test_a_mistake_in_one_key(text, sentence):
    assert any(line.startswith(sentence) for line in mistakes(text)), mistakes(text)


@pytest.mark.parametrize(
    ("text", "part"),
    [
        (changed("[body]\nkg = 9.5\ngyradii = [8.3, 42.0, 42.0]\n", ""), "body: expected, not found"),
        (changed("kg = 9.5", ""), "exactly one of kg (above keel), zg (above still water) and cog expected, none found"),
        (changed("kg = 9.5", "kg = 9.5\nzg = 0.0"), "expected, kg, zg found"),
        (changed("42.0]", "99.0]"), "body.gyradii: [8.3, 42.0, 99.0]: no mass has them"),
        (
            changed('shape = "s175"', 'shape = "s175"\nfile = "a.gdf"'),
            "hull: exactly one of file and shape expected, both found",
        ),
        (changed('shape = "s175"', 'shape = "box"'), 'hull.length: expected with shape "box", not found'),
        (changed('shape = "s175"', 'shape = "s175"\nbeam = 3.0'), 'hull.beam: not used by shape "s175"'),
        (changed('shape = "s175"', 'file = "nowhere.gdf"'), 'hull.file: "nowhere.gdf": no such file'),
        (changed('[hull]\nshape = "s175"\n', ""), "hull: expected, not found"),
        (changed("hs = 4.0", "hs = 30.0"), "steepness 0.192, at most 1/7 exists"),
        (changed("[sea]\nhs = 4.0\ntp = 10.0\n", ""), "sea: expected, not found"),
        (changed("tp = 10.0", ""), 'sea.tp: expected with spectrum "jonswap", not found'),
        (changed("tp = 10.0", 'tp = 10.0\nspectrum = "regular"'), 'sea.hs: not used by spectrum "regular"'),
        (GOOD + "[coefficients]\nomega_min = 0.1", "omega_min and omega_max expected together, one found"),
        (GOOD + "[coefficients]\nomega_min = 2.0\nomega_max = 1.0", "omega_max: 1: more than omega_min 2 expected"),
        (GOOD + "[coefficients]\nomega_min = 0.1\nomega_max = 0.7", "must hold it and reach 1.5 times the peak, 0.942 rad/s"),
        (GOOD + "[coefficients]\nomega = [0.1, 2.0]\nperiods = [3.0, 9.0]", "one of omega, periods and"),
        (GOOD + '[coefficients]\nfile = "nowhere.1"\nomega_min = 0.1', "file has its own"),
        (GOOD + "[simulation]\ndt = 2.0", "dt: 2: at most a twentieth of the wave period expected, 0.5 s"),
        (GOOD + "[simulation]\nduration = 50.0\nramp = 60.0", "ramp: 60: less than the duration 50 s expected"),
        (GOOD + "[simulation]\noutput_step = 0.25", "output_step: 0.25: a multiple of dt = 0.1 s expected"),
        (GOOD + '[simulation]\nmethod = "exact"\n[memory]\nmodel = "convolution"', 'method: "exact": only with'),
        (GOOD + "[loads]\ndamping_ratio = { roll = 5.0 }", "a fraction of critical damping < 1 expected"),
        (
            GOOD + "[loads]\nmooring_period = { surge = 100.0 }\nmooring_stiffness = { surge = 1e5 }",
            "loads: surge: one of mooring_period and mooring_stiffness expected, both found",
        ),
    ],
)
def test_keys_that_contradict_each_other_or_physics(text, part):
    assert any(part in line for line in mistakes(text)), mistakes(text)


def test_toml_syntax_errors_name_the_line():
    with pytest.raises(FormatError, match=r"ship.toml: no valid TOML: .*line 3.*hs = = 4"):
        parse_case("[sea]\ntp = 10.0\nhs = = 4\n", label="ship.toml")


def test_a_repeated_key_is_a_syntax_error():
    with pytest.raises(FormatError, match="no valid TOML"):
        parse_case("[sea]\nhs = 1.0\nhs = 2.0\n")


def test_binary_files_are_refused(tmp_path):
    path = tmp_path / "ship.toml"
    path.write_bytes(b"\x89HDF\r\n\xff\xfe")
    with pytest.raises(FormatError, match=r"ship.toml: a TOML text in UTF-8 expected"):
        read_case(path)


def test_paths_start_at_the_case_file(tmp_path):
    (tmp_path / "ship.1").write_text("")
    text = changed('shape = "s175"', 'shape = "s175"') + '[coefficients]\nfile = "ship"'
    (tmp_path / "a.toml").write_text(text)
    case = read_case(tmp_path / "a.toml")
    assert case.path("ship") == tmp_path / "ship"
    assert case.name == "a"


def test_the_digest_changes_with_the_text():
    assert parse_case(GOOD).digest != parse_case(GOOD + " ").digest


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("hs = 4.0", "hs = 4.0\nhs = 5.0", "stands twice"),
        ("[sea]", "[body]", "stands twice"),
        ("hs = 4.0", "hs = 4,5", "Decimals take a point"),
    ],
)
def test_what_the_parser_says_is_explained(old, new, words):
    with pytest.raises(FormatError, match=words):
        parse_case(changed(old, new))
