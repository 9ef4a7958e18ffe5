"""The command `live`: a case run by the clock, its datagrams on a real socket, its end by time or by an interrupt."""

import json
import math
import os
import re
import select
import signal
import socket
import subprocess
import sys
import time

import numpy as np
import pytest
from typer.testing import CliRunner

import ogilvie as og
from ogilvie.app import build, build_memory, build_run, live
from ogilvie.app.case import parse_case
from ogilvie.app.cli import app

# a process that heeds ctrl-C even where the tests themselves run in the background
START = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); from ogilvie.app.cli import main; main()"


@pytest.fixture(scope="module")
def buoy(tmp_path_factory):
    """A case whose coefficients are in a file: nothing is solved."""
    from ogilvie.hydro.netcdf import write_netcdf

    folder = tmp_path_factory.mktemp("live")
    w, directions = np.linspace(0.05, 4.0, 80), np.radians([0.0, 90.0, 180.0])
    K_hat = 1j * w / ((1j * w + 0.4) ** 2 + 1)
    sizes = np.array([1.0, 1.0, 2.0, 3.0, 3.0, 1.0]) * 1e5
    A, B, X = np.zeros((80, 6, 6)), np.zeros((80, 6, 6)), np.zeros((80, 3, 6), dtype=complex)
    for i, size in enumerate(sizes):
        A[:, i, i], B[:, i, i] = size * (2 + K_hat.imag / w), size * K_hat.real
    fall, cosine, sine = np.exp(-(w[:, None] ** 2)), np.cos(directions), np.sin(directions)
    X[:, :, 0], X[:, :, 1] = 1e5j * cosine * w[:, None] ** 2 * fall, 1e5j * sine * w[:, None] ** 2 * fall
    X[:, :, 2] = 1e6 * fall + 1j * (w * B[:, 2, 2])[:, None]
    X[:, :, 4] = 3e5j * cosine * w[:, None] * fall
    hydro = og.hydro_from_arrays(
        omega=w,
        added_mass=A,
        radiation_damping=B,
        added_mass_inf=2 * np.diag(sizes),
        wave_direction=directions,
        excitation_force=X,
        hydrostatic_stiffness=np.diag([0, 0, 1e6, 1e6, 1e6, 0]),
    )
    write_netcdf(hydro, folder / "buoy.nc")
    text = """
    [vessel]
    heading_deg = 30.0
    [body]
    mass = 1e5
    cog = [0.0, 0.0, 0.0]
    gyradii = [2.0, 2.0, 2.0]
    [coefficients]
    file = "buoy.nc"
    [sea]
    hs = 1.0
    tp = 8.0
    direction_deg = 120.0
    [loads]
    damping_ratio = { surge = 0.1, sway = 0.1, yaw = 0.1 }
    mooring_period = { surge = 30.0, sway = 30.0, yaw = 30.0 }
    [simulation]
    duration = 100.0
    dt = 0.05
    realisations = 3
    """
    (folder / "buoy.toml").write_text(text)
    return folder / "buoy.toml"


@pytest.fixture
def ear():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        receiver.bind(("127.0.0.1", 0))
        receiver.settimeout(60.0)
        yield receiver


def started(case, ear, *words) -> subprocess.Popen:
    command = [sys.executable, "-c", START, "live", str(case), "--port", str(ear.getsockname()[1]), *words]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def drained(ear) -> list[bytes]:
    """What has come."""
    heard = []
    while select.select([ear], [], [], 0.0)[0]:
        heard.append(ear.recv(65536))
    return heard


def refused(*words) -> str:
    result = CliRunner().invoke(app, ["live", *map(str, words)])
    assert result.exit_code == 2, (result.stdout, result.stderr)
    assert "Traceback" not in result.stdout + result.stderr
    return " ".join(result.stderr.split())


def test_a_case_is_sent_step_by_step(buoy, ear):
    """Every datagram of a short run, in order: the pose in the world of the same case stepped here."""
    process = started(buoy, ear, "--duration", "2", "--factor", "4")
    out, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    lines = [json.loads(line) for line in drained(ear)]
    assert [line["t"] for line in lines] == pytest.approx(0.05 * np.arange(1, 41))
    expected = first_realisation(buoy)
    c, s = math.cos(math.radians(30.0)), math.sin(math.radians(30.0))
    for line in lines:
        eta = expected.step().eta
        assert line["eta"] == pytest.approx([c * eta[0] - s * eta[1], s * eta[0] + c * eta[1], *eta[2:5], eta[5] + math.pi / 6])
        assert line["version"] == 1
    assert re.search(r"^2 s in 40 steps of 50 ms, [\d.]+ s on the clock \(4 x real time\)$", out, re.MULTILINE)
    assert "40 datagrams sent to 127.0.0.1" in out
    assert "\x1b[" not in out + err


