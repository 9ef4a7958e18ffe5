"""Response amplitude operators: the equation, overtaken waves, long waves, WAMIT's own motions, responses to seas."""

import warnings

import numpy as np
import pytest
import xarray as xr

from ogilvie.body import RigidBody
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.at_speed import at_speed
from ogilvie.hydro.rao import rao
from ogilvie.hydro.response import response_spectrum, response_statistics
from ogilvie.hydro.schema import DOFS, hydro_from_arrays
from ogilvie.units import GRAVITY, deg
from ogilvie.waves.dispersion import encounter_frequency
from ogilvie.waves.sea import irregular
from ogilvie.waves.spectra import jonswap, spreading

OMEGA = np.linspace(0.2, 2.5, 40)
rng = np.random.default_rng(5)


def vessel(speed=0.0, directions=(0.0, np.pi / 2, np.pi), **changes):
    """A made-up vessel with full coupling."""
    n = 6
    L = rng.normal(size=(n, n)) * 0.2
    A0 = np.eye(n) + L @ L.T
    A = A0 * (1.0 + 0.3 * np.cos(OMEGA))[:, None, None]
    B = np.eye(n) * (0.5 * OMEGA**2 * np.exp(-OMEGA))[:, None, None]
    F = rng.normal(size=(len(OMEGA), len(directions), n)) + 1j * rng.normal(size=(len(OMEGA), len(directions), n))
    arguments = {
        "omega": OMEGA,
        "added_mass": A,
        "radiation_damping": B,
        "added_mass_zero": 1.3 * A0,
        "wave_direction": directions,
        "excitation_force": F,
        "hydrostatic_stiffness": np.diag([0.02, 0.02, 2.0, 2.0, 3.0, 0.02]),
        "inertia_matrix": 2.0 * np.eye(n),
        "speed": speed,
    }
    return hydro_from_arrays(**{**arguments, **changes})


# ---------------------------------------------------------------------------------------------------- equation


def test_equation_is_satisfied():
    hydro = vessel()
    B_ext, C_ext = 0.1 * np.eye(6), np.diag([0.5, 0.5, 0, 0, 0, 0.5])
    X = rao(hydro, damping=B_ext, stiffness=C_ext)
    assert X.dims == ("omega", "wave_direction", "dof")
    for i in (0, 7, 39):
        w = OMEGA[i]
        Z = (
            -(w**2) * (hydro.inertia_matrix + hydro.added_mass[i]).values
            + 1j * w * (hydro.radiation_damping[i].values + B_ext)
            + hydro.hydrostatic_stiffness.values
            + C_ext
        )
        np.testing.assert_allclose(Z @ X.values[i].T, hydro.excitation_force.values[i].T, rtol=1e-10, atol=1e-12)


def test_a_body_or_its_matrix():
    body = RigidBody(mass=3.0, cog=[0.1, 0.0, 0.0], inertia=np.diag([3.0, 4.0, 5.0]))
    hydro = vessel()
    np.testing.assert_array_equal(rao(hydro, body).values, rao(hydro, mass=body.matrix).values)
    own = rao(hydro).values
    np.testing.assert_array_equal(rao(hydro, mass=hydro.inertia_matrix).values, own)


def test_subset_of_dofs():
    hydro = vessel().sel(influenced_dof=["heave", "pitch"], radiating_dof=["heave", "pitch"])
    body = RigidBody(mass=2.0, cog=[0, 0, 0], inertia=np.diag([2.0, 2.0, 2.0]))
    assert rao(hydro, body).sizes["dof"] == 2
    np.testing.assert_allclose(rao(hydro, body).values, rao(hydro).values)


# ---------------------------------------------------------------------------------------------------- forward speed


