"""A simulation in progress: all realisations advance block by block, in parallel."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numba import config
from numpy.typing import NDArray

from ogilvie.errors import ConvergenceError, InputError
from ogilvie.hydro.progress import tracked
from ogilvie.hydro.schema import DOFS
from ogilvie.hydro.threads import machine_memory
from ogilvie.sim.engine import Engine, Initial, first_step
from ogilvie.sim.forces import LoadForce
from ogilvie.sim.large import LargeMotions
from ogilvie.sim.large_forces import LargeLoadForce
from ogilvie.sim.scheme import Interval

Array = NDArray[Any]
#: What a recorded row holds in its first 18 columns.
MOTIONS = ("eta", "nu", "acceleration")
_LARGE = np.full(12, 1e9)  # m, rad: beyond this a motion has diverged
_FAR = np.r_[np.full(3, 1e6), np.full(3, 1e2), np.full(6, 1e9)]  # the same for small motions


@dataclass(eq=False)
class Run:
    """A run in progress: it advances all realisations block by block, and after each block the result so far is whole."""

    engine: Engine
    y: Array  # (r, 12)
    memory: Array  # (r, k)
    first: int  # number of the first step on the grid of times that begins at origin
    origin: float
    steps: int
    stride: int
    loads: Sequence[LoadForce | LargeLoadForce]  # whose forces are wanted
    series: dict[str, Array]  # (r, rows, 6), or (r, rows) for the elevation
    begun: Array  # (r, 12), where the run started
    rows: int = 0  # that are done

    @classmethod
    def begin(cls, engine: Engine, initial: Initial, duration: float, stride: int, names: Sequence[str]) -> "Run":
        """Return a run that stands at its initial state, with room for its result."""
        y, memory, time = engine.start(initial)
        first, origin = first_step(time, engine.dt)
        steps = max(1, int(np.ceil(duration / engine.dt - 1e-9)))
        loads = engine.load_forces() if "forces" in names else ()
        wanted = [key for key in MOTIONS if key in names] + [f"force_{f.name}" for f in loads]
        signals = engine.signals if "signals" in names else ()
        shape = (engine.realisations, steps // stride + 1)
        check_memory(shape[0] * shape[1], 6 * len(wanted) + 1 + len(signals))
        series = {key: np.empty((*shape, 6)) for key in wanted}
        series |= {variable: np.empty(shape) for variable, _, _ in signals}
        if "elevation" in names and engine.seaway is not None:
            series["elevation"] = np.empty(shape)
        return cls(engine, y, memory, first, origin, steps, stride, loads, series, y.copy())

    def times(self) -> Array:
        """Times of the rows that are done, s."""
        return self.origin + (self.first + self.stride * np.arange(self.rows)) * self.engine.dt

    def go(self, progress: bool | None) -> KeyboardInterrupt | ConvergenceError | None:
        """Run to the end; return what stopped it before, if anything."""
        number = len(self.y)
        threads = min(number, config.NUMBA_NUM_THREADS)  # type: ignore[attr-defined]
        if isinstance(self.engine.scheme, LargeMotions) and self.engine.scheme.callbacks:
            threads = 1  # Python calls one after the other
        pool = ThreadPoolExecutor(threads) if threads > 1 else None
        try:
            for done, count in tracked(self._blocks(), show=progress, title="simulate"):
                self._block(done, count, pool, 4 * threads)
                self._check(done, count)
        except KeyboardInterrupt as stop:
            if self.rows == 0:
                raise
            return stop
        except ConvergenceError as error:
            return error
        finally:
            if pool is not None:
                pool.shutdown(cancel_futures=True)
        return None

    def _blocks(self) -> list[tuple[int, int]]:
        """Steps done before and steps in each block of wave forces; the step after the last writes the last row."""
        size, end = self.engine.block, self.first + self.steps + 1
        inner = range((self.first // size + 1) * size, end, size)
        edges = [self.first, *inner, end]
        return [(a - self.first, b - a) for a, b in pairwise(edges)]

    def _block(self, done: int, count: int, pool: ThreadPoolExecutor | None, shares: int) -> None:
        """Advance all realisations through a block of wave forces."""
        engine, i = self.engine, self.first + done
        block = i // engine.block
        phases = engine.block_phases(block, self.origin)

        def work(realisations: NDArray[np.intp]) -> None:
            for r in realisations:
                self._advance(int(r), block, phases, i - block * engine.block, done, count)

        everyone = np.arange(len(self.y))
        if pool is None:
            work(everyone)
        else:
            list(pool.map(work, np.array_split(everyone, min(shares, len(everyone)))))

    def _advance(self, r: int, block: int, phases: NDArray[np.complex128], offset: int, done: int, count: int) -> None:
        engine, rows = self.engine, self._rows(done, count)
        wave = engine.wave_series(r, block, self.origin, phases)
        motion = np.empty((rows.stop - rows.start, engine.scheme.columns))
        at = Interval(count, 2 * offset, done, self.stride, self.first + done, self.origin, r)
        engine.scheme.advance(self.y[r], self.memory[r], wave, engine.system.constant, at, motion)
        for i, key in enumerate(MOTIONS):
            if key in self.series:
                self.series[key][r, rows] = motion[:, 6 * i : 6 * i + 6]
        begin, step = 2 * (offset + (-done) % self.stride), 2 * self.stride
        t = self.origin + (self.first + self.stride * np.arange(rows.start, rows.stop)) * engine.dt
        if "elevation" in self.series:
            at_rest = wave[begin : 2 * (offset + count) : step, 6]
            self.series["elevation"][r, rows] = engine.elevation(r, t, motion) if engine.large else at_rest
        for load in self.loads:
            load.fill(motion, wave, begin, step, self.series[f"force_{load.name}"][r, rows], t=t, realisation=r)
        for k, (name, _, _) in enumerate(engine.signals):
            if name in self.series:
                self.series[name][r, rows] = motion[:, engine.scheme.columns - len(engine.signals) + k]

    def _rows(self, done: int, count: int) -> slice:
        """Rows that the steps done, ..., done + count - 1 write."""
        return slice(-(-done // self.stride), -(-(done + count) // self.stride))

    def _check(self, done: int, count: int) -> None:
        """Count the rows of a block as done, up to the first at which a motion has diverged."""
        rows = self._rows(done, count)
        limit = _LARGE if self.engine.large else _FAR
        if np.all(np.abs(self.y) < limit):  # False for NaN
            self.rows = rows.stop
            return
        good = np.ones(rows.stop - rows.start, dtype=bool)
        for key, values in self.series.items():
            part = np.abs(values[:, rows]).reshape(len(self.y), len(good), -1)
            most = limit[:6] if key == "eta" else limit[6:] if key == "nu" else np.inf
            good &= (part < most).all(axis=(0, 2))
        self.rows = rows.start + (good.size if good.all() else int(good.argmin()))
        bad = np.where(np.isfinite(self.y), np.abs(self.y) / limit, np.inf)
        which = int(bad.max(axis=1).argmax())
        why = self._why(which) or "The vessel itself is unstable: check restoring, memory model and damping."
        dof = DOFS[int(bad[which].argmax()) % 6]
        raise ConvergenceError(
            f"simulate: {dof} diverges after {self.times()[-1:].sum():g} s (beyond {limit[0]:g} m or "
            f"{limit[3]:g} rad, or not a number). {why} The error's attribute 'result' holds what was computed before."
        )

    def _why(self, realisation: int) -> str:
        """Return which load the vessel left, from the last good row, or nothing."""
        if not {"eta", "nu"} <= set(self.series):
            return ""
        if self.rows == 0:
            t, y = np.full(2, self.origin + self.first * self.engine.dt), np.stack([self.begun[realisation]] * 2)
            return self.engine.explain(realisation, t, y[:, :6], y[:, 6:])
        last = slice(max(self.rows - 2, 0), self.rows)
        return self.engine.explain(
            realisation, self.times()[last], *(self.series[key][realisation, last] for key in ("eta", "nu"))
        )


def check_memory(rows: int, columns: int) -> None:
    """Refuse a result that does not fit in the machine's memory."""
    need = 8 * rows * columns
    have = machine_memory()
    if need > have:
        raise InputError(
            f"simulate: the result would take {need / 1e9:.3g} GB, this machine has {have / 1e9:.3g} GB. Give a longer "
            "output_step, fewer realisations at a time, or variables without 'forces'."
        )
