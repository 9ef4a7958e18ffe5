"""Drift in short waves: walls, circles and boxes in closed form, diffraction theory, symmetry, rays, errors."""

import warnings

import numpy as np
import pytest
import xarray as xr
from scipy.special import h2vp, jvp

from ogilvie.errors import InputError
from ogilvie.hydro.drift_contour import Contour, find_contour
from ogilvie.hydro.drift_join import _raised, joined_drift
from ogilvie.hydro.drift_short import reflection, short_wave_drift, wall_force
from ogilvie.hydro.schema import hydro_from_arrays, validate
from ogilvie.loads.slow_drift import SlowDrift
from ogilvie.mesh import shapes
from ogilvie.mesh.panels import PanelMesh

RHO, G = 1000.0, 9.81
WATER = {"rho": RHO, "g": G}
HALF = 0.5 * RHO * G
HEADINGS = np.radians([0.0, 40.0, 90.0, 135.0, 180.0])


def polygon(corners):
    """Return the contour of a closed polygon given anticlockwise."""
    p = np.asarray(corners, dtype=float)
    step = np.roll(p, -1, axis=0) - p
    length = np.hypot(*step.T)
    return Contour(p + 0.5 * step, np.stack([step[:, 1], -step[:, 0]], axis=1) / length[:, None], length)


def circle(n, radius=1.0, center=(0.0, 0.0)):
    a = 2.0 * np.pi * (np.arange(n) + 0.5) / n
    return polygon(np.asarray(center) + radius * np.stack([np.cos(a), np.sin(a)], axis=1))


def together(*parts):
    return Contour(*(np.concatenate([getattr(one, key) for one in parts]) for key in ("middle", "normal", "length")))


def square(x, y, half):
    return polygon([[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]])


def force(hull, **options):
    found = short_wave_drift(hull, **{"omega": [3.0], **WATER, **options}).mean_drift.values
    return found[0, :, [0, 1, 5]].T / HALF


# --- one wall


@pytest.mark.parametrize("angle", [0.2, 0.9, np.pi / 2])
def test_wall_at_rest_is_pushed_by_the_pressure_of_incident_and_reflected_wave(angle):
    """<rho g eta^2/2> - int rho/2 <|grad phi|^2> dz of both waves together, summed over a period and the depth."""
    s, c = np.sin(angle), np.cos(angle)
    t, (depth, weight) = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False), np.polynomial.legendre.leggauss(40)
    z, dz = 15.0 * (depth - 1.0), 15.0 * weight  # g = omega = k = 1, and the wall is y = 0
    eta = 2.0 * np.cos(t)  # both waves in phase at the wall
    potential = 2.0 * np.sin(t)[:, None] * np.exp(z)
    along = 2.0 * c * np.cos(t)[:, None] * np.exp(z)
    found = np.mean(0.5 * eta**2) - np.mean(0.5 * (potential**2 + along**2) @ dz)
    assert found / 0.5 == pytest.approx(wall_force(s, 0.0), rel=1e-12)


def test_wall_at_low_speed_has_the_published_slope():
    """The wall at theta, waves at beta off the bow: sin^2(theta + beta) + 2 tau (cos beta - cos theta cos(theta + beta))."""
    theta, beta = np.meshgrid(np.linspace(0.3, 1.5, 7), np.linspace(0.0, 1.2, 7))
    s = np.sin(theta + beta)
    errors = []
    for tau in (0.02, 0.01):
        published = s**2 + 2.0 * tau * (np.cos(beta) - np.cos(theta) * np.cos(theta + beta))
        errors.append(np.abs(wall_force(s, tau * np.sin(theta)) - published).max())
    assert errors[1] < 3e-4
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)


def test_wall_against_the_waves_feels_the_square_of_the_frequency_of_encounter():
    tau = np.array([0.0, 0.3, 1.0])
    np.testing.assert_allclose(wall_force(1.0, tau), (1.0 + tau) ** 2, rtol=1e-14)


def test_wall_force_is_continuous_and_never_negative():
    s, w = np.meshgrid(np.linspace(-1.0, 1.0, 81), np.linspace(-3.0, 3.0, 121))
    f = wall_force(s, w)
    assert np.all(f >= 0.0)
    assert np.all(f[(s <= 0.0) | (s + 2.0 * w <= 0.0)] == 0.0)
    for at in (0.0, -0.4):  # the wall at rest, and one that runs away as fast as the energy of waves with s = 0.8
        low, high = wall_force(0.8, at - 1e-9), wall_force(0.8, at + 1e-9)
        assert high == pytest.approx(low, abs=1e-8)


