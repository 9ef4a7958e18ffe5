"""The two-phase probe: long waves betray the time factor, the direction and the axes of a data set."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.errors import ConventionError
from ogilvie.hydro.probe_result import ProbeResult

Array = NDArray[np.float64]
Index = NDArray[np.intp]

_LONG = 0.5  # largest k R of a wave that counts as long, R the radius of the waterplane
_SHORT = 5.0  # k R from which on the heave force has to be small
_COUNT = 3  # frequencies that are judged, from the lowest usable one upwards


def phase_probe(hydro: xr.Dataset) -> ProbeResult:
    """Return the two numbers (and two more) that tell the conventions of a data set.

    Parameters
    ----------
    hydro : Dataset
        With `excitation_force`; see :mod:`ogilvie.hydro.schema`.

    Returns
    -------
    ProbeResult

    Notes
    -----
    In waves much longer than the body the water moves as a whole with zeta = exp(i(omega t - k s)). The body sees the relative
    motion, so F3 = C33 - omega^2 A33 + i omega B33 up to terms that are odd in the direction, which the average over b and
    b + pi removes. The water accelerates by i omega^2 along the direction of travel and takes the body with it:
    F1 = i omega^2 (m + A11). Both hold at any depth.

    Short waves, k R > 5, hardly push: the heave force there has to be less than half of its long-wave value C33. If it is not,
    periods were taken for frequencies, or the other way round.

    Frequencies are taken from the lowest upwards while k R < 0.5, while Re F3 keeps half of its first value (a semi-submersible
    cancels it) and where omega B33 stands above rounding; the median of three is judged.

    Examples
    --------
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> w = np.array([0.1, 0.2]); B = 5.0 * w**3
    >>> F3 = 1e4 - 10.0 * w**2 + 1j * w * B
    >>> h = hydro_from_arrays(omega=w, added_mass=np.full((2, 1, 1), 10.0), radiation_damping=B[:, None, None],
    ...     wave_direction=[np.pi / 2], excitation_force=F3[:, None, None], dofs=("heave",))
    >>> round(phase_probe(h).heave_ratio, 6)
    1.0
    """
    notes: list[str] = []
    if "excitation_force" not in hydro or hydro.sizes.get("wave_direction", 0) == 0:
        return _nothing("no excitation force")
    dofs = hydro.influenced_dof.values.tolist()
    omega, b = hydro.omega.values, hydro.wave_direction.values
    kR = _wavenumber(hydro) * _radius(hydro, dofs)
    short = _short_waves(hydro, dofs.index("heave")) if "heave" in dofs and kR[-1] > _SHORT else np.nan
    heave, usable = (np.nan, np.nan), np.flatnonzero(kR < _LONG).astype(np.intp)
    if len(usable) == 0:
        return _nothing(f"no long waves: k R is {kR.min():.2f} or more, {_LONG} or less needed", short)
    judged = usable[:_COUNT]
    if "heave" in dofs:
        heave, judged = _heave(hydro, dofs.index("heave"), usable, notes)
    horizontal = {}
    for dof, part in (("surge", np.cos(b)), ("sway", np.sin(b))):
        horizontal[dof] = np.nan
        if dof in dofs and np.abs(part).max() > 0.1:
            force = hydro.excitation_force.values[usable[:_COUNT], :, dofs.index(dof)] @ part
            horizontal[dof] = _phase(force)
        else:
            notes.append(f"{dof}: no such force or direction")
    rates = tuple(omega[judged].tolist())
    phases = horizontal["surge"], horizontal["sway"]
    return ProbeResult(heave[0], *phases, heave[1], short, rates, float(kR[judged].max()), tuple(notes))


def check_convention(hydro: xr.Dataset, *, source: str) -> xr.Dataset:
    """Return the data set with the probe's numbers as attributes, or raise if they contradict the convention.

    Parameters
    ----------
    hydro : Dataset
    source : str
        Name for the message.

    Raises
    ------
    ConventionError
        With the two numbers and the conversion that would cure it.
    """
    result = phase_probe(hydro)
    if not result.ok:
        raise ConventionError(
            f"{source}: {result}: {' '.join(result.problems)} Convert the data, or pass probe=False if you know better."
        )
    attrs: dict[str, Any] = {"probe_heave_ratio": result.heave_ratio, "probe_surge_phase_deg": result.surge_phase}
    if result.notes:
        attrs["probe_notes"] = "not possible: " + "; ".join(result.notes)
    return hydro.assign_attrs(attrs)


def _nothing(reason: str, short_waves: float = np.nan) -> ProbeResult:
    return ProbeResult(np.nan, np.nan, np.nan, np.nan, short_waves, (), np.nan, (reason,))


def _wavenumber(hydro: xr.Dataset) -> Array:
    """Return k (1/m) by Eckart's formula, K / sqrt(tanh K h), right to 5 percent at any depth."""
    K = hydro.omega.values**2 / hydro.attrs["g"]
    return K / np.sqrt(np.tanh(K * hydro.attrs["water_depth"]))


