"""Spreading functions: unit integral, moments in closed form, quantiles."""

import numpy as np
import pytest
from scipy.integrate import quad

from ogilvie.errors import InputError
from ogilvie.waves.spreading import spreading


@pytest.mark.parametrize("s", [1.0, 2.5, 10.0, 75.0, 400.0])
def test_cos2s(s):
    D = spreading(s=s)
    assert quad(D, -np.pi, np.pi, points=[0.0], limit=200)[0] == pytest.approx(1.0, rel=1e-10)
    # first Fourier moment of cos^2s is s/(s + 1) (Longuet-Higgins et al. 1963)
    assert quad(lambda a: D(a) * np.cos(a), -np.pi, np.pi, points=[0.0])[0] == pytest.approx(s / (s + 1), rel=1e-10)
    assert D.deviation == pytest.approx(np.sqrt(2 / (s + 1)), rel=1e-3)


@pytest.mark.parametrize("n", [1.0, 2.0, 4.0, 10.0])
def test_cosn(n):
    D = spreading(n=n)
    assert quad(D, -np.pi / 2, np.pi / 2)[0] == pytest.approx(1.0, rel=1e-10)
    assert D(1.6) == D(-3.0) == D(np.pi) == 0.0
    if n == 2.0:
        np.testing.assert_allclose(D([0.0, 0.5]), 2 / np.pi * np.cos([0.0, 0.5]) ** 2, rtol=1e-13)


@pytest.mark.parametrize("D", [spreading(s=3.0), spreading(s=40.0), spreading(n=2.0)], ids=["s3", "s40", "n2"])
def test_quantile_inverts_the_integral(D):
    p = np.array([0.01, 0.2, 0.5, 0.77, 0.999])
    for fraction, angle in zip(p, D.quantile(p), strict=True):
        assert quad(D, -np.pi, angle, points=[-np.pi / 2, 0.0][: 1 + (angle > 0)], limit=300)[0] == pytest.approx(
            fraction, abs=1e-9
        )
    np.testing.assert_allclose(D.quantile(p), -D.quantile(1 - p), atol=1e-14)


def test_density_is_periodic():
    D = spreading(s=5.0)
    np.testing.assert_allclose(D(0.3 + 2 * np.pi), D(0.3), rtol=1e-12)


@pytest.mark.parametrize(
    "call", [lambda: spreading(), lambda: spreading(s=1, n=2), lambda: spreading(s=-1.0), lambda: spreading(n=np.nan)]
)
def test_bad_input(call):
    with pytest.raises(InputError, match="spreading"):
        call()
