"""The contract of the data set: what the constructor orders and refuses."""

import numpy as np
import pytest
import xarray as xr

from ogilvie.errors import InputError
from ogilvie.frames import about_origin, shift_matrix
from ogilvie.hydro.reference import moved_to_origin
from ogilvie.hydro.schema import DOFS, VARIABLES, hydro_from_arrays, validate

W = np.array([0.5, 1.0, 1.5])
RNG = np.random.default_rng(0)
A = RNG.normal(size=(3, 6, 6))
F = RNG.normal(size=(3, 2, 6)) + 1j * RNG.normal(size=(3, 2, 6))


def make(**changes) -> xr.Dataset:
    given = {"omega": W, "added_mass": A, "radiation_damping": 2 * A, "wave_direction": [0.0, 1.0], "excitation_force": F}
    return hydro_from_arrays(**(given | changes))


def test_frequencies_and_directions_are_sorted_with_their_values():
    mixed, b = [2, 0, 1], [1, 0]
    h = make(
        omega=W[mixed],
        added_mass=A[mixed],
        radiation_damping=2 * A[mixed],
        wave_direction=[1.0, 0.0],
        excitation_force=F[mixed][:, b],
    )
    xr.testing.assert_identical(h, make())


def test_excitation_is_the_sum_of_its_parts():
    h = make(excitation_force=None, froude_krylov_force=0.3 * F, diffraction_force=0.7 * F)
    np.testing.assert_allclose(h.excitation_force, F)
    h = make(froude_krylov_force=0.3 * F, diffraction_force=0.5 * F)  # a given total is kept; hydro.checks compares
    np.testing.assert_allclose(h.excitation_force, F)


def test_every_dof_count_and_the_meta_data():
    h = hydro_from_arrays(
        omega=[1.0], added_mass=[[[2.0]]], radiation_damping=[[[1.0]]], dofs=("heave",), g=9.7, attrs={"x": 1}
    )
    assert h.influenced_dof.values.tolist() == h.radiating_dof.values.tolist() == ["heave"]
    assert (h.attrs["g"], h.attrs["x"], h.attrs["time_convention"], h.attrs["water_depth"]) == (9.7, 1, "exp(+iwt)", np.inf)
    assert tuple(make().influenced_dof.values) == DOFS


def test_the_input_is_not_changed_and_not_shared():
    own = A.copy()
    h = make(added_mass=own)
    own[:] = 0.0
    np.testing.assert_array_equal(h.added_mass, A)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"added_mass": A[:2]},
            r"added_mass: shape \(3, 6, 6\) = \(omega, influenced_dof, radiating_dof\) expected, \(2, 6, 6\)",
        ),
        ({"excitation_force": F[:, :1]}, r"excitation_force: shape \(3, 2, 6\)"),
        ({"wave_direction": None}, "wave_direction: needed with wave forces"),
        ({"added_mass": A * np.nan}, "added_mass: finite numbers expected, 108 NaN or infinite found"),
        ({"omega": [0.0, 1.0, 2.0]}, "omega: positive, ascending, distinct"),
        ({"omega": [1.0, 1.0, 2.0]}, "omega: positive, ascending, distinct"),
        ({"omega": [1.0, np.inf, 2.0]}, "omega: positive, ascending, distinct"),
        ({"omega": [1.0, np.nan, 2.0]}, "omega: positive, ascending, distinct"),
        ({"omega": [[1.0, 2.0, 3.0]]}, "omega: a list of numbers expected"),
        ({"wave_direction": [0.0, 0.0]}, "wave_direction: distinct directions"),
        ({"wave_direction": [0.0, 180.0]}, r"wave_direction: rad expected, 0..180 found; degrees\?"),
        ({"rho": 0.0}, "attribute rho: positive number expected, 0.0 found"),
        ({"g": np.nan}, "attribute g: positive number expected"),
        ({"water_depth": -1.0}, "attribute water_depth: positive number expected"),
        ({"dofs": (*DOFS[:5], "pitch")}, "dofs: one list of distinct names"),
        ({"attrs": {"time_convention": "exp(-iwt)"}}, r"time_convention: 'exp\(\+iwt\)' expected"),
    ],
)
def test_mistakes_are_named(changes, message):
    with pytest.raises(InputError, match=message):
        make(**changes)


