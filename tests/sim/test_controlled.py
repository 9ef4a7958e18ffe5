"""Control laws and Python forces in the time loop: sampled, held, recorded, saved and restored."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.units import deg

pytestmark = pytest.mark.filterwarnings("ignore:WaveExcitation")
LIFT = og.HullLift(draught=8.0, x=-40.0)


def steered(barge, **options):
    loads = [load for load in barge.ship.loads if not isinstance(load, og.LinearMooring)]
    pilot = og.Autopilot(0.3, max_moment=3e8, natural_frequency=0.1, added_mass=2e9, period=0.5)
    engine = og.SpeedKeeping(3.0, added_mass=3e5, max_thrust=2e6, thrust=9e4, period=0.5)
    return og.Vessel(barge.body, loads=(*loads, LIFT, pilot, engine), speed=3.0, **options)


def test_course_and_speed_are_kept_in_waves(barge, seas):
    run = og.simulate(steered(barge), seas.one, duration=400.0, dt=0.1, ramp=20.0, output_step=0.5)
    late = run.sel(time=slice(250, None))
    assert float(late.eta.sel(dof="yaw").mean()) == pytest.approx(0.3, abs=1 * deg)
    assert float(late.nu.sel(dof="surge").mean()) == pytest.approx(3.0, rel=0.02)
    assert {"force_autopilot", "force_speed_keeping"} <= set(run.data_vars)
    signals = [v for v in run.data_vars if str(v).startswith(("autopilot_", "speed_keeping_"))]
    assert signals
    assert all("units" in run[v].attrs for v in signals)


def test_control_is_held_between_samples(barge):
    run = og.simulate(steered(barge), duration=30.0, dt=0.1)
    moment = run.force_autopilot.sel(dof="yaw").values
    change = np.flatnonzero(np.diff(moment) != 0.0) + 1
    assert len(change) > 20
    assert np.all(change % 5 == 0)


def test_save_and_restore_are_bit_exact(barge, seas, tmp_path):
    ship = steered(barge)
    one = og.Stepper(ship, seas.one, dt=0.1, initial="rest")
    for _ in range(137):  # in the middle of a sampling period
        one.step()
    one.save(tmp_path / "state.npz")
    on = [one.step() for _ in range(60)]
    other = og.Stepper(ship, seas.one, dt=0.1, initial="rest")
    other.restore(tmp_path / "state.npz")
    again = [other.step() for _ in range(60)]
    assert all(np.array_equal(a.eta, b.eta) and np.array_equal(a.memory, b.memory) for a, b in zip(on, again, strict=True))


def test_python_force_is_called_once_per_period_and_held(barge):
    times = []

    def pull(t, eta, nu):
        times.append(t)
        return [1e5 * np.cos(t), 0, 0, 0, 0, 0]

    ship = og.Vessel(barge.body, loads=(*barge.ship.loads, og.UserForce(pull, 0.4, name="tug")))
    run = og.simulate(ship, duration=12.0, dt=0.1)
    assert times == pytest.approx(np.arange(0.0, 12.01, 0.4))
    found = run.force_tug.sel(dof="surge").values
    assert found == pytest.approx(1e5 * np.cos(0.4 * (np.arange(121) // 4)), rel=1e-12)
    times.clear()
    stepper = og.Stepper(ship, dt=0.1)
    states = [stepper.step() for _ in range(40)]
    assert np.array_equal(states[-1].eta, run.eta.values[40])
    assert times == pytest.approx(np.arange(0.0, 3.99, 0.4))


def test_python_force_tends_to_the_compiled_one(barge):
    """A spring in Python, held for shorter and shorter periods: first order."""
    loads = [load for load in barge.ship.loads if not isinstance(load, og.LinearMooring | og.WaveExcitation)]
    k = np.array([3.2e4, 4e4, 0, 0, 0, 1.6e7])
    start = {"eta": [2.0, 1.0, 0, 0, 0, 0.05]}
    wanted = og.simulate(
        og.Vessel(barge.body, loads=(*loads, og.LinearMooring(np.diag(k)))),
        duration=40.0,
        dt=0.1,
        initial=start,
        motions="large",
    )
    left = []
    for period in (0.4, 0.2, 0.1):

        def spring(t, eta, nu):
            c, s = np.cos(eta[5]), np.sin(eta[5])
            world = -k[:2] * eta[:2]
            return [c * world[0] + s * world[1], -s * world[0] + c * world[1], 0, 0, 0, -k[5] * eta[5]]

        held = og.Vessel(barge.body, loads=(*loads, og.UserForce(spring, period)))
        run = og.simulate(held, duration=40.0, dt=0.1, initial=start)
        left.append(np.abs(run.eta.values[-1] - wanted.eta.values[-1])[[0, 1, 5]].max())
    assert left[0] / left[1] == pytest.approx(2.0, abs=0.3)
    assert left[1] / left[2] == pytest.approx(2.0, abs=0.3)


def test_what_python_raises_is_told_with_load_and_time(barge):
    def broken(t, eta, nu):
        return [np.nan if t > 1.0 else 0.0, 0, 0, 0, 0, 0]

    ship = og.Vessel(barge.body, loads=(*barge.ship.loads, og.UserForce(broken, 0.5, name="winch")))
    with pytest.raises(og.InputError, match=r"UserForce 'winch'.*t = 1.5 s"):
        og.simulate(ship, duration=5.0)


def test_sampling_period_must_fit_the_step(barge):
    ship = og.Vessel(barge.body, loads=(*barge.ship.loads, og.UserForce(lambda t, eta, nu: np.zeros(6), 0.25)))
    with pytest.raises(og.InputError, match=r"multiple of dt = 0.1 s expected, 0.25 s found"):
        og.simulate(ship, duration=5.0, dt=0.1)


def test_ensemble_with_control_equals_single_runs(barge, seas):
    together = og.simulate(steered(barge), seas.three, duration=20.0, dt=0.1, initial="rest")
    alone = og.simulate(steered(barge), seas.three.isel(2), duration=20.0, dt=0.1, initial="rest")
    assert np.array_equal(together.eta.values[2], alone.eta.values)


def test_position_is_kept_by_thrusters(barge, seas):
    """Current, and thrusters that hold it: the mean thrust is the mean drag, and no thruster exceeds its limit."""
    loads = [load for load in barge.ship.loads if not isinstance(load, og.LinearMooring)]
    units = (
        og.Thruster([-40, 0, -4], azimuth=True, max_thrust=3e5, name="stern"),
        og.Thruster([40, 0, -4], direction=np.pi / 2, max_thrust=2e5, name="bow"),
    )
    keeper = og.DynamicPositioning(
        [0, 0, 0], units, natural_frequency=0.06, added_mass=barge.model.A_inf, design_force=[5e4, 5e4, 0], period=0.5
    )
    current = og.Current(0.7, 200 * deg)
    ship = og.Vessel(barge.body, loads=(*loads, keeper, current))
    run = og.simulate(ship, seas.one, duration=1500.0, dt=0.1, output_step=1.0, ramp=30.0)
    late = run.sel(time=slice(1000, None))
    assert np.abs(late.eta.values[:, :2].mean(axis=0)).max() < 0.5
    thrust = [v for v in run.data_vars if "thrust" in str(v) and "stern" in str(v)]
    assert thrust
    total = late.force_damping.mean("time").values + late[f"force_{keeper.name}"].mean("time").values
    assert np.abs(total[:2]).max() < 0.05 * np.abs(late.force_damping.mean("time").values[:2]).max()
