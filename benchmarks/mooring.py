"""Compiled mooring forces: a table against the offset and catenary lines, per evaluation of the force."""

from collections.abc import Callable
from time import perf_counter

import numpy as np
from numba import njit

from benchmarks import Measurement
from ogilvie.loads.kernel import ETA, Kernel, situation
from ogilvie.loads.mooring_line import MooringLine
from ogilvie.loads.mooring_lines import CatenaryMooring
from ogilvie.loads.mooring_table import MooringTable

CALLS = 200_000


@njit
def _many(force, x, data, own, calls):
    total = np.zeros(6)
    for i in range(calls):
        x[ETA] = 3.0 * np.sin(0.001 * i)
        x[ETA + 1] = 2.0 * np.cos(0.0013 * i)
        force(x, data, own, total)
    return total


def measure() -> list[Measurement]:
    """Return ns per evaluation of the table, then of moorings with 3 and 8 lines on the ground in part."""
    offset = np.linspace(0.0, 30.0, 31)
    table = _nanoseconds(MooringTable((offset, 5e4 * offset + 80.0 * offset**3)).kernel)
    found = [Measurement("table against the offset", table, "ns")]
    for count in (3, 8):
        time = _nanoseconds(_spread(count).kernel)
        note = f"{time / count:.0f} ns a line, {1e9 / time:.3g} evaluations/s"
        found.append(Measurement(f"{count} catenary lines", time, "ns", time / table, "table", note))
    return found


def _spread(count: int) -> CatenaryMooring:
    lines = []
    for a in 2.0 * np.pi * np.arange(count) / count:
        c, s = np.cos(a), np.sin(a)
        ends = [837.6 * c, 837.6 * s, -200.0], [40.868 * c, 40.868 * s, -14.0]
        lines.append(MooringLine(*ends, length=835.35, weight=1065.7, stiffness=753.6e6, friction=0.5))
    return CatenaryMooring(lines)


def _nanoseconds(kernel: Kernel) -> float:
    x, own = situation(), np.zeros(0)
    run: Callable[[int], object] = lambda calls: _many(kernel.function, x, kernel.data, own, calls)  # noqa: E731
    run(10)
    times = []
    for _ in range(9):
        start = perf_counter()
        run(CALLS)
        times.append(perf_counter() - start)
    return min(times) / CALLS * 1e9
