"""Seas: convention, sums by every route, kinematics, statistics of realisations, reproducible seeds, records, bad input."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.units import GRAVITY, SEA_WATER, deg
from ogilvie.waves.field import Sea
from ogilvie.waves.sea import bichromatic, irregular, regular, sea_from_record
from ogilvie.waves.spectra import bretschneider, jonswap, spreading
from ogilvie.waves.synthesis import time_series

SPECTRUM = jonswap(hs=4.25, tp=9.8)
T = np.arange(0.0, 600.0, 0.25)


def plain_sum(sea, t, x=0.0, y=0.0):
    """The definition, by numpy."""
    phase = (
        np.multiply.outer(t, sea.omega) - sea.wavenumber * (x * np.cos(sea.direction) + y * np.sin(sea.direction)) + sea.phase
    )
    return np.sum(sea.amplitude * np.cos(phase), axis=-1)


# ---------------------------------------------------------------------------------------------------- convention


def test_a_wave_travels_to_its_direction():
    speed = GRAVITY / 0.8
    for b in (0.0, 40 * deg, np.pi / 2, np.pi, -30 * deg):
        wave = regular(amplitude=1.5, omega=0.8, direction=b, phase=0.2)
        t = 3.0
        crest = wave.elevation(t, speed * t * np.cos(b), speed * t * np.sin(b))
        assert crest == pytest.approx(1.5 * np.cos(0.2), rel=1e-12)


def test_height_period_and_amplitude_omega_agree():
    one = regular(height=3.0, period=8.0, direction=0.0)
    two = regular(amplitude=1.5, omega=2 * np.pi / 8, direction=0.0)
    assert one.omega == two.omega
    assert one.amplitude == two.amplitude
    assert one.hs == pytest.approx(4 * 1.5 / np.sqrt(2))


def test_bichromatic_is_the_sum():
    sea = bichromatic(amplitude=(1.0, 2.0), omega=(0.6, 0.7), direction=(0.0, np.pi), phase=(0.1, 0.2), depth=50.0)
    a = regular(amplitude=1.0, omega=0.6, direction=0.0, phase=0.1, depth=50.0)
    b = regular(amplitude=2.0, omega=0.7, direction=np.pi, phase=0.2, depth=50.0)
    np.testing.assert_allclose(sea.elevation(T, 7.0, 3.0), a.elevation(T, 7.0, 3.0) + b.elevation(T, 7.0, 3.0), atol=1e-12)
    assert sea.depth == 50.0


# ---------------------------------------------------------------------------------------------------- sums


@pytest.mark.parametrize("t", [T, T + 1e4, T[::-1], np.sort(np.random.default_rng(1).uniform(0, 500, 200)), np.array([3.7])])
def test_series_equal_the_plain_sum(t):
    sea = irregular(SPECTRUM, direction=200 * deg, n=150, seed=4, depth=60.0)
    expected = plain_sum(sea, t, 30.0, -12.0)
    np.testing.assert_allclose(sea.elevation(t, 30.0, -12.0), expected, atol=2e-11)


@pytest.mark.parametrize("n_steps", [500, 501, 37])
@pytest.mark.parametrize("start", [0.0, 12.3])
def test_fft_equals_the_plain_sum(n_steps, start):
    """Also where components lie above the Nyquist frequency of the times, and over more than one period."""
    period = 400.0
    k = np.array([1, 5, 20, 133, 250, 300])
    rng = np.random.default_rng(7)
    sea = Sea(
        omega=2 * np.pi / period * k,
        direction=np.zeros(6),
        amplitude=rng.uniform(size=(2, 6)),
        phase=rng.uniform(0, 6, size=(2, 6)),
        period=period,
    )
    t = start + period / n_steps * np.arange(int(1.7 * n_steps))
    expected = np.stack([plain_sum(sea.isel(i), t) for i in (0, 1)])
    np.testing.assert_allclose(sea.elevation(t), expected, atol=1e-12 * sea.amplitude.sum())


def test_points_of_any_shape():
    sea = irregular(SPECTRUM, direction=np.pi, n=20, seed=range(3))
    t = np.linspace(0, 20, 5)[:, None]
    x = np.array([0.0, 10.0, 20.0])
    zeta = sea.elevation(t, x, 4.0)
    assert zeta.shape == (3, 5, 3)
    assert zeta[2, 4, 1] == pytest.approx(plain_sum(sea.isel(2), 20.0, 10.0, 4.0), rel=1e-11)
    assert sea.elevation(1.0).shape == (3,)
    assert sea.isel(0).elevation(1.0).shape == ()


def test_time_series_of_many_coefficients():
    omega, t = np.array([0.5, 1.1]), np.arange(0, 50, 0.1)
    C = np.array([[1.0, 2j], [0.5j, -1.0]])
    expected = (C @ np.exp(1j * np.outer(omega, t))).real
    np.testing.assert_allclose(time_series(omega, C, t), expected, atol=1e-13)


# ---------------------------------------------------------------------------------------------------- kinematics


@pytest.mark.parametrize("depth", [8.0, 40.0, np.inf])
def test_kinematics_are_those_of_potential_flow(depth):
    sea = bichromatic(amplitude=(1.0, 0.6), period=(9.0, 6.0), direction=(30 * deg, 200 * deg), phase=(0.3, 1.0), depth=depth)
    t, x, y, z, h = 2.3, 4.0, -7.0, -3.0, 1e-4

    def velocity(t, x, y, z):
        return sea.velocity(t, x, y, z=z)

    u = velocity(t, x, y, z)
    grad = np.stack(
        [
            (velocity(t, x + h, y, z) - velocity(t, x - h, y, z)) / (2 * h),
            (velocity(t, x, y + h, z) - velocity(t, x, y - h, z)) / (2 * h),
            (velocity(t, x, y, z + h) - velocity(t, x, y, z - h)) / (2 * h),
        ]
    )
    assert abs(np.trace(grad)) < 1e-8  # continuity
    np.testing.assert_allclose(grad, grad.T, atol=1e-8)  # no rotation
    acceleration = (velocity(t + h, x, y, z) - velocity(t - h, x, y, z)) / (2 * h)
    slope = [
        (sea.pressure(t, x + h, y, z=z) - sea.pressure(t, x - h, y, z=z)) / (2 * h),
        (sea.pressure(t, x, y + h, z=z) - sea.pressure(t, x, y - h, z=z)) / (2 * h),
        (sea.pressure(t, x, y, z=z + h) - sea.pressure(t, x, y, z=z - h)) / (2 * h),
    ]
    np.testing.assert_allclose(acceleration, -np.array(slope) / SEA_WATER, atol=1e-7)  # linear momentum
    assert sea.pressure(t, x, y, z=0.0) == pytest.approx(SEA_WATER * GRAVITY * sea.elevation(t, x, y), rel=1e-12)
    rise = (sea.elevation(t + h, x, y) - sea.elevation(t - h, x, y)) / (2 * h)
    assert velocity(t, x, y, 0.0)[2] == pytest.approx(rise, rel=1e-6)
    if np.isfinite(depth):
        assert abs(velocity(t, x, y, -depth)[2]) < 1e-12
    assert u.shape == (3,)


# ---------------------------------------------------------------------------------------------------- irregular


@pytest.mark.parametrize("method", ["equal-frequency", "equal-energy"])
@pytest.mark.parametrize("n", [50, 400])
def test_components_hold_the_variance_of_the_range(method, n):
    sea = irregular(SPECTRUM, direction=np.pi, n=n, method=method, omega_range=(0.4, 2.0))
    m0 = SPECTRUM.moment(0, omega_range=(0.4, 2.0))
    assert sea.hs == pytest.approx(4 * np.sqrt(m0), rel=1e-12)
    assert np.all(np.diff(sea.omega) > 0)
    assert sea.omega[0] >= 0.4
    assert sea.omega[-1] <= 2.0
    if method == "equal-energy":
        assert np.ptp(sea.amplitude) < 1e-12
    m2 = np.sum(sea.omega**2 * sea.amplitude**2) / 2
    assert m2 == pytest.approx(SPECTRUM.moment(2, omega_range=(0.4, 2.0)), rel=0.02)


def test_grid_of_a_duration():
    sea = irregular(SPECTRUM, direction=np.pi, duration=3600.0, seed=range(2))
    assert sea.period == 3600.0
    t = np.arange(0, 3600, 0.5)
    zeta = sea.elevation(t)
    np.testing.assert_allclose(4 * zeta.std(axis=1), sea.hs, rtol=1e-12)  # Parseval: exact over one period
    np.testing.assert_allclose(sea.elevation(t[:50] + 3600.0), zeta[:, :50], atol=1e-10)
    assert sea.hs[0] == pytest.approx(4.25, rel=1.1e-3)
    direct = Sea(sea.omega, sea.direction, sea.amplitude, sea.phase)
    np.testing.assert_allclose(direct.elevation(t[:200]), zeta[:, :200], atol=1e-10)


def test_default_range_and_hs():
    sea = irregular(SPECTRUM, direction=np.pi)
    assert len(sea.omega) == 300
    assert 0.9985 * 4.25 < sea.hs < 4.25
    assert sea.period is None


def test_sea_without_period_does_not_repeat():
    sea = irregular(SPECTRUM, direction=np.pi, n=200, seed=3)
    repeat = 2 * np.pi / np.mean(np.diff(sea.omega))  # where equal steps would repeat exactly
    t = np.arange(0, 300, 0.5)
    first = sea.elevation(t)
    for later in (repeat, 2 * repeat):
        best = max(abs(np.corrcoef(first, sea.elevation(t + later + shift))[0, 1]) for shift in np.arange(-3, 3, 0.5))
        assert best < 0.5


@pytest.mark.parametrize("random", ["phase", "amplitude"])
@pytest.mark.parametrize("spread", [None, spreading(s=10)])
def test_a_realisation_is_what_its_seed_gives(random, spread):
    many = irregular(SPECTRUM, direction=np.pi, seed=range(5, 9), n=60, random=random, spreading=spread)
    assert many.n_realisations == 4
    assert many.seeds == (5, 6, 7, 8)
    for i, seed in enumerate(range(5, 9)):
        one = irregular(SPECTRUM, direction=np.pi, seed=seed, n=60, random=random, spreading=spread)
        np.testing.assert_array_equal(many.phase[i], one.phase)
        np.testing.assert_array_equal(many.amplitude[i], one.amplitude)
        np.testing.assert_array_equal(many.omega, one.omega)
        np.testing.assert_array_equal(many.direction, one.direction)
        np.testing.assert_array_equal(many.isel(i).phase, one.phase)
        assert many.isel(i).seeds == (seed,)
    assert many.isel([0, 2]).seeds == (5, 7)


def test_random_amplitudes_are_rayleigh_and_energy_right_on_average():
    sea = irregular(SPECTRUM, direction=np.pi, n=100, seed=range(400), random="amplitude")
    sigma = irregular(SPECTRUM, direction=np.pi, n=100).amplitude / np.sqrt(2)
    u = np.sort((1 - np.exp(-0.5 * (sea.amplitude / sigma) ** 2)).ravel())
    assert np.abs(u - (np.arange(u.size) + 0.5) / u.size).max() < 1.63 / np.sqrt(u.size)  # Kolmogorov-Smirnov, 1 %
    assert np.mean(sea.hs**2) == pytest.approx(irregular(SPECTRUM, direction=np.pi, n=100).hs ** 2, rel=0.02)
    assert sea.hs.std() > 0.02


def test_elevation_is_gaussian_with_the_right_moments():
    sea = irregular(SPECTRUM, direction=np.pi, n=200, seed=range(60))
    zeta = sea.elevation(np.arange(0, 1200, 1.0))
    sigma = SPECTRUM.hs / 4
    assert zeta.std() == pytest.approx(sigma, rel=0.01)
    assert np.mean(zeta**3) / sigma**3 == pytest.approx(0.0, abs=0.05)
    assert np.mean(zeta**4) / sigma**4 == pytest.approx(3.0, abs=0.1)


def test_measured_spectrum_is_the_spectrum_asked_for():
    sea = irregular(SPECTRUM, direction=np.pi, n=800, seed=range(40))
    dt, n = 0.5, 1024
    zeta = sea.elevation(dt * np.arange(n)) * np.hanning(n)
    power = np.mean(np.abs(np.fft.rfft(zeta, axis=1)) ** 2, axis=0) * 2 * dt / (2 * np.pi * np.sum(np.hanning(n) ** 2))
    omega = 2 * np.pi * np.fft.rfftfreq(n, dt)
    band = (omega > 0.5) & (omega < 1.5)
    smooth = np.convolve(power, np.ones(5) / 5, "same")
    wanted = np.convolve(SPECTRUM(omega), np.ones(5) / 5, "same")
    np.testing.assert_allclose(smooth[band], wanted[band], rtol=0.35)
    assert power[band].sum() == pytest.approx(SPECTRUM(omega)[band].sum(), rel=0.03)


def test_spread_sea_has_the_spread_asked_for():
    D = spreading(s=8)
    sea = irregular(SPECTRUM, direction=170 * deg, spreading=D, n=600, n_directions=15)
    assert len(np.unique(sea.direction)) == 15
    assert np.all((sea.direction > -np.pi) & (sea.direction <= np.pi))
    energy = sea.amplitude**2 / sea.hs**2 * 8
    first = np.sum(energy * np.exp(1j * sea.direction))
    assert np.angle(first) == pytest.approx(170 * deg, abs=2 * deg)
    assert np.abs(first) == pytest.approx(8 / 9, abs=0.02)


def test_seas_add_and_shared_seeds_are_refused():
    wind = irregular(SPECTRUM, direction=np.pi, seed=range(3), n=40)
    swell = irregular(bretschneider(hs=2.0, tp=15.0), direction=np.pi / 2, seed=range(100, 103), n=30)
    both = wind + swell
    np.testing.assert_allclose(
        both.elevation(T[:50], 3.0, 2.0), wind.elevation(T[:50], 3.0, 2.0) + swell.elevation(T[:50], 3.0, 2.0)
    )
    np.testing.assert_allclose(both.hs**2, wind.hs**2 + swell.hs**2)
    with pytest.raises(InputError, match="same seeds"):
        wind + irregular(bretschneider(hs=2.0, tp=15.0), direction=np.pi / 2, seed=range(3), n=30)
    with_one = wind + regular(height=2.0, period=9.0, direction=0.0)
    assert with_one.amplitude.shape == (3, 41)
    with pytest.raises(InputError, match="one depth"):
        wind + regular(height=2.0, period=9.0, direction=0.0, depth=20.0)
    with pytest.raises(InputError, match="realisations"):
        wind + irregular(SPECTRUM, direction=0.0, seed=range(50, 54))


def test_a_sea_cannot_be_changed():
    sea = irregular(SPECTRUM, direction=np.pi, seed=range(2))
    for name in ("omega", "wavenumber", "direction", "amplitude", "phase"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(sea, name)[...] = 0.0


# ---------------------------------------------------------------------------------------------------- records


@settings(max_examples=40, deadline=None)
@given(st.integers(4, 400), st.floats(0.05, 2.0), st.floats(-100, 1e4), st.integers(0, 10**6))
def test_record_is_reproduced_to_rounding(n, dt, start, seed):
    t = start + dt * np.arange(n)
    zeta = np.random.default_rng(seed).normal(size=n)
    zeta -= zeta.mean()
    sea = sea_from_record(t, zeta, direction=np.pi)
    np.testing.assert_allclose(sea.elevation(t), zeta, atol=1e-9)  # phases carry omega t0 of 1e4 s


def test_record_at_a_probe_and_several_realisations():
    sea = irregular(SPECTRUM, direction=150 * deg, duration=400.0, seed=range(2), depth=70.0)
    t = np.arange(0, 400.0, 0.5)
    probe = (120.0, -15.0)
    back = sea_from_record(t, sea.elevation(t, *probe), direction=150 * deg, x=probe[0], y=probe[1], depth=70.0)
    np.testing.assert_allclose(back.elevation(t, *probe), sea.elevation(t, *probe), atol=1e-12)
    np.testing.assert_allclose(back.elevation(t), sea.elevation(t), atol=1e-11)  # the same long-crested sea everywhere
    np.testing.assert_allclose(back.elevation(t, -80.0, 33.0), sea.elevation(t, -80.0, 33.0), atol=1e-10)


def test_record_range_and_taper():
    t = np.arange(0, 200.0, 0.5)
    slow, fast = np.cos(2 * np.pi / 20 * t), 0.3 * np.cos(2 * np.pi / 2.5 * t)
    sea = sea_from_record(t, slow + fast, direction=0.0, omega_range=(0.1, 1.0))
    np.testing.assert_allclose(sea.elevation(t), slow, atol=1e-12)
    tapered = sea_from_record(t, slow + fast, direction=0.0, taper=20.0).elevation(t)
    assert abs(tapered[0]) < 0.02
    np.testing.assert_allclose(tapered[60:-60], (slow + fast)[60:-60], atol=2e-3)


def test_record_mean_is_named():
    t = np.arange(0, 100.0, 0.5)
    with pytest.warns(OgilvieWarning, match=r"mean 0\.5 m"):
        sea = sea_from_record(t, 0.5 + np.cos(2 * np.pi / 10 * t), direction=0.0)
    np.testing.assert_allclose(sea.elevation(t), np.cos(2 * np.pi / 10 * t), atol=1e-12)


# ---------------------------------------------------------------------------------------------------- bad input


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: irregular(SPECTRUM, direction=180.0), "Degrees"),
        (lambda: irregular(SPECTRUM, direction=np.nan), "direction"),
        (lambda: irregular(SPECTRUM, direction=[0.0, 1.0]), "add seas"),
        (lambda: irregular(lambda w: w, direction=0.0), "a spectrum"),
        (lambda: irregular(SPECTRUM, direction=0.0, seed=1.5), "seed"),
        (lambda: irregular(SPECTRUM, direction=0.0, seed=-1), "seed"),
        (lambda: irregular(SPECTRUM, direction=0.0, seed=[]), "seed"),
        (lambda: irregular(SPECTRUM, direction=0.0, seed=[3, 3]), "repeats"),
        (lambda: irregular(SPECTRUM, direction=0.0, seed="abc"), "seed"),
        (lambda: irregular(SPECTRUM, direction=0.0, n=0), "n: a whole"),
        (lambda: irregular(SPECTRUM, direction=0.0, n=10, duration=100.0), "n or duration"),
        (lambda: irregular(SPECTRUM, direction=0.0, duration=10.0), "at least 20"),
        (lambda: irregular(SPECTRUM, direction=0.0, duration=-5.0), "duration"),
        (lambda: irregular(SPECTRUM, direction=0.0, duration=900.0, method="equal-energy"), "equal-frequency"),
        (lambda: irregular(SPECTRUM, direction=0.0, method="fft"), "method"),
        (lambda: irregular(SPECTRUM, direction=0.0, random="no"), "random"),
        (lambda: irregular(SPECTRUM, direction=0.0, omega_range=(1.0, 0.5)), "omega_range"),
        (lambda: irregular(SPECTRUM, direction=0.0, omega_range=(0.001, 0.01)), "no energy"),
        (lambda: irregular(SPECTRUM, direction=0.0, spreading=10), "spreading"),
        (lambda: irregular(SPECTRUM, direction=0.0, spreading=spreading(s=5), n=5), "n_directions"),
        (lambda: irregular(SPECTRUM, direction=0.0, depth=-10.0), "depth"),
        (lambda: regular(direction=0.0, period=8.0), "exactly one of amplitude, height"),
        (lambda: regular(direction=0.0, amplitude=1.0, height=2.0, period=8.0), "amplitude, height found"),
        (lambda: regular(direction=0.0, amplitude=-1.0, period=8.0), "amplitude: a positive"),
        (lambda: regular(direction=0.0, amplitude=1.0, period=np.nan), "period: a positive"),
        (lambda: bichromatic(direction=0.0, amplitude=1.0, period=(8.0, 9.0)), "two numbers"),
        (lambda: Sea([0.5], [0.0], [1.0], [np.nan]), "finite"),
        (lambda: Sea([0.0], [0.0], [1.0], [0.0]), "> 0"),
        (lambda: Sea([0.5, 0.6], [0.0], [1.0], [0.0]), "as many"),
        (lambda: Sea([0.5], [0.0], [1.0, 2.0], [0.0]), "shape|expected"),
        (lambda: Sea([0.5], [0.0], [1.0], [0.0], period=10.0), "period"),
        (lambda: regular(height=1.0, period=8.0, direction=0.0).isel(0), "no axis"),
        (lambda: regular(height=1.0, period=8.0, direction=0.0).pressure(0.0, z=1.0), "z:"),
        (lambda: regular(height=1.0, period=8.0, direction=0.0).elevation([0.0, np.nan]), "t:"),
        (lambda: sea_from_record([0.0, 1.0, 2.5, 3.0], [0.0, 1.0, 0.0, -1.0], direction=0.0), "equally spaced"),
        (lambda: sea_from_record(np.arange(5.0), [0.0, 1.0, np.nan, 0.0, 1.0], direction=0.0), "1 NaN"),
        (lambda: sea_from_record(np.arange(5.0), np.zeros(4), direction=0.0), "sea_from_record"),
        (lambda: sea_from_record(np.arange(5.0), np.zeros(5), direction=0.0, taper=4.0), "taper"),
        (lambda: sea_from_record(np.arange(5.0), np.zeros(5), direction=0.0, omega_range=(9.0, 10.0)), "no component"),
    ],
)
def test_bad_input_is_named(call, words):
    with pytest.raises(InputError, match=words):
        call()
