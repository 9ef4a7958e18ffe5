"""What is asked of the panel method, checked: hull and lid, frequencies, directions, water, speed."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.bem_panels import HullPanels
from ogilvie.hydro.threads import machine_memory
from ogilvie.mesh.inspect import require_usable
from ogilvie.mesh.lid import waterplane_lid
from ogilvie.mesh.panels import PanelMesh
from ogilvie.waves.dispersion import encounter_frequency, frequency, wavenumber

Array = NDArray[np.float64]
Irregular = Literal["remove", "keep"]

#: Panels per wave length that a mesh needs at the surface.
PANELS_PER_WAVE = 6.0
#: Smallest k h at which the Green function of finite depth is evaluated.
SHALLOWEST = 0.01


@dataclass(frozen=True, eq=False)
class Case:
    """A checked problem for the panel method.

    Parameters
    ----------
    panels : HullPanels
    omega, direction : (n_w,), (n_b,) array
        rad/s, ascending; rad, ascending.
    depth, rho, g, speed : float
        m (inf for deep water), kg/m3, m/s2, m/s.
    """

    panels: HullPanels
    omega: Array
    direction: Array
    depth: float
    rho: float
    g: float
    speed: float

    @cached_property
    def k(self) -> Array:
        """Wavenumber (n_w,) of waves of frequency omega, rad/m: of the incident and, at zero speed, of the radiated ones."""
        return wavenumber(self.omega, self.depth, g=self.g)

    @cached_property
    def encounter(self) -> Array:
        """Signed frequency (n_w, n_b) at which the ship meets each incident wave, rad/s; negative for overtaken waves."""
        if self.speed == 0.0:
            return np.repeat(self.omega[:, None], len(self.direction), axis=1)
        w = encounter_frequency(
            self.omega[:, None], speed=self.speed, direction=self.direction[None, :], depth=self.depth, g=self.g
        )
        return np.where(np.abs(w) < 1e-9 * self.omega[:, None], 0.0, w)

    @cached_property
    def k_encounter(self) -> Array:
        """Wavenumber (n_w, n_b) of waves of the encounter frequency, rad/m."""
        return wavenumber(np.abs(self.encounter), self.depth, g=self.g)

    @cached_property
    def wavenumbers(self) -> list[float]:
        """Distinct wavenumbers to solve, ascending; infinity last, zero first (deep water at zero speed only)."""
        k = {entry(x) for x in [*self.k, *self.k_encounter.ravel(), np.inf]}
        if self.has_zero_limit:
            k.add(0.0)
        return sorted(k)

    def deep_wavenumber(self, k: float) -> float:
        """Return K = omega^2/g = k tanh kh, rad/m."""
        return k if np.isinf(self.depth) else float(k * np.tanh(k * self.depth))

    def panels_at(self, k: float) -> HullPanels:
        """Return the panels to solve with: no lid at zero and infinite wavenumber, where no frequency is irregular."""
        return self.panels.without_lid if k in (0.0, np.inf) else self.panels

    @property
    def has_zero_limit(self) -> bool:
        """True if added mass has a limit at zero frequency: it grows as log omega in finite depth, as 1/omega^2 at speed."""
        return bool(np.isinf(self.depth)) and self.speed == 0.0


def entry(k: float) -> float:
    """Return a wavenumber rounded to 12 digits, so that equal ones that were computed differently are one."""
    return float(f"{k:.12g}")


def make_case(
    hull: PanelMesh,
    *,
    omega: ArrayLike,
    wave_direction: ArrayLike,
    rho: float,
    g: float,
    water_depth: float,
    speed: float,
    irregular_frequencies: Irregular,
) -> Case:
    """Return the checked problem, with a lid where irregular frequencies are to be removed.

    Raises
    ------
    InputError
        Each argument that cannot be worked with, by name.
    """
    require_usable(hull, purpose="solve_bem")
    for name, value in (("rho", rho), ("g", g)):
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(f"solve_bem: {name}: a positive number expected, {value!r} found.")
    if not np.isfinite(speed):
        raise InputError(f"solve_bem: speed: a finite number of m/s expected, {speed!r} found.")
    if not water_depth > -hull.bounds[0, 2]:
        raise InputError(
            f"solve_bem: water_depth: more than the draught of {hull.name!r}, {hull.draught:.6g} m, expected "
            f"(inf for deep water), {water_depth!r} found."
        )
    if irregular_frequencies not in ("remove", "keep"):
        raise InputError(f"solve_bem: irregular_frequencies: 'remove' or 'keep' expected, {irregular_frequencies!r} found.")
    case = Case(
        panels=HullPanels(hull, _lid(hull) if irregular_frequencies == "remove" else None),
        omega=_frequencies(omega),
        direction=_directions(wave_direction),
        depth=float(water_depth),
        rho=float(rho),
        g=float(g),
        speed=float(speed),
    )
    _refuse_shallow(case)
    _refuse_too_large(case)
    return case


def resolved_wavenumber(mesh: PanelMesh) -> float:
    """Return the largest wavenumber (rad/m) whose waves the panels resolve: 6 panels per wave length where the wave is felt.

    Notes
    -----
    Waves decay as exp(k z): a panel with longest side s at depth d limits k by k s exp(-k d) = 2 pi/6, whose smallest solution
    is k = -W(-(2 pi/6) d/s)/d; deep panels, with s < (2 pi/6) e d, do not limit it.

    Examples
    --------
    >>> square = PanelMesh([[0, 0, -1e-9], [2, 0, -1e-9], [2, 2, -1e-9], [0, 2, -1e-9]], [[0, 1, 2, 3]])
    >>> round(resolved_wavenumber(square), 6)
    0.523599
    """
    from scipy.special import lambertw

    corner = mesh.vertices[mesh.faces]
    side = np.linalg.norm(corner - np.roll(corner, -1, axis=1), axis=2).max(axis=1)
    c = 2.0 * np.pi / PANELS_PER_WAVE
    d = np.maximum(-mesh.centers[:, 2], 1e-9 * side)
    felt = c * d / side < np.exp(-1.0)
    if not felt.any():
        return np.inf
    return float((-lambertw(-c * d[felt] / side[felt]).real / d[felt]).min())


def warn_if_coarse(case: Case) -> float:
    """Return the frequency up to which the hull's panels resolve the waves, rad/s; warn if the case goes beyond."""
    limit = resolved_wavenumber(case.panels.hull)
    highest = float(frequency(limit, case.depth, g=case.g)) if np.isfinite(limit) else np.inf
    oscillation = np.concatenate([case.omega, np.abs(case.encounter).ravel()])
    beyond = np.unique(oscillation[oscillation > highest])
    if len(beyond):
        what = "frequencies" if case.speed == 0.0 else "frequencies (of oscillation or encounter)"
        warnings.warn(
            f"solve_bem: the panels of {case.panels.hull.name!r} resolve waves up to omega = {highest:.4g} rad/s "
            f"({PANELS_PER_WAVE:g} panels per wave length); {len(beyond)} {what} are above, up to {beyond[-1]:.4g} rad/s. "
            "Refine the mesh near the waterline or leave these frequencies out.",
            OgilvieWarning,
            stacklevel=3,
        )
    return highest


