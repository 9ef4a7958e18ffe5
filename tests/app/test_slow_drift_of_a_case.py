"""Second-order wave forces of a case: where the mean drift comes from, what it pushes, what is refused."""

import numpy as np
import pytest
import xarray as xr

import ogilvie as og
from ogilvie.app import build, build_run
from ogilvie.app.build_drift import drift_loads, holds_drift, with_drift
from ogilvie.app.case import parse_case
from ogilvie.app.foresight import foresee_data
from ogilvie.app.run import run_case
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.units import deg

HULLLESS = """
[coefficients]
file = "data.nc"
[body]
mass = 1e7
zg = 0.0
gyradii = [7.0, 28.0, 28.0]
[sea]
hs = 2.0
tp = 9.0
[slow_drift]
"""


def regular(text: str) -> str:
    """The barge in regular waves on springs of known stiffness, with slow drift and without pictures."""
    text = text.replace("hs = 1.0\ntp = 8.0", 'spectrum = "regular"\namplitude = 0.5\nperiod = 5.0')
    text = text.replace("mooring_period = { surge = 60.0, sway = 60.0, yaw = 60.0 }", SPRINGS)
    text = text.replace("realisations = 2", "realisations = 1").replace("omega_count = 15", "omega_count = 8")
    return text + "[slow_drift]\n[output]\nfigures = false\nreport = false\n"


SPRINGS = "mooring_stiffness = { surge = 2e4, sway = 2e4, yaw = 1e7 }"


@pytest.fixture(scope="module")
def run(box_text, tmp_path_factory):
    """The findings of a run and its folder."""
    folder = tmp_path_factory.mktemp("drift")
    return run_case(parse_case(regular(box_text)), folder, progress=False), folder


def test_springs_hold_the_mean_drift_of_regular_waves(run):
    """Over whole periods the mean force of the springs is that of the waves, a^2 D at their frequency and direction."""
    found, _ = run
    eta = found.run.eta.sel(time=slice(99.95, 199.95)).mean("time")
    for dof in ("surge", "sway"):
        D = found.hydro.mean_drift.sel(influenced_dof=dof).interp(wave_direction=135 * deg)
        force = 0.25 * np.interp(2 * np.pi / 5.0, D.omega, D.values)
        assert float(eta.sel(dof=dof)) * 2e4 == pytest.approx(force, rel=0.15), dof
    assert float(eta.sel(dof="surge")) < 0 < float(eta.sel(dof="sway"))  # they travel aft and to port


def test_the_drift_is_kept_with_the_coefficients(run):
    found, folder = run
    kept = og.read_hydro(folder / "coefficients.nc")
    xr.testing.assert_allclose(kept.mean_drift, found.hydro.mean_drift)
    assert found.loads.count("slow_drift") == found.loads.count("wave_drift_damping") == 1


def test_coefficients_that_hold_a_drift_are_taken_as_they_are(run, box_text):
    found, _ = run
    case = parse_case(regular(box_text))
    assert holds_drift(case, found.hydro)
    assert with_drift(case, None, found.hydro, found.body, found.hull) is found.hydro


def test_a_vessel_without_the_section_has_no_drift(run, box_text):
    found, _ = run
    case = parse_case(box_text)
    hydro = found.hydro.drop_vars("mean_drift")
    assert with_drift(case, None, hydro, found.body, found.hull) is hydro
    sea = build_run.make_sea(case, build_run.make_spectrum(case), hydro)
    names = build_run.make_vessel(case, found.body, hydro, found.K, found.ssm, hull=found.hull, sea=sea).names
    assert "slow_drift" not in names


def test_in_large_motions_the_waves_are_met_at_the_slow_position(run, box_text):
    found, _ = run
    text = regular(box_text).replace("[simulation]", '[simulation]\nmotions = "large"')
    text = text.replace("[90.0, 135.0, 180.0]", "[0.0, 45.0, 90.0, 135.0, 180.0]")
    case = parse_case(text)
    sea = build_run.make_sea(case, None, found.hydro)
    vessel = build_run.make_vessel(case, found.body, found.hydro, found.K, found.ssm, hull=found.hull, sea=sea)
    (waves,) = [load for load in vessel.loads if load.name == "excitation"]
    assert waves.position == "slow"


def test_wave_drift_damping_can_be_left_out(run, box_text):
    found, _ = run
    case = parse_case(regular(box_text).replace("[slow_drift]", "[slow_drift]\ndamping = false"))
    sea = build_run.make_sea(case, None, found.hydro)
    assert [load.name for load in drift_loads(case, found.hydro, sea)] == ["slow_drift"]


def test_drift_needs_data_or_a_hull(tmp_path):
    (tmp_path / "data.nc").touch()
    w, Z = np.linspace(0.2, 1.6, 8), np.zeros((8, 6, 6))
    hydro = og.hydro_from_arrays(omega=w, added_mass=Z, radiation_damping=Z)
    with pytest.raises(InputError, match=r"WAMIT .8 or .9.*\[hull\]"):
        foresee_data(parse_case(HULLLESS, folder=tmp_path), hydro)
    full = parse_case(HULLLESS + 'approximation = "full"\n', folder=tmp_path)
    with pytest.raises(InputError, match=r"\.12d"):
        foresee_data(full, hydro)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('spectrum = "regular"\namplitude = 0.5\nperiod = 5.0', 'spectrum = "calm"', "slow_drift: a sea expected"),
        ('name = "barge"', "speed_knots = 5", "without forward speed expected"),
        ("[slow_drift]", '[slow_drift]\napproximation = "full"', "coefficients.file with a WAMIT .12d"),
        ("[slow_drift]", '[slow_drift]\napproximation = "newman"', "newman-arithmetic"),
    ],
)
def test_contradictions(box_text, old, new, words):
    text = regular(box_text)
    assert old in text
    with pytest.raises(InputError, match=words):
        parse_case(text.replace(old, new))


def test_a_method_is_for_hulls(tmp_path):
    (tmp_path / "data.nc").touch()
    with pytest.raises(InputError, match=r"slow_drift.method: how the drift of a \[hull\]"):
        parse_case(HULLLESS + 'method = "near"\n', folder=tmp_path)


def test_the_drift_is_that_of_the_damped_and_moored_vessel(run, box_text):
    """Springs and damping of the case shape the motion that the drift comes from."""
    found, _ = run
    case = parse_case(regular(box_text).replace("roll = 0.08", "roll = 0.9"))
    hydro = found.hydro.drop_vars("mean_drift")
    still = build_run.make_vessel(case, found.body, hydro, found.K, found.ssm, hull=build.make_hull(case))
    with pytest.warns(OgilvieWarning, match="energy out of balance"):
        moved = with_drift(case, still, hydro, found.body, found.hull, progress=False)
    other = moved.mean_drift.sel(influenced_dof="sway")
    mine = found.hydro.mean_drift.sel(influenced_dof="sway")
    assert float(abs(other - mine).max()) > 0.02 * float(abs(mine).max())
