"""A mooring of catenary lines: conservation, symmetry, published stiffness, and what it refuses."""

import numpy as np
import pytest

from ogilvie.body import RigidBody
from ogilvie.errors import ConvergenceError, InputError
from ogilvie.frames import rotation_matrix
from ogilvie.loads.base import Load, Surroundings
from ogilvie.loads.mooring_line import MooringLine
from ogilvie.loads.mooring_lines import CatenaryMooring
from ogilvie.post import plot

AROUND = Surroundings(RigidBody(mass=1.0, cog=[0, 0, 0], inertia=np.eye(3)))
POSE = np.array([9.0, -4.0, 1.5, 0.06, -0.08, 0.3])


def spread(count, anchors, fairleads, *, first=0.0, **chain):
    """Lines all round: (radius, depth) of anchors and fairleads."""
    lines = []
    for a in first + 2 * np.pi * np.arange(count) / count:
        c, s = np.cos(a), np.sin(a)
        places = ([r * c, r * s, -d] for r, d in (anchors, fairleads))
        lines.append(MooringLine(*places, **chain))
    return CatenaryMooring(lines)


def semisubmersible(friction=0.0, first=np.pi / 3):
    chain = dict(length=835.35, weight=108.63 * 9.81, stiffness=753.6e6, friction=friction)
    return spread(3, (837.6, 200.0), (40.868, 14.0), first=first, **chain)


def spar(friction=0.0):
    chain = dict(length=902.2, weight=698.094, stiffness=384.243e6, friction=friction)
    return spread(3, (853.87, 320.0), (5.2, 70.0), **chain)


def ragged(friction=0.0):
    """No symmetry, all three kinds of lines, one hanging free."""
    chain = dict(weight=900.0, stiffness=2e8, friction=friction)
    return CatenaryMooring(
        [
            MooringLine([400, 50, -80], [60, 10, -3], length=370.0, **chain),
            MooringLine([-300, 250, -80], [-50, 12, -3], length=360.0, **chain),
            MooringLine([-350, -150, -80], [-55, -8, 2], length=420.0, **chain),
            MooringLine([80, -90, 4], [40, -14, 6], length=92.0, grounded=False, **chain),
        ]
    )


def test_obeys_the_protocol():
    load = semisubmersible()
    assert isinstance(load, Load)
    assert load.covers == {"mooring"}
    assert load.bind(AROUND).kernel.force(eta=POSE) == pytest.approx(load.force(POSE))


def test_force_is_the_lines_pull_at_the_fairleads():
    mooring = ragged()
    R = rotation_matrix(*POSE[3:])
    expected = np.zeros(6)
    for line, shape, T in zip(mooring.lines, mooring.shapes(POSE, points=200001), mooring.tensions(POSE), strict=True):
        along = shape[-2] - shape[-1]  # the line's last piece
        F = R.T @ (T[0] * along / np.linalg.norm(along))
        expected += np.concatenate([F, np.cross(line.fairlead, F)])
        assert shape[-1] == pytest.approx(POSE[:3] + R @ line.fairlead, abs=1e-6)
        assert shape[0] == pytest.approx(line.anchor, abs=1e-6)
    assert mooring.force(POSE) == pytest.approx(expected, rel=1e-4, abs=1e-5 * np.abs(expected).max())
    assert set(mooring.kinds(POSE)) == {"slack", "grounded", "suspended"}


@pytest.mark.parametrize(
    "mooring", [semisubmersible(), spar(), spread(5, (500, 100), (30, 5), length=490, weight=2e3, stiffness=1e9)]
)
def test_a_spread_all_round_pulls_straight_down_at_rest(mooring):
    force = mooring.force()
    assert np.abs(np.delete(force, 2)).max() < 1e-8 * -force[2]
    T = mooring.tensions()  # without friction the anchor of a grounded line feels the horizontal pull
    assert -force[2] == pytest.approx(np.sqrt(T[:, 0] ** 2 - T[:, 1] ** 2).sum(), rel=1e-9)


def test_turning_ship_and_anchors_together_changes_nothing():
    mooring, turn = semisubmersible(), 2.1
    R = rotation_matrix(0, 0, turn)
    moved = np.concatenate([R @ POSE[:3], POSE[3:5], [POSE[5] + turn]])
    turned = CatenaryMooring([MooringLine(R @ p.anchor, p.fairlead, **_stuff(p)) for p in mooring.lines])
    assert turned.force(moved) == pytest.approx(mooring.force(POSE), rel=1e-9, abs=1e-3)


