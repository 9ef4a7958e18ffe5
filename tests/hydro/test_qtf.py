"""Quadratic transfer functions: symmetry, gaps, and what WAMIT's files make of them."""

import numpy as np
import pytest
import xarray as xr

import ogilvie as og
from ogilvie.errors import FormatError, InputError
from ogilvie.hydro.qtf import filled_qtf, symmetric_qtf, symmetry_defect, with_qtf
from ogilvie.hydro.wamit_write import write_wamit

W = 2 * np.pi / np.array([16.0, 12.5, 10.0, 8.0])
HEADINGS = np.radians([120.0, 150.0, 180.0])


def set_of(headings=HEADINGS, **more):
    n, rng = len(W), np.random.default_rng(0)
    M = np.tile(np.eye(6) * 1e6, (n, 1, 1))
    shape = (n, len(headings), 6)
    return og.hydro_from_arrays(
        omega=W,
        added_mass=M,
        radiation_damping=0.1 * M,
        wave_direction=headings,
        excitation_force=rng.normal(size=shape) + 1j * rng.normal(size=shape),
        **more,
    )


def hermitian(n_b, seed=1):
    """(n_w, n_w, n_b, 6) with Q(j, i) = conj Q(i, j)."""
    rng = np.random.default_rng(seed)
    Q = rng.normal(size=(len(W), len(W), n_b, 6)) + 1j * rng.normal(size=(len(W), len(W), n_b, 6))
    return 1e4 * (Q + Q.swapaxes(0, 1).conj())


def all_pairs(headings):
    return np.array([(a, b) for a in headings for b in headings])


def hermitian_pairs(headings, seed=2):
    """(n_w, n_w, n_b^2, 6): exchanging the waves exchanges frequencies and directions."""
    n, m = len(W), len(headings)
    rng = np.random.default_rng(seed)
    Q = rng.normal(size=(n, m, n, m, 6)) + 1j * rng.normal(size=(n, m, n, m, 6))
    Q = 1e4 * (Q + Q.transpose(2, 3, 0, 1, 4).conj())
    return Q.transpose(0, 2, 1, 3, 4).reshape(n, n, m * m, 6)


def test_the_missing_half_follows_from_the_symmetry_and_is_counted():
    Q = hermitian(3)
    half = np.where(np.tril(np.ones((4, 4), dtype=bool))[:, :, None, None], Q, np.nan)
    found = with_qtf(set_of(), omega=W, qtf_diff=half, qtf_sum=half)
    np.testing.assert_array_equal(found.qtf_diff, Q)
    assert found.qtf_diff.attrs["filled_by_symmetry"] == 6
    S = found.qtf_sum.values
    np.testing.assert_array_equal(S, S.swapaxes(0, 1))
    assert "filled_by_symmetry" not in with_qtf(set_of(), omega=W, qtf_diff=Q).qtf_diff.attrs


@pytest.mark.parametrize("kind", ["qtf_diff", "qtf_sum"])
def test_functions_without_their_symmetry_are_refused(kind):
    Q = hermitian(3) if kind == "qtf_diff" else hermitian(3) + hermitian(3).swapaxes(0, 1)
    with_qtf(set_of(), omega=W, **{kind: Q})
    Q[0, 1, 2, 3] *= -1.0
    with pytest.raises(InputError, match=rf"{kind}: Q\(w2, w1\) = .* expected"):
        with_qtf(set_of(), omega=W, **{kind: Q})


def test_pairs_of_directions_are_exchanged_with_the_frequencies():
    b = HEADINGS[:2]
    Q, two = hermitian_pairs(b), all_pairs(b)
    found = with_qtf(set_of(), omega=W, qtf_diff=Q, direction_pairs=two)
    np.testing.assert_array_equal(found.qtf_diff_pairs, Q)
    upper = Q.copy()
    upper[:, :, 2] = np.nan  # (b2, b1) follows from (b1, b2)
    np.testing.assert_array_equal(with_qtf(set_of(), omega=W, qtf_diff=upper, direction_pairs=two).qtf_diff_pairs, Q)
    Q[0, 0, 0, 0] += 1j * 1e5
    with pytest.raises(InputError, match="qtf_diff_pairs"):
        with_qtf(set_of(), omega=W, qtf_diff=Q, direction_pairs=two)


