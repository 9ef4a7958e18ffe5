"""Mean drift forces from the panel solution, by three methods side by side."""

import warnings

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ogilvie.body import RigidBody
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.bem_case import Irregular
from ogilvie.hydro.drift_inputs import Moments, WaterlineRule, checked_case, checked_dynamics, checked_workers, require_words
from ogilvie.hydro.drift_result import Method, as_dataset
from ogilvie.hydro.drift_run import Options, drifts
from ogilvie.hydro.drift_static import Rotation
from ogilvie.mesh.panels import PanelMesh
from ogilvie.units import GRAVITY, SEA_WATER


def mean_drift(
    hull: PanelMesh,
    body: RigidBody | None = None,
    *,
    omega: ArrayLike,
    wave_direction: ArrayLike = (np.pi,),
    rho: float = SEA_WATER,
    g: float = GRAVITY,
    water_depth: float = np.inf,
    speed: float = 0.0,
    damping: ArrayLike | None = None,
    stiffness: ArrayLike | None = None,
    method: Method = "auto",
    rotation: Rotation = "ZYX",
    moments: Moments = "space",
    waterline: WaterlineRule = "edge",
    pairs: bool = False,
    irregular_frequencies: Irregular = "remove",
    progress: bool | None = None,
    cache: bool = True,
    workers: int | None = None,
) -> xr.Dataset:
    """Return the mean second-order wave forces on a hull, per square metre of wave amplitude.

    Parameters
    ----------
    hull : PanelMesh
        Wetted hull (z <= 0, normals into the fluid); its symmetry and its own `lid` are used.
    body : RigidBody, optional
        Floats freely; without it the hull is held fixed.
    omega : (n_w,) array
        Frequencies, rad/s.
    wave_direction : (n_b,) array
        Directions that the waves travel to, rad; pi is head seas.
    rho, g, water_depth : float
        kg/m3, m/s2, m (inf for deep water).
    speed : float
        Forward speed, m/s: ``-mean_drift`` in surge is the added resistance then.
    damping, stiffness : (6, 6) array, optional
        About O: external damping (viscous roll damping) and stiffness (mooring), added to those of water and gravity.
    method : {"auto", "near", "far", "control_surface"}
        What ``mean_drift`` is taken from. "auto": surge, sway and, at rest, yaw from the far field, the others from the control
        surface (or, around several waterlines, the near field). "near" and "far" leave the control surface out, which nearly
        halves the work. At speed the far field is for deep water; "auto" takes the control surface elsewhere.
    rotation : {"ZYX", "XYZ"}
        Order of the rotations: Rz Ry Rx (this package) or Rx Ry Rz (WAMIT); heave, roll and pitch differ.
    moments : {"space", "body"}
        About the fixed mean origin, or about the origin that moves with the body (WAMIT's negative modes).
    waterline : {"edge", "centre"}
        "centre": the near field as codes of flat panels do it, for comparison with WAMIT's ``.9`` files on the same mesh: the
        elevation is taken at the centres of the panels along the waterline, flare and velocity are as the panels give them
        (:mod:`ogilvie.hydro.drift_centre`). It is up to 70 % off where "edge" is within 1 %. At rest only.
    pairs : bool
        Add ``mean_drift_pairs`` for two waves of one frequency from different directions; at rest, since at speed they are met
        at different frequencies.
    irregular_frequencies, progress, cache, workers
        As in :func:`ogilvie.solve_bem`.

    Returns
    -------
    xarray.Dataset
        Dims omega, wave_direction, influenced_dof; N/m2 and N m/m2.

        * mean_drift; mean_drift_pressure (near field, about the fixed origin), mean_drift_pressure_body (about the moving
          one), mean_drift_control_surface, mean_drift_momentum (far field, NaN in heave, roll, pitch); mean_drift_pairs
        * pressure_terms, control_surface_terms: the terms (term first) that these are sums of, about the fixed origin
        * energy_imbalance: wave energy radiated, scattered and damped less that taken from the incident wave, as a part of it
        * difference_pressure, difference_control_surface: distance from the far field, as a part of the largest value over all
          directions at that frequency
        * flag_energy (imbalance above 2 %, at speed 25), flag_pressure, flag_control_surface (difference above 10 %, at speed
          50), flag_vertical (heave, roll or pitch by near field and control surface more than half apart)
        * motion_rao: the motions
        * at speed: encounter_frequency (signed), flag_slow_encounter (U omega_e/g below 1/4)

        :class:`ogilvie.SlowDrift` takes the result as it is, or several of them at different speeds;
        ``hydro.assign(mean_drift=drift.mean_drift)`` puts it into a data set of the same frequencies and directions. The
        attribute `summary` tells in words how good it is.

    Raises
    ------
    InputError
        An argument is out of range, or the hull cannot be solved; waves that the ship keeps pace with (omega_e = 0).
    ConvergenceError
        The Green function cannot be evaluated.

    Warns
    -----
    OgilvieWarning
        Energy out of balance, or the method asked for off the far field, beyond the limits of the flags; a body that does not
        float; frequencies above those that the panels resolve.

    Notes
    -----
    Forces of the water on the body: weight, mooring and viscous forces are not among them. Formulas, derivations and what was
    measured: docs/theory/drift.md. Near field: :mod:`ogilvie.hydro.drift_near`; far field: :mod:`ogilvie.hydro.drift_far`;
    control surface: :mod:`ogilvie.hydro.drift_control`.

    At speed `omega` is the frequency of the incident waves, and the first order is that of :func:`ogilvie.solve_bem`: the Green
    function of zero speed at the frequency of encounter, uniform flow past the hull. Near field and control surface then hold
    (d/dt - U d/dx) in place of d/dt throughout; the far field is Maruo's with the waves that a moving ship makes
    (:mod:`ogilvie.hydro.drift_maruo`). Near field and control surface give peaks of added resistance 40 to 90 % above the far
    field's, which is the one close to model tests (docs/theory/drift.md). That is for slender hulls under way: slow motion of
    blunt bodies is for :class:`ogilvie.WaveDriftDamping`. In waves shorter than about half the ship both underestimate added
    resistance, that of a full hull by far: reflection at the waterline is :func:`ogilvie.short_wave_drift`, and
    :func:`ogilvie.joined_drift` raises the result to it.

    At sharp edges the velocity is infinite and its square near the edge is badly resolved by panels: there the near field is
    for comparison only, while the other two need no velocity on the hull.

    References
    ----------
    H. Maruo, The drift of a body floating on waves, J. Ship Research 4 (1960); J. N. Newman, The drift force and moment on
    ships in waves, J. Ship Research 11 (1967); J. A. Pinkster, Low frequency second order wave exciting forces on floating
    structures, Delft (1980); X.-B. Chen, Middle-field formulation for the computation of wave-drift loads, J. Eng. Math. 59
    (2007) 61-82. With forward speed: paper D (Somayajula and Falzarano 2016), Eqs. (1)-(39).

    Examples
    --------
    >>> from ogilvie.mesh.shapes import hemisphere
    >>> drift = mean_drift(hemisphere(1.0, panels=100), omega=[4.0], rho=1000.0, cache=False, workers=1)
    >>> drift.mean_drift.sizes["influenced_dof"], bool(drift.mean_drift.sel(influenced_dof="surge") < 0)  # pushed astern
    (6, True)
    """
    case = checked_case(
        hull,
        irregular_frequencies,
        purpose="mean_drift",
        omega=omega,
        direction=wave_direction,
        rho=rho,
        g=g,
        depth=water_depth,
        speed=speed,
    )
    require_words(
        "mean_drift",
        method=(method, Method),
        rotation=(rotation, Rotation),
        moments=(moments, Moments),
        waterline=(waterline, WaterlineRule),
    )
    if speed != 0.0 and pairs:
        raise InputError(
            "mean_drift: pairs: False expected at speed, where waves of two directions are met at two frequencies."
        )
    if speed != 0.0 and waterline == "centre":
        raise InputError(
            "mean_drift: waterline: 'edge' expected at speed, 'centre' found: it is there to compare with codes at rest."
        )
    if speed != 0.0 and method == "far" and np.isfinite(water_depth):
        raise InputError(
            f"mean_drift: method: deep water expected for the far field at speed, {water_depth:.4g} m found. "
            "Take 'control_surface' or 'near'."
        )
    options = Options(
        rotation=rotation,
        centre=waterline == "centre",
        control=method in ("auto", "control_surface"),
        cache=cache,
        workers=checked_workers(workers, purpose="mean_drift"),
        progress=progress,
    )
    found = drifts(case, checked_dynamics(case, body, damping, stiffness, purpose="mean_drift"), options)
    result = as_dataset(case, found, method=method, moments=moments, pairs=pairs)
    result = result.assign_attrs(rotation=rotation, waterline=waterline, body="fixed" if body is None else body.name)
    _warn_of_flags(result, method)
    return result


def _warn_of_flags(result: xr.Dataset, method: Method) -> None:
    compared = {"near": "flag_pressure", "far": "flag_energy"}.get(method, "flag_control_surface")
    if bool(result.flag_energy.any()) or bool(result[compared].any()):
        warnings.warn(f"mean_drift: {result.attrs['summary']}", OgilvieWarning, stacklevel=3)
