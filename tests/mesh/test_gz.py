"""Righting levers: wall-sided formula, energy, symmetry, decks, and what is refused."""

from types import SimpleNamespace

import numpy as np
import pytest

import ogilvie as og
from ogilvie.mesh.buoyancy import corners, energy_gradient, immersed_integrals, potential_energy
from ogilvie.mesh.deck import decked
from ogilvie.mesh.gz import gz_curve
from ogilvie.units import deg

RHO = 1025.0
L, B, T, DEPTH = 60.0, 10.0, 3.0, 8.0


def barge(depth=DEPTH):
    return og.shapes.box(L, B, depth, panels=300).translated((0, 0, depth - T))


def weight(zg, mass=RHO * L * B * T, xg=0.0, yg=0.0):
    return SimpleNamespace(mass=mass, cog=np.array([xg, yg, zg]))


def ship(**more):
    particulars = dict(length=175.0, beam=25.4, draught=9.5, cb=0.572, cm=0.97, cwp=0.711, lcb=-0.0142, depth=15.0)
    return og.shapes.from_particulars(**particulars, panels=800, above_water=True, **more)


SHIP = ship()
SHIP_BODY = og.RigidBody.from_hull(SHIP.immersed(), kg=9.55, gyradii=(8.3, 42.0, 42.0))


def test_integrals_of_any_pose_are_those_of_the_cut_hull():
    closed = decked(SHIP)
    p = corners(closed)
    for z, phi, theta in [(0.3, 0.2, 0.02), (-2.0, -0.9, -0.05), (1.0, 2.5, 0.01), (0.0, 0.0, 0.0)]:
        wet = closed.rotated(phi, theta).translated((0, 0, z)).immersed()
        expected = np.r_[wet.volume, wet.volume * wet.center_of_buoyancy]
        assert immersed_integrals(p, z, phi, theta) == pytest.approx(expected, rel=1e-9, abs=1e-6)


def test_gradient_is_that_of_the_energy():
    p, q, cog = corners(decked(SHIP)), np.array([0.5, 0.4, 0.03]), np.array([-2.0, 0.3, 0.5])

    def energy(q):
        return potential_energy(p, 24000.0, cog, *q)

    g = energy_gradient(p, 24000.0, cog, *q)
    errors = []
    for h in (1e-2, 5e-3):
        fd = [(energy(q + e) - energy(q - e)) / (2 * h) for e in h * np.eye(3)]
        errors.append(np.abs(np.array(fd) / g - 1).max())
    assert errors[1] < errors[0] / 3.0
    assert errors[1] < 1e-3


def test_wall_sided_formula_until_the_deck_gets_wet_or_the_bilge_dry():
    phi = np.arange(-20.0, 60.1, 2.5) * deg
    curve = gz_curve(barge(), weight(0.5), phi)
    BM, GM = B**2 / 12 / T, T / 2 + B**2 / 12 / T - (T + 0.5)
    limit = np.arctan(2 * T / B)  # bilge dry; the deck, 5 m above the water, gets wet at 45 deg
    inside = np.abs(phi) < limit
    expected = np.sin(phi) * (GM + 0.5 * BM * np.tan(phi) ** 2)
    assert curve.gz[inside] == pytest.approx(expected[inside], abs=1e-9)
    assert np.all(np.abs(curve.gz - expected)[~inside] > 1e-4)
    assert curve.gm == pytest.approx(GM, rel=1e-5)
    assert curve.trim == pytest.approx(0.0, abs=1e-12)
    assert curve.sinkage[inside] == pytest.approx(0.0, abs=1e-9)  # equal wedges meet on the centreline


def test_deck_angle_of_a_barge_of_little_freeboard():
    curve = gz_curve(barge(depth=4.0), weight(-0.5), np.arange(0.0, 30.1, 1.0) * deg)
    assert curve.deck_angle == pytest.approx(np.arctan(1.0 / 5.0), abs=2e-4)
    assert np.isnan(gz_curve(barge(), weight(0.5), np.arange(0.0, 40.1, 10.0) * deg).deck_angle)


def test_a_closed_cylinder_on_its_side_has_a_sine():
    """Circular sections turn in themselves: GZ = (axis - G) sin(phi) at all angles."""
    n = 48
    a = 2 * np.pi * np.arange(n) / n
    ring = np.stack([3.0 * np.cos(a), 3.0 * np.sin(a)], axis=1)
    v = np.concatenate([[[x, y, z] for y, z in ring] for x in (-10.0, 10.0)] + [[[-10.0, 0, 0], [10.0, 0, 0]]])
    k, m = np.arange(n), (np.arange(n) + 1) % n
    side = np.stack([k, m, m + n, k + n], axis=1)
    caps = [
        np.stack([m, k, 0 * k + 2 * n, 0 * k + 2 * n], axis=1),
        np.stack([k + n, m + n, 0 * k + 2 * n + 1, 0 * k + 2 * n + 1], axis=1),
    ]
    faces = np.concatenate([side, *caps])
    mesh = og.PanelMesh(v, faces)
    mesh = mesh if mesh.volume > 0 else mesh.flipped()
    body = weight(-0.8, mass=RHO * mesh.volume / 2)
    curve = gz_curve(mesh, body, np.arange(0.0, 171.0, 7.5) * deg)  # steps of the polygon: exact there
    assert curve.gz == pytest.approx(0.8 * np.sin(curve.angles), abs=2e-6)
    assert np.isnan(curve.vanishing_angle)


