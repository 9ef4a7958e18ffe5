"""Every way from radiation data to K(t) by the same tests; the added mass at infinite frequency; bad data."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.memory.curves import continued
from ogilvie.memory.from_added_mass import kernel_from_added_mass
from ogilvie.memory.from_damping import kernel_from_damping
from ogilvie.memory.from_samples import kernel_by_ifft
from ogilvie.memory.retardation import METHODS

A, W0 = 0.8, 1.1  # 1/s, rad/s
EXACT = ("damping", "added_mass")
SAMPLED = ("trapezoid", "ifft")


def synthetic(last=12.0, n=150, *, A_inf=2.0, given=True, **change):
    """K = d/dt exp(-a t) sin(w0 t): K_hat = w0 s/((s + a)^2 + w0^2), heave only."""
    omega = last / n * np.arange(1, n + 1)
    K_hat = W0 * 1j * omega / ((1j * omega + A) ** 2 + W0**2)
    data = {"added_mass": A_inf + K_hat.imag / omega, "radiation_damping": K_hat.real} | change
    return og.hydro_from_arrays(
        omega=omega,
        added_mass_inf=[[A_inf]] if given else None,
        dofs=("heave",),
        **{name: values[:, None, None] for name, values in data.items()},
    )


def exact_kernel(t):
    return np.exp(-A * t) * (W0 * np.cos(W0 * t) - A * np.sin(W0 * t))


@pytest.fixture(scope="module")
def hemisphere(shared_reference):
    """Hydro of surge and heave cut at Ka = 10 (unit 2/3 pi rho a^3), and the exact t, K (n, 2)."""
    d = np.genfromtxt(shared_reference / "hemisphere_exact.csv", delimiter=",", names=True, skip_header=2)
    exact = np.loadtxt(shared_reference / "hemisphere_K.csv", delimiter=",", skiprows=2)
    d = d[d["Ka"] <= 10.0 + 1e-9]
    omega = np.sqrt(d["Ka"])
    mass, damping = np.zeros((2, len(d), 2, 2))
    for i, n in enumerate(("11", "33")):
        mass[:, i, i], damping[:, i, i] = d["mu" + n], d["lam" + n] * omega
    h = og.hydro_from_arrays(
        omega=omega,
        added_mass=mass,
        radiation_damping=damping,
        added_mass_inf=np.diag([4 / np.pi - 1, 0.5]),
        dofs=("surge", "heave"),
    )
    return h, exact[:, 0], exact[:, [2, 1]]


@pytest.mark.parametrize("interpolation", ["spline", "linear"])
@pytest.mark.parametrize(("method", "worst"), [("damping", 2e-3), ("added_mass", 2e-3), ("trapezoid", 0.09), ("ifft", 0.55)])
def test_closed_form(method, worst, interpolation):
    """The samples lack what lies beyond the data (9 % of K(0)); the discrete transform takes half of K(0+) at t = 0."""
    K = og.retardation(synthetic(), method=method, duration=15.0, dt=0.05, interpolation=interpolation)
    error = np.abs(K.K[:, 0, 0] - exact_kernel(K.t)) / W0
    assert error.max() < worst
    assert error[K.t > 5.0].max() < 5e-3


@pytest.mark.parametrize("method", METHODS)
def test_hemisphere(hemisphere, method):
    """Largest error over 0 <= t (g/a)^1/2 <= 40 as a part of K(0): surge, heave."""
    h, _, exact = hemisphere
    K = og.retardation(h, method=method, duration=40.0, dt=0.05)
    error = np.abs(np.einsum("tii->ti", K.K) - exact).max(axis=0) / exact[0]
    low, high = {
        "damping": ((0.0, 0.0), (0.005, 5e-4)),
        "added_mass": ((0.0, 0.0), (0.013, 0.007)),
        "trapezoid": ((0.15, 0.005), (0.25, 0.1)),
        "ifft": ((0.45, 0.45), (0.6, 0.55)),
    }[method]
    assert np.all(error > low)
    assert np.all(error < high)


def test_added_mass_form_meets_its_value_at_zero_by_the_tail_alone():
    """The sine integral over the data vanishes at t = 0; K(0) = 1.1 is the coefficient of the tail -K(0)/omega."""
    K = og.retardation(synthetic(), method="added_mass", duration=15.0, dt=0.05)
    assert K.K[0, 0, 0] == pytest.approx(W0, rel=2e-3)


@pytest.mark.parametrize("method", EXACT)
@pytest.mark.parametrize(("interpolation", "least"), [("linear", 1.8), ("spline", 3.0)])
def test_exact_forms_converge_with_the_spacing(method, interpolation, least):
    """Second order with a polygon, higher with a spline; beyond the data nothing is missing (omega up to 60)."""
    t = np.linspace(0.0, 10.0, 101)
    route = kernel_from_damping if method == "damping" else kernel_from_added_mass

    def error(n):
        h = synthetic(60.0, n)
        curves, _ = continued(h.omega.values, h.added_mass.values, h.radiation_damping.values, ("heave",), "fit")
        return np.abs(route(curves, np.array([[2.0]]), t, interpolation)[:, 0, 0] - exact_kernel(t)).max()

    assert np.log2(error(120) / error(240)) > least


def power_pair(p, s):
    """K = t^(p-1) exp(-t)/Gamma(p) - t^p exp(-t)/Gamma(p+1), with K_hat(0) = 0; damping falls as omega^-p."""
    from scipy.special import gamma

    return 1 / (1 + s) ** p - 1 / (1 + s) ** (p + 1), lambda t: np.exp(-t) * (t ** (p - 1) / gamma(p) - t**p / gamma(p + 1))


def logarithm_pair(s):
    """K = t^2 log t exp(-t) - c t^3 exp(-t)/6 with K_hat(0) = 0; damping falls as omega^-3, as in surge."""
    from scipy.special import digamma, xlogy

    c = 2 * digamma(3.0)
    return (c - 2 * np.log(1 + s)) / (1 + s) ** 3 - c / (1 + s) ** 4, lambda t: np.exp(-t) * (t * xlogy(t, t) - c * t**3 / 6)


@pytest.mark.parametrize("p", [1.7, 2.5, "logarithm"])
def test_added_mass_beyond_the_data_follows_from_the_damping_there(monkeypatch, p):
    """The causal partner of the damping's tail lowers the error three times and more."""
    omega = np.linspace(0.04, 12.0, 300)
    K_hat, exact = logarithm_pair(1j * omega) if p == "logarithm" else power_pair(p, 1j * omega)
    mass, damping = (1.0 + K_hat.imag / omega)[:, None, None], K_hat.real[:, None, None]
    curves, _ = continued(omega, mass, damping, ("heave",), "fit")
    t = np.linspace(0.0, 12.0, 241)

    def error():
        return np.abs(kernel_from_added_mass(curves, np.array([[1.0]]), t, "spline")[:, 0, 0] - exact(t)).max()

    with_partner = error()
    monkeypatch.setattr("ogilvie.memory.from_added_mass._STEEP", 0.0)
    assert with_partner < error() / 3
    assert with_partner < 0.025 * np.abs(exact(t)).max()


