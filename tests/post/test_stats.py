"""Statistics: exact values of known series, coverage of the intervals over many Gaussian series, extremes, spectra."""

import numpy as np
import pytest
import xarray as xr
from scipy import stats as reference

from ogilvie.errors import InputError
from ogilvie.post.stats import cycles, fit_gumbel, fit_rayleigh, fit_weibull, spectral_density, summary
from ogilvie.waves.sea import irregular
from ogilvie.waves.spectra import jonswap

SEA = jonswap(hs=4.0, tp=10.0)
DT = 0.5


def gaussian(spectrum, duration, dt, count, seed):
    """Records (count, n_t) of a Gaussian process, cut from periodic ones eight times as long."""
    rng = np.random.default_rng(seed)
    n = int(8 * duration / dt)
    step = 2 * np.pi / (n * dt)
    k = np.arange(1, n // 2)
    F = np.zeros((count, n // 2 + 1), dtype=complex)
    F[:, 1 : n // 2] = np.sqrt(spectrum(k * step) * step) * (
        rng.normal(size=(count, len(k))) - 1j * rng.normal(size=(count, len(k)))
    )
    return np.fft.irfft(F, n=n, axis=1)[:, : int(duration / dt)] * n / 2


# ---------------------------------------------------------------------------------------------------- exact values


def test_a_sine():
    t = np.arange(0, 1000, 0.1)
    result = summary(0.7 + 2.0 * np.sin(2 * np.pi * t / 8.0 + 0.3), dt=0.1)
    assert float(result["mean"]) == pytest.approx(0.7, abs=1e-10)
    assert float(result["std"]) == pytest.approx(np.sqrt(2), rel=1e-9)
    assert float(result.significant) == pytest.approx(4 * np.sqrt(2), rel=1e-9)
    assert float(result.significant_third) == pytest.approx(4.0, rel=1e-3)
    assert float(result.maximum) == pytest.approx(2.7, rel=1e-3)
    assert float(result.minimum) == pytest.approx(-1.3, rel=1e-3)
    assert float(result.tz) == pytest.approx(8.0, rel=1e-6)
    assert float(result.cycles) == 124
    assert float(result.most_probable_maximum) == pytest.approx(np.sqrt(2) * np.sqrt(2 * np.log(125)), rel=1e-6)
    assert result.attrs["duration"] == pytest.approx(1000.0)


def test_skip_leaves_out_the_start():
    t = np.arange(0, 400, 0.5)
    x = np.where(t < 100, 50.0, np.sin(t))
    result = summary(x, dt=0.5, skip=100.0)
    assert abs(float(result["mean"])) < 0.01
    assert result.attrs["duration"] == pytest.approx(300.0)


def test_cycles_by_hand():
    x = np.array([-1.0, 1.0, 3.0, -1.0, -3.0, 1.0, 2.0, -2.0, -1.0, 1.0])
    found = cycles(x, 1.0, level=0.0)
    np.testing.assert_allclose(found.starts, [0.5, 4.75])
    np.testing.assert_allclose(found.periods, [4.25, 3.75])
    np.testing.assert_array_equal(found.crests, [3.0, 2.0])
    np.testing.assert_array_equal(found.troughs, [-3.0, -2.0])
    np.testing.assert_array_equal(found.double_amplitudes, [6.0, 4.0])
    assert np.isnan(found.significant)
    assert len(cycles(np.ones(20), 1.0).periods) == 0


def test_dimensions_follow_the_run():
    t = np.arange(0, 300, 0.5)
    rng = np.random.default_rng(0)
    eta = rng.normal(size=(4, len(t), 2))
    run = xr.Dataset(
        {"eta": (("realisation", "time", "dof"), eta)}, coords={"time": t, "dof": ["heave", "pitch"], "realisation": range(4)}
    )
    result = summary(run)
    assert result["std"].dims == ("dof",)
    assert result.std_interval.dims == ("dof", "bound")
    assert result.attrs["realisations"] == 4
    for i, dof in enumerate(("heave", "pitch")):
        alone = summary(eta[:, :, i], dt=0.5)
        for key in alone.data_vars:
            np.testing.assert_allclose(result[key].sel(dof=dof), alone[key])
    single = summary(run.isel(realisation=0))
    assert single["std"].sel(dof="heave") == pytest.approx(eta[0, :, 0].std())
    S = spectral_density(run)
    assert S.density.dims == ("dof", "omega")


# ---------------------------------------------------------------------------------------------------- Gaussian seas


def test_a_sea_returns_its_spectrum():
    sea = irregular(SEA, direction=np.pi, duration=1800.0, seed=range(40))
    result = summary(sea.elevation(np.arange(0, 1800, DT)), dt=DT)
    assert float(result.significant) == pytest.approx(4.0, rel=2e-3)
    assert float(result.tz) == pytest.approx(
        2 * np.pi * np.sqrt(SEA.moment(0, omega_range=(0.3, 2.8)) / SEA.moment(2, omega_range=(0.3, 2.8))), rel=0.01
    )
    assert float(result.significant_third) == pytest.approx(0.945 * 4.0, rel=0.02)  # H_1/3 is 5 to 6 % below 4 std in wind seas
    expected = float(result["std"]) * (
        np.sqrt(2 * np.log(1800 / float(result.tz))) + 0.5772 / np.sqrt(2 * np.log(1800 / float(result.tz)))
    )
    low, high = result.expected_maximum_interval.values
    assert low < expected * 1.03
    assert high > expected * 0.97


@pytest.mark.parametrize(
    ("duration", "least"),
    [(300.0, 0.92), (1200.0, 0.93), (3600.0, 0.93)],
)
def test_intervals_from_one_record_cover_the_truth(duration, least):
    records = gaussian(SEA, duration, 1.0, 300, seed=11)
    truth = SEA.hs / 4
    inside = np.zeros(2)
    for x in records:
        result = summary(x, dt=1.0)
        low, high = result.std_interval.values
        inside += [low < truth < high, result.mean_interval.values[0] < 0.0 < result.mean_interval.values[1]]
    assert least <= inside[0] / 300 <= 0.98
    assert inside[1] / 300 >= 0.93  # conservative: the mean of a wave record scatters by its ends alone


def test_intervals_of_a_slow_resonance_cover_the_truth():
    """Surge on its moorings, 100 s and 5 % of critical damping: an hour holds 36 cycles that remember each other."""
    w_n, ratio = 2 * np.pi / 100, 0.05

    def spectrum(w):
        return 1e-6 / ((w_n**2 - w**2) ** 2 + (2 * ratio * w_n * w) ** 2)

    w = np.linspace(0, 3, 300001)
    truth = np.sqrt(np.trapezoid(spectrum(w), w))
    records = gaussian(spectrum, 3600.0, 2.0, 250, seed=21)
    inside = np.zeros(2)
    for x in records:
        result = summary(x, dt=2.0)
        inside += [
            result.std_interval.values[0] < truth < result.std_interval.values[1],
            result.mean_interval.values[0] < 0.0 < result.mean_interval.values[1],
        ]
    assert np.all(inside / 250 > 0.92), inside / 250
    assert np.all(inside / 250 < 0.99), inside / 250


def test_intervals_of_a_broad_low_frequency_process_cover_the_truth():
    def spectrum(w):
        return np.exp(-w / 0.3)

    records = gaussian(spectrum, 2400.0, 1.0, 300, seed=3)
    truth = np.sqrt(0.3)
    inside = np.zeros(2)
    for x in records:
        result = summary(x, dt=1.0)
        inside += [
            result.std_interval.values[0] < truth < result.std_interval.values[1],
            result.mean_interval.values[0] < 0.0 < result.mean_interval.values[1],
        ]
    assert np.all(inside / 300 > 0.91), inside / 300
    assert np.all(inside / 300 < 0.985), inside / 300


def test_intervals_from_realisations_cover_the_truth():
    records = gaussian(SEA, 600.0, 1.0, 200 * 15, seed=5).reshape(200, 15, -1)
    truth = SEA.hs / 4
    inside = 0
    widths = []
    for x in records:
        low, high = summary(x, dt=1.0).std_interval.values
        inside += low < truth < high
        widths.append((high - low) / truth)
    assert 0.90 <= inside / 200 <= 0.985
    assert np.mean(widths) == pytest.approx(2 * 2.14 / np.sqrt(2 * 15 * 82), rel=0.25)  # 82 independent harmonics in 10 minutes


def test_more_data_narrow_the_interval_as_the_square_root():
    x = gaussian(SEA, 7200.0, 1.0, 8, seed=2)
    one = np.mean([np.ptp(summary(row[:1800], dt=1.0).std_interval.values) for row in x])
    four = np.mean([np.ptp(summary(row, dt=1.0).std_interval.values) for row in x])
    pooled = np.mean([np.ptp(summary(x[i : i + 4, :1800], dt=1.0).std_interval.values) for i in (0, 4)])
    assert one / four == pytest.approx(2.0, rel=0.1)
    assert one / pooled == pytest.approx(2.0, rel=0.15)


# ---------------------------------------------------------------------------------------------------- spectra


def test_spectrum_is_that_of_scipy():
    from scipy.signal import welch

    x = gaussian(SEA, 2000.0, DT, 1, seed=9)[0]
    ours = spectral_density(x, dt=DT, segment=250.0)
    f, P = welch(x, 1 / DT, "hann", nperseg=500, noverlap=250, detrend="constant")
    np.testing.assert_allclose(ours.omega, 2 * np.pi * f, rtol=1e-12)
    np.testing.assert_allclose(ours.density, P / (2 * np.pi), rtol=1e-9)


def test_spectrum_interval_covers_the_truth():
    x = gaussian(SEA, 3600.0, DT, 20, seed=8)
    inside, count = 0, 0
    for row in x:
        S = spectral_density(row, dt=DT, segment=400.0)
        band = (S.omega > 0.7) & (S.omega < 1.5)  # where the spectrum is flat over the width of the window
        truth = SEA(S.omega.values)
        hit = (S.interval.sel(bound="low") < truth) & (truth < S.interval.sel(bound="high"))
        inside, count = inside + int(hit[band].sum()), count + int(band.sum())
    assert inside / count == pytest.approx(0.95, abs=0.025)


# ---------------------------------------------------------------------------------------------------- extremes


@pytest.mark.parametrize(
    ("fit", "draw", "truth"),
    [
        (fit_rayleigh, lambda rng, n: rng.rayleigh(2.0, n), lambda p: 2.0 * np.sqrt(-2 * np.log1p(-p))),
        (fit_weibull, lambda rng, n: 2.0 * rng.weibull(1.4, n), lambda p: 2.0 * (-np.log1p(-p)) ** (1 / 1.4)),
        (fit_gumbel, lambda rng, n: rng.gumbel(10.0, 1.5, n), lambda p: 10.0 - 1.5 * np.log(-np.log(p))),
    ],
    ids=["rayleigh", "weibull", "gumbel"],
)
def test_quantile_intervals_cover_the_truth(fit, draw, truth):
    rng, p, inside = np.random.default_rng(17), 0.99, 0
    for _ in range(400):
        low, high = fit(draw(rng, 80)).interval(p)
        inside += low < truth(p) < high
    assert 0.915 <= inside / 400 <= 0.98


def test_fits_are_those_of_scipy():
    rng = np.random.default_rng(2)
    x = 2.0 * rng.weibull(1.7, 300)
    shape, _, scale = reference.weibull_min.fit(x, floc=0)
    ours = fit_weibull(x)
    assert (ours.shape, ours.scale) == (pytest.approx(shape, rel=1e-4), pytest.approx(scale, rel=1e-4))
    y = rng.gumbel(5.0, 0.7, 200)
    location, scale = reference.gumbel_r.fit(y)
    ours = fit_gumbel(y)
    assert (ours.location, ours.scale) == (pytest.approx(location, rel=1e-4), pytest.approx(scale, rel=1e-4))


def test_crests_of_a_narrow_sea_are_rayleigh_distributed():
    narrow = jonswap(hs=4.0, tp=10.0, sigma=(0.02, 0.02), gamma=7.0)
    sea = irregular(narrow, direction=0.0, duration=7200.0, seed=range(6), omega_range=(0.5, 0.8))
    crests = np.concatenate([cycles(row, DT).crests for row in sea.elevation(np.arange(0, 7200, DT))])
    fit = fit_rayleigh(crests)
    assert fit.scale == pytest.approx(float(sea.hs[0]) / 4, rel=0.02)
    assert fit_weibull(crests).shape == pytest.approx(2.0, abs=0.1)
    value, low, high = fit.maximum_of(1000)
    assert low < value < high
    assert value == pytest.approx(fit.scale * np.sqrt(2 * np.log(1000)), rel=1e-12)


# ---------------------------------------------------------------------------------------------------- bad input


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: summary(np.ones(100)), "dt: the time step"),
        (lambda: summary(np.ones(100), dt=0.0), "dt"),
        (lambda: summary(np.ones((2, 3, 100)), dt=0.1), "shape"),
        (lambda: summary(np.r_[np.ones(99), np.nan], dt=0.1), "1 NaN"),
        (lambda: summary(np.ones(100), dt=0.1, skip=9.9), "at least 16 times"),
        (lambda: summary(np.ones(100), dt=0.1, skip=-1.0), "skip"),
        (lambda: summary(np.ones(100), dt=0.1, confidence=95), "confidence"),
        (lambda: summary(xr.Dataset({"nu": ("time", np.ones(20))})), "variable: one of nu expected"),
        (lambda: summary(xr.DataArray(np.ones(20), dims="x")), "dimension 'time'"),
        (lambda: summary(xr.DataArray(np.ones(20), dims="time", coords={"time": np.arange(20.0) ** 2})), "equal steps"),
        (lambda: spectral_density(np.ones(100), dt=0.1, segment=50.0), "segment"),
        (lambda: fit_rayleigh([1.0, -1.0]), "peaks"),
        (lambda: fit_weibull([1.0, 1.0, 1.0, 1.0, 1.0]), "differ"),
        (lambda: fit_gumbel([1.0, 2.0]), "maxima"),
        (lambda: fit_rayleigh([1.0, 2.0]).quantile(1.0), "probability"),
        (lambda: fit_rayleigh([1.0, 2.0]).maximum_of(0.5), "n:"),
        (lambda: cycles(np.ones((2, 2)), 0.1), "cycles"),
    ],
)
def test_bad_input_is_named(call, words):
    with pytest.raises(InputError, match=words):
        call()
