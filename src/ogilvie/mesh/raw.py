"""What a mesh file holds before it is a hull, and how its text is scanned: every fault is named with file and line."""

import re
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import FormatError, InputError

Array = NDArray[np.float64]
Faces = NDArray[np.int64]

_NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eEdDqQ][+-]?[0-9]+|[+-][0-9]{3})?"
_FLOAT = re.compile(_NUMBER + r"\Z")
_REPEAT = re.compile(r"([1-9][0-9]?)\*(" + _NUMBER + r")\Z")
_BARE_EXPONENT = re.compile(r"(?<=[0-9.])([+-][0-9]{3})\Z")
_INTEGER = re.compile(r"[+-]?[0-9]{1,12}\Z")


@dataclass(frozen=True, eq=False)
class RawMesh:
    """Panels as a file gives them: points (n, 3) in the file's unit, faces (m, 4), its planes of symmetry, metres per unit."""

    points: Array
    faces: Faces
    planes: tuple[str, ...] = ()
    unit: float = 1.0


@dataclass(frozen=True, eq=False)
class TextFile:
    """Lines of a text file; `path` names it in messages."""

    path: Path
    lines: tuple[str, ...]

    def error(
        self, line: int, expected: str, found: str, *, hint: str = "The file looks damaged; re-export it."
    ) -> FormatError:
        """Return the error that says what was expected in a line (counted from 1) and what was found."""
        return FormatError(f"{self.path.name} line {line}: {expected} expected, {found} found. {hint}")

    def row(self, line: int, expected: str) -> tuple[list[float], str]:
        """Return the numbers that a line (counted from 1) begins with, and the text after them."""
        if line > len(self.lines):
            raise self.error(line, expected, "the end of the file", hint="The file looks truncated; re-export it.")
        return leading_numbers(self.lines[line - 1])

    def integers(self, line: int, count: int, expected: str) -> list[int]:
        """Return the first `count` numbers of a line as integers."""
        self.row(line, expected)
        tokens = self.lines[line - 1].replace(",", " ").split()[:count]
        if len(tokens) < count or not all(_INTEGER.match(t) for t in tokens):
            raise self.error(line, expected, shown(self.lines[line - 1]))
        return [int(t) for t in tokens]


def read_text(path: Path) -> TextFile:
    """Return the lines of a text file.

    Raises
    ------
    InputError
        No such file.
    FormatError
        The file is empty or binary.
    """
    data = read_bytes(path)
    if b"\0" in data:
        raise FormatError(f"{path.name}: a text file expected, binary data found. Is this the mesh and not a result file?")
    text = data.decode("utf-8", errors="replace")
    if not text.strip():
        raise FormatError(f"{path.name}: a mesh expected, an empty file found.")
    return TextFile(path, tuple(re.split(r"\r\n|\n|\r", text.rstrip())))


def read_bytes(path: Path) -> bytes:
    """Return the content of a file; InputError where it cannot be read."""
    try:
        return path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: a readable file expected; {error.strerror or error}.") from error


def leading_numbers(line: str) -> tuple[list[float], str]:
    """Return the numbers at the begin of a line, Fortran forms included, and the rest of it.

    Examples
    --------
    >>> leading_numbers(" 1.5, -2.D-3  2*0. 1.25-101 ! corner")
    ([1.5, -0.002, 0.0, 0.0, 1.25e-101], '! corner')
    >>> leading_numbers("nan 1.0")
    ([], 'nan 1.0')
    """
    tokens = line.replace(",", " ").split() if ",," not in line else []
    values: list[float] = []
    for i, token in enumerate(tokens):
        count, number = 1, token
        if repeat := _REPEAT.match(token):
            count, number = int(repeat[1]), repeat[2]
        value = _fortran_float(number) if _FLOAT.match(number) else float("nan")
        if not isfinite(value):
            return values, " ".join(tokens[i:])
        values += [value] * count
    return values, "" if tokens else line.strip()


def _fortran_float(number: str) -> float:
    text = _BARE_EXPONENT.sub(r"e\1", number) if not re.search("[eEdDqQ]", number) else re.sub("[dDqQ]", "e", number)
    return float(text)


def shown(text: str) -> str:
    """Return a line as it can be shown in a message.

    Examples
    --------
    >>> shown(" 1.0  abc ")
    "'1.0 abc'"
    """
    words = " ".join(text.split())
    return repr(words if len(words) <= 60 else words[:57] + "...") if words else "an empty line"


def check_indices(text: TextFile, faces: list[list[int]], rows: list[int], n_nodes: int) -> None:
    """Raise FormatError where a face names a node outside 1..n_nodes; `rows` are the lines of the faces."""
    for face, line in zip(faces, rows, strict=True):
        if min(face) < 1 or max(face) > n_nodes:
            raise text.error(line, f"node numbers 1..{n_nodes}", str(face))
