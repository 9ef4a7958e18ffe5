"""The sections of a case file: keys, units, defaults and allowed ranges.

Numbers are SI. Degrees and knots appear only where the key says so (``direction_deg``, ``speed_knots``).
"""

from math import radians
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Finite = Annotated[float, Field(allow_inf_nan=False)]
Fraction = Annotated[float, Field(ge=0, lt=1, allow_inf_nan=False)]
Angle = Annotated[float, Field(ge=-360, le=360, allow_inf_nan=False)]
Text = Annotated[str, Field(min_length=1)]
Vector3 = Annotated[tuple[Finite, Finite, Finite], Field(strict=False)]
Lengths3 = Annotated[tuple[Positive, Positive, Positive], Field(strict=False)]
Row3 = Annotated[tuple[Finite, Finite, Finite], Field(strict=False)]
Matrix3 = Annotated[tuple[Row3, Row3, Row3], Field(strict=False)]

Shape = Literal["s175", "box", "hemisphere", "cylinder", "wigley", "particulars"]
Spectrum = Literal["jonswap", "bretschneider", "pierson-moskowitz", "torsethaugen", "regular", "calm"]


class Section(BaseModel):
    """A table of the case file; unknown keys are mistakes."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class Vessel(Section):
    """Name, forward speed and heading (anticlockwise from x East)."""

    name: Text = "vessel"
    speed_knots: NonNegative = 0.0
    heading_deg: Angle = 0.0


class Hull(Section):
    """A mesh file, or a shape made here with its parameters (m)."""

    file: Text | None = None
    shape: Shape | None = None
    draught: Positive | None = None
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

    rho: Positive = 1025.0
    g: Positive = 9.80665
    depth: Annotated[float, Field(gt=0)] = float("inf")


class Coefficients(Section):
    """A file of coefficients, or frequencies and directions for the panel solver."""

    file: Text | None = None
    scale: Positive | None = None
    omega: Annotated[list[Positive], Field(min_length=2)] | None = None
    periods: Annotated[list[Positive], Field(min_length=2)] | None = None
    omega_min: Positive | None = None
    omega_max: Positive | None = None
    omega_count: Annotated[int, Field(ge=2, le=1000)] = 40
    directions_deg: Annotated[list[Angle], Field(min_length=1)] | None = None
    irregular_frequencies: bool = True
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
    that its Hs varies from seed to seed as in nature; random phases alone keep Hs.
    """

    spectrum: Spectrum = "jonswap"
    hs: Positive | None = None
    tp: Positive | None = None
    gamma: Annotated[float, Field(ge=1, le=20)] = 3.3
    amplitude: Positive | None = None
    period: Positive | None = None
    direction_deg: Angle = 180.0
    spreading: Annotated[float, Field(gt=0, le=200)] | None = None
    components: Annotated[int, Field(ge=1, le=100000)] | None = None
    method: Literal["equal-frequency", "equal-energy"] = "equal-frequency"
    random: Literal["amplitude", "phase"] = "amplitude"
    seed: Annotated[int, Field(ge=0)] = 1


class PerDof(Section):
    """One number per degree of freedom; what is left out is not there."""

    surge: Positive | None = None
    sway: Positive | None = None
    heave: Positive | None = None
    roll: Positive | None = None
    pitch: Positive | None = None
    yaw: Positive | None = None

    @property
    def given(self) -> dict[str, float]:
        """The numbers that the file states."""
        return {dof: value for dof, value in self.model_dump().items() if value is not None}


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

    Without a ramp and an initial pose a run starts in the stationary motion, so that there is no transient.
    """

    duration: Positive = 3600.0
    dt: Positive = 0.1
    ramp: NonNegative = 0.0
    method: Literal["rk4", "exact"] = "rk4"
    output_step: Positive | None = None
    realisations: Annotated[int, Field(ge=1, le=100000)] = 1
    skip: NonNegative | None = None
    initial: Initial | None = None


class Output(Section):
    """Where results go, and which."""

    folder: Text | None = None
    figures: bool = True
    report: bool = True


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
    "simulation": Simulation,
    "output": Output,
}
