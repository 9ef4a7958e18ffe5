"""Mean drift: three methods against each other, closed forms, symmetries, energy, scaling, WAMIT's far field."""

import warnings

import numpy as np
import pytest
from scipy.special import h2vp, jvp

from ogilvie.body import RigidBody
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro import drift_solver
from ogilvie.hydro.capytaine import solve_bem
from ogilvie.hydro.drift import mean_drift
from ogilvie.hydro.files import read_hydro
from ogilvie.hydro.rao import rao
from ogilvie.hydro.schema import validate
from ogilvie.mesh import shapes
from ogilvie.mesh.files import load_mesh

RHO, G = 1000.0, 9.81
UNIT = RHO * G
QUIET = {"cache": False, "progress": False, "workers": 1, "rho": RHO, "g": G}
DIRECTIONS = np.array([-np.pi / 2, -0.6, 0.0, 0.6, np.pi])
KA = np.array([0.9, 1.2, 1.6])


def afloat(hull, *, zg=-0.2, gyradii=(0.5, 0.5, 0.6)):
    return RigidBody.from_hull(hull, gyradii=gyradii, zg=zg, rho=RHO)


@pytest.fixture(scope="module")
def sphere():
    return shapes.hemisphere(1.0, panels=400)


@pytest.fixture(scope="module")
def free(sphere):
    return mean_drift(sphere, afloat(sphere), omega=np.sqrt(G * KA), wave_direction=DIRECTIONS, pairs=True, **QUIET)


@pytest.fixture(scope="module")
def fixed(sphere):
    return mean_drift(sphere, omega=np.sqrt(G * KA), wave_direction=DIRECTIONS, **QUIET)


# --- methods against each other


@pytest.mark.parametrize("case", ["free", "fixed"])
def test_three_methods_agree_on_a_sphere(case, request):
    drift = request.getfixturevalue(case)
    near, far, control = (drift[f"mean_drift_{m}"].values / UNIT for m in ("pressure", "momentum", "control_surface"))
    size = np.abs(far[..., :2]).max()
    np.testing.assert_allclose(control[..., :2], far[..., :2], atol=0.003 * size)
    np.testing.assert_allclose(near[..., :2], far[..., :2], atol=0.012 * size)
    np.testing.assert_allclose(near[..., 2], control[..., 2], atol=0.02)
    np.testing.assert_allclose(near[..., 3:5], control[..., 3:5], atol=0.006)
    for method in (near, far, control):
        assert np.abs(method[..., 5]).max() < 2e-3
    assert np.abs(drift.energy_imbalance).max() < 0.01
    assert not drift.flag_energy.any()
    assert not drift.flag_pressure.any()
    assert not drift.flag_control_surface.any()
    np.testing.assert_allclose(drift.pressure_terms.sum("pressure_term"), drift.mean_drift_pressure, rtol=1e-12, atol=1e-9)
    total = drift.control_surface_terms.sum("control_surface_term")
    np.testing.assert_allclose(total, drift.mean_drift_control_surface, rtol=1e-12, atol=1e-9)


def test_near_field_converges_in_second_order():
    error = []
    for panels in (100, 400, 900):
        drift = mean_drift(shapes.hemisphere(1.0, panels=panels), omega=[np.sqrt(1.2 * G)], wave_direction=[0.0], **QUIET)
        error.append(abs(float(drift.mean_drift_pressure[0, 0, 0]) / float(drift.mean_drift_momentum[0, 0, 0]) - 1.0))
    assert error[2] < 0.004
    assert error[0] > 3.0 * error[2]


