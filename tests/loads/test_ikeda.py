"""Ikeda's roll damping: geometry, levers by quadrature, limits and scaling, then measured sections and another program."""

from dataclasses import fields

import numpy as np
import pytest

import ogilvie as og
from ogilvie.loads.base import RADIATION, Load, Surroundings, viscous_effect
from ogilvie.loads.ikeda import IkedaHull
from ogilvie.loads.ikeda_damping import IkedaRollDamping
from ogilvie.loads.ikeda_eddy import bilge_radius, eddy_coefficient, lewis_coefficients
from ogilvie.loads.ikeda_keels import keel_damping, levers
from ogilvie.loads.ikeda_wave import wave_roll_damping, wave_speed_factor
from ogilvie.loads.viscous import quadratic_effect

BODY = og.RigidBody(mass=1.0, cog=[0, 0, 0], inertia=np.eye(3))


def prism(scale=1.0, og=0.5, keels=(-30.0, 30.0, 0.4), **more):
    """A ship of one section, 100 x 20 x 8 m."""
    x = np.array([-50.0, 0.0, 50.0]) * scale
    keels = None if keels is None else tuple(k * scale for k in keels)
    args = dict(length=100.0 * scale, beam=20.0 * scale, draught=8.0 * scale, cb=0.95, cm=0.95, og=og * scale, x=x)
    args |= dict(breadth=20.0 * scale, section_draught=8.0 * scale, area=152.0 * scale**2, keels=keels)
    return IkedaHull(**(args | more))


@pytest.mark.parametrize(("H0", "sigma"), [(1.25, 0.95), (0.5, 0.6), (2.0, 0.8), (1.0, 0.7)])
def test_lewis_section_has_the_ratio_and_the_area(H0, sigma):
    a1, a3 = lewis_coefficients(H0, sigma)
    psi = np.linspace(0.0, np.pi / 2, 20001)  # 0: keel
    y = (1 + a1) * np.sin(psi) - a3 * np.sin(3 * psi)
    z = (1 - a1) * np.cos(psi) + a3 * np.cos(3 * psi)
    assert y[-1] / z[0] == pytest.approx(H0, rel=1e-9)
    assert -np.trapezoid(y, z) / (y[-1] * z[0]) == pytest.approx(sigma, rel=1e-7)


def test_bilge_radius_of_a_round_bilge():
    assert bilge_radius(12.0, 5.0, 60.0 - 2 * 4.0 * (1 - np.pi / 4)) == pytest.approx(2.0)
    assert bilge_radius(12.0, 5.0, 60.0) == 0.0
    assert bilge_radius(12.0, 5.0, 20.0) == 5.0
    assert bilge_radius(6.0, 5.0, 10.0) == 3.0


def contour(H0, m1, m2, number=400001):
    """Points from the waterline down to the centreline: girth from the keel (at mid bilge), lever of a unit inward pressure."""
    side, arc, bottom = 1 - m1, np.pi / 2 * m1, H0 - m1
    s = np.linspace(0.0, side + arc + bottom, number)
    keel = side + arc / 2
    t = np.clip((s - side) / max(m1, 1e-300), 0.0, np.pi / 2)  # 0 on the side, pi/2 on the bottom
    y, z = H0 - m1 + m1 * np.cos(t), -(1 - m1) - m1 * np.sin(t)
    z, y = np.where(s < side, -s, z), np.where(s > side + arc, H0 - m1 - (s - side - arc), y)
    inward_y, inward_z = -np.cos(t), np.sin(t)
    return s - keel, y * inward_z - (z + m2) * inward_y


@pytest.mark.parametrize(("H0", "m1", "m2", "length"), [(1.3, 0.35, 0.05, 0.6), (1.3, 0.35, -0.2, 0.2), (0.8, 0.5, 0.1, 0.3)])
def test_levers_are_the_integrals_that_they_stand_for(H0, m1, m2, length):
    """One keel has its lee towards the bottom, that of the other side towards the waterline."""
    g, lever = contour(H0, m1, m2)
    step = g[1] - g[0]
    towards_bottom, towards_side = g >= 0, g < 0
    low = lever[towards_bottom & (g < length)].sum() - lever[towards_side & (g > -length)].sum()
    before_bottom = (lever * (1 - g / g[-1]))[towards_bottom].sum()
    before_side = (lever * (1 - g / g[0]))[towards_side].sum()
    A, B = levers(H0, m1, m2, length)
    assert low * step == pytest.approx(float(A), abs=2e-5)
    assert (before_bottom - before_side) * step == pytest.approx(float(B), abs=2e-5)


