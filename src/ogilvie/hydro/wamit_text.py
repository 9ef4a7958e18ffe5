"""Numeric text tables as Fortran programs print them: fast to read, and every mistake named with its line."""

import gzip
import re
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import FormatError, InputError

Array = NDArray[np.float64]

_PRINTABLE = np.zeros(256, dtype=bool)
_PRINTABLE[[9, 10, 13, *range(32, 127)]] = True
_NO_EXPONENT_LETTER = re.compile(rb"(?<=[0-9.])([+-][0-9]{3})(?![0-9.])")  # Fortran drops the E of three-digit exponents
_WORD = re.compile(rb"[A-Za-z]{3,}")


@dataclass(frozen=True, eq=False)
class Table:
    """Rows of numbers with the line each came from.

    Parameters
    ----------
    path : Path
        File, for messages.
    values : (n, m) array
        Rows that are shorter than m are filled with NaN.
    widths : (n,) int array
        Numbers found in each row.
    lines : (n,) int array
        Line number of each row, from 1.
    """

    path: Path
    values: Array
    widths: NDArray[np.intp]
    lines: NDArray[np.intp]

    def fail(self, row: int, expected: str, found: str, advice: str) -> NoReturn:
        """Raise :class:`FormatError` for one row."""
        fail(self.path, expected, found, advice, line=int(self.lines[row]))

    def integers(self, column: int, what: str) -> NDArray[np.intp]:
        """Return a column of whole numbers, or name the first row that holds another."""
        values = self.values[:, column]
        bad = np.flatnonzero((values != np.round(values)) | (np.abs(values) > 1e6))
        if len(bad):
            self.fail(
                int(bad[0]), f"{what}, a whole number,", f"{values[bad[0]]:g}", "The line is damaged; re-export the file."
            )
        return values.astype(np.intp)


def fail(path: Path, expected: str, found: str, advice: str, *, line: int | None = None) -> NoReturn:
    """Raise :class:`FormatError` with file, line, what was expected, what was found and what to do."""
    where = f"{path.name} line {line}" if line is not None else path.name
    raise FormatError(f"{where}: {expected} expected, {found} found. {advice}")


def read_bytes(path: Path) -> bytes:
    """Return the content of a file; a name that ends with .gz is decompressed."""
    try:
        if path.suffix.lower() == ".gz":
            with gzip.open(path, "rb") as stream:
                return stream.read()
        return path.read_bytes()
    except (EOFError, gzip.BadGzipFile, zlib.error) as error:
        fail(path, "a complete gzip file", str(error), "Compress the file again.")
    except OSError as error:
        raise InputError(f"{path}: a readable file expected, {error.strerror or error} found. Check the path.") from error


def read_text_lines(path: Path) -> list[str]:
    """Return the lines of a text file, after refusing binary content."""
    raw = read_bytes(path)
    _refuse_binary(path, raw, allow_latin=True)
    return raw.decode("latin-1").splitlines()


def read_table(path: Path, *, widths: Sequence[int]) -> Table:
    """Read a table of numbers whose rows hold one of the allowed counts.

    Parameters
    ----------
    path : Path
        Text file; one header line is allowed.
    widths : sequence of int
        Allowed counts of numbers per row.

    Returns
    -------
    Table

    Raises
    ------
    FormatError
        Binary or empty file, wrong count, a word where a number is expected, Fortran overflow, NaN, a cut last line.

    Notes
    -----
    A file that does not end with a newline and whose last line is shorter than others of its kind has lost characters, perhaps
    digits of an exponent; it is refused although every word of it may still be a number.
    """
    raw = read_bytes(path)
    _refuse_binary(path, raw)
    text = raw.splitlines()
    rows = [line.split() for line in text]
    lines = np.array([k for k, row in enumerate(rows) if row], dtype=np.intp)
    if len(lines) and _is_header(rows[lines[0]], text[lines[0]]):
        lines = lines[1:]
    if len(lines) == 0:
        fail(path, "rows of numbers", "an empty file", "Re-export the file.")
    rows = [rows[k] for k in lines]
    counts = np.array(list(map(len, rows)), dtype=np.intp)
    lines += 1
    _check_widths(path, counts, lines, widths)
    if not raw.endswith((b"\n", b"\r")):
        _check_last_line(path, text, counts, lines)
    flat = _floats(path, rows, lines)
    values = np.full((len(rows), int(counts.max())), np.nan)
    values[np.arange(values.shape[1]) < counts[:, None]] = flat
    return Table(path, values, counts, lines)


