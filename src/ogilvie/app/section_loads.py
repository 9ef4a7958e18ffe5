"""Sections of a case file on the forces beyond waves and radiation: damping, restoring, resistance, lift, weather, mooring."""

from typing import Annotated, Literal

from pydantic import Field

from ogilvie.app.section_base import Angle, Finite, NonNegative, PerDof, Positive, Row2, Section, Text, Vector3

ShipType = Literal[
    "car carrier",
    "cargo vessel, loaded",
    "cargo vessel, containers on deck",
    "container ship, loaded",
    "destroyer",
    "diving support vessel",
    "drilling vessel",
    "ferry",
    "fishing vessel",
    "liquefied natural gas tanker",
    "offshore supply vessel",
    "passenger liner",
    "research vessel",
    "speed boat",
    "tanker, loaded",
    "tanker, in ballast",
    "tender",
]


class CrossFlow(Section):
    """Drag of the flow across the hull, from its sections; drag coefficients on draught (by default by section) and breadth."""

    cd: Positive | None = None
    cd_vertical: NonNegative = 0.0
    z: Finite | None = None
    strips: Annotated[int, Field(ge=4, le=1000)] = 40


class Ikeda(Section):
    """Roll damping by Ikeda's method, with bilge keels from x = keel_start to keel_end (m from O) of keel_breadth (m)."""

    amplitude_deg: Annotated[float, Field(gt=0, le=60)] = 10.0
    model: Literal["cubic", "quadratic", "linear"] = "cubic"
    keel_start: Finite | None = None
    keel_end: Finite | None = None
    keel_breadth: Positive | None = None


class RollCubic(Section):
    """The roll entry of the cubic damping."""

    roll: Positive


class Damping(Section):
    """Damping on the velocity v through the water: linear v + quadratic |v| v (+ cubic v^3 of roll), SI, about O."""

    linear: PerDof = PerDof()
    quadratic: PerDof = PerDof()
    cubic: RollCubic | None = None
    cross_flow: CrossFlow | None = None
    ikeda: Ikeda | None = None


class Restoring(Section):
    """Linear; "gz": a curve of righting levers, from the hull or a file (deg, m); "hull": the hull cut by the water."""

    kind: Literal["linear", "gz", "hull"] = "linear"
    file: Text | None = None
    max_roll_deg: Annotated[float, Field(ge=10, le=180)] = 60.0
    max_pitch_deg: Annotated[float, Field(ge=1, le=60)] = 8.0


class Resistance(Section):
    """Calm-water resistance: friction line (1 + form_factor) and further coefficients, or a table of speed (m/s), force (N)."""

    file: Text | None = None
    residuary: Text | None = None
    wetted_area: Positive | None = None
    length: Positive | None = None
    form_factor: Annotated[float, Field(gt=-1, le=2)] = 0.0
    allowance: Annotated[float, Field(ge=-0.01, le=0.02)] = 0.0
    astern: Positive = 1.0
    balanced: bool | None = None


class HullLift(Section):
    """Side force of the hull as a wing: draught at the after end and its place x, m; by default those of the hull."""

    draught: Positive | None = None
    x: Finite | None = None


class Blendermann(Section):
    """Wind coefficients by type of ship."""

    type: ShipType
    frontal_area: Positive
    lateral_area: Positive
    length: Positive | None = None
    centroid_height: Positive
    centroid_x: Finite = 0.0


class Isherwood(Section):
    """Wind coefficients by regression of merchant ships."""

    frontal_area: Positive
    lateral_area: Positive
    superstructure_area: NonNegative
    perimeter: Positive
    centroid_from_bow: Positive
    length: Positive | None = None
    beam: Positive | None = None
    masts: Annotated[int, Field(ge=0, le=20)] = 0
    centroid_height: Positive | None = None


class WindTable(Section):
    """Wind coefficients from a file: angle the relative wind blows to (deg, 180 from ahead), CX, CY and, if wanted, CK, CN."""

    file: Text
    frontal_area: Positive
    lateral_area: Positive
    length: Positive | None = None
    symmetry: Literal["xz", "none"] = "xz"


