"""Mean drift at forward speed: identities, limits, symmetry, wave resistance of a source, first order, errors."""

import warnings
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import quad

from ogilvie.body import RigidBody
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro import drift_maruo
from ogilvie.hydro.bem_panels import HullPanels
from ogilvie.hydro.capytaine import solve_bem
from ogilvie.hydro.drift import mean_drift
from ogilvie.hydro.drift_encounter import placed_pairs, waves_met
from ogilvie.hydro.drift_far import amplitude
from ogilvie.hydro.drift_inputs import checked_case, checked_dynamics
from ogilvie.hydro.drift_panels import WholeHull
from ogilvie.hydro.drift_solver import Solver
from ogilvie.hydro.rao import rao
from ogilvie.mesh import shapes

RHO, G = 1000.0, 9.81
QUIET = {"rho": RHO, "g": G, "progress": False, "cache": False, "workers": 1}
METHODS = ("pressure", "control_surface", "momentum")
DIRECTIONS = np.radians([35.0, 150.0, 180.0])


def drift(hull, body, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)
        return mean_drift(hull, body, **{**QUIET, **options})


def a_case(hull, omega, direction, speed=0.0):
    water = {"rho": RHO, "g": G, "depth": np.inf}
    return checked_case(hull, "remove", purpose="t", omega=omega, direction=direction, speed=speed, **water)


@pytest.fixture(scope="module")
def ship():
    """A Wigley hull of 3 m and its body."""
    hull = shapes.wigley(3.0, kind="IV", panels=400)
    return hull, RigidBody.from_gyradii(RHO * hull.volume, cog=[0.0, 0.0, -0.02], gyradii=[0.2, 0.75, 0.75])


@pytest.fixture(scope="module")
def ball():
    """A hemisphere, afloat."""
    hull = shapes.hemisphere(1.0, panels=400)
    return hull, RigidBody.from_hull(hull, gyradii=(0.5, 0.5, 0.6), zg=-0.3, rho=RHO)


@pytest.fixture(scope="module")
def sailing(ship):
    return drift(*ship, omega=[4.0, 4.8], wave_direction=DIRECTIONS, speed=1.1)


# --- identities and limits


def test_pressure_on_the_hull_and_flow_through_a_surface_are_one_force(ball):
    """Gauss and Stokes turn one into the other for any speed: all six components, moments with U x momentum among them."""
    found = drift(*ball, omega=np.sqrt(G * np.array([0.9, 1.4])), wave_direction=[0.6, 2.2], speed=0.4)
    near, control = (found[f"mean_drift_{m}"].values / (RHO * G) for m in METHODS[:2])
    size = np.abs(near).max(axis=(0, 1))
    np.testing.assert_allclose(near[..., :2], control[..., :2], atol=0.01 * size[:2].max())
    np.testing.assert_allclose(near[..., 2], control[..., 2], atol=0.03 * size[2])
    np.testing.assert_allclose(near[..., 3:], control[..., 3:], atol=0.01 * size[3:].max())
    stream = found.control_surface_terms.sel(control_surface_term="stream").values / (RHO * G)
    assert np.abs(stream[..., 4]).max() > 0.05 * size[4]  # the moment of the momentum beside the hull is part of it
    np.testing.assert_array_equal(stream[..., :4], 0.0)


def test_slow_ship_feels_what_a_ship_at_rest_does(ship):
    keys = {"omega": [4.0, 5.0], "wave_direction": DIRECTIONS}
    still, slow = drift(*ship, **keys), drift(*ship, speed=1e-5, **keys)
    for method in METHODS:
        one, two = (d[f"mean_drift_{method}"].values for d in (still, slow))
        known = np.isfinite(two)
        assert known[..., :2].all()
        scale = np.abs(np.where(known, one, 0.0)).max(axis=(0, 1))
        tolerance = 1e-3 if method != "momentum" else 0.04  # the far field takes other panel integrals, of 100 panels
        assert np.all(np.abs(np.where(known, one - two, 0.0)) <= tolerance * scale + 1e-9)
    np.testing.assert_allclose(slow.energy_imbalance, still.energy_imbalance, atol=0.025)


