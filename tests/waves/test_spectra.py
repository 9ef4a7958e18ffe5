"""Spectra: exact Hs, moments against gamma functions and quadrature, published ratios, quantiles, an independent package."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import gamma as gamma_function

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.waves.double_peak import ochi_hubble, ochi_hubble_family, torsethaugen
from ogilvie.waves.spectra import bretschneider, jonswap, pierson_moskowitz, spectrum_from_table

OMEGA = np.linspace(0.15, 6.0, 3000)
MANY = [
    jonswap(hs=4.25, tp=9.8),
    jonswap(hs=2.0, tp=6.0, gamma=7.0),
    bretschneider(hs=3.0, tp=12.0),
    pierson_moskowitz(wind_speed=20.0),
    torsethaugen(hs=3.0, tp=14.0),
    torsethaugen(hs=3.0, tp=8.0, model="1996"),
    torsethaugen(hs=0.5, tp=16.0, model="1996"),
    ochi_hubble(hs1=3.0, tp1=14.0, lambda1=3.0, hs2=2.0, tp2=8.0, lambda2=1.5),
    ochi_hubble_family(hs=5.0)[0],
    spectrum_from_table([0.3, 0.5, 0.9, 1.4], [0.0, 3.0, 1.0, 0.0]),
    jonswap(hs=2.0, tp=6.0) + bretschneider(hs=1.0, tp=14.0),
]
by_name = pytest.mark.parametrize("sea", MANY, ids=lambda sea: sea.name)


@by_name
def test_hs_is_four_root_of_the_numerical_integral(sea):
    edges = np.geomspace(0.05, 200.0, 60)
    m0 = sum(quad(sea, a, b, epsabs=1e-13, limit=200)[0] for a, b in pairwise(edges))
    tail = sea.m0 - float(sea.cumulative(200.0))
    assert 4 * np.sqrt(m0 + tail) == pytest.approx(sea.hs, rel=1e-9)
    assert sea.cumulative(1e9) == pytest.approx(sea.m0, rel=1e-11)


@settings(max_examples=60, deadline=None)
@given(st.floats(0.05, 20.0), st.floats(2.0, 25.0), st.floats(1.0, 7.0))
def test_jonswap_has_the_hs_and_peak_asked_for(hs, tp, gamma):
    sea = jonswap(hs=hs, tp=tp, gamma=gamma)
    assert sea.hs == pytest.approx(hs, rel=1e-14)
    wp = 2 * np.pi / tp
    around = wp * np.linspace(0.8, 1.2, 401)
    assert around[np.argmax(sea(around))] == pytest.approx(wp, rel=2e-3)
    # the approximation of the codes for the normalisation
    approximate = 5 / 16 * hs**2 / wp * np.exp(-1.25) * gamma * (1 - 0.287 * np.log(gamma))
    assert sea(wp) == pytest.approx(approximate, rel=0.02)


def test_bretschneider_moments_are_gamma_functions():
    sea, wp = bretschneider(hs=4.0, tp=10.0), 0.2 * np.pi
    for n in (-1, 0, 1, 2, 3):
        assert sea.moment(n) == pytest.approx(gamma_function(1 - n / 4) * 1.25 ** (n / 4) * wp**n, rel=1e-14)
    assert sea.m4 == np.inf
    assert np.isfinite(sea.moment(4, omega_range=(0.0, 5.0)))


def test_published_period_ratios():
    # DNV-RP-C205 (2010), 3.5.5.4: Tz/Tp = 0.6673 + 0.05037 g - 0.006230 g^2 + 0.0003341 g^3; T1/Tp the like with 0.7303 ...
    for gamma in (1.0, 2.0, 3.3, 5.0, 7.0):
        sea = jonswap(hs=3.0, tp=10.0, gamma=gamma)
        g = gamma
        assert sea.tz / sea.tp == pytest.approx(0.6673 + 0.05037 * g - 0.006230 * g**2 + 0.0003341 * g**3, abs=0.012)
        assert sea.t1 / sea.tp == pytest.approx(0.7303 + 0.04936 * g - 0.006556 * g**2 + 0.0003610 * g**3, abs=0.012)


@by_name
def test_cumulative_and_quantile_are_inverse_and_right(sea):
    p = np.array([1e-6, 1e-3, 0.1, 0.5, 0.9, 0.99])
    w = sea.quantile(p)
    np.testing.assert_allclose(sea.cumulative(w) / sea.m0, p, rtol=1e-9)
    assert np.all(np.diff(w) > 0)
    between = quad(sea, w[2], w[4], points=[w[3]], epsabs=1e-14, limit=400)[0]
    assert between == pytest.approx(0.8 * sea.m0, rel=1e-6)
    assert sea.moment(0, omega_range=(float(w[2]), float(w[4]))) == pytest.approx(0.8 * sea.m0, rel=1e-12)


@pytest.mark.parametrize("key", ["tp", "tz", "t1"])
@pytest.mark.parametrize("gamma", [1.0, 3.3, 6.0])
def test_any_period_may_be_given(key, gamma):
    assert getattr(jonswap(hs=2.0, gamma=gamma, **{key: 7.0}), key) == pytest.approx(7.0, rel=1e-13)
    assert getattr(bretschneider(hs=2.0, **{key: 7.0}), key) == pytest.approx(7.0, rel=1e-13)


def test_gamma_from_steepness():
    # DNV-RP-C205 (2010), 3.5.5.5
    assert jonswap(hs=9.0, tp=10.5, gamma=None).parts[0].gamma == 5.0
    assert jonswap(hs=4.0, tp=8.4, gamma=None).parts[0].gamma == pytest.approx(np.exp(5.75 - 1.15 * 4.2))
    assert jonswap(hs=4.0, tp=12.0, gamma=None).parts[0].gamma == 1.0


def test_pierson_moskowitz_of_1964():
    sea, U, g = pierson_moskowitz(wind_speed=15.0), 15.0, 9.80665
    w = np.linspace(0.2, 3.0, 50)
    np.testing.assert_allclose(sea(w), 0.0081 * g**2 / w**5 * np.exp(-0.74 * (g / (U * w)) ** 4), rtol=1e-12)
    for key in ("hs", "tp", "tz", "t1"):
        same = pierson_moskowitz(**{key: getattr(sea, key)})
        assert same.hs == pytest.approx(sea.hs, rel=1e-12)
        assert same.tp == pytest.approx(sea.tp, rel=1e-12)
    np.testing.assert_array_equal(pierson_moskowitz(hs=3.0, tp=9.0)(w), bretschneider(hs=3.0, tp=9.0)(w))


@settings(max_examples=80, deadline=None)
@given(st.floats(0.3, 15.0), st.floats(3.0, 24.0), st.sampled_from(["2004", "1996"]))
def test_torsethaugen_shares_energy(hs, tp, model):
    sea = torsethaugen(hs=hs, tp=tp, model=model)
    assert sea.hs == pytest.approx(hs, rel=1e-13)
    assert sea.parts[0].tp == tp
    share = (sea.parts[0].hs / hs) ** 2
    assert 0.6**2 - 1e-9 <= share <= 1 + 1e-12
    assert all(part.gamma >= 1.0 for part in sea.parts)


def test_torsethaugen_meets_at_the_border_and_is_jonswap_there():
    hs = 6.0
    tf = 6.6 * hs ** (1 / 3)
    below, above = torsethaugen(hs=hs, tp=tf * (1 - 1e-9)), torsethaugen(hs=hs, tp=tf * (1 + 1e-9))
    assert below.parts[0].hs == pytest.approx(hs, rel=1e-9)
    np.testing.assert_allclose(below(OMEGA), above(OMEGA), atol=1e-6 * below(OMEGA).max())
    # published: gamma = 35 (2 pi Hs / (g Tf^2))^(6/7)
    assert below.parts[0].gamma == pytest.approx(35 * (2 * np.pi * hs / 9.80665 / tf**2) ** (6 / 7), rel=1e-6)


def test_torsethaugen_1996_of_dnv_by_hand():
    # DNV-RP-C205 (2010), A.1, swell-dominated: Hs = 4 m, Tp = 16 s
    hs, tp = 4.0, 16.0
    primary, secondary = torsethaugen(hs=hs, tp=tp, model="1996", g=9.81).parts
    tf = 6.6 * 4 ** (1 / 3)
    eps = (16 - tf) / (25 - tf)
    rps = 0.6 + 0.4 * np.exp(-((eps / 0.3) ** 2))
    assert primary.hs == pytest.approx(rps * hs, rel=1e-13)
    assert primary.tail == secondary.tail == 0.5 * 2 + 3.2
    assert secondary.width == pytest.approx(4 * (1 - 0.7 * np.exp(-4 / 3)))
    gamma = 35 * (1 + 3.5 * np.exp(-4)) * (2 * np.pi / 9.81 * hs / tf**2) ** (6 / 7) * (1 + 6 * eps)
    assert primary.gamma == pytest.approx(gamma, rel=1e-12)
    # the secondary peak's period puts the wind sea on the equilibrium tail: E G0 (0.4)^N-law of the standard
    N, M = secondary.tail, secondary.width
    G0 = 1 / ((1 / M) * (N / M) ** (-(N - 1) / M) * gamma_function((N - 1) / M))
    s4 = max(0.01, 0.08 * (1 - np.exp(-hs / 3)))
    tp2 = max(2.5, (16 * s4 * 0.4**N / (G0 * secondary.hs**2)) ** (-1 / (N - 1)))
    assert secondary.tp == pytest.approx(tp2, rel=1e-12)


def test_ochi_hubble_is_the_published_formula():
    sea = ochi_hubble(hs1=3.0, tp1=14.0, lambda1=3.0, hs2=2.0, tp2=8.0, lambda2=1.5)
    w = OMEGA
    expected = np.zeros_like(w)
    for hs, tp, lam in ((3.0, 14.0, 3.0), (2.0, 8.0, 1.5)):
        wm = 2 * np.pi / tp
        a = (4 * lam + 1) / 4
        expected += 0.25 * (a * wm**4) ** lam / gamma_function(lam) * hs**2 / w ** (4 * lam + 1) * np.exp(-a * (wm / w) ** 4)
    np.testing.assert_allclose(sea(w), expected, rtol=1e-11)


def test_most_probable_ochi_hubble():
    family = ochi_hubble_family(hs=4.0)
    assert len(family) == 11
    assert all(sea.hs == pytest.approx(4.0, rel=1e-13) for sea in family)
    low, high = family[0].parts
    assert 2 * np.pi / low.tp == pytest.approx(0.70 * np.exp(-0.046 * 4))
    assert 2 * np.pi / high.tp == pytest.approx(1.15 * np.exp(-0.039 * 4))
    assert (low.tail - 1) / 4 == 3.0
    assert (high.tail - 1) / 4 == pytest.approx(1.54 * np.exp(-0.062 * 4))
    assert low.hs == pytest.approx(0.84 * 4, rel=2e-3)


def test_against_waveresponse():
    wr = pytest.importorskip("waveresponse")
    _, b = wr.ModifiedPiersonMoskowitz(OMEGA)(3.0, 9.0)
    np.testing.assert_allclose(bretschneider(hs=3.0, tp=9.0)(OMEGA), b, rtol=1e-12)
    _, j = wr.JONSWAP(OMEGA)(3.0, 9.0, gamma=2.5)  # same shape; its scale is the approximation of the codes
    ratio = j / jonswap(hs=3.0, tp=9.0, gamma=2.5)(OMEGA)
    assert np.ptp(ratio) < 1e-12
    assert ratio[0] == pytest.approx(1.0, abs=0.01)
    for hs, tp in ((3.0, 14.0), (3.0, 8.0), (8.0, 12.0), (1.0, 5.0)):
        _, t = wr.Torsethaugen(OMEGA)(hs, tp)  # the same two shapes; the published regressions scale them
        peaks = np.stack([part.density(OMEGA) for part in torsethaugen(hs=hs, tp=tp).parts], axis=1)
        scales, *_ = np.linalg.lstsq(peaks, t)
        assert np.abs(peaks @ scales - t).max() < 1e-9 * t.max()
        assert scales[0] == pytest.approx(1.0, abs=0.04)
        assert scales[1] == pytest.approx(3.26 * gamma_function(0.75) / 4, rel=1e-6)  # 3.26 for 4 / Gamma(3/4)
    _, o = wr.OchiHubble(OMEGA)(3.0, 14.0, 3.0)
    np.testing.assert_allclose(ochi_hubble(hs1=3.0, tp1=14, lambda1=3.0, hs2=1e-9, tp2=9, lambda2=1)(OMEGA), o, rtol=1e-9)


def test_table_is_linear_and_its_moments_exact():
    w, S = np.array([0.4, 0.5, 0.8, 1.0]), np.array([0.0, 2.0, 1.0, 0.0])
    sea = spectrum_from_table(w, S)
    assert sea.m0 == pytest.approx(np.trapezoid(S, w), rel=1e-14)
    assert sea(0.45) == pytest.approx(1.0)
    assert sea(0.39) == sea(1.1) == 0.0
    assert sea.tp == pytest.approx(2 * np.pi / 0.5, rel=1e-6)
    m2 = sum(quad(lambda x: x**2 * np.interp(x, w, S), a, b)[0] for a, b in pairwise(w))
    assert sea.m2 == pytest.approx(m2, rel=1e-13)


def test_spectra_add():
    a, b = jonswap(hs=3.0, tp=8.0), bretschneider(hs=4.0, tp=15.0)
    both = a + b
    np.testing.assert_array_equal(both(OMEGA), a(OMEGA) + b(OMEGA))
    assert both.hs == pytest.approx(5.0)
    assert both.m2 == pytest.approx(a.m2 + b.m2)


def test_froude_scaling():
    scale = 40.0
    full, model = jonswap(hs=4.0, tp=10.0), jonswap(hs=4.0 / scale, tp=10.0 / np.sqrt(scale))
    w = np.linspace(0.3, 2.0, 40)
    np.testing.assert_allclose(model(w * np.sqrt(scale)), full(w) / scale**2.5, rtol=1e-12)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: jonswap(hs=-1.0, tp=8.0), "hs: a positive"),
        (lambda: jonswap(hs=0.0, tp=8.0), "hs: a positive"),
        (lambda: jonswap(hs=np.nan, tp=8.0), "hs: a positive"),
        (lambda: jonswap(hs=1.0, tp=0.0), "tp: a positive"),
        (lambda: jonswap(hs=1.0, tp=np.inf), "tp: a positive"),
        (lambda: jonswap(hs=1.0), "exactly one of tp, tz, t1"),
        (lambda: jonswap(hs=1.0, tp=8.0, tz=6.0), "tp, tz found"),
        (lambda: jonswap(hs=1.0, tp=8.0, gamma=-2.0), "gamma: a positive"),
        (lambda: jonswap(hs=1.0, tz=8.0, gamma=None), "needs tp"),
        (lambda: jonswap(hs=1.0, tp=8.0, sigma=(0.07, 0.9)), "sigma"),
        (lambda: bretschneider(hs=1.0), "exactly one"),
        (lambda: pierson_moskowitz(), "nothing found"),
        (lambda: pierson_moskowitz(wind_speed=10.0, hs=3.0), "wind_speed, hs found"),
        (lambda: torsethaugen(hs=1.0, tp=8.0, model="1997"), "model"),
        (lambda: torsethaugen(hs=-1.0, tp=8.0), "hs"),
        (lambda: ochi_hubble(hs1=1, tp1=1, lambda1=0, hs2=1, tp2=1, lambda2=1), "lambda1"),
        (lambda: ochi_hubble_family(hs=np.nan), "hs"),
        (lambda: spectrum_from_table([0.1, 0.2], [1.0, -1.0]), "densities"),
        (lambda: spectrum_from_table([0.2, 0.1], [1.0, 1.0]), "ascending"),
        (lambda: spectrum_from_table([0.1, 0.2, 0.3], [1.0, 1.0]), "one length"),
        (lambda: jonswap(hs=1.0, tp=8.0)([-0.1, 0.2]), "one-sided"),
        (lambda: jonswap(hs=1.0, tp=8.0).moment(0, omega_range=(1.0, 0.5)), "omega_range"),
        (lambda: jonswap(hs=1.0, tp=8.0).quantile(1.2), "fraction"),
    ],
)
def test_bad_input_is_named(call, words):
    with pytest.raises(InputError, match=words):
        call()


def test_unusual_gamma_warns():
    with pytest.warns(OgilvieWarning, match="usually 1 to 7, 9 found"):
        jonswap(hs=1.0, tp=8.0, gamma=9.0)
    with pytest.warns(OgilvieWarning, match="usually 1 to 7"):
        jonswap(hs=1.0, tp=8.0, gamma=0.8)
