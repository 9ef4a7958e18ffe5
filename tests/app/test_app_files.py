"""Files of the application: whole or not at all, read back equal, recognised for what they are."""

import os
import warnings

import numpy as np
import pytest
import xarray as xr

import ogilvie as og
from ogilvie.app.files import collected_warnings, kind_of, read_memory, read_result, write_memory, write_result, write_whole
from ogilvie.errors import FormatError, InputError, OgilvieWarning


@pytest.fixture(scope="module")
def memory():
    w = np.linspace(0.05, 4.0, 80)
    K_hat = 1j * w / ((1j * w + 0.4) ** 2 + 1)
    A, B = (2 + K_hat.imag / w)[:, None, None], K_hat.real[:, None, None]
    K = og.retardation(og.hydro_from_arrays(omega=w, added_mass=A, radiation_damping=B, dofs=("heave",)))
    return K, og.identify(K)


def test_memory_is_read_back_equal(tmp_path, memory):
    K, ssm = memory
    again, model = read_memory(write_memory(tmp_path / "m.npz", K, ssm))
    np.testing.assert_array_equal(again.K, K.K)
    np.testing.assert_array_equal(model.A, ssm.A)
    assert (again.dofs, again.source, again.notes) == (K.dofs, K.source, K.notes)
    assert (model.is_passive, model.method, model.notes) == (ssm.is_passive, ssm.method, ssm.notes)
    assert model.passivity_margin == ssm.passivity_margin
    np.testing.assert_array_equal(model.impulse(K.t), ssm.impulse(K.t))


def test_memory_without_a_model(tmp_path, memory):
    K, model = read_memory(write_memory(tmp_path / "m.npz", memory[0]))
    assert model is None
    assert K.dt == memory[0].dt


@pytest.mark.parametrize("damage", ["cut", "text", "other"])
def test_damaged_memory_is_refused(tmp_path, memory, damage):
    path = write_memory(tmp_path / "m.npz", *memory)
    if damage == "cut":
        path.write_bytes(path.read_bytes()[:-200])
    elif damage == "text":
        path.write_text("no archive")
    else:
        np.savez(path, a=np.zeros(3))
    with pytest.raises(FormatError, match=r"m.npz: a file of `ogilvie identify` expected, another found"):
        read_memory(path)


def test_results_are_read_back_equal(tmp_path):
    run = xr.Dataset(
        {"eta": (("time", "dof"), np.random.default_rng(1).normal(size=(5, 2)))}, {"time": np.arange(5.0), "dof": ["a", "b"]}
    )
    run.attrs = {"seeds": [1, 2], "title": "x"}
    again = read_result(write_result(run, tmp_path / "r.nc"))
    xr.testing.assert_equal(again, run)
    assert list(again.attrs["seeds"]) == [1, 2]


def test_a_result_is_not_confused_with_something_else(tmp_path):
    xr.Dataset({"b": ("x", [1.0])}).to_netcdf(tmp_path / "r.nc", engine="h5netcdf")
    with pytest.raises(FormatError, match="result of a simulation"):
        read_result(tmp_path / "r.nc")
    (tmp_path / "r.nc").write_bytes(b"CDF broken")
    with pytest.raises(FormatError, match="a netCDF file expected"):
        read_result(tmp_path / "r.nc")


def test_nothing_is_left_behind_when_writing_fails(tmp_path):
    target = tmp_path / "a.txt"
    target.write_text("old")

    def fails(path):
        path.write_text("half")
        raise RuntimeError("full disk")

    with pytest.raises(RuntimeError):
        write_whole(target, fails)
    assert target.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.txt"]


def test_files_get_the_rights_that_the_user_wants(tmp_path):
    mask = os.umask(0o027)
    try:
        path = write_whole(tmp_path / "a.txt", lambda p: p.write_text("x"))
    finally:
        os.umask(mask)
    assert path.stat().st_mode & 0o777 == 0o640


def test_a_missing_folder_is_named(tmp_path):
    with pytest.raises(InputError, match="an existing folder expected"):
        write_whole(tmp_path / "no" / "a.txt", lambda p: p.write_text("x"))


def test_kinds(tmp_path, memory):
    write_memory(tmp_path / "m.npz", *memory)
    (tmp_path / "c.toml").write_text("a = 1")
    (tmp_path / "h.gdf").write_text("x")
    (tmp_path / "s.1").write_text("x")
    run = xr.Dataset({"eta": (("time",), [0.0])}, {"time": [0.0]})
    write_result(run, tmp_path / "r.nc")
    xr.Dataset({"added_mass": ("omega", [0.0])}, {"omega": [1.0]}).to_netcdf(tmp_path / "h.nc", engine="h5netcdf")
    names = {
        "m.npz": "memory",
        "c.toml": "case",
        "h.gdf": "mesh",
        "s.1": "coefficients",
        "s": "coefficients",
        "r.nc": "result",
        "h.nc": "coefficients",
    }
    assert {name: kind_of(tmp_path / name) for name in names} == names
    with pytest.raises(FileNotFoundError):
        kind_of(tmp_path / "nothing.gdf")
    (tmp_path / "empty.gdf").write_text("")
    with pytest.raises(FormatError, match="an empty one found"):
        kind_of(tmp_path / "empty.gdf")


def test_own_warnings_are_collected_once_and_others_pass():
    notes: list[str] = []

    def work():
        with collected_warnings(notes):
            for _ in range(3):
                warnings.warn("mine", OgilvieWarning)
            warnings.warn("other", UserWarning)

    with pytest.warns(UserWarning, match="other"):
        work()
    assert notes == ["mine"]