def first_realisation(path) -> og.Stepper:
    """What `ogilvie simulate` would run first, as a stepper."""
    case = parse_case(path.read_text(), folder=path.parent)
    body = build.make_body(case, None)
    hydro = build.make_hydro(case, None, body)
    sea = build_run.make_sea(case, build_run.make_spectrum(case), hydro)
    vessel = build_run.make_vessel(case, body, hydro, *build_memory.make_memory(case, hydro, body))
    return og.Stepper(vessel, sea.isel(0), dt=case.simulation.dt)


def test_nmea_with_an_origin(buoy, ear):
    words = ("--format", "nmea", "--origin", "59.9,-10.7", "--rate", "2", "--duration", "2.5", "--factor", "10")
    process = started(buoy, ear, *words)
    _, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    blocks = [block.decode("ascii").split("\r\n") for block in drained(ear)]
    assert len(blocks) == 6  # the first state, then one each half second
    for lines in blocks:
        assert [line[1:6] for line in lines if line] == ["GPGGA", "GPRMC", "GPVTG", "HEHDT", "TIROT", "YXXDR", "PASHR"]
        gga = lines[0].split(",")
        assert gga[2][:7] in ("5953.99", "5954.00")
        assert (gga[3], gga[5], gga[6]) == ("N", "W", "8")
        assert gga[4][:8] in ("01041.99", "01042.00")
        assert float(lines[3].split(",")[1]) == pytest.approx(60.0, abs=20.0)  # 30 deg anticlockwise from East, and yaw


@pytest.mark.parametrize(("duration", "code"), [("inf", 0), ("3600", 130)])
def test_an_interrupt_ends_it_with_the_report(buoy, ear, duration, code):
    process = started(buoy, ear, "--duration", duration)
    try:
        for _ in range(3):
            ear.recv(65536)  # it runs
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == code, (out, err)
    assert "interrupted" in out
    assert "deadlines missed" in out
    assert "datagrams sent" in out
    assert "Traceback" not in out + err
    assert ("interrupted: " in err) == (code == 130)
    time.sleep(0.2)
    drained(ear)
    assert not select.select([ear], [], [], 0.2)[0]  # nothing comes any more


def test_a_terminal_gets_one_line(buoy, ear):
    pty = pytest.importorskip("pty")
    mine, its = pty.openpty()
    command = [sys.executable, "-c", START, "live", str(buoy), "--port", str(ear.getsockname()[1]), "--duration", "1.5"]
    environment = {k: v for k, v in os.environ.items() if k != "NO_COLOR"} | {"TERM": "xterm", "COLUMNS": "120"}
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=its, text=True, env=environment) as process:
        os.close(its)
        shown = b""
        while True:
            try:
                more = os.read(mine, 65536)
            except OSError:  # the other side has closed
                break
            if not more:
                break
            shown += more
        out = process.stdout.read()
    os.close(mine)
    assert process.returncode == 0, shown
    lines = re.findall(rb"t \d\.\d of 1\.5 s  heave [+-]\d\.\d\d m, roll [+-]\d\.\d\d deg, pitch", shown)
    assert len(lines) >= 2
    assert "heave" not in out
    assert "30 datagrams sent" in out


def test_nobody_needs_to_listen(buoy, ear):
    port = ear.getsockname()[1]
    ear.close()
    result = CliRunner().invoke(app, ["live", str(buoy), "--port", str(port), "--duration", "1", "--factor", "20"])
    assert result.exit_code == 0, result.stderr
    assert "20 datagrams sent" in result.stdout


def test_too_slow_is_said_once(buoy, ear):
    """A thousandfold is more than a step can do; the run goes on to its end."""
    words = ["--port", str(ear.getsockname()[1]), "--duration", "400", "--factor", "1e9", "--rate", "0.1"]
    result = CliRunner().invoke(app, ["live", str(buoy), *words])
    assert result.exit_code == 0, result.stderr
    assert "in 8000 steps" in result.stdout
    assert result.stderr.count("warning: real time: behind") <= 1
    assert "behind at the end" in result.stdout


