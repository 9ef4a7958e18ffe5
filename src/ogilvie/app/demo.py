"""The demo: a ship from its lines to motions in a seaway, and the case file to start one's own from."""

from importlib.resources import files
from pathlib import Path

from ogilvie.app.case import parse_case
from ogilvie.app.console import say
from ogilvie.app.files import write_text
from ogilvie.app.run import run_case
from ogilvie.app.summary import print_findings


def demo_text() -> str:
    """Return the TOML text of the demo's case."""
    return files("ogilvie.app").joinpath("cases", "s175.toml").read_text(encoding="utf-8")


def run_demo(folder: Path, *, cache: bool = True) -> None:
    """Run the demo into a folder and say where to look."""
    text = demo_text() if cache else demo_text().replace("[coefficients] ", "[coefficients]\ncache = false ", 1)
    found = run_case(parse_case(text, folder=folder, name="s175", label="s175.toml"), folder)
    write_text(folder / "s175.toml", text)
    print_findings(found, folder)
    say(f"Next: edit {folder / 's175.toml'} and `ogilvie run` it.")
