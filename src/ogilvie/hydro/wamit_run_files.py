"""The files beside WAMIT's tables: what .out, .frc, .gdf, .pot and .cfg say about the run, each on its own."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ogilvie.hydro.wamit_tables import ONE_BODY
from ogilvie.hydro.wamit_text import Array, fail, read_text_lines

_NUMBER = r"([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[EeDd][-+]?[0-9]+)?)(?!\S)"
_OUT_NUMBERS = {
    "g": re.compile(r"Gravity:\s*" + _NUMBER),
    "ulen": re.compile(r"Length scale:\s*" + _NUMBER),
    "rho": re.compile(r"Water density:\s*" + _NUMBER),
}
_DEPTH = re.compile(r"Water depth:\s*(infinite|" + _NUMBER + r")(?!\S)", re.IGNORECASE)
_BODY_ORIGIN = re.compile(rf"XBODY\s*=\s*{_NUMBER}\s*YBODY\s*=\s*{_NUMBER}\s*ZBODY\s*=\s*{_NUMBER}\s*PHIBODY\s*=\s*{_NUMBER}")


@dataclass(frozen=True)
class Given:
    """What one file says; what it does not say is absent."""

    path: Path
    numbers: Mapping[str, float] = field(default_factory=dict)
    origin: tuple[float, float, float, float] | None = None
    matrices: Mapping[str, Array] = field(default_factory=dict)
    volume: float | None = None
    cog: tuple[float, float, float] | None = None
    gyradii: Array | None = None


def read_config(path: Path) -> dict[str, str]:
    """Return the KEY = VALUE pairs of a `.cfg` file, keys in capitals; '!' starts a comment."""
    pairs = (line.split("!")[0].partition("=") for line in read_text_lines(path))
    return {key.strip().upper(): value.strip() for key, sign, value in pairs if sign}


def read_out(path: Path) -> Given:
    """Read the head of a `.out` file: constants, place of the body, volume, centre of gravity, radii of gyration."""
    lines = []
    for line in read_text_lines(path):
        lines.append(line)
        if "Output from" in line:
            break
    text = "\n".join(lines)
    numbers = {key: _float(found[1]) for key, pattern in _OUT_NUMBERS.items() if (found := pattern.search(text))}
    depth = _DEPTH.search(text)
    advice = "The file is truncated or no WAMIT output; complete it, or move it away and give ulen, rho, g, water_depth."
    if "g" not in numbers or "ulen" not in numbers or depth is None:
        fail(path, "lines with Gravity, Length scale and Water depth", "none", advice)
    if "\n" not in text[depth.end() :].rstrip():
        fail(path, "more lines after the one with Water depth", "the end of the file", advice)
    numbers["water_depth"] = np.inf if depth[2] is None else _float(depth[2])
    if "rho" not in numbers and "Water density:" in text:
        fail(path, "a number after Water density", "none", "The line is damaged; repair it.")
    origins = _BODY_ORIGIN.findall(text)
    if not origins and "XBODY" in text:
        fail(path, "XBODY, YBODY, ZBODY, PHIBODY, four numbers,", "others", "The line is damaged; repair it.")
    if len(origins) > 1:
        fail(path, "one body", f"{len(origins)} bodies", ONE_BODY)
    origin = tuple(map(_float, origins[0])) if origins else None
    volume, cog, gyradii = _mass_of_out(lines)
    return Given(path, numbers, origin, {}, volume, cog, gyradii)  # type: ignore[arg-type]


def read_geometry_head(path: Path) -> Given:
    """Read ULEN and GRAV from the second line of a `.gdf` file."""
    lines = read_text_lines(path)
    numbers = leading_numbers(lines[1]) if len(lines) > 1 else []
    if len(numbers) < 2 or numbers[0] <= 0 or numbers[1] <= 0:
        fail(
            path, "ULEN and GRAV, two positive numbers,", repr(lines[1]) if len(lines) > 1 else "nothing", "Repair it.", line=2
        )
    return Given(path, {"ulen": numbers[0], "g": numbers[1]})


def read_potential_control(path: Path) -> Given:
    """Read HBOT and XBODY from a `.pot` file: on one line (form 1), or HBOT first and XBODY after the .gdf (form 2)."""
    lines = read_text_lines(path)
    names = [k for k, line in enumerate(lines) if line.strip().lower().split("!")[0].strip().endswith(".gdf")]
    if len(names) > 1:
        fail(path, "one body", f"{len(names)} geometry files", ONE_BODY, line=names[1] + 1)
    rows = [leading_numbers(line) for line in lines]
    if names:
        depth, place = (
            (rows[1] + [np.nan])[0] if len(rows) > 1 else np.nan,
            rows[names[0] + 1] if len(rows) > names[0] + 1 else [],
        )
    else:
        together = next((row for row in rows[1:6] if len(row) >= 5), [np.nan])
        depth, place = together[0], together[1:5]
    if not np.isfinite(depth) or len(place) < 4:
        fail(path, "HBOT and the four numbers XBODY", "none", "Move the file away and give water_depth.")
    return Given(path, {"water_depth": depth if depth > 0 else np.inf}, tuple(place[:4]))  # type: ignore[arg-type]


def read_force_control(path: Path) -> Given:
    """Read a `.frc` file: of alternative form 2 the density and the matrices, of form 1 nothing that the `.out` lacks.

    Notes
    -----
    Form 2 after the title and the options: RHO; XCG YCG ZCG; then IMASS, IDAMP, ISTIF, each 0 or 1 and followed by a 6 x 6
    matrix if 1: mass, external damping, external stiffness about the body's origin, dimensional.
    """
    lines = read_text_lines(path)
    rows = [leading_numbers(line) for line in lines]
    if len(rows) < 5:
        fail(path, "title, options, density or centre of gravity, ...", f"{len(rows)} lines", "Complete the file.")
    if len(rows[4]) >= 3:
        return Given(path)  # form 1: VCG and radii of gyration; they need the volume and are repeated in the .out file
    if not rows[2] or len(rows[3]) < 3 or not rows[4] or rows[2][0] <= 0:
        fail(path, "alternative form 1 or 2", "another form", "Move the file away and give rho.", line=3)
    if len(rows[3]) > 3:
        fail(path, "the centre of gravity of one body", f"{len(rows[3])} numbers", ONE_BODY, line=4)
    matrices, at = {}, 4
    for key in ("inertia_matrix", "external_damping", "external_stiffness"):
        at = _next_row(path, rows, at, key)
        flag = rows[at][0]
        at += 1
        if flag == 0:
            continue
        if flag != 1:
            fail(path, f"0 or 1 before the matrix {key}", f"{flag:g}", "Use alternative form 2 with one body.", line=at)
        matrix: list[float] = []
        while len(matrix) < 36:
            at = _next_row(path, rows, at, key)
            matrix += rows[at]
            at += 1
        if len(matrix) != 36:
            fail(path, f"36 numbers in the matrix {key}", str(len(matrix)), "Write six numbers a line.", line=at)
        matrices[key] = np.array(matrix).reshape(6, 6)
    return Given(path, {"rho": rows[2][0]}, matrices=matrices)


def _next_row(path: Path, rows: list[list[float]], at: int, key: str) -> int:
    while at < len(rows) and not rows[at]:
        at += 1
    if at == len(rows):
        fail(path, f"the matrix {key}", "the end of the file", "Complete the file.", line=at)
    return at


def _float(word: str) -> float:
    return float(word.replace("D", "E").replace("d", "e"))


def leading_numbers(line: str) -> list[float]:
    """Return the numbers at the start of a line, up to the first word that is none."""
    numbers: list[float] = []
    for word in line.replace(",", " ").split():
        try:
            value = _float(word)
        except ValueError:
            break
        if not np.isfinite(value):
            break
        numbers.append(value)
    return numbers


def _mass_of_out(lines: list[str]) -> tuple[float | None, tuple[float, float, float] | None, Array | None]:
    after = {}
    for k, line in enumerate(lines):
        for mark in ("Volumes (VOLX,VOLY,VOLZ):", "Center of Buoyancy (Xb,Yb,Zb):", "Center of Gravity  (Xg,Yg,Zg):"):
            if mark in line:
                after[mark[:11]] = leading_numbers(line.split(":", 1)[1])
        if "Radii of gyration:" in line:
            block = [leading_numbers(line.split(":", 1)[1]), *(leading_numbers(row) for row in lines[k + 1 : k + 3])]
            after["gyradii"] = [number for row in block for number in row]
    volumes, buoyancy, gravity = (after.get(key, []) for key in ("Volumes (VO", "Center of B", "Center of G"))
    volume = float(np.median(volumes)) if len(volumes) == 3 else None
    if len(gravity) == 1 and len(buoyancy) == 3:  # form 1 prints ZG alone: the body floats with its centre above buoyancy
        gravity = [buoyancy[0], buoyancy[1], gravity[0]]
    cog = (gravity[0], gravity[1], gravity[2]) if len(gravity) == 3 else None
    gyradii = np.array(after.get("gyradii", []))
    return volume, cog, gyradii.reshape(3, 3) if gyradii.shape == (9,) else None
