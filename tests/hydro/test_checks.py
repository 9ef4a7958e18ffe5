"""Checks of a data set: a sound one passes, damage is found where it was put, and so are known defects of real data."""

import warnings

import numpy as np
import pytest
import xarray as xr

from ogilvie.errors import InputError
from ogilvie.hydro.check_waves import damping_from_forces
from ogilvie.hydro.checks import CheckReport, check
from ogilvie.hydro.kramers_kronig import kramers_kronig_matrix, mismatch
from ogilvie.hydro.mirror import full_circle, is_symmetric
from ogilvie.hydro.schema import hydro_from_arrays
from ogilvie.waves.dispersion import group_velocity, wavenumber

RHO, G, RADIUS = 1025.0, 9.80665, 10.0


@pytest.fixture(scope="module")
def hemisphere(shared_reference) -> xr.Dataset:
    """The exact floating hemisphere in surge, sway, heave, with the forces of Haskind's relation and phases of long waves."""
    Ka, mu33, lam33, mu11, lam11 = np.loadtxt(shared_reference / "hemisphere_exact.csv", delimiter=",", skiprows=3, unpack=True)
    omega = np.sqrt(Ka * G / RADIUS)
    mass = 2 / 3 * np.pi * RHO * RADIUS**3
    A, B = np.zeros((2, len(omega), 3, 3))
    for i, (mu, lam) in enumerate(((mu11, lam11), (mu11, lam11), (mu33, lam33))):
        A[:, i, i], B[:, i, i] = mass * mu, mass * lam * omega
    directions = np.arange(0, 360, 30) * np.pi / 180
    k, cg = omega**2 / G, 0.5 * G / omega
    size = np.sqrt(8 * np.pi * RHO * G * cg / k)[:, None] * np.sqrt(B[:, range(3), range(3)])
    X = np.zeros((len(omega), 12, 3), dtype=complex)
    X[:, :, 0] = 1j * size[:, :1] / np.sqrt(np.pi) * np.cos(directions)
    X[:, :, 1] = 1j * size[:, 1:2] / np.sqrt(np.pi) * np.sin(directions)
    heave = size[:, 2] / np.sqrt(2 * np.pi)
    phase = np.arcsin(np.clip(omega * B[:, 2, 2] / heave, -1, 1))
    X[:, :, 2] = (heave * np.exp(1j * phase))[:, None]
    return hydro_from_arrays(
        omega=omega,
        added_mass=A,
        radiation_damping=B,
        added_mass_inf=np.diag([4 / np.pi - 1, 4 / np.pi - 1, 0.5]) * mass,
        added_mass_zero=np.diag([0.5, 0.5, 0.830951]) * mass,
        wave_direction=directions,
        excitation_force=X,
        hydrostatic_stiffness=np.diag([0.0, 0.0, RHO * G * np.pi * RADIUS**2]),
        inertia_matrix=np.eye(3) * mass,
        rho=RHO,
        g=G,
        dofs=("surge", "sway", "heave"),
        name="hemisphere",
    )


@pytest.fixture(scope="module")
def sound() -> xr.Dataset:
    """A causal, passive, reciprocal model in closed form: K_hat = sum s R/(s^2 + d s + w0^2), R positive semi-definite."""
    omega = np.linspace(0.05, 8.0, 120)
    v = np.array([1.0, 0.6, -0.5])
    terms = ((np.diag([2.0, 1.5, 3.0]), 0.6, 0.9), (np.outer(v, v), 0.9, 1.2))
    K = sum(R * (1j * omega / (w0**2 - omega**2 + 1j * d * omega))[:, None, None] for R, d, w0 in terms)
    A_inf = np.array([[3.0, 0.2, 0.1], [0.2, 4.0, 0.0], [0.1, 0.0, 5.0]])
    return hydro_from_arrays(
        omega=omega,
        added_mass=A_inf + K.imag / omega[:, None, None],
        radiation_damping=K.real,
        added_mass_inf=A_inf,
        hydrostatic_stiffness=np.diag([0.0, 0.0, 9.0]),
        inertia_matrix=np.eye(3),
        dofs=("surge", "sway", "heave"),
    )


