"""Forces at the difference of two frequencies from the panel solution: the full quadratic transfer function."""

import warnings

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ogilvie.body import RigidBody
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.bem_case import Case, Irregular
from ogilvie.hydro.drift_inputs import Moments, WaterlineRule, checked_case, checked_dynamics, checked_workers, require_words
from ogilvie.hydro.drift_pairs import Choice, QtfMethod, Quadratic, SecondOrder, quadratic_forces
from ogilvie.hydro.drift_static import Rotation
from ogilvie.hydro.qtf import with_qtf
from ogilvie.hydro.schema import DOFS, hydro_from_arrays
from ogilvie.mesh.panels import PanelMesh
from ogilvie.units import GRAVITY, SEA_WATER

_LIMIT = 0.10  # beyond this part of the largest drift the diagonal is named


def difference_qtf(
    hull: PanelMesh,
    body: RigidBody | None = None,
    *,
    omega: ArrayLike,
    wave_direction: ArrayLike = (np.pi,),
    rho: float = SEA_WATER,
    g: float = GRAVITY,
    water_depth: float = np.inf,
    damping: ArrayLike | None = None,
    stiffness: ArrayLike | None = None,
    second_order: SecondOrder = "none",
    method: QtfMethod = "auto",
    rotation: Rotation = "ZYX",
    moments: Moments = "space",
    waterline: WaterlineRule = "edge",
    pairs: bool = False,
    irregular_frequencies: Irregular = "remove",
    progress: bool | None = None,
    cache: bool = True,
    workers: int | None = None,
) -> xr.Dataset:
    """Return the quadratic transfer function of the forces at the difference of two wave frequencies.

    Parameters
    ----------
    hull : PanelMesh
        Wetted hull (z <= 0, normals into the fluid); its symmetry and its own `lid` are used.
    body : RigidBody, optional
        Floats freely; without it the hull is held fixed.
    omega : (n_w,) array
        Frequencies of both waves, rad/s: two or more. Their step has to resolve the phase of the function.
    wave_direction : (n_b,) array
        Directions that the waves travel to, rad; pi is head seas.
    rho, g, water_depth : float
        kg/m3, m/s2, m (inf for deep water).
    damping, stiffness : (6, 6) array, optional
        About O: external damping and stiffness of the first-order motions.
    second_order : {"none", "pinkster"}
        Leave the potential of second order out, or take that of the incident waves and its diffraction by a scaled
        first-order wave force. That is nothing on the diagonal; in finite depth heave, roll and pitch jump there.
    method : {"auto", "near", "control_surface"}
        "near": pressure on the hull. "control_surface": its squared velocities replaced by those on a surface around the
        hull, for sharp edges. "auto": that, and the near field for the components it does not give.
    rotation, moments, waterline
        As in :func:`ogilvie.mean_drift`.
    pairs : bool
        Add ``qtf_diff_pairs`` for waves of two directions; not with "pinkster".
    irregular_frequencies, progress, cache, workers
        As in :func:`ogilvie.solve_bem`. The cache is that of :func:`ogilvie.mean_drift`.

    Returns
    -------
    xarray.Dataset
        * qtf_diff (omega_1, omega_2, wave_direction, influenced_dof), N/m2 and N m/m2; its attribute `method` names the method
          of each component; qtf_diff_pairs (omega_1, omega_2, qtf_pair, influenced_dof)
        * mean_drift (omega, wave_direction, influenced_dof), its diagonal; mean_drift_momentum, the far field
        * added_mass, radiation_damping, excitation_force, motion_rao: the first order it was made of

        Obeys :mod:`ogilvie.hydro.schema`: ``SlowDrift(result, approximation="full")`` takes it as it is, and
        ``with_qtf(hydro, omega=result.omega_1, qtf_diff=result.qtf_diff)`` puts it into another data set of these directions.

    Raises
    ------
    InputError
        An argument is out of range, or the hull cannot be solved.
    ConvergenceError
        The Green function cannot be evaluated.

    Warns
    -----
    OgilvieWarning
        Surge or sway on the diagonal over 10 % of the largest drift off the far field; a body that does not float; frequencies
        above those that the panels resolve.

    Notes
    -----
    F = Re sum over ordered pairs of a_m a_n* Q_mn exp(i (w_m - w_n) t), Q Hermitian, as in
    :func:`ogilvie.hydro.qtf.with_qtf`. On the diagonal it is the mean drift by the same method. Forces of the water alone:
    inertia of second order belongs to the equations of motion. Without the potential of second order the error grows with the
    difference of frequencies; with "pinkster" scattered waves are still missing from it. Derivation: docs/theory/drift.md.

    References
    ----------
    J. A. Pinkster, Low frequency second order wave exciting forces on floating structures, Delft (1980); X.-B. Chen,
    Middle-field formulation for the computation of wave-drift loads, J. Eng. Math. 59 (2007) 61-82.

    Examples
    --------
    >>> from ogilvie.mesh.shapes import hemisphere
    >>> hull = hemisphere(1.0, panels=100)
    >>> Q = difference_qtf(hull, omega=[3.5, 4.0], rho=1000.0, method="near", cache=False, workers=1).qtf_diff
    >>> Q.shape, bool(np.allclose(Q[0, 1], Q[1, 0].conj())), bool(Q[0, 1, 0, 0].real < 0)  # pushed astern
    ((2, 2, 1, 6), True, True)
    """
    case = checked_case(
        hull,
        irregular_frequencies,
        purpose="difference_qtf",
        omega=omega,
        direction=wave_direction,
        rho=rho,
        g=g,
        depth=water_depth,
    )
    require_words(
        "difference_qtf",
        second_order=(second_order, SecondOrder),
        method=(method, QtfMethod),
        rotation=(rotation, Rotation),
        moments=(moments, Moments),
        waterline=(waterline, WaterlineRule),
    )
    if len(case.omega) < 2:
        raise InputError(
            "difference_qtf: omega: two frequencies or more expected, one found. For one frequency use mean_drift."
        )
    if pairs and second_order != "none":
        raise InputError(
            "difference_qtf: pairs: second_order='none' expected, 'pinkster' found: it holds for waves of one direction."
        )
    threads = checked_workers(workers, purpose="difference_qtf")
    choice = Choice(rotation, waterline == "centre", method, second_order, moments == "body", pairs)
    dynamics = checked_dynamics(case, body, damping, stiffness, purpose="difference_qtf")
    found = quadratic_forces(case, dynamics, choice, cache=cache, workers=threads, progress=progress)
    result = _as_dataset(found, case).assign_attrs(
        moments=moments,
        rotation=rotation,
        waterline=waterline,
        second_order=second_order,
        body="fixed" if body is None else body.name,
    )
    _warn_of_diagonal(result)
    return result