def _stuff(p):
    return dict(length=p.length, weight=p.weight, stiffness=p.stiffness, friction=p.friction, grounded=p.grounded)


@pytest.mark.parametrize("eta", [np.zeros(6), POSE])
@pytest.mark.parametrize("mooring", [semisubmersible(), ragged()])
def test_stiffness_is_symmetric_without_friction(mooring, eta):
    K = mooring.stiffness(eta)
    scale = np.sqrt(np.outer(np.diag(np.abs(K)), np.diag(np.abs(K))))
    assert np.abs((K - K.T) / scale).max() < 2e-6
    assert np.linalg.eigvalsh(K[:2, :2])[0] > 0.0


def test_a_closed_path_costs_no_work_without_friction():
    mooring, n = ragged(), 400
    s = 2 * np.pi * np.arange(n) / n
    amplitude = np.array([6.0, 4.0, 1.5, 0.1, 0.12, 0.2])
    phase = np.array([0.0, 1.0, 2.5, 0.4, 2.0, 4.0])
    path, rate = amplitude * np.sin(s[:, None] + phase), amplitude * np.cos(s[:, None] + phase)
    power = []
    for eta, d in zip(path, rate, strict=True):
        Q = mooring.generalised_force(eta)
        Q[:3] = rotation_matrix(0, 0, eta[5]) @ Q[:3]
        power.append(Q @ d)
    assert abs(np.mean(power)) < 2e-5 * np.abs(power).max()


def test_generalised_force_is_the_power_in_body_axes():
    from ogilvie.frames import euler_rate_matrix

    mooring, nu = ragged(), np.array([0.3, -0.2, 0.1, 0.02, 0.01, -0.03])
    rate = np.concatenate([rotation_matrix(*POSE[3:]) @ nu[:3], euler_rate_matrix(POSE[3], POSE[4]) @ nu[3:]])
    Q = mooring.generalised_force(POSE)
    Q[:3] = rotation_matrix(0, 0, POSE[5]) @ Q[:3]
    assert Q @ rate == pytest.approx(mooring.force(POSE) @ nu, rel=1e-12)


def test_published_stiffness_of_the_spar_of_oc3():
    """J. Jonkman, Definition of the Floating System for Phase IV of OC3, NREL/TP-500-47535, 2010: linearised mooring."""
    K, F = spar().stiffness(), spar().force()
    assert F[2] == pytest.approx(-1.607e6, rel=1e-3)
    found = [K[0, 0], K[1, 1], K[2, 2], K[3, 3], K[4, 4], K[5, 5], K[0, 4], K[1, 3]]
    assert found == pytest.approx([41180, 41180, 11940, 311.1e6, 311.1e6, 11.56e6, -2.816e6, 2.816e6], rel=2e-3)


def test_published_stiffness_of_the_semisubmersible_of_oc4():
    """A. Robertson et al., Definition of the Semisubmersible Floating System for Phase II of OC4, NREL/TP-5000-60601, 2014.

    Its vertical force, 1.839 MN, is 3 % below what its lines give here and in MoorDyn (tests/loads/test_mooring_moordyn.py).
    """
    K, F = semisubmersible().stiffness(), semisubmersible().force()
    found = [K[0, 0], K[1, 1], K[2, 2], K[3, 3], K[4, 4], K[5, 5]]
    assert found == pytest.approx([7.08e4, 7.08e4, 1.91e4, 8.73e7, 8.73e7, 1.17e8], rel=3e-3)
    assert K[4, 0] == pytest.approx(-1.07e5, rel=5e-3)
    assert F[2] == pytest.approx(-1.839e6, rel=0.035)


def test_linearised_mooring_is_the_tangent():
    mooring = semisubmersible()
    linear = mooring.linearised(POSE)
    direction = np.array([1.0, -0.7, 0.4, 0.004, -0.006, 0.005])
    turn = rotation_matrix(0, 0, POSE[5])
    errors = []
    for e in (1.0, 0.5):
        d = e * direction
        moved = POSE + np.concatenate([turn @ d[:3], d[3:]])
        Q = mooring._generalised(moved, POSE[5])
        errors.append(np.abs(Q - linear.pretension + linear.stiffness @ d) / np.abs(linear.stiffness @ d))
    assert np.all(errors[1][[0, 1, 2]] < 0.6 * errors[0][[0, 1, 2]])  # relative error of first order
    assert errors[1].max() < 0.1


