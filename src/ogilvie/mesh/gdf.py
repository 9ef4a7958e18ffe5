"""WAMIT's geometric data file (GDF), low order: flat panels by their four corners.

Line 1 title; line 2 ULEN GRAV; line 3 ISX ISY (planes of symmetry x = 0 and y = 0); line 4 the number of panels; then the
corners, anticlockwise seen from the fluid. Coordinates are lengths in the unit of GRAV, ULEN only scales WAMIT's results.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.raw import Array, Faces, RawMesh, TextFile, read_text, shown
from ogilvie.units import GRAVITY

FOOT = 0.3048  # m


@dataclass(frozen=True)
class GdfHeader:
    """First four lines of a GDF.

    Parameters
    ----------
    title : str
    ulen : float
        Length that WAMIT's results are scaled with, in the file's unit.
    gravity : float
        In the file's unit of length per s2.
    isx, isy : int
        1: the plane x = 0 (y = 0) is a plane of symmetry.
    n_panels : int
    unit : float
        Length of the file's unit, m: 1 for GRAV about 9.8, 0.3048 for GRAV about 32.2, else nan.
    """

    title: str
    ulen: float
    gravity: float
    isx: int
    isy: int
    n_panels: int
    unit: float


def read_gdf_header(path: str | Path) -> GdfHeader:
    """Return the header of a low-order GDF.

    Raises
    ------
    FormatError
        Not a GDF, or one of higher order.
    """
    return _header(read_text(Path(path)))


def read_gdf(path: Path, *, unit: float | None = None) -> RawMesh:
    """Return the panels of a low-order GDF.

    Parameters
    ----------
    path : Path
    unit : float, optional
        Length of the file's unit, m; None: from GRAV.

    Notes
    -----
    Numbers may be spread over lines in any way as long as there are 12 to a panel. Otherwise each corner needs a line of its
    own: then columns after the third are ignored. Text after the numbers of a line is ignored.
    """
    text = read_text(path)
    header = _header(text)
    if unit is None and not np.isfinite(header.unit):
        raise text.error(2, "GRAV 9.8 (metres) or 32.2 (feet)", f"{header.gravity:g}", hint="Say which unit with unit=.")
    corners = _corners(text, header.n_panels)
    faces: Faces = np.arange(len(corners), dtype=np.int64).reshape(-1, 4)
    planes = ("xz",) * header.isy + ("yz",) * header.isx
    return RawMesh(corners, faces, planes, header.unit if unit is None else unit)


def _header(text: TextFile) -> GdfHeader:
    scales, _ = text.row(2, "ULEN and GRAV")
    if len(scales) < 2 or min(scales[:2]) <= 0.0:
        raise text.error(2, "two positive numbers ULEN GRAV", shown(text.lines[1]))
    isx, isy = text.integers(3, 2, "ISX ISY")
    if isx not in (0, 1) or isy not in (0, 1):
        raise text.error(3, "ISX and ISY 0 or 1", f"{isx} {isy}", hint="Walls (negative values) are not supported.")
    (n,) = text.integers(4, 1, "the number of panels")
    numbers, _ = text.row(4, "the number of panels")
    if len(numbers) > 1 and numbers[1] != 0.0:
        raise text.error(
            4, "a low-order GDF (number of panels alone)", f"NPATCH {n} IGDEF {numbers[1]:g}, a higher-order GDF",
            hint="Let WAMIT write its low-order mesh (ILOWGDF > 0 in the .cfg: *_low.gdf) and load that.",
        )  # fmt: skip
    if n < 1:
        raise text.error(4, "at least one panel", str(n))
    g = scales[1]
    unit = 1.0 if 9.7 < g < 9.9 else FOOT if 32.0 < g < 32.4 else float("nan")
    return GdfHeader(text.lines[0].strip(), scales[0], g, isx, isy, n, unit)


def _corners(text: TextFile, n_panels: int) -> Array:
    """Return the (4 n_panels, 3) corners."""
    rows: list[list[float]] = []
    where: list[int] = []
    rest: list[str] = []
    for line in range(5, len(text.lines) + 1):
        if text.lines[line - 1].strip():
            numbers, tail = text.row(line, "coordinates")
            rows.append(numbers)
            where.append(line)
            rest.append(tail)
    while rows and not rows[-1]:  # words after the last panel
        rows.pop()
    for numbers, line, tail in zip(rows, where, rest, strict=False):
        if not numbers or (tail and len(numbers) < 3):
            raise text.error(line, "numbers (x y z)", shown(text.lines[line - 1]))
    total = sum(map(len, rows))
    if total == 12 * n_panels:
        return np.array([value for numbers in rows for value in numbers]).reshape(-1, 3)
    columns = len(rows[0]) if rows else 0
    if columns > 3 and len(rows) == 4 * n_panels:
        for numbers, line in zip(rows, where, strict=False):
            if len(numbers) != columns:
                raise text.error(line, f"{columns} columns as in line {where[0]}", f"{len(numbers)}")
        return np.array([numbers[:3] for numbers in rows])
    last = where[len(rows) - 1] if rows else 4
    expected = f"{12 * n_panels} coordinates for {n_panels} panels ({4 * n_panels} lines x y z)"
    few = total < 12 * n_panels
    hint = (
        "The file looks truncated; re-export it." if few else "Correct the number of panels in line 4, or re-export the file."
    )
    raise text.error(last, expected, f"{total} in {len(rows)} lines", hint=hint)


def gdf_text(mesh: PanelMesh, *, lid: bool, ulen: float) -> str:
    """Return a mesh as the text of a low-order GDF: stored panels, symmetry as flags, the lid's panels last."""
    parts = [mesh] if not lid or mesh.lid is None else [mesh, mesh.lid]
    corners = np.concatenate([part.vertices[part.faces].reshape(-1, 3) for part in parts])
    title = " ".join(mesh.name.split()).encode("ascii", "replace").decode("ascii")
    isx, isy = int("yz" in mesh.planes), int("xz" in mesh.planes)
    head = [title[:72], f"{ulen:g} {GRAVITY} ULEN GRAV", f"{isx} {isy} ISX ISY", f"{len(corners) // 4}"]
    return "\n".join(head + [f"{x: .9e} {y: .9e} {z: .9e}" for x, y, z in corners + 0.0]) + "\n"
