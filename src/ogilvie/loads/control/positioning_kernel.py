"""The compiled law of dynamic positioning: layout of its data and memory, and one sample."""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.loads.control.allocation import allocate, thrust_force
from ogilvie.loads.control.observer import BLOCKS, POSITION, VELOCITY, planar_observer_step, turn
from ogilvie.loads.control.reference import REFERENCE_DATA, heading_reference_step, reference_step, wrapped
from ogilvie.loads.control.schedule import row_at
from ogilvie.loads.control.thruster import THRUSTER_DATA
from ogilvie.loads.kernel import ETA, NU, TIME, load_kernel

Array = NDArray[Any]

#: Data: period, largest force (3,) without thrusters, number of thrusters, switch of the wave filter, number of set-points,
#: arm; inertia, damping and gains (3, 3) each; then the blocks that follow.
PERIOD, LIMIT, THRUSTERS, FILTERED, ROWS, ARM, M, D, KP, KI, KD, COURSE = 0, 1, 4, 5, 6, 7, 8, 17, 26, 35, 44, 53
FILTER = COURSE + 3 * REFERENCE_DATA
STEP_MATRIX = 3 * BLOCKS * 3 * (BLOCKS + 3)
UNITS = FILTER + STEP_MATRIX

#: Memory, each of three numbers (x, y, heading in the world, or surge, sway, yaw along the vessel): 1 after the first sample;
#: set-point; reference (position, rate, acceleration of x, then y, then heading); integral part of the force, in the world;
#: measured pose; estimated pose and velocity; force wanted, made and missing; state of the wave filter (15,); thrusts (2 n,).
STARTED, TARGET, REFERENCE, INTEGRAL, MEASURED, ESTIMATE, SPEED, DEMAND, PRODUCED, SHORTFALL, OBSERVER, THRUST = (
    0, 1, 4, 13, 16, 19, 22, 25, 28, 31, 34, 34 + 3 * BLOCKS,
)  # fmt: skip


@njit(cache=True, nogil=True)
def _estimate(x: Array, data: Array, memory: Array) -> None:
    """Write pose (heading continuous) and velocity, measured or filtered, to the memory."""
    measured, state = memory[MEASURED : MEASURED + 3], memory[OBSERVER:THRUST]
    pose, speed = memory[ESTIMATE : ESTIMATE + 3], memory[SPEED : SPEED + 3]
    if memory[STARTED] == 0.0:
        measured[0], measured[1], measured[2] = x[ETA], x[ETA + 1], x[ETA + 5]
        state[3 * POSITION : 3 * POSITION + 3] = measured
    old = measured.copy()
    measured[0], measured[1] = x[ETA], x[ETA + 1]
    measured[2] += wrapped(x[ETA + 5] - measured[2])
    if data[FILTERED] == 0.0:
        pose[:] = measured
        speed[0], speed[1], speed[2] = x[NU], x[NU + 1], x[NU + 5]
        return
    if memory[STARTED] != 0.0:
        planar_observer_step(data[FILTER:UNITS], state, old, measured, memory[PRODUCED : PRODUCED + 3])
    pose[:] = state[3 * POSITION : 3 * POSITION + 3]
    speed[:] = state[3 * VELOCITY : 3 * VELOCITY + 3]


@njit(cache=True, nogil=True)
def _reference(x: Array, data: Array, memory: Array) -> None:
    """Advance the reference; it starts where the vessel is."""
    for i in range(3):
        at, course = REFERENCE + 3 * i, COURSE + i * REFERENCE_DATA
        if memory[STARTED] == 0.0:
            memory[at] = memory[ESTIMATE + i]
        elif i == 2:
            heading_reference_step(data[course : course + REFERENCE_DATA], memory[at : at + 3], memory[TARGET + i])
        else:
            reference_step(data[course : course + REFERENCE_DATA], memory[at : at + 3], memory[TARGET + i])
    table = data[UNITS + int(data[THRUSTERS]) * THRUSTER_DATA :]
    row = row_at(table, int(data[ROWS]), 3, x[TIME])
    memory[TARGET : TARGET + 3] = table[row : row + 3]
    memory[STARTED] = 1.0


@njit(cache=True, nogil=True)
def _add_product(data: Array, at: int, vector: Array, out: Array) -> None:
    """Add the (3, 3) matrix that starts at `at` times a vector."""
    for i in range(3):
        for j in range(3):
            out[i] += data[at + 3 * i + j] * vector[j]


@njit(cache=True, nogil=True)
def _act(data: Array, memory: Array, force: Array) -> None:
    """Make what can be made of the force wanted: by the thrusters, or directly."""
    wanted, made, missing = memory[DEMAND : DEMAND + 3], memory[PRODUCED : PRODUCED + 3], memory[SHORTFALL : SHORTFALL + 3]
    n = int(data[THRUSTERS])
    if n == 0:
        force[:] = 0.0
        for i in range(3):
            made[i] = min(max(wanted[i], -data[LIMIT + i]), data[LIMIT + i])
            missing[i] = wanted[i] - made[i]
        force[0], force[1], force[5] = made[0], made[1], made[2]
        return
    units, u = data[UNITS : UNITS + n * THRUSTER_DATA], memory[THRUST : THRUST + 2 * n]
    allocate(units, n, data[ARM], wanted, u, missing)
    thrust_force(units, n, u, force)
    made[0], made[1], made[2] = force[0], force[1], force[5]


@load_kernel
def positioning(x, data, memory, force):
    """One sample of dynamic positioning."""
    _estimate(x, data, memory)
    _reference(x, data, memory)
    psi = memory[ESTIMATE + 2]
    c, s = np.cos(psi), np.sin(psi)
    error, speed, acceleration = np.zeros(3), np.zeros(3), np.zeros(3)
    for i in range(3):
        at = REFERENCE + 3 * i
        error[i], speed[i], acceleration[i] = memory[at] - memory[ESTIMATE + i], memory[at + 1], memory[at + 2]
    error[2] = wrapped(error[2])
    wanted, growth = memory[INTEGRAL : INTEGRAL + 3].copy(), np.zeros(3)
    for part in (error, speed, acceleration, wanted):
        turn(part, c, -s)
    _add_product(data, M, acceleration, wanted)
    _add_product(data, D, speed, wanted)
    _add_product(data, KP, error, wanted)
    _add_product(data, KI, error, growth)
    speed -= memory[SPEED : SPEED + 3]
    _add_product(data, KD, speed, wanted)
    memory[DEMAND : DEMAND + 3] = wanted
    _act(data, memory, force)
    for i in range(3):
        growth[i] *= data[PERIOD]
        if growth[i] * memory[SHORTFALL + i] > 1e-9 * abs(growth[i] * wanted[i]):
            growth[i] = 0.0
    turn(growth, c, s)
    memory[INTEGRAL : INTEGRAL + 3] += growth
