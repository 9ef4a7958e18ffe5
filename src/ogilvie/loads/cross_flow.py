"""Cross-flow drag: a hull moved sideways, strip by strip."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import Surroundings, Terms
from ogilvie.loads.given import ascending, column, number
from ogilvie.loads.kernel import NU_R, Kernel, load_kernel
from ogilvie.loads.viscous import quadratic_effect
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.stations import stations
from ogilvie.units import SEA_WATER

Array = NDArray[Any]

#: Half-breadth over draught, and drag coefficient on the draught, of ship sections.
_CURVE = np.array(
    [
        *[(0.0, 1.966), (0.177, 1.966), (0.353, 1.898), (0.452, 1.787), (0.473, 1.584), (0.493, 1.279), (0.494, 1.211)],
        *[(0.558, 1.084), (0.646, 0.999), (0.834, 0.880), (0.988, 0.828), (1.308, 0.760), (1.639, 0.691), (1.860, 0.657)],
        *[(2.313, 0.631), (2.600, 0.596), (3.009, 0.587), (3.451, 0.586), (3.738, 0.560), (4.003, 0.559)],
    ]
)
_GAUSS = 0.5 / np.sqrt(3.0)  # two points in an interval, about its middle, over its length


def section_drag_coefficient(breadth: ArrayLike, draught: ArrayLike) -> Array:
    """Return the cross-flow drag coefficient of sections on their draught, from their half-breadth over draught.

    Notes
    -----
    Linear between points read off a curve, from 1.97 for thin sections to 0.56 at a ratio of 4 and held beyond. Sharp bilges,
    bilge keels and scale change it by far more than the reading does.

    References
    ----------
    Leite, Aranha, Umeda, de Conti (1998), Current forces in tankers and bifurcation of equilibrium of turret systems, Applied
    Ocean Research 20, 145-156, after Hoerner; points as in the function Hoerner of the Marine Systems Simulator.

    Examples
    --------
    >>> section_drag_coefficient([25.4, 40.0], [12.7, 5.0]).round(2)
    array([0.83, 0.56])
    """
    B, T = np.asarray(breadth, dtype=float), np.asarray(draught, dtype=float)
    ratio = 0.5 * B / np.where(T > 0.0, T, np.inf)
    return np.interp(ratio, _CURVE[:, 0], _CURVE[:, 1])


@load_kernel
def cross_flow_force(x: Array, data: Array, own: Array, force: Array) -> None:
    """Drag of strips; data: rows (x, z, lateral, vertical) with 1/2 rho Cd T dx and 1/2 rho Cd B dx."""
    v, w, p, q, r = x[NU_R + 1], x[NU_R + 2], x[NU_R + 3], x[NU_R + 4], x[NU_R + 5]
    for k in range(data.size // 4):
        xs, zs = data[4 * k], data[4 * k + 1]
        across = v + xs * r - zs * p
        up = w - xs * q
        Y = -data[4 * k + 2] * abs(across) * across
        Z = -data[4 * k + 3] * abs(up) * up
        force[1] += Y
        force[2] += Z
        force[3] -= zs * Y
        force[4] -= xs * Z
        force[5] += xs * Y


@dataclass(frozen=True, eq=False, init=False)
class CrossFlowDrag:
    """Drag of the flow across a slender hull, lateral and, if wanted, vertical.

    Parameters
    ----------
    x : (n,) array
        Stations from O, ascending, m.
    draught : float or (n,) array
        m.
    cd : float or (n,) array
        Lateral drag coefficient on draught, of the strip alone (not of the strip with its mirror image in the water surface).
    beam : float or (n,) array, optional
        Breadth, m: needed for the vertical drag.
    cd_vertical : float or (n,) array
        Drag coefficient of the vertical flow, on the breadth.
    z : float or (n,) array, optional
        Height where the lateral drag of a strip acts, m (negative below O); by default half the draught. With 0 the drag has
        no part in roll.
    rho : float
        kg/m3.
    strips : int
        Least number of intervals along the length; each has two points.

    Raises
    ------
    InputError
        Shapes that do not agree, NaN, negative draught or coefficient, vertical drag without beam.

    Notes
    -----
    ``dF_y = -1/2 rho Cd T |v_s| v_s dx`` with v_s = v_r + x r - z p; ``dF_z = -1/2 rho Cd_z B |w_s| w_s dx`` with
    w_s = w_r - x q; moments of both about O. Draught, breadth and coefficients are linear between the stations; two Gauss
    points in each interval make pure sway and, for constant Cd T, pure yaw exact. The wetted hull is that at rest.

    References
    ----------
    Faltinsen (1990), Sea loads on ships and offshore structures, section 6.4.3, the cross-flow principle; Fossen (2021),
    Handbook of marine craft hydrodynamics and motion control, section 6.4.3.

    Examples
    --------
    >>> drag = CrossFlowDrag([-50.0, 50.0], 5.0, cd=0.8, rho=1000.0)
    >>> force = drag.bind(None).kernel.force(nu=[0, 2.0, 0, 0, 0, 0])  # -1/2 1000 0.8 5 100 2^2
    >>> float(force[1]), float(force[3])
    (-800000.0, -2000000.0)
    """

    points: Array
    name: str = "cross_flow"

    def __init__(
        self,
        x: ArrayLike,
        draught: ArrayLike,
        *,
        cd: ArrayLike,
        beam: ArrayLike | None = None,
        cd_vertical: ArrayLike = 0.0,
        z: ArrayLike | None = None,
        rho: float = SEA_WATER,
        strips: int = 40,
    ) -> None:
        place = ascending(x, "CrossFlowDrag: x (m)")
        n = len(place)

        def given(value: ArrayLike, what: str, least: float = 0.0) -> Array:
            return column(value, f"CrossFlowDrag: {what}", n=n, least=least)

        T, Cd, Cz = given(draught, "draught (m)"), given(cd, "cd"), given(cd_vertical, "cd_vertical")
        if beam is None and np.any(Cz > 0.0):
            raise InputError("CrossFlowDrag: beam (m) expected with cd_vertical, not found.")
        B = given(0.0 if beam is None else beam, "beam (m)")
        height = -0.5 * T if z is None else given(z, "z (m)", -np.inf)
        at, step = gauss_points(place, strips)
        half = 0.5 * number(rho, "CrossFlowDrag: rho (kg/m3)", above=0.0) * step
        columns = [at, np.interp(at, place, height), half * np.interp(at, place, Cd) * np.interp(at, place, T)]
        columns.append(half * np.interp(at, place, Cz) * np.interp(at, place, B))
        points = np.stack(columns, axis=1)
        points.setflags(write=False)
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "name", "cross_flow")

    @classmethod
    def from_hull(
        cls,
        hull: PanelMesh,
        *,
        cd: ArrayLike | None = None,
        cd_vertical: ArrayLike = 0.0,
        z: ArrayLike | None = None,
        rho: float = SEA_WATER,
        strips: int = 40,
    ) -> "CrossFlowDrag":
        """Return the drag with draught and breadth of each station taken from the panels below z = 0.

        Parameters
        ----------
        hull : PanelMesh
            In the body's axes at rest.
        cd : float or (strips,) array, optional
            At the middles of equal strips over the wetted length; by default :func:`section_drag_coefficient` of each.
        cd_vertical, z : float or (strips,) array
            As above, at the same places.
        rho : float
            kg/m3.
        strips : int

        Examples
        --------
        >>> from ogilvie.mesh.shapes import box
        >>> load = CrossFlowDrag.from_hull(box(100.0, 20.0, 5.0, panels=200), cd=0.8, rho=1000.0)
        >>> round(float(load.bind(None).kernel.force(nu=[0, 1.0, 0, 0, 0, 0])[1]))
        -200000
        """
        s = stations(hull, strips)
        low, high = hull.immersed().bounds[:, 0]
        x = np.r_[low, s.x, high]  # the outer halves of the end strips have the dimensions of their middles

        def ends(value: ArrayLike) -> ArrayLike:
            return value if np.ndim(value) == 0 else np.pad(np.asarray(value, dtype=float), 1, mode="edge")

        return cls(
            x,
            ends(s.draught),
            cd=ends(section_drag_coefficient(s.breadth, s.draught) if cd is None else cd),
            beam=ends(s.breadth),
            cd_vertical=ends(cd_vertical),
            z=None if z is None else ends(z),
            rho=rho,
            strips=strips,
        )

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for; the small part in roll is not claimed, a roll damping load may stand beside."""
        lateral = {"sway", "yaw"} if np.any(self.points[:, 2] > 0.0) else set()
        vertical = {"heave", "pitch"} if np.any(self.points[:, 3] > 0.0) else set()
        return frozenset(quadratic_effect(d) for d in lateral | vertical)

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the compiled force for the time loop."""
        return Terms(kernel=Kernel(cross_flow_force, self.points.flatten()))


def gauss_points(x: Array, intervals: int) -> tuple[Array, Array]:
    """Return two Gauss points (m,) in each interval and their weights, over stations divided to at least so many intervals.

    Notes
    -----
    x = 0 is a boundary where it lies inside: the drag in pure yaw has a kink there.

    Examples
    --------
    >>> at, weight = gauss_points(np.array([-1.0, 1.0]), 2)
    >>> round(float(weight @ np.abs(at) ** 3), 12)
    0.5
    """
    if not (isinstance(intervals, int | np.integer) and intervals >= 1):
        raise InputError(f"strips: a whole number >= 1 expected, {intervals!r} found.")
    even = np.linspace(x[0], x[-1], intervals + 1)
    edge = np.r_[x, even, 0.0 if x[0] < 0.0 < x[-1] else x[0]]
    edge = np.unique(edge)
    edge = edge[np.r_[True, np.diff(edge) > 1e-9 * (x[-1] - x[0])]]
    middle, step = 0.5 * (edge[1:] + edge[:-1]), np.diff(edge)
    at = np.stack([middle - _GAUSS * step, middle + _GAUSS * step], axis=1).ravel()
    return at, np.repeat(0.5 * step, 2)
