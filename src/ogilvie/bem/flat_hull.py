"""A panelled hull as it is: each flat panel becomes one curved panel of degree 1."""

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.curves import turned
from ogilvie.errors import InputError
from ogilvie.mesh.chebyshev import chebyshev_points, interpolation
from ogilvie.mesh.panels import PanelMesh

Array = NDArray[np.float64]

_GAP = 0.005  #: most that the volumes by three integrals may differ, of the volume: holes


def flat_panels(hull: PanelMesh, *, q: int) -> Array:
    """Return the panels of a hull as bilinear surfaces through their corners, (n, q, q, 3), m; normals into the hull.

    Parameters
    ----------
    hull : PanelMesh
        Below z = 0.
    q : int
        Points per side of a panel.

    Notes
    -----
    A triangle has two corners at one place: its Jacobian vanishes there, but nowhere else.

    Examples
    --------
    >>> from ogilvie.mesh.shapes import box
    >>> flat_panels(box(4.0, 1.0, 0.5, panels=60), q=3).shape
    (13, 3, 3, 3)
    """
    corners = hull.vertices[hull.faces]  # (n, 4, 3), anticlockwise seen from the fluid
    square = np.stack([corners[:, [0, 3]], corners[:, [1, 2]]], axis=1)  # (n, 2, 2, 3): u from 0 to 1, v from 0 to 3
    U = interpolation(2, chebyshev_points(q))
    return turned(np.asarray(np.einsum("ai,bj,nijk->nabk", U, U, square)))


def require_closed(hull: PanelMesh) -> None:
    """Raise if a hull has holes below the water: its volumes by n_x x, n_y y and n_z z differ.

    Raises
    ------
    InputError
    """
    low, high = float(hull.volumes.min()), float(hull.volumes.max())
    if not (low > 0.0 and high - low <= _GAP * high):
        found = ", ".join(f"{v:.6g}" for v in hull.volumes)
        raise InputError(
            f"inner_mesh: a hull without holes and with normals into the water expected, volumes {found} m3 by the integrals "
            f"of n_x x, n_y y and n_z z found for {hull.name!r}. See check_mesh() and heal()."
        )
