"""What the two-phase probe found, and what it means."""

from dataclasses import dataclass

import numpy as np

_PHASE_TOLERANCE = 30.0  # deg


@dataclass(frozen=True)
class ProbeResult:
    """What long waves say about the conventions of a data set.

    Parameters
    ----------
    heave_ratio : float
        Im F3 / (omega B33), averaged over b and b + pi: +1 for exp(+i omega t), -1 for exp(-i omega t); NaN: not possible.
    surge_phase : float
        Phase of F1 in waves that travel to +x, deg: +90 expected; NaN: not possible.
    sway_phase : float
        Phase of F2 in waves that travel to +y, deg: +90 expected; NaN: not possible.
    heave_sign : float
        Sign of Re F3 in long waves: +1 expected where there is a waterplane; NaN: not possible.
    short_waves : float
        |F3| in the shortest waves as part of C33 or of the largest |F3|; NaN: no waves with k R > 5.
    omega : tuple of float
        Frequencies that were judged, rad/s.
    size : float
        k R at the highest of them.
    notes : tuple of str
        What was not possible and why.
    """

    heave_ratio: float
    surge_phase: float
    sway_phase: float
    heave_sign: float
    short_waves: float
    omega: tuple[float, ...]
    size: float
    notes: tuple[str, ...]

    @property
    def problems(self) -> tuple[str, ...]:
        """What contradicts the convention, each with the conversion that would cure it; empty if nothing does."""
        return tuple(_problems(self))

    @property
    def ok(self) -> bool:
        """Whether nothing contradicts the convention of the project."""
        return not self.problems

    def __str__(self) -> str:
        return (
            f"heave ratio {self.heave_ratio:+.4f} (+1 expected), surge phase {self.surge_phase:+.2f} deg (+90 expected), "
            f"sway phase {self.sway_phase:+.2f} deg (+90 expected)"
        )


def _off(phase: float, expected: float) -> bool:
    return bool(abs((phase - expected + 180.0) % 360.0 - 180.0) > _PHASE_TOLERANCE)


def _problems(result: ProbeResult) -> list[str]:
    tolerance = 0.2 + 0.5 * (result.size if np.isfinite(result.size) else 0.0)
    ratio, surge, sway = result.heave_ratio, result.surge_phase, result.sway_phase
    if result.short_waves > 0.5:
        return [
            f"Heave force does not vanish in short waves ({result.short_waves:.2f} of its long-wave value): check whether the "
            "first column is the period."
        ]
    if result.heave_sign < 0:
        return ["Heave force is against the wave: z points down. Turn the axes (frames.to_z_down) and mirror the directions."]
    if np.isfinite(ratio) and abs(abs(ratio) - 1.0) > tolerance:
        return ["The sizes do not fit: check the length scale, gravity, and whether the first column is the period."]
    conjugated = bool(ratio < 0)
    back = -90.0 if conjugated else 90.0  # what surge and sway show if the time factor is all that is wrong
    problems = []
    if conjugated:
        problems.append("The data follow exp(-i omega t): take the complex conjugate of forces and motions.")
    if np.isnan(ratio) and all(np.isnan(x) or _off(x, 90.0) for x in (surge, sway)) and not np.isnan([surge, sway]).all():
        return [
            "Either the time factor is exp(-i omega t) (take the conjugate) or directions say where waves come from (add pi)."
        ]
    wrong = [_off(x, back) if np.isfinite(x) else None for x in (surge, sway)]
    if wrong[0] and wrong[1] in (True, None):
        problems.append("Directions say where waves come from: add pi to them.")
    elif wrong[1]:
        problems.append("Directions are clockwise or y points to starboard: change the sign of the directions.")
    elif wrong[0]:
        problems.append("x points aft: change b to pi - b.")
    return problems
