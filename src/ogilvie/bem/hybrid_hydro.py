"""Added mass, damping and wave forces of a hull from the time domain: no irregular frequencies, any frequency after one run."""

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.bem import hybrid
from ogilvie.bem.coupled import coupled_system
from ogilvie.bem.inner import inner_maps
from ogilvie.bem.outer import depth_functions, outer_mode
from ogilvie.bem.short_waves import short_waves, wavenumber_limit
from ogilvie.bem.stepping import impulse_response
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

_DURATION = 40.0  # default over sqrt(control radius / g)


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
    dt, control_radius, resolution, order, rho, g
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
    >>> round(float(hydro.added_mass[0, 2, 2] / (2 / 3 * np.pi)), 2)  # of A33 = 0.5861 at Ka = 1
    0.59
    """
    omega = np.sort(np.atleast_1d(np.asarray(omega, dtype=float)))
    direction = np.atleast_1d(np.asarray(wave_direction, dtype=float))
    if not (omega.ndim == 1 and np.all(np.isfinite(omega)) and np.all(omega > 0.0) and len(omega)):
        raise InputError("hybrid_hydro: omega: finite frequencies > 0 expected, others found.")
    mesh = hybrid._mesh(hull, control_radius, resolution)
    time = np.sqrt(mesh.radius / g)
    duration = _DURATION * time if duration is None else duration
    step = hybrid._DT * time if dt is None else dt
    hybrid._check(duration, dt, resolution, order, "compressed", rho, g)
    maps, _ = inner_maps(mesh, order=order)
    resolved = float(np.sqrt(g * wavenumber_limit(maps[0].nodes) / mesh.radius))
    if omega[-1] > resolved:
        warnings.warn(
            f"hybrid_hydro: waves of {omega[-1]:.4g} rad/s are too short for the panels, which resolve up to {resolved:.4g} rad/s; "
            "a higher resolution helps.",
            OgilvieWarning,
            stacklevel=2,
        )
    sea = [outer_mode(m, hybrid._FUNCTIONS) for m in range(hybrid._MODES)]
    count = int(np.ceil(duration / step - 1e-9)) + 1
    n_w, n_b = len(omega), len(direction)
    A, B, A_inf = np.zeros((n_w, 6, 6)), np.zeros((n_w, 6, 6)), np.zeros((6, 6))
    parts = np.zeros((2, n_w, n_b, 6), dtype=complex)
    for inner in (m for m in maps if m.dofs):
        system = coupled_system(inner, sea, depth_functions, centre=np.array(mesh.centre) / mesh.radius)
        rate = impulse_response(
            system.stiffness,
            system.dampers,
            system.forcing,
            dt=step / time,
            count=count,
            late=short_waves(system),
            outputs=system.inputs,
        ).K
        at = np.ix_(inner.dofs, inner.dofs)
        K = np.einsum("in,tnj->tij", system.motions, rate)
        t = step / time * np.arange(count)
        K_hat = np.conj(fourier_integral(t, legendre_pieces(t, 0.5 * (K + K.transpose(0, 2, 1)), "spline"), omega * time))
        A_inf[at] = system.added_mass
        B[:, *at], A[:, *at] = K_hat.real, system.added_mass + K_hat.imag / (omega * time)[:, None, None]
        parts[..., inner.dofs] = wave_force(
            system, rate, dt=step / time, omega=omega * time, direction=direction, centre=np.array(mesh.centre) / mesh.radius
        )
    arm = np.where(np.arange(6) < 3, 1.0, mesh.radius)
    mass, force = rho * mesh.radius**3 * np.outer(arm, arm), rho * g * mesh.radius**2 * arm
    return hydro_from_arrays(
        omega=omega,
        added_mass=mass * A,
        radiation_damping=mass / time * B,
        added_mass_inf=mass * A_inf,
        wave_direction=direction,
        froude_krylov_force=force * parts[0],
        diffraction_force=force * parts[1],
        hydrostatic_stiffness=None if body is None else hydrostatics(hull, body=body, rho=rho, g=g).stiffness,
        inertia_matrix=None if body is None else body.matrix,
        rho=rho,
        g=g,
        name=hull.name,
        source="ogilvie hybrid_hydro",
        attrs={"panels": len(mesh.part) * len(mesh.images), "symmetry": mesh.symmetry, "omega_resolved": resolved},
    )
