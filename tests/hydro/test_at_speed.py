"""Forward speed put on zero-speed data and taken off again: strip theory, time domain, the panel method, other codes."""

import warnings

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.frames import Z_DOWN
from ogilvie.hydro.at_speed import at_speed, zero_speed_equivalent
from ogilvie.hydro.capytaine import solve_bem
from ogilvie.hydro.checks import check
from ogilvie.hydro.netcdf import read_netcdf, write_netcdf
from ogilvie.hydro.rao import rao
from ogilvie.hydro.schema import DOFS, hydro_from_arrays
from ogilvie.hydro.speed_terms import FluidMomentum, fluid_momentum, speed_matrix
from ogilvie.memory.retardation import retardation
from ogilvie.mesh.shapes import hemisphere, wigley
from ogilvie.units import GRAVITY, deg
from ogilvie.waves.dispersion import encounter_frequency

OMEGA = np.linspace(0.2, 3.0, 15)
U = 6.0
B_ALL = np.array([0.0, 40.0, 90.0, 140.0, 180.0]) * deg


def made_up(seed=1, directions=B_ALL, **changes):
    """Symmetric positive A, B of six dofs that vary smoothly, and forces in two parts."""
    rng = np.random.default_rng(seed)
    G, H = rng.normal(size=(2, 6, 6))
    A = (6 * np.eye(6) + G @ G.T) * (1.0 + 0.3 * np.cos(OMEGA))[:, None, None]
    B = (np.eye(6) + H @ H.T) * (OMEGA**3 * np.exp(-2 * OMEGA))[:, None, None]
    shape = (len(OMEGA), len(directions), 6)
    parts = rng.normal(size=(2, *shape)) + 1j * rng.normal(size=(2, *shape))
    arguments = {
        "omega": OMEGA, "added_mass": A, "radiation_damping": B, "added_mass_inf": A[-1], "wave_direction": directions,
        "froude_krylov_force": parts[0], "diffraction_force": parts[1], "g": GRAVITY,
        "hydrostatic_stiffness": np.diag([5.0, 5.0, 90.0, 80.0, 100.0, 5.0]), "inertia_matrix": 20.0 * np.eye(6),
    }  # fmt: skip
    return hydro_from_arrays(**{**arguments, **changes})


def moved(hydro, speed, **options):
    """at_speed without the warning of encounter frequencies beyond the data."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)
        return at_speed(hydro, speed, **options)


def rested(hydro):
    """zero_speed_equivalent without that warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)
        return zero_speed_equivalent(hydro)


# ---------------------------------------------------------------------------------------------------- coefficients


def strips(w, speed, kind):
    """F = -(d/dt - U d/dx) of the momentum of each strip, integrated: A and B of translation and rotation.

    Vertical: a strip is displaced by z - x theta; horizontal: by y + x psi.
    """
    x, weight = np.polynomial.legendre.leggauss(60)
    sign = -1.0 if kind == "vertical" else 1.0
    m = (1 - x**2) ** 2 * (2.0 + 0.7 * x + 0.4 * x**2) * (1.0 + 0.2 * np.cos(w))
    b = (1 - x**2) ** 2 * (0.6 - 0.3 * x) * w**2
    lever = np.stack([np.ones_like(x), sign * x])  # displacement of the strip per unit translation, rotation
    slope = np.stack([np.zeros_like(x), sign * np.ones_like(x)])
    s = 1j * w
    velocity = s * lever - speed * slope
    momentum = (m + b / s) * velocity
    # -int lever (s - U d/dx) p dx; p vanishes at the ends, so -U int lever dp/dx = +U int slope p
    force = -np.einsum("ix,jx,x->ij", s * lever + speed * slope, momentum, weight)
    T = -force / s**2
    return T.real, -w * T.imag


