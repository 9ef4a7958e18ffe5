"""The demo: a ship from its lines to motions in a seaway, and the case files to start one's own from."""

import tomllib
from importlib.resources import files
from pathlib import Path

from ogilvie.app.case import parse_case
from ogilvie.app.console import say, table
from ogilvie.app.files import write_text
from ogilvie.app.mistakes import did_you_mean
from ogilvie.app.run import run_case
from ogilvie.app.summary import print_findings
from ogilvie.errors import InputError


def demo_text() -> str:
    """Return the TOML text of the demo's case."""
    return files("ogilvie.app").joinpath("cases", "s175.toml").read_text(encoding="utf-8")


def shipped_cases() -> dict[str, str]:
    """Return the TOML texts of all cases that come with the package, by name."""
    folder = files("ogilvie.app").joinpath("cases")
    found = sorted(item.name for item in folder.iterdir() if item.name.endswith(".toml"))
    return {name.removesuffix(".toml"): folder.joinpath(name).read_text(encoding="utf-8") for name in found}


def list_cases() -> None:
    """Print names and titles of the cases that come with the package."""
    cases = shipped_cases()
    table([(name, tomllib.loads(text)["title"]) for name, text in cases.items()], left=frozenset({0, 1}))
    say("Copy one with `ogilvie cases NAME`, edit it, and `ogilvie run NAME.toml`.")


def copy_case(name: str, output: Path | None) -> None:
    """Write a case that comes with the package to a file of one's own.

    Raises
    ------
    InputError
        No such case.
    FileExistsError
        There is such a file already.
    """
    cases = shipped_cases()
    name = name.removesuffix(".toml")
    if name not in cases:
        raise InputError(f"cases: one of {', '.join(cases)} expected, {name!r} found{did_you_mean(name, list(cases)) or '.'}")
    target = Path(f"{name}.toml") if output is None else output / f"{name}.toml" if output.is_dir() else output
    if target.exists():
        raise FileExistsError(17, "File exists", str(target))
    write_text(target, cases[name])
    say(f"{target} written. Next: `ogilvie run {target}`.")


def run_demo(folder: Path, *, cache: bool = True) -> None:
    """Run the demo into a folder and say where to look."""
    text = demo_text() if cache else demo_text().replace("[coefficients] ", "[coefficients]\ncache = false ", 1)
    found = run_case(parse_case(text, folder=folder, name="s175", label="s175.toml"), folder)
    write_text(folder / "s175.toml", text)
    print_findings(found, folder)
    say(f"Next: edit {folder / 's175.toml'} and `ogilvie run` it.")
