"""Which frequencies of radiation data can be trusted: damaged ones leave marks that no causal, passive fluid has."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.hydro.check_report import Check

Array = NDArray[Any]

_NEGATIVE = 0.005  # of the largest damping: below it a negative eigenvalue is rounding
_FEWEST = 12  # frequencies that the comparison of added mass and damping needs


def screen(hydro: "xr.Dataset", mask: Array, *, remove: bool) -> tuple[Array, list[str]]:
    """Return the mask of the frequencies to be used, and what the data lack, one sentence each.

    Parameters
    ----------
    hydro : xarray.Dataset
        Radiation data at zero speed.
    mask : (n_w,) bool array
        Frequencies considered.
    remove : bool
        Whether damaged frequencies are taken out of the mask, or only named: those whose damping matrix is not positive
        semi-definite (see `clean_frequencies`), and those whose added mass is off what damping implies (Kramers-Kronig) by more
        than 10 % of max \\|A - A_inf\\| while that of the frequencies beside it is not.

    Returns
    -------
    mask : (n_w,) bool array
    notes : list of str
        Lost positive semi-definiteness, added mass that is off, couplings whose added mass and damping contradict each other
        over a range, spikes.

    Notes
    -----
    The laws are those of :func:`ogilvie.check`. Contradictions over a range and spikes are named, not removed: which
    frequencies to leave out would be a guess.
    """
    from ogilvie.hydro.check_causality import causality
    from ogilvie.hydro.check_radiation import outliers, radiating

    omega, B = hydro.omega.values, hydro.radiation_damping.values
    if not (np.all(np.isfinite(B)) and np.all(np.isfinite(hydro.added_mass.values)) and np.any(B)):
        return mask, []
    waves = radiating(hydro)
    definite = clean_frequencies(omega, waves.radiation_damping.values)
    notes = [describe(omega, definite | ~mask, removed=remove)]
    good = mask & definite
    off = np.zeros(len(omega), dtype=bool)
    if good.sum() >= _FEWEST:
        causal = causality(waves, omega[~good])[0]
        off = np.isin(omega, [f.omega for f in causal.findings if f.local and f.omega])
        notes += [_off(omega, off, removed=remove), _contradictions(causal)]
    notes.append(_spikes(outliers(waves, omega[~(good & ~off)])))
    return (good & ~off if remove else mask), [note for note in notes if note]


def clean_frequencies(omega: Array, B: Array) -> Array:
    """Return the mask (n_w,) of the frequencies whose damping matrix is positive semi-definite, cut where most above are not.

    Parameters
    ----------
    omega : (n_w,) array
    B : (n_w, m, m) array
        Radiation damping.

    Returns
    -------
    (n_w,) bool array
        False where the smallest eigenvalue of the symmetric part, each dof scaled by its largest damping, is below -0.5 %,
        and from the first such frequency on above which at least a third are so: between two irregular frequencies the
        damping of the upper range is no better than at them.

    Notes
    -----
    Radiated power nu^H B nu is never negative.

    Examples
    --------
    >>> B = np.ones((5, 1, 1)); B[2] = -1.0
    >>> clean_frequencies(np.arange(1.0, 6.0), B)
    array([ True,  True, False, False, False])
    """
    peak = np.abs(np.einsum("wii->wi", B)).max(axis=0)
    scale = np.sqrt(np.where(peak > 0, peak, 1.0))
    scaled = (B + B.transpose(0, 2, 1)) / 2 / np.outer(scale, scale)
    bad = np.linalg.eigvalsh(scaled)[:, 0] < -_NEGATIVE
    mask = ~bad
    for k in np.flatnonzero(bad):
        if bad[k:].mean() >= 1 / 3:
            mask[k:] = False
            break
    return mask


def describe(omega: Array, mask: Array, *, removed: bool = True) -> str:
    """Return one sentence that names the masked frequencies, or an empty string.

    Examples
    --------
    >>> describe(np.array([1.0, 2.0, 3.0, 4.0]), np.array([True, False, True, False]))
    'damping not positive semi-definite at omega 2, 4 rad/s: left out.'
    """
    at = _names(omega, ~mask)
    return f"damping not positive semi-definite at omega {at} rad/s: {'left out' if removed else 'kept'}." if at else ""


def _off(omega: Array, off: Array, *, removed: bool) -> str:
    at = _names(omega, off)
    what = "added mass unlike what damping implies (Kramers-Kronig) and unlike its neighbours'"
    return f"{what} at omega {at} rad/s: {'left out' if removed else 'kept'}." if at else ""


def _contradictions(causal: "Check") -> str:
    """Name the couplings whose added mass and damping contradict each other, and by how much."""
    pairs = [
        f"{'-'.join(f.dofs)} {100 * f.value:.2g} % at {f.omega:.4g} rad/s" for f in causal.findings if not f.local and f.omega
    ]
    what = "added mass and damping contradict each other (Kramers-Kronig, parts of max |A - A_inf|)"
    return f"{what}: {', '.join(pairs)}; no causal model fits both." if pairs else ""


def _spikes(found: "Check") -> str:
    spikes = [f"{f.omega:.4g} ({f.dofs[0]} {100 * f.value:.2g} %)" for f in found.findings]
    what = "spikes that stand out from their neighbours"
    return f"{what} at omega {', '.join(spikes)} rad/s: kept, see check(hydro)." if spikes else ""


def _names(omega: Array, chosen: Array) -> str:
    """Frequencies as numbers and ranges."""
    at = np.flatnonzero(chosen)
    if len(at) == 0:
        return ""
    runs = np.split(at, np.flatnonzero(np.diff(at) > 1) + 1)
    return ", ".join(f"{omega[r[0]]:.4g}" if len(r) == 1 else f"{omega[r[0]]:.4g} to {omega[r[-1]]:.4g}" for r in runs)
