"""Added mass, damping and wave forces of a hull from the time domain: no irregular frequencies, any frequency after one run."""

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.bem.hybrid_case import hybrid_case
from ogilvie.bem.impulses import Impulses, impulses
from ogilvie.bem.wave_force import wave_force
from ogilvie.body import RigidBody
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.schema import hydro_from_arrays
from ogilvie.memory.fourier import fourier_integral, legendre_pieces
from ogilvie.mesh.hydrostatics import hydrostatics
from ogilvie.mesh.panels import PanelMesh
from ogilvie.units import GRAVITY, SEA_WATER

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[Any]


def hybrid_hydro(
    hull: PanelMesh,
    body: RigidBody | None = None,
    *,
    omega: ArrayLike,
    wave_direction: ArrayLike = (np.pi,),
    duration: float | None = None,
    dt: float | None = None,
    control_radius: float | None = None,
    resolution: float = 1.0,
    order: int = 4,
    rho: float = SEA_WATER,
    g: float = GRAVITY,
    progress: bool | None = None,
) -> "xr.Dataset":
    """Return added mass, damping and wave forces in deep water at zero speed, transformed from the time domain.

    Parameters
    ----------
    hull : PanelMesh
        What is below z = 0 counts.
    body : RigidBody, optional
        Adds `inertia_matrix` and `hydrostatic_stiffness` (gravity included) to the result.
    omega : (n_w,) array
        Frequencies, rad/s.
    wave_direction : (n_b,) array
        Directions that the waves travel to, rad; pi is head seas.
    duration : float, optional
        Length of the impulse responses, s; by default 40 sqrt(Rc/g).
    dt, control_radius, resolution, order, rho, g, progress
        As for :func:`ogilvie.hybrid_bem`.

    Returns
    -------
    xarray.Dataset
        As :func:`ogilvie.solve_bem` gives it: radiation_damping, added_mass, added_mass_inf, Froude_Krylov_force,
        diffraction_force and their sum excitation_force, about O.

    Raises
    ------
    InputError, ConvergenceError
        As :func:`ogilvie.hybrid_bem`; frequencies that are not positive.

    Warns
    -----
    OgilvieWarning
        Frequencies above those that the panels resolve (attribute `omega_resolved`).

    Notes
    -----
    B + i omega (A - A_inf) = int K exp(-i omega t) dt; the diffraction force follows from the potentials on the hull after
    impulses of its velocity by Haskind's relation (:mod:`ogilvie.bem.wave_force`). Another frequency costs a transform only.

    References
    ----------
    W. E. Cummins, Schiffstechnik 9 (1962) 101; T. F. Ogilvie (1964); J. N. Newman, Journal of Ship Research 6 (1962) 10.

    Examples
    --------
    >>> from ogilvie.mesh.shapes import hemisphere
    >>> hydro = hybrid_hydro(hemisphere(1.0), omega=[1.0, 1.6], rho=1.0, g=1.0)
    >>> hydro.attrs["source"], hydro.excitation_force.shape
    ('ogilvie hybrid_hydro', (2, 1, 6))
    >>> round(float(hydro.added_mass[0, 2, 2] / (2 / 3 * np.pi)), 3)  # exact: 0.4284
    0.428
    """
    omega = np.unique(np.asarray(omega, dtype=float))
    direction = np.atleast_1d(np.asarray(wave_direction, dtype=float))
    if not (len(omega) and np.all(np.isfinite(omega)) and omega[0] > 0.0):
        raise InputError("hybrid_hydro: omega: finite frequencies > 0 expected, others found.")
    case = hybrid_case(
        "hybrid_hydro",
        hull,
        duration=duration,
        dt=dt,
        control_radius=control_radius,
        resolution=resolution,
        order=order,
        rho=rho,
        g=g,
    )
    found = impulses(case, progress=progress)
    if omega[-1] > found.resolved:
        warnings.warn(
            f"hybrid_hydro: waves of {omega[-1]:.4g} rad/s are too short for the panels, which resolve up to "
            f"{found.resolved:.4g} rad/s; a higher resolution helps.",
            OgilvieWarning,
            stacklevel=2,
        )
    return hydro_of(found, hull, body, omega=omega, wave_direction=direction)


def hydro_of(
    found: Impulses, hull: PanelMesh, body: RigidBody | None = None, *, omega: Array, wave_direction: Array
) -> "xr.Dataset":
    """Return the data of :func:`hybrid_hydro` from impulse responses that are there; omega ascending and positive."""
    case, n_w, n_b = found.case, len(omega), len(wave_direction)
    w, t = omega * case.time, case.t / case.time
    A, B, A_inf = np.zeros((n_w, 6, 6)), np.zeros((n_w, 6, 6)), np.zeros((6, 6))
    forces = np.zeros((2, n_w, n_b, 6), dtype=complex)
    for part in found.parts:
        i, j = np.ix_(part.dofs, part.dofs)
        K_hat = np.conj(fourier_integral(t, legendre_pieces(t, part.K, "spline"), w))
        A_inf[i, j], B[:, i, j] = part.system.added_mass, K_hat.real
        A[:, i, j] = part.system.added_mass + K_hat.imag / w[:, None, None]
        forces[..., part.dofs] = wave_force(
            part.system, part.rate, dt=float(t[1]), omega=w, direction=wave_direction, centre=case.centre
        )
    mesh, arm = case.mesh, case.arm
    mass, force = case.rho * mesh.radius**3 * np.outer(arm, arm), case.rho * case.g * mesh.radius**2 * arm
    return hydro_from_arrays(
        omega=omega,
        added_mass=mass * A,
        radiation_damping=mass / case.time * B,
        added_mass_inf=mass * A_inf,
        wave_direction=wave_direction,
        froude_krylov_force=force * forces[0],
        diffraction_force=force * forces[1],
        hydrostatic_stiffness=None if body is None else hydrostatics(hull, body=body, rho=case.rho, g=case.g).stiffness,
        inertia_matrix=None if body is None else body.matrix,
        rho=case.rho,
        g=case.g,
        name=hull.name,
        source="ogilvie hybrid_hydro",
        attrs={"panels": len(mesh.part) * len(mesh.images), "symmetry": mesh.symmetry, "omega_resolved": found.resolved},
    )
