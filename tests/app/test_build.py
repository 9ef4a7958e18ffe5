"""From a case to objects: units, defaults, and what is derived from other things."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.app import build, build_memory, build_run
from ogilvie.app.case import parse_case
from ogilvie.errors import InputError, OgilvieWarning

HEAD = """
[hull]
shape = "box"
length = 40.0
beam = 12.0
draught = 4.0
[body]
mass = 2.0e6
cog = [0.0, 0.0, 0.5]
gyradii = [4.0, 11.0, 11.0]
"""
SEA = "[sea]\nhs = 1.0\ntp = 8.0\n"


def barge(w=None):
    """Coefficients that are constant, with the stiffness of a barge."""
    w = np.linspace(0.2, 3.0, 29) if w is None else w
    A = np.tile(np.diag([1e6, 2e6, 3e6, 1e8, 4e8, 5e8]), (len(w), 1, 1))
    C = np.diag([0, 0, 5e6, 6e7, 7e8, 0])
    return og.hydro_from_arrays(omega=w, added_mass=A, radiation_damping=0.1 * A, hydrostatic_stiffness=C)


def test_body_from_its_matrix_is_the_body():
    inertia = np.array([[3.0, 0.1, 0.2], [0.1, 4.0, 0.3], [0.2, 0.3, 5.0]]) * 1e7
    body = og.RigidBody(1.5e6, np.array([1.0, -0.5, 2.0]), inertia)
    again = build.body_from_matrix(body.matrix)
    assert again.mass == body.mass
    np.testing.assert_allclose(again.cog, body.cog, atol=1e-12)
    np.testing.assert_allclose(again.inertia, inertia, rtol=1e-12)


def test_mass_is_what_the_hull_displaces():
    case = parse_case(HEAD.replace("mass = 2.0e6\n", "") + SEA)
    hull = build.make_hull(case)
    assert build.make_body(case, hull).mass == pytest.approx(1025.0 * 40 * 12 * 4, rel=1e-9)


def test_kg_counts_from_the_keel():
    text = HEAD.replace("mass = 2.0e6\n", "").replace("cog = [0.0, 0.0, 0.5]", "kg = 3.0") + SEA
    case = parse_case(text)
    np.testing.assert_allclose(build.make_body(case, build.make_hull(case)).cog, [0.0, 0.0, -1.0], atol=1e-9)


def test_mooring_gives_the_natural_period_that_was_asked_for():
    case = parse_case(HEAD + SEA + "[loads]\nmooring_period = { surge = 50.0, heave = 3.0 }")
    hydro, body = barge(), build.make_body(case, None)
    K = build_memory.mooring_stiffness(case, body, hydro)
    total = K + hydro.hydrostatic_stiffness.values
    M = body.matrix + hydro.added_mass.values[0]
    assert 2 * np.pi * np.sqrt(M[0, 0] / total[0, 0]) == pytest.approx(50.0)
    assert 2 * np.pi * np.sqrt(M[2, 2] / total[2, 2]) == pytest.approx(3.0)


def test_springs_cannot_lengthen_a_period():
    case = parse_case(HEAD + SEA + "[loads]\nmooring_period = { heave = 30.0 }")
    with pytest.raises(InputError, match=r"mooring_period.heave: 30: a period shorter than the unmoored one, 6.28"):
        build_memory.mooring_stiffness(case, build.make_body(case, None), barge())


@pytest.mark.parametrize(
    ("extra", "expected"),
    [
        ("direction_deg = 135.0", [135.0]),
        ("direction_deg = -180.0", [180.0]),
        ("direction_deg = 200.0", [-160.0]),
    ],
)
def test_directions_follow_the_sea(extra, expected):
    case = parse_case(HEAD + SEA + extra)
    np.testing.assert_allclose(np.degrees(build.directions(case)), expected)


def test_directions_are_relative_to_the_bow():
    case = parse_case(HEAD + SEA + "direction_deg = 90.0\n[vessel]\nheading_deg = -90.0")
    np.testing.assert_allclose(np.degrees(build.directions(case)), [180.0])


def test_a_spread_sea_asks_for_directions_all_around():
    case = parse_case(HEAD + SEA + "spreading = 10.0\ndirection_deg = 180.0")
    b = np.degrees(build.directions(case))
    assert len(b) == 24
    np.testing.assert_allclose(np.diff(b), 15.0)


def test_frequencies_from_periods():
    case = parse_case(HEAD + SEA + "[coefficients]\nperiods = [3.0, 20.0, 6.0]")
    np.testing.assert_allclose(build.frequencies(case, None), 2 * np.pi / np.array([20.0, 6.0, 3.0]))


def test_the_sea_has_hs_direction_and_seeds_of_the_case():
    case = parse_case(HEAD + SEA + 'direction_deg = 120.0\nseed = 7\nrandom = "phase"\n[simulation]\nrealisations = 3')
    sea = build_run.make_sea(case, build_run.make_spectrum(case), barge())
    assert sea.seeds == (7, 8, 9)
    np.testing.assert_allclose(sea.hs, 1.0, rtol=5e-3)
    np.testing.assert_allclose(sea.direction, np.radians(120.0))
    assert sea.period == case.simulation.duration


def test_gaussian_seas_vary_in_hs_and_agree_in_the_mean():
    case = parse_case(HEAD + SEA + "[simulation]\nrealisations = 200\nduration = 600.0")
    hs = build_run.make_sea(case, build_run.make_spectrum(case), barge()).hs
    assert hs.std() > 0.02
    assert np.sqrt(np.mean(hs**2)) == pytest.approx(1.0, abs=0.02)


def test_a_sea_beyond_the_coefficients_is_refused():
    case = parse_case(HEAD + SEA)
    with pytest.raises(InputError, match=r"sea: .* % of the variance lies outside the coefficients' 0.2..0.9 rad/s"):
        build_run.make_sea(case, build_run.make_spectrum(case), barge(np.linspace(0.2, 0.9, 8)))


def test_a_sea_that_loses_a_little_is_cut_with_a_warning():
    case = parse_case(HEAD + SEA)
    with pytest.warns(OgilvieWarning, match=r"left out; Hs is .* % low"):
        sea = build_run.make_sea(case, build_run.make_spectrum(case), barge(np.linspace(0.2, 1.8, 17)))
    assert sea.omega.max() <= 1.8


def test_regular_and_calm():
    case = parse_case(HEAD + '[sea]\nspectrum = "regular"\namplitude = 0.5\nperiod = 9.0\ndirection_deg = 90.0')
    sea = build_run.make_sea(case, None, barge())
    assert (float(sea.amplitude[0]), float(sea.direction[0])) == (0.5, pytest.approx(np.pi / 2))
    calm = parse_case(HEAD + '[sea]\nspectrum = "calm"')
    assert build_run.make_sea(calm, None, barge()) is None


@pytest.mark.parametrize(
    ("keys", "expected"), [("", 0.0), ("ramp = 100.0", 200.0), ("initial = { roll_deg = 5.0 }", 360.0), ("skip = 11.0", 11.0)]
)
def test_start_of_the_statistics(keys, expected):
    assert build_run.skipped(parse_case(HEAD + SEA + f"[simulation]\n{keys}")) == expected


def test_default_frequencies_end_where_the_panels_do():
    """Where they resolve a little less than the default range, no frequency is above; where much less, the range stays."""
    from ogilvie.app.crosschecks import default_range
    from ogilvie.hydro.bem_case import resolved_wavenumber

    text = '[hull]\nshape = "box"\nlength = 60.0\nbeam = 20.0\ndraught = 5.0\npanels = {}\n[body]\nkg = 5.0\n'
    text += "gyradii = [7.0, 17.0, 17.0]\n[sea]\nhs = 1.0\ntp = 8.0\n"
    ends = {}
    for panels in (60, 300, 2000):
        case = parse_case(text.format(panels))
        hull = build.make_hull(case)
        high = default_range(hull.beam, case.water.g)[1]
        resolved = float(np.sqrt(case.water.g * resolved_wavenumber(hull)))
        last = build.frequencies(case, hull)[-1]
        assert last == pytest.approx(min(high, resolved) if resolved > 0.75 * high else high)
        ends[panels] = last < high
    assert ends == {60: False, 300: True, 2000: False}
