"""One kernel serves the single run, the ensemble, the stepper and the restart: the same bits come out."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.sim.state import State

SHIPS = ["ship", "ship_convolution"]
VARIABLES = ("eta", "nu", "acceleration", "elevation", "force_excitation", "force_radiation")


@pytest.mark.parametrize("name", SHIPS)
def test_realisation_of_an_ensemble_equals_the_single_run(barge, seas, name):
    vessel = getattr(barge, name)
    runs = og.simulate(vessel, seas.three, duration=300.0, dt=0.1)
    assert runs.eta.dims == ("realisation", "time", "dof")
    assert runs.seed.values.tolist() == [0, 1, 2]
    for i in range(3):
        single = og.simulate(vessel, seas.three.isel(i), duration=300.0, dt=0.1)
        for v in VARIABLES:
            assert np.array_equal(runs[v].values[i], single[v].values), v
    assert not np.array_equal(runs.eta.values[0], runs.eta.values[1])


@pytest.mark.parametrize("ramp", [0.0, 30.0])
@pytest.mark.parametrize(("name", "method"), [("ship", "rk4"), ("ship", "exact"), ("ship_convolution", "rk4")])
def test_stepper_equals_simulate(barge, seas, name, method, ramp):
    vessel = getattr(barge, name)
    run = og.simulate(vessel, seas.one, duration=220.0, dt=0.1, method=method, ramp=ramp)
    stepper = og.Stepper(vessel, seas.one, dt=0.1, method=method, ramp=ramp)
    states = [stepper.state] + [stepper.step() for _ in range(2200)]  # beyond the first block of wave forces
    assert np.array_equal([s.eta for s in states], run.eta.values)
    assert np.array_equal([s.nu for s in states], run.nu.values)
    assert [s.time for s in states] == run.time.values.tolist()


@pytest.mark.parametrize("name", SHIPS)
def test_stepper_goes_on_from_a_saved_state_bit_for_bit(barge, seas, name, tmp_path):
    stepper = og.Stepper(getattr(barge, name), seas.one, dt=0.1)
    for _ in range(50):
        stepper.step()
    stepper.save(tmp_path / "state.npz")
    kept = stepper.state
    ahead = [stepper.step() for _ in range(60)]
    for source in (kept, tmp_path / "state.npz"):
        stepper.restore(source)
        again = [stepper.step() for _ in range(60)]
        assert np.array_equal([s.eta for s in again], [s.eta for s in ahead])
    fresh = og.Stepper(getattr(barge, name), seas.one, dt=0.1, initial=kept)
    assert np.array_equal(fresh.step().eta, ahead[0].eta)


@pytest.mark.parametrize("name", SHIPS)
def test_simulate_goes_on_from_a_state(barge, seas, name):
    vessel = getattr(barge, name)
    whole = og.simulate(vessel, seas.one, duration=60.0)
    stepper = og.Stepper(vessel, seas.one)
    for _ in range(200):
        stepper.step()
    rest = og.simulate(vessel, seas.one, duration=40.0, initial=stepper.state)
    assert rest.time.values[0] == 20.0
    assert np.array_equal(rest.eta.values, whole.eta.values[200:])


def test_external_force_is_held_during_a_step(barge):
    """A constant force through the stepper equals the same pretension in the vessel."""
    force = np.array([1e5, -2e4, 3e4, 1e6, 0.0, 2e6])
    loads = [load for load in barge.ship.loads if not isinstance(load, (og.WaveExcitation, og.LinearMooring))]
    plain = og.Vessel(barge.body, loads=(*loads, barge.others[1]))
    tense = og.Vessel(barge.body, loads=(*loads, og.LinearMooring(barge.others[1].stiffness, pretension=force)))
    expected = og.simulate(tense, duration=5.0).eta.values[-1]
    stepper = og.Stepper(plain)
    for _ in range(50):
        state = stepper.step(force)
    assert state.eta == pytest.approx(expected, rel=1e-12)


def test_states_do_not_change_afterwards(barge, seas):
    stepper = og.Stepper(barge.ship, seas.one)
    first = stepper.state
    eta = first.eta.copy()
    stepper.step()
    assert np.array_equal(first.eta, eta)
    with pytest.raises(ValueError):
        first.eta[0] = 1.0


def test_init_starts_again(barge, seas):
    stepper = og.Stepper(barge.ship, seas.one)
    a = [stepper.step().eta for _ in range(5)]
    stepper.init()
    assert np.array_equal([stepper.step().eta for _ in range(5)], a)
    assert not stepper.init({"eta": [1, 0, 0, 0, 0, 0]}).nu.any()


def test_stepper_refuses(barge, seas, tmp_path):
    with pytest.raises(og.InputError, match="one realisation expected, 3 found"):
        og.Stepper(barge.ship, seas.three)
    stepper = og.Stepper(barge.ship, seas.one)
    for bad in ([1.0, 2.0], [np.nan] * 6, "push"):
        with pytest.raises((og.InputError, ValueError)):
            stepper.step(bad)
    other = og.Stepper(barge.ship_convolution, seas.one).state
    with pytest.raises(og.InputError, match="memory of shape"):
        stepper.restore(other)
    (tmp_path / "broken.npz").write_bytes(b"PK\x03\x04 not an archive")
    with pytest.raises(og.FormatError, match="a state written by"):
        stepper.restore(tmp_path / "broken.npz")


def test_state_file_is_whole_or_absent(tmp_path):
    state = State(eta=np.arange(6.0), nu=-np.arange(6.0), memory=[1.0, np.pi], time=12.5)
    state.save(tmp_path / "s.npz")
    again = State.load(tmp_path / "s.npz")
    assert np.array_equal(again.memory, state.memory)
    assert (again.time, again.eta.tolist()) == (12.5, state.eta.tolist())
    assert [p.name for p in tmp_path.iterdir()] == ["s.npz"]
    with pytest.raises(OSError):
        state.save(tmp_path / "no" / "s.npz")
