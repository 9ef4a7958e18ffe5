"""Hulls from a few numbers: bodies with a formula here, ships from their lines or particulars by modules of their own."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.mesh.lid import waterplane_lid
from ogilvie.mesh.loft import from_offsets
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.particulars import from_particulars
from ogilvie.mesh.patches import oriented, panel_mesh, quarter_disc, spacing
from ogilvie.mesh.s175 import s175
from ogilvie.mesh.smooth_shapes import smooth_box, smooth_cylinder, smooth_hemisphere, smooth_wigley

__all__ = ["box", "cylinder", "from_offsets", "from_particulars", "hemisphere", "s175", "waterplane_lid", "wigley"]

Array = NDArray[np.float64]

#: Journee's hulls: length over beam and the coefficient alpha of the bulged sections; length over draught is 16.
_WIGLEY = {"I": (10.0, 1.0), "II": (5.0, 1.0), "III": (10.0, 0.0), "IV": (5.0, 0.0), "parabolic": (10.0, 0.0)}


def hemisphere(radius: float, *, panels: int = 1000, grading: float = 0.5, name: str = "hemisphere") -> PanelMesh:
    """Return the lower half of a sphere whose centre is O, with the volume of the sphere.

    Parameters
    ----------
    radius : float
        m.
    panels : int
        Largest number of panels of the whole hull (>= 12).
    grading : float
        0: rings of equal height; 1: cosine spacing towards the waterline.
    name : str

    Returns
    -------
    PanelMesh
        Symmetry "xz+yz".

    Notes
    -----
    A cube's surface blown up to the sphere: nearly square quadrilaterals everywhere, no slivers at the pole. Flat panels with
    corners on the sphere enclose too little, so the corners are moved out by one common factor 1 + O(h^2) that makes
    the volume 2/3 pi radius^3 (1.0015 for 768 panels).

    Examples
    --------
    >>> mesh = hemisphere(5.0, panels=800)
    >>> mesh.n_faces, mesh.symmetry, round(mesh.volume / (2 / 3 * np.pi * 5.0**3), 12)
    (192, 'xz+yz', 1.0)
    """
    (R,) = _positive(radius=radius)
    n, m = _counts(panels, (1.0, 1.0), lambda n, m: 4 * n * (n + 2 * m))
    across = np.tan(0.25 * np.pi * np.linspace(0.0, 1.0, n + 1))
    down = -np.tan(0.25 * np.pi * (1.0 - spacing(m, grading=grading)))
    cube = [
        _grid(across, across, lambda a, b: (a, b, -1.0), outward=(0, 0, -1)),
        _grid(across, down, lambda a, z: (1.0, a, z), outward=(1, 0, 0)),
        _grid(across, down, lambda a, z: (a, 1.0, z), outward=(0, 1, 0)),
    ]
    mesh = panel_mesh([R * g / np.linalg.norm(g, axis=-1, keepdims=True) for g in cube], symmetry="xz+yz", name=name)
    return replace(mesh.scaled((2.0 / 3.0 * np.pi * R**3 / mesh.volume) ** (1.0 / 3.0)), surface=smooth_hemisphere(R))


def box(
    length: float, beam: float, draught: float, *, panels: int = 1000, grading: float = 0.7, name: str = "box"
) -> PanelMesh:
    """Return a box barge with its centre above O.

    Parameters
    ----------
    length, beam, draught : float
        m.
    panels : int
        Largest number of panels of the whole hull (>= 12).
    grading : float
        0: equal panels; 1: cosine spacing towards edges (where the velocity is singular) and waterline.
    name : str

    Returns
    -------
    PanelMesh
        Symmetry "xz+yz".

    Examples
    --------
    >>> box(100.0, 20.0, 5.0, panels=600).bounds.tolist()
    [[-50.0, -10.0, -5.0], [50.0, 10.0, 0.0]]
    """
    L, B, T = _positive(length=length, beam=beam, draught=draught)
    sides = (0.5 * L, 0.5 * B, T)
    nx, ny, nz = _counts(panels, sides, lambda nx, ny, nz: 4 * (nx * ny + nx * nz + ny * nz))
    x, y = 0.5 * L * spacing(nx, grading=grading), 0.5 * B * spacing(ny, grading=grading)
    z = T * (spacing(nz, grading=grading, fine="both") - 1.0)
    sheets = [
        _grid(x, y, lambda x, y: (x, y, -T), outward=(0, 0, -1)),
        _grid(x, z, lambda x, z: (x, 0.5 * B, z), outward=(0, 1, 0)),
        _grid(y, z, lambda y, z: (0.5 * L, y, z), outward=(1, 0, 0)),
    ]
    return replace(panel_mesh(sheets, symmetry="xz+yz", name=name), surface=smooth_box(L, B, T))


def cylinder(radius: float, draught: float, *, panels: int = 1000, grading: float = 0.5, name: str = "cylinder") -> PanelMesh:
    """Return a vertical circular cylinder about the z axis, each of its waterplanes with the area of the circle.

    Parameters
    ----------
    radius, draught : float
        m.
    panels : int
        Largest number of panels of the whole hull (>= 20).
    grading : float
        0: equal rows; 1: cosine spacing towards edge and waterline.
    name : str

    Returns
    -------
    PanelMesh
        Symmetry "xz+yz".

    Notes
    -----
    The corners of the regular polygon lie on a circle whose radius is greater by (d / sin d)^(1/2), d the angle between
    corners.

    Examples
    --------
    >>> round(cylinder(1.0, 2.0, panels=600).volume / (2.0 * np.pi), 12)
    1.0
    """
    R, T = _positive(radius=radius, draught=draught)
    sides = (0.25 * np.pi * R, 0.5 * R, T)
    n, rings, rows = _counts(panels, sides, lambda n, m, k: 4 * (n * (n + 2 * m) + 2 * n * k))
    d = 0.25 * np.pi / n
    rim = R * np.sqrt(d / np.sin(d))
    bottom = [np.dstack([rim * g, np.full(g.shape[:2], -T)]) for g in quarter_disc(n, rings, grading=grading)]
    z = T * (spacing(rows, grading=grading, fine="both") - 1.0)
    angle = d * np.arange(2 * n + 1, dtype=float)
    side = _grid(angle, z, lambda a, z: (rim * np.cos(a), rim * np.sin(a), z), outward=(1, 1, 0))
    mesh = panel_mesh([*(oriented(g, (0, 0, -1)) for g in bottom), side], symmetry="xz+yz", name=name)
    return replace(mesh, surface=smooth_cylinder(R, T))


def wigley(
    length: float = 3.0,
    beam: float | None = None,
    draught: float | None = None,
    *,
    kind: Literal["I", "II", "III", "IV", "parabolic"] = "III",
    panels: int = 1000,
    grading: float = 0.4,
    name: str | None = None,
) -> PanelMesh:
    """Return one of Journee's Wigley hulls I to IV, or the classic parabolic one, with the volume of its formula.

    Parameters
    ----------
    length, beam, draught : float
        m. By default Journee's models: length 3 m, beam a tenth (I, III) or a fifth (II, IV) of it, draught a sixteenth.
    kind : {"I", "II", "III", "IV", "parabolic"}
        I, II: bulged sections, alpha = 1; III, IV: alpha = 0; "parabolic": alpha = 0 and no factor 1 + 0.2 xi^2.
    panels : int
        Largest number of panels of the whole hull (>= 8).
    grading : float
        0: equal panels; 1: cosine spacing towards the ends and the waterline.
    name : str, optional

    Returns
    -------
    PanelMesh
        Symmetry "xz+yz".

    Notes
    -----
    eta = (1 - zeta^2)(1 - xi^2)(1 + 0.2 xi^2) + alpha zeta^2 (1 - zeta^8)(1 - xi^2)^4, with xi = 2 x/L, eta = 2 y/B, zeta =
    z/T. All half-breadths of the mesh are multiplied by 1 + O(h^2), so that the flat panels enclose the volume of the
    formula.

    References
    ----------
    Journee (1992), Experiments and calculations on 4 Wigley hull forms in head waves, TU Delft report 0909.

    Examples
    --------
    >>> round(wigley(kind="III").volume, 4), round(wigley(kind="IV").volume, 4)
    (0.078, 0.156)
    """
    if kind not in _WIGLEY:
        raise InputError(f"wigley: kind 'I', 'II', 'III', 'IV' or 'parabolic' expected, {kind!r} found.")
    slenderness, alpha = _WIGLEY[kind]
    beam = length / slenderness if beam is None else beam
    draught = length / 16.0 if draught is None else draught
    L, B, T = _positive(length=length, beam=beam, draught=draught)
    c = 0.0 if kind == "parabolic" else 0.2
    # integral of eta over xi, zeta in 0..1 (each term by hand)
    mean = (2 / 3) * (2 / 3 + c * 2 / 15) + alpha * (1 / 3 - 1 / 11) * (128 / 315)
    for target in range(panels, 3, -4):
        side = _wigley_side((L, B, T), alpha, c, target, grading)
        mesh = panel_mesh([side], symmetry="xz+yz", name=name or f"Wigley {kind}")
        if 4 * mesh.n_faces <= panels:  # strongly warped panels have become two triangles
            surface = smooth_wigley(L, B, T, lambda xi, zeta: _wigley_eta(xi, zeta, alpha, c))
            return replace(mesh, vertices=mesh.vertices * [1.0, L * B * T * mean / mesh.volume, 1.0], surface=surface)
    raise InputError(f"panels: at least 8 expected for this shape, {panels!r} found.")


def _wigley_side(size: tuple[float, float, float], alpha: float, c: float, panels: int, grading: float) -> Array:
    """Return vertices (nx + 1, nz + 1, 3) of the quarter x, y >= 0, spaced along the girth of each section."""
    L, B, T = size
    depth = np.linspace(-1.0, 0.0, 401)
    girth = [_girth(0.5 * B * _wigley_eta(x, depth, alpha, c), T * depth) for x in np.linspace(0.0, 1.0, 21)]
    nx, nz = _counts(panels, (0.25 * L, float(np.mean([s[-1] for s in girth]))), lambda nx, nz: 4 * nx * nz)
    s, side = spacing(nz, grading=grading), np.zeros((nx + 1, nz + 1, 3))
    for i, xi in enumerate(spacing(nx, grading=grading)):
        l = _girth(0.5 * B * _wigley_eta(xi, depth, alpha, c), T * depth)
        zeta = np.interp(l[-1] * s, l, depth)
        side[i] = np.stack([0.5 * L * xi + 0.0 * zeta, 0.5 * B * _wigley_eta(xi, zeta, alpha, c), T * zeta], axis=-1)
    return oriented(side, (0, 1, 0))


def _girth(y: Array, z: Array) -> Array:
    return np.cumsum(np.r_[0.0, np.hypot(np.diff(y), np.diff(z))])


def _wigley_eta(xi: Array | float, zeta: Array, alpha: float, c: float) -> Array:
    side = (1 - zeta**2) * (1 - xi**2) * (1 + c * xi**2)
    return np.maximum(side + alpha * zeta**2 * (1 - zeta**8) * (1 - xi**2) ** 4, 0.0)


def _grid(a: Array, b: Array, point: Callable[..., Sequence[Array | float]], *, outward: Sequence[float]) -> Array:
    """Return the points (n_a, n_b, 3) of `point(a, b)`, ordered so that the normals are on the side of `outward`."""
    A, B = np.meshgrid(a, b, indexing="ij")
    return oriented(np.stack([np.broadcast_to(np.asarray(p, dtype=float), A.shape) for p in point(A, B)], axis=-1), outward)


def _counts(panels: int, sides: Sequence[float], total: Callable[..., int]) -> tuple[int, ...]:
    """Return numbers of panels along sides (m), as equal in size as possible, with the largest total <= panels."""
    best: tuple[int, ...] = (1,) * len(sides)
    if panels < total(*best):
        raise InputError(f"panels: at least {total(*best)} expected for this shape, {panels!r} found.")
    for h in max(sides) * np.geomspace(2.0, 0.5 / np.sqrt(panels) / 10.0, 600):
        n = tuple(max(1, round(s / h)) for s in sides)
        if total(*best) < total(*n) <= panels:
            best = n
    return best


def _positive(**lengths: float) -> tuple[float, ...]:
    for key, value in lengths.items():
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(f"{key}: a positive length in m expected, {value!r} found.")
    return tuple(float(v) for v in lengths.values())
