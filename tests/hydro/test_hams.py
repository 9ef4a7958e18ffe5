"""HAMS: the folder of a case, its constants, its first column, and the motions it writes in units of its own."""

import gzip
import shutil
from pathlib import Path

import numpy as np
import pytest

from ogilvie.errors import FormatError, InputError
from ogilvie.hydro.files import read_hydro
from ogilvie.hydro.hams import read_control_file, read_hydrostatic

CONTROL = """   --------------HAMS Control file---------------

   Waterdepth  {depth}            (a negative value denotes the infinite depth)

   #Start Definition of Wave Frequencies
    0_inf_frequency_limits      1
    Input_frequency_type        1
    Output_frequency_type       {kind}
    Number_of_frequencies      -2
   #End Definition of Wave Frequencies
    Reference_body_center       {x}       0.000       {z}
    Reference_body_length   {length}
   Output_frequency_type options: same as Input_frequency_type options
"""


def matrix(M) -> str:
    return "\n".join("   ".join(f"{x:.5E}" for x in row) for row in M)


M = np.diag([3e3, 3e3, 3e3, 2e3, 2e3, 2e3])
C = np.diag([0.0, 0.0, 3e4, 1e4, 1e4, 0.0])
RG = 1025.0 * 9.80665


def hydrostatic(damping=0.0, quadratic=0.0) -> str:
    blocks = [("Body Mass Matrix", M), ("External Linear Damping Matrix", damping * M)]
    blocks += [("External Quadratic Damping Matrix", quadratic * M), ("Hydrostatic Restoring Matrix", C)]
    blocks += [("External Restoring Matrix", 0.1 * C + np.diag([1e3] * 6))]
    return " Center of Gravity:\n 0.0 0.0 0.0\n" + "\n".join(f" {name}:\n{matrix(value)}" for name, value in blocks) + "\n"


def response(values, columns) -> str:
    text = ""
    for x, row in zip(columns, values):
        for m, v in enumerate(row):
            phase = np.degrees(np.angle(v))
            text += f"{x:14.6E}{0.0:14.6E}{m + 1:6d}{abs(v):14.6E}{phase:14.6E}{v.real:14.6E}{v.imag:14.6E}\n"
    return text


def case(folder: Path, *, kind=4, depth="-1.D0", x=0.0, z=0.0, length="1.D0", raw=True, damping=0.0, quadratic=0.0) -> Path:
    """A case of two frequencies with motions from its own equation of motion."""
    k, h = np.array([0.2, 0.1]), float(depth.replace("D", "E"))
    w = np.sqrt(9.80665 * k * (np.tanh(k * h) if h > 0 else 1.0))
    columns = {1: w**2 / 9.80665, 2: k, 3: w, 4: 2 * np.pi / w, 5: 2 * np.pi / k}[kind]
    zero, infinite = (-1.0, 0.0) if kind > 3 else (1e-20, -1.0)
    A, B = 0.5 * M / 1025.0, 0.02 * M / 1025.0  # so that A = M/2 and B = 0.02 omega M
    F = np.array([[4e3j * s**2, 1.0, 3e4 - 1.5e3 * s**2 + 60j * s**2, 2.0, 3.0j, 4.0] for s in w])
    Z = [-(s**2) * 1.5 * M + 1j * s * (0.02 * s + damping) * M + 1.1 * C + 1e3 * np.eye(6) for s in w]
    X = np.array([np.linalg.solve(z, f) for z, f in zip(Z, F)])
    L = float(length.replace("D", "E"))
    out = folder / "Output" / "Wamit_format"
    out.mkdir(parents=True, exist_ok=True)
    (folder / "Input").mkdir(exist_ok=True)
    (folder / "Input" / "ControlFile.in").write_text(CONTROL.format(kind=kind, depth=depth, x=x, z=z, length=length))
    (folder / "Input" / "Hydrostatic.in").write_text(hydrostatic(damping, quadratic))
    rows = [f"{s:14.6E}{i + 1:6d}{i + 1:6d}{A[i, i]:14.6E}\n" for s in (zero, infinite) for i in range(6)]
    rows += [f"{s:14.6E}{i + 1:6d}{i + 1:6d}{A[i, i]:14.6E}{B[i, i]:14.6E}\n" for s in columns for i in range(6)]
    (out / "Buoy.1").write_text("".join(rows))
    (out / "Buoy.3").write_text(response(F / RG, columns))
    unit = 1j / RG / L ** np.array([2, 2, 2, 3, 3, 3]) if raw else 1.0
    (out / "Buoy.4").write_text(response(X * unit, columns))
    hst = "".join(f"{i + 1:6d}{j + 1:6d}{C[i, j] / RG:16.6E}\n" for i in range(6) for j in range(6))
    (out / "Buoy.hst").write_text(hst)
    return folder


