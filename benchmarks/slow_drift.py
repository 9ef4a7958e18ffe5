"""Slow-drift force of one hour at 0.25 s by products of sums, a single FFT and the plain double sum, against the components."""

from collections.abc import Callable
from time import perf_counter

import numpy as np

import ogilvie as og
from benchmarks import Measurement
from ogilvie.hydro.qtf import with_qtf
from ogilvie.loads.harmonics import HarmonicGrid
from ogilvie.loads.quadratic import double_sum, single_fft
from ogilvie.loads.slow_drift import SlowDrift

STEP, TIMES = 0.25, 14_400
COMPONENTS = (100, 300, 1000)
WAYS = ("newman-arithmetic", "newman-geometric", "full")


def vessel() -> object:
    """Return a data set with smooth made-up drift and a full quadratic transfer function of it."""
    w, b = np.linspace(0.2, 2.4, 30), np.radians(np.arange(0, 181, 30))
    M = np.tile(np.eye(6) * 1e6, (len(w), 1, 1))
    around = np.stack([np.cos(b), np.sin(b), np.ones_like(b), np.sin(b), np.cos(b), np.sin(2 * b)], axis=-1)
    D = np.tanh(2 * w[:, None, None] ** 2) * around
    hydro = og.hydro_from_arrays(omega=w, added_mass=M, radiation_damping=M, wave_direction=b, mean_drift=1e5 * D)
    difference = np.subtract.outer(w, w)[:, :, None, None]
    wall = 2.0 - 2.0 * (np.multiply.outer(w, w) / np.add.outer(w**2, w**2))[:, :, None, None]
    return with_qtf(hydro, omega=w, qtf_diff=5e4 * wall * (D[:, None] + D[None]) * np.exp(3j * difference))


def measure() -> list[Measurement]:
    """Return ms for one realisation; the double sum is timed on a part and scaled by the number of times."""
    hydro, rows = vessel(), []
    for n in COMPONENTS:
        omega, rng = np.linspace(0.3, 2.3, n), np.random.default_rng(0)
        A = rng.normal(size=n) * np.exp(2j * np.pi * rng.random(n)) / np.sqrt(n)
        sea = og.Sea(omega=omega, direction=np.full(n, 2.6), amplitude=np.abs(A), phase=np.angle(A))
        pair = [k.ravel() for k in np.indices((n, n))]
        Q = SlowDrift(hydro, "full").qtf(omega[pair[0]], omega[pair[1]], 2.6).reshape(n, n, 6)
        part = STEP * np.arange(max(64, 64_000 // n))
        seconds, notes = {}, {}
        for way in WAYS:
            form, grid = SlowDrift(hydro, way).form(sea), HarmonicGrid(omega, STEP, TIMES)
            seconds[way] = _best(lambda f=form, g=grid, A=A: f.series(g, A * g.phases(0.0)))
            notes[way] = f"{len(form.left)} products"
        seconds["single FFT of paper D"] = _best(lambda A=A, Q=Q: single_fft(A, Q, TIMES))
        notes["single FFT of paper D"] = "equidistant frequencies only"
        plain = _best(lambda A=A, w=omega, Q=Q, t=part: double_sum(A, w, Q, t))
        seconds["double sum"] = plain * TIMES / len(part)
        for way, duration in seconds.items():
            ratio = (None, "") if way == WAYS[0] else (duration / seconds[WAYS[0]], WAYS[0])
            rows.append(Measurement(f"{n} components, {way}", 1e3 * duration, "ms", *ratio, notes.get(way, "")))
    return rows


def _best(function: Callable[[], object]) -> float:
    function()
    times = []
    for _ in range(3):
        begin = perf_counter()
        function()
        times.append(perf_counter() - begin)
    return min(times)