@pytest.mark.parametrize(("kind", "dofs"), [("vertical", ("heave", "pitch")), ("horizontal", ("sway", "yaw"))])
def test_strip_theory_is_met_exactly(kind, dofs):
    def data(speed):
        A, B = np.transpose([strips(w, speed, kind) for w in OMEGA], (1, 0, 2, 3))
        return hydro_from_arrays(omega=OMEGA, added_mass=A, radiation_damping=B, dofs=dofs)

    still, sailing = data(0.0), at_speed(data(0.0), U)
    for key in ("added_mass", "radiation_damping"):
        wanted = data(U)[key].values
        assert np.abs(wanted - still[key].values).max() > 0.3 * np.abs(wanted).max()
        np.testing.assert_allclose(sailing[key].values, wanted, rtol=1e-12, atol=1e-12 * np.abs(wanted).max())


def test_terms_of_salvesen_tuck_and_faltinsen():
    hydro = made_up()
    A, B = hydro.added_mass.values, hydro.radiation_damping.values
    found = moved(hydro, U)
    A_U, B_U, w2 = found.added_mass.values, found.radiation_damping.values, OMEGA**2
    for i, j, u in ((2, 4, U), (1, 5, -U)):
        np.testing.assert_allclose(A_U[:, i, i], A[:, i, i])
        np.testing.assert_allclose(A_U[:, i, j], A[:, i, j] - u * B[:, i, i] / w2)
        np.testing.assert_allclose(B_U[:, i, j], B[:, i, j] + u * A[:, i, i])
        np.testing.assert_allclose(A_U[:, j, i], A[:, j, i] + u * B[:, i, i] / w2)
        np.testing.assert_allclose(B_U[:, j, i], B[:, j, i] - u * A[:, i, i])
        np.testing.assert_allclose(A_U[:, j, j], A[:, j, j] + U**2 * A[:, i, i] / w2)
        np.testing.assert_allclose(B_U[:, j, j], B[:, j, j] + U**2 * B[:, i, i] / w2)
    L = speed_matrix(DOFS)
    np.testing.assert_allclose(found.radiation_damping_inf.values, U * (L.T @ A[-1] - A[-1] @ L))


def test_timman_newman_reversed_flow():
    """A_ij(U) = A_ji(-U), and the same of B."""
    hydro = made_up()
    ahead, astern = moved(hydro, U), moved(hydro, -U)
    for key in ("added_mass", "radiation_damping", "radiation_damping_inf"):
        np.testing.assert_allclose(ahead[key].values, np.swapaxes(astern[key].values, -1, -2), rtol=1e-10, atol=1e-10)


def test_strip_theory_code_at_five_speeds(shared_data):
    """VERES, S175 at 5, 10, 15, 20 knots against its own coefficients at zero speed, in the same axes: signs and size."""
    from scipy.io import loadmat

    s175 = loadmat(shared_data / "mss_shipx_s175" / "s175.mat", squeeze_me=True, struct_as_record=False)["vessel"]
    A, B = (M.transpose(3, 2, 0, 1) * Z_DOWN[:, None] * Z_DOWN for M in (s175.A, s175.B))
    still = hydro_from_arrays(omega=s175.freqs, added_mass=A[0], radiation_damping=B[0])
    pairs = [(2, 4), (4, 2), (4, 4), (1, 5), (5, 1), (5, 5), (3, 5), (5, 3)]
    for n, speed in enumerate(s175.velocities[1:], start=1):
        found = at_speed(still, float(speed))
        for key, wanted, rest in (("added_mass", A[n], A[0]), ("radiation_damping", B[n], B[0])):
            error = {p: np.abs(found[key].values - wanted)[:, *p].max() / np.abs(wanted[:, *p]).max() for p in pairs}
            assert max(error.values()) < 0.016, (speed, key, error)
            change = np.abs(rest - wanted)[:, 2, 4].max() / np.abs(wanted[:, 2, 4]).max()
            assert change > 0.5, "the test would see no speed"


# ---------------------------------------------------------------------------------------------------- wave forces


