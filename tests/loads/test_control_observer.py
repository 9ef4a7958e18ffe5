"""The passive observer: transfer functions, exact step, stability at every period, what it lets through."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ogilvie as og
from ogilvie.loads.control import WaveFilter
from ogilvie.loads.control.observer import BIAS, POSITION, VELOCITY, WAVE, observer_step, planar_observer_step

M3 = np.array([[7e6, 0, 0], [0, 9e6, -3e6], [0, -3e6, 4e9]])
D3 = np.array([[3e5, 0, 0], [0, 9e5, 0], [0, 0, 3e8]])
M1, D1 = np.array([[2.0]]), np.array([[0.1]])
FILTER = WaveFilter(0.7)


def transfer(F, G, C, w):
    return np.array([C @ np.linalg.solve(1j * x * np.eye(len(F)) - F, G[:, 0]) for x in w])


@pytest.mark.parametrize("l", [0.05, 0.1, 0.3])
def test_transfer_from_measurement_to_position_and_wave_is_the_closed_form(l):
    wf = WaveFilter(0.7, wave_damping=l, cutoff=0.9, bandwidth=0.08, bias_time=800.0)
    F, G, _ = wf.continuous(M1, D1)
    w = np.geomspace(0.005, 5.0, 60)
    s, wo, wc, wb = 1j * w, 0.7, 0.9, 0.08
    part = 1 + 2 * (1 - l) * wc / wo
    f = wc / part - 2 * wb
    wave = (2 * wo * (1 - l) * s + wo**2 * 2 * (1 - l) * wc / wo) / (s**2 + 2 * l * wo * s + wo**2)
    m, d = M1[0, 0], D1[0, 0]
    low = (wc + part * m * (wb**2 + 2 * wb * f + f * wb**2 / (s + 1 / 800.0)) / (m * s + d)) / s
    assert transfer(F, G, np.eye(5)[POSITION], w) == pytest.approx(low / (1 + wave + low), rel=1e-9)
    assert transfer(F, G, np.eye(5)[WAVE], w) == pytest.approx(wave / (1 + wave + low), rel=1e-9)


def test_notch_of_the_innovation_is_the_published_one():
    """Without K3 and K4 (a bandwidth near 0): s (s2 + 2 l w s + w2) / ((s2 + 2 w s + w2)(s + wc))."""
    wo, wc, l = 0.8976, 1.1, 0.1
    wf = WaveFilter(wo, bandwidth=1e-6, bias_time=1e9)
    F, G, _ = wf.continuous(M1, D1)
    assert G[:3, 0] == pytest.approx([-2 * 0.9 * wc / wo, 2 * 0.9 * wo, wc])
    w = np.geomspace(0.1, 5, 40)
    s = 1j * w
    notch = s * (s**2 + 2 * l * wo * s + wo**2) / ((s**2 + 2 * wo * s + wo**2) * (s + wc))
    innovation = 1 - transfer(F, G, np.eye(5)[POSITION] + np.eye(5)[WAVE], w)
    assert innovation == pytest.approx(notch, rel=1e-4)


def test_slow_poles_are_placed_to_first_order():
    wb, errors = 0.02, []
    for wo in (1.0, 10.0, 100.0):
        wf = WaveFilter(wo, bandwidth=wb, bias_time=1e9)
        poles = np.linalg.eigvals(wf.continuous(M1, 0 * D1)[0])
        slow = poles[np.argsort(np.abs(poles))[:2]]
        errors.append(abs(slow.mean() / -wb - 1))
    assert errors[0] < 0.1
    assert errors[1] < 0.2 * errors[0]
    assert errors[2] < 0.2 * errors[1]


def test_default_tuning_is_well_damped():
    for wo in (0.4, 0.7, 1.2):
        poles = np.linalg.eigvals(WaveFilter(wo).continuous(M1, 0 * D1)[0])
        assert np.all(-poles.real / np.abs(poles) > 0.9)


@pytest.mark.parametrize("wo", [0.4, 0.7, 1.2])
def test_default_tuning_is_passive(wo):
    """Phase of the loop above -90 deg: notch over s, times (s + K3/K4) / s."""
    _, G, _ = WaveFilter(wo).continuous(M1, D1)
    w = np.geomspace(1e-4, 1e2, 4000)
    s, wc, ratio = 1j * w, WaveFilter(wo).cutoff, G[BIAS, 0] / (M1[0, 0] * G[VELOCITY, 0])
    notch = (s**2 + 2 * 0.1 * wo * s + wo**2) / ((s**2 + 2 * wo * s + wo**2) * (s + wc))
    assert np.all(np.real(notch * (s + ratio) / s) > 0.0)
    assert 0.0 < ratio < wo < wc


def test_step_is_exact_for_a_linear_measurement_and_a_held_force():
    T, rng = 2.0, np.random.default_rng(1)
    F, G, B = FILTER.continuous(M3, D3)
    scale = np.repeat([1.0, 1.0, 1.0, 1e5, 0.1], 3)
    z, y0, y1, tau = scale * rng.normal(size=15), rng.normal(size=3), rng.normal(size=3), 1e5 * rng.normal(size=3)
    rhs = lambda t, x: F @ x + G @ (y0 + (y1 - y0) * t / T) + B @ tau  # noqa: E731
    exact = solve_ivp(rhs, (0, T), z, rtol=1e-11, atol=1e-11).y[:, -1]
    out = z.copy()
    observer_step(FILTER.step_matrix(M3, D3, T).ravel(), 3, out, y0, y1, tau)
    assert out / scale == pytest.approx(exact / scale, rel=1e-8, abs=1e-8)


@pytest.mark.parametrize("period", [0.05, 1.0, 10.0, 300.0])
def test_it_is_stable_at_every_period(period):
    S = FILTER.step_matrix(M3, D3, period)
    assert np.abs(np.linalg.eigvals(S[:, :15])).max() < 1.0


def follow(wf, y, T, *, M=M1, D=D1, tau=None):
    """Run the observer on a record y (n,) and return its states (n, 5)."""
    S, z = wf.step_matrix(M, D, T).ravel(), np.zeros(5)
    z[POSITION] = y[0]
    out = [z.copy()]
    for j in range(len(y) - 1):
        observer_step(S, 1, z, y[j : j + 1], y[j + 1 : j + 2], np.zeros(1) if tau is None else tau[j : j + 1])
        out.append(z.copy())
    return np.array(out)


def test_waves_are_removed_and_slow_motion_is_followed():
    T, wo, ws = 0.5, 0.7, 0.02
    t = np.arange(0, 3000, T)
    late = t > 1500
    wave = follow(FILTER, np.sin(wo * t), T)
    assert wave[late, POSITION].std() * np.sqrt(2) < 0.1
    assert wave[late, VELOCITY].std() * np.sqrt(2) < 0.1 * wo
    slow = follow(FILTER, np.sin(ws * t), T)[late]
    coefficient = 2 * np.mean(slow[:, POSITION] * np.exp(-1j * ws * t[late])) * 1j
    lag = -np.angle(coefficient) / ws
    assert np.abs(coefficient) == pytest.approx(1.0, abs=0.05)
    assert abs(lag) < 3.0  # s, of a motion of 314 s
    assert np.abs(slow[:, POSITION] - np.sin(ws * t[late])).max() < 0.05


def test_irregular_waves_are_removed():
    T, wo = 0.5, 0.7
    sea = og.irregular(og.jonswap(hs=4.0, tp=2 * np.pi / wo, gamma=3.3), direction=np.pi, seed=3)
    t = np.arange(0, 2000, T)
    y = np.real(np.exp(1j * (t[:, None] * sea.omega + np.ravel(sea.phase))) @ np.ravel(sea.amplitude))
    state = follow(FILTER, y, T)
    late = t > 300
    assert state[late, POSITION].std() < 0.2 * y[late].std()
    assert np.corrcoef(state[late, WAVE], y[late])[0, 1] > 0.95


def test_motion_of_constant_velocity_and_a_constant_force_are_found():
    T = 0.5
    t = np.arange(0, 4000, T)
    wf = WaveFilter(0.7, bias_time=1e7)
    state = follow(wf, 0.3 * t, T)
    assert state[-1, VELOCITY] == pytest.approx(0.3, rel=1e-3)
    assert state[-1, POSITION] == pytest.approx(0.3 * t[-1], abs=1e-3)
    assert state[-1, BIAS] == pytest.approx(D1[0, 0] * 0.3, rel=1e-3)  # the force that holds this speed
    held = follow(wf, np.zeros_like(t), T, tau=np.full(t.size, -0.7))
    assert held[-1, BIAS] == pytest.approx(0.7, rel=1e-3)


def test_estimates_turn_with_the_world():
    T, a, rng = 0.5, 0.8, np.random.default_rng(2)
    S = FILTER.step_matrix(M3, D3, T).ravel()
    c, s = np.cos(a), np.sin(a)
    R = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    z, z_turned = np.zeros(15), np.zeros(15)
    y = np.cumsum(rng.normal(size=(50, 3)) * [1, 1, 0.02], axis=0)
    turned = y @ R.T + [0, 0, a]
    z[6:9], z_turned[6:9] = y[0], turned[0]
    for j in range(49):
        tau = 1e5 * rng.normal(size=3)
        planar_observer_step(S, z, y[j].copy(), y[j + 1].copy(), tau)
        planar_observer_step(S, z_turned, turned[j].copy(), turned[j + 1].copy(), tau)
    for block in (WAVE, POSITION, BIAS):
        part = slice(3 * block, 3 * block + 3)
        expected = R @ z[part] + [0, 0, a * (block == POSITION)]
        assert z_turned[part] == pytest.approx(expected, rel=1e-9, abs=1e-9)
    assert z_turned[12:] == pytest.approx(z[12:], rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"wave_frequency": 0.0}, "wave_frequency"),
        ({"wave_frequency": "long"}, "wave_frequency"),
        ({"wave_frequency": 0.7, "cutoff": 0.5}, "cutoff above"),
        ({"wave_frequency": 0.7, "wave_damping": 1.5}, "no notch"),
        ({"wave_frequency": 0.7, "bandwidth": 0.5}, "bandwidth below w_e / 2"),
        ({"wave_frequency": 0.7, "bias_time": 10.0}, "passivity"),
    ],
)
def test_wrong_arguments_are_refused(arguments, words):
    with pytest.raises(og.InputError, match=words):
        WaveFilter(**arguments)


def test_wave_frequencies_of_another_number_are_refused():
    with pytest.raises(og.InputError, match="wave_frequency"):
        WaveFilter([0.7, 0.8]).continuous(M3, D3)
