"""Read and write mesh files; the format follows from the name's ending."""

import os
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from ogilvie.errors import FormatError, InputError
from ogilvie.mesh import cad, gdf, pnl
from ogilvie.mesh.integrals import MIRROR, reversed_faces
from ogilvie.mesh.panels import PanelMesh, Symmetry
from ogilvie.mesh.raw import Array, Faces, RawMesh, read_bytes
from ogilvie.mesh.topology import NORMAL_AXIS, canonical, compact, merge_vertices, with_mirror_image

#: Vertices closer than this part of the mesh's extent are one; panels that close to z = 0 are interior lid panels.
MERGE = 1e-6

READERS: dict[str, Callable[[Path], RawMesh]] = {
    "hams": pnl.read_hams,
    "nemoh": pnl.read_nemoh,
    "tecplot": pnl.read_tecplot,
    "stl": cad.read_stl,
    "obj": cad.read_obj,
    "msh": cad.read_msh,
}
FORMATS = ("gdf", *READERS)
ENDINGS = {".gdf": "gdf", ".pnl": "hams", ".nemoh": "nemoh", ".mar": "nemoh", ".stl": "stl", ".obj": "obj", ".msh": "msh"}


def load_mesh(
    path: str | Path,
    *,
    format: str | None = None,
    unit: float | None = None,
    symmetry: Symmetry | None = None,
    offset: ArrayLike | None = None,
) -> PanelMesh:
    """Return the hull that a mesh file describes, as it is: nothing is turned, closed or clipped.

    Parameters
    ----------
    path : str or Path
    format : {"gdf", "hams", "nemoh", "tecplot", "stl", "obj", "msh"}, optional
        None: from the ending (.gdf, .pnl, .dat, .nemoh, .mar, .stl, .obj, .msh).
    unit : float, optional
        Length of the file's unit, m. None: GDF metres or feet by its GRAV, others metres.
    symmetry : {"none", "xz", "xz+yz"}, optional
        For files that do not say (STL, OBJ, MSH, Tecplot): the planes whose other side the file leaves out.
    offset : (4,) array, optional
        Position x, y, z (m) of the file's origin and heading psi (rad) of its x axis, as WAMIT's XBODY (there in degrees).

    Returns
    -------
    PanelMesh
        Vertices within 1e-6 of the extent of each other are one. The stored part is on the positive side of each plane of
        symmetry. Panels at z = 0 are interior panels and become `lid`, unless there are no others.

    Raises
    ------
    FormatError
        The file is not what it should be; the message names line, expectation and finding.
    InputError
        No such file, unknown format, or an argument out of range.

    See Also
    --------
    ogilvie.mesh.inspect.check_mesh : inward normals, holes, panels above water.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> text = "raft\\n1.0 9.81 ULEN GRAV\\n0 0\\n1\\n 0 0 -1\\n 0 1 -1\\n 1. 1. -1.D0\\n 1 0 -1\\n"
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "raft.gdf")
    ...     _ = path.write_text(text)
    ...     load_mesh(path)
    PanelMesh 'raft': 1 panels (none), 1 x 1 x 0 m, volume 1 m3
    """
    path = Path(path)
    if unit is not None and not (np.isfinite(unit) and unit > 0.0):
        raise InputError(f"unit: a positive length in m expected, {unit!r} found.")
    kind = _format(path, format)
    raw = gdf.read_gdf(path, unit=unit) if kind == "gdf" else READERS[kind](path)
    if symmetry is not None:
        raw = _with_planes(raw, kind, symmetry)
    mesh = _mesh(path, raw, raw.unit if unit is None else unit)
    if offset is not None:
        position = np.asarray(offset, dtype=float)
        if position.shape != (4,) or not np.all(np.isfinite(position)):
            raise InputError(f"offset: four numbers x, y, z (m), psi (rad) expected, {offset!r} found.")
        mesh = mesh.rotated(psi=float(position[3])).translated(position[:3])
    return _with_lid_split_off(mesh)


