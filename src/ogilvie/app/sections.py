"""The sections of a case file: keys, units, defaults and allowed ranges.

Numbers are SI. Degrees and knots appear only where the key says so (``direction_deg``, ``speed_knots``).
"""

from math import radians
from typing import Annotated, Literal

from pydantic import Field

from ogilvie.app.section_base import (
    Angle,
    Finite,
    Lengths3,
    Matrix3,
    NonNegative,
    PerDof,
    Positive,
    Section,
    Text,
    Vector3,
)
from ogilvie.app.section_control import Autopilot, Positioning, SpeedKeeping
from ogilvie.app.section_loads import Current, Damping, HullLift, Mooring, Resistance, Restoring, SlowDrift, Wind

Shape = Literal["s175", "box", "hemisphere", "cylinder", "wigley", "particulars"]
Spectrum = Literal["jonswap", "bretschneider", "pierson-moskowitz", "torsethaugen", "regular", "calm"]


class Vessel(Section):
    """Name, forward speed and heading (anticlockwise from x East)."""

    name: Text = "vessel"
    speed_knots: NonNegative = 0.0
    heading_deg: Angle = 0.0


class Hull(Section):
    """A mesh file, or a shape made here with its parameters (m); depth, from keel to deck, is for restoring at large heel.

    Of a file: `unit` is the length of its unit (m; 0.001 for millimetres), `symmetry` names the planes whose other side it
    leaves out, `offset` is the place of its origin (m from O); `heal` repairs what has one obvious repair, panels with normals
    into the body above all.
    """

    file: Text | None = None
    unit: Positive | None = None
    symmetry: Literal["none", "xz", "xz+yz"] | None = None
    offset: Vector3 | None = None
    heal: bool = False
    shape: Shape | None = None
    draught: Positive | None = None
    depth: Positive | None = None
    panels: Annotated[int, Field(ge=8, le=20000)] = 1000
    length: Positive | None = None
    beam: Positive | None = None
    radius: Positive | None = None
    variant: Literal["I", "II", "III", "IV"] | None = None
    cb: Annotated[float, Field(gt=0, lt=1)] | None = None
    cm: Annotated[float, Field(gt=0, le=1)] | None = None
    cwp: Annotated[float, Field(gt=0, le=1)] | None = None
    lcb: Finite | None = None


class Body(Section):
    """Mass (kg; left out: what the hull displaces), centre of gravity and inertia."""

    mass: Positive | None = None
    kg: Finite | None = None
    zg: Finite | None = None
    cog: Vector3 | None = None
    gyradii: Lengths3 | None = None
    inertia: Matrix3 | None = None


class Water(Section):
    """Density kg/m3, gravity m/s2, depth m (``inf`` for deep water)."""

    rho: Annotated[float, Field(ge=500, le=2000)] = 1025.0
    g: Annotated[float, Field(ge=1, le=30)] = 9.80665
    depth: Annotated[float, Field(gt=0)] = float("inf")


class Coefficients(Section):
    """A file of coefficients, or frequencies and directions for the panel solver.

    At forward speed the panel solver meets each wave at its own frequency (`forward_speed = "panels"`, ten times the work), or
    what it solved at zero speed is carried to the speed by the rule of :func:`ogilvie.at_speed` ("rule", at any speed).
    `solver = "time-domain"` takes :func:`ogilvie.hybrid_hydro` instead: deep water, nothing is kept in the cache.
    """

    file: Text | None = None
    scale: Positive | None = None
    omega: Annotated[list[Positive], Field(min_length=2)] | None = None
    periods: Annotated[list[Positive], Field(min_length=2)] | None = None
    omega_min: Positive | None = None
    omega_max: Positive | None = None
    omega_count: Annotated[int, Field(ge=2, le=1000)] = 40
    directions_deg: Annotated[list[Angle], Field(min_length=1)] | None = None
    irregular_frequencies: bool = True
    forward_speed: Literal["panels", "rule"] = "panels"
    solver: Literal["frequency-domain", "time-domain"] = "frequency-domain"
    cache: bool = True


