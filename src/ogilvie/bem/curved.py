"""The boundary of the inner domain as curved quadrilaterals: hull, free surface and control hemisphere."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError

Array = NDArray[Any]
Symmetry = Literal["none", "xz", "xz+yz"]

#: Parts of the boundary, as numbers in `CurvedMesh.part`.
BODY, FREE, CONTROL = 0, 1, 2
PARTS = ("hull", "free surface", "control surface")


@dataclass(frozen=True, eq=False)
class CurvedMesh:
    """Curved quadrilaterals that enclose the fluid between a hull and the control hemisphere of `radius`, z <= 0.

    Parameters
    ----------
    points : (n, q, q, 3) array
        m. Position of each panel at the products of the q Chebyshev points -cos(pi i/(q - 1)), i = 0..q-1, of u (first index)
        and v (second), q >= 2: the panel is the polynomial through them. x_u x x_v points OUT of the fluid: into the hull,
        up from the free surface, away from O on the control surface.
    part : (n,) int array
        `BODY`, `FREE` or `CONTROL`.
    radius : float
        Of the control hemisphere about O, m.
    symmetry : {"none", "xz", "xz+yz"}
        Planes of symmetry; only the part y >= 0 (and x >= 0) is stored.
    centre : (x, y, 0)
        Where the middle O of the hemisphere is in the hull's axes, m; `points` count from there.
    notes : tuple of str
        How the hull became curved panels.
    """

    points: Array
    part: NDArray[np.int64]
    radius: float
    symmetry: Symmetry = "none"
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0)
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        points, part = np.array(self.points, dtype=float), np.array(self.part, dtype=np.int64)
        n, q = points.shape[:2] if points.ndim == 4 else (0, 0)
        if points.shape != (n, q, q, 3) or n == 0 or q < 2 or not np.all(np.isfinite(points)):
            raise InputError(
                f"points: finite (n, q, q, 3) array, q >= 2, expected; shape {np.shape(self.points)} found (or NaN)."
            )
        if part.shape != (n,) or set(np.unique(part)) - {BODY, FREE, CONTROL}:
            raise InputError(f"part: {n} numbers of 0 (hull), 1 (free surface), 2 (control surface) expected.")
        if not self.radius > 0.0 or self.symmetry not in ("none", "xz", "xz+yz"):
            raise InputError(f"radius > 0 and a known symmetry expected, {self.radius!r} and {self.symmetry!r} found.")
        if len(self.centre) != 3 or not np.all(np.isfinite(self.centre)) or self.centre[2] != 0.0:
            raise InputError(f"centre: a point (x, y, 0) expected, {self.centre!r} found.")
        points.setflags(write=False)
        part.setflags(write=False)
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "part", part)

    @property
    def degree(self) -> int:
        """Points per side of a panel, q: polynomials of degree q - 1."""
        return int(self.points.shape[1])

    @cached_property
    def images(self) -> Array:
        """Signs (n_images, 2) of x and y of the stored part and of its mirror images."""
        return image_signs(self.symmetry)


def image_signs(symmetry: Symmetry) -> Array:
    """Return the signs (n_images, 2) of x and y of the stored part and of its mirror images.

    Examples
    --------
    >>> image_signs("xz").tolist()
    [[1.0, 1.0], [1.0, -1.0]]
    """
    y = (1.0,) if symmetry == "none" else (1.0, -1.0)
    x = (1.0, -1.0) if symmetry == "xz+yz" else (1.0,)
    return np.array([(a, b) for a in x for b in y])