def changed(hydro, key, change):
    """Return the data set with `change` applied to a copy of one variable."""
    values = hydro[key].values.copy()
    values = change(values)
    return hydro.assign({key: (hydro[key].dims, values)})


def found(report, kind):
    return [f for f in report.findings if f.kind == kind]


# ---------------------------------------------------------------------------------------------------- sound data


def test_a_sound_data_set_passes(hemisphere):
    report = check(hemisphere)
    assert isinstance(report, CheckReport)
    assert report.ok
    assert report.findings == ()
    assert report.dirty_omega.size == 0
    verdicts = {c.kind: c.verdict for c in report.checks}
    assert set(verdicts.values()) == {"ok"}, verdicts
    worst = {c.kind: c.worst for c in report.checks}
    assert worst["Kramers-Kronig"] < 0.005
    assert worst["added_mass_inf"] < 0.005
    assert worst["Haskind"] < 1e-10
    assert "hemisphere: 108 frequencies" in str(report)


def test_a_model_in_closed_form_passes(sound):
    report = check(sound)
    assert report.findings == ()
    worst = {c.kind: c.worst for c in report.checks}
    assert worst["Kramers-Kronig"] < 0.005
    assert worst["added_mass_inf"] < 0.005
    assert {c.kind for c in report.checks if c.verdict == "not judged"} == {
        "Haskind",
        "long waves",
        "phase probe",
        "headings",
        "added_mass_zero positive",
    }


def test_kramers_kronig_of_the_exact_hemisphere(hemisphere):
    w, A, B = (hemisphere[k].values for k in ("omega", "added_mass", "radiation_damping"))
    result = mismatch(
        w,
        A[:, [0, 2], [0, 2]],
        B[:, [0, 2], [0, 2]],
        hemisphere.added_mass_inf.values[[0, 2], [0, 2]],
        np.ones(len(w), dtype=bool),
    )
    assert np.nanmax(np.abs(result.residual)) < 4e-3
    assert np.abs(result.constant).max() < 3e-3


def test_hilbert_matrix_is_exact_for_lines():
    """B a triangle: the principal value in closed form."""
    s, B = np.array([1.0, 2.0, 4.0]), np.array([0.0, 1.0, 0.0])
    w = np.array([0.5, 1.5, 2.0, 3.0, 7.0])
    fine = np.linspace(1.0, 4.0, 30001)

    def closed(w):
        u = np.abs(np.array([1 - w, 2 - w, 4 - w]))
        with np.errstate(divide="ignore", invalid="ignore"):
            part = np.nan_to_num(u * np.log(u)) * np.sign(np.array([1 - w, 2 - w, 4 - w]))
        return part[0] - 1.5 * part[1] + 0.5 * part[2]  # the jumps of the slope

    expected = np.array([(closed(x) - closed(-x)) / (np.pi * x) for x in w])
    for grid in (s, fine):
        value = kramers_kronig_matrix(grid, w) @ np.interp(grid, s, B)
        np.testing.assert_allclose(value, expected, atol=2e-12 if grid is s else 1e-9)


@pytest.mark.parametrize("depth", [4.0, 30.0, np.inf])
def test_haskind_at_any_depth(depth):
    """A vertical line source: an isotropic force of known size must give back its own damping."""
    omega = np.linspace(0.3, 1.5, 9)
    k, cg = wavenumber(omega, depth, g=G), group_velocity(omega, depth, g=G)
    X = np.full((9, 12, 1), 3.0 + 4.0j)
    B = k / (4 * RHO * G * cg) * 25.0
    hydro = hydro_from_arrays(
        omega=omega,
        added_mass=np.ones((9, 1, 1)),
        radiation_damping=B[:, None, None],
        wave_direction=np.arange(12) * np.pi / 6,
        excitation_force=X,
        water_depth=depth,
        rho=RHO,
        g=G,
        dofs=("heave",),
    )
    implied, trusted = damping_from_forces(hydro)
    np.testing.assert_allclose(implied[:, 0, 0], B, rtol=1e-12)
    assert trusted.all()