def test_discrete_transform_is_numpys():
    """At t = n pi/omega_N the sum equals numpy.fft.irfft of the samples over the time step."""
    h = synthetic(6.0, 60)
    K_hat = h.radiation_damping.values[:, 0, 0] + 1j * h.omega.values * (h.added_mass.values[:, 0, 0] - 2.0)
    step = np.pi / 6.0
    direct = np.fft.irfft(np.concatenate([[0.0], K_hat])) / step
    curves, _ = continued(h.omega.values, h.added_mass.values, h.radiation_damping.values, ("heave",), "none")
    t = step * np.arange(len(direct))
    assert np.allclose(kernel_by_ifft(curves, np.array([[2.0]]), t, "spline")[:, 0, 0], direct, atol=1e-12)


@pytest.mark.parametrize("method", SAMPLED)
def test_sums_repeat_themselves_and_say_so(method):
    h = synthetic(6.0, 60)
    period = 2 * np.pi / 0.1
    K = og.retardation(h, method=method, duration=1.25 * period, dt=period / 1000)
    assert np.allclose(K.K[1000:], K.K[:251], atol=1e-9)
    assert any(f"repeats at 2 pi/d_omega = {period:.4g} s" in n for n in K.notes)
    exact = og.retardation(h, duration=1.25 * period, dt=period / 1000)
    assert np.abs(exact.K[900:]).max() < 0.01 * np.abs(K.K[900:]).max()


@pytest.mark.parametrize("method", METHODS)
def test_scaling_and_symmetry(method):
    """K is linear in the data: twice the data, twice K; a coupling matrix that is symmetric stays so."""
    h = synthetic()
    wide = np.array([[1.0, 0.3], [0.3, 2.0]])
    two = og.hydro_from_arrays(
        omega=h.omega.values,
        added_mass=h.added_mass.values * wide,
        radiation_damping=h.radiation_damping.values * wide,
        added_mass_inf=2.0 * wide,
        dofs=("heave", "pitch"),
    )
    one, K = (og.retardation(x, method=method, duration=10.0, dt=0.1) for x in (h, two))
    assert np.allclose(K.K, one.K * wide, rtol=1e-9, atol=1e-9)


