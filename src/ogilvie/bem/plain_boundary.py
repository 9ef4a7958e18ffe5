"""The closed boundary of the inner fluid in flat panels: hull, free surface, control surface."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.curved import BODY, CONTROL, FREE, CurvedMesh, Symmetry
from ogilvie.bem.flat_panels import FlatPanels
from ogilvie.errors import InputError
from ogilvie.mesh.chebyshev import interpolation

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class FlatBoundary:
    """Flat panels around the fluid between a hull and a control surface.

    Parameters
    ----------
    hull, free, control : FlatPanels
        Normals OUT of the fluid: into the hull, up, away from the hull. Edges of neighbouring surfaces should meet, and panels
        of two surfaces have one size where they do.

    Raises
    ------
    InputError
        Symmetries differ, panels above the water, a free surface off z = 0 or not facing up.
    """

    hull: FlatPanels
    free: FlatPanels
    control: FlatPanels

    def __post_init__(self) -> None:
        if len({p.symmetry for p in (self.hull, self.free, self.control)}) > 1:
            found = ", ".join(p.symmetry for p in (self.hull, self.free, self.control))
            raise InputError(f"FlatBoundary: one symmetry of hull, free surface and control surface expected, {found} found.")
        size = np.ptp(self.control.corners.reshape(-1, 3), axis=0).max()
        if np.abs(self.free.corners[..., 2]).max() > 1e-9 * size or self.free.normals[:, 2].min() < 0.5:
            raise InputError("FlatBoundary: free-surface panels on z = 0 whose normals point up expected.")
        for name, panels in (("hull", self.hull), ("control surface", self.control)):
            if panels.centers[:, 2].max() > -1e-9 * size:
                raise InputError(f"FlatBoundary: {name}: centres of all panels below z = 0 expected.")

    @property
    def symmetry(self) -> Symmetry:
        """Planes of symmetry."""
        return self.hull.symmetry

    @cached_property
    def counts(self) -> tuple[int, int, int]:
        """Given panels of control surface, free surface, hull (the order of the equations)."""
        return len(self.control), len(self.free), len(self.hull)

    @cached_property
    def panels(self) -> FlatPanels:
        """All given panels: control surface, free surface, hull."""
        return FlatPanels(np.concatenate([p.corners for p in (self.control, self.free, self.hull)]), symmetry=self.symmetry)

    @cached_property
    def modes(self) -> Array:
        """Normal velocities (n_hull, 6) of unit motions about O: n and x x n."""
        return np.concatenate([self.hull.normals, np.cross(self.hull.centers, self.hull.normals)], axis=1)

    def expanded(self) -> "FlatBoundary":
        """Return the boundary with all mirror images written out, symmetry "none".

        Examples
        --------
        >>> hemisphere_boundary().expanded().counts
        (300, 400, 260)
        """
        return FlatBoundary(*(_with_images(p) for p in (self.hull, self.free, self.control)))


def _with_images(panels: FlatPanels) -> FlatPanels:
    copies = [panels.corners * [*s, 1.0] for s in panels.images]
    return FlatPanels(
        np.concatenate([c if s.prod() > 0 else c[:, [1, 0, 3, 2]] for c, s in zip(copies, panels.images, strict=True)])
    )


def flat_boundary(mesh: CurvedMesh, *, divisions: int = 2) -> FlatBoundary:
    """Return flat panels with their corners on a curved boundary, in the axes of the hull.

    Parameters
    ----------
    mesh : CurvedMesh
    divisions : int
        Flat panels along each side of a curved one, >= 1.

    Raises
    ------
    InputError
        divisions < 1, or a part of the boundary is missing.
    """
    if divisions < 1:
        raise InputError(f"flat_boundary: divisions >= 1 expected, {divisions!r} found.")
    L = interpolation(mesh.degree, np.linspace(-1.0, 1.0, divisions + 1))
    p = np.einsum("ai,bj,nijk->nabk", L, L, mesh.points) + np.array(mesh.centre)
    corners = np.stack([p[:, :-1, :-1], p[:, 1:, :-1], p[:, 1:, 1:], p[:, :-1, 1:]], axis=3)
    corners[np.abs(corners) < 1e-12 * mesh.radius] = 0.0
    surfaces = []
    for part, name in ((BODY, "hull"), (FREE, "free surface"), (CONTROL, "control surface")):
        if not np.any(mesh.part == part):
            raise InputError(f"flat_boundary: panels of the {name} expected, none found.")
        surfaces.append(FlatPanels(corners[mesh.part == part].reshape(-1, 4, 3), symmetry=mesh.symmetry))
    return FlatBoundary(*surfaces)


def hemisphere_boundary(
    radius: float = 1.0,
    control_radius: float = 5.0,
    *,
    around: int = 20,
    rings: tuple[int, int, int] = (13, 20, 15),
    grading: float = 0.6,
) -> FlatBoundary:
    """Return the boundary of a floating hemisphere with a concentric control hemisphere.

    Parameters
    ----------
    radius, control_radius : float
        m.
    around : int
        Panels around the whole circle, a multiple of 4.
    rings : three int
        Rings of panels on the hull, the free surface and the control surface; the defaults are 260, 400 and 300 panels.
    grading : float
        Height of the hull's ring at the waterline over the mean height of its rings, 0.1..1.

    Returns
    -------
    FlatBoundary
        Symmetry "xz+yz".

    Raises
    ------
    InputError
        Numbers out of range.

    Notes
    -----
    Heights grow in geometric series from the waterline: down the hull, outwards on the free surface and, from its last ring,
    down the control surface, so that panels have one size at both edges. Flat panels with corners on the sphere enclose too
    little; the hull's corners are moved out by a common factor that makes its volume that of the hemisphere.

    Examples
    --------
    >>> hemisphere_boundary().counts
    (75, 100, 65)
    """
    if not (0.0 < radius < control_radius < np.inf and 0.1 <= grading <= 1.0):
        raise InputError(
            f"hemisphere_boundary: 0 < radius < control_radius and grading 0.1..1 expected, {radius!r}, {control_radius!r} "
            f"and {grading!r} found."
        )
    if around < 8 or around % 4 or min(rings) < 2:
        raise InputError(
            f"hemisphere_boundary: around a multiple of 4, >= 8, rings >= 2 expected, {around!r}, {rings!r} found."
        )
    depth = 0.5 * np.pi * radius * _geometric(rings[0], grading / rings[0])
    out = (control_radius - radius) * _geometric(rings[1], (depth[1] - depth[0]) / (control_radius - radius))
    arc = 0.5 * np.pi * control_radius
    far = arc * _geometric(rings[2], (out[-1] - out[-2]) / arc)
    alpha = 0.5 * np.pi * np.linspace(0.0, 1.0, around // 4 + 1)
    hull = _revolved(*_meridian(radius, depth), alpha)
    volume = 4.0 * np.abs(np.einsum("nk,nk->", FlatPanels(hull).centers, FlatPanels(hull).normals * _areas(hull))) / 3.0
    factor = (2.0 / 3.0 * np.pi * radius**3 / volume) ** (1.0 / 3.0)
    shell = _revolved(*_meridian(control_radius, far), alpha)[:, ::-1]
    edge = radius * factor + (control_radius - radius * factor) * out / (control_radius - radius)
    free = _revolved(edge, np.zeros(len(edge)), alpha)[:, ::-1]
    return FlatBoundary(*(FlatPanels(c, symmetry="xz+yz") for c in (hull * factor, free, shell)))


def _areas(corners: Array) -> Array:
    return FlatPanels(corners).areas[:, None]


def _geometric(count: int, first: float) -> Array:
    """Return 0..1 in `count` steps that grow by one factor from `first`."""
    from scipy.optimize import brentq

    powers = np.arange(count)
    q = brentq(lambda q: first * (np.exp(q) ** powers).sum() - 1.0, -3.0, 3.0, xtol=1e-14)
    return np.concatenate([[0.0], np.cumsum(first * np.exp(q) ** powers)]) / (first * (np.exp(q) ** powers).sum())


def _meridian(radius: float, depth: Array) -> tuple[Array, Array]:
    """Return distances from the axis and heights of points at these arc lengths below the waterline."""
    angle = depth / radius
    s, z = radius * np.cos(angle), -radius * np.sin(angle)
    s[-1], z[0] = 0.0, 0.0
    return s, z


def _revolved(s: Array, z: Array, alpha: Array) -> Array:
    """Return corners (n, 4, 3) of a quarter's surface of revolution; normals to the axis where z falls along the meridian."""
    c, d = np.cos(alpha), np.sin(alpha)
    c[-1], d[0] = 0.0, 0.0
    p = np.stack([np.outer(s, c), np.outer(s, d), np.outer(z, np.ones_like(alpha))], axis=-1)
    return np.stack([p[:-1, :-1], p[:-1, 1:], p[1:, 1:], p[1:, :-1]], axis=2).reshape(-1, 4, 3)
