"""The hybrid time-domain methods on the hemisphere: set-up and run to t = 40 (r/g)^1/2.

The plain one (Guo et al.: flat panels, transient Green function outside) with and without symmetry; beside it `hybrid_bem`
(curved panels, passive oscillators outside) with as many nodes as the plain one has panels, one unknown each, both using two
planes of symmetry; and with so few nodes that its K33 is about as accurate. Errors are differences from `hybrid_bem` with
resolution 1.6, which is within 0.01 % of the exact K33. `hybrid_bem` always gives all six dofs and an estimate of its
error, for which it solves twice. The Green function alone, too: values with gradient per second as scattered points and as
histories of pairs of panels.
"""

from collections.abc import Callable
from functools import partial
from time import perf_counter
from typing import Any

import numpy as np

from benchmarks import Measurement
from ogilvie.bem.flat_panels import FlatPanels
from ogilvie.bem.hybrid import hybrid_bem
from ogilvie.bem.plain import plain_hybrid
from ogilvie.bem.plain_boundary import FlatBoundary, hemisphere_boundary
from ogilvie.bem.plain_checks import DOFS
from ogilvie.bem.plain_matrices import histories
from ogilvie.bem.transient_green import transient_green
from ogilvie.memory.table import Retardation
from ogilvie.mesh.shapes import hemisphere

DURATION, DT = 40.0, 0.1
EVEN = np.array([[1, 1]])


def boundaries() -> dict[str, FlatBoundary]:
    """Return 260 + 400 + 300 panels as a quarter, a half and a whole."""
    quarter = hemisphere_boundary(1.0, 5.0, around=20, rings=(13, 20, 15))
    whole = quarter.expanded()
    half = [FlatPanels(p.corners[p.centers[:, 1] > 0.0], symmetry="xz") for p in (whole.hull, whole.free, whole.control)]
    return {"two planes": quarter, "one plane": FlatBoundary(*half), "none": whole}


def measure() -> list[Measurement]:
    """Return seconds of both methods, and evaluations of the Green function per second."""
    rows: list[Measurement] = []
    for points in (1, 3):
        base = 0.0
        for name, boundary in boundaries().items():
            if points == 3 and name != "two planes":
                continue
            set_up, run, bytes_ = plain(boundary, points)
            base = base or set_up + run
            ratio = (None, "") if name == "two planes" else ((set_up + run) / base, "two planes")
            title = f"plain, 960 panels, symmetry: {name}, {points} x {points} points"
            note = f"set-up {set_up:.2f} s, run {run:.2f} s, {bytes_ / 1e6:.0f} MB"
            rows.append(Measurement(title, set_up + run, "s", *ratio, note))
    return rows + both() + green()


def plain(boundary: FlatBoundary, points: int) -> tuple[float, float, int]:
    """Return seconds of set-up and of the steps, and bytes, for heave."""
    plain_hybrid(boundary, duration=1.0, dt=DT, dofs=("heave",), points=points, rho=1.0, g=1.0)  # compile
    result = plain_hybrid(boundary, duration=DURATION, dt=DT, dofs=("heave",), points=points, rho=1.0, g=1.0)
    s = result.seconds
    return s["rankine"] + s["green"], s["run"], sum(result.storage.values())


def both() -> list[Measurement]:
    """Return seconds of both methods with their errors of K33."""
    reference = hybrid_bem(hemisphere(1.0), duration=DURATION, dt=DT, resolution=1.6, rho=1.0, g=1.0)
    rows, seconds = [], {}
    for title, settings in HYBRID.items():
        call = partial(hybrid_bem, hemisphere(1.0), duration=DURATION, dt=DT, rho=1.0, g=1.0, **settings)
        found, seconds[title] = call(), best(call, 2)
        rows.append(Measurement(f"hybrid_bem, {title}, six dofs", seconds[title], "s", note=words(found, reference)))
    meshes = {960: boundaries()["two planes"], 1792: hemisphere_boundary(1.0, 5.0, around=28, rings=(17, 27, 20))}
    for panels, points, dofs, others in PLAIN:
        settings = {"duration": DURATION, "dt": DT, "rho": 1.0, "g": 1.0, "dofs": dofs, "points": points}
        plain_call = partial(plain_hybrid, meshes[panels], **settings)
        note, taken = words(plain_call().retardation(), reference), best(plain_call, 1)
        title = f"plain, {panels} panels, {points} x {points} points, {'heave' if len(dofs) == 1 else 'six dofs'}"
        rows += [Measurement(title, taken, "s", taken / seconds[other], f"hybrid_bem, {other}", note) for other in others]
    return rows


HYBRID: dict[str, dict[str, Any]] = {
    "no settings, 1792 nodes": {},
    "720 nodes": {"resolution": 0.3, "order": 3},
    "320 nodes": {"resolution": 0.3, "order": 2},
}
#: Panels, points per side for the Green function, dofs, what to compare with: equal count, then equal or better accuracy.
PLAIN: list[tuple[int, int, tuple[str, ...], tuple[str, ...]]] = [
    (1792, 3, ("heave",), ("no settings, 1792 nodes", "720 nodes")),
    (1792, 3, DOFS, ("no settings, 1792 nodes",)),
    (1792, 1, ("heave",), ("no settings, 1792 nodes", "320 nodes")),
    (960, 3, ("heave",), ("320 nodes",)),
]


def words(found: Retardation, reference: Retardation) -> str:
    """Return the largest errors of K33, in words."""
    i, j = found.dofs.index("heave"), reference.dofs.index("heave")
    n = min(len(found.t), len(reference.t))
    error = 100.0 * np.abs(found.K[:n, i, i] - reference.K[:n, j, j]) / reference.K[0, j, j]
    early = found.t[:n] <= 12.0
    return f"K33 within {error[early].max():.2g} % of K(0) to t = 12, {error.max():.2g} % to t = 40"


def green() -> list[Measurement]:
    """Return evaluations of value and gradient per second."""
    rng = np.random.default_rng(0)
    x, xi = rng.normal(size=(2, 200_000, 3))
    x[:, 2], xi[:, 2] = -np.abs(x[:, 2]), -np.abs(xi[:, 2])
    t = rng.uniform(0.0, 40.0, len(x))
    transient_green(x, xi, t, g=1.0)  # compile
    scattered = len(x) / best(lambda: transient_green(x, xi, t, g=1.0))
    control = boundaries()["two planes"]
    n, steps = control.counts[0], round(DURATION / DT)
    pairs = 4 * n * n * steps / best(lambda: histories(control, EVEN, g=1.0, step=DT, steps=steps, points=1))
    return [
        Measurement("Green function with gradient, scattered", scattered, "1/s"),
        Measurement("Green function with gradient, histories of pairs", pairs, "1/s", pairs / scattered, "scattered"),
    ]


def best(function: Callable[[], object], times: int = 3) -> float:
    """Return the shortest time of a call, s."""
    found = []
    for _ in range(times):
        begin = perf_counter()
        function()
        found.append(perf_counter() - begin)
    return min(found)
