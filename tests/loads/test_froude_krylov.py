"""Nonlinear Froude-Krylov force and restoring: closed forms, convergence, invariance, energy, the linear limit, bad input."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

import ogilvie as og
from ogilvie.frames import rotation_matrix
from ogilvie.loads.base import DIFFRACTION, FROUDE_KRYLOV, RESTORING, SLOW_DRIFT, Load, Surroundings
from ogilvie.loads.froude_krylov import NonlinearFroudeKrylov
from ogilvie.loads.kernel import Kernel
from ogilvie.mesh.buoyancy import corners, energy_gradient
from ogilvie.mesh.deck import decked
from ogilvie.units import GRAVITY, SEA_WATER, deg

L, B, T, DEPTH = 60.0, 12.0, 3.0, 8.0
RHO_G = SEA_WATER * GRAVITY


def barge(panels=400, depth=DEPTH):
    return og.shapes.box(L, B, depth, panels=panels, grading=0.0).translated((0, 0, depth - T))


BARGE = barge()
BODY = og.RigidBody.from_hull(BARGE.immersed(), zg=0.5, gyradii=(4.0, 15.0, 15.0))


def box_transfer(omega, direction, depth=np.inf):
    """Closed form of the linear Froude-Krylov force (n, 6) of the box in waves along x; z' = 0 at the mean surface."""
    k = og.waves.dispersion.wavenumber(omega, depth)
    c = np.cos(direction)
    profile = (lambda z: np.cosh(k * (z + depth)) / np.cosh(k * depth)) if np.isfinite(depth) else (lambda z: np.exp(k * z))
    f, a = profile(-T), 0.5 * k * L
    ends, levers = (quad(lambda z, n=n: z**n * profile(z), -T, 0.0)[0] for n in (0, 1))
    X = np.zeros(6, dtype=complex)
    X[0] = RHO_G * B * ends * 2j * np.sin(a) * c
    X[2] = RHO_G * B * f * 2.0 * np.sin(a) / k
    first_moment = 2j * (a * np.cos(a) - np.sin(a)) / k**2 * c  # int x exp(-i k c x) dx
    X[4] = RHO_G * B * (levers * 2j * np.sin(a) * c - f * first_moment)
    return X


def hydro(*, water_depth=np.inf, diffraction=0.5):
    """Data whose Froude-Krylov part is that of the box in waves along x."""
    omega = np.linspace(0.2, 2.0, 61)
    directions = np.radians([0.0, 180.0])
    X = np.array([[box_transfer(w, b, water_depth) for b in directions] for w in omega])
    Z = np.zeros((len(omega), 6, 6))
    data = og.hydro_from_arrays(
        omega=omega,
        added_mass=Z,
        radiation_damping=Z,
        wave_direction=directions,
        excitation_force=(1.0 + diffraction) * X,
        water_depth=water_depth,
        rho=SEA_WATER,
        g=GRAVITY,
    )
    return data.assign(Froude_Krylov_force=data.excitation_force / (1.0 + diffraction))


HYDRO = hydro()


def load(hull=BARGE, body=BODY, data=HYDRO, **more):
    return NonlinearFroudeKrylov(hull, body, data, **more)


def sphere(panels, radius=5.0):
    """Whole sphere about O, closed."""
    half = og.shapes.hemisphere(radius, panels=panels)
    lower = half.full()
    upper = lower.vertices * [1.0, 1.0, -1.0]
    faces = np.concatenate([lower.faces, lower.faces[:, ::-1] + len(upper)])
    return og.PanelMesh(np.concatenate([lower.vertices, upper]), faces)


