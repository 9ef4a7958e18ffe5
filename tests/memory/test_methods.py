"""All methods of identification by the same tests; balanced truncation."""

import dataclasses
import warnings

import numpy as np
import pytest
import scipy.linalg

import ogilvie as og
from ogilvie.memory.blocks import r_squared
from ogilvie.memory.common_poles import MOST_POLES, fit_common_poles, modal, stable
from ogilvie.memory.frequency import _coefficients, _factors, _fractions, _orthonormal, _poles, frequency_poles
from ogilvie.memory.identify import METHODS
from ogilvie.memory.oscillators import state_space
from ogilvie.memory.passive_start import oscillators_of
from ogilvie.memory.passivity import smallest_damping
from ogilvie.memory.prony import prony_poles
from ogilvie.memory.reduce import balance, hankel_singular_values, reduce
from ogilvie.memory.targets import Impulse, Spectrum
from ogilvie.memory.vector_fitting import vector_poles

VESSELS = ("fpso", "tanker", "semisub", "s175", "supply")
PUBLISHED = tuple(m for m in METHODS if m != "oscillators")
IN_TIME = ("realization", "impulse")  # fitted to K(t); the others to A and B
pytestmark = pytest.mark.filterwarnings("default::ogilvie.errors.OgilvieWarning")


def known_model(scale=(1.0, 1.0)):
    """Two coupled dofs, three oscillators on two dampers: symmetric, passive, six distinct poles well inside the data."""
    b = np.array([[1.0, 0.3], [-0.4, 0.9], [0.5, 0.5]])
    D = np.array([[0.7, 0.0], [0.3, 0.8], [-0.5, 0.6]])
    p = np.concatenate([np.log([0.6, 1.1, 1.9]), (b * scale).ravel(), D.ravel()])
    return og.StateSpace(*state_space(p, 3, 2, 2), ("heave", "pitch"))


def exact_data(model, *, A_inf=((3.0, 0.2), (0.2, 2.0)), given=True, n_w=60):
    """K(t), A and B of a model, without any error of transforms."""
    omega, t = np.linspace(0.05, 4.0, n_w), np.arange(1201) * 0.05
    K_hat = model.transfer(omega)
    A = np.array(A_inf) + K_hat.imag / omega[:, None, None]
    first = np.array(A_inf) if given else A[-1]
    data = {"omega": omega, "added_mass": A, "radiation_damping": K_hat.real, "A_inf_given": given}
    return og.Retardation(t, model.impulse(t), first, model.dofs, **data)


@pytest.fixture(scope="module")
def vessels(shared_reference):
    """K of the five vessels, made once."""

    def load(name):
        d = np.load(shared_reference / "radiation" / f"{name}.npz")
        some = d["omega"] > 0
        return og.retardation(
            og.hydro_from_arrays(
                omega=d["omega"][some],
                added_mass=d["added_mass"][some],
                radiation_damping=d["radiation_damping"][some],
                added_mass_inf=d["added_mass_inf"] if "added_mass_inf" in d.files else None,
                name=name,
            )
        )

    return {name: load(name) for name in VESSELS}


@pytest.mark.parametrize("passive", [True, False])
@pytest.mark.parametrize("method", METHODS)
def test_a_known_model_is_found_again(method, passive):
    """Six states for data of six states; poles exact where nothing is discretised by the bilinear map."""
    true = known_model()
    K = exact_data(true)
    found = og.identify(K, method=method, order=6, passive=passive)
    exact = not passive and method in ("impulse", "frequency", "vector")
    assert found.order == 6
    lost = 1 - min(np.nanmin(x) for x in (found.r2, found.r2_added_mass, found.r2_damping))
    assert lost < (1e-10 if exact else 1e-3)
    if exact:
        assert np.abs(np.sort_complex(found.poles) - np.sort_complex(true.poles)).max() < 1e-5
    else:
        assert np.abs(np.sort(np.abs(found.poles)) - np.sort(np.abs(true.poles))).max() < 0.15


#: As published on every vessel; the passive refit, one code for all methods, on two (the default sees all in test_identify).
CASES = [(n, m, False) for n in VESSELS for m in PUBLISHED] + [(n, m, True) for n in ("tanker", "semisub") for m in PUBLISHED]


