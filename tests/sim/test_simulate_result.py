"""What a simulation returns, also when it is stopped or goes wrong."""

import _thread
import threading

import numpy as np
import pytest
import xarray as xr

import ogilvie as og
from ogilvie.sim.result import case_hash


def test_dataset(barge, seas):
    run = og.simulate(barge.ship, seas.one, duration=10.0, dt=0.1)
    assert run.eta.dims == ("time", "dof")
    assert run.sizes == {"time": 101, "dof": 6}
    assert list(run.dof.values) == ["surge", "sway", "heave", "roll", "pitch", "yaw"]
    assert {v for v in run if v.startswith("force_")} == {
        "force_restoring",
        "force_mooring",
        "force_damping",
        "force_excitation",
        "force_radiation",
    }
    assert run.time.values == pytest.approx(np.arange(101) * 0.1)
    assert run.elevation.values == pytest.approx(seas.one.elevation(run.time.values), abs=1e-9)
    assert run.attrs["complete"] == 1
    assert run.attrs["seeds"] == [7]
    assert run.attrs["dt"] == 0.1
    assert "ogilvie" in run.attrs["versions"]
    assert run.attrs["wall_time"] > 0.0


def test_elevation_without_wave_loads(barge, seas):
    ship = og.Vessel(barge.body, loads=barge.others[:1])
    run = og.simulate(ship, seas.three, duration=10.0)
    assert run.elevation.values == pytest.approx(seas.three.elevation(run.time.values), abs=1e-9)
    assert not run.eta.values.any()


def test_coarser_output_is_a_selection(barge, seas):
    fine = og.simulate(barge.ship, seas.three, duration=500.0, dt=0.1)
    coarse = og.simulate(barge.ship, seas.three, duration=500.0, dt=0.1, output_step=0.7)
    assert coarse.time.values == pytest.approx(fine.time.values[::7])
    for v in fine.data_vars:
        assert np.array_equal(coarse[v].values, fine[v].values[:, ::7]), v


def test_duration_is_rounded_up_to_whole_steps(barge):
    assert og.simulate(barge.ship, duration=1.05, dt=0.1).time.values[-1] == pytest.approx(1.1)
    assert og.simulate(barge.ship, duration=0.3, dt=0.1).time.values[-1] == pytest.approx(0.3)


def test_chosen_variables(barge, seas):
    run = og.simulate(barge.ship, seas.one, duration=1.0, variables=["eta", "elevation"])
    assert set(run.data_vars) == {"eta", "elevation"}


