"""WAMIT's files: units, first column, reference point, fitting together, and what is said about damaged ones."""

import gzip
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from ogilvie.errors import FormatError, InputError, OgilvieWarning
from ogilvie.frames import shift_matrix
from ogilvie.hydro.files import read_hydro
from ogilvie.hydro.schema import DOFS, hydro_from_arrays
from ogilvie.hydro.wamit_write import write_wamit

REAL = {
    "tanker": "mss_wamit_tanker/tanker",
    "fpso": "mss_wamit_fpso/fpso",
    "semisub": "mss_wamit_semisub/semisub",
    "sphere": "wecsim_sphere_drift/sphere",
    "cyl": "wecsim_cylinder/cyl",
    "ellipsoid": "wecsim_ellipsoid/ellipsoid",
    "buoy": "fshd_buoya5/BuoyA5",
}


def buoy(n: int = 5, degrees=(0.0, 90.0, 180.0), *, seed: int = 1) -> xr.Dataset:
    """A made-up body whose long-wave forces obey the relative-motion relations, so that the probe is content."""
    rng = np.random.default_rng(seed)
    w, b = np.linspace(0.2, 0.6, n), np.deg2rad(degrees)
    M = np.diag([2e6, 2e6, 2e6, 4e7, 5e7, 6e7]) + 0.0
    M[0, 4] = M[4, 0] = -1e6
    M[1, 3] = M[3, 1] = 1e6
    A = (0.5 + 0.3 * np.exp(-w))[:, None, None] * M
    B = 1e4 * w[:, None, None] ** 3 * M / 1e6
    C = np.zeros((6, 6))
    C[2, 2], C[3, 3], C[4, 4], C[2, 4], C[4, 2] = 3e6, 8e6, 9e6, -1e5, -1e5
    F = 1e5 * (rng.normal(size=(n, len(b), 6)) + 1j * rng.normal(size=(n, len(b), 6)))
    F[:, :, 0] = 1j * w[:, None] ** 2 * 4e6 * np.cos(b)
    F[:, :, 1] = 1j * w[:, None] ** 2 * 4e6 * np.sin(b)
    F[:, :, 2] = (C[2, 2] - w**2 * A[:, 2, 2] + 1j * w * B[:, 2, 2])[:, None]
    FK = 0.7 * F
    return hydro_from_arrays(
        omega=w,
        wave_direction=b,
        added_mass=A,
        radiation_damping=B,
        added_mass_inf=0.5 * M,
        added_mass_zero=0.8 * M,
        excitation_force=F,
        froude_krylov_force=FK,
        diffraction_force=F - FK,
        motion_rao=F / 3e6,
        hydrostatic_stiffness=C,
        inertia_matrix=M,
        external_damping=0.01 * M,
        external_stiffness=0.02 * M,
        rho=1000.0,
        g=9.81,
        water_depth=50.0,
    )


def assert_same(a: xr.Dataset, b: xr.Dataset, *, digits: float = 2e-6) -> None:
    """Every variable equal to the printed digits of its own largest number of a kind."""
    assert set(a.data_vars) == set(b.data_vars)
    np.testing.assert_allclose(a.omega, b.omega, rtol=digits)
    np.testing.assert_allclose(a.wave_direction, b.wave_direction, atol=1e-6)
    for key in a.data_vars:
        x, y = a[key].values, b[key].values
        parts = (x.real - y.real, x.imag - y.imag) if np.iscomplexobj(x) else (x - y,)
        size = np.abs(x)
        for part in parts:
            assert np.all(np.isnan(part) | (np.abs(part) <= digits * size)), key
        assert np.array_equal(np.isnan(x), np.isnan(y)), key


# --- units, by hand ---


def write(folder: Path, **texts: str) -> Path:
    for suffix, text in texts.items():
        (folder / f"hull.{suffix.lstrip('_')}").write_text(text)
    return folder / "hull"


ONE = """ -1.0 3 3 5.0
  0.0 3 3 2.0
  2.0 3 3 3.0 4.0
  2.0 5 5 30.0 40.0
  2.0 3 5 7.0 8.0
  2.0 5 3 7.0 8.0
 -1.0 5 5 1.0
 -1.0 3 5 1.0
 -1.0 5 3 1.0
  0.0 5 5 1.0
  0.0 3 5 1.0
  0.0 5 3 1.0
"""
THREE = """ WAMIT Numeric Output -- Filename  hull.3    01-Jan-2020  10:00:00
 2.0 180.0 3 5.0 53.130102 3.0 4.0
 2.0 180.0 5 2.0 90.0 0.0 2.0
"""


def test_units_by_hand(tmp_path):
    L, rho, g, w = 2.0, 1000.0, 10.0, np.pi
    stem = write(tmp_path, _1=ONE, _3=THREE, _4=THREE)
    h = read_hydro(stem, ulen=L, rho=rho, g=g, probe=False)
    assert h.influenced_dof.values.tolist() == ["heave", "pitch"]
    np.testing.assert_allclose(h.omega, [w])
    np.testing.assert_allclose(h.added_mass[0], rho * np.array([[3 * L**3, 7 * L**4], [7 * L**4, 30 * L**5]]))
    np.testing.assert_allclose(h.radiation_damping[0], rho * w * np.array([[4 * L**3, 8 * L**4], [8 * L**4, 40 * L**5]]))
    np.testing.assert_allclose(h.added_mass_zero[0, 0], rho * 5 * L**3)
    np.testing.assert_allclose(h.added_mass_inf[0, 0], rho * 2 * L**3)
    np.testing.assert_allclose(h.excitation_force[0, 0], rho * g * np.array([(3 + 4j) * L**2, 2j * L**3]))
    np.testing.assert_allclose(h.motion_rao[0, 0], [3 + 4j, 2j / L])
    np.testing.assert_allclose(h.wave_direction, [np.pi])
    assert (h.attrs["rho_source"], h.attrs["ulen"], h.attrs["water_depth_source"]) == ("given", 2.0, "assumed")


