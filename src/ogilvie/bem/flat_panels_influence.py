"""Rankine influence of flat panels with constant densities, and of all their mirror images at once."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.bem.flat_panels import FlatPanels
from ogilvie.bem.flat_panels_kernel import fill_influence
from ogilvie.errors import InputError

Array = NDArray[Any]


class Influence(NamedTuple):
    """Potentials (n_field, n) of unit source density, m, and of unit dipole density along the normals, dimensionless."""

    single: Array
    double: Array


def rankine(field: ArrayLike, panels: FlatPanels, *, accuracy: float = 1e-6) -> Influence:
    """Return int 1/r dS and int d/dn_q (1/r) dS over each given panel (no mirror images).

    Parameters
    ----------
    field : (n_field, 3) array
        Points, m.
    panels : FlatPanels
    accuracy : float
        Largest relative error of an entry, 1e-10..1e-2 (of the double layer: relative to A/d^2).

    Returns
    -------
    Influence
        At a point in the plane of a panel the double layer is zero, the mean of both sides.

    Raises
    ------
    InputError
        Wrong shapes, NaN, accuracy out of range.

    Notes
    -----
    Exact near the panel; from (1/(2 accuracy))^(1/3) panel sizes on by second moments, from (3/(2 accuracy))^(1/2) sizes on as
    points.

    Examples
    --------
    Centre of a unit square: 4 ln(1 + 2^(1/2)).

    >>> square = FlatPanels([[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]])
    >>> rankine([[0.5, 0.5, 0.0]], square).single.round(6).tolist()
    [[3.525494]]
    """
    points = np.ascontiguousarray(field, dtype=float)
    if points.ndim != 2 or points.shape[1] != 3 or not np.all(np.isfinite(points)):
        raise InputError(f"rankine: field: a finite (n, 3) array expected, shape {points.shape} found (or NaN).")
    if not 1e-10 <= accuracy <= 1e-2:
        raise InputError(f"rankine: accuracy: 1e-10..1e-2 expected, {accuracy!r} found.")
    S, D = np.empty((2, len(points), len(panels)))
    p = panels
    near, far = (0.5 / accuracy) ** (1 / 3), (1.5 / accuracy) ** 0.5
    fill_influence(points, p.corners, p.centers, p.normals, p.areas, p.moments, p.sizes, max(near, 3.0), far, S, D)
    return Influence(S, D)


def rankine_by_parity(
    field: ArrayLike, panels: FlatPanels, parities: ArrayLike, *, accuracy: float = 1e-6, mirror: tuple[float, ...] = (1, 1, 1)
) -> list[Influence]:
    """Return the influence of panels with all their mirror images, for densities that are even or odd in x and y.

    Parameters
    ----------
    field : (n_field, 3) array
        Points, m.
    panels : FlatPanels
    parities : (n_parities, 2) array
        +1 (even) or -1 (odd) in x and in y.
    accuracy : float
        See `rankine`.
    mirror : 3 signs
        (1, 1, -1): of the images in z = 0 instead, with the densities and normal derivatives of the panels.

    Returns
    -------
    list of Influence
        One for each parity.

    Notes
    -----
    An image at P acts as the panel itself at the image of P, so each image is integrated once and added with the sign of
    each parity (Guo et al., Eqs. (26)-(33), for any symmetry and all modes at once).

    Examples
    --------
    >>> half = FlatPanels([[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]], symmetry="xz")
    >>> even, odd = rankine_by_parity([[0.5, 0.0, 0.3]], half, [[1, 1], [1, -1]])
    >>> bool(even.single > 1.0), bool(abs(odd.single) < 1e-12)
    (True, True)
    """
    points = np.asarray(field, dtype=float) * np.asarray(mirror, dtype=float)
    signs = density_signs(panels.images, parities)
    total: list[Influence] = []
    for image, sign in zip(panels.images, signs.T, strict=True):
        S, D = rankine(points * [*image, 1.0], panels, accuracy=accuracy)
        if not total:
            total = [Influence(s * S, s * D) for s in sign]
            continue
        for s, (single, double) in zip(sign, total, strict=True):
            single += s * S
            double += s * D
    return total


def density_signs(images: Array, parities: ArrayLike) -> Array:
    """Return the sign (n_parities, n_images) that a density of each parity has on each image."""
    p = np.atleast_2d(np.asarray(parities, dtype=float))
    if p.ndim != 2 or p.shape[1] != 2 or not np.all(np.abs(p) == 1.0):
        raise InputError(f"parities: an (n, 2) array of +1 and -1 expected, {parities!r} found.")
    return np.asarray(np.where(images[None] < 0.0, p[:, None, :], 1.0).prod(axis=-1))
