"""Simulation in the time domain."""

import time as clock
from collections.abc import Sequence
from typing import Any

import xarray as xr
from numpy.typing import NDArray

from ogilvie.errors import ConvergenceError, InputError
from ogilvie.sim.engine import Initial, make_engine, positive
from ogilvie.sim.result import VARIABLES, case_hash, check_variables, to_dataset, versions
from ogilvie.sim.run import Run
from ogilvie.sim.vessel import Vessel
from ogilvie.waves.field import Sea

Array = NDArray[Any]


def simulate(
    vessel: Vessel,
    sea: Sea | None = None,
    *,
    duration: float,
    dt: float = 0.1,
    ramp: float = 0.0,
    initial: Initial = None,
    method: str = "rk4",
    motions: str | None = None,
    output_step: float | None = None,
    variables: Sequence[str] = VARIABLES,
    progress: bool | None = None,
) -> xr.Dataset:
    """Simulate the motions of a vessel in the time domain.

    Parameters
    ----------
    vessel : Vessel
        Body, loads, speed and heading.
    sea : Sea, optional
        Calm water where it is not given. The realisations of a sea with an axis for them run in parallel.
    duration : float
        s, > 0; rounded up to whole steps.
    dt : float
        Time step, s.
    ramp : float
        The sea grows from nothing during this time, s (sin^2).
    initial : State, mapping or str, optional
        ``"steady"``: the stationary motion in the sea, so that there is no transient to cut off; ``"rest"``: no motion before
        t = 0; or a State (or mapping) with eta and nu, e.g. for a free decay. By default ``"steady"`` in a sea without a ramp
        and ``"rest"`` otherwise.
    method : {"rk4", "exact"}
        Classical Runge-Kutta method, or the matrix exponential of a vessel with a state-space memory (any dt).
    motions : {"small", "large"}, optional
        ``"small"``: linear equations about the steady frame; eta is the displacement from it and nu the velocity in body axes
        less the steady speed. ``"large"``: any heading, roll and pitch; eta is the pose in the world and nu the whole velocity
        in body axes. By default ``"large"`` where a load is not linear, steers or holds the vessel, or water flows past it.
    output_step : float, optional
        Time between outputs, s, a multiple of dt; dt by default.
    variables : sequence of str
        What to keep, out of eta, nu, acceleration, elevation, forces, signals (of control laws: rudder angle, thrust ...).
    progress : bool, optional
        Show a progress bar; by default in a terminal, when the run takes more than 2 s.

    Returns
    -------
    xarray.Dataset
        dims (realisation,) time, dof; eta, nu, acceleration, elevation, force_<load> (on the body, about O); attrs versions,
        seeds, case_hash, wall_time, dt, complete (0 where an interrupt ended the run early).

    Raises
    ------
    InputError
        Arguments outside their range; dt beyond stability (the message gives one that works); a sea that the loads do not
        cover.
    ConvergenceError
        The motion diverges. Its attribute ``result`` holds what was computed before.

    Notes
    -----
    Small motions at zero speed: (M + A_inf) nu' + D nu + C eta + mu(t) = F_wave(t) + F_const, eta' = nu, in the steady frame
    that moves with the vessel's speed and heading and is at the origin of the sea at t = 0; mu = int K(s) nu(t - s) ds, a state
    space or a convolution. With speed :class:`ogilvie.sim.system.LinearSystem` tells what is added; the equations of large
    motions, which tend to those of small ones, stand in :mod:`ogilvie.sim.large_kernel` (docs/theory/sailing.md).

    References
    ----------
    Cummins (1962); Ogilvie (1964); paper A (Yuan), Eq. (1); paper C (Vu), Eqs. (9), (27).

    Examples
    --------
    >>> import numpy as np
    >>> from ogilvie.body import RigidBody
    >>> from ogilvie.loads.restoring import LinearRestoring
    >>> body = RigidBody(mass=1.0, cog=[0, 0, 0], inertia=np.eye(3))
    >>> ship = Vessel(body, loads=(LinearRestoring(np.diag([0, 0, 4.0, 0, 0, 0])),))
    >>> run = simulate(ship, duration=1.0, dt=0.01, initial={"eta": [0, 0, 1.0, 0, 0, 0]})
    >>> round(float(run.eta.sel(dof="heave")[-1]), 6)  # cos(2)
    -0.416147
    """
    began = clock.perf_counter()
    positive(duration, "duration", "s")
    names = check_variables(variables)
    engine = make_engine(vessel, sea, dt=dt, method=method, ramp=ramp, motions=motions)
    run = Run.begin(engine, initial, duration, _stride(output_step, dt), names)
    trouble = run.go(progress)
    seeds = () if sea is None else sea.seeds
    batched = engine.seaway is not None and engine.seaway.batched
    done = {key: values[:, : run.rows] for key, values in run.series.items()}
    result = to_dataset(done, run.times(), batched=batched, seeds=seeds, large=engine.large, signals=engine.signals)
    result.attrs = {
        "dt": float(dt),
        "method": method,
        "motions": "large" if engine.large else "small",
        "ramp": float(ramp),
        "speed": vessel.speed,
        "heading": vessel.heading,
        "complete": int(trouble is None),
        "seeds": [int(s) for s in seeds],
        "versions": versions(),
        "case_hash": case_hash(vessel, sea, duration, dt, ramp, initial, method, motions, output_step),
        "wall_time": clock.perf_counter() - began,
    }
    if isinstance(trouble, ConvergenceError):
        trouble.result = result  # type: ignore[attr-defined]
        raise trouble
    return result


def _stride(output_step: float | None, dt: float) -> int:
    """Return the number of steps between outputs."""
    if output_step is None:
        return 1
    positive(output_step, "output_step", "s")
    positive(dt, "dt", "s")
    stride = round(output_step / dt)
    if stride < 1 or abs(stride * dt - output_step) > 1e-6 * dt:
        raise InputError(f"output_step: a multiple of dt = {dt:g} s expected, {output_step:g} s found.")
    return stride
