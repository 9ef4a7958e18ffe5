"""A vessel whose radiation data, retardation functions and state-space model are one and the same thing, exactly."""

from types import SimpleNamespace

import numpy as np
import pytest

import ogilvie as og

BLOCKS = ([0, 2, 4], [1, 3, 5])  # surge-heave-pitch and sway-roll-yaw do not interact
A_INF = np.diag([3e5, 4e6, 6e6, 1.5e8, 2.5e9, 2e9])
STIFFNESS = np.diag([0.0, 0.0, 8e6, 1.6e8, 4e9, 0.0])
SPRINGS = np.diag([3.2e4, 4e4, 0.0, 0.0, 0.0, 1.6e7])
DAMPING = np.diag([3e4, 4e4, 0.0, 3e7, 0.0, 3e7])


def oscillator_memory() -> og.StateSpace:
    """K_hat = s b^T (s^2 + s D + W^2)^-1 b: passive, reciprocal, zero at s = 0."""
    scale = np.sqrt([4e5, 3e6, 5e6, 4e7, 2.5e9, 1.2e9])
    A, B = np.zeros((24, 24)), np.zeros((24, 6))
    for k, dofs in enumerate(BLOCKS):
        q, p = np.arange(12 * k, 12 * k + 6), np.arange(12 * k + 6, 12 * k + 12)
        W = np.linspace(0.5, 1.8, 6)
        A[q, p] = 1.0
        A[p, q] = -(W**2)
        A[p, p] = -np.linspace(0.5, 0.9, 6)
        mix = np.cos(np.outer(np.arange(6), [1.0, 1.7, 2.3]) + k)
        B[np.ix_(p, dofs)] = mix * scale[dofs]
    return og.StateSpace(A, B, B.T, A_inf=A_INF)


def wave_force(omega, direction):
    """A smooth force with the symmetry of a hull that is its own mirror image, (n_w, n_b, 6)."""
    w, b = np.asarray(omega)[:, None], np.asarray(direction)[None, :]
    c, s = np.cos(b), np.sin(b)
    size = np.exp(-(w**2)) * np.exp(0.4j * w * c)
    return np.stack(
        [
            1j * c * 8e5 * w**2 * size,
            1j * s * 3e6 * w**2 * size,
            8e6 * size * np.exp(-(w**2) * c**2),
            1j * s * 2e7 * w**2 * size,
            1j * c * 3e8 * w * size,
            s * c * 4e7 * w**2 * size,
        ],
        axis=-1,
    )


@pytest.fixture(scope="session")
def barge() -> SimpleNamespace:
    """Body, model, hydro, K, the loads but for radiation, and ready vessels `ship`, `ship_convolution`."""
    body = og.RigidBody(mass=1e7, cog=[0.5, 0.0, 1.0], inertia=np.diag([4e8, 7e9, 7e9]))
    model = oscillator_memory()
    omega = np.linspace(0.05, 3.0, 60)
    direction = np.radians(np.arange(0, 181, 15))
    H = model.transfer(omega)
    hydro = og.hydro_from_arrays(
        omega=omega,
        added_mass=A_INF + H.imag / omega[:, None, None],
        radiation_damping=H.real,
        added_mass_inf=A_INF,
        wave_direction=direction,
        excitation_force=wave_force(omega, direction),
        hydrostatic_stiffness=STIFFNESS,
    )
    t = np.arange(0.0, 60.0, 0.05)
    K = og.Retardation(t, model.impulse(t), A_INF)
    others = (og.LinearRestoring(hydro), og.LinearMooring(SPRINGS), og.LinearDamping(DAMPING), og.WaveExcitation(hydro))
    return SimpleNamespace(
        body=body,
        model=model,
        hydro=hydro,
        K=K,
        others=others,
        ship=og.Vessel(body, loads=(*others, og.StateSpaceRadiation(model))),
        ship_convolution=og.Vessel(body, loads=(*others, og.Convolution(K))),
    )


@pytest.fixture(scope="session")
def seas() -> SimpleNamespace:
    """An irregular sea and three realisations of another."""
    spectrum = og.jonswap(hs=2.0, tp=8.0, gamma=3.3)
    options = {"direction": np.radians(130.0), "n": 40, "omega_range": (0.4, 2.0)}
    return SimpleNamespace(
        one=og.irregular(spectrum, seed=7, **options), three=og.irregular(spectrum, seed=range(3), **options)
    )