@pytest.mark.parametrize(("name", "method", "passive"), CASES)
def test_real_vessels(vessels, name, method, passive):
    """Stable; figures true; R2 of 0.99 reached, as published or the couplings named; passive, K_hat(0) = 0 where claimed."""
    K = vessels[name]
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", og.OgilvieWarning)
        model = og.identify(K, method=method, passive=passive)
    assert model.is_stable
    assert model.order <= 60
    assert np.allclose(model.r2, r_squared(K.K, model.impulse(K.t)), equal_nan=True)
    reached = model.r2 if method in IN_TIME and not passive else np.fmin(model.r2_added_mass, model.r2_damping)
    missed = [f"{K.dofs[i]}-{K.dofs[j]} {reached[i, j]:.4f}" for i, j in np.argwhere(reached < 0.99)]
    assert all(any(pair in note for note in model.notes) for pair in missed)
    assert {f"identify: {n}" for n in model.notes if "R2" in n} == {str(w.message) for w in said if "R2" in str(w.message)}
    grid = np.geomspace(0.01 * K.omega[0], 100 * K.omega[-1], 4000)
    assert model.is_passive == passive
    assert (smallest_damping(model.transfer(grid)) > -1e-9) == passive
    if passive:
        assert not missed
        assert model.order <= 48
    if passive or method in ("frequency", "vector"):
        assert np.abs(model.transfer(0.0)).max() < 1e-9 * np.abs(model.transfer(K.omega)).max()


@pytest.mark.parametrize("passive", [True, False])
@pytest.mark.parametrize("method", METHODS)
def test_same_answer_every_time(vessels, method, passive):
    a, b = (og.identify(vessels["semisub"], method=method, order=4, passive=passive) for _ in range(2))
    assert np.array_equal(a.A, b.A)
    assert np.array_equal(a.C, b.C)
    assert a.order == 16


@pytest.mark.parametrize("method", METHODS)
def test_units_do_not_matter(method):
    """A pitch moment in other units is the same fit."""
    small, large = (
        og.identify(exact_data(known_model(s), A_inf=np.diag(np.square(s))), method=method, order=4, passive=False)
        for s in ((1.0, 1.0), (1.0, 1e4))
    )
    assert np.allclose(np.sort_complex(small.poles), np.sort_complex(large.poles), rtol=1e-5, atol=1e-5)
    assert np.allclose(small.r2, large.r2, atol=1e-6)


@pytest.mark.parametrize("method", ["frequency", "vector"])
def test_added_mass_at_infinite_frequency_is_found_where_it_is_unknown(method):
    K = exact_data(known_model(), given=False)
    found = og.identify(K, method=method, order=6, passive=False)
    assert np.allclose(found.A_inf, [[3.0, 0.2], [0.2, 2.0]], atol=1e-6)


@pytest.mark.parametrize("method", PUBLISHED)
def test_hemisphere_with_six_states(shared_reference, method):
    """K33 and K11 of the floating hemisphere, exact data to Ka = 30, against the exact K."""
    data, exact = (
        np.array([x.split(",") for x in (shared_reference / f).read_text().splitlines() if x[:1].isdigit()], dtype=float)
        for f in ("hemisphere_exact.csv", "hemisphere_K.csv")
    )
    omega = np.sqrt(data[:, 0])
    for dof, column, A_inf in (("heave", 1, 0.5), ("surge", 3, 4 / np.pi - 1)):
        h = og.hydro_from_arrays(
            omega=omega,
            added_mass=data[:, column, None, None],
            radiation_damping=(data[:, column + 1] * omega)[:, None, None],
            added_mass_inf=[[A_inf]],
            dofs=(dof,),
        )
        K = og.retardation(h)
        for passive in (True, False):
            model = og.identify(K, method=method, order=6, passive=passive)
            fit = model.impulse(exact[:, 0])[:, :, 0]
            assert r_squared(exact[:, [1 if dof == "heave" else 2], None], fit[:, :, None])[0, 0] > 0.9998
            assert model.is_passive or not passive


@pytest.mark.parametrize("method", PUBLISHED)
def test_shortfall_is_a_warning_that_names_the_coupling(method):
    """Damping and added mass that no causal model fits."""
    rng = np.random.default_rng(5)
    t, omega = np.arange(401) * 0.05, np.linspace(0.1, 3.0, 40)
    noise = og.Retardation(
        t,
        rng.standard_normal((401, 1, 1)),
        np.eye(1),
        ("heave",),
        omega=omega,
        added_mass=1 + rng.standard_normal((40, 1, 1)),
        radiation_damping=rng.uniform(0.1, 1, (40, 1, 1)),
    )
    with pytest.warns(og.OgilvieWarning, match="heave-heave"):
        og.identify(noise, method=method, r2=0.999, max_order=6, passive=False)


