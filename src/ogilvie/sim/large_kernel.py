"""Compiled: Runge-Kutta steps of a vessel in large motions: world pose, body velocity, fluid momentum, any compiled load.

    p' = R v, Theta' = T omega,  nu = (v, omega) in body axes;  nu_r = nu - (R^T v_c, 0), delta = nu_r - U e_1
    P = A delta + p_m - A_i1(0) (u_m - U)      momentum of the fluid; p_m' = mu, the fluid memory driven by delta; the last
                                               term, of the mean speed u_m, for U > 0 and i = 1, 5 alone
    (M + A) nu' = F - A (omega x R^T v_c) - mu - [omega x h; omega x k + v x h]_M nu - [omega x P_1; omega x P_2 + v_r x P_1]

Every product with a velocity is without work, so a passive memory stays passive in large motions.
"""

import numpy as np
from numba import njit

from ogilvie.loads.kernel import ETA, MEAN_SPEED, NU, NU_R, ROTATION, SITUATION, SLOW, TIME
from ogilvie.sim.dynamics import FAST, combine
from ogilvie.sim.packed import advance_memory, memory_force
from ogilvie.waves.sincos import sine_and_cosine

#: Columns of a row of output: eta, nu, acceleration, radiation force without -A nu', mean speed, slow x, y and heading; then
#: the held forces and the signals.
LARGE_COLUMNS = 28

#: Mean speed and slow pose at the head of the memory vector: u_m; x, y, psi of the slow pose and their rates.
SLOW_STATES = 7

#: s, over which the mean speed is averaged (exponentially): long beside a wave, short beside a manoeuvre.
AVERAGING = 30.0

#: rad/s and damping ratio of the filter of the slow pose, which follows steady sailing and steady turning without delay.
SLOW_FREQUENCY, SLOW_DAMPING = 0.1, 0.7


@njit(cache=True, nogil=True, fastmath=FAST)
def situate(t, current, x, trig):
    """Fill in time, rotation and velocity through the water where pose and velocity are set.

    trig (4,) becomes sin phi, cos phi, sin theta, cos theta.
    """
    sf, cf = sine_and_cosine(x[ETA + 3])
    st, ct = sine_and_cosine(x[ETA + 4])
    sp, cp = sine_and_cosine(x[ETA + 5])
    x[TIME] = t
    R = x[ROTATION:]
    R[0], R[1], R[2] = cp * ct, -sp * cf + cp * st * sf, sp * sf + cp * st * cf
    R[3], R[4], R[5] = sp * ct, cp * cf + sp * st * sf, -cp * sf + sp * st * cf
    R[6], R[7], R[8] = -st, ct * sf, ct * cf
    for p in range(3):
        x[NU_R + p] = x[NU + p] - (R[p] * current[0] + R[3 + p] * current[1] + R[6 + p] * current[2])
        x[NU_R + 3 + p] = x[NU + 3 + p]
    trig[0], trig[1], trig[2], trig[3] = sf, cf, st, ct


@njit(cache=True, nogil=True, fastmath=FAST)
def _cross(force, at, a, i, b, j):
    """force[at:at+3] -= a[i:i+3] x b[j:j+3]."""
    force[at] -= a[i + 1] * b[j + 2] - a[i + 2] * b[j + 1]
    force[at + 1] -= a[i + 2] * b[j] - a[i] * b[j + 2]
    force[at + 2] -= a[i] * b[j + 1] - a[i + 1] * b[j]


@njit(cache=True, nogil=True, fastmath=FAST)
def _add_product(turned, x, i, sign, out, j):
    """out[j:j+6] += sign M x[i:i+6] with `turned` (6, 6), the transpose of M."""
    s0 = s1 = s2 = s3 = s4 = s5 = 0.0
    for q in range(6):
        v = x[i + q]
        s0 += turned[q, 0] * v
        s1 += turned[q, 1] * v
        s2 += turned[q, 2] * v
        s3 += turned[q, 3] * v
        s4 += turned[q, 4] * v
        s5 += turned[q, 5] * v
    out[j] += sign * s0
    out[j + 1] += sign * s1
    out[j + 2] += sign * s2
    out[j + 3] += sign * s3
    out[j + 4] += sign * s4
    out[j + 5] += sign * s5


