"""A case from its hull to a report, and the simulation from saved pieces, on a barge of few panels."""

import os
import re
import warnings
from html.parser import HTMLParser

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

import ogilvie as og
from ogilvie.app import build_run
from ogilvie.app.case import parse_case
from ogilvie.app.cli import app
from ogilvie.app.files import read_memory, read_result
from ogilvie.app.run import run_case
from ogilvie.errors import OgilvieWarning
from ogilvie.sim.system import assemble

NO_FIGURES = "[output]\nfigures = false\nreport = false\n"
FIGURES = {"overview", "hull", "coefficients", "retardation", "excitation", "rao", "spectrum", "motions", "response_spectra"}


@pytest.fixture(scope="module")
def finished(tmp_path_factory, own_cache, box_text):
    """The folder of a case that the command line ran, and what it printed."""
    folder = tmp_path_factory.mktemp("run")
    (folder / "barge.toml").write_text(box_text)
    result = CliRunner().invoke(app, ["run", str(folder / "barge.toml")])
    assert result.exit_code == 0, result.stderr
    return folder / "barge-results", result.stdout


def test_everything_is_written_and_nothing_else(finished):
    folder, _ = finished
    assert sorted(os.listdir(folder)) == ["coefficients.nc", "figures", "memory.npz", "report.html", "result.nc"]
    assert {name.removesuffix(".png") for name in os.listdir(folder / "figures")} == FIGURES
    assert all((folder / "figures" / f"{n}.png").read_bytes().startswith(b"\x89PNG") for n in FIGURES)


def test_the_terminal_tells_motions_and_where_to_look(finished):
    folder, out = finished
    assert "motions of O, 2 x 200" in out
    assert str(folder / "report.html") in out
    assert re.search(r"^ heave +m +0\.\d+", out, re.MULTILINE)
    assert "\x1b[" not in out


def test_the_result_knows_its_case(finished, box_text):
    run = read_result(finished[0] / "result.nc")
    assert run.attrs["case_toml"] == box_text
    assert run.attrs["case_digest"] == parse_case(box_text).digest
    assert list(run.attrs["seeds"]) == [1, 2]
    assert run.sizes["realisation"] == 2


def test_a_short_run_says_that_its_statistics_are_uncertain(finished, box_text):
    run, case = read_result(finished[0] / "result.nc"), parse_case(box_text)
    with pytest.warns(OgilvieWarning, match=r"a short run: .*heave.* known to within \d+ % only"):
        build_run.statistics(case, run)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        build_run.statistics(case, xr.concat([run] * 60, "realisation"))


def test_pieces_are_sound(finished):
    hydro = og.read_hydro(finished[0] / "coefficients.nc")
    K, ssm = read_memory(finished[0] / "memory.npz")
    assert ssm.is_stable
    assert ssm.is_passive
    assert K.dofs == tuple(hydro.influenced_dof.values)