def _as_dataset(found: Quadratic, case: Case) -> xr.Dataset:
    """Return a data set that obeys :mod:`ogilvie.hydro.schema`."""
    hydro = hydro_from_arrays(
        omega=case.omega,
        added_mass=found.added_mass,
        radiation_damping=found.damping,
        wave_direction=case.direction,
        excitation_force=found.excitation,
        motion_rao=found.motion,
        mean_drift=np.einsum("wwbi->wbi", found.same).real,
        rho=case.rho,
        g=case.g,
        water_depth=case.depth,
        name=case.panels.hull.name,
        source="ogilvie.difference_qtf",
    )
    hydro["mean_drift_momentum"] = hydro.mean_drift.dims, found.far
    result = with_qtf(hydro, omega=case.omega, qtf_diff=found.same)
    taken = ", ".join(f"{dof}: {name}" for dof, name in zip(DOFS, found.method, strict=True))
    result.qtf_diff.attrs["method"] = taken
    if found.pairs is None:
        return result
    n = len(case.direction)
    two = np.stack([np.repeat(case.direction, n), np.tile(case.direction, n)], axis=1)
    return with_qtf(result, omega=case.omega, qtf_diff=found.pairs, direction_pairs=two)


def _warn_of_diagonal(result: xr.Dataset) -> None:
    diagonal = np.einsum("wwbi->wbi", result.qtf_diff.values).real[..., :2]
    far = result.mean_drift_momentum.values[..., :2]
    difference = float(np.abs(diagonal - far).max() / max(np.abs(far).max(), np.finfo(float).tiny))
    if difference > _LIMIT:
        warnings.warn(
            f"difference_qtf: a diagonal that is the drift of the far field expected, {100 * difference:.2g} % of the largest "
            "surge and sway drift between them found. Use a finer mesh, method='control_surface', or frequencies that the mesh "
            "resolves.",
            OgilvieWarning,
            stacklevel=3,
        )
