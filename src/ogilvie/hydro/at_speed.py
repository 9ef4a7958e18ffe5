"""Coefficients and wave forces at forward speed from those at zero speed, and back."""

import warnings
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.check_radiation import scaled
from ogilvie.hydro.schema import DOFS, VARIABLES, validate
from ogilvie.hydro.speed_terms import (
    FluidMomentum,
    diffraction_at_rest,
    diffraction_at_speed,
    fluid_momentum,
    momentum_at_speed,
    speed_matrix,
    split,
)
from ogilvie.waves.dispersion import encounter_frequency, wavenumber

if TYPE_CHECKING:
    from ogilvie.mesh.panels import PanelMesh

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_PARTS = ("Froude_Krylov_force", "diffraction_force")
#: Variables that do not depend on the speed.
_KEPT = {"added_mass_inf", "hydrostatic_stiffness", "inertia_matrix", "external_damping", "external_stiffness"}
#: Fraction of omega below which the frequency of encounter counts as zero.
_STANDING = 1e-6


def at_speed(hydro: xr.Dataset, speed: float, *, hull: "PanelMesh | None" = None) -> xr.Dataset:
    """Return the data set at a forward speed.

    Parameters
    ----------
    hydro : xarray.Dataset
        At zero speed. Wave forces, if any, in their two parts ``Froude_Krylov_force`` and ``diffraction_force``.
    speed : float
        U, m/s; negative astern.
    hull : PanelMesh, optional
        Wetted hull in the axes of the data: gives the Froude-Krylov force where the data hold only the sum.

    Returns
    -------
    xarray.Dataset
        With the attribute ``speed``. ``omega`` is the frequency of oscillation (of encounter) of ``added_mass`` and
        ``radiation_damping``, and the frequency of the incident wave of the forces, as in ``solve_bem(speed=...)``.
        ``radiation_damping_inf`` is what the damping tends to. What is known at zero speed only (``added_mass_zero``,
        ``motion_rao``, mean drift, quadratic transfer functions) is left out.

    Raises
    ------
    InputError
        Data at speed already; pitch without heave or yaw without sway; wave forces whose parts are not known.

    Warns
    -----
    OgilvieWarning
        Frequencies of encounter beyond the data: their coefficients, needed for the diffraction force, are continued
        (:class:`ogilvie.hydro.speed_terms.FluidMomentum`).

    Notes
    -----
    With T = A + B/s, s = i omega, L[sway, yaw] = 1, L[heave, pitch] = -1:

        A_U + B_U/s = (1 + U L^T/s) T (1 - U L/s),

    that is A35_U = A35 - U B33/omega^2, B35_U = B35 + U A33, A53_U = A53 + U B33/omega^2, B53_U = B53 - U A33,
    A55_U = A55 + U^2 A33/omega^2 + U (B35 - B53)/omega^2, B55_U = B55 + U^2 B33/omega^2 - U (A35 - A53), and the like for sway
    and yaw: strip theory's terms of speed (without those of a transom) on three-dimensional coefficients; exactly what
    ``solve_bem`` does. The Froude-Krylov force does not change. The diffraction force becomes
    (i omega_e + U L^T) T(omega_e) T(omega)^-1 X/(i omega), an approximation of what ``solve_bem`` does with each panel.
    See docs/theory/speed.md.

    References
    ----------
    N. Salvesen, E. O. Tuck and O. Faltinsen, Ship motions and sea loads, SNAME Transactions 78 (1970) 250.

    Examples
    --------
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> A = np.tile(np.diag([2.0, 3.0]), (2, 1, 1))
    >>> hydro = hydro_from_arrays(omega=[1.0, 2.0], added_mass=A, radiation_damping=0.1 * A, dofs=("heave", "pitch"))
    >>> sailing = at_speed(hydro, 0.5)
    >>> sailing.radiation_damping.values[0].round(6).tolist()
    [[0.2, 1.0], [-1.0, 0.35]]
    """
    L = _checked(hydro, "at_speed")
    own = float(hydro.attrs.get("speed", 0.0))
    if own != 0.0:
        raise InputError(
            f"at_speed: coefficients at zero speed expected, speed {own:.4g} m/s found. "
            "Take its terms off with zero_speed_equivalent first."
        )
    U = _speed(speed)
    fluid = fluid_momentum(hydro)
    changed = _kept(hydro)
    if "excitation_force" in hydro:
        incident = _incident(hydro, hull)
        scattered = hydro.excitation_force.values - incident
        found = diffraction_at_speed(scattered, **_encounters(hydro, fluid, U, "at_speed"), speed=U, L=L)
        changed = _with_forces(changed, incident, found)
    changed = _with_radiation(changed, momentum_at_speed(fluid.T, fluid.omega, U, L), fluid.omega)
    if "added_mass_inf" in hydro and U != 0.0:
        A = hydro.added_mass_inf.values
        changed["radiation_damping_inf"] = (("influenced_dof", "radiating_dof"), U * (L.T @ A - A @ L))
    return validate(changed.assign_attrs({"speed": U}))


