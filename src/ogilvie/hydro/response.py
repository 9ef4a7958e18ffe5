"""Responses to irregular waves in the frequency domain: spectra and statistics from RAOs."""

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError
from ogilvie.hydro.mirror import full_circle, wrapped
from ogilvie.units import GRAVITY
from ogilvie.waves.dispersion import encounter_frequency
from ogilvie.waves.spectrum import Spectrum
from ogilvie.waves.spreading import Spreading, check_direction

Array = NDArray[np.float64]

_LOST = 0.01  # share of the wave energy that may lie outside the RAO
_ANGLES = 45  # equally probable directions of a spread sea
_NODES = 12  # Gauss points between two frequencies of the RAO

TURN = 2.0 * np.pi


def response_spectrum(
    rao: xr.DataArray,
    spectrum: Spectrum,
    *,
    direction: float,
    spreading: Spreading | None = None,
    omega: ArrayLike | None = None,
) -> xr.DataArray:
    """Return the spectrum of the response over the frequency of the waves.

    Parameters
    ----------
    rao : xarray.DataArray
        As :func:`ogilvie.rao` returns it; (omega, wave_direction, dof).
    spectrum : Spectrum
    direction : float
        Main direction the waves travel to relative to the bow, rad.
    spreading : Spreading, optional
        Long-crested without.
    omega : (n,) array, optional
        rad/s, within the RAO; its own frequencies by default.

    Returns
    -------
    xarray.DataArray
        (omega, dof), m2 s/rad and rad2 s/rad. The integral over omega is the variance, at any speed.

    Raises
    ------
    InputError
        A direction or frequency outside the RAO, NaN in the RAO where the sea has energy.

    Notes
    -----
    S_R = S(omega) int \\|H(omega, b)\\|^2 D(b - direction) db. The RAO is interpolated in amplitude squared: linearly between
    directions, monotonically (PCHIP) between frequencies. RAOs of a port-starboard symmetric body serve both sides.

    Examples
    --------
    >>> from ogilvie.waves.spectra import jonswap
    >>> H = xr.DataArray(np.full((2, 1, 1), 2.0 + 0j), dims=("omega", "wave_direction", "dof"),
    ...     coords={"omega": [0.2, 3.0], "wave_direction": [np.pi], "dof": ["heave"]})
    >>> sea = jonswap(hs=2.0, tp=8.0)
    >>> S = response_spectrum(H, sea, direction=np.pi, omega=[0.8])
    >>> bool(abs(S.values[0, 0] - 4.0 * sea(0.8)) < 1e-12)
    True
    """
    at = rao.omega.values if omega is None else np.asarray(omega, dtype=float)
    S = spectrum(at)
    values = _mean_power(rao, direction, spreading, at, S)[0] * S[:, None]
    return xr.DataArray(
        values,
        dims=("omega", "dof"),
        coords={"omega": at, "dof": rao.dof.values},
        name="response_spectrum",
        attrs=dict(rao.attrs),
    )


def response_statistics(
    rao: xr.DataArray, spectrum: Spectrum, *, direction: float, spreading: Spreading | None = None
) -> xr.Dataset:
    """Return variance, significant amplitude and periods of the response.

    Parameters
    ----------
    rao, spectrum, direction, spreading
        As for :func:`response_spectrum`.

    Returns
    -------
    xarray.Dataset
        (dof): ``m0, m2, m4`` (m2 or rad2, times (rad/s)^n with the encounter frequency), ``std``, ``significant`` (double
        amplitude 4 sqrt(m0), m or rad), ``tz`` (mean zero-up-crossing period, s).

    Raises
    ------
    InputError
        Also where more than 1 % of the wave energy lies outside the frequencies of the RAO.

    Notes
    -----
    m_n = int int \\|omega_e\\|^n \\|H\\|^2 S D d omega db.

    Examples
    --------
    >>> from ogilvie.waves.spectra import jonswap
    >>> H = xr.DataArray(np.full((2, 1, 1), 1.0 + 0j), dims=("omega", "wave_direction", "dof"),
    ...     coords={"omega": [0.05, 20.0], "wave_direction": [np.pi], "dof": ["heave"]})
    >>> sea = jonswap(hs=2.0, tp=8.0)
    >>> result = response_statistics(H, sea, direction=np.pi)
    >>> round(float(result.significant[0]), 4), bool(abs(result.tz[0] - sea.tz) < 0.02)
    (2.0, True)
    """
    omega = rao.omega.values
    low, high = spectrum.cumulative([omega[0], omega[-1]])
    lost = 1.0 - (high - low) / spectrum.m0
    if lost > _LOST:
        raise InputError(
            f"response_statistics: the RAO covers {omega[0]:.4g}..{omega[-1]:.4g} rad/s, {100 * lost:.3g} % of the wave energy "
            f"lies outside; at most {100 * _LOST:g} % expected. Extend the coefficients."
        )
    at, weight = _quadrature(omega, spectrum)
    S = spectrum(at)
    powers = _mean_power(rao, direction, spreading, at, S)
    moments = {f"m{n}": ("dof", (S * weight) @ powers[n]) for n in (0, 2, 4)}
    result = xr.Dataset(moments, coords={"dof": rao.dof.values}, attrs=dict(rao.attrs))
    result["std"] = np.sqrt(result.m0)
    result["significant"] = 4.0 * result["std"]
    result["tz"] = TURN * np.sqrt(result.m0 / result.m2.where(result.m2 > 0.0))
    return result


