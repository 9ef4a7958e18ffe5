"""Hulls from coefficients: the coefficients come out, the hull is fair, what cannot be is refused."""

import re

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from ogilvie.errors import InputError
from ogilvie.mesh.fairing import Basis, Constraints, smoothest, span
from ogilvie.mesh.form import form_curves, section_points
from ogilvie.mesh.hydrostatics import hydrostatics
from ogilvie.mesh.inspect import check_mesh
from ogilvie.mesh.particulars import completed, from_particulars, stations

SHIPS = {
    "KVLCC2": {"length": 320.0, "beam": 58.0, "draught": 20.8, "cb": 0.8098, "cm": 0.998, "cwp": 0.90, "lcb": 0.0348},
    "DTMB5415": {"length": 142.0, "beam": 19.06, "draught": 6.15, "cb": 0.508, "cm": 0.819, "cwp": 0.774, "lcb": -0.0055},
    "S175": {"length": 175.0, "beam": 25.4, "draught": 9.5, "cb": 0.572, "cm": 0.970, "cwp": 0.711, "lcb": -0.0142},
    "HYSY201": {"length": 185.0, "beam": 39.2, "draught": 8.959, "cb": 0.8274},
    "Series 60, 0.60": {
        "length": 121.92,
        "beam": 16.256,
        "draught": 6.502,
        "cb": 0.60,
        "cm": 0.977,
        "cwp": 0.706,
        "lcb": -0.015,
    },
    "Series 60, 0.80": {
        "length": 121.92,
        "beam": 18.757,
        "draught": 7.503,
        "cb": 0.80,
        "cm": 0.994,
        "cwp": 0.871,
        "lcb": 0.025,
    },
    "supply": {"length": 82.8, "beam": 19.2, "draught": 6.0, "cb": 0.651, "cm": 0.98, "cwp": 0.85, "lcb": -0.02},
    "frigate": {"length": 120.0, "beam": 14.0, "draught": 4.5, "cb": 0.45, "cm": 0.78, "cwp": 0.73, "lcb": -0.02},
    "transom": {
        "length": 120.0,
        "beam": 14.0,
        "draught": 4.5,
        "cb": 0.47,
        "cm": 0.8,
        "cwp": 0.76,
        "lcb": -0.02,
        "transom": 0.06,
    },
    "tanker": {"length": 250.0, "beam": 44.0, "draught": 15.0, "cb": 0.85},
    "barge": {"length": 100.0, "beam": 30.0, "draught": 6.0, "cb": 0.93},
}


def form_of(ship):
    return completed(**{k: v for k, v in ship.items() if k not in ("length", "beam", "draught")})


@pytest.fixture(scope="module", params=SHIPS, ids=list(SHIPS))
def ship(request):
    particulars = SHIPS[request.param]
    return particulars, from_particulars(**particulars, panels=1000, name=request.param), form_curves(form_of(particulars))


def test_coefficients_come_out(ship):
    p, mesh, curves = ship
    form, L, B, T = curves.form, p["length"], p["beam"], p["draught"]
    h = hydrostatics(mesh)
    assert mesh.volume / (L * B * T) == pytest.approx(form.cb, rel=1e-4)
    assert h.waterplane_area / (L * B) == pytest.approx(form.cwp, rel=2e-3)
    assert mesh.center_of_buoyancy[0] / L == pytest.approx(form.lcb, abs=5e-4)
    np.testing.assert_allclose([mesh.length, mesh.beam, mesh.draught], [L, B, T], rtol=1e-3)


def test_midship_section_has_its_coefficient(ship):
    _, _, curves = ship
    y, z = dict(stations(curves, length=2.0, beam=2.0, draught=1.0, depth=1.3))[0.0].T
    wet = z <= 0.0
    assert np.trapezoid(y[wet], z[wet]) == pytest.approx(curves.form.cm, rel=2e-3)


def test_mesh_is_closed_and_clean(ship):
    _, mesh, _ = ship
    assert check_mesh(mesh).findings == ()
    assert 800 < 2 * mesh.n_faces <= 1000


