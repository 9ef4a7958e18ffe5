"""Benchmarks: ``python -m benchmarks`` runs every module of this folder that has a function ``measure``.

What is quoted elsewhere comes from here, always as a ratio to a baseline that is timed in the same run.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Measurement:
    """One timed thing: `value` in `unit`, and how many times its baseline's that is."""

    name: str
    value: float
    unit: str
    ratio: float | None = None
    baseline: str = ""
    note: str = ""
