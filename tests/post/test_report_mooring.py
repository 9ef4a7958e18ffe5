"""Tensions of mooring lines in the report."""

import numpy as np
import pytest
import xarray as xr

from ogilvie.loads.mooring_line import MooringLine
from ogilvie.loads.mooring_lines import CatenaryMooring
from ogilvie.post.report_mooring import line_tensions, tension_table

LINES = CatenaryMooring(
    [
        MooringLine([s * 837.6, 0.0, -200.0], [s * 40.9, 0.0, -14.0], length=835.35, weight=1066.0, stiffness=753.6e6)
        for s in (1, -1)
    ]
)


def swaying(n=None) -> xr.Dataset:
    """A vessel that goes to and fro by 5 m along the lines, after 100 s far away."""
    t = np.arange(0.0, 300.0, 0.05)
    eta = np.zeros((n or 1, t.size, 6))
    eta[..., 0] = np.where(t < 100.0, 30.0, 5.0 * np.sin(2 * np.pi * t / 50.0))
    dims = ("realisation", "time", "dof")
    if n is None:
        eta, dims = eta[0], dims[1:]
    return xr.Dataset({"eta": (dims, eta)}, coords={"time": t})


@pytest.mark.parametrize("n", [None, 2])
def test_extremes_are_those_of_the_extreme_poses(n):
    T = line_tensions(LINES, swaying(n), skip=100.0)
    assert T.shape[0] == (n or 1)
    assert T.shape[1] == pytest.approx(200 / 0.25, abs=1)
    at = [LINES.tensions([x, 0, 0, 0, 0, 0]) for x in (-5.0, 5.0)]
    np.testing.assert_allclose(T.max(axis=(0, 1)), np.maximum(*at), rtol=1e-6)
    np.testing.assert_allclose(T.min(axis=(0, 1)), np.minimum(*at), rtol=1e-6)


def test_the_table_has_a_row_per_line_in_kilonewtons():
    table = tension_table(LINES, swaying(), skip=100.0)
    (first, second), largest = table.rows, LINES.tensions([-5.0, 0, 0, 0, 0, 0])[0] / 1e3
    assert first[0] == "0"
    assert first[1] == "40.9, 0, -14"
    assert float(first[5]) == pytest.approx(largest[0], rel=1e-3)
    assert float(first[6]) == pytest.approx(largest[1], rel=1e-3)
    assert float(first[2]) == pytest.approx(float(second[2]), rel=1e-3)  # mirrored motion
    assert all("[kN]" in word for word in table.head[2:])