# ---------------------------------------------------------------------------------------------------- damage


@pytest.mark.parametrize("at", [20, 60, 90])
def test_negative_damping(sound, at):
    def damage(B):
        B[at] = np.diag(B[at].diagonal())
        B[at, 2, 2] = -0.1 * B[:, 2, 2].max()
        return B

    report = check(changed(sound, "radiation_damping", damage))
    finding = found(report, "damping positive")[0]
    assert finding.omega == sound.omega.values[at]
    assert finding.dofs == ("heave",)
    assert finding.value == pytest.approx(0.1)
    assert not report.ok
    assert sound.omega.values[at] in report.dirty_omega


def test_broken_reciprocity(sound):
    def damage(A):
        A[33, 0, 2] = A[33, 2, 0] + 0.2 * np.sqrt(A[:, 0, 0].max() * A[:, 2, 2].max())
        return A

    report = check(changed(sound, "added_mass", damage))
    (finding,) = found(report, "reciprocity")
    assert finding.dofs == ("surge", "heave")
    assert finding.omega == sound.omega.values[33]
    assert finding.value == pytest.approx(0.2)
    assert "A(surge, heave) and A(heave, surge) differ by 20 %" in finding.sentence


def test_an_outlier_is_a_warning_and_a_contradiction_an_error(sound):
    def damage(A):
        A[40, 2, 2] += 0.3 * np.ptp(A[:, 2, 2])
        return A

    report = check(changed(sound, "added_mass", damage))
    (finding,) = [f for f in found(report, "Kramers-Kronig") if f.local]
    assert finding.omega == sound.omega.values[40]
    assert finding.dofs == ("heave",)
    assert report.dirty_omega.tolist() == [sound.omega.values[40]]
    # the same bump in one cluster of coarse data, where A and B cannot be compared, remains an outlier
    coarse = changed(sound, "added_mass", damage).isel(omega=slice(36, 46))
    (warning,) = found(check(coarse), "outliers")
    assert warning.severity == "warning"
    assert warning.omega == sound.omega.values[40]


@pytest.mark.parametrize("factor", [0.8, 1.25])
def test_added_mass_and_damping_of_different_bodies(hemisphere, factor):
    report = check(changed(hemisphere, "radiation_damping", lambda B: factor * B))
    assert {f.dofs for f in found(report, "Kramers-Kronig")} >= {("surge",), ("sway",), ("heave",)}
    assert max(f.value for f in found(report, "Haskind")) == pytest.approx(abs(1 / factor - 1), rel=1e-6)


def test_wrong_added_mass_inf(sound):
    def damage(A_inf):
        A_inf[2, 2] *= 1.15
        return A_inf

    (finding,) = found(check(changed(sound, "added_mass_inf", damage)), "added_mass_inf")
    assert finding.dofs == ("heave",)
    assert finding.severity == "error"


def test_truncated_range(sound):
    peak = int(sound.radiation_damping.values[:, 2, 2].argmax())
    upper = check(sound.isel(omega=slice(None, peak + 3)))
    lower = check(sound.isel(omega=slice(peak - 3, None)))
    assert any("at the last frequency" in f.sentence for f in found(upper, "range"))
    assert any("at the first frequency" in f.sentence for f in found(lower, "range"))
    assert all(f.severity == "warning" for f in found(upper, "range"))


def test_coarse_frequencies(sound):
    (finding,) = found(check(sound.isel(omega=slice(0, None, 8))), "resolution")
    assert finding.severity == "warning"
    assert "Add frequencies" in finding.sentence


def test_haskind_finds_forces_of_another_hull(hemisphere):
    report = check(changed(hemisphere, "excitation_force", lambda X: 1.1 * X))
    assert len(found(report, "Haskind")) > 10
    assert max(f.value for f in found(report, "Haskind")) == pytest.approx(0.21, rel=1e-6)
    text = str(report)
    assert "more like it" in text
    assert len(text) < 6000


