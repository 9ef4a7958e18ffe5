"""Control as loads: a law that looks at the vessel once per period, and whose force is held in between."""

from ogilvie.loads.control.autopilot import Autopilot
from ogilvie.loads.control.observer import WaveFilter
from ogilvie.loads.control.positioning import DynamicPositioning
from ogilvie.loads.control.rudder import Rudder
from ogilvie.loads.control.speed import SpeedKeeping
from ogilvie.loads.control.thruster import Thruster
from ogilvie.loads.control.user import UserForce

__all__ = ["Autopilot", "DynamicPositioning", "Rudder", "SpeedKeeping", "Thruster", "UserForce", "WaveFilter"]