def zero_speed_equivalent(hydro: xr.Dataset) -> xr.Dataset:
    """Return the data set with the terms of forward speed taken off: the inverse of :func:`at_speed`.

    Parameters
    ----------
    hydro : xarray.Dataset
        At speed, from :func:`at_speed`, ``solve_bem(speed=...)`` or another code.

    Returns
    -------
    xarray.Dataset
        With speed 0: what ``retardation`` expects. Attributes ``asymmetry_added_mass`` and ``asymmetry_radiation_damping`` tell
        how far it is from the reciprocity A_ij = A_ji of a body at rest: the largest difference, as a fraction of
        sqrt(max M_ii max M_jj). It holds the error of the panel method, and what speed does in the data beyond
        :func:`at_speed`.

    Raises
    ------
    InputError
        Data at zero speed; wave forces whose parts are not known, or that stand still (omega_e = 0), where nothing can be
        taken off: leave them out with ``hydro.drop_vars("excitation_force")`` or ``hydro.sel``.

    Examples
    --------
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> A = np.tile(np.diag([2.0, 3.0]), (2, 1, 1))
    >>> hydro = hydro_from_arrays(omega=[1.0, 2.0], added_mass=A, radiation_damping=0.1 * A, dofs=("heave", "pitch"))
    >>> back = zero_speed_equivalent(at_speed(hydro, 0.5))
    >>> bool(np.allclose(back.added_mass, hydro.added_mass)), back.attrs["speed"]
    (True, 0.0)
    """
    L = _checked(hydro, "zero_speed_equivalent")
    U = float(hydro.attrs.get("speed", 0.0))
    if U == 0.0:
        raise InputError(
            "zero_speed_equivalent: coefficients at speed expected, those at zero speed found. Use them as they are."
        )
    fluid = fluid_momentum(hydro, speed=U, L=L)
    changed = _with_radiation(_kept(hydro), fluid.T, fluid.omega)
    if "excitation_force" in hydro:
        incident = _incident(hydro, None)
        scattered = hydro.excitation_force.values - incident
        at = _encounters(hydro, fluid, U, "zero_speed_equivalent")
        _refuse_standing(hydro, at["encounter"])
        changed = _with_forces(changed, incident, diffraction_at_rest(scattered, **at, speed=U, L=L))
    asymmetry = {f"asymmetry_{key}": _asymmetry(changed[key].values) for key in ("added_mass", "radiation_damping")}
    return validate(changed.assign_attrs({"speed": 0.0, "speed_taken_off": U, **asymmetry}))


def radiation_at_rest(hydro: xr.Dataset) -> xr.Dataset:
    """Return the radiation data at zero speed, of which fluid memory is made; data at speed lose their wave forces."""
    if float(hydro.attrs.get("speed", 0.0)) == 0.0:
        return hydro
    return zero_speed_equivalent(hydro.drop_vars([key for key in ("excitation_force", *_PARTS) if key in hydro]))


def _checked(hydro: xr.Dataset, name: str) -> Array:
    """Return L for the degrees of freedom of the data set."""
    if not isinstance(hydro, xr.Dataset):
        raise InputError(f"{name}: a hydrodynamic data set (xarray.Dataset) expected, {type(hydro).__name__} found.")
    validate(hydro)
    dofs = [str(dof) for dof in hydro.influenced_dof.values]
    L = speed_matrix(dofs)
    if L is None:
        raise InputError(
            f"{name}: heave with pitch and sway with yaw expected (speed turns one into the other), {', '.join(dofs)} found. "
            "Give the missing degrees of freedom or leave pitch and yaw out."
        )
    return L


def _speed(speed: float) -> float:
    if isinstance(speed, bool) or not isinstance(speed, int | float | np.number) or not np.isfinite(speed):
        raise InputError(f"at_speed: speed: a finite number of m/s expected, {speed!r} found.")
    return float(speed)


