"""The near field at panel centres, as WAMIT's files have it, and moments about the moving origin."""

import warnings

import numpy as np
import pytest

from ogilvie.body import RigidBody
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.drift import mean_drift
from ogilvie.hydro.drift_inputs import checked_case
from ogilvie.hydro.drift_origin import drift_about_body
from ogilvie.hydro.drift_qtf import difference_qtf
from ogilvie.hydro.drift_solver import Solver
from ogilvie.hydro.drift_wave import Wave
from ogilvie.hydro.files import read_hydro
from ogilvie.hydro.schema import hydro_from_arrays
from ogilvie.mesh import shapes
from ogilvie.mesh.files import load_mesh

RHO, G = 1000.0, 9.81
QUIET = {"cache": False, "progress": False, "workers": 1, "rho": RHO, "g": G}


def afloat(hull):
    return RigidBody.from_hull(hull, gyradii=(0.5, 0.5, 0.6), zg=-0.2, rho=RHO)


def test_near_field_at_panel_centres_is_wamits_pressure_integration(shared_data):
    """On its own panels, on both sides of the first irregular frequency (Ka = 2.56), which WAMIT did not remove."""
    wamit = read_hydro(shared_data / "wecsim_sphere_drift/sphere.1")
    M = wamit.inertia_matrix.values
    pick = [i for i, w in enumerate(wamit.omega.values) if 1.0 < w < 6.0 and abs(w - 5.01) > 0.06][::4]
    keys = {
        "omega": wamit.omega.values[pick],
        "wave_direction": [0.0],
        "rotation": "XYZ",
        "irregular_frequencies": "keep",
        **{**QUIET, "rho": wamit.attrs["rho"], "g": wamit.attrs["g"]},
    }
    hull = load_mesh(shared_data / "wecsim_sphere_drift/sphere.GDF")
    body = RigidBody(M[0, 0], [0.0, 0.0, 0.0], np.diag(M)[3:])
    with pytest.warns(OgilvieWarning, match="near field against far field"):
        drift = mean_drift(hull, body, waterline="centre", method="near", **keys)
    edge = mean_drift(hull, body, method="far", **keys)
    for i in (0, 2):
        theirs = wamit.mean_drift_pressure.values[pick, 0, i]
        scale = np.abs(theirs).max()
        np.testing.assert_allclose(drift.mean_drift[:, 0, i], theirs, atol=0.03 * scale)
        assert np.abs(edge.mean_drift_pressure.values[:, 0, i] - theirs).max() > 0.3 * scale  # theirs is far from converged
    np.testing.assert_array_equal(drift.mean_drift_momentum, edge.mean_drift_momentum)  # only the near field changes
    pairs = difference_qtf(hull, body, waterline="centre", method="near", **{**keys, "omega": keys["omega"][8:11]})
    np.testing.assert_allclose(
        np.einsum("wwbi->wbi", pairs.qtf_diff.values), drift.mean_drift[8:11], rtol=1e-9, atol=1e-9 * scale
    )


def test_near_field_at_panel_centres_tends_to_that_at_the_edges():
    keys = {"omega": [3.5], "wave_direction": [0.0], "method": "near", **QUIET}
    apart = []
    for panels in (100, 400, 1600):
        hull = shapes.hemisphere(1.0, panels=panels)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", OgilvieWarning)
            centre, edge = (mean_drift(hull, afloat(hull), waterline=rule, **keys).mean_drift for rule in ("centre", "edge"))
        apart.append(np.abs((centre - edge).values[0, 0, [0, 2]]).max() / np.abs(edge.values).max())
    assert apart[1] < 0.65 * apart[0]
    assert apart[2] < 0.65 * apart[1]


@pytest.mark.parametrize("irregular", ["keep", "remove"])
def test_both_ways_of_solving_tend_to_one_potential(irregular):
    """Green's theorem for the whole diffraction potential, lid or none, against sources on the hull."""
    apart = []
    for panels in (200, 800):
        hull = shapes.box(2.0, 1.5, 0.8, panels=panels)
        case = checked_case(hull, irregular, purpose="test", omega=[2.2], direction=[0.4], rho=RHO, g=G, depth=np.inf)
        assert (case.panels.n_lid > 0) == (irregular == "remove")
        solver, wave = Solver(case, cache=False, workers=1), Wave(2.2, float(case.k[0]), case.direction, np.inf, RHO, G)
        one, two = solver.at_hull(wave).potential, solver.at_hull(wave, centres=True).potential
        weight = case.panels.hull.areas
        difference, size = (np.sqrt((np.abs(phi) ** 2 @ weight).sum(axis=1)) for phi in (two - one, one))
        apart.append(difference / size)
    assert np.all(apart[1] < 0.05)
    assert np.all(apart[1] < 0.5 * apart[0])


