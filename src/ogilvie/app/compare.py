"""What the frequency domain says about a case, beside its simulation."""

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.app.build_run import make_spreading
from ogilvie.app.case import Case
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.at_speed import radiation_at_rest
from ogilvie.hydro.schema import DOFS

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.sim.system import LinearSystem
    from ogilvie.sim.vessel import Vessel

Array = NDArray[np.float64]

#: Large motions are compared in what the water restores; course and speed belong to control, wind and current.
_RESTORED = ("heave", "roll", "pitch")
#: rad/s; waves met more slowly carry a free vessel with them, which is no matter of linear theory.
_CARRIED = 0.05
_BEYOND = "(at_speed: the frequency of encounter|rao: the encounter frequency) exceeds"
_ROUNDS = 6  # of the iteration for damping of roll
_RADIATION = ("added_mass", "radiation_damping")
_FORCES = ("excitation_force", "Froude_Krylov_force", "diffraction_force")


def frequency_domain(case: Case, vessel: "Vessel", hydro: "xr.Dataset", body: Any, spectrum: Any) -> dict[str, Any]:
    """Return responses with the linear damping and springs of the vessel, and what they say about the sea of the case.

    Notes
    -----
    A force -D nu acts on the velocity in body axes, nu = xi' - U L xi, so that at speed it has the stiffness -U D L too
    (:class:`ogilvie.sim.system.LinearSystem`). Large motions have damping of roll B1 p + B2 |p| p + B3 p^3: it is replaced by
    (B1 + sqrt(8/pi) B2 s + 3 B3 s^2) p, which errs least for a Gaussian rate p of standard deviation s, found by iteration.
    """
    if "excitation_force" not in hydro:
        return {}
    from ogilvie.hydro.response import response_spectrum
    from ogilvie.sim.system import assemble, bind_loads

    system, extra_damping = assemble(vessel), np.zeros((6, 6))
    sailing = continued(under_way_quietly(finer(hydro, count=240 if case.large else 400), case.speed))
    last = float(hydro.omega[-1])
    response = _response(case, system, sailing, body, extra_damping, last)
    out: dict[str, Any] = {"response": response}
    if spectrum is None:
        return out
    b = np.radians(case.sea.direction_deg - case.vessel.heading_deg)
    options: Any = {"direction": b, "spreading": make_spreading(case)}
    roll = _roll_beyond_linear(bind_loads(vessel)) if case.large and "roll" in response.dof.values else (0.0, 0.0)
    try:
        out["expected"] = _statistics(response, spectrum, options)
        s = float(np.sqrt(out["expected"].m2.sel(dof="roll"))) if any(roll) else 0.0
        for _ in range(_ROUNDS if any(roll) else 0):
            extra_damping[3, 3] = np.sqrt(8.0 / np.pi) * roll[0] * s + 3.0 * roll[1] * s**2
            out["response"] = response = _response(case, system, sailing, body, extra_damping, last)
            out["expected"] = _statistics(response, spectrum, options)
            s = float(np.sqrt(s * np.sqrt(out["expected"].m2.sel(dof="roll"))))  # halfway, since more damping is less motion
        if case.speed == 0.0:
            out["expected_spectra"] = response_spectrum(response, spectrum, **options)
    except InputError as error:
        warnings.warn(f"no comparison with the frequency domain: {error}", OgilvieWarning)
    return out


def _statistics(response: "xr.DataArray", spectrum: Any, options: Any) -> "xr.Dataset":
    from ogilvie.hydro.response import response_statistics

    return response_statistics(response, spectrum, **options)


def _response(
    case: Case, system: "LinearSystem", hydro: "xr.Dataset", body: Any, extra_damping: Array, last: float
) -> "xr.DataArray":
    """Motions per metre of wave amplitude up to the last frequency (rad/s); of large motions what the water restores."""
    from ogilvie.hydro.rao import rao
    from ogilvie.sim.system import TURNING

    of_data = np.ix_(*(2 * [[DOFS.index(str(d)) for d in hydro.influenced_dof.values]]))
    D = system.damping + extra_damping
    stiffness = (system.stiffness - case.speed * D @ TURNING)[of_data] - hydro.hydrostatic_stiffness.values
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=_BEYOND, category=OgilvieWarning)
        if case.large:  # damping that is not linear is found by iteration
            warnings.filterwarnings("ignore", message="rao: the resonance", category=OgilvieWarning)
        response = rao(hydro, body, stiffness=stiffness, damping=D[of_data]).sel(omega=slice(None, last))
    if case.large:
        response = bridged(response.sel(dof=[d for d in _RESTORED if d in response.dof.values]))
    return response


