"""Look at a mesh with a critical eye: `check_mesh` reports, `heal` repairs what it lists, `require_usable` refuses."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.integrals import reversed_faces
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.report import Finding, HealReport, MeshReport, Severity
from ogilvie.mesh.topology import (
    NORMAL_AXIS,
    canonical,
    compact,
    consistent_orientation,
    edges,
    merge_vertices,
    open_edges,
    without_t_junctions,
)

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

CLOSE = 1e-6  #: part of the hull's extent below which two vertices are one
WARP = 0.1  #: corner above the panel's mean plane / square root of the area
ASPECT = 50.0  #: longest side squared / area
VOLUMES = 0.01  #: difference of the three volumes / volume
_LONGEST = 1e4  # m; nothing afloat is longer


def check_mesh(mesh: PanelMesh) -> MeshReport:
    """Return what is wrong with a mesh that is to be solved: orientation, water, connections, shape of panels.

    Parameters
    ----------
    mesh : PanelMesh

    Returns
    -------
    MeshReport
        `.ok` if a solver can use the mesh; `print` shows a table.

    Notes
    -----
    Edges in z = 0 and in planes of symmetry may be open. Open edges elsewhere are T-junctions where they run along other
    edges (no hole), else holes.

    Examples
    --------
    >>> v = [[0.0, 0, -1], [2, 0, -1], [2, 1, -1], [0, 1, -1], [0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0]]
    >>> f = [[0, 3, 2, 1], [2, 3, 7, 6], [1, 2, 6, 5], [0, 4, 7, 3]]
    >>> barge = PanelMesh(v, f, symmetry="xz", name="barge")
    >>> check_mesh(barge).ok, check_mesh(barge.flipped())["inward normals"]
    (True, 1)
    >>> print(check_mesh(barge.translated((0.0, 0.0, 0.5))))
    PanelMesh 'barge': 4 panels (xz), 2 x 2 x 1 m, volume 2 m3
      error         3  panels above water  clip with .immersed(), or give the draught: .immersed(draught)
      ...
    """
    findings = [*_position(mesh), *_orientation(mesh), *_connections(mesh), *_panels(mesh), *_lid(mesh)]
    return MeshReport(repr(mesh), tuple(f for f in findings if f.count))


def require_usable(mesh: PanelMesh, *, purpose: str = "hydrostatics") -> None:
    """Raise InputError unless the mesh is a wetted hull with normals into the fluid (quick: no look at connections).

    Parameters
    ----------
    mesh : PanelMesh
    purpose : str
        What the mesh is wanted for; begins the message.

    Examples
    --------
    >>> v = [[0.0, 0, -1], [2, 0, -1], [2, 1, -1], [0, 1, -1], [0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0]]
    >>> f = [[0, 3, 2, 1], [2, 3, 7, 6], [1, 2, 6, 5], [0, 4, 7, 3]]
    >>> require_usable(PanelMesh(v, f, symmetry="xz", name="barge").flipped())
    Traceback (most recent call last):
    ogilvie.errors.InputError: hydrostatics: normals of 'barge' into the fluid expected, normals into the body found ...
    """
    low, high = mesh.bounds[:, 2]
    if low >= -mesh.tolerance:
        raise InputError(
            f"{purpose}: a hull below z = 0 expected, {mesh.name!r} with z from {low:.6g} to {high:.6g} m found. "
            f"Give its draught: .immersed(draught); if its z axis points down, turn it: .rotated(phi=pi)."
        )
    if high > mesh.tolerance:
        n = int((mesh.vertices[mesh.faces, 2] > mesh.tolerance).any(axis=1).sum())
        raise InputError(
            f"{purpose}: no panel above z = 0 expected, {n} of {mesh.name!r} reach up to {high:.6g} m. Use .immersed()."
        )
    size = _orientation_volume(mesh)
    if size < 0.0:
        raise InputError(
            f"{purpose}: normals of {mesh.name!r} into the fluid expected, normals into the body found "
            f"(volume {size:.6g} m3). Use .flipped()."
        )
    if size == 0.0 or mesh.volume <= 0.0:
        raise InputError(f"{purpose}: a hull that encloses water expected, volumes {mesh.volumes} m3 found. See check_mesh().")


def heal(mesh: PanelMesh) -> tuple[PanelMesh, HealReport]:
    """Return the mesh with those faults repaired that have one obvious repair, and the list of what was done.

    Parameters
    ----------
    mesh : PanelMesh

    Returns
    -------
    mesh : PanelMesh
    report : HealReport

    Notes
    -----
    In this order: vertices nearer than 1e-6 of the extent to z = 0 or a plane of symmetry are put on it; vertices that
    near to each other become one; panels without area, and all but one of identical panels, are removed; panels are turned
    to agree with their neighbours; a hull with normals into the body is turned over. Holes, panels above water and warped
    panels are left to the user.

    Examples
    --------
    >>> mesh = PanelMesh([[0.0, 0, -1], [1, 0, -1], [1, 1, -1], [0, 1, -1]], [[0, 1, 2, 3], [0, 3, 2, 1]])
    >>> healed, report = heal(mesh)
    >>> healed.n_faces, report.repairs
    (1, (('identical panels removed', 1),))
    """
    repairs: list[tuple[str, int]] = []
    before = check_mesh(mesh)
    tolerance = _close(mesh)
    vertices, n = _snapped(mesh, tolerance)
    repairs.append(("vertices put on z = 0 or a plane of symmetry", n))
    used = len(np.unique(mesh.faces))
    vertices, faces = merge_vertices(vertices, mesh.faces, tolerance=tolerance)
    repairs.append(("vertices merged", used - len(np.unique(faces))))
    faces = canonical(faces)
    flat = _without_area(vertices, faces)
    repairs.append(("panels without area removed", int(flat.sum())))
    faces = faces[~flat]
    twins = _twins(faces)
    repairs.append(("identical panels removed", int(twins.sum())))
    faces = faces[~twins]
    if len(faces) == 0:
        raise InputError(f"heal: {mesh.name!r} has no panel with an area.")
    turned = consistent_orientation(faces, _areas(vertices, faces))
    repairs.append(("panels turned to agree with their neighbours", int(turned.sum())))
    faces = np.where(turned[:, None], reversed_faces(faces), faces)
    vertices, faces = compact(vertices, faces)
    healed = replace(mesh, vertices=vertices, faces=faces)
    if _orientation_volume(healed) < 0.0:
        healed = healed.flipped()
        repairs.append(("hull turned over, normals now into the fluid", healed.n_faces))
    return healed, HealReport(tuple(r for r in repairs if r[1]), before, check_mesh(healed))


# ---- single checks


def _finding(
    what: str, severity: Severity, faces: Mask | NDArray[np.int64], advice: str, *, count: int | None = None
) -> Finding:
    index = np.flatnonzero(faces) if faces.dtype == bool else np.unique(faces)
    return Finding(what, severity, len(index) if count is None else count, advice, tuple(index[:20].tolist()))


def _position(mesh: PanelMesh) -> list[Finding]:
    z = mesh.vertices[mesh.faces, 2]
    findings = []
    if mesh.bounds[0, 2] >= -mesh.tolerance:
        advice = "give the draught: .immersed(draught); z axis down: .rotated(phi=pi)"
        findings.append(Finding("hull wholly above water", "error", 1, advice))
    if (extent := float(np.ptp(mesh.bounds, axis=0).max())) > _LONGEST:
        findings.append(Finding(f"extent {extent:.4g} m", "warning", 1, "millimetres? unit=0.001 of load_mesh, --unit 0.001"))
    above = (z > mesh.tolerance).any(axis=1)
    findings.append(
        _finding("panels above water", "error", above, "clip with .immersed(), or give the draught: .immersed(draught)")
    )
    for plane in mesh.planes:
        c = mesh.vertices[mesh.faces, NORMAL_AXIS[plane]]
        letter = "xyz"[NORMAL_AXIS[plane]]
        both = c.max() > _close(mesh)  # a half stored at y < 0 alone is as good as one at y > 0
        wrong = both & (c < -_close(mesh)).any(axis=1)
        findings.append(
            _finding(f"panels beyond {letter} = 0", "error", wrong, "the stored part must lie on one side of the symmetry")
        )
        inside = (np.abs(c) <= _close(mesh)).all(axis=1)
        findings.append(_finding(f"panels in {letter} = 0", "error", inside, "remove them: they lie inside the hull"))
    return findings


def _orientation(mesh: PanelMesh) -> list[Finding]:
    findings = []
    if _orientation_volume(mesh) < 0.0:
        findings.append(Finding("inward normals", "error", 1, "turn the hull over: .flipped(), or heal()"))
    size = max(abs(mesh.volumes).max(), 1e-300)
    closed = mesh.bounds[1, 2] <= mesh.tolerance
    if closed and np.ptp(mesh.volumes) > VOLUMES * size:
        advice = f"volumes {', '.join(f'{v:.6g}' for v in mesh.volumes)} m3 differ: holes, or panels turned over"
        findings.append(Finding("volumes differ", "error", 1, advice))
    return findings


def _connections(mesh: PanelMesh) -> list[Finding]:
    faces = mesh.faces
    _, merged = merge_vertices(mesh.vertices, faces, tolerance=_close(mesh))
    n_double = len(np.unique(faces)) - len(np.unique(merged))
    start, end, owner = edges(faces)
    low, high = np.minimum(start, end), np.maximum(start, end)
    _, edge, count = np.unique(np.stack([low, high], axis=1), axis=0, return_inverse=True, return_counts=True)
    many = count[edge.ravel()] > 2
    _, index, times = np.unique(np.stack([start, end], axis=1), axis=0, return_inverse=True, return_counts=True)
    same = (times[index.ravel()] > 1) & (count[edge.ravel()] == 2)
    rim_start, rim_end, rim_owner = open_edges(mesh.vertices, faces, planes=("xy", *mesh.planes), tolerance=_close(mesh))
    hole = without_t_junctions(mesh.vertices, rim_start, rim_end, tolerance=10.0 * _close(mesh))
    n_many, n_same = len(np.unique(edge.ravel()[many])), int(same.sum()) // 2
    along, gap = rim_owner[~hole], rim_owner[hole]
    no_hole = "no hole; the panels of two patches do not match"
    return [
        Finding("duplicate vertices", "error", n_double, "neighbours are not connected: heal() merges them"),
        _finding("edges run twice in one direction", "error", owner[same], "panels turned over: heal()", count=n_same),
        _finding("edges with more than two panels", "warning", owner[many], "inner walls or doubled panels", count=n_many),
        _finding("identical panels", "error", _twins(faces), "heal() removes them"),
        _finding("T-junction edges", "warning", along, no_hole, count=len(along)),
        _finding("open edges", "warning", gap, "a hole, or a gap between patches", count=len(gap)),
    ]


def _panels(mesh: PanelMesh) -> list[Finding]:
    p = mesh.vertices[mesh.faces]
    flat = _without_area(mesh.vertices, mesh.faces)
    area = np.where(flat, 1.0, mesh.areas)
    lift = np.abs(np.einsum("fi,fi->f", p[:, 1] - p[:, 0], mesh.normals)) / 2.0
    warped = ~flat & (lift > WARP * np.sqrt(area))
    side = np.linalg.norm(p - np.roll(p, -1, axis=1), axis=2).max(axis=1)
    slender = ~flat & (side**2 > ASPECT * area)
    return [
        _finding("panels without area", "error", flat, "heal() removes them"),
        _finding("warped panels", "warning", warped, f"corners over {WARP:g} sqrt(area) off the mean plane: split them"),
        _finding("slender panels", "warning", slender, f"longest side squared over {ASPECT:g} times the area"),
    ]


def _lid(mesh: PanelMesh) -> list[Finding]:
    lid = mesh.lid
    if lid is None:
        return []
    findings = []
    if np.abs(lid.bounds[:, 2]).max() > _close(mesh):
        findings.append(Finding("lid off z = 0", "error", 1, "remove it: .with_lid(None)"))
    waterplane = -mesh.moments[0][2]
    if mesh.bounds[1, 2] <= mesh.tolerance and lid.wetted_area > 1.02 * waterplane:
        advice = f"{lid.wetted_area:.6g} m2, waterplane {waterplane:.6g} m2: the lid must lie inside the hull"
        findings.append(Finding("lid larger than the waterplane", "error", 1, advice))
    return findings


# ---- helpers


def _close(mesh: PanelMesh) -> float:
    return CLOSE * float(np.ptp(mesh.bounds, axis=0).max())


def _orientation_volume(mesh: PanelMesh) -> float:
    """Mean of the volumes by n_x x and n_y y: right for a hull that is open at the top, at any height of it."""
    return float(mesh.volumes[:2].mean())


def _areas(vertices: Array, faces: NDArray[np.int64]) -> Array:
    p = vertices[faces]
    return 0.5 * np.linalg.norm(np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1]), axis=1)


def _without_area(vertices: Array, faces: NDArray[np.int64]) -> Mask:
    p = vertices[faces]
    side = np.linalg.norm(p - np.roll(p, -1, axis=1), axis=2).max(axis=1)
    return _areas(vertices, faces) <= 1e-9 * side**2


def _twins(faces: NDArray[np.int64]) -> Mask:
    """True for faces whose corners are those of an earlier face."""
    corners = np.sort(canonical(faces), axis=1)
    triangle = (np.diff(corners, axis=1) == 0).any(axis=1)
    for row in np.flatnonzero(triangle):
        distinct = np.unique(corners[row])
        corners[row] = [*distinct, *[-1] * (4 - len(distinct))]
    _, first = np.unique(corners, axis=0, return_index=True)
    twin = np.ones(len(faces), dtype=bool)
    twin[first] = False
    return twin


def _snapped(mesh: PanelMesh, tolerance: float) -> tuple[Array, int]:
    vertices = np.array(mesh.vertices)
    moved = np.zeros(len(vertices), dtype=bool)
    for axis in (2, *(NORMAL_AXIS[plane] for plane in mesh.planes)):
        near = (np.abs(vertices[:, axis]) <= tolerance) & (vertices[:, axis] != 0.0)
        vertices[near, axis] = 0.0
        moved |= near
    return vertices, int(moved.sum())