def test_linear_model_follows_the_heading():
    still, psi = semisubmersible(), 0.7
    R = rotation_matrix(0, 0, psi)
    turned = CatenaryMooring([MooringLine(R @ p.anchor, p.fairlead, **_stuff(p)) for p in still.lines])
    a, b = still.linearised(), turned.linearised([0, 0, 0, 0, 0, psi])
    assert b.stiffness == pytest.approx(a.stiffness, rel=1e-6, abs=1.0)
    assert b.pretension == pytest.approx(a.pretension, rel=1e-9, abs=1e-3)


def test_equilibrium_under_a_mean_load():
    mooring = semisubmersible()
    C = np.diag([0, 0, 3.8e6, 1e9, 1e9, 0])
    still = mooring.force()
    load = np.array([8e5, 2e5, -still[2], 0, 3e7, 5e6])
    eta = mooring.equilibrium(C, load=load)
    assert mooring._generalised(eta, 0.0) + load - C @ eta == pytest.approx(np.zeros(6), abs=5.0)
    assert 5.0 < eta[0] < 15.0
    assert mooring.equilibrium(C, load=[0, 0, -still[2], 0, 0, 0]) == pytest.approx(np.zeros(6), abs=1e-9)
    with pytest.raises(InputError, match="heave, roll and pitch alone"):
        mooring.equilibrium(np.eye(6))


def test_friction_lowers_the_anchors_tension_and_hardly_the_fairleads():
    smooth, rough = semisubmersible().tensions(), semisubmersible(friction=1.0).tensions()
    assert rough[:, 0] == pytest.approx(smooth[:, 0], rel=3e-3)
    lying = 835.35 - np.sqrt(smooth[0, 0] ** 2 - smooth[0, 1] ** 2) / (108.63 * 9.81)
    assert rough[0, 1] == pytest.approx(smooth[0, 1] - 108.63 * 9.81 * lying, rel=5e-3)


def test_a_fairlead_below_the_bottom_stops_the_run():
    mooring, deep = semisubmersible(), [0, 0, -190.0, 0, 0, 0]
    assert np.isnan(mooring.kernel.force(eta=deep)[:3]).all()
    for ask in (mooring.force, mooring.tensions, mooring.shapes, mooring.stiffness, mooring.kinds):
        with pytest.raises(ConvergenceError, match=r"line 0 .* no solution"):
            ask(deep)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"length": -1.0}, "length: a positive number of m"),
        ({"weight": 0.0}, "weight: a positive number of N/m"),
        ({"stiffness": np.nan}, "stiffness: a positive number of N"),
        ({"stiffness": "much"}, "stiffness: a positive number"),
        ({"stiffness": 7.5e4}, "EA is in N"),
        ({"friction": -0.1}, "friction: a number >= 0"),
        ({"anchor": [1.0, 2.0]}, "anchor: three finite"),
        ({"fairlead": [1.0, np.inf, 0.0]}, "fairlead: three finite"),
        ({"fairlead": "bow"}, "fairlead: three coordinates"),
    ],
)
def test_wrong_lines_are_refused(change, text):
    good = dict(anchor=[800, 0, -200], fairlead=[40, 0, -14], length=835.0, weight=1e3, stiffness=7e8)
    with pytest.raises(InputError, match=text):
        MooringLine(**good | change)


def test_wrong_moorings_are_refused():
    for wrong in ([], [3.0]):
        with pytest.raises(InputError, match="one or more MooringLine"):
            CatenaryMooring(wrong)
    with pytest.raises(InputError, match="pose eta"):
        semisubmersible().force([0, 0, 0])


def test_figure_shows_every_line():
    fig = plot.mooring(ragged(), eta=POSE)
    plan, side, bars = fig.axes
    assert [len(ax.get_lines()) for ax in (plan, side)] == [4 + 3 * 4, 4 + 2 * 4 + 2]
    assert len(bars.patches) == 8
    assert "[m]" in plan.get_xlabel()
    assert "kN" in bars.get_ylabel()


@pytest.mark.parametrize("mooring", [semisubmersible(friction=0.3), spar(), ragged()])
def test_tensions_of_many_poses_are_those_of_each(mooring):
    rng = np.random.default_rng(3)
    poses = np.array([3.0, 3.0, 0.5, 0.05, 0.05, 0.2]) * rng.uniform(-1, 1, (2, 4, 6))
    T = mooring.tensions(poses)
    assert T.shape == (2, 4, len(mooring.lines), 2)
    for k in np.ndindex(2, 4):
        np.testing.assert_allclose(T[k], mooring.tensions(poses[k]), rtol=1e-12)
    with pytest.raises(InputError, match="6"):
        mooring.tensions(np.zeros((4, 5)))
