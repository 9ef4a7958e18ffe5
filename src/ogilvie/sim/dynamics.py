"""Compiled: one Runge-Kutta step of the linear equations of motion, whatever the model of the fluid memory.

Kernels see plain arrays; ``y = (eta, nu)`` (12,) is advanced in place. eta is the displacement from the steady frame, nu the
velocity in body axes less the steady speed U: eta' = nu + U (0, psi, -theta, 0, 0, 0). ``mechanics`` (18, 6, 6) holds the
inverse mass, the stiffness and the sixteen matrices E_ij of :func:`stages`.
"""

import numpy as np
from numba import njit

#: Floating-point freedom that the loops may use. NaN and infinity are not assumed away, so divergence stays visible.
FAST = {"reassoc", "contract", "nsz", "arcp"}

#: Columns of a recorded row: eta, nu, acceleration, memory force.
COLUMNS = 24


def pack_mechanics(inverse_mass: np.ndarray, stiffness: np.ndarray, damping: np.ndarray, coupling: np.ndarray) -> np.ndarray:
    """Return the array `mechanics` of :func:`stages` from its parts; coupling is (4, 4, 6, 6)."""
    E = coupling.copy()
    E[range(4), range(4)] = damping
    return np.ascontiguousarray(np.concatenate([inverse_mass[None], stiffness[None], E.reshape(16, 6, 6)]), dtype=float)


@njit(cache=True, nogil=True, fastmath=FAST)
def stages(dt, speed, mechanics, wave, row, external, memory_force, y, eta, rate, v, a):
    """Fill the rates of eta, velocities v and accelerations a, each (4, 6), of the stages of the classical Runge-Kutta method.

    Notes
    -----
    (M + A_inf) a_i = F(t + c_i dt) + F_external - C eta_i - m_i - sum_{j <= i} E_ij v_j. E_ii is the damping; E_ij, j < i, is
    what the velocity of an earlier stage adds to the memory force of stage i; m_i (row i of `memory_force`) is the part of the
    memory force that is known before the step. `wave` is a table at half steps and `row` its row at t.
    """
    for i in range(4):
        h = dt if i == 3 else 0.5 * dt
        for p in range(6):
            if i == 0:
                eta[p] = y[p]
                v[0, p] = y[6 + p]
            else:
                eta[p] = y[p] + h * rate[i - 1, p]
                v[i, p] = y[6 + p] + h * a[i - 1, p]
            rate[i, p] = v[i, p]
        rate[i, 1] += speed * eta[5]
        rate[i, 2] -= speed * eta[4]
        k = row + (i + 1) // 2
        f0 = wave[k, 0] + external[0] - memory_force[i, 0]
        f1 = wave[k, 1] + external[1] - memory_force[i, 1]
        f2 = wave[k, 2] + external[2] - memory_force[i, 2]
        f3 = wave[k, 3] + external[3] - memory_force[i, 3]
        f4 = wave[k, 4] + external[4] - memory_force[i, 4]
        f5 = wave[k, 5] + external[5] - memory_force[i, 5]
        for j in range(-1, i + 1):
            for q in range(6):
                e = eta[q] if j < 0 else v[j, q]
                m = 1 if j < 0 else 2 + 4 * i + j
                f0 -= mechanics[m, 0, q] * e
                f1 -= mechanics[m, 1, q] * e
                f2 -= mechanics[m, 2, q] * e
                f3 -= mechanics[m, 3, q] * e
                f4 -= mechanics[m, 4, q] * e
                f5 -= mechanics[m, 5, q] * e
        for p in range(6):
            a[i, p] = (
                (mechanics[0, p, 0] * f0 + mechanics[0, p, 1] * f1)
                + (mechanics[0, p, 2] * f2 + mechanics[0, p, 3] * f3)
                + (mechanics[0, p, 4] * f4 + mechanics[0, p, 5] * f5)
            )


@njit(cache=True, nogil=True, fastmath=FAST)
def combine(dt, y, rate, a):
    """Advance y by one step with the weights (1, 2, 2, 1) / 6."""
    w = dt / 6.0
    for p in range(6):
        y[p] += w * (rate[0, p] + 2.0 * (rate[1, p] + rate[2, p]) + rate[3, p])
        y[6 + p] += w * (a[0, p] + 2.0 * (a[1, p] + a[2, p]) + a[3, p])


@njit(cache=True, nogil=True, fastmath=FAST)
def record(out, row, y, a, memory_force):
    """Write eta, nu, acceleration and memory force at the start of a step."""
    for p in range(6):
        out[row, p] = y[p]
        out[row, 6 + p] = y[6 + p]
        out[row, 12 + p] = a[0, p]
        out[row, 18 + p] = memory_force[0, p]
