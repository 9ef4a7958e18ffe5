"""Runs with slow-drift forces: tables in small motions, compiled forces in large ones, ramp, start, stepper."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.hydro.qtf import with_qtf
from ogilvie.loads.base import Surroundings
from ogilvie.loads.slow_drift import SlowDrift


def drift(omega, direction):
    """Mean drift (n_w, n_b, 6) of a hull that is its own mirror image."""
    w, b = np.broadcast_arrays(np.asarray(omega)[:, None], np.asarray(direction)[None, :])
    c, s = np.cos(b), np.sin(b)
    size = np.tanh(2.0 * w**2)
    return np.stack([4e4 * c * size, 6e4 * s * size, 2e4 * w, 3e4 * s * w, 4e5 * c, 4e5 * s * c * size], axis=-1)


@pytest.fixture(scope="module")
def data(barge):
    """The barge's coefficients with drift and a quadratic transfer function."""
    w, b = np.linspace(0.3, 2.2, 20), barge.hydro.wave_direction.values
    difference = np.subtract.outer(w, w)[:, :, None, None]
    D = drift(w, b)
    Q = 0.5 * (D[:, None] + D[None, :]) * (1.0 + 0.8j * difference)
    full = with_qtf(barge.hydro, omega=w, qtf_diff=Q)
    dims = ("omega", "wave_direction", "influenced_dof")
    return full.assign(mean_drift=(dims, drift(barge.hydro.omega.values, b)))


def with_drift(barge, load, **more):
    waves = og.WaveExcitation(barge.hydro, position="slow")
    return og.Vessel(barge.body, loads=(*barge.others[:3], waves, og.StateSpaceRadiation(barge.model), load), **more)


def test_drift_beside_waves_at_the_place_of_the_moment_is_told(barge, data, seas):
    ship = og.Vessel(barge.body, loads=(*barge.others, og.StateSpaceRadiation(barge.model), SlowDrift(data)))
    with pytest.warns(og.OgilvieWarning, match=r"count part of the mean force twice.*position='slow'"):
        og.simulate(ship, seas.one, duration=1.0, motions="large", ramp=1.0)


@pytest.mark.parametrize("approximation", ["newman-arithmetic", "full", "mean"])
def test_small_motions_add_the_force_to_that_of_the_waves(barge, data, seas, approximation):
    """The recorded force is the series times the ramp squared, and the equation of motion holds it."""
    load = SlowDrift(data, approximation)
    run = og.simulate(with_drift(barge, load), seas.one, duration=60.0, dt=0.1, ramp=20.0)
    t = run.time.values
    ramp = np.sin(0.5 * np.pi * np.clip(t / 20.0, 0, 1)) ** 2
    expected = load.series(seas.one, t) * ramp[:, None] ** 2
    np.testing.assert_allclose(run.force_slow_drift, expected, rtol=0, atol=1e-8 * np.abs(expected).max())
    total = sum(run[key] for key in run.data_vars if key.startswith("force_"))
    residual = barge.body.matrix @ run.acceleration.values.T - total.values.T
    assert np.abs(residual).max() < 1e-6 * np.abs(total.values).max()
    without = og.simulate(barge.ship, seas.one, duration=60.0, dt=0.1, ramp=20.0)
    np.testing.assert_allclose(run.force_excitation, without.force_excitation, atol=1e-6 * float(np.abs(expected).max()))
    assert float(np.abs(run.eta - without.eta).max()) > 1e-3


def test_small_motions_are_the_convolution_of_the_force(barge, data, seas):
    """Superposition: the difference of two runs is the response to the table alone."""
    load = SlowDrift(data)
    options = {"duration": 80.0, "dt": 0.05, "initial": "rest"}
    more, less = (og.simulate(v, seas.one, **options) for v in (with_drift(barge, load), barge.ship))
    t = np.arange(0.0, 90.0, 0.05)
    table = og.ForceTable(t, load.series(seas.one, t), frame="heading")
    still = og.Vessel(barge.body, loads=(*barge.others[:-1], og.StateSpaceRadiation(barge.model), table))
    alone = og.simulate(still, **options, motions="large")
    away = (more.eta - less.eta).values[:, :3] - alone.eta.values[:, :3]
    assert np.abs(away).max() < 0.02 * np.abs(alone.eta.values[:, :3]).max()


def test_steady_start_includes_the_mean_offset(barge, data, seas):
    run = og.simulate(with_drift(barge, SlowDrift(data, "mean")), seas.three, duration=5.0, dt=0.1)
    plain = og.simulate(barge.ship, seas.three, duration=5.0, dt=0.1)
    mean = run.force_slow_drift.values[:, 0]
    C = sum(load.bind(Surroundings(barge.body)).stiffness for load in barge.others)
    offset = np.linalg.lstsq(C, mean.T, rcond=None)[0].T
    np.testing.assert_allclose((run.eta - plain.eta).values, np.repeat(offset[:, None], 51, axis=1), atol=1e-6)
    assert len(np.unique(mean[:, 0])) == 3 or np.ptp(mean[:, 0]) < 1e-9  # one mean for one spectrum


def test_large_motions_at_the_mean_position_are_small_ones(barge, data, seas):
    load = SlowDrift(data, position="mean")
    one, two = (
        og.simulate(with_drift(barge, load), seas.one, duration=40.0, dt=0.1, ramp=10.0, motions=m) for m in ("small", "large")
    )
    scale = float(np.abs(one.force_slow_drift).max())
    np.testing.assert_allclose(two.force_slow_drift, one.force_slow_drift, atol=0.05 * scale)


