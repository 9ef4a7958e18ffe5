"""What was found out about a mesh: findings and reports to print."""

from dataclasses import dataclass
from typing import Literal

Severity = Literal["error", "warning"]


@dataclass(frozen=True)
class Finding:
    """One fault of a mesh.

    Parameters
    ----------
    what : str
    severity : {"error", "warning"}
        An error makes the mesh unusable for a solver.
    count : int
        How many (panels, edges, vertices, or 1).
    advice : str
        What to do.
    faces : tuple of int
        Stored panels concerned (the first 20).
    """

    what: str
    severity: Severity
    count: int
    advice: str
    faces: tuple[int, ...] = ()


@dataclass(frozen=True)
class MeshReport:
    """What :func:`check_mesh` found; print it."""

    mesh: str
    findings: tuple[Finding, ...]

    @property
    def ok(self) -> bool:
        """True if there is no error (warnings may be there)."""
        return not any(f.severity == "error" for f in self.findings)

    def __getitem__(self, what: str) -> int:
        """Return how often a fault was found; 0 if not."""
        return sum(f.count for f in self.findings if f.what == what)

    def __str__(self) -> str:
        if not self.findings:
            return f"{self.mesh}\n  no faults found"
        width = max(len(f.what) for f in self.findings)
        lines = [f"  {f.severity:7s}  {f.count:6d}  {f.what:{width}s}  {f.advice}" for f in self.findings]
        return "\n".join([self.mesh, *lines])


@dataclass(frozen=True)
class HealReport:
    """Repairs that :func:`heal` made, (what, how many), and the report before and after; print it."""

    repairs: tuple[tuple[str, int], ...]
    before: MeshReport
    after: MeshReport

    def __str__(self) -> str:
        lines = [f"  {n:6d}  {what}" for what, n in self.repairs] or ["  nothing to repair"]
        return "\n".join(["repairs", *lines, str(self.after)])
