"""What the sections of a case file are made of: numbers with their allowed ranges, and tables that know their keys."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Finite = Annotated[float, Field(allow_inf_nan=False)]
Fraction = Annotated[float, Field(ge=0, lt=1, allow_inf_nan=False)]
Angle = Annotated[float, Field(ge=-360, le=360, allow_inf_nan=False)]
Text = Annotated[str, Field(min_length=1)]
Vector3 = Annotated[tuple[Finite, Finite, Finite], Field(strict=False)]
Lengths3 = Annotated[tuple[Positive, Positive, Positive], Field(strict=False)]
Row2 = Annotated[tuple[Finite, Finite], Field(strict=False)]
Row3 = Annotated[tuple[Finite, Finite, Finite], Field(strict=False)]
Row4 = Annotated[tuple[Finite, Finite, Finite, Finite], Field(strict=False)]
Matrix3 = Annotated[tuple[Row3, Row3, Row3], Field(strict=False)]


class Section(BaseModel):
    """A table of the case file; unknown keys are mistakes."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


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