@njit(cache=True, nogil=True, fastmath=FAST)
def _pose_rate(x, trig, rate):
    """rate (6,) = J(eta) nu."""
    R = x[ROTATION:]
    for p in range(3):
        rate[p] = R[3 * p] * x[NU] + R[3 * p + 1] * x[NU + 1] + R[3 * p + 2] * x[NU + 2]
    p, q, r = x[NU + 3], x[NU + 4], x[NU + 5]
    yaw = (trig[0] * q + trig[1] * r) / trig[3]
    rate[3] = p + trig[2] * yaw
    rate[4] = trig[1] * q - trig[0] * r
    rate[5] = yaw


@njit(cache=True, nogil=True, fastmath=FAST)
def add_reference_forces(t, frame, C, wave, k, x, trig, work, force):
    """Add -J^T C (eta - eta_0) and the tabulated forces, given in the frame that advances steadily at U and psi_0.

    frame = U, psi_0, current (3), constant force (6), cos psi_0, sin psi_0, ...; C transposed; work (12,) is room to work in.
    """
    R, U, c, s = x[ROTATION:], frame[0], frame[11], frame[12]
    dx, dy = x[ETA] - U * t * c, x[ETA + 1] - U * t * s
    work[0], work[1], work[2] = c * dx + s * dy, -s * dx + c * dy, x[ETA + 2]
    work[3], work[4], work[5] = x[ETA + 3], x[ETA + 4], x[ETA + 5] - frame[1]
    work[6:12] = 0.0
    _add_product(C, work, 0, -1.0, work, 6)
    sf, cf, st, ct = trig[0], trig[1], trig[2], trig[3]
    across = (st * work[9] + work[11]) / ct
    force[3] += work[9]
    force[4] += sf * across + cf * work[10]
    force[5] += cf * across - sf * work[10]
    for part in range(2):
        f0 = frame[5 + 3 * part] + wave[k, 3 * part]
        f1 = frame[6 + 3 * part] + wave[k, 3 * part + 1]
        f2 = frame[7 + 3 * part] + wave[k, 3 * part + 2]
        if part == 0:
            f0, f1, f2 = f0 + work[6], f1 + work[7], f2 + work[8]
        w0, w1 = c * f0 - s * f1, s * f0 + c * f1
        for p in range(3):
            force[3 * part + p] += R[p] * w0 + R[3 + p] * w1 + R[6 + p] * f2


@njit(cache=True, nogil=True, fastmath=FAST)
def _body_forces(matrices, x, delta, memory, work, radiation, force):
    """Add damping, gyroscopic forces and the force of the moving fluid; keep the latter in `radiation`.

    memory (12,) holds mu and p_m and ends as mu and P; matrices are transposed; work (12,) is room to work in.
    """
    work[:] = 0.0
    _add_product(matrices[1], x, NU, 1.0, work, 0)
    _add_product(matrices[2], delta, 0, 1.0, memory, 6)
    _add_product(matrices[3], delta, 0, -1.0, force, 0)
    _cross(force, 0, x, NU + 3, work, 0)
    _cross(force, 3, x, NU + 3, work, 3)
    _cross(force, 3, x, NU, work, 0)
    for p in range(6):
        radiation[p] = -memory[p]
    _cross(radiation, 0, x, NU + 3, memory, 6)
    _cross(radiation, 3, x, NU + 3, memory, 9)
    _cross(radiation, 3, x, NU_R, memory, 6)
    work[:] = 0.0
    for p in range(3):
        work[p] = x[NU + p] - x[NU_R + p]
    _cross(work, 6, x, NU + 3, work, 0)  # -omega x v_c: the rate of the current in body axes
    _add_product(matrices[2], work, 6, 1.0, radiation, 0)
    for p in range(6):
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
def _slow_rates(x, slow, rate):
    """rate (7,) of mean speed and slow pose, u_m' = (u_r - u_m) / T, z' = v + 2 d w (y - z), v' = w^2 (y - z)."""
    rate[0] = (x[NU_R] - slow[0]) / AVERAGING
    for p in range(3):
        left = x[ETA + (p if p < 2 else 5)] - slow[1 + p]
        rate[1 + p] = slow[4 + p] + 2.0 * SLOW_DAMPING * SLOW_FREQUENCY * left
        rate[4 + p] = SLOW_FREQUENCY * SLOW_FREQUENCY * left


