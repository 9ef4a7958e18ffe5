"""Arrays on disk under the user's cache folder, keyed by the content of the problem that they solve.

One folder per problem, one ``.npz`` file per entry (a wavenumber), so that an interrupted run goes on where it stopped. Entries
are written whole or not at all; one that cannot be read is reported and computed again.
"""

import hashlib
import os
import shutil
import sys
import tempfile
import warnings
import zipfile
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ogilvie.errors import OgilvieWarning

Arrays = Mapping[str, NDArray[Any]]

#: Size that :func:`prune` cuts the cache down to, bytes.
LIMIT = 2 * 1024**3

#: What numpy raises on files that are cut, overwritten or no archives.
_DAMAGED = (OSError, ValueError, EOFError, KeyError, NotImplementedError, RuntimeError, zipfile.BadZipFile, zlib.error)


def cache_folder() -> Path:
    """Return the folder of all caches: OGILVIE_CACHE if set, else ``ogilvie`` in the user's cache folder of the system.

    Examples
    --------
    >>> cache_folder().name != ""
    True
    """
    given = os.environ.get("OGILVIE_CACHE", "").strip()
    if given:
        return Path(given).expanduser()
    home = Path.home()
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or home / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = home / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME", "").strip() or home / ".cache")
    return base / "ogilvie"


def content_key(*parts: NDArray[Any] | str | float) -> str:
    """Return a key (32 hexadecimal digits) that differs whenever a number, a shape, a type or a text differs.

    Examples
    --------
    >>> content_key(np.zeros(3), "a", 1.0) == content_key(np.zeros(3), "a", 1.0)
    True
    >>> content_key(np.zeros((2, 3))) == content_key(np.zeros((3, 2)))
    False
    """
    digest = hashlib.sha256()
    for part in parts:
        array = np.asarray(part)
        data = part.encode() if isinstance(part, str) else np.ascontiguousarray(array).tobytes()
        kind = "text" if isinstance(part, str) else f"{array.dtype.str}{array.shape}"
        digest.update(f"{kind}:{len(data)};".encode() + data)
    return digest.hexdigest()[:32]


@dataclass(frozen=True)
class Cache:
    """The entries of one problem.

    Parameters
    ----------
    folder : Path
        Folder of the problem; it is made when the first entry is stored.

    Examples
    --------
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     cache = Cache(Path(folder) / "problem")
    ...     before = cache.load("k1")
    ...     cache.store("k1", {"x": np.arange(3.0)})
    ...     before is None, cache.load("k1")
    (True, {'x': array([0., 1., 2.])})
    """

    folder: Path

    def load(self, entry: str) -> dict[str, NDArray[Any]] | None:
        """Return the arrays of an entry, or None if there is none or (with a warning) if it is damaged."""
        path = self.folder / f"{entry}.npz"
        try:
            with np.load(path, allow_pickle=False) as file:
                return {key: file[key] for key in file.files}
        except FileNotFoundError:
            return None
        except _DAMAGED as e:
            warnings.warn(
                f"cache: {path} cannot be read ({type(e).__name__}: {e}); it is computed again.", OgilvieWarning, stacklevel=2
            )
            return None

    def store(self, entry: str, arrays: Arrays) -> None:
        """Write the arrays of an entry, whole or not at all; a folder that cannot be written is a warning."""
        path = self.folder / f"{entry}.npz"
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            write_whole(path, arrays)
        except OSError as e:
            warnings.warn(
                f"cache: {path} cannot be written ({e}); results are not kept. Set OGILVIE_CACHE to a folder that can be "
                "written, or use cache=False.",
                OgilvieWarning,
                stacklevel=2,
            )

    def touch(self) -> None:
        """Mark the problem as just used."""
        if self.folder.is_dir():
            os.utime(self.folder)


def write_whole(path: Path, arrays: Arrays) -> None:
    """Write an ``.npz`` file through a temporary one in the same folder."""
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}-", suffix=".tmp")
    try:
        with os.fdopen(handle, "wb") as file:
            np.savez(file, allow_pickle=False, **arrays)
        os.replace(name, path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def fill_folder(folder: Path, fill: Callable[[Path], object]) -> None:
    """Fill a new folder under a temporary name and put it in place, so that it is there whole or not at all.

    Where another process was faster, or nothing can be written, the folder is left as it is.
    """
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.parent, prefix=".new-", ignore_cleanup_errors=True) as new:
            fill(Path(new))
            os.replace(new, folder)
    except OSError:
        return


def prune(root: Path, *, limit: int = LIMIT) -> int:
    """Remove the problems under `root` that were not used for longest until `limit` bytes are left; return the bytes removed.

    Examples
    --------
    >>> prune(Path("no such folder"))
    0
    """
    if not root.is_dir():
        return 0
    problems = [(p.stat().st_mtime, p, _size(p)) for p in root.iterdir() if p.is_dir()]
    total, removed = sum(size for _, _, size in problems), 0
    for _, folder, size in sorted(problems)[:-1]:  # the last used one stays
        if total - removed <= limit:
            break
        shutil.rmtree(folder, ignore_errors=True)
        removed += size
    return removed


def _size(folder: Path) -> int:
    return sum(f.stat().st_size for f in folder.iterdir() if f.is_file())
