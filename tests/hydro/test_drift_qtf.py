"""Forces at the difference of two frequencies: closed forms, two methods against each other, limits, symmetries, refusals."""

import warnings

import numpy as np
import pytest
from scipy.special import h2vp

from ogilvie.body import RigidBody
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro import drift_solver
from ogilvie.hydro.capytaine import solve_bem
from ogilvie.hydro.drift import mean_drift
from ogilvie.hydro.drift_qtf import difference_qtf
from ogilvie.hydro.drift_second import bound_wave, wavenumbers
from ogilvie.hydro.files import read_hydro
from ogilvie.hydro.qtf import mirrored, symmetry_defect, with_qtf
from ogilvie.hydro.wamit_write import write_wamit
from ogilvie.loads.slow_drift import SlowDrift
from ogilvie.mesh import shapes
from ogilvie.waves.dispersion import wavenumber

RHO, G = 1000.0, 9.81
UNIT = RHO * G
QUIET = {"cache": False, "progress": False, "workers": 1, "rho": RHO, "g": G}
OMEGA = np.sqrt(G * np.array([0.7, 0.9, 1.2, 1.6]))
DIRECTIONS = np.array([-0.6, 0.0, 0.6, np.pi])
HORIZONTAL = [0, 1, 5]


def afloat(hull, *, zg=-0.2, gyradii=(0.5, 0.5, 0.6)):
    return RigidBody.from_hull(hull, gyradii=gyradii, zg=zg, rho=RHO)


@pytest.fixture(scope="module")
def sphere():
    return shapes.hemisphere(1.0, panels=400)


@pytest.fixture(scope="module")
def near(sphere):
    return difference_qtf(sphere, afloat(sphere), omega=OMEGA, wave_direction=DIRECTIONS, method="near", **QUIET)


@pytest.fixture(scope="module")
def control(sphere):
    return difference_qtf(sphere, afloat(sphere), omega=OMEGA, wave_direction=DIRECTIONS, pairs=True, **QUIET)


# --- closed forms


def cylinder(kR):
    """Surge over rho g a^2 R of a deep fixed cylinder, from the diffraction theory of MacCamy and Fuchs, waves along +x.

    On the wall eta = sum of e_m (-i)^m (-2i/(pi kR))/H_m'(kR) cos(m theta), phi = (i g/omega) eta exp(kz); the force is
    -rho g/2 <eta^2> n over the waterline and rho/2 <|grad phi|^2> n over the wall, exp((k_1 + k_2) z) integrated.
    """
    theta = 2.0 * np.pi * np.arange(256) / 256
    m = np.arange(int(2 * max(kR)) + 25)
    eta, slope = np.empty((2, len(kR), 256), dtype=complex)
    for i, k in enumerate(kR):
        c = np.where(m == 0, 1.0, 2.0) * (-1j) ** m * (-2j / (np.pi * k)) / h2vp(m, k)
        eta[i], slope[i] = c @ np.cos(np.outer(m, theta)), -(c * m) @ np.sin(np.outer(m, theta))
    push = np.cos(theta) * 2.0 * np.pi / 256
    levels, slopes = (np.einsum("it,jt,t->ij", f, f.conj(), push) for f in (eta, slope))
    k1, k2 = np.meshgrid(kR, kR, indexing="ij")
    return -0.25 * levels + 0.25 / np.sqrt(k1 * k2) * (slopes + k1 * k2 * levels) / (k1 + k2)


@pytest.mark.parametrize("method", ["near", "control_surface"])
def test_deep_cylinder_agrees_with_diffraction_theory(method):
    kR = np.array([0.8, 1.0, 1.4, 2.0])
    Q = difference_qtf(
        shapes.cylinder(1.0, 3.0, panels=800), omega=np.sqrt(G * kR), wave_direction=[0.0], method=method, **QUIET
    )
    exact = cylinder(kR)
    assert abs(exact[0, 3].imag) > 0.3  # far from real: Newman's rules have no such part
    np.testing.assert_allclose(Q.qtf_diff[..., 0, 0] / UNIT, exact, atol=0.012 * np.abs(exact).max())


