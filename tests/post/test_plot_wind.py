"""The figure of wind coefficients shows the curves and the points of the table."""

import numpy as np
import pytest

from ogilvie.errors import InputError
from ogilvie.loads.wind_blendermann import blendermann_wind
from ogilvie.loads.wind_coefficients import WindCoefficients
from ogilvie.post import plot

AREAS = {"frontal_area": 500.0, "lateral_area": 2500.0, "length": 180.0}
ANGLE = np.linspace(0.0, np.pi, 13)
PLATE = WindCoefficients(ANGLE, np.cos(ANGLE), np.sin(ANGLE) * (np.arange(13) % 12 > 0), **AREAS)


def test_curves_and_points_are_the_coefficients(tmp_path):
    fig = plot.wind_coefficients(PLATE, save=tmp_path / "wind.png")
    assert (tmp_path / "wind.png").stat().st_size > 10_000
    curve, points = fig.axes[0].lines[:2]
    assert curve.get_ydata() == pytest.approx(PLATE(np.radians(curve.get_xdata()))[:, 0])
    assert points.get_xdata() == pytest.approx(np.degrees(ANGLE))
    assert points.get_ydata() == pytest.approx(np.cos(ANGLE))
    assert "deg" in fig.axes[2].get_xlabel()


def test_several_sets_and_whole_turns():
    full = np.linspace(-np.pi, np.pi, 25)
    turn = WindCoefficients(full, np.cos(full), np.sin(2 * full), symmetry="none", name="turn", **AREAS)
    ferry = blendermann_wind("ferry", centroid_height=9.0, **AREAS)
    fig = plot.wind_coefficients([turn, ferry])
    assert fig.axes[1].get_xlim() == (-180.0, 180.0)
    left = fig.axes[1].lines[1]  # the half turn of the ferry is mirrored
    assert left.get_ydata() == pytest.approx(-left.get_ydata()[::-1], abs=1e-9)
    with pytest.raises(InputError):
        plot.wind_coefficients([])
