"""WAMIT's numeric files as dimensionless arrays: grids complete, no row twice, amplitude and phase true to the parts."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.qtf import SYMMETRIC_WITHIN
from ogilvie.hydro.wamit_text import Array, Table, fail, read_table

ComplexArray = NDArray[np.complex128]
IntArray = NDArray[np.intp]

N_MODES = 6  # rigid-body modes of one body
TRUNCATED = "The file looks truncated or a line was lost; re-export it."
ONE_BODY = "Several bodies and generalized modes are not read by this version; export one rigid body."


@dataclass(frozen=True, eq=False)
class Radiation:
    """Added mass and damping of a `.1` file: first column (n,), the modes in it (from 1), A and B (n, 6, 6)."""

    path: Path
    axis: Array
    modes: tuple[int, ...]
    added_mass: Array
    damping: Array


@dataclass(frozen=True, eq=False)
class Response:
    """Complex amplitudes (n_frequency, n_direction, n_mode) of a `.3`, `.3fk`, `.3sc` or `.4` file; directions in degrees."""

    path: Path
    axis: Array
    directions: Array
    modes: tuple[int, ...]
    values: ComplexArray


@dataclass(frozen=True, eq=False)
class Drift:
    """Mean drift (n_frequency, n_pair, n_mode) of a `.7`, `.8` or `.9` file; negative modes are about the moving origin."""

    path: Path
    axis: Array
    pairs: Array
    modes: tuple[int, ...]
    values: ComplexArray


@dataclass(frozen=True, eq=False)
class Quadratic:
    """Second-order transfer functions (n_frequency, n_frequency, n_pair, n_mode) of a `.12d` or `.12s` file; NaN: not given."""

    path: Path
    axis: Array
    pairs: Array
    modes: tuple[int, ...]
    values: ComplexArray
    filled: int = 0  # pairs of frequencies of which the other half was printed


def radiation(path: Path) -> Radiation:
    """Read a `.1` file: period, i, j, A_ij and, at finite frequency, B_ij. Couplings that never occur are zero by symmetry."""
    table = read_table(path, widths=(4, 5))
    column, damping = (
        table.values[:, 0],
        table.values[:, 4] if table.values.shape[1] > 4 else np.full(len(table.widths), np.nan),
    )
    special = (column <= 1e-9) & ((np.abs(column) <= 1e-9) | (np.abs(column + 1) <= 1e-9))
    for row in _rows(special & (np.nan_to_num(damping) != 0.0)):
        table.fail(row, "no damping at zero or infinite frequency", f"{damping[row]:g}", "Check the first column.")
    for row in _rows(~special & (column <= 0.0)):
        table.fail(row, "a positive first column, 0 or -1", f"{column[row]:g}", "The line is damaged; re-export the file.")
    for row in _rows(~special & np.isnan(damping)):
        table.fail(row, "5 columns at finite frequency", "4", TRUNCATED)
    i, j = _modes(table, 1), _modes(table, 2)
    axis, f = np.unique(column, return_inverse=True)
    coupling = (i - 1) * N_MODES + (j - 1)
    _refuse_duplicates(table, f * N_MODES**2 + coupling)
    given = np.zeros((len(axis), N_MODES**2), dtype=bool)
    given[f, coupling] = True
    _check_couplings(table, axis, f, given)
    A, B = np.zeros((2, len(axis), N_MODES**2))
    A[f, coupling], B[f, coupling] = table.values[:, 3], np.nan_to_num(damping)
    shape = (len(axis), N_MODES, N_MODES)
    return Radiation(path, axis, tuple(np.unique(i).tolist()), A.reshape(shape), B.reshape(shape))


def response(path: Path) -> Response:
    """Read a table of period, direction, mode, amplitude, phase, real and imaginary part."""
    table = read_table(path, widths=(7,))
    mode = _modes(table, 2)
    _positive(table, 0)
    _check_polar(table, 3, mode)
    axis, f = np.unique(table.values[:, 0], return_inverse=True)
    directions, b = np.unique(table.values[:, 1], return_inverse=True)
    modes, m = np.unique(mode, return_inverse=True)
    values = _grid(table, (f, b, m), (axis, directions, modes), _complex(table, 5), names=("frequency", "direction", "mode"))
    return Response(path, axis, directions, tuple(modes.tolist()), values)


def drift(path: Path) -> Drift:
    """Read a table of period, two directions, mode (negative: about the moving origin), amplitude, phase, real, imaginary."""
    table = read_table(path, widths=(8,))
    mode = _modes(table, 3, signed=True)
    _positive(table, 0)
    _check_polar(table, 4, mode)
    axis, f = np.unique(table.values[:, 0], return_inverse=True)
    pairs, p = np.unique(table.values[:, 1:3], axis=0, return_inverse=True)
    modes, m = np.unique(mode, return_inverse=True)
    keys, axes = (f, p.ravel(), m), (axis, pairs, modes)
    values = _grid(table, keys, axes, _complex(table, 6), names=("frequency", "pair of directions", "mode"))
    return Drift(path, axis, pairs, tuple(modes.tolist()), values)


def quadratic(path: Path, *, difference: bool) -> Quadratic:
    """Read a `.12d` or `.12s` file: two periods, two directions, mode, amplitude, phase, real, imaginary.

    Notes
    -----
    The half that is not printed follows from Q_diff(2, 1) = conj Q_diff(1, 2) and Q_sum(2, 1) = Q_sum(1, 2), frequencies and
    directions exchanged together. Where both halves are printed they have to agree. Pairs that are in neither half are NaN.
    """
    table = read_table(path, widths=(9,))
    mode = _modes(table, 4)
    _positive(table, 0)
    _positive(table, 1)
    _check_polar(table, 5, mode)
    axis, both = np.unique(table.values[:, :2], return_inverse=True)
    f1, f2 = both.reshape(-1, 2).T
    pairs = np.unique(np.vstack([table.values[:, 2:4], table.values[:, 3:1:-1]]), axis=0)
    given = [tuple(pair) for pair in table.values[:, 2:4].tolist()]
    place = {tuple(pair): k for k, pair in enumerate(pairs.tolist())}
    mirror = np.array([place[(b, a)] for a, b in pairs.tolist()], dtype=np.intp)
    p = np.array([place[pair] for pair in given], dtype=np.intp)
    modes, m = np.unique(mode, return_inverse=True)
    shape = (len(axis), len(axis), len(pairs), len(modes))
    if np.prod(shape, dtype=float) > max(1e6, 64.0 * len(given)):
        fail(path, "a grid of frequencies and directions", f"{len(given)} rows scattered over {shape}", "The file is damaged.")
    _refuse_duplicates(table, np.ravel_multi_index((f1, f2, p, m), shape))
    _check_modes_complete(table, np.ravel_multi_index((f1, f2, p), shape[:3]), len(modes))
    values = np.full(shape, np.nan + 0j)
    values[f1, f2, p, m] = _complex(table, 7)
    other = values.swapaxes(0, 1)[:, :, mirror]
    other = other.conj() if difference else other
    _check_halves(table, values, other, (f1, f2, p, m))
    missing = np.isnan(values) & ~np.isnan(other)
    filled = int(missing.any(axis=(2, 3)).sum())
    return Quadratic(path, axis, pairs, tuple(modes.tolist()), np.where(missing, other, values), filled)


def hydrostatics(path: Path) -> Array:
    """Read a `.hst` file: the 6 x 6 restoring coefficients, every one of them."""
    table = read_table(path, widths=(3,))
    i, j = _modes(table, 0), _modes(table, 1)
    key = (i - 1) * N_MODES + (j - 1)
    _refuse_duplicates(table, key)
    missing = np.setdiff1d(np.arange(N_MODES**2), key)
    if len(missing):
        place = f"C({missing[0] // N_MODES + 1},{missing[0] % N_MODES + 1})"
        fail(path, f"{N_MODES**2} coefficients", f"{len(key)} ({place} is missing)", TRUNCATED)
    C = np.zeros(N_MODES**2)
    C[key] = table.values[:, 2]
    return C.reshape(N_MODES, N_MODES)


def _modes(table: Table, column: int, *, signed: bool = False) -> IntArray:
    mode = table.integers(column, "a mode")
    size = np.abs(mode) if signed else mode
    bad = np.flatnonzero((size < 1) | (size > N_MODES))
    if len(bad):
        table.fail(int(bad[0]), f"modes 1 to {N_MODES}", f"mode {mode[bad[0]]}", ONE_BODY)
    return mode


def _rows(condition: NDArray[np.bool_]) -> list[int]:
    return np.flatnonzero(condition).tolist()


def _positive(table: Table, column: int) -> None:
    bad = np.flatnonzero(table.values[:, column] <= 0.0)
    if len(bad):
        row = int(bad[0])
        table.fail(row, "a finite positive period or frequency", f"{table.values[row, column]:g}", "Leave such rows out.")


def _complex(table: Table, column: int) -> ComplexArray:
    return table.values[:, column] + 1j * table.values[:, column + 1]


def _check_polar(table: Table, column: int, mode: IntArray) -> None:
    """Compare amplitude and phase (deg) with real and imaginary part: the file's own checksum.

    Where the amplitude is rounding noise WAMIT prints a phase of 90 deg, whatever the parts are.
    """
    amplitude, phase, re, im = table.values[:, column : column + 4].T
    largest = np.zeros(2 * N_MODES + 1)
    np.maximum.at(largest, mode, np.maximum(np.abs(amplitude), np.hypot(re, im)))
    noise = np.maximum(1e-5 * largest[mode], 1e-7 * largest.max())
    wrong = np.abs(amplitude - np.hypot(re, im)) > 2e-3 * np.abs(amplitude) + noise
    turn = np.abs((phase - np.degrees(np.arctan2(im, re)) + 180.0) % 360.0 - 180.0)
    wrong |= (turn > 0.2) & (np.abs(amplitude) > noise)
    if wrong.any():
        row = int(np.argmax(wrong))
        parts = f"{np.hypot(re[row], im[row]):.6e} and {np.degrees(np.arctan2(im[row], re[row])):.4f} deg"
        found = f"{amplitude[row]:.6e} and {phase[row]:.4f} deg"
        table.fail(row, f"amplitude and phase of its parts, {parts},", found, "The line is damaged; re-export the file.")


def _refuse_duplicates(table: Table, key: IntArray) -> None:
    _, first, count = np.unique(key, return_index=True, return_counts=True)
    if np.all(count == 1):
        return
    start = int(first[np.argmax(count > 1)])
    again = int(np.flatnonzero(key == key[start])[1])
    advice = "Two runs may have been joined in one file; keep one."
    table.fail(again, "every entry once", f"the entry of line {table.lines[start]} again", advice)


def _check_couplings(table: Table, axis: Array, f: IntArray, given: NDArray[np.bool_]) -> None:
    """Refuse couplings that some frequencies lack, that lack their mirror, or modes without their diagonal."""
    ever = given.any(axis=0)
    lacking = ever & ~given
    if lacking.any():
        k = int(np.argmax(lacking.any(axis=1)))
        i, j = divmod(int(np.argmax(lacking[k])), N_MODES)
        row = int(np.flatnonzero(f == k)[-1])
        expected = f"{int(ever.sum())} couplings at every frequency"
        table.fail(row, expected, f"none for ({i + 1},{j + 1}) where the first column is {axis[k]:g}", TRUNCATED)
    square = ever.reshape(N_MODES, N_MODES)
    single = square & ~square.T
    if single.any():
        i, j = np.argwhere(single)[0] + 1
        fail(table.path, f"coupling ({j},{i}) beside ({i},{j})", "none", "Couplings are missing; re-export the file.")
    bare = square.any(axis=0) & ~square.diagonal()
    if bare.any():
        i = int(np.argmax(bare)) + 1
        fail(table.path, f"the diagonal ({i},{i}) of a mode that has couplings", "none", "Couplings are missing; re-export.")


def _check_halves(table: Table, values: ComplexArray, other: ComplexArray, keys: tuple[IntArray, ...]) -> None:
    """Refuse two printed halves that contradict each other."""
    size = np.nanmax(np.abs(values), axis=(0, 1, 2), initial=0.0)
    wrong = (np.abs(values - other) > SYMMETRIC_WITHIN * size)[keys]  # False for NaN
    if wrong.any():
        row = int(np.argmax(wrong))
        there = other[tuple(key[row] for key in keys)]
        found = f"{values[tuple(key[row] for key in keys)]:.6e}"
        advice = "Two runs may have been joined; keep one."
        table.fail(row, f"what the other half of the file says, {there:.6e},", found, advice)


def _check_modes_complete(table: Table, key: IntArray, n_modes: int) -> None:
    _, last, count = np.unique(key[::-1], return_index=True, return_counts=True)
    short = np.flatnonzero(count != n_modes)
    if len(short):
        row = len(key) - 1 - int(last[short[0]])
        table.fail(row, f"{n_modes} modes for every pair of frequencies and directions", str(count[short[0]]), TRUNCATED)


def _grid(
    table: Table, keys: Sequence[IntArray], axes: Sequence[NDArray], values: ComplexArray, *, names: Sequence[str]
) -> ComplexArray:
    """Put rows on a full grid, or name the first combination that is missing."""
    shape = tuple(map(len, axes))
    flat = np.ravel_multi_index(tuple(keys), shape)
    _refuse_duplicates(table, flat)
    size = int(np.prod(shape))
    if len(flat) != size:
        ordered = np.sort(flat)
        gaps = np.flatnonzero(ordered != np.arange(len(flat)))
        place = np.unravel_index(int(gaps[0]) if len(gaps) else len(flat), shape)
        missing = ", ".join(f"{name} {axis[k]}" for name, axis, k in zip(names, axes, place, strict=True))
        row = int(np.flatnonzero(keys[0] == place[0])[-1])
        sizes = " x ".join(f"{n} {name}" for n, name in zip(shape, names, strict=True))
        table.fail(row, f"{sizes} = {size} rows", f"{len(flat)} (missing: {missing})", TRUNCATED)
    full = np.empty(shape, dtype=complex)
    full.reshape(-1)[flat] = values
    return full
