"""Sections of a case file on control: autopilot, speed keeping, dynamic positioning."""

from typing import Annotated, Literal

from pydantic import Field

from ogilvie.app.section_base import Angle, Finite, Fraction, NonNegative, Positive, Row2, Row4, Section, Text

Frequency = Annotated[float, Field(gt=0, le=2, allow_inf_nan=False)]
Ratio = Annotated[float, Field(ge=0.1, le=5, allow_inf_nan=False)]
Factor = Annotated[float, Field(gt=0, le=3, allow_inf_nan=False)]


class Rudder(Section):
    """Rudder: area m2, aspect ratio, centre of the blade m from O (by default the after end of the hull, half its draught)."""

    area: Positive
    aspect_ratio: Positive = 1.5
    x: Finite | None = None
    y: Finite = 0.0
    z: Finite | None = None
    max_angle_deg: Annotated[float, Field(gt=0, le=45)] = 35.0
    rate_deg: Positive = 2.32
    inflow: Factor = 1.0
    straightening: Annotated[float, Field(ge=0, le=2)] = 1.0
    drag_deduction: Fraction = 0.0
    hull_interaction: Annotated[float, Field(ge=0, le=2)] = 0.0
    hull_position: Finite = 0.0


class Autopilot(Section):
    """Heading control by a rudder, or by a yaw moment of at most max_moment (N m).

    The heading is that of the vessel where not given; a schedule has rows of time (s) and heading (deg).
    """

    heading_deg: Angle | None = None
    schedule: Annotated[list[Row2], Field(min_length=1)] | None = None
    rudder: Rudder | None = None
    max_moment: Positive | None = None
    natural_frequency: Frequency = 0.06
    damping: Ratio = 1.0
    max_rate_deg: Positive | None = None
    wave_filter: bool = False
    period: Positive = 0.5


class SpeedKeeping(Section):
    """Thrust that keeps a speed through the water (or over ground); that of the vessel where not given."""

    speed_knots: NonNegative | None = None
    over_ground: bool = False
    natural_frequency: Frequency = 0.02
    damping: Ratio = 1.0
    max_thrust: Positive | None = None
    max_reverse: NonNegative | None = None
    rate: Positive | None = None
    z: Finite = 0.0
    period: Positive = 0.5


class Thruster(Section):
    """A thruster at x, y, z (m from O): with a fixed direction (deg from forward to port), or one that turns (azimuth)."""

    name: Text | None = None
    x: Finite
    y: Finite = 0.0
    z: Finite = 0.0
    kind: Literal["fixed", "tunnel", "azimuth"]
    direction_deg: Angle | None = None
    max_thrust: Positive
    max_reverse: NonNegative | None = None
    rate: Positive | None = None


class Positioning(Section):
    """Dynamic positioning: position and heading in the world, or a schedule with rows of time (s), x, y (m), heading (deg).

    Without thrusters the wanted force acts directly.
    """

    x: Finite = 0.0
    y: Finite = 0.0
    heading_deg: Angle | None = None
    schedule: Annotated[list[Row4], Field(min_length=1)] | None = None
    thrusters: Annotated[list[Thruster], Field(min_length=1, max_length=30)] | None = None
    natural_frequency: Frequency = 0.06
    damping: Ratio = 1.0
    wave_filter: bool = True
    max_speed: Positive | None = None
    max_rate_deg: Positive | None = None
    period: Positive = 0.5
