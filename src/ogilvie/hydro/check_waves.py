"""Checks of the wave forces: Haskind's relation, long waves, headings."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.hydro.check_radiation import AT_REST, largest, names
from ogilvie.hydro.check_report import Check, Finding
from ogilvie.hydro.mirror import TURN, full_circle, is_symmetric, mirror_signs
from ogilvie.hydro.probe import phase_probe
from ogilvie.waves.dispersion import group_velocity, wavenumber

Array = NDArray[np.float64]

HASKIND = 0.05
LONG_WAVES = 0.05
PHASE = 0.1
WIDEST_GAP = 45.0  # deg
_LONG = 0.05  # K R of a long wave, R the radius of the waterplane
_UNRESOLVED = 1e-3  # share of the angular variation of the forces near the limit of the headings


def damping_from_forces(hydro: xr.Dataset) -> tuple[Array, NDArray[np.bool_]] | None:
    """Return the damping (n_w, n, n) that the wave forces imply, and where (n_w,) the headings resolve it.

    None where the headings, mirrored if the body is symmetric, do not go round the circle in equal steps.

    Notes
    -----
    B_ij = k/(8 pi rho g c_g) int Re X_i X_j* db at any depth: the energy radiated by a forced motion, by Haskind's relation
    between the far field of that motion and the force of a wave from there. The trapezoidal rule over equal steps is exact once
    the angular harmonics of X end below half the number of headings; frequencies where more than 0.1 % of their energy lies in
    the uppermost fifth are not trusted, nor any above the first such one.

    References
    ----------
    Newman (1962), J. Ship Research 6(3), 10-17; Newman, Marine Hydrodynamics (1977), section 6.18.
    """
    signs = mirror_signs(names(hydro)) if is_symmetric(hydro) else None
    b, X = full_circle(hydro.wave_direction.values, hydro.excitation_force.values, signs)
    if len(b) < 8 or np.ptp(np.diff(np.r_[b, b[0] + TURN])) > 1e-4:
        return None
    omega, attrs = hydro.omega.values, hydro.attrs
    k = wavenumber(omega, attrs["water_depth"], g=attrs["g"])
    cg = group_velocity(omega, attrs["water_depth"], g=attrs["g"])
    factor = k / (8.0 * np.pi * attrs["rho"] * attrs["g"] * cg) * TURN / len(b)
    B = factor[:, None, None] * np.einsum("wbi,wbj->wij", X, X.conj()).real
    energy = np.abs(np.fft.fft(X, axis=1)) ** 2
    order = np.abs(np.fft.fftfreq(len(b), 1.0 / len(b)))
    total = energy.sum(axis=1)
    high = energy[:, order > 0.4 * len(b)].sum(axis=1)
    unresolved = np.max(np.divide(high, total, out=np.zeros_like(high), where=total > 0.0), axis=1) > _UNRESOLVED
    return B, ~np.logical_or.accumulate(unresolved)


def haskind(hydro: xr.Dataset) -> Check:
    """Damping equals what the wave forces of all headings imply, as a fraction of the peak of each B_ii."""
    kind = "Haskind"
    if "excitation_force" not in hydro:
        return Check(kind, note="no wave forces")
    if hydro.attrs.get("speed", 0.0) != 0.0:
        return Check(kind, note=AT_REST)
    implied = damping_from_forces(hydro)
    if implied is None:
        return Check(kind, note="headings do not go round the circle in equal steps")
    from_forces, trusted = implied
    if not trusted.any():
        return Check(kind, note="headings are too coarse at every frequency")
    omega, dofs = hydro.omega.values, names(hydro)
    B = hydro.radiation_damping.values
    peak = np.diagonal(B, axis1=1, axis2=2)[trusted].max(axis=0)
    size = np.sqrt(np.where(peak > 0.0, peak, np.inf))
    off = np.abs(from_forces - B) / (size[:, None] * size)
    off[~trusted] = 0.0
    diagonal = np.diagonal(off, axis1=1, axis2=2)
    findings = []
    for w in np.flatnonzero(diagonal.max(axis=1) > HASKIND):
        i = int(diagonal[w].argmax())
        sentence = (
            f"B({dofs[i]}, {dofs[i]}) and the wave forces contradict each other by {100 * diagonal[w, i]:.3g} % of its peak at "
            f"{omega[w]:.4g} rad/s (Haskind): an irregular frequency, too few panels (roll first), or forces and damping of "
            "different hulls."
        )
        findings.append(
            Finding(kind, "error", (dofs[i],), float(omega[w]), float(diagonal[w, i]), HASKIND, sentence, local=True)
        )
    k, i = largest(diagonal)
    where = f"{dofs[i]}, {omega[k]:.4g} rad/s (headings resolve up to {omega[trusted][-1]:.4g})"
    return Check(kind, float(diagonal[k, i]), HASKIND, where, tuple(findings))


def long_waves(hydro: xr.Dataset) -> Check:
    """In long waves F3 tends to C33 - omega^2 (A33 + M33): the vessel rides on the wave."""
    kind = "long waves"
    dofs = names(hydro)
    if "excitation_force" not in hydro or "hydrostatic_stiffness" not in hydro or "heave" not in dofs:
        return Check(kind, note="no heave force or no stiffness")
    i, omega = dofs.index("heave"), hydro.omega.values
    C33 = float(hydro.hydrostatic_stiffness.values[i, i])
    if C33 <= 0.0:
        return Check(kind, note="no waterplane")
    KR = omega**2 / hydro.attrs["g"] * np.sqrt(C33 / (np.pi * hydro.attrs["rho"] * hydro.attrs["g"]))
    if KR[0] > _LONG:
        return Check(kind, note=f"the longest wave has K R = {KR[0]:.2g}; {_LONG:g} or less needed")
    inertia = hydro.added_mass.values[0, i, i] + (hydro.inertia_matrix.values[i, i] if "inertia_matrix" in hydro else 0.0)
    F3 = hydro.excitation_force.values[0, :, i].real.mean()
    off = abs(float(F3 / (C33 - omega[0] ** 2 * inertia)) - 1.0)
    findings: tuple[Finding, ...] = ()
    if off > LONG_WAVES:
        sentence = (
            f"the heave force at {omega[0]:.4g} rad/s is {F3:.4g} N/m, {C33:.4g} N/m (C33, rho g times the waterplane area) "
            "expected: check units, length scale and stiffness."
        )
        findings = (Finding(kind, "error", ("heave",), float(omega[0]), off, LONG_WAVES, sentence),)
    return Check(kind, off, LONG_WAVES, f"heave, {omega[0]:.4g} rad/s", findings)


def phases(hydro: xr.Dataset) -> Check:
    """The two-phase probe: Im F3/(omega B33) = +1 in long waves for exp(+i omega t)."""
    kind = "phase probe"
    result = phase_probe(hydro)
    off = abs(result.heave_ratio - 1.0)
    if np.isnan(off) and np.isnan(result.surge_phase) and np.isnan(result.sway_phase):
        return Check(kind, note="; ".join(result.notes) or "not possible")
    where = f"heave {result.heave_ratio:+.4f}, surge {result.surge_phase:+.1f}, sway {result.sway_phase:+.1f} deg"
    findings = tuple(Finding(kind, "error", ("heave",), None, off, PHASE, problem) for problem in result.problems)
    return Check(kind, off, PHASE if not np.isnan(off) else np.nan, where, findings)


def headings(hydro: xr.Dataset) -> Check:
    """Wave directions at most 45 deg apart all round (one side of a symmetric body is enough)."""
    kind = "headings"
    if "excitation_force" not in hydro:
        return Check(kind, note="no wave forces")
    signs = mirror_signs(names(hydro)) if is_symmetric(hydro) else None
    b, _ = full_circle(hydro.wave_direction.values, hydro.excitation_force.values, signs)
    gaps = np.degrees(np.diff(np.r_[b, b[0] + TURN]))
    i = int(gaps.argmax())
    first, last = np.degrees(b[i]), np.degrees(np.r_[b, b[0] + TURN][i + 1])
    where = f"{hydro.sizes['wave_direction']} direction(s), widest gap {gaps[i]:.4g} deg"
    if gaps[i] <= WIDEST_GAP + 1e-6:
        return Check(kind, where=where)
    sentence = f"no wave directions between {first:.4g} and {last:.4g} deg: seas from there cannot be simulated."
    if len(b) == 1:
        sentence = f"one wave direction only, {first:.4g} deg: other seas cannot be simulated."
    return Check(
        kind, where=where, findings=(Finding(kind, "warning", (), None, gaps[i] / 360.0, WIDEST_GAP / 360.0, sentence),)
    )
