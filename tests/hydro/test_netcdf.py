"""netCDF: the package's own files survive bit for bit, Capytaine's come out in the project's convention."""

import numpy as np
import pytest
import xarray as xr

from ogilvie.errors import ConventionError, FormatError, InputError
from ogilvie.hydro.capytaine_data import from_capytaine
from ogilvie.hydro.files import read_hydro
from ogilvie.hydro.netcdf import merge_complex, read_netcdf, separate_complex, write_netcdf
from ogilvie.hydro.schema import DOFS, hydro_from_arrays


def everything() -> xr.Dataset:
    """A data set with every kind of variable, NaN and infinite depth."""
    rng = np.random.default_rng(5)
    w, b = np.array([0.3, 0.7, 1.1]), np.array([0.0, np.pi / 2, np.pi])
    M = rng.normal(size=(6, 6))
    F = rng.normal(size=(3, 3, 6)) + 1j * rng.normal(size=(3, 3, 6))
    drift = rng.normal(size=(3, 3, 6))
    drift[..., 2:5] = np.nan
    h = hydro_from_arrays(
        omega=w,
        added_mass=rng.normal(size=(3, 6, 6)),
        radiation_damping=rng.normal(size=(3, 6, 6)),
        added_mass_inf=M,
        wave_direction=b,
        excitation_force=F,
        motion_rao=1j * F,
        mean_drift=drift,
        hydrostatic_stiffness=M,
        inertia_matrix=M @ M.T,
        name="all",
        attrs={"notes": "one; two", "moved_from": [0.0, 0.0, -3.5], "count": 3},
    )
    qtf = xr.DataArray(
        rng.normal(size=(2, 2, 3, 6)) + 1j,
        dims=("omega_1", "omega_2", "wave_direction", "influenced_dof"),
        coords={"omega_1": [0.3, 0.7], "omega_2": [0.3, 0.7]},
    )
    return h.assign(qtf_diff=qtf)


def test_own_files_survive_bit_for_bit(tmp_path):
    h = everything()
    path = write_netcdf(h, tmp_path / "all.nc")
    assert [p.name for p in tmp_path.iterdir()] == ["all.nc"]
    xr.testing.assert_identical(read_netcdf(path), h)
    xr.testing.assert_equal(read_hydro(path, probe=False), h)
    write_netcdf(read_netcdf(path), path)
    xr.testing.assert_identical(read_netcdf(path), h)


def test_real_sets_survive(shared_data, tmp_path):
    h = read_hydro(shared_data / "mss_wamit_tanker/tanker")
    xr.testing.assert_identical(read_hydro(write_netcdf(h, tmp_path / "t.nc")), h)


def test_splitting_complex_numbers_is_undone():
    h = everything()
    split = separate_complex(h)
    assert split.excitation_force.dims[0] == "complex"
    assert all(v.dtype.kind != "c" for v in split.data_vars.values())
    xr.testing.assert_identical(merge_complex(split), h)
    with pytest.raises(FormatError, match="labels"):
        merge_complex(split.assign_coords(complex=["a", "b"]))


def test_the_writer_refuses(tmp_path):
    h = everything()
    with pytest.raises(InputError, match="an existing folder expected"):
        write_netcdf(h, tmp_path / "nowhere" / "h.nc")
    with pytest.raises(InputError, match="attribute strange: text or numbers expected, None found"):
        write_netcdf(h.assign_attrs(strange=None), tmp_path / "h.nc")
    with pytest.raises(InputError, match="rho: positive number expected"):
        write_netcdf(h.assign_attrs(rho=-1.0), tmp_path / "h.nc")
    assert list(tmp_path.iterdir()) == []


def test_nothing_half_written(tmp_path, monkeypatch):
    path = write_netcdf(everything(), tmp_path / "h.nc")
    before = path.read_bytes()

    def break_down(self, name, **_):
        with open(name, "wb") as stream:
            stream.write(b"half")
        raise OSError("disk full")

    monkeypatch.setattr(xr.Dataset, "to_netcdf", break_down)
    with pytest.raises(OSError, match="disk full"):
        write_netcdf(everything(), path)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["h.nc"]


@pytest.mark.parametrize("kept", [0, 4, 100, 2000, -100, -1])
def test_truncated_files_are_refused(tmp_path, kept):
    path = write_netcdf(everything(), tmp_path / "h.nc")
    path.write_bytes(path.read_bytes()[:kept])
    with pytest.raises(FormatError, match=r"h.nc: a netCDF file expected"):
        read_netcdf(path)


