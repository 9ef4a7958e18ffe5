"""Second-order wave forces of a case: where the mean drift comes from, what it pushes, what is refused."""

import numpy as np
import pytest
import xarray as xr

import ogilvie as og
from ogilvie.app import build, build_run
from ogilvie.app.build_drift import drift_data, drift_loads, frequencies_of, holds_drift
from ogilvie.app.build_loads import Made, resistance
from ogilvie.app.build_resistance import added_resistance, moving
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
    assert drift_data(case, None, found.hydro, found.body, found.hull, None) is found.hydro


def test_a_vessel_without_the_section_has_no_drift(run, box_text):
    found, _ = run
    case = parse_case(box_text)
    hydro = found.hydro.drop_vars("mean_drift")
    assert drift_data(case, None, hydro, found.body, found.hull, None) is hydro
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
        ('name = "barge"', "speed_knots = 5", "added resistance slows a ship down"),
        ('name = "barge"', "speed_knots = 5\n[resistance]\n[slow_drift]\ndamping = true", "for a vessel at rest; at 5 knots"),
        ('name = "barge"', 'speed_knots = 5\n[resistance]\n[slow_drift]\napproximation = "full"', "for a vessel at rest"),
        ('name = "barge"', "speed_knots = 5\n[resistance]\n[water]\ndepth = 40.0", "speed in water of 40 m"),
        ("[slow_drift]", '[slow_drift]\nsecond_order = "pinkster"', "only with approximation"),
        ("[slow_drift]", "[slow_drift]\nomega_count = 9", "only at speed or with"),
        ("[slow_drift]", '[slow_drift]\napproximation = "full"\nmethod = "near"', "not with approximation"),
        ("[slow_drift]", '[slow_drift]\napproximation = "newman"', "newman-arithmetic"),
    ],
)
def test_contradictions(box_text, old, new, words):
    text = regular(box_text)
    assert old in text
    if "[slow_drift]" in new and old != "[slow_drift]":
        text = text.replace("[slow_drift]\n", "")
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
        moved = drift_data(case, still, hydro, found.body, found.hull, found.sea, progress=False)
    other = moved.mean_drift.sel(influenced_dof="sway")
    mine = found.hydro.mean_drift.sel(influenced_dof="sway")
    assert float(abs(other - mine).max()) > 0.02 * float(abs(mine).max())


def test_a_full_function_is_computed_from_the_hull(run, box_text, tmp_path):
    """In regular waves its diagonal is all that counts: the mean force is that of the mean drift."""
    found, _ = run
    text = regular(box_text).replace("[slow_drift]", '[slow_drift]\napproximation = "full"\nsecond_order = "pinkster"')
    full = run_case(parse_case(text), tmp_path, progress=False)
    assert (tmp_path / "drift.nc").is_file()
    assert "qtf_diff" not in full.hydro
    one, two = (f.run.eta.sel(time=slice(99.95, 199.95), dof="sway").mean() for f in (full, found))
    assert float(one) == pytest.approx(float(two), rel=0.2)  # one from the control surface, the other from the far field


SAILING = """
[vessel]
name = "barge"
speed_knots = 6.0
[hull]
shape = "wigley"
variant = "I"
length = 60.0
beam = 8.0
draught = 3.5
panels = 160
[body]
kg = 3.0
gyradii = [2.8, 15.0, 15.0]
[coefficients]
omega_min = 0.5
omega_max = 2.4
omega_count = 8
directions_deg = [150.0, 180.0]
forward_speed = "rule"
[sea]
spectrum = "regular"
amplitude = 0.2
period = 6.2
[resistance]
[loads]
mooring_stiffness = { sway = 1e4, yaw = 1e7 }
damping_ratio = { roll = 0.1 }
[simulation]
duration = 400.0
dt = 0.1
ramp = 40.0
motions = "large"
[slow_drift]
[output]
figures = false
report = false
"""