def _refuse_binary(path: Path, raw: bytes, *, allow_latin: bool = False) -> None:
    data = np.frombuffer(raw, dtype=np.uint8)
    good = _PRINTABLE[data]
    if allow_latin:
        good = good | (data >= 160)
    if good.all():
        return
    at = int(np.argmin(good))
    line = raw[:at].count(b"\n") + 1
    fail(path, "plain text", f"the byte 0x{raw[at]:02x}", "The file is binary or damaged; re-export it as text.", line=line)


def _is_header(words: list[bytes], line: bytes) -> bool:
    lead = words[0].lower().lstrip(b"+-")
    if lead[:1].isdigit() or lead.startswith((b".", b"*", b"nan", b"inf")):
        return False
    return _WORD.search(line) is not None


def _check_widths(path: Path, counts: NDArray[np.intp], lines: NDArray[np.intp], widths: Sequence[int]) -> None:
    bad = np.flatnonzero(~np.isin(counts, widths))
    if len(bad) == 0:
        return
    k = int(bad[0])
    expected = " or ".join(map(str, widths)) + " columns"
    last = k == len(counts) - 1 and counts[k] < max(widths)
    advice = "The file looks truncated; re-export it." if last else "The line is damaged or belongs to another kind of file."
    fail(path, expected, str(counts[k]), advice, line=int(lines[k]))


def _check_last_line(path: Path, text: list[bytes], counts: NDArray[np.intp], lines: NDArray[np.intp]) -> None:
    alike = np.flatnonzero(counts == counts[-1])
    if len(alike) < 2:
        return
    length, before = len(text[lines[-1] - 1].rstrip()), len(text[lines[alike[-2]] - 1].rstrip())
    if length < before:
        advice = "The file looks truncated; re-export it. If it is complete, end it with a newline."
        fail(path, f"a last line of {before} characters", f"{length} and no newline", advice, line=int(lines[-1]))


def _floats(path: Path, rows: list[list[bytes]], lines: NDArray[np.intp]) -> Array:
    words = list(chain.from_iterable(rows))
    try:
        flat = np.array(list(map(float, words)))
    except ValueError:
        flat = np.array([_float(path, word, int(line)) for row, line in zip(rows, lines, strict=True) for word in row])
    if not np.isfinite(flat).all() or any(b"_" in word for word in words):
        for row, line in zip(rows, lines, strict=True):
            for word in row:
                _float(path, word, int(line))
    return flat


def _float(path: Path, word: bytes, line: int) -> float:
    """Return one number as Fortran prints it, or say what is wrong with it."""
    shown = repr(word.decode("ascii", "replace"))
    if b"*" in word:
        fail(
            path, "a number", f"{shown}, a Fortran overflow,", "Scale the output or use more digits, and re-export.", line=line
        )
    try:
        if b"_" in word:
            raise ValueError
        value = float(_NO_EXPONENT_LETTER.sub(rb"E\1", word.replace(b"D", b"E").replace(b"d", b"e")))
    except ValueError:
        fail(path, "a number", shown, "The line is damaged; re-export the file.", line=line)
    if not np.isfinite(value):
        fail(path, "a finite number", shown, "The solver failed here; exclude this frequency or run it again.", line=line)
    return value
