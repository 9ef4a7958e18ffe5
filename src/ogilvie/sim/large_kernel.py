"""Compiled: Runge-Kutta steps of a vessel in large motions: world pose, body velocity, fluid momentum, any compiled load.

    p' = R v, Theta' = T omega,  nu = (v, omega) in body axes;  nu_r = nu - (R^T v_c, 0), delta = nu_r - U e_1
    P = A delta + p_m                         momentum of the fluid; p_m' = mu, the fluid memory driven by delta
    (M + A) nu' = F - A (omega x R^T v_c) - mu - [omega x h; omega x k + v x h]_M nu - [omega x P_1; omega x P_2 + v_r x P_1]

Every product with a velocity is without work, so a passive memory stays passive in large motions.
"""

import numpy as np
from numba import njit

from ogilvie.loads.kernel import ETA, NU, NU_R, ROTATION, SITUATION, TIME
from ogilvie.sim.dynamics import FAST, combine
from ogilvie.sim.packed import advance_memory, memory_force

#: Columns of a row of output: eta, nu, acceleration, radiation force without -A nu'; then the held forces and the signals.
LARGE_COLUMNS = 24


@njit(cache=True, nogil=True, fastmath=FAST)
def situate(t, current, x):
    """Fill in time, rotation and velocity through the water where pose and velocity are set."""
    cf, sf = np.cos(x[ETA + 3]), np.sin(x[ETA + 3])
    ct, st = np.cos(x[ETA + 4]), np.sin(x[ETA + 4])
    cp, sp = np.cos(x[ETA + 5]), np.sin(x[ETA + 5])
    x[TIME] = t
    R = x[ROTATION:]
    R[0], R[1], R[2] = cp * ct, -sp * cf + cp * st * sf, sp * sf + cp * st * cf
    R[3], R[4], R[5] = sp * ct, cp * cf + sp * st * sf, -cp * sf + sp * st * cf
    R[6], R[7], R[8] = -st, ct * sf, ct * cf
    for p in range(3):
        x[NU_R + p] = x[NU + p] - (R[p] * current[0] + R[3 + p] * current[1] + R[6 + p] * current[2])
        x[NU_R + 3 + p] = x[NU + 3 + p]


@njit(cache=True, nogil=True, fastmath=FAST)
def _cross(force, at, a, i, b, j):
    """force[at:at+3] -= a[i:i+3] x b[j:j+3]."""
    force[at] -= a[i + 1] * b[j + 2] - a[i + 2] * b[j + 1]
    force[at + 1] -= a[i + 2] * b[j] - a[i] * b[j + 2]
    force[at + 2] -= a[i] * b[j + 1] - a[i + 1] * b[j]


@njit(cache=True, nogil=True, fastmath=FAST)
def _pose_rate(x, rate):
    """rate (6,) = J(eta) nu."""
    R = x[ROTATION:]
    for p in range(3):
        rate[p] = R[3 * p] * x[NU] + R[3 * p + 1] * x[NU + 1] + R[3 * p + 2] * x[NU + 2]
    sf, cf, ct = np.sin(x[ETA + 3]), np.cos(x[ETA + 3]), np.cos(x[ETA + 4])
    tt = np.tan(x[ETA + 4])
    p, q, r = x[NU + 3], x[NU + 4], x[NU + 5]
    rate[3] = p + tt * (sf * q + cf * r)
    rate[4] = cf * q - sf * r
    rate[5] = (sf * q + cf * r) / ct


@njit(cache=True, nogil=True, fastmath=FAST)
def add_reference_forces(t, frame, C, wave, k, x, g, force):
    """Add -J^T C (eta - eta_0) and the tabulated forces, given in the frame that advances steadily at U and psi_0.

    frame = U, psi_0, current (3), constant force (6); g (6,) is room to work in.
    """
    R, U = x[ROTATION:], frame[0]
    c, s = np.cos(frame[1]), np.sin(frame[1])
    dx, dy = x[ETA] - U * t * c, x[ETA + 1] - U * t * s
    d0, d1, d2 = c * dx + s * dy, -s * dx + c * dy, x[ETA + 2]
    d3, d4, d5 = x[ETA + 3], x[ETA + 4], x[ETA + 5] - frame[1]
    for p in range(6):
        g[p] = -(C[p, 0] * d0 + C[p, 1] * d1 + C[p, 2] * d2 + C[p, 3] * d3 + C[p, 4] * d4 + C[p, 5] * d5)
    sf, cf, ct, tt = np.sin(d3), np.cos(d3), np.cos(d4), np.tan(d4)
    force[3] += g[3]
    force[4] += sf * tt * g[3] + cf * g[4] + sf / ct * g[5]
    force[5] += cf * tt * g[3] - sf * g[4] + cf / ct * g[5]
    for part in range(2):
        f0, f1, f2 = frame[5 + 3 * part], frame[6 + 3 * part], frame[7 + 3 * part]
        f0, f1, f2 = f0 + wave[k, 3 * part], f1 + wave[k, 3 * part + 1], f2 + wave[k, 3 * part + 2]
        if part == 0:
            f0, f1, f2 = f0 + g[0], f1 + g[1], f2 + g[2]
        w0, w1 = c * f0 - s * f1, s * f0 + c * f1
        for p in range(3):
            force[3 * part + p] += R[p] * w0 + R[3 + p] * w1 + R[6 + p] * f2


