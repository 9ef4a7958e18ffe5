"""From the solutions at single wavenumbers to the data set."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ogilvie.body import RigidBody
from ogilvie.hydro.bem_case import Case, entry
from ogilvie.hydro.bem_forces import radiation, scattered
from ogilvie.hydro.bem_waves import incident
from ogilvie.hydro.schema import hydro_from_arrays
from ogilvie.mesh.hydrostatics import hydrostatics

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Vectors = Mapping[float, Complex]


def assemble(case: Case, vectors: Vectors, *, body: RigidBody | None, attrs: Mapping[str, Any]) -> xr.Dataset:
    """Return the data set of a case whose wavenumbers are solved.

    Parameters
    ----------
    case : Case
    vectors : mapping of float to (6, n_hull) complex array
        Force vectors at each of ``case.wavenumbers``.
    body : RigidBody or None
    attrs : mapping
        Further attributes.
    """
    A, B = _radiation(case, vectors)
    froude_krylov, diffraction = _excitation(case, vectors)
    A_inf, B_inf = _limit(case, vectors[np.inf], np.inf)
    hull = case.panels.hull
    copies = len(case.panels.images)
    hydro = hydro_from_arrays(
        omega=case.omega,
        added_mass=A,
        radiation_damping=B,
        added_mass_inf=A_inf,
        added_mass_zero=_limit(case, vectors[0.0], 0.0)[0] if case.has_zero_limit else None,
        wave_direction=case.direction,
        froude_krylov_force=froude_krylov,
        diffraction_force=diffraction,
        hydrostatic_stiffness=None if body is None else hydrostatics(hull, body=body, rho=case.rho, g=case.g).stiffness,
        inertia_matrix=None if body is None else body.matrix,
        rho=case.rho,
        g=case.g,
        water_depth=case.depth,
        speed=case.speed,
        name=hull.name,
        attrs={
            **attrs,
            "panels": hull.n_faces * copies,
            "lid_panels": case.panels.n_lid * copies,
            "symmetry": hull.symmetry,
        },
    )
    if case.speed != 0.0:
        hydro["radiation_damping_inf"] = (("influenced_dof", "radiating_dof"), B_inf)
    return hydro


def _radiation(case: Case, vectors: Vectors) -> tuple[Array, Array]:
    pairs = [
        radiation(case.panels, vectors[entry(k)], omega=float(w), rho=case.rho, speed=case.speed)
        for w, k in zip(case.omega, case.k, strict=True)
    ]
    return np.array([A for A, _ in pairs]), np.array([B for _, B in pairs])


def _limit(case: Case, g: Complex, omega: float) -> tuple[Array, Array]:
    return radiation(case.panels_at(omega), g, omega=omega, rho=case.rho, speed=case.speed)


def _excitation(case: Case, vectors: Vectors) -> tuple[Complex, Complex]:
    """Return Froude-Krylov and diffraction forces (n_w, n_b, 6); they oscillate with the signed encounter frequency."""
    shape = (len(case.omega), len(case.direction), 6)
    froude_krylov, diffraction = np.empty(shape, dtype=complex), np.empty(shape, dtype=complex)
    for i, w in enumerate(case.omega):
        froude_krylov[i], velocity = incident(
            case.panels, omega=float(w), k=float(case.k[i]), direction=case.direction, depth=case.depth, rho=case.rho, g=case.g
        )
        for k in np.unique(case.k_encounter[i]):
            for sign in (1.0, -1.0):
                here = (case.k_encounter[i] == k) & (np.where(case.encounter[i] < 0.0, -1.0, 1.0) == sign)
                if here.any():
                    solution = vectors[entry(k)] if sign > 0.0 else vectors[entry(k)].conj()
                    w_e = float(case.encounter[i][here][0])
                    diffraction[i, here] = scattered(
                        case.panels, solution, -velocity[here], omega=w_e, rho=case.rho, speed=case.speed
                    )
    return froude_krylov, diffraction