def _roll_beyond_linear(terms: Any) -> tuple[float, float]:
    """Quadratic and cubic coefficient of the damping of roll."""
    from ogilvie.loads.roll_damping import roll_polynomial

    found = [t.kernel.data for t in terms if t.kernel is not None and t.kernel.function is roll_polynomial]
    return (float(sum(d[0] for d in found)), float(sum(d[1] for d in found)))


def under_way_quietly(hydro: "xr.Dataset", speed: float) -> "xr.Dataset":
    """As :func:`under_way`, without warnings of headings that the sea may not have."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=_BEYOND, category=OgilvieWarning)
        return under_way(hydro, speed)


def bridged(response: "xr.DataArray") -> "xr.DataArray":
    """Return responses with straight lines across the frequencies at which the waves run as fast as the vessel."""
    w, met = response.omega.values, response.encounter_frequency.values
    X = response.values.copy()
    for j in range(X.shape[1]):
        slow = np.abs(met[:, j]) < _CARRIED
        if slow.any() and not slow.all():
            for i in range(X.shape[2]):
                X[slow, j, i] = np.interp(w[slow], w[~slow], X[~slow, j, i])
    return response.copy(data=X)


def under_way(hydro: "xr.Dataset", speed: float) -> "xr.Dataset":
    """Return coefficients at the vessel's speed; those at zero speed are carried there where their parts are known."""
    from ogilvie.hydro.at_speed import at_speed

    if speed == 0.0 or float(hydro.attrs.get("speed", 0.0)) != 0.0:
        return hydro
    if "Froude_Krylov_force" in hydro or "diffraction_force" in hydro:
        return at_speed(hydro, speed)
    forces = {"excitation_force": hydro.excitation_force}
    return at_speed(hydro.drop_vars("excitation_force"), speed).assign(forces)


def continued(hydro: "xr.Dataset") -> "xr.Dataset":
    """Return coefficients at speed with radiation up to the highest frequency of encounter; no wave forces are added there.

    Notes
    -----
    By the continuation of :class:`ogilvie.hydro.speed_terms.FluidMomentum`, as in the rule for wave forces at speed.
    """
    from ogilvie.hydro.speed_terms import fluid_momentum, momentum_at_speed, speed_matrix, split
    from ogilvie.waves.dispersion import encounter_frequency

    U, w = float(hydro.attrs.get("speed", 0.0)), hydro.omega.values
    if U == 0.0:
        return hydro
    water = {"depth": float(hydro.attrs["water_depth"]), "g": float(hydro.attrs["g"])}
    met = np.abs(encounter_frequency(w[:, None], speed=U, direction=hydro.wave_direction.values, **water))
    L = speed_matrix([str(d) for d in hydro.influenced_dof.values])
    if met.max() <= w[-1] or L is None:
        return hydro
    more = np.linspace(w[-1], 1.0001 * met.max(), 61)[1:]
    T = fluid_momentum(hydro, speed=U, L=L).at(more)
    added = dict(zip(_RADIATION, split(momentum_at_speed(T, more, U, L), more), strict=True))
    longer = {}
    for key in [key for key in hydro.data_vars if "omega" in hydro[key].dims]:
        old = hydro[key].transpose("omega", ...)
        rest = added.get(str(key), np.zeros((len(more), *old.shape[1:]), dtype=old.dtype))
        longer[key] = (old.dims, np.concatenate([old.values, rest]))
    return hydro.drop_dims("omega").assign_coords(omega=np.r_[w, more]).assign(longer)


def finer(hydro: "xr.Dataset", *, count: int = 400) -> "xr.Dataset":
    """Return coefficients interpolated to more frequencies, so that resonances between those of the data are seen.

    Added mass and damping monotonically (PCHIP) and without their terms of speed, forces by cubic splines, as the time domain
    has them.
    """
    if hydro.sizes["omega"] >= count:
        return hydro
    from scipy.interpolate import CubicSpline, PchipInterpolator

    from ogilvie.hydro.at_speed import at_speed

    w = np.linspace(float(hydro.omega[0]), float(hydro.omega[-1]), count)
    w[0], w[-1] = hydro.omega.values[0], hydro.omega.values[-1]
    rest, speed = radiation_at_rest(hydro), float(hydro.attrs.get("speed", 0.0))
    made = {key: (rest[key].dims, PchipInterpolator(hydro.omega.values, rest[key].values)(w)) for key in _RADIATION}
    made |= {key: (hydro[key].dims, CubicSpline(hydro.omega.values, hydro[key].values)(w)) for key in _FORCES if key in hydro}
    fine = hydro.drop_dims("omega").assign_coords(omega=w).assign(made)
    if speed == 0.0:
        return fine
    radiation = at_speed(fine.drop_vars([k for k in _FORCES if k in fine]).assign_attrs(speed=0.0), speed)
    return fine.assign({key: radiation[key] for key in _RADIATION})