def test_speed_uses_the_signed_encounter_frequency():
    U, b = 9.0, np.array([0.0, 70 * deg, np.pi])
    still = vessel(directions=b, added_mass=np.ones((40, 6, 6)) + 3 * np.eye(6))
    hydro = at_speed(still.drop_vars("excitation_force"), U).assign(excitation_force=still.excitation_force)
    with pytest.warns(OgilvieWarning, match="exceeds the radiation data"):
        X = rao(hydro)
    omega_e = encounter_frequency(OMEGA[:, None], speed=U, direction=b)
    np.testing.assert_allclose(X.encounter_frequency.values, omega_e)
    assert (omega_e < 0).any()
    assert (omega_e > OMEGA[-1]).any()
    np.testing.assert_array_equal(np.isnan(X.values).any(axis=-1), np.abs(omega_e) > OMEGA[-1])
    # overtaken waves: the equation with e^{-i|w_e|t}, that is the conjugate problem at |omega_e|
    i, j = np.argwhere(omega_e < -0.3)[0]
    w = -omega_e[i, j]
    there = hydro_from_arrays(
        omega=[w], added_mass=_between(still.added_mass, w), radiation_damping=_between(still.radiation_damping, w)
    )
    there = at_speed(there, U)
    A, B = there.added_mass.values[0], there.radiation_damping.values[0]
    Z = -(w**2) * (hydro.inertia_matrix.values + A) + 1j * w * B + hydro.hydrostatic_stiffness.values
    conjugate = np.linalg.solve(Z, np.conj(hydro.excitation_force.values[i, j]))
    np.testing.assert_allclose(X.values[i, j], np.conj(conjugate), rtol=5e-3)


def _between(M, w):
    return np.array([[[np.interp(w, OMEGA, M.values[:, p, q]) for q in range(6)] for p in range(6)]])


def test_speed_given_beside_the_data_warns():
    hydro = vessel(directions=(np.pi / 2,))
    with pytest.warns(OgilvieWarning, match="only the encounter frequency follows"):
        beam = rao(hydro, speed=8.0)
    np.testing.assert_allclose(beam.values, rao(hydro).values, rtol=1e-9)  # no Doppler shift in beam seas


# ---------------------------------------------------------------------------------------------------- real vessels


@pytest.mark.parametrize(
    ("name", "percent"),
    # WAMIT made its motions with the Haskind forces (IOPTN(4) = 1 in the .frc), the .3 file holds the diffraction forces: they
    # differ near the irregular frequencies of the FPSO
    [
        ("tanker", (0.9, 0.3, 0.2, 0.45, 0.45, 0.5)),
        ("fpso", (1.3, 1.7, 1.7, 0.2, 1.8, 4.0)),
        ("semisub", (0.2, 0.3, 0.2, 0.5, 0.8, 1.1)),
    ],
)
def test_motions_of_wamit(shared_data, name, percent):
    from ogilvie.hydro.wamit import read_wamit

    hydro = read_wamit(shared_data / f"mss_wamit_{name}" / name)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)
        X = rao(hydro, damping=hydro.get("external_damping"))
    reference = hydro.motion_rao.values
    error = 100 * np.abs(X.values - reference).max(axis=(0, 1)) / np.abs(reference).max(axis=(0, 1))
    assert np.all(error < percent), error
    rms = 100 * np.sqrt(np.mean(np.abs(X.values - reference) ** 2, axis=(0, 1))) / np.abs(reference).max(axis=(0, 1))
    assert np.all(rms < 0.35), rms


def test_long_waves_carry_the_vessel(shared_data):
    """Heave follows the elevation, pitch and roll the slope, surge the horizontal orbit; phases included."""
    from ogilvie.hydro.wamit import read_wamit

    hydro = read_wamit(shared_data / "mss_wamit_tanker" / "tanker")
    X = rao(hydro, damping=hydro.external_damping)
    w, b = float(X.omega[0]), X.wave_direction.values
    k = w**2 / GRAVITY
    motion = dict(zip(DOFS, X.values[0].T, strict=True))
    np.testing.assert_allclose(motion["heave"], 1.0, atol=2e-3)
    np.testing.assert_allclose(motion["pitch"], 1j * k * np.cos(b), atol=0.03 * k)  # bow down where the sea falls ahead
    np.testing.assert_allclose(motion["roll"], -1j * k * np.sin(b), atol=0.03 * k)
    np.testing.assert_allclose(motion["sway"], -1j * np.sin(b), atol=2e-3)  # the orbit: displacement u/(i omega)


# ---------------------------------------------------------------------------------------------------- warnings and errors


def test_light_damping_is_named():
    C = np.diag([0.02, 0.02, 2.0, 0.02, 0.02, 0.02])
    hydro = vessel(radiation_damping=1e-4 * np.ones((40, 6, 6)) * np.eye(6), hydrostatic_stiffness=C)
    with pytest.warns(OgilvieWarning, match="resonance in heave"):
        rao(hydro)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rao(hydro, damping=0.2 * np.eye(6))


