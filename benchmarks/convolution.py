"""The memory force as a state space and as a convolution: ratios of time by three ways of writing, and the offline convolution.

The roll decay of validation/paper_a_time: a HYSY201-like hull, 0.01 s, 30 s of memory, beside what Yuan et al. (2017) report.
"""

import importlib.util
import time
from pathlib import Path
from types import ModuleType

import numpy as np

from benchmarks import Measurement
from benchmarks.simulation import memory_model
from ogilvie.memory.convolve import convolve
from ogilvie.memory.table import Retardation

CASE = Path(__file__).parents[1] / "validation" / "paper_a_time" / "case.py"
HISTORY, HISTORY_STEP, MEMORY = 3600.0, 0.05, 60.0  # s, of the offline convolution


def load(path: Path) -> ModuleType:
    """Return a validation case as a module."""
    spec = importlib.util.spec_from_file_location(path.parent.name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def offline() -> Measurement:
    """Return samples per second of one hour of six velocities, all 18 couplings of two blocks."""
    t = np.arange(0.0, MEMORY + HISTORY_STEP / 2, HISTORY_STEP)
    K = Retardation(t, memory_model(np.eye(6)).impulse(t), np.eye(6))
    nu = np.random.default_rng(1).standard_normal((round(HISTORY / HISTORY_STEP), 6))
    best = np.inf
    for _ in range(3):
        begin = time.perf_counter()
        convolve(K, nu, HISTORY_STEP, truncation=MEMORY)
        best = min(best, time.perf_counter() - begin)
    return Measurement("convolve, one hour at 0.05 s, 60 s of memory", len(nu) / best, "samples/s", note="weights included")


def measure() -> list[Measurement]:
    """Return the measurements."""
    case = load(CASE)
    data = case.measure()
    rows = []
    for way, (cim, ssm) in data["seconds"].items():
        rows.append(
            Measurement(f"CIM, {way}", cim, "s / 200 s", cim / ssm, f"SSM, {'compiled' if way == case.WAYS[2] else 'numpy'}")
        )
    compiled = data["seconds"][case.WAYS[2]][1]
    note = f"{data['states']} states, {data['couplings']} couplings"
    rows.append(Measurement("SSM, numpy", data["seconds"][case.WAYS[0]][1], "s / 200 s", note=note))
    rows.append(Measurement("SSM, compiled", compiled, "s / 200 s", note=note))
    published = [("roll decay of 200 s", 30.0, 6.86), ("motions in waves", 10.26 * 60, 22.36)]
    rows += [Measurement(f"CIM as published, {name}", cim, "s", cim / ssm, "SSM as published") for name, cim, ssm in published]
    return [*rows, offline()]