def test_added_resistance_grows_linearly_at_first(ship):
    """Terms of U^2 alone are left of the symmetric part in U."""
    keys = {"omega": [4.4], "wave_direction": [np.pi]}
    h = 0.02
    D = {u: drift(*ship, speed=u, **keys) for u in (-2 * h, -h, 0.0, h, 2 * h)}
    for method in METHODS:
        y = {u: float(d[f"mean_drift_{method}"][0, 0, 0]) for u, d in D.items()}
        if method == "momentum":
            y[0.0] = 0.5 * (y[h] + y[-h])  # at rest by other panel integrals
        bend = [y[s] + y[-s] - 2 * y[0.0] for s in (h, 2 * h)]
        slope = (y[h] - y[-h]) / (2 * h)
        assert slope < 0.0  # more resistance with speed in head seas
        assert abs(bend[1]) < 0.3 * abs(2 * h * slope)


def test_slope_at_rest_is_the_wave_drift_damping_of_a_slender_ship(ship):
    """Aranha (1994), head seas: dR/dU = (omega/g) (omega dR/domega + 4 R), from drift at rest alone."""
    hull, body = ship
    w, h, U = 4.8, 0.05, 0.15
    keys = {"wave_direction": [np.pi], "method": "near"}
    rest = -drift(hull, body, omega=[w - h, w, w + h], **keys).mean_drift_momentum.values[:, 0, 0]
    aranha = w / G * (w * (rest[2] - rest[0]) / (2 * h) + 4.0 * rest[1])
    ahead, astern = (drift(hull, body, omega=[w], speed=u, **keys) for u in (U, -U))
    for method in ("pressure", "momentum"):
        high, low = (-float(d[f"mean_drift_{method}"][0, 0, 0]) for d in (ahead, astern))
        slope = (high - low) / (2.0 * U)
        assert slope == pytest.approx(aranha, rel=0.2)


def test_other_end_first_is_the_mirror_image(ship):
    """The hull is symmetric fore and aft: astern in waves from astern is ahead in waves from ahead; overtaken waves too."""
    body = RigidBody.from_gyradii(ship[1].mass, cog=[0.0, 0.0, 0.0], gyradii=[0.2, 0.75, 0.75])
    keys = {"omega": [3.0, 6.0]}
    ahead = drift(ship[0], body, wave_direction=np.radians([20.0, 140.0]), speed=2.0, **keys)
    astern = drift(ship[0], body, wave_direction=np.radians([40.0, 160.0]), speed=-2.0, **keys).isel(wave_direction=[1, 0])
    assert float(ahead.encounter_frequency[1, 0]) < 0.0 < float(ahead.encounter_frequency[0, 0])
    signs = np.array([-1.0, 1.0, 1.0, 1.0, -1.0, -1.0])
    for name in (*(f"mean_drift_{m}" for m in METHODS), "motion_rao"):
        one, two = ahead[name].values, astern[name].values * signs
        np.testing.assert_allclose(one, two, atol=1e-6 * np.nanmax(np.abs(one)))


def test_port_and_starboard(ship):
    found = drift(*ship, omega=[4.5], wave_direction=[-2.3, 2.3], speed=1.2)
    signs = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    for method in METHODS:
        values = found[f"mean_drift_{method}"].values[0]
        np.testing.assert_allclose(values[0], values[1] * signs, atol=1e-6 * np.nanmax(np.abs(values)))


def test_three_methods_and_energy_where_added_resistance_is_large(ship):
    """Theory of different parentage: pressure gives more by up to two thirds; energy within 30 %."""
    found = drift(*ship, omega=[4.0, 4.3, 4.6], wave_direction=[np.pi], speed=0.2 * np.sqrt(3.0 * G))
    far = found.mean_drift_momentum.values[:, 0, 0]
    assert np.all(far < 0.0)
    for method in METHODS[:2]:
        ratio = found[f"mean_drift_{method}"].values[:, 0, 0] / far
        assert 1.1 < ratio.min() < ratio.max() < 1.67
    assert np.abs(found.energy_imbalance).max() < 0.3
    still = drift(*ship, omega=[4.0, 4.3, 4.6], wave_direction=[np.pi], method="far").mean_drift[:, 0, 0].values
    assert np.abs(far).max() > 2.0 * np.abs(still).max()
    assert found.mean_drift.attrs["method"].startswith("surge: momentum, sway: momentum, heave: control_surface")
    np.testing.assert_array_equal(found.mean_drift[..., 0], found.mean_drift_momentum[..., 0])


