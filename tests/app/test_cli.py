"""The command line: what it prints, what it refuses and how, exit codes."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import ogilvie as og
from ogilvie.app.cli import app
from ogilvie.app.console import DEBUG_VARIABLE

COMMANDS = ("demo", "cases", "run", "hydro", "check", "identify", "simulate", "plot", "validate")


def call(*words) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, [str(w) for w in words])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result.exit_code, result.stdout, result.stderr


def refused(*words) -> str:
    """The message of a call that must end with exit code 2, without a traceback and without results."""
    code, out, err = call(*words)
    assert code == 2, (code, out, err)
    assert "Traceback" not in out + err
    assert err.startswith("error: ")
    return " ".join(err.split())


@pytest.fixture(scope="module")
def coefficients(tmp_path_factory):
    """A netCDF file of coefficients of a made-up buoy whose radiation is causal and passive."""
    w = np.linspace(0.05, 4.0, 80)
    K_hat = 1j * w / ((1j * w + 0.4) ** 2 + 1)
    A, B = np.zeros((80, 6, 6)), np.zeros((80, 6, 6))
    for i, size in enumerate((1.0, 1.0, 2.0, 3.0, 3.0, 1.0)):
        A[:, i, i], B[:, i, i] = size * 1e5 * (2 + K_hat.imag / w), size * 1e5 * K_hat.real
    hydro = og.hydro_from_arrays(
        omega=w,
        added_mass=A,
        radiation_damping=B,
        added_mass_inf=2e5 * np.diag((1.0, 1.0, 2.0, 3.0, 3.0, 1.0)),
        hydrostatic_stiffness=np.diag([0, 0, 1e6, 1e6, 1e6, 0]),
    )
    from ogilvie.hydro.netcdf import write_netcdf

    return write_netcdf(hydro, tmp_path_factory.mktemp("hydro") / "buoy.nc")


@pytest.fixture
def box_gdf(tmp_path):
    og.write_mesh(og.shapes.box(20.0, 6.0, 2.0, panels=60), tmp_path / "box.gdf")
    return tmp_path / "box.gdf"


def test_help_names_every_command():
    code, out, _ = call("--help")
    assert code == 0
    assert all(name in out for name in COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself(command):
    code, out, _ = call(command, "--help")
    assert code == 0
    assert "Usage" in out
    assert len(out.splitlines()) > 8


def test_help_loads_no_heavy_library():
    code = "import sys; from ogilvie.app import cli; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert not {"numpy", "scipy", "xarray", "numba", "matplotlib", "pydantic", "capytaine"} & set(loaded)
    assert "typer" in loaded


def test_version():
    assert call("--version")[1].strip() == f"ogilvie {og.__version__}"


def test_the_demo_prints_a_case_to_start_from(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(call("demo", "--case")[1])
    code, out, _ = call("check", path)
    assert (code, out.strip()) == (0, "mine.toml: no mistakes.")


# what cannot be used: expected, found, what to do; exit code 2


def test_a_missing_file(tmp_path):
    for command in ("run", "check", "hydro", "identify", "simulate", "plot"):
        assert "an existing file expected, none found. Check the path." in refused(command, tmp_path / "no.toml")


def test_a_folder_in_place_of_a_file(tmp_path):
    assert "a file expected, a folder found" in refused("run", tmp_path)


def test_an_unreadable_file(tmp_path, monkeypatch):
    def denied(self):
        raise PermissionError(13, "Permission denied", str(self))

    monkeypatch.setattr(Path, "read_bytes", denied)  # the superuser may read whatever its rights
    assert "a.toml: no permission. Check the rights" in refused("run", tmp_path / "a.toml")


def test_a_case_with_mistakes_names_all_of_them(tmp_path, box_text):
    path = tmp_path / "ship.toml"
    path.write_text(box_text.replace("hs = 1.0", "hs = -1.0").replace("beam", "baem"))
    message = refused("run", path)
    assert "ship.toml: 2 mistakes: " in message
    assert "sea.hs: -1.0: a number > 0 expected." in message
    assert 'hull.baem: unknown key; did you mean "beam"?' in message
    assert os.listdir(tmp_path) == ["ship.toml"]


def test_a_broken_case_names_the_line(tmp_path):
    path = tmp_path / "ship.toml"
    path.write_text("[sea]\nhs == 3")
    assert "no valid TOML" in refused("run", path)
    assert "line 2" in refused("run", path)


def test_a_truncated_wamit_file(tmp_path):
    (tmp_path / "tanker.1").write_text(" 6.0 1 1 0.5 0.1\n 6.0 1 2 0.5\n")
    message = refused("check", tmp_path / "tanker.1")
    assert "tanker.1 line 2" in message
    assert "found" in message


def test_a_binary_wamit_file(tmp_path):
    (tmp_path / "tanker.1").write_bytes(bytes(range(256)))
    assert "tanker.1" in refused("identify", tmp_path / "tanker.1")


def test_nan_in_a_wamit_file(tmp_path):
    (tmp_path / "tanker.1").write_text(" 6.0 1 1 NaN 0.1\n")
    assert "tanker.1 line 1" in refused("check", tmp_path / "tanker.1")


def test_a_damaged_result(tmp_path):
    (tmp_path / "result.nc").write_bytes(b"\x89HDF\r\n\x1a\nrest is missing")
    assert "result.nc" in refused("plot", tmp_path / "result.nc", "-o", tmp_path / "figures")
    assert not (tmp_path / "figures").exists()


def test_the_wrong_kind_of_file_is_named(coefficients, box_gdf):
    assert "coefficients (netCDF, WAMIT, HAMS) expected, a mesh found" in refused("identify", box_gdf)
    assert "a MIN:MAX:N" not in refused("hydro", box_gdf)
    assert "--omega: MIN:MAX:N in rad/s expected" in refused("hydro", box_gdf)
    assert "no valid TOML" in refused("run", coefficients) or "a TOML text" in refused("run", coefficients)


def test_an_unknown_word_on_the_command_line():
    code, _, err = call("identify", "--order")
    assert code == 2
    assert "No such option" in err


def test_an_output_folder_that_is_a_file(tmp_path, box_text):
    (tmp_path / "ship.toml").write_text(box_text)
    (tmp_path / "there").write_text("")
    assert "a folder expected, a file found" in refused("run", tmp_path / "ship.toml", "-o", tmp_path / "there")


def test_an_output_in_a_folder_that_is_not_there(tmp_path, coefficients):
    assert "folder" in refused("identify", coefficients, "-o", tmp_path / "no" / "memory.npz")


def test_bad_options(coefficients, tmp_path):
    assert "r2" in refused("identify", coefficients, "--r2", "1.5", "-o", tmp_path / "m.npz")
    assert "--format: one of png, svg, pdf expected, 'gif' found" in refused("plot", coefficients, "--format", "gif")
    assert os.listdir(tmp_path) == []


# interrupts and defects


def test_an_interrupt_says_what_was_kept(tmp_path, box_text, monkeypatch):
    def interrupted(*args, **kwargs):
        stop = KeyboardInterrupt()
        stop.add_note("Kept in here: coefficients.nc.")
        raise stop

    monkeypatch.setattr("ogilvie.app.run.run_case", interrupted)
    (tmp_path / "a.toml").write_text(box_text)
    code, _, err = call("run", tmp_path / "a.toml")
    assert (code, err.strip()) == (130, "interrupted: Kept in here: coefficients.nc.")


def test_a_defect_of_the_program_gives_a_hint_and_no_traceback(tmp_path, box_text, monkeypatch):
    monkeypatch.setattr("ogilvie.app.run.run_case", lambda *args, **kwargs: 1 / 0)
    (tmp_path / "a.toml").write_text(box_text)
    code, _, err = call("run", tmp_path / "a.toml")
    assert code == 1
    assert "unexpected error: ZeroDivisionError: division by zero" in err
    assert "--debug" in err
    assert "Traceback" not in err


def test_debug_raises(tmp_path, box_text, monkeypatch):
    monkeypatch.setenv(DEBUG_VARIABLE, "")
    monkeypatch.setattr("ogilvie.app.run.run_case", lambda *args, **kwargs: 1 / 0)
    (tmp_path / "a.toml").write_text(box_text)
    with pytest.raises(ZeroDivisionError):
        call("--debug", "run", tmp_path / "a.toml")


def test_exit_code_and_streams_of_the_real_command(tmp_path):
    command = [sys.executable, "-c", "from ogilvie.app.cli import main; main()", "run", str(tmp_path / "no.toml")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith("error: ")
    assert "Traceback" not in done.stderr


# the small commands at work


def test_check_of_a_good_and_of_a_bad_mesh(box_gdf, tmp_path):
    code, out, _ = call("check", box_gdf)
    assert code == 0
    assert "no faults found" in out
    assert "displaced volume" in out
    og.write_mesh(og.shapes.box(20.0, 6.0, 2.0, panels=60).flipped(), tmp_path / "inside_out.gdf")
    code, out, _ = call("check", tmp_path / "inside_out.gdf")
    assert code == 1
    assert "inward normals" in out


def test_check_of_coefficients(coefficients, tmp_path):
    code, out, _ = call("check", coefficients)
    assert code == 0
    assert "reciprocity" in out
    hydro = og.read_hydro(coefficients)
    hydro.radiation_damping.values[40] *= -1
    from ogilvie.hydro.netcdf import write_netcdf

    write_netcdf(hydro, tmp_path / "bad.nc")
    assert call("check", tmp_path / "bad.nc")[0] == 1


def test_hydro_converts(coefficients, tmp_path):
    code, out, _ = call("hydro", coefficients, "-o", tmp_path / "a.nc", "--wamit", tmp_path / "buoy")
    assert code == 0
    assert str(tmp_path / "buoy.1") in out.replace("\n", "")
    again = og.read_hydro(tmp_path / "buoy.1")
    np.testing.assert_allclose(again.radiation_damping, og.read_hydro(coefficients).radiation_damping, rtol=1e-5, atol=1.0)


def test_identify_saves_what_it_prints_and_draws(coefficients, tmp_path):
    code, out, _ = call("identify", coefficients, "-o", tmp_path / "m.npz", "--figures", tmp_path / "f", "--r2", 0.95)
    assert code == 0
    assert "stable, passive" in out
    from ogilvie.app.files import read_memory

    _, ssm = read_memory(tmp_path / "m.npz")
    assert f"{ssm.order} states" in out
    assert sorted(os.listdir(tmp_path / "f")) == ["coefficients.png", "retardation.png"]


@pytest.mark.parametrize(("kind", "names"), [("coefficients", {"coefficients"}), ("mesh", {"hull"}), ("drift", {"drift"})])
def test_plot_draws_what_a_file_holds(kind, names, coefficients, box_gdf, tmp_path):
    from ogilvie.app.files import write_result

    short = og.short_wave_drift(og.shapes.box(40.0, 12.0, 4.0, panels=60), omega=[1.0, 1.5, 2.0], speed=3.0)
    drift = write_result(short, tmp_path / "drift.nc")
    source = {"coefficients": coefficients, "mesh": box_gdf, "drift": drift}[kind]
    code, _, _ = call("plot", source, "-o", tmp_path / "f", "--format", "svg")
    assert code == 0
    assert {p.stem for p in Path(tmp_path / "f").glob("*.svg")} == names


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        ("inside out", ("normals", "found")),
        ("out of the water", ("below", "found")),
        ("impossible inertia", ("violate the triangle inequality", "Check")),
        ("negative mass", ("body.mass: -5.0: a number > 0 expected",)),
        ("holes", ("hull.file", "a file expected, a folder found")),
    ],
)
def test_a_hull_or_body_that_cannot_be(spoil, words, tmp_path, box_text):
    mesh = og.shapes.box(40.0, 12.0, 4.0, panels=60)
    mesh = {"inside out": mesh.flipped(), "out of the water": mesh.translated((0.0, 0.0, 9.0))}.get(spoil, mesh)
    og.write_mesh(mesh, tmp_path / "barge.gdf")
    text = box_text.replace('shape = "box"\nlength = 40.0\nbeam = 12.0\ndraught = 4.0\npanels = 120', 'file = "barge.gdf"')
    if spoil == "impossible inertia":
        text = text.replace("gyradii = [4.0, 11.0, 11.0]", "inertia = [[1e7, 0, 0], [0, 2e7, 0], [0, 0, 9e7]]")
    if spoil == "negative mass":
        text = text.replace("kg = 3.0", "kg = 3.0\nmass = -5.0")
    if spoil == "holes":
        text = text.replace('"barge.gdf"', '"."')
    (tmp_path / "ship.toml").write_text(text)
    message = refused("run", tmp_path / "ship.toml")
    assert all(word in message for word in words), message
    assert not (tmp_path / "ship-results").exists()


def test_the_package_runs_as_a_module():
    done = subprocess.run([sys.executable, "-m", "ogilvie", "--version"], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == f"ogilvie {og.__version__}"


def test_a_case_to_be_looked_at_is_told_and_passes(tmp_path, box_text):
    path = tmp_path / "case.toml"
    path.write_text(box_text.replace("135.0\n[loads]", "2.3562\n[loads]").replace("[90.0, 135.0", "[0.0, 45.0, 90.0, 135.0"))
    code, out, err = call("check", path)
    assert (code, out.strip()) == (0, "case.toml: no mistakes, 1 to look at.")
    assert "sea.direction_deg: 2.3562: degrees expected; this is 135 deg in radians" in " ".join(err.split())


def test_a_mesh_in_millimetres_is_read_with_its_unit(tmp_path):
    og.write_mesh(og.shapes.box(20.0, 6.0, 2.0, panels=60).scaled(1000.0), tmp_path / "mm.gdf")
    assert "millimetres?" in call("check", tmp_path / "mm.gdf")[1]
    code, out, _ = call("check", tmp_path / "mm.gdf", "--unit", "0.001")
    assert code == 0
    assert "20 x 6 x 2 m" in out
    assert "--symmetry: one of none, xz, xz+yz expected" in refused("check", tmp_path / "mm.gdf", "--symmetry", "yz")


def test_the_folder_one_is_in_is_no_file():
    assert "a file expected, a folder found" in refused("check", ".")


def test_the_place_of_a_result_is_tried_before_the_work(coefficients, tmp_path, monkeypatch):
    monkeypatch.setattr("ogilvie.memory.retardation.retardation", lambda *a, **k: pytest.fail("worked for nothing"))
    assert "Make it first" in refused("identify", coefficients, "-o", tmp_path / "no" / "memory.npz")
    monkeypatch.setattr(os, "access", lambda place, mode, **options: mode != os.W_OK)  # the superuser may write anywhere
    assert "no permission" in refused("identify", coefficients, "-o", tmp_path / "memory.npz")


def test_a_fluid_memory_of_another_vessel_is_refused(coefficients):
    from ogilvie.app.build_memory import refuse_memory_of_another

    hydro = og.read_hydro(coefficients)
    K = og.retardation(hydro, duration=20.0, dt=0.1)
    refuse_memory_of_another(K, hydro)
    with pytest.raises(og.InputError, match="another vessel"):
        refuse_memory_of_another(K, hydro.assign(added_mass_inf=2 * hydro.added_mass_inf))


def test_too_little_memory_is_no_defect_of_the_program(coefficients, monkeypatch):
    def greedy(*args, **options):
        raise MemoryError("Unable to allocate 53 GiB")

    monkeypatch.setattr("ogilvie.memory.retardation.retardation", greedy)
    message = refused("identify", coefficients)
    assert "53 GiB" in message
    assert "shorter duration" in message