def test_result_survives_a_file(barge, seas, tmp_path):
    run = og.simulate(barge.ship, seas.three, duration=2.0)
    run.to_netcdf(tmp_path / "run.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "run.nc", engine="h5netcdf") as again:
        xr.testing.assert_identical(again.load().drop_attrs(), run.drop_attrs())
        assert again.attrs["case_hash"] == run.attrs["case_hash"]


def test_case_hash_tells_cases_apart(barge, seas):
    runs = [
        og.simulate(barge.ship, seas.one, duration=1.0),
        og.simulate(barge.ship, seas.one, duration=1.0),
        og.simulate(barge.ship, seas.one, duration=1.0, dt=0.05),
        og.simulate(barge.ship, seas.three, duration=1.0),
        og.simulate(barge.ship_convolution, seas.one, duration=1.0),
        og.simulate(og.Vessel(barge.body, loads=barge.ship.loads, heading=0.1), seas.one, duration=1.0),
    ]
    hashes = [r.attrs["case_hash"] for r in runs]
    assert hashes[0] == hashes[1]
    assert len(set(hashes)) == 5
    assert case_hash([1, 2], "a") != case_hash([1], 2, "a")


def test_interrupt_leaves_what_was_computed(barge, seas):
    timer = threading.Timer(2.0, _thread.interrupt_main)
    og.simulate(barge.ship, seas.three, duration=10.0)  # compile first
    timer.start()
    try:
        run = og.simulate(barge.ship, seas.three, duration=5e6, dt=0.1, output_step=1000.0)
    finally:
        timer.cancel()
    assert run.attrs["complete"] == 0
    assert 0 < run.sizes["time"] < 5001
    assert np.isfinite(run.eta.values).all()
    whole = og.simulate(barge.ship, seas.three, duration=float(run.time[-1]), dt=0.1, output_step=1000.0)
    assert np.array_equal(whole.eta.values[:, : run.sizes["time"]], run.eta.values)


@pytest.mark.filterwarnings("ignore:Vessel")
@pytest.mark.parametrize("sea", ["one", "three"])
def test_divergence_keeps_what_was_computed(barge, seas, sea):
    capsizing = og.LinearRestoring(np.diag([0, 0, 8e6, -1.6e8, 4e9, 0.0]))
    vessel = og.Vessel(barge.body, loads=(capsizing, barge.others[3]))
    with pytest.raises(og.ConvergenceError, match=r"(sway|roll|yaw) diverges after") as caught:
        og.simulate(vessel, getattr(seas, sea), duration=2000.0, initial="rest")
    result = caught.value.result
    assert result.attrs["complete"] == 0
    assert 10 < result.sizes["time"] < 20001
    assert np.abs(result.eta.values).max() <= 1e9


def test_progress_bar_on_request(barge, capsys):
    og.simulate(barge.ship, duration=1.0, progress=True)
    assert capsys.readouterr().err != ""
    og.simulate(barge.ship, duration=1.0)
    assert capsys.readouterr().err == ""


BAD = {
    "negative duration": ({"duration": -1.0}, "duration: a positive number"),
    "NaN duration": ({"duration": np.nan}, "duration: a positive number"),
    "zero dt": ({"dt": 0.0}, "dt: a positive number"),
    "negative dt": ({"dt": -0.1}, "dt: a positive number"),
    "text dt": ({"dt": "fast"}, "dt: a positive number"),
    "negative ramp": ({"ramp": -5.0}, "ramp"),
    "unknown method": ({"method": "euler"}, "method: one of rk4, exact expected, 'euler' found"),
    "unknown variable": ({"variables": ["heave"]}, "variables"),
    "no variable": ({"variables": []}, "variables"),
    "output_step": ({"output_step": 0.15}, "output_step: a multiple of dt"),
    "zero output_step": ({"output_step": 0.0}, "output_step"),
    "unknown initial": ({"initial": "calm"}, "initial: 'steady', 'rest'"),
    "unknown key": ({"initial": {"heel": 1.0}}, "keys out of eta, nu, memory, time expected, 'heel' found"),
    "NaN state": ({"initial": {"eta": [np.nan] * 6}}, "eta without NaN"),
    "short state": ({"initial": {"eta": [1.0, 2.0]}}, "six numbers"),
    "too many states": ({"initial": {"eta": np.zeros((4, 6))}}, r"shape \(6,\) expected"),
    "number as state": ({"initial": 3.0}, "a State or a mapping"),
    "foreign memory": ({"initial": {"memory": np.zeros(3)}}, "memory of shape"),
    "steady with ramp": ({"initial": "steady", "ramp": 10.0}, "needs the full sea"),
    "huge result": ({"duration": 1e12}, "GB"),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_arguments(barge, seas, what):
    arguments, message = BAD[what]
    with pytest.raises(og.InputError, match=message):
        og.simulate(barge.ship, seas.one, **{"duration": 10.0, **arguments})


def test_wrong_kinds(barge, seas):
    with pytest.raises(og.InputError, match="a Vessel expected, RigidBody found"):
        og.simulate(barge.body, duration=1.0)
    with pytest.raises(og.InputError, match=r"a Sea .* expected, list found"):
        og.simulate(barge.ship, [1.0], duration=1.0)
    with pytest.raises(og.InputError, match="'exact' needs a state-space memory"):
        og.simulate(barge.ship_convolution, duration=1.0, method="exact")
    with pytest.raises(og.InputError, match="an eighth of the memory"):
        og.simulate(barge.ship_convolution, duration=100.0, dt=9.0)
    free = og.Vessel(barge.body, loads=(barge.others[0], og.LinearMooring(np.zeros((6, 6)), pretension=[1e3, 0, 0, 0, 0, 0])))
    with pytest.raises(og.InputError, match="nothing restores"):
        og.simulate(free, duration=1.0, initial="steady")


@pytest.mark.filterwarnings("ignore:WaveExcitation")
def test_wave_that_keeps_pace_has_no_stationary_motion(barge):
    """A following wave with zero encounter frequency pushes a free vessel for ever."""
    speed = 9.0
    sea = og.regular(amplitude=1.0, omega=9.80665 / speed, direction=0.0)
    lift = og.HullLift(draught=25.0, x=-40.0)
    free = og.Vessel(barge.body, loads=(barge.others[0], *barge.ship.loads[3:], lift), speed=speed)
    with pytest.raises(og.InputError, match="no stationary motion exists"):
        og.simulate(free, sea, duration=1.0)
    og.simulate(free, sea, duration=1.0, initial="rest")


@pytest.mark.parametrize("eta", [[0, 0, 0, 10.0, 0, 0], [0, 0, 0, 0, -5.0, 0]])
def test_a_pose_in_degrees_is_refused(eta):
    from ogilvie.sim.state import as_state

    with pytest.raises(og.InputError, match="Degrees"):
        as_state({"eta": eta})
    assert as_state({"eta": [0, 0, 0, 3.0, 1.5, 400.0]}).eta[5] == 400.0