def expected_motions(h) -> np.ndarray:
    w = h.omega.values[:, None, None]
    Z = -(w**2) * (h.inertia_matrix.values + h.added_mass.values) + h.hydrostatic_stiffness.values + h.external_stiffness.values
    Z = Z + 1j * w * (h.radiation_damping.values + h.external_damping.values)
    return np.linalg.solve(Z, h.excitation_force.values.swapaxes(1, 2)).swapaxes(1, 2)


@pytest.mark.parametrize("depth", ["-1.D0", "12.D0"])
@pytest.mark.parametrize("kind", [1, 2, 3, 4, 5])
def test_every_kind_of_first_column(tmp_path, kind, depth):
    h = read_hydro(case(tmp_path, kind=kind, depth=depth))
    k, tanh = np.array([0.1, 0.2]), np.tanh(12.0 * np.array([0.1, 0.2])) if depth[0] != "-" else 1.0
    np.testing.assert_allclose(h.omega, np.sqrt(9.80665 * k * tanh), rtol=1e-6)
    np.testing.assert_allclose(h.radiation_damping[:, 2, 2], 0.02 * 3e3 * h.omega, rtol=1e-5)
    np.testing.assert_allclose(h.added_mass[:, 2, 2], 1.5e3, rtol=1e-5)
    np.testing.assert_allclose([h.added_mass_zero[2, 2], h.added_mass_inf[2, 2]], 1.5e3, rtol=1e-5)
    assert h.attrs["water_depth"] == (12.0 if depth[0] != "-" else np.inf)
    assert (h.attrs["first_column_source"], h.attrs["rho"], h.attrs["g"]) == ("ControlFile.in", 1025.0, 9.80665)


@pytest.mark.parametrize("raw", [True, False])
def test_motions_in_both_units_that_hams_has_written(tmp_path, raw):
    h = read_hydro(case(tmp_path, raw=raw, length="2.5D0" if raw else "1.D0", damping=0.3))
    np.testing.assert_allclose(h.motion_rao, expected_motions(h), rtol=1e-4)
    np.testing.assert_allclose(h.excitation_force[:, 0, 0], 1j * h.omega.values**2 * 4e3, rtol=1e-5, atol=1e-2)


def test_motions_that_cannot_be_told_are_left_out(tmp_path):
    h = read_hydro(case(tmp_path, quadratic=0.5))
    assert "motion_rao" not in h
    assert "motions (.4) left out: external quadratic damping" in h.attrs["notes"]
    file = case(tmp_path, kind=2) / "Output/Wamit_format/Buoy.4"
    file.write_text(response(np.full((2, 6), 1 + 1j), [0.2, 0.1]))
    assert "it fits neither X nor i X" in read_hydro(tmp_path).attrs["notes"]
    (tmp_path / "Output/Wamit_format/Buoy.3").unlink()
    assert "no inertia or stiffness" in read_hydro(tmp_path, probe=False).attrs["notes"]


def test_data_about_another_point_come_to_the_origin(tmp_path):
    """A diagonal set about (0, 0, z): about O there are A15 = z A11 and A55 + z^2 A11, and F5 + z F1."""
    h = read_hydro(case(tmp_path, z=-2.0))
    np.testing.assert_allclose(h.added_mass[:, 0, 4], -2.0 * 1.5e3, rtol=1e-5)
    np.testing.assert_allclose(h.added_mass[:, 4, 4], 1e3 + 4.0 * 1.5e3, rtol=1e-5)
    np.testing.assert_allclose(h.excitation_force[:, 0, 4], -2.0 * h.excitation_force[:, 0, 0] + 3j, rtol=1e-4, atol=1e-2)
    assert h.attrs["moved_from"] == [0.0, 0.0, -2.0]


