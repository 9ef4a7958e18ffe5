"""Surface meshes of CAD programs: STL (trimesh), OBJ and Gmsh MSH (meshio). The only importer of both libraries.

The libraries skip what they do not understand; so the text is checked line by line first, and what they return afterwards.
"""

import warnings
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from ogilvie.errors import FormatError
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.raw import Array, Faces, RawMesh, leading_numbers, read_bytes, read_text, shown

OBJ_KEYWORDS = {"v", "vn", "vt", "vp", "f", "l", "p", "g", "o", "s", "usemtl", "mtllib", "call", "csh"}


def read_stl(path: Path) -> RawMesh:
    """Return the triangles of a binary or text STL file."""
    data = read_bytes(path)
    n = int.from_bytes(data[80:84], "little") if len(data) >= 84 else -1
    if len(data) != 84 + 50 * n:
        n = _check_text_stl(path, data)
    if n < 1:
        raise FormatError(f"{path.name}: triangles expected, none found.")

    def load() -> Any:
        import trimesh

        return trimesh.load(BytesIO(data), file_type="stl", process=False, force="mesh")

    solid = _guarded(path, load)
    faces = np.asarray(solid.faces, dtype=np.int64)
    if len(faces) != n:
        raise FormatError(f"{path.name}: {n} triangles expected, {len(faces)} found. The file looks damaged; re-export it.")
    return _raw(path, np.asarray(solid.vertices, dtype=float), [faces])


def read_obj(path: Path) -> RawMesh:
    """Return the triangles and quadrilaterals of a Wavefront OBJ file."""
    text = read_text(path)
    for line, content in enumerate(text.lines, start=1):
        words = content.split("#")[0].split()
        if words and words[0] not in OBJ_KEYWORDS:
            raise text.error(line, "an OBJ keyword (v, f, ...)", shown(content))
        if words and words[0] == "v" and (len(words) != 4 or len(leading_numbers(" ".join(words[1:]))[0]) != 3):
            raise text.error(line, "v x y z", shown(content))
        if words and words[0] == "f" and len(words) not in (4, 5):
            raise text.error(line, "a triangle or quadrilateral", f"{len(words) - 1} corners", hint="Export with triangles.")

    def load() -> Any:
        import meshio

        return meshio.read(path, file_format="obj")

    return _from_meshio(path, load)


def read_msh(path: Path) -> RawMesh:
    """Return the triangles and quadrilaterals of a Gmsh file (formats 2.2 and 4, text and binary)."""
    data = read_bytes(path)
    for section in (b"MeshFormat", b"Nodes", b"Elements"):
        if b"$" + section not in data or b"$End" + section not in data:
            raise FormatError(
                f"{path.name}: sections $MeshFormat, $Nodes and $Elements with their ends expected, "
                f"${section.decode()} .. $End{section.decode()} not found. The file looks truncated; re-export it."
            )

    def load() -> Any:
        import meshio

        return meshio.read(path, file_format="gmsh")

    return _from_meshio(path, load)


def stl_bytes(mesh: PanelMesh) -> bytes:
    """Return the whole hull as a binary STL file: triangles, single precision, panels without area left out."""
    import trimesh

    from ogilvie.mesh.integrals import triangle_area_vectors, triangles

    hull = mesh.full()
    tri = triangles(hull.faces)
    tri = tri[np.linalg.norm(triangle_area_vectors(hull.vertices, tri), axis=1) > 0.0]
    data = trimesh.Trimesh(hull.vertices, tri, process=False).export(file_type="stl")
    return data if isinstance(data, bytes) else str(data).encode("ascii")


def _check_text_stl(path: Path, data: bytes) -> int:
    """Return the number of triangles of a text STL file after looking at every line of it."""
    if not data.lstrip()[:5].lower() == b"solid":
        raise FormatError(
            f"{path.name}: an STL file expected (binary: 84 + 50 n bytes; text: begins with 'solid'), {len(data)} bytes found "
            f"that are neither. The file looks truncated; re-export it."
        )
    text = read_text(path)
    words = [line.lower().split() for line in text.lines]
    vertices = facets = 0
    for line, row in enumerate(words, start=1):
        if row[:1] == ["vertex"]:
            vertices += 1
            if len(row) != 4 or len(leading_numbers(" ".join(row[1:]))[0]) != 3:
                raise text.error(line, "vertex x y z", shown(text.lines[line - 1]))
        elif row[:1] == ["facet"]:
            facets += 1
        elif row and row[0] not in ("solid", "endsolid", "endfacet", "outer", "endloop"):
            raise text.error(line, "an STL keyword", shown(text.lines[line - 1]))
    ends = [sum(row[:1] == [word] for row in words) for word in ("endfacet", "solid", "endsolid")]
    if vertices != 3 * facets or ends[0] != facets or ends[1] != ends[2]:
        found = f"{facets} facets, {ends[0]} endfacets, {vertices} vertices, {ends[1]} solids, {ends[2]} endsolids"
        raise text.error(len(words), "'facet', three 'vertex', 'endfacet' each, 'endsolid' at the end", found)
    return facets


def _from_meshio(path: Path, load: Callable[[], Any]) -> RawMesh:
    content = _guarded(path, load)
    blocks = []
    for cells in content.cells:
        if cells.type in ("triangle", "quad"):
            blocks.append(np.asarray(cells.data, dtype=np.int64))
        elif cells.type not in ("vertex", "line"):
            raise FormatError(f"{path.name}: triangles and quadrilaterals of first order expected, {cells.type!r} found.")
    return _raw(path, np.asarray(content.points, dtype=float), blocks)


def _raw(path: Path, points: Array, blocks: list[Faces]) -> RawMesh:
    faces = [block if block.shape[1] == 4 else block[:, [0, 1, 2, 2]] for block in blocks if block.ndim == 2 and len(block)]
    if not faces or points.ndim != 2 or points.shape[1] != 3:
        raise FormatError(f"{path.name}: points in space and panels expected, {len(faces)} blocks of panels found.")
    panels = np.concatenate(faces)
    if panels.min() < 0 or panels.max() >= len(points):
        raise FormatError(
            f"{path.name}: corners among points 1..{len(points)} expected, {panels.min() + 1}..{panels.max() + 1} found."
        )
    if not np.all(np.isfinite(points)):
        raise FormatError(f"{path.name}: finite coordinates expected, NaN or infinity found. Re-export the file.")
    return RawMesh(points, panels)


def _guarded(path: Path, load: Callable[[], Any]) -> Any:
    """Return what a library reads; any failure of it is a FormatError (meshio even ends the program with SystemExit)."""
    import contextlib
    import io

    try:
        with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            warnings.simplefilter("ignore")
            return load()
    except (Exception, SystemExit) as error:
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise FormatError(f"{path.name}: a readable {path.suffix} mesh expected; reading failed: {reason}.") from error