class TestStillWater:
    def test_protocol(self):
        assert isinstance(load(), Load)
        assert load().covers == {RESTORING, FROUDE_KRYLOV, SLOW_DRIFT}

    def test_any_pose_has_the_energy_gradient_of_the_hull(self):
        """Buoyancy and weight by another route: derivatives of the exact energy of the closed hull."""
        one = load(barge(200))
        p, mass = corners(decked(barge(200))), BODY.mass / SEA_WATER
        for z, phi, theta in np.random.default_rng(1).uniform([-3, -1.4, -0.4], [3, 1.4, 0.4], (40, 3)):
            F = one.force(eta=[4.0, 5.0, z, phi, theta, 2.0])
            R = rotation_matrix(phi, theta, 0.0)
            Q = -RHO_G * energy_gradient(p, mass, BODY.cog, z, phi, theta)
            world = R @ F[:3]
            assert world == pytest.approx([0, 0, Q[0]], abs=1e-9 * BODY.mass * GRAVITY)
            assert F[3] == pytest.approx(Q[1], abs=1e-8 * BODY.mass * GRAVITY)  # roll about the body's x axis
            assert np.cos(phi) * F[4] - np.sin(phi) * F[5] == pytest.approx(Q[2], abs=1e-8 * BODY.mass * GRAVITY)

    def test_wall_sided_barge_at_large_heel(self):
        BM, GM = B**2 / 12 / T, T / 2 + B**2 / 12 / T - (T + 0.5)
        for phi in np.radians([5.0, 20.0, 26.0]):
            lever = np.sin(phi) * (GM + 0.5 * BM * np.tan(phi) ** 2)
            assert load().force(eta=[0, 0, 0, phi, 0, 0])[3] == pytest.approx(-BODY.mass * GRAVITY * lever, rel=1e-9)

    def test_equals_the_tabulated_restoring_of_the_hull(self):
        table = og.HullRestoring(BARGE, BODY, roll=60 * deg, pitch=4 * deg, points=(31, 121, 21)).bind(Surroundings(BODY))
        for eta in np.random.default_rng(3).uniform([-1, -0.9, -0.05], [1, 0.9, 0.05], (20, 3)):
            pose = [0, 0, *eta, 0]
            want, found = table.kernel.force(eta=pose), load().force(eta=pose)
            assert np.abs(found - want).max() < 2e-3 * BODY.mass * GRAVITY

    def test_out_of_the_water_and_under_it(self):
        weight = BODY.mass * GRAVITY
        above = load().force(eta=[0, 0, 20.0, 0.3, 0, 0])
        assert rotation_matrix(0.3, 0, 0) @ above[:3] == pytest.approx([0, 0, -weight], abs=1e-6 * weight)
        below = load().force(eta=[0, 0, -50.0, 0.3, -0.4, 0])
        up = RHO_G * L * B * DEPTH - weight
        assert rotation_matrix(0.3, -0.4, 0) @ below[:3] == pytest.approx([0, 0, up], abs=1e-6 * weight)

    def test_the_wet_part_is_a_closed_volume(self):
        """Vertical force rho g V of the hull clipped by other code, no horizontal one."""
        closed = decked(BARGE)
        for z, phi, theta, psi in np.random.default_rng(5).uniform([-2, -1, -0.2, -3], [2, 1, 0.2, 3], (10, 4)):
            R = rotation_matrix(phi, theta, psi)
            moved = og.PanelMesh(closed.vertices @ R.T + [0, 0, z], closed.faces)
            F = R @ load().force(eta=[0, 0, z, phi, theta, psi])[:3] + [0, 0, BODY.mass * GRAVITY]
            volume = moved.immersed().volumes[2]
            assert pytest.approx([0, 0, RHO_G * volume], rel=1e-9, abs=1e-7 * RHO_G * volume) == F

    def test_partly_immersed_sphere_converges_to_the_cap(self):
        r, errors = 5.0, []
        body = og.RigidBody(mass=1.0, cog=[0, 0, 0], inertia=np.eye(3))
        for panels in (200, 800, 3200):
            hull = sphere(panels)
            with pytest.warns(og.OgilvieWarning, match="balances the weight"):
                one = load(hull, body)
            worst = 0.0
            for z in (-3.0, -1.0, 0.0, 2.0, 4.0):
                h = r - z
                cap = np.pi * h**2 * (3 * r - h) / 3
                F = rotation_matrix(0.3, 0.2, 0.1) @ one.force(eta=[0, 0, z, 0.3, 0.2, 0.1])[:3]
                worst = max(worst, abs(F[2] / RHO_G - cap))
            errors.append(worst / (4 / 3 * np.pi * r**3))
        assert np.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.5)
        assert errors[2] < 1e-2

    def test_stiffness_is_the_slope(self):
        one, h = load(), 1e-4
        for i in (2, 3, 4):
            e = np.eye(6)[i] * h
            slope = (one.force(eta=e) - one.force(eta=-e)) / (2 * h)
            assert slope == pytest.approx(-one.stiffness[:, i], abs=1e-5 * np.abs(one.stiffness[:, i]).max())


