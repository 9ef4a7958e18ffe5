"""MoorDyn beside the ship: the coupling by itself against a library of springs, then MoorDyn against the static lines."""

import sys
from types import SimpleNamespace

import numpy as np
import pytest

from ogilvie.errors import ConvergenceError, InputError
from ogilvie.frames import rotation_matrix
from ogilvie.loads.moordyn import MoorDyn
from ogilvie.loads.mooring_line import MooringLine
from ogilvie.loads.mooring_lines import CatenaryMooring

POSE = np.array([5.0, -3.0, 0.4, 0.03, -0.04, 0.1])
REST = np.zeros(6)
LENGTH, MASS, EA, DIAMETER = 835.35, 113.35, 753.6e6, 0.0766
WEIGHT = (MASS - 1025.0 * np.pi / 4 * DIAMETER**2) * 9.81
PLACES = [(c, s) for c, s in zip(np.cos(np.radians([60, 180, 300])), np.sin(np.radians([60, 180, 300])), strict=True)]

FILE = """--------------------- MoorDyn Input File ---------------------
Three chains of a semisubmersible
---------------------- LINE TYPES ----------------------------
TypeName Diam   Mass/m   EA   BA/-zeta EI  Cd  Ca  CdAx CaAx
(name)   (m)    (kg/m)   (N)  (N-s/-)  (N-m^2) (-) (-) (-) (-)
chain    {diameter} {mass} {stiffness} -1.0 0 2.0 0.8 0.4 0.25
---------------------- POINTS --------------------------------
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
{points}
---------------------- LINES ---------------------------------
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
(#) (name) (#) (#) (m) (-) (-)
{lines}
---------------------- OPTIONS -------------------------------
2e-3 dtM
1e5 kbot
1e4 cbot
9.81 g
1025.0 WtrDnsty
200.0 WtrDpth
0.5 dtIC
100.0 TmaxIC
4.0 CdScaleIC
1e-4 threshIC
------------------------- end --------------------------------
"""


@pytest.fixture
def chains(tmp_path):
    """An input file with three chains."""
    points = [f"{i + 1} Fixed {837.6 * c} {837.6 * s} -200.0 0 0 0 0" for i, (c, s) in enumerate(PLACES)]
    points += [f"{i + 4} Coupled {40.868 * c} {40.868 * s} -14.0 0 0 0 0" for i, (c, s) in enumerate(PLACES)]
    lines = [f"{i + 1} chain {i + 1} {i + 4} {LENGTH} 40 -" for i in range(3)]
    path = tmp_path / "chains.txt"
    text = FILE.format(diameter=DIAMETER, mass=MASS, stiffness=EA, points="\n".join(points), lines="\n".join(lines))
    path.write_text(text)
    return path


class Springs:
    """What the coupling uses of moordyn, with a spring to its first place at every coupled point."""

    LEVEL_ERR, POINT_TYPE_COUPLED, STIFFNESS = 1, 2, 1e5

    def __init__(self, *, places=((10.0, 0.0, -2.0), (-10.0, 3.0, -1.0)), dofs=6, broken=False):
        self.places, self.dofs, self.broken, self.closed = np.array(places), dofs, broken, 0
        self.steps, self.dt = [], None

    def Create(self, path):
        return SimpleNamespace(x=self.places.copy())

    def SetVerbosity(self, system, level):
        assert level == self.LEVEL_ERR

    def SetDt(self, system, dt):
        self.dt = dt

    def NCoupledDOF(self, system):
        return self.dofs

    def GetNumberPoints(self, system):
        return len(self.places) + 1

    def GetPoint(self, system, i):
        return system, i

    def GetPointType(self, point):
        return self.POINT_TYPE_COUPLED if point[1] > 1 else 0

    def GetPointPos(self, point):
        return tuple(point[0].x[point[1] - 2])

    def GetPointForce(self, point):
        return tuple(self._force(point[0])[point[1] - 2])

    def _force(self, system):
        return -self.STIFFNESS * (system.x - self.places)

    def Init(self, system, x, v):
        system.x = np.reshape(x, (-1, 3))
        return 0

    def Step(self, system, x, v, t, dt):
        if self.broken:
            raise RuntimeError("MoorDyn_Step() failed")
        system.x = np.reshape(x, (-1, 3)) + np.reshape(v, (-1, 3)) * dt
        self.steps.append((t, dt, system.x))
        return self._force(system).ravel().tolist()

    def Close(self, system):
        self.closed += 1


@pytest.fixture
def springs(monkeypatch, tmp_path):
    """A stand-in for moordyn and an input file that it does not read."""
    library, path = Springs(), tmp_path / "lines.txt"
    path.write_text("none")
    monkeypatch.setitem(sys.modules, "moordyn", library)
    return library, path


