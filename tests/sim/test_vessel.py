"""Vessels: what they refuse, how loads are bound."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.sim.system import assemble


def test_double_counting_names_both_loads(barge):
    with pytest.raises(
        og.DoubleCountingError, match="wave radiation is covered by two loads, StateSpaceRadiation and Convolution"
    ):
        og.Vessel(barge.body, loads=(og.StateSpaceRadiation(barge.model), og.Convolution(barge.K)))
    with pytest.raises(og.DoubleCountingError, match=r"Froude-Krylov force.*WaveExcitation and WaveExcitation"):
        og.Vessel(barge.body, loads=(og.WaveExcitation(barge.hydro), og.WaveExcitation(barge.hydro)))
    with pytest.raises(og.DoubleCountingError, match="viscous damping of roll"):
        og.Vessel(barge.body, loads=(og.LinearDamping(np.eye(6)), og.LinearDamping(ratio={"roll": 0.05})))


def test_damping_of_different_degrees_of_freedom_may_come_from_two_loads(barge):
    vessel = og.Vessel(
        barge.body, loads=(barge.others[0], og.LinearDamping(ratio={"roll": 0.05}), og.LinearDamping(ratio={"heave": 0.1}))
    )
    assert vessel.names == ("restoring", "damping", "damping_2")
    run = og.simulate(vessel, duration=1.0, initial={"nu": [0, 0, 1.0, 1.0, 0, 0]})
    assert run.force_damping.values[0, 2] == 0.0
    assert run.force_damping_2.values[0, 3] == 0.0
    assert run.force_damping.values[0, 3] < 0.0


def test_refuses_what_is_not_a_vessel(barge):
    with pytest.raises(og.InputError, match=r"a RigidBody .* expected, NoneType found"):
        og.Vessel(None, loads=barge.ship.loads)
    with pytest.raises(og.InputError, match="loads with name, covers and bind expected, str found"):
        og.Vessel(barge.body, loads=("restoring",))
    for bad in ({"speed": -1.0}, {"speed": np.nan}, {"heading": np.inf}):
        with pytest.raises(og.InputError, match="Vessel: a "):
            og.Vessel(barge.body, **bad)


def test_a_single_load_needs_no_tuple(barge):
    assert og.Vessel(barge.body, loads=barge.others[0]).names == ("restoring",)


def test_negative_total_mass_is_refused(barge):
    model = og.StateSpace(barge.model.A, barge.model.B, barge.model.C, A_inf=-2e8 * np.eye(6))
    with pytest.raises(og.InputError, match="positive definite"):
        og.simulate(og.Vessel(barge.body, loads=og.StateSpaceRadiation(model)), duration=1.0)


@pytest.mark.parametrize("radiation", ["state space", "convolution", "none"])
def test_damping_ratio_is_the_decay_of_the_uncoupled_motion(barge, radiation):
    """Roll decays with ratio * critical damping; with memory, its added mass at the natural frequency counts."""
    loads = {
        "state space": (og.StateSpaceRadiation(barge.model),),
        "convolution": (og.Convolution(barge.K),),
        "none": (),
    }[radiation]
    vessel = og.Vessel(barge.body, loads=(barge.others[0], og.LinearDamping(ratio={"roll": 0.05}), *loads))
    system = assemble(vessel)
    C, D = system.stiffness[3, 3], system.damping[3, 3]
    w = np.sqrt(C / system.mass[3, 3])
    for _ in range(60):
        w = np.sqrt(C / (system.mass[3, 3] + system.memory_transfer([w])[0, 3, 3].imag / w))
    assert pytest.approx(2 * 0.05 * C / w, rel=1e-6) == D
    assert np.count_nonzero(system.damping) == 1


def test_damping_ratio_without_stiffness_is_refused(barge):
    vessel = og.Vessel(barge.body, loads=(barge.others[0], og.LinearDamping(ratio={"surge": 0.05})))
    with pytest.raises(og.InputError, match="damping ratio of surge: a positive stiffness expected"):
        og.simulate(vessel, duration=1.0)


def test_roll_decay_of_a_ratio():
    """Log decrement of an uncoupled roll with 5 % of critical damping: 2 pi z / sqrt(1 - z^2)."""
    body = og.RigidBody(mass=1e6, cog=[0, 0, 0], inertia=np.diag([1e8, 1e9, 1e9]))
    restoring = og.LinearRestoring(np.diag([0, 0, 1e6, 2.5e7, 1e9, 0]))
    vessel = og.Vessel(body, loads=(restoring, og.LinearDamping(ratio={"roll": 0.05})))
    period = 2 * np.pi / (0.5 * np.sqrt(1 - 0.05**2))
    run = og.simulate(vessel, duration=2 * period, dt=period / 400, initial={"eta": [0, 0, 0, 0.1, 0, 0]})
    roll = run.eta.sel(dof="roll").values
    assert np.log(roll[0] / roll[400]) == pytest.approx(2 * np.pi * 0.05 / np.sqrt(1 - 0.05**2), rel=1e-4)


def test_a_heading_in_degrees_is_refused():
    with pytest.raises(og.InputError, match="Degrees"):
        og.Vessel(og.RigidBody(mass=1.0, cog=[0, 0, 0], inertia=np.eye(3)), heading=45.0)