def test_external_damping_is_part_of_the_energy_balance_at_speed(ship):
    case, damping = a_case(ship[0], [4.3], [np.pi], speed=1.1), np.diag([0.0, 0.0, 300.0, 0.0, 150.0, 0.0])
    dynamics = checked_dynamics(case, ship[1], damping, None, purpose="t")
    ((_, wave),) = waves_met(case, 0)
    first = Solver(case, cache=False, workers=1).first_order(wave, dynamics)
    far, P = drift_maruo.far_field_at_speed(first), float(first.dissipated[0, 0].real)
    assert 0.3 * far.radiated[0] < P
    assert abs(far.radiated[0] - far.removed[0]) < 0.5 * abs(far.radiated[0] - P - far.removed[0])
    found = drift(*ship, damping=damping, omega=[4.3], wave_direction=[np.pi], speed=1.1)
    assert float(found.mean_drift_pressure[0, 0, 0]) == pytest.approx(float(far.force[0, 0, 0].real), rel=0.6)


def test_waves_shorter_than_two_panels_matter_little(ship, monkeypatch):
    """With its integral along the waterline the Kochin function falls off."""
    keys = {"omega": [4.3], "wave_direction": [np.pi], "speed": 1.1, "method": "far"}
    values = []
    for finest in (2.0, 3.0, 6.0):
        monkeypatch.setattr(drift_maruo, "_FINEST", finest)
        values.append(float(drift(*ship, **keys).mean_drift[0, 0, 0]))
    assert values[1] == pytest.approx(values[2], rel=0.03)
    assert abs(values[1] - values[0]) < 0.05 * abs(values[2])


# --- waves of a moving ship


class Source:
    """One source under water as the far field sees it: K = exp(-q depth)."""

    def __init__(self, depth):
        self.depth = depth

    def __call__(self, first, qx, qy):
        return np.exp(-self.depth * np.hypot(qx, qy))[None].astype(complex)


def carried(omega_e, U, depth=1.0, limit=60.0):
    """Return wave vectors and action of a source of unit strength."""
    parts = [drift_maruo._waves(omega_e, U, G, sign, limit, 4.0) for sign in (1.0, -1.0)]
    Omega, qx, qy, weight = (np.concatenate([p[i] for p in parts]) for i in range(4))
    q = np.hypot(qx, qy)
    return Omega, qx, qy, RHO / (8 * np.pi) * np.sign(Omega) * q * np.exp(-2.0 * depth * q) * weight


def test_steady_limit_is_havelocks_wave_resistance_of_a_source():
    """Havelock: R = 16 pi rho k^2 m^2 int sec^3 exp(-2 k f sec^2) for phi = m/r; half of it for one that oscillates slowly."""
    U, f = 2.5, 0.4
    k = G / U**2
    integral = quad(lambda t: np.exp(-2.0 * k * f / np.cos(t) ** 2) / np.cos(t) ** 3, 0.0, 0.5 * np.pi)[0]
    havelock = 16.0 * np.pi * RHO * k**2 * integral / (4.0 * np.pi) ** 2  # unit flux
    _, qx, _, dN = carried(1e-4, U, depth=f)
    assert qx @ dN == pytest.approx(0.5 * havelock, rel=1e-3)


