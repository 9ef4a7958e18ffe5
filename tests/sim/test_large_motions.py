"""Large motions: invariances, closed forms, conservation, an independent loop in Fossen's axes, the limit of small motions."""

import itertools

import numpy as np
import pytest

import ogilvie as og
from ogilvie.frames import coriolis_matrix, euler_rate_matrix, matrix_to_z_down, rotation_matrix, to_z_down
from ogilvie.loads.base import Terms
from ogilvie.loads.kernel import NU, Kernel, load_kernel

pytestmark = pytest.mark.filterwarnings("ignore:WaveExcitation")
CALM = {"eta": [1.0, 2.0, 0.5, 0.4, 0.2, 0.7], "nu": [2.0, 0.8, 0.3, 0.15, 0.1, 0.12]}


class Push:
    """A constant force in body axes, as a compiled load."""

    name = "push"
    covers = frozenset({"push"})

    def __init__(self, force):
        self.force = np.array(force, dtype=float)

    def bind(self, surroundings):
        return Terms(kernel=Kernel(_push, self.force))


@load_kernel
def _push(x, data, own, force):
    for p in range(6):
        force[p] += data[p]


class NoDataBeyond:
    """A force that is known up to a surge speed."""

    name = "narrow"
    covers = frozenset({"narrow"})

    def bind(self, surroundings):
        return Terms(kernel=Kernel(_narrow, limits="surge speeds up to 1 m/s"))


@load_kernel
def _narrow(x, data, own, force):
    if x[NU] > 1.0:
        force[0] += np.nan


def heavy(added=True):
    """A body with all couplings and an added mass of its own."""
    body = og.RigidBody(mass=1e7, cog=[0.5, 0.2, 1.0], inertia=np.diag([4e8, 7e9, 7e9]))
    A = np.diag([3e5, 4e6, 6e6, 1.5e8, 2.5e9, 2e9])
    A[1, 5] = A[5, 1] = 2e7
    A[2, 4] = A[4, 2] = -3e7
    A[1, 3] = A[3, 1] = 5e6
    model = og.StateSpace(np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0)), A_inf=A)
    return body, A, og.StateSpaceRadiation(model)


def relative(run, speed, heading):
    """Displacement from the steady frame of a run in the world."""
    eta, t = run.eta.values.copy(), run.time.values
    x, y = eta[:, 0] - speed * t * np.cos(heading), eta[:, 1] - speed * t * np.sin(heading)
    eta[:, 0], eta[:, 1] = np.cos(heading) * x + np.sin(heading) * y, -np.sin(heading) * x + np.cos(heading) * y
    eta[:, 5] -= heading
    return eta


def slopes(values):
    return np.log2(np.array(values[:-1]) / np.array(values[1:]))


@pytest.mark.parametrize("direction", [130.0, 20.0])
def test_small_waves_give_the_small_motions(barge, direction):
    """At speed and heading, head and following seas; what is left falls with the square of the amplitude."""
    speed, heading = 5.0, 0.4
    loads = (*barge.ship.loads, og.HullLift(draught=25.0, x=-40.0))
    ship = og.Vessel(barge.body, loads=loads, speed=speed, heading=heading)
    left = []
    for amplitude in (2e-3, 1e-3):
        sea = og.regular(amplitude=amplitude, period=7.0, direction=heading + np.radians(direction))
        small, large = (og.simulate(ship, sea, duration=60.0, motions=m) for m in ("small", "large"))
        difference = np.abs(relative(large, speed, heading) - small.eta.values).max(axis=0)
        assert (difference / np.abs(small.eta.values).max(axis=0)).max() < 0.1
        left.append(difference)
    assert slopes(left)[0] == pytest.approx(2.0, abs=0.2)


def test_forces_balance_the_motion(barge, seas):
    """What is recorded for each load adds up to the inertia of the body, gyroscopic forces included."""
    ship = og.Vessel(barge.body, loads=(*barge.ship.loads, og.HullLift(draught=20.0, x=-40.0)), speed=3.0, heading=1.0)
    run = og.simulate(ship, seas.one, duration=60.0, dt=0.1, motions="large", ramp=20.0)
    total = sum(run[v].values for v in run if v.startswith("force_"))
    M = barge.body.matrix
    inertia = run.acceleration.values @ M.T + np.array([coriolis_matrix(M, nu) @ nu for nu in run.nu.values])
    assert np.abs(total - inertia).max(axis=0) / np.abs(inertia).max(axis=0) == pytest.approx(np.zeros(6), abs=1e-9)


