"""Data that cannot be identified: a clear refusal, or a note that names the coupling and by how much."""

import numpy as np
import pytest

import ogilvie as og

T = np.arange(0.0, 20.0, 0.05)
K_T = (np.exp(-0.4 * T) * (np.cos(T) - 0.4 * np.sin(T)))[:, None, None]
OMEGA = np.linspace(0.05, 4.0, 80)
K_HAT = 1j * OMEGA / ((1j * OMEGA + 0.4) ** 2 + 1)
A, B = (2 + K_HAT.imag / OMEGA)[:, None, None], K_HAT.real[:, None, None]


def table(**data):
    return og.Retardation(T, K_T, 2 * np.eye(1), ("heave",), **data)


def spectrum(**change):
    return table(**({"omega": OMEGA, "added_mass": A, "radiation_damping": B} | change))


@pytest.mark.parametrize(
    ("t", "K", "words"),
    [
        (T, np.where(T[:, None, None] == T[3], np.nan, K_T), "finite"),
        (np.where(T[5] == T, T[5] + 0.01, T), K_T, "uniform"),
        (np.where(T[4] == T, np.nan, T), K_T, "uniform"),
        (T[::-1], K_T, "uniform"),
        (T, K_T[:, 0], "expected"),
    ],
)
def test_tables_that_are_none(t, K, words):
    with pytest.raises(og.InputError, match=words):
        og.Retardation(t, K, np.eye(1), ("heave",))


@pytest.mark.parametrize("method", ["oscillators", "realization", "impulse", "frequency", "vector"])
@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"omega": OMEGA[:1], "added_mass": A[:1], "radiation_damping": B[:1]}, "4 frequencies"),
        ({"mask": np.zeros(80, dtype=bool)}, "4 frequencies"),
        ({"omega": OMEGA[::-1]}, "ascending"),
        ({"omega": OMEGA - OMEGA[0]}, "positive"),
        ({"added_mass": A * np.nan}, "finite"),
        ({"radiation_damping": np.where(OMEGA[:, None, None] < 1, np.inf, B)}, "finite"),
        ({"radiation_damping": 0 * B}, "zero"),
        ({"added_mass": A[:5]}, "expected"),
        ({"mask": np.ones(3, dtype=bool)}, "expected"),
    ],
)
def test_spectra_that_cannot_be_fitted(method, change, words):
    with pytest.raises(og.InputError, match=words):
        og.identify(spectrum(**change), method=method, order=4)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"r2": "high"}, "number"),
        ({"order": 2.5}, "whole"),
        ({"mass": np.eye(1) * np.nan, "stiffness": np.eye(1)}, "finite"),
        ({"mass": np.eye(1)}, "both"),
    ],
)
def test_arguments_that_are_none(change, words):
    with pytest.raises(og.InputError, match=words):
        og.identify(spectrum(), **change)


def test_something_else_than_retardation_functions():
    with pytest.raises(og.InputError, match="retardation"):
        og.identify(3)


def test_damaged_frequencies_may_hold_anything_if_masked():
    mask = np.arange(80) != 7
    broken = np.where(mask[:, None, None], A, np.nan)
    assert og.identify(spectrum(added_mass=broken, mask=mask), order=2).r2_damping[0, 0] > 0.999


def test_silent_degrees_of_freedom_take_no_states():
    """Couplings that are zero, and a yaw of rounding beside a roll that is none."""
    omega, size = OMEGA, np.array([1.0, 1.0, 1e-24])
    a, b = (np.einsum("w,ij->wij", x[:, 0, 0], np.diag(size)) for x in (A - 2, B))
    rng = np.random.default_rng(3)
    b[:, 2, 2] *= rng.uniform(0, 1, 80)
    h = og.hydro_from_arrays(omega=omega, added_mass=a + 2 * np.eye(3), radiation_damping=b, dofs=("heave", "roll", "yaw"))
    model = og.identify(og.retardation(h), mass=np.eye(3), stiffness=np.eye(3))
    assert model.order == 4
    assert not np.any(model.B[:, 2])
    assert np.isnan(model.r2_damping[2]).all()
    assert np.isnan(model.r2_damping[0, 1])


@pytest.mark.filterwarnings("ignore::ogilvie.errors.OgilvieWarning")
def test_data_that_no_causal_model_fits_are_named():
    h = og.hydro_from_arrays(
        omega=OMEGA,
        added_mass=A + 0.5 * np.sin(3 * OMEGA)[:, None, None],
        radiation_damping=B,
        added_mass_inf=[[2.0]],
        dofs=("heave",),
    )
    with pytest.warns(og.OgilvieWarning, match=r"heave-heave: R2 stays at"):
        model = og.identify(og.retardation(h))
    assert model.is_passive
    assert any("contradict each other" in note and "heave" in note and "%" in note for note in model.notes)