def test_all_mistakes_are_named_at_once():
    bad = make().assign_attrs(rho=-1.0, g="much").drop_vars("radiation_damping")
    bad = bad.assign(excitation_force=bad.excitation_force.transpose("wave_direction", ...), inertia_matrix=("omega", W))
    with pytest.raises(InputError) as error:
        validate(bad)
    for word in ("rho", "attribute g", "radiation_damping: expected", "excitation_force: dims", "inertia_matrix: dims"):
        assert word in str(error.value)


def test_kinds_of_numbers():
    with pytest.raises(InputError, match="added_mass: real numbers expected, complex128 found"):
        validate(make().assign(added_mass=make().added_mass * 1j))
    with pytest.raises(InputError, match="added_mass: real numbers expected, <U"):
        validate(make().assign(added_mass=make().added_mass.astype(str)))


def test_nan_only_where_a_method_gives_nothing():
    drift = np.full((3, 2, 6), np.nan)
    drift[..., [0, 1, 5]] = 1.0
    h = make(mean_drift=drift)
    assert np.isnan(h.mean_drift.values).sum() == 18
    with pytest.raises(InputError, match="mean_drift: finite numbers expected, 18"):
        make(mean_drift=drift * 0 + np.inf)
    with pytest.raises(InputError, match="mean_drift_pressure: finite"):
        validate(h.assign(mean_drift_pressure=h.mean_drift))


def test_every_variable_has_its_last_dimension_a_dof():
    for dims, _ in VARIABLES.values():
        assert dims[-1] in ("influenced_dof", "radiating_dof")


# --- change of the reference point ---


def test_moving_to_the_origin_keeps_work_and_power():
    """Forces times velocities, and the power of matrices, do not depend on the point they are written for."""
    p = np.array([3.0, -2.0, -5.0])
    C = RNG.normal(size=(6, 6))
    h = make(hydrostatic_stiffness=C, inertia_matrix=C @ C.T, motion_rao=F.conj(), mean_drift=F.real)
    moved = moved_to_origin(h, p)
    nu = RNG.normal(size=6)
    at_p = shift_matrix(p) @ nu
    for key in ("excitation_force", "mean_drift"):
        np.testing.assert_allclose(moved[key].values @ nu, h[key].values @ at_p)
    for key in ("added_mass", "radiation_damping", "hydrostatic_stiffness", "inertia_matrix"):
        np.testing.assert_allclose(nu @ moved[key].values @ nu, at_p @ h[key].values @ at_p)
    np.testing.assert_allclose(moved.motion_rao.values @ shift_matrix(p).T, h.motion_rao.values)
    np.testing.assert_allclose(moved.added_mass[0], about_origin(A[0], p))


def test_moving_spreads_nan_no_further_than_it_must():
    """Far-field drift: yaw moves with the known surge and sway; roll stays unknown."""
    drift = np.full((3, 2, 6), np.nan)
    drift[..., [0, 1, 5]] = [1.0, 2.0, 3.0]
    moved = moved_to_origin(make(mean_drift=drift), [10.0, 4.0, -1.0]).mean_drift.values
    np.testing.assert_allclose(moved[0, 0, [0, 1, 5]], [1.0, 2.0, 3.0 + 10.0 * 2.0 - 4.0 * 1.0])
    assert np.isnan(moved[..., 2:5]).all()


def test_moving_needs_all_dofs_and_drops_what_it_cannot_move():
    h = make()
    assert moved_to_origin(h, [0.0, 0.0, 0.0]) is h
    body = h.assign(mean_drift_pressure_body=h.excitation_force.real)
    assert "mean_drift_pressure_body" not in moved_to_origin(body, [0.0, 0.0, 1.0])
    with pytest.raises(InputError, match="all six dofs expected"):
        moved_to_origin(h.isel(influenced_dof=[2], radiating_dof=[2]), [0.0, 0.0, 1.0])
