"""Sinkage, heel and trim at which a hull and a weight are in equilibrium."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import ConvergenceError, InputError
from ogilvie.frames import rotation_matrix
from ogilvie.mesh.clip import clip_below
from ogilvie.mesh.hydrostatics import Hydrostatics, Weight, hydrostatics
from ogilvie.mesh.integrals import MIRROR, triangles
from ogilvie.mesh.panels import PanelMesh
from ogilvie.mesh.topology import open_edges, without_t_junctions
from ogilvie.units import GRAVITY, SEA_WATER, deg

Array = NDArray[np.float64]

MAX_ANGLE = 60.0 * deg
MAX_STEPS = 60
GAP = 0.01  #: part of the extent up to which two open edges side by side are a gap between patches, not an opening


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """How a body floats at rest; print it.

    Parameters
    ----------
    sinkage : float
        Height of the body's origin above the still water, m (negative: deeper than it was).
    heel, trim : float
        phi (positive port side up) and theta (positive bow down), rad.
    cog : (3,) array
        Centre of gravity in the axes of `hull`, m.
    hull : PanelMesh
        Wetted hull in horizontal axes: still water z = 0, origin above or below the body's.
    hydrostatics : Hydrostatics
        Of that hull with the body's weight.
    iterations : int
    """

    sinkage: float
    heel: float
    trim: float
    cog: Array
    hull: PanelMesh
    hydrostatics: Hydrostatics
    iterations: int

    def __str__(self) -> str:
        angles = f"heel {self.heel / deg:.6g} deg, trim {self.trim / deg:.6g} deg (positive bow down)"
        head = f"equilibrium: sinkage {self.sinkage:.6g} m, {angles}"
        return f"{head}\n{self.hydrostatics}"


def equilibrium(mesh: PanelMesh, body: Weight, *, rho: float = SEA_WATER, g: float = GRAVITY) -> Equilibrium:
    """Return the stable equilibrium of a body that floats freely.

    Parameters
    ----------
    mesh : PanelMesh
        Hull up to the deck (not clipped), in the body's axes, at a position near or far from that of rest.
    body : RigidBody
        Mass and centre of gravity, in the same axes.
    rho, g : float
        kg/m3, m/s2.

    Returns
    -------
    Equilibrium

    Raises
    ------
    InputError
        Normals into the body.
    ConvergenceError
        The body sinks, its deck edge (open at the top) gets below water, or it has no stable equilibrium within 60 deg.

    Notes
    -----
    Newton's method on buoyancy - weight and the moments of both about the origin, in (z, phi, theta), with the exact stiffness
    of the instantaneous wetted hull, steps limited. Heel (trim) is left out where symmetry makes it zero. The solution is
    refused unless the stiffness in heave, heel and trim is positive definite there.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> v = [[-5.0, 0, -1], [5, 0, -1], [5, 2, -1], [-5, 2, -1], [-5, 0, 2], [5, 0, 2], [5, 2, 2], [-5, 2, 2]]
    >>> f = [[0, 3, 2, 1], [2, 3, 7, 6], [1, 2, 6, 5], [0, 4, 7, 3]]
    >>> barge = PanelMesh(v, f, symmetry="xz", name="barge")
    >>> rest = equilibrium(barge, SimpleNamespace(mass=1025.0 * 60.0, cog=np.array([0.0, 0.0, -0.5])))
    >>> round(rest.sinkage, 12), rest.heel, round(rest.hydrostatics.draught, 12)
    (-0.5, 0.0, 1.5)
    """
    if mesh.volumes[:2].mean() <= 0.0:
        raise InputError(f"equilibrium: normals of {mesh.name!r} into the fluid expected. Use .flipped().")
    if not (rho > 0.0 and g > 0.0 and body.mass > 0.0):
        raise InputError(f"equilibrium: positive rho, g and mass expected, {rho!r}, {g!r} and {body.mass!r} found.")
    problem = _Floating(mesh, body, rho)
    q = np.array([problem.sinkage(), 0.0, 0.0])
    q, iterations = problem.solve(q)
    return problem.result(q, g, iterations)


class _Floating:
    """A hull as triangles and a weight: residual and Jacobian in q = (z, phi, theta), all divided by rho g."""

    def __init__(self, mesh: PanelMesh, body: Weight, rho: float) -> None:
        self.mesh, self.body, self.rho = mesh.with_lid(None), body, rho
        self.cog = np.asarray(body.cog, dtype=float)
        self.load = float(body.mass) / rho  # m3
        self.size = float(np.ptp(mesh.bounds, axis=0).max())
        tri = triangles(mesh.faces)
        self.flat = PanelMesh(mesh.vertices, tri[:, [0, 1, 2, 2]], symmetry=mesh.symmetry, name=mesh.name)
        heels = "xz" not in mesh.planes or abs(self.cog[1]) > 1e-12 * self.size
        trims = "yz" not in mesh.planes or abs(self.cog[0]) > 1e-12 * self.size
        self.active = np.array([True, heels, trims])

    def wetted(self, q: Array) -> PanelMesh | None:
        """Return the wetted hull at q as triangles, None where nothing is wet."""
        moved = _posed(self.flat, q)
        vertices, faces = clip_below(moved.vertices, moved.faces, tolerance=moved.tolerance)
        return PanelMesh(vertices, faces, symmetry=moved.symmetry, name=self.mesh.name) if len(faces) else None

    def sinkage(self) -> float:
        """Return z at which the upright hull displaces its weight (bisection: the volume falls with z)."""
        low, high = -float(self.mesh.bounds[1, 2]), -float(self.mesh.bounds[0, 2])  # deck, keel at the waterline
        full = self.wetted(np.array([low, 0.0, 0.0]))
        if full is None or full.volume < self.load:
            most = 0.0 if full is None else full.volume
            raise ConvergenceError(
                f"equilibrium: {self.mesh.name!r} sinks: {self.body.mass:.6g} kg need {self.load:.6g} m3, the hull up to its "
                f"highest point holds {most:.6g} m3. Check the mass, or give the hull up to the deck (not clipped)."
            )
        for _ in range(25):
            z = 0.5 * (low + high)
            wet = self.wetted(np.array([z, 0.0, 0.0]))
            low, high = (z, high) if wet is not None and wet.volume > self.load else (low, z)
        return 0.5 * (low + high)

    def residual(self, q: Array) -> tuple[Array, Array]:
        """Return (force, heeling, trimming moment) / (rho g) and its Jacobian with respect to q."""
        wet = self.wetted(q)
        if wet is None:
            return np.array([-self.load, np.nan, np.nan]), np.eye(3)
        G = rotation_matrix(q[1], q[2], 0.0) @ self.cog + [0.0, 0.0, q[0]]
        M0, M1, M2 = wet.moments
        V, Vb, m = M1[2, 2], M2[2, :, 2] * [1.0, 1.0, 0.5], self.load
        r = np.array([V - m, Vb[1] - m * G[1], m * G[0] - Vb[0]])
        Aw, S, SS = -M0[2], -M1[2, :2], -M2[2, :2, :2]
        lever = Vb[2] - m * G[2]  # turning about the point (0, 0, z) moves hull and weight alike: r[1:] change by r[0] z
        shift = (V - m) * q[0]
        K = np.array(  # minus the derivatives of r by heave and by turning about the horizontal axes through O
            [
                [Aw, S[1], -S[0]],
                [S[1], SS[1, 1] + lever - shift, -SS[0, 1]],
                [-S[0], -SS[0, 1], SS[0, 0] + lever - shift],
            ]
        )
        yaw = np.array([0.0, -r[2], r[1]])  # change of the moments' components by turning about z
        c, s = np.cos(q[2]), np.sin(q[2])
        return r, -np.column_stack([K[:, 0], K[:, 1] * c + yaw * s, K[:, 2]])

    def solve(self, q: Array) -> tuple[Array, int]:
        """Return the root of the residual by Newton's method with limited, halved steps."""
        scale = 1.0 / (self.load * np.array([1.0, self.size, self.size]))
        limit = np.array([0.1 * self.size, 0.1, 0.1])
        a = self.active
        r, J = self.residual(q)
        for iteration in range(MAX_STEPS):
            error = np.abs(r * scale)[a].max()
            if error < 1e-13:
                return q, iteration
            dq = np.zeros(3)
            dq[a] = np.linalg.lstsq(J[np.ix_(a, a)], -r[a], rcond=None)[0]
            dq /= max(1.0, float((np.abs(dq) / limit).max()))
            for _ in range(30):
                r_new, J_new = self.residual(q + dq)
                if np.abs(r_new * scale)[a].max() < error:
                    break
                dq *= 0.5
            else:
                if error < 1e-10:  # rounding
                    return q, iteration
                raise ConvergenceError(f"equilibrium: no position with less imbalance found near {_text(q)}. {_ADVICE}")
            q, r, J = q + dq, r_new, J_new
            if np.abs(q[1:]).max() > MAX_ANGLE:
                raise ConvergenceError(f"equilibrium: {self.mesh.name!r} capsizes: it passes {_text(q)}. {_ADVICE}")
        raise ConvergenceError(f"equilibrium: not reached in {MAX_STEPS} steps, last position {_text(q)}. {_ADVICE}")

    def result(self, q: Array, g: float, iterations: int) -> Equilibrium:
        """Return what was found, if it is stable and dry."""
        z, phi, theta = (float(v) for v in q)
        hull = _posed(self.mesh, q)
        cog = rotation_matrix(phi, theta, 0.0) @ self.cog + [0.0, 0.0, z]
        self._require_dry(q)
        statics = hydrostatics(hull.immersed(), body=_Point(float(self.body.mass), cog), rho=self.rho, g=g)
        smallest = _smallest_eigenvalue(statics.stiffness[2:5, 2:5], self.size)
        if smallest <= 0.0:
            raise ConvergenceError(
                f"equilibrium: {self.mesh.name!r} capsizes: at {_text(q)} it is in balance but not stable "
                f"(GM_T {statics.GM_T:.4g} m, GM_L {statics.GM_L:.4g} m). {_ADVICE}"
            )
        return Equilibrium(z, phi, theta, cog, hull.immersed(), statics, iterations)

    def _require_dry(self, q: Array) -> None:
        mesh, close = self.mesh, 1e-6 * self.size
        start, end, _ = open_edges(mesh.vertices, mesh.faces, planes=mesh.planes, tolerance=close)
        rim = without_t_junctions(mesh.vertices, start, end, tolerance=GAP * self.size)
        points = mesh.vertices[np.concatenate([start[rim], end[rim]])]
        for plane in mesh.planes:
            points = np.concatenate([points, points * MIRROR[plane]])
        R = rotation_matrix(q[1], q[2], 0.0)
        lowest = float((points @ R.T)[:, 2].min() + q[0]) if len(points) else np.inf
        if lowest < -close:
            raise ConvergenceError(
                f"equilibrium: {self.mesh.name!r} floods: its open upper edge is {-lowest:.4g} m below water at {_text(q)}. "
                f"Give the hull with its deck, or reduce the weight."
            )


@dataclass(frozen=True)
class _Point:
    mass: float
    cog: Array


_ADVICE = "Check mass and centre of gravity (from O, z up) against the hull's axes."


def _posed(mesh: PanelMesh, q: Array) -> PanelMesh:
    return mesh.rotated(float(q[1]), float(q[2])).translated((0.0, 0.0, float(q[0])))


def _smallest_eigenvalue(C: Array, size: float) -> float:
    scale = np.array([1.0, 1.0 / size, 1.0 / size])
    return float(np.linalg.eigvalsh(C * scale[:, None] * scale)[0])


def _text(q: Array) -> str:
    return f"sinkage {q[0]:.4g} m, heel {q[1] / deg:.4g} deg, trim {q[2] / deg:.4g} deg"