def test_sharp_edges_spoil_the_near_field_alone():
    hull = shapes.box(10.0, 2.0, 0.6, panels=400, grading=0.7)
    w, b = np.array([1.6, 2.2, 2.8]), np.radians([90.0, 135.0, 180.0])
    drift = mean_drift(hull, afloat(hull, zg=0.0, gyradii=(0.7, 2.5, 2.5)), omega=w, wave_direction=b, **QUIET)
    near, far, control = (drift[f"mean_drift_{m}"].values for m in ("pressure", "momentum", "control_surface"))
    size = np.abs(far).max(axis=(0, 1))
    assert np.all(np.abs(control - far).max(axis=(0, 1))[[0, 1, 5]] < size[[0, 1, 5]] * [0.02, 0.01, 0.05])
    assert np.abs(near - far).max(axis=(0, 1))[0] > 0.1 * size[0]
    assert drift.flag_pressure.any()
    assert not drift.flag_control_surface.any()
    assert not drift.flag_energy.any()
    assert "control surface against far field" in drift.attrs["summary"]
    assert drift.mean_drift.attrs["method"].startswith("surge: momentum, sway: momentum, heave: control_surface")


# --- closed forms


def cylinder_drift(kR):
    """Drift of a deep vertical cylinder over rho g a^2 R, from the diffraction theory of MacCamy and Fuchs and Maruo's form."""
    m = np.arange(int(2 * kR) + 25)
    c = jvp(m, kR) / h2vp(m, kR) * np.where(m == 0, 1.0, 2.0)
    theta = 2.0 * np.pi * np.arange(800) / 800
    A = -np.sqrt(2.0 / (np.pi * kR)) * np.exp(0.25j * np.pi) * (c @ np.cos(np.outer(m, theta)))
    return 0.25 * np.sum(np.abs(A) ** 2 * (1.0 - np.cos(theta))) * 2.0 * np.pi / 800


def test_closed_form_tends_to_total_reflection():
    assert cylinder_drift(60.0) == pytest.approx(2.0 / 3.0, abs=0.01)


def test_deep_cylinder_agrees_with_diffraction_theory():
    hull = shapes.cylinder(1.0, 3.0, panels=1600)
    kR = np.array([1.0, 2.0, 3.0])
    drift = mean_drift(hull, omega=np.sqrt(G * kR), wave_direction=[0.0], **QUIET)
    exact = [cylinder_drift(x) for x in kR]
    np.testing.assert_allclose(drift.mean_drift_momentum[:, 0, 0] / UNIT, exact, rtol=0.012)
    np.testing.assert_allclose(drift.mean_drift_control_surface[:, 0, 0] / UNIT, exact, rtol=0.01)
    np.testing.assert_allclose(drift.mean_drift_pressure[:, 0, 0] / UNIT, exact, rtol=0.01)


def test_methods_agree_in_shallow_water(sphere):
    drift = mean_drift(sphere, afloat(sphere), omega=[2.2, 3.0], wave_direction=[0.3], water_depth=1.6, **QUIET)
    near, far, control = (drift[f"mean_drift_{m}"].values / UNIT for m in ("pressure", "momentum", "control_surface"))
    size = np.abs(far[..., :2]).max()
    np.testing.assert_allclose(control[..., :2], far[..., :2], atol=0.01 * size)
    np.testing.assert_allclose(near[..., :2], far[..., :2], atol=0.03 * size)
    np.testing.assert_allclose(near[..., 2], control[..., 2], atol=0.04 * np.abs(control[..., 2]).max())


def test_methods_agree_on_a_submerged_sphere():
    quarter = shapes.hemisphere(1.0, panels=300).with_symmetry("xz+yz")
    lower, n = quarter.vertices, len(quarter.vertices)
    vertices = np.concatenate([lower, lower * [1.0, 1.0, -1.0]]) - [0.0, 0.0, 1.4]
    ball = type(quarter)(vertices, np.concatenate([quarter.faces, quarter.faces[:, ::-1] + n]), symmetry="xz+yz")
    drift = mean_drift(ball, omega=np.sqrt(G * np.array([0.5, 1.0])), wave_direction=[0.4], **QUIET)
    near, far, control = (drift[f"mean_drift_{m}"].values / UNIT for m in ("pressure", "momentum", "control_surface"))
    size = np.abs(near).max()
    np.testing.assert_allclose(near[..., 2:5], control[..., 2:5], atol=0.02 * size)
    np.testing.assert_allclose(near[..., :2], far[..., :2], atol=0.01 * size)
    np.testing.assert_allclose(control[..., :2], far[..., :2], atol=0.01 * size)
    assert np.all(near[..., 2] > 0.01)  # sucked to the surface
    assert "heave: control_surface" in drift.mean_drift.attrs["method"]