def test_equal_frequencies_give_the_mean_drift(sphere, near, control):
    drift = mean_drift(sphere, afloat(sphere), omega=OMEGA, wave_direction=DIRECTIONS, pairs=True, **QUIET)
    diagonal = np.einsum("wwbi->wbi", near.qtf_diff.values)
    np.testing.assert_allclose(diagonal, drift.mean_drift_pressure, atol=1e-12 * UNIT)
    np.testing.assert_allclose(
        np.einsum("wwbi->wbi", control.qtf_diff.values), drift.mean_drift_control_surface, atol=5e-5 * UNIT
    )
    np.testing.assert_allclose(near.mean_drift_momentum, drift.mean_drift_momentum, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(near.motion_rao, drift.motion_rao)
    pairs = mean_drift(
        sphere, afloat(sphere), omega=OMEGA, wave_direction=DIRECTIONS, pairs=True, method="control_surface", **QUIET
    ).mean_drift_pairs
    np.testing.assert_allclose(np.einsum("wwpi->wpi", control.qtf_diff_pairs.values), pairs, atol=5e-5 * UNIT)


def test_moments_about_the_moving_origin_on_the_diagonal(sphere):
    keys = {"omega": OMEGA[:2], "wave_direction": [0.6], "method": "near", **QUIET}
    Q = difference_qtf(sphere, afloat(sphere), moments="body", **keys).qtf_diff.values
    drift = mean_drift(sphere, afloat(sphere), moments="body", **keys).mean_drift
    np.testing.assert_allclose(np.einsum("wwbi->wbi", Q), drift, atol=1e-12 * UNIT)
    np.testing.assert_allclose(Q[..., 3:] / UNIT, 0.0, atol=0.01)  # pressure on a sphere has no moment about its centre


# --- methods against each other


def test_control_surface_and_near_field_agree_on_a_sphere(near, control):
    one, two = near.qtf_diff.values / UNIT, control.qtf_diff.values / UNIT
    assert "heave: control_surface" in control.qtf_diff.attrs["method"]
    size = np.abs(one).max(axis=(0, 1, 2))
    for dof, part in ((0, 0.006), (1, 0.009), (2, 0.025), (3, 0.01), (4, 0.01)):
        np.testing.assert_allclose(two[..., dof], one[..., dof], atol=part * size[dof])
        assert np.abs(one[0, 3, :, dof].imag).max() > 2.0 * part * size[dof]


def test_methods_agree_in_shallow_water(sphere):
    keys = {"omega": OMEGA[[0, 2]], "wave_direction": [0.3], "water_depth": 1.6, **QUIET}
    one, two = (
        difference_qtf(sphere, afloat(sphere), method=m, **keys).qtf_diff.values[..., 0, :] / UNIT for m in ("near", "auto")
    )
    size = np.abs(two).max(axis=(0, 1))
    assert np.all((np.abs(one - two).max(axis=(0, 1)) / size)[:5] < [0.01, 0.01, 0.04, 0.02, 0.02])


def test_sharp_edges_need_the_control_surface():
    hull = shapes.box(10.0, 2.0, 0.6, panels=300, grading=0.7)
    keys = {"omega": [1.6, 2.2, 2.8], "wave_direction": np.radians([135.0]), **QUIET}
    body = afloat(hull, zg=0.0, gyradii=(0.7, 2.5, 2.5))
    with pytest.warns(OgilvieWarning, match="diagonal that is the drift of the far field"):
        rough = difference_qtf(hull, body, method="near", **keys).qtf_diff.values[..., 0, :]
    fine = difference_qtf(hull, body, **keys)
    Q, far = fine.qtf_diff.values[..., 0, :], fine.mean_drift_momentum.values[:, 0]
    size = np.abs(far).max(axis=0)
    diagonal = np.einsum("wwi->wi", Q).real
    assert np.all((np.abs(diagonal - far) / size)[:, HORIZONTAL] < [0.02, 0.01, 0.05])
    assert np.abs(rough - Q)[..., 0].max() > 0.1 * size[0]


# --- limits


def test_near_the_diagonal_newman_holds_in_second_order(sphere):
    d = 0.2
    w = 4.2 + d * np.array([-1.0, -0.5, 0.0, 0.5, 1.0])
    Q = (
        difference_qtf(sphere, afloat(sphere), omega=w, wave_direction=[0.0], method="near", **QUIET).qtf_diff.values[..., 0, 0]
        / UNIT
    )
    off = [Q[i, j] - 0.5 * (Q[i, i] + Q[j, j]) for i, j in ((0, 4), (1, 3))]
    assert off[0].real / off[1].real == pytest.approx(4.0, rel=0.05)
    assert off[0].imag / off[1].imag == pytest.approx(2.0, rel=0.05)
    assert abs(off[0].imag) > 1e-3


def test_set_down_of_groups_is_that_of_radiation_stress():
    """Longuet-Higgins and Stewart (1962): eta = -S/(rho (g h - c_g^2)), S = E (2n - 1/2), E = rho g a^2/2."""
    w, h = np.array([0.8, 0.8 + 1e-5]), 12.0
    k = wavenumber(w, h, g=G)
    K = w[0] ** 2 / G
    C = bound_wave(w, k, depth=h, g=G)[1, 0]
    level = -1j * (w[1] - w[0]) * C / G - (k[0] ** 2 - K**2) / (4.0 * K)  # -(phi_2t + |grad phi|^2/2 + eta phi_tz)/g
    n = 0.5 * (1.0 + 2.0 * k[0] * h / np.sinh(2.0 * k[0] * h))
    assert level.real == pytest.approx(-0.5 * G * (2.0 * n - 0.5) / (G * h - (n * w[0] / k[0]) ** 2), rel=1e-4)
    assert abs(level.imag) < 1e-12


@pytest.mark.parametrize("depth", [np.inf, 4.0])
def test_pinkster_adds_a_scaled_first_order_force(depth):
    hull = shapes.hemisphere(1.0, panels=200)
    w = np.array([3.0, 3.6])
    keys = {"omega": w, "wave_direction": [0.6], "water_depth": depth, "method": "near", **QUIET}
    added = (difference_qtf(hull, second_order="pinkster", **keys) - difference_qtf(hull, **keys)).qtf_diff.values[..., 0, :]
    k = wavenumber(w, depth, g=G)
    kappa = k[1] - k[0]
    long = np.sqrt(G * kappa * (1.0 if np.isinf(depth) else np.tanh(kappa * depth)))
    X = solve_bem(hull, omega=[long], wave_direction=[0.6], water_depth=depth, **QUIET).excitation_force.values[0, 0]
    scale = -1j * (w[1] - w[0]) * bound_wave(w, k, depth=depth, g=G)[1, 0] / G
    np.testing.assert_allclose(added[1, 0], scale * X, atol=0.02 * np.abs(scale * X).max())
    np.testing.assert_allclose(added[0, 1], added[1, 0].conj(), atol=1e-9)
    np.testing.assert_allclose(np.einsum("wwi->wi", added), 0.0, atol=1e-9)
    assert scale.real < 0.0  # the water is lower where waves are higher


def test_pinkster_tends_to_nothing_in_deep_water(sphere):
    w = 3.0 + np.array([0.0, 0.05, 0.1])
    keys = {"omega": w, "wave_direction": [0.0], "method": "near", **QUIET}
    added = (difference_qtf(sphere, second_order="pinkster", **keys) - difference_qtf(sphere, **keys)).qtf_diff.values[
        ..., 0, :
    ]
    assert abs(added[2, 0, 2] / added[1, 0, 2]) == pytest.approx(2.0, rel=0.1)
    assert abs(added[2, 0, 0] / added[1, 0, 0]) == pytest.approx(4.0, rel=0.15)  # surge: pressure times its slope


def test_wavenumbers_of_the_long_waves():
    k = wavenumbers(np.array([0.1, 0.3, 0.7]), length=10.0, depth=np.inf, least=0.01)
    assert k[-1] == pytest.approx(0.6)
    assert len(k) == 10
    assert np.all(wavenumbers(np.array([0.1, 0.7]), length=10.0, depth=0.3, least=0.01) >= 0.03)


# --- symmetries


def test_hermitian_in_both_frequencies_and_directions(near, control):
    for Q in (near.qtf_diff.values, control.qtf_diff.values):
        np.testing.assert_allclose(Q, Q.conj().swapaxes(0, 1), atol=1e-11 * UNIT)
    assert symmetry_defect(control.qtf_diff_pairs.values, mirrored(control, "qtf_diff_pairs")) < 1e-10
    n = len(DIRECTIONS)
    same = control.qtf_diff_pairs.values[:, :, [b * n + b for b in range(n)]]
    np.testing.assert_allclose(same, control.qtf_diff, atol=1e-11 * UNIT)


def test_mirrored_directions_and_axial_symmetry(near):
    Q = near.qtf_diff.values
    signs = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    np.testing.assert_allclose(Q[:, :, 0], Q[:, :, 2] * signs, atol=1e-9 * UNIT)
    along, size = Q[:, :, 1, 0], np.abs(Q).max()
    np.testing.assert_allclose(Q[:, :, 3, 0], -along, atol=1e-9 * UNIT)
    np.testing.assert_allclose(Q[:, :, 2, 0], along * np.cos(0.6), atol=3e-3 * size)
    np.testing.assert_allclose(Q[:, :, 2, 1], along * np.sin(0.6), atol=3e-3 * size)


@pytest.mark.parametrize("method", ["near", "control_surface"])
def test_body_elsewhere_meets_the_groups_later(method):
    """At (x, y) the force has the phase of the group there, and a yaw moment about O beside its own."""
    hull = shapes.box(2.0, 1.0, 0.5, panels=100).with_symmetry("none")
    w, beta, d = np.array([2.5, 3.0, 3.5]), 2.2, np.array([0.5, 0.2, 0.0])
    keys = {"omega": w, "wave_direction": [beta], "method": method, **QUIET}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)  # sharp edges
        one = afloat(hull, zg=0.0)
        there = RigidBody(one.mass, one.cog + d, one.inertia)
        here, moved = difference_qtf(hull, one, **keys), difference_qtf(hull.translated(d), there, **keys)
    k = w**2 / G
    late = np.exp(-1j * (k[:, None] - k[None]) * (d[0] * np.cos(beta) + d[1] * np.sin(beta)))[..., None]
    expected = here.qtf_diff.values[..., 0, :] * late
    expected[..., 5] += d[0] * expected[..., 1] - d[1] * expected[..., 0]
    found, size = moved.qtf_diff.values[..., 0, :], np.abs(expected).max(axis=(0, 1))
    limit = 1e-6 if method == "near" else [0.02, 0.01, 0.06]
    assert np.all((np.abs(found - expected) / size).max(axis=(0, 1))[HORIZONTAL] < limit)