@njit(cache=True, nogil=True, fastmath=FAST)
def _body_forces(matrices, x, delta, memory, momentum, work, radiation, force):
    """Add damping, gyroscopic forces and the force of the moving fluid; keep the latter in `radiation`."""
    M, A, D = matrices[1], matrices[2], matrices[3]
    h, P, water, turning = work[0], work[1], work[2], work[3]
    turning[:] = 0.0
    for p in range(6):
        h[p], P[p], radiation[p] = 0.0, momentum[p], -memory[p]
        for q in range(6):
            h[p] += M[p, q] * x[NU + q]
            P[p] += A[p, q] * delta[q]
            force[p] -= D[p, q] * delta[q]
    _cross(force, 0, x, NU + 3, h, 0)
    _cross(force, 3, x, NU + 3, h, 3)
    _cross(force, 3, x, NU, h, 0)
    _cross(radiation, 0, x, NU + 3, P, 0)
    _cross(radiation, 3, x, NU + 3, P, 3)
    _cross(radiation, 3, x, NU_R, P, 0)
    for p in range(3):
        water[p] = x[NU + p] - x[NU_R + p]
    _cross(turning, 0, x, NU + 3, water, 0)  # -omega x v_c = d/dt of the current in body axes
    for p in range(6):
        radiation[p] += A[p, 0] * turning[0] + A[p, 1] * turning[1] + A[p, 2] * turning[2]
        force[p] += radiation[p]


@njit(nogil=True, fastmath=FAST)
def add_kernels(functions, places, data, own, x, force):
    """Add the force of every compiled load; places (n, 4) holds the ranges of its numbers in `data` and `own`."""
    for k in range(len(functions)):
        functions[k](x, data[places[k, 0] : places[k, 1]], own[places[k, 2] : places[k, 3]], force)


@njit(cache=True, nogil=True, fastmath=FAST)
def _sample(functions, table, data, number, x, memory):
    """Call the control laws whose time has come; table (n, 5): data from, to, memory from, to, steps per sample."""
    for k in range(len(functions)):
        if number % table[k, 4] == 0:
            begin, end = table[k, 2], table[k, 3]
            functions[k](x, data[table[k, 0] : table[k, 1]], memory[begin + 6 : end], memory[begin : begin + 6])


@njit(cache=True, nogil=True, fastmath=FAST)
def run_large(
    dt, frame, matrices, places, output, coupling, source, bands, dense,
    functions, ranges, data, own, laws, table, law_data, signals,
    y, memory, wave, external, row, steps, first, stride, number, origin, out,
):  # fmt: skip
    """Advance `steps` steps; see :class:`ogilvie.sim.large.LargeMotions` for the arrays."""
    n_states = places.shape[0] * (output.shape[3] + 2)
    states = memory[:n_states].reshape(places.shape[0], output.shape[3] + 2)
    old = np.empty(output.shape[3] + 2)
    rate, a, delta = np.empty((4, 6)), np.empty((4, 6)), np.empty((4, 6))
    v = np.empty((4, 6))
    both, radiation, held = np.zeros((2, 24)), np.zeros((4, 6)), np.empty(6)
    work = np.empty((4, 6))
    mu, momentum, force, x = np.empty(6), np.empty(6), np.empty(6), np.empty(SITUATION)
    current = frame[2:5]
    written = 0
    for i in range(steps):
        t = origin + (number + i) * dt
        memory_force(places, output[0], states, both[0])
        memory_force(places, output[1], states, both[1])
        for stage in range(4):
            h = 0.0 if stage == 0 else dt if stage == 3 else 0.5 * dt
            for p in range(6):
                x[ETA + p], x[NU + p] = y[p], y[6 + p]
                if stage > 0:
                    x[ETA + p] += h * rate[stage - 1, p]
                    x[NU + p] += h * a[stage - 1, p]
                v[stage, p] = x[NU + p]
            situate(t + h, current, x)
            if stage == 0:
                _sample(laws, table, law_data, number + i, x, memory)
                held[:] = external
                for k in range(table.shape[0]):
                    for p in range(6):
                        held[p] += memory[table[k, 2] + p]
            for p in range(6):
                delta[stage, p] = x[NU_R + p]
                mu[p], momentum[p] = both[0, 6 * stage + p], both[1, 6 * stage + p]
                force[p] = held[p]
            delta[stage, 0] -= frame[0]
            for j in range(stage):
                for p in range(6):
                    for q in range(6):
                        mu[p] += coupling[0, stage, j, p, q] * delta[j, q]
                        momentum[p] += coupling[1, stage, j, p, q] * delta[j, q]
            _pose_rate(x, rate[stage])
            add_reference_forces(t + h, frame, matrices[4], wave, row + 2 * i + (stage + 1) // 2, x, work[0], force)
            _body_forces(matrices, x, delta[stage], mu, momentum, work, radiation[stage], force)
            add_kernels(functions, ranges, data, own, x, force)
            for p in range(6):
                a[stage, p] = 0.0
                for q in range(6):
                    a[stage, p] += matrices[0, p, q] * force[q]
        if (first + i) % stride == 0:
            for p in range(6):
                out[written, p], out[written, 6 + p] = y[p], y[6 + p]
                out[written, 12 + p], out[written, 18 + p] = a[0, p], radiation[0, p]
            for k in range(table.shape[0]):
                for p in range(6):
                    out[written, LARGE_COLUMNS + 6 * k + p] = memory[table[k, 2] + p]
            for k in range(signals.shape[0]):
                out[written, LARGE_COLUMNS + 6 * table.shape[0] + k] = memory[signals[k]]
            written += 1
        combine(dt, y, rate, v, a)
        advance_memory(places, source, bands, dense, delta.reshape(24), old, states)
    return written