def test_area_under_the_curve_is_the_work():
    phi = np.arange(0.0, 60.1, 1.0) * deg
    curve = gz_curve(SHIP, SHIP_BODY, phi)
    p, m = corners(decked(SHIP)), SHIP_BODY.mass / RHO
    E = [potential_energy(p, m, SHIP_BODY.cog, curve.sinkage[i], phi[i], curve.trim[i]) for i in (0, 30, 60)]
    assert curve.area(phi[30]) == pytest.approx((E[1] - E[0]) / m, rel=2e-5)
    assert curve.area(phi[60]) == pytest.approx((E[2] - E[0]) / m, rel=2e-5)


def test_ship_agrees_with_hydrostatics_and_equilibrium():
    curve = gz_curve(SHIP, SHIP_BODY)
    assert curve.gm == pytest.approx(og.hydrostatics(SHIP.immersed(), body=SHIP_BODY).GM_T, rel=2e-3)
    assert curve.sinkage[0] == pytest.approx(0.0, abs=1e-6)
    heeled = og.RigidBody(SHIP_BODY.mass, SHIP_BODY.cog + [0.0, 0.25, 0.0], SHIP_BODY.inertia)
    rest = og.equilibrium(SHIP, heeled)
    at = gz_curve(SHIP, heeled, rest.heel + np.array([-0.02, -0.01, 0.0, 0.01]))
    assert at.gz[2] == pytest.approx(0.0, abs=1e-9)
    assert at.sinkage[2] == pytest.approx(rest.sinkage, abs=1e-7)
    assert at.trim[2] == pytest.approx(rest.trim, abs=1e-9)


def test_mirror_image_and_held_trim():
    phi = np.arange(-40.0, 41.0, 10.0) * deg
    curve = gz_curve(SHIP, SHIP_BODY, phi)
    assert curve.gz == pytest.approx(-curve.gz[::-1], abs=1e-9)
    assert curve.trim == pytest.approx(curve.trim[::-1], abs=1e-9)
    held = gz_curve(SHIP, SHIP_BODY, phi, free_trim=False)
    assert not held.trim.any()
    assert np.abs(curve.trim).max() > 1e-3
    assert np.all(np.abs(held.gz[phi != 0]) > np.abs(curve.gz[phi != 0]))  # held: more energy at each heel


def test_result_tells_its_figures():
    curve = gz_curve(barge(depth=5.0), weight(0.5), np.arange(0.0, 90.1, 2.5) * deg)
    assert 0.0 < curve.max_angle < curve.vanishing_angle < 90 * deg
    assert curve.spline(curve.vanishing_angle) == pytest.approx(0.0, abs=1e-9)
    assert curve.max_gz >= curve.gz.max()
    assert np.isnan(curve.spline(100 * deg))
    assert "GM 0.77778 m" in str(curve)
    other = gz_curve(barge(), weight(0.5), np.arange(-40.0, -9.0, 10.0) * deg)
    assert np.isnan([other.max_angle, other.max_gz, other.vanishing_angle, other.area(0.1)]).all()
    assert "nan" in str(other)


def test_decks_close_hulls_of_many_patches_and_bodies_of_many_parts():
    for hull in (
        SHIP,
        og.shapes.s175(panels=600, above_water=True),
        og.shapes.cylinder(5.0, 9.0, panels=200).translated((0, 0, 4.0)),
    ):
        closed = decked(hull)
        assert np.abs(closed.area_vectors.sum(axis=0)).max() < 1e-9 * closed.areas.sum()
        assert closed.volumes == pytest.approx(closed.volume)
        assert closed.volume > hull.immersed().volume
    once = decked(SHIP)
    assert decked(once).n_faces == once.n_faces


def test_refusals():
    hull = barge().full()
    holed = og.PanelMesh(hull.vertices, hull.faces[hull.centers[:, 2] > -T + 1e-6])  # no bottom
    with pytest.raises(og.InputError, match=r"open edge at z = -3 m"):
        gz_curve(holed, weight(0.0))
    with pytest.raises(og.InputError, match="freeboard"):
        gz_curve(og.shapes.box(L, B, T, panels=100), weight(0.0))
    with pytest.raises(og.InputError, match="ascending"):
        gz_curve(barge(), weight(0.0), [0.2, 0.1, 0.3, 0.4])
    with pytest.raises(og.InputError, match="radians"):
        gz_curve(barge(), weight(0.0), [0.0, 10.0, 20.0, 30.0])
    with pytest.raises(og.ConvergenceError, match="sinks"):
        gz_curve(barge(), weight(0.0, mass=RHO * L * B * 9.0))
    with pytest.raises(og.InputError, match="flipped"):
        gz_curve(barge().flipped(), weight(0.0))