# --- into loads and files


def test_slow_drift_takes_the_result_as_it_is(near, control):
    force = SlowDrift(near, approximation="full")
    np.testing.assert_allclose(
        force.qtf([OMEGA[1]], [OMEGA[3]], 0.6)[0], near.qtf_diff.values[1, 3, 2], atol=1e-6 * np.abs(near.qtf_diff).max()
    )
    pair = SlowDrift(control, approximation="full").qtf([OMEGA[1]], [OMEGA[3]], 0.0, 0.6)[0]
    known = control.qtf_diff_pairs.values[1, 3, 1 * len(DIRECTIONS) + 2]
    np.testing.assert_allclose(pair, known, atol=1e-6 * np.abs(control.qtf_diff_pairs).max())


def test_result_goes_into_a_data_set_and_a_file(tmp_path, sphere, near):
    hydro = solve_bem(sphere, afloat(sphere), omega=OMEGA, wave_direction=DIRECTIONS, **QUIET)
    whole = with_qtf(hydro, omega=near.omega_1, qtf_diff=near.qtf_diff)
    write_wamit(whole, tmp_path / "sphere")
    back = read_hydro(next(tmp_path.rglob("sphere.1")))
    size = np.abs(near.qtf_diff).max()
    for b in DIRECTIONS:
        i = int(np.abs(np.exp(1j * back.wave_direction.values) - np.exp(1j * b)).argmin())
        np.testing.assert_allclose(back.qtf_diff[:, :, i], near.qtf_diff.sel(wave_direction=b), atol=1e-5 * size)


