"""From retardation functions to a state-space model: the methods, the blocks, what is reported."""

import warnings
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.threads import algebra_threads
from ogilvie.memory.blocks import coupled_blocks, r_squared
from ogilvie.memory.common_poles import condense
from ogilvie.memory.frequency import identify_by_frequency
from ogilvie.memory.motion import motion_change
from ogilvie.memory.passive import check_square, identify_passive
from ogilvie.memory.passive_start import identify_passive_from
from ogilvie.memory.passive_target import check_spectrum, radiation_data
from ogilvie.memory.passivity import is_passive, smallest_damping
from ogilvie.memory.prony import identify_by_prony
from ogilvie.memory.raise_order import shortfall
from ogilvie.memory.realization import identify_by_realization
from ogilvie.memory.retardation import Retardation
from ogilvie.memory.statespace import StateSpace, modal_form, stack_blocks
from ogilvie.memory.targets import FitTarget, Impulse, Spectrum, Trial
from ogilvie.memory.vector_fitting import identify_by_vector_fitting

Array = NDArray[Any]
Blocks = list[tuple[list[int], Array, Array, Array]]

_FITS_TO: dict[str, tuple[Any, Callable[..., tuple[Trial, Array]]]] = {
    "realization": (Impulse, identify_by_realization),
    "impulse": (Impulse, identify_by_prony),
    "frequency": (Spectrum, identify_by_frequency),
    "vector": (Spectrum, identify_by_vector_fitting),
}
_ROUNDING = 1e-9  # of the largest K of a translation or a rotation
METHODS = ("oscillators", *_FITS_TO)


