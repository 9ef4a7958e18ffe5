"""What the frequency domain says about a case, beside its simulation."""

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from ogilvie.app.build_memory import at_rest
from ogilvie.app.build_run import make_spreading
from ogilvie.app.case import Case
from ogilvie.errors import InputError, OgilvieWarning
from ogilvie.hydro.schema import DOFS

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.sim.vessel import Vessel

#: Large motions are compared in what the water restores; course and speed belong to control, wind and current.
_RESTORED = ("heave", "roll", "pitch")
_RADIATION = ("added_mass", "radiation_damping")
_FORCES = ("excitation_force", "Froude_Krylov_force", "diffraction_force")


def frequency_domain(case: Case, vessel: "Vessel", hydro: "xr.Dataset", body: Any, spectrum: Any) -> dict[str, Any]:
    """Return responses with the linear damping and springs of the vessel, and what they say about the sea of the case.

    Notes
    -----
    A force -D nu acts on the velocity in body axes, nu = xi' - U L xi, so that at speed it has the stiffness -U D L too
    (:class:`ogilvie.sim.system.LinearSystem`).
    """
    if "excitation_force" not in hydro:
        return {}
    from ogilvie.hydro.rao import rao
    from ogilvie.hydro.response import response_spectrum, response_statistics
    from ogilvie.sim.system import TURNING, assemble

    system = assemble(vessel)
    of_data = np.ix_(*(2 * [[DOFS.index(str(d)) for d in hydro.influenced_dof.values]]))
    extra = (system.stiffness - case.speed * system.damping @ TURNING)[of_data] - hydro.hydrostatic_stiffness.values
    response = rao(under_way(finer(hydro), case.speed), body, stiffness=extra, damping=system.damping[of_data])
    if case.large:
        response = response.sel(dof=[d for d in _RESTORED if d in response.dof.values])
    out: dict[str, Any] = {"response": response}
    if spectrum is not None:
        b = np.radians(case.sea.direction_deg - case.vessel.heading_deg)
        spread = make_spreading(case)
        try:
            out["expected"] = response_statistics(response, spectrum, direction=b, spreading=spread)
            if case.speed == 0.0:
                out["expected_spectra"] = response_spectrum(response, spectrum, direction=b, spreading=spread)
        except InputError as error:
            warnings.warn(f"no comparison with the frequency domain: {error}", OgilvieWarning)
    return out


def under_way(hydro: "xr.Dataset", speed: float) -> "xr.Dataset":
    """Return coefficients at the vessel's speed; those at zero speed are carried there where their parts are known."""
    from ogilvie.hydro.at_speed import at_speed

    if speed == 0.0 or float(hydro.attrs.get("speed", 0.0)) != 0.0:
        return hydro
    if "Froude_Krylov_force" in hydro or "diffraction_force" in hydro:
        return at_speed(hydro, speed)
    forces = {"excitation_force": hydro.excitation_force}
    return at_speed(hydro.drop_vars("excitation_force"), speed).assign(forces)


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
    rest, speed = at_rest(hydro), float(hydro.attrs.get("speed", 0.0))
    made = {key: (rest[key].dims, PchipInterpolator(hydro.omega.values, rest[key].values)(w)) for key in _RADIATION}
    made |= {key: (hydro[key].dims, CubicSpline(hydro.omega.values, hydro[key].values)(w)) for key in _FORCES if key in hydro}
    fine = hydro.drop_dims("omega").assign_coords(omega=w).assign(made)
    if speed == 0.0:
        return fine
    radiation = at_speed(fine.drop_vars([k for k in _FORCES if k in fine]).assign_attrs(speed=0.0), speed)
    return fine.assign({key: radiation[key] for key in _RADIATION})