def test_sectional_area_and_waterline_rise_to_midship_and_fall(ship):
    _, _, curves = ship
    x = np.linspace(-1.0, 1.0, 801)
    for curve in (curves.area(x), curves.breadth(x)):
        assert curve.min() > -1e-9
        assert curve.max() < 1.0 + 1e-9
        assert np.diff(curve[:401]).min() > -1e-4
        assert np.diff(curve[400:]).max() < 1e-4
    assert np.all(curves.area(x) <= curves.breadth(x) + 1e-3)


def test_sections_widen_upward_and_the_keel_rises_towards_the_ends(ship):
    p, _, curves = ship
    listed = stations(curves, length=p["length"], beam=p["beam"], draught=p["draught"], depth=1.3 * p["draught"])
    for _, points in listed:
        y, z = points.T
        assert y.min() >= 0.0
        assert np.diff(y).min() > -1e-9
        assert np.diff(z).min() > -1e-9
    keel = np.array([points[0, 1] for _, points in listed])
    middle = int(np.argmin(keel))
    assert np.diff(keel[: middle + 1]).max(initial=0.0) < 1e-9
    assert np.diff(keel[middle:]).min(initial=0.0) > -1e-9
    lower = np.array([np.interp(-0.5 * p["draught"], q[:, 1], q[:, 0], left=0.0) for _, q in listed])
    assert np.diff(lower[: len(lower) // 2]).min() > -2e-3 * p["beam"]
    assert np.diff(lower[len(lower) // 2 :]).max() < 2e-3 * p["beam"]


@settings(max_examples=12, deadline=None)
@given(st.floats(0.42, 0.86), st.floats(-0.02, 0.04), st.floats(-0.012, 0.012))
def test_any_ordinary_ship_is_possible(cb, more_cwp, shift):
    usual = completed(cb=cb)
    cwp = usual.cwp + more_cwp
    assume(cwp > usual.cp + 0.02)
    form = completed(cb=cb, cwp=cwp, lcb=usual.lcb + shift)
    curves = form_curves(form)
    x = np.linspace(-1.0, 1.0, 2001)
    S = curves.area(x)
    assert np.trapezoid(S, x) / 2.0 == pytest.approx(form.cp, rel=1e-5)
    assert np.trapezoid(S * x, x) / np.trapezoid(S, x) / 2.0 == pytest.approx(form.lcb, abs=1e-6)
    assert np.trapezoid(curves.breadth(x), x) / 2.0 == pytest.approx(form.cwp, rel=1e-5)


def test_box_is_the_limit_of_barges():
    mesh = from_particulars(length=100.0, beam=30.0, draught=6.0, cb=1.0, panels=600)
    assert mesh.volume == pytest.approx(18000.0, rel=1e-9)
    np.testing.assert_allclose(mesh.bounds, [[-50.0, -15.0, -6.0], [50.0, 15.0, 0.0]], atol=1e-9)


def test_freeboard_reaches_the_deck():
    hull = from_particulars(**SHIPS["S175"], depth=15.4, panels=500, above_water=True)
    assert hull.bounds[1, 2] == pytest.approx(5.9)
    assert hull.immersed().volume == pytest.approx(0.572 * 175.0 * 25.4 * 9.5, rel=1e-4)


def test_impossible_coefficients_name_the_possible_ranges():
    asked = {"cb": 0.5, "cm": 0.98, "cwp": 0.9, "lcb": 0.0}
    with pytest.raises(InputError, match="no fair ship") as caught:
        from_particulars(length=100.0, beam=15.0, draught=5.0, **asked)
    for key in ("cb", "cwp", "lcb"):
        low, high = map(float, re.search(rf"{key} (-?[\d.]+) to (-?[\d.]+)", str(caught.value)).groups())
        assert not low <= asked[key] <= high
        nearest = low if asked[key] < low else high
        form_curves(completed(**{**asked, key: nearest + 0.05 * np.sign(nearest - asked[key]) * (high - low)}))  # it is true


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cb": 1.2}, "cb"),
        ({"cb": float("nan")}, "cb"),
        ({"cm": 0.5}, "cm"),
        ({"cwp": 0.4}, "cwp"),
        ({"lcb": 2.6}, "lcb"),
        ({"transom": -0.1}, "transom"),
        ({"ends": "bowl"}, "ends"),
        ({"length": 0.0}, "length"),
        ({"depth": 3.0}, "depth"),
        ({"panels": 3}, "panels"),
    ],
)
def test_nonsense_is_refused(change, message):
    with pytest.raises(InputError, match=message):
        from_particulars(**{"length": 100.0, "beam": 15.0, "draught": 5.0, "cb": 0.7, **change})


def test_defaults_are_the_statistics_of_the_docstring():
    form = completed(cb=0.7)
    assert form.cm == pytest.approx(1.006 - 0.0056 * 0.7**-3.56)
    assert form.cwp == pytest.approx(2.4 / 3.0)
    assert form.lcb == pytest.approx(-0.135 + 0.194 * 0.7 / form.cm)
    assert completed(cb=0.95).ends == "barge"
    assert completed(cb=0.95).lcb == 0.0


# ---- sections


@settings(max_examples=40, deadline=None)
@given(st.floats(0.3, 0.9994))
def test_section_family_has_the_area_asked_for(c):
    y, s = section_points(c).T
    fine = np.linspace(0.0, 1.0, 20001)
    area = np.trapezoid(np.interp(fine, s, y), fine)
    assert area == pytest.approx(c, abs=4e-3)
    assert (y[0], s[0], y[-1], s[-1]) == (0.0, 0.0, 1.0, 1.0)
    assert min(np.diff(y).min(), np.diff(s).min()) >= -1e-12


# ---- fairing


def test_fairest_curve_through_a_parabola_is_the_parabola():
    basis = Basis(12)
    x = np.array([-0.8, 0.1, 0.7])
    A = np.vstack([basis.rows(x), basis.integral()])
    b = np.r_[1.0 - x**2 + 0.3 * x, 4.0 / 3.0]
    none = np.zeros((0, basis.size))
    found = smoothest(basis.roughness(), Constraints(A, b, none, np.zeros(0)))
    at = np.linspace(-1.0, 1.0, 50)
    np.testing.assert_allclose(basis.curve(found)(at), 1.0 - at**2 + 0.3 * at, atol=1e-6)


def test_integrals_of_splines():
    basis = Basis(8)
    one, line = np.ones(basis.size), np.linalg.lstsq(basis.rows(basis.points), basis.points, rcond=None)[0]
    assert basis.integral() @ one == pytest.approx(2.0)
    assert basis.integral(1) @ line == pytest.approx(2.0 / 3.0)
    cubic = np.linalg.lstsq(basis.rows(basis.points), basis.points**3, rcond=None)[0]
    assert np.sum((basis.roughness() @ cubic) ** 2) == pytest.approx(2.0 * 36.0)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**31))
