"""Retardation functions of a hull straight from the time domain: panels inside a control hemisphere, the open sea outside."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ogilvie.bem.coupled import CoupledSystem, joined, uncoupled
from ogilvie.bem.curved import CurvedMesh
from ogilvie.bem.curved_split import split_at_waterline
from ogilvie.bem.inner import InnerMap, inner_maps
from ogilvie.bem.inner_mesh import default_size, inner_mesh
from ogilvie.bem.outer import depth_functions, outer_mode
from ogilvie.bem.short_waves import short_waves, wavenumber_limit
from ogilvie.bem.stepping import Response, impulse_response
from ogilvie.body import RigidBody
from ogilvie.errors import InputError
from ogilvie.memory.table import Retardation
from ogilvie.mesh.panels import PanelMesh
from ogilvie.units import GRAVITY, SEA_WATER

Array = NDArray[Any]

_DT = 0.035  # default time step over sqrt(control radius / g)
_SIZE = 1.75  # length of panels over the mesher's default
_ROWS, _DEPTH = 6, 3  # rows of panels on the free surface and on the control surface
_FINE = 1.5  # resolution from which on the panels at the waterline are divided twice
_SHARE, _SHARES = (0.15,), (0.25, 0.25)  # of a panel at the waterline that its part next to the waterline gets, once or twice
_MODES, _FUNCTIONS = 17, 12  # azimuthal modes and depth functions of the outer domain
_OTHER_LIMIT = 0.8  # of the wavenumber where damping sets in, in the solution for comparison
_LAST = 0.05  # of the duration, whose largest |K| stands for what is left
_FLOATS = 0.01  # difference of displaced and body's mass that is worth a note


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
    outer: Literal["compressed"] = "compressed",
    rho: float = SEA_WATER,
    g: float = GRAVITY,
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
    outer : {"compressed"}
        The open sea as the passive oscillators of :mod:`ogilvie.bem.outer`.
    rho, g : float
        kg/m3, m/s2.

    Returns
    -------
    Retardation
        About O. `discretisation_error` is the difference of two solutions that treat reciprocity and short waves differently,
        `truncation_error` what is left at the end, both as parts of the largest |K_ij|.

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
    _check(duration, dt, resolution, order, outer, rho, g)
    mesh = hull if isinstance(hull, CurvedMesh) else _mesh(hull, control_radius, resolution)
    time = np.sqrt(mesh.radius / g)
    step = _DT * time if dt is None else dt
    count = int(np.ceil(duration / step - 1e-9)) + 1
    maps, defect = inner_maps(mesh, order=order)
    sea = [outer_mode(m, _FUNCTIONS) for m in range(_MODES)]
    parts = [_solved(inner, sea, np.array(mesh.centre) / mesh.radius, step / time, count) for inner in maps if inner.dofs]
    return _table(parts, mesh, step * np.arange(count), rho, g, _remarks(parts, mesh, defect, _floating(hull, body, rho)))


def _check(duration: float, dt: float | None, resolution: float, order: int, outer: str, rho: float, g: float) -> None:
    positive = {"duration": duration, "dt": 1.0 if dt is None else dt, "rho": rho, "g": g}
    for name, value in positive.items():
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(f"hybrid_bem: {name} > 0 expected, {value!r} found.")
    if dt is not None and dt > duration:
        raise InputError(f"hybrid_bem: a time step up to the duration, {duration:g} s, expected, {dt:g} s found.")
    if not 0.3 <= resolution <= 5.0:
        raise InputError(f"hybrid_bem: resolution 0.3 to 5 expected, {resolution!r} found.")
    if not 2 <= order <= 10:
        raise InputError(f"hybrid_bem: order 2 to 10 expected, {order!r} found.")
    if outer != "compressed":
        raise InputError(f"hybrid_bem: outer='compressed' expected, {outer!r} found.")


def _mesh(hull: PanelMesh, control_radius: float | None, resolution: float) -> CurvedMesh:
    """Return curved panels, smallest at the waterline."""
    mesh = inner_mesh(
        hull,
        control_radius=control_radius,
        size=_SIZE / resolution * default_size(hull),
        rows=max(3, round(_ROWS * resolution)),
        depth=max(2, round(_DEPTH * resolution)),
    )
    for share in _SHARE if resolution < _FINE else _SHARES:
        mesh = split_at_waterline(mesh, share=share)
    return mesh


def _solved(inner: InnerMap, sea: list[Any], centre: Array, dt: float, count: int) -> _Part:
    """Return the solution of one class and the one for comparison."""
    domains = uncoupled(inner, sea, depth_functions, centre=centre)
    system = joined(domains)
    response = impulse_response(system.stiffness, system.dampers, system.forcing, dt=dt, count=count, late=short_waves(system))
    mean = joined(domains, reciprocity="mean")
    late = short_waves(mean, limit=_OTHER_LIMIT * wavenumber_limit(inner.nodes))
    other = impulse_response(mean.stiffness, mean.dampers, mean.forcing, dt=dt, count=count, late=late)
    return _Part(inner.dofs, system, response, other)


def _table(parts: list[_Part], mesh: CurvedMesh, t: Array, rho: float, g: float, notes: tuple[str, ...]) -> Retardation:
    """Return SI values of all dofs."""
    K, other, A = np.zeros((len(t), 6, 6)), np.zeros((len(t), 6, 6)), np.zeros((6, 6))
    for part in parts:
        at = np.ix_(part.dofs, part.dofs)
        A[at] = part.system.added_mass
        for i, j in np.ndindex(len(part.dofs), len(part.dofs)):
            K[:, part.dofs[i], part.dofs[j]] = part.response.K[:, i, j]
            other[:, part.dofs[i], part.dofs[j]] = part.other.K[:, i, j]
    arm = np.where(np.arange(6) < 3, 1.0, mesh.radius)
    unit = rho * mesh.radius**2 * np.outer(arm, arm)
    peak = np.abs(K).max(axis=0)
    scale = np.where(peak > 1e-9 * np.sqrt(np.outer(np.diag(peak), np.diag(peak))), peak, np.nan)
    last = np.abs(K[t >= (1.0 - _LAST) * t[-1]]).max(axis=0)
    return Retardation(
        t,
        g * unit * K,
        mesh.radius * unit * A,
        truncation_error=last / scale,
        discretisation_error=np.abs(other - K).max(axis=0) / scale,
        source=f"hybrid time-domain panel method, {len(mesh.part)} curved panels, control radius {mesh.radius:.4g} m",
        notes=notes,
    )


def _remarks(parts: list[_Part], mesh: CurvedMesh, defect: float, floating: list[str]) -> tuple[str, ...]:
    """Return what the user should know."""
    nodes = len(parts[0].system.inner.nodes.weight)
    lowest = min(p.response.least for p in parts)
    notes = [*getattr(mesh, "notes", ())]
    notes.append(
        f"{nodes} nodes on the stored part, {len(mesh.images) * nodes} on the whole boundary; closed within {defect:.0e}."
    )
    if lowest < -1e-9:
        notes.append(f"a negative eigenvalue of the stiffness, {lowest:.1e} of the largest, was set to zero.")
    return (*notes, *floating)


def _floating(hull: PanelMesh | CurvedMesh, body: RigidBody | None, rho: float) -> list[str]:
    """Return a note where the body does not float at this draught."""
    if body is None or isinstance(hull, CurvedMesh):
        return []
    displaced = rho * hull.immersed().volume
    if abs(displaced / body.mass - 1.0) < _FLOATS:
        return []
    return [f"the hull displaces {displaced:.4g} kg at z = 0, the mass of the body is {body.mass:.4g} kg."]