# --- moments about the moving origin


def test_negative_modes_follow_from_the_positive_ones(shared_data):
    wamit = read_hydro(shared_data / "mss_wamit_fpso/fpso.1")
    found, theirs = drift_about_body(wamit, "mean_drift_pressure").values, wamit.mean_drift_pressure_body.values
    about_mean = wamit.mean_drift_pressure.values
    np.testing.assert_array_equal(found[..., :3], theirs[..., :3])
    for i in (3, 4, 5):
        np.testing.assert_allclose(found[..., i], theirs[..., i], atol=0.01 * np.abs(theirs[..., i]).max())
    regular = wamit.omega.values < 0.75  # beyond, their first-order forces are those of irregular frequencies
    for i in (3, 5):
        shift, own = (about_mean - values for values in (theirs, found))
        size = np.abs(shift[regular, :, i]).max()
        np.testing.assert_allclose(own[regular, :, i], shift[regular, :, i], atol=0.015 * size)
        assert size > 0.01 * np.abs(about_mean[..., i]).max()


def test_own_moments_about_the_moving_origin_are_those_of_the_near_field():
    hull = shapes.box(2.0, 1.5, 0.8, panels=200)
    body = afloat(hull)
    damping = np.diag([0.0, 0.0, 200.0, 30.0, 0.0, 0.0])
    stiffness = np.diag([500.0, 0.0, 0.0, 0.0, 0.0, 20.0])
    keys = {"omega": [2.2, 2.8], "wave_direction": [0.4, 2.0], "damping": damping, "stiffness": stiffness, **QUIET}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OgilvieWarning)
        drift = mean_drift(hull, body, method="near", **keys)
        again = mean_drift(hull, body, method="near", moments="body", waterline="centre", **keys)
    zeros = np.zeros((2, 6, 6))
    hydro = hydro_from_arrays(
        omega=drift.omega,
        added_mass=zeros,
        radiation_damping=zeros,
        wave_direction=drift.wave_direction,
        motion_rao=drift.motion_rao.values,
        inertia_matrix=body.matrix,
        external_damping=damping,
        external_stiffness=stiffness,
        rho=RHO,
        g=G,
    ).assign(mean_drift_pressure=drift.mean_drift_pressure)
    found = drift_about_body(hydro, "mean_drift_pressure")
    np.testing.assert_allclose(found, drift.mean_drift_pressure_body, rtol=1e-9, atol=1e-6)
    assert np.abs(found.values - drift.mean_drift_pressure.values)[..., 3:].max() > 10.0
    np.testing.assert_array_equal(again.mean_drift, again.mean_drift_pressure_body)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda hydro: hydro.drop_vars("mean_drift"), "mean_drift expected"),
        (lambda hydro: hydro.drop_vars("inertia_matrix"), "inertia_matrix expected"),
        (lambda hydro: hydro.isel(influenced_dof=[0, 2, 4], radiating_dof=[0, 2, 4]), "sway.* expected"),
    ],
)
def test_what_a_change_of_origin_needs(change, words):
    A = np.ones((2, 6, 6))
    hydro = hydro_from_arrays(
        omega=[0.5, 1.0],
        added_mass=A,
        radiation_damping=A,
        wave_direction=[0.0],
        motion_rao=np.zeros((2, 1, 6)),
        mean_drift=np.zeros((2, 1, 6)),
        inertia_matrix=np.eye(6),
    )
    with pytest.raises(InputError, match=words):
        drift_about_body(change(hydro))


def test_no_centres_at_speed():
    with pytest.raises(InputError, match="waterline: 'edge' expected at speed"):
        mean_drift(shapes.hemisphere(1.0, panels=60), omega=[3.0], speed=1.0, waterline="centre", **QUIET)
