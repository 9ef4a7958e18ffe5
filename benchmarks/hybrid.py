"""The hybrid time-domain method on the hemisphere of Guo et al.: set-up and run to t = 40 (r/g)^1/2, with and without symmetry.

The Green function alone, too: values with gradient per second as scattered points and as histories of pairs of panels.
"""

from collections.abc import Callable
from time import perf_counter

import numpy as np

from benchmarks import Measurement
from ogilvie.bem.flat_panels import FlatPanels
from ogilvie.bem.plain import plain_hybrid
from ogilvie.bem.plain_boundary import FlatBoundary, hemisphere_boundary
from ogilvie.bem.plain_matrices import histories
from ogilvie.bem.transient_green import transient_green

DURATION, DT = 40.0, 0.1
EVEN = np.array([[1, 1]])


def boundaries() -> dict[str, FlatBoundary]:
    """Return 260 + 400 + 300 panels as a quarter, a half and a whole."""
    quarter = hemisphere_boundary(1.0, 5.0, around=20, rings=(13, 20, 15))
    whole = quarter.expanded()
    half = [FlatPanels(p.corners[p.centers[:, 1] > 0.0], symmetry="xz") for p in (whole.hull, whole.free, whole.control)]
    return {"two planes": quarter, "one plane": FlatBoundary(*half), "none": whole}


def measure() -> list[Measurement]:
    """Return seconds of the plain method in heave, and evaluations of the Green function per second."""
    rows: list[Measurement] = []
    for points in (1, 3):
        base = 0.0
        for name, boundary in boundaries().items():
            if points == 3 and name != "two planes":
                continue
            set_up, run, bytes_ = plain(boundary, points)
            base = base or set_up + run
            ratio = (None, "") if name == "two planes" else ((set_up + run) / base, "two planes")
            title = f"plain, symmetry: {name}, {points} x {points} points"
            note = f"set-up {set_up:.2f} s, run {run:.2f} s, {bytes_ / 1e6:.0f} MB"
            rows.append(Measurement(title, set_up + run, "s", *ratio, note))
    return rows + green()


def plain(boundary: FlatBoundary, points: int) -> tuple[float, float, int]:
    """Return seconds of set-up and of the steps, and bytes, for heave."""
    plain_hybrid(boundary, duration=1.0, dt=DT, dofs=("heave",), points=points, rho=1.0, g=1.0)  # compile
    result = plain_hybrid(boundary, duration=DURATION, dt=DT, dofs=("heave",), points=points, rho=1.0, g=1.0)
    s = result.seconds
    return s["rankine"] + s["green"], s["run"], sum(result.storage.values())


def green() -> list[Measurement]:
    """Return evaluations of value and gradient per second."""
    rng = np.random.default_rng(0)
    x, xi = rng.normal(size=(2, 200_000, 3))
    x[:, 2], xi[:, 2] = -np.abs(x[:, 2]), -np.abs(xi[:, 2])
    t = rng.uniform(0.0, 40.0, len(x))
    scattered = len(x) / _best(lambda: transient_green(x, xi, t, g=1.0))
    control = boundaries()["two planes"]
    n, steps = control.counts[0], round(DURATION / DT)
    pairs = 4 * n * n * steps / _best(lambda: histories(control, EVEN, g=1.0, step=DT, steps=steps, points=1))
    return [
        Measurement("Green function with gradient, scattered", scattered, "1/s"),
        Measurement("Green function with gradient, histories of pairs", pairs, "1/s", pairs / scattered, "scattered"),
    ]


def _best(function: Callable[[], object]) -> float:
    function()
    times = []
    for _ in range(3):
        begin = perf_counter()
        function()
        times.append(perf_counter() - begin)
    return min(times)