def test_levers_agree_with_the_published_polynomials():
    """Himeno (1981): m5, m6 to three digits."""
    H0, m1, m2 = 1.34, 0.45, 0.1
    m3, m4, root = 1 - m1 - m2, H0 - m1, (H0 - 0.215 * m1) * (1 - 0.215 * m1)
    m5 = (0.414 * H0 + 0.0651 * m1**2 - (0.382 * H0 + 0.0106) * m1) / root
    m6 = (0.414 * H0 + 0.0651 * m1**2 - (0.382 + 0.0106 * H0) * m1) / root
    B = m4**3 / (3 * (H0 - 0.215 * m1)) + (1 - m1) ** 2 * (2 * m3 - m2) / (6 * (1 - 0.215 * m1)) + m1 * (m3 * m5 + m4 * m6)
    assert float(levers(H0, m1, m2, 0.5)[1]) == pytest.approx(B, rel=1e-3)


def test_normal_force_of_keels_is_the_drag_of_plates():
    """Point drag with the same coefficient, averaged over a cycle."""
    from ogilvie.loads.point_drag import PointDrag

    B, d, b, a, w, rho = 20.0, 8.0, 0.4, 0.15, 0.6, 1000.0
    one = np.ones(1)
    N, _ = keel_damping(B * one, d * one, B * d * 0.9 * one, 0 * one, keel=b * one, og=0.0, amplitude=a * one)
    r = np.hypot(B / 2, d)
    cd = 22.5 * b / (np.pi * r * a * (1 + 0.3 * np.exp(-16.0))) + 2.4
    keels = PointDrag.bilge_keels([0.0, 1.0], y=B / 2, z=-d, breadth=b, cd=cd, rho=rho)
    K = -keels.bind(None).kernel.force(nu=[0, 0, 0, 1.0, 0, 0])[3]
    assert rho * w * a * N[0] == pytest.approx(8 / (3 * np.pi) * K * w * a, rel=1e-6)


def test_friction_is_katos_formula():
    """B_F = 0.787 rho S r^2 (omega nu)^1/2 (1 + 0.00814 (r^2 phi^2 omega / nu)^0.386), as Himeno has it."""
    ship, a, w, nu = prism(), 0.1, 0.5, 1.1892e-6
    girth = 1.7 * 8 + 0.95 * 20
    r = ((0.887 + 0.145 * 0.95) * girth - 2 * 0.5) / np.pi
    laminar = 0.787 * 1025.0 * 100 * girth * r**2 * np.sqrt(w * nu)
    expected = laminar * (1 + 0.00814 * (r**2 * a**2 * w / nu) ** 0.386)
    assert ship.components(amplitude=a, omega=w).friction == pytest.approx(expected, rel=2e-3)
    at_speed = ship.components(amplitude=a, omega=w, speed=8.0).friction
    assert at_speed == pytest.approx(expected * (1 + 4.1 * 8 / (w * 100)), rel=2e-3)


def test_components_are_dimensionally_right():
    """Froude scaling: all but friction grow with the power 4.5 of the length."""
    q = 16.0
    one, large = prism(), prism(q)
    for speed in (0.0, 6.0):
        a = one.components(amplitude=0.12, omega=0.8, speed=speed, wave=1e6)
        b = large.components(amplitude=0.12, omega=0.8 / 4, speed=speed * 4, wave=1e6 * q**4.5)
        for f in fields(a):
            ratio = getattr(b, f.name) / q**4.5
            if f.name == "friction":
                assert ratio < 0.9 * a.friction
            else:
                assert ratio == pytest.approx(getattr(a, f.name), rel=1e-9)


def test_growth_with_amplitude_frequency_and_speed():
    ship = prism()
    a = np.array([0.05, 0.1, 0.2])
    rest = ship.components(amplitude=a, omega=0.5)
    assert rest.eddy == pytest.approx(rest.eddy[0] * a / a[0])
    assert not rest.lift.any()
    assert not rest.wave.any()
    assert rest.total == pytest.approx(rest.viscous)
    fast = ship.components(amplitude=a, omega=0.5, speed=5.0)
    k = 0.04 * 0.5 * 100 / 5.0
    assert fast.eddy == pytest.approx(rest.eddy * k**2 / (1 + k**2))
    assert ship.components(amplitude=0.1, omega=0.5, speed=10.0).lift == pytest.approx(2 * fast.lift[0])
    assert ship.components(amplitude=0.1, omega=0.5, speed=-5.0).lift == pytest.approx(fast.lift[0])
    assert fast.keel_force == pytest.approx(rest.keel_force)
    bare = prism(keels=None).components(amplitude=a, omega=0.5)
    assert not bare.keel_force.any()
    assert bare.eddy == pytest.approx(rest.eddy)