def identify(
    K: Retardation,
    *,
    method: str = "oscillators",
    r2: float = 0.99,
    order: int | None = None,
    max_order: int = 60,
    passive: bool = True,
    mass: ArrayLike | None = None,
    stiffness: ArrayLike | None = None,
) -> StateSpace:
    """Return a stable state-space model of the fluid memory; unless told otherwise it is passive for any data.

    The couplings are sorted into blocks that do not interact (surge-heave-pitch and sway-roll-yaw for a symmetric hull);
    each block shares one set of poles. Blocks grow until every coupling reaches `r2`.

    Parameters
    ----------
    K : Retardation
    method : {"oscillators", "realization", "impulse", "frequency", "vector"}
        ``oscillators``: oscillators that share dampers, fitted to added mass and damping; symmetric, passive and zero at zero
        frequency whatever the data. The others find poles by ``realization``: singular values of the Hankel matrix of K and the
        bilinear map (paper A's RTM); ``impulse``: Prony's method and Steiglitz-McBride iterations on K (paper A's IRCFM);
        ``frequency``: rational functions with a common denominator fitted to added mass and damping (FDI of Perez and Fossen);
        ``vector``: vector fitting of the same.
    r2 : float
        Coefficient of determination to be reached, 0 < r2 < 1: of A(omega) and B(omega) of each coupling; of K(t) for
        ``realization`` and ``impulse`` as published.
    order : int, optional
        Number of states of every block, instead of `r2`; passive models have an even number. Where mass and restoring are not
        given, K(t) then has the largest weight, as far as the data determine it.
    max_order : int
        Largest number of states of the model.
    passive : bool
        Whether the model must be passive. If so, the poles that a method finds are the start of the oscillator form, which is
        fitted to added mass and damping; if not, the methods give what was published: stable, but hardly ever passive. The
        default method is passive either way.
    mass, stiffness : (m, m) array, optional
        Rigid-body inertia and restoring about O, both or none. With them a passive fit is aware of the motion: it weighs what
        the fit changes in the motion of the free-floating body under unit forces, and grows until that change is small; then
        it aims at damping and frequency of the body's resonances.

    Returns
    -------
    StateSpace
        In real modal form.

    Raises
    ------
    InputError
        Unknown method, r2 outside (0, 1), an order that the method cannot have, K that is zero, matrices of the wrong shape,
        mass without restoring; added mass and damping behind K with NaN, fewer than four or unsorted frequencies.

    Warns
    -----
    OgilvieWarning
        `r2` is not reached; the couplings and what they reach are named.

    Notes
    -----
    R2 = 1 - sum (x - x_fit)^2 / sum (x - mean x)^2. ``impulse``, ``frequency`` and ``vector`` as published find common poles
    with residues of full rank, m states for each pole of a block of m degrees of freedom; balanced truncation then takes away
    the states that R2 does not need. ``frequency`` and ``vector`` have K_hat(0) = 0.

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
    if not isinstance(K, Retardation):
        raise InputError(f"identify: retardation functions (see retardation) expected, {type(K).__name__} found.")
    check_spectrum(K)
    silent = _silent(K)
    blocks = coupled_blocks(np.where(silent[:, None] | silent, 0.0, K.K))
    if not blocks:
        raise InputError("identify: K is zero; there is no fluid memory to model.")
    m, notes = len(K.dofs), [n for n in K.notes if n.startswith(("damping not positive", "added mass"))]
    M = None if mass is None else check_square("mass", mass, m)
    C = None if stiffness is None else check_square("stiffness", stiffness, m)
    if (M is None) != (C is None):
        raise InputError("identify: mass and stiffness belong together; give both or none.")
    with algebra_threads(1):  # small matrices: threads would only wait for each other
        if method == "oscillators":
            models, A_inf, said = identify_passive(K, blocks, r2=r2, order=order, max_order=max_order, mass=M, stiffness=C)
        elif passive:
            poles = [trial.poles for _, trial, _ in _found(K, blocks, method, r2, order, max_order)]
            models, A_inf, said = identify_passive_from(
                K, blocks, poles, r2=r2, order=order, max_order=max_order, mass=M, stiffness=C
            )
        else:
            models, A_inf, said = _as_published(K, blocks, method, r2, order, max_order)
    for note in said:
        warnings.warn(f"identify: {note}", OgilvieWarning, stacklevel=2)
    A, B, C_out = stack_blocks([(dofs, *modal_form(a, b, c)) for dofs, a, b, c in models], m)
    model = StateSpace(A, B, C_out, K.dofs, A_inf=A_inf, method=method, notes=tuple(notes + said))
    return _reported(model, K, M, C)


def _silent(K: Retardation) -> Array:
    """Return the degrees of freedom (m,) that hold rounding only, such as yaw of a body of revolution."""
    size = np.abs(np.einsum("tii->ti", K.K)).max(axis=0)
    turns = np.array([dof.endswith(("roll", "pitch", "yaw")) for dof in K.dofs])
    largest = np.where(turns, size.max(where=turns, initial=0.0), size.max(where=~turns, initial=0.0))
    return np.asarray(size <= _ROUNDING * largest)


def _found(
    K: Retardation, blocks: list[list[int]], method: str, r2: float, order: int | None, max_order: int
) -> Iterator[tuple[FitTarget, Trial, Array]]:
    """What the papers' method finds for each block and the R2 it reaches; blocks share the states by their size."""
    target_of, fit = _FITS_TO[method]
    for dofs in blocks:
        target = target_of.of(K, dofs)
        yield target, *fit(target, r2=r2, order=order, limit=max(2, max_order * len(dofs) // sum(map(len, blocks))))


def _as_published(
    K: Retardation, blocks: list[list[int]], method: str, r2: float, order: int | None, max_order: int
) -> tuple[Blocks, Array, list[str]]:
    """Models of the blocks [(dofs, A, B, C)], A_inf (m, m) and notes on couplings that do not reach `r2`."""
    models: Blocks = []
    A_inf, notes = np.array(K.A_inf), []
    for dofs, (target, x, reached) in zip(blocks, _found(K, blocks, method, r2, order, max_order), strict=True):
        if order is None:
            x, reached = condense(target, x, reached, r2)
            notes += shortfall(K.dofs, dofs, reached, r2, len(x.A))
        elif order != len(x.A):
            raise InputError(
                f"order: {len(x.A)} is the closest that {method!r} and these data allow for "
                f"{', '.join(K.dofs[i] for i in dofs)}, {order} found."
            )
        models.append((dofs, x.A, x.B * target.scale, x.C * target.scale[:, None]))
        A_inf[np.ix_(dofs, dofs)] = x.A_inf * np.outer(target.scale, target.scale)
    return models, A_inf, notes


def _reported(model: StateSpace, K: Retardation, mass: Array | None, stiffness: Array | None) -> StateSpace:
    """Return the model with its figures of merit."""
    omega, A, B = radiation_data(K)
    K_hat = model.transfer(omega)
    assert model.A_inf is not None
    fitted_A = model.A_inf + K_hat.imag / omega[:, None, None]
    nothing = _silent(K)[:, None] | _silent(K)
    grid = np.concatenate([[0.0], np.geomspace(0.01 * omega[0], 100 * omega[-1], 4000)])
    change = None
    if mass is not None and stiffness is not None:
        change = motion_change(omega, A, B, fitted_A, K_hat.real, mass, stiffness)
    return replace(
        model,
        r2=np.where(nothing, np.nan, r_squared(K.K, model.impulse(K.t))),
        r2_added_mass=np.where(nothing, np.nan, r_squared(A, fitted_A, size=B)),
        r2_damping=np.where(nothing, np.nan, r_squared(B, K_hat.real)),
        passivity_margin=smallest_damping(model.transfer(grid)),
        is_passive=is_passive(model.A, model.B, model.C),
        motion_change=change,
    )


def _check_arguments(method: str, r2: float, order: int | None, max_order: int) -> None:
    if method not in METHODS:
        raise InputError(f"method: one of {METHODS} expected, {method!r} found.")
    for name, value in (("r2", r2), ("order", order), ("max_order", max_order)):
        if not (value is None and name == "order") and not isinstance(value, int | float | np.number):
            raise InputError(f"{name}: a number expected, {value!r} found.")
    if not 0.0 < r2 < 1.0:
        raise InputError(f"r2: a number between 0 and 1 (0.99, say) expected, {r2!r} found.")
    if order is not None and (order < 1 or order != int(order)):
        raise InputError(f"order: a positive whole number of states expected, {order!r} found.")
    if max_order < 1:
        raise InputError(f"max_order: a positive number of states expected, {max_order!r} found.")
