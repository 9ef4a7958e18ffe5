"""Calm-water resistance: the friction line, its guard at rest, both directions, tables and the balancing thrust."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.loads.base import Load
from ogilvie.loads.resistance import CALM_WATER, VISCOSITY, WIND, SurgeResistance, friction_coefficient

S, L, RHO = 5500.0, 175.0, 1025.0
FN = np.array([0.1, 0.15, 0.2, 0.25, 0.3])
CR = np.array([0.4, 0.5, 0.6, 0.9, 1.6]) * 1e-3


def force(load, u, u_r=None):
    nu_r = None if u_r is None else [u_r, 0, 0, 0, 0, 0]
    F = load.bind(None).kernel.force(nu=[u, 0, 0, 0, 0, 0], nu_r=nu_r)
    assert not F[1:].any()
    return F[0]


def test_friction_line():
    for Rn in (1e7, 1e8, 1e9):
        assert friction_coefficient(Rn) == pytest.approx(0.075 / (np.log10(Rn) - 2) ** 2, rel=1e-4)
    assert friction_coefficient(1e9) == pytest.approx(0.075 / 49)


def test_resistance_is_the_sum_of_its_parts():
    load = SurgeResistance(area=S, length=L, form_factor=0.2, allowance=4e-4, residuary=(FN, CR), air_area=400.0, air_cd=0.8)
    assert isinstance(load, Load)
    assert load.covers == {CALM_WATER, WIND}
    u, u_r = 9.0, 0.2 * np.sqrt(9.80665 * L)
    C = 1.2 * friction_coefficient(u_r * L / VISCOSITY) + 4e-4 + 0.6e-3
    expected = -0.5 * RHO * S * C * u_r**2 - 0.5 * 1.225 * 400.0 * 0.8 * u**2
    assert force(load, u, u_r) == pytest.approx(expected, rel=1e-10)


def test_odd_and_smooth_through_rest():
    load = SurgeResistance(area=S, length=L, form_factor=0.2)
    assert load.covers == {CALM_WATER}
    u = np.array([1e-9, 1e-6, 1e-4, 1e-2, 0.1, 1.0])
    R = load.resistance(u)
    assert load.resistance(-u) == pytest.approx(-R)
    assert np.all(np.diff(R / u) > 0.0)  # R / u falls to zero with u
    assert R[0] / u[0] ** 2 == pytest.approx(0.5 * RHO * S * 1.2 * 0.075 / 9, rel=1e-6)
    assert force(load, 0.0) == 0.0


def test_astern_factor():
    load = SurgeResistance(area=S, length=L, astern=1.3)
    assert load.resistance(-4.0) == pytest.approx(-1.3 * load.resistance(4.0))


def test_residuary_table_is_met_held_below_and_refused_above():
    with_table = SurgeResistance(area=S, length=L, residuary=(FN, CR))
    without = SurgeResistance(area=S, length=L)
    u = FN * np.sqrt(9.80665 * L)
    found = (with_table.resistance(u) - without.resistance(u)) / (0.5 * RHO * S * u**2)
    assert found == pytest.approx(CR, rel=1e-9)
    assert (with_table.resistance(1.0) - without.resistance(1.0)) / (0.5 * RHO * S) == pytest.approx(CR[0])
    assert np.isnan(force(with_table, 1.01 * u[-1]))


def test_table_of_a_cubic_is_exact():
    u = np.linspace(0.0, 12.0, 7)
    load = SurgeResistance.from_table(u, 100 * u + 50 * u**2 + 3 * u**3)
    v = np.array([0.3, 5.1, 11.9])
    assert load.resistance(v) == pytest.approx(100 * v + 50 * v**2 + 3 * v**3)
    assert np.isnan(load.resistance(12.5))


def test_table_of_both_directions():
    u = np.linspace(-6.0, 12.0, 9)
    load = SurgeResistance.from_table(u, 100 * u + 50 * u**2 + 3 * u**3, balanced_at=5.0)
    v = np.array([-5.3, -0.1, 0.0, 5.1, 11.9])
    assert load.resistance(v) == pytest.approx(100 * v + 50 * v**2 + 3 * v**3)
    assert force(load, 5.0) == pytest.approx(0.0, abs=1e-9)
    assert np.isnan(load.resistance([-6.5, 12.5])).all()
    with pytest.raises(og.InputError, match="astern"):
        SurgeResistance.from_table(u, u, astern=1.2)


def test_thrust_holds_the_speed_and_brings_it_back():
    load = SurgeResistance(area=S, length=L, form_factor=0.15, balanced_at=8.0)
    assert load.thrust == pytest.approx(float(load.resistance(8.0)))
    assert force(load, 8.0) == 0.0
    assert force(load, 7.9) > 0.0 > force(load, 8.1)
    assert SurgeResistance(area=S, length=L).thrust == 0.0


def test_decay_of_speed_with_constant_coefficient_has_its_closed_form():
    """m u' = -c u^2: u = u0 / (1 + c u0 t / m), by Runge-Kutta steps through the kernel."""
    u_table = np.linspace(0.0, 10.0, 5)
    load, m = SurgeResistance.from_table(u_table, 2e4 * u_table**2), 2e7
    kernel, u, dt = load.bind(None).kernel, 8.0, 1.0
    rate = lambda v: kernel.force(nu=[v, 0, 0, 0, 0, 0])[0] / m  # noqa: E731
    for _ in range(200):
        k1 = rate(u)
        k2 = rate(u + dt / 2 * k1)
        k3 = rate(u + dt / 2 * k2)
        u += dt / 6 * (k1 + 2 * k2 + 2 * k3 + rate(u + dt * k3))
    assert u == pytest.approx(8.0 / (1 + 2e4 * 8.0 * 200 / m), rel=1e-9)


def test_refusals():
    with pytest.raises(og.InputError, match="area"):
        SurgeResistance(area=0.0, length=L)
    with pytest.raises(og.InputError, match="n >= 4"):
        SurgeResistance(area=S, length=L, residuary=([0.1, 0.2], [1e-3, 1e-3]))
    with pytest.raises(og.InputError, match="balanced_at"):
        SurgeResistance.from_table([0, 1, 2, 3], [0, 1, 4, 9], balanced_at=4.0)
    with pytest.raises(og.InputError, match="zero speed"):
        SurgeResistance.from_table([1, 2, 3, 4], [1, 4, 9, 16])
