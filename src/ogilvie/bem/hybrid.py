"""Retardation functions of a hull straight from the time domain: panels inside a control hemisphere, the open sea outside."""

from dataclasses import dataclass
from functools import partial
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.coupled import CoupledSystem, joined
from ogilvie.bem.curved import CurvedMesh
from ogilvie.bem.hybrid_case import HybridCase, flared, floating, hybrid_case
from ogilvie.bem.inner import InnerMap, inner_maps
from ogilvie.bem.inner_mesh import inner_mesh
from ogilvie.bem.plain import plain_hybrid
from ogilvie.bem.plain_boundary import flat_boundary
from ogilvie.bem.short_waves import short_waves, wavenumber_limit
from ogilvie.bem.stepping import Response, impulse_response
from ogilvie.body import RigidBody
from ogilvie.errors import InputError
from ogilvie.hydro.threads import in_parallel
from ogilvie.memory.table import Retardation
from ogilvie.mesh.panels import PanelMesh
from ogilvie.units import GRAVITY, SEA_WATER

Array = NDArray[Any]

_OTHER_LIMIT = 0.8  # of the wavenumber where damping sets in, in the solution for comparison
_LAST = 0.05  # of the duration, whose largest |K| stands for what is left


@dataclass(frozen=True, eq=False)
class _Part:
    """Solution of one class of symmetry, in units of control radius and gravity, and one made otherwise for comparison."""

    dofs: list[int]
    system: CoupledSystem
    response: Response
    other: Response


def hybrid_bem(
    hull: PanelMesh | CurvedMesh,
    body: RigidBody | None = None,
    *,
    duration: float,
    dt: float | None = None,
    control_radius: float | None = None,
    resolution: float = 1.0,
    order: int = 4,
    outer: Literal["compressed", "green"] = "compressed",
    rho: float = SEA_WATER,
    g: float = GRAVITY,
    progress: bool | None = None,
) -> Retardation:
    """Return the retardation functions and the added mass at infinite frequency of a floating hull in deep water.

    Parameters
    ----------
    hull : PanelMesh or CurvedMesh
        What is below z = 0 counts. Curved panels (:func:`ogilvie.bem.inner_mesh.inner_mesh`) are taken as they are.
    body : RigidBody, optional
        Its mass is compared with the displaced mass; K depends on the hull alone.
    duration : float
        Last time, s.
    dt : float, optional
        Time step of the table, s; by default 0.035 sqrt(Rc/g). It does not change the values.
    control_radius : float, optional
        Rc, m; by default as :func:`ogilvie.bem.inner_mesh.inner_mesh` chooses.
    resolution : float
        Panels per length, 1 for the default.
    order : int
        Nodes per side of a panel, 2 or more.
    outer : {"compressed", "green"}
        The open sea as the passive oscillators of :mod:`ogilvie.bem.outer`, or paper B's method as published, by the transient
        Green function and flat panels (:func:`ogilvie.bem.plain.plain_hybrid`): to compare with, several times the work for a
        hundredth of the accuracy. `order` - 2 flat panels go along each side of a curved one.
    rho, g : float
        kg/m3, m/s2.
    progress : bool, optional
        Show a progress bar; by default for long work on a terminal.

    Returns
    -------
    Retardation
        About O. `discretisation_error` is the difference of two solutions that treat reciprocity and short waves differently,
        `truncation_error` what is left at the end, both as parts of the largest K_ij.

    Raises
    ------
    InputError
        A duration, step, resolution or order out of range; a hull without waterline, beyond the control surface, or open.
    ConvergenceError
        A mesh so distorted that the equations are not solvable or their energy not positive.

    Notes
    -----
    docs/theory/hybrid.md. With z the modes of the free surface and the oscillators of the open sea,
    z'' + C z' + S z = h nu, S and C symmetric and >= 0, K(t) = rho h.T z'(t) after nu = delta(t): reciprocal, and nothing can
    grow. There is no Green function, no sum over the past, no irregular frequency and no limit of the time step.

    References
    ----------
    Paper B (Guo), Eqs. (8)-(25), for the matching on a control hemisphere; Liapis (1986) for psi and chi.

    Examples
    --------
    >>> from ogilvie.mesh.shapes import hemisphere
    >>> K = hybrid_bem(hemisphere(1.0), duration=4.0, rho=1.0, g=1.0)
    >>> unit = 2 / 3 * np.pi  # of K33(0) = 3/16 and A33 = 1/2
    >>> [round(float(x / unit), 3) for x in (K.K[0, 2, 2], K.A_inf[2, 2])]
    [0.188, 0.5]
    """
    if outer not in ("compressed", "green"):
        raise InputError(f"hybrid_bem: outer: 'compressed' or 'green' expected, {outer!r} found.")
    if outer == "green":
        mesh = hull if isinstance(hull, CurvedMesh) else inner_mesh(hull, control_radius=control_radius)
        flat = flat_boundary(mesh, divisions=max(1, order - 2))
        return plain_hybrid(flat, duration=duration, dt=dt, rho=rho, g=g, points=1).retardation()
    case = hybrid_case(
        "hybrid_bem",
        hull,
        duration=duration,
        dt=dt,
        control_radius=control_radius,
        resolution=resolution,
        order=order,
        rho=rho,
        g=g,
    )
    maps, defect = inner_maps(case.mesh, order=order)
    title = "impulses of surge..yaw, by symmetry"
    parts = in_parallel(partial(_solved, case), [m for m in maps if m.dofs], progress=progress, title=title)
    return _table(parts, case, _remarks(parts, case.mesh, defect, [*flared(case.mesh, case.time), *floating(hull, body, rho)]))


