"""What a command prints at its end: short tables, and where to look."""

from pathlib import Path
from typing import TYPE_CHECKING

from ogilvie.app.console import say, table, warn
from ogilvie.post.report import describe
from ogilvie.post.report_course import course_rows
from ogilvie.post.report_tables import memory_table, motion_rows

if TYPE_CHECKING:
    import xarray as xr

    from ogilvie.memory.retardation import Retardation
    from ogilvie.memory.statespace import StateSpace
    from ogilvie.post.report import Findings


def print_memory(K: "Retardation", ssm: "StateSpace | None") -> None:
    """Print the quality of the fluid memory."""
    shown = memory_table(K, ssm)
    kept = [
        i for i, name in enumerate(shown.head) if not name.startswith(("K(0)", "A", "tail B", "interpolation"))
    ]  # what fits a terminal
    table([[row[i] for i in kept] for row in shown.rows], head=[shown.head[i] for i in kept], title="fluid memory")
    if ssm is not None:
        say(describe(ssm))
    for note in dict.fromkeys((*K.notes, *(ssm.notes if ssm is not None else ()))):
        say(f"note: {note}")


def print_motions(
    statistics: "xr.Dataset | None",
    expected: "xr.Dataset | None" = None,
    *,
    run: "xr.Dataset | None" = None,
    skip: float = 0.0,
) -> None:
    """Print a small table of motions, and of the course of a run of large ones."""
    if statistics is None:
        return
    head, rows = motion_rows(statistics, expected)
    n, seconds = statistics.attrs["realisations"], statistics.attrs["duration"]
    where = " about the mean course" if statistics.attrs.get("about") else ""
    table(rows, head=head, title=f"motions of O{where}, {n} x {seconds:.4g} s")
    if run is not None and (course := course_rows(run, skip=skip)):
        table(course, left=frozenset({0, 1}))


def print_findings(found: "Findings", folder: Path) -> None:
    """Print what a case came to, its warnings, and where the results are."""
    for note in found.notes:
        warn(note)
    print_motions(found.statistics, found.expected, run=found.run, skip=found.skip)
    for name in ("report.html", "figures", "result.nc", "coefficients.nc", "memory.npz"):
        if (folder / name).exists():
            say(f"  {folder / name}")