def box_by_quadrature(sea, stretching, surface, pose_z=0.0):
    """Force (x, z, pitch) of the frozen sea along x at t = 0 on the upright box, by adaptive quadrature."""
    k, a, c, h = sea.wavenumber, sea.amplitude, np.cos(sea.direction), sea.depth

    def factor(z):
        deep = np.exp(k * z) if np.isinf(h) else np.cosh(k * (z + h)) / np.cosh(k * h)
        if stretching == "extrapolated":
            return deep if z <= 0.0 else 1.0 + z * k * (1.0 if np.isinf(h) else np.tanh(k * h))
        return deep

    def phases(x):
        return a * np.cos(-k * c * x + sea.phase)

    def zeta(x):
        return float(phases(x).sum()) if surface == "incident" else 0.0

    def head(x, z):
        s = z
        if stretching == "wheeler" and surface == "incident":
            s = z - zeta(x) if np.isinf(h) else (z - zeta(x)) * h / (h + zeta(x))
        elif stretching == "vertical" or surface == "mean":
            s = min(z, 0.0)
        return float((phases(x) * factor(s)).sum()) - z

    keel = pose_z - T
    lift = quad(lambda x: head(x, keel), -L / 2, L / 2, epsabs=1e-9, limit=200)[0]
    trim = quad(lambda x: -x * head(x, keel), -L / 2, L / 2, epsabs=1e-9, limit=200)[0]
    push = 0.0
    for end in (-1.0, 1.0):
        x, breaks = end * L / 2, [0.0] if keel < 0.0 < zeta(end * L / 2) else None
        push -= end * quad(lambda z, x=x: head(x, z), keel, zeta(x), points=breaks)[0]
        trim -= end * quad(lambda z, x=x: (z - pose_z) * head(x, z), keel, zeta(x), points=breaks)[0]
    return RHO_G * B * np.array([push, lift, trim])


def frozen(depth=np.inf):
    return og.Sea(
        omega=[0.7, 1.1], direction=[np.pi, np.pi], amplitude=[1.2, 0.5], phase=[0.4, 2.0], depth=depth
    )  # 2.4 m of 3 m draught


