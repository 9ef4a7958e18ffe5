"""Mooring of catenary lines, quasi-static: the lines lie in equilibrium at each instant."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import ConvergenceError, InputError
from ogilvie.frames import euler_rate_matrix, rotation_matrix
from ogilvie.loads.base import MOORING, Surroundings, Terms, matrix6, vector6
from ogilvie.loads.catenary import FAILED, GROUNDED, SLACK, SUSPENDED, anchor_tension, compiled, solve_line
from ogilvie.loads.catenary_shape import line_shape
from ogilvie.loads.kernel import ETA, ROTATION, Kernel, load_kernel
from ogilvie.loads.mooring import LinearMooring
from ogilvie.loads.mooring_line import MooringLine

Array = NDArray[Any]

#: How a line lies, by the number that the solver gives.
KINDS = {SLACK: "slack", GROUNDED: "grounded", SUSPENDED: "suspended"}

_ROW = 11  # numbers of a line, see MooringLine.row


@compiled
def _span(p, place, R):
    """Return where the anchor of a line p (11,) is from its fairlead, dx and dy, and the fairlead's height over it."""
    a, b, c = p[3], p[4], p[5]
    dx = p[0] - place[0] - R[0] * a - R[1] * b - R[2] * c
    dy = p[1] - place[1] - R[3] * a - R[4] * b - R[5] * c
    return dx, dy, place[2] + R[6] * a + R[7] * b + R[8] * c - p[2]


