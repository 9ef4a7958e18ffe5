"""From motions about the steady frame of a vessel to its pose in the world."""

from dataclasses import dataclass
from math import cos, sin
from typing import Any

import numpy as np

from ogilvie.errors import InputError
from ogilvie.sim.state import State


@dataclass(frozen=True)
class SteadyFrame:
    """The frame that moves with a vessel's mean speed and heading; it leaves the world's origin at t = 0.

    Parameters
    ----------
    speed : float
        m/s.
    heading : float
        Anticlockwise from the world's x axis, rad.

    Raises
    ------
    InputError
        Speed or heading not finite.

    Examples
    --------
    >>> ahead = SteadyFrame(speed=9.0, heading=np.pi / 2).in_world(State(eta=[0, 0, 0.5, 0, 0, 0], time=10.0))
    >>> ahead.eta.round(6), ahead.nu
    (array([ 0. , 90. , 0.5 , 0. , 0. , 1.570796]), array([9., 0., 0., 0., 0., 0.]))
    """

    speed: float = 0.0
    heading: float = 0.0

    def __post_init__(self) -> None:
        if not (np.isfinite(self.speed) and np.isfinite(self.heading)):
            raise InputError(f"SteadyFrame: a finite speed and heading expected, {self.speed!r}, {self.heading!r} found.")

    def in_world(self, state: State) -> State:
        """Return pose in the world and velocity in body axes of a state that is given in this frame.

        Notes
        -----
        x = Rz(psi0) (eta + (U t, 0, 0)), psi = psi0 + eta_6; the velocity of small motions is that in body axes less U.
        """
        eta = state.eta
        c, s = cos(self.heading), sin(self.heading)
        along = eta[0] + self.speed * state.time
        pose: Any = np.array([c * along - s * eta[1], s * along + c * eta[1], *eta[2:5], eta[5] + self.heading])
        nu = state.nu + np.array([self.speed, 0.0, 0.0, 0.0, 0.0, 0.0])
        return State(pose, nu, memory=state.memory, time=state.time)
