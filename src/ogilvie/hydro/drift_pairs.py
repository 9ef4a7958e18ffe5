"""Pairs of frequencies: first-order quantities of all waves side by side, and the forms of the second order over them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ogilvie.hydro.bem_case import SHALLOWEST, Case
from ogilvie.hydro.drift_control import OnSurface, control_terms, on_surface
from ogilvie.hydro.drift_far import far_field
from ogilvie.hydro.drift_forms import cross_mean
from ogilvie.hydro.drift_near import OnHull, near_terms, on_hull
from ogilvie.hydro.drift_second import bound_force, wavenumbers
from ogilvie.hydro.drift_solver import Solver
from ogilvie.hydro.drift_static import Rotation
from ogilvie.hydro.drift_surface import control_surface
from ogilvie.hydro.drift_wave import Dynamics, Wave
from ogilvie.hydro.progress import tracked

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Complex = NDArray[np.complex128]
SecondOrder = Literal["none", "pinkster"]
QtfMethod = Literal["auto", "near", "control_surface"]


@dataclass(frozen=True)
class Choice:
    """How the forces are evaluated; see :func:`ogilvie.hydro.drift_qtf.difference_qtf`."""

    rotation: Rotation
    centre: bool
    method: QtfMethod
    second_order: SecondOrder
    about_body: bool
    pairs: bool


@dataclass(frozen=True, eq=False)
class Quadratic:
    """Forces at the difference of two frequencies.

    Parameters
    ----------
    same : (n_w, n_w, n_b, 6) complex array
        Both waves of one direction.
    pairs : (n_w, n_w, n_b n_b, 6) complex array or None
        Waves of two directions.
    method : tuple of str
        Of each component.
    far : (n_w, n_b, 6) array
        Mean drift of the far field.
    added_mass, damping : (n_w, 6, 6) array
    excitation, motion : (n_w, n_b, 6) complex array
        First order.
    """

    same: Complex
    pairs: Complex | None
    method: tuple[str, ...]
    far: Array
    added_mass: Array
    damping: Array
    excitation: Complex
    motion: Complex


def quadratic_forces(
    case: Case, dynamics: Dynamics | None, choice: Choice, *, cache: bool, workers: int, progress: bool | None
) -> Quadratic:
    """Return the forces of every pair of frequencies of a case."""
    solver = Solver(case, cache=cache, workers=workers)
    surface = None
    if choice.method != "near":
        surface = control_surface(solver.hull, k=float(case.k.max()), depth=case.depth)
    waves, beside, outer, far, radiation, excitation = [], [], [], [], [], []
    for i in tracked(range(len(case.omega)), show=progress, title=f"second order of {case.panels.hull.name}"):
        wave = _wave(case, float(case.omega[i]), float(case.k[i]))
        first = solver.first_order(wave, dynamics)
        waves.append(on_hull(first))
        if choice.centre:
            beside.append(on_hull(solver.first_order_at_centres(wave, dynamics)))
        radiation.append(first.radiation)
        excitation.append(first.excitation)
        far.append(np.einsum("bbi->bi", far_field(first).force).real)
        if surface is not None:
            where = f"control{len(surface.points)}"
            outer.append(on_surface(first, surface, solver.at_surface(first.wave, surface, first.fields, where=where)))
    bound = _bound(case, solver, choice)
    solver.finish()
    n_w, n_b = len(case.omega), len(case.direction)
    groups = [np.arange(n_b)] if choice.pairs else [np.array([b]) for b in range(n_b)]
    forms, methods = zip(*[_form(waves, beside or waves, outer, group, solver, case, choice) for group in groups], strict=True)
    A, B = (np.array(values) for values in zip(*radiation, strict=True))
    order = np.array(far), A, B, np.array(excitation), np.array([w.motion for w in waves])
    if choice.pairs:
        full = forms[0].reshape(n_w, n_b, n_w, n_b, 6)
        pairs = full.transpose(0, 2, 1, 3, 4).reshape(n_w, n_w, n_b * n_b, 6)
        return Quadratic(np.einsum("pbqbi->pqbi", full), pairs, methods[0], *order)
    return Quadratic(np.stack(forms, axis=2) + bound, None, methods[0], *order)


def _wave(case: Case, omega: float, k: float) -> Wave:
    return Wave(omega, k, case.direction, case.depth, case.rho, case.g)


def _form(
    waves: list[OnHull],
    beside: list[OnHull],
    outer: list[OnSurface],
    group: Ints,
    solver: Solver,
    case: Case,
    choice: Choice,
) -> tuple[Complex, tuple[str, ...]]:
    """Return the force (m, m, 6) of the waves of a group of directions at all frequencies, m = n_w len(group).

    `beside` has the first order of the near field.
    """
    all_waves, near_waves = (_side_by_side(each, group) for each in (waves, beside))
    hull, rotation, rho, g = solver.hull, choice.rotation, case.rho, case.g
    near = np.sum(list(near_terms(near_waves, hull, rotation=rotation, rho=rho, g=g).values()), axis=0)
    best, chosen = near, ["near"] * 6
    if outer:
        around = _around(outer, group)
        terms = control_terms(all_waves, around, hull, rotation=rotation, rho=rho, g=g)
        control = np.sum(list(terms.values()), axis=0)
        known = np.all(np.isfinite(control), axis=(0, 1))
        best = np.where(known, control, near if choice.method == "auto" else np.nan)
        chosen = ["control_surface" if yes else "near" if choice.method == "auto" else "none" for yes in known]
    if choice.about_body:
        best = best.copy()
        shift, near_shift = (cross_mean(each.motion[:, :3], each.force) for each in (all_waves, near_waves))
        best[..., 3:] -= np.where([name == "near" for name in chosen[3:]], near_shift, shift)
    return np.asarray(0.5 * (best + best.conj().swapaxes(0, 1))), tuple(chosen)  # rounding would show where all is zero


def _side_by_side(waves: Sequence[OnHull], group: Ints) -> OnHull:
    names = ("omega", "motion", "velocity", "loads", "momentum", "elevation", "potential", "force")
    parts = {name: np.concatenate([getattr(w, name)[group] for w in waves]) for name in names}
    return OnHull(**parts, line=waves[0].line, speed=0.0)


def _around(outer: Sequence[OnSurface], group: Ints) -> OnSurface:
    phi = [np.concatenate([o.phi[i][group] for o in outer]) for i in range(4)]
    v = [np.concatenate([o.v[i][group] for o in outer]) for i in range(4)]
    K, excess = (
        np.concatenate([part[group] for part in parts]) for parts in zip(*((o.K, o.excess) for o in outer), strict=True)
    )
    return OnSurface(outer[0].surface, K, phi, v, excess)


def _bound(case: Case, solver: Solver, choice: Choice) -> Complex:
    """Return the force (n_w, n_w, n_b, 6) of the incident waves' potential of second order, zero if it is left out."""
    shape = (len(case.omega), len(case.omega), len(case.direction), 6)
    if choice.second_order == "none":
        return np.zeros(shape, dtype=complex)
    k = wavenumbers(case.k, length=case.panels.hull.length, depth=case.depth, least=SHALLOWEST)
    omega = np.sqrt(case.g * k * (1.0 if np.isinf(case.depth) else np.tanh(k * case.depth)))
    M0, M1, _ = case.panels.hull.moments
    about = np.array([M1[2, 1] - M1[1, 2], M1[0, 2] - M1[2, 0], M1[1, 0] - M1[0, 1]])  # integral of x x n
    still = -case.rho * case.g * np.tile(np.concatenate([M0, about]), (shape[2], 1))
    waves = [_wave(case, float(w), float(x)) for w, x in zip(omega, k, strict=True)]
    X = np.array([still, *(solver.first_order(wave, None).excitation for wave in waves)])
    nodes = np.concatenate([[0.0], k])
    parts = [
        bound_force(case.omega, case.k, nodes=nodes, excitation=X[:, b], depth=case.depth, g=case.g) for b in range(shape[2])
    ]
    return np.stack(parts, axis=2)
