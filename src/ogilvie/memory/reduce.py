"""Balanced truncation of a fluid-memory model, with its Hankel singular values and error bound."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ogilvie.errors import InputError
from ogilvie.memory.passivity import is_passive, smallest_damping
from ogilvie.memory.statespace import StateSpace, modal_form

Array = NDArray[Any]

_NOTHING = 1e-11  # of the largest singular value: states below it are rounding


@dataclass(frozen=True, eq=False)
class Balanced:
    """A stable model whose states are ordered by how much they are driven and seen.

    Attributes
    ----------
    A, B, C : (n, n), (n, m), (m, n) array
    singular_values : (n,) array
        Hankel singular values, descending. A model of order k misses K_hat by 2 sum singular_values[k:] at most, whatever the
        frequency, in the 2-norm.
    """

    A: Array
    B: Array
    C: Array
    singular_values: Array

    def truncated(self, order: int) -> tuple[Array, Array, Array]:
        """Return (A, B, C) of the first states."""
        return self.A[:order, :order], self.B[:order], self.C[:, :order]


def balance(A: Array, B: Array, C: Array) -> Balanced:
    """Return the stable model in balanced form, without the states that cannot be driven or seen.

    Notes
    -----
    Square-root method: A P + P A^T + B B^T = 0, A^T Q + Q A + C^T C = 0, P = L L^T, Q = M M^T, M^T L = U S V^T; then
    T = L V S^-1/2, T^-1 = S^-1/2 U^T M^T.

    References
    ----------
    Moore (1981); Enns (1984) and Glover (1984) for the bound; Tombs and Postlethwaite (1987) for the square roots.
    """
    L = _root(scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T))
    M = _root(scipy.linalg.solve_continuous_lyapunov(A.T, -C.T @ C))
    U, s, Vt = scipy.linalg.svd(M.T @ L, full_matrices=False)
    keep = s > _NOTHING * s[0]
    root = np.sqrt(s[keep])
    T, inverse = L @ Vt[keep].T / root, (M @ U[:, keep] / root).T
    return Balanced(inverse @ A @ T, inverse @ B, C @ T, s[keep])


def _root(P: Array) -> Array:
    """L with L L^T = P; the eigenvalues of P that rounding made negative count as zero."""
    lam, V = scipy.linalg.eigh((P + P.T) / 2)
    return V * np.sqrt(np.maximum(lam, 0.0))


def hankel_singular_values(ssm: StateSpace) -> Array:
    """Return the Hankel singular values (n,) of a model, descending, each dof scaled by its largest |K_hat_ii|.

    Examples
    --------
    >>> two = StateSpace(np.diag([-1.0, -1.1]), np.ones((2, 1)), np.ones((1, 2)), ("heave",))
    >>> hankel_singular_values(two)  # nearly one state, and K_hat(0) = 1 in this scale
    array([0.5..., 0.000...])
    """
    return balance(*_scaled(ssm)[:3]).singular_values


def reduce(ssm: StateSpace, *, order: int | None = None, tol: float | None = None) -> StateSpace:
    """Return a model with fewer states by balanced truncation.

    Parameters
    ----------
    ssm : StateSpace
        Stable.
    order : int, optional
        Number of states to keep.
    tol : float, optional
        Instead of `order`: largest error of K_hat at any frequency, each dof scaled by its largest |K_hat_ii|; 0.01 is one per
        cent. The fewest states whose error bound keeps it.

    Returns
    -------
    StateSpace
        In real modal form, stable, with its passivity; the error bound is in the notes. R2 is not known without the data.

    Raises
    ------
    InputError
        An unstable model; not exactly one of `order` and `tol`; an order above that of the model.

    Notes
    -----
    |K_hat - K_hat_k| <= 2 sum of the Hankel singular values left out. Truncation keeps neither passivity nor K_hat(0) = 0: for
    a passive model of lower order identify again with that `order`.

    Examples
    --------
    >>> two = StateSpace(np.diag([-1.0, -1.1]), np.ones((2, 1)), np.ones((1, 2)), ("heave",))
    >>> one = reduce(two, tol=0.01)
    >>> one.order, bool(abs(one.transfer(0.0) - two.transfer(0.0)).max() < 0.01 * two.transfer(0.0).real)
    (1, True)
    """
    if (order is None) == (tol is None):
        raise InputError("reduce: one of order and tol expected.")
    if ssm.order == 0 or not ssm.is_stable:
        raise InputError("reduce: a stable model with states expected; balanced truncation needs finite energies.")
    if order is not None and not 1 <= order <= ssm.order:
        raise InputError(f"reduce: order between 1 and {ssm.order} expected, {order} found.")
    if tol is not None and not tol > 0.0:
        raise InputError(f"reduce: a positive tol expected, {tol} found.")
    A, B, C, scale = _scaled(ssm)
    balanced = balance(A, B, C)
    s = balanced.singular_values
    bounds = np.append(2 * np.cumsum(s[::-1])[::-1], 0.0)  # of the orders 0, 1, ...
    k = min(order, len(s)) if order else max(1, int(np.flatnonzero(bounds <= (tol or 0.0))[0]))
    A, B, C = modal_form(*balanced.truncated(k))
    note = f"balanced truncation from {ssm.order} to {k} states: K_hat changes by {bounds[k]:.2g} of its largest value at most."
    grid = np.concatenate([[0.0], np.geomspace(0.01, 100.0, 4000) * np.median(np.abs(ssm.poles))])
    reduced = StateSpace(A, B * scale, C * scale[:, None], ssm.dofs)
    return StateSpace(
        reduced.A,
        reduced.B,
        reduced.C,
        ssm.dofs,
        passivity_margin=smallest_damping(reduced.transfer(grid)),
        is_passive=is_passive(reduced.A, reduced.B, reduced.C),
        A_inf=ssm.A_inf,
        method=f"{ssm.method}, balanced truncation",
        notes=(*ssm.notes, note),
    )


def _scaled(ssm: StateSpace) -> tuple[Array, Array, Array, Array]:
    """(A, B, C) with each dof divided by its scale, and the scale (m,), the square root of the largest |K_hat_ii|."""
    poles = ssm.poles
    omega = np.unique(np.concatenate([[0.0], np.abs(poles), np.abs(poles.imag)]))
    size = np.abs(np.einsum("wii->wi", ssm.transfer(omega))).max(axis=0)
    scale = np.sqrt(np.where(size > 0.0, size, 1.0))
    return ssm.A, ssm.B / scale, ssm.C / scale[:, None], scale
