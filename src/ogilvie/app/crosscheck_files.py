"""Whether the files that a case names are there."""

from collections.abc import Iterator
from pathlib import Path


def missing_file(path: str, name: str, folder: Path, *, stem: bool = False) -> Iterator[str]:
    """Yield a sentence where a file is not there; with `stem` other files of that stem will do."""
    target = folder / Path(name).expanduser()
    if target.is_dir():
        yield f'{path}: "{name}": a file expected, a folder found.'
    elif not target.exists() and not (stem and list(target.parent.glob(target.name + ".*"))):
        yield f'{path}: "{name}": no such file (relative paths start at the case file\'s folder).'