def test_pressure_on_a_sphere_has_no_moment_about_its_centre(free, sphere):
    rolling = afloat(sphere, zg=-0.3)
    drift = mean_drift(sphere, rolling, omega=[np.sqrt(1.1 * G)], wave_direction=[0.4], moments="body", method="near", **QUIET)
    assert np.abs(drift.mean_drift[..., 3:]).max() < 0.01 * UNIT
    assert np.abs(drift.mean_drift_pressure[..., 3:]).max() > 0.1 * UNIT
    np.testing.assert_allclose(drift.mean_drift, drift.mean_drift_pressure_body)
    np.testing.assert_allclose(free.mean_drift_pressure_body[..., 3:] / UNIT, 0.0, atol=0.01)


def test_long_waves_lift_a_free_body_no_more_than_the_water_does():
    hull = shapes.hemisphere(1.0, panels=400)
    drift = mean_drift(hull, afloat(hull), omega=[np.sqrt(0.05 * G)], wave_direction=[0.0], **QUIET)
    assert abs(float(drift.mean_drift[0, 0, 0])) < 1e-3 * UNIT
    assert abs(complex(drift.motion_rao[0, 0, 2]) - 1.0) < 0.1


# --- symmetries


def test_axisymmetric_body_is_pushed_along_the_waves(free):
    far = free.mean_drift_momentum.values
    along = far[:, 2, 0]
    np.testing.assert_allclose(far[..., 0], along[:, None] * np.cos(DIRECTIONS), atol=1e-3 * along.max())
    np.testing.assert_allclose(far[..., 1], along[:, None] * np.sin(DIRECTIONS), atol=1e-3 * along.max())
    heave = free.mean_drift.values[..., 2]
    np.testing.assert_allclose(heave, heave[:, 2:3] + 0.0 * heave, atol=2e-3 * UNIT)


def test_mirrored_directions_give_mirrored_forces(free):
    signs = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    for name in ("mean_drift", "mean_drift_pressure", "mean_drift_control_surface"):
        values = free[name].values
        np.testing.assert_allclose(values[:, 1], values[:, 3] * signs, atol=1e-9 * UNIT)


def test_half_and_whole_hull_agree():
    quarter = shapes.box(3.0, 1.0, 0.5, panels=100)
    results = [
        mean_drift(hull, afloat(hull, zg=0.0), omega=[3.0], wave_direction=[0.7], irregular_frequencies="keep", **QUIET)
        for hull in (quarter, quarter.with_symmetry("xz"), quarter.with_symmetry("none"))
    ]
    for name in ("mean_drift_pressure", "mean_drift_momentum"):
        for other in results[1:]:
            np.testing.assert_allclose(other[name], results[0][name], rtol=1e-5, atol=1e-6 * UNIT)
    for other in results[1:]:
        np.testing.assert_allclose(other.mean_drift, results[0].mean_drift, atol=2e-3 * UNIT)


def test_two_directions_at_once_are_a_hermitian_form(free):
    n = len(DIRECTIONS)
    Q = free.mean_drift_pairs.values.reshape(len(KA), n, n, 6)
    np.testing.assert_allclose(Q, Q.conj().transpose(0, 2, 1, 3), atol=1e-12 * UNIT)
    np.testing.assert_allclose(np.einsum("wbbi->wbi", Q).real, free.mean_drift)
    np.testing.assert_allclose(free.drift_direction_1.values.reshape(n, n)[:, 0], DIRECTIONS)
    assert np.abs(Q[:, 2, 4]).max() > 0.1 * UNIT  # head and following waves together