def test_forces_do_not_change_at_zero_speed_and_in_beam_seas_but_for_rotation():
    hydro = made_up(directions=[np.pi / 2])
    np.testing.assert_allclose(at_speed(hydro, 0.0).excitation_force.values, hydro.excitation_force.values, rtol=1e-12)
    X, X_U = hydro.diffraction_force.values, at_speed(hydro, U).diffraction_force.values
    np.testing.assert_allclose(X_U[..., :4], X[..., :4])
    iw = 1j * OMEGA[:, None]
    np.testing.assert_allclose(X_U[..., 4], X[..., 4] - U * X[..., 2] / iw)
    np.testing.assert_allclose(X_U[..., 5], X[..., 5] + U * X[..., 1] / iw)


def test_added_mass_alone_meets_the_wave_at_the_frequency_of_encounter():
    """Constant A, no B: X_D = (i omega_e + U L^T) A v, whatever the sign of omega_e, and regular at omega_e = 0."""
    v = np.random.default_rng(3).normal(size=(3, 6)) + 0j
    A = np.diag([1.0, 5, 6, 2, 40, 50]) + 0.1
    w = np.array([1.0, GRAVITY / U, 2.5])  # the second: omega_e = 0 in following seas
    X = np.einsum("w,ij,bj->wbi", 1j * w, A, v)
    still = hydro_from_arrays(
        omega=w, added_mass=np.tile(A, (3, 1, 1)), radiation_damping=np.zeros((3, 6, 6)), wave_direction=[0.0, 1.0, np.pi],
        froude_krylov_force=X, diffraction_force=X, g=GRAVITY,
    )  # fmt: skip
    found = moved(still, U)
    w_e = encounter_frequency(w[:, None], speed=U, direction=still.wave_direction.values, g=GRAVITY)
    assert (np.abs(w_e) < 1e-9).any()
    assert (w_e < -0.5).any()
    L = speed_matrix(DOFS)
    wanted = 1j * w_e[..., None] * (v @ A) + U * (v @ A) @ L
    np.testing.assert_allclose(found.diffraction_force.values, wanted, atol=1e-9)
    np.testing.assert_allclose(found.Froude_Krylov_force.values, X)


def test_hull_gives_the_froude_krylov_force():
    hull = wigley(3.0, kind="III", panels=100)
    still = solve_bem(hull, omega=[1.0, 3.0, 5.0], wave_direction=[1.0, np.pi], progress=False)
    total = still.drop_vars(["Froude_Krylov_force", "diffraction_force"])
    with pytest.raises(InputError, match="hull="):
        at_speed(total, 1.0)
    one, other = moved(still, 1.0), moved(total, 1.0, hull=hull)
    for key in ("excitation_force", "Froude_Krylov_force"):
        np.testing.assert_allclose(other[key].values, one[key].values, atol=1e-9 * np.abs(one[key].values).max())
    part = still.drop_vars("Froude_Krylov_force")
    np.testing.assert_allclose(moved(part, 1.0).excitation_force.values, one.excitation_force.values, rtol=1e-9, atol=1e-6)


# ---------------------------------------------------------------------------------------------------- panel method


@pytest.fixture(scope="module")
def panel_method():
    """Wigley III, Fn 0.3: solved at speed, and at zero speed up to the highest frequency of encounter that matters."""
    hull, speed, g = wigley(3.0, kind="III", panels=250), 0.3 * np.sqrt(9.81 * 3.0), 9.81
    options = {"wave_direction": B_ALL, "rho": 1000.0, "g": g, "progress": False}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)
        still = solve_bem(hull, omega=np.arange(0.8, 9.61, 0.4), **options)
        sailing = solve_bem(hull, omega=still.omega.values[:12], speed=speed, **options)
    return still, sailing, speed


def test_coefficients_are_those_of_the_panel_method(panel_method):
    still, sailing, speed = panel_method
    ours = moved(still, speed).isel(omega=slice(12))
    for key in ("added_mass", "radiation_damping", "radiation_damping_inf"):
        np.testing.assert_allclose(ours[key].values, sailing[key].values, rtol=1e-9, atol=1e-9 * np.abs(ours[key].values).max())


