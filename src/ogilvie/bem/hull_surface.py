"""What stands for a hull: its own smooth surface, one fitted to its panels, or the panels as they are."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.fitted_hull import FittedHull, divided
from ogilvie.bem.flat_hull import flat_panels, require_closed
from ogilvie.bem.hull_patches import hull_panels
from ogilvie.errors import InputError
from ogilvie.mesh.fitting import fitted
from ogilvie.mesh.flattening import flattened
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.smooth import SmoothSurface, SurfaceCorners

Array = NDArray[np.float64]
Representation = Literal["auto", "smooth", "panels"]

_OFF = 0.004  #: of the beam, most that corners of flat panels may be off a fitted surface (rms)
_SIZES = (1.0, 0.9, 1.15)  #: of the size asked for, tried until no panel is folded
_VOLUME = 0.01  #: most that the volumes may differ


def represented(hull: PanelMesh, wish: Representation, *, size: float, q: int) -> tuple[Array, PanelMesh, str]:
    """Return a hull's curved panels, the hull with the planes of symmetry that they have, and a note on what they are.

    Parameters
    ----------
    hull : PanelMesh
        Below z = 0.
    wish : {"auto", "smooth", "panels"}
        See :func:`ogilvie.bem.inner_mesh.inner_mesh`.
    size : float
        Length of a panel, m.
    q : int
        Points per side of a panel.

    Returns
    -------
    panels : (n, q, q, 3) array
        m; normals into the hull.
    hull : PanelMesh
    note : str

    Raises
    ------
    InputError
        The hull has holes; with "smooth": no surface can be fitted.

    Examples
    --------
    >>> from ogilvie.mesh.shapes import box
    >>> represented(box(4.0, 1.0, 0.5, panels=60), "panels", size=1.0, q=2)[2]
    '13 flat panels as they are'
    """
    if wish not in ("auto", "smooth", "panels"):
        raise InputError(f"surface: 'auto', 'smooth' or 'panels' expected, {wish!r} found.")
    if isinstance(hull.surface, SmoothSurface) and wish != "panels":
        return hull_panels(hull.surface, planes=hull.planes, size=size, q=q), hull, "smooth surface of the hull"
    require_closed(hull)
    flat = flat_panels(hull, q=q), hull, f"{hull.n_faces} flat panels as they are"
    if wish == "panels":
        return flat
    try:
        half = hull.with_symmetry("xz")
        fit = _best_fit(half, size, q)
    except InputError as error:
        if wish == "smooth":
            raise
        return (*flat[:2], f"{flat[2]}; no smooth surface: {error}")
    told = _told(fit, half)
    if wish == "auto" and not _is_good(fit, half):
        return (*flat[:2], f"{flat[2]}; no good {told}")
    return fit.panels, half, told


def _on_surface(hull: PanelMesh) -> PanelMesh:
    """Return the hull with the corners of its panels on its smooth surface, where that is known."""
    corners = hull.surface
    return PanelMesh(corners.vertices, corners.faces, symmetry="xz") if isinstance(corners, SurfaceCorners) else hull


def _best_fit(hull: PanelMesh, size: float, q: int) -> FittedHull:
    """Return the first good fit with panels of about that size, a chine kept or rounded off; else that of the size itself."""
    fits, corners = [], _on_surface(hull)
    for chine in (True, False):
        flat = flattened(corners, chine=chine)
        sheet = fitted(flat)
        for factor in _SIZES:
            fits.append(divided(sheet, flat.vertices, size=factor * size, q=q))
            if _is_good(fits[-1], hull):
                return fits[-1]
        if not fits[0].chine:
            break
    return fits[0]


def _told(fit: FittedHull, hull: PanelMesh) -> str:
    return (
        f"smooth surface fitted to {hull.n_faces} flat panels: their corners are {100.0 * fit.rms / hull.beam:.2f} % of the "
        f"beam off (rms; most {100.0 * fit.most / hull.beam:.2f} %), volume {100.0 * (fit.volume / hull.volume - 1.0):+.2f} %"
    )


def _is_good(fit: FittedHull, hull: PanelMesh) -> bool:
    close = fit.rms < _OFF * hull.beam and abs(fit.volume / hull.volume - 1.0) < _VOLUME
    return bool(close and fit.jacobian > 0.0)