def test_pairs_agree_between_the_methods(sphere):
    keys = {"omega": [np.sqrt(1.2 * G)], "wave_direction": [0.0, 0.8, 2.5], "pairs": True, **QUIET}
    body = afloat(sphere)
    near, far, control = (
        mean_drift(sphere, body, method=m, **keys).mean_drift_pairs for m in ("near", "far", "control_surface")
    )
    np.testing.assert_allclose(control[..., [0, 1]] / UNIT, far[..., [0, 1]] / UNIT, atol=0.006)
    np.testing.assert_allclose(near[..., [0, 1]] / UNIT, far[..., [0, 1]] / UNIT, atol=0.02)
    np.testing.assert_allclose(near[..., 2] / UNIT, control[..., 2] / UNIT, atol=0.03)
    assert np.isnan(far[..., 2:5]).all()


def test_pairs_of_far_field_and_control_surface_agree_on_a_box():
    hull = shapes.box(10.0, 2.0, 0.6, panels=300, grading=0.7)
    keys = {"omega": [2.8], "wave_direction": np.radians([20.0, 100.0, 135.0]), "pairs": True, **QUIET}
    body = afloat(hull, zg=0.0, gyradii=(0.7, 2.5, 2.5))
    far, control = (mean_drift(hull, body, method=m, **keys).mean_drift_pairs.values for m in ("far", "control_surface"))
    for dof, part in ((0, 0.015), (1, 0.015), (5, 0.04)):  # imaginary parts are as large as real ones
        assert np.abs(far[..., dof] - control[..., dof]).max() < part * np.abs(far[..., dof]).max()
        assert np.abs(far[..., dof].imag).max() > 0.03 * np.abs(far[..., dof]).max()


def test_order_of_rotations_changes_vertical_components_alone():
    hull = shapes.box(3.0, 1.0, 0.5, panels=100)
    keys = {"omega": [2.5], "wave_direction": [2.2], "method": "near", **QUIET}
    with pytest.warns(OgilvieWarning, match="near field"):  # sharp edges
        one, two = (mean_drift(hull, afloat(hull, zg=0.1), rotation=r, **keys).mean_drift.values[0, 0] for r in ("ZYX", "XYZ"))
    np.testing.assert_allclose(one[[0, 1, 5]], two[[0, 1, 5]], rtol=1e-9)
    assert np.abs(one - two)[3:5].max() > 1.0


# --- energy, scaling, first order


def test_external_damping_is_part_of_the_energy_balance(sphere):
    damping = np.diag([0.0, 0.0, 2000.0, 0.0, 300.0, 0.0])
    drift = mean_drift(sphere, afloat(sphere), omega=np.sqrt(G * KA), wave_direction=[0.0], damping=damping, **QUIET)
    assert np.abs(drift.energy_imbalance).max() < 0.01
    far, control = drift.mean_drift_momentum.values[:, 0, 0], drift.mean_drift_control_surface.values[:, 0, 0]
    np.testing.assert_allclose(control, far, rtol=0.01)


def test_irregular_frequency_is_removed_by_the_lid():
    hull, body = shapes.hemisphere(1.0, panels=256), None
    keys = {"omega": [np.sqrt(2.56 * G)], "wave_direction": [0.0], "method": "far", **QUIET}
    smooth = [
        float(mean_drift(hull, body, **{**keys, "omega": [np.sqrt(x * G)]}).mean_drift[0, 0, 0]) for x in (2.4, 2.56, 2.72)
    ]
    assert smooth[1] == pytest.approx(0.5 * (smooth[0] + smooth[2]), rel=0.01)
    with_lid = mean_drift(hull, afloat(hull), **keys)
    assert abs(float(with_lid.energy_imbalance[0, 0])) < 0.01


def test_froude_scaling():
    hulls = [shapes.hemisphere(s, panels=100) for s in (1.0, 2.0)]
    bodies = [
        afloat(hull, zg=-0.2 * s, gyradii=s * np.array([0.5, 0.5, 0.6])) for hull, s in zip(hulls, (1.0, 2.0), strict=True)
    ]
    one, two = (
        mean_drift(hull, body, omega=[3.5 / np.sqrt(s)], wave_direction=[0.5], **QUIET).mean_drift.values[0, 0]
        for hull, body, s in zip(hulls, bodies, (1.0, 2.0), strict=True)
    )
    np.testing.assert_allclose(two, one * [2, 2, 2, 4, 4, 4], rtol=2e-4, atol=1e-4 * UNIT)