def test_mistakes():
    with pytest.raises(InputError, match=r"qtf_diff: shape \(4, 4, 3, 6\)"):
        with_qtf(set_of(), omega=W, qtf_diff=np.zeros((4, 4, 2, 6)))
    with pytest.raises(InputError, match="qtf_diff expected"):
        filled_qtf(set_of(), by="zero")
    with pytest.raises(InputError, match="'newman-arithmetic' or 'zero'"):
        filled_qtf(set_of(), by="nearest")
    Q = with_qtf(set_of(), omega=W, qtf_diff=hermitian(3))
    with pytest.raises(InputError, match="same frequencies"):
        symmetric_qtf(Q.assign_coords(omega_2=1.1 * W))
    Q.qtf_diff.values[1, 1] = np.nan
    with pytest.raises(InputError, match="diagonal"):
        filled_qtf(Q, by="zero")


def test_gaps_are_filled_by_the_rule_that_is_named():
    Q = hermitian(3)
    far = np.abs(np.subtract.outer(np.arange(4), np.arange(4))) > 1
    band = with_qtf(set_of(), omega=W, qtf_diff=np.where(far[:, :, None, None], np.nan, Q))
    zero, mean = (filled_qtf(band, by=rule) for rule in ("zero", "newman-arithmetic"))
    assert not zero.qtf_diff.values[far].any()
    np.testing.assert_allclose(mean.qtf_diff.values[0, 3], 0.5 * (Q[0, 0] + Q[3, 3]))
    for found in (zero, mean):
        np.testing.assert_array_equal(found.qtf_diff.values[~far], Q[~far])
        assert symmetric_qtf(found).identical(found)
    assert mean.qtf_diff.attrs["filled_by"] == "newman-arithmetic"


# --- WAMIT's files ---


@pytest.mark.parametrize("ulen", [1.0, 40.0])
def test_written_and_read_again(tmp_path, ulen):
    h = with_qtf(set_of(), omega=W, qtf_diff=hermitian(3), qtf_sum=hermitian(3, 5) + hermitian(3, 5).swapaxes(0, 1))
    paths = write_wamit(h, tmp_path / "hull", ulen=ulen)
    assert {"hull.12d", "hull.12s"} <= {p.name for p in paths}
    back = og.read_hydro(tmp_path / "hull", probe=False)
    for key in ("qtf_diff", "qtf_sum"):
        np.testing.assert_allclose(back[key], h[key], rtol=3e-6, atol=1e-6 * np.abs(h[key]).max())
        assert back[key].attrs["filled_by_symmetry"] == 6
    lines = (tmp_path / "hull.12d").read_text().splitlines()
    assert len(lines) == 10 * 3 * 6  # one half


def test_pairs_of_directions_written_and_read_again(tmp_path):
    Q, two = hermitian_pairs(HEADINGS), all_pairs(HEADINGS)
    h = with_qtf(set_of(), omega=W, qtf_diff=Q, direction_pairs=two)
    write_wamit(h, tmp_path / "hull")
    back = og.read_hydro(tmp_path / "hull", probe=False)
    np.testing.assert_allclose(back.qtf_diff_pairs, Q, rtol=3e-6, atol=1e-6 * np.abs(Q).max())
    np.testing.assert_allclose(back.qtf_direction_2, two[:, 1], atol=1e-6)
    alone = two[:, 0] == two[:, 1]
    np.testing.assert_allclose(back.qtf_diff, Q[:, :, alone], rtol=3e-6, atol=1e-6 * np.abs(Q).max())


