"""From retardation functions to a state-space model: the methods, the blocks, what is reported."""

import warnings
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.memory.blocks import coupled_blocks, r_squared
from ogilvie.memory.passive import check_square, identify_passive, radiation_data
from ogilvie.memory.passivity import is_passive, smallest_damping
from ogilvie.memory.realization import identify_by_realization
from ogilvie.memory.retardation import Retardation
from ogilvie.memory.statespace import StateSpace, modal_form, stack_blocks

Array = NDArray[Any]

METHODS = ("oscillators", "realization")


def identify(
    K: Retardation,
    *,
    method: str = "oscillators",
    r2: float = 0.99,
    order: int | None = None,
    max_order: int = 60,
    mass: ArrayLike | None = None,
    stiffness: ArrayLike | None = None,
) -> StateSpace:
    """Return a stable state-space model of the fluid memory; with the default method it is passive for any data.

    The couplings are sorted into blocks that do not interact (surge-heave-pitch and sway-roll-yaw for a symmetric hull);
    each block shares one set of poles. Blocks grow until every coupling reaches `r2`.

    Parameters
    ----------
    K : Retardation
    method : {"oscillators", "realization"}
        ``oscillators``: oscillators that share dampers, fitted to added mass and damping; symmetric, passive and zero at zero
        frequency whatever the data. ``realization``: singular values of the Hankel matrix of K, bilinear map, outputs refitted
        (paper A); stable, not passive.
    r2 : float
        Coefficient of determination to be reached, 0 < r2 < 1: of A(omega) and B(omega) of each coupling for ``oscillators``,
        of K(t) for ``realization``.
    order : int, optional
        Number of states of every block, instead of `r2`.
    max_order : int
        Largest number of states of the model.
    mass, stiffness : (m, m) array, optional
        Rigid-body inertia and restoring about O. With them the fit of ``oscillators`` is aware of the motion: it weighs what
        the fit changes in the motion of the free-floating body under unit forces, and grows until that change is small.

    Returns
    -------
    StateSpace
        In real modal form.

    Raises
    ------
    InputError
        Unknown method, r2 outside (0, 1), order < 1, K that is zero, matrices of the wrong shape.

    Warns
    -----
    OgilvieWarning
        `r2` is not reached; the couplings and what they reach are named.

    Notes
    -----
    R2 = 1 - sum (x - x_fit)^2 / sum (x - mean x)^2.

    References
    ----------
    Paper A (Yuan 2017), sections III and IV; docs/theory/memory.md for the oscillators.

    Examples
    --------
    >>> import ogilvie as og
    >>> w = np.linspace(0.05, 4.0, 80)
    >>> K_hat = 1j * w / ((1j * w + 0.4) ** 2 + 1)
    >>> A, B = 2 + K_hat.imag / w, K_hat.real
    >>> h = og.hydro_from_arrays(omega=w, added_mass=A[:, None, None], radiation_damping=B[:, None, None], dofs=("heave",))
    >>> ssm = og.identify(og.retardation(h))
    >>> ssm.order, ssm.is_stable, ssm.is_passive, bool(ssm.r2_damping[0, 0] > 0.999)
    (2, True, True, True)
    """
    _check_arguments(method, r2, order, max_order)
    blocks = coupled_blocks(K.K)
    if not blocks:
        raise InputError("identify: K is zero; there is no fluid memory to model.")
    m = len(K.dofs)
    A_inf, notes = K.A_inf, [n for n in K.notes if n.startswith("damping not positive")]
    if method == "realization":
        models, found = identify_by_realization(K, blocks, r2=r2, order=order, max_order=max_order)
    else:
        M = None if mass is None else check_square("mass", mass, m)
        C = None if stiffness is None else check_square("stiffness", stiffness, m)
        models, A_inf, found = identify_passive(K, blocks, r2=r2, order=order, max_order=max_order, mass=M, stiffness=C)
    for note in found:
        warnings.warn(f"identify: {note}", OgilvieWarning, stacklevel=2)
    parts = [(dofs, *modal_form(a, b, c)) for dofs, a, b, c in models]
    A, B, C_out = stack_blocks(parts, m)
    return _reported(StateSpace(A, B, C_out, K.dofs, A_inf=A_inf, method=method, notes=tuple(notes + found)), K)


def _reported(model: StateSpace, K: Retardation) -> StateSpace:
    """Return the model with its figures of merit."""
    omega, A, B = radiation_data(K)
    K_hat = model.transfer(omega)
    assert model.A_inf is not None
    fitted_A = model.A_inf + K_hat.imag / omega[:, None, None]
    grid = np.concatenate([[0.0], np.geomspace(0.01 * omega[0], 100 * omega[-1], 4000)])
    return StateSpace(
        model.A,
        model.B,
        model.C,
        model.dofs,
        r2=r_squared(K.K, model.impulse(K.t)),
        r2_added_mass=r_squared(A, fitted_A, size=B),
        r2_damping=r_squared(B, K_hat.real),
        passivity_margin=smallest_damping(model.transfer(grid)),
        is_passive=is_passive(model.A, model.B, model.C),
        A_inf=model.A_inf,
        method=model.method,
        notes=model.notes,
    )


def _check_arguments(method: str, r2: float, order: int | None, max_order: int) -> None:
    if method not in METHODS:
        raise InputError(f"method: one of {METHODS} expected, {method!r} found.")
    if not 0.0 < r2 < 1.0:
        raise InputError(f"r2: a number between 0 and 1 (0.99, say) expected, {r2!r} found.")
    if order is not None and order < 1:
        raise InputError(f"order: a positive number of states expected, {order!r} found.")
    if max_order < 1:
        raise InputError(f"max_order: a positive number of states expected, {max_order!r} found.")