class Memory(Section):
    """How the fluid memory is kept: a state space with the given R2, or the convolution itself."""

    model: Literal["state-space", "convolution"] = "state-space"
    method: Literal["oscillators", "realization"] = "oscillators"
    r2: Annotated[float, Field(gt=0, lt=1)] = 0.99
    max_order: Annotated[int, Field(ge=1, le=1000)] = 60
    frequencies: Literal["clean", "all"] = "clean"
    cache: bool = True
    duration: Positive | None = None
    dt: Positive | None = None
    tail: Literal["fit", "omega-2", "omega-3", "none"] = "fit"


class Sea(Section):
    """Waves: a spectrum, a regular wave, or calm water. Directions are where waves travel to: 180 deg is head sea.

    Without `components` a sea has the multiples of 2 pi/duration as its frequencies. Random amplitudes make it Gaussian, so
    that its Hs varies from seed to seed as in nature; random phases alone keep Hs. `spreading` is s of cos^2s of half the
    angle from the main direction, or n of cos^n of the angle.
    """

    spectrum: Spectrum = "jonswap"
    hs: Positive | None = None
    tp: Positive | None = None
    gamma: Annotated[float, Field(ge=1, le=20)] = 3.3
    amplitude: Positive | None = None
    period: Positive | None = None
    direction_deg: Angle = 180.0
    spreading: Annotated[float, Field(gt=0, le=200)] | None = None
    spreading_kind: Literal["cos2s", "cosn"] = "cos2s"
    components: Annotated[int, Field(ge=1, le=100000)] | None = None
    method: Literal["equal-frequency", "equal-energy"] = "equal-frequency"
    random: Literal["amplitude", "phase"] = "amplitude"
    seed: Annotated[int, Field(ge=0)] = 1


class Loads(Section):
    """Damping as a fraction of critical; mooring by natural periods (s) or by stiffness (N/m, N m/rad)."""

    damping_ratio: PerDof = PerDof()
    mooring_period: PerDof = PerDof()
    mooring_stiffness: PerDof = PerDof()


class Initial(Section):
    """Pose at the start, for decay tests."""

    surge: Finite = 0.0
    sway: Finite = 0.0
    heave: Finite = 0.0
    roll_deg: Angle = 0.0
    pitch_deg: Angle = 0.0
    yaw_deg: Angle = 0.0

    @property
    def eta(self) -> list[float]:
        """The pose (6,), m and rad."""
        angles = (radians(a) for a in (self.roll_deg, self.pitch_deg, self.yaw_deg))
        return [self.surge, self.sway, self.heave, *angles]


class Simulation(Section):
    """Duration, time step and ramp, s; number of realisations (seeds seed, seed + 1, ...); start of the statistics, s.

    Without a ramp and an initial pose a run starts in the stationary motion, so that there is no transient. Motions are large
    ("auto") where a section that is not linear, steers or holds the vessel is given.
    """

    duration: Positive = 3600.0
    dt: Positive = 0.1
    ramp: NonNegative = 0.0
    method: Literal["rk4", "exact"] = "rk4"
    output_step: Positive | None = None
    realisations: Annotated[int, Field(ge=1, le=100000)] = 1
    skip: NonNegative | None = None
    motions: Literal["auto", "small", "large"] = "auto"
    initial: Initial | None = None


class Output(Section):
    """Where results go, and which."""

    folder: Text | None = None
    figures: bool = True
    report: bool = True


#: Sections without which a file stays as it is; None where they are not given.
OPTIONAL = (
    "hull",
    "body",
    "restoring",
    "damping",
    "resistance",
    "hull_lift",
    "wind",
    "current",
    "slow_drift",
    "mooring",
    "autopilot",
    "speed_keeping",
    "positioning",
)

#: Name of the section in the file -> its model.
SECTIONS: dict[str, type[Section]] = {
    "vessel": Vessel,
    "hull": Hull,
    "body": Body,
    "water": Water,
    "coefficients": Coefficients,
    "memory": Memory,
    "sea": Sea,
    "loads": Loads,
    "damping": Damping,
    "restoring": Restoring,
    "resistance": Resistance,
    "hull_lift": HullLift,
    "wind": Wind,
    "current": Current,
    "slow_drift": SlowDrift,
    "mooring": Mooring,
    "autopilot": Autopilot,
    "speed_keeping": SpeedKeeping,
    "positioning": Positioning,
    "simulation": Simulation,
    "output": Output,
}
