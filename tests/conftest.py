"""Where the validation data are, if they are: tests that need them skip with a reason otherwise."""

from pathlib import Path

import pytest

SHARED = Path(__file__).resolve().parents[2] / "shared"


def _folder(name: str) -> Path:
    path = SHARED / name
    if not path.is_dir():
        pytest.skip(f"validation data not present: a folder {name!r} in 'shared' beside the project is expected")
    return path


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Folder of real public data sets; the test is skipped where it is absent."""
    return _folder("data")


@pytest.fixture(scope="session")
def shared_reference() -> Path:
    """Folder of exact solutions; the test is skipped where it is absent."""
    return _folder("reference")
