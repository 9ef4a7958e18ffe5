"""Added mass, damping and wave forces of a hull from the time domain: no irregular frequencies, any frequency after one run."""

import warnings
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.bem.coupled import joined
from ogilvie.bem.hybrid_case import HybridCase, hybrid_case
from ogilvie.bem.inner import InnerMap, inner_maps
from ogilvie.bem.short_waves import short_waves, wavenumber_limit
from ogilvie.bem.stepping import impulse_response
from ogilvie.bem.wave_force import wave_force
from ogilvie.body import RigidBody
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.schema import hydro_from_arrays
from ogilvie.hydro.threads import in_parallel
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
    >>> round(float(hydro.added_mass[0, 2, 2] / (2 / 3 * np.pi)), 3)  # exact: 0.430
    0.430
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
    maps, _ = inner_maps(case.mesh, order=order)
    resolved = float(np.sqrt(wavenumber_limit(maps[0].nodes)) / case.time)
    if omega[-1] > resolved:
        warnings.warn(
            f"hybrid_hydro: waves of {omega[-1]:.4g} rad/s are too short for the panels, which resolve up to {resolved:.4g} "
            "rad/s; a higher resolution helps.",
            OgilvieWarning,
            stacklevel=2,
        )
    parts = in_parallel(partial(_part, case, omega, direction), (m for m in maps if m.dofs))
    return _dataset(parts, case, omega, direction, hull, body, resolved)


@dataclass(frozen=True, eq=False)
class _Part:
    """Results of one class of symmetry, in units of control radius and gravity."""

    dofs: list[int]
    A_inf: Array
    A: Array
    B: Array
    froude_krylov: Array
    diffraction: Array


def _part(case: HybridCase, omega: Array, direction: Array, inner: InnerMap) -> _Part:
    """Return added mass, damping and forces of one class."""
    system, dt = joined(case.domains(inner)), case.step / case.time
    rate = impulse_response(
        system.stiffness,
        system.dampers,
        system.forcing,
        dt=dt,
        count=case.count,
        late=short_waves(system),
        outputs=system.inputs,
    ).K
    K = np.einsum("in,tnj->tij", system.motions, rate, optimize=True)
    pieces = legendre_pieces(dt * np.arange(case.count), 0.5 * (K + K.transpose(0, 2, 1)), "spline")
    w = omega * case.time
    K_hat = np.conj(fourier_integral(dt * np.arange(case.count), pieces, w))
    A = system.added_mass + K_hat.imag / w[:, None, None]
    forces = wave_force(system, rate, dt=dt, omega=w, direction=direction, centre=case.centre)
    return _Part(inner.dofs, system.added_mass, A, K_hat.real, *forces)


def _dataset(
    parts: list[_Part],
    case: HybridCase,
    omega: Array,
    direction: Array,
    hull: PanelMesh,
    body: RigidBody | None,
    resolved: float,
) -> "xr.Dataset":
    """Return SI values of all dofs."""
    n_w, n_b = len(omega), len(direction)
    A, B, A_inf = np.zeros((n_w, 6, 6)), np.zeros((n_w, 6, 6)), np.zeros((6, 6))
    froude_krylov, diffraction = np.zeros((2, n_w, n_b, 6), dtype=complex)
    for part in parts:
        i, j = np.ix_(part.dofs, part.dofs)
        A_inf[i, j], A[:, i, j], B[:, i, j] = part.A_inf, part.A, part.B
        froude_krylov[..., part.dofs], diffraction[..., part.dofs] = part.froude_krylov, part.diffraction
    radius, mesh = case.mesh.radius, case.mesh
    mass, force = case.rho * radius**3 * np.outer(case.arm, case.arm), case.rho * case.g * radius**2 * case.arm
    return hydro_from_arrays(
        omega=omega,
        added_mass=mass * A,
        radiation_damping=mass / case.time * B,
        added_mass_inf=mass * A_inf,
        wave_direction=direction,
        froude_krylov_force=force * froude_krylov,
        diffraction_force=force * diffraction,
        hydrostatic_stiffness=None if body is None else hydrostatics(hull, body=body, rho=case.rho, g=case.g).stiffness,
        inertia_matrix=None if body is None else body.matrix,
        rho=case.rho,
        g=case.g,
        name=hull.name,
        source="ogilvie hybrid_hydro",
        attrs={"panels": len(mesh.part) * len(mesh.images), "symmetry": mesh.symmetry, "omega_resolved": resolved},
    )
