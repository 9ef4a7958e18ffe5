"""Quadratic, roll, cross-flow and point drag: closed forms, symmetry, dissipation, and what they refuse."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.frames import shift_matrix
from ogilvie.loads.base import Load, Surroundings, viscous_effect
from ogilvie.loads.cross_flow import CrossFlowDrag, section_drag_coefficient
from ogilvie.loads.point_drag import PointDrag
from ogilvie.loads.roll_damping import RollDamping
from ogilvie.loads.viscous import QuadraticDamping, quadratic_effect
from ogilvie.mesh.stations import stations

AROUND = Surroundings(og.RigidBody(mass=1.0, cog=[0, 0, 0], inertia=np.eye(3)))
RHO = 1000.0


def force(load, nu, nu_r=None):
    return load.bind(AROUND).kernel.force(nu=nu, nu_r=nu_r)


def some_drags():
    rng = np.random.default_rng(3)
    x = np.linspace(-60.0, 50.0, 12)
    return [
        QuadraticDamping({"surge": 1e3, "roll": 1e8}),
        RollDamping(quadratic=3e8, cubic=1e8),
        CrossFlowDrag(x, 5 + rng.random(12), cd=0.9, beam=18.0, cd_vertical=1.1),
        PointDrag(rng.normal(size=(7, 3)), rng.normal(size=(7, 3)), rng.random(7), kind=["plate"] * 3 + ["member"] * 4),
    ]


@pytest.mark.parametrize("load", some_drags(), ids=lambda d: d.name)
def test_drag_obeys_the_protocol_takes_energy_and_uses_the_velocity_through_the_water(load):
    assert isinstance(load, Load)
    for nu in np.random.default_rng(0).normal(size=(50, 6)):
        F = force(load, nu)
        assert F @ nu < 0.0
        assert force(load, -nu) == pytest.approx(-F)
        assert force(load, [9.0, 9, 9, 9, 9, 9], nu) == pytest.approx(F)
    assert not force(load, np.zeros(6)).any()


@pytest.mark.parametrize("load", [some_drags()[i] for i in (0, 2, 3)], ids=lambda d: d.name)
def test_drag_grows_with_the_square(load):
    nu = np.array([1.0, -2.0, 0.5, 0.1, 0.2, -0.3])
    assert force(load, 3.0 * nu) == pytest.approx(9.0 * force(load, nu))


def test_quadratic_damping_couples_as_its_matrix_says():
    D = np.zeros((6, 6))
    D[1, 1], D[1, 5], D[5, 1], D[5, 5] = 4.0, 1.0, 2.0, 9.0
    F = force(QuadraticDamping(D), [0, -2.0, 0, 0, 0, 3.0])
    assert F.tolist() == [0, 4 * 4 - 9, 0, 0, 0, 2 * 4 - 9 * 9]
    assert QuadraticDamping(D).covers == {quadratic_effect("sway"), quadratic_effect("yaw")}


def test_roll_damping_is_the_sum_of_its_terms():
    load = RollDamping(linear=2.0, quadratic=3.0, cubic=5.0)
    terms = load.bind(AROUND)
    p = -0.7
    assert terms.damping[3, 3] == 2.0
    assert np.count_nonzero(terms.damping) == 1
    assert terms.kernel.force(nu=[0, 0, 0, p, 0, 0])[3] == pytest.approx(-3 * abs(p) * p - 5 * p**3)
    assert RollDamping(ratio=0.05).bind(AROUND).damping_ratio.tolist() == [0, 0, 0, 0.05, 0, 0]
    assert RollDamping(ratio=0.05).bind(AROUND).kernel is None
    assert RollDamping(quadratic=1.0).covers == {quadratic_effect("roll")}
    assert RollDamping(linear=1.0).covers == {viscous_effect("roll")}


def test_equivalent_roll_damping_takes_the_energy_of_a_cycle():
    load, a, w = RollDamping(linear=2.0, quadratic=3.0, cubic=5.0), 0.3, 0.8
    t = np.linspace(0.0, 2 * np.pi / w, 4001)
    p = a * w * np.cos(w * t)
    work = np.trapezoid(2 * p**2 + 3 * np.abs(p) ** 3 + 5 * p**4, t)
    assert load.equivalent(amplitude=a, omega=w) == pytest.approx(work / (np.pi * w * a**2), rel=1e-6)


def test_roll_damping_out_of_a_decay_gives_the_decay_back():
    """The coefficients per unit of inertia that an analysis finds, put into the load, are those of the motion analysed."""
    from scipy.integrate import solve_ivp

    I, b1, b2, w = 3.0e9, 0.02, 0.3, 0.6
    load = RollDamping(linear=b1, quadratic=b2, inertia=I)
    terms = load.bind(AROUND)

    def rate(t, y):
        K = terms.kernel.force(nu=[0, 0, 0, y[1], 0, 0])[3] - terms.damping[3, 3] * y[1]
        return [y[1], K / I - w**2 * y[0]]

    run = solve_ivp(rate, (0, 100), [0.3, 0.0], t_eval=np.linspace(0, 100, 1001), rtol=1e-9, atol=1e-10)
    found = og.decay(run.t, run.y[0], dof="roll", model="linear+quadratic", inertia=I)
    again = RollDamping.from_decay(found)
    assert again.linear == pytest.approx(b1 * I, rel=1e-3)
    assert again.quadratic == pytest.approx(b2 * I, rel=1e-3)
    less = RollDamping.from_decay(found, wave=0.3 * b1 * I)
    assert less.linear == pytest.approx(0.7 * b1 * I, rel=1e-3)
    with pytest.raises(og.InputError, match="wave damping"):
        RollDamping.from_decay(found, wave=2 * b1 * I)
    with pytest.raises(og.InputError, match="inertia"):
        RollDamping.from_decay(og.decay(run.t, run.y[0], dof="roll", model="linear+quadratic"))


class TestCrossFlow:
    L, T, CD = 120.0, 6.0, 0.8

    def load(self, **more):
        return CrossFlowDrag([-self.L / 2, self.L / 2], self.T, cd=self.CD, rho=RHO, **more)

    def test_pure_sway(self):
        F = force(self.load(), [3.0, 2.0, 0, 0, 0, 0])
        Y = -0.5 * RHO * self.CD * self.T * self.L * 4.0
        expected = [0, Y, 0, Y * self.T / 2, 0, 0]  # drag to starboard below O turns the port side down
        assert np.abs(F - expected).max() < 1e-12 * abs(Y)

    def test_pure_yaw(self):
        F = force(self.load(), [0, 0, 0, 0, 0, 0.1])
        N = -0.5 * RHO * self.CD * self.T * 2 * (self.L / 2) ** 4 / 4 * 0.01
        assert F[5] == pytest.approx(N, rel=1e-12)
        assert F[:5] == pytest.approx(0.0, abs=1e-6 * abs(N))

    def test_pure_yaw_off_the_middle(self):
        """O at an end: int x^2 and int x^3 over (0, L)."""
        F = force(CrossFlowDrag([0.0, self.L], self.T, cd=self.CD, rho=RHO, z=0.0), [0, 0, 0, 0, 0, -0.1])
        c = 0.5 * RHO * self.CD * self.T * 0.01
        assert F[[1, 3, 5]] == pytest.approx([c * self.L**3 / 3, 0.0, c * self.L**4 / 4], rel=1e-12)

    def test_sway_and_yaw_together_converge_to_the_integral(self):
        v, r = 1.0, 0.04  # the strip at x = -25 is at rest
        x0 = -v / r
        a, b = -self.L / 2, self.L / 2

        def moment(x):  # of |v + x r| (v + x r) x, indefinite, for positive v + x r
            return v**2 * x**2 / 2 + 2 * v * r * x**3 / 3 + r**2 * x**4 / 4

        N = -0.5 * RHO * self.CD * self.T * (moment(b) - 2 * moment(x0) + moment(a))
        errors = [abs(force(self.load(strips=n), [0, v, 0, 0, 0, r])[5] / N - 1) for n in (10, 40, 160)]
        assert errors[1] < 1e-4
        assert errors[2] < errors[0] / 50

    def test_heave_and_pitch(self):
        load = self.load(beam=18.0, cd_vertical=1.2)
        c = 0.5 * RHO * 1.2 * 18.0
        assert force(load, [0, 0, -2.0, 0, 0, 0])[[2, 4]] == pytest.approx([c * self.L * 4, 0.0], abs=1e-6)
        assert force(load, [0, 0, 0, 0, 0.1, 0])[4] == pytest.approx(-c * 2 * (self.L / 2) ** 4 / 4 * 0.01)
        assert load.covers == {quadratic_effect(d) for d in ("sway", "yaw", "heave", "pitch")}

    def test_mirror_image(self):
        load = CrossFlowDrag(np.linspace(-50, 60, 9), np.linspace(4, 6, 9), cd=0.7)
        S = np.array([1.0, -1, 1, -1, 1, -1])
        nu = np.array([1.0, 0.4, -0.2, 0.1, 0.05, 0.03])
        assert force(load, S * nu) == pytest.approx(S * force(load, nu))

    def test_the_hull_gives_its_draught_and_breadth(self):
        hull = og.shapes.wigley(100.0, kind="parabolic", panels=3000)  # B 10, T 6.25, profile a rectangle
        load = CrossFlowDrag.from_hull(hull, cd=1.0, cd_vertical=1.0, rho=RHO)
        B, T = 10.0, 100.0 / 16
        F = force(load, [0, 1.0, 1.0, 0, 0, 0])
        assert F[1] == pytest.approx(-0.5 * RHO * T * 100.0, rel=2e-3)
        assert F[2] == pytest.approx(-0.5 * RHO * B * 100.0 * 2 / 3, rel=5e-3)

    def test_coefficients_of_the_sections(self):
        hull = og.shapes.box(100.0, 20.0, 5.0, panels=300)  # B / 2 T = 2: between 0.657 and 0.631
        by_curve = force(CrossFlowDrag.from_hull(hull), [0, 1.0, 0, 0, 0.0, 0])
        assert 0.64 < -by_curve[1] / (0.5 * 1025.0 * 500.0) < 0.65
        along = np.linspace(0.5, 1.5, 20)
        given = force(CrossFlowDrag.from_hull(hull, cd=along, strips=20), [0, 1.0, 0, 0, 0.0, 0])
        assert given[1] == pytest.approx(-0.5 * 1025.0 * 500.0, rel=1e-9)
        assert given[5] < 0.0  # more drag forward
        assert np.all(np.diff(section_drag_coefficient(np.linspace(0, 60, 99), 5.0)) <= 0.0)

    def test_refusals(self):
        with pytest.raises(og.InputError, match="ascending"):
            CrossFlowDrag([1.0, 0.0], 5.0, cd=1.0)
        with pytest.raises(og.InputError, match="beam"):
            CrossFlowDrag([0.0, 1.0], 5.0, cd=1.0, cd_vertical=1.0)
        with pytest.raises(og.InputError, match="draught"):
            CrossFlowDrag([0.0, 1.0], [5.0, -1.0], cd=1.0)
        with pytest.raises(og.InputError, match="strips"):
            CrossFlowDrag([0.0, 1.0], 5.0, cd=1.0, strips=0)


def test_stations_of_a_hull_integrate_to_its_volume():
    hull = og.shapes.s175(panels=2000)
    s = stations(hull, 400)
    step = s.x[1] - s.x[0]
    assert s.area.sum() * step == pytest.approx(hull.volume, rel=2e-4)
    assert s.draught.max() == pytest.approx(9.5, abs=1e-6)
    assert s.breadth.max() == pytest.approx(25.4, rel=1e-3)
    assert (s.area @ s.x) * step / hull.volume == pytest.approx(hull.center_of_buoyancy[0], abs=0.02)


def test_stations_of_a_hemisphere():
    s = stations(og.shapes.hemisphere(5.0, panels=4000), [0.0, 3.0, 9.0])
    assert s.draught == pytest.approx([5.0, 4.0, 0.0], rel=3e-3)
    assert s.breadth == pytest.approx([10.0, 8.0, 0.0], rel=3e-3)
    assert s.area == pytest.approx(np.pi / 2 * np.array([25.0, 16.0, 0.0]), rel=6e-3)
    assert s.girth == pytest.approx(np.pi * np.array([5.0, 4.0, 0.0]), rel=6e-3)


class TestPointDrag:
    def test_force_of_a_plate_is_moved_to_the_origin(self):
        rng = np.random.default_rng(1)
        point, d, nu = rng.normal(size=3), rng.normal(size=3), rng.normal(size=6)
        d /= np.linalg.norm(d)
        H = shift_matrix(point)
        along = d @ (H @ nu)[:3]
        expected = H.T @ np.r_[-2.0 * abs(along) * along * d, 0, 0, 0]
        assert force(PointDrag([point], d, 2.0), nu) == pytest.approx(expected)

    def test_member_feels_the_velocity_across_its_axis(self):
        column = PointDrag.from_members([[0, 0, -20.0]], [[0, 0, 0.0]], width=8.0, cd=1.0, rho=RHO)
        F = force(column, [3.0, 4.0, 7.0, 0, 0, 0])
        assert F[:3] == pytest.approx(-0.5 * RHO * 8.0 * 20.0 * 5.0 * np.array([3.0, 4.0, 0.0]))
        assert F[4] == pytest.approx(-10.0 * F[0])  # acts at z = -10: M = z F_x

    def test_rotating_member_converges_to_the_integral(self):
        """A column of length L turned about its upper end: 1/2 rho Cd D L^4 / 4 q^2."""
        exact = -0.5 * RHO * 8.0 * 20.0**4 / 4 * 0.1**2
        errors = []
        for n in (5, 10, 20):
            load = PointDrag.from_members([[0, 0, -20.0]], [[0, 0, 0.0]], width=8.0, cd=1.0, rho=RHO, segments=n)
            errors.append(abs(force(load, [0, 0, 0, 0, 0.1, 0])[4] / exact - 1))
        assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)
        assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.05)

    def test_members_are_cut_at_the_water_and_have_ends(self):
        start, end = [[0, 0, -20.0], [10.0, 0, 5.0]], [[0, 0, 10.0], [10.0, 0, -15.0]]
        load = PointDrag.from_members(start, end, width=4.0, cd=1.0, cd_end=1.0, rho=RHO, segments=3)
        assert len(load.data) == 2 * (3 + 1)
        disc = 0.5 * RHO * np.pi * 4.0
        assert force(load, [0, 0, 1.0, 0, 0, 0])[2] == pytest.approx(-2 * disc)
        assert force(load, [1.0, 0, 0, 0, 0, 0])[0] == pytest.approx(-0.5 * RHO * 4.0 * (20 + 15))

    def test_bilge_keels_resist_roll_alone(self):
        load = PointDrag.bilge_keels([-30.0, 0.0, 30.0], y=8.0, z=-6.0, breadth=0.4, cd=4.0, rho=RHO)
        F = force(load, [0, 0, 0, 0.2, 0, 0])
        assert F[3] == pytest.approx(-RHO * 4.0 * 0.4 * 60.0 * 10.0**3 * 0.04)
        assert F[1] == pytest.approx(F[3] * 6.0 / 100.0)  # both push to one side: lever z = -6 of the radius 10
        assert F[[0, 2, 4, 5]] == pytest.approx(0.0, abs=1e-6)
        assert load.covers == {quadratic_effect("roll")}

    def test_covers_what_meets_resistance(self):
        load = PointDrag([[0.0, 3.0, 0.0]], [0.0, 0.0, 1.0], 1.0)
        assert load.covers == {quadratic_effect("heave"), quadratic_effect("roll")}

    def test_refusals(self):
        with pytest.raises(og.InputError, match="some length"):
            PointDrag([[0, 0, 0]], [0, 0, 0], 1.0)
        with pytest.raises(og.InputError, match="kind"):
            PointDrag([[0, 0, 0]], [0, 0, 1], 1.0, kind="disc")
        with pytest.raises(og.InputError, match="below the water"):
            PointDrag.from_members([[0, 0, 1.0]], [[0, 0, 2.0]], width=1.0, cd=1.0)
        with pytest.raises(og.InputError, match="points"):
            PointDrag([0, 0, 0], [0, 0, 1], 1.0)


def test_damping_refusals():
    with pytest.raises(og.InputError, match="roll"):
        QuadraticDamping({"roll": -1.0})
    with pytest.raises(og.InputError, match="shape"):
        QuadraticDamping(np.eye(3))
    with pytest.raises(og.InputError, match="both"):
        RollDamping(linear=1.0, ratio=0.1)
    with pytest.raises(og.InputError, match="none found"):
        RollDamping()
    with pytest.raises(og.InputError, match="quadratic"):
        RollDamping(quadratic=-1.0)
    with pytest.raises(og.InputError, match="number"):
        RollDamping(quadratic="much")
