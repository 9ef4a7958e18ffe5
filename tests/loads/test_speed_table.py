"""Wave forces between speeds: the rule, polynomials, continuity, a naval vessel's forces at five speeds."""

import warnings

import numpy as np
import pytest

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.frames import to_z_down
from ogilvie.hydro.at_speed import at_speed
from ogilvie.hydro.probe import phase_probe
from ogilvie.hydro.schema import DOFS, hydro_from_arrays
from ogilvie.loads.excitation import WaveExcitation
from ogilvie.loads.speed_table import SpeedTable
from ogilvie.units import deg

OMEGA = np.linspace(0.2, 3.0, 29)
HEADINGS = np.arange(0.0, 181.0, 30.0) * deg
ODD = np.array([0.0, 1.0, 0.0, 1.0, 0.0, 1.0])


def smooth(a, b, c):
    """A symmetric hull's force, smooth in frequency and heading."""
    w, h = OMEGA[:, None, None], HEADINGS[None, :, None]
    i = np.arange(1.0, 7.0)
    even = np.exp(-a * w) * (1.0 + 0.3 * i * np.cos(h)) + 0.4j * np.cos(b * w + c * np.cos(h))
    return even * np.where(ODD, np.sin(h), 1.0)


def still(**changes):
    A = np.diag([1.0, 5, 6, 2, 40, 50]) * (1.0 + 0.2 * np.cos(OMEGA))[:, None, None]
    B = np.diag([0.1, 1, 3, 0.1, 9, 8]) * (OMEGA**3 * np.exp(-2 * OMEGA))[:, None, None]
    arguments = {
        "omega": OMEGA, "added_mass": A, "radiation_damping": B, "wave_direction": HEADINGS,
        "froude_krylov_force": 9 * smooth(1.0, 1.0, 0.5), "diffraction_force": 4 * smooth(0.5, 2.0, 1.0),
    }  # fmt: skip
    return hydro_from_arrays(**{**arguments, **changes})


def moved(speed):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)
        return at_speed(still(), speed)


def at_three(speed, power):
    """Forces that are a polynomial of the speed."""
    X = still().excitation_force.values
    return hydro_from_arrays(
        omega=OMEGA, added_mass=still().added_mass.values, radiation_damping=still().radiation_damping.values,
        wave_direction=HEADINGS, excitation_force=X * (1.0 + 0.3j * speed**power), speed=speed,
    )  # fmt: skip


def test_at_the_tabulated_speeds_it_is_the_excitation_of_that_speed():
    table = SpeedTable([moved(u) for u in (6.0, 0.0, 3.0)])
    w, b = np.array([0.33, 1.0, 2.71]), np.array([-2.0, 0.4, 3.0])
    for u in (0.0, 3.0, 6.0):
        np.testing.assert_allclose(table.force(w, b, u), WaveExcitation(moved(u)).force(w, b), rtol=1e-12, atol=1e-12)
    assert table.speed_range == (0.0, 6.0)
    assert table.omega_range == (0.2, 3.0)


def test_the_rule_is_at_speed_on_the_grid():
    table = SpeedTable(still())
    for u in (0.0, 4.2, 11.0, -3.0):
        wanted = moved(u).excitation_force.values
        w, b = (v.ravel() for v in np.meshgrid(OMEGA, HEADINGS, indexing="ij"))
        np.testing.assert_allclose(table.force(w, b, u).reshape(wanted.shape), wanted, rtol=1e-9, atol=1e-9)


def test_the_rule_between_speeds_is_what_a_fine_table_gives():
    """Cubic interpolation between data sets 1 m/s apart against the rule itself."""
    rule, table = SpeedTable(still()), SpeedTable([moved(u) for u in np.arange(0.0, 8.1, 1.0)])
    w, b = np.array([0.5, 1.0, 1.7, 2.2]), np.array([1.2, 2.4, 0.3, np.pi])
    for u in (0.5, 3.3, 7.4):
        wanted = rule.force(w, b, u)
        np.testing.assert_allclose(table.force(w, b, u), wanted, atol=0.01 * np.abs(wanted).max())


@pytest.mark.parametrize(("power", "interpolation"), [(3, "cubic"), (2, "cubic"), (1, "linear")])
def test_polynomials_of_the_speed_are_met(power, interpolation):
    table = SpeedTable([at_three(u, power) for u in (0.0, 2.0, 5.0, 6.0, 9.0)], interpolation=interpolation)
    X = table.force([0.9, 1.9], [0.7, 2.9], [0.0, 0.0])
    for u in (1.0, 4.4, 8.9):
        np.testing.assert_allclose(table.force([0.9, 1.9], [0.7, 2.9], u), X * (1.0 + 0.3j * u**power), rtol=1e-10)


def test_fewer_speeds_lower_degree():
    two = SpeedTable([at_three(0.0, 1), at_three(4.0, 1)])
    np.testing.assert_allclose(two.force(1.0, np.pi, 1.0), two.force(1.0, np.pi, 0.0) * (1.0 + 0.3j), rtol=1e-12)
    one = SpeedTable([at_three(4.0, 1)])
    np.testing.assert_allclose(one.force(1.0, np.pi, 4.0), two.force(1.0, np.pi, 4.0))
    with pytest.raises(InputError, match=r"speeds within 4..4 m/s expected, 5 m/s found"):
        one.force(1.0, np.pi, 5.0)