def test_wall_that_outruns_the_waves_is_not_pushed():
    """A flat stern in following seas: s (s + 2 w) down to the group velocity, nothing beyond; nor is the bow."""
    hull = shapes.box(4.0, 1.0, 0.5, panels=200)
    group = 0.5 * G / 3.0
    for U, wanted in ((0.0, 1.0), (0.5 * group, 0.5), (group, 0.0), (1.5 * group, 0.0), (3.0 * group, 0.0)):
        assert force(hull, wave_direction=[0.0], speed=U)[0, 0] == pytest.approx(wanted, abs=1e-9)


# --- whole waterlines


def test_circle_at_rest_is_two_thirds_and_converges_with_the_square_of_the_panels():
    errors = []
    for panels in (200, 800, 3200):
        hull = shapes.cylinder(1.0, 1.0, panels=panels)
        found = force(hull, wave_direction=HEADINGS)
        np.testing.assert_allclose(found[:, :2], np.hypot(*found[0, :2]) * np.c_[np.cos(HEADINGS), np.sin(HEADINGS)], atol=0.01)
        np.testing.assert_allclose(found[:, 2], 0.0, atol=1e-12)
        errors.append(4.0 / 3.0 - found[0, 0])
    assert errors[-1] < 3e-4
    assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx(2.0, abs=0.4)


def test_circle_is_the_end_of_diffraction_theory():
    """MacCamy and Fuchs with Maruo's momentum: drift over rho g a^2 R tends to that of rays, faster than 1/kR."""

    def theory(kR):
        m = np.arange(int(2 * kR) + 25)
        c = jvp(m, kR) / h2vp(m, kR) * np.where(m == 0, 1.0, 2.0)
        angle = 2.0 * np.pi * np.arange(720) / 720
        A = np.sqrt(2.0 / (np.pi * kR)) * (c @ np.cos(np.outer(m, angle)))
        return 0.5 * np.pi * np.mean(np.abs(A) ** 2 * (1.0 - np.cos(angle)))

    rays = -0.5 * reflection(circle(2000), np.pi, 0.0)[0]
    short = np.array([rays - theory(kR) for kR in (20.0, 40.0, 80.0)])
    assert np.all(short > 0.0)
    assert short[-1] < 0.002 * rays
    assert np.all(np.log2(short[:-1] / short[1:]) > 1.0)


def test_box_is_pushed_on_the_sides_that_waves_hit():
    hull = shapes.box(4.0, 1.0, 0.5, panels=300)
    np.testing.assert_allclose(force(hull)[0], [-1.0, 0.0, 0.0], atol=1e-12)  # the bow alone
    np.testing.assert_allclose(force(hull, wave_direction=[np.pi / 2])[0], [0.0, 4.0, 0.0], atol=1e-12)
    found = force(hull, wave_direction=[0.75 * np.pi])[0]  # half on bow (breadth 1) and starboard side (length 4)
    np.testing.assert_allclose(found, [-0.5, 2.0, 0.0], atol=1e-12)
    tau = 3.0 * 1.3 / G
    np.testing.assert_allclose(force(hull, speed=1.3)[0, 0], -((1.0 + tau) ** 2), rtol=1e-12)


def test_moment_is_that_of_the_force_at_its_place():
    hull = shapes.box(4.0, 1.0, 0.5, panels=300).translated((3.0, 2.0, 0.0))
    for direction, wanted in ((np.pi, [-1.0, 0.0, 2.0]), (np.pi / 2, [0.0, 4.0, 12.0])):
        np.testing.assert_allclose(force(hull, wave_direction=[direction])[0], wanted, atol=1e-12)


def test_slope_in_speed_of_a_ship_in_head_seas():
    """(1 + 2 omega U/g) times the drift at rest, to first order, for any waterline; the second order has a limit."""
    hull = shapes.wigley(3.0, panels=400)
    rest = force(hull)[0, 0]
    second = []
    for U in (0.02, 0.01):
        tau = 3.0 * U / G
        second.append((force(hull, speed=U)[0, 0] / rest - 1.0 - 2.0 * tau) / tau**2)
    assert second[1] == pytest.approx(second[0], rel=0.02)
    assert abs(second[1]) < 3.0


