"""Restoring by righting levers and by the cut hull: linear limit, wall-sided barge, energy, and what is refused."""

from itertools import pairwise

import numpy as np
import pytest

import ogilvie as og
from ogilvie.frames import euler_rate_matrix, rotation_matrix
from ogilvie.loads.base import RESTORING, Load, Surroundings
from ogilvie.loads.gz import GZRestoring
from ogilvie.loads.hull_restoring import HullRestoring
from ogilvie.loads.tricubic import coefficients, evaluate
from ogilvie.mesh.deck import decked
from ogilvie.mesh.gz import gz_curve
from ogilvie.units import GRAVITY, deg

L, B, T, DEPTH = 60.0, 10.0, 3.0, 8.0
BARGE = og.shapes.box(L, B, DEPTH, panels=100).translated((0, 0, DEPTH - T))
BODY = og.RigidBody.from_hull(BARGE.immersed(), zg=0.5, gyradii=(3.5, 15.0, 15.0))
BM, GM = B**2 / 12 / T, T / 2 + B**2 / 12 / T - (T + 0.5)
PHI = np.arange(0.0, 61.0, 5.0) * deg


def jacobian(eta):
    J = np.zeros((6, 6))
    J[:3, :3] = rotation_matrix(*eta[3:])
    J[3:, 3:] = euler_rate_matrix(eta[3], eta[4])
    return J


def force(load, eta, body=BODY):
    return load.bind(Surroundings(body)).kernel.force(eta=eta)


def linear(C, eta):
    """-J^T C eta' as the large-motion loop has it."""
    upright = np.r_[0, 0, eta[2:5], 0]
    return -jacobian(eta).T @ (C @ upright)


@pytest.fixture(scope="module")
def ship():
    hull = og.shapes.from_particulars(
        length=175.0,
        beam=25.4,
        draught=9.5,
        cb=0.572,
        cm=0.97,
        cwp=0.711,
        lcb=-0.0142,
        depth=15.0,
        panels=600,
        above_water=True,
    )
    body = og.RigidBody.from_hull(hull.immersed(), kg=9.55, gyradii=(8.3, 42.0, 42.0))
    C = og.hydrostatics(hull.immersed(), body=body).stiffness
    return hull, body, C


class TestGZ:
    def load(self, gz=None, C=None, **more):
        gz = np.sin(PHI) * (GM + 0.5 * BM * np.tan(PHI) ** 2) if gz is None else gz
        C = np.diag([0, 0, 6e6, 1.0, 2e9, 0]) if C is None else C
        return GZRestoring(C, PHI, gz, displacement=BODY.mass, **more)

    def test_protocol(self):
        assert isinstance(self.load(), Load)
        assert self.load().covers == {RESTORING}

    def test_levers_are_met_on_both_sides(self):
        gz = np.sin(PHI) * (GM + 0.5 * BM * np.tan(PHI) ** 2)
        for phi, lever in zip(PHI, gz, strict=True):
            for sign in (1, -1):
                F = force(self.load(), [5.0, 6.0, 0, sign * phi, 0, 2.0])
                assert np.abs(F + sign * BODY.mass * GRAVITY * lever * np.eye(6)[3]).max() < 1e-3

    def test_one_sided_curves_and_those_of_both_sides_agree(self):
        gz = 0.3 * PHI + 0.5 * PHI**3 - 0.4 * PHI**5
        both = GZRestoring(
            np.diag([0, 0, 6e6, 1.0, 2e9, 0]), np.r_[-PHI[:0:-1], PHI], np.r_[-gz[:0:-1], gz], displacement=BODY.mass
        )
        for eta in np.random.default_rng(1).uniform(-0.5, 0.5, (20, 6)):
            assert force(self.load(gz), eta) == pytest.approx(force(both, eta))

    def test_a_linear_lever_is_linear_restoring(self):
        C = np.zeros((6, 6))
        C[2:5, 2:5] = [[6e6, 3e5, 4e6], [3e5, BODY.mass * GRAVITY * 0.7, 2e6], [4e6, 2e6, 2e9]]
        load = self.load(0.7 * PHI, C)
        assert load.stiffness == pytest.approx(C)
        for eta in np.random.default_rng(2).uniform(-0.6, 0.6, (20, 6)):
            assert force(load, eta) == pytest.approx(linear(C, eta), rel=1e-9)

    def test_takes_a_curve_of_the_hull(self):
        curve = gz_curve(BARGE, BODY, PHI)
        load = GZRestoring.from_curve(og.hydrostatics(BARGE.immersed(), body=BODY).stiffness, curve)
        assert force(load, [0, 0, 0, PHI[4], 0, 0])[3] == pytest.approx(-BODY.mass * GRAVITY * curve.gz[4])

    def test_nan_beyond_the_curve(self):
        assert np.isfinite(force(self.load(), [0, 0, 0, 60 * deg, 0, 0])).all()
        assert np.isnan(force(self.load(), [0, 0, 0, -61 * deg, 0, 0])[3])

    def test_refusals(self):
        with pytest.raises(og.InputError, match="lever 0"):
            self.load(np.cos(PHI))
        with pytest.raises(og.InputError, match="degrees"):
            GZRestoring(np.eye(6), PHI / deg, PHI, displacement=1.0)
        with pytest.raises(og.InputError, match="both sides"):
            GZRestoring(np.eye(6), PHI + 0.1, PHI, displacement=1.0)
        with pytest.raises(og.InputError, match="displacement"):
            GZRestoring(np.eye(6), PHI, PHI, displacement=-1.0)


