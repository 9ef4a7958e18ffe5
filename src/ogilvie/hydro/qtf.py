"""Quadratic transfer functions in a data set: put in, checked for symmetry, gaps filled by a rule that is named."""

from typing import Any, Literal

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.schema import VARIABLES, validate

Array = NDArray[Any]
Rule = Literal["newman-arithmetic", "zero"]

#: Largest deviation from the symmetry of a quadratic transfer function, as a fraction of its largest value (per component).
SYMMETRIC_WITHIN = 1e-4
_KINDS = ("qtf_diff", "qtf_sum")


def with_qtf(
    hydro: xr.Dataset,
    *,
    omega: ArrayLike,
    qtf_diff: ArrayLike | None = None,
    qtf_sum: ArrayLike | None = None,
    direction_pairs: ArrayLike | None = None,
) -> xr.Dataset:
    """Return the data set with quadratic transfer functions.

    Parameters
    ----------
    hydro : xarray.Dataset
        Obeys :mod:`ogilvie.hydro.schema`.
    omega : (n_w,) array
        Frequencies of both waves, rad/s, ascending; they need not be those of the data set.
    qtf_diff, qtf_sum : (n_w, n_w, n_b, n) complex array
        First wave, second wave, direction, degree of freedom. NaN: not known; a half that is missing follows from the symmetry.
    direction_pairs : (n_b, 2) array, optional
        Directions of the first and the second wave, rad; by default both waves travel in each ``wave_direction`` of the set.

    Raises
    ------
    InputError
        Shapes that differ; functions without their symmetry.

    Notes
    -----
    F = Re sum_i sum_j a_i a_j* Q_diff(i, j) exp(i (w_i - w_j) t) over all ordered pairs, with Q_diff(j, i) = conj Q_diff(i, j)
    and Q_diff(i, i) the mean drift per a^2; Q_sum(j, i) = Q_sum(i, j).

    Examples
    --------
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> A = np.ones((1, 1, 1))
    >>> hydro = hydro_from_arrays(omega=[0.5], added_mass=A, radiation_damping=A, dofs=("surge",),
    ...                           wave_direction=[np.pi], excitation_force=A)
    >>> half = np.array([[-1.0, np.nan], [0.2 - 1.5j, -2.0]])
    >>> with_qtf(hydro, omega=[0.5, 0.6], qtf_diff=half[:, :, None, None]).qtf_diff.values[0, 1, 0, 0]
    np.complex128(0.2+1.5j)
    """
    w = np.atleast_1d(np.asarray(omega, dtype=float))
    coords: dict[str, Any] = {"omega_1": w, "omega_2": w}
    if direction_pairs is not None:
        two = np.asarray(direction_pairs, dtype=float).reshape(-1, 2)
        coords |= {f"qtf_direction_{k + 1}": ("qtf_pair", two[:, k]) for k in (0, 1)}
        number = len(two)
    elif "wave_direction" in hydro.coords:
        number = hydro.sizes["wave_direction"]
    else:
        raise InputError("with_qtf: wave_direction in the data set, or direction_pairs, expected; neither found.")
    given = {kind: value for kind, value in zip(_KINDS, (qtf_diff, qtf_sum), strict=True) if value is not None}
    shape = (len(w), len(w), number, hydro.sizes["influenced_dof"])
    found = {}
    for kind, value in given.items():
        Q = np.array(value, dtype=complex)
        if Q.shape != shape:
            raise InputError(f"{kind}: shape {shape} = (omega, omega, direction, dof) expected, {Q.shape} found.")
        name = kind if direction_pairs is None else f"{kind}_pairs"
        found[name] = xr.DataArray(Q, dims=VARIABLES[name][0], coords=coords)
    return validate(symmetric_qtf(hydro.assign(found)))


