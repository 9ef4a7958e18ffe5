"""Coefficients and wave forces transformed from the time domain: exact values, energy, long waves; the plain method beside."""

from functools import cache

import numpy as np
import pytest

import ogilvie as og
from ogilvie.bem.hybrid import hybrid_bem
from ogilvie.bem.hybrid_hydro import hybrid_hydro
from ogilvie.mesh.shapes import hemisphere

KA = np.array([0.02, 0.1, 0.5, 1.0, 1.5, 2.0, 2.4, 2.56, 2.8, 3.5])  # irregular frequency of heave: 2.56
UNIT = 2 / 3 * np.pi


@cache
def found():
    return hybrid_hydro(hemisphere(1.0), omega=np.sqrt(KA), wave_direction=[0.0, 0.7], rho=1.0, g=1.0, resolution=0.8)


@pytest.mark.parametrize(("dof", "digits"), [(2, "33"), (0, "11")])
def test_coefficients_of_the_hemisphere(shared_reference, dof, digits):
    exact = np.genfromtxt(shared_reference / "hemisphere_exact.csv", delimiter=",", names=True, skip_header=2)
    at = [int(np.argmin(np.abs(exact["Ka"] - ka))) for ka in KA]
    same = np.abs(exact["Ka"][at] - KA) < 1e-9
    assert same.sum() >= 7
    A, B = found().added_mass.values[same, dof, dof], found().radiation_damping.values[same, dof, dof]
    np.testing.assert_allclose(A / UNIT, exact["mu" + digits][at][same], atol=1e-3)
    np.testing.assert_allclose(B / UNIT / np.sqrt(KA[same]), exact["lam" + digits][at][same], atol=1e-3)


def test_damping_is_the_energy_of_the_waves():
    """B = k/(8 pi rho g c_g) int |X|^2 db, c_g = g/(2 omega); of surge, int cos^2 b db = pi."""
    w, X = np.sqrt(KA), found().excitation_force.values
    for dof, around in ((0, np.pi), (2, 2 * np.pi)):
        B = found().radiation_damping.values[:, dof, dof]
        expected = 2.0 * w**3 / (8.0 * np.pi) * around * np.abs(X[:, 0, dof]) ** 2
        np.testing.assert_allclose(B, expected, atol=4e-3 * B.max())


def test_a_sphere_knows_its_directions():
    X = found().excitation_force.values
    np.testing.assert_allclose(X[:, 1, 0], np.cos(0.7) * X[:, 0, 0], atol=2e-3)
    np.testing.assert_allclose(X[:, 1, 1], np.sin(0.7) * X[:, 0, 0], atol=2e-3)
    np.testing.assert_allclose(X[:, 1, 2], X[:, 0, 2], atol=2e-3)
    assert np.abs(X[..., 3:]).max() < 2e-3


def test_long_waves_lift_the_waterplane():
    """X3 -> rho g pi a^2 and, with the crest at O, X1 leads by 90 deg."""
    X = found().excitation_force.values[0, 0]
    assert abs(X[2]) == pytest.approx(np.pi * (1.0 - 0.02 * (UNIT / np.pi) * (1 + 0.83)), rel=2e-2)
    assert np.degrees(np.angle(X[0])) == pytest.approx(90.0, abs=2.0)


def test_a_hull_off_its_middle():
    """Moved by d, the force is that at O with the wave's phase, and the pitch moment follows the heave force."""
    d, w = 0.8, np.array([0.9])
    options = {"omega": w, "wave_direction": [0.0], "rho": 1.0, "g": 1.0, "resolution": 0.5}
    here = hybrid_hydro(hemisphere(1.0), **options).excitation_force.values[0, 0]
    there = hybrid_hydro(hemisphere(1.0).translated([d, 0.0, 0.0]), **options).excitation_force.values[0, 0]
    expected = here * np.exp(-1j * w[0] ** 2 * d)
    np.testing.assert_allclose(there[[0, 2]], expected[[0, 2]], atol=3e-3)
    assert there[4] == pytest.approx(-d * expected[2], abs=5e-3)


def test_force_in_time_is_that_in_frequency():
    """From the elevation at O by the kernel, which is not causal, as by the sum over its components."""
    hydro = hybrid_hydro(
        hemisphere(1.0), omega=np.linspace(0.04, 3.2, 80), wave_direction=[0.0], rho=1.0, g=1.0, resolution=0.5
    )
    kernel = og.excitation_kernel(hydro, dt=0.1, duration=40.0)
    t, w, a, phase = 0.1 * np.arange(1600), np.array([0.5, 1.0, 1.6]), np.array([1.0, 0.6, 0.4]), np.array([0.2, 1.9, 4.0])
    motion = a * np.exp(1j * (np.outer(t, w) + phase))
    X = hydro.excitation_force.interp(omega=w, method="cubic").values[:, 0, [0, 2]]
    middle = slice(410, -410)
    force = kernel.force(motion.real.sum(axis=1))[middle][:, [0, 2]]
    np.testing.assert_allclose(force, (motion @ X).real[middle], atol=4e-3 * np.abs(force).max())
    before = np.abs(kernel.kernel[kernel.t < -0.5, 0, 0]).max()
    assert before > 0.05 * np.abs(kernel.kernel[:, 0, 0]).max()


def test_waves_too_short_for_the_panels_are_named():
    with pytest.warns(og.OgilvieWarning, match="too short for the panels, which resolve up to"):
        hybrid_hydro(hemisphere(1.0), omega=[1.0, 20.0], rho=1.0, g=1.0, resolution=0.5, duration=4.0)


@pytest.mark.parametrize("omega", [[0.0, 1.0], [], [np.nan]])
def test_frequencies_that_are_none(omega):
    with pytest.raises(og.InputError, match="frequencies > 0"):
        hybrid_hydro(hemisphere(1.0), omega=omega)


def test_the_plain_method_is_there_to_compare():
    K = hybrid_bem(hemisphere(1.0), duration=3.0, outer="green", order=3, rho=1.0, g=1.0)
    assert K.K[0, 2, 2] / UNIT == pytest.approx(3 / 16, rel=0.1)
    assert K.A_inf[2, 2] / UNIT == pytest.approx(0.5, rel=0.05)