def test_how_a_case_is_found(tmp_path):
    whole = read_hydro(case(tmp_path / "case"))
    out = tmp_path / "case/Output/Wamit_format"
    (out / "Buoy.3.gz").write_bytes(gzip.compress((out / "Buoy.3").read_bytes()))
    (out / "Buoy.3").unlink()
    for path in (out, out / "Buoy.1", out / "Buoy.3.gz", tmp_path / "case"):
        assert read_hydro(path).equals(whole)
    (tmp_path / "case/Input/ControlFile.in").unlink()
    with pytest.raises(FormatError, match=r"Input/ControlFile.in of the HAMS case expected nearby"):
        read_hydro(out / "Buoy.1")
    shutil.copytree(out, tmp_path / "case/Output_2/Wamit_format")
    case(tmp_path / "case")
    with pytest.raises(FormatError, match=r"one \*.1 in Wamit_format expected, .*Output_2.* found"):
        read_hydro(tmp_path / "case")
    with pytest.raises(InputError, match="ulen: only WAMIT files"):
        read_hydro(out, ulen=2.0)


def test_density_and_gravity_are_proved_by_the_stiffness(tmp_path):
    with pytest.raises(FormatError, match=r"Buoy.hst: C\(3,3\) rho g = 30000 as in Hydrostatic.in expected, 29268.3"):
        read_hydro(case(tmp_path), rho=1000.0)


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        ("ControlFile.in", "Waterdepth  -1.D0", "Waterdepth  deep", r"ControlFile.in line 3: 1 numbers after Waterdepth"),
        ("ControlFile.in", "Waterdepth", "Depth", r"ControlFile.in: a line Waterdepth expected, none found"),
        ("ControlFile.in", "Output_frequency_type       4", "Output_frequency_type       9", r"type 1 to 5 expected, 9 found"),
        ("Hydrostatic.in", "3.00000E+03   0.00000E+00", "3.00000E+03", r"Hydrostatic.in line 3: six lines of six numbers"),
        ("Hydrostatic.in", "Body Mass", "Body", r"Hydrostatic.in: Body Mass Matrix: expected, none found"),
        ("ControlFile.in", "Waterdepth", "\x00", r"ControlFile.in line 3: plain text expected"),
    ],
)
def test_damaged_input_files(tmp_path, file, old, new, message):
    path = case(tmp_path) / "Input" / file
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(FormatError, match=message):
        read_hydro(tmp_path)


def test_shared_cases(shared_data):
    """The certification cases: constants from the input files, motions by HAMS's own coefficients, near unity in long waves."""
    folder = shared_data / "hams_certtest"
    cylinder, moonpool = read_hydro(folder / "Cylinder"), read_hydro(folder / "Moonpool/Output_Benchmark/Wamit_format")
    assert (cylinder.attrs["water_depth"], moonpool.attrs["water_depth"]) == (10.0, 2.0)
    assert (cylinder.sizes["wave_direction"], moonpool.sizes["wave_direction"]) == (36, 1)
    np.testing.assert_allclose(np.rad2deg(cylinder.wave_direction), np.arange(0.0, 360.0, 10.0))
    k = 0.1 * np.arange(1, 31)
    np.testing.assert_allclose(cylinder.omega**2, 9.80665 * k, rtol=2e-6)  # wavenumbers omega^2/g of ControlFile.in
    np.testing.assert_allclose(np.abs(cylinder.motion_rao[0, :, 2]), 1.0, atol=0.01)
    np.testing.assert_allclose(np.degrees(np.angle(cylinder.motion_rao[0, :, 2])), 0.0, atol=0.1)
    for h in (cylinder, moonpool):
        scale = np.abs(h.motion_rao.values).max(axis=(0, 1))
        assert (np.abs(h.motion_rao.values - expected_motions(h)) < 1e-2 * scale + 1e-9).all()


def test_readers_of_the_input_files(shared_data):
    folder = shared_data / "hams_certtest/Moonpool/Input"
    assert read_control_file(folder / "ControlFile.in") == ("period", 2.0, (0.0, 0.0, 0.0), 1.0)
    found = read_hydrostatic(folder / "Hydrostatic.in")
    assert set(found) == {
        "inertia_matrix",
        "external_damping",
        "quadratic_damping",
        "hydrostatic_stiffness",
        "external_stiffness",
    }
    np.testing.assert_allclose(found["hydrostatic_stiffness"][2, 2:5], [2.36452e4, -1.60611, -5.84136])