def _lid(hull: PanelMesh) -> PanelMesh | None:
    """Return the hull's own lid, or one made for it; None for a submerged hull."""
    if hull.lid is not None:
        return hull.lid
    on_surface = np.abs(hull.vertices[np.unique(hull.faces), 2]) <= hull.tolerance
    return waterplane_lid(hull) if on_surface.any() else None


def _frequencies(omega: ArrayLike) -> Array:
    w = np.atleast_1d(np.asarray(omega, dtype=float))
    if w.ndim != 1 or len(w) == 0:
        raise InputError(f"solve_bem: omega: at least one frequency in rad/s expected, an array of shape {w.shape} found.")
    bad = w[~(np.isfinite(w) & (w > 0.0))]
    if len(bad):
        raise InputError(
            f"solve_bem: omega: positive, finite frequencies in rad/s expected, {bad[0]!r} found. The limits at zero and "
            "infinite frequency are always part of the result."
        )
    w = np.sort(w)
    if np.any(np.diff(w) <= 1e-12 * w[1:]):
        raise InputError("solve_bem: omega: distinct frequencies expected, one is given twice.")
    return w


def _directions(wave_direction: ArrayLike) -> Array:
    b = np.atleast_1d(np.asarray(wave_direction, dtype=float))
    if b.ndim != 1 or len(b) == 0:
        raise InputError(f"solve_bem: wave_direction: at least one angle in rad expected, an array of shape {b.shape} found.")
    if not np.all(np.isfinite(b)) or b.min() < -np.pi - 1e-9 or b.max() > 2.0 * np.pi + 1e-9:
        raise InputError(
            f"solve_bem: wave_direction: angles in rad, from -pi to 2 pi, expected, {b.min():.6g} to {b.max():.6g} found. "
            "Degrees? Multiply by ogilvie.units.deg."
        )
    b = np.sort(b)
    if np.any(np.diff(b) <= 1e-12):
        raise InputError("solve_bem: wave_direction: distinct directions expected, one is given twice.")
    return b


def _refuse_shallow(case: Case) -> None:
    if np.isinf(case.depth):
        return
    lowest = float(frequency(SHALLOWEST / case.depth, case.depth, g=case.g))
    if case.omega[0] < lowest:
        raise InputError(
            f"solve_bem: omega: frequencies of at least {lowest:.4g} rad/s expected in {case.depth:.6g} m of water (k h >= "
            f"{SHALLOWEST:g}), {case.omega[0]:.4g} rad/s found."
        )
    slow = np.argwhere(np.abs(case.encounter) < lowest)
    if len(slow):
        raise InputError(
            f"solve_bem: encounter frequencies of at least {lowest:.4g} rad/s expected in {case.depth:.6g} m of water (k h >= "
            f"{SHALLOWEST:g}), but smaller ones found at {_pairs(case, slow)}. Leave these directions or frequencies out."
        )


def _refuse_too_large(case: Case) -> None:
    """Compare the size of the influence matrices with the memory of this machine, where the system tells it."""
    n, copies = case.panels.n_hull + case.panels.n_lid, len(case.panels.images)
    needed = 16.0 * n**2 * 2.0 * (copies + 1)
    memory = machine_memory()
    if needed > memory:
        raise InputError(
            f"solve_bem: a mesh that fits into {memory / 1e9:.3g} GB of memory expected, {n} stored panels found, which need "
            f"{needed / 1e9:.3g} GB. Use a coarser mesh, or store the hull with its symmetry: hull.with_symmetry('xz')."
        )


def _pairs(case: Case, index: Sequence[Sequence[int]] | NDArray[np.int64]) -> str:
    shown = [f"omega {case.omega[i]:.4g} rad/s in direction {np.degrees(case.direction[j]):.4g} deg" for i, j in index[:5]]
    more = f" and {len(index) - 5} more" if len(index) > 5 else ""
    return ", ".join(shown) + more