def symmetric_qtf(hydro: xr.Dataset) -> xr.Dataset:
    """Return the data set with the missing half of each quadratic transfer function from the other half.

    The attribute ``filled_by_symmetry`` of a variable counts the pairs of frequencies that were filled.

    Raises
    ------
    InputError
        The two halves contradict each other, or the two axes of frequency differ.
    """
    filled = {}
    for name in (*_KINDS, *(f"{kind}_pairs" for kind in _KINDS)):
        if name not in hydro:
            continue
        Q, other = hydro[name].values, mirrored(hydro, name)
        defect = symmetry_defect(Q, other)
        if defect > SYMMETRIC_WITHIN:
            law = "Q(w2, w1) = conj Q(w1, w2)" if name.startswith("qtf_diff") else "Q(w2, w1) = Q(w1, w2)"
            raise InputError(
                f"{name}: {law} expected, a difference of {defect:.2g} of the largest value found. Check order, time factor "
                "and directions of the two waves."
            )
        missing = np.isnan(Q) & ~np.isnan(other)
        if missing.any():
            number = int(missing.any(axis=(2, 3)).sum())
            filled[name] = hydro[name].copy(data=np.where(missing, other, Q)).assign_attrs(filled_by_symmetry=number)
    return hydro.assign(filled)


def mirrored(hydro: xr.Dataset, name: str) -> Array:
    """Return what the symmetry makes of a quadratic transfer function: waves exchanged, conjugate for differences."""
    w1, w2 = hydro.omega_1.values, hydro.omega_2.values
    if len(w1) != len(w2) or not np.allclose(w1, w2, rtol=1e-9):
        raise InputError(f"{name}: the same frequencies for both waves expected, different ones found.")
    other = hydro[name].values.swapaxes(0, 1)
    if name.endswith("_pairs"):
        two = np.round(np.stack([hydro.qtf_direction_1.values, hydro.qtf_direction_2.values], axis=1), 7)
        place = {tuple(pair): k for k, pair in enumerate(two.tolist())}
        exchanged = [place.get((b, a)) for a, b in two.tolist()]
        known = [k for k in exchanged if k is not None]
        full = np.full(other.shape, np.nan + 0j)
        full[:, :, [k is not None for k in exchanged]] = other[:, :, known]
        other = full
    return other.conj() if name.startswith("qtf_diff") else other


def symmetry_defect(Q: Array, other: Array) -> float:
    """Return the largest difference of two halves where both are known, as a fraction of the largest value of the component."""
    both = ~np.isnan(Q) & ~np.isnan(other)
    if not both.any():
        return 0.0
    size = np.where(both, np.abs(Q), 0.0).max(axis=(0, 1, 2))
    away = np.where(both, np.abs(Q - other), 0.0).max(axis=(0, 1, 2))
    return float((away / np.maximum(size, 1e-12 * size.max() + np.finfo(float).tiny)).max())


def filled_qtf(hydro: xr.Dataset, *, by: Rule) -> xr.Dataset:
    """Return the data set with the pairs of frequencies that nobody computed filled in ``qtf_diff``.

    Parameters
    ----------
    hydro : xarray.Dataset
        With ``qtf_diff`` on a band about its diagonal, the diagonal included.
    by : {"newman-arithmetic", "zero"}
        (Q(w1, w1) + Q(w2, w2))/2, or nothing. Large differences of frequency hardly matter for slow motions.

    Raises
    ------
    InputError
        No ``qtf_diff``, a gap on its diagonal.

    Notes
    -----
    The attribute ``filled_by`` of the variable holds the rule.
    """
    if by not in ("newman-arithmetic", "zero"):
        raise InputError(f"filled_qtf: by 'newman-arithmetic' or 'zero' expected, {by!r} found.")
    if "qtf_diff" not in hydro:
        raise InputError("filled_qtf: qtf_diff expected in the data set, not found.")
    Q = symmetric_qtf(hydro).qtf_diff.values
    known = ~np.isnan(Q).all(axis=(0, 1, 2))
    diagonal = np.einsum("ppbi->pbi", Q)
    if np.isnan(diagonal[..., known]).any():
        raise InputError("qtf_diff: values on the whole diagonal expected, some are not known. Compute them.")
    mean = 0.5 * (diagonal[:, None] + diagonal[None, :]) if by == "newman-arithmetic" else np.zeros_like(Q)
    filled = np.where(np.isnan(Q) & known, mean, Q)
    return hydro.assign(qtf_diff=hydro.qtf_diff.copy(data=filled).assign_attrs(filled_by=by))
