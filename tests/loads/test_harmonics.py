"""Sums of harmonics on a grid of times, against the plain sum."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ogilvie.loads.harmonics import HarmonicGrid


def plain(frequency, amplitude, transfer, t):
    return (np.exp(1j * np.outer(t, frequency)) @ (amplitude[:, None] * transfer)).real


def case(n, columns, seed):
    rng = np.random.default_rng(seed)
    complex_normal = lambda *shape: rng.normal(size=shape) + 1j * rng.normal(size=shape)  # noqa: E731
    return rng.uniform(-3.0, 3.0, n), complex_normal(n), complex_normal(n, columns)


@settings(max_examples=40, deadline=None)
@given(
    n=st.integers(1, 60),
    columns=st.integers(1, 8),
    count=st.integers(1, 500),
    step=st.floats(0.01, 3.0),
    start=st.floats(-1e3, 1e4),
    seed=st.integers(0, 1000),
)
def test_equals_the_plain_sum(n, columns, count, step, start, seed):
    w, a, T = case(n, columns, seed)
    grid = HarmonicGrid(w, step, count)
    series = grid.series(a * grid.phases(start), T)
    expected = plain(w, a, T, start + step * np.arange(count))
    scale = np.abs(a[:, None] * T).sum(axis=0).max()
    assert series.shape == expected.shape
    assert np.abs(series - expected).max() < 5e-11 * scale


@pytest.mark.parametrize("w", [0.0, 1e-9, np.pi / 0.1, -np.pi / 0.1, 2 * np.pi / 0.1, 100.0])
def test_frequencies_at_the_edges_of_the_grid(w):
    """Zero, the highest that the step resolves, and beyond it (the samples are still right)."""
    grid = HarmonicGrid(np.array([w]), 0.1, 64)
    series = grid.series(grid.phases(0.0), np.array([[1.0 + 0.5j]]))[:, 0]
    t = 0.1 * np.arange(64)
    assert series == pytest.approx((np.exp(1j * w * t) * (1.0 + 0.5j)).real, abs=1e-10)


def test_blocks_join():
    w, a, T = case(20, 2, 5)
    grid = HarmonicGrid(w, 0.05, 101)
    first, second = (grid.series(a * grid.phases(start), T) for start in (0.0, 5.0))
    assert first[100] == pytest.approx(second[0], abs=1e-9)