def test_stiffness_by_hand(tmp_path):
    C = np.arange(36.0).reshape(6, 6)
    hst = "".join(f"{i + 1} {j + 1} {C[i, j]}\n" for i in range(6) for j in range(6))
    h = read_hydro(write(tmp_path, _1=ONE, hst=hst), ulen=2.0, rho=1000.0, g=10.0)
    np.testing.assert_allclose(h.hydrostatic_stiffness, 1e4 * np.array([[14 * 4, 16 * 8], [26 * 8, 28 * 16]]))


@pytest.mark.parametrize(
    ("kind", "value", "omega"),
    [
        (1, 2.0, np.pi),
        (2, 2.0, 2.0),
        (3, 2.0, np.sqrt(9.81 * 2.0 / 4.0)),
        (4, 2.0, np.sqrt(9.81 * 0.5 * np.tanh(0.5 * 3.0))),
    ],
)
def test_first_column(tmp_path, kind, value, omega):
    """-1 and 0 are the limits, and they change places between periods and frequencies."""
    zero, infinite = (-1, 0) if kind == 1 else (0, -1)
    text = f"{zero} 3 3 5.0\n{infinite} 3 3 2.0\n{value} 3 3 3.0 4.0\n"
    stem = write(tmp_path, _1=text, cfg=f"! comment\nipltdat=1\nIPEROUT = {kind}  ! first column\n")
    h = read_hydro(stem, ulen=4.0, rho=1.0, g=9.81, water_depth=3.0)
    np.testing.assert_allclose(h.omega, [omega])
    assert (float(h.added_mass_zero[0, 0]), float(h.added_mass_inf[0, 0])) == (5.0 * 64, 2.0 * 64)
    np.testing.assert_allclose(h.radiation_damping[0, 0, 0], 4.0 * 64 * omega)


def test_deep_water_limit_of_the_wavenumber(tmp_path):
    stem = write(tmp_path, _1="2.0 3 3 3.0 4.0\n", cfg="IPERIO=4\n")
    np.testing.assert_allclose(read_hydro(stem, g=9.81).omega, [np.sqrt(9.81 * 2.0)])


# --- the files beside the tables ---

OUT = """ Some head
 Gravity:     9.81000                Length scale:        2.00000
 Water depth:        {depth}       Water density:     1030.00000
{bodies} more
------------
                            Output from  WAMIT
"""
BODY = " XBODY =    {0} YBODY =    {1} ZBODY =    {2} PHIBODY =   {3}\n"
FORM_1 = """ Volumes (VOLX,VOLY,VOLZ):           9.0      10.0      12.0
 Center of Buoyancy (Xb,Yb,Zb):     1.5     0.0    -4.8
 Center of Gravity  (Xg,Yg,Zg):                              -1.0
 Radii of gyration:     3.0     0.0    -1.0
                        0.0     5.0     0.0
                       -1.0     0.0     6.0
"""


def test_constants_from_the_out_file(tmp_path):
    h = read_hydro(write(tmp_path, _1=ONE, out=OUT.format(depth="infinite", bodies="")))
    assert (h.attrs["g"], h.attrs["ulen"], h.attrs["rho"], h.attrs["water_depth"]) == (9.81, 2.0, 1030.0, np.inf)
    assert h.attrs["rho_source"] == "hull.out"
    h = read_hydro(write(tmp_path, _1=ONE, out=OUT.format(depth="40.5", bodies="")), rho=999.0)
    assert (h.attrs["rho"], h.attrs["water_depth"], h.attrs["rho_source"]) == (999.0, 40.5, "given")


def test_defaults_are_named(tmp_path):
    h = read_hydro(write(tmp_path, _1=ONE))
    assert (h.attrs["rho"], h.attrs["g"], h.attrs["ulen"]) == (1025.0, 9.80665, 1.0)
    assert {h.attrs[f"{key}_source"] for key in ("rho", "g", "ulen", "water_depth")} == {"assumed"}


def test_gdf_and_pot_where_there_is_no_out(tmp_path):
    pot = "title\n0\n0\n12.5 0.0 0.0 0.0 0.0\n0 1 0\n"
    h = read_hydro(write(tmp_path, _1=ONE, gdf="title\n3.0 9.7 ULEN GRAV\n0 1\n", pot=pot))
    assert (h.attrs["ulen"], h.attrs["g"], h.attrs["water_depth"]) == (3.0, 9.7, 12.5)
    pot = "title\n-1.0\n1 1\n2\n1.0 2.0\n1\n0.0\n1\nhull.gdf\n0.0 0.0 0.0 0.0\n1 1 1 1 1 1\n"
    assert read_hydro(write(tmp_path, _1=ONE, pot=pot)).attrs["water_depth"] == np.inf