def test_least_distance_solution_meets_the_optimality_conditions(seed):
    rng = np.random.default_rng(seed)
    R, A, G = rng.normal(size=(8, 6)), rng.normal(size=(2, 6)), rng.normal(size=(9, 6))
    inside = rng.normal(size=6)
    c = Constraints(A, A @ inside, G, G @ inside - rng.uniform(0.0, 1.0, 9))
    x = smoothest(R, c)
    np.testing.assert_allclose(A @ x, c.b, atol=1e-9)
    slack = G @ x - c.h
    assert slack.min() > -1e-8
    active = slack < 1e-7
    columns = np.hstack([A.T, G[active].T])  # gradient = A' nu + G' mu with mu >= 0
    multipliers, *_ = np.linalg.lstsq(columns, R.T @ R @ x, rcond=None)
    np.testing.assert_allclose(columns @ multipliers, R.T @ R @ x, atol=1e-5)
    assert multipliers[2:].min(initial=0.0) > -1e-5


def test_contradicting_conditions_have_no_solution():
    G = np.array([[1.0, 0.0], [-1.0, 0.0]])
    c = Constraints(np.array([[0.0, 1.0]]), np.array([0.0]), G, np.array([1.0, 0.0]))  # x >= 1 and x <= 0
    assert smoothest(np.eye(2), c) is None
    assert span(np.array([1.0, 0.0]), c) is None


def test_span_is_the_range_of_a_linear_function():
    G = np.vstack([np.eye(2), -np.eye(2)])
    c = Constraints(np.array([[1.0, 1.0]]), np.array([1.0]), G, np.array([0.0, 0.0, -0.8, -1.0]))
    assert span(np.array([1.0, 0.0]), c) == pytest.approx((0.0, 0.8))
