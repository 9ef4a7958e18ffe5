"""Wave-drift damping against its definition: the drift on a slowly moving body, by wave action and by finite differences."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.errors import DoubleCountingError, InputError
from ogilvie.loads.base import Surroundings
from ogilvie.loads.wave_drift_damping import WaveDriftDamping
from ogilvie.waves.dispersion import group_velocity, wavenumber

G = 9.80665
W = np.linspace(0.3, 2.2, 60)
HEADINGS = np.radians(np.arange(0, 361, 5))[:-1]
BODY = og.RigidBody(1e7, [0, 0, 0], 1e9 * np.eye(3))


def drift(w, b):
    """Surge and sway (..., 6)."""
    D = np.zeros((*np.broadcast_shapes(np.shape(w), np.shape(b)), 6))
    D[..., 0] = 3e4 * np.cos(b) * np.tanh(2 * w**2) * (1 + 0.2 * np.cos(2 * b))
    D[..., 1] = 9e4 * np.sin(b) * np.tanh(3 * w**2)
    D[..., 5] = 1e6 * np.sin(2 * b)
    return D


def hydro(depth=np.inf, headings=HEADINGS, **more):
    M = np.tile(np.eye(6) * 1e6, (len(W), 1, 1))
    D = drift(W[:, None], headings)
    return og.hydro_from_arrays(
        omega=W, added_mass=M, radiation_damping=M, wave_direction=headings, mean_drift=D, water_depth=depth, **more
    )


def action(w, b, theta, weight, velocity, depth):
    """Drift (2,) on a body at a velocity (2,) that turns the action of the waves into the directions theta, by wave action.

    In the frame of the body a wave has the frequency w - k.U and travels with c_g - U; scattering there is taken to be that of
    the body at rest, for these frequencies and directions. Each wave carries the momentum N k at the velocity c_g - U.
    """

    def wave(frequency, angle):
        k, c = wavenumber(frequency, depth, g=G), group_velocity(frequency, depth, g=G)
        e = np.array([np.cos(angle), np.sin(angle)])
        return k * e, c * e - velocity, frequency - k * e @ velocity

    k_in, ray, w_e = wave(w, b)
    flux = 0.5 * 1025 * G / w * np.hypot(*ray)
    relative = np.arctan2(ray[1], ray[0])
    force = np.zeros(2)
    for angle, share in zip(theta, weight, strict=True):
        seen = relative + angle  # direction of the scattered ray in the frame of the body
        out_w, out_b = w_e, seen
        for _ in range(60):  # the wave whose ray and frequency those are
            _, ray, found = wave(out_w, out_b)
            out_w += w_e - found
            out_b += seen - np.arctan2(ray[1], ray[0])
        force += share * flux * (k_in - wave(out_w, out_b)[0])
    return force


@pytest.mark.parametrize("depth", [np.inf, 25.0])
@pytest.mark.parametrize("alpha", [0.0, np.pi / 2])
def test_formula_follows_from_wave_action(depth, alpha):
    """A body that scatters into given directions from its own: drift at a small speed against the formula."""
    theta, weight, w, b = np.array([0.4, 2.0, -2.6]), np.array([0.5, 0.2, 0.3]), 0.8, 2.2
    speed = 1e-3
    e = np.array([np.cos(alpha), np.sin(alpha)])
    ahead, astern = (action(w, b, theta, weight, s * speed * e, depth) for s in (1, -1))
    expected = -(ahead - astern) / (2 * speed)
    at_rest = lambda f, angle: action(f, angle, theta, weight, np.zeros(2), depth)  # noqa: E731
    h = 1e-4
    D = at_rest(w, b)
    D_w, D_b = (at_rest(w + h, b) - at_rest(w - h, b)) / (2 * h), (at_rest(w, b + h) - at_rest(w, b - h)) / (2 * h)
    k, c = wavenumber(w, depth, g=G), group_velocity(w, depth, g=G)
    slope = (group_velocity(w + h, depth, g=G) - group_velocity(w - h, depth, g=G)) / (2 * h)
    q = k / w + 1 / c - k * slope / c
    formula = np.cos(b - alpha) * (k * D_w + q * D) - np.sin(b - alpha) / c * D_b
    np.testing.assert_allclose(formula, expected, rtol=1e-5, atol=1e-6 * np.abs(D).max())
    if np.isinf(depth):
        assert q == pytest.approx(4 * w / G, rel=1e-6)


@pytest.mark.parametrize("depth", [np.inf, 30.0])
def test_coefficients_are_the_change_of_drift_with_speed(depth):
    """D(w, b; U) = (1 - q U cos b) D(w_e, b_e): frequency of encounter and direction of the rays relative to the body."""
    damping = WaveDriftDamping(hydro(depth), og.regular(amplitude=1.0, omega=0.8, direction=2.5))
    w, b, U = np.array([0.5, 0.9, 1.4]), np.array([2.9, 2.1, 0.6]), 1e-3
    k, c = wavenumber(w, depth, g=G), group_velocity(w, depth, g=G)
    h = 1e-5
    q = k / w + 1 / c - k * (group_velocity(w + h, depth, g=G) - group_velocity(w - h, depth, g=G)) / (2 * h * c)
    for j, alpha in enumerate((0.0, np.pi / 2)):

        def at(speed, alpha=alpha):
            w_e = w - k * speed * np.cos(b - alpha)
            ray = c * np.exp(1j * b) - speed * np.exp(1j * alpha)
            return (1 - q * speed * np.cos(b - alpha))[:, None] * drift(w_e, np.angle(ray))[:, :2]

        expected = -(at(U) - at(-U)) / (2 * U)
        np.testing.assert_allclose(damping.coefficients(w, b)[:, :, j], expected, rtol=2e-3, atol=1e-3 * np.abs(expected).max())


def test_head_waves():
    """(omega/g)(4 |D| + omega d|D|/domega) > 0: waves ahead damp surge."""
    damping = WaveDriftDamping(hydro(), og.regular(amplitude=1.0, omega=0.8, direction=np.pi))
    w = np.array([0.6, 1.0])
    D, slope = (np.abs(drift(w, np.pi)[:, 0]), 1.2 * 3e4 * 4 * w / np.cosh(2 * w**2) ** 2)
    B = damping.coefficients(w, np.pi)
    np.testing.assert_allclose(B[:, 0, 0], w / G * (4 * D + w * slope), rtol=1e-3)
    np.testing.assert_allclose(B[:, 1, 0], 0.0, atol=1e-6 * B[0, 0, 0])


def test_irregular_sea_and_heading():
    sea = og.irregular(og.jonswap(hs=3.0, tp=9.0), direction=2.8, n=60, seed=range(2), omega_range=(0.4, 2.0))
    damping = WaveDriftDamping(hydro(), sea)
    expected = np.einsum("n,nij->ij", sea.amplitude[0] ** 2, damping.coefficients(sea.omega, sea.direction - 0.3))
    np.testing.assert_allclose(damping.matrix(0.3), expected, rtol=1e-12)
    twice = WaveDriftDamping(hydro(), og.irregular(og.jonswap(hs=6.0, tp=9.0), direction=2.8, n=60, omega_range=(0.4, 2.0)))
    np.testing.assert_allclose(twice.matrix(0.3), 4 * expected, rtol=1e-6)


def test_turning_the_axes():
    """B is a tensor: a body of revolution has the same B in axes that turn with the waves."""
    M = np.tile(np.eye(6) * 1e6, (len(W), 1, 1))
    D = np.zeros((len(W), len(HEADINGS), 6))
    D[..., 0] = 2e4 * np.tanh(2 * W**2)[:, None] * np.cos(HEADINGS)
    D[..., 1] = 2e4 * np.tanh(2 * W**2)[:, None] * np.sin(HEADINGS)
    buoy = og.hydro_from_arrays(omega=W, added_mass=M, radiation_damping=M, wave_direction=HEADINGS, mean_drift=D)
    damping = WaveDriftDamping(buoy, og.regular(amplitude=1.0, omega=0.8, direction=0.0))
    along, turned = damping.coefficients([0.9, 0.9], [0.0, 0.7])
    T = np.array([[np.cos(0.7), -np.sin(0.7)], [np.sin(0.7), np.cos(0.7)]])
    np.testing.assert_allclose(turned, T @ along @ T.T, rtol=1e-4, atol=1e-5 * along[0, 0])


def test_terms():
    """Small motions: -B (U + nu'); large ones: -B nu_r at the heading of the moment."""
    sea = og.irregular(og.jonswap(hs=3.0, tp=9.0), direction=2.8, n=60, omega_range=(0.4, 2.0))
    damping = WaveDriftDamping(hydro(), sea)
    terms = damping.bind(Surroundings(BODY, speed=1.5, heading=0.3))
    B = damping.matrix(0.3)
    np.testing.assert_allclose(terms.small.damping[:2, :2], B)
    np.testing.assert_allclose(terms.small.constant[:2], -1.5 * B[:, 0])
    assert not terms.small.damping[2:].any()
    nu = np.array([1.2, -0.4, 0, 0, 0, 0])
    on = np.radians(18.0)  # a heading of the table
    found = terms.kernel.force(eta=[5, 6, 0, 0, 0, on + 2 * np.pi], nu=[9, 9, 9, 0, 0, 0], nu_r=nu)
    np.testing.assert_allclose(found[:2], -damping.matrix(on) @ nu[:2], rtol=1e-9)
    between = terms.kernel.force(eta=[0, 0, 0, 0, 0, 0.3], nu=nu)
    np.testing.assert_allclose(between[:2], -B @ nu[:2], rtol=5e-3)


def test_it_damps_a_slow_motion():
    """A moored body in head waves: the decrement of surge is that of B11."""
    sea = og.regular(amplitude=3.0, omega=0.8, direction=np.pi)
    damping = WaveDriftDamping(hydro(), sea)
    spring = np.diag([1e5, 1e5, 1e8, 1e9, 1e9, 1e9])
    ship = og.Vessel(BODY, loads=(og.LinearMooring(spring), damping))
    for motions in ("small", "large"):
        run = og.simulate(ship, duration=1500.0, dt=0.5, initial={"eta": [1.0, 0, 0, 0, 0, 0]}, motions=motions)
        x = run.eta.sel(dof="surge").values
        peaks = x[1:-1][(x[1:-1] > x[2:]) & (x[1:-1] > x[:-2])]
        ratio = damping.matrix(0.0)[0, 0] / (2 * np.sqrt(1e5 * 1e7))
        assert np.log(peaks[0] / peaks[3]) / (6 * np.pi) == pytest.approx(ratio, rel=0.05)


def test_mistakes():
    sea = og.regular(amplitude=1.0, omega=0.8, direction=2.5)
    with pytest.raises(InputError, match="a Sea expected"):
        WaveDriftDamping(hydro(), None)
    with pytest.raises(InputError, match="zero speed"):
        WaveDriftDamping(hydro(speed=3.0), sea)
    with pytest.raises(InputError, match="two or more frequencies and headings"):
        WaveDriftDamping(hydro(headings=np.array([2.5])), sea)
    with pytest.raises(InputError, match="of its variance lies outside"):
        WaveDriftDamping(hydro(), og.regular(amplitude=1.0, omega=2.5, direction=2.5))
    with pytest.raises(InputError, match="frequencies within"):
        WaveDriftDamping(hydro(), sea).coefficients(0.1, 2.0)
    two = WaveDriftDamping(hydro(), sea)
    with pytest.raises(DoubleCountingError, match="wave-drift damping"):
        og.Vessel(BODY, loads=(two, two))