def _short_waves(hydro: xr.Dataset, k: int) -> float:
    size = np.abs(hydro.excitation_force.values[:, :, k]).max(axis=1)
    stiffness = float(hydro.hydrostatic_stiffness.values[k, k]) if "hydrostatic_stiffness" in hydro else 0.0
    reference = stiffness if stiffness > 0.0 else size.max()
    return float(size[-1] / reference) if reference > 0.0 else float("nan")


def _radius(hydro: xr.Dataset, dofs: list[str]) -> float:
    """Return the radius of a circle of the waterplane's area, or the size of the added mass where there is none."""
    weight = hydro.attrs["rho"] * hydro.attrs["g"]
    if "hydrostatic_stiffness" in hydro and "heave" in dofs:
        k = dofs.index("heave")
        area = float(hydro.hydrostatic_stiffness.values[k, k]) / weight
        if area > 0:
            return float(np.sqrt(area / np.pi))
    k = dofs.index("heave") if "heave" in dofs else 0
    volume = float(np.abs(hydro.added_mass.values[0, k, k])) / hydro.attrs["rho"]
    return (volume / 2.0) ** (1.0 / 3.0)


def _heave(hydro: xr.Dataset, k: int, usable: Index, notes: list[str]) -> tuple[tuple[float, float], Index]:
    """Return Im F3 / (omega B33) and the sign of Re F3, with the frequencies (indices) that were judged."""
    nothing = (np.nan, np.nan), usable[:_COUNT]
    F3 = _even_part(hydro, k, notes)
    if F3 is None:
        return nothing
    floats = _floats(hydro, k, usable, F3)
    F3 = F3[usable]
    wB = (hydro.omega.values * hydro.radiation_damping.values[:, k, k])[usable]
    size = np.abs(F3.real)
    clear = np.abs(wB) > 1e-7 * np.abs(F3)
    strong = np.logical_and.accumulate(size > 0.5 * size[0])
    sign = float(np.sign(F3.real[0])) if floats and size[0] > 0 else np.nan
    good = np.flatnonzero(clear & strong & (wB != 0.0))
    if len(good) == 0:
        notes.append("heave: damping in long waves is below rounding")
        return (np.nan, sign), usable[:_COUNT]
    better = good[np.abs(wB[good]) > 1e-4 * np.abs(F3[good])]
    good = (better if len(better) else good)[:_COUNT]
    return (float(np.median(F3.imag[good] / wB[good])), sign), usable[good]


def _floats(hydro: xr.Dataset, k: int, usable: Index, F3: NDArray) -> bool:
    """Tell whether there is a waterplane; without stiffness, whether F3 tends to a constant (submerged bodies: omega^2)."""
    if "hydrostatic_stiffness" in hydro:
        return float(hydro.hydrostatic_stiffness.values[k, k]) > 0.0
    low, high = usable[0], usable[-1]
    w, size = hydro.omega.values, np.abs(F3)
    return bool(w[high] > 1.2 * w[low] and size[high] < size[low] * (w[high] / w[low]))


def _even_part(hydro: xr.Dataset, k: int, notes: list[str]) -> NDArray | None:
    """Return F3 (n_omega,) averaged over opposite directions, or over all directions if the body is alike fore and aft."""
    F3, b = hydro.excitation_force.values[:, :, k], hydro.wave_direction.values
    opposite = np.abs(np.exp(1j * b[:, None]) + np.exp(1j * b[None, :])) < 1e-6
    pairs = np.argwhere(opposite)
    if len(pairs):
        return F3[:, pairs.ravel()].mean(axis=1)
    if _alike(hydro, b):
        return F3.mean(axis=1)
    notes.append("heave: no two opposite directions, and the hull is not alike fore and aft")
    return None


def _alike(hydro: xr.Dataset, b: Array) -> bool:
    """Tell whether heave couples with nothing that is odd in the directions at hand: pitch for cos b, roll for sin b."""
    dofs = hydro.influenced_dof.values.tolist()
    k = dofs.index("heave")
    for dof, part in (("pitch", np.cos(b)), ("roll", np.sin(b))):
        if np.abs(part).max() < 1e-6:
            continue
        if dof not in dofs:
            return len(dofs) == 1
        j = dofs.index(dof)
        for matrix in (hydro.added_mass.values[0], hydro.get("hydrostatic_stiffness")):
            if matrix is None:
                continue
            M = np.asarray(matrix)
            if abs(M[k, j]) > 0.02 * np.sqrt(abs(M[k, k] * M[j, j])):
                return False
    return True


def _phase(force: NDArray) -> float:
    """Return the mean phase (deg) of a few forces."""
    size = np.abs(force)
    if not size.any():
        return float("nan")
    return float(np.degrees(np.angle(np.sum(force[size > 0] / size[size > 0]))))
