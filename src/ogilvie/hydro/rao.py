"""Motions per metre of wave amplitude (response amplitude operators) from a hydrodynamic data set."""

import warnings

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.body import RigidBody
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.mirror import is_symmetric
from ogilvie.hydro.speed_terms import fluid_momentum, speed_matrix
from ogilvie.waves.dispersion import encounter_frequency

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_SINGULAR = 1e12  # condition number of the scaled impedance beyond which no motion is given
_LIGHT_DAMPING = 0.01  # of critical


def rao(
    hydro: xr.Dataset,
    body: RigidBody | None = None,
    *,
    mass: ArrayLike | None = None,
    stiffness: ArrayLike | None = None,
    damping: ArrayLike | None = None,
    speed: float | None = None,
) -> xr.DataArray:
    """Return the motion of O per metre of wave amplitude, complex.

    Parameters
    ----------
    hydro : xarray.Dataset
        Data set with ``excitation_force``.
    body : RigidBody, optional
        Its inertia matrix about O. Without `body` and `mass` the data set's ``inertia_matrix`` is used.
    mass : (n, n) array, optional
        Inertia matrix about O in place of `body`.
    stiffness : (n, n) array, optional
        Added to the hydrostatic stiffness (mooring), about O.
    damping : (n, n) array, optional
        Added to the radiation damping (viscous roll damping), about O. What WAMIT added to its own motions is
        ``hydro.external_damping``; it is not used unless given here.
    speed : float, optional
        Forward speed, m/s; that of the data by default. With another only the encounter frequency follows, with a warning;
        :func:`ogilvie.at_speed` makes coefficients and forces follow too.

    Returns
    -------
    xarray.DataArray
        (omega, wave_direction, dof) complex; m/m and rad/m, x = Re(RAO a exp(i (omega_e t + phase))). The coordinate
        ``encounter_frequency`` (omega, wave_direction) is signed. NaN where omega_e lies beyond the radiation data, or where
        nothing holds the body.

    Raises
    ------
    InputError
        No excitation, inertia or stiffness; wrong shape.

    Warns
    -----
    OgilvieWarning
        A resonance with less than 1 % of critical damping, encounter frequencies outside the data, a singular impedance, a body
        whose weight does not fit the data set's stiffness.

    Notes
    -----
    [-omega_e^2 (M + A) + i omega_e (B + B_ext) + C + C_ext] X = F(omega, b). A and B are even in omega_e, so the negative
    omega_e of overtaken waves turns the sign of the damping term, as it must. Between the frequencies of the data A and B are
    interpolated monotonically (PCHIP); down to omega_e = 0, B falls to 0 and A goes to ``added_mass_zero`` or, without it,
    keeps its first value. Coefficients at speed, which grow as 1/omega_e^2, are interpolated without their terms of speed
    (:mod:`ogilvie.hydro.speed_terms`), which are put back at omega_e: the impedance -omega_e^2 A + i omega_e B then has its
    limit -U^2 L^T A L at omega_e = 0. At negative omega_e X is
    the conjugate of the motion at -omega_e under the conjugate force.

    Examples
    --------
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> w = np.array([0.5, 1.0, 2.0]); A = np.ones((3, 1, 1)); B = 0.2 * A
    >>> hydro = hydro_from_arrays(omega=w, added_mass=A, radiation_damping=B, wave_direction=[np.pi], dofs=("heave",),
    ...     excitation_force=np.full((3, 1, 1), 4.0), hydrostatic_stiffness=[[4.0]], inertia_matrix=[[2.0]])
    >>> np.abs(rao(hydro).values[:, 0, 0]).round(4)
    array([1.2302, 3.9223, 0.4994])
    """
    if "excitation_force" not in hydro:
        raise InputError("rao: excitation_force expected in the data set, not found. Read or solve for wave forces.")
    dofs = [str(d) for d in hydro.influenced_dof.values]
    M = _inertia(hydro, body, mass)  # (n, n)
    C = _restoring(hydro) + _matrix(stiffness, dofs, "stiffness")
    B_ext = _matrix(damping, dofs, "damping")
    U = _speed(hydro, speed)
    omega, b = hydro.omega.values, hydro.wave_direction.values
    omega_e = encounter_frequency(
        omega[:, None], speed=U, direction=b, depth=hydro.attrs["water_depth"], g=hydro.attrs["g"]
    )  # (n_w, n_b)
    _warn_of_resonance(hydro, M, C, B_ext, dofs)
    w = omega_e[..., None, None]
    Z = -(w**2) * M + 1j * w * B_ext + C + _radiation(hydro, omega_e)  # (n_w, n_b, n, n)
    X = _solve(Z, hydro.excitation_force.values, dofs, omega_e)
    return xr.DataArray(
        X,
        dims=("omega", "wave_direction", "dof"),
        coords={
            "omega": omega,
            "wave_direction": b,
            "dof": dofs,
            "encounter_frequency": (("omega", "wave_direction"), omega_e),
        },
        name="rao",
        attrs={
            "speed": U,
            "water_depth": hydro.attrs["water_depth"],
            "g": hydro.attrs["g"],
            "time_convention": "exp(+iwt)",
            "port_starboard_symmetric": int(is_symmetric(hydro)),
            "units": "m/m for translations, rad/m for rotations",
        },
    )