def test_damaged_numbers_are_refused(tmp_path):
    """Every byte of the numbers is guarded by a checksum."""
    h = everything()
    path = write_netcdf(h, tmp_path / "h.nc")
    raw = path.read_bytes()
    at = raw.index(h.added_mass.values.tobytes())
    for k in (0, 7, 100):
        path.write_bytes(raw[: at + k] + bytes([raw[at + k] ^ 1]) + raw[at + k + 1 :])
        with pytest.raises(FormatError, match=r"h.nc: a netCDF file expected"):
            read_netcdf(path)


@pytest.mark.parametrize(
    "content", [b"", b"text\n", bytes(256), b"\x89HDF\r\n\x1a\n" + 200 * b"\x00", b"CDF\x01" + 60 * b"\xff"]
)
def test_other_content_is_refused(tmp_path, content):
    (tmp_path / "h.nc").write_bytes(content)
    with pytest.raises(FormatError, match=r"h.nc: a netCDF file expected"):
        read_hydro(tmp_path / "h.nc")


def test_missing_files_and_strangers(tmp_path):
    with pytest.raises(InputError, match="an existing file expected"):
        read_hydro(tmp_path / "h.nc")
    xr.Dataset({"a": ("x", [1.0])}).to_netcdf(tmp_path / "h.nc", engine="h5netcdf")
    with pytest.raises(FormatError, match=r"h.nc: added_mass and radiation_damping: expected, not found"):
        read_hydro(tmp_path / "h.nc")


# --- Capytaine ---


@pytest.fixture(scope="module")
def solved() -> xr.Dataset:
    """A hemisphere of 32 panels, solved by Capytaine itself."""
    cpt = pytest.importorskip("capytaine")
    cpt.set_logging("ERROR")
    mesh = cpt.mesh_sphere(radius=1.0, center=(0, 0, 0), resolution=(8, 8)).immersed_part()
    dofs = cpt.rigid_body_dofs(rotation_center=(0, 0, 0))
    body = cpt.FloatingBody(mesh, dofs=dofs, center_of_mass=(0, 0, -0.2), name="ball")
    body.inertia_matrix = body.compute_rigid_body_inertia()
    body.hydrostatic_stiffness = body.compute_hydrostatic_stiffness()
    matrix = xr.Dataset(
        coords={
            "omega": [0.0, 0.5, 1.0, 2.0, np.inf],
            "wave_direction": [0.0, np.pi / 2, np.pi],
            "radiating_dof": list(body.dofs),
            "rho": 1025.0,
        }
    )
    return cpt.BEMSolver().fill_dataset(matrix, body, progress_bar=False)


@pytest.fixture
def capytaine_file(solved, tmp_path):
    import capytaine as cpt

    path = tmp_path / "ball.nc"
    cpt.export_dataset(str(path), solved)
    return path


def test_capytaine_files_come_out_conjugated_and_by_name(solved, capytaine_file):
    h = read_hydro(capytaine_file)
    np.testing.assert_allclose(h.omega, [0.5, 1.0, 2.0])
    assert tuple(h.influenced_dof.values) == DOFS
    assert (h.attrs["rho"], h.attrs["g"], h.attrs["water_depth"], h.attrs["name"]) == (1025.0, 9.81, np.inf, "ball")
    for theirs, ours in (("Heave", "heave"), ("Pitch", "pitch")):
        F = solved.excitation_force.sel(omega=[0.5, 1.0, 2.0], influenced_dof=theirs).values
        np.testing.assert_allclose(h.excitation_force.sel(influenced_dof=ours), F.conj())
        A = solved.added_mass.sel(influenced_dof=theirs, radiating_dof="Surge").values
        np.testing.assert_allclose(h.added_mass.sel(influenced_dof=ours, radiating_dof="surge"), A[1:4])
        np.testing.assert_allclose(h.added_mass_zero.sel(influenced_dof=ours, radiating_dof="surge"), A[0])
        np.testing.assert_allclose(h.added_mass_inf.sel(influenced_dof=ours, radiating_dof="surge"), A[4])
    np.testing.assert_allclose(h.excitation_force, h.Froude_Krylov_force + h.diffraction_force)
    np.testing.assert_allclose(h.hydrostatic_stiffness, solved.hydrostatic_stiffness)
    np.testing.assert_allclose(h.inertia_matrix, solved.inertia_matrix)
    np.testing.assert_allclose(h.attrs["probe_heave_ratio"], 1.0, atol=0.02)
    np.testing.assert_allclose(h.attrs["probe_surge_phase_deg"], 90.0, atol=1.0)