@pytest.mark.parametrize("speed", [0.0, 1.5])
def test_mirror_images(speed):
    """Waves from the other bow give the mirror image, for a hull stored in half and one stored whole alike."""
    half = shapes.wigley(3.0, panels=400)
    one = force(half, wave_direction=[2.4], speed=speed)
    np.testing.assert_allclose(force(half, wave_direction=[-2.4], speed=speed), one * [1.0, -1.0, -1.0], atol=1e-12)
    whole = half.with_symmetry("none")
    np.testing.assert_allclose(force(whole, wave_direction=[2.4], speed=speed), one, atol=1e-9)


def test_turned_hull_in_turned_waves():
    hull = shapes.wigley(3.0, panels=400).translated((0.4, 0.0, 0.0))
    turned = hull.rotated(psi=0.7)
    c, s = np.cos(0.7), np.sin(0.7)
    for direction in (0.3, 1.9):
        one, other = force(hull, wave_direction=[direction])[0], force(turned, wave_direction=[direction + 0.7])[0]
        np.testing.assert_allclose(other, [c * one[0] - s * one[1], s * one[0] + c * one[1], one[2]], atol=1e-9)


def test_going_astern_is_going_ahead_turned_round():
    hull = shapes.wigley(3.0, panels=400).translated((0.4, 0.0, 0.0))
    one = force(hull, wave_direction=[2.3], speed=1.5)[0]
    other = force(hull.rotated(psi=np.pi), wave_direction=[2.3 - np.pi], speed=-1.5)[0]
    np.testing.assert_allclose(other, one * [-1.0, -1.0, 1.0], atol=1e-9)


def test_forces_do_not_depend_on_the_scale():
    small = short_wave_drift(shapes.wigley(1.0, panels=300), omega=[6.0], wave_direction=[2.6], speed=1.1, **WATER)
    large = short_wave_drift(shapes.wigley(25.0, panels=300), omega=[1.2], wave_direction=[2.6], speed=5.5, **WATER)
    ratio = large.mean_drift.values[0, 0, [0, 1, 5]] / small.mean_drift.values[0, 0, [0, 1, 5]]
    np.testing.assert_allclose(ratio, [25.0, 25.0, 625.0], rtol=1e-6)


# --- shadow


def test_a_body_in_the_shadow_of_another_is_not_pushed():
    before, behind = square(5.0, 0.0, 1.0), square(0.0, 0.0, 0.9)
    pair = together(before, behind)
    np.testing.assert_allclose(reflection(pair, np.pi, 0.0), reflection(before, np.pi, 0.0))
    np.testing.assert_allclose(reflection(pair, np.pi / 2, 0.0)[1], 2.0 + 1.8)  # from the side both are
    aside = together(before, square(0.0, 2.0, 0.9))
    assert reflection(aside, np.pi, 0.0)[0] == pytest.approx(-3.8)


def test_half_of_a_wide_wall_in_the_shadow():
    small, n = square(5.0, 0.5, 0.5), 200
    y = np.linspace(-1.0, 1.0, n + 1)
    wall = polygon([*np.c_[np.zeros(n + 1), y], [-1.0, 1.0], [-1.0, -1.0]])
    assert reflection(together(small, wall), np.pi, 0.0)[0] == pytest.approx(-2.0, abs=2.5 / n)


def test_inner_walls_are_hidden():
    """A moonpool: its walls face each other and the outer hull stands before them."""
    outer, inner = circle(60), circle(40, 0.5)
    pool = Contour(inner.middle, -inner.normal, inner.length)
    for direction in (0.3, np.pi):
        np.testing.assert_allclose(reflection(together(outer, pool), direction, 0.0), reflection(outer, direction, 0.0))


def test_at_speed_the_shadow_follows_the_energy_in_the_axes_of_the_ship():
    """Waves abeam of a ship that advances with c_g come from 45 degrees off the bow: d - (U/c_g) e_x."""
    before, behind = square(4.0, -4.0, 1.0), square(0.0, 0.0, 0.9)
    pair = together(before, behind)
    exposed = pair.exposed(np.array([0.0, 1.0]) - [2.0 * 0.5, 0.0])
    assert exposed.tolist() == [True, True, False, False, False, False, False, False]
    assert pair.exposed(np.array([0.0, 1.0])).tolist() == [True, False, False, False, True, False, False, False]
    assert not pair.exposed(np.zeros(2)).any()


