"""Righting levers of a hull over the angle of heel, with free sinkage and trim."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import ConvergenceError, InputError
from ogilvie.frames import rotation_matrix
from ogilvie.mesh.buoyancy import corners, energy_gradient
from ogilvie.mesh.deck import decked, rim
from ogilvie.mesh.hydrostatics import Weight
from ogilvie.mesh.panels import PanelMesh
from ogilvie.units import SEA_WATER, deg, tonne

Array = NDArray[Any]

_STEPS = 60
_NEAR = 1e-3  # rad: heel of the two levers that give GM
_CLOSE = 1e-12  # imbalance over the weight


@dataclass(frozen=True, eq=False)
class GZCurve:
    """Righting levers over heel; print it.

    Parameters
    ----------
    name : str
    angles, gz : (n,) array
        Heel phi, ascending, rad (positive port side up) and lever, m: positive where it rights a positive heel.
    sinkage, trim : (n,) array
        z, m, and theta, rad (positive bow down), of the body's origin in balance at each heel.
    displacement : float
        Mass, kg.
    gm : float
        Slope of the lever at zero heel, m/rad.
    deck_angle : float
        Heel at which the open edge of the hull, where the deck is, gets wet, rad; NaN within these angles or without an edge.
    """

    name: str
    angles: Array
    gz: Array
    sinkage: Array
    trim: Array
    displacement: float
    gm: float
    deck_angle: float

    @cached_property
    def spline(self) -> Any:
        """Cubic spline of the lever (m) over heel (rad), NaN outside."""
        from scipy.interpolate import CubicSpline

        return CubicSpline(self.angles, self.gz, extrapolate=False)

    def area(self, to: float, start: float = 0.0) -> float:
        """Return the area under the curve between two angles (rad), m rad; NaN outside the curve."""
        return float(self.spline.integrate(start, to, extrapolate=False))

    @property
    def max_angle(self) -> float:
        """Positive heel of the largest lever, rad; NaN where the curve has no positive heel."""
        stationary = self.spline.derivative().roots(extrapolate=False)
        at = np.r_[stationary[stationary >= 0.0], self.angles[self.angles >= 0.0]]
        return float(at[int(np.argmax(self.spline(at)))]) if len(at) else float("nan")

    @property
    def max_gz(self) -> float:
        """Largest lever at a positive heel, m."""
        return float(self.spline(self.max_angle))

    @property
    def vanishing_angle(self) -> float:
        """Heel beyond that of the largest lever at which it vanishes, rad; NaN if that is beyond the curve."""
        roots = self.spline.roots(extrapolate=False)
        beyond = roots[roots > self.max_angle]
        return float(beyond[0]) if len(beyond) and self.max_gz > 0.0 else float("nan")

    def __str__(self) -> str:
        lines = [
            f"righting levers of {self.name}, displacement {self.displacement / tonne:.6g} t, GM {self.gm:.5g} m",
            f"largest {self.max_gz:.5g} m at {self.max_angle / deg:.4g} deg, "
            f"vanishing at {self.vanishing_angle / deg:.4g} deg, deck edge wet at {self.deck_angle / deg:.4g} deg",
            "  heel [deg]    GZ [m]  area [m rad]  sinkage [m]  trim [deg]",
        ]
        for a, lever, z, t in zip(self.angles, self.gz, self.sinkage, self.trim, strict=True):
            lines.append(f"{a / deg:12.4g} {lever:9.4f} {self._area(a):13.4f} {z:12.4f} {t / deg:11.4f}")
        return "\n".join(lines)

    def _area(self, angle: float) -> float:
        return self.area(angle, min(max(0.0, self.angles[0]), self.angles[-1]))


def gz_curve(
    hull: PanelMesh, body: Weight, angles: ArrayLike | None = None, *, free_trim: bool = True, rho: float = SEA_WATER
) -> GZCurve:
    """Return the righting levers of a body in still water.

    Parameters
    ----------
    hull : PanelMesh
        Up to the deck (not clipped at the water), in the body's axes. Where it is open at the top a watertight deck is put
        across: the levers are those of the hull weathertight up to there.
    body : RigidBody
        Mass and centre of gravity in the same axes.
    angles : (n,) array, optional
        Heel, ascending, n >= 4, rad, within +-180 deg; by default 0 to 80 deg by 2.5 deg.
    free_trim : bool
        False holds theta at zero.
    rho : float
        kg/m3.

    Returns
    -------
    GZCurve

    Raises
    ------
    InputError
        Hull without freeboard, normals into the body, angles that do not ascend.
    ConvergenceError
        The body sinks, or no sinkage and trim in balance are found at an angle.

    Notes
    -----
    At each heel E(z, phi, theta) = m z_G / rho - V z_b is at its least over z and theta, so that buoyancy equals weight and
    nothing trims the body; GZ = dE/dphi rho / m there. The moment is that about the body's longitudinal axis, the lever
    that belongs to roll; the area under the curve is the work done on the body. Buoyancy is exact for the panels.

    References
    ----------
    IMO, International Code on Intact Stability 2008 (MSC.267(85)), part A, 2.1 and part B, 3.5: free trim.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> from ogilvie.mesh.shapes import box
    >>> barge = box(60.0, 10.0, 8.0, panels=100).translated((0, 0, 5.0))  # draught 3 m, freeboard 5 m, open at the top
    >>> body = SimpleNamespace(mass=1025.0 * 60 * 10 * 3, cog=np.array([0.0, 0.0, 0.5]))
    >>> curve = gz_curve(barge, body, np.arange(0.0, 41.0, 5.0) * deg)
    >>> round(curve.gm, 4)  # KB + BM - KG = 1.5 + 100 / 36 - 3.5
    0.7778
    >>> s, t = np.sin(20 * deg), np.tan(20 * deg)  # wall-sided: sin(phi) (GM + BM / 2 tan^2(phi))
    >>> round(float(curve.gz[4] / (s * (7 / 9 + 0.5 * 100 / 36 * t**2))), 6)
    1.0
    """
    phi = np.arange(0.0, 80.1, 2.5) * deg if angles is None else np.array(angles, dtype=float)
    if phi.ndim != 1 or len(phi) < 4 or not np.all(np.isfinite(phi)) or np.any(np.diff(phi) <= 0.0):
        raise InputError(f"gz_curve: at least four ascending angles (rad) expected, {angles!r} found.")
    if np.abs(phi).max() > np.pi:
        raise InputError(f"gz_curve: angles within 180 deg expected, {np.abs(phi).max() / deg:.4g} deg found (give radians).")
    if not (np.isfinite(rho) and rho > 0.0 and body.mass > 0.0):
        raise InputError(f"gz_curve: positive rho and mass expected, {rho!r} and {body.mass!r} found.")
    problem = _Heeled(hull, body, float(rho), free_trim)
    upright = problem.balance(0.0, np.zeros(2))
    q = np.empty((len(phi), 2))
    order = np.argsort(np.abs(phi), kind="stable")
    for side in (order[phi[order] >= 0.0], order[phi[order] < 0.0]):
        start = upright
        for i in side:
            q[i] = start = problem.balance(float(phi[i]), start)
    lever = np.array([problem.lever(float(a), b) for a, b in zip(phi, q, strict=True)])
    ends = [problem.lever(s * _NEAR, problem.balance(s * _NEAR, upright)) for s in (1.0, -1.0)]
    gm = (ends[0] - ends[1]) / (2.0 * _NEAR)
    wet_at = _deck_angle(rim(hull), phi, q)
    return GZCurve(hull.name, phi, lever, q[:, 0], q[:, 1], float(body.mass), gm, wet_at)


class _Heeled:
    """A closed hull and a weight at a given heel."""

    def __init__(self, hull: PanelMesh, body: Weight, rho: float, free_trim: bool) -> None:
        self.name = hull.name
        closed = decked(hull)
        self.triangles = corners(closed)
        self.cog = np.array(body.cog, dtype=float)
        self.mass = float(body.mass) / rho  # m3
        self.size = float(np.ptp(closed.bounds, axis=0).max())
        self.free = np.array([True, free_trim])
        if self.mass >= closed.volume:
            raise ConvergenceError(
                f"gz_curve: {hull.name!r} sinks: {float(body.mass):.6g} kg need {self.mass:.6g} m3, the hull up to its deck "
                f"holds {closed.volume:.6g} m3. Check the mass, or give the hull up to the deck."
            )

    def gradient(self, phi: float, q: Array) -> Array:
        return energy_gradient(self.triangles, self.mass, self.cog, float(q[0]), phi, float(q[1]))

    def lever(self, phi: float, q: Array) -> float:
        return float(self.gradient(phi, q)[1] / self.mass)

    def balance(self, phi: float, q: Array) -> Array:
        """Return (z, theta) in balance at a heel by Newton's method with limited, halved steps, from a start."""
        unit = np.array([1.0, self.size])

        def residual(q: Array) -> Array:
            """In units of weight and weight times size, by z over size and theta."""
            return np.asarray(self.gradient(phi, q)[[0, 2]] / (self.mass * unit))[self.free]

        scale = np.array([self.size, 1.0])[self.free]
        r = residual(q)
        for _ in range(_STEPS):
            error = float(np.abs(r).max())
            if error < _CLOSE:
                return q
            step = np.zeros(2)
            step[self.free] = scale * _newton(residual, q, r, self.free, scale)
            for _ in range(30):
                r_new = residual(q + step)
                if np.abs(r_new).max() < error:
                    break
                step *= 0.5
            else:
                if error < 1e-9:  # rounding
                    return q
                break
            q, r = q + step, r_new
        raise ConvergenceError(
            f"gz_curve: no sinkage and trim in balance found for {self.name!r} at heel {phi / deg:.4g} deg (imbalance "
            f"{np.abs(r).max():.2g} of the weight). Check mass and centre of gravity, or give angles in smaller steps."
        )


