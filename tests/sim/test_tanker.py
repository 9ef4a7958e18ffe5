"""A real tanker in an irregular sea: time domain against frequency domain, all six degrees of freedom, dt 0.1 s."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import ogilvie as og
from ogilvie.frames import skew

PERIOD = 120.0  # s, natural period of surge, sway and yaw on soft springs


def rigid_body(M):
    """The body of a (6, 6) mass matrix; the source's yaw inertia is 1 % more than a body with its other inertias can have."""
    S = M[3:, :3] / M[0, 0]
    cog = np.array([S[2, 1], S[0, 2], S[1, 0]])
    inertia = M[3:, 3:] - M[0, 0] * skew(cog).T @ skew(cog)
    inertia[2, 2] = min(inertia[2, 2], inertia[0, 0] + inertia[1, 1])
    return og.RigidBody(M[0, 0], cog, (inertia + inertia.T) / 2)


@pytest.fixture(scope="module")
def tanker(shared_data, shared_reference):
    given = np.load(shared_reference / "radiation" / "tanker.npz")
    hydro = og.read_hydro(shared_data / "mss_wamit_tanker" / "tanker.1")
    body = rigid_body(given["mass"])
    A_inf = hydro.added_mass_inf.values
    springs = np.diag([1.0, 1.0, 0, 0, 0, 1.0]) * (body.matrix + A_inf) * (2 * np.pi / PERIOD) ** 2
    others = (
        og.LinearRestoring(given["stiffness"]),
        og.LinearMooring(springs),
        og.LinearDamping(given["extra_damping"]),
        og.WaveExcitation(hydro),
    )
    sea = og.irregular(og.jonswap(hs=4.0, tp=10.0, gamma=3.3), direction=np.radians(135.0), n=200, seed=11)
    return SimpleNamespace(hydro=hydro, body=body, others=others, sea=sea, K=og.retardation(hydro))


def component_sum(tanker, added_mass, damping, t):
    """The frequency domain with added mass and damping (n, 6, 6) at the components' frequencies, written out."""
    w = tanker.sea.omega
    C = tanker.others[0].stiffness + tanker.others[1].stiffness
    Z = (
        -(w[:, None, None] ** 2) * (tanker.body.matrix + added_mass)
        + 1j * w[:, None, None] * (damping + tanker.others[2].matrix)
        + C
    )
    X = np.linalg.solve(Z, tanker.others[3].force(w, tanker.sea.direction)[..., None])[..., 0]
    return (tanker.sea.complex_amplitude * np.exp(1j * np.outer(t, w)) @ X).real


def of_transfer(A_inf, H, w):
    return A_inf + H.imag / w[:, None, None], H.real


def relative(difference, reference):
    return np.sqrt(np.mean(difference**2, axis=0) / np.mean(reference**2, axis=0))


def raw(tanker, t):
    """The frequency domain with the data's own A(w), B(w), by cubic splines between its frequencies."""
    w, data = tanker.sea.omega, tanker.hydro.omega.values
    A, B = (CubicSpline(data, tanker.hydro[key].values)(w) for key in ("added_mass", "radiation_damping"))
    return component_sum(tanker, A, B, t)


@pytest.mark.filterwarnings("ignore::ogilvie.errors.OgilvieWarning")
def test_identified_model(tanker):
    ssm = og.identify(tanker.K, mass=tanker.body.matrix, stiffness=tanker.hydro.hydrostatic_stiffness.values)
    run = og.simulate(og.Vessel(tanker.body, loads=(*tanker.others, og.StateSpaceRadiation(ssm))), tanker.sea, duration=3600.0)
    t, w = run.time.values, tanker.sea.omega
    own = component_sum(tanker, *of_transfer(ssm.A_inf, ssm.transfer(w), w), t)
    assert relative(run.eta.values - own, own).max() < 1e-5
    data = raw(tanker, t)  # what the fit costs when it knows the motion
    assert relative(run.eta.values - data, data).max() < 0.02


def test_convolution(tanker):
    vessel = og.Vessel(tanker.body, loads=(*tanker.others, og.Convolution(tanker.K)))
    run = og.simulate(vessel, tanker.sea, duration=3600.0)
    t, w = run.time.values, tanker.sea.omega
    own = component_sum(tanker, *of_transfer(tanker.K.A_inf, tanker.K.transform(w), w), t)
    assert relative(run.eta.values - own, own).max() < 1e-4
    data = raw(tanker, t)  # 0.2 to 0.9 % away: added mass and damping of the data contradict each other by that much
    assert relative(run.eta.values - data, data).max() < 0.015


@pytest.mark.filterwarnings("ignore::ogilvie.errors.OgilvieWarning")
def test_grown_from_rest_it_ends_in_the_same_motion(tanker):
    """Without the steady start: a ramp, then time for the springs' slow transient to die out."""
    ssm = og.identify(tanker.K, r2=0.99)
    vessel = og.Vessel(tanker.body, loads=(*tanker.others, og.StateSpaceRadiation(ssm)))
    run = og.simulate(vessel, tanker.sea, duration=6000.0, ramp=600.0, variables=["eta"])
    last = run.eta.sel(time=slice(5000.0, None))
    w = tanker.sea.omega
    own = component_sum(tanker, *of_transfer(ssm.A_inf, ssm.transfer(w), w), last.time.values)
    assert relative(last.values - own, own).max() < 1e-3