def write_mesh(mesh: PanelMesh, path: str | Path, *, format: str | None = None, lid: bool = True, ulen: float = 1.0) -> None:
    """Write a mesh to a file, whole or not at all.

    Parameters
    ----------
    mesh : PanelMesh
    path : str or Path
    format : {"gdf", "stl"}, optional
        None: from the ending. GDF keeps the symmetry; STL gets the whole hull, as triangles.
    lid : bool
        GDF: write the interior panels, too.
    ulen : float
        GDF: the length that WAMIT's results are to be scaled with, m.

    Raises
    ------
    InputError
        A format that is not written, or the folder cannot be written to.
    """
    path = Path(path)
    kind = (format or path.suffix.lstrip(".")).lower()
    if kind not in ("gdf", "stl"):
        raise InputError(f"write_mesh: format 'gdf' or 'stl' (or such an ending) expected, {kind!r} found.")
    if not (np.isfinite(ulen) and ulen > 0.0):
        raise InputError(f"write_mesh: a positive ulen in m expected, {ulen!r} found.")
    data = cad.stl_bytes(mesh) if kind == "stl" else gdf.gdf_text(mesh, lid=lid, ulen=ulen).encode("ascii")
    try:
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
            os.replace(temporary, path)
        except BaseException:
            os.unlink(temporary)
            raise
    except OSError as error:
        raise InputError(f"{path}: a file that can be written expected; {error.strerror or error}.") from error


def _format(path: Path, format: str | None) -> str:
    if format is not None:
        if format not in FORMATS:
            raise InputError(f"format: one of {', '.join(FORMATS)} expected, {format!r} found.")
        return format
    ending = path.suffix.lower()
    if ending == ".dat":
        return "tecplot" if read_bytes(path)[:4096].lstrip().lower().startswith((b"zone", b"title", b"variables")) else "nemoh"
    if ending not in ENDINGS:
        raise InputError(f"{path.name}: an ending of {', '.join(ENDINGS)}, .dat expected, {ending!r} found; or give format=.")
    return ENDINGS[ending]


def _with_planes(raw: RawMesh, kind: str, symmetry: str) -> RawMesh:
    if kind in ("gdf", "hams", "nemoh"):
        raise InputError(f"symmetry: no value expected, {symmetry!r} found: {kind} files say their symmetry themselves.")
    planes = {"none": (), "xz": ("xz",), "xz+yz": ("xz", "yz")}
    if symmetry not in planes:
        raise InputError(f"symmetry: 'none', 'xz' or 'xz+yz' expected, {symmetry!r} found.")
    return RawMesh(raw.points, raw.faces, planes[symmetry], raw.unit)


def _mesh(path: Path, raw: RawMesh, unit: float) -> PanelMesh:
    points = raw.points * unit
    tolerance = MERGE * float(np.ptp(points[raw.faces.ravel()], axis=0).max())
    vertices, faces = merge_vertices(points, raw.faces, tolerance=tolerance)
    vertices, faces = compact(vertices, canonical(faces))
    for plane in raw.planes:
        vertices, faces = _positive_side(path, vertices, faces, plane, 10.0 * tolerance)
    if raw.planes == ("yz",):  # symmetry about x = 0 alone is expanded
        vertices, faces = with_mirror_image(vertices, faces, plane="yz", tolerance=tolerance)
    symmetry: Symmetry = "xz+yz" if len(raw.planes) == 2 else "xz" if raw.planes == ("xz",) else "none"
    return PanelMesh(vertices, faces, symmetry=symmetry, name=path.stem)


def _positive_side(path: Path, vertices: Array, faces: Faces, plane: str, tolerance: float) -> tuple[Array, Faces]:
    c = vertices[:, NORMAL_AXIS[plane]]
    letter = "xyz"[NORMAL_AXIS[plane]]
    if c.min() < -tolerance and c.max() > tolerance:
        raise FormatError(
            f"{path.name}: panels on one side of the plane of symmetry {letter} = 0 expected, {letter} from {c.min():.6g} to "
            f"{c.max():.6g} m found. Clear the symmetry flag or leave one side out."
        )
    return (vertices * MIRROR[plane] + 0.0, reversed_faces(faces)) if c.max() <= tolerance else (vertices, faces)


def _with_lid_split_off(mesh: PanelMesh) -> PanelMesh:
    tolerance = MERGE * float(np.ptp(mesh.bounds, axis=0).max())
    at_surface = np.abs(mesh.vertices[:, 2]) <= tolerance
    lid = at_surface[mesh.faces].all(axis=1)
    if not lid.any() or lid.all():
        return mesh
    vertices, faces = compact(mesh.vertices, mesh.faces[lid])
    vertices = vertices * [1.0, 1.0, 0.0]
    interior = PanelMesh(vertices, faces, symmetry=mesh.symmetry, name=f"{mesh.name} lid")
    vertices, faces = compact(mesh.vertices, mesh.faces[~lid])
    return PanelMesh(vertices, faces, symmetry=mesh.symmetry, name=mesh.name, lid=interior)
