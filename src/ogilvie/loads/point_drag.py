"""Drag of parts small against the motion: members of a semisubmersible, plates, bilge keels, as points (Morison)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.schema import DOFS
from ogilvie.loads.base import Surroundings, Terms, dof_indices
from ogilvie.loads.cross_flow import gauss_points
from ogilvie.loads.given import ascending, column, number
from ogilvie.loads.kernel import NU_R, Kernel, load_kernel
from ogilvie.loads.viscous import quadratic_effect
from ogilvie.units import SEA_WATER

Array = NDArray[Any]

_PLATE, _MEMBER = 0.0, 1.0


@load_kernel
def point_drag_force(x: Array, data: Array, own: Array, force: Array) -> None:
    """Drag of points; data: rows (x, y, z, d_x, d_y, d_z, 1/2 rho Cd A, kind)."""
    u, v, w, p, q, r = x[NU_R], x[NU_R + 1], x[NU_R + 2], x[NU_R + 3], x[NU_R + 4], x[NU_R + 5]
    for k in range(data.size // 8):
        X, Y, Z = data[8 * k], data[8 * k + 1], data[8 * k + 2]
        a, b, d = data[8 * k + 3], data[8 * k + 4], data[8 * k + 5]
        vx, vy, vz = u + q * Z - r * Y, v + r * X - p * Z, w + p * Y - q * X
        along = vx * a + vy * b + vz * d
        if data[8 * k + 7] == 0.0:
            vx, vy, vz = along * a, along * b, along * d
        else:
            vx, vy, vz = vx - along * a, vy - along * b, vz - along * d
        c = -data[8 * k + 6] * np.sqrt(vx * vx + vy * vy + vz * vz)
        fx, fy, fz = c * vx, c * vy, c * vz
        force[0] += fx
        force[1] += fy
        force[2] += fz
        force[3] += Y * fz - Z * fy
        force[4] += Z * fx - X * fz
        force[5] += X * fy - Y * fx


@dataclass(frozen=True, eq=False, init=False)
class PointDrag:
    """Quadratic drag of many small parts, each at a point of the body.

    Parameters
    ----------
    points : (n, 3) array
        From O in body axes, m.
    directions : (3,) or (n, 3) array
        Of a plate its normal, of a member its axis; made unit vectors.
    coefficients : float or (n,) array
        1/2 rho Cd A, kg/m.
    kind : {"plate", "member"} or sequence of them
        "plate": drag along the direction, of the velocity along it. "member": drag of the velocity across the axis.
    covers : sequence of str, optional
        Degrees of freedom whose nonlinear viscous damping this is; by default all in which the points meet resistance.

    Raises
    ------
    InputError
        Shapes that do not agree, NaN, a direction of no length, negative coefficient, unknown kind or degree of freedom.

    Notes
    -----
    With the velocity of the point through the water v = v_r + omega x r: plate ``F = -c |v.d| (v.d) d``; member
    ``F = -c |v_n| v_n`` with v_n = v - (v.a) a. The water moves with the current alone; the orbital velocity of waves is left
    out.

    References
    ----------
    Morison et al. (1950); DNV-RP-C205 (2021), section 6.3, drag on members at an angle to the flow.

    Examples
    --------
    >>> plate = PointDrag([[0.0, 10.0, -5.0]], [0.0, 0.0, 1.0], 2.0)
    >>> plate.bind(None).kernel.force(nu=[9.0, 0, 1.0, 0.1, 0, 0]).tolist()  # at the plate w = 1 + 10 0.1
    [0.0, 0.0, -8.0, -80.0, 0.0, 0.0]
    """

    data: Array
    damped: tuple[str, ...]
    name: str = "point_drag"

    def __init__(
        self,
        points: ArrayLike,
        directions: ArrayLike,
        coefficients: ArrayLike,
        *,
        kind: str | Sequence[str] = "plate",
        covers: Sequence[str] | None = None,
    ) -> None:
        at = column(points, "PointDrag: points (m)", wide=3)
        n = len(at)
        d = column(directions, "PointDrag: directions", n=n, wide=3)
        size = np.linalg.norm(d, axis=1, keepdims=True)
        if np.any(size == 0.0):
            raise InputError("PointDrag: directions of some length expected, (0, 0, 0) found.")
        c = column(coefficients, "PointDrag: coefficients (kg/m)", n=n, least=0.0)
        kinds = [kind] * n if isinstance(kind, str) else list(kind)
        if len(kinds) != n or not set(kinds) <= {"plate", "member"}:
            raise InputError(f"PointDrag: kind 'plate' or 'member', one or {n}, expected, {kind!r} found.")
        data = np.column_stack([at, d / size, c, [_PLATE if k == "plate" else _MEMBER for k in kinds]])
        data.setflags(write=False)
        damped = _damped(data) if covers is None else tuple(DOFS[i] for i in dof_indices(tuple(covers)))
        object.__setattr__(self, "data", data)
        object.__setattr__(self, "damped", damped)
        object.__setattr__(self, "name", "point_drag")

    @classmethod
    def from_members(
        cls,
        start: ArrayLike,
        end: ArrayLike,
        *,
        width: ArrayLike,
        cd: ArrayLike,
        cd_end: ArrayLike = 0.0,
        rho: float = SEA_WATER,
        segments: int = 10,
    ) -> "PointDrag":
        """Return the drag of straight members, cut off at the still water.

        Parameters
        ----------
        start, end : (m, 3) array
            Ends of the axes, m.
        width : float or (m,) array
            Diameter or width across the flow, m.
        cd : float or (m,) array
            Drag coefficient on the width.
        cd_end : float or (m,) array
            Drag coefficient of each wet end as a disc of that diameter, along the axis; an end above the water has none.
        rho : float
            kg/m3.
        segments : int
            Points of each member, in the middles of equal pieces of its wet part.

        Examples
        --------
        >>> column = PointDrag.from_members([[0.0, 0, -20]], [[0.0, 0, 10]], width=8.0, cd=1.0, rho=1000.0)
        >>> column.bind(None).kernel.force(nu=[1.0, 0, 0, 0, 0, 0])[:3].round(6).tolist()  # -1/2 1000 8 20
        [-80000.0, 0.0, 0.0]
        """
        a, b = column(start, "from_members: start (m)", wide=3), column(end, "from_members: end (m)", wide=3)
        if a.shape != b.shape:
            raise InputError(f"from_members: as many ends as starts expected, {len(b)} and {len(a)} found.")
        if not (isinstance(segments, int) and segments >= 1):
            raise InputError(f"from_members: segments >= 1 expected, {segments!r} found.")
        m = len(a)
        D, C = (column(v, f"from_members: {k}", n=m, least=0.0) for v, k in ((width, "width (m)"), (cd, "cd")))
        Ce = column(cd_end, "from_members: cd_end", n=m, least=0.0)
        half = 0.5 * number(rho, "from_members: rho (kg/m3)", above=0.0)
        rows: list[tuple[Any, Any, float, str]] = []
        for k in range(m):
            p, q = _wet_part(a[k], b[k])
            length = float(np.linalg.norm(q - p))
            for s in (np.arange(segments) + 0.5) / segments:
                rows.append((p + s * (q - p), b[k] - a[k], half * C[k] * D[k] * length / segments, "member"))
            if Ce[k] > 0.0:
                disc = half * Ce[k] * 0.25 * np.pi * D[k] ** 2
                rows += [(e, b[k] - a[k], disc, "plate") for e, whole in ((p, a[k]), (q, b[k])) if np.array_equal(e, whole)]
        return cls(*(np.array([r[i] for r in rows]) for i in range(3)), kind=[r[3] for r in rows])

    @classmethod
    def bilge_keels(
        cls, x: ArrayLike, *, y: ArrayLike, z: ArrayLike, breadth: ArrayLike, cd: ArrayLike, rho: float = SEA_WATER
    ) -> "PointDrag":
        """Return the normal force of a pair of bilge keels in roll; the pressure that they cause on the hull is not in it.

        Parameters
        ----------
        x : (n,) array
            Stations along the keel, ascending, m.
        y, z : float or (n,) array
            Middle of the port keel, m; the keel stands off along the radius from (0, 0): its normal is across that.
        breadth : float or (n,) array
            Of the keel, m.
        cd : float or (n,) array
            Drag coefficient on the breadth, increase of the velocity at the bilge included: of the order of 2.4 + 22.5 b /
            (pi r phi_a) by Ikeda for keels of breadth b at the radius r in roll of amplitude phi_a.
        rho : float
            kg/m3.

        Notes
        -----
        Roll alone is claimed in `covers`, so the drag of the hull in other directions may stand beside it. The normal is
        tangential to a circle about O.

        Examples
        --------
        >>> keels = PointDrag.bilge_keels([-30.0, 30.0], y=8.0, z=-6.0, breadth=0.4, cd=4.0, rho=1000.0)
        >>> force = keels.bind(None).kernel.force(nu=[0, 0, 0, 1.0, 0, 0])
        >>> round(float(force[3]))  # two keels: -1/2 1000 4 0.4 60 r^3 with r = 10
        -96000000
        """
        place = ascending(x, "bilge_keels: x (m)")
        n = len(place)
        Y, Z = (column(v, f"bilge_keels: {k} (m)", n=n) for v, k in ((y, "y"), (z, "z")))
        b, C = (column(v, f"bilge_keels: {k}", n=n, least=0.0) for v, k in ((breadth, "breadth (m)"), (cd, "cd")))
        at, step = gauss_points(place, 10)
        Y, Z, area = (np.interp(at, place, v) for v in (Y, Z, b * C))
        c = 0.5 * number(rho, "bilge_keels: rho (kg/m3)", above=0.0) * area * step
        both = [(np.column_stack([at, s * Y, Z]), np.column_stack([0.0 * at, -Z, s * Y])) for s in (1.0, -1.0)]
        points, normals = (np.concatenate([side[i] for side in both]) for i in (0, 1))
        return cls(points, normals, np.r_[c, c], covers=("roll",))

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset(quadratic_effect(d) for d in self.damped)

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the compiled force for the time loop."""
        return Terms(kernel=Kernel(point_drag_force, self.data.flatten()))


def _wet_part(a: Array, b: Array) -> tuple[Array, Array]:
    """Return the ends of the part of a straight member with z <= 0."""
    if max(a[2], b[2]) <= 0.0:
        return a, b
    if min(a[2], b[2]) >= 0.0:
        raise InputError(f"from_members: members that reach below the water expected, {a.tolist()} to {b.tolist()} found.")
    cut = a + a[2] / (a[2] - b[2]) * (b - a)
    return (cut, b) if a[2] > 0.0 else (a, cut)


def _damped(data: Array) -> tuple[str, ...]:
    """Return the degrees of freedom in which the points meet resistance."""
    found = []
    for i, dof in enumerate(DOFS):
        nu = np.zeros(6)
        nu[i] = 1.0
        if abs(Kernel(point_drag_force, data.flatten()).force(nu=nu)[i]) > 0.0:
            found.append(dof)
    return tuple(found)
