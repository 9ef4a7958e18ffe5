"""Checks of range and resolution in frequency, and of the constant matrices."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.hydro.check_radiation import RECIPROCITY, SILENT, largest, names
from ogilvie.hydro.check_report import Check, Finding, Severity

Array = NDArray[np.float64]

END_OF_RANGE = 0.05
RESOLUTION = 0.02
SYMMETRY = 0.01


def frequency_range(hydro: xr.Dataset, damaged: Array) -> Check:
    """Damping is small, against its peak, at the first and at the last frequency."""
    kind = "range"
    omega, dofs = hydro.omega.values, names(hydro)
    keep = ~np.isin(omega, damaged)
    if keep.sum() < 2:
        return Check(kind, note="fewer than two undamaged frequencies")
    B = np.diagonal(hydro.radiation_damping.values, axis1=1, axis2=2)[keep]
    peak = np.abs(B).max(axis=0)
    ends = np.abs(B[[0, -1]]) / np.where(peak > 0.0, peak, np.inf)
    findings = []
    for end, word, advice in (
        (0, "first", "Start lower: drift and slow motions need it."),
        (1, "last", "The rest is a guess: extend the data upwards."),
    ):
        i, w = int(ends[end].argmax()), float(omega[keep][-end])
        if ends[end, i] > END_OF_RANGE:
            share = f"{100 * ends[end, i]:.3g} % of its peak"
            sentence = f"B({dofs[i]}, {dofs[i]}) still has {share} at the {word} frequency, {w:.4g} rad/s. {advice}"
            findings.append(Finding(kind, "warning", (dofs[i],), w, float(ends[end, i]), END_OF_RANGE, sentence))
    end, i = largest(ends)
    return Check(kind, float(ends[end, i]), END_OF_RANGE, f"{dofs[i]}, {omega[keep][-end]:.4g} rad/s", tuple(findings))


def resolution(hydro: xr.Dataset, damaged: Array) -> Check:
    """Frequencies are close enough: estimated by leaving out every second one."""
    kind = "resolution"
    omega, dofs = hydro.omega.values, names(hydro)
    keep = ~np.isin(omega, damaged)
    if keep.sum() < 9:
        return Check(kind, note="fewer than nine undamaged frequencies")
    from scipy.interpolate import PchipInterpolator

    w = np.r_[0.0, omega[keep]]
    B = np.diagonal(hydro.radiation_damping.values, axis1=1, axis2=2)[keep]
    peak = np.abs(B).max(axis=0)
    B = np.concatenate([np.zeros_like(B[:1]), B]) / np.where(peak > 0.0, peak, np.inf)
    error = np.zeros_like(B)
    for first in (0, 1):
        known = np.unique(np.r_[0, np.arange(first, len(w), 2), len(w) - 1])
        error = np.maximum(error, np.abs(PchipInterpolator(w[known], B[known])(w) - B))
    error /= 4.0  # of second order near peaks: twice the points, a quarter of the error
    k, i = largest(error)
    where = f"{dofs[i]}, {w[k]:.4g} rad/s"
    if error[k, i] <= RESOLUTION:
        return Check(kind, float(error[k, i]), RESOLUTION, where)
    step = float(max(w[k] - w[k - 1], w[min(k + 1, len(w) - 1)] - w[k]))
    sentence = (
        f"B({dofs[i]}, {dofs[i]}) is resolved to about {100 * error[k, i]:.2g} % of its peak only near {w[k]:.4g} rad/s, where "
        f"the step is {step:.3g} rad/s: fluid memory beyond {np.pi / step:.3g} s is not in the data. Add frequencies there."
    )
    finding = Finding(kind, "warning", (dofs[i],), float(w[k]), float(error[k, i]), RESOLUTION, sentence)
    return Check(kind, float(error[k, i]), RESOLUTION, where, (finding,))


def stiffness(hydro: xr.Dataset) -> Check:
    """Heave, roll and pitch are stable, and their couplings symmetric."""
    kind = "stiffness"
    dofs = names(hydro)
    if "hydrostatic_stiffness" not in hydro:
        return Check(kind, note="not in the data set")
    place = [i for i, dof in enumerate(dofs) if dof in ("heave", "roll", "pitch")]
    if not place:
        return Check(kind, note="no heave, roll or pitch")
    C = hydro.hydrostatic_stiffness.values[np.ix_(place, place)]
    findings = []
    for i, p in enumerate(place):
        if C[i, i] < 0.0:
            meaning = "a waterplane of negative area" if dofs[p] == "heave" else "unstable upright"
            sentence = (
                f"C({dofs[p]}, {dofs[p]}) = {C[i, i]:.4g} is negative: {meaning}. Check centre of gravity, sign and origin."
            )
            severity: Severity = "error" if dofs[p] == "heave" else "warning"
            findings.append(Finding(kind, severity, (dofs[p],), None, float("nan"), 0.0, sentence))
    size = np.sqrt(np.abs(C.diagonal()))
    skew = np.abs(C - C.T) / np.where(np.outer(size, size) > 0.0, np.outer(size, size), np.inf)
    if skew.max() > SYMMETRY:
        i, j = sorted(largest(skew))
        pair = (dofs[place[i]], dofs[place[j]])
        sentence = f"C({pair[0]}, {pair[1]}) = {C[i, j]:.4g} and C({pair[1]}, {pair[0]}) = {C[j, i]:.4g} should be equal."
        findings.append(Finding(kind, "error", pair, None, float(skew.max()), SYMMETRY, sentence))
    return Check(kind, float(skew.max()), SYMMETRY, "asymmetry of heave, roll, pitch", tuple(findings))


def inertias(hydro: xr.Dataset) -> tuple[Check, ...]:
    """Inertia and the limits of the added mass are symmetric and positive definite."""
    checks = []
    for key in ("inertia_matrix", "added_mass_inf", "added_mass_zero"):
        kind = f"{key} positive"
        if key not in hydro:
            checks.append(Check(kind, note="not in the data set"))
            continue
        M = hydro[key].values
        size = np.sqrt(np.abs(M.diagonal()))
        turns = np.array([dof.endswith(("roll", "pitch", "yaw")) for dof in names(hydro)])
        largest_of_kind = np.where(turns, np.max(size, where=turns, initial=0.0), np.max(size, where=~turns, initial=0.0))
        used = size > np.sqrt(SILENT) * largest_of_kind
        if not used.any():
            checks.append(Check(kind, note="all zero"))
            continue
        M = M[np.ix_(used, used)] / np.outer(size[used], size[used])
        skew, lowest = float(np.abs(M - M.T).max()), float(np.linalg.eigvalsh(0.5 * (M + M.T))[0])
        worst, limit = max(skew, -lowest, 0.0), SYMMETRY if key == "inertia_matrix" else RECIPROCITY
        findings: tuple[Finding, ...] = ()
        if worst > limit:
            what = "symmetric" if skew >= -lowest else "positive definite"
            sentence = f"{key} is not {what} ({100 * worst:.3g} % of its diagonal); it is the matrix of a kinetic energy."
            findings = (Finding(kind, "error", (), None, worst, limit, sentence),)
        checks.append(Check(kind, worst, limit, "scaled by its diagonal", findings))
    return tuple(checks)