def _newton(residual: Any, q: Array, r: Array, free: Array, scale: Array) -> Array:
    """Return a Newton step in scaled variables by central differences, at most a tenth."""
    h, J = 1e-6, np.empty((len(r), len(r)))
    for k, i in enumerate(np.flatnonzero(free)):
        e = np.zeros(2)
        e[i] = h * scale[k]
        J[:, k] = (residual(q + e) - residual(q - e)) / (2.0 * h)
    step = np.linalg.lstsq(J, -r, rcond=None)[0]
    return step * min(1.0, 0.1 / max(float(np.abs(step).max()), 1e-300))


def _deck_angle(edge: Array, phi: Array, q: Array) -> float:
    """Return the first positive heel at which a point of the edge is at the water."""
    kept = np.flatnonzero(phi >= 0.0)
    if len(edge) == 0 or len(kept) == 0:
        return float("nan")
    lowest = np.array([(edge @ rotation_matrix(phi[i], q[i, 1], 0.0)[2]).min() + q[i, 0] for i in kept])
    wet = np.flatnonzero(lowest <= 0.0)
    if len(wet) == 0:
        return float("nan")
    k = int(wet[0])
    if k == 0:
        return float(phi[kept[0]])
    a, b = phi[kept[k - 1]], phi[kept[k]]
    return float(a + (b - a) * lowest[k - 1] / (lowest[k - 1] - lowest[k]))
