"""Thrust allocation: which thruster makes how much of a wanted force, within the limits of size and rate."""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ogilvie.loads.control.thruster import KIND, MAX, MIN, STEP, THRUSTER_DATA, WEIGHT

Array = NDArray[Any]

_SMALL = 1e-8  # of each diagonal term: keeps the solution finite where no free thruster can act; each round mends what it costs
_IDLE = 1e-12  # of what all thrusters together do in a degree of freedom, squared: less than this is none


@njit(cache=True, nogil=True)
def allocate(data: Array, n: int, arm: float, wanted: Array, u: Array, shortfall: Array) -> None:
    """Move the thrusts u (2 n,) of n thrusters towards a wanted force and write what is missing of it.

    Parameters
    ----------
    data : (n * THRUSTER_DATA,) array
    n : int
    arm : float
        Length that makes the yaw moment a force, m.
    wanted : (3,) array
        Surge and sway force (N), yaw moment (N m).
    u : (2 n,) array
        Thrusts of the last period, replaced: a fixed thruster uses the first of its two places, an azimuth one both (forward,
        port).
    shortfall : (3,) array
        wanted - B u, written.

    Notes
    -----
    Weighted pseudo-inverse u = W^-1 B^T (B W^-1 B^T)^-1 tau, repeated on what remains: thrusters that would pass a limit are
    set to it and left out of the next round (redistributed pseudo-inverse). Where no limit is met, B u = tau to rounding. Not
    every force within the limits is found in full; what is not made is the shortfall.

    References
    ----------
    Fossen (2021), thrust allocation by generalised inverse; Virnig, Bodden (1994), Multivariable control allocation and control
    law conditioning when control effectors limit, AIAA 94-3609, for the redistribution.
    """
    new, free = np.zeros(2 * n), np.ones(n)
    G, r, all_free = np.zeros((3, 3)), np.zeros(3), np.zeros(3)
    for attempt in range(n + 3):
        _remaining(data, n, wanted, new, shortfall)
        r[0], r[1], r[2] = shortfall[0], shortfall[1], shortfall[2] / arm
        _gram(data, n, arm, free, G)
        for j in range(3):
            if attempt == 0:
                all_free[j] = G[j, j]
            if G[j, j] <= _IDLE * all_free[j]:
                G[j, :], G[:, j], G[j, j], r[j] = 0.0, 0.0, 1.0, 0.0
        _solve3(G, r)
        for i in range(n):
            if free[i] != 0.0:
                at = i * THRUSTER_DATA
                for c in range(int(data[at + KIND])):
                    b = at + 6 * c
                    new[2 * i + c] += (data[b] * r[0] + data[b + 1] * r[1] + data[b + 5] / arm * r[2]) / data[at + WEIGHT]
                if _limited(data[at : at + THRUSTER_DATA], u[2 * i : 2 * i + 2], new[2 * i : 2 * i + 2]):
                    free[i] = 0.0
    u[: 2 * n] = new
    _remaining(data, n, wanted, u, shortfall)


@njit(cache=True, nogil=True)
def thrust_force(data: Array, n: int, u: Array, force: Array) -> None:
    """Write the force (6,) about O of the thrusts u (2 n,)."""
    force[:] = 0.0
    for i in range(n):
        at = i * THRUSTER_DATA
        for c in range(int(data[at + KIND])):
            for k in range(6):
                force[k] += data[at + 6 * c + k] * u[2 * i + c]


@njit(cache=True, nogil=True)
def _limited(thruster: Array, old: Array, new: Array) -> bool:
    """Bring a thrust within its limits of size, then of change from the old one, and say whether that changed it."""
    changed = False
    if thruster[KIND] == 1.0:
        lowest = max(thruster[MIN], old[0] - thruster[STEP])
        highest = min(thruster[MAX], old[0] + thruster[STEP])
        changed = new[0] < lowest or new[0] > highest
        new[0] = min(max(new[0], lowest), highest)
        return changed
    size = np.hypot(new[0], new[1])
    if size > thruster[MAX]:
        new *= thruster[MAX] / size
        changed = True
    change = np.hypot(new[0] - old[0], new[1] - old[1])
    if change > thruster[STEP]:
        part = thruster[STEP] / change
        new[0], new[1] = old[0] + part * (new[0] - old[0]), old[1] + part * (new[1] - old[1])
        changed = True
    return changed


@njit(cache=True, nogil=True)
def _remaining(data: Array, n: int, wanted: Array, u: Array, out: Array) -> None:
    """Write wanted - B u."""
    out[:] = wanted
    for i in range(n):
        at = i * THRUSTER_DATA
        for c in range(int(data[at + KIND])):
            b, thrust = at + 6 * c, u[2 * i + c]
            out[0] -= data[b] * thrust
            out[1] -= data[b + 1] * thrust
            out[2] -= data[b + 5] * thrust


@njit(cache=True, nogil=True)
def _gram(data: Array, n: int, arm: float, free: Array, G: Array) -> None:
    """Write B W^-1 B^T of the free thrusters, moments divided by the arm."""
    G[:] = 0.0
    b = np.zeros(3)
    for i in range(n):
        at = i * THRUSTER_DATA
        for c in range(int(data[at + KIND])):
            b[0], b[1], b[2] = data[at + 6 * c], data[at + 6 * c + 1], data[at + 6 * c + 5] / arm
            for j in range(3):
                for k in range(3):
                    G[j, k] += free[i] * b[j] * b[k] / data[at + WEIGHT]


@njit(cache=True, nogil=True)
def _solve3(G: Array, r: Array) -> None:
    """Solve G x = r for a symmetric G >= 0, made definite by a small part of its diagonal; x replaces r."""
    for j in range(3):
        G[j, j] *= 1.0 + _SMALL
    for j in range(3):
        for i in range(j + 1, 3):
            f = G[i, j] / G[j, j]
            for k in range(j, 3):
                G[i, k] -= f * G[j, k]
            r[i] -= f * r[j]
    for j in range(2, -1, -1):
        for k in range(j + 1, 3):
            r[j] -= G[j, k] * r[k]
        r[j] /= G[j, j]
