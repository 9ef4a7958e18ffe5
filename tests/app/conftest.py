"""A cache of their own for the tests of the application, and a small case that runs in seconds."""

import pytest

BOX = """
title = "Box barge"
[vessel]
name = "barge"
[hull]
shape = "box"
length = 40.0
beam = 12.0
draught = 4.0
panels = 120
[body]
kg = 3.0
gyradii = [4.0, 11.0, 11.0]
[coefficients]
omega_min = 0.3
omega_max = 2.4
omega_count = 15
directions_deg = [90.0, 135.0, 180.0]
[memory]
r2 = 0.95
max_order = 30
[sea]
hs = 1.0
tp = 8.0
direction_deg = 135.0
[loads]
damping_ratio = { surge = 0.1, sway = 0.1, roll = 0.08, yaw = 0.1 }
mooring_period = { surge = 60.0, sway = 60.0, yaw = 60.0 }
[simulation]
duration = 200.0
dt = 0.1
realisations = 2
"""


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory):
    """Keep solved coefficients away from the user's cache."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("OGILVIE_CACHE", str(tmp_path_factory.mktemp("cache")))
        patch.setenv("NO_COLOR", "1")
        yield


@pytest.fixture(scope="session")
def box_text() -> str:
    """TOML text of a small barge in waves."""
    return BOX
