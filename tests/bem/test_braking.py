"""Damping along shapes: few columns by sweeps, many by products of matrices, against the formula."""

import numpy as np
import pytest

from ogilvie.bem.braking import Brake


@pytest.mark.parametrize("columns", [1, 3, 12, 13, 40])
def test_velocities_lose_their_part_and_positions_stay(columns):
    rng = np.random.default_rng(columns)
    shape, loss, x = rng.normal(size=(9, 7)) / 10, -rng.random(7), rng.normal(size=(18, columns))
    before = x.copy()
    out = Brake(shape)(x, loss)
    np.testing.assert_array_equal(x, before)
    np.testing.assert_array_equal(out[:9], x[:9])
    np.testing.assert_allclose(out[9:], x[9:] + shape @ np.diag(loss) @ shape.T @ x[9:], rtol=1e-12, atol=1e-14)


def test_columns_in_any_layout_give_the_same():
    rng = np.random.default_rng(3)
    shape, loss, x = np.asfortranarray(rng.normal(size=(5, 5)) / 5), -rng.random(5), np.asfortranarray(rng.normal(size=(10, 3)))
    np.testing.assert_allclose(Brake(shape)(x, loss), Brake(shape.copy())(x.copy(), loss), rtol=1e-12)


def test_full_loss_along_an_orthonormal_shape_leaves_nothing():
    shape = np.linalg.qr(np.random.default_rng(0).normal(size=(6, 6)))[0]
    out = Brake(shape)(np.ones((12, 2)), -np.ones(6))
    np.testing.assert_allclose(out, np.repeat([[1.0], [0.0]], 6, axis=0).repeat(2, axis=1), atol=1e-14)