@pytest.mark.parametrize("method", PUBLISHED)
def test_order_limit_is_kept_and_said(vessels, method):
    with pytest.warns(og.OgilvieWarning, match="order limit 12 reached"):
        model = og.identify(vessels["tanker"], method=method, max_order=12)
    assert model.order == 12
    assert model.is_passive


@pytest.mark.parametrize("method", ["frequency", "vector"])
def test_too_few_states_for_the_structure_are_refused(vessels, method):
    """K_hat(0) = 0 for three coupled dofs takes six states."""
    with pytest.raises(og.InputError, match="order: 6 is the closest"):
        og.identify(vessels["tanker"], method=method, order=4, passive=False)


def test_more_states_than_poles_have_are_refused():
    with pytest.raises(og.InputError, match="is the closest"):
        og.identify(exact_data(known_model()), method="impulse", order=2 * MOST_POLES + 1, passive=False)


def test_tables_too_short_for_poles_are_refused():
    K = og.Retardation(np.arange(5.0), np.exp(-np.arange(5.0))[:, None, None], np.eye(1), ("heave",))
    with pytest.raises(og.InputError, match="too few samples"):
        og.identify(K, method="impulse", passive=False)


def test_orders_of_passive_models_are_even(vessels):
    for method in PUBLISHED:
        assert og.identify(vessels["tanker"], method=method, order=5).order == 12


def test_motion_aware_fits_keep_the_motion_better(vessels, shared_reference):
    """Heave of the free-floating semisubmersible at its resonance, from the poles of FDI: within 1.5 % with it in the fit."""
    d, K = np.load(shared_reference / "radiation" / "semisub.npz"), vessels["semisub"]
    C = d["stiffness"] + np.diag([d["mass"][0, 0], d["mass"][0, 0], 0, 0, 0, d["mass"][5, 5]]) * 0.003
    omega = K.omega

    def heave(A, B):
        return 1 / (C[2, 2] - omega**2 * (d["mass"][2, 2] + A) + 1j * omega * B)

    exact = heave(K.added_mass[:, 2, 2], K.radiation_damping[:, 2, 2])
    change = []
    for more in ({"mass": d["mass"], "stiffness": C}, {}):
        model = og.identify(K, method="frequency", order=8, **more)
        K_hat = model.transfer(omega)[:, 2, 2]
        fitted = heave(model.A_inf[2, 2] + K_hat.imag / omega, K_hat.real)
        change.append(np.linalg.norm(fitted - exact) / np.linalg.norm(exact))
    assert change[0] < 0.015
    assert change[1] > 3 * change[0]


def test_fractions_of_frequency_domain_fit_and_their_slopes():
    """Partial fractions vanish where they should; their derivatives against central differences."""
    x = _factors(np.array([-0.2 + 0.7j, -0.2 - 0.7j, -0.1, -2.0, -0.5]))
    s, h = 1j * np.linspace(0.1, 1.0, 7), 1e-6
    assert np.allclose(np.sort_complex(_poles(x)), [-2.0, -0.5, -0.2 - 0.7j, -0.2 + 0.7j, -0.1])
    assert np.allclose(_coefficients(x)[0][0], [0.4, 0.53])
    F, slopes = _fractions(x, s)
    for k in range(len(x)):
        step = h * (np.arange(len(x)) == k)
        numeric = (_fractions(x + step, s)[0] - _fractions(x - step, s)[0]) / (2 * h)
        assert np.allclose(slopes[:, :, k], numeric, atol=1e-8 * np.abs(F).max() + 1e-7)


def test_polynomials_of_frequency_domain_fit_are_orthonormal():
    s = 1j * np.linspace(0.02, 1.0, 50)
    phi, _ = _orthonormal(s, 20)
    assert np.allclose((phi.conj().T @ phi).real, np.eye(21), atol=1e-9)


@pytest.mark.parametrize("find", [prony_poles, frequency_poles, vector_poles])
def test_twelve_poles_are_found_exactly(find):
    """Three couplings of random residues over twelve poles, 0.3 to 3.5 rad/s."""
    rng = np.random.default_rng(3)
    up = np.linspace(0.3, 3.5, 6) * np.exp(1j * (np.pi / 2 + rng.uniform(0.05, 0.4, 6)))
    poles = np.concatenate([up, up.conj()])
    A, b = modal(poles)
    one = np.eye(2)
    A, B = np.kron(one, A), np.kron(one, b[:, None])
    C = rng.standard_normal((2, 24))
    C[1, :12] = C[0, 12:]
    zero = np.linalg.solve(A, B)
    C -= np.linalg.lstsq(zero.T, (C @ zero).T, rcond=None)[0].T  # K_hat(0) = 0
    C[1, :12] = C[0, 12:]
    model = og.StateSpace(A, B, C, ("x", "y"))
    K = exact_data(model, A_inf=np.eye(2), n_w=120)
    target = Impulse.of(K, [0, 1]) if find is prony_poles else Spectrum.of(K, [0, 1])
    assert np.abs(np.sort_complex(find(target, 12)) - np.sort_complex(poles)).max() < 1e-4


