"""Coefficients of time steps: Runge-Kutta with a condensed exponential step of the fluid memory, stability, exact steps."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.sim.modes import independent

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class MemoryStep:
    """One step of x' = A x + B v, mu = C x beside a Runge-Kutta step of the body, with the inner stages of x eliminated.

    Parameters
    ----------
    output : (4, 6, n) array
        Memory force of stage i that is known before the step: output_i x.
    coupling : (4, 4, 6, 6) array
        Memory force of stage i due to the velocity v_j of an earlier stage.
    transition : (n, n) array
    source : (4, n, 6) array
        x at the next step = transition x + sum_i source_i v_i.
    """

    output: Array
    coupling: Array
    transition: Array
    source: Array


def memory_step(A: Array, B: Array, C: Array, dt: float) -> MemoryStep:
    """Return the coefficients of one step of the fourth-order exponential Runge-Kutta method.

    Notes
    -----
    The memory's own motion is exact, so a fast pole does not limit dt; for A = 0 the method is the classical one. With
    P = exp(A dt/2), Q = dt/2 phi_1(A dt/2) B the stages are x, P x + Q v_1, P x + Q v_2, P^2 x + (P - 1) Q v_1 + 2 Q v_3, and

        x_next = P^2 x + dt ((phi_1 - 3 phi_2 + 4 phi_3) B v_1 + (2 phi_2 - 4 phi_3) B (v_2 + v_3) + (4 phi_3 - phi_2) B v_4)

    with phi_k(A dt). The time loop needs C times the factors of x (one product per step, for all stages together), C times
    those of v (6 x 6) and the update, but no stage of x itself.

    References
    ----------
    Cox and Matthews (2002), J. Comput. Phys. 176, 430, Eqs. (26)-(29).
    """
    half, (Q, _, _) = exponential_integrals(A, B, 0.5 * dt)
    full, phi = exponential_integrals(A, B, dt)  # phi_k(A dt) B dt
    n = len(A)
    P = np.stack([np.eye(n), half, half, full])
    S = np.zeros((4, 4, n, 6))
    S[1, 0] = S[2, 1] = Q
    S[3, 0], S[3, 2] = half @ Q - Q, 2.0 * Q
    middle = 2.0 * phi[1] - 4.0 * phi[2]
    source = np.stack([phi[0] - 3.0 * phi[1] + 4.0 * phi[2], middle, middle, 4.0 * phi[2] - phi[1]])
    return MemoryStep(C @ P, C @ S, full, source)


def exponential_integrals(A: Array, B: Array, dt: float) -> tuple[Array, Array]:
    """Return exp(A dt) (n, n) and dt phi_k(A dt) B, k = 1, 2, 3 (3, n, m), phi_k(z) = sum_j z^j / (j + k)!.

    Examples
    --------
    >>> E, phi = exponential_integrals(np.array([[-2.0]]), np.array([[1.0]]), 1.0)
    >>> round(float(phi[0, 0, 0]), 6)  # (1 - exp(-2)) / 2
    0.432332
    """
    n, m = B.shape
    full, phi = np.zeros((n, n)), np.zeros((3, n, m))
    for i, j in independent(A):
        p = j - i
        E = np.zeros((p + 3 * m, p + 3 * m))
        E[:p, :p], E[:p, p : p + m] = A[i:j, i:j] * dt, B[i:j] * dt
        E[p : p + m, p + m : p + 2 * m] = E[p + m : p + 2 * m, p + 2 * m :] = np.eye(m)
        Phi = scipy.linalg.expm(E)[:p]
        full[i:j, i:j] = Phi[:, :p]
        phi[:, i:j] = Phi[:, p:].reshape(p, 3, m).transpose(1, 0, 2)
    return full, phi


def exact_step(A: Array, G: Array, dt: float) -> tuple[Array, Array]:
    """Return the exact step of z' = A z + G f(t) for forces that are quadratic in time within the step.

    Parameters
    ----------
    A : (n, n) array
    G : (n, m) array
    dt : float
        s.

    Returns
    -------
    transition : (n, n) array
    source : (n, 3, m) array
        z(t + dt) = transition z(t) + sum_k source_k f(t + k dt / 2), k = 0, 1, 2.
    """
    transition, phi = exponential_integrals(A, G, dt)  # of f, dt f', dt^2 f'' at the start
    stencil = np.array([[1.0, 0.0, 0.0], [-3.0, 4.0, -1.0], [4.0, -8.0, 4.0]])
    return transition, np.einsum("dnm,dk->nkm", phi, stencil)


def step_matrix(
    inverse_mass: Array, stiffness: Array, damping: Array, memory: MemoryStep, dt: float, speed: float = 0.0
) -> Array:
    """Return the matrix (12 + n, 12 + n) by which one step multiplies (eta, nu, x) without outer forces."""
    n = len(memory.transition)
    I = np.eye(12 + n)
    eta, nu, x = I[:6], I[6:12], I[12:]
    rate, v, a = np.zeros((3, 4, 6, 12 + n))
    for i, h in enumerate((0.0, 0.5 * dt, 0.5 * dt, dt)):
        v[i] = nu + h * a[i - 1] if i else nu
        pose = eta + h * rate[i - 1] if i else eta
        rate[i] = v[i]
        rate[i, 1:3] += speed * pose[[5, 4]] * [[1.0], [-1.0]]
        force = stiffness @ pose + damping @ v[i] + memory.output[i] @ x
        for j in range(i):
            force = force + memory.coupling[i, j] @ v[j]
        a[i] = -inverse_mass @ force
    w = dt * np.array([1.0, 2.0, 2.0, 1.0]) / 6.0
    following = memory.transition @ x + sum(s @ u for s, u in zip(memory.source, v, strict=True))
    return np.concatenate([eta + np.einsum("i,iab->ab", w, rate), nu + np.einsum("i,iab->ab", w, a), following])


def refuse_unstable_step(growth: Callable[[float], float], dt: float) -> None:
    """Raise :class:`InputError` with a time step that works if the largest growth per step at dt exceeds 1.

    Parameters
    ----------
    growth : callable
        Largest growth of a mode in one step, as a function of dt; modes that grow by nature do not count.
    dt : float
        s.
    """
    if growth(dt) <= 1.0 + _ROUNDING:
        return
    works = 0.5 * dt
    while growth(works) > 1.0 + _ROUNDING:
        works *= 0.5
    fails = 2.0 * works
    for _ in range(8):
        middle = 0.5 * (works + fails)
        works, fails = (middle, fails) if growth(middle) <= 1.0 + _ROUNDING else (works, middle)
    digit = 10.0 ** np.floor(np.log10(works))
    round_off = np.floor(10.0 * works / digit) * digit / 10.0  # two digits, downwards
    raise InputError(
        f"dt: {dt:g} s is too large for the fastest motion of the vessel, at most about {works:.4g} s expected. "
        f"Use dt={round_off:.2g} or smaller."
    )


#: Growth per step that is rounding: the double poles at zero of a free vessel are as uncertain as this.
_ROUNDING = 1e-6