def test_wave_forces_are_near_those_of_the_panel_method(panel_method):
    """Heave within 3 % of the largest force, the others within 10 %; without the terms of speed far more."""
    still, sailing, speed = panel_method
    short = sailing.omega.values[np.abs(_encounters(sailing)).max(axis=1) < still.omega.values[-1]]
    ours, theirs, rest = (h.excitation_force.sel(omega=short).values for h in (moved(still, speed), sailing, still))
    assert len(short) > 6
    for i, allowed in ((0, 0.06), (1, 0.08), (2, 0.03), (4, 0.10), (5, 0.10)):
        size = np.abs(theirs[..., i]).max()
        error, unmoved = (np.abs(X - theirs)[..., i].max() / size for X in (ours, rest))
        assert error < allowed, (DOFS[i], error)
        assert error < 0.6 * unmoved, (DOFS[i], error, unmoved)


def test_overtaken_waves_are_near_those_of_the_panel_method(panel_method):
    """At 4 m/s the hull overtakes following waves from 2.5 rad/s: the conjugate problem, found in two ways."""
    still, *_ = panel_method
    hull, speed, omega = wigley(3.0, kind="III", panels=250), 4.0, still.omega.values[5:11]  # 2.8 to 4.8 rad/s
    options = {"wave_direction": [0.0, 20 * deg], "rho": 1000.0, "g": 9.81, "progress": False}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)
        theirs = solve_bem(hull, omega=omega, speed=speed, **options)
        rest = solve_bem(hull, omega=still.omega.values, **options)
    assert _encounters(theirs).max() < -0.2
    ours = moved(rest, speed).sel(omega=omega).diffraction_force.values
    wanted = theirs.diffraction_force.values
    for i in (0, 2, 4):
        size = np.abs(theirs.excitation_force.values[..., i]).max()
        error, turned = (np.abs(X - wanted)[..., i].max() / size for X in (ours, ours.conj()))
        assert error < 0.1, (DOFS[i], error)
        assert error < 0.2 * turned, "the test would not see the conjugate"


def _encounters(hydro):
    return encounter_frequency(
        hydro.omega.values[:, None], speed=hydro.attrs["speed"], direction=hydro.wave_direction.values, g=hydro.attrs["g"]
    )


def test_memory_from_data_at_speed(panel_method):
    """The retardation function of solve_bem(speed=...) with the terms of speed taken off is that of zero speed."""
    still, sailing, _ = panel_method
    back = zero_speed_equivalent(sailing.drop_vars(["excitation_force", "Froude_Krylov_force", "diffraction_force"]))
    part = still.isel(omega=slice(12))
    assert back.attrs["asymmetry_added_mass"] < 0.02
    assert back.attrs["asymmetry_radiation_damping"] < 0.03
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)
        K, K_still = (retardation(h, duration=10.0, dt=0.1) for h in (back, part))
    np.testing.assert_allclose(K.K, K_still.K, atol=1e-8 * np.abs(K_still.K).max())
    assert not [f for f in check(back).findings if f.kind == "reciprocity"]


