"""The two-phase probe: content with every real set, and not with any of them once a convention is turned."""

import re

import numpy as np
import pytest
import xarray as xr

from ogilvie.errors import ConventionError
from ogilvie.frames import Z_DOWN
from ogilvie.hydro.files import read_hydro
from ogilvie.hydro.probe import check_convention, phase_probe
from ogilvie.hydro.schema import hydro_from_arrays

REAL = {
    "tanker": "mss_wamit_tanker/tanker",
    "fpso": "mss_wamit_fpso/fpso",
    "semisub": "mss_wamit_semisub/semisub",
    "sphere": "wecsim_sphere_drift/sphere",
    "cyl": "wecsim_cylinder/cyl",
    "ellipsoid": "wecsim_ellipsoid/ellipsoid",
    "buoy": "fshd_buoya5/BuoyA5",
    "hams-cylinder": "hams_certtest/Cylinder",
    "hams-moonpool": "hams_certtest/Moonpool",
}
TWO_SIDED = ("tanker", "fpso", "semisub", "hams-cylinder", "hams-moonpool")  # headings that tell port from starboard

FORCES = ("excitation_force", "Froude_Krylov_force", "diffraction_force", "motion_rao")


def conjugated(h: xr.Dataset) -> xr.Dataset:
    return h.assign({key: h[key].conj() for key in FORCES if key in h})


def turned(h: xr.Dataset, change) -> xr.Dataset:
    """The same numbers with other labels on the directions."""
    b = change(h.wave_direction.values) % (2 * np.pi)
    return h.assign_coords(wave_direction=b).sortby("wave_direction")


def z_down(h: xr.Dataset) -> xr.Dataset:
    """x forward, y to starboard, z down, directions clockwise: as Fossen's vessels."""
    T = Z_DOWN
    new = {key: h[key] * T for key in FORCES if key in h}
    new |= {key: h[key] * T[:, None] * T for key in ("added_mass", "radiation_damping", "hydrostatic_stiffness") if key in h}
    return turned(h.assign(new), lambda b: -b)


@pytest.mark.parametrize("name", REAL)
def test_real_sets_follow_the_convention(shared_data, name):
    result = phase_probe(read_hydro(shared_data / REAL[name], probe=False))
    assert result.ok, result.problems
    np.testing.assert_allclose(result.heave_ratio, 1.0, atol=0.015)
    np.testing.assert_allclose(result.surge_phase, 90.0, atol=1.0)
    if name in TWO_SIDED:
        np.testing.assert_allclose(result.sway_phase, 90.0, atol=2.0)
    assert result.size < 0.5


@pytest.mark.parametrize("name", REAL)
@pytest.mark.parametrize(
    ("change", "ratio", "surge", "cure"),
    [
        (conjugated, -1.0, -90.0, "complex conjugate of forces and motions.$"),
        (lambda h: turned(h, lambda b: b + np.pi), 1.0, -90.0, "^Directions say where waves come from: add pi"),
        (lambda h: turned(conjugated(h), lambda b: b + np.pi), -1.0, 90.0, "complex conjugate.*Directions say where"),
        (z_down, -1.0, 90.0, "z points down"),
    ],
    ids=["conjugated", "from", "conjugated-from", "z-down"],
)
def test_turned_sets_are_refused_with_the_cure(shared_data, name, change, ratio, surge, cure):
    h = change(read_hydro(shared_data / REAL[name]))
    result = phase_probe(h)
    np.testing.assert_allclose([result.heave_ratio, result.surge_phase], [ratio, surge], atol=1.0)
    assert re.search(cure, " ".join(result.problems)), result.problems
    with pytest.raises(ConventionError, match=r"x.1: heave ratio .* surge phase"):
        check_convention(h, source="x.1")


@pytest.mark.parametrize("name", TWO_SIDED)
def test_mirrored_sets_are_refused(shared_data, name):
    h = turned(read_hydro(shared_data / REAL[name]), lambda b: -b)
    assert phase_probe(h).problems == ("Directions are clockwise or y points to starboard: change the sign of the directions.",)


@pytest.mark.parametrize("given", [{"ulen": 3.0}, {"ulen": 0.3}, {"g": 32.2}])
def test_wrong_sizes_are_refused(shared_data, tmp_path, given):
    """Length scale and gravity enter F3 and omega B33 with different powers, so the ratio leaves 1."""
    for suffix in ("1", "3"):
        (tmp_path / f"x.{suffix}").write_bytes((shared_data / f"{REAL['fpso']}.{suffix}").read_bytes())
    with pytest.raises(ConventionError, match="check the length scale, gravity, and whether the first column is the period"):
        read_hydro(tmp_path / "x", **given)


