"""Retardation functions: closed forms, the exact hemisphere, identities, bad input."""

import numpy as np
import pytest

import ogilvie as og


def exponential_pair(omega, a=0.8, w0=1.1):
    """K = exp(-a t) cos(w0 t) with its damping and added mass (A_inf = 2): K_hat = (s + a)/((s + a)^2 + w0^2)."""
    s = 1j * omega
    K_hat = (s + a) / ((s + a) ** 2 + w0**2)
    return K_hat.real, 2.0 + K_hat.imag / omega


def test_closed_form_pair_comes_back():
    """B does not vanish at zero frequency here, so K_hat is taken with a zero there: K = d/dt of exp(-a t) sin(w0 t)."""
    a, w0, omega = 0.8, 1.1, np.linspace(0.02, 12.0, 600)
    s = 1j * omega
    K_hat = w0 * s / ((s + a) ** 2 + w0**2)
    h = og.hydro_from_arrays(
        omega=omega,
        added_mass=(2 + K_hat.imag / omega)[:, None, None],
        radiation_damping=K_hat.real[:, None, None],
        dofs=("heave",),
    )
    K = og.retardation(h, duration=15.0, dt=0.05)
    exact = np.exp(-a * K.t) * (w0 * np.cos(w0 * K.t) - a * np.sin(w0 * K.t))
    assert np.abs(K.K[:, 0, 0] - exact).max() < 2e-3
    assert np.isclose(K.A_inf[0, 0], 2.0, rtol=2e-3)
    back = K.transform([0.5, 1.0, 3.0])[:, 0, 0]
    s = 1j * np.array([0.5, 1.0, 3.0])
    assert np.abs(back - w0 * s / ((s + a) ** 2 + w0**2)).max() < 2e-3


@pytest.fixture(scope="module")
def hemisphere(shared_reference):
    """Exact coefficients (in units of 2/3 pi rho a^3, sqrt(g/a)) and exact K of the floating hemisphere."""
    rows = [
        line.split(",") for line in (shared_reference / "hemisphere_exact.csv").read_text().splitlines() if line[:1].isdigit()
    ]
    d = np.array(rows, dtype=float)
    rows = [line.split(",") for line in (shared_reference / "hemisphere_K.csv").read_text().splitlines() if line[:1].isdigit()]
    return d, np.array(rows, dtype=float)


def cut_at(d, Ka):
    d = d[d[:, 0] <= Ka + 1e-9]
    omega = np.sqrt(d[:, 0])
    A, B = np.zeros((2, len(d), 2, 2))
    A[:, 0, 0], A[:, 1, 1] = d[:, 3], d[:, 1]
    B[:, 0, 0], B[:, 1, 1] = d[:, 4] * omega, d[:, 2] * omega
    return og.hydro_from_arrays(omega=omega, added_mass=A, radiation_damping=B, dofs=("surge", "heave"))


def test_hemisphere_cut_at_ka_10(hemisphere):
    """K11 and K33 within 0.5 % of K(0) for all t in 0..40, and the stated errors cover the true ones."""
    d, exact = hemisphere
    K = og.retardation(cut_at(d, 10.0), duration=40.0, dt=0.05)
    assert len(K.t) == len(exact)
    error = np.abs(np.stack([K.K[:, 0, 0] - exact[:, 2], K.K[:, 1, 1] - exact[:, 1]])).max(axis=1) / [exact[0, 2], exact[0, 1]]
    assert error[0] < 0.005
    assert error[1] < 0.0005
    stated = np.diag(K.tail_error + K.truncation_error + K.discretisation_error)
    assert np.all(error < stated)


def test_hemisphere_infinite_added_mass_by_ogilvie(hemisphere):
    """A_inf = 4/pi - 1 in surge and 1/2 in heave."""
    K = og.retardation(cut_at(hemisphere[0], 10.0), duration=40.0, dt=0.05)
    assert np.allclose(np.diag(K.A_inf_ogilvie), [4 / np.pi - 1, 0.5], atol=2e-5)


@pytest.mark.parametrize(("tail", "worst"), [("none", 0.15), ("omega-2", 0.15)])
def test_hemisphere_surge_needs_the_right_tail(hemisphere, tail, worst):
    """What the fitted tail is for: with none, or with omega^-2, early surge is wrong by more than 15 %."""
    d, exact = hemisphere
    K = og.retardation(cut_at(d, 10.0), duration=40.0, dt=0.05, tail=tail)
    assert np.abs(K.K[:, 0, 0] - exact[:, 2]).max() / exact[0, 2] > worst


