"""Gust spectra against their integrals, the profile against the standard's other units, and series against the spectrum."""

from math import gamma, log, pi, sqrt

import numpy as np
import pytest
from scipy.integrate import quad

from ogilvie.errors import InputError
from ogilvie.units import deg
from ogilvie.waves.gust import GustSpectrum, api_gust, davenport_gust, harris_gust, npd_gust
from ogilvie.waves.wind import Wind, blowing_from

FOOT = 0.3048
SPECTRA = {
    "npd": npd_gust(25.0, height=30.0),
    "api": api_gust(25.0, height=30.0),
    "davenport": davenport_gust(25.0, drag=0.002),
    "harris": harris_gust(25.0, drag=0.002),
}


@pytest.mark.parametrize("spectrum", SPECTRA.values(), ids=SPECTRA.keys())
def test_variance_is_the_integral_of_the_spectrum(spectrum):
    def per_log(s):
        return float(spectrum(np.exp(s))) * np.exp(s)

    for low, high in ((1e-9, 1e6), (0.01, 3.0), (0.3, 0.31)):
        integral = quad(per_log, log(low), log(high), limit=400, epsabs=1e-13, epsrel=1e-12)[0]
        assert float(spectrum.variance(low, high)) == pytest.approx(integral, rel=1e-9)
    assert spectrum.deviation**2 == pytest.approx(float(spectrum.variance(0.0, np.inf)), rel=1e-14)


def test_closed_forms_of_the_variance():
    U, k = 25.0, 0.002
    assert api_gust(U, height=10.0).deviation == pytest.approx(0.15 * U * 0.5**-0.125, rel=1e-12)
    assert api_gust(U, height=60.0).deviation == pytest.approx(0.15 * U * 3.0**-0.275, rel=1e-12)
    assert float(davenport_gust(U, drag=k).variance()) == pytest.approx(6.0 * k * U**2, rel=1e-12)
    harris = 4.0 * 2.0 ** (-1 / 3) * sqrt(pi) * gamma(1 / 3) / (2.0 * gamma(5 / 6))
    assert float(harris_gust(U, drag=k).variance()) == pytest.approx(harris * k * U**2, rel=1e-12)


def test_davenport_peaks_where_it_should():
    U, L = 20.0, 1200.0
    f = np.geomspace(1e-4, 1.0, 20001)
    fS = f * davenport_gust(U, drag=0.002)(2 * pi * f)
    assert f[fS.argmax()] == pytest.approx(sqrt(3.0) * U / L, rel=1e-3)  # d/dX of X^2 (1 + X^2)^(-4/3)


def test_npd_spectrum_of_the_standard_in_feet():
    """API RP 2A-WSD 2.3.2 in feet: 3444 ft2/s2/Hz (U/32.8 ft/s)^2 (z/32.8 ft)^0.45, F = 172 f (z/32.8)^(2/3) (U/32.8)^-0.75."""
    U, z, n = 80.0, 100.0, 0.468
    for f in (0.002, 0.02, 0.3):
        F = 172.0 * f * (z / 32.8) ** (2 / 3) * (U / 32.8) ** -0.75
        S = 3444.0 * (U / 32.8) ** 2 * (z / 32.8) ** 0.45 / (1.0 + F**n) ** (5 / (3 * n))
        ours = 2 * pi * float(npd_gust(U * FOOT, height=z * FOOT)(2 * pi * f)) / FOOT**2
        assert ours == pytest.approx(S, rel=1e-3)


def test_npd_profile_of_the_standard_in_feet():
    """API RP 2A-WSD 2.3.2 in feet: C = 0.0573 sqrt(1 + 0.0457 U), I = 0.06 (1 + 0.0131 U) (z/32.8)^-0.22."""
    U = 80.0
    wind = Wind(U * FOOT, 0.0)
    for z in (20.0, 32.8, 100.0, 300.0):
        hour = U * (1.0 + 0.0573 * sqrt(1.0 + 0.0457 * U) * log(z / 32.8))
        assert wind.mean(z * FOOT) / FOOT == pytest.approx(hour, rel=2e-4)
        for t in (3.0, 60.0, 600.0):
            gust = hour * (1.0 - 0.41 * 0.06 * (1.0 + 0.0131 * U) * (z / 32.8) ** -0.22 * log(t / 3600.0))
            assert wind.sustained(t, z * FOOT) / FOOT == pytest.approx(gust, rel=5e-4)
    assert wind.sustained(3600.0, 30.0) == wind.mean(30.0)


def test_npd_spectrum_agrees_with_the_turbulence_intensity_of_its_profile():
    """Two fits of one set of measurements: the deviation from the spectrum's range of validity against I U, within 12 %."""
    for U in (15.0, 25.0, 35.0):
        intensity = 0.06 * (1.0 + 0.043 * U)
        deviation = sqrt(npd_gust(U).variance(2 * pi / 3600, 2 * pi * 0.5))
        assert deviation == pytest.approx(intensity * U, rel=0.12)