def test_energy_of_a_free_body_is_kept_at_the_order_of_the_method():
    body, A, radiation = heavy()
    C = np.diag([0.0, 0.0, 8e6, 1.6e8, 4e9, 0.0])
    C[2, 4] = C[4, 2] = 5e7
    ship = og.Vessel(body, loads=(og.LinearRestoring(C), radiation))
    drift = []
    for dt in (0.4, 0.2, 0.1):
        run = og.simulate(ship, duration=80.0, dt=dt, initial=CALM, motions="large", variables=("eta", "nu"))
        nu, eta = run.nu.values, run.eta.values
        energy = 0.5 * np.einsum("ti,ij,tj->t", nu, body.matrix + A, nu) + 0.5 * np.einsum("ti,ij,tj->t", eta, C, eta)
        drift.append(np.abs(energy / energy[0] - 1.0).max())
    assert slopes(drift)[-1] > 3.9
    assert drift[-1] < 2e-6


def test_fluid_never_gives_energy_in_large_motions(barge):
    """A passive memory stays passive: the work done on the fluid is never negative."""
    radiation = og.StateSpaceRadiation(barge.model)
    ship = og.Vessel(barge.body, loads=(og.LinearRestoring(barge.hydro), radiation))
    run = og.simulate(ship, duration=200.0, dt=0.02, initial=CALM, motions="large")
    nu = run.nu.values
    momentum = 0.5 * np.einsum("ti,ij,tj->t", nu, barge.model.A_inf, nu)
    power = -np.einsum("ti,ti->t", run.force_radiation.values, nu)
    work = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * 0.02)])
    memory = work - (momentum - momentum[0])  # taken by the waves, beside the energy of the added mass
    assert memory.min() > -1e-4 * momentum[0]
    assert memory[-1] > 0.0


def test_steady_circle_in_calm_water():
    """(m + a) of surge and sway alike: u, v, r from a constant thrust and yaw moment in closed form."""
    m, a, d1, d2, d6 = 1e6, 4e5, 2e4, 3e5, 4e7
    body = og.RigidBody(mass=m, cog=[0, 0, 0], inertia=np.diag([4e7, 7e8, 7e8]))
    model = og.StateSpace(np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0)), A_inf=np.diag([a, a, a, 1e7, 1e8, 1e8]))
    X, N = 2e5, 1.6e6
    ship = og.Vessel(
        body,
        loads=(
            og.StateSpaceRadiation(model),
            og.LinearRestoring(np.diag([0, 0, 8e6, 1e8, 1e9, 0])),
            og.LinearDamping(np.diag([d1, d2, 1e6, 5e7, 1e9, d6])),
            Push([X, 0, 0, 0, 0, N]),
        ),
    )
    run = og.simulate(ship, duration=900.0, dt=0.1, output_step=1.0)
    r = N / d6
    u = X / (d1 + (m + a) ** 2 * r**2 / d2)
    v = -(m + a) * u * r / d2
    assert run.nu.values[-1, [0, 1, 5]] == pytest.approx([u, v, r], rel=1e-6)
    late = run.eta.values[-round(2 * np.pi / r) :, :2]
    radius = 0.5 * (np.ptp(late[:, 0]) + np.ptp(late[:, 1])) / 2
    assert radius == pytest.approx(np.hypot(u, v) / r, rel=1e-3)