def test_inertia_of_form_1_is_about_the_body_origin(tmp_path):
    """m = rho times the median volume, I_ij = m r_ij |r_ij|, centre of gravity above that of buoyancy."""
    full = "".join(f" 2.0 {i} {i} 1.0 1.0\n" for i in range(1, 7))
    M = read_hydro(write(tmp_path, _1=full, out=OUT.format(depth="infinite", bodies=FORM_1))).inertia_matrix.values
    m = 1030.0 * 10.0
    np.testing.assert_allclose(M.diagonal(), m * np.array([1, 1, 1, 9, 25, 36]))
    np.testing.assert_allclose([M[3, 5], M[0, 4], M[1, 5], M[2, 4]], m * np.array([-1, -1.0, 1.5, -1.5]))
    np.testing.assert_allclose(M, M.T)


def test_force_control_form_2(tmp_path):
    rows = "\n".join(" ".join("2.0" if i == j else "0" for j in range(6)) + " a comment" for i in range(6))
    frc = f"title\n1 0 1 1 0 0 0 0 1\n1010.0\n0 0 -1\n1\n{rows}\n0\n1\n{rows}\n0\n0\n"
    h = read_hydro(write(tmp_path, _1=ONE, frc=frc))
    assert (h.attrs["rho"], h.attrs["rho_source"]) == (1010.0, "hull.frc")
    np.testing.assert_array_equal(h.inertia_matrix, 2.0 * np.eye(2))
    np.testing.assert_array_equal(h.external_stiffness, 2.0 * np.eye(2))
    assert "external_damping" not in h
    with pytest.warns(OgilvieWarning, match="1010 kg/m3, 900 given"):
        read_hydro(tmp_path / "hull", rho=900.0)


def test_data_about_another_point_come_to_the_origin(tmp_path):
    """A set about (2, -1, -3) with XBODY saying so is the set about O."""
    p = np.array([2.0, -1.0, -3.0])
    h = buoy()
    H = shift_matrix(-p)  # velocity at O from that at p
    moved = {}
    for key, variable in h.data_vars.items():
        if "radiating_dof" in variable.dims:
            moved[key] = (variable.dims, H.T @ variable.values @ H)
        elif key == "motion_rao":
            moved[key] = (variable.dims, variable.values @ shift_matrix(p).T)
        else:
            moved[key] = (variable.dims, variable.values @ H)
    write_wamit(h.assign(moved), tmp_path / "hull")
    out = tmp_path / "hull.out"
    out.write_text(out.read_text() + BODY.format(*p, 0.0))
    back = read_hydro(tmp_path / "hull")
    assert back.attrs["moved_from"] == p.tolist()
    for key in h.data_vars:
        scale = np.abs(moved[key][1]).max()
        np.testing.assert_allclose(back[key], h[key], rtol=1e-5, atol=2e-6 * scale, err_msg=key)


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        (
            {"out": OUT.format(depth="infinite", bodies=2 * BODY.format(0, 0, 0, 0))},
            r"hull.out: one body expected, 2 bodies found",
        ),
        ({"out": OUT.format(depth="infinite", bodies=BODY.format(0, 0, 0, 90))}, r"PHIBODY = 0.*90 deg found"),
        ({"out": " Gravity: 9.81\n"}, r"hull.out: lines with Gravity, Length scale and Water depth expected"),
        ({"out": " Gravity: 9.81 Length scale: 1.0\n Water depth: infinite Water density: 1.0"}, r"the end of the file found"),
        (
            {"out": OUT.format(depth="infinite", bodies=""), "gdf": "t\n1.0 9.81\n"},
            r"hull.gdf: ulen 2.0 expected as in hull.out",
        ),
        ({"gdf": "t\nnothing\n"}, r"hull.gdf line 2: ULEN and GRAV"),
        (
            {"out": OUT.format(depth="infinite", bodies="").replace("1030.00000", "1030.000x0")},
            r"hull.out: a number after Water density expected, none found",
        ),
        (
            {"out": OUT.format(depth="infinite", bodies="").replace("9.81000", "0.00000")},
            r"hull.out: g, a positive number",
        ),
        ({"out": OUT.format(depth="infinite", bodies=BODY.format(0, 0, "*", 0))}, r"hull.out: XBODY, YBODY, ZBODY, PHIBODY"),
        ({"cfg": "IPEROUT=7\n"}, r"hull.cfg: IPEROUT = 1, 2, 3 or 4 expected, '7' found"),
        (
            {"frc": "t\n1 0\n1000\n0 0 0\n1\n1 2 3\n"},
            r"hull.frc line 6: the matrix inertia_matrix expected, the end of the file",
        ),
        ({"frc": "t\n1 0\n1000\n0 0 0 1 1 1\n1\n"}, r"hull.frc line 4: the centre of gravity of one body"),
        ({"frc": "t\n"}, r"hull.frc: .* expected, 1 lines found"),
        ({"pot": "t\n0\n"}, r"hull.pot: HBOT and the four numbers XBODY expected"),
    ],
)
def test_run_files_that_cannot_be_used(tmp_path, texts, message):
    with pytest.raises(FormatError, match=message):
        read_hydro(write(tmp_path, _1=ONE, **texts))


