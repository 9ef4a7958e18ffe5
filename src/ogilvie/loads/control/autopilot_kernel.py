"""The compiled law of the autopilot: layout of its data and memory, and one sample."""

from typing import Any

from numba import njit
from numpy.typing import NDArray

from ogilvie.loads.control.observer import BLOCKS, POSITION, VELOCITY, observer_step
from ogilvie.loads.control.reference import REFERENCE_DATA, heading_reference_step, wrapped
from ogilvie.loads.control.rudder import RUDDER_DATA, rudder_command, rudder_force, rudder_moment, rudder_move
from ogilvie.loads.control.schedule import row_at
from ogilvie.loads.kernel import ETA, NU, NU_R, TIME, load_kernel

Array = NDArray[Any]

#: Data: inertia, damping, gains, period, limit of the moment, switches, number of set-points; then the blocks that follow.
INERTIA, DAMPING, KP, KI, KD, PERIOD, LIMIT, RUDDERED, FILTERED, ROWS, HEAD = range(11)
STEP_MATRIX = BLOCKS * (BLOCKS + 3)
COURSE = HEAD
BLADE = COURSE + REFERENCE_DATA
FILTER = BLADE + RUDDER_DATA
TABLE = FILTER + STEP_MATRIX

#: Memory: 1 after the first sample; set-point; reference and its two derivatives; integral part of the moment (N m); measured
#: heading; estimated heading and rate; moment wanted, made and missing (N m); rudder angle; state of the wave filter.
STARTED, TARGET, REFERENCE, INTEGRAL, MEASURED, ESTIMATE, DEMAND, PRODUCED, SHORTFALL, RUDDER, OBSERVER, MEMORY = (
    0, 1, 2, 5, 6, 7, 9, 10, 11, 12, 13, 13 + BLOCKS,
)  # fmt: skip


@njit(cache=True, nogil=True)
def _estimate(x: Array, data: Array, memory: Array) -> None:
    """Write heading (continuous, measured or filtered) and yaw rate to the memory."""
    if memory[STARTED] == 0.0:
        memory[MEASURED] = x[ETA + 5]
        memory[OBSERVER + POSITION] = x[ETA + 5]
    old = memory[MEASURED : MEASURED + 1].copy()
    memory[MEASURED] += wrapped(x[ETA + 5] - memory[MEASURED])
    memory[ESTIMATE], memory[ESTIMATE + 1] = memory[MEASURED], x[NU + 5]
    if data[FILTERED] == 0.0:
        return
    state = memory[OBSERVER:MEMORY]
    if memory[STARTED] != 0.0:
        new, made = memory[MEASURED : MEASURED + 1], memory[PRODUCED : PRODUCED + 1]
        observer_step(data[FILTER:TABLE], 1, state, old, new, made)
    memory[ESTIMATE], memory[ESTIMATE + 1] = state[POSITION], state[VELOCITY]


@njit(cache=True, nogil=True)
def _act(x: Array, data: Array, memory: Array, force: Array) -> None:
    """Make what can be made of the moment wanted: by the rudder, or directly."""
    force[:] = 0.0
    if data[RUDDERED] == 0.0:
        made = min(max(memory[DEMAND], -data[LIMIT]), data[LIMIT])
        force[5] = made
    else:
        blade, u = data[BLADE:FILTER], x[NU_R]
        memory[RUDDER] = rudder_move(blade, memory[RUDDER], rudder_command(blade, memory[DEMAND], u))
        rudder_force(blade, memory[RUDDER], x[NU_R : NU_R + 6], force)
        made = rudder_moment(blade, memory[RUDDER], u)
    memory[PRODUCED] = made
    memory[SHORTFALL] = memory[DEMAND] - made


@load_kernel
def autopilot(x, data, memory, force):
    """One sample of the heading control."""
    _estimate(x, data, memory)
    psi, r = memory[ESTIMATE], memory[ESTIMATE + 1]
    reference = memory[REFERENCE : REFERENCE + 3]
    if memory[STARTED] == 0.0:
        reference[0] = psi
    else:
        heading_reference_step(data[COURSE:BLADE], reference, memory[TARGET])
    table = data[TABLE:]
    memory[TARGET] = table[row_at(table, int(data[ROWS]), 1, x[TIME])]
    memory[STARTED] = 1.0
    error = wrapped(reference[0] - psi)
    feedforward = data[INERTIA] * reference[2] + data[DAMPING] * reference[1]
    memory[DEMAND] = feedforward + data[KP] * error + data[KD] * (reference[1] - r) + memory[INTEGRAL]
    _act(x, data, memory, force)
    growth = data[PERIOD] * data[KI] * error
    if growth * memory[SHORTFALL] <= 1e-9 * abs(growth * memory[DEMAND]):
        memory[INTEGRAL] += growth