def test_motions_are_those_of_the_coefficients(sphere, free):
    body = afloat(sphere)
    hydro = solve_bem(sphere, body, omega=free.omega.values, wave_direction=DIRECTIONS, **QUIET)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)
        expected = rao(hydro).values
    np.testing.assert_allclose(free.motion_rao, expected, atol=0.025 * np.abs(expected).max(axis=(0, 1)).max())


def test_result_enters_a_data_set(sphere, free):
    hydro = solve_bem(sphere, afloat(sphere), omega=free.omega.values, wave_direction=DIRECTIONS, **QUIET)
    whole = validate(hydro.assign({key: free[key] for key in free if str(key).startswith("mean_drift")}))
    assert whole.mean_drift.shape == (3, 5, 6)


def test_far_field_on_wamits_mesh_is_wamits(shared_data):
    wamit = read_hydro(shared_data / "wecsim_sphere_drift/sphere.1")
    hull = load_mesh(shared_data / "wecsim_sphere_drift/sphere.GDF")
    M = wamit.inertia_matrix.values
    pick = [i for i, w in enumerate(wamit.omega.values) if 2.8 < w < 4.3][::5]
    drift = mean_drift(
        hull,
        RigidBody(M[0, 0], [0.0, 0.0, 0.0], np.diag(M)[3:]),
        omega=wamit.omega.values[pick],
        wave_direction=[0.0],
        **{**QUIET, "rho": wamit.attrs["rho"], "g": wamit.attrs["g"]},
    )
    theirs = wamit.mean_drift_momentum.values[pick, 0, 0]
    scale = np.abs(theirs).max()
    for name in ("momentum", "control_surface", "pressure"):
        np.testing.assert_allclose(drift[f"mean_drift_{name}"][:, 0, 0], theirs, atol=0.01 * scale)
    pressure = wamit.mean_drift_pressure.values[pick, 0, 0]
    assert np.abs(pressure - theirs).max() > 0.3 * scale  # their own pressure integration with potentials at panel centres


@pytest.mark.slow
def test_fpso_in_beam_and_head_seas(shared_data):
    wamit = read_hydro(shared_data / "mss_wamit_fpso/fpso.1")
    hull = load_mesh(shared_data / "mss_wamit_fpso/fpso_low.gdf")
    M = wamit.inertia_matrix.values
    m, cog = M[0, 0], np.array([-M[2, 4], M[2, 3], M[0, 4]]) / M[0, 0]
    S = np.array([[0.0, -cog[2], cog[1]], [cog[2], 0.0, -cog[0]], [-cog[1], cog[0], 0.0]])
    i = int(np.abs(2.0 * np.pi / wamit.omega.values - 10.44).argmin())
    j = [0, 9, 18]
    drift = mean_drift(
        hull,
        RigidBody(m, cog, M[3:, 3:] - m * S.T @ S),
        omega=wamit.omega.values[[i]],
        wave_direction=wamit.wave_direction.values[j],
        rotation="XYZ",
        method="far",
        **{**QUIET, "rho": wamit.attrs["rho"], "g": wamit.attrs["g"]},
    )
    near, far = drift.mean_drift_pressure.values[0], drift.mean_drift.values[0]
    assert abs(drift.energy_imbalance).max() < 0.015
    theirs = wamit.mean_drift_pressure.values[i, j]  # sharp edges: theirs and our near field err to the same side
    assert far[1, 1] < near[1, 1] < theirs[1, 1] < 1.8 * far[1, 1]
    shift = (drift.mean_drift_pressure - drift.mean_drift_pressure_body).values[0, :, 3:]  # <T x F1>
    expected = (wamit.mean_drift_pressure - wamit.mean_drift_pressure_body).values[i, j, 3:]
    np.testing.assert_allclose(shift, expected, atol=0.03 * np.abs(expected).max())
    motion, X = drift.motion_rao.values[0], wamit.motion_rao.values[i, j]
    np.testing.assert_allclose(motion[:, :3], X[:, :3], atol=0.02 * np.abs(X[:, :3]).max())