def test_lift_by_hand():
    m, o, U = 0.95 - 0.91, 0.5, 7.0
    kN = 2 * np.pi * 8 / 100 + (106 * m**2 - 700 * m**3) * (4.1 * 20 / 100 - 0.045)
    expected = 0.5 * 1025 * 100 * 8 * U * kN * 2.4 * 4.0 * (1 - 1.4 * o / 4.0 + 0.7 * o**2 / 9.6)
    assert prism().components(amplitude=0.1, omega=0.5, speed=U).lift == pytest.approx(expected)


def test_wave_factor_is_one_at_rest_and_has_its_limits():
    w = np.array([0.5, 0.8, 1.2])
    assert wave_speed_factor(w, speed=0.0, draught=9.5) == pytest.approx(1.0, abs=2e-3)
    k = w**2 * 9.5 / 9.80665
    fast = wave_speed_factor(w, speed=9.80665 / w, draught=9.5)  # tau = 1
    assert fast == pytest.approx(0.5 + np.exp(-2 * k) / k, rel=1e-6)
    quarter = wave_speed_factor(w, speed=0.25 * 9.80665 / w, draught=9.5)
    assert np.all(quarter > 1.0)


def test_wave_damping_about_the_axis_of_roll():
    B = np.zeros((3, 6, 6))
    B[:, 1, 1], B[:, 3, 3] = [1.0, 2.0, 4.0], [10.0, 20.0, 40.0]
    B[:, 1, 3] = B[:, 3, 1] = [2.0, 3.0, 5.0]
    data = og.hydro_from_arrays(omega=[0.5, 1.0, 1.5], added_mass=0 * B, radiation_damping=B)
    assert wave_roll_damping(data, [0.5, 0.75], cog=[0, 0, 2.0]) == pytest.approx([10 + 8 + 4, 15 + 2 * 5 + 4 * 1.5])
    with pytest.raises(og.InputError, match="rad/s"):
        wave_roll_damping(data, 2.0, cog=[0, 0, 0])
    heave = og.hydro_from_arrays(omega=[0.5, 1.0], added_mass=B[:2, :1, :1], radiation_damping=B[:2, :1, :1], dofs=("heave",))
    with pytest.raises(og.InputError, match="sway"):
        wave_roll_damping(heave, 0.7, cog=[0, 0, 0])


class TestLoad:
    @pytest.mark.parametrize("model", ["cubic", "quadratic", "linear"])
    def test_bound_load_takes_the_energy_of_the_method(self, model):
        ship, a, w, U = prism(), 0.3, 0.5, 6.0
        load = IkedaRollDamping(ship, omega=w, amplitude=a, model=model)
        assert isinstance(load, Load)
        assert load.covers == {viscous_effect("roll"), quadratic_effect("roll")}
        terms = load.bind(Surroundings(BODY, speed=U))
        t = np.linspace(0, 2 * np.pi / w, 2001)
        for part, within in ((1.0, 0.06), (0.5, 0.1)) if model != "linear" else ((1.0, 1e-6),):
            p = part * a * w * np.cos(w * t)
            drag = [terms.kernel.force(nu=[0, 0, 0, v, 0, 0])[3] if terms.kernel else 0.0 for v in p]
            work = np.trapezoid(terms.damping[3, 3] * p**2 - np.array(drag) * p, t)
            B = ship.components(amplitude=part * a, omega=w, speed=U).total
            within = 0.01 if model == "cubic" else within
            assert work / (np.pi * w * (part * a) ** 2) == pytest.approx(float(B), rel=within)
        assert np.count_nonzero(terms.damping) == 1

    def test_wave_part_is_claimed_when_given(self):
        ship = prism()
        bare, waves = (IkedaRollDamping(ship, omega=0.5, amplitude=0.2, wave=w) for w in (None, 3e7))
        assert RADIATION in waves.covers - bare.covers
        difference = np.subtract(waves.coefficients(speed=0.0), bare.coefficients(speed=0.0))
        assert difference == pytest.approx([3e7 * wave_speed_factor(0.5, speed=0.0, draught=8.0), 0, 0], rel=1e-6, abs=1.0)

    def test_refusals(self):
        with pytest.raises(og.InputError, match="model"):
            IkedaRollDamping(prism(), omega=0.5, amplitude=0.2, model="cube")
        with pytest.raises(og.InputError, match="omega"):
            IkedaRollDamping(prism(), omega=0.0, amplitude=0.2)
        with pytest.raises(og.InputError, match="keels"):
            prism(keels=(-60.0, 30.0, 0.4))
        with pytest.raises(og.InputError, match="cb and cm"):
            prism(cb=1.2)
        with pytest.raises(og.InputError, match="roll axis"):
            prism(og=9.0)
        with pytest.raises(og.InputError, match="amplitudes"):
            prism().components(amplitude=0.0, omega=0.5)