def test_convex_waterlines_have_no_pairs_to_look_at():
    contour = find_contour(shapes.wigley(3.0, panels=400), purpose="t")
    assert len(contour._before[0]) == 0


# --- what the theory leaves out


@pytest.mark.parametrize(("tau", "rays"), [(0.02, 1.080), (0.1, 1.416), (0.5, 1.79)])
def test_rays_around_a_circle(tau, rays):
    """Wave action followed through the potential flow round a circle: 1 + 4 tau at first, less than twice the drift at rest.

    The formula has half of the slope and more at high speed: docs/theory/drift.md, section 8, quotes these ratios.
    """
    rest = ray_force(0.0)
    assert rest == pytest.approx(4.0 / 3.0, rel=3e-3)
    assert ray_force(tau) / rest - 1.0 == pytest.approx(rays - 1.0, rel=0.06)
    ours = reflection(circle(500), np.pi, tau)[0] / reflection(circle(500), np.pi, 0.0)[0]
    assert 0.45 < (ours - 1.0) / (rays - 1.0) < 1.6


def ray_force(tau, n=120, start=12.0, step=0.01):
    """Return the force of rays from ahead on a circle of radius 1 over rho g a^2/2, sternwards.

    k = g = omega = 1, so U = tau and c_g = 1/2; dx/dt = c_g + u, dk/dt = -(grad u) k, reflection at the wall; each ray carries
    the action (1/2 + U) dy of E/omega and leaves the momentum k_in - k_out.
    """
    width = 1.5
    x = start + 1j * (np.arange(n) + 0.5) / n * width
    k = np.full(n, -1.0 + 0.0j)

    def rates(x, k):
        u = np.conj(-tau * (1.0 - x**-2))
        slope = -2.0 * tau * x**-3  # u_x - i v_x, and v_x = u_y, v_y = -u_x
        return 0.5 * np.abs(k) ** -1.5 * k + u, -np.conj(slope * k)

    for _ in range(int(120.0 / step)):
        a = rates(x, k)
        b = rates(x + 0.5 * step * a[0], k + 0.5 * step * a[1])
        c = rates(x + 0.5 * step * b[0], k + 0.5 * step * b[1])
        d = rates(x + step * c[0], k + step * c[1])
        x, k = (old + step / 6.0 * (p + 2 * q + 2 * r + s) for old, p, q, r, s in zip((x, k), a, b, c, d, strict=True))
        inside = np.abs(x) < 1.0
        normal = x / np.abs(x)
        towards = np.minimum(np.real(k * np.conj(normal)), 0.0)
        k = np.where(inside, k - 2.0 * towards * normal, k)
        x = np.where(inside, normal * (1.0 + 1e-9), x)
    return 2.0 * (0.5 + tau) * np.sum(1.0 + k.real) * width / n


# --- results