def expected(library, pose):
    R = rotation_matrix(*pose[3:])
    F = -library.STIFFNESS * (pose[:3] + library.places @ R.T - library.places) @ R
    return np.concatenate([F.sum(axis=0), np.cross(library.places, F).sum(axis=0)])


def test_force_is_about_the_origin_in_body_axes(springs):
    library, path = springs
    mooring = MoorDyn(path, period=0.1, lead=0.0, dt=0.01)
    assert mooring.start(0.0, POSE, REST) == pytest.approx(expected(library, POSE))
    assert mooring.fairleads == pytest.approx(library.places)
    assert library.dt == 0.01
    assert mooring.call(0.0, POSE, REST) == pytest.approx(expected(library, POSE))
    assert library.steps == []
    assert mooring.call(0.1, 1.1 * POSE, REST) == pytest.approx(expected(library, 1.1 * POSE))
    mooring.close()
    mooring.close()
    assert library.closed == 1
    assert mooring.covers == {"mooring"}


def test_fairleads_follow_the_ship_without_drift(springs):
    library, path = springs
    mooring, period, w = MoorDyn(path, period=0.2), 0.2, 1.5

    def motion(t):
        """Surge, heave and yaw with their velocities in body axes."""
        eta, rate = np.zeros(6), np.zeros(6)
        eta[[0, 2, 5]], rate[[0, 2, 5]] = np.outer([5.0, 0.4, 0.1], [np.sin(w * t), w * np.cos(w * t)]).T
        rate[:3] = rotation_matrix(*eta[3:]).T @ rate[:3]
        return eta, rate

    def places(eta):
        return eta[:3] + library.places @ rotation_matrix(*eta[3:]).T

    mooring.start(1.0, *motion(1.0))
    for i in range(1, 40):
        t = 1.0 + period * i
        mooring.call(t, *motion(t))
        assert library.steps[-1][2] == pytest.approx(places(motion(t)[0]), abs=1e-9)
    times = np.array([s[0] + s[1] for s in library.steps])
    assert np.diff(times) == pytest.approx(np.full(len(times) - 1, 0.02))
    off = [np.abs(x - places(motion(t)[0])).max() for (_, _, x), t in zip(library.steps, times, strict=True)]
    assert max(off) < 5.0 * (w * period) ** 4 / 384 * 1.5  # error of cubic interpolation


def test_extrapolation_takes_the_delay_out(springs):
    """The held force of springs on a moving ship: the work over a cycle is the energy that the delay feeds in."""
    _, path = springs
    w = 2 * np.pi / 10
    work = {}
    for period in (0.2, 0.1):
        for lead in (0.0, 0.5):
            mooring = MoorDyn(path, period=period, lead=lead)
            mooring.start(0.0, REST, REST)
            t = period * np.arange(1, round(20 / period) + 1)
            held = np.array([mooring.call(a, [np.sin(w * a), 0, 0, 0, 0, 0], REST)[0] for a in t])
            last = t > 10.0 - 0.5 * period
            move = np.sin(w * (t + period)) - np.sin(w * t)
            work[period, lead] = (held * move)[last][: round(10 / period)].sum()
    assert work[0.1, 0.0] == pytest.approx(0.5 * work[0.2, 0.0], rel=0.02)  # first order: half the delay, half the energy
    assert work[0.1, 0.0] > 0.0
    assert abs(work[0.2, 0.5]) < 0.01 * work[0.2, 0.0]
    assert abs(work[0.1, 0.5]) < 0.15 * abs(work[0.2, 0.5])


def test_order_of_calls_is_checked(springs):
    _, path = springs
    mooring = MoorDyn(path, period=0.1)
    with pytest.raises(InputError, match="start"):
        mooring.call(0.0, REST, REST)
    mooring.start(5.0, REST, REST)
    with pytest.raises(InputError, match="from 5 s on"):
        mooring.call(4.9, REST, REST)


def test_failures_of_the_library_are_told(springs):
    library, path = springs
    mooring = MoorDyn(path, period=0.1)
    mooring.start(0.0, REST, REST)
    library.broken = True
    with pytest.raises(ConvergenceError, match=r"step to 0.1 s failed"):
        mooring.call(0.1, REST, REST)
    library.broken, library.places = False, np.full((2, 3), np.nan)
    with pytest.raises(ConvergenceError, match="no static shape"):
        MoorDyn(path, period=0.1).start(0.0, REST, REST)


def test_bodies_and_rods_are_refused(springs):
    library, path = springs
    library.dofs = 12
    with pytest.raises(InputError, match="2 of them and 12 coupled"):
        MoorDyn(path, period=0.1).start(0.0, REST, REST)
    assert library.closed == 1