def test_a_speed_at_another_height_is_brought_to_ten_metres():
    at_ten = Wind(22.0, 0.0)
    for z in (3.0, 25.0, 80.0):
        same = Wind(at_ten.mean(z), 0.0, reference_height=z)
        assert same.speed_10 == pytest.approx(22.0, rel=1e-12)
        assert same.mean(40.0) == pytest.approx(at_ten.mean(40.0), rel=1e-12)
        assert same.mean(z) == pytest.approx(at_ten.mean(z), rel=1e-12)
    power = Wind(20.0, 0.0, profile="power", exponent=0.11, reference_height=30.0)
    assert power.mean(30.0) == 20.0
    assert power.speed_10 == pytest.approx(20.0 * 3.0**-0.11)
    assert Wind(20.0, 0.0, profile="uniform").mean(77.0) == 20.0
    assert Wind(0.0, 0.0).mean(50.0) == 0.0


@pytest.mark.parametrize("gust", ["npd", "api", davenport_gust(20.0, drag=0.003)])
def test_each_component_of_a_series_has_the_variance_of_its_band(gust):
    wind = Wind(20.0, 0.0, gust=gust, seed=[3, 8], period=1200.0, step=0.5)
    u, spectrum = wind.gusts(20.0), wind.spectrum(20.0)
    n = u.shape[1]
    power = 2.0 * np.abs(np.fft.rfft(u) / n) ** 2
    k = np.arange(1, n // 4 + 1)
    band = spectrum.variance((k - 0.5) * 2 * pi / 1200.0, (k + 0.5) * 2 * pi / 1200.0)
    assert power[:, k] == pytest.approx(np.tile(band, (2, 1)), rel=1e-9)
    assert power[:, n // 4 + 1 :].max() < 1e-20
    assert np.abs(u.mean(axis=1)).max() < 1e-12
    whole = spectrum.variance(pi / 1200.0, (k[-1] + 0.5) * 2 * pi / 1200.0)
    assert u.var(axis=1) == pytest.approx([whole, whole], rel=1e-10)


def test_spectral_density_of_many_series_is_the_target():
    """Welch's estimate of 40 realisations, whose windows do not divide the period, within the scatter of the estimate."""
    from scipy.signal import welch

    wind = Wind(20.0, 0.0, gust="npd", seed=range(40), period=3600.0, step=0.5)
    f, S = welch(wind.gusts(10.0), fs=2.0, nperseg=1000, axis=-1)
    inside = (f > 0.02) & (f < 0.45)
    target = 2 * pi * wind.spectrum(10.0)(2 * pi * f[inside])
    ratio = S.mean(axis=0)[inside] / target
    assert ratio.mean() == pytest.approx(1.0, abs=0.01)
    assert np.abs(ratio - 1.0).max() < 0.3


def test_a_realisation_depends_on_its_seed_alone():
    many = Wind(20.0, 0.0, gust="npd", seed=range(5), period=600.0).gusts(10.0)
    one = Wind(20.0, 0.0, gust="npd", seed=3, period=600.0).gusts(10.0)
    assert np.array_equal(many[3], one[0])
    assert abs(np.corrcoef(many[0], many[1])[0, 1]) < 0.3
    assert Wind(20.0, 0.0, seed=range(5)).n_realisations == 1


@pytest.mark.parametrize(
    ("bearing", "north", "to"),
    [(0, 90, -90), (90, 90, 180), (270, 90, 0), (225, 90, 45), (0, 0, 180), (180, 0, 0), (270, 0, -90)],
)
def test_meteorological_bearings(bearing, north, to):
    """A north wind blows south; +x is East where North is at 90 deg, North where it is at 0."""
    assert blowing_from(bearing * deg, north=north * deg) / deg == pytest.approx(to)


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: Wind(-1.0, 0.0),
        lambda: Wind(float("nan"), 0.0),
        lambda: Wind(20.0, 180.0),
        lambda: Wind(20.0, [0.0, 1.0]),
        lambda: Wind(20.0, 0.0, profile="log"),
        lambda: Wind(20.0, 0.0, gust="kaimal"),
        lambda: Wind(0.0, 0.0, gust="npd"),
        lambda: Wind(20.0, 0.0, period=100.0, step=0.3),
        lambda: Wind(20.0, 0.0, period=1.0, step=0.5),
        lambda: Wind(20.0, 0.0, seed=[1, 1]),
        lambda: Wind(20.0, 0.0, seed=-1),
        lambda: Wind(20.0, 0.0, reference_height=0.0),
        lambda: Wind(20.0, 0.0).mean(-5.0),
        lambda: Wind(20.0, 0.0).sustained(7200.0, 10.0),
        lambda: Wind(20.0, 0.0, profile="power").sustained(60.0, 10.0),
        lambda: Wind(20.0, 0.0).mean(1e-4),
        lambda: npd_gust(0.0),
        lambda: api_gust(20.0, height=-1.0),
        lambda: npd_gust(20.0)(-1.0),
        lambda: npd_gust(20.0).variance(-1.0, 2.0),
        lambda: GustSpectrum("endless", 1.0, 1.0, rise=1.0, offset=1.0, power=1.0, fall=2.0),
        lambda: blowing_from(225.0),
    ],
)
def test_bad_input_is_refused(wrong):
    with pytest.raises(InputError):
        wrong()