def test_a_body_of_revolution_has_no_momentum_about_its_axis():
    """A66 = 0: its row and column are left alone, nothing is divided by zero."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)
        still = solve_bem(hemisphere(1.0, panels=144), omega=[1.0, 2.0, 3.0], wave_direction=[0.0, 2.0], progress=False)
    found = moved(still, 0.3).diffraction_force.values
    assert np.all(np.isfinite(found))
    assert np.abs(found[..., 2]).max() < 1.5 * np.abs(still.diffraction_force.values[..., 2]).max()


# ---------------------------------------------------------------------------------------------------- there and back


@pytest.mark.parametrize("speed", [U, -2.5])
def test_round_trip(speed):
    hydro = made_up()
    back = rested(moved(hydro, speed))
    assert back.attrs["speed"] == 0.0
    for key in ("added_mass", "radiation_damping", "excitation_force", "diffraction_force", "Froude_Krylov_force"):
        wanted = hydro[key].values
        np.testing.assert_allclose(back[key].values, wanted, rtol=1e-8, atol=1e-9 * np.abs(wanted).max(), err_msg=key)
    assert back.attrs["asymmetry_added_mass"] < 1e-12


def test_asymmetry_is_reported():
    hydro = made_up()
    A = hydro.added_mass.values.copy()
    A[:, 2, 4] += 0.05 * np.sqrt(A[:, 2, 2].max() * A[:, 4, 4].max())
    skewed = hydro.assign(added_mass=(hydro.added_mass.dims, A)).drop_vars(
        ["excitation_force", "Froude_Krylov_force", "diffraction_force"]
    )
    back = zero_speed_equivalent(at_speed(skewed, U))
    assert back.attrs["asymmetry_added_mass"] == pytest.approx(0.05, rel=1e-6)
    assert back.attrs["asymmetry_radiation_damping"] < 1e-12


def test_waves_that_stand_still_have_no_zero_speed_equivalent():
    hydro = made_up(directions=[0.0])
    sailing = moved(hydro, GRAVITY / OMEGA[6])  # phase velocity g/omega
    with pytest.raises(InputError, match=r"omega_e = 0 found at 1.4 rad/s in direction 0 deg"):
        rested(sailing)


def test_what_is_not_known_at_speed_is_left_out(tmp_path):
    shape = (len(OMEGA), len(B_ALL), 6)
    hydro = made_up(mean_drift=np.ones(shape), motion_rao=np.ones(shape), added_mass_zero=np.eye(6))
    sailing = moved(hydro, U)
    assert {"mean_drift", "motion_rao", "added_mass_zero"}.isdisjoint(sailing.data_vars)
    assert sailing.attrs["speed"] == U
    for key in ("hydrostatic_stiffness", "inertia_matrix", "added_mass_inf"):
        np.testing.assert_array_equal(sailing[key].values, hydro[key].values)
    assert read_netcdf(write_netcdf(sailing, tmp_path / "sailing.nc")).identical(sailing)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: at_speed(made_up(speed=3.0), 2.0), "zero_speed_equivalent first"),
        (lambda: zero_speed_equivalent(made_up()), "at speed expected"),
        (lambda: at_speed(made_up(), np.nan), "finite number"),
        (lambda: at_speed("hydro.nc", 1.0), "data set"),
        (lambda: at_speed(made_up().sel(influenced_dof=["pitch"], radiating_dof=["pitch"]), 1.0), "heave with pitch"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()


def test_frequencies_of_encounter_beyond_the_data_are_named():
    with pytest.warns(OgilvieWarning, match=r"exceeds the radiation data \(3 rad/s\)"):
        at_speed(made_up(), U)


# ---------------------------------------------------------------------------------------------------- interpolation


def test_momentum_is_continuous_and_conjugate():
    hydro = made_up()
    fluid = fluid_momentum(hydro)
    np.testing.assert_allclose(fluid.at(OMEGA), fluid.T)
    np.testing.assert_allclose(fluid.at(-OMEGA), fluid.T.conj())
    for edge in (0.0, OMEGA[0], OMEGA[-1]):
        np.testing.assert_allclose(fluid.at(edge + 1e-7), fluid.at(edge - 1e-7), atol=1e-4)
    assert isinstance(fluid, FluidMomentum)
    np.testing.assert_allclose(fluid.at(1e6), hydro.added_mass_inf.values, atol=1e-9)


def test_motion_in_following_quartering_and_head_seas_is_that_of_the_time_domain():
    """M xi'' + (d/dt + U L^T) p + C xi = Re X exp(i w_e t), p = A nu + G x2, x1' = nu - c x1, x2' = x1 - c x2."""
    A, G, c = np.array([[3.0, 0.4], [0.4, 2.0]]), np.array([[6.0, 0.8], [0.8, 5.0]]), 1.5
    M, C, speed = np.diag([4.0, 5.0]), np.array([[120.0, 5.0], [5.0, 200.0]]), 5.0
    omega, directions = np.linspace(0.1, 3.0, 59), np.array([0.0, 35.0, 150.0]) * deg
    T = A + G / (1j * omega[:, None, None] + c) ** 2
    rng = np.random.default_rng(8)
    X = rng.normal(size=(59, 3, 2)) + 1j * rng.normal(size=(59, 3, 2))
    still = hydro_from_arrays(
        omega=omega, added_mass=T.real, radiation_damping=-omega[:, None, None] * T.imag, dofs=("heave", "pitch"),
        wave_direction=directions, froude_krylov_force=X, diffraction_force=0 * X, hydrostatic_stiffness=C, inertia_matrix=M,
        g=GRAVITY,
    )  # fmt: skip
    motion = _quiet_rao(moved(still, speed))
    L = speed_matrix(("heave", "pitch"))
    w_e = motion.encounter_frequency.values
    inside = [(i, j) for i, j in np.ndindex(w_e.shape) if 0.1 < abs(w_e[i, j]) < 3.0]
    overtaken = [p for p in inside if w_e[p] < -0.4]
    assert len(overtaken) > 10
    for i, j in [overtaken[0], overtaken[-1], inside[0], inside[-1]]:
        s, z, force = 1j * w_e[i, j], motion.values[i, j], X[i, j]

        def rate(t, y, s=s, force=force):
            xi, velocity, x1, x2 = y.reshape(4, 2)
            nu, dx2 = velocity - speed * L @ xi, x1 - c * x2
            load = (force * np.exp(s * t)).real - C @ xi - G @ dx2 - speed * L.T @ (A @ nu + G @ x2)
            acceleration = np.linalg.solve(M + A, load + speed * A @ L @ velocity)
            return np.concatenate([velocity, acceleration, nu - c * x1, dx2])

        # start on the steady motion: what is wrong in it would be seen to swing free
        nu = s * z - speed * L @ z
        start = np.concatenate([z, s * z, nu / (s + c), nu / (s + c) ** 2]).real
        t = np.linspace(0.0, 12.0, 60)
        run = solve_ivp(rate, (0.0, 12.0), start, t_eval=t, rtol=1e-9, atol=1e-12)
        wanted = (z[:, None] * np.exp(s * t)).real
        np.testing.assert_allclose(run.y[:2], wanted, atol=0.002 * np.abs(z).max())


def _quiet_rao(hydro):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)
        return rao(hydro)


def test_motion_is_regular_where_the_ship_keeps_up_with_the_waves():
    """At omega_e -> 0 the impedance goes to C - U^2 L^T A L, not to what 1/omega^2 between the data would make of it."""
    omega = np.linspace(0.3, 1.6, 27)
    A, n = np.diag([2.0, 3.0]), 27
    still = hydro_from_arrays(
        omega=omega, added_mass=np.tile(A, (n, 1, 1)), radiation_damping=np.zeros((n, 2, 2)), dofs=("heave", "pitch"),
        wave_direction=[0.0], froude_krylov_force=np.ones((n, 1, 2)), diffraction_force=np.zeros((n, 1, 2)),
        hydrostatic_stiffness=np.diag([50.0, 400.0]), inertia_matrix=np.eye(2), g=GRAVITY,
    )  # fmt: skip
    speed = GRAVITY / 0.8
    found = rao(at_speed(still, speed))
    i = int(np.argmin(np.abs(found.encounter_frequency.values[:, 0])))
    w = found.encounter_frequency.values[:, 0]
    assert abs(w[i]) < 1e-12
    for k in range(i - 4, i + 5):
        s = 1j * w[k]
        R = np.diag([2.0 * s**2, 3.0 * s**2 - speed**2 * 2.0]) + 2.0 * s * speed * np.array([[0, 1.0], [-1.0, 0]])
        wanted = np.linalg.solve(R + s**2 * np.eye(2) + np.diag([50.0, 400.0]), [1.0, 1.0])
        np.testing.assert_allclose(found.values[k, 0], wanted, rtol=1e-9, atol=1e-12)
