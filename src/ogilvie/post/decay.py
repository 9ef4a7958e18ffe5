"""Free decays: period and damping of every cycle, and damping coefficients that reproduce the whole series."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.schema import DOFS
from ogilvie.post.decay_fit import TERMS, Fit, fit_decay
from ogilvie.post.decay_peaks import extrema, first_look
from ogilvie.post.decay_result import DecayAnalysis, Estimate

Array = NDArray[Any]

_SMALL = 0.01  # of the first extremum: smaller ones are not picked
_SWINGS = 0.9995  # R2 below which a misfit that swings with the motion is mentioned
_POOR = 0.99  # R2 below which the fit is said to be poor


def decay(
    t: ArrayLike,
    x: ArrayLike,
    *,
    dof: str = "roll",
    model: str = "linear+quadratic",
    start: float | None = None,
    end: float | None = None,
    offset: float | str = "fit",
    restoring: str = "linear",
    inertia: float | None = None,
    stiffness: float | None = None,
) -> DecayAnalysis:
    """Return period and damping of a free decay, cycle by cycle and as coefficients of a model fitted to the whole series.

    Parameters
    ----------
    t, x : (n,) array
        Times, s, and motion, m or rad, measured or simulated; the motion is free from `start` on.
    dof : str
        Degree of freedom; decides the units of the printed table.
    model : str
        Damping terms joined by +: ``linear``, ``quadratic``, ``cubic``.
    start, end : float, optional
        Part of the series to be used, s. By default from the largest excursion to the end.
    offset : float, "fit" or "drift"
        Rest position, m or rad: known, to be found, or to be found with a linear drift.
    restoring : {"linear", "cubic"}
        ``cubic``: a term e x^3 of the restoring is found too, for a period that changes with the amplitude.
    inertia : float, optional
        Mass or moment of inertia with added mass: damping coefficients are then in SI instead of per unit of inertia.
    stiffness : float, optional
        Restoring coefficient, N/m or N m/rad (of roll: weight times GM), instead of the inertia: that is stiffness / omega^2.

    Returns
    -------
    DecayAnalysis
        Print it for a table.

    Raises
    ------
    InputError
        NaN, times that do not ascend, fewer than one and a half cycles or ten samples in a cycle, unknown model.
    ConvergenceError
        The fit does not converge.

    Notes
    -----
    m x'' + B1 x' + B2 |x'| x' + B3 x'^3 + C (x + e x^3) = 0 about the offset is integrated and fitted to all samples by
    nonlinear least squares, so noise averages out and no amplitude is read off. Extrema come from local fits of a damped
    sine. The decrement of the cycle from extremum k to k + 2 is d = log(x_k / x_{k+2}), its damping ratio
    d / sqrt(4 pi^2 + d^2). To first order in the damping it equals :meth:`DecayAnalysis.equivalent_damping_ratio`.

    References
    ----------
    ITTC Recommended Procedures 7.5-02-07-04.5, Numerical estimation of roll damping; Faltinsen (1990), Sea loads on ships and
    offshore structures, chapter 7.

    Examples
    --------
    >>> t = np.linspace(0.0, 60.0, 1201)
    >>> x = 0.1 * np.exp(-0.02 * t) * np.cos(np.sqrt(1 - 0.02**2) * t)
    >>> found = decay(t, x, dof="heave", model="linear", inertia=50.0)
    >>> round(found.linear.value, 4), round(found.natural_period, 4), round(float(found.damping_ratio.max()), 4)
    (2.0, 6.2832, 0.02)
    """
    terms = _check(t, x, dof, model, offset, restoring, inertia, stiffness)
    t, x = _window(np.asarray(t, dtype=float), np.asarray(x, dtype=float), start, end)
    look = first_look(t, x, drift=offset == "drift")
    found = fit_decay(
        t,
        x,
        terms=terms,
        stiffening=restoring == "cubic",
        drift=offset == "drift",
        fixed=float(offset) if not isinstance(offset, str) else None,
        start=_guess(t, x, look),
    )
    base = found.values["offset"] + found.values["drift"] * (t - t[0])
    residual = x - found.series
    peak_time, peak = extrema(t, x - base, look, noise=float(residual.std()), smallest=_SMALL)
    root = float(np.sqrt(found.values["stiffness"]))
    omega = Estimate(root, found.errors["stiffness"] / (2 * root))
    if stiffness is not None:
        inertia = stiffness / omega.value**2
    decrement = np.log(peak[:-2] / peak[2:])
    r2 = float(1 - (residual @ residual) / ((x - x.mean()) @ (x - x.mean())))
    return DecayAnalysis(
        dof,
        "+".join(terms),
        t,
        x,
        found.series,
        natural_frequency=omega,
        **{k: _estimate(found, k, inertia or 1.0) for k in TERMS},
        **{k: _estimate(found, k, 1.0) for k in ("stiffening", "offset", "drift")},
        inertia=inertia,
        peak_time=peak_time,
        peak=peak,
        time=(peak_time[:-2] + peak_time[2:]) / 2,
        amplitude=np.abs(peak[:-2] - 2 * peak[1:-1] + peak[2:]) / 4,
        period=peak_time[2:] - peak_time[:-2],
        damping_ratio=decrement / np.hypot(2 * np.pi, decrement),
        r2=r2,
        independent=found.independent,
        notes=_notes(found, terms, r2, len(t) / found.independent),
    )


def _check(
    t: Any, x: Any, dof: str, model: str, offset: float | str, restoring: str, inertia: float | None, stiffness: float | None
) -> tuple[str, ...]:
    """Return the damping terms in their order, or raise InputError."""
    times, motion = np.asarray(t, dtype=float), np.asarray(x, dtype=float)
    if times.ndim != 1 or times.shape != motion.shape:
        raise InputError(f"decay: t and x of one length expected, shapes {times.shape} and {motion.shape} found.")
    if not (np.all(np.isfinite(times)) and np.all(np.isfinite(motion))):
        raise InputError("decay: finite t and x expected, NaN or infinite found; cut them out.")
    if len(times) < 2 or np.any(np.diff(times) <= 0.0):
        raise InputError("decay: ascending times expected, repeated or descending ones found.")
    if dof not in DOFS:
        raise InputError(f"dof: one of {', '.join(DOFS)} expected, {dof!r} found.")
    words = model.split("+") if isinstance(model, str) else []
    if not words or len(set(words)) != len(words) or any(w not in TERMS for w in words):
        raise InputError(f"model: {', '.join(TERMS)}, or some of them joined by +, expected, {model!r} found.")
    if isinstance(offset, str) and offset not in ("fit", "drift"):
        raise InputError(f"offset: a number, 'fit' or 'drift' expected, {offset!r} found.")
    if restoring not in ("linear", "cubic"):
        raise InputError(f"restoring: 'linear' or 'cubic' expected, {restoring!r} found.")
    if inertia is not None and stiffness is not None:
        raise InputError("decay: inertia or stiffness expected, both found; the natural frequency ties them together.")
    for name, value in (("inertia", inertia), ("stiffness", stiffness)):
        if value is not None and not (np.isfinite(value) and value > 0):
            raise InputError(f"{name}: a positive number expected, {value!r} found.")
    return tuple(k for k in TERMS if k in words)


def _window(t: Array, x: Array, start: float | None, end: float | None) -> tuple[Array, Array]:
    last = t[-1] if end is None else end
    if start is None:
        before = t <= last
        rest = x[before][before.sum() // 2 :].mean() if before.any() else 0.0
        start = t[before][int(np.argmax(np.abs(x[before] - rest)))] if before.any() else t[0]
    use = (t >= start) & (t <= last)
    if use.sum() < 2 or not np.ptp(x[use]) > 0.0:
        raise InputError(f"decay: a motion between {start:g} and {last:g} s expected, none found. Check start and end.")
    return t[use], x[use]


def _guess(t: Array, x: Array, look: Any) -> dict[str, float]:
    """First parameters of the fit from the damped sine."""
    s = (t - t[0])[t - t[0] < np.pi / look.omega]
    decay = np.exp(-look.sigma * s)
    y = x[: len(s)] - look.base(t)[: len(s)]
    regressors = np.stack([decay * np.cos(look.omega * s), decay * np.sin(look.omega * s)], axis=1)
    a, b = np.linalg.lstsq(regressors, y, rcond=None)[0]
    return {
        "x0": float(a),
        "v0": float(b * look.omega - look.sigma * a),
        "stiffness": look.omega**2 + look.sigma**2,
        "linear": 2 * look.sigma,
        "offset": look.offset,
        "drift": look.drift,
    }


def _estimate(found: Fit, name: str, factor: float) -> Estimate:
    return Estimate(factor * found.values[name], factor * found.errors[name])


def _notes(found: Fit, terms: tuple[str, ...], r2: float, inflation: float) -> tuple[str, ...]:
    notes = []
    if r2 < _POOR:
        notes.append(f"the fitted decay explains {r2:.1%} of the variance only; check start, end, offset and model.")
    elif r2 < _SWINGS and inflation > 10.0:
        notes.append(
            "the misfit swings with the motion: another damping model, restoring='cubic' or a later start may fit better."
        )
    vague = [k for k in terms if found.errors[k] > abs(found.values[k])]
    if vague:
        notes.append(f"{', '.join(vague)}: not told from zero; a longer series or larger amplitudes, or fewer terms.")
    return tuple(notes)