@load_kernel
def _lines_kernel(x, data, own, force):
    for i in range(data.size // _ROW):
        p = data[i * _ROW : (i + 1) * _ROW]
        R = x[ROTATION : ROTATION + 9]
        a, b, c = p[3], p[4], p[5]
        dx, dy, h = _span(p, x[ETA : ETA + 3], R)
        l = np.hypot(dx, dy)
        H, V, _ = solve_line(l, h, p[6], p[7], p[8], p[9], p[10])
        pull = H / l if l > 0.0 else 0.0 * H
        X, Y = pull * dx, pull * dy
        fx = R[0] * X + R[3] * Y - R[6] * V
        fy = R[1] * X + R[4] * Y - R[7] * V
        fz = R[2] * X + R[5] * Y - R[8] * V
        force[0] += fx
        force[1] += fy
        force[2] += fz
        force[3] += b * fz - c * fy
        force[4] += c * fx - a * fz
        force[5] += a * fy - b * fx


@compiled
def _all_tensions(poses, rotations, rows, out):
    for k in range(poses.shape[0]):
        for i in range(rows.shape[0]):
            p = rows[i]
            dx, dy, h = _span(p, poses[k], rotations[k])
            H, V, kind = solve_line(np.hypot(dx, dy), h, p[6], p[7], p[8], p[9], p[10])
            out[k, i, 0] = np.hypot(H, V) if kind != FAILED else np.nan
            out[k, i, 1] = anchor_tension(H, V, p[6], p[7], p[9], kind) if kind != FAILED else np.nan


@dataclass(frozen=True, eq=False, init=False)
class CatenaryMooring:
    """Force of elastic catenary lines, solved at each call from the pose: no inertia and no drag of the lines.

    Parameters
    ----------
    lines : sequence of MooringLine

    Raises
    ------
    InputError
        No line, or something that is no line.

    Notes
    -----
    Where a line has no solution (its fairlead below the bottom, a pose that is not finite) the kernel's force is NaN, so that a
    run stops; the methods here raise :class:`ConvergenceError` and name the line.

    References
    ----------
    docs/theory/mooring.md; J. M. Jonkman, NREL/TP-500-41958, 2007, chapter 2.

    Examples
    --------
    >>> spread = [(np.cos(a), np.sin(a)) for a in np.radians([60, 180, 300])]
    >>> chain = dict(length=835.35, weight=108.63 * 9.81, stiffness=753.6e6)
    >>> lines = [MooringLine([837.6 * c, 837.6 * s, -200], [40.868 * c, 40.868 * s, -14], **chain) for c, s in spread]
    >>> mooring = CatenaryMooring(lines)
    >>> (mooring.force() / 1e3).round().astype(int).tolist()
    [0, 0, -1894, 0, 0, 0]
    """

    lines: tuple[MooringLine, ...]
    name: str = "mooring"

    def __init__(self, lines: Sequence[MooringLine]) -> None:
        found = tuple(lines) if not isinstance(lines, MooringLine) else (lines,)
        if not found or not all(isinstance(line, MooringLine) for line in found):
            raise InputError("CatenaryMooring: one or more MooringLine expected.")
        object.__setattr__(self, "lines", found)
        object.__setattr__(self, "name", "mooring")

    @property
    def covers(self) -> frozenset[str]:
        """Effects that this load accounts for."""
        return frozenset({MOORING})

    def bind(self, surroundings: Surroundings) -> Terms:
        """Return the compiled force for the time loop."""
        return Terms(kernel=self.kernel)

    @property
    def kernel(self) -> Kernel:
        """The compiled force with the numbers of all lines."""
        return Kernel(_lines_kernel, np.concatenate([line.row for line in self.lines]))

    def force(self, eta: ArrayLike | None = None) -> Array:
        """Return the force (6,) on the body about O in body axes, N and N m, at the pose eta (6,), zero by default."""
        pose = _pose(eta)
        force = self.kernel.force(eta=pose)
        if not np.all(np.isfinite(force)):
            self._solved(pose)
        return force

    def tensions(self, eta: ArrayLike | None = None) -> Array:
        """Return the tensions (lines, 2) at fairlead and anchor, N, or those (..., lines, 2) of many poses (..., 6): `run.eta`.

        Among many poses those that a line has no solution for are NaN.
        """
        if eta is not None and np.ndim(eta) > 1:
            poses = np.ascontiguousarray(eta, dtype=float)
            if poses.shape[-1] != 6:
                raise InputError(f"CatenaryMooring: tensions: poses (..., 6) expected, shape {poses.shape} found.")
            one_by_one = poses.reshape(-1, 6)
            rotations = np.array([rotation_matrix(*pose[3:]).ravel() for pose in one_by_one]).reshape(-1, 9)
            out = np.empty((len(one_by_one), len(self.lines), 2))
            _all_tensions(one_by_one, rotations, np.stack([line.row for line in self.lines]), out)
            return out.reshape(*poses.shape[:-1], len(self.lines), 2)
        solved = self._solved(_pose(eta))
        anchors = [
            anchor_tension(H, V, p.length, p.weight, p.friction, k) for p, (H, V, k) in zip(self.lines, solved, strict=True)
        ]
        return np.stack([np.hypot(*np.array([s[:2] for s in solved]).T), anchors], axis=1)

    def kinds(self, eta: ArrayLike | None = None) -> tuple[str, ...]:
        """Return how each line lies: "slack" (all weight on the bottom), "grounded" (in part) or "suspended"."""
        return tuple(KINDS[kind] for _, _, kind in self._solved(_pose(eta)))

    def generalised_force(self, eta: ArrayLike | None = None) -> Array:
        """Return the work per unit of each coordinate (6,): forces along the world turned by the heading of eta, then moments.

        Notes
        -----
        Power = F . v + M . omega with omega = T^-1 (phi', theta', psi'), so the moments about O in body axes count as T^-T M.
        Minus the gradient of the potential energy where the lines have no friction.
        """
        return self._generalised(_pose(eta), _pose(eta)[5])

    def stiffness(self, eta: ArrayLike | None = None, *, step: float = 1e-3) -> Array:
        """Return the stiffness (6, 6) about the pose: minus the derivative of :meth:`generalised_force`, N/m, N, N m.

        Displacements are along the world turned by the heading of eta. Symmetric where the lines have no friction.

        Parameters
        ----------
        eta : (6,) array, optional
        step : float
            Of the central differences, m; angles take a step that moves the farthest fairlead as much.
        """
        pose = _pose(eta)
        arm = max(1.0, max(float(np.linalg.norm(line.fairlead)) for line in self.lines))
        turn = rotation_matrix(0.0, 0.0, pose[5])
        K = np.empty((6, 6))
        for j in range(6):
            d = np.zeros(6)
            d[j] = step if j < 3 else step / arm
            d[:3] = turn @ d[:3]
            change = self._generalised(pose + d, pose[5]) - self._generalised(pose - d, pose[5])
            K[:, j] = -change / (2.0 * (step if j < 3 else step / arm))
        return K

    def linearised(self, eta: ArrayLike | None = None) -> LinearMooring:
        """Return the mooring that is linear in small motions about the pose eta, for the small-motion time loop.

        The motions of the linear model are then measured from eta, along axes turned by its heading.
        """
        return LinearMooring(self.stiffness(eta), pretension=self.generalised_force(eta))

    def equilibrium(self, restoring: ArrayLike, *, load: ArrayLike | None = None, start: ArrayLike | None = None) -> Array:
        """Return the pose (6,) where mooring, linear restoring -C eta and a constant load are in balance.

        Parameters
        ----------
        restoring : (6, 6) array
            Hydrostatic stiffness about O; surge, sway and yaw must not be among its entries.
        load : (6,) array, optional
            Force on the body along the coordinates (world axes; moments about O), e.g. mean wind and drift plus, where the
            weight of the mooring is part of the ship's trim, its pretension with opposite sign.
        start : (6,) array, optional
            Pose to start from.

        Raises
        ------
        ConvergenceError
            No balance found.
        """
        from scipy.optimize import root

        C = matrix6(restoring, "equilibrium: restoring")
        if C[:, [0, 1, 5]].any():
            raise InputError(
                "equilibrium: restoring of heave, roll and pitch alone expected, entries in surge, sway or yaw found."
            )
        given = vector6(np.zeros(6) if load is None else load, "equilibrium: load")
        scale = np.maximum(np.abs(np.diag(C)) + np.abs(np.diag(self.stiffness(start))), 1.0)
        out = root(lambda e: (self._generalised(e, 0.0) + given - C @ e) / scale, _pose(start), tol=1e-12)
        if np.abs(out.fun).max() > 1e-8:
            raise ConvergenceError(
                f"equilibrium: balance expected, {np.abs(out.fun).max():.3g} m or rad short of it: {out.message}"
            )
        return np.asarray(out.x)

    def shapes(self, eta: ArrayLike | None = None, *, points: int = 101) -> list[Array]:
        """Return the world coordinates (points, 3) of each line from anchor to fairlead, m."""
        pose, shapes = _pose(eta), []
        for line, (H, V, kind) in zip(self.lines, self._solved(pose), strict=True):
            span = self._fairlead(line, pose) - line.anchor
            l = float(np.hypot(span[0], span[1]))
            ahead = span[:2] / l if l > 0.0 else np.zeros(2)
            x, z = line_shape(line, H, V, kind, l, points)
            shapes.append(line.anchor + np.column_stack([x * ahead[0], x * ahead[1], z]))
        return shapes

    def _generalised(self, pose: Array, heading: float) -> Array:
        force = self.force(pose)
        R = rotation_matrix(*pose[3:])
        F = rotation_matrix(0.0, 0.0, heading).T @ R @ force[:3]
        return np.concatenate([F, np.linalg.solve(euler_rate_matrix(pose[3], pose[4]).T, force[3:])])

    @staticmethod
    def _fairlead(line: MooringLine, pose: Array) -> Array:
        return np.asarray(pose[:3] + rotation_matrix(*pose[3:]) @ line.fairlead)

    def _solved(self, pose: Array) -> list[tuple[float, float, int]]:
        found = []
        for i, line in enumerate(self.lines):
            d = self._fairlead(line, pose) - line.anchor
            l = float(np.hypot(d[0], d[1]))
            H, V, kind = solve_line(l, d[2], line.length, line.weight, line.stiffness, line.friction, float(line.grounded))
            if kind == FAILED:
                raise ConvergenceError(
                    f"CatenaryMooring: line {i} (from 0) has no solution with its fairlead {l:.4g} m from the anchor and "
                    f"{d[2]:.4g} m above it. A grounded line needs its fairlead above the bottom."
                )
            found.append((H, V, kind))
        return found


def _pose(eta: ArrayLike | None) -> Array:
    return vector6(np.zeros(6) if eta is None else eta, "CatenaryMooring: pose eta")
