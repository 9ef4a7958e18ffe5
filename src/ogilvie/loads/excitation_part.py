"""The two parts of the wave excitation: the pressure of the undisturbed waves, and what the hull makes of them."""

import xarray as xr

from ogilvie.errors import InputError
from ogilvie.loads.base import DIFFRACTION, FROUDE_KRYLOV

#: Physical effects of each part.
PARTS = {
    "total": frozenset({FROUDE_KRYLOV, DIFFRACTION}),
    "diffraction": frozenset({DIFFRACTION}),
    "Froude-Krylov": frozenset({FROUDE_KRYLOV}),
}
#: Names of the loads.
NAMES = {"total": "excitation", "diffraction": "diffraction", "Froude-Krylov": "froude_krylov"}


def only_part(hydro: xr.Dataset, part: str) -> xr.Dataset:
    """Return a data set whose excitation force is one part of it alone.

    Parameters
    ----------
    hydro : xarray.Dataset
        With ``excitation_force`` and, for a part, ``Froude_Krylov_force`` or ``diffraction_force``.
    part : {"total", "diffraction", "Froude-Krylov"}

    Raises
    ------
    InputError
        The data set does not tell the parts apart.

    Notes
    -----
    X = X_FK + X_D. The result holds the part as ``excitation_force`` together with its own X_FK and X_D, of which the rule for
    forward speed (:func:`ogilvie.at_speed`) moves the second.

    Examples
    --------
    >>> import numpy as np
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> w, Z, X = np.linspace(0.2, 2.0, 4), np.zeros((4, 6, 6)), np.ones((4, 1, 6))
    >>> hydro = hydro_from_arrays(omega=w, added_mass=Z, radiation_damping=Z, wave_direction=[0.0], excitation_force=X)
    >>> hydro = hydro.assign(Froude_Krylov_force=1.5 * hydro.excitation_force)
    >>> complex(only_part(hydro, "diffraction").excitation_force[0, 0, 2])
    (-0.5+0j)
    """
    if part == "total":
        return hydro
    if "Froude_Krylov_force" in hydro:
        incident = hydro.Froude_Krylov_force
    elif "diffraction_force" in hydro:
        incident = hydro.excitation_force - hydro.diffraction_force
    else:
        raise InputError(
            f"WaveExcitation: part={part!r}: Froude_Krylov_force or diffraction_force expected in the data set, none found. "
            "Solve for them (solve_bem), or take part='total'."
        )
    scattered, nothing = hydro.excitation_force - incident, xr.zeros_like(hydro.excitation_force)
    if part == "diffraction":
        return hydro.assign(excitation_force=scattered, Froude_Krylov_force=nothing, diffraction_force=scattered)
    return hydro.assign(excitation_force=incident, Froude_Krylov_force=incident, diffraction_force=nothing)
