"""A case: one TOML file from hull or coefficients to results, with every mistake in it reported at once."""

import hashlib
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ogilvie.app.crosschecks import crosschecks
from ogilvie.app.crosschecks_control import large_motions
from ogilvie.app.mistakes import describe, unknown_key
from ogilvie.app.section_base import Section
from ogilvie.app.section_control import Autopilot, Positioning, SpeedKeeping
from ogilvie.app.section_loads import Current, Damping, HullLift, Mooring, Resistance, Restoring, SlowDrift, Wind
from ogilvie.app.sections import (
    OPTIONAL,
    SECTIONS,
    Body,
    Coefficients,
    Hull,
    Loads,
    Memory,
    Output,
    Sea,
    Simulation,
    Vessel,
    Water,
)
from ogilvie.errors import FormatError, InputError
from ogilvie.units import knot


@dataclass(frozen=True)
class Case:
    """A case file that was read and found free of mistakes.

    Parameters
    ----------
    text : str
        The TOML text.
    folder : Path
        Where relative paths in the file start.
    name : str
        Stem of the file, also that of the output folder by default.
    """

    text: str
    folder: Path
    name: str
    title: str
    vessel: Vessel
    hull: Hull | None
    body: Body | None
    water: Water
    coefficients: Coefficients
    memory: Memory
    sea: Sea
    loads: Loads
    simulation: Simulation
    output: Output
    restoring: Restoring | None = None
    damping: Damping | None = None
    resistance: Resistance | None = None
    hull_lift: HullLift | None = None
    wind: Wind | None = None
    current: Current | None = None
    slow_drift: SlowDrift | None = None
    mooring: Mooring | None = None
    autopilot: Autopilot | None = None
    speed_keeping: SpeedKeeping | None = None
    positioning: Positioning | None = None

    @property
    def large(self) -> bool:
        """Whether motions are large: any heading, roll and pitch, poses in the world."""
        return large_motions(vars(self))

    @property
    def speed(self) -> float:
        """Forward speed, m/s."""
        return self.vessel.speed_knots * knot

    @property
    def digest(self) -> str:
        """First 16 hexadecimal digits of the SHA-256 of the text."""
        return hashlib.sha256(self.text.encode()).hexdigest()[:16]

    def path(self, name: str) -> Path:
        """Return a path of the file, relative to the file's own folder."""
        return self.folder / Path(name).expanduser()


def read_case(path: str | Path) -> Case:
    """Return the case that a TOML file describes.

    Parameters
    ----------
    path : str or Path

    Raises
    ------
    FormatError
        No TOML; the message names the line.
    InputError
        Mistakes in the case: all of them in one message, each with its path in the file.
    """
    path = Path(path)
    try:
        text = path.read_bytes().decode("utf-8")
    except UnicodeDecodeError as error:
        raise FormatError(
            f"{path.name}: a TOML text in UTF-8 expected, byte {error.start} is no text. Is it a case file?"
        ) from None
    return parse_case(text, folder=path.parent, name=path.stem, label=path.name)


def parse_case(text: str, *, folder: Path | str = ".", name: str = "case", label: str = "case") -> Case:
    """Return the case of a TOML text.

    Parameters
    ----------
    text : str
    folder : Path
        Where relative paths start.
    name : str
        Name of the case.
    label : str
        What messages call the text, usually the file's name.

    Examples
    --------
    >>> hull, body = '[hull]\\nshape = "s175"\\n', '[body]\\nkg = 9.5\\ngyradii = [8.3, 42.0, 42.0]\\n'
    >>> case = parse_case(hull + body + '[sea]\\nhs = 4.0\\ntp = 10.0')
    >>> case.sea.hs, case.memory.r2
    (4.0, 0.99)
    >>> parse_case('[sea]\\nhs = -1')  # doctest: +IGNORE_EXCEPTION_DETAIL
    Traceback (most recent call last):
    InputError: case: mistakes: ...
    """
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise FormatError(f"{label}: no valid TOML: {_toml_problem(error, text)}") from None
    title = data.pop("title", name)
    problems = [] if isinstance(title, str) else [f"title: {title!r}: a text in quotes expected."]
    problems += [unknown_key(key, key, ["title", *SECTIONS], "section") for key in data if key not in SECTIONS]
    sections: dict[str, Section | None] = {}
    for key, model in SECTIONS.items():
        if key in OPTIONAL and key not in data:
            sections[key] = None
            continue
        sections[key] = _section(model, data.get(key, {}), key, problems)
    problems += crosschecks(sections, present=set(data), folder=Path(folder))
    if problems:
        count = "1 mistake" if len(problems) == 1 else f"{len(problems)} mistakes"
        raise InputError(f"{label}: {count}:\n" + "\n".join(f"  {p}" for p in problems))
    return Case(text=text, folder=Path(folder), name=name, title=str(title), **sections)  # type: ignore[arg-type]


def _section(model: type[Section], values: Any, key: str, problems: list[str]) -> Section | None:
    """Return the validated section, or None after noting its mistakes."""
    if not isinstance(values, dict):
        problems.append(f"{key}: {values!r}: a section [{key}] with keys expected.")
        return None
    try:
        return model.model_validate(values)
    except ValidationError as error:
        problems += describe(error, model, key)
        return None


def _toml_problem(error: tomllib.TOMLDecodeError, text: str) -> str:
    """The parser's sentence with the line it speaks of."""
    message = str(error)
    line = getattr(error, "lineno", None)
    if line is None and "(at line " in message:
        line = int(message.split("(at line ")[1].split(",")[0])
    lines = text.splitlines()
    if line and line <= len(lines):
        found = lines[line - 1].strip()
        return f"{message}: {found!r}{_toml_hint(message, found)}"
    return message


def _toml_hint(message: str, line: str) -> str:
    """What the parser's words mean for those who write no parsers."""
    if "overwrite" in message or "Cannot declare" in message:
        return ". The key or section stands twice; keep one."
    if re.search(r"=\s*-?\d+,\d", line):
        return ". Decimals take a point, 4.5."
    return ""
