"""The wave force from a record of the elevation equals the sum over its components."""

import numpy as np
import pytest

import ogilvie as og
from ogilvie.memory.excitation_kernel import excitation_kernel

C = np.array([[0.0, 0.0], [0.0, 1.0]])


def _hydro(n=200, top=6.0, **more):
    """Two dofs with known kernels: exp(-(t - s)^2/4)/(2 sqrt pi), and its rate."""
    w = np.linspace(top / n, top, n)
    X = np.exp(-(w**2)) * np.exp(-1.5j * w)
    X = np.stack([1j * w * X, X], axis=1)[:, None, :]
    zero = np.zeros((n, 2, 2))
    return og.hydro_from_arrays(
        omega=w,
        added_mass=zero,
        radiation_damping=zero,
        wave_direction=[0.5],
        excitation_force=X,
        dofs=("surge", "heave"),
        **more,
    )


def _exact(t):
    heave = np.exp(-((t - 1.5) ** 2) / 4.0) / (2.0 * np.sqrt(np.pi))
    return np.stack([-(t - 1.5) / 2.0 * heave, heave], axis=1)


def test_known_kernels():
    k = excitation_kernel(_hydro(hydrostatic_stiffness=C), dt=0.05, duration=20.0)
    assert np.abs(k.kernel[:, 0] - _exact(k.t)).max() < 1e-6
    assert np.all(k.truncation_error < 1e-6)


def test_the_default_length_leaves_out_what_is_negligible():
    k = excitation_kernel(_hydro(), dt=0.05)
    assert 6.0 < k.t[-1] < 9.0
    assert k.t[0] == -k.t[-1]


def test_force_of_a_record_is_the_sum_of_its_components():
    k = excitation_kernel(_hydro(hydrostatic_stiffness=C), dt=0.1, duration=20.0)
    t = 0.1 * np.arange(1200)
    w, a, phase = np.array([0.4, 0.9, 1.7]), np.array([1.0, 0.5, 0.7]), np.array([0.3, 2.0, 4.0])
    elevation = (a * np.cos(np.outer(t, w) + phase)).sum(axis=1)
    X = np.exp(-(w**2)) * np.exp(-1.5j * w)
    expected = np.real(np.exp(1j * (np.outer(t, w) + phase)) @ (a[:, None] * np.stack([1j * w * X, X], axis=1)))
    middle = slice(220, -220)
    assert np.abs(k.force(elevation)[middle] - expected[middle]).max() < 1e-5
    assert k.force(np.stack([elevation, 2 * elevation]), direction=0.5).shape == (2, 1200, 2)


def test_long_waves_lift_by_the_stiffness():
    k = excitation_kernel(_hydro(hydrostatic_stiffness=C), dt=0.05, duration=20.0)
    assert k.kernel[:, 0].sum(axis=0) * k.dt == pytest.approx([0.0, 1.0], abs=1e-6)


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ({"dt": 1.0}, r"up to pi/omega_max = 0\.5236 s"),
        ({"dt": 0.1, "duration": 1000.0}, "104.7 s"),
    ],
)
def test_steps_and_lengths_out_of_range(how, words):
    with pytest.raises(og.InputError, match=words):
        excitation_kernel(_hydro(), **how)


def test_what_cannot_be_used():
    with pytest.raises(og.InputError, match="zero speed expected, speed 5 m/s"):
        excitation_kernel(_hydro(speed=5.0), dt=0.1)
    with pytest.raises(og.InputError, match="excitation_force"):
        excitation_kernel(_hydro().drop_vars("excitation_force"), dt=0.1)
    k = excitation_kernel(_hydro(), dt=0.1)
    with pytest.raises(og.InputError, match=r"28\.65 deg\) expected, 90 deg found"):
        k.force([0.0, 1.0], direction=np.pi / 2)
    with pytest.raises(og.InputError, match="NaN"):
        k.force([0.0, np.nan])
