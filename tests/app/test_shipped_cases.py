"""The cases that come with the package: without mistakes, to be copied, and run in a shortened form."""

import os
import re
import tomllib

import numpy as np
import pytest
from typer.testing import CliRunner

from ogilvie.app.case import parse_case
from ogilvie.app.cli import app
from ogilvie.app.demo import shipped_cases
from ogilvie.app.files import read_result
from ogilvie.post.course import courses

NAMES = ("container_ship", "moored_tanker", "s175", "supply_vessel")


def call(*words) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, [str(w) for w in words])
    return result.exit_code, result.stdout, result.stderr


def shortened(text: str, **changes: str) -> str:
    """The case with few panels and frequencies, a minute long, one realisation."""
    given = {"panels": "200", "omega_count": "7", "duration": "60.0", "realisations": "1", **changes}
    for key, value in given.items():
        text, count = re.subn(rf"^{key} = \S+", f"{key} = {value}", text, count=1, flags=re.MULTILINE)
        assert count == 1, key
    return text.replace("seed = 1\n", "seed = 1\ncomponents = 60\n", 1)


def test_all_are_there():
    assert tuple(shipped_cases()) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_no_mistakes(name):
    text = shipped_cases()[name]
    case = parse_case(text, name=name)
    assert case.title == tomllib.loads(text)["title"]
    assert case.large == (name != "s175")


def test_the_list_names_all():
    code, out, _ = call("cases")
    assert code == 0
    assert all(name in out for name in NAMES)
    assert "Storage tanker on eight catenary lines" in out


def test_a_case_is_copied_once(tmp_path):
    target = tmp_path / "mine.toml"
    code, out, _ = call("cases", "supply_vessel", "-o", target)
    assert (code, target.read_text()) == (0, shipped_cases()["supply_vessel"])
    assert str(target) in out
    target.write_text("mine")
    code, _, err = call("cases", "supply_vessel", "-o", target)
    assert (code, target.read_text()) == (2, "mine")
    assert "something is there already. Choose another." in err
    assert call("cases", "supply_vessel", "-o", tmp_path)[0] == 0
    assert (tmp_path / "supply_vessel.toml").exists()


def test_an_unknown_case(tmp_path):
    code, _, err = call("cases", "container-ship", "-o", tmp_path)
    assert code == 2
    assert "expected, 'container-ship' found; did you mean \"container_ship\"?" in err
    assert os.listdir(tmp_path) == []


@pytest.mark.filterwarnings("default::ogilvie.errors.OgilvieWarning")
def test_the_container_ship_sails(tmp_path):
    """Shortened: it makes way at its speed, heeds its heading, and the report says what blew and flowed."""
    (tmp_path / "ship.toml").write_text(shortened(shipped_cases()["container_ship"], panels="120"))
    code, out, err = call("run", tmp_path / "ship.toml")
    assert code == 0, err
    folder = tmp_path / "ship-results"
    run = read_result(folder / "result.nc")
    (course,) = courses(run, skip=6.0)
    assert course.speed == pytest.approx(18.0 * 1852 / 3600, rel=0.05)
    assert abs(course.heading) < np.radians(6.0)
    assert 0.0 < np.degrees(course.drift_angle) < 15.0  # wind, waves and current come from starboard
    assert float(np.abs(run.autopilot_rudder_angle).max()) > 0.0
    assert "about the mean course" in out
    assert re.search(r"speed over ground +1[789](\.\d)? kn", out)
    names = {name.removesuffix(".png") for name in os.listdir(folder / "figures")}
    assert {"track", "controls", "overview", "motions"} <= names
    page = (folder / "report.html").read_text(encoding="utf-8")
    for part in ("Sea, wind and current", "14 m/s (27.2 kn) at 10 m", "120\u00b0", "NPD", "large motions", "rudder angle"):
        assert part in page


@pytest.mark.filterwarnings("default::ogilvie.errors.OgilvieWarning")
@pytest.mark.parametrize("name", ["supply_vessel", "moored_tanker"])
def test_vessels_that_keep_their_place(name, tmp_path):
    text = shortened(shipped_cases()[name])
    text = re.sub(r"\[water\]\ndepth = \S+", "[water]\ndepth = inf", text)  # deep water is solved sooner
    text = text.replace("figures = true", "figures = false").replace("report = true", "report = false")
    (tmp_path / "a.toml").write_text(text)
    code, out, err = call("simulate", tmp_path / "a.toml", "-o", tmp_path / "a.nc")
    assert code == 0, err
    assert "mean place, x" in out
    run = read_result(tmp_path / "a.nc")
    assert float(np.abs(run.eta.sel(dof=["surge", "sway"])).max()) < 15.0
    assert float(np.abs(run.eta.sel(dof="yaw")).max()) < np.radians(10.0)
    held = "force_positioning" if name == "supply_vessel" else "force_mooring"
    assert float(np.abs(run[held]).max()) > 1e4


@pytest.mark.filterwarnings("default::ogilvie.errors.OgilvieWarning")
def test_a_ship_that_turns_has_no_mean_course(tmp_path):
    """A course change of 90 degrees in calm water, from hull to figures: what needs a mean course is left out."""
    text = shortened(shipped_cases()["container_ship"], duration="240.0", panels="300", omega_count="24")
    text = re.sub(r"\[sea\].*?\[wind\]", '[sea]\nspectrum = "calm"\n[wind]', text, flags=re.DOTALL)
    text = text.replace("[autopilot]\nheading_deg = 0.0", "[autopilot]\nschedule = [[0.0, 0.0], [20.0, 90.0]]")
    text = text.replace('gust = "npd"', "")
    (tmp_path / "ship.toml").write_text(text)
    code, out, err = call("run", tmp_path / "ship.toml")
    assert code == 0, err
    assert "no mean track" in out
    assert not re.search(r"^ surge", out, re.MULTILINE)
    run = read_result(tmp_path / "ship-results" / "result.nc")
    assert float(run.eta.sel(dof="yaw")[-1]) == pytest.approx(np.pi / 2, abs=np.radians(10.0))
    assert float(run.eta.sel(dof="sway")[-1]) > 500.0  # to port
