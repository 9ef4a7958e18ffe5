"""What the checks of a data set found, as data and as a table."""

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

_AT_MOST = 8  # findings of one check that are all printed

Severity = Literal["error", "warning"]
Verdict = Literal["ok", "WRONG", "warning", "not judged"]


@dataclass(frozen=True)
class Finding:
    """One thing that is wrong, or that limits the use of the data.

    Parameters
    ----------
    kind : str
        Name of the check.
    severity : {"error", "warning"}
        An error contradicts physics; a warning limits what the data are good for.
    dofs : tuple of str
        Degrees of freedom concerned: none, one, or the pair of a coupling.
    omega : float, optional
        Frequency of the worst, rad/s.
    value, tolerance : float
        What was found and what is allowed, as fractions of the scale that the sentence names.
    sentence : str
        What is wrong, where, and what to do.
    local : bool
        Whether the data at `omega` themselves are damaged, so that leaving this frequency out helps.
    """

    kind: str
    severity: Severity
    dofs: tuple[str, ...]
    omega: float | None
    value: float
    tolerance: float
    sentence: str
    local: bool = False


@dataclass(frozen=True)
class Check:
    """The outcome of one check.

    Parameters
    ----------
    kind : str
    worst, tolerance : float
        Fractions; NaN where there is no number.
    where : str
        Couplings and frequency of the worst.
    findings : tuple of Finding
    note : str
        Why it was not judged, if it was not.
    """

    kind: str
    worst: float = np.nan
    tolerance: float = np.nan
    where: str = ""
    findings: tuple[Finding, ...] = ()
    note: str = ""

    @property
    def verdict(self) -> Verdict:
        """One word."""
        if self.note:
            return "not judged"
        severities = {finding.severity for finding in self.findings}
        return "WRONG" if "error" in severities else "warning" if severities else "ok"


@dataclass(frozen=True)
class CheckReport:
    """All checks of one data set; ``print(report)`` shows a table and a sentence for each finding.

    Parameters
    ----------
    title : str
    checks : tuple of Check
    """

    title: str
    checks: tuple[Check, ...] = field(repr=False)

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What was found, in the order of the checks."""
        return tuple(finding for check in self.checks for finding in check.findings)

    @property
    def ok(self) -> bool:
        """Whether nothing contradicts physics (warnings are allowed)."""
        return not any(finding.severity == "error" for finding in self.findings)

    @property
    def dirty_omega(self) -> NDArray[np.float64]:
        """Frequencies whose data are damaged, rad/s, ascending: candidates for leaving out."""
        return np.unique([finding.omega for finding in self.findings if finding.local and finding.omega is not None])

    @property
    def rows(self) -> tuple[tuple[str, str, str, str, str], ...]:
        """The table as text: check, worst, allowed, where, verdict."""
        return tuple(
            (check.kind, _percent(check.worst), _percent(check.tolerance), check.note or check.where, check.verdict)
            for check in self.checks
        )

    def __str__(self) -> str:
        head = ("check", "worst", "allowed", "where", "verdict")
        rows = (head, *self.rows)
        widths = [max(len(row[i]) for row in rows) for i in range(5)]
        lines = [self.title, ""]
        lines += ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
        if self.findings:
            lines += ["", "findings"]
            lines += [line for check in self.checks for line in _sentences(check.findings)]
        if len(self.dirty_omega):
            lines += ["", "damaged frequencies: " + ", ".join(f"{w:.4g}" for w in self.dirty_omega) + " rad/s"]
        return "\n".join(lines)


def _sentences(findings: tuple[Finding, ...]) -> list[str]:
    """Return a line for each finding; of many alike the worst, with the frequencies of the others."""
    if len(findings) <= _AT_MOST:
        return [f"- {f.severity}: {f.sentence}" for f in findings]
    worst = max(findings, key=lambda f: f.value)
    others = sorted({f.omega for f in findings if f.omega is not None and f is not worst})
    at = f", at {others[0]:.4g}..{others[-1]:.4g} rad/s" if others else ""
    return [f"- {worst.severity}: {worst.sentence}", f"- {worst.severity}: and {len(findings) - 1} more like it{at}."]


def _percent(value: float) -> str:
    return "" if np.isnan(value) else f"{100 * value:.3g} %"
