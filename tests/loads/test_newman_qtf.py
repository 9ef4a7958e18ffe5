"""Newman's approximations as quadratic transfer functions in a data set."""

import numpy as np
import pytest

from ogilvie.errors import InputError
from ogilvie.hydro.files import read_hydro
from ogilvie.hydro.qtf import mirrored, symmetry_defect, with_qtf
from ogilvie.hydro.schema import hydro_from_arrays
from ogilvie.hydro.wamit_write import write_wamit
from ogilvie.loads.newman_qtf import newman
from ogilvie.loads.slow_drift import SlowDrift, slow_drift_force
from ogilvie.waves.sea import irregular
from ogilvie.waves.spectra import jonswap

W = np.linspace(0.3, 1.6, 14)
B = np.radians([90.0, 135.0, 180.0])
RULE = {"newman": "newman-1974", "arithmetic": "newman-arithmetic", "geometric": "newman-geometric"}


@pytest.fixture(scope="module")
def hydro():
    """Surge and sway of either sign, no heave, as a far field has it."""
    drift = np.zeros((len(W), len(B), 6))
    drift[..., 0] = -1e5 * np.sin(2.0 * W)[:, None] * np.cos(B) ** 2
    drift[..., 1] = 2e5 * np.cos(3.0 * W)[:, None] * np.sin(B)
    drift[..., 2] = np.nan
    Z = np.zeros((len(W), 6, 6))
    return hydro_from_arrays(omega=W, added_mass=Z, radiation_damping=Z, wave_direction=B, mean_drift=drift)


@pytest.mark.parametrize("form", list(RULE))
def test_values_are_those_of_the_load(hydro, form):
    Q = newman(hydro, form, pairs=True)
    load = SlowDrift(hydro, RULE[form])
    size = np.nanmax(np.abs(Q.qtf_diff.values))
    for i, j, b in ((0, 5, 0), (7, 3, 1), (13, 12, 2)):
        expected = load.qtf([W[i]], [W[j]], B[b])[0]
        np.testing.assert_allclose(Q.qtf_diff.values[i, j, b, :2], expected[:2], atol=1e-12 * size)
        for other in range(len(B)):
            pair = load.qtf([W[i]], [W[j]], B[b], B[other])[0, :2]
            np.testing.assert_allclose(Q.qtf_diff_pairs.values[i, j, 3 * b + other, :2], pair, atol=1e-12 * size)
    assert np.isnan(Q.qtf_diff.values[..., 2]).all()
    diagonal = np.einsum("wwbi->wbi", Q.qtf_diff.values).real
    np.testing.assert_allclose(diagonal[..., :2], hydro.mean_drift.values[..., :2], atol=1e-9 * size)
    for name in ("qtf_diff", "qtf_diff_pairs"):
        assert symmetry_defect(Q[name].values, mirrored(Q, name)) < 1e-12


@pytest.mark.parametrize("form", list(RULE))
def test_force_in_time_is_the_double_sum(hydro, form):
    sea = irregular(jonswap(hs=3.0, tp=9.0), direction=B[2], n=12, seed=3, omega_range=(0.35, 1.5))
    t = np.arange(0.0, 50.0, 0.5)
    Q = newman(hydro, form)
    force = slow_drift_force(sea, Q, t)
    i, j = (x.ravel() for x in np.indices((12, 12)))
    pairs = SlowDrift(Q, "full").qtf(sea.omega[i], sea.omega[j], B[2])
    c = sea.complex_amplitude[i] * sea.complex_amplitude[j].conj()
    plain = np.real(np.exp(1j * np.outer(t, sea.omega[i] - sea.omega[j])) @ (c[:, None] * pairs))
    np.testing.assert_allclose(force, plain, atol=1e-10 * np.abs(plain).max())
    np.testing.assert_array_equal(force, SlowDrift(Q, "full").series(sea, t))
    assert np.all(force[:, 2] == 0.0)
    close = {"newman": 1e-3, "arithmetic": 1e-3, "geometric": 0.2}[form]  # a spline through roots near a change of sign
    direct = SlowDrift(hydro, RULE[form]).series(sea, t)
    np.testing.assert_allclose(force[:, 0], direct[:, 0], atol=close * np.abs(direct[:, 0]).max())


def test_another_function_in_the_set_is_replaced_and_written(hydro, tmp_path):
    w = np.array([0.5, 0.7])
    other = with_qtf(hydro, omega=w, qtf_diff=np.ones((2, 2, 3, 6)))
    Q = newman(other, "arithmetic")
    assert Q.qtf_diff.shape == (14, 14, 3, 6)
    assert Q.qtf_diff.attrs["method"] == "newman-arithmetic from mean_drift"
    write_wamit(Q.drop_vars(["mean_drift"]), tmp_path / "hull")
    back = read_hydro(tmp_path / "hull.1")
    found = back.qtf_diff_pairs  # without wave forces a file has no directions but those of its pairs
    np.testing.assert_allclose(found.qtf_direction_1, B, rtol=1e-6)
    np.testing.assert_allclose(found[..., :2], Q.qtf_diff[..., :2], rtol=2e-6)


def test_what_is_refused(hydro):
    with pytest.raises(InputError, match="form: one of newman, arithmetic, geometric expected, 'mean' found"):
        newman(hydro, "mean")
    with pytest.raises(InputError, match=r"mean_drift .or qtf_diff. expected"):
        newman(hydro.drop_vars("mean_drift"))
    with pytest.raises(InputError, match="qtf_diff expected"):
        slow_drift_force(irregular(jonswap(hs=3.0, tp=9.0), direction=np.pi, n=5), hydro, [0.0, 1.0])