def test_residues_of_full_rank_need_no_second_look():
    """With the right poles the least-squares outputs are the model."""
    true = known_model()
    target = Spectrum.of(exact_data(true), [0, 1])
    trial, reached = fit_common_poles(target, lambda _, n: true.poles, r2=0.99, order=6, limit=6)
    assert np.nanmin(reached) > 1 - 1e-10
    assert len(trial.A) == 6


def test_poles_are_mirrored_and_damped():
    found = stable(np.array([0.3 + 1j, 0.3 - 1j, -1e-9 + 2j, 4.0]))
    assert np.allclose(found[[0, 1, 3]], [-0.3 + 1j, -0.3 - 1j, -4.0])
    assert np.isclose(found[2].real, -0.02)


def test_oscillators_have_the_poles_they_were_made_from():
    poles = np.array([-0.2 + 0.7j, -0.2 - 0.7j, -0.1, -2.0, -0.4, -0.5])
    w, a = oscillators_of(poles)
    back = np.concatenate([np.roots([1.0, x, y**2]) for x, y in zip(a, w, strict=True)])
    assert np.allclose(np.sort_complex(back), np.sort_complex(poles))
    assert len(oscillators_of(poles[:-1])[0]) == 3


def test_balanced_form_is_balanced():
    model = known_model()
    b = balance(model.A, model.B, model.C)
    s = np.diag(b.singular_values)
    assert np.allclose(b.A @ s + s @ b.A.T, -b.B @ b.B.T, atol=1e-10)
    assert np.allclose(b.A.T @ s + s @ b.A, -b.C.T @ b.C, atol=1e-10)
    same = og.StateSpace(b.A, b.B, b.C, model.dofs)
    assert np.allclose(same.transfer(1.3), model.transfer(1.3))


def test_reduction_keeps_its_error_bound(vessels):
    """Largest singular value of the error over 2000 frequencies against twice the sum of what was left out, for every order."""
    model = og.identify(vessels["tanker"], order=10)
    s = hankel_singular_values(model)
    assert np.all(np.diff(s) <= 0)
    omega = np.geomspace(1e-3, 1e2, 2000)
    K_hat = model.transfer(omega)
    size = np.sqrt(np.abs(np.einsum("wii->wi", K_hat)).max(axis=0))
    for order in range(2, model.order, 3):
        small = reduce(model, order=order)
        assert small.order == order
        assert small.is_stable
        error = np.linalg.norm((small.transfer(omega) - K_hat) / np.outer(size, size), ord=2, axis=(1, 2)).max()
        assert error <= 2 * s[order:].sum() * 1.01
        assert error >= 0.5 * s[order]


def test_reduction_by_tolerance(vessels):
    model = og.identify(vessels["supply"], method="vector", passive=False)
    s = hankel_singular_values(model)
    small = reduce(model, tol=0.05)
    assert small.order < model.order
    assert 2 * s[small.order :].sum() <= 0.05 < 2 * s[small.order - 1 :].sum()
    assert any("balanced truncation" in n for n in small.notes)
    assert small.is_passive is not None
    assert np.array_equal(small.A_inf, model.A_inf)


def test_reduction_drops_states_that_do_nothing():
    true = known_model()
    idle = scipy.linalg.block_diag(true.A, -3.0)
    model = og.StateSpace(idle, np.vstack([true.B, np.zeros((1, 2))]), np.hstack([true.C, np.ones((2, 1))]), true.dofs)
    small = reduce(model, tol=1e-9)
    assert small.order == 6
    assert np.allclose(small.transfer(0.9), true.transfer(0.9))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({}, "one of order and tol"),
        ({"order": 2, "tol": 0.1}, "one of"),
        ({"order": 9}, "between 1 and 6"),
        ({"tol": -1.0}, "tol"),
    ],
)
def test_bad_reductions(change, words):
    with pytest.raises(og.InputError, match=words):
        reduce(known_model(), **change)


def test_unstable_models_are_not_reduced():
    model = known_model()
    with pytest.raises(og.InputError, match="stable"):
        reduce(dataclasses.replace(model, A=-model.A), order=2)