def test_result_obeys_the_schema_and_feeds_slow_drift():
    w, b = np.linspace(0.8, 1.6, 9), np.radians([90.0, 135.0, 180.0])
    drift = short_wave_drift(shapes.wigley(100.0, panels=300), omega=w[::-1], wave_direction=b, speed=5.0, **WATER)
    assert drift.omega.values.tolist() == w.tolist()
    assert np.isnan(drift.mean_drift.sel(influenced_dof=["heave", "roll", "pitch"])).all()
    np.testing.assert_allclose(drift.encounter_frequency, w[:, None] - w[:, None] ** 2 * 5.0 * np.cos(b) / G)
    Z = np.zeros((9, 6, 6))
    hydro = hydro_from_arrays(omega=w, added_mass=Z, radiation_damping=Z, wave_direction=b, speed=5.0, **WATER)
    assert validate(hydro.assign(mean_drift=drift.mean_drift)).mean_drift.equals(drift.mean_drift)
    for one in (drift, hydro.assign(mean_drift=drift.mean_drift)):
        load = SlowDrift(one)
        assert load.dofs == ("surge", "sway", "yaw")
        np.testing.assert_allclose(load.qtf([1.2], [1.2], np.pi)[0, 0].real, drift.mean_drift.values[4, 2, 0], rtol=1e-9)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"hull": "ship"}, "hull: a PanelMesh expected, str found"),
        ({"hull": shapes.hemisphere(1.0, panels=60).translated((0, 0, -2.0))}, "pierces the surface"),
        ({"hull": shapes.hemisphere(1.0, panels=60).translated((0, 0, 0.4))}, "no panel above z = 0"),
        ({"omega": [0.0, 1.0]}, "omega: positive frequencies in rad/s expected, 0.0 found"),
        ({"omega": [np.nan]}, "omega: positive"),
        ({"omega": []}, "omega: a list"),
        ({"omega": "fast"}, "omega: positive frequencies in rad/s expected, 'fast'"),
        ({"omega": [1.0, 1.0]}, "omega: distinct values expected, 1.0 is given twice"),
        ({"wave_direction": [180.0]}, "wave_direction: angles from -pi to 2 pi rad expected, 180.0 found"),
        ({"wave_direction": [0.0, 0.0]}, "distinct"),
        ({"speed": np.inf}, "speed: a finite number"),
        ({"speed": "fast"}, "speed: a finite number of m/s expected, 'fast' found"),
        ({"speed": np.nan}, "speed: a finite number"),
        ({"rho": -1.0}, "rho: a positive number"),
        ({"g": 0.0}, "g: a positive number"),
    ],
)
def test_bad_input(change, words):
    options = {"hull": shapes.hemisphere(1.0, panels=60), "omega": [5.0], **change}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(InputError, match=words):
            short_wave_drift(**options)


def test_open_waterline():
    hull = shapes.box(4.0, 1.0, 0.5, panels=300).with_symmetry("none")
    keep = hull.centers[:, 0] < 1.99  # the bow is missing
    with pytest.raises(InputError, match=r"a closed waterline expected, one of 9 m with a gap of 1 m"):
        short_wave_drift(PanelMesh(hull.vertices, hull.faces[keep]), omega=[5.0])


# --- with the panel method


@pytest.fixture(scope="module")
def short():
    hull = shapes.wigley(100.0, panels=300)
    return short_wave_drift(hull, omega=np.linspace(0.7, 2.0, 14), wave_direction=[2.5, np.pi], speed=5.0, **WATER)


def panel_method(short, omega, factor=1.0):
    """Stand in for the drift of the panel method: falls with frequency, with heave but no roll."""
    w = np.asarray(omega)[:, None, None]
    first = short.mean_drift.sel(influenced_dof=["surge", "sway", "yaw"]).isel(omega=0).values
    values = np.full((len(w), short.sizes["wave_direction"], 6), np.nan)
    values[..., [0, 1, 5]] = factor * first * (1.0 + 3.0 * np.exp(-(((w - 0.6) / 0.3) ** 2)))
    values[..., 2] = 1e5
    coords = {"omega": omega, "wave_direction": short.wave_direction, "influenced_dof": short.influenced_dof}
    attrs = {key: short.attrs[key] for key in ("rho", "g", "speed", "water_depth")}
    return xr.Dataset({"mean_drift": (short.mean_drift.dims, values)}, coords=coords, attrs=attrs)


def frequencies(one, ratio):
    return np.sqrt(2.0 * np.pi * G / (np.asarray(ratio) * one.attrs["length"]))


def test_at_speed_reflection_is_a_floor_of_surge_and_sway(short):
    long = panel_method(short, np.linspace(0.3, 1.5, 41), factor=0.8)
    joined = joined_drift(long, short)
    at = np.intersect1d(joined.omega, short.omega)
    at = at[(at >= frequencies(short, 0.8)) & (at <= 1.5)]
    l, s, found = (one.mean_drift.sel(omega=at).values for one in (panel_method(short, at, factor=0.8), short, joined))
    assert np.any(np.abs(l) > np.abs(s), axis=(0, 1))[0]
    assert np.any(np.abs(l) < np.abs(s), axis=(0, 1))[0]
    larger = np.where(np.abs(l) > np.abs(s), l, s)[..., :2]  # same signs here
    np.testing.assert_allclose(found[..., :2], larger, rtol=2e-3)
    np.testing.assert_allclose(found[..., 5], l[..., 5], rtol=2e-3)  # yaw is that of the panels
    far = joined.omega.values[joined.omega.values <= frequencies(short, 1.2)]
    known = [0, 1, 5]
    np.testing.assert_allclose(joined.mean_drift.sel(omega=far)[..., known], long.mean_drift.sel(omega=far)[..., known])
    assert np.isnan(joined.mean_drift.values[..., [2, 3, 4]]).all()
    assert SlowDrift(joined).dofs == ("surge", "sway", "yaw")