def test_waves_obey_the_dispersion_relation_and_their_number_is_right():
    for tau in (0.1, 0.6, -0.6):
        U = 2.0
        w = abs(tau) * G / U
        Omega, qx, qy, dN = carried(w, np.sign(tau) * U)
        np.testing.assert_allclose(Omega, w + np.sign(tau) * U * qx, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(Omega**2, G * np.hypot(qx, qy), rtol=1e-9)
        ahead = np.sign(tau) * qx / np.hypot(qx, qy)
        assert (ahead.max() > 0.99) if abs(tau) < 0.25 else (ahead.max() <= 0.25 / abs(tau) + 1e-9)
        assert np.all(np.sign(tau) * qx[Omega < 0.0] < 0.0)
        assert dN.sum() > 0.0


@pytest.mark.parametrize("tau", [0.1, 0.2499, 0.2501, 0.7])
def test_integral_over_the_waves_against_one_over_the_wave_plane(tau):
    """int int delta(g q - Omega^2) (g/8 pi) rho sgn(Omega) |K|^2 dq_x dq_y, with q_y by hand and q_x by quadrature."""
    U = 2.0
    w = tau * G / U

    def line(qx, power):
        Omega = w + U * qx
        q = Omega**2 / G
        qy = np.sqrt(max(q**2 - qx**2, 0.0))
        return np.sign(Omega) * qx**power * np.exp(-2.0 * q) * q / (G * qy) if qy > 0.0 else 0.0  # |d q/d q_y| = q_y/q

    ends = sorted(x.real for s in (1.0, -1.0) for x in np.roots([U**2, 2 * w * U - s * G, w**2]) if abs(x.imag) < 1e-9)
    pieces = [-40.0, *ends, 40.0]
    for power in (0, 1):
        total = sum(
            quad(lambda t, a=a, b=b: line(0.5 * (a + b) - 0.5 * (b - a) * np.cos(t), power) * 0.5 * (b - a) * np.sin(t),
                 0.0, np.pi, limit=400)[0]
            for a, b in pairwise(pieces)
        )  # fmt: skip
        _, qx, _, dN = carried(w, U)
        assert (qx**power) @ dN == pytest.approx(
            2.0 * G * RHO / (8.0 * np.pi) * total, rel=3e-3 if abs(tau - 0.25) < 0.01 else 1e-4
        )


def test_kochin_function_at_rest_is_that_of_the_sources(ball):
    case = a_case(ball[0], [3.2], [0.4, 2.0])
    ((_, wave),) = waves_met(case, 0)
    first = Solver(case, cache=False, workers=1).first_order(wave, checked_dynamics(case, ball[1], None, None, purpose="t"))
    theta = np.linspace(0.0, 6.0, 25)
    K = drift_maruo.kochin(first, wave.k * np.cos(theta), wave.k * np.sin(theta))
    scale = wave.omega * wave.k / (2.0 * G) * np.sqrt(2.0 / (np.pi * wave.k)) * np.exp(0.25j * np.pi)
    A, _ = amplitude(first, theta)
    np.testing.assert_allclose(scale * K, A, atol=0.016 * np.abs(A).max())


@pytest.mark.parametrize("k", [0.8, 4.0])
def test_a_wave_that_passes_through_the_hull_radiates_nothing(k):
    """Green's theorem inside the hull: with the integral along the waterline K of any wave of the moving frame is zero."""
    hull = WholeHull(HullPanels(shapes.hemisphere(1.0, panels=2000)))
    U, b = 1.5, 2.4
    w, q0 = np.sqrt(G * k), k * np.array([np.cos(b), np.sin(b)])
    w_e = w - U * q0[0]

    def wave(x):
        return np.exp(k * x[:, 2] - 1j * (x[:, :2] @ q0))[None]

    def flow(x, n):
        return wave(x) * (n[:, 2] * k - 1j * (n[:, :2] @ q0))

    middle = hull.waterline.middle
    first = SimpleNamespace(
        hull=hull, motion=np.zeros((1, 6)), wave=SimpleNamespace(speed=U, omega_e=w_e, g=G),
        scattered_potential=wave(hull.centers), scattered_flow=flow,
        scattered_line=(wave(middle), -1j * q0[0] * wave(middle)),
    )  # fmt: skip
    parts = [drift_maruo._waves(w_e, U, G, sign, 8.0, 1.0) for sign in (1.0, -1.0)]
    qx, qy = (np.concatenate([p[i] for p in parts])[::7] for i in (1, 2))
    K = drift_maruo.kochin(first, qx, qy)
    alone = drift_maruo._over_hull(first, qx, qy)
    assert np.abs(K).max() < 0.015 * np.abs(alone).max()


# --- first order, data, refusals


def test_motions_are_those_of_solve_bem_at_speed(ship):
    """Head, bow and overtaken waves, phases included."""
    hull, body = ship
    U = 2.0
    keys = {"omega": [2.6, 7.0], "wave_direction": np.radians([30.0, 150.0]), "speed": U}
    found = drift(*ship, method="near", **keys)
    needed = np.unique(np.abs(found.encounter_frequency.values).ravel().round(12))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)
        hydro = solve_bem(hull, body, **{**QUIET, **keys, "omega": np.unique(np.r_[keys["omega"], needed])})
        expected = rao(hydro, body).sel(omega=keys["omega"]).values
    assert float(found.encounter_frequency.min()) < 0.0
    scale = np.abs(expected).max(axis=(0, 1))
    for i in (0, 1, 2, 4, 5):  # roll is resonant
        np.testing.assert_allclose(found.motion_rao.values[..., i], expected[..., i], atol=0.06 * scale[i])


