"""Retardation functions K(t) from frequency-domain radiation data."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.memory.fourier import fourier_integral, legendre_pieces
from ogilvie.memory.screening import screen
from ogilvie.memory.tail import Tail, fit_tail

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Retardation:
    """Retardation functions K(t) of the radiation force -A_inf nu' - int K(t - s) nu(s) ds.

    Parameters
    ----------
    t : (n_t,) array
        Uniform, from 0, s.
    K : (n_t, m, m) array
        Force per velocity and time; SI.
    A_inf : (m, m) array
        Added mass at infinite frequency that goes with K, SI.
    dofs : tuple of str
    truncation_error, tail_error, discretisation_error : (m, m) array
        Estimates as fractions of the largest K_ij: what remains after the last time; what the damping beyond the last frequency
        may change; what the interpolation between frequencies may change. NaN where K_ij is zero.
    tail_exponent : (m, m) array
        p of the tail B ~ omega^-p; NaN where there is none.
    A_inf_ogilvie : (m, m) array
        A_inf from Ogilvie's relation, for comparison.
    omega, added_mass, radiation_damping : arrays
        The data that K was made from.
    mask : (n_w,) bool array
        Frequencies that were used.
    A_inf_given : bool
        False where A_inf was estimated from the rest of the data.
    source : str
    notes : tuple of str
        What the user should know about these functions.
    """

    t: Array
    K: Array
    A_inf: Array
    dofs: tuple[str, ...] = ("surge", "sway", "heave", "roll", "pitch", "yaw")
    truncation_error: Array | None = None
    tail_error: Array | None = None
    discretisation_error: Array | None = None
    tail_exponent: Array | None = None
    A_inf_ogilvie: Array | None = None
    omega: Array | None = None
    added_mass: Array | None = None
    radiation_damping: Array | None = None
    mask: Array | None = None
    A_inf_given: bool = True
    source: str = "given"
    notes: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        t, K, A_inf = np.array(self.t, dtype=float), np.array(self.K, dtype=float), np.array(self.A_inf, dtype=float)
        m = len(self.dofs)
        if t.ndim != 1 or len(t) < 2 or t[0] != 0.0 or not np.allclose(np.diff(t), t[1], rtol=1e-6, atol=0.0) or t[1] <= 0:
            raise InputError("Retardation: t must be uniform, ascending and start at 0; resample K first.")
        if K.shape != (len(t), m, m) or A_inf.shape != (m, m):
            raise InputError(f"Retardation: K ({len(t)}, {m}, {m}), A_inf ({m}, {m}) expected, {K.shape}, {A_inf.shape} found.")
        if not (np.all(np.isfinite(K)) and np.all(np.isfinite(A_inf))):
            raise InputError("Retardation: finite K and A_inf expected, NaN or infinite found.")
        for name, value in (("t", t), ("K", K), ("A_inf", A_inf)):
            value.setflags(write=False)
            object.__setattr__(self, name, value)

    @property
    def dt(self) -> float:
        """Time step of the table, s."""
        return float(self.t[-1] / (len(self.t) - 1))

    @property
    def duration(self) -> float:
        """Last time of the table, s."""
        return float(self.t[-1])

    def transform(self, omega: ArrayLike) -> NDArray[np.complex128]:
        """Return K_hat(i omega) = int_0^T K(t) exp(-i omega t) dt of the table (cubic spline), shape (n_w, m, m).

        B = Re K_hat and A = A_inf + Im K_hat / omega are the damping and added mass that a convolution with this table has.
        """
        return np.conj(fourier_integral(self.t, legendre_pieces(self.t, self.K, "spline"), omega))

    def __str__(self) -> str:
        lines = [
            f"Retardation functions: {len(self.dofs)} dofs, t = 0..{self.duration:g} s, dt = {self.dt:g} s ({self.source})",
            f"{'':14}{'K(0) SI':>12}{'tail p':>8}{'tail err':>10}{'trunc err':>10}{'interp err':>11}"
            f"{'A_inf':>13}{'Ogilvie':>13}",
        ]
        for i, dof in enumerate(self.dofs):
            values = [
                _at(x, i) for x in (self.tail_exponent, self.tail_error, self.truncation_error, self.discretisation_error)
            ]
            p, tail, truncation, interpolation = values
            lines.append(
                f"{dof:14}{self.K[0, i, i]:12.4g}{p:8.2f}{tail:10.1%}{truncation:10.1%}{interpolation:11.1%}"
                f"{self.A_inf[i, i]:13.5g}{_at(self.A_inf_ogilvie, i):13.5g}"
            )
        return "\n".join(lines + [f"note: {n}" for n in self.notes])


def _at(x: Array | None, i: int) -> float:
    return float("nan") if x is None else float(x[i, i])


def retardation(
    hydro: "xr.Dataset",
    *,
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
        With radiation_damping and added_mass; see :mod:`ogilvie.hydro.schema`.
    duration : float, optional
        Last time, s. By default where the size of every K_ii has fallen below 0.2 % of its largest value, as far as the
        spacing of the frequencies allows.
    dt : float, optional
        Time step, s. By default about 1/20 of the shortest period in the data.
    tail : {"fit", "omega-2", "omega-3", "none"}
        Damping beyond the last frequency; see :func:`ogilvie.memory.tail.fit_tail`.
    interpolation : {"spline", "linear"}
        Damping between the frequencies, integrated exactly either way.
    frequencies : {"clean", "all"} or (n_w,) bool array
        ``clean`` leaves out those whose damping matrix is not positive semi-definite (irregular frequencies) or whose added
        mass contradicts damping, and says which; see :func:`ogilvie.memory.screening.screen`.

    Returns
    -------
    Retardation

    Raises
    ------
    InputError
        Coefficients at forward speed, fewer than four frequencies, non-positive duration or step, damping that is zero
        everywhere.

    Notes
    -----
    K(t) = (2/pi) int_0^inf B(omega) cos(omega t) d omega with B(0) = 0; A_inf from the data where they have it, otherwise
    from Ogilvie's relation A_inf = A(omega) + (1/omega) int_0^inf K(t) sin(omega t) dt, averaged over the frequencies with
    weight omega^2 d omega; both are kept for comparison.

    References
    ----------
    Ogilvie (1964); paper A (Yuan 2017), Eqs. (3), (4).

    Examples
    --------
    >>> import ogilvie as og
    >>> w = np.linspace(0.05, 4.0, 80)
    >>> B = (2 * w**2 / (1 + w**2) ** 2)[:, None, None]  # of K = (1 - t) exp(-t)
    >>> h = og.hydro_from_arrays(omega=w, added_mass=np.ones_like(B), radiation_damping=B, dofs=("heave",))
    >>> K = og.retardation(h, duration=20.0, dt=0.1)
    >>> K.K.shape, bool(abs(K.K[10, 0, 0]) < 0.01)  # K(1) = 0
    ((201, 1, 1), True)
    """
    if hydro.attrs.get("speed", 0.0) != 0.0:
        raise InputError(
            f"retardation: coefficients at zero speed expected, speed {hydro.attrs['speed']:.4g} m/s found. At speed "
            f"the damping does not vanish at infinite frequency and this version does not split it off; use zero-speed ones."
        )
    omega_all, A_all, B_all = hydro.omega.values, hydro.added_mass.values, hydro.radiation_damping.values
    mask, screened = screen(
        hydro, _mask(frequencies, omega_all), remove=isinstance(frequencies, str) and frequencies == "clean"
    )
    omega, A, B = omega_all[mask], A_all[mask], B_all[mask]
    _check_data(omega, B, duration, dt)
    dofs = tuple(str(d) for d in hydro.influenced_dof.values)
    w0, B0 = np.concatenate([[0.0], omega]), np.concatenate([np.zeros((1,) + B.shape[1:]), B])
    tails, notes = _tails(omega, B, dofs, tail)
    notes = screened + notes
    dt = dt or _nice_step(2 * np.pi / omega[-1] / 20)
    horizon = np.pi / _energetic_step(omega, B)
    if duration is None:
        duration = _memory_length(w0, B0, tails, horizon, dt, interpolation)
    t = dt * np.arange(int(np.ceil(duration / dt - 1e-9)) + 1)
    K = _kernel(w0, B0, tails, t, interpolation)
    later = np.linspace(t[-1], max(min(2 * t[-1], horizon), 1.05 * t[-1]), 200)
    scale = np.abs(K).max(axis=0)
    scale = np.where(scale > 0, scale, np.nan)
    other = "linear" if interpolation == "spline" else "spline"
    A_ogilvie = _ogilvie(omega, A, t, K)
    has_A_inf = "added_mass_inf" in hydro
    if not has_A_inf:
        notes.append("A_inf: not in the data; Ogilvie's relation is used.")
    if t[-1] > horizon:
        notes.append(
            f"duration {t[-1]:.4g} s exceeds {horizon:.4g} s, up to which the spacing of the frequencies determines K."
        )
    return Retardation(
        t,
        K,
        hydro.added_mass_inf.values if has_A_inf else A_ogilvie,
        dofs,
        truncation_error=np.abs(_kernel(w0, B0, tails, later, interpolation)).max(axis=0) / scale,
        tail_error=_tail_error(omega, B, tails, t[: len(t) // 4 + 2], tail) / scale,
        discretisation_error=np.abs(_kernel(w0, B0, tails, t, other) - K).max(axis=0) / scale,
        tail_exponent=np.array([[np.nan if x is None else x.p for x in row] for row in tails]),
        A_inf_ogilvie=A_ogilvie,
        omega=omega_all,
        added_mass=A_all,
        radiation_damping=B_all,
        mask=mask,
        A_inf_given=has_A_inf,
        source=f"damping of {hydro.attrs.get('name', 'vessel')}, {interpolation}, tail {tail}",
        notes=tuple(notes),
    )


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
    if not np.all(np.isfinite(B)):
        raise InputError("retardation: finite damping expected, NaN or infinite found.")
    if not np.any(B):
        raise InputError("retardation: the damping is zero at all frequencies; there is no fluid memory to model.")
    for name, value in (("duration", duration), ("dt", dt)):
        if value is not None and not (np.isfinite(value) and value > 0):
            raise InputError(f"retardation: {name} must be a positive number of seconds, {value!r} found.")
    if duration is not None and dt is not None and dt > duration:
        raise InputError(f"retardation: dt = {dt:g} s exceeds the duration {duration:g} s.")


def _tails(omega: Array, B: Array, dofs: tuple[str, ...], kind: str) -> tuple[list[list[Tail | None]], list[str]]:
    """Return the tail of each coupling; where none can be fitted though damping is left, omega^-3 is used and said."""
    peak = np.abs(B).max(axis=0)
    rows, forced = [], []
    for i in range(B.shape[1]):
        row: list[Tail | None] = []
        for j in range(B.shape[2]):
            found = fit_tail(omega, B[:, i, j], kind)
            if found is None and kind == "fit" and abs(B[-1, i, j]) > 0.01 * peak[i, j] > 0:
                found = fit_tail(omega, B[:, i, j], "omega-3")
                forced.append(f"{dofs[i]}-{dofs[j]}")
            row.append(found)
        rows.append(row)
    notes = [f"damping has no clean tail to fit, omega^-3 assumed: {', '.join(forced)}."] if forced else []
    return rows, notes


def _kernel(w0: Array, B0: Array, tails: list[list[Tail | None]], t: Array, interpolation: str) -> Array:
    K = fourier_integral(w0, legendre_pieces(w0, B0, interpolation), t).real
    for i, row in enumerate(tails):
        for j, tail in enumerate(row):
            if tail is not None:
                K[:, i, j] += tail.integral(w0[-1], t).real
    return 2 / np.pi * K


def _tail_error(omega: Array, B: Array, tails: list[list[Tail | None]], t: Array, kind: str) -> Array:
    """Largest change of K(t) when the tail is fitted otherwise: to a shorter piece, with another correction."""
    error = np.zeros(B.shape[1:])
    for i, row in enumerate(tails):
        for j, tail in enumerate(row):
            b = B[:, i, j]
            base = 0.0 if tail is None else tail.integral(omega[-1], t).real
            others = [fit_tail(omega, b, "fit", share=0.3), fit_tail(omega, b, "fit", power=3)]
            others = [o for o in others if o is not None] or [fit_tail(omega, b, "omega-2")]
            error[i, j] = max(
                (np.abs(o.integral(omega[-1], t).real - base).max() for o in others if o is not None), default=0.0
            )
    return 2 / np.pi * error


def _ogilvie(omega: Array, A: Array, t: Array, K: Array) -> Array:
    sine = fourier_integral(t, legendre_pieces(t, K, "spline"), omega).imag
    weight = omega**2 * np.gradient(omega)
    return np.einsum("w,wij->ij", weight / weight.sum(), A + sine / omega[:, None, None])


def _energetic_step(omega: Array, B: Array) -> float:
    """Median spacing of the frequencies that carry the damping."""
    diagonal = np.abs(np.einsum("wii->wi", B))
    peak = diagonal.max(axis=0)
    level = (diagonal[:, peak > 0] / peak[peak > 0]).max(axis=1)
    step = np.diff(np.concatenate([[0.0], omega]))
    return float(np.median(step[level > 0.05]))


def _memory_length(
    w0: Array, B0: Array, tails: list[list[Tail | None]], horizon: float, dt: float, interpolation: str
) -> float:
    t = np.linspace(0.0, horizon, 600)
    K = np.abs(np.einsum("tii->ti", _kernel(w0, B0, tails, t, interpolation)))
    peak = K.max(axis=0)
    alive = (K[:, peak > 0] / peak[peak > 0]).max(axis=1) > 2e-3
    last = t[np.flatnonzero(alive)[-1]]
    return float(max(min(1.05 * last, horizon), 40 * dt))


def _nice_step(dt: float) -> float:
    """Round down to 1, 2 or 5 times a power of ten."""
    decade = 10.0 ** np.floor(np.log10(dt))
    return float(max(m for m in (1.0, 2.0, 5.0) if m * decade <= dt * (1 + 1e-9)) * decade)
