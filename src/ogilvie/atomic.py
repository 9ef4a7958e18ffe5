"""Files are written whole or not at all."""

import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ogilvie.errors import InputError


def write_whole(path: Path, write: Callable[[Path], Any]) -> Path:
    """Let `write` fill a temporary file in the same folder, then move it into place, with the rights that new files get.

    Parameters
    ----------
    path : Path
    write : callable
        Takes the path of the temporary file, which has the ending of `path`.

    Raises
    ------
    InputError
        The folder does not exist; something other than a file (a folder, a device) stands in the way.
    PermissionError
        The folder is read-only.
    """
    check_place(path)
    handle, name = tempfile.mkstemp(prefix=f".{path.stem}-", suffix=path.suffix, dir=path.parent)
    os.close(handle)
    temporary = Path(name)
    try:
        write(temporary)
        os.chmod(temporary, 0o666 & ~_umask())
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)
    return path


def check_place(path: Path) -> None:
    """Raise InputError or PermissionError where no file can be written, for use before work whose result is to go there."""
    if path.exists() and not path.is_file():
        raise InputError(f"{path}: the place of a file expected, something else found. Give another name.")
    if not path.parent.is_dir():
        raise InputError(f"{path}: an existing folder expected, no {path.parent} found. Make it first.")
    if not os.access(path.parent, os.W_OK):
        raise PermissionError(13, "Permission denied", str(path))


def _umask() -> int:
    """The rights that new files do not get; mkstemp gives none to others."""
    mask = os.umask(0o022)
    os.umask(mask)
    return mask