def test_froude_scaling(hemisphere):
    """Stretching length by 4 (time by 2) multiplies K by the mass over the time squared: 4^3 / 2^2."""
    d, _ = hemisphere
    h = cut_at(d, 10.0)
    big = og.hydro_from_arrays(
        omega=h.omega.values / 2,
        added_mass=h.added_mass.values * 64,
        radiation_damping=h.radiation_damping.values * 32,
        dofs=("surge", "heave"),
    )
    small, large = og.retardation(h, duration=20.0, dt=0.1), og.retardation(big, duration=40.0, dt=0.2)
    assert np.allclose(large.K, small.K * 16, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"duration": -1.0}, "duration"),
        ({"dt": 0.0}, "dt"),
        ({"dt": np.nan}, "dt"),
        ({"duration": "long"}, "duration"),
        ({"dt": 3.0, "duration": 2.0}, "exceeds"),
        ({"tail": "omega-4"}, "tail"),
        ({"interpolation": "cubic"}, "interpolation"),
    ],
)
def test_bad_arguments(change, words):
    omega = np.linspace(0.1, 5, 50)
    B, A = exponential_pair(omega)
    h = og.hydro_from_arrays(omega=omega, added_mass=A[:, None, None], radiation_damping=B[:, None, None], dofs=("heave",))
    with pytest.raises(og.InputError, match=words):
        og.retardation(h, **change)


def oscillating(U=0.0):
    """Radiation data at speed U of a model whose K is known, with its retardation functions at rest."""
    w = np.linspace(0.02, 12.0, 600)
    s = 1j * w[:, None, None]
    b = np.array([[2.0, 0.4], [0.5, 1.5]])  # two oscillators: K_hat(0) = 0, passive
    H = s * b.T @ np.linalg.solve(s**2 * np.eye(2) + s * np.diag([0.9, 1.2]) + np.diag([0.8, 1.7]), np.tile(b, (600, 1, 1)))
    A_inf = np.array([[5.0, 0.3], [0.3, 7.0]])
    T = A_inf + H / s
    L = np.array([[0.0, -1.0], [0.0, 0.0]])
    T = (np.eye(2) + U * L.T / s) @ T @ (np.eye(2) - U * L / s)
    return og.hydro_from_arrays(
        omega=w,
        added_mass=T.real,
        radiation_damping=-w[:, None, None] * T.imag,
        added_mass_inf=A_inf,
        speed=U,
        dofs=("heave", "pitch"),
    )


def test_data_at_speed_give_the_retardation_functions_at_rest():
    rest, sailing = (og.retardation(oscillating(U), duration=40.0, dt=0.05) for U in (0.0, 1.5))
    assert np.abs(sailing.K - rest.K).max() < 1e-9 * np.abs(rest.K).max()
    assert any("speed 1.5 m/s are taken off" in note for note in sailing.notes)


def test_kernel_at_speed_has_the_added_mass_and_damping_at_speed():
    U = 1.5
    K = og.retardation(oscillating(), duration=60.0, dt=0.02)
    sailing = og.kernel_at_speed(K, U)
    wanted = oscillating(U)
    w = wanted.omega.values[10:200:10]
    table = og.Retardation(sailing.t, sailing.K, sailing.A_inf, ("heave", "pitch"))
    K_hat = table.transform(w)
    B = sailing.damping + K_hat.real
    A = sailing.A_inf + K_hat.imag / w[:, None, None] - sailing.stiffness / w[:, None, None] ** 2
    at = slice(10, 200, 10)
    assert np.abs(B - wanted.radiation_damping.values[at]).max() < 2e-3 * np.abs(wanted.radiation_damping.values).max()
    size = np.abs(wanted.added_mass.values[at])
    assert (np.abs(A - wanted.added_mass.values[at]) / size.max(axis=(1, 2))[:, None, None]).max() < 2e-3
    assert np.abs(sailing.K[-1]).max() < 1e-3 * np.abs(sailing.K).max()


def test_single_frequency_and_zero_damping_are_refused():
    one = og.hydro_from_arrays(
        omega=[1.0], added_mass=np.ones((1, 1, 1)), radiation_damping=np.ones((1, 1, 1)), dofs=("heave",)
    )
    with pytest.raises(og.InputError, match="at least 4 frequencies"):
        og.retardation(one)
    w = np.linspace(0.1, 1, 9)
    none = og.hydro_from_arrays(omega=w, added_mass=np.ones((9, 1, 1)), radiation_damping=np.zeros((9, 1, 1)), dofs=("heave",))
    with pytest.raises(og.InputError, match="no fluid memory"):
        og.retardation(none)


@pytest.mark.parametrize(
    ("t", "K", "words"),
    [
        (np.array([0, 1, 3.0]), np.zeros((3, 1, 1)), "uniform"),
        (np.array([1, 2, 3.0]), np.zeros((3, 1, 1)), "start at 0"),
        (np.array([0, 1, 2.0]), np.full((3, 1, 1), np.nan), "finite"),
        (np.array([0, 1, 2.0]), np.zeros((3, 2, 2)), "expected"),
    ],
)
def test_table_that_is_no_retardation_function(t, K, words):
    with pytest.raises(og.InputError, match=words):
        og.Retardation(t, K, np.ones((1, 1)), ("heave",))
