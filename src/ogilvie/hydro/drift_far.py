"""Mean drift from the waves far away (Maruo's form), and the energy balance (kernel).

Far from the body the scattered and radiated waves are eta = A(theta) R^(-1/2) exp(-ikR). With n = c_g/c

    F_x = (rho g n/2) int |A|^2 (cos b - cos theta) dtheta + (P/c) cos b      (F_y: sines)
    M_z = (rho g n/2k) int Im(A* A') dtheta - (rho g n/k) (2 pi/k)^(1/2) Re(exp(i pi/4) A'(b))
    0 = (rho g c_g/2) int |A|^2 dtheta + rho g c_g (2 pi/k)^(1/2) Re(exp(-i pi/4) A(b)) + P

per square metre of wave amplitude; P is the power taken by external damping. The last line, the energy balance, has been used
in the first, whose direct form is a small difference of large numbers in long waves; so it stays as a check. See
docs/theory/drift.md.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.bem_waves import profile
from ogilvie.hydro.drift_first import FirstOrder
from ogilvie.hydro.drift_wave import Wave

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class FarField:
    """Mean drift and energy from the far field, for every pair of directions.

    Parameters
    ----------
    force : (n_b, n_b, 6) complex array
        N/m2 and N m/m2; NaN in heave, roll, pitch.
    radiated, removed : (n_b,) array
        Power in the scattered and radiated waves plus that of external damping, and power taken from the incident wave, W/m2.
    """

    force: Complex
    radiated: Array
    removed: Array


def far_field(first: FirstOrder) -> FarField:
    """Return the mean drift by conservation of momentum in the far field.

    Notes
    -----
    Two directions m, n at once: |A|^2 becomes A_m A_n*, and the terms at theta = b become half the sum of A_m(b_n) and
    A_n(b_m)*. The energy balance of the pair gives one combination of these two; the other, weighted with
    (cos b_n - cos b_m)/2, stays.
    """
    w, b = first.wave, first.wave.directions
    N = 2 * int(np.ceil(2.0 * w.k * _radius(first) + 24.0))
    theta = 2.0 * np.pi * np.arange(N) / N
    A, slope = amplitude(first, theta)
    A_b, slope_b = amplitude(first, b)  # [m, n]: wave of direction m, seen in direction n
    d = 2.0 * np.pi / N
    level = 0.5 * w.rho * w.g * w.ratio  # N/m per m2
    c = w.omega / w.k
    total = level * (A * d) @ A.conj().T  # (n_b, n_b)
    root = np.sqrt(2.0 * np.pi / w.k)
    X = np.exp(-0.25j * np.pi) * A_b
    out = c * total + first.dissipated
    force = np.full((len(b), len(b), 6), np.nan, dtype=complex)
    for i, part in enumerate((np.cos, np.sin)):
        one, two = part(b)[:, None], part(b)[None, :]
        scattered = level * (A * part(theta) * d) @ A.conj().T
        odd = -level * root * 0.5 * (two - one) * (X - X.conj().T)
        force[..., i] = 0.5 * (one + two) * out / c - scattered + odd
    turn = (A.conj()[None, :, :] * slope[:, None, :] - A[:, None, :] * slope.conj()[None, :, :]).sum(axis=-1) * d / 2j
    Y = np.exp(0.25j * np.pi) * slope_b
    force[..., 5] = level / w.k * (turn - root * (Y + Y.conj().T))
    removed = -2.0 * level * c * root * np.real(np.diag(X))
    return FarField(force, np.real(np.diag(out)), removed)


def amplitude(first: FirstOrder, theta: Array) -> tuple[Complex, Complex]:
    """Return A(theta) (n_b, n_theta), m^(1/2) per metre, and its derivative.

    Notes
    -----
    A = omega/(4 g N) (2/(pi k))^(1/2) exp(i pi/4) sum of sources times f(z) exp(ik(x cos theta + y sin theta)) dS, with N the
    integral of f^2 over the depth, n tanh(kh)/k: the far field of the Green function is (i/4N) f f H0^(2)(kR).
    """
    w, hull = first.wave, first.hull
    x = hull.source_points
    strength = first.strengths * (profile(x[:, 2], w.k, w.depth)[0] * hull.source_areas)
    cos, sin = np.cos(theta), np.sin(theta)
    wave = np.exp(1j * w.k * (np.outer(x[:, 0], cos) + np.outer(x[:, 1], sin)))
    turn = 1j * w.k * (np.outer(x[:, 1], cos) - np.outer(x[:, 0], sin)) * wave
    scale = w.omega / (4.0 * w.g * _depth_integral(w)) * np.sqrt(2.0 / (np.pi * w.k)) * np.exp(0.25j * np.pi)
    return scale * strength @ wave, scale * strength @ turn


def _depth_integral(w: Wave) -> float:
    return float(w.ratio * np.tanh(w.k * w.depth) / w.k)


def _radius(first: FirstOrder) -> float:
    return float(np.linalg.norm(first.hull.source_points[:, :2], axis=1).max())
