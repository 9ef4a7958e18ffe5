"""The memory force of a velocity known in advance: closed forms, order, the time loop's own; the length of a memory."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.memory.convolve import convolve, memory_length, truncated

DOFS = ("heave", "pitch")
SIZE = np.array([[2.0, -0.5], [-0.3, 3.0]])
RATE = 0.9  # 1/s


def table(step=0.01, duration=30.0):
    """K = SIZE exp(-RATE t)."""
    t = np.arange(0.0, duration + step / 2, step)
    return og.Retardation(t, SIZE * np.exp(-RATE * t)[:, None, None], np.eye(2), dofs=DOFS)


def smooth(t, w=1.3, phase=0.7):
    """A velocity that jumps at t = 0, and int_0^t exp(-RATE (t - s)) nu(s) ds of it."""
    nu = np.cos(w * t + phase)
    mu = (np.exp(1j * (w * t + phase)) - np.exp(1j * phase - RATE * t)) / (RATE + 1j * w)
    return nu, mu.real


def both(t):
    (a, p), (b, q) = smooth(t), smooth(t, 0.8, -1.1)
    return np.stack([a, b], axis=1), np.stack([p, q], axis=1) @ SIZE.T


def test_closed_form():
    t = 0.05 * np.arange(801)
    nu, mu = both(t)
    assert np.abs(convolve(table(), nu, 0.05) - mu).max() < 1e-5 * np.abs(mu).max()


def test_observed_order_is_four():
    """With a jump of velocity at the start; the very first steps know too few velocities for a cubic: third order."""

    def errors(dt):
        t = dt * np.arange(round(20.0 / dt) + 1)
        nu, mu = both(t)
        wrong = np.abs(convolve(table(0.005, 40.0), nu, dt, truncation=40.0) - mu).max(axis=1)
        return wrong.max(), wrong[t >= 3.2].max()

    found = np.log2(np.array([errors(0.4), errors(0.2)]) / np.array([errors(0.2), errors(0.1)]))
    assert np.all(found[:, 0] > 2.5)
    assert found[:, 1] == pytest.approx([4.0, 4.0], abs=0.35)


def test_equals_the_sum_written_out():
    """Linear in nu, causal, and for any n the same as the convolution with its own response to one sample."""
    rng = np.random.default_rng(1)
    nu = rng.normal(size=(60, 2))
    nu[:20] = 0.0  # away from the start, where the weights are those of any later time
    K = table(duration=3.0)
    pulse = np.zeros((60, 2, 60, 2))
    for j in range(2):
        pulse[20, j, 20, j] = 1.0
    response = np.stack([convolve(K, pulse[20, j], 0.1, truncation=3.0)[20:] for j in range(2)], axis=2)  # (lag, force, motion)
    mu = convolve(K, nu, 0.1, truncation=3.0)
    assert np.abs(mu[:20]).max() < 1e-14
    for n in (20, 21, 37, 59):
        expected = sum(response[k] @ nu[n - k] for k in range(n - 19))
        assert mu[n] == pytest.approx(expected, abs=1e-12)


def test_realisations_are_a_leading_axis():
    nu = np.random.default_rng(2).normal(size=(3, 2, 50, 2))
    K = table(duration=2.0)
    together = convolve(K, nu, 0.1)
    assert together.shape == nu.shape
    assert together[1, 0] == pytest.approx(convolve(K, nu[1, 0], 0.1), abs=1e-13)


@pytest.mark.parametrize("n", [1, 2, 5, 8, 9])
def test_short_histories(n):
    t = 0.05 * np.arange(n)
    nu, mu = both(t)
    assert convolve(table(), nu, 0.05) == pytest.approx(mu, abs=2e-3)


@pytest.mark.parametrize("start", ["rest", {"eta": [0, 0, 1.0, 0.1, 0.05, 0], "nu": [0.5, 0.3, 0.2, 0.01, 0.02, 0.03]}])
def test_equals_the_convolution_in_the_time_loop(start):
    """The memory force of the simulated velocity is the one that the loop used; the first steps differ by terms of dt^4."""
    t = np.arange(0.0, 30.0, 0.05)
    size = np.diag([4e5, 3e6, 5e6, 4e7, 2.5e9, 1.2e9])
    size[2, 4] = size[4, 2] = 3e7
    K = og.Retardation(t, size * (np.exp(-0.6 * t) * (np.cos(t) - 0.6 * np.sin(t)))[:, None, None], np.diag(np.diag(size)))
    body = og.RigidBody(mass=1e7, cog=[0.5, 0.0, 1.0], inertia=np.diag([4e8, 7e9, 7e9]))
    springs = np.diag([3.2e4, 4e4, 8e6, 1.6e8, 4e9, 1.6e7])
    ship = og.Vessel(body, loads=(og.LinearRestoring(springs), og.Convolution(K, truncation=25.0)))
    if start == "rest":
        start = {"eta": [1.0, 1.0, 1.0, 0.1, 0.05, 0.1]}
    run = og.simulate(ship, duration=60.0, dt=0.05, initial=start)
    used = -run.force_radiation.values - run.acceleration.values @ K.A_inf.T
    mu = convolve(K, run.nu.values, 0.05, truncation=25.0)
    scale = np.abs(used).max(axis=0)
    assert (np.abs(mu - used) / scale).max() < 2e-5
    assert (np.abs(mu - used)[20:] / scale).max() < 1e-6


class TestLength:
    def test_exponential(self):
        """int_T^inf exp(-r s) ds = share int_0^inf: T = log(1/share)/r."""
        for share in (1e-2, 1e-4):
            assert memory_length(table(), share=share) == pytest.approx(np.log(1 / share) / RATE, abs=0.02)

    def test_nothing_shorter_would_do(self):
        K = table()
        T = memory_length(K, share=1e-3)
        k = round(T / K.dt)
        left = [np.trapezoid(np.abs(K.K[i:, 0, 0]), K.t[i:]) / np.trapezoid(np.abs(K.K[:, 0, 0]), K.t) for i in (k - 1, k)]
        assert left[1] <= 1e-3 < left[0]

    def test_default_changes_a_force_by_no_more_than_stated(self):
        K = table(duration=40.0)
        nu, _ = both(0.05 * np.arange(801))
        change = np.abs(convolve(K, nu, 0.05) - convolve(K, nu, 0.05, truncation=40.0)).max()
        assert 0.0 < change < 1e-5 * np.abs(SIZE).sum(axis=1).max() / RATE

    def test_a_memory_that_never_fades_is_kept(self):
        t = np.arange(0.0, 10.0, 0.1)
        K = og.Retardation(t, np.cos(t)[:, None, None], [[0.0]], dofs=("heave",))
        assert memory_length(K) == K.duration
        assert og.Convolution(K).truncation == K.duration

    def test_the_load_takes_it(self):
        K = table()
        load = og.Convolution(K)
        assert load.truncation == memory_length(K) < 0.5 * K.duration
        assert load.bind(None).memory.t[-1] == pytest.approx(load.truncation)

    def test_truncated_keeps_what_it_keeps(self):
        K = table()
        short = truncated(K, 4.0)
        assert short.duration == pytest.approx(4.0)
        assert np.array_equal(short.K, K.K[: len(short.t)])

    def test_zero_kernel(self):
        t = np.arange(0.0, 10.0, 0.1)
        K = og.Retardation(t, np.zeros((100, 1, 1)), [[0.0]], dofs=("heave",))
        assert memory_length(K) == pytest.approx(0.1)
        assert not np.any(convolve(K, np.ones((50, 1)), 0.1, truncation=5.0))

    @pytest.mark.parametrize("share", [0.0, 1.0, -0.1, np.nan])
    def test_bad_share(self, share):
        with pytest.raises(og.InputError, match="share"):
            memory_length(table(), share=share)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"nu": np.ones((50, 3))}, r"nu \(\.\.\., n_t, 2\) over heave, pitch"),
        ({"nu": np.ones(50)}, "shape"),
        ({"nu": np.ones((0, 2))}, "shape"),
        ({"nu": np.full((50, 2), np.nan)}, "100 NaN"),
        ({"nu": "fast"}, "array of velocities"),
        ({"dt": 0.0}, "dt positive"),
        ({"dt": np.nan}, "dt positive"),
        ({"dt": 9.0}, "an eighth"),
        ({"truncation": 31.0}, r"truncation in \(0, 30\] s"),
        ({"truncation": -1.0}, "truncation"),
        ({"truncation": "long"}, "truncation"),
        ({"K": np.ones((3, 2, 2))}, "a Retardation"),
    ],
)
def test_bad_input(change, words):
    good = {"K": table(), "nu": np.ones((50, 2)), "dt": 0.1}
    with pytest.raises(og.InputError, match=words):
        convolve(**(good | change))