def test_tricubic_spline_has_order_four_and_its_gradient_order_three():
    def f(x, y, z):
        return np.sin(1.1 * x) * np.cos(0.7 * y + 0.2 * x) * np.exp(0.3 * z)

    errors = []
    for n in (9, 17, 33):
        a = np.linspace(0.0, 2.0, n)
        c = coefficients(f(a[:, None, None], a[:, None], a))
        rng, worst = np.random.default_rng(0), [0.0, 0.0]
        for q in rng.uniform(0.0, 2.0, (200, 3)):
            value, *g = evaluate(c, *(q * (n - 1) / 2.0))
            e = 1e-5 * np.eye(3)
            exact = [(f(*(q + d)) - f(*(q - d))) / 2e-5 for d in e]
            worst[0] = max(worst[0], abs(value - f(*q)))
            worst[1] = max(worst[1], np.abs(np.array(g) * (n - 1) / 2.0 - exact).max())
        errors.append(worst)
    order = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(order[:, 0] > 3.6)
    assert np.all(order[:, 1] > 2.6)


@pytest.fixture(scope="module")
def barge():
    return HullRestoring(BARGE, BODY, heave=1.5, roll=50 * deg, pitch=3 * deg, points=(17, 101, 11))


class TestHull:
    def test_protocol(self, barge):
        assert isinstance(barge, Load)
        assert barge.covers == {RESTORING}

    def test_no_force_at_rest(self, barge):
        scale = BODY.mass * GRAVITY
        assert np.abs(force(barge, [3.0, 4.0, 0, 0, 0, 1.0])).max() < 1e-9 * scale
        assert np.abs(barge.rest).max() < 1e-9 * scale

    def test_wall_sided_moment_at_large_angles(self, barge):
        for phi in np.array([-30.0, -12.3, 5.0, 17.7, 29.0]) * deg:
            expected = -BODY.mass * GRAVITY * np.sin(phi) * (GM + 0.5 * BM * np.tan(phi) ** 2)
            F = force(barge, [0, 0, 0, phi, 0, 0.4])
            assert F[3] == pytest.approx(expected, rel=2e-4)
            assert np.abs(F[[0, 1, 2]]).max() < 1e-4 * BODY.mass * GRAVITY

    def test_heave_of_a_box_is_linear_and_vertical_in_the_world(self, barge):
        F = force(barge, [0, 0, 0.5, 0.2, 0, 0])
        up = rotation_matrix(0.2, 0, 0) @ F[:3]
        assert up == pytest.approx([0, 0, -1025.0 * GRAVITY * L * B / np.cos(0.2) * 0.5], rel=1e-4, abs=1.0)

    def test_linear_limit(self, ship):
        hull, body, C = ship
        load = HullRestoring(hull, body, heave=0.8, roll=6 * deg, pitch=0.6 * deg, points=(17, 25, 17))
        assert load.stiffness == pytest.approx(C)
        direction = np.array([0, 0, 0.5, 0.06, 0.005, 0.3])
        scale = np.abs(linear(C, direction))
        errors = []
        for h in (1.0, 0.5, 0.25):
            F = force(load, h * direction, body)
            errors.append(np.abs((F - linear(C, h * direction))[2:5] / scale[2:5]))
        assert errors[-1].max() < 0.02
        slope = np.log2(np.array(errors[:-1]) / errors[1:])
        assert np.all(slope > 1.7)

    def test_forces_are_those_of_the_cut_hull(self, ship):
        hull, body, _ = ship
        load = HullRestoring(hull, body, roll=40 * deg, pitch=4 * deg, points=(21, 41, 21))
        closed = decked(hull)
        errors = []
        for z, phi, theta in np.random.default_rng(4).uniform(-1, 1, (12, 3)) * [3.0, 35 * deg, 3 * deg]:
            eta = np.array([0, 0, z, phi, theta, 0.7])
            wet = closed.rotated(phi, theta).translated((0, 0, z)).immersed()
            up = 1025.0 * GRAVITY * wet.volume
            R = rotation_matrix(phi, theta, 0.0)
            arm_b, arm_g = wet.center_of_buoyancy - [0, 0, z], R @ body.cog
            moment = np.cross(arm_b, [0, 0, up]) - np.cross(arm_g, [0, 0, body.mass * GRAVITY])
            exact = np.r_[R.T @ [0, 0, up - body.mass * GRAVITY], R.T @ moment]
            scale = body.mass * GRAVITY * np.array([1, 1, 1, 1.0, 175.0, 175.0])
            errors.append(np.abs(force(load, eta, body) - exact) / scale)
        assert np.max(errors) < 1e-3
        assert np.median(np.max(errors, axis=1)) < 2e-4

    def test_work_around_a_closed_path_is_zero_and_between_ends_the_energy(self, barge):
        kernel = barge.bind(Surroundings(BODY)).kernel

        def work(path):
            total = 0.0
            x, w = np.polynomial.legendre.leggauss(4)
            for a, b in pairwise(path):
                for xi, wi in zip(x, w, strict=True):
                    eta = a + 0.5 * (1 + xi) * (b - a)
                    nu = np.linalg.solve(jacobian(eta), b - a)
                    total += 0.5 * wi * kernel.force(eta=eta) @ nu
            return total

        s = np.linspace(0, 2 * np.pi, 400)
        path = np.stack([s, 0 * s, 0.8 * np.sin(s), 0.6 * np.cos(s), 0.04 * np.sin(2 * s), 0.3 * s], axis=1)
        half = len(s) // 2
        up = work(path[: half + 1])
        assert up == pytest.approx(barge.energy(*path[0, 2:5]) - barge.energy(*path[half, 2:5]), rel=1e-6, abs=2.0)
        assert abs(work(path)) < 1e-6 * BODY.mass * GRAVITY

    def test_symmetric_hulls_have_symmetric_tables(self, ship):
        hull, body, _ = ship
        args = dict(roll=20 * deg, pitch=2 * deg, points=(7, 9, 7))
        one, whole = HullRestoring(hull, body, **args), HullRestoring(hull.full(), body, **args)
        even = HullRestoring(hull, body, **{**args, "points": (7, 10, 7)})
        eta = np.array([0, 0, 0.5, 0.2, 0.01, 0])
        assert force(one, eta, body) == pytest.approx(force(whole, eta, body), rel=1e-7, abs=1e-3)
        assert force(even, eta, body)[3] == pytest.approx(-force(even, eta * [1, 1, 1, -1, 1, 1], body)[3])

    def test_free_roll_keeps_its_energy(self, barge):
        """Heave, roll and pitch with inertia alone, by Runge-Kutta steps: kinetic and potential energy keep their sum."""
        kernel, M = barge.bind(Surroundings(BODY)).kernel, np.array([BODY.mass, BODY.mass * 16.0, BODY.mass * 225.0])
        q, v = np.array([0.3, 0.5, 0.01]), np.zeros(3)

        def acceleration(q):
            eta = np.r_[0, 0, q, 0]
            Q = np.linalg.solve(jacobian(eta).T, kernel.force(eta=eta))
            return Q[2:5] / M

        total = [barge.energy(*q) + 0.5 * M @ v**2]
        dt = 0.02
        for _ in range(1000):
            k1 = acceleration(q)
            k2 = acceleration(q + dt / 2 * v)
            k3 = acceleration(q + dt / 2 * v + dt**2 / 4 * k1)
            k4 = acceleration(q + dt * v + dt**2 / 2 * k2)
            q = q + dt * v + dt**2 / 6 * (k1 + k2 + k3)
            v = v + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            total.append(barge.energy(*q) + 0.5 * M @ v**2)
        assert np.ptp(total) < 1e-4 * (total[0] - barge.energy(0, 0, 0))

    def test_nan_outside_the_table(self, barge):
        assert np.isfinite(force(barge, [0, 0, 1.5, 50 * deg, 0, 0])).all()
        for eta in ([0, 0, 1.6, 0, 0, 0], [0, 0, 0, -51 * deg, 0, 0], [0, 0, 0, 0, 3.1 * deg, 0]):
            assert np.isnan(force(barge, eta)).any()

    def test_the_body_of_the_table_is_that_of_the_vessel(self, barge):
        heavier = og.RigidBody(1.01 * BODY.mass, BODY.cog, BODY.inertia)
        with pytest.raises(og.InputError, match="vessel's body"):
            barge.bind(Surroundings(heavier))

    def test_refusals(self):
        with pytest.raises(og.InputError, match="freeboard"):
            HullRestoring(BARGE.immersed(), BODY)
        with pytest.raises(og.InputError, match="roll"):
            HullRestoring(BARGE, BODY, roll=(0.1, 0.5))
        with pytest.raises(og.InputError, match="points"):
            HullRestoring(BARGE, BODY, points=(4, 10, 10))