def test_floor_is_continuous_whatever_the_signs():
    """Neither a change of sign of one nor of the other makes a jump; larger and of one sign is the rule."""
    x = np.linspace(-2.0, 2.0, 801)
    l, s = np.meshgrid(x, x)
    both = [np.repeat(part.reshape(-1, 1, 1), 6, axis=2) for part in (l, s)]
    found = _raised(*both, np.ones(l.size))[:, 0, 0].reshape(l.shape)
    step = x[1] - x[0]
    assert np.abs(np.diff(found, axis=0)).max() < 2.01 * step
    assert np.abs(np.diff(found, axis=1)).max() < 2.01 * step
    same = l * s >= 0.0
    np.testing.assert_allclose(found[same], np.where(np.abs(l) > np.abs(s), l, s)[same], atol=1e-12)
    np.testing.assert_allclose(found[s == 0.0], l[s == 0.0])
    assert np.all(np.abs(found) <= np.maximum(np.abs(l), np.abs(s)) + 1e-12)


def test_at_rest_the_panel_method_is_taken_as_far_as_it_goes():
    hull, w = shapes.wigley(100.0, panels=300), np.linspace(0.7, 3.0, 24)
    short = short_wave_drift(hull, omega=w, wave_direction=[2.5, np.pi], **WATER)
    long = panel_method(short, w[:8], factor=0.1)
    joined = joined_drift(long, short).mean_drift.values[..., [0, 1, 5]]
    np.testing.assert_allclose(joined[:8], long.mean_drift.values[..., [0, 1, 5]])
    half = w >= np.sqrt(2.0) * w[7]  # waves of half the length and shorter
    np.testing.assert_allclose(joined[half], short.mean_drift.values[half][..., [0, 1, 5]])
    between = joined[7:][~half[7:]]
    steps = np.diff(np.concatenate([between, joined[half][:1]]), axis=0)
    assert np.all((steps >= -1e-9).all(axis=0) | (steps <= 1e-9).all(axis=0))  # from one to the other


def test_joining_a_drift_with_itself_changes_nothing(short):
    joined = joined_drift(short, short)
    assert joined.omega.values.tolist() == short.omega.values.tolist()
    np.testing.assert_allclose(joined.mean_drift, short.mean_drift, rtol=1e-12)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda one, other: (one.isel(omega=slice(8)), other), "long: frequencies up to 0.8778 rad/s"),
        (lambda one, other: (one, other.isel(omega=slice(4, None))), "short: frequencies from 0.7167 rad/s on"),
        (lambda one, other: (one.assign_attrs(speed=0.0), other), "attribute speed 5.0 of short expected, 0.0 found"),
        (lambda one, other: (one.assign_attrs(rho=1025.0), other), "attribute rho"),
        (lambda one, other: (one.assign_attrs(moments="body"), other), "moments"),
        (lambda one, other: (one.isel(wave_direction=[1]), other), "the directions of short expected"),
        (lambda one, other: (one.isel(influenced_dof=[0]), other), "the dofs of short expected"),
        (lambda one, other: (one.drop_vars("mean_drift"), other), "long: mean_drift over omega"),
        (lambda one, other: (None, other), "long: a data set expected"),
        (lambda one, other: (other, one.drop_attrs()), "short: a result of short_wave_drift"),
    ],
)
def test_sets_that_cannot_be_joined(short, change, words):
    long, other = change(panel_method(short, np.linspace(0.3, 1.3, 21)), short)
    with pytest.raises(InputError, match=words):
        joined_drift(long, other)


@pytest.mark.parametrize("band", [(0.8, 0.4), (0.0, 0.5), (0.5,), 0.5, (0.5, np.inf), ("a", "b")])
def test_bands_that_are_none(short, band):
    with pytest.raises(InputError, match="joined_drift: band: two"):
        joined_drift(short, short, band=band)