def test_added_resistance_slows_a_ship_down(tmp_path):
    """The mean speed is where thrust, set for the speed in still water, balances resistance and the mean drift at speed."""
    with_waves = run_case(parse_case(SAILING), tmp_path / "with", progress=False)
    without = run_case(parse_case(SAILING.replace("[slow_drift]\n", "")), tmp_path / "without", progress=False)
    assert "mean_drift" not in with_waves.hydro
    assert "slow_drift" in with_waves.loads
    assert "wave_drift_damping" not in with_waves.loads
    case = parse_case(SAILING)
    hull, U = build.make_hull(case), case.speed
    D = og.mean_drift(
        hull,
        with_waves.body,
        omega=[2 * np.pi / 6.2],
        speed=U,
        method="far",
        rho=1025.0,
        g=9.80665,
        cache=False,
        progress=False,
    )
    force = 0.04 * float(D.mean_drift.sel(influenced_dof="surge").squeeze())
    speeds = [float(f.run.nu.sel(time=slice(300, None), dof="surge").mean()) for f in (with_waves, without)]
    assert force < 0.0
    load = resistance(Made(case, with_waves.body, with_waves.hydro, hull))
    slope = float((load.resistance(U + 0.1) - load.resistance(U - 0.1)) / 0.2)
    M = with_waves.body.mass + float(with_waves.K.A_inf[0, 0])
    elapsed = 380.0 - 20.0  # s: of full waves, the ramp half counted, to the middle of the mean
    gone = force / slope * (1.0 - np.exp(-slope * elapsed / M))
    assert speeds[0] - speeds[1] == pytest.approx(gone, rel=0.25)


def test_short_waves_are_reflected_where_panels_end():
    """Beyond what the panels resolve the drift becomes that of reflection; without it the panel method goes on alone."""
    text = SAILING.replace('spectrum = "regular"\namplitude = 0.2\nperiod = 6.2', "hs = 0.5\ntp = 5.0")
    text = text.replace("omega_count = 8", "omega_count = 16").replace("omega_max = 2.4", "omega_max = 3.2")
    case = parse_case(text)
    hull = build.make_hull(case)
    body = build.make_body(case, hull)
    sea = og.irregular(og.jonswap(hs=0.5, tp=5.0), direction=np.pi, n=20, omega_range=(0.9, 3.0))
    options = {"omega": frequencies_of(case, sea), "wave_direction": np.array([np.pi]), "rho": 1025.0, "g": 9.80665}
    options |= {"progress": False, "cache": False}
    with pytest.warns(OgilvieWarning):
        joined = added_resistance(case, hull, body, **options)
    short = og.short_wave_drift(hull, omega=joined.omega.values[-1:], speed=case.speed, rho=1025.0, g=9.80665)
    assert float(joined.mean_drift[-1, 0, 0]) == pytest.approx(float(short.mean_drift[0, 0, 0]), rel=1e-6)
    assert joined.attrs["speed"] == pytest.approx(case.speed)
    assert og.SlowDrift(joined).dofs[:2] == ("surge", "sway")
    alone = parse_case(text.replace("[slow_drift]", "[slow_drift]\nshort_waves = false"))
    with pytest.warns(OgilvieWarning):
        panels = added_resistance(alone, hull, body, **options)
    np.testing.assert_allclose(panels.omega, options["omega"])
    assert abs(float(panels.mean_drift[-1, 0, 0]) / float(short.mean_drift[0, 0, 0]) - 1.0) > 0.2


def test_frequencies_keep_clear_of_waves_that_travel_with_the_ship():
    case = parse_case(SAILING.replace("speed_knots = 6.0", "speed_knots = 12.0"))
    standing = 9.80665 / case.speed  # rad/s, from astern
    w = moving(np.linspace(standing - 0.1, standing + 0.1, 5), np.array([0.0, np.pi]), case, 9.80665)
    met = w - w**2 * case.speed / 9.80665
    assert len(w) == 5
    assert np.all(np.abs(met) > 0.02 * w)