def _solved(case: HybridCase, inner: InnerMap) -> _Part:
    """Return the solution of one class and the one for comparison."""
    dt, domains = case.step / case.time, case.domains(inner)
    system, mean = joined(domains), joined(domains, reciprocity="mean")
    late = short_waves(system), short_waves(mean, limit=_OTHER_LIMIT * wavenumber_limit(inner.nodes))
    response, other = (
        impulse_response(s.stiffness, s.dampers, s.forcing, dt=dt, count=case.count, late=damping)
        for s, damping in zip((system, mean), late, strict=True)
    )
    return _Part(inner.dofs, system, response, other)


def _table(parts: list[_Part], case: HybridCase, notes: tuple[str, ...]) -> Retardation:
    """Return SI values of all dofs."""
    t, mesh = case.t, case.mesh
    K, other, A = np.zeros((len(t), 6, 6)), np.zeros((len(t), 6, 6)), np.zeros((6, 6))
    for part in parts:
        i, j = np.ix_(part.dofs, part.dofs)
        A[i, j], K[:, i, j], other[:, i, j] = part.system.added_mass, part.response.K, part.other.K
    unit = case.rho * mesh.radius**2 * np.outer(case.arm, case.arm)
    peak = np.abs(K).max(axis=0)
    scale = np.where(peak > 1e-9 * np.sqrt(np.outer(np.diag(peak), np.diag(peak))), peak, np.nan)
    last = np.abs(K[t >= (1.0 - _LAST) * t[-1]]).max(axis=0)
    return Retardation(
        t,
        case.g * unit * K,
        mesh.radius * unit * A,
        truncation_error=last / scale,
        discretisation_error=np.abs(other - K).max(axis=0) / scale,
        source=case.source,
        notes=notes,
    )


def _remarks(parts: list[_Part], mesh: CurvedMesh, defect: float, floating: list[str]) -> tuple[str, ...]:
    """Return what the user should know."""
    nodes = len(parts[0].system.inner.nodes.weight)
    lowest = min(p.response.least for p in parts)
    notes = [*mesh.notes]
    notes.append(
        f"{nodes} nodes on the stored part, {len(mesh.images) * nodes} on the whole boundary; closed within {defect:.0e}."
    )
    if lowest < -1e-9:
        notes.append(f"a negative eigenvalue of the stiffness, {lowest:.1e} of the largest, was set to zero.")
    return (*notes, *floating)