@pytest.mark.parametrize("name", ["tanker", "fpso", "semisub", "buoy"])
def test_a_first_column_taken_for_another_is_refused(shared_data, tmp_path, name):
    """Read upside down there may be no long waves at all, but short ones that push as long ones do."""
    for suffix in ("1", "3"):
        (tmp_path / f"x.{suffix}").write_bytes((shared_data / f"{REAL[name]}.{suffix}").read_bytes())
    (tmp_path / "x.cfg").write_text("IPEROUT=2\n")
    with pytest.raises(ConventionError, match="check whether the first column is the period"):
        read_hydro(tmp_path / "x")


# --- by formula: what the relative motion says, for the directions that happen to be there ---


def body(degrees, *, draught_coupling=0.0, C33=1e6, stiffness=True, lead=1.0, omega=(0.1, 0.2, 0.3)) -> xr.Dataset:
    """Heave from the relative motion, with a part that is odd in the direction; surge and sway from the acceleration."""
    w, b = np.array(omega), np.deg2rad(degrees)
    A = np.tile(np.diag([1e5, 2e5, 3e5, 1e6, 2e6, 1e6]), (len(w), 1, 1))
    B = 1e4 * w[:, None, None] ** 3 * A / 1e5
    A[:, 2, 4] = A[:, 4, 2] = draught_coupling
    k = w**2 / 9.81
    F = np.zeros((len(w), len(b), 6), dtype=complex)
    F[:, :, 0] = 1j * (w**2 * 2e5)[:, None] * np.cos(b)
    F[:, :, 1] = 1j * (w**2 * 3e5)[:, None] * np.sin(b)
    F[:, :, 2] = (C33 - w**2 * (A[:, 2, 2] + 1e5) + 1j * w * B[:, 2, 2])[:, None]
    F[:, :, 2] += -1j * k[:, None] * draught_coupling * 20.0 * np.cos(b)
    C = np.diag([0.0, 0.0, C33, 1e6, 1e6, 0.0])
    h = hydro_from_arrays(
        omega=w,
        wave_direction=b,
        added_mass=A,
        radiation_damping=B,
        excitation_force=lead * F,
        hydrostatic_stiffness=C if stiffness else None,
        g=9.81,
        rho=1000.0,
    )
    return h


def test_opposite_directions_remove_what_is_odd():
    """A ship that is unlike fore and aft: exact from 0 and 180 deg."""
    result = phase_probe(body((0.0, 45.0, 180.0), draught_coupling=3e5))
    np.testing.assert_allclose([result.heave_ratio, result.surge_phase, result.sway_phase], [1.0, 90.0, 90.0], rtol=1e-9)


def test_one_direction_is_enough_for_a_body_alike_fore_and_aft():
    result = phase_probe(body((150.0,)))
    np.testing.assert_allclose([result.heave_ratio, result.surge_phase, result.sway_phase], [1.0, 90.0, 90.0], rtol=1e-9)
    assert result.notes == ()


def test_what_is_not_possible_is_noted_and_no_error():
    h = check_convention(body((150.0,), draught_coupling=3e5), source="x")
    assert np.isnan(h.attrs["probe_heave_ratio"])
    assert "no two opposite directions, and the hull is not alike fore and aft" in h.attrs["probe_notes"]
    np.testing.assert_allclose(h.attrs["probe_surge_phase_deg"], 90.0)


def test_beam_seas_only():
    result = phase_probe(body((90.0,), draught_coupling=3e5))
    np.testing.assert_allclose([result.heave_ratio, result.sway_phase], [1.0, 90.0], rtol=1e-9)
    assert np.isnan(result.surge_phase)
    assert result.ok
    assert "take the complex conjugate" in phase_probe(conjugated(body((90.0,)))).problems[0]


def test_without_heave_the_surge_phase_still_speaks():
    h = body((0.0,), draught_coupling=3e5)
    (problem,) = phase_probe(conjugated(h)).problems
    assert problem.startswith("Either the time factor is exp(-i omega t)")


def test_a_submerged_body_has_no_stiffness_and_a_heave_force_against_the_wave():
    result = phase_probe(body((0.0, 180.0), C33=0.0))
    assert result.ok
    np.testing.assert_allclose(result.heave_ratio, 1.0, rtol=1e-9)
    assert np.isnan(result.heave_sign)
    assert phase_probe(body((0.0, 180.0), C33=0.0, stiffness=False)).ok


def test_z_down_is_seen_without_stiffness():
    h = body((0.0, 180.0), stiffness=False)
    assert phase_probe(h).heave_sign == 1.0
    assert "z points down" in phase_probe(z_down(h)).problems[0]


def test_nothing_to_probe():
    h = body((0.0, 180.0))
    assert phase_probe(h.drop_vars("excitation_force")).notes == ("no excitation force",)
    short = body((0.0, 180.0), omega=(8.0, 9.0), lead=1e-4)
    assert phase_probe(short).notes[0].startswith("no long waves: k R is 3")
    still = h.assign(radiation_damping=0.0 * h.radiation_damping)
    assert phase_probe(still).notes == ("heave: damping in long waves is below rounding", "sway: no such force or direction")
    for dull in (h.drop_vars("excitation_force"), short, still):
        assert "not possible" in check_convention(dull, source="x").attrs["probe_notes"]