class TestFrozenWave:
    @pytest.mark.parametrize("depth", [np.inf, 12.0])
    @pytest.mark.parametrize(
        ("stretching", "surface"),
        [("wheeler", "incident"), ("vertical", "incident"), ("extrapolated", "incident"), ("vertical", "mean")],
    )
    def test_box_converges_to_quadrature(self, stretching, surface, depth):
        sea, z, errors = frozen(depth), 0.3, []
        want = box_by_quadrature(sea, stretching, surface, z)
        scale = RHO_G * np.array([B * T * 2, L * B, L * L * B / 6])
        for panels in (200, 800, 3200):
            one = load(barge(panels), stretching=stretching, surface=surface, evaluation="direct", accuracy=1e-6)
            F = one.force(sea, eta=[0, 0, z, 0, 0, 0]) + [0, 0, BODY.mass * GRAVITY, 0, 0, 0]
            errors.append(np.abs((F[[0, 2, 4]] - want) / scale).max())
            assert np.abs(F[[1, 3, 5]]).max() < 1e-6 * RHO_G * L * B * T  # nothing across
        assert np.log2(errors[0] / errors[2]) / 2 == pytest.approx(2.0, abs=0.6)
        assert errors[2] < 2e-3

    def test_place_and_time_are_one_phase(self):
        sea = og.irregular(og.jonswap(hs=3.0, tp=8.0), direction=0.6, n=30, seed=1, omega_range=(0.4, 2.0))
        one, eta = load(), np.array([0, 0, 0.4, 0.5, 0.1, 0.2])
        here = one.force(sea, t=3.0, eta=eta)
        k = sea.wavenumber * (np.cos(0.6) * 100.0 + np.sin(0.6) * -70.0)
        moved = og.Sea(omega=sea.omega, direction=sea.direction, amplitude=sea.amplitude, phase=sea.phase + sea.omega * 3.0 + k)
        there = one.force(moved, t=0.0, eta=eta + [100.0, -70.0, 0, 0, 0, 0])
        assert there == pytest.approx(here, abs=1e-8 * BODY.mass * GRAVITY)

    def test_turning_sea_and_ship_together_changes_nothing(self):
        one, base = load(), None
        for turn in (0.0, 0.9, 2.5, -2.0):
            sea = og.irregular(og.jonswap(hs=3.0, tp=8.0), direction=turn, n=30, seed=1, omega_range=(0.4, 2.0))
            c, s = np.cos(turn), np.sin(turn)
            F = one.force(sea, t=2.0, eta=[5 * c - 3 * s, 5 * s + 3 * c, 0.4, 0.5, 0.1, 0.3 + turn])
            base = F if base is None else base
            assert pytest.approx(base, abs=1e-5 * BODY.mass * GRAVITY) == F

    def test_port_and_starboard(self):
        one = load()
        mirror = np.array([1, -1, 1, -1, 1, -1])
        sea = og.irregular(og.jonswap(hs=3.0, tp=8.0), direction=0.8, n=30, seed=1, omega_range=(0.4, 2.0))
        other = og.Sea(omega=sea.omega, direction=-sea.direction, amplitude=sea.amplitude, phase=sea.phase)
        eta = np.array([2.0, 3.0, 0.4, 0.5, 0.1, 0.3])
        assert one.force(other, t=1.0, eta=mirror * eta) == pytest.approx(
            mirror * one.force(sea, t=1.0, eta=eta), abs=1e-5 * BODY.mass * GRAVITY * L
        )

    def test_a_wave_without_end_in_length_lifts_the_water(self):
        """A wave of 15 km: still water at another height, for all stretchings."""
        sea = og.regular(amplitude=1.5, omega=0.064, direction=np.pi)
        for stretching in ("wheeler", "vertical", "extrapolated"):
            F = load(stretching=stretching).force(sea, eta=[0, 0, 0, 0.4, 0, 0])
            want = load().force(eta=[0, 0, -1.5, 0.4, 0, 0])
            assert np.abs(F - want).max() < 0.01 * BODY.mass * GRAVITY

    def test_interpolation_is_as_accurate_as_asked(self):
        """Short-crested: directions with many components on lines, others at each vertex; errors near the wanted ones."""
        one = og.irregular(og.jonswap(hs=3.0, tp=8.0), direction=0.8, n=40, seed=1, omega_range=(0.4, 2.5))
        two = og.irregular(og.jonswap(hs=2.0, tp=6.0), direction=-2.0, n=25, seed=7, omega_range=(0.6, 2.5))
        few = og.Sea(omega=[0.5, 0.9, 1.2], direction=[1.0, 2.0, -0.5], amplitude=[0.5, 0.3, 0.2], phase=[1.0, 2.0, 3.0])
        sea, eta = one + two + few, [20.0, -5.0, 0.4, 0.5, 0.1, 0.3]
        exact = load(evaluation="direct", accuracy=1e-6).force(sea, t=4.0, eta=eta)
        kernel = load().bind(Surroundings(BODY)).encounter(sea, 0.0)
        lines, alone = kernel.data[3 + int(kernel.data[2]) :][1:3].astype(int)
        assert (lines, alone) == (1, 40)  # one direction on a line, 28 components at each vertex
        errors = []
        for accuracy in (1e-2, 1e-3, 1e-4):
            difference = load(accuracy=accuracy).force(sea, t=4.0, eta=eta) - exact
            errors.append(np.abs(difference / [1, 1, 1, B, L / 4, L / 4]).max() / (RHO_G * L * B))
        assert all(b < a for a, b in pairwise(errors))
        assert errors[2] < 1e-4 * 0.9  # hs/4 = 0.9 m

    def test_ramp_and_realisations(self):
        sea = og.irregular(og.jonswap(hs=3.0, tp=8.0), direction=0.8, n=30, seed=(1, 2), omega_range=(0.4, 2.0))
        encounter = load().bind(Surroundings(BODY)).encounter
        kernel = encounter(sea, 40.0)
        assert len(kernel.own) == 2
        assert np.abs(kernel.force(t=0.0)).max() < 1e-12 * BODY.mass * GRAVITY
        half = og.Sea(omega=sea.omega, direction=sea.direction, amplitude=0.5 * sea.amplitude[0], phase=sea.phase[0])
        assert kernel.force(t=20.0) == pytest.approx(encounter(half, 0.0).force(t=20.0), rel=1e-9)
        assert kernel.force(t=50.0) == pytest.approx(encounter(sea.isel(0), 0.0).force(t=50.0))