def _inertia(hydro: xr.Dataset, body: RigidBody | None, mass: ArrayLike | None) -> Array:
    dofs = [str(d) for d in hydro.influenced_dof.values]
    if body is not None and mass is not None:
        raise InputError("rao: body or mass expected, both found.")
    if mass is not None:
        return _matrix(mass, dofs, "mass")
    if body is None:
        if "inertia_matrix" not in hydro:
            raise InputError("rao: a body, mass= or inertia_matrix in the data set expected, none found.")
        return hydro.inertia_matrix.values
    if not isinstance(body, RigidBody):
        raise InputError(f"body: a RigidBody expected, {type(body).__name__} found; give a matrix as mass=.")
    six = ["surge", "sway", "heave", "roll", "pitch", "yaw"]
    if not all(dof in six for dof in dofs):
        raise InputError(f"rao: a body moves in {', '.join(six)}; the data set has {', '.join(dofs)}. Give mass=.")
    place = [six.index(dof) for dof in dofs]
    M = body.matrix[np.ix_(place, place)]
    _warn_of_other_weight(hydro, M, dofs)
    return M


def _warn_of_other_weight(hydro: xr.Dataset, M: Array, dofs: list[str]) -> None:
    """The stiffness holds the weight and the height of the centre of gravity of the body it was made for."""
    if "inertia_matrix" not in hydro or "roll" not in dofs or "sway" not in dofs:
        return
    own, i, j = hydro.inertia_matrix.values, dofs.index("sway"), dofs.index("roll")
    C44 = hydro.hydrostatic_stiffness.values[j, j] if "hydrostatic_stiffness" in hydro else np.inf
    change = hydro.attrs["g"] * (M[i, j] - own[i, j])  # -m z_G, times g: what C44 should gain
    if abs(change) > 0.01 * abs(C44):
        warnings.warn(
            f"rao: the centre of gravity of the body would change C44 of the data set by {change:.4g} N m "
            f"({100 * change / abs(C44):.1f} %); the stiffness of the data set is kept. Give stiffness= for the difference.",
            OgilvieWarning,
            stacklevel=4,
        )


def _restoring(hydro: xr.Dataset) -> Array:
    if "hydrostatic_stiffness" not in hydro:
        raise InputError(
            "rao: hydrostatic_stiffness expected in the data set, not found. Read the .hst or give it with the arrays."
        )
    return hydro.hydrostatic_stiffness.values


def _matrix(value: ArrayLike | None, dofs: list[str], name: str) -> Array:
    n = len(dofs)
    if value is None:
        return np.zeros((n, n))
    M = np.asarray(value, dtype=float)
    if M.shape != (n, n) or not np.all(np.isfinite(M)):
        raise InputError(f"{name}: a finite ({n}, {n}) matrix about O ({', '.join(dofs)}) expected, shape {M.shape} found.")
    return M


def _speed(hydro: xr.Dataset, speed: float | None) -> float:
    own = float(hydro.attrs.get("speed", 0.0))
    if speed is None:
        return own
    if not np.isfinite(speed):
        raise InputError(f"speed: a finite number of m/s expected, {speed!r} found.")
    if abs(speed - own) > 1e-6 * max(1.0, abs(own)):
        warnings.warn(
            f"rao: the coefficients hold for {own:.4g} m/s; at {speed:.4g} m/s only the encounter frequency follows. "
            "Coefficients for that speed: at_speed(hydro, speed).",
            OgilvieWarning,
            stacklevel=3,
        )
    return float(speed)


