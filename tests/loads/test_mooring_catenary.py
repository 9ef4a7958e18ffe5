"""Statics of one elastic line: closed forms, the differential equation, a minimum of energy, and no jumps anywhere."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize

from ogilvie.loads.catenary import FAILED, GROUNDED, SLACK, SUSPENDED, anchor_tension, solve_line
from ogilvie.loads.catenary_shape import line_shape
from ogilvie.loads.mooring_line import MooringLine

CHAIN = (835.35, 108.63 * 9.81, 753.6e6)  # length m, weight N/m, EA N
RIGID = 1e16


def textbook(H, V, L, w, EA, friction, ground):
    """Place of the fairlead as Jonkman (2007) writes it, with inverse hyperbolic sines and the touchdown."""
    if ground and w * L > V:
        b = L - V / w
        l = b + H / w * np.arcsinh(V / H) + H * L / EA
        if friction > 0:
            x = H / (friction * w)
            l += friction * w / (2 * EA) * (-b * b + (b - x) * max(b - x, 0.0))
        return l, H / w * (np.hypot(1, V / H) - 1) + V * V / (2 * EA * w)
    a = (V - w * L) / H
    l = H / w * (np.arcsinh(V / H) - np.arcsinh(a)) + H * L / EA
    return l, H / w * (np.hypot(1, V / H) - np.hypot(1, a)) + (V * L - 0.5 * w * L * L) / EA


@pytest.mark.parametrize("sag", [0.02, 0.3, 2.0])
def test_inextensible_line_between_equal_heights(sag):
    l, w, a = 100.0, 50.0, 100.0 / (8 * sag)
    L = 2 * a * np.sinh(l / (2 * a))
    H, V, kind = solve_line(l, 0.0, L, w, RIGID, 0.0, 0.0)
    assert kind == SUSPENDED
    assert pytest.approx((w * a, 0.5 * w * L), rel=1e-7) == (H, V)


@pytest.mark.parametrize("a", [1.0, 40.0, 900.0])
def test_inextensible_line_on_the_ground(a):
    h, w = 100.0, 800.0
    s = np.sqrt(h * h + 2 * a * h)
    L = s + 200.0
    H, V, kind = solve_line(200.0 + a * np.arccosh(1 + h / a), h, L, w, RIGID, 0.7, 1.0)
    assert kind == GROUNDED
    assert pytest.approx((w * a, w * s), rel=1e-8) == (H, V)


def test_elastic_line_that_hangs_upright():
    L, w, EA = 100.0, 200.0, 1e6
    h = L + 3.0  # longer than its own weight stretches it: 1 m
    for ground in (0.0, 1.0):
        H, V, _ = solve_line(0.0, h, L, w, EA, 0.0, ground)
        assert pytest.approx(EA * (h - L) / L + 0.5 * w * L, rel=1e-9) == V
        assert pytest.approx(0.0, abs=1e-3) == H


def test_line_of_almost_no_weight_is_a_spring():
    L, EA = 100.0, 1e7
    l, h = 80.0, 63.0
    stretch = np.hypot(l, h) / L - 1
    H, V, kind = solve_line(l, h, L, 1e-6, EA, 0.0, 1.0)
    assert kind == SUSPENDED
    assert pytest.approx(EA * stretch * np.array([l, h]) / np.hypot(l, h), rel=1e-6) == [H, V]


def test_loop_that_hangs_from_one_place():
    L, w, EA = 50.0, 100.0, 1e9
    H, V, kind = solve_line(0.0, 0.0, L, w, EA, 0.0, 0.0)
    assert kind == SUSPENDED
    assert pytest.approx(0.5 * w * L, rel=1e-9) == V
    assert abs(H) < 1e-6 * w * L


def test_slack_line_carries_what_hangs():
    L, w, EA = 300.0, 500.0, 1e8
    s = brentq(lambda s: s + w * s * s / (2 * EA) - 80.0, 0.0, L)
    H, V, kind = solve_line(100.0, 80.0, L, w, EA, 0.5, 1.0)
    assert (H, kind) == (0.0, SLACK)
    assert pytest.approx(w * s, rel=1e-12) == V
    assert anchor_tension(H, V, L, w, 0.5, kind) == 0.0


@pytest.mark.parametrize("friction", [0.0, 0.2, 1.5])
@pytest.mark.parametrize(("l", "EA"), [(725.0, 753.6e6), (796.732, 753.6e6), (830.0, 2e6)])
def test_line_obeys_its_differential_equation(l, EA, friction):
    L, w, _ = CHAIN
    h = 186.0
    H, V, kind = solve_line(l, h, L, w, EA, friction, 1.0)
    assert kind == GROUNDED

    def line(s, y):
        T = y[2]  # y = (x, z, T) from the fairlead down; T is the horizontal pull in the part on the ground
        v = max(V - w * s, 0.0)
        pull = H if v > 0 else max(T, 0.0)
        t = np.hypot(pull, v)
        fall = -friction * w if v == 0.0 and T > 0.0 else 0.0
        stretch = (1 / t if t > 0 else 0.0) + 1 / EA
        return [-pull * stretch if v > 0 or T > 0 else -1.0, -v * stretch, fall]

    touch = V / w
    hung = solve_ivp(line, (0, touch * (1 - 1e-12)), [l, h, H], rtol=1e-10, atol=1e-9)
    ground = solve_ivp(line, (touch, L), [hung.y[0, -1], hung.y[1, -1], H], rtol=1e-10, atol=1e-9, max_step=(L - touch) / 400)
    assert ground.y[1, -1] == pytest.approx(0.0, abs=1e-6 * L)
    assert ground.y[0, -1] == pytest.approx(0.0, abs=1e-6 * L)
    assert anchor_tension(H, V, L, w, friction, kind) == pytest.approx(max(ground.y[2, -1], 0.0), abs=2e-3 * H)


def bars(n, l, h, L, w, EA):
    """Force of a chain of n straight elastic bars that holds itself up on z >= 0: the minimum of its energy."""
    d = L / n

    def energy(q):
        p = np.zeros((n + 1, 2))
        p[1:-1] = q.reshape(-1, 2)
        p[-1] = l, h
        e = np.diff(p, axis=0)
        r = np.hypot(*e.T)
        strain = r / d - 1
        pull = np.where(strain > 0, EA * strain, 0.0)[:, None] * e / r[:, None]
        g = np.zeros_like(p)
        g[1:] += pull
        g[:-1] -= pull
        g[1:-1, 1] += w * d
        total = 0.5 * EA * d * (np.maximum(strain, 0) ** 2).sum() + w * d * p[1:-1, 1].sum()
        return total / (w * L * h), g[1:-1].ravel() / (w * L * h), g[-1] + [0.0, 0.5 * w * d]

    start = np.linspace([0, 0], [l, h], n + 1)[1:-1]
    start[:, 1] = h * (start[:, 0] / l) ** 4
    bounds = [b for _ in range(n - 1) for b in ((None, None), (0.0, None))]
    options = {"maxiter": 40000, "maxfun": 80000, "ftol": 1e-16, "gtol": 1e-9, "maxcor": 60}
    out = minimize(lambda q: energy(q)[:2], start.ravel(), jac=True, bounds=bounds, method="L-BFGS-B", options=options)
    return energy(out.x)[2]


def test_line_is_the_limit_of_a_chain_of_elastic_bars():
    l, h, L, w, EA = 170.0, 60.0, 200.0, 1000.0, 4e6
    H, V, kind = solve_line(l, h, L, w, EA, 0.0, 1.0)
    assert kind == GROUNDED
    coarse, fine = bars(20, l, h, L, w, EA), bars(40, l, h, L, w, EA)
    assert fine == pytest.approx([H, V], rel=6e-3)
    assert np.abs(fine - [H, V]).max() < 0.5 * np.abs(coarse - [H, V]).max()


def test_no_jump_where_the_line_leaves_the_ground():
    L, w, EA = CHAIN
    h = 186.0
    q = h - 0.5 * w * L * L / EA
    limit = 0.5 * w * (L * L - q * q) / q
    l = limit / w * np.arcsinh(w * L / limit) + limit * L / EA
    below, above = (np.array(solve_line(l + e, h, *CHAIN, 0.4, 1.0)) for e in (-1e-7, 1e-7))
    assert (below[2], above[2]) == (GROUNDED, SUSPENDED)
    assert below[:2] == pytest.approx(above[:2], rel=1e-7)
    assert below[0] == pytest.approx(limit, rel=1e-7)


def test_no_jump_where_the_line_falls_slack():
    L, w, EA = CHAIN
    h = 186.0
    V = brentq(lambda V: V / w + V * V / (2 * EA * w) - h, 0, w * L)
    l = L - V / w
    assert solve_line(l - 1e-9, h, *CHAIN, 0.4, 1.0)[2] == SLACK
    H, V1, kind = solve_line(l + 1e-3, h, *CHAIN, 0.4, 1.0)
    assert kind == GROUNDED
    assert 0.0 < H < 5e-4 * V  # about w dl / ln(2 V / H)
    assert pytest.approx(V, rel=1e-3) == V1
    H, V1, _ = solve_line(l + 1e-8, h, *CHAIN, 0.4, 1.0)
    assert H < 1e-8 * V
    assert pytest.approx(V, rel=1e-7) == V1


@pytest.mark.parametrize("friction", [0.0, 1.0])
@pytest.mark.parametrize("h", [0.0, 1e-6, 5.0, 186.0, 700.0, 834.0, 840.0])
def test_force_grows_with_distance_and_never_jumps(h, friction):
    l = np.linspace(0.0, 850.0, 8501)
    found = np.array([solve_line(x, h, *CHAIN, friction, 1.0) for x in l])
    assert np.all(found[:, 2] >= SLACK)
    dH = np.diff(found[:, 0])
    assert np.all(dH >= -1e-4)
    L, w, EA = CHAIN
    stiffest = 0.1 * EA / L  # the bare line; friction holds part of a line that lies flat: H = sqrt(2 c w EA stretch)
    if friction > 0.0 and h < 100.0:
        stiffest = np.sqrt(2 * friction * w * EA * 0.1)
    assert np.abs(np.diff(found[:, :2], axis=0)).max() < 1.01 * stiffest


def test_every_geometry_is_solved_and_solved_rightly():
    rng = np.random.default_rng(4)
    n = 20000
    L, w = 10 ** rng.uniform(0, 3.5, n), 10 ** rng.uniform(0, 4, n)
    EA = w * L * 10 ** rng.uniform(0.5, 6, n)
    friction, ground = rng.choice([0.0, 0.3, 1.0], n), rng.choice([0.0, 1.0], n)
    chord = L * rng.uniform(0, 1.1, n) ** rng.choice([0.2, 1.0], n)
    angle = rng.uniform(-1, 1, n) * np.pi / 2
    angle[::50] = np.pi / 2  # upright
    l, h = chord * np.cos(angle), chord * np.sin(np.where(ground > 0, np.abs(angle), angle))
    kinds = set()
    for p in zip(l, h, L, w, EA, friction, ground, strict=True):
        H, V, kind = solve_line(*p)
        kinds.add(kind)
        assert kind != FAILED, p
        if kind != SLACK:
            assert textbook(H, V, *p[2:]) == pytest.approx(p[:2], abs=2e-8 * p[2]), p
    assert kinds == {SLACK, GROUNDED, SUSPENDED}


def test_what_cannot_be_is_nan():
    for l, h, ground in ((100.0, -1.0, 1.0), (np.nan, 10.0, 1.0), (10.0, np.nan, 0.0), (np.inf, 10.0, 1.0), (-1.0, 10.0, 1.0)):
        H, V, kind = solve_line(l, h, *CHAIN, 0.0, ground)
        assert kind == FAILED
        assert np.isnan(H)
        assert np.isnan(V)


@pytest.mark.parametrize("friction", [0.0, 0.8])
@pytest.mark.parametrize(
    ("l", "h", "grounded"), [(600.0, 186.0, True), (796.7, 186.0, True), (830.0, 150.0, True), (500.0, -90.0, False)]
)
def test_drawn_shape_ends_where_it_is_held_and_has_its_length(l, h, grounded, friction):
    L, w, EA = CHAIN
    line = MooringLine([0, 0, -200], [0, 0, 0], length=L, weight=w, stiffness=EA, friction=friction, grounded=grounded)
    H, V, kind = solve_line(l, h, *CHAIN, friction, float(grounded))
    x, z = line_shape(line, H, V, kind, l, 4001)
    assert (x[0], z[0]) == pytest.approx((0.0, 0.0), abs=1e-6)
    assert (x[-1], z[-1]) == pytest.approx((l, h), abs=1e-6)
    assert not grounded or z.min() > -1e-9
    if kind != SLACK:
        assert np.hypot(np.diff(x), np.diff(z)).sum() == pytest.approx(L, rel=1.5e-2)
        assert np.hypot(np.diff(x), np.diff(z)).sum() >= L * (1 - 1e-6)