class TestSmallMotions:
    @pytest.mark.parametrize("depth", [np.inf, 12.0])
    def test_difference_to_the_linear_force_is_of_second_order(self, depth):
        """A fine mesh has the closed form of the box within 2e-3; half the wave leaves a quarter of the rest."""
        one = load(barge(6000), data=hydro(water_depth=depth), evaluation="direct", accuracy=1e-7)
        X = box_transfer(0.9, np.pi, depth)
        found = []
        for a in (0.4, 0.2, 0.1):
            F = []
            for phase in (0.0, np.pi / 2):  # real and minus imaginary part
                sea = og.Sea(omega=[0.9], direction=[np.pi], amplitude=[a], phase=[phase], depth=depth)
                F.append((one.force(sea) - one.force()) / a)
            found.append(F[0] - 1j * F[1])
        size = np.abs(X)[[0, 2, 4]]
        limit = 2 * found[2] - found[1]  # linear in the amplitude: extrapolated to none
        assert np.abs((limit - X)[[0, 2, 4]] / size).max() < 2e-3
        second = [np.abs(np.array(found[i] - limit)[[0, 2, 4]]).max() for i in range(2)]
        assert np.log2(second[0] / second[1]) == pytest.approx(1.0, abs=0.35)

    def test_small_motions_are_those_of_linear_loads(self):
        springs = og.LinearMooring(np.diag([1e5, 1e5, 0, 0, 0, 1e8]))
        sea = og.irregular(og.jonswap(hs=1.0, tp=8.0), direction=np.pi, n=20, seed=1, omega_range=(0.4, 1.9))
        linear = (og.LinearRestoring(load().stiffness), og.WaveExcitation(HYDRO), springs)
        exact = (load(), og.WaveExcitation(HYDRO, part="diffraction"), springs)
        runs = [
            og.simulate(og.Vessel(BODY, loads=loads), sea, duration=30.0, dt=0.1, initial="rest", motions="small")
            for loads in (linear, exact)
        ]
        assert runs[1].eta.values == pytest.approx(runs[0].eta.values, abs=1e-9)

    def test_large_motions_tend_to_small_ones(self):
        """In tiny waves large motions with this load are small motions, and so is a steady start."""
        springs, damping = og.LinearMooring(np.diag([1e5, 1e5, 0, 0, 0, 1e8])), og.LinearDamping(BODY.matrix * 0.1)
        loads = (load(barge(1500)), og.WaveExcitation(HYDRO, part="diffraction", position="mean"), springs, damping)
        vessel = og.Vessel(BODY, loads=loads)
        sea = og.regular(amplitude=0.01, omega=0.9, direction=np.pi)
        runs = [og.simulate(vessel, sea, duration=20.0, dt=0.1, motions=motions) for motions in ("small", "large")]
        small, large = (r.eta.values for r in runs)
        assert np.abs(large - small).max(axis=0)[[0, 2, 4]] / np.abs(small).max(axis=0)[[0, 2, 4]] == pytest.approx(
            np.zeros(3), abs=0.02
        )