def _incident(hydro: xr.Dataset, hull: "PanelMesh | None") -> Complex:
    """Return the Froude-Krylov force (n_w, n_b, n) of the data set, or of the hull."""
    if "Froude_Krylov_force" in hydro:
        return hydro.Froude_Krylov_force.values
    if "diffraction_force" in hydro:
        return np.asarray(hydro.excitation_force.values - hydro.diffraction_force.values)
    if hull is None:
        raise InputError(
            f"wave forces at speed: {' or '.join(_PARTS)} expected beside excitation_force, none found: speed changes the "
            "diffraction force alone. Give hull= to at_speed, data with the parts, or drop_vars('excitation_force')."
        )
    return _froude_krylov(hydro, hull)


def _froude_krylov(hydro: xr.Dataset, hull: "PanelMesh") -> Complex:
    from ogilvie.hydro.bem_panels import HullPanels
    from ogilvie.hydro.bem_waves import incident

    water = {key: float(hydro.attrs[name]) for key, name in (("depth", "water_depth"), ("rho", "rho"), ("g", "g"))}
    panels, b = HullPanels(hull), hydro.wave_direction.values.astype(float)
    k = wavenumber(hydro.omega.values, water["depth"], g=water["g"])
    rows = [
        incident(panels, omega=float(w), k=float(kw), direction=b, **water)[0]
        for w, kw in zip(hydro.omega.values, k, strict=True)
    ]
    return np.array(rows)[:, :, [DOFS.index(str(dof)) for dof in hydro.influenced_dof.values]]


def _encounters(hydro: xr.Dataset, fluid: FluidMomentum, speed: float, name: str) -> dict[str, NDArray]:
    """Return frequencies and the fluid's momentum at them, (n_w, n_b, ...)."""
    omega, b = hydro.omega.values, hydro.wave_direction.values
    encounter = encounter_frequency(
        omega[:, None], speed=speed, direction=b, depth=hydro.attrs["water_depth"], g=hydro.attrs["g"]
    )
    beyond = np.abs(encounter) > omega[-1] * (1.0 + 1e-9)
    if beyond.any():
        first = np.broadcast_to(omega[:, None], beyond.shape)[beyond].min()
        warnings.warn(
            f"{name}: the frequency of encounter exceeds the radiation data ({omega[-1]:.4g} rad/s) at {int(beyond.sum())} of "
            f"{beyond.size} points, for waves from {first:.4g} rad/s; their diffraction force is made with continued "
            "coefficients. Extend the data upwards where these waves matter.",
            OgilvieWarning,
            stacklevel=3,
        )
    full = np.broadcast_to(omega[:, None], encounter.shape)
    T = np.broadcast_to(fluid.T[:, None], (*encounter.shape, *fluid.T.shape[1:]))
    return {"omega": full, "encounter": encounter, "T": T, "T_encounter": fluid.at(encounter)}


def _refuse_standing(hydro: xr.Dataset, encounter: Array) -> None:
    standing = np.argwhere(np.abs(encounter) < _STANDING * hydro.omega.values[:, None])
    if len(standing):
        i, j = standing[0]
        raise InputError(
            f"zero_speed_equivalent: waves that move relative to the ship expected, omega_e = 0 found at "
            f"{hydro.omega.values[i]:.4g} rad/s in direction {np.degrees(hydro.wave_direction.values[j]):.4g} deg. Leave this "
            "frequency or direction out, or the forces: hydro.drop_vars(...)."
        )


def _kept(hydro: xr.Dataset) -> xr.Dataset:
    """Return the data set without the variables that change with the speed in a way that is not known."""
    known = {*_KEPT, "added_mass", "radiation_damping", *_PARTS, "excitation_force"}
    lost = [key for key in hydro.data_vars if key not in known and key in VARIABLES]
    kept = hydro.drop_vars(lost)
    used = {dim for variable in kept.data_vars.values() for dim in variable.dims}
    return kept.drop_vars([key for key, c in kept.coords.items() if c.dims and not set(c.dims) <= used])


def _with_radiation(hydro: xr.Dataset, T: Complex, omega: Array) -> xr.Dataset:
    A, B = split(T, omega)
    dims = hydro.added_mass.dims
    return hydro.assign(added_mass=(dims, A), radiation_damping=(dims, B))


def _with_forces(hydro: xr.Dataset, incident: Complex, scattered: Complex) -> xr.Dataset:
    dims = ("omega", "wave_direction", "influenced_dof")
    total = incident + scattered
    return hydro.assign(
        excitation_force=(dims, total), Froude_Krylov_force=(dims, incident), diffraction_force=(dims, scattered)
    )


def _asymmetry(M: Array) -> float:
    part = scaled(M)
    return float(np.abs(part - np.swapaxes(part, 1, 2)).max())
