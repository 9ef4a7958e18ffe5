"""A case at forward speed: memory, wave forces and the frequency domain beside the time domain, following seas included."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.app import build, build_run
from ogilvie.app.build_memory import make_memory
from ogilvie.app.case import parse_case
from ogilvie.app.compare import continued, finer, frequency_domain, under_way
from ogilvie.app.run import run_case
from ogilvie.errors import InputError
from ogilvie.hydro.at_speed import radiation_at_rest
from ogilvie.sim.system import assemble
from ogilvie.units import knot

pytestmark = pytest.mark.filterwarnings("default::ogilvie.errors.OgilvieWarning")

BARGE = """
[vessel]
speed_knots = 6.0
heading_deg = 20.0
[hull]
shape = "wigley"
length = 60.0
beam = 9.0
draught = 3.75
variant = "III"
panels = 160
[body]
kg = 3.4
gyradii = [3.2, 15.0, 15.0]
[coefficients]
omega_min = 0.15
omega_max = 2.6
omega_count = 26
directions_deg = [0.0, 30.0, 60.0, 90.0, 120.0, 150.0, 180.0]
forward_speed = "rule"
[memory]
model = "convolution"
[sea]
hs = 1.0
tp = 8.0
random = "phase"
direction_deg = 50.0
[loads]
damping_ratio = { surge = 0.1, sway = 0.1, roll = 0.1, yaw = 0.1 }
mooring_period = { surge = 60.0, sway = 60.0, yaw = 60.0 }
[hull_lift]
[simulation]
duration = 1500.0
dt = 0.1
realisations = 2
[output]
figures = false
report = false
"""


@pytest.fixture(scope="module")
def built(own_cache):
    """Case, hull, body, coefficients and memory."""
    case = parse_case(BARGE)
    hull = build.make_hull(case)
    body = build.make_body(case, hull)
    hydro = build.make_hydro(case, hull, body)
    return case, hull, body, hydro, *make_memory(case, hydro, body)


def response_of_system(case, hull, body, hydro, K, ssm, response):
    """Z(w_e)^-1 F of the equations that the time domain solves, at the frequencies and directions of a response."""
    vessel = build_run.make_vessel(case, body, hydro, K, ssm, hull=hull)
    system, excitation = assemble(vessel), og.WaveExcitation(hydro)
    w = response.omega.values
    X = np.empty(response.shape, dtype=complex)
    for j, b in enumerate(response.wave_direction.values):
        F = excitation.force(w, np.full_like(w, b), case.speed)
        X[:, j] = np.linalg.solve(system.impedance(response.encounter_frequency.values[:, j]), F[..., None])[..., 0]
    return X


def test_the_frequency_domain_solves_the_equations_of_the_time_domain(built):
    """Lift, damping and springs at 14 knots, all headings: the RAO of the data against the impedance of the vessel."""
    _, hull, body, hydro, K, ssm = built
    case = parse_case(BARGE.replace("speed_knots = 6.0", "speed_knots = 14.0"))
    vessel = build_run.make_vessel(case, body, hydro, K, ssm, hull=hull)
    response = frequency_domain(case, vessel, hydro, body, None)["response"]
    kept = response.omega <= 1.6  # where the wave is longer than the panels allow for
    response = response.isel(omega=np.flatnonzero(kept))
    X = response_of_system(case, hull, body, hydro, K, ssm, response)
    assert (response.encounter_frequency < 0).any()  # overtaken waves are among them
    for i in range(6):
        size = np.abs(X[:, :, i]).max()
        np.testing.assert_allclose(response.values[:, :, i], X[:, :, i], atol=0.05 * size)


def test_statistics_agree_in_a_quartering_sea(tmp_path):
    """Time against frequency domain at 6 knots with waves from the quarter."""
    found = run_case(parse_case(BARGE), tmp_path)
    assert found.run.attrs["motions"] == "small"
    np.testing.assert_allclose(found.statistics["std"] / found.expected["std"], 1.0, atol=0.05)


def test_coefficients_solved_at_speed_give_the_memory_of_zero_speed(built):
    _, hull, body, _, K, _ = built
    text = BARGE.replace('forward_speed = "rule"', "").replace("omega_count = 26", "omega_count = 26\n")
    text = text.replace("directions_deg = [0.0, 30.0, 60.0, 90.0, 120.0, 150.0, 180.0]", "directions_deg = [180.0]")
    other = parse_case(text)
    sailing = build.make_hydro(other, hull, body)
    assert sailing.attrs["speed"] == pytest.approx(6 * knot)
    assert radiation_at_rest(sailing).attrs["speed"] == 0.0
    K_sailing, _ = make_memory(other, sailing, body)
    size = np.sqrt(np.multiply.outer(*(2 * [np.abs(np.diagonal(K.K[0]))])))
    n = min(len(K.t), len(K_sailing.t), 100)
    assert np.abs((K_sailing.K[:n] - K.K[:n]) / size).max() < 0.05


def test_finer_coefficients_keep_their_terms_of_speed(built):
    """Interpolated at zero speed: between the frequencies the same as carried to the speed after interpolation."""
    *_, hydro, _, _ = built
    sailing = og.at_speed(hydro, 3.0)
    one, other = finer(sailing), og.at_speed(finer(hydro), 3.0)
    for key in ("added_mass", "radiation_damping"):
        np.testing.assert_allclose(one[key].values, other[key].values, rtol=1e-9, atol=1e-6 * np.abs(other[key].values).max())


def test_continued_coefficients_reach_the_encounter(built):
    *_, hydro, _, _ = built
    sailing = under_way(hydro, 3.0)
    longer = continued(sailing)
    assert longer.omega[-1] > 2.6 + 2.6**2 / 9.81 * 3.0 * 0.99
    np.testing.assert_array_equal(longer.added_mass.values[:26], sailing.added_mass.values)
    assert not np.any(longer.excitation_force.values[26:])
    A_inf, A = hydro.added_mass_inf.values, hydro.added_mass.values[-1]
    expected = A_inf + (A - A_inf) * (2.6 / float(longer.omega[-1])) ** 2
    np.testing.assert_allclose(np.diag(radiation_at_rest(longer).added_mass.values[-1]), np.diag(expected), rtol=1e-6)


def test_coefficients_of_another_speed_are_refused(built):
    case, hull, _, hydro, *_ = built
    with pytest.raises(
        InputError, match=r"those of zero speed or of the vessel's 6 knots expected, 19.44 knots \(10 m/s\) found"
    ):
        build.fitted_to_speed(case, hydro.assign_attrs(speed=10.0), hull)


def test_wave_forces_in_one_part_are_split_by_the_hull(built):
    case, hull, _, hydro, *_ = built
    whole = hydro.drop_vars(["Froude_Krylov_force", "diffraction_force"])
    found = build.fitted_to_speed(case, whole, hull)
    expected = og.at_speed(hydro, case.speed)
    size = np.abs(expected.excitation_force.values).max(axis=(0, 1))
    np.testing.assert_allclose(found.excitation_force.values / size, expected.excitation_force.values / size, atol=1e-6)


def test_a_pose_at_the_start_is_turned_into_the_world():
    text = BARGE.replace('model = "convolution"', "")
    text += "[current]\nspeed = 0.5\ndirection_deg = 0.0\n[simulation.initial]\nsurge = 10.0\nyaw_deg = 5.0\n"
    start = build_run.initial(parse_case(text))["eta"]
    np.testing.assert_allclose(start[:2], 10.0 * np.array([np.cos(np.radians(20)), np.sin(np.radians(20))]))
    assert start[5] == pytest.approx(np.radians(25.0))
