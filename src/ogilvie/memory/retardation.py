"""Retardation functions K(t) from frequency-domain radiation data: the ways to them, the choices, what is reported."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.memory.curves import RadiationCurves, continued
from ogilvie.memory.fourier import INTERPOLATIONS
from ogilvie.memory.from_added_mass import kernel_from_added_mass
from ogilvie.memory.from_damping import kernel_from_damping
from ogilvie.memory.from_samples import equidistant_step, kernel_by_ifft, kernel_by_trapezoid
from ogilvie.memory.infinite import infinite_added_mass
from ogilvie.memory.kernel_errors import Doubts, doubts_of, other_interpolation
from ogilvie.memory.screening import screen
from ogilvie.memory.table import Retardation
from ogilvie.memory.times import time_table

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[Any]
Route = Callable[[RadiationCurves, Array | None, Array, str], Array]

_EXACT: dict[str, Route] = {"damping": kernel_from_damping, "added_mass": kernel_from_added_mass}
_SAMPLED: dict[str, Route] = {"trapezoid": kernel_by_trapezoid, "ifft": kernel_by_ifft}
METHODS = (*_EXACT, *_SAMPLED)

_CONTRADICTION = 0.1  # of the largest K_ii, by which the two exact forms may differ without a word


def retardation(
    hydro: "xr.Dataset",
    *,
    method: str = "damping",
    duration: float | None = None,
    dt: float | None = None,
    tail: str = "fit",
    interpolation: str = "spline",
    frequencies: str | ArrayLike = "clean",
) -> Retardation:
    """Return the retardation functions of a hydrodynamic data set, with their errors.

    Parameters
    ----------
    hydro : xarray.Dataset
        With radiation_damping and added_mass; see :mod:`ogilvie.hydro.schema`. From data at forward speed the terms of speed
        are taken off (:func:`ogilvie.zero_speed_equivalent`): the time loop and :func:`ogilvie.kernel_at_speed` put them back.
    method : {"damping", "added_mass", "trapezoid", "ifft"}
        ``damping``: the cosine form, ``added_mass``: the sine form, both integrated exactly from 0 to infinity; they agree
        where the data are causal. ``trapezoid`` and ``ifft``: paper A's Eqs. (9) and (8) as published, sums over
        equidistant frequencies without a tail, which repeat themselves; for comparison only.
    duration : float, optional
        Last time, s. By default where the size of every K_ii has fallen below 0.2 % of its largest value, as far as the
        spacing of the frequencies allows.
    dt : float, optional
        Time step, s. By default about 1/20 of the shortest period in the data.
    tail : {"fit", "omega-2", "omega-3", "none"}
        Damping beyond the last frequency; see :func:`ogilvie.memory.tail.fit_tail`.
    interpolation : {"spline", "linear"}
        Between the frequencies, integrated exactly either way.
    frequencies : {"clean", "all"} or (n_w,) bool array
        ``clean`` leaves out those whose damping matrix is not positive semi-definite (irregular frequencies) or whose added
        mass contradicts damping, and says which; see :func:`ogilvie.memory.screening.screen`.

    Returns
    -------
    Retardation

    Raises
    ------
    InputError
        Fewer than four frequencies, non-positive duration or step, NaN, damping that is zero
        everywhere, unknown method, tail or interpolation.

    Notes
    -----
    K(t) = (2/pi) int_0^inf B cos(omega t) d omega = -(2/pi) int_0^inf omega (A - A_inf) sin(omega t) d omega with B(0) = 0.
    A_inf is taken from the data where they have it, otherwise from Ogilvie's relation
    A_inf = A(omega) + (1/omega) int_0^inf K(t) sin(omega t) dt with K from the damping, averaged over the frequencies by
    confidence (:mod:`ogilvie.memory.infinite`); both are kept for comparison. The error estimates are explained at
    :class:`Retardation`. Those of the tail and of what is left after the last time are those of the damping whatever the
    method; the discretisation error of the sums is their distance from the exact integral.

    References
    ----------
    Ogilvie (1964); paper A (Yuan 2017), Eqs. (3), (4), (8), (9).

    Examples
    --------
    >>> import ogilvie as og
    >>> w = np.linspace(0.05, 4.0, 80)
    >>> B = (2 * w**2 / (1 + w**2) ** 2)[:, None, None]  # of K = (1 - t) exp(-t)
    >>> A = (1 + (1 - w**2) / (1 + w**2) ** 2)[:, None, None]
    >>> h = og.hydro_from_arrays(omega=w, added_mass=A, radiation_damping=B, dofs=("heave",))
    >>> K = og.retardation(h, duration=20.0, dt=0.1)
    >>> K.K.shape, bool(abs(K.K[10, 0, 0]) < 0.01)  # K(1) = 0
    ((201, 1, 1), True)
    >>> bool(K.consistency_error[0, 0] < 0.01), round(float(K.A_inf[0, 0]), 3)
    (True, 1.0)
    """
    route = _route(method, interpolation)
    hydro, taken_off = _at_rest(hydro)
    omega_all, A_all, B_all = _data(hydro)
    clean = isinstance(frequencies, str) and frequencies == "clean"
    mask, screened = screen(hydro, _mask(frequencies, omega_all), remove=clean)
    _check_data(omega_all[mask], B_all[mask], duration, dt)
    dofs = tuple(str(d) for d in hydro.influenced_dof.values)
    curves, notes = continued(omega_all[mask], A_all[mask], B_all[mask], dofs, tail)
    notes = [*screened, *taken_off, *notes]
    horizon = np.pi / curves.energetic_step()
    t = time_table(curves, duration, dt, horizon, interpolation)
    K_damping = kernel_from_damping(curves, None, t, interpolation)
    doubts = doubts_of(curves, K_damping, t, interpolation, horizon)
    A_ogilvie = infinite_added_mass(curves, t, K_damping, doubts)
    given = "added_mass_inf" in hydro
    A_inf = hydro.added_mass_inf.values if given else A_ogilvie
    K = K_damping if method == "damping" else route(curves, A_inf, t, interpolation)
    errors = _errors(curves, A_inf, t, method, interpolation, K, K_damping, doubts)
    notes += _remarks(curves, method, given, t[-1], horizon)
    if method in _EXACT:
        notes += _contradictions(dofs, errors["consistency_error"])
    return Retardation(
        t,
        K,
        A_inf,
        dofs,
        **errors,
        tail_exponent=np.array([[np.nan if x is None else x.p for x in row] for row in curves.tails]),
        A_inf_ogilvie=A_ogilvie,
        omega=omega_all,
        added_mass=A_all,
        radiation_damping=B_all,
        mask=mask,
        A_inf_given=given,
        source=f"{method} of {hydro.attrs.get('name', 'vessel')}, {interpolation}, tail {tail if method in _EXACT else 'none'}",
        notes=tuple(notes),
    )


def _errors(
    curves: RadiationCurves, A_inf: Array, t: Array, method: str, interpolation: str, K: Array, K_damping: Array, doubts: Doubts
) -> dict[str, Array]:
    """Error estimates (m, m) as parts of the largest |K_ij|, NaN where that is zero."""
    peak = np.abs(K).max(axis=0)
    scale = np.where(peak > 0, peak, np.nan)
    if method == "added_mass":
        K_other, otherwise = K_damping, kernel_from_added_mass(curves, A_inf, t, other_interpolation(interpolation))
    else:
        K_other, otherwise = kernel_from_added_mass(curves, A_inf, t, interpolation), K_damping + doubts.interpolation
    return {
        "truncation_error": doubts.later / scale,
        "tail_error": doubts.tail / scale,
        "discretisation_error": np.abs(otherwise - K).max(axis=0) / scale,
        "consistency_error": np.abs(K_other - K).max(axis=0) / scale,
    }


def _route(method: str, interpolation: str) -> Route:
    if method not in METHODS:
        raise InputError(f"method: one of {METHODS} expected, {method!r} found.")
    if interpolation not in INTERPOLATIONS:
        raise InputError(f"interpolation: one of {INTERPOLATIONS} expected, {interpolation!r} found.")
    return (_EXACT | _SAMPLED)[method]


def _at_rest(hydro: "xr.Dataset") -> tuple["xr.Dataset", list[str]]:
    """Return the data with the terms of forward speed taken off, and a note of it."""
    speed = float(getattr(hydro, "attrs", {}).get("speed", 0.0))
    if speed == 0.0:
        return hydro, []
    from ogilvie.hydro.at_speed import radiation_at_rest

    rest = radiation_at_rest(hydro)
    left = max(rest.attrs["asymmetry_added_mass"], rest.attrs["asymmetry_radiation_damping"])
    return rest, [f"the terms of the speed {speed:.4g} m/s are taken off; couplings ij and ji then differ by up to {left:.2%}."]


def _data(hydro: "xr.Dataset") -> tuple[Array, Array, Array]:
    """Frequencies, added mass and damping at zero speed."""
    if not hasattr(hydro, "data_vars"):
        raise InputError(f"retardation: a hydrodynamic data set (e.g. from read_hydro) expected, {type(hydro).__name__} found.")
    if missing := [name for name in ("added_mass", "radiation_damping") if name not in hydro]:
        raise InputError(f"retardation: a hydrodynamic data set with {', '.join(missing)} expected; see og.hydro_from_arrays.")
    values = hydro.omega.values, hydro.added_mass.values, hydro.radiation_damping.values
    bad = [n for n, x in zip(("omega", "added mass", "damping"), values, strict=True) if not np.all(np.isfinite(x))]
    if "added_mass_inf" in hydro and not np.all(np.isfinite(hydro.added_mass_inf.values)):
        bad.append("added_mass_inf")
    if bad:
        raise InputError(f"retardation: finite {' and '.join(bad)} expected, NaN or infinite found.")
    return values


def _mask(frequencies: str | ArrayLike, omega: Array) -> Array:
    if isinstance(frequencies, str):
        if frequencies not in ("clean", "all"):
            raise InputError(f"frequencies: 'clean', 'all' or a mask expected, {frequencies!r} found.")
        return np.ones(len(omega), dtype=bool)
    mask = np.asarray(frequencies)
    if mask.shape != omega.shape or mask.dtype != bool:
        raise InputError(f"frequencies: a mask of {len(omega)} booleans expected, {mask.dtype} of shape {mask.shape} found.")
    return mask


def _check_data(omega: Array, B: Array, duration: float | None, dt: float | None) -> None:
    if len(omega) < 4:
        raise InputError(f"retardation: at least 4 frequencies expected, {len(omega)} found; K needs the whole damping curve.")
    if not np.any(np.einsum("wii->wi", B)):
        raise InputError("retardation: the damping of each dof is zero at all frequencies; there is no fluid memory to model.")
    for name, value in (("duration", duration), ("dt", dt)):
        if value is not None and not (isinstance(value, int | float | np.number) and np.isfinite(value) and value > 0):
            raise InputError(f"retardation: {name} must be a positive number of seconds, {value!r} found.")
    if duration is not None and dt is not None and dt > duration:
        raise InputError(f"retardation: dt = {dt:g} s exceeds the duration {duration:g} s.")


def _remarks(curves: RadiationCurves, method: str, A_inf_given: bool, duration: float, horizon: float) -> list[str]:
    """What the user should know besides the tails."""
    remarks = []
    if not A_inf_given:
        remarks.append("A_inf: not in the data; Ogilvie's relation is used.")
    if method in _SAMPLED:
        step = equidistant_step(curves)
        remarks.append(
            f"{method}: K repeats at 2 pi/d_omega = {2 * np.pi / step:.4g} s and has no part beyond {curves.omega[-1]:.4g} "
            "rad/s; for comparison with method='damping'."
        )
    if duration > horizon:
        remarks.append(
            f"duration {duration:.4g} s exceeds {horizon:.4g} s, up to which the spacing of the frequencies determines K."
        )
    return remarks


def _contradictions(dofs: tuple[str, ...], consistency: Array) -> list[str]:
    """Name the degrees of freedom in which added mass and damping do not give the same K."""
    far = [f"{dof} {x:.0%}" for dof, x in zip(dofs, np.diag(consistency), strict=True) if x > _CONTRADICTION]
    if not far:
        return []
    return [
        f"K from the added mass is another than K from the damping in {', '.join(far)}: damping ends too high, A_inf is off, "
        "or the two contradict each other; see check(hydro)."
    ]