def test_singular_impedance_is_named():
    zero = np.zeros((40, 1, 1))
    hydro = hydro_from_arrays(
        omega=OMEGA,
        added_mass=zero,
        radiation_damping=zero,
        wave_direction=[0.0],
        excitation_force=np.ones((40, 1, 1)),
        hydrostatic_stiffness=[[0.0]],
        inertia_matrix=[[0.0]],
        dofs=("surge",),
    )
    with pytest.warns(OgilvieWarning, match="nothing holds the body at 40 points"):
        X = rao(hydro)
    assert np.isnan(X.values).all()


def test_body_with_another_centre_of_gravity_is_named():
    body = RigidBody(mass=2.0, cog=[0.0, 0.0, 0.3], inertia=np.diag([2.0, 2.0, 2.0]))
    with pytest.warns(OgilvieWarning, match=r"change C44 of the data set by -5\.884"):
        rao(vessel(), body)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: rao(vessel().drop_vars("excitation_force")), "excitation_force expected"),
        (lambda: rao(vessel().drop_vars("inertia_matrix")), "inertia_matrix in the data set expected"),
        (lambda: rao(vessel().drop_vars("hydrostatic_stiffness")), "hydrostatic_stiffness expected"),
        (lambda: rao(vessel(), mass=np.eye(5)), r"mass: a finite \(6, 6\)"),
        (lambda: rao(vessel(), damping=np.full((6, 6), np.nan)), "damping"),
        (lambda: rao(vessel(), stiffness=3.0), "stiffness"),
        (lambda: rao(vessel(), np.eye(6)), "give a matrix as mass="),
        (lambda: rao(vessel(), speed=np.nan), "speed"),
    ],
)
def test_bad_input_is_named(call, words):
    with pytest.raises(InputError, match=words):
        call()


# ---------------------------------------------------------------------------------------------------- responses to seas

SEA = jonswap(hs=3.0, tp=9.0)


def operator(values, omega, directions, **attrs):
    return xr.DataArray(
        np.asarray(values, dtype=complex),
        dims=("omega", "wave_direction", "dof"),
        coords={"omega": omega, "wave_direction": directions, "dof": ["heave"]},
        attrs=attrs,
    )


def test_unit_response_is_the_sea():
    w = np.linspace(0.1, 6.0, 30)
    H = operator(np.ones((30, 1, 1)), w, [np.pi])
    result = response_statistics(H, SEA, direction=np.pi)
    inside = SEA.moment(0, omega_range=(0.1, 6.0))
    assert float(result.m0[0]) == pytest.approx(inside, rel=1e-12)
    assert float(result.m2[0]) == pytest.approx(SEA.moment(2, omega_range=(0.1, 6.0)), rel=1e-12)
    assert float(result.m4[0]) == pytest.approx(SEA.moment(4, omega_range=(0.1, 6.0)), rel=1e-12)
    assert float(result.significant[0]) == pytest.approx(4 * np.sqrt(inside))


def test_moments_use_the_encounter_frequency():
    w, U = np.linspace(0.1, 4.0, 30), 8.0
    H = operator(np.ones((30, 1, 1)), w, [np.pi], speed=U)
    result = response_statistics(H, SEA, direction=np.pi)
    x = np.linspace(0.1, 4.0, 200001)
    omega_e = x + x**2 / GRAVITY * U
    assert float(result.m2[0]) == pytest.approx(np.trapezoid(omega_e**2 * SEA(x), x), rel=1e-7)


@pytest.mark.parametrize("s", [2.0, 12.0])
def test_short_crested_average(s):
    """|H|^2 = cos^2 b: the mean over cos^2s is (1 + r2 cos 2 b0)/2, r2 = s(s - 1)/((s + 1)(s + 2))."""
    b = np.arange(0, 360, 5) * deg
    w = np.array([0.1, 3.0, 6.0])
    H = operator(np.broadcast_to(np.cos(b)[None, :, None], (3, len(b), 1)), w, b)
    main = 40 * deg
    S = response_spectrum(H, SEA, direction=main, spreading=spreading(s=s), omega=[0.8])
    r2 = s * (s - 1) / ((s + 1) * (s + 2))
    assert float(S[0, 0]) == pytest.approx(float(SEA(0.8)) * 0.5 * (1 + r2 * np.cos(2 * main)), rel=5e-3)


