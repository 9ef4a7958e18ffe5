"""Mesh files of numbered nodes and panels: HAMS (.pnl) and NEMOH (.dat, .nemoh); and WAMIT's plot of panels (*_pan.dat)."""

from pathlib import Path

import numpy as np

from ogilvie.mesh.raw import Faces, RawMesh, TextFile, check_indices, read_text, shown

TRUNCATED = "The file looks truncated; re-export it."


def read_hams(path: Path) -> RawMesh:
    """Return the panels of a HAMS mesh.

    Notes
    -----
    Lines that begin with # or -- are headings. Then: numbers of panels and nodes, X- and Y-symmetry (1: the plane x = 0, y = 0
    is a plane of symmetry); lines `node x y z`; lines `panel corners node1 .. node4`; anticlockwise seen from the fluid.
    """
    text = read_text(path)
    rows = [i for i, line in enumerate(text.lines, start=1) if line.strip() and not line.lstrip().startswith(("#", "--", "!"))]
    if not rows:
        raise text.error(1, "numbers of panels and nodes, X-symmetry, Y-symmetry", "no such line", hint=TRUNCATED)
    n_panels, n_nodes, isx, isy = text.integers(rows[0], 4, "numbers of panels and nodes, X-symmetry, Y-symmetry")
    if n_panels < 1 or n_nodes < 3 or isx not in (0, 1) or isy not in (0, 1):
        raise text.error(rows[0], "positive numbers of panels and nodes, symmetries 0 or 1", shown(text.lines[rows[0] - 1]))
    if len(rows) != 1 + n_nodes + n_panels:
        expected = f"{n_nodes} nodes and {n_panels} panels ({n_nodes + n_panels} lines)"
        raise text.error(rows[-1], expected, f"{len(rows) - 1} lines", hint=TRUNCATED)
    if not any(line.lstrip().startswith("#") for line in text.lines[rows[-1] :]):
        raise text.error(
            rows[-1], "'#End Definition of Node Relations' after the panels", "the end of the file", hint=TRUNCATED
        )
    nodes = [_node(text, line, number) for number, line in enumerate(rows[1 : n_nodes + 1], start=1)]
    panels = [_numbered_panel(text, line, number) for number, line in enumerate(rows[n_nodes + 1 :], start=1)]
    check_indices(text, panels, rows[n_nodes + 1 :], n_nodes)
    return RawMesh(np.array(nodes), _faces(panels), ("xz",) * isy + ("yz",) * isx)


def read_nemoh(path: Path) -> RawMesh:
    """Return the panels of a NEMOH mesh.

    Notes
    -----
    First line `2 1` (1: y = 0 is a plane of symmetry; 0: none); lines `node x y z` ended by `0 0. 0. 0.`; lines `node1 ..
    node4` ended by `0 0 0 0`; anticlockwise seen from the fluid.
    """
    text = read_text(path)
    two, symmetry = text.integers(1, 2, "'2 0' or '2 1' (symmetry about y = 0)")
    if two != 2 or symmetry not in (0, 1):
        raise text.error(1, "'2 0' or '2 1' (symmetry about y = 0)", shown(text.lines[0]), hint="Is this a NEMOH mesh?")
    nodes: list[list[float]] = []
    line = 2
    while text.integers(line, 1, "a node, or 0 0. 0. 0. after the last one") != [0]:
        nodes.append(_node(text, line, len(nodes) + 1))
        line += 1
    panels: list[list[int]] = []
    first = line + 1
    while True:
        line += 1
        panel = text.integers(line, 4, "four node numbers, or 0 0 0 0 after the last panel")
        if not any(panel):
            break
        panels.append(panel)
    if not panels:
        raise text.error(line, "at least one panel", "none")
    check_indices(text, panels, list(range(first, line)), len(nodes))
    return RawMesh(np.array(nodes), _faces(panels), ("xz",) * symmetry)


def read_tecplot(path: Path) -> RawMesh:
    """Return the panels of a WAMIT plot file (IPLTDAT): Tecplot zones of 2 x 2 points.

    Notes
    -----
    Points are ordered i first: corners 1, 2, 4, 3 of the panel. The file is for pictures: images in a plane of symmetry
    are turned the other way, so :func:`ogilvie.mesh.inspect.heal` has to make the orientation consistent.
    """
    text = read_text(path)
    points: list[list[float]] = []
    line = 1
    while line <= len(text.lines):
        heading = text.lines[line - 1].lower().replace(" ", "")
        if heading.startswith("zone"):
            if "i=2" not in heading or "j=2" not in heading or "f=point" not in heading:
                raise text.error(line, "a zone I=2, J=2, F=POINT", shown(text.lines[line - 1]))
            points += [_point(text, line + k) for k in range(1, 5)]
            line += 4
        elif heading and not heading.startswith(("title", "variables")):
            raise text.error(line, "a line 'zone I=2 J=2 F=POINT'", shown(text.lines[line - 1]))
        line += 1
    if not points:
        raise text.error(len(text.lines), "at least one zone", "none")
    corners: Faces = np.arange(len(points), dtype=np.int64).reshape(-1, 4)
    return RawMesh(np.array(points), corners[:, [0, 1, 3, 2]])


def _point(text: TextFile, line: int) -> list[float]:
    numbers, tail = text.row(line, "x y z")
    if len(numbers) < 3 or tail:
        raise text.error(line, "three numbers x y z", shown(text.lines[line - 1]))
    return numbers[:3]


def _node(text: TextFile, line: int, number: int) -> list[float]:
    (found,) = text.integers(line, 1, f"node {number}")
    numbers, _ = text.row(line, f"node {number}")
    if found != number or len(numbers) < 4:
        raise text.error(line, f"node {number} with x y z", shown(text.lines[line - 1]))
    return numbers[1:4]


def _numbered_panel(text: TextFile, line: int, number: int) -> list[int]:
    found, corners = text.integers(line, 2, f"panel {number}")
    if found != number or corners not in (3, 4):
        raise text.error(line, f"panel {number} with 3 or 4 corners", shown(text.lines[line - 1]))
    panel = text.integers(line, 2 + corners, f"{corners} node numbers of panel {number}")[2:]
    return panel if corners == 4 else [*panel, panel[-1]]


def _faces(panels: list[list[int]]) -> Faces:
    return np.array(panels, dtype=np.int64) - 1
