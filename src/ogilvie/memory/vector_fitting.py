"""Vector fitting (Gustavsen and Semlyen): poles shared by all couplings of a block, relocated until they stay where they are.

With poles a_k, an unknown scaling function sigma(s) = d + sum c_k / (s - a_k) and the products K_hat_ij sigma are sought as
sums over the same partial fractions, by linear least squares. The zeros of sigma are better poles than the a_k; at the end
they are the same.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.memory.common_poles import compressed, fit_common_poles, modal, one_each, stable
from ogilvie.memory.targets import Spectrum, Trial

Array = NDArray[Any]

_ITERATIONS = 15
_START_DAMPING = 0.3  # of the first poles; those of floating bodies are that broad
_SMALLEST_D = 1e-8


def identify_by_vector_fitting(target: Spectrum, *, r2: float, order: int | None, limit: int) -> tuple[Trial, Array]:
    """Return the model of a block with common poles by relaxed vector fitting; K_hat(0) = 0 and strictly proper.

    References
    ----------
    Gustavsen and Semlyen (1999), IEEE Trans. Power Delivery 14(3); Gustavsen (2006), ibid. 21(3), for the relaxed sigma;
    Deschrijver, Mrozowski, Dhaene and De Zutter (2008), for the compression by QR that makes many couplings cheap.
    """
    return fit_common_poles(target, vector_poles, r2=r2, order=order, limit=limit)


def vector_poles(target: Spectrum, n: int) -> Array:
    """Return n stable poles shared by all couplings of the target, 1/s.

    Examples
    --------
    >>> w = np.linspace(0.1, 4.0, 40)
    >>> K_hat = 1j * w / ((1j * w) ** 2 + 0.6j * w + 1.09)  # poles -0.3 +- i
    >>> A, B = (K_hat.imag / w)[:, None, None], K_hat.real[:, None, None]
    >>> vector_poles(Spectrum(w, A, B, np.zeros((1, 1)), True, np.ones(1)), 2).round(6)
    array([-0.3+1.j, -0.3-1.j])
    """
    omega = target.omega
    pairs = np.linspace(omega[0], omega[-1], n // 2 + 2)[1:-1] * (1j - _START_DAMPING)
    poles = np.concatenate([pairs, pairs.conj(), [-omega.mean()] * (n % 2)])
    for _ in range(_ITERATIONS):
        before, poles = poles, stable(_relocate(target, poles))
        if np.abs(np.sort(np.abs(poles)) - np.sort(np.abs(before))).max() < 1e-8 * omega[-1]:
            break
    return poles


def _relocate(target: Spectrum, poles: Array) -> Array:
    """Zeros of sigma, the poles that K_hat seems to have."""
    s, n = 1j * target.omega, len(poles)
    F, strictly_proper = _fractions(poles, s)
    numerator = s[:, None] * (F @ strictly_proper)
    if not target.A_inf_given:
        numerator = np.hstack([numerator, s[:, None]])
    K_hat = target.data(target.couplings, target.A_inf)[:, :, None]
    M = np.concatenate([np.broadcast_to(numerator, (len(K_hat), *numerator.shape)), -K_hat * F, -K_hat], axis=2)
    R = compressed(target.rows(M, target.couplings), numerator.shape[1])
    mean = np.concatenate([F.real.mean(axis=0), [1.0]])  # of Re sigma over the frequencies, to be 1: no trivial solution
    weight = np.linalg.norm(R)
    M, rhs = np.vstack([R, weight * mean]), np.concatenate([np.zeros(len(R)), [weight]])
    size = np.maximum(np.linalg.norm(M, axis=0), 1e-300)
    c = np.linalg.lstsq(M / size, rhs, rcond=None)[0] / size
    d = c[n] if abs(c[n]) > _SMALLEST_D else np.copysign(_SMALLEST_D, c[n])
    A, b = modal(poles)
    return np.linalg.eigvals(A - np.outer(b, c[:n]) / d)


def _fractions(poles: Array, s: Array) -> tuple[Array, Array]:
    """Real basis of partial fractions (n_w, n), and the basis (n, n - 1) of their sums that fall as 1/s^2."""
    columns, total = [], []
    for a in one_each(poles):
        f = 1 / (s - a)
        if a.imag > 0:
            g = 1 / (s - a.conjugate())
            columns += [(f + g) / 2, 1j * (f - g) / 2]
            total += [1.0, 0.0]
        else:
            columns.append(f)
            total.append(1.0)
    return np.stack(columns, axis=1), np.linalg.qr(np.array(total)[:, None], mode="complete")[0][:, 1:]
