"""Slow-drift forces: every quick way against the plain double sum, mean and spectrum against closed forms, runs."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.errors import DoubleCountingError, InputError, OgilvieWarning
from ogilvie.hydro.qtf import filled_qtf, with_qtf
from ogilvie.loads.base import SLOW_DRIFT, Surroundings
from ogilvie.loads.harmonics import HarmonicGrid
from ogilvie.loads.quadratic import double_sum, single_fft
from ogilvie.loads.slow_drift import SlowDrift
from ogilvie.loads.sum_frequency import SumFrequency
from ogilvie.loads.transfer import decomposed, qtf_table

W = np.linspace(0.3, 2.2, 20)
HEADINGS = np.radians(np.arange(0, 181, 30))
NEWMAN = ("newman-arithmetic", "newman-geometric", "newman-1974")
EVERY = (*NEWMAN, "full")


def drift(omega, direction):
    """Mean drift (n_w, n_b, 6) of a hull that is its own mirror image; surge changes its sign with the frequency."""
    w, b = np.broadcast_arrays(np.asarray(omega)[:, None], np.asarray(direction)[None, :])
    c, s = np.cos(b), np.sin(b)
    size = np.tanh(2.0 * w**2)
    parts = [8e4 * c * size * np.sin(3.0 * w), 4e5 * s * size, 1e5 * (w - 1.0), 3e5 * s * w, 2e6 * c, 1e6 * s * c * size]
    return np.stack(parts, axis=-1)


def full_qtf(omega, direction):
    """Hermitian (n_w, n_w, n_b, 6) whose diagonal is the mean drift."""
    D = drift(omega, direction)
    difference = np.subtract.outer(omega, omega)[:, :, None, None]
    middle = drift(0.5 * np.add.outer(omega, omega).ravel(), direction).reshape(len(omega), len(omega), *D.shape[1:])
    return middle * (1.0 + 0.4 * difference**2 + 0.8j * difference)


def sets(headings=HEADINGS, full=True, **more):
    M = np.tile(np.diag([1e6, 1e6, 1e6, 1e8, 1e9, 1e9]), (len(W), 1, 1))
    F = np.zeros((len(W), len(headings), 6))
    hydro = og.hydro_from_arrays(
        omega=W,
        added_mass=M,
        radiation_damping=0.1 * M,
        wave_direction=headings,
        excitation_force=F,
        mean_drift=drift(W, headings),
        **more,
    )
    return with_qtf(hydro, omega=W, qtf_diff=full_qtf(W, headings)) if full else hydro


HYDRO = sets()
BODY = og.RigidBody(1e7, [0, 0, 0], 1e9 * np.eye(3))
SPECTRUM = og.jonswap(hs=3.0, tp=9.0)


def equidistant(n_seeds=1, direction=np.radians(150.0)):
    seed = 3 if n_seeds == 1 else range(n_seeds)
    return og.irregular(SPECTRUM, direction=direction, duration=400.0, seed=seed, omega_range=(0.4, 2.0))


def scattered(direction=np.radians(150.0), **more):
    return og.irregular(SPECTRUM, direction=direction, n=50, seed=3, omega_range=(0.4, 2.0), **more)


def reference(load, sea, t, heading=0.0, speed=0.0):
    """The plain double sum over Q from its definition."""
    n = len(sea.omega)
    i, j = (k.ravel() for k in np.indices((n, n)))
    b = sea.direction - heading
    Q = load.qtf(sea.omega[i], sea.omega[j], b[i], b[j]).reshape(n, n, 6)
    w = sea.omega - sea.wavenumber * speed * np.cos(b)
    return double_sum(sea.complex_amplitude, w, Q, t)


# --- the ways of summing ---


@pytest.mark.parametrize("approximation", [*EVERY, "mean"])
def test_equals_the_plain_double_sum_on_equidistant_frequencies(approximation):
    load, sea, t = SlowDrift(HYDRO, approximation, tolerance=1e-14), equidistant(), np.arange(0.0, 400.0, 0.5)
    expected = reference(load, sea, t)
    scale = np.abs(expected).max(axis=0)
    assert np.all(scale > 0.0)
    assert np.all(np.abs(load.series(sea, t) - expected).max(axis=0) < 1e-10 * scale)


@pytest.mark.parametrize("approximation", EVERY)
def test_single_fft_of_paper_d(approximation):
    """Eq. (52) equals Eq. (51) and the products."""
    load, sea = SlowDrift(HYDRO, approximation, tolerance=1e-14), equidistant()
    n, count = len(sea.omega), 600
    i, j = (k.ravel() for k in np.indices((n, n)))
    Q = load.qtf(sea.omega[i], sea.omega[j], sea.direction[0]).reshape(n, n, 6)
    force = single_fft(sea.complex_amplitude, Q, count)
    t = np.arange(count) * 400.0 / count
    np.testing.assert_allclose(force, reference(load, sea, t), rtol=0, atol=1e-10 * np.abs(force).max())
    np.testing.assert_allclose(force, load.series(sea, t), rtol=0, atol=1e-10 * np.abs(force).max())
    with pytest.raises(InputError, match="times or more"):
        single_fft(sea.complex_amplitude, Q, 2 * n - 1)


@pytest.mark.parametrize("approximation", EVERY)
@pytest.mark.parametrize("speed", [0.0, 6.0])
def test_frequencies_of_encounter_that_fit_no_grid(approximation, speed):
    load, sea = SlowDrift(HYDRO, approximation, tolerance=1e-14), scattered()
    t = 1000.0 + np.arange(0.0, 200.0, 0.4)
    expected = reference(load, sea, t, heading=0.4, speed=speed)
    found = load.series(sea, t, heading=0.4, speed=speed)
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-9 * np.abs(expected).max())


@pytest.mark.parametrize("approximation", EVERY)
def test_a_spread_sea(approximation):
    """Pairs of waves from different directions follow the documented rule."""
    load, sea = SlowDrift(HYDRO, approximation, tolerance=1e-14), scattered(spreading=og.spreading(s=8))
    assert len(np.unique(sea.direction)) > 5
    t = np.arange(0.0, 100.0, 0.5)
    expected = reference(load, sea, t)
    np.testing.assert_allclose(load.series(sea, t), expected, rtol=0, atol=1e-9 * np.abs(expected).max())


def test_form_and_definition_are_one_matrix():
    sea = scattered(spreading=og.spreading(s=8))
    n = len(sea.omega)
    i, j = (k.ravel() for k in np.indices((n, n)))
    for approximation in EVERY:
        load = SlowDrift(HYDRO, approximation, tolerance=1e-14)
        Q = load.qtf(sea.omega[i], sea.omega[j], sea.direction[i], sea.direction[j]).reshape(n, n, 6)
        form = load.form(sea)
        np.testing.assert_allclose(form.matrix(), Q, rtol=0, atol=1e-11 * np.abs(Q).max())
        np.testing.assert_allclose(Q, Q.swapaxes(0, 1).conj(), rtol=0, atol=1e-11 * np.abs(Q).max())
        np.testing.assert_allclose(form.diagonal(), np.einsum("iid->id", Q).real, atol=1e-11 * np.abs(Q).max())


# --- the approximations ---


def test_definitions():
    w1, w2, b = np.array([0.5, 0.9]), np.array([0.7, 1.6]), 2.5
    D = lambda w: drift(w, [b])[:, 0]  # noqa: E731
    Q = {name: SlowDrift(HYDRO, name).qtf(w1, w2, b) for name in NEWMAN}
    one, two, middle = D(w1), D(w2), D(0.5 * (w1 + w2))
    close = {"rtol": 5e-3, "atol": 1e-3 * np.abs(one).max()}
    np.testing.assert_allclose(Q["newman-arithmetic"], 0.5 * (one + two), **close)
    sign = np.where(one * two > 0, np.sign(one), 0.0)
    np.testing.assert_allclose(Q["newman-geometric"], sign * np.sqrt(np.abs(one * two)), **close)
    np.testing.assert_allclose(Q["newman-1974"], middle, **close)
    assert np.any(one * two < 0)


def test_newmans_first_form_is_the_arithmetic_mean():
    """Q_ij = Q_ii, paper D, Eq. (46), is not Hermitian; the force of its double sum is that of Eq. (47)."""
    load, sea, t = SlowDrift(HYDRO), scattered(), np.arange(0.0, 50.0, 0.5)
    D = load.form(sea).diagonal()
    force = double_sum(sea.complex_amplitude, sea.omega, np.repeat(D[:, None], len(D), axis=1), t)
    np.testing.assert_allclose(force, load.series(sea, t), rtol=0, atol=1e-9 * np.abs(force).max())


def test_all_agree_where_the_drift_is_constant_and_near_the_diagonal():
    flat = HYDRO.assign(mean_drift=HYDRO.mean_drift * 0.0 - 2e4).drop_vars("qtf_diff")
    sea, t = scattered(), np.arange(0.0, 60.0, 0.5)
    first, *others = (SlowDrift(flat, name, tolerance=1e-13).series(sea, t) for name in NEWMAN)
    for force in others:
        np.testing.assert_allclose(force, first, rtol=0, atol=1e-9 * np.abs(first).max())
    errors = []  # Q - D(middle) falls with the square of the difference of the frequencies
    for h in (0.1, 0.05):
        one, two = ([1.2 - h], [1.2 + h])
        exact = SlowDrift(HYDRO, "newman-1974").qtf(one, two, 2.5)
        errors.append([np.abs(SlowDrift(HYDRO, name).qtf(one, two, 2.5) - exact)[0, 1] for name in NEWMAN[:2]])
    np.testing.assert_allclose(np.divide(*errors), 4.0, rtol=0.15)


def test_mirror_image():
    """Data of one side serve both."""
    for name in EVERY:
        load = SlowDrift(HYDRO, name)
        port, starboard = load.qtf([0.6], [0.8], 2.0), load.qtf([0.6], [0.8], -2.0)
        np.testing.assert_allclose(starboard, port * [1, -1, 1, -1, 1, -1], rtol=1e-9)


def test_the_diagonal_serves_where_no_mean_drift_is_given():
    bare = HYDRO.drop_vars("mean_drift")
    np.testing.assert_allclose(SlowDrift(bare).qtf([0.6], [0.9], 2.0), SlowDrift(HYDRO).qtf([0.6], [0.9], 2.0))


def test_components_that_are_not_known_are_zero():
    D = drift(W, HEADINGS)
    D[..., 2:5] = np.nan
    load = SlowDrift(sets(full=False).assign(mean_drift=HYDRO.mean_drift.copy(data=D)))
    assert load.dofs == ("surge", "sway", "yaw")
    force = load.series(scattered(), np.arange(0.0, 20.0, 0.5))
    assert not force[:, 2:5].any()
    assert force[:, [0, 1, 5]].any(axis=0).all()


# --- two directions at once ---


def test_bidirectional_data_are_used_where_they_are_complete():
    """Data that obey the rule for two directions give what the rule gives; others do not."""
    b = np.radians([120.0, 150.0, 180.0])
    single = full_qtf(W, b)
    two = np.array([(m, n) for m in b for n in b])
    rule = np.stack([0.5 * (single[:, :, m] + single[:, :, n]) for m in range(3) for n in range(3)], axis=2)
    plain = sets(b)
    both = with_qtf(plain.drop_vars("qtf_diff"), omega=W, qtf_diff=rule, direction_pairs=two)
    w1, w2, b1, b2 = np.array([0.7]), np.array([1.1]), b[:1], b[1:2]
    expected = SlowDrift(plain, "full").qtf(w1, w2, b1, b2)
    np.testing.assert_allclose(SlowDrift(both, "full").qtf(w1, w2, b1, b2), expected, rtol=1e-9)
    turned = rule * np.exp(1j * (two[:, 0] - two[:, 1]))[:, None]  # still Hermitian
    load = SlowDrift(with_qtf(both, omega=W, qtf_diff=turned, direction_pairs=two), "full", tolerance=1e-14)
    np.testing.assert_allclose(load.qtf(w1, w2, b1, b2), expected * np.exp(1j * (b1 - b2)), rtol=1e-9)
    sea = og.irregular(SPECTRUM, direction=b[0], n=20, seed=1, omega_range=(0.4, 2.0))
    sea = sea + og.irregular(SPECTRUM, direction=2.7, n=20, seed=2, omega_range=(0.4, 2.0))
    t = np.arange(0.0, 60.0, 0.5)
    expected = reference(load, sea, t)
    np.testing.assert_allclose(load.series(sea, t), expected, rtol=0, atol=1e-9 * np.abs(expected).max())
    fewer = both.isel(qtf_pair=[0, 2, 4, 5, 6, 7, 8])
    with pytest.raises(InputError, match="every pair of the 3 directions expected, 2 found missing"):
        SlowDrift(fewer, "full")


# --- mean and spectrum ---


@pytest.mark.parametrize("approximation", [*EVERY, "mean"])
def test_mean(approximation):
    """sum |A|^2 D over whole periods, whatever the approximation."""
    load, sea = SlowDrift(HYDRO, approximation), equidistant()
    mean = np.sum(sea.amplitude[:, None] ** 2 * drift(sea.omega, sea.direction[:1])[:, 0], axis=0)
    found = load.series(sea, np.arange(0.0, 400.0, 0.5)).mean(axis=0)
    np.testing.assert_allclose(found, mean, rtol=3e-3, atol=3e-3 * np.abs(mean).max())
    from_form = SlowDrift(HYDRO, approximation)._force.tabulate(sea, 0.0, 0.0).mean(0)
    np.testing.assert_allclose(found, from_form, rtol=1e-6, atol=1e-6 * np.abs(mean).max())


@pytest.mark.parametrize("approximation", ["newman-arithmetic", "full"])
def test_spectrum_of_the_slow_force(approximation):
    """Pinkster: S_F(mu) = 8 int S(w + mu) S(w) |Q(w + mu, w)|^2 dw, averaged over realisations."""
    load, duration = SlowDrift(HYDRO, approximation), 800.0
    sea = og.irregular(SPECTRUM, direction=np.pi / 2, duration=duration, seed=range(60), omega_range=(0.4, 2.0))
    t = np.arange(0.0, duration, 1.0)
    force = load.series(sea, t)[:, :, 1]
    dw = 2 * np.pi / duration
    spectrum = 2 * (np.abs(np.fft.rfft(force, axis=1)) / len(t)) ** 2 / dw
    found, w = spectrum.mean(axis=0), sea.omega
    S = SPECTRUM(w)
    for band in (range(2, 12), range(25, 40)):
        expected = []
        for k in band:
            Q = load.qtf(w[k:], w[:-k], np.pi / 2)[:, 1]
            expected.append(8 * np.sum(S[k:] * S[:-k] * np.abs(Q) ** 2) * dw)
        assert np.mean(found[list(band)]) == pytest.approx(np.mean(expected), rel=0.12)


def test_realisations_are_those_of_their_seeds():
    sea, t = equidistant(3), np.arange(0.0, 50.0, 0.5)
    load = SlowDrift(HYDRO)
    force = load.series(sea, t)
    assert force.shape == (3, 100, 6)
    np.testing.assert_array_equal(force[2], load.series(sea.isel(2), t))


# --- low rank and sum frequencies ---


def test_rank_does_not_grow_with_the_sea():
    sea = [og.irregular(SPECTRUM, direction=2.5, n=n, seed=1, omega_range=(0.4, 2.0)) for n in (40, 400)]
    loose, tight = SlowDrift(HYDRO, "full", tolerance=1e-4), SlowDrift(HYDRO, "full", tolerance=1e-12)
    ranks = [len(tight.form(s).left) for s in sea]
    assert max(ranks) <= 6 * len(W)
    assert abs(ranks[0] - ranks[1]) <= 6
    assert len(loose.form(sea[0]).left) < ranks[0]
    t = np.arange(0.0, 100.0, 0.5)
    away = np.abs(loose.series(sea[0], t) - tight.series(sea[0], t)).max(axis=0)
    assert np.all(away < 1e-3 * np.abs(tight.series(sea[0], t)).max(axis=0))


@pytest.mark.parametrize("difference", [True, False])
def test_decomposition(difference):
    rng = np.random.default_rng(0)
    Q = rng.normal(size=(8, 8)) + 1j * rng.normal(size=(8, 8))
    Q = Q + (Q.conj().T if difference else Q.T)
    size, u, v = decomposed(Q, 1e-14, difference=difference)
    np.testing.assert_allclose((u * size) @ (v.conj().T if difference else v.T), Q, atol=1e-12)


def with_sums():
    Q = full_qtf(W, HEADINGS)
    return with_qtf(HYDRO, omega=W, qtf_sum=Q + Q.swapaxes(0, 1) * (1 + 0.5j) + 0.5j * Q)


@pytest.mark.parametrize("speed", [0.0, 4.0])
def test_sum_frequencies_by_the_same_products(speed):
    load, sea, t = SumFrequency(with_sums(), tolerance=1e-14), scattered(), np.arange(0.0, 60.0, 0.3)
    n = len(sea.omega)
    i, j = (k.ravel() for k in np.indices((n, n)))
    b = sea.direction - 0.2
    Q = load.qtf(sea.omega[i], sea.omega[j], b[i], b[j]).reshape(n, n, 6)
    w = sea.omega - sea.wavenumber * speed * np.cos(b)
    expected = double_sum(sea.complex_amplitude, w, Q, t, difference=False)
    found = load.series(sea, t, heading=0.2, speed=speed)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * np.abs(expected).max())
    assert np.abs(found.mean(axis=0)).max() < 0.2 * np.abs(found).max()


def test_compiled_force_at_sum_frequencies():
    load, sea, ramp, psi = SumFrequency(with_sums()), scattered(), 20.0, np.radians(-9.0)
    kernel = load.bind(Surroundings(BODY)).encounter(sea, ramp)
    t = np.arange(0.0, 40.0, 2.9)
    expected = load.series(sea, t, heading=psi) * np.sin(0.5 * np.pi * np.clip(t / ramp, 0, 1))[:, None] ** 4
    found = np.array([kernel.force(t=s, eta=[0, 0, 0, 0, 0, psi]) for s in t])
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8 * np.abs(expected).max())


def test_sum_frequencies_in_a_run_beside_drift():
    springs = og.LinearMooring(np.diag([1e5, 1e5, 1e8, 1e9, 1e9, 1e9]))
    loads = (springs, SlowDrift(with_sums()), SumFrequency(with_sums()))
    sea = scattered()
    run = og.simulate(og.Vessel(BODY, loads=loads), sea, duration=20.0, dt=0.05, initial="rest")
    for load in loads[1:]:
        expected = load.series(sea, run.time.values)
        found = run[f"force_{load.name}"].values
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8 * np.abs(expected).max())
    residual = BODY.matrix @ run.acceleration.values.T - sum(run[f"force_{x.name}"].values for x in loads).T
    assert np.abs(residual).max() < 1e-6 * np.abs(run.force_sum_frequency.values).max()
    with pytest.raises(DoubleCountingError, match="sum-frequency"):
        og.Vessel(BODY, loads=(*loads, SumFrequency(with_sums())))
    with pytest.raises(InputError, match="qtf_sum expected"):
        SumFrequency(HYDRO)


# --- the compiled force ---


@pytest.mark.parametrize("approximation", [*EVERY, "mean"])
def test_compiled_force_at_the_mean_position_is_the_table(approximation):
    load = SlowDrift(HYDRO, approximation)
    sea, ramp, psi = scattered(), 30.0, np.radians(6.0)
    kernel = load.bind(Surroundings(BODY)).encounter(sea, ramp)
    t = np.arange(0.0, 60.0, 5.0)
    expected = load.series(sea, t, heading=psi) * np.sin(0.5 * np.pi * np.clip(t / ramp, 0, 1))[:, None] ** 4
    found = np.array([kernel.force(t=s, eta=[0, 0, 0, 0, 0, psi + 4 * np.pi]) for s in t])
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("approximation", ["newman-geometric", "full"])
def test_compiled_force_sails_with_the_vessel(approximation):
    """At a steady speed the phases at the place of the vessel are those of the frequencies of encounter."""
    load, sea, U, psi = SlowDrift(HYDRO, approximation), scattered(), 5.0, 0.5
    kernel = load.bind(Surroundings(BODY)).encounter(sea, 0.0)
    t = np.arange(0.0, 60.0, 5.0)
    expected = load.series(sea, t, heading=psi, speed=U)
    place = [[U * s * np.cos(psi), U * s * np.sin(psi), 0, 0, 0, psi] for s in t]
    found = np.array([kernel.force(t=s, eta=eta) for s, eta in zip(t, place, strict=True)])
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-3 * np.abs(expected).max())  # linear in heading


def test_compiled_force_turns_with_the_body():
    load, sea = SlowDrift(HYDRO, "mean"), scattered()
    kernel = load.bind(Surroundings(BODY)).encounter(sea, 0.0)
    level, rolled = (kernel.force(eta=[0, 0, 0, phi, 0, 0]) for phi in (0.0, 0.3))
    turn = np.array([[1, 0, 0], [0, np.cos(0.3), np.sin(0.3)], [0, -np.sin(0.3), np.cos(0.3)]])
    np.testing.assert_allclose(rolled[:3], turn @ level[:3], rtol=1e-12)
    np.testing.assert_allclose(rolled[3:], turn @ level[3:], rtol=1e-12)


def test_headings_beyond_the_data_are_told():
    few = sets(np.radians([120.0, 150.0, 180.0]), full=False, hydrostatic_stiffness=np.diag([0, 0, 1, 1, 1, 0]))
    few.added_mass.values[:, 0, 1] = 1e5  # no symmetry
    sea = scattered()
    kernel = SlowDrift(few).bind(Surroundings(BODY)).encounter(sea, 0.0)
    assert "-30..30 deg" in kernel.limits
    assert np.isfinite(kernel.force(eta=[0, 0, 0, 0, 0, 0.5])).all()
    assert np.isnan(kernel.force(eta=[0, 0, 0, 0, 0, 0.6])).all()
    with pytest.raises(InputError, match="SlowDrift: headings"):
        SlowDrift(few).series(sea, np.arange(3.0), heading=1.0)
    one = sets(np.radians([150.0]), full=False)
    one.added_mass.values[:, 0, 1] = 1e5
    with pytest.raises(InputError, match="more headings"):
        SlowDrift(one).bind(Surroundings(BODY)).encounter(sea, 0.0)


# --- data at several speeds ---


def at_speeds(*speeds, full=False):
    """Drift that grows with the speed, by another amount at each frequency and heading."""
    found = []
    for U in speeds:
        hydro = sets(full=full).assign_attrs(speed=U)
        scale = 1.0 + 0.2 * U
        hydro["mean_drift"] = hydro.mean_drift * scale + 1e4 * U * hydro.omega * (hydro.influenced_dof == "surge")
        if full:
            hydro["qtf_diff"] = hydro.qtf_diff * scale
        found.append(hydro)
    return found


@pytest.mark.parametrize("approximation", [*EVERY, "mean"])
def test_between_speeds_the_transfer_function_is_linear(approximation):
    load = SlowDrift(at_speeds(6.0, 0.0, 3.0, full=approximation == "full"), approximation)  # in any order
    w1, w2, b = np.array([0.5, 0.8, 0.9]), np.array([0.7, 0.8, 1.4]), np.radians(140.0)
    low, high = (load.qtf(w1, w2, b, speed=U) for U in (3.0, 6.0))
    alone = SlowDrift(at_speeds(3.0, full=approximation == "full"), approximation).qtf(w1, w2, b)
    np.testing.assert_allclose(low, alone, rtol=1e-12)
    assert np.abs(high - low).max() > 0.2 * np.abs(low).max()
    np.testing.assert_allclose(load.qtf(w1, w2, b, speed=4.0), (2.0 * low + high) / 3.0, rtol=1e-12)
    np.testing.assert_array_equal(load.qtf(w1, w2, b), load.qtf(w1, w2, b, speed=0.0))


@pytest.mark.parametrize("approximation", [*EVERY, "mean"])
def test_force_at_a_speed_between_the_data_beats_at_differences_of_the_frequencies_of_encounter(approximation):
    load, sea, t = (
        SlowDrift(at_speeds(0.0, 6.0, full=approximation == "full"), approximation),
        scattered(),
        np.arange(0.0, 60.0, 0.5),
    )
    psi, U = 0.3, 4.5
    i, j = (k.ravel() for k in np.indices((50, 50)))
    b = sea.direction - psi
    Q = load.qtf(sea.omega[i], sea.omega[j], b[i], b[j], speed=U).reshape(50, 50, 6)
    expected = double_sum(sea.complex_amplitude, sea.omega - sea.wavenumber * U * np.cos(b), Q, t)
    found = load.series(sea, t, heading=psi, speed=U)
    np.testing.assert_allclose(found, expected, rtol=0, atol=5e-9 * np.abs(expected).max())


@pytest.mark.parametrize("approximation", ["newman-arithmetic", "full", "mean"])
def test_compiled_force_follows_the_mean_speed(approximation):
    load, sea = SlowDrift(at_speeds(0.0, 3.0, 6.0, full=approximation == "full"), approximation), scattered()
    kernel, psi = load.bind(Surroundings(BODY, speed=4.0)).encounter(sea, 0.0), np.radians(6.0)
    for U in (0.0, 2.0, 3.0, 4.5, 6.0):
        expected = load.form(sea, psi, U).series(HarmonicGrid(sea.omega, 1.0, 1), sea.complex_amplitude)[0]
        found = kernel.force(eta=[0, 0, 0, 0, 0, psi], nu=[U, 0, 0, 0, 0, 0])
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8 * np.abs(expected).max())
    assert np.isnan(kernel.force(eta=[0, 0, 0, 0, 0, psi], nu=[6.5, 0, 0, 0, 0, 0])).all()
    assert "mean speeds through the water 0..6 m/s" in kernel.limits


def test_data_at_several_speeds_that_do_not_belong_together():
    with pytest.raises(InputError, match="different speeds"):
        SlowDrift(at_speeds(3.0, 3.0))
    with pytest.raises(InputError, match="one hydrodynamic data set or more"):
        SlowDrift([])
    with pytest.raises(InputError, match="str found"):
        SlowDrift([HYDRO, "hydro"])
    with pytest.raises(InputError, match="same headings"):
        SlowDrift([sets(HEADINGS[:-1], full=False), at_speeds(2.0)[0]])
    load = SlowDrift(at_speeds(0.0, 3.0))
    with pytest.raises(InputError, match=r"within the data \(0\.\.3 m/s\)"):
        load.bind(Surroundings(BODY, speed=5.0))
    with pytest.raises(InputError, match="a speed within the data"):
        load.series(scattered(), np.arange(3.0), speed=5.0)


# --- mistakes ---


def test_double_counting():
    with pytest.raises(DoubleCountingError, match="slow drift"):
        og.Vessel(BODY, loads=(SlowDrift(HYDRO), SlowDrift(HYDRO, "full")))
    t = np.arange(5.0)
    with pytest.raises(DoubleCountingError, match="slow drift"):
        og.Vessel(BODY, loads=(SlowDrift(HYDRO), og.ForceTable(t, np.zeros((5, 6)), covers={SLOW_DRIFT})))


def test_mistakes():
    with pytest.raises(InputError, match="approximation, one of full, newman-arithmetic"):
        SlowDrift(HYDRO, "newman")
    with pytest.raises(InputError, match="position"):
        SlowDrift(HYDRO, position="here")
    with pytest.raises(InputError, match="data set"):
        SlowDrift(3.0)
    with pytest.raises(InputError, match="tolerance"):
        SlowDrift(HYDRO, tolerance=2.0)
    with pytest.raises(InputError, match="mean_drift_momentum"):
        SlowDrift(HYDRO, variable="mean_drift_momentum")
    with pytest.raises(InputError, match=r"mean_drift .or qtf_diff. expected"):
        SlowDrift(HYDRO.drop_vars(["mean_drift", "qtf_diff"]))
    with pytest.raises(InputError, match="qtf_diff expected"):
        SlowDrift(sets(full=False), "full")
    D = drift(W, HEADINGS)
    D[3, 2, 1] = np.nan
    with pytest.raises(InputError, match="everywhere or nowhere"):
        SlowDrift(HYDRO.assign(mean_drift=HYDRO.mean_drift.copy(data=D)))
    with pytest.raises(InputError, match="frequencies within"):
        SlowDrift(HYDRO).qtf([0.1], [0.5], 2.0)
    with pytest.raises(InputError, match="equally spaced"):
        SlowDrift(HYDRO).series(scattered(), [0.0, 1.0, 3.0])
    with pytest.raises(InputError, match="of its variance lies outside"):
        SlowDrift(HYDRO).series(og.regular(amplitude=1.0, omega=2.5, direction=2.0), np.arange(3.0))


def test_gaps_are_not_filled_silently():
    far = np.abs(np.subtract.outer(W, W)) > 0.5
    Q = np.where(far[:, :, None, None], np.nan, full_qtf(W, HEADINGS))
    band = with_qtf(HYDRO, omega=W, qtf_diff=Q)
    with pytest.raises(InputError, match=r"found missing. Fill them knowingly"):
        SlowDrift(band, "full")
    SlowDrift(filled_qtf(band, by="newman-arithmetic"), "full")


def test_speed_that_the_data_do_not_hold():
    with pytest.warns(OgilvieWarning, match="WaveDriftDamping"):
        SlowDrift(HYDRO).bind(Surroundings(BODY, speed=2.0))
    wide = og.irregular(SPECTRUM, direction=2.0, n=400, omega_range=(0.4, 2.23))
    with pytest.warns(OgilvieWarning, match="exerts no force"):
        SlowDrift(HYDRO).series(wide, np.arange(3.0))


# --- first principles ---


def test_force_on_a_wall():
    """rho g zeta^2/2 - rho/2 int w^2 dz of standing waves, at each instant, is the difference and the sum frequency force."""
    rho, g = 1025.0, 9.80665
    w = np.linspace(0.35, 1.65, 60)
    factor = (np.multiply.outer(w, w) / np.add.outer(w**2, w**2))[:, :, None, None]
    Z = np.zeros((len(w), 1, 1))
    bare = og.hydro_from_arrays(
        omega=w, added_mass=Z, radiation_damping=Z, dofs=("surge",), wave_direction=[0.0], excitation_force=Z
    )
    wall = with_qtf(bare, omega=w, qtf_diff=rho * g * (1 - factor), qtf_sum=rho * g * (1 + factor))
    sea = og.irregular(SPECTRUM, direction=0.0, n=30, seed=5, omega_range=(0.4, 1.6))
    t = np.arange(0.0, 100.0, 0.2)
    slow = SlowDrift(wall, "full", tolerance=1e-12).series(sea, t)[:, 0]
    grid = HarmonicGrid(sea.omega, 0.2, len(t))
    table = qtf_table(wall, "qtf_sum", tolerance=1e-12).form(sea.omega, sea.direction)
    fast = table.series(grid, sea.complex_amplitude * grid.phases(0.0))[:, 0]
    e = sea.complex_amplitude * np.exp(1j * np.multiply.outer(t, sea.omega))
    zeta, rate = 2 * e.real.sum(axis=1), 2 * (1j * e * sea.omega).real
    depth = np.einsum("ti,tj,ij->t", rate, rate, 1 / np.add.outer(sea.wavenumber, sea.wavenumber))
    expected = 0.5 * rho * g * zeta**2 - 0.5 * rho * depth
    np.testing.assert_allclose(slow + fast, expected, rtol=0, atol=1e-6 * np.abs(expected).max())
