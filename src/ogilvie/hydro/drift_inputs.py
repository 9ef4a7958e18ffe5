"""What is asked of the second-order forces, checked: hull and water, and the body that moves."""

import warnings
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ogilvie.body import RigidBody
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.bem_case import Case, Irregular, make_case, warn_if_coarse
from ogilvie.hydro.drift_wave import Dynamics
from ogilvie.hydro.threads import available_cores
from ogilvie.mesh.hydrostatics import hydrostatics
from ogilvie.mesh.panels import PanelMesh

Array = NDArray[np.float64]
Moments = Literal["space", "body"]
WaterlineRule = Literal["edge", "centre"]

_AFLOAT = 0.015  # part of the displacement by which a free body's weight may differ from its buoyancy
_STANDING = 0.01  # part of the frequency below which that of encounter counts as zero
_UPRIGHT = 0.005  # part of length and beam by which the centre of gravity may be off that of buoyancy


def checked_case(
    hull: PanelMesh,
    irregular: Irregular,
    *,
    purpose: str,
    omega: ArrayLike,
    direction: ArrayLike,
    rho: float,
    g: float,
    depth: float,
    speed: float = 0.0,
) -> Case:
    """Return the case of a hull, with messages in the name of `purpose`.

    Raises
    ------
    InputError
        An argument is out of range, or the hull cannot be solved.
    """
    if not isinstance(hull, PanelMesh):
        raise InputError(f"{purpose}: hull: a PanelMesh expected, {type(hull).__name__} found. Read one with load_mesh.")
    try:
        case = make_case(
            hull,
            omega=omega,
            wave_direction=direction,
            rho=rho,
            g=g,
            water_depth=depth,
            speed=speed,
            irregular_frequencies=irregular,
        )
    except InputError as e:
        raise InputError(str(e).replace("solve_bem", purpose)) from None
    fastest = float(np.sqrt(g * hull.length))
    if abs(case.speed) > fastest:
        raise InputError(
            f"{purpose}: speed: up to {fastest:.4g} m/s (Froude number 1) expected, {case.speed:.4g} m/s found: a ship that "
            "planes is beyond this theory. Is the speed in m/s?"
        )
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        warn_if_coarse(case)
    slow = np.argwhere(np.abs(case.encounter) < _STANDING * case.omega[:, None])
    if len(slow):
        i, j = slow[0]
        raise InputError(
            f"{purpose}: waves that move relative to the ship expected, a frequency of encounter of "
            f"{case.encounter[i, j]:.3g} rad/s found at {case.omega[i]:.4g} rad/s in direction "
            f"{np.degrees(case.direction[j]):.4g} deg. Move this frequency or direction a little."
        )
    for warning in caught:
        warnings.warn(str(warning.message).replace("solve_bem", purpose), OgilvieWarning, stacklevel=3)
    return case


def require_words(purpose: str, **given: tuple[object, object]) -> None:
    """Raise InputError where a setting (value, Literal of what is allowed) is another word."""
    for name, (value, allowed) in given.items():
        if value not in get_args(allowed):
            raise InputError(f"{purpose}: {name}: one of {', '.join(get_args(allowed))} expected, {value!r} found.")


def checked_workers(workers: int | None, *, purpose: str) -> int:
    """Return a number of threads, by default that of the cores."""
    if workers is not None and (isinstance(workers, bool) or not isinstance(workers, int) or workers < 1):
        raise InputError(f"{purpose}: workers: a number of threads >= 1 or None expected, {workers!r} found.")
    return workers or available_cores()


def checked_dynamics(
    case: Case, body: RigidBody | None, damping: ArrayLike | None, stiffness: ArrayLike | None, *, purpose: str
) -> Dynamics | None:
    """Return inertia, restoring and external coefficients, None for a fixed hull; warn of a body that does not float.

    Raises
    ------
    InputError
        Matrices of another shape, coefficients without a body.
    """
    external = [_matrix(damping, "damping", purpose), _matrix(stiffness, "stiffness", purpose)]
    if body is None:
        if damping is not None or stiffness is not None:
            raise InputError(f"{purpose}: damping and stiffness act on a body that moves: body expected, none found.")
        return None
    if not isinstance(body, RigidBody):
        raise InputError(f"{purpose}: body: a RigidBody or None (fixed) expected, {type(body).__name__} found.")
    water = hydrostatics(case.panels.hull, body=body, rho=case.rho, g=case.g)
    excess = body.mass / (case.rho * water.volume) - 1.0
    offset = np.abs(body.cog - water.center_of_buoyancy)[:2] / [case.panels.hull.length, case.panels.hull.beam]
    if abs(excess) > _AFLOAT or np.any(offset > _UPRIGHT):
        arm = (body.cog - water.center_of_buoyancy)[:2].round(3).tolist()
        warnings.warn(
            f"{purpose}: a body that floats at rest expected; its mass is {100 * excess:+.1f} % off the displacement, its "
            f"centre of gravity {arm} m (x, y) off that of buoyancy. Energy is not conserved then. Use RigidBody.from_hull, "
            "or another draught and trim.",
            OgilvieWarning,
            stacklevel=3,
        )
    return Dynamics(body.matrix, water.stiffness, *external)


def _matrix(value: ArrayLike | None, name: str, purpose: str) -> Array:
    if value is None:
        return np.zeros((6, 6))
    M = np.asarray(value, dtype=float)
    if M.shape != (6, 6) or not np.all(np.isfinite(M)):
        raise InputError(f"{purpose}: {name}: a finite (6, 6) matrix about O expected, shape {M.shape} found.")
    return M