def test_haskind_needs_enough_headings(hemisphere):
    few = hemisphere.isel(wave_direction=[0, 3, 7])
    (outcome,) = [c for c in check(few).checks if c.kind == "Haskind"]
    assert outcome.verdict == "not judged"
    # one side is enough for a symmetric body
    half = hemisphere.isel(wave_direction=slice(0, 7))
    assert is_symmetric(half)
    (outcome,) = [c for c in check(half).checks if c.kind == "Haskind"]
    assert outcome.verdict == "ok"
    assert outcome.worst < 1e-10


def test_wrong_units_of_the_forces(hemisphere):
    (finding,) = found(check(changed(hemisphere, "excitation_force", lambda X: 0.3048 * X)), "long waves")
    assert finding.severity == "error"


def test_wrong_time_factor(hemisphere):
    (first, *_) = found(check(changed(hemisphere, "excitation_force", np.conj)), "phase probe")
    assert "exp(-i omega t)" in first.sentence


def test_missing_directions(hemisphere):
    (finding,) = found(check(hemisphere.isel(wave_direction=[0, 1])), "headings")
    assert finding.severity == "warning"
    assert "seas from there cannot be simulated" in finding.sentence


def test_matrices(sound):
    def negative(C):
        C[2, 2] *= -1
        return C

    def skew(M):
        M[0, 1] = 0.3 * M[0, 0]
        return M

    assert found(check(changed(sound, "hydrostatic_stiffness", negative)), "stiffness")[0].dofs == ("heave",)
    assert "not symmetric" in found(check(changed(sound, "inertia_matrix", skew)), "inertia_matrix positive")[0].sentence
    minus = check(changed(sound, "added_mass_inf", lambda A: -A))
    assert "not positive definite" in found(minus, "added_mass_inf positive")[0].sentence


def test_forward_speed_is_not_judged_by_laws_at_rest(hemisphere):
    report = check(hemisphere.assign_attrs(speed=8.0))
    verdicts = {c.kind: c for c in report.checks}
    for kind in ("reciprocity", "damping positive", "Kramers-Kronig", "Haskind"):
        assert verdicts[kind].verdict == "not judged"
        assert "zero speed" in verdicts[kind].note
    assert verdicts["outliers"].verdict == "ok"


def test_an_unresolved_resonance_is_not_taken_for_a_contradiction(sound):
    """A piston mode: K_hat gains a resonance so narrow that one frequency alone shows it."""
    w, w0, d = sound.omega.values, sound.omega.values[50] + 0.003, 0.02
    K = 0.08 * 1j * w / (w0**2 - w**2 + 1j * d * w)

    def gain(M, extra):
        M = M.copy()
        M[:, 2, 2] += extra
        return M

    narrow = changed(sound, "added_mass", lambda A: gain(A, K.imag / w))
    narrow = changed(narrow, "radiation_damping", lambda B: gain(B, K.real))
    report = check(narrow)
    assert report.ok, str(report)
    assert found(report, "outliers")[0].omega == w[50]
    (causal,) = [c for c in report.checks if c.kind == "Kramers-Kronig"]
    assert "unresolved resonance of heave" in causal.where


def test_silent_dofs_are_left_out(sound):
    def quiet(M):
        M = M.copy()
        M[:, 1] = M[:, :, 1] = 0.0
        M[:, 1, 1] = 1e-6 * M[:, 0, 0].max() * np.random.default_rng(1).normal(size=len(M))
        return M

    silent = changed(changed(sound, "added_mass", quiet), "radiation_damping", quiet).drop_vars("added_mass_inf")
    report = check(silent)
    assert "sway hardly makes waves" in str(report)
    assert report.ok


def test_broken_contract_raises(sound):
    with pytest.raises(InputError, match="NaN"):
        check(changed(sound, "added_mass", lambda A: A * np.nan))


