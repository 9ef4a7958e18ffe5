"""Exact hydrostatic restoring of a hull in still water, for large heave, roll and pitch."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.loads.base import RESTORING, Surroundings, Terms
from ogilvie.loads.given import number
from ogilvie.loads.kernel import ETA, Kernel, load_kernel
from ogilvie.loads.pose import add_generalised
from ogilvie.loads.tricubic import coefficients, evaluate
from ogilvie.mesh.buoyancy import corners, energy_gradient, potential_energy
from ogilvie.mesh.deck import decked
from ogilvie.mesh.hydrostatics import Weight, hydrostatics
from ogilvie.mesh.panels import PanelMesh
from ogilvie.units import GRAVITY, SEA_WATER, deg

Array = NDArray[Any]

_HEAD = 12  # sizes, first values, steps, gradient that is added


@load_kernel
def hull_force(x: Array, data: Array, own: Array, force: Array) -> None:
    """Gradient of the tabulated energy; data: sizes (3), first values (3), steps (3), added gradient (3), coefficients."""
    n1, n2, n3 = int(data[0]), int(data[1]), int(data[2])
    c = data[12 : 12 + n1 * n2 * n3].reshape((n1, n2, n3))
    a = (x[ETA + 2] - data[3]) / data[6]
    b = (x[ETA + 3] - data[4]) / data[7]
    d = (x[ETA + 4] - data[5]) / data[8]
    _, heave, roll, pitch = evaluate(c, a, b, d)
    heave, roll, pitch = heave / data[6] + data[9], roll / data[7] + data[10], pitch / data[8] + data[11]
    add_generalised(x, -heave, -roll, -pitch, force)


@njit(cache=True, nogil=True)
def energies(p: Array, mass: float, cog: Array, z: Array, phi: Array, theta: Array) -> Array:
    """Return the energies (n_z, n_phi, n_theta) of all poses, over rho g."""
    out = np.empty((z.size, phi.size, theta.size))
    for j in range(phi.size):
        for k in range(theta.size):
            for i in range(z.size):
                out[i, j, k] = potential_energy(p, mass, cog, z[i], phi[j], theta[k])
    return out


@dataclass(frozen=True, eq=False, init=False)
class HullRestoring:
    """Weight and buoyancy of a hull cut by still water at its pose, from a table of their energy.

    Parameters
    ----------
    hull : PanelMesh
        Up to the deck, in the body's axes; a watertight deck is put across where it is open at the top.
    body : RigidBody
        Mass and centre of gravity.
    heave : float or pair, optional
        Range of z of O, m, or its half width; by default 0.6 draughts either way.
    roll, pitch : float or pair
        Ranges, rad, or their half widths.
    points : (int, int, int)
        Points of the table in heave, roll and pitch, >= 5 each.
    rho, g : float
        kg/m3, m/s2.

    Raises
    ------
    InputError
        Hull without freeboard, normals into the body, a range without 0 inside, too few points.

    Notes
    -----
    E(z, phi, theta) = m g z_G - rho g V z_b, exact for the panels, at the points of a uniform grid and between them by a
    tricubic spline; generalised forces -dE/dz, -dE/dphi, -dE/dtheta, mapped to the body axes by J^T. So the work around any
    closed path is zero by construction. A linear term makes the force at eta = 0 that of the panels (zero for a body that
    floats there). Errors of the force fall with the third power of the steps, those of its slope with the second, slower where
    the deck, the bilge or a knuckle passes the water. Outside the table the force is NaN and a run stops. Attributes:
    `stiffness` (6, 6), the linear limit; `rest` (3,), the generalised force at eta = 0; `weight` (4,), mass and centre of
    gravity.

    References
    ----------
    Newman (1977), Marine Hydrodynamics, section 6.16, for the linear limit.

    Examples
    --------
    >>> from ogilvie.body import RigidBody
    >>> from ogilvie.loads.base import Surroundings
    >>> from ogilvie.mesh.shapes import box
    >>> barge = box(60.0, 10.0, 8.0, panels=100).translated((0, 0, 5.0))  # draught 3 m
    >>> body = RigidBody.from_hull(barge.immersed(), zg=0.5, gyradii=(3.5, 15.0, 15.0))
    >>> load = HullRestoring(barge, body, roll=40 * deg, pitch=2 * deg, points=(9, 41, 9))
    >>> s, t = np.sin(20 * deg), np.tan(20 * deg)  # wall-sided: m g sin(phi) (GM + BM / 2 tan^2(phi))
    >>> moment = load.bind(Surroundings(body)).kernel.force(eta=[0, 0, 0, 20 * deg, 0, 0])[3]
    >>> round(float(moment / (-body.mass * 9.80665 * s * (7 / 9 + 0.5 * 100 / 36 * t**2))), 4)
    1.0
    """

    data: Array
    rest: Array
    stiffness: Array
    weight: Array
    limits: str
    name: str = "restoring"

    def __init__(
        self,
        hull: PanelMesh,
        body: Weight,
        *,
        heave: float | tuple[float, float] | None = None,
        roll: float | tuple[float, float] = 60.0 * deg,
        pitch: float | tuple[float, float] = 8.0 * deg,
        points: tuple[int, int, int] = (25, 61, 25),
        rho: float = SEA_WATER,
        g: float = GRAVITY,
    ) -> None:
        closed = decked(hull)
        spans = [
            _span(0.6 * hull.draught if heave is None else heave, "heave (m)"),
            _span(roll, "roll (rad)", np.pi),
            _span(pitch, "pitch (rad)", 0.5 * np.pi),
        ]
        if len(points) != 3 or any(not isinstance(n, int) or n < 5 for n in points):
            raise InputError(f"HullRestoring: points: three whole numbers >= 5 expected, {points!r} found.")
        density = number(rho, "HullRestoring: rho (kg/m3)", above=0.0)
        weight = density * number(g, "HullRestoring: g (m/s2)", above=0.0)
        axes = [np.linspace(a, b, n) for (a, b), n in zip(spans, points, strict=True)]
        p, mass, cog = corners(closed), float(body.mass) / density, np.array(body.cog, dtype=float)
        mirrored = "xz" in hull.planes and cog[1] == 0.0 and spans[1][0] == -spans[1][1]
        E = weight * _table(p, mass, cog, axes, mirrored)
        c = coefficients(E - E.mean())
        first, step = np.array([a[0] for a in axes]), np.array([a[1] - a[0] for a in axes])
        rest = weight * energy_gradient(p, mass, cog, 0.0, 0.0, 0.0)
        found = np.array(evaluate(c, *(-first / step))[1:]) / step
        data = np.concatenate([c.shape, first, step, rest - found, c.ravel()])
        tangent = hydrostatics(hull.immersed(), body=body, rho=density, g=weight / density).stiffness
        body_weight = np.r_[float(body.mass), cog]
        for key, value in (("data", data), ("rest", -rest), ("stiffness", tangent), ("weight", body_weight)):
            value.setflags(write=False)
            object.__setattr__(self, key, value)
        (z0, z1), roll_range, pitch_range = spans
        degrees = [f"{a:.4g}..{b:.4g} deg" for a, b in np.degrees([roll_range, pitch_range])]
        object.__setattr__(self, "limits", f"heave {z0:.4g}..{z1:.4g} m, roll {degrees[0]}, pitch {degrees[1]}")
        object.__setattr__(self, "name", "restoring")

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({RESTORING})

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the compiled force for the time loop; the vessel's body has to be the one of the table."""
        body = surroundings.body
        if not np.allclose(np.r_[body.mass, body.cog], self.weight, rtol=1e-9, atol=1e-9):
            raise InputError(
                f"HullRestoring: the vessel's body expected ({body.mass:.6g} kg at {body.cog.tolist()}), "
                f"{self.weight[0]:.6g} kg at {self.weight[1:].tolist()} found in the table. Make it with the vessel's body."
            )
        return Terms(kernel=Kernel(hull_force, self.data, limits=self.limits), small=Terms(stiffness=self.stiffness))

    def energy(self, z: float, phi: float, theta: float) -> float:
        """Return the potential energy of a pose, J, up to a constant; NaN outside the table."""
        n = self.data[:3].astype(int)
        q = np.array([z, phi, theta], dtype=float)
        place = (q - self.data[3:6]) / self.data[6:9]
        return float(evaluate(self.data[_HEAD:].reshape(n), *place)[0] + self.data[9:12] @ q)


def _table(p: Array, mass: float, cog: Array, axes: list[Array], mirrored: bool) -> Array:
    """Return the energies of the grid; for a hull and a weight that are symmetric those of one side, and their image."""
    z, phi, theta = axes
    if not mirrored:
        return np.asarray(energies(p, mass, cog, z, phi, theta))
    half = len(phi) // 2
    one = energies(p, mass, cog, z, phi[half:], theta)
    return np.concatenate([one[:, : 0 if len(phi) % 2 else None : -1], one], axis=1)


def _span(value: float | tuple[float, float], what: str, most: float = np.inf) -> tuple[float, float]:
    """Return the ends of a range that holds 0 well inside."""
    ends = (-value, value) if isinstance(value, int | float | np.number) else tuple(value)
    if len(ends) != 2 or not np.all(np.isfinite(ends)) or not -most <= ends[0] < 0.0 < ends[1] <= most:
        limit = f" within {most:.4g}" if most < np.inf else ""
        raise InputError(f"HullRestoring: {what}: a half width or a range around 0{limit} expected, {value!r} found.")
    return float(ends[0]), float(ends[1])