# --- cache and refusals


def test_cache_gives_the_same_numbers_and_solves_new_directions_only(tmp_path, monkeypatch):
    hull = shapes.hemisphere(1.0, panels=240)
    body = afloat(hull)
    monkeypatch.setattr("ogilvie.hydro.drift_store.cache_folder", lambda: tmp_path)
    keys = {**QUIET, "omega": [3.0], "cache": True}
    first = mean_drift(hull, body, wave_direction=[0.0, 1.0], **keys)
    plain = mean_drift(hull, body, wave_direction=[0.5], **{**keys, "cache": False})
    solved = []
    real = drift_solver.solve_sources
    monkeypatch.setattr(
        drift_solver,
        "solve_sources",
        lambda *a, directions, **k: solved.append(list(directions)) or real(*a, directions=directions, **k),
    )
    again = mean_drift(hull, body, wave_direction=[0.0, 1.0], **keys)
    assert solved == []
    more = mean_drift(hull, body, wave_direction=[0.0, 0.5, 1.0], **keys)
    assert solved == [[0.5]]
    for name in ("mean_drift", "mean_drift_pressure", "motion_rao"):
        np.testing.assert_array_equal(first[name], again[name])
        np.testing.assert_allclose(more[name][:, [0, 2]], first[name], rtol=1e-9, atol=1e-6)
        np.testing.assert_allclose(more[name][:, 1], plain[name][:, 0], rtol=1e-9, atol=1e-6)


def test_several_waterlines_leave_vertical_components_to_the_near_field():
    column = shapes.cylinder(0.4, 0.6, panels=20).with_symmetry("none")
    twin = type(column)(
        np.concatenate([column.vertices + [1.5, 0, 0], column.vertices - [1.5, 0, 0]]),
        np.concatenate([column.faces, column.faces + len(column.vertices)]),
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)
        drift = mean_drift(twin, omega=[3.0], wave_direction=[0.0], **QUIET)
    assert "heave: pressure" in drift.mean_drift.attrs["method"]
    assert np.all(np.isfinite(drift.mean_drift))
    far, control = float(drift.mean_drift_momentum[0, 0, 0]), float(drift.mean_drift_control_surface[0, 0, 0])
    assert control == pytest.approx(far, rel=0.03)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"speed": np.inf}, "mean_drift: speed: a finite number"),
        ({"speed": 600.0}, r"mean_drift: speed: up to 4\.\d+ m/s \(Froude number 1\) expected, 600 m/s found"),
        ({"method": "magic"}, "method: one of auto"),
        ({"rotation": "YXZ"}, "rotation"),
        ({"moments": "ship"}, "moments"),
        ({"waterline": "panel"}, "waterline"),
        ({"damping": np.eye(3)}, "damping"),
        ({"damping": np.eye(6)}, "body expected"),
        ({"omega": [-1.0]}, "mean_drift: omega"),
        ({"workers": 0}, "workers"),
        ({"water_depth": 0.5}, "mean_drift: water_depth"),
    ],
)
def test_what_cannot_be_done_is_refused(change, words):
    keys = {"omega": [3.0], "wave_direction": [0.0], **QUIET, **change}
    with pytest.raises(InputError, match=words):
        mean_drift(shapes.hemisphere(1.0, panels=60), **keys)


def test_body_that_does_not_float_is_named():
    hull = shapes.hemisphere(1.0, panels=240)
    heavy = RigidBody(1.1 * RHO * hull.volume, [0.0, 0.0, -0.2], [500.0, 500.0, 600.0])
    with pytest.warns(OgilvieWarning, match="floats at rest"):
        mean_drift(hull, heavy, omega=[3.0], wave_direction=[0.0], method="far", **QUIET)
