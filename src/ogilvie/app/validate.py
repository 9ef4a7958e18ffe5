"""Comparisons with published results: runs ``validation/<name>/case.py``, prints a table, writes a figure and a page of each.

A case is a module with

- ``TITLE``, ``ABOUT``: one line, and a few sentences in Markdown;
- ``NEEDS``: paths below the folder of published data that it reads (it is skipped where one is missing);
- ``run(shared)``: returns ``(checks, data)``; each check is a mapping with ``name``, ``value``, ``reference``, ``tolerance``
  and, if wished, ``unit``, ``source``, ``note``; it passes when abs(value - reference) <= tolerance;
- ``draw(data, fig)``: draws into a matplotlib figure; ``HEIGHT`` (in), if wished, is its height.
"""

import importlib.util
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any

from ogilvie.app.console import say, stderr, table
from ogilvie.app.files import write_bytes, write_text
from ogilvie.app.mistakes import did_you_mean
from ogilvie.errors import InputError
from ogilvie.post.report_tables import number

_PARTS = ("TITLE", "ABOUT", "NEEDS", "run", "draw")


@dataclass(frozen=True)
class Comparison:
    """One number beside the published one."""

    name: str
    value: float
    reference: float
    tolerance: float
    unit: str = ""
    source: str = ""
    note: str = ""

    @property
    def passed(self) -> bool:
        """Whether the value is within the tolerance (NaN is not)."""
        return abs(self.value - self.reference) <= self.tolerance


@dataclass(frozen=True)
class Outcome:
    """What became of a case: comparisons, or the reason why there are none."""

    name: str
    title: str
    about: str = ""
    comparisons: tuple[Comparison, ...] = ()
    skipped: str = ""
    failure: str = ""
    seconds: float = 0.0
    picture: bytes = field(default=b"", repr=False)

    @property
    def passed(self) -> bool:
        """Whether all comparisons passed (a skipped case is no failure)."""
        return not self.failure and all(c.passed for c in self.comparisons)

    @property
    def verdict(self) -> str:
        """One word or a few."""
        if self.skipped:
            return "skipped"
        if self.failure:
            return "ERROR"
        good = sum(c.passed for c in self.comparisons)
        return f"{good} of {len(self.comparisons)} within tolerance"


def validate_all(names: Sequence[str], *, folder: Path, data: Path | None, output: Path) -> bool:
    """Run cases, print what came out and write their pages; return whether none failed.

    Parameters
    ----------
    names : sequence of str
        All cases when empty.
    folder : Path
        Of the cases.
    data : Path or None
        Published data; the folder ``shared`` beside the project by default.
    output : Path
        Gets ``<name>.md`` and ``<name>.png`` of each case and an ``index.md``.

    Raises
    ------
    InputError
        No such folder or case.
    """
    cases = find_cases(folder, names)
    shared = data if data is not None else folder.resolve().parent.parent / "shared"
    if data is not None and not data.is_dir():
        raise InputError(f"--data: {data}: an existing folder of published data expected, none found.")
    output.mkdir(parents=True, exist_ok=True)
    outcomes = []
    for path in cases:
        if sys.stderr.isatty():
            stderr().print(f"[dim]{path.parent.name} ...[/dim]")
        outcome = run_one(path, shared if shared.is_dir() else None)
        outcomes.append(outcome)
        _print(outcome)
        if outcome.comparisons:
            _write(outcome, output)
    write_text(output / "index.md", index_page(outcomes))
    rows = [(o.name, o.verdict, f"{o.seconds:.1f} s", o.skipped or o.failure) for o in outcomes]
    table(rows, head=("case", "result", "time", ""), title="validation", left=frozenset({0, 1, 3}))
    say(f"pages and figures in {output}")
    return all(o.passed for o in outcomes)


def find_cases(folder: Path, names: Sequence[str]) -> list[Path]:
    """Return the files of the cases, all or those named."""
    if not folder.is_dir():
        raise InputError(
            f"{folder}: a folder of validation cases expected, none found. Run this at the project's root, or give --folder."
        )
    known = {path.parent.name: path for path in sorted(folder.glob("*/case.py"))}
    if not known:
        raise InputError(f"{folder}: folders with a case.py expected, none found.")
    for name in names:
        if name not in known:
            raise InputError(
                f"{name}: no such validation case{did_you_mean(name, list(known)) or '.'} Known: {', '.join(known)}."
            )
    return [known[name] for name in names] if names else list(known.values())