# --- tables that are damaged or do not fit ---

GOOD_1 = " 1.0 3 3 3.0 4.0\n 2.0 3 3 3.0 4.0\n"
GOOD_3 = " 1.0 0.0 3 1.0 0.0 1.0 0.0\n 2.0 0.0 3 1.0 0.0 1.0 0.0\n"


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        ({"_1": ""}, r"hull.1: rows of numbers expected, an empty file found"),
        ({"_1": " 1.0 3 3 3.0 4.0\n 2.0 3 3\n"}, r"hull.1 line 2: 4 or 5 columns expected, 3 found. The file looks truncated"),
        ({"_1": " 1.0 3 3 3.0\n 2.0 3 3 3.0 4.0\n"}, r"hull.1 line 1: 5 columns at finite frequency expected, 4 found"),
        ({"_1": GOOD_1 + " 3.0 3 3 3.0 4."}, r"hull.1 line 3: a last line of 16 characters expected, 15 and no newline found"),
        ({"_1": GOOD_1.replace("4.0", "NaN")}, r"hull.1 line 1: a finite number expected, 'NaN' found"),
        ({"_1": GOOD_1.replace("4.0", "1e999")}, r"hull.1 line 1: a finite number expected"),
        ({"_1": GOOD_1.replace("2.0 3 3 3.0", "2.0 3 3 ***")}, r"hull.1 line 2: .* '\*\*\*', a Fortran overflow, found"),
        ({"_1": GOOD_1.replace("2.0 3 3 3.0", "2.0 3 3 3_0")}, r"hull.1 line 2: a number expected, '3_0' found"),
        ({"_1": GOOD_1.replace("2.0 3 3", "2.0 3 x")}, r"hull.1 line 2: a number expected, 'x' found"),
        ({"_1": GOOD_1.replace("2.0 3 3", "2.0 3.5 3")}, r"hull.1 line 2: a mode, a whole number, expected, 3.5 found"),
        ({"_1": GOOD_1.replace("2.0 3 3", "2.0 9 9")}, r"hull.1 line 2: modes 1 to 6 expected, mode 9 found. Several bodies"),
        ({"_1": GOOD_1.replace("2.0", "-2.0")}, r"hull.1 line 2: a positive first column, 0 or -1 expected, -2 found"),
        ({"_1": GOOD_1 + " 0.0 3 3 1.0 1.0\n"}, r"hull.1 line 3: no damping at zero or infinite frequency expected, 1 found"),
        ({"_1": GOOD_1 + GOOD_1}, r"hull.1 line 3: every entry once expected, the entry of line 1 again found"),
        ({"_1": GOOD_1 + " 2.0 5 5 1.0 1.0\n"}, r"line 1: 2 couplings at every frequency expected, none for \(5,5\)"),
        (
            {"_1": GOOD_1 + " 1.0 1 3 1.0 1.0\n 2.0 1 3 1.0 1.0\n"},
            r"hull.1: coupling \(3,1\) beside \(1,3\) expected, none found",
        ),
        ({"_1": "".join(f" 1.0 {i} {j} 1.0 1.0\n" for i, j in ((1, 3), (3, 1)))}, r"the diagonal \(1,1\) of a mode"),
        ({"_1": " 0.0 3 3 1.0\n"}, r"hull.1: added mass at finite frequencies expected, none found"),
        ({"_1": GOOD_1.replace("3.0", "3\x00.0")}, r"hull.1 line 1: plain text expected, the byte 0x00 found"),
        (
            {"_1": GOOD_1, "_3": GOOD_3.replace(" 2.0 0.0 3", " 2.0 10.0 3")},
            r"hull.3 line 1: 2 frequency x 2 direction x 1 mode",
        ),
        ({"_1": GOOD_1, "_3": GOOD_3.replace("3 1.0", "3 1.1", 1)}, r"hull.3 line 1: amplitude and phase of its parts"),
        (
            {"_1": GOOD_1, "_3": GOOD_3.replace("1.0 0.0\n", "-1.0 0.0\n", 1)},
            r"hull.3 line 1: amplitude and phase of its parts",
        ),
        ({"_1": GOOD_1, "_3": GOOD_3.replace(" 2.0 0", " 3.0 0")}, r"hull.3: the frequencies of hull.1, 2 s .* expected"),
        ({"_1": GOOD_1, "_3": GOOD_3[: len(GOOD_3) // 2]}, r"hull.3: the frequencies of hull.1, 2 s .*truncated"),
        ({"_1": GOOD_1, "_3": GOOD_3.replace("0.0 3", "0.0 1")}, r"hull.3: modes \[3\] as in hull.1 expected, \[3\] missing"),
        ({"_1": GOOD_1, "_3": GOOD_3.replace("1.0 0.0 3", "-1.0 0.0 3", 1)}, r"hull.3 line 1: a finite positive period"),
        (
            {"_1": GOOD_1, "_3": GOOD_3, "_4": GOOD_3.replace(" 0.0 3", " 90.0 3")},
            r"hull.4: the 1 directions of hull.3 \(0..0 deg\) expected, 1 \(90..90 deg\) found",
        ),
        ({"_1": GOOD_1, "_3": GOOD_3, "_3fk": GOOD_3, "_3sc": GOOD_3}, r"hull.3fk and hull.3sc: parts of the total force"),
        ({"_1": GOOD_1, "hst": "1 1 0.0\n"}, r"hull.hst: 36 coefficients expected, 1 \(C\(1,2\) is missing\) found"),
        ({"_3": GOOD_3}, r"hull: a file hull.1 with added mass and damping expected, hull.3 found"),
    ],
)
def test_damaged_tables_are_named_with_their_line(tmp_path, texts, message):
    with pytest.raises(FormatError, match=message):
        read_hydro(write(tmp_path, **texts), probe=False)


def test_fortran_habits_are_understood(tmp_path):
    """D exponents, three-digit exponents without a letter, Windows line ends, blank lines, no newline at the end."""
    text = " 1.0D+00 3 3 3.0D+00 4.0\r\n\r\n 2.0E+00 3 3 3.000000-101 4.0"
    h = read_hydro(write(tmp_path, _1=text), rho=1.0)
    np.testing.assert_allclose(h.added_mass[:, 0, 0], [3e-101, 3.0])


def test_compressed_files_any_name_and_case(tmp_path):
    write_wamit(buoy(), tmp_path / "hull")
    plain = read_hydro(tmp_path / "hull")
    (tmp_path / "hull.3.gz").write_bytes(gzip.compress((tmp_path / "hull.3").read_bytes()))
    (tmp_path / "hull.3").unlink()
    (tmp_path / "hull.4").rename(tmp_path / "HULL.4")
    for name in ("hull", "hull.1", "hull.3.gz", "hull.hst", "HULL.4", "hull.out", "."):
        assert_same(read_hydro(tmp_path / name), plain, digits=0)
    (tmp_path / "hull.3.gz").write_bytes((tmp_path / "hull.3.gz").read_bytes()[:-20])
    with pytest.raises(FormatError, match=r"hull.3.gz: a complete gzip file expected"):
        read_hydro(tmp_path / "hull")


def test_what_is_not_there(tmp_path):
    with pytest.raises(InputError, match="nothing found"):
        read_hydro(tmp_path / "hull")
    with pytest.raises(InputError, match="no folder"):
        read_hydro(tmp_path / "nowhere" / "hull.1")
    (tmp_path / "a.txt").write_text("text")
    with pytest.raises(InputError, match="an unknown kind of file"):
        read_hydro(tmp_path / "a.txt")
    write(tmp_path, _1=ONE)
    with pytest.raises(InputError, match="format: one of wamit, hams, netcdf"):
        read_hydro(tmp_path / "hull", format="aqwa")
    with pytest.raises(InputError, match="ulen: a positive number"):
        read_hydro(tmp_path / "hull", ulen=-1.0)
    (tmp_path / "other.1").write_text(ONE)
    with pytest.raises(FormatError, match="one WAMIT run expected, hull, other found"):
        read_hydro(tmp_path)


# --- directions ---


def response(rows) -> str:
    """Rows of (period, direction, mode, complex value)."""
    return "".join(f"{T} {b} {m} {abs(v)} {np.degrees(np.angle(v))} {v.real} {v.imag}\n" for T, b, m, v in rows)


@pytest.mark.parametrize(
    ("degrees", "expected"),
    [
        ((-90.0, 0.0, 180.0), (-90.0, 0.0, 180.0)),
        ((0.0, 90.0, 270.0), (0.0, 90.0, 270.0)),
        ((-180.0, 0.0), (0.0, 180.0)),
        ((270.0, 370.0), (10.0, 270.0)),
    ],
)
def test_directions_are_kept_or_wrapped(tmp_path, degrees, expected):
    rows = [(T, b, 3, complex(b + 1.0, T)) for T in (1.0, 2.0) for b in degrees]
    h = read_hydro(write(tmp_path, _1=GOOD_1, _3=response(rows)), rho=1.0, g=1.0, probe=False)
    np.testing.assert_allclose(np.rad2deg(h.wave_direction), expected)
    wrapped = {(b - e) % 360.0: 0 for b in degrees for e in expected}
    assert 0.0 in wrapped
    for k, e in enumerate(expected):
        source = next(b for b in degrees if (b - e) % 360.0 == 0.0)
        np.testing.assert_allclose(h.excitation_force[:, k, 0], [source + 1 + 2j, source + 1 + 1j])


def test_0_and_360_degrees_are_one_direction(tmp_path):
    rows = [(T, b, 3, complex(b % 360.0 + 1.0, T)) for T in (1.0, 2.0) for b in (0.0, 180.0, 360.0)]
    h = read_hydro(write(tmp_path, _1=GOOD_1, _3=response(rows)), probe=False)
    np.testing.assert_allclose(np.rad2deg(h.wave_direction), [0.0, 180.0])
    assert "differ by 360 deg are one" in h.attrs["notes"]
    rows[-1] = (2.0, 360.0, 3, 5.0 + 0j)
    with pytest.raises(FormatError, match=r"hull.3: equal values in directions that differ by 360 deg expected"):
        read_hydro(write(tmp_path, _1=GOOD_1, _3=response(rows)), probe=False)


# --- parts of the force ---


def test_the_missing_part_of_the_force_is_the_difference(tmp_path):
    h = buoy()
    write_wamit(h, tmp_path / "hull")
    whole = read_hydro(tmp_path / "hull")
    for lacking in ("3sc", "3fk", "3"):
        text = (tmp_path / f"hull.{lacking}").read_text()
        (tmp_path / f"hull.{lacking}").unlink()
        part = read_hydro(tmp_path / "hull")
        for key in ("excitation_force", "Froude_Krylov_force", "diffraction_force"):
            np.testing.assert_allclose(part[key], whole[key], rtol=1e-5, atol=1.0)
        (tmp_path / f"hull.{lacking}").write_text(text)


def test_haskind_forces_stand_in(tmp_path):
    h = read_hydro(write(tmp_path, _1=GOOD_1, _2=GOOD_3), rho=1.0, g=1.0, probe=False)
    np.testing.assert_allclose(h.excitation_force, np.ones((2, 1, 1)))
    assert "Haskind" in h.attrs["notes"]


def test_modes_that_do_not_move_or_radiate(tmp_path):
    both = GOOD_3 + GOOD_3.replace("0.0 3", "0.0 1")
    h = read_hydro(write(tmp_path, _1=GOOD_1, _3=both, _4=GOOD_3.replace("0.0 3", "0.0 1")), probe=False)
    assert h.sizes["influenced_dof"] == 1
    assert "motion_rao" not in h
    assert "hull.3: modes [1] left out" in h.attrs["notes"]
    assert "hull.4: left out, modes [3]" in h.attrs["notes"]


# --- second order ---


def drift(rows) -> str:
    return "".join(f"{T} {a} {b} {m} {abs(v)} {np.degrees(np.angle(v))} {v.real} {v.imag}\n" for T, a, b, m, v in rows)


ALL = "".join(f" {T} {i} {i} 1.0 1.0\n" for T in (1.0, 2.0) for i in range(1, 7))


def test_mean_drift_of_each_method_and_the_best(tmp_path):
    near = [(T, b, b, m, complex(T * m, 0.0)) for T in (1.0, 2.0) for b in (0.0, 90.0) for m in (1, 2, 3, 4, 5, 6, -4, -5, -6)]
    far = [(T, b, b, m, complex(10.0 * m, 0.0)) for T in (1.0, 2.0) for b in (0.0, 90.0) for m in (1, 2, 6)]
    stem = write(tmp_path, _1=ALL, _8=drift(far))
    h = read_hydro(stem, ulen=2.0, rho=1.0, g=1.0)
    assert h.mean_drift.attrs["method"] == "surge: momentum, sway: momentum, yaw: momentum"
    np.testing.assert_allclose(h.mean_drift[0, 0], [20.0, 40.0, np.nan, np.nan, np.nan, 240.0])
    write(tmp_path, _9=drift(near))
    h = read_hydro(stem, ulen=2.0, rho=1.0, g=1.0)
    assert "sway: momentum, heave: pressure" in h.mean_drift.attrs["method"]
    np.testing.assert_allclose(h.mean_drift.sel(omega=2 * np.pi)[1], [20.0, 40.0, 6.0, 16.0, 20.0, 240.0])
    np.testing.assert_allclose(h.mean_drift_pressure.sel(omega=2 * np.pi)[1], [2.0, 4.0, 6.0, 16.0, 20.0, 24.0])
    np.testing.assert_allclose(h.mean_drift_pressure_body.sel(omega=2 * np.pi)[1], [2.0, 4.0, 6.0, -16.0, -20.0, -24.0])
    np.testing.assert_allclose(h.mean_drift_momentum[0, 0, 5], 240.0)
    assert "mean_drift_pairs" not in h


def test_mean_drift_of_two_directions(tmp_path):
    rows = [
        (T, a, b, m, complex(m, (a - b) / 90.0))
        for T in (1.0, 2.0)
        for a in (0.0, 90.0)
        for b in (0.0, 90.0)
        for m in (1, 2, 6)
    ]
    h = read_hydro(write(tmp_path, _1=ALL, _8=drift(rows)), rho=1.0, g=1.0)
    np.testing.assert_allclose(h.mean_drift[:, :, 1], 2.0)
    k = int(np.flatnonzero((h.drift_direction_1 > 1) & (h.drift_direction_2 == 0))[0])
    np.testing.assert_allclose(h.mean_drift_pairs[:, k, 0], 1.0 + 1.0j)
    assert h.sizes["drift_pair"] == 4


def test_drift_of_another_run_is_refused(tmp_path):
    rows = [(T, 0.0, 0.0, 1, 1.0 + 0j) for T in (1.0, 3.0)]
    with pytest.raises(FormatError, match=r"hull.8: the frequencies of hull.1, 2 s"):
        read_hydro(write(tmp_path, _1=ALL, _8=drift(rows)))
    rows = [(T, 45.0, 45.0, 1, 1.0 + 0j) for T in (1.0, 2.0)]
    with pytest.raises(FormatError, match=r"hull.8: the 1 directions of hull.3"):
        read_hydro(
            write(tmp_path, _1=ALL, _8=drift(rows), _3=response([(T, 0.0, m, 1j) for T in (1.0, 2.0) for m in range(1, 7)]))
        )


def qtf(rows) -> str:
    out = ""
    for T1, T2, a, b, m, v in rows:
        out += f"{T1} {T2} {a} {b} {m} {abs(v)} {np.degrees(np.angle(v))} {v.real} {v.imag}\n"
    return out


def test_quadratic_transfer_functions_are_completed_by_symmetry(tmp_path):
    """One half is printed; Q_diff is Hermitian, Q_sum symmetric; what no half holds is NaN."""
    periods, value = (1.0, 2.0, 4.0), lambda i, j, m: complex(m, i - j) if i != j else complex(m, 0.0)
    half = [
        (periods[i], periods[j], 0.0, 0.0, m, value(i, j, m))
        for i in range(3)
        for j in range(i + 1)
        if i - j < 2
        for m in range(1, 7)
    ]
    waves = response([(T, 0.0, m, 1j) for T in (1.0, 2.0) for m in range(1, 7)])
    stem = write(tmp_path, _1=ALL, _3=waves, _12d=qtf(half), _12s=qtf(half))
    h = read_hydro(stem, ulen=2.0, rho=1.0, g=1.0, probe=False)
    np.testing.assert_allclose(h.omega_1, 2 * np.pi / np.array([4.0, 2.0, 1.0]))
    D, S = h.qtf_diff.values[:, :, 0], h.qtf_sum.values[:, :, 0]
    np.testing.assert_allclose(D[0, 1], 2.0 ** np.array([1, 1, 1, 2, 2, 2]) * [value(2, 1, m) for m in range(1, 7)])
    np.testing.assert_allclose(D[1, 0], D[0, 1].conj())
    np.testing.assert_allclose(S[1, 0], S[0, 1])
    assert np.isnan(D[0, 2]).all()
    assert np.isfinite(D[1, 1]).all()
    assert "qtf_diff_pairs" not in h


def test_quadratic_transfer_functions_of_two_directions(tmp_path):
    """Exchanging frequencies exchanges directions."""
    rows = [
        (T1, T2, a, b, m, complex(T1 + a, T2 + b))
        for T1, T2 in ((1.0, 2.0),)
        for a, b in ((0.0, 0.0), (0.0, 90.0))
        for m in (1, 2, 3, 4, 5, 6)
    ]
    h = read_hydro(write(tmp_path, _1=ALL, _12d=qtf(rows)), rho=1.0, g=1.0)
    assert "qtf_diff" not in h
    pairs = np.rad2deg(np.stack([h.qtf_direction_1, h.qtf_direction_2], axis=1))
    np.testing.assert_allclose(pairs, [[0, 0], [0, 90], [90, 0]])
    np.testing.assert_allclose(h.qtf_diff_pairs[1, 0, 1], 1 + 92j)
    np.testing.assert_allclose(h.qtf_diff_pairs[0, 1, 2], 1 - 92j)
    with pytest.raises(FormatError, match=r"hull.12d line 11: 6 modes for every pair"):
        read_hydro(write(tmp_path, _12d=qtf(rows[:-1])))


# --- writing ---


@pytest.mark.parametrize("ulen", [1.0, 7.5])
def test_written_and_read_again(tmp_path, ulen):
    h = buoy()
    paths = write_wamit(h, tmp_path / "hull", ulen=ulen)
    assert {p.name.split(".", 1)[1] for p in paths} == {"1", "3", "3fk", "3sc", "4", "hst", "frc", "out"}
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(p.name for p in paths)
    back = read_hydro(tmp_path / "hull")
    assert_same(back, h)
    assert [back.attrs[k] for k in ("rho", "g", "water_depth", "ulen")] == [1000.0, 9.81, 50.0, ulen]
    write_wamit(h, tmp_path / "hull", ulen=ulen)  # over its own files


def test_drift_written_and_read_again(tmp_path):
    h = buoy()
    rng = np.random.default_rng(2)
    dims = ("omega", "wave_direction", "influenced_dof")
    near, body, far = rng.normal(size=(3, *h.excitation_force.shape))
    body[..., :3] = near[..., :3]
    far[..., 2:5] = np.nan
    h = h.assign(mean_drift_pressure=(dims, near), mean_drift_pressure_body=(dims, body), mean_drift_momentum=(dims, far))
    write_wamit(h, tmp_path / "hull", ulen=3.0)
    assert_same(read_hydro(tmp_path / "hull").drop_vars("mean_drift"), h)


def test_numbers_that_do_not_fit_the_columns(tmp_path):
    h = buoy()
    F = h.excitation_force.values.copy()
    F[0, 0, 5] = -1e-250 - 3e-120j
    write_wamit(
        h.drop_vars(("Froude_Krylov_force", "diffraction_force")).assign(excitation_force=h.excitation_force.copy(data=F)),
        tmp_path / "a",
    )
    assert complex(read_hydro(tmp_path / "a").excitation_force[0, 0, 5]) == 0.0
    with pytest.raises(InputError, match="numbers below 1e100 expected"):
        write_wamit(h.assign(added_mass=1e150 * h.added_mass), tmp_path / "b")


def test_the_writer_refuses(tmp_path):
    h = buoy()
    with pytest.raises(InputError, match="speed: zero expected"):
        write_wamit(h.assign_attrs(speed=3.0), tmp_path / "hull")
    with pytest.raises(InputError, match="an existing folder expected"):
        write_wamit(h, tmp_path / "nowhere" / "hull")
    with pytest.raises(InputError, match="positive ulen"):
        write_wamit(h, tmp_path / "hull", ulen=0.0)
    (tmp_path / "hull.8").write_text("left over from another run\n")
    with pytest.raises(InputError, match="no other files of this stem expected"):
        write_wamit(h, tmp_path / "hull")
    (tmp_path / "hull.8").unlink()
    (tmp_path / "hull.out").write_text("the record of a run that took a week\n")
    with pytest.raises(InputError, match=r"hull.out: no other files"):
        write_wamit(h, tmp_path / "hull")
    assert [p.name for p in tmp_path.iterdir()] == ["hull.out"]


def test_nothing_half_written(tmp_path, monkeypatch):
    """The last file cannot be written: none is there."""
    import ogilvie.hydro.wamit_write as module

    monkeypatch.setattr(module, "_head", lambda *_: "\u20ac")  # no ASCII
    with pytest.raises(UnicodeEncodeError):
        write_wamit(buoy(), tmp_path / "hull")
    assert list(tmp_path.iterdir()) == []


# --- real data ---


@pytest.mark.parametrize("name", REAL)
def test_real_sets_survive_writing_to_the_printed_digits(shared_data, tmp_path, name):
    h = read_hydro(shared_data / REAL[name])
    write_wamit(h, tmp_path / name)
    back = read_hydro(tmp_path / name)
    assert_same(back, h)
    write_wamit(back, tmp_path / "again")  # numbers of seven digits have no more to lose
    for suffix in ("1", "3"):
        first, second = ((tmp_path / f"{stem}.{suffix}").read_text().split() for stem in (name, "again"))
        np.testing.assert_allclose(np.array(first, float), np.array(second, float), rtol=1.5e-6, atol=1e-30)


@pytest.mark.parametrize(("name", "tolerance"), [("tanker", 0.009), ("fpso", 0.041), ("semisub", 0.011)])
def test_motions_in_the_files_obey_the_equation_of_motion(shared_data, name, tolerance):
    """(-w^2 (M + A) + i w (B + B_ext) + C + C_ext) X = F with everything as read: units, powers and matrices at once.

    The motions of these runs (IOPTN(4) = 1) come from Haskind's forces, F from the diffraction potential; the two differ by the
    discretisation, most for the coarse FPSO.
    """
    h = read_hydro(shared_data / REAL[name])
    X, scale = h.motion_rao.values, np.abs(h.motion_rao.values).max(axis=(0, 1))
    assert (np.abs(motions(h) - X).max(axis=(0, 1)) < tolerance * scale).all()
    if name == "tanker":  # without the .frc's damping the roll resonance is far off
        off = np.abs(motions(h.drop_vars("external_damping")) - X).max(axis=(0, 1)) / scale
        assert off[3] > 0.5


def motions(h: xr.Dataset) -> np.ndarray:
    w, zero = h.omega.values[:, None, None], np.zeros((6, 6))
    B = h.radiation_damping.values + np.asarray(h.get("external_damping", zero))
    C = h.hydrostatic_stiffness.values + np.asarray(h.get("external_stiffness", zero))
    Z = -(w**2) * (h.inertia_matrix.values + h.added_mass.values) + 1j * w * B + C
    return np.linalg.solve(Z, h.excitation_force.values.swapaxes(1, 2)).swapaxes(1, 2)


def test_tanker_as_published(shared_data):
    """Numbers of the .out file: water plane, restoring, volume; the .frc's mass and damping."""
    h = read_hydro(shared_data / REAL["tanker"])
    rg = 1025.0 * 9.80665
    C = h.hydrostatic_stiffness.values / rg
    np.testing.assert_allclose([C[2, 2], C[2, 4], C[3, 3], C[4, 4]], [10222.0, 31916.0, 0.92149e6, 0.43472e8], rtol=1e-4)
    np.testing.assert_allclose(h.inertia_matrix[0, 0] / 1025.0, 92312.4, rtol=1e-3)
    assert float(h.external_damping[3, 3]) == 1.56e9
    assert (h.sizes["omega"], h.sizes["wave_direction"], h.attrs["rho_source"]) == (58, 19, "tanker.out.head")
    assert tuple(h.influenced_dof.values) == DOFS


def test_sphere_far_and_near_drift_are_one_force(shared_data):
    """Momentum and pressure integration agree up to ka = 1; beyond, 400 panels are too coarse for the pressure (.9)."""
    h = read_hydro(shared_data / REAL["sphere"])
    far, near = h.mean_drift_momentum.values[:, 0, 0], h.mean_drift_pressure.values[:, 0, 0]
    band = (h.omega.values > 1.6) & (h.omega.values < 3.13)
    np.testing.assert_allclose(near[band], far[band], rtol=0.2)
    np.testing.assert_array_equal(h.mean_drift.values[:, 0, 0], far)
    np.testing.assert_array_equal(h.mean_drift.values[:, 0, 2], h.mean_drift_pressure.values[:, 0, 2])
    assert np.isnan(h.mean_drift_momentum.values[..., 2:5]).all()


@pytest.mark.parametrize("cut", [0.999, 0.7, 0.31])
def test_truncated_tanker(shared_data, tmp_path, cut):
    for suffix in ("1", "3"):
        raw = (shared_data / f"{REAL['tanker']}.{suffix}").read_bytes()
        (tmp_path / f"tanker.{suffix}").write_bytes(raw if suffix == "1" else raw[: int(cut * len(raw))])
    with pytest.raises(FormatError, match=r"tanker\.3"):
        read_hydro(tmp_path / "tanker")