def test_a_longer_run_has_a_longer_sea(buoy):
    from ogilvie.app.live import make_stepper

    case = parse_case(buoy.read_text(), folder=buoy.parent)
    sizes = [make_stepper(case, d)._engine.seaway.frequency.size for d in (5.0, 100.0, 200.0, math.inf)]
    assert sizes[0] == sizes[1] == sizes[3]
    assert sizes[2] == pytest.approx(2 * sizes[1], abs=2)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--format", "xml"], "--format: json or nmea expected, 'xml' found"),
        (["--format", "nmea", "--origin", "here"], "--origin: LAT,LON in degrees expected"),
        (["--format", "nmea", "--origin", "91,0"], "--origin"),
        (["--format", "nmea", "--x-axis", "up"], "--x-axis: east or north expected, 'up' found"),
        (["--format", "nmea", "--fix", "good"], "--fix"),
        (["--port", "0"], "port: a whole number from 1 to 65535 expected, 0 found"),
        (["--host", "a" * 70 + ".invalid"], "host: a name or address"),
        (["--factor", "0"], "--factor"),
        (["--factor", "nan"], "--factor"),
        (["--duration", "-1"], "--duration"),
        (["--duration", "nan"], "--duration"),
        (["--duration", "0.001"], "duration: at least one step of 0.05 s expected"),
        (["--rate", "0"], "rate: a positive number"),
    ],
)
def test_what_cannot_be_used(buoy, words, message):
    assert message in refused(buoy, *words)


def test_mistakes_in_the_case(buoy, tmp_path):
    assert "an existing file expected" in refused(tmp_path / "no.toml")
    (tmp_path / "bad.toml").write_text(buoy.read_text().replace("hs = 1.0", "hs = -1.0"))
    assert "sea.hs: -1.0: a number > 0 expected." in refused(tmp_path / "bad.toml")


def test_help_is_quick_to_load():
    """Neither the command nor its options need anything heavy."""
    code = "import sys; sys.argv = ['ogilvie', 'live', '--help']\nfrom ogilvie.app.cli import app\n"
    code += "try: app()\nexcept SystemExit: pass\nprint('LOADED', *sys.modules)"
    environment = os.environ | {"COLUMNS": "100"}
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment).stdout
    text, loaded = out.split("LOADED")
    assert "real time" in text
    assert not {"numpy", "scipy", "xarray", "numba", "ogilvie.sim"} & set(loaded.split())


def test_large_motions_are_sent_as_poses_in_the_world(buoy, tmp_path, ear):
    """A current turns the case into one of large motions; it drifts with the water, and no steady frame is added."""
    text = buoy.read_text() + "[current]\nspeed = 1.0\ndirection_deg = 90.0\n[damping]\nquadratic = { sway = 1e5 }\n"
    text = re.sub(r"hs = 1.0\s+tp = 8.0\s+direction_deg = 120.0", 'spectrum = "calm"', text).replace("realisations = 3", "")
    text = text.replace("mooring_period = { surge = 30.0, sway = 30.0, yaw = 30.0 }", "")
    text = text.replace("damping_ratio = { surge = 0.1, sway = 0.1, yaw = 0.1 }", "")
    (tmp_path / "buoy.nc").write_bytes((buoy.parent / "buoy.nc").read_bytes())
    (tmp_path / "buoy.toml").write_text(text)
    process = started(tmp_path / "buoy.toml", ear, "--duration", "4", "--factor", "8")
    _, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    lines = [json.loads(line) for line in drained(ear)]
    assert len(lines) == 80
    assert lines[-1]["eta"][1] - lines[0]["eta"][1] > 0.05
    assert lines[-1]["eta"][5] == pytest.approx(math.radians(30.0), abs=0.2)


@pytest.mark.parametrize("option", [{"origin": "59,10"}, {"x_axis": "west"}, {"fix": "ordinary"}])
def test_what_json_does_not_hold_is_refused_with_it(option):
    given = dict(origin="0,0", x_axis="east", fix="simulated") | option
    options = live.LiveOptions("127.0.0.1", 10110, "json", 1.0, None, None, **given)
    with pytest.raises(og.InputError, match="only with --format nmea"):
        _ = options.formatter
