"""Is this data set sound? Every law that the coefficients must obey, and where they do not."""

import xarray as xr

from ogilvie.hydro.check_causality import causality
from ogilvie.hydro.check_matrices import frequency_range, inertias, resolution, stiffness
from ogilvie.hydro.check_radiation import outliers, passivity, radiating, reciprocity
from ogilvie.hydro.check_report import Check, CheckReport, Finding
from ogilvie.hydro.check_waves import haskind, headings, long_waves, phases
from ogilvie.hydro.schema import validate

__all__ = ["Check", "CheckReport", "Finding", "check"]


def check(hydro: xr.Dataset) -> CheckReport:
    """Check a hydrodynamic data set against the laws of physics, and say what its range and resolution are good for.

    Parameters
    ----------
    hydro : xarray.Dataset
        Obeys :mod:`ogilvie.hydro.schema`.

    Returns
    -------
    CheckReport
        ``print`` it; ``.ok``, ``.findings``, ``.dirty_omega``.

    Raises
    ------
    InputError
        The data set breaks the contract itself.

    Notes
    -----
    Laws, at zero speed: reciprocity A_ij = A_ji; damping positive semi-definite (judged by the smallest eigenvalue of B scaled
    to unit peaks); damping from the forces of all headings (Haskind); Kramers-Kronig between A and B, with a robustly fitted
    tail; A_inf from Ogilvie's relation; long waves and their phases; stiffness and inertia. Then outliers, range, resolution
    and headings. Frequencies that one check finds damaged are left out by those after it.

    References
    ----------
    Ogilvie (1964); Newman, Marine Hydrodynamics (1977), chapter 6.

    Examples
    --------
    >>> from ogilvie.hydro.schema import hydro_from_arrays
    >>> import numpy as np
    >>> w = np.linspace(0.1, 8.0, 80)
    >>> B = w**2 / (1 + w**2) ** 2 * 4
    >>> A = 1.0 + 2 * (1 - w**2) / (1 + w**2) ** 2
    >>> B[40] = -0.5
    >>> A, B = A[:, None, None], B[:, None, None]
    >>> report = check(hydro_from_arrays(omega=w, added_mass=A, radiation_damping=B, dofs=("heave",)))
    >>> report.ok, report.dirty_omega
    (False, array([4.1]))
    """
    validate(hydro)
    waves = radiating(hydro)
    first = (reciprocity(waves), passivity(waves), haskind(waves))
    damaged = CheckReport("", first).dirty_omega
    causal, limit = causality(waves, damaged)
    damaged = CheckReport("", (*first, causal)).dirty_omega
    checks = (
        *first,
        causal,
        limit,
        outliers(waves, damaged),
        frequency_range(waves, damaged),
        resolution(waves, damaged),
        long_waves(hydro),
        phases(hydro),
        headings(hydro),
        stiffness(hydro),
        *inertias(hydro),
    )
    w = hydro.omega.values
    title = f"{hydro.attrs.get('name', 'data set')}: {len(w)} frequencies {w[0]:.4g}..{w[-1]:.4g} rad/s"
    silent = [str(dof) for dof in hydro.influenced_dof.values if dof not in waves.influenced_dof.values]
    if silent:
        title += f"; {', '.join(silent)} hardly makes waves and is left out of the radiation checks"
    return CheckReport(title, checks)
