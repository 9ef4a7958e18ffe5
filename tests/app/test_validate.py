"""`ogilvie validate`: passes, fails, skips, and writes pages without folders of the machine in them."""

import pytest
from typer.testing import CliRunner

from ogilvie.app.cli import app
from ogilvie.app.validate import Comparison, case_page, run_one

CASE = """
TITLE = "Circle | area"
ABOUT = "The area of a circle, [Archimedes]."
NEEDS = {needs}

def run(shared):
    checks = [
        dict(name="area", value={value}, reference=3.1416, tolerance=1e-4, unit="m2", source="Archimedes", note="a = 1"),
        dict(name="perimeter", value=6.2832, reference=6.2832, tolerance=0.0),
    ]
    return checks, [1.0, 2.0]

def draw(data, fig):
    ax = fig.add_subplot()
    ax.plot(data)
"""


@pytest.fixture
def cases(tmp_path):
    """A project with a passing, a failing, a skipped and a broken case."""
    folder = tmp_path / "project" / "validation"
    texts = {
        "circle": CASE.format(needs="[]", value=3.14159),
        "failing": CASE.format(needs="[]", value=3.2),
        "far": CASE.format(needs='["data/far.csv"]', value=3.14159),
        "broken": CASE.format(needs="[]", value="1 / 0"),
        "lacking": "TITLE = 'x'",
    }
    for name, text in texts.items():
        (folder / name).mkdir(parents=True)
        (folder / name / "case.py").write_text(text)
    return folder


def call(cases, *names, extra=()):
    words = ["validate", *names, "--folder", cases, "-o", cases.parent / "out", *extra]
    return CliRunner().invoke(app, [str(w) for w in words])


def test_a_case_that_passes(cases):
    result = call(cases, "circle")
    assert result.exit_code == 0
    assert "2 of 2 within tolerance" in result.stdout
    page = (cases.parent / "out" / "circle.md").read_text()
    assert "| area | 3.142 | 3.142 | 0.0001 | m2 | ok | Archimedes |" in page
    assert "![Circle | area](circle.png)" in page
    assert "- area: a = 1" in page
    assert (cases.parent / "out" / "circle.png").read_bytes().startswith(b"\x89PNG")


def test_a_case_that_fails(cases):
    result = call(cases, "failing")
    assert result.exit_code == 1
    assert "FAILED" in result.stdout
    assert "1 of 2 within tolerance" in (cases.parent / "out" / "index.md").read_text()


def test_a_case_without_its_data_is_skipped_with_the_reason(cases):
    result = call(cases, "far")
    assert result.exit_code == 0
    assert "published data not present: data/far.csv" in result.stdout
    assert not (cases.parent / "out" / "far.md").exists()


def test_data_are_looked_for_beside_the_project_or_where_told(cases, tmp_path):
    (tmp_path / "shared" / "data").mkdir(parents=True)
    (tmp_path / "shared" / "data" / "far.csv").write_text("1")
    assert "2 of 2" in call(cases, "far").stdout
    assert "skipped" in call(cases, "far", extra=["--data", tmp_path]).stdout
    missing = call(cases, "far", extra=["--data", tmp_path / "no"])
    assert missing.exit_code == 2
    assert "an existing folder of published data expected" in " ".join(missing.stderr.split())


@pytest.mark.parametrize(("name", "word"), [("broken", "ZeroDivisionError"), ("lacking", "ABOUT, NEEDS, run, draw missing")])
def test_a_broken_case_is_an_error_and_stops_nothing(cases, name, word):
    result = call(cases, name, "circle")
    assert result.exit_code == 1
    assert word in " ".join(result.stdout.split())
    assert "2 of 2 within tolerance" in result.stdout


def test_all_cases_run_by_default_and_no_page_names_a_folder(cases):
    result = call(cases)
    assert result.exit_code == 1
    out = cases.parent / "out"
    assert {p.stem for p in out.glob("*.md")} == {"circle", "failing", "index"}
    index = (out / "index.md").read_text()
    assert all(f"| {title} |" in index for title in ("far", "broken", "x")) or "skipped" in index
    for page in out.glob("*.md"):
        assert str(cases.parent.parent) not in page.read_text()


def test_an_unknown_case_is_named(cases):
    result = call(cases, "circel")
    assert result.exit_code == 2
    assert 'circel: no such validation case; did you mean "circle"' in " ".join(result.stderr.split())


def test_a_folder_without_cases(tmp_path):
    assert CliRunner().invoke(app, ["validate", "--folder", str(tmp_path)]).exit_code == 2


def test_nan_never_passes():
    assert not Comparison("x", float("nan"), 0.0, 1e9).passed
    assert Comparison("x", 1.0, 0.5, 0.5).passed


def test_page_of_a_case(cases):
    outcome = run_one(cases / "circle" / "case.py", None)
    assert outcome.passed
    assert case_page(outcome).startswith("# Circle | area\n")
