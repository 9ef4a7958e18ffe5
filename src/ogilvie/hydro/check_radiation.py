"""Checks of added mass and damping: reciprocity, passivity, outliers."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.hydro.check_report import Check, Finding

Array = NDArray[np.float64]

RECIPROCITY = 0.05
NEGATIVE_DAMPING = 0.02
OUTLIER = 0.05
SILENT = 1e-4
AT_REST = "holds at zero speed only"


def names(hydro: xr.Dataset) -> list[str]:
    """Return the names of the degrees of freedom."""
    return [str(d) for d in hydro.influenced_dof.values]


def radiating(hydro: xr.Dataset) -> xr.Dataset:
    """Return the data set without the degrees of freedom that hardly make waves, such as yaw of a body of revolution.

    They hold rounding only: neither added mass nor damping reaches 1e-4 of the largest translation or rotation.
    """
    dofs = names(hydro)
    turns = np.array([dof.endswith(("roll", "pitch", "yaw")) for dof in dofs])
    silent = np.ones(len(dofs), dtype=bool)
    for key in ("added_mass", "radiation_damping"):
        size = np.abs(np.diagonal(hydro[key].values, axis1=1, axis2=2)).max(axis=0)
        for kind in (turns, ~turns):
            silent[kind] &= size[kind] <= SILENT * size[kind].max(initial=0.0)
    kept = [dof for dof, quiet in zip(dofs, silent, strict=True) if not quiet]
    return hydro.sel(influenced_dof=kept, radiating_dof=kept) if 0 < len(kept) < len(dofs) else hydro


def scaled(matrices: Array) -> Array:
    """Return (n_w, n, n) matrices divided by sqrt(max |M_ii| max |M_jj|)."""
    size = np.sqrt(np.abs(np.diagonal(matrices, axis1=1, axis2=2)).max(axis=0))
    size = np.where(size > 0.0, size, 1.0)
    return matrices / (size[:, None] * size)


def reciprocity(hydro: xr.Dataset) -> Check:
    """A_ij = A_ji and B_ij = B_ji at zero speed, as fractions of sqrt(max M_ii max M_jj)."""
    kind = "reciprocity"
    if hydro.attrs.get("speed", 0.0) != 0.0:
        return Check(kind, note=AT_REST)
    if hydro.sizes["influenced_dof"] < 2:
        return Check(kind, note="one degree of freedom")
    dofs, omega = names(hydro), hydro.omega.values
    skew = {}
    for letter, key in (("A", "added_mass"), ("B", "radiation_damping")):
        M = scaled(hydro[key].values)
        skew[letter] = np.abs(M - np.swapaxes(M, 1, 2))
    both = np.maximum(skew["A"], skew["B"])
    findings = []
    for w in np.flatnonzero(both.max(axis=(1, 2)) > RECIPROCITY):
        letter = "A" if skew["A"][w].max() >= skew["B"][w].max() else "B"
        i, j = sorted(largest(skew[letter][w]))
        value = float(skew[letter][w, i, j])
        sentence = (
            f"{letter}({dofs[i]}, {dofs[j]}) and {letter}({dofs[j]}, {dofs[i]}) differ by {100 * value:.3g} % of "
            f"sqrt({letter}ii {letter}jj) at {omega[w]:.4g} rad/s; they should be equal."
        )
        pair = (dofs[i], dofs[j])
        findings.append(Finding(kind, "error", pair, float(omega[w]), value, RECIPROCITY, sentence, local=True))
    return check_at(kind, both, RECIPROCITY, omega, dofs, findings)


def passivity(hydro: xr.Dataset) -> Check:
    """The damping matrix is positive semi-definite: no motion takes energy out of the waves it makes."""
    kind = "damping positive"
    omega, dofs = hydro.omega.values, names(hydro)
    B = scaled(hydro.radiation_damping.values)
    B = 0.5 * (B + np.swapaxes(B, 1, 2))
    if hydro.attrs.get("speed", 0.0) != 0.0:
        return Check(kind, note=AT_REST)
    lowest = np.linalg.eigvalsh(B)[:, 0]
    diagonal = np.diagonal(B, axis1=1, axis2=2)
    findings = []
    for w in np.flatnonzero(lowest < -NEGATIVE_DAMPING):
        negative = [f"{dof} {100 * b:.3g} %" for dof, b in zip(dofs, diagonal[w], strict=True) if b < -0.2 * NEGATIVE_DAMPING]
        sentence = (
            f"damping is negative at {omega[w]:.4g} rad/s: smallest eigenvalue of B scaled to unit peaks {lowest[w]:.3g}"
            + (f" ({', '.join(negative)} of the peak)" if negative else "")
            + ". An irregular frequency; solve again with a lid or leave the frequency out."
        )
        bad = tuple(dof for dof, b in zip(dofs, diagonal[w], strict=True) if b < -0.2 * NEGATIVE_DAMPING)
        findings.append(Finding(kind, "error", bad, float(omega[w]), float(-lowest[w]), NEGATIVE_DAMPING, sentence, local=True))
    worst = int(lowest.argmin())
    return Check(kind, max(float(-lowest[worst]), 0.0), NEGATIVE_DAMPING, f"{omega[worst]:.4g} rad/s", tuple(findings))


def outliers(hydro: xr.Dataset, damaged: Array) -> Check:
    """Each diagonal entry lies near the cubic through its four undamaged neighbours."""
    kind = "outliers"
    keep = ~np.isin(hydro.omega.values, damaged)
    omega, dofs = hydro.omega.values[keep], names(hydro)
    if len(omega) < 9:
        return Check(kind, note="fewer than nine undamaged frequencies")
    deviation = np.zeros((len(omega), len(dofs), 2))
    for m, key in enumerate(("added_mass", "radiation_damping")):
        curves = np.diagonal(hydro[key].values, axis1=1, axis2=2)[keep]
        scale = np.ptp(curves, axis=0) if m == 0 else np.abs(curves).max(axis=0)
        deviation[2:-2, :, m] = off_cubic(omega, curves) / np.where(scale > 0.0, scale, 1.0)
    worst = np.abs(deviation).max(axis=(1, 2))
    findings = []
    for w in np.flatnonzero(worst > OUTLIER):
        if worst[w] < worst[max(w - 2, 0) : w + 3].max():
            continue  # in the shadow of a larger one
        i, m = largest(np.abs(deviation[w]))
        sentence = (
            f"{'A' if m == 0 else 'B'}({dofs[i]}, {dofs[i]}) stands out from its neighbours by {100 * worst[w]:.3g} % of its "
            f"{'range' if m == 0 else 'peak'} at {omega[w]:.4g} rad/s: an irregular frequency, or a resonance of the water "
            "between hulls that the frequencies do not resolve. Solve at more frequencies near it."
        )
        findings.append(Finding(kind, "warning", (dofs[i],), float(omega[w]), float(worst[w]), OUTLIER, sentence))
    return check_at(kind, np.abs(deviation).max(axis=2), OUTLIER, omega, dofs, findings)


def off_cubic(x: Array, y: Array) -> Array:
    """Return y (n, m) less the cubic through two neighbours on either side, (n - 4, m)."""
    middle = x[2:-2]
    others = np.stack([x[:-4], x[1:-3], x[3:-1], x[4:]])
    predicted = np.zeros_like(y[2:-2])
    for a, values in enumerate((y[:-4], y[1:-3], y[3:-1], y[4:])):
        weight = np.ones_like(middle)
        for b in range(4):
            if b != a:
                weight *= (middle - others[b]) / (others[a] - others[b])
        predicted += weight[:, None] * values
    return y[2:-2] - predicted


def check_at(kind: str, values: Array, tolerance: float, omega: Array, dofs: list[str], findings: list[Finding]) -> Check:
    """Return the check with the place of the largest of values (n_w, n) or (n_w, n, n)."""
    place = np.unravel_index(int(values.argmax()), values.shape)
    w, i, j = int(place[0]), int(place[1]), int(place[-1])
    where = f"{pair_name(dofs, i, j)}, {omega[w]:.4g} rad/s"
    return Check(kind, float(values[place]), tolerance, where, tuple(findings))


def largest(values: Array) -> tuple[int, int]:
    """Return row and column of the largest entry of a matrix."""
    row, column = np.unravel_index(int(values.argmax()), values.shape)
    return int(row), int(column)


def pair_name(dofs: list[str], i: int, j: int) -> str:
    """Return the name of a coupling, the same for ij and ji."""
    return dofs[i] if i == j else f"{dofs[min(i, j)]}-{dofs[max(i, j)]}"