def test_equals_an_independent_loop_in_z_down_axes():
    """Fossen's equations with m2c in z-down axes, plain numpy: turned into our axes the same motion, current included."""
    body, A, radiation = heavy()
    C = np.diag([0.0, 0.0, 8e6, 1.6e8, 4e9, 0.0])
    D = np.diag([3e4, 4e5, 1e5, 3e7, 1e8, 3e8])
    current = og.Current(0.8, 2.0)
    ship = og.Vessel(body, loads=(og.LinearRestoring(C), radiation, og.LinearDamping(D), current))
    dt, steps = 0.05, 800
    run = og.simulate(ship, duration=dt * steps, dt=dt, initial=CALM)
    M_d, A_d, C_d, D_d = (matrix_to_z_down(x) for x in (body.matrix, A, C, D))
    v_c = to_z_down(np.r_[current.velocity, 0, 0, 0])[:3]
    inverse = np.linalg.inv(M_d + A_d)

    def rates(z):
        eta, nu = z[:6], z[6:]
        R, T = rotation_matrix(*eta[3:]), euler_rate_matrix(eta[3], eta[4])
        J = np.block([[R, np.zeros((3, 3))], [np.zeros((3, 3)), T]])
        nu_c = np.r_[R.T @ v_c, 0, 0, 0]
        nu_r = nu - nu_c
        slip = np.r_[np.cross(nu[3:], nu_c[:3]), 0, 0, 0]
        restoring = J.T @ (C_d @ eta)
        force = -coriolis_matrix(M_d, nu) @ nu - coriolis_matrix(A_d, nu_r) @ nu_r - D_d @ nu_r - restoring - A_d @ slip
        return np.r_[J @ nu, inverse @ force]

    z = np.r_[to_z_down(CALM["eta"]), to_z_down(CALM["nu"])]
    for _ in range(steps):
        k1 = rates(z)
        k2 = rates(z + 0.5 * dt * k1)
        k3 = rates(z + 0.5 * dt * k2)
        k4 = rates(z + dt * k3)
        z = z + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    assert run.eta.values[-1] == pytest.approx(to_z_down(z[:6]), rel=1e-9, abs=1e-10)
    assert run.nu.values[-1] == pytest.approx(to_z_down(z[6:]), rel=1e-9, abs=1e-10)


def test_water_that_moves_as_a_whole_is_no_force(barge):
    """Galileo: a vessel that starts with the current moves as in still water, seen from the current."""
    still = og.Vessel(barge.body, loads=(og.LinearRestoring(barge.hydro), og.StateSpaceRadiation(barge.model)))
    current = og.Current(1.5, 0.6)
    moving = og.Vessel(barge.body, loads=(*still.loads, current))
    R = rotation_matrix(*CALM["eta"][3:])
    start = {"eta": CALM["eta"], "nu": np.array(CALM["nu"]) + np.r_[R.T @ current.velocity, 0, 0, 0]}
    a = og.simulate(still, duration=60.0, initial=CALM, motions="large")
    b = og.simulate(moving, duration=60.0, initial=start)
    carried = b.eta.values.copy()
    carried[:, :3] -= np.outer(b.time.values, current.velocity)
    assert carried == pytest.approx(a.eta.values, abs=2e-5)


def test_turned_world_turns_the_motion(barge, seas):
    """No direction of the world is special; 3 degree steps of the force table make the rounding."""
    loads = [load for load in barge.ship.loads if not isinstance(load, og.LinearMooring)]
    turn = np.radians(57.0)
    sea = og.irregular(og.jonswap(hs=3.0, tp=9.0), direction=2.0, n=30, omega_range=(0.4, 1.8), seed=3)
    turned = og.Sea(sea.omega, sea.direction + turn, sea.amplitude, sea.phase)
    runs = [
        og.simulate(og.Vessel(barge.body, loads=loads, heading=h), s, duration=60.0, initial="rest", motions="large")
        for h, s in ((0.3, sea), (0.3 + turn, turned))
    ]
    x, y = runs[0].eta.values[:, 0], runs[0].eta.values[:, 1]
    c, s = np.cos(turn), np.sin(turn)
    assert runs[1].eta.values[:, 0] == pytest.approx(c * x - s * y, abs=1e-9)
    assert runs[1].eta.values[:, 2:5] == pytest.approx(runs[0].eta.values[:, 2:5], abs=1e-9)
    assert runs[1].eta.values[:, 5] - turn == pytest.approx(runs[0].eta.values[:, 5], abs=1e-9)


