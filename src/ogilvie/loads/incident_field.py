"""Elevation and dynamic pressure of a sea at scattered points near the water: tables, made once, of a compiled evaluation.

Each component is a phase at O (one sine and cosine), a factor of the horizontal place and a factor of the height. Components of
one direction depend on one horizontal coordinate: they are summed on a line of equal steps, where the phase turns by a constant
from point to point, for every height of a table, and interpolated to the points. Where there are many directions, components
that share theirs with few others are evaluated at every point, in single precision (1e-6 of the elevation). Heights are always
interpolated, so no exponential is taken in the time loop.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.waves.field import Sea

Array = NDArray[Any]

HEAD, GROUP = 8, 5  #: numbers of the header; of a group of components
STRETCHING = {"wheeler": 0.0, "vertical": 1.0, "extrapolated": 2.0}

_CUBIC = 3.0 / 128.0  # largest error of cubic interpolation over the fourth derivative times the step^4
_FEW, _WORTH = 4, 32  # directions that all get a line; components of one direction from which on a line pays
_FINEST, _MOST = 0.02, 400  # rad of the shortest wave per step; heights of the table


@dataclass(frozen=True, eq=False)
class IncidentField:
    """Numbers of a sea for :func:`ogilvie.loads.incident_kernel.incident`.

    Parameters
    ----------
    data : (n,) array
        Header, groups, components, table of heights; see :meth:`of`.
    own : (r, 2 n_c) array
        Amplitudes (m) and phases (rad) of each realisation.
    reach : float
        Largest depth below the surface, m, at which the field is known.
    """

    data: Array
    own: Array
    reach: float

    @classmethod
    def of(
        cls, sea: Sea, *, reach: float, accuracy: float, stretching: str = "wheeler", ramp: float = 0.0, lines: bool = True
    ) -> "IncidentField":
        """Return the tables of a sea.

        Parameters
        ----------
        sea : Sea
        reach : float
            Depth down to which points lie, m; cut at the bottom.
        accuracy : float
            Standard deviation of the error of interpolation over that of the elevation.
        stretching : {"wheeler", "vertical", "extrapolated"}
        ramp : float
            s; amplitudes grow from nothing with sin^2.
        lines : bool
            False evaluates every component at every point.

        Notes
        -----
        Header: components, groups, first component without a group, rows of the table of heights, their scale c, depth (0:
        infinite), ramp, kind of stretching. A group: first component, count, cos and sin of the direction, step of the line.
        Components, six rows: omega, k_x, k_y, k, cos and sin of k times the step. The table (rows, components): the factor
        cosh k(z + h)/cosh kh at z = -c i^2, then its slope k tanh kh at z = 0. Fourth powers of the steps give the error.
        """
        depth = sea.depth
        deep = min(reach, 1.02 * depth)
        weight = _shares(sea)
        order, groups = _grouped(sea, weight, accuracy, lines)
        k, omega = sea.wavenumber[order], sea.omega[order]
        kx, ky = k * np.cos(sea.direction[order]), k * np.sin(sea.direction[order])
        rows, c = _heights(k, weight[order], deep, accuracy)
        z = -c * np.arange(rows)[:, None] ** 2
        factor = (np.exp(k * z) + np.exp(-k * (z + 2.0 * depth))) / (1.0 + np.exp(-2.0 * k * depth))
        slope = k * np.tanh(k * depth)
        turn = np.zeros(len(k))
        for begin, count, _, _, step in groups:
            turn[int(begin) : int(begin + count)] = k[int(begin) : int(begin + count)] * step
        single = sum(int(g[1]) for g in groups)
        finite = depth if np.isfinite(depth) else 0.0
        head = [len(k), len(groups), single, rows, c, finite, ramp, STRETCHING[stretching]]
        described = np.array(groups, dtype=float).ravel()
        parts: list[Array] = [np.array(head), described, omega, kx, ky, k, np.cos(turn), np.sin(turn), factor.ravel(), slope]
        amplitude, phase = np.atleast_2d(sea.amplitude)[:, order], np.atleast_2d(sea.phase)[:, order]
        shape = np.broadcast_shapes(amplitude.shape, phase.shape)
        own = np.concatenate([np.broadcast_to(amplitude, shape), np.broadcast_to(phase, shape)], axis=1)
        return cls(np.concatenate(parts), own, c * (rows - 3.0) ** 2)


def _shares(sea: Sea) -> Array:
    """Return the share (n,) of each component in the variance of all realisations."""
    variance = np.atleast_2d(sea.amplitude**2).mean(axis=0)
    total = variance.sum()
    return variance / total if total > 0.0 else np.full(len(variance), 1.0 / len(variance))


def _grouped(sea: Sea, weight: Array, accuracy: float, lines: bool) -> tuple[NDArray[np.intp], list[list[float]]]:
    """Return the order of the components, those on lines first, and the groups."""
    directions, which = np.unique(sea.direction.round(12), return_inverse=True)
    members = [np.flatnonzero(which == g) for g in range(len(directions))]
    least = (1 if len(directions) <= _FEW else _WORTH) if lines else len(which) + 1
    order: list[NDArray[np.intp]] = []
    groups: list[list[float]] = []
    for direction, m in zip(directions, members, strict=True):
        if len(m) >= least:
            step = _step(sea.wavenumber[m], weight[m], accuracy)
            groups.append([sum(len(o) for o in order), len(m), np.cos(direction), np.sin(direction), step])
            order.append(m)
    order += [m for m in members if len(m) < least]
    return np.concatenate(order), groups


def _step(k: Array, weight: Array, accuracy: float) -> float:
    """Return the longest step of a line, m, at which cubic interpolation has the wanted accuracy."""
    share = weight / max(float(weight.sum()), 1e-300)
    kd = np.pi / 2.0
    step = kd / float(k.min())
    while np.sqrt(np.sum(share * np.minimum(_CUBIC * (k * step) ** 4, 1.0) ** 2)) > accuracy and step > _FINEST / k.max():
        step *= 0.9
    return step


def _heights(k: Array, weight: Array, reach: float, accuracy: float) -> tuple[int, float]:
    """Return the number of rows of the table of heights and their scale c.

    Notes
    -----
    exp(k z) at z = -c u^2 is a Gauss curve of u with fourth derivatives up to 12 (k c)^2.
    """
    for m in range(6, _MOST):
        c = reach / m**2
        if np.sqrt(np.sum(weight * np.minimum(12.0 * _CUBIC * (k * c) ** 2, 1.0) ** 2)) <= accuracy:
            return m + 3, c
    raise InputError(
        f"NonlinearFroudeKrylov: an accuracy that {_MOST} heights of {reach:.4g} m give expected, {accuracy:g} found for waves "
        f"down to {2 * np.pi / k.max():.3g} m in length. Give a larger `accuracy`."
    )