def _radiation(hydro: xr.Dataset, omega_e: Array) -> ComplexArray:
    """Return the impedance -omega_e^2 A + i omega_e B (n_w, n_b, n, n); NaN above the data."""
    omega, A, B = hydro.omega.values, hydro.added_mass.values, hydro.radiation_damping.values
    w = omega_e[..., None, None]
    if np.array_equal(omega_e, np.broadcast_to(omega[:, None], omega_e.shape)):
        return np.asarray(-(w**2) * A[:, None] + 1j * w * B[:, None])
    beyond = np.abs(omega_e) > omega[-1] * (1.0 + 1e-9)
    if beyond.any():
        warnings.warn(
            f"rao: the encounter frequency exceeds the radiation data ({omega[-1]:.4g} rad/s) at {int(beyond.sum())} of "
            f"{beyond.size} points, up to {np.abs(omega_e).max():.4g} rad/s; no motion there. Extend the data upwards.",
            OgilvieWarning,
            stacklevel=3,
        )
    at = np.where(beyond, np.nan, np.clip(omega_e, -omega[-1], omega[-1]))
    U, L = float(hydro.attrs.get("speed", 0.0)), speed_matrix([str(d) for d in hydro.influenced_dof.values])
    if U != 0.0 and L is not None:
        return _impedance_at_speed(hydro, at, U, L)
    from scipy.interpolate import PchipInterpolator

    A_zero = hydro.added_mass_zero.values if "added_mass_zero" in hydro else A[0]
    grid = np.r_[0.0, omega]
    A_at = PchipInterpolator(grid, np.concatenate([A_zero[None], A]))(np.abs(at))
    B_at = PchipInterpolator(grid, np.concatenate([np.zeros_like(B[:1]), B]))(np.abs(at))
    return np.asarray(-(w**2) * A_at + 1j * w * B_at)


def _impedance_at_speed(hydro: xr.Dataset, omega_e: Array, U: float, L: Array) -> ComplexArray:
    """Return (s + U L^T) T (s - U L) with s = i omega_e and T interpolated at zero speed."""
    T = fluid_momentum(hydro, speed=U, L=L).at(omega_e)
    s = 1j * omega_e[..., None, None] * np.eye(len(L))
    return np.asarray((s + U * L.T) @ T @ (s - U * L))


def _solve(Z: NDArray, F: ComplexArray, dofs: list[str], omega_e: Array) -> ComplexArray:
    """Return Z^-1 F (n_w, n_b, n), NaN where Z is singular or NaN."""
    Z = np.broadcast_to(Z, (*F.shape, F.shape[-1])).astype(complex)
    size = np.sqrt(np.abs(np.diagonal(Z, axis1=-2, axis2=-1)))
    usable = np.all(np.isfinite(Z), axis=(-2, -1))
    safe = np.where(usable[..., None] & (size > 0.0), size, 1.0)
    scaled = np.where(usable[..., None, None], Z, np.eye(len(dofs))) / (safe[..., :, None] * safe[..., None, :])
    singular = usable & ((np.linalg.cond(scaled) > _SINGULAR) | np.any(size == 0.0, axis=-1))
    if singular.any():
        at = np.abs(omega_e[singular])
        warnings.warn(
            f"rao: nothing holds the body at {int(singular.sum())} points (encounter frequency {at.min():.4g}..{at.max():.4g} "
            "rad/s); no motion is given there. Add stiffness= in surge, sway and yaw.",
            OgilvieWarning,
            stacklevel=3,
        )
    good = usable & ~singular
    X = np.full(F.shape, np.nan + 0j)
    X[good] = np.linalg.solve(scaled[good], (F / safe)[good][..., None])[..., 0] / safe[good]
    return X


def _warn_of_resonance(hydro: xr.Dataset, M: Array, C: Array, B_ext: Array, dofs: list[str]) -> None:
    """Warn of dofs whose uncoupled resonance lies in the data and is hardly damped."""
    omega = hydro.omega.values
    for i, dof in enumerate(dofs):
        inertia = M[i, i] + hydro.added_mass.values[:, i, i]
        change = C[i, i] - omega**2 * inertia
        crossings = np.flatnonzero((change[:-1] > 0.0) & (change[1:] <= 0.0))
        if C[i, i] <= 0.0 or len(crossings) == 0:
            continue
        j = int(crossings[0])
        part = change[j] / (change[j] - change[j + 1])
        w_n = omega[j] + part * (omega[j + 1] - omega[j])
        B = hydro.radiation_damping.values[:, i, i]
        B_n = B[j] + part * (B[j + 1] - B[j]) + B_ext[i, i]
        ratio = B_n / (2.0 * w_n * (inertia[j] + part * (inertia[j + 1] - inertia[j])))
        if ratio < _LIGHT_DAMPING:
            warnings.warn(
                f"rao: the resonance in {dof} at {w_n:.4g} rad/s ({2 * np.pi / w_n:.4g} s) has {100 * ratio:.2g} % of critical "
                "damping only; its height is decided by what potential theory leaves out. Give damping=.",
                OgilvieWarning,
                stacklevel=3,
            )
