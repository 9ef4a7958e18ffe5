"""Tables of numbers that a case file names: columns separated by commas, semicolons or blanks."""

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import FormatError

Array = NDArray[np.float64]


def read_columns(path: Path, *, columns: tuple[int, ...], what: str) -> tuple[Array, ...]:
    """Return the columns of a text table.

    Parameters
    ----------
    path : Path
    columns : tuple of int
        Numbers of columns that are possible, ascending.
    what : str
        What they are, for messages.

    Returns
    -------
    tuple of (n,) array

    Raises
    ------
    FormatError
        No text, a line that is no row of numbers, another number of columns; with the line.

    Notes
    -----
    Lines that are empty or begin with # are passed over, and one heading before the first row of numbers. With semicolons
    between the columns a comma is no decimal sign either.
    """
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError:
        raise FormatError(f"{path.name}: a table as text ({what}) expected, something else found.") from None
    rows: list[list[float]] = []
    heading = False
    for number, line in enumerate(lines, start=1):
        text = line.split("#")[0].strip()
        if not text:
            continue
        words = [w for w in re.split(r"\s*[,;]\s*|\s+", text) if w]
        try:
            row = [float(w) for w in words]
        except ValueError:
            if not rows and not heading:
                heading = True
                continue
            raise FormatError(f"{path.name} line {number}: numbers ({what}) expected, {text[:40]!r} found.") from None
        if len(row) not in columns or (rows and len(row) != len(rows[0])):
            wanted = " or ".join(map(str, columns)) if not rows else str(len(rows[0]))
            raise FormatError(f"{path.name} line {number}: {wanted} columns ({what}) expected, {len(row)} found.")
        if not np.all(np.isfinite(row)):
            raise FormatError(f"{path.name} line {number}: finite numbers expected, {text[:40]!r} found.")
        rows.append(row)
    if not rows:
        raise FormatError(f"{path.name}: rows of numbers ({what}) expected, none found.")
    return tuple(np.array(rows).T.copy())
