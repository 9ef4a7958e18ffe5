"""Newman's approximations as a quadratic transfer function in a data set, to look at or to hand to another program."""

from typing import Literal, get_args

import numpy as np
import xarray as xr

from ogilvie.errors import InputError
from ogilvie.hydro.schema import DOFS
from ogilvie.loads.newman import drift_table

Form = Literal["newman", "arithmetic", "geometric"]

_RULES = {"newman": "newman-1974", "arithmetic": "newman-arithmetic", "geometric": "newman-geometric"}


def newman(mean_drift: xr.Dataset, form: Form = "newman", *, pairs: bool = False, variable: str = "mean_drift") -> xr.Dataset:
    """Return the data set with ``qtf_diff`` from its mean drift alone.

    Parameters
    ----------
    mean_drift : xarray.Dataset
        Of :func:`ogilvie.mean_drift`, or any data set with mean drift.
    form : {"newman", "arithmetic", "geometric"}
        Drift at the mean of the two frequencies (Newman 1974), mean of the two drifts, or their geometric mean with its sign;
        see :mod:`ogilvie.loads.newman`.
    pairs : bool
        Add ``qtf_diff_pairs`` for waves of any two directions of the data.
    variable : str
        Which mean drift.

    Returns
    -------
    xarray.Dataset
        The data set given, with qtf_diff (omega_1, omega_2, wave_direction, influenced_dof), N/m2 and N m/m2, in place of any
        other; components that the drift does not hold are NaN.

    Raises
    ------
    InputError
        Another form; no mean drift, or a component known in part.

    Notes
    -----
    For forces in time :class:`ogilvie.SlowDrift` with ``approximation=`` needs no such function, and is faster.

    Examples
    --------
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> w, Z = np.linspace(0.2, 1.0, 5), np.zeros((5, 6, 6))
    >>> D = np.broadcast_to(-w[:, None, None], (5, 1, 6))
    >>> hydro = hydro_from_arrays(omega=w, added_mass=Z, radiation_damping=Z, wave_direction=[np.pi], mean_drift=D)
    >>> [float(newman(hydro, form).qtf_diff[0, 3, 0, 0].real.round(4)) for form in ("newman", "arithmetic", "geometric")]
    [-0.5, -0.5, -0.4]
    """
    if form not in get_args(Form):
        raise InputError(f"newman: form: one of {', '.join(get_args(Form))} expected, {form!r} found.")
    table = drift_table(mean_drift, _RULES[form], variable)
    w, dofs = table.omega, [DOFS.index(str(d)) for d in mean_drift.influenced_dof.values]
    b = mean_drift.wave_direction.values.astype(float)
    one, two = (np.repeat(b, len(b)), np.tile(b, len(b))) if pairs else (b, b)
    i, j, p = (x.ravel() for x in np.indices((len(w), len(w), len(one))))
    Q = table.pair(w[i], one[p], w[j], two[p]).reshape(len(w), len(w), len(one), 6)
    Q = np.where(table.known, Q, np.nan)[..., dofs]
    dof = ("influenced_dof", mean_drift.influenced_dof.values)
    axes = {"omega_1": w, "omega_2": w, "influenced_dof": dof}
    said = {"method": f"{_RULES[form]} from {variable}"}
    same = one == two
    variables = {
        "qtf_diff": xr.DataArray(
            Q[:, :, same], dims=("omega_1", "omega_2", "wave_direction", "influenced_dof"), coords={**axes, "wave_direction": b}
        ).assign_attrs(said)
    }
    if pairs:
        variables["qtf_diff_pairs"] = xr.DataArray(
            Q,
            dims=("omega_1", "omega_2", "qtf_pair", "influenced_dof"),
            coords={**axes, "qtf_direction_1": ("qtf_pair", one), "qtf_direction_2": ("qtf_pair", two)},
        ).assign_attrs(said)
    return mean_drift.drop_dims(["omega_1", "omega_2", "qtf_pair"], errors="ignore").assign(variables)
