"""Drift moments about the origin that moves with the body, from those about its mean position."""

import numpy as np
import xarray as xr

from ogilvie.errors import InputError
from ogilvie.hydro.rao import rao
from ogilvie.hydro.schema import DOFS
from ogilvie.waves.dispersion import encounter_frequency


def drift_about_body(hydro: xr.Dataset, variable: str = "mean_drift") -> xr.DataArray:
    """Return mean drift with its moments about the moving origin O of the body, as WAMIT's negative modes have them.

    Parameters
    ----------
    hydro : xarray.Dataset
        With the six dofs, `variable`, ``inertia_matrix`` and ``motion_rao`` (or what :func:`ogilvie.rao` needs to find it).
    variable : str
        Which mean drift, with moments about the mean position of O: "mean_drift", "mean_drift_pressure", ...

    Returns
    -------
    xarray.DataArray
        (omega, wave_direction, influenced_dof), N/m2 and N m/m2; forces are those of `variable`.

    Raises
    ------
    InputError
        Not six dofs; a variable, motions or inertia that are not there.

    Notes
    -----
    M_body = M - <T x F1>, with T the motion of O and F1 = (-omega_e^2 M + i omega_e B_ext + C_ext) xi the first-order force of
    the water: what accelerates the body, and what ``external_damping`` and ``external_stiffness`` take of it. For the
    motion-dependent part to be meaningful the motions must be those that the drift was made with.

    Examples
    --------
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> xi = np.zeros((1, 1, 6), dtype=complex); xi[..., 0], xi[..., 4] = 1.0, 0.1j  # surge, and pitch a quarter later
    >>> xi[..., 2] = 0.5
    >>> M = np.diag([2.0, 2, 2, 1, 1, 1]); M[0, 4] = M[4, 0] = 0.8  # centre of gravity above O
    >>> Z = np.ones((1, 6, 6))
    >>> hydro = hydro_from_arrays(omega=[1.0], added_mass=Z, radiation_damping=Z, wave_direction=[np.pi], motion_rao=xi,
    ...                           inertia_matrix=M, mean_drift=np.ones((1, 1, 6)))
    >>> drift_about_body(hydro).values[0, 0].round(3).tolist()
    [1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    >>> xi[..., 4] = 0.1
    >>> drift_about_body(hydro.assign(motion_rao=hydro.motion_rao.copy(data=xi))).values[0, 0].round(3).tolist()
    [1.0, 1.0, 1.0, 1.0, 1.02, 1.0]
    """
    if variable not in hydro:
        raise InputError(f"drift_about_body: {variable} expected in the data set, not found.")
    if tuple(str(d) for d in hydro.influenced_dof.values) != DOFS:
        raise InputError(
            f"drift_about_body: {', '.join(DOFS)} expected, {', '.join(hydro.influenced_dof.values)} found: moments about "
            "another origin need all forces."
        )
    if "inertia_matrix" not in hydro:
        raise InputError("drift_about_body: inertia_matrix expected in the data set, not found. Read the .frc file with it.")
    drift = hydro[variable]
    motion = hydro.motion_rao if "motion_rao" in hydro else rao(hydro)
    xi = motion.sel(omega=drift.omega, wave_direction=drift.wave_direction).values
    omega_e = encounter_frequency(
        drift.omega.values[:, None],
        speed=float(hydro.attrs.get("speed", 0.0)),
        direction=drift.wave_direction.values,
        depth=hydro.attrs["water_depth"],
        g=hydro.attrs["g"],
    )
    force = -(omega_e[..., None] ** 2) * (xi @ hydro.inertia_matrix.values.T)
    if "external_damping" in hydro:
        force = force + 1j * omega_e[..., None] * (xi @ hydro.external_damping.values.T)
    if "external_stiffness" in hydro:
        force = force + xi @ hydro.external_stiffness.values.T
    values = np.array(drift.values, dtype=float)
    values[..., 3:] -= 0.5 * np.cross(xi[..., :3], force[..., :3].conj()).real
    return drift.copy(data=values).assign_attrs(origin="moving with the body")
