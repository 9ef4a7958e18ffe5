"""Check of causality: Kramers-Kronig between added mass and damping, and the added mass at infinite frequency."""

from dataclasses import replace

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.hydro.check_radiation import AT_REST, check_at, largest, names, off_cubic, pair_name, scaled
from ogilvie.hydro.check_report import Check, Finding
from ogilvie.hydro.kramers_kronig import mismatch

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

CAUSALITY = 0.05
NEGLIGIBLE_COUPLING = 0.01  # of sqrt(B_ii B_jj), largest over all frequencies
_DOUBT = 3.0  # uncertainties of interpolation that a contradiction must exceed
_SHARP = 0.2  # of the peak, by which damping stands above its neighbours at an unresolved resonance
_CUT_OFF = 0.3  # of the peak, from which on the damping at the last frequency leaves A_inf open


def causality(hydro: xr.Dataset, damaged: Array) -> tuple[Check, Check]:
    """Added mass and damping belong together (Kramers-Kronig), and A_inf fits both."""
    kind, limit_kind = "Kramers-Kronig", "added_mass_inf"
    omega, dofs = hydro.omega.values, names(hydro)
    if hydro.attrs.get("speed", 0.0) != 0.0:
        return Check(kind, note=AT_REST), Check(limit_kind, note=AT_REST)
    keep = ~np.isin(omega, damaged)
    if keep.sum() < 12:
        return Check(kind, note="fewer than twelve undamaged frequencies"), Check(limit_kind, note="see Kramers-Kronig")
    unresolved = _unresolved(hydro, keep)
    excess, constants, doubts = _mismatches(hydro, keep, unresolved)
    alone = _alone(excess, keep)
    findings = _damage_findings(kind, excess, alone, omega, dofs)
    if alone.any():
        again, constants, doubts = _mismatches(hydro, keep & ~alone, unresolved)
        findings += _causality_findings(kind, again, omega, dofs)
        excess = np.where(alone[:, None, None], excess, again)
    else:
        findings += _causality_findings(kind, excess, omega, dofs)
    skipped = [dof for dof, hidden in zip(dofs, unresolved, strict=True) if hidden]
    if len(skipped) == len(dofs):
        reason = f"resonances of {', '.join(dofs)} are not resolved"
        return Check(kind, note=reason), Check(limit_kind, note=reason)
    causal = check_at(kind, excess, CAUSALITY, omega, dofs, findings)
    if skipped:
        causal = replace(causal, where=f"{causal.where}; not judged: unresolved resonance of {', '.join(skipped)}")
    if "added_mass_inf" not in hydro:
        return causal, Check(limit_kind, note="not in the data set")
    return causal, _limit_check(limit_kind, constants, doubts, dofs)


def _unresolved(hydro: xr.Dataset, keep: Mask) -> Mask:
    """Return the dofs (n,) whose damping peaks too sharply for the frequencies: a resonance of the water between hulls."""
    B = np.diagonal(hydro.radiation_damping.values, axis1=1, axis2=2)[keep]
    peak = B.max(axis=0)
    return np.any(off_cubic(hydro.omega.values[keep], B) > _SHARP * peak, axis=0)


def _mismatches(hydro: xr.Dataset, keep: Mask, unresolved: Mask) -> tuple[Array, Array, Array]:
    """Return by how much A and B contradict each other (n_w, n, n), the misfit of A_inf and what the tail leaves open in it.

    Zero where a coupling is negligible or not resolved, or a frequency is not judged: left out, or near the end of the data.
    """
    omega, n = hydro.omega.values, hydro.sizes["influenced_dof"]
    A, B = (0.5 * (M + np.swapaxes(M, 1, 2)) for M in (hydro.added_mass.values, hydro.radiation_damping.values))
    A_inf = hydro.added_mass_inf.values if "added_mass_inf" in hydro else A[keep][-1]
    excess, constants, doubts = np.zeros((len(omega), n, n)), np.zeros((n, n)), np.full((n, n), np.inf)
    judged = np.abs(scaled(B)[keep]).max(axis=0) > NEGLIGIBLE_COUPLING
    judged &= ~unresolved[:, None] & ~unresolved
    i, j = np.nonzero(np.triu(judged))
    if len(i) == 0:
        return excess, constants, doubts
    result = mismatch(omega, A[:, i, j], B[:, i, j], 0.5 * (A_inf + A_inf.T)[i, j], keep)
    off = np.abs(result.residual) - _DOUBT * result.uncertainty - result.tail
    excess[:, i, j] = np.maximum(np.nan_to_num(off), 0.0)
    constants[i, j] = result.constant
    cut_off = np.abs(B[keep][-1, i, j]) > _CUT_OFF * np.abs(B[keep][:, i, j]).max(axis=0)
    doubts[i, j] = np.where(cut_off, np.inf, np.nanmean(result.tail, axis=0))
    return excess, constants, doubts