def test_start_elsewhere_meets_the_sea_there(barge):
    """A vessel that starts at (x, y) feels the sea with the phases of that place."""
    loads = [load for load in barge.ship.loads if not isinstance(load, og.LinearMooring)]
    ship = og.Vessel(barge.body, loads=loads)
    sea = og.irregular(og.jonswap(hs=2.0, tp=9.0), direction=0.5, n=25, omega_range=(0.4, 1.8), seed=5)
    x, y = 310.0, -45.0
    k = sea.wavenumber
    there = og.Sea(
        sea.omega, sea.direction, sea.amplitude, sea.phase - k * (x * np.cos(sea.direction) + y * np.sin(sea.direction))
    )
    a = og.simulate(ship, there, duration=60.0, initial="rest", motions="large")
    b = og.simulate(ship, sea, duration=60.0, initial={"eta": [x, y, 0, 0, 0, 0]}, motions="large")
    assert b.eta.values - [x, y, 0, 0, 0, 0] == pytest.approx(a.eta.values, abs=1e-9)
    assert b.elevation.values == pytest.approx(a.elevation.values, abs=1e-10)


def test_method_is_of_fourth_order(barge):
    ship = og.Vessel(barge.body, loads=barge.ship.loads, speed=2.0)
    sea = og.irregular(og.jonswap(hs=4.0, tp=8.0), direction=2.3, n=20, omega_range=(0.5, 1.5), seed=2)
    start = {"eta": CALM["eta"], "nu": CALM["nu"]}
    with pytest.warns(og.OgilvieWarning, match="Munk"):
        ends = [
            og.simulate(ship, sea, duration=12.0, dt=dt, initial=start, motions="large").eta.values[-1]
            for dt in (0.2, 0.1, 0.05, 0.025)
        ]
    e = [np.linalg.norm((a - b) / np.abs(ends[-1])) for a, b in itertools.pairwise(ends)]
    assert slopes(e)[-1] == pytest.approx(4.0, abs=0.1)


def test_stepper_and_ensemble_are_the_simulation(barge, seas):
    ship = og.Vessel(barge.body, loads=barge.ship.loads)
    together = og.simulate(ship, seas.three, duration=20.0, initial="rest", motions="large")
    alone = og.simulate(ship, seas.three.isel(1), duration=20.0, initial="rest", motions="large")
    assert np.array_equal(together.eta.values[1], alone.eta.values)
    stepper = og.Stepper(ship, seas.three.isel(1), initial="rest", motions="large")
    states = [stepper.state] + [stepper.step() for _ in range(200)]
    assert np.array_equal(np.array([s.eta for s in states]), alone.eta.values)


def test_where_data_end_the_error_says_so_and_keeps_the_run():
    body, _, radiation = heavy()
    ship = og.Vessel(
        body,
        loads=(og.LinearRestoring(np.diag([0, 0, 8e6, 1.6e8, 4e9, 0])), radiation, Push([1e6, 0, 0, 0, 0, 0]), NoDataBeyond()),
    )
    with pytest.raises(og.ConvergenceError, match="narrow is known for surge speeds up to 1 m/s only") as caught:
        og.simulate(ship, duration=60.0)
    assert 0.9 < float(caught.value.result.nu.sel(dof="surge")[-1]) <= 1.0


def test_headings_beyond_the_coefficients_stop_the_run(barge):
    h = barge.hydro.sel(wave_direction=slice(np.radians(100), None))
    h = og.hydro_from_arrays(
        omega=h.omega.values,
        added_mass=h.added_mass.values,
        radiation_damping=h.radiation_damping.values,
        wave_direction=h.wave_direction.values,
        excitation_force=h.excitation_force.values,
    )
    sea = og.regular(amplitude=0.5, period=8.0, direction=np.pi)
    loads = (og.LinearRestoring(barge.hydro), og.StateSpaceRadiation(barge.model), og.LinearDamping(np.eye(6) * 1e6))
    turning = og.Vessel(barge.body, loads=(*loads, og.WaveExcitation(h), Push([0, 0, 0, 0, 0, 2e7])))
    with pytest.raises(og.ConvergenceError, match=r"excitation is known for headings of the vessel -75..75 deg"):
        og.simulate(turning, sea, duration=900.0, dt=0.2, initial="rest")
    one = og.hydro_from_arrays(
        omega=h.omega.values,
        added_mass=h.added_mass.values,
        radiation_damping=h.radiation_damping.values,
        wave_direction=h.wave_direction.values[-1:],
        excitation_force=h.excitation_force.values[:, -1:],
    )
    with pytest.raises(og.InputError, match="position='mean'"):
        og.simulate(og.Vessel(barge.body, loads=(*loads, og.WaveExcitation(one))), sea, duration=10.0, motions="large")
    run = og.simulate(
        og.Vessel(barge.body, loads=(*loads, og.WaveExcitation(one, position="mean"))), sea, duration=10.0, motions="large"
    )
    assert np.isfinite(run.eta.values).all()