@njit(cache=True, nogil=True, fastmath=FAST)
def run_large(
    dt, frame, matrices, places, output, coupling, source, bands, dense,
    functions, ranges, data, own, laws, table, law_data, signals,
    y, memory, wave, external, row, steps, first, stride, number, origin, out,
):  # fmt: skip
    """Advance `steps` steps; see :class:`ogilvie.sim.large.LargeMotions` for the arrays.

    The memory vector begins with mean speed and slow pose, advanced with the body's stages. For U > 0 the products with
    velocities see the momentum without its steady part A_i1(0) (u_m - U), as in the theory of a uniform stream.
    """
    n_states = SLOW_STATES + places.shape[0] * (output.shape[3] + 2)
    states = memory[SLOW_STATES:n_states].reshape(places.shape[0], output.shape[3] + 2)
    old = np.empty(output.shape[3] + 2)
    rate, a, v, delta = np.empty((4, 6)), np.empty((4, 6)), np.empty((4, 6)), np.empty((4, 6))
    both, radiation, held = np.zeros((2, 24)), np.zeros((4, 6)), np.empty(6)
    mu, force, x, trig, work = np.empty(12), np.empty(6), np.empty(SITUATION), np.empty(4), np.empty(12)
    current = frame[2:5]
    flat_delta, slow, slow_rate = delta.reshape(24), np.empty(SLOW_STATES), np.zeros((4, SLOW_STATES))
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
            situate(t + h, current, x, trig)
            for p in range(SLOW_STATES):
                slow[p] = memory[p] + (h * slow_rate[stage - 1, p] if stage > 0 else 0.0)
            _slow_rates(x, slow, slow_rate[stage])
            x[MEAN_SPEED], x[SLOW], x[SLOW + 1], x[SLOW + 2] = slow[0], slow[1], slow[2], slow[3]
            if stage == 0:
                _sample(laws, table, law_data, number + i, x, memory)
                held[:] = external
                for k in range(table.shape[0]):
                    for p in range(6):
                        held[p] += memory[table[k, 2] + p]
            for p in range(6):
                delta[stage, p] = x[NU_R + p]
                mu[p], mu[6 + p] = both[0, 6 * stage + p], both[1, 6 * stage + p]
                force[p] = held[p]
                a[stage, p] = 0.0
            delta[stage, 0] -= frame[0]
            if stage > 0:  # only these couplings of the stages are not zero
                j = 1 if stage == 2 else 0
                _add_product(coupling[0, stage, j], delta[j], 0, 1.0, mu, 0)
                _add_product(coupling[1, stage, j], delta[j], 0, 1.0, mu, 6)
            if stage == 3:
                _add_product(coupling[0, 3, 2], delta[2], 0, 1.0, mu, 0)
                _add_product(coupling[1, 3, 2], delta[2], 0, 1.0, mu, 6)
            mu[6] -= frame[13] * (slow[0] - frame[0])
            mu[10] -= frame[14] * (slow[0] - frame[0])
            _pose_rate(x, trig, rate[stage])
            add_reference_forces(t + h, frame, matrices[4], wave, row + 2 * i + (stage + 1) // 2, x, trig, work, force)
            _body_forces(matrices, x, delta[stage], mu, work, radiation[stage], force)
            add_kernels(functions, ranges, data, own, x, force)
            _add_product(matrices[0], force, 0, 1.0, a[stage], 0)
        if (first + i) % stride == 0:
            for p in range(6):
                out[written, p], out[written, 6 + p] = y[p], y[6 + p]
                out[written, 12 + p], out[written, 18 + p] = a[0, p], radiation[0, p]
            for p in range(4):
                out[written, 24 + p] = memory[p]
            for k in range(table.shape[0]):
                for p in range(6):
                    out[written, LARGE_COLUMNS + 6 * k + p] = memory[table[k, 2] + p]
            for k in range(signals.shape[0]):
                out[written, LARGE_COLUMNS + 6 * table.shape[0] + k] = memory[signals[k]]
            written += 1
        combine(dt, y, rate, a)
        for p in range(SLOW_STATES):
            middle = slow_rate[1, p] + slow_rate[2, p]
            memory[p] += dt / 6.0 * (slow_rate[0, p] + 2.0 * middle + slow_rate[3, p])
        advance_memory(places, source, bands, dense, flat_delta, old, states)
    return written