@pytest.mark.parametrize("rule", [True, False])
def test_slopes_are_continuous_in_speed_heading_and_frequency(rule):
    """One-sided slopes at the nodes agree: of the table at 3 m/s, 30 deg and 0.5 rad/s; headings wrap at +-180 deg."""
    table = SpeedTable(still()) if rule else SpeedTable([moved(u) for u in (0.0, 1.5, 3.0, 4.5, 6.0)])
    h = 1e-5
    for w, b, u in ((0.5, 30 * deg, 3.0), (1.0, np.pi, 3.0), (2.0, -np.pi, 4.5)):
        X = table.force(w, b, u)
        for step in (np.array([h, 0, 0]), np.array([0, h, 0]), np.array([0, 0, h])):
            before = (X - table.force(w - step[0], b - step[1], u - step[2])) / h
            after = (table.force(w + step[0], b + step[1], u + step[2]) - X) / h
            np.testing.assert_allclose(after, before, rtol=1e-3, atol=1e-3)
    np.testing.assert_allclose(table.force(1.0, np.pi, 2.2), table.force(1.0, -np.pi, 2.2), atol=1e-12)


def test_mirror_symmetry():
    table = SpeedTable(still())
    w, b = np.array([0.4, 1.3]), np.array([0.6, 2.0])
    np.testing.assert_allclose(table.force(w, -b, 5.0), table.force(w, b, 5.0) * np.where(ODD, -1.0, 1.0), rtol=1e-10)


def test_subset_of_dofs_is_embedded():
    part = still().sel(influenced_dof=["heave", "pitch"], radiating_dof=["heave", "pitch"])
    one, other = SpeedTable(part), SpeedTable(still())
    a, b = one.force(1.1, 2.5, 4.0), other.force(1.1, 2.5, 4.0)
    np.testing.assert_allclose(a[:, [2, 4]], b[:, [2, 4]])
    assert not a[:, [0, 1, 3, 5]].any()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: SpeedTable([]), "at least one"),
        (lambda: SpeedTable(["x"]), "data sets"),
        (lambda: SpeedTable(still().drop_vars("excitation_force")), "excitation_force"),
        (lambda: SpeedTable(still().drop_vars(["Froude_Krylov_force", "diffraction_force"])), "several speeds"),
        (lambda: SpeedTable([moved(2.0), moved(2.0)]), "different speeds"),
        (lambda: SpeedTable([still(), still(speed=1.0, rho=1000.0)]), "rho"),
        (lambda: SpeedTable(still(), interpolation="quintic"), "'cubic' or 'linear'"),
        (lambda: SpeedTable(still()).force(3.5, np.pi, 1.0), "frequencies within 0.2..3 rad/s"),
        (lambda: SpeedTable(still()).force(1.0, np.pi, np.nan), "speeds within"),
        (lambda: SpeedTable([moved(0.0), moved(3.0)]).force(1.0, np.pi, -0.1), "speeds within 0..3 m/s expected, -0.1"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()


# ---------------------------------------------------------------------------------------------------- a naval vessel


@pytest.fixture(scope="module")
def naval(shared_data):
    """Forces of a multi-role naval vessel at 0, 10, 12, 15 and 17 knots: z down and clockwise headings turned at the door."""
    from scipy.io import loadmat

    path = shared_data / "mss_navalvessel" / "forceRAO_navalvessel.mat"
    data = loadmat(path, squeeze_me=True, struct_as_record=False)["RAO"]
    X = np.stack([a * np.exp(1j * p) for a, p in zip(data.Amp, data.Phase, strict=True)], axis=-1)  # (n_w, n_b, n_u, 6)
    nothing = np.zeros((len(data.Freq), 6, 6))
    return [
        hydro_from_arrays(
            omega=data.Freq, added_mass=nothing, radiation_damping=nothing, wave_direction=-data.Dir,
            excitation_force=to_z_down(X[:, :, n]), speed=float(u),
        )
        for n, u in enumerate(data.Vel)
    ]  # fmt: skip


def test_naval_vessel_has_our_phases(naval):
    for hydro in naval:
        probe = phase_probe(hydro)
        assert probe.surge_phase == pytest.approx(90.0, abs=2.0)
    assert phase_probe(naval[0]).sway_phase == pytest.approx(90.0, abs=2.0)
    heave = naval[0].excitation_force.sel(influenced_dof="heave").values[0]
    assert np.abs(np.angle(heave)).max() < 0.1  # long waves lift the ship with the elevation
    assert np.angle(heave).mean() > 0.0  # and a little before it: i omega B33, exp(+i omega t)


def test_naval_vessel_between_its_speeds(naval):
    """Any one speed left out is found again from the others; complex interpolation, never of unwrapped phases."""
    w, b = np.array([0.5, 0.7, 0.9, 1.2]), np.array([-150.0, -120.0, -90.0]) * deg
    w, b = (v.ravel() for v in np.meshgrid(w, b))
    for n in (1, 2, 3):
        table = SpeedTable([h for i, h in enumerate(naval) if i != n])
        own = naval[n].attrs["speed"]
        found, wanted = table.force(w, b, own), WaveExcitation(naval[n]).force(w, b)
        error = np.abs(found - wanted).max(axis=0) / np.abs(wanted).max(axis=0)
        assert np.all(error < 0.05), (own, error)
    assert DOFS[2] == "heave"