def test_result_names_its_speed_and_encounter(sailing):
    assert sailing.attrs["speed"] == 1.1
    w, b = sailing.omega.values[:, None], sailing.wave_direction.values
    np.testing.assert_allclose(sailing.encounter_frequency, w - w**2 / G * 1.1 * np.cos(b))
    np.testing.assert_array_equal(sailing.flag_slow_encounter, 1.1 * np.abs(sailing.encounter_frequency) / G < 0.25)
    assert "at 1.1 m/s" in sailing.attrs["summary"]
    assert np.isnan(sailing.mean_drift_momentum[..., 5]).all()
    assert np.isfinite(sailing.mean_drift).all()


def test_submerged_ball_and_twin_columns():
    """No waterline: near field and control surface agree; two waterlines: the control surface knows nothing at speed."""
    quarter = shapes.hemisphere(1.0, panels=300).with_symmetry("xz+yz")
    lower, n = quarter.vertices, len(quarter.vertices)
    vertices = np.concatenate([lower, lower * [1.0, 1.0, -1.0]]) - [0.0, 0.0, 1.4]
    ball = type(quarter)(vertices, np.concatenate([quarter.faces, quarter.faces[:, ::-1] + n]), symmetry="xz+yz")
    found = drift(ball, None, omega=[3.0], wave_direction=[2.4], speed=0.5)
    near, control, far = (found[f"mean_drift_{m}"].values[0, 0] for m in METHODS)
    np.testing.assert_allclose(near, control, atol=0.02 * np.abs(near).max())
    assert np.isfinite(far[:2]).all()
    column = shapes.cylinder(0.4, 0.6, panels=20).with_symmetry("none")
    twin = type(column)(
        np.concatenate([column.vertices + [1.5, 0, 0], column.vertices - [1.5, 0, 0]]),
        np.concatenate([column.faces, column.faces + len(column.vertices)]),
    )
    found = drift(twin, None, omega=[3.0], wave_direction=[2.4], speed=0.5)
    assert np.isnan(found.mean_drift_control_surface).all()
    assert found.mean_drift.attrs["method"] == "surge: momentum, sway: momentum, " + ", ".join(
        f"{dof}: pressure" for dof in ("heave", "roll", "pitch", "yaw")
    )
    assert np.isfinite(found.mean_drift).all()


def test_finite_depth_leaves_the_far_field_out(ship):
    keys = {"omega": [4.5], "wave_direction": [np.pi], "speed": 1.0}
    deep, shallow = drift(*ship, **keys), drift(*ship, water_depth=6.0, **keys)
    assert "surge: control_surface" in shallow.mean_drift.attrs["method"]
    assert "energy" not in shallow.attrs["summary"]
    assert not shallow.flag_energy.any()
    for method in METHODS[:2]:
        one, two = (float(d[f"mean_drift_{method}"][0, 0, 0]) for d in (deep, shallow))
        assert two == pytest.approx(one, rel=0.05)


def test_cache_keeps_speeds_apart(ship, tmp_path, monkeypatch):
    monkeypatch.setattr("ogilvie.hydro.drift_store.cache_folder", lambda: tmp_path)
    keys = {"omega": [4.0], "wave_direction": [np.pi, 2.5], "method": "near"}
    first = [drift(*ship, **keys, speed=u, cache=True) for u in (0.0, 1.0)]
    again = [drift(*ship, **keys, speed=u, cache=True) for u in (0.0, 1.0)]
    plain = [drift(*ship, **keys, speed=u) for u in (0.0, 1.0)]
    for one, two, three in zip(first, again, plain, strict=True):
        np.testing.assert_array_equal(one.mean_drift, two.mean_drift)
        np.testing.assert_allclose(one.mean_drift, three.mean_drift, rtol=1e-9, atol=1e-9)


def test_parts_are_put_in_their_places():
    pairs = placed_pairs([np.array([0, 2]), np.array([1])], [np.array([[1.0, 2.0], [3.0, 4.0]]), np.array([[5.0]])])
    np.testing.assert_array_equal(pairs, [[1.0, 0.0, 2.0], [0.0, 5.0, 0.0], [3.0, 0.0, 4.0]])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"pairs": True}, "pairs: False expected at speed"),
        ({"method": "far", "water_depth": 5.0}, "deep water expected"),
        ({"speed": np.nan}, "mean_drift: speed: a finite number"),
        ({"wave_direction": [0.0], "omega": [G / 2.0]}, "move relative to the ship"),
    ],
)
def test_what_cannot_be_done_at_speed_is_refused(change, words):
    keys = {"omega": [3.0], "wave_direction": [np.pi], "speed": 2.0, **QUIET, **change}
    with pytest.raises(InputError, match=words):
        mean_drift(shapes.hemisphere(1.0, panels=60), **keys)