class TestConsistency:
    """The two exact forms check each other: the difference of K is a check of the data."""

    def test_causal_data_agree(self):
        K = og.retardation(synthetic())
        assert K.consistency_error[0, 0] < 3e-3
        assert "A vs B" in str(K)
        assert not any("another" in n for n in K.notes)

    def test_it_is_the_difference_of_the_two(self):
        h = synthetic(8.0, 40)
        a, b = (og.retardation(h, method=m, duration=10.0, dt=0.1) for m in EXACT)
        difference = np.abs(a.K - b.K).max() / np.abs(a.K).max()
        assert a.consistency_error[0, 0] == pytest.approx(difference)
        assert b.consistency_error[0, 0] == pytest.approx(difference, rel=0.05)

    def test_added_mass_of_another_body_is_found(self):
        h = synthetic()
        off = h.added_mass.values[:, 0, 0] + 0.3 * np.exp(-((h.omega.values - 1.5) ** 2) / 0.1)
        assert og.retardation(synthetic(added_mass=off)).consistency_error[0, 0] > 0.1

    def test_wrong_infinite_added_mass_is_found(self):
        h = synthetic().assign(added_mass_inf=(("influenced_dof", "radiating_dof"), [[2.1]]))
        K = og.retardation(h)
        assert K.consistency_error[0, 0] > 0.5
        assert any(n.startswith("K from the added mass is another") and "heave" in n for n in K.notes)


class TestInfiniteAddedMass:
    @pytest.mark.parametrize("method", METHODS)
    def test_without_the_limit_it_is_found(self, method):
        K = og.retardation(synthetic(given=False), method=method)
        assert not K.A_inf_given
        assert K.A_inf[0, 0] == pytest.approx(2.0, abs=1e-3)
        assert any("Ogilvie" in n for n in K.notes)

    def test_outliers_do_not_move_it(self):
        """Three frequencies off by 50 %, as irregular frequencies are: the plain mean moves by 1 %, this one by 0.1 %."""
        h = synthetic(6.0, 60, given=False)
        off = h.added_mass.values[:, 0, 0].copy()
        off[[20, 33, 47]] += 1.0
        K = og.retardation(synthetic(6.0, 60, given=False, added_mass=off))
        clean = og.retardation(h).A_inf_ogilvie[0, 0]
        assert abs(K.A_inf_ogilvie[0, 0] - clean) < 2e-3

    def test_it_moves_with_the_added_mass(self):
        """Ogilvie's relation is linear in A: a constant added to A is added to A_inf."""
        a, b = (og.retardation(synthetic(A_inf=x, given=False)).A_inf[0, 0] for x in (2.0, 5.0))
        assert b - a == pytest.approx(3.0, abs=1e-9)

    @pytest.mark.parametrize(("name", "worst"), [("fpso", 0.015), ("tanker", 0.018), ("semisub", 0.05)])
    def test_close_to_the_solvers(self, shared_reference, name, worst):
        """Diagonal terms of three WAMIT vessels; the plain mean of published tools misses by 10 % and more."""
        d = np.load(shared_reference / "radiation" / f"{name}.npz")
        some = d["omega"] > 0
        h = og.hydro_from_arrays(
            omega=d["omega"][some],
            added_mass=d["added_mass"][some],
            radiation_damping=d["radiation_damping"][some],
            added_mass_inf=d["added_mass_inf"],
        )
        K = og.retardation(h)
        assert np.abs(np.diag(K.A_inf_ogilvie) / np.diag(d["added_mass_inf"]) - 1).max() < worst


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"radiation_damping": "nan"}, "finite damping"),
        ({"added_mass": "nan"}, "finite added mass"),
        ({"radiation_damping": "zero"}, "no fluid memory"),
        ({"n": 1}, "at least 4 frequencies"),
        ({"n": 3}, "at least 4 frequencies"),
    ],
    ids=["NaN damping", "NaN added mass", "no damping", "one frequency", "three frequencies"],
)
def test_bad_data(method, change, words):
    h = synthetic(6.0, change.get("n", 60))
    for name, kind in change.items():
        if name != "n":
            h[name] = h[name] * np.nan if kind == "nan" else h[name] * 0.0
    with pytest.raises(og.InputError, match=words):
        og.retardation(h, method=method)


@pytest.mark.parametrize(
    ("change", "words"),
    [({"method": "cosine"}, "method: one of"), ({"method": "added_mass", "interpolation": "cubic"}, "interpolation: one of")],
)
def test_bad_choices(change, words):
    with pytest.raises(og.InputError, match=words):
        og.retardation(synthetic(), **change)


def test_damping_in_couplings_alone_is_no_damping():
    h = synthetic()
    only = {name: h[name].values * np.array([[0.0, 1.0], [1.0, 0.0]]) for name in ("added_mass", "radiation_damping")}
    two = og.hydro_from_arrays(omega=h.omega.values, dofs=("heave", "pitch"), **only)
    with pytest.raises(og.InputError, match="no fluid memory"):
        og.retardation(two, frequencies="all")


def test_data_without_damping_variable():
    with pytest.raises(og.InputError, match="data set"):
        og.retardation(np.ones(3))
    with pytest.raises(og.InputError, match="radiation_damping expected"):
        og.retardation(synthetic().drop_vars("radiation_damping"))


@pytest.mark.parametrize(
    ("t", "K"),
    [("soon", np.zeros((3, 1, 1))), ([0, 1, 2], [["a"]]), ([0, 1, 2], None)],
    ids=["text", "letters", "nothing"],
)
def test_a_table_must_be_numbers(t, K):
    with pytest.raises(og.InputError):
        og.Retardation(t, K, np.ones((1, 1)), ("heave",))