def test_one_side_serves_both_where_the_hull_is_symmetric():
    b = np.arange(0, 181, 15) * deg
    values = np.broadcast_to((2 + np.cos(b))[None, :, None], (2, len(b), 1))
    H = operator(values, [0.1, 6.0], b, port_starboard_symmetric=1)
    left, right = (float(response_statistics(H, SEA, direction=side * 40 * deg).m0[0]) for side in (1, -1))
    assert left == pytest.approx(right, rel=1e-13)
    response_statistics(H, SEA, direction=np.pi, spreading=spreading(s=10))
    with pytest.raises(InputError, match=r"-40 deg found"):
        response_statistics(H.assign_attrs(port_starboard_symmetric=0), SEA, direction=-40 * deg)


def test_frequency_domain_equals_the_component_sum():
    hydro = vessel(directions=(np.pi,))
    H = rao(hydro, damping=0.3 * np.eye(6))
    sea = irregular(SEA, direction=np.pi, n=3000, omega_range=(0.2, 2.5))
    at = np.stack([np.interp(sea.omega, OMEGA, np.abs(H.values[:, 0, i]) ** 2) for i in range(6)])
    component_sum = at @ sea.amplitude**2 / 2
    with pytest.raises(InputError, match="wave energy"):
        response_statistics(H, jonswap(hs=1.0, tp=3.0), direction=np.pi)
    np.testing.assert_allclose(response_statistics(H, SEA, direction=np.pi).m0, component_sum, rtol=0.02)


def test_unknown_motions_matter_only_where_the_sea_has_energy():
    w = np.linspace(0.1, 6.0, 60)
    values = np.ones((60, 1, 1))
    values[w > 5.0] = np.nan
    assert float(response_statistics(operator(values, w, [0.0]), SEA, direction=0.0).m0[0]) == pytest.approx(SEA.m0, rel=0.01)
    values[(w > 0.6) & (w < 0.8)] = np.nan
    with pytest.raises(InputError, match="where the sea has energy"):
        response_statistics(operator(values, w, [0.0]), SEA, direction=0.0)


def test_motions_of_a_strip_theory_code_at_five_speeds(shared_data):
    """S175 of VERES, 0 to 20 knots, head to following seas: its coefficients and forces give its motions, phases included.

    Waves that the ship overtakes are left out: VERES puts |omega_e| into the impedance there.
    """
    from scipy.io import loadmat

    from ogilvie.frames import Z_DOWN

    s175 = loadmat(shared_data / "mss_shipx_s175" / "s175.mat", squeeze_me=True, struct_as_record=False)["vessel"]
    A, B = (M.transpose(3, 2, 0, 1) * Z_DOWN[:, None] * Z_DOWN for M in (s175.A, s175.B))
    M, C = (m * Z_DOWN[:, None] * Z_DOWN for m in (s175.MRB, s175.C[:, :, 0, 0]))
    forces, motions = (
        np.stack([a * np.exp(1j * p) for a, p in zip(raos.amp, raos.phase, strict=True)], axis=-1) * Z_DOWN
        for raos in (s175.forceRAO, s175.motionRAO)
    )  # (n_w, n_b, n_u, 6), about the centre of gravity; matrices about midship
    x_G = s175.main.CG[0]
    forces[..., 4] -= x_G * forces[..., 2]
    motions[..., 2] += x_G * motions[..., 4]
    some = [0, 3, 6, 12, 15, 18]  # 0, 30, 60, 120, 150, 180 deg clockwise
    keep = {"influenced_dof": ["surge", "heave", "pitch"], "radiating_dof": ["surge", "heave", "pitch"]}
    order = np.argsort(-s175.headings[some])
    for n, speed in enumerate(s175.velocities):
        hydro = hydro_from_arrays(
            omega=s175.freqs, added_mass=A[n], radiation_damping=B[n], wave_direction=-s175.headings[some],
            excitation_force=forces[:, some, n], hydrostatic_stiffness=C, inertia_matrix=M, g=9.81, speed=float(speed),
        )  # fmt: skip
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", OgilvieWarning)
            X = rao(hydro.sel(keep))
        wanted = motions[:, np.array(some)[order], n]
        met = (X.encounter_frequency.values > 0.0) & np.isfinite(X.values).all(axis=-1)
        for dof, i, allowed in (("heave", 2, 0.03), ("pitch", 4, 0.08)):
            away = np.where(met, np.abs(X.sel(dof=dof).values - wanted[:, :, i]), 0.0).max(axis=0)
            error = away / np.abs(wanted[:, :, i]).max(axis=0)
            assert np.all(error[:3] < 0.006), (speed, dof, error)  # head and bow
            assert np.all(error < allowed), (speed, dof, error)  # following: few data at low omega_e