class TestRuns:
    def test_energy_is_kept_in_still_water(self):
        """Rolling 50 deg and heaving freely: kinetic and potential energy, by another code, to the order of the step."""
        p, errors = corners(decked(BARGE)), []
        for dt in (0.1, 0.05):
            run = og.simulate(
                og.Vessel(BODY, loads=(load(),)), duration=20.0, dt=dt, motions="large",
                initial={"eta": [0, 0, 0.8, 50 * deg, 2 * deg, 0]},
            )  # fmt: skip
            eta, nu = run.eta.values, run.nu.values
            kinetic = 0.5 * np.einsum("ti,ij,tj->t", nu, BODY.matrix, nu)
            potential = [og.mesh.buoyancy.potential_energy(p, BODY.mass / SEA_WATER, BODY.cog, *e[2:5]) for e in eta]
            energy = kinetic + RHO_G * np.array(potential)
            errors.append(np.ptp(energy) / np.ptp(kinetic))
        assert errors[0] < 1e-3
        assert errors[0] / errors[1] > 6.0  # a cut hull has kinks in its second derivatives: order 3 at least

    def test_thrown_over_and_dropped(self):
        """60 deg of roll from 10 m above the water, in waves: all numbers are finite and the force is its own evaluation."""
        data, sea = HYDRO, og.irregular(og.jonswap(hs=4.0, tp=8.0), direction=np.pi, n=40, seed=3, omega_range=(0.4, 1.9))
        damping = og.LinearDamping(0.3 * BODY.matrix)
        one = load(data=data)
        vessel = og.Vessel(BODY, loads=(one, og.WaveExcitation(data, part="diffraction", position="mean"), damping))
        run = og.simulate(vessel, sea, duration=60.0, dt=0.05, initial={"eta": [0, 0, 10.0, 60 * deg, 0, 0]}, motions="large")
        assert int(run.attrs["complete"]) == 1
        assert np.isfinite(run.eta.values).all()
        assert run.eta.sel(dof="heave").values.max() <= 10.0 + 1e-9
        for i in (0, 200, 900):
            want = one.force(sea, t=float(run.time[i]), eta=run.eta.values[i])
            assert run.force_froude_krylov.values[i] == pytest.approx(want, rel=1e-9, abs=1.0)

    def test_a_run_that_goes_too_deep_ends_with_what_was_computed(self):
        heavy = og.RigidBody(mass=3.0 * SEA_WATER * L * B * DEPTH, cog=[0, 0, 0.5], inertia=BODY.inertia * 10)
        with pytest.warns(og.OgilvieWarning, match="balances the weight"):
            one = load(body=heavy)
        sea = og.regular(amplitude=1.0, omega=0.7, direction=np.pi)
        vessel = og.Vessel(heavy, loads=(one, og.WaveExcitation(HYDRO, part="diffraction", position="mean")))
        with pytest.raises(
            og.errors.ConvergenceError, match=r"froude_krylov is known for hulls at most .* below the waves"
        ) as caught:
            og.simulate(vessel, sea, duration=100.0, dt=0.05, initial="rest", motions="large")
        kept = caught.value.result
        assert int(kept.attrs["complete"]) == 0
        assert 3.0 < float(kept.time[-1]) < 60.0
        assert np.isfinite(kept.eta.values[:-1]).all()

    @pytest.mark.filterwarnings("ignore:invalid value encountered:RuntimeWarning")  # of the rotation matrix
    def test_poses_that_are_not_numbers_give_nan(self):
        terms = load().bind(Surroundings(BODY))
        sea = og.regular(amplitude=1.0, omega=0.7, direction=np.pi)
        for bad in ([0, 0, np.nan, 0, 0, 0], [0, 0, 0, np.inf, 0, 0], [0, 0, 1e12, 0, 0, 0], [np.nan, 0, 0, 0, 0, 0]):
            assert np.isnan(terms.encounter(sea, 0.0).force(eta=bad)).any()
        assert np.isnan(terms.kernel.force(eta=[0, 0, 0, 0, np.nan, 0])).all()

    def test_below_the_bottom_is_not_known(self):
        one = load(data=hydro(water_depth=8.0))
        sea = og.regular(amplitude=0.5, omega=0.7, direction=np.pi, depth=8.0)
        assert np.isfinite(one.force(sea, eta=[0, 0, -4.0, 0, 0, 0])).all()
        assert np.isnan(one.force(sea, eta=[0, 0, -6.0, 0, 0, 0])).all()