def test_fields_of_the_mean_drift_are_used_again(tmp_path, monkeypatch):
    hull = shapes.hemisphere(1.0, panels=240)
    monkeypatch.setattr("ogilvie.hydro.drift_store.cache_folder", lambda: tmp_path)
    keys = {**QUIET, "omega": [3.0, 3.4], "wave_direction": [0.0], "cache": True}
    mean_drift(hull, afloat(hull), method="near", **keys)
    monkeypatch.setattr(drift_solver, "solve_sources", lambda *a, **k: pytest.fail("solved again"))
    first = difference_qtf(hull, afloat(hull), **keys)
    monkeypatch.setattr(drift_solver, "fields_at", lambda *a, **k: pytest.fail("evaluated again"))
    np.testing.assert_array_equal(difference_qtf(hull, afloat(hull), **keys).qtf_diff, first.qtf_diff)


# --- refusals


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"omega": [3.0]}, "two frequencies or more"),
        ({"omega": [-1.0, 2.0]}, "difference_qtf: omega"),
        ({"method": "far"}, "difference_qtf: method: one of auto"),
        ({"second_order": "full"}, "second_order: one of none"),
        ({"second_order": "pinkster", "pairs": True}, "waves of one direction"),
        ({"rotation": "YXZ"}, "rotation"),
        ({"moments": "ship"}, "moments"),
        ({"damping": np.eye(6)}, "difference_qtf: damping and stiffness"),
        ({"workers": 0}, "difference_qtf: workers"),
        ({"water_depth": 0.5}, "difference_qtf: water_depth"),
    ],
)
def test_what_cannot_be_done_is_refused(change, words):
    keys = {"omega": [3.0, 3.3], "wave_direction": [0.0], **QUIET, **change}
    with pytest.raises(InputError, match=words):
        difference_qtf(shapes.hemisphere(1.0, panels=60), **keys)