def _mean_power(rao: xr.DataArray, direction: float, spreading: Spreading | None, at: Array, S: Array) -> dict[int, Array]:
    """Return |omega_e|^n |H|^2 (n_at, n_dof) averaged over the directions of the sea, for n = 0, 2, 4."""
    _check_rao(rao)
    check_direction(direction)
    squared = np.abs(rao.values) ** 2
    mirrored = np.ones(squared.shape[2]) if rao.attrs.get("port_starboard_symmetric", 0) else None
    b, squared = full_circle(rao.wave_direction.values, squared, mirrored)
    angles = np.zeros(1) if spreading is None else spreading.quantile((np.arange(_ANGLES) + 0.5) / _ANGLES)
    weights = _direction_weights(b, direction + angles)
    used = weights > 0.0
    power = _interpolated(rao.omega.values, squared[:, used], at, S)  # (n_at, n_used, n_dof)
    omega_e = encounter_frequency(
        at[:, None],
        speed=rao.attrs.get("speed", 0.0),
        direction=b[used],
        depth=rao.attrs.get("water_depth", np.inf),
        g=rao.attrs.get("g", GRAVITY),
    )
    return {n: np.einsum("wbi,wb,b->wi", power, np.abs(omega_e) ** n, weights[used]) for n in (0, 2, 4)}


def _direction_weights(b: Array, angles: Array) -> Array:
    """Return how much each tabulated direction counts in the mean over the angles, by linear interpolation."""
    weights = np.zeros(len(b))
    ring = np.r_[b, b[0] + TURN]
    widest = max(1.5 * np.sort(np.diff(ring))[-2] if len(b) > 2 else 0.0, 1e-9)
    for angle in angles:
        near = int(np.argmin(np.abs(wrapped(b - angle))))
        if abs(float(wrapped(b[near] - angle))) < 1e-6:
            weights[near] += 1.0
            continue
        x = b[0] + np.mod(angle - b[0], TURN)
        i = int(np.searchsorted(ring, x, side="right")) - 1
        gap = ring[i + 1] - ring[i]
        if gap > min(widest, np.pi / 3.0 + 1e-9):
            given = ", ".join(f"{v:.4g}" for v in np.degrees(b))
            raise InputError(
                f"response: directions among or between those of the RAO ({given} deg) expected, "
                f"{np.degrees(float(wrapped(np.asarray(angle)))):.4g} deg found. Compute more directions."
            )
        part = (x - ring[i]) / gap
        weights[i] += 1.0 - part
        weights[(i + 1) % len(b)] += part
    return weights / len(angles)


def _interpolated(omega: Array, power: Array, at: Array, density: Array) -> Array:
    """Return the power (n_w, n_b, n_dof) at other frequencies; zero where it is unknown and the sea has next to no energy."""
    if at.ndim != 1 or at.size == 0 or at.min() < omega[0] * (1 - 1e-9) or at.max() > omega[-1] * (1 + 1e-9):
        raise InputError(f"omega: frequencies within the RAO's {omega[0]:.4g}..{omega[-1]:.4g} rad/s expected, others found.")
    from scipy.interpolate import PchipInterpolator

    known = np.asarray(np.isfinite(power).all(axis=(1, 2)))
    if known.sum() < 2:
        raise InputError("rao: at least two frequencies without NaN expected.")
    at = np.clip(at, omega[0], omega[-1])
    left, right = np.searchsorted(omega, at, side="right") - 1, np.searchsorted(omega, at)
    unknown = ~(known[left] & known[right])
    energetic = np.logical_and(unknown, density > 1e-3 * float(density.max()))
    if energetic.any():
        raise InputError(
            f"rao: NaN at {at[energetic].min():.4g}..{at[energetic].max():.4g} rad/s, where the sea has energy (encounter "
            "frequency outside the radiation data, or a body that nothing holds). Extend the data or add stiffness."
        )
    values = PchipInterpolator(omega[known], power[known], extrapolate=False)(at)
    values[unknown] = 0.0
    return values


def _quadrature(omega: Array, spectrum: Spectrum) -> tuple[Array, Array]:
    """Return Gauss points and weights between the frequencies of the RAO and the breakpoints of the spectrum."""
    marks = np.concatenate([part.breakpoints for part in spectrum.parts])
    edges = np.unique(np.r_[omega, marks[(marks > omega[0]) & (marks < omega[-1])]])
    x, w = np.polynomial.legendre.leggauss(_NODES)
    half = 0.5 * np.diff(edges)
    return (edges[:-1, None] + half[:, None] * (1.0 + x)).ravel(), (half[:, None] * w).ravel()


def _check_rao(rao: xr.DataArray) -> None:
    if not isinstance(rao, xr.DataArray) or rao.dims != ("omega", "wave_direction", "dof"):
        raise InputError(
            "rao: the DataArray (omega, wave_direction, dof) that ogilvie.rao returns expected, something else found."
        )