def _alone(excess: Array, keep: Mask) -> Mask:
    """Return the frequencies (n_w,) where a diagonal entry is off and its neighbours are not: bad data, not a bad curve."""
    diagonal = np.where(keep[:, None], np.diagonal(excess, axis1=1, axis2=2), np.inf)
    padded = np.pad(diagonal, ((1, 1), (0, 0)))
    beside = np.maximum(padded[:-2], padded[2:])
    return keep & np.any((diagonal > 2.0 * CAUSALITY) & (beside < 0.3 * diagonal), axis=1)


def _damage_findings(kind: str, excess: Array, alone: Mask, omega: Array, dofs: list[str]) -> list[Finding]:
    """One finding for each frequency whose data are off on their own."""
    findings = []
    for w in np.flatnonzero(alone):
        diagonal = excess[w].diagonal()
        bad = tuple(dof for dof, value in zip(dofs, diagonal, strict=True) if value > CAUSALITY)
        worst = float(diagonal.max())
        sentence = (
            f"added mass at {omega[w]:.4g} rad/s ({', '.join(bad)}) is up to {100 * worst:.3g} % of max |A - A_inf| off what "
            "damping implies, unlike at its neighbours: bad data at this frequency. Leave it out."
        )
        findings.append(Finding(kind, "error", bad, float(omega[w]), worst, CAUSALITY, sentence, local=True))
    return findings


def _causality_findings(kind: str, excess: Array, omega: Array, dofs: list[str]) -> list[Finding]:
    """One finding for each coupling that contradicts itself."""
    findings = []
    for i, j in zip(*np.nonzero(excess.max(axis=0) > CAUSALITY), strict=True):
        curve = excess[:, i, j]
        w, above = int(curve.argmax()), omega[curve > CAUSALITY]
        span = "" if len(above) == 1 else f", above {100 * CAUSALITY:.0f} % from {above[0]:.4g} to {above[-1]:.4g} rad/s"
        sentence = (
            f"A({dofs[i]}, {dofs[j]}) is {100 * curve[w]:.3g} % of max |A - A_inf| off what damping implies at "
            f"{omega[w]:.4g} rad/s{span}; no causal model fits both."
        )
        pair = (dofs[i],) if i == j else (dofs[i], dofs[j])
        findings.append(Finding(kind, "error", pair, float(omega[w]), float(curve[w]), CAUSALITY, sentence))
    return findings


def _limit_check(kind: str, constants: Array, doubts: Array, dofs: list[str]) -> Check:
    """The given A_inf against the one that Ogilvie's relation yields."""
    if not np.isfinite(doubts).any():
        return Check(kind, note=f"damping is cut off above {100 * _CUT_OFF:.0f} % of its peak")
    excess = np.maximum(np.abs(constants) - doubts, 0.0)
    findings = []
    for i, j in zip(*np.nonzero(excess > CAUSALITY), strict=True):
        sentence = (
            f"A_inf({dofs[i]}, {dofs[j]}) differs by {100 * constants[i, j]:.3g} % of max |A - A_inf| from Ogilvie's relation "
            f"(the unknown tail accounts for {100 * doubts[i, j]:.2g} %)."
        )
        pair = (dofs[i],) if i == j else (dofs[i], dofs[j])
        findings.append(Finding(kind, "error", pair, None, float(excess[i, j]), CAUSALITY, sentence))
    i, j = largest(excess)
    return Check(kind, float(excess[i, j]), CAUSALITY, pair_name(dofs, i, j), tuple(findings))