def run_one(path: Path, shared: Path | None) -> Outcome:
    """Run one case; whatever goes wrong in it becomes its outcome."""
    name, began = path.parent.name, time.perf_counter()
    title = name
    try:
        module = _load(path)
        title = str(module.TITLE)
        missing = [need for need in module.NEEDS if shared is None or not (shared / need).exists()]
        if missing:
            return Outcome(name, title, skipped=f"published data not present: {', '.join(missing)}")
        checks, data = module.run(shared)
        comparisons = tuple(_comparison(check) for check in checks)
        if not comparisons:
            raise InputError("run: at least one check expected, none found.")
        from ogilvie.post import plot

        picture = plot.to_png(plot.custom(module.draw, data, height=float(getattr(module, "HEIGHT", 3.6))))
    except Exception as error:
        return Outcome(name, title, failure=f"{type(error).__name__}: {error}", seconds=time.perf_counter() - began)
    return Outcome(name, title, str(module.ABOUT), comparisons, seconds=time.perf_counter() - began, picture=picture)


def _load(path: Path) -> ModuleType:
    name = f"ogilvie_validation_{path.parent.name}"
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses in the case look themselves up there
    spec.loader.exec_module(module)
    lacking = [part for part in _PARTS if not hasattr(module, part)]
    if lacking:
        raise InputError(f"{path.parent.name}/case.py: {', '.join(_PARTS)} expected, {', '.join(lacking)} missing.")
    return module


def _comparison(check: Mapping[str, Any]) -> Comparison:
    value, reference, tolerance = (float(check[key]) for key in ("value", "reference", "tolerance"))
    unit, source, note = (str(check.get(key, "")) for key in ("unit", "source", "note"))
    return Comparison(str(check["name"]), value, reference, tolerance, unit, source, note)


def _row(c: Comparison) -> tuple[str, ...]:
    verdict = "ok" if c.passed else "FAILED"
    return c.name, number(c.value), number(c.reference), number(c.tolerance, 2), c.unit, verdict


def _print(outcome: Outcome) -> None:
    title = f"{outcome.name}: {outcome.title}"
    if outcome.comparisons:
        head = ("", "here", "published", "allowed", "unit", "")
        table([_row(c) for c in outcome.comparisons], head=head, title=title, left=frozenset({0, 4, 5}))
    else:
        say(f"{title}: {outcome.verdict}: {outcome.skipped or outcome.failure}")


def _write(outcome: Outcome, output: Path) -> None:
    write_bytes(output / f"{outcome.name}.png", outcome.picture)
    write_text(output / f"{outcome.name}.md", case_page(outcome))


def case_page(outcome: Outcome) -> str:
    """Return the Markdown page of a case."""
    lines = [f"# {outcome.title}", "", outcome.about.strip(), "", f"![{outcome.title}]({outcome.name}.png)", ""]
    lines += ["| | here | published | allowed difference | unit | | source |", "|---|---:|---:|---:|---|---|---|"]
    for c in outcome.comparisons:
        lines.append(f"| {' | '.join(_cell(x) for x in (*_row(c), c.source))} |")
    notes = [f"- {c.name}: {c.note}" for c in outcome.comparisons if c.note]
    return "\n".join([*lines, "", *notes, *([""] if notes else []), f"Result: {outcome.verdict}.", ""])


def index_page(outcomes: Sequence[Outcome]) -> str:
    """Return the Markdown page that lists all cases."""
    lines = ["# Validation", "", "Made by `ogilvie validate`.", "", "| case | result |", "|---|---|"]
    for o in outcomes:
        title = f"[{_cell(o.title)}]({o.name}.md)" if o.comparisons else _cell(o.title)
        reason = f": {_cell(o.skipped)}" if o.skipped else ""
        lines.append(f"| {title} | {o.verdict}{reason} |")
    return "\n".join([*lines, ""])


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")