class Wind(Section):
    """Wind of one direction, with or without gusts; its coefficients in exactly one of the three tables."""

    speed: NonNegative | None = None
    speed_knots: NonNegative | None = None
    direction_deg: Angle | None = None
    from_deg: Angle | None = None
    reference_height: Positive = 10.0
    height: Positive = 10.0
    profile: Literal["npd", "power", "uniform"] = "npd"
    gust: Literal["npd", "api", "none"] = "none"
    seed: Annotated[int, Field(ge=0)] | None = None
    blendermann: Blendermann | None = None
    isherwood: Isherwood | None = None
    table: WindTable | None = None


class Current(Section):
    """Steady current; a profile has rows of z (m, 0 and below) and speed (m/s), averaged over the draught."""

    speed: NonNegative | None = None
    speed_knots: NonNegative | None = None
    direction_deg: Angle
    profile: Annotated[list[Row2], Field(min_length=2)] | None = None
    draught: Positive | None = None


class MooringTables(Section):
    """Files of displacement (m; deg for yaw) and force back (N, N m): radial, or surge, sway and yaw."""

    radial: Text | None = None
    surge: Text | None = None
    sway: Text | None = None
    yaw: Text | None = None
    point: Vector3 = (0.0, 0.0, 0.0)
    interpolation: Literal["spline", "monotone"] = "spline"
    beyond: Literal["error", "linear"] = "error"

    @property
    def files(self) -> dict[str, str]:
        """The files that are given, by what they hold."""
        names = {key: getattr(self, key) for key in ("radial", "surge", "sway", "yaw")}
        return {key: name for key, name in names.items() if name is not None}


class Line(Section):
    """One line: anchor in the world, fairlead on the body (m); what is left out is that of [mooring]."""

    anchor: Vector3
    fairlead: Vector3
    length: Positive | None = None
    weight: Positive | None = None
    stiffness: Positive | None = None
    friction: NonNegative | None = None
    grounded: bool | None = None


class MoorDyn(Section):
    """An input file of MoorDyn, called once per period (s; the time step of the simulation where not given)."""

    file: Text
    period: Positive | None = None
    dt: Positive | None = None


class Mooring(Section):
    """Catenary lines (unstretched length m, weight in water N/m, stiffness EA N), tables, or a MoorDyn file: one of them."""

    lines: Annotated[list[Line], Field(min_length=1, max_length=100)] | None = None
    length: Positive | None = None
    weight: Positive | None = None
    stiffness: Positive | None = None
    friction: NonNegative = 0.0
    grounded: bool = True
    linearised: bool = False
    table: MooringTables | None = None
    moordyn: MoorDyn | None = None


class SlowDrift(Section):
    """Mean and slowly varying second-order forces of the waves, from the drift of the coefficients or of the hull.

    Coefficients that hold a mean drift (WAMIT .8, .9; .12d for "full") are taken as they are. Otherwise it is computed from the
    hull by `method`: the far field alone gives surge, sway and yaw; with "auto" heave, roll and pitch have it too, at twice the
    work. At the vessel's speed its mean is the added resistance. Then, and for "full" (which `second_order` belongs to), it
    is computed at `omega_count` frequencies of the sea. `damping` is wave-drift damping, by default at rest where there are
    two or more directions. At speed `short_waves` puts reflection at the waterline in the place of waves that the panels do not
    resolve, and under those shorter than the ship.
    """

    approximation: Literal["newman-arithmetic", "newman-geometric", "newman-1974", "full", "mean"] = "newman-arithmetic"
    method: Literal["far", "near", "control_surface", "auto"] = "far"
    second_order: Literal["none", "pinkster"] = "none"
    omega_count: Annotated[int, Field(ge=4, le=200)] = 16
    short_waves: bool = True
    damping: bool | None = None
