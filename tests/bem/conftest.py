"""Boundaries with their inner corners moved at random."""

from collections.abc import Callable

import pytest

from ogilvie.bem.curved import CurvedMesh
from ogilvie.bem.jitter import jittered as move_corners


@pytest.fixture(scope="session")
def jittered() -> Callable[..., CurvedMesh]:
    return move_corners