def test_a_band_about_the_diagonal_stays_one(tmp_path):
    far = np.abs(np.subtract.outer(np.arange(4), np.arange(4))) > 1
    h = with_qtf(set_of(), omega=W, qtf_diff=np.where(far[:, :, None, None], np.nan, hermitian(3)))
    write_wamit(h, tmp_path / "hull")
    back = og.read_hydro(tmp_path / "hull", probe=False)
    assert np.isnan(back.qtf_diff.values[far]).all()
    np.testing.assert_allclose(back.qtf_diff.values[~far], h.qtf_diff.values[~far], rtol=3e-6, atol=0.1)


def test_halves_that_contradict_each_other_are_refused(tmp_path):
    h = with_qtf(set_of(), omega=W, qtf_diff=hermitian(3))
    write_wamit(h, tmp_path / "hull")
    text = (tmp_path / "hull.12d").read_text()
    row = next(line for line in text.splitlines() if line.split()[0] != line.split()[1])
    T1, T2, *rest = row.split()
    others = [line.split() for line in text.splitlines() if line.split()[:4] == [T1, T2, *rest[:2]]]
    bad = "".join(" ".join([T2, T1, *line[2:]]) + "\n" for line in others)
    (tmp_path / "hull.12d").write_text(text + bad)
    with pytest.raises(FormatError, match=r"hull.12d line \d+: what the other half"):
        og.read_hydro(tmp_path / "hull", probe=False)
    good = "".join(
        " ".join([T2, T1, *line[2:6], str(-float(line[6])), line[7], str(-float(line[8]))]) + "\n" for line in others
    )
    (tmp_path / "hull.12d").write_text(text + good)
    back = og.read_hydro(tmp_path / "hull", probe=False)
    assert back.qtf_diff.attrs["filled_by_symmetry"] == 6  # of the other directions


def test_drift_in_two_directions_written_and_read_again(tmp_path):
    rng = np.random.default_rng(4)
    two = all_pairs(HEADINGS)
    values = rng.normal(size=(4, 9, 6)) + 1j * rng.normal(size=(4, 9, 6))
    values = values + values.reshape(4, 3, 3, 6).swapaxes(1, 2).reshape(4, 9, 6).conj()
    values[..., 2:5] = np.nan
    pairs = xr.DataArray(
        values,
        dims=("omega", "drift_pair", "influenced_dof"),
        coords={f"drift_direction_{k + 1}": ("drift_pair", two[:, k]) for k in (0, 1)},
    )
    alone = values[:, two[:, 0] == two[:, 1]].real
    h = set_of(mean_drift=alone).assign(mean_drift_pairs=pairs)
    h = h.assign(mean_drift_momentum=h.mean_drift)
    write_wamit(h, tmp_path / "hull", ulen=3.0)
    back = og.read_hydro(tmp_path / "hull", probe=False)
    for key in ("mean_drift_pairs", "mean_drift", "mean_drift_momentum"):
        np.testing.assert_allclose(back[key], h[key], rtol=1e-6, atol=1e-6)
    near = h.assign(mean_drift_pressure=h.excitation_force.real).drop_vars("mean_drift_momentum")
    with pytest.raises(InputError, match=r"mean_drift_pairs: components of one of the other"):
        write_wamit(near, tmp_path / "other")


def test_defect_of_a_zero_function():
    assert symmetry_defect(np.zeros((2, 2, 1, 6)), np.zeros((2, 2, 1, 6))) == 0.0
    assert symmetry_defect(np.full((2, 2, 1, 6), np.nan), np.zeros((2, 2, 1, 6))) == 0.0


def test_drift_of_real_vessels_written_and_read_again(shared_data, tmp_path):
    for k, name in enumerate(("mss_wamit_semisub/semisub", "wecsim_sphere_drift/sphere")):
        h = og.read_hydro(shared_data / name)
        write_wamit(h, tmp_path / f"hull{k}", ulen=h.attrs["ulen"])
        back = og.read_hydro(tmp_path / f"hull{k}")
        for key in (key for key in h if str(key).startswith("mean_drift")):
            size = np.nanmax(np.abs(h[key].values), initial=0.0)
            np.testing.assert_allclose(back[key], h[key], rtol=1e-6, atol=1e-7 * size)
        assert back.mean_drift.attrs["method"] == h.mean_drift.attrs["method"]
