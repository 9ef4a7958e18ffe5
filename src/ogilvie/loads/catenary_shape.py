"""The curve of a solved mooring line, for figures and reports."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.loads.catenary import SLACK

if TYPE_CHECKING:
    from ogilvie.loads.mooring_line import MooringLine

Array = NDArray[Any]


def line_shape(line: "MooringLine", H: float, V: float, kind: int, distance: float, points: int) -> tuple[Array, Array]:
    """Return horizontal distance and height (points,) above the anchor along a line, from anchor to fairlead, m.

    Parameters
    ----------
    line : MooringLine
    H, V : float
        Tension components at the fairlead, N.
    kind : int
        From :func:`ogilvie.loads.catenary.solve_line`.
    distance : float
        Horizontal, of the fairlead, m: a slack line covers it in a straight run, what is too long is not drawn.
    points : int
        Equally spaced in unstretched length.

    Notes
    -----
    dx/ds = H / T + H / EA, dz/ds = v / T + v / EA, v = V - w (L - s) (0 on the bottom), integrated in closed form from the
    fairlead; on the bottom the tension falls by friction w per metre.
    """
    L, w, EA = line.length, line.weight, line.stiffness
    s = np.linspace(0.0, L, points)
    v = V - w * (L - s)
    if line.grounded:
        v = np.maximum(v, 0.0)
    z_top = _height(V, H, w, EA)
    z = _height(v, H, w, EA) - z_top
    if kind == SLACK:
        lying = np.clip((L - V / w) - s, 0.0, None)
        x = distance - lying * (distance / (L - V / w) if w * L > V else 0.0)
    else:
        x = distance + H / w * (np.arcsinh(v / H) - np.arcsinh(V / H)) + H / EA * (s - L)
        x = x - np.clip(L - V / w - s, 0.0, None) if line.grounded else x
        x = x + _friction_loss(line, H, L - V / w - s) if line.grounded else x
    return x - x[0] if kind != SLACK else x, z - z[0]


def _height(v: Any, H: float, w: float, EA: float) -> Any:
    return (
        (np.hypot(H, v) - H) / w + v * np.abs(v) / (2.0 * EA * w) if H == 0.0 else np.hypot(H, v) / w + v * v / (2.0 * EA * w)
    )


def _friction_loss(line: "MooringLine", H: float, lying: Array) -> Array:
    """Stretch that friction takes from the line between touchdown and a point that lies `lying` metres behind it."""
    drag = line.friction * line.weight
    if drag == 0.0:
        return np.zeros_like(lying)
    b = np.clip(lying, 0.0, None)
    held = np.minimum(b, H / drag)
    return np.asarray((drag * held**2 / 2.0 + H * (b - held)) / line.stiffness)
