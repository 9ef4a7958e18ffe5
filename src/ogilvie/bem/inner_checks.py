"""What a boundary of curved panels must satisfy: closed, right side out, no folds; its volume and its angles."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.curved import BODY, CONTROL, FREE, CurvedMesh
from ogilvie.mesh.chebyshev import chebyshev_points, differentiation, interpolation

Array = NDArray[np.float64]


@dataclass(frozen=True)
class InnerReport:
    """Measures of a closed boundary, mirror images included.

    Parameters
    ----------
    closure : float
        Length of the integral of n dS over the square of the radius: 0 for a closed boundary.
    volume : float
        Of the fluid, integral of x.n dS / 3, m3.
    displacement : float
        Volume that the hull takes off the half ball, from the same integral over the hull alone, m3.
    jacobian : float
        Least |x_u x x_v| over its greatest value inside a panel; negative where the panel is folded.
    angle : float
        Least angle between the lines of u and v at the corners of a panel, or what the greatest lacks to 180 deg, rad.
    panels : tuple of int
        Of hull, free surface and control surface, stored part.
    """

    closure: float
    volume: float
    displacement: float
    jacobian: float
    angle: float
    panels: tuple[int, int, int]


def inspect_inner(mesh: CurvedMesh) -> InnerReport:
    """Return the measures of a boundary.

    Examples
    --------
    >>> from ogilvie.bem.inner_mesh import inner_mesh
    >>> from ogilvie.mesh.shapes import hemisphere
    >>> report = inspect_inner(inner_mesh(hemisphere(1.0)))
    >>> report.closure < 1e-6, report.jacobian > 0.0, round(report.volume / (2 / 3 * np.pi * (2.0**3 - 1.0)), 6)
    (True, True, 1.0)
    """
    q = mesh.degree
    g, w = np.polynomial.legendre.leggauss(q + 2)
    x, normal = positions_and_normals(mesh.points, g, g)
    W = np.outer(w, w)
    vector = np.einsum("ab,nabk->nk", W, normal)
    flux = np.einsum("ab,nabk,nabk->n", W, x, normal) / 3.0
    images = len(mesh.images)
    total = sum(vector.sum(axis=0) * [sx, sy, 1.0] for sx, sy in mesh.images)
    hull = mesh.part == BODY
    return InnerReport(
        closure=float(np.linalg.norm(total)) / mesh.radius**2,
        volume=images * float(flux.sum()),
        displacement=-images * float(flux[hull].sum()),
        jacobian=float(jacobians(normal).min()),
        angle=float(corner_angles(mesh.points).min()),
        panels=tuple(int((mesh.part == k).sum()) for k in (BODY, FREE, CONTROL)),  # type: ignore[arg-type]
    )


def positions_and_normals(points: Array, u: Array, v: Array) -> tuple[Array, Array]:
    """Return positions and x_u x x_v (n, n_u, n_v, 3) of panels (n, q, q, 3) at the products of u and v."""
    q = points.shape[1]
    U, V, D = interpolation(q, u), interpolation(q, v), differentiation(q)
    x = np.einsum("ai,bj,nijk->nabk", U, V, points)
    xu, xv = np.einsum("ai,bj,nijk->nabk", U @ D, V, points), np.einsum("ai,bj,nijk->nabk", U, V @ D, points)
    return x, np.cross(xu, xv)


def jacobians(normal: Array) -> Array:
    """Return |x_u x x_v| over its greatest value in the panel, from values (n, n_u, n_v, 3) on a grid.

    It is negative where the normal turns by more than 90 deg from the mean of its neighbours on the grid: there the panel is
    folded.
    """
    size = np.linalg.norm(normal, axis=-1)
    unit = normal / np.maximum(size, 1e-300)[..., None]
    near = np.zeros_like(unit)
    near[:, 1:] += unit[:, :-1]
    near[:, :-1] += unit[:, 1:]
    near[:, :, 1:] += unit[:, :, :-1]
    near[:, :, :-1] += unit[:, :, 1:]
    return np.asarray(np.sign((near * unit).sum(axis=-1)) * size / size.max(axis=(1, 2), keepdims=True))


def corner_angles(points: Array) -> Array:
    """Return, per panel (n,), the least of the angles at its corners and of what they lack to 180 deg, rad."""
    q = points.shape[1]
    near = 0.98 * chebyshev_points(2)  # a little inside: panels of three corners have no angle at the double one
    U, D = interpolation(q, near), differentiation(q)
    xu, xv = np.einsum("ai,bj,nijk->nabk", U @ D, U, points), np.einsum("ai,bj,nijk->nabk", U, U @ D, points)
    cross = np.linalg.norm(np.cross(xu, xv), axis=-1)
    return np.asarray(np.arctan2(cross, np.abs((xu * xv).sum(axis=-1))).min(axis=(1, 2)))