def test_unconjugated_capytaine_data_would_be_refused(solved, capytaine_file, monkeypatch):
    """The probe sees exp(-i omega t) in Capytaine's own numbers."""
    monkeypatch.setattr("ogilvie.hydro.capytaine_data.np.conj", lambda x: x)
    with pytest.raises(ConventionError, match=r"heave ratio -1.0.*surge phase -89.*complex conjugate"):
        read_hydro(capytaine_file)


def test_the_order_of_dimensions_and_dofs_does_not_matter(solved):
    expected = from_capytaine(solved)
    shuffled = solved.transpose("radiating_dof", "influenced_dof", "wave_direction", "omega", ...)
    shuffled = shuffled.isel(influenced_dof=[4, 2, 0, 5, 3, 1], radiating_dof=[1, 0, 3, 2, 5, 4], omega=[4, 2, 0, 1, 3])
    xr.testing.assert_equal(from_capytaine(shuffled), expected)
    for axis in ("period", "wavenumber", "wavelength", "freq"):
        xr.testing.assert_equal(from_capytaine(solved.swap_dims(omega=axis)), expected)


def test_some_dofs_one_direction_one_frequency(solved):
    h = from_capytaine(solved.sel(radiating_dof=["Heave"], omega=[1.0], wave_direction=0.0))
    assert h.influenced_dof.values.tolist() == ["heave"]
    assert h.excitation_force.shape == (1, 1, 1)
    h = from_capytaine(solved.sel(omega=1.0))
    assert h.added_mass.shape == (1, 6, 6)


def test_dofs_about_another_centre_come_to_the_origin(solved):
    from ogilvie.frames import shift_matrix

    p = np.array([0.5, 0.0, -1.5])
    H = shift_matrix(-p)
    expected = from_capytaine(solved)
    moved = solved.assign_coords(rotation_center=("space_coordinate", p))
    for key in ("added_mass", "radiation_damping", "hydrostatic_stiffness", "inertia_matrix"):
        moved[key] = (solved[key].dims, H.T @ solved[key].transpose(..., "influenced_dof", "radiating_dof").values @ H)
    for key in ("excitation_force", "Froude_Krylov_force", "diffraction_force"):
        moved[key] = (solved[key].dims, solved[key].values @ H)
    h = from_capytaine(moved)
    assert h.attrs["moved_from"] == p.tolist()
    for key in expected.data_vars:
        np.testing.assert_allclose(h[key], expected[key], atol=1e-9 * np.abs(expected[key].values).max())


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.drop_vars("added_mass"), "added_mass and radiation_damping: expected, not found"),
        (lambda d: d.assign_coords(forward_speed=3.0), "forward_speed: zero expected, 3 m/s found"),
        (lambda d: d.drop_vars("omega"), "omega: a coordinate expected"),
        (lambda d: d.drop_vars("rho"), "rho: expected, not found. Give it"),
        (lambda d: xr.concat([d, d.assign_coords(water_depth=5.0)], "water_depth"), "water_depth: one value expected"),
        (lambda d: d.assign_coords(influenced_dof=[f"a__{n}" for n in "xyzuvw"]), "surge to yaw of one body expected"),
        (
            lambda d: xr.concat(
                [d.assign_coords(influenced_dof=[f"{b}__{n}" for n in d.influenced_dof.values]) for b in ("one", "two")],
                "influenced_dof",
                data_vars="all",
            ),
            "Several bodies are not read",
        ),
        (lambda d: d.assign(added_mass=d.added_mass * np.nan), "added_mass: finite numbers expected"),
        (lambda d: d.expand_dims(theta=[0.0, 1.0]), "dimensions .* expected"),
    ],
)
def test_what_cannot_be_used_is_named(solved, change, message):
    with pytest.raises(InputError, match=message):
        from_capytaine(change(solved))


def test_a_value_that_contradicts_the_file_is_refused(solved, capytaine_file):
    assert from_capytaine(solved.drop_vars("rho"), rho=1000.0).attrs["rho"] == 1000.0
    with pytest.raises(FormatError, match=r"ball.nc: rho: 1025 as in the data set expected, 1000 given"):
        read_hydro(capytaine_file, rho=1000.0)