def test_a_large_run_with_drift(barge, data, seas):
    """A moored barge in large motions feels the drift and moves off."""
    ship = with_drift(barge, SlowDrift(data))
    run = og.simulate(ship, seas.three, duration=60.0, dt=0.1, ramp=10.0, motions="large")
    assert run.force_slow_drift.shape == (3, 601, 6)
    small = og.simulate(ship, seas.three, duration=60.0, dt=0.1, ramp=10.0, motions="small")
    for dof in ("surge", "sway"):
        F, G = (r.force_slow_drift.sel(dof=dof).values for r in (run, small))
        assert np.abs(F - G).mean() < 0.2 * np.abs(G).mean()


def test_stepper_has_the_same_force(barge, data, seas):
    ship = with_drift(barge, SlowDrift(data))
    run = og.simulate(ship, seas.one, duration=20.0, dt=0.1, ramp=5.0)
    stepper = og.Stepper(ship, seas.one, dt=0.1, ramp=5.0)
    for _ in range(200):
        state = stepper.step()
    np.testing.assert_allclose(state.eta, run.eta.values[-1], rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("other", ["exact", "convolution"])
def test_other_schemes_take_the_same_table(barge, data, seas, other):
    load = SlowDrift(data)
    options = {"duration": 40.0, "dt": 0.05, "initial": "rest"}
    run = og.simulate(with_drift(barge, load), seas.one, **options)
    if other == "exact":
        again = og.simulate(with_drift(barge, load), seas.one, method="exact", **options)
    else:
        again = og.simulate(og.Vessel(barge.body, loads=(*barge.others, og.Convolution(barge.K), load)), seas.one, **options)
    np.testing.assert_allclose(again.force_slow_drift, run.force_slow_drift, rtol=1e-12)
    scale = np.abs(run.eta).max("time")
    assert float((np.abs(again.eta - run.eta).max("time") / scale).max()) < 0.01


def test_a_free_ship_starts_without_an_offset_where_nothing_restores(barge, data, seas):
    """Mean drift is balanced in heave, roll and pitch; the free modes drift away from zero."""
    loads = (barge.others[0], *barge.others[2:], og.StateSpaceRadiation(barge.model))
    free, bare = (og.Vessel(barge.body, loads=(*loads, *more)) for more in ((SlowDrift(data),), ()))
    run, plain = (og.simulate(v, seas.one, duration=100.0, dt=0.1) for v in (free, bare))
    away = (run.eta - plain.eta).values
    assert np.abs(away[0, [0, 1, 5]]).max() < 1e-9
    assert np.abs(away[0, [2, 4]]).min() > 0.0
    assert np.abs(away[-1, :2]).min() > 0.1


@pytest.mark.parametrize("approximation", ["mean", "newman-arithmetic"])
def test_added_resistance_slows_a_ship_to_where_thrust_balances_it(barge, data, approximation):
    """Constant thrust for 6 m/s in calm water; head seas; drift at 0, 4 and 8 m/s that grows linearly with the speed."""
    scale = {U: 1.0 + 0.3 * U for U in (0.0, 4.0, 8.0)}
    sets = [data.assign(mean_drift=data.mean_drift * k).assign_attrs(speed=U) for U, k in scale.items()]
    sea = og.irregular(og.jonswap(hs=2.0, tp=8.0), direction=np.pi, n=40, omega_range=(0.4, 2.0), seed=3)
    speeds = np.linspace(0.0, 9.0, 10)
    calm = og.SurgeResistance.from_table(speeds, 8e3 * speeds**2, balanced_at=6.0)
    load = SlowDrift(sets, approximation)
    course = og.LinearMooring(np.diag([0.0, 1e5, 0.0, 0.0, 0.0, 2e9]))
    damping = og.LinearDamping(np.diag([0.0, 1e6, 0.0, 3e7, 0.0, 4e9]))
    loads = (barge.others[0], course, damping, og.StateSpaceRadiation(barge.model), calm, load)
    run = og.simulate(og.Vessel(barge.body, loads=loads, speed=6.0), sea, duration=900.0, dt=0.1, motions="large")
    D = load.form(sea, 0.0, 0.0).diagonal()[:, 0] @ sea.amplitude**2
    assert D < 0.0
    u = np.linspace(2.0, 8.0, 6001)
    balance = 8e3 * (36.0 - u**2) + D * (1.0 + 0.3 * u)
    expected = u[np.argmin(np.abs(balance))]
    late = run.nu.sel(dof="surge")[run.time > 600.0]
    assert float(late.mean()) == pytest.approx(expected, abs=0.03)
    assert expected < 5.6


def test_drift_at_several_speeds_and_its_damping_are_not_counted_together(barge, data, seas):
    sets = [data.assign_attrs(speed=U) for U in (0.0, 4.0)]
    damping = og.WaveDriftDamping(data, seas.one)
    og.Vessel(barge.body, loads=(*barge.others, SlowDrift(data), damping))
    with pytest.raises(og.DoubleCountingError, match="wave-drift damping"):
        og.Vessel(barge.body, loads=(*barge.others, SlowDrift(sets), damping))