def test_absent_library_names_the_way_to_get_it(springs, monkeypatch):
    monkeypatch.setitem(sys.modules, "moordyn", None)
    with pytest.raises(InputError, match=r"pip install 'ogilvie\[moordyn\]'"):
        MoorDyn(springs[1], period=0.1).start(0.0, REST, REST)


@pytest.mark.parametrize(
    ("change", "text"),
    [({"period": 0.0}, "period"), ({"dt": -1.0}, "dt"), ({"dt": 0.2}, "up to the period"), ({"lead": 2.0}, "lead")],
)
def test_wrong_arguments_are_refused(springs, change, text):
    with pytest.raises(InputError, match=text):
        MoorDyn(springs[1], **{"period": 0.1} | change)


def catenaries():
    chain = dict(length=LENGTH, weight=WEIGHT, stiffness=EA)
    return CatenaryMooring(
        [MooringLine([837.6 * c, 837.6 * s, -200], [40.868 * c, 40.868 * s, -14], **chain) for c, s in PLACES]
    )


def test_moordyn_at_rest_agrees_with_the_static_lines(chains):
    pytest.importorskip("moordyn", reason="moordyn is not installed: pip install 'ogilvie[moordyn]'")
    lines = catenaries()
    for eta in (REST, np.array([8.0, 4.0, 1.0, 0.02, -0.03, 0.05])):
        mooring = MoorDyn(chains, period=0.5)
        found, static = mooring.start(0.0, eta, REST), lines.force(eta)
        mooring.close()
        scale = np.maximum(np.abs(static), [1.9e6] * 3 + [1.9e6 * 40] * 3)
        assert np.abs((found - static) / scale).max() < 4e-3


def test_moordyn_moved_slowly_stays_with_the_static_lines(chains):
    pytest.importorskip("moordyn", reason="moordyn is not installed: pip install 'ogilvie[moordyn]'")
    mooring, lines, period = MoorDyn(chains, period=0.5), catenaries(), 0.5
    mooring.start(0.0, REST, REST)
    for i in range(1, 241):
        t = i * period
        eta = np.array([6.0 * (1 - np.cos(np.pi * t / 120)) / 2, 0, 0, 0, 0, 0])
        force = mooring.call(t, eta, REST)
        if i % 40 == 0:
            assert force[0] == pytest.approx(lines.force(eta)[0], abs=0.02 * 4.5e5)
            assert force[2] == pytest.approx(lines.force(eta)[2], rel=0.01)
    mooring.close()


def test_moordyn_refuses_a_file_that_is_none(chains):
    pytest.importorskip("moordyn", reason="moordyn is not installed: pip install 'ogilvie[moordyn]'")
    chains.write_text("hello\n")
    with pytest.raises(InputError, match="coupled points alone expected"):
        MoorDyn(chains, period=0.5).start(0.0, REST, REST)


def test_a_vessel_moored_by_moordyn_swings_like_one_on_static_lines(chains, capfd):
    """In the time loop: quiet on the terminal, slow motion as with quasi-static lines but for the damping of the lines."""
    pytest.importorskip("moordyn", reason="MoorDyn is an optional extra: pip install ogilvie[moordyn]")
    import ogilvie as og

    body = og.RigidBody(mass=1.347e7, cog=[0, 0, -13.5], inertia=np.diag([6.9e9, 6.9e9, 1.2e10]))
    A_inf = np.diag([8e6, 8e6, 1.4e7, 7e9, 7e9, 5e9])
    radiation = og.StateSpaceRadiation(og.StateSpace(np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0)), A_inf=A_inf))
    damping = og.LinearDamping(np.diag([2e5, 2e5, 1e5, 1e7, 1e7, 1e7]))
    loads = (og.LinearRestoring(np.diag([0, 0, 3.8e6, 1.3e9, 1.3e9, 0])), radiation, damping)
    lines = [
        og.MooringLine((837.6 * c, 837.6 * s, -200), (40.868 * c, 40.868 * s, -14), length=LENGTH, weight=WEIGHT, stiffness=EA)
        for c, s in PLACES
    ]
    options = {"duration": 60.0, "dt": 0.1, "initial": {"eta": [8.0, 0, 0, 0, 0, 0]}, "output_step": 1.0}
    static, dynamic = (
        og.simulate(og.Vessel(body, loads=(*loads, m)), **options)
        for m in (og.CatenaryMooring(lines), MoorDyn(chains, period=0.1))
    )
    assert np.abs(static.eta.values - dynamic.eta.values)[:, 0].max() < 1.0
    assert dynamic.force_mooring.values[0, 0] == pytest.approx(static.force_mooring.values[0, 0], rel=0.05)
    assert capfd.readouterr().out == ""