def test_hull_gives_its_particulars():
    hull = og.shapes.s175(panels=2000)
    ship = IkedaHull.from_hull(hull, cog=[-2.5, 0.0, 0.05], length=175.0)
    assert [ship.beam, ship.draught, ship.og] == pytest.approx([25.4, 9.5, -0.05], rel=1e-3)
    assert ship.cb == pytest.approx(0.571, abs=0.003)
    assert ship.cm == pytest.approx(0.967, abs=0.003)


#: C_R of Ikeda's two-dimensional cylinders rolling about the waterline and by how much the formula misses the mean of them.
MISSES = {"A": 0.06, "B": 0.08, "C": 0.02, "D": 0.25, "G": 0.15, "I": 0.4, "J": 0.06, "K": 0.07, "L": 0.25}


def test_measured_eddy_damping_of_cylinders(shared_data):
    """Ikeda (1978), Table 1 (digitised): the formula with the radius of the models."""
    import csv

    with open(shared_data / "ikeda_2d_cylinders" / "ikeda_sections.csv") as file:
        rows = list(csv.DictReader(file))
    found = {}
    for r in rows:
        B, d, sigma = float(r["beam"]), float(r["T"]), float(r["sigma"])
        a1, a3 = lewis_coefficients(0.5 * B / d, sigma)
        assert [float(a1), float(a3)] == pytest.approx([float(r["a_1"]), float(r["a_3"])], abs=1e-5)
        radius = [float(r["R"])] if r["R"] else None
        C = float(eddy_coefficient([B], [d], [sigma * B * d], og=0.0, radius=radius)[0])
        found.setdefault(r["model"], []).append(C / float(r["C_r"]) - 1.0)
    for model, within in MISSES.items():
        assert abs(np.mean(found[model])) < within, model
    assert -0.8 < np.mean(found["H"]) < -0.65  # the formula gives next to nothing for this nearly round section
    assert np.median(np.abs([np.mean(v) for v in found.values()])) < 0.1


def test_s175_against_another_program():
    """VERES 4.02 for the S175, KG 9.55 m, bilge keels 0.35 m: its linear term is friction and the part of the keels that does
    not depend on the amplitude; its quadratic term is 0.510e9 + 0.2020e9 omega, where the last is its eddy part."""
    hull = og.shapes.s175(panels=2000)
    ship = IkedaHull.from_hull(hull, cog=[-2.55, 0.0, 0.05], keels=(-26.25, 26.25, 0.35), length=175.0)
    a = 1e-4
    for w, U, linear in [
        (0.1047, 0.0, 0.92928e6),
        (0.3142, 0.0, 2.6031e6),
        (0.6283, 0.0, 5.0584e6),
        (0.1047, 10.29, 1.2647e6),
        (0.6283, 10.29, 5.1954e6),
    ]:
        c = ship.components(amplitude=a, omega=w, speed=U)
        assert c.friction + c.keel_force + c.keel_pressure == pytest.approx(linear, rel=0.05)
    faster = (
        ship.components(amplitude=a, omega=0.1047, speed=10.29).friction - ship.components(amplitude=a, omega=0.1047).friction
    )
    assert faster == pytest.approx(1.2647e6 - 0.92928e6, rel=0.08)
    c, to_quadratic = ship.components(amplitude=0.1, omega=0.5), 8 / (3 * np.pi) * 0.5 * 0.1
    assert c.eddy / to_quadratic == pytest.approx(0.2020e9, rel=0.03)
    keels = [ship.components(amplitude=a, omega=0.5) for a in (1e-4, 0.05, 0.3)]
    grown = [((k.keel_force + k.keel_pressure) - (keels[0].keel_force + keels[0].keel_pressure)) for k in keels[1:]]
    low, high = np.array(grown) / (8 / (3 * np.pi) * 0.5 * np.array([0.05, 0.3]))
    assert low < 0.510e9 < high