class _Links(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.tags: list[str] = []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.targets += [value for key, value in attrs if key in ("src", "href", "data", "action") and value]


def test_the_report_is_self_contained(finished):
    page = (finished[0] / "report.html").read_text(encoding="utf-8")
    links = _Links()
    links.feed(page)
    assert links.tags.count("img") == len(FIGURES)
    assert all(t.startswith(("data:image/png;base64,", "#")) for t in links.targets)
    assert "script" not in links.tags
    assert "http" not in re.sub(r"base64,[A-Za-z0-9+/=]+", "", page)


@pytest.mark.parametrize(
    "part",
    [
        "Hull and hydrostatics",
        "GM transverse",
        "Fluid memory",
        "R\u00b2 of A",
        "Sea",
        "95 % interval",
        "Checks",
        "kg = 3.0",
        "SHA-256",
    ],
)
def test_the_report_holds(finished, part):
    assert part in (finished[0] / "report.html").read_text(encoding="utf-8")


def test_the_report_names_no_folder_of_the_machine(finished):
    page = (finished[0] / "report.html").read_text(encoding="utf-8")
    assert str(finished[0].parent) not in page


def test_simulate_from_saved_pieces_gives_the_same_motions(finished, tmp_path):
    folder, _ = finished
    words = ["simulate", folder.parent / "barge.toml", "--coefficients", folder / "coefficients.nc"]
    words += ["--memory", folder / "memory.npz", "-o", tmp_path / "again.nc"]
    result = CliRunner().invoke(app, [str(w) for w in words])
    assert result.exit_code == 0, result.stderr
    xr.testing.assert_allclose(read_result(tmp_path / "again.nc").eta, read_result(folder / "result.nc").eta, rtol=1e-9)


def test_plot_of_the_result(finished, tmp_path):
    words = ["plot", finished[0] / "result.nc", "-o", tmp_path, "--window", 20, 60]
    result = CliRunner().invoke(app, [str(w) for w in words])
    assert result.exit_code == 0, result.stderr
    assert sorted(os.listdir(tmp_path)) == ["motions.png", "response_spectra.png"]


def test_the_run_is_the_sum_of_its_components(box_text, tmp_path):
    """Harmonic frequencies, stationary start: the variance of a run is that of the vessel's response to each component."""
    case = parse_case(box_text + NO_FIGURES)
    found = run_case(case, tmp_path)
    system = assemble(build_run.make_vessel(case, found.body, found.hydro, found.K, found.ssm))
    force = og.WaveExcitation(found.hydro).force(found.sea.omega, found.sea.direction)
    X = np.linalg.solve(system.impedance(found.sea.omega), force[..., None])[..., 0]
    variance = 0.5 * np.sum(np.abs(X * found.sea.amplitude[..., None]) ** 2, axis=1).mean(axis=0)
    np.testing.assert_allclose(found.statistics["std"], np.sqrt(variance), rtol=3e-3)


def test_time_and_frequency_domain_agree_within_the_fit(box_text, tmp_path):
    text = box_text.replace("[sea]", '[sea]\nrandom = "phase"').replace("duration = 200.0", "duration = 1500.0")
    text = text.replace("r2 = 0.95", 'model = "convolution"')
    found = run_case(parse_case(text + NO_FIGURES), tmp_path)
    np.testing.assert_allclose(found.statistics["std"] / found.expected["std"], 1.0, atol=0.03)
    assert sorted(os.listdir(tmp_path)) == ["coefficients.nc", "memory.npz", "result.nc"]


def test_an_interrupt_in_the_simulation_keeps_the_pieces(box_text, tmp_path, monkeypatch):
    def interrupted(*args, **kwargs):
        raise KeyboardInterrupt

    monkeypatch.setattr(build_run, "simulate_case", interrupted)
    (tmp_path / "a.toml").write_text(box_text)
    result = CliRunner().invoke(app, ["run", str(tmp_path / "a.toml")])
    assert result.exit_code == 130
    assert "coefficients.nc, memory.npz." in " ".join(result.stderr.split())
    assert sorted(os.listdir(tmp_path / "a-results")) == ["coefficients.nc", "memory.npz"]


def test_an_interrupted_simulation_is_reported_as_such(box_text, tmp_path, monkeypatch):
    whole = build_run.simulate_case

    def partly(*args, **kwargs):
        run = whole(*args, **kwargs).isel(time=slice(0, 900))
        return run.assign_attrs(run.attrs | {"complete": 0})

    monkeypatch.setattr(build_run, "simulate_case", partly)
    (tmp_path / "a.toml").write_text(box_text + NO_FIGURES)
    result = CliRunner().invoke(app, ["run", str(tmp_path / "a.toml")])
    assert result.exit_code == 130
    assert "interrupted: The simulation up to then" in " ".join(result.stderr.split())
    assert float(read_result(tmp_path / "a-results" / "result.nc").time[-1]) == pytest.approx(89.9)


def test_both_panel_methods_give_the_same_ship(box_text, tmp_path):
    """Coefficients by the time domain: heave and pitch of the same waves as by the frequency domain."""
    found = {}
    for solver in ("frequency-domain", "time-domain"):
        text = box_text.replace("[memory]", f'solver = "{solver}"\n[memory]') + NO_FIGURES
        found[solver] = run_case(parse_case(text), tmp_path / solver)
    one, two = (f.statistics["std"].sel(dof=["heave", "pitch", "sway"]).values for f in found.values())
    np.testing.assert_allclose(one, two, rtol=0.05)
    assert found["time-domain"].hydro.attrs["source"] == "ogilvie hybrid_hydro"


def test_free_decay_in_calm_water(box_text, tmp_path):
    text = re.sub(r"\[sea\].*?\[loads\]", '[sea]\nspectrum = "calm"\n[loads]', box_text, flags=re.DOTALL)
    text = text.replace("realisations = 2", "initial = { roll_deg = 8.0 }")
    found = run_case(parse_case(text + NO_FIGURES), tmp_path)
    roll = np.degrees(found.run.eta.sel(dof="roll").values)
    assert roll[0] == pytest.approx(8.0)
    assert np.abs(roll[-400:]).max() < 0.6
    assert "elevation" not in found.run