def test_full_circle_merges_and_mirrors():
    X = np.arange(4.0)[None, :, None] * np.ones((2, 1, 2))
    b, values = full_circle(np.array([-np.pi / 2, 0.0, np.pi / 2, np.pi]), X, None)
    np.testing.assert_allclose(b, [0, np.pi / 2, np.pi, 3 * np.pi / 2])
    np.testing.assert_array_equal(values[0, :, 0], [1, 2, 3, 0])
    b, values = full_circle(np.array([0.0, np.pi / 3]), X[:, :2], np.array([1.0, -1.0]))
    np.testing.assert_allclose(b, [0, np.pi / 3, 5 * np.pi / 3])
    np.testing.assert_array_equal(values[0, :, 1], [0, 1, -1])


# ---------------------------------------------------------------------------------------------------- real vessels


@pytest.fixture(scope="module")
def reports(shared_data):
    from ogilvie.hydro.wamit import read_wamit

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return {name: check(read_wamit(shared_data / f"mss_wamit_{name}" / name)) for name in ("tanker", "fpso", "semisub")}


def test_irregular_frequencies_of_the_fpso(reports):
    """SOURCE.md: negative damping at 1.267, 3.16, 3.65, 3.93, 5.37, 5.98 rad/s; 13, 35 and 26 violate Kramers-Kronig."""
    negative = [f.omega for f in found(reports["fpso"], "damping positive")]
    np.testing.assert_allclose(negative, [1.267, 3.157, 3.653, 3.927, 5.370, 5.984], atol=1e-3)
    causal = {f.dofs: f.value for f in found(reports["fpso"], "Kramers-Kronig")}
    assert {("surge", "heave"), ("heave", "pitch"), ("sway", "yaw")} <= set(causal)
    assert causal["surge", "heave"] == pytest.approx(0.15, abs=0.02)
    assert causal["heave", "pitch"] == pytest.approx(0.15, abs=0.02)
    assert all(dofs not in causal for dofs in (("surge",), ("sway",), ("heave",), ("pitch",), ("yaw",), ("surge", "pitch")))
    # one that damping alone does not show: heave damping and heave force contradict each other
    (haskind,) = found(reports["fpso"], "Haskind")
    assert haskind.omega == pytest.approx(1.056, abs=1e-3)
    assert haskind.dofs == ("heave",)


def test_damage_of_the_tanker(reports):
    """SOURCE.md: damaged at omega 3.65 to 5.71, smallest eigenvalue of the scaled damping matrix -0.97."""
    report = reports["tanker"]
    np.testing.assert_allclose(report.dirty_omega, [3.653, 3.927, 4.189, 4.488, 5.712], atol=1e-3)
    assert max(f.value for f in found(report, "damping positive")) == pytest.approx(0.97, abs=0.005)
    below = [f for f in report.findings if f.local and f.omega < 3.6]
    assert below == []
    (haskind,) = [c for c in report.checks if c.kind == "Haskind"]
    assert haskind.worst < 0.003


def test_semisubmersible_ends_too_early_but_is_sound(reports):
    """SOURCE.md: data end where B11 is still 37 % of its peak."""
    report = reports["semisub"]
    assert report.ok
    assert any(f.value == pytest.approx(0.37, abs=0.005) and f.dofs == ("surge",) for f in found(report, "range"))
    (haskind,) = [c for c in report.checks if c.kind == "Haskind"]
    assert haskind.worst < 0.005


@pytest.mark.parametrize("name", ["s175", "supply"])
def test_first_frequency_of_the_strip_theory_data_is_bad(shared_reference, name):
    """Added mass and damping at 0.105 rad/s are about half of what their neighbours and Kramers-Kronig imply, in every dof."""
    data = np.load(shared_reference / "radiation" / f"{name}.npz")
    hydro = hydro_from_arrays(omega=data["omega"], added_mass=data["added_mass"], radiation_damping=data["radiation_damping"])
    np.testing.assert_allclose(check(hydro).dirty_omega, [0.10472], atol=1e-4)
