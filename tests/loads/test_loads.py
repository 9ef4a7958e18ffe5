"""Restoring, mooring, damping and radiation: the arrays they hand on, and what they refuse."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.loads.base import Load, Surroundings, embed

BODY = og.RigidBody(mass=1.0, cog=[0, 0, 0], inertia=np.eye(3))
AROUND = Surroundings(BODY)
HEAVE_PITCH = ("heave", "pitch")


def small_hydro(**more):
    w = np.linspace(0.2, 2.0, 5)
    Z = np.zeros((5, 2, 2))
    return og.hydro_from_arrays(omega=w, added_mass=Z, radiation_damping=Z, dofs=HEAVE_PITCH, **more)


def small_model(**more):
    return og.StateSpace([[-1.0]], [[1.0, 2.0]], [[3.0], [4.0]], dofs=HEAVE_PITCH, **more)


def test_restoring_from_data_and_matrix():
    C = np.array([[2.0, 0.5], [0.5, 3.0]])
    from_data = og.LinearRestoring(small_hydro(hydrostatic_stiffness=C)).bind(AROUND).stiffness
    assert from_data[np.ix_([2, 4], [2, 4])] == pytest.approx(C)
    assert np.count_nonzero(from_data) == 4
    full = np.arange(36.0).reshape(6, 6)
    assert og.LinearRestoring(full).bind(AROUND).stiffness == pytest.approx(full)


def test_mooring_and_damping_hand_on_their_matrices():
    K, F = np.diag(np.arange(6.0)), np.arange(6.0)
    terms = og.LinearMooring(K, pretension=F).bind(AROUND)
    assert np.array_equal(terms.stiffness, K)
    assert np.array_equal(terms.constant, F)
    assert np.array_equal(og.LinearDamping(K).bind(AROUND).damping, K)
    assert og.LinearDamping(ratio={"pitch": 0.1, "roll": 0.05}).bind(AROUND).damping_ratio.tolist() == [0, 0, 0, 0.05, 0.1, 0]


def test_radiation_is_placed_in_six_degrees_of_freedom():
    terms = og.StateSpaceRadiation(small_model(A_inf=[[5.0, 1.0], [1.0, 6.0]])).bind(AROUND)
    assert terms.memory.B.tolist() == [[0, 0, 1, 0, 2, 0]]
    assert terms.memory.C[:, 0].tolist() == [0, 0, 3, 0, 4, 0]
    assert terms.added_mass[2, 4] == 1.0
    t = np.arange(0, 5, 0.1)
    K = og.Retardation(t, np.exp(-t)[:, None, None] * np.eye(2), 7 * np.eye(2), dofs=HEAVE_PITCH)
    terms = og.Convolution(K).bind(AROUND)
    assert terms.memory.K[:, 4, 4] == pytest.approx(np.exp(-t))
    assert np.count_nonzero(terms.memory.K[0]) == 2
    assert og.Convolution(K, truncation=2.0).bind(AROUND).memory.t[-1] == pytest.approx(2.0)


def test_added_mass_may_be_given_instead_of_the_models():
    other = og.StateSpaceRadiation(small_model(A_inf=np.eye(2)), added_mass=9 * np.eye(2))
    assert other.bind(AROUND).added_mass[2, 2] == 9.0


def test_every_load_obeys_the_protocol():
    K = og.Retardation(np.arange(5.0), np.ones((5, 2, 2)), np.eye(2), dofs=HEAVE_PITCH)
    loads = [
        og.LinearRestoring(np.eye(6)),
        og.LinearMooring(np.eye(6)),
        og.LinearDamping(np.eye(6)),
        og.StateSpaceRadiation(small_model(A_inf=np.eye(2))),
        og.Convolution(K),
    ]
    for load in loads:
        assert isinstance(load, Load)
        assert load.covers
    assert [load.name for load in loads] == ["restoring", "mooring", "damping", "radiation", "radiation"]


def test_loads_cannot_be_changed():
    load = og.LinearMooring(np.eye(6))
    with pytest.raises(AttributeError):
        load.stiffness = np.zeros((6, 6))
    with pytest.raises(ValueError):
        load.stiffness[0, 0] = 2.0


def test_damping_covers_the_degrees_of_freedom_that_it_damps():
    assert og.LinearDamping(np.diag([1.0, 0, 0, 2.0, 0, 0])).covers == {"viscous damping of surge", "viscous damping of roll"}
    assert og.LinearDamping(np.zeros((6, 6))).covers == frozenset()


def test_embed_keeps_full_arrays():
    full = np.arange(36.0).reshape(6, 6)
    assert np.array_equal(embed(full, ("surge", "sway", "heave", "roll", "pitch", "yaw"), (0, 1)), full)


BAD = {
    "restoring shape": (lambda: og.LinearRestoring(np.eye(3)), "shape"),
    "restoring NaN": (lambda: og.LinearRestoring(np.full((6, 6), np.nan)), "36 NaN"),
    "restoring absent": (lambda: og.LinearRestoring(small_hydro()), "hydrostatic_stiffness expected"),
    "mooring text": (lambda: og.LinearMooring("stiff"), r"numbers of shape \(6, 6\) expected, str found"),
    "pretension": (lambda: og.LinearMooring(np.eye(6), pretension=[1.0]), "pretension: shape"),
    "damping none": (lambda: og.LinearDamping(), "exactly one of matrix"),
    "damping both": (lambda: og.LinearDamping(np.eye(6), ratio={"roll": 0.1}), "exactly one of matrix"),
    "damping dof": (lambda: og.LinearDamping(ratio={"rol": 0.1}), "names out of surge, .* expected, rol found"),
    "damping sign": (lambda: og.LinearDamping(ratio={"roll": -0.1}), "ratios >= 0 expected, -0.1 found for roll"),
    "no added mass": (lambda: og.StateSpaceRadiation(small_model()), "Give added_mass="),
    "added mass shape": (lambda: og.StateSpaceRadiation(small_model(), added_mass=np.eye(6)), r"\(2, 2\) matrix"),
    "unstable": (
        lambda: og.StateSpaceRadiation(og.StateSpace([[0.1]], [[1.0]], [[1.0]], dofs=("heave",)), added_mass=[[1.0]]),
        r"a pole with real part \+0.1",
    ),
    "not a model": (lambda: og.StateSpaceRadiation(np.eye(3), added_mass=np.eye(6)), "a StateSpace .* expected, ndarray found"),
    "not K": (lambda: og.Convolution(np.eye(3)), "a Retardation .* expected, ndarray found"),
    "truncation": (
        lambda: og.Convolution(og.Retardation(np.arange(5.0), np.ones((5, 2, 2)), np.eye(2), dofs=HEAVE_PITCH), truncation=9.0),
        r"truncation in \(0, 4\] s",
    ),
    "unknown dof": (
        lambda: og.StateSpaceRadiation(og.StateSpace([[-1.0]], [[1.0]], [[1.0]], dofs=("flap",)), added_mass=[[1.0]]),
        "names out of surge, .* expected, flap found",
    ),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_input(what):
    make, message = BAD[what]
    with pytest.raises(og.InputError, match=message):
        make()