class TestRefusals:
    def test_double_counting(self):
        with pytest.raises(og.errors.DoubleCountingError, match="Froude-Krylov force"):
            og.Vessel(BODY, loads=(load(), og.WaveExcitation(HYDRO)))
        with pytest.raises(og.errors.DoubleCountingError, match="hydrostatic restoring"):
            og.Vessel(BODY, loads=(load(), og.LinearRestoring(np.eye(6))))

        class Drift:
            name, covers = "drift", frozenset({SLOW_DRIFT})

            def bind(self, surroundings):
                return None

        with pytest.raises(og.errors.DoubleCountingError, match="slow drift"):
            og.Vessel(BODY, loads=(load(), Drift()))
        both = og.Vessel(BODY, loads=(load(), og.WaveExcitation(HYDRO, part="diffraction", position="mean")))
        assert both.loads[1].covers == {DIFFRACTION}

    def test_another_body(self):
        other = og.RigidBody(mass=BODY.mass * 1.01, cog=BODY.cog, inertia=BODY.inertia)
        with pytest.raises(og.InputError, match="the vessel's body expected"):
            load().bind(Surroundings(other))

    @pytest.mark.parametrize(
        ("more", "match"),
        [
            ({"stretching": "none"}, "stretching: one of"),
            ({"surface": "wavy"}, "surface: one of"),
            ({"evaluation": "fft"}, "evaluation: one of"),
            ({"accuracy": 0.0}, "accuracy"),
        ],
    )
    def test_words(self, more, match):
        with pytest.raises(og.InputError, match=match):
            load(**more)

    def test_hull_without_freeboard_and_data_without_parts(self):
        with pytest.raises(og.InputError, match="up to its deck expected"):
            load(BARGE.immersed())
        with pytest.raises(og.InputError, match="Froude_Krylov_force or diffraction_force expected"):
            load(data=HYDRO.drop_vars("Froude_Krylov_force"))

    def test_things_of_another_kind(self):
        for bad in ({"hull": BARGE.vertices}, {"body": 3.0}, {"data": {"rho": 1.0}}):
            with pytest.raises(og.InputError, match=r"a PanelMesh expected|a RigidBody expected|xarray\.Dataset"):
                load(**bad)

    def test_data_at_several_speeds(self):
        one = load(data=[HYDRO, HYDRO.assign_attrs(speed=5.0)])
        assert one.bind(Surroundings(BODY, speed=2.0)).wave(og.regular(amplitude=1.0, omega=0.8, direction=np.pi), 0.0)[
            0
        ] == pytest.approx(box_transfer(0.8, np.pi), rel=1e-3, abs=1e-3 * RHO_G * L * B)

    def test_too_much_accuracy(self):
        sea = og.regular(amplitude=1.0, omega=60.0, direction=0.0)
        with pytest.raises(og.InputError, match="larger `accuracy`"):
            load(accuracy=1e-9).force(sea)

    def test_kernels_name_their_limits(self):
        sea = og.regular(amplitude=1.0, omega=0.7, direction=0.0)
        kernel = load().bind(Surroundings(BODY)).encounter(sea, 0.0)
        assert isinstance(kernel, Kernel)
        assert not kernel.steady
        assert "m below the waves" in kernel.limits
