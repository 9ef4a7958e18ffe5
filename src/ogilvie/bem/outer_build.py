"""Computes the data of the outer domain that the package ships: python -m ogilvie.bem.outer_build [FILE]."""

import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.atomic import write_whole
from ogilvie.bem.outer import DATA
from ogilvie.bem.outer_fit import fitted
from ogilvie.bem.outer_initial import initial_memory
from ogilvie.bem.outer_map import MULTIPOLES, outer_map
from ogilvie.bem.outer_oscillators import solved
from ogilvie.bem.outer_short_waves import short_waves

Array = NDArray[Any]

MODES, FUNCTIONS, OSCILLATORS = 23, 16, 28


def frequencies() -> tuple[Array, Array, Array]:
    """Return the frequencies of the multipoles (the low ones, where m = 0 is logarithmic, and the waves), of short waves for
    which more multipoles are needed, and those that are beyond multipoles.
    """
    waves = np.concatenate([np.geomspace(0.001, 0.4, 32), np.arange(0.45, 7.0, 0.08), np.geomspace(7.0, 19.0, 20)])
    return waves, np.linspace(20.0, 34.0, 16), np.geomspace(36.0, 300.0, 14)


def exact(m: int, count: int) -> tuple[Array, Array, Array, Array]:
    """Return frequencies (f,) from zero on, N_inf (J, J), L = N - N_inf at them (f, J, J), and K(0+) (J, J)."""
    waves, short, beyond = frequencies()
    sea, finer, initial = outer_map(m, count), outer_map(m, count, multipoles=2 * MULTIPOLES), initial_memory(m, count)
    N_inf = finer.at_infinity
    L = np.array([finer.at_zero + 0j] + [sea.at(w) for w in waves] + [finer.at(w) for w in short]) - N_inf
    L_beyond = short_waves(m, short, L[-len(short) :], initial, beyond)
    return np.concatenate([[0.0], waves, short, beyond]), N_inf, np.concatenate([L, L_beyond]), initial


def build_mode(m: int, *, count: int = FUNCTIONS, oscillators: int = OSCILLATORS) -> dict[str, Array]:
    """Return what is stored of one azimuthal mode, and the largest error over the largest entry of N - N_inf."""
    omega, N_inf, L, initial = exact(m, count)
    w, b, d = fitted(omega, L, initial, oscillators)
    order = np.argsort(w)
    error = np.abs(b.T @ solved(w, b, d, omega) - L).max() / np.abs(L).max()
    return {
        "instantaneous": N_inf,
        "inputs": b[order],
        "dampers": d[order],
        "frequencies": w[order],
        "error": np.array(error),
    }


def main(path: Path) -> None:
    """Compute all modes and write them."""
    modes = []
    for m in range(MODES):
        start = time.perf_counter()
        modes.append(build_mode(m))
        print(f"m = {m:2d}: error {modes[-1]['error']:.1e}, {time.perf_counter() - start:.0f} s", flush=True)
    arrays: dict[str, Any] = {name: np.array([mode[name] for mode in modes]) for name in modes[0]}
    write_whole(path, lambda file: np.savez_compressed(file, **arrays))
    print(f"{path}: {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_name(DATA))
