"""Matrices of the plain hybrid method for one combination of parities (arrays only).

Letters as in Guo et al.; panels in the order control surface C, free surface F, hull H, densities even or odd in x and y.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.flat_panels_influence import density_signs, rankine_by_parity
from ogilvie.bem.plain_boundary import FlatBoundary
from ogilvie.bem.transient_green_kernel import fill_history
from ogilvie.bem.transient_green_table import chebyshev_table
from ogilvie.errors import InputError

Array = NDArray[Any]

#: Largest error of the solid angle that the boundary subtends at one of its panels, part of 2 pi.
CLOSED = 0.03


@dataclass(frozen=True, eq=False)
class Response:
    """What a prescribed potential on the free surface, the outer history and a moving hull cause at one instant.

    Parameters
    ----------
    Z, Y : (n_c, n_c) array
        phi_C = Z phi_n,C - Y r_C on the control surface, from the outer fluid: Z = C^-1 D, Y = C^-1, Eq. (23).
    X : (n_c + n_f + n_h, n_c + n_f) array
        (phi_n,C, phi_n,F, phi_H) caused by (r_C, phi_F): H^-1 G_2 of Eq. (25), the sign of the second part turned.
    V : (n_c + n_f + n_h, n_h) array
        The same caused by phi_n on the hull: H^-1 G_1 of Eq. (16).
    """

    Z: Array
    Y: Array
    X: Array
    V: Array

    @property
    def storage(self) -> int:
        """Bytes."""
        return self.Z.nbytes + self.Y.nbytes + self.X.nbytes + self.V.nbytes


def responses(boundary: FlatBoundary, parities: Array, *, accuracy: float = 1e-6) -> list[Response]:
    """Return the response for each parity (n, 2).

    Raises
    ------
    InputError
        The panels do not enclose the fluid.

    Notes
    -----
    Inside, 2 pi phi + int phi d/dn (1/r) = int phi_n / r, Eq. (7): A phi = B phi_n. Outside,
    -2 pi phi + int_C phi d/dn (1/r - 1/r') = int_C phi_n (1/r - 1/r') - r_C, Eq. (8): C phi = D phi_n - r_C.
    """
    n_c = boundary.counts[0]
    points, panels, control = boundary.panels.centers, boundary.panels, boundary.control
    inner = rankine_by_parity(points, panels, np.concatenate([[[1, 1]], parities]), accuracy=accuracy)
    _check_closed(boundary, inner.pop(0).double.sum(axis=1) / (2.0 * np.pi) + 1.0)
    image = rankine_by_parity(control.centers, control, parities, accuracy=accuracy, mirror=(1, 1, -1))
    found = []
    for (B, A), (d, c) in zip(inner, image, strict=True):
        C = A[:n_c, :n_c] - c - 2.0 * np.pi * np.eye(n_c)
        Y = np.linalg.inv(C)
        Z = Y @ (B[:n_c, :n_c] - d)
        A[np.diag_indices(len(A))] += 2.0 * np.pi
        found.append(_solved(A, B, Z, Y, boundary.counts))
    return found


def _solved(A: Array, B: Array, Z: Array, Y: Array, counts: tuple[int, int, int]) -> Response:
    """Return the solution of Eqs. (15) and (24) for unit right sides."""
    n_c, n_f, _ = counts
    C, F, H = slice(0, n_c), slice(n_c, n_c + n_f), slice(n_c + n_f, None)
    left = np.concatenate([A[:, C] @ Z - B[:, C], -B[:, F], A[:, H]], axis=1)
    solution = np.linalg.solve(left, np.concatenate([A[:, C] @ Y, -A[:, F], B[:, H]], axis=1))
    return Response(
        Z=Z, Y=Y, X=np.ascontiguousarray(solution[:, : n_c + n_f]), V=np.ascontiguousarray(solution[:, n_c + n_f :])
    )


def _check_closed(boundary: FlatBoundary, error: Array) -> None:
    worst = int(np.abs(error).argmax())
    if abs(error[worst]) > CLOSED:
        n_c, n_f, _ = boundary.counts
        name = "control surface" if worst < n_c else "free surface" if worst < n_c + n_f else "hull"
        at = ", ".join(f"{x:.4g}" for x in boundary.panels.centers[worst])
        raise InputError(
            f"FlatBoundary: panels that enclose the fluid, normals outwards, expected; at ({at}) of the {name} the solid angle "
            f"is {abs(error[worst]):.1%} off. Look for gaps, overlaps and panels that are turned over."
        )


def histories(boundary: FlatBoundary, parities: Array, *, g: float, step: float, steps: int, points: int = 3) -> list[Array]:
    """Return the kernels (n_c, steps, 2 n_c) of r_C for each parity: at lag (l + 1) step what (phi, phi_n) = 1 adds.

    Notes
    -----
    r_C = int dtau int_C [phi d/dn_q G_f(t - tau) - phi_n G_f(t - tau)] dS, Eqs. (20), (21), with points^2 Gauss points on each
    panel; 1: its centroid.
    """
    control = boundary.control
    n, n_p = len(control), len(parities)
    signs = density_signs(control.images, parities)
    total = [np.zeros((n, steps, 2 * n)) for _ in range(n_p)]
    part = np.zeros((n, steps, 2 * n)) if n_p > 1 else total[0]  # of one image; with one parity they add up at once
    for image, sign in zip(control.images, signs.T, strict=True):
        field = np.ascontiguousarray(control.centers * [*image, 1.0])
        if n_p > 1:
            part[:] = 0.0
        for x, weight in zip(*control.gauss_points(points), strict=True):
            w = weight if n_p > 1 else sign[0] * weight
            fill_history(field, x, control.normals, w, g, step, 1, chebyshev_table(), part[..., n:], part[..., :n])
        if n_p > 1:
            for s, W in zip(sign, total, strict=True):
                W += s * part
    for W in total:
        W[..., n:] *= -1.0
    return total


def leapfrog_limit(response: Response, counts: tuple[int, int, int], *, g: float) -> float:
    """Return the largest stable time step 2/(g lambda)^(1/2), lambda the largest eigenvalue of phi_F -> phi_n,F, s.

    Notes
    -----
    Of the instantaneous coupling; the memory of the outer fluid does not enter.
    """
    n_c, n_f, _ = counts
    T = response.X[n_c : n_c + n_f, n_c:]
    if n_f < 400:
        largest = np.linalg.eigvals(T).real.max()
    else:
        from scipy.sparse.linalg import eigs

        largest = eigs(T, k=1, which="LM", v0=np.ones(n_f), tol=1e-6, return_eigenvectors=False)[0].real
    return float(2.0 / np.sqrt(g * largest))