def test_words_and_methods_that_do_not_fit(barge, seas):
    with pytest.raises(og.InputError, match="motions"):
        og.simulate(barge.ship, seas.one, duration=1.0, motions="medium")
    with pytest.raises(og.InputError, match="rk4"):
        og.simulate(barge.ship, seas.one, duration=1.0, motions="large", method="exact")
    with pytest.raises(og.InputError, match="state-space"):
        og.simulate(barge.ship_convolution, seas.one, duration=1.0, motions="large")
    with pytest.raises(og.InputError, match="'large' expected for the loads push"):
        og.simulate(og.Vessel(barge.body, loads=(*barge.ship.loads, Push(np.ones(6)))), duration=1.0, motions="small")


def test_capsizing_beyond_the_vertical_is_told():
    """Euler angles end at a pitch of 90 degrees; the run ends there with a clear error."""
    body, _, radiation = heavy()
    ship = og.Vessel(body, loads=(radiation, Push([0, 0, 0, 0, 3e9, 0])))
    with pytest.raises(og.ConvergenceError):
        og.simulate(ship, duration=600.0, dt=0.1)


def test_waves_at_several_speeds_follow_the_mean_speed():
    """From rest to speed on data sets at 0 to 8 m/s; outside them the run stops and says so."""
    w, b, Z = np.linspace(0.2, 2.0, 10), np.radians(np.arange(0, 181, 30)), np.zeros((10, 6, 6))
    sets = [
        og.hydro_from_arrays(
            omega=w,
            added_mass=Z,
            radiation_damping=Z,
            wave_direction=b,
            excitation_force=np.ones((10, 7, 6)) * (1 + u),
            speed=u,
        )
        for u in (0.0, 2.0, 4.0, 8.0)
    ]
    body = og.RigidBody(mass=1e12, cog=[0, 0, 0], inertia=np.eye(3) * 1e15)
    sea = og.regular(amplitude=1.0, omega=1.0, direction=np.pi)
    for nominal, speed in ((0.0, 6.0), (6.0, 6.0), (2.0, 7.8)):
        ship = og.Vessel(body, loads=og.WaveExcitation(sets), speed=nominal)
        start = {"eta": np.zeros(6), "nu": [speed, 0, 0, 0, 0, 0]}
        run = og.simulate(ship, sea, duration=20.0, initial=start, motions="large")
        assert np.abs(run.force_excitation.values[:, 2]).max() == pytest.approx(1 + speed, rel=2e-3)
    with pytest.raises(og.ConvergenceError, match=r"excitation is known for .*mean speeds through the water 0..8 m/s"):
        og.simulate(
            og.Vessel(body, loads=og.WaveExcitation(sets)),
            sea,
            duration=5.0,
            motions="large",
            initial={"nu": [9.0, 0, 0, 0, 0, 0]},
        )


def test_waves_at_the_slow_place_leave_little_mean_force(barge):
    """At the place of the moment the force has a mean up to k |F| |surge| / 2; at the slow place the motion counts a fifth."""
    loads = [load for load in barge.ship.loads if not isinstance(load, og.WaveExcitation)]
    sea = og.regular(amplitude=2.0, period=8.0, direction=np.pi)
    mean = {}
    for position in ("instantaneous", "slow", "mean"):
        ship = og.Vessel(barge.body, loads=(*loads, og.WaveExcitation(barge.hydro, position=position)))
        run = og.simulate(ship, sea, duration=800.0, ramp=100.0, motions="large", output_step=0.2).sel(time=slice(600, 792))
        axes = np.array([rotation_matrix(*eta[3:]) for eta in run.eta.values])
        force = np.einsum("tij,tj->ti", axes, run.force_excitation.values[:, :3])[:-1, 0]
        mean[position] = abs(force.mean()) / (sea.wavenumber[0] * force.std() * run.eta.values[:-1, 0].std())
    assert mean["instantaneous"] > 0.2
    assert mean["slow"] < 0.25
    assert mean["mean"] < 0.02
